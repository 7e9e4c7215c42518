#!/usr/bin/env python3
"""Judges `halfplane explain` from outside: python3 explain_judge.py PROGRAM CAPTURE|FOLDER [PIXELS] [SEED] [-- OPTIONS...]

Random pixels of a capture, or of all in a folder, told by `explain --json`, are held against what this file computes by itself from
the text of the capture (corners, areas, edge values, ties, coverage, exact planes, tests, stencil operations, blending,
texels, means of samples), and against the images that `render` writes (functional engine and golden; cycle engine and, with
--rtl among the options, the RTL, where they have the scene). It knows nothing of the program's sources. Prints how many
figures it compared; the status is 1 when one differs.
"""
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
import zlib
from fractions import Fraction
from pathlib import Path

COVERED = ("stencil", "depth", "alpha", "masked", "written")
VERDICTS = COVERED + ("frustum", "zero_area", "backface", "empty", "no_sample", "scissor", "tiles_outside", "tiles_hiz",
                      "uncovered")
TESTS = {"never": lambda a, b: False, "less": lambda a, b: a < b, "lequal": lambda a, b: a <= b,
         "equal": lambda a, b: a == b, "greater": lambda a, b: a > b, "gequal": lambda a, b: a >= b,
         "notequal": lambda a, b: a != b, "always": lambda a, b: True}
PLACES = {1: [(8, 8)], 2: [(12, 12), (4, 4)], 4: [(6, 2), (14, 6), (2, 10), (10, 14)],
          8: [(9, 5), (7, 11), (13, 9), (5, 3), (3, 13), (1, 7), (11, 15), (15, 1)]}  # sixteenths of a pixel


class Judge:
    def __init__(self):
        self.figures, self.failures, self.where, self.seen = 0, [], "", {}

    def same(self, what, told, expected):
        self.figures += 1
        self.seen[what] = self.seen.get(what, 0) + 1
        if told != expected:
            self.failures.append(f"{self.where}: {what} is {told}, should be {expected}")

    def near(self, what, told, expected, by):
        self.figures += 1
        self.seen[what] = self.seen.get(what, 0) + 1
        if not abs(told - expected) <= by:
            self.failures.append(f"{self.where}: {what} is {told}, should be within {by} of {expected}")


def to_number(word):
    return float.fromhex(word) if word.lstrip("+-").startswith("0x") else float(word)


class Capture:
    """Vertices, and of each primitive in program order its state and its vertices."""

    def __init__(self, text):
        self.vertices, self.primitives, self.textures, self.size = [], [], {}, (640, 480)
        state, space, texture = {}, "clip", None
        for line in text.splitlines():
            words = line.split("#")[0].split()
            if not words:
                continue
            head, rest = words[0], words[1:]
            if head == "target":
                self.size = (int(rest[0]), int(rest[1]))
            elif head == "space":
                space = rest[0]
            elif head == "state":
                state = {**state, rest[0]: rest[1:]}
            elif head == "v":
                n = [to_number(w) for w in rest]
                n += [1.0] if len(n) == 3 else []
                n += [255.0] * 4 if len(n) == 4 else []
                self.vertices.append(n)
            elif head == "texture":
                texture = self.textures[rest[0]] = {"words": rest, "texels": ""}
            elif head == "texels":
                texture["texels"] += "".join(rest)
            elif head in ("t", "l", "p"):
                count = {"t": 3, "l": 2, "p": 1}[head]
                for i in range(0, len(rest), count):
                    self.add(head, space, state, [int(w) for w in rest[i:i + count]])
            elif head in ("ts", "tf", "ls", "ll"):
                for run in " ".join(rest).split("restart"):
                    self.add_run(head, space, state, [int(w) for w in run.split()])

    def add(self, kind, space, state, indices):
        self.primitives.append({"kind": kind, "space": space, "state": state, "v": indices})

    def add_run(self, kind, space, state, v):
        n = len(v)
        if kind == "ts":
            for i in range(n - 2):
                self.add("t", space, state, [v[i], v[i + 1], v[i + 2]] if i % 2 == 0 else [v[i + 1], v[i], v[i + 2]])
        elif kind == "tf":
            for i in range(1, n - 1):
                self.add("t", space, state, [v[0], v[i], v[i + 1]])
        else:
            for i in range(n if kind == "ll" else n - 1):
                self.add("l", space, state, [v[i], v[(i + 1) % n]])


