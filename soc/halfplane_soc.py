#!/usr/bin/env python3
"""A system that draws, in LiteX: VexRiscv, memory, halfplane_core, a display.

Without SDRAM the memory is integrated RAM, and the core is wishbone_shell.py's module, a master of the Wishbone bus. With
SDRAM the core has a port of LiteDRAM of its own, by LiteDRAM's AXI frontend, and there is no cache between processor and
SDRAM.

usage: halfplane_soc.py FOLDER [sdram]    writes soc.v, the memories' contents, sources.txt, and system.h and regions.ld for
the firmware; the processor's program is FOLDER/firmware.bin, if there is one. sdram: LiteDRAM with its model of SDRAM, and
display.py
"""

import pathlib
import sys

import display
import wishbone_shell
from core_module import Core
from litedram.frontend.axi import LiteDRAMAXI2Native
from litedram.init import get_sdram_phy_init_sequence
from litedram.modules import MT48LC16M16
from litedram.phy.model import SDRAMPHYModel
from litex.build.generic_platform import Pins, Subsignal
from litex.build.sim import SimPlatform
from litex.soc.integration.common import get_mem_data
from litex.soc.integration.export import get_csr_header, get_linker_regions
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCCore
from migen import ClockDomain, Module

MEMORY_BASE = 0x40000000
CORE_BASE = 0x90000000  # registers of the core; uncached
CORE_IRQ = 3
CLOCK = 50_000_000
# Bits of LiteDRAM's registers sdram_dfii_control and sdram_dfii_pi0_command, from bit 0 on
CONTROLS = ["SEL", "CKE", "ODT", "RESET_N"]
COMMANDS = ["CS", "WE", "CAS", "RAS", "WRDATA", "RDDATA"]

IO = [
    ("clk", 0, Pins(1)),
    ("reset", 0, Pins(1)),
    (
        "video",
        0,
        Subsignal("data", Pins(24)),
        Subsignal("valid", Pins(1)),
        Subsignal("ready", Pins(1)),
        Subsignal("last", Pins(1)),
        Subsignal("user", Pins(1)),
    ),
]


class HalfplaneSoC(SoCCore):
    """`sdram`: the PHY and the module that it is connected to."""

    def __init__(
        self, platform, crg, firmware, clock, variant="standard", rom_size=0x20000, sram_size=0x8000, sdram=None
    ):
        self.crg = crg
        SoCCore.__init__(
            self,
            platform,
            clk_freq=clock,
            cpu_type="vexriscv",
            cpu_variant=variant,
            with_uart=False,
            with_timer=False,
            ident="",
            integrated_rom_size=rom_size,
            integrated_rom_init=get_mem_data(firmware, data_width=32, endianness="little") if firmware else [],
            integrated_sram_size=sram_size,
            integrated_main_ram_size=0 if sdram else 0x80000,
        )
        if sdram:
            self.submodules.halfplane = core = Core()
        else:
            self.submodules.halfplane = core = wishbone_shell.Instantiated()
        self.irq.add("halfplane", n=CORE_IRQ)
        self.bus.add_slave("halfplane", core.registers, SoCRegion(origin=CORE_BASE, size=0x1000, cached=False))
        if sdram:
            self.submodules.sdrphy, module = sdram
            self.add_sdram("sdram", phy=self.sdrphy, module=module, origin=MEMORY_BASE, l2_cache_size=0)
            port = self.sdram.crossbar.get_port(data_width=32)
            self.submodules += LiteDRAMAXI2Native(core.memory, port, base_address=MEMORY_BASE)
        else:
            self.bus.add_master("halfplane", master=core.memory)

    def write_header(self, folder):
        """What the firmware knows of the system: addresses and sizes, and how the SDRAM is begun."""
        (folder / "regions.ld").write_text(get_linker_regions(self.mem_regions))
        text = "#include <stdint.h>\n" + get_csr_header(self.csr_regions, self.constants, with_access_functions=False)
        if hasattr(self, "sdram"):
            text += self.sdram_steps()
        (folder / "system.h").write_text(text)

    def sdram_steps(self):
        timing = self.sdram.controller.settings.timing
        steps, _ = get_sdram_phy_init_sequence(self.sdrphy.settings, timing)
        text = "".join(f"#define DFII_CONTROL_{name} {1 << bit}\n" for bit, name in enumerate(CONTROLS))
        text += "".join(f"#define DFII_COMMAND_{name} {1 << bit}\n" for bit, name in enumerate(COMMANDS))
        rows = (f"  {{{a}, {bank}, {command}, {int('CONTROL' in command)}, {delay}}}, /* {what} */"
                for what, a, bank, command, delay in steps)
        return text + "\n".join(
            [
                "static const struct {",
                "  uint16_t address;",
                "  uint8_t bank, word, is_control;",
                "  uint16_t delay;",
                "} sdram_steps[] = {",
                *rows,
                "};",
                "",
            ]
        )


def main():
    folder, with_sdram = pathlib.Path(sys.argv[1]), sys.argv[2:] == ["sdram"]
    firmware = folder / "firmware.bin"
    platform = SimPlatform("SIM", list(IO))
    crg = Module()
    crg.clock_domains.cd_sys = ClockDomain("sys")
    crg.comb += [crg.cd_sys.clk.eq(platform.request("clk")), crg.cd_sys.rst.eq(platform.request("reset"))]
    sdram = None
    if with_sdram:
        module = MT48LC16M16(CLOCK, "1:1")
        sdram = SDRAMPHYModel(module, data_width=32, clk_freq=CLOCK), module
    soc = HalfplaneSoC(platform, crg, str(firmware) if firmware.exists() else None, CLOCK, sdram=sdram)
    video, pads = soc.halfplane.video, platform.request("video")
    if with_sdram:
        soc.submodules.display = shown = display.Display(display.SIMULATED)
        soc.comb += [
            video.connect(shown.sink),
            shown.source.ready.eq(pads.ready),
            pads.valid.eq(shown.source.valid & shown.is_pixel),
            pads.data.eq(shown.pixel.data),
            pads.user.eq(shown.pixel.user),
            pads.last.eq(shown.pixel.last),
        ]
    else:
        soc.comb += [pads.valid.eq(video.valid), video.ready.eq(pads.ready)]
        soc.comb += [getattr(pads, name).eq(getattr(video, name)) for name in ("data", "user", "last")]
    soc.finalize()
    soc.write_header(folder)
    platform.get_verilog(soc, name="soc", regs_init=True).write(str(folder / "soc.v"))
    (folder / "sources.txt").write_text("".join(f"{source[0]}\n" for source in platform.sources))


if __name__ == "__main__":
    main()
