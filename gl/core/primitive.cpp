// Primitives: from vertices to draws of the model. Those that the model draws as OpenGL does pass unchanged; the rest is
// taken apart here, primitive by primitive.
#include "primitive.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../../model/attributes.hpp"
#include "../../model/signature.hpp"
#include "context.hpp"

namespace halfplane::gl {
namespace {

/// State that one draw of the model shares.
struct Group {
  DrawKind kind = DrawKind::triangles;
  Topology topology = Topology::triangles;
  bool is_window = false;    ///< ShadedVertex::clip is x, y, z in the window, and the w of clip space
  bool is_stippled = false;  ///< polygons, in the window
  double point_size = 1;
  bool operator==(const Group&) const = default;
};

/// Memory of this thread that is kept from draw to draw.
template <class Element>
std::vector<Element>& empty_scratch() {
  thread_local std::vector<Element> elements;
  elements.clear();
  return elements;
}

bool makes_triangles(Topology topology) {
  return topology == Topology::triangles || topology == Topology::triangle_strip || topology == Topology::triangle_fan;
}

bool is_textured(const Context& context) { return sampled_texture(context, 0) != nullptr; }

double limited(double value) { return value > 0 ? std::min(value, 1.0) : 0; }

// ---- draws

double fog_factor(const FogState& fog, double distance) {
  const double x = fog.density * distance;
  if (fog.mode == GL_LINEAR) return limited((fog.end - distance) / (fog.end - fog.start));
  return limited(std::exp(fog.mode == GL_EXP ? -x : -x * x));
}

/// Whether fog between two vertices is not nearly linear.
bool fog_bends(const FogState& fog, const ShadedVertex& a, const ShadedVertex& b) {
  constexpr double kMost = 8 / 255.0;
  if (a.clip[3] <= 0 || b.clip[3] <= 0) return true;  // the distance has a least value between them
  return std::abs(fog_factor(fog, a.fog_distance) - fog_factor(fog, b.fog_distance)) > kMost;
}

/// State that decides how a batch of vertices is drawn.
struct BatchTraits {
  bool has_one_color = true, has_one_w = true, has_one_q = true, has_positive_q = true;
  bool has_secondary = false;
  bool is_fogged_by_w = true;  ///< clip w is the distance that fog takes
};

BatchTraits traits_of(std::span<const ShadedVertex> vertices) {
  BatchTraits traits;
  const ShadedVertex& first = vertices.front();
  for (const ShadedVertex& v : vertices) {
    traits.has_one_color &= v.color[0] == first.color[0] && v.secondary[0] == first.secondary[0];
    traits.has_one_w &= v.clip[3] == first.clip[3];
    traits.has_one_q &= v.tex_coord[0][3] == first.tex_coord[0][3];
    traits.has_positive_q &= v.tex_coord[0][3] > 0;
    for (std::size_t c = 0; c < 3; ++c) traits.has_secondary |= v.secondary[0][c] != 0;
    traits.is_fogged_by_w &= std::abs(std::abs(v.clip[3]) - v.fog_distance) <= 1e-6 * v.fog_distance;
  }
  return traits;
}

/// Draws vertices in their first colour.
class Batch {
 public:
  Batch(Context& context, const Group& group, std::span<const ShadedVertex> vertices,
        std::span<const std::uint32_t> indices)
      : context_(context), group_(group), vertices_(vertices), indices_(indices), traits_(traits_of(vertices)) {}

