// rtl_ref/primitive_stream_checker.sv, as raster_cosim binds it: each rule of the primitive stream that is broken is named in
// the clock in which it is, and a right stream is not.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "model/packets/packet_words.hpp"
#include "model/packets/state_packets.hpp"
#include "model/stages/memory_port.hpp"
#include "rtl_ref/cosim/verilated_messages.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/cosim/memory_model.hpp"
#include "sim/cosim/session.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane::primitive_stream_test {
namespace {

constexpr int kSide = 8;         // pixels of the target
constexpr int kPatience = 2000;  // cycles in which a primitive is taken, or memory has the picture

class PrimitiveStream : public testing::Test {
 protected:
  PrimitiveStream() { reset(); }

  void reset() {
    dut_->reset(1, 0);
    dut_->set_layout(packed(layout_, widths_).data());
    memory_.emplace(config_, widths_, MemorySettings{}, layout_);
    cycle_ = 0;
    (void)step();
  }

  [[nodiscard]] PrimitivePacket packet(PrimitiveKind kind) const {
    PrimitivePacket p;
    p.kind = kind;
    p.box = {0, 0, kSide - 1, kSide - 1};
    p.state.depth_test = DepthFunc::always;
    p.vertex.x = {0, 0, kSide << widths_.grid_bits};
    p.vertex.y = {0, kSide << widths_.grid_bits, 0};
    return p;
  }
  [[nodiscard]] PrimitivePacket clear() const {
    PrimitivePacket p = packet(PrimitiveKind::fast_clear);
    p.state.depth_write = p.state.color_write = true;
    return p;
  }
  [[nodiscard]] PrimitivePacket triangle() const {
    PrimitivePacket p = packet(PrimitiveKind::triangle);
    p.state.color_write = true;
    return p;
  }
  [[nodiscard]] PrimitivePacket flush() const { return packet(PrimitiveKind::flush); }

  /// A clock, with a memory that answers. The message of a failed assertion in it; empty: none.
  std::string step() {
    const std::uint32_t* due = has_answer_ ? nullptr : memory_->due(cycle_);
    if (!has_answer_) dut_->set_answer(due);
    has_answer_ = has_answer_ || due != nullptr;
    const DutOutputs& out = dut_->evaluate(0, true, true);
    if (out.beat_valid) {
      std::vector<std::uint32_t> words(words_of(packet_bits<MemoryBeat>(widths_)));
      std::memcpy(words.data(), out.packet[index(Arrow::beat)],
                  static_cast<std::size_t>(packet_bits<MemoryBeat>(widths_) + 7) / 8);
      memory_->accept(words.data(), cycle_);
    }
    if (has_answer_ && out.answer_ready) {
      memory_->pop();
      has_answer_ = false;
    }
    is_taken_ = out.primitive_ready;
    is_idle_ = out.idle;
    std::string failure = out.failure;
    dut_->clock();
    ++cycle_;
    return failure;
  }

  /// Offers the packet until it is accepted. The message of the clock after that.
  std::string send(const PrimitivePacket& p) {
    dut_->set_primitive(packed(p, widths_).data());
    std::string failure;
    for (int n = 0; n < kPatience && failure.empty(); ++n) {
      failure = step();
      if (is_taken_) break;
    }
    dut_->set_primitive(nullptr);
    const std::string later = step();
    return failure.empty() ? later : failure;
  }

  std::string wait_for_idle() {
    std::string failure;
    for (int n = 0; n < kPatience && failure.empty(); ++n) {
      failure = step();
      if (is_idle_) break;
    }
    return failure;
  }

  /// After a correct beginning: the message for one more packet.
  std::string said_of(const PrimitivePacket& p) {
    reset();
    EXPECT_EQ(send(clear()), "");
    EXPECT_EQ(send(triangle()), "");
    return send(p);
  }

