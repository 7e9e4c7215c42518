// The comparison at the end of a lock-step run: packets and crossings that never came, counters, memory.
#include <algorithm>

#include "sim/cosim/lockstep.hpp"

namespace halfplane {

std::uint64_t LockstepResult::total() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t n : compared) sum += n;
  return sum;
}

std::uint64_t LockstepResult::total_cycles_compared() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t n : cycles_compared) sum += n;
  return sum;
}

void LockstepResult::add(const LockstepResult& later) {
  for (std::size_t i = 0; i < kArrows; ++i) {
    compared[i] += later.compared[i];
    cycles_compared[i] += later.cycles_compared[i];
  }
  memory_compared += later.memory_compared;
  counters_compared += later.counters_compared;
  if (!mismatch) mismatch = later.mismatch;
  is_stopped |= later.is_stopped;
  triangles += later.triangles;
  lines += later.lines;
  points += later.points;
  cycles += later.cycles;
  model_cycles += later.model_cycles;
  model_raster_cycles += later.model_raster_cycles;
  model_tile_cycles += later.model_tile_cycles;
  clocks += later.clocks;
  raster_cycles += later.raster_cycles;
  tile_cycles += later.tile_cycles;
  for (std::size_t i = 0; i < use.size(); ++i) {
    use[i].busy += later.use[i].busy;
    use[i].stalled += later.use[i].stalled;
    use[i].starved += later.use[i].starved;
  }
}

ExpectedPackets::ExpectedPackets(const Widths& widths) : widths_(widths) {
  for (std::size_t i = 0; i < kArrows; ++i)
    queue_.emplace_back(with_packet_type(static_cast<Arrow>(i), [&]<class Packet>(std::type_identity<Packet>) {
      return words_of(packet_bits<Packet>(widths));
    }));
}

void ExpectedPackets::clear() {
  for (PacketQueue& queue : queue_)
    while (!queue.empty()) queue.pop();
}

bool ExpectedPackets::empty() const {
  for (const PacketQueue& queue : queue_)
    if (!queue.empty()) return false;
  return true;
}

/// Reports, at the end, a crossing that the cycle model expects and that never came.
void Lockstep::report_missing_cycle() {
  if (!cycle_model_) return;
  for (const Arrow boundary : kBoundaries)
    if (const auto& left = expected_cycles_[boundary]; !left.empty() && !result_.mismatch)
      result_.mismatch =
          cycle_mismatch(boundary, {}, "the cycle model has one more in cycle " + std::to_string(left.front()));
}

/// Names the streams whose packet is not taken; suspects the stage downstream of the last one.
void Lockstep::explain_standstill(Mismatch& mismatch) {
  const DutOutputs& out = dut_.evaluate(0, true, true);
  std::string waiting;
  for (std::size_t i = 0; i < kStreams.size(); ++i) {
    if ((out.stream_valid >> i & ~(out.stream_ready >> i) & 1) == 0) continue;
    waiting += (waiting.empty() ? "" : ", ") + std::string(info(kStreams[i]).name);
    mismatch.stage = info(info(kStreams[i]).to).name;
  }
  mismatch.hint = "nothing moves after cycle " + std::to_string(last_moved_) + "; " +
                  (waiting.empty() ? "no stream holds a packet" : "offered and not taken: " + waiting);
}

/// Reports the missing packet of the earliest primitive: everything later waits for it.
void Lockstep::report_missing() {
  std::optional<Arrow> first;
  for (const Arrow arrow : kCompared) {
    if (expected_[arrow].empty()) continue;
    if (!first || expected_[arrow].front_tag() < expected_[*first].front_tag()) first = arrow;
  }
  const PacketQueue& queue = expected_[*first];
  const std::vector<std::uint32_t> nothing(queue.words());
  result_.mismatch = packet_mismatch(Mismatch::Kind::missing, *first, queue.front(), nothing.data(), queue.front_tag());
  result_.mismatch->cycle = last_moved_;
  explain_standstill(*result_.mismatch);
}

std::optional<Stage> stage_of_counter(std::string_view name) {
  using enum Stage;
  static constexpr std::pair<std::string_view, Stage> kStageOfCounter[]{{"primitives_in", cull},
                                                                        {"zero_area", cull},
                                                                        {"backface", cull},
                                                                        {"empty", cull},
                                                                        {"no_sample", cull},
                                                                        {"tiles_visited", coarse_raster},
                                                                        {"tiles_outside", coarse_raster},
                                                                        {"trivially_accepted", coarse_raster},
                                                                        {"tiles_hiz", coarse_raster},
                                                                        {"samples_tested", coarse_raster},
                                                                        {"covered", depth_test},
                                                                        {"depth_passed", depth_test},
                                                                        {"written", depth_test},
                                                                        {"alpha_killed", depth_test},
                                                                        {"tile_fills", framebuffer},
                                                                        {"tile_evictions", framebuffer},
                                                                        {"tile_clears", framebuffer},
                                                                        {"texture_samples", texture_unit},
                                                                        {"texture_hits", texture_unit},
                                                                        {"texture_fills", texture_unit}};
  const auto* found = std::ranges::find(kStageOfCounter, name, &std::pair<std::string_view, Stage>::first);
  return found == std::end(kStageOfCounter) ? std::nullopt : std::optional(found->second);
}

void Lockstep::compare_counters() {
  if (config_.counter_units == 0) return;
  if (!snapshot_.empty() && snapshot_ != shown_counters()) return fail_protocol("raster_top", "held counters count");
  const auto model = packed(as_counted(model_->counters(), widths_), widths_), rtl = packed(counters(), widths_);
  Mismatch m;
  m.kind = Mismatch::Kind::counters;
  m.fields = field_pairs<CounterPacket>(widths_, model.data(), rtl.data());
  result_.counters_compared += m.fields.size();
  const auto names = m.differing();
  if (names.empty()) return;
  m.arrow = "counters";
  const auto counter =
      std::ranges::find_if(names, [](std::string_view name) { return stage_of_counter(name).has_value(); });
  m.stage = counter == names.end() ? "raster_top" : info(*stage_of_counter(*counter)).name;
  m.cycle = cycle_;
  result_.mismatch = std::move(m);
}

void Lockstep::compare_memory() {
  const TileMemory &model = model_->memory(), &rtl = memory_.tiles();
  constexpr std::uint32_t kPage = TileMemory::kPage;
  const auto beats = kPage / static_cast<std::uint32_t>(widths_.port_bytes);
  for (std::size_t page = 0; page < rtl.pages(); ++page) {
    if (model.page(page).empty() && rtl.page(page).empty()) continue;
    result_.memory_compared += kPage >> widths_.memory.stamp[0];
    if (std::ranges::equal(model.page(page), rtl.page(page))) continue;
    for (std::uint32_t n = 0; n < beats; ++n) {
      MemoryBeat a, b;
      a.address = b.address = static_cast<std::uint32_t>(page) * kPage + (n << widths_.memory.port);
      model.read(a.address, a.data);
      rtl.read(b.address, b.data);
      if (a.data == b.data) continue;
      result_.mismatch = packet_mismatch(Mismatch::Kind::memory, Arrow::beat, packed(a, widths_).data(),
                                         packed(b, widths_).data(), ~0U);
      result_.mismatch->arrow = "memory";
      return;
    }
  }
}

}  // namespace halfplane
