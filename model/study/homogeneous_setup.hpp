// Homogeneous setup: a triangle in clip coordinates in, edge functions that are valid only in front of the eye out.
// Nothing is cut, and vertices are divided only for the box and the range to which depth and colour are clamped. After
// Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", Graphics Hardware 1997.
//
// With v_i = (X, Y, W), window coordinates times w, and e_0 = v1 x v2 and so on, a pixel p = (x, y, 1) is sum b_i v_i
// with b_i = e_i(p) / det. sum b_i f_i is f / w of the point seen at p, for any f linear in clip space: 1 / w, window
// depth, and the distances to near and far. If all b_i >= 0, p sees the triangle, and w > 0 there.
//
// Host side, binary64, up to the coefficients; these are rounded to integers, and all later steps are exact:
//   bounds   E(x, y) = a x + b y + c in whole pixels, the larger of |a|, |b| scaled to m bits; covered where E >= 0,
//            with the fill rule folded into c. The two triangles on an edge compute it with exchanged ends, which
//            negates each coefficient to the last bit: every sample belongs to exactly one side of the edge
//   depth    the plane of triangle_setup, with its guard bits, from the unsnapped vertices
//   colour   affine when every vertex has w > 0; otherwise, where that is meaningless on the screen, perspective:
//            one division a sample, (sum b_i c_i) / (sum b_i)
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "../config.hpp"
#include "../host/clip.hpp"
#include "../host/primitive_assembly.hpp"
#include "../scene.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/triangle_setup.hpp"
#include "../widths.hpp"

namespace halfplane {

/// a x + b y + c.
struct LinearFunction {
  std::int64_t a = 0, b = 0, c = 0;

  [[nodiscard]] constexpr std::int64_t at(int x, int y) const { return a * x + b * y + c; }
};

/// The reason why nothing of a triangle is drawn.
enum class Rejection { none, outside, zero_area, backface, empty };

struct HomogeneousSetup {
  Rejection rejection = Rejection::none;
  std::array<LinearFunction, 5>
      bound{};                    ///< three edges, near, far: covered where none is negative; (0, 0): first pixel
  TriangleSetup triangle;         ///< box, planes and their ranges; its edges are not set
  std::int64_t depth_offset = 0;  ///< polygon offset, codes: added at the sample
  bool is_back = false;           ///< the back is visible
  bool is_perspective = false;    ///< then the next two are set, and the colour planes are not
  LinearFunction weight;          ///< 1 / w, scaled; (0, 0) is the first pixel of the box
  PerPlane<LinearFunction> code_weight{};  ///< codes / w likewise, of the planes except depth
};

/// Constants of a draw.
struct HomogeneousFrame {
  const Config& config;
  const Widths& widths;
  const State& state;
  Viewport viewport;
  Rect rect;  ///< pixels that the draw may touch
  HomogeneousWidths homogeneous = derive_homogeneous_widths(config);
  ClipPlanes view_volume = view_volume_planes(state.clip_z);
};

/// Any order of the vertices gives the same bits. Colours in their final form for interpolation.
[[nodiscard]] HomogeneousSetup setup_homogeneous(const std::array<Vertex, 3>& v, const HomogeneousFrame& frame);

/// The codes at a sample, including polygon offset and the final clamps. `unrounded`: of the planes alone.
[[nodiscard]] Interpolated interpolate_at(const HomogeneousSetup& setup, const Widths& widths, int x, int y);

/// Calls emit(x, y) for every covered sample of the box, row by row; returns how many samples it tested.
template <class Emit>
std::uint64_t traverse_homogeneous(const HomogeneousSetup& setup, Emit&& emit) {
  const TriangleSetup& box = setup.triangle;
  if (setup.rejection != Rejection::none) return 0;
  for (int y = box.top; y <= box.bottom; ++y) {
    std::array<std::int64_t, 5> value{};
    for (std::size_t i = 0; i < 5; ++i) value[i] = setup.bound[i].at(box.left, y);
    for (int x = box.left; x <= box.right; ++x) {
      if (std::ranges::all_of(value, [](std::int64_t v) { return v >= 0; })) emit(x, y);
      for (std::size_t i = 0; i < 5; ++i) value[i] += setup.bound[i].a;
    }
  }
  return static_cast<std::uint64_t>(box.right - box.left + 1) * static_cast<std::uint64_t>(box.bottom - box.top + 1);
}

/// Calls visit(setup) for every triangle of a draw in clip space, in order.
template <class Visit>
void for_each_homogeneous(const Scene& scene, const Draw& draw, const HomogeneousFrame& frame, Visit&& visit) {
  const auto& state = frame.state;
  for_each_triangle(scene, draw, state.provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::array<Vertex, 3> v{scene.vertices[a], scene.vertices[b], scene.vertices[c]};
    if (state.shade == Shade::flat) v[1].rgba = v[2].rgba = v[0].rgba;
    visit(setup_homogeneous(v, frame));
  });
}

}  // namespace halfplane
