#include "sim/scene/builtin_meshes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "sim/scene/random.hpp"

namespace halfplane {

namespace {

using Color = std::array<double, 4>;
using Quad = std::array<Vec3, 4>;  // counter-clockwise from the visible side

// A hue of 0...1 (red, green, blue, red), fully bright.
Color from_hue(double hue, double saturation, double value) {
  Color rgba{0, 0, 0, 255};
  for (std::size_t i = 0; i < 3; ++i) {
    const double turn = hue * 6 + std::array<double, 3>{5, 3, 1}[i];
    const double k = turn - 6 * std::floor(turn / 6);
    rgba[i] = 255 * value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  }
  return rgba;
}

// Two triangles with separate vertices: flat normal, one colour.
void add_quad(Mesh& mesh, const Quad& corners, const Color& color) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Vec3 normal = normalized(cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0])));
  for (const Vec3& corner : corners) mesh.vertices.push_back({corner, normal, color, 0, 0});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

// Makes everything since the last part a new part.
void close_part(Mesh& mesh, const std::string& object) {
  const std::size_t first = mesh.parts.empty() ? 0 : mesh.parts.back().first + mesh.parts.back().count;
  mesh.parts.push_back({static_cast<std::uint32_t>(mesh.objects.size()), first, mesh.triangles.size() - first, 0});
  mesh.objects.push_back(object);
}

// The six sides of a box, seen from outside. Axis 0...2, side low or high.
Quad box_side(const Vec3& low, const Vec3& high, std::size_t axis, bool upper) {
  const std::size_t s = (axis + 1) % 3, t = (axis + 2) % 3;
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t corner = upper ? i : 3 - i;
    quad[i][axis] = upper ? high[axis] : low[axis];
    quad[i][s] = corner == 1 || corner == 2 ? high[s] : low[s];
    quad[i][t] = corner >= 2 ? high[t] : low[t];
  }
  return quad;
}

// The torus knot's centre line at angle t of 0...2 pi: twice around the axis, three times through the hole.
Vec3 knot_line(double t) {
  const double r = 2 + std::cos(3 * t);
  return {r * std::cos(2 * t), r * std::sin(2 * t), std::sin(3 * t)};
}

Vec3 knot_tangent(double t) {
  const double r = 2 + std::cos(3 * t), slope = -3 * std::sin(3 * t);
  return normalized({slope * std::cos(2 * t) - 2 * r * std::sin(2 * t),
                     slope * std::sin(2 * t) + 2 * r * std::cos(2 * t), 3 * std::cos(3 * t)});
}

}  // namespace

Mesh city_mesh(int boxes, std::uint64_t seed) {
  Mesh mesh;
  Random random(seed);
  int side = 1;
  while (side * side < boxes) ++side;
  const double half = side / 2.0;
  for (int i = 0; i < boxes; ++i) {
    const double x = i % side - half, z = std::floor(static_cast<double>(i) / side) - half;  // the lot's corner
    const double inset = random.uniform(0.12, 0.3);
    // A few towers among many low houses.
    const double height = 0.25 + 3.2 * std::pow(random.uniform(0, 1), 3);
    // One after the other: compilers evaluate arguments in orders of their own.
    const double value = random.uniform(0.65, 0.95), saturation = random.uniform(0.15, 0.45),
                 hue = random.uniform(0, 1);
    const Color color = from_hue(hue, saturation, value);
    const Vec3 low{x + inset, 0, z + inset}, high{x + 1 - inset, height, z + 1 - inset};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const bool upper : {false, true}) add_quad(mesh, box_side(low, high, axis, upper), color);
    }
    close_part(mesh, "box " + std::to_string(i));
  }
  const double edge = half + 0.5;
  // Slightly below the boxes' bottoms, which would otherwise have the same depth.
  add_quad(mesh, {{{-edge, -0.02, edge}, {edge, -0.02, edge}, {edge, -0.02, -edge}, {-edge, -0.02, -edge}}},
           {95, 105, 95, 255});
  close_part(mesh, "ground");
  return mesh;
}

