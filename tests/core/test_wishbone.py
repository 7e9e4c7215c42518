"""halfplane_core on Wishbone, the module that soc/wishbone_shell.py writes: pictures of the model, and errors of the bus told as
those of AXI are."""

import random
from dataclasses import dataclass

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import RisingEdge
from command_words import COMMAND, ERROR
from core_bench import IDLE, REGISTERS, RING, RUNNING, SIZE, WRITTEN, Core
from core_bench import ERROR as ERROR_IRQ

BENCH = {
    "top": "wishbone_core",
    "settings": {"memory.port_bits": "32"},
    "generated": {"halfplane_core_wishbone.sv": "soc/wishbone_shell.py"},
    "sources": ["core/core_pkg.sv", "tests/core/core_checkers.sv"],
    "faults": [
        # An error of a read, or of a write, is not told; it is told for the burst's last beat alone, or for the next burst too.
        ("halfplane_core_wishbone.sv", "assign memory_r_payload_resp = (read_error ?", "assign memory_r_payload_resp = (read_error && !FAULT ?", "errors"),
        ("halfplane_core_wishbone.sv", "assign memory_b_payload_resp = (write_error ?", "assign memory_b_payload_resp = (write_error && !FAULT ?", "errors"),
        ("halfplane_core_wishbone.sv", "write_error <= (write_error | memory_err);", "write_error <= (write_error && !FAULT) | memory_err;", "one_beat"),
        ("halfplane_core_wishbone.sv", "if ((memory_b_valid & memory_b_ready)) begin", "if (memory_b_valid && memory_b_ready && !FAULT) begin", "one_beat"),
        # err alone does not end a beat.
        ("halfplane_core_wishbone.sv", "assign inner_ack = (memory_ack | memory_err);", "assign inner_ack = (memory_ack | (memory_err && !FAULT));", "one_beat"),
        # A request is taken back; a register answers nobody: the ports' checkers alone say so.
        ("halfplane_core_wishbone.sv", "registers_ack <= 1'd0;", "registers_ack <= FAULT;", "frames"),
        ("halfplane_core_wishbone.sv", "assign memory_stb = inner_stb;", "assign memory_stb = inner_stb && !(FAULT && registers_stb);", "frames"),
        # A register's error is not told.
        ("halfplane_core_wishbone.sv", "registers_err <= 1'd1;", "registers_err <= !FAULT;", "part_of_a_word"),
    ],
}
READ_ERROR, WRITE_ERROR = 1 << 12, 1 << 13


@dataclass
class Behaviour:
    latency: tuple = (0, 6)  # cycles from the request to ack: least and most
    fails: object = None     # fails(address, is_write): the beat ends with err
    acks: float = 0.5        # probability of ack with it


class Memory:
    def __init__(self, dut, behaviour, rng):
        self.dut, self.behaviour, self.random, self.bytes = dut, behaviour, rng, bytearray(SIZE)

    async def run(self):
        d, wait, request = self.dut, None, None
        d.memory_ack.value = d.memory_err.value = 0
        while True:
            await RisingEdge(d.clk_i)
            answered, d.memory_ack.value, d.memory_err.value = request, 0, 0
            request = None
            if answered or d.memory_stb.value != 1 or d.rst_ni.value != 1:
                wait = None
                continue
            if wait is None:
                wait = self.random.randint(*self.behaviour.latency)
            if wait:
                wait -= 1
                continue
            request, at, is_write = True, int(d.memory_adr.value) * 4 % SIZE, d.memory_we.value == 1
            failed = self.behaviour.fails is not None and self.behaviour.fails(at, is_write)
            d.memory_err.value = failed
            d.memory_ack.value = not failed or self.random.random() < self.behaviour.acks
            if not is_write:
                d.memory_dat_r.value = self.random.getrandbits(32) if failed else int.from_bytes(self.bytes[at:at + 4], "little")
            elif not failed:
                raw, sel = int(d.memory_dat_w.value).to_bytes(4, "little"), int(d.memory_sel.value)
                for i in range(4):
                    if sel >> i & 1:
                        self.bytes[at + i] = raw[i]


