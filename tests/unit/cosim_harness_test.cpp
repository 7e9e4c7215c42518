// The co-simulation harness itself, on designs that replay the model's packets and are then tampered with: equal
// designs must pass, and every single fault must be named.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>

#include "model/capture/capture.hpp"
#include "model/host/primitive_assembly.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/report.hpp"
#include "sim/cosim/session.hpp"
#include "sim/interrupt.hpp"
#include "sim/scene/random.hpp"
#include "tests/scene_builder.hpp"

namespace halfplane::cosim_harness_test {
namespace {

/// A faulty design's treatment of packet `number` of `arrow`.
struct Fault {
  enum class Kind { none, flip, lose, repeat, stop, counter, release, withdraw, busy } kind = Kind::none;
  Arrow arrow = Arrow::stamp;
  std::uint64_t number = 0;
  int bit = 0;
};

/// Takes a primitive when it has sent all packets of the previous one; every arrow moves a packet in every cycle in which it
/// is not stalled.
class FakeDut final : public Dut {
 public:
  FakeDut(const Config& config, const Fault& fault)
      : config_(config), widths_(derive_widths(config)), fault_(fault), planned_(fault) {
    FakeDut::reset(0, 0);
  }
  std::uint64_t config_id() override { return 0; }
  void reset(std::uint64_t, std::uint16_t) override {
    expected_ = std::make_unique<ExpectedPackets>(widths_);
    model_ = std::make_unique<HardwareModel>(config_, *expected_);
    sent_ = {};
    fault_ = planned_;
    withdrawn_ = is_answered_ = false;
    unanswered_ = 0;
    offered_.clear();
    line_.reset();
    lines_.clear();
  }
  void set_line(const std::uint32_t* words) override {
    line_.reset();
    if (words != nullptr) line_ = unpack_words<LineSetup>(words, widths_);
  }
  void set_primitive(const std::uint32_t* words) override {
    offered_.clear();
    if (words != nullptr) offered_.assign(words, words + words_of(packet_bits<PrimitivePacket>(widths_)));
  }
  void set_texel(const std::uint32_t*) override {}
  void set_answer(const std::uint32_t* words) override { is_answered_ = words != nullptr; }
  void set_layout(const std::uint32_t*) override {}
  void hold_reset(bool) override {}
  void set_counters_hold(bool holds) override { holds_counters_ = holds; }

  const DutOutputs& evaluate(std::uint32_t stalls, bool beat_ready, bool texture_ready) override;
  void clock() override;

 private:
  [[nodiscard]] bool hits(Arrow arrow, Fault::Kind kind) const {
    return fault_.kind == kind && fault_.arrow == arrow && sent_[static_cast<std::size_t>(arrow)] == fault_.number;
  }
  [[nodiscard]] const std::uint32_t* content(Arrow arrow);

