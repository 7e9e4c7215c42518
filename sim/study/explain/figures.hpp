// The figures of one primitive at one pixel up to its attributes: edges, tile, coverage, planes, surface; by the
// specification's own stages, with the exact values.
#pragma once

#include <memory>

#include "history.hpp"
#include "model/host/primitives.hpp"
#include "model/study/rules.hpp"
#include "sim/study/compare/surface_oracle.hpp"

namespace halfplane::explain {

/// A triangle from the host side, at any pixel: at its centre, or at another place of it.
class TrianglePiece {
 public:
  /// `context` and `rules` must outlive it. `offset`: of the place from the centre, 2^-s pixel; none by study rules.
  TrianglePiece(const DrawContext& context, const Widths& widths, const StudyRules& rules, const Triangle& triangle,
                const SampleOffset& offset = {});
  TrianglePiece(const TrianglePiece&) = delete;  // its surface points into it
  TrianglePiece& operator=(const TrianglePiece&) = delete;

  /// An entry without operations; its specification gives the triangle's progress.
  [[nodiscard]] Entry at(Pixel pixel) const;
  [[nodiscard]] bool covers(Pixel pixel) const;
  /// Planes and surface. Precondition: it covers the place.
  void add_attributes(Pixel pixel, Entry& entry) const;
  /// Every pixel of its box.
  [[nodiscard]] std::vector<TriangleStep> steps() const;

 private:
  [[nodiscard]] EdgeValues edges_at(Pixel pixel) const;
  [[nodiscard]] bool is_covered(Pixel pixel) const;
  [[nodiscard]] Outcome outcome_at(Pixel pixel, const EdgeValues& edges) const;
  [[nodiscard]] PlaneSample depth_at(int x, int y) const;

  const DrawContext& context_;
  const Widths& widths_;
  const StudyRules& rules_;
  Triangle triangle_;    ///< moved so that the place lies at the centre
  SampleOffset offset_;  ///< the displacement
  TriangleSetup setup_;  ///< inside the rectangle that may be drawn
  TriangleSetup whole_;  ///< over the guard band
  std::array<std::size_t, 3> order_{};
  std::array<SnappedVertex, 3> corner_{};  ///< in canonical order
  exact::TriangleOracle oracle_;
  std::optional<Surface> surface_;
  std::optional<SurfaceOracle> surface_oracle_;
};

/// A triangle at each sample of a pixel; with one sample, the centre.
class SampledPiece {
 public:
  SampledPiece(const DrawContext& context, const Widths& widths, const StudyRules& rules, const Triangle& triangle);

  /// An entry at a sample, likewise without operations: its depth is the sample's, its colour is from the shading
  /// place.
  [[nodiscard]] Entry at(Pixel pixel, int sample) const;
  [[nodiscard]] std::vector<TriangleStep> steps(int sample) const { return piece(sample).steps(); }

 private:
  [[nodiscard]] const TrianglePiece& piece(int place) const;
  [[nodiscard]] int shaded_at(Pixel pixel) const;

  TrianglePiece centre_;
  std::vector<std::unique_ptr<TrianglePiece>> samples_;  ///< empty: one sample per pixel
};

[[nodiscard]] Entry line_entry(const DrawContext& context, const Widths& widths, const LinePrimitive& line, Pixel pixel,
                               bool wants_steps);
[[nodiscard]] Entry point_entry(const Widths& widths, const PointPrimitive& point, Pixel pixel);

/// The address of a texel in the texture unit's memory; none without such a unit, or if it has no levels.
[[nodiscard]] std::optional<std::uint32_t> texel_address(const Scene& scene, const Config& config,
                                                         std::uint32_t texture, int level, int x, int y);

// The operations on a fragment, one after the other, with the values before and after each. The arithmetic is the
// model's own (model/stages/fragment_ops.hpp); the final values are compared with it.

/// A fragment during the operations.
struct FragmentAtWork {
  const DrawContext& context;
  const SurfaceFigure* surface = nullptr;  ///< source of its colour, if not a plane
  std::uint32_t plane_depth = 0;           ///< code of the plane
  std::array<std::uint32_t, 4>
      color{};               ///< R, G, B, A, 8 bits each: the primitive's own, then the result of operations
  std::uint32_t depth = 0;   ///< code in the stored format
  std::uint32_t packed = 0;  ///< colour in the stored format
  Stored& stored;            ///< at its pixel
  Pixel at;
  bool is_back = false;  ///< of a triangle that shows its back
  bool passes_stencil = true, passes_depth = true;
  bool passes_alpha = true;
  std::uint32_t primitive = 0;
  std::uint32_t sample = 0;  ///< in its pixel
};

/// Runs the table. Returns the fate of the fragment.
[[nodiscard]] Outcome run_operations(FragmentAtWork& fragment, std::vector<OperationStep>& steps);

}  // namespace halfplane::explain
