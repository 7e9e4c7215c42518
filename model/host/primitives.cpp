#include "primitives.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>

#include "../stages/surface.hpp"
#include "clip_fan.hpp"
#include "smooth_raster.hpp"

namespace halfplane {
namespace {

/// A clipped polygon after the snap.
struct SnappedPolygon {
  std::array<SnappedVertex, 9> v;
  std::array<SurfaceVertex, 9> surface;
  int size = 0;
  [[nodiscard]] const SnappedVertex& at(int i) const { return v[static_cast<std::size_t>(i % size)]; }
  [[nodiscard]] const SurfaceVertex& surface_at(int i) const { return surface[static_cast<std::size_t>(i % size)]; }
  [[nodiscard]] std::span<const SnappedVertex> corners() const {
    return std::span(v).first(static_cast<std::size_t>(size));
  }
  [[nodiscard]] std::int64_t fan_area(int start, int i) const {
    return halfplane::fan_area(corners(), static_cast<std::size_t>(start), static_cast<std::size_t>(i));
  }
};

double largest_coordinate(std::span<const Vertex> v) {
  double largest = 0;
  for (const Vertex& vertex : v)
    for (const double c : {vertex.x, vertex.y, vertex.z, vertex.w}) largest = std::max(largest, std::abs(c));
  return largest;
}

/// Whether no corner is off by more than a pixel. Clipping cancels digits: a corner is as exact as binary64 at the size
/// of the primitive's coordinates.
bool is_precise(std::span<const Vertex> clipped, std::span<const Vertex> v, const DrawContext& context) {
  const double pixels = std::max(context.viewport.width, context.viewport.height);
  const double error = largest_coordinate(v) * pixels * std::numeric_limits<double>::epsilon();
  return std::ranges::all_of(clipped, [error](const Vertex& corner) { return error <= corner.w; });
}

[[noreturn]] void refuse_imprecise(std::span<const Vertex> v, const DrawContext& context) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", largest_coordinate(v));
  throw InputError(place_of_draw(context.scene.name, context.draw.line) + ": clip coordinates as large as " + text +
                   " leave less than a pixel of precision where the primitive is cut; use smaller coordinates");
}

/// A vertex made by a cut, or left unchanged next to one: in the guard band, up to rounding in binary64.
SnappedVertex snap_clipped(const Vertex& v, const DrawContext& context, std::uint32_t number) {
  WindowPosition p = to_window(v, context.state, context.viewport);
  p.x = std::clamp(p.x, -context.band, context.band);
  p.y = std::clamp(p.y, -context.band, context.band);
  return snap_vertex(p, v, context.config, {context.scene.name, context.draw.line, number},
                     snap_origin(context.state, context.config));
}

SurfaceVertex surface_vertex(const Vertex& v) { return {v.w, v.u, v.v, {}}; }

/// Cuts the same triangle once more, with its normals as colours: the cuts are the same, because they depend on
/// positions only.
void clip_normals(const DrawContext& context, const std::array<std::uint32_t, 3>& index, std::array<Vertex, 3> v,
                  SnappedPolygon& polygon) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto n = unit_normal(context.scene.normal(index[i]));
    v[i].rgba = {n[0], n[1], n[2], 0};
  }
  const ClipPolygon clipped = clip(context.guard_band, v[0], v[1], v[2]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(clipped.size); ++i) {
    const auto& n = clipped.v[i].rgba;
    polygon.surface[i].normal = normal_codes({n[0], n[1], n[2]});
  }
}

/// `is_outside`: the triangle is outside the view, so corners that are too inexact to draw are dropped.
SnappedPolygon clip_and_snap(const DrawContext& context, const std::array<std::uint32_t, 3>& index, bool is_outside) {
  const auto& vertices = context.scene.vertices;
  std::array<Vertex, 3> v{vertices[index[0]], vertices[index[1]], vertices[index[2]]};
  const ClipPolygon clipped = clip(context.guard_band, v[0], v[1], v[2]);
  const auto corners = std::span(clipped.v).first(static_cast<std::size_t>(clipped.size));
  SnappedPolygon polygon;
  if (!is_precise(corners, v, context)) {
    if (is_outside) return polygon;
    refuse_imprecise(v, context);
  }
  polygon.size = clipped.size;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    polygon.v[i] = snap_clipped(corners[i], context, index[0]);
    polygon.surface[i] = surface_vertex(corners[i]);
  }
  if (context.phong) clip_normals(context, index, v, polygon);
  return polygon;
}

