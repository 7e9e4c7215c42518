// The figures of one primitive at one pixel up to its attributes: edges, tile, coverage, planes, surface; by the
// specification's own stages, with the exact answer beside them.
#pragma once

#include <memory>

#include "history.hpp"
#include "model/pipeline.hpp"

namespace halfplane::explain {

/// A triangle that the host side has left, at any pixel.
class TrianglePiece {
 public:
  /// `context` must outlive it.
  TrianglePiece(const DrawContext& context, const Widths& widths, const Triangle& triangle);
  TrianglePiece(const TrianglePiece&) = delete;  // its surface points into it
  TrianglePiece& operator=(const TrianglePiece&) = delete;

  /// An entry without operations; its specification says how far the triangle came.
  [[nodiscard]] Entry at(Pixel pixel) const;
  /// Every pixel of its box.
  [[nodiscard]] std::vector<TriangleStep> steps() const;

 private:
  [[nodiscard]] EdgeValues edges_at(Pixel pixel) const;
  [[nodiscard]] bool is_covered(Pixel pixel) const;
  [[nodiscard]] Outcome outcome_at(Pixel pixel, const EdgeValues& edges) const;
  void add_attributes(Pixel pixel, Entry& entry) const;

  const DrawContext& context_;
  const Widths& widths_;
  Triangle triangle_;
  TriangleSetup setup_;  ///< inside the rectangle that may be drawn
  TriangleSetup whole_;  ///< over the guard band
  std::array<std::size_t, 3> order_{};
  std::array<SnappedVertex, 3> corner_{};  ///< in canonical order
  exact::TriangleOracle oracle_;
  std::optional<Surface> surface_;
  std::optional<SurfaceOracle> surface_oracle_;
};

[[nodiscard]] Entry line_entry(const DrawContext& context, const Widths& widths, const LinePrimitive& line, Pixel pixel,
                               bool wants_steps);
[[nodiscard]] Entry point_entry(const Widths& widths, const PointPrimitive& point, Pixel pixel);

/// What the texture unit's memory, or none, has at a texel of level 0.
[[nodiscard]] std::optional<std::uint32_t> texel_address(const Scene& scene, const Config& config,
                                                         std::uint32_t texture, int x, int y);

}  // namespace halfplane::explain
