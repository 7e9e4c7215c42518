"""halfplane_core under cocotb: registers through AXI4-Lite, commands through a ring in memory, pictures of the model.

    core = Core(dut)
    await core.start()
    frame = core.frame(scene)      # packets of a capture's text, and the model's picture
    await core.draw(frame)         # encodes, writes the ring, waits for the fence
    core.check(frame)              # every pixel of colour and depth
"""

import json
import os
import pathlib
import random
import re
import struct
import subprocess
import tempfile
import zlib

import cocotb
from axi_memory import Behaviour, Memory
from cocotb.clock import Clock
from cocotb.triggers import ReadOnly, RisingEdge
from cocotbext.axi import AxiLiteBus, AxiLiteMaster
from command_words import FAST_CLEAR, Encoder, Package, encode, picture, read_hex

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["HALFPLANE_PROGRAM"]
PACKAGES = pathlib.Path(os.environ["HALFPLANE_PACKAGES"])
REGISTERS = {}
for line in (ROOT / "core/registers/halfplane.rdl").read_text().splitlines():
    if match := re.match(r"    } (\w+) @ (0x\w+);", line):
        REGISTERS[match[1]] = int(match[2], 16)
RUNNING, IDLE, WRITTEN, RESTARTING, TIMED_OUT, RING_EMPTY, UNDERRUN = (1 << i for i in range(7))
START, STOP, RESTART = 1, 2, 4
FENCE, VBLANK, ERROR, STOPPED, EMPTY = (1 << i for i in range(5))

RING = 0x300000
SIZE = 1 << 22


def random_scene(seed, width=64, height=64, lines=True, primitives=24):
    """A capture with triangles, strips, points, lines and clears in random states; the same for the same seed."""
    r = random.Random(seed)
    text = ["halfplane 1", f"target {width} {height}", "space window"]
    colour = lambda: " ".join(str(r.randrange(256)) for _ in range(4))
    text.append(f"clear color {colour()} depth {r.choice([1, 0.5])}")
    vertices = 0

    def vertex(x, y):
        nonlocal vertices
        text.append(f"v {x:.17g} {y:.17g} {r.random():.17g} 1 {colour()}")
        vertices += 1
        return vertices - 1

    for _ in range(primitives):
        for state, values in (("depth_test", "never less lequal equal greater gequal notequal always"), ("depth_write", "on on on off"),
                              ("color_write", "on on on off"), ("cull", "none none back front"), ("front", "ccw cw")):
            if r.random() < 0.3:
                text.append(f"state {state} {r.choice(values.split())}")
        if r.random() < 0.2:
            x, y = r.randrange(width), r.randrange(height)
            text.append(f"state scissor {x} {y} {r.randint(1, width - x)} {r.randint(1, height - y)}" if r.random() < 0.7 else "state scissor off")
        what = r.choice("tttsssfpcl" if lines else "tttsssfpc")
        reach = r.choice([8, 24, 96])
        at = r.randint(-8, width + 8), r.randint(-8, height + 8)
        points = [vertex(at[0] + r.uniform(-reach, reach), at[1] + r.uniform(-reach, reach)) for _ in range(r.randint(3, 7))]
        words = " ".join(map(str, points))
        if what == "t":
            text.append(f"t {' '.join(map(str, points[:3]))}")
        elif what == "c":
            text.append(f"clear color {colour()}" if r.random() < 0.6 else f"clear depth {r.random():.3f}")
        else:
            text.append({"s": "ts", "f": "tf", "p": "p", "l": "ls"}[what] + " " + words)
    return "\n".join(text) + "\n"