PixelBounds bounds_of(const Rect& rect) { return {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1}; }

bool box_is_empty(const std::array<SnappedVertex, 3>& v, const DrawContext& context) {
  return sample_bounds(v, bounds_of(context.rect), coordinate_grid_bits(context.config), context.config.msaa_samples)
      .is_empty();
}

/// Codes with the provoking vertex's colour.
PerPlane<std::uint32_t> flat_color(const DrawContext& context, std::uint32_t provoking) {
  return snap_codes(0, context.scene.vertices[provoking], context.config);
}

/// An input triangle after clip, viewport and snap.
struct Projected {
  SnappedPolygon polygon;  ///< fewer than three corners: nothing is left
  bool is_cut = false;
};

/// Counts an incoming triangle, and a triangle that is clipped away.
Projected project(const DrawContext& context, VertexCache& cache, const std::array<std::uint32_t, 3>& index,
                  const Skip& skip, Counters& counters) {
  ++counters.primitives_in;
  const auto &a = cache.get(context, index[0]), &b = cache.get(context, index[1]), &c = cache.get(context, index[2]);
  Projected result;
  const bool is_outside = (a.outside_frustum & b.outside_frustum & c.outside_frustum) != 0;
  if (skip.frustum && is_outside) {
    ++counters.skipped.frustum;
    ++counters.culled;
    return result;
  }
  SnappedPolygon& polygon = result.polygon;
  result.is_cut = (a.outside_guard_band | b.outside_guard_band | c.outside_guard_band) != 0;
  if (result.is_cut) {
    polygon = clip_and_snap(context, index, is_outside);
  } else {
    polygon.size = 3;
    polygon.v[0] = a.snapped;
    polygon.v[1] = b.snapped;
    polygon.v[2] = c.snapped;
    if (has_surface(context.state))
      for (std::size_t i = 0; i < 3; ++i) {
        polygon.surface[i] = surface_vertex(context.scene.vertices[index[i]]);
        if (context.phong) polygon.surface[i].normal = normal_codes(unit_normal(context.scene.normal(index[i])));
      }
  }
  if (context.state.shade == Shade::flat)
    for (SnappedVertex& v : polygon.v) copy_color(v.code, flat_color(context, index[0]), context.config);
  counters.culled += polygon.size < 3 ? 1 : 0;
  return result;
}

/// Whether the whole polygon is culled; counts it then.
bool is_culled(std::int64_t area, const State& state, Counters& counters) {
  const CullResult result = cull(area, state);
  if (result == CullResult::keep) return false;
  ++(result == CullResult::zero_area ? counters.skipped.zero_area : counters.skipped.backface);
  ++counters.culled;
  return true;
}

/// Polygon offset in depth codes: slope factor times the steeper slope of the plane per pixel, plus the constant. The
/// slope is that of the fan's largest piece; a polygon without area has no slope.
std::int64_t offset_codes(const SnappedPolygon& polygon, const DrawContext& context) {
  const auto& [factor, constant] = context.state.polygon_offset;
  if (factor == 0 && constant == 0) return 0;
  double slope = 0;
  std::int64_t largest = 0;
  for (int i = 1; i + 1 < polygon.size; ++i) {
    const SnappedVertex &a = polygon.at(0), &b = polygon.at(i), &c = polygon.at(i + 1);
    const std::int64_t area = signed_area(a, b, c);
    if (std::abs(area) <= largest) continue;
    largest = std::abs(area);
    const double dz1 = static_cast<double>(b.code[kDepthPlane]) - a.code[kDepthPlane],
                 dz2 = static_cast<double>(c.code[kDepthPlane]) - a.code[kDepthPlane];
    const double per_x = dz1 * (c.y - a.y) - dz2 * (b.y - a.y), per_y = dz2 * (b.x - a.x) - dz1 * (c.x - a.x);
    slope = std::max(std::abs(per_x), std::abs(per_y)) / static_cast<double>(largest) *
            static_cast<double>(std::int64_t{1} << coordinate_grid_bits(context.config));
  }
  const double codes = std::ldexp(1.0, context.config.depth_bits);  // enough to reach either end from the other
  return snap(std::clamp(factor * slope + constant, -codes, codes), 1.0);
}

