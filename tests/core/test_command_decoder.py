"""command_decoder alone: packets of the model come back from their words, and wrong words stop it."""

import os
import pathlib
import random
import subprocess

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, ReadOnly, RisingEdge
from command_words import (
    COMMAND,
    ERROR,
    FAST_CLEAR,
    FLUSH,
    LINE,
    POINT,
    RECTANGLE,
    REGISTER,
    STATE,
    TRIANGLE,
    Encoder,
    Package,
    encode,
    read_hex,
)

BENCH = {
    "top": "command_decoder",
    "configs": ["embedded", "textured"],
    "sources": ["core/core_pkg.sv"],
    "faults": [
        # A turned triangle faces as if it were not.
        ("core/command_decoder.sv", "state_bits_q[7] ^ flags_q[3]", "state_bits_q[7] ^ (flags_q[3] && !FAULT)", "a_strip"),
        # Slots after the first loaded one are not loaded.
        ("core/command_decoder.sv", "loads_q & (loads_q - 3'd1)", "loads_q & (loads_q - 3'd1) & {3{!FAULT}}", "packets_of"),
        # Codes of a box come to its first vertex alone.
        ("core/command_decoder.sv", "(is_broadcast && FIRST != w", "(is_broadcast && !FAULT && FIRST != w", "packets_of"),
        # A header is taken while the line before it waits.
        ("core/command_decoder.sv", "(primitive_valid_q && !primitive_ready_i) ||", "(primitive_valid_q && !primitive_ready_i && !FAULT) ||",
         "packets_of"),
        # A register more, or less, is set.
        ("core/command_decoder.sv", "if (rest_q == 4'd1) state_q", "if (rest_q == (FAULT ? 4'd2 : 4'd1)) state_q", "packets_of"),
        # The vertices of a box keep a triangle's values.
        ("core/command_decoder.sv", "(IN_SLOT ? !is_triangle && FIRST == 0", "(IN_SLOT ? !is_triangle && FIRST == 0 && !FAULT", "packets_of"),
        # A fence, or a picture, is reported at once.
        ("core/command_decoder.sv", "fence_waits_q && fence_left_q == '0", "fence_waits_q && (fence_left_q == '0 || FAULT)", "a_fence"),
        ("core/command_decoder.sv", "present_waits_q && present_left_q == '0", "present_waits_q && (present_left_q == '0 || FAULT)", "a_fence"),
        # A second fence takes the place of the first.
        ("core/command_decoder.sv", "is_open = !fence_waits_q", "is_open = !fence_waits_q || FAULT", "a_fence"),
        ("core/command_decoder.sv", "is_open = !present_waits_q", "is_open = !present_waits_q || FAULT", "vblank"),
        # A layout changes while primitives are in flight.
        ("core/command_decoder.sv", "drawn_q || (idle_i &&", "drawn_q || ((idle_i || FAULT) &&", "a_layout"),
        ("core/command_decoder.sv", "&& flushes_q == '0);", "&& (flushes_q == '0 || FAULT));", "a_layout"),
        # A fourth flush is sent.
        ("core/command_decoder.sv", "is_open = flushes_q != '1", "is_open = flushes_q != '1 || FAULT", "four"),
        # Wrong words are not seen.
        ("core/command_decoder.sv", "!UNIT_REGISTERS[word_i[2:0]]", "!UNIT_REGISTERS[word_i[2:0]] && !(FAULT && word_i[2:0] == 3'd7)",
         "wrong_word"),
        ("core/command_decoder.sv", "reserved = word_i[23:12] != '0 ||", "reserved = (word_i[23:12] != '0 && !FAULT) ||", "wrong_word"),
        ("core/command_decoder.sv", "bottom_q < top_q ||", "(bottom_q < top_q && !FAULT) ||", "wrong_word"),
        ("core/command_decoder.sv", "STATE_REGISTER_TARGET)) cleared_q <= 1'b0;", "STATE_REGISTER_TARGET)) cleared_q <= cleared_q && FAULT;",
         "wrong_word"),
        ("core/command_decoder.sv", "if (word_error_i) error", "if (word_error_i && !FAULT) error", "wrong_word"),
        ("core/command_decoder.sv", "> 5'(core_pkg::STATE_REGISTERS)", "> 5'(core_pkg::STATE_REGISTERS) + 5'(FAULT)", "wrong_word"),
        # An error does not stop the stream, is forgotten, or its place is that of the command.
        ("core/command_decoder.sv", "ERROR_STUCK;\n        running_q <= 1'b0;",
         "ERROR_STUCK;\n        running_q <= FAULT;", "wrong_word"),
        ("core/command_decoder.sv", "start_i && error_q == core_pkg::ERROR_NONE", "start_i && (error_q == core_pkg::ERROR_NONE || FAULT)", "wrong_word"),
        ("core/command_decoder.sv", "words_q + 32'(takes)", "words_q + 32'(takes && !(FAULT && state_q != HEADER))", "wrong_word"),
        # A stop cuts a command in two.
        ("core/command_decoder.sv", "if (stops_q && state_q == HEADER)", "if (stops_q && (state_q == HEADER || FAULT))", "a_stop"),
    ],
}

