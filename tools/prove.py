#!/usr/bin/env python3
"""./dev prove: the proofs about the RTL, each with a broken twin that must fail. docs/proofs.md says what they mean.

A proof is a file of tests/formal, put in front of `endmodule` of a module of rtl_ref, with the package of a preset. The
MiniSat inside Yosys (or z3, --z3) then shows that no assertion fails in the first cycles (the base) and that none can fail
when none has failed for k cycles (the step). Together: never. The twin is the same with one fault in the RTL. What cannot
be shown so is enumerated: Proofs.* of halfplane_unit_tests (--program).

Runs in the repository's root; build/prove keeps every design and log. Exit status: 0 all proven and every twin caught,
1 not so, 2 wrong usage, 3 a tool is missing.
"""
import argparse
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib

from prove_list import PROOFS

RTL = pathlib.Path('rtl_ref')
FORMAL = pathlib.Path('tests/formal')
DESIGNS = [name for table in tomllib.loads(pathlib.Path('model/designs.toml').read_text(encoding='utf-8')).values() for name in table]
ENUMERATIONS = 'Proofs.*'


class Broken(Exception):
    """What stops a proof before the solver has its say."""


@dataclasses.dataclass
class Outcome:
    """What one proof came to, with one preset."""
    proof: object
    preset: str
    proven: bool
    caught: list  # by twin: how it was found, or None
    seconds: float
    twin_seconds: float
    remark: str = ''

    @property
    def good(self):
        return self.proven and None not in self.caught


def once(text, old, new, where):
    """`text` with its only `old` replaced."""
    if text.count(old) != 1:
        raise Broken(f'{where}: this must occur exactly once, not {text.count(old)} times: {old}')
    return text.replace(old, new)


def seeded_faults():
    """The faults of mutants.cmake by number: (file, good text, bad text)."""
    text = (RTL / 'cosim/mutants.cmake').read_text(encoding='utf-8')
    found = re.findall(r'^mutant\((\d+) (\S+) "[^"]*"\s*\[=\[(.*?)\]=\]\s*\[=\[(.*?)\]=\]\)', text, flags=re.M | re.S)
    return {int(number): (file, good, bad) for number, file, good, bad in found}


def package_constant(package, name):
    match = re.search(rf'localparam int {name} = (\d+);', package)
    if match is None:
        raise Broken(f'no constant {name} in the package')
    return int(match[1])


def properties(proof):
    """The text of the properties; a cover is an assertion of the contrary, which must fail."""
    text = ''.join((FORMAL / f'{name}.sv').read_text(encoding='utf-8') for name in proof.properties)
    return re.sub(r'\bcover (\(.*\));', lambda match: f'cover_{match.start()}: assert (!{match[1]});', text)


def joined(text, name, module):
    """`text`, in which the text of `module` takes the place of its instance. Ports become what they are connected to, derived
    parameters local ones; what both declare alike is declared once."""
    instance = re.search(rf'^  {name} u_\w+ \((.*?)\n  \);\n', text, flags=re.M | re.S)
    nets = dict(re.findall(r'\.(\w+)\s*\((\w+)\)', instance[1]))
    head, body = re.search(rf'^module {name} (.*?)\n\);\n(.*)^endmodule', module, flags=re.M | re.S).groups()
    parameters = re.findall(r'parameter (int \w+ = .*?)(?:,|$)', head[:head.index(') (')].replace('\n', ',\n'), flags=re.M)
    body = ''.join(f'  localparam {p.split("//")[0].rstrip(", ")};\n' for p in parameters) + body
    body = re.sub(r'\.(\w+)(?=,)', lambda port: f'.{port[1]}({nets[port[1]]})' if port[1] in nets else port[0], body)
    body = re.sub(r'(?<![.\w])\w+', lambda word: nets.get(word[0], word[0]), body)
    for declared in re.findall(r'^  localparam .*?;|^  function .*?endfunction$', body, flags=re.M | re.S):
        if re.sub(r'\s+', ' ', declared) in re.sub(r'\s+', ' ', text):
            body = body.replace(declared, '', 1)
    body = re.sub(r'^  genvar .*;$', '', body, flags=re.M)
    return text[:instance.start()] + body + text[instance.end():]


def hierarchy(proof):
    """The module, and every module that it or its properties instantiate."""
    files = {path.stem: path for path in [*RTL.glob('lib/*.sv'), *RTL.glob('stages/*.sv')]}
    found, text = [RTL / proof.module], (RTL / proof.module).read_text(encoding='utf-8') + properties(proof)
    while text:
        used = [files[n] for n in re.findall(r'^\s+(\w+) (?:#\(|u_\w+ \()', text, flags=re.M) if n in files]
        new = [path for path in dict.fromkeys(used) if path not in found]
        found += new
        text = ''.join(path.read_text(encoding='utf-8') for path in new)
    return found