  void draw() {
    const bool takes_texture = makes_triangles(group_.topology) && !group_.is_stippled;
    const auto state = hardware_state(context_, group_.kind, takes_texture, use_);
    if (!state) return;
    state_ = *state;
    if (group_.is_window) state_.space = Space::window;
    if (group_.is_window && group_.kind != DrawKind::rectangle) cut_to_viewport();
    if (group_.topology == Topology::points) state_.point_size = group_.point_size;
    is_textured_ = state_.texture.has_value();
    if (group_.is_stippled) stipple();
    const FogState& fog = context_.state.fog;
    has_host_fog_ = fog.enabled && !(state_.fog && traits_.is_fogged_by_w);
    if (has_host_fog_) state_.fog.reset();
    if (has_host_fog_ && traits_.has_one_color) state_.shade = Shade::smooth;  // fog has not one colour
    const bool colors_differ = !traits_.has_one_color || (has_host_fog_ && !is_textured_);
    // Equally exact, and in hardware of any configuration.
    if (!colors_differ || traits_.has_one_w || state_.shade == Shade::flat) state_.color_interp = ColorInterp::affine;
    const Options& options = context_.drawable->frame.options();
    if (state_.color_interp == ColorInterp::perspective && !has_colors_over_w(options.config) &&
        options.on_missing != OnMissing::host) {
      missing("colours over w", "they are affine in the window; perspective.colors=1 has them");
      state_.color_interp = ColorInterp::affine;
    }
    place();
    paint([this](const ShadedVertex& v) { return main_color(v); });
    draw_in(context_, state_, group_.topology, model_, indices_);
    if (is_textured_ && traits_.has_secondary) add_secondary();
    if (is_textured_ && has_host_fog_) add_fog();
  }

 private:
  void missing(const char* what, const char* instead) { context_.drawable->frame.missing(what, instead); }

  /// As in clip space.
  void cut_to_viewport() {
    const ViewportState& v = context_.state.viewport;
    Rect& cut = state_.scissor ? *state_.scissor : state_.scissor.emplace(Rect{v.x, v.y, v.width, v.height});
    const auto limit = [](int& start, int& size, int low, int length) {
      const std::int64_t end = std::min(std::int64_t{start} + size, std::int64_t{low} + length);
      start = std::max(start, low);
      size = static_cast<int>(std::clamp<std::int64_t>(end - start, 0, kLargestViewport));
    };
    limit(cut.x, cut.width, v.x, v.width);
    limit(cut.y, cut.height, v.y, v.height);
    limit(cut.x, cut.width, 0, kLargestViewport);
    limit(cut.y, cut.height, 0, kLargestViewport);
    cut.x = std::min(cut.x, kLargestViewport);
    cut.y = std::min(cut.y, kLargestViewport);
  }

  /// Positions and texture coordinates. Where q differs, x y z w divided by q are the same place, and the interpolated value
  /// over w / q is the projected coordinate.
  void place() {
    const bool divides_w = is_textured_ && !traits_.has_one_q && traits_.has_positive_q;
    if (is_textured_ && !traits_.has_one_q) {
      if (!divides_w) missing("texture coordinates with a q of 0 or less", "q is 1 there");
      if (!traits_.has_one_color || state_.fog)
        missing("projective textures under colours or fog that change", "these are interpolated over w / q");
    }
    model_.reserve(vertices_.size());
    for (const ShadedVertex& v : vertices_) {
      Vec4 at = v.clip;
      const Vec4& tex = v.tex_coord[0];
      const double q = tex[3] > 0 || (traits_.has_one_q && tex[3] != 0) ? tex[3] : 1;
      if (divides_w)
        for (std::size_t c = group_.is_window ? 3 : 0; c < 4; ++c) at[c] /= q;
      Vertex& out = model_.emplace_back();
      out.x = at[0], out.y = at[1], out.z = at[2], out.w = at[3];
      if (group_.is_stippled) {
        out.u = at[0] / 32, out.v = at[1] / 32;
      } else if (is_textured_) {
        out.u = tex[0] / q, out.v = tex[1] / q;
        if (!std::isfinite(out.u)) out.u = 0;
        if (!std::isfinite(out.v)) out.v = 0;
      }
    }
  }

  template <class ColorOf>
  void paint(const ColorOf& color_of) {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const Vec4 color = color_of(vertices_[i]);
      for (std::size_t c = 0; c < 4; ++c) model_[i].rgba[c] = 255 * limited(color[c]);
    }
  }

