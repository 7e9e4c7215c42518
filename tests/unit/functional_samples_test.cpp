// Several samples a pixel on the functional engine's fast path: the scalar engine's bits of every sample, on every
// instruction set and any number of threads.
#include <gtest/gtest.h>

#include <string>

#include "model/engines/functional.hpp"
#include "model/engines/functional/frame_renderer.hpp"
#include "model/engines/functional/kernels.hpp"
#include "model/engines/scalar.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/stress/unit.hpp"

namespace halfplane::functional_samples_test {
namespace {

Config sampled(std::string_view name, int samples, std::string_view pattern = "standard") {
  Config config = preset(name);
  config.tile_size = 8;
  config.msaa_samples = samples;
  config.msaa_pattern = parse_sample_pattern(pattern);
  while (config.stamp_size * config.stamp_size * samples > 64) config.stamp_size /= 2;
  validate(config);
  return config;
}

/// Triangles of all that the fast path takes.
Scene random_triangles(const Config& config, std::uint64_t seed) {
  Config plain = config;
  plain.msaa_samples = 1;
  plain.msaa_pattern = {};
  Scene scene = random_scene(plain, seed, 60);
  stress::Random random(seed);
  for (State& state : scene.states) {
    state.stencil.reset();
    if (random.index(2) != 0)
      state = random_state(state, states_named({"sample_mask", "blend", "color_mask", "dither", "alpha_test"}),
                           chooser(random));
    state.alpha_to_coverage = false;
    state.stencil.reset();
  }
  std::erase_if(scene.commands, [&scene](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && drawn_as(scene.states[draw->state], draw->topology) == PrimitiveType::line;
  });
  return scene;
}

/// Whether a row has the same bits in both.
template <class Plane>
bool is_same_row(const Framebuffer& a, const Framebuffer& b, Plane Framebuffer::*plane, int y) {
  const auto first = [y](const Framebuffer& f) { return static_cast<std::ptrdiff_t>(f.at(0, y)); };
  const auto from = (a.*plane).begin() + first(a);
  return std::equal(from, from + a.width, (b.*plane).begin() + first(b));
}

void expect_same_images(const Framebuffer& a, const Framebuffer& b) {
  for (int y = 0; y < a.height; ++y) {
    if (is_same_row(a, b, &Framebuffer::depth, y) && is_same_row(a, b, &Framebuffer::color, y) &&
        is_same_row(a, b, &Framebuffer::stencil, y))
      continue;  // a check of each pixel takes longer than to draw it
    for (int x = 0; x < a.width; ++x) {
      ASSERT_EQ(a.depth[a.at(x, y)], b.depth[b.at(x, y)]) << x << ", " << y;
      ASSERT_EQ(a.color[a.at(x, y)], b.color[b.at(x, y)]) << x << ", " << y;
      ASSERT_EQ(a.stencil[a.at(x, y)], b.stencil[b.at(x, y)]) << x << ", " << y;
    }
  }
}

void expect_same_samples(const Framebuffer& a, const Framebuffer& b) {
  expect_same_images(a, b);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    SCOPED_TRACE("sample " + std::to_string(k));
    expect_same_images(a.samples[k], b.samples[k]);
  }
}

/// Every kernel and one and two threads against the scalar engine; then the picture alone.
void expect_scalar_bits(const Scene& scene, const Config& config) {
  const Rendering expected = render_scalar(scene, config, {});
  ASSERT_TRUE(functional::is_supported(scene, config, {}));
  FunctionalEngine engine(config);
  for (const functional::Kernels* const kernels : functional::available_kernels())
    for (const int threads : {1, 2}) {
      SCOPED_TRACE(std::string(kernels->name) + ", threads " + std::to_string(threads));
      RenderOptions options;
      options.instruction_set = kernels->name;
      options.threads = threads;
      const Rendering& all = engine.render(scene, options);
      expect_same_samples(all.frame, expected.frame);
      EXPECT_EQ(all.counters.primitives_in, expected.counters.primitives_in);
      EXPECT_EQ(all.counters.culled, expected.counters.culled);
      EXPECT_EQ(all.counters.drawn, expected.counters.drawn);
      EXPECT_EQ(all.counters.clipped, expected.counters.clipped);
      options.resolved_only = true;
      expect_same_images(engine.render(scene, options).frame, expected.frame);
      if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(FunctionalSamples, RandomScenesAreTheScalarEngines) {
  std::vector<Config> configs;
  for (const char* name : {"embedded", "full"})
    for (const int samples : {2, 4, 8}) configs.push_back(sampled(name, samples));
  configs.push_back(sampled("embedded", 4, "0.5,0.5;0.0078125,0.25;0.25,0.9921875;0.75,0.75"));
  configs.push_back(sampled("embedded", 2, "0,0;0.99609375,0.99609375"));
  std::size_t drawn = 0;
  for (const Config& config : configs)
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      SCOPED_TRACE(std::to_string(config.msaa_samples) + " samples, seed " + std::to_string(seed));
      const Scene scene = random_triangles(config, seed);
      if (!functional::is_supported(scene, config, {})) continue;
      ++drawn;
      expect_scalar_bits(scene, config);
      if (HasFatalFailure()) return;
    }
  EXPECT_GT(drawn, 100U);
}

/// Draws of many triangles of about `size` pixels, slivers among them, one or two large ones in between, each draw with
/// another depth test and other writes: triangles set up sixteen at a time, and tiles that are whole, split and whole again.
Scene small_triangles(std::uint64_t seed, double size) {
  constexpr int kWidth = 150, kHeight = 140, kDraws = 8, kOfDraw = 70;
  Scene scene = cleared_scene(kWidth, kHeight);
  stress::Random random(seed);
  const auto add_triangle = [&](double side, bool is_sliver) {
    const double x = random.between(0, kWidth), y = random.between(0, kHeight), z = random.between(-0.9, 0.9);
    for (int corner = 0; corner < 3; ++corner) {
      const double thin = is_sliver ? 0.02 : 1, along = random.between(-side, side),
                   aside = random.between(-side, side);
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back({2 * (x + along) / kWidth - 1,
                                2 * (y + (is_sliver ? along / 3 : 0) + thin * aside) / kHeight - 1,
                                z + random.between(-0.1, 0.1),
                                1,
                                {random.between(0, 255), random.between(0, 255), random.between(0, 255), 255},
                                0,
                                0});
    }
  };
  for (int draw = 0; draw < kDraws; ++draw) {
    State state;
    if (draw >= kDraws / 2) state.depth_test = static_cast<DepthFunc>(random.index(8));
    state.depth_write = random.index(4) != 0;
    state.color_write = random.index(4) != 0;
    if (random.index(3) == 0) state.sample_mask = static_cast<std::uint32_t>(random.index(256));
    if (random.index(4) == 0) state.shade = Shade::flat;
    const auto number = static_cast<std::uint32_t>(scene.states.size());
    scene.states.push_back(state);
    const std::size_t first = scene.indices.size();
    for (int i = 0; i < kOfDraw; ++i) add_triangle(i % 23 == 22 ? 80 : size, i % 7 == 6);
    scene.commands.push_back(Draw{number, 0, Topology::triangles, first, scene.indices.size() - first, 0});
  }
  validate(scene);
  return scene;
}

TEST(FunctionalSamples, SmallTrianglesAreTheScalarEngines) {
  std::vector<Config> configs;
  for (const char* name : {"embedded", "full"})
    for (const int samples : {2, 4, 8}) configs.push_back(sampled(name, samples));
  configs.push_back(sampled("embedded", 4, "0.5,0.5;0.0078125,0.25;0.25,0.9921875;0.75,0.75"));
  configs.push_back(sampled("full", 2, "0,0;0.99609375,0.99609375"));
  std::uint64_t seed = 1;
  for (const Config& config : configs)
    for (const double size : {0.7, 2.0, 5.0, 9.0}) {
      SCOPED_TRACE(std::to_string(config.msaa_samples) + " samples, seed " + std::to_string(seed));
      expect_scalar_bits(small_triangles(seed++, size), config);
      if (HasFatalFailure()) return;
    }
}

/// Large triangles one behind the other, half of them along one diagonal, a small one now and then: in tiles that they cut they
/// wait, hide each other from front, from behind and in parts, and are asked for before the end.
Scene large_triangles(std::uint64_t seed) {
  constexpr int kWidth = 150, kHeight = 140, kDraws = 8, kOfDraw = 40;
  Scene scene = cleared_scene(kWidth, kHeight);
  stress::Random random(seed);
  for (int draw = 0; draw < kDraws; ++draw) {
    State state;
    if (draw >= kDraws / 2) {
      state.depth_test = static_cast<DepthFunc>(random.index(8));
      state.depth_write = random.index(4) != 0;
      state.color_write = random.index(4) != 0;
      if (random.index(3) == 0) state.sample_mask = static_cast<std::uint32_t>(random.index(256));
    }
    const auto number = static_cast<std::uint32_t>(scene.states.size());
    scene.states.push_back(state);
    const std::size_t first = scene.indices.size(), order = random.index(3);
    for (int i = 0; i < kOfDraw; ++i) {
      const int rank = order == 0 ? i : order == 1 ? kOfDraw - 1 - i : static_cast<int>(random.index(kOfDraw));
      const double z = -0.9 + 1.8 * rank / kOfDraw, tilt = random.index(4) == 0 ? 0.3 : 0.01;
      const bool is_small = i % 13 == 12, is_half = random.index(2) == 0;
      const double x = random.between(-1, 1), y = random.between(-1, 1), size = is_small ? 0.05 : 1.2,
                   side = random.index(2) == 0 ? 1 : -1;
      for (int corner = 0; corner < 3; ++corner) {
        const double at_x = corner == 1 ? side : -side, at_y = corner == 2 ? side : -side;
        scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
        scene.vertices.push_back({is_half && !is_small ? at_x : x + size * random.between(-1, 1),
                                  is_half && !is_small ? at_y : y + size * random.between(-1, 1),
                                  z + tilt * random.between(-0.3, 0.3),
                                  1,
                                  {random.between(0, 255), random.between(0, 255), random.between(0, 255), 255},
                                  0,
                                  0});
      }
    }
    scene.commands.push_back(Draw{number, 0, Topology::triangles, first, scene.indices.size() - first, 0});
  }
  validate(scene);
  return scene;
}

TEST(FunctionalSamples, LargeTrianglesAreTheScalarEngines) {
  std::uint64_t seed = 1;
  for (const char* name : {"embedded", "full"})
    for (const int samples : {2, 4, 8})
      for (int scene = 0; scene < 4; ++scene) {
        SCOPED_TRACE(std::string(name) + ", " + std::to_string(samples) + " samples, seed " + std::to_string(seed));
        expect_scalar_bits(large_triangles(seed++), sampled(name, samples));
        if (HasFatalFailure()) return;
      }
}

TEST(FunctionalSamples, BuiltInScenesAreTheScalarEngines) {
  const Config config = sampled("embedded", 4);
  for (const char* name : {"teapot", "city", "knot", "coplanar", "slivers", "triangle", "layers", "layers_nearest",
                           "layers_linear", "layers_glass", "layers_leaves", "ball", "blocks"}) {
    SCOPED_TRACE(name);
    expect_scalar_bits(make_builtin(name, 203, 149, {}, 1), config);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace halfplane::functional_samples_test
