// Coverage of lines and points: against the exact oracle, pixel by pixel, and the golden's pixels that are so close to
// a border that the snap may decide them.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "coverage.hpp"
#include "model/engines/render.hpp"
#include "model/golden/golden.hpp"

namespace halfplane {

/// All calls of an engine's pixel tap.
class PixelLog {
 public:
  struct Pixel {
    std::uint32_t primitive;
    int y, x;
    bool operator<(const Pixel& other) const {
      return std::tie(primitive, y, x) < std::tie(other.primitive, other.y, other.x);
    }
  };

  void add(std::uint32_t primitive, int x, int y) { pixels_.push_back({primitive, y, x}); }
  /// In the order of Pixel: call once, before pixels().
  void sort();
  [[nodiscard]] const std::vector<Pixel>& pixels() const { return pixels_; }

 private:
  std::vector<Pixel> pixels_;
};

/// Compares the logged pixels of every line and point with exact::covers and the definition of a point, and adds the
/// result to `result`. A line that the engine left out completely is not found here: it is missing against U.
void check_line_coverage(const Scene& scene, const Config& config, const Rendering& rendering, const PixelLog& log,
                         OracleResult& result);

/// Marks in `near` the pixels of `wanted` whose coverage by the golden's line or point could change when its vertices
/// move by up to one snap step (2^-subpixel_bits pixels); see "Golden" in docs/spec.md.
void mark_uncertain(const golden::Outline& outline, const State& state, int subpixel_bits, const golden::Image& image,
                    const std::vector<bool>& wanted, std::vector<bool>& near);

}  // namespace halfplane
