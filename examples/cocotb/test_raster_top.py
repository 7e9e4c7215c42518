"""raster_top under cocotb beside Halfplane's pipeline, which is called through ctypes: every beat on the memory port is
the model's, in order, and memory ends as the model's, byte for byte. run.py sets up what this needs; docs/your-rtl.md.
"""

import collections
import os
import pathlib
import random

import cocotb
import halfplane
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, Timer


class Scoreboard:
    """Gets what crosses the ports of raster_top; the first beat that differs fails the test."""

    def __init__(self, config, design):
        self.model = halfplane.Pipeline(config, halfplane.config_id(design), halfplane.Pipeline.BEATS)
        self.beats = 0

    def beat(self, beat):
        expected = self.model.beat()
        assert expected is not None, f"beat {self.beats} is {beat:x}, the model has none"
        assert beat == expected, f"beat {self.beats} is {beat:x}, the model's {expected:x}"
        self.beats += 1


class Memory:
    """Answers beats in order, after a random time."""

    def __init__(self, config, content):
        self.bytes, self.answers = bytearray(content), collections.deque()
        self.port = halfplane.Stage(config, "memory_port").outputs[0]
        self.step = int(config["memory.port_bits"]) // 8

    def take(self, beat):
        fields = self.port.packet(beat)
        at, lanes = fields["address"], range(self.step)
        if fields["is_write"]:
            for lane in lanes:
                if fields["strobe"] >> lane & 1:
                    self.bytes[at + lane] = fields[f"data[{lane}]"]
            if fields["length"] == 1:
                self.answers.append(1 << 8 * self.step)  # is_write lies above the data
        else:
            for first in range(at, at + fields["length"] * self.step, self.step):
                self.answers.append(int.from_bytes(self.bytes[first:first + self.step], "little"))


@cocotb.test(timeout_time=1, timeout_unit="ms")
async def every_beat_is_the_models(dut):
    generator = random.Random(cocotb.RANDOM_SEED)
    config = halfplane.Config(os.environ["HALFPLANE_PRESET"])
    packets = collections.deque()
    for scene in sorted(pathlib.Path(os.environ["HALFPLANE_SCENES"]).glob("*.hpt")):
        packets.extend(halfplane.Host(halfplane.Scene(scene.read_text()), config))
    lines = collections.deque(line for _, line in packets if line is not None)
    scoreboard = Scoreboard(config, os.environ["HALFPLANE_DESIGN"])
    model, memory = scoreboard.model, Memory(config, scoreboard.model.memory())

    for name in (
        "rst_ni power_on_ni stall_i primitive_valid_i primitive_i line_valid_i line_i beat_ready_i answer_valid_i answer_i "
        "texture_ready_i texel_valid_i texel_i counters_hold_i"
    ).split():
        getattr(dut, name).value = 0
    layout = 0
    for base in model.layout[:4]:
        layout = layout << 32 | base
    dut.layout_i.value = layout << len(dut.layout_i) - 128 | model.layout[4]
    cocotb.start_soon(Clock(dut.clk_i, 10, "ns").start())
    await Timer(25, "ns")
    dut.rst_ni.value = dut.power_on_ni.value = 1

    cycles, count, is_idle = 0, len(packets), False
    while packets or not is_idle:
        await FallingEdge(dut.clk_i)
        dut.primitive_valid_i.value, dut.line_valid_i.value = int(bool(packets)), int(bool(lines))
        dut.primitive_i.value, dut.line_i.value = packets[0][0] if packets else 0, lines[0] if lines else 0
        dut.beat_ready_i.value = generator.randint(0, 1)
        dut.answer_valid_i.value = int(bool(memory.answers))
        dut.answer_i.value = memory.answers[0] if memory.answers else 0
        await Timer(1, "ns")  # what is valid and ready now crosses at the next edge
        if packets and dut.primitive_ready_o.value:
            model.put_primitive(packets.popleft()[0])
        else:
            is_idle = not packets and bool(dut.idle_o.value)  # after the flush was taken
        if lines and dut.line_ready_o.value:
            model.put_line(lines.popleft())
        if memory.answers and dut.answer_ready_o.value:
            memory.answers.popleft()
        if dut.beat_valid_o.value and dut.beat_ready_i.value:
            scoreboard.beat(int(dut.beat_o.value))
            memory.take(int(dut.beat_o.value))
        cycles += 1
    assert memory.bytes == model.memory(), "memory differs from the model's"
    assert model.beat() is None, "the model has further beats"
    dut._log.info("%d primitives, %d cycles, %d beats: equal", count, cycles, scoreboard.beats)
