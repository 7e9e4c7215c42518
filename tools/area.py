#!/usr/bin/env python3
"""./dev area: what rtl_ref costs. Yosys for ECP5 and iCE40, nextpnr for both, into docs/area.md.

nextpnr-ecp5 is used where it is on the PATH; elsewhere the page says that nothing was placed for ECP5. Runs in the
repository's root, two tools at a time, a quarter of an hour in all; build/area keeps every log.
"""
import argparse
import collections
import concurrent.futures
import datetime
import json
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'rtl_ref/area'))
import gates  # noqa: E402  what it shares with `halfplane bench --area`
from gates import cells, places  # noqa: E402

BUILD = pathlib.Path('build/area')
SYNTH_ECP5 = 'synth_ecp5 -top raster_top -nowidelut'
# What the options of synth_ecp5 do, shown for one configuration without any module kept apart.
FLAT_ECP5 = ['synth_ecp5 -top raster_top -nowidelut', 'synth_ecp5 -top raster_top', 'synth_ecp5 -top raster_top -abc9',
             'synth_ecp5 -top raster_top -abc9 -nowidelut']
FLAT = 'embedded, 2x2'
# Its own script for -abc9: structural choices (&dch), as Yosys has them, lead round through carry boxes, which &if of Yosys
# 0.23's ABC refuses in the flat design of `small` ("not in a topological order"); and &mfs aborts there.
SYNTH_ICE40 = ('scratchpad -set abc9.script "+&scorr; &sweep; &syn3; &if {C} {W} {D} {R} -v"; '
               'synth_ice40 -top pin_wrapper -abc9')
# The modules that stay apart in a run that says which block costs what; what is inside of them is flattened.
KEEP = gates.KEEP
PLACE = 'nextpnr-ice40 --hx8k --package ct256 --freq 65 --seed 2'
# Title, preset, settings.
CONFIGURATIONS = [
    ('tiny, 1x1', 'tiny', []),
    ('small, 1x1', 'small', []),
    ('small, 1x1, counters', 'small', ['counters.unit=1']),
    ('small, 1x1, lines', 'small', ['lines.unit=1']),
    ('embedded, 1x1', 'embedded', ['stamp.size=1']),
    ('embedded, 2x2', 'embedded', []),
    ('embedded, 2x2, no lines', 'embedded', ['lines.unit=0']),
    ('embedded, 2x2, no counters', 'embedded', ['counters.unit=0']),
    ('embedded, 2x2, HiZ 8 bits', 'embedded', ['hiz.bits=8']),
    ('embedded, 2x2, HiZ 8 bits, no counters', 'embedded', ['hiz.bits=8', 'counters.unit=0']),
    ('embedded, 2x2, HiZ 8 bits, VGA', 'embedded', ['hiz.bits=8', 'target.width=640', 'target.height=480']),
    ('embedded, 4x4', 'embedded', ['stamp.size=4']),
    ('full, 2x2', 'full', ['stamp.size=2']),
    ('full, 4x4', 'full', ['stamp.size=4']),
]
PLACED = ['small, 1x1', 'small, 1x1, counters', 'small, 1x1, lines']
PLACE_ECP5 = 'nextpnr-ecp5 --25k --speed 6 --package CABGA381 --freq 65 --seed 1'
# A 25F has 56 block RAMs: too few for bounds of 16 bits at 1920x1080.
PLACED_ECP5 = ['embedded, 2x2, HiZ 8 bits', 'embedded, 2x2, HiZ 8 bits, no counters', 'embedded, 2x2, HiZ 8 bits, VGA']
SYNTH_PLACED = 'synth_ecp5 -top pin_wrapper -abc9 -nowidelut'
# As it is, and without the cells that nextpnr adds to each carry chain: ecp5_carry.v, without_dangling_carries().
CARRIES = {'plain': False, 'carries': True}
# The unit that draws lines, alone, and the same with nobody looking at depth and colour.
LINES = ['tiny, 1x1', 'embedded, 2x2', 'full, 4x4']
LINE_TOPS = {'line_raster': '`line_raster`', 'line_positions': '`line_raster`, positions alone',
             'primitive_join': '`primitive_join`'}
