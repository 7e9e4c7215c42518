// halfplane_detile against the specification: memory after a flush of the hardware model is the picture of the
// scalar engine, in configurations of every layout.
#include "driver/detile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "frame_memory.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::test {
namespace {

const char* const kConfigs[] = {
    "embedded",
    "embedded frame.clears=flags",
    "embedded stamp.size=1 tile.size=16 memory.port_bits=16 frame.clears=flags",
    "embedded stamp.size=4 tile.size=4 memory.port_bits=512",
    "embedded color.format=rgba8888 stamp.size=8 memory.port_bits=512 frame.clears=flags",
    "embedded msaa.samples=2",
    "embedded msaa.samples=8 compress.unit=1 memory.port_bits=16 frame.clears=flags",
    "small",
    "small frame.clears=flags",
    "tiny",
    "tiny frame.clears=flags",
    "full",
    "full frame.clears=flags",
    "sampled",
    "sampled frame.clears=flags",
    "resolved",
    "resolved frame.clears=flags",
};

halfplane_layout layout_for(const Config& config, const TileMemory& memory) {
  const Widths w = derive_widths(config);
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
  halfplane_layout layout{};
  layout.tile = byte(config.tile_size);
  layout.block = byte(w.blocks.side * config.stamp_size);
  layout.stamp = byte(config.stamp_size);
  layout.colors = byte(w.memory_colors / w.pixels);
  layout.color_bytes = byte(1 << w.memory.sample[1]);
  layout.compresses = byte(config.compress_units);
  layout.has_flags = config.frame_clears == FrameClears::flags ? 1 : 0;
  layout.plane_bytes = std::uint32_t{1} << w.memory.plane;
  layout.flag_row_bytes = std::uint32_t{1} << w.memory.flag_row;
  layout.color_base = memory.layout().color_base;
  layout.color_flags_base = memory.layout().color_flags_base;
  layout.row_stride = memory.layout().row_stride;
  layout.clear_color = memory.clear_value(true);
  return layout;
}

std::vector<std::uint8_t> bytes_of(const TileMemory& memory) {
  std::vector<std::uint8_t> bytes(memory.pages() * TileMemory::kPage);
  for (std::size_t n = 0; n < memory.pages(); ++n)
    std::ranges::copy(memory.page(n), bytes.begin() + static_cast<std::ptrdiff_t>(n * TileMemory::kPage));
  return bytes;
}

TEST(Detile, GivesThePictureOfTheSpecificationInEveryLayoutAndFormat) {
  for (const char* const label : kConfigs)
    for (const std::uint64_t seed : {1U, 2U}) {
      SCOPED_TRACE(std::string(label) + ", seed " + std::to_string(seed));
      const Config config = labelled(label);
      Scene scene = random_scene(config, seed, 60);
      scene.width = std::min(scene.width, 101);  // no multiple of a tile
      scene.height = std::min(scene.height, 75);
      const TileMemory memory = memory_after(scene, config);
      const Picture picture = picture_of(scene, config);
      const std::vector<std::uint8_t> bytes = bytes_of(memory);
      const halfplane_layout layout = layout_for(config, memory);
      const auto width = static_cast<std::uint32_t>(scene.width), height = static_cast<std::uint32_t>(scene.height);
      const std::size_t pixels = std::size_t{width} * height;
      std::vector<std::uint8_t> rgb(3 * pixels), word(4 * pixels), narrow(2 * pixels);
      halfplane_detile(bytes.data(), &layout, width, height, rgb.data(), HALFPLANE_OUT_RGB888);
      ASSERT_EQ(rgb, picture.rgb);
      halfplane_detile(bytes.data(), &layout, width, height, word.data(), HALFPLANE_OUT_XRGB8888);
      halfplane_detile(bytes.data(), &layout, width, height, narrow.data(), HALFPLANE_OUT_RGB565);
      for (std::size_t p = 0; p < pixels; ++p) {
        const unsigned r = rgb[3 * p], g = rgb[3 * p + 1], b = rgb[3 * p + 2];
        ASSERT_EQ(word[4 * p] | word[4 * p + 1] << 8 | word[4 * p + 2] << 16 | word[4 * p + 3] << 24,
                  static_cast<int>(r << 16 | g << 8 | b));
        ASSERT_EQ(static_cast<unsigned>(narrow[2 * p] | narrow[2 * p + 1] << 8), r >> 3 << 11 | g >> 2 << 5 | b >> 3);
      }
    }
}

}  // namespace
}  // namespace halfplane::test
