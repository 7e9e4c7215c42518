// Coverage against the exact oracle (every sample, on snapped vertices) and against the golden (per pixel, unsnapped).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "model/engines/render.hpp"
#include "model/golden/golden.hpp"

namespace halfplane {

/// All calls of an engine's coverage tap, packed: one visit is 24 bytes and a bit per sample.
class CoverageLog {
 public:
  struct Visit {
    std::uint32_t triangle;
    int tile_x, tile_y;
    std::size_t first_word;
  };

  explicit CoverageLog(int tile_size)
      : tile_size_(tile_size), words_per_tile_((static_cast<std::size_t>(tile_size * tile_size) + 63) / 64) {}

  void add(std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask);
  /// Orders the visits by triangle, tile row, tile column: call once, before visits().
  void sort();

  [[nodiscard]] const std::vector<Visit>& visits() const { return visits_; }
  [[nodiscard]] bool test(const Visit& visit, int column, int row) const;
  [[nodiscard]] std::uint64_t sample_count(const Visit& visit) const;

 private:
  int tile_size_;
  std::size_t words_per_tile_;
  std::vector<Visit> visits_;
  std::vector<std::uint64_t> words_;
};

/// A sample on which engine and oracle disagree.
struct CoverageMismatch {
  std::uint32_t triangle = 0;   ///< index into Rendering::triangles; 0 for lines and points
  std::uint32_t primitive = 0;  ///< number of the input primitive
  int x = 0, y = 0;             ///< pixels
  bool oracle_covers = false;
  int sample = 0;  ///< in its pixel
};

struct OracleResult {
  std::uint64_t samples =
      0;  ///< compared: every pixel centre in every triangle's box that the draw may touch; the band of
          ///< pixels around each line and point
  std::uint64_t mismatches = 0;  ///< disagreements, and samples outside the box or in a tile visited twice
  std::optional<CoverageMismatch> first;
};

/// Compares the logged coverage of every triangle with exact::covers by `rule`, including tiles that were never
/// visited. `logs`: of each sample of a pixel.
[[nodiscard]] OracleResult check_coverage(const Scene& scene, const Config& config, std::span<const Triangle> triangles,
                                          std::span<const CoverageLog> logs, FillRule rule = FillRule::top_left);

/// A log for each sample of a pixel.
[[nodiscard]] std::vector<CoverageLog> coverage_logs(const Config& config);

struct PixelCoverage {
  std::uint64_t missing = 0;  ///< samples that U covers and the model does not
  std::uint64_t extra = 0;    ///< samples that the model covers and U does not
  std::uint64_t near_edge =
      0;  ///< missing and extra ones at an edge of U, or where a line or point changes within a snap step
};

/// Compares counts per pixel with the golden's; needs Image::outlines.
[[nodiscard]] PixelCoverage compare_counts(const Scene& scene, std::span<const std::uint32_t> model,
                                           const golden::Image& golden, int subpixel_bits);

// Coverage of lines and points: against the exact oracle, pixel by pixel, and the golden's pixels that are so close to
// a border that the snap may decide them.

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
