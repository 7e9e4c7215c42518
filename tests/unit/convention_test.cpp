// The same scene in every convention gives the same picture.
#include "sim/scene/convention.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>

#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/viewport.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::convention_test {
namespace {

constexpr const char* kStandard[] = {"d3d", "mit3dcg", "fcg:standard"};
constexpr const char* kReversed[] = {"gl:reversed", "d3d:reversed", "mit3dcg:reversed", "fcg"};

/// The differences of two pictures of one scene. Under reversed z the second picture's depth is taken as 2^B - 1 -
/// code.
struct Difference {
  int color = 0, ids = 0, depth = 0;
  std::uint32_t largest_depth = 0;  ///< LSB
};

Difference difference(const Rendering& a, const Rendering& b, bool is_reversed, int depth_bits) {
  Difference d;
  const auto top = static_cast<std::uint32_t>((std::uint64_t{1} << depth_bits) - 1);
  for (int y = 0; y < a.frame.height; ++y) {
    for (int x = 0; x < a.frame.width; ++x) {
      const std::size_t at = a.frame.at(x, y);
      const std::size_t p =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(a.frame.width) + static_cast<std::size_t>(x);
      const std::uint32_t code = is_reversed ? top - b.frame.depth[at] : b.frame.depth[at];
      const std::uint32_t lsb = std::max(code, a.frame.depth[at]) - std::min(code, a.frame.depth[at]);
      d.color += a.frame.color[at] != b.frame.color[at] ? 1 : 0;
      d.ids += a.ids[p] != b.ids[p] ? 1 : 0;
      d.depth += lsb != 0 ? 1 : 0;
      d.largest_depth = std::max(d.largest_depth, lsb);
    }
  }
  return d;
}

Rendering draw(const Scene& scene, const Config& config) {
  RenderOptions options;
  options.want_ids = true;
  return render_functional(scene, config, options);
}

/// Draws whose states already name other conventions than gl's, in any mixture.
Scene random_scene(std::uint64_t seed, Space space) {
  Random random(seed);
  Scene scene;
  scene.width = 96;
  scene.height = 61;
  const int count = 40;
  for (int i = 0; i < 3 * count; ++i) {
    const double w = random.uniform(0.5, 3);
    Vertex v{random.uniform(-20, 110), random.uniform(-20, 80), random.uniform(0, 1), w, {}, 0, 0};
    if (space == Space::clip)
      v = {random.uniform(-1.5, 1.5) * w, random.uniform(-1.5, 1.5) * w, random.uniform(-1.3, 1.3) * w, w, {}, 0, 0};
    for (double& channel : v.rgba) channel = random.uniform(0, 255);
    scene.vertices.push_back(v);
  }
  const auto pick = [&random](int n) { return static_cast<int>(random.uniform(0, n - 1e-9)); };
  scene.states.push_back({});
  scene.commands.push_back(Clear{0, std::array<double, 4>{0, 0, 60, 255}, 1.0});
  for (int i = 0; i < 12; ++i) {
    State state;
    state.space = space;
    // Not these two: a steep slope, and depths on the border between two codes, show the last bit of a cut.
    state = random_state(state, states_but({"space", "polygon_offset", "depth_range"}), chooser(random));
    if (pick(2) == 0) state.depth_range = {0.75, 0.125};
    scene.states.push_back(state);
    const auto index = static_cast<std::uint32_t>(scene.states.size() - 1);
    if (pick(4) == 0) scene.commands.push_back(Clear{index, {}, 0.625});
    const std::size_t first = scene.indices.size();
    for (int k = 0; k < 9; ++k)
      scene.indices.push_back(k == 5 ? kRestart : static_cast<std::uint32_t>(pick(3 * count)));
    scene.commands.push_back(Draw{index, 0, static_cast<Topology>(pick(7)), first, scene.indices.size() - first, 0});
  }
  return scene;
}

TEST(Convention, EveryBuiltinSceneIsTheSamePictureAndDepthInEachOfStandardOrder) {
  for (const char* preset_name : {"embedded", "full"}) {
    const Config config = preset(preset_name);
    for (const Builtin& builtin : builtin_scenes()) {
      const Scene scene = make_builtin(builtin.name, 320, 240, {}, 1);
      const Rendering gl = draw(scene, config);
      for (const char* name : kStandard) {
        const Difference d =
            difference(gl, draw(in_convention(scene, parse_convention(name)), config), false, config.depth_bits);
        EXPECT_EQ(d.color, 0) << builtin.name << " " << name << " " << preset_name;
        EXPECT_EQ(d.ids, 0) << builtin.name << " " << name << " " << preset_name;
        EXPECT_EQ(d.depth, 0) << builtin.name << " " << name << " " << preset_name;
      }
    }
  }
}

// Codes are rounded half up, which the complement turns into half down: one may move by a code against another.
TEST(Convention, UnderReversedZDepthIsTheComplementToOneCodeAndColourFollowsButForTies) {
  for (const char* preset_name : {"embedded", "full"}) {
    const Config config = preset(preset_name);
    for (const Builtin& builtin : builtin_scenes()) {
      const Scene scene = make_builtin(builtin.name, 320, 240, {}, 1);
      const Rendering gl = draw(scene, config);
      for (const char* name : kReversed) {
        const Difference d =
            difference(gl, draw(in_convention(scene, parse_convention(name)), config), true, config.depth_bits);
        if (std::string(name) == "fcg")
          std::printf("%-8s %-8s colour differs in %3d of %d pixels, depth in %5d, by %u LSB at most\n", preset_name,
                      std::string(builtin.name).c_str(), d.color, 320 * 240, d.depth, d.largest_depth);
        EXPECT_LE(d.largest_depth, 1u) << builtin.name << " " << name;
        EXPECT_LE(d.ids, builtin.name == "coplanar" ? 1000 : 8) << builtin.name << " " << name;
      }
    }
  }
}

TEST(Convention, RandomStatesInBothSpacesAreTheSamePicture) {
  const Config config = preset("embedded");
  for (const Space space : {Space::clip, Space::window}) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      const Scene scene = random_scene(seed, space);
      const Rendering gl = draw(scene, config);
      for (const char* name : kStandard) {
        const Scene restated = in_convention(scene, parse_convention(name));
        const Difference d = difference(gl, draw(restated, config), false, config.depth_bits);
        EXPECT_EQ(d.color + d.ids + d.depth, 0) << "seed " << seed << " " << name;
        for (const State& state : restated.states)
          EXPECT_EQ(state.clip_z == ClipZ::zero_one, name == std::string("d3d"));
      }
    }
  }
}

