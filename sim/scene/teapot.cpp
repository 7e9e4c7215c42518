// The Utah teapot from its Bezier patches.
#include <array>
#include <cstdint>
#include <map>

#include "sim/scene/builtin_meshes.hpp"

namespace halfplane {
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
