#include "cycle_model.hpp"

#include <algorithm>
#include <bit>
#include <utility>

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
#include "cycle_times.hpp"
#include "stamp_images.hpp"
#include "stamp_lanes.hpp"
#include "step_queue.hpp"

namespace halfplane {
namespace {

/// Whether the area is negative with the vertices as cull_serial sorts them: the sort swaps two and rotates all three.
bool is_negative_when_sorted(const std::array<SnappedVertex, 3>& v, std::int64_t area) {
  const bool swaps_first = canonically_before(v[1], v[0]);
  const bool swaps_again = canonically_before(swaps_first ? v[1] : v[0], v[2]);
  return (area < 0) != (swaps_first != swaps_again);
}

PrimitiveWork work_of(const PrimitivePacket& packet, bool is_dropped, bool is_serial) {
  PrimitiveWork work;
  const PrimitiveKind kind = packet.kind;
  work.is_triangle = kind == PrimitiveKind::triangle;
  work.is_line = kind == PrimitiveKind::line;
  work.is_state = kind == PrimitiveKind::state;
  work.is_counted = is_counted(kind);
  work.is_dropped = is_dropped;
  if (!work.is_triangle || !is_serial) return work;  // the time of a pipelined stage depends on no values
  const auto v = to_snapped(packet.vertex);
  const std::int64_t area = signed_area(v[0], v[1], v[2]);
  const auto size = static_cast<std::uint64_t>(area < 0 ? -area : area);
  work.is_negative = is_negative_when_sorted(v, area);
  work.log2_area = size == 0 ? 0 : static_cast<int>(std::bit_width(size - 1));
  return work;
}

/// Computes the bits of the stages, stamp by stamp, and hands on the steps whose times CycleTimes computes. Packets leave
/// a stage in an order that does not depend on time.
class BitsAndTimes final : public CycleModel {
 public:
  BitsAndTimes(const Config& config, MemoryTiming& memory, const CycleOptions& options)
      : config_(config),
        widths_(derive_widths(config)),
        options_(options),
        times_(make_cycle_times(config, memory, options)),
        queue_(*times_),
        hiz_(config_, widths_, options.parameters.untested_tiles),
        path_(config_, widths_),
        lanes_(config_, widths_),
        is_watched_(options.sink != nullptr) {}

  void hold_textures(const Scene& scene) override { texels_ = TextureMemory(scene, config_); }

  void begin(int width, int height, Cycle cycle, int threads) override {
    Framebuffer held = std::move(rendering_.frame);
    rendering_ = {};
    if (held.width == width && held.height == height) {
      rendering_.frame = std::move(held);
    } else {
      rendering_.frame = Framebuffer(width, height, config_.tile_size, FrameContent::undefined);
      fill_padding(rendering_.frame.depth, snap_depth(1.0, config_.depth_bits));  // as in an empty target
      fill_padding(rendering_.frame.color, pack_color(config_.color_format, {0, 0, 0, 255}));
      if (widths_.has_samples != 0)
        rendering_.frame.samples.assign(static_cast<std::size_t>(config_.msaa_samples), Framebuffer(rendering_.frame));
    }
    images_.emplace(frames(), widths_);
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (options_.want_count) rendering_.count.resize(pixels);
    if (options_.want_ids) rendering_.ids.assign(pixels, -1);
    if (options_.want_misses) misses_.assign(pixels, 0);
    times_->begin(width, height, cycle);
    queue_.begin(is_watched_ ? 1 : threads);
  }

  bool run(const HostPrimitive& host) override {
    if (is_watched_) options_.sink->primitive(host);
    const std::uint64_t dropped = DrawnCount::dropped(counters_);
    draw(host);
    if (is_watched_) queue_.hand_over();
    return DrawnCount::dropped(counters_) == dropped;
  }

  void end() override { queue_.hand_over(); }

  void complete() override {
    queue_.complete();
    const CounterPacket& moves = times_->counters();
    all_counters_ = counters_;
    all_counters_.tile_fills += moves.tile_fills;
    all_counters_.tile_evictions += moves.tile_evictions;
    all_counters_.tile_clears += moves.tile_clears;
  }

