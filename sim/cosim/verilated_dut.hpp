// A Verilated raster_cosim as a Dut. Included only where the generated classes are (duts.cpp).
#pragma once

#include <verilated.h>
#ifdef HALFPLANE_RTL_COVERAGE
#include <verilated_cov.h>
#endif

#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

#include "rtl_ref/cosim/fst_files.hpp"
#include "rtl_ref/cosim/verilated_messages.hpp"
#include "sim/cosim/dut.hpp"

namespace halfplane {

/// V: the generated class. Trace: its VerilatedFstC, or void for a class without.
template <class V, class Trace = void>
class VerilatedDut final : public Dut {
 public:
  explicit VerilatedDut(std::uint64_t seed = 1) { build(seed, 0); }
  ~VerilatedDut() override {
    VerilatedDut::close_trace();
    enter_context();
    if (top_) top_->final();
    write_coverage();
  }
  VerilatedDut(const VerilatedDut&) = delete;
  VerilatedDut& operator=(const VerilatedDut&) = delete;

  std::uint64_t config_id() override { return top_->config_id_o; }
  void reset(std::uint64_t seed, std::uint16_t mutant) override { build(seed, mutant); }

  void set_primitive(const std::uint32_t* words) override {
    top_->primitive_valid_i = words != nullptr;
    if (words != nullptr) std::memcpy(first_word(top_->primitive_i), words, sizeof top_->primitive_i);
  }
  void set_line(const std::uint32_t* words) override {
    top_->line_valid_i = words != nullptr;
    if (words != nullptr) std::memcpy(first_word(top_->line_i), words, sizeof top_->line_i);
  }
  void set_answer(const std::uint32_t* words) override {
    top_->answer_valid_i = words != nullptr;
    if (words != nullptr) std::memcpy(first_word(top_->answer_i), words, sizeof top_->answer_i);
  }
  void set_texel(const std::uint32_t* words) override {
    top_->texel_valid_i = words != nullptr;
    if (words != nullptr) std::memcpy(first_word(top_->texel_i), words, sizeof top_->texel_i);
  }
  void set_layout(const std::uint32_t* words) override {
    std::memcpy(first_word(top_->layout_i), words, sizeof top_->layout_i);
  }
  void hold_reset(bool holds) override { top_->rst_ni = !holds; }
  void set_counters_hold(bool holds) override { top_->counters_hold_i = holds; }

  /// raster_cosim registers its inputs, so they are taken at the edge that ends the last cycle.
  const DutOutputs& evaluate(std::uint32_t stalls, bool beat_ready, bool texture_ready) override {
    if (top_->clk_i != 0) fall();  // one more, uncounted cycle, as for the counters after the last
    top_->stall_i = static_cast<std::remove_reference_t<decltype(top_->stall_i)>>(stalls);
    top_->beat_ready_i = beat_ready;
    top_->texture_ready_i = texture_ready;
    top_->clk_i = 1;
    enter_context();
    top_->eval();
    dump();
    out_.failure.clear();
    if (context_->gotError()) note_failure();
    out_.fired = top_->fire_o;
    out_.primitive_ready = top_->primitive_ready_o != 0;
    out_.line_ready = top_->line_ready_o != 0;
    out_.beat_valid = top_->beat_valid_o != 0;
    out_.answer_ready = top_->answer_ready_o != 0;
    out_.texture_valid = top_->texture_valid_o != 0;
    out_.texel_ready = top_->texel_ready_o != 0;
    out_.idle = top_->idle_o != 0;
    out_.moves_tiles = top_->moves_tiles_o != 0;
    out_.stream_valid = top_->stream_valid_o;
    out_.stream_ready = top_->stream_ready_o;
    return out_;
  }

  void clock() override { fall(); }

  [[nodiscard]] bool can_trace() const override { return !std::is_void_v<Trace>; }
  [[nodiscard]] int open_trace([[maybe_unused]] const std::string& path) override {
    if constexpr (!std::is_void_v<Trace>) {
      close_trace();
      begin_fst(path.substr(0, path.find_last_of('/') + 1));
      trace_ = std::make_unique<TraceFile>();
      top_->trace(&trace_->fst, 99);
      trace_->fst.open(path.c_str());
      return fst_error();
    }
    return 0;
  }
  int close_trace() override {
    if constexpr (!std::is_void_v<Trace>) {
      if (!trace_) return 0;
      if (trace_->fst.isOpen()) trace_->fst.close();
      trace_.reset();
      return fst_error();
    }
    return 0;
  }

