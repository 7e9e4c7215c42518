// The whole pipeline of the C interface: the pictures of the functional engine, events and beats that make them, one line for
// every packet that breaks a rule.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "halfplane.h"

namespace {

using Words = std::vector<std::uint32_t>;
using Settings = std::vector<std::pair<const char*, const char*>>;

/// A packet's fields by name, for the ports that a stage has as well.
class Fields {
 public:
  Fields(const halfplane_config* config, const char* stage_name, int is_out) {
    halfplane_stage* stage = halfplane_stage_new(config, stage_name);
    EXPECT_NE(stage, nullptr) << halfplane_last_error();
    int low = halfplane_stage_port_bits(stage, is_out, 0);
    for (int f = 0; f < halfplane_stage_fields(stage, is_out, 0); ++f) {
      const int bits = std::abs(halfplane_stage_field_bits(stage, is_out, 0, f));
      low -= bits;
      place_.emplace(halfplane_stage_field_name(stage, is_out, 0, f), std::pair(low, bits));
    }
    halfplane_stage_free(stage);
  }
  [[nodiscard]] std::uint64_t get(const Words& words, const std::string& field) const {
    const auto [low, bits] = place_.at(field);
    std::uint64_t value = 0;
    for (int i = 0; i < bits; ++i)
      value |= std::uint64_t{words[static_cast<std::size_t>((low + i) / 32)] >> (low + i) % 32 & 1} << i;
    return value;
  }
  void set(Words& words, const std::string& field, std::uint64_t value) const {
    const auto [low, bits] = place_.at(field);
    for (int i = 0; i < bits; ++i) {
      std::uint32_t& word = words[static_cast<std::size_t>((low + i) / 32)];
      word = (word & ~(1U << (low + i) % 32)) | static_cast<std::uint32_t>(value >> i & 1) << (low + i) % 32;
    }
  }

