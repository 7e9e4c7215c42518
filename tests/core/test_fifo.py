"""The FIFO of rtl_ref/lib beside a queue, under random valid and ready."""

import collections
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, Timer

BENCH = {
    "top": "fifo",
    "parameters": {"WIDTH": 8, "DEPTH": 4},
    "faults": [
        ("rtl_ref/lib/fifo.sv", "valid_i && ready_o", "valid_i && (ready_o || FAULT)", "items_leave"),
        ("rtl_ref/lib/fifo.sv", "valid_o && ready_i", "valid_o && (ready_i && !FAULT)", "items_leave"),
    ],
}


@cocotb.test(timeout_time=1, timeout_unit="ms")
async def items_leave_in_order(dut):
    generator = random.Random(cocotb.RANDOM_SEED)
    cocotb.start_soon(Clock(dut.clk_i, 10, "ns").start())
    dut.rst_ni.value = 0
    dut.valid_i.value = dut.ready_i.value = 0
    await Timer(25, "ns")
    dut.rst_ni.value = 1
    model, left = collections.deque(), 0
    while left < 500:
        await FallingEdge(dut.clk_i)
        dut.valid_i.value, dut.ready_i.value = generator.randint(0, 1), generator.randint(0, 1)
        dut.data_i.value = generator.randrange(256)
        await Timer(1, "ns")
        if dut.valid_o.value and dut.ready_i.value:
            assert int(dut.data_o.value) == model.popleft(), f"item {left}"
            left += 1
        if dut.valid_i.value and dut.ready_o.value:
            model.append(int(dut.data_i.value))
        assert len(model) <= 4