void move_depth(SnappedVertex& v, std::int64_t offset, int depth_bits) {
  std::uint32_t& code = v.code[kDepthPlane];
  code = static_cast<std::uint32_t>(std::clamp<std::int64_t>(code + offset, 0, (std::int64_t{1} << depth_bits) - 1));
}

void apply_polygon_offset(SnappedPolygon& polygon, const DrawContext& context) {
  if (const std::int64_t offset = offset_codes(polygon, context); offset != 0)
    for (SnappedVertex& v : polygon.v) move_depth(v, offset, context.config.depth_bits);
}

/// Calls visit(piece) for the triangles of a polygon's fan. A piece reversed by the snap is skipped.
template <class Visit>
void for_each_piece(const SnappedPolygon& polygon, std::int64_t area, std::uint32_t primitive, std::uint32_t command,
                    Visit&& visit) {
  const int start = polygon.size == 3 ? 0 : static_cast<int>(fan_start(polygon.corners()));
  for (int i = 1; i + 1 < polygon.size; ++i) {
    const std::int64_t piece_area = polygon.fan_area(start, i);
    if (piece_area == 0 || (piece_area > 0) != (area > 0)) continue;
    visit(Triangle{primitive,
                   command,
                   {polygon.at(start), polygon.at(start + i), polygon.at(start + i + 1)},
                   {polygon.surface_at(start), polygon.surface_at(start + i), polygon.surface_at(start + i + 1)}});
  }
}

/// Distances to planes are sums of a few coordinates times pixels: they must fit binary64.
void require_finite_distances(const Vertex& v, const DrawContext& context, std::uint32_t number) {
  for (const double c : {v.x, v.y, v.z, v.w})
    if (!(std::abs(c) <= 1e300))
      throw InputError(place_of_draw(context.scene.name, context.draw.line) + ": vertex " + std::to_string(number) +
                       " has a clip coordinate beyond 1e300; use smaller ones, x y z w may be scaled together");
}

/// The host side of lines and points, one input primitive at a time.
class OutlineBuilder {
 public:
  OutlineBuilder(const DrawContext& context, const Widths& widths, VertexCache& cache, std::uint32_t number,
                 Outline& out)
      : context_(context), widths_(widths), cache_(cache), number_(number), out_(out) {}

  std::optional<PerPlane<std::uint32_t>> color;  ///< colour of every vertex, if shading is flat
  std::int64_t depth_offset = 0;                 ///< codes
  bool is_cut = false;                           ///< an earlier part of a line was cut

  void add_line(std::uint32_t a, std::uint32_t b) {
    const LineRule rule = context_.state.line_rule;
    const bool is_rectangle = rule == LineRule::rectangle || is_smooth_;
    const VertexCache::Entry &from = cache_.get(context_, a), &to = cache_.get(context_, b);
    bool crosses = (from.outside_guard_band | to.outside_guard_band) != 0;
    DrawnLine line{number_, context_.command, from.snapped, to.snapped, drops_last()};
    std::array<Vertex, 2> v{context_.scene.vertices[a], context_.scene.vertices[b]};
    if (crosses) {
      const auto clipped = clip(context_.guard_band, v[0], v[1]);
      if (!clipped) return;
      if (!is_precise(*clipped, v, context_)) refuse_imprecise(v, context_);
      line.start = snap_clipped((*clipped)[0], context_, a);
      line.end = snap_clipped((*clipped)[1], context_, b);
      v = *clipped;
    } else if (is_rectangle && context_.state.space == Space::window) {
      for (Vertex& end : v) to_top_left(end);
      const auto clipped = clip_to_square(context_.band, v[0], v[1]);
      if (!clipped) return;
      crosses = (*clipped)[0].x != v[0].x || (*clipped)[0].y != v[0].y || (*clipped)[1].x != v[1].x ||
                (*clipped)[1].y != v[1].y;
      if (crosses) {
        line.start = snap_window((*clipped)[0], a);
        line.end = snap_window((*clipped)[1], b);
        v = *clipped;
      }
    }
    finish(line.start, v[0].w);
    finish(line.end, v[1].w);
    if (is_rectangle) return add_rectangle(line, crosses);
    const int count = strands_of(context_.state.line_width);
    for (int i = 0; i < count; ++i) {
      DrawnLine strand = line;
      if (count > 1) move_to_strand(strand.start, strand.end, i, count, rule, widths_.grid_bits);
      auto setup = setup_line(strand.start, strand.end, rule, strand.drops_last, bounds_of(context_.rect), widths_);
      if (!setup) continue;
      setup->primitive_id = number_;
      is_cut |= crosses;
      out_.lines.push_back({strand, *setup});
    }
  }

