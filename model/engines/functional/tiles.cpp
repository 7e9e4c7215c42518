#include "tiles.hpp"

#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "../../stages/multisample.hpp"
#include "../commands.hpp"
#include "../tile_kernel.hpp"

namespace halfplane {
namespace {

/// What became of the samples of some rows.
void count_fates(Counters& counters, const Skip& skip, bool writes, std::uint64_t covered, std::uint64_t passed,
                 std::uint64_t kept) {
  counters.covered += covered;
  counters.depth_passed += passed;
  if (skip.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
  counters.alpha_killed += passed - kept;
  if (writes) counters.written += kept;
}

/// The covered pixels of a row of a tile that begins at pixel (x, y), and those of them that are stored.
struct NotedRow {
  std::uint32_t primitive = 0, index = 0;
  int x = 0, y = 0;
  std::uint32_t covered = 0, kept = 0;
};

/// Counts and owners of a row, for whoever asked.
void note_row(Rendering& out, Owners& owners, bool writes, const NotedRow& row) {
  const auto first =
      static_cast<std::size_t>(row.y) * static_cast<std::size_t>(out.frame.width) + static_cast<std::size_t>(row.x);
  const auto for_each = [first](std::uint32_t bits, auto&& visit) {
    for (; bits != 0; bits &= bits - 1) visit(first + static_cast<std::size_t>(std::countr_zero(bits)));
  };
  if (!out.count.empty()) for_each(row.covered, [&](std::size_t pixel) { ++out.count[pixel]; });
  if (!writes) return;
  if (!owners.ids.empty())
    for_each(row.kept, [&](std::size_t pixel) { owners.ids[pixel] = static_cast<std::int32_t>(row.primitive); });
  if (!owners.visible.empty())
    for_each(row.kept, [&](std::size_t pixel) { owners.visible[pixel] = static_cast<std::int32_t>(row.index); });
}

/// A triangle whose pixels have several samples: each tile sample by sample, its colours once.
template <int T, class Lane>
class SampledTiles {
 public:
  using Kernel = TileKernel<T, Lane>;
  using Mask = typename Kernel::Mask;

  SampledTiles(const DrawContext& context, const Widths& widths, const RenderOptions& options, const Kernel& kernel,
               const Triangle& triangle, const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes,
               std::uint32_t index, Rendering& rendering)
      : context_(context),
        widths_(widths),
        options_(options),
        kernel_(kernel),
        triangle_(triangle),
        lanes_(lanes),
        index_(index),
        out_(rendering),
        setups_(setup, widths),
        samples_(setups_.sample.size()),
        writes_(context.fragment_ops.state.writes()) {
    const auto& v = triangle.v;
    is_back_ = shows_back(signed_area(v[0], v[1], v[2]), context.state.front);
    if (!has_surface(context.state)) return;
    surfaces_.reserve(samples_ + 1);
    for (int k = kAtCentre; k < widths.pixel_samples; ++k) {
      surfaces_.push_back(surface_of(context, triangle_, setups_.at(k), widths, offset_of(k, widths)));
    }
  }

  void draw() {
    const TriangleSetup& setup = setups_.centre;
    const int shift = widths_.tile_shift;
    for (int tile_y = setup.top >> shift; tile_y <= setup.bottom >> shift; ++tile_y)
      for (int tile_x = setup.left >> shift; tile_x <= setup.right >> shift; ++tile_x) visit(tile_x, tile_y);
  }

 private:
  /// A tile at work.
  struct Tile {
    int x, y;
    bool is_accepted = false;
    std::array<std::array<Mask, T>, kMaxPixelSamples + 1> covered;  ///< at the centre, at each sample
    std::array<Channels<Mask>, T> color;
    std::array<std::uint32_t, T> known{};  ///< columns of a row whose colour is there
  };
  /// The colours of a tile's pixels: from the centre, or from the first covered sample.
  struct PixelColors {
    static constexpr bool makes_all = true;
    SampledTiles& tiles;
    Tile& tile;
    void operator()(int j, const Mask& wanted, Channels<Mask>& channel) const {
      tiles.find_colors(tile, j, Kernel::to_bits(wanted));
      channel = tile.color[static_cast<std::size_t>(j)];
    }
  };

  void visit(int tile_x, int tile_y) {
    Counters& counters = out_.counters;
    ++counters.tiles_visited;
    std::array<EdgeValues, kMaxPixelSamples + 1> edges;
    bool is_outside = true, is_inside = true;
    for (int k = kAtCentre; k < widths_.pixel_samples; ++k) {
      EdgeValues& at = edges[static_cast<std::size_t>(k + 1)];
      at = edges_at_tile(setups_.at(k), tile_x, tile_y, widths_);
      const TileClass kind = classify(setups_.at(k), at, T);
      is_outside &= k == kAtCentre || kind == TileClass::outside;
      is_inside &= kind == TileClass::inside;
    }
    if (is_outside && options_.skip.tiles_outside) {
      ++counters.skipped.tiles_outside;
      return;
    }
    Tile tile;
    tile.x = tile_x;
    tile.y = tile_y;
    tile.is_accepted = is_inside && options_.skip.trivially_accepted;
    if (tile.is_accepted)
      ++counters.skipped.trivially_accepted;
    else
      counters.samples_tested += tile_box(setups_.centre, tile_x, tile_y, widths_).samples() * samples_;
    for (std::size_t m = 0; m <= samples_; ++m)
      tile.covered[m] =
          kernel_.coverage(setups_.at(static_cast<int>(m) - 1), lanes_, edges[m], tile.is_accepted, tile_x, tile_y);
    for (std::size_t k = 0; k < samples_; ++k) {
      if (options_.coverage_tap) tap(tile, k);
      if ((drawn_samples(context_.state) >> k & 1U) != 0) draw_sample(tile, k, edges[k + 1]);
    }
  }

  void tap(const Tile& tile, std::size_t k) const {
    TileMask bits{};
    for (std::size_t j = 0; j < T; ++j) bits[j] = Kernel::to_bits(tile.covered[k + 1][j]);
    options_.coverage_tap(index_, tile.x, tile.y, bits, static_cast<int>(k));
  }

  void draw_sample(Tile& tile, std::size_t k, const EdgeValues& edges) {
    Mask covered_count{}, passed_count{}, kept_count{};
    const auto on_row = [&](int j, const Mask& covered, const typename Kernel::Fates& fates) {
      covered_count += covered;
      passed_count += fates.passed;
      kept_count += fates.kept;
      if (options_.want_count || options_.want_ids)
        note_row(out_, out_.sample_owners[k], writes_,
                 {setups_.centre.primitive, index_, tile.x * T, tile.y * T + j, Kernel::to_bits(covered),
                  Kernel::to_bits(fates.kept)});
    };
    kernel_.draw(setups_.sample[k], lanes_, edges, tile.is_accepted, tile.x, tile.y, !options_.skip.fragments_early_z,
                 is_back_, out_.frame.samples[k], on_row, PixelColors{*this, tile}, static_cast<std::uint32_t>(k));
    count_fates(out_.counters, options_.skip, writes_, Kernel::count(covered_count), Kernel::count(passed_count),
                Kernel::count(kept_count));
  }

  /// Makes the colours of the wanted columns of row j that are not there yet.
  void find_colors(Tile& tile, int j, std::uint32_t wanted) const {
    const auto row = static_cast<std::size_t>(j);
    wanted &= ~tile.known[row];
    for (std::size_t m = 0; wanted != 0 && m <= samples_; ++m) {
      const std::uint32_t here = wanted & Kernel::to_bits(tile.covered[m][row]);
      if (here == 0) continue;
      wanted &= ~here;
      tile.known[row] |= here;
      const int place = static_cast<int>(m) - 1;
      if (surfaces_.empty())
        set(tile.color[row], here, kernel_.plane_colors(setups_.at(place), lanes_, tile.x, tile.y, j));
      else
        set_surface(tile, j, here, *surfaces_[m]);
    }
  }

  static void set(Channels<Mask>& channel, std::uint32_t columns, const Channels<Mask>& from) {
    for (; columns != 0; columns &= columns - 1) {
      const int i = std::countr_zero(columns);
      for (std::size_t c = 0; c < 4; ++c) channel[c][i] = from[c][i];
    }
  }

  static void set_surface(Tile& tile, int j, std::uint32_t columns, const Surface& surface) {
    for (; columns != 0; columns &= columns - 1) {
      const int i = std::countr_zero(columns);
      const std::array<std::uint32_t, 4> color = surface_channels(surface, tile.x * T + i, tile.y * T + j);
      for (std::size_t c = 0; c < 4; ++c) tile.color[static_cast<std::size_t>(j)][c][i] = color[c];
    }
  }

  const DrawContext& context_;
  const Widths& widths_;
  const RenderOptions& options_;
  const Kernel& kernel_;
  const Triangle& triangle_;
  const TriangleLanes<T, Lane>& lanes_;
  std::uint32_t index_;
  Rendering& out_;
  SampledSetup setups_;
  std::size_t samples_;
  bool writes_, is_back_ = false;
  std::vector<std::optional<Surface>> surfaces_;  ///< at the centre, at each sample; empty: colours are planes
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
        kernel_(context.fragment_ops, context.config, widths,
                context.depth_encode.is_identity() ? nullptr : &context.depth_encode),
        writes_(context.fragment_ops.state.writes()),
        wants_bits_(options.want_count || options.want_ids || options.coverage_tap) {}

  void draw(const Triangle& triangle, std::uint32_t index) {
    const TriangleSetup setup = setup_triangle(triangle, config_, widths_, context_.rect);
    if (setup.is_empty()) return;
    const TriangleLanes<T, Lane> lanes(setup, widths_);
    if (widths_.pixel_samples > 1) {
      SampledTiles<T, Lane>(context_, widths_, options_, kernel_, triangle, setup, lanes, index, out_).draw();
      return;
    }
    const std::optional<Surface> surface = surface_of(context_, triangle, setup, widths_);
    const auto& v = triangle.v;
    is_back_ = shows_back(signed_area(v[0], v[1], v[2]), context_.state.front);
    const int shift = widths_.tile_shift;
    for (int tile_y = setup.top >> shift; tile_y <= setup.bottom >> shift; ++tile_y)
      for (int tile_x = setup.left >> shift; tile_x <= setup.right >> shift; ++tile_x)
        visit(setup, lanes, surface, index, tile_x, tile_y);
  }

 private:
  using Mask = typename TileKernel<T, Lane>::Mask;

  void visit(const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes, const std::optional<Surface>& surface,
             std::uint32_t index, int tile_x, int tile_y) {
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

    if (!is_accepted) counters.samples_tested += tile_box(setup, tile_x, tile_y, widths_).samples();
    Mask covered_count{}, passed_count{}, kept_count{};
    TileMask bits{};  // filled when somebody wants it
    const auto on_row = [&](int j, const Mask& covered, const typename TileKernel<T, Lane>::Fates& fates) {
      covered_count += covered;
      passed_count += fates.passed;
      kept_count += fates.kept;
      if (!wants_bits_) return;
      bits[static_cast<std::size_t>(j)] = kernel_.to_bits(covered);
      note_row(
          out_, out_, writes_,
          {setup.primitive, index, tile_x * T, tile_y * T + j, kernel_.to_bits(covered), kernel_.to_bits(fates.kept)});
    };
    const auto color = [&](int j, const Mask& wanted, Channels<Mask>& channel) {
      if (surface) color_row(*surface, tile_x * T, tile_y * T + j, kernel_.to_bits(wanted), channel);
    };
    kernel_.draw(setup, lanes, edges, is_accepted, tile_x, tile_y, !options_.skip.fragments_early_z, is_back_,
                 out_.frame, on_row, color);
    count_fates(counters, options_.skip, writes_, kernel_.count(covered_count), kernel_.count(passed_count),
                kernel_.count(kept_count));
    if (options_.coverage_tap) options_.coverage_tap(index, tile_x, tile_y, bits, 0);
  }

  /// The surface's colours where somebody wants them, in place of those of its planes.
  static void color_row(const Surface& surface, int x, int y, std::uint32_t wanted, Channels<Mask>& channel) {
    for (; wanted != 0; wanted &= wanted - 1) {
      const int i = std::countr_zero(wanted);
      const std::array<std::uint32_t, 4> color = surface_channels(surface, x + i, y);
      for (std::size_t c = 0; c < 4; ++c) channel[c][i] = color[c];
    }
  }

  const DrawContext& context_;
  const Config& config_;
  const Widths& widths_;
  const RenderOptions& options_;
  Rendering& out_;
  TileKernel<T, Lane> kernel_;
  bool writes_, wants_bits_;
  bool is_back_ = false;  ///< of the triangle at work
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
  const bool fits_32_bits = derive_widths(config).depth().local.bits <= 32;
  return fits_32_bits ? render<T, std::uint32_t>(scene, config, options)
                      : render<T, std::uint64_t>(scene, config, options);
}

}  // namespace

Rendering render_tiles(const Scene& scene, const Config& plain_config, const RenderOptions& options) {
  const Config config = with_alpha(plain_config, scene);
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
