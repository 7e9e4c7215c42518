// One stage in RTL against its model, packet by packet, in the three presets: one configuration and one field list serve
// both sides.
#include <gtest/gtest.h>
#include <verilated.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <random>

#include "VFineRasterEmbedded.h"
#include "VFineRasterFull.h"
#include "VFineRasterTiny.h"
#include "model/packet_bits.hpp"
#include "model/pipeline.hpp"

namespace halfplane {
namespace {

template <class Port>
void drive(Port& port, const PacketBits& bits) {
  if constexpr (std::is_integral_v<Port>) {
    std::uint64_t value = bits.word[0];
    if (bits.word.size() > 1) value |= static_cast<std::uint64_t>(bits.word[1]) << 32;
    port = static_cast<Port>(value);
  } else {
    for (std::size_t i = 0; i < bits.word.size(); ++i) port[i] = bits.word[i];
  }
}

template <class Port>
PacketBits sample(const Port& port, int size) {
  PacketBits bits(size);
  for (std::size_t i = 0; i < bits.word.size(); ++i) {
    if constexpr (std::is_integral_v<Port>)
      bits.word[i] = static_cast<std::uint32_t>(static_cast<std::uint64_t>(port) >> 32 * i);
    else
      bits.word[i] = port[i];
  }
  return bits;
}

struct Stimulus {
  TilePacket tile;
  EdgeContext edges;
};

/// Tiles of random triangles of all sizes: cut, accepted and rejected ones, boxes cut by the scissor.
std::vector<Stimulus> random_tiles(const Config& config, std::uint64_t seed, std::size_t count) {
  const Widths widths = derive_widths(config);
  std::mt19937_64 random(seed);
  const auto below = [&random](std::int64_t n) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n));
  };
  std::vector<Stimulus> stimuli;
  for (std::uint32_t primitive = 0; stimuli.size() < count; ++primitive) {
    Triangle triangle;
    triangle.primitive = primitive;
    const auto target = std::min(config.target_width, config.target_height);
    const std::int64_t reach = std::int64_t{1}
                               << (1 + below(widths.coordinate.bits - 1));  // from 1 subpixel to the band
    const std::int64_t center_x = below(std::int64_t{target} << widths.grid_bits);
    const std::int64_t center_y = below(std::int64_t{target} << widths.grid_bits);
    for (auto& v : triangle.v) {
      const auto clamped = [&](std::int64_t x) {
        return static_cast<std::int32_t>(std::clamp(x, static_cast<std::int64_t>(widths.coordinate.range.lo),
                                                    static_cast<std::int64_t>(widths.coordinate.range.hi)));
      };
      v.x = clamped(center_x + below(2 * reach) - reach);
      v.y = clamped(center_y + below(2 * reach) - reach);
    }
    const int inset = static_cast<int>(below(4));
    const TriangleSetup setup =
        setup_triangle(triangle, config, widths, {inset, inset, target - 2 * inset, target - 2 * inset});
    if (setup.is_empty()) continue;
    const int last_x = setup.right >> widths.tile_shift, last_y = setup.bottom >> widths.tile_shift;
    const auto slot = static_cast<std::uint8_t>(primitive % static_cast<std::uint32_t>(config.context_slots));
    for (int n = 0; n < 16 && stimuli.size() < count; ++n) {  // a sample of its tiles, those outside an edge included
      const int x =
          (setup.left >> widths.tile_shift) + static_cast<int>(below(last_x - (setup.left >> widths.tile_shift) + 1));
      const int y =
          (setup.top >> widths.tile_shift) + static_cast<int>(below(last_y - (setup.top >> widths.tile_shift) + 1));
      stimuli.push_back({make_tile_packet(setup, x, y, slot, widths), make_edge_context(setup)});
    }
  }
  return stimuli;
}

std::deque<StampPacket> model_stamps(const std::vector<Stimulus>& stimuli, const Config& config) {
  const Widths widths = derive_widths(config);
  std::deque<StampPacket> stamps;
  for (const auto& s : stimuli)
    fine_raster(s.tile, s.edges, config, widths, [&](const StampPacket& stamp) { stamps.push_back(stamp); });
  return stamps;
}

struct Outcome {
  std::size_t compared = 0;
  std::string first_mismatch;
};

