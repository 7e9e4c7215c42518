// Lines and points in the hardware model: their fragments, their place in program order, and their effect on HiZ.
#include <gtest/gtest.h>

#include <utility>

#include "model/engines/functional.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/primitive_join.hpp"
#include "sim/cosim/random_scene.hpp"
#include "tests/hardware_scene.hpp"

namespace halfplane::hardware_lines_test {
namespace {

using test::with;

/// Everything that came to depth_test, in order.
struct Fragments : PacketSink {
  using PacketSink::take;
  void take(On<Arrow::fragment>, const FragmentPacket& packet) override { fragments.push_back(packet); }
  void take(On<Arrow::retire>, const RetirePacket&) override { ++retired; }
  std::vector<FragmentPacket> fragments;
  int retired = 0;
};

PrimitivePacket primitive(PrimitiveKind kind, DepthFunc func, PixelBounds box, std::uint32_t depth) {
  PrimitivePacket packet;
  packet.kind = kind;
  packet.state = {func, true, true};
  packet.box = to_box(box);
  for (auto& code : packet.vertex.code) code[kDepthPlane] = depth;
  return packet;
}

/// The place of a level line of `count` pixels from (x, y) on, and the line.
struct LinePackets {
  PrimitivePacket place;
  LineSetup setup;
};
LinePackets level_line(int x, int y, std::uint32_t count, std::uint32_t depth, DepthFunc func, const Widths& widths) {
  LinePackets line{primitive(PrimitiveKind::line, func, {x, y, x, y}, 0), {}};
  line.place.primitive_id = line.setup.primitive_id = 7;
  line.setup.x = x;
  line.setup.y = y;
  line.setup.is_x_major = 1;
  line.setup.remaining = count - 1;
  line.setup.error = line.setup.step_move = -1;
  line.setup.value[kDepthPlane] = std::uint64_t{depth} << widths.line_guard_bits;
  return line;
}

/// A triangle that covers the target's 4 x 4 tiles.
PrimitivePacket large_triangle(DepthFunc func, std::uint32_t depth) {
  PrimitivePacket packet = primitive(PrimitiveKind::triangle, func, {0, 0, 31, 31}, depth);
  packet.vertex.x = {0, 64 << 4, 0};
  packet.vertex.y = {0, 0, 64 << 4};
  return packet;
}

TEST(HardwareLines, EveryPixelOfALineIsAStampWithOneSampleAndTheStateOfItsPlace) {
  for (const char* size : {"1", "2", "4"}) {
    const Config config = with("embedded", {{"stamp.size", size}});
    const Widths widths = derive_widths(config);
    Fragments sink;
    HardwareModel hardware(config, sink);
    hardware.run(primitive(PrimitiveKind::fast_clear, DepthFunc::always, {0, 0, 31, 31}, 60000));
    sink = {};
    const LinePackets line = level_line(5, 11, 9, 1234, DepthFunc::lequal, widths);
    hardware.run(line.place, line.setup);
    ASSERT_EQ(sink.fragments.size(), 9u);
    for (int n = 0; n < 9; ++n) {
      const FragmentPacket& f = sink.fragments[static_cast<std::size_t>(n)];
      const int x = f.key.tile_x * 8 + f.stamp % widths.stamps.stamps_per_row * config.stamp_size;
      const int y = f.key.tile_y * 8 + f.stamp / widths.stamps.stamps_per_row * config.stamp_size;
      const int sample = (11 - y) * config.stamp_size + 5 + n - x;
      EXPECT_EQ(f.mask.bits(), std::uint64_t{1} << sample) << n;
      EXPECT_EQ(f.code[static_cast<std::size_t>(sample)][kDepthPlane], 1234u);
      EXPECT_EQ(f.state.depth_test, DepthFunc::lequal);
      EXPECT_EQ(f.key.primitive_id, 7u);
      EXPECT_FALSE(f.ends_visit);
      EXPECT_EQ(f.ends_primitive, n == 8);
    }
    EXPECT_EQ(sink.retired, 0) << "a line belongs to no tile visit";
    EXPECT_EQ(hardware.counters().primitives_in, 1u);
    EXPECT_EQ(hardware.counters().written, 9u);
    EXPECT_EQ(hardware.counters().tiles_visited, 0u);
  }
}

TEST(HardwareLines, APointIsCountedButItsTilesAreNot) {
  PacketSink nobody;
  HardwareModel hardware(preset("embedded"), nobody);
  hardware.run(primitive(PrimitiveKind::fast_clear, DepthFunc::always, {0, 0, 31, 31}, 60000));
  hardware.run(primitive(PrimitiveKind::point, DepthFunc::less, {3, 3, 12, 7}, 100));
  EXPECT_EQ(hardware.counters().primitives_in, 1u);
  EXPECT_EQ(hardware.counters().covered, 50u);
  EXPECT_EQ(hardware.counters().written, 50u);
  EXPECT_EQ(hardware.counters().tiles_visited, 0u);
}

/// How many tiles HiZ skips of a triangle behind others, with a line between them.
std::uint64_t tiles_skipped(DepthFunc line_func, bool clears_again) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  PacketSink nobody;
  HardwareModel hardware(config, nobody);
  const auto clear = primitive(PrimitiveKind::fast_clear, DepthFunc::always, {0, 0, 31, 31}, 60000);
  hardware.run(clear);
  const LinePackets line = level_line(3, 3, 20, 50000, line_func, widths);
  if (clears_again) hardware.run(line.place, line.setup);
  if (clears_again) hardware.run(clear);
  for (int n = 0; n < 2; ++n) hardware.run(large_triangle(DepthFunc::lequal, 1000));  // the lag's worth of visits
  if (!clears_again) hardware.run(line.place, line.setup);
  hardware.run(large_triangle(DepthFunc::less, 2000));
  return hardware.counters().tiles_hiz;
}

TEST(HardwareLines, OnlyALineThatCanRaiseDepthsPutsHizToRest) {
  EXPECT_EQ(tiles_skipped(DepthFunc::lequal, false), 16u);
  for (const DepthFunc func : {DepthFunc::greater, DepthFunc::gequal, DepthFunc::notequal, DepthFunc::always})
    EXPECT_EQ(tiles_skipped(func, false), 0u) << "its pixels may lie behind the bound";
}

TEST(HardwareLines, AFastClearWakesHizAgain) { EXPECT_EQ(tiles_skipped(DepthFunc::always, true), 16u); }

TEST(HostStreamMustFail, AMissingFirstClearAndALineWithoutASetupAreFaults) {
  HostPrimitive first;
  first.packet = primitive(PrimitiveKind::fast_clear, DepthFunc::always, {0, 0, 31, 31}, 60000);
  first.packet.state.depth_write = first.packet.state.color_write = true;
  EXPECT_EQ(stream_fault(first, true), "");
  first.packet.state.color_write = false;
  EXPECT_EQ(stream_fault(first, false), "") << "later clears may leave a plane alone";
  EXPECT_NE(stream_fault(first, true).find("does not begin with a fast clear"), std::string::npos);
  HostPrimitive line;
  line.packet = primitive(PrimitiveKind::line, DepthFunc::less, {3, 3, 3, 3}, 0);
  EXPECT_NE(stream_fault(line, false).find("without its setup"), std::string::npos);
  line.line.emplace();
  EXPECT_EQ(stream_fault(line, false), "");
}

TEST(HostStream, EveryStreamThatItMakesIsWithoutFault) {
  const Config config = preset("embedded");
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = random_scene(config, seed, 200);
    HostStream host(scene, config);
    bool is_first = true;
    while (const auto next = host.next()) EXPECT_EQ(stream_fault(*next, std::exchange(is_first, false)), "");
  }
}