  [[nodiscard]] Vec4 main_color(const ShadedVertex& v) const {
    Vec4 color = v.color[0];
    const Vec4& fog = context_.state.fog.color;
    const double f = has_host_fog_ && !is_textured_ ? fog_factor(context_.state.fog, v.fog_distance) : 1;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!is_textured_) color[c] = limited(color[c] + v.secondary[0][c]);
      if (f < 1) color[c] = f * color[c] + (1 - f) * fog[c];
      if (is_textured_ && use_.replaces_rgb) color[c] = 1;
    }
    if (is_textured_ && use_.replaces_alpha) color[3] = 1;
    // A texel of the stipple is alpha: the test must tell it from 0.
    if (group_.is_stippled && color[3] < 1 / 255.0) color[3] = 1 / 255.0;
    return color;
  }

  /// The pattern as a texture over the window, whose zeros the alpha test drops.
  void stipple() {
    if (is_textured(context_)) missing("stippled polygons with a texture", "they are drawn without the texture");
    const auto& rows = context_.state.stipple.row;
    SignatureHash hash;
    for (const std::uint32_t row : rows) hash.add(row);
    state_.texture = context_.drawable->frame.texture(hash.signature().low | std::uint64_t{1} << 63, [&rows] {
      halfplane::Texture texture;
      texture.name = "stipple";
      TextureLevel& level = texture.level.emplace_back(TextureLevel{32, 32, {}});
      for (const std::uint32_t row : rows)
        for (unsigned x = 0; x < 32; ++x) level.code.push_back((row >> (31 - x) & 1) != 0 ? 0xffffffffU : 0xffffff00U);
      return texture;
    });
    state_.texture_interp = TextureInterp::affine;
    const AlphaTest& test = state_.alpha_test;
    const bool fails_zero = test.func == DepthFunc::never || test.func == DepthFunc::greater ||
                            (test.func == DepthFunc::gequal && test.reference > 0) ||
                            (test.func == DepthFunc::equal && test.reference > 0) ||
                            (test.func == DepthFunc::notequal && test.reference == 0);
    if (test.func != DepthFunc::always && !fails_zero)
      missing("stippled polygons whose alpha test passes an alpha of 0", "they are drawn without the alpha test");
    if (!fails_zero) state_.alpha_test = {DepthFunc::greater, 0};
  }

  /// Draws colours over the batch, for features that the model's textures lack.
  template <class ColorOf>
  void draw_over(const char* what, BlendFactors blend, std::array<std::uint8_t, 3> fog_color, const ColorOf& color_of) {
    const ColorState& color = context_.state.color;
    if (state_.blend || color.logic_op || state_.stencil || state_.alpha_test.func != DepthFunc::always)
      return missing(what, "the texture is drawn without, as other fragment operations need its colour");
    missing(what, "it is drawn in another pass");
    halfplane::State over = state_;
    over.texture.reset();
    if (over.depth_write) over.depth_test = DepthFunc::equal;
    over.depth_write = false;
    over.blend = blend;
    over.color_mask[3] = false;
    over.fog_color = fog_color;
    paint(color_of);
    context_.drawable->frame.draw(over, group_.topology, model_, indices_);
  }

  void add_secondary() {
    draw_over("colours that are added to a texture", {BlendFactor::one, BlendFactor::one}, {0, 0, 0},
              [](const ShadedVertex& v) { return v.secondary[0]; });
  }

  void add_fog() {
    draw_over("fog of a texture by other distances than w", {BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha},
              state_.fog_color, [this](const ShadedVertex& v) {
                Vec4 color = context_.state.fog.color;
                color[3] = 1 - fog_factor(context_.state.fog, v.fog_distance);
                return color;
              });
  }

  Context& context_;
  Group group_;
  std::span<const ShadedVertex> vertices_;
  std::span<const std::uint32_t> indices_;
  BatchTraits traits_;
  halfplane::State state_;
  TextureUse use_;
  bool is_textured_ = false, has_host_fog_ = false;
  std::vector<Vertex>& model_ = empty_scratch<Vertex>();  // one batch is drawn at a time
};

void draw_batch(Context& context, const Group& group, std::span<const ShadedVertex> vertices,
                std::span<const std::uint32_t> indices) {
  if (!vertices.empty() && !indices.empty()) Batch(context, group, vertices, indices).draw();
}

// ---- clipping

