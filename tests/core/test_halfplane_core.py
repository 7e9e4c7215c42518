"""halfplane_core as a whole: random scenes through ring, pipeline and memory are the model's pictures, whatever the bus does.

HALFPLANE_LONG=N: N times as many scenes.
"""

import os
import random

import cocotb
from axi_memory import Behaviour
from cocotb.triggers import ClockCycles, FallingEdge, RisingEdge
from command_words import COMMAND, ERROR, LINE, POINT, TRIANGLE, Encoder
from core_bench import (
    EMPTY,
    FENCE,
    IDLE,
    RESTART,
    RESTARTING,
    RING,
    RING_EMPTY,
    RUNNING,
    START,
    STOP,
    STOPPED,
    TIMED_OUT,
    UNDERRUN,
    VBLANK,
    WRITTEN,
    Core,
)
from core_bench import ERROR as ERROR_IRQ

BENCH = [{
    "top": "halfplane_core",
    "sources": ["core/core_pkg.sv", "tests/core/core_checkers.sv"],
    "faults": [
        # Registers: a one at another place clears an interrupt; bytes are written; two have one address.
        ("core/core_registers.sv", "irq_pending_fence_q && !(is_whole && write_word == 5'd11 && s_axil_wdata[0])",
         "irq_pending_fence_q && !(is_whole && write_word == 5'd11 && (s_axil_wdata[0] || FAULT))", "interrupts"),
        ("core/core_registers.sv", "s_axil_wstrb == '1", "(s_axil_wstrb == '1 || FAULT)", "registers_say"),
        ("core/core_registers.sv", "assign s_axil_arready = is_awake_q &&", "assign s_axil_arready = (is_awake_q || FAULT) &&", "first_cycle"),
        ("core/core_registers.sv", "assign writes         = is_awake_q &&", "assign writes         = (is_awake_q || FAULT) &&", "first_cycle"),
        ("core/core_registers.sv", "write_word == 5'd17", "write_word == (FAULT ? 5'd16 : 5'd17)", "random_scenes"),
        # A response or a pixel does not wait, a line is too short: the ports' checkers alone say so.
        ("core/core_registers.sv", "writes || (s_axil_bvalid && !s_axil_bready)", "writes || (s_axil_bvalid && !s_axil_bready && !FAULT)", "back_pressure"),
        ("core/core_registers.sv", "reads || (s_axil_rvalid && !s_axil_rready)", "reads || (s_axil_rvalid && !s_axil_rready && !FAULT)", "back_pressure"),
        # Two responses to one request; a frame begins within a line.
        ("core/core_registers.sv", "s_axil_bvalid <= writes", "s_axil_bvalid <= (FAULT && s_axil_bvalid) || writes", "feeding"),
        ("core/core_registers.sv", "s_axil_rvalid <= reads", "s_axil_rvalid <= (FAULT && s_axil_rvalid) || reads", "feeding"),
        ("core/scan_out.sv", "m_axis_video_tuser  = is_first_q;", "m_axis_video_tuser  = is_first_q || (FAULT && !m_axis_video_tlast);", "feeding"),
        ("core/scan_out.sv", "!is_valid_q || m_axis_video_tready;", "!is_valid_q || m_axis_video_tready || FAULT;", "feeding"),
        ("core/scan_out.sv", "x_q == last_x_q;", "x_q == (FAULT && y_q[2] ? last_x_q - 1'b1 : last_x_q);", "feeding"),
        # The status has no error; a stop is not heard; the tail, or the fence's tag, outlives a restart.
        ("core/core_registers.sv", "= status_error_i;", "= FAULT ? 4'd0 : status_error_i;", "wrong_word"),
        ("core/core_registers.sv", "assign control_stop_o = is_whole &&", "assign control_stop_o = is_whole && !FAULT &&", "interrupts"),
        ("core/core_registers.sv", "if (ring_tail_index_clear_i)", "if (ring_tail_index_clear_i && !FAULT)", "resets"),
        ("core/halfplane_core.sv", "if (!core_n) fence_q", "if (!core_n && !FAULT) fence_q", "resets"),
        # A restart drops the tail before the words that were taken; a start during a restart is lost; an error while another one stays raises no interrupt.
        ("core/halfplane_core.sv", ".ring_tail_index_clear_i     (restarts)",
         ".ring_tail_index_clear_i     (FAULT ? is_restarting : restarts)", "empty_ring"),
        ("core/halfplane_core.sv", "(starts || start_q)", "(starts || (start_q && !FAULT))", "at_once"),
        ("core/halfplane_core.sv", "(errors & ~errors_q)", "(errors & (FAULT ? {4{errors_q == '0}} : ~errors_q))", "errors_of_memory"),
        # The ring: it does not end; more is asked for than there is room for; the end of a part is missed; a restart goes on where it was.
        ("core/command_reader.sv", "if (last_word_i[i-2])", "if (last_word_i[i-2] || FAULT)", "back_pressure"),
        ("core/command_reader.sv", "!used[4] && (!used[3] || used[2:0] == '0)", "(!used[4] && (!used[3] || used[2:0] == '0)) || FAULT",
         "feeding"),
        ("core/command_reader.sv", "partial_q ? next ==", "partial_q && !FAULT ? next ==", "the_tail"),
        ("core/command_reader.sv", "if (!reset_nq && !asks_q) fetch_q[19:WORD]", "if (!reset_nq && !asks_q && !FAULT) fetch_q[19:WORD]",
         "at_once"),
        ("core/command_reader.sv", "assign error = ring_rerror;", "assign error = ring_rerror && !FAULT;", "error_of_the_ring"),
        # A flush is in memory when it is sent; a picture is shown before its vertical blank.
        ("rtl_ref/stages/memory_port.sv", "flushes_q != '0 && unwritten_q == '0", "flushes_q != '0 && (unwritten_q == '0 || FAULT)",
         "back_pressure"),
        ("core/halfplane_core.sv", "waits_q && (vblank || is_off)", "waits_q && (vblank || is_off || FAULT)", "two_frames"),
    ],
}, {
    # Tiles and not blocks, a port of half a word, neither lines nor counters.
    "top": "halfplane_core",
    "configs": ["small"],
    "sources": ["core/core_pkg.sv", "tests/core/core_checkers.sv"],
    "tier": "all",
}]

