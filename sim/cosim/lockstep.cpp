#include "sim/cosim/lockstep.hpp"
#include "model/stages/memory_port.hpp"
#include "model/stages/stencil_packets.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "model/stages/depth_test.hpp"
#include "model/stages/rop.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {
namespace {

/// The stencil value that a fast clear of depth leaves.
std::uint8_t clear_stencil(const HostPrimitive& clear) {
  StencilState state;
  if (const auto& test = clear.units.stencil.test[0]) state.set(StateRegister::stencil_test, front_only(*test));
  return state.clear_value();
}

constexpr std::uint64_t kHangCycles = 100'000;  // cycles without any packet; walks over the clear flags are added
constexpr std::uint64_t kCountingCycles = 8;    // cycles after the end, until all counts are shown
constexpr std::uint64_t kSettleCycles = 64;     // cycles after the end, in which an extra packet would show
constexpr std::uint64_t kMostCyclesBeforeReset = 6000;
constexpr std::uint64_t kReportCycles = 1 << 16;
constexpr std::uint32_t kWrites = tap_bit(Arrow::write);

std::array<std::size_t, kArrows> packet_bytes(const Widths& widths) {
  std::array<std::size_t, kArrows> bytes{};
  for (std::size_t i = 0; i < kArrows; ++i)
    bytes[i] = with_packet_type(static_cast<Arrow>(i), [&]<class Packet>(std::type_identity<Packet>) {
      return static_cast<std::size_t>(packet_bits<Packet>(widths) + 7) / 8;
    });
  return bytes;
}

/// A port's packet as words.
std::vector<std::uint32_t> words_from(const void* bytes, std::size_t count) {
  std::vector<std::uint32_t> words((count + 3) / 4);
  std::memcpy(words.data(), bytes, count);
  return words;
}

/// Fault attribution by the arrow and, for a packet that differs, by its differing fields.
Stage suspect(Arrow arrow, const Mismatch& mismatch) {
  if (mismatch.kind != Mismatch::Kind::differs) return suspect(arrow);
  Difference difference;
  for (const FieldPair& field : mismatch.fields) {
    if (field.name == "kind") difference.is_of_line = field.model == static_cast<std::uint64_t>(PrimitiveKind::line);
    if (field.differs() && !field.name.starts_with("color[")) difference.is_in_color_only = false;
  }
  return suspect(arrow, difference);
}

}  // namespace

Lockstep::Lockstep(Dut& dut, const Config& config, LockstepOptions options)
    : dut_(dut),
      config_(config),
      widths_(derive_widths(config)),
      options_(std::move(options)),
      threshold_(stall_threshold(options_.stall_probability)),
      bytes_(packet_bytes(widths_)),
      expected_(widths_),
      memory_(config_, widths_, options_.memory, options_.layout.value_or(default_layout(widths_))),
      textures_(config_, widths_, make_memory(without_traffic(options_.memory), config_)),
      counter_bytes_(static_cast<std::size_t>(packet_bits<CounterPacket>(widths_) + 7) / 8),
      primitive_(words_of(packet_bits<PrimitivePacket>(widths_))),
      lines_(words_of(packet_bits<LineSetup>(widths_))),
      held_(words_of(packet_bits<MemoryBeat>(widths_))) {
  dut_.reset(options_.seed, options_.mutant);
  dut_.set_layout(packed(memory_.tiles().layout(), widths_).data());
  start_models(memory_.tiles());
}

/// Starts the models as after a reset, with this memory.
void Lockstep::start_models(TileMemory memory) {
  expected_.clear();
  expected_cycles_ = {};
  is_first_ = true;
  bins_.forget();
  model_.emplace(config_, expected_, std::move(memory));
  if (!options_.compares || !options_.compares_cycles || options_.drains_clears) return;
  CycleOptions cycles;
  cycles.stalls = {options_.seed, threshold_};
  cycles.parameters = options_.parameters;
  cycles.sink = &expected_cycles_;
  cycles.layout = options_.layout;
  model_memory_ = make_memory(options_.model_memory.value_or(options_.memory), config_);
  cycles.textures = options_.model_memory.value_or(options_.memory);
  cycle_model_ = make_cycle_model(config_, *model_memory_, cycles);
}

Lockstep::~Lockstep() {
  if (waveform_) dut_.close_trace();  // not wanted
}