def sources(proof, package, folder, twin):
    """Writes package, library and stages into `folder`, the properties inside the module that they are about."""
    preset, package = package.parent.name, package.read_text(encoding='utf-8')
    for name, value, *only in proof.package:
        if only and preset not in only:
            continue
        package = re.sub(rf'(localparam int {name} =) \d+;', rf'\1 {value};', package)
    for struct, kind, name in proof.members:
        package = once(package, f'  }} {struct};', f'    {kind} {name};\n  }} {struct};', 'raster_pkg')
    (folder / 'raster_pkg.sv').write_text(package, encoding='utf-8')
    files = [folder / 'raster_pkg.sv']
    change = None
    if isinstance(twin, int):
        change = seeded_faults()[twin]
    elif twin is not None:
        change = (place_of_twin(proof, twin), *twin)

    def read(path):
        text = path.read_text(encoding='utf-8')
        if change and RTL / change[0] == path:
            text = once(text, change[1], f'({change[2]})' if isinstance(twin, int) else change[2], str(path))
        return text

    for path in hierarchy(proof):
        if path.stem in proof.joins:
            continue
        name = proof.module if path == RTL / proof.module else str(path.relative_to(RTL))
        text = read(path)
        if name == proof.module:
            for module in proof.joins:
                text = joined(text, module, read(RTL / f'stages/{module}.sv'))
            text = text.replace(');\n', ');\n  genvar s, v;\n', 1) if proof.joins else text
            for parameter, value in proof.parameters:  # not by -chparam: with it Yosys 0.23 derives no module twice
                value = value if isinstance(value, int) else package_constant(package, value)
                text, found = re.subn(rf'(parameter int {parameter} += )\w+', rf'\g<1>{value}', text, count=1)
                assert found, f'{name} has no parameter {parameter}'
            end = text.rindex('endmodule')
            text = text[:end] + properties(proof) + text[end:]
        for module, start in proof.starts:
            if module == name:
                end = text.rindex('endmodule')
                text = text[:end] + (FORMAL / f'{start}.sv').read_text(encoding='utf-8') + text[end:]
        copy = folder / path.name
        copy.write_text(text, encoding='utf-8')
        files.append(copy)
    (folder / 'all.txt').write_text(properties(proof), encoding='utf-8')
    return files


def place_of_twin(proof, twin):
    """The file of the proof's own text in which a twin changes something."""
    places = [proof.module, *(f'stages/{name}.sv' for name in proof.joins)]
    counts = {place: (RTL / place).read_text(encoding='utf-8').count(twin[0]) for place in places}
    found = [place for place in places if counts[place]]
    if len(found) != 1 or counts[found[0]] != 1:
        raise Broken(f'{proof.name}: in {", ".join(places)} this must occur exactly once, not {sum(counts.values())} times: {twin[0]}')
    return found[0]


def stale_twins():
    """Of every proof, run or not, the twins that are none any more, because the module reads otherwise."""
    faults, stale = seeded_faults(), []
    for proof in PROOFS:
        for twin in proof.twins:
            if isinstance(twin, int):
                if twin not in faults:
                    stale.append(f'{proof.name}: there is no mutant {twin}')
                continue
            try:
                place_of_twin(proof, twin)
            except Broken as error:
                stale.append(str(error))
    return stale


RUNNING = set()  # sessions, so that no solver outlives this program


def stop(*_):
    for process in list(RUNNING):
        os.killpg(process, signal.SIGKILL)
    os._exit(1)


def run(command, log, seconds):
    """Runs a command with its children, output to `log`; None when the time is up."""
    with open(log, 'w', encoding='utf-8') as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT, start_new_session=True)
        RUNNING.add(process.pid)
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return None
        finally:
            RUNNING.discard(process.pid)


def front_end(proof, package, folder, twin):
    """Yosys commands that give the flat design of a proof or of its twin."""
    folder.mkdir(parents=True, exist_ok=True)
    files = sources(proof, package, folder, twin)
    # What is cut out may give any result: what is shown then holds for the right one, too.
    cut = ''.join(f'cutpoint t:{cells}; ' for cells in proof.cuts)
    top = pathlib.Path(proof.module).stem
    wires = ''.join(f'connect -nomap -nounset -set {name} {inside}; ' for name, inside in proof.wires)
    return (f'read_verilog -sv -formal {" ".join(map(str, files))}; hierarchy -check -top {top}; proc; {cut}'
            f'flatten; {wires}opt_clean; memory -nordff -nomap; opt -fast; async2sync; dffunmap; opt_clean; stat; ')