# Fragment operations: what a unit adds to a whole design, `embedded` with the settings behind it; and modules by themselves.
OPERATION_BASE = 'HiZ 12 bits'  # as `embedded` is placed: a 25F has too few block RAMs for bounds of 16
OPERATION_SETTINGS = ['hiz.bits=12']
UNITS = ['alpha.unit=1', 'blend.lanes=4', 'dither.unit=1', 'stencil.bits=8']
OPERATIONS = [
    (OPERATION_BASE, [], OPERATION_BASE),
    ('stencil', ['stencil.bits=8'], OPERATION_BASE),
    ('dithering', ['dither.unit=1'], OPERATION_BASE),
    ('alpha test', ['alpha.unit=1'], OPERATION_BASE),
    ('one blend lane', ['blend.lanes=1'], OPERATION_BASE),
    ('four blend lanes', ['blend.lanes=4'], OPERATION_BASE),
    ('all of these', UNITS, OPERATION_BASE),
    ('a texture unit', ['texture.unit=nearest'], OPERATION_BASE),
    ('and fog', ['texture.unit=nearest', 'fog.unit=1'], 'a texture unit'),
    ('and all of these', ['texture.unit=nearest', 'fog.unit=1', *UNITS], 'a texture unit'),
]
OPERATION_TOPS = {'blend_lane': 'a lane of four channels with alpha', 'alpha_test': 'of four samples', 'stencil_test': 'of four samples',
                  'dithered_rop': 'a sample', 'fog_place': 'a sample', 'fog_unit': 'four samples', 'color_write': 'four blend lanes'}
OPERATION_PARAMETERS = {'fog_unit': 'WORD 76'}  # where a module alone has others: the places of four samples
OPERATION_UNITS = 'and all of these'  # the design that has them
OPERATION_HEAD = '## Fragment operations'
LINE_POSITIONS = '''
module line_positions (
    input logic clk_i, rst_ni, line_valid_i, pixel_ready_i, output logic line_ready_o, pixel_valid_o, is_last_o,
    input raster_pkg::line_setup_t line_i,
    output logic [raster_pkg::PIXEL_X_BITS-1:0] x_o, output logic [raster_pkg::PIXEL_Y_BITS-1:0] y_o);
  raster_pkg::line_pixel_t pixel;
  line_raster u_line_raster (.clk_i, .rst_ni, .line_valid_i, .line_ready_o, .line_i, .pixel_valid_o, .pixel_ready_i,
                             .pixel_o(pixel));
  assign x_o = pixel.x;
  assign y_o = pixel.y;
  assign is_last_o = pixel.is_last;
endmodule
'''


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
    return gates.read_verilog('rtl_ref', package) + (' rtl_ref/area/pin_wrapper.sv' if wrapper else '')


def yosys(title, tag, script):
    """Runs a script that ends in `stat`; cells by module."""
    stat = BUILD / f'{slug(title)}{tag}.stat'
    run(['yosys', '-q', '-p', f'{script}; tee -o {stat} stat'], BUILD / f'{slug(title)}{tag}.log')
    return cells(stat.read_text(encoding='utf-8'))


def flat(title, command):
    """ECP5 cells of the whole design as one module."""
    tag = '-flat' + command.split('raster_top')[1].replace(' ', '')
    return yosys(title, tag, f'{read_verilog(title)}; {command}')['raster_top']


def line_unit(title):
    """ECP5 cells of each of LINE_TOPS by itself."""
    positions = BUILD / 'line_positions.sv'
    return {top: yosys(title, f'-{top}', f'{read_verilog(title)}; read_verilog -sv {positions}; '
                                         + SYNTH_ECP5.replace('raster_top', top))[top] for top in LINE_TOPS}


def operation_file(title):
    return f'operations, {title}'


def operation_units():
    """ECP5 cells of each of OPERATION_TOPS by itself."""
    title = operation_file(OPERATION_UNITS)
    found = {}
    for top in OPERATION_TOPS:
        # Its cells are made again as those of a module of this name, whatever name its parameters have given it.
        made = f'hierarchy -top {top} -chparam {OPERATION_PARAMETERS[top]}; rename -top {top}; ' if top in OPERATION_PARAMETERS else ''
        found[top] = yosys(title, f'-{top}', f'{read_verilog(title)}; {made}' + SYNTH_ECP5.replace('raster_top', top))[top]
    return found


