// Lock-step: runs a scene in the design, and compares every packet on every arrow with the model's, in order and bit by
// bit.
//
// The model runs one primitive at a time, when that primitive is first offered to the design, and queues the expected
// packets. Each arrow is compared separately, so latencies do not matter.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/cycle/streams.hpp"
#include "model/engines/hardware.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/timing/stream.hpp"
#include "sim/cosim/arrows.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/cosim/memory_model.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {

/// The streams of one cycle as raster_top's stall_i.
[[nodiscard]] constexpr std::uint32_t stall_bits(std::uint64_t seed, std::uint64_t cycle, std::uint64_t threshold) {
  unsigned bits = 0;
  if (threshold != 0)
    for (const Arrow arrow : kElastic)
      if (is_stalled(seed, info(arrow).flow.stall, cycle, threshold)) bits |= stall_bit(arrow);
  return bits;
}

struct Mismatch {
  enum class Kind {
    differs,   ///< a packet with other bits
    extra,     ///< a packet that the model does not send
    missing,   ///< a packet that the RTL never sends
    memory,    ///< the final memory image
    counters,  ///< the performance counters
    protocol,  ///< valid, ready or idle broke a rule
    cycle      ///< a packet in a cycle other than the cycle model's
  };
  Kind kind = Kind::differs;
  std::string stage, arrow;                ///< the first suspect, and the arrow
  std::string hint;                        ///< one more line, or empty
  std::vector<FieldPair> fields;           ///< all fields; one side is 0 if it has no packet
  std::uint64_t cycle = 0;                 ///< since reset
  std::uint64_t number = 0;                ///< of the packet on its arrow, from 0 at the start of the scene
  std::optional<std::uint32_t> primitive;  ///< number of the input primitive; none: a clear, the flush, or unknown
  std::optional<std::uint64_t> tile_x, tile_y, stamp;

  /// Names of the fields that differ.
  [[nodiscard]] std::vector<std::string> differing() const {
    std::vector<std::string> names;
    for (const FieldPair& field : fields)
      if (field.differs()) names.push_back(field.name);
    return names;
  }
};

struct LockstepOptions {
  std::uint64_t seed = 1;        ///< seed of stalls and start values
  double stall_probability = 0;  ///< per stream and cycle, in [0, 1)
  MemorySettings memory;         ///< connected to the RTL's memory port
  std::uint16_t mutant = 0;
  bool drains_clears = false;  ///< no packet enters after a fast clear until it is done: for cycles of primitives only
  bool counts_use = false;     ///< counts the cycles of streams (LockstepResult::use) while it compares, too
  /// Called with each scene that is run to its end, as it is sent, before it is. May be empty.
  std::function<void(const Scene& scene, const Config& host)> watch;
  bool compares = true;  ///< false: only the design, for its image and counters
  /// With `compares`, and without `drains_clears`: the cycle of every crossing of every boundary against the cycle model.
  bool compares_cycles = false;
  int resets =
      0;  ///< with `compares`: each scene is started and cut by a reset at a random cycle this often, before it runs
  std::optional<MemoryLayout> layout;          ///< addresses of the buffers in memory; default_layout() unless given
  TimingParameters parameters;                 ///< parameters of the cycle model; the default is the RTL
  std::optional<MemorySettings> model_memory;  ///< likewise: `memory` unless given
  std::string trace;                           ///< FST file, empty: none; contains the cycles of the window
  std::uint64_t trace_first = 0, trace_last = ~0ULL;
  /// Sees every packet that crosses a boundary into or inside the RTL, in its cycle: little-endian bytes of the packet,
  /// rounded up. Packets of one arrow come in order. May be empty.
  std::function<void(Arrow arrow, const void* packet, std::uint64_t cycle)> tap;
  /// Called every 2^16 cycles with the fraction of the scene that has been sent; false stops the run.
  std::function<bool(double fraction)> progress;
};

