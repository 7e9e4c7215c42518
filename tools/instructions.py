#!/usr/bin/env python3
"""What engines spend, in instructions (valgrind --tool=callgrind, one thread): the functional engine on small
triangles and lines, with AVX2, and the cycle engine on the cycles of a frame.

Time on a shared machine says little, and instructions do not lie about how much work there is: a gate that a slow
neighbour cannot close. Counted is a frame whose memory is there from the frame before: the second of two.

  tools/instructions.py PROGRAM ENGINE [--valgrind FILE]     PROGRAM: halfplane_frames, of a release build

Exit status: 0 within the bounds, 1 beyond one, 3 something is missing, 77 the machine has no AVX2.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

# Engine, scene, size, samples a pixel, the things that count and their number, instructions that each may take: what
# was measured with g++ 12, and a twentieth.
GATES = [
    ('functional', 'dust:250000', (640, 360), 1, 'triangle', 249_630, 330),
    ('functional', 'ball', (1280, 720), 1, 'triangle', 51_200, 744),
    ('functional', 'ball_linear', (1280, 720), 1, 'triangle', 51_200, 1_674),
    ('functional', 'scratches', (1280, 720), 1, 'line', 50_000, 2_860),
    ('functional', 'city', (640, 480), 4, 'pixel', 307_200, 67),
    ('cycle', 'city', (320, 240), 1, 'cycle', 48_405, 671),
]
COUNTED = {
    'functional': 'halfplane::functional::FrameRenderer::render*',
    'cycle': 'halfplane::CycleFrames::draw(halfplane::Scene const&, halfplane::RenderOptions const&)',
}


def instructions(program, valgrind, engine, scene, size, samples):
    """Of the second frame, inside the engine."""
    with tempfile.TemporaryDirectory() as folder:
        command = [valgrind, '--tool=callgrind', f'--callgrind-out-file={folder}/out',
                   f'--toggle-collect={COUNTED[engine]}', program, engine, scene, *map(str, (*size, 2, samples))]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode == 77:
            print('this machine has no AVX2, whose instructions are counted')
            sys.exit(77)
        if run.returncode != 0:
            sys.exit(f'{" ".join(command)}: status {run.returncode}\n{run.stderr}')
        summary = re.search(r'^(?:totals|summary): (\d+)', pathlib.Path(folder, 'out').read_text(), re.MULTILINE)
        if summary is None or int(summary[1]) == 0:
            sys.exit(f'nothing was counted in {COUNTED[engine]}')
        return int(summary[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('program')
    parser.add_argument('engine', choices=sorted(COUNTED))
    parser.add_argument('--valgrind', default='valgrind')
    options = parser.parse_args()
    within = True
    for engine, scene, size, samples, thing, count, bound in GATES:
        if engine != options.engine:
            continue
        each = instructions(options.program, options.valgrind, engine, scene, size, samples) / count
        within &= each <= bound
        print(f'{scene:12} {size[0]}x{size[1]}  {samples} a pixel  {each:7.1f} instructions a {thing}, at most {bound}')
    return 0 if within else 1


if __name__ == '__main__':
    try:
        sys.exit(main())
    except FileNotFoundError as missing:
        print(f'{missing.filename}: not found', file=sys.stderr)
        sys.exit(3)
