"""The student's edge unit in Icarus, driven by cocotb, beside fine_raster of Halfplane, which is called through ctypes: no files.

Random edges over a whole tile, many of them through pixel centres; the first pixel that differs ends it. run.sh sets up what
this needs; docs/your-rtl.md.
"""

import random

import cocotb
import halfplane
from cocotb.triggers import Timer

SIDE = 4  # pixels of a tile
TILES = 200


def random_edges(generator):
    """Of three edges (value, step_x, step_y): small steps, and a value that makes the edge pass through some pixel."""
    steps = [(generator.randint(-32, 31), generator.randint(-32, 31)) for _ in range(3)]
    return [(-x * generator.randrange(SIDE) - y * generator.randrange(SIDE), x, y) for x, y in steps]


def covered_by_model(stage, edges):
    """The pixels of a tile that fine_raster covers, row by row: a stamp of `tiny` is one pixel."""
    tile = {"is_visit": 1, "ends_primitive": 1, "right": SIDE - 1, "bottom": SIDE - 1}
    stage.put("tile", tile | {f"edge_value[{e}]": value for e, (value, _, _) in enumerate(edges)})
    stage.put("edges", {f"step_{c}[{e}]": edge[1 + i] for e, edge in enumerate(edges) for i, c in enumerate("xy")})
    covered = set()
    while (stamp := stage.get("stamp")) is not None:
        if stamp["mask"]:
            covered.add(stamp["stamp"])
    return covered


async def is_inside(dut, edge, x, y):
    """What the edge unit says of a pixel."""
    dut.value_i.value, dut.step_x_i.value, dut.step_y_i.value = edge
    dut.x_i.value, dut.y_i.value = x, y
    await Timer(1, "ns")
    return int(dut.inside_o.value) == 1


@cocotb.test()
async def edge_unit_is_fine_raster(dut):
    generator = random.Random(1)
    stage = halfplane.Stage(halfplane.Config("tiny", **{"tile.size": SIDE}), "fine_raster")
    inside = 0
    for tile in range(TILES):
        edges = random_edges(generator)
        covered = covered_by_model(stage, edges)
        for pixel in range(SIDE * SIDE):
            mine = True
            for edge in edges:
                mine = mine and await is_inside(dut, edge, pixel % SIDE, pixel // SIDE)
            model = pixel in covered
            inside += mine
            assert mine == model, f"tile {tile}, pixel {pixel}: edge_unit says {mine}, the model {model}; edges {edges}"
    assert inside > 0, "nothing was inside"
    dut._log.info("%d tiles of seed 1, %d pixels inside: equal", TILES, inside)
