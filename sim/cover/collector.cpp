#include "sim/cover/collector.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <utility>

#include "model/engines/hardware.hpp"
#include "model/engines/hardware_watch.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/coarse_raster.hpp"
#include "model/stages/depth_test.hpp"
#include "model/stages/fine_raster.hpp"
#include "model/stages/hiz.hpp"
#include "model/stages/line_raster.hpp"
#include "sim/cover/bins.hpp"

namespace halfplane::cover {
namespace {

Config without_lag(Config config) {
  config.hiz_lag = 1;
  return config;
}

/// The walk of a primitive over its tiles, as coarse_raster walks them.
bool walks_left(const SetupPacket& setup, const Widths& widths) {
  TileWalk walk(setup.box.left >> widths.tile_shift, setup.box.top >> widths.tile_shift,
                setup.box.right >> widths.tile_shift, setup.box.bottom >> widths.tile_shift, setup.dy);
  for (int x = walk.x(), y = walk.y();; x = walk.x(), y = walk.y()) {
    const EdgeValues edges = moved_by_samples(edges_at_tile(setup, x, y, widths), setup.dx, setup.dy, true, widths);
    if (!walk.next(outside_edges(setup.dx, setup.dy, edges, 1 << widths.tile_shift))) return false;
    if (walk.y() == y && walk.x() < x) return true;
  }
}

}  // namespace

/// Sees packets, in the order of a pipeline.
class PacketCoverage : public PacketSink, public HardwareWatch {
 public:
  explicit PacketCoverage(const Config& config);
  PacketCoverage(const PacketCoverage&) = delete;
  PacketCoverage& operator=(const PacketCoverage&) = delete;

  void take(On<Arrow::primitive>, const PrimitivePacket& packet) override;
  void take(On<Arrow::line>, const LineSetup& packet) override;
  void take(On<Arrow::triangle>, const TrianglePacket& packet) override;
  void take(On<Arrow::setup>, const SetupPacket& packet) override;
  void take(On<Arrow::tile>, const TilePacket& packet) override;
  void take(On<Arrow::edges>, const EdgeContext& packet) override;
  void take(On<Arrow::stamp>, const StampPacket& packet) override;
  void take(On<Arrow::retire>, const RetirePacket& packet) override;
  void take(On<Arrow::request>, const MemoryRequest& packet) override;
  void take(On<Arrow::texture>, const TextureRequest& packet) override;
  using PacketSink::take;

  void looked_up(const FragmentPacket& fragment, const TagResult& tags) override;
  void meets(const FragmentPacket& fragment, std::span<const std::uint32_t> stored, const StencilState& state) override;
  void shaded(const FragmentPacket& fragment, const StampFate& fate, const ColorState& colors) override;

 protected:
  void see(Event event);

  Config config_;
  Widths widths_;
  Hits hits_;
  Seen seen_;

 private:
  struct Rule {
    std::uint64_t (*hits)(const Seen&);
    std::size_t first;  ///< bin of member 0
  };