  Config config_ = preset("tiny");
  Widths widths_ = derive_widths(config_);
  std::unique_ptr<Dut> dut_ = make_dut(find_dut(config_));
  MemoryLayout layout_ = default_layout(widths_);
  std::optional<MemoryModel> memory_;
  std::uint64_t cycle_ = 0;
  bool has_answer_ = false, is_taken_ = false, is_idle_ = false;
};

void expect_said(const std::string& said, const char* part) {
  EXPECT_NE(said.find(part), std::string::npos) << "'" << said << "'";
}

TEST_F(PrimitiveStream, ARightOneIsNotSpokenOf) {
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(send(clear()), "");
    EXPECT_EQ(send(triangle()), "");
    PrimitivePacket depth = clear();  // a clear of depth alone, in the middle of the frame
    depth.state.color_write = false;
    EXPECT_EQ(send(depth), "");
    EXPECT_EQ(send(triangle()), "");
    EXPECT_EQ(send(flush()), "");
    EXPECT_EQ(wait_for_idle(), "");
    layout_.color_base ^= 1U << 16;  // another buffer for the next one
    dut_->set_layout(packed(layout_, widths_).data());
  }
  dut_.reset();
  EXPECT_EQ(take_verilated_text(), "");
}

TEST_F(PrimitiveStream, WhatIsDrawnBeforeTheFirstClearIsNamed) {
  expect_said(send(triangle()), "primitive 0 is drawn before the first clear");
  reset();
  PrimitivePacket depth = clear();
  depth.state.color_write = false;
  expect_said(send(depth), "primitive 0 is drawn before the first clear");
}

TEST_F(PrimitiveStream, BoxesThatHoldNoPixelOrLeaveTheTargetAreNamed) {
  const std::pair<PixelBox, const char*> boxes[]{
      {{5, 0, 4, 7}, "primitive 2 has an inverted box, x 5 to 4, y 0 to 7"},
      {{0, 7, 7, 6}, "primitive 2 has an inverted box, x 0 to 7, y 7 to 6"},
      {{0, 0, 8, 7}, "primitive 2 has a box outside the target, to pixel 8, 7 of 7, 7"},
      {{0, 0, 7, 15}, "primitive 2 has a box outside the target, to pixel 7, 15 of 7, 7"}};
  for (const auto& [box, part] : boxes)
    for (const PrimitiveKind kind : {PrimitiveKind::triangle, PrimitiveKind::rectangle, PrimitiveKind::point}) {
      PrimitivePacket p = packet(kind);
      p.box = box;
      expect_said(said_of(p), part);
    }
  PrimitivePacket p = triangle();
  p.box = {3, 4, 3, 4};
  EXPECT_EQ(said_of(p), "") << "one pixel";
}

TEST_F(PrimitiveStream, ClearsAndFlushesOfAPartOfTheTargetAreNamed) {
  PrimitivePacket p = flush();
  p.box.right = 3;
  expect_said(said_of(p), "primitive 2, a fast clear or flush, has a part of the target");
  p = clear();
  p.state.color_write = false;
  p.box.left = 1;
  expect_said(said_of(p), "primitive 2, a fast clear or flush, has a part of the target");
  p = clear();
  p.box.right = kSide;
  expect_said(said_of(p), "changes the target's size after 2 primitives without a flush");
  p = clear();
  p.box.top = 1;
  expect_said(said_of(p), "give the whole target");
}

TEST_F(PrimitiveStream, KindsAndDepthTestsThatThisHardwareLacksAreNamed) {
  PrimitivePacket p = packet(static_cast<PrimitiveKind>(5));
  expect_said(said_of(p), "primitive 2 is of kind 5");
  p = flush();
  p.state.depth_test = DepthFunc::less;
  expect_said(said_of(p), "has the depth test 1; give always");
  p = packet(PrimitiveKind::state);
  p.state = sets_register(StateRegister::texture);
  expect_said(said_of(p), "primitive 2 sets state register 0, of a unit");
}

