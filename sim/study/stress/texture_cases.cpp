// Textures and colours over w: every fragment's coordinate, level, texel and colour against real arithmetic on its
// snapped vertices (SurfaceOracle), and pictures that must be equal to the bit.
#include <algorithm>
#include <cmath>

#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "sim/study/compare/fragment_judge.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/check.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

/// Called for each sample of a surface.
using SampleTap = std::function<void(const TappedFragment& fragment, const SurfaceSample& sample)>;

Texture random_texture(Unit& unit, int width, int height) {
  TexelImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    const std::uint64_t bits = unit.random.next();
    Texel& texel = image.texel.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) texel[c] = static_cast<std::uint8_t>(bits >> (8 * c));
  }
  constexpr std::array kFormats{TextureFormat::rgba8888, TextureFormat::rgb565, TextureFormat::la88};
  Texture texture = make_texture("t", image, kFormats[static_cast<std::size_t>(unit.random.index(3))], Mips::box);
  if (image.texel.front()[0] % 4 != 0) return texture;
  // Levels that have nothing to do with their image: the upper left texels of that, as they come.
  texture.mips = Mips::levels;
  for (std::size_t n = 1; n < texture.level.size(); ++n)
    std::copy_n(texture.level[0].code.begin(), texture.level[n].code.size(), texture.level[n].code.begin());
  return texture;
}

/// A side of 1 to 256 texels, half of them powers of two.
int random_side(Unit& unit) { return unit.random.coin() ? 1 << unit.random.index(9) : 1 + unit.random.index(256); }

State random_sampler(Unit& unit) {
  Random& random = unit.random;
  State state = SceneBuilder::window_state();
  state.texture = 0;
  state.texture_min = static_cast<TextureMin>(random.index(6));
  state.texture_mag = static_cast<TextureMag>(random.index(2));
  const auto wrap = [&] { return static_cast<TextureWrap>(random.index(5)); };
  state.texture_wrap = {wrap(), wrap()};
  state.texture_combine = static_cast<TextureCombine>(random.index(5));
  for (std::uint8_t& channel : state.texture_constant) channel = static_cast<std::uint8_t>(random.index(256));
  for (std::uint8_t& channel : state.texture_border) channel = static_cast<std::uint8_t>(random.index(256));
  return state;
}

/// A vertex with w, and a place on a texture in texels.
Vertex textured(Vertex vertex, double w, double u, double v, const Texture& texture) {
  vertex.w = w;
  vertex.u = u / texture.width();
  vertex.v = v / texture.height();
  return vertex;
}

/// w between 1 and `ratio`, including both.
std::array<double, 3> random_w(Random& random, double ratio) {
  std::array<double, 3> w{1, ratio, std::pow(ratio, random.unit())};
  std::rotate(w.begin(), w.begin() + random.index(3), w.end());
  return w;
}

/// Triangles with places within `texels` of 0 and w ratios up to 2^`octaves`.
Scene random_scene(Unit& unit, const State& state, Texture texture, double octaves, double texels) {
  const int width = unit.width(48), height = unit.height(40);
  Random& random = unit.random;
  SceneBuilder builder(width, height, state);
  for (int n = 0; n < 3; ++n) {
    const std::array<double, 3> w = random_w(random, std::exp2(random.between(0, octaves)));
    std::array<Vertex, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex at = random_vertex_at(unit, random_point(unit, width, height, 4));
      const double u = random.between(-texels, texels);
      v[i] = textured(at, w[i], u, random.between(-texels, texels), texture);
    }
    builder.triangle(v[0], v[1], v[2]);
  }
  builder.scene.textures.push_back(std::move(texture));
  return std::move(builder.scene);
}

