"""Every stage of a design, packet by packet: what `halfplane vectors` recorded goes through the C interface by the names of
its fields, and what comes out must be what was recorded. Places of fields are judged by the same packets in hexadecimal, as
they lie on a bus.

usage: test_vectors.py PROGRAM DESIGN...     A DESIGN may have settings behind it: "embedded stamp.size=4".
"""

import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

import halfplane

PRIMITIVES = 8
MOST = 1500  # packets of a stage: a fast clear sends a tile each
STAGES = (  # a design has most of them; viewport and line_setup take a scene, texture_memory its textures: not packets alone
    "cull triangle_setup coarse_raster fine_raster interpolate line_raster primitive_join depth_test rop texture_unit "
    "framebuffer memory_port memory"
).split()


def vectors(program, design, stage, form, path):
    """False: the design has no such stage."""
    name, *settings = design.split()
    command = [program, "vectors", "--random", str(PRIMITIVES), "--config", name, "--stage", stage, "--format", form]
    for setting in settings:
        command += ["--set", setting]
    return subprocess.run([*command, "-o", path], capture_output=True, check=False).returncode == 0


def value(text, is_signed, bits):
    number = int(text, 16)
    return number - (1 << bits) if is_signed and number >> bits - 1 else number


def packets_of(path, folder):
    """The configuration, and the packets in order: (direction, port, fields, the whole as a number)."""
    with open(path, encoding="ascii") as file:
        header, *lines = map(json.loads, itertools.islice(file, MOST + 1))
    ports = header["in"] + header["out"]
    types = {port["packet"]: {f["name"]: (f["signed"], f["bits"]) for f in port["fields"]} for port in ports}
    buses = {port: iter((folder / f"{port}.hex").read_text(encoding="ascii").split()) for port in types}
    packets = []
    for line in lines:
        direction, port, _ = line.pop("dir"), line.pop("packet"), line.pop("n")
        fields = {name: value(text, *types[port][name]) for name, text in line.items()}
        packets.append((direction, port, fields, int(next(buses[port]), 16)))
    return header["config"], packets


def number_of(words):
    return sum(word << 32 * i for i, word in enumerate(words))


def judge(unit, stage, packets):
    """Throws what differs first."""
    ports = {"in": {p.name: p for p in unit.inputs}, "out": {p.name: p for p in unit.outputs}}
    for direction, name, fields, bus in packets:
        port = ports[direction][name]
        if number_of(port.words(fields)) != bus or port.packet(port.words(bus)) != fields:
            raise AssertionError(f"{stage}: fields of {name} lie elsewhere: {port.words(fields)} and {bus:#x}")
        if direction == "in":
            unit.put(name, fields)
    for direction, name, fields, _ in packets:
        if direction == "out" and (found := unit.get(name)) != fields:
            raise AssertionError(f"{stage}: {name} is {found}, recorded was {fields}")
    for name in ports["out"] if len(packets) < MOST else ():
        if (more := unit.get(name)) is not None:
            raise AssertionError(f"{stage}: {name} gives {more}, which was not recorded")


def main(program, designs):
    for design in designs:
        judged = []
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for stage in STAGES:
                hexes = folder / stage
                if not vectors(program, design, stage, "jsonl", folder / "jsonl"):
                    continue
                if not vectors(program, design, stage, "hex", hexes):
                    raise AssertionError(f"{design}, {stage}: no vectors in hexadecimal")
                config, packets = packets_of(folder / "jsonl", hexes)
                preset = config.pop("preset")
                judge(halfplane.Stage(halfplane.Config(preset, **config), stage), stage, packets)
                judged.append(len(packets))
        print(f"{design}: {len(judged)} stages, {sum(judged)} packets")
        if len(judged) < 9 or sum(judged) < 1000:
            raise AssertionError(f"{design}: few were judged")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