  /// Adds two triangles that share the diagonal from the first to the third corner, or the pixels of a smooth line.
  void add_rectangle(const DrawnLine& line, bool crosses) {
    const auto corners = line_rectangle(line.start, line.end, context_.state.line_width, widths_.grid_bits);
    if (!corners) return;
    if (is_smooth_) return add_smooth(line, *corners, crosses);
    const auto& [a, b, c, d] = *corners;
    for (const auto& v : {std::array{a, b, c}, std::array{c, d, a}}) {
      if (box_is_empty(v, context_)) continue;
      is_cut |= crosses;
      out_.triangles.push_back({number_, context_.command, v, {}});
    }
  }

  /// Adds a point of one pixel for each pixel that the rectangle covers in part.
  void add_smooth(const DrawnLine& line, const std::array<SnappedVertex, 4>& corners, bool crosses) {
    const std::vector<SmoothPixel> pixels =
        smooth_raster(corners, bounds_of(context_.rect), widths_.grid_bits, out_.smooth_lanes);
    is_cut |= crosses && !pixels.empty();
    CodesBeside codes(line.start, line.end, widths_);
    for (const SmoothPixel& pixel : pixels) add_pixel(pixel, codes(pixel.x, pixel.y));
  }

  /// Adds a pixel of a smooth primitive: a point of its own. Inlined into the loops over them.
  [[gnu::always_inline]] void add_pixel(const SmoothPixel& pixel, const PerPlane<std::uint32_t>& code) {
    std::uint32_t alpha = code[kColorPlane + 3];
    if (widths_.color_planes == 4) alpha = (alpha * pixel.coverage + kWholePixel / 2) / kWholePixel;
    if (out_.keeps_dots) {
      constexpr std::uint32_t kColors = 0xffffff;
      out_.dots.push_back({pixel.x, pixel.y, code[kDepthPlane], (packed_channels(code) & kColors) | alpha << 24});
      return;
    }
    const std::int32_t whole = std::int32_t{1} << widths_.grid_bits;
    SnappedVertex at;
    at.x = pixel.x * whole + whole / 2;
    at.y = pixel.y * whole + whole / 2;
    at.code = code;
    at.code[kColorPlane + 3] = alpha;
    out_.points.push_back(
        {{number_, context_.command, at, whole, PointShape::square}, {pixel.x, pixel.y, pixel.x, pixel.y}});
  }

  void add_point(std::uint32_t index) {
    const VertexCache::Entry& entry = cache_.get(context_, index);
    const State& state = context_.state;
    const bool is_inside = state.point_clip == PointClip::pixel || state.space == Space::window ||
                           outcode(context_.view_volume, context_.scene.vertices[index]) == 0;
    if (entry.outside_guard_band != 0 || !is_inside) return;
    const double pixel = static_cast<double>(std::int64_t{1} << widths_.grid_bits);
    DrawnPoint point{number_, context_.command, entry.snapped, static_cast<std::int32_t>(snap(state.point_size, pixel)),
                     state.point_shape};
    finish(point.at, context_.scene.vertices[index].w);
    if (is_smooth_) {
      const PixelBounds limit = bounds_of(context_.rect);
      for (const SmoothPixel& covered : smooth_raster(point.at, point.size, point.shape, limit, widths_.grid_bits))
        add_pixel(covered, point.at.code);
      return;
    }
    const PixelBounds box = point_bounds(point.at, point.size, bounds_of(context_.rect), widths_.grid_bits);
    if (out_.keeps_dots) return add_dots(box, {0, 0, point.at.depth(), packed_channels(point.at.code)}, out_.dots);
    bool is_drawn = false;
    const PointPrimitive primitive{point, box};
    for_each_run(primitive, widths_.grid_bits, [&is_drawn](const PixelBounds&) { is_drawn = true; });
    if (is_drawn) out_.points.push_back(primitive);
  }

