// Clip, division and viewport in the numbers of smaller hosts: against exact rationals and against binary32 step by step,
// near the planes and where w is next to nothing; shared edges stay shared.
#include "sim/scene/host_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/fixed.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane::host_geometry_test {
namespace {

using test::clip_at;
using test::Random;
using test::SceneBuilder;

constexpr std::array kSmaller{TransformNumbers::binary32, TransformNumbers::s15_16};
constexpr double kNear = 0.1, kFar = 20;
constexpr int kWidth = 90, kHeight = 70;
const int kBand = preset("embedded").guard_band;

const char* name_of(TransformNumbers numbers) { return numbers == TransformNumbers::s15_16 ? "s15.16" : "binary32"; }

/// A point of eye space (x right, y up, z forward) through a camera of 90 degrees.
Vertex project(double x, double y, double z, double near = kNear) {
  return clip_at(x, y, 2 * kFar / (kFar - near) * (z - near) - z, z);
}

/// About the eye, the near plane and the far plane, at random.
HostVertex random_vertex(Random& random, const HostGeometry& host) {
  const double reach = std::exp2(random.between(-4, 4));
  const double z = std::array{random.between(-3, 6), kNear + random.between(-1e-4, 1e-4), random.between(-1e-4, 1e-4),
                              kFar + random.between(-1e-3, 1e-3)}[static_cast<std::size_t>(random.index(4))];
  const double x = random.between(-reach, reach), y = random.between(-reach, reach);
  HostVertex v{project(x, y, z)};
  for (double& channel : v.vertex.rgba) channel = random.between(0, 255);
  v.vertex.u = random.between(-3, 3);
  v.vertex.v = random.between(-3, 3);
  v.normal = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  return host.rounded(v);
}

HostGeometry make_host(TransformNumbers numbers, const State& state = {}, const Config& config = preset("embedded")) {
  return {numbers, state, kWidth, kHeight, config};
}

constexpr std::array<double Vertex::*, 6> kParts{&Vertex::x, &Vertex::y, &Vertex::z,
                                                 &Vertex::w, &Vertex::u, &Vertex::v};

std::int64_t units(double v) { return static_cast<std::int64_t>(std::ldexp(v, 16)); }

/// The planes derived again from their purpose: near, far, left, right, top, bottom of the guard band.
struct ExactPlane {
  std::int64_t x, y, z, w;  ///< 2^-16
  [[nodiscard]] int128 distance(const Vertex& v) const {
    return int128{x} * units(v.x) + int128{y} * units(v.y) + int128{z} * units(v.z) + int128{w} * units(v.w);
  }
};
std::vector<ExactPlane> exact_planes() {
  const std::int64_t one = 1 << 16, half_width = kWidth / 2 * one, half_height = kHeight / 2 * one;
  const std::int64_t limit = kBand * one - one / 16;
  return {{0, 0, one, one},
          {0, 0, -one, one},
          {half_width, 0, 0, limit + half_width},
          {-half_width, 0, 0, limit - half_width},
          {0, -half_height, 0, limit + half_height},
          {0, half_height, 0, limit - half_height}};
}

/// Calls visit(inside end, outside end, cut, plane) for random edges that one plane alone cuts.
void for_each_single_cut(
    TransformNumbers numbers, int count,
    const std::function<void(const HostVertex&, const HostVertex&, const HostVertex&, int)>& visit) {
  const HostGeometry host = make_host(numbers);
  Random random(71);
  int found = 0;
  for (int i = 0; found < count; ++i) {
    ASSERT_LT(i, 100 * count);
    const HostVertex a = random_vertex(random, host), b = random_vertex(random, host);
    const unsigned code_a = host.outcode(a.vertex), code_b = host.outcode(b.vertex);
    const unsigned crossed = code_a | code_b;
    if ((code_a == 0) == (code_b == 0) || std::popcount(crossed) != 1) continue;
    const auto line = host.clip(a, b);
    ASSERT_TRUE(line);
    ++found;
    visit(code_a == 0 ? a : b, code_a == 0 ? b : a, code_a == 0 ? line->second : line->first,
          std::countr_zero(crossed));
  }
}

TEST(HostGeometry, FixedCutsAreTheExactOnesRounded) {
  const std::vector<ExactPlane> planes = exact_planes();
  std::array<int, 6> cuts{};
  for_each_single_cut(TransformNumbers::s15_16, 20000,
                      [&](const auto& in, const auto& out, const auto& cut, int plane) {
                        ++cuts[static_cast<std::size_t>(plane)];
                        const int128 d_in = planes[static_cast<std::size_t>(plane)].distance(in.vertex);
                        const int128 d_out = planes[static_cast<std::size_t>(plane)].distance(out.vertex);
                        ASSERT_TRUE(d_in >= 0 && d_out < 0) << "an exact distance has the other sign";
                        const auto check = [&](double from, double to, double made) {
                          // The parameter is off by 2^-31 at most, the rounding by half a unit.
                          const int128 whole = d_in - d_out, step = int128{units(to)} - units(from);
                          const int128 error = (int128{units(made)} - units(from)) * whole - step * d_in;
                          const int128 bound = whole * ((int128{1} << 29) + (step < 0 ? -step : step));
                          ASSERT_LE((error < 0 ? -error : error) << 30, bound) << from << " to " << to << ": " << made;
                        };
                        for (const auto part : kParts) check(in.vertex.*part, out.vertex.*part, cut.vertex.*part);
                        for (std::size_t c = 0; c < 4; ++c)
                          check(in.vertex.rgba[c], out.vertex.rgba[c], cut.vertex.rgba[c]);
                        for (std::size_t i = 0; i < 3; ++i) check(in.normal[i], out.normal[i], cut.normal[i]);
                      });
  for (const int count : cuts) EXPECT_GT(count, 100) << "each plane cuts";
}

/// Each operation in binary64, which has more than twice the bits of binary32: rounding its result again is binary32's.
double single(double v) { return static_cast<double>(static_cast<float>(v)); }

TEST(HostGeometry, Binary32RoundsEachOperation) {
  const std::vector<ExactPlane> planes = exact_planes();
  for_each_single_cut(
      TransformNumbers::binary32, 20000, [&](const auto& in, const auto& out, const auto& cut, int plane) {
        const ExactPlane& p = planes[static_cast<std::size_t>(plane)];
        const auto distance = [&p](const Vertex& v) {
          const auto term = [](std::int64_t a, double b) {
            return single(std::ldexp(static_cast<double>(a), -16) * b);
          };
          return single(single(term(p.x, v.x) + term(p.y, v.y)) + single(term(p.z, v.z)) + term(p.w, v.w));
        };
        const double d_in = distance(in.vertex), d_out = distance(out.vertex);
        const double t = single(d_in / single(d_in - d_out));
        const auto mix = [t](double from, double to) { return single(from + single(t * single(to - from))); };
        for (const auto part : kParts) ASSERT_EQ(cut.vertex.*part, mix(in.vertex.*part, out.vertex.*part));
        for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(cut.vertex.rgba[c], mix(in.vertex.rgba[c], out.vertex.rgba[c]));
        for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(cut.normal[i], mix(in.normal[i], out.normal[i]));
      });
}

int128 rounded_quotient(int128 n, int128 d) {
  const int128 twice = 2 * n + d, whole = twice / (2 * d);
  return whole * 2 * d > twice ? whole - 1 : whole;
}

TEST(HostGeometry, FixedPlacesAreTheExactOnesRounded) {
  for (const ClipZ clip_z : {ClipZ::minus_one_one, ClipZ::zero_one}) {
    State state;
    state.clip_z = clip_z;
    const HostGeometry host = make_host(TransformNumbers::s15_16, state);
    Random random(73);
    int seen = 0, at_limit = 0;
    for (int i = 0; i < 200000; ++i) {
      Vertex v = random_vertex(random, host).vertex;
      if (clip_z == ClipZ::zero_one) v.z = std::ldexp(std::floor(std::ldexp((v.z + v.w) / 2, 16)), -16);
      if (i % 4 == 0) v.w = std::ldexp(1 + random.index(5), -16);  // next to nothing
      if (!(v.w > 0)) continue;
      const HostPosition made = host.window(v);
      ASSERT_FALSE(made.had_no_w);
      const int128 w = units(v.w), limit = (kBand << 16) - (1 << 12);
      const auto place = [&](double at, int size) {
        const int128 half = int128{size / 2} << 16;
        return std::clamp(half + rounded_quotient(int128{units(at)} * half, w), -limit, limit);
      };
      const int128 x = place(v.x, kWidth), y = place(-v.y, kHeight);
      ASSERT_EQ(units(made.at.x), static_cast<std::int64_t>(x));
      ASSERT_EQ(units(made.at.y), static_cast<std::int64_t>(y));
      const int128 up = clip_z == ClipZ::zero_one ? 2 * int128{units(v.z)} : units(v.z) + w;
      const int128 depth = rounded_quotient(std::clamp<int128>(up, 0, 2 * w) << 30, w);
      ASSERT_EQ(std::ldexp(made.at.z, 31), static_cast<double>(depth));
      ++seen;
      at_limit += x == limit || x == -limit ? 1 : 0;
    }
    EXPECT_GT(seen, 100000);
    EXPECT_GT(at_limit, 1000) << "what is beyond the guard band is held to it";
  }
}

TEST(HostGeometry, Binary32PlacesRoundEachOperation) {
  const HostGeometry host = make_host(TransformNumbers::binary32);
  Random random(74);
  int seen = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vertex v = random_vertex(random, host).vertex;
    if (!(v.w > 0)) continue;
    const HostPosition made = host.window(v);
    const double limit = kBand - 0x1p-4;
    const auto place = [&](double ndc, int size) {
      return std::clamp(single(single(single(ndc + 1) / 2) * size), -limit, limit);
    };
    ASSERT_EQ(made.at.x, place(single(v.x / v.w), kWidth));
    ASSERT_EQ(made.at.y, place(single(-v.y / v.w), kHeight));
    ASSERT_EQ(made.at.z, std::clamp(single(single(single(v.z / v.w) + 1) / 2), 0.0, 1.0));
    ++seen;
  }
  EXPECT_GT(seen, 50000);
}