/// Judges every fragment, and compares the engine's picture with the specification's. Returns the latter.
Rendering check_surfaces(Unit& unit, const Scene& scene, const SampleTap& tap = {}) {
  FragmentJudge judge(scene, unit.config);
  RenderOptions options = render_options();
  options.fragment_tap = [&](const TappedFragment& fragment) {
    judge.add(fragment);
    if (tap && fragment.surface) tap(fragment, *fragment.surface);
  };
  const Rendering rendering = unit.engine(scene, unit.config, options);
  const FragmentVerdict verdict = judge.finish(rendering);
  unit.count_triangles(rendering.triangles.size());
  unit.count_samples(verdict.fragments);
  const auto measure = [&](const char* property, const char* what, const Held& held) {
    if (std::isfinite(held.bound)) unit.measure(property, what, held.value, held.bound, scene);
  };
  measure("coordinate", "texels", verdict.surfaces.coordinate);
  measure("level", "levels", verdict.surfaces.level);
  measure("filter", "LSB", verdict.surfaces.filter);
  measure("color over w", "LSB", verdict.surfaces.color);
  const auto broken = broken_fragment_bounds(verdict, unit.config);
  unit.require(broken.empty(), "fragments", scene, broken.empty() ? "" : broken.front());
  Rendering drawn = unit.engine(scene, unit.config, {});
  expect_same_image(unit, scene, render_scalar(scene, unit.config), drawn);
  return drawn;
}

/// The same with whole periods added to every place: the picture must be equal.
void check_periods(Unit& unit, const Scene& scene) {
  const Rendering here = check_surfaces(unit, scene);
  Scene moved = scene;
  const auto& wrap = scene.states.back().texture_wrap;
  const auto periods = [&](std::size_t axis) {
    return !has_period(wrap[axis]) ? 0 : 2.0 * static_cast<double>(unit.random.integer(-500, 500));
  };
  const double u = periods(0), v = periods(1);
  for (Vertex& vertex : moved.vertices) {
    vertex.u += u;
    vertex.v += v;
  }
  expect_same_image(unit, moved, here, check_surfaces(unit, moved));
}

/// Places in multiples of 2^-10 of a power-of-two side, so that a period can be added without rounding.
Scene on_places(Unit& unit, const State& state, double octaves, double repeats) {
  const int side = 1 << unit.random.index(7);
  Scene scene = random_scene(unit, state, random_texture(unit, side, side), octaves, repeats / 2 * side);
  for (Vertex& vertex : scene.vertices) {
    vertex.u = std::round(vertex.u * 1024) / 1024;
    vertex.v = std::round(vertex.v * 1024) / 1024;
  }
  return scene;
}

/// A rectangle of grid points as two triangles, with the texture once over it.
Scene rectangle(Unit& unit, const State& state, Texture texture, Point from, Point to) {
  SceneBuilder builder(unit.width(32), unit.height(32), state);
  const auto at = [&](std::int64_t x, std::int64_t y, double u, double v) {
    return textured(random_vertex_at(unit, {x, y}), 1, u * texture.width(), v * texture.height(), texture);
  };
  const Vertex a = at(from.x, from.y, 0, 0), b = at(to.x, from.y, 1, 0), c = at(to.x, to.y, 1, 1),
               d = at(from.x, to.y, 0, 1);
  builder.triangle(a, b, c).triangle(a, c, d);
  builder.scene.textures.push_back(std::move(texture));
  return std::move(builder.scene);
}

}  // namespace

void textured_w_ratio(Unit& unit) {
  const double octaves = 20 * unit.random.unit(), texels = std::exp2(unit.random.between(0, 12));
  State state = random_sampler(unit);
  if (unit.random.coin()) state.color_interp = ColorInterp::perspective;
  const int width = random_side(unit);
  (void)check_surfaces(unit,
                       random_scene(unit, state, random_texture(unit, width, random_side(unit)), octaves, texels));
}

void textured_slivers(Unit& unit) {
  // Thin triangles across the target, and triangles that contain all of it.
  Random& random = unit.random;
  const int width = unit.width(32), height = unit.height(32), side = random_side(unit);
  const Texture texture = random_texture(unit, side, side);
  SceneBuilder builder(width, height, random_sampler(unit));
  const std::array<double, 3> w = random_w(random, std::exp2(random.between(0, 10)));
  const Point a = random_point(unit, width, height, 2), b = random_point(unit, width, height, 2);
  const std::int64_t thick = random.integer(-2 * unit.pixel(), 2 * unit.pixel()), p = unit.pixel();
  const bool is_full = random.coin();
  const std::array<Point, 3> thin{a, b, Point{(a.x + b.x) / 2 + thick, (a.y + b.y) / 2}};
  const std::array<Point, 3> full{Point{0, 0}, Point{unit.width(32) * 2 * p, 0}, Point{0, unit.height(32) * 2 * p}};
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point at = is_full ? full[i] : thin[i];
    const Point held{std::clamp(at.x, lowest(unit), highest(unit)), std::clamp(at.y, lowest(unit), highest(unit))};
    const double u = random.between(-200, 200);
    v[i] = textured(random_vertex_at(unit, held), w[i], u, random.between(-200, 200), texture);
  }
  builder.triangle(v[0], v[1], v[2]);
  builder.scene.textures.push_back(texture);
  (void)check_surfaces(unit, builder.scene);
}

