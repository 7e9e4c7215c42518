// The library as outside callers use it: unchecked scenes, and frames that stay.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include "../api_case.hpp"
#include "../hardware_scene.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/target.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::library_test {
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

/// Configurations of every kind that a Target draws in: the fast path, other tiles, a mapping that is stored otherwise.
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

/// Textures, light, fog, blending and stencil, by the engine that draws packet after packet: another way altogether.
TEST(Library, ATargetDrawsRandomStatesAndTexturesAsTheScalarEngineDoes) {
  std::size_t textured = 0, stenciled = 0, lit = 0;
  for (const char* format : {"rgb565", "rgba8888"}) {
    const Config config = test::with("embedded", {{"texture.unit", "trilinear"},
                                                  {"stencil.bits", "8"},
                                                  {"fog.unit", "1"},
                                                  {"shade.unit", "1"},
                                                  {"alpha.unit", "1"},
                                                  {"blend.lanes", "4"},
                                                  {"color.format", format}});
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      const Scene scene = random_scene(config, seed, 40);
      const Rendering parts = test::by_target(scene, config), whole = render_scalar(scene, config);
      ASSERT_EQ(parts.frame.depth, whole.frame.depth) << "seed " << seed << ", " << format;
      ASSERT_EQ(parts.frame.color, whole.frame.color) << "seed " << seed << ", " << format;
      ASSERT_EQ(parts.frame.stencil, whole.frame.stencil) << "seed " << seed << ", " << format;
      for (const State& state : scene.states) {
        textured += state.texture ? 1 : 0;
        stenciled += state.stencil ? 1 : 0;
        lit += state.shade == Shade::phong ? 1 : 0;
      }
    }
  }
  EXPECT_GT(std::min({textured, stenciled, lit}), 20u) << textured << " " << stenciled << " " << lit;
}

/// A square of 4 x 2 texels on 4 x 2 pixels: each pixel shows its texel.
TEST(Library, ATargetKeepsItsTexturesAndRefusesThoseThatAreNone) {
  const auto texture = [](std::uint8_t first) {
    TexelImage image{4, 2, {}};
    for (std::uint8_t i = 0; i < 8; ++i) image.texel.push_back({static_cast<std::uint8_t>(first + i), i, 7, 255});
    return make_texture("t", image, TextureFormat::rgba8888, Mips::none);
  };
  Target target(preset("full"), 4, 2);
  const std::uint32_t number = target.add_texture(texture(10));
  EXPECT_EQ(target.add_texture(texture(50)), number + 1);
  State state;
  state.space = Space::window;
  state.depth_test = DepthFunc::always;
  state.texture_combine = TextureCombine::replace;
  std::vector<Vertex> square{{0, 0, 0.5}, {4, 0, 0.5}, {0, 2, 0.5}, {4, 2, 0.5}};
  for (Vertex& v : square) {
    v.u = v.x / 4;
    v.v = v.y / 2;
  }
  const auto shown = [&](std::uint32_t which) {
    state.texture = which;
    (void)target.draw(state, Topology::triangle_strip, square);
    std::vector<std::uint32_t> pixels(8);
    target.copy_to({pixels.data(), 16, nullptr, 0});
    return pixels;
  };
  const auto texels = [](std::uint32_t first) {  // R in the lowest byte
    std::vector<std::uint32_t> codes(8);
    for (std::uint32_t i = 0; i < 8; ++i) codes[i] = (first + i) | i << 8 | 7U << 16 | 255U << 24;
    return codes;
  };
  EXPECT_EQ(shown(number), texels(10));
  EXPECT_EQ(shown(number + 1), texels(50));
  EXPECT_EQ(shown(number), texels(10));
  target.replace_texture(number, texture(100));
  EXPECT_EQ(shown(number), texels(100));
  Texture damaged = texture(200);
  damaged.level[0].code.pop_back();
  EXPECT_THROW(target.replace_texture(number, damaged), InputError);
  EXPECT_THROW((void)target.add_texture(damaged), InputError);
  EXPECT_THROW(target.replace_texture(9, texture(1)), InputError);
  EXPECT_THROW((void)shown(2), InputError);
  EXPECT_EQ(shown(number), texels(100));
  square[0].u = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)shown(number + 1), InputError);
  square[0].u = 0;
  EXPECT_EQ(shown(number + 1), texels(50));
  EXPECT_THROW(target.set_threads(0), InputError);
}

TEST(Library, ATargetClearsItsStencilInsideTheScissor) {
  Target target(preset("embedded"), 5, 3);
  State state;
  state.scissor = Rect{1, 1, 3, 1};
  target.clear({.stencil = 9}, state);
  const Framebuffer& frame = target.frame();
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x)
      EXPECT_EQ(frame.stencil[frame.at(x, y)], y == 1 && x >= 1 && x < 4 ? 9 : 0) << x << ", " << y;
}

TEST(Library, ATargetGoesOnInTheCallersMemory) {
  for (const Config& config : target_configs()) {
    const int width = std::min(50, config.target_width), height = std::min(37, config.target_height);
    const Scene first = make_builtin("teapot", width, height, {}, 1),
                second = make_builtin("ball:3", width, height, {}, 1);
    Target whole(config, width, height, first.planes);
    (void)whole.draw(first);
    // The caller's rows are longer than the picture, and the bytes between them stay unchanged.
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
    target.clear({.depth = 1.0});  // nothing of the refused scene remains
    EXPECT_EQ(target.frame().color, before.color);
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
}  // namespace halfplane::library_test
