// Primitives: from vertices to draws of the model. Those that the model draws as OpenGL does pass unchanged; the rest is
// taken apart here, primitive by primitive.
#include "primitive.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "batch.hpp"
#include "clip.hpp"
#include "context.hpp"
#include "matrix.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

/// Takes primitives apart until the model, feedback or selection can take them.
class Pipeline {
 public:
  /// `is_shaded`: the host shades the fragments of what is textured.
  Pipeline(Context& context, bool is_shaded)
      : context_(context),
        state_(context.state),
        is_textured_(draw_setup(context).units != 0),
        is_shaded_(is_shaded),
        is_fed_(context.render_mode != GL_RENDER) {
    const TransformState& transform = state_.transform;
    for (std::size_t i = 0; i < transform.clip_plane.size(); ++i)
      if (transform.clip_enabled[i]) user_planes_.push_back({&ShadedVertex::eye, transform.clip_plane[i], true});
  }

  /// One, two or more vertices, in their order around; `provoking` gives the colour. `resets`: the stipple begins anew.
  void primitive(Vertices vertices, std::size_t provoking, bool resets) {
    if (state_.lighting.shade_model == GL_FLAT) {
      const ShadedVertex from = vertices[provoking];
      for (ShadedVertex& v : vertices) v.color = from.color, v.secondary = from.secondary;
    }
    clip(vertices, user_planes_);
    if (vertices.empty()) return;
    if (vertices.size() > 2) return polygon(std::move(vertices), provoking);
    vertices.size() == 1 ? point(vertices) : line(vertices, resets);
  }

  void flush() {
    indices_.resize(pending_.size());
    std::iota(indices_.begin(), indices_.end(), 0U);
    if (!pending_.empty())
      draw_batch(context_, group_, pending_, indices_, traits_of(pending_, draw_setup(context_).unit));
    pending_.clear();
  }

 private:
  void add(const BatchKind& group, const Vertices& vertices) {
    if (group != group_) flush();
    group_ = group;
    for (const ShadedVertex& v : vertices) pending_.push_back(v);
  }

  /// Triangles of a polygon, each with the vertex `last` at its end.
  void add_fan(const BatchKind& group, const Vertices& v, std::size_t last) {
    for (std::size_t i = 1; i + 1 < v.size(); ++i)
      add(group, {v[(last + i) % v.size()], v[(last + i + 1) % v.size()], v[last % v.size()]});
  }

  /// Clips to the view volume, to window coordinates. False: nothing is left.
  bool to_window(Vertices& vertices, double margin = 0) const {
    if (state_.viewport.width <= 0 || state_.viewport.height <= 0) return false;
    clip(vertices, view_volume(state_.viewport, margin));
    for (ShadedVertex& v : vertices) {
      if (!(v.clip[3] > 0)) return false;
      v.clip = window_position(state_.viewport, v.clip);
      if (!std::ranges::all_of(v.clip, [](double c) { return std::isfinite(c); })) return false;
    }
    return !vertices.empty();
  }

