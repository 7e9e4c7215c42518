#include "functional.hpp"

#include <bit>

#include "commands.hpp"

namespace halfplane {
namespace {

/// What the rows of a triangle's tiles have in common. Lane: 32 bits where depth codes and guard bits fit, else 64.
template <int T, class Lane>
struct TriangleLanes {
  using Depths = std::array<Lane, T>;
  using Colors = std::array<std::uint32_t, T>;

  LocalFormat<Lane> depth_format;
  LocalFormat<std::uint32_t> color_format;
  std::array<std::array<std::int32_t, T>, 3> edge_ramp{};  ///< column * step_x
  Depths depth_ramp{};                                     ///< (column - T/2) * step_x
  std::array<Colors, 4> color_ramp{};
  LocalPlane<Lane> depth;
  std::array<LocalPlane<std::uint32_t>, 4> color{};

  TriangleLanes(const TriangleSetup& setup, const Config& config, const Widths& widths)
      : depth_format(config.depth_bits, config.local_guard_bits), color_format(8, config.local_guard_bits) {
    depth = local_plane(0, setup.depth, depth_format, widths);
    for (std::size_t c = 0; c < 4; ++c) color[c] = local_plane(0, setup.color[c], color_format, widths);
    for (int i = 0; i < T; ++i) {
      const auto n = static_cast<std::size_t>(i);
      for (std::size_t e = 0; e < 3; ++e) edge_ramp[e][n] = -i * setup.edge[e].dy;
      depth_ramp[n] = static_cast<Lane>(static_cast<Lane>(i - T / 2) * depth.step_x);
      for (std::size_t c = 0; c < 4; ++c)
        color_ramp[c][n] = static_cast<std::uint32_t>(i - T / 2) * color[c].step_x;
    }
  }
};

/// A depth function as the three outcomes of one comparison: all bits set where the outcome passes.
struct DepthOutcomes {
  std::uint32_t less, equal, greater;
  explicit DepthOutcomes(DepthFunc func)
      : less(depth_passes(func, 0, 1) ? ~0U : 0U),
        equal(depth_passes(func, 0, 0) ? ~0U : 0U),
        greater(depth_passes(func, 1, 0) ? ~0U : 0U) {}
};

/// Draws the triangles of one draw, tile by tile; T is the tile size.
template <int T, class Lane>
class TileRaster {
 public:
  TileRaster(const DrawContext& context, const Widths& widths, const RenderOptions& options, Rendering& rendering)
      : context_(context),
        config_(context.config),
        widths_(widths),
        options_(options),
        out_(rendering),
        outcomes_(context.state.depth_test),
        writes_(context.state.depth_write || context.state.color_write) {}

  void draw(const Triangle& triangle, std::uint32_t index) {
    const TriangleSetup setup = setup_triangle(triangle, config_, widths_, context_.rect);
    if (setup.is_empty()) return;
    const TriangleLanes<T, Lane> lanes(setup, config_, widths_);
    const int shift = widths_.tile_shift;
    for (int tile_y = setup.top >> shift; tile_y <= setup.bottom >> shift; ++tile_y)
      for (int tile_x = setup.left >> shift; tile_x <= setup.right >> shift; ++tile_x)
        visit(setup, lanes, index, tile_x, tile_y);
  }

 private:
  using SignedLane = std::make_signed_t<Lane>;
  using Mask = std::array<std::uint32_t, T>;  ///< one lane per column: all bits set or none