bool is_same(const HostVertex& a, const HostVertex& b) {
  return std::ranges::all_of(kParts, [&](auto part) { return a.vertex.*part == b.vertex.*part; }) &&
         a.vertex.rgba == b.vertex.rgba && a.normal == b.normal;
}

TEST(HostGeometry, BothTrianglesOnACutEdgeGetTheSameCorners) {
  for (const TransformNumbers numbers : kSmaller) {
    const HostGeometry host = make_host(numbers);
    Random random(75);
    int shared = 0;
    for (int i = 0; i < 30000; ++i) {
      const HostVertex a = random_vertex(random, host), b = random_vertex(random, host),
                       c = random_vertex(random, host), d = random_vertex(random, host);
      if ((host.outcode(a.vertex) | host.outcode(b.vertex)) == 0) continue;
      const auto line = host.clip(a, b), back = host.clip(b, a);
      ASSERT_EQ(line.has_value(), back.has_value());
      if (!line) continue;
      ASSERT_TRUE(is_same(line->first, back->second) && is_same(line->second, back->first));
      const auto one = host.clip(a, b, c), other = host.clip(d, b, a);
      for (const HostVertex& end : {line->first, line->second})
        for (const auto* polygon : {&one, &other})
          ASSERT_TRUE(polygon->empty() || std::ranges::any_of(*polygon, [&](const auto& v) { return is_same(v, end); }))
              << name_of(numbers) << ", pair " << i;
      shared += !one.empty() && !other.empty() ? 1 : 0;
    }
    EXPECT_GT(shared, 3000) << name_of(numbers);
  }
}

