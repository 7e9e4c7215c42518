#include "config.hpp"

#include <charconv>
#include <type_traits>

#include "enum_names.hpp"

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

/// A number from a list of values.
template <int Config::*member>
Setting one_of(std::string_view key, std::string unit, std::string_view meaning, std::vector<int> values) {
  Setting setting = number<member>(key, std::move(unit), meaning, values.front(), values.back());
  setting.values = std::move(values);
  return setting;
}

/// A power of two between two bounds.
template <int Config::*member>
Setting powers(std::string_view key, std::string unit, std::string_view meaning, int min, int max) {
  std::vector<int> values;
  for (int value = min; value <= max; value *= 2) values.push_back(value);
  return one_of<member>(key, std::move(unit), meaning, std::move(values));
}

/// One of an enumeration's values.
template <auto member>
Setting choice(std::string_view key, std::string_view meaning) {
  using Value = std::remove_cvref_t<decltype(std::declval<Config>().*member)>;
  std::vector<std::string_view> names(kNamesOf<Value>.begin(), kNamesOf<Value>.end());
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

/// A value with its own notation.
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

Setting unnamed_at_0(Setting setting) {
  setting.is_unnamed_at_0 = true;
  return setting;
}

Setting no_pixel(Setting setting) {
  setting.may_change_pixels = false;
  return setting;
}

bool has_texture_unit(const Config& config) { return config.texture_unit != TextureUnitKind::off; }

/// Cost: what an ECP5 takes more than with the smallest value, or than with the value named second: places (LUT4),
/// multipliers, block RAMs by synth_ecp5 of Yosys 0.23, of the time of the page or ADR named; and cycles and bytes of a frame
/// of 640x480 where the key changes them. A key of the host costs nothing.
std::vector<Setting> all_settings() {
  return {
      // Cost: 8 instead of 2: 3,008 places, 16 multipliers (docs/design-space.md).
      number<&Config::subpixel_bits>("subpixel.bits", "bits", "fraction bits S of a snapped window coordinate", 0, 12),
      // Cost: 4096 instead of 2048: 412 places (docs/area.md).
      powers<&Config::guard_band>("guard.band", "pixels", "window coordinates lie in [-band, band); a power of two", 16,
                                  1 << 20),
      // Cost: 1920 instead of 960: 137 places, 16 block RAMs for flags of blocks and HiZ bounds (docs/area.md).
      number<&Config::target_width>("target.width", "pixels", "widest target", 1, 16384).ability_named("target_width"),
      // Cost: 1080 instead of 540: 124 places, 16 block RAMs (docs/area.md).
      number<&Config::target_height>("target.height", "pixels", "highest target", 1, 16384)
          .ability_named("target_height"),
      // Cost: some 110 LUT4 and as many flip-flops a bit (docs/depth.md).
      number<&Config::depth_bits>("depth.bits", "bits", "bits B of an interpolated depth, and of its stored code", 8,
                                  32),
      // Cost: 8 instead of 6: 96 places (docs/area.md).
      number<&Config::local_guard_bits>("plane.local_guard_bits", "bits",
                                        "fraction bits of a plane stepped inside one tile", 4, 12),
      // Cost: 8 instead of 4: 252 places (docs/area.md).
      number<&Config::reciprocal_extra_bits>("reciprocal.extra_bits", "bits",
                                             "significant bits of 1/area beyond depth.bits", 2, 12),
      // Cost: 22 instead of 18: 563 places, a block RAM, with a texture unit (docs/area.md).
      number<&Config::perspective_bits>("perspective.bits", "bits", "bits N of 1/w, and of what is interpolated over w",
                                        12, 26),
      // Cost: 18 instead of 14: 117 places, with a texture unit (docs/area.md).
      number<&Config::perspective_mantissa_bits>("perspective.mantissa_bits", "bits",
                                                 "bits k of 1/w that a pixel's reciprocal looks at", 8, 20),
      // Cost: 3,049 places of the texture unit (ADR 55).
      no_pixel(number<&Config::perspective_colors>(
                   "perspective.colors", "units",
                   "1: the RTL's texture unit also interpolates colours over w; 0: colours are affine in the RTL", 0, 1)
                   .ability_named("colors_over_w")
                   .only_with(has_texture_unit,
                              "colours over w are divided by the texture unit's 1/w: use texture.unit=nearest, or "
                              "perspective.colors=0")),
      // Cost: rgba8888: 674 places, 4 block RAMs, alpha included (docs/area.md).
      choice<&Config::color_format>("color.format", "layout of a stored colour"),
      // Cost: 16 instead of 8: 708 places, 16 block RAMs less, +0.1 % of cycles in a frame of `city`, -2.1 % of `teapot`;
      // cycles with 4: +2.0 %, +8.1 % (docs/area.md).
      powers<&Config::tile_size>("tile.size", "pixels", "side of a tile: 4, 8, 16 or 32", 4, 32),
      // Cost: `embedded` with 1, 2, 4: 12,689, 15,227, 28,329 places (docs/area.md).
      no_pixel(powers<&Config::stamp_size>("stamp.size", "pixels",
                                           "side of the stamp tested in one clock: 1, 2, 4 or 8", 1, 8)),
      // Cost: 16 instead of 8: 25 places, 200 flip-flops (docs/area.md).
      no_pixel(number<&Config::primitive_id_bits>("key.primitive_bits", "bits",
                                                  "bits of the primitive number in an RTL packet key", 4, 32)),
      // Cost: 8 instead of 4: 2 places; constants lie in block RAM (docs/area.md).
      no_pixel(powers<&Config::context_slots>(
          "context.slots", "slots", "triangles whose constants the context RAM holds; a power of two", 2, 64)),
      // Cost: 12: 434 places, 24 block RAMs (docs/area.md).
      no_pixel(number<&Config::hiz_bits>("hiz.bits", "bits",
                                         "bits of a tile's HiZ bound, or all of a depth code; 0: no HiZ", 0, 32)),
      // Cost: 32 instead of 16: 106 places; 4: 34 places less (docs/area.md).
      no_pixel(powers<&Config::hiz_lag>(
          "hiz.lag", "visits", "tile visits after which a HiZ update is seen, and in flight at most; a power of two", 2,
          64)),
      // Cost: blocks instead of tiles in `small`: 4,707 cells and 4 RAMs of an iCE40 (ADR 25).
      no_pixel(choice<&Config::cache_kind>("cache.kind",
                                           "what a line of the on-chip RAM is: a tile, or 4x4 pixels fetched ahead")),
      // Cost: 512 instead of 256: 88 places, 8 block RAMs (docs/design-space.md).
      no_pixel(powers<&Config::cache_lines>(
          "cache.lines", "lines", "tiles or blocks that the on-chip depth and colour RAM holds; a power of two", 1,
          4096)),
      // Cost: 64 instead of 32: 652 places less, 7 block RAMs more, which take the place of LUT RAM (docs/area.md).
      no_pixel(powers<&Config::cache_queue>(
          "cache.queue", "fragments",
          "blocks: fragments between tags and depth test, so that misses overlap; a power of two", 4, 128)),
      // Cost: 16 instead of 8: 1,152 places (docs/area.md).
      no_pixel(powers<&Config::cache_victims>("cache.victims", "blocks",
                                              "blocks: evicted blocks that wait to be written; a power of two", 2, 32)),
      // Cost: flags: 22 places less (docs/area.md).
      no_pixel(choice<&Config::frame_clears>("frame.clears",
                                             "what a flush writes of cleared blocks or tiles: colours, or flags")),
      // Cost: 128 instead of 64: 208 places (docs/area.md).
      no_pixel(powers<&Config::memory_port_bits>(
          "memory.port_bits", "bits", "data that the memory port moves in a cycle; a power of two", 16, 512)),
      no_pixel(of_host(choice<&Config::frame_order>(
          "frame.order",
          "blocks: order in which the host sends a frame: program order, or bins that fit the on-chip RAM"))),
      no_pixel(of_host(choice<&Config::frame_store>(
          "frame.store", "blocks: buffers of a frame that are written to memory; color: its depth is lost"))),
      // Cost: serial: 2,936 places and 22 multipliers less, 13 block RAMs more; 24 times the cycles in a frame of `city`, 61
      // times of `teapot` (docs/area.md).
      no_pixel(choice<&Config::setup_kind>("setup.kind", "RTL triangle setup: several multipliers, or one")),
      // Cost: 2 saves 1,414 places and 13 multipliers with a texture unit (docs/area.md).
      no_pixel(number<&Config::setup_plane_clocks>(
          "setup.plane_clocks", "clocks",
          "cycles per plane of the RTL's pipelined triangle setup: 1, or 2 with half of the multipliers", 1, 2)),
      // Cost: nearest 3,866 places, 8 multipliers, 4 block RAMs; bilinear 6,203, 20, 5; without the wider planes and
      // queues (ADR 29).
      no_pixel(choice<&Config::texture_unit>("texture.unit", "what the RTL's texture unit can do; off: it has none")
                   .ability_named("texture")),
      // Cost: 4, trilinear: 16,582 places, 69 multipliers (ADR 108).
      no_pixel(one_of<&Config::texture_lanes>(
          "texture.lanes", "pixels", "texture pixels per cycle of the RTL, each with its divider and filter: 1 or 4",
          {1, 4})),
      // Cost: 16 instead of 8: 7 places, 4 block RAMs (docs/area.md).
      no_pixel(powers<&Config::texture_cache_kb>(
          "texture.cache_kb", "KB", "texels that the texture unit holds on the chip; a power of two", 1, 64)),
      // Cost: 2: 626 places (ADR 101).
      no_pixel(number<&Config::texture_ways>(
          "texture.ways", "places",
          "places of a block in the texture cache: 1, or 2, of which the less recently used is replaced", 1, 2)),
      // Cost: 64 instead of 32: 1,471 places; -2.1 % of cycles in a frame of `ball_nearest`, none of `walk` (docs/area.md).
      no_pixel(powers<&Config::texture_queue>(
          "texture.queue", "samples", "samples that wait for their texels, so that misses overlap; a power of two", 8,
          128)),
      // Cost: restoring: 606 places more, 2 multipliers and a block RAM less (docs/area.md).
      no_pixel(
          choice<&Config::reciprocal_kind>("reciprocal.kind",
                                           "what the texture unit divides by 1/w with: a RAM and two multipliers, or "
                                           "subtractions; the same bits and time")),
      // Cost: 1,001 places less, 21 block RAMs in textured-25f (docs/area.md).
      unnamed_at_0(no_pixel(number<&Config::queue_block_rams>(
          "queue.block_ram", "units",
          "1: the RTL's queues of fragments and its contexts lie in block RAM, whose items are read later in a cycle; "
          "0: in LUT RAM where that is smaller",
          0, 1))),
      // Cost: 173 places (docs/area.md).
      unnamed_at_0(
          number<&Config::texture_constants>(
              "texture.constant", "units",
              "1: the RTL's texture unit blends with a constant colour (texture_combine blend); 0: it does not", 0, 1)
              .ability_named("texture_constant")
              .only_with(has_texture_unit,
                         "a constant colour is blended by the texels of a texture unit: use texture.unit=nearest, or "
                         "texture.constant=0")),
      // Cost: 172 places (docs/area.md).
      unnamed_at_0(
          number<&Config::texture_borders>(
              "texture.border", "units",
              "1: the RTL's texture unit has a border colour (texture_wrap border and half_border); 0: it has none", 0,
              1)
              .ability_named("texture_border")
              .only_with(
                  has_texture_unit,
                  "a border colour is a texel of a texture unit: use texture.unit=nearest, or texture.border=0")),
      // Cost: 871 places (docs/area.md).
      number<&Config::alpha_units>(
          "alpha.unit", "units",
          "1: the RTL interpolates alpha, whatever color.format keeps, and (blocks, pipelined) tests it; 0: neither", 0,
          1)
          .ability_named("alpha"),
      // Cost: 1: 1,935 places, 6 multipliers, 2 block RAMs; 4: 2,650, 24, 2 (docs/area.md).
      no_pixel(one_of<&Config::blend_lanes>(
                   "blend.lanes", "samples",
                   "samples blended per cycle by the RTL, 1 or 4; 0: neither blending nor partial color masks",
                   {0, 1, 4})
                   .ability_named("blending")),
      // Cost: 150 places in color_write (ADR 116).
      unnamed_at_0(no_pixel(
          number<&Config::logic_units>(
              "logic.unit", "units",
              "1: the RTL combines stored colours with new ones bit by bit (logic_op); 0: it does not", 0, 1)
              .ability_named("logic_op")
              .only_with(
                  [](const Config& config) { return config.blend_lanes != 0; },
                  "logic operations take the stored colours that blending reads: use blend.lanes=4, or logic.unit=0"))),
      // Cost: 61 places (docs/area.md).
      number<&Config::dither_units>("dither.unit", "units", "1: the RTL dithers colours of rgb565; 0: it rounds them",
                                    0, 1)
          .ability_named("dither"),
      // Cost: about 1,900 places, 16 multipliers, 4 block RAMs (ADR 60).
      number<&Config::fog_units>("fog.unit", "units",
                                 "1: the RTL fogs triangles, downstream of its texture unit; 0: it has no fog", 0, 1)
          .ability_named("fog")
          .that_executes({"fog", "texture.unit=nearest", true})
          .only_with(
              has_texture_unit,
              "fog reads the plane of 1/w, which only a texture unit has: use texture.unit=nearest, or fog.unit=0"),
      // Cost: 8,043 places, 22 multipliers, 2 block RAMs (ADR 99).
      number<&Config::shade_units>(
          "shade.unit", "units",
          "1: the RTL lights the fragments of shade phong, upstream of its texture unit; 0: it lights none", 0, 1)
          .ability_named("shade")
          .only_with(has_texture_unit,
                     "normals are interpolated over w from the vertex with the smallest 1/w, by planes of the texture "
                     "unit: use "
                     "texture.unit=nearest, or shade.unit=0")
          .only_with([](const Config& config) { return config.perspective_colors == 0; },
                     "fragments are lit upstream of the texture unit, which divides colours over w: use "
                     "perspective.colors=0, or shade.unit=0"),
      // Cost: 680 places, 5 block RAMs (docs/area.md).
      one_of<&Config::stencil_bits>(
          "stencil.bits", "bits",
          "bits of stencil that the RTL stores above each depth: 8, or 0 (blocks, pipelined; depth.bits up to 24)",
          {0, 8})
          .ability_named("stencil"),
      // Cost: 577 places (docs/area.md).
      no_pixel(number<&Config::line_units>("lines.unit", "units",
                                           "1: the RTL has the unit that draws lines; 0: it takes none", 0, 1)
                   .ability_named("lines")),
      // Cost: 1,570 places (docs/area.md).
      no_pixel(number<&Config::counter_units>("counters.unit", "units",
                                              "1: the RTL has performance counters; 0: it has none", 0, 1)
                   .ability_named("counters")),
      // Cost: 32 instead of 16: 768 places (docs/area.md).
      no_pixel(number<&Config::counter_bits>(
          "counters.bits", "bits",
          "bits of each performance counter of the RTL; a sticky bit shows that one has wrapped", 16, 32)),
      // Cost: 4: 9,508 places, 40 block RAMs (ADR 65).
      powers<&Config::msaa_samples>("msaa.samples", "samples",
                                    "samples of a pixel, 1, 2, 4 or 8, each with coverage, depth, stencil and colour",
                                    1, kMaxPixelSamples),
      // Cost: of four samples, the standard places instead of a grid of 2x2: 577 places (docs/area.md).
      text<&Config::msaa_pattern>(
          "msaa.pattern", "standard|<X>,<Y>;...",
          "places of a pixel's samples: those of Direct3D and Vulkan, or pixels from its upper left corner"),
      // Cost: 284 places; with four samples a quarter of the bytes of a frame in bins, and 0.41 of the cycles of `city`
      // (docs/area.md).
      number<&Config::resolve_units>("resolve.unit", "units",
                                     "1: the RTL stores the mean of a pixel's samples as its block leaves the chip, of "
                                     "frames in bins that store colours alone; 0: it stores all samples",
                                     0, 1),
      // Cost: 1,493 places, 10 block RAMs (ADR 103).
      number<&Config::compress_units>("compress.unit", "units",
                                      "1: the RTL stores one colour a pixel, not one a sample, of blocks whose pixels "
                                      "have one each, and a flag; 0: it stores all samples",
                                      0, 1),
      of_host(choice<&Config::depth_mapping>(
          "depth.mapping", "what a depth means: what the scene's projection says, or one of these (docs/depth.md)")),
      of_host(text<&Config::depth_format>("depth.format", "plane|u<b>|bins<b>|f16|f32|uf<e>.<m>",
                                          "how a depth is stored; plane: the depth.bits that are interpolated")),
  };
}

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

}  // namespace halfplane