def blocks(title):
    """ECP5 cells of each stage, flattened inside, and what is left in raster_top: unit by unit, kept in build/gates."""
    kept = gates.Gates('build/gates', 'rtl_ref')
    return kept.cells_of('ecp5', BUILD / f'{slug(title)}.sv')


def packed_blocks(title):
    """iCE40 logic cells of each stage, as nextpnr packs them, of a netlist with the stages kept apart."""
    netlist, out = BUILD / f'{slug(title)}-blocks.json', BUILD / f'{slug(title)}-packed.json'
    run(['yosys', '-q', '-p', f'{read_verilog(title, wrapper=True)}; hierarchy -top pin_wrapper; {KEEP}; '
                              f'{SYNTH_ICE40} -json {netlist}'], BUILD / f'{slug(title)}-ice40-blocks.log')
    run([*PLACE.split(), '--pack-only', '--json', netlist, '--write', out], BUILD / f'{slug(title)}-pack.log')
    modules = json.loads(out.read_text(encoding='utf-8'))['modules'].values()
    total = collections.defaultdict(collections.Counter)
    for name, cell in max((module['cells'] for module in modules), key=len).items():
        inside = [part for part in name.split('.')[:-1] if part.startswith('u_')]
        # u_core is raster_top; a kept stage is the first instance in it, unless that is one of its own RAMs.
        block = 'pin_wrapper' if not inside else 'raster_top'
        if len(inside) > 1 and inside[1] not in ('u_context', 'u_step_x', 'u_step_y', 'u_rest'):
            block = inside[1][2:]
        bits = {key: int(value, 2) for key, value in cell['parameters'].items() if key.endswith('_ENABLE')}
        if cell['type'] == 'ICESTORM_LC':
            total[block].update(cells=1, ffs=bits['DFF_ENABLE'], carries=bits['CARRY_ENABLE'])
        elif cell['type'] == 'ICESTORM_RAM':
            total[block].update(rams=1)
    return total


def placed(title):
    """iCE40: logic cells, RAMs and MHz after place and route, behind the pin wrapper."""
    netlist, report = BUILD / f'{slug(title)}.json', BUILD / f'{slug(title)}-report.json'
    run(['yosys', '-q', '-p', f'{read_verilog(title, wrapper=True)}; {SYNTH_ICE40} -json {netlist}'],
        BUILD / f'{slug(title)}-ice40.log')
    run([*PLACE.split(), '--timing-allow-fail', '--json', netlist, '--report', report], BUILD / f'{slug(title)}-nextpnr.log')
    result = json.loads(report.read_text(encoding='utf-8'))
    return {'cells': result['utilization']['ICESTORM_LC']['used'], 'rams': result['utilization']['ICESTORM_RAM']['used'],
            'mhz': min(clock['achieved'] for clock in result['fmax'].values())}


def without_dangling_carries(netlist):
    """nextpnr leads the carry out of each chain's end into the fabric, by a cell of two places, also where nobody reads it."""
    design = json.loads(netlist.read_text(encoding='utf-8'))
    for module in design['modules'].values():
        read = {bit for port in module['ports'].values() for bit in port['bits']}
        for cell in module['cells'].values():
            read.update(bit for port, bits in cell['connections'].items() if cell['port_directions'][port] != 'output'
                        for bit in bits)
        for cell in module['cells'].values():
            if cell['type'] == 'CCU2C' and not read.intersection(cell['connections'].get('COUT', [])):
                cell['connections']['COUT'] = ['x']
    netlist.write_text(json.dumps(design), encoding='utf-8')


