// The host's side of the pipeline (pipeline_graph.hpp): converts one primitive of a scene into the input of the
// hardware, or of an engine that computes the same.
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
#include "smooth_raster.hpp"
#include "viewport.hpp"

namespace halfplane {

struct DrawContext {
  const Scene& scene;
  const Config& config;
  const std::shared_ptr<const State> state_of_rectangles;  ///< for a draw of rectangles
  const State& state;                                      ///< the draw's, or *state_of_rectangles
  const Draw& draw;
  std::uint32_t command = 0;  ///< index of the draw in Scene::commands
  Viewport viewport;
  Rect rect;    ///< pixels that the draw may touch
  double band;  ///< distance of the guard band's sides from 0, pixels; for rectangles less their width
  ClipPlanes guard_band, view_volume;
  ClipPlanes frustum;  ///< the view volume and a pixel around it: primitives outside snap to no pixel of the viewport
  DepthEncode depth_encode;
  FragmentOps fragment_ops;
  std::shared_ptr<const FogTable> fog;      ///< null: no fog
  std::shared_ptr<const PhongLight> phong;  ///< null: no light of fragments

  DrawContext(const Scene& scene_, const Config& config_, const Draw& draw_, std::uint32_t command_);
};

/// Throws InputError for a triangle with a vertex that is not in front of the eye, possible only in window space: its
/// attributes cannot be divided by w.
void require_positive_w(const DrawContext& context, const Triangle& triangle);

/// Projects a vertex shared by several triangles once.
class VertexCache {
 public:
  struct Entry {
    SnappedVertex snapped;         ///< valid when outside_guard_band == 0
    unsigned outside_frustum = 0;  ///< outcode against DrawContext::frustum
    unsigned outside_guard_band = 0;
    std::uint32_t state = ~0U;  ///< state that the entry was made with
  };
  /// `vertices` of the scene; 0: remembers only the last three, for callers without shared vertices.
  explicit VertexCache(std::size_t vertices) : entries_(vertices == 0 ? 3 : vertices), is_ring_(vertices == 0) {}
  [[nodiscard]] const Entry& get(const DrawContext& context, std::uint32_t index) {
    if (!is_ring_ && entries_[index].state == context.draw.state) return entries_[index];
    return make(context, index);
  }

 private:
  const Entry& make(const DrawContext& context, std::uint32_t index);

  std::vector<Entry> entries_;
  bool is_ring_;
  std::size_t next_ = 0;
};

/// The host side of one input triangle: clip, viewport, cull. Appends the result to `out`: nothing, the triangle, or
/// the fan of its clipped polygon. Counts into `counters`.
void geometry(const DrawContext& context, VertexCache& cache, std::array<std::uint32_t, 3> index,
              std::uint32_t primitive, const Skip& skip, Counters& counters, std::vector<Triangle>& out);

/// The same for hardware that culls: a triangle that needs no cut is appended unchanged, with any area, facing and box;
/// of a clipped polygon, culled as a whole, every piece that is not reversed. Counts primitives_in, clipped, and
/// triangles culled here. Returns whether the triangle was cut.
bool geometry_for_hardware(const DrawContext& context, VertexCache& cache, std::array<std::uint32_t, 3> index,
                           std::uint32_t primitive, Counters& counters, std::vector<Triangle>& out);

/// A line from the host side: with at least one pixel inside the scissor.
struct LinePrimitive {
  DrawnLine drawn;
  LineSetup setup;
};

/// Likewise a point.
struct PointPrimitive {
  DrawnPoint drawn;
  PixelBounds box;
};

/// Calls visit(box) for the boxes of its pixels.
template <class Visit>
void for_each_run(const PointPrimitive& point, int grid_bits, Visit&& visit) {
  const DrawnPoint& drawn = point.drawn;
  for_each_run(drawn.at, drawn.size, drawn.shape, point.box, grid_bits, visit);
}

/// The colour planes in a word: 8 bits a channel, R lowest.
[[nodiscard]] inline std::uint32_t packed_channels(const PerPlane<std::uint32_t>& code) {
  const auto channel = color_channels(code);
  return channel[0] | channel[1] << 8 | channel[2] << 16 | channel[3] << 24;
}

/// A point of one pixel: of a smooth primitive with its alpha times coverage, or of a point.
struct Dot {
  std::int32_t x = 0, y = 0;
  std::uint32_t z = 0, rgba = 0;  ///< depth code; packed_channels()
};

/// Appends a dot for each pixel of a box.
inline void add_dots(const PixelBounds& box, Dot dot, std::vector<Dot>& out) {
  for (dot.y = box.top; dot.y <= box.bottom; ++dot.y)
    for (dot.x = box.left; dot.x <= box.right; ++dot.x) out.push_back(dot);
}

/// The result for one primitive that is not filled.
struct Outline {
  std::vector<LinePrimitive> lines;
  std::vector<Triangle> triangles;  ///< for lines that are rectangles: each with a sample position in its box
  std::vector<PointPrimitive> points;
  std::vector<Dot> dots;  ///< with `keeps_dots`: the pixels of smooth primitives and of square points
  // Set by who wants that; clear() leaves them.
  bool keeps_dots = false;             ///< here, and not in `points`
  SmoothLanes smooth_lanes = nullptr;  ///< of smooth_raster()

  void clear() {
    dots.clear();
    lines.clear();
    triangles.clear();
    points.clear();
  }
  [[nodiscard]] std::size_t size() const { return lines.size() + triangles.size() + points.size() + dots.size(); }
};

/// The type that the primitives of a draw are finally drawn as.
[[nodiscard]] constexpr PrimitiveType drawn_as(const State& state, Topology topology) {
  const PrimitiveType type = primitive_type(topology);
  if (type != PrimitiveType::triangle || state.polygon_mode == PolygonMode::fill) return type;
  return state.polygon_mode == PolygonMode::line ? PrimitiveType::line : PrimitiveType::point;
}

/// Whether a draw's lines are rectangles, which are drawn as triangles.
[[nodiscard]] constexpr bool draws_rectangles(const State& state, Topology topology) {
  return state.line_rule == LineRule::rectangle && drawn_as(state, topology) == PrimitiveType::line;
}

/// The state of these triangles. A line has no texture, is fogged at its ends, and shows its front.
[[nodiscard]] State rectangle_state(State state);

/// The host side of one primitive that is not filled: clip, viewport, cull (of triangles), line_setup or point_raster.
/// Appends to `out`, counts into `counters`. Cull of triangles tests the clipped triangle; its edges are then clipped
/// one by one. No side of the view volume drops a line before the clip: a line slightly outside may snap to a pixel
/// inside.
void geometry(const DrawContext& context, const Widths& widths, VertexCache& cache, const AssembledPrimitive& primitive,
              std::uint32_t number, Counters& counters, Outline& out);

/// validate(scene), then check_fits().
void check_scene(const Scene& scene, const Config& config);

/// Throws InputError when `scene`, which is valid, needs a feature that this configuration or version lacks.
void check_fits(const Scene& scene, const Config& config);

/// The pixels that a clear fills: limited by the scissor, not the viewport.
[[nodiscard]] Rect clear_rect(const Scene& scene, const Clear& command);

}  // namespace halfplane