Mesh knot_mesh(int segments) {
  Mesh mesh;
  const int around = std::max(3, segments / 8);
  constexpr double kTurn = 2 * std::numbers::pi, kTube = 0.42;  // radius of the tube; the strands are 1 to 2 apart
  // Rotated towards the default camera, which would otherwise look along one of the tube's bends.
  const Vec3 z = normalized({0.45, 0.3, 0.85}), x = normalized(cross({0, 1, 0}, z)), y = cross(z, x);
  const auto turned = [&](const Vec3& p) { return add(add(scaled(x, p[0]), scaled(y, p[1])), scaled(z, p[2])); };
  for (int i = 0; i < segments; ++i) {
    const double t = kTurn * i / segments;
    const Vec3 center = knot_line(t), tangent = knot_tangent(t);
    // Away from the torus' own core circle: a frame that is continuous over the whole loop.
    const Vec3 core{2 * std::cos(2 * t), 2 * std::sin(2 * t), 0};
    const Vec3 side = normalized(cross(tangent, subtract(center, core)));
    const Vec3 out = cross(side, tangent);
    const Color color = from_hue(static_cast<double>(i) / segments, 0.75, 0.95);
    for (int j = 0; j < around; ++j) {
      const double angle = kTurn * j / around;
      const Vec3 normal = add(scaled(out, std::cos(angle)), scaled(side, std::sin(angle)));
      mesh.vertices.push_back({turned(add(center, scaled(normal, kTube))), turned(normal), color, 0, 0});
    }
  }
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(i % segments * around + j % around); };
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i + 1, j)});
      mesh.triangles.push_back({index(i, j), index(i, j + 1), index(i + 1, j + 1)});
    }
  }
  close_part(mesh, "knot");
  return mesh;
}

Mesh coplanar_mesh() {
  Mesh mesh;
  mesh.lit = false;
  // Both squares lean back; the second is rotated by a third of a degree about their common line x = 0.
  constexpr double kSize = 8, kLean = 0.6, kTilt = 0.006;
  const auto square = [](double tilt) {
    Quad quad{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = i == 1 || i == 2 ? kSize : -kSize, y = i >= 2 ? kSize : -kSize;
      quad[i] = {x, y, -kLean * y + tilt * x};
    }
    return quad;
  };
  add_quad(mesh, square(0), {240, 140, 40, 255});
  close_part(mesh, "orange");
  Quad second = square(kTilt);
  std::rotate(second.begin(), second.begin() + 1, second.end());  // the other diagonal: rounding differs too
  add_quad(mesh, second, {50, 120, 220, 255});
  close_part(mesh, "blue");
  return mesh;
}

Mesh corridor_mesh() {
  Mesh mesh;
  mesh.lit = false;
  const Vec3 low{-2, 0, -20}, high{2, 3, 20};
  const Vec3 cell{1, 1, 8};  // long in the walking direction: the cells next to the eye begin behind it and end in view
  const std::array<std::array<Color, 2>, 3> colors{{{{{205, 190, 150, 255}, {120, 80, 60, 255}}},   // walls
                                                    {{{90, 140, 120, 255}, {225, 230, 220, 255}}},  // floor, ceiling
                                                    {{{150, 60, 60, 255}, {235, 200, 90, 255}}}}};  // ends
  const std::array<const char*, 6> names{"left wall", "right wall", "floor", "ceiling", "far end", "near end"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      const std::size_t s = (axis + 1) % 3, t = (axis + 2) % 3;
      // Every edge of a cell is an edge of its neighbour too, also across the corridor's corners: no T-junction.
      for (int i = 0; low[s] + i * cell[s] < high[s]; ++i) {
        for (int j = 0; low[t] + j * cell[t] < high[t]; ++j) {
          Vec3 from = low, to = high;
          from[s] = low[s] + i * cell[s];
          to[s] = from[s] + cell[s];
          from[t] = low[t] + j * cell[t];
          to[t] = from[t] + cell[t];
          const bool odd = (i + j) % 2 != 0;
          Quad quad = box_side(from, to, axis, upper);
          std::reverse(quad.begin(), quad.end());  // seen from inside
          add_quad(mesh, quad, colors[axis][odd ? 1 : 0]);
        }
      }
      close_part(mesh, names[axis * 2 + (upper ? 1 : 0)]);
    }
  }
  return mesh;
}

// The Utah teapot from its Bezier patches.

namespace {

#include "sim/scene/teapot_patches.inc"

// The weights of four control points at i / n, or the weights of the derivative.
using Weights = std::array<double, 4>;

// Integers before the one division, so that i / n and (n - i) / n give the same weights in reverse.
Weights bernstein(int i, int n) {
  const double a = i, b = n - i, cube = static_cast<double>(n) * n * n;
  return {b * b * b / cube, 3 * (a * b * b) / cube, 3 * (a * a * b) / cube, a * a * a / cube};
}

Weights bernstein_slope(int i, int n) {
  const double t = static_cast<double>(i) / n, s = 1 - t;
  return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
}

// Outer points first, then inner ones: reversing points and weights gives the same bits, so neighbours agree on their
// common curve in either direction.
Vec3 blend(const std::array<Vec3, 4>& points, const Weights& w) {
  return add(add(scaled(points[0], w[0]), scaled(points[3], w[3])),
             add(scaled(points[1], w[1]), scaled(points[2], w[2])));
}

struct Patch {
  std::array<std::array<Vec3, 4>, 4> rows;  // rows run along v, their order along u

  // A point, or with the slopes' weights a derivative.
  Vec3 at(const Weights& u, const Weights& v) const {
    std::array<Vec3, 4> curve{};
    for (std::size_t i = 0; i < 4; ++i) curve[i] = blend(rows[i], v);
    return blend(curve, u);
  }

