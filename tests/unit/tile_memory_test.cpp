// The blocks beside the pipeline of the hardware model: HiZ, tile cache, memory, and the stream of primitives from the host.
#include <gtest/gtest.h>

#include <algorithm>

#include "../hardware_scene.hpp"
#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/stages/hiz.hpp"
#include "model/stages/memory_port.hpp"
#include "model/stages/tile_directory.hpp"

namespace halfplane::tile_memory_test {
namespace {

using test::at;
using test::Recorder;
using test::run_scene;
using test::SceneBuilder;
using test::with;

/// Two window-space triangles that fill the target.
void fill_target(SceneBuilder& builder, double z) {
  const double w = builder.scene.width, h = builder.scene.height;
  builder.triangle(at(0, 0, z), at(w, 0, z), at(0, h, z));
  builder.triangle(at(w, 0, z), at(w, h, z), at(0, h, z));
}

TEST(Hiz, FrontToBackSceneSkipsTilesAndShowsTheSameImage) {
  State state = SceneBuilder::window_state();
  state.depth_test = DepthFunc::less;
  SceneBuilder builder(96, 96, state);
  for (int layer = 1; layer <= 8; ++layer) fill_target(builder, 0.1 * layer);
  const Config config = preset("embedded");
  const Rendering expected = render_scalar(builder.scene, config), hardware = render_hardware(builder.scene, config);
  EXPECT_EQ(hardware.frame.depth, expected.frame.depth);
  EXPECT_EQ(hardware.frame.color, expected.frame.color);
  EXPECT_EQ(hardware.counters.written, 96u * 96u);
  // The tiles on the diagonal are never covered by one triangle alone: their bound stays where the clear put it.
  EXPECT_EQ(hardware.counters.skipped.tiles_hiz, 7u * 2u * 66u);
  EXPECT_LT(hardware.counters.covered, expected.counters.covered / 3);
}

TEST(Hiz, BoundOfATileFollowsTheDepthsInIt) {
  const Config config = with("embedded", {{"hiz.bits", "8"}});
  const Widths widths = derive_widths(config);
  Hiz hiz(config, widths);
  EXPECT_EQ(hiz.bound(3, 2), 65535u);
  hiz.clear(5, 5, 0x1234);
  EXPECT_EQ(hiz.bound(3, 2), 0x12FFu);
  const auto visit = [&hiz, &config](const RetirePacket& retired) {
    for (int n = 0; n < config.hiz_lag; ++n) {  // other visits retire later, elsewhere
      hiz.begin_visit({DepthFunc::less, true, true});
      hiz.retire(n == 0 ? retired : RetirePacket{});
    }
  };
  visit({{0, 3, 2}, HizUpdate::none, 0});
  EXPECT_EQ(hiz.bound(3, 2), 0x12FFu);
  visit({{0, 3, 2}, HizUpdate::set, 0x05});
  EXPECT_EQ(hiz.bound(3, 2), 0x05FFu);
  EXPECT_EQ(hiz.bound(2, 3), 0x12FFu);
  SetupPacket setup;
  setup.range.low[kDepthPlane] = 0x05FF;
  setup.state.depth_test = DepthFunc::less;
  EXPECT_TRUE(hiz.rejects(setup, 3, 2));
  setup.state.depth_test = DepthFunc::lequal;
  EXPECT_FALSE(hiz.rejects(setup, 3, 2));
  setup.range.low[kDepthPlane] = 0x0600;
  EXPECT_TRUE(hiz.rejects(setup, 3, 2));
  visit({{0, 3, 2}, HizUpdate::clear, 0xFF});
  EXPECT_FALSE(hiz.rejects(setup, 3, 2));
}

TEST(Hiz, AVisitSeesTheUpdatesOfTheVisitsUpToItsOwnNumberLessTheLag) {
  for (const char* lag : {"2", "4", "16"}) {
    const Config config = with("embedded", {{"hiz.lag", lag}});
    const Widths widths = derive_widths(config);
    Hiz hiz(config, widths);
    hiz.clear(5, 5, 0xFFFF);
    const auto visit = [&hiz](std::uint16_t x, DepthFunc func, std::uint32_t code) {
      hiz.begin_visit({func, true, true});
      hiz.retire({{0, x, 0}, HizUpdate::set, code});
    };
    SetupPacket far;
    far.range.low[kDepthPlane] = 0xFFFF;
    far.state.depth_test = DepthFunc::less;
    EXPECT_TRUE(hiz.rejects(far, 0, 0)) << "nothing is farther than the clear";
    visit(1, DepthFunc::less, 0x100);
    for (int n = 1; n < config.hiz_lag; ++n) {
      EXPECT_EQ(hiz.bound(1, 0), 0xFFFFu) << lag << ", " << n << " visits later";
      visit(2, DepthFunc::less, 0x200);
    }
    EXPECT_EQ(hiz.bound(1, 0), 0x100u);
    EXPECT_EQ(hiz.bound(2, 0), 0xFFFFu);
    // Until the update of a visit that may raise a depth is seen, no tile is hidden.
    visit(3, DepthFunc::always, 0x300);
    for (int n = 1; n < config.hiz_lag; ++n) {
      EXPECT_FALSE(hiz.rejects(far, 1, 0)) << lag << ", " << n << " visits later";
      visit(2, DepthFunc::less, 0x200);
    }
    EXPECT_TRUE(hiz.rejects(far, 1, 0));
    EXPECT_EQ(hiz.bound(3, 0), 0x300u);
    // A clear follows all earlier visits, even visits without a result so far.
    visit(4, DepthFunc::always, 0x400);
    hiz.clear(5, 5, 0x8000);
    EXPECT_TRUE(hiz.rejects(far, 4, 0));
    for (int n = 0; n < config.hiz_lag; ++n) visit(2, DepthFunc::less, 0x200);
    EXPECT_EQ(hiz.bound(4, 0), 0x8000u);
    EXPECT_EQ(hiz.bound(2, 0), 0x200u);
  }
}

TEST(Hiz, DepthThatCanRiseTakesTheBoundAway) {
  // A near wall, then one test that raises part of a tile, then something between: it must be seen.
  for (const DepthFunc raising : {DepthFunc::greater, DepthFunc::gequal, DepthFunc::notequal, DepthFunc::always}) {
    State state = SceneBuilder::window_state();
    state.depth_test = DepthFunc::less;
    SceneBuilder builder(64, 64, state);
    fill_target(builder, 0.2);
    state.depth_test = raising;
    builder.with_state(state).triangle(at(1, 1, 0.9), at(30, 2, 0.9), at(3, 33, 0.9));
    state.depth_test = DepthFunc::less;
    builder.with_state(state);
    fill_target(builder, 0.5);
    const Config config = preset("embedded");
    EXPECT_EQ(render_hardware(builder.scene, config).frame.depth, render_functional(builder.scene, config).frame.depth);
  }
}

/// `embedded` with a cache of `lines` tiles of 16 stamps.
Config tiles(const char* lines, const char* clears = "resolve") {
  return with("embedded", {{"cache.lines", lines}, {"cache.kind", "tiles"}, {"frame.clears", clears}});
}

/// Requests of a plane, by whether they write.
std::size_t count(const Recorder& sink, TilePlane plane, bool is_write) {
  return static_cast<std::size_t>(std::ranges::count_if(sink.requests, [&](const MemoryRequest& request) {
    return request.plane == plane && (request.is_write != 0) == is_write;
  }));
}

TEST(TileCache, FastClearedSceneThatFitsReadsNoMemory) {
  SceneBuilder builder(32, 32);  // 4 x 4 tiles, 16 lines
  for (int n = 0; n < 5; ++n) fill_target(builder, 0.1 * n);
  Recorder sink;
  const CounterPacket counters = run_scene(builder.scene, tiles("16"), sink);
  for (const MemoryRequest& request : sink.requests) EXPECT_EQ(request.is_write, 1);
  EXPECT_EQ(count(sink, TilePlane::depth, true), 32u * 32u / 4) << "each stamp of each plane is written once";
  EXPECT_EQ(count(sink, TilePlane::color, true), 32u * 32u / 4);
  EXPECT_EQ(count(sink, TilePlane::depth_flags, true), 4u) << "a word for each row of tiles";
  EXPECT_EQ(counters.tile_fills, 0u);
  EXPECT_EQ(counters.tile_clears, 32u * 32u / 4);
  EXPECT_EQ(counters.tile_evictions, 2u * 32u * 32u / 4);
}

TEST(TileCache, OfATileThatNobodyTouchesAFlushWritesTheColourOrNothing) {
  SceneBuilder builder(64, 8);
  builder.triangle(at(1, 1), at(7, 1), at(1, 7));
  for (const char* clears : {"resolve", "flags"}) {
    Recorder sink;
    const CounterPacket counters = run_scene(builder.scene, tiles("16", clears), sink);
    const bool resolves = std::string_view(clears) == "resolve";
    EXPECT_EQ(counters.tile_clears, 16u);
    EXPECT_EQ(counters.tile_evictions, 32u + (resolves ? 7u * 16u : 0u));
    ASSERT_EQ(sink.requests.size(), 32u + 1u + (resolves ? 7u * 16u : 1u));
    for (std::size_t n = 0; n < 32; ++n) {  // the dirty line, depth before colour
      EXPECT_EQ(sink.requests[n].tile_x, 0);
      EXPECT_EQ(sink.requests[n].plane, n < 16 ? TilePlane::depth : TilePlane::color);
      EXPECT_EQ(sink.requests[n].stamp, n % 16);
    }
    const std::uint64_t flags = ~std::uint64_t{1};  // flags of all tiles of the word but the first
    EXPECT_EQ(sink.requests[32].plane, TilePlane::depth_flags);
    EXPECT_EQ(flag_word(sink.requests[32], derive_widths(tiles("16"))), flags);
    if (!resolves) {
      EXPECT_EQ(sink.requests[33].plane, TilePlane::color_flags);
      EXPECT_EQ(flag_word(sink.requests[33], derive_widths(tiles("16"))), flags);
      continue;
    }
    for (std::size_t n = 33; n < sink.requests.size(); ++n) {
      EXPECT_EQ(sink.requests[n].tile_x, (n - 33) / 16 + 1);
      EXPECT_EQ(sink.requests[n].plane, TilePlane::color);
    }
  }
}

TEST(TileCache, SecondReadOfATileIsAHit) {
  // Two tiles that share a line take it from each other; staying in one costs nothing.
  const auto fills = [](std::initializer_list<double> xs) {
    SceneBuilder builder(64, 8);
    for (const double x : xs) builder.triangle(at(x + 1, 1), at(x + 7, 1), at(x + 1, 7));
    Recorder sink;
    const CounterPacket counters = run_scene(builder.scene, tiles("1"), sink);
    EXPECT_EQ(16 * count(sink, TilePlane::depth, false), counters.tile_fills) << "one request for all stamps";
    EXPECT_EQ(count(sink, TilePlane::color, false), 0u) << "nobody reads colours";
    return counters.tile_fills;
  };
  EXPECT_EQ(fills({0, 0, 0}), 0u);
  EXPECT_EQ(fills({0, 8}), 0u);
  EXPECT_EQ(fills({0, 8, 0}), 16u);
  EXPECT_EQ(fills({0, 8, 0, 0, 8}), 32u);
}

TEST(TileCache, PlaneThatNobodyWroteIsNotWrittenBack) {
  State state = SceneBuilder::window_state();
  state.depth_write = false;
  SceneBuilder builder(16, 8, state);
  for (const double x : {0.0, 8.0, 0.0}) builder.triangle(at(x + 1, 1), at(x + 7, 1), at(x + 1, 7));
  Recorder sink;
  const CounterPacket counters = run_scene(builder.scene, tiles("1"), sink);
  EXPECT_EQ(count(sink, TilePlane::depth, true), 0u);
  EXPECT_EQ(counters.tile_fills, 0u) << "the flag of depth stays";
  EXPECT_EQ(counters.tile_clears, 3u * 16u);
}

TEST(TileCache, OnlySamplesThatWereWrittenGoToMemoryAgain) {
  SceneBuilder builder(64, 8);
  // The first tile, one that takes its line from it, and the first again: one pixel of it.
  for (const double x : {0.0, 8.0, 0.0}) builder.triangle(at(x + 4, 2), at(x + 5.2, 2), at(x + 4, 3.2));
  Recorder sink;
  (void)run_scene(builder.scene, tiles("1", "flags"), sink);
  for (const TilePlane plane : {TilePlane::depth, TilePlane::color}) {
    EXPECT_EQ(count(sink, plane, true), 16u + 16u + 1u);
    const auto last =
        std::ranges::find_if(sink.requests.rbegin(), sink.requests.rend(),
                             [plane](const MemoryRequest& r) { return r.is_write != 0 && r.plane == plane; });
    EXPECT_EQ(last->strobe.bits(), 1u);
    EXPECT_EQ(last->stamp, 6);
    EXPECT_EQ(last->data[1], 0u);
  }
}

TEST(TileCache, ClearOfOnePlaneKeepsTheOther) {
  SceneBuilder builder(40, 40);
  fill_target(builder, 0.5);
  builder.scene.commands.push_back(Clear{0, std::nullopt, 0.25});
  builder.triangle(at(1, 1, 0.75, {255, 0, 0, 255}), at(20, 1, 0.75, {255, 0, 0, 255}),
                   at(1, 30, 0.75, {255, 0, 0, 255}));
  builder.scene.commands.push_back(Clear{0, std::array<double, 4>{0, 255, 0, 255}, std::nullopt});
  for (const char* lines : {"1", "4", "64"})
    for (const char* clears : {"flags", "resolve"}) {
      const Config config = tiles(lines, clears);
      const Rendering expected = render_functional(builder.scene, config),
                      hardware = render_hardware(builder.scene, config);
      EXPECT_EQ(hardware.frame.depth, expected.frame.depth) << lines << clears;
      EXPECT_EQ(hardware.frame.color, expected.frame.color) << lines << clears;
    }
}

/// `embedded` with a cache of `lines` blocks of 4x4 pixels.
Config blocks(const char* lines, const char* clears = "flags") {
  return with("embedded", {{"cache.kind", "blocks"}, {"cache.lines", lines}, {"frame.clears", clears}});
}

TEST(BlockCache, AFragmentOnAClearedTargetReadsNothingAndWritesItsBlock) {
  SceneBuilder builder(64, 8);  // 16 x 2 blocks
  builder.triangle(at(1, 1), at(3, 1), at(1, 3));
  Recorder sink;
  const CounterPacket counters = run_scene(builder.scene, blocks("16"), sink);
  EXPECT_EQ(count(sink, TilePlane::depth, false), 0u);
  EXPECT_EQ(count(sink, TilePlane::depth, true), 4u) << "memory was garbage: all four stamps of the block";
  EXPECT_EQ(count(sink, TilePlane::color, true), 4u);
  EXPECT_EQ(count(sink, TilePlane::depth_flags, true), 2u) << "a word for each row of blocks";
  EXPECT_EQ(count(sink, TilePlane::color_flags, true), 2u);
  EXPECT_EQ(counters.tile_evictions, 8u);
  for (const MemoryRequest& request : sink.requests) {
    if (request.plane != TilePlane::depth_flags) continue;
    const std::uint64_t word = flag_word(request, derive_widths(blocks("16")));
    EXPECT_EQ(word, request.stamp == 0 ? 0xFFFEu : 0xFFFFu) << "of 16 blocks the first has been drawn into";
  }
}

TEST(BlockCache, AResolvedTargetHasEveryColourInMemory) {
  SceneBuilder builder(64, 8);
  builder.triangle(at(1, 1), at(3, 1), at(1, 3));
  Recorder sink;
  const CounterPacket counters = run_scene(builder.scene, blocks("16", "resolve"), sink);
  EXPECT_EQ(count(sink, TilePlane::color, true), 64u * 8u / 4u);
  EXPECT_EQ(count(sink, TilePlane::color_flags, true), 0u);
  EXPECT_EQ(count(sink, TilePlane::depth, true), 4u) << "nobody reads the depths of what is cleared";
  EXPECT_EQ(counters.tile_evictions, 64u * 8u / 4u + 4u);
}

TEST(BlockCache, OnlySamplesThatWereWrittenGoToMemoryAgain) {
  SceneBuilder builder(64, 4);
  // The first block, one that takes its line from it, and the first again: one pixel of it.
  for (const double x : {0.0, 4.0, 0.0}) builder.triangle(at(x, 0), at(x + 1.2, 0), at(x, 1.2));
  Recorder sink;
  (void)run_scene(builder.scene, blocks("1"), sink);
  EXPECT_EQ(count(sink, TilePlane::depth, false), 1u) << "the stamp that is tested";
  EXPECT_EQ(count(sink, TilePlane::color, false), 0u) << "nobody reads colours";
  EXPECT_EQ(count(sink, TilePlane::color, true), 4u + 4u + 1u);
  const auto last = std::ranges::find_if(sink.requests.rbegin(), sink.requests.rend(),
                                         [](const MemoryRequest& r) { return r.plane == TilePlane::color; });
  EXPECT_EQ(last->strobe.bits(), 1u);
}

TEST(BlockCache, AFullStampThatAlwaysPassesReadsNoDepth) {
  for (const DepthFunc func : {DepthFunc::always, DepthFunc::lequal}) {
    State state = SceneBuilder::window_state();
    state.depth_test = func;
    SceneBuilder builder(64, 4);
    for (const int x : {0, 4, 0}) {
      state.scissor = Rect{x, 0, 4, 4};
      builder.with_state(state).triangle(at(x, 0), at(x + 40, 0), at(x, 40));
    }
    Recorder sink;
    (void)run_scene(builder.scene, blocks("1"), sink);
    EXPECT_EQ(count(sink, TilePlane::depth, false), func == DepthFunc::always ? 0u : 4u);
  }
}

TEST(BlockCache, ABlockOnItsWayToMemoryIsWrittenBeforeItIsReadAgain) {
  // Two blocks that share the only line, in turns, with a deeper surface each time: a stale depth would show.
  State state = SceneBuilder::window_state();
  state.depth_test = DepthFunc::greater;
  SceneBuilder builder(8, 4, state);
  builder.scene.commands.push_back(Clear{0, std::nullopt, 0.0});
  for (int n = 1; n < 20; ++n)
    builder.triangle(at(n % 2 * 4, 0, 0.04 * n), at(n % 2 * 4 + 4, 0, 0.04 * n), at(n % 2 * 4, 4, 0.04 * n));
  for (const std::string_view victims : {"2", "8"}) {
    Config config = blocks("1");
    set(config, "cache.victims", victims);
    const Rendering expected = render_functional(builder.scene, config),
                    hardware = render_hardware(builder.scene, config);
    EXPECT_EQ(hardware.frame.depth, expected.frame.depth);
    EXPECT_EQ(hardware.frame.color, expected.frame.color);
  }
}

TEST(BlockCache, ClearOfOnePlaneKeepsTheOther) {
  SceneBuilder builder(40, 40);
  fill_target(builder, 0.5);
  builder.scene.commands.push_back(Clear{0, std::nullopt, 0.25});
  builder.triangle(at(1, 1, 0.75, {255, 0, 0, 255}), at(20, 1, 0.75, {255, 0, 0, 255}),
                   at(1, 30, 0.75, {255, 0, 0, 255}));
  builder.scene.commands.push_back(Clear{0, std::array<double, 4>{0, 255, 0, 255}, std::nullopt});
  for (const char* lines : {"1", "4", "64"})
    for (const char* clears : {"flags", "resolve"}) {
      const Config config = blocks(lines, clears);
      const Rendering expected = render_functional(builder.scene, config),
                      hardware = render_hardware(builder.scene, config);
      EXPECT_EQ(hardware.frame.depth, expected.frame.depth) << lines;
      EXPECT_EQ(hardware.frame.color, expected.frame.color) << lines;
    }
}

TEST(BlockCache, AStampOfABlockIsFoundByItsTileAndBack) {
  for (const char* stamp : {"1", "2", "4", "8"})
    for (const char* tile : {"8", "16"}) {
      const Config config =
          with("embedded", {{"stamp.size", stamp}, {"tile.size", tile}, {"plane.local_guard_bits", "8"}});
      const Widths widths = derive_widths(config);
      for (int n = 0; n < widths.stamps.stamps(); ++n) {
        const StampAddress at{3, 2, static_cast<std::uint16_t>(n)};
        const BlockStamp place = block_stamp(at, widths);
        const StampAddress back = stamp_address(place, widths);
        EXPECT_EQ(back.tile_x, at.tile_x);
        EXPECT_EQ(back.tile_y, at.tile_y);
        EXPECT_EQ(back.stamp, at.stamp);
        const PixelOffset first = widths.stamps.origin_of(n);
        const int side = std::max(4, config.stamp_size);
        EXPECT_EQ(place.block.x, (3 * config.tile_size + first.x) / side);
        EXPECT_EQ(place.block.y, (2 * config.tile_size + first.y) / side);
      }
    }
}

TEST(TileMemory, ReadsBackWhatWasWrittenAndGarbageElsewhere) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  TileMemory memory(config);
  MemoryBeat beat;
  beat.is_write = true;
  beat.address = byte_address(TilePlane::color, 2, 3, 5, memory.layout(), widths);
  beat.strobe = 0b11110011;  // not sample 1
  for (std::size_t n = 0; n < 8; ++n) beat.data[n] = static_cast<std::uint8_t>(n + 1);
  memory.write(beat);
  std::array<std::uint32_t, 64> back{};
  memory.read(TilePlane::color, 2, 3, 5, back);
  const auto garbage = [](std::uint32_t address) {
    return std::uint32_t{memory_garbage(address)} | std::uint32_t{memory_garbage(address + 1)} << 8;
  };
  EXPECT_EQ(back[0], 0x0201u);
  EXPECT_EQ(back[1], garbage(beat.address + 2));
  EXPECT_EQ(back[2], 0x0605u);
  EXPECT_EQ(back[3], 0x0807u);
  MemoryBeat::Bytes bytes{};
  memory.read(beat.address, bytes);
  EXPECT_EQ(bytes[7], 8);
  EXPECT_EQ(bytes[2], memory_garbage(beat.address + 2));
  memory.read(TilePlane::depth, 0, 0, 0, back);
  EXPECT_EQ(back[0], garbage(0));
  EXPECT_NE(garbage(0), garbage(2));
  EXPECT_FALSE(memory.page(beat.address / TileMemory::kPage).empty());
  EXPECT_TRUE(memory.page(0).empty());
  EXPECT_TRUE(memory.has(beat));
  beat.address = ~0U - 7;
  EXPECT_FALSE(memory.has(beat));
}

TEST(HostStream, BeginsWithAClearOfBothPlanesAndEndsWithAFlush) {
  SceneBuilder builder(20, 10);
  builder.scene.commands.clear();
  builder.scene.commands.push_back(EndFrame{});
  State scissored = SceneBuilder::window_state();
  scissored.scissor = Rect{5, 2, 100, 3};
  builder.with_state(scissored);
  builder.scene.commands.push_back(Clear{1, std::nullopt, 1.0});
  builder.scene.commands.push_back(Clear{0, std::array<double, 4>{255, 1, 2, 3}, std::nullopt});
  builder.scene.commands.push_back(Clear{0, std::nullopt, std::nullopt});
  builder.triangle(at(1, 1), at(1, 1), at(1, 1));  // a triangle without area, which hardware drops
  HostStream host(builder.scene, preset("embedded"));
  auto p = host.next();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->packet.kind, PrimitiveKind::fast_clear);
  EXPECT_EQ(p->packet.vertex.code[2][kDepthPlane], 65535u);
  EXPECT_EQ(color_channels(p->packet.vertex.code[0]), (std::array<std::uint32_t, 4>{0, 0, 0, 0}));
  EXPECT_EQ(p->packet.box.right, 19);
  EXPECT_TRUE(p->packet.state.depth_write && p->packet.state.color_write);
  p = host.next();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->packet.kind, PrimitiveKind::rectangle);
  EXPECT_EQ(p->packet.box.left, 5);
  EXPECT_EQ(p->packet.box.right, 19);
  EXPECT_EQ(p->packet.box.bottom, 4);
  EXPECT_FALSE(p->packet.state.color_write);
  EXPECT_EQ(p->command, 1u);
  p = host.next();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->packet.kind, PrimitiveKind::fast_clear);
  EXPECT_EQ(color_channels(p->packet.vertex.code[1]), (std::array<std::uint32_t, 4>{255, 1, 2, 0}));
  EXPECT_FALSE(p->packet.state.depth_write);
  p = host.next();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->packet.kind, PrimitiveKind::triangle);
  EXPECT_EQ(p->packet.box.left, 5) << "the scissor rides along";
  p = host.next();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->packet.kind, PrimitiveKind::flush);
  EXPECT_EQ(p->command, HostPrimitive::kNoCommand);
  EXPECT_FALSE(host.next());
  EXPECT_FALSE(host.next());
}

