"""The ports to memory alone: a model of raster_top's port on one side, a memory that reorders on the other.

Everything random comes from the seed of run.py.
"""

import random
from collections import deque

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import RisingEdge, Timer

from axi_memory import Behaviour, Memory

BENCH = [{
    "top": "axi_ports",  # embedded: single beats are read
    "faults": [
        # A read passes an unanswered write to its place.
        ("core/axi_frame_port.sv", "age < NUMBER'(pending_q)", "age < NUMBER'(pending_q) && !FAULT", "every_read"),
        # Only the last granule of a burst is noted.
        ("core/axi_frame_port.sv", "(is_clearing || takes_write)", "(is_clearing || (takes_write && !(FAULT && !ends)))",
         "every_read"),
        # A read is sent without room for its answer.
        ("core/axi_frame_port.sv", "room_q > ROOM'(frame_arlen)", "(room_q > ROOM'(frame_arlen) || FAULT)", "nobody"),
        # A write is answered when it is sent.
        ("core/axi_frame_port.sv", "assign is_owed = is_answered;", "assign is_owed = FAULT ? enters_burst : is_answered;",
         "every_read"),
        # A burst is a beat short.
        ("core/axi_frame_port.sv", "8'(4'(length - first))", "8'(4'(length - first - 4'(FAULT)))", "every_read"),
        ("core/axi_frame_port.sv", "(frame_rvalid && frame_rerror)", "(frame_rvalid && frame_rerror && !FAULT)", "errors"),
        ("core/axi_frame_port.sv", "(is_answered && m_axi_bresp[1])", "(is_answered && m_axi_bresp[1] && !FAULT)", "errors"),
        # An old answer is given after a restart.
        ("core/axi_frame_port.sv", "assign answer_valid_o    = !forgets_q && ",
         "assign answer_valid_o    = (!forgets_q || FAULT) && ", "late_answer"),
        # The port forgets for a cycle.
        ("core/axi_frame_port.sv", "forget_i || (forgets_q && !idle_o)", "forget_i || (forgets_q && !idle_o && !FAULT)",
         "late_answer"),
        # Half a burst stays after a restart.
        ("core/burst_fifo.sv", "drops_i ? whole_q :", "drops_i && !FAULT ? whole_q :", "late_answer"),
        # A request that ends with its window has a burst more.
        ("core/burst_split.sv", "more_q <= LEFT'(in_window)", "more_q + LEFT'(FAULT) <= LEFT'(in_window)", "every_read"),
        # The base is not added.
        ("core/axi_texture_port.sv", "32'(texture_i.address) + texture_base_i",
         "32'(texture_i.address) + (FAULT ? '0 : texture_base_i)", "every_read"),
        # An address on offer is taken back for another client's.
        ("core/axi_arbiter.sv", "if (!waits_q)", "if (!waits_q || FAULT)", "every_read"),
        # Data go to the client that asks now.
        ("core/axi_arbiter.sv", "(CLIENTS'(1) << answered)", "(CLIENTS'(1) << (FAULT ? client : answered))",
         "every_read"),
        # Scan-out is served last.
        ("core/axi_arbiter.sv", "if (s_arvalid[i])", "if (s_arvalid[i] && !(FAULT && i == 0 && |(s_arvalid >> 1)))", "scan_out"),
    ],
}, {
    "top": "axi_ports",
    "configs": ["small"],  # buffers of tiles are read and written, in several bursts
    "faults": [
        ("core/axi_frame_port.sv", "age < NUMBER'(pending_q)", "age < NUMBER'(pending_q) && !FAULT", "every_read"),
        # Each part of a write that was cut is answered.
        ("core/axi_frame_port.sv", "is_answered && is_last", "is_answered && (is_last || FAULT)", "every_read"),
        # A part is a beat short.
        ("core/axi_frame_port.sv", "(SPLITS && index == '1)", "(SPLITS && index == ~4'(FAULT))", "every_read"),
        ("core/burst_split.sv", "more_q <= LEFT'(in_window)", "more_q + LEFT'(FAULT) <= LEFT'(in_window)", "every_read"),
    ],
}]
SIZE = 1 << 16