double area(const std::vector<WindowPosition>& corner) {
  double twice = 0;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const WindowPosition &a = corner[i], &b = corner[(i + 1) % corner.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return twice / 2;
}

TEST(HostGeometry, NoTriangleIsLostWhereWIsNextToNothing) {
  for (const TransformNumbers numbers : kSmaller) {
    const State state;
    const HostGeometry host = make_host(numbers);
    const Viewport viewport = effective_viewport(state, kWidth, kHeight);
    Random random(76);
    int compared = 0, without_w = 0;
    for (int i = 0; i < 30000; ++i) {
      const double near = i % 2 == 0 ? kNear : 5e-6;  // a third of a unit
      std::array<HostVertex, 3> v;
      for (HostVertex& corner : v) {
        const double z = random.index(3) == 0 ? random.between(-1, 1) * 4 * near : random.between(-2, 3);
        const double x = random.between(-2, 2), y = random.between(-2, 2);
        corner = host.rounded({project(x, y, z, near)});
      }
      const std::vector<HostVertex> made = host.clip(v[0], v[1], v[2]);
      const ClipPolygon right = clip(host.planes(), v[0].vertex, v[1].vertex, v[2].vertex);
      std::vector<WindowPosition> places, right_places;
      for (const HostVertex& corner : made) {
        const HostPosition position = host.window(corner.vertex);
        without_w += position.had_no_w ? 1 : 0;
        ASSERT_TRUE(std::abs(position.at.x) < kBand && std::abs(position.at.y) < kBand);
        ASSERT_TRUE(position.at.z >= 0 && position.at.z <= 1 && position.w > 0);
        places.push_back(position.at);
      }
      for (int k = 0; k < right.size; ++k)
        right_places.push_back(to_window(right.v[static_cast<std::size_t>(k)], state, viewport));
      if (std::abs(area(right_places)) < 1) continue;
      ++compared;
      ASSERT_FALSE(made.empty()) << name_of(numbers) << ", triangle " << i << ", " << area(right_places) << " pixels";
      if (near == kNear) {
        ASSERT_GT(area(places) * area(right_places), 0) << name_of(numbers) << ", triangle " << i;
      }
    }
    EXPECT_GT(compared, 10000);
    if (numbers == TransformNumbers::s15_16) {
      EXPECT_GT(without_w, 30) << "otherwise nothing was next to nothing";
    }
  }
}

/// A floor from behind the eye to the horizon, in small triangles that share their vertices.
Scene floor_scene(int cells) {
  SceneBuilder builder(kWidth, kHeight, State{});
  builder.scene.states[0].depth_test = DepthFunc::always;
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column) {
      const double across = -1 + 2.0 * column / cells, along = static_cast<double>(row) / cells;
      builder.scene.vertices.push_back(project(9.7 * across + 0.3 * along, -0.31 + 0.01 * across, -1.3 + 9 * along));
    }
  const auto corner = [cells](int row, int column) { return static_cast<std::uint32_t>(row * (cells + 1) + column); };
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      for (const auto& [r, c] : {std::pair(0, 0), {0, 1}, {1, 1}, {0, 0}, {1, 1}, {1, 0}})
        builder.scene.indices.push_back(corner(row + r, column + c));
  builder.scene.commands.push_back(Draw{0, 0, Topology::triangles, 0, builder.scene.indices.size()});
  return builder.scene;
}

