// The hardware engine against the functional one, and the packets that it sends on the way.
#include "model/engines/hardware.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../hardware_scene.hpp"
#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/packets/packet_words.hpp"
#include "model/stages/coarse_raster.hpp"
#include "model/stages/cull.hpp"
#include "model/stages/depth_test.hpp"
#include "model/stages/fine_raster.hpp"
#include "model/stages/interpolate.hpp"
#include "model/stages/rop.hpp"
#include "model/stages/triangle_setup.hpp"
#include "sim/study/vertices.hpp"
#include "tests/packet_values.hpp"

namespace halfplane::hardware_test {
namespace {

using test::at;
using test::clip_at;
using test::Random;
using test::Recorder;
using test::run_scene;
using test::SceneBuilder;
using test::with;

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{
      preset("tiny"),
      preset("embedded"),
      preset("full"),
      with("embedded", {{"stamp.size", "1"}, {"hiz.bits", "0"}, {"cache.lines", "1"}}),
      with("embedded", {{"stamp.size", "4"}, {"hiz.bits", "8"}, {"cache.lines", "4"}, {"tile.size", "4"}}),
      with("full", {{"stamp.size", "8"}, {"hiz.bits", "1"}, {"cache.lines", "2"}, {"key.primitive_bits", "4"}}),
      with("tiny", {{"hiz.bits", "3"}, {"tile.size", "4"}, {"cache.lines", "1"}, {"color.format", "rgba8888"}})};
  return all;
}

Clear random_clear(Random& random, std::uint32_t state) {
  Clear clear;
  clear.state = state;
  const int planes = random.index(4);  // 3: none, which the reader of a capture would refuse
  if (planes != 1) clear.depth = random.unit();
  if (planes != 0) {
    clear.color.emplace();
    for (double& channel : *clear.color) channel = random.between(0, 255);
  }
  return clear;
}

/// Triangles of all sizes and states in both spaces, some across the eye, with clears in between.
Scene random_scene(std::uint32_t seed, int width, int height, double band, int triangles) {
  Random random(seed);
  SceneBuilder builder(width, height);
  if (seed % 3 == 0) builder.scene.commands.clear();
  State state;
  for (int n = 0; n < triangles; ++n) {
    if (n % 5 == 0) {
      state = random_state(SceneBuilder::window_state(),
                           without_operations(states_but({"polygon_mode", "pixel_center", "origin"})), chooser(random));
      builder.with_state(state);
      if (random.unit() < 0.25)
        builder.scene.commands.push_back(
            random_clear(random, static_cast<std::uint32_t>(builder.scene.states.size() - 1)));
      if (builder.scene.commands.empty()) builder.scene.commands.push_back(EndFrame{});
    }
    const bool is_flat = random.unit() < 0.2;  // one depth: ties, and bounds that HiZ can use
    const double reach = std::exp2(random.between(-4, std::log2(band) + 1));
    const double x = random.between(0, width), y = random.between(0, height), z = random.unit();
    std::array<Vertex, 3> v;
    for (auto& vertex : v) {
      const double dx = random.between(-reach, reach), dy = random.between(-reach, reach);
      if (state.space == Space::clip) {
        vertex.x = random.between(-3, 3);
        vertex.y = random.between(-3, 3);
        vertex.z = random.between(-1.5, 1.5);
        vertex.w = random.between(-0.5, 2);
      } else {
        const double low = 1 - band, high = band - 1;
        vertex = at(std::clamp(x + dx, low, high), std::clamp(y + dy, low, high), is_flat ? z : random.unit());
        if (random.unit() < 0.3) vertex.x = std::floor(vertex.x) + 0.5;  // onto a pixel centre
      }
      for (auto& channel : vertex.rgba) channel = random.between(0, 255);
    }
    if (random.unit() < 0.05) v[2] = v[1];
    builder.triangle(v[0], v[1], v[2]);
  }
  return builder.scene;
}

Scene random_scene(std::uint32_t seed, const Config& config, int triangles = 80) {
  const bool is_tiny = config.target_width < 64;
  return random_scene(seed, is_tiny ? 15 : 93, is_tiny ? 13 : 71, is_tiny ? 32 : 500, triangles);
}

/// The counts of coarse_raster for the triangles that cull drops because they cover no sample.
CounterPacket walks_saved(const Scene& scene, const Config& config) {
  const Widths widths = derive_widths(config);
  CounterPacket saved, ignored;
  Hiz hiz(config, widths);
  HostStream host(scene, config);
  while (const auto primitive = host.next()) {
    const auto kept = cull(primitive->packet, widths, ignored);
    if (!kept || cull(primitive->packet, widths, saved, true)) continue;
    coarse_raster(setup_packet(*kept, config, widths), 0, hiz, widths, saved, [](const TilePacket&) {});
  }
  return saved;
}

TEST(Hardware, ImageAndCountersAreThoseOfTheFunctionalEngineOnRandomScenes) {
  std::uint64_t written = 0, hiz = 0, clipped = 0, sampleless = 0;
  for (const Config& config : configurations())
    for (std::uint32_t seed = 1; seed <= 25; ++seed) {
      SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
      const Scene scene = random_scene(seed, config);
      const Rendering expected = render_scalar(scene, config), hardware = render_hardware(scene, config);
      ASSERT_EQ(hardware.frame.depth, expected.frame.depth);
      ASSERT_EQ(hardware.frame.color, expected.frame.color);
      const Counters &a = hardware.counters, &b = expected.counters;
      EXPECT_EQ(a.primitives_in, b.primitives_in);
      EXPECT_EQ(a.culled, b.culled);
      EXPECT_EQ(a.drawn, b.drawn);
      EXPECT_EQ(a.clipped, b.clipped);
      EXPECT_EQ(a.skipped.frustum, b.skipped.frustum);
      EXPECT_EQ(a.skipped.backface, b.skipped.backface);
      EXPECT_EQ(a.skipped.zero_area, b.skipped.zero_area);
      EXPECT_EQ(a.skipped.empty, b.skipped.empty);
      const CounterPacket saved = walks_saved(scene, config);
      EXPECT_EQ(a.skipped.no_sample, saved.no_sample);
      EXPECT_EQ(saved.trivially_accepted, 0u);
      // The walk looks at few of the tiles outside; the scalar engine at all of a box.
      EXPECT_EQ(a.tiles_visited - a.skipped.tiles_outside + saved.tiles_visited - saved.tiles_outside,
                b.tiles_visited - b.skipped.tiles_outside);
      EXPECT_LE(a.skipped.tiles_outside + saved.tiles_outside, b.skipped.tiles_outside);
      EXPECT_EQ(a.depth_passed, b.depth_passed);
      EXPECT_EQ(a.written, b.written);
      EXPECT_LE(a.covered, b.covered);
      if (a.skipped.tiles_hiz == 0) {
        EXPECT_EQ(a.covered, b.covered);
        EXPECT_EQ(a.samples_tested + saved.samples_tested, b.samples_tested);
        EXPECT_EQ(a.skipped.trivially_accepted, b.skipped.trivially_accepted);
        EXPECT_EQ(a.skipped.fragments_early_z, b.skipped.fragments_early_z);
      }
      written += a.written;
      hiz += a.skipped.tiles_hiz;
      clipped += a.clipped;
      sampleless += a.skipped.no_sample;
    }
  EXPECT_GT(written, 100000u);
  EXPECT_GT(sampleless, 100u);
  EXPECT_GT(hiz, 100u);
  EXPECT_GT(clipped, 100u);
}

/// Packs and unpacks every packet: one that comes back changed has a value that its field does not hold.
class RoundTrip : public EveryPacket<RoundTrip> {
 public:
  explicit RoundTrip(const Widths& widths) : widths_(widths) {}
  template <Arrow A>
  void take_any(const PacketOf<A>& packet) {
    check(packet);
  }

