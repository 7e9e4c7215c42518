#!/usr/bin/env python3
"""tools/carry_chains.py keeps a netlist's function, and takes away what it says: Yosys proves both netlists equal with
its models of the cells, whatever a carry-in that nobody gives is.

  tests/area/carry_chains_test.py YOSYS FOLDER
"""
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / 'tools'))
import carry_chains  # noqa: E402

# Chains of odd and even lengths, with either constant and with a signal as carry-in, with a reader of the carry-out and
# without.
DESIGN = '''
module chains (input [8:0] a, b, input c, output [6:0] odd, output [7:0] even, output [6:0] minus,
               output [7:0] even_minus, output [5:0] carried, output less, output [7:0] out);
  assign odd = a[6:0] + b[8:2];
  assign even = a[7:0] + b[8:1];
  assign minus = b[6:0] - a[8:2];
  assign even_minus = b[7:0] - a[8:1];
  assign carried = a[8:3] + b[5:0] + c;
  assign less = a < b;
  assign out = {1'b0, a[8:2]} + {1'b0, b[7:1]};
endmodule
'''
TAKEN = (2, 6)  # constant carry-ins of chains with a free half; carry-outs


def yosys(program, script, folder):
    return subprocess.run([program, '-q', '-p', script], cwd=folder, capture_output=True, text=True, check=False)


def equal(program, folder, before, after):
    """Whether Yosys proves that the netlists have one function."""
    read = '; '.join(f'read_json {name}.json; rename chains {name}' for name in (before, after))
    run = yosys(program, f'{read}; read_verilog -overwrite +/ecp5/cells_sim.v; hierarchy -check; proc; flatten; '
                f'miter -equiv -make_outputs {before} {after} both; flatten both; opt_clean; '
                'sat -verify -prove trigger 0 -show-inputs both', folder)
    if run.returncode and 'proof did fail' not in run.stdout + run.stderr:
        sys.exit(run.stdout + run.stderr)
    return run.returncode == 0


def changed(folder, name, netlist, change):
    module = json.loads(json.dumps(netlist))['modules']['chains']
    module['attributes'] = {}  # none is the top
    change(module)
    text = json.dumps({'creator': 'test', 'modules': {'chains': module}})
    (folder / f'{name}.json').write_text(text, encoding='utf-8')


def open_carries(value):
    """Gives every carry-in that nobody gives a value; outputs that nobody reads are unconnected."""
    def change(module):
        for cell in module['cells'].values():
            for port, bits in cell['connections'].items():
                if bits == ['x']:
                    cell['connections'][port] = [value] if port == 'CIN' else []
    return change


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / 'chains.v').write_text(DESIGN, encoding='utf-8')
    made = yosys(program, 'read_verilog chains.v; synth_ecp5 -top chains; write_json chains.json', folder)
    if made.returncode:
        sys.exit(made.stdout + made.stderr)
    made = json.loads((folder / 'chains.json').read_text(encoding='utf-8'))
    changed(folder, 'before', made, lambda module: None)
    after = json.loads((folder / 'before.json').read_text(encoding='utf-8'))
    taken = carry_chains.without_feeding(after['modules']['chains'])
    if taken != TAKEN:
        sys.exit(f'took {taken}, not {TAKEN}')
    for value in '01':
        changed(folder, 'after', after, open_carries(value))
        if not equal(program, folder, 'before', 'after'):
            sys.exit(f'another function where an open carry-in is {value}')

    # A chain that gives the other constant must be found.
    given = carry_chains.GIVES
    carry_chains.GIVES = {'0': given['1'], '1': given['0']}
    faulty = json.loads((folder / 'before.json').read_text(encoding='utf-8'))
    carry_chains.without_feeding(faulty['modules']['chains'])
    changed(folder, 'faulty', faulty, open_carries('0'))
    if equal(program, folder, 'before', 'faulty'):
        sys.exit('the fault was not found')


if __name__ == '__main__':
    main()