def yosys(script, log, seconds):
    """Runs Yosys. False: the time was up."""
    status = run(['yosys', '-p', script], log, seconds)
    text = log.read_text(encoding='utf-8')
    # A misspelt name would be a free variable, and the properties would be about nothing.
    if 'implicitly declared' in text:
        raise Broken(f'a name is not declared, see {log}')
    if status is None:
        return False
    if status != 0:
        raise Broken(f'yosys failed, see {log}')
    if not re.search(r'^ +\$assert +\d', text, flags=re.M):
        raise Broken(f'nothing is asserted, see {log}')
    return True


def solve_by_z3(front, folder, calls, limit):
    """By call (`base`, `step`; each with its cycles): PASSED, FAILED or what went wrong."""
    smt2, results = folder / 'design.smt2', {}
    if not yosys(f'{front}chformal -assert -remove n:*cover_*; write_smt2 -wires {smt2}', folder / 'yosys.log', 300):
        raise Broken('yosys: time-out')
    for name, cycles in calls.items():
        log = folder / f'{name}.log'
        option = ['-i'] if name == 'step' else []
        if run(['yosys-smtbmc', '-s', 'z3', '--unroll', *option, '-t', str(cycles), str(smt2)], log, limit) is None:
            results[name] = 'time-out'
        else:
            found = re.findall(r'Status: (\w+)', log.read_text(encoding='utf-8'))
            results[name] = found[-1] if found else f'no answer, see {log}'
    return results


def solve_by_minisat(front, folder, calls, limit):
    """The same by Yosys itself, whose solver gets single bits; or `cover`, PASSED when every cover is reached."""
    script = front + 'memory_map; opt -fast; '
    covers = []
    for name, cycles in calls.items():
        if name == 'cover':
            covers = sorted(set(re.findall(r'\b(cover_\d+): assert', (folder / 'all.txt').read_text(encoding='utf-8'))))
            script += 'design -save all; '
            script += ''.join(f'design -load all; chformal -assert -remove t:$assert n:*{cover} %d; '
                              f'tee -o {folder / cover}.log sat -prove-asserts -set-assumes -seq {cycles} -timeout {limit:.0f}; '
                              for cover in covers)
        else:
            part = 'baseonly' if name == 'base' else 'inductonly'
            script += (f'chformal -assert -remove n:*cover_*; tee -o {folder / name}.log sat -prove-asserts -set-assumes '
                       f'-tempinduct-{part} -maxsteps {cycles} -timeout {limit:.0f}; ')
    yosys(script, folder / 'yosys.log', limit * (len(calls) + len(covers)) + 60)

    def verdict(name):
        log = folder / f'{name}.log'
        text = log.read_text(encoding='utf-8') if log.exists() else ''
        if re.search(r'SUCCESS!', text):
            return 'PASSED'
        return 'FAILED' if 'FAIL!' in text or '-> proof failed.' in text else 'time-out'

    results = {name: verdict(name) for name in calls if name != 'cover'}
    if 'cover' in calls:
        unreached = [cover for cover in covers if verdict(cover) != 'FAILED']
        results['cover'] = 'PASSED' if covers and not unreached else f'not reached: {", ".join(unreached)}'
    return results


def prove(proof, package, limit, solver):
    """The proof, then its twins."""
    began, preset = time.monotonic(), package.parent.name
    base = pathlib.Path('build/prove') / f'{proof.name}-{preset}'
    shutil.rmtree(base, ignore_errors=True)
    outcome = Outcome(proof, preset, False, [], 0, 0)
    try:
        calls = {'base': 1} if proof.is_combinational else {'base': proof.depth, 'step': proof.k}
        if proof.is_bounded:
            del calls['step']
        results = solver(front_end(proof, package, base, None), base, calls, limit)
        if proof.cover_depth and 'FAILED' not in results.values():
            folder = base / 'cover'
            results |= solve_by_minisat(front_end(proof, package, folder, None), folder, {'cover': proof.cover_depth}, limit)
        failed = {name: result for name, result in results.items() if result != 'PASSED'}
        outcome.remark = ', '.join(f'{name}: {result}' for name, result in failed.items()) + f', see {base}' if failed else ''
        outcome.proven = not failed
        outcome.seconds = time.monotonic() - began
        for number, twin in enumerate(proof.twins):
            calls = {'base': 1} if proof.is_combinational else {'step': proof.k, 'base': proof.twin_depth}
            if proof.twin_traces or proof.is_bounded:
                del calls['step']
            outcome.caught.append(None)
            for name, cycles in calls.items():
                folder = base / f'twin{number}'
                if solver(front_end(proof, package, folder, twin), folder, {name: cycles}, limit)[name] == 'FAILED':
                    outcome.caught[-1] = name
                    break
        outcome.twin_seconds = time.monotonic() - began - outcome.seconds
    except Broken as error:
        outcome.proven = False
        outcome.remark = str(error)
    return outcome


