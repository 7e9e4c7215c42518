#!/usr/bin/env python3
"""Carry chains of a netlist by synth_ecp5 without the places that only feed them: carry_chains.py NETLIST RESULT (JSON).

nextpnr-ecp5 puts a cell in front of a chain whose carry-in is a constant, and one behind a chain whose carry-out is
connected, even if nobody reads it; each takes two places. Here a carry-out that nobody reads is disconnected, and where
the last half of a chain's last cell is free, the chain moves up by a half: the first one then gives the constant,
whatever its carry-in is. The function of the netlist stays (tests/area/carry_chains_test.py).
"""
import collections
import json
import sys

HALF = ('A', 'B', 'C', 'D', 'S', 'INIT', 'INJECT1_')
# A half that propagates nothing: its LUT4 is 0, so its carry-out is its LUT2, the lowest bits of INIT, which A and B select.
# A to D are 1; its sum is not read.
GIVES = {'0': f'{0x0000:016b}', '1': f'{0x000f:016b}'}


def half(cell, k):
    ports = [cell['connections'][f'{port}{k}'] for port in HALF[:5]]
    return ports + [cell['parameters'][f'{name}{k}'] for name in HALF[5:]]


def set_half(cell, k, values):
    for port, bits in zip(HALF[:5], values):
        cell['connections'][f'{port}{k}'] = bits
    for name, value in zip(HALF[5:], values[5:]):
        cell['parameters'][f'{name}{k}'] = value


def without_feeding(module):
    """Changes the module's chains; the number of constants and carry-outs that no longer take a cell."""
    cells = module['cells'].values()
    readers = collections.Counter()
    for port in module['ports'].values():
        if port['direction'] == 'output':
            readers.update(port['bits'])
    for cell in cells:
        for port, bits in cell['connections'].items():
            if cell['port_directions'][port] == 'input':
                readers.update(bits)
    carries = [cell for cell in cells if cell['type'] == 'CCU2C']
    follows = {cell['connections']['CIN'][0]: cell for cell in carries if cell['connections']['CIN']}

    def is_read(bits):
        return any(readers[bit] for bit in bits)

    constants = outs = 0
    for first in carries:
        if first['connections']['CIN'] not in (['0'], ['1']):
            continue
        chain = [first]
        while (out := chain[-1]['connections']['COUT']) and readers[out[0]] == 1 and out[0] in follows:
            chain.append(follows[out[0]])
        halves = [half(cell, k) for cell in chain for k in (0, 1)]
        if is_read(chain[-1]['connections']['COUT']) or is_read(halves[-1][4]) or any(h[6] != 'NO' for h in halves):
            continue
        given = GIVES[first['connections']['CIN'][0]]
        halves = [[['1']] * 4 + [['x'], given, 'NO'], *halves[:-1]]
        for at, values in enumerate(halves):
            set_half(chain[at // 2], at % 2, values)
        first['connections']['CIN'] = ['x']
        constants += 1
    for cell in carries:
        if cell['connections']['COUT'] and not is_read(cell['connections']['COUT']):
            cell['connections']['COUT'] = ['x']
            outs += 1
    return constants, outs


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        netlist = json.load(file)
    for name, module in netlist['modules'].items():
        if not int(module['attributes'].get('blackbox', '0'), 2):
            constants, outs = without_feeding(module)
            print(f'{name}: {constants} constant carry-ins, {outs} carry-outs')
    with open(sys.argv[2], 'w', encoding='utf-8') as file:
        json.dump(netlist, file)


if __name__ == '__main__':
    main()
