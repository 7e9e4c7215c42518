"""Whole frames of raster_top through the AXI ports: the model's picture, and what the bus costs in cycles.

HALFPLANE_LONG=1: larger frames at more latencies. HALFPLANE_FRAME_TRACE=FILE: each beat of raster_top as a line.
"""

import json
import os
import pathlib
import random
import subprocess
import tempfile

import cocotb
from axi_memory import Behaviour, Memory
from cocotb.clock import Clock
from cocotb.triggers import RisingEdge
from command_words import Package, picture, read_hex

BENCH = {
    "top": "axi_frame",
    "tier": "",
    "faults": [
        # A read passes an unanswered write to its place.
        ("core/axi_frame_port.sv", "age < NUMBER'(pending_q)", "age < NUMBER'(pending_q) && !FAULT", "hostile.*city"),
        # raster_top is not powered on again after the time-out.
        ("core/reset_order.sv", "power_on_q  <= gives_up", "power_on_q  <= gives_up && !FAULT", "restarts"),
        ("core/reset_order.sv", "forget_o    <= gives_up", "forget_o    <= gives_up && !FAULT", "restarts"),
        # A restart does not wait for memory.
        ("core/reset_order.sv", "&& idle_i && was_idle_q", "&& ((idle_i && was_idle_q) || FAULT)", "restarts"),
    ],
}
PROGRAM = os.environ["HALFPLANE_PROGRAM"]
CONFIG = os.environ["HALFPLANE_CONFIG"]
PACKAGE = Package(pathlib.Path(os.environ["HALFPLANE_PACKAGES"]) / CONFIG / "raster_pkg.sv")
LONG = int(os.environ.get("HALFPLANE_LONG", "0"))
COLOR = 1 << PACKAGE.PLANE_SHIFT
DEPTH_FLAGS, COLOR_FLAGS, SIZE = 0x200000, 0x220000, 0x240000


class Scene:
    def __init__(self, name, size, latency):
        self.width, self.height = map(int, size.split("x"))
        options = [name, "--config", CONFIG, "--size", size]
        with tempfile.TemporaryDirectory() as folder:
            run = lambda *words: subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True).stdout
            run("vectors", *options, "--stage", "cull", "--format", "hex", "-o", folder)
            self.packets = read_hex(f"{folder}/primitive.hex")
            report = json.loads(run("render", *options, "--engine", "cycle", "--memory-latency", str(latency), "--json",
                                    "--quiet", "-o", f"{folder}/color.png", "--depth", f"{folder}/depth.npy"))
            self.cycles = report["cycles"]
            from core_bench import read_npy, read_png

            rgb, self.depth = read_png(f"{folder}/color.png"), read_npy(f"{folder}/depth.npy")
        self.color = [rgb[i] >> 3 << 11 | rgb[i + 1] >> 2 << 5 | rgb[i + 2] >> 3 for i in range(0, len(rgb), 3)]  # rgb565
        self.stride = (self.width + PACKAGE.TILE_SIZE - 1) // PACKAGE.TILE_SIZE << PACKAGE.PLANE_SHIFT + 1


class Bench:
    def __init__(self, dut, behaviour):
        self.dut, self.random = dut, random.Random(cocotb.RANDOM_SEED)
        self.memory = Memory(dut, SIZE, behaviour, self.random)
        self.memory.bytes[:] = self.random.randbytes(SIZE)
        self.packets, self.next = [], 0
        self.trace = None

    async def start(self):
        dut = self.dut
        dut.rst_ni.value = dut.packet_valid.value = dut.restart_i.value = 0
        dut.depth_base.value, dut.color_base.value = 0, COLOR
        dut.depth_flags_base.value, dut.color_flags_base.value = DEPTH_FLAGS, COLOR_FLAGS
        cocotb.start_soon(Clock(dut.clk_i, 10, "ns").start())
        for _ in range(3):
            await RisingEdge(dut.clk_i)
        dut.rst_ni.value = 1
        cocotb.start_soon(self.step())
        while dut.is_busy_o.value == 1 or dut.rst_ni.value == 0:
            await RisingEdge(dut.clk_i)
        for _ in range(1100):  # the port fills its table
            await RisingEdge(dut.clk_i)

    async def step(self):
        dut = self.dut
        offered = None
        while True:
            await RisingEdge(dut.clk_i)
            self.memory.take()
            if offered is not None and dut.packet_ready.value == 1:
                self.next += 1
            if self.trace is not None and dut.beat_moves_o.value == 1:
                self.trace.append((self.memory.cycle, int(dut.beat_is_write_o.value), int(dut.beat_address_o.value)))
            self.memory.cycle += 1
            self.memory.drive()
            packet = self.packets[self.next] if self.next < len(self.packets) else None
            if packet is not offered:
                dut.packet_valid.value = packet is not None
                if packet is not None:
                    dut.packet.value = packet
                offered = packet

    async def draw(self, scene):
        """Cycles from the first packet on offer to the last answer."""
        self.dut.row_stride.value = scene.stride
        self.packets, self.next = scene.packets, 0
        await RisingEdge(self.dut.clk_i)
        start = self.memory.cycle
        while self.next < len(self.packets) or self.dut.idle_o.value == 0:
            await RisingEdge(self.dut.clk_i)
            assert self.memory.cycle - start < 20 * scene.cycles, "the frame does not end"
        return self.memory.cycle - start

    def check(self, scene):
        clears = [f for f in map(PACKAGE.unpack, scene.packets) if f["kind"] == 2 and f["depth_write"]]
        cleared = clears[-1]["vertices"][0][2] & (1 << PACKAGE.DEPTH_CODE_BITS) - 1
        got = picture(PACKAGE, self.memory.bytes, COLOR, scene.stride, scene.width, scene.height)
        wrong = sum(a != b for a, b in zip(got, scene.color))
        assert wrong == 0 and len(got) == len(scene.color), f"{wrong} colours of {len(got)} differ"
        got = picture(PACKAGE, self.memory.bytes, 0, scene.stride, scene.width, scene.height, flags=DEPTH_FLAGS, depth=True,
                      cleared=cleared)
        wrong = sum(a != b for a, b in zip(got, scene.depth))
        assert wrong == 0 and len(got) == len(scene.depth), f"{wrong} depths of {len(got)} differ"