PROGRAM = os.environ["HALFPLANE_PROGRAM"]
PACKAGES = pathlib.Path(os.environ["HALFPLANE_PACKAGES"])


def config_of(_dut):
    return os.environ["HALFPLANE_CONFIG"]


def packets_of(config, *scene):
    """Packets into cull, and setups into line_raster, of a scene."""
    found = []
    for stage, name in (("cull", "primitive"), ("line_raster", "line")):
        folder = pathlib.Path(f"{name}_{config}_{'_'.join(scene).replace('/', '_')}")
        subprocess.run([PROGRAM, "vectors", *scene, "--config", config, "--stage", stage, "--format", "hex", "--quiet", "-o", folder],
                       check=True)
        found.append(read_hex(folder / f"{name}.hex"))
    return found


class Bench:
    """Plays memory's side (idle, flushed), raster_top's and scan-out's; keeps what comes out."""

    def __init__(self, dut, words=1.0, takes=1.0):
        self.dut, self.random = dut, random.Random(cocotb.RANDOM_SEED)
        self.package = Package(PACKAGES / config_of(dut) / "raster_pkg.sv")
        self.word_rate, self.take_rate = words, takes
        self.queue, self.packets, self.lines, self.fences, self.presents, self.layouts = [], [], [], [], [], []
        self.cycle, self.flushes, self.flush_answers, self.busy_until = 0, 0, True, 0
        self.flush_due, self.idles, self.shows, self.latency = [], True, True, 3
        self.entered = []  # cycle of each packet

    async def start(self):
        d = self.dut
        for name in ("start_i", "stop_i", "word_valid_i", "word_error_i", "is_owed_i", "primitive_ready_i", "line_ready_i", "flushed_i",
                     "moves_i", "present_ready_i"):
            getattr(d, name).value = 0
        d.word_i.value, d.idle_i.value, d.rst_ni.value = 0, 1, 0
        cocotb.start_soon(Clock(d.clk_i, 2, "ns").start())
        await self.reset()
        self.task = cocotb.start_soon(self.run())
        await self.pulse(d.start_i)

    async def reset(self):
        self.dut.rst_ni.value = 0
        await FallingEdge(self.dut.clk_i)
        await FallingEdge(self.dut.clk_i)
        self.dut.rst_ni.value = 1
        self.queue.clear()
        self.flush_due.clear()

    async def pulse(self, signal):
        await FallingEdge(self.dut.clk_i)
        signal.value = 1
        await FallingEdge(self.dut.clk_i)
        signal.value = 0

    async def run(self):
        """Inputs change at the falling edge; what moves at the rising edge is read just before it."""
        d, roll = self.dut, self.random.random
        while True:
            await FallingEdge(d.clk_i)
            offered = bool(self.queue) and (bool(d.word_valid_i.value) and not self.moved_word or roll() < self.word_rate) \
                if self.cycle else bool(self.queue)
            d.word_valid_i.value = offered
            if offered:
                word = self.queue[0]
                d.word_error_i.value = isinstance(word, tuple)
                d.word_i.value = word[0] if isinstance(word, tuple) else word
            d.primitive_ready_i.value = roll() < self.take_rate
            d.line_ready_i.value = roll() < self.take_rate
            done = bool(self.flush_due) and self.flush_due[0] <= self.cycle and self.flush_answers
            d.flushed_i.value = done
            if done:
                self.flush_due.pop(0)
            d.idle_i.value = self.idles and self.busy_until <= self.cycle
            d.present_ready_i.value = self.shows
            await ReadOnly()
            reset = d.rst_ni.value == 0
            self.moved_word = offered and d.word_ready_o.value == 1 and not reset
            if self.moved_word:
                self.queue.pop(0)
            if d.primitive_valid_o.value == 1 and d.primitive_ready_i.value == 1 and not reset:
                packet = int(d.primitive_o.value)
                self.packets.append(packet)
                self.entered.append(self.cycle)
                self.busy_until = self.cycle + self.latency
                if packet >> self.package.PRIMITIVE_PACKET_BITS - 3 == FLUSH:
                    self.flush_due.append(self.cycle + self.latency)
            if d.line_valid_o.value == 1 and d.line_ready_i.value == 1 and not reset:
                self.lines.append(int(d.line_o.value))
            if d.fence_valid_o.value == 1 and not reset:
                self.fences.append((int(d.fence_o.value), self.cycle))
            if d.present_valid_o.value == 1 and d.present_ready_i.value == 1 and not reset:
                self.presents.append((int(d.present_color_base_o.value), int(d.present_color_flags_base_o.value), self.cycle))
            await RisingEdge(d.clk_i)
            self.cycle += 1

    moved_word = False

    async def settle(self, limit=100000):
        """Until all words are taken and nothing comes out any more, or the decoder has stopped."""
        quiet = 0
        for _ in range(limit):
            await FallingEdge(self.dut.clk_i)
            await ReadOnly()
            busy = (self.queue and self.dut.is_running_o.value == 1) or self.dut.primitive_valid_o.value == 1 or self.dut.line_valid_o.value == 1
            quiet = 0 if busy else quiet + 1
            if quiet > 12:
                return
        raise AssertionError(f"the decoder does not come to an end, {len(self.queue)} words wait")

    def error(self):
        return int(self.dut.error_o.value)


