#!/usr/bin/env python3
"""./dev area: what rtl_ref costs. Yosys for ECP5 and iCE40, nextpnr for iCE40, into docs/area.md.

Runs in the repository's root, two tools at a time, a quarter of an hour in all; build/area keeps every log.
"""
import argparse
import collections
import concurrent.futures
import datetime
import json
import pathlib
import re
import subprocess
import sys

BUILD = pathlib.Path('build/area')
ECP5 = {'default': '', '-nowidelut': '-nowidelut'}
SYNTH_ICE40 = 'synth_ice40 -top pin_wrapper -abc9'
PLACE = 'nextpnr-ice40 --hx8k --package ct256 --freq 60 --seed 1'
# Title, preset, settings.
CONFIGURATIONS = [
    ('tiny, 1x1', 'tiny', []),
    ('small, 1x1', 'small', []),
    ('embedded, 1x1', 'embedded', ['stamp.size=1']),
    ('embedded, 2x2', 'embedded', []),
    ('embedded, 4x4', 'embedded', ['stamp.size=4']),
    ('full, 2x2', 'full', ['stamp.size=2']),
    ('full, 4x4', 'full', ['stamp.size=4']),
]
BLOCKS = ['embedded, 2x2', 'small, 1x1']  # broken down by module
PLACED = ['small, 1x1']


def run(command, log):
    """Runs a command, output to `log`; stops everything when it fails."""
    with open(log, 'w', encoding='utf-8') as out:
        if subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, check=False).returncode != 0:
            sys.exit(f'area: {command[0]} failed, see {log}')
    return pathlib.Path(log).read_text(encoding='utf-8')


def slug(title):
    return re.sub(r'\W+', '-', title)


def read_verilog(title, wrapper=False):
    package = BUILD / f'{slug(title)}.sv'
    sources = [package, *sorted(pathlib.Path('rtl_ref/lib').glob('*.sv')),
               *sorted(pathlib.Path('rtl_ref/stages').glob('*.sv')), 'rtl_ref/raster_top.sv']
    if wrapper:
        sources.append('rtl_ref/area/pin_wrapper.sv')
    return 'read_verilog -sv ' + ' '.join(map(str, sources))


def cells(text):
    """Cells by type, from the last table that `stat` printed, and by module from all of them."""
    modules = {}
    for part in re.split(r'^=== ', text, flags=re.M)[1:]:
        name = part.split(' ===', 1)[0]
        modules[name] = collections.Counter(
            {cell: int(count) for cell, count in re.findall(r'^ {5,}(\S+) +(\d+)$', part, flags=re.M)})
    return modules


def yosys(title, tag, script):
    """Runs a script that ends in `stat`; cells by module."""
    stat = BUILD / f'{slug(title)}{tag}.stat'
    run(['yosys', '-q', '-p', f'{script}; tee -o {stat} stat'], BUILD / f'{slug(title)}{tag}.log')
    return cells(stat.read_text(encoding='utf-8'))


def ecp5(title, option):
    found = yosys(title, '-ecp5' + option, f'{read_verilog(title)}; synth_ecp5 -top raster_top {option}')
    return found['raster_top']


def blocks(title):
    """ECP5 cells of each module without what is below it, all instances together."""
    found = yosys(title, '-blocks', f'{read_verilog(title)}; synth_ecp5 -noflatten -nowidelut -top raster_top')
    found.pop('design hierarchy', None)

    instances = collections.Counter()

    def visit(name):
        instances[name] += 1
        for cell, count in found[name].items():
            for _ in range(count if cell in found else 0):
                visit(cell)

    visit('raster_top')
    total = collections.defaultdict(collections.Counter)
    for name, count in instances.items():
        label = re.sub(r'^\$paramod(\$[0-9a-f]+)?\\?', '', name).split('\\')[0]
        for cell, each in found[name].items():
            if cell not in found:
                total[label][cell] += each * count
    return total


def placed(title):
    """iCE40: logic cells, RAMs and MHz after place and route, behind the pin wrapper."""
    netlist, report = BUILD / f'{slug(title)}.json', BUILD / f'{slug(title)}-report.json'
    run(['yosys', '-q', '-p', f'{read_verilog(title, wrapper=True)}; {SYNTH_ICE40} -json {netlist}'],
        BUILD / f'{slug(title)}-ice40.log')
    run([*PLACE.split(), '--timing-allow-fail', '--json', netlist, '--report', report], BUILD / f'{slug(title)}-nextpnr.log')
    result = json.loads(report.read_text(encoding='utf-8'))
    return {'cells': result['utilization']['ICESTORM_LC'], 'rams': result['utilization']['ICESTORM_RAM'],
            'mhz': min(clock['achieved'] for clock in result['fmax'].values())}