  /// Twice the area in clip space, of the sign that it has in the window, whatever the signs of w.
  [[nodiscard]] static double area(const Vertices& v) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < v.size(); ++i) {
      const Vec4 &a = v[0].clip, &b = v[i].clip, &c = v[i + 1].clip;
      sum +=
          a[0] * (b[1] * c[3] - b[3] * c[1]) - a[1] * (b[0] * c[3] - b[3] * c[0]) + a[3] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum;
  }

  void polygon(Vertices vertices, std::size_t provoking) {
    const PolygonState& state = state_.polygon;
    const bool is_back = (area(vertices) < 0) == (state.front_face == GL_CCW) && area(vertices) != 0;
    if (state.cull && (state.cull_face == GL_FRONT_AND_BACK || (state.cull_face == GL_BACK) == is_back)) return;
    if (is_back)
      for (ShadedVertex& v : vertices) v.color[0] = v.color[1], v.secondary[0] = v.secondary[1];
    const GLenum mode = state.mode[is_back ? 1 : 0];
    if (mode == GL_FILL) return fill(std::move(vertices), provoking);
    move_by_offset(vertices, mode == GL_LINE ? state.offset_line : state.offset_point);
    bool resets = true;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (!vertices[i].edge_flag) continue;
      if (mode == GL_POINT) {
        point({vertices[i]});
      } else {
        line({vertices[i], vertices[(i + 1) % vertices.size()]}, resets);
        resets = false;
      }
    }
  }

  void fill(Vertices vertices, std::size_t provoking) {
    if (!is_fed_ && !state_.polygon.stipple)
      return add_fan({.is_shaded = is_shaded_}, vertices, provoking < vertices.size() ? provoking : 0);
    if (!to_window(vertices)) return;
    if (is_fed_) return feed_primitive(context_, GL_POLYGON_TOKEN, vertices);
    add_fan({.is_window = true, .is_stippled = true, .is_shaded = is_shaded_}, vertices, 0);
  }

  /// Polygon offset of lines and points, which the model has of triangles alone.
  void move_by_offset(Vertices& vertices, bool is_enabled) const {
    const PolygonState& polygon = state_.polygon;
    if (!is_enabled || is_fed_ || context_.drawable == nullptr) return;
    const double range = state_.viewport.far - state_.viewport.near;
    Vertices window = vertices;
    if (range == 0 || !to_window(window)) return;
    double slope = 0, largest = 0;  // of the largest triangle
    for (std::size_t i = 1; i + 1 < window.size(); ++i) {
      const auto side = [&](std::size_t to, std::size_t c) { return window[to].clip[c] - window[0].clip[c]; };
      const double size = side(i, 0) * side(i + 1, 1) - side(i + 1, 0) * side(i, 1);
      if (!(std::abs(size) > largest)) continue;
      largest = std::abs(size);
      slope = std::max(std::abs(side(i, 2) * side(i + 1, 1) - side(i + 1, 2) * side(i, 1)),
                       std::abs(side(i + 1, 2) * side(i, 0) - side(i, 2) * side(i + 1, 0))) /
              largest;
    }
    const double code = 1 / (std::ldexp(1.0, context_.drawable->frame.options().config.depth_bits) - 1);
    const double offset = 2 * (slope * polygon.offset_factor + code * polygon.offset_units) / range;
    if (!std::isfinite(offset)) return;
    // Parts beyond near and far are cut off before the offset moves vertices beyond them, where depths are clamped.
    const auto planes = view_volume(state_.viewport, 0);
    clip(vertices, std::span(planes).first(2));
    for (ShadedVertex& v : vertices)
      v.clip[2] = std::clamp(v.clip[2] + offset * v.clip[3], -std::abs(v.clip[3]), std::abs(v.clip[3]));
  }

  void point(Vertices vertices) {
    const double size = point_size(vertices.front());
    if (!is_fed_ && !is_textured_)
      return add({.kind = DrawKind::points, .topology = Topology::points, .point_size = size}, vertices);
    if (!to_window(vertices)) return;
    if (is_fed_) return feed_primitive(context_, GL_POINT_TOKEN, vertices);
    if (state_.point.smooth && !state_.point.sprite) missing("smooth points with a texture", "they are squares");
    rectangle(DrawKind::points, {vertices[0], vertices[0]}, {size / 2, 0}, {0, size / 2});
  }

  void line(Vertices vertices, bool resets) {
    if (resets) stipple_at_ = 0;
    if (!is_fed_ && !is_textured_ && !state_.line.stipple && !fog_bends(vertices[0], vertices[1]))
      return add({.kind = DrawKind::lines, .topology = Topology::lines}, vertices);
    // With a pixel around it, no pixel is lost at the border, and the scissor drops the rest.
    if (!to_window(vertices, is_fed_ ? 0 : 1)) return;
    if (is_fed_) return feed_primitive(context_, resets ? GL_LINE_RESET_TOKEN : GL_LINE_TOKEN, vertices);
    const ShadedVertex &a = vertices[0], &b = vertices[1];
    const double dx = b.clip[0] - a.clip[0], dy = b.clip[1] - a.clip[1];
    const std::size_t major = std::abs(dx) >= std::abs(dy) ? 0 : 1;
    if (!state_.line.stipple) return piece(a, b, major);
    stippled_line(a, b, major);
  }

  /// The pieces of a line that its stipple leaves, cut along the major axis where one pixel's diamond has been left and
  /// the next one's cannot have been.
  void stippled_line(const ShadedVertex& a, const ShadedVertex& b, std::size_t major) {
    const double turn = b.clip[major] >= a.clip[major] ? 1 : -1, from = turn * a.clip[major], to = turn * b.clip[major];
    const auto is_in_diamond = [&](const ShadedVertex& v) {
      const double along = v.clip[major], across = v.clip[1 - major];
      return std::abs(along - std::floor(along) - 0.5) + std::abs(across - std::floor(across) - 0.5) < 0.5;
    };
    // The first pixel whose diamond is left, and one past the last.
    const double first = std::floor(from) + (from - std::floor(from) > 0.5 && !is_in_diamond(a) ? 1 : 0),
                 end = std::floor(to) + (to - std::floor(to) > 0.5 && !is_in_diamond(b) ? 1 : 0);
    const auto at = [&](double place) {
      const double t = (place + 0.25 - from) / (to - from);
      return t <= 0 ? a : t >= 1 ? b : window_mix(a, b, t);
    };
    double begin = first;
    for (double pixel = first; pixel < end; ++pixel) {
      const bool is_last = pixel + 1 >= end;
      const bool is_drawn = stipple_bit(pixel - first);
      if (!is_drawn) begin = pixel + 1;
      if (is_drawn && (is_last || !stipple_bit(pixel + 1 - first)))
        piece(begin == first ? a : at(begin), is_last ? b : at(pixel + 1), major);
    }
    stipple_at_ += static_cast<std::uint64_t>(std::max(end - first, 0.0));
  }

  /// The stipple's bit at a pixel of the current line.
  [[nodiscard]] bool stipple_bit(double pixel) const {
    const std::uint64_t count = stipple_at_ + static_cast<std::uint64_t>(pixel);
    return (state_.line.stipple_pattern >> (count / static_cast<std::uint64_t>(state_.line.stipple_factor) % 16) & 1) !=
           0;
  }

  /// Fog is the model's at the ends of a line: this one is halved until that shows no more.
  void fogged_piece(const ShadedVertex& a, const ShadedVertex& b, int halvings) {
    if (halvings == 0 || !fog_bends(a, b))
      return add({.kind = DrawKind::lines, .topology = Topology::lines, .is_window = true}, {a, b});
    const ShadedVertex middle = window_mix(a, b, 0.5);
    fogged_piece(a, middle, halvings - 1);
    fogged_piece(middle, b, halvings - 1);
  }

  [[nodiscard]] bool fog_bends(const ShadedVertex& a, const ShadedVertex& b) const {
    return state_.fog.enabled && !is_fed_ && gl::fog_bends(state_.fog, a, b);
  }

  /// A line in the window; with a texture as wide along the minor axis as lines are, which covers the same pixels between
  /// its ends.
  void piece(const ShadedVertex& a, const ShadedVertex& b, std::size_t major) {
    if (!is_textured_) return fogged_piece(a, b, kFogHalvings);
    if (state_.line.smooth) missing("smooth lines with a texture", "they are drawn without antialiasing");
    const double half = std::rint(std::clamp<double>(state_.line.width, 1, kLargestLine)) / 2;
    std::array<double, 2> across{};
    across[1 - major] = half;
    rectangle(DrawKind::lines, {a, b}, {0, 0}, across);
  }

  /// Two triangles about a line, its ends moved outwards by `along` and to both sides by `across`.
  void rectangle(DrawKind kind, const std::array<ShadedVertex, 2>& ends, std::array<double, 2> along,
                 std::array<double, 2> across) {
    std::array<ShadedVertex, 4> corner;
    for (std::size_t i = 0; i < 4; ++i) {
      corner[i] = ends[i / 2];
      if (kind == DrawKind::points && state_.point.sprite)  // from the upper left corner
        for (std::size_t unit = 0; unit < kTextureUnits; ++unit)
          if (state_.texture.unit[unit].coord_replace)
            corner[i].tex_coord[unit] = {i < 2 ? 0.0 : 1.0, i % 2 == 0 ? 1.0 : 0.0, 0, 1};
      for (std::size_t c = 0; c < 2; ++c)
        corner[i].clip[c] += (i < 2 ? -along[c] : along[c]) + (i % 2 == 0 ? -across[c] : across[c]);
    }
    missing(kind == DrawKind::points ? "textured points" : "textured lines", "they are drawn as two triangles");
    add({.kind = kind, .is_window = true, .is_shaded = is_shaded_},
        {corner[0], corner[2], corner[3], corner[0], corner[3], corner[1]});
  }

 public:
  [[nodiscard]] double point_size(const ShadedVertex& v) const {
    const double size = v.point_size > 1 ? std::min<double>(v.point_size, kLargestPoint) : 1;
    return state_.point.smooth || (state_.point.sprite && is_textured_) ? size : std::rint(size);
  }

 private:
  void missing(const char* what, const char* instead) const {
    if (context_.drawable != nullptr) context_.drawable->frame.missing(what, instead);
  }

  static constexpr int kFogHalvings = 6;

  Context& context_;
  const gl::State& state_;
  const bool is_textured_, is_shaded_, is_fed_;
  std::vector<Plane> user_planes_;
  std::uint64_t stipple_at_ = 0;  ///< pixels since the stipple was reset
  BatchKind group_;
  ShadedVertices pending_;
  std::vector<std::uint32_t> indices_;
};