 private:
  std::map<std::string, std::pair<int, int>> place_;
};

struct Packet {
  Words primitive, line;  ///< no line: empty
};

constexpr int kWidth = 16, kHeight = 13;

/// Triangles, lines and points in random states; after the first clear no other, so that events make the picture.
std::string random_capture(unsigned seed, const std::vector<std::string>& states, bool has_lines = false) {
  std::mt19937 random(seed);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  std::ostringstream text;
  text << "halfplane 1\ntarget " << kWidth << ' ' << kHeight << "\nspace window\ntexture T pattern chequer 8 8\n"
       << "clear color 20 90 160 255 depth 0.75\n";
  for (int n = 0; n < 24; ++n) {
    text << "state " << states[static_cast<std::size_t>(below(static_cast<unsigned>(states.size())))] << '\n';
    for (int v = 0; v < 3; ++v)
      text << "v " << below(80) / 4.0 - 2 << ' ' << below(64) / 4.0 - 2 << ' ' << below(5) / 4.0 << " 1 " << below(256)
           << ' ' << below(256) << ' ' << below(256) << ' ' << below(256) << " 0.25 " << v << '\n';
    text << (n % 6 == 4                ? "p "
             : n % 6 == 5 && has_lines ? "ls "
                                       : "t ")
         << 3 * n << ' ' << 3 * n + 1 << ' ' << 3 * n + 2 << '\n';
  }
  return text.str();
}

/// A configuration, a scene for it, and the packets of the scene.
class Pipeline : public testing::Test {
 protected:
  void SetUp() override { choose("tiny", {}); }
  void TearDown() override {
    for (halfplane_pipeline* made : made_) halfplane_pipeline_free(made);
    halfplane_scene_free(scene);
    halfplane_config_free(config);
  }
  void choose(const char* preset, const Settings& settings) {
    halfplane_config_free(config);
    config = halfplane_config_new(preset);
    for (const auto& [key, value] : settings)
      ASSERT_EQ(halfplane_config_set(config, key, value), 0) << halfplane_last_error();
  }
  void read(const std::string& capture) {
    halfplane_scene_free(scene);
    scene = halfplane_scene_read(capture.data(), capture.size());
    ASSERT_NE(scene, nullptr) << halfplane_last_error() << '\n' << capture;
  }
  [[nodiscard]] Words room(const char* arrow) const {
    const int bits = halfplane_packet_bits(config, arrow);
    EXPECT_GT(bits, 0) << halfplane_last_error();
    return Words(static_cast<std::size_t>(bits + 31) / 32);
  }
  [[nodiscard]] std::vector<Packet> packets() const {
    halfplane_host* host = halfplane_host_new(scene, config);
    EXPECT_NE(host, nullptr) << halfplane_last_error();
    std::vector<Packet> all;
    Words primitive = room("primitive"), line = room("line");
    while (const int got = halfplane_host_next(host, primitive.data(), line.data())) {
      EXPECT_GT(got, 0) << halfplane_last_error();
      all.push_back({primitive, got == 2 ? line : Words()});
      if (got < 0) break;
    }
    halfplane_host_free(host);
    return all;
  }
  [[nodiscard]] halfplane_pipeline* pipeline(int outputs) {
    halfplane_pipeline* made = halfplane_pipeline_new(config, halfplane_config_id(config), outputs);
    EXPECT_NE(made, nullptr) << halfplane_last_error();
    made_.push_back(made);
    EXPECT_EQ(halfplane_pipeline_textures(made, scene), 0) << halfplane_last_error();
    return made;
  }
  static void put(halfplane_pipeline* made, const std::vector<Packet>& all) {
    for (const Packet& packet : all) {
      ASSERT_EQ(halfplane_pipeline_put_primitive(made, packet.primitive.data()), 0) << halfplane_last_error();
      if (packet.line.empty()) continue;
      ASSERT_EQ(halfplane_pipeline_put_line(made, packet.line.data()), 0) << halfplane_last_error();
    }
  }
  [[nodiscard]] static Words plane(const halfplane_pipeline* made, const char* name) {
    Words values(kWidth * kHeight);
    EXPECT_EQ(halfplane_pipeline_plane(made, name, values.data(), values.size()), kWidth * kHeight)
        << halfplane_last_error();
    return values;
  }
  [[nodiscard]] Words drawn(const char* name) const {
    halfplane_frame* frame = halfplane_render(scene, config, "functional");
    EXPECT_NE(frame, nullptr) << halfplane_last_error();
    Words values(kWidth * kHeight);
    EXPECT_EQ(halfplane_frame_plane(frame, name, values.data(), values.size()), kWidth * kHeight);
    halfplane_frame_free(frame);
    return values;
  }
  static void expect_error(std::int64_t status, const std::string& part) {
    EXPECT_LT(status, 0) << part;
    EXPECT_NE(std::string(halfplane_last_error()).find(part), std::string::npos) << halfplane_last_error();
  }

  halfplane_config* config = nullptr;
  halfplane_scene* scene = nullptr;

