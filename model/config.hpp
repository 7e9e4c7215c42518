// The ONE authored configuration. Everything else that has a width (C++ lanes, raster_pkg.sv, the table that
// `halfplane config --widths` prints) is derived from it by model/widths.hpp.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/depth_format.hpp"
#include "formats/sample_pattern.hpp"
#include "input_error.hpp"

namespace halfplane {

/// Layout of a stored colour. rgb565: R in bits 15...11. rgba8888: R in the lowest byte, so memory order is R, G, B, A.
enum class ColorFormat : int { rgb565, rgba8888 };

/// The content of the on-chip depth and colour RAM: whole tiles, with blocking misses; or blocks of 4x4 pixels, a
/// non-blocking cache whose tag lookup runs ahead of the depth test.
enum class CacheKind : int { tiles, blocks };

/// Effect of a flush on cleared blocks without draws: it writes their clear colour to memory, or only their flags.
enum class FrameClears : int { resolve, flags };

/// The order in which the host sends a frame's primitives: program order, or sorted by bin, a part of the target that
/// fits the on-chip blocks.
enum class FrameOrder : int { program, bins };

/// The buffers of a frame that are written to memory.
enum class FrameStore : int { all, color };

/// Triangle setup in the RTL: several multipliers and a triangle every few cycles, or one shared multiplier. Same bits.
enum class SetupKind : int { pipelined, serial };

/// Features of the RTL's texture unit: none, as it is absent; nearest texels; linear filters of four as well; levels,
/// and linear between two of them.
enum class TextureUnitKind : int { off, nearest, bilinear, trilinear };

/// Source of the reciprocal of 1/w, one sample per clock either way: a table and a correction, or rows of subtractions.
enum class ReciprocalKind : int { table, restoring };

/// A hardware configuration. The default is the `embedded` preset.
struct Config {
  std::string preset = "embedded";  ///< the preset the values started from
  int subpixel_bits = 4;            ///< S: fraction bits of a snapped window coordinate
  int guard_band = 2048;            ///< window coordinates lie in [-guard_band, guard_band) pixels; a power of two
  int target_width = 1920;          ///< widest target, pixels
  int target_height = 1080;         ///< highest target, pixels
  int depth_bits = 16;       ///< B: bits of the interpolated depth, and of the stored one unless depth_format differs
  int local_guard_bits = 6;  ///< fraction bits of a plane stepped inside one tile
  int reciprocal_extra_bits = 4;       ///< the reciprocal of the area has depth_bits + this many significant bits
  int perspective_bits = 22;           ///< N: bits of 1/w, and of attributes over w
  int perspective_mantissa_bits = 18;  ///< k: bits of 1/w used by a pixel's reciprocal
  int perspective_colors = 0;          ///< 1: the RTL's texture unit divides colours by w as well
  ColorFormat color_format = ColorFormat::rgb565;
  int tile_size = 8;           ///< pixels along the side of a tile
  int stamp_size = 2;          ///< pixels along the side of the stamp that fine_raster tests in one clock
  int primitive_id_bits = 16;  ///< bits of the primitive number in every packet key (modulo 2^bits)
  int context_slots = 4;       ///< triangles whose constants the context RAM holds at a time
  int hiz_bits = 16;           ///< bits of a tile's HiZ bound, see hiz_code_bits(); 0: no HiZ
  int hiz_lag = 16;            ///< visits after which a HiZ update is seen; limit of visits under way; a power of two
  CacheKind cache_kind = CacheKind::blocks;
  int cache_lines = 256;  ///< tiles or blocks in the on-chip depth and colour RAM; a power of two
  int cache_queue = 32;   ///< blocks: fragments between the tags and the depth test; a power of two
  int cache_victims = 8;  ///< blocks: evicted blocks that wait to be written to memory; a power of two
  FrameClears frame_clears = FrameClears::resolve;
  FrameOrder frame_order = FrameOrder::program;  ///< host side: the RTL does not depend on it
  FrameStore frame_store = FrameStore::all;      ///< likewise: passed in a bit of fast clears and flushes
  int memory_port_bits = 64;                     ///< data of one beat of the memory port; a power of two
  SetupKind setup_kind = SetupKind::pipelined;
  int setup_plane_clocks = 1;  ///< per plane in the pipelined setup: 1, or 2 with half of the multipliers
  TextureUnitKind texture_unit = TextureUnitKind::off;
  int texture_lanes = 1;     ///< samples that go together: 1, or 4 of a stamp
  int texture_cache_kb = 4;  ///< texels on the chip, KB; a power of two
  int texture_ways = 1;      ///< places in the cache for a block: 1 or 2
  int texture_queue = 32;    ///< samples between their coordinates and their texels; a power of two
  ReciprocalKind reciprocal_kind = ReciprocalKind::table;  ///< of the texture unit
  int queue_block_rams = 0;                                ///< 1: fragments that wait, and contexts, lie in block RAM
  int texture_constants = 0;                               ///< 1: the RTL's texture unit blends with a constant colour
  int texture_borders = 0;                                 ///< 1: the RTL's texture unit has a border colour
  int alpha_units = 0;    ///< 1: alpha is interpolated for any stored format, and tested
  int blend_lanes = 0;    ///< samples blended per clock: 0 (no unit), 1 or 4
  int dither_units = 0;   ///< 1: the RTL dithers colours of rgb565
  int logic_units = 0;    ///< 1: the RTL combines stored codes with new ones bit by bit
  int fog_units = 0;      ///< 1: the RTL fogs triangles, downstream of its texture unit
  int shade_units = 0;    ///< 1: the RTL lights fragments, upstream of its texture unit
  int stencil_bits = 0;   ///< bits of the stencil stored above each depth: 0 (none) or 8
  int line_units = 1;     ///< 1: the RTL draws lines; 0: no line_raster and its join
  int counter_units = 1;  ///< 1: the RTL counts its work; 0: no counters
  int counter_bits = 32;  ///< bits of each counter
  int msaa_samples = 1;   ///< samples of a pixel, 1, 2, 4 or 8
  SamplePattern msaa_pattern;
  int resolve_units = 0;   ///< 1: the RTL stores the mean of a pixel's samples when its block is evicted
  int compress_units = 0;  ///< 1: the RTL stores blocks of uniform pixels with one colour per pixel
  DepthMapping depth_mapping = DepthMapping::projection;  ///< host side, except for w and log, which no RTL has
  DepthFormat depth_format;                               ///< the RTL has only `plane`