std::vector<std::uint32_t> counts_of(const Scene& scene, const Config& config) {
  RenderOptions options;
  options.want_count = true;
  const Rendering rendering = FunctionalEngine(config).render(scene, options);
  return {rendering.count.begin(), rendering.count.end()};
}

TEST(HostGeometry, ACutFloorHasNoHolesAndNoPixelTwice) {
  const Config config = preset("embedded");
  for (const int cells : {3, 10, 41}) {
    const Scene scene = floor_scene(cells);
    const std::vector<std::uint32_t> right = counts_of(scene, config);
    for (const TransformNumbers numbers : kSmaller) {
      HostCounts counts;
      const std::vector<std::uint32_t> made = counts_of(in_host_numbers(scene, numbers, config, &counts), config);
      EXPECT_GT(counts.cut, 2U);
      // At the horizon triangles are thinner than the snap grid; below it the floor is everywhere.
      const auto below = std::span(made).subspan(static_cast<std::size_t>(42 * kWidth));
      EXPECT_EQ(std::ranges::count(below, 1U), (kHeight - 42) * kWidth) << name_of(numbers) << ", " << cells;
      int differences = 0;
      for (std::size_t i = 0; i < made.size(); ++i) differences += made[i] != right[i] ? 1 : 0;
      EXPECT_LE(differences, kWidth / 4) << "along the horizon";
    }
  }
}

