#!/usr/bin/env python3
"""The triangle of docs/spec.md, computed from the formulas alone: prints every figure of the page, writes its drawing.

docs/spec/triangle.py docs/images/spec-triangle.svg
"""
import sys
from fractions import Fraction
from math import floor

S, B, T, GUARD, EXTRA, LOCAL = 4, 16, 8, 2048, 4, 6  # embedded: subpixel.bits ... plane.local_guard_bits
G = (4 * GUARD - 1).bit_length() + 4
F = G + S
VERTICES = [('2.30', '1.20', '0.25', (255, 64, 0)), ('14.10', '5.50', '0.50', (0, 255, 64)),
            ('4.90', '11.50', '0.75', (64, 0, 255))]
PIXEL, ANCHOR = (6, 3), (4, 4)


def nearest(value):
    return floor(value + Fraction(1, 2))


class Edge:
    """From one snapped vertex to the next one."""

    def __init__(self, start, end):
        self.start, self.dx, self.dy = start, end[0] - start[0], end[1] - start[1]
        self.is_top_left = self.dy < 0 or self.dy == 0 and self.dx > 0

    def exact(self, x, y):
        return self.dx * (16 * y + 8 - self.start[1]) - self.dy * (16 * x + 8 - self.start[0])

    def value(self, x, y):
        return (self.exact(x, y) - (not self.is_top_left)) >> S


def plane(name, bits, codes, vertices, area):
    """One attribute: its gradients, its value at the first tile's anchor, its code at PIXEL."""
    (x0, y0), (x1, y1), (x2, y2) = vertices
    k = area.bit_length() - 1 + bits + EXTRA
    reciprocal = nearest(Fraction(2**k, area))
    a, b = codes[1] - codes[0], codes[2] - codes[0]
    numerators = a * (y2 - y0) - b * (y1 - y0), (x1 - x0) * b - (x2 - x0) * a
    gradients = [nearest(Fraction(n * reciprocal, 2**(k - F))) for n in numerators]
    centre = [16 * c + 8 for c in ANCHOR]
    value = (codes[0] << F) + gradients[0] * (centre[0] - x0) + gradients[1] * (centre[1] - y0)
    anchor = nearest(Fraction(value, 2**(F - LOCAL)))
    steps = [nearest(Fraction(g, 2**(F - LOCAL - S))) for g in gradients]
    local = anchor + sum((p - c) * s for p, c, s in zip(PIXEL, ANCHOR, steps))
    bias = (1 << (F - LOCAL - 1)) + (((1 << (bits - 1 + LOCAL)) + (1 << (LOCAL - 1))) << (F - LOCAL))
    packet = [n % 2**(bits + 1 + F) for n in (value + bias, *gradients)]
    code = nearest(Fraction(local, 2**LOCAL))
    print(f'{name}: k {k}, R {reciprocal}, N {numerators}, g {gradients}, value {value}, packet',
          *map(hex, packet), f'anchor {anchor}, steps {steps}, v {local} = {local / 2**LOCAL}, code {code} {code:#x}')
    return code


def draw(path, vertices, edges, is_covered):
    """24 units a pixel; samples are dots, filled where they are covered; tiles have thick sides; PIXEL is framed."""
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="-34 -34 452 452" font-family="sans-serif" font-size="13">',
           '<rect x="-34" y="-34" width="452" height="452" fill="#fff"/>']
    for y in range(16):
        for x in range(16):
            fill = '#cfe3f7' if is_covered(x, y) else '#fff'
            out.append(f'<rect x="{24*x}" y="{24*y}" width="24" height="24" fill="{fill}" stroke="#ccc"/>')
    for x, y in (0, 0), (1, 0), (0, 1), (1, 1):
        out.append(f'<rect x="{192*x}" y="{192*y}" width="192" height="192" fill="none" stroke="#555" stroke-width="2"/>'
                   f'<text x="{192*x+96}" y="{404*y-8}" text-anchor="middle">tile {x} {y}</text>')
    for n in range(16):
        out.append(f'<text x="-8" y="{24*n+17}" text-anchor="end" fill="#555">{n}</text>')
    out.append(f'<rect x="{48*(PIXEL[0]//2)}" y="{48*(PIXEL[1]//2)}" width="48" height="48" fill="none" stroke="#c30" '
               f'stroke-width="2" stroke-dasharray="5 3"/>'
               f'<rect x="{24*PIXEL[0]}" y="{24*PIXEL[1]}" width="24" height="24" fill="none" stroke="#c30" stroke-width="3"/>')
    outline = 'L'.join(f'{1.5*x} {1.5*y}' for x, y in vertices)
    out.append(f'<path d="M{outline}Z" fill="none" stroke="#06c" stroke-width="2"/>')
    for y in range(16):
        for x in range(16):
            is_on_an_edge = any(e.exact(x, y) == 0 for e in edges)
            color = '#c30' if is_on_an_edge else '#024' if is_covered(x, y) else '#bbb'
            out.append(f'<circle cx="{24*x+12}" cy="{24*y+12}" r="{4 if is_on_an_edge else 2.5}" fill="{color}"/>')
    for name, (x, y), (dx, dy) in zip('PQR', vertices, ((-14, -4), (6, -4), (-4, 18))):
        out.append(f'<text x="{1.5*x+dx}" y="{1.5*y+dy}" font-weight="bold" fill="#06c">{name}</text>')
    with open(path, 'w', encoding='ascii') as file:
        file.write('\n'.join(out + ['</svg>', '']))


def main():
    vertices = [(nearest(Fraction(x) * 2**S), nearest(Fraction(y) * 2**S)) for x, y, _, _ in VERTICES]
    depths = [nearest(Fraction(z) * (2**B - 1)) for _, _, z, _ in VERTICES]
    edges = [Edge(vertices[i], vertices[(i + 1) % 3]) for i in range(3)]
    area = edges[0].dx * (vertices[2][1] - vertices[0][1]) - edges[0].dy * (vertices[2][0] - vertices[0][0])
    print(f'vertices {vertices}, depths {depths}, area {area}, F {F}')
    for e in edges:
        span = [(T - 1) * (max(e.dx, 0) + max(-e.dy, 0)), (T - 1) * (min(e.dx, 0) + min(-e.dy, 0))]
        values = [e.value(x, y) for y in (0, 8) for x in (0, 8)]
        print(f'dx {e.dx}, dy {e.dy}, top-left {e.is_top_left}, E at 0 0 {e.exact(0, 0)}, at PIXEL {e.exact(*PIXEL)};',
              f'value at PIXEL {e.value(*PIXEL)}, at tiles with extremes', [(v, *(v + s for s in span)) for v in values])

    def is_covered(x, y):
        return all(e.value(x, y) >= 0 for e in edges)

    print('covered', sum(is_covered(x, y) for x in range(16) for y in range(16)))
    plane('depth', B, depths, vertices, area)
    red, green, blue = (plane(name, 8, [v[3][c] for v in VERTICES], vertices, area)
                        for c, name in enumerate(('red', 'green', 'blue')))
    stored = ((red * 249 + 1014) >> 11) << 11 | ((green * 253 + 505) >> 10) << 5 | (blue * 249 + 1014) >> 11
    print(f'stored colour {stored:#x}')
    if len(sys.argv) > 1:
        draw(sys.argv[1], vertices, edges, is_covered)


if __name__ == '__main__':
    main()
