// A triangle with attributes over w, drawn through the stages, and the expected values in exact integers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "model/stages/cull.hpp"
#include "model/stages/perspective.hpp"

namespace halfplane::test {

/// A configuration's widths with a format of attributes over w.
struct PerspectiveDesign {
  std::string name;
  Config config;
  PerspectiveFormat format;
  Widths widths = derive_widths(config);
};

inline PerspectiveDesign perspective_design(const std::string& name, const PerspectiveFormat& format) {
  return {name, preset(name), format};
}

/// Vertices on the subpixel grid. Every value is an integer, so that the value at a pixel is an exact quotient.
struct OverWTriangle {
  std::array<SnappedVertex, 3> v{};
  std::array<std::int64_t, 3> w{};      ///< 2^-10, up to 2^20 of them
  std::array<std::int64_t, 3> value{};  ///< 1/16 texel or LSB

  [[nodiscard]] std::array<double, 3> clip_w() const {
    return {std::ldexp(w[0], -10), std::ldexp(w[1], -10), std::ldexp(w[2], -10)};
  }
  [[nodiscard]] std::array<double, 3> values() const {
    return {std::ldexp(value[0], -4), std::ldexp(value[1], -4), std::ldexp(value[2], -4)};
  }
  [[nodiscard]] std::int64_t area() const { return signed_area(v[0], v[1], v[2]); }
};

/// How much each vertex weighs at the centre of a pixel: doubled areas, all of one sign inside.
inline std::array<std::int64_t, 3> vertex_weights(const std::array<SnappedVertex, 3>& v, int x, int y, int grid_bits) {
  const std::int32_t half = 1 << (grid_bits - 1);
  SnappedVertex p;
  p.x = (x << grid_bits) + half;
  p.y = (y << grid_bits) + half;
  return {signed_area(p, v[1], v[2]), signed_area(v[0], p, v[2]), signed_area(v[0], v[1], p)};
}

/// Whether the closed triangle holds the point with these weights.
inline bool is_inside(const std::array<std::int64_t, 3>& weight) {
  const auto [low, high] = std::minmax({weight[0], weight[1], weight[2]});
  return low >= 0 || high <= 0;
}

/// One attribute through setup, tile and pixel.
class OverWRun {
 public:
  /// `is_canonical_base`: planes start at the first vertex of the canonical order, whatever its q.
  OverWRun(const OverWTriangle& triangle, const PerspectiveDesign& design, const OverWFormat& attribute,
           bool is_canonical_base = false)
      : design_(design), attribute_(attribute) {
    const auto order = canonical_order(triangle.v, triangle.area());
    std::array<double, 3> w{}, value{};
    for (std::size_t i = 0; i < 3; ++i) {
      vertex_[i] = triangle.v[order[i]];
      w[i] = triangle.clip_w()[order[i]];
      value[i] = triangle.values()[order[i]];
    }
    setup_ = setup_triangle({0, 0, triangle.v}, design.config, design.widths);
    q_ = quantize_q(w, design.format.q_bits);
    over_w_ = quantize_over_w(value, q_, attribute);
    const std::size_t base = is_canonical_base ? 0 : base_vertex(q_);
    const PerspectiveFrame frame = perspective_frame(vertex_, base, setup_, design.format, design.widths);
    q_plane_ = setup_q(q_, frame, design.format, design.widths);
    p_plane_ = setup_over_w(over_w_, frame, attribute, design.widths);
  }

  [[nodiscard]] const TriangleSetup& setup() const { return setup_; }
  [[nodiscard]] const std::array<SnappedVertex, 3>& canonical_vertices() const { return vertex_; }
  [[nodiscard]] const QCodes& q_codes() const { return q_; }
  [[nodiscard]] const OverW& over_w() const { return over_w_; }

  [[nodiscard]] std::uint64_t q(int x, int y) const {
    return q_at(q_plane_, place_of(setup_, design_.widths, x, y), design_.format, design_.widths);
  }
  [[nodiscard]] std::int64_t p(int x, int y) const {
    return p_at(p_plane_, place_of(setup_, design_.widths, x, y), attribute_, design_.format, design_.widths);
  }
  /// The attribute, u_ref included, in 2^-f.
  [[nodiscard]] std::int64_t value(int x, int y) const {
    const PixelReciprocal q = divide_by_q(this->q(x, y), design_.format);
    return over_q(p(x, y), q, over_w_, attribute_, design_.format) +
           static_cast<std::int64_t>(over_w_.reference) * (std::int64_t{1} << attribute_.fraction_bits);
  }

