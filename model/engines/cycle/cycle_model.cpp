#include "cycle_model.hpp"

#include <algorithm>
#include <bit>

#include "../../host/viewport.hpp"
#include "../../packets/state_packets.hpp"
#include "../../stages/coarse_raster.hpp"
#include "../../stages/cull.hpp"
#include "../../stages/fine_raster.hpp"
#include "../../stages/fragment_path.hpp"
#include "../../stages/hiz.hpp"
#include "../../stages/interpolate.hpp"
#include "../../stages/primitive_join.hpp"
#include "../hardware.hpp"
#include "pipelined_timing.hpp"
#include "serial_timing.hpp"
#include "stamp_images.hpp"

namespace halfplane {
namespace {

/// Whether the area is negative with the vertices as cull_serial sorts them: the sort swaps two and rotates all three.
bool is_negative_when_sorted(const std::array<SnappedVertex, 3>& v, std::int64_t area) {
  const bool swaps_first = canonically_before(v[1], v[0]);
  const bool swaps_again = canonically_before(swaps_first ? v[1] : v[0], v[2]);
  return (area < 0) != (swaps_first != swaps_again);
}

PrimitiveWork work_of(const PrimitivePacket& packet, bool is_dropped) {
  PrimitiveWork work;
  const PrimitiveKind kind = packet.kind;
  work.is_triangle = kind == PrimitiveKind::triangle;
  work.is_line = kind == PrimitiveKind::line;
  work.is_state = kind == PrimitiveKind::state;
  work.is_counted = is_counted(kind);
  work.is_dropped = is_dropped;
  if (!work.is_triangle) return work;
  const auto v = to_snapped(packet.vertex);
  const std::int64_t area = signed_area(v[0], v[1], v[2]);
  const auto size = static_cast<std::uint64_t>(area < 0 ? -area : area);
  work.is_negative = is_negative_when_sorted(v, area);
  work.log2_area = size == 0 ? 0 : static_cast<int>(std::bit_width(size - 1));
  return work;
}

/// Computes the bits of the stages, stamp by stamp, and `Timing` for each. Packets leave a stage in an order that does
/// not depend on time.
template <class Timing>
class CycleModelOf final : public CycleModel {
 public:
  CycleModelOf(const Config& config, MemoryTiming& memory, const CycleOptions& options)
      : config_(config),
        widths_(derive_widths(config)),
        options_(options),
        timing_(config_, widths_, options.stalls, memory, options.parameters, options.sink, options.textures),
        hiz_(config_, widths_, options.parameters.untested_tiles),
        path_(config_, widths_),
        coverage_(static_cast<std::size_t>(widths_.stamps.stamps())) {
    if (config_.cache_kind == CacheKind::blocks)
      blocks_.emplace(config_, widths_);
    else
      tiles_.emplace(config_, widths_);
    if (options.layout) timing_.set_layout(*options.layout);
    if (config_.compress_units != 0)
      timing_.look_at_colors([this](const StampAddress& at, SampleMask mask) {
        images_->enter(at);
        return images_->has_one_color(mask);
      });
  }

  void hold_textures(const Scene& scene) override { texels_ = TextureMemory(scene, config_); }

  void begin(int width, int height, Cycle cycle) override {
    Framebuffer held = std::move(rendering_.frame);
    rendering_ = {};
    if (held.width == width && held.height == height) {
      rendering_.frame = std::move(held);
    } else {
      rendering_.frame = Framebuffer(width, height, config_.tile_size);
      fill_padding(rendering_.frame.depth, snap_depth(1.0, config_.depth_bits));  // as in an empty target
      fill_padding(rendering_.frame.color, pack_color(config_.color_format, {0, 0, 0, 255}));
      if (widths_.has_samples != 0)
        rendering_.frame.samples.assign(static_cast<std::size_t>(config_.msaa_samples), Framebuffer(rendering_.frame));
    }
    images_.emplace(frames(), widths_);
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (options_.want_count) rendering_.count.resize(pixels);
    if (options_.want_ids) rendering_.ids.assign(pixels, -1);
    if (options_.want_cost) cost_.assign(pixels, 0);
    if (options_.want_misses) misses_.assign(pixels, 0);
    timing_.begin(cycle);
  }

