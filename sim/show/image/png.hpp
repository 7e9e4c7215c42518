// PNG files: 8-bit RGB for pictures, 16-bit grey for depth.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/show/image/picture.hpp"

namespace halfplane {

/// The bytes of an opaque 8-bit RGB PNG. Throws InputError for an empty picture or one beyond 2 GB.
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Picture& picture);

/// The bytes of a 16-bit greyscale PNG: width * height samples, row 0 at the top, values unscaled and without gamma.
[[nodiscard]] std::vector<std::uint8_t> encode_png_grey16(int width, int height,
                                                          std::span<const std::uint16_t> samples);

/// Writes the file completely or not at all. Throws InputError naming path and reason.
void write_png(const std::string& path, const Picture& picture);

}  // namespace halfplane