  std::array<std::vector<Rule>, kEvents> rules_;
  PrimitivePacket primitive_;
  TrianglePacket triangle_;
  SetupPacket setup_;
  TilePacket tile_;
  std::array<bool, 3> may_tie_{}, is_top_left_{};  ///< by edge of the triangle: a pixel centre may lie on it
  bool has_triangle_ = false, has_setup_ = false;  ///< of the same primitive as the tiles
  Hiz hiz_, newest_;  ///< with the configured lag, and without one; the second does not know of lines
  int since_raise_;   ///< visits since one that may raise a depth
  FragmentPacket last_;
  bool has_last_ = false, has_stored_ = true;
  std::vector<BlockAddress> victims_;  ///< oldest first
};

PacketCoverage::PacketCoverage(const Config& config)
    : config_(config),
      widths_(derive_widths(config)),
      seen_{config_, widths_},
      hiz_(config_, widths_),
      newest_(without_lag(config_), widths_),
      since_raise_(config_.hiz_lag) {
  const BinRow* row = nullptr;
  for (std::size_t n = 0; n < bins().size(); ++n)
    if (bins()[n].row != std::exchange(row, bins()[n].row))
      rules_[static_cast<std::size_t>(row->event)].push_back({row->hits, n});
}

void PacketCoverage::see(Event event) {
  for (const Rule& rule : rules_[static_cast<std::size_t>(event)])
    for (std::uint64_t left = rule.hits(seen_); left != 0; left &= left - 1)
      ++hits_.bins[rule.first + static_cast<std::size_t>(std::countr_zero(left))];
}

void PacketCoverage::take(On<Arrow::primitive>, const PrimitivePacket& packet) {
  primitive_ = packet;
  seen_.kind = packet.kind;
  seen_.primitive = &primitive_;
  see(Event::primitive);
}

void PacketCoverage::take(On<Arrow::line>, const LineSetup& packet) {
  seen_.line = &packet;
  seen_.has_line_tie = false;
  LineState state = first_state(packet);
  for (; state.remaining != 0; advance(state, packet, widths_)) seen_.has_line_tie |= state.error == 0;
  see(Event::line);
}

void PacketCoverage::take(On<Arrow::triangle>, const TrianglePacket& packet) {
  triangle_ = packet;
  has_triangle_ = packet.kind == PrimitiveKind::triangle;
  if (!has_triangle_) return;
  const auto v = to_snapped(packet.vertex);
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    const std::int64_t exact = exact_edge(from, to, 0, 0, widths_.grid_bits, 0);
    may_tie_[i] = (exact & ((std::int64_t{1} << widths_.grid_bits) - 1)) == 0;  // the same at every pixel centre
    is_top_left_[i] = is_top_left(from, to);
  }
  if (seen_.primitive != nullptr) {
    const auto input = to_snapped(primitive_.vertex);
    const std::int64_t area = signed_area(input[0], input[1], input[2]);
    seen_.corner = static_cast<unsigned>(canonical_order(input, area)[0]) + (area < 0 ? 3U : 0U);
  }
  seen_.triangle = &triangle_;
  see(Event::triangle);
}

void PacketCoverage::take(On<Arrow::setup>, const SetupPacket& packet) {
  setup_ = packet;
  has_setup_ = true;
  seen_.setup = &setup_;
  seen_.walks_left = packet.kind == PrimitiveKind::triangle && walks_left(packet, widths_);
  seen_.asks_hiz = hiz_.is_eligible(packet, widths_);
  SetupPacket unmarked = packet;
  unmarked.state.marks_failed = false;
  seen_.is_hiz_off_by_line = !seen_.asks_hiz && newest_.is_eligible(packet, widths_);
  seen_.is_hiz_off_by_stencil = packet.state.marks_failed && hiz_.is_eligible(unmarked, widths_);
  see(Event::setup);
  if (packet.kind == PrimitiveKind::fast_clear && packet.state.depth_write) {
    const int last_x = packet.box.right >> widths_.tile_shift, last_y = packet.box.bottom >> widths_.tile_shift;
    for (Hiz* hiz : {&hiz_, &newest_}) hiz->clear(last_x, last_y, packet.range.high[kDepthPlane]);
    since_raise_ = config_.hiz_lag;
  }
  if (packet.kind == PrimitiveKind::line) hiz_.pass_line(packet);
}

