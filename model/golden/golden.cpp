#include "golden.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "clip.hpp"
#include "depth_format.hpp"
#include "fog.hpp"
#include "fragment_buffer.hpp"
#include "homogeneous.hpp"
#include "interpolate.hpp"
#include "line.hpp"
#include "phong.hpp"
#include "polygon_offset.hpp"
#include "primitive_assembly.hpp"
#include "triangle_setup.hpp"
#include "viewport.hpp"

namespace halfplane::golden {
namespace {

constexpr std::array<int, 4> kMax565{31, 63, 31, 0}, kMax8888{255, 255, 255, 255};
constexpr std::array<int, 4> kShift565{11, 5, 0, 0}, kShift8888{0, 8, 16, 24};

const std::array<int, 4>& channel_shift(ColorFormat format) {
  return format == ColorFormat::rgb565 ? kShift565 : kShift8888;
}

/// floor(value + 1/2), clamped to 0...max; NaN becomes 0.
std::uint32_t round_to_code(double value, double max) {
  return value > 0 ? static_cast<std::uint32_t>(std::min(std::floor(value + 0.5), max)) : 0;
}

std::uint32_t pack_color(const std::array<double, 4>& rgba, ColorFormat format) {
  const auto max = channel_max(format);
  std::uint32_t color = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channel_count(format)); ++c)
    color |= round_to_code(rgba[c] * max[c] / 255, max[c]) << channel_shift(format)[c];
  return color;
}

template <class Real>
std::array<double, 4> widen(const std::array<Real, 4>& v) {
  return {v[0], v[1], v[2], v[3]};
}