def clear(package, right=63, bottom=63):
    e = Encoder(package)
    e.set(dict(TARGET=right | bottom << 16))
    e.command("CLEAR", 3, [0] * package.affine_words)
    return e


def meaning(package, packet):
    """What hardware makes of a packet: without the order of vertices but with the side that faces."""
    f = package.unpack(packet)
    kind, key = f["kind"], {"kind": f["kind"]}
    names = [name for name, _ in package.fields()[6:] if name not in ("cull", "front_cw", "x", "y", "code", "coordinates")]
    key.update({name: f[name] for name in names})
    bits = (1 << package.ALL_AFFINE_CODE_BITS) - 1
    if kind in (TRIANGLE, RECTANGLE, POINT, FAST_CLEAR, FLUSH):
        key["box"] = tuple(f[side] for side in ("left", "top", "right", "bottom"))
    if kind == TRIANGLE:
        vertices = f["vertices"]
        order = sorted(range(3), key=lambda i: vertices[i])
        odd = order in ([0, 2, 1], [2, 1, 0], [1, 0, 2])
        key.update(cull=f["cull"], front=f["front_cw"] ^ odd, vertices=[vertices[i] for i in order], frame=f["coordinates"])
        if len(set(vertices)) < 3:  # no area
            key["front"] = 0
    elif kind == STATE:
        words = {c | o << package.ALL_AFFINE_CODE_BITS for _, _, c, o in f["vertices"]}
        key["word"] = {w & (1 << package.STATE_WORD_BITS) - 1 for w in words}
    elif kind not in (LINE, FLUSH):
        key["codes"] = {(x, y, c & bits, o) for x, y, c, o in f["vertices"]}
    return key


async def compare(dut, scene, rates):
    bench = Bench(dut, *rates)
    config, package = config_of(dut), bench.package
    packets, lines = packets_of(config, *scene)
    encoder = Encoder(package)
    random_ = random.Random(cocotb.RANDOM_SEED + 1)
    encoder.set({name: random_.getrandbits(20 if name == "ROW_STRIDE" else 32) for name in list(REGISTER)[4:]})
    if packets[0] >> package.PRIMITIVE_PACKET_BITS - 3 != FAST_CLEAR:
        encoder.words += clear(package, 1919, 1079).words  # --random draws at once
        encoder.registers["TARGET"] = 1919 | 1079 << 16
        packets_out = 1
    else:
        packets_out = 0
    await bench.start()
    bench.queue += encode(encoder, packets, lines)
    await bench.settle(limit=60 * len(bench.queue) + 1000)
    assert bench.error() == 0, f"error {bench.error()} after {int(dut.words_o.value)} words"
    assert int(dut.words_o.value) == len(encoder.words)
    got = bench.packets[packets_out:]
    assert len(got) == len(packets), f"{len(got)} packets came of {len(packets)}"
    for n, (mine, model) in enumerate(zip(got, packets)):
        assert meaning(package, mine) == meaning(package, model), f"packet {n}: {meaning(package, mine)}, model {meaning(package, model)}"
    mask = (1 << package.LINE_SETUP_BITS - package.PRIMITIVE_ID_BITS) - 1
    assert bench.package.COORDINATES or scene[0] == "--random" or len(lines) > 20
    assert bench.lines == [line & mask for line in lines]
    layout = int(dut.layout_o.value)
    r, stride = encoder.registers, package.ROW_STRIDE_BITS
    assert layout == (r["DEPTH_BASE"] << 96 | r["COLOR_BASE"] << 64 | r["DEPTH_FLAGS_BASE"] << 32 | r["COLOR_FLAGS_BASE"]) << stride | \
        r["ROW_STRIDE"] & (1 << stride) - 1
    assert int(dut.texture_base_o.value) == r["TEXTURE_BASE"] >> 12
    return bench, encoder