  void run(const HostPrimitive& host) override {
    if (options_.sink != nullptr) options_.sink->primitive(host);
    if (host.packet.kind != PrimitiveKind::fast_clear || options_.parameters.fast_clear != 0) {
      send(host, host.packet);
      return;
    }
    PrimitivePacket drawn = host.packet;
    drawn.kind = PrimitiveKind::rectangle;
    drawn.state.depth_test = DepthFunc::always;
    const ColorState held = path_.colors();
    const StencilState held_stencil = path_.stencil();
    StencilState stencil = held_stencil;
    if (drawn.state.depth_write && has_stencil(config_)) {
      stencil.side[0] = replacing_stencil(stencil.clear_value());
      (void)set_stencil_flags(drawn.state, stencil.side);
    }
    set({}, stencil);  // a clear ignores the colour registers
    send(host, drawn);
    set(held, held_stencil);
  }

  [[nodiscard]] const CounterPacket& counters() const override { return counters_; }
  [[nodiscard]] const TimingTotals& totals() const override { return timing_.totals(); }
  [[nodiscard]] const Stream& stream(Arrow boundary) const override { return timing_.stream(boundary); }
  [[nodiscard]] Rendering& rendering() override { return rendering_; }
  [[nodiscard]] std::vector<float>& cost() override { return cost_; }
  [[nodiscard]] std::vector<float>& misses() override { return misses_; }

 private:
  /// Sends a primitive of the host down the pipeline as `primitive`.
  void send(const HostPrimitive& host, const PrimitivePacket& primitive) {
    const auto triangle = cull(primitive, widths_, counters_, config_.setup_kind == SetupKind::pipelined);
    timing_.take(work_of(primitive, !triangle));
    if (!triangle) return;
    switch (triangle->kind) {
      case PrimitiveKind::fast_clear: fast_clear(*triangle); return;
      case PrimitiveKind::flush: flush(*triangle); return;
      case PrimitiveKind::state:
        timing_.end_token([&](Cycle offered) {
          BlockItem item;
          set_state(*triangle, item.texture);
          return timing_.access(offered, TagResult{}, item);
        });
        return;
      case PrimitiveKind::line: draw_line(*triangle, *host.line, host.primitive); return;
      case PrimitiveKind::triangle:
      case PrimitiveKind::rectangle:
      case PrimitiveKind::point: draw(setup_packet(*triangle, config_, widths_), host.primitive); return;
    }
  }

  void fast_clear(const TrianglePacket& clear) {
    const int last_x = clear.box.right >> widths_.tile_shift, last_y = clear.box.bottom >> widths_.tile_shift;
    const PerPlane<std::uint32_t>& code = clear.vertex.code[0];
    const std::array<bool, 2> planes{clear.state.depth_write, clear.state.color_write};
    if (planes[0]) {
      hiz_.clear(last_x, last_y, code[kDepthPlane]);
      if (config_.hiz_bits != 0)
        timing_.clear_bounds(static_cast<std::uint64_t>((last_x >> widths_.hiz_group_bits) + 1) *
                             static_cast<std::uint64_t>(last_y + 1));
      for (Framebuffer& frame : frames()) {
        fill(frame.depth, to_bounds(clear.box), code[kDepthPlane]);
        if (has_stencil(config_)) fill(frame.stencil, to_bounds(clear.box), path_.stencil().clear_value());
      }
    }
    timing_.end_token([&](Cycle offered) {
      if (blocks_) return timing_.pass_token(offered, *blocks_, true, clear.state, last_x, last_y);
      return timing_.pass_token(offered,
                                [&](auto& mover) { tiles_->fast_clear(last_x, last_y, planes, mover, counters_); });
    });
    if (planes[1])  // after the blocks evicted before it
      for (Framebuffer& frame : frames())
        fill(frame.color, to_bounds(clear.box), pack_color(config_.color_format, color_channels(code)));
    if (planes[0] || planes[1]) std::ranges::fill(rendering_.ids, -1);
  }