/// The scene in one scalar type: the whole pipeline, one primitive after the other.
template <class Real>
class Renderer {
 public:
  Renderer(const Scene& scene, const Config& config, const Options& options)
      : scene_(scene),
        config_(config),
        options_(options),
        depth_max_(std::ldexp(1.0, config.depth_bits) - 1),
        depth_buffer_(config, scene.planes),
        samples_(static_cast<std::size_t>(config.msaa_samples)),
        pixels_(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height) * samples_, Real(1), {},
                config.color_format == ColorFormat::rgba8888) {
    const auto pixels = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
    const SamplePattern pattern = resolved_pattern(config.msaa_pattern, config.msaa_samples);
    const auto in_pixels = [](int place) { return static_cast<Real>(std::ldexp(place, -kPatternFraction)); };
    for (std::size_t k = 0; k < samples_; ++k)
      place_[k] = {in_pixels(pattern.place[k].x), in_pixels(pattern.place[k].y)};
    image_.width = scene.width;
    image_.height = scene.height;
    image_.count.assign(pixels, 0);
    image_.depth.resize(pixels);
    image_.frame = Framebuffer(scene.width, scene.height, config.tile_size);
    fill({0, 0, scene.width, scene.height}, Clear{0, std::array<double, 4>{0, 0, 0, 255}, 1.0});  // an empty target
  }

  Image run() && {
    for (std::size_t i = 0; i < scene_.commands.size(); ++i) {
      if (const auto* clear = std::get_if<Clear>(&scene_.commands[i]))
        fill(clear_region(scene_, scene_.states[clear->state]), *clear);
      if (const auto* draw = std::get_if<Draw>(&scene_.commands[i])) this->draw(*draw, static_cast<std::uint32_t>(i));
    }
    if (samples_ == 1) {
      image_.ids = pixels_.owners();
      image_.color = pixels_.values();
    } else {
      split_samples();
    }
    round_frame();
    return std::move(image_);
  }

 private:
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x);
  }

  std::size_t first_sample(std::size_t pixel) const { return pixel * samples_; }

  /// Splits the samples into images, and computes the pixels from them.
  void split_samples() {
    const std::size_t pixels = image_.count.size();
    image_.samples.resize(samples_);
    for (std::size_t k = 0; k < samples_; ++k) {
      Samples& of = image_.samples[k];
      for (std::size_t p = 0; p < pixels; ++p) {
        const std::size_t at = first_sample(p) + k;
        of.ids.push_back(pixels_.owners()[at]);
        of.color.push_back(pixels_.value(at));
        of.depth.push_back(static_cast<double>(pixels_.depth(at)) * depth_max_);
      }
    }
    image_.ids = image_.samples.front().ids;
    image_.color.assign(pixels, {});
    for (const Samples& of : image_.samples)
      for (std::size_t p = 0; p < pixels; ++p)
        for (std::size_t c = 0; c < 4; ++c) image_.color[p][c] += of.color[p][c] / static_cast<double>(samples_);
  }

  /// Rounds the final real values: no intermediate depends on the codes.
  void round_frame() {
    for (int y = 0; y < image_.height; ++y) {
      for (int x = 0; x < image_.width; ++x) {
        const std::size_t p = pixel(x, y), at = image_.frame.at(x, y);
        const auto z = static_cast<double>(pixels_.depth(first_sample(p)));
        image_.depth[p] = z * depth_max_;
        image_.frame.depth[at] = depth_buffer_.code(depth_buffer_.stored_depth(z));
        image_.frame.color[at] = pack_color(image_.color[p], config_.color_format);
      }
    }
  }

  void fill(const PixelRange& range, const Clear& clear) {
    for (int y = range.begin_y; y < range.end_y; ++y) {
      for (int x = range.begin_x; x < range.end_x; ++x) {
        const std::size_t first = first_sample(pixel(x, y));
        for (std::size_t p = first; p < first + samples_; ++p) {
          if (clear.depth) pixels_.clear_depth(p, static_cast<Real>(depth_buffer_.window_depth(*clear.depth)));
          if (clear.color) pixels_.clear_value(p, *clear.color);
          if (clear.stencil) pixels_.clear_stencil(p, *clear.stencil);
          pixels_.disown(p);
        }
      }
    }
  }

  [[nodiscard]] PixelRange wanted(const PixelRange& range) const {
    if (!options_.only) return range;
    const Rect& only = *options_.only;
    return intersect(range, {only.x, only.y, only.x + only.width, only.y + only.height});
  }

  [[nodiscard]] double subpixel() const { return std::ldexp(1.0, -config_.subpixel_bits); }

  /// One draw, and its current primitive.
  struct DrawAtWork {
    const State& state;
    const Viewport vp;
    const std::array<Plane<Real>, 6> planes;
    const std::array<Plane<Real>, 6> rectangle_planes;  ///< of a smaller guard band: so that the line's width fits too
    const PixelRange region;
    const std::uint32_t command;
    std::uint32_t primitive = 0;
    Real offset = 0;  ///< polygon offset, window depth
    bool was_cut = false, was_drawn = false;
    bool is_back = false;       ///< of a filled triangle that shows its back
    bool is_rectangle = false;  ///< the current triangle is half of a line
    /// The current triangle with its normals as colours, if its fragments are lit: one of the two.
    std::optional<Setup<Real>> normals{};
    std::optional<HomogeneousSetup<Real>> homogeneous_normals{};
  };

  void draw(const Draw& draw, std::uint32_t command) {
    const State& state = scene_.states[draw.state];
    if (state.space == Space::clip) refuse_huge(draw);
    const Viewport vp = viewport_of(scene_, state);
    DrawAtWork d{state,
                 vp,
                 clip_planes<Real>(state.clip_z, vp, config_.guard_band - subpixel()),
                 clip_planes<Real>(state.clip_z, vp, config_.guard_band - 2 * subpixel() - state.line_width / 2),
                 wanted(draw_region(scene_, state)),
                 command};
    std::size_t done = 0;
    for_each_primitive(scene_, draw, state.provoking, [&](const Primitive& p) {
      d.primitive = static_cast<std::uint32_t>(image_.counters.primitives_in++);
      d.offset = 0;
      d.was_cut = d.was_drawn = d.is_back = d.is_rectangle = false;
      d.normals.reset();
      d.homogeneous_normals.reset();
      std::array<ClipVertex<Real>, 3> v;
      for (std::size_t i = 0; i < 3; ++i)
        v[i] = vertex(p.index[i], state.shade == Shade::flat ? p.provoking : p.index[i]);
      if (p.corners == 3) {
        std::optional<Corners> normals;
        if (state.shade == Shade::phong) normals = with_normals(v, p);
        draw_triangle(v, normals ? &*normals : nullptr, d);
      }
      if (p.corners == 2) draw_line(v[0], v[1], d);
      if (p.corners == 1) draw_point(v[0], d);
      image_.counters.culled += d.was_drawn ? 0 : 1;
      image_.counters.drawn += d.was_drawn ? 1 : 0;
      image_.counters.clipped += d.was_drawn && d.was_cut ? 1 : 0;
      if (options_.progress && done++ % 64 == 0)
        options_.progress(static_cast<double>(draw.first + done) / static_cast<double>(scene_.indices.size()));
    });
  }

  /// The position of one vertex with the colour of another. Distances to the clip planes are sums of products with
  /// coordinates: they must fit binary64.
  void refuse_huge(const Draw& draw) const {
    for (std::size_t i = draw.first; i < draw.first + draw.count; ++i) {
      if (scene_.indices[i] == kRestart) continue;
      const Vertex& v = scene_.vertices[scene_.indices[i]];
      for (const double c : {v.x, v.y, v.z, v.w})
        if (!(std::abs(c) <= 1e300))
          throw InputError(scene_.name + ": vertex " + std::to_string(scene_.indices[i]) +
                           " has a clip coordinate beyond 1e300; use smaller ones, x y z w may be scaled together");
    }
  }

  ClipVertex<Real> vertex(std::uint32_t position, std::uint32_t color) const {
    const auto real = [](double value) { return static_cast<Real>(value); };
    const Vertex& v = scene_.vertices[position];
    const auto& rgba = scene_.vertices[color].rgba;
    return {{real(v.x), real(v.y), real(v.z), real(v.w)},
            {real(rgba[0]), real(rgba[1]), real(rgba[2]), real(rgba[3])},
            {real(v.u), real(v.v)}};
  }

  using Corners = std::array<ClipVertex<Real>, 3>;

  /// The vertices of a triangle with their normals as colours.
  Corners with_normals(Corners v, const Primitive& p) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const Direction n = unit(scene_.normal(p.index[i]));
      v[i].rgba = {static_cast<Real>(n[0]), static_cast<Real>(n[1]), static_cast<Real>(n[2]), 0};
    }
    return v;
  }

  /// From clip or window space to pixels.
  ScreenVertex<Real> screen(const ClipVertex<Real>& v, const DrawAtWork& d) const {
    return d.state.space == Space::clip ? to_screen(v, d.state, d.vp) : from_window(v, d.state, scene_);
  }

  /// `normals`: from with_normals(); null: fragments are not lit.
  void draw_triangle(const Corners& v, const Corners* normals, DrawAtWork& d) {
    if (options_.clipping == Clipping::homogeneous && d.state.space == Space::clip &&
        d.state.polygon_mode == PolygonMode::fill) {
      if (normals != nullptr) d.homogeneous_normals = setup_homogeneous(*normals, d.state, d.vp);
      return draw_homogeneous(v, d);
    }
    std::array<ScreenVertex<Real>, 9> corners;
    const std::span<const ScreenVertex<Real>> outline = clipped(v, corners, d);
    const PlaneNormal<Real> normal = plane_normal(outline);
    d.offset = polygon_offset(normal, d.state.polygon_offset, static_cast<Real>(depth_max_));
    if (d.state.polygon_mode == PolygonMode::fill) {
      if (normals == nullptr) return draw_fan(outline, {}, d);
      std::array<ScreenVertex<Real>, 9> of_normals;
      return draw_fan(outline, clipped(*normals, of_normals, d), d);
    }
    if (is_culled(normal.z, d.state)) return;
    d.was_cut = false;  // from here on edges are cut
    for (std::size_t i = 0; i < 3; ++i)
      d.state.polygon_mode == PolygonMode::line ? draw_line(v[i], v[(i + 1) % 3], d) : draw_point(v[i], d);
  }

  /// A triangle's polygon on the screen, in `corners`.
  std::span<const ScreenVertex<Real>> clipped(const Corners& v, std::array<ScreenVertex<Real>, 9>& corners,
                                              DrawAtWork& d) const {
    Polygon<Real> polygon;
    for (const auto& corner : v) polygon.push(corner);
    if (d.state.space == Space::clip) polygon = clip<Real>(polygon, d.planes, d.was_cut);
    for (std::size_t i = 0; i < polygon.count; ++i) corners[i] = screen(polygon.vertex[i], d);
    return {corners.data(), polygon.count};
  }

  /// `normals`: of the polygon's corners, as colours; empty: fragments are not lit.
  void draw_fan(std::span<const ScreenVertex<Real>> polygon, std::span<const ScreenVertex<Real>> normals,
                DrawAtWork& d) {
    const std::size_t start = polygon.size() > 3 ? fan_start(polygon, d.state) : 0;
    const auto place = [&](std::size_t k) { return (start + k) % polygon.size(); };
    const auto corner = [&](std::size_t k) { return polygon[place(k)]; };
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      std::array<ScreenVertex<Real>, 3> v{corner(0), corner(k), corner(k + 1)};
      if (is_culled(signed_area(v), d.state)) continue;
      d.is_back = shows_back(signed_area(v), d.state);
      d.was_drawn = true;
      add_outline(v, d);
      for (auto& vertex : v) vertex.z += d.offset;
      if (!normals.empty())
        d.normals = setup_triangle(std::array{normals[place(0)], normals[place(k)], normals[place(k + 1)]});
      rasterize(setup_triangle(v), d);
    }
  }

  void draw_homogeneous(const std::array<ClipVertex<Real>, 3>& v, DrawAtWork& d) {
    const HomogeneousSetup<Real> t = setup_homogeneous(v, d.state, d.vp);
    if (is_culled(t.determinant, d.state)) return;
    d.is_back = shows_back(t.determinant, d.state);
    const PixelRange range = homogeneous_range(t, d.region, scene_);
    const auto [per_x, per_y] = depth_slopes(t);
    d.was_drawn = !range.empty();
    d.offset =
        polygon_offset(PlaneNormal<Real>{per_x, per_y, 1}, d.state.polygon_offset, static_cast<Real>(depth_max_));
    for (int y = range.begin_y; y < range.end_y; ++y) {
      for (int x = range.begin_x; x < range.end_x; ++x) {
        const Real px = static_cast<Real>(x) + Real(0.5), py = static_cast<Real>(y) + Real(0.5);
        const std::array<Real, 3> e{t.edge[0].value(px, py), t.edge[1].value(px, py), t.edge[2].value(px, py)};
        ++image_.counters.samples_tested;
        if (!covers(t, e)) continue;
        Fragment<Real> fragment = fragment_at(t, e, d);
        fragment.z += d.offset;
        shade_triangle(x, y, fragment, d);
      }
    }
  }

  void draw_line(ClipVertex<Real> a, ClipVertex<Real> b, DrawAtWork& d) {
    const bool is_smooth = d.state.smooth && samples_ == 1;  // several samples are already smooth
    const bool is_rectangle = d.state.line_rule == LineRule::rectangle || is_smooth;
    const auto& planes = is_rectangle ? d.rectangle_planes : d.planes;
    if (d.state.space == Space::clip && !clip_segment<Real>(a, b, planes, d.was_cut)) return;
    std::array<ScreenVertex<Real>, 2> v{screen(a, d), screen(b, d)};
    if (is_rectangle) return draw_rectangle(v[0], v[1], is_smooth, d);
    add_outline(v, d);
    d.was_drawn = true;
    for (auto& end : v) {
      end.z += d.offset;
      add_fog(end.rgba, end.inverse_w, d.state);  // lines and points are fogged at their ends
    }
    const Line<Real> whole{v[0], v[1], d.state.line_rule, drops_last_pixel(d.state)};
    const int count = strands_of(d.state.line_width);
    for (int i = 0; i < count; ++i) {
      const Line<Real> line = strand(whole, i, count);
      for_each_candidate(line, d.region, 1, [&](int x, int y) {
        if (covers(line, x, y)) shade(x, y, interpolate(line, x, y, rules_of(d)), d);
      });
    }
  }

  /// A line as two triangles, with either side visible, or smooth.
  void draw_rectangle(ScreenVertex<Real> start, ScreenVertex<Real> end, bool is_smooth, DrawAtWork& d) {
    for (auto* v : {&start, &end}) add_fog(v->rgba, v->inverse_w, d.state);
    const auto corners = rectangle_about(start, end, d.state.line_width);
    if (!corners) return;
    d.is_rectangle = d.was_drawn = true;
    const auto& [a, b, c, e] = *corners;
    for (std::array<ScreenVertex<Real>, 3> v : {std::array{a, b, c}, std::array{c, e, a}}) {
      add_outline(v, d);
      for (auto& vertex : v) vertex.z += d.offset;
      if (!is_smooth && signed_area(v) != 0) rasterize(setup_triangle(v), d);
    }
    if (!is_smooth) return;
    const auto [left, right] = std::minmax({a.x, b.x, c.x, e.x});
    const auto [top, bottom] = std::minmax({a.y, b.y, c.y, e.y});
    const PixelRange range = intersect(d.region, pixel_range(left - 1, top - 1, right + 1, bottom + 1, scene_));
    for (int y = range.begin_y; y < range.end_y; ++y)
      for (int x = range.begin_x; x < range.end_x; ++x) {
        const double area = area_in_pixel(*corners, x, y);
        if (area <= 0) continue;
        Fragment<Real> fragment = beside(start, end, x, y);
        fragment.z += d.offset;
        fragment.rgba[3] *= static_cast<Real>(area);
        shade(x, y, fragment, d);
      }
  }

  void draw_point(const ClipVertex<Real>& v, DrawAtWork& d) {
    if (d.state.space == Space::clip && is_outside(v, d.state.clip_z, d.state.point_clip == PointClip::center)) return;
    ScreenVertex<Real> at = screen(v, d);
    add_outline(std::span(&at, 1), d);
    add_fog(at.rgba, at.inverse_w, d.state);
    d.was_drawn = true;
    if (d.state.smooth && samples_ == 1) return draw_smooth(at, d);
    const PixelRange range = intersect(d.region, point_range(at, d.state.point_size, scene_));
    const Fragment<Real> fragment{at.z + d.offset, at.rgba, {}};
    for (int y = range.begin_y; y < range.end_y; ++y)
      for (int x = range.begin_x; x < range.end_x; ++x)
        if (point_covers(at, d.state, x, y)) shade(x, y, fragment, d);
  }

  /// A point whose alpha is multiplied by its coverage of each pixel.
  void draw_smooth(const ScreenVertex<Real>& at, const DrawAtWork& d) {
    const PixelRange range = intersect(d.region, point_range(at, d.state.point_size + 2, scene_));
    for (int y = range.begin_y; y < range.end_y; ++y)
      for (int x = range.begin_x; x < range.end_x; ++x) {
        const double area = area_in_pixel(at, d.state, x, y);
        if (area <= 0) continue;
        Fragment<Real> fragment{at.z + d.offset, at.rgba, {}};
        fragment.rgba[3] *= static_cast<Real>(area);
        shade(x, y, fragment, d);
      }
  }

  void add_outline(std::span<const ScreenVertex<Real>> v, const DrawAtWork& d) {
    if (!options_.want_outlines) return;
    Outline outline{v.size(), d.primitive, d.command, {}, {}, {}, {}};
    for (std::size_t i = 0; i < v.size(); ++i) {
      outline.x[i] = v[i].x;
      outline.y[i] = v[i].y;
      outline.z[i] = v[i].z;
      outline.inverse_w[i] = v[i].inverse_w;
    }
    image_.outlines.push_back(outline);
  }

  /// The corner at which a clipped polygon's fan starts: the smallest (Y, X, Z) after the snap. The place of the
  /// diagonals is visible in affine colours, and the real coordinates of a level edge tie only up to rounding.
  std::size_t fan_start(std::span<const ScreenVertex<Real>> polygon, const State& state) const {
    std::array<std::array<double, 3>, 9> key{};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto& v = polygon[i];
      const double origin = config_.subpixel_bits == 0 ? first_pixel_offset(state) : 0;
      const auto snapped = [this, origin](Real value) {
        return std::floor(std::ldexp(static_cast<double>(value) - origin, config_.subpixel_bits) + 0.5);
      };
      key[i] = {snapped(v.y), snapped(v.x),
                std::floor(static_cast<double>(v.z) * (std::ldexp(1.0, config_.depth_bits) - 1) + 0.5)};
    }
    return static_cast<std::size_t>(
        std::min_element(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(polygon.size())) - key.begin());
  }

  void rasterize(const Setup<Real>& t, const DrawAtWork& d) {
    const auto [left, right] = std::minmax({t.v[0].x, t.v[1].x, t.v[2].x});
    const auto [top, bottom] = std::minmax({t.v[0].y, t.v[1].y, t.v[2].y});
    // One pixel wider on the far sides: edges, not the range, decide about a sample on the border.
    const Real margin = samples_ == 1 ? 0 : 1;  // samples lie before the centre too
    const PixelRange range =
        intersect(d.region, pixel_range(left - margin, top - margin, right + 1, bottom + 1, scene_));
    for (int y = range.begin_y; y < range.end_y; ++y) {
      for (int x = range.begin_x; x < range.end_x; ++x) {
        const Real px = static_cast<Real>(x) + Real(0.5), py = static_cast<Real>(y) + Real(0.5);
        const std::array<Real, 3> e{t.edge[0].value(px, py), t.edge[1].value(px, py), t.edge[2].value(px, py)};
        if (samples_ > 1) {
          sample_pixel(t, x, y, e, d);
          continue;
        }
        ++image_.counters.samples_tested;
        if (!(t.edge[0].inside(e[0]) && t.edge[1].inside(e[1]) && t.edge[2].inside(e[2]))) continue;
        shade_triangle(x, y, fragment_at(t, e, d), d);
      }
    }
  }

  using EdgeValues = std::array<Real, 3>;

  /// A pixel with several samples: coverage and depth of each, one colour: from the centre, whose edge values are
  /// given, or if that is not covered from the first covered sample.
  void sample_pixel(const Setup<Real>& t, int x, int y, const EdgeValues& centre, const DrawAtWork& d) {
    const auto is_inside = [&t](const EdgeValues& e) {
      return t.edge[0].inside(e[0]) && t.edge[1].inside(e[1]) && t.edge[2].inside(e[2]);
    };
    std::array<EdgeValues, kMaxPixelSamples> at{};
    std::optional<EdgeValues> shaded;
    if (is_inside(centre)) shaded = centre;
    unsigned covered = 0;
    for (std::size_t k = 0; k < samples_; ++k) {
      const Real px = static_cast<Real>(x) + place_[k].first, py = static_cast<Real>(y) + place_[k].second;
      at[k] = {t.edge[0].value(px, py), t.edge[1].value(px, py), t.edge[2].value(px, py)};
      ++image_.counters.samples_tested;
      if (!is_inside(at[k])) continue;
      covered |= 1U << k;
      if (!shaded) shaded = at[k];
    }
    if (covered == 0) return;
    Fragment<Real> fragment = with_surface(fragment_at(t, *shaded, d), d);
    for (std::size_t k = 0; k < samples_; ++k) {
      if ((covered >> k & 1U) == 0) continue;
      fragment.z = interpolate(t, at[k], rules_of(d)).z;
      store(x, y, k, fragment, d);
    }
  }

  [[nodiscard]] InterpolationRules rules_of(const DrawAtWork& d) const {
    return {options_.color_interp.value_or(d.state.color_interp),
            options_.texture_interp.value_or(d.state.texture_interp)};
  }

  /// Interpolated attributes of a triangle, in its light if it has one.
  template <class Triangle>
  [[nodiscard]] Fragment<Real> fragment_at(const Triangle& t, const EdgeValues& e, const DrawAtWork& d) const {
    Fragment<Real> fragment = interpolate(t, e, rules_of(d));
    if (d.normals) add_light(*d.normals, e, d.state, fragment.rgba);
    if (d.homogeneous_normals) add_light(*d.homogeneous_normals, e, d.state, fragment.rgba);
    return fragment;
  }

  /// `normals`: the triangle whose colours are normals, which are interpolated over w.
  template <class Triangle>
  static void add_light(const Triangle& normals, const EdgeValues& e, const State& state, std::array<Real, 4>& rgba) {
    const Color n = widen(interpolate(normals, e, {ColorInterp::perspective, TextureInterp::perspective}).rgba);
    const Color lit = in_light(state, widen(rgba), light_factors(state, {n[0], n[1], n[2]}));
    for (std::size_t c = 0; c < 4; ++c) rgba[c] = static_cast<Real>(lit[c]);
  }

  /// A fragment of a triangle: its texture and fog, if it has any, then shade().
  void shade_triangle(int x, int y, const Fragment<Real>& fragment, const DrawAtWork& d) {
    shade(x, y, with_surface(fragment, d), d);
  }

  Fragment<Real> with_surface(Fragment<Real> fragment, const DrawAtWork& d) const {
    if (d.is_rectangle) return fragment;
    if (d.state.texture) {
      const Texture& texture = scene_.textures[*d.state.texture];
      const Color color = combined(widen(fragment.rgba), filtered(texture, d.state, fragment.texture),
                                   d.state.texture_combine, has_alpha(texture.format), d.state.texture_constant);
      for (std::size_t c = 0; c < 4; ++c) fragment.rgba[c] = static_cast<Real>(color[c]);
    }
    add_fog(fragment.rgba, fragment.inverse_w, d.state);
    return fragment;
  }

  static void add_fog(std::array<Real, 4>& rgba, Real inverse_w, const State& state) {
    if (!state.fog) return;
    const Color color = in_fog(state, widen(rgba), fog_part(*state.fog, static_cast<double>(inverse_w)));
    for (std::size_t c = 0; c < 4; ++c) rgba[c] = static_cast<Real>(color[c]);
  }

  /// A fragment that covers its whole pixel.
  void shade(int x, int y, const Fragment<Real>& fragment, const DrawAtWork& d) {
    for (std::size_t k = 0; k < samples_; ++k) store(x, y, k, fragment, d);
  }

  /// Whether alpha to coverage draws a sample: the first samples, as many as alpha selects.
  [[nodiscard]] bool is_drawn(std::size_t sample, double alpha, const State& state) const {
    if (samples_ == 1 || !state.alpha_to_coverage) return true;
    return static_cast<double>(sample) < std::floor(alpha / 255 * static_cast<double>(samples_) + 0.5);
  }

  void store(int x, int y, std::size_t sample, Fragment<Real> fragment, const DrawAtWork& d) {
    if (samples_ > 1 && (d.state.sample_mask.value_or(~0U) >> sample & 1U) == 0) return;
    if (d.offset != 0) fragment.z = std::clamp(fragment.z, Real(0), Real(1));
    const std::size_t p = first_sample(pixel(x, y)) + sample;
    ++image_.counters.covered;
    ++image_.count[pixel(x, y)];
    const auto stored = static_cast<double>(pixels_.depth(p));
    const Color color = widen(fragment.rgba);
    const Fate fate = pixels_.apply(p, d.state, {fragment.z, color[3], d.is_back, is_drawn(sample, color[3], d.state)},
                                    color, static_cast<std::int32_t>(d.primitive));
    if (options_.fragment_tap)
      options_.fragment_tap({d.primitive, d.command, image_.outlines.empty() ? 0 : image_.outlines.size() - 1, x, y,
                             static_cast<int>(sample), static_cast<double>(fragment.z) * depth_max_,
                             stored * depth_max_, color, fate});
    image_.counters.depth_passed += fate.passed ? 1 : 0;
    image_.counters.alpha_killed += fate.killed ? 1 : 0;
    image_.counters.written += fate.written ? 1 : 0;
  }

  const Scene& scene_;
  const Config& config_;
  const Options& options_;
  double depth_max_;  // 2^B - 1
  const DepthBuffer depth_buffer_;
  Image image_;
  std::size_t samples_;                                          // of a pixel
  std::array<std::pair<Real, Real>, kMaxPixelSamples> place_{};  // of each sample, pixels from the upper left corner
  FragmentBuffer<Real, std::array<double, 4>> pixels_;           // window depth, 0...1; colour, 0...255
};

}  // namespace