// ---- primitives of glBegin

/// How primitives follow from the places of vertices.
struct Assembly {
  std::size_t size, step;
  std::array<std::size_t, 4> order;  ///< around the primitive
  std::size_t provoking;             ///< which of `order` gives the colour
  std::optional<Topology> topology;  ///< topology of the model that draws the same
  bool has_edge_flags = false;
};

constexpr std::array<Assembly, 10> kAssemblies{{
    {1, 1, {0}, 0, Topology::points},
    {2, 2, {0, 1}, 1, Topology::lines},
    {2, 1, {0, 1}, 1, Topology::line_loop},
    {2, 1, {0, 1}, 1, Topology::line_strip},
    {3, 3, {0, 1, 2}, 2, Topology::triangles, true},
    {3, 1, {0, 1, 2}, 2, Topology::triangle_strip},
    {3, 1, {0, 1, 2}, 2, Topology::triangle_fan},
    {4, 4, {0, 1, 2, 3}, 3, std::nullopt, true},
    {4, 2, {0, 1, 3, 2}, 2, std::nullopt},
    {3, 1, {}, 0, std::nullopt, true},  // all vertices are one polygon
}};

/// Calls visit(places, provoking) for each primitive that `count` vertices make.
template <class Visit>
void for_each_primitive(GLenum mode, std::size_t count, const Visit& visit) {
  const Assembly& assembly = kAssemblies[mode];
  if (mode == GL_POLYGON) {
    if (count > 2) visit(counting(count), 0);
    return;
  }
  std::array<std::uint32_t, 4> place{};
  for (std::size_t first = 0; first + assembly.size <= count; first += assembly.step) {
    for (std::size_t i = 0; i < assembly.size; ++i) place[i] = static_cast<std::uint32_t>(first + assembly.order[i]);
    if (mode == GL_TRIANGLE_FAN) place[0] = 0;
    const bool is_turned = mode == GL_TRIANGLE_STRIP && first % 2 == 1;
    if (is_turned) std::swap(place[0], place[1]);
    visit(std::span<const std::uint32_t>(place).first(assembly.size), assembly.provoking);
  }
  place = {static_cast<std::uint32_t>(count - 1), 0};
  if (mode == GL_LINE_LOOP && count > 1) visit(std::span<const std::uint32_t>(place).first(2), 1);
}