  template <class Packet>
  void check(const Packet& packet) {
    test::expect_survives_packing(packet, widths_);
  }

 private:
  Widths widths_;
};

TEST(Hardware, EveryPacketFitsItsFields) {
  for (const Config& config : configurations()) {
    SCOPED_TRACE(label(config));
    const Widths widths = derive_widths(config);
    RoundTrip sink(widths);
    const Scene scene = random_scene(77, config, 40);
    HostStream host(scene, config);
    HardwareModel hardware(config, sink);
    while (const auto primitive = host.next()) {
      sink.check(primitive->packet);
      if (primitive->line) sink.check(*primitive->line);
      hardware.run(primitive->packet, primitive->line);
      if (HasFatalFailure()) return;
    }
    sink.check(hardware.counters());
  }
}

template <class... Packets>
void expect_all_wide_enough(const Widths& widths) {
  (test::expect_members_wide_enough<Packets>(widths), ...);
}

TEST(Hardware, EveryMemberHoldsItsFieldInTheWidestConfiguration) {
  Config config = preset("full");
  config.tile_size = 4;
  config.stamp_size = 1;
  config.local_guard_bits = 8;
  config.context_slots = 64;
  config.primitive_id_bits = 32;
  config.guard_band = config.target_width = config.target_height = 16384;
  for (const int stamp : {1, 4, 8}) {
    config.stamp_size = stamp;
    config.tile_size = std::max(4, stamp);
    validate(config);
    expect_all_wide_enough<PrimitivePacket, TrianglePacket, SetupPacket, ContextPacket, FragmentPacket, WritePacket,
                           RetirePacket, MemoryRequest, MemoryResponse, MemoryBeat, MemoryAnswer, CounterPacket>(
        derive_widths(config));
  }
}

TEST(Hardware, StampInterpolatedFromItsTileEqualsTheClosedFormAtEveryPixel) {
  Random random(31);
  for (const Config& config : configurations()) {
    SCOPED_TRACE(label(config));
    const Widths widths = derive_widths(config);
    const int size = config.stamp_size;
    for (int n = 0; n < 300; ++n) {
      Triangle triangle;
      const int reach = 1 << (1 + random.index(widths.coordinate.bits - 2));
      for (auto& v : triangle.v) {
        v.x = random.index(2 * reach) - reach;
        v.y = random.index(2 * reach) - reach;
        v.depth() = static_cast<std::uint32_t>(random.between(0, static_cast<double>(widths.depth().code.range.hi)));
        set_colors(v, widths, [&] { return random.index(256); });
      }
      const TriangleSetup setup =
          setup_triangle(triangle, config, widths, {0, 0, config.target_width, config.target_height});
      if (setup.area == 0 || setup.is_empty()) continue;
      const SetupPacket packet = to_setup_packet(setup, widths);
      const int tile_x = setup.right >> widths.tile_shift, tile_y = setup.bottom >> widths.tile_shift;
      StampPacket stamp = empty_stamp(make_tile_packet(packet, tile_x, tile_y, 0, false, widths));
      stamp.stamp = static_cast<std::uint16_t>(random.index(widths.stamps.stamps()));
      const FragmentPacket fragment = interpolate(stamp, make_context(packet, widths), widths);
      const int x = tile_x * config.tile_size + stamp.stamp % widths.stamps.stamps_per_row * size;
      const int y = tile_y * config.tile_size + stamp.stamp / widths.stamps.stamps_per_row * size;
      for (int s = 0; s < size * size; ++s) {
        const auto sample = static_cast<std::size_t>(s);
        const Interpolated expected = interpolate_at(setup, widths, x + s % size, y + s / size);
        for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {  // modulo 2^bits
          const int guard_bits = widths.of_plane(p).guard_bits(), bits = widths.of_plane(p).code.bits;
          const std::int64_t rounded = (expected.unrounded[p] + (std::int64_t{1} << (guard_bits - 1))) >> guard_bits;
          ASSERT_EQ(fragment.code[sample][p], static_cast<std::uint32_t>(rounded & ((std::int64_t{1} << bits) - 1)));
        }
        for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
          const PlaneSample alone = plane_at(setup, p, widths, x + s % size, y + s / size);
          ASSERT_EQ(alone.code, expected.code[p]);
          ASSERT_EQ(alone.unrounded, expected.unrounded[p]);
        }
      }
    }
  }
}