class RasterPort:
    """Bursts as raster_top gives them: a place is written only after what was read there has been answered."""

    def __init__(self, dut, memory, rng, reads=0.7, places=12, ready=1.0):
        self.dut, self.memory, self.rng, self.bytes = dut, memory, rng, memory.beat
        self.buffer, self.read = int(dut.buffer_bytes_o.value), int(dut.read_beats_o.value)
        self.shadow = bytearray(memory.bytes)
        self.reads, self.ready = reads, ready
        self.places = [rng.randrange(SIZE // self.buffer) * self.buffer for _ in range(places if self.read == 1 else 4)]
        self.beats, self.expected, self.held = deque(), deque(), []
        self.bursts = self.write_answers = self.read_answers = self.unwritten = 0
        self.left = 0          # bursts still to make
        self.taking = False
        self.wrong = 0         # of answers whose data are not checked: error responses
        self.trusts = True

    def make(self):
        """The next burst, or none if a place waits for its answer."""
        if self.held:
            operation = self.held.pop()
        else:
            base = self.rng.choice(self.places)
            beats = self.buffer // self.bytes
            if self.rng.random() < self.reads:
                operation = ("read", base + self.rng.randrange(beats // self.read) * self.read * self.bytes, self.read)
            else:
                first = self.rng.randrange(beats)
                if self.rng.random() < 0.5:  # one line, as for an evicted block
                    first -= first % 4
                    operation = ("write", base + first * self.bytes, min(4, beats - first))
                else:
                    operation = ("write", base + first * self.bytes, self.rng.randint(1, beats - first))
        kind, address, length = operation
        if kind == "write":
            end = address + length * self.bytes
            if any(a < end and address < a + self.bytes for a, _ in self.expected):
                self.held.append(operation)
                return
        self.left -= 1
        self.bursts += 1
        for i in range(length if kind == "write" else 1):
            self.beats.append((kind == "write", i == 0, address + i * self.bytes, length - i,
                               self.rng.getrandbits(self.bytes) if self.rng.random() < 0.7 else 0,
                               self.rng.getrandbits(8 * self.bytes)))

    def take(self):
        dut = self.dut
        if dut.beat_valid.value == 1 and dut.beat_ready.value == 1:
            is_write, _, address, length, strobe, data = self.beats.popleft()
            if is_write:
                raw = data.to_bytes(self.bytes, "little")
                for b in range(self.bytes):
                    if strobe >> b & 1:
                        self.shadow[address + b] = raw[b]
                if length == 1:
                    self.unwritten += 1
            else:
                for i in range(length):
                    at = address + i * self.bytes
                    self.expected.append((at, bytes(self.shadow[at:at + self.bytes])))
        if self.taking and dut.answer_valid.value == 1:
            if dut.answer_is_write.value == 1:
                self.write_answers += 1
                self.unwritten -= 1
                assert self.unwritten >= 0, "an answer to a write before its last beat"
                assert self.write_answers <= self.memory.counts["b"], "an answer to a write before B"
            else:
                assert self.expected, "an answer to no read"
                at, want = self.expected.popleft()
                got = int(dut.answer_data.value).to_bytes(self.bytes, "little")
                if got != want:
                    self.wrong += 1
                    assert not self.trusts, f"read {self.read_answers} at {at:#x}: {got.hex()}, not {want.hex()}"
                self.read_answers += 1

    def drive(self):
        dut = self.dut
        if not self.beats and self.left > 0:
            self.make()
        offers = bool(self.beats) and self.rng.random() < 0.9 or (dut.beat_valid.value == 1 and bool(self.beats) and
                                                                  self.is_offered)
        self.is_offered = offers
        dut.beat_valid.value = offers
        if offers:
            (dut.beat_is_write.value, dut.beat_is_first.value, dut.beat_address.value, dut.beat_length.value,
             dut.beat_strobe.value, dut.beat_data.value) = self.beats[0]
        self.taking = self.ready >= 1 or self.rng.random() < self.ready
        dut.answer_ready.value = self.taking

    is_offered = False
    must_restart = False  # set by a test: forget_i, and everything of raster_top begins anew

    def restart(self):
        """Power-on: what was asked for is nobody's any more."""
        self.left = self.unwritten = 0
        self.is_offered = False
        self.beats.clear()
        self.held.clear()
        self.expected.clear()

    @property
    def is_done(self):
        return self.left <= 0 and not self.beats and not self.held and not self.expected and self.unwritten == 0


class Reader:
    """A client of the arbiter that reads constant memory: textures and scan-out."""

    def __init__(self, dut, memory, rng, prefix, rate):
        self.dut, self.rng, self.rate, self.memory = dut, rng, rate, memory
        self.is_texture = prefix == "texture"
        self.request = None
        self.expected = deque()
        self.beats = self.left = 0
        self.trusts = True

    def take(self):
        dut, size = self.dut, self.memory.beat
        ready = dut.texture_ready if self.is_texture else dut.scan_arready
        if self.request and ready.value == 1:
            address, length = self.request
            for i in range(length):
                at = address + i * size
                self.expected.append(int.from_bytes(self.memory.bytes[at:at + size], "little"))
            self.request = None
        valid = dut.texel_valid if self.is_texture else dut.scan_rvalid
        if valid.value == 1:
            data = int((dut.texel_data if self.is_texture else dut.scan_rdata).value)
            assert self.expected, "data for nobody"
            want = self.expected.popleft()
            assert data == want or not self.trusts, f"{'texel' if self.is_texture else 'scan-out'} {self.beats}: {data:x}"
            self.beats += 1

    def drive(self):
        dut, size = self.dut, self.memory.beat
        if self.request is None and self.left > 0 and self.rng.random() < self.rate:
            self.left -= 1
            if self.is_texture:
                length = (16 << self.rng.randrange(3)) // size
                self.request = (SIZE + self.rng.randrange(SIZE // 16 - 4) * 16, length)
            else:
                first = self.rng.randrange(SIZE // size - 16)
                self.request = (SIZE + first * size, self.rng.randint(1, 16 - first % 16))
        if self.is_texture:
            dut.texture_valid.value = self.request is not None
            if self.request:  # above the base
                dut.texture_address.value, dut.texture_beats.value = self.request[0] - SIZE, self.request[1]
        else:
            dut.scan_arvalid.value = self.request is not None
            if self.request:
                dut.scan_araddr.value, dut.scan_arlen.value = self.request[0], self.request[1] - 1

    def restart(self):
        self.left, self.request = 0, None
        self.expected.clear()

    @property
    def is_done(self):
        return self.left <= 0 and self.request is None and not self.expected


async def start(dut, behaviour, rng, **port):
    """After power-on: the memory with random contents, the port, two readers, all stepped once a clock."""
    for name in ("forget_i", "clear_errors_i", "beat_valid", "answer_ready", "texture_valid", "scan_arvalid"):
        getattr(dut, name).value = 0
    dut.texel_ready.value = 1
    dut.texture_base.value = SIZE
    dut.rst_ni.value = 0
    memory = Memory(dut, 2 * SIZE, behaviour, rng)
    memory.bytes[:] = rng.randbytes(len(memory.bytes))
    await Timer(1, "ns")
    raster = RasterPort(dut, memory, rng, **port)
    raster.shadow = bytearray(memory.bytes)
    readers = [Reader(dut, memory, rng, "scan", 0.1), Reader(dut, memory, rng, "texture", 0.2)]
    cocotb.start_soon(Clock(dut.clk_i, 10, unit="ns").start())
    for _ in range(3):
        await RisingEdge(dut.clk_i)
    dut.rst_ni.value = 1

    async def step():
        forgets = False
        while True:
            await RisingEdge(dut.clk_i)
            for part in (memory, readers[0], *([] if forgets else [raster, readers[1]])):
                part.take()
            memory.cycle += 1
            forgets, raster.must_restart = raster.must_restart, False
            dut.forget_i.value = forgets
            if forgets:
                raster.restart()
                readers[1].restart()
            for part in (memory, raster, *readers):
                part.drive()

    cocotb.start_soon(step())
    scale = 8 if raster.read > 1 else 1  # reads of tiles take as many cycles as 32 of stamps
    return memory, raster, readers, scale


async def finish(dut, parts, limit):
    cycles = 0
    while not (all(p.is_done for p in parts) and dut.frame_idle_o.value == 1 and dut.texture_idle_o.value == 1 and
               dut.arbiter_idle_o.value == 1):
        await RisingEdge(dut.clk_i)
        cycles += 1
        assert cycles < limit, "the ports hang"
    return cycles


BEHAVIOURS = {
    "fast": Behaviour(latency=(1, 1)),
    "lazy": Behaviour(latency=(20, 40), eager_reads=1, lazy_writes=1),
    "slow": Behaviour(latency=(1, 300), ready=0.3, valid=0.3),
    "late": Behaviour(latency=(300, 300), ready=0.8),
}


@cocotb.test()
@cocotb.parametrize(name=list(BEHAVIOURS), answers=[1.0, 0.2])
async def every_read_sees_the_writes_before_it(dut, name, answers):
    rng = random.Random(cocotb.RANDOM_SEED)
    memory, raster, readers, scale = await start(dut, BEHAVIOURS[name], rng, ready=answers)
    raster.left = (400 if name in ("fast", "lazy") else 120) // scale
    for reader in readers:
        reader.left = raster.left * scale // 8
    cycles = await finish(dut, [raster, *readers], 60000)
    assert raster.write_answers and raster.read_answers and all(r.beats for r in readers)
    assert memory.bytes[:SIZE] == raster.shadow[:SIZE]
    assert memory.is_idle and not dut.read_error_o.value and not dut.write_error_o.value
    dut._log.info(f"{raster.write_answers} writes, {raster.read_answers} reads, {cycles} cycles")


@cocotb.test()
async def errors_are_reported_and_survived(dut):
    rng = random.Random(cocotb.RANDOM_SEED)
    memory, raster, readers, scale = await start(dut, Behaviour(latency=(2, 30), errors=0.2), rng)
    raster.trusts = readers[0].trusts = readers[1].trusts = False
    raster.left, readers[0].left, readers[1].left = 200 // scale, 20, 20
    await finish(dut, [raster, *readers], 60000)
    assert memory.counts["errors"] > 5
    assert dut.read_error_o.value == 1 and dut.write_error_o.value == 1 and dut.texture_error_o.value == 1
    memory.behaviour.errors = 0
    dut.clear_errors_i.value = 1
    await RisingEdge(dut.clk_i)
    dut.clear_errors_i.value = 0
    raster.shadow[:] = memory.bytes
    raster.trusts = readers[0].trusts = readers[1].trusts = True
    raster.left, readers[0].left, readers[1].left = 100 // scale, 20, 20
    await finish(dut, [raster, *readers], 60000)
    assert dut.read_error_o.value == 0 and dut.write_error_o.value == 0 and dut.texture_error_o.value == 0
    assert memory.bytes[:SIZE] == raster.shadow[:SIZE]


@cocotb.test()
async def a_late_answer_after_a_restart_is_dropped(dut):
    """The memory stops, raster_top is powered on again in the middle of a burst, and the old answers come later."""
    rng = random.Random(cocotb.RANDOM_SEED)
    memory, raster, readers, scale = await start(dut, Behaviour(latency=(2, 30)), rng)
    held = 0
    for turn in range(12):
        raster.left, readers[1].left = 60, 10
        for _ in range(rng.randint(20, 200)):
            await RisingEdge(dut.clk_i)
        memory.behaviour.answers = turn % 3 == 0
        for _ in range(rng.randint(1, 100)):
            await RisingEdge(dut.clk_i)
        raster.must_restart = True
        for _ in range(2):
            await RisingEdge(dut.clk_i)
        seen = raster.read_answers + raster.write_answers, readers[1].beats
        raster.left, readers[1].left = 20 // scale, 5
        for _ in range(50):
            await RisingEdge(dut.clk_i)
        if not memory.behaviour.answers and not memory.is_idle:
            assert seen == (raster.read_answers + raster.write_answers, readers[1].beats)
            held += 1
        memory.behaviour.answers = True
        raster.trusts = False  # bytes that a dropped burst has written are not known
        await finish(dut, [raster, *readers], 20000)
        raster.shadow[:] = memory.bytes
        raster.trusts = True
        raster.left, readers[0].left, readers[1].left = 40 // scale, 5, 5
        await finish(dut, [raster, *readers], 20000)
        assert memory.bytes[:SIZE] == raster.shadow[:SIZE]
    assert held > 1


@cocotb.test()
async def scan_out_is_served_before_all_others(dut):
    """An address of scan-out waits for at most one other address: the one that is on offer already."""
    rng = random.Random(cocotb.RANDOM_SEED)
    memory, raster, readers, scale = await start(dut, Behaviour(latency=(4, 4), ready=0.5), rng, reads=1.0)
    raster.left, readers[0].left, readers[1].left = 400 // scale, 60, 100
    waits = others = most = 0
    for _ in range(2000):
        await RisingEdge(dut.clk_i)
        if dut.scan_arvalid.value == 1:
            if dut.m_axi_arvalid.value == 1 and dut.m_axi_arready.value == 1:
                if dut.scan_arready.value == 1:
                    most, others, waits = max(most, others), 0, waits + 1
                else:
                    others += 1
    assert waits > 20 and most <= 1
    await finish(dut, [raster, *readers], 20000)


@cocotb.test()
async def nobody_waits_for_a_framebuffer_that_takes_no_answers(dut):
    rng = random.Random(cocotb.RANDOM_SEED)
    memory, raster, readers, scale = await start(dut, Behaviour(latency=(4, 10)), rng, reads=1.0, ready=0.0)
    raster.left, readers[0].left, readers[1].left = 100, 20, 20
    cycles = 0
    while not (readers[0].is_done and readers[1].is_done):
        await RisingEdge(dut.clk_i)
        cycles += 1
        assert cycles < 2000, "a reader waits"
    assert raster.read_answers == 0 and not raster.is_done
    raster.ready = 0.5
    await finish(dut, [raster, *readers], 20000)
