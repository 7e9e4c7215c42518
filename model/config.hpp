// The ONE authored configuration. Everything else that has a width (C++ lanes, raster_pkg.sv, the table that
// `halfplane config --widths` prints) is derived from it by model/widths.hpp.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/depth_format.hpp"
#include "formats/sample_pattern.hpp"
#include "input_error.hpp"

namespace halfplane {

/// Layout of a stored colour. rgb565: R in bits 15...11. rgba8888: R in the lowest byte, so memory order is R, G, B, A.
enum class ColorFormat : int { rgb565, rgba8888 };

/// What the on-chip depth and colour RAM holds, and how it meets memory: whole tiles, a miss at a time; or blocks of 4x4
/// pixels, whose tags run ahead of the depth test.
enum class CacheKind : int { tiles, blocks };

/// What a flush leaves of cleared blocks that nothing was drawn into: their clear colour in memory, or their flags alone.
enum class FrameClears : int { resolve, flags };

/// In which order the host sends a frame's primitives: as the scene names them, or sorted by bin, a part of the target that
/// the on-chip blocks hold.
enum class FrameOrder : int { program, bins };

/// Which planes of a frame come to memory.
enum class FrameStore : int { all, color };

/// How the RTL does triangle setup: several multipliers and a triangle every few cycles, or one shared multiplier. Same bits.
enum class SetupKind : int { pipelined, serial };

/// What the RTL's texture unit can do: nothing, as it is not there; nearest texels; linear filters of four as well; levels,
/// and linear between two of them.
enum class TextureUnitKind : int { off, nearest, bilinear, trilinear };

/// Where the reciprocal of 1/w comes from, a sample a clock either way: a table and a correction, or a row of subtractions.
enum class ReciprocalKind : int { table, restoring };

/// A hardware configuration. The default is the `embedded` preset.
struct Config {
  std::string preset = "embedded";  ///< the preset the values started from
  int subpixel_bits = 4;            ///< S: fraction bits of a snapped window coordinate
  int guard_band = 2048;            ///< window coordinates lie in [-guard_band, guard_band) pixels; a power of two
  int target_width = 1920;          ///< widest target, pixels
  int target_height = 1080;         ///< highest target, pixels
  int depth_bits = 16;  ///< B: bits of the depth that is interpolated, and stored unless depth_format says otherwise
  int local_guard_bits = 6;            ///< fraction bits of a plane stepped inside one tile
  int reciprocal_extra_bits = 4;       ///< the reciprocal of the area has depth_bits + this many significant bits
  int perspective_bits = 22;           ///< N: bits of 1/w, and of what is interpolated over w
  int perspective_mantissa_bits = 18;  ///< k: bits of 1/w that a pixel's reciprocal looks at
  int perspective_colors = 0;          ///< 1: the RTL's texture unit divides colours by w as well
  ColorFormat color_format = ColorFormat::rgb565;
  int tile_size = 8;           ///< pixels along the side of a tile
  int stamp_size = 2;          ///< pixels along the side of the stamp that fine_raster tests in one clock
  int primitive_id_bits = 16;  ///< bits of the primitive number that rides in every packet key (modulo 2^bits)
  int context_slots = 4;       ///< triangles whose constants the context RAM holds at a time
  int hiz_bits = 16;           ///< bits of a tile's HiZ bound, see hiz_code_bits(); 0: no HiZ
  int hiz_lag = 16;            ///< visits behind which a HiZ update is seen, and under way at most; a power of two
  CacheKind cache_kind = CacheKind::blocks;
  int cache_lines = 256;  ///< tiles or blocks that the on-chip depth and colour RAM holds; a power of two
  int cache_queue = 32;   ///< blocks: fragments between the tags and the depth test; a power of two
  int cache_victims = 8;  ///< blocks: evicted ones that wait to be written to memory; a power of two
  FrameClears frame_clears = FrameClears::resolve;
  FrameOrder frame_order = FrameOrder::program;  ///< the host's: no matter to the RTL
  FrameStore frame_store = FrameStore::all;      ///< likewise: a bit of fast clears and flushes says it
  int memory_port_bits = 64;                     ///< data of one beat of the memory port; a power of two
  SetupKind setup_kind = SetupKind::pipelined;
  int setup_plane_clocks = 1;  ///< that the pipelined setup takes for a plane: 1, or 2 with half of the multipliers
  TextureUnitKind texture_unit = TextureUnitKind::off;
  int texture_lanes = 1;     ///< samples that go through it together: 1, or 4 of a stamp
  int texture_cache_kb = 4;  ///< texels on the chip, KB; a power of two
  int texture_ways = 1;      ///< places there in which a block of them may lie: 1 or 2
  int texture_queue = 32;    ///< samples between their coordinates and their texels; a power of two
  ReciprocalKind reciprocal_kind = ReciprocalKind::table;  ///< of the texture unit
  int alpha_units = 0;    ///< 1: alpha is interpolated whatever the format stores, and tested
  int blend_lanes = 0;    ///< samples that are blended in a clock: 0 (no unit), 1 or 4
  int dither_units = 0;   ///< 1: the RTL dithers colours of rgb565
  int fog_units = 0;      ///< 1: the RTL fogs triangles, behind its texture unit
  int shade_units = 0;    ///< 1: the RTL lights fragments, in front of its texture unit
  int stencil_bits = 0;   ///< of the stencil that is stored above each depth: 0 (none) or 8
  int line_units = 1;     ///< 1: the RTL draws lines; 0: line_raster and what joins it are left out
  int counter_units = 1;  ///< 1: the RTL counts its work; 0: its counters are left out
  int counter_bits = 32;  ///< of each of them
  int msaa_samples = 1;   ///< samples of a pixel, 1, 2, 4 or 8
  SamplePattern msaa_pattern;
  int resolve_units = 0;   ///< 1: the RTL stores the mean of a pixel's samples, as its block leaves the chip
  int compress_units = 0;  ///< 1: the RTL stores a colour a pixel of blocks whose pixels have one each
  DepthMapping depth_mapping = DepthMapping::projection;  ///< host side, but for w and log: no RTL has those
  DepthFormat depth_format;                               ///< the RTL has `plane` alone

