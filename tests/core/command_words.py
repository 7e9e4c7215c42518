"""Command words for the core, from the packets of `halfplane vectors --format hex`, and pictures back from memory.

    package = Package("build/ci/rtl_ref/packages/embedded/raster_pkg.sv")
    words = scene_words(package, layout, packets, lines)  # docs/core.md has the stream

Everything follows from the constants of raster_pkg.sv and from core/stream.toml.
"""

import itertools
import pathlib
import re
import tomllib

STREAM = tomllib.loads((pathlib.Path(__file__).resolve().parents[2] / "core/stream.toml").read_text())
COMMAND = {command["name"]: command["opcode"] for command in STREAM["command"]}
REGISTER = {register["name"]: number for number, register in enumerate(STREAM["state_register"])}
ERROR = {error["name"]: number for number, error in enumerate(STREAM["error"])}
TRIANGLE, RECTANGLE, FAST_CLEAR, FLUSH, POINT, LINE, STATE = 0, 1, 2, 3, 4, 6, 7  # primitive_kind_t
NEVER, EQUAL = 0, 3  # depth_func_t


class Package:
    """The constants of a raster_pkg.sv, as attributes."""

    def __init__(self, file):
        for name, value in re.findall(r"localparam (?:int|logic \[63:0\]) (\w+) = ([\w']+);", pathlib.Path(file).read_text()):
            setattr(self, name, int(value.replace("64'h", "0x"), 0))
        affine, codes = self.ALL_AFFINE_CODE_BITS, self.ALL_CODE_BITS
        self.affine_words = words_of(affine)
        self.over_words = words_of(codes - affine)
        self.frame_words = words_of(self.COORDINATE_FRAME_BITS)
        self.state_words = words_of(max(self.STATE_WORD_BITS - affine, 0))
        self.line_words = words_of(self.LINE_SETUP_BITS - self.PRIMITIVE_ID_BITS) if self.LINES_UNIT else 0
        tests_alpha = self.ALPHA_UNIT and self.CACHE_KIND == 1 and self.SETUP_KIND == 0
        # state_register_t: whose unit is there
        self.unit_registers = {*((0, 1, 2) if self.COORDINATES else ()), *((3, 7) if self.STENCIL_BITS else ()),
                               *((4, 5) if self.BLEND_LANES or self.DITHER_UNIT else ()), *((6,) if tests_alpha else ())}

    def fields(self):
        """(name, bits) of primitive_packet_t, highest first."""
        c, codes = self.COORDINATE_BITS, self.ALL_CODE_BITS
        stencil = [(name, 1) for name in ("tests_stencil", "writes_stencil", "marks_failed", "is_back")] if self.STENCIL_BITS else []
        samples = [("masked_samples", self.MSAA_SAMPLES)] if self.MSAA_SAMPLES > 1 else []
        return [("kind", 3), ("primitive_id", self.PRIMITIVE_ID_BITS), ("left", self.PIXEL_X_BITS), ("top", self.PIXEL_Y_BITS),
                ("right", self.PIXEL_X_BITS), ("bottom", self.PIXEL_Y_BITS), ("depth_test", 3), ("depth_write", 1),
                ("color_write", 1), *stencil, *samples, ("cull", 2), ("front_cw", 1), ("x", 3 * c), ("y", 3 * c),
                ("code", 3 * codes), ("coordinates", self.COORDINATE_FRAME_BITS)]

    def unpack(self, packet):
        """A dictionary of the fields; `vertices`: of each (x, y, affine codes, codes over w)."""
        fields, c, codes, affine = {}, self.COORDINATE_BITS, self.ALL_CODE_BITS, self.ALL_AFFINE_CODE_BITS
        for name, bits in reversed(self.fields()):
            fields[name] = packet & (1 << bits) - 1
            packet >>= bits
        assert packet == 0, "the packet is not of this configuration"
        part = lambda name, i, bits: fields[name] >> i * bits & (1 << bits) - 1
        fields["vertices"] = []
        for i in range(3):
            code = part("code", i, codes)
            fields["vertices"].append((part("x", i, c), part("y", i, c), code & (1 << affine) - 1, code >> affine))
        return fields


def words_of(bits):
    return (bits + 31) // 32


def split(value, words):
    return [value >> 32 * i & 0xFFFFFFFF for i in range(words)]


