// The RTL's part of an explanation: every packet that carries a pixel, bit by bit, in the model's cycle.
#include <gtest/gtest.h>

#include <iostream>

#include "sim/cosim/dut.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/random.hpp"
#include "sim/study/explain/explain.hpp"

namespace halfplane::explain::explain_rtl_test {
namespace {

constexpr std::uint64_t kSeed = 26;

TEST(ExplainRtl, RandomPixelsAgreeWithTheRtlInEveryPacketAndCycle) {
  std::cout << "seed " << kSeed << '\n';
  for (const DutFactory& factory : verilated_duts()) {
    SCOPED_TRACE(factory.name);
    if (factory.config.msaa_samples > 1) continue;  // explain keeps no record of such hardware
    const auto dut = make_dut(factory);
    Random random(kSeed);
    std::size_t packets = 0, cycles = 0;
    for (int n = 0; n < 6; ++n) {
      const std::uint64_t seed = random.next();
      SCOPED_TRACE("scene seed " + std::to_string(seed));
      const Scene scene = random_scene(factory.config, seed, 100);
      std::vector<Pixel> pixels;
      for (int i = 0; i < 25; ++i)
        pixels.push_back({static_cast<int>(random.next() % static_cast<unsigned>(scene.width)),
                          static_cast<int>(random.next() % static_cast<unsigned>(scene.height))});
      Options options;
      options.rtl = dut.get();
      const Explanation told = explain(scene, factory.config, pixels, options);
      for (const std::string& difference : told.differences) ADD_FAILURE() << difference;
      for (const auto& [id, packet] : told.packets) {
        EXPECT_EQ(packet.model, packet.rtl) << info(id.first).name << ' ' << id.second;
        ++packets;
        if (!packet.model_cycle) continue;
        EXPECT_EQ(packet.model_cycle, packet.rtl_cycle) << info(id.first).name << ' ' << id.second;
        ++cycles;
      }
      for (const PixelHistory& pixel : told.pixels) EXPECT_EQ(pixel.rtl->color, pixel.hardware->color);
      if (HasFailure()) return;
    }
    std::cout << factory.name << ": " << packets << " packets, " << cycles << " cycles\n";
    EXPECT_GT(packets, 500U);
    EXPECT_GT(cycles, 300U);
  }
}

}  // namespace
}  // namespace halfplane::explain::explain_rtl_test
