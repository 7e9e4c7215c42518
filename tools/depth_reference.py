#!/usr/bin/env python3
"""Exact reference for depth quantization, written without a look at sim/study/depth, from the definitions in docs/depth.md.

Usage: tools/depth_reference.py > tests/data/depth_reference.csv
"""
import csv
import sys
from decimal import Decimal, getcontext
from fractions import Fraction as Fr

getcontext().prec = 120  # log only; 60 leaves 15 digits of f32 code 0 (width ~1e-45 of z)
MAPPINGS = ("std", "rev", "stdinf", "revinf", "w", "log")
FORMATS = ("u8", "u16", "u24", "u32", "bins8", "bins16", "bins24", "f16", "f32", "uf4.12", "uf5.11", "uf3.5")


def to_decimal(x):
    return Decimal(x.numerator) / Decimal(x.denominator)

class Mapping:
    def __init__(self, name, near, far):
        self.name, self.n, self.f = name, near, far
        self.log_ratio = Fr(to_decimal(far / near).ln()) if name == "log" else None

    def depth(self, z):
        """(d, exact); inexact only for an irrational log depth."""
        n, f = self.n, self.f
        if self.name == "log":
            d = Fr(to_decimal(z / n).ln()) / self.log_ratio
            # d = p/q makes f/n a perfect q-th power, so q <= log2(numerator) < 64
            guess = d.limit_denominator(64)
            exact = (z / n) ** guess.denominator == (f / n) ** guess.numerator
            return (guess, True) if exact else (d, False)
        return {"std": f * (z - n) / (z * (f - n)), "rev": n * (f - z) / (z * (f - n)),
                "stdinf": 1 - n / z, "revinf": n / z, "w": (z - n) / (f - n)}[self.name], True

    def eye(self, d):
        """Inverse of depth on [0, 1]; None is infinity."""
        n, f = self.n, self.f
        if self.name == "log":
            return f if d == 1 else n * Fr(to_decimal(d * self.log_ratio).exp())
        if self.name == "w":
            return n + d * (f - n)
        inverse = {"std": f - d * (f - n), "rev": n + d * (f - n), "stdinf": 1 - d, "revinf": d}[self.name]
        scale = n * f if self.name in ("std", "rev") else n
        return scale / inverse if inverse else None

    def slope(self, z):
        """|dz/dd|"""
        n, f = self.n, self.f
        if self.name == "log":
            return z * self.log_ratio
        if self.name == "w":
            return f - n
        return z * z / n * ((f - n) / f if self.name in ("std", "rev") else 1)

class Format:
    def __init__(self, name):
        self.kind = name.rstrip("0123456789.")
        size = name[len(self.kind):]
        if self.kind == "uf":
            exponent_bits, self.m = map(int, size.split("."))
            self.top = 2 ** (exponent_bits + self.m) - 1
            self.unit = Fr(1, self.integer(self.top))
        elif self.kind == "f":
            self.m, bias = {"16": (10, 15), "32": (23, 127)}[size]
            self.top = bias << self.m  # raw bits of 1.0
            self.unit = Fr(1, 2 ** (bias - 1 + self.m))
        else:
            self.top = 2 ** int(size) - 1

    def integer(self, c):
        exponent, frac = c >> self.m, c & (2 ** self.m - 1)
        return (2 ** self.m + frac) << (exponent - 1) if exponent else frac

    def value(self, c):
        if self.kind == "u":
            return Fr(c, self.top)
        return Fr(2 * c + 1, 2 * (self.top + 1)) if self.kind == "bins" else self.integer(c) * self.unit

    def lower(self, c):
        """d-boundary between codes c-1 and c; 0 below the first code, 1 above the top code."""
        if c == 0 or c > self.top:
            return Fr(min(c, 1))
        return Fr(c, self.top + 1) if self.kind == "bins" else (self.value(c - 1) + self.value(c)) / 2

    def encode(self, d):
        low, high = 0, self.top  # largest code with lower(code) <= d: ties up
        while low < high:
            mid = (low + high + 1) // 2
            low, high = (mid, high) if self.lower(mid) <= d else (low, mid - 1)
        return low - 1 if self.kind in ("f", "uf") and low % 2 and self.lower(low) == d else low

    def width(self, c):
        """Width in d for first_order: the end codes count as whole bins."""
        if self.kind == "u":
            return Fr(1, self.top)
        if c == 0 and self.kind != "bins":
            return 2 * self.lower(1)
        if c == self.top and self.kind != "bins":
            return 2 * (self.value(c) - self.lower(c))
        return self.lower(c + 1) - self.lower(c)