template <std::size_t n>
std::array<double, n> mix(const std::array<double, n>& a, const std::array<double, n>& b, double t) {
  std::array<double, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] + t * (b[i] - a[i]);
  return out;
}
template <class Element, std::size_t n>
std::array<Element, n> mix(const std::array<Element, n>& a, const std::array<Element, n>& b, double t) {
  std::array<Element, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = mix(a[i], b[i], t);
  return out;
}

ShadedVertex mix(const ShadedVertex& a, const ShadedVertex& b, double t) {
  // The distance of a line that passes the eye has no sign: it is that of the mixed place, unless it is a coordinate.
  const auto is_depth = [](const ShadedVertex& v) { return v.fog_distance == std::abs(v.eye[2]); };
  ShadedVertex out{.eye = mix(a.eye, b.eye, t),
                   .clip = mix(a.clip, b.clip, t),
                   .color = mix(a.color, b.color, t),
                   .secondary = mix(a.secondary, b.secondary, t),
                   .tex_coord = mix(a.tex_coord, b.tex_coord, t),
                   .fog_distance = std::lerp(a.fog_distance, b.fog_distance, t),
                   .point_size = std::lerp(a.point_size, b.point_size, t),
                   .edge_flag = a.edge_flag};
  if (is_depth(a) && is_depth(b)) out.fog_distance = std::abs(out.eye[2]);
  return out;
}

/// Inside: the product with a vertex's member is not negative.
struct Plane {
  Vec4 ShadedVertex::*where;
  Vec4 equation;
  bool shows_cut;  ///< the edge along the cut is one of the polygon's
};

/// Planes near and far, then the sides, `margin` pixels farther out.
std::array<Plane, 6> view_volume(const ViewportState& viewport, double margin) {
  const double x = 1 + 2 * margin / viewport.width, y = 1 + 2 * margin / viewport.height;
  return {{{&ShadedVertex::clip, {0, 0, 1, 1}, false},
           {&ShadedVertex::clip, {0, 0, -1, 1}, false},
           {&ShadedVertex::clip, {1, 0, 0, x}, false},
           {&ShadedVertex::clip, {-1, 0, 0, x}, false},
           {&ShadedVertex::clip, {0, 1, 0, y}, false},
           {&ShadedVertex::clip, {0, -1, 0, y}, false}}};
}

double distance(const Plane& plane, const ShadedVertex& v) {
  const Vec4& at = v.*plane.where;
  return std::inner_product(at.begin(), at.end(), plane.equation.begin(), 0.0);
}

/// The same point for either order of the ends.
ShadedVertex cut(const ShadedVertex& inside, double from, const ShadedVertex& outside, double to) {
  return mix(inside, outside, from / (from - to));
}

using Vertices = std::vector<ShadedVertex>;

void clip_polygon(Vertices& vertices, const Plane& plane) {
  Vertices out;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const ShadedVertex &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
    const double from = distance(plane, a), to = distance(plane, b);
    const bool is_in = from >= 0;
    if (is_in) out.push_back(a);
    if (is_in == (to >= 0)) continue;
    out.push_back(is_in ? cut(a, from, b, to) : cut(b, to, a, from));
    out.back().edge_flag = is_in ? plane.shows_cut : a.edge_flag;
  }
  vertices = std::move(out);
}

/// Points, lines and polygons. Empty: nothing is left.
void clip(Vertices& vertices, std::span<const Plane> planes) {
  for (const Plane& plane : planes) {
    if (vertices.size() > 2) {
      clip_polygon(vertices, plane);
      if (vertices.size() < 3) vertices.clear();
      continue;
    }
    const Vertices whole = vertices;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const ShadedVertex &v = whole[i], &other = whole[whole.size() - 1 - i];
      const double at = distance(plane, v), beyond = distance(plane, other);
      if (at >= 0) continue;
      if (!(beyond >= 0) || !(at < 0)) return vertices.clear();
      vertices[i] = cut(other, beyond, v, at);
      vertices[i].edge_flag = v.edge_flag;
    }
  }
}

Vec4 window_position(const ViewportState& v, const Vec4& clip) {
  const double x = clip[0] / clip[3], y = clip[1] / clip[3], z = clip[2] / clip[3];
  return {v.x + (x + 1) / 2 * v.width, v.y + (y + 1) / 2 * v.height, v.near + limited((z + 1) / 2) * (v.far - v.near),
          clip[3]};
}

