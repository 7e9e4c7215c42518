"""scan_out: the pixels of frames that the model left in memory, bit for bit, before a memory and a display of every kind.

A frame is a file of frame_memory.cpp: the memory after the flush of a random scene, and the picture of the specification.
"""

import json
import os
import pathlib
import random
import subprocess

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, Timer

import detile

BENCH = [
    {
        "top": "scan_out", "configs": ["embedded"], "parameters": {"WIDEST": 104, "FLAGS": 1},
        "faults": [
            ("core/scan_out.sv", "if (vblank_o) begin\n      stride_q",
             "if (vblank_o || FAULT) begin\n      stride_q", "a_new_base"),
            ("core/scan_out.sv", "FLAGS != 0 && &unit_cleared",
             "FLAGS != 0 && (&unit_cleared || (FAULT && |unit_cleared))", "frames_are"),
            ("core/scan_out.sv", "arrives && scan_rerror", "arrives && scan_rerror && !FAULT", "an_error"),
            ("core/scan_out.sv", "may_fetch && !is_used_q[asked_buffer_q]",
             "may_fetch && (!is_used_q[asked_buffer_q] || FAULT)", "a_new_base"),
            ("core/scan_out.sv", "32'(band_q) & 32'(PER_TILE - 1)) == 32'(PER_TILE - 1)",
             "32'(band_q) & 32'(PER_TILE - 1)) == (FAULT ? 32'd0 : 32'(PER_TILE - 1))", "frames_are"),
            ("core/scan_out.sv", "&& is_full_q[shown_buffer_q]",
             "&& (is_full_q[shown_buffer_q] || FAULT)", "frames_are"),
            ("core/scan_out.sv", "x_q == last_x_q;", "x_q == (FAULT ? last_x_q | 1'b1 : last_x_q);", "frames_are"),
            ("core/scan_out.sv", "!is_valid_q || m_axis_video_tready;",
             "!is_valid_q || m_axis_video_tready || FAULT;", "frames_are"),
            ("core/scan_out.sv", "!clear_underrun_i && (underrun_q ||",
             "!clear_underrun_i && ((underrun_q && !FAULT) ||", "a_slow_memory"),
            ("core/scan_out.sv", "shown_cleared[UNIT_BLOCKS < 2 ? 0 : block_q]",
             "shown_cleared[UNIT_BLOCKS < 2 || FAULT ? 0 : block_q]", "frames_are"),
        ],
    },
    {
        "top": "scan_out", "configs": ["sampled"], "parameters": {"WIDEST": 104, "FLAGS": 1},
        "faults": [
            ("core/scan_out.sv", "unit_of_pixels ? 8'(PIXEL_BURST - 1)", "unit_of_pixels && !FAULT ? 8'(PIXEL_BURST - 1)", "frames_are"),
            ("core/scan_out.sv", "state_q == PIXELS ? 32'd1 <<",
             "state_q == PIXELS && !FAULT ? 32'd1 <<", "frames_are"),
            ("core/scan_out.sv", "if (asked) state_q <= COMPRESS ? PIXELS : WAIT;",
             "if (asked) state_q <= COMPRESS && !FAULT ? PIXELS : WAIT;", "an_error"),
            ("core/scan_out.sv", "32'(beat_q) & 32'(WORD_BEATS - 1)) == 32'(WORD_BEATS - 1)",
             "32'(beat_q) & 32'(WORD_BEATS - 1)) == (FAULT ? 32'd0 : 32'(WORD_BEATS - 1))", "frames_are"),
        ],
    },
    {"top": "scan_out", "configs": ["small"], "parameters": {"WIDEST": 104}, "tier": "all"},
    {"top": "scan_out", "configs": ["small", "full", "tiny", "resolved"],
     "parameters": {"WIDEST": 104, "FLAGS": 1}, "tier": "all"},
    {"top": "scan_out", "configs": ["embedded", "sampled", "full"],
     "parameters": {"WIDEST": 104, "BLANK": 7}, "tier": "all"},
]
PERIOD = 10  # ns


