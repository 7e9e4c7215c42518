"""A display: pixels of the core in the time of a screen, with its sync signals, in front of a PHY of LiteX."""

from core_module import PIXEL
from litex.soc.cores.video import VideoTimingGenerator, video_data_layout
from litex.soc.interconnect import stream
from migen import ClockDomainsRenamer, If, Module, Mux, Signal

SIMULATED = {
    "pix_clk": 0,
    "h_active": 96,
    "h_blanking": 32,
    "h_sync_offset": 8,
    "h_sync_width": 8,
    "v_active": 72,
    "v_blanking": 8,
    "v_sync_offset": 2,
    "v_sync_width": 2,
}


class Display(Module):
    """A pixel that is late is black, and pixels are in step again from the next vertical sync on: what is left of the old
    frame is thrown away there. A frame begins in the screen's first pixel; one that is late there waits for the next screen."""

    def __init__(self, timings, clock_domain="sys"):
        self.sink = stream.Endpoint(PIXEL)
        self.source = source = stream.Endpoint(video_data_layout)
        self.is_pixel = Signal()  # source is a pixel of the core
        self.submodules.timing = ClockDomainsRenamer(clock_domain)(VideoTimingGenerator(timings))
        self.submodules.crossing = stream.ClockDomainCrossing(PIXEL, cd_from="sys", cd_to=clock_domain, depth=16)
        time, self.pixel = self.timing.source, self.crossing.source
        pixel, is_first, in_frame = self.pixel, Signal(), Signal()
        self.comb += [
            self.sink.connect(self.crossing.sink),
            source.valid.eq(time.valid),
            time.ready.eq(source.ready),
            source.hsync.eq(time.hsync),
            source.vsync.eq(time.vsync),
            source.de.eq(time.de),
            self.is_pixel.eq(time.de & pixel.valid & Mux(pixel.user, is_first, in_frame)),
            If(self.is_pixel, source.r.eq(pixel.data[16:]), source.g.eq(pixel.data[8:16]), source.b.eq(pixel.data[:8])),
            pixel.ready.eq((self.is_pixel & source.valid & source.ready) | (~in_frame & ~pixel.user)),
        ]
        sync = getattr(self.sync, clock_domain)
        sync += If(time.vsync, is_first.eq(1), in_frame.eq(0)).Elif(
            time.de & source.valid & source.ready, is_first.eq(0), If(is_first, in_frame.eq(self.is_pixel))
        )