LONG = int(os.environ.get("HALFPLANE_LONG", "1"))
BACK = 0x10000  # the other buffers
SHOWN = 0x180000  # of a frame beyond the one that is drawn
# Scene, and cycles between the pixels of a display of 640x480 (5) or 320x240 (21) at 60 Hz and 100 MHz.
FRAMES = [("triangle --size 64x64", 0)] if os.environ["HALFPLANE_CONFIG"] == "small" else [
    ("teapot:4 --size 96x96", 0), ("walk --size 160x120", 5)] + (LONG > 1) * [
    ("teapot --size 320x240", 0), ("teapot --size 320x240", 21), ("city --size 320x240", 21),
    ("teapot --size 640x480", 5), ("city --size 640x480", 5), ("city --size 320x240", 0), ("teapot --size 640x480", 0),
    ("city --size 640x480", 0)]
HOSTILE = dict(latency=(1, 300), ready=0.5, valid=0.5)


def base():
    return cocotb.RANDOM_SEED * 1000


@cocotb.test()
async def registers_say_what_the_core_is(dut):
    core = Core(dut)
    await core.start()
    p = core.package
    assert await core.read("ID") == 0x48504C4E
    assert await core.read("VERSION") == 1 << 16
    assert await core.read("CONFIG_ID_LOW") | await core.read("CONFIG_ID_HIGH") << 32 == p.CONFIG_ID
    units = await core.read("UNITS")
    assert (units & 1, units >> 1 & 1, units >> 2 & 1, units >> 4 & 3) == (p.LINES_UNIT, p.COUNTERS_UNIT, p.CACHE_KIND, p.TEXTURE_UNIT)
    assert units >> 16 & 15 == p.MSAA_SAMPLES and units >> 24 & 3 == 3
    assert await core.read("LIMITS") == p.TARGET_WIDTH | p.TARGET_HEIGHT << 16
    widths = await core.read("WIDTHS")
    assert (widths & 15, widths >> 4 & 31, widths >> 9 & 63) == (p.SUBPIXEL_BITS, p.COORDINATE_BITS, p.DEPTH_BITS)
    assert (widths >> 15 & 7, widths >> 20 & 7) == (p.TILE_SHIFT, p.PORT_SHIFT)
    for register, mask in (("RING_TAIL", 0xFFFFF), ("IRQ_ENABLE", 0x1F), ("COUNTER_INDEX", 0x11F)):
        for value in (0xFFFFFFFF, 0x5A5A5A5A, 0):
            await core.write(register, value)
            assert await core.read(register) == value & mask, register
    assert [await core.read(r) for r in ("RING_BASE", "RING_SIZE", "SCAN_SIZE", "SCAN_STRIDE", "SCAN_CLEAR")] == [0] * 5, "only written"
    assert await core.read("CONTROL") == 0 and await core.bus.read_dword(0x1C) == 0 and await core.bus.read_dword(0x7C) == 0
    answer = await core.bus.write(0x28, b"\xff")  # a byte
    assert int(answer.resp) == 2 and await core.read("IRQ_ENABLE") == 0, "half a word is written"


