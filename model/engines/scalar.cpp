#include "scalar.hpp"

#include <bit>
#include <optional>
#include <vector>

#include "../stages/coarse_raster.hpp"
#include "../stages/fine_raster.hpp"
#include "../study/homogeneous_setup.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/multisample.hpp"
#include "../study/plane_rules.hpp"
#include "../study/traversal.hpp"
#include "commands.hpp"

namespace halfplane {
namespace {

/// As the tap has it.
TappedFragment tapped(const Interpolated& value, const Triangle& triangle, std::uint32_t index, int guard_bits, int x,
                      int y) {
  TappedFragment fragment{PrimitiveKind::triangle,
                          triangle.primitive,
                          triangle.draw,
                          index,
                          &triangle,
                          nullptr,
                          nullptr,
                          x,
                          y,
                          guard_bits,
                          {}};
  for (std::size_t p = 0; p < kMaxPlanes; ++p) fragment.plane[p] = {value.unrounded[p], value.code[p]};
  return fragment;
}

/// A triangle that the host side has left, and its number.
struct NumberedTriangle {
  const Triangle& triangle;
  std::uint32_t index;
};

/// One covered sample of a triangle through interpolate, depth_test and rop.
void shade_sample(const DrawContext& context, const TriangleSetup& setup, const Surface* surface, const Widths& widths,
                  const RenderOptions& options, const NumberedTriangle& t, int x, int y, Rendering& rendering) {
  const Interpolated value = interpolate_by_rules(setup, options.rules, widths, x, y);
  const int weight_bits = options.rules.weights == Weights::four ? 4 : kTexelFraction;
  if (options.fragment_tap) {
    TappedFragment fragment = tapped(value, t.triangle, t.index, context.config.local_guard_bits, x, y);
    if (surface != nullptr) fragment.surface = surface->at(x, y, weight_bits);
    options.fragment_tap(fragment);
  }
  const auto color = [&]() -> std::array<std::uint32_t, 4> {
    if (surface == nullptr) return color_channels(value.code);
    const Texel c = surface->at(x, y, weight_bits).color;
    return {c[0], c[1], c[2], c[3]};
  };
  const auto& v = t.triangle.v;
  shade_pixel(
      context, options, x, y, kAllSamples, [&value](int) { return value.code[kDepthPlane]; }, color, setup.primitive,
      static_cast<std::int32_t>(t.index), rendering,
      context.fragment_ops.stencil && shows_back(signed_area(v[0], v[1], v[2]), context.state.front));
}

/// What stays the same over a scene.
struct ScalarEngine {
  const Config& config;
  const RenderOptions& options;
  const Widths widths = derive_widths(config);
};

/// The pipeline's own traversal: coarse_raster and fine_raster.
void raster_tiles(const ScalarEngine& engine, const DrawContext& context, const TriangleSetup& setup,
                  const NumberedTriangle& t, Rendering& rendering) {
  const Config& config = engine.config;
  const Widths& widths = engine.widths;
  const Skip& skip = engine.options.skip;
  const int shift = widths.tile_shift;
  const SetupPacket packet = to_setup_packet(setup, widths);
  const EdgeContext edges = make_edge_context(setup);
  const std::optional<Surface> surface = surface_of(context, t.triangle, setup, widths);
  Counters& counters = rendering.counters;
  for (int tile_y = setup.top >> shift; tile_y <= setup.bottom >> shift; ++tile_y) {
    for (int tile_x = setup.left >> shift; tile_x <= setup.right >> shift; ++tile_x) {
      ++counters.tiles_visited;
      const TileClass kind = classify(setup, edges_at_tile(setup, tile_x, tile_y, widths), config.tile_size);
      if (kind == TileClass::outside && skip.tiles_outside) {
        ++counters.skipped.tiles_outside;
        continue;
      }
      TilePacket tile = make_tile_packet(packet, tile_x, tile_y, 0, false, widths);
      tile.is_inside = tile.is_inside && skip.trivially_accepted;
      if (tile.is_inside)
        ++counters.skipped.trivially_accepted;
      else
        counters.samples_tested += to_bounds(tile.box).samples();
      TileMask mask{};
      fine_raster(tile, edges, widths, [&](const StampPacket& covered) {
        const PixelOffset origin = widths.stamps.origin_of(covered.stamp);
        covered.mask.for_each([&](std::size_t s) {
          const PixelOffset pixel = widths.stamps.pixel_of(static_cast<int>(s));
          const int i = origin.x + pixel.x, j = origin.y + pixel.y;
          mask[static_cast<std::size_t>(j)] |= 1U << i;
          shade_sample(context, setup, surface ? &*surface : nullptr, engine.widths, engine.options, t,
                       (tile_x << shift) + i, (tile_y << shift) + j, rendering);
        });
      });
      if (engine.options.coverage_tap) engine.options.coverage_tap(t.index, tile_x, tile_y, mask, 0);
    }
  }
}

/// A triangle whose pixels have several samples, at the centre of pixels and at each sample: what the stages make of each.
class SampledTriangle {
 public:
  SampledTriangle(const ScalarEngine& engine, const DrawContext& context, const NumberedTriangle& t,
                  const TriangleSetup& setup)
      : engine_(engine),
        context_(context),
        t_(t),
        setups_(setup, engine.widths),
        packet_(to_setup_packet(setup, engine.widths)),
        edges_(make_edge_context(setup)) {
    places_.reserve(setups_.sample.size() + 1);
    for (int k = kAtCentre; k < engine.widths.pixel_samples; ++k) {
      const TriangleSetup& at = setups_.at(k);
      places_.push_back({at, surface_of(context, t.triangle, at, engine.widths, offset_of(k, engine.widths))});
    }
    const auto& v = t.triangle.v;
    is_back_ = context.fragment_ops.stencil && shows_back(signed_area(v[0], v[1], v[2]), context.state.front);
  }