void texel_borders(Unit& unit) {
  // Pixel centres on the borders of texels: either neighbour is valid, and no other. This follows from a coordinate
  // within its bound and its nearest texel.
  Random& random = unit.random;
  const int side = 1 << random.index(6), zoom = 1 << random.index(4);
  State state = random_sampler(unit);
  state.texture_min = TextureMin::nearest;
  state.texture_mag = TextureMag::nearest;
  Scene scene = rectangle(unit, state, random_texture(unit, side, side), {0, 0},
                          {std::int64_t{unit.width(32)} * unit.pixel(), std::int64_t{unit.height(32)} * unit.pixel()});
  const double w = std::exp2(random.index(5));
  for (Vertex& vertex : scene.vertices) {
    vertex.w = vertex.x > 0 ? w : 1;  // w 1, 2, 4...: centres meet borders where it is 1
    vertex.u = (vertex.x - 0.5) / zoom / side;
    vertex.v = (vertex.y - 0.5) / zoom / side;
  }
  (void)check_surfaces(unit, scene);
}

void texture_repeats(Unit& unit) {
  State state = random_sampler(unit);
  state.texture_wrap = {TextureWrap::repeat, unit.random.coin() ? TextureWrap::repeat : TextureWrap::clamp};
  check_periods(unit, on_places(unit, state, 8, 16));
}

void texture_mirrors(Unit& unit) {
  State state = random_sampler(unit);
  state.texture_wrap = {TextureWrap::mirror, static_cast<TextureWrap>(unit.random.index(3))};
  Scene scene = on_places(unit, state, 8, 6);
  for (Vertex& vertex : scene.vertices) vertex.u = -std::abs(vertex.u);
  check_periods(unit, scene);
}

void texture_of_one_texel(Unit& unit) {
  State state = random_sampler(unit);
  Scene scene = random_scene(unit, state, random_texture(unit, 1, 1), 20, 100);
  const Texel only = scene.textures[0].texel(0, 0, 0);
  for (State& drawn : scene.states) drawn.texture_border = only;
  std::uint64_t wrong = 0;
  (void)check_surfaces(unit, scene, [&](const TappedFragment&, const SurfaceSample& s) { wrong += s.texel != only; });
  unit.measure("texel", "samples", static_cast<double>(wrong), 0, scene);
}

void constant_coordinate(Unit& unit) {
  // On the grid of the result and within half of its step, a constant stays that constant.
  const PerspectiveFormat format = perspective_format(unit.config);
  const double step = std::ldexp(1.0, -format.coordinate.fraction_bits), octaves = 6 * unit.random.unit();
  const int side = 1 << unit.random.index(8);
  Scene scene = random_scene(unit, random_sampler(unit), random_texture(unit, side, side), octaves, 50);
  const double u = std::floor(unit.random.between(-side, side) / step) * step / side;
  for (Vertex& vertex : scene.vertices) vertex.u = u;
  double worst = 0;
  (void)check_surfaces(unit, scene, [&](const TappedFragment&, const SurfaceSample& s) {
    worst = std::max(worst, std::abs(s.coordinate[0] - u * side));
  });
  if (over_w_bound(0, std::exp2(octaves), format, format.coordinate, plane_roundings(unit.config)) < step)
    unit.measure("constant", "texels", worst, 0, scene);
}

void equal_w(Unit& unit) {
  // A power of two everywhere gives the codes of an affine attribute.
  Random& random = unit.random;
  State state = random_sampler(unit);
  Scene scene = random_scene(unit, state, random_texture(unit, 64, 64), 0, 200);
  const double w = random.coin() ? std::ldexp(1.0, random.index(20) - 10) : random.between(0.01, 100);
  for (Vertex& vertex : scene.vertices) vertex.w = w;
  const Rendering over_w = check_surfaces(unit, scene);
  if (std::exp2(std::round(std::log2(w))) != w) return;
  Scene affine = scene;
  affine.states.back().texture_interp = TextureInterp::affine;
  expect_same_image(unit, affine, over_w, check_surfaces(unit, affine));
}

