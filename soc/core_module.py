"""halfplane_core.sv as a module of LiteX."""

from litex.soc.interconnect import axi, stream
from migen import ClockSignal, Instance, Module, ResetSignal, Signal

PIXEL = [("data", 24), ("user", 1)]  # red highest; user: the first of a frame. The last of a line is `last`
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

    def __init__(self):
        self.video = video = stream.Endpoint(PIXEL)
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