@cocotb.test()
@cocotb.parametrize(name=["teapot", "city"], size=["320x240", "640x480"] if LONG else ["160x120"],
                    latency=[8, 40] if LONG else [8])
async def the_bus_costs_less_than_a_twentieth(dut, name, size, latency):
    """Of a memory that takes a beat of each channel in each cycle, and answers it `latency` cycles later."""
    scene = Scene(name, size, latency)
    bench = Bench(dut, Behaviour(latency=(latency, latency)))
    await bench.start()
    file = os.environ.get("HALFPLANE_FRAME_TRACE")
    if file:
        bench.trace = []
    cycles = await bench.draw(scene)
    bench.check(scene)
    more = 100 * (cycles / scene.cycles - 1)
    print(f"{name} {size} latency {latency}: {cycles} cycles, raster_top alone {scene.cycles}: {more:+.2f} %, "
          f"{bench.memory.counts['ar']} reads, {bench.memory.counts['aw']} bursts written")
    if file:
        pathlib.Path(f"{file}.{name}.{size}.{latency}").write_text(
            "".join(f"{c} {'W' if w else 'R'} {a:x}\n" for c, w, a in bench.trace))
    assert more < 5


@cocotb.test()
@cocotb.parametrize(name=["teapot", "city", "walk"] if LONG else ["city", "walk"])
async def hostile_memory_changes_no_bit(dut, name):
    """Latencies to 300, back-pressure on each channel, reads and writes in any order that AXI allows."""
    scene = Scene(name, "320x240" if LONG else "96x96", 8)
    bench = Bench(dut, Behaviour(latency=(1, 300), ready=0.7, valid=0.7))
    await bench.start()
    await bench.draw(scene)
    bench.check(scene)
    bench.memory.behaviour = Behaviour(latency=(30, 60), eager_reads=1.0, lazy_writes=1.0)
    await bench.draw(scene)
    bench.check(scene)
    assert dut.has_error_o.value == 0


@cocotb.test()
async def restarts_in_the_middle_leave_nothing_behind(dut):
    """With a memory that answers, one that answers late, and one that answers only after the time-out."""
    scene = Scene("walk", "160x120" if LONG or "HALFPLANE_ALL" in os.environ else "96x96", 8)
    bench = Bench(dut, Behaviour(latency=(1, 40)))
    await bench.start()
    late = 0
    for turn in range(6):
        bench.dut.row_stride.value = scene.stride
        bench.packets, bench.next = scene.packets, 0
        for _ in range(bench.random.randint(300, 3000)):
            await RisingEdge(dut.clk_i)
        bench.memory.behaviour.answers = turn % 3 == 0
        while bench.memory.is_idle:
            await RisingEdge(dut.clk_i)
        for _ in range(bench.random.randint(1, 50)):
            await RisingEdge(dut.clk_i)
        bench.packets, bench.next = [], 0
        dut.restart_i.value = 1
        await RisingEdge(dut.clk_i)
        dut.restart_i.value = 0
        await RisingEdge(dut.clk_i)
        await RisingEdge(dut.clk_i)
        assert dut.is_busy_o.value == 1
        waited = 0
        while dut.is_busy_o.value == 1:
            if turn % 3 == 1 and waited == 500:
                bench.memory.behaviour.answers = True
            await RisingEdge(dut.clk_i)
            waited += 1
            assert waited < 1100
        owed = not bench.memory.is_idle
        assert owed == (turn % 3 == 2) == (dut.timed_out_o.value == 1), "the restart does not wait for memory"
        late += owed
        bench.packets, bench.next = scene.packets, 0
        for _ in range(300):
            await RisingEdge(dut.clk_i)
        bench.memory.behaviour.answers = True
        await bench.draw(Rest(scene, bench.next))
        bench.check(scene)
    assert late == 2


class Rest:
    """The packets of a scene that have not gone."""

    def __init__(self, scene, gone):
        self.packets, self.stride, self.cycles = scene.packets[gone:], scene.stride, scene.cycles