def placed_ecp5(title, tag, carries):
    """ECP5: TRELLIS_COMB, flip-flops, block RAMs, multipliers and MHz after place and route, behind the pin wrapper."""
    synth, tag = SYNTH_PLACED, f'-{tag}'
    if carries:
        synth = (f'{synth} -run :map_gates; techmap -map rtl_ref/area/ecp5_carry.v; {synth} -run map_gates:')
    netlist, report = BUILD / f'{slug(title)}{tag}.json', BUILD / f'{slug(title)}{tag}-report.json'
    run(['yosys', '-q', '-p', f'{read_verilog(title, wrapper=True)}; {synth} -json {netlist}'],
        BUILD / f'{slug(title)}{tag}-ecp5.log')
    if carries:
        without_dangling_carries(netlist)
    run([*PLACE_ECP5.split(), '--timing-allow-fail', '--json', netlist, '--report', report],
        BUILD / f'{slug(title)}{tag}-nextpnr-ecp5.log')
    result = json.loads(report.read_text(encoding='utf-8'))
    used = {cell: count['used'] for cell, count in result['utilization'].items()}
    return [used['TRELLIS_COMB'], used['TRELLIS_FF'], used['DP16KD'], used['MULT18X18D'],
            f"{min(clock['achieved'] for clock in result['fmax'].values()):.1f}"]


def version(command):
    out = subprocess.run(command, capture_output=True, text=True, check=True)
    first = (out.stdout + out.stderr).strip().splitlines()[0]
    return re.sub(r'.*"?(nextpnr-ice40|nextpnr-ecp5).*Version ([^)]*)\).*', r'\1 \2', first.split(' (git')[0])


def ecp5_cells(count):
    return [places(count), count['LUT4'], count['CCU2C'], count['TRELLIS_DPR16X4'], count['TRELLIS_FF'],
            count['MULT18X18D'], count['DP16KD']]


def table(head, rows):
    """Markdown; numbers with thousands apart."""
    cell = lambda value: f'{value:,}' if isinstance(value, int) else value
    return ['', '| ' + ' | '.join(head) + ' |', '|' + ' --- |' * len(head),
            *('| ' + ' | '.join(map(cell, row)) + ' |' for row in rows), '']


def line_part(units):
    lines = [f'Lines: `{SYNTH_ECP5}` with each module of its own as the top. What is set up once a line is done by the host '
             'and comes in a packet; the flip-flops hold its constants as well.']
    lines += table(['module', *units], [[label, *(f"{places(unit[top]):,} places, {unit[top]['TRELLIS_FF']:,} FF"
                                                  for unit in units.values())] for top, label in LINE_TOPS.items()])
    return lines


def operation_part(designs, tops):
    """`designs`: cells of each of OPERATIONS that was asked for, with those that they are held against."""
    total = {title: sum(part.values(), collections.Counter()) for title, part in designs.items()}
    head = ['places', 'LUT4', 'CCU2C', 'DPR16X4', 'FF', 'MULT18X18D', 'DP16KD']
    lines = [OPERATION_HEAD, '', 'What a unit adds: `embedded --set ' + ' '.join(OPERATION_SETTINGS) + '` with its settings, planes '
             f'included, less the same without (`{SYNTH_ECP5}`, every stage kept apart and counted as above).']
    rows = []
    for title, settings, base in OPERATIONS:
        if title in total:
            more = [a - b for a, b in zip(ecp5_cells(total[title]), ecp5_cells(total[base]))]
            rows.append([title, '`' + '` `'.join(settings) + '`' if settings else '', ecp5_cells(total[title])[0],
                         *(f'{n:+,}' if title != base else '' for n in more)])
    lines += table(['unit', 'settings', 'the whole, places', *head], rows)
    lines += ['Where that is, in places.']
    names = sorted({name for part in designs.values() for name in part})
    changed = [(title, base) for title, _, base in OPERATIONS if title in total and title != base]
    rows = [[f'`{name}`', *(f'{places(designs[t][name]) - places(designs[b][name]):+,}' for t, b in changed)] for name in names]
    lines += table(['block', *(title for title, _ in changed)], [row for row in rows if set(row[1:]) != {'+0'}])
    if tops:
        lines += ['Modules by themselves, in a design with all of them.']
        lines += table(['module', 'what', *head],
                       [[f'`{top}`', OPERATION_TOPS[top], *ecp5_cells(count)] for top, count in tops.items()])
    return lines


def in_page(page, part, command):
    """The page with the lines of `part` in place of its section, or before that of the iCE40."""
    sections = re.split(r'^(?=## )', page, flags=re.M)
    at = [i for i, section in enumerate(sections) if section.startswith(OPERATION_HEAD)]
    if not at:
        at = [i for i, section in enumerate(sections) if section.startswith('## iCE40')] or [len(sections)]
        sections.insert(at[0], '')
    dated = f'By `{command}` on {datetime.date.today()} with {version(["yosys", "-V"])}.'
    sections[at[0]] = '\n'.join([part[0], '', dated, '', *part[2:]]).replace('\n\n\n', '\n\n').rstrip() + '\n\n'
    return ''.join(sections).rstrip() + '\n'


