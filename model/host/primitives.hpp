// The host's side of the pipeline (pipeline_graph.hpp): one primitive of a scene to what goes into the hardware, or into an
// engine that does what the hardware does.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "../counters.hpp"
#include "../scene.hpp"
#include "../stages/cull.hpp"
#include "../stages/depth_encode.hpp"
#include "../stages/fog.hpp"
#include "../stages/fragment_ops.hpp"
#include "../stages/phong.hpp"
#include "clip.hpp"
#include "line_setup.hpp"
#include "point_raster.hpp"
#include "primitive_assembly.hpp"
#include "viewport.hpp"

namespace halfplane {

/// What a draw needs that does not change from one triangle to the next.
struct DrawContext {
  const Scene& scene;
  const Config& config;
  const std::shared_ptr<const State> state_of_rectangles;  ///< of a draw of rectangles
  const State& state;                                      ///< of the draw, or that one
  const Draw& draw;
  std::uint32_t command = 0;  ///< index of the draw in Scene::commands
  Viewport viewport;
  Rect rect;    ///< pixels that the draw may touch
  double band;  ///< where the sides of the guard band cut, pixels on either side of 0; of rectangles with room for them
  ClipPlanes guard_band, view_volume;
  ClipPlanes
      frustum;  ///< the view volume and a pixel around it: what is outside of this snaps to no pixel of the viewport
  DepthEncode depth_encode;
  FragmentOps fragment_ops;
  std::shared_ptr<const FogTable> fog;      ///< none: no fog
  std::shared_ptr<const PhongLight> phong;  ///< none: colours are not lit by fragments

  DrawContext(const Scene& scene_, const Config& config_, const Draw& draw_, std::uint32_t command_);
};

/// Throws InputError for a triangle with a vertex that is not in front of the eye, as only window space can give one: its
/// attributes cannot be divided by w.
void require_positive_w(const DrawContext& context, const Triangle& triangle);

/// A vertex that several triangles share is projected once.
class VertexCache {
 public:
  struct Entry {
    SnappedVertex snapped;         ///< valid when outside_guard_band == 0
    unsigned outside_frustum = 0;  ///< outcode against DrawContext::frustum
    unsigned outside_guard_band = 0;
    std::uint32_t state = ~0U;  ///< state that the entry was made with
  };
  /// `vertices` of the scene; 0: remembers the last three alone, for callers to whom sharing is no matter.
  explicit VertexCache(std::size_t vertices) : entries_(vertices == 0 ? 3 : vertices), is_ring_(vertices == 0) {}
  [[nodiscard]] const Entry& get(const DrawContext& context, std::uint32_t index);

 private:
  std::vector<Entry> entries_;
  bool is_ring_;
  std::size_t next_ = 0;
};

/// The host side of one input triangle: clip, viewport, cull. Appends what is left of it to `out`: nothing, the triangle,
/// or the fan of its clipped polygon. Counts into `counters`.
void geometry(const DrawContext& context, VertexCache& cache, std::array<std::uint32_t, 3> index,
              std::uint32_t primitive, const Skip& skip, Counters& counters, std::vector<Triangle>& out);

/// The same for hardware that culls by itself: a triangle that needs no cut is appended as it was named, whatever its
/// area, facing and box; of a clipped polygon, culled as a whole, every piece that is not turned over. Counts
/// primitives_in, clipped, and what is culled here. Returns whether the triangle was cut.
bool geometry_for_hardware(const DrawContext& context, VertexCache& cache, std::array<std::uint32_t, 3> index,
                           std::uint32_t primitive, Counters& counters, std::vector<Triangle>& out);

/// A line that the host side leaves: with at least one pixel inside the scissor.
struct LinePrimitive {
  DrawnLine drawn;
  LineSetup setup;
};

/// Likewise a point.
struct PointPrimitive {
  DrawnPoint drawn;
  PixelBounds box;
};

/// Calls visit(box) for the boxes that its pixels make up.
template <class Visit>
void for_each_run(const PointPrimitive& point, int grid_bits, Visit&& visit) {
  const DrawnPoint& drawn = point.drawn;
  for_each_run(drawn.at, drawn.size, drawn.shape, point.box, grid_bits, visit);
}

/// What is left of one primitive that is not filled.
struct Outline {
  std::vector<LinePrimitive> lines;
  std::vector<Triangle> triangles;  ///< of lines that are rectangles: each with a sample's place in its box
  std::vector<PointPrimitive> points;

  void clear() {
    lines.clear();
    triangles.clear();
    points.clear();
  }
  [[nodiscard]] std::size_t size() const { return lines.size() + triangles.size() + points.size(); }
};

/// What the primitives of a draw end as.
[[nodiscard]] constexpr PrimitiveType drawn_as(const State& state, Topology topology) {
  const PrimitiveType type = primitive_type(topology);
  if (type != PrimitiveType::triangle || state.polygon_mode == PolygonMode::fill) return type;
  return state.polygon_mode == PolygonMode::line ? PrimitiveType::line : PrimitiveType::point;
}

/// Whether a draw's lines are rectangles, which are drawn as triangles.
[[nodiscard]] constexpr bool draws_rectangles(const State& state, Topology topology) {
  return state.line_rule == LineRule::rectangle && drawn_as(state, topology) == PrimitiveType::line;
}

/// What those triangles are drawn with. A line has no texture, meets fog at its ends, and shows its front.
[[nodiscard]] State rectangle_state(State state);

/// The host side of one primitive that is not filled: clip, viewport, cull (of triangles), line_setup or point_raster.
/// Appends to `out`, counts into `counters`. Cull of triangles looks at the clipped triangle; its edges are then clipped
/// one by one. No side of the view volume drops a line before the clip: a line a hair outside may snap to a pixel inside.
void geometry(const DrawContext& context, const Widths& widths, VertexCache& cache, const AssembledPrimitive& primitive,
              std::uint32_t number, Counters& counters, Outline& out);

/// validate(scene), then check_fits().
void check_scene(const Scene& scene, const Config& config);

/// Throws InputError when `scene`, which is valid, asks for what this configuration or version does not have.
void check_fits(const Scene& scene, const Config& config);

/// The pixels that a clear fills: it obeys the scissor alone, not the viewport.
[[nodiscard]] Rect clear_rect(const Scene& scene, const Clear& command);

}  // namespace halfplane
