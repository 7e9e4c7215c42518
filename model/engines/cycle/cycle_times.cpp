#include "cycle_times.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "../../stages/pixel_colors.hpp"
#include "pipelined_timing.hpp"
#include "serial_timing.hpp"

namespace halfplane {
namespace {

template <class Timing>
class alignas(kOwnLineBytes) TimesOf final : public CycleTimes {
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
    for (int stamp = 0; stamp < widths_.stamps.stamps(); ++stamp)
      places_.push_back(block_stamp({0, 0, static_cast<std::uint16_t>(stamp)}, widths_));
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
    lane_stamp_ = steps.lane_stamps.data();
    lane_row_ = steps.lane_rows.data();
    tags_ = steps.tags.data();
    area_ = steps.areas.data();
    texture_ = steps.textures.data();
    lookup_ = steps.lookups.data();
    for (const Steps::Step& step : steps.order.items()) run(step);
  }

  [[nodiscard]] const CounterPacket& counters() const override { return counters_; }
  [[nodiscard]] TimingTotals totals() const override { return timing_.totals(); }
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
      case StepKind::behind:
        timing_.read_bound();
        timing_.skip_behind();
        return;
      case StepKind::end_walk: timing_.end_walk([&](Cycle offered) { return timing_.pass(offered); }); return;
      case StepKind::visit:
        if (step.reads_bound) timing_.read_bound();
        visit(*visit_++, {stamp_, step.count});
        stamp_ += step.count;
        return;
      case StepKind::lane_visit:
        if (step.reads_bound) timing_.read_bound();
        lane_visit(*visit_++, {lane_stamp_, step.count});
        lane_stamp_ += step.count;
        return;
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

  /// The work of a visit in fine_raster.
  [[nodiscard]] TileVisitWork work_of(const VisitStep& step) const {
    const StampGrid& grid = widths_.stamps;
    const int first = grid.stamp_at(step.box.left, step.box.top), last = grid.stamp_at(step.box.right, step.box.bottom);
    return {step.ends_primitive, grid.row_of(first), grid.row_of(last), grid.column_of(first), grid.column_of(last)};
  }
  /// A visit's stamps, row by row.
  struct StampRows {
    const StampGrid& grid;
    const StampStep *next, *end;
    /// The number of stamps in the next row; a bit for each of them.
    [[nodiscard]] int count(int row) {
      const StampStep* const first = next;
      for (const int below = grid.stamp_number(0, row + 1); next != end && next->at.stamp < below;) ++next;
      return static_cast<int>(next - first);
    }
    [[nodiscard]] std::uint32_t columns(int row) {
      std::uint32_t columns = 0;
      for (int left = count(row); left > 0; --left) columns |= 1U << grid.column_of(next[-left].at.stamp);
      return columns;
    }
  };
  /// The same of a visit in lanes, whose rows are counted.
  struct LaneRows {
    const std::uint8_t*& next;
    [[nodiscard]] int count(int /*row*/) { return *next++; }
  };
  void visit(const VisitStep& step, std::span<const StampStep> stamps) {
    const StampStep* stamp = stamps.data();
    const Cycle before = timing_.last_fragment();
    if (sink_ != nullptr) sink_->visit(step.tile_x, step.tile_y);
    is_resident_ = false;
    StampRows rows{widths_.stamps, stamps.data(), stamps.data() + stamps.size()};
    timing_.visit(work_of(step), rows, [&](Cycle offered, bool is_covered) {
      return is_covered ? enter(*stamp++, offered, 0) : timing_.pass(offered);
    });
    if (want_cost_) share_cost(step, stamps, static_cast<float>(timing_.last_fragment() - before));
  }

  /// A visit of stamps that were drawn in lanes. Half of the model's time is here, a part of it in calls unless they are
  /// inlined.
  [[gnu::flatten]] void lane_visit(const VisitStep& step, std::span<const LaneStamp> stamps) {
    if constexpr (Timing::is_plain) {
      BlockItem item;
      item.depth_write = state_.writes_word();
      item.color_write = state_.color_write;
      const int per_tile = widths_.blocks.per_tile_log2, first_x = step.tile_x << per_tile,
                first_y = step.tile_y << per_tile;
      const bool writes_depth = state_.depth_write;
      const std::uint8_t writes_color = state_.color_write ? 0xff : 0;
      const LaneStamp* stamp = stamps.data();
      bool is_noted = stamps.empty();
      timing_.visit(work_of(step), LaneRows{lane_row_}, [&](Cycle offered, bool is_covered) {
        if (!is_covered) {  // it ends the visit
          if (!std::exchange(is_noted, true)) timing_.note_write();
          return timing_.pass(offered);
        }
        const auto& [number, covered, passed] = *stamp++;
        if (covered == 0) __builtin_unreachable();  // a stamp from the lanes has covered samples: no test of item.mask
        BlockStamp place = places_[number];
        place.block.x = static_cast<std::uint16_t>(place.block.x + first_x);
        place.block.y = static_cast<std::uint16_t>(place.block.y + first_y);
        item.mask = SampleMask(covered);
        item.wrote_depth = writes_depth && passed != 0;
        item.colors = SampleMask(passed & writes_color);
        return timing_.access(offered, blocks_->access(place, state_, item.mask == all_samples_), item, shading_);
      });
      if (!is_noted) timing_.note_write();
    } else {
      const TileVisitWork work = work_of(step);
      lane_row_ += work.last_row - work.first_row + 1;
      expanded_visit(step, stamps);
    }
  }