void Lockstep::begin(const Scene& scene) {
  result_ = {};
  sent_.clear();
  all_sent_ = false;
  snapshot_.clear();
  dut_.set_counters_hold(false);
  last_moved_ = cycle_;
  last_drawn_ = ~0ULL;
  textures_.hold(scene);
  model_->hold_textures(scene);
  memory_.show(scene.width, scene.height);
  if (cycle_model_) {
    model_memory_->show(scene.width, scene.height);
    cycle_model_->hold_textures(scene);
    cycle_model_->begin(scene.width, scene.height, cycle_);
  }
}

/// Runs a part of a scene, and then resets in the middle of it; the memory does not see the reset. After it the model
/// starts as after power-up, with the memory's content.
void Lockstep::run_and_reset(const Scene& scene, std::uint64_t cycles) {
  HostStream host(scene, config_);
  begin(scene);
  for (const std::uint64_t end = cycle_ + cycles; cycle_ != end && !result_.mismatch;) step(host);
  // A cycle of reset, with nothing on offer any more. Then the memory answers, and the answers are dropped.
  options_.compares = false;
  dut_.hold_reset(true);
  dut_.set_primitive(nullptr);
  dut_.set_line(nullptr);
  has_primitive_ = has_line_ = false;
  all_sent_ = true;
  while (!lines_.empty()) lines_.pop();
  step(host);
  dut_.hold_reset(false);
  was_idle_ = false;
  for (const std::uint64_t limit = cycle_ + kHangCycles;
       !(was_idle_ && memory_.is_idle() && textures_.is_idle()) && cycle_ != limit;)
    step(host);
  options_.compares = true;
  memory_.rest(make_memory(options_.memory, config_));
  textures_.rest(make_memory(without_traffic(options_.memory), config_));
  start_models(memory_.tiles());
}

LockstepResult Lockstep::run(const Scene& scene, const Config& host_config, bool draws_all) {
  if (options_.watch) options_.watch(scene, host_config);
  Random random(options_.seed + cycle_);
  for (int n = 0; n < options_.resets; ++n) {
    run_and_reset(scene, 1 + random.next() % kMostCyclesBeforeReset);
    if (result_.mismatch) return result_;
  }
  if (draws_all) bins_.forget();
  HostStream host(scene, host_config, &bins_);
  begin(scene);
  const std::uint64_t start = cycle_;
  // Clearing and flushing visit the flags of every tile, a few cycles each, and move no packet meanwhile.
  const auto tiles = static_cast<std::uint64_t>((scene.width >> widths_.tile_shift) + 1) *
                     static_cast<std::uint64_t>((scene.height >> widths_.tile_shift) + 1);
  const std::uint64_t limit = kHangCycles + 8 * tiles;
  while (!result_.mismatch) {
    step(host);
    const std::uint64_t still = cycle_ - last_moved_;
    if (has_finished() && still > kSettleCycles) break;
    if (all_sent_ && was_idle_ && still > 16 * kSettleCycles + static_cast<std::uint64_t>(options_.memory.latency))
      break;
    if (still > limit) break;
    if (cycle_ % kReportCycles == 0 && options_.progress && !options_.progress(host.progress())) {
      result_.is_stopped = true;
      break;
    }
  }
  if (!result_.mismatch && !result_.is_stopped) {
    if (options_.compares && !expected_.empty())
      report_missing();
    else if (!has_finished())
      fail_protocol("raster_top", all_sent_ ? "idle_o never rises after the flush" : "primitives are no longer taken");
    if (options_.compares && !result_.mismatch) compare_memory();
    if (options_.compares && !result_.mismatch) compare_counters();
    if (!result_.mismatch) report_missing_cycle();
  }
  for (; result_.mismatch && waveform_ && cycle_ <= options_.trace_last; ++cycle_) {  // records the fault's effects
    (void)dut_.evaluate(0, true, true);
    dut_.clock();
  }
  host_counters_ = host.counters();
  result_.cycles = last_moved_ + 1 - start;
  if (cycle_model_) {
    cycle_model_->complete();
    result_.model_cycles = cycle_model_->totals().last + 1 - start;
    result_.model_raster_cycles = cycle_model_->totals().raster_cycles();
    result_.model_tile_cycles = cycle_model_->totals().tile_cycles;
  }
  result_.clocks = cycle_ - start;
  return result_;
}

bool Lockstep::has_finished() const {
  return all_sent_ && was_idle_ && lines_.empty() && memory_.is_idle() && textures_.is_idle() && expected_.empty();
}

