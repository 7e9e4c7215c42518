#!/usr/bin/env python3
"""PPM (P6, 8 bits) to PNG, which `halfplane compare --against` reads. usage: ppm_to_png.py IN.ppm OUT.png"""

import pathlib
import struct
import sys
import zlib


def main():
    header, width, height, most, pixels = pathlib.Path(sys.argv[1]).read_bytes().split(maxsplit=4)
    width, height = int(width), int(height)
    pixels = pixels[-3 * width * height :] if len(pixels) >= 3 * width * height else b""
    if header != b"P6" or most != b"255" or not pixels:
        sys.exit(f"{sys.argv[1]}: no whole PPM of 8 bits")
    rows = b"".join(b"\0" + pixels[3 * width * y : 3 * width * (y + 1)] for y in range(height))
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    )
    with open(sys.argv[2], "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, data in chunks:
            file.write(struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)))


if __name__ == "__main__":
    main()
