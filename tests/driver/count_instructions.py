#!/usr/bin/env python3
"""Instructions that the driver takes for a vertex and for a triangle of a strip, counted by qemu (docs/driver.md).

usage: tests/driver/count_instructions.py HALFPLANE [--only TEXT] [--profile] [--page FILE]

HALFPLANE: the program `halfplane`, which writes a configuration's C header. --only: rows whose name has TEXT.
--profile: by function, of the strips alone. --page FILE: exit 1 where a count is more than 1 % off what FILE, a page
with this table, says. Counts depend on the compiler: the page has those of Debian 12's gcc.

tests/driver/target/scene.c draws four strips of 64 triangles; the same program without its draws is subtracted, and
that which culls every triangle tells the vertex from the triangle. Cortex-M4 code runs on qemu's Cortex-A7.
"""
import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = {
    'RV32IM': (['riscv64-unknown-elf-gcc', '-march=rv32im', '-mabi=ilp32', '-isystem',
                '/usr/lib/picolibc/riscv64-unknown-elf/include'], ['qemu-riscv32']),
    'Cortex-M4': (['arm-none-eabi-gcc', '-mcpu=cortex-m4', '-mthumb', '-isystem',
                   '/usr/lib/picolibc/arm-none-eabi/include'], ['qemu-arm', '-cpu', 'cortex-a7']),
}
TRIANGLES, VERTICES = 256, 264
NOTHING, DRAWS, CULLS = 0, 1, 2  # WORK of scene.c
SCENES = {'embedded': ('embedded', []), 'textured': ('textured', ['-DTEXTURED']),
          'textured, levels': ('textured', ['-DTEXTURED', '-DLEVELS=7']),
          'stencilled, light': ('stencilled', ['-DLIT'])}
PRODUCT, DIVISION = re.compile(r'mul|ml[as]|smm'), re.compile(r'u?s?div|rem')


def build(folder, target, scene, level, work):
    compiler, _ = TARGETS[target]
    config, defines = SCENES[scene]
    program = folder / f'{target}_{config}_{level}_{work}'
    options = ['-std=c99', level, '-ffreestanding', '-fno-builtin', '-nostartfiles', '-nostdlib', '-ffunction-sections',
               '-Wl,--gc-sections', '-Wl,--no-relax', '-Wl,-e,_start,--no-warn-rwx-segments', '-I', ROOT / 'driver', f'-DWORK={work}',
               f'-DHALFPLANE_CONFIG_FILE="{folder}/{config}.h"']
    sources = [ROOT / 'tests/driver/target/scene.c', *sorted((ROOT / 'driver').glob('*.c'))]
    subprocess.run([*compiler, *options, *defines, '-o', program, *sources, '-lgcc'], check=True)
    return program


def mnemonics(target, program):
    """Address -> mnemonic."""
    objdump = TARGETS[target][0][0].replace('gcc', 'objdump')
    text = subprocess.run([objdump, '-d', '--no-show-raw-insn', program], check=True, capture_output=True, text=True).stdout
    return {int(m[1], 16): m[2] for m in re.finditer(r'^ *([0-9a-f]+):\t(\S+)', text, re.M)}


def executed(target, program):
    """How often each (address, function) ran."""
    run = subprocess.Popen([*TARGETS[target][1], '-singlestep', '-d', 'nochain,exec', '-D', '/dev/stdout', program],
                           stdout=subprocess.PIPE, text=True)
    counts = collections.Counter(line.split('/', 2)[1] + line.rsplit(']', 1)[1].rstrip()
                                 for line in run.stdout if line.startswith('Trace'))
    if run.wait() != 0:
        sys.exit(f'count_instructions.py: {program.name} ended with {run.returncode}')
    return counts


def code_bytes(target, program):
    size = TARGETS[target][0][0].replace('gcc', 'size')
    text = subprocess.run([size, program], check=True, capture_output=True, text=True).stdout
    return int(text.splitlines()[1].split()[0])


def measure(folder, target, scene, level, profile):
    """Instructions a vertex, a triangle; products and divisions a triangle; bytes of code."""
    counts, total, kinds = {}, {}, {}
    for work in (NOTHING, DRAWS, CULLS):
        program = build(folder, target, scene, level, work)
        counts[work] = executed(target, program)
        total[work] = sum(counts[work].values())
        names, kinds[work] = mnemonics(target, program), collections.Counter()
        for place, count in counts[work].items():
            name = names.get(int(place.split(' ')[0], 16), '')
            kind = 'division' if DIVISION.match(name) else 'product' if PRODUCT.match(name) or 'mul' in name else ''
            kinds[work][kind] += count
        if work == DRAWS:
            size = code_bytes(target, program)
    if profile:
        functions = collections.Counter()
        for work, sign in ((DRAWS, 1), (NOTHING, -1)):
            for place, count in counts[work].items():
                functions[place.split(' ', 1)[1] if ' ' in place else '?'] += sign * count
        for name, count in functions.most_common(16):
            if count >= TRIANGLES:
                print(f'    {name:24} {count / TRIANGLES:8.1f} a triangle')
    each = {kind: (kinds[DRAWS][kind] - kinds[NOTHING][kind]) / TRIANGLES for kind in ('product', 'division')}
    return (round((total[CULLS] - total[NOTHING]) / VERTICES), round((total[DRAWS] - total[NOTHING]) / TRIANGLES),
            round(each['product']), round(each['division']), size)


def rows(halfplane, only, profile):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for config in ('embedded', 'textured', 'stencilled'):
            header = subprocess.run([halfplane, 'config', '--config', config, '--c-header'], check=True, capture_output=True)
            (folder / f'{config}.h').write_bytes(header.stdout)
        for target in TARGETS:
            for level in ('-O2', '-O3'):
                for scene in SCENES:
                    row = f'{target} {level} {scene}'
                    if only in row:
                        yield row, measure(folder, target, scene, level, profile)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('halfplane')
    parser.add_argument('--only', default='')
    parser.add_argument('--profile', action='store_true')
    parser.add_argument('--page')
    options = parser.parse_args()
    missing = [words[0] for pair in TARGETS.values() for words in pair if not shutil.which(words[0])]
    if missing:
        sys.exit(f'count_instructions.py: not installed: {" ".join(missing)}')
    page = pathlib.Path(options.page).read_text() if options.page else ''
    wrong = 0
    print('| processor, options, configuration | vertex | triangle | products | divisions | triangles/s at 100 MHz | code |')
    print('| --- | ---: | ---: | ---: | ---: | ---: | ---: |')
    for row, (vertex, triangle, products, divisions, size) in rows(options.halfplane, options.only, options.profile):
        rate = round(1e8 / triangle, -2)
        print(f'| {row} | {vertex:,} | {triangle:,} | {products} | {divisions} | {rate:,.0f} | {size:,} |', flush=True)
        if page:
            said = re.search(rf'^\| {row} \| ([\d,]+) \| ([\d,]+) \|', page, re.M)
            if not said or any(abs(int(text.replace(',', '')) - value) > value / 100
                               for text, value in zip(said.groups(), (vertex, triangle))):
                print(f'{options.page} says {said[0] if said else "nothing of " + row}', file=sys.stderr)
                wrong = 1
    return wrong


if __name__ == '__main__':
    sys.exit(main())
