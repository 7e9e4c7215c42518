#!/usr/bin/env python3
"""soc/display.py alone, pixels that come late among others: every pixel that is shown is the next one of its frame, a frame
begins at the screen's first pixel, and a frame whose pixels are all in time is shown whole.

usage: display_steps.py [SEED]    with build/python's python; status 1 when a frame is wrong
"""

import pathlib
import random
import sys

from migen import passive, run_simulation

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "soc"))
import display  # noqa: E402

WIDTH, HEIGHT, FRAMES = 10, 6, 40
TIMINGS = {"pix_clk": 0, "h_active": WIDTH, "h_blanking": 12, "h_sync_offset": 2, "h_sync_width": 3,
           "v_active": HEIGHT, "v_blanking": 6, "v_sync_offset": 1, "v_sync_width": 2}  # fmt: skip


@passive
def feed(shell, rng):
    """Frames of pixels whose number is their data; every third frame is late somewhere, and the fifth has too few of them."""
    frame = 0
    while True:
        for number in range(WIDTH * HEIGHT - 7 * (frame == 5)):
            if frame % 3 == 2 and rng.random() < 0.05:
                for _ in range(rng.choice((1, 3, 40, 400))):
                    yield
            yield shell.sink.valid.eq(1)
            yield shell.sink.data.eq(number + 1)
            yield shell.sink.user.eq(number == 0)
            yield
            while not (yield shell.sink.ready):
                yield
            yield shell.sink.valid.eq(0)
        frame += 1


def watch(shell, rng, frames):
    """What is shown of each frame: places on the screen and numbers."""
    was_vsync, place = 0, 0
    while len(frames) < FRAMES + 1:
        ready = rng.random() < 0.8
        yield shell.source.ready.eq(ready)
        yield
        if not (yield shell.source.ready) or not (yield shell.source.valid):
            continue
        vsync = yield shell.source.vsync
        if vsync and not was_vsync:
            frames.append([])
            place = 0
        was_vsync = vsync
        if (yield shell.source.de):
            color = (yield shell.source.r) << 16 | (yield shell.source.g) << 8 | (yield shell.source.b)
            if (yield shell.is_pixel) and frames:
                frames[-1].append((place, color - 1))
            elif color:
                sys.exit("a pixel of nobody is not black")
            place += 1
    if place > WIDTH * HEIGHT:
        sys.exit(f"{place} places in a frame")


def main():
    seed = int(sys.argv[1]) if sys.argv[1:] else 1
    rng, frames, shell = random.Random(seed), [], display.Display(TIMINGS)
    run_simulation(shell, [feed(shell, rng), watch(shell, rng, frames)])
    whole = 0
    for shown in frames[:FRAMES]:
        if [number for _, number in shown] != list(range(len(shown))) or any(place < number for place, number in shown):
            print(f"seed {seed}: not the pixels of one frame in their order: {shown}")
            return 1
        whole += shown == [(number, number) for number in range(WIDTH * HEIGHT)]
    print(f"seed {seed}: {whole} of {FRAMES} frames shown whole")
    return 0 if FRAMES // 3 < whole < FRAMES else 1  # a third come late, and some of the later ones do


if __name__ == "__main__":
    sys.exit(main())
