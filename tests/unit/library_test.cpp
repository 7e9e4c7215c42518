// The library as strangers call it: scenes that nobody has checked, and frames that stay.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include "../api_case.hpp"
#include "model/engines/target.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {
namespace {

/// As many inputs as HALFPLANE_API_INPUTS says, for the sanitizers: ./dev test --preset asan-ubsan -R AnyScene
TEST(Library, AnySceneGivesAPictureOrOneLine) {
  constexpr std::uint64_t kSeed = 20;
  const char* wanted = std::getenv("HALFPLANE_API_INPUTS");
  const int inputs = wanted == nullptr ? 6000 : std::atoi(wanted);
  Random random(kSeed);
  int drawn = 0;
  for (int n = 0; n < inputs; ++n) {
    std::vector<std::uint8_t> bytes(60 + random.next() % 360);  // a state alone takes one for each row of the table
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    const test::ApiCase input = test::api_case(bytes);
    ASSERT_EQ(test::api_fault(input), "") << "seed " << kSeed << ", input " << n << ", " << label(input.config);
    try {
      drawn += render_functional(input.scene, input.config).counters.written > 0 ? 1 : 0;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(drawn, inputs / 10) << "of " << inputs << ": the inputs are too wild to say much";
}

Scene triangle() {
  Scene scene;
  scene.name = "mine";
  scene.width = 32;
  scene.height = 24;
  scene.states.emplace_back().space = Space::window;
  scene.vertices = {
      {2, 2, 0.25, 1, {255, 0, 0, 255}}, {30, 4, 0.5, 1, {0, 255, 0, 255}}, {8, 22, 0.75, 1, {0, 0, 255, 255}}};
  scene.indices = {0, 1, 2};
  scene.commands.emplace_back(Draw{.count = 3});
  return scene;
}

std::string refusal(const std::function<void(Scene&)>& change) {
  Scene scene = triangle();
  change(scene);
  try {
    validate(scene);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Library, ValidateNamesWhatIsWrongAndWhere) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal([](Scene&) {}), "");
  EXPECT_EQ(refusal([](Scene& s) { s.indices[1] = 7; }), "mine: draw 0: index 7, but there are 3 vertices");
  EXPECT_EQ(refusal([](Scene& s) { std::get<Draw>(s.commands[0]).count = 6; }),
            "mine: draw 0: indices 0 and 6 more, but there are 3");
  EXPECT_NE(refusal([](Scene& s) { std::get<Draw>(s.commands[0]).first = ~std::size_t{0}; }), "");
  EXPECT_EQ(refusal([](Scene& s) { std::get<Draw>(s.commands[0]).state = 1; }), "mine: draw 0: state 1 of 1");
  EXPECT_EQ(refusal([](Scene& s) { std::get<Draw>(s.commands[0]).object = 2; }), "mine: draw 0: object 2 of 1");
  EXPECT_EQ(refusal([](Scene& s) {
              std::get<Draw>(s.commands[0]).line = 9;
              s.indices[0] = 4;
            }),
            "mine: draw from line 9: index 4, but there are 3 vertices");
  EXPECT_EQ(refusal([&](Scene& s) { s.vertices[2].y = nan; }),
            "mine: vertex 2 has a coordinate that is no finite number");
  EXPECT_NE(refusal([&](Scene& s) { s.vertices[0].u = nan; }), "");
  EXPECT_EQ(refusal([](Scene& s) { s.vertices[1].rgba[2] = 256; }),
            "mine: vertex 1 has a colour component outside 0...255");
  EXPECT_EQ(refusal([](Scene& s) { s.width = 0; }), "mine: a target of 0x24; give 1x1 to 16384x16384 pixels");
  EXPECT_NE(refusal([](Scene& s) { s.planes = {2.0, 1.0}; }), "");
  EXPECT_NE(refusal([](Scene& s) { s.states[0].cull = static_cast<Cull>(9); }), "");
  EXPECT_NE(refusal([](Scene& s) { s.states[0].viewport = Viewport{0, 0, 0, 5}; }), "");
  EXPECT_NE(refusal([](Scene& s) { s.commands.emplace_back(Clear{.color = {{0, 0, -1, 0}}}); }), "");
  EXPECT_NE(refusal([](Scene& s) { s.commands.emplace_back(Clear{.depth = 1.5}); }), "");
  EXPECT_EQ(refusal([](Scene& s) { s.indices = {0, kRestart, 2}; }), "");
  EXPECT_EQ(refusal([](Scene& s) { s.vertices[0].x = 1e300; }), "") << "a finite number: others judge its size";
  EXPECT_EQ(refusal([](Scene& s) { s.planes = {0.1, std::numeric_limits<double>::infinity()}; }), "");
}

/// Of every kind that a Target draws in: the fast path, other tiles, a mapping that is stored otherwise.
std::vector<Config> target_configs() {
  std::vector<Config> configs{preset("tiny"), preset("embedded"), preset("full")};
  set(configs.emplace_back(preset("embedded")), "tile.size", "16");
  set(configs.emplace_back(preset("embedded")), "depth.format", "uf4.12");
  return configs;
}

TEST(Library, ATargetDrawnCommandByCommandIsTheSceneDrawnAtOnce) {
  for (const Config& config : target_configs())
    for (const char* name : {"teapot", "city:20", "wires", "layers:4"}) {
      const int width = std::min(96, config.target_width), height = std::min(64, config.target_height);
      const Scene scene = make_builtin(name, width, height, {}, 1);
      const Rendering whole = render_functional(scene, config);
      const Rendering parts = test::by_target(scene, config);
      EXPECT_EQ(whole.frame.depth, parts.frame.depth) << name << ", " << label(config);
      EXPECT_EQ(whole.frame.color, parts.frame.color) << name << ", " << label(config);
      EXPECT_EQ(whole.counters.written, parts.counters.written) << name << ", " << label(config);
      Target target(config, width, height, scene.planes);
      (void)target.draw(scene);
      EXPECT_EQ(whole.frame.color, target.frame().color) << name << ", " << label(config);
    }
}

TEST(Library, ATargetGoesOnInTheCallersMemory) {
  for (const Config& config : target_configs()) {
    const int width = std::min(50, config.target_width), height = std::min(37, config.target_height);
    const Scene first = make_builtin("teapot", width, height, {}, 1),
                second = make_builtin("ball:3", width, height, {}, 1);
    Target whole(config, width, height, first.planes);
    (void)whole.draw(first);
    // Rows of the caller's are longer than the picture, and what is between them stays.
    const std::size_t bytes = config.color_format == ColorFormat::rgb565 ? 2 : 4, pitch = bytes * 60;
    std::vector<std::uint8_t> color(pitch * static_cast<std::size_t>(height), 0xa5);
    std::vector<std::uint32_t> depth(53 * static_cast<std::size_t>(height), 77);
    const PixelMemory memory{color.data(), pitch, depth.data(), std::size_t{53} * 4};
    whole.copy_to(memory);
    EXPECT_EQ(color[bytes * static_cast<std::size_t>(width)], 0xa5);
    EXPECT_EQ(depth[static_cast<std::size_t>(width)], 77u);
    Target other(config, width, height, first.planes);
    other.copy_from(memory);
    EXPECT_EQ(other.frame().depth, whole.frame().depth) << label(config);
    EXPECT_EQ(other.frame().color, whole.frame().color) << label(config);
    if (second.planes == first.planes) {
      (void)whole.draw(second);
      (void)other.draw(second);
    }
    Clear clear{.depth = 0.25};
    State state;
    state.scissor = Rect{3, 3, 9, 9};
    whole.clear(clear, state);
    other.clear(clear, state);
    EXPECT_EQ(other.frame().depth, whole.frame().depth) << label(config);
    EXPECT_EQ(other.frame().color, whole.frame().color) << label(config);
  }
}

TEST(Library, ARefusedDrawLeavesTheTargetAsItWas) {
  const Scene scene = triangle();
  for (const Config& config : target_configs()) {
    Target target(config, std::min(32, config.target_width), std::min(24, config.target_height));
    target.clear({.color = {{9, 99, 199, 255}}});
    const Framebuffer before = target.frame();
    std::vector<Vertex> vertices = scene.vertices;
    const std::vector<std::uint32_t> beyond{0, 1, 3};
    EXPECT_THROW((void)target.draw(scene.states[0], Topology::triangles, vertices, beyond), InputError);
    vertices[1].x = 1e9;
    EXPECT_THROW((void)target.draw(scene.states[0], Topology::triangles, vertices), InputError);
    EXPECT_EQ(target.frame().color, before.color);
    EXPECT_EQ(target.frame().depth, before.depth);
    EXPECT_GT(target.draw(scene.states[0], Topology::triangles, std::span(scene.vertices)).written, 0u);
    EXPECT_NE(target.frame().color, before.color);
  }
}

TEST(Library, ATargetRefusesMemoryThatItsRowsDoNotFit) {
  Target target(preset("full"), 10, 4);
  std::vector<std::uint32_t> color(40), depth(40, ~0U);
  EXPECT_THROW(target.copy_to({color.data(), 39, nullptr, 0}), InputError);
  EXPECT_THROW(target.copy_to({color.data(), 42, nullptr, 0}), InputError);
  EXPECT_THROW(target.copy_to({nullptr, 0, depth.data(), 36}), InputError);
  EXPECT_THROW(target.copy_from({nullptr, 0, depth.data(), 40}), InputError) << "codes of more bits than the depth has";
  target.copy_to({color.data(), 40, depth.data(), 40});
  EXPECT_EQ(depth[39], (1U << preset("full").depth_bits) - 1);
  EXPECT_THROW((void)target.draw(triangle()), InputError) << "made for another size";
  EXPECT_THROW(Target(preset("tiny"), 5000, 5), InputError);
}

}  // namespace
}  // namespace halfplane
