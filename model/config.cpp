#include "config.hpp"

#include <bit>
#include <charconv>
#include <cstdio>

#include "widths.hpp"

namespace halfplane {
namespace {

std::string joined(std::span<const std::string_view> names, std::string_view separator) {
  std::string text;
  for (const auto name : names) text.append(text.empty() ? "" : separator).append(name);
  return text;
}

int parse_int(const Setting& setting, std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string range = std::to_string(setting.min) + "..." + std::to_string(setting.max);
  if (error == std::errc::invalid_argument || end != text.data() + text.size())
    throw InputError(std::string(setting.key) + ": '" + std::string(text) + "' is not a whole number; give " + range);
  if (error == std::errc::result_out_of_range || value < setting.min || value > setting.max)
    throw InputError(std::string(setting.key) + ": " + std::string(text) + " is outside its range; give " + range);
  return value;
}

std::size_t parse_name(const Setting& setting, std::string_view text) {
  const auto name = std::ranges::find(setting.names, text);
  if (name != setting.names.end()) return static_cast<std::size_t>(name - setting.names.begin());
  throw InputError(std::string(setting.key) + ": no value '" + std::string(text) + "'; give " +
                   joined(setting.names, ", "));
}

void parse_text(std::string_view text, DepthFormat& format) { format = parse_depth_format(text); }
void parse_text(std::string_view text, SamplePattern& pattern) { pattern = parse_sample_pattern(text); }

template <int Config::*member>
Setting number(std::string_view key, std::string unit, std::string_view meaning, int min, int max) {
  return {.key = key,
          .unit = std::move(unit),
          .meaning = meaning,
          .min = min,
          .max = max,
          .read = [](const Config& config, const Setting&) { return std::to_string(config.*member); },
          .write = [](Config& config, const Setting& setting,
                      std::string_view text) { config.*member = parse_int(setting, text); }};
}

/// One of an enumeration's values.
template <auto member>
Setting choice(std::string_view key, std::vector<std::string_view> names, std::string_view meaning) {
  return {.key = key,
          .unit = joined(names, "|"),
          .meaning = meaning,
          .names = std::move(names),
          .read =
              [](const Config& config, const Setting& setting) {
                return std::string(setting.names[static_cast<std::size_t>(config.*member)]);
              },
          .write =
              [](Config& config, const Setting& setting, std::string_view text) {
                auto& value = config.*member;
                value = static_cast<std::remove_reference_t<decltype(value)>>(parse_name(setting, text));
              }};
}

/// What has a notation of its own.
template <auto member>
Setting text(std::string_view key, std::string unit, std::string_view meaning) {
  return {.key = key,
          .unit = std::move(unit),
          .meaning = meaning,
          .read = [](const Config& config, const Setting&) { return to_string(config.*member); },
          .write =
              [](Config& config, const Setting& setting, std::string_view text) {
                try {
                  parse_text(text, config.*member);
                } catch (const InputError& error) {
                  throw InputError(std::string(setting.key) + ": " + error.what());
                }
              }};
}

Setting of_host(Setting setting) {
  setting.is_host = true;
  return setting;
}

std::vector<Setting> all_settings() {
  return {
      number<&Config::subpixel_bits>("subpixel.bits", "bits", "fraction bits S of a snapped window coordinate", 0, 12),
      number<&Config::guard_band>("guard.band", "pixels", "window coordinates lie in [-band, band); a power of two", 16,
                                  1 << 20),
      number<&Config::target_width>("target.width", "pixels", "widest target", 1, 16384),
      number<&Config::target_height>("target.height", "pixels", "highest target", 1, 16384),
      number<&Config::depth_bits>("depth.bits", "bits", "bits B of an interpolated depth, and of its stored code", 8,
                                  32),
      number<&Config::local_guard_bits>("plane.local_guard_bits", "bits",
                                        "fraction bits of a plane stepped inside one tile", 4, 12),
      number<&Config::reciprocal_extra_bits>("reciprocal.extra_bits", "bits",
                                             "significant bits of 1/area beyond depth.bits", 2, 12),
      number<&Config::perspective_bits>("perspective.bits", "bits", "bits N of 1/w, and of what is interpolated over w",
                                        12, 26),
      number<&Config::perspective_mantissa_bits>("perspective.mantissa_bits", "bits",
                                                 "bits k of 1/w that a pixel's reciprocal looks at", 8, 20),
      number<&Config::perspective_colors>(
          "perspective.colors", "units",
          "1: the RTL's texture unit also interpolates colours over w; 0: colours are affine in the RTL", 0, 1),
      choice<&Config::color_format>("color.format", {"rgb565", "rgba8888"}, "layout of a stored colour"),
      number<&Config::tile_size>("tile.size", "pixels", "side of a tile: 4, 8, 16 or 32", 4, 32),
      number<&Config::stamp_size>("stamp.size", "pixels", "side of the stamp tested in one clock: 1, 2, 4 or 8", 1, 8),
      number<&Config::primitive_id_bits>("key.primitive_bits", "bits",
                                         "bits of the primitive number in an RTL packet key", 4, 32),
      number<&Config::context_slots>("context.slots", "slots",
                                     "triangles whose constants the context RAM holds; a power of two", 2, 64),
      number<&Config::hiz_bits>("hiz.bits", "bits", "bits of a tile's HiZ bound, or all of a depth code; 0: no HiZ", 0,
                                32),
      number<&Config::hiz_lag>("hiz.lag", "visits",
                               "tile visits behind which a HiZ update is seen, and under way at most; a power of two",
                               2, 64),
      choice<&Config::cache_kind>("cache.kind", {"tiles", "blocks"},
                                  "what a line of the on-chip RAM is: a tile, or 4x4 pixels fetched ahead"),
      number<&Config::cache_lines>("cache.lines", "lines",
                                   "tiles or blocks that the on-chip depth and colour RAM holds; a power of two", 1,
                                   4096),
      number<&Config::cache_queue>("cache.queue", "fragments", "blocks: between tags and depth test; a power of two", 4,
                                   128),
      number<&Config::cache_victims>("cache.victims", "blocks", "blocks: evicted and not yet written; a power of two",
                                     2, 32),
      choice<&Config::frame_clears>("frame.clears", {"resolve", "flags"},
                                    "what a flush writes of cleared blocks or tiles: colours, or flags"),
      number<&Config::memory_port_bits>("memory.port_bits", "bits",
                                        "data that the memory port moves in a cycle; a power of two", 16, 512),
      of_host(choice<&Config::frame_order>(
          "frame.order", {"program", "bins"},
          "blocks: order in which the host sends a frame: as named, or by parts that fit the chip")),
      of_host(choice<&Config::frame_store>("frame.store", {"all", "color"},
                                           "blocks: planes of a frame that come to memory; color: its depth is lost")),
      choice<&Config::setup_kind>("setup.kind", {"pipelined", "serial"},
                                  "RTL triangle setup: several multipliers, or one"),
      number<&Config::setup_plane_clocks>(
          "setup.plane_clocks", "clocks",
          "that the RTL's pipelined triangle setup takes for a plane: 1, or 2 with half of the multipliers", 1, 2),
      choice<&Config::texture_unit>("texture.unit", {"off", "nearest", "bilinear", "trilinear"},
                                    "what the RTL's texture unit can do; off: it has none"),
      number<&Config::texture_lanes>("texture.lanes", "pixels",
                                     "that the RTL's texture unit divides, addresses and filters in a clock: 1 or 4", 1,
                                     4),
      number<&Config::texture_cache_kb>("texture.cache_kb", "KB",
                                        "texels that the texture unit holds on the chip; a power of two", 1, 64),
      number<&Config::texture_ways>(
          "texture.ways", "places",
          "in the texture unit's cache where a block may lie: 1, or 2, of which the one used longer ago is replaced", 1,
          2),
      number<&Config::texture_queue>("texture.queue", "samples",
                                     "between their coordinates and their texels in the texture unit; a power of two",
                                     8, 128),
      choice<&Config::reciprocal_kind>("reciprocal.kind", {"table", "restoring"},
                                       "what the texture unit divides by 1/w with: a RAM and two multipliers, or "
                                       "subtractions; the same bits and time"),
      number<&Config::alpha_units>(
          "alpha.unit", "units",
          "1: the RTL interpolates alpha, whatever color.format keeps, and (blocks, pipelined) tests it; 0: neither", 0,
          1),
      number<&Config::blend_lanes>(
          "blend.lanes", "samples",
          "blended in a clock by the RTL, 1 or 4; 0: it has neither blending nor partial color masks", 0, 4),
      number<&Config::dither_units>("dither.unit", "units", "1: the RTL dithers colours of rgb565; 0: it rounds them",
                                    0, 1),
      number<&Config::fog_units>("fog.unit", "units",
                                 "1: the RTL fogs triangles behind its texture unit; 0: it has no fog", 0, 1),
      number<&Config::shade_units>(
          "shade.unit", "units",
          "1: the RTL lights the fragments of shade phong in front of its texture unit; 0: it lights none", 0, 1),
      number<&Config::stencil_bits>(
          "stencil.bits", "bits",
          "of the stencil that the RTL keeps above each stored depth: 8, or 0 (blocks, pipelined; depth.bits up to 24)",
          0, 8),
      number<&Config::line_units>("lines.unit", "units", "1: the RTL has the unit that draws lines; 0: it takes none",
                                  0, 1),
      number<&Config::counter_units>("counters.unit", "units", "1: the RTL has performance counters; 0: it has none", 0,
                                     1),
      number<&Config::counter_bits>("counters.bits", "bits",
                                    "of a performance counter of the RTL; a sticky bit tells that one has wrapped", 16,
                                    32),
      number<&Config::msaa_samples>("msaa.samples", "samples",
                                    "of a pixel, 1, 2, 4 or 8: coverage, depth, stencil and colour each", 1,
                                    kMaxPixelSamples),
      text<&Config::msaa_pattern>(
          "msaa.pattern", "standard|<X>,<Y>;...",
          "where they lie: as Direct3D and Vulkan have it, or places in pixels from the upper left corner"),
      number<&Config::resolve_units>("resolve.unit", "units",
                                     "1: the RTL stores the mean of a pixel's samples as its block leaves the chip, of "
                                     "frames in bins that store colours alone; 0: it stores all samples",
                                     0, 1),
      number<&Config::compress_units>("compress.unit", "units",
                                      "1: the RTL stores one colour a pixel, not one a sample, of blocks whose pixels "
                                      "have one each, and a flag; 0: it stores all samples",
                                      0, 1),
      of_host(choice<&Config::depth_mapping>(
          "depth.mapping", {depth_mapping_names().begin(), depth_mapping_names().end()},
          "what a depth means: as the scene's projection has it, or one of these (docs/depth.md)")),
      of_host(text<&Config::depth_format>("depth.format", "plane|u<b>|bins<b>|f16|f32|uf<e>.<m>",
                                          "how a depth is stored; plane: the depth.bits that are interpolated")),
  };
}

void refuse_unless(bool holds, const std::string& message) {
  if (!holds) throw InputError("configuration refused: " + message);
}

void require_bits(const Width& width, int bits, std::string_view holder) {
  refuse_unless(width.bits <= bits, std::string(width.name) + " needs " + std::to_string(width.bits) +
                                        " bits (bound: " + std::string(width.bound) + "), but " + std::string(holder) +
                                        " has " + std::to_string(bits) +
                                        "; lower subpixel.bits, guard.band or depth.bits");
}

bool is_power_of_two(int value) { return std::has_single_bit(static_cast<unsigned>(value)); }

}  // namespace

std::span<const Setting> settings() {
  static const std::vector<Setting> all = all_settings();
  return all;
}

std::string get(const Config& config, const Setting& setting) { return setting.read(config, setting); }

std::string label(const Config& config, std::string_view separator) {
  const Config base = preset(config.preset);
  std::string text = config.preset;
  for (const Setting& setting : settings())
    if (get(config, setting) != get(base, setting))
      text.append(separator).append(setting.key).append(1, '=').append(get(config, setting));
  return text;
}

void set(Config& config, std::string_view key, std::string_view value) {
  const auto setting = std::ranges::find(settings(), key, &Setting::key);
  if (setting == settings().end())
    throw InputError("no setting '" + std::string(key) + "'; `halfplane config --list` shows them all");
  setting->write(config, *setting, value);
}

void require_one_sample(const Config& config, std::string_view who) {
  if (config.msaa_samples != 1)
    throw InputError("msaa.samples: " + std::string(who) +
                     " has one sample a pixel; use msaa.samples=1, or the functional, scalar or golden engine");
}

void require_sampled_hardware(const Config& config, std::string_view who) {
  if (config.msaa_samples == 1) return;
  if (config.setup_kind == SetupKind::serial)
    throw InputError(
        "msaa.samples: " + std::string(who) +
        " has one sample a pixel with setup.kind=serial; use msaa.samples=1 or setup.kind=pipelined, or the "
        "functional, scalar or golden engine");
}

void validate(const Config& config) {
  for (const Setting& setting : settings())  // a Config built in code has not passed through set()
    if (setting.is_number()) (void)parse_int(setting, get(config, setting));
  refuse_unless(is_power_of_two(config.guard_band), "guard.band must be a power of two");
  refuse_unless(is_power_of_two(config.tile_size), "tile.size must be 4, 8, 16 or 32");
  refuse_unless(is_power_of_two(config.stamp_size), "stamp.size must be 1, 2, 4 or 8");
  refuse_unless(is_power_of_two(config.context_slots), "context.slots must be a power of two");
  refuse_unless(is_power_of_two(config.hiz_lag), "hiz.lag must be a power of two");
  refuse_unless(is_power_of_two(config.cache_lines), "cache.lines must be a power of two");
  refuse_unless(is_power_of_two(config.cache_queue), "cache.queue must be a power of two");
  refuse_unless(is_power_of_two(config.cache_victims), "cache.victims must be a power of two");
  refuse_unless(is_power_of_two(config.memory_port_bits), "memory.port_bits must be 16, 32, 64, 128, 256 or 512");
  refuse_unless(is_power_of_two(config.texture_cache_kb), "texture.cache_kb must be a power of two");
  refuse_unless(is_power_of_two(config.texture_queue), "texture.queue must be a power of two");
  refuse_unless(config.setup_plane_clocks == 1 || config.setup_kind == SetupKind::pipelined,
                "the serial setup takes as many clocks for a plane as its bits want: use setup.plane_clocks=1, or "
                "setup.kind=pipelined");
  if (config.texture_unit != TextureUnitKind::off) {
    refuse_unless(config.cache_kind == CacheKind::blocks && config.setup_kind == SetupKind::pipelined,
                  "a texture unit stands behind the depth test of blocks, and its planes want the pipelined setup: use "
                  "cache.kind=blocks and setup.kind=pipelined, or texture.unit=off");
    refuse_unless(config.stamp_size <= 4, "a texture unit takes stamps of at most 4x4 samples: lower stamp.size");
  }
  refuse_unless(config.texture_lanes == 1 || config.texture_lanes == 4, "texture.lanes must be 1 or 4");
  if (config.texture_lanes != 1) {
    refuse_unless(config.stamp_size >= 2, "four lanes of a texture unit take 2x2 samples of a stamp: raise stamp.size");
  }
  refuse_unless(
      config.texture_ways == 1 || config.texture_unit != TextureUnitKind::nearest || config.texture_lanes != 1,
      "a texture unit with one nearest texel a clock has one way: use texture.unit=bilinear or trilinear, "
      "texture.lanes=4, or texture.ways=1");
  refuse_unless(config.fog_units == 0 || config.texture_unit != TextureUnitKind::off,
                "fog looks at the plane of 1/w, which a texture unit brings: use texture.unit=nearest, or fog.unit=0");
  refuse_unless(config.shade_units == 0 || config.texture_unit != TextureUnitKind::off,
                "normals lie over w and start where 1/w is smallest, which a texture unit's planes say: use "
                "texture.unit=nearest, or shade.unit=0");
  refuse_unless(config.shade_units == 0 || config.perspective_colors == 0,
                "fragments are lit in front of the texture unit, which divides colours over w: use "
                "perspective.colors=0, or shade.unit=0");
  refuse_unless(config.perspective_colors == 0 || config.texture_unit != TextureUnitKind::off,
                "colours over w are divided by the texture unit's 1/w: use texture.unit=nearest, or "
                "perspective.colors=0");
  refuse_unless(config.blend_lanes == 0 || config.blend_lanes == 1 || config.blend_lanes == 4,
                "blend.lanes must be 0, 1 or 4");
  refuse_unless(
      !packs_at_write(config) || (config.cache_kind == CacheKind::blocks && config.setup_kind == SetupKind::pipelined),
      "colours are blended and dithered where the framebuffer of blocks writes them, by states that the pipelined "
      "setup lets through: use cache.kind=blocks and setup.kind=pipelined, or blend.lanes=0 and dither.unit=0");
  refuse_unless(config.stencil_bits == 0 || config.stencil_bits == 8, "stencil.bits must be 0 or 8");
  refuse_unless(
      config.stencil_bits == 0 || (config.cache_kind == CacheKind::blocks &&
                                   config.setup_kind == SetupKind::pipelined && config.depth_bits <= 24),
      "a stencil stands above the depth in one word of 32 bits at most, in the framebuffer of blocks, by states "
      "that the pipelined setup lets through: use cache.kind=blocks, setup.kind=pipelined and depth.bits up to "
      "24, or stencil.bits=0");
  refuse_unless(config.cache_kind == CacheKind::blocks || config.cache_lines <= 256,
                "a cache of tiles holds at most 256: lower cache.lines");
  refuse_unless(config.cache_kind == CacheKind::blocks || config.frame_order == FrameOrder::program,
                "a cache of tiles has no bins: use frame.order=program or cache.kind=blocks");
  refuse_unless(config.cache_kind == CacheKind::blocks || config.frame_store == FrameStore::all,
                "a cache of tiles stores both planes: use frame.store=all or cache.kind=blocks");
  refuse_unless(config.stamp_size <= config.tile_size, "a stamp must fit into a tile: stamp.size <= tile.size");
  refuse_unless(config.target_width <= config.guard_band && config.target_height <= config.guard_band,
                "the target must lie inside the guard band: target.width and target.height <= guard.band");
  refuse_unless(is_power_of_two(config.msaa_samples), "msaa.samples must be 1, 2, 4 or 8");
  refuse_unless(config.stamp_size * config.stamp_size * config.msaa_samples <= 64,
                "a stamp holds at most 64 samples, stamp.size^2 * msaa.samples: lower one of them");
  refuse_unless(config.msaa_samples > 1 || config.msaa_pattern == SamplePattern{},
                "the one sample of a pixel is its centre: raise msaa.samples, or leave msaa.pattern out");
  refuse_unless(config.resolve_units == 0 || (config.msaa_samples > 1 && config.cache_kind == CacheKind::blocks),
                "a mean is taken of several samples, in the framebuffer of blocks: raise msaa.samples and use "
                "cache.kind=blocks, or resolve.unit=0");
  refuse_unless(
      config.resolve_units == 0 || (config.frame_order == FrameOrder::bins && config.frame_store == FrameStore::color),
      "a pixel's samples become one colour as their block leaves the chip, so they must leave it once, in bins, "
      "and without their depths: use frame.order=bins and frame.store=color, or resolve.unit=0");
  refuse_unless(
      config.compress_units == 0 ||
          (config.msaa_samples > 1 && config.cache_kind == CacheKind::blocks && config.resolve_units == 0),
      "blocks whose pixels have one colour are told from others where pixels have several samples in memory, in the "
      "framebuffer of blocks: raise msaa.samples, use cache.kind=blocks and resolve.unit=0, or compress.unit=0");
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
