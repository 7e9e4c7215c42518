#!/usr/bin/env python3
"""FuseSoC's generator `raster_pkg` of halfplane.core: writes raster_pkg.sv of a configuration, and a core that has it.

Called by FuseSoC with a file of the call. The program is $HALFPLANE, `halfplane` in the PATH, or build/halfplane here.
"""

import os
import pathlib
import shutil
import subprocess
import sys

import yaml


def main():
    call = yaml.safe_load(pathlib.Path(sys.argv[1]).read_text())
    parameters = call.get("parameters") or {}
    here = pathlib.Path(__file__).resolve().parents[1] / "build/halfplane"
    program = os.environ.get("HALFPLANE") or shutil.which("halfplane") or str(here)
    command = [program, "config", "--config", str(parameters.get("config", "embedded")), "--sv"]
    for setting in parameters.get("settings", []):
        command += ["--set", str(setting)]
    try:
        package = subprocess.run(
            command, stdout=subprocess.PIPE, text=True, check=True, cwd=call.get("files_root")
        ).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"{' '.join(command)}: {error}; set HALFPLANE to the program")
    name = str(call["vlnv"])
    pathlib.Path("raster_pkg.sv").write_text(package)
    core = {
        "name": name,
        "filesets": {"package": {"files": ["raster_pkg.sv"], "file_type": "systemVerilogSource"}},
        "targets": {"default": {"filesets": ["package"]}},
    }
    pathlib.Path(name.replace(":", "_").strip("_") + ".core").write_text("CAPI=2:\n" + yaml.safe_dump(core))


if __name__ == "__main__":
    main()
