#include "functional.hpp"

#include <bit>
#include <cstring>

#include "commands.hpp"

namespace halfplane {
namespace {

/// N lanes of a T. The compiler maps them to whatever vector registers it may use.
template <class T, int N>
struct LanesOf {
  typedef T type __attribute__((vector_size(sizeof(T) * N)));
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

  TriangleLanes(const TriangleSetup& setup, const Config& config, const Widths& widths)
      : depth_format(config.depth_bits, config.local_guard_bits), color_format(8, config.local_guard_bits) {
    Lanes<std::int32_t, T> column;
    Lanes<Lane, T> depth_column;
    for (int i = 0; i < T; ++i) {
      column[i] = i;
      depth_column[i] = static_cast<Lane>(i - T / 2);
    }
    for (std::size_t e = 0; e < 3; ++e) edge_ramp[e] = column * -setup.edge[e].dy;
    depth = local_plane(0, setup.depth, depth_format, widths);
    depth_ramp = depth_column * depth.step_x;
    for (std::size_t c = 0; c < 4; ++c) {
      color[c] = local_plane(0, setup.color[c], color_format, widths);
      color_ramp[c] = (Lanes<std::uint32_t, T>)(column - T / 2) * color[c].step_x;
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
        writes_(context.state.depth_write || context.state.color_write),
        wants_bits_(options.want_count || options.want_ids || options.coverage_tap) {}

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
  using Mask = Lanes<std::uint32_t, T>;  ///< one lane per column: all bits set or none

  /// One tile of one triangle while its rows are drawn.
  struct Tile {
    int x, y;                              ///< tiles
    Lane depth;                            ///< accumulator at the anchor
    std::array<std::uint32_t, 4> color{};  ///< likewise; valid when has_color
    bool has_color = false;
    Mask covered_count{}, passed_count{};  ///< per column, negated: a mask lane is -1
    TileMask bits{};                       ///< filled when somebody wants it
  };

  void visit(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, std::uint32_t index, int tile_x,
             int tile_y) {
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
      counters.samples_tested +=
          static_cast<std::uint64_t>(right - left + 1) * static_cast<std::uint64_t>(bottom - top + 1);
    Mask box;
    for (int i = 0; i < T; ++i) box[i] = i >= left && i <= right ? ~0U : 0U;

    const auto anchor = plane_at_tile(setup, setup.depth, tile_x, tile_y, widths_, 64);
    Tile tile{tile_x, tile_y, local_plane(anchor, setup.depth, lanes.depth_format, widths_).anchor};
    const std::array<std::int32_t, 3> edge0{saturate_tile_edge(edges[0], widths_),
                                            saturate_tile_edge(edges[1], widths_),
                                            saturate_tile_edge(edges[2], widths_)};
    for (int j = top; j <= bottom; ++j) {
      Mask covered = box;
      if (!is_accepted) cover_row(setup, lanes, edge0, j, covered);
      if (is_any(covered)) shade_row(setup, lanes, index, tile, j, covered);
    }
    count(tile);
    if (options_.coverage_tap) options_.coverage_tap(index, tile_x, tile_y, tile.bits);
  }

  void count(const Tile& tile) {
    std::uint64_t covered = 0, passed = 0;
    for (int i = 0; i < T; ++i) {
      covered -= static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(tile.covered_count[i])});
      passed -= static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(tile.passed_count[i])});
    }
    Counters& counters = out_.counters;
    counters.covered += covered;
    counters.depth_passed += passed;
    if (options_.skip.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
    if (writes_) counters.written += passed;
  }

  static bool is_any(const Mask& mask) {
    std::array<std::uint64_t, sizeof(Mask) / 8> words;
    std::memcpy(words.data(), &mask, sizeof mask);
    std::uint64_t any = 0;
    for (const std::uint64_t word : words) any |= word;
    return any != 0;
  }

