#include "cycle_times.hpp"

#include <algorithm>
#include <optional>

#include "../../stages/pixel_colors.hpp"
#include "pipelined_timing.hpp"
#include "serial_timing.hpp"

namespace halfplane {
namespace {

template <class Timing>
class TimesOf final : public CycleTimes {
 public:
  TimesOf(const Config& config, MemoryTiming& memory, const CycleOptions& options)
      : widths_(derive_widths(config)),
        timing_(config, widths_, options.stalls, memory, options.parameters, options.sink, options.textures),
        all_samples_(SampleMask::all(widths_.samples)),
        sink_(options.sink),
        want_cost_(options.want_cost),
        has_texture_(has_texture_planes(config)) {
    if (config.cache_kind == CacheKind::blocks)
      blocks_.emplace(config, widths_);
    else
      tiles_.emplace(config, widths_);
    if (options.layout) timing_.set_layout(*options.layout);
    if (config.compress_units == 0) return;
    even_.resize(
        place_of({static_cast<std::uint16_t>(widths_.tiles_x - 1), static_cast<std::uint16_t>(widths_.tiles_y - 1),
                  static_cast<std::uint16_t>(widths_.stamps.stamps() - 1)}) +
        1);
    timing_.look_at_colors([this](const StampAddress& at, SampleMask mask) {
      const SampleMask even = widths_.stamps.samples_of(even_[place_of(at)]);
      return widths_.stamps.samples_of(widths_.stamps.pixels_of(mask)) == mask && (mask & even) == mask;
    });
  }

  void begin(int width, int height, Cycle cycle) override {
    if (width != width_ || height != height_)
      std::ranges::fill(even_, SampleMask::all(widths_.pixels));  // as in an empty target
    width_ = width;
    height_ = height;
    if (want_cost_) cost_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    timing_.begin(cycle);
  }

  void run(const Steps& steps) override {
    primitive_ = steps.primitives.data();
    visit_ = steps.visits.data();
    stamp_ = steps.stamps.data();
    tags_ = steps.tags.data();
    area_ = steps.areas.data();
    texture_ = steps.textures.data();
    lookup_ = steps.lookups.data();
    for (const Steps::Step& step : steps.order) run(step);
  }

  [[nodiscard]] const CounterPacket& counters() const override { return counters_; }
  [[nodiscard]] const TimingTotals& totals() const override { return timing_.totals(); }
  [[nodiscard]] const Stream& stream(Arrow boundary) const override { return timing_.stream(boundary); }
  [[nodiscard]] std::vector<float>& cost() override { return cost_; }

 private:
  void run(const Steps::Step& step) {
    switch (step.kind) {
      case StepKind::take:
        state_ = primitive_->state;
        timing_.take(primitive_++->work);
        return;
      case StepKind::outside:
        for (std::uint32_t n = 0; n < step.count; ++n) timing_.skip_outside();
        return;
      case StepKind::read_ahead: timing_.read_ahead(); return;
      case StepKind::read_bound: timing_.read_bound(); return;
      case StepKind::behind: timing_.skip_behind(); return;
      case StepKind::end_walk: timing_.end_walk([&](Cycle offered) { return timing_.pass(offered); }); return;
      case StepKind::visit: visit(*visit_++, step.count); return;
      case StepKind::line_pixels: pass_line(step.count); return;
      case StepKind::set_tags:
        if (blocks_) blocks_->set(tags_->reads_color, tags_->tests_alpha, tags_->replaces_stencil);
        ++tags_;
        return;
      case StepKind::set_state:
        timing_.end_token([&](Cycle offered) { return timing_.access(offered, TagResult{}, BlockItem{}, texture()); });
        return;
      case StepKind::clear: clear(*area_++); return;
      case StepKind::flush: flush(*area_++); return;
    }
  }

  void visit(const VisitStep& step, std::uint32_t stamps) {
    const StampStep* const first = stamp_;
    const Cycle before = timing_.last_fragment();
    if (sink_ != nullptr) sink_->visit(step.tile_x, step.tile_y);
    is_resident_ = false;
    timing_.visit(step.work, [&](Cycle offered, int /*row*/, int column) {
      return column < 0 ? timing_.pass(offered) : next_stamp(offered, 0);
    });
    if (want_cost_) share_cost(step, {first, stamps}, static_cast<float>(timing_.last_fragment() - before));
  }

  /// The next stamp in depth_test, on offer from `offered` on. Returns when it moves. Half of the model's time is here, a
  /// twelfth of it in calls unless they are inlined.
  [[gnu::flatten]] Cycle next_stamp(Cycle offered, unsigned others) {
    const StampStep& stamp = *stamp_++;
    if (!stamp.item.mask.any()) return timing_.pass(offered, others);  // no sample is drawn
    if (blocks_) {
      if (!even_.empty()) even_[place_of(stamp.at)] = stamp.even;
      const TagResult tags = blocks_->access(stamp.at, state_, stamp.item.mask == all_samples_);
      return timing_.access(offered, tags, stamp.item, texture(), others);
    }
    const FragmentPlace place{stamp.at.tile_x, stamp.at.tile_y, stamp.at.stamp, stamp.item.mask, state_.depth_write};
    const auto look_up = [&](auto& mover) {
      return is_resident_ || ((is_resident_ = true), tiles_->access(place.tile_x, place.tile_y, mover, counters_));
    };
    const Cycle moved = timing_.access(offered, place, look_up, others);
    if (stamp.is_dirty) tiles_->wrote(place.tile_x, place.tile_y, place.stamp, state_.depth_write, state_.color_write);
    return moved;
  }

