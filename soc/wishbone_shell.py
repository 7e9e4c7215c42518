#!/usr/bin/env python3
"""halfplane_core as a Verilog module on Wishbone: registers as a slave, memory as a master, by LiteX's bridges around
the AXI ports. Classic cycles, a beat at a time, words of 32 bits, addresses in words. `err` ends a beat with or without
`ack`. Memory's is the error response of the burst, where LiteX's bridge says OKAY; of a register it comes with `ack`, as
LiteX's bridges have it.

usage: wishbone_shell.py FILE    with build/python's python: writes the module halfplane_core_wishbone, which wants core/
and rtl_ref/
"""

import sys

from core_module import PIXEL, Core
from litex.soc.interconnect import axi, stream, wishbone
from migen import ClockDomain, ClockSignal, If, Instance, Module, Mux, ResetSignal, Signal
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
        bridged = axi.AXIInterface(data_width=32, address_width=32, id_width=1)
        self.submodules += axi.AXI2Wishbone(bridged, inner)
        self.comb += [inner.connect(self.memory, omit=["ack"]), inner.ack.eq(self.memory.ack | self.memory.err)]
        self.comb += [getattr(core.memory, channel).connect(getattr(bridged, channel)) for channel in ("aw", "w", "ar")]
        self.comb += [getattr(bridged, channel).connect(getattr(core.memory, channel), omit=["resp"]) for channel in "br"]
        # The bridge does one thing at a time: a read is answered before its next beat, a write after its last one.
        self.read_error, self.write_error = Signal(name="read_error"), Signal(name="write_error")
        self.sync += [
            If(core.memory.b.valid & core.memory.b.ready, self.write_error.eq(0)),
            If(
                inner.stb & inner.ack,
                If(inner.we, self.write_error.eq(self.write_error | self.memory.err)).Else(
                    self.read_error.eq(self.memory.err)
                ),
            ),
        ]
        self.comb += [
            core.memory.r.resp.eq(Mux(self.read_error, axi.RESP_SLVERR, axi.RESP_OKAY)),
            core.memory.b.resp.eq(Mux(self.write_error, axi.RESP_SLVERR, axi.RESP_OKAY)),
        ]
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