 private:
  /// Converts a vertex of window space to the rasterizer's pixels.
  void to_top_left(Vertex& v) const {
    const WindowPosition p = window_position(v, context_.state, context_.scene.height);
    v.x = p.x;
    v.y = p.y;
  }
  [[nodiscard]] SnappedVertex snap_window(const Vertex& v, std::uint32_t number) const {
    return snap_vertex({v.x, v.y, v.z}, v, context_.config, {context_.scene.name, context_.draw.line, number},
                       snap_origin(context_.state, context_.config));
  }
  [[nodiscard]] bool drops_last() const {
    const State& state = context_.state;
    return state.line_rule == LineRule::diamond ||
           (state.line_last ? !*state.line_last : drops_last_by_default(state.line_rule));
  }
  void finish(SnappedVertex& v, double w) const {
    if (color) copy_color(v.code, *color, context_.config);
    if (context_.fog) add_fog(v, w);
    if (depth_offset != 0) move_depth(v, depth_offset, context_.config.depth_bits);
  }

  /// Lines and points are fogged at their ends.
  void add_fog(SnappedVertex& v, double w) const {
    const FogTable& fog = *context_.fog;
    const std::uint32_t factor = fog_factor_of_vertex(fog.fog(), w);
    for (std::size_t c = 0; c < 3; ++c)
      v.code[kColorPlane + c] = fogged<std::uint32_t>(v.code[kColorPlane + c], fog.color()[c], factor);
  }

  const DrawContext& context_;
  const Widths& widths_;
  VertexCache& cache_;
  std::uint32_t number_;
  const bool is_smooth_ = is_smooth(context_.state, context_.config);
  Outline& out_;
};

/// Whether lines must lie in the guard band with their whole width.
bool draws_whole_rectangles(const DrawContext& context) {
  return drawn_as(context.state, context.draw.topology) == PrimitiveType::line &&
         (context.state.line_rule == LineRule::rectangle || is_smooth(context.state, context.config));
}

/// Distance of a corner from its end along an axis: half the width, and a subpixel for both snaps.
double room_for_rectangle(const State& state, const Config& config) {
  return state.line_width / 2 + std::ldexp(1.0, -config.subpixel_bits);
}

/// Primitives outside the guard band are not drawn: a point or a line there must not be wide enough to reach the
/// target. A line of one pixel never is. A rectangle must lie completely in the guard band: its line is cut half its
/// width, a subpixel and the snap inside it, where the cut end itself must not be visible.
void refuse_too_wide(const DrawContext& context) {
  const Scene& scene = context.scene;
  const PrimitiveType type = drawn_as(context.state, context.draw.topology);
  const bool is_rectangle = draws_whole_rectangles(context);
  const double width = type == PrimitiveType::point ? context.state.point_size
                       : is_rectangle               ? context.state.line_width
                                                    : strands_of(context.state.line_width);
  const int beside = context.config.guard_band - std::max(scene.width, scene.height);
  const double widest = is_rectangle ? beside - 3 : 2 * (beside - 1);
  const bool is_thin = type == PrimitiveType::line && !is_rectangle && width == 1;
  if (type == PrimitiveType::triangle || is_thin || (width >= 1 && width <= widest)) return;
  const std::string what = type == PrimitiveType::point ? "point" : "line";
  throw InputError(place_of_draw(scene.name, context.draw.line) + ": state " +
                   (type == PrimitiveType::point ? "point_size" : "line_width") + ": " +
                   (widest >= 1
                        ? what + "s of this target and guard.band are 1 to " +
                              std::to_string(static_cast<int>(widest)) + " pixels wide; use a smaller " + what + ", "
                        : "no " + what + " fits beside this target in this guard.band; use ") +
                   "a smaller target or raise guard.band");
}

}  // namespace

State rectangle_state(State state) {
  state.texture.reset();
  state.fog.reset();
  state.stencil_back.reset();
  state.shade = Shade::smooth;  // flat colours are at both ends, possibly with different fog; a line has no normal
  return state;
}