void q_near_one(Unit& unit) {
  // w just next to a power of two: Q at the ends of its range, mantissas of all ones and of zeros.
  Random& random = unit.random;
  Scene scene = random_scene(unit, random_sampler(unit), random_texture(unit, 64, 64), 0, 300);
  for (Vertex& vertex : scene.vertices) {
    const double near = std::ldexp(random.between(-1, 1), -8 - random.index(24));
    vertex.w = std::ldexp(1 + near, random.index(3));
  }
  (void)check_surfaces(unit, scene);
}

void wrap_across_a_tile(Unit& unit) {
  // A border of the image every few pixels.
  State state = random_sampler(unit);
  const auto wrap = [&] { return unit.random.coin() ? TextureWrap::repeat : TextureWrap::mirror; };
  state.texture_wrap = {wrap(), wrap()};
  const int side = 1 << unit.random.index(7);
  const std::int64_t right = std::int64_t{unit.width(32)} * unit.pixel(),
                     bottom = std::int64_t{unit.height(32)} * unit.pixel();
  Scene scene = rectangle(unit, state, random_texture(unit, side, side), {0, 0}, {right, bottom});
  const double pixels = unit.random.between(2.5, plane_roundings(unit.config));  // of one image
  const double w = std::exp2(3 * unit.random.unit());
  for (Vertex& vertex : scene.vertices) {
    vertex.u = std::round(vertex.x / pixels * 1024) / 1024;
    vertex.v = std::round(vertex.y / pixels * 1024) / 1024;
    if (vertex.y > 0) vertex.w = w;
  }
  check_periods(unit, scene);
}

void levels_along_a_scanline(Unit& unit) {
  // A wall receding to the right: all levels in each row.
  Random& random = unit.random;
  State state = random_sampler(unit);
  state.texture_min = static_cast<TextureMin>(2 + random.index(4));
  state.texture_lod[0] = random.coin() ? random.between(-2, 2) : 0;
  const std::int64_t right = std::int64_t{unit.width(32)} * unit.pixel(),
                     bottom = std::int64_t{unit.height(32)} * unit.pixel();
  Scene scene = rectangle(unit, state, random_texture(unit, 256, 256), {0, 0}, {right, bottom});
  const double depth = std::exp2(random.between(3, 9)), repeats = std::exp2(random.between(0, 3));
  for (Vertex& vertex : scene.vertices) {
    vertex.w = vertex.x > 0 ? depth : 1;
    vertex.u *= repeats;
  }
  (void)check_surfaces(unit, scene);
}

void texture_viewport(Unit& unit) {
  // One texel per pixel, half a texel from the sides: the image itself.
  Random& random = unit.random;
  const int width = 1 + random.index(unit.width(32)), height = 1 + random.index(unit.height(32));
  const Point from{random.index(unit.width(32) - width + 1), random.index(unit.height(32) - height + 1)};
  State state = random_sampler(unit);
  const bool is_linear = random.coin();
  state.texture_mag = is_linear ? TextureMag::linear : TextureMag::nearest;
  state.texture_min = is_linear ? TextureMin::linear : TextureMin::nearest;
  const std::int64_t p = unit.pixel();
  const Scene scene = rectangle(unit, state, random_texture(unit, width, height), {from.x * p, from.y * p},
                                {(from.x + width) * p, (from.y + height) * p});
  const PerspectiveFormat format = perspective_format(unit.config);
  const auto off = [&](int side) {
    return over_w_bound(side, 1, format, format.coordinate, plane_roundings(unit.config));
  };
  int worst = 0;
  (void)check_surfaces(unit, scene, [&](const TappedFragment& f, const SurfaceSample& s) {
    const Texel texel = scene.textures[0].texel(0, f.x - static_cast<int>(from.x), f.y - static_cast<int>(from.y));
    for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(s.texel[c] - texel[c]));
  });
  unit.measure(is_linear ? "linear image" : "nearest image", "LSB", worst,
               is_linear ? 255 * (off(width) + off(height)) + 2 : 0, scene);
}

}  // namespace halfplane::stress