  void visit(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, std::uint32_t index, int tile_x, int tile_y) {
    Counters& counters = out_.counters;
    ++counters.tiles_visited;
    const EdgeValues edges = edges_at_tile(setup, tile_x, tile_y, widths_);
    const TileClass kind = classify(setup, edges, T);
    if (kind == TileClass::outside && options_.skip.tiles_outside) {
      ++counters.skipped.tiles_outside;
      return;
    }
    const bool is_accepted = kind == TileClass::inside && options_.skip.trivially_accepted;
    counters.skipped.trivially_accepted += is_accepted ? 1 : 0;

    const int x0 = tile_x * T, y0 = tile_y * T;
    const int left = std::max(setup.left - x0, 0), right = std::min(setup.right - x0, T - 1);
    const int top = std::max(setup.top - y0, 0), bottom = std::min(setup.bottom - y0, T - 1);
    if (!is_accepted)
      counters.samples_tested += static_cast<std::uint64_t>(right - left + 1) * static_cast<std::uint64_t>(bottom - top + 1);
    Mask box;
    for (int i = 0; i < T; ++i) box[static_cast<std::size_t>(i)] = i >= left && i <= right ? ~0U : 0U;

    const auto depth_anchor = plane_at_tile(setup, setup.depth, tile_x, tile_y, widths_, 64);
    const Lane depth0 = local_plane(depth_anchor, setup.depth, lanes.depth_format, widths_).anchor;
    const std::array<std::int32_t, 3> edge0{saturate_tile_edge(edges[0], widths_), saturate_tile_edge(edges[1], widths_),
                                            saturate_tile_edge(edges[2], widths_)};
    TileMask tile_mask{};
    std::uint32_t covered_in_tile = 0;
    for (int j = top; j <= bottom; ++j) {
      const Mask covered = is_accepted ? box : cover_row(setup, lanes, edge0, box, j);
      const std::uint32_t bits = to_bits(covered);
      if (bits == 0) continue;
      tile_mask[static_cast<std::size_t>(j)] = bits;
      covered_in_tile += static_cast<std::uint32_t>(std::popcount(bits));
      const Lane row = static_cast<Lane>(depth0 + static_cast<Lane>(j - T / 2) * lanes.depth.step_y);
      shade_row(setup, lanes, index, {tile_x, tile_y, j}, covered, row);
    }
    counters.covered += covered_in_tile;
    if (options_.coverage_tap) options_.coverage_tap(index, tile_x, tile_y, tile_mask);
  }

  struct Row {
    int tile_x, tile_y, j;
  };

  static std::uint32_t to_bits(const Mask& mask) {
    std::uint32_t bits = 0;
    for (int i = 0; i < T; ++i) bits |= mask[static_cast<std::size_t>(i)] & (1U << i);
    return bits;
  }

  static Mask cover_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes,
                        const std::array<std::int32_t, 3>& edge0, const Mask& box, int j) {
    const std::int32_t e0 = edge0[0] + j * setup.edge[0].dx, e1 = edge0[1] + j * setup.edge[1].dx,
                       e2 = edge0[2] + j * setup.edge[2].dx;
    Mask covered;
    for (std::size_t i = 0; i < T; ++i) {
      // Covered when no edge value is negative: the sign bit of the three together is 0.
      const std::int32_t signs = (e0 + lanes.edge_ramp[0][i]) | (e1 + lanes.edge_ramp[1][i]) | (e2 + lanes.edge_ramp[2][i]);
      covered[i] = ~static_cast<std::uint32_t>(signs >> 31) & box[i];
    }
    return covered;
  }

  /// interpolate, depth_test and rop for one row of a tile. `row`: the depth accumulator of the row's middle column.
  void shade_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, std::uint32_t index, Row at,
                 const Mask& covered, Lane row) {
    const std::size_t first = out_.frame.at(at.tile_x * T, at.tile_y * T + at.j);
    std::uint32_t* stored_depth = out_.frame.depth.data() + first;
    const auto low = static_cast<SignedLane>(setup.depth_min), high = static_cast<SignedLane>(setup.depth_max);
    Mask depth, passed;
    for (std::size_t i = 0; i < T; ++i) {
      const Lane value = static_cast<Lane>(row + lanes.depth_ramp[i]);
      const auto z = static_cast<std::uint32_t>(decode(value, lanes.depth_format, low, high));
      const std::uint32_t stored = stored_depth[i];
      depth[i] = z;
      passed[i] = covered[i] & ((z < stored ? outcomes_.less : 0U) | (z == stored ? outcomes_.equal : 0U) |
                                (z > stored ? outcomes_.greater : 0U));
    }
    const std::uint32_t covered_bits = to_bits(covered), passed_bits = to_bits(passed);
    Counters& counters = out_.counters;
    const auto passes = static_cast<std::uint64_t>(std::popcount(passed_bits));
    counters.depth_passed += passes;
    if (options_.skip.fragments_early_z)
      counters.skipped.fragments_early_z += static_cast<std::uint64_t>(std::popcount(covered_bits)) - passes;
    if (writes_) counters.written += passes;
    if (!out_.count.empty()) for_each_pixel(at, covered_bits, [&](std::size_t pixel) { ++out_.count[pixel]; });
    if (!writes_ || (passed_bits == 0 && options_.skip.fragments_early_z)) return;

    if (context_.state.depth_write)
      for (std::size_t i = 0; i < T; ++i) stored_depth[i] = (depth[i] & passed[i]) | (stored_depth[i] & ~passed[i]);
    if (context_.state.color_write) color_row(setup, lanes, at, passed, out_.frame.color.data() + first);
    if (!out_.ids.empty())
      for_each_pixel(at, passed_bits, [&](std::size_t pixel) { out_.ids[pixel] = static_cast<std::int32_t>(setup.primitive); });
    if (!out_.visible.empty())
      for_each_pixel(at, passed_bits, [&](std::size_t pixel) { out_.visible[pixel] = static_cast<std::int32_t>(index); });
  }

