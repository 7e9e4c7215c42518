// Frames as the driver collects them: the drawn scene equals the saved scene, whatever the program looks at on the way.
#include "gl/core/frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>

#include "gl/core/commands.hpp"
#include "gl/core/context.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::gl::frame_test {
namespace {

constexpr int kWidth = 70, kHeight = 52;

/// A folder of this test's own, removed with its content.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::path(::testing::TempDir()) /
              (std::string("gl_frame_") + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

Options options_of(const std::string& config = "embedded") {
  Options options;
  options.config = labelled(config);
  return options;
}

Options saving(const Folder& folder, const std::string& config = "embedded") {
  Options options = options_of(config);
  options.save_all = true;
  options.save_to = folder.file("");
  options.results = folder.file("results");
  return options;
}

std::vector<nlohmann::json> results_of(const Options& options) {
  std::vector<nlohmann::json> rows;
  std::ifstream in(options.results);
  for (std::string line; std::getline(in, line);) rows.push_back(nlohmann::json::parse(line));
  return rows;
}

/// The capture of the frame that ended last.
Scene last_capture(const Folder& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("")))
    if (entry.path().extension() == ".hpt") paths.push_back(entry.path());
  if (paths.empty()) return {};
  return read_capture_file(std::ranges::max(paths).string());
}

void expect_same(const Framebuffer& a, const Framebuffer& b, const std::string& where) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  int colors = 0, depths = 0, stencils = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      colors += a.color[a.at(x, y)] != b.color[b.at(x, y)];
      depths += a.depth[a.at(x, y)] != b.depth[b.at(x, y)];
      stencils += a.stencil[a.at(x, y)] != b.stencil[b.at(x, y)];
    }
  EXPECT_EQ(colors, 0) << where;
  EXPECT_EQ(depths, 0) << where;
  EXPECT_EQ(stencils, 0) << where;
}

const Clear kClear{0, {{10, 20, 30, 255}}, 1.0, std::uint8_t{0}};

halfplane::State clip_state() {
  halfplane::State state;
  state.provoking = Provoking::last;
  return state;
}

Vertex vertex_at(double x, double y, double z, int i) {
  return {x, y, z, 1, {37.0 * i, 255 - 21.0 * i, 90, 200}, 0.3 * i, 0.2 * i * i};
}

/// A fan of `count` triangles' worth of vertices about the middle.
std::vector<Vertex> ring(int count, double radius, double z) {
  std::vector<Vertex> vertices{vertex_at(0, 0, z, 0)};
  for (int i = 0; i <= count; ++i) {
    const double angle = 6.283185307179586 * i / count;
    vertices.push_back(vertex_at(radius * std::cos(angle), radius * std::sin(angle), z, i % 6));
  }
  return vertices;
}

std::vector<std::uint32_t> counted(std::size_t count) {
  std::vector<std::uint32_t> indices(count);
  for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<std::uint32_t>(i);
  return indices;
}

halfplane::Texture chequer(int side) {
  return make_texture("any", pattern_image(TexturePattern::grid, side, side), TextureFormat::rgba8888, Mips::box);
}

/// A ring drawn by every topology, with a texture and a blend.
void draw_some(Frame& frame, double z) {
  halfplane::State state = clip_state();
  const std::vector<Vertex> vertices = ring(6, 0.8, z);
  const std::vector<std::uint32_t> all = counted(vertices.size());
  frame.draw(state, Topology::triangle_fan, vertices, all);
  state.texture = frame.texture(1, [] { return chequer(16); });
  state.texture_mag = TextureMag::linear;
  frame.draw(state, Topology::triangle_strip, ring(3, 0.5, z - 0.1), counted(5));
  state.texture.reset();
  state.blend =
      BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one, BlendFactor::zero};
  for (int i = 0; i < 3; ++i) frame.draw(state, Topology::triangles, ring(2, 0.3 + 0.1 * i, z - 0.2), counted(3));
  frame.draw(state, Topology::line_strip, vertices, all);
  frame.draw(state, Topology::line_strip, vertices, all);
  frame.draw(state, Topology::points, vertices, all);
}