@cocotb.test()
async def packets_of_a_scene_are_those_of_the_model(dut):
    scene = ("layers_linear:6",) if config_of(dut) == "textured" else ("wires:6",)
    await compare(dut, (*scene, "--size", "64x64"), (1.0, 1.0))


@cocotb.test()
async def packets_of_random_primitives_are_those_of_the_model(dut):
    await compare(dut, ("--random", "60", "--seed", str(cocotb.RANDOM_SEED % 1000)), (0.7, 0.6))


@cocotb.test()
async def a_strip_costs_one_vertex_and_its_words_a_triangle(dut):
    bench = Bench(dut)
    package = bench.package
    await bench.start()
    e = clear(package)
    e.set(dict(BOX_MIN=0, BOX_MAX=63 | 63 << 16, STATE=0x19))
    start = len(e.words)
    roll = random.Random(cocotb.RANDOM_SEED)
    over = (1 << package.ALL_CODE_BITS - package.ALL_AFFINE_CODE_BITS) - 1
    vertices = [(roll.getrandbits(10), roll.getrandbits(10), roll.getrandbits(package.ALL_AFFINE_CODE_BITS)) for _ in range(22)]
    for i in range(20):
        f = dict(kind=TRIANGLE, left=0, top=0, right=63, bottom=63, depth_test=1, depth_write=1, color_write=1, cull=0, front_cw=0,
                 vertices=[(*vertices[n], roll.getrandbits(200) & over) for n in ((i + 1, i, i + 2) if i % 2 else (i, i + 1, i + 2))],
                 coordinates=over and 5)
        e.triangle(f)
    bench.queue += e.words
    await bench.settle()
    words = (len(e.words) - start - 2 * (1 + package.affine_words)) / 20
    dut._log.info("%s: %.2f words a triangle of a strip, %.2f cycles", config_of(dut), words,
                  (bench.entered[-1] - bench.entered[1]) / 19)
    assert words <= (20 if over else 12)
    assert bench.entered[-1] - bench.entered[1] == 19 * words, "a word is not taken in every cycle"
    for i, packet in enumerate(bench.packets[1:]):
        f = package.unpack(packet)
        order = [vertices[i:i + 3].index(vertex[:3]) for vertex in f["vertices"]]
        assert f["front_cw"] ^ (order in ([0, 2, 1], [2, 1, 0], [1, 0, 2])) == i % 2, f"triangle {i} faces the other way"


@cocotb.test()
async def a_fence_comes_when_its_flush_is_in_memory_and_the_stream_goes_on(dut):
    bench = Bench(dut)
    await bench.start()
    e = clear(bench.package)
    e.command("FENCE", 0, [11])          # nothing to wait for
    e.command("FLUSH")
    e.command("FENCE", 0, [22])
    e.command("PRESENT", 0, [0x1000, 0x2000])
    e.command("CLEAR", 3, [1] * bench.package.affine_words)  # the next frame
    e.command("FLUSH")
    e.command("FENCE", 0, [33])          # waits for 22
    e.command("STOP")
    bench.flush_answers = False
    bench.queue += e.words
    for _ in range(100):
        await FallingEdge(dut.clk_i)
    assert [tag for tag, _ in bench.fences] == [11] and not bench.presents
    assert len(bench.packets) == 4, "the next frame is not drawn while the fence waits"
    assert len(bench.queue) == 3, "the second fence does not wait in the stream"
    bench.flush_due[1] = 1 << 60         # the second flush stays away
    bench.flush_answers = True
    await bench.settle()
    assert [tag for tag, _ in bench.fences] == [11, 22] and [p[:2] for p in bench.presents] == [(0x1000, 0x2000)]
    assert dut.is_running_o.value == 0 and dut.is_written_o.value == 0, "STOP, and a flush is under way"
    bench.flush_due[0] = 0
    for _ in range(10):
        await FallingEdge(dut.clk_i)
    assert [tag for tag, _ in bench.fences] == [11, 22, 33] and dut.is_written_o.value == 1