/// Keeps a primitive and a line on offer, and runs the model for it before the design can have seen it.
void Lockstep::offer(HostStream& host) {
  offer_primitive(host);
  if (has_line_) return;
  has_line_ = !lines_.empty();
  dut_.set_line(has_line_ ? lines_.front() : nullptr);
}

void Lockstep::offer_primitive(HostStream& host) {
  if (has_primitive_ || all_sent_) return;
  if (drains_) {
    dut_.set_primitive(nullptr);
    if (!was_idle_) return;
    drains_ = false;
  }
  const auto next = host.next();
  if (!next) {
    all_sent_ = true;
    dut_.set_primitive(nullptr);
    dut_.set_counters_hold(true);  // while there are still events to count
    snapshot_at_ = cycle_ + kCountingCycles;
    return;
  }
  if (const std::string fault = stream_fault(*next, is_first_); !fault.empty()) {
    fail_protocol("host", fault);
    return;
  }
  is_first_ = is_first_ && next->packet.kind == PrimitiveKind::state;
  pack_words(next->packet, widths_, primitive_.data());
  dut_.set_primitive(primitive_.data());
  has_primitive_ = true;
  if (next->packet.kind == PrimitiveKind::fast_clear) {  // the host's knowledge about blocks whose flags are set
    const PerPlane<std::uint32_t>& code = next->packet.vertex.code[0];
    if (next->packet.state.depth_write)
      memory_.tiles().set_clear_value(TilePlane::depth, depth_word(code[kDepthPlane], clear_stencil(*next), widths_));
    if (next->packet.state.color_write) memory_.tiles().set_clear_value(TilePlane::color, stored_color(code, config_));
  }
  if (next->line) pack_words(*next->line, widths_, lines_.push(0));
  if (options_.compares) {
    expected_.set_sequence(static_cast<std::uint32_t>(sent_.size()));
    model_->run(next->packet, next->line);
    if (cycle_model_) cycle_model_->run(*next);
  } else if (next->packet.kind == PrimitiveKind::triangle && !next->is_part) {
    CounterPacket ignored;  // the pieces of one input triangle are consecutive
    if (cull(next->packet, widths_, ignored) && std::exchange(last_drawn_, next->primitive) != next->primitive)
      ++result_.drawn;
  }
  sent_.push_back(*next);
}

void Lockstep::step(HostStream& host) {
  trace();
  offer(host);
  if (!has_answer_) {
    const std::uint32_t* due = memory_.due(cycle_);
    dut_.set_answer(due);  // here and not at the take: the clock edge must still see it
    has_answer_ = due != nullptr;
  }
  const std::uint32_t stalls = stall_bits(options_.seed, cycle_, threshold_);
  const bool beat_ready = memory_.is_ready(cycle_) && !is_stalled(options_.seed, kMemoryStall, cycle_, threshold_);
  if (!has_texel_) {
    const std::uint32_t* due = textures_.due(cycle_);
    dut_.set_texel(due);
    has_texel_ = due != nullptr;
  }
  const bool texture_ready = textures_.is_ready(cycle_);
  const DutOutputs& out = dut_.evaluate(stalls, beat_ready, texture_ready);
  if (!out.failure.empty()) fail_protocol("host", out.failure);

  if (all_sent_ && cycle_ == snapshot_at_) snapshot_ = words_from(out.counters, counter_bytes_);

  bool moved = out.fired != 0;
  if (options_.tap)
    for (std::uint32_t left = out.fired; left != 0; left &= left - 1) {
      const Arrow arrow = kTapped[static_cast<std::size_t>(std::countr_zero(left))];
      options_.tap(arrow, out.packet[index(arrow)], cycle_);
    }
  if (options_.compares)
    for (std::uint32_t left = out.fired; left != 0 && !result_.mismatch; left &= left - 1) {
      const Arrow arrow = kTapped[static_cast<std::size_t>(std::countr_zero(left))];
      compare(arrow, out.packet[index(arrow)]);
      if (is_boundary(arrow)) compare_cycle(arrow);
    }
  if (out.beat_valid || has_held_) {
    const bool taken = out.beat_valid && beat_ready;
    if (threshold_ != 0) watch_beat(out, stalls, taken);
    if (taken && !result_.mismatch) {
      const void* beat = out.packet[index(Arrow::beat)];
      if (options_.compares) {
        compare(Arrow::beat, beat);
        compare_cycle(Arrow::beat);
      }
      std::memcpy(held_.data(), beat, bytes_[index(Arrow::beat)]);
      memory_.accept(held_.data(), cycle_);
      moved = true;
    }
  }
  if (has_answer_ && out.answer_ready) {
    memory_.pop();
    has_answer_ = false;
    moved = true;
    compare_cycle(Arrow::answer);
  }
  if (out.texture_valid && texture_ready && !result_.mismatch) {
    const void* request = out.packet[index(Arrow::texture)];
    if (options_.compares) {
      compare(Arrow::texture, request);
      compare_cycle(Arrow::texture);
    }
    textures_.accept(words_from(request, bytes_[index(Arrow::texture)]).data(), cycle_);
    moved = true;
  }
  if (has_texel_ && out.texel_ready) {
    textures_.pop();
    has_texel_ = false;
    moved = true;
    compare_cycle(Arrow::texel);
  }
  const bool taken = has_primitive_ && out.primitive_ready;
  if (taken) {
    has_primitive_ = false;
    moved = true;
    drains_ = options_.drains_clears && sent_.back().packet.kind == PrimitiveKind::fast_clear;
    if (options_.tap) options_.tap(Arrow::primitive, primitive_.data(), cycle_);
    count_taken();
    compare_cycle(Arrow::primitive);
  }
  if (has_line_ && out.line_ready) {
    compare_cycle(Arrow::line);
    if (options_.tap) options_.tap(Arrow::line, lines_.front(), cycle_);
    lines_.pop();
    has_line_ = false;
    moved = true;
  }
  if (result_.primitives() != 0 && out.moves_tiles) ++tile_cycles_;
  if ((out.fired & kWrites) != 0 && result_.primitives() != 0) {
    result_.raster_cycles = cycle_ - first_taken_ + 1;
    result_.tile_cycles = tile_cycles_;
  }
  if (out.idle && !textures_.is_idle())
    fail_protocol(std::string(info(Stage::texture_unit).name),
                  "idle_o is high before the memory of textures has answered");
  if (out.idle && !memory_.is_idle())
    fail_protocol(std::string(info(Stage::memory_port).name), "idle_o is high before memory has answered");
  was_idle_ = out.idle && !taken;  // a packet taken now is not yet under way
  if (moved) last_moved_ = cycle_;
  if (!options_.compares || options_.counts_use) count_use(out);
  dut_.clock();
  ++cycle_;
}

