#include "constants.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "../packets/state_packets.hpp"
#include "../stages/surface.hpp"
#include "../stages/texture_packets.hpp"

namespace halfplane {

std::vector<DerivedConstant> derived_constants(const Config& config, const Widths& widths) {
  std::vector<DerivedConstant> list;
  const auto add = [&list](const char* name, long long value, const char* why) { list.push_back({name, value, why}); };
  add("GRID_BITS", widths.grid_bits, "s: fraction bits of a coordinate, at least 1");
  add("GUARD_BITS", widths.guard_bits, "G: fraction bits of a gradient per pixel");
  add("PLANE_FRACTION", widths.plane_fraction, "F = G + s");
  add("TILE_SHIFT", widths.tile_shift, "log2 of the tile size");
  add("LINE_GUARD_BITS", widths.line_guard_bits, "G': fraction bits of the planes along a line");
  add("STAMPS_PER_ROW", widths.stamps.stamps_per_row, "stamps along the side of a tile");
  add("PLANES", widths.planes, "interpolated planes: depth, the colours and planes over w");
  add("COLOR_PLANES", widths.color_planes, "planes of the stored colour: plane 1 and the next ones");
  add("AFFINE_PLANES", widths.affine_planes, "linear in the window: depth and colours, which come first");
  add("COORDINATES", widths.coordinates, "planes of texture coordinates, after the plane of 1/w");
  add("PERSPECTIVE_GUARD_BITS", kPerspectiveGuardBits, "l: fraction bits of planes over w inside a tile");
  add("COORDINATE_FRACTION", perspective_format(config).coordinate.fraction_bits, "f: of a texture coordinate, texels");
  add("COLORS_OVER_W", widths.colors_over_w, "colour planes divided by w");
  add("COLOR_NARROW_BITS", kColorNarrowBits, "mantissa bits of the reciprocal of w, for colours");
  add("NORMALS", widths.normals, "planes of normals over w; instead of colours");
  add("STATE_WORD_BITS", state_word_bits(widths), "bits of a token's value");
  add("TEXTURE_STAMPS", texture_stamps(config), "stamps between depth test and stored colours, with a texture unit");
  add("TEXTURE_PORT_BITS", 8 * widths.texture_port_bytes, "data of a beat of texels");
  add("PIXELS", widths.pixels, "pixels of a stamp");
  add("SAMPLES", widths.samples, "samples of a stamp, the samples of a pixel next to each other");
  add("TILES_X", widths.tiles_x, "tiles along the top of the widest target");
  add("TILES_Y", widths.tiles_y, "tiles along the side of the highest target");
  add("HIZ_GROUP_BITS", widths.hiz_group_bits, "bounds of 2^this tiles of a row are cleared at once");
  add("LINE_X_BITS", widths.line_x_bits, "low bits of a tile's or block's x in a cache line's number");
  add("LINE_Y_BITS", widths.line_y_bits, "likewise of its y, above the bits of x");
  add("BLOCK_SIDE", widths.blocks.side, "stamps along the side of a block");
  add("BLOCKS_PER_ROW", widths.blocks.per_tile, "blocks along the side of a tile");
  add("FLAG_WORD", widths.blocks.flag_word, "flags of cleared blocks in a word, blocks of one row");
  const MemoryGrid& memory = widths.memory;
  add("PORT_SHIFT", memory.port, "log2 of the bytes of a beat");
  add("DEPTH_SAMPLE_BYTES", 1 << memory.sample[0], "bytes of a stored depth");
  add("COLOR_SAMPLE_BYTES", 1 << memory.sample[1], "bytes of a stored colour");
  add("MEMORY_COLORS", widths.memory_colors, "colours of a stamp in memory: one a sample, or one a pixel");
  const int stamp_bytes = std::max(widths.samples << memory.sample[0], widths.memory_colors << memory.sample[1]);
  add("REQUEST_BYTES", std::max(stamp_bytes, widths.blocks.flag_word / 8),
      "data of a request, as they lie in memory: a stamp of the larger plane, or a word of flags");
  add("PLANE_SHIFT", memory.plane, "log2 of the bytes of a plane of a tile");
  add("FLAG_ROW_SHIFT", memory.flag_row, "log2 of the bytes from one row of flags to the next");
  return list;
}

std::string constant_name(std::string_view name) {
  std::string upper;
  for (const char c : name)
    upper += c == ' ' || c == '.' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

long long number_of(const Setting& setting, std::string_view value) {
  const auto name = std::ranges::find(setting.names, value);
  if (name != setting.names.end()) return name - setting.names.begin();
  return setting.is_number() ? std::stoll(std::string(value)) : 0;
}

}  // namespace halfplane
