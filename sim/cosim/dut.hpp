// The design under test as the harness sees it: packed words in, packed words out, one clock at a time. Verilated designs
// implement it (verilated_dut.hpp), and so do the fakes of the harness' own tests.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/pipeline_graph.hpp"

namespace halfplane {

/// The design's outputs in one cycle, before the clock edge.
struct DutOutputs {
  std::uint32_t fired = 0;  ///< bit i: a packet of arrow kTapped[i] moves now
  bool primitive_ready = false, line_ready = false, beat_valid = false, answer_ready = false, idle = false;
  bool texture_valid = false, texel_ready = false;
  bool moves_tiles = false;                          ///< the framebuffer waits for memory or a clear
  std::uint32_t stream_valid = 0, stream_ready = 0;  ///< bit i: kStreams[i]
  std::array<const void*, kArrows> packet{};         ///< little-endian bytes sent by the RTL, rounded up; by Arrow
  const void* counters = nullptr;                    ///< CounterPacket, likewise
  std::string failure;                               ///< message of an assertion that failed at the edge; empty: none
};

class Dut {
 public:
  virtual ~Dut() = default;
  /// raster_pkg::CONFIG_ID of the Verilated sources.
  [[nodiscard]] virtual std::uint64_t config_id() = 0;
  /// A new instance with registers of random content from `seed`, reset. Nothing is offered to it. `mutant`: the fault in
  /// it, 0 for none.
  virtual void reset(std::uint64_t seed, std::uint16_t mutant) = 0;
  /// Asserts the reset from now on, or releases it: without power_on_ni, so that the memory port recovers.
  virtual void hold_reset(bool holds) = 0;
  /// Sets the addresses of the buffers in memory, from now on.
  virtual void set_layout(const std::uint32_t* words) = 0;
  /// Offers a packet from now on; null withdraws the offer. The words are copied.
  virtual void set_primitive(const std::uint32_t* words) = 0;
  virtual void set_line(const std::uint32_t* words) = 0;
  virtual void set_answer(const std::uint32_t* words) = 0;
  virtual void set_texel(const std::uint32_t* words) = 0;
  /// While held, the design's counter outputs stay constant.
  virtual void set_counters_hold(bool holds) = 0;
  /// Settles this cycle's outputs; they stay valid until clock().
  virtual const DutOutputs& evaluate(std::uint32_t stalls, bool beat_ready, bool texture_ready) = 0;
  virtual void clock() = 0;
  [[nodiscard]] virtual bool can_trace() const { return false; }
  /// Records a waveform until close_trace(), if possible. Each returns 0, or the errno of the first failed write so
  /// far.
  [[nodiscard]] virtual int open_trace(const std::string&) { return 0; }
  virtual int close_trace() { return 0; }
};

/// A design that this program was built with.
struct DutFactory {
  std::string name;  ///< "embedded"
  Config config;
  bool has_mutants = false, has_trace = false;
  std::function<std::unique_ptr<Dut>()> make;
};

/// The Verilated designs in this build; none without Verilator.
[[nodiscard]] const std::vector<DutFactory>& verilated_duts();

/// A seeded fault of the designs that have mutants: rtl_ref/cosim/mutants.cmake.
struct Mutant {
  int id = 0;             ///< raster_cosim's mutant_q
  std::string_view file;  ///< relative to rtl_ref
  std::string_view what;
};

/// All designs; none without Verilator.
[[nodiscard]] std::span<const Mutant> mutants();

/// The design with exactly this configuration, under any preset name. Throws std::runtime_error, one line with the
/// available configurations, when there is none: exit status 3.
[[nodiscard]] const DutFactory& find_dut(const Config& config);

/// Makes the design and checks that it was Verilated from this configuration. Throws std::runtime_error if not.
[[nodiscard]] std::unique_ptr<Dut> make_dut(const DutFactory& factory);

}  // namespace halfplane
