#!/usr/bin/env python3
"""Captures in every engine, the golden and the RTL: two tables, of what holds and of what their frames cost.

  captures.py FOLDER [--config blended]    of FOLDER/*.hpt: `halfplane convert NAME.trace --frame N -o NAME-N.hpt`

For each: `render` on the functional, scalar and cycle engine (equal hashes of colour and depth), `compare` (every
bound), `cosim` (bits and cycles of the whole frame), `explain` of the middle pixel, `depth` by the planes that the
frame was projected with. A frame without a depth test or a perspective has no eye depth: `depth` refuses it, and the
table says so. Costs are those of the cycle engine with --memory. Exit status 1: something differs, or a command fails.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Why `depth` has nothing to say about a frame: its words, and those of the table.
NO_DEPTH = {'no eye depth is known': 'flat', 'no draw tests or writes depth': 'no depth',
            'are not known': 'no one projection', 'in window space': 'two spaces'}


class Run:
    """Runs commands of the program on one capture and notes what is wrong."""

    def __init__(self, program, capture, config):
        self.program, self.capture, self.config, self.faults = program, capture, config, []

    def __call__(self, command, *words, before=(), may_refuse=False):
        done = subprocess.run([str(self.program), command, *before, str(self.capture), *words, '--json', '--quiet'],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0 and not may_refuse:
            self.faults.append(f'{command}: status {done.returncode}, {done.stderr.strip()[-200:]}')
        if done.stdout.strip():
            return json.loads(done.stdout)
        return {'refused': done.stderr.strip().removeprefix('halfplane: ')}


def hashes(result):
    return result.get('color_hash'), result.get('depth_hash')


def measure(program, capture, config, memory):
    run = Run(program, capture, config)
    where = ['--config', config]
    frame = run('render', '--engine', 'cycle', '--memory', memory, *where)
    engines = [frame] + [run('render', '--engine', engine, *where) for engine in ('functional', 'scalar')]
    if None in hashes(frame) or len({hashes(engine) for engine in engines}) != 1:
        run.faults.append('the engines differ')
    golden = run('compare', *where)
    rtl = run('cosim', '--save', str(capture.with_suffix('.mismatch.hpt')), *where)
    middle = [str(frame.get(side, 2) // 2) for side in ('width', 'height')]
    pixel = run('explain', *middle, *where)
    if pixel.get('differences', ['no answer']):
        run.faults.append(f'explain: {pixel.get("differences", "no answer")}')
    depth = run('depth', '--mapping', 'std', before=['--scene'], may_refuse=True)
    if 'refused' in depth and not any(reason in depth['refused'] for reason in NO_DEPTH):
        run.faults.append(f'depth: {depth["refused"]}')
    return {'name': capture.stem, 'frame': frame, 'golden': golden, 'rtl': rtl, 'pixel': pixel, 'depth': depth,
            'faults': run.faults}


def fight_rate(depth):
    """Part of the overlapping pairs of fragments whose depths fight in u16; why there is none."""
    if 'refused' in depth:
        return next(short for reason, short in NO_DEPTH.items() if reason in depth['refused'])
    rates = [row['value'] for row in depth['rows'] if row['metric'] == 'fight_rate']
    return f'{100 * rates[0]:.2f} %' if rates else 'no two overlap'


def held_row(one):
    rtl, golden = one['rtl'], one['golden']
    if one['faults']:
        return f'| {one["name"]} | **{"; ".join(one["faults"])}** |'
    cycles = rtl['cycles']
    history = sum(len(pixel['history']) for pixel in one['pixel']['pixels'])
    return (f'| {one["name"]} | {one["frame"]["primitives"]["in"]:,} | {cycles["model"]:,} | '
            f'{"held" if not golden["broken_bounds"] else "**broken**"}; {golden["color_lsb"]["max"]:.1f}, '
            f'{golden["color_lsb"]["rms"]:.2f} LSB | equal | {rtl["mismatches"]} bits, '
            f'{abs(cycles["model"] - cycles["rtl"])} cycles of {sum(rtl["crossings"].values()):,} crossings | '
            f'{history} | {fight_rate(one["depth"])} |')


def cost_row(one):
    frame = one['frame']
    pixels = frame['width'] * frame['height']
    causes = frame['traffic_bytes']
    moved = sum(sum(kinds.values()) for kinds in causes.values())
    texels = sum(kinds.get('texture', 0) for kinds in causes.values())
    skipped, visits = frame['skipped'], max(1, frame['tiles_visited'])
    # Tiles that HiZ hides are not visited.
    share = {'culled': frame['primitives']['culled'] / max(1, frame['primitives']['in']),
             'outside': skipped['tiles_outside'] / visits, 'hidden': skipped['tiles_hiz'] / visits,
             'early': skipped['fragments_early_z'] / max(1, frame['fragments']['covered'])}
    works = frame['bottleneck'].split(':')[0]
    return (f'| {one["name"]} | {frame["width"]}x{frame["height"]} | {frame["primitives"]["in"]:,} | '
            f'{frame["fragments"]["covered"] / pixels:.1f} | {frame["cycles"]:,} | {moved / 1000:,.0f} | '
            f'{100 * texels / max(1, moved):.0f} | {100 * share["culled"]:.0f} | {100 * share["outside"]:.0f} | '
            f'{100 * share["hidden"]:.1f} | {100 * share["early"]:.0f} | {works} |')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--config', default='blended')
    parser.add_argument('--memory', default='sdram')
    parser.add_argument('--halfplane', type=pathlib.Path, default=ROOT / 'build/halfplane')
    parser.add_argument('-j', '--jobs', type=int, default=1)
    options = parser.parse_args()
    captures = sorted(path for path in options.folder.glob('*.hpt') if not path.name.endswith('.mismatch.hpt'))
    if not captures:
        sys.exit(f'captures.py: no .hpt file in {options.folder}')
    rows = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(lambda capture: measure(options.halfplane, capture, options.config, options.memory),
                            captures):
            rows.append(row)
            print(held_row(row), file=sys.stderr, flush=True)
    print('| frame | primitives | cycles | golden | engines | RTL | steps at the middle pixel | depths that fight |')
    print('| --- ' * 8 + '|')
    print('\n'.join(held_row(one) for one in rows))
    print('\n| frame | pixels | primitives | fragments per pixel | cycles | kB moved | of it textures, % | culled, % '
          '| tiles outside, % | tiles hidden, % | early z, % | works most |')
    print('| --- ' * 12 + '|')
    print('\n'.join(cost_row(one) for one in rows if not one['faults']))
    programs = collections.Counter(one['name'].rpartition('-')[0] for one in rows if not one['faults'])
    print(f'\n{sum(programs.values())} of {len(rows)} frames, {len(programs)} programs')
    return int(any(one['faults'] for one in rows))


if __name__ == '__main__':
    sys.exit(main())