  /// One image for each sample of a pixel.
  [[nodiscard]] std::span<Framebuffer> frames() {
    if (widths_.has_samples == 0) return {&rendering_.frame, 1};
    return rendering_.frame.samples;
  }

  /// Pads the right ends of the rows and the rows below; the first clear fills the rest.
  void fill_padding(Framebuffer::Image& image, std::uint32_t code) const {
    const Framebuffer& frame = rendering_.frame;
    const auto row = [&](int y) { return image.begin() + static_cast<std::ptrdiff_t>(frame.at(0, y)); };
    for (int y = 0; y < frame.height; ++y) std::fill(row(y) + frame.width, row(y) + frame.stride, code);
    std::fill(row(frame.height), image.end(), code);
  }

  /// Leaves the padding alone.
  template <class Image>
  void fill(Image& image, const PixelBounds& box, typename Image::value_type code) const {
    for (int y = box.top; y <= box.bottom; ++y)
      std::fill_n(image.begin() + static_cast<std::ptrdiff_t>(rendering_.frame.at(box.left, y)),
                  box.right - box.left + 1, code);
  }

  void flush(const TrianglePacket& packet) {
    const int last_x = packet.box.right >> widths_.tile_shift, last_y = packet.box.bottom >> widths_.tile_shift;
    timing_.end_token([&](Cycle offered) {
      if (blocks_) return timing_.pass_token(offered, *blocks_, false, packet.state, last_x, last_y);
      return timing_.pass_token(offered, [&](auto& mover) { tiles_->flush(last_x, last_y, mover, counters_); });
    });
  }

  void draw_line(const TrianglePacket& token, const LineSetup& line, std::uint32_t primitive) {
    const PrimitiveState& state = token.state;
    SetupPacket setup;  // input of HiZ
    setup.state = state;
    hiz_.pass_line(setup);
    fragment_.kind = token.kind;
    fragment_.state = state;
    fragment_.coordinates = token.coordinates;
    LineState next = first_state(line);
    FragmentPlace place;
    place.depth_write = state.depth_write;
    StampFate fate;
    const auto step = [&] {
      const LinePixel pixel = pixel_of(next, line, widths_);
      set_line_pixel(pixel, widths_, fragment_);
      place = place_of(fragment_);
      fate = {};
      if (place.mask.any()) fate = shade(nullptr, nullptr, primitive);
      if (!pixel.is_last) advance(next, line, widths_);
      return !pixel.is_last;
    };
    const auto look_up = [&](auto& mover) {
      const bool hits = tiles_->access(place.tile_x, place.tile_y, mover, counters_);
      if (fate.kept.any()) tiles_->wrote(place.tile_x, place.tile_y, place.stamp, state.depth_write, state.color_write);
      return hits;
    };
    const auto look_up_block = [&](BlockItem& item) {
      return place.mask.any() ? block_access(place, fate, item) : TagResult{};  // no sample is drawn
    };
    const Cycle before = timing_.last_fragment();
    timing_.end_token([&](Cycle offered) {
      return blocks_ ? timing_.take_block_pixels(offered, step, look_up_block)
                     : timing_.take_pixels(offered, place, step, look_up);
    });
    if (!options_.want_cost) return;
    const float cycles = static_cast<float>(timing_.last_fragment() - before) / static_cast<float>(line.remaining + 1);
    line_raster(line, widths_, [&](const LinePixel& pixel) { cost_[plain_index(pixel.x, pixel.y)] += cycles; });
  }

  [[nodiscard]] static FragmentPlace place_of(const FragmentPacket& fragment) {
    return {fragment.key.tile_x, fragment.key.tile_y, fragment.stamp, fragment.mask, fragment.state.depth_write};
  }

