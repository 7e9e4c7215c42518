// The pipeline, in order. Read this file first: each line below is a stage, and each stage is a file.
#pragma once

// clang-format off: the order is the point.
#include "stages/clip.hpp"                // homogeneous triangle    -> convex polygon                       host
#include "stages/coarse_raster.hpp"       // setup                   -> tiles, rejected and accepted
#include "stages/cull.hpp"                // signed area             -> keep or drop
#include "stages/depth_encode.hpp"        // interpolated depth      -> stored depth code
#include "stages/depth_test.hpp"          // fragment, stored depth  -> pass or fail
#include "stages/fine_raster.hpp"         // tile                    -> covered samples of its stamps
#include "stages/framebuffer.hpp"         // stored codes            -> the two images
#include "stages/hiz.hpp"                 // retired tile visits     -> a bound on the depths of each tile
#include "stages/interpolate.hpp"         // planes at the tile      -> depth and colour at a sample
#include "stages/line_raster.hpp"         // line setup              -> pixels with depth and colour
#include "stages/line_setup.hpp"          // two snapped vertices    -> first pixel, error term, steps       host
#include "stages/point_raster.hpp"        // a snapped vertex        -> the box of its pixels                host
#include "stages/primitive_assembly.hpp"  // indices and topology    -> triangles, lines, points             host
#include "stages/primitive_join.hpp"      // line pixels, stamps     -> fragments in program order
#include "stages/rop.hpp"                 // passed fragment         -> stored colour
#include "stages/tile_cache.hpp"          // passed stamps           -> on-chip tiles, memory requests
#include "stages/triangle_setup.hpp"      // three snapped vertices  -> edges, reciprocal, planes
#include "stages/viewport.hpp"            // clip coordinates        -> snapped window vertex                host
// clang-format on

#include "engines/render.hpp"

namespace halfplane {

/// What a draw needs that does not change from one triangle to the next.
struct DrawContext {
  const Scene& scene;
  const Config& config;
  const State& state;
  const Draw& draw;
  std::uint32_t command = 0;  ///< index of the draw in Scene::commands
  Viewport viewport;
  Rect rect;  ///< pixels that the draw may touch
  ClipPlanes guard_band, view_volume;
  DepthEncode depth_encode;

  DrawContext(const Scene& scene_, const Config& config_, const Draw& draw_, std::uint32_t command_);
};

/// A vertex that several triangles share is projected once.
class VertexCache {
 public:
  struct Entry {
    SnappedVertex snapped;        ///< valid when outside_guard_band == 0
    unsigned outside_volume = 0;  ///< outcode against the view volume
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

/// What is left of one primitive that is not filled.
struct Outline {
  std::vector<LinePrimitive> lines;
  std::vector<PointPrimitive> points;
};

/// What the primitives of a draw end as.
[[nodiscard]] constexpr PrimitiveType drawn_as(const State& state, Topology topology) {
  const PrimitiveType type = primitive_type(topology);
  if (type != PrimitiveType::triangle || state.polygon_mode == PolygonMode::fill) return type;
  return state.polygon_mode == PolygonMode::line ? PrimitiveType::line : PrimitiveType::point;
}

/// The host side of one primitive that is not filled: clip, viewport, cull (of triangles), line_setup or point_raster.
/// Appends to `out`, counts into `counters`. Cull of triangles looks at the clipped triangle; its edges are then clipped
/// one by one. No side of the view volume drops a line before the clip: a line a hair outside may snap to a pixel inside.
void geometry(const DrawContext& context, const Widths& widths, VertexCache& cache, const AssembledPrimitive& primitive,
              std::uint32_t number, Counters& counters, Outline& out);

/// Throws InputError when `scene` asks for what this configuration or version does not have.
void check_scene(const Scene& scene, const Config& config);

/// The pixels that a clear fills: it obeys the scissor alone, not the viewport.
[[nodiscard]] Rect clear_rect(const Scene& scene, const Clear& command);

/// Clears depth and colour inside the scissor; nobody owns the cleared pixels any more.
void clear(Rendering& rendering, const Scene& scene, const Clear& command, const Config& config);

/// An empty target: the farthest depth, opaque black, and the buffers that the options ask for.
[[nodiscard]] Rendering make_rendering(const Scene& scene, const Config& config, const RenderOptions& options);

}  // namespace halfplane