@cocotb.test()
async def wait_for_vblank_waits_for_what_is_shown(dut):
    bench = Bench(dut)
    await bench.start()
    e = clear(bench.package)
    e.command("WAIT_VBLANK")             # nothing is presented
    e.command("FLUSH")
    e.command("PRESENT", 0, [1, 2])
    e.command("WAIT_VBLANK")
    e.command("CLEAR", 3, [1] * bench.package.affine_words)
    bench.shows = False
    bench.queue += e.words
    for _ in range(60):
        await FallingEdge(dut.clk_i)
    assert len(bench.packets) == 2 and len(bench.queue) == 2 + bench.package.affine_words, "the clear does not wait"
    bench.shows = True
    await bench.settle()
    assert len(bench.packets) == 3 and len(bench.presents) == 1


@cocotb.test()
async def a_layout_waits_until_everything_is_in_memory_and_a_box_does_not(dut):
    bench = Bench(dut)
    await bench.start()
    e = clear(bench.package)
    e.command("FLUSH")
    e.set(dict(BOX_MIN=1))
    before = len(e.words)
    e.set(dict(COLOR_BASE=0x4000))
    bench.flush_answers = False
    bench.queue += e.words
    for idle, answers in ((True, False), (False, True)):  # one without the other is not enough
        bench.idles, bench.flush_answers = idle, answers
        for _ in range(40):
            await FallingEdge(dut.clk_i)
        assert len(e.words) - len(bench.queue) == before + 1, "the base, and it alone, does not wait"
    bench.idles = True
    await bench.settle()
    assert int(dut.layout_o.value) >> 64 + bench.package.ROW_STRIDE_BITS & 0xFFFFFFFF == 0x4000


@cocotb.test()
async def four_flushes_are_never_under_way(dut):
    bench = Bench(dut)
    await bench.start()
    e = clear(bench.package)
    for _ in range(5):
        e.command("FLUSH")
    bench.flush_answers = False
    bench.queue += e.words
    for _ in range(40):
        await FallingEdge(dut.clk_i)
    assert len(bench.packets) == 4 and len(bench.queue) == 2
    bench.flush_answers = True
    await bench.settle()
    assert len(bench.packets) == 6 and bench.error() == 0