// ---- primitives one by one

/// Takes primitives apart until the model, feedback or selection can take them.
class Pipeline {
 public:
  explicit Pipeline(Context& context)
      : context_(context),
        state_(context.state),
        is_textured_(is_textured(context)),
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
    draw_batch(context_, group_, pending_, indices_);
    pending_.clear();
  }

 private:
  void add(const Group& group, const Vertices& vertices) {
    if (group != group_) flush();
    group_ = group;
    pending_.insert(pending_.end(), vertices.begin(), vertices.end());
  }

  /// Triangles of a polygon, each with the vertex `last` at its end.
  void add_fan(const Group& group, const Vertices& v, std::size_t last) {
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
    if (!is_fed_ && !state_.polygon.stipple) return add_fan({}, vertices, provoking < vertices.size() ? provoking : 0);
    if (!to_window(vertices)) return;
    if (is_fed_) return feed_primitive(context_, GL_POLYGON_TOKEN, vertices);
    add_fan({.is_window = true, .is_stippled = true}, vertices, 0);
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
    if (!is_fed_ && !is_textured_) return add({DrawKind::points, Topology::points, false, false, size}, vertices);
    if (!to_window(vertices)) return;
    if (is_fed_) return feed_primitive(context_, GL_POINT_TOKEN, vertices);
    if (state_.point.smooth) missing("smooth points with a texture", "they are squares");
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

  /// In window coordinates: places are linear there, attributes over w.
  [[nodiscard]] static ShadedVertex window_mix(const ShadedVertex& a, const ShadedVertex& b, double t) {
    const double per_w = (1 - t) / a.clip[3] + t / b.clip[3];
    ShadedVertex v = mix(a, b, t / b.clip[3] / per_w);
    v.clip = mix(a.clip, b.clip, t);
    v.clip[3] = 1 / per_w;
    return v;
  }

  /// The model fogs the ends of a line: a line is halved until the error is invisible.
  void fogged_piece(const ShadedVertex& a, const ShadedVertex& b, int halvings) {
    if (halvings == 0 || !fog_bends(a, b)) return add({DrawKind::lines, Topology::lines, true, false, 1}, {a, b});
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
      for (std::size_t c = 0; c < 2; ++c)
        corner[i].clip[c] += (i < 2 ? -along[c] : along[c]) + (i % 2 == 0 ? -across[c] : across[c]);
    }
    missing(kind == DrawKind::points ? "textured points" : "textured lines", "they are drawn as two triangles");
    add({kind, Topology::triangles, true, false, 1},
        {corner[0], corner[2], corner[3], corner[0], corner[3], corner[1]});
  }

 public:
  [[nodiscard]] double point_size(const ShadedVertex& v) const {
    const double size = v.point_size > 1 ? std::min<double>(v.point_size, kLargestPoint) : 1;
    return state_.point.smooth ? size : std::rint(size);
  }

 private:
  void missing(const char* what, const char* instead) const {
    if (context_.drawable != nullptr) context_.drawable->frame.missing(what, instead);
  }

  static constexpr int kFogHalvings = 6;

  Context& context_;
  const gl::State& state_;
  const bool is_textured_, is_fed_;
  std::vector<Plane> user_planes_;
  std::uint64_t stipple_at_ = 0;  ///< pixels since the stipple was reset
  Group group_;
  Vertices pending_;
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
  std::vector<std::size_t> place;
  if (mode == GL_POLYGON) {
    place.resize(count);
    std::iota(place.begin(), place.end(), std::size_t{0});
    if (count > 2) visit(place, 0);
    return;
  }
  for (std::size_t first = 0; first + assembly.size <= count; first += assembly.step) {
    place.assign(assembly.order.begin(), assembly.order.begin() + static_cast<std::ptrdiff_t>(assembly.size));
    for (std::size_t& p : place) p += first;
    if (mode == GL_TRIANGLE_FAN) place[0] = 0;
    const bool is_turned = mode == GL_TRIANGLE_STRIP && first % 2 == 1;
    if (is_turned) std::swap(place[0], place[1]);
    visit(place, assembly.provoking);
  }
  place = {count - 1, 0};
  if (mode == GL_LINE_LOOP && count > 1) visit(place, 1);
}

