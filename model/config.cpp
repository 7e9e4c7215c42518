#include "config.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstdio>

#include "widths.hpp"

namespace halfplane {
namespace {

constexpr std::array<std::string_view, 2> kColorFormatNames{"rgb565", "rgba8888"};
constexpr std::array<std::string_view, 2> kCacheKindNames{"tiles", "blocks"};
constexpr std::array<std::string_view, 2> kFrameClearsNames{"resolve", "flags"};
constexpr std::array<std::string_view, 2> kFrameOrderNames{"program", "bins"};
constexpr std::array<std::string_view, 2> kFrameStoreNames{"all", "color"};
constexpr std::array<std::string_view, 2> kSetupKindNames{"pipelined", "serial"};
constexpr std::array<std::string_view, 4> kTextureUnitNames{"off", "nearest", "bilinear", "trilinear"};
constexpr std::array<std::string_view, 2> kReciprocalKindNames{"table", "restoring"};

const std::array kSettings{
    Setting{"subpixel.bits", "bits", "fraction bits S of a snapped window coordinate", 0, 12, &Config::subpixel_bits},
    Setting{"guard.band", "pixels", "window coordinates lie in [-band, band); a power of two", 16, 1 << 20,
            &Config::guard_band},
    Setting{"target.width", "pixels", "widest target", 1, 16384, &Config::target_width},
    Setting{"target.height", "pixels", "highest target", 1, 16384, &Config::target_height},
    Setting{"depth.bits", "bits", "bits B of an interpolated depth, and of its stored code", 8, 32,
            &Config::depth_bits},
    Setting{"plane.local_guard_bits", "bits", "fraction bits of a plane stepped inside one tile", 4, 12,
            &Config::local_guard_bits},
    Setting{"reciprocal.extra_bits", "bits", "significant bits of 1/area beyond depth.bits", 2, 12,
            &Config::reciprocal_extra_bits},
    Setting{"perspective.bits", "bits", "bits N of 1/w, and of what is interpolated over w", 12, 26,
            &Config::perspective_bits},
    Setting{"perspective.mantissa_bits", "bits", "bits k of 1/w that a pixel's reciprocal looks at", 8, 20,
            &Config::perspective_mantissa_bits},
    Setting{"perspective.colors", "units",
            "1: the RTL's texture unit also interpolates colours over w; 0: colours are affine in the RTL", 0, 1,
            &Config::perspective_colors},
    Setting{"color.format", "rgb565|rgba8888", "layout of a stored colour", 0, 0, &Config::color_format},
    Setting{"tile.size", "pixels", "side of a tile: 4, 8, 16 or 32", 4, 32, &Config::tile_size},
    Setting{"stamp.size", "pixels", "side of the stamp tested in one clock: 1, 2, 4 or 8", 1, 8, &Config::stamp_size},
    Setting{"key.primitive_bits", "bits", "bits of the primitive number in an RTL packet key", 4, 32,
            &Config::primitive_id_bits},
    Setting{"context.slots", "slots", "triangles whose constants the context RAM holds; a power of two", 2, 64,
            &Config::context_slots},
    Setting{"hiz.bits", "bits", "bits of a tile's HiZ bound, or all of a depth code; 0: no HiZ", 0, 32,
            &Config::hiz_bits},
    Setting{"hiz.lag", "visits", "tile visits behind which a HiZ update is seen, and under way at most; a power of two",
            2, 64, &Config::hiz_lag},
    Setting{"cache.kind", "tiles|blocks", "what a line of the on-chip RAM is: a tile, or 4x4 pixels fetched ahead", 0,
            0, &Config::cache_kind},
    Setting{"cache.lines", "lines", "tiles or blocks that the on-chip depth and colour RAM holds; a power of two", 1,
            4096, &Config::cache_lines},
    Setting{"cache.queue", "fragments", "blocks: between tags and depth test; a power of two", 4, 128,
            &Config::cache_queue},
    Setting{"cache.victims", "blocks", "blocks: evicted and not yet written; a power of two", 2, 32,
            &Config::cache_victims},
    Setting{"frame.clears", "resolve|flags", "what a flush writes of cleared blocks or tiles: colours, or flags", 0, 0,
            &Config::frame_clears},
    Setting{"memory.port_bits", "bits", "data that the memory port moves in a cycle; a power of two", 16, 512,
            &Config::memory_port_bits},
    Setting{"frame.order", "program|bins",
            "blocks: order in which the host sends a frame: as named, or by parts that fit the chip", 0, 0,
            &Config::frame_order},
    Setting{"frame.store", "all|color", "blocks: planes of a frame that come to memory; color: its depth is lost", 0, 0,
            &Config::frame_store},
    Setting{"setup.kind", "pipelined|serial", "RTL triangle setup: several multipliers, or one", 0, 0,
            &Config::setup_kind},
    Setting{"setup.plane_clocks", "clocks",
            "that the RTL's pipelined triangle setup takes for a plane: 1, or 2 with half of the multipliers", 1, 2,
            &Config::setup_plane_clocks},
    Setting{"texture.unit", "off|nearest|bilinear|trilinear", "what the RTL's texture unit can do; off: it has none", 0,
            0, &Config::texture_unit},
    Setting{"texture.lanes", "pixels", "that the RTL's texture unit divides, addresses and filters in a clock: 1 or 4",
            1, 4, &Config::texture_lanes},
    Setting{"texture.cache_kb", "KB", "texels that the texture unit holds on the chip; a power of two", 1, 64,
            &Config::texture_cache_kb},
    Setting{"texture.ways", "places",
            "in the texture unit's cache where a block may lie: 1, or 2, of which the one used longer ago is replaced",
            1, 2, &Config::texture_ways},
    Setting{"texture.queue", "samples",
            "between their coordinates and their texels in the texture unit; a power of two", 8, 128,
            &Config::texture_queue},
    Setting{
        "reciprocal.kind", "table|restoring",
        "what the texture unit divides by 1/w with: a RAM and two multipliers, or subtractions; the same bits and time",
        0, 0, &Config::reciprocal_kind},
    Setting{"alpha.unit", "units",
            "1: the RTL interpolates alpha, whatever color.format keeps, and (blocks, pipelined) tests it; 0: neither",
            0, 1, &Config::alpha_units},
    Setting{"blend.lanes", "samples",
            "blended in a clock by the RTL, 1 or 4; 0: it has neither blending nor partial color masks", 0, 4,
            &Config::blend_lanes},
    Setting{"dither.unit", "units", "1: the RTL dithers colours of rgb565; 0: it rounds them", 0, 1,
            &Config::dither_units},
    Setting{"fog.unit", "units", "1: the RTL fogs triangles behind its texture unit; 0: it has no fog", 0, 1,
            &Config::fog_units},
    Setting{"shade.unit", "units",
            "1: the RTL lights the fragments of shade phong in front of its texture unit; 0: it lights none", 0, 1,
            &Config::shade_units},
    Setting{
        "stencil.bits", "bits",
        "of the stencil that the RTL keeps above each stored depth: 8, or 0 (blocks, pipelined; depth.bits up to 24)",
        0, 8, &Config::stencil_bits},
    Setting{"lines.unit", "units", "1: the RTL has the unit that draws lines; 0: it takes none", 0, 1,
            &Config::line_units},
    Setting{"counters.unit", "units", "1: the RTL has performance counters; 0: it has none", 0, 1,
            &Config::counter_units},
    Setting{"counters.bits", "bits", "of a performance counter of the RTL; a sticky bit tells that one has wrapped", 16,
            32, &Config::counter_bits},
    Setting{"msaa.samples", "samples", "of a pixel, 1, 2, 4 or 8: coverage, depth, stencil and colour each", 1,
            kMaxPixelSamples, &Config::msaa_samples},
    Setting{"msaa.pattern", "standard|<X>,<Y>;...",
            "where they lie: as Direct3D and Vulkan have it, or places in pixels from the upper left corner", 0, 0,
            &Config::msaa_pattern},
    Setting{
        "resolve.unit", "units",
        "1: the RTL stores the mean of a pixel's samples as its block leaves the chip, of frames in bins that store "
        "colours alone; 0: it stores all samples",
        0, 1, &Config::resolve_units},
    Setting{"compress.unit", "units",
            "1: the RTL stores one colour a pixel, not one a sample, of blocks whose pixels have one each, and a flag; "
            "0: it stores all samples",
            0, 1, &Config::compress_units},
    Setting{"depth.mapping", "projection|std|rev|stdinf|revinf|w|log",
            "what a depth means: as the scene's projection has it, or one of these (docs/depth.md)", 0, 0,
            &Config::depth_mapping},
    Setting{"depth.format", "plane|u<b>|bins<b>|f16|f32|uf<e>.<m>",
            "how a depth is stored; plane: the depth.bits that are interpolated", 0, 0, &Config::depth_format},
};

constexpr std::array<std::string_view, 4> kPresetNames{"tiny", "small", "embedded", "full"};

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const auto name : names) text += (text.empty() ? "" : ", ") + std::string(name);
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

int parse_name(std::string_view key, std::string_view value, std::span<const std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == value) return static_cast<int>(i);
  throw InputError(std::string(key) + ": no value '" + std::string(value) + "'; give " + joined(names));
}