// Less and greater store the smaller and the larger of two codes: a difference of at most one stays at most one. Equal
// does not keep it.
TEST(Convention, UnderReversedZRandomStatesGiveTheComplementToOneCode) {
  const Config config = preset("embedded");
  for (const Space space : {Space::clip, Space::window}) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      Scene scene = random_scene(seed, space);
      for (State& state : scene.states) {
        if (state.depth_test == DepthFunc::equal) state.depth_test = DepthFunc::less;
        if (state.depth_test == DepthFunc::notequal) state.depth_test = DepthFunc::always;
      }
      const Rendering gl = draw(scene, config);
      for (const char* name : kReversed) {
        const Rendering restated = draw(in_convention(scene, parse_convention(name)), config);
        EXPECT_EQ(gl.counters.covered, restated.counters.covered) << "seed " << seed << " " << name;
        const Difference d = difference(gl, restated, true, config.depth_bits);
        EXPECT_LE(d.largest_depth, 1u) << "seed " << seed << " " << name;
      }
    }
  }
}

TEST(Convention, TheGoldenModelReadsEveryConventionAlike) {
  const Config config = preset("embedded");
  for (const Space space : {Space::clip, Space::window}) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      Scene scene = random_scene(seed, space);
      // Whether an edge that two outlines share passes `less` is decided by the last bit of real depths.
      for (State& state : scene.states) state.depth_test = DepthFunc::always;
      const golden::Image gl = golden::render(scene, config, golden::Precision::binary64);
      for (const char* name : kStandard) {
        const Scene restated = in_convention(scene, parse_convention(name));
        const golden::Image image = golden::render(restated, config, golden::Precision::binary64);
        EXPECT_EQ(gl.ids, image.ids) << "seed " << seed << " " << name;
        EXPECT_EQ(gl.frame.color, image.frame.color) << "seed " << seed << " " << name;
        for (std::size_t p = 0; p < gl.depth.size(); ++p)
          ASSERT_NEAR(gl.depth[p], image.depth[p], 1e-6) << "seed " << seed << " " << name << ", pixel " << p;
      }
    }
  }
}

