#!/usr/bin/env python3
"""Debian's piglit on Halfplane's OpenGL driver: the tests of OpenGL 1.0 to 1.5 that are in the package, in windows under Xvfb.

  piglit.py [--only REGEX] [--halfplane PROGRAM]    one line for each test that does not pass or skip itself, then the counts

Needs Debian's piglit and xvfb, build/halfplane and the driver beside it. Exit status 1: a test fails that is not in KNOWN.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

import programs

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLACE = pathlib.Path('/usr/lib/x86_64-linux-gnu/piglit')
SECONDS = 90  # for a test
# Every unit: what the driver has without a configuration (gl/core/options.cpp).
UNITS = ('stencil.bits=8', 'perspective.colors=1', 'texture.unit=trilinear', 'texture.constant=1', 'texture.border=1',
         'alpha.unit=1', 'blend.lanes=4', 'logic.unit=1', 'fog.unit=1')
# What does not pass, and why: docs/programs.md.
KNOWN = {'copy-pixels', 'depthstencil-default_fb-copypixels', 'draw-pixels', 'gl-1.0-beginend-coverage', 'gl-1.0-blend-func',
         'max-texture-size', 'sized-texture-format-channels', 'streaming-texture-leak', 'teximage-errors',
         'texsubimage-depth-formats', 'windowoverlap'}


def commands(only):
    """Name and words of each test. piglit would draw into framebuffer objects, which OpenGL 1.5 does not have."""
    listed = subprocess.run(['piglit', 'print-cmd', '--format', '{name}\t{command}', 'opengl'], capture_output=True,
                            text=True, check=True).stdout
    for line in listed.splitlines():
        name, _, command = line.partition('\t')
        found = re.match(r'spec@!opengl 1\.[0-5]@(.*)', name)
        if found and re.search(only, found[1]):
            program, *words = command.split()
            yield found[1], [str(PLACE / 'bin' / pathlib.Path(program).name), *(w for w in words if w != '-fbo')]


def result(words, display, halfplane):
    env = os.environ | {'PIGLIT_PLATFORM': 'glx', 'PIGLIT_SOURCE_DIR': str(PLACE), 'DISPLAY': display}
    if not os.path.exists(words[0]):
        return 'not in the package'
    configuration = ['--config', 'full', *(word for unit in UNITS for word in ('--set', unit))]
    process = subprocess.Popen([str(halfplane), 'run', *configuration, '--', *words], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True, errors='replace', env=env, start_new_session=True)
    try:
        said = re.findall(r'PIGLIT: \{"result": "(\w+)"', process.communicate(timeout=SECONDS)[0])
    except subprocess.TimeoutExpired:
        programs.stop(process)
        return f'over {SECONDS} s'
    return said[-1] if said else f'no result, status {process.returncode}'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--only', default='', metavar='REGEX')
    parser.add_argument('--halfplane', type=pathlib.Path, default=ROOT / 'build/halfplane', metavar='PROGRAM')
    options = parser.parse_args()
    tests = list(commands(options.only))
    if not tests:
        sys.exit('piglit.py: piglit has no such test')
    counts, unknown = collections.Counter(), 0
    with programs.Display() as display, concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = pool.map(lambda test: result(test[1], display.name, options.halfplane), tests)
        for (name, _), said in zip(tests, results):
            counts[said] += 1
            if said not in ('pass', 'skip'):
                print(f'{name}: {said}', flush=True)
                unknown += name not in KNOWN
            elif name in KNOWN:
                print(f'{name}: {said}, which KNOWN does not know', flush=True)
    print(', '.join(f'{n} {said}' for said, n in counts.most_common()))
    return 1 if unknown else 0


if __name__ == '__main__':
    sys.exit(main())