DepthFormat depth_format_of(std::string_view key, std::string_view value) {
  try {
    return parse_depth_format(value);
  } catch (const InputError& error) {
    throw InputError(std::string(key) + ": " + error.what());
  }
}

SamplePattern pattern_of(std::string_view key, std::string_view value) {
  try {
    return parse_sample_pattern(value);
  } catch (const InputError& error) {
    throw InputError(std::string(key) + ": " + error.what());
  }
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

std::span<const Setting> settings() { return kSettings; }

std::span<const std::string_view> preset_names() { return kPresetNames; }

Config preset(std::string_view name) {
  Config config;
  if (name == "embedded") return config;
  config.preset = name;
  if (name == "tiny") {
    config.subpixel_bits = 2;
    config.guard_band = 32;
    config.target_width = config.target_height = 16;
    config.depth_bits = 8;
    config.perspective_bits = 16;
    config.perspective_mantissa_bits = 14;
    config.stamp_size = 1;
    config.hiz_bits = 8;
    config.cache_kind = CacheKind::tiles;
    config.cache_lines = 2;
    config.memory_port_bits = 16;
    config.counter_bits = 16;  // so few that tests see one wrap
    return config;
  }
  if (name == "small") {  // what fits an FPGA without multipliers
    config.guard_band = 512;
    config.target_width = 320;
    config.target_height = 240;
    config.stamp_size = 1;
    config.primitive_id_bits = 8;
    config.context_slots = 2;
    config.hiz_bits = 8;
    config.cache_kind = CacheKind::tiles;
    config.hiz_lag = 4;  // of which its serial stages do not take more
    config.cache_lines = 4;
    config.memory_port_bits = 16;
    config.setup_kind = SetupKind::serial;
    config.line_units = 0;  // with it 60 MHz are out of reach there: docs/area.md
    config.counter_units = 0;
    return config;
  }
  if (name == "full") {
    config.subpixel_bits = 8;
    config.guard_band = 8192;
    config.target_width = config.target_height = 4096;
    config.depth_bits = 24;
    config.perspective_bits = 26;
    config.color_format = ColorFormat::rgba8888;
    config.stamp_size = 4;
    config.memory_port_bits = 512;  // a stamp of either plane
    return config;
  }
  throw InputError("no preset '" + std::string(name) + "'; the presets are " + joined(kPresetNames));
}

std::string get(const Config& config, const Setting& setting) {
  if (const auto* number = std::get_if<int Config::*>(&setting.member)) return std::to_string(config.**number);
  if (const auto* format = std::get_if<ColorFormat Config::*>(&setting.member))
    return std::string(kColorFormatNames[static_cast<std::size_t>(config.**format)]);
  if (const auto* mapping = std::get_if<DepthMapping Config::*>(&setting.member))
    return std::string(depth_mapping_names()[static_cast<std::size_t>(config.**mapping)]);
  if (const auto* stored = std::get_if<DepthFormat Config::*>(&setting.member)) return to_string(config.**stored);
  if (const auto* pattern = std::get_if<SamplePattern Config::*>(&setting.member)) return to_string(config.**pattern);
  if (const auto* cache = std::get_if<CacheKind Config::*>(&setting.member))
    return std::string(kCacheKindNames[static_cast<std::size_t>(config.**cache)]);
  if (const auto* clears = std::get_if<FrameClears Config::*>(&setting.member))
    return std::string(kFrameClearsNames[static_cast<std::size_t>(config.**clears)]);
  if (const auto* order = std::get_if<FrameOrder Config::*>(&setting.member))
    return std::string(kFrameOrderNames[static_cast<std::size_t>(config.**order)]);
  if (const auto* store = std::get_if<FrameStore Config::*>(&setting.member))
    return std::string(kFrameStoreNames[static_cast<std::size_t>(config.**store)]);
  if (const auto* kind = std::get_if<ReciprocalKind Config::*>(&setting.member))
    return std::string(kReciprocalKindNames[static_cast<std::size_t>(config.**kind)]);
  if (const auto* unit = std::get_if<TextureUnitKind Config::*>(&setting.member))
    return std::string(kTextureUnitNames[static_cast<std::size_t>(config.**unit)]);
  const auto kind = config.*std::get<SetupKind Config::*>(setting.member);
  return std::string(kSetupKindNames[static_cast<std::size_t>(kind)]);
}

std::string label(const Config& config, std::string_view separator) {
  const Config base = preset(config.preset);
  std::string text = config.preset;
  for (const Setting& setting : kSettings)
    if (get(config, setting) != get(base, setting))
      text.append(separator).append(setting.key).append(1, '=').append(get(config, setting));
  return text;
}

void set(Config& config, std::string_view key, std::string_view value) {
  for (const Setting& setting : kSettings) {
    if (setting.key != key) continue;
    if (const auto* number = std::get_if<int Config::*>(&setting.member)) {
      config.** number = parse_int(setting, value);
      return;
    }
    if (const auto* format = std::get_if<ColorFormat Config::*>(&setting.member))
      config.** format = static_cast<ColorFormat>(parse_name(key, value, kColorFormatNames));
    else if (const auto* cache = std::get_if<CacheKind Config::*>(&setting.member))
      config.** cache = static_cast<CacheKind>(parse_name(key, value, kCacheKindNames));
    else if (const auto* clears = std::get_if<FrameClears Config::*>(&setting.member))
      config.** clears = static_cast<FrameClears>(parse_name(key, value, kFrameClearsNames));
    else if (const auto* order = std::get_if<FrameOrder Config::*>(&setting.member))
      config.** order = static_cast<FrameOrder>(parse_name(key, value, kFrameOrderNames));
    else if (const auto* store = std::get_if<FrameStore Config::*>(&setting.member))
      config.** store = static_cast<FrameStore>(parse_name(key, value, kFrameStoreNames));
    else if (const auto* unit = std::get_if<TextureUnitKind Config::*>(&setting.member))
      config.** unit = static_cast<TextureUnitKind>(parse_name(key, value, kTextureUnitNames));
    else if (const auto* kind = std::get_if<ReciprocalKind Config::*>(&setting.member))
      config.** kind = static_cast<ReciprocalKind>(parse_name(key, value, kReciprocalKindNames));
    else if (const auto* mapping = std::get_if<DepthMapping Config::*>(&setting.member))
      config.** mapping = static_cast<DepthMapping>(parse_name(key, value, depth_mapping_names()));
    else if (const auto* stored = std::get_if<DepthFormat Config::*>(&setting.member))
      config.** stored = depth_format_of(key, value);
    else if (const auto* pattern = std::get_if<SamplePattern Config::*>(&setting.member))
      config.** pattern = pattern_of(key, value);
    else
      config.*std::get<SetupKind Config::*>(setting.member) =
          static_cast<SetupKind>(parse_name(key, value, kSetupKindNames));
    return;
  }
  throw InputError("no setting '" + std::string(key) + "'; `halfplane config --list` shows them all");
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
  for (const Setting& setting : kSettings)  // a Config built in code has not passed through set()
    if (const auto* number = std::get_if<int Config::*>(&setting.member))
      (void)parse_int(setting, std::to_string(config.**number));
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