TEST_F(PrimitiveStream, AnOfferThatIsTakenBackOrChangedIsNamed) {
  for (const bool changes : {false, true}) {
    reset();
    EXPECT_EQ(send(clear()), "");
    dut_->set_primitive(packed(triangle(), widths_).data());
    for (int n = 0; n < kPatience && (step(), is_taken_); ++n) {
    }
    ASSERT_FALSE(is_taken_) << "it is on offer and not taken";
    PrimitivePacket other = triangle();
    other.primitive_id = 1;
    dut_->set_primitive(changes ? packed(other, widths_).data() : nullptr);
    expect_said(step() + step(), "was taken back or changed before it was taken; hold valid and packet until ready");
  }
}

TEST_F(PrimitiveStream, APictureThatIsNotFlushedIsNamedWhereItWouldBeLost) {
  EXPECT_EQ(said_of(triangle()), "");
  (void)wait_for_idle();
  EXPECT_TRUE(is_idle_) << "though the triangles are on the chip alone";
  layout_.color_base ^= 1U << 16;
  dut_->set_layout(packed(layout_, widths_).data());
  expect_said(step() + step(), "layout_i changes before memory has the picture, 3 primitives after the last flush");
  dut_.reset();  // the end of the simulation
  expect_said(take_verilated_text(), "the stream ends with 3 primitives after the last flush");
}

TEST_F(PrimitiveStream, LinesAndTheirPlacesAreCountedAndCompared) {
  PrimitivePacket place = packet(PrimitiveKind::line);
  place.box = {0, 0, 0, 0};
  place.primitive_id = 3;
  EXPECT_EQ(said_of(place), "");
  LineSetup line;
  line.primitive_id = 4;
  dut_->set_line(packed(line, widths_).data());
  expect_said(step() + step() + step(), "a line and its place have the primitive_id 3 and 4");
  dut_->set_line(nullptr);
  EXPECT_EQ(said_of(place), "");
  dut_.reset();
  expect_said(take_verilated_text(), "the stream ends with 1 places of lines and 0 lines");
}

TEST_F(PrimitiveStream, AFailedAssertionEndsACoSimulationWithItsMessage) {
  /// Turns the box of the packet that is offered.
  class Inverted final : public Dut {
   public:
    Inverted(std::unique_ptr<Dut> dut, const Widths& widths) : dut_(std::move(dut)), widths_(widths) {}
    std::uint64_t config_id() override { return dut_->config_id(); }
    void reset(std::uint64_t seed, std::uint16_t mutant) override { dut_->reset(seed, mutant); }
    void hold_reset(bool holds) override { dut_->hold_reset(holds); }
    void set_layout(const std::uint32_t* words) override { dut_->set_layout(words); }
    void set_primitive(const std::uint32_t* words) override {
      if (words == nullptr) return dut_->set_primitive(words);
      auto p = unpack_words<PrimitivePacket>(words, widths_);
      if (p.kind == PrimitiveKind::triangle) std::swap(p.box.left, p.box.right);
      dut_->set_primitive(packed(p, widths_).data());
    }
    void set_line(const std::uint32_t* words) override { dut_->set_line(words); }
    void set_answer(const std::uint32_t* words) override { dut_->set_answer(words); }
    void set_texel(const std::uint32_t* words) override { dut_->set_texel(words); }
    void set_counters_hold(bool holds) override { dut_->set_counters_hold(holds); }
    const DutOutputs& evaluate(std::uint32_t stalls, bool beat_ready, bool texture_ready) override {
      return dut_->evaluate(stalls, beat_ready, texture_ready);
    }
    void clock() override { dut_->clock(); }

   private:
    std::unique_ptr<Dut> dut_;
    Widths widths_;
  };
  Inverted inverted(std::move(dut_), widths_);
  const Session session = run_session(inverted, config_, {}, single_scene(make_builtin("triangle", 16, 16, {}, 1)));
  ASSERT_TRUE(session.result.mismatch);
  EXPECT_EQ(session.result.mismatch->kind, Mismatch::Kind::protocol);
  expect_said(session.result.mismatch->hint, "has an inverted box");
}

}  // namespace
}  // namespace halfplane::primitive_stream_test