/// The primitive on offer has been taken.
void Lockstep::count_taken() {
  const PrimitiveKind kind = sent_.back().packet.kind;
  if (!is_counted(kind)) return;
  if (result_.primitives() == 0) {
    first_taken_ = cycle_;
    tile_cycles_ = 0;
  }
  ++(kind == PrimitiveKind::line ? result_.lines : kind == PrimitiveKind::point ? result_.points : result_.triangles);
}

void Lockstep::compare(Arrow arrow, const void* rtl) {
  const std::size_t bytes = bytes_[index(arrow)];
  PacketQueue& queue = expected_[arrow];
  ++result_.compared[index(arrow)];
  if (!queue.empty() && std::memcmp(queue.front(), rtl, bytes) == 0) {
    queue.pop();
    return;
  }
  const auto words = words_from(rtl, bytes);
  if (queue.empty()) {
    const std::vector<std::uint32_t> nothing(words.size());
    result_.mismatch = packet_mismatch(Mismatch::Kind::extra, arrow, nothing.data(), words.data(), ~0U);
    return;
  }
  result_.mismatch = packet_mismatch(Mismatch::Kind::differs, arrow, queue.front(), words.data(), queue.front_tag());
  if (queue.size() > 1 && std::memcmp(queue.front(1), rtl, bytes) == 0)
    result_.mismatch->hint = "the RTL's packet is the model's next one: this one was lost";
}

/// An item crosses `boundary` in this cycle.
void Lockstep::compare_cycle(Arrow boundary) {
  if (!cycle_model_ || !options_.compares || result_.mismatch) return;
  auto& queue = expected_cycles_[boundary];
  ++result_.cycles_compared[index(boundary)];
  if (!queue.empty() && queue.front() == cycle_) {
    queue.pop_front();
    return;
  }
  if (queue.empty())
    result_.mismatch = cycle_mismatch(boundary, {}, "the cycle model knows of no such packet");
  else
    result_.mismatch = cycle_mismatch(boundary, {{"cycle", 64, false, queue.front(), cycle_}}, "");
}