  // The point; a row that has degenerated to a point stays one, although the rounded weights do not add up to 1.
  Vec3 point(const Weights& u, const Weights& v) const {
    std::array<Vec3, 4> curve{};
    for (std::size_t i = 0; i < 4; ++i) {
      const bool shrunk = rows[i][0] == rows[i][1] && rows[i][0] == rows[i][2] && rows[i][0] == rows[i][3];
      curve[i] = shrunk ? rows[i][0] : blend(rows[i], v);
    }
    return blend(curve, u);
  }
};

// y up instead of z up; + 0.0 turns a negative zero into the positive one.
Vec3 upright(const Vec3& p) { return {p[0] + 0.0, p[2] + 0.0, -p[1] + 0.0}; }

// The outward unit normal at (i, j) of n. Where an edge has degenerated to a point, dP/dv (or dP/du) is zero and the
// mixed derivative, the limit of its direction, replaces it.
Vec3 normal_at(const Patch& patch, int i, int j, int n) {
  constexpr double kNothing = 1e-9;  // the pot is 3 units high; its smallest true derivative is about 0.1
  const Weights u = bernstein(i, n), v = bernstein(j, n);
  const Weights du = bernstein_slope(i, n), dv = bernstein_slope(j, n);
  Vec3 along_u = patch.at(du, v), along_v = patch.at(u, dv);
  if (length(along_v) < kNothing) along_v = scaled(patch.at(du, dv), i == 0 ? 1 : -1);
  if (length(along_u) < kNothing) along_u = scaled(patch.at(du, dv), j == 0 ? 1 : -1);
  return normalized(upright(cross(along_v, along_u)));  // dP/du x dP/dv points inwards
}

class TeapotBuilder {
 public:
  explicit TeapotBuilder(int segments) : n_(segments) {}

  Mesh run() {
    struct Part {
      const char* name;
      std::size_t first, end;  // of kPatches
    };
    constexpr std::array<Part, 6> kParts{
        {{"rim", 0, 4}, {"body", 4, 12}, {"handle", 12, 16}, {"spout", 16, 20}, {"lid", 20, 28}, {"bottom", 28, 32}}};
    for (const Part& part : kParts) {
      const std::size_t first = mesh_.triangles.size();
      for (std::size_t i = part.first; i < part.end; ++i) add_patch(kPatches[i]);
      mesh_.parts.push_back(
          {static_cast<std::uint32_t>(mesh_.objects.size()), first, mesh_.triangles.size() - first, 0});
      mesh_.objects.push_back(part.name);
    }
    return std::move(mesh_);
  }

 private:
  void add_patch(const std::array<std::uint16_t, 16>& indices) {
    Patch patch{};
    for (std::size_t i = 0; i < 16; ++i) patch.rows[i / 4][i % 4] = kPoints[indices[i]];
    const auto side = static_cast<std::size_t>(n_ + 1);
    std::vector<std::uint32_t> grid;
    grid.reserve(side * side);
    for (int i = 0; i <= n_; ++i) {
      for (int j = 0; j <= n_; ++j) {
        const Vec3 position = upright(patch.point(bernstein(i, n_), bernstein(j, n_)));
        const bool inside = i > 0 && i < n_ && j > 0 && j < n_;  // shared with no other patch
        grid.push_back(vertex(position, normal_at(patch, i, j, n_), inside));
      }
    }
    for (std::size_t i = 0; i + 1 < side; ++i) {
      for (std::size_t j = 0; j + 1 < side; ++j) {
        const std::size_t at = i * side + j;
        add_triangle(grid[at], grid[at + side + 1], grid[at + side]);
        add_triangle(grid[at], grid[at + 1], grid[at + side + 1]);
      }
    }
  }

  // An existing vertex with this position and nearly this normal: patches that join smoothly share it, creases do not.
  std::uint32_t vertex(const Vec3& position, const Vec3& normal, bool inside) {
    const auto added = static_cast<std::uint32_t>(mesh_.vertices.size());
    if (!inside) {
      std::vector<std::uint32_t>& here = at_[position];
      for (const std::uint32_t known : here) {
        if (dot(mesh_.vertices[known].normal, normal) > 0.9999) return known;
      }
      here.push_back(added);
    }
    mesh_.vertices.push_back({position, normal, {226, 178, 120, 255}, 0, 0});
    return added;
  }

  // Triangles with a degenerate side are left out.
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& p = mesh_.vertices;
    const auto same = [&p](std::uint32_t i, std::uint32_t j) { return p[i].position == p[j].position; };
    if (!same(a, b) && !same(b, c) && !same(c, a)) mesh_.triangles.push_back({a, b, c});
  }

  int n_;
  Mesh mesh_;
  std::map<Vec3, std::vector<std::uint32_t>> at_;
};

}  // namespace

Mesh teapot_mesh(int segments) { return TeapotBuilder(segments).run(); }

}  // namespace halfplane