  /// Looks up the current fragment in the tags of a framebuffer of blocks, and records its fate.
  TagResult block_access(const FragmentPlace& place, const StampFate& fate, BlockItem& item) {
    const PrimitiveState& state = fragment_.state;
    const ColorState& colors = path_.colors();
    const StampAddress at{fragment_.key.tile_x, fragment_.key.tile_y, fragment_.stamp};
    item.mask = place.mask;
    item.stamp = block_stamp(at, widths_).stamp;
    item.depth_write = state.writes_word();
    item.color_write = state.color_write;
    item.blends = blends_;
    item.is_late = is_late(state, colors.tests_alpha(), config_);
    item.wrote_depth = fate.written.any();
    if (state.color_write) item.colors = fate.kept;
    item.is_shaded = (colors.tests_alpha() ? fate.passed | fate.changed : item.colors).any();
    item.texture.lookups = fate.lookups;
    if (fate.shaded.any()) {
      if (fragment_.coordinates.divides_colors) item.texture.divided = path_.units()->texture.groups(fate.shaded);
      if (path_.units()->light.is_lit(fragment_.kind == PrimitiveKind::triangle))
        item.texture.lit = fate.shaded.count();
    }
    return blocks_->access(at, state, place.mask == SampleMask::all(widths_.samples));
  }

  /// The images and the texture memory, as the fragment path sees them.
  struct StampPort {
    static constexpr bool kSendsPackets = false;
    CycleModelOf& model;
    const StampPacket* stamp;  ///< null: a pixel of a line, whose fragment has all of its codes
    const ContextPacket* context;

    [[nodiscard]] std::span<const std::uint32_t> stored() const { return model.images_->words(model.fragment_.mask); }
    void interpolate_colors(SampleMask samples) const {
      interpolate(kColorPlane, model.widths_.affine_planes, samples);
    }
    void interpolate_over_w(SampleMask samples) const {
      interpolate(model.widths_.affine_planes, model.widths_.planes, samples);
    }
    void interpolate(int first, int end, SampleMask samples) const {
      if (stamp == nullptr) return;
      const SampleMask pixels = model.widths_.stamps.pixels_of(samples);
      interpolate_planes(*stamp, *context, first, end, pixels, model.widths_, model.fragment_);
    }
    [[nodiscard]] TextureLine read(std::uint32_t address, int /*beats*/) const {
      TextureLine line;
      model.texels_.read(address, line);
      return line;
    }
    [[nodiscard]] std::span<const std::uint32_t> stored_colors(SampleMask samples) const {
      return model.images_->colors(samples);
    }
    void send(const WritePacket&) const {}
    void send(const ColorPacket&) const {}
    void write(const WritePacket& packet) const { model.images_->write(packet); }
  };

  /// Takes the current fragment from depth_test to the framebuffer.
  StampFate shade(const StampPacket* stamp, const ContextPacket* context, std::uint32_t primitive) {
    images_->enter({fragment_.key.tile_x, fragment_.key.tile_y, fragment_.stamp});
    const StampFate fate = path_.shade(fragment_, counters_, StampPort{*this, stamp, context});
    if (options_.want_count || options_.want_ids) note_samples(fate.kept, primitive);
    if (options_.want_misses)
      for (const TextureLookup& lookup : fate.lookups)
        if (lookup.is_miss) {
          const PixelOffset at = images_->pixel(lookup.sample * static_cast<std::size_t>(widths_.pixel_samples));
          misses_[plain_index(at.x, at.y)] += 1.0F;
        }
    return fate;
  }

