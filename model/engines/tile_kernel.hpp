// One tile of one triangle, a row of lanes at a time: the bits of fine_raster, interpolate, depth_test and rop, fused.
// The functional and the cycle engine share it; the tests hold it against the stages.
#pragma once

#include <bit>
#include <cstring>

#include "../stages/fragment_ops.hpp"
#include "../stages/depth_encode.hpp"
#include "../stages/interpolate.hpp"
#include "render.hpp"

namespace halfplane {

/// N lanes of a T. The compiler maps them to whatever vector registers it may use.
template <class T, int N>
struct LanesOf {
  typedef T type __attribute__((vector_size(sizeof(T) * N)));  // NOLINT(modernize-use-using): GCC drops it there
};
template <class T, int N>
using Lanes = typename LanesOf<T, N>::type;

template <class Vector, class Element>
void load(Vector& vector, const Element* from) {
  std::memcpy(&vector, from, sizeof vector);
}
template <class Vector, class Element>
void store(Element* to, const Vector& vector) {
  std::memcpy(to, &vector, sizeof vector);
}

/// What the rows of a triangle's tiles have in common. Lane: 32 bits where depth codes and guard bits fit, else 64.
template <int T, class Lane>
struct TriangleLanes {
  LocalFormat<Lane> depth_format;
  LocalFormat<std::uint32_t> color_format;
  std::array<Lanes<std::int32_t, T>, 3> edge_ramp;  ///< column * step_x
  Lanes<Lane, T> depth_ramp;                        ///< (column - T/2) * step_x
  std::array<Lanes<std::uint32_t, T>, 4> color_ramp;
  LocalPlane<Lane> depth;
  std::array<LocalPlane<std::uint32_t>, 4> color;

  TriangleLanes(const TriangleSetup& setup, const Widths& widths)
      : depth_format(widths.depth()), color_format(widths.color()) {
    Lanes<std::int32_t, T> column;
    Lanes<Lane, T> depth_column;
    for (int i = 0; i < T; ++i) {
      column[i] = i;
      depth_column[i] = static_cast<Lane>(i - T / 2);
    }
    for (std::size_t e = 0; e < 3; ++e) edge_ramp[e] = column * -setup.edge[e].dy;
    depth = local_plane(0, setup.plane[kDepthPlane], depth_format, widths);
    depth_ramp = depth_column * depth.step_x;
    for (std::size_t c = 0; c < 4; ++c) {
      color[c] = local_plane(0, setup.plane[kColorPlane + c], color_format, widths);
      color_ramp[c] = (Lanes<std::uint32_t, T>)(column - T / 2) * color[c].step_x;
    }
  }
};

/// Leaves the colours of a row as its planes have them.
template <class Mask>
struct PlaneColors {
  void operator()(int /*row*/, const Mask& /*wanted*/, Channels<Mask>& /*color*/) const {}
};

/// T: the tile size. The tiles of triangles that share the operations of their fragments.
template <int T, class Lane>
class TileKernel {
 public:
  using Mask = Lanes<std::uint32_t, T>;  ///< one lane per column: all bits set or none

  /// `encode`: not null where stored codes are not plane codes.
  TileKernel(const FragmentOps& ops, const Config& config, const Widths& widths, const DepthEncode* encode = nullptr)
      : ops_(ops),
        widths_(widths),
        encode_(encode),
        channels_(static_cast<std::size_t>(widths.color_planes)),
        format_(config.color_format),
        outcomes_(ops.state.depth_test),
        alpha_outcomes_(ops.alpha.func) {}

  /// What the operations made of a row's lanes.
  struct Fates {
    Mask passed;  ///< the stencil and the depth test
    Mask kept;    ///< of those, what the alpha test has not dropped
    Mask passed_stencil;
  };

  /// Draws the part of tile (tile_x, tile_y) that lies in the triangle's box. `edges`: the edge values at the tile's
  /// first pixel; `is_accepted`: no need to look at them. Calls on_row(j, covered, fates) for each row with a covered
  /// sample. `shades_failed`: colours are computed even where the depth test has failed. `is_back`: the triangle shows its
  /// back. color(j, wanted, channels) may replace the colours of a row's wanted lanes; a Color with `makes_all` makes them.
  /// `sample`: of its pixels, where they have several and `setup` is that of a sample.
  template <class OnRow, class Color = PlaneColors<Mask>>
  void draw(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, const EdgeValues& edges, bool is_accepted,
            int tile_x, int tile_y, bool shades_failed, bool is_back, Framebuffer& frame, OnRow&& on_row,
            Color&& color = {}, std::uint32_t sample = 0) const {
    const PixelBounds box = tile_box(setup, tile_x, tile_y, widths_);
    Mask in_box;
    for (int i = 0; i < T; ++i) in_box[i] = i >= box.left && i <= box.right ? ~0U : 0U;
    const auto anchor = plane_at_tile(setup.plane[kDepthPlane], tile_offset(setup, tile_x, tile_y, widths_), 64);
    Tile tile{tile_x, tile_y, local_plane(anchor, setup.plane[kDepthPlane], lanes.depth_format, widths_).anchor};
    tile.sample = sample;
    if (ops_.stencil) tile.stencil = &(*ops_.stencil)[is_back ? 1 : 0];
    const std::array<std::int32_t, 3> edge0{saturate_tile_edge(edges[0], widths_),
                                            saturate_tile_edge(edges[1], widths_),
                                            saturate_tile_edge(edges[2], widths_)};
    for (int j = box.top; j <= box.bottom; ++j) {
      Mask covered = in_box;
      if (!is_accepted) cover_row(setup, lanes, edge0, j, covered);
      if (is_any(covered)) on_row(j, covered, shade_row(setup, lanes, tile, j, covered, shades_failed, frame, color));
    }
  }