  /// coarse_raster, fine_raster at each sample, and one shading of each pixel.
  void raster(Rendering& rendering) const {
    const TriangleSetup& setup = setups_.centre;
    const int shift = engine_.widths.tile_shift;
    for (int y = setup.top >> shift; y <= setup.bottom >> shift; ++y)
      for (int x = setup.left >> shift; x <= setup.right >> shift; ++x) raster_tile(x, y, rendering);
  }

 private:
  struct Place {
    const TriangleSetup& setup;
    std::optional<Surface> surface;
  };
  [[nodiscard]] const Place& at(int place) const { return places_[static_cast<std::size_t>(place + 1)]; }

  /// Of a tile, the covered pixels at their centres, if a sample of them is, and at each sample.
  [[nodiscard]] std::vector<TileMask> masks_in(int tile_x, int tile_y, bool is_accepted) const {
    const Widths& widths = engine_.widths;
    const StampGrid& stamps = widths.stamps;
    TilePacket tile = make_tile_packet(packet_, tile_x, tile_y, 0, false, widths);
    tile.is_inside = is_accepted;
    std::vector<TileMask> mask(setups_.sample.size() + 1);
    fine_raster(tile, edges_, widths, [&](const StampPacket& covered) {
      const PixelOffset origin = stamps.origin_of(covered.stamp);
      const auto set = [&](TileMask& at, int pixel) {
        const PixelOffset in_stamp = stamps.pixel_of(pixel * stamps.per_pixel);
        at[static_cast<std::size_t>(origin.y + in_stamp.y)] |= 1U << (origin.x + in_stamp.x);
      };
      covered.centre.for_each([&](std::size_t pixel) { set(mask[0], static_cast<int>(pixel)); });
      covered.mask.for_each([&](std::size_t s) {
        const int sample = static_cast<int>(s);
        set(mask[static_cast<std::size_t>(sample % stamps.per_pixel) + 1], sample / stamps.per_pixel);
      });
    });
    return mask;
  }

  void raster_tile(int tile_x, int tile_y, Rendering& rendering) const {
    const Widths& widths = engine_.widths;
    const Skip& skip = engine_.options.skip;
    Counters& counters = rendering.counters;
    ++counters.tiles_visited;
    bool is_outside = true, is_inside = true;
    for (const Place& place : places_) {
      const TileClass kind =
          classify(place.setup, edges_at_tile(place.setup, tile_x, tile_y, widths), engine_.config.tile_size);
      is_outside &= kind == TileClass::outside || &place == &places_.front();
      is_inside &= kind == TileClass::inside;
    }
    if (is_outside && skip.tiles_outside) {
      ++counters.skipped.tiles_outside;
      return;
    }
    const bool is_accepted = is_inside && skip.trivially_accepted;
    const std::uint64_t pixels = tile_box(setups_.centre, tile_x, tile_y, widths).samples();
    if (is_accepted)
      ++counters.skipped.trivially_accepted;
    else
      counters.samples_tested += pixels * setups_.sample.size();
    const std::vector<TileMask> mask = masks_in(tile_x, tile_y, is_accepted);
    for (int j = 0; j < engine_.config.tile_size; ++j)
      for (int i = 0; i < engine_.config.tile_size; ++i) {
        const auto is_set = [&](std::size_t m) { return (mask[m][static_cast<std::size_t>(j)] >> i & 1U) != 0; };
        unsigned covered = 0;
        for (std::size_t k = 0; k < setups_.sample.size(); ++k) covered |= is_set(k + 1) ? 1U << k : 0U;
        if (covered == 0) continue;
        const int place = is_set(0) ? kAtCentre : std::countr_zero(covered);
        shade((tile_x << widths.tile_shift) + i, (tile_y << widths.tile_shift) + j, covered, place, rendering);
      }
    if (engine_.options.coverage_tap)
      for (std::size_t k = 0; k < setups_.sample.size(); ++k)
        engine_.options.coverage_tap(t_.index, tile_x, tile_y, mask[k + 1], static_cast<int>(k));
  }