TEST(GlFrame, TheSavedCaptureIsThePicture) {
  const Folder folder;
  const Options options = saving(folder);
  Frame frame(options, kWidth, kHeight);
  frame.clear({}, kClear);
  draw_some(frame, 0.5);
  const Framebuffer picture = frame.picture();
  frame.end();
  expect_same(render_functional(last_capture(folder), options.config).frame, picture, "capture");
  const auto rows = results_of(options);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_FALSE(rows[0]["goes_on"]);
  EXPECT_EQ(rows[0]["primitives"]["in"], 6 + 3 + 3 + 2 * 7 + 8);
  EXPECT_EQ(rows[0]["draws"], 5);  // draws of one state and topology are one
  EXPECT_EQ(rows[0]["textures"], 1);
}

TEST(GlFrame, LooksOnTheWayChangeNothing) {
  const Folder folder;
  const Options options = saving(folder, "full stencil.bits=8");
  Frame looked(options, kWidth, kHeight), plain(options_of("full stencil.bits=8"), kWidth, kHeight);
  for (int i = 0; i < 3; ++i) {
    for (Frame* frame : {&looked, &plain}) {
      if (i == 0) frame->clear({}, kClear);
      halfplane::State part;
      part.scissor = Rect{5, 5, 30, 20};
      frame->clear(part, {0, {{200, 0, 0, 255}}, 0.9, {}});
      if (frame == &looked) (void)frame->picture();
      draw_some(*frame, 0.6 - 0.1 * i);
      if (frame == &looked) (void)frame->samples_passed();
      halfplane::State marked = clip_state();
      marked.stencil = Stencil{.reference = 3, .passes = StencilOp::incr};
      marked.texture = frame->texture(1, [] { return chequer(16); });
      frame->draw(marked, Topology::triangles, ring(5, 0.7, 0.0), counted(6));
      draw_some(*frame, 0.4 - 0.1 * i);
    }
    expect_same(looked.picture(), plain.picture(), "looked");
    EXPECT_EQ(looked.samples_passed(), plain.samples_passed());
    const Framebuffer picture = looked.picture();
    looked.end();
    plain.end();
    expect_same(render_functional(last_capture(folder), options.config).frame, picture, "frame " + std::to_string(i));
  }
  EXPECT_TRUE(results_of(options).back()["goes_on"]);
}

TEST(GlFrame, AFrameThatGoesOnIsSavedWithThePictureBefore) {
  for (const char* config : {"embedded", "full stencil.bits=8"}) {
    const Folder folder;
    const Options options = saving(folder, config);
    Frame frame(options, 1030, 77);  // more than one rectangle
    frame.clear({}, kClear);
    draw_some(frame, 0.5);
    frame.end();
    frame.clear({}, {0, {}, 0.75, {}});  // the depth alone
    draw_some(frame, 0.2);
    const Framebuffer picture = frame.picture();
    frame.end();
    expect_same(render_functional(last_capture(folder), options.config).frame, picture, config);
  }
}

