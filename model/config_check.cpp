// Checks that no single range of a setting can express: combinations that could overflow, or that no hardware has.
#include <algorithm>
#include <cstdio>
#include <span>
#include <string>

#include "config.hpp"
#include "widths.hpp"

namespace halfplane {
namespace {

void refuse_unless(bool holds, const std::string& message) {
  if (!holds) throw InputError("configuration refused: " + message);
}

void require_bits(const Width& width, int bits, std::string_view holder) {
  refuse_unless(width.bits <= bits, std::string(width.name) + " needs " + std::to_string(width.bits) +
                                        " bits (bound: " + std::string(width.bound) + "), but " + std::string(holder) +
                                        " has " + std::to_string(bits) +
                                        "; lower subpixel.bits, guard.band or depth.bits");
}

/// "4, 8, 16 or 32"; a longer list is given as powers.
std::string listed(std::span<const int> values) {
  if (values.size() > 6) return "a power of two";
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + std::to_string(values[i]);
  return text;
}

}  // namespace

void validate(const Config& config) {
  Config copy = config;
  for (const Setting& setting : settings()) {  // a Config built in code has not passed through set()
    if (!setting.is_number()) continue;
    const std::string value = get(config, setting);
    setting.write(copy, setting, value);
    refuse_unless(setting.values.empty() || std::ranges::count(setting.values, std::stoi(value)) == 1,
                  std::string(setting.key) + " must be " + listed(setting.values));
  }
  for (const Setting& setting : settings())
    if (!setting.needs.empty() && get(config, setting) != "0")
      for (const Need& need : setting.needs) refuse_unless(need.holds(config), std::string(need.message));
  refuse_unless(config.setup_plane_clocks == 1 || config.setup_kind == SetupKind::pipelined,
                "the clocks of the serial setup for a plane follow from the plane's bits: use setup.plane_clocks=1, or "
                "setup.kind=pipelined");
  if (config.texture_unit != TextureUnitKind::off) {
    refuse_unless(config.cache_kind == CacheKind::blocks && config.setup_kind == SetupKind::pipelined,
                  "a texture unit is downstream of the depth test of a cache of blocks, and its planes need the "
                  "pipelined setup: use "
                  "cache.kind=blocks and setup.kind=pipelined, or texture.unit=off");
    refuse_unless(config.stamp_size <= 4, "a texture unit takes stamps of at most 4x4 samples: lower stamp.size");
  }
  if (config.texture_lanes != 1) {
    refuse_unless(config.stamp_size >= 2, "texture.lanes=4 takes 2x2 samples of a stamp: raise stamp.size");
  }
  refuse_unless(
      config.texture_ways == 1 || config.texture_unit != TextureUnitKind::nearest || config.texture_lanes != 1,
      "a texture unit with one nearest texel a clock has one way: use texture.unit=bilinear or trilinear, "
      "texture.lanes=4, or texture.ways=1");
  refuse_unless(
      !packs_at_write(config) || (config.cache_kind == CacheKind::blocks && config.setup_kind == SetupKind::pipelined),
      "colours are blended and dithered where a cache of blocks writes them, by states that only the pipelined setup "
      "passes on: use cache.kind=blocks and setup.kind=pipelined, or blend.lanes=0 and dither.unit=0");
  refuse_unless(
      config.stencil_bits == 0 || (config.cache_kind == CacheKind::blocks &&
                                   config.setup_kind == SetupKind::pipelined && config.depth_bits <= 24),
      "a stencil is stored above the depth in one word of at most 32 bits, in a cache of blocks, and set by states "
      "that only the pipelined setup passes on: use cache.kind=blocks, setup.kind=pipelined and depth.bits up to "
      "24, or stencil.bits=0");
  refuse_unless(config.cache_kind == CacheKind::blocks || config.cache_lines <= 256,
                "a cache of tiles holds at most 256: lower cache.lines");
  refuse_unless(config.cache_kind == CacheKind::blocks || config.frame_order == FrameOrder::program,
                "a cache of tiles has no bins: use frame.order=program or cache.kind=blocks");
  refuse_unless(config.cache_kind == CacheKind::blocks || config.frame_store == FrameStore::all,
                "a cache of tiles stores depth and colour: use frame.store=all or cache.kind=blocks");
  refuse_unless(config.stamp_size <= config.tile_size, "a stamp must fit into a tile: stamp.size <= tile.size");
  refuse_unless(config.target_width <= config.guard_band && config.target_height <= config.guard_band,
                "the target must lie inside the guard band: target.width and target.height <= guard.band");
  refuse_unless(config.stamp_size * config.stamp_size * config.msaa_samples <= 64,
                "a stamp holds at most 64 samples, stamp.size^2 * msaa.samples: lower one of them");
  refuse_unless(config.msaa_samples > 1 || config.msaa_pattern == SamplePattern{},
                "the one sample of a pixel is its centre: raise msaa.samples, or leave msaa.pattern out");
  refuse_unless(config.resolve_units == 0 || (config.msaa_samples > 1 && config.cache_kind == CacheKind::blocks),
                "resolve.unit takes the mean of several samples in a cache of blocks: raise msaa.samples and use "
                "cache.kind=blocks, or resolve.unit=0");
  refuse_unless(
      config.resolve_units == 0 || (config.frame_order == FrameOrder::bins && config.frame_store == FrameStore::color),
      "resolve.unit makes one colour of a pixel's samples when their block is evicted, so each block is evicted once, "
      "in bins, without its depths: use frame.order=bins and frame.store=color, or resolve.unit=0");
  refuse_unless(
      config.compress_units == 0 ||
          (config.msaa_samples > 1 && config.cache_kind == CacheKind::blocks && config.resolve_units == 0),
      "compress.unit marks blocks whose pixels have one colour each, with several samples a pixel in memory and a "
      "cache of blocks: raise msaa.samples, use cache.kind=blocks and resolve.unit=0, or compress.unit=0");
  refuse_unless(config.msaa_pattern.count == 0 || config.msaa_pattern.count == config.msaa_samples,
                "msaa.pattern has " + std::to_string(config.msaa_pattern.count) + " places, but msaa.samples is " +
                    std::to_string(config.msaa_samples) + ": give as many");
  const Widths widths = derive_widths(config);
  require_bits(widths.coordinate, 32, "a packet's coordinate");
  require_bits(widths.area, 63, "a 64-bit lane");
  require_bits(widths.edge_value, 64, "a 64-bit lane");
  require_bits(widths.sample_edge, 32, "a 32-bit lane");
  for (int a = 0; a < widths.attributes.attributes; ++a) {
    const AttributeWidths& attribute = widths.attribute[static_cast<std::size_t>(a)];
    require_bits(attribute.plane, 64, "a 64-bit lane");
    require_bits(attribute.product, 127, "a 128-bit product");
  }
  const double bound = depth_error_bound(config);
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", bound);
  refuse_unless(bound <= 1.0, std::string("the depth error may reach ") + text + " LSB (bound: 1/2 + 2^-extra + (T+" +
                                  (config.msaa_samples > 1 ? "3" : "1") +
                                  ") 2^-(l+1) + 2^-5, at most 1); raise "
                                  "plane.local_guard_bits or reciprocal.extra_bits, or lower tile.size");
}

}  // namespace halfplane