def wrong_words(package):
    """(what, words after a clear of 64x64 and a box in it, error); the last word taken is the wrong one."""
    codes = [0] * package.affine_words
    op = lambda name, header=0: COMMAND[name] << 24 | header
    set_ = lambda name, value: [op("SET", REGISTER[name] | 1 << 8), value]
    yield "an opcode that is none", [0x06000000], "UNKNOWN_OPCODE"
    yield "an opcode between primitives", [0x15000000], "UNKNOWN_OPCODE"
    yield "an opcode beyond all", [0xFF000000], "UNKNOWN_OPCODE"
    yield "a bit of NOP", [op("NOP", 1)], "RESERVED"
    yield "a bit of FLUSH", [op("FLUSH", 2)], "RESERVED"
    yield "a bit of TRIANGLE", [op("TRIANGLE", 32)], "RESERVED"
    yield "a high bit of TRIANGLE", [op("TRIANGLE", 7 | 1 << 23)], "RESERVED"
    yield "a bit of RECTANGLE", [op("RECTANGLE", 1 << 8)], "RESERVED"
    yield "a clear of nothing", [op("CLEAR", 0)], "RESERVED"
    yield "a bin's clear of depth", [op("CLEAR", 7)], "RESERVED"
    yield "SET of no register", [op("SET", 0)], "BAD_REGISTER"
    yield "SET beyond the last", [op("SET", 9 | 2 << 8)], "BAD_REGISTER"
    yield "SET far beyond the last", [op("SET", 15 | 15 << 8)], "BAD_REGISTER"
    yield "a base without a flush", [op("RECTANGLE"), *codes, op("SET", 4 | 1 << 8), 0], "NOT_FLUSHED"
    yield "a target without a flush", [op("RECTANGLE"), *codes, op("SET", 3 | 1 << 8), 0], "NOT_FLUSHED"
    yield "drawing in a new target", [op("FLUSH"), *set_("TARGET", 7 | 7 << 16), op("RECTANGLE")], "NO_CLEAR"
    yield "a flush of a new target", [op("FLUSH"), *set_("TARGET", 7 | 7 << 16), op("FLUSH")], "NO_CLEAR"
    yield "half a clear of a new target", [op("FLUSH"), *set_("TARGET", 7 | 7 << 16), op("CLEAR", 1)], "NO_CLEAR"
    yield "a box beyond the right side", [*set_("BOX_MAX", 64 | 63 << 16), op("TRIANGLE", 7)], "BAD_BOX"
    yield "a box beyond the bottom", [*set_("BOX_MAX", 63 | 64 << 16), op("POINT")], "BAD_BOX"
    yield "a box inverted in x", [*set_("BOX_MIN", 60), op("RECTANGLE")], "BAD_BOX"
    yield "a box inverted in y", [*set_("BOX_MIN", 60 << 16), op("RECTANGLE")], "BAD_BOX"
    yield "a bin inverted", [*set_("BOX_MIN", 60 << 16), op("CLEAR", 6)], "BAD_BOX"
    for register in set(range(8)) - package.unit_registers:
        yield f"register {register} of a unit that is not there", [op("STATE", register)], "NOT_SUPPORTED"
    if package.COORDINATES == 0:
        yield "coordinates without textures", [op("TRIANGLE", 7 | 16)], "NOT_SUPPORTED"
    yield "an error of the bus in a header", [(op("NOP"), 1)], "BUS"
    yield "an error of the bus in codes", [op("RECTANGLE"), (0, 1)], "BUS"


@cocotb.test()
async def a_wrong_word_stops_the_stream_and_reset_begins_it_anew(dut):
    bench = Bench(dut, 0.8, 0.8)
    await bench.start()
    for what, words, error in wrong_words(bench.package):
        bench.packets.clear()
        e = clear(bench.package)
        e.set(dict(BOX_MIN=2 | 3 << 16, BOX_MAX=40 | 50 << 16))
        bench.queue += [*e.words, *words, COMMAND["FLUSH"] << 24, COMMAND["FLUSH"] << 24]
        await bench.settle()
        assert bench.error() == ERROR[error], f"{what}: error {bench.error()}, not {error}"
        assert int(dut.words_o.value) == len(e.words) + len(words), f"{what}: stopped at word {int(dut.words_o.value)}"
        assert dut.is_running_o.value == 0 and len(bench.queue) == 2, what
        drawn = sum(w >> 24 in (COMMAND["RECTANGLE"], COMMAND["FLUSH"]) for w in words[:-1]) if error != "BUS" else 0
        assert len(bench.packets) == 1 + drawn, f"{what}: {len(bench.packets)} packets"
        await bench.pulse(dut.start_i)
        await bench.settle()
        assert dut.is_running_o.value == 0, f"{what}: an error is gone without a reset"
        await FallingEdge(dut.clk_i)
        await bench.reset()
        await bench.pulse(dut.start_i)
        assert bench.error() == 0 and int(dut.words_o.value) == 0
    bench.queue += [COMMAND["RECTANGLE"] << 24]
    await bench.settle()
    assert bench.error() == ERROR["NO_CLEAR"], "drawing before the first clear"


@cocotb.test()
async def a_stop_waits_for_the_end_of_a_command_and_start_goes_on(dut):
    bench = Bench(dut)
    await bench.start()
    e = clear(bench.package)
    bench.queue += e.words[:3]  # the header of CLEAR and no codes
    await bench.settle()
    await bench.pulse(dut.stop_i)
    assert dut.is_running_o.value == 1
    bench.queue += [*e.words[3:], COMMAND["FLUSH"] << 24]
    await bench.settle()
    assert dut.is_running_o.value == 0 and len(bench.queue) == 1 and len(bench.packets) == 1
    await bench.pulse(dut.start_i)
    await bench.settle()
    assert len(bench.packets) == 2 and dut.is_written_o.value == 1
    await bench.pulse(dut.stop_i)
    await bench.settle()
    assert dut.is_running_o.value == 0