/// The stage that counts this member of CounterPacket; none: several stages.
[[nodiscard]] std::optional<Stage> stage_of_counter(std::string_view name);

struct LockstepResult {
  std::array<std::uint64_t, kArrows> compared{};  ///< packets, by arrow
  std::uint64_t memory_compared = 0;              ///< stamps of either buffer in the final memory
  std::uint64_t counters_compared = 0;
  std::array<std::uint64_t, kArrows> cycles_compared{};  ///< crossings, by boundary
  std::optional<Mismatch> mismatch;
  bool is_stopped = false;                             ///< stopped by options.progress: neither equal nor different
  std::uint64_t triangles = 0, lines = 0, points = 0;  ///< taken by the RTL
  std::uint64_t cycles = 0;                            ///< to the last packet anywhere, memory included
  std::uint64_t raster_cycles = 0;  ///< from the first primitive taken to the last write into the on-chip tiles
  std::uint64_t tile_cycles = 0;    ///< cycles among them in which the framebuffer moved tiles and served no access
  std::uint64_t model_cycles = 0;   ///< the cycle model's `cycles`; 0 if not computed
  std::uint64_t model_raster_cycles = 0, model_tile_cycles = 0;  ///< likewise of `raster_cycles`, `tile_cycles`
  std::uint64_t clocks = 0;  ///< simulated clocks, including the wait for an extra packet
  std::uint64_t drawn = 0;   ///< input triangles with a piece that passed cull; only if nothing is compared
  std::array<StreamUse, kStreams.size()> use{};  ///< by kStreams; if nothing is compared, or counts_use

  [[nodiscard]] std::uint64_t total() const;
  [[nodiscard]] std::uint64_t total_cycles_compared() const;
  [[nodiscard]] std::uint64_t primitives() const { return triangles + lines + points; }
  /// Adds a later run of the same Lockstep.
  void add(const LockstepResult& later);
};

/// Collects the packets of the RTL's arrows from the model into one queue per arrow.
class ExpectedPackets final : public EveryPacket<ExpectedPackets> {
 public:
  explicit ExpectedPackets(const Widths& widths);
  void set_sequence(std::uint32_t sequence) { sequence_ = sequence; }
  [[nodiscard]] PacketQueue& operator[](Arrow arrow) { return queue_[index(arrow)]; }
  [[nodiscard]] bool empty() const;
  void clear();

  template <Arrow A>
  void take_any(const PacketOf<A>& packet) {
    if constexpr (is_compared(A)) pack_words(packet, widths_, (*this)[A].push(sequence_));
  }

 private:
  const Widths& widths_;
  std::vector<PacketQueue> queue_;
  std::uint32_t sequence_ = 0;  ///< of the current primitive: returned as the tag of its packets
};

/// Collects the cycles of the cycle model into one queue per boundary.
class ExpectedCycles final : public TransferSink {
 public:
  void transfer(Arrow boundary, Cycle cycle) override { queue_[index(boundary)].push_back(cycle); }
  [[nodiscard]] std::deque<Cycle>& operator[](Arrow boundary) { return queue_[index(boundary)]; }

 private:
  std::array<std::deque<Cycle>, kArrows> queue_;
};

/// A design and its model, side by side since reset.
class Lockstep {
 public:
  /// Resets `dut`, which must outlive this.
  Lockstep(Dut& dut, const Config& config, LockstepOptions options);
  ~Lockstep();
  Lockstep(const Lockstep&) = delete;
  Lockstep& operator=(const Lockstep&) = delete;

  /// One scene, to its flush, without a reset before it. Not after a run that has failed or was stopped. Throws
  /// InputError for a scene that the hardware does not support.
  [[nodiscard]] LockstepResult run(const Scene& scene) { return run(scene, config_); }
  /// `host` may differ from the configuration in the host's settings: frame.order and frame.store. If these allow
  /// comparison of bins, bins whose content equals the draws of `scene` are skipped, unless `draws_all`.
  [[nodiscard]] LockstepResult run(const Scene& scene, const Config& host, bool draws_all = false);