enum class Shape { point, line, polygon };
Shape shape_of(GLenum mode) {
  return mode == GL_POINTS ? Shape::point : mode <= GL_LINE_STRIP ? Shape::line : Shape::polygon;
}

bool is_taken_apart(const Context& context, Shape shape, std::span<const ShadedVertex> vertices,
                    std::span<const std::uint32_t> indices) {
  const gl::State& state = context.state;
  const auto is_set = [](bool b) { return b; };
  if (context.render_mode != GL_RENDER || std::ranges::any_of(state.transform.clip_enabled, is_set)) return true;
  if (shape == Shape::polygon) {
    const auto is_two_sided = [](const ShadedVertex& v) {
      return v.color[0] != v.color[1] || v.secondary[0] != v.secondary[1];
    };
    return state.polygon.mode != std::array<GLenum, 2>{GL_FILL, GL_FILL} || state.polygon.stipple ||
           std::ranges::any_of(vertices, is_two_sided);
  }
  if (is_textured(context)) return true;
  const auto bends = [&](std::uint32_t a, std::uint32_t b) { return fog_bends(state.fog, vertices[a], vertices[b]); };
  if (shape == Shape::line && state.fog.enabled && std::ranges::adjacent_find(indices, bends) != indices.end())
    return true;
  const auto other_size = [&](const ShadedVertex& v) { return v.point_size != vertices.front().point_size; };
  return shape == Shape::line ? state.line.stipple : std::ranges::any_of(vertices, other_size);
}

}  // namespace

void draw_primitives(Context& context, GLenum mode, std::span<const ShadedVertex> vertices,
                     std::span<const std::uint32_t> indices) {
  if (mode > GL_POLYGON || vertices.empty() || indices.empty()) return;
  if (context.render_mode == GL_RENDER && context.drawable == nullptr) return;
  const Assembly& assembly = kAssemblies[mode];
  const Shape shape = shape_of(mode);
  Pipeline pipeline(context);
  if (!is_taken_apart(context, shape, vertices, indices)) {
    Group group{.topology = assembly.topology.value_or(Topology::triangles)};
    if (shape == Shape::line) group.kind = DrawKind::lines;
    if (shape == Shape::point) {
      group.kind = DrawKind::points;
      group.point_size = pipeline.point_size(vertices[indices[0]]);
    }
    if (assembly.topology) return draw_batch(context, group, vertices, indices);
    std::vector<std::uint32_t>& triangles = empty_scratch<std::uint32_t>();
    for_each_primitive(mode, indices.size(), [&](const std::vector<std::size_t>& place, std::size_t last) {
      const std::size_t corners = place.size();
      for (std::size_t i = 1; i + 1 < corners; ++i)
        for (const std::size_t corner : {last + i, last + i + 1, last})
          triangles.push_back(indices[place[corner % corners]]);
    });
    return draw_batch(context, group, vertices, triangles);
  }
  bool resets = true;
  for_each_primitive(mode, indices.size(), [&](const std::vector<std::size_t>& place, std::size_t provoking) {
    Vertices primitive;
    for (const std::size_t p : place) {
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
  Vertices vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const WindowFragment& f = fragments[i];
    if (f.x >= 0 && f.x < frame.width() && f.y >= 0 && f.y < frame.height()) {
      ShadedVertex& v = vertices.emplace_back();
      v.clip = {f.x + 0.5, f.y + 0.5, limited(f.z), f.w};
      v.color.fill(f.color);
      v.fog_distance = f.w;
      indices.push_back(static_cast<std::uint32_t>(indices.size()));
    }
    if (vertices.size() < kMost && i + 1 < fragments.size()) continue;
    draw_batch(context, {DrawKind::rectangle, Topology::points, true, false, 1}, vertices, indices);
    vertices.clear();
    indices.clear();
  }
}

}  // namespace halfplane::gl