void PacketCoverage::take(On<Arrow::tile>, const TilePacket& packet) {
  tile_ = packet;
  seen_.tile = &tile_;
  seen_.is_best_on_edge = seen_.is_worst_on_edge = false;
  seen_.is_hidden_by_newer = seen_.is_hiz_bound_equal = seen_.is_in_raising_window = false;
  if (has_setup_ && packet.is_visit) {
    const int x = packet.key.tile_x, y = packet.key.tile_y, size = 1 << widths_.tile_shift;
    if (setup_.kind == PrimitiveKind::triangle) {
      const EdgeValues value = edges_at_tile(setup_, x, y, widths_);
      for (std::size_t i = 0; i < 3; ++i) {
        seen_.is_best_on_edge |= largest_in_tile(value[i], setup_.dx[i], setup_.dy[i], size) == 0;
        seen_.is_worst_on_edge |= smallest_in_tile(value[i], setup_.dx[i], setup_.dy[i], size) == 0;
      }
    }
    if (seen_.asks_hiz) {
      seen_.is_hidden_by_newer = newest_.rejects(setup_, x, y);
      seen_.is_hiz_bound_equal = hiz_.bound(x, y) == setup_.range.low[kDepthPlane];
      seen_.is_in_raising_window = since_raise_ < config_.hiz_lag - 1;
    }
    for (Hiz* hiz : {&hiz_, &newest_}) hiz->begin_visit(setup_.state);
    since_raise_ = setup_.state.depth_write && can_raise_depth(setup_.state.depth_test) ? 0 : since_raise_ + 1;
  }
  see(Event::tile);
}

/// The edges' increments follow each tile.
void PacketCoverage::take(On<Arrow::edges>, const EdgeContext& packet) {
  seen_.ties = 0;
  if (!has_triangle_ || !tile_.is_visit || tile_.kind != PrimitiveKind::triangle) return;
  const bool may_tie = may_tie_[0] || may_tie_[1] || may_tie_[2];
  for (int y = tile_.box.top; may_tie && y <= tile_.box.bottom; ++y)
    for (int x = tile_.box.left; x <= tile_.box.right; ++x) {
      const EdgeDeltas value = edges_at(tile_, packet, x, y);
      unsigned sides = 0;
      int tied = 0;
      bool is_outside = false;
      for (std::size_t i = 0; i < 3; ++i) {
        const bool is_tie = may_tie_[i] && value[i] == (is_top_left_[i] ? 0 : -1);
        is_outside |= value[i] < 0 && !is_tie;
        if (!is_tie) continue;
        ++tied;
        sides |= !is_top_left_[i] ? 4U : packet.step_x[i] == 0 ? 1U : 2U;  // step_x is -dy: 0 on a top edge
      }
      if (!is_outside && tied != 0) seen_.ties |= sides | (tied > 1 ? 8U : 0U);
    }
  see(Event::tie);
}

void PacketCoverage::take(On<Arrow::stamp>, const StampPacket& packet) {
  seen_.stamp = &packet;
  see(Event::stamp);
}

void PacketCoverage::take(On<Arrow::retire>, const RetirePacket& packet) {
  for (Hiz* hiz : {&hiz_, &newest_}) hiz->retire(packet);
  seen_.retire = &packet;
  see(Event::retire);
}

void PacketCoverage::take(On<Arrow::request>, const MemoryRequest& packet) {
  seen_.request = &packet;
  see(Event::request);
}

void PacketCoverage::take(On<Arrow::texture>, const TextureRequest& packet) {
  seen_.texture = &packet;
  see(Event::texture);
}

void PacketCoverage::looked_up(const FragmentPacket& fragment, const TagResult& tags) {
  seen_.fragment = &fragment;
  seen_.tags = &tags;
  has_stored_ = tags.source != DepthSource::none;
  seen_.victims = victims_.size();
  seen_.is_victim_again = std::ranges::find(victims_, tags.block) != victims_.end();
  see(Event::lookup);
  if (tags.eviction) victims_.push_back(tags.eviction->block);
  victims_.erase(victims_.begin(), victims_.begin() + std::min<std::ptrdiff_t>(tags.writes, std::ssize(victims_)));
}