TEST(GlFrame, BadDrawsAreDroppedAlone) {
  const Options options = options_of();
  Frame good(options, kWidth, kHeight), bad(options, kWidth, kHeight);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  // Cut where it is nearly at the eye, and no pixel is exact.
  const std::vector<Vertex> cut{{-1e6, 0, 0, 1e-9}, {1e6, 0, 0, 1e-9}, {0, 1e6, 0, 1}};
  for (Frame* frame : {&good, &bad}) {
    const bool is_bad = frame == &bad;
    frame->clear({}, {0, {{10, 20, 30, 255}}, 1.0, {}});
    draw_some(*frame, 0.5);
    std::vector<Vertex> mixed = ring(4, 0.9, 0.1);
    const std::vector<std::uint32_t> first{0, 1, 2}, list{0, 1, 2, 0, 2, 6, 0, 1, 99};
    if (is_bad) {
      for (const double value : {kNan, kInf, -kInf, 1e301, 1e40}) {
        std::vector<Vertex> broken = ring(2, 0.5, 0);
        broken[1].x = value;
        frame->draw(clip_state(), Topology::triangle_strip, broken, counted(3));
        frame->draw(clip_state(), Topology::lines, broken, counted(2));
      }
      halfplane::State window;
      window.space = Space::window;
      frame->draw(window, Topology::triangles, std::vector<Vertex>{{0, 0, 0}, {1e5, 0, 0}, {0, 1e5, 0}}, counted(3));
      window.color_interp = ColorInterp::perspective;
      frame->draw(window, Topology::lines, std::vector<Vertex>{{0, 0, 0}, {10, 0, 0}}, counted(2));
      window = {};
      window.texture = 77;
      frame->draw(window, Topology::triangles, std::vector<Vertex>(3), counted(3));
      frame->draw(clip_state(), Topology::triangles, mixed, list);  // an index beyond the vertices
      frame->draw(clip_state(), Topology::triangles, cut, counted(3));
      (void)frame->picture();
      frame->draw(clip_state(), Topology::triangles, cut, counted(3));
      mixed.insert(mixed.end(), cut.begin(), cut.end());
      const std::vector<std::uint32_t> with_cut{0, 1, 2, 6, 7, 8};
      frame->draw(clip_state(), Topology::triangles, mixed, with_cut);
    } else {
      frame->draw(clip_state(), Topology::triangles, mixed, first);
    }
    frame->draw(clip_state(), Topology::triangles, ring(3, 0.2, -0.1), first);
  }
  expect_same(bad.picture(), good.picture(), "bad");
  EXPECT_EQ(bad.samples_passed(), good.samples_passed());
  bad.end();
  good.end();
  draw_some(bad, 0.0);
  draw_some(good, 0.0);
  expect_same(bad.picture(), good.picture(), "the frame after it");
}