  bool operator==(const Config&) const = default;
};

/// Throws InputError, naming `who`, for a configuration with several samples per pixel.
void require_one_sample(const Config& config, std::string_view who);

/// Throws InputError, naming `who`, for a configuration with several samples a pixel whose hardware has a unit for one
/// sample per pixel.
void require_sampled_hardware(const Config& config, std::string_view who);

/// The highest bits of a depth code that a tile's HiZ bound keeps: hiz.bits, or all bits of a shorter code; 0: no HiZ.
[[nodiscard]] constexpr int hiz_code_bits(const Config& config) { return std::min(config.hiz_bits, config.depth_bits); }

/// s: fraction bits of the grid on which snapped vertices, pixel centres and samples lie. At S = 0 coordinates are
/// doubled, so that centres are integers; where samples lie on a finer grid than vertices, vertices are scaled to it.
[[nodiscard]] inline int coordinate_grid_bits(const Config& config) {
  const int centres = std::max(config.subpixel_bits, 1);
  if (config.msaa_samples == 1) return centres;
  return std::max(centres, pattern_bits(resolved_pattern(config.msaa_pattern, config.msaa_samples)));
}

/// T, or with several samples per pixel T + 2: bound on the roundings of a plane's steps, in halves of a tile's last
/// place, without that of its anchor. T/2 pixels along x and along y; with several samples half a pixel more each, and
/// one final rounding (stages/multisample.hpp).
[[nodiscard]] constexpr int plane_roundings(const Config& config) {
  return config.tile_size + (config.msaa_samples > 1 ? 2 : 0);
}

/// What the hardware of a unit builds on.
struct Need {
  bool (*holds)(const Config&);
  std::string_view message;  ///< what the unit takes from the other one, and what to write instead
};

/// The draw state that a unit in the stream of stamps executes, where a triangle's colours are written.
struct ExecutedState {
  std::string_view name;  ///< in the table of draw states; empty: none
  std::string_view with;  ///< what the unit takes, for a message: "texture.unit=nearest"
  bool reads_w = false;   ///< the plane of 1/w, which a triangle has once
};

/// One setting: its key in TOML and `--set`, its values, and access to its member of Config.
struct Setting {
  std::string_view key;                      ///< "depth.bits"
  std::string unit;                          ///< "bits", "pixels", ...; for an enumeration its names: "rgb565|rgba8888"
  std::string_view meaning;                  ///< one line for `halfplane config --list`
  int min = 0;                               ///< smallest legal value (numbers only)
  int max = 0;                               ///< largest legal value (numbers only)
  std::vector<int> values = {};              ///< the legal values, ascending; empty: all from min to max (numbers only)
  std::vector<std::string_view> names = {};  ///< names of an enumeration's values, in order
  bool is_host = false;                      ///< the RTL does not depend on it
  bool may_change_pixels = true;             ///< false: it affects time and area only
  std::string_view ability = {};             ///< name among a design's abilities, where more is better; empty: none
  std::vector<Need> needs = {};              ///< what must hold unless its value is 0
  ExecutedState executed = {};               ///< by the unit that this setting counts
  bool is_unnamed_at_0 = false;              ///< at 0 it is no part of CONFIG_ID: IDs are older than the setting
  std::string (*read)(const Config&, const Setting&) = nullptr;
  void (*write)(Config&, const Setting&, std::string_view) = nullptr;

