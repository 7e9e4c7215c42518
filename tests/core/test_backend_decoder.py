"""The software backend's decoder (driver/backend) refuses what command_decoder refuses, at the same word for the same reason, and
makes the same packets of all other streams: random ones, and right ones with faults.

HALFPLANE_LONG=N: N times as many streams.
"""

import collections
import json
import os
import pathlib
import random
import subprocess

import cocotb
from cocotb.triggers import FallingEdge
from command_words import COMMAND, ERROR, FLUSH, LINE, REGISTER, STATE, STREAM, TRIANGLE, Encoder, Package
from test_command_decoder import Bench

BENCH = [
    {
        "top": "command_decoder",
        "configs": ["textured"],  # a texture unit and no blending
        "sources": ["core/core_pkg.sv"],
        "faults": [
            # A reserved bit is not looked at; a base changes under a drawing; a box may end beyond the target.
            ("core/command_decoder.sv", "reserved = word_i[23:12] != '0 ||", "reserved = (word_i[23:12] != '0 && !FAULT) ||"),
            ("core/command_decoder.sv", "STATE_REGISTER_TARGET) && drawn_q)", "STATE_REGISTER_TARGET) && drawn_q && !FAULT)"),
            ("core/command_decoder.sv", "target_right_q < right_q", "(target_right_q < right_q && !FAULT)"),
            # A clear is of a buffer less; STOP is none; another order of errors.
            ("core/command_decoder.sv", "FAST_CLEAR && flags_q[1];", "FAST_CLEAR && flags_q[1] && !FAULT;"),
            ("core/command_decoder.sv", "if (is_stop) running_q", "if (is_stop && !FAULT) running_q"),
            ("core/command_decoder.sv", "needs_target && !cleared_q)", "needs_target && !cleared_q && !(FAULT && is_bad_box))"),
        ],
    },
    # With little; with blending and no texture unit.
    {"top": "command_decoder", "configs": ["small", "sampled"], "sources": ["core/core_pkg.sv"]},
]


def fields_of(opcode):
    return next((c.get("fields", []) for c in STREAM["command"] if c["opcode"] == opcode), [])


class Streams:
    """Random streams of a configuration."""

    def __init__(self, package, seed):
        self.package, self.random = package, random.Random(seed)

    def payload(self, count):
        r = self.random
        return [r.choice((0, 1, 0xFFFFFFFF, r.getrandbits(32), r.getrandbits(32))) for _ in range(count)]

    def register(self, number):
        r = self.random
        name = list(REGISTER)[number]
        if name == "TARGET":
            return r.randrange(64) | r.randrange(64) << 16
        if name.startswith("BOX"):
            least, end = (0, 8) if name == "BOX_MIN" else (7, 64 if r.random() < 0.9 else 80)
            return r.randrange(least, end) | r.randrange(least, end) << 16
        return r.getrandbits(32)

    def command(self):
        """A command that is right by itself, most often."""
        r, p = self.random, self.package
        opcode = r.choice(list(COMMAND.values()))
        header = 0
        for _, low, bits in fields_of(opcode):
            header |= r.getrandbits(bits) << low
        words, name = [], next(n for n, o in COMMAND.items() if o == opcode)
        if name == "SET":
            first = r.randrange(3) if r.random() < 0.85 else r.randrange(10)
            count = r.randint(1, min(3 - first, 3) if first < 3 else 10 - first)
            header, words = first | count << 8, [self.register(first + i) for i in range(count)]
        elif name in ("FENCE", "PRESENT"):
            words = self.payload(1 if name == "FENCE" else 2)
        elif name == "TRIANGLE":
            header = header & 0xF if not p.over_words or r.random() < 0.5 else header | 16
            header |= 7 if r.random() < 0.6 else 0
            words = self.payload(bin(header & 7).count("1") * (1 + p.affine_words) + (header >> 4) * (3 * p.over_words + p.frame_words))
        elif name in ("RECTANGLE", "POINT", "CLEAR"):
            words = self.payload(p.affine_words)
            header = r.choice((1, 2, 3, 3, 6, 9, 10, 11)) if name == "CLEAR" else 0
            if not p.CACHE_KIND and r.random() < 0.8:
                header &= 3
        elif name == "LINE":
            words = [0] * p.line_words if r.random() < 0.8 else self.payload(p.line_words)
        elif name == "STATE":
            words = self.payload(p.affine_words + p.state_words)
        elif name == "FLUSH" and not p.CACHE_KIND:
            header &= r.random() < 0.1
        units = (name == "LINE" and not p.LINES_UNIT) or (name == "STATE" and header not in p.unit_registers)
        return [] if units and r.random() < 0.9 else [opcode << 24 | header, *words]

    def begin(self):
        e = Encoder(self.package)
        e.set({name: self.register(number) for name, number in REGISTER.items()})
        e.set(dict(TARGET=63 | 63 << 16))
        e.command("CLEAR", 3, self.payload(self.package.affine_words))
        return e.words

    def stream(self):
        r = self.random
        words = self.begin() if r.random() < 0.95 else []
        for _ in range(r.randint(1, 12)):
            words += self.command()
        for _ in range(r.choice((0, 0, 1, 1, 2, 4)) if words else 0):  # faults
            at = r.randrange(len(words))
            what = r.randrange(6)
            if what == 0:
                words[at] ^= 1 << r.randrange(32)
            elif what == 1:
                del words[at]
            elif what == 2:
                words.insert(at, r.choice(words))
            elif what == 3:
                words.insert(at, r.choice((*COMMAND.values(), 6, 0x15, 0x18, 0xFF)) << 24 | r.getrandbits(12))
            elif what == 4:
                words.insert(at, COMMAND["FLUSH"] << 24)
            else:
                words.insert(at, COMMAND["SET"] << 24 | r.randrange(16) | r.randrange(16) << 8)
            if not words:
                break
        return words or [0]


