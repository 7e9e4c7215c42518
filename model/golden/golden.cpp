#include "golden.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "clip.hpp"
#include "depth_test.hpp"
#include "interpolate.hpp"
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

/// floor(value + 1/2), held inside 0...max; what is no number becomes 0.
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

/// The scene in one scalar type: the whole pipeline, one triangle after the other.
template <class Real>
class Renderer {
 public:
  Renderer(const Scene& scene, const Config& config, const Options& options)
      : scene_(scene), config_(config), options_(options), depth_max_(std::ldexp(1.0, config.depth_bits) - 1) {
    const auto pixels = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
    image_.width = scene.width;
    image_.height = scene.height;
    image_.count.assign(pixels, 0);
    image_.ids.assign(pixels, -1);
    image_.depth.resize(pixels);
    image_.affine.resize(pixels);
    image_.perspective.resize(pixels);
    image_.frame = Framebuffer(scene.width, scene.height, config.tile_size);
    z_.resize(pixels);
    stored_.resize(pixels);
    fill({0, 0, scene.width, scene.height}, Clear{0, std::array<double, 4>{0, 0, 0, 255}, 1.0});  // an empty target
  }

  Image run() && {
    for (std::size_t i = 0; i < scene_.commands.size(); ++i) {
      if (const auto* clear = std::get_if<Clear>(&scene_.commands[i]))
        fill(clear_region(scene_, scene_.states[clear->state]), *clear);
      if (const auto* draw = std::get_if<Draw>(&scene_.commands[i])) this->draw(*draw, static_cast<std::uint32_t>(i));
    }
    round_frame();
    return std::move(image_);
  }