 private:
  struct NoTrace {
    void close() {}
  };
  struct TraceFile {
    std::conditional_t<std::is_void_v<Trace>, NoTrace, Trace> fst;
  };

  void build(std::uint64_t seed, std::uint16_t mutant) {
    close_trace();
    write_coverage();
    enter_context();
    top_.reset();
    (void)take_verilated_text();  // of the previous instance
    context_ = std::make_unique<VerilatedContext>();
#ifdef HALFPLANE_RTL_COVERAGE
    context_->randReset(0);  // otherwise the reset itself would toggle half of the bits
#else
    context_->randReset(2);  // random start values: reveal a register that lacks a reset
#endif
    context_->fatalOnError(false);  // a failed assertion is reported, and does not end the program
    context_->randSeed(static_cast<int>(seed % 0x7fffffff + 1));
    if constexpr (!std::is_void_v<Trace>) context_->traceEverOn(true);
    top_ = std::make_unique<V>(context_.get());
    // The inputs were randomised as well.
    top_->clk_i = 0;
    top_->mutant_i = mutant;
    top_->stall_i = 0;
    top_->beat_ready_i = 0;
    top_->texture_ready_i = 0;
    top_->counters_hold_i = 0;
    std::memset(first_word(top_->primitive_i), 0, sizeof top_->primitive_i);
    std::memset(first_word(top_->line_i), 0, sizeof top_->line_i);
    std::memset(first_word(top_->answer_i), 0, sizeof top_->answer_i);
    std::memset(first_word(top_->texel_i), 0, sizeof top_->texel_i);
    std::memset(first_word(top_->layout_i), 0, sizeof top_->layout_i);
    set_primitive(nullptr);
    set_line(nullptr);
    set_answer(nullptr);
    set_texel(nullptr);
    top_->rst_ni = top_->power_on_ni = 1;
    top_->eval();
    top_->rst_ni = top_->power_on_ni = 0;
    for (int i = 0; i < 4; ++i) {
      (void)evaluate(0, false, false);
      clock();
    }
    top_->rst_ni = top_->power_on_ni = 1;
    top_->eval();
    time_ = 0;  // so that cycle c begins at time 2 c
#define HALFPLANE_CONNECT(name, ...) \
  connect<Arrow::name>([](auto& top) -> decltype(&top.name##_o) { return &top.name##_o; });
    HALFPLANE_ARROWS(HALFPLANE_CONNECT)
#undef HALFPLANE_CONNECT
    out_.counters = &top_->counters_o;
  }

  /// `port`: raster_cosim's output for the packets of arrow A, if the RTL sends them.
  template <Arrow A, class Port>
  void connect([[maybe_unused]] Port port) {
    if constexpr (is_compared(A)) out_.packet[index(A)] = port(*top_);
  }

  /// Verilator keeps one context a thread, which may be another instance's, or that of one which is gone: failed assertions
  /// are noted there, and scopes are given back to it.
  void enter_context() {
    if (context_) Verilated::threadContextp(context_.get());
  }

  void note_failure() {
    out_.failure = assertion_message(take_verilated_text());
    context_->gotError(false);
  }

  void fall() {
    top_->clk_i = 0;
    top_->eval();  // nothing but Verilator's note of the level
    dump();
  }

  /// In a build of the preset `coverage`: writes this instance's coverage to the file named in HALFPLANE_RTL_COVERAGE,
  /// if it is set, with a number appended.
  void write_coverage() const {
#ifdef HALFPLANE_RTL_COVERAGE
    const char* path = std::getenv("HALFPLANE_RTL_COVERAGE");
    if (!top_ || path == nullptr) return;
    static int number = 0;
    context_->coveragep()->write((path + ("." + std::to_string(number++))).c_str());
#endif
  }

  template <class Port>
  static void* first_word(Port& port) {
    return static_cast<void*>(&port);
  }
  void dump() {
    if constexpr (!std::is_void_v<Trace>)
      if (trace_ && trace_->fst.isOpen()) trace_->fst.dump(time_);
    ++time_;
  }

  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<TraceFile> trace_;
  std::unique_ptr<V> top_;
  DutOutputs out_;
  std::uint64_t time_ = 0;  // half cycles
};

}  // namespace halfplane