def what_counts(package, packet):
    """The fields of a packet that hardware looks at."""
    f = package.unpack(packet)
    kept = {name: f[name] for name, _ in package.fields() if name not in ("primitive_id", "x", "y", "code", "front_cw", "coordinates")}
    if f["kind"] in (LINE, STATE):
        for side in ("left", "top", "right", "bottom"):
            del kept[side]
    if f["kind"] == TRIANGLE:
        kept.update(front=f["front_cw"], vertices=f["vertices"], frame=f["coordinates"])
    elif f["kind"] == STATE:
        low = package.ALL_AFFINE_CODE_BITS
        kept["word"] = (f["vertices"][0][2] | f["vertices"][0][3] << low) & (1 << package.STATE_WORD_BITS) - 1
    elif f["kind"] not in (FLUSH, LINE):
        kept["codes"] = [vertex[:3] for vertex in f["vertices"]]
    return kept


@cocotb.test()
async def the_backend_refuses_and_makes_what_the_core_does(dut):
    config, seed = os.environ["HALFPLANE_CONFIG"], cocotb.RANDOM_SEED
    packages = pathlib.Path(os.environ["HALFPLANE_PACKAGES"])
    package = Package(packages / config / "raster_pkg.sv")
    maker = Streams(package, seed)
    streams = [maker.stream() for _ in range(500 * int(os.environ.get("HALFPLANE_LONG", 1)))]
    text = "\n".join(" ".join(f"{word:x}" for word in words) for words in streams) + "\n"
    tool = packages.parents[1] / "tests/core/halfplane_decode_words"
    done = subprocess.run([tool, config], input=text, capture_output=True, text=True, check=True)
    results = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(results) == len(streams)

    bench = Bench(dut)
    await bench.start()
    mask = (1 << package.LINE_SETUP_BITS - package.PRIMITIVE_ID_BITS) - 1
    outcomes = collections.Counter()
    for number, (words, wanted) in enumerate(zip(streams, results)):
        where = f"seed {seed}, stream {number}: {' '.join(f'{word:08x}' for word in words)}\nbackend: {wanted}\ncore: "
        for kept in (bench.packets, bench.lines, bench.fences, bench.presents):
            kept.clear()
        await FallingEdge(dut.clk_i)
        await bench.reset()
        await bench.pulse(dut.start_i)
        bench.queue += words
        starts = 1
        while True:  # started again after each STOP
            await bench.settle()
            if dut.is_running_o.value == 1 or bench.error() or not bench.queue:
                break
            await bench.pulse(dut.start_i)
            starts += 1
        outcome, taken = wanted["outcome"], int(dut.words_o.value)
        where += f"error {bench.error()}, {taken} words, {len(bench.packets)} packets"
        packets = [int(packet, 16) for packet in wanted["packets"]]
        if outcome == "refused":
            assert (bench.error(), taken) == (wanted["error"], wanted["words"]), where
        elif outcome == "taken":
            assert (bench.error(), taken, starts) == (0, len(words), wanted["starts"]), where
        else:  # undefined: the core goes on, as it likes
            at = int(outcome.split()[1])
            assert taken >= at and (bench.error() == 0 or taken > at or bench.error() == ERROR["BAD_BOX"]), where
            del bench.packets[len(packets):]
        outcomes[outcome if outcome == "taken" else next(n for n, e in ERROR.items() if e == wanted["error"]) if outcome == "refused"
                 else "undefined"] += 1
        assert len(bench.packets) == len(packets), where
        for mine, model in zip(bench.packets, packets):
            assert what_counts(package, mine) == what_counts(package, model), \
                f"{where}\n{what_counts(package, mine)}\n{what_counts(package, model)}"
        if outcome in ("refused", "taken"):
            assert bench.lines == [int(line, 16) & mask for line in wanted["lines"]], where
            assert [tag for tag, _ in bench.fences] == wanted["fences"], where
            assert [list(shown[:2]) for shown in bench.presents] == wanted["presented"], where
            if words[0] == COMMAND["SET"] << 24 | len(REGISTER) << 8 and outcome == "taken":
                assert int(dut.layout_o.value) == int(wanted["layout"], 16), where
    dut._log.info("%s, seed %d: %d streams, %s", config, seed, len(streams), dict(outcomes))
    rare = {"NONE", "BUS", "STUCK"} | ({"NOT_SUPPORTED"} if package.unit_registers else set())
    assert all(outcomes[name] > 0 for name in ERROR if name not in rare) and outcomes["taken"] > len(streams) / 10
