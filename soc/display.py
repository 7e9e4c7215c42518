"""A display: pixels of the core in the time of a screen, with its sync signals, and as TMDS on a connector's pads."""

from core_module import PIXEL
from litex.build.io import DDROutput
from litex.soc.cores.code_tmds import TMDSEncoder
from litex.soc.cores.video import VideoTimingGenerator, video_data_layout
from litex.soc.interconnect import stream
from migen import Cat, ClockDomainsRenamer, ClockSignal, If, Module, Mux, Signal

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


class Gearbox(Module):
    """Words of ten bits, one a channel and pixel, as pairs of bits in the domain of five times the clock, the least
    first. A pair is in flip-flops, so the wire to the pad has a cycle of its own."""

    def __init__(self, channels, clock_domain):
        fast, width = clock_domain + "5x", 10 * channels
        self.words = Signal(width)  # channel 0 lowest
        self.pairs = [Signal(2) for _ in range(channels)]
        self.submodules.crossing = stream.ClockDomainCrossing([("data", width)], cd_from=clock_domain, cd_to=fast)
        words, turn = self.crossing.source, Signal(5, reset=1)
        self.comb += [self.crossing.sink.valid.eq(1), self.crossing.sink.data.eq(self.words), words.ready.eq(turn[0])]
        sync = getattr(self.sync, fast)
        sync += turn.eq(Cat(turn[-1], turn[:-1]))
        for channel, pair in enumerate(self.pairs):
            bits = Signal(10)
            sync += If(turn[0], bits.eq(words.data[10 * channel : 10 * channel + 10])).Else(bits.eq(bits[2:]))
            self.comb += pair.eq(bits[:2])


class Tmds(Module):
    """Blue, green and red as channels 0, 1, 2. LiteX's VideoHDMIPHY is the same with five LUTs between the flip-flops of
    a gearbox and its pad."""

    def __init__(self, pads, clock_domain):
        self.sink = sink = stream.Endpoint(video_data_layout)
        self.submodules.gearbox = gearbox = Gearbox(3, clock_domain)
        encoders = [ClockDomainsRenamer(clock_domain)(TMDSEncoder()) for _ in range(3)]
        self.submodules += encoders
        self.comb += [sink.ready.eq(1), gearbox.words.eq(Cat(*(encoder.out for encoder in encoders)))]
        self.comb += encoders[0].c.eq(Cat(sink.hsync, sink.vsync))
        self.specials += DDROutput(1, 0, pads.clk_p, ClockSignal(clock_domain))
        for channel, (encoder, color) in enumerate(zip(encoders, (sink.b, sink.g, sink.r))):
            pad, (first, second) = getattr(pads, f"data{channel}_p"), gearbox.pairs[channel]
            self.comb += [encoder.d.eq(color), encoder.de.eq(sink.de)]
            self.specials += DDROutput(first, second, pad, ClockSignal(clock_domain + "5x"))