/// Any states, topologies and coordinates, looks on the way, frames that go on: every capture is its picture. And so is what a
/// frame shows that nobody looks at, which is drawn while the next one is collected.
TEST(GlFrame, WhateverIsDrawnIsWhatIsSaved) {
  std::mt19937_64 random(11);
  const Chooser choose = chooser(random);
  const auto one_in = [&](std::uint32_t n) { return choose(n) == 0; };
  const StateRows rows = states_but({"texture"});
  const auto coordinate = [&](bool is_window) -> double {
    constexpr std::array kOdd{0.0,
                              1e5,
                              -1e12,
                              1e40,
                              1e303,
                              std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()};
    if (one_in(40)) return kOdd[choose(kOdd.size())];
    return is_window ? choose(900) / 10.0 - 10 : choose(400) / 100.0 - 2;
  };
  for (const char* config :
       {"embedded", "full stencil.bits=8", "tiny target.width=80 target.height=60 guard.band=128"}) {
    const Folder folder;
    const Options options = saving(folder, config);
    Framebuffer shown, last;  // written until `beside` ends
    Frame frame(options, kWidth, kHeight), beside(options_of(config), kWidth, kHeight);
    shown = last = frame.picture();
    for (int number = 0; number < 40; ++number) {
      const std::uint32_t commands = choose(12);
      for (std::uint32_t i = 0; i < commands; ++i) {
        halfplane::State state;
        for (int n = one_in(3) ? 0 : 3; n > 0; --n) {  // a few states that are not the default, or many
          const DrawState& row = *rows[choose(static_cast<std::uint32_t>(rows.size()))];
          row.set(state, random_value(row, choose));
        }
        if (one_in(6)) state = random_state(state, rows, choose);
        if (i == 0 || one_in(4)) {
          Clear clear;
          if (!one_in(4)) clear.color = {{coordinate(true), 50, 100, 255}};
          if (!one_in(4)) clear.depth = one_in(2) ? 1.0 : coordinate(false);
          if (!one_in(4)) clear.stencil = static_cast<std::uint8_t>(choose(3));
          const halfplane::State region = one_in(3) ? state : halfplane::State{};
          frame.clear(region, clear);
          beside.clear(region, clear);
        }
        const auto key = one_in(3) ? std::optional(choose(4)) : std::nullopt;
        const bool is_window = state.space == Space::window;
        std::vector<Vertex> vertices(1 + choose(12));
        for (Vertex& v : vertices)
          v = {coordinate(is_window),
               coordinate(is_window),
               is_window ? choose(11) / 10.0 : coordinate(false),
               one_in(3) ? coordinate(false) : 1.0,
               {coordinate(true), choose(256) * 1.0, 0, choose(256) * 1.0},
               coordinate(false),
               coordinate(false)};
        std::vector<std::uint32_t> indices(choose(20));
        for (std::uint32_t& index : indices)
          index = one_in(20) ? kRestart : choose(static_cast<std::uint32_t>(vertices.size()));
        const auto topology = static_cast<Topology>(choose(7));
        for (Frame* to : {&frame, &beside}) {
          if (key) state.texture = to->texture(*key, [] { return chequer(8); });
          to->draw(state, topology, vertices, indices);
        }
        if (one_in(8)) (void)frame.picture();
        if (one_in(8)) (void)frame.samples_passed();
      }
      const Framebuffer picture = frame.picture();
      frame.end();
      const Scene saved = last_capture(folder);
      expect_same(render_functional(saved, options.config).frame, picture,
                  std::string(config) + ", frame " + std::to_string(number) + " of " + folder.file(""));
      beside.wait();
      expect_same(shown, last, std::string(config) + ", shown before frame " + std::to_string(number));
      last = picture;
      beside.end([&shown](const Framebuffer& its) { shown = its; });
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(GlFrame, TexturesAreMadeOnceAndKeptWhileTheyAreUsed) {
  Frame frame(options_of(), kWidth, kHeight);
  int made = 0;
  const auto use = [&](std::uint64_t key) {
    halfplane::State state = clip_state();
    state.texture = frame.texture(key, [&made] {
      ++made;
      return chequer(8);
    });
    frame.draw(state, Topology::triangle_fan, ring(4, 0.5, 0.5), counted(5));
  };
  for (int i = 0; i < 5; ++i) {
    use(1);
    use(2);
    (void)frame.picture();
    use(1);
    frame.end();
  }
  EXPECT_EQ(made, 2);
  for (int i = 0; i < 100; ++i) {
    use(1);
    frame.end();
  }
  EXPECT_EQ(made, 2);
  use(2);  // it was dropped
  EXPECT_EQ(made, 3);
  const auto broken = [] { return halfplane::Texture{}; };
  EXPECT_NO_THROW((void)frame.texture(9, broken));
  EXPECT_NO_THROW((void)frame.picture());
}

TEST(GlFrame, CyclesAreMeasuredWhereTheHardwareDrawsIt) {
  const Folder folder;
  Options options = saving(folder, "textured");
  options.save_all = false;
  options.cycles = true;
  options.memory = "sdram";
  options.mhz = 100;
  options.first_frame = 0;
  Frame frame(options, kWidth, kHeight);
  frame.clear({}, kClear);
  frame.draw(clip_state(), Topology::triangle_fan, ring(6, 0.8, 0.5), counted(8));
  frame.end();
  frame.clear({}, kClear);
  draw_some(frame, 0.5);  // it blends
  frame.end();
  const auto rows = results_of(options);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_GT(rows[0]["cycles"], 1000);
  EXPECT_GT(rows[0]["bytes"], 1000);
  EXPECT_TRUE(rows[0]["lacks"].is_null());
  EXPECT_TRUE(rows[1]["cycles"].is_null());
  EXPECT_NE(rows[1]["lacks"].get<std::string>().find("blend"), std::string::npos);
}

/// Random triangles and quadrilaterals around the eye.
void draw_around(Context& context, Drawable& drawable, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-3, 3), channel(0, 1);
  context.drawable = context.read_drawable = &drawable;
  viewport(context, 0, 0, kWidth, kHeight);
  matrix_mode(context, GL_PROJECTION);
  frustum(context, -0.5, 0.5, -0.5, 0.5, 0.5, 4);
  enable(context, GL_DEPTH_TEST, true);
  ++context.revision;
  for (int i = 0; i < 100; ++i) {
    begin(context, i % 2 == 0 ? GL_TRIANGLES : GL_QUADS);
    const double x = place(random), y = place(random), z = place(random) - 2;
    for (int corner = 0; corner < 12; ++corner) {
      color(context, channel(random), channel(random), channel(random), 1);
      vertex(context, x + place(random) / 3, y + place(random) / 3, z + place(random) / 3, 1);
    }
    end(context);
  }
}

TEST(GlFrame, WhatIsOutsideTheViewIsMissingInNoPicture) {
  const Folder folder;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Options options = options_of("full");
    Drawable drawable(options, kWidth, kHeight);
    options.results = folder.file("results" + std::to_string(seed));  // all draws are kept
    Drawable keeping(options, kWidth, kHeight);
    Context context, of_keeping;
    draw_around(context, drawable, seed);
    draw_around(of_keeping, keeping, seed);
    expect_same(drawable.frame.picture(), keeping.frame.picture(), "seed " + std::to_string(seed));
    keeping.frame.end();
    keeping.frame.wait();
    EXPECT_GT(results_of(options).at(0)["primitives"]["culled"], 50) << "nothing outside, seed " << seed;
  }
}

TEST(GlFrame, ResizesAndKeepsWithinTheConfiguration) {
  Frame frame(options_of("small"), 100, 100);
  draw_some(frame, 0.5);
  frame.resize(1000, 50);
  EXPECT_EQ(frame.width(), 320);
  EXPECT_EQ(frame.height(), 50);
  EXPECT_EQ(frame.picture().width, 320);
  EXPECT_THROW(Frame(options_of("small"), 1000, 50), InputError);
}

TEST(GlFrame, TheHudStaysInTheShownPicture) {
  Options options = options_of();
  Frame without(options, kWidth, kHeight);
  options.hud = true;
  Frame frame(options, kWidth, kHeight);
  std::vector<std::uint32_t> shown(64 * 20, 0x123456);
  without.draw_hud(shown, 60, 20, 64);
  EXPECT_EQ(std::ranges::count(shown, 0x123456U), 64 * 20);
  frame.draw_hud(shown, 60, 20, 64);
  EXPECT_GT(std::ranges::count(shown, 0xffffffU), 20);
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 60; x < 64; ++x) EXPECT_EQ(shown[y * 64 + x], 0x123456U);
  frame.draw_hud(std::span(shown).first(100), 60, 20, 64);  // a picture that is smaller than it says
  EXPECT_EQ(std::ranges::count(frame.picture().color, frame.picture().color[0]),
            static_cast<std::ptrdiff_t>(frame.picture().color.size()));
}

