"""The watchdog of command_decoder, of 64 cycles: the error STUCK where nothing moves, and not where something does."""

import cocotb
from cocotb.triggers import FallingEdge
from command_words import COMMAND, ERROR
from test_command_decoder import Bench, clear

BENCH = {
    "top": "command_decoder",
    "configs": ["small"],
    "parameters": {"WATCHDOG": 6},
    "sources": ["core/core_pkg.sv"],
    "faults": [
        # It never bites; it bites though something moves, or while the display is slow; not for a flush, a command's rest or a
        # ring that is not read.
        ("core/command_decoder.sv", "assign is_stuck = waited_q[WATCHDOG]", "assign is_stuck = waited_q[WATCHDOG] && !FAULT"),
        ("core/command_decoder.sv", "takes || moves_i ||", "takes || (moves_i && !FAULT) ||"),
        ("core/command_decoder.sv", "                        !present_valid_o;", "                        (!present_valid_o || FAULT);"),
        ("core/command_decoder.sv", "primitive_valid_q || flushes_q != '0)", "primitive_valid_q || (flushes_q != '0 && !FAULT))"),
        ("core/command_decoder.sv", "is_owed_i || state_q != HEADER)", "is_owed_i || (state_q != HEADER && !FAULT))"),
        ("core/command_decoder.sv", "(word_valid_i || is_owed_i", "(word_valid_i || (is_owed_i && !FAULT)"),
    ],
}
PATIENCE = 64


async def error_after(bench, cycles):
    for _ in range(cycles):
        await FallingEdge(bench.dut.clk_i)
    return bench.error()


async def begin(dut, *commands):
    """A bench after the first clear and these: (name, header, words)."""
    bench = Bench(dut)
    await bench.start()
    e = clear(bench.package)
    for name, *rest in commands:
        e.command(name, *rest)
    bench.queue += e.words
    await bench.settle()
    return bench


@cocotb.test()
async def memory_that_does_not_answer_is_an_error_after_so_many_cycles(dut):
    for commands in ([("FLUSH",)], [("FLUSH",), ("FENCE", 0, [7])], [("FLUSH",), ("FENCE", 0, [7]), ("STOP",)]):
        bench = Bench(dut)
        bench.flush_answers = False
        await bench.start()
        e = clear(bench.package)
        for name, *rest in commands:
            e.command(name, *rest)
        bench.queue += e.words
        while bench.queue:
            await FallingEdge(dut.clk_i)
        assert await error_after(bench, PATIENCE - 8) == 0, f"{commands}: too early"
        assert await error_after(bench, 16) == ERROR["STUCK"], f"{commands}: it does not bite"
        assert dut.is_running_o.value == 0
        bench.task.cancel()


@cocotb.test()
async def the_rest_of_a_command_that_does_not_come_is_an_error_and_a_reset_helps(dut):
    bench = await begin(dut)
    bench.queue.append(COMMAND["FENCE"] << 24)
    assert await error_after(bench, PATIENCE - 8) == 0
    assert await error_after(bench, 16) == ERROR["STUCK"]
    await bench.pulse(dut.start_i)
    assert dut.is_running_o.value == 0 and bench.error() == ERROR["STUCK"]
    await bench.reset()
    await bench.pulse(dut.start_i)
    bench.queue += [COMMAND["FENCE"] << 24, 5]
    assert await error_after(bench, 2 * PATIENCE) == 0 and [tag for tag, _ in bench.fences][-1] == 5


@cocotb.test()
async def a_ring_that_memory_does_not_give_is_an_error(dut):
    bench = await begin(dut)
    await FallingEdge(dut.clk_i)
    dut.is_owed_i.value = 1
    assert await error_after(bench, PATIENCE - 8) == 0
    assert await error_after(bench, 16) == ERROR["STUCK"]


@cocotb.test()
async def what_moves_or_has_nothing_to_do_is_not_stuck(dut):
    bench = await begin(dut)
    assert await error_after(bench, 3 * PATIENCE) == 0, "without words"
    bench.flush_answers = False
    bench.queue += [COMMAND["FLUSH"] << 24, COMMAND["FENCE"] << 24, 9]
    for _ in range(6):  # slow, and not dead
        assert await error_after(bench, PATIENCE // 2) == 0
        await bench.pulse(dut.moves_i)
    bench.flush_answers = True
    assert await error_after(bench, 3 * PATIENCE) == 0 and [tag for tag, _ in bench.fences] == [9]


@cocotb.test()
async def a_display_may_be_slow(dut):
    bench = Bench(dut)
    bench.shows = False
    await bench.start()
    bench.queue += [*clear(bench.package).words, COMMAND["FLUSH"] << 24, COMMAND["PRESENT"] << 24, 0x1000, 0x2000,
                    COMMAND["WAIT_VBLANK"] << 24]
    assert await error_after(bench, 4 * PATIENCE) == 0
    bench.shows = True
    await bench.settle()
    assert not bench.queue and bench.error() == 0