def line(outcome):
    proof = outcome.proof
    method = f'induction k={proof.k}, base {proof.depth}'
    if proof.is_bounded:
        method = f'{proof.depth} cycles from where it starts'
    if proof.is_combinational:
        method = 'every input'
    twins = f'{sum(c is not None for c in outcome.caught)} of {len(proof.twins)} twins caught'
    verdict = 'proven' if outcome.proven else 'NOT PROVEN'
    return (f'{verdict:10} {f"({proof.letter})":6} {proof.name:27} {outcome.preset:9} {method:38} {outcome.seconds:6.1f} s   '
            f'{twins}, {outcome.twin_seconds:.1f} s' + (f'   {outcome.remark}' if outcome.remark else ''))


def enumerate_cases(program, whole):
    """The exhaustive proofs in C++: their own lines, and whether all held."""
    began = time.monotonic()
    result = subprocess.run([program, f'--gtest_filter={ENUMERATIONS}', '--gtest_brief=1'], capture_output=True, text=True,
                            check=False, env={**os.environ, **({'HALFPLANE_EXHAUSTIVE': 'whole'} if whole else {})})
    for text in result.stdout.splitlines():
        if text.startswith('proof: '):
            print('enumerated ' + text[len('proof: '):])
    if result.returncode != 0:
        print(result.stdout + result.stderr)
    print(f'enumerations: {"all hold" if result.returncode == 0 else "FAILED"}, {time.monotonic() - began:.1f} s', flush=True)
    return result.returncode == 0 and 'proof: ' in result.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--quick', action='store_true', help='the proofs that take a few seconds')
    parser.add_argument('--twins', type=int, metavar='N', help='the first N twins of each proof alone')
    parser.add_argument('--only', metavar='NAME', help='proofs whose name contains this')
    parser.add_argument('--preset', choices=DESIGNS, help='with the widths of this preset alone')
    parser.add_argument('--packages', type=pathlib.Path, default='build/release/rtl_ref/packages', metavar='DIR',
                        help='where NAME/raster_pkg.sv of each design lies')
    parser.add_argument('--list', action='store_true', help='what there is to prove')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), metavar='N', help='solvers at a time')
    parser.add_argument('--limit', type=float, default=600, metavar='SECONDS', help='time-out of each call of the solver')
    parser.add_argument('--z3', action='store_true', help='z3 instead of the MiniSat of Yosys: a second opinion, far slower')
    parser.add_argument('--program', metavar='FILE', help='halfplane_unit_tests, whose enumerations run as well')
    options = parser.parse_args()
    if options.jobs < 1 or not options.limit >= 1:
        parser.error('--jobs and --limit begin at 1')
    if options.program and not os.access(options.program, os.X_OK):
        parser.error(f'--program: {options.program} is no program')

    chosen = [(dataclasses.replace(proof, twins=proof.twins[:options.twins]), options.packages / preset / 'raster_pkg.sv') for proof in PROOFS
              for preset in proof.presets + (proof.no_answer if options.only else ())
              if (not options.only or options.only in proof.name) and options.preset in (None, preset)
              and (not options.quick or preset in proof.quick)]
    if options.list:
        for proof in PROOFS:
            if options.only and options.only not in proof.name:
                continue
            print(f'{f"({proof.letter})":6} {proof.name:27} {proof.module:26} {", ".join(proof.presets):15} {proof.claim}' +
                  ''.join(f' [{preset}: no answer in time]' for preset in proof.no_answer))
        return 0
    if not chosen:
        print('prove: nothing of that name and preset', file=sys.stderr)
        return 2
    for _, package in chosen:
        if not package.is_file():
            parser.error(f'--packages: there is no {package}; a build writes it')
    missing = [tool for tool in ('yosys', *(['z3'] if options.z3 else [])) if shutil.which(tool) is None]
    if missing:
        print(f'prove: not installed: {" ".join(missing)} (apt-get install {" ".join(missing)})', file=sys.stderr)
        return 3

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    began, good, solver = time.monotonic(), True, solve_by_z3 if options.z3 else solve_by_minisat
    with concurrent.futures.ThreadPoolExecutor(max(1, options.jobs)) as pool:
        for outcome in pool.map(lambda pair: prove(*pair, options.limit, solver), chosen):
            print(line(outcome), flush=True)
            good = good and outcome.good
    if not options.only:
        stale = stale_twins()
        print(*(f'NOT A TWIN  {text}' for text in stale), sep='\n', end='\n' if stale else '')
        good = good and not stale
    if options.program and not options.only:
        good = enumerate_cases(options.program, not options.quick) and good
    print(f'{len(chosen)} proofs, {time.monotonic() - began:.0f} s: ' + ('all hold, every twin was caught' if good else 'FAILED'))
    return 0 if good else 1


if __name__ == '__main__':
    sys.exit(main())
