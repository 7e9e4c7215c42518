// The cycle engine without RTL: the functional engine's bits, the same cycles with and without an observer, and rules
// of monotony.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../hardware_scene.hpp"
#include "../scene_builder.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/host/primitive_stream.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane::cycle_model_test {
namespace {

using test::at;
using test::SceneBuilder;
using test::with;

CycleRendering render(const Scene& scene, const Config& config, const CycleOptions& options = {},
                      const MemorySettings& memory = {}, const RenderOptions& wanted = {}) {
  const auto timing = make_memory(memory, config);
  return render_cycle(scene, config, *timing, wanted, options);
}

Scene scene_for(std::string_view name, const Config& config) {
  return make_builtin(name, std::min(160, config.target_width), std::min(120, config.target_height), {}, 1);
}

bool takes(const Scene& scene, const Config& config) {
  try {
    check_hardware_scene(scene, config);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

struct Nobody final : TransferSink {
  std::uint64_t transfers = 0;
  void transfer(Arrow, Cycle) override { ++transfers; }
};

TEST(CycleModel, ItsBitsAreThoseOfTheFunctionalEngine) {
  int scenes = 0;
  for (const std::string_view name : preset_names())
    for (const int tile : {4, 8, 16, 32})
      for (const Builtin& builtin : builtin_scenes()) {
        Config config = preset(name);
        config.tile_size = std::max(tile, config.stamp_size);
        if (config.target_width < config.tile_size) continue;
        const Scene scene = scene_for(builtin.name, config);
        if (!takes(scene, config)) continue;
        SCOPED_TRACE(std::string(name) + ", " + std::string(builtin.name) + ", tiles of " + std::to_string(tile));
        RenderOptions wanted;
        wanted.want_count = wanted.want_ids = true;
        const Rendering expected = render_functional(scene, config, wanted);
        const Rendering cycle = render(scene, config, {}, {}, wanted).rendering;
        EXPECT_EQ(cycle.frame.depth, expected.frame.depth);
        EXPECT_EQ(cycle.frame.color, expected.frame.color);
        EXPECT_EQ(cycle.ids, expected.ids);
        EXPECT_EQ(cycle.counters.depth_passed, expected.counters.depth_passed);
        EXPECT_EQ(cycle.counters.written, expected.counters.written);
        EXPECT_EQ(cycle.counters.drawn, expected.counters.drawn);
        wanted = {};  // neither needs every stamp's samples one by one
        wanted.threads = 2;
        const Rendering alone = render(scene, config, {}, {}, wanted).rendering;
        EXPECT_EQ(alone.frame.depth, expected.frame.depth);
        EXPECT_EQ(alone.frame.color, expected.frame.color);
        EXPECT_EQ(alone.counters.covered, cycle.counters.covered);
        EXPECT_EQ(alone.counters.depth_passed, expected.counters.depth_passed);
        EXPECT_EQ(alone.counters.written, expected.counters.written);
        EXPECT_EQ(alone.counters.skipped.tiles_hiz, cycle.counters.skipped.tiles_hiz);
        ++scenes;
      }
  EXPECT_GT(scenes, 100);
}

TEST(CycleModel, WithoutHizItCountsEveryCoveredSample) {
  Config config = preset("embedded");
  config.hiz_bits = 0;
  const Scene scene = scene_for("city", config);
  RenderOptions wanted;
  wanted.want_count = true;
  EXPECT_EQ(render(scene, config, {}, {}, wanted).rendering.count, render_functional(scene, config, wanted).count);
}

// Without an observer, whole bursts are one step.
TEST(CycleModel, TheCyclesAreTheSameWhetherOrNotSomebodyLooksOn) {
  std::vector<Config> configs;
  for (const std::string_view name : preset_names()) configs.push_back(preset(name));
  for (const char* bits : {"16", "256"}) configs.push_back(with("embedded", {{"memory.port_bits", bits}}));
  for (const Config& config : configs)
    for (const Builtin& builtin : builtin_scenes()) {
      const Scene scene = scene_for(builtin.name, config);
      if (!takes(scene, config)) continue;
      SCOPED_TRACE(label(config) + ", " + std::string(builtin.name));
      Nobody sink;
      CycleOptions watched;
      watched.sink = &sink;
      const CycleRun a = render(scene, config).run, b = render(scene, config, watched).run;
      EXPECT_EQ(a.cycles, b.cycles);
      EXPECT_EQ(a.raster_cycles, b.raster_cycles);
      EXPECT_EQ(a.tile_cycles, b.tile_cycles);
      EXPECT_EQ(a.totals.memory_cycles, b.totals.memory_cycles);
      for (std::size_t arrow = 0; arrow < kArrows; ++arrow) {
        EXPECT_EQ(a.use[arrow].busy, b.use[arrow].busy) << arrow;
        EXPECT_EQ(a.use[arrow].stalled, b.use[arrow].stalled) << arrow;
      }
      EXPECT_GT(sink.transfers, 100u);
    }
}

// A max-plus recurrence: more room can delay nothing.
TEST(CycleModel, ADeeperQueueIsNeverSlower) {
  const Config config = preset("embedded");
  std::set<std::string> helped;
  for (const char* name : {"city", "teapot:6", "wires"}) {
    const Scene scene = scene_for(name, config);
    for (const char* key : {"queue.triangle", "queue.setup", "queue.tile", "queue.stamp", "queue.fragment"}) {
      const TimingSetting& setting = *find_timing_setting(key);
      Cycle before = ~0ULL, first = 0;
      for (const int items : {2, 3, 4, 8, 16, 64}) {
        CycleOptions options;
        options.parameters.*setting.member = items;
        const Cycle cycles = render(scene, config, options).run.cycles;
        EXPECT_LE(cycles, before) << name << ", " << key << " " << items;
        before = cycles;
        if (first == 0) first = cycles;
      }
      if (before < first) helped.insert(key);
    }
  }
  // A queue upstream of the bottleneck helps in some scene.
  for (const char* key : {"queue.stamp", "queue.fragment"}) EXPECT_EQ(helped.count(key), 1u) << key;
}

TEST(CycleModel, AFasterMemoryIsNeverSlower) {
  const Config config = preset("embedded");
  const Scene scene = scene_for("city", config);
  Cycle before = 0;
  for (const int latency : {1, 2, 5, 8, 30, 200}) {
    const Cycle cycles = render(scene, config, {}, {MemoryKind::fixed, latency, 50}).run.cycles;
    EXPECT_GT(cycles, before);
    before = cycles;
  }
}

/// Everything that a run measures.
void expect_equal(const CycleRendering& a, const CycleRendering& b) {
  EXPECT_EQ(a.rendering.frame.depth, b.rendering.frame.depth);
  EXPECT_EQ(a.rendering.frame.color, b.rendering.frame.color);
  EXPECT_EQ(a.rendering.counters.covered, b.rendering.counters.covered);
  EXPECT_EQ(a.rendering.counters.texture.fills, b.rendering.counters.texture.fills);
  EXPECT_EQ(a.run.cycles, b.run.cycles);
  EXPECT_EQ(a.run.raster_cycles, b.run.raster_cycles);
  EXPECT_EQ(a.run.tile_cycles, b.run.tile_cycles);
  EXPECT_EQ(a.run.totals.works, b.run.totals.works);
  EXPECT_EQ(a.run.totals.beats, b.run.totals.beats);
  EXPECT_EQ(a.run.totals.texel_beats, b.run.totals.texel_beats);
  for (const Arrow arrow : kElastic) {
    EXPECT_EQ(a.run.use[index(arrow)].busy, b.run.use[index(arrow)].busy) << info(arrow).name;
    EXPECT_EQ(a.run.use[index(arrow)].stalled, b.run.use[index(arrow)].stalled) << info(arrow).name;
  }
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.misses, b.misses);
}

// Long enough that the ring of batches is full, and all kinds of steps are in it.
TEST(CycleModel, TimesOnAThreadOfTheirOwnAreTheSame) {
  const Config sampled = with("embedded", {{"msaa.samples", "4"},
                                           {"compress.unit", "1"},
                                           {"alpha.unit", "1"},
                                           {"blend.lanes", "4"},
                                           {"cache.lines", "16"}});
  const Config textured = with("embedded", {{"texture.unit", "trilinear"}});
  for (const auto& [config, scene] : {std::pair{preset("embedded"), "city"},
                                      {preset("small"), "knot"},
                                      {preset("full"), "teapot"},
                                      {sampled, "city"},
                                      {sampled, "wires"},
                                      {textured, "ball_linear"}}) {
    SCOPED_TRACE(scene);
    CycleOptions options;
    options.want_cost = options.want_misses = true;
    RenderOptions one, two;
    two.threads = 2;
    const Scene drawn =
        make_builtin(scene, config.target_width < 320 ? 160 : 320, config.target_width < 320 ? 120 : 240, {}, 1);
    const CycleRendering alone = render(drawn, config, options, {}, one);
    expect_equal(alone, render(drawn, config, options, {}, two));
    Nobody nobody;  // bits and times, primitive by primitive
    options.sink = &nobody;
    expect_equal(alone, render(drawn, config, options, {}, two));
  }
}

TEST(CycleModel, AnErrorEndsTheThreadOfTheTimes) {
  struct Full final : MemoryTiming {
    int bursts = 0;
    [[nodiscard]] Cycle room() const override { return 0; }
    BurstAnswer accept(const MemoryBurst&, Cycle cycle) override {
      if (++bursts == 1000) throw InputError("full");
      return {cycle + 8};
    }
  };
  const Config config = preset("embedded");
  const Scene scene = make_builtin("city", 320, 240, {}, 1);
  RenderOptions wanted;
  wanted.threads = 2;
  Full memory;
  EXPECT_THROW((void)render_cycle(scene, config, memory, wanted), InputError);
  wanted.progress = [](double) { throw InputError("stopped"); };
  EXPECT_THROW((void)render(scene, config, {}, {}, wanted), InputError);
}

/// A memory of which nothing is known but its answers.
class AskedMemory final : public MemoryTiming {
 public:
  explicit AskedMemory(const Config& config) : memory_(make_memory({}, config)) {}
  [[nodiscard]] Cycle room() const override { return memory_->room(); }
  BurstAnswer accept(const MemoryBurst& burst, Cycle cycle) override { return memory_->accept(burst, cycle); }

 private:
  std::unique_ptr<MemoryTiming> memory_;
};

TEST(CycleModel, AnIdealMemoryAnswersWithoutBeingAskedAsItWould) {
  using Setting = std::pair<const char*, const char*>;
  for (const Setting& setting : {Setting{"memory.port_bits", "32"}, Setting{"memory.port_bits", "64"},
                                 Setting{"memory.port_bits", "128"}, Setting{"setup.kind", "serial"}}) {
    const Config config = with("embedded", {setting});
    for (const std::string_view name : {"city", "layers_glass"}) {
      SCOPED_TRACE(std::string(name) + ' ' + setting.first + '=' + setting.second);
      const Scene scene = scene_for(name, config);
      if (!takes(scene, config)) continue;
      AskedMemory asked(config);
      const CycleRun expected = render_cycle(scene, config, asked).run, run = render(scene, config).run;
      EXPECT_EQ(run.cycles, expected.cycles);
      EXPECT_EQ(run.totals.memory_cycles, expected.totals.memory_cycles);
      EXPECT_EQ(run.totals.beats, expected.totals.beats);
      for (const Arrow arrow : kElastic) {
        EXPECT_EQ(run.use[index(arrow)].busy, expected.use[index(arrow)].busy);
        EXPECT_EQ(run.use[index(arrow)].stalled, expected.use[index(arrow)].stalled);
      }
    }
  }
}

TEST(CycleModel, PlainTrianglesAreThoseOfTheHostsLongWay) {
  const Config config = preset("embedded");
  for (const std::string_view name : {"city", "teapot", "layers"}) {
    SCOPED_TRACE(name);
    const Scene plain = scene_for(name, config);
    Scene offset = plain;
    for (State& state : offset.states) state.polygon_offset = {0, 0.25};  // of a code: it is rounded to none
    HostStream stream(plain, config), expected(offset, config);
    std::size_t triangles = 0;
    for (;;) {
      const HostPrimitive* const one = stream.pull();
      const auto other = expected.next();
      ASSERT_EQ(one == nullptr, !other);
      if (one == nullptr) break;
      const auto parts = [](const HostPrimitive& host) {
        const PrimitivePacket& p = host.packet;
        return std::tuple(p.kind, p.primitive_id, p.vertex.x, p.vertex.y, p.vertex.code, p.state.depth_test,
                          p.state.depth_write, p.state.color_write, p.box.left, p.box.top, p.box.right, p.box.bottom,
                          p.cull, p.front_cw, host.primitive, host.command, host.units.colors.ops);
      };
      EXPECT_TRUE(parts(*one) == parts(*other)) << "primitive " << one->primitive;
      triangles += one->packet.kind == PrimitiveKind::triangle ? 1 : 0;
    }
    EXPECT_GT(triangles, 0U);
    EXPECT_EQ(stream.counters().primitives_in, expected.counters().primitives_in);
    EXPECT_EQ(stream.counters().culled, expected.counters().culled);
    EXPECT_EQ(stream.counters().pairs, expected.counters().pairs);
  }
}

TEST(CycleModel, StallsCostCyclesAndNoBits) {
  const Config config = preset("embedded");
  const Scene scene = scene_for("teapot:6", config);
  CycleOptions options;
  options.stalls = {3, stall_threshold(0.3)};
  const CycleRendering plain = render(scene, config), stalled = render(scene, config, options);
  EXPECT_GT(stalled.run.cycles, plain.run.cycles);
  EXPECT_EQ(stalled.rendering.frame.color, plain.rendering.frame.color);
  EXPECT_EQ(stalled.rendering.counters.skipped.tiles_hiz, plain.rendering.counters.skipped.tiles_hiz);
}

TEST(CycleModel, ParametersThatNoHardwareHasAreRefused) {
  const auto refuses = [](const Config& config, int TimingParameters::*member, int value) {
    CycleOptions options;
    options.parameters.*member = value;
    const auto memory = make_memory({}, config);
    EXPECT_THROW((void)make_cycle_model(config, *memory, options), InputError);
  };
  refuses(preset("embedded"), &TimingParameters::stamp_queue, 0);
  refuses(preset("embedded"), &TimingParameters::divide_bits, 0);
  refuses(preset("small"), &TimingParameters::tile_queue, 4);
}

TEST(CycleModel, RulesThatAreSwitchedOffChangeCyclesAndNoBits) {
  const Config config = preset("embedded");
  const Scene scene = scene_for("city", config);
  const CycleRendering plain = render(scene, config);
  for (const auto& [member, value] : {std::pair{&TimingParameters::rejects, 0},
                                      {&TimingParameters::fast_clear, 0},
                                      {&TimingParameters::untested_tiles, 64}}) {
    CycleOptions options;
    options.parameters.*member = value;
    const CycleRendering other = render(scene, config, options);
    EXPECT_NE(other.run.cycles, plain.run.cycles);
    EXPECT_EQ(other.rendering.frame.color, plain.rendering.frame.color);
    EXPECT_EQ(other.rendering.frame.depth, plain.rendering.frame.depth);
  }
}

// A clear that is drawn is stored as it is, whatever the draw before it does with colours.
TEST(CycleModel, ADrawnClearIsNotBlended) {
  State state = SceneBuilder::window_state();
  state.alpha_test = {DepthFunc::less, 1};
  state.blend = {BlendFactor::zero, BlendFactor::one, BlendFactor::zero, BlendFactor::one};
  state.color_mask = {true, false, false, true};
  SceneBuilder builder(32, 32, state);
  builder.triangle(at(2, 2), at(30, 2), at(2, 30));
  builder.scene.commands.push_back(Clear{0, std::array<double, 4>{10, 20, 30, 255}, 0.25});
  const Config config = with("embedded", {{"blend.lanes", "4"}, {"alpha.unit", "1"}, {"color.format", "rgba8888"}});
  CycleOptions drawn;
  drawn.parameters.fast_clear = 0;
  const CycleRendering fast = render(builder.scene, config), slow = render(builder.scene, config, drawn);
  EXPECT_NE(slow.run.cycles, fast.run.cycles);
  EXPECT_EQ(slow.rendering.frame.color, fast.rendering.frame.color);
  EXPECT_EQ(slow.rendering.frame.depth, fast.rendering.frame.depth);
}

/// A scene at 640x480, `embedded`, an ideal memory of 64 bits, latency 8: a frame from the first clear to the last write of
/// the flush. Bounds: thousand cycles, and KB of traffic.
struct WholeFrame {
  const char* scene;
  std::uint64_t cycles, bytes;
};

void expect_bounds(const Config& config, std::initializer_list<WholeFrame> bounds) {
  for (const WholeFrame& bound : bounds) {
    const Scene scene = make_builtin(bound.scene, 640, 480, {}, 1);
    const CycleRun run = render(scene, config).run;
    const std::uint64_t bytes = traffic(run, config).total();
    EXPECT_LE(run.cycles, bound.cycles * 1000) << bound.scene;
    EXPECT_LE(bytes, bound.bytes * 1024) << bound.scene;
  }
}

TEST(WholeFrames, TakeNoMoreCyclesAndBytesThanTheirBounds) {
  expect_bounds(
      with("embedded", {{"frame.clears", "flags"}}),
      {{"teapot", 128, 674}, {"city", 125, 951}, {"ball", 820, 1050}, {"knot", 159, 518}, {"walk", 188, 1417}});
}

TEST(WholeFrames, InBinsTakeNoMoreCyclesAndBytesThanTheirBounds) {
  expect_bounds(with("embedded", {{"frame.clears", "flags"}, {"frame.order", "bins"}, {"frame.store", "color"}}),
                {{"teapot", 112, 179}, {"city", 79, 186}, {"ball", 363, 348}, {"knot", 93, 239}, {"walk", 127, 650}});
}

// 16 bits are a quarter of the bandwidth.
TEST(WholeFrames, TakeNoMoreCyclesThanTheirBoundsOnANarrowPort) {
  const MemorySettings slow{MemoryKind::fixed, 12, 50};
  const Config config = with("embedded", {{"frame.clears", "flags"}, {"memory.port_bits", "16"}});
  const Config bins =
      with("embedded",
           {{"frame.clears", "flags"}, {"memory.port_bits", "16"}, {"frame.order", "bins"}, {"frame.store", "color"}});
  for (const auto& [name, in_order, in_bins] : {std::tuple{"teapot", 360U, 158U},
                                                {"city", 480U, 122U},
                                                {"ball", 1110U, 380U},
                                                {"knot", 292U, 135U},
                                                {"walk", 710U, 336U}}) {
    const Scene scene = make_builtin(name, 640, 480, {}, 1);
    EXPECT_LE(render(scene, config, {}, slow).run.cycles, in_order * 1000U) << name;
    EXPECT_LE(render(scene, bins, {}, slow).run.cycles, in_bins * 1000U) << name;
  }
}

TEST(WholeFrames, OfTilesTakeNoMoreCyclesAndBytesThanTheirBounds) {  // 16 of them on the chip
  expect_bounds(
      with("embedded", {{"frame.clears", "flags"}, {"cache.kind", "tiles"}, {"cache.lines", "16"}}),
      {{"teapot", 338, 1160}, {"city", 348, 1325}, {"ball", 846, 2060}, {"knot", 266, 890}, {"walk", 426, 1555}});
}

/// A quad over the whole target: a clear, two triangles, a flush.
double cycles_per_pixel_of_a_quad(const Config& config) {
  SceneBuilder builder(640, 480);
  builder.triangle(at(0, 0), at(640, 0), at(0, 480)).triangle(at(640, 0), at(640, 480), at(0, 480));
  return static_cast<double>(render(builder.scene, config).run.cycles) / (640 * 480);
}

TEST(WholeFrames, AFullScreenQuadTakesAtMost55HundredthsOfACyclePerPixelAnd28InBins) {
  EXPECT_LE(cycles_per_pixel_of_a_quad(with("embedded", {{"frame.clears", "flags"}})), 0.55);
  EXPECT_LE(cycles_per_pixel_of_a_quad(
                with("embedded", {{"frame.clears", "flags"}, {"frame.order", "bins"}, {"frame.store", "color"}})),
            0.28);
}

TEST(WholeFrames, TheRecommendedOrderIsTheFasterOfTheTwo) {
  const Hardware hardware{with("embedded", {{"frame.clears", "flags"}}), {}, {}};
  const auto orders = try_orders(make_builtin("city", 320, 240, {}, 1), hardware, {}, {});
  ASSERT_EQ(orders.size(), 3u);
  EXPECT_LT(orders[1].cycles, orders[0].cycles);
  EXPECT_LT(orders[1].bytes, orders[0].bytes);
  EXPECT_LT(orders[2].bytes, orders[1].bytes);
  EXPECT_EQ(recommended(orders), "bins");
  EXPECT_EQ(recommended({{"program", "all", 100, 20}, {"bins", "all", 100, 20}}), "program");
  EXPECT_EQ(recommended({{"program", "all", 100, 20}, {"bins", "all", 100, 19}}), "bins");
  EXPECT_EQ(recommended({{"program", "all", 100, 20}, {"bins", "all", 101, 1}}), "program");
  EXPECT_TRUE(try_orders(make_builtin("city", 64, 48, {}, 1), {preset("small"), {}, {}}, {}, {}).empty());
}

TEST(WholeFrames, OneTriangleOfOnePixelTakesAtMost10000CyclesAndResolved80000) {
  SceneBuilder builder(640, 480);
  builder.triangle(at(100.25, 100.25), at(101, 100.25), at(100.25, 101));
  EXPECT_LE(render(builder.scene, with("embedded", {{"frame.clears", "flags"}})).run.cycles, 10'000u);
  EXPECT_LE(render(builder.scene, with("embedded", {{"frame.clears", "resolve"}})).run.cycles, 80'000u);
}

}  // namespace
}  // namespace halfplane::cycle_model_test