enum class Shape { point, line, polygon };
Shape shape_of(GLenum mode) {
  return mode == GL_POINTS ? Shape::point : mode <= GL_LINE_STRIP ? Shape::line : Shape::polygon;
}

/// Whether polygons are filled, on both sides.
bool is_filled(const PolygonState& polygon) { return polygon.mode == std::array<GLenum, 2>{GL_FILL, GL_FILL}; }

bool is_taken_apart(Context& context, Shape shape, const ShadedVertices& vertices,
                    std::span<const std::uint32_t> indices, const BatchTraits& traits) {
  const gl::State& state = context.state;
  const auto is_set = [](bool b) { return b; };
  if (context.render_mode != GL_RENDER || std::ranges::any_of(state.transform.clip_enabled, is_set)) return true;
  if (shape == Shape::polygon) return !is_filled(state.polygon) || state.polygon.stipple || traits.is_two_sided;
  if (draw_setup(context).units != 0) return true;
  const auto bends = [&](std::uint32_t a, std::uint32_t b) { return fog_bends(state.fog, vertices[a], vertices[b]); };
  if (shape == Shape::line && state.fog.enabled && std::ranges::adjacent_find(indices, bends) != indices.end())
    return true;
  if (shape == Shape::line) return state.line.stipple;
  const auto size = [&](std::uint32_t i) { return vertices.number(i, ShadedVertices::kPointSize); };
  return std::ranges::any_of(indices, [&](std::uint32_t i) { return size(i) != size(indices[0]); });
}

}  // namespace

