#!/usr/bin/env python3
"""A system that draws, in LiteX: VexRiscv, integrated RAM, halfplane_core as slave and master of the bus, video pins.

usage: halfplane_soc.py FIRMWARE.bin FOLDER    writes soc.v, the memories' contents and sources.txt into FOLDER
"""

import pathlib
import sys

from litex.build.generic_platform import Pins, Subsignal
from litex.build.sim import SimPlatform
from litex.soc.integration.common import get_mem_data
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCCore
from litex.soc.interconnect import axi
from migen import ClockDomain, ClockSignal, Instance, Module, ResetSignal, Signal

CORE_BASE = 0x90000000  # registers of the core; uncached
CORE_IRQ = 3

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
# Signals of the AXI channels that both sides have, by the direction seen from the master.
OUT = {
    "aw": "id addr len size burst lock cache prot valid",
    "w": "data strb last valid",
    "b": "ready",
    "ar": "id addr len size burst lock cache prot valid",
    "r": "ready",
}
IN = {"aw": "ready", "w": "ready", "b": "id resp valid", "ar": "ready", "r": "id data resp last valid"}


class Core(Module):
    """halfplane_core.sv: registers on AXI-Lite, memory on AXI, video."""

    def __init__(self, video):
        self.registers = axi.AXILiteInterface(data_width=32, address_width=32)
        self.memory = axi.AXIInterface(data_width=32, address_width=32, id_width=1)
        self.irq = Signal()
        self.ev = self  # LiteX connects ev.irq
        ports = {
            "i_clk_i": ClockSignal("sys"),
            "i_rst_ni": ~ResetSignal("sys"),
            "o_irq": self.irq,
            "i_s_axis_tdata": 0,
            "i_s_axis_tvalid": 0,
            "i_m_axi_texture_arready": 0,
            "i_m_axi_texture_rid": 0,
            "i_m_axi_texture_rdata": 0,
            "i_m_axi_texture_rresp": 0,
            "i_m_axi_texture_rlast": 0,
            "i_m_axi_texture_rvalid": 0,
            "i_m_axis_video_tready": video.ready,
        }
        ports |= {f"o_m_axis_video_t{name}": getattr(video, name) for name in ("data", "valid", "last", "user")}
        for direction, table in (("o", OUT), ("i", IN)):
            for channel, names in table.items():
                for name in names.split():
                    ports[f"{direction}_m_axi_{channel}{name}"] = getattr(getattr(self.memory, channel), name)
                    back = "i" if direction == "o" else "o"
                    if hasattr(getattr(self.registers, channel), name) and name not in ("id", "last"):
                        signal = getattr(getattr(self.registers, channel), name)
                        ports[f"{back}_s_axil_{channel}{name}"] = signal[:7] if name == "addr" else signal
        self.specials += Instance("halfplane_core", **ports)


class HalfplaneSoC(SoCCore):
    def __init__(self, platform, firmware):
        self.crg = Module()
        self.crg.clock_domains.cd_sys = ClockDomain("sys")
        self.comb += [
            self.crg.cd_sys.clk.eq(platform.request("clk")),
            self.crg.cd_sys.rst.eq(platform.request("reset")),
        ]
        SoCCore.__init__(
            self,
            platform,
            clk_freq=50_000_000,
            cpu_type="vexriscv",
            cpu_variant="standard",
            with_uart=False,
            with_timer=False,
            ident="",
            integrated_rom_size=0x20000,
            integrated_rom_init=get_mem_data(firmware, data_width=32, endianness="little"),
            integrated_sram_size=0x8000,
            integrated_main_ram_size=0x80000,
        )
        self.submodules.halfplane = Core(platform.request("video"))
        self.irq.add("halfplane", n=CORE_IRQ)
        self.bus.add_slave(
            "halfplane", self.halfplane.registers, SoCRegion(origin=CORE_BASE, size=0x1000, cached=False)
        )
        self.bus.add_master("halfplane", master=self.halfplane.memory)


def main():
    firmware, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    platform = SimPlatform("SIM", list(IO))
    soc = HalfplaneSoC(platform, firmware)
    soc.finalize()
    platform.get_verilog(soc, name="soc", regs_init=True).write(str(folder / "soc.v"))
    (folder / "sources.txt").write_text("".join(f"{source[0]}\n" for source in platform.sources))


if __name__ == "__main__":
    main()