  static std::uint32_t to_bits(const Mask& mask) {
    std::uint32_t bits = 0;
    for (int i = 0; i < T; ++i) bits |= mask[i] & (1U << i);
    return bits;
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

  /// interpolate, depth_test and rop for row j of a tile.
  void shade_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, std::uint32_t index, Tile& tile,
                 int j, const Mask& covered) {
    const std::size_t first = out_.frame.at(tile.x * T, tile.y * T + j);
    std::uint32_t* stored_depth = out_.frame.depth.data() + first;
    const Lane row = static_cast<Lane>(tile.depth + static_cast<Lane>(j - T / 2) * lanes.depth.step_y);
    const Lanes<Lane, T> value = lanes.depth_ramp + row;
    const Mask depth = decode_row<Lane>(value, lanes.depth_format, setup.depth_min, setup.depth_max);
    Mask stored;
    load(stored, stored_depth);
    const Mask passed =
        covered & (((Mask)(depth < stored) & outcomes_.less) | ((Mask)(depth == stored) & outcomes_.equal) |
                   ((Mask)(depth > stored) & outcomes_.greater));
    tile.covered_count += covered;
    tile.passed_count += passed;
    if (wants_bits_) note_row(setup, index, tile, j, to_bits(covered), to_bits(passed));
    if (!writes_ || (options_.skip.fragments_early_z && !is_any(passed))) return;
    if (context_.state.depth_write) store(stored_depth, (depth & passed) | (stored & ~passed));
    if (context_.state.color_write) color_row(setup, lanes, tile, j, passed, out_.frame.color.data() + first);
  }

  void color_row(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, Tile& tile, int j, const Mask& passed,
                 std::uint32_t* stored_color) {
    const bool has_alpha = config_.color_format == ColorFormat::rgba8888;
    const std::size_t channels = has_alpha ? 4 : 3;
    if (!tile.has_color) {
      tile.has_color = true;
      for (std::size_t c = 0; c < channels; ++c) {
        const auto anchor = plane_at_tile(setup, setup.color[c], tile.x, tile.y, widths_, 64);
        tile.color[c] = local_plane(anchor, setup.color[c], lanes.color_format, widths_).anchor;
      }
    }
    std::array<Mask, 4> channel;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::uint32_t row = tile.color[c] + static_cast<std::uint32_t>(j - T / 2) * lanes.color[c].step_y;
      const Mask value = lanes.color_ramp[c] + row;
      channel[c] = decode_row<std::uint32_t>(value, lanes.color_format, setup.color_min[c], setup.color_max[c]);
    }
    const Mask packed = has_alpha ? pack_rgba8888(channel[0], channel[1], channel[2], channel[3])
                                  : pack_rgb565(channel[0], channel[1], channel[2]);
    Mask stored;
    load(stored, stored_color);
    store(stored_color, (packed & passed) | (stored & ~passed));
  }

  /// Counts, owners and coverage bits of row j, for whoever asked.
  void note_row(const TriangleSetup& setup, std::uint32_t index, Tile& tile, int j, std::uint32_t covered,
                std::uint32_t passed) {
    tile.bits[static_cast<std::size_t>(j)] = covered;
    const auto first = static_cast<std::size_t>(tile.y * T + j) * static_cast<std::size_t>(out_.frame.width) +
                       static_cast<std::size_t>(tile.x * T);
    const auto for_each = [first](std::uint32_t bits, auto&& visit) {
      for (; bits != 0; bits &= bits - 1) visit(first + static_cast<std::size_t>(std::countr_zero(bits)));
    };
    if (!out_.count.empty()) for_each(covered, [&](std::size_t pixel) { ++out_.count[pixel]; });
    if (!writes_) return;
    if (!out_.ids.empty())
      for_each(passed, [&](std::size_t pixel) { out_.ids[pixel] = static_cast<std::int32_t>(setup.primitive); });
    if (!out_.visible.empty())
      for_each(passed, [&](std::size_t pixel) { out_.visible[pixel] = static_cast<std::int32_t>(index); });
  }

  const DrawContext& context_;
  const Config& config_;
  const Widths& widths_;
  const RenderOptions& options_;
  Rendering& out_;
  DepthOutcomes outcomes_;
  bool writes_, wants_bits_;
};

template <int T, class Lane>
Rendering render(const Scene& scene, const Config& config, const RenderOptions& options) {
  const Widths widths = derive_widths(config);
  return run_commands(
      scene, config, options,
      [&](const DrawContext& context, const Triangle& triangle, std::uint32_t index, Rendering& rendering) {
        TileRaster<T, Lane>(context, widths, options, rendering).draw(triangle, index);
      });
}

template <int T>
Rendering render(const Scene& scene, const Config& config, const RenderOptions& options) {
  const bool fits_32_bits = derive_widths(config).local_depth.bits <= 32;
  return fits_32_bits ? render<T, std::uint32_t>(scene, config, options)
                      : render<T, std::uint64_t>(scene, config, options);
}

}  // namespace

Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options) {
  validate(config);
  if (options.rules != StudyRules{})
    throw InputError("the functional engine has no other traversal, fill rule or clipping; use the scalar engine");
  switch (config.tile_size) {
    case 4: return render<4>(scene, config, options);
    case 8: return render<8>(scene, config, options);
    case 16: return render<16>(scene, config, options);
    default: return render<32>(scene, config, options);
  }
}

}  // namespace halfplane