  [[nodiscard]] const TileMemory& memory() const { return memory_.tiles(); }  ///< the RTL's
  [[nodiscard]] CounterPacket counters();                                     ///< the RTL's, of all work so far
  [[nodiscard]] const Counters& host_counters() const { return host_counters_; }
  /// Closes the waveform and moves it to its final path. Returns whether there is one.
  bool finish_trace();
  /// Reason of a missing waveform, one line; empty without a failure. The run continues without it.
  [[nodiscard]] const std::string& trace_failure() const { return trace_failure_; }

 private:
  void start_models(TileMemory memory);
  void begin(const Scene& scene);
  void run_and_reset(const Scene& scene, std::uint64_t cycles);
  void offer(HostStream& host);
  void offer_primitive(HostStream& host);
  void step(HostStream& host);
  void compare(Arrow arrow, const void* rtl);
  void compare_cycle(Arrow boundary);
  void report_missing_cycle();
  [[nodiscard]] Mismatch cycle_mismatch(Arrow boundary, std::vector<FieldPair> fields, const std::string& hint) const;
  void count_taken();
  void watch_beat(const DutOutputs& out, std::uint32_t stalls, bool taken);
  void count_use(const DutOutputs& out);
  void trace();
  void begin_trace();
  [[nodiscard]] bool has_finished() const;
  void report_missing();
  void explain_standstill(Mismatch& mismatch);
  [[nodiscard]] std::vector<std::uint32_t> shown_counters();
  void compare_counters();
  void compare_memory();
  Mismatch packet_mismatch(Mismatch::Kind kind, Arrow arrow, const std::uint32_t* model, const std::uint32_t* rtl,
                           std::uint32_t tag) const;
  void fail_protocol(const std::string& stage, const std::string& hint);

  Dut& dut_;
  Config config_;
  Widths widths_;
  LockstepOptions options_;
  std::uint64_t threshold_;  // of the stalls
  std::array<std::size_t, kArrows> bytes_{};
  ExpectedPackets expected_;
  MemoryModel memory_;
  TextureModel textures_;
  std::optional<HardwareModel> model_;
  ExpectedCycles expected_cycles_;
  std::unique_ptr<MemoryTiming> model_memory_;  // memory of the cycle model: only if cycles are compared
  std::unique_ptr<CycleModel> cycle_model_;
  Counters host_counters_;
  BinContents bins_;                     // content of the memories, for the host
  std::vector<std::uint32_t> snapshot_;  // counters of the RTL, held since the last primitive was taken
  std::uint64_t snapshot_at_ = 0;        // the cycle in which they are read
  std::size_t counter_bytes_;            // bytes of the counters' packet

  LockstepResult result_;                 // of the current run
  std::vector<HostPrimitive> sent_;       // of the current run, without their packets: tags index it
  std::vector<std::uint32_t> primitive_;  // words of the primitive on offer
  PacketQueue lines_;                     // lines of the primitives in sent_, not yet taken: a stream of its own
  std::vector<std::uint32_t> held_;       // words of a beat on offer
  bool has_primitive_ = false, has_line_ = false, all_sent_ = false, has_answer_ = false, has_held_ = false;
  bool has_texel_ = false;
  bool is_first_ = true;  // no primitive since reset
  bool has_traced_ = false, was_idle_ = false, drains_ = false;
  std::optional<PartFile> waveform_;  // while recording
  std::string trace_failure_;
  std::uint64_t cycle_ = 0;           // since reset
  std::uint64_t first_taken_ = 0;     // cycle of the first counted primitive
  std::uint64_t tile_cycles_ = 0;     // since then
  std::uint64_t last_drawn_ = ~0ULL;  // input triangle counted last
  std::uint64_t last_moved_ = 0;      // the last cycle in which a packet moved anywhere
};

}  // namespace halfplane