  /// What draw() takes for covered, row by row; in the tile's box.
  [[nodiscard]] std::array<Mask, T> coverage(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes,
                                             const EdgeValues& edges, bool is_accepted, int tile_x, int tile_y) const {
    const PixelBounds box = tile_box(setup, tile_x, tile_y, widths_);
    const std::array<std::int32_t, 3> edge0{saturate_tile_edge(edges[0], widths_),
                                            saturate_tile_edge(edges[1], widths_),
                                            saturate_tile_edge(edges[2], widths_)};
    std::array<Mask, T> rows{};
    for (int j = box.top; j <= box.bottom; ++j) {
      Mask& covered = rows[static_cast<std::size_t>(j)];
      for (int i = box.left; i <= box.right; ++i) covered[i] = ~0U;
      if (!is_accepted) cover_row(setup, lanes, edge0, j, covered);
    }
    return rows;
  }

  /// The colours of the planes of row j of a tile, of all its lanes.
  [[nodiscard]] Channels<Mask> plane_colors(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, int tile_x,
                                            int tile_y, int j) const {
    Tile tile{tile_x, tile_y, 0};
    return color_row(setup, lanes, tile, j);
  }

  /// Set lanes of the masks that were added up in `sum`: a mask lane is -1.
  static std::uint32_t count(const Mask& sum) {
    std::uint32_t count = 0;
    for (int i = 0; i < T; ++i) count -= sum[i];
    return count;
  }

  static std::uint32_t to_bits(const Mask& mask) {
    std::uint32_t bits = 0;
    for (int i = 0; i < T; ++i) bits |= mask[i] & (1U << i);
    return bits;
  }

 private:
  /// One tile of one triangle while its rows are drawn.
  struct Tile {
    int x, y;                              ///< tiles
    Lane depth;                            ///< accumulator at the anchor
    std::array<std::uint32_t, 4> color{};  ///< likewise; valid when has_color
    bool has_color = false;
    const Stencil* stencil = nullptr;
    std::uint32_t sample = 0;  ///< of its pixels
  };

  static bool is_any(const Mask& mask) {
    std::array<std::uint64_t, sizeof(Mask) / 8> words;
    std::memcpy(words.data(), &mask, sizeof mask);
    std::uint64_t any = 0;
    for (const std::uint64_t word : words) any |= word;
    return any != 0;
  }

  /// Keeps the columns of row j where no edge value is negative: there the sign bit of the three together is 0.
  static void cover_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes,
                        const std::array<std::int32_t, 3>& edge0, int j, Mask& covered) {
    const std::int32_t e0 = edge0[0] + j * setup.edge[0].dx, e1 = edge0[1] + j * setup.edge[1].dx,
                       e2 = edge0[2] + j * setup.edge[2].dx;
    const auto signs = (lanes.edge_ramp[0] + e0) | (lanes.edge_ramp[1] + e1) | (lanes.edge_ramp[2] + e2);
    covered &= ~(Mask)(signs >> 31);
  }

  /// The codes of a row of accumulators, clamped to the vertices' range: decode() lane by lane.
  template <class Accumulator>
  static Mask decode_row(const Lanes<Accumulator, T>& value, const LocalFormat<Accumulator>& format, std::uint32_t low,
                         std::uint32_t high) {
    using Signed = std::make_signed_t<Accumulator>;
    using Row = Lanes<Signed, T>;
    const Row bias = Row{} + static_cast<Signed>(Signed{1} << (format.bits - 1));
    const Row lowest = Row{} + static_cast<Signed>(low), highest = Row{} + static_cast<Signed>(high);
    Row code = (Row)((value & format.modulus_mask) >> format.guard_bits) - bias;
    code = code < lowest ? lowest : code;
    code = code > highest ? highest : code;
    if constexpr (sizeof(Accumulator) == sizeof(std::uint32_t))
      return (Mask)code;
    else
      return __builtin_convertvector(code, Mask);
  }