DrawContext::DrawContext(const Scene& scene_, const Config& config_, const Draw& draw_, std::uint32_t command_)
    : scene(scene_),
      config(config_),
      state_of_rectangles(draws_rectangles(scene_.states[draw_.state], draw_.topology)
                              ? std::make_shared<const State>(rectangle_state(scene_.states[draw_.state]))
                              : nullptr),
      state(state_of_rectangles ? *state_of_rectangles : scene_.states[draw_.state]),
      draw(draw_),
      command(command_),
      viewport(effective_viewport(state, scene_.width, scene_.height)),
      rect(raster_rect(state, scene_.width, scene_.height)),
      band(guard_band_limit(config_) - (draws_whole_rectangles(*this) ? room_for_rectangle(state, config_) : 0)),
      guard_band(guard_band_planes(state.clip_z, viewport, band)),
      view_volume(view_volume_planes(state.clip_z)),
      frustum(view_volume_planes(state.clip_z, viewport, 1)),
      depth_encode(config_, scene_.planes),
      fragment_ops(halfplane::fragment_ops(state, config_.color_format)),
      fog(fog_table(scene_.states[draw_.state])),
      phong(phong_light(state)) {
  if (state.alpha_to_coverage && config_.msaa_samples > 1) fragment_ops.alpha_samples = config_.msaa_samples;
}

void require_positive_w(const DrawContext& context, const Triangle& triangle) {
  if (std::ranges::all_of(triangle.surface, [](const SurfaceVertex& v) { return v.w > 0; })) return;
  throw InputError(place_of_draw(context.scene.name, context.draw.line) + ": triangle " +
                   std::to_string(triangle.primitive) +
                   " has a vertex with w <= 0, by which its attributes cannot be divided; give w > 0, or state "
                   "texture_interp and color_interp affine, fog off, shade smooth and w 1");
}

const VertexCache::Entry& VertexCache::make(const DrawContext& context, std::uint32_t index) {
  if (is_ring_) next_ = (next_ + 1) % entries_.size();
  Entry& entry = entries_[is_ring_ ? next_ : index];
  const Vertex& v = context.scene.vertices[index];
  if (context.state.space == Space::clip) {
    require_finite_distances(v, context, index);
    entry.outside_frustum = outcode(context.frustum, v);
    entry.outside_guard_band = outcode(context.guard_band, v) | (v.w > 0 ? 0U : 1U);
  } else {
    entry.outside_frustum = entry.outside_guard_band = 0;
  }
  if (entry.outside_guard_band == 0) {
    const WindowPosition p = context.state.space == Space::clip
                                 ? to_window(v, context.state, context.viewport)
                                 : window_position(v, context.state, context.scene.height);
    entry.snapped = snap_vertex(p, v, context.config, {context.scene.name, context.draw.line, index},
                                snap_origin(context.state, context.config));
  }
  entry.state = context.draw.state;
  return entry;
}

void geometry(const DrawContext& context, VertexCache& cache, std::array<std::uint32_t, 3> index,
              std::uint32_t primitive, const Skip& skip, Counters& counters, std::vector<Triangle>& out) {
  Projected projected = project(context, cache, index, skip, counters);
  SnappedPolygon& polygon = projected.polygon;
  if (polygon.size < 3) return;
  const std::int64_t area = total_area(polygon.corners());
  if (is_culled(area, context.state, counters)) return;
  apply_polygon_offset(polygon, context);
  bool is_drawn = false;
  for_each_piece(polygon, area, primitive, context.command, [&](const Triangle& piece) {
    const bool is_empty = box_is_empty(piece.v, context);
    is_drawn |= !is_empty;
    if (!is_empty || !skip.empty) out.push_back(piece);
  });
  if (is_drawn) {
    ++counters.drawn;
    counters.clipped += projected.is_cut ? 1 : 0;
  } else {
    ++counters.culled;
    counters.skipped.empty += skip.empty ? 1 : 0;
  }
}