// Hardware does not clamp codes to the range of the vertices; the specification does.
TEST(Hardware, NoCodeOfACoveredSampleLeavesTheRangeOfTheVertices) {
  Random random(32);
  int covered = 0;
  for (const Config& config : configurations()) {
    SCOPED_TRACE(label(config));
    const Widths widths = derive_widths(config);
    for (int n = 0; n < 1000; ++n) {
      Triangle triangle;
      const int reach = 1 << (1 + random.index(widths.coordinate.bits - 2));
      for (auto& v : triangle.v) {
        v.x = random.index(reach);
        v.y = random.index(reach);
        v.depth() = static_cast<std::uint32_t>(random.between(0, static_cast<double>(widths.depth().code.range.hi)));
        set_colors(v, widths, [&] { return random.index(256); });
      }
      const TriangleSetup setup =
          setup_triangle(triangle, config, widths, {0, 0, config.target_width, config.target_height});
      if (setup.area == 0 || setup.is_empty()) continue;
      const auto& v = triangle.v;
      const bool turns = (std::int64_t{v[1].x} - v[0].x) * (std::int64_t{v[2].y} - v[0].y) <
                         (std::int64_t{v[2].x} - v[0].x) * (std::int64_t{v[1].y} - v[0].y);
      const std::array<std::size_t, 3> order{0, turns ? 2U : 1U, turns ? 1U : 2U};
      for (int i = 0; i < 30; ++i) {
        const int x = setup.left + random.index(setup.right - setup.left + 1);
        const int y = setup.top + random.index(setup.bottom - setup.top + 1);
        bool is_covered = true;
        for (std::size_t e = 0; e < 3; ++e)
          is_covered &= edge_function(v[order[e]], v[order[(e + 1) % 3]], x, y, widths.grid_bits) >= 0;
        if (!is_covered) continue;
        ++covered;
        for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
          const int guard_bits = widths.of_plane(p).guard_bits();
          const std::int64_t rounded =
              (plane_at(setup, p, widths, x, y).unrounded + (std::int64_t{1} << (guard_bits - 1))) >> guard_bits;
          ASSERT_LE(std::int64_t{setup.range.low[p]}, rounded);
          ASSERT_GE(std::int64_t{setup.range.high[p]}, rounded);
        }
      }
    }
  }
  EXPECT_GT(covered, 10000);
}