void draw_vertices(Context& context, GLenum mode, const InputVertices& vertices, const InputVertices::Values& values,
                   std::span<const std::uint32_t> indices) {
  if (mode > GL_POLYGON || vertices.empty() || indices.empty()) return;
  const bool is_drawn = context.render_mode == GL_RENDER;
  if (is_drawn && context.drawable == nullptr) return;
  const bool is_outside = place_vertices(context, vertices, context.shaded) && context.shaded.empty();
  if (is_outside && is_drawn && shape_of(mode) == Shape::polygon && is_filled(context.state.polygon) &&
      !context.drawable->frame.options().keeps_draws())
    return;  // it draws no pixel, and is no part of a capture or a figure
  finish_vertices(context, vertices, values, context.shaded);
  draw_primitives(context, mode, context.shaded, indices);
}

void draw_primitives(Context& context, GLenum mode, const ShadedVertices& vertices,
                     std::span<const std::uint32_t> indices) {
  if (mode > GL_POLYGON || vertices.empty() || indices.empty()) return;
  if (context.render_mode == GL_RENDER && context.drawable == nullptr) return;
  const Assembly& assembly = kAssemblies[mode];
  const Shape shape = shape_of(mode);
  const BatchTraits traits = traits_of(vertices, draw_setup(context).unit);
  const char* const beyond = context.render_mode == GL_RENDER ? why_shaded(context, traits) : nullptr;
  if (beyond != nullptr) context.drawable->frame.missing(beyond, "the host shades its fragments");
  Pipeline pipeline(context, beyond != nullptr);
  if (beyond == nullptr && !is_taken_apart(context, shape, vertices, indices, traits)) {
    BatchKind group{.topology = assembly.topology.value_or(Topology::triangles)};
    if (shape == Shape::line) group.kind = DrawKind::lines;
    if (shape == Shape::point) {
      group.kind = DrawKind::points;
      group.point_size = pipeline.point_size(vertices[indices[0]]);
    }
    if (assembly.topology) return draw_batch(context, group, vertices, indices, traits);
    std::vector<std::uint32_t>& triangles = empty_scratch<std::uint32_t>();
    for_each_primitive(mode, indices.size(), [&](std::span<const std::uint32_t> place, std::size_t last) {
      const std::size_t corners = place.size();
      for (std::size_t i = 1; i + 1 < corners; ++i)
        for (const std::size_t corner : {last + i, last + i + 1, last})
          triangles.push_back(indices[place[corner % corners]]);
    });
    return draw_batch(context, group, vertices, triangles, traits);
  }
  bool resets = true;
  for_each_primitive(mode, indices.size(), [&](std::span<const std::uint32_t> place, std::size_t provoking) {
    Vertices primitive;
    for (const std::uint32_t p : place) {
      primitive.push_back(vertices[indices[p]]);
      primitive.back().edge_flag |= !assembly.has_edge_flags;
    }
    pipeline.primitive(std::move(primitive), provoking, resets);
    resets = mode == GL_LINES;
  });
  pipeline.flush();
}

void draw_fragments(Context& context, std::span<const WindowFragment> fragments) {
  if (context.drawable == nullptr) return;
  const Frame& frame = context.drawable->frame;
  constexpr std::size_t kMost = 4096;  // vertices are large
  ShadedVertices vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const WindowFragment& f = fragments[i];
    if (f.x >= 0 && f.x < frame.width() && f.y >= 0 && f.y < frame.height()) {
      ShadedVertex v;
      v.clip = {f.x + 0.5, f.y + 0.5, held(f.z), f.w};
      v.color.fill(f.color);
      v.fog_distance = f.w;
      vertices.push_back(v);
      indices.push_back(static_cast<std::uint32_t>(indices.size()));
    }
    if (vertices.size() < kMost && i + 1 < fragments.size()) continue;
    if (!vertices.empty())
      draw_batch(context, {.kind = DrawKind::rectangle, .topology = Topology::points, .is_window = true}, vertices,
                 indices, traits_of(vertices, 0));
    vertices.clear();
    indices.clear();
  }
}

}  // namespace halfplane::gl