def version(command):
    out = subprocess.run(command, capture_output=True, text=True, check=True)
    return (out.stdout + out.stderr).strip().splitlines()[0].split(' (git')[0]


def ecp5_row(title, count):
    default, narrow = count['default'], count['-nowidelut']
    return (f"| {title} | {narrow['LUT4']:,} | {default['LUT4']:,} | {narrow['CCU2C']:,} | {narrow['TRELLIS_FF']:,} "
            f"| {narrow['MULT18X18D']} | {narrow['DP16KD']} | {narrow['TRELLIS_DPR16X4']} |")


def block_row(name, count):
    return (f"| `{name}` | {count['LUT4']:,} | {count['CCU2C']:,} | {count['TRELLIS_FF']:,} | {count['MULT18X18D']} "
            f"| {count['DP16KD']} | {count['TRELLIS_DPR16X4']} |")


def page(luts, parts, fitted):
    lines = [
        '# Area and speed',
        '',
        f'Written by `./dev area` on {datetime.date.today()}: {version(["yosys", "-V"])}, '
        f'{version(["nextpnr-ice40", "--version"]).replace("Next Generation Place and Route ", "")}.',
        '',
        '## ECP5: `synth_ecp5 -top raster_top`',
        '',
        'LUT4 with `-nowidelut`, and with the default options, which build wide multiplexers out of more LUTs and count '
        'those as LUT4 too. A CCU2C is two bits of carry chain and takes the place of two more LUT4. A 16-bit word of '
        'the HiZ bound of every tile, and two flags, are in the DP16KD; so most of those are the size of the target.',
        '',
        '| preset, stamp | LUT4 | LUT4, default | CCU2C | FF | MULT18X18D | DP16KD | DPR16X4 |',
        '| --- | --- | --- | --- | --- | --- | --- | --- |',
    ]
    lines += [ecp5_row(title, luts[title]) for title, _, _ in CONFIGURATIONS if title in luts]
    for title, part in parts.items():
        lines += [
            '', f'### Which block costs what: {title}', '',
            'Each module with `-noflatten -nowidelut`, all its instances together, without the modules inside it; the '
            'sum is more than the flattened design, in which what is constant or unused across modules goes away.', '',
            '| module | LUT4 | CCU2C | FF | MULT18X18D | DP16KD | DPR16X4 |',
            '| --- | --- | --- | --- | --- | --- | --- |',
        ]
        lines += [block_row(*entry) for entry in sorted(part.items(), key=lambda e: -e[1]['LUT4'] - 2 * e[1]['CCU2C'])]
    if fitted:
        lines += [
            '', '## iCE40 HX8K, placed and routed', '',
            f'`{SYNTH_ICE40}`, `{PLACE}`, behind `rtl_ref/area/pin_wrapper.sv`: a shift register in front of all inputs, '
            'a parity of all outputs behind; its cells are counted too. No multipliers are used: the part has none.', '',
            '| preset, stamp | logic cells of 7,680 | RAM blocks of 32 | MHz |', '| --- | --- | --- | --- |',
        ]
        lines += [f"| {title} | {f['cells']['used']:,} | {f['rams']['used']} | {f['mhz']:.1f} |"
                  for title, f in fitted.items()]
    return '\n'.join(lines) + '\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--only', metavar='PRESET', help='configurations of one preset, printed and not written')
    parser.add_argument('--program', default='build/halfplane', help='the halfplane program')
    options = parser.parse_args()
    chosen = [c for c in CONFIGURATIONS if options.only in (None, c[1])]
    if not chosen:
        sys.exit(f'area: no preset {options.only!r}')
    BUILD.mkdir(parents=True, exist_ok=True)
    for title, preset, settings in chosen:
        sets = [word for setting in settings for word in ('--set', setting)]
        run([options.program, 'config', '--config', preset, *sets, '--sv'], BUILD / f'{slug(title)}.sv')
    titles = [title for title, _, _ in chosen]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        fits = {t: pool.submit(placed, t) for t in PLACED if t in titles}
        parts = {t: pool.submit(blocks, t) for t in BLOCKS if t in titles}
        luts = {t: {name: pool.submit(ecp5, t, option) for name, option in ECP5.items()} for t in titles}
        text = page({t: {name: job.result() for name, job in jobs.items()} for t, jobs in luts.items()},
                    {t: job.result() for t, job in parts.items()}, {t: job.result() for t, job in fits.items()})
    print(text, end='')
    if options.only is None:
        pathlib.Path('docs/area.md').write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