def analyse(mapping_name, format_name, near, far, z):
    near, far, z = map(Fr, (near, far, z))
    mapping, fmt = Mapping(mapping_name, near, far), Format(format_name)
    d, exact = mapping.depth(z)
    code = fmt.encode(d)
    edges = (fmt.lower(code), fmt.lower(code + 1))
    assert edges[0] <= d <= edges[1] and (exact or min(abs(d - e) for e in edges) > Fr(1, 10 ** 60))
    eyes = [mapping.eye(e) for e in edges]
    ends = sorted(far if e is None else min(max(e, near), far) for e in eyes)
    restored = mapping.eye(fmt.value(code))
    error = float("inf") if restored is None else max(abs(e - restored) for e in ends)
    return {"code": code, "bin_width": float(ends[1] - ends[0]), "max_recon_err": float(error),
            "first_order": float(mapping.slope(z) * fmt.width(code))}

# for every mapping and format: ties (4, 5.5, 2, 4.096), an infinite reconstruction, the documented example
ALWAYS = (("1", "1000", "900"), ("1", "10", "4"), ("1", "10", "5.5"), ("1", "10", "2"), ("1", "10", "4.096"),
          ("1", "10000000", "10000000"))
# z on a float format's midpoint; even code below, below, above, above
FLOAT_TIES = (("revinf", "f16", "1.31072"), ("revinf", "uf4.12", "1.048448"), ("w", "f16", "5.506591796875"),
              ("w", "f32", "5.5000008046627044677734375"))
SPREAD = {("1", "1000"): "1 1.0001 1.5 10 99.9 100 500.5 999.999 1000",
          ("0.1", "10000"): "0.1 0.10001 0.2 1 10 123.456 900 9999.9 10000",
          ("0.01", "1000"): "0.01 0.0123 0.1 1 10 99.9 314.159 1000",
          ("1", "10"): "1 1.0001 3.3 7.77 9.999 10",
          ("0.5", "5000000"): "0.5 0.7 1 50 900 65536.25 1234567.8 5000000",
          ("1", "10000000"): "1 1.0001 10 99.9 1000 250000 7654321",
          ("3.7", "123.4"): "3.7 3.75 7.4 10 63.55 99.9 123.4",
          ("100", "101"): "100 100.0001 100.25 100.5 100.77 101"}

def grid():
    spread = [(near, far, z) for (near, far), zs in SPREAD.items() for z in zs.split()]
    for i, mapping in enumerate(MAPPINGS):
        for j, fmt in enumerate(FORMATS):
            chosen = tuple(p for k, p in enumerate(spread) if (k + i + 2 * j) % 5 == 0)
            yield from ((mapping, fmt) + point for point in ALWAYS + chosen)
    yield from ((mapping, fmt, "1", "10", z) for mapping, fmt, z in FLOAT_TIES)

def self_check():
    example = analyse("std", "u16", "1", "1000", "900")
    assert "%.3f %.3f" % (example["bin_width"], example["first_order"]) == "12.447 12.347"
    for fmt, code in (("u8", 128), ("bins8", 128), ("u16", 32768)):  # exact log tie at d = 1/2
        assert analyse("log", fmt, "1", "100", "10")["code"] == code

if __name__ == "__main__":
    self_check()
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(("mapping", "format", "near", "far", "z", "code", "bin_width", "max_recon_err", "first_order"))
    for row in grid():
        out.writerow(row + tuple(repr(number) for number in analyse(*row).values()))