def read_npy(path):
    data = Path(path).read_bytes()
    return struct.unpack(f"<{(len(data) - 10 - struct.unpack('<H', data[8:10])[0]) // 4}I",
                         data[10 + struct.unpack("<H", data[8:10])[0]:])


def read_png(path):
    """Rows of (r, g, b)."""
    data, at, packed = Path(path).read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height = struct.unpack(">II", data[at + 8:at + 16])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, before, rows = zlib.decompress(packed), 3 * width, bytes(3 * width), []
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (line[i - 3] if i >= 3 else 0), before[i], (before[i - 3] if i >= 3 else 0)
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        before = bytes(line)
        rows.append([tuple(line[3 * x:3 * x + 3]) for x in range(width)])
    return rows


def widened(code, is_565):
    if not is_565:
        return [code >> 8 * c & 255 for c in range(4)]
    r, g, b = code >> 11 & 31, code >> 5 & 63, code & 31
    return [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2, 255]


def snapped(value, bits):
    return math.floor(Fraction(value) * 2 ** bits + Fraction(1, 2))


class Explained:
    """A pixel's history against the capture."""

    def __init__(self, judge, capture, told):
        self.j, self.capture, self.told = judge, capture, told
        config = told["config"]
        self.samples, self.is_565 = config["msaa.samples"], config["color.format"] == "rgb565"
        pattern = config["msaa.pattern"]
        if pattern == "standard":
            self.places = [(Fraction(x, 16), Fraction(y, 16)) for x, y in PLACES[self.samples]]
        else:
            self.places = [tuple(Fraction(w) for w in place.split(",")) for place in pattern.split(";")]
        bits = 0  # of the pattern, from the centre
        for x, y in self.places:
            for way in (x - Fraction(1, 2), y - Fraction(1, 2)):
                bits = max(bits, way.denominator.bit_length() - 1)
        self.s = max(1, config["subpixel.bits"], bits)
        self.given, self.depth_bits = config["subpixel.bits"], config["depth.bits"]

    def corner(self, vertex, state):
        move = 0.5 if state.get("pixel_center", ["half"])[0] == "integer" else 0.0
        x, y = vertex[0] + move, vertex[1] + move
        if state.get("origin", ["top_left"])[0] == "bottom_left":
            y = self.capture.size[1] - y
        up = 2 ** (self.s - self.given)
        return snapped(x, self.given) * up, snapped(y, self.given) * up

    def geometry(self, entry, pixel):
        j, primitive = self.j, self.capture.primitives[entry["primitive"]]
        state, model = primitive["state"], entry["model"]
        if primitive["kind"] != "t" or entry["kind"] != "triangle" or primitive["space"] != "window":
            return
        vertices = [self.capture.vertices[i] for i in primitive["v"]]
        corners = [self.corner(v, state) for v in vertices]
        if not model["corners"]:
            return
        for told, c in zip(model["corners"], corners):
            j.same("corner", (told["x"], told["y"]), c)
            j.same("corner in pixels", (told["x_pixels"], told["y_pixels"]), (c[0] / 2 ** self.s, c[1] / 2 ** self.s))
        (ax, ay), (bx, by), (cx, cy) = corners
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        j.same("area", model["area"]["value"], area)
        if area == 0:
            j.same("verdict of no area", entry["verdict"], "zero_area")
            return
        place = self.places[entry.get("sample", 0)]
        px, py = ((Fraction(pixel["x"]) + place[0]) * 2 ** self.s, (Fraction(pixel["y"]) + place[1]) * 2 ** self.s)
        weights, inside, border = [0, 0, 0], True, False
        for told in model.get("edges", []):
            (fx, fy), (tx, ty) = corners[told["from"]], corners[told["to"]]
            exact = (tx - fx) * (py - fy) - (ty - fy) * (px - fx)
            owns = ty == fy and tx > fx or ty < fy
            j.same("edge", told["exact"], exact)
            j.same("edge's side", told["side"],
                   ("top" if tx > fx else "bottom") if ty == fy else "left" if ty < fy else "right")
            j.same("who owns a tie", told["owns_ties"], owns)
            j.same("tie", told["tie"], exact == 0)
            value = math.floor((exact - (0 if owns else 1)) / 2 ** self.s)
            j.same("edge value", told["value"], value)
            digits = len(told["bits"]) - 2
            j.same("edge's bits", int(told["bits"], 16) & 15, value & 15)
            j.same("edge's digits", int(told["bits"], 16) >> 4 * digits, 0)
            j.same("edge, real", told["real"], float(exact / 4 ** self.s))
            weights[3 - told["from"] - told["to"]] = exact
            inside = inside and (exact > 0 or exact == 0 and owns)
            border = border or exact == 0
        if not model.get("edges"):
            return
        j.same("who covers", entry["oracle"]["covers"], inside)
        if border and min(weights) >= 0:
            j.same("border", entry["oracle"]["on_border"], True)
        mask = state.get("sample_mask", ["all"])[0]
        is_left_out = self.samples > 1 and mask != "all" and not int(mask, 16) >> entry.get("sample", 0) & 1
        j.same("covered", model["verdict"] in COVERED + ("scissor",), inside and not is_left_out)
        if state.get("polygon_offset", ["0", "0"]) != ["0", "0"] or "planes" not in model:
            return
        top = 2 ** self.depth_bits - 1
        codes = [snapped(Fraction(v[2]) * top, 0) for v in vertices]
        for told, code in zip(model["corners"], codes):
            j.same("corner's depth", told["codes"]["depth"], code)
        exact = Fraction(sum(w * c for w, c in zip(weights, codes)), sum(weights))
        told = entry["oracle"]["planes"]["depth"]
        j.same("exact depth", Fraction(int(told["numerator"]), int(told["denominator"])), exact)
        self.plane(entry, "depth", exact, 1)
        colors = [[snapped(Fraction(c), 0) for c in v[4:8]] for v in vertices]
        is_flat = state.get("shade", ["smooth"])[0] == "flat"
        at_sample = self.samples == 1 or model.get("shaded_at") == entry.get("sample")
        for c, name in enumerate(("red", "green", "blue", "alpha")):
            if name not in model["planes"] or not at_sample or is_flat:
                continue
            exact = Fraction(sum(w * v[c] for w, v in zip(weights, colors)), sum(weights))
            told = entry["oracle"]["planes"][name]
            j.same("exact colour", Fraction(int(told["numerator"]), int(told["denominator"])), exact)
            self.plane(entry, name, exact, 1)

    def plane(self, entry, name, exact, bound):
        j, told = self.j, entry["model"]["planes"][name]
        top = 2 ** (self.depth_bits if name == "depth" else 8) - 1
        real = Fraction(told["unrounded"], 2 ** told["fraction_bits"])
        j.same("unrounded, real", told["real"], float(real))
        j.same("rounding", told["code"], min(max(math.floor(real + Fraction(1, 2)), 0), top))
        j.near("interpolated " + name, float(real), float(exact), bound)
        parts = entry["parts"].get(name)
        if not parts:
            return
        j.near("parts", parts["snap"] + parts["interpolation"] + parts["storage"], parts["total"], 1e-9)
        golden = entry["golden"]["depth"] if name == "depth" else entry["golden"]["color"][
            ("red", "green", "blue", "alpha").index(name)]
        j.near("total of the parts", parts["total"], told["code"] - golden, 2e-6)
        j.near("storage", parts["storage"], float(told["code"] - real), 2e-6)
        j.near("interpolation", parts["interpolation"], float(real - exact), 2e-6)

    def blended(self, step, state):
        """The blended colour in real arithmetic, channel by channel."""
        s, d = [c / 255 for c in step["before"]], [c / 255 for c in step["stored"]]
        words = state["blend"]
        factors = [words[0], words[1]] + (words[2:4] if len(words) == 4 else words[:2])
        equations = (state.get("blend_equation", ["add"]) * 2)[:2]
        k = [to_number(w) / 255 for w in state.get("blend_color", ["0"] * 4)]
        result = []
        for c in range(4):
            f, g = factors[2:] if c == 3 else factors[:2]
            equation = equations[1] if c == 3 else equations[0]
            value = {"zero": 0, "one": 1, "src_alpha_saturate": 1 if c == 3 else min(s[3], 1 - d[3])}
            for name, source in (("src", s), ("dst", d), ("constant", k)):
                for what, of in (("color", source[c]), ("alpha", source[3])):
                    value[f"{name}_{what}"], value[f"one_minus_{name}_{what}"] = of, 1 - of
            a, b = (s[c], d[c]) if equation in ("min", "max") else (s[c] * value[f], d[c] * value[g])
            r = {"add": a + b, "subtract": a - b, "reverse_subtract": b - a, "min": min(a, b), "max": max(a, b)}[equation]
            result.append(255 * min(max(r, 0), 1))
        return result

    def texels(self, entry):
        """Weights sum to 1, and the texel is what they make of the texels."""
        j, surface = self.j, entry["model"].get("surface")
        if not surface or "texels" not in surface:
            return
        j.near("weights", sum(t["weight"] for t in surface["texels"]), 1, 1e-12)
        for c in range(4):
            j.near("filtered texel", surface["texel"][c], sum(t["weight"] * t["color"][c] for t in surface["texels"]), 1.01)
        words, hexes = (self.capture.textures[surface["texture"]][k] for k in ("words", "texels"))
        if words[1] != "inline" or words[2] not in ("rgba8888", "l8", "rgb565"):
            return
        digits, width = {"rgba8888": 8, "l8": 2, "rgb565": 4}[words[2]], int(words[3])
        for t in surface["texels"]:
            if t["level"] != 0:
                continue
            at = (t["y"] * width + t["x"]) * digits
            code = int(hexes[at:at + digits], 16)
            color = {"rgba8888": [code >> 24 & 255, code >> 16 & 255, code >> 8 & 255, code & 255], "l8": [code] * 3 + [255],
                     "rgb565": widened(code, True)}[words[2]]
            j.same("texel", t["color"], color)

    def operations(self, entry, stored):
        """Each test and operation from what stands before it; `stored` changes."""
        j, model = self.j, entry["model"]
        state = self.capture.primitives[entry["primitive"]]["state"] if entry["primitive"] is not None else {}
        is_triangle = entry["primitive"] is not None and self.capture.primitives[entry["primitive"]]["kind"] == "t"
        color, verdict, passes_stencil, passes_depth = None, None, True, True
        for step in model["operations"]:
            name = step["operation"]
            if name == "stencil_test":
                reference, read, value = (int(step[k], 16) for k in ("reference", "read", "stored"))
                j.same("stored stencil", value, stored["stencil"])
                passes_stencil = TESTS[step["func"]](reference & read, value & read)
                j.same("stencil test", step["passes"], passes_stencil)
            elif name == "depth_test":
                j.same("depth func", step["func"], state.get("depth_test", ["less"])[0])
                j.same("stored depth", step["stored"], stored["depth"])
                passes_depth = TESTS[step["func"]](int(step["fragment"], 16), int(step["stored"], 16))
                j.same("depth test", step["passes"], passes_depth)
            elif name == "alpha_test":
                j.same("alpha func", step["func"], state["alpha_test"][0])
                j.same("alpha test", step["passes"], TESTS[step["func"]](int(step["fragment"], 16), int(step["reference"], 16)))
                verdict = verdict if step["passes"] or not (passes_stencil and passes_depth) else "alpha"
            elif name == "alpha_to_coverage":
                drawn = math.floor(Fraction(self.samples * int(step["fragment"], 16), 255) + Fraction(1, 2))
                j.same("samples of alpha", int(step["samples_drawn"], 16), drawn)
                j.same("drawn by alpha", step["passes"], entry["sample"] < drawn)
                verdict = verdict if step["passes"] or not (passes_stencil and passes_depth) else "alpha"
            elif name == "write_stencil":
                before, after = int(step["before"], 16), int(step["after"], 16)
                j.same("stencil before", before, stored["stencil"])
                if entry["kind"] != "clear":
                    words = state["stencil"]
                    # A triangle's back may have a stencil of its own; lines and points show their front.
                    if is_triangle and entry["kind"] == "triangle" and "stencil_back" in state and \
                            state["stencil_back"][0] != "same":
                        is_ccw = model["area"]["value"] < 0
                        if is_ccw != (state.get("front", ["ccw"])[0] == "ccw"):
                            words = state["stencil_back"]
                    reference, write = int(words[1]), int(words[3])
                    op = words[4] if not passes_stencil else words[6] if passes_depth else words[5]
                    made = {"keep": before, "zero": 0, "replace": reference, "incr": min(before + 1, 255),
                            "decr": max(before - 1, 0), "invert": before ^ 255, "incr_wrap": before + 1 & 255,
                            "decr_wrap": before - 1 & 255}[op]
                    j.same("stencil after", after, before & ~write | made & write)
                stored["stencil"] = after
            elif name in ("light", "texture", "fog"):
                color = step["after"]
            elif name == "blend":
                if color:
                    j.same("colour before blending", step["before"], color)
                j.same("stored colour", step["stored"][:3], widened(int(stored["color"], 16), self.is_565)[:3])
                for c, real in enumerate(self.blended(step, state)[:3 if self.is_565 else 4]):  # 5, 6, 5 have no alpha
                    j.near("blended colour", step["after"][c], real, 0.51)
                color = step["after"]
            elif name == "pack_color":
                if color:
                    j.same("colour before packing", step["before"], color)
                if "threshold" not in step:
                    tops = ((31, 11), (63, 5), (31, 0)) if self.is_565 else ((255, 0), (255, 8), (255, 16), (255, 24))
                    code = sum(math.floor(Fraction(step["before"][c] * top, 255) + Fraction(1, 2)) << low
                               for c, (top, low) in enumerate(tops))
                    j.same("packed colour", int(step["after"], 16), code)
                packed = int(step["after"], 16)
            elif name == "logic_op":
                j.same("logic operation", step["op"], state["logic_op"][0])
                j.same("colour before the logic operation", int(step["before"], 16), packed)
                j.same("stored colour", step["stored"], stored["color"])
                s, d = packed, int(stored["color"], 16)
                made = {"clear": 0, "and": s & d, "and_reverse": s & ~d, "copy": s, "and_inverted": ~s & d, "noop": d,
                        "xor": s ^ d, "or": s | d, "nor": ~(s | d), "equiv": ~(s ^ d), "invert": ~d, "or_reverse": s | ~d,
                        "copy_inverted": ~s, "or_inverted": ~s | d, "nand": ~(s & d), "set": -1}[step["op"]]
                packed = made & (0xffff if self.is_565 else 0xffffffff)
                j.same("colour of the logic operation", int(step["after"], 16), packed)
            elif name in ("write_depth", "write_color"):
                key = name[6:]
                j.same(key + " before", step["before"], stored[key])
                if name == "write_color" and entry["kind"] != "clear":
                    mask = int(step["mask"], 16) if "mask" in step else -1
                    j.same("colour after", int(step["after"], 16), int(stored[key], 16) & ~mask | packed & mask)
                stored[key] = step["after"]
        if model["verdict"] in COVERED and entry["kind"] != "clear":
            verdict = verdict or ("stencil" if not passes_stencil else "depth" if not passes_depth else None)
            j.same("verdict", model["verdict"] if verdict or model["verdict"] != "masked" else "written",
                   verdict or "written")
        if entry["verdict"] == "written":
            stored["owner"] = entry["primitive"]

    def pixel(self, pixel, images):
        j, n = self.j, self.samples
        index = pixel["y"] * self.told["width"] + pixel["x"]
        j.where = f"pixel {pixel['x']} {pixel['y']}"
        stored, covered = None, 0
        if n > 1:
            j.same("sample places", [(s["x_pixels"], s["y_pixels"]) for s in pixel["samples"]],
                   [(float(x), float(y)) for x, y in self.places])
        for sample in range(n):
            history = [e for e in pixel["history"] if e.get("sample", 0) == sample]
            depth_digits, color_digits = len(pixel["final"]["model"]["depth"]) - 2, 4 if self.is_565 else 8
            stored = {"stencil": 0, "owner": None, "depth": images["empty_depth"].rjust(depth_digits, "0"),
                      "color": "0x0000" if self.is_565 else "0xff000000"}
            number = -1
            for entry in history:
                j.where = f"pixel {pixel['x']} {pixel['y']} primitive {entry['primitive']} sample {sample}"
                j.same("verdict's name", entry["verdict"] in VERDICTS and entry["model"]["verdict"] in VERDICTS, True)
                if entry["primitive"] is not None:
                    j.same("program order", entry["primitive"] >= number, True)
                    number = entry["primitive"]
                    self.geometry(entry, pixel)
                    self.texels(entry)
                    covered += entry["model"]["verdict"] in COVERED
                self.operations(entry, stored)
                if entry["rtl"] is not None:
                    j.same("RTL packets that differ", entry["rtl"]["differing"], 0)
                    for a, b in zip(entry["rtl"]["packets"], entry["model"]["hardware"]["packets"]):
                        j.same("RTL's packet", (a["arrow"], a["number"]), (b["arrow"], b["number"]))
                        if b["cycle"] is not None:
                            j.same("RTL's cycle", a["cycle"], b["cycle"])
            final = pixel["samples"][sample]["final"] if n > 1 else pixel["final"]
            j.where = f"pixel {pixel['x']} {pixel['y']} sample {sample}"
            for key in ("depth", "color", "stencil", "owner"):
                j.same("what is left", final["model"][key], stored[key])
                j.same("what the engine left", final["engine"][key], stored[key])
        final = pixel["final"]["model"]
        if n > 1:
            fields = ((11, 31), (5, 63), (0, 31)) if self.is_565 else ((0, 255), (8, 255), (16, 255), (24, 255))
            codes = [int(s["final"]["model"]["color"], 16) for s in pixel["samples"]]
            mean = sum((sum(c >> low & top for c in codes) + n // 2) // n << low for low, top in fields)
            j.same("mean of the samples", int(final["color"], 16), mean)
            j.same("depth of sample 0", final["depth"], pixel["samples"][0]["final"]["model"]["depth"])
        for name, (depth, ids, count, colors) in images["drawn"].items():
            told = pixel["final"]["golden"] if name == "golden" else final
            j.same(f"{name}: depth", int(told["depth"], 16), depth[index])
            j.same(f"{name}: colour", tuple(widened(int(told["color"], 16), self.is_565)[:3]), colors[pixel["y"]][pixel["x"]])
            if ids:
                owner = told["owner"]
                j.same(f"{name}: owner", -1 if owner is None else owner, ids[index] - (ids[index] >> 31 << 32))
            if count:
                golden = sum(e["golden"] is not None and "depth" in e["golden"] for e in pixel["history"])
                j.same(f"{name}: count", golden if name == "golden" else covered, count[index])
        for engine in ("hardware", "rtl"):
            told = pixel["final"][engine]
            if told:
                j.same(f"{engine}'s depth", told["depth"], final["depth"])
                j.same(f"{engine}'s colour", told["color"], final["color"])


def judge_capture(judge, program, path, options, pixels, choose, kinds):
    """Random pixels of one capture. Returns the engines that drew it."""
    has_rtl, plain = "--rtl" in options, [w for w in options if w not in ("--rtl", "--steps")]
    capture = Capture(path.read_text())
    width, height = capture.size
    with tempfile.TemporaryDirectory() as folder:
        def run(*arguments):
            return subprocess.run([program, *arguments], capture_output=True, text=True)

        drawn = {}
        for engine in ("functional", "golden", "cycle") + (("rtl",) if has_rtl else ()):
            stem = f"{folder}/{engine}"
            full = engine in ("functional", "golden")
            images = ["--ids", stem + ".ids.npy", "--count", stem + ".count.npy"] if full else []
            ran = run("render", str(path), "--engine", engine, *plain, "-o", stem + ".png", "--depth", stem + ".depth.npy",
                      *images, *(["--skip", "none"] if engine == "functional" else []))
            if ran.returncode != 0 and engine == "cycle":
                continue  # hardware does not have the scene
            if ran.returncode != 0:
                sys.exit(f"render --engine {engine}: {ran.stderr}")
            drawn[engine] = (read_npy(stem + ".depth.npy"), read_npy(stem + ".ids.npy") if full else None,
                             read_npy(stem + ".count.npy") if full else None, read_png(stem + ".png"))
        owned = [p for p, owner in enumerate(drawn["functional"][1]) if owner != 0xffffffff]
        for n in range(pixels):
            place = choose.choice(owned) if owned and n % 4 else choose.randrange(width * height)
            x, y = place % width, place // width
            judge.where = f"{path.name}, pixel {x} {y}"
            told = run("explain", str(path), str(x), str(y), *options, "--json")
            if told.returncode != 0:
                judge.failures.append(f"{judge.where}: explain ends with {told.returncode}: {told.stderr.strip()[-600:]}")
                continue
            result = json.loads(told.stdout)
            judge.same("differences", result["differences"], [])
            explained = Explained(judge, capture, result)
            digits = len(result["pixels"][0]["final"]["model"]["depth"]) - 2
            images = {"drawn": drawn, "empty_depth": "0x" + format(2 ** result["config"]["depth.bits"] - 1, f"0{digits}x")}
            for pixel in result["pixels"]:
                explained.pixel(pixel, images)
                for entry in pixel["history"]:
                    kinds[entry["verdict"]] = kinds.get(entry["verdict"], 0) + 1
        return set(drawn)


def main():
    words = sys.argv[1:]
    options = words[words.index("--") + 1:] if "--" in words else []
    words = words[:words.index("--")] if "--" in words else words
    program, path = words[0], Path(words[1])
    pixels, seed = (int(w) for w in (words[2:4] + ["20", "1"][len(words) - 2:]))
    captures = sorted(path.glob("*.hpt")) if path.is_dir() else [path]
    judge, choose, kinds, engines = Judge(), random.Random(seed), {}, set()
    for n, capture in enumerate(captures):
        share = pixels * (n + 1) // len(captures) - pixels * n // len(captures)
        engines |= judge_capture(judge, program, capture, options, share, choose, kinds)
    for failure in judge.failures[:20]:
        print(failure)
    print(f"{pixels} pixels of {len(captures)} captures, {judge.figures} figures, {len(judge.failures)} differ; images of "
          + ", ".join(sorted(engines)) + "; " + ", ".join(f"{k} {v}" for k, v in sorted(kinds.items())))
    sys.exit(1 if judge.failures or judge.figures == 0 else 0)


main()
