#include "tiles.hpp"

#include <optional>

#include "../commands.hpp"
#include "../tile_kernel.hpp"

namespace halfplane {
namespace {

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
      note_row(setup, index, tile_x * T, tile_y * T + j, kernel_.to_bits(covered), kernel_.to_bits(fates.kept));
    };
    const auto color = [&](int j, const Mask& wanted, Channels<Mask>& channel) {
      if (surface) color_row(*surface, tile_x * T, tile_y * T + j, kernel_.to_bits(wanted), channel);
    };
    kernel_.draw(setup, lanes, edges, is_accepted, tile_x, tile_y, !options_.skip.fragments_early_z, is_back_,
                 out_.frame, on_row, color);
    count(kernel_.count(covered_count), kernel_.count(passed_count), kernel_.count(kept_count));
    if (options_.coverage_tap) options_.coverage_tap(index, tile_x, tile_y, bits);
  }

  void count(std::uint64_t covered, std::uint64_t passed, std::uint64_t kept) {
    Counters& counters = out_.counters;
    counters.covered += covered;
    counters.depth_passed += passed;
    if (options_.skip.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
    counters.alpha_killed += passed - kept;
    if (writes_) counters.written += kept;
  }

  /// The surface's colours where somebody wants them, in place of those of its planes.
  static void color_row(const Surface& surface, int x, int y, std::uint32_t wanted, Channels<Mask>& channel) {
    for (; wanted != 0; wanted &= wanted - 1) {
      const int i = std::countr_zero(wanted);
      const std::array<std::uint32_t, 4> color = surface_channels(surface, x + i, y);
      for (std::size_t c = 0; c < 4; ++c) channel[c][i] = color[c];
    }
  }

  /// Counts and owners of a row of a tile that begins at pixel (x, y), for whoever asked.
  void note_row(const TriangleSetup& setup, std::uint32_t index, int x, int y, std::uint32_t covered,
                std::uint32_t passed) {
    const auto first =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(out_.frame.width) + static_cast<std::size_t>(x);
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