  /// The work of the next stamp or token in the shading units.
  [[nodiscard]] const TextureWork& texture() {
    if (!has_texture_) return work_;
    work_ = texture_->work;
    work_.lookups = {lookup_, texture_->lookups};
    lookup_ += texture_->lookups;
    ++texture_;
    return work_;
  }

  void pass_line(std::uint32_t pixels) {
    const StampStep* const first = stamp_;
    const Cycle before = timing_.last_fragment();
    timing_.end_token([&](Cycle offered) {
      return timing_.take_pixels(offered, pixels, [&](Cycle at, unsigned others) {
        is_resident_ = false;  // each pixel looks its tile up
        return next_stamp(at, others);
      });
    });
    if (!want_cost_) return;
    const float cycles = static_cast<float>(timing_.last_fragment() - before) / static_cast<float>(pixels);
    for (const StampStep* stamp = first; stamp != stamp_; ++stamp)
      cost_[plain_index(stamp->at, widths_.stamps.place_of(stamp->pixel))] += cycles;
  }

  void clear(const AreaStep& area) {
    if (area.bounds != 0) timing_.clear_bounds(area.bounds);
    timing_.end_token([&](Cycle offered) {
      if (blocks_) return timing_.pass_token(offered, *blocks_, true, state_, area.last_x, area.last_y);
      return timing_.pass_token(offered, [&](auto& mover) {
        tiles_->fast_clear(area.last_x, area.last_y, {state_.depth_write, state_.color_write}, mover, counters_);
      });
    });
    if (even_.empty() || !state_.color_write) return;
    // Beyond the box, at the right and the lower end of the target, nothing is drawn.
    const int size = 1 << widths_.tile_shift;
    for (int y = area.box.top; y <= area.box.bottom; y += size)
      for (int x = area.box.left; x <= area.box.right; x += size)
        std::fill_n(even_.begin() +
                        static_cast<std::ptrdiff_t>(place_of({static_cast<std::uint16_t>(x >> widths_.tile_shift),
                                                              static_cast<std::uint16_t>(y >> widths_.tile_shift), 0})),
                    widths_.stamps.stamps(), SampleMask::all(widths_.pixels));
  }

  void flush(const AreaStep& area) {
    timing_.end_token([&](Cycle offered) {
      if (blocks_) return timing_.pass_token(offered, *blocks_, false, state_, area.last_x, area.last_y);
      return timing_.pass_token(offered,
                                [&](auto& mover) { tiles_->flush(area.last_x, area.last_y, mover, counters_); });
    });
  }

  /// Shares the cycles of a visit among its covered pixels, or, if there are none, the pixels of its box. Pixels with
  /// several samples all have equal shares.
  void share_cost(const VisitStep& visit, std::span<const StampStep> stamps, float cycles) {
    std::uint64_t covered = 0;
    if (widths_.has_samples == 0)
      for (const StampStep& stamp : stamps) covered += static_cast<std::uint64_t>(stamp.item.mask.count());
    const float share = cycles / static_cast<float>(covered == 0 ? visit.box.samples() : covered);
    if (covered == 0) {
      const int left = visit.tile_x << widths_.tile_shift, top = visit.tile_y << widths_.tile_shift;
      for (int y = visit.box.top; y <= visit.box.bottom; ++y)
        for (int x = visit.box.left; x <= visit.box.right; ++x) cost_[plain_index(left + x, top + y)] += share;
      return;
    }
    for (const StampStep& stamp : stamps)
      stamp.item.mask.for_each(
          [&](std::size_t s) { cost_[plain_index(stamp.at, widths_.stamps.place_of(static_cast<int>(s)))] += share; });
  }

  [[nodiscard]] std::size_t plain_index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  /// Of a place in a stamp.
  [[nodiscard]] std::size_t plain_index(const StampAddress& at, const PixelOffset& place) const {
    const PixelOffset origin = widths_.stamps.origin_of(at.stamp);
    return plain_index((at.tile_x << widths_.tile_shift) + origin.x + place.x,
                       (at.tile_y << widths_.tile_shift) + origin.y + place.y);
  }
  /// Index in even_.
  [[nodiscard]] std::size_t place_of(const StampAddress& at) const {
    const auto tile = static_cast<std::size_t>(at.tile_y) * static_cast<std::size_t>(widths_.tiles_x) + at.tile_x;
    return tile * static_cast<std::size_t>(widths_.stamps.stamps()) + at.stamp;
  }

  Widths widths_;
  Timing timing_;
  std::optional<TileDirectory> tiles_;  ///< one of the two, by cache.kind
  std::optional<CacheTags> blocks_;
  CounterPacket counters_;
  SampleMask all_samples_;
  TransferSink* sink_;
  bool want_cost_, has_texture_;
  int width_ = 0, height_ = 0;
  PrimitiveState state_;          ///< of the current primitive
  TextureWork work_;              ///< of the current stamp or token
  bool is_resident_ = false;      ///< the tile of the current visit, in a cache of tiles
  std::vector<SampleMask> even_;  ///< StampStep::even of the last write, by place
  std::vector<float> cost_;
  // The next of the current batch.
  const PrimitiveStep* primitive_ = nullptr;
  const VisitStep* visit_ = nullptr;
  const StampStep* stamp_ = nullptr;
  const TagsStep* tags_ = nullptr;
  const AreaStep* area_ = nullptr;
  const TextureStep* texture_ = nullptr;
  const TextureLookup* lookup_ = nullptr;
};

}  // namespace

std::unique_ptr<CycleTimes> make_cycle_times(const Config& config, MemoryTiming& memory, const CycleOptions& options) {
  if (config.setup_kind == SetupKind::pipelined)
    return std::make_unique<TimesOf<PipelinedTiming>>(config, memory, options);
  return std::make_unique<TimesOf<SerialTiming>>(config, memory, options);
}

}  // namespace halfplane