 private:
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x);
  }

  void write_color(std::size_t p, const std::array<double, 4>& affine, const std::array<double, 4>& perspective,
                   ColorInterp stored) {
    image_.affine[p] = affine;
    image_.perspective[p] = perspective;
    stored_[p] = stored;
  }

  /// The real values at the end, rounded: nothing in between depends on the codes.
  void round_frame() {
    for (int y = 0; y < image_.height; ++y) {
      for (int x = 0; x < image_.width; ++x) {
        const std::size_t p = pixel(x, y), at = image_.frame.at(x, y);
        image_.depth[p] = static_cast<double>(z_[p]) * depth_max_;
        image_.frame.depth[at] = round_to_code(image_.depth[p], depth_max_);
        image_.frame.color[at] = pack_color(
            stored_[p] == ColorInterp::affine ? image_.affine[p] : image_.perspective[p], config_.color_format);
      }
    }
  }

  void fill(const PixelBox& box, const Clear& clear) {
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        const std::size_t p = pixel(x, y);
        if (clear.depth) z_[p] = static_cast<Real>(*clear.depth);
        if (clear.color) write_color(p, *clear.color, *clear.color, ColorInterp::affine);
        image_.ids[p] = -1;
      }
    }
  }

  void draw(const Draw& draw, std::uint32_t command) {
    const State& state = scene_.states[draw.state];
    const Viewport vp = viewport_of(scene_, state);
    const auto planes = clip_planes<Real>(state.clip_z, vp, config_.guard_band);
    const std::size_t count = triangle_count(draw);
    for (std::size_t i = 0; i < count; ++i) {
      auto vertices = triangle_vertices(scene_, draw, i);
      if (state.shade == Shade::flat) vertices[1].rgba = vertices[2].rgba = vertices[0].rgba;
      const auto primitive = static_cast<std::uint32_t>(image_.counters.primitives_in++);
      bool was_cut = false, was_drawn = false;
      Polygon<Real> polygon = assemble(vertices);
      if (state.space == Space::clip) polygon = clip<Real>(polygon, planes, was_cut);
      const std::size_t start = polygon.count > 3 ? fan_start(polygon, state, vp) : 0;
      const auto corner = [&](std::size_t k) { return polygon.vertex[(start + k) % polygon.count]; };
      for (std::size_t k = 1; k + 1 < polygon.count; ++k) {
        const std::array<ClipVertex<Real>, 3> part{corner(0), corner(k), corner(k + 1)};
        was_drawn |= draw_part(part, state, vp, primitive, command);
      }
      image_.counters.culled += was_drawn ? 0 : 1;
      image_.counters.drawn += was_drawn ? 1 : 0;
      image_.counters.clipped += was_drawn && was_cut ? 1 : 0;
      if (options_.progress && i % 64 == 0)
        options_.progress(static_cast<double>(draw.first + i) / static_cast<double>(scene_.indices.size()));
    }
  }

  static Polygon<Real> assemble(const std::array<Vertex, 3>& vertices) {
    Polygon<Real> polygon;
    for (const Vertex& v : vertices) {
      const auto real = [](double value) { return static_cast<Real>(value); };
      polygon.push({{real(v.x), real(v.y), real(v.z), real(v.w)},
                    {real(v.rgba[0]), real(v.rgba[1]), real(v.rgba[2]), real(v.rgba[3])}});
    }
    return polygon;
  }

  /// The corner that a clipped polygon's fan starts at: the smallest (Y, X, Z) after the snap. Where the diagonals lie shows
  /// in affine colours, and the real coordinates of a level edge tie only up to rounding.
  std::size_t fan_start(const Polygon<Real>& polygon, const State& state, const Viewport& vp) const {
    std::array<std::array<double, 3>, 9> key{};
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const auto v = to_screen(polygon.vertex[i], state, vp);
      const auto snapped = [](Real value, int bits) {
        return std::floor(std::ldexp(static_cast<double>(value), bits) + 0.5);
      };
      key[i] = {snapped(v.y, config_.subpixel_bits), snapped(v.x, config_.subpixel_bits),
                std::floor(static_cast<double>(v.z) * (std::ldexp(1.0, config_.depth_bits) - 1) + 0.5)};
    }
    return static_cast<std::size_t>(
        std::min_element(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(polygon.count)) - key.begin());
  }

  /// From clip or window space to pixels. False when it was culled.
  bool draw_part(const std::array<ClipVertex<Real>, 3>& part, const State& state, const Viewport& vp,
                 std::uint32_t primitive, std::uint32_t command) {
    std::array<ScreenVertex<Real>, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = state.space == Space::clip ? to_screen(part[i], state, vp) : from_window(part[i], state, scene_);
    }
    if (is_culled(signed_area(v), state)) return false;
    if (options_.want_outlines) {
      Outline outline{primitive, command, {}, {}, {}, {}};
      for (std::size_t i = 0; i < 3; ++i) {
        outline.x[i] = v[i].x;
        outline.y[i] = v[i].y;
        outline.z[i] = v[i].z;
        outline.inverse_w[i] = v[i].inverse_w;
      }
      image_.outlines.push_back(outline);
    }
    rasterize(setup_triangle(v), state, primitive);
    return true;
  }

  void rasterize(const Setup<Real>& t, const State& state, std::uint32_t primitive) {
    const auto [left, right] = std::minmax({t.v[0].x, t.v[1].x, t.v[2].x});
    const auto [top, bottom] = std::minmax({t.v[0].y, t.v[1].y, t.v[2].y});
    // One pixel wider on the far sides: a sample on the very border is decided by the edges, not by the box.
    const PixelBox box = intersect(draw_region(scene_, state), pixel_box(left, top, right + 1, bottom + 1, scene_));
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        const Real px = static_cast<Real>(x) + Real(0.5), py = static_cast<Real>(y) + Real(0.5);
        const std::array<Real, 3> e{t.edge[0].value(px, py), t.edge[1].value(px, py), t.edge[2].value(px, py)};
        ++image_.counters.samples_tested;
        if (!(t.edge[0].inside(e[0]) && t.edge[1].inside(e[1]) && t.edge[2].inside(e[2]))) continue;
        shade(x, y, interpolate(t, e), state, primitive);
      }
    }
  }

  void shade(int x, int y, const Fragment<Real>& fragment, const State& state, std::uint32_t primitive) {
    const std::size_t p = pixel(x, y);
    ++image_.counters.covered;
    ++image_.count[p];
    if (!passes(state.depth_test, fragment.z, z_[p])) return;
    ++image_.counters.depth_passed;
    if (!state.depth_write && !state.color_write) return;
    ++image_.counters.written;
    image_.ids[p] = static_cast<std::int32_t>(primitive);
    if (state.depth_write) z_[p] = fragment.z;
    if (state.color_write) write_color(p, widen(fragment.affine), widen(fragment.perspective), state.color_interp);
  }

  const Scene& scene_;
  const Config& config_;
  const Options& options_;
  double depth_max_;  // 2^B - 1
  Image image_;
  std::vector<Real> z_;              // the depth buffer that the test reads, 0...1
  std::vector<ColorInterp> stored_;  // which of the two colours the frame holds
};

}  // namespace

std::array<int, 4> channel_max(ColorFormat format) { return format == ColorFormat::rgb565 ? kMax565 : kMax8888; }

int channel_count(ColorFormat format) { return format == ColorFormat::rgb565 ? 3 : 4; }

int stored_channel(std::uint32_t color, ColorFormat format, int channel) {
  const auto c = static_cast<std::size_t>(channel);
  return static_cast<int>(color >> channel_shift(format)[c] & static_cast<std::uint32_t>(channel_max(format)[c]));
}

Image render(const Scene& scene, const Config& config, const Options& options) {
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

}  // namespace halfplane::golden