def ecp5_part(parts, flats, fitted):
    head = ['places', 'LUT4', 'CCU2C', 'DPR16X4', 'FF', 'MULT18X18D', 'DP16KD']
    total = {title: sum(part.values(), collections.Counter()) for title, part in parts.items()}
    names = sorted({name for part in parts.values() for name in part}, key=lambda name: -sum(
        places(part[name]) for part in parts.values()))
    placed_lines = ['nextpnr-ecp5 was not there: nothing is placed and routed for ECP5.', '']
    if fitted:
        placed_lines = [f'Placed and routed: `{SYNTH_PLACED}`, `{PLACE_ECP5}`, the design flat, behind '
                        '`rtl_ref/area/pin_wrapper.sv`, whose cells are in these figures. A place is a TRELLIS_COMB. nextpnr '
                        'puts a cell of two places in front of each carry chain whose carry-in is a constant, and one '
                        'behind each whose carry-out nobody reads; "carries" is without them: adders by '
                        '`rtl_ref/area/ecp5_carry.v`, carry-outs that dangle taken off.']
        placed_lines += table(['configuration', 'carry chains', 'places of 24,288', 'FF', 'DP16KD of 56', 'MULT18X18D of 28',
                               'MHz'], [[title, tag, *figures] for (title, tag), figures in fitted.items()])
    lines = ['## ECP5', '', *placed_lines]
    lines += [f'`{SYNTH_ECP5}`, every stage flattened inside and kept apart from the others '
             '(`keep_hierarchy`), so that each block has its own cells and they add up. "Places" are what the cells '
             'take up in the part, of 24,288 in a 25F: a LUT4 one, a CCU2C (two bits of a carry chain) two, a DPR16X4 (16 '
             'words of 4 bits) four and two more for its write port.']
    lines += table(['configuration', *head], [[title, *ecp5_cells(count)] for title, count in total.items()])
    lines += ['Which block costs what, in places. `raster_top` is the counters, the context RAM and what joins the '
              'stages; `depth_test` contains `rop`; `framebuffer` is that of tiles; of blocks `cache_tags` has the '
              'tags and flags, `depth_cache`, `color_write`, `memory_answers` and `write_back` what is behind them.']
    lines += table(['block', *parts], [[f'`{name}`', *(places(part[name]) for part in parts.values())] for name in names])
    lines += ['Flip-flops and multipliers (`FF + MULT18X18D`).']
    lines += table(['block', *parts], [[f'`{name}`', *(f"{part[name]['TRELLIS_FF']:,} + {part[name]['MULT18X18D']}"
                                                      for part in parts.values())] for name in names])
    if flats:
        lines += [f'What the options do: {FLAT} as one flat module. The default options make wide multiplexers '
                  '(PFUMX, L6MUX21) out of more LUT4.']
        lines += table(['command', *head], [[f'`{command}`', *ecp5_cells(count)] for command, count in flats.items()])
    return lines


def ice40_part(fitted, packed):
    lines = ['## iCE40 HX8K', '', f'`{SYNTH_ICE40}`, then `{PLACE}`: placed and routed with the design flat, behind '
             '`rtl_ref/area/pin_wrapper.sv` (a shift register before every input, a parity of all outputs behind them). '
             'The wrapper\'s cells are in these figures. The part has no multipliers; none are needed by `small`.']
    lines += table(['configuration', 'logic cells of 7,680', 'RAM of 32', 'MHz'],
                   [[title, f['cells'], f['rams'], f"{f['mhz']:.1f}"] for title, f in fitted.items()])
    for title, part in packed.items():
        lines += [f'Which block costs what: {title}, the stages kept apart, packed by nextpnr (`--pack-only`). A logic '
                  'cell is a LUT4, a bit of carry chain and a flip-flop; it counts once, whichever of them it holds.']
        rows = sorted(part.items(), key=lambda entry: -entry[1]['cells'])
        total = sum(part.values(), collections.Counter())
        lines += table(['block', 'logic cells', 'with a flip-flop', 'with a carry', 'RAM'],
                       [[name, c['cells'], c['ffs'], c['carries'], c['rams']]
                        for name, c in [*((f'`{n}`', c) for n, c in rows), ('all', total)]])
    return lines


