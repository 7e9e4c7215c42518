// The error of a pixel's coverage against the exact area for every kind of antialiasing, and the cost of a frame: time
// of the functional engine, and cycles and bytes of hardware.
//
// The hardware is the configuration's, in bins that store only colours, with clears left as flags. Several samples:
// with the unit that stores their mean (resolve.unit). Supersampling: N x N frames with one sample; the pictures that
// the host reads, and the mean that it writes, count as bytes; the host's time is not in the cycles. Smooth: with alpha
// and one lane that blends.
#pragma once

#include <gmpxx.h>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/packets/packets.hpp"
#include "model/scene.hpp"
#include "sim/study/antialiasing/supersample.hpp"

namespace halfplane::antialiasing {

/// The hardware for a kind, and the cost of a frame.
struct AreaHardware {
  Config config;
  std::uint64_t cycles = 0, bytes = 0;
};

/// One kind on one scene.
struct AreaRow {
  std::string kind;                      ///< "1 sample", "msaa 4", "supersample 2x2:rotated"; for lines "smooth" too
  int samples = 1;                       ///< sample positions of a pixel; 0: none, smooth lines use the area
  double frame_s = 0;                    ///< the median, functional engine, one thread
  double max = 0;                        ///< the largest |shown - exact|, fraction of a pixel
  double rms = 0;                        ///< over the partially covered pixels
  double mean = 0;                       ///< of shown - exact
  bool is_front = false;                 ///< no other kind is both more accurate and faster
  std::optional<AreaHardware> hardware;  ///< none: no hardware of this configuration supports it
};

struct AreaStudy {
  std::size_t edge_pixels = 0;  ///< partially covered, by the exact area
  std::vector<AreaRow> rows;
};

/// White blades on black around the centre of the target, without overlap, from a sixteenth of half a circle to almost
/// no width.
[[nodiscard]] Scene blades(int width, int height, std::uint64_t seed);

/// White lines on black as rectangles, 1 to 4 pixels wide, around the centre of the target, without overlap.
[[nodiscard]] Scene spokes(int width, int height, std::uint64_t seed);

/// Every kind: 1, 2, 4 and 8 samples, supersampling 2x2 and 4x4 in rows and rotated, and smooth for lines; as far as
/// `config` supports them. The scene has no triangles other than the rectangles', or no lines. `repeat` frames are
/// measured of each.
[[nodiscard]] AreaStudy measure_areas(const Scene& scene, const Config& config, int repeat,
                                      const std::function<void(double)>& progress);

// The exact area reference: the part of a pixel that a triangle covers, in rationals.
//
// The triangle is the snapped one. It is clipped against the four sides of the pixel, as a polygon whose corners are
// rational, and measured by the shoelace formula: no sample, no rounding, no code of the engines.

/// The area of the triangle inside pixel (x, y), 0 to 1 pixels^2. Coordinates of 2^-grid_bits pixel; either orientation.
[[nodiscard]] mpq_class covered_area(const Triangle& triangle, int x, int y, int grid_bits);

/// The sum of covered_area() over triangles in every pixel of a target, width * height, rows from the top. For disjoint
/// triangles it is their coverage of the pixel.
[[nodiscard]] std::vector<double> covered_areas(const std::vector<Triangle>& triangles, int width, int height,
                                                int grid_bits);

}  // namespace halfplane::antialiasing