class Frame:
    """Of the model; its memory begins at `base`, so that several fit beside each other."""

    def __init__(self, path, base):
        with open(path, "rb") as file:
            head = json.loads(file.readline())
            self.pages = {base // head["page_bytes"] + page: file.read(head["page_bytes"]) for page in head["pages"]}
            self.page_bytes = head["page_bytes"]
            self.width, self.height = head["width"], head["height"]
            rgb = file.read()
        self.picture = [int.from_bytes(rgb[n:n + 3], "big") for n in range(0, len(rgb), 3)]
        assert len(self.picture) == self.width * self.height
        self.color_base, self.flags_base = head["color_base"] + base, head["color_flags_base"] + base
        self.stride, self.clear_color = head["row_stride"], head["clear_color"]


class Memory:
    """Bytes by address: pages of frames, and garbage elsewhere."""

    def __init__(self, frames):
        self.page_bytes = frames[0].page_bytes
        self.pages = {page: data for frame in frames for page, data in frame.pages.items()}

    def __getitem__(self, at):
        if isinstance(at, slice):
            return bytes(self[n] for n in range(at.start, at.stop))
        page = self.pages.get(at // self.page_bytes)
        return page[at % self.page_bytes] if page else at * 73 + 5 & 255

    def beat(self, address, size):
        page = self.pages.get(address // self.page_bytes)
        at = address % self.page_bytes
        return int.from_bytes(page[at:at + size] if page else self[address:address + size], "little")


def dump(config, flags, seed, width, height):
    """A frame's file, made by the model if it is not there yet."""
    program = os.environ.get("HALFPLANE_FRAME_MEMORY") or str(
        pathlib.Path(os.environ["HALFPLANE_PACKAGES"]).parents[1] / "tests/core/halfplane_frame_memory")
    label = f"{config} frame.clears={'flags' if flags else 'resolve'}"
    path = pathlib.Path(f"{label.replace(' ', '_')}_{seed}_{width}x{height}.bin")
    subprocess.run([program, label, str(seed), str(width), str(height), str(path)], check=True)
    return path


class Bench:
    """The memory and the display, cycle by cycle."""

    def __init__(self, dut):
        self.dut, self.random = dut, random.Random(cocotb.RANDOM_SEED)
        self.config = os.environ["HALFPLANE_CONFIG"]
        self.package = (pathlib.Path(os.environ["HALFPLANE_PACKAGES"]) / self.config / "raster_pkg.sv").read_text()
        self.flags = int(dut.FLAGS.value)
        self.port = len(dut.scan_rdata) // 8
        self.memory = None
        # Probabilities of a request, of an answer, and of a display's cycle that takes a pixel.
        self.asks, self.answers, self.takes, self.latency = 1.0, 1.0, 1.0, (3, 3)
        self.error_at = None  # the beat that is answered with an error
        self.cycle = self.beats = self.vblanks = self.errors = 0
        self.pending = []  # (cycle, address) of beats
        self.inputs = {}  # to be set
        self.pixels, self.starts = [], []
        self.was_asked = self.was_offered = None
        self.answered = False

    def frame(self, number, width=0, height=0, base=0):
        seed = self.random.randrange(1 << 30)
        if width == 0:
            side = 16 if self.config in ("tiny", "resolved") else 104
            width, height = self.random.randint(1, side), self.random.randint(1, 16 if side == 16 else 40)
        self.dut._log.info(f"{self.config}: frame {number}, seed {seed}, {width}x{height}")
        return Frame(dump(self.config, self.flags, seed, width, height), base)

    def frames_of(self, sizes):
        frames = [self.frame(n, *size, base=n << 28) for n, size in enumerate(sizes)]
        self.memory = Memory(frames)
        return frames

    def set(self, **inputs):
        """From the next cycle on."""
        self.inputs |= inputs

    def show(self, frame):
        self.set(color_base_i=frame.color_base, color_flags_base_i=frame.flags_base, row_stride_i=frame.stride,
                 clear_color_i=frame.clear_color, last_x_i=frame.width - 1, last_y_i=frame.height - 1)

    async def start(self):
        d = self.dut
        cocotb.start_soon(Clock(d.clk_i, PERIOD, "ns").start())
        for name in ("enable_i", "scan_arready", "scan_rvalid", "scan_rdata", "scan_rerror", "m_axis_video_tready", "clear_underrun_i"):
            getattr(d, name).value = 0
        await self.reset()

    async def reset(self):
        self.dut.rst_ni.value = 0
        self.pending, self.pixels = [], []
        self.was_asked = self.was_offered = None
        self.answered = False
        await Timer(25, "ns")
        await FallingEdge(self.dut.clk_i)
        self.dut.rst_ni.value = 1

    def chance(self, probability):
        return probability >= 1 or self.random.random() < probability

    async def step(self):
        """A clock: inputs after the falling edge, outputs before the rising one."""
        d = self.dut
        await FallingEdge(d.clk_i)
        self.cycle += 1
        for name, value in self.inputs.items():
            getattr(d, name).value = value
        self.inputs = {}
        d.scan_arready.value = int(self.chance(self.asks))
        if not self.answered and self.pending and self.pending[0][0] <= self.cycle and self.chance(self.answers):
            d.scan_rdata.value = self.memory.beat(self.pending[0][1], self.port)
            d.scan_rerror.value = int(self.beats == self.error_at)
            self.answered = True
        d.scan_rvalid.value = int(self.answered)
        d.m_axis_video_tready.value = int(self.chance(self.takes))
        await Timer(1, "ns")
        self.vblanks += int(d.vblank_o.value)
        self.errors += int(d.error_o.value)
        asked = (int(d.scan_araddr.value), int(d.scan_arlen.value)) if d.scan_arvalid.value else None
        assert self.was_asked is None or asked == self.was_asked, "a request changed before it was taken"
        self.was_asked = asked
        if asked and d.scan_arready.value:
            self.was_asked = None
            address, beats = asked[0], asked[1] + 1
            assert beats <= 16 and address % self.port == 0 and address // 4096 == (address + beats * self.port - 1) // 4096
            due = max(self.cycle + self.random.randint(*self.latency), self.pending[-1][0] if self.pending else 0)
            self.pending += [(due, address + n * self.port) for n in range(beats)]
        if self.answered and d.scan_rready.value:
            self.pending.pop(0)
            self.answered = False
            self.beats += 1
        offered = None
        if d.m_axis_video_tvalid.value:
            offered = (int(d.m_axis_video_tdata.value), int(d.m_axis_video_tlast.value), int(d.m_axis_video_tuser.value))
        assert self.was_offered is None or offered == self.was_offered, "a pixel changed before it was taken"
        self.was_offered = offered
        if offered and d.m_axis_video_tready.value:
            self.was_offered = None
            self.starts += [self.cycle] if offered[2] else []
            self.pixels.append(offered)
            self.last_pixel = self.cycle

    async def take(self, frame):
        """Runs to the last pixel of a frame, and compares it."""
        count = frame.width * frame.height
        limit = self.cycle + 80 * count + 20000
        while len(self.pixels) < count:
            await self.step()
            assert self.cycle < limit, f"{len(self.pixels)} of {count} pixels after {limit} cycles"
        self.compare(frame)
        self.pixels = self.pixels[count:]

    def compare(self, frame):
        for n, (color, last, first) in enumerate(self.pixels[:frame.width * frame.height]):
            x, y = n % frame.width, n // frame.width
            assert color == frame.picture[n], f"pixel ({x}, {y}): {color:06x}, the model has {frame.picture[n]:06x}"
            assert last == int(x == frame.width - 1), f"end of line at ({x}, {y})"
            assert first == int(n == 0), f"start of frame at ({x}, {y})"

    def any_speed(self):
        self.asks, self.answers, self.takes = (self.random.choice((1.0, 0.7, 0.2)) for _ in range(3))
        self.latency = self.random.choice(((1, 1), (1, 40), (300, 300), (10, 300)))


async def bench_of(dut):
    bench = Bench(dut)
    await bench.start()
    return bench


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def frames_are_the_models_at_any_speed(dut):
    """Six frames of random sizes and contents, each from another base, at another speed of memory and display."""
    bench = await bench_of(dut)
    frames = bench.frames_of([()] * 6)
    bench.show(frames[0])
    bench.set(enable_i=1)
    for n, frame in enumerate(frames):
        bench.any_speed()
        await bench.take(frame)
        bench.show(frames[min(n + 1, len(frames) - 1)])  # before the vertical blank, which is the next cycle at the earliest
    assert bench.vblanks == len(frames)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def a_new_base_is_taken_at_vertical_blank_alone(dut):
    """Everything changes in the middle of a frame, often; the frame stays whole, and the next one is the last that was set."""
    bench = await bench_of(dut)
    side = 16
    frames = bench.frames_of([(side, side)] * 3 + [(side - 3, side - 1)])
    shown = frames[0]
    bench.show(shown)
    bench.set(enable_i=1)
    bench.takes = 0.8
    for _ in range(4):
        before = bench.vblanks
        while bench.vblanks == before:
            await bench.step()
        following = shown
        while len(bench.pixels) < shown.width * shown.height:
            await bench.step()
            if bench.random.random() < 0.02:
                following = bench.random.choice(frames)
                bench.show(following)
        bench.compare(shown)
        bench.pixels = []
        shown = following


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def a_pixel_a_clock_leaves_when_memory_is_fast(dut):
    bench = await bench_of(dut)
    side = 16 if bench.config in ("tiny", "resolved") else 40
    (frame,) = bench.frames_of([(side, side)])
    bench.show(frame)
    bench.set(enable_i=1)
    bench.latency = (20, 20)
    colors = detile.Layout.of_package(bench.package)
    beats_a_pixel = colors.colors * colors.color_bytes / bench.port
    if beats_a_pixel >= 0.9:  # a beat a clock is not enough: memory is the limit
        await bench.take(frame)
        return
    for _ in range(2):
        await bench.take(frame)
        assert bench.last_pixel - bench.starts[-1] == side * side - 1, "the stream had gaps"
    assert dut.underrun_o.value == 0


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def a_slow_memory_is_an_underrun_until_it_is_cleared(dut):
    bench = await bench_of(dut)
    (frame,) = bench.frames_of([(16, 16)])
    bench.show(frame)
    bench.set(enable_i=1)
    bench.takes = 0.0  # a display that takes nothing before the frame begins
    for _ in range(3000):
        await bench.step()
    bench.takes, bench.latency, bench.answers = 0.1, (1, 1), 1.0
    await bench.take(frame)
    assert dut.underrun_o.value == 0
    bench.takes, bench.latency, bench.answers, bench.asks = 1.0, (300, 300), 0.05, 0.05
    bench.memory.pages = {page: bytes(len(data)) for page, data in bench.memory.pages.items()}  # no flag: all is read
    while len(bench.pixels) < 256:
        await bench.step()
    await bench.step()
    assert dut.underrun_o.value == 1
    bench.set(clear_underrun_i=1, enable_i=0)
    await bench.step()
    bench.set(clear_underrun_i=0)
    await bench.step()
    assert dut.underrun_o.value == 0


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def an_error_is_told_and_survived(dut):
    bench = await bench_of(dut)
    (frame,) = bench.frames_of([(16, 12)])
    bench.memory.pages = {page: bytes(len(data)) for page, data in bench.memory.pages.items()}
    bench.show(frame)
    bench.set(enable_i=1)
    bench.error_at = 3
    while len(bench.pixels) < 16 * 12:
        await bench.step()
        assert bench.cycle < 20000, "the frame does not end"
    assert bench.errors == 1
    assert bench.pixels[-1][1] == 1 and bench.pixels[0][2] == 1


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def without_enable_the_frame_ends_and_nothing_is_read(dut):
    bench = await bench_of(dut)
    frame, other = bench.frames_of([(16, 16), (13, 16)])
    bench.show(frame)
    await bench.step()
    assert dut.idle_o.value == 1
    bench.set(enable_i=1)
    while len(bench.pixels) < 100:
        await bench.step()
    bench.set(enable_i=0)
    bench.show(other)
    await bench.take(frame)
    for _ in range(200):
        await bench.step()
        assert not dut.scan_arvalid.value and not dut.m_axis_video_tvalid.value
    assert dut.idle_o.value == 1 and bench.vblanks == 1
    bench.set(enable_i=1)
    await bench.take(other)


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def a_reset_at_any_time_is_followed_by_a_whole_frame(dut):
    bench = await bench_of(dut)
    side = 16 if bench.config in ("tiny", "resolved") else 24
    (frame,) = bench.frames_of([(side, side)])
    bench.show(frame)
    bench.set(enable_i=1)
    for _ in range(5):
        bench.any_speed()
        for _ in range(bench.random.randint(1, 600)):
            await bench.step()
        await bench.reset()
        bench.asks, bench.answers, bench.takes, bench.latency = 1.0, 1.0, 1.0, (2, 30)
        await bench.take(frame)


@cocotb.test()
async def python_says_the_same_of_the_memory(dut):
    """examples/python/detile.py, which has nothing of the RTL, and the model's memory."""
    bench = Bench(dut)
    (frame,) = bench.frames_of([(16, 16) if bench.config in ("tiny", "resolved") else (45, 37)])
    layout = detile.Layout.of_package(bench.package, has_flags=bool(bench.flags), color_base=frame.color_base,
                                      color_flags_base=frame.flags_base, row_stride=frame.stride, clear_color=frame.clear_color)
    rows = detile.detile(bench.memory, layout, frame.width, frame.height)
    assert [r << 16 | g << 8 | b for row in rows for r, g, b in row] == frame.picture
    await Timer(1, "ns")


@cocotb.test(timeout_time=20, timeout_unit="ms")
async def what_is_read_is_what_the_layout_says(dut):
    """Beats of a frame: of units that are not cleared, fewer where they have a colour a pixel, and the flags."""
    bench = await bench_of(dut)
    side = 16 if bench.config in ("tiny", "resolved") else 40
    (frame,) = bench.frames_of([(side - 1, side - 5)])
    bench.show(frame)
    bench.set(enable_i=1)
    await bench.take(frame)
    bench.set(enable_i=0)
    layout = detile.Layout.of_package(bench.package, has_flags=bool(bench.flags), color_flags_base=frame.flags_base)
    unit = layout.block if layout.compresses else layout.tile  # pixels along it
    beats = 0
    for y in range(0, frame.height, layout.block):
        for x in range(0, -(-frame.width // layout.tile) * layout.tile, unit):
            if all(layout.is_cleared(bench.memory, x + n, y) for n in range(0, unit, layout.block)):
                continue
            colors = 1 if layout.has_pixel_colors(bench.memory, x, y) else layout.colors
            beats += max(1, unit * layout.block * colors * layout.color_bytes // bench.port)
        words = -(-(-(-frame.width // layout.tile) * layout.tile // layout.block) // (8 * bench.port))
        beats += words * (int(layout.has_flags) + int(layout.compresses))
    assert bench.beats == beats