TEST(HostStream, DrawIntoAnEmptyRectangleSendsNothing) {
  State state = SceneBuilder::window_state();
  state.scissor = Rect{30, 0, 5, 5};
  SceneBuilder builder(20, 10, state);
  builder.triangle(at(1, 1), at(9, 1), at(1, 9));
  HostStream host(builder.scene, preset("embedded"));
  std::size_t triangles = 0;
  while (const auto p = host.next()) triangles += p->packet.kind == PrimitiveKind::triangle ? 1 : 0;
  EXPECT_EQ(triangles, 0u);
  EXPECT_EQ(host.counters().culled, 1u);
}

TEST(HostStream, NumberOfATriangleDoesNotWrapWhereItsKeyDoes) {
  const Config config = with("embedded", {{"key.primitive_bits", "4"}});
  SceneBuilder builder(20, 10);
  for (int n = 0; n < 20; ++n) builder.triangle(at(1, 1), at(9, 1), at(1, 9));
  HostStream host(builder.scene, config);
  std::uint32_t expected = 0;
  while (const auto p = host.next()) {
    if (p->packet.kind != PrimitiveKind::triangle) continue;
    EXPECT_EQ(p->primitive, expected);
    EXPECT_EQ(p->packet.primitive_id, expected % 16);
    ++expected;
  }
  EXPECT_EQ(expected, 20u);
}

TEST(HostStream, RefusesWhatTheHardwareDoesNotHave) {
  State state = SceneBuilder::window_state();
  state.color_interp = ColorInterp::perspective;
  SceneBuilder builder(20, 10, state);
  builder.triangle(at(1, 1), at(9, 1), at(1, 9));
  EXPECT_THROW((void)render_hardware(builder.scene, preset("embedded")), InputError);
}

}  // namespace
}  // namespace halfplane::tile_memory_test
