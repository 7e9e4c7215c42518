"""One start of a simulation for many runs: run.py puts this module before a bench. What is imported and set up is the same for
each of them; then a run is a process of its own, a copy of this one, in a folder of its own."""

import atexit
import importlib
import json
import os
import pathlib
import sys

from cocotb import simulator
from cocotb.utils import get_sim_steps


def begin(fault, tests, limit):
    """In the copy: a fault's number, which the RTL reads, 0 for none; a regular expression; ns after which it ends, 0: never."""
    folder = pathlib.Path(str(fault))
    folder.mkdir()
    os.chdir(folder)
    pathlib.Path("fault").write_text(f"{fault:x}")
    log = os.open("simulation.log", os.O_WRONLY | os.O_CREAT)
    os.dup2(log, sys.stdout.fileno())
    os.dup2(log, sys.stderr.fileno())
    atexit.register(os._exit, 0)  # the copy has no thread of Verilator's pool, which its end would wait for
    os.environ["COCOTB_TEST_FILTER"] = tests
    os.environ["COCOTB_RESULTS_FILE"] = "results.xml"
    return simulator.register_timed_callback(get_sim_steps(limit, "ns"), end, limit) if limit else None


def end(limit):
    print(f"no end after {limit} ns", flush=True)
    os._exit(1)


importlib.import_module(os.environ["HALFPLANE_BENCH"])
for run in json.loads(os.environ["HALFPLANE_RUNS"]):
    sys.stdout.flush()
    sys.stderr.flush()
    process = os.fork()
    if process == 0:
        ending = begin(**run)  # kept: without it the callback is gone
        break
    os.waitpid(process, 0)
else:
    os._exit(0)
