// Viewport and cull, lanes at a time: the bits of stages/viewport and stages/cull for vertices that need no clipping. Triangles
// that need clipping, or may not be drawn at all, take the slow path: the host side's own function, which makes the
// messages.
#pragma once

#include "lane_memory.inl"
#include "lane_moves.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// floor(value * scale + 1/2), equal to snap(), as half of floor(2 value * scale) + 1: no sum is rounded. |value *
/// scale| < 2^30.
HALFPLANE_INLINE I16 snap_lanes(const D16& value, double scale) {
  return (convert<std::int32_t>(floor(value * (2 * scale))) + 1) >> 1;
}

/// Sixteen vertices of the scene, attribute by attribute.
struct VertexLanes {
  D16 x, y, z, w;
  I16 rgba;
};

/// Constants of the projection of a slice's vertices.
struct Projection {
  bool is_clip_space;
  Viewport viewport;
  double near_z, near_w;         ///< distance to near: near_z z + near_w w
  std::array<double, 4> band_w;  ///< the guard band's planes: left, right, top, bottom
  double side_x, side_y;         ///< the frustum's planes, of points those of the view volume itself: w times this
  double half_width, half_height;
  bool is_zero_one;
  double range_from, range_by;
  double offset_x, offset_y, scale_y;  ///< of window space
  double grid, codes;                  ///< subpixels in a pixel; largest depth code
  double grid_origin;                  ///< snap_origin()
  int coordinate_shift;
  double reach;        ///< pixels
  std::int32_t limit;  ///< subpixels

  Projection(const DrawContext& context, const Widths& widths) {
    const State& state = context.state;
    const Config& config = context.config;
    is_clip_space = state.space == Space::clip;
    viewport = context.viewport;
    near_z = context.guard_band[0].c;
    near_w = context.guard_band[0].d;
    for (std::size_t i = 0; i < 4; ++i) band_w[i] = context.guard_band[2 + i].d;
    const ClipPlanes& volume = context.draw.topology == Topology::points ? context.view_volume : context.frustum;
    side_x = volume[2].d;
    side_y = volume[4].d;
    half_width = context.guard_band[2].a;
    half_height = context.guard_band[5].b;
    is_zero_one = state.clip_z == ClipZ::zero_one;
    range_from = state.depth_range[0];
    range_by = state.depth_range[1] - state.depth_range[0];
    offset_x = offset_y = state.pixel_center == PixelCenter::integer ? 0.5 : 0.0;
    scale_y = state.origin == Origin::bottom_left ? -1 : 1;
    grid = static_cast<double>(std::int64_t{1} << config.subpixel_bits);
    grid_origin = snap_origin(state, config);
    codes = static_cast<double>((std::int64_t{1} << config.depth_bits) - 1);
    coordinate_shift = widths.grid_bits - config.subpixel_bits;
    reach = 2.0 * config.guard_band;
    limit = static_cast<std::int32_t>(config.guard_band << widths.grid_bits);
  }
};

/// Codes of clip-space vertices: which planes of the frustum they lie outside of, and whether they need the clipper.
HALFPLANE_INLINE I16 clip_codes(const VertexLanes& v, const Projection& p) {
  const auto is_inside = [](const D16& distance) HALFPLANE_LAMBDA { return convert<std::int32_t>(distance >= 0.0); };
  const auto bit = [](const I16& inside, int code) HALFPLANE_LAMBDA { return ~inside & code; };
  const I16 near = is_inside(v.z * p.near_z + v.w * p.near_w), far = is_inside(-v.z + v.w);
  const D16 side_x = v.w * p.side_x, side_y = v.w * p.side_y;
  const I16 volume = bit(near, 1) | bit(far, 2) | bit(is_inside(v.x + side_x), 4) | bit(is_inside(-v.x + side_x), 8) |
                     bit(is_inside(-v.y + side_y), 16) | bit(is_inside(v.y + side_y), 32);
  const D16 by_x = v.x * p.half_width, by_y = v.y * p.half_height;
  const L16 in_band = (by_x + v.w * p.band_w[0] >= 0.0) & (-by_x + v.w * p.band_w[1] >= 0.0) &
                      (-by_y + v.w * p.band_w[2] >= 0.0) & (by_y + v.w * p.band_w[3] >= 0.0) & (v.w > 0.0);
  // Inside all planes and with w at most this, every coordinate is small too.
  const L16 is_small = (v.w <= 1e300) & (max(max(v.x, -v.x), max(v.y, -v.y)) <= 1e300) & (max(v.z, -v.z) <= 1e300);
  return volume | bit(near & far & convert<std::int32_t>(in_band & is_small), Slice::kSlow);
}