TEST(HostGeometry, PiecesOfACutTriangleDrawNoPixelTwice) {
  for (const char* name : {"tiny", "embedded"}) {
    Config config = preset(name);
    config.target_width = config.target_height = 96;
    config.guard_band = 128;
    for (const TransformNumbers numbers : kSmaller) {
      Random random(78);
      std::size_t cut = 0;
      for (int i = 0; i < 1500; ++i) {
        SceneBuilder builder(kWidth, kHeight, State{});
        std::array<Vertex, 3> v;
        for (Vertex& corner : v) {
          const double z = random.between(-1, 3), x = random.between(-2, 2);
          corner = project(x, random.between(-2, 2), z);
        }
        builder.triangle(v[0], v[1], v[2]);
        HostCounts counts;
        const Scene made = in_host_numbers(builder.scene, numbers, config, &counts);
        cut += counts.cut;
        for (const std::uint32_t count : counts_of(made, config)) ASSERT_LE(count, 1U) << name << ", triangle " << i;
      }
      EXPECT_GT(cut, 500U);
    }
  }
}

TEST(HostGeometry, Binary64LeavesASceneAsItIs) {
  const Scene scene = floor_scene(5);
  const Scene same = in_host_numbers(scene, TransformNumbers::binary64, preset("embedded"));
  EXPECT_EQ(same.indices, scene.indices);
  EXPECT_EQ(same.states, scene.states);
  ASSERT_EQ(same.vertices.size(), scene.vertices.size());
}

TEST(HostGeometry, TrianglesOutsideKeepTheirNumbersAndPiecesFollowEachOther) {
  const Config config = preset("embedded");
  SceneBuilder builder(kWidth, kHeight, State{});
  builder.triangle(project(0, 0, -1), project(1, 0, -1), project(0, 1, -1));     // behind the eye
  builder.triangle(project(-1, -1, 1), project(1, -1, 1), project(0, 1, -0.5));  // cut at near: four corners
  builder.triangle(project(-1, -1, 3), project(1, -1, 3), project(0, 1, 3));
  for (const TransformNumbers numbers : kSmaller) {
    HostCounts counts;
    const Scene made = in_host_numbers(builder.scene, numbers, config, &counts);
    EXPECT_EQ(counts.outside, 1U);
    EXPECT_EQ(counts.cut, 1U);
    const auto& draw = std::get<Draw>(made.commands.back());
    EXPECT_EQ(draw.count, 3U * 4);
    const Rendering rendering = FunctionalEngine(config).render(made, {});
    EXPECT_EQ(rendering.counters.primitives_in, 4U);
    EXPECT_GE(rendering.counters.skipped.zero_area, 1U);
    EXPECT_GE(rendering.counters.drawn, 2U);
  }
}

