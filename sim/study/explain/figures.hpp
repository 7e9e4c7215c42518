// The figures of one primitive at one pixel up to its attributes: edges, tile, coverage, planes, surface; by the
// specification's own stages, with the exact answer beside them.
#pragma once

#include <memory>

#include "history.hpp"
#include "model/host/primitives.hpp"
#include "model/study/rules.hpp"

namespace halfplane::explain {

/// A triangle that the host side has left, at any pixel: at its centre, or at another place of it.
class TrianglePiece {
 public:
  /// `context` and `rules` must outlive it. `offset`: of the place from the centre, 2^-s pixel; none by study rules.
  TrianglePiece(const DrawContext& context, const Widths& widths, const StudyRules& rules, const Triangle& triangle,
                const SampleOffset& offset = {});
  TrianglePiece(const TrianglePiece&) = delete;  // its surface points into it
  TrianglePiece& operator=(const TrianglePiece&) = delete;

  /// An entry without operations; its specification says how far the triangle came.
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
  SampleOffset offset_;  ///< by which it has been
  TriangleSetup setup_;  ///< inside the rectangle that may be drawn
  TriangleSetup whole_;  ///< over the guard band
  std::array<std::size_t, 3> order_{};
  std::array<SnappedVertex, 3> corner_{};  ///< in canonical order
  exact::TriangleOracle oracle_;
  std::optional<Surface> surface_;
  std::optional<SurfaceOracle> surface_oracle_;
};

/// A triangle at each sample of a pixel; where a pixel has one, that is its centre.
class SampledPiece {
 public:
  SampledPiece(const DrawContext& context, const Widths& widths, const StudyRules& rules, const Triangle& triangle);

  /// An entry at a sample, likewise without operations: its depth is the sample's, its colour from where the pixel is shaded.
  [[nodiscard]] Entry at(Pixel pixel, int sample) const;
  [[nodiscard]] std::vector<TriangleStep> steps(int sample) const { return piece(sample).steps(); }

 private:
  [[nodiscard]] const TrianglePiece& piece(int place) const;
  [[nodiscard]] int shaded_at(Pixel pixel) const;

  TrianglePiece centre_;
  std::vector<std::unique_ptr<TrianglePiece>> samples_;  ///< none: a pixel has one
};

[[nodiscard]] Entry line_entry(const DrawContext& context, const Widths& widths, const LinePrimitive& line, Pixel pixel,
                               bool wants_steps);
[[nodiscard]] Entry point_entry(const Widths& widths, const PointPrimitive& point, Pixel pixel);

/// Where the texture unit's memory has a texel; none without such a unit, or where that has no levels.
[[nodiscard]] std::optional<std::uint32_t> texel_address(const Scene& scene, const Config& config,
                                                         std::uint32_t texture, int level, int x, int y);

// The operations on a fragment, one after the other, with what each finds and leaves: the table behind "colours before and
// after". The arithmetic is the model's own (model/stages/fragment_ops.hpp); what all of them leave is held against it.

/// A fragment on its way through the table.
struct FragmentAtWork {
  const DrawContext& context;
  const SurfaceFigure* surface = nullptr;  ///< what its colour is, where it is no plane's
  std::uint32_t plane_depth = 0;           ///< code of the plane
  std::array<std::uint32_t, 4>
      color{};               ///< R, G, B, A, 8 bits each: the primitive's own, then what operations make of it
  std::uint32_t depth = 0;   ///< code as it is stored
  std::uint32_t packed = 0;  ///< colour as it is stored
  Stored& stored;            ///< at its pixel
  Pixel at;
  bool is_back = false;  ///< of a triangle that shows its back
  bool passes_stencil = true, passes_depth = true;
  bool passes_alpha = true;
  std::uint32_t primitive = 0;
  std::uint32_t sample = 0;  ///< of its pixel
};

/// Runs the table. Returns what became of the fragment.
[[nodiscard]] Outcome run_operations(FragmentAtWork& fragment, std::vector<OperationStep>& steps);

}  // namespace halfplane::explain