def read_png(file):
    """The bytes of an 8-bit RGB picture, row by row."""
    data, at, packed = pathlib.Path(file).read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, bits, colours = struct.unpack(">IIBB", body[:10])
            assert (bits, colours) == (8, 2)
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, pitch, above, out = zlib.decompress(packed), 3 * width, bytes(3 * width), bytearray()
    for y in range(height):
        method, row = raw[y * (pitch + 1)], bytearray(raw[y * (pitch + 1) + 1:(y + 1) * (pitch + 1)])
        for i in range(pitch):
            left, up, corner = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row[i] = row[i] + (0, left, up, (left + up) // 2, nearest)[method] & 255
        out += row
        above = row
    return bytes(out)


def read_npy(file):
    """The words of a .npy of the program."""
    data = pathlib.Path(file).read_bytes()
    start = 10 + int.from_bytes(data[8:10], "little")
    return list(struct.unpack(f"<{(len(data) - start) // 4}I", data[start:]))


class Frame:
    """A scene: its packets, its picture and cycles as the model has them. `scene`: words of the program instead of a capture."""

    def __init__(self, config, settings, text, scene=None, lines=True):
        with tempfile.TemporaryDirectory() as folder:
            if scene is None:
                scene = [pathlib.Path(folder) / "scene.hpt"]
                scene[0].write_text(text)
            options = ["--config", config, "--quiet", *(word for key, value in settings.items() for word in ("--set", f"{key}={value}"))]
            run = lambda *words: subprocess.run([PROGRAM, *map(str, words), *options], check=True)
            found = []
            for stage, name in (("cull", "primitive"), ("line_raster", "line"))[:1 + lines]:
                run("vectors", *scene, "--stage", stage, "--format", "hex", "-o", pathlib.Path(folder) / name)
                found.append(read_hex(pathlib.Path(folder) / name / f"{name}.hex"))
            run("render", *scene, "--engine", "cycle", "-o", f"{folder}/color.png", "--depth", f"{folder}/depth.npy", f"--json={folder}/r.json")
            result = json.loads(pathlib.Path(f"{folder}/r.json").read_text())
            rgb, self.depth = read_png(f"{folder}/color.png"), read_npy(f"{folder}/depth.npy")
        self.packets, self.lines = found[0], found[1] if lines else []
        self.color = [rgb[i] >> 3 << 11 | rgb[i + 1] >> 2 << 5 | rgb[i + 2] >> 3 for i in range(0, len(rgb), 3)]  # rgb565
        self.cycles, self.width, self.height = result["cycles"], result["width"], result["height"]

    def cleared_depth(self, package):
        """The depth of the last fast clear of it."""
        clears = [f for f in map(package.unpack, self.packets) if f["kind"] == FAST_CLEAR and f["depth_write"]]
        return clears[-1]["vertices"][0][2] & (1 << package.DEPTH_CODE_BITS) - 1

class Core:
    def __init__(self, dut, behaviour=None, ring_words=1024, has_ring=True, has_texture_master=False):
        self.dut, self.config, self.random = dut, os.environ["HALFPLANE_CONFIG"], random.Random(cocotb.RANDOM_SEED)
        self.package = Package(PACKAGES / self.config / "raster_pkg.sv")
        self.ring_words = ring_words
        self.behaviour = behaviour or Behaviour()
        self.has_ring, self.has_texture_master = has_ring, has_texture_master  # the parameters of the core
        self.tag = self.tail = 0
        self.encoder = Encoder(self.package)
        self.log = dut._log

    async def start(self):
        d = self.dut
        d.rst_ni.value = 0
        for name in ("s_axis_tvalid", "s_axis_tdata", "m_axi_bid", "m_axi_rid", "m_axis_video_tready", "m_axi_texture_arready",
                     "m_axi_texture_rvalid", "m_axi_texture_rlast", "m_axi_texture_rid"):
            getattr(d, name).value = 0
        self.clock = cocotb.start_soon(Clock(d.clk_i, 2, "ns").start())
        self.memory = Memory(d, SIZE, self.behaviour, self.random)
        self.tasks = [cocotb.start_soon(self.memory.run())]
        self.memories = [self.memory]
        if self.has_texture_master:
            self.memories.append(Memory(d, SIZE, self.behaviour, self.random, "m_axi_texture", self.memory.bytes))
            self.tasks.append(cocotb.start_soon(self.memories[1].run()))
        self.bus = AxiLiteMaster(AxiLiteBus.from_prefix(d, "s_axil"), d.clk_i, d.rst_ni, reset_active_level=False)
        for logger in (self.bus.write_if.log, self.bus.read_if.log):
            logger.setLevel("WARNING")
        await self.cycles(5)
        d.rst_ni.value = 1
        await self.cycles(10)
        await self.set_up()

    async def set_up(self):
        """After a reset: the ring, and the core runs."""
        self.tail, self.encoder = 0, Encoder(self.package)
        await self.write("RING_BASE", RING)
        await self.write("RING_SIZE", self.ring_words - 1)
        await self.write("CONTROL", START)

    async def reset(self):
        """That of the bus: memory forgets as well."""
        await RisingEdge(self.dut.clk_i)
        self.dut.rst_ni.value = 0
        await self.cycles(self.random.randint(1, 4))
        for memory in self.memories:
            memory.forget()
        self.dut.rst_ni.value = 1
        await self.set_up()

    async def restart(self, drops_word=False):
        """From the register, while memory goes on. drops_word: one is on offer to s_axis that was not taken."""
        await self.write("CONTROL", RESTART)
        if drops_word:
            self.dut.s_axis_tvalid.value = 0
        for _ in range(4000):
            if not await self.read("STATUS") & RESTARTING:
                break
            await self.cycles(20)
        else:
            raise AssertionError("the restart does not end")
        await self.set_up()

    def pause_registers(self, probability):
        """Each channel of s_axil waits so often in a cycle: requests come apart, responses are not taken."""
        channels = ("aw_channel", "w_channel", "b_channel", "ar_channel", "r_channel")
        found = [getattr(part, name) for part in (self.bus.write_if, self.bus.read_if) for name in channels if hasattr(part, name)]
        assert len(found) == len(channels)
        for channel in found:
            channel.set_pause_generator(iter(lambda: self.random.random() < probability, None))

    async def cycles(self, count):
        for _ in range(count):
            await RisingEdge(self.dut.clk_i)

    async def write(self, register, value):
        await self.bus.write_dword(REGISTERS[register], value)

    async def read(self, register):
        return await self.bus.read_dword(REGISTERS[register])

    async def wait(self, condition, what, polls=4000):
        """Until a status has all bits of `condition`."""
        for _ in range(polls):
            status = await self.read("STATUS")
            if status & condition == condition:
                return status
            await self.cycles(20)
        raise AssertionError(f"{what}: STATUS stays {status:#x}, error {status >> 8 & 15}, {await self.read('WORDS')} words, "
                             f"tail {self.tail}")

    def layout(self, where, width, height=64):
        """Buffers of a frame from an address on: of 64x64 pixels 64 KB."""
        p = self.package
        stride = (width + p.TILE_SIZE - 1) // p.TILE_SIZE << p.PLANE_SHIFT + 1
        flags = where + max(0xC000, stride * ((height + p.TILE_SIZE - 1) // p.TILE_SIZE))
        return dict(depth=where, color=where + (1 << p.PLANE_SHIFT), depth_flags=flags, color_flags=flags + 0x2000, stride=stride)

    def scene(self, seed, *size, **options):
        return random_scene(seed, *size, lines=self.package.LINES_UNIT != 0, **options)

    def frame(self, text, scene=None, **settings):
        return Frame(self.config, settings, text, scene, self.package.LINES_UNIT)

    def words(self, frame, where=0, present=False):
        """The words of a frame, ended by a fence."""
        e = self.encoder
        e.words = []
        e.layout(**self.layout(where, frame.width, frame.height))
        encode(e, frame.packets, frame.lines)
        self.tag += 1
        if present:
            layout = self.layout(where, frame.width, frame.height)
            e.command("PRESENT", 0, [layout["color"], layout["color_flags"]])
        e.command("FENCE", 0, [self.tag])
        return e.words

    async def send(self, words, most=300):
        """Into the ring, as the driver does: waits for room, writes, moves the tail by parts of any size. Or to s_axis."""
        words = list(words)
        if not self.has_ring:
            return await self.stream(words)
        while words:
            head = await self.read("WORDS")
            room = self.ring_words - (self.tail - head) % (1 << 20)
            part = min(len(words), room, self.random.randint(1, most))
            for i in range(part):
                at = RING + (self.tail + i) % self.ring_words * 4
                self.memory.bytes[at:at + 4] = words[i].to_bytes(4, "little")
            del words[:part]
            self.tail = (self.tail + part) % (1 << 20)
            if part:
                await self.write("RING_TAIL", self.tail)
            else:
                status = await self.read("STATUS")
                assert status & RUNNING, f"the ring is full and the core has stopped: STATUS {status:#x}"
                await self.cycles(50)

    async def stream(self, words, offers=0.8):
        """To s_axis, with gaps; returns when all are taken, or the core has stopped with an error."""
        d = self.dut
        for word in words:
            while self.random.random() >= offers:
                await RisingEdge(d.clk_i)
            d.s_axis_tdata.value, d.s_axis_tvalid.value = word, 1
            taken = False
            while not taken:
                await ReadOnly()
                taken = d.s_axis_tready.value == 1
                await RisingEdge(d.clk_i)
                if d.irq.value == 1:  # interrupt of an error, where it is enabled
                    break
            if not taken:
                return
            d.s_axis_tvalid.value = 0

    async def fence(self, tag, polls=20000):
        for _ in range(polls):
            if await self.read("FENCE") == tag:
                return
            await self.cycles(30)
            status = await self.read("STATUS")
            assert status >> 8 & 15 == 0, f"error {status >> 8 & 15} after {await self.read('WORDS')} words"
        raise AssertionError(f"fence {tag} does not come: STATUS {await self.read('STATUS'):#x}")

    async def draw(self, frame, where=0, **options):
        await self.send(self.words(frame, where, **options))
        await self.fence(self.tag)

    def check(self, frame, where=0):
        """Every pixel of both buffers."""
        at, p = self.layout(where, frame.width, frame.height), self.package
        assert len(frame.color) == len(frame.depth) == frame.width * frame.height
        for what, model in (("color", frame.color), ("depth", frame.depth)):
            is_depth = what == "depth"
            got = picture(p, self.memory.bytes, at[what], at["stride"], frame.width, frame.height, is_depth and at["depth_flags"] or None,
                          is_depth, frame.cleared_depth(p))
            wrong = [i for i, (a, b) in enumerate(zip(got, model, strict=True)) if a != b]
            assert not wrong, f"{what} of {len(wrong)} pixels differs, first at {wrong[0] % frame.width}, {wrong[0] // frame.width}: " \
                f"{got[wrong[0]]:#x}, model {model[wrong[0]]:#x}"
