#include "scalar.hpp"

#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "../stages/fine_raster.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/multisample.hpp"
#include "../stages/tile_walk.hpp"
#include "../study/homogeneous_setup.hpp"
#include "../study/plane_rules.hpp"
#include "../study/traversal.hpp"
#include "commands.hpp"

namespace halfplane {
namespace {

/// The fragment in the tap's form.
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

/// A triangle from the host side, and its number.
struct NumberedTriangle {
  const Triangle& triangle;
  std::uint32_t index;
};

/// Buffers of the current tile, reused.
struct TileScratch {
  FragmentPacket fragment;          ///< the codes of a stamp
  std::vector<StampPacket> stamps;  ///< with several samples per pixel
  std::vector<TileMask> masks;      ///< likewise, by sample, if requested
};

/// Constants of a scene.
struct ScalarEngine {
  const Config& config;
  const RenderOptions& options;
  TileScratch& scratch;
  const Widths widths = derive_widths(config);
  /// Whether interpolate() has the codes of these rules: with faulty gradients, codes leave the range that hardware
  /// need not clamp to.
  [[nodiscard]] bool has_stage_planes() const {
    return options.rules.gradients == Gradients::one_reciprocal && options.rules.accumulator == Accumulator::wrap;
  }
  [[nodiscard]] int weight_bits() const { return options.rules.weights == Weights::four ? 4 : kTexelFraction; }
};

/// Sets a bit of a coverage tap: pixel (x, y) of a tile.
void set(TileMask& mask, int x, int y) { mask[static_cast<std::size_t>(y)] |= 1U << x; }

/// Rasterizes a triangle at the centres of pixels, and with several samples at each sample.
class TriangleRaster {
 public:
  TriangleRaster(const ScalarEngine& engine, const DrawContext& context, const NumberedTriangle& t,
                 const TriangleSetup& setup, Rendering& rendering)
      : engine_(engine),
        widths_(engine.widths),
        context_(context),
        t_(t),
        rendering_(rendering),
        centre_(setup),
        fragment_(engine.scratch.fragment),
        stamps_(engine.scratch.stamps),
        masks_(engine.scratch.masks) {
    if (widths_.has_samples != 0) sampled_.emplace(setup, widths_);
    places_.reserve(static_cast<std::size_t>(samples()) + 1);
    for (int k = kAtCentre; k < samples(); ++k) {
      const TriangleSetup& at = setup_at(k);
      places_.push_back({at, surface_of(context, t.triangle, at, widths_, offset_of(k, widths_))});
    }
    const auto& v = t.triangle.v;
    is_back_ = context.fragment_ops.stencil && shows_back(signed_area(v[0], v[1], v[2]), context.state.front);
  }

  /// Every tile of the box, classified; then fine_raster and each of its stamps.
  void raster() {
    packet_ = to_setup_packet(centre_, widths_);
    constants_ = make_context(packet_, widths_);
    edges_ = make_edge_context(packet_);
    const int shift = widths_.tile_shift;
    for (int y = centre_.top >> shift; y <= centre_.bottom >> shift; ++y)
      for (int x = centre_.left >> shift; x <= centre_.right >> shift; ++x) raster_tile(x, y);
  }

  /// Shades a covered pixel found by another traversal.
  void shade_pixel(int x, int y) {
    const Interpolated value = interpolate_by_rules(centre_, engine_.options.rules, widths_, x, y);
    if (engine_.options.fragment_tap) tap(value, x, y, 1, kAtCentre);
    shade(
        x, y, kAllSamples, kAtCentre, [&value](int) { return value.code[kDepthPlane]; },
        [&value] { return color_channels(value.code); });
  }

 private:
  struct Place {
    const TriangleSetup& setup;
    std::optional<Surface> surface;
  };
  [[nodiscard]] int samples() const { return widths_.has_samples != 0 ? widths_.pixel_samples : 0; }
  [[nodiscard]] const TriangleSetup& setup_at(int place) const { return sampled_ ? sampled_->at(place) : centre_; }
  [[nodiscard]] const Place& at(int place) const { return places_[static_cast<std::size_t>(place + 1)]; }