void geometry(const DrawContext& context, const Widths& widths, VertexCache& cache, const AssembledPrimitive& primitive,
              std::uint32_t number, Counters& counters, Outline& out) {
  OutlineBuilder builder(context, widths, cache, number, out);
  const std::size_t before = out.size();
  const auto& index = primitive.index;
  const PrimitiveType type = drawn_as(context.state, context.draw.topology);
  const std::size_t corners = primitive.type == PrimitiveType::triangle ? 3 : 1;
  if (primitive.type == PrimitiveType::triangle) {
    const Skip no_skip{.frustum = false};
    const Projected projected = project(context, cache, index, no_skip, counters);
    if (projected.polygon.size < 3 || is_culled(total_area(projected.polygon.corners()), context.state, counters))
      return;
    builder.depth_offset = offset_codes(projected.polygon, context);
  } else {
    ++counters.primitives_in;
  }
  if (context.scene.states[context.draw.state].shade == Shade::flat) {
    const bool is_second = primitive.type == PrimitiveType::line && context.state.provoking == Provoking::last;
    builder.color = flat_color(context, index[is_second ? 1 : 0]);
  }
  if (context.rect.width > 0 && context.rect.height > 0)
    for (std::size_t i = 0; i < corners; ++i)
      type == PrimitiveType::line ? builder.add_line(index[i], index[(i + 1) % 3]) : builder.add_point(index[i]);
  if (out.size() > before) {
    ++counters.drawn;
    counters.clipped += builder.is_cut ? 1 : 0;
  } else {
    ++counters.culled;
    ++counters.skipped.empty;
  }
}

bool geometry_for_hardware(const DrawContext& context, VertexCache& cache, std::array<std::uint32_t, 3> index,
                           std::uint32_t primitive, Counters& counters, std::vector<Triangle>& out) {
  Projected projected = project(context, cache, index, Skip{}, counters);
  SnappedPolygon& polygon = projected.polygon;
  if (polygon.size < 3) return false;
  apply_polygon_offset(polygon, context);
  if (!projected.is_cut) {
    out.push_back({primitive,
                   context.command,
                   {polygon.v[0], polygon.v[1], polygon.v[2]},
                   {polygon.surface_at(0), polygon.surface_at(1), polygon.surface_at(2)}});
    return false;
  }
  const std::int64_t area = total_area(polygon.corners());
  if (is_culled(area, context.state, counters)) return true;
  bool is_drawn = false;
  for_each_piece(polygon, area, primitive, context.command, [&](const Triangle& piece) {
    is_drawn |= !box_is_empty(piece.v, context);
    out.push_back(piece);
  });
  counters.clipped += is_drawn ? 1 : 0;
  return true;
}

void check_scene(const Scene& scene, const Config& config) {
  validate(scene);
  check_fits(scene, config);
}

void check_fits(const Scene& scene, const Config& config) {
  if (scene.width < 1 || scene.height < 1 || scene.width > config.target_width || scene.height > config.target_height)
    throw InputError(scene.name + ": the target is " + std::to_string(scene.width) + "x" +
                     std::to_string(scene.height) + ", but this configuration takes 1x1 to " +
                     std::to_string(config.target_width) + "x" + std::to_string(config.target_height) +
                     "; make the target smaller, or raise target.width and target.height");
  const Draw* looked_at = nullptr;
  for (std::size_t i = 0; i < scene.commands.size(); ++i) {
    const auto* draw = std::get_if<Draw>(&scene.commands[i]);
    if (draw == nullptr) continue;
    // A mesh of many objects is many draws with one state.
    if (looked_at != nullptr && draw->state == looked_at->state && draw->topology == looked_at->topology) continue;
    looked_at = draw;
    const DrawContext context(scene, config, *draw, static_cast<std::uint32_t>(i));
    const State& state = context.state;
    if (drawn_as(state, draw->topology) != PrimitiveType::triangle && state.color_interp == ColorInterp::perspective)
      throw InputError(place_of_draw(context.scene.name, context.draw.line) +
                       ": state color_interp perspective: this engine interpolates the colours of lines and points "
                       "affinely; the golden has it over w");
    refuse_too_wide(context);
    const Viewport& v = context.viewport;
    // A sample that the clipper cuts away, or places on its right or lower edge, would be lost.
    const double limit = guard_band_limit(config), last = limit + 0.5;
    const bool fits = v.x >= -limit && v.y >= -limit && v.x + v.width < last && v.y + v.height < last;
    if (context.state.space == Space::clip && !fits)
      throw InputError(place_of_draw(context.scene.name, context.draw.line) +
                       ": state viewport: in clip space it must lie inside the guard band of +-" +
                       std::to_string(config.guard_band) + " pixels, with subpixel.bits below 2 a pixel inside; " +
                       "use a smaller viewport or raise guard.band");
  }
}

Rect clear_rect(const Scene& scene, const Clear& command) {
  State state = scene.states[command.state];
  state.viewport.reset();
  return raster_rect(state, scene.width, scene.height);
}

}  // namespace halfplane
