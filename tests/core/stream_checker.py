#!/usr/bin/env python3
"""command_stream_checker says what is wrong with a stream, and nothing of a right one.

usage: stream_checker.py VERILATOR PACKAGES FOLDER
"""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from command_words import COMMAND, Encoder, Package  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]


def stream(package, *parts, ends=True):
    """A frame with the parts in it: words, or functions of the encoder."""
    e = Encoder(package)
    e.layout(0, 128, 0x8000, 0x9000, 0x800)
    e.set(dict(TARGET=63 | 63 << 16, BOX_MIN=0, BOX_MAX=63 | 63 << 16, STATE=0x19))
    e.command("CLEAR", 3, [0] * package.affine_words)
    for part in parts:
        part(e) if callable(part) else e.words.append(part)
    if ends:
        e.command("FLUSH")
        e.command("FENCE", 0, [1])
    return e.words


def cases(p):
    """(what is said, the words); nothing is said of the first ones."""
    codes, vertex = [0] * p.affine_words, [0] * (1 + p.affine_words)
    triangle = lambda load: lambda e: e.command("TRIANGLE", load, vertex * bin(load).count("1"))
    yield "", stream(p, triangle(7), triangle(1), lambda e: e.command("RECTANGLE", 0, codes), triangle(7))
    yield "", stream(p, triangle(7), lambda e: e.command("FLUSH"), lambda e: e.command("PRESENT", 0, [0, 0]))
    yield "draws before the state is set", without(p, "STATE", triangle(7))
    yield "draws before the box is set", without(p, "BOX_MAX", triangle(7))
    yield "draws before the layout is set", without(p, "ROW_STRIDE", triangle(7))
    yield "is a triangle without a vertex in slot 2", stream(p, triangle(3))
    yield "is a triangle without a vertex in slot 0", stream(p, triangle(7), lambda e: e.command("POINT", 0, codes), triangle(6))
    yield "presents a picture of which 2 primitives may not be in memory", stream(p, triangle(7), lambda e: e.command("PRESENT", 0, [0, 0]))
    yield "has bits above those of the codes", stream(p, lambda e: e.command("RECTANGLE", 0, codes[:-1] + [1 << 31]))
    yield "is no command; was the header before it right", stream(p, 0x80000000)
    yield "sets a bit that its command does not have", stream(p, COMMAND["FLUSH"] << 24 | 8)
    yield "sets registers that are not there; there are 10", stream(p, COMMAND["SET"] << 24 | 9 | 2 << 8)
    yield "changes target or addresses while drawings are on the chip alone", stream(p, COMMAND["SET"] << 24 | 4 | 1 << 8, 0)
    yield "draws before the target is cleared", stream(p, lambda e: e.command("FLUSH"), lambda e: e.set(dict(TARGET=1)), triangle(7))
    yield "draws in a box that is inverted or ends beyond the target", stream(p, lambda e: e.set(dict(BOX_MAX=64)), triangle(7))
    yield "needs a unit that this configuration lacks", stream(p, COMMAND["STATE"] << 24)
    yield "the stream ends within a command: 1 words are missing", stream(p, lambda e: e.command("FLUSH"), COMMAND["FENCE"] << 24, ends=False)
    yield "the stream ends with 2 drawings after the last FLUSH", stream(p, triangle(7), ends=False)
    yield "it waits for an earlier fence, flush, picture or layout", stream(p) + stream(p)[-3:]


def without(package, register, part):
    """A stream in which a state register is never set."""
    e = Encoder(package)
    plain = e.set
    e.set = lambda values: plain({k: v for k, v in values.items() if k != register})
    e.layout(0, 128, 0x8000, 0x9000, 0x800)
    e.set(dict(TARGET=63 | 63 << 16, BOX_MIN=0, BOX_MAX=63 | 63 << 16, STATE=0x19))
    e.command("CLEAR", 3, [0] * package.affine_words)
    part(e)
    e.command("FLUSH")
    return e.words


def main():
    verilator, package, folder = sys.argv[1], pathlib.Path(sys.argv[2]) / "embedded/raster_pkg.sv", pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    build = subprocess.run(
        [verilator, "--binary", "--timing", "--assert", "-Wno-fatal", "-Wno-lint", "--top-module", "stream_player", "--Mdir", folder / "obj",
         "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0", package, ROOT / "core/core_pkg.sv", ROOT / "core/command_decoder.sv",
         ROOT / "core/command_stream_checker.sv", ROOT / "tests/core/stream_player.sv", "-o", "player"], capture_output=True, text=True)
    if build.returncode != 0:
        sys.exit(build.stdout + build.stderr)
    failures = count = 0
    for said, words in cases(Package(package)):
        count += 1
        (folder / "words.hex").write_text("".join(f"{word:08x}\n" for word in words))
        options = ["+silent"] if said.startswith("it waits") else []
        done = subprocess.run([folder / "obj/player", f"+words={folder}/words.hex", f"+count={len(words)}", *options], capture_output=True,
                              text=True)
        text = done.stdout + done.stderr
        errors = [line for line in text.splitlines() if "Error" in line]
        if bool(errors) != bool(said) or said not in text:
            failures += 1
            print(f"expected '{said}', got: {errors or 'nothing'}")
    print(f"{count - failures} of {count} streams are judged as they should be")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main())