def page(parts, flats, fitted_ecp5, fitted, packed, units, operations, tops):
    tools = [version(['yosys', '-V']), version(['nextpnr-ice40', '--version'])]
    if shutil.which('nextpnr-ecp5'):
        tools.append(version(['nextpnr-ecp5', '--version']))
    lines = ['# Area and speed', '', f'Written by `./dev area` on {datetime.date.today()} with {", ".join(tools)}. '
             'Configurations: preset, stamp.', '']
    lines += ecp5_part(parts, flats, fitted_ecp5)
    if units:
        lines += line_part(units)
    if operations:
        lines += operation_part(operations, tops)
    if fitted:
        lines += ice40_part(fitted, packed)
    return '\n'.join(lines).replace('\n\n\n', '\n\n').rstrip() + '\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--only', metavar='PRESET', help='configurations of one preset, printed and not written; or `operations`, '
                        'fragment operations, whose section of the page is written anew')
    parser.add_argument('--units', metavar='LIST', help='with `--only operations`: the section has these units only, of '
                        + ', '.join(title for title, _, _ in OPERATIONS))
    parser.add_argument('--jobs', type=int, default=2, metavar='N', help='tools at a time (2)')
    parser.add_argument('--program', default='build/halfplane', help='the halfplane program')
    options = parser.parse_args()
    only_operations = options.only == 'operations'
    chosen = [c for c in CONFIGURATIONS if options.only in (None, c[1])]
    if not chosen and not only_operations:
        sys.exit(f'area: no preset {options.only!r}')
    BUILD.mkdir(parents=True, exist_ok=True)

    def package(title, preset, settings):
        sets = [word for setting in settings for word in ('--set', setting)]
        run([options.program, 'config', '--config', preset, *sets, '--sv'], BUILD / f'{slug(title)}.sv')

    for title, preset, settings in chosen:
        package(title, preset, settings)
    titles = [title for title, _, _ in chosen]
    asked = [title.strip() for title in (options.units or '').split(',') if title.strip()]
    extra = []
    if options.only in (None, 'operations', 'embedded'):
        extra = [o[0] for o in OPERATIONS if not asked or o[0] in asked or o[0] in {b for t, _, b in OPERATIONS if t in asked}]
    for title, settings, _ in OPERATIONS:
        if title in extra or (extra and title == OPERATION_UNITS):
            package(operation_file(title), 'embedded', OPERATION_SETTINGS + settings)
    (BUILD / 'line_positions.sv').write_text(LINE_POSITIONS, encoding='utf-8')
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = {
            'fitted': {t: pool.submit(placed, t) for t in PLACED if t in titles},
            'fitted_ecp5': {(t, tag): pool.submit(placed_ecp5, t, tag, carries) for t in PLACED_ECP5 if t in titles
                            for tag, carries in CARRIES.items() if shutil.which('nextpnr-ecp5')},
            'packed': {t: pool.submit(packed_blocks, t) for t in PLACED[:1] if t in titles},
            'units': {t: pool.submit(line_unit, t) for t in LINES if t in titles},
            'parts': {t: pool.submit(blocks, t) for t in titles},
            'operations': {t: pool.submit(blocks, operation_file(t)) for t in extra},
            'flats': {c: pool.submit(flat, FLAT, c) for c in FLAT_ECP5 if FLAT in titles},
        }
        tops = pool.submit(operation_units).result() if extra else {}
        results = {name: {key: job.result() for key, job in group.items()} for name, group in jobs.items()}
    target = pathlib.Path('docs/area.md')
    if only_operations:
        part = operation_part(results['operations'], tops)
        command = './dev area --only operations' + (f' --units "{options.units}"' if asked else '')
        print('\n'.join(part))
        target.write_text(in_page(target.read_text(encoding='utf-8'), part, command), encoding='utf-8')
        return
    text = page(**results, tops=tops)
    print(text, end='')
    if options.only is None:
        target.write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