  /// Not inlined, for visit() would be compiled twice.
  [[gnu::noinline]] void expanded_visit(const VisitStep& step, std::span<const LaneStamp> stamps) {
    expanded_.clear();
    for (const LaneStamp& stamp : stamps) expanded_.push_back(expanded(step, stamp));
    visit(step, std::span<const StampStep>(expanded_));
  }

  [[nodiscard]] StampStep expanded(const VisitStep& visit, const LaneStamp& stamp) const {
    StampStep step;
    step.at = {visit.tile_x, visit.tile_y, stamp.stamp};
    step.is_dirty = stamp.passed != 0;
    step.item.mask = SampleMask(stamp.covered);
    step.item.depth_write = state_.writes_word();
    step.item.color_write = state_.color_write;
    step.item.wrote_depth = state_.depth_write && stamp.passed != 0;
    if (state_.color_write) step.item.colors = SampleMask(stamp.passed);
    return step;
  }

  /// A stamp in depth_test, on offer from `offered` on. Returns when it moves.
  [[gnu::flatten]] Cycle enter(const StampStep& stamp, Cycle offered, unsigned others) {
    if (!stamp.item.mask.any()) return timing_.pass(offered, others);  // no sample is drawn
    if (blocks_) {
      if (!even_.empty()) even_[place_of(stamp.at)] = stamp.even;
      const TagResult tags = blocks_->access(stamp.at, state_, stamp.item.mask == all_samples_);
      const Cycle moved = timing_.access(offered, tags, stamp.item, texture(), others);
      timing_.note_write();
      return moved;
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
    if (!has_texture_) return shading_;
    shading_ = texture_->work;
    shading_.lookups = {lookup_, texture_->lookups};
    lookup_ += texture_->lookups;
    ++texture_;
    return shading_;
  }

  void pass_line(std::uint32_t pixels) {
    const StampStep* const first = stamp_;
    const Cycle before = timing_.last_fragment();
    timing_.end_token([&](Cycle offered) {
      return timing_.take_pixels(offered, pixels, [&](Cycle at, unsigned others) {
        is_resident_ = false;  // each pixel looks its tile up
        return enter(*stamp_++, at, others);
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
    const PixelBounds box = to_bounds(visit.box);
    const float share = cycles / static_cast<float>(covered == 0 ? box.samples() : covered);
    if (covered == 0) {
      const int left = visit.tile_x << widths_.tile_shift, top = visit.tile_y << widths_.tile_shift;
      for (int y = box.top; y <= box.bottom; ++y)
        for (int x = box.left; x <= box.right; ++x) cost_[plain_index(left + x, top + y)] += share;
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
  PrimitiveState state_;               ///< of the current primitive
  TextureWork shading_;                ///< of the current stamp or token
  std::vector<StampStep> expanded_;    ///< of the current visit, if it was drawn in lanes
  OwnLinesVector<BlockStamp> places_;  ///< of the stamps of tile (0, 0)
  bool is_resident_ = false;           ///< the tile of the current visit, in a cache of tiles
  std::vector<SampleMask> even_;       ///< StampStep::even of the last write, by place
  std::vector<float> cost_;
  // The next of the current batch.
  const PrimitiveStep* primitive_ = nullptr;
  const VisitStep* visit_ = nullptr;
  const StampStep* stamp_ = nullptr;
  const LaneStamp* lane_stamp_ = nullptr;
  const std::uint8_t* lane_row_ = nullptr;
  const TagsStep* tags_ = nullptr;
  const AreaStep* area_ = nullptr;
  const TextureStep* texture_ = nullptr;
  const TextureLookup* lookup_ = nullptr;
};

}  // namespace

std::unique_ptr<CycleTimes> make_cycle_times(const Config& config, MemoryTiming& memory, const CycleOptions& options) {
  const bool is_plain = config.cache_kind == CacheKind::blocks && !has_texture_planes(config) &&
                        config.blend_lanes == 0 && config.compress_units == 0 && options.stalls.threshold == 0 &&
                        options.sink == nullptr && !options.want_cost;
  if (config.setup_kind == SetupKind::pipelined && is_plain)
    return std::make_unique<TimesOf<PipelinedTiming<PlainRun>>>(config, memory, options);
  if (config.setup_kind == SetupKind::pipelined)
    return std::make_unique<TimesOf<PipelinedTiming<AnyRun>>>(config, memory, options);
  return std::make_unique<TimesOf<SerialTiming>>(config, memory, options);
}

}  // namespace halfplane
