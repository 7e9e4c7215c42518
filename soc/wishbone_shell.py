#!/usr/bin/env python3
"""halfplane_core as a Verilog module on Wishbone: registers as a slave, memory as a master, by LiteX's bridges around
the AXI ports. Classic cycles, a beat at a time, words of 32 bits, addresses in words. Memory's `err` ends a beat as `ack`
does: the bridge does not report it.

usage: wishbone_shell.py FILE    with build/python's python: writes the module halfplane_core_wishbone, which wants core/
and rtl_ref/
"""

import sys

from core_module import PIXEL, Core
from litex.soc.interconnect import axi, stream, wishbone
from migen import ClockDomain, ClockSignal, Instance, Module, ResetSignal, Signal
from migen.fhdl import verilog

NAME = "halfplane_core_wishbone"
WISHBONE = {"out": "adr dat_w sel cyc stb we", "in": "dat_r ack err"}  # seen from the master
VIDEO = ["data", "valid", "ready", "last", "user"]


class Shell(Module):
    def __init__(self):
        self.registers, self.memory = (wishbone.Interface(data_width=32, adr_width=30) for _ in range(2))
        self.submodules.core = core = Core()
        self.submodules += axi.Wishbone2AXILite(self.registers, core.registers)
        inner = wishbone.Interface(data_width=32, adr_width=30)
        self.submodules += axi.AXI2Wishbone(core.memory, inner)
        self.comb += [inner.connect(self.memory, omit=["ack"]), inner.ack.eq(self.memory.ack | self.memory.err)]
        self.video, self.irq = core.video, core.irq


class Instantiated(Module):
    """The same, as an instance of the module that is in the file."""

    def __init__(self):
        self.registers, self.memory = (wishbone.Interface(data_width=32, adr_width=30) for _ in range(2))
        self.video, self.irq = stream.Endpoint(PIXEL), Signal()
        self.ev = self  # LiteX connects ev.irq
        ports = {"i_clk": ClockSignal("sys"), "i_rst": ResetSignal("sys"), "o_irq": self.irq}
        for name in VIDEO:
            ports[f"{'i' if name == 'ready' else 'o'}_video_{name}"] = getattr(self.video, name)
        for bus, sides in (("registers", "io"), ("memory", "oi")):
            for side, table in zip(sides, WISHBONE.values()):
                for name in table.split():
                    ports[f"{side}_{bus}_{name}"] = getattr(getattr(self, bus), name)
        self.specials += Instance(NAME, **ports)


def write(file):
    shell = Shell()
    shell.clock_domains.cd_sys = domain = ClockDomain("sys")
    domain.clk.name_override, domain.rst.name_override, shell.irq.name_override = "clk", "rst", "irq"
    ports = {domain.clk, domain.rst, shell.irq}
    for prefix, record, names in (
        ("registers", shell.registers, " ".join(WISHBONE.values()).split()),
        ("memory", shell.memory, " ".join(WISHBONE.values()).split()),
        ("video", shell.video, VIDEO),
    ):
        for name in names:
            signal = getattr(record, name)
            signal.name_override = f"{prefix}_{name}"
            ports.add(signal)
    verilog.convert(shell, ports, name=NAME).write(file)


if __name__ == "__main__":
    write(sys.argv[1])