/// Projects and snaps sixteen vertices; returns their codes. `kInView`: Slice::is_in_view, so that all codes are 0.
/// Vertices of other draws among them may become any rows.
template <bool kInView>
HALFPLANE_INLINE I16 project_lanes(const VertexLanes& v, const Projection& p, int target_height, VertexRow* out) {
  D16 x, y, z;
  I16 codes(0);
  if (kInView || p.is_clip_space) {
    D16 w = v.w;
    if constexpr (!kInView) {
      codes = clip_codes(v, p);
      const L16 is_fine = convert<std::int64_t>(codes < static_cast<int>(Slice::kSlow));
      w = select(is_fine, w, D16(1.0));  // others are not used
    }
    D16 nx = v.x, ny = v.y, nz = v.z;
    if (is_any(convert<std::int32_t>(w != 1.0))) {  // of two-dimensional programs all are 1
      nx = nx / w;
      ny = ny / w;
      nz = nz / w;
    }
    const D16 depth = p.is_zero_one ? nz : (nz + 1.0) * 0.5;  // halves are exact
    x = p.viewport.x + (nx + 1.0) * 0.5 * p.viewport.width;
    y = p.viewport.y + (1.0 - ny) * 0.5 * p.viewport.height;
    z = p.range_from + p.range_by * min(max(depth, D16(0.0)), D16(1.0));
  } else {
    x = v.x + p.offset_x;
    y = v.y + p.offset_y;
    if (p.scale_y < 0) y = static_cast<double>(target_height) - y;
    z = v.z;
  }
  L16 fits;
  if constexpr (!kInView) {
    // A coarse bound: larger values do not fit the conversions.
    fits = (max(x, -x) <= p.reach) & (max(y, -y) <= p.reach) & (z >= -1.0) & (z <= 2.0);
    x = select(fits, x, D16(0.0));
    y = select(fits, y, D16(0.0));
    z = select(fits, z, D16(0.0));
  }
  if (p.grid_origin != 0) {
    x = x - p.grid_origin;
    y = y - p.grid_origin;
  }
  I16 sx = snap_lanes(x, p.grid) << p.coordinate_shift, sy = snap_lanes(y, p.grid) << p.coordinate_shift;
  if (p.grid_origin != 0) {
    const std::int32_t half = 1 << (p.coordinate_shift - 1);
    sx = sx + half;
    sy = sy + half;
  }
  const I16 sz = snap_lanes(z, p.codes);
  if constexpr (kInView) {
    store_rows({sx, sy, sz, v.rgba}, out, sizeof(VertexRow));
    return codes;
  }
  const I16 is_legal = (sx >= -p.limit) & (sx < p.limit) & (sy >= -p.limit) & (sy < p.limit) & (sz >= 0) &
                       (sz <= static_cast<std::int32_t>(p.codes)) & convert<std::int32_t>(fits);
  store_rows({sx, sy, sz, v.rgba}, out, sizeof(VertexRow));
  return codes | (~is_legal & static_cast<int>(Slice::kSlow));
}

/// Slice::vertices, any_code, and, unless all vertices are in view, codes. Both vectors are large enough for sixteen more
/// than there are vertices.
static void project(const FrameContext& frame, Slice& slice) {
  const DrawContext& context = *slice.context;
  const PreparedScene& from = frame.prepared;
  const Projection projection(context, frame.widths);
  I16 any(0);
  const auto put = [&](const VertexLanes& lanes, std::size_t to) HALFPLANE_LAMBDA {
    const I16 codes = project_lanes<false>(lanes, projection, context.scene.height, slice.vertices.data() + to);
    codes.store(slice.codes.data() + to);
    any |= codes;
  };
  if (!slice.is_wide) {
    const auto vertices_at = [&from](std::size_t i) HALFPLANE_LAMBDA {
      return VertexLanes{D16::load(&from.x[i]), D16::load(&from.y[i]), D16::load(&from.z[i]), D16::load(&from.w[i]),
                         I16::load(&from.rgba[i])};
    };
    if (slice.is_in_view) {
      VertexRow* to = slice.vertices.data();
      for (std::size_t i = slice.low_index; i <= slice.high_index; i += 16, to += 16)
        (void)project_lanes<true>(vertices_at(i), projection, context.scene.height, to);
      slice.any_code = 0;
      return;
    }
    for (std::size_t i = slice.low_index, to = 0; i <= slice.high_index; i += 16, to += 16) put(vertices_at(i), to);
  } else {
    std::size_t to = 0;
    for (const Slice::Part& part : slice.parts)
      for (std::size_t corner = 0; corner < 3 * part.count; corner += 16) {
        std::array<std::size_t, 16> at;
        for (std::size_t k = 0; k < 16; ++k) {
          const std::size_t c = std::min(corner + k, 3 * part.count - 1);
          at[k] = from.index[c % 3][part.first + c / 3];
        }
        const auto attribute = [&at](const std::vector<double>& values) HALFPLANE_LAMBDA {
          return D16::of([&](int k) HALFPLANE_LAMBDA { return values[at[static_cast<std::size_t>(k)]]; });
        };
        put({attribute(from.x), attribute(from.y), attribute(from.z), attribute(from.w),
             I16::of([&](int k) HALFPLANE_LAMBDA {
               return static_cast<std::int32_t>(from.rgba[at[static_cast<std::size_t>(k)]]);
             })},
            to + corner);
        if (corner + 16 >= 3 * part.count) to += 3 * part.count;
      }
  }
  slice.any_code = 0;
  for (std::uint32_t bit = 1; bit <= Slice::kSlow; bit <<= 1)
    slice.any_code |= is_any((any & static_cast<int>(bit)) != 0) ? bit : 0;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