  [[nodiscard]] Setting ability_named(std::string_view name) && {
    ability = name;
    return std::move(*this);
  }
  [[nodiscard]] Setting only_with(bool (*holds)(const Config&), std::string_view message) && {
    needs.push_back({holds, message});
    return std::move(*this);
  }
  [[nodiscard]] Setting that_executes(ExecutedState state) && {
    executed = state;
    return std::move(*this);
  }
  [[nodiscard]] bool is_number() const { return max > min; }
  [[nodiscard]] bool is_hardware() const { return !is_host; }
};

/// Every setting, in the order in which `config --list` prints them.
[[nodiscard]] std::span<const Setting> settings();

/// A named configuration: a row of model/designs.toml.
struct Design {
  std::string_view name;   ///< "textured"
  std::string_view label;  ///< name of a preset; otherwise a preset and settings: "embedded texture.unit=trilinear"
  Config config;

  [[nodiscard]] bool is_preset() const { return name == config.preset; }
};

/// All named configurations, the presets first.
[[nodiscard]] std::span<const Design> designs();

/// The names of the presets: tiny, small, embedded, full.
[[nodiscard]] std::span<const std::string_view> preset_names();

/// The preset or other design with that name. Throws InputError when there is none.
[[nodiscard]] Config preset(std::string_view name);

/// A name for preset(), and settings that differ, separated by blanks: "embedded stamp.size=4". Throws InputError.
[[nodiscard]] Config labelled(std::string_view label);

/// The value of one setting, as written in TOML and on the command line.
[[nodiscard]] std::string get(const Config& config, const Setting& setting);

/// The preset, and every setting that differs from it: "embedded, depth.bits=20, stamp.size=4". `separator` goes before
/// each setting.
[[nodiscard]] std::string label(const Config& config, std::string_view separator = ", ");

/// Changes one setting by key. Throws InputError for an unknown key or a value outside its range; `config` is then unchanged.
void set(Config& config, std::string_view key, std::string_view value);

/// Checks combinations of settings: those that could overflow are refused, naming the bound. Throws InputError.
void validate(const Config& config);

}  // namespace halfplane
