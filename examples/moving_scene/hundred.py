#!/usr/bin/env python3
"""Writes hundred.gltf, or the file that is named: a hundred balls before a camera at rest, one of which moves for two seconds.

  python3 hundred.py
  halfplane render hundred.gltf --frames 8 --engine cycle --set frame.order=bins --set frame.store=color --set frame.clears=flags --csv bins.csv

  python3 hundred.py --rings 20 --around 28 --textured fine.gltf     # 106,400 triangles
  halfplane bench fine.gltf --size 1280x720 --threads 2 --engines functional,llvmpipe
"""
import argparse
import base64
import json
import math
import struct
import zlib

SIDE = 10            # balls along a side
RADIUS = 0.4         # of a ball; their centres are 1 apart
COLORS = ((0.85, 0.3, 0.25), (0.3, 0.6, 0.85), (0.9, 0.75, 0.3), (0.4, 0.75, 0.45))


class File:
    """The parts of a glTF file that this one needs."""

    def __init__(self):
        self.bytes = b''
        self.views, self.accessors = [], []

    def accessor(self, kind, rows, target=None):
        """rows: tuples of floats, or for SCALAR numbers; 16-bit ones where they are whole."""
        flat = [x for row in rows for x in (row if isinstance(row, tuple) else (row,))]
        is_index = all(isinstance(x, int) for x in flat)
        data = struct.pack(f'<{len(flat)}{"H" if is_index else "f"}', *flat)
        self.bytes += bytes(-len(self.bytes) % 4)
        self.views.append({'buffer': 0, 'byteOffset': len(self.bytes), 'byteLength': len(data)})
        if target:
            self.views[-1]['target'] = target
        self.bytes += data
        entry = {'bufferView': len(self.views) - 1, 'componentType': 5123 if is_index else 5126, 'count': len(rows), 'type': kind}
        columns = list(zip(*[row if isinstance(row, tuple) else (row,) for row in rows]))
        entry |= {'min': [min(c) for c in columns], 'max': [max(c) for c in columns]}
        self.accessors.append(entry)
        return len(self.accessors) - 1


def ball(rings, around):
    """Normals, places in the texture, and triangles: at the poles one a segment."""
    normals, places, triangles = [], [], []
    for i in range(rings + 1):
        for j in range(around + 1):
            polar, angle = math.pi * i / rings, 2 * math.pi * j / around
            normals.append((math.sin(polar) * math.cos(angle), math.cos(polar), math.sin(polar) * math.sin(angle)))
            places.append((2.0 * j / around, float(i) / rings))
    row = around + 1
    for i in range(rings):
        for j in range(around):
            a, b = i * row + j, i * row + j + 1
            triangles += ([a, b, a + row] if i else []) + ([b, b + row, a + row] if i + 1 < rings else [])
    return normals, places, triangles


def chequered_png(side=64, squares=8):
    """A PNG of grey squares, as bytes."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))

    rows = b''.join(b'\0' + bytes(255 if (x * squares // side + y * squares // side) % 2 else 150 for x in range(side))
                    for y in range(side))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', side, side, 8, 0, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('file', nargs='?', default='hundred.gltf')
    parser.add_argument('--rings', type=int, default=10, help='of a ball')
    parser.add_argument('--around', type=int, default=16, help='segments of a ring')
    parser.add_argument('--textured', action='store_true')
    options = parser.parse_args()

    file = File()
    normals, on_texture, triangles = ball(options.rings, options.around)
    positions = [tuple(RADIUS * x for x in n) for n in normals]
    attributes = {'POSITION': file.accessor('VEC3', positions, 34962), 'NORMAL': file.accessor('VEC3', normals, 34962)}
    if options.textured:
        attributes['TEXCOORD_0'] = file.accessor('VEC2', on_texture, 34962)
    indices = file.accessor('SCALAR', triangles, 34963)
    moving = SIDE * (SIDE // 2) + SIDE // 2
    places = [((n % SIDE) - (SIDE - 1) / 2, (n // SIDE) - (SIDE - 1) / 2, 0.0) for n in range(SIDE * SIDE)]
    x, y, z = places[moving]
    times = file.accessor('SCALAR', [0.0, 1.0, 2.0])
    way = file.accessor('VEC3', [(x, y, z), (x + 0.1, y, z + 0.3), (x, y, z)])
    document = {
        'asset': {'version': '2.0'},
        'buffers': [{'byteLength': len(file.bytes),
                     'uri': 'data:application/octet-stream;base64,' + base64.b64encode(file.bytes).decode()}],
        'bufferViews': file.views,
        'accessors': file.accessors,
        'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [*c, 1], 'metallicFactor': 0, 'roughnessFactor': 0.6}} for c in COLORS],
        'meshes': [{'primitives': [{'attributes': attributes, 'indices': indices, 'material': m}]} for m in range(len(COLORS))],
        'cameras': [{'type': 'perspective', 'perspective': {'yfov': 0.8, 'znear': 1, 'zfar': 40}}],
        'nodes': [{'mesh': n * 7 % len(COLORS), 'translation': list(p)} for n, p in enumerate(places)] +
                 [{'camera': 0, 'translation': [0, 0, 13]}],
        'scenes': [{'nodes': list(range(SIDE * SIDE + 1))}],
        'scene': 0,
        'animations': [{'samplers': [{'input': times, 'output': way}],
                        'channels': [{'sampler': 0, 'target': {'node': moving, 'path': 'translation'}}]}],
    }
    if options.textured:
        document['images'] = [{'uri': 'data:image/png;base64,' + base64.b64encode(chequered_png()).decode()}]
        document['samplers'] = [{'magFilter': 9729, 'minFilter': 9729}]  # linear
        document['textures'] = [{'source': 0, 'sampler': 0}]
        for material in document['materials']:
            material['pbrMetallicRoughness']['baseColorTexture'] = {'index': 0}
    with open(options.file, 'w', encoding='ascii') as out:
        json.dump(document, out)


if __name__ == '__main__':
    main()