  void raster_tile(int tile_x, int tile_y) {
    const Skip& skip = engine_.options.skip;
    Counters& counters = rendering_.counters;
    ++counters.tiles_visited;
    bool is_outside = true, is_inside = true;  // with several samples the centre is not drawn
    for (const Place& place : places_) {
      const TileClass kind =
          classify(place.setup, edges_at_tile(place.setup, tile_x, tile_y, widths_), engine_.config.tile_size);
      is_outside &= kind == TileClass::outside || (sampled_ && &place == &places_.front());
      is_inside &= kind == TileClass::inside;
    }
    if (is_outside && skip.tiles_outside) {
      ++counters.skipped.tiles_outside;
      return;
    }
    TilePacket tile = make_tile_packet(packet_, tile_x, tile_y, 0, false, widths_);
    tile.is_inside = is_inside && skip.trivially_accepted;
    if (tile.is_inside)
      ++counters.skipped.trivially_accepted;
    else
      counters.samples_tested += to_bounds(tile.box).samples() * static_cast<std::uint64_t>(widths_.pixel_samples);
    if (engine_.options.coverage_tap) masks_.assign(static_cast<std::size_t>(widths_.pixel_samples), {});
    if (sampled_)
      shade_rows(tile);
    else
      fine_raster(tile, edges_, widths_, [&](const StampPacket& stamp) { shade_stamp(stamp, stamp.mask); });
    for (std::size_t k = 0; k < masks_.size(); ++k)
      engine_.options.coverage_tap(t_.index, tile_x, tile_y, masks_[k], static_cast<int>(k));
  }

  /// The stamps of a tile, each row of their pixels separately: the order of fragments with several samples.
  void shade_rows(const TilePacket& tile) {
    const StampGrid& stamps = widths_.stamps;
    stamps_.clear();
    fine_raster(tile, edges_, widths_, [&](const StampPacket& stamp) { stamps_.push_back(stamp); });
    for (int j = tile.box.top; j <= tile.box.bottom; ++j) {
      const int first = stamps.stamp_at(0, j);
      const SampleMask row(SampleMask::all(stamps.size).bits() << j % stamps.size * stamps.size);
      for (const StampPacket& stamp : stamps_)
        if (stamp.stamp >= first && stamp.stamp < first + stamps.stamps_per_row)
          shade_stamp(stamp, row & stamps.pixels_of(stamp.mask));
    }
  }

  /// Interpolates and shades these pixels of a stamp, which have a covered sample.
  void shade_stamp(const StampPacket& stamp, SampleMask pixels) {
    const StampGrid& stamps = widths_.stamps;
    const PixelOffset in_tile = stamps.origin_of(stamp.stamp);
    const bool has_stage_planes = engine_.has_stage_planes();
    if (has_stage_planes) interpolate_depths(stamp, constants_, pixels, widths_, fragment_);
    bool has_colors = false;
    pixels.for_each([&](std::size_t n) {
      const int pixel = static_cast<int>(n), first = pixel * stamps.per_pixel;
      const PixelOffset in_stamp = stamps.place_of(pixel);
      const int i = in_tile.x + in_stamp.x, j = in_tile.y + in_stamp.y;
      const unsigned covered = stamps.of_pixel(stamp.mask, pixel);
      for (std::size_t k = 0; k < masks_.size(); ++k)
        if ((covered >> k & 1U) != 0) set(masks_[k], i, j);
      const int x = (stamp.key.tile_x << widths_.tile_shift) + i, y = (stamp.key.tile_y << widths_.tile_shift) + j;
      if (!has_stage_planes) return shade_pixel(x, y);
      const int place = !sampled_ || stamp.centre.has(n) ? kAtCentre : std::countr_zero(covered);
      if (engine_.options.fragment_tap) tap(interpolate_at(at(place).setup, widths_, x, y), x, y, covered, place);
      shade(
          x, y, covered, place,
          [&](int k) { return fragment_depth(fragment_, static_cast<std::size_t>(first + k), widths_); },
          [&] {
            if (!std::exchange(has_colors, true))
              interpolate_planes(stamp, constants_, kColorPlane, widths_.affine_planes, pixels, widths_, fragment_);
            return color_channels(fragment_.code[n]);
          });
    });
  }