  void color_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, Row at, const Mask& passed,
                 std::uint32_t* stored) {
    std::array<Mask, 4> channel;
    const bool has_alpha = config_.color_format == ColorFormat::rgba8888;
    for (std::size_t c = 0; c < (has_alpha ? 4U : 3U); ++c) {
      const auto anchor = plane_at_tile(setup, setup.color[c], at.tile_x, at.tile_y, widths_, 64);
      const std::uint32_t row = local_plane(anchor, setup.color[c], lanes.color_format, widths_).anchor +
                                static_cast<std::uint32_t>(at.j - T / 2) * lanes.color[c].step_y;
      const std::int32_t low = setup.color_min[c], high = setup.color_max[c];
      for (std::size_t i = 0; i < T; ++i)
        channel[c][i] = static_cast<std::uint32_t>(decode(row + lanes.color_ramp[c][i], lanes.color_format, low, high));
    }
    Mask packed;
    if (has_alpha)
      for (std::size_t i = 0; i < T; ++i)
        packed[i] = pack_rgba8888(channel[0][i], channel[1][i], channel[2][i], channel[3][i]);
    else
      for (std::size_t i = 0; i < T; ++i) packed[i] = pack_rgb565(channel[0][i], channel[1][i], channel[2][i]);
    for (std::size_t i = 0; i < T; ++i) stored[i] = (packed[i] & passed[i]) | (stored[i] & ~passed[i]);
  }

  template <class Visit>
  void for_each_pixel(Row at, std::uint32_t bits, Visit&& visit) const {
    const auto first = static_cast<std::size_t>(at.tile_y * T + at.j) * static_cast<std::size_t>(out_.frame.width) +
                       static_cast<std::size_t>(at.tile_x * T);
    for (; bits != 0; bits &= bits - 1) visit(first + static_cast<std::size_t>(std::countr_zero(bits)));
  }

  const DrawContext& context_;
  const Config& config_;
  const Widths& widths_;
  const RenderOptions& options_;
  Rendering& out_;
  DepthOutcomes outcomes_;
  bool writes_;
};

template <int T, class Lane>
Rendering render(const Scene& scene, const Config& config, const RenderOptions& options) {
  const Widths widths = derive_widths(config);
  return run_commands(scene, config, options, [&](const DrawContext& context, const Triangle& triangle, std::uint32_t index,
                                                  Rendering& rendering) {
    TileRaster<T, Lane>(context, widths, options, rendering).draw(triangle, index);
  });
}

template <int T>
Rendering render(const Scene& scene, const Config& config, const RenderOptions& options) {
  const bool fits_32_bits = derive_widths(config).local_depth.bits <= 32;
  return fits_32_bits ? render<T, std::uint32_t>(scene, config, options) : render<T, std::uint64_t>(scene, config, options);
}

}  // namespace

Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options) {
  validate(config);
  switch (config.tile_size) {
    case 4: return render<4>(scene, config, options);
    case 8: return render<8>(scene, config, options);
    case 16: return render<16>(scene, config, options);
    default: return render<32>(scene, config, options);
  }
}

}  // namespace halfplane
