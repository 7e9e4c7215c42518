#!/usr/bin/env python3
"""slang's command line, of which PyPI has the library alone: elaborates a design and prints what is wrong with it.

  build/python/bin/python tools/slang.py --top raster_top PACKAGE rtl_ref/lib/*.sv rtl_ref/stages/*.sv rtl_ref/raster_top.sv

Every warning counts as an error. Exit status: 0 nothing to say, 1 anything else.
"""
import shlex
import sys

from pyslang.driver import Driver

# Generic code shifts by the whole width where a configuration leaves one item, and means the 0 that comes out.
OPTIONS = ['-Werror', '-Wno-shift-count-overflow', '--color-diagnostics=false']


def main():
    driver = Driver()
    driver.addStandardArgs()
    command = shlex.join(['slang', *OPTIONS, *sys.argv[1:]])
    is_read = driver.parseCommandLine(command) and driver.processOptions() and driver.parseAllSources()
    return 0 if is_read and driver.runFullCompilation(quiet=True) else 1


if __name__ == '__main__':
    sys.exit(main())