  /// The tests and rop for a pixel, shaded at `place`. color(): from its planes.
  template <class Depth, class Color>
  void shade(int x, int y, unsigned covered, int place, Depth&& depth, Color&& color) {
    const std::optional<Surface>& surface = at(place).surface;
    const auto shaded = [&]() -> std::array<std::uint32_t, 4> {
      if (!surface) return color();
      const Texel c = surface->at(x, y, engine_.weight_bits()).color;
      return {c[0], c[1], c[2], c[3]};
    };
    halfplane::shade_pixel(context_, engine_.options, x, y, covered, depth, shaded, centre_.primitive,
                           static_cast<std::int32_t>(t_.index), rendering_, is_back_);
  }

  /// Taps each covered sample as a fragment.
  void tap(const Interpolated& value, int x, int y, unsigned covered, int place) const {
    TappedFragment fragment = tapped(value, t_.triangle, t_.index, engine_.config.local_guard_bits, x, y);
    fragment.shaded_at = place;
    if (at(place).surface) fragment.surface = at(place).surface->at(x, y, engine_.weight_bits());
    for (fragment.sample = 0; fragment.sample < widths_.pixel_samples; ++fragment.sample) {
      if ((covered >> fragment.sample & 1U) == 0) continue;
      if (sampled_) fragment.plane[kDepthPlane] = plane_at(setup_at(fragment.sample), kDepthPlane, widths_, x, y);
      engine_.options.fragment_tap(fragment);
    }
  }

  const ScalarEngine& engine_;
  const Widths& widths_;
  const DrawContext& context_;
  NumberedTriangle t_;
  Rendering& rendering_;
  const TriangleSetup& centre_;
  std::optional<SampledSetup> sampled_;
  std::vector<Place> places_;  ///< the centre, and each sample of several
  bool is_back_ = false;
  SetupPacket packet_;
  ContextPacket constants_;
  EdgeContext edges_;
  FragmentPacket& fragment_;
  std::vector<StampPacket>& stamps_;
  std::vector<TileMask>& masks_;
};

/// Collects samples in any order into the masks of a coverage tap.
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

/// Rasterizes a triangle by rules other than the pipeline's.
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
  TriangleRaster raster(engine, context, t, setup, rendering);
  const auto emit = [&](int x, int y) {
    if (tiles) tiles->add(x, y);
    raster.shade_pixel(x, y);
  };
  std::uint64_t& tested = rendering.counters.samples_tested;
  switch (rules.traversal) {
    case Traversal::tiled: raster.raster(); break;
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

/// Draws the triangles of a draw without geometric clipping.
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
        "clipping homogeneous replaces setup and sampling: leave traversal, fill rule, gradients, accumulator and "
        "weights as they are");
  if (options.keeps_triangles())
    throw InputError("clipping homogeneous has no snapped triangles to keep; use clipping polygon");
}

}  // namespace

Rendering render_scalar(const Scene& scene, const Config& plain_config, const RenderOptions& options) {
  validate(plain_config);
  const Config config = with_alpha(plain_config, scene);
  check_options(options, config);
  TileScratch scratch;
  const ScalarEngine engine{config, options, scratch};
  const bool is_default = options.rules == StudyRules{};
  return run_commands(
      scene, config, options,
      [&](const DrawContext& context, const Triangle& triangle, std::uint32_t index, Rendering& rendering) {
        TriangleSetup setup = setup_triangle(triangle, config, engine.widths, context.rect);
        // brute visits the whole target regardless of the box.
        if (setup.is_empty() && (options.rules.traversal != Traversal::brute || setup.area == 0)) return;
        if (is_default)
          TriangleRaster(engine, context, {triangle, index}, setup, rendering).raster();
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