class WishboneCore(Core):
    async def start(self):
        d = self.dut
        d.rst_ni.value = d.registers_cyc.value = d.registers_stb.value = 0
        d.video_ready.value = 1
        cocotb.start_soon(Clock(d.clk_i, 2, "ns").start())
        self.memory = Memory(d, self.behaviour, self.random)
        cocotb.start_soon(self.memory.run())
        await self.cycles(5)
        d.rst_ni.value = 1
        await self.cycles(10)
        await self.set_up()

    async def access(self, register, value=None, sel=15):
        """A read, or with a value a write; returns what is read and whether err came."""
        d = self.dut
        d.registers_adr.value, d.registers_sel.value, d.registers_we.value = REGISTERS[register] // 4, sel, value is not None
        d.registers_dat_w.value = value or 0
        d.registers_cyc.value = d.registers_stb.value = 1
        for _ in range(200):
            await RisingEdge(d.clk_i)
            if d.registers_ack.value == 1 or d.registers_err.value == 1:
                break
        else:
            raise AssertionError(f"no answer of {register}")
        data, error = d.registers_dat_r.value, d.registers_err.value == 1
        d.registers_cyc.value = d.registers_stb.value = 0
        for _ in range(self.random.randint(1, 4)):
            await RisingEdge(d.clk_i)
        return int(data) if data.is_resolvable else 0, error

    async def write(self, register, value):
        assert not (await self.access(register, value))[1], register

    async def read(self, register):
        data, error = await self.access(register)
        assert not error, register
        return data


def frame_of(core, seed, size, primitives):
    return core.frame(core.scene(cocotb.RANDOM_SEED * 1000 + seed, size, size, primitives=primitives), **BENCH["settings"])


@cocotb.test()
async def frames_are_the_model_s(dut):
    core = WishboneCore(dut, Behaviour())
    await core.start()
    assert await core.read("ID") == 0x48504C4E
    for seed in range(2):
        frame = frame_of(core, seed, 48, 8)
        await core.draw(frame)
        core.check(frame)


@cocotb.test()
async def errors_of_memory_are_reported_and_survived(dut):
    core = WishboneCore(dut, Behaviour(latency=(0, 2)))
    await core.start()
    frame = frame_of(core, 10, 96, 10)  # larger than the caches
    await core.write("IRQ_ENABLE", ERROR_IRQ)
    for what, bits in ((False, READ_ERROR), (True, WRITE_ERROR)):
        core.behaviour.fails = lambda at, is_write, what=what: is_write == what and not RING <= at < RING + 0x100000
        await core.send(core.words(frame))
        await core.fence(core.tag)
        status = await core.wait(IDLE | WRITTEN, "after the fence")
        assert status & (READ_ERROR | WRITE_ERROR) == bits and status & RUNNING, f"STATUS {status:#x}, not {bits:#x} of the errors"
        assert dut.irq.value == 1
        core.behaviour.fails = None
        await core.restart()
        await core.write("IRQ_PENDING", 31)
        assert await core.read("STATUS") >> 12 & 7 == 0 and dut.irq.value == 0
        await core.draw(frame)
        core.check(frame)
    core.behaviour.fails = lambda at, is_write: RING <= at < RING + 0x100000
    before = core.tail
    await core.send([COMMAND["NOP"] << 24] * 3)
    for _ in range(300):
        await RisingEdge(dut.clk_i)
    assert await core.read("STATUS") >> 8 & 15 == ERROR["BUS"] and await core.read("WORDS") == before + 1 and dut.irq.value == 1


@cocotb.test()
async def an_error_of_one_beat_is_one_of_its_burst_and_of_no_other(dut):
    core = WishboneCore(dut, Behaviour(latency=(0, 1), acks=0))
    await core.start()
    frame = frame_of(core, 20, 48, 5)
    failed = []

    def begins_a_burst(at, is_write):
        """The first write to the first beat of a block, once."""
        if is_write and at % 64 == 0 and not failed:
            failed.append(at)
            return True
        return False

    core.behaviour.fails = begins_a_burst
    await core.send(core.words(frame))
    await core.fence(core.tag)
    assert failed, "no write begins a burst"
    assert await core.read("STATUS") & (READ_ERROR | WRITE_ERROR) == WRITE_ERROR
    core.behaviour.fails = None
    await core.restart()
    await core.draw(frame)
    core.check(frame)
    assert await core.read("STATUS") & (READ_ERROR | WRITE_ERROR) == 0


@cocotb.test()
async def a_write_of_part_of_a_word_is_answered_with_err(dut):
    core = WishboneCore(dut, Behaviour())
    await core.start()
    rng = random.Random(cocotb.RANDOM_SEED)
    for _ in range(20):
        sel, value = rng.randint(1, 15), rng.getrandbits(5)
        before = await core.read("IRQ_ENABLE")
        assert (await core.access("IRQ_ENABLE", value, sel))[1] == (sel != 15)
        assert await core.read("IRQ_ENABLE") == (value if sel == 15 else before)
