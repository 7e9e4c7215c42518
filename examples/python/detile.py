"""The picture in a colour buffer in memory: the way of core/scan_out.sv and driver/detile.c, in Python (docs/scan-out.md)."""

import dataclasses
import re


@dataclasses.dataclass
class Layout:
    """Where colours lie. The first values are of the configuration (Layout.of_package), the others of a frame."""

    tile: int  # pixels along a tile
    block: int  # pixels along a block: a cache line; with cache.kind tiles a tile
    stamp: int  # pixels along a stamp
    colors: int  # of a pixel in memory: its samples, or 1
    color_bytes: int  # 2: rgb565, 4: rgba8888
    plane_bytes: int  # of a tile's buffer; half of the distance from one tile to the next
    flag_row_bytes: int  # from the flags of a row of blocks to those of the next
    compresses: bool = False  # compress.unit: blocks with one colour a pixel have a flag in the second half of a row
    has_flags: bool = False  # frame.clears flags: cleared blocks have a flag
    color_base: int = 0
    color_flags_base: int = 0
    row_stride: int = 0  # from one row of tiles to the next
    clear_color: int = 0  # code of the last fast clear

    @staticmethod
    def of_package(text, **others):
        """From the text of a raster_pkg.sv."""
        value = {name: int(number) for name, number in re.findall(r"localparam int (\w+) = (-?\d+);", text)}
        return Layout(
            tile=value["TILE_SIZE"], block=value["BLOCK_SIDE"] * value["STAMP_SIZE"], stamp=value["STAMP_SIZE"],
            colors=value["MEMORY_COLORS"] // value["PIXELS"], color_bytes=value["COLOR_SAMPLE_BYTES"],
            plane_bytes=1 << value["PLANE_SHIFT"], flag_row_bytes=1 << value["FLAG_ROW_SHIFT"],
            **({"compresses": value["COMPRESS_UNIT"] == 1, "has_flags": value["FRAME_CLEARS"] == 1} | others))

    def flag(self, memory, x, y, first=0):
        """The flag of the block with pixel (x, y), in a row's bytes from `first` on."""
        bit = x // self.block
        return memory[self.color_flags_base + y // self.block * self.flag_row_bytes + first + bit // 8] >> bit % 8 & 1

    def is_cleared(self, memory, x, y):
        return self.has_flags and self.flag(memory, x, y) == 1

    def has_pixel_colors(self, memory, x, y):
        return self.compresses and self.flag(memory, x, y, self.flag_row_bytes // 2) == 1

    def code(self, memory, x, y):
        """The stored code of pixel (x, y): the mean of its samples where memory has several. `memory`: bytes by address."""
        if self.is_cleared(memory, x, y):
            return self.clear_color
        colors = 1 if self.has_pixel_colors(memory, x, y) else self.colors
        in_x, in_y = x % self.tile, y % self.tile
        block = in_y // self.block * (self.tile // self.block) + in_x // self.block
        in_x, in_y = in_x % self.block, in_y % self.block
        pixel = in_y // self.stamp * (self.block // self.stamp) + in_x // self.stamp  # the stamp's number
        pixel = (pixel * self.stamp + in_y % self.stamp) * self.stamp + in_x % self.stamp
        address = (self.color_base + y // self.tile * self.row_stride + x // self.tile * 2 * self.plane_bytes +
                   block * self.block**2 * self.colors * self.color_bytes + pixel * colors * self.color_bytes)
        size = self.color_bytes
        codes = [int.from_bytes(memory[address + n * size:address + (n + 1) * size], "little") for n in range(colors)]
        return codes[0] if colors == 1 else self.mean(codes)

    def mean(self, codes):
        """Channel by channel to the nearest, halves up."""
        code = 0
        for shift, bits in ((0, 5), (5, 6), (11, 5)) if self.color_bytes == 2 else ((0, 8), (8, 8), (16, 8), (24, 8)):
            total = sum(c >> shift & (1 << bits) - 1 for c in codes)
            code |= (total + len(codes) // 2) // len(codes) << shift
        return code

    def rgb(self, code):
        """8 bits a channel; narrow channels repeat their highest bits."""
        if self.color_bytes == 4:
            return code & 255, code >> 8 & 255, code >> 16 & 255
        r, g, b = code >> 11, code >> 5 & 63, code & 31
        return r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2


def detile(memory, layout, width, height):
    """Rows from the top of (red, green, blue), 0...255. `memory`: what is indexed by addresses gives bytes."""
    return [[layout.rgb(layout.code(memory, x, y)) for x in range(width)] for y in range(height)]