  [[nodiscard]] const CounterPacket& counters() const override { return all_counters_; }
  [[nodiscard]] TimingTotals totals() const override { return times_->totals(); }
  [[nodiscard]] const Stream& stream(Arrow boundary) const override { return times_->stream(boundary); }
  [[nodiscard]] Rendering& rendering() override { return rendering_; }
  [[nodiscard]] std::vector<float>& cost() override { return times_->cost(); }
  [[nodiscard]] std::vector<float>& misses() override { return misses_; }

 private:
  [[nodiscard]] Steps& steps() { return queue_.filling(); }
  /// A whole step has been added.
  void added() {
    if (queue_.filling().is_full()) queue_.hand_over();
  }

  void draw(const HostPrimitive& host) {
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

  /// Sends a primitive of the host down the pipeline as `primitive`.
  void send(const HostPrimitive& host, const PrimitivePacket& primitive) {
    TrianglePacket& triangle = triangle_;
    const bool is_kept = cull(primitive, widths_, counters_, config_.setup_kind == SetupKind::pipelined, triangle);
    steps().add(StepKind::take);
    steps().primitives.add_item({work_of(primitive, !is_kept, config_.setup_kind == SetupKind::serial),
                                 is_kept ? triangle.state : PrimitiveState{}});
    if (!is_kept) return added();
    switch (triangle.kind) {
      case PrimitiveKind::fast_clear: fast_clear(triangle); return;
      case PrimitiveKind::flush:
        steps().add(StepKind::flush);
        steps().areas.push_back(area_of(triangle));
        added();
        return;
      case PrimitiveKind::state:
        set_state(triangle);
        added();
        return;
      case PrimitiveKind::line: draw_line(triangle, *host.line, host.primitive); return;
      case PrimitiveKind::triangle:
      case PrimitiveKind::rectangle:
      case PrimitiveKind::point:
        setup_packet(triangle, config_, widths_, setup_);
        draw(setup_, host.primitive);
        return;
    }
  }

  [[nodiscard]] AreaStep area_of(const TrianglePacket& token) const {
    const PixelBounds box = to_bounds(token.box);
    return {box.right >> widths_.tile_shift, box.bottom >> widths_.tile_shift, 0, box};
  }

  void fast_clear(const TrianglePacket& clear) {
    AreaStep area = area_of(clear);
    const PerPlane<std::uint32_t>& code = clear.vertex.code[0];
    if (clear.state.depth_write) {
      hiz_.clear(area.last_x, area.last_y, code[kDepthPlane]);
      if (config_.hiz_bits != 0)
        area.bounds = static_cast<std::uint64_t>((area.last_x >> widths_.hiz_group_bits) + 1) *
                      static_cast<std::uint64_t>(area.last_y + 1);
      for (Framebuffer& frame : frames()) {
        fill(frame.depth, area.box, code[kDepthPlane]);
        if (has_stencil(config_)) fill(frame.stencil, area.box, path_.stencil().clear_value());
      }
    }
    steps().add(StepKind::clear);
    steps().areas.push_back(area);
    added();
    if (clear.state.color_write)
      for (Framebuffer& frame : frames())
        fill(frame.color, area.box, pack_color(config_.color_format, color_channels(code)));
    if (clear.state.writes()) std::ranges::fill(rendering_.ids, -1);
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

  void draw_line(const TrianglePacket& token, const LineSetup& line, std::uint32_t primitive) {
    const PrimitiveState& state = token.state;
    SetupPacket setup;  // input of HiZ
    setup.state = state;
    hiz_.pass_line(setup);
    fragment_.kind = token.kind;
    fragment_.state = state;
    fragment_.coordinates = token.coordinates;
    LineState next = first_state(line);
    const auto pixels = static_cast<std::size_t>(line.remaining) + 1;
    steps().add(StepKind::line_pixels, pixels);
    for (std::size_t n = 0; n < pixels; ++n) {
      const LinePixel pixel = pixel_of(next, line, widths_);
      set_line_pixel(pixel, widths_, fragment_);
      StampStep& step = add_stamp();
      step.pixel = static_cast<std::uint8_t>(widths_.stamps.pixel_number(
          widths_.stamps.sample_at(pixel.x & (widths_.stamps.size - 1), pixel.y & (widths_.stamps.size - 1))));
      if (fragment_.mask.any()) {
        const StampFate fate = shade(nullptr, nullptr, primitive);
        note_fate(fate, fate.kept.any(), step);
      }
      if (!pixel.is_last) advance(next, line, widths_);
    }
    added();
  }

  /// A step for the current fragment, which passes.
  [[nodiscard]] StampStep& add_stamp() {
    StampStep step;
    step.at = {fragment_.key.tile_x, fragment_.key.tile_y, fragment_.stamp};
    steps().stamps.add_item(step);
    return steps().stamps.last();
  }

  /// The current fragment's fate, for its times.
  void note_fate(const StampFate& fate, bool is_dirty, StampStep& step) {
    const PrimitiveState& state = fragment_.state;
    const ColorState& colors = path_.colors();
    BlockItem& item = step.item;
    item.mask = fragment_.mask;
    item.depth_write = state.writes_word();
    item.color_write = state.color_write;
    item.blends = blends_;
    item.is_late = is_late(state, colors.tests_alpha(), config_);
    item.wrote_depth = fate.written.any();
    if (state.color_write) item.colors = fate.kept;
    item.is_shaded = (colors.tests_alpha() ? fate.passed | fate.changed : item.colors).any();
    step.is_dirty = is_dirty;
    if (config_.compress_units != 0) step.even = images_->even_pixels();
    if (!path_.units()) return;
    TextureStep& texture = steps().textures.emplace_back();
    texture.lookups = static_cast<std::uint32_t>(fate.lookups.size());
    steps().lookups.insert(steps().lookups.end(), fate.lookups.begin(), fate.lookups.end());
    if (!fate.shaded.any()) return;
    if (fragment_.coordinates.divides_colors) texture.work.divided = path_.units()->texture.groups(fate.shaded);
    if (path_.units()->light.is_lit(fragment_.kind == PrimitiveKind::triangle)) texture.work.lit = fate.shaded.count();
  }

  /// The images and the texture memory, as the fragment path sees them.
  struct StampPort {
    static constexpr bool kSendsPackets = false;
    BitsAndTimes& model;
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

  /// The steps of coarse_raster's walk.
  struct WalkWatch {
    BitsAndTimes& model;
    bool rejects;
    void skip_outside() const { model.steps().add_outside(); }
    void read_bound() const { model.reads_bound_ = true; }
    void skip_behind() const {
      model.steps().add(StepKind::behind);
      model.reads_bound_ = false;
    }
  };

  /// Runs coarse_raster, and for each visit the rest of the pipeline.
  void draw(const SetupPacket& setup, std::uint32_t primitive) {
    const WalkWatch watch{*this, options_.parameters.rejects != 0};
    const auto end_walk = [this] {
      steps().add(StepKind::end_walk);
      added();
    };
    if (!options_.want_count && !options_.want_ids && lanes_.draws(setup.state, path_.colors().tests_alpha())) {
      lanes_.begin(setup);
      walk_tiles(
          setup, hiz_, widths_, counters_, [&](const VisitedTile& tile) { visit_in_lanes(setup, tile); },
          [&](int, int) { end_walk(); }, watch);
      return;
    }
    make_context(setup, widths_, context_);
    const EdgeContext edges = make_edge_context(setup);
    places_.emplace(edges, widths_);
    coarse_raster(
        setup, 0, hiz_, widths_, counters_,
        [&](const TilePacket& tile) { tile.is_visit ? visit(tile, edges, *places_, context_, primitive) : end_walk(); },
        watch);
  }

  /// The step of a visit, without its stamps.
  void add_visit(StepKind kind, const VisitStep& visit, std::size_t stamps) {
    steps().add(kind, stamps, std::exchange(reads_bound_, false));
    steps().visits.add_item(visit);
  }

  void visit_in_lanes(const SetupPacket& setup, const VisitedTile& tile) {
    LaneStamp* const first = steps().lane_stamps.room(static_cast<std::size_t>(widths_.stamps.stamps()));
    std::uint8_t* const first_row = steps().lane_rows.room(static_cast<std::size_t>(widths_.stamps.stamps_per_row));
    LaneStamp* next = first;
    std::uint8_t* row = first_row;
    const RetirePacket retired = lanes_.draw(setup, tile, rendering_.frame, counters_, next, row);
    const auto stamps = static_cast<std::size_t>(next - first);
    steps().lane_stamps.add(stamps);
    steps().lane_rows.add(static_cast<std::size_t>(row - first_row));
    add_visit(StepKind::lane_visit, {retired.key.tile_x, retired.key.tile_y, tile.box, tile.ends_primitive}, stamps);
    if (config_.hiz_bits != 0) hiz_.retire(retired);
    added();
  }

  void visit(const TilePacket& tile, const EdgeContext& edges, const StampEdges& places, const ContextPacket& context,
             std::uint32_t primitive) {
    StampPacket stamp = empty_stamp(tile);
    start_fragment(stamp, context, widths_, fragment_);
    const std::size_t stamps_before = steps().stamps.size();
    cover_tile(tile, edges, places, widths_, [&](int number, SampleMask samples, SampleMask centres) {
      stamp.stamp = static_cast<std::uint16_t>(number);
      stamp.mask = samples;
      stamp.centre = centres;
      enter_stamp(stamp, widths_, fragment_);
      StampStep& sent = add_stamp();
      if (!fragment_.mask.any()) return;  // no sample is drawn
      interpolate_depths(stamp, context, widths_.stamps.pixels_of(fragment_.mask), widths_, fragment_);
      const StampFate fate = shade(&stamp, &context, primitive);
      note_fate(fate, fate.passed.any(), sent);
    });
    add_visit(StepKind::visit, {tile.key.tile_x, tile.key.tile_y, tile.box, tile.ends_primitive},
              steps().stamps.size() - stamps_before);
    if (config_.hiz_bits != 0) hiz_.retire(path_.retire(fragment_));
    added();
  }

  /// Applies a token's state, here and in the tags, and notes its work in the texture unit.
  void set_state(const TrianglePacket& token) {
    const StateRegister which = state_register(token.state);
    const PerPlane<std::uint32_t>& codes = token.vertex.code[2];  // the place of a state's word
    path_.set(which, codes);
    if (!is_of_texture(which)) set_tags();
    steps().add(StepKind::set_state);
    if (!path_.units()) return;
    TextureWork& work = steps().textures.emplace_back().work;
    if (!is_of_texture(which)) return;
    const LevelsWord beside = word_beside_texture(which, codes, widths_);
    work.sets_light = beside == LevelsWord::light;
    work.sets_border = beside == LevelsWord::border;
    if (beside != LevelsWord::levels) return;
    work.sets = which;
    work.invalidates = which == StateRegister::texture && path_.units()->texture.state().invalidates;
  }

  void set(const ColorState& colors, const StencilState& stencil) {
    path_.set(colors, stencil);
    set_tags();
  }
  void set_tags() {
    const ColorState& colors = path_.colors();
    blends_ = colors.ops.blends();
    steps().add(StepKind::set_tags);
    steps().tags.push_back({colors.ops.reads_stored(), colors.tests_alpha(), path_.stencil().replaces()});
  }

  Config config_;
  Widths widths_;
  CycleOptions options_;
  std::unique_ptr<CycleTimes> times_;
  StepQueue queue_;
  CounterPacket counters_;      ///< without the caches'
  CounterPacket all_counters_;  ///< up to the last complete()
  Hiz hiz_;
  FragmentPath path_;
  StampLanes lanes_;
  bool blends_ = false;  ///< by the current colour operations
  // Of the current primitive.
  TrianglePacket triangle_;
  SetupPacket setup_;
  ContextPacket context_;
  std::optional<StampEdges> places_;   ///< where it is not drawn in lanes
  bool reads_bound_ = false;           ///< of the next tile
  FragmentPacket fragment_;            ///< the current one; holds only codes that have been requested
  std::optional<StampImages> images_;  ///< of the current frame, at the stamp of this fragment
  TextureMemory texels_;
  Rendering rendering_;
  std::vector<float> misses_;
  bool is_watched_;  ///< by a sink: each primitive's times come with its bits
};

}  // namespace

std::unique_ptr<CycleModel> make_cycle_model(const Config& config, MemoryTiming& memory, const CycleOptions& options) {
  validate(config);
  validate(options.parameters, config);
  return std::make_unique<BitsAndTimes>(config, memory, options);
}

}  // namespace halfplane