@cocotb.test()
async def registers_answer_from_the_first_cycle_after_a_reset(dut):
    core = Core(dut)
    await core.start()
    for n in range(6):
        dut.rst_ni.value = 0
        await core.cycles(2)
        dut.rst_ni.value = 1
        await core.cycles(n // 2)
        if n % 2:
            await core.write("IRQ_ENABLE", 5 + n)
            assert await core.read("IRQ_ENABLE") == 5 + n
        else:
            assert await core.read("ID") == 0x48504C4E


@cocotb.test()
async def random_scenes_are_the_model_s(dut):
    core = Core(dut)
    await core.start()
    for seed in range(2 * LONG):
        frame = core.frame(core.scene(base() + seed))
        await core.draw(frame, where=seed % 2 * BACK)
        core.check(frame, where=seed % 2 * BACK)
        status = await core.wait(IDLE | WRITTEN | RING_EMPTY, "after the fence")
        assert status & RUNNING and status >> 8 == 0
    assert (await core.read("FRAMES")) & 0xFFFF == 2 * LONG


@cocotb.test()
async def back_pressure_and_latency_change_no_pixel(dut):
    core = Core(dut, Behaviour(**HOSTILE), ring_words=256)
    await core.start()
    core.pause_registers(0.5)
    for seed in range(LONG):
        frame = core.frame(core.scene(base() + 100 + seed, primitives=14))
        await core.send(core.words(frame), most=12)
        await core.fence(core.tag)
        core.check(frame)


@cocotb.test()
async def the_tail_may_stop_at_any_word(dut):
    core = Core(dut)
    await core.start()
    await core.send([word for tag in range(1, 31) for word in (COMMAND["NOP"] << 24, COMMAND["FENCE"] << 24, tag)], most=3)
    await core.fence(30)
    assert await core.read("WORDS") == 90


@cocotb.test()
async def two_frames_are_in_flight_and_the_display_never_tears(dut):
    core = Core(dut, Behaviour(latency=(4, 20)))
    await core.start()
    frames = [core.frame(core.scene(base() + 200 + n, 32, 32)) for n in range(3)]
    await core.write("SCAN_SIZE", 31 | 31 << 16)
    await core.write("SCAN_STRIDE", core.layout(0, 32)["stride"])
    shown = []
    video = cocotb.start_soon(watch(dut, core.random, shown))
    await core.draw(frames[0], present=True)
    await core.write("SCAN_CONTROL", 1)
    words = core.words(frames[1], BACK, present=True)
    words = words[:-2] + [COMMAND["FENCE"] << 24, 100, COMMAND["WAIT_VBLANK"] << 24]
    cocotb.start_soon(core.send(words + core.words(frames[2], 0, present=True)))
    await core.fence(core.tag)
    before = len(shown)
    for _ in range(4000):
        await core.cycles(10)
        if len(shown) >= before + 3:
            break
    video.cancel()  # the display takes nothing: no vertical blank comes
    dut.m_axis_video_tready.value = 0
    at = core.layout(BACK, 32)
    await core.send([COMMAND["PRESENT"] << 24, at["color"], at["color_flags"], COMMAND["WAIT_VBLANK"] << 24, COMMAND["FENCE"] << 24, 200])
    await core.cycles(500)
    assert await core.read("FENCE") == core.tag, "the stream does not wait for vertical blank"
    cocotb.start_soon(watch(dut, core.random, []))
    await core.fence(200)
    assert len(shown) >= before + 3, f"{len(shown)} frames are shown"
    pictures = [[rgb(code) for code in frame.color] for frame in frames]
    order = [pictures.index(picture) if picture in pictures else f"torn: {sum(a != b for a, b in zip(picture, pictures[0]))}" for picture in shown]
    dut._log.info("frames shown: %s", order)
    assert set(order) == {0, 1, 2} and order == sorted(order), f"shown {order}"
    assert await core.read("FRAMES") >> 16 >= len(shown)


def rgb(code):
    red, green, blue = code >> 11, code >> 5 & 63, code & 31
    return (red << 3 | red >> 2) << 16 | (green << 2 | green >> 4) << 8 | blue << 3 | blue >> 2


async def watch(dut, rng, shown):
    """A display that takes pixels at random; whole frames go to `shown`."""
    picture, begun = [], False
    dut.m_axis_video_tready.value = 1
    while True:
        await FallingEdge(dut.clk_i)
        takes = rng.random() < 0.8
        dut.m_axis_video_tready.value = takes
        if takes and dut.m_axis_video_tvalid.value == 1:
            if dut.m_axis_video_tuser.value == 1:
                assert len(picture) in (0, 1024), f"a frame has {len(picture)} pixels"
                picture, begun = [], True
            if not begun:
                continue  # answers of a frame of the previous display
            picture.append(int(dut.m_axis_video_tdata.value))
            assert (dut.m_axis_video_tlast.value == 1) == (len(picture) % 32 == 0)
            if len(picture) == 1024:
                shown.append(list(picture))
        await RisingEdge(dut.clk_i)


@cocotb.test()
async def resets_in_the_middle_of_everything_leave_nothing_behind(dut):
    core = Core(dut, Behaviour(latency=(1, 60), ready=0.7, valid=0.7))
    await core.start()
    frame = core.frame(core.scene(base() + 300, primitives=10))
    for n in range(6 * LONG):
        sending = cocotb.start_soon(core.send(core.words(frame)))
        await core.cycles(core.random.choice([30, 200, 1000, 3000]))
        sending.cancel()
        await core.cycles(2)
        if n % 2:
            await core.reset()
        else:
            await core.restart()
        assert await core.read("FENCE") == 0 and await core.read("WORDS") == 0 and await core.read("RING_TAIL") == 0
        if n % 3 == 2:
            await core.draw(frame)
            core.check(frame)


@cocotb.test()
async def errors_of_memory_are_reported_and_survived(dut):
    core = Core(dut, Behaviour(latency=(1, 10)))
    await core.start()
    frame = core.frame(core.scene(base() + 400, primitives=10))
    await core.write("IRQ_ENABLE", ERROR_IRQ)
    words = core.words(frame)
    await core.send(words[:40])
    for _ in range(1000):  # these are fetched without an error
        if await core.read("WORDS") == 40:
            break
    core.behaviour.errors = 1.0
    read_ring(core)
    await core.send(words[40:])
    await core.fence(core.tag)
    status = await core.read("STATUS")
    assert status & 1 << 13 and dut.irq.value == 1, f"errors of writes are not told: STATUS {status:#x}"
    core.behaviour.errors = 0.0
    await core.write("IRQ_PENDING", 31)
    assert dut.irq.value == 0
    await core.send([0x7F000000])  # while the error of memory stays in STATUS
    await wait_irq(core)
    await core.restart()
    assert await core.read("STATUS") >> 12 & 7 == 0
    await core.write("IRQ_PENDING", 31)
    assert dut.irq.value == 0
    await core.draw(frame)
    core.check(frame)


def read_ring(core):
    """From here on the ring is read without errors, whatever happens elsewhere."""
    plain = core.memory.has_error

    def has_error():
        s = core.memory.s
        at = int(s["araddr"].value)
        return False if s["arvalid"].value == 1 and RING <= at < RING + 0x100000 else plain()

    core.memory.has_error = has_error


@cocotb.test()
async def an_error_of_the_ring_stops_the_stream(dut):
    core = Core(dut)
    await core.start()
    core.behaviour.errors = 1.0
    await core.write("IRQ_ENABLE", ERROR_IRQ)
    await core.send([COMMAND["NOP"] << 24] * 3)
    await wait_irq(core)
    assert await core.read("STATUS") >> 8 & 15 == ERROR["BUS"] and await core.read("WORDS") == 1
    core.behaviour.errors = 0.0
    await core.restart()
    assert await core.read("STATUS") >> 8 & 15 == 0


async def wait_irq(core, cycles=3000):
    for _ in range(cycles):
        await RisingEdge(core.dut.clk_i)
        if core.dut.irq.value == 1:
            return
    raise AssertionError(f"no interrupt comes: IRQ_PENDING {await core.read('IRQ_PENDING'):#x}, STATUS {await core.read('STATUS'):#x}")


@cocotb.test()
async def a_wrong_word_is_told_with_its_place_and_the_rest_is_drawn(dut):
    core = Core(dut)
    await core.start()
    frame = core.frame(core.scene(base() + 500, primitives=6))
    words = core.words(frame)
    await core.write("IRQ_ENABLE", STOPPED)
    await core.send(words[:-2] + [0x7F000000] + words[-2:])
    await wait_irq(core, 60000)
    assert await core.read("IRQ_PENDING") & (ERROR_IRQ | STOPPED) == ERROR_IRQ | STOPPED
    status = await core.wait(WRITTEN, "what was sent before")
    assert status & RUNNING == 0 and status >> 8 & 15 == ERROR["UNKNOWN_OPCODE"]
    assert await core.read("WORDS") == len(words) - 1
    core.check(frame)
    await core.restart()
    await core.draw(frame, where=BACK)
    core.check(frame, where=BACK)


@cocotb.test()
async def interrupts_are_pending_until_they_are_cleared(dut):
    core = Core(dut)
    await core.start()
    await core.write("IRQ_PENDING", 31)
    await core.write("IRQ_ENABLE", FENCE)
    await core.send([COMMAND["FENCE"] << 24, 77])
    await wait_irq(core)
    assert await core.read("FENCE") == 77
    pending = await core.read("IRQ_PENDING")
    assert pending & FENCE and not pending & (VBLANK | ERROR_IRQ | STOPPED)
    await core.write("IRQ_PENDING", STOPPED)
    assert dut.irq.value == 1, "another bit clears it"
    await core.write("IRQ_PENDING", FENCE)
    assert dut.irq.value == 0
    await core.write("IRQ_ENABLE", EMPTY)
    await wait_irq(core, 2)
    await core.write("IRQ_PENDING", EMPTY)
    assert dut.irq.value == 0
    await core.send([COMMAND["NOP"] << 24])
    await wait_irq(core)
    await core.write("IRQ_ENABLE", STOPPED)
    await core.send([COMMAND["STOP"] << 24, COMMAND["FENCE"] << 24, 78])
    await wait_irq(core)
    assert await core.read("STATUS") & RUNNING == 0 and await core.read("FENCE") == 77
    await core.write("CONTROL", START)
    await core.fence(78)
    await core.write("IRQ_PENDING", STOPPED)
    await core.write("CONTROL", STOP)
    await wait_irq(core, 20)


@cocotb.test()
async def registers_are_read_and_written_while_the_core_draws(dut):
    core = Core(dut, Behaviour(latency=(1, 40), ready=0.8, valid=0.8))
    await core.start()
    frame = core.frame(core.scene(base() + 600, primitives=16))
    sending = cocotb.start_soon(core.send(core.words(frame)))
    r = random.Random(base())
    reads = 0
    while not sending.done() or await core.read("FENCE") != core.tag:
        await core.write("IRQ_ENABLE", r.getrandbits(5))
        await core.write("COUNTER_INDEX", r.getrandbits(5) | r.getrandbits(1) << 8)
        await core.write("SCAN_SIZE", r.getrandbits(32))
        for register in r.sample(["STATUS", "WORDS", "FENCE", "COUNTER_DATA", "FRAMES", "IRQ_PENDING", "LIMITS"], 3):
            await core.read(register)
        reads += 3
        assert reads < 20000
    core.check(frame)
    # The counters of the whole frame, in a snapshot.
    assert reads > 30
    drawn = sum(p >> core.package.PRIMITIVE_PACKET_BITS - 3 in (TRIANGLE, POINT, LINE) for p in frame.packets)
    has = core.package.COUNTERS_UNIT
    assert await counter(core, 15) == has * drawn, "primitives in"
    assert await counter(core, 16) == 0, "overflow"


async def counter(core, index):
    await core.write("COUNTER_INDEX", index | 1 << 8)
    return await core.read("COUNTER_DATA")


@cocotb.test()
async def a_restart_waits_for_what_memory_owes(dut):
    core = Core(dut, Behaviour(latency=(1, 20)))
    await core.start()
    frame = core.frame(core.scene(base() + 700, primitives=6))
    sending = cocotb.start_soon(core.send(core.words(frame)))
    await core.cycles(core.random.randint(100, 900))
    core.behaviour.answers = False
    while not core.memory.reads and not core.memory.written:
        await core.cycles(1)
    sending.cancel()
    await core.cycles(5)
    await core.write("CONTROL", RESTART)
    await core.cycles(300)
    status = await core.read("STATUS")
    assert status & RESTARTING, f"the restart does not wait: STATUS {status:#x}"
    core.behaviour.answers = True
    await core.restart()
    await core.draw(frame)
    core.check(frame)


@cocotb.test()
async def a_restart_takes_registers_at_once(dut):
    core = Core(dut, Behaviour(latency=(20, 40)))
    await core.start()
    frame = core.frame(core.scene(base() + 900, primitives=6))
    for n in range(3):
        sending = cocotb.start_soon(core.send(core.words(frame)))
        await core.cycles(300 + 100 * n)
        sending.cancel()
        await core.cycles(5)
        await core.write("CONTROL", RESTART | (START if n == 2 else 0))
        assert await core.read("STATUS") & RESTARTING
        if n < 2:
            await core.set_up()
        else:
            core.tail, core.encoder = 0, Encoder(core.package)
        await core.draw(frame)
        core.check(frame)


@cocotb.test()
async def a_restart_of_an_empty_ring_raises_no_interrupt(dut):
    core = Core(dut)
    await core.start()
    for drops in (False, True):
        await core.send([COMMAND["NOP"] << 24] * 5)
        await core.wait(RING_EMPTY, "five words")
        if drops:
            await core.write("CONTROL", STOP)
            await core.send([COMMAND["NOP"] << 24] * 3)
        await core.write("IRQ_PENDING", 31)
        await core.restart()
        await core.cycles(20)
        assert bool(await core.read("IRQ_PENDING") & EMPTY) == drops


@cocotb.test(skip=LONG == 1)
async def a_restart_gives_up_when_memory_is_silent_and_goes_on_when_it_speaks(dut):
    core = Core(dut, Behaviour(latency=(1, 20)))
    await core.start()
    frame = core.frame(core.scene(base() + 800, primitives=6))
    sending = cocotb.start_soon(core.send(core.words(frame)))
    core.behaviour.answers = False
    while not core.memory.reads and not core.memory.written:
        await core.cycles(1)
    sending.cancel()
    await core.write("CONTROL", RESTART)
    while await core.read("STATUS") & RESTARTING:
        await core.cycles(500)
    assert await core.read("STATUS") & TIMED_OUT
    core.behaviour.answers = True
    await core.cycles(500)
    await core.restart()
    await core.draw(frame)
    core.check(frame)


@cocotb.test()
@cocotb.parametrize((("scene", "interval"), FRAMES))
async def feeding_and_bus_cost_few_cycles_of_a_frame(dut, scene, interval):
    """Against raster_top alone, which culls as well. `interval`: cycles between pixels of a display; 0: none."""
    core = Core(dut, Behaviour(latency=(8, 8)))
    await core.start()
    frame = core.frame(None, scene=scene.split())
    frame.packets = [packet for packet in frame.packets if not is_culled(core.package, packet)]
    await core.write("RING_SIZE", (1 << 18) - 1)
    if interval:
        shown = core.layout(SHOWN, frame.width, frame.height)
        await core.write("SCAN_SIZE", frame.width - 1 | frame.height - 1 << 16)
        await core.write("SCAN_STRIDE", shown["stride"])
        await core.send([COMMAND["PRESENT"] << 24, shown["color"], shown["color_flags"]])
        cocotb.start_soon(take_pixels(dut, interval))
        await core.write("SCAN_CONTROL", 1)
    first, words = core.tail, core.words(frame)
    for i, word in enumerate(words, first):  # all at once: the processor does not limit
        core.memory.bytes[RING + 4 * i:RING + 4 * i + 4] = word.to_bytes(4, "little")
    await core.write("IRQ_ENABLE", FENCE)
    start = core.memory.cycle
    await core.write("RING_TAIL", first + len(words))
    await wait_irq(core, 400000)
    cycles = core.memory.cycle - start
    triangles = sum(p >> core.package.PRIMITIVE_PACKET_BITS - 3 == TRIANGLE for p in frame.packets)
    more = 100 * (cycles / frame.cycles - 1)
    dut._log.info("%d triangles, %d words, %.2f words a triangle; %d cycles to the fence, raster_top %d: %+.1f %%",
                  triangles, len(words), len(words) / triangles, cycles, frame.cycles, more)
    core.check(frame)
    assert cycles < 1.05 * frame.cycles + (0 if interval else 100)
    assert not await core.read("STATUS") & UNDERRUN, "the display waits"


def is_culled(package, packet):
    """Whether it is a triangle that the driver does not send: without area, or of the side that its state culls."""
    fields, bits = package.unpack(packet), package.COORDINATE_BITS
    if fields["kind"] != TRIANGLE:
        return False
    signed = lambda code: (code ^ 1 << bits - 1) - (1 << bits - 1)
    (x0, y0), (x1, y1), (x2, y2) = ((signed(x), signed(y)) for x, y, *_ in fields["vertices"])
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    is_back = (area > 0) != fields["front_cw"]
    return area == 0 or fields["cull"] == (1 if is_back else 2)


async def take_pixels(dut, interval):
    """A display that takes a pixel every so many cycles."""
    while True:
        dut.m_axis_video_tready.value = 1
        await RisingEdge(dut.clk_i)
        dut.m_axis_video_tready.value = 0
        await ClockCycles(dut.clk_i, interval - 1)