TEST(HostGeometry, LinesAreCutAndOutlinesThatWouldBeStayInClipSpace) {
  const Config config = preset("embedded");
  SceneBuilder builder(kWidth, kHeight, State{});
  builder.scene.vertices = {project(0, 0, -1), project(0, 0, 2), project(0.5, 0, 3), project(0, 0.2, -2)};
  builder.scene.indices = {0, 1, 2, 3, 0, 1, 2, 1, 2, 1};
  builder.scene.states.push_back({});
  builder.scene.states[1].polygon_mode = PolygonMode::line;
  builder.scene.commands.push_back(Draw{0, 0, Topology::line_loop, 0, 4});
  builder.scene.commands.push_back(Draw{1, 0, Topology::triangles, 4, 3});
  builder.scene.commands.push_back(Draw{1, 0, Topology::triangles, 7, 3});
  builder.scene.commands.push_back(Draw{0, 0, Topology::points, 0, 4});
  for (const TransformNumbers numbers : kSmaller) {
    const Scene made = in_host_numbers(builder.scene, numbers, config);
    std::vector<Draw> draws;
    for (const Command& command : made.commands)
      if (const auto* draw = std::get_if<Draw>(&command)) draws.push_back(*draw);
    ASSERT_EQ(draws.size(), 4U);
    EXPECT_EQ(draws[0].count, 6U) << "of four lines one lies behind the eye";
    EXPECT_EQ(draws[0].topology, Topology::lines);
    EXPECT_EQ(made.states[draws[1].state].space, Space::clip) << "vertex 0 is behind the eye";
    EXPECT_EQ(made.states[draws[2].state].space, Space::window);
    EXPECT_EQ(draws[3].count, 2U);
    EXPECT_NO_THROW(validate(made));
  }
}

TEST(HostGeometry, WhatTheNumbersCannotHoldIsRefused) {
  const HostGeometry fixed = make_host(TransformNumbers::s15_16), floats = make_host(TransformNumbers::binary32);
  EXPECT_NO_THROW((void)fixed.rounded({clip_at(32767, -32768, 0, 1)}));
  EXPECT_THROW((void)fixed.rounded({clip_at(0, 0, 32768, 1)}), InputError);
  HostVertex coordinates{clip_at(0, 0, 0, 1)};
  coordinates.vertex.u = 40000;
  EXPECT_THROW((void)fixed.rounded(coordinates), InputError);
  EXPECT_NO_THROW((void)floats.rounded(coordinates));
  EXPECT_THROW((void)floats.rounded({clip_at(1e30, 0, 0, 1)}), InputError);
}

TEST(HostGeometry, PicturesOfSmallerNumbersAreNearlyTheSame) {
  const Config config = preset("full");
  for (const TransformNumbers numbers : kSmaller) {
    for (const char* name : {"teapot:4", "walk", "city:20", "wireframe:3", "wires"}) {
      MeshOptions options;
      const Rendering right = FunctionalEngine(config).render(make_builtin(name, 160, 120, {}, 1, options), {});
      options.transform = numbers;
      const Scene scene = in_host_numbers(make_builtin(name, 160, 120, {}, 1, options), numbers, config);
      const Rendering made = FunctionalEngine(config).render(scene, {});
      std::size_t differences = 0;
      for (std::size_t i = 0; i < made.frame.color.size(); ++i) {
        const std::uint32_t a = made.frame.color[i], b = right.frame.color[i];
        for (int shift = 0; shift < 24; shift += 8)
          if (std::abs(static_cast<int>(a >> shift & 255) - static_cast<int>(b >> shift & 255)) > 8) {
            ++differences;
            break;
          }
      }
      EXPECT_LT(differences, 160U * 120 / 100) << name << " in " << name_of(numbers);
    }
  }
}

}  // namespace
}  // namespace halfplane::host_geometry_test
