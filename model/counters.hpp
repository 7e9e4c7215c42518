// Work done and work skipped: the counts of the host's side and every engine, and the switches for skipping.
#pragma once

#include <cstdint>

#include "packets/packets.hpp"

namespace halfplane {

/// Work that an engine may skip because it cannot change the image. Each switch has a counter of the same name. An
/// engine without a way to skip some work ignores its switch.
struct Skip {
  bool frustum = true;             ///< triangles wholly outside one clip plane skip the clipper
  bool backface = true;            ///< triangles that face away skip binning and setup
  bool zero_area = true;           ///< triangles of area 0 likewise
  bool empty = true;               ///< triangles whose box holds no pixel centre likewise
  bool no_sample = true;           ///< triangles of a few pixel centres that cover none likewise
  bool objects_hiz = true;         ///< objects hidden by the depths drawn so far skip everything
  bool tiles_hiz = true;           ///< tiles hidden by the depths drawn so far skip the fine raster
  bool tiles_outside = true;       ///< tiles wholly outside one edge skip the fine raster
  bool trivially_accepted = true;  ///< tiles wholly inside all edges skip the edge tests
  bool fragments_early_z = true;   ///< fragments that fail the depth test skip the other attributes
  bool attributes = true;          ///< fragments that are overdrawn skip the other attributes
  bool clear = true;               ///< a clear is deferred until the tile is touched
  // For draws that blend, test alpha, dither or mask channels:
  bool operations_early_z = true;  ///< hidden tiles, and fragments that fail the depth test skip all operations
  bool alpha_tiles = true;         ///< tiles and triangles whose alpha all fails, or passes, skip the alpha test
  bool opaque_blends = true;       ///< triangles with an opaque source replace, without blending
  bool masked_draws = true;        ///< draws that write no channel skip colours
  // For a frame after another one:
  bool bins =
      true;  ///< bins with the same draws as in the frame before keep their pixels; none of their work is counted
  bool operator==(const Skip&) const = default;
};

/// Work done and work skipped. The JSON keys of `render` have the same names.
struct Counters {
  std::uint64_t primitives_in = 0, culled = 0, drawn = 0, clipped = 0;
  std::uint64_t covered = 0;         ///< samples that the fine raster produced; untested ones of accepted tiles too
  std::uint64_t depth_passed = 0;    ///< in program order: equal for every engine and skip setting
  std::uint64_t alpha_killed = 0;    ///< samples of these dropped by the alpha test
  std::uint64_t written = 0;         ///< samples of the rest, with depth or colour writes enabled
  std::uint64_t samples_tested = 0;  ///< samples whose edge functions were evaluated; scanline: samples visited
  std::uint64_t tiles_visited = 0;   ///< primitive-tile visits, including skipped ones
  std::uint64_t bins = 1;            ///< hardware: parts of the target that the frame is sent in
  std::uint64_t pairs = 0;           ///< hardware: triangles, lines and points sent; counted once per bin
  struct {
    std::uint64_t samples = 0, hits = 0, fills = 0;
  } texture;  ///< hardware: samples looked up in the cache, samples whose lines were all there, lines requested
  /// Skipped work, by the switch of that name.
  struct Skipped {
    std::uint64_t frustum = 0, backface = 0, zero_area = 0, empty = 0, no_sample = 0;  ///< triangles
    std::uint64_t objects_hiz = 0;                                                     ///< objects
    std::uint64_t tiles_hiz = 0, tiles_outside = 0, trivially_accepted = 0;            ///< visits of tiles
    std::uint64_t fragments_early_z = 0, attributes = 0;                               ///< fragments
    std::uint64_t clear = 0;               ///< tiles without a written pixel between two clears, or a clear and the end
    std::uint64_t operations_early_z = 0;  ///< visits of tiles in which no fragment passes; includes tiles_hiz
    std::uint64_t alpha_tiles = 0;         ///< visits of tiles in which the alpha test drops every fragment
    std::uint64_t opaque_blends = 0;       ///< fragments
    std::uint64_t masked_draws = 0;        ///< primitives
    std::uint64_t bins = 0;                ///< bins that are not empty
  } skipped;
};

/// The switches by name, as in --skip, and the work that each skips.
struct SkipName {
  const char* name;
  bool Skip::*member;
  std::uint64_t Counters::Skipped::*counter;
};
inline constexpr SkipName kSkipNames[] = {
    {"frustum", &Skip::frustum, &Counters::Skipped::frustum},
    {"backface", &Skip::backface, &Counters::Skipped::backface},
    {"zero_area", &Skip::zero_area, &Counters::Skipped::zero_area},
    {"empty", &Skip::empty, &Counters::Skipped::empty},
    {"no_sample", &Skip::no_sample, &Counters::Skipped::no_sample},
    {"objects_hiz", &Skip::objects_hiz, &Counters::Skipped::objects_hiz},
    {"tiles_hiz", &Skip::tiles_hiz, &Counters::Skipped::tiles_hiz},
    {"tiles_outside", &Skip::tiles_outside, &Counters::Skipped::tiles_outside},
    {"trivially_accepted", &Skip::trivially_accepted, &Counters::Skipped::trivially_accepted},
    {"fragments_early_z", &Skip::fragments_early_z, &Counters::Skipped::fragments_early_z},
    {"attributes", &Skip::attributes, &Counters::Skipped::attributes},
    {"clear", &Skip::clear, &Counters::Skipped::clear},
    {"operations_early_z", &Skip::operations_early_z, &Counters::Skipped::operations_early_z},
    {"alpha_tiles", &Skip::alpha_tiles, &Counters::Skipped::alpha_tiles},
    {"opaque_blends", &Skip::opaque_blends, &Counters::Skipped::opaque_blends},
    {"masked_draws", &Skip::masked_draws, &Counters::Skipped::masked_draws},
    {"bins", &Skip::bins, &Counters::Skipped::bins},
};

/// Nothing may be skipped.
[[nodiscard]] inline Skip skip_none() {
  Skip skip;
  for (const SkipName& entry : kSkipNames) skip.*entry.member = false;
  return skip;
}

/// A line at the entry of line_setup, and a point at the entry of point_raster.
struct DrawnLine {
  std::uint32_t primitive = 0;  ///< number of the input primitive, over the whole scene
  std::uint32_t draw = 0;       ///< index into Scene::commands
  SnappedVertex start, end;
  bool drops_last = false;
};
struct DrawnPoint {
  std::uint32_t primitive = 0, draw = 0;  ///< likewise
  SnappedVertex at;
  std::int32_t size = 0;  ///< side of the square, subpixels
  PointShape shape = PointShape::square;
};

}  // namespace halfplane
