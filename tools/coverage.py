#!/usr/bin/env python3
"""What the tests reach: lines and branches of model/stages and of driver/ (gcov), lines and bits of rtl_ref (Verilator).

  coverage.py model --objects FOLDER --exceptions FILE [-o TABLE] -- COMMAND...  runs COMMAND, built with --coverage
  coverage.py driver --objects FOLDER [-o TABLE] PROGRAM...                      runs each, added up over configurations
  coverage.py rtl --exceptions FILE [--least PERCENT] [-o TABLE] DATA...         reads what Verilator's designs have written

Prints a table and what was missed. Exit status 1: a line or a branch of model or driver is not reached (rtl: less than PERCENT
of a file's blocks or bits), or an exception excepts nothing.

An exception is a line `FILE | KIND | PATTERN | REASON`: points of KIND (line, branch, toggle) in FILE, a pattern of names,
are left out of the count where they are missed and PATTERN, a regular expression, is found in the text of the source line
(toggle: matches the whole name of the bit).
"""
import argparse
import fnmatch
import itertools
import json
import pathlib
import re
import shutil
import subprocess
import sys
from collections import Counter, defaultdict

ROOT = pathlib.Path(__file__).resolve().parent.parent
HOST_STAGES = ('primitive_assembly', 'clip', 'viewport', 'line_setup', 'point_raster', 'smooth_raster')
OPERATIONS = ('color_ops', 'fragment_ops', 'stencil_ops')  # arithmetic that stages and engines share


def read(path):
    try:
        return pathlib.Path(path).read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        sys.exit(f'{path}: cannot be read: {error}')


class Exceptions:
    def __init__(self, path):
        self.path, self.rules, self.used = path, [], Counter()
        for number, text in enumerate(read(path).splitlines() if path else [], 1):
            if not text.strip() or text.startswith('#'):
                continue
            fields = [field.strip() for field in text.split(' | ')]
            if len(fields) != 4 or fields[1] not in ('line', 'branch', 'toggle') or not fields[3]:
                sys.exit(f'{path}:{number}: an exception is FILE | KIND | PATTERN | REASON')
            self.rules.append((number, fields[0], fields[1], re.compile(fields[2])))

    def allows(self, file, kind, text):
        for number, files, of_kind, pattern in self.rules:
            found = pattern.fullmatch(text) if kind == 'toggle' else pattern.search(text)
            if of_kind == kind and found and fnmatch.fnmatch(file, files):
                self.used[number] += 1
                return True
        return False

    def useless(self):
        return [f'{self.path}:{number}: excepts nothing' for number, *_ in self.rules if not self.used[number]]


class Table:
    """Points reached, missed and excepted, by file and kind."""

    def __init__(self, kinds, exceptions):
        self.kinds, self.exceptions = kinds, exceptions
        self.count, self.missed = defaultdict(Counter), []

    def add(self, file, kind, is_reached, line, text, what=''):
        if not is_reached and self.exceptions.allows(file, kind, what if kind == 'toggle' else text):
            self.count[file][kind, 'excepted'] += 1
            return
        self.count[file][kind, 'all'] += 1
        self.count[file][kind, 'reached'] += is_reached
        if not is_reached:
            self.missed.append((file, line, kind, what or text.strip()))

    def percent(self, file, kind):
        counts = self.count[file]
        return 100.0 if not counts[kind, 'all'] else 100.0 * counts[kind, 'reached'] / counts[kind, 'all']

    def text(self):
        for file in list(self.count):
            if file != 'all':
                self.count['all'].update(self.count[file])
        width = max(map(len, self.count))
        head = f'{"":{width}}' + ''.join(f'  {kind + " reached":>16}      %  excepted' for kind in self.kinds)
        rows = [head]
        for file in sorted(self.count, key=lambda name: (name == 'all', name)):
            row = f'{file:{width}}'
            for kind in self.kinds:
                counts = self.count[file]
                of = f'{counts[kind, "reached"]} of {counts[kind, "all"]}'
                row += f'  {of:>16}  {int(10 * self.percent(file, kind)) / 10:5.1f}  {counts[kind, "excepted"] or "":>8}'
            rows.append(row)
        return '\n'.join(row.rstrip() for row in rows) + '\n'


