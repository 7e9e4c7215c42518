// The capture format: reading and writing. docs/capture.md is its reference.
#include "model/capture/capture.hpp"
#include "halfplane_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "sim/scene/random_state.hpp"

namespace halfplane::capture_test {
namespace {

Scene read(const std::string& body) { return read_capture("halfplane 1\n" + body, "test.hpt"); }

std::string written(const Scene& scene) {
  std::ostringstream out;
  write_capture(scene, out);
  return out.str();
}

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

const Draw& draw_at(const Scene& scene, std::size_t command) { return std::get<Draw>(scene.commands.at(command)); }

const State& state_of(const Scene& scene, std::size_t command) {
  return scene.states.at(draw_at(scene, command).state);
}

State read_state(const std::string& lines) { return state_of(read(three_vertices + lines + "t 0 1 2\n"), 0); }

double read_number(const std::string& text) { return read("v " + text + " 0 0\n").vertices.at(0).x; }

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

// ---- reading

TEST(Capture, ExampleOfTheContractIsRead) {
  const Scene scene = read(
      "target 640 480\n"
      "clear color 20 20 30 255 depth 1.0\n"
      "space window            # a comment\n"
      "state depth_test less\n"
      "state cull none\n"
      "state color_write on\n"
      "v 10.5 20.25 0.5 1 255 0 0 255 0.0 0.25\n"
      "v 1 2 0\n"
      "v 3 4 0 2\n"
      "t 0 1 2\n");
  EXPECT_EQ(scene.width, 640);
  EXPECT_EQ(scene.height, 480);
  ASSERT_EQ(scene.commands.size(), 2u);
  const auto& clear = std::get<Clear>(scene.commands[0]);
  EXPECT_EQ(clear.color, (std::array<double, 4>{20, 20, 30, 255}));
  EXPECT_EQ(clear.depth, 1.0);
  EXPECT_EQ(state_of(scene, 1).space, Space::window);
  EXPECT_EQ(draw_at(scene, 1).line, 11u);
  ASSERT_EQ(scene.vertices.size(), 3u);
  EXPECT_EQ(scene.vertices[0].y, 20.25);
  EXPECT_EQ(scene.vertices[0].rgba, (std::array<double, 4>{255, 0, 0, 255}));
  EXPECT_EQ(scene.vertices[0].v, 0.25);
  EXPECT_EQ(scene.vertices[2].w, 2.0);
  EXPECT_EQ(scene.indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Capture, NumbersLeftOutOfAVertexTakeTheirDefaults) {
  const Scene scene = read("v 1 2 3\nv 1 2 3 4\nv 1 2 3 4 5 6 7 8\nv 1 2 3 4 5 6 7 8 9 10\n");
  const Vertex defaults;
  EXPECT_EQ(scene.vertices.at(0).w, defaults.w);
  EXPECT_EQ(scene.vertices.at(1).w, 4.0);
  EXPECT_EQ(scene.vertices.at(1).rgba, defaults.rgba);
  EXPECT_EQ(scene.vertices.at(2).rgba, (std::array<double, 4>{5, 6, 7, 8}));
  EXPECT_EQ(scene.vertices.at(2).u, defaults.u);
  EXPECT_EQ(scene.vertices.at(3).u, 9.0);
  EXPECT_EQ(scene.vertices.at(3).v, 10.0);
}

TEST(Capture, EveryStateValueReachesItsField) {
  EXPECT_EQ(read_state(""), State{});
  const std::vector<std::string> functions{"never",   "less",   "lequal",   "equal",
                                           "greater", "gequal", "notequal", "always"};
  for (std::size_t i = 0; i < functions.size(); ++i)
    EXPECT_EQ(read_state("state depth_test " + functions[i] + "\n").depth_test, static_cast<DepthFunc>(i))
        << functions[i];
  EXPECT_FALSE(read_state("state depth_write off\n").depth_write);
  EXPECT_TRUE(read_state("state depth_write off\nstate depth_write on\n").depth_write);
  EXPECT_FALSE(read_state("state color_write off\n").color_write);
  EXPECT_EQ(read_state("state cull back\n").cull, Cull::back);
  EXPECT_EQ(read_state("state cull front\n").cull, Cull::front);
  EXPECT_EQ(read_state("state cull both\n").cull, Cull::both);
  EXPECT_EQ(read_state("state front cw\n").front, FrontFace::cw);
  EXPECT_EQ(read_state("state shade flat\n").shade, Shade::flat);
  EXPECT_EQ(read_state("state color_interp perspective\n").color_interp, ColorInterp::perspective);
  EXPECT_EQ(read_state("state clip_z zero_one\n").clip_z, ClipZ::zero_one);
  EXPECT_EQ(read_state("space window\n").space, Space::window);
  EXPECT_EQ(read_state("space window\nspace clip\n").space, Space::clip);
  EXPECT_EQ(read_state("state scissor -1 2 0 4\n").scissor, (Rect{-1, 2, 0, 4}));
  EXPECT_EQ(read_state("state scissor 1 2 3 4\nstate scissor off\n").scissor, std::nullopt);
  EXPECT_EQ(read_state("state viewport -0.5 2 3.25 4\n").viewport, (Viewport{-0.5, 2, 3.25, 4}));
  EXPECT_EQ(read_state("state viewport 1 2 3 4\nstate viewport full\n").viewport, std::nullopt);
  EXPECT_EQ(read_state("state depth_range 1 0.25\n").depth_range, (std::array<double, 2>{1, 0.25}));
}

TEST(Capture, StateAppliesToWhatFollowsOnly) {
  const Scene scene =
      read(three_vertices + "t 0 1 2\nstate cull back\nclear depth 0\nt 0 1 2\nstate cull none\nt 0 1 2\n");
  ASSERT_EQ(scene.commands.size(), 4u);
  EXPECT_EQ(state_of(scene, 0).cull, Cull::none);
  EXPECT_EQ(scene.states.at(std::get<Clear>(scene.commands[1]).state).cull, Cull::back);
  EXPECT_EQ(state_of(scene, 2).cull, Cull::back);
  EXPECT_EQ(draw_at(scene, 3).state, draw_at(scene, 0).state);
  EXPECT_EQ(scene.states.size(), 2u);  // equal ones are stored once
}

TEST(Capture, NeighbouringTriangleLinesWithOneStateAndObjectAreOneDraw) {
  const Scene scene =
      read(three_vertices +
           "t 0 1 2\n\nv 5 5 5\nt 0 1 3  1 2 3\nstate cull none\nt 2 1 0\n"  // one draw: nothing changed
           "state cull back\nt 0 1 2\nobject b\nt 0 1 2\nframe\nt 0 1 2\n");
  ASSERT_EQ(scene.commands.size(), 5u);
  EXPECT_EQ(draw_at(scene, 0).count, 12u);
  EXPECT_EQ(draw_at(scene, 0).line, 5u);
  EXPECT_EQ(draw_at(scene, 1).first, 12u);
  EXPECT_EQ(draw_at(scene, 2).object, 1u);
  EXPECT_TRUE(std::holds_alternative<EndFrame>(scene.commands[3]));
  EXPECT_EQ(draw_at(scene, 4).first, 18u);
}

TEST(Capture, EachStripAndFanLineIsADrawOfItsOwn) {
  const Scene scene = read(three_vertices + "v 1 1 0\nts 0 1 2 3\nts 0 1 2\ntf 3 2 1 0\nt 0 1 2\n");
  ASSERT_EQ(scene.commands.size(), 4u);
  EXPECT_EQ(draw_at(scene, 0).topology, Topology::triangle_strip);
  EXPECT_EQ(draw_at(scene, 0).count, 4u);
  EXPECT_EQ(draw_at(scene, 1).first, 4u);
  EXPECT_EQ(draw_at(scene, 2).topology, Topology::triangle_fan);
  EXPECT_EQ(draw_at(scene, 3).topology, Topology::triangles);
}

TEST(Capture, ObjectNamesAreResumedAndTheEmptyOneIsTheUnnamedGroup) {
  const Scene scene = read(three_vertices +
                           "object left wheel # the rest is a comment\nt 0 1 2\nobject 100%25 %23%20\nt 0 1 2\n"
                           "object left wheel\nt 0 1 2\nobject\nt 0 1 2\n");
  EXPECT_EQ(scene.objects, (std::vector<std::string>{"", "left wheel", "100% # "}));
  EXPECT_EQ(draw_at(scene, 0).object, 1u);
  EXPECT_EQ(draw_at(scene, 1).object, 2u);
  EXPECT_EQ(draw_at(scene, 2).object, 1u);
  EXPECT_EQ(draw_at(scene, 3).object, 0u);
}

TEST(Capture, BlanksCommentsAndLineEndsOfAnySystemAreTolerated) {
  const Scene plain = read("target 8 8\n" + three_vertices + "t 0 1 2\n");
  EXPECT_TRUE(same_scene(plain, read("\r\ntarget 8 8\r\nv 0 0 0\r\nv\t1 0  0 \r\n v 0 1 0#c\r\nt 0 1 2\r\n")));
  EXPECT_TRUE(same_scene(
      plain,
      read_capture("\xef\xbb\xbf# saved by an editor\nhalfplane 1\ntarget 8 8\n" + three_vertices + "t 0 1 2\n", "")));
  EXPECT_TRUE(same_scene(plain, read_capture("# made by hand\n\nhalfplane 1 # v1\ntarget 8 8\n" + three_vertices +
                                                 "t 0 1 2",  // no line end
                                             "")));
}

TEST(Capture, ExampleOfTheReferencePageIsRead) {
  std::ifstream file(HALFPLANE_SOURCE_DIR "/docs/capture.md");
  std::stringstream page;
  page << file.rdbuf();
  const std::string text = page.str();
  const std::size_t begin = text.find("halfplane 1\n");
  ASSERT_NE(begin, std::string::npos) << "no example in docs/capture.md";
  const Scene scene = read_capture(text.substr(begin, text.find("```", begin) - begin), "docs/capture.md");
  EXPECT_EQ(scene.vertices.size(), 7u);
  ASSERT_EQ(scene.commands.size(), 4u);  // clear, t, ts, frame
  EXPECT_EQ(draw_at(scene, 2).topology, Topology::triangle_strip);
  EXPECT_EQ(state_of(scene, 2).shade, Shade::flat);
  EXPECT_EQ(scene.objects.at(draw_at(scene, 2).object), "banner");
}

// ---- numbers

TEST(CaptureNumbers, DecimalsAndHexFloatsAreReadAsTheCLibraryReadsThem) {
  for (const char* text : {"0",
                           "-0",
                           "+1",
                           "1.",
                           ".5",
                           "-.5",
                           "+0.1",
                           "1e5",
                           "1E-5",
                           "00012.500",
                           "9007199254740993",
                           "9007199254740992",
                           "0.30000000000000004",
                           "123456789012345678",
                           "1234567890123456789",
                           "0.000000000000000001",
                           "1.7976931348623157e308",
                           "4.9406564584124654e-324",
                           "0x1p0",
                           "-0x1.8p-3",
                           "+0X1.FP+2",
                           "0x.8",
                           "0x1.0000000000000801p0",
                           "0x1.00000000000018p0",
                           "0x1p-1074",
                           "0x10",
                           "72057594037927937",
                           "0.1000000000000000055511151231257827021181583404541015625",
                           "0e999"})
    EXPECT_EQ(bits(read_number(text)), bits(std::strtod(text, nullptr))) << text;
}

TEST(CaptureNumbers, RandomDecimalsRoundToNearestAsTheCLibraryDoes) {
  constexpr unsigned seed = 20;
  std::mt19937_64 random(seed);
  std::string lines;
  std::vector<std::string> texts;
  for (int i = 0; i < 30'000; ++i) {
    std::string text = random() % 2 != 0 ? "-" : "";
    const auto digits = 1 + random() % 21;  // both sides of the short path's limits
    const auto point = random() % 23;
    for (std::size_t d = 0; d < digits; ++d) {
      if (d == point) text += '.';
      text += static_cast<char>('0' + random() % 10);
    }
    texts.push_back(text);
    lines += "v " + text + " 0 0\n";
  }
  const Scene scene = read(lines);
  ASSERT_EQ(scene.vertices.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i)
    EXPECT_EQ(bits(scene.vertices[i].x), bits(std::strtod(texts[i].c_str(), nullptr))) << texts[i] << ", seed " << seed;
}

// ---- writing

/// A finite double of random bits: subnormals, huge ones and both zeros included.
double random_double(std::mt19937_64& random) {
  switch (random() % 8) {
    case 0: return 0.0;
    case 1: return -0.0;
    case 2: return std::numeric_limits<double>::denorm_min() * static_cast<double>(random() % 100);
    case 3: return static_cast<double>(random() % 1000);
    default: break;
  }
  for (;;) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

double random_in(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

template <class Enum>
Enum random_enum(std::mt19937_64& random, unsigned count) {
  return static_cast<Enum>(random() % count);
}

/// Any state, and numbers of many digits: the numbers of random_value() are short.
State random_state(std::mt19937_64& random) {
  State state = random_state({}, states_but({}), chooser(random), Refused::kept);
  for (const DrawState& row : draw_states()) {
    StateValue value{row.words.size(), {}};
    bool is_whole = row.numbers.empty();
    for (std::size_t i = 0; i < row.numbers.size(); ++i) {
      is_whole |= row.numbers[i].is_whole;
      value.numbers[i] = random_in(random, std::max(row.numbers[i].low, -9.0), std::min(row.numbers[i].high, 100.0));
    }
    if (!is_whole && random() % 4 == 0) row.set(state, value);
  }
  return state;
}

void add_random_vertices(std::mt19937_64& random, Scene& scene) {
  for (int i = 0; i < 60; ++i) {
    Vertex v{.x = random_double(random), .y = random_double(random), .z = random_double(random)};
    if (random() % 2 != 0) v.w = random_double(random);
    if (random() % 2 != 0)
      for (double& component : v.rgba) component = random() % 8 == 0 ? -0.0 : random_in(random, 0, 255);
    if (random() % 2 != 0) v.u = random_double(random);
    if (random() % 2 != 0) v.v = random_double(random);
    scene.vertices.push_back(v);
  }
}

/// A random scene in the form that the reader makes: states and objects in the order of their first use.
Scene random_scene(std::mt19937_64& random) {
  Scene scene;
  scene.width = static_cast<int>(1 + random() % 16384);
  scene.height = static_cast<int>(1 + random() % 16384);
  if (random() % 2 != 0)
    scene.planes = {random_in(random, 0.001, 1), random() % 4 == 0 ? INFINITY : random_in(random, 2, 99)};
  add_random_vertices(random, scene);
  scene.objects = {"", "one", "a % # b ", " \t\n\x01\x7f", "gr\xc3\xbcn", std::string("nul\0!", 5)};
  for (int i = 0; i < 40; ++i) {
    if (scene.states.empty() || random() % 4 == 0) scene.states.push_back(random_state(random));
    const auto newest = static_cast<std::uint32_t>(scene.states.size() - 1);
    if (random() % 8 == 0) {
      scene.commands.emplace_back(EndFrame{});
    }
    Clear clear;
    clear.state = newest;
    if (random() % 2 != 0) clear.color = {random_in(random, 0, 255), -0.0, 255, 0.1};
    if (!clear.color || random() % 2 != 0) clear.depth = random_in(random, 0, 1);
    scene.commands.emplace_back(clear);
    Draw draw{.state = static_cast<std::uint32_t>(random() % scene.states.size()),
              .object = static_cast<std::uint32_t>(random() % scene.objects.size()),
              .topology = random_enum<Topology>(random, 7),
              .first = scene.indices.size()};
    const bool is_list = draw.topology == Topology::triangles || draw.topology == Topology::lines;
    const bool may_restart = !is_list && draw.topology != Topology::points;
    draw.count = is_list ? 6 * (1 + random() % 3) : 3 + random() % 9;
    for (std::size_t k = 0; k < draw.count; ++k)
      scene.indices.push_back(static_cast<std::uint32_t>(random() % scene.vertices.size()));
    if (may_restart && draw.count > 6) scene.indices[draw.first + 3] = kRestart;
    scene.commands.emplace_back(draw);
  }
  return scene;
}

TEST(CaptureRoundTrip, RandomScenesComeBackBitForBit) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(seed);
    const Scene scene = random_scene(random);
    const std::string text = written(scene);
    const Scene again = read_capture(text, "again.hpt");
    ASSERT_TRUE(same_scene(scene, again)) << "seed " << seed << "\n" << text;
    ASSERT_EQ(written(again), text) << "seed " << seed;
  }
}

TEST(CaptureRoundTrip, SameSceneSeesEveryKindOfDifference) {
  std::mt19937_64 random(5);
  const Scene scene = random_scene(random);
  const auto differs = [&scene](auto&& change) {
    Scene other = scene;
    change(other);
    return !same_scene(scene, other) && !same_scene(other, scene);
  };
  EXPECT_FALSE(differs([](Scene& s) { s.name = "only a label"; }));
  EXPECT_TRUE(differs([](Scene& s) { ++s.width; }));
  EXPECT_TRUE(differs([](Scene& s) { ++s.height; }));
  EXPECT_TRUE(differs([](Scene& s) { s.planes = {0.25, 4.0}; }));
  EXPECT_TRUE(differs([](Scene& s) { s.vertices.pop_back(); }));
  EXPECT_TRUE(differs([](Scene& s) { s.commands.pop_back(); }));
  EXPECT_TRUE(differs([](Scene& s) { s.objects[1] = "two"; }));
  EXPECT_TRUE(differs(
      [](Scene& s) { s.states[0].front = s.states[0].front == FrontFace::cw ? FrontFace::ccw : FrontFace::cw; }));
  EXPECT_TRUE(differs([](Scene& s) { s.indices[4] = (s.indices[4] + 1) % 60; }));
  for (double Vertex::*member : {&Vertex::x, &Vertex::y, &Vertex::z, &Vertex::w, &Vertex::u, &Vertex::v})
    EXPECT_TRUE(differs([member](Scene& s) { s.vertices[7].*member = -(s.vertices[7].*member); }));  // 0 and -0 too
  const auto is_clear = [](const Command& command) { return std::holds_alternative<Clear>(command); };
  EXPECT_TRUE(differs([&](Scene& s) { std::get<Clear>(*std::ranges::find_if(s.commands, is_clear)).depth = 0.123; }));
}

TEST(CaptureRoundTrip, SceneInAnotherFormKeepsItsPicture) {
  Scene scene;
  scene.vertices.resize(4);
  scene.indices = {9, 9, 0, 1, 2, 1, 2, 3};  // a gap before the first draw
  scene.states.resize(3);
  scene.states[1].cull = Cull::both;
  scene.states[2].depth_write = false;
  scene.commands = {Draw{.state = 2, .first = 2, .count = 3}, Draw{.state = 2, .first = 5, .count = 3},
                    Draw{.state = 1, .topology = Topology::triangle_strip, .first = 2, .count = 2}};  // draws nothing
  const Scene again = read_capture(written(scene), "");
  ASSERT_EQ(again.commands.size(), 1u);
  EXPECT_EQ(again.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 3}));
  EXPECT_EQ(state_of(again, 0), scene.states[2]);
  EXPECT_EQ(again.states.size(), 1u);
}

TEST(CaptureRoundTrip, NothingIsWrittenThatADefaultSays) {
  Scene scene = read(three_vertices + "t 0 1 2\n");
  EXPECT_EQ(written(scene), "halfplane 1\ntarget 640 480\nv 0 0 0\nv 1 0 0\nv 0 1 0\nspace clip\nt 0 1 2\n");
  scene.vertices[1].u = -0.0;  // differs from the default in its sign only
  EXPECT_NE(written(scene).find("v 1 0 0 1 255 255 255 255 -0 0\n"), std::string::npos) << written(scene);
}

TEST(CaptureFiles, FileIsReadAsItsTextIs) {
  const std::string path = testing::TempDir() + "halfplane_capture_test.hpt";
  std::mt19937_64 random(3);
  const Scene scene = random_scene(random);
  {
    std::ofstream file(path, std::ios::binary);
    write_capture(scene, file);
  }
  const Scene again = read_capture_file(path);
  EXPECT_TRUE(same_scene(scene, again));
  EXPECT_EQ(again.name, path);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace halfplane::capture_test
