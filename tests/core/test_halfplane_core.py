"""halfplane_core as a whole: random scenes through ring, pipeline and memory are the model's pictures, whatever the bus does."""

import cocotb
from axi_memory import Behaviour
from core_bench import Core, random_scene

BENCH = {
    "top": "halfplane_core",
    "sources": ["core/core_pkg.sv"],
    "parameters": {"SCAN_OUT": 0},
}


@cocotb.test()
async def a_triangle_is_the_model_s(dut):
    core = Core(dut)
    await core.start()
    frame = core.frame("halfplane 1\ntarget 64 64\nspace window\nclear color 10 20 30 255 depth 1\nv 5 5 .5 1 255 0 0 255\n"
                       "v 60 9 .5 1 0 255 0 255\nv 20 58 .5 1 0 0 255 255\nt 0 1 2\n")
    await core.draw(frame)
    core.check(frame)


@cocotb.test()
async def random_scenes_are_the_model_s(dut):
    core = Core(dut)
    await core.start()
    for seed in range(3):
        frame = core.frame(random_scene(seed + 1))
        await core.draw(frame, where=seed % 2 * 0x10000)
        core.check(frame, where=seed % 2 * 0x10000)