def is_stage(path):
    """Whether a file is measured: of the host's those are the stages, not what sends their packets."""
    if path.parent == ROOT / 'model/host':
        return path.stem in HOST_STAGES
    return path.parent in (ROOT / 'model/stages', ROOT / 'model/study') and path.stem not in OPERATIONS


def gcov(data, is_measured):
    """What gcov says of one .gcda file: the measured files in it."""
    report = subprocess.run(['gcov', '--json-format', '--stdout', '--branch-probabilities', data.name], cwd=data.parent,
                            check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return [file for text in report.splitlines() if text for file in json.loads(text)['files']
            if is_measured((ROOT / file['file']).resolve())]


def branch_counts(branches):
    """Without the two ways out of a call, of which one is an exception: gcov names that one, right after the other."""
    return [branch['count'] for branch, after in zip(branches, branches[1:] + [{'throw': False}])
            if not branch['throw'] and not after['throw']]


def merged(copies):
    """Counts of a line's branches over all `copies`, (where its function starts, counts). Of a lambda in a template gcov
    gives the branches of all instances in one row: then they are as many as the shortest row has."""
    by_start = defaultdict(list)
    for start, counts in copies:
        by_start[start].append(counts)
    lengths = {len(counts) for _, counts in copies}
    if len(lengths) > 1:
        by_start = {None: [counts[i:i + min(lengths)] for _, counts in copies for i in range(0, len(counts), min(lengths))]}
    return [sum(row) for rows in by_start.values() for row in itertools.zip_longest(*rows, fillvalue=0)]


def model_points(objects, command, table):
    """Of a test program's run; the counts of an earlier one go first. A function template's instances, and the copies of
    an inline function in several objects, are one: a branch is reached when one of them has reached it. Calls that may
    throw or return, and functions that the compiler has made up, do not count."""
    if shutil.which(command[0]) is None:
        sys.exit(f'{command[0]}: no such program')
    run(objects, [command])
    lines, branches, sources = Counter(), defaultdict(list), {}
    for data in sorted(pathlib.Path(objects).rglob('*.gcda')):
        for file in gcov(data, is_stage):
            path = (ROOT / file['file']).resolve()
            name = str(path.relative_to(ROOT))
            source = sources.setdefault(name, path.read_text().splitlines())
            starts = {function['name']: (function['start_line'], function['start_column'])
                      for function in file['functions']}
            for line in file['lines']:
                start, number = starts.get(line.get('function_name'), (line['line_number'], 0)), line['line_number']
                if re.match(r'\s*(class|struct) |.*= default;', source[start[0] - 1]):
                    continue
                if re.fullmatch(r'[\s{}();]*', source[number - 1]):
                    continue  # destructors, some of them on the way of an exception
                lines[name, number] += line['count']
                if kept := branch_counts(line['branches']):
                    branches[name, number].append((start, kept))
    for (name, number), count in sorted(lines.items()):
        table.add(name, 'line', count > 0, number, sources[name][number - 1])
    for (name, number), copies in sorted(branches.items()):
        if lines[name, number] > 0:  # else the line is what is missed
            for count in merged(copies):
                table.add(name, 'branch', count > 0, number, sources[name][number - 1])


def run(objects, commands):
    """The counts of earlier runs go first."""
    for old in pathlib.Path(objects).rglob('*.gcda'):
        old.unlink()
    for command in commands:
        if subprocess.run(command, check=False).returncode:
            sys.exit(f'{command[0]} failed: nothing was measured')


def driver_points(objects, programs, table):
    """A line is cut into more branches or fewer by a configuration, whose settings decide conditions: each of its forms is
    counted, a branch of it is reached when it is in one of the configurations that have this form."""
    run(objects, [[program, '--gtest_brief=1'] for program in programs])
    lines, forms = Counter(), {}
    for data in sorted(pathlib.Path(objects).rglob('*.gcda')):
        for file in gcov(data, lambda path: path.parent == ROOT / 'driver'):
            name = str((ROOT / file['file']).resolve().relative_to(ROOT))
            for line in file['lines']:
                lines[name, line['line_number']] += line['count']
                counts = [branch['count'] for branch in line['branches']]
                before = forms.setdefault((name, line['line_number'], len(counts)), [0] * len(counts))
                before[:] = map(sum, zip(before, counts))
    sources = {name: (ROOT / name).read_text().splitlines() for name, _ in lines}
    for (name, number), count in sorted(lines.items()):
        table.add(name, 'line', count > 0, number, sources[name][number - 1])
    for (name, number, _), counts in sorted(forms.items()):
        for count in counts:
            table.add(name, 'branch', count > 0, number, sources[name][number - 1])


def rtl_points(data, table):
    """Of all instances of all configurations together: a point is reached when one of them has reached it."""
    hits = Counter()
    for path in data:
        for record in re.finditer(r"^C '(.*)' (\d+)$", read(path), re.MULTILINE):
            fields = dict(field.split('\2', 1) for field in record[1].split('\1') if field)
            kind = 'toggle' if fields['page'].startswith('v_toggle') else 'line'
            hits[fields['f'], int(fields['l']), int(fields['n']), kind, fields['o']] += int(record[2])
    sources = {}
    for (path, line, _, kind, what), count in sorted(hits.items()):
        file = pathlib.Path(path).resolve()
        if file.is_relative_to(ROOT):
            if file not in sources:
                sources[file] = file.read_text().splitlines()
            table.add(str(file.relative_to(ROOT)), kind, count > 0, line, sources[file][line - 1], what if kind == 'toggle' else '')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('of', choices=['model', 'driver', 'rtl'])
    parser.add_argument('--objects', help='folder of the objects, .gcno and .gcda; old .gcda go')
    parser.add_argument('--exceptions')
    parser.add_argument('--least', type=float, default=95.0, help='percent that each file must reach (rtl)')
    parser.add_argument('-o', '--output', help='where the table goes as well')
    parser.add_argument('inputs', nargs='+', metavar='COMMAND|PROGRAM|DATA')
    arguments = parser.parse_args()
    if arguments.of != 'rtl' and not arguments.objects:
        parser.error(f'{arguments.of}: --objects is missing')
    if arguments.of != 'driver' and not arguments.exceptions:
        parser.error(f'{arguments.of}: --exceptions is missing')
    exceptions = Exceptions(arguments.exceptions)
    kinds = ('line', 'toggle') if arguments.of == 'rtl' else ('line', 'branch')
    table = Table(kinds, exceptions)
    if arguments.of == 'model':
        model_points(arguments.objects, arguments.inputs, table)
    elif arguments.of == 'driver':
        driver_points(arguments.objects, arguments.inputs, table)
    else:
        rtl_points(arguments.inputs, table)
    if not table.count:
        sys.exit('nothing was measured')
    text = table.text()
    least = arguments.least if arguments.of == 'rtl' else 100.0
    missed = [f'{file}:{line}: {kind} not reached: {what}' for file, line, kind, what in table.missed]
    low = [f'{file}: less than {least:g} % of {kind}' for file in table.count for kind in kinds
           if table.percent(file, kind) < least]
    if arguments.output:
        pathlib.Path(arguments.output).write_text(text)
    print(text + '\n'.join(missed + exceptions.useless() + low))
    return 1 if low or exceptions.useless() else 0


if __name__ == '__main__':
    sys.exit(main())