/// Without a pair of cycles nothing can be compared: `fields` is empty.
Mismatch Lockstep::cycle_mismatch(Arrow boundary, std::vector<FieldPair> fields, const std::string& hint) const {
  Mismatch m;
  m.kind = Mismatch::Kind::cycle;
  m.arrow = info(boundary).name;
  m.stage = sender_name(boundary);
  m.cycle = cycle_;
  const std::uint64_t compared = result_.cycles_compared[index(boundary)];
  m.number = compared - std::min<std::uint64_t>(1, compared);
  m.fields = std::move(fields);
  m.hint = hint;
  return m;
}

/// Under back-pressure a beat must wait unchanged. A cycle that stalls the stream itself shows no offer.
void Lockstep::watch_beat(const DutOutputs& out, std::uint32_t stalls, bool taken) {
  const void* beat = out.packet[index(Arrow::beat)];
  const std::size_t bytes = bytes_[index(Arrow::beat)];
  const bool is_hidden = (stalls & stall_bit(Arrow::beat)) != 0;
  if (has_held_ && !is_hidden) {
    if (!out.beat_valid)
      fail_protocol(std::string(info(Stage::memory_port).name), "beat_valid_o fell before the beat was taken");
    else if (std::memcmp(held_.data(), beat, bytes) != 0)
      fail_protocol(std::string(info(Stage::memory_port).name), "beat_o changed before the beat was taken");
  }
  if (out.beat_valid && !taken) std::memcpy(held_.data(), beat, bytes);
  has_held_ = (has_held_ || out.beat_valid) && !taken;
}

void Lockstep::count_use(const DutOutputs& out) {
  for (std::size_t i = 0; i < kStreams.size(); ++i) {
    const bool valid = (out.stream_valid >> i & 1) != 0, ready = (out.stream_ready >> i & 1) != 0;
    result_.use[i].busy += valid && ready ? 1 : 0;
    result_.use[i].stalled += valid && !ready ? 1 : 0;
    result_.use[i].starved += valid ? 0 : 1;
  }
}

void Lockstep::trace() {
  if (options_.trace.empty()) return;
  if (cycle_ == options_.trace_first && dut_.can_trace()) begin_trace();
  if (waveform_ && cycle_ == options_.trace_last + 1) (void)finish_trace();
}

void Lockstep::begin_trace() {
  try {
    waveform_.emplace(options_.trace);
  } catch (const InputError& error) {
    trace_failure_ = error.what();
    return;
  }
  if (dut_.open_trace(waveform_->name()) != 0) (void)finish_trace();
}

bool Lockstep::finish_trace() {
  if (!waveform_) return has_traced_;
  try {
    waveform_->finish(dut_.close_trace());
    has_traced_ = true;
  } catch (const InputError& error) {
    trace_failure_ = error.what();
  }
  waveform_.reset();
  return has_traced_;
}

Mismatch Lockstep::packet_mismatch(Mismatch::Kind kind, Arrow arrow, const std::uint32_t* model,
                                   const std::uint32_t* rtl, std::uint32_t tag) const {
  Mismatch m;
  m.kind = kind;
  m.arrow = info(arrow).name;
  m.fields = field_pairs(arrow, widths_, model, rtl);
  m.stage = info(suspect(arrow, m)).name;
  m.cycle = cycle_;
  const std::uint64_t compared = result_.compared[index(arrow)];
  m.number = kind == Mismatch::Kind::missing ? compared : compared - 1;
  if (tag < sent_.size() && is_counted(sent_[tag].packet.kind)) m.primitive = sent_[tag].primitive;
  for (const FieldPair& field : m.fields) {
    const std::uint64_t value = kind == Mismatch::Kind::extra ? field.rtl : field.model;
    if (field.name == "tile_x") m.tile_x = value;
    if (field.name == "tile_y") m.tile_y = value;
    if (field.name == "stamp") m.stamp = value;
  }
  return m;
}

void Lockstep::fail_protocol(const std::string& stage, const std::string& hint) {
  Mismatch m;
  m.kind = Mismatch::Kind::protocol;
  m.stage = stage;
  m.arrow = "protocol";
  m.hint = hint;
  m.cycle = cycle_;
  result_.mismatch = std::move(m);
}

std::vector<std::uint32_t> Lockstep::shown_counters() {
  for (std::uint64_t cycle = 1; cycle < kCountingCycles; ++cycle) (void)dut_.evaluate(0, false, false);
  return words_from(dut_.evaluate(0, false, false).counters, counter_bytes_);
}

CounterPacket Lockstep::counters() {
  dut_.set_counters_hold(false);
  return unpack_words<CounterPacket>(shown_counters().data(), widths_);
}

}  // namespace halfplane