  /// Counts the fragment's samples, and notes the owners of the stored ones: a pixel has the owner of its first sample.
  void note_samples(SampleMask kept, std::uint32_t primitive) {
    const bool counts = is_counted(fragment_.kind);
    fragment_.mask.for_each([&](std::size_t s) {
      const PixelOffset at = images_->pixel(s);
      const std::size_t plain = plain_index(at.x, at.y);
      if (counts && !rendering_.count.empty()) ++rendering_.count[plain];
      if (s % static_cast<std::size_t>(widths_.pixel_samples) == 0 && kept.has(s) && !rendering_.ids.empty() &&
          (fragment_.state.writes() || !counts))
        rendering_.ids[plain] = counts ? static_cast<std::int32_t>(primitive) : -1;
    });
  }

  [[nodiscard]] std::size_t plain_index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering_.frame.width) + static_cast<std::size_t>(x);
  }

  /// The times of coarse_raster's walk.
  struct WalkWatch {
    Timing& timing;
    bool rejects;
    void read_ahead() const { timing.read_ahead(); }
    void skip_outside() const { timing.skip_outside(); }
    void read_bound() const { timing.read_bound(); }
    void skip_behind() const { timing.skip_behind(); }
  };

  /// Runs coarse_raster, and for each visit the rest of the pipeline.
  void draw(const SetupPacket& setup, std::uint32_t primitive) {
    const ContextPacket context = make_context(setup, widths_);
    const EdgeContext edges = make_edge_context(setup);
    const StampEdges places(edges, widths_);
    coarse_raster(
        setup, 0, hiz_, widths_, counters_,
        [&](const TilePacket& tile) {
          if (tile.is_visit)
            visit(tile, edges, places, context, primitive);
          else
            timing_.end_walk([&](Cycle offered) { return timing_.pass(offered); });
        },
        WalkWatch{timing_, options_.parameters.rejects != 0});
  }

  void visit(const TilePacket& tile, const EdgeContext& edges, const StampEdges& places, const ContextPacket& context,
             std::uint32_t primitive) {
    const StampGrid& stamps = widths_.stamps;
    const int tile_x = tile.key.tile_x, tile_y = tile.key.tile_y;
    const int first_stamp = stamps.stamp_at(tile.box.left, tile.box.top),
              last_stamp = stamps.stamp_at(tile.box.right, tile.box.bottom);
    TileVisitWork work{tile.ends_primitive,           stamps.row_of(first_stamp),   stamps.row_of(last_stamp),
                       stamps.column_of(first_stamp), stamps.column_of(last_stamp), {}};
    cover_tile(tile, edges, places, widths_, [&](int number, SampleMask samples, SampleMask centres) {
      coverage_[static_cast<std::size_t>(number)] = {samples, centres};
      work.columns[static_cast<std::size_t>(stamps.row_of(number))] |= 1U << stamps.column_of(number);
    });
    StampPacket stamp = empty_stamp(tile);
    start_fragment(stamp, context, widths_, fragment_);
    bool is_resident = false;
    const Cycle before = timing_.last_fragment();
    if (options_.sink != nullptr) options_.sink->visit(tile_x, tile_y);
    timing_.visit(work, [&](Cycle offered, int row, int column) {
      if (column < 0) return timing_.pass(offered);
      stamp.stamp = static_cast<std::uint16_t>(stamps.stamp_number(column, row));
      stamp.mask = coverage_[stamp.stamp].samples;
      stamp.centre = coverage_[stamp.stamp].centres;
      enter_stamp(stamp, widths_, fragment_);
      const FragmentPlace place = place_of(fragment_);
      if (!place.mask.any()) return timing_.pass(offered);  // no sample is drawn
      interpolate_depths(stamp, context, widths_.stamps.pixels_of(place.mask), widths_, fragment_);
      const StampFate fate = shade(&stamp, &context, primitive);
      if (blocks_) {
        BlockItem item;
        const TagResult tags = block_access(place, fate, item);
        return timing_.access(offered, tags, item);
      }
      const Cycle moved = timing_.access(offered, place, [&](auto& mover) {
        return is_resident || ((is_resident = true), tiles_->access(tile_x, tile_y, mover, counters_));
      });
      if (fate.passed.any())
        tiles_->wrote(tile_x, tile_y, place.stamp, context.state.depth_write, context.state.color_write);
      return moved;
    });
    if (config_.hiz_bits != 0) hiz_.retire(path_.retire(fragment_));
    if (options_.want_cost) share_cost(tile, work, static_cast<float>(timing_.last_fragment() - before));
  }

