"""A frame that stays, drawn on from buffers: the picture that `halfplane render` makes of the same commands, by its hashes.

usage: test_target.py PROGRAM
"""

import array
import json
import math
import struct
import subprocess
import sys
import tempfile

import halfplane

try:
    import numpy
except ImportError:  # then buffers of the standard library alone are tried
    numpy = None

WIDTH, HEIGHT = 90, 70
LAYOUT = halfplane.Layout(20, position=("f32", 4, 0), color=("u8", 4, 16))  # four floats, four bytes
TEXELS = bytes(range(256))  # 8 x 8, four bytes each


def fnv1a(data):
    """The hash of the program's pages, docs/interface.md."""
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 % (1 << 64)
    return f"{value:016x}"


def corners(turn):
    """A fan about the middle, in clip space, with w of 1 to 3: x y z w and colours, as floats of 32 bits have them."""
    rows = [(0.0, 0.0, 0.0, 1.0, 255, 255, 255, 255)]
    for i in range(7):
        angle, w = turn + i, 1 + i % 3
        at = [math.cos(angle) * w, math.sin(angle) * w, 0.5 * w, w]
        rows.append((*struct.unpack("4f", struct.pack("4f", *at)), 30 * i, 255 - 30 * i, 128, 255))
    return rows


def capture(turns):
    text = f"halfplane 1\ntarget {WIDTH} {HEIGHT}\ntexture T inline rgba8888 8 8 mips box\ntexels {TEXELS.hex()}\n"
    text += "clear color 10 20 30 255 depth 1\nstate depth_test lequal\nstate texture T\nstate texture_combine add\n"
    for number, turn in enumerate(turns):
        for row in corners(turn):
            text += "v " + " ".join(float(value).hex() for value in row) + "\n"
        text += "tf " + " ".join(str(8 * number + i) for i in range(8)) + "\n"
    return text


def rendered(program, text):
    with tempfile.NamedTemporaryFile("w", suffix=".hpt", encoding="ascii") as file:
        file.write(text)
        file.flush()
        said = subprocess.run([program, "render", file.name, "--json"], capture_output=True, check=True)
    result = json.loads(said.stdout)
    return result["color_hash"], result["depth_hash"]


def hashes(target):
    """Of `embedded`: rgb565, little-endian, and depth as words of 32 bits."""
    color, depth = target.plane("color"), target.plane("depth")
    return fnv1a(array.array("H", color).tobytes()), fnv1a(depth.tobytes())


def draw(target, turn, form):
    rows = corners(turn)
    indices = array.array("I", range(8))
    if form == "rows":
        target.draw(rows, topology="triangle_fan")
    elif form == "layout":
        packed = b"".join(struct.pack("4f4B", *row) for row in rows)
        target.draw(packed, LAYOUT, indices, "triangle_fan")
    elif form == "view":
        doubles = memoryview(array.array("d", (value for row in rows for value in row))).cast("B")
        target.draw(doubles.cast("d", (8, 8)), None, list(indices), "triangle_fan")
    else:
        order = numpy.arange(8, dtype=numpy.uint32)
        target.draw(numpy.array(rows, dtype=numpy.float64), None, order, "triangle_fan")


def refusal(call, *arguments, **named):
    try:
        call(*arguments, **named)
    except halfplane.Error as error:
        return str(error)
    raise AssertionError(f"{call.__name__} takes {arguments} {named}")


def main(program):
    turns = [0.0, 0.3, 0.7, 1.9]
    wanted = rendered(program, capture(turns))
    config = halfplane.Config("embedded")
    forms = ["rows", "layout", "view"] + (["numpy"] if numpy else [])
    for form in forms:
        for threads in (1, 3):
            target = halfplane.Target(config, WIDTH, HEIGHT, threads=threads)
            target.texture("T", 8, 8, TEXELS, mips="box")
            target.clear(color=(10, 20, 30, 255), depth=1)
            target.say("state depth_test lequal\nstate texture T\nstate texture_combine add\n")
            for turn in turns:
                draw(target, turn, form)
            assert hashes(target) == wanted, f"{form}, {threads} threads: {hashes(target)}, the program {wanted}"
            frame = halfplane.Frame(halfplane.Scene(capture(turns)), config, threads=threads)
            assert frame.plane("color") == target.plane("color")

    mine = array.array("I", bytes(4 * WIDTH * HEIGHT))
    assert target.plane("depth", into=mine) == target.plane("depth") and any(mine)
    if numpy:
        assert numpy.asarray(target.plane("depth")).reshape(HEIGHT, WIDTH)[0, 0] == mine[0]
    before = hashes(target)
    rows = corners(0)
    assert "room for 3 values" in refusal(target.plane, "color", into=array.array("I", [0] * 3))
    assert "can be written" in refusal(target.plane, "color", into=bytes(4 * WIDTH * HEIGHT))
    assert "the draw has 8 vertices" in refusal(target.draw, rows, indices=[0, 1, 8])
    assert "4, 8 or 10 numbers" in refusal(target.draw, [[1, 2, 3]])
    assert "different lengths" in refusal(target.draw, [[0, 0, 0, 1], [0] * 8])
    assert "give a layout" in refusal(target.draw, bytes(64))
    assert "no type 'f16'" in refusal(halfplane.Layout, 8, position=("f16", 4, 0))
    assert "4 bytes for 8x8 texels" in refusal(target.texture, "T", 8, 8, b"four")
    assert "lines:1: " in refusal(target.say, "state cul none")
    assert hashes(target) == before
    target.draw(rows, indices=[])
    assert hashes(target) == before
    print(f"equal by {', '.join(forms)}")


if __name__ == "__main__":
    main(sys.argv[1])