TEST(GlOptions, ComeFromTheEnvironment) {
  ::setenv("HALFPLANE_GL",
           R"({"preset": "small", "config": ["depth.bits=12"], "threads": 2, "save": [3], "hud": true})", 1);
  const Options options = options_from_environment();
  EXPECT_EQ(options.config.preset, "small");
  EXPECT_EQ(options.config.depth_bits, 12);
  EXPECT_EQ(options.threads, 2);
  EXPECT_EQ(options.save, std::vector<int>{3});
  EXPECT_TRUE(options.hud);
  for (const char* text : {"{", "[]", R"({"preset": "none"})", R"({"config": ["depth.bits"]})", R"({"threads": "two"})",
                           R"({"threads": 0})", R"({"on_missing": "never"})", R"({"memory": "paper"})"}) {
    ::setenv("HALFPLANE_GL", text, 1);
    EXPECT_THROW((void)options_from_environment(), InputError) << text;
  }
  ::unsetenv("HALFPLANE_GL");
  const Options plain = options_from_environment();
  EXPECT_EQ(plain.config.depth_bits, 24);
  EXPECT_EQ(plain.config.stencil_bits, 8);
  EXPECT_EQ(plain.config.color_format, ColorFormat::rgba8888);
}

}  // namespace
}  // namespace halfplane::gl::frame_test