  /// interpolate, the tests and rop for row j of a tile.
  template <class Color>
  Fates shade_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, Tile& tile, int j,
                  const Mask& covered, bool shades_failed, Framebuffer& frame, Color&& color) const {
    const std::size_t first = frame.at(tile.x * T, tile.y * T + j);
    std::uint32_t* stored_depth = frame.depth.data() + first;
    const Lane row = static_cast<Lane>(tile.depth + static_cast<Lane>(j - T / 2) * lanes.depth.step_y);
    const Lanes<Lane, T> value = lanes.depth_ramp + row;
    Mask depth =
        decode_row<Lane>(value, lanes.depth_format, setup.range.low[kDepthPlane], setup.range.high[kDepthPlane]);
    if (encode_ != nullptr)
      for (int i = 0; i < T; ++i) depth[i] = covered[i] != 0 ? (*encode_)(depth[i]) : 0;
    Mask stored;
    load(stored, stored_depth);
    const Mask is_nearer = outcomes_(depth, stored);
    Mask passes_stencil = ~Mask{}, stencil{};
    if (tile.stencil != nullptr) {
      for (int i = 0; i < T; ++i) stencil[i] = frame.stencil[first + static_cast<std::size_t>(i)];
      const std::uint32_t read = tile.stencil->read_mask;
      passes_stencil =
          DepthOutcomes(tile.stencil->func)(Mask(Mask{} + (tile.stencil->reference & read)), Mask(stencil & read));
    }
    const Mask passed = covered & passes_stencil & is_nearer;
    const bool writes_stencil = tile.stencil != nullptr && halfplane::writes_stencil(*tile.stencil);
    if (!shades_failed && !is_any(writes_stencil ? covered : passed)) return {passed, passed, passes_stencil};
    Mask kept = covered;
    Channels<Mask> channel;
    const bool tests_alpha = ops_.alpha.func != DepthFunc::always || ops_.alpha_samples != 0;
    if (tests_alpha || ops_.state.color_write) {
      if constexpr (!requires { std::remove_cvref_t<Color>::makes_all; }) channel = color_row(setup, lanes, tile, j);
      color(j, tests_alpha && writes_stencil ? covered : passed, channel);
    }
    if (tests_alpha) kept &= alpha_outcomes_(channel[3], Mask(Mask{} + ops_.alpha.reference));
    if (ops_.alpha_samples != 0)
      kept &= lane_mask<Mask>(Mask(Mask{} + tile.sample) <
                              samples_of_alpha(channel[3], static_cast<std::uint32_t>(ops_.alpha_samples)));
    if (writes_stencil) store_stencil(*tile.stencil, kept, passes_stencil, is_nearer, stencil, &frame.stencil[first]);
    kept &= passed;
    if (ops_.state.depth_write) store(stored_depth, write_where(kept, depth, stored));
    if (ops_.state.color_write) {
      std::uint32_t* stored_color = frame.color.data() + first;
      load(stored, stored_color);
      store(stored_color, write_where(kept, store_row(tile, j, channel, stored), stored));
    }
    return {passed, kept, passes_stencil};
  }

  void store_stencil(const Stencil& s, const Mask& kept, const Mask& passes_stencil, const Mask& is_nearer,
                     const Mask& stored, std::uint8_t* to) const {
    Mask result = write_where(is_nearer, apply_stencil(s.passes, s, stored), apply_stencil(s.depth_fails, s, stored));
    result = write_where(passes_stencil, result, apply_stencil(s.stencil_fails, s, stored));
    result = write_where(kept, result, stored);
    for (int i = 0; i < T; ++i) to[i] = static_cast<std::uint8_t>(result[i]);
  }

  /// The codes that colours leave of stored ones.
  Mask store_row(const Tile& tile, int j, const Channels<Mask>& channel, const Mask& stored) const {
    if (ops_.color.is_plain()) return pack_color(format_, channel);
    Mask threshold{};
    if (ops_.color.dithers)
      for (int i = 0; i < T; ++i) threshold[i] = dither_threshold(tile.x * T + i, tile.y * T + j);
    return store_color(ops_.color, format_, channel, stored, threshold);
  }

  /// The colours of a row's planes.
  Channels<Mask> color_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, Tile& tile, int j) const {
    if (!tile.has_color) {
      tile.has_color = true;
      const TileOffset offset = tile_offset(setup, tile.x, tile.y, widths_);
      for (std::size_t c = 0; c < channels_; ++c) {
        const auto anchor = plane_at_tile(setup.plane[kColorPlane + c], offset, 64);
        tile.color[c] = local_plane(anchor, setup.plane[kColorPlane + c], lanes.color_format, widths_).anchor;
      }
    }
    Channels<Mask> channel{};
    for (std::size_t c = 0; c < channels_; ++c) {
      const std::uint32_t row = tile.color[c] + static_cast<std::uint32_t>(j - T / 2) * lanes.color[c].step_y;
      const Mask value = lanes.color_ramp[c] + row;
      channel[c] = decode_row<std::uint32_t>(value, lanes.color_format, setup.range.low[kColorPlane + c],
                                             setup.range.high[kColorPlane + c]);
    }
    return channel;
  }

  FragmentOps ops_;
  const Widths& widths_;
  const DepthEncode* encode_;
  std::size_t channels_;
  ColorFormat format_;
  DepthOutcomes outcomes_, alpha_outcomes_;
};

}  // namespace halfplane
