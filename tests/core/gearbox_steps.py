#!/usr/bin/env python3
"""The gearbox of soc/display.py alone: the bits of each channel are those of the words, the least first, without a gap,
and the channels are in step.

usage: gearbox_steps.py    with build/python's python; status 1 when a word is wrong
"""

import pathlib
import random
import sys

from migen import passive, run_simulation

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "soc"))
import display  # noqa: E402

CHANNELS, WORDS = 3, 200
FILLED = 20  # words that pass before the crossing between the clocks is filled for certain


@passive
def feed(gearbox, sent, rng):
    while True:
        sent.append([rng.getrandbits(10) for _ in range(CHANNELS)])
        yield gearbox.words.eq(sum(word << 10 * channel for channel, word in enumerate(sent[-1])))
        yield


def watch(gearbox, bits):
    for _ in range(5 * WORDS):
        yield
        for channel, pair in enumerate(gearbox.pairs):
            value = yield pair
            bits[channel] += [value & 1, value >> 1]


def words(phase):
    """Words that left, or None, where the pixels' clock rises so much after that of the bits; ten is its period."""
    gearbox, sent, bits = display.Gearbox(CHANNELS, "pixel"), [], [[] for _ in range(CHANNELS)]
    generators = {"pixel": feed(gearbox, sent, random.Random(phase)), "pixel5x": watch(gearbox, bits)}
    run_simulation(gearbox, generators, clocks={"pixel": (10, phase), "pixel5x": 2})
    kept = sent[FILLED:-FILLED]
    want = [[word[channel] >> bit & 1 for word in kept for bit in range(10)] for channel in range(CHANNELS)]
    at = next((at for at in range(len(bits[0])) if bits[0][at : at + len(want[0])] == want[0]), None)
    if at is None or any(got[at : at + len(wanted)] != wanted for got, wanted in zip(bits, want)):
        return None
    return len(kept)


def main():
    counts = [words(phase) for phase in range(0, 10, 2)]
    if None in counts:
        print(f"phase {2 * counts.index(None)}: bits that are not those of the words, or channels out of step")
        return 1
    print(f"{sum(counts)} words on {CHANNELS} channels")
    return 0


if __name__ == "__main__":
    sys.exit(main())