  /// One pixel: its colour from `place`, the depth of each covered sample from there.
  void shade(int x, int y, unsigned covered, int place, Rendering& rendering) const {
    const Widths& widths = engine_.widths;
    const Place& shaded = at(place);
    const auto depth = [&](int k) { return plane_at(setups_.at(k), kDepthPlane, widths, x, y).code; };
    if (engine_.options.fragment_tap) {
      TappedFragment fragment = tapped(interpolate_at(shaded.setup, widths, x, y), t_.triangle, t_.index,
                                       engine_.config.local_guard_bits, x, y);
      fragment.shaded_at = place;
      if (shaded.surface) fragment.surface = shaded.surface->at(x, y);
      for (int k = 0; k < widths.pixel_samples; ++k) {
        if ((covered >> k & 1U) == 0) continue;
        fragment.sample = k;
        fragment.plane[kDepthPlane] = plane_at(setups_.at(k), kDepthPlane, widths, x, y);
        engine_.options.fragment_tap(fragment);
      }
    }
    const auto color = [&]() -> std::array<std::uint32_t, 4> {
      return shaded.surface ? surface_channels(*shaded.surface, x, y)
                            : color_channels(interpolate_at(shaded.setup, widths, x, y).code);
    };
    shade_pixel(context_, engine_.options, x, y, covered, depth, color, setups_.centre.primitive,
                static_cast<std::int32_t>(t_.index), rendering, is_back_);
  }

  const ScalarEngine& engine_;
  const DrawContext& context_;
  const NumberedTriangle& t_;
  SampledSetup setups_;
  SetupPacket packet_;
  EdgeContext edges_;
  std::vector<Place> places_;  ///< of the centre, and of each sample
  bool is_back_ = false;
};

/// Gathers samples that come in any order into the masks that a coverage tap takes.
class TapTiles {
 public:
  TapTiles(const TriangleSetup& setup, int tile_shift)
      : shift_(tile_shift),
        first_x_(setup.left >> tile_shift),
        first_y_(setup.top >> tile_shift),
        columns_((setup.right >> tile_shift) - first_x_ + 1),
        masks_(static_cast<std::size_t>(columns_) *
               static_cast<std::size_t>((setup.bottom >> tile_shift) - first_y_ + 1)) {}

  void add(int x, int y) {
    const int column = (x >> shift_) - first_x_, row = (y >> shift_) - first_y_;
    const int last = (1 << shift_) - 1;
    masks_[static_cast<std::size_t>(row * columns_ + column)][static_cast<std::size_t>(y & last)] |= 1U << (x & last);
  }

  void send(const CoverageTap& tap, std::uint32_t index) const {
    for (std::size_t i = 0; i < masks_.size(); ++i)
      tap(index, first_x_ + static_cast<int>(i) % columns_, first_y_ + static_cast<int>(i) / columns_, masks_[i], 0);
  }