/// Feeds the tiles to the RTL, with random gaps on both sides, and compares every stamp in order.
template <class Dut>
Outcome run(const std::vector<Stimulus>& stimuli, std::deque<StampPacket> expected, const Config& config,
            double stall_probability, std::uint64_t seed) {
  const Widths widths = derive_widths(config);
  VerilatedContext context;
  context.randReset(2);
  context.randSeed(static_cast<int>(seed % 1000 + 1));
  Dut dut(&context);
  std::mt19937_64 random(seed);
  const auto stalls = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 < stall_probability; };
  dut.clk_i = 0;
  dut.rst_ni = 0;
  dut.tile_valid_i = 0;
  dut.stamp_ready_i = 0;
  dut.eval();
  Outcome outcome;
  std::size_t next = 0;
  bool offered = false;  // valid must stay until the tile is taken
  // Runs until nothing has moved for a while, also after the last expected stamp: one too many must be seen.
  const std::size_t idle_limit = 1000;
  for (std::size_t cycle = 0, idle = 0; idle < idle_limit; ++cycle, ++idle) {
    dut.rst_ni = cycle >= 2;
    offered = dut.rst_ni != 0 && next < stimuli.size() && (offered || !stalls());
    dut.tile_valid_i = offered;
    if (offered) {
      drive(dut.tile_i, pack(stimuli[next].tile, widths));
      drive(dut.edges_i, pack(stimuli[next].edges, widths));
    }
    dut.stamp_ready_i = dut.rst_ni != 0 && !stalls();
    dut.eval();
    const bool tile_taken = offered && dut.tile_ready_o;
    if (dut.stamp_valid_o && dut.stamp_ready_i) {
      idle = 0;
      const auto stamp = unpack<StampPacket>(sample(dut.stamp_o, packet_bits<StampPacket>(widths)), widths);
      if (expected.empty()) return {outcome.compared, "the RTL sent a stamp too many: " + to_string(stamp, widths)};
      ++outcome.compared;
      const auto fields = differing_fields(expected.front(), stamp, widths);
      if (!fields.empty())
        return {outcome.compared, "cycle " + std::to_string(cycle) + ", field " + fields.front() + "\n  model " +
                                      to_string(expected.front(), widths) + "\n  rtl   " + to_string(stamp, widths)};
      expected.pop_front();
    }
    if (tile_taken) {
      idle = 0;
      ++next;
      offered = false;
    }
    dut.clk_i = 1;
    dut.eval();
    dut.clk_i = 0;
  }
  if (!expected.empty() || next < stimuli.size()) outcome.first_mismatch = "the RTL stopped: stamps are missing";
  dut.final();
  return outcome;
}

template <class Dut_>
struct Preset {
  using Dut = Dut_;
};
struct Tiny : Preset<VFineRasterTiny> {
  static constexpr auto kName = "tiny";
};
struct Embedded : Preset<VFineRasterEmbedded> {
  static constexpr auto kName = "embedded";
};
struct Full : Preset<VFineRasterFull> {
  static constexpr auto kName = "full";
};

template <class P>
class FineRasterRtl : public ::testing::Test {
 protected:
  Config config = preset(P::kName);
};
using Presets = ::testing::Types<Tiny, Embedded, Full>;
TYPED_TEST_SUITE(FineRasterRtl, Presets);

TYPED_TEST(FineRasterRtl, EqualsTheModelInEveryStampWithAndWithoutStalls) {
  for (const double stall : {0.0, 0.3, 0.8}) {
    const std::uint64_t seed = 20 + static_cast<std::uint64_t>(stall * 10);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", stall probability " + std::to_string(stall));
    const auto stimuli = random_tiles(this->config, seed, 20000);
    const auto expected = model_stamps(stimuli, this->config);
    const Outcome outcome = run<typename TypeParam::Dut>(stimuli, expected, this->config, stall, seed);
    EXPECT_EQ(outcome.first_mismatch, "");
    EXPECT_EQ(outcome.compared, expected.size());
    EXPECT_GT(outcome.compared, 10000u);
  }
}

TYPED_TEST(FineRasterRtl, IsToldApartFromAModelThatTiesTheOtherWay) {
  // Must fail: a model whose edges are one step further in drops exactly the samples on an edge.
  auto stimuli = random_tiles(this->config, 7, 2000);
  auto wrong = stimuli;
  for (auto& s : wrong) s.tile.edge_value[0] -= s.tile.edge_value[0] > -1 ? 1 : 0;
  const Outcome outcome =
      run<typename TypeParam::Dut>(stimuli, model_stamps(wrong, this->config), this->config, 0.3, 7);
  EXPECT_NE(outcome.first_mismatch, "");
}

TYPED_TEST(FineRasterRtl, IsToldApartFromAModelThatLosesOneStamp) {
  const auto stimuli = random_tiles(this->config, 8, 2000);
  auto expected = model_stamps(stimuli, this->config);
  expected.pop_back();
  const Outcome outcome = run<typename TypeParam::Dut>(stimuli, expected, this->config, 0.3, 8);
  EXPECT_NE(outcome.first_mismatch, "");
}

}  // namespace
}  // namespace halfplane
