"""halfplane_core without a ring and with a master for textures: frames that the driver wrote, of random triangles, lines and
points with and without textures, through s_axis and two memories are the model's pictures.

HALFPLANE_LONG=N: N times as many frames.
"""

import json
import os
import pathlib
import subprocess

import cocotb
from axi_memory import Behaviour
from cocotb.triggers import RisingEdge
from command_words import COMMAND, ERROR, REGISTER
from core_bench import ERROR as ERROR_IRQ
from core_bench import IDLE, RESTART, RUNNING, START, WRITTEN, Core

BENCH = {
    "top": "halfplane_core",
    "configs": ["textured"],
    "parameters": {"RING": 0, "TEXTURE_MASTER": 1, "WATCHDOG": 14},
    "sources": ["core/core_pkg.sv", "tests/core/core_checkers.sv"],
    "faults": [
        # Words are taken that the decoder does not take.
        ("core/halfplane_core.sv", "word_ready && core_n", "(word_ready || FAULT) && core_n", "frames"),
        # Texels come from the other master, or of the wrong texture; their error is not told.
        ("core/halfplane_core.sv", "TEXTURE_MASTER ? m_axi_texture_rdata : s_rdata",
         "TEXTURE_MASTER && !FAULT ? m_axi_texture_rdata : s_rdata", "frames"),
        ("core/axi_texture_port.sv", "+ texture_base_i", "+ (FAULT ? 32'd0 : texture_base_i)", "frames"),
        ("core/halfplane_core.sv", "m_axi_texture_rresp[1]", "m_axi_texture_rresp[1] && !FAULT", "an_error_of_texels"),
    ],
}

TEXTURES = 0x140000
LONG = int(os.environ.get("HALFPLANE_LONG", "1"))


class DriverFrame:
    """A frame of tests/driver/stream_file.cpp, with its buffers at `layout` and its texels at TEXTURES."""

    def __init__(self, seed, primitives=25, pixels=4000):
        tool = pathlib.Path(os.environ["HALFPLANE_PACKAGES"]).parents[1] / "tests/driver/halfplane_driver_stream_file"
        frame = json.loads(subprocess.run([tool, *map(str, (seed, primitives, pixels))], capture_output=True, check=True).stdout)
        for name in ("seed", "width", "height", "words", "color", "depth", "textured_pixels"):
            setattr(self, name, frame[name])
        self.textures, self.depth_of_clear = bytes(frame["textures"]), frame["cleared_depth"]

    def cleared_depth(self, _package):
        return self.depth_of_clear

    def placed(self, layout):
        """The words, with these addresses in the SET of the target, which is the first command."""
        assert self.words[0] == COMMAND["SET"] << 24 | REGISTER["TARGET"] | 7 << 8
        order = ("depth", "color", "depth_flags", "color_flags", "stride")
        return [*self.words[:2], *(layout[name] for name in order), TEXTURES, *self.words[8:]]


def core_of(dut, **behaviour):
    return Core(dut, Behaviour(**behaviour), has_ring=False, has_texture_master=True)


async def draw(core, frame):
    core.memory.bytes[TEXTURES:TEXTURES + len(frame.textures)] = frame.textures
    await core.stream(frame.placed(core.layout(0, frame.width, frame.height)))
    await core.fence(1)


def frames(count, first=0):
    seed = cocotb.RANDOM_SEED % 1000 * 1000 + first
    for _ in range(count):
        frame = DriverFrame(seed)
        seed = frame.seed + 1
        yield frame


@cocotb.test()
async def frames_of_the_driver_are_the_model_s(dut):
    core = core_of(dut, latency=(1, 60), ready=0.8, valid=0.8)
    await core.start()
    units = await core.read("UNITS")
    assert units >> 25 & 1 == 0 and units >> 4 & 3 == core.package.TEXTURE_UNIT != 0
    for frame in frames(2 * LONG):
        read = core.memories[1].counts["r"]
        core.memory.trace = []
        await draw(core, frame)
        core.check(frame)
        texels = core.memories[1].counts["r"] - read
        dut._log.info("seed %d: %dx%d, %d words, %d pixels of texels, %d beats of texels", frame.seed, frame.width, frame.height,
                      len(frame.words), frame.textured_pixels, texels)
        assert texels > 0 and not any(what == "AR" and address >= TEXTURES for _, what, address, _ in core.memory.trace)
        await core.restart()  # the next frame has the same tag


@cocotb.test()
async def a_restart_in_the_middle_of_the_stream_begins_anew(dut):
    core = core_of(dut)
    await core.start()
    frame = next(frames(1, 500))
    words = frame.placed(core.layout(0, frame.width, frame.height))
    for end in (len(words) // 3, len(words) // 2 + 1):
        await core.stream(words[:end])
        await core.write("CONTROL", RESTART)
        next_words = cocotb.start_soon(core.stream(words[:7]))  # wait until it has ended
        await core.restart()
        await next_words
        assert await core.read("WORDS") == 7
        await core.restart()
        assert await core.read("WORDS") == 0
    await draw(core, frame)
    core.check(frame)
    assert await core.wait(IDLE | WRITTEN, "after the fence") & RUNNING


@cocotb.test()
async def a_wrong_word_stops_the_stream(dut):
    core = core_of(dut)
    await core.start()
    await core.write("IRQ_ENABLE", ERROR_IRQ)
    await core.stream([COMMAND["NOP"] << 24, 0x06000000, COMMAND["NOP"] << 24])
    assert dut.irq.value == 1 and dut.s_axis_tready.value == 0
    status = await core.read("STATUS")
    assert status >> 8 & 15 == ERROR["UNKNOWN_OPCODE"] and not status & RUNNING and await core.read("WORDS") == 2
    await core.write("CONTROL", START)
    assert not await core.read("STATUS") & RUNNING
    await core.restart(drops_word=True)
    assert await core.read("STATUS") >> 8 & 15 == 0


@cocotb.test()
async def an_error_of_texels_is_told_and_the_frame_ends(dut):
    core = core_of(dut)
    await core.start()
    core.memories[1].behaviour = Behaviour(errors=1)
    await draw(core, next(frames(1, 700)))
    assert await core.read("STATUS") >> 12 & 7 == 4
    await core.restart()
    assert await core.read("STATUS") >> 12 & 7 == 0


@cocotb.test()
async def memory_that_stops_answering_is_an_error_and_a_restart_helps(dut):
    core = core_of(dut)
    await core.start()
    await core.write("IRQ_ENABLE", ERROR_IRQ)
    frame = next(frames(1, 900))
    for at in range(2):  # the frame's memory, that of texels
        core.memories[at].behaviour = Behaviour(answers=False)
        await draw_until_error(core, frame)
        status = await core.read("STATUS")
        assert status >> 8 & 15 == ERROR["STUCK"] and not status & RUNNING, f"STATUS {status:#x}"
        core.memories[at].behaviour = core.behaviour
        await core.restart(drops_word=True)
        await core.write("IRQ_PENDING", ERROR_IRQ)
    await draw(core, frame)
    core.check(frame)


async def draw_until_error(core, frame):
    words = cocotb.start_soon(core.stream(frame.placed(core.layout(0, frame.width, frame.height))))
    for _ in range(60000):
        await RisingEdge(core.dut.clk_i)
        if core.dut.irq.value == 1:
            break
    else:
        raise AssertionError("no interrupt")
    words.cancel()