TEST(Convention, AVertexSharedByStatesOfDifferentTermsIsRestatedForEach) {
  Scene scene = random_scene(3, Space::window);
  scene.states = {{}, {}};
  scene.states[0].space = Space::window;
  scene.vertices = {
      {0.25, 0.5, 0.5, 1, {255, 0, 0, 255}, 0, 0}, {0.75, 0.5, 0.5, 1, {}, 0, 0}, {0.25, 1, 0.5, 1, {}, 0, 0}};
  scene.indices = {0, 1, 2, 0, 1, 2};
  scene.commands = {Draw{0, 0, Topology::triangles, 0, 3, 0}, Draw{1, 0, Topology::triangles, 3, 3, 0}};
  const Scene restated = in_convention(scene, parse_convention("mit3dcg"));
  ASSERT_EQ(restated.vertices.size(), 6u);
  EXPECT_EQ(restated.vertices[0].y, scene.height - 1.0);  // 0.5 below the top edge: the centre of the top row
  EXPECT_EQ(restated.vertices[restated.indices[3]].y, 0.5);
}

TEST(Convention, TheBookOfFcgsViewportMatrixAgrees) {
  // x_pixel = nx/2 x + (nx - 1)/2, y likewise and upwards: Shirley and Marschner, section 7.1.1.
  const int nx = 40, ny = 30;
  State state;
  state.pixel_center = PixelCenter::integer;
  state.origin = Origin::bottom_left;
  state.viewport = Viewport{-0.5, -0.5, static_cast<double>(nx), static_cast<double>(ny)};
  const Viewport viewport = effective_viewport(state, nx, ny);
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {0.0, 0.0}, {0.3, -0.7}, {1.0, 1.0}}) {
    const WindowPosition clip = to_window(Vertex{x, y, 0, 1, {}, 0, 0}, state, viewport);
    const double x_pixel = nx / 2.0 * x + (nx - 1) / 2.0, y_pixel = ny / 2.0 * y + (ny - 1) / 2.0;
    const WindowPosition window = window_position(Vertex{x_pixel, y_pixel, 0, 1, {}, 0, 0}, state, ny);
    EXPECT_NEAR(clip.x, window.x, 1e-12);
    EXPECT_NEAR(clip.y, window.y, 1e-12);
  }
}

TEST(Convention, InDirect3DTheFrontFacesOfACulledSceneRunClockwise) {
  const Scene scene = make_builtin("knot", 64, 64, {}, 1), d3d = in_convention(scene, parse_convention("d3d"));
  ASSERT_EQ(scene.states[0].front, FrontFace::ccw);
  EXPECT_EQ(d3d.states[0].front, FrontFace::cw);
  EXPECT_EQ(d3d.indices[0], scene.indices[0]);
  EXPECT_EQ(d3d.indices[1], scene.indices[2]);
  EXPECT_EQ(d3d.indices[2], scene.indices[1]);
}

TEST(Convention, ReversedZClearsToZeroAlsoWhereTheSceneDoesNotClear) {
  Scene scene = make_builtin("triangle", 16, 16, {}, 1);
  scene.commands.erase(scene.commands.begin());
  const Rendering r = draw(in_convention(scene, parse_convention("fcg")), preset("embedded"));
  EXPECT_EQ(r.frame.depth[r.frame.at(0, 0)], 0u);
  EXPECT_GT(r.counters.depth_passed, 0u);
}

TEST(Convention, ACaptureInEachReadsBackAsThePictureThatItWas) {
  const Config config = preset("embedded");
  for (const char* name : {"d3d", "mit3dcg", "fcg"}) {
    const Scene scene = in_convention(random_scene(9, Space::window), parse_convention(name));
    std::ostringstream text;
    write_capture(scene, text);
    const Scene read = read_capture(text.str(), "convention.hpt");
    EXPECT_EQ(draw(scene, config).frame.color, draw(read, config).frame.color) << name;
  }
}

TEST(Convention, GlLeavesASceneAsItIs) {
  const Scene scene = random_scene(4, Space::clip);
  EXPECT_TRUE(same_scene(scene, in_convention(scene, parse_convention("gl"))));
}

TEST(Convention, ANameThatIsNoneIsRefusedWithTheList) {
  for (const char* name : {"", "vulkan", "d3d:", "d3d:backwards", "gl:standard:x"}) {
    try {
      (void)parse_convention(name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("gl, d3d, mit3dcg, fcg"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace halfplane::convention_test
