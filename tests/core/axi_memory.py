"""A memory on an AXI4 port that does whatever AXI allows with one ID, once a clock.

Reads and writes are not ordered: each read looks at memory at any time between AR and R, each write reaches memory at any
time between its last beat and B. Of each channel the order stays. An error response leaves memory as it is, and a read
with it carries noise.
"""

from collections import deque
from dataclasses import dataclass

from cocotb.triggers import RisingEdge


@dataclass
class Behaviour:
    latency: tuple = (1, 8)       # cycles, from the last of the request to the answer: least and most
    ready: float = 1.0            # probability that an address or a beat is taken in a cycle
    valid: float = 1.0            # probability that a due answer is given
    eager_reads: float = 0.5      # probability that a read looks at memory when its address is taken, not when answered
    lazy_writes: float = 0.5      # probability that a write reaches memory only with B
    errors: float = 0.0           # of an error response to a burst
    answers: bool = True          # False: nothing is answered until it is set


class Unconnected:
    """A signal of a channel that the port does not have."""
    value = 0


class Memory:
    """`content`: the bytes of another memory, to share; a port without writes has the channels of reads alone."""

    def __init__(self, dut, size, behaviour, random, prefix="m_axi", content=None):
        self.dut, self.behaviour, self.random = dut, behaviour, random
        self.bytes = bytearray(size) if content is None else content
        self.s = {n: getattr(dut, f"{prefix}_{n}") for n in "arvalid arready araddr arlen rvalid rready rdata rlast rresp".split()}
        for n in "awvalid awready awaddr awlen wvalid wready wdata wstrb wlast bvalid bready bresp".split():
            self.s[n] = getattr(dut, f"{prefix}_{n}") if hasattr(dut, f"{prefix}_awvalid") else Unconnected()
        self.beat = len(self.s["rdata"]) // 8
        self.cycle = 0
        self.counts = dict(ar=0, aw=0, r=0, w=0, b=0, errors=0)
        self.trace = None  # a list: (cycle, "AR" or "AW", address, beats)
        self.forget()

    def forget(self):
        """As the reset of the bus: nothing is owed any more."""
        self.aw, self.w, self.written = deque(), deque(), deque()  # addresses; whole bursts of data; bursts owed B
        self.burst, self.reads = [], deque()                       # data of the burst under way; reads owed R
        self.give_b = self.give_r = None
        self.driven = {}  # the last value of each
        for name in ("awready", "wready", "arready", "bvalid", "rvalid"):
            self.put(name, False)
        self.taking = dict(aw=False, w=False, ar=False)

    def put(self, name, value):
        """Drives a flag; most clocks change none, and a write costs more than all else here."""
        if self.driven.get(name) is not value:
            self.driven[name] = value
            self.s[name].value = value

    def due(self):
        return self.cycle + self.random.randint(*self.behaviour.latency)

    def look(self, read):
        if read["data"] is None:
            at = read["address"] % len(self.bytes)
            read["data"] = [int.from_bytes(self.bytes[at + i * self.beat: at + (i + 1) * self.beat], "little")
                            for i in range(read["length"])]

    def store(self, write):
        if not write["stored"] and not write["error"]:
            for i, (data, strobe) in enumerate(write["beats"]):
                at = (write["address"] + i * self.beat) % len(self.bytes)
                raw = data.to_bytes(self.beat, "little")
                for b in range(self.beat):
                    if strobe >> b & 1:
                        self.bytes[at + b] = raw[b]
        write["stored"] = True

    def has_error(self):
        error = self.random.random() < self.behaviour.errors
        self.counts["errors"] += error
        return error

    def take(self):
        """What moved at this edge: the handshakes of the values before it."""
        s, b = self.s, self.behaviour
        if self.taking["aw"] and s["awvalid"].value == 1:
            self.aw.append((int(s["awaddr"].value), int(s["awlen"].value) + 1))
            self.counts["aw"] += 1
        if self.taking["w"] and s["wvalid"].value == 1:
            self.burst.append((int(s["wdata"].value), int(s["wstrb"].value)))
            self.counts["w"] += 1
            if s["wlast"].value == 1:
                self.w.append(self.burst)
                self.burst = []
        if self.taking["ar"] and s["arvalid"].value == 1:
            read = dict(address=int(s["araddr"].value), length=int(s["arlen"].value) + 1, data=None, next=0,
                        due=self.due(), error=self.has_error())
            self.counts["ar"] += 1
            if self.trace is not None:
                self.trace.append((self.cycle, "AR", read["address"], read["length"]))
            if self.random.random() < b.eager_reads:
                self.look(read)
            self.reads.append(read)
        while self.aw and self.w:
            address, length = self.aw.popleft()
            write = dict(address=address, beats=self.w.popleft(), stored=False, due=self.due(), error=self.has_error())
            assert len(write["beats"]) == length
            if self.trace is not None:
                self.trace.append((self.cycle, "AW", address, length))
            write["lazy"] = self.random.random() < b.lazy_writes
            self.written.append(write)
        if self.give_b is not None and s["bready"].value == 1:
            self.give_b = None
            self.counts["b"] += 1
        if self.give_r is not None and s["rready"].value == 1:
            self.counts["r"] += 1
            self.give_r["next"] += 1
            if self.give_r["next"] == self.give_r["length"]:
                self.reads.popleft()
            self.give_r = None

    def drive(self):
        """What is on offer in the next cycle."""
        s, b, r = self.s, self.behaviour, self.random.random
        for name in ("aw", "w", "ar"):
            self.taking[name] = b.ready >= 1 or r() < b.ready
            self.put(name + "ready", self.taking[name])
        # Writes reach memory in order: a lazy write holds back later writes.
        for write in self.written:
            if write["lazy"] and not write["stored"]:
                break
            self.store(write)
        if self.give_b is None and self.written and self.written[0]["due"] <= self.cycle and b.answers and (
                b.valid >= 1 or r() < b.valid):
            self.give_b = self.written.popleft()
            self.store(self.give_b)
            s["bresp"].value = 2 + (self.cycle & 1) if self.give_b["error"] else 0
        self.put("bvalid", self.give_b is not None)
        if self.give_r is None and self.reads and self.reads[0]["due"] <= self.cycle and b.answers and (
                b.valid >= 1 or r() < b.valid):
            self.give_r = read = self.reads[0]
            self.look(read)
            i = read["next"]
            s["rdata"].value = self.random.getrandbits(8 * self.beat) if read["error"] else read["data"][i]
            s["rresp"].value = 2 + (self.cycle & 1) if read["error"] else 0
            s["rlast"].value = i + 1 == read["length"]
        self.put("rvalid", self.give_r is not None)

    @property
    def is_idle(self):
        return not (self.aw or self.w or self.burst or self.written or self.reads or self.give_b or self.give_r)

    async def run(self):
        while True:
            await RisingEdge(self.dut.clk_i)
            self.take()
            self.cycle += 1
            self.drive()
