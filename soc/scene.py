#!/usr/bin/env python3
"""The scene of the system: a teapot on a textured floor in a frame of lines, seen from a camera that turns round it.

It is an OBJ file, which `halfplane convert --transform s15.16` projects, and a C header with the same numbers in s15.16
for the firmware.

usage: scene.py HALFPLANE FOLDER [screen]    writes scene.obj, scene.mtl, floor.png, scene.h and cameras.txt, a camera a frame
screen: for a board's: larger, and its cameras once around, again and again
"""

import math
import pathlib
import struct
import subprocess
import sys
import zlib

WIDTH, HEIGHT, FRAMES = 96, 72, 3
SEGMENTS = 2  # segments of a patch of the teapot along a side
CLEAR = (20, 20, 30)
FOV, NEAR, FAR, DISTANCE, UP = 45, 1, 16, 5, 1.75
REACH = 1.75  # half a side of the frame
FLOOR, REPEATS = -0.75, 3  # height of the floor; times that the texture lies along a side of it
TEXELS = 16  # along a side of the texture


def teapot(halfplane):
    """Places in units of 1/4096, colours, triangles; from a picture of it in parallel projection."""
    camera = "eye=0,0,20;target=0,0,0;up=0,1,0;ortho=8;near=1;far=41"
    text = subprocess.run(
        [halfplane, "convert", f"teapot:{SEGMENTS}", "--size", "64x64", "--camera", camera, "-o", "-", "--quiet"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    vertices, triangles = [], []
    for line in text.splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            x, y, z, _, *color = map(float, words[1:9])
            place = (4 * x, 4 * y, -20 * z - 1)
            vertices.append((tuple(round(4096 * c) for c in place), tuple(round(c) for c in color[:3])))
        elif words[:1] == ["t"]:
            triangles += map(int, words[1:])
    return vertices, triangles


def texel(x, y):
    """Row 0 is the one of v = 0."""
    return (230, 200 - 6 * x, 60 + 8 * y) if (x // 4 + y // 4) % 2 else (40, 90, 180)


def png():
    """The texture as an image, whose first row is the top: v = 1."""
    rows = b"".join(b"\0" + bytes(c for x in range(TEXELS) for c in texel(x, y)) for y in reversed(range(TEXELS)))
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", TEXELS, TEXELS, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks
    )


def fixed(value):
    """The nearest s15.16, halves up."""
    return math.floor(value * 65536 + 0.5)


def subtract(a, b):
    return [p - q for p, q in zip(a, b)]


def normalized(a):
    length = math.sqrt(sum(c * c for c in a))
    return [c / length for c in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def view_matrix(eye):
    back = normalized(eye)
    right = normalized(cross([0, 1, 0], back))
    rows = [right, cross(back, right), back]
    return [c for row in rows for c in (*row, -sum(a * b for a, b in zip(row, eye)))] + [0, 0, 0, 1]


def projection_matrix():
    scale = 1 / math.tan(FOV * math.pi / 360)
    return [
        scale / (WIDTH / HEIGHT),
        0,
        0,
        0,
        0,
        scale,
        0,
        0,
        0,
        0,
        -(FAR + NEAR) / (FAR - NEAR),
        -2 * FAR * NEAR / (FAR - NEAR),
        0,
        0,
        -1,
        0,
    ]


def main():
    halfplane, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    vertices, triangles = teapot(halfplane)
    first = len(vertices)
    side = round(4096 * REACH)
    for corner in range(8):
        place = tuple(side if corner >> axis & 1 else -side for axis in range(3))
        vertices.append((place, (255, 255 if corner & 1 else 0, 64)))
    lines = [first + c for a in range(8) for axis in range(3) if not a >> axis & 1 for c in (a, a | 1 << axis)]
    floor = len(vertices)
    corners = [(-1, -1), (-1, 1), (1, 1), (1, -1)]
    vertices += [((x * side, round(4096 * FLOOR), z * side), (255, 255, 255)) for x, z in corners]
    coordinates = [(REPEATS * (x > 0), REPEATS * (z > 0)) for x, z in corners]
    faces = [0, 1, 2, 0, 2, 3]
    width, height, angles = WIDTH, HEIGHT, (0.3, 1.1, 1.9)[:FRAMES]
    if sys.argv[3:] == ["screen"]:
        width, height, angles = 640, 480, [2 * math.pi * n / 64 for n in range(64)]
    eyes = [(DISTANCE * math.sin(angle), UP, DISTANCE * math.cos(angle)) for angle in angles]
    eyes = [tuple(round(c * 4096) / 4096 for c in eye) for eye in eyes]

    obj = [f"v {' '.join(str(c / 4096) for c in place)} {' '.join(map(str, color))}" for place, color in vertices]
    obj += [f"vt {u} {v}" for u, v in coordinates]
    obj += ["mtllib scene.mtl", "usemtl floor"]
    obj += ["f " + " ".join(f"{floor + c + 1}/{c + 1}" for c in face) for face in zip(*[iter(faces)] * 3)]
    obj += ["usemtl plain"]
    obj += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in zip(*[iter(triangles)] * 3)]
    obj += [f"l {a + 1} {b + 1}" for a, b in zip(*[iter(lines)] * 2)]
    (folder / "scene.obj").write_text("\n".join(obj) + "\n")
    (folder / "scene.mtl").write_text("newmtl floor\nKd 1 1 1\nmap_Kd floor.png\nnewmtl plain\nKd 1 1 1\n")
    (folder / "floor.png").write_bytes(png())
    cameras = [f"eye={','.join(map(str, eye))};target=0,0,0;up=0,1,0;fov={FOV};near={NEAR};far={FAR}" for eye in eyes]
    (folder / "cameras.txt").write_text("\n".join(cameras) + "\n")

    def table(kind, name, values, rows=""):
        return f"static const {kind} {name}{rows}[] = {{{', '.join(map(str, values))}}};\n"

    (folder / "scene.h").write_text(
        "/* Generated by soc/scene.py. */\n"
        f"#define SCENE_WIDTH {width}\n#define SCENE_HEIGHT {height}\n#define SCENE_FRAMES {len(eyes)}\n"
        f"#define SCENE_IS_ENDLESS {int(width != WIDTH)}\n"
        f"#define SCENE_CLEAR HP_RGBA{(*CLEAR, 255)}\n"
        f"#define SCENE_LOG2_TEXELS {TEXELS.bit_length() - 1}\n#define SCENE_FLOOR {len(faces)}\n"
        f"#define SCENE_TRIANGLES {len(triangles)}\n#define SCENE_LINES {len(lines)}\n"
        + table("hp_fixed", "scene_position", [16 * c for place, _ in vertices for c in place])
        + table("uint32_t", "scene_color", [f"HP_RGBA({r}, {g}, {b}, 255)" for _, (r, g, b) in vertices])
        + table(
            "hp_fixed",
            "scene_texcoord",
            [65536 * c for n in range(len(vertices)) for c in (coordinates[n - floor] if n >= floor else (0, 0))],
        )
        + table("uint16_t", "scene_floor", [floor + c for c in faces])
        + table(
            "uint8_t",
            "scene_texels",
            [c for y in range(TEXELS) for x in range(TEXELS) for c in (255, *reversed(texel(x, y)))],
        )  # A lowest
        + table("uint16_t", "scene_triangles", triangles)
        + table("uint16_t", "scene_lines", lines)
        + table("hp_fixed", "scene_projection", map(fixed, projection_matrix()))
        + "static const hp_fixed scene_view[][16] = {"
        + ", ".join("{" + ", ".join(str(fixed(c)) for c in view_matrix(eye)) + "}" for eye in eyes)
        + "};\n"
    )


if __name__ == "__main__":
    main()