TEST(Hardware, SetupOfAPacketIsTheSetupOfItsTriangle) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  Random random(32);
  std::size_t compared = 0;
  for (int n = 0; n < 1000; ++n) {
    Triangle triangle;
    triangle.primitive = static_cast<std::uint32_t>(n);
    PrimitivePacket packet;
    packet.primitive_id = triangle.primitive;
    for (auto& v : triangle.v) {
      v.x = random.index(2000) - 500;
      v.y = random.index(2000) - 500;
      v.depth() = static_cast<std::uint32_t>(random.index(65536));
      for (std::size_t c = 0; c < 3; ++c) v.code[kColorPlane + c] = static_cast<std::uint32_t>(random.index(256));
    }
    set_vertices(packet.vertex, triangle.v);
    packet.box = to_box({3, 5, 60, 50});
    const TriangleSetup expected = setup_triangle(triangle, config, widths, {3, 5, 58, 46});
    CounterPacket counters;
    const auto kept = cull(packet, widths, counters);
    ASSERT_EQ(kept.has_value(), !expected.is_empty());
    if (!kept) continue;
    ++compared;
    ASSERT_EQ(test::values_of(to_setup_packet(expected, widths), widths),
              test::values_of(setup_packet(*kept, config, widths), widths));
  }
  EXPECT_GT(compared, 300u);
}

TEST(Hardware, EveryVisitEndsOnceWithItsLastStampAndRetiresOnce) {
  for (const Config& config : configurations()) {
    SCOPED_TRACE(label(config));
    Recorder sink;
    (void)run_scene(random_scene(5, config), config, sink);
    std::size_t stamp = 0, visits = 0, empty_ends = 0;
    for (const TilePacket& tile : sink.tiles) {
      for (bool is_last = false; !is_last; ++stamp) {
        ASSERT_LT(stamp, sink.stamps.size());
        const StampPacket& s = sink.stamps[stamp];
        is_last = !tile.is_visit || s.ends_visit;
        EXPECT_EQ(s.key.tile_x, tile.key.tile_x);
        EXPECT_EQ(s.key.tile_y, tile.key.tile_y);
        EXPECT_EQ(s.slot, tile.slot);
        EXPECT_EQ(s.ends_primitive, is_last && tile.ends_primitive);
        EXPECT_EQ(s.ends_visit, is_last && tile.is_visit);
        if (!is_last) {
          EXPECT_TRUE(s.mask.any());
        } else if (!s.mask.any()) {
          ++empty_ends;
          const int row = tile.is_visit ? tile.box.bottom / config.stamp_size : 0;
          EXPECT_EQ(s.stamp, row * derive_widths(config).stamps.stamps_per_row);
        }
      }
      if (!tile.is_visit) continue;
      ASSERT_LT(visits, sink.retired.size());
      const RetirePacket& retired = sink.retired[visits++];
      EXPECT_EQ(retired.key.tile_x, tile.key.tile_x);
      EXPECT_EQ(retired.key.tile_y, tile.key.tile_y);
      EXPECT_EQ(retired.key.primitive_id, tile.key.primitive_id);
    }
    EXPECT_EQ(stamp, sink.stamps.size());
    EXPECT_EQ(visits, sink.retired.size());
    EXPECT_GT(empty_ends, 0u) << "the case was never met";
  }
}

}  // namespace
}  // namespace halfplane::hardware_test
