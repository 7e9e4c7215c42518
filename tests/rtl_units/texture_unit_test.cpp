// The texture unit of the RTL against its specification and its timing: random programs, textures and stalls, resets at any
// time. Every colour, request and stamp in its cycle. Units with a fault are found.
#include <gtest/gtest.h>
#include <verilated.h>

#include <cstdlib>
#include <cstring>
#include <iostream>
#include <optional>
#include <string>

#include "../tier.hpp"
#include "VTextureUnit.h"
#include "VTextureUnitFull.h"
#include "VTextureUnitLanes.h"
#include "VTextureUnitLanesFull.h"
#include "VTextureUnitLanesLevels.h"
#include "VTextureUnitLanesLevelsFull.h"
#include "VTextureUnitLanesLevelsQueue.h"
#include "VTextureUnitLanesWays.h"
#include "VTextureUnitLevels.h"
#include "VTextureUnitLevelsTiny.h"
#include "VTextureUnitLevelsWays.h"
#include "VTextureUnitLinear.h"
#include "VTextureUnitLinearTiny.h"
#include "VTextureUnitTiny.h"
#include "texture_faults.hpp"
#include "texture_unit_plan.hpp"

namespace halfplane::texture_test {
namespace {

const UnitFormat kEmbedded{4, 4, {64, 64, 16, 32}, kEmbeddedPerspective, true};
const UnitFormat kTiny{1, 3, {4, 16, 4, 8}, kTinyPerspective, true, true, true};
const UnitFormat kLinear{4, 4, {64, 64, 16, 32, true}, kEmbeddedPerspective, false, false, true};
const UnitFormat kLinearTiny{1, 3, {16, 16, 4, 8, true}, kTinyPerspective};
const UnitFormat kLevels{4, 4, {64, 64, 16, 32, true, true, 104}, kEmbeddedPerspective, true};
const UnitFormat kLevelsTiny{1, 3, {16, 16, 4, 8, true, true, 70}, kTinyPerspective, false, false, true};
const UnitFormat kLevelsWays{1, 3, {16, 16, 4, 8, true, true, 70, 1, 1, 2}, kTinyPerspective};
const UnitFormat kLanes{4, 4, {64, 64, 32, 32, true, false, 104, 4, 2}, kEmbeddedPerspective, true, false, true};
const UnitFormat kLanesWays{4, 4, {16, 64, 32, 32, true, false, 104, 4, 2, 2}, kEmbeddedPerspective, true};
const UnitFormat kLanesFull{16, 4, {256, 16, 8, 8, false, false, 104, 4, 4, 2}, kFullPerspective, true, false, true};
const UnitFormat kLanesLevels{4, 4, {64, 64, 32, 32, true, true, 104, 4, 2}, kEmbeddedPerspective, true};
const UnitFormat kLanesLevelsFull{16, 4, {16, 16, 8, 8, true, true, 104, 4, 4, 2}, kFullPerspective};
const UnitFormat kLanesLevelsFaults{16, 4, {64, 64, 8, 32, true, true, 104, 4, 4}, kFullPerspective, false, true, true};
const UnitFormat kFull{16, 4, {256, 128, 16, 64}, kFullPerspective, true};

std::uint64_t seed_of_run() {
  const char* given = std::getenv("HALFPLANE_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 0) : std::random_device{}();
}

/// Ports of any width as rows of bits.
template <class Port>
void put(Port& port, std::size_t at, int bits, std::uint64_t value) {
  for (int i = 0; i < bits; ++i) {
    const std::size_t bit = at + static_cast<std::size_t>(i);
    if constexpr (std::is_integral_v<Port>) {
      port = static_cast<Port>((port & ~(std::uint64_t{1} << bit)) | (value >> i & 1) << bit);
    } else {
      auto& word = port[bit / 32];
      word = (word & ~(1U << bit % 32)) | static_cast<std::uint32_t>(value >> i & 1) << bit % 32;
    }
  }
}
template <class Port>
std::uint8_t byte_of(const Port& port, std::size_t n) {
  if constexpr (std::is_integral_v<Port>)
    return static_cast<std::uint8_t>(port >> (8 * n));
  else
    return static_cast<std::uint8_t>(port[n / 4] >> (8 * (n % 4)));
}

template <class Dut>
class Bench {
 public:
  explicit Bench(const UnitFormat& format, int fault = 0) : format_(format) {
    dut_.fault_i = static_cast<CData>(fault);
    dut_.power_on_ni = 0;
    dut_.rst_ni = 0;
    dut_.stamp_valid_i = 0;
    dut_.answer_valid_i = 0;
    dut_.clk_i = 0;
    dut_.eval();
    clock();
    dut_.power_on_ni = 1;
  }
  ~Bench() { dut_.final(); }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] Cycle cycles() const { return cycle_; }

  /// Programs with resets between. The first fault, or nothing.
  std::string run(std::uint64_t seed, int programs, int stamps) {
    Random random(seed);
    Cycle over = 0;  // the last request of before was taken and answered
    Plan plan;
    for (int n = 0; n < programs; ++n) {
      const World world = random_world(random);
      const Cycle resets = static_cast<Cycle>(pick(random, 1, 20));
      world_ = world;
      if (auto wrong = reset(plan, resets); !wrong.empty()) return wrong;
      const bool is_cut = n + 1 < programs && pick(random, 0, 2) != 0;
      over_of(plan, over);
      std::vector<PlannedRequest> before;
      for (PlannedRequest& request : plan.requests)
        if (request.answered.back() >= cycle_ || request.asked >= cycle_) before.push_back(request);
      plan = make_plan(format_, world, random, stamps, cycle_, TextureTiming::recovered(cycle_ - 1, over), over);
      const auto length = static_cast<int>(plan.last - cycle_);
      const Cycle end = is_cut ? cycle_ + static_cast<Cycle>(pick(random, 0, length)) : plan.last + 3;
      plan.requests.insert(plan.requests.begin(), before.begin(), before.end());
      begin(plan);
      while (cycle_ < end)
        if (auto wrong = step(plan); !wrong.empty()) return wrong;
      if (!is_cut && !dut_.idle_o) return at("is not idle");
      if (!is_cut && (use_.samples != plan.use.samples || use_.hits != plan.use.hits || use_.fills != plan.use.fills))
        return at("counts samples, hits or lines wrong");
      samples_ += use_.samples;
      // A request not made before the reset is never made.
      std::erase_if(plan.requests, [this](const PlannedRequest& r) { return r.offered > cycle_; });
      plan.stamps.clear();
    }
    return {};
  }

 private:
  void clock() {
    dut_.clk_i = 1;
    dut_.eval();
    dut_.clk_i = 0;
    dut_.eval();
  }
  [[nodiscard]] std::string at(const std::string& what) const {
    return "cycle " + std::to_string(cycle_) + ": " + what;
  }

  void over_of(const Plan& plan, Cycle& over) const {
    for (const PlannedRequest& request : plan.requests) over = std::max({over, request.asked, request.answered.back()});
  }
  void begin(const Plan&) {
    in_ = out_ = request_ = answer_ = 0;
    beat_ = 0;
    use_ = {};
  }

  std::string reset(const Plan& plan, Cycle cycles) {
    dut_.rst_ni = 0;
    for (Cycle end = cycle_ + cycles; cycle_ < end;)
      if (auto wrong = step(plan); !wrong.empty()) return wrong;
    dut_.rst_ni = 1;
    return {};
  }

  std::string step(const Plan& plan) {
    drive(plan);
    dut_.eval();
    if (auto wrong = compare(plan); !wrong.empty()) return wrong;
    use_.samples += dut_.sample_o;
    use_.hits += dut_.hit_o;
    use_.fills += dut_.miss_o;
    clock();
    ++cycle_;
    return {};
  }

  void drive(const Plan& plan) {
    dut_.stamp_valid_i = in_ < plan.stamps.size() && plan.stamps[in_].enters == cycle_;
    if (dut_.stamp_valid_i) drive_stamp(plan.stamps[in_++]);
    dut_.stamp_ready_i = !world_.is_stalled(1, cycle_);
    // A request of before a reset is taken when it was planned to be.
    while (request_ < plan.requests.size() && plan.requests[request_].asked < cycle_) ++request_;
    dut_.request_ready_i = !world_.is_stalled(2, cycle_);
    if (request_ < plan.requests.size() && plan.requests[request_].offered <= cycle_)
      dut_.request_ready_i = plan.requests[request_].asked == cycle_;
    while (answer_ < plan.requests.size() && plan.requests[answer_].answered.back() < cycle_) ++answer_, beat_ = 0;
    dut_.answer_valid_i = 0;
    if (answer_ == plan.requests.size()) return;
    const PlannedRequest& request = plan.requests[answer_];
    while (request.answered[beat_] < cycle_) ++beat_;
    dut_.answer_valid_i = request.answered[beat_] == cycle_;
    const auto bytes = static_cast<std::size_t>(format_.settings.port_bits / 8);
    for (std::size_t i = 0; i < bytes; ++i) put(dut_.answer_data_i, 8 * i, 8, request.line[beat_ * bytes + i]);
  }

  void drive_stamp(const PlannedStamp& stamp) {
    const int q_bits = q_local_bits(format_.perspective),
              p_bits = p_local_bits(format_.perspective.coordinate, format_.perspective);
    dut_.payload_i = stamp.payload;
    put(dut_.mask_i, 0, format_.samples, stamp.mask.bits());
    dut_.is_triangle_i = stamp.is_triangle;
    dut_.sets_state_i = stamp.sets == StateRegister::texture;
    dut_.sets_levels_i = sets(stamp, LevelsWord::levels);
    dut_.sets_constant_i = sets(stamp, LevelsWord::constant);
    dut_.sets_border_i = sets(stamp, LevelsWord::border);
    dut_.moves_in_i = stamp.sets == StateRegister::texture_lines;
    dut_.x_i = static_cast<SData>(stamp.x);
    dut_.y_i = static_cast<SData>(stamp.y);
    const int word_bits = format_.settings.has_levels ? format_.settings.line_bits
                          : format_.has_border        ? TextureState::kBits
                                                      : TextureState::kBits - (format_.has_constant ? 2 : 3);
    put(dut_.state_i, 0, std::min(word_bits, 64), static_cast<std::uint64_t>(stamp.word));
    if (word_bits > 64) put(dut_.state_i, 64, word_bits - 64, static_cast<std::uint64_t>(stamp.word >> 64));
    for (std::size_t s = 0; s < static_cast<std::size_t>(format_.samples); ++s) {
      put(dut_.q_i, s * static_cast<std::size_t>(q_bits), q_bits, stamp.sample[s].q);
      put(dut_.u_i, s * static_cast<std::size_t>(p_bits), p_bits, static_cast<std::uint64_t>(stamp.sample[s].p[0]));
      put(dut_.v_i, s * static_cast<std::size_t>(p_bits), p_bits, static_cast<std::uint64_t>(stamp.sample[s].p[1]));
      const auto channels = static_cast<std::size_t>(format_.channels);
      for (std::size_t c = 0; c < channels; ++c) put(dut_.color_i, 8 * (s * channels + c), 8, stamp.color[s][c]);
      if (!format_.divides_colors) continue;
      const int color_bits = p_local_bits(format_.perspective.color, format_.perspective);
      for (std::size_t c = 0; c < channels; ++c)
        put(dut_.color_p_i, (s * channels + c) * static_cast<std::size_t>(color_bits), color_bits,
            static_cast<std::uint64_t>(stamp.sample[s].color_p[c]));
    }
    dut_.divides_colors_i = stamp.frame.divides_colors;
    for (std::size_t c = 0; c < static_cast<std::size_t>(format_.channels); ++c) {
      put(dut_.color_shift_i, 6 * c, 6, static_cast<std::uint64_t>(stamp.frame.color_scale[c].shift));
      put(dut_.color_reach_i, 4 * c, 4, static_cast<std::uint64_t>(stamp.frame.color_scale[c].reach));
      put(dut_.least_color_i, 8 * c, 8, stamp.frame.least[c]);
      put(dut_.greatest_color_i, 8 * c, 8, stamp.frame.greatest[c]);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      put(dut_.shift_i, 6 * i, 6, static_cast<std::uint64_t>(stamp.frame.scale[i].shift));
      put(dut_.reach_i, 5 * i, 5, static_cast<std::uint64_t>(stamp.frame.scale[i].reach));
      put(dut_.reference_i, 24 * i, 24, static_cast<std::uint64_t>(stamp.frame.reference[i]));
    }
  }

  std::string compare(const Plan& plan) {
    const bool is_reset = !dut_.rst_ni;
    while (out_ < plan.stamps.size() && plan.stamps[out_].left < cycle_) ++out_;
    const bool offers = !is_reset && out_ < plan.stamps.size() && plan.stamps[out_].offered <= cycle_;
    if (dut_.stamp_valid_o != offers) return at(offers ? "a stamp is late" : "a stamp is early");
    if (offers)
      if (auto wrong = compare_stamp(plan.stamps[out_]); !wrong.empty()) return wrong;
    const bool asks = request_ < plan.requests.size() && plan.requests[request_].offered <= cycle_;
    if (dut_.request_valid_o != asks) return at(asks ? "a request is late" : "a request is early");
    if (asks && dut_.request_address_o != plan.requests[request_].address) return at("asks for another line");
    if (asks && dut_.request_beats_o != plan.requests[request_].beats) return at("asks for more or fewer beats");
    if (!dut_.answer_ready_o) return at("does not take an answer");
    return {};
  }

  [[nodiscard]] std::string compare_stamp(const PlannedStamp& stamp) const {
    if (dut_.payload_o != stamp.payload) return at("another stamp");
    if (dut_.mask_o != stamp.mask.bits()) return at("other samples");
    std::string wrong;
    const auto channels = static_cast<std::size_t>(format_.channels);
    stamp.mask.for_each([&](std::size_t s) {
      for (std::size_t c = 0; c < channels; ++c) {
        const int got = byte_of(dut_.color_o, s * channels + c), expected = stamp.combined[s][c];
        if (got != expected)
          wrong = at("sample " + std::to_string(s) + ", channel " + std::to_string(c) + " is " + std::to_string(got) +
                     " instead of " + std::to_string(expected));
      }
    });
    return wrong;
  }

  UnitFormat format_;
  Dut dut_;
  World world_;
  Cycle cycle_ = 0;
  std::size_t in_ = 0, out_ = 0, request_ = 0, answer_ = 0, beat_ = 0;
  std::uint64_t samples_ = 0;
  TextureUse use_;  ///< since the program began
};

template <class Dut>
void expect_right(const UnitFormat& format, std::uint64_t all_samples) {
  const std::uint64_t samples = test::cases(all_samples / 4, all_samples);
  std::uint64_t seed = seed_of_run(), done = 0, cycles = 0;
  while (done < samples) {
    Bench<Dut> bench(format);
    ASSERT_EQ(bench.run(seed, 8, 400), "") << "HALFPLANE_SEED=" << seed;
    done += bench.samples();
    cycles += bench.cycles();
    ++seed;
  }
  std::cout << done << " samples in " << cycles << " cycles, seeds up to " << seed << '\n';
}

TEST(TextureUnit, EmbeddedIsItsSpecificationInEveryCycle) { expect_right<VTextureUnit>(kEmbedded, 200'000); }
TEST(TextureUnit, TinyIsItsSpecificationInEveryCycle) { expect_right<VTextureUnitTiny>(kTiny, 50'000); }
TEST(TextureUnit, LinearIsItsSpecificationInEveryCycle) { expect_right<VTextureUnitLinear>(kLinear, 200'000); }
TEST(TextureUnit, LinearTinyIsItsSpecificationInEveryCycle) {
  expect_right<VTextureUnitLinearTiny>(kLinearTiny, 50'000);
}
TEST(TextureUnit, WithLevelsItIsItsSpecificationInEveryCycle) { expect_right<VTextureUnitLevels>(kLevels, 200'000); }
TEST(TextureUnit, TinyWithLevelsItIsItsSpecificationInEveryCycle) {
  expect_right<VTextureUnitLevelsTiny>(kLevelsTiny, 50'000);
}
TEST(TextureUnit, WithLevelsAndTwoWaysItIsItsSpecificationInEveryCycle) {
  expect_right<VTextureUnitLevelsWays>(kLevelsWays, 100'000);
}
TEST(TextureUnit, FullIsItsSpecificationInEveryCycle) { expect_right<VTextureUnitFull>(kFull, 200'000); }

TEST(TextureUnit, OfFourLanesItIsItsSpecificationInEveryCycle) { expect_right<VTextureUnitLanes>(kLanes, 400'000); }
TEST(TextureUnit, OfFourLanesFullIsItsSpecificationInEveryCycle) {
  expect_right<VTextureUnitLanesFull>(kLanesFull, 200'000);
}

TEST(TextureUnit, OfFourLanesWithLevelsItIsItsSpecificationInEveryCycle) {
  expect_right<VTextureUnitLanesLevels>(kLanesLevels, 400'000);
}
TEST(TextureUnit, OfFourLanesWithLevelsFullIsItsSpecificationInEveryCycle) {
  expect_right<VTextureUnitLanesLevelsFull>(kLanesLevelsFull, 200'000);
}

/// Faults `first` to `last`, and none.
template <class Dut>
void expect_found(const UnitFormat& format, int first, int last) {
  const std::uint64_t seed = seed_of_run();
  const auto run = [&](int fault) {
    const std::uint64_t runs = fault == 0 ? 20 : 400;  // one rounding less is seen in one of a few thousand samples
    for (std::uint64_t n = 0; n < runs; ++n)
      if (std::string found = Bench<Dut>(format, fault).run(seed + n, 8, 300); !found.empty()) return found;
    return std::string();
  };
  EXPECT_EQ(run(0), "") << "HALFPLANE_SEED=" << seed;
  for (int fault = first; fault <= last; ++fault)
    EXPECT_NE(run(fault), "") << "fault " << fault << " is not found, HALFPLANE_SEED=" << seed;
}

TEST(TextureUnit, FaultsAreFound) { expect_found<VTextureUnit>(kEmbedded, 1, kNearestFaults); }
TEST(TextureUnit, FaultsOfTheLinearFilterAreFound) {
  expect_found<VTextureUnitLinear>(kLinear, kNearestFaults + 1, kLinearFaults);
}
TEST(TextureUnit, FaultsOfLevelsAreFound) {
  expect_found<VTextureUnitLevels>(kLevels, kLinearFaults + 1, kLevelsFaults);
}
TEST(TextureUnit, FaultsOfTheConstantAreFound) {
  expect_found<VTextureUnitLanesLevelsQueue>(kLanesLevelsFaults, kLanesFaults + 1, kConstantFaults);
}
TEST(TextureUnit, FaultsOfTheBorderAreFound) {
  expect_found<VTextureUnitLanesLevelsQueue>(kLanesLevelsFaults, kConstantFaults + 1, kTextureFaults);
}
TEST(TextureUnit, FaultsOfColorsOverWAreFound) {
  expect_found<VTextureUnit>(kEmbedded, kLevelsFaults + 1, kColorsFaults);
}
TEST(TextureUnit, FaultsOfLanesAndWaysAreFound) {
  expect_found<VTextureUnitLanesWays>(kLanesWays, kColorsFaults + 1, kWaysFaults);
}
TEST(TextureUnit, FaultsOfLanesWithLevelsAreFound) {
  expect_found<VTextureUnitLanesLevelsQueue>(kLanesLevelsFaults, kWaysFaults + 1, kLanesFaults);
}

}  // namespace
}  // namespace halfplane::texture_test
