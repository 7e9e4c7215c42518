// How far from the exact area the coverage of a pixel is by every kind of antialiasing, and what a frame of it takes: time of
// the functional engine, and cycles and bytes of hardware.
//
// The hardware is the configuration's, in bins that store colours alone, with clears that stay flags. Several samples: with the
// unit that stores their mean (resolve.unit). Supersampling: N x N frames with one sample, whose pictures the host reads, and
// the mean that it writes, are bytes too; its own time is not in the cycles. Smooth: with alpha and one lane that blends.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/study/antialiasing/supersample.hpp"

namespace halfplane::antialiasing {

/// What draws a kind, and what a frame of it takes.
struct AreaHardware {
  Config config;
  std::uint64_t cycles = 0, bytes = 0;
};

/// One kind on one scene.
struct AreaRow {
  std::string kind;                      ///< "1 sample", "msaa 4", "supersample 2x2:rotated"; of lines "smooth" too
  int samples = 1;                       ///< places of a pixel that are looked at; 0: none, smooth lines have the area
  double frame_s = 0;                    ///< the median, functional engine, one thread
  double max = 0;                        ///< the largest |shown - exact|, parts of a pixel
  double rms = 0;                        ///< over the pixels that are covered in part
  double mean = 0;                       ///< of shown - exact
  bool is_front = false;                 ///< no other kind is both nearer and faster
  std::optional<AreaHardware> hardware;  ///< none: no hardware of this configuration draws it
};

struct AreaStudy {
  std::size_t edge_pixels = 0;  ///< covered in part, by the exact area
  std::vector<AreaRow> rows;
};

/// White blades on black round the middle of the target, none over another, from half a circle's sixteenth to a hair wide.
[[nodiscard]] Scene blades(int width, int height, std::uint64_t seed);

/// White lines on black as rectangles, 1 to 4 pixels wide, round the middle of the target, none over another.
[[nodiscard]] Scene spokes(int width, int height, std::uint64_t seed);

/// Every kind: 1, 2, 4 and 8 samples, supersampling 2x2 and 4x4 in rows and turned, and smooth where there are lines; as long
/// as `config` takes them. The scene has no triangle beside those of rectangles, or no line. `repeat`
/// frames are measured of each.
[[nodiscard]] AreaStudy measure_areas(const Scene& scene, const Config& config, int repeat,
                                      const std::function<void(double)>& progress);

}  // namespace halfplane::antialiasing
