"""A student's edge unit in Python against fine_raster of Halfplane; with `bug` it forgets ties, and is caught.

usage: test_edge_unit.py [bug]    The status is 0 when they are equal, 1 when not; without a word, 0 when both are as they
should be.
"""

import random
import sys

import halfplane

SIDE = 4  # pixels of a tile, `tiny`


def is_inside(value, step_x, step_y, x, y, has_bug):
    at_pixel = value + step_x * x + step_y * y
    return at_pixel > 0 if has_bug else at_pixel >= 0


def first_difference(has_bug, tiles=500, seed=1):
    """None, or what differs, in words."""
    random.seed(seed)
    stage = halfplane.Stage(halfplane.Config("tiny", **{"tile.size": SIDE}), "fine_raster")
    for tile in range(tiles):
        steps = [(random.randint(-32, 31), random.randint(-32, 31)) for _ in range(3)]
        values = [-sx * random.randrange(SIDE) - sy * random.randrange(SIDE) for sx, sy in steps]
        packet = {"is_visit": 1, "ends_primitive": 1, "right": SIDE - 1, "bottom": SIDE - 1}
        stage.put("tile", packet | {f"edge_value[{e}]": values[e] for e in range(3)})
        stage.put("edges", {f"step_{c}[{e}]": steps[e][i] for e in range(3) for i, c in enumerate("xy")})
        model = set()
        while (stamp := stage.get("stamp")) is not None:
            if stamp["mask"]:
                model.add(stamp["stamp"])
        for pixel in range(SIDE * SIDE):
            mine = all(is_inside(v, sx, sy, pixel % SIDE, pixel // SIDE, has_bug) for v, (sx, sy) in zip(values, steps))
            if mine != (pixel in model):
                return f"tile {tile}, pixel {pixel}: the edge unit says {mine}, the model {pixel in model}"
    return None


def assert_arrays_are_a_capture():
    """The same scene by arrays and as a capture."""
    rows = [[1, 1, 0.25, 1, 255, 0, 0, 255], [15, 2, 0.5, 1, 0, 255, 0, 255], [3, 14, 0.75, 1, 0, 0, 255, 255]]
    arrays = halfplane.ArrayScene(16, 16, "clear color 0 0 0 255 depth 1\nspace window")
    first = arrays.vertices(rows)
    arrays.draw([first, first + 1, first + 2])
    text = "".join("v " + " ".join(map(str, row)) + "\n" for row in rows)
    head = "halfplane 1\ntarget 16 16\nclear color 0 0 0 255 depth 1\nspace window\n"
    config = halfplane.Config("tiny")
    frames = [halfplane.Frame(scene, config) for scene in (arrays, halfplane.Scene(f"{head}{text}t 0 1 2\n"))]
    assert frames[0].plane("color") == frames[1].plane("color")
    assert any(frames[0].plane("color"))


def main(words):
    if words:
        difference = first_difference(words == ["bug"])
        print(difference or "equal")
        return 1 if difference else 0
    assert_arrays_are_a_capture()
    wrong, caught = first_difference(False), first_difference(True)
    print(wrong or "without the bug: equal", caught or "the bug is not caught", sep="\n")
    return 1 if wrong or not caught else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