  Config config_;
  Widths widths_;
  Fault fault_, planned_;
  std::unique_ptr<ExpectedPackets> expected_;
  std::unique_ptr<HardwareModel> model_;
  std::array<std::uint64_t, kArrows> sent_{};
  std::vector<std::uint32_t> offered_;
  std::optional<LineSetup> line_;  // on offer
  std::deque<LineSetup> lines_;    // taken; at the latest with the primitive that holds the line's place
  std::array<std::vector<std::uint32_t>, kArrows> words_;
  std::vector<std::uint32_t> counters_;
  DutOutputs out_;
  bool takes_beat_ = false, is_answered_ = false, withdrawn_ = false, holds_counters_ = false;
  int unanswered_ = 0;  // beats that were read, bursts that were written
};

const std::uint32_t* FakeDut::content(Arrow arrow) {
  PacketQueue& queue = (*expected_)[arrow];
  if (hits(arrow, Fault::Kind::lose)) {
    queue.pop();
    fault_.kind = Fault::Kind::none;
  }
  if (queue.empty()) return nullptr;
  auto& words = words_[static_cast<std::size_t>(arrow)];
  words.assign(queue.front(), queue.front() + queue.words());
  if (hits(arrow, Fault::Kind::flip)) words[static_cast<std::size_t>(fault_.bit / 32)] ^= 1U << (fault_.bit % 32);
  return words.data();
}

const DutOutputs& FakeDut::evaluate(std::uint32_t stalls, bool beat_ready, bool /*texture_ready*/) {
  out_ = {};
  for (const Arrow arrow : kCompared) {
    const Arrow leader = info(arrow).flow.rides_with.value_or(arrow);
    const unsigned stalled_by = stall_bit(is_elastic(leader) ? leader : Arrow::fragment);
    if ((stalls & stalled_by) != 0 || hits(arrow, Fault::Kind::stop)) continue;
    const void*& packet = out_.packet[index(arrow)];
    packet = content(arrow);
    if (packet == nullptr) continue;
    if (arrow == Arrow::beat)
      out_.beat_valid = true;
    else
      out_.fired |= tap_bit(arrow);
  }
  if (fault_.kind == Fault::Kind::withdraw && out_.beat_valid && !beat_ready) {
    fault_.kind = Fault::Kind::none;
    withdrawn_ = true;
  } else if (withdrawn_ && out_.beat_valid) {
    withdrawn_ = out_.beat_valid = false;
  }
  takes_beat_ = out_.beat_valid && beat_ready;
  out_.answer_ready = out_.line_ready = true;
  out_.primitive_ready = expected_->empty() && (stalls & 1) == 0;
  out_.idle = expected_->empty() && offered_.empty() && unanswered_ == 0 && fault_.kind != Fault::Kind::busy;
  if (!holds_counters_) counters_ = packed(model_->counters(), widths_);
  if (fault_.kind == (holds_counters_ ? Fault::Kind::release : Fault::Kind::counter)) {
    auto wrong = unpack_words<CounterPacket>(counters_.data(), widths_);
    ++wrong.tile_fills;
    counters_ = packed(wrong, widths_);
  }
  out_.counters = counters_.data();
  return out_;
}

void FakeDut::clock() {
  if (takes_beat_) {
    const auto beat = unpack_words<MemoryBeat>(words_[index(Arrow::beat)].data(), widths_);
    unanswered_ += beat.is_write ? (beat.length == 1 ? 1 : 0) : beat.length;
  }
  unanswered_ -= is_answered_ ? 1 : 0;
  for (const Arrow arrow : kCompared) {
    const bool moves = arrow == Arrow::beat ? takes_beat_ : (out_.fired & tap_bit(arrow)) != 0;
    if (!moves) continue;
    if (hits(arrow, Fault::Kind::repeat)) {
      fault_.kind = Fault::Kind::none;
      continue;
    }
    (*expected_)[arrow].pop();
    ++sent_[index(arrow)];
  }
  if (line_) lines_.push_back(*std::exchange(line_, std::nullopt));
  if (out_.primitive_ready && !offered_.empty()) {
    const auto primitive = unpack_words<PrimitivePacket>(offered_.data(), widths_);
    std::optional<LineSetup> line;
    if (primitive.kind == PrimitiveKind::line) {
      line = lines_.front();
      lines_.pop_front();
    }
    model_->run(primitive, line);
    offered_.clear();
  }
}

LockstepOptions with_stalls(double probability, std::uint64_t seed = 3) {
  LockstepOptions options;
  options.stall_probability = probability;
  options.seed = seed;
  return options;
}

/// One scene, so that packets are numbered from its beginning.
LockstepResult run(const Config& config, const Fault& fault, const LockstepOptions& options, std::size_t count = 150) {
  FakeDut dut(config, fault);
  return run_session(dut, config, options, single_scene(random_scene(config, 16, count))).result;
}

class CosimHarness : public ::testing::TestWithParam<const char*> {
 protected:
  Config config = preset(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Presets, CosimHarness, ::testing::Values("tiny", "embedded", "full"));

TEST_P(CosimHarness, AnEqualDesignPassesWithAndWithoutStallsAndEveryArrowIsCompared) {
  for (const double stalls : {0.0, 0.3, 0.8}) {
    FakeDut dut(config, {});
    const Session session = run_session(dut, config, with_stalls(stalls), random_scenes(config, 16, 150));
    const LockstepResult& result = session.result;
    EXPECT_EQ(session.scenes, 2u);
    EXPECT_FALSE(result.mismatch.has_value()) << mismatch_report(*result.mismatch);
    for (const Arrow arrow : kCompared)
      EXPECT_EQ(result.compared[index(arrow)] > 0, !is_of_texture_unit(arrow)) << info(arrow).name;
    EXPECT_GT(result.memory_compared, 0u);
    EXPECT_GT(result.counters_compared, 0u);
    EXPECT_GE(result.triangles, 100u);
  }
}

TEST(CosimSession, ASceneAloneTakesTheOrderThatItTakesInTheRun) {
  const Config config = preset("embedded");
  const RandomProfile profile = read_random_profile("triangles,16x16,size=1..9", config);
  int bins = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto run_from = [&](std::uint64_t first) {
      FakeDut dut(config, {});
      return run_session(dut, config, with_stalls(0, seed), random_scenes(config, seed, 180, profile, {first}),
                         HostOrders::drawn, false, first);
    };
    const Session whole = run_from(1), alone = run_from(3);
    EXPECT_EQ(whole.scene, 3u);
    EXPECT_EQ(alone.scene, 3u);
    EXPECT_LT(alone.result.triangles, whole.result.triangles);
    EXPECT_EQ(alone.config, whole.config) << seed;
    bins += whole.config.frame_order == FrameOrder::bins ? 1 : 0;
  }
  EXPECT_GT(bins, 0);
  EXPECT_LT(bins, 8);
}

TEST_P(CosimHarness, OneFlippedBitOnAnyArrowIsNamedWithItsField) {
  const Widths widths = derive_widths(config);
  for (const Arrow arrow : kCompared) {
    if (is_of_texture_unit(arrow)) continue;
    const int size =
        with_packet_type(arrow, [&]<class Packet>(std::type_identity<Packet>) { return packet_bits<Packet>(widths); });
    for (const int bit : {0, size / 3, size - 1}) {
      const LockstepResult result = run(config, {Fault::Kind::flip, arrow, 20, bit}, with_stalls(0.2));
      ASSERT_TRUE(result.mismatch.has_value()) << info(arrow).name << " bit " << bit;
      EXPECT_EQ(result.mismatch->arrow, info(arrow).name);
      EXPECT_EQ(result.mismatch->number, 20u);
      EXPECT_EQ(result.mismatch->differing().size(), 1u);
      EXPECT_GT(result.mismatch->cycle, 0u);
    }
  }
}

TEST_P(CosimHarness, ALostARepeatedAndANeverSentPacketAreNamedOnEveryArrow) {
  for (const Arrow arrow : kCompared) {
    if (is_of_texture_unit(arrow)) continue;
    for (const auto kind : {Fault::Kind::lose, Fault::Kind::repeat, Fault::Kind::stop}) {
      const LockstepResult result = run(config, {kind, arrow, 20, 0}, with_stalls(0));
      ASSERT_TRUE(result.mismatch.has_value()) << info(arrow).name << " fault " << static_cast<int>(kind);
      EXPECT_EQ(result.mismatch->arrow, info(arrow).name);
    }
  }
}

TEST_P(CosimHarness, AWrongContextIsBlamedOnCoarseRasterWhichMakesIt) {
  const LockstepResult result = run(config, {Fault::Kind::flip, Arrow::context, 20, 0}, with_stalls(0.2));
  ASSERT_TRUE(result.mismatch.has_value());
  EXPECT_EQ(result.mismatch->stage, "coarse_raster");
}

TEST_P(CosimHarness, AWrongCounterIsNamed) {
  const LockstepResult result = run(config, {Fault::Kind::counter, {}, 0, 0}, {});
  ASSERT_TRUE(result.mismatch.has_value());
  EXPECT_EQ(result.mismatch->arrow, "counters");
  EXPECT_EQ(result.mismatch->differing(), std::vector<std::string>{"tile_fills"});
  EXPECT_EQ(result.mismatch->stage, "framebuffer");
}

TEST(CosimCounters, EachIsOfAStageButTheOneThatTellsOfAnOverflow) {
  for_each_field<CounterPacket>([](const auto& field) {
    EXPECT_EQ(stage_of_counter(field.name).has_value(), field.name != "overflow") << field.name;
  });
  EXPECT_EQ(stage_of_counter("alpha_killed"), Stage::depth_test);
  EXPECT_EQ(stage_of_counter("texture_hits"), Stage::texture_unit);
}

TEST_P(CosimHarness, CountersThatMoveWhileTheyAreHeldBreakTheProtocol) {
  const LockstepResult result = run(config, {Fault::Kind::release, {}, 0, 0}, {});
  ASSERT_TRUE(result.mismatch.has_value());
  EXPECT_EQ(result.mismatch->hint, "held counters count");
}

TEST(CosimCounters, AreNotComparedWhereThereAreNone) {
  const Config config = preset("small");
  ASSERT_EQ(config.counter_units, 0);
  const LockstepResult result = run(config, {Fault::Kind::counter, {}, 0, 0}, {});
  EXPECT_FALSE(result.mismatch.has_value());
  EXPECT_EQ(result.counters_compared, 0u);
}

TEST_P(CosimHarness, ARequestThatIsTakenBackBreaksTheProtocol) {
  const LockstepResult result = run(config, {Fault::Kind::withdraw, {}, 0, 0}, with_stalls(0.5));
  ASSERT_TRUE(result.mismatch.has_value());
  EXPECT_EQ(result.mismatch->kind, Mismatch::Kind::protocol);
}

TEST_P(CosimHarness, ADesignThatNeverRestsBreaksTheProtocol) {
  const LockstepResult result = run(config, {Fault::Kind::busy, {}, 0, 0}, {}, 10);
  ASSERT_TRUE(result.mismatch.has_value());
  EXPECT_NE(mismatch_line(*result.mismatch).find("idle_o"), std::string::npos);
}

TEST_P(CosimHarness, ARunThatIsStoppedIsNeitherEqualNorDifferent) {
  LockstepOptions options;
  options.progress = [](double) { return false; };
  const LockstepResult result = run(config, {Fault::Kind::stop, Arrow::tile, 30, 0}, options);
  EXPECT_TRUE(result.is_stopped);
  EXPECT_FALSE(result.mismatch.has_value());
}

TEST(CosimReport, ModelStandsAboveRtlAndDifferingBitsAreMarked) {
  const Config config = preset("embedded");
  const LockstepResult result = run(config, {Fault::Kind::flip, Arrow::tile, 20, 0}, {});
  ASSERT_TRUE(result.mismatch.has_value());
  const std::string text = mismatch_report(*result.mismatch);
  const auto model = text.find("model  "), rtl = text.find("rtl    "), mark = text.find('^');
  ASSERT_NE(mark, std::string::npos) << text;
  EXPECT_LT(model, rtl);
  EXPECT_LT(rtl, mark);
  EXPECT_NE(text.find("coarse_raster"), std::string::npos);
  EXPECT_NE(text.find("anchor[red]"), std::string::npos) << text;
  EXPECT_NE(text.find("cycle"), std::string::npos);
  for (std::size_t start = 0; start < text.size(); start = text.find('\n', start) + 1)
    EXPECT_LE(text.find('\n', start) - start, 120u);
}

TEST(CosimReport, JunitHasACaseForEveryArrowAndEscapesWhatXmlReserves) {
  const Config config = preset("tiny");
  const auto cases = junit_cases(run(config, {}, {}));
  EXPECT_EQ(cases.size(), kCompared.size() + 2);
  EXPECT_EQ(junit_xml("cosim", cases, 1).find("<failure"), std::string::npos);
  const auto failed = junit_cases(run(config, {Fault::Kind::lose, Arrow::stamp, 20, 0}, {}));
  EXPECT_NE(junit_xml("cosim", failed, 1).find("failures=\"1\""), std::string::npos);
  EXPECT_NE(junit_xml("a<&\"b", {}, 1).find("a&lt;&amp;&quot;b"), std::string::npos);
  EXPECT_EQ(junit_cases({}).back().failure, "nothing was compared");
}

TEST(CosimReport, JunitFailsWithTheFindingAndNotWithTheFirstSymptom) {
  const Config config = preset("tiny");
  const LockstepResult result = run(config, {Fault::Kind::lose, Arrow::stamp, 20, 0}, {});
  ASSERT_TRUE(result.mismatch.has_value());
  Mismatch reduced = *result.mismatch;
  reduced.arrow = "memory";
  reduced.number = 0;
  const JunitFinding finding{reduced, "saved in out/Zähne.hpt"};
  int failures = 0;
  for (const JunitCase& c : junit_cases(result, &finding)) {
    EXPECT_EQ(c.failure.empty(), c.name != "memory") << c.name;
    failures += c.failure.empty() ? 0 : 1;
    if (!c.failure.empty()) {
      EXPECT_EQ(c.failure, mismatch_line(reduced));
      EXPECT_EQ(c.details, finding.report);
    }
  }
  EXPECT_EQ(failures, 1);
  reduced.arrow = "somewhere";  // is no test case of its own: none may pass because of it
  EXPECT_EQ(junit_cases(result, &finding).back().failure, mismatch_line(reduced));
  EXPECT_NE(junit_xml("cosim", junit_cases(result, &finding), 1).find("out/Zähne.hpt"), std::string::npos);
  EXPECT_NE(junit_xml("a\xc3", {}, 1).find("\"a?\""), std::string::npos) << "half a character";
}

TEST(CosimStalls, AreTheirProbabilityAndNoneAtZero) {
  for (const double probability : {0.0, 0.1, 0.5, 0.9}) {
    std::array<int, kStallStreams> stalled{};
    int together = 0;
    constexpr int kCycles = 20000;
    for (std::uint64_t cycle = 0; cycle < kCycles; ++cycle) {
      for (int stream = 0; stream < kStallStreams; ++stream)
        stalled[static_cast<std::size_t>(stream)] += is_stalled(9, stream, cycle, stall_threshold(probability)) ? 1 : 0;
      const auto bits = stall_bits(9, cycle, stall_threshold(probability));
      together += (bits & 3) == 3 ? 1 : 0;
    }
    for (const int n : stalled) EXPECT_NEAR(n, probability * kCycles, 400);
    EXPECT_NEAR(together, probability * probability * kCycles, 400);
  }
}

TEST(CosimWords, UnpackedAndPackedAgainAreTheSameWords) {
  for (const auto preset_name : preset_names()) {
    const Config config = preset(preset_name);
    const Widths widths = derive_widths(config);
    Random random(1);
    for (std::size_t i = 0; i < kArrows; ++i)
      with_packet_type(static_cast<Arrow>(i), [&]<class Packet>(std::type_identity<Packet>) {
        const int bits = packet_bits<Packet>(widths);
        std::vector<std::uint32_t> words(words_of(bits));
        for (auto& word : words) word = static_cast<std::uint32_t>(random.next());
        if (bits % 32 != 0) words.back() &= ~0U >> (32 - bits % 32);
        EXPECT_EQ(packed(unpack_words<Packet>(words.data(), widths), widths), words) << Packet::name;
      });
  }
}

TEST(CosimWords, TheFirstFieldIsHighestAndElementsOfAnArrayAreLowestFirst) {
  const Widths widths = derive_widths(preset("tiny"));
  RetirePacket retired;
  retired.key = {0xabcd, 1, 0};
  retired.update = HizUpdate::clear;
  retired.hiz_code = 0x5a;
  // 16 bits of the primitive, 1 of each coordinate of a tile, 2 of the update, 8 of the bound.
  EXPECT_EQ(packed(retired, widths),
            (std::vector<std::uint32_t>{0xabcdU << 12 | 1U << 11 | 0U << 10 | 2U << 8 | 0x5aU}));
  EdgeContext edges;
  edges.step_x = {-1, 2, -3};
  edges.step_y = {4, -5, 6};
  std::array<std::uint64_t, 6> expected{4, static_cast<std::uint64_t>(-5), 6, static_cast<std::uint64_t>(-1),
                                        2, static_cast<std::uint64_t>(-3)};  // from the lowest up
  const auto words = packed(edges, widths);
  WordReader reader(words.data());
  for (const std::uint64_t value : expected)
    EXPECT_EQ(reader.take(widths.edge_step.bits), wrap_unsigned(value, widths.edge_step.bits));
}

TEST(CosimWords, AQueueGivesBackInOrderWhileItGrows) {
  PacketQueue queue(2);
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    queue.push(i)[1] = 7 * i;
    if (i % 3 == 2) {
      EXPECT_EQ(queue.front_tag(), next);
      EXPECT_EQ(queue.front()[1], 7 * next);
      queue.pop();
      ++next;
    }
  }
  for (; !queue.empty(); queue.pop()) EXPECT_EQ(queue.front_tag(), next++);
  EXPECT_EQ(next, 1000u);
}

TEST(CosimRandomScene, IsTheSameForTheSameSeedAndRichInStates) {
  for (const auto name : preset_names()) {
    const Config config = preset(name);
    const Scene a = random_scene(config, 7, 2000), b = random_scene(config, 7, 2000);
    EXPECT_TRUE(same_scene(a, b));
    EXPECT_FALSE(same_scene(a, random_scene(config, 8, 2000)));
    std::array<std::size_t, 3> primitives{};
    for (const Command& command : a.commands)
      if (const auto* draw = std::get_if<Draw>(&command))
        primitives[static_cast<std::size_t>(primitive_type(draw->topology))] +=
            draw->count / (draw->topology == Topology::triangles ? 3
                           : draw->topology == Topology::lines   ? 2
                                                                 : 1);
    EXPECT_EQ(primitives[0] + primitives[1] + primitives[2], 2000u);
    EXPECT_EQ(primitives[static_cast<std::size_t>(PrimitiveType::line)] > 50, config.line_units != 0) << name;
    EXPECT_GT(primitives[static_cast<std::size_t>(PrimitiveType::point)], 50u) << name;
    std::array<int, 8> functions{};
    for (const State& state : a.states) ++functions[static_cast<std::size_t>(state.depth_test)];
    for (const int n : functions) EXPECT_GT(n, 0) << name;
    HostStream host(a, config);
    CounterPacket counters;
    const Widths widths = derive_widths(config);
    while (const auto primitive = host.next()) (void)cull(primitive->packet, widths, counters);
    EXPECT_GT(counters.zero_area, 10u) << name;
    EXPECT_GT(counters.backface, 100u) << name;
    EXPECT_GT(counters.empty, 10u) << name;
  }
}

TEST(CosimReduce, FindsTheTwoTrianglesThatAreToBlame) {
  const Config config = preset("embedded");
  const Scene scene = random_scene(config, 11, 400);
  // "Fails" while two certain vertices are there: independent of any hardware.
  const auto has = [](const Scene& s, double x) {
    return std::any_of(s.vertices.begin(), s.vertices.end(), [x](const Vertex& v) { return v.x == x; });
  };
  const double first = scene.vertices[300].x, second = scene.vertices[900].x;
  std::size_t runs = 0;
  const FailTest test = [&](const Scene& s, const LockstepOptions&) -> std::optional<Mismatch> {
    ++runs;
    if (!has(s, first) || !has(s, second)) return {};
    return Mismatch{};
  };
  const auto reduced = reduce(scene, config, with_stalls(0.5), test);
  ASSERT_TRUE(reduced.has_value());
  EXPECT_TRUE(reduced->is_minimal);
  EXPECT_LE(reduced->primitives_after, 2u);
  EXPECT_EQ(reduced->primitives_before, 400u);
  EXPECT_EQ(reduced->lockstep.stall_probability, 0);
  EXPECT_EQ(reduced->scene.width, 1);
  EXPECT_EQ(reduced->runs, runs);
  EXPECT_TRUE(has(reduced->scene, first) && has(reduced->scene, second));
  for (const Vertex& v : reduced->scene.vertices) EXPECT_EQ(v.rgba, (std::array<double, 4>{255, 255, 255, 255}));
}

TEST(CosimReduce, ASceneThatDoesNotFailIsNotReduced) {
  const Config config = preset("tiny");
  FakeDut dut(config, {});
  EXPECT_FALSE(reduce(random_scene(config, 1, 20), config, {}, lockstep_test(dut, config)).has_value());
}

TEST(CosimReduce, KeepsWhatItHasWhenItIsInterrupted) {
  const Config config = preset("tiny");
  const FailTest always = [](const Scene&, const LockstepOptions&) { return std::optional(Mismatch{}); };
  ReduceOptions options;
  options.progress = [left = 3](double) mutable {
    if (left-- == 0) throw Interrupted{};
  };
  const auto reduced = reduce(random_scene(config, 1, 400), config, {}, always, options);
  ASSERT_TRUE(reduced.has_value());
  EXPECT_FALSE(reduced->is_minimal);
  EXPECT_FALSE(reduced->scene.commands.empty());
  options.progress = [](double) { throw Interrupted{}; };
  EXPECT_THROW((void)reduce(random_scene(config, 1, 400), config, {}, always, options), Interrupted);
}

TEST(CosimReduce, AFaultInTheDesignLeavesOneTriangle) {
  const Config config = preset("tiny");
  FakeDut dut(config, {Fault::Kind::flip, Arrow::fragment, 3, 5});
  const Scene scene = random_scene(config, 4, 200);
  const LockstepOptions options = with_stalls(0.3);
  const auto mismatch = lockstep_test(dut, config)(scene, options);
  ASSERT_TRUE(mismatch.has_value());
  const Finding finding = investigate(dut, config, options, scene, *mismatch, "", {});
  ASSERT_TRUE(finding.reduced.has_value());
  EXPECT_LE(finding.reduced->primitives_after, 4u);
  EXPECT_TRUE(lockstep_test(dut, config)(finding.scene, finding.lockstep).has_value()) << "it must still fail";
}

TEST(CosimReduce, AFaultInALineLeavesALine) {
  const Config config = preset("tiny");
  FakeDut dut(config, {Fault::Kind::flip, Arrow::line_pixel, 1, 2});
  const auto reduced = reduce(random_scene(config, 16, 150), config, {}, lockstep_test(dut, config));
  ASSERT_TRUE(reduced.has_value());
  EXPECT_LE(reduced->primitives_after, 2u);  // its second pixel may belong to another line
  EXPECT_EQ(reduced->scene.states.at(std::get<Draw>(reduced->scene.commands.at(0)).state).line_rule, State{}.line_rule);
  EXPECT_EQ(std::get<Draw>(reduced->scene.commands.at(0)).topology, Topology::lines);
}

TEST(CosimReduce, OfTheTexturesTheOneThatIsShownIsLeft) {
  Config config = preset("embedded");
  config.texture_unit = TextureUnitKind::nearest;
  std::uint64_t seed = 1;
  while (random_scene(config, seed, 60).textures.size() < 3) ++seed;
  const Scene scene = random_scene(config, seed, 60);
  const auto shows = [](const Scene& s, std::string_view name) {
    return std::ranges::any_of(s.commands, [&](const Command& command) {
      const auto* draw = std::get_if<Draw>(&command);
      return draw != nullptr && s.states[draw->state].texture &&
             s.textures.at(*s.states[draw->state].texture).name == name;
    });
  };
  std::size_t shown = 0;
  for (const Texture& texture : scene.textures) {
    if (!shows(scene, texture.name)) continue;
    ++shown;
    const auto reduced = reduce(scene, config, {}, [&](const Scene& s, const LockstepOptions&) {
      validate(s);
      return shows(s, texture.name) ? std::optional(Mismatch{}) : std::nullopt;
    });
    ASSERT_TRUE(reduced.has_value());
    EXPECT_EQ(reduced->primitives_after, 1u);
    ASSERT_EQ(reduced->scene.textures.size(), 1u);
    EXPECT_EQ(reduced->scene.textures[0].name, texture.name);
  }
  EXPECT_GT(shown, 1u);
}

TEST(CosimReduce, WindowSpaceSendsTheSamePrimitives) {
  const Config config = preset("embedded");
  test::SceneBuilder builder(64, 48, State{});
  builder.triangle(test::clip_at(-0.5, -0.5, 0.1, 1, {255, 0, 9, 255}), test::clip_at(0.5, -0.5, 0.2, 1),
                   test::clip_at(0, 0.7, 0.3, 1.5));
  State culled;
  culled.cull = Cull::front;
  culled.scissor = Rect{3, 4, 20, 20};
  builder.with_state(culled).triangle(test::clip_at(-0.5, -0.5, 0.1, 1), test::clip_at(0.5, -0.5, 0.2, 1),
                                      test::clip_at(0, 0.7, 0.3, 1.5));
  HostStream a(builder.scene, config);
  const Scene window = window_scene(builder.scene, config);
  HostStream b(window, config);
  const Widths widths = derive_widths(config);
  while (const auto from_clip = a.next()) {
    const auto from_window = b.next();
    ASSERT_TRUE(from_window.has_value());
    EXPECT_EQ(packed(from_clip->packet, widths), packed(from_window->packet, widths));
  }
  EXPECT_FALSE(b.next().has_value());
}

}  // namespace
}  // namespace halfplane::cosim_harness_test
