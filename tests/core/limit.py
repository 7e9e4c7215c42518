"""Ends a simulation that takes too long. run.py puts it before a bench when there is a fault, which may make tests wait for ever."""

import os

from cocotb import simulator
from cocotb.utils import get_sim_steps

LIMIT = int(os.environ["HALFPLANE_LIMIT"])  # ns


def end(*_):
    print(f"no end after {LIMIT} ns", flush=True)
    os._exit(1)


ending = simulator.register_timed_callback(get_sim_steps(LIMIT, "ns"), end)  # kept: without it the callback is gone
