#!/usr/bin/env python3
"""A rasterizer of somebody else's: captures of flat triangles in window space, each at one depth, into a PNG.

Written from docs/spec.md and docs/capture.md alone, in whole numbers of its own, and judged by its picture:

  rasterizer.py scene.hpt yours.png && halfplane compare scene.hpt --against yours.png

--bug edge_rule  a sample on any border belongs to the triangle
--bug snap       vertices are cut to the grid, not rounded
--bug depth_func what is as far away replaces what is there
--bug color      colours are cut to 5 and 6 bits, not rounded
"""
import argparse
import struct
import sys
import zlib

SUBPIXEL = 4  # bits of `embedded`
DEPTH_MAX = 2**16 - 1
BUGS = ('edge_rule', 'snap', 'depth_func', 'color')


def read_capture(path):
    """(width, height, clear colour, clear depth, triangles); a triangle is three vertices (x, y, z, rgb)."""
    size, color, depth, vertices, triangles = None, (0, 0, 0), 1.0, [], []
    with open(path, encoding='utf-8') as file:
        for number, line in enumerate(file, 1):
            words = line.split('#', 1)[0].split()
            match words:
                case [] | ['halfplane', '1'] | ['space', 'window' | 'clip']:  # clip: of a clear alone
                    pass
                case ['target', width, height]:
                    size = int(width), int(height)
                case ['clear', 'color', r, g, b, _, 'depth', z]:
                    color, depth = (int(r), int(g), int(b)), float(z)
                case ['v', x, y, z, _, r, g, b, _]:
                    vertices.append((float(x), float(y), float(z), (int(r), int(g), int(b))))
                case ['t', *indices] if len(indices) % 3 == 0:
                    corners = [vertices[int(index)] for index in indices]
                    triangles += [corners[i:i + 3] for i in range(0, len(corners), 3)]
                case _:
                    sys.exit(f'{path}:{number}: not for this rasterizer')
    return *size, color, depth, triangles


def stored(rgb, bug):
    """rgb565, a code for each channel."""
    if bug == 'color':
        return tuple(c * (2**bits) // 256 for c, bits in zip(rgb, (5, 6, 5)))
    return tuple((c * (2**bits - 1) * 2 + 255) // 510 for c, bits in zip(rgb, (5, 6, 5)))


def snapped(value, bug):
    scaled = value * 2**SUBPIXEL
    return int(scaled // 1) if bug == 'snap' else int((scaled + 0.5) // 1)


def draw(triangle, width, height, color, depth, bug):
    """Draws into `color` and `depth`, dictionaries by pixel."""
    (ax, ay), (bx, by), (cx, cy) = [(snapped(x, bug), snapped(y, bug)) for x, y, _, _ in triangle]
    if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0:
        bx, by, cx, cy = cx, cy, bx, by
    sides = []
    for (px, py), (qx, qy) in (((ax, ay), (bx, by)), ((bx, by), (cx, cy)), ((cx, cy), (ax, ay))):
        dx, dy = qx - px, qy - py
        # y goes down and the inside is on the right: a left side goes up, a top side to the right.
        is_owner = dy < 0 or (dy == 0 and dx > 0)
        sides.append((px, py, dx, dy, 0 if is_owner or bug == 'edge_rule' else 1))
    z = int(triangle[0][2] * DEPTH_MAX + 0.5)
    code = stored(triangle[0][3], bug)
    one, half = 2**SUBPIXEL, 2**(SUBPIXEL - 1)
    for y in range(max(0, min(ay, by, cy) // one), min(height, max(ay, by, cy) // one + 1)):
        for x in range(max(0, min(ax, bx, cx) // one), min(width, max(ax, bx, cx) // one + 1)):
            sx, sy = x * one + half, y * one + half
            if all(dx * (sy - py) - dy * (sx - px) >= least for px, py, dx, dy, least in sides):
                if z < depth[x, y] or (bug == 'depth_func' and z == depth[x, y]):
                    depth[x, y], color[x, y] = z, code


def write_png(path, width, height, color):
    """8 bits, rgb565 by bit replication."""
    widen = lambda c, bits: c << (8 - bits) | c >> (2 * bits - 8)
    rows = b''.join(b'\0' + bytes(widen(c, bits) for x in range(width) for c, bits in zip(color[x, y], (5, 6, 5)))
                    for y in range(height))
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    with open(path, 'wb') as file:
        file.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0))
                   + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('capture')
    parser.add_argument('picture')
    parser.add_argument('--bug', choices=BUGS)
    options = parser.parse_args()
    width, height, clear_color, clear_depth, triangles = read_capture(options.capture)
    pixels = [(x, y) for y in range(height) for x in range(width)]
    color = dict.fromkeys(pixels, stored(clear_color, options.bug))
    depth = dict.fromkeys(pixels, int(clear_depth * DEPTH_MAX + 0.5))
    for triangle in triangles:
        draw(triangle, width, height, color, depth, options.bug)
    write_png(options.picture, width, height, color)


if __name__ == '__main__':
    main()