 private:
  std::vector<halfplane_pipeline*> made_;
};

struct Design {
  const char* preset;
  Settings settings;
  std::vector<std::string> states;
  bool has_lines = true;
};

const std::vector<std::string> kStates{"depth_test less", "depth_test always", "depth_test equal",
                                       "depth_write off", "depth_write on",    "color_write off",
                                       "color_write on",  "scissor 2 3 9 8",   "cull back"};

std::vector<Design> designs() {
  std::vector<std::string> with_units = kStates;
  for (const char* state : {"texture T", "blend src_alpha one_minus_src_alpha", "alpha_test greater 128",
                            "stencil equal 0 255 255 keep incr incr_wrap", "color_mask on off on off"})
    with_units.emplace_back(state);
  return {{"tiny", {}, kStates},
          {"small", {}, kStates, false},
          {"embedded", {}, kStates},
          {"embedded",
           {{"texture.unit", "bilinear"}, {"alpha.unit", "1"}, {"blend.lanes", "4"}, {"stencil.bits", "8"}},
           with_units},
          {"full", {{"target.width", "64"}, {"target.height", "64"}}, kStates},
          {"embedded", {{"frame.order", "bins"}}, kStates}};
}

TEST_F(Pipeline, EventsAndBeatsMakeThePictureOfTheFunctionalEngine) {
  unsigned seed = 1;
  std::size_t writes = 0, beats = 0;
  for (const Design& design : designs()) {
    choose(design.preset, design.settings);
    for (int n = 0; n < 6; ++n, ++seed) {
      SCOPED_TRACE(std::string(design.preset) + ", seed " + std::to_string(seed));
      const std::string capture = random_capture(seed, design.states, design.has_lines);
      read(capture);
      const std::vector<Packet> all = packets();
      halfplane_pipeline* made = pipeline(HALFPLANE_WRITES | HALFPLANE_RETIRED | HALFPLANE_BEATS);
      const std::int64_t size = halfplane_pipeline_memory_size(made);
      std::vector<std::uint8_t> memory(static_cast<std::size_t>(size)), left(memory.size());
      ASSERT_EQ(halfplane_pipeline_memory(made, 0, memory.data(), memory.size()), 0) << halfplane_last_error();
      put(made, all);
      const Words depth = plane(made, "depth"), color = plane(made, "color"), stencil = plane(made, "stencil");
      EXPECT_EQ(depth, drawn("depth"));
      EXPECT_EQ(color, drawn("color"));
      EXPECT_EQ(stencil, drawn("stencil"));
      // The events, on what a scene without draws leaves.
      read(capture.substr(0, capture.find("state ")));
      halfplane_pipeline* empty = pipeline(0);
      put(empty, packets());
      Words made_depth = plane(empty, "depth"), made_color = plane(empty, "color"),
            made_stencil = plane(empty, "stencil");
      halfplane_event event{};
      EXPECT_EQ(halfplane_pipeline_get_event(empty, &event), 0) << "what was not asked for is not kept";
      std::uint32_t retired = 0;
      while (halfplane_pipeline_get_event(made, &event) == 1) {
        ASSERT_EQ(event.primitive, retired);
        if (event.kind == HALFPLANE_RETIRED) {
          ++retired;
          continue;
        }
        ++writes;
        ASSERT_LT(event.x, std::uint32_t{kWidth});
        ASSERT_LT(event.y, std::uint32_t{kHeight});
        const std::size_t at = event.y * kWidth + event.x;
        if ((event.parts & HALFPLANE_DEPTH) != 0) made_depth[at] = event.depth, made_stencil[at] = event.stencil;
        if ((event.parts & HALFPLANE_COLOR) != 0) made_color[at] = event.color;
      }
      EXPECT_EQ(retired, all.size());
      EXPECT_EQ(made_depth, depth);
      EXPECT_EQ(made_color, color);
      EXPECT_EQ(made_stencil, stencil);
      // The beats, on the bytes that memory began with.
      const Fields fields(config, "memory_port", 1);
      Words beat = room("beat");
      std::size_t bytes = 0;
      while (halfplane_pipeline_get_beat(made, beat.data()) == 1) {
        if (fields.get(beat, "is_write") == 0) continue;
        ++beats;
        const std::uint64_t strobe = fields.get(beat, "strobe"), address = fields.get(beat, "address");
        for (std::size_t b = 0; b < 64; ++b)
          if ((strobe >> b & 1) != 0) {
            memory.at(address + b) = static_cast<std::uint8_t>(fields.get(beat, "data[" + std::to_string(b) + "]"));
            ++bytes;
          }
      }
      EXPECT_GT(bytes, 0u);
      ASSERT_EQ(halfplane_pipeline_memory(made, 0, left.data(), left.size()), 0) << halfplane_last_error();
      EXPECT_TRUE(left == memory) << "the bytes that the beats leave";
    }
  }
  EXPECT_GT(writes, 3000u);
  EXPECT_GT(beats, 500u);
}

TEST_F(Pipeline, SamplesAreWrittenOneByOne) {
  choose("embedded", {{"msaa.samples", "4"}});
  read(
      "halfplane 1\ntarget 16 13\nspace window\nclear color 0 0 0 255 depth 1\nv 2 2 0.5\nv 6 2 0.5\nv 2 6 0.5\nt 0 1 "
      "2\n");
  halfplane_pipeline* made = pipeline(HALFPLANE_WRITES);
  put(made, packets());
  std::array<int, 4> of_sample{};
  halfplane_event event{};
  while (halfplane_pipeline_get_event(made, &event) == 1) {
    ASSERT_LT(event.sample, 4u);
    EXPECT_LE(event.x + event.y, 7u);
    ++of_sample[event.sample];
  }
  for (const int count : of_sample) EXPECT_NEAR(count, 8, 2) << "of a triangle of eight pixels";
  EXPECT_EQ(plane(made, "color"), drawn("color"));
}

TEST_F(Pipeline, ADesignOfAnotherConfigurationIsRefused) {
  halfplane_config* other = halfplane_config_new("tiny");
  ASSERT_EQ(halfplane_config_set(other, "depth.bits", "12"), 0);
  EXPECT_EQ(halfplane_pipeline_new(config, halfplane_config_id(other), 0), nullptr);
  expect_error(-1, "CONFIG_ID is of another configuration");
  EXPECT_EQ(halfplane_pipeline_new(config, 0, 0), nullptr);
  EXPECT_EQ(halfplane_pipeline_new(config, halfplane_config_id(config), 8), nullptr);
  expect_error(-1, "outputs are a sum");
  EXPECT_EQ(halfplane_pipeline_new(nullptr, 0, 0), nullptr);
  halfplane_config_free(other);
}

TEST_F(Pipeline, TheLayoutIsTheBenchs) {
  read(random_capture(3, kStates));
  halfplane_pipeline* usual = pipeline(0);
  halfplane_pipeline* moved = pipeline(0);
  std::array<std::uint32_t, 5> layout{}, read_back{};
  ASSERT_EQ(halfplane_pipeline_layout(usual, layout.data()), 0);
  for (std::size_t i = 0; i < 4; ++i) layout[i] += 0x10000;
  ASSERT_EQ(halfplane_pipeline_set_layout(moved, layout.data()), 0) << halfplane_last_error();
  ASSERT_EQ(halfplane_pipeline_layout(moved, read_back.data()), 0);
  EXPECT_EQ(read_back, layout);
  const auto all = packets();
  put(usual, all);
  put(moved, all);
  EXPECT_EQ(plane(usual, "color"), plane(moved, "color"));
  std::array<std::uint8_t, 16> a{}, b{};
  ASSERT_EQ(halfplane_pipeline_memory(usual, 0, a.data(), a.size()), 0);
  ASSERT_EQ(halfplane_pipeline_memory(moved, 0x10000, b.data(), b.size()), 0);
  EXPECT_EQ(a, b);
  expect_error(halfplane_pipeline_set_layout(moved, layout.data()), "before the first primitive");
  layout[0] = 0xffffff00;
  expect_error(halfplane_pipeline_set_layout(pipeline(0), layout.data()), "beyond the last address");
  const auto size = static_cast<std::uint32_t>(halfplane_pipeline_memory_size(usual));
  expect_error(halfplane_pipeline_memory(usual, size - 15, a.data(), a.size()), "memory ends at address");
}

TEST_F(Pipeline, ALineAndItsPlaceMayComeInEitherOrder) {
  read(
      "halfplane 1\ntarget 16 13\nspace window\nclear color 0 0 0 255 depth 1\nv 1 1 0.5\nv 14 11 0.5\nv 1 11 0.25\nls "
      "0 1 2\nt 0 1 2\n");
  const std::vector<Packet> all = packets();
  halfplane_pipeline* before = pipeline(HALFPLANE_RETIRED);
  for (const Packet& packet : all)
    if (!packet.line.empty()) {
      ASSERT_EQ(halfplane_pipeline_put_line(before, packet.line.data()), 0) << halfplane_last_error();
    }
  for (const Packet& packet : all)
    ASSERT_EQ(halfplane_pipeline_put_primitive(before, packet.primitive.data()), 0) << halfplane_last_error();
  halfplane_pipeline* after = pipeline(HALFPLANE_RETIRED);
  for (const Packet& packet : all) ASSERT_EQ(halfplane_pipeline_put_primitive(after, packet.primitive.data()), 0);
  Words values(kWidth * kHeight);
  expect_error(halfplane_pipeline_plane(after, "color", values.data(), values.size()), "waits for its line");
  halfplane_event event{};
  int retired = 0;
  while (halfplane_pipeline_get_event(after, &event) == 1) ++retired;
  EXPECT_EQ(retired, 1) << "the clear: the place of the first line is next";
  for (const Packet& packet : all)
    if (!packet.line.empty()) {
      ASSERT_EQ(halfplane_pipeline_put_line(after, packet.line.data()), 0) << halfplane_last_error();
    }
  EXPECT_EQ(plane(before, "color"), plane(after, "color"));
  EXPECT_EQ(plane(after, "color"), drawn("color"));
}

TEST_F(Pipeline, APacketThatBreaksARuleIsRefusedAndNothingHappens) {
  read(random_capture(5, kStates));
  const std::vector<Packet> all = packets();
  const Fields fields(config, "cull", 0);
  halfplane_pipeline* made = pipeline(HALFPLANE_RETIRED);
  Words values(kWidth * kHeight);
  expect_error(halfplane_pipeline_plane(made, "color", values.data(), values.size()), "nothing was cleared");
  const auto refused = [&](std::size_t n, const std::string& field, std::uint64_t value, const std::string& part) {
    Words wrong = all[n].primitive;
    fields.set(wrong, field, value);
    expect_error(halfplane_pipeline_put_primitive(made, wrong.data()), part);
  };
  refused(1, "primitive_id", 0, "primitive 0 of the stream is drawn before the first clear");
  refused(0, "color_write", 0, "before the first clear");
  refused(0, "left", 1, "of another box than a whole target");
  refused(0, "depth_test", 2, "with another depth test than always");
  ASSERT_EQ(halfplane_pipeline_put_primitive(made, all[0].primitive.data()), 0);
  refused(1, "bottom", kHeight, "primitive 1 of the stream has a box outside the target");
  refused(1, "top", kHeight + 1, "has an inverted box");
  refused(1, "kind", 5, "is of kind 5");
  refused(1, "kind", 7, "sets state register");
  refused(all.size() - 1, "right", 3, "of a part of the target");
  ASSERT_EQ(halfplane_pipeline_put_primitive(made, all[1].primitive.data()), 0) << halfplane_last_error();
  refused(0, "bottom", 3, "changes the target's size after");
  expect_error(halfplane_pipeline_plane(made, "color", values.data(), values.size()),
               "2 primitives after the last flush are on the chip alone");
  for (std::size_t n = 2; n < all.size(); ++n)
    ASSERT_EQ(halfplane_pipeline_put_primitive(made, all[n].primitive.data()), 0) << halfplane_last_error();
  EXPECT_EQ(plane(made, "color"), drawn("color"));
  Words line = room("line");
  std::ranges::fill(line, ~0U);
  expect_error(halfplane_pipeline_put_line(made, line.data()), "a line leaves the target");
  expect_error(halfplane_pipeline_put_primitive(made, nullptr), "is NULL");
  expect_error(halfplane_pipeline_put_primitive(nullptr, line.data()), "the pipeline is NULL");
  choose("small", {});
  expect_error(halfplane_pipeline_put_line(pipeline(0), line.data()), "this hardware draws none");
  expect_error(halfplane_packet_bits(config, "pixels"), "no arrow 'pixels'");
}

/// Bits that no host sends: taken or refused, without a fault of memory (this test is meant for the sanitizers).
TEST_F(Pipeline, RandomBitsAreTakenOrRefused) {
  std::mt19937 random(8);
  int taken = 0, refused = 0;
  for (const Design& design : designs()) {
    choose(design.preset, design.settings);
    read(random_capture(9, design.states, design.has_lines));
    const std::vector<Packet> all = packets();
    for (int n = 0; n < 20; ++n) {
      halfplane_pipeline* made = pipeline(0);
      for (std::size_t p = 0; p < all.size(); ++p) {
        Words primitive = all[p].primitive, line = all[p].line;
        for (int flips = p == 0 ? 0 : n; flips > 0; --flips) {
          const std::size_t bit = random() % static_cast<unsigned>(halfplane_packet_bits(config, "primitive"));
          primitive[bit / 32] ^= 1U << bit % 32;
          if (!line.empty()) line[random() % line.size()] ^= 1U << random() % 32;
        }
        ++(halfplane_pipeline_put_primitive(made, primitive.data()) == 0 ? taken : refused);
        if (!line.empty()) ++(halfplane_pipeline_put_line(made, line.data()) == 0 ? taken : refused);
        EXPECT_EQ(std::string(halfplane_last_error()).find('\n'), std::string::npos);
      }
    }
  }
  EXPECT_GT(taken, 1000);
  EXPECT_GT(refused, 100);
}

}  // namespace