 private:
  int shift_, first_x_, first_y_, columns_;
  std::vector<TileMask> masks_;
};

/// A triangle by other rules than the pipeline's.
void raster_by_rules(const ScalarEngine& engine, const DrawContext& context, const NumberedTriangle& t,
                     TriangleSetup& setup, Rendering& rendering) {
  const StudyRules& rules = engine.options.rules;
  const int grid_bits = engine.widths.grid_bits;
  const auto& corner = t.triangle.v;
  const auto v = canonical(corner, signed_area(corner[0], corner[1], corner[2]));
  set_fill_rule(setup, v, rules.fill_rule, engine.widths);
  set_planes(setup, v, rules, engine.config, engine.widths);
  const bool taps = static_cast<bool>(engine.options.coverage_tap) && !setup.is_empty();
  std::optional<TapTiles> tiles;
  if (taps && rules.traversal != Traversal::tiled) tiles.emplace(setup, engine.widths.tile_shift);
  const std::optional<Surface> surface = surface_of(context, t.triangle, setup, engine.widths);
  const auto emit = [&](int x, int y) {
    if (tiles) tiles->add(x, y);
    shade_sample(context, setup, surface ? &*surface : nullptr, engine.widths, engine.options, t, x, y, rendering);
  };
  std::uint64_t& tested = rendering.counters.samples_tested;
  switch (rules.traversal) {
    case Traversal::tiled: raster_tiles(engine, context, setup, t, rendering); break;
    case Traversal::bbox: tested += traverse_bbox(setup, engine.widths, emit); break;
    case Traversal::scanline: {
      const PixelBounds box{setup.left, setup.top, setup.right, setup.bottom};
      tested += traverse_scanline(v, box, rules.fill_rule, grid_bits, emit);
      break;
    }
    case Traversal::brute: {
      const Framebuffer& frame = rendering.frame;
      tested += traverse_brute(v, context.rect, frame.width, frame.height, rules.fill_rule, grid_bits, emit);
      break;
    }
  }
  if (tiles) tiles->send(engine.options.coverage_tap, t.index);
}

/// The triangles of a draw without geometric clipping.
void draw_homogeneous(const ScalarEngine& engine, const DrawContext& context, std::uint32_t& primitive,
                      Rendering& rendering) {
  if (has_surface(context.state))
    throw InputError(
        place_of_draw(context.scene.name, context.draw.line) +
        ": clipping homogeneous has no textures, no colours over w, no fog and no light; use clipping polygon");
  const HomogeneousFrame frame{engine.config, engine.widths, context.state, context.viewport, context.rect};
  Counters& counters = rendering.counters;
  for_each_homogeneous(context.scene, context.draw, frame, [&](const HomogeneousSetup& setup) {
    const std::uint32_t number = primitive++;
    ++counters.primitives_in;
    ++(setup.rejection == Rejection::none ? counters.drawn : counters.culled);
    counters.skipped.frustum += setup.rejection == Rejection::outside ? 1 : 0;
    counters.skipped.zero_area += setup.rejection == Rejection::zero_area ? 1 : 0;
    counters.skipped.backface += setup.rejection == Rejection::backface ? 1 : 0;
    counters.skipped.empty += setup.rejection == Rejection::empty ? 1 : 0;
    counters.samples_tested += traverse_homogeneous(setup, [&](int x, int y) {
      const Interpolated value = interpolate_at(setup, engine.widths, x, y);
      shade_pixel(
          context, engine.options, x, y, kAllSamples, [&value](int) { return value.code[kDepthPlane]; },
          [&value] { return color_channels(value.code); }, number, kVisibleOutline, rendering, setup.is_back);
    });
  });
}

void check_options(const RenderOptions& options, const Config& config) {
  const StudyRules& rules = options.rules;
  if (config.msaa_samples > 1 && rules != StudyRules{})
    throw InputError(
        "msaa.samples: other rules for traversal, fill rule, gradients, accumulator, weights or clipping are of pixels "
        "with one sample; leave them as they are, or use msaa.samples=1");
  if (rules.clipping == Clipping::polygon) return;
  if (rules != StudyRules{.clipping = rules.clipping})
    throw InputError(
        "clipping homogeneous has its own setup and samples: leave traversal, fill rule, gradients, accumulator and "
        "weights as they are");
  if (options.keeps_triangles())
    throw InputError("clipping homogeneous has no snapped triangles to keep; use clipping polygon");
}

}  // namespace

Rendering render_scalar(const Scene& scene, const Config& plain_config, const RenderOptions& options) {
  validate(plain_config);
  const Config config = with_alpha(plain_config, scene);
  check_options(options, config);
  const ScalarEngine engine{config, options};
  const bool is_default = options.rules == StudyRules{};
  return run_commands(
      scene, config, options,
      [&](const DrawContext& context, const Triangle& triangle, std::uint32_t index, Rendering& rendering) {
        TriangleSetup setup = setup_triangle(triangle, config, engine.widths, context.rect);
        // brute visits the whole target whatever the box is.
        if (setup.is_empty() && (options.rules.traversal != Traversal::brute || setup.area == 0)) return;
        if (config.msaa_samples > 1)
          SampledTriangle(engine, context, {triangle, index}, setup).raster(rendering);
        else if (is_default)
          raster_tiles(engine, context, setup, {triangle, index}, rendering);
        else
          raster_by_rules(engine, context, {triangle, index}, setup, rendering);
      },
      [&](const DrawContext& context, std::uint32_t& primitive, Rendering& rendering) {
        if (options.rules.clipping == Clipping::polygon || context.state.space == Space::window) return false;
        draw_homogeneous(engine, context, primitive, rendering);
        return true;
      });
}

}  // namespace halfplane
