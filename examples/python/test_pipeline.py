"""A scoreboard for a rasterizer of somebody else's: examples/foreign_rasterizer beside Halfplane's pipeline, triangle by triangle.
Its four bugs are caught at the first triangle that they change.

usage: test_pipeline.py
"""

import pathlib
import sys

import halfplane
from halfplane import Pipeline

FOREIGN = pathlib.Path(__file__).resolve().parents[1] / "foreign_rasterizer"
sys.path.append(str(FOREIGN))
sys.dont_write_bytecode = True
import rasterizer

CONFIG = halfplane.Config("embedded")
CULL = halfplane.Stage(CONFIG, "cull").inputs[0]  # for the fields of primitive packets
TRIANGLE = 0  # of primitive_kind_t


class Scoreboard:
    """Says of each primitive which pixels are written otherwise than the model writes them."""

    def __init__(self, design_id):
        self.model = Pipeline(CONFIG, design_id, Pipeline.WRITES | Pipeline.RETIRED)

    def wrong_pixels(self, primitive, written):
        """`written`: {(x, y): (depth, color)}, the last write to each pixel."""
        self.model.put_primitive(primitive)
        expected = {}
        while (event := self.model.event()).kind != Pipeline.RETIRED:
            expected[event.x, event.y] = event.depth, event.color
        return sorted(at for at in expected.keys() | written.keys() if expected.get(at) != written.get(at))


def first_difference(bug):
    """None, or triangle and pixel."""
    width, height, clear_color, clear_depth, triangles = rasterizer.read_capture(FOREIGN / "scene.hpt")
    pixels = [(x, y) for y in range(height) for x in range(width)]
    color = dict.fromkeys(pixels, rasterizer.stored(clear_color, bug))
    depth = dict.fromkeys(pixels, int(clear_depth * rasterizer.DEPTH_MAX + 0.5))
    scoreboard, number = Scoreboard(CONFIG.id()), 0
    for primitive, _ in halfplane.Host(halfplane.Scene((FOREIGN / "scene.hpt").read_text()), CONFIG):
        written = {}
        if CULL.packet(primitive)["kind"] == TRIANGLE:
            before = {at: (depth[at], color[at]) for at in pixels}
            rasterizer.draw(triangles[number], width, height, color, depth, bug)
            changed = (at for at in pixels if (depth[at], color[at]) != before[at])
            written = {at: (depth[at], color[at][0] << 11 | color[at][1] << 5 | color[at][2]) for at in changed}
        if wrong := scoreboard.wrong_pixels(primitive, written):
            return f"triangle {number}, pixel {wrong[0]}"
        number += CULL.packet(primitive)["kind"] == TRIANGLE
    assert number == len(triangles)
    return None


def main():
    equal = first_difference(None)
    assert equal is None, equal
    for bug in rasterizer.BUGS:
        difference = first_difference(bug)
        print(bug, difference, sep=": ")
        assert difference is not None, f"{bug} is not caught"
    try:
        Scoreboard(CONFIG.id() ^ 1)
    except halfplane.Error as error:
        assert "CONFIG_ID" in str(error)
    else:
        raise AssertionError("a design of another configuration is not refused")


if __name__ == "__main__":
    main()