void PacketCoverage::meets(const FragmentPacket& fragment, std::span<const std::uint32_t> stored,
                           const StencilState& state) {
  seen_.fragment = &fragment;
  seen_.is_same_stamp = has_last_ && last_.key.tile_x == fragment.key.tile_x &&
                        last_.key.tile_y == fragment.key.tile_y && last_.stamp == fragment.stamp &&
                        last_.state.depth_write && (last_.mask & fragment.mask).any();
  see(Event::meeting);
  seen_.func = fragment.state.depth_test;
  seen_.stencil = fragment.state.tests_stencil ? &state.side[fragment.state.is_back ? 1 : 0] : nullptr;
  seen_.has_stored = has_stored_;
  fragment.mask.for_each([&](std::size_t s) {
    seen_.depth = fragment_depth(fragment, s, widths_);
    seen_.stored = depth_of(stored[s], widths_);
    seen_.stored_stencil = stencil_of(stored[s], widths_);
    seen_.passes_depth = depth_passes(seen_.func, seen_.depth, seen_.stored);
    seen_.passes_stencil = seen_.stencil == nullptr ||
                           depth_passes(seen_.stencil->func, seen_.stencil->reference & seen_.stencil->read_mask,
                                        seen_.stored_stencil & seen_.stencil->read_mask);
    see(Event::sample);
  });
  last_.key = fragment.key;
  last_.stamp = fragment.stamp;
  last_.state = fragment.state;
  last_.mask = fragment.mask;
  has_last_ = true;
}

void PacketCoverage::shaded(const FragmentPacket& fragment, const StampFate& fate, const ColorState& colors) {
  seen_.fragment = &fragment;
  seen_.fate = &fate;
  seen_.colors = &colors;
  see(Event::fate);
}

Hits::Hits() : bins(cover::bins().size()) {}

const std::vector<Dimension>& Hits::all_dimensions() {
  static const std::vector<Dimension> kAll = dimensions();
  return kAll;
}

struct Collector::Run final : PacketCoverage {
  explicit Run(const Config& config) : PacketCoverage(config) {}

  void draw(const Scene& scene, const Config& host);
  void add(const std::array<StreamUse, kStreams.size()>& use);
  [[nodiscard]] const Hits& hits() const { return hits_; }

 private:
  std::optional<HardwareModel> model_;  ///< of the first scene on
  BinContents held_;
  CounterPacket counted_;
};

void Collector::Run::draw(const Scene& scene, const Config& host) {
  if (!model_) model_.emplace(config_, *this).set_watch(this);
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    seen_.state = &scene.states[draw->state];
    seen_.type = drawn_as(*seen_.state, draw->topology);
    hits_.pairs.add(*seen_.state);
    see(Event::draw);
  }
  HostStream stream(scene, host, &held_);
  model_->hold_textures(scene);
  Counters before;
  while (const auto primitive = stream.next()) {
    const Counters& now = stream.counters();
    seen_.is_clipped = now.clipped != before.clipped;
    seen_.is_outside = now.skipped.frustum != before.skipped.frustum;
    seen_.is_part = primitive->is_part;
    before = now;
    take(on<Arrow::primitive>, primitive->packet);
    if (primitive->line) take(on<Arrow::line>, *primitive->line);
    model_->run(primitive->packet, primitive->line);
    seen_.counted = since(model_->counters(), counted_);
    counted_ = model_->counters();
    see(Event::counted);
  }
}

void Collector::Run::add(const std::array<StreamUse, kStreams.size()>& use) {
  for (std::size_t n = 0; n < use.size(); ++n) {
    seen_.stream = n;
    if (use[n].stalled != 0) see(Event::stream);
  }
}

Collector::Collector(const Config& config) : run_(std::make_unique<Run>(config)) {}
Collector::~Collector() = default;
void Collector::run(const Scene& scene, const Config& host) { run_->draw(scene, host); }
void Collector::add(const std::array<StreamUse, kStreams.size()>& use) { run_->add(use); }
PacketSink& Collector::packets() { return *run_; }
const Hits& Collector::hits() const { return run_->hits(); }

}  // namespace halfplane::cover