class Encoder:
    """Packets to words; sends state registers that differ and vertices that no slot has."""

    def __init__(self, package):
        self.package = package
        self.words = []
        self.registers = {}
        self.slots = [None] * 3
        self.triangles = 0

    def command(self, name, header=0, words=()):
        self.words += [COMMAND[name] << 24 | header, *words]

    def set(self, values):
        """{register: value}, those that differ; neighbours share a header."""
        new = sorted((REGISTER[name], value) for name, value in values.items() if self.registers.get(name) != value)
        self.registers.update(values)
        while new:
            run = [new.pop(0)]
            while new and new[0][0] == run[-1][0] + 1:
                run.append(new.pop(0))
            self.command("SET", run[0][0] | len(run) << 8, [value for _, value in run])

    def layout(self, depth, color, depth_flags, color_flags, stride):
        self.set(dict(DEPTH_BASE=depth, COLOR_BASE=color, DEPTH_FLAGS_BASE=depth_flags, COLOR_FLAGS_BASE=color_flags, ROW_STRIDE=stride))

    def box(self, f):
        self.set(dict(BOX_MIN=f["left"] | f["top"] << 16, BOX_MAX=f["right"] | f["bottom"] << 16))

    def state(self, f):
        bits = f["depth_test"] | f["depth_write"] << 3 | f["color_write"] << 4 | f["cull"] << 5 | f["front_cw"] << 7
        if self.package.STENCIL_BITS:
            bits |= f["tests_stencil"] << 8 | f["writes_stencil"] << 9 | f["marks_failed"] << 10 | f["is_back"] << 11
        if self.package.MSAA_SAMPLES > 1:
            bits |= f["masked_samples"] << 16
        self.set(dict(STATE=bits))

    def packet(self, packet, line=None):
        """A packet of raster_pkg as an integer; `line`: the setup that goes with one of kind LINE."""
        p, f = self.package, self.package.unpack(packet)
        affine = split(f["vertices"][0][2], p.affine_words)
        kind = f["kind"]
        if kind == TRIANGLE:
            return self.triangle(f)
        self.slots = [None] * 3
        if kind in (RECTANGLE, POINT):
            self.box(f)
            self.state(f)
            return self.command("RECTANGLE" if kind == RECTANGLE else "POINT", 0, affine)
        if kind == FAST_CLEAR:
            is_bin = f["depth_test"] == EQUAL
            if is_bin:
                self.box(f)
            else:
                self.set(dict(TARGET=f["right"] | f["bottom"] << 16))
            return self.command("CLEAR", f["depth_write"] | f["color_write"] << 1 | is_bin << 2 | (f["depth_test"] == NEVER) << 3, affine)
        if kind == FLUSH:
            return self.command("FLUSH", f["depth_test"] == NEVER)
        if kind == LINE:
            self.state(f)
            return self.command("LINE", 0, split(line & (1 << p.LINE_SETUP_BITS - p.PRIMITIVE_ID_BITS) - 1, p.line_words))
        assert kind == STATE
        value = f["vertices"][0][2] | f["vertices"][0][3] << p.ALL_AFFINE_CODE_BITS
        over = value >> p.ALL_AFFINE_CODE_BITS & (1 << max(p.STATE_WORD_BITS - p.ALL_AFFINE_CODE_BITS, 0)) - 1
        return self.command("STATE", f["depth_test"], affine + split(over, p.state_words))

    def triangle(self, f):
        p, vertices = self.package, f["vertices"]
        self.box(f)
        self.state(f)
        # The order that loads least; cull sorts vertices, so only its parity matters.
        order = min(itertools.permutations(range(3)), key=lambda o: sum(self.slots[s] != vertices[v][:3] for s, v in enumerate(o)))
        is_odd = order in ((0, 2, 1), (2, 1, 0), (1, 0, 2))
        load, words = 0, []
        for slot, v in enumerate(order):
            x, y, affine, _ = vertices[v]
            if self.slots[slot] != vertices[v][:3]:
                self.slots[slot] = vertices[v][:3]
                load |= 1 << slot
                words += [x | y << 16, *split(affine, p.affine_words)]
        over = any(v[3] for v in vertices) or f["coordinates"]
        if over:
            for v in order:
                words += split(vertices[v][3], p.over_words)
            words += split(f["coordinates"], p.frame_words)
        self.command("TRIANGLE", load | is_odd << 3 | bool(over) << 4, words)
        self.triangles += 1


def read_hex(file):
    return [int(line, 16) for line in pathlib.Path(file).read_text().split()]


def encode(encoder, packets, lines=()):
    """All packets of a scene; `lines`: the setups of its lines, in order."""
    lines = iter(lines)
    for packet in packets:
        kind = packet >> encoder.package.PRIMITIVE_PACKET_BITS - 3
        encoder.packet(packet, next(lines) if kind == LINE else None)
    return encoder.words


def picture(package, memory, base, stride, width, height, flags=None, depth=False, cleared=0):
    """Codes of a buffer of one sample a pixel that lies in `memory`, row by row (docs/memory.md). `flags`: base of its flags,
    `cleared`: the code where one is set."""
    p = package
    size = p.DEPTH_SAMPLE_BYTES if depth else p.COLOR_SAMPLE_BYTES
    stamp, side, blocks, tile = p.STAMP_SIZE, p.BLOCK_SIDE, p.BLOCKS_PER_ROW, p.TILE_SIZE
    codes = []
    for y in range(height):
        for x in range(width):
            column, row = x % tile // stamp, y % tile // stamp
            place = (row // side * blocks + column // side) * side * side + row % side * side + column % side
            pixel = place * stamp * stamp + y % stamp * stamp + x % stamp
            at = base + y // tile * stride + (x // tile << p.PLANE_SHIFT + 1) + pixel * size
            code = int.from_bytes(memory[at:at + size], "little")
            if flags is not None:
                block = tile // blocks
                bit = x // block
                if memory[flags + (y // block << p.FLAG_ROW_SHIFT) + bit // 8] >> bit % 8 & 1:
                    code = cleared
            codes.append(code)
    return codes