  /// Shares the cycles of a visit among its covered pixels, or, if there are none, the pixels of its box. Pixels with
  /// several samples all have equal shares.
  void share_cost(const TilePacket& tile, const TileVisitWork& work, float cycles) {
    const int per_row = widths_.stamps.stamps_per_row, size = config_.stamp_size;
    const auto is_covered = [&](int x, int y) {
      const int column = x / size, row = y / size;
      return (work.columns[static_cast<std::size_t>(row)] >> column & 1) != 0 &&
             coverage_[static_cast<std::size_t>(row * per_row + column)].samples.has(
                 static_cast<std::size_t>(y % size * size + x % size));
    };
    const PixelBounds box = to_bounds(tile.box);
    std::uint64_t covered = 0;
    for (int y = box.top; widths_.has_samples == 0 && y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x) covered += is_covered(x, y) ? 1 : 0;
    const float share = cycles / static_cast<float>(covered == 0 ? box.samples() : covered);
    for (int y = box.top; y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x)
        if (covered == 0 || is_covered(x, y))
          cost_[plain_index((tile.key.tile_x << widths_.tile_shift) + x,
                            (tile.key.tile_y << widths_.tile_shift) + y)] += share;
  }

  /// Applies a token's state, here and in the tags; `texture`: its work in the texture unit.
  void set_state(const TrianglePacket& token, TextureWork& texture) {
    const StateRegister which = state_register(token.state);
    const PerPlane<std::uint32_t>& codes = token.vertex.code[2];  // the place of a state's word
    path_.set(which, codes);
    if (!is_of_texture(which)) return set_tags();
    if (!path_.units()) return;
    const LevelsWord beside = word_beside_texture(which, codes, widths_);
    texture.sets_light = beside == LevelsWord::light;
    texture.sets_border = beside == LevelsWord::border;
    if (beside != LevelsWord::levels) return;
    texture.sets = which;
    texture.invalidates = which == StateRegister::texture && path_.units()->texture.state().invalidates;
  }

  void set(const ColorState& colors, const StencilState& stencil) {
    path_.set(colors, stencil);
    set_tags();
  }
  void set_tags() {
    if (!blocks_) return;
    const ColorState& colors = path_.colors();
    blends_ = colors.ops.blends();
    blocks_->set(colors.ops.reads_stored(), colors.tests_alpha(), path_.stencil().replaces());
  }

  Config config_;
  Widths widths_;
  CycleOptions options_;
  Timing timing_;
  CounterPacket counters_;
  Hiz hiz_;
  std::optional<TileDirectory> tiles_;  ///< one of the two, by cache.kind
  std::optional<CacheTags> blocks_;
  FragmentPath path_;
  bool blends_ = false;  ///< by the current colour operations
  /// Coverage of a stamp of the current tile that is not empty.
  struct Coverage {
    SampleMask samples, centres;
  };
  std::vector<Coverage> coverage_;
  FragmentPacket fragment_;            ///< the current one; holds only codes that have been requested
  std::optional<StampImages> images_;  ///< of the current frame, at the stamp of this fragment
  TextureMemory texels_;
  Rendering rendering_;
  std::vector<float> cost_, misses_;
};

}  // namespace

std::unique_ptr<CycleModel> make_cycle_model(const Config& config, MemoryTiming& memory, const CycleOptions& options) {
  validate(config);
  validate(options.parameters, config);
  if (config.setup_kind == SetupKind::pipelined)
    return std::make_unique<CycleModelOf<PipelinedTiming>>(config, memory, options);
  return std::make_unique<CycleModelOf<SerialTiming>>(config, memory, options);
}

}  // namespace halfplane