std::array<int, 4> channel_max(ColorFormat format) { return format == ColorFormat::rgb565 ? kMax565 : kMax8888; }

int channel_count(ColorFormat format) { return format == ColorFormat::rgb565 ? 3 : 4; }

int stored_channel(std::uint32_t color, ColorFormat format, int channel) {
  const auto c = static_cast<std::size_t>(channel);
  return static_cast<int>(color >> channel_shift(format)[c] & static_cast<std::uint32_t>(channel_max(format)[c]));
}

Image render(const Scene& scene, const Config& config, const Options& options) {
  validate(config);
  validate(scene);
  if (config.msaa_samples > 1 && options.clipping == Clipping::homogeneous)
    throw InputError("msaa.samples: clipping homogeneous has one sample a pixel; use msaa.samples=1");
  if (scene.width < 1 || scene.height < 1 || scene.width > config.target_width || scene.height > config.target_height)
    throw InputError(scene.name + ": the target of " + std::to_string(scene.width) + "x" +
                     std::to_string(scene.height) + " does not fit " + std::to_string(config.target_width) + "x" +
                     std::to_string(config.target_height) + "; make it smaller or raise target.width, target.height");
  if (options.precision == Precision::binary32) return Renderer<float>(scene, config, options).run();
  return Renderer<double>(scene, config, options).run();
}

Image render(const Scene& scene, const Config& config, Precision precision) {
  Options options;
  options.precision = precision;
  return render(scene, config, options);
}

std::uint32_t rounded_color(const std::array<double, 4>& rgba, ColorFormat format) { return pack_color(rgba, format); }

}  // namespace halfplane::golden