TEST(HardwareLines, ImagesAreThoseOfTheFunctionalEngine) {
  for (const char* name : {"tiny", "embedded", "full"})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Config config = preset(name);
      const Scene scene = random_scene(config, seed, 300);
      const Rendering expected = render_functional(scene, config), hardware = render_hardware(scene, config);
      ASSERT_EQ(hardware.frame.depth, expected.frame.depth);
      ASSERT_EQ(hardware.frame.color, expected.frame.color);
      EXPECT_EQ(hardware.counters.primitives_in, expected.counters.primitives_in);
      EXPECT_EQ(hardware.counters.culled, expected.counters.culled);
      EXPECT_EQ(hardware.counters.drawn, expected.counters.drawn);
      EXPECT_EQ(hardware.counters.written, expected.counters.written);
    }
}

TEST(HardwareLines, AConfigurationWithoutTheUnitRefusesLinesInOneLine) {
  const Config config = with("embedded", {{"lines.unit", "0"}});
  Scene scene;
  scene.name = "scene.hpt";
  scene.vertices.resize(2);
  scene.indices = {0, 1};
  scene.states.emplace_back();
  scene.commands.push_back(Draw{0, 0, Topology::points, 0, 2, 3});
  EXPECT_NO_THROW(check_hardware_scene(scene, config));
  scene.commands.push_back(Draw{0, 0, Topology::lines, 0, 2, 4});
  try {
    check_hardware_scene(scene, config);
    FAIL() << "the line was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line 4: lines, but"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("set lines.unit=1"), std::string::npos);
  }
}

}  // namespace
}  // namespace halfplane::hardware_lines_test