 private:
  const PerspectiveDesign& design_;
  OverWFormat attribute_;
  std::array<SnappedVertex, 3> vertex_{};
  TriangleSetup setup_;
  QCodes q_{};
  OverW over_w_;
  Plane q_plane_, p_plane_;
};

/// `computed` 2^-f less the exact value at a pixel with these weights, in texels or LSB.
inline double over_w_error(const OverWTriangle& t, const std::array<std::int64_t, 3>& weight, std::int64_t computed,
                           int fraction_bits) {
  int128 numerator = 0, denominator = 0;  // times w_0 w_1 w_2; the values 1/16
  for (std::size_t i = 0; i < 3; ++i) {
    const int128 over_w = int128{weight[i]} * t.w[(i + 1) % 3] * t.w[(i + 2) % 3];
    numerator += over_w * t.value[i];
    denominator += over_w;
  }
  const int128 difference = int128{computed} * 16 * denominator - numerator * (int128{1} << fraction_bits);
  return static_cast<double>(static_cast<long double>(difference) / static_cast<long double>(denominator)) /
         std::ldexp(16.0, fraction_bits);
}

/// Random triangles on the target: large ones, small ones, slivers.
class OverWRandom {
 public:
  explicit OverWRandom(std::uint64_t seed) : engine_(seed) {}
  /// In [low, high].
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

  /// `ratio`: of the largest w to the smallest; `extent`: of the values, texels. Not of zero area.
  OverWTriangle triangle(const PerspectiveDesign& design, std::int64_t ratio, std::int64_t extent) {
    OverWTriangle t;
    const int s = design.widths.grid_bits;
    const std::int64_t width = std::int64_t{design.config.target_width} << s,
                       height = std::int64_t{design.config.target_height} << s;
    do {
      const std::int64_t reach = std::int64_t{4} << (s + between(0, 10)), x = between(0, width), y = between(0, height);
      for (SnappedVertex& v : t.v) {
        v.x = static_cast<std::int32_t>(std::clamp<std::int64_t>(x + between(-reach, reach), 0, width));
        v.y = static_cast<std::int32_t>(std::clamp<std::int64_t>(y + between(-reach, reach), 0, height));
      }
      if (between(0, 3) == 0) {
        t.v[2].x = (t.v[0].x + t.v[1].x) / 2 + static_cast<std::int32_t>(between(-4 << s, 4 << s));
        t.v[2].y = (t.v[0].y + t.v[1].y) / 2 + static_cast<std::int32_t>(between(-4 << s, 4 << s));
      }
    } while (t.area() == 0);
    const std::int64_t nearest = between(1, (std::int64_t{1} << 20) / ratio), start = between(-8 * extent, 8 * extent);
    t.w = {nearest, nearest * ratio, between(nearest, nearest * ratio)};
    t.value = {start, start + 16 * extent, start + between(0, 16 * extent)};
    shuffle(t.w);
    shuffle(t.value);
    return t;
  }

  template <class Array>
  void shuffle(Array& array) {
    for (std::size_t i = array.size() - 1; i > 0; --i)
      std::swap(array[i], array[static_cast<std::size_t>(between(0, static_cast<std::int64_t>(i)))]);
  }

 private:
  std::mt19937_64 engine_;
};

/// Calls visit(x, y, weight) for some pixels inside: the pixels nearest to the vertices, and others from all over the box.
template <class Visit>
void for_some_pixels(const OverWTriangle& t, const TriangleSetup& setup, const PerspectiveDesign& design, int others,
                     OverWRandom& random, Visit&& visit) {
  if (setup.is_empty()) return;
  const int s = design.widths.grid_bits;
  const auto see = [&](std::int64_t x, std::int64_t y) {
    const int px = std::clamp(static_cast<int>(x), setup.left, setup.right),
              py = std::clamp(static_cast<int>(y), setup.top, setup.bottom);
    const auto weight = vertex_weights(t.v, px, py, s);
    if (is_inside(weight)) visit(px, py, weight);
  };
  for (const SnappedVertex& v : t.v)
    for (int i = 0; i < 4; ++i) see((v.x >> s) - (i & 1), (v.y >> s) - (i >> 1));
  for (int i = 0; i < others; ++i) {  // between the vertices, so that slivers are met too
    const std::int64_t a = random.between(0, 1024), b = random.between(0, 1024 - a), c = 1024 - a - b;
    see((a * t.v[0].x + b * t.v[1].x + c * t.v[2].x) >> (10 + s),
        (a * t.v[0].y + b * t.v[1].y + c * t.v[2].y) >> (10 + s));
  }
}

}  // namespace halfplane::test