  bool operator==(const Config&) const = default;
};

/// Throws InputError, naming `who`, for a configuration with several samples a pixel.
void require_one_sample(const Config& config, std::string_view who);

/// Throws InputError, naming `who`, for a configuration with several samples a pixel whose hardware has a unit that takes one.
void require_sampled_hardware(const Config& config, std::string_view who);

/// The highest bits of a depth code that a tile's HiZ bound keeps: hiz.bits, or all where a code has fewer; 0: no HiZ.
[[nodiscard]] constexpr int hiz_code_bits(const Config& config) { return std::min(config.hiz_bits, config.depth_bits); }

/// s: fraction bits of the grid on which snapped vertices, pixel centres and samples lie. At S = 0 coordinates are doubled, so
/// that centres are integers; where samples lie on a finer grid than vertices, those are scaled to it.
[[nodiscard]] inline int coordinate_grid_bits(const Config& config) {
  const int centres = std::max(config.subpixel_bits, 1);
  if (config.msaa_samples == 1) return centres;
  return std::max(centres, pattern_bits(resolved_pattern(config.msaa_pattern, config.msaa_samples)));
}

/// T, or where pixels have several samples T + 2: the halves of a tile's last place that the roundings of a plane's steps may
/// add up to, but for that of its anchor. T/2 pixels along x and along y; half a pixel more each, and where that ends is
/// rounded once (stages/multisample.hpp).
[[nodiscard]] constexpr int plane_roundings(const Config& config) {
  return config.tile_size + (config.msaa_samples > 1 ? 2 : 0);
}

/// One setting: its key in TOML and `--set`, its values, and how its member of Config is read and written.
struct Setting {
  std::string_view key;                      ///< "depth.bits"
  std::string unit;                          ///< "bits", "pixels", ...; of names all of them: "rgb565|rgba8888"
  std::string_view meaning;                  ///< one line for `halfplane config --list`
  int min = 0;                               ///< smallest legal value (numbers only)
  int max = 0;                               ///< largest legal value (numbers only)
  std::vector<int> values = {};              ///< the legal ones, rising; none: all from min to max (numbers only)
  std::vector<std::string_view> names = {};  ///< of an enumeration's values, in their order
  bool is_host = false;                      ///< the RTL does not depend on it
  bool may_change_pixels = true;             ///< false: it shapes time and gates, and no pixel
  std::string (*read)(const Config&, const Setting&) = nullptr;
  void (*write)(Config&, const Setting&, std::string_view) = nullptr;

  [[nodiscard]] bool is_number() const { return max > min; }
  [[nodiscard]] bool is_hardware() const { return !is_host; }
};

/// Every setting, in the order in which `config --list` prints them.
[[nodiscard]] std::span<const Setting> settings();

/// A configuration that has a name: a row of model/designs.toml.
struct Design {
  std::string_view name;   ///< "textured"
  std::string_view label;  ///< of a preset its name, of others a preset and settings: "embedded texture.unit=trilinear"
  Config config;

  [[nodiscard]] bool is_preset() const { return name == config.preset; }
};

/// All of them, the presets first.
[[nodiscard]] std::span<const Design> designs();

/// Those of the presets: tiny, small, embedded, full.
[[nodiscard]] std::span<const std::string_view> preset_names();

/// The preset of that name, or another design. Throws InputError when there is none.
[[nodiscard]] Config preset(std::string_view name);

/// A name that preset() takes, and settings that differ, with blanks between: "embedded stamp.size=4". Throws InputError.
[[nodiscard]] Config labelled(std::string_view label);

/// The value of one setting, as it is written in TOML and on the command line.
[[nodiscard]] std::string get(const Config& config, const Setting& setting);

/// The preset, and every setting that differs from it: "embedded, depth.bits=20, stamp.size=4". `separator` goes before
/// each setting.
[[nodiscard]] std::string label(const Config& config, std::string_view separator = ", ");

/// Changes one setting by key. Throws InputError for an unknown key or a value outside its range; `config` is then unchanged.
void set(Config& config, std::string_view key, std::string_view value);

/// Checks what no single range can: combinations that could overflow are refused, naming the bound. Throws InputError.
void validate(const Config& config);

}  // namespace halfplane
