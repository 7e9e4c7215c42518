// Textured triangles in hardware: the hardware and the cycle engine against the scalar one, and a texture unit's
// refusals.
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>
#include <random>
#include <string>

#include "../hardware_scene.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/packets/state_packets.hpp"
#include "model/stages/texture_packets.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::texture_hardware_test {
namespace {

using test::with;

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{
      with("embedded", {{"texture.unit", "nearest"}}),
      with("embedded", {{"texture.unit", "nearest"}, {"frame.order", "bins"}, {"texture.cache_kb", "1"}}),
      with("embedded", {{"texture.unit", "bilinear"}}),
      with("full", {{"texture.unit", "bilinear"}, {"texture.cache_kb", "1"}, {"memory.port_bits", "32"}}),
      with("embedded", {{"texture.unit", "trilinear"}}),
      with("full", {{"texture.unit", "trilinear"}, {"frame.order", "bins"}, {"texture.cache_kb", "1"}}),
      with("tiny", {{"texture.unit", "trilinear"}, {"cache.kind", "blocks"}, {"perspective.bits", "12"}}),
      with("full", {{"texture.unit", "nearest"}, {"texture.queue", "8"}}),
      with("tiny", {{"texture.unit", "nearest"}, {"cache.kind", "blocks"}, {"perspective.bits", "12"}}),
      with("embedded", {{"texture.unit", "nearest"}, {"perspective.colors", "1"}}),
      with("embedded", {{"texture.unit", "trilinear"}, {"perspective.colors", "1"}, {"frame.order", "bins"}}),
      with("embedded", {{"texture.unit", "bilinear"},
                        {"perspective.colors", "1"},
                        {"alpha.unit", "1"},
                        {"blend.lanes", "4"},
                        {"fog.unit", "1"},
                        {"stencil.bits", "8"}}),
      with("full", {{"texture.unit", "trilinear"}, {"perspective.colors", "1"}}),
      with("embedded", {{"texture.unit", "bilinear"}, {"texture.lanes", "4"}, {"perspective.colors", "1"}}),
      with("full", {{"texture.unit", "nearest"}, {"texture.lanes", "4"}, {"texture.cache_kb", "1"}}),
      with("embedded", {{"texture.unit", "trilinear"}, {"texture.cache_kb", "1"}, {"texture.ways", "2"}}),
      with("full",
           {{"texture.unit", "bilinear"}, {"texture.lanes", "4"}, {"texture.cache_kb", "2"}, {"texture.ways", "2"}}),
      with("embedded", {{"texture.unit", "trilinear"}, {"texture.lanes", "4"}, {"perspective.colors", "1"}}),
      with("full",
           {{"texture.unit", "trilinear"}, {"texture.lanes", "4"}, {"texture.cache_kb", "1"}, {"texture.ways", "2"}}),
      with("full", {{"texture.unit", "nearest"}, {"perspective.colors", "1"}, {"stamp.size", "1"}}),
      with("tiny", {{"texture.unit", "nearest"},
                    {"perspective.colors", "1"},
                    {"cache.kind", "blocks"},
                    {"perspective.bits", "12"}})};
  return all;
}

/// A floor to the horizon that crosses the eye's plane, a wall in front of it, and a triangle without a texture.
constexpr const char* kRoom = R"(halfplane 1
target 64 48
clear color 90 140 200 255 depth 1
texture ground pattern grid 64 64 format rgb565
texture wall pattern chequer 16 8 format l8
state texture ground
state texture_wrap repeat mirror
v -40 -4 60 62 255 255 255 255 -8 16
v 40 -4 60 62 255 255 255 255 8 16
v 8 -2 -1 -1.5 200 220 255 255 2 0
v -8 -2 -1 -1.5 255 220 200 255 -2 0
t 0 1 2 0 2 3
state texture wall
state texture_combine decal
state texture_interp affine
v -3 -1 6 8 255 40 40 255 0 2
v 0 -1.5 4 6 40 255 40 255 2 2
v 0 3 4 6 40 40 255 255 2 0
t 4 5 6
state texture off
v 2 -1 5 7 255 0 0 255
v 5 -1 5 7 0 255 0 255
v 3.5 3 5 7 0 0 255 255
t 7 8 9
)";

void expect_equal(const Scene& scene, const Config& config) {
  const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
  EXPECT_EQ(scalar.frame.color, hardware.frame.color) << scene.name << ", " << label(config);
  EXPECT_EQ(scalar.frame.depth, hardware.frame.depth) << scene.name << ", " << label(config);
  const auto memory = make_memory({}, config);
  const Rendering cycle = render_cycle(scene, config, *memory).rendering;
  EXPECT_EQ(scalar.frame.color, cycle.frame.color) << scene.name << ", " << label(config);
}

TEST(TexturedHardware, DrawsARoomAsTheScalarEngine) {
  for (Config config : configurations()) {
    config.target_width = std::max(config.target_width, 64);
    config.target_height = std::max(config.target_height, 64);
    config.guard_band = std::max(config.guard_band, 128);
    expect_equal(read_capture(kRoom, "room"), config);
  }
}

TEST(TexturedHardware, DrawsRandomScenesAsTheScalarEngine) {
  for (const Config& config : configurations())
    for (std::uint64_t seed = 1; seed <= 12; ++seed) expect_equal(random_scene(config, seed, 25), config);
}

/// The room with colours over w throughout, but for the wall's texture, which is affine.
std::string room_over_w() {
  std::string text = kRoom;
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("state texture ground\n", "state texture ground\nstate color_interp perspective\n");
  replace("state texture_interp affine\n", "state color_interp affine\nstate texture_interp affine\n");
  replace("state texture off\n", "state texture off\nstate color_interp perspective\n");
  return text;
}

// Textured and not, with three channels and four, in front of a blend and an alpha test; and it is another picture.
TEST(TexturedHardware, DividesColorsByWAsTheScalarEngine) {
  int divided = 0;
  for (Config config : configurations()) {
    if (!has_colors_over_w(config)) continue;
    ++divided;
    config.target_width = std::max(config.target_width, 64);
    config.target_height = std::max(config.target_height, 64);
    config.guard_band = std::max(config.guard_band, 128);
    const Scene scene = read_capture(room_over_w(), "room");
    expect_equal(scene, config);
    EXPECT_NE(render_hardware(scene, config).frame.color,
              render_hardware(read_capture(kRoom, "room"), config).frame.color);
    int over_w = 0, textured = 0, affine = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
      for (const Scene random = random_scene(config, seed, 25); const State& state : random.states) {
        const bool is_over_w = state.color_interp == ColorInterp::perspective;
        ++(is_over_w ? over_w : affine);
        textured += is_over_w && state.texture ? 1 : 0;
      }
    EXPECT_GT(over_w, 20) << label(config);
    EXPECT_GT(textured, 10) << label(config);
    EXPECT_GT(affine, 20) << label(config);
  }
  EXPECT_GE(divided, 6);
}

// A stamp that has no texture takes a clock for each sample whose colour is divided, and none where colours are affine.
TEST(TexturedHardware, AColorOverWTakesAClockASampleAndLane) {
  const auto cycles = [&](const Config& config, const std::string& states) {
    const Scene scene = read_capture(
        "halfplane 1\ntarget 128 128\ntexture ground pattern chequer 16 16 format rgb565\nspace window\n"
        "state depth_test always\n" +
            states +
            "v -130 -2 0.5 1 255 0 0 255 0 0\nv 130 -2 0.5 2 0 255 0 255 1 0\nv -2 400 0.5 4 0 0 255 255 0 1\n"
            "t 0 1 2\n",
        "screen");
    const auto memory = make_memory({}, config);
    return static_cast<double>(render_cycle(scene, config, *memory).run.raster_cycles);
  };
  const std::string divides = "state color_interp perspective\n",
                    linear = "state texture ground\nstate texture_min linear\nstate texture_mag linear\n";
  const double pixels = 128 * 128;
  const Config config = with("embedded", {{"texture.unit", "bilinear"}, {"perspective.colors", "1"}});
  EXPECT_LT(cycles(config, ""), 0.4 * pixels);
  for (const std::string& states : {divides, linear, linear + divides}) {
    EXPECT_GT(cycles(config, states), 0.6 * pixels) << states;
    EXPECT_LT(cycles(config, states), 1.1 * pixels) << states;
    Config lanes = config;
    lanes.texture_lanes = 4;
    EXPECT_LT(cycles(lanes, states), 0.4 * pixels) << states;
  }
}

// Where the upper of two levels is not there, or has no weight, the other is asked once.
TEST(TexturedHardware, ASecondLevelThatAddsNothingIsNotAsked) {
  for (const std::string lod : {"6.3 0 12", "0 2 2"}) {
    std::string text = kRoom;
    const auto replace = [&text](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace("state texture_wrap",
            "state texture_min linear_mipmap_linear\nstate texture_mag linear\nstate texture_lod " + lod +
                "\nstate texture_wrap");
    replace("grid 64 64", "grid 4 4 mips box");
    const Config config = with("embedded", {{"texture.unit", "trilinear"}});
    expect_equal(read_capture(text, "room"), config);
  }
}

// One word of 49 bits, over the codes of a vertex and back from a fragment that setup and interpolation have made of it.
TEST(TexturedHardware, ATokenKeepsItsWordThroughThePlanes) {
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    for (std::uint64_t word = 1; word < std::uint64_t{1} << TextureState::kBits; word = word * 5 + 3) {
      const TextureState state = TextureState::unpack(word);
      PerPlane<std::uint32_t> code{};
      set_state_word(code, state.pack(), widths);
      EXPECT_EQ(TextureState::unpack(state_word(code, widths)), state) << label(config);
    }
  }
}

/// The room with another line in place of one.
std::string changed_room(const std::string& line, const std::string& other) {
  std::string text = kRoom;
  return text.replace(text.find(line), line.size(), other);
}

/// The room, its wall blended by its texels.
std::string blended_room(const std::string& constant) {
  return changed_room("state texture_combine decal\n",
                      "state texture_combine blend\nstate texture_constant " + constant + '\n');
}

// The constant shows.
TEST(TexturedHardware, BlendsToTheConstantAsTheScalarEngine) {
  for (Config config : configurations()) {
    config.texture_constants = 1;
    config.target_width = std::max(config.target_width, 64);
    config.target_height = std::max(config.target_height, 64);
    config.guard_band = std::max(config.guard_band, 128);
    expect_equal(read_capture(blended_room("10 200 90"), "blended room"), config);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) expect_equal(random_scene(config, seed, 25), config);
    EXPECT_NE(render_hardware(read_capture(blended_room("10 200 90"), "room"), config).frame.color,
              render_hardware(read_capture(blended_room("10 90 90"), "room"), config).frame.color);
  }
}

TEST(TexturedHardware, AConstantIsRefusedByNameWhereThereIsNone) {
  Config config = preset("embedded");
  config.texture_unit = TextureUnitKind::trilinear;
  try {
    check_hardware_scene(read_capture(blended_room("1 2 3"), "room"), config);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("texture.constant=1"), std::string::npos) << error.what();
  }
}

/// The room, its ground with a border.
std::string bordered_room(const std::string& wrap, const std::string& border) {
  return changed_room("state texture_wrap repeat mirror\n",
                      "state texture_wrap " + wrap + "\nstate texture_border " + border + '\n');
}

// The border shows.
TEST(TexturedHardware, HasABorderAsTheScalarEngine) {
  for (Config config : configurations()) {
    config.texture_borders = 1;
    config.target_width = std::max(config.target_width, 64);
    config.target_height = std::max(config.target_height, 64);
    config.guard_band = std::max(config.guard_band, 128);
    for (const char* wrap : {"border border", "half_border half_border", "clamp border", "half_border repeat"})
      expect_equal(read_capture(bordered_room(wrap, "10 200 90 120"), wrap), config);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) expect_equal(random_scene(config, seed, 25), config);
    EXPECT_NE(render_hardware(read_capture(bordered_room("border border", "10 200 90 0"), "room"), config).frame.color,
              render_hardware(read_capture(bordered_room("border border", "10 90 90 0"), "room"), config).frame.color);
  }
}

TEST(TexturedHardware, ABorderIsRefusedByNameWhereThereIsNone) {
  Config config = preset("embedded");
  config.texture_unit = TextureUnitKind::trilinear;
  for (const char* wrap : {"border clamp", "clamp half_border"}) try {
      check_hardware_scene(read_capture(bordered_room(wrap, "1 2 3 4"), "room"), config);
      FAIL() << "not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("texture.border=1"), std::string::npos) << error.what();
    }
}

// The lines of half_border, and of border, equal the lines of clamp.
TEST(TexturedHardware, ABorderReadsNoMoreThanTheEdge) {
  for (Config config : configurations()) {
    config.texture_borders = 1;
    config.target_width = std::max(config.target_width, 64);
    config.target_height = std::max(config.target_height, 64);
    config.guard_band = std::max(config.guard_band, 128);
    const auto counters = [&config](const char* wrap) {
      return render_hardware(read_capture(bordered_room(wrap, "1 2 3 4"), "room"), config).counters;
    };
    const auto clamped = counters("clamp clamp").texture;
    for (const char* wrap : {"border border", "half_border half_border"}) {
      EXPECT_EQ(counters(wrap).texture.samples, clamped.samples);
      EXPECT_EQ(counters(wrap).texture.hits, clamped.hits);
      EXPECT_EQ(counters(wrap).texture.fills, clamped.fills);
    }
  }
}

TEST(TexturedHardware, ATextureStateKeepsItsWrapsInTheWord) {
  for (int u = 0; u < 5; ++u)
    for (int v = 0; v < 5; ++v) {
      TextureState state;
      state.combine = TextureCombine::blend;
      state.wrap = {static_cast<TextureWrap>(u), static_cast<TextureWrap>(v)};
      EXPECT_EQ(TextureState::unpack(state.pack()), state);
      EXPECT_EQ(state.pack() >> TextureState::kBits, 0U);
    }
  const Texel border{1, 2, 3, 255};
  EXPECT_EQ(TextureBorder::unpack(TextureBorder{border}.pack()).color, border);
  EXPECT_EQ(levels_word(TextureBorder{border}.pack()), LevelsWord::border);
}

// One token for each other constant; none for draws that have none.
TEST(TexturedHardware, AConstantCostsATokenWhereItIsNeeded) {
  Config config = preset("embedded");
  config.texture_unit = TextureUnitKind::trilinear;
  const auto tokens = [&config](const std::string& text) {
    const Scene scene = read_capture(text, "room");
    HostStream stream(scene, config);
    const Widths widths = derive_widths(config);
    int all = 0, constants = 0;
    while (const auto next = stream.next()) {
      if (next->packet.kind != PrimitiveKind::state) continue;
      ++all;
      constants += state_register(next->packet.state) == StateRegister::texture_levels &&
                           levels_word(state_word(next->packet.vertex.code[0], widths)) == LevelsWord::constant
                       ? 1
                       : 0;
    }
    return std::pair(all, constants);
  };
  const auto without = tokens(kRoom);
  config.texture_constants = 1;
  EXPECT_EQ(tokens(kRoom), without);
  EXPECT_EQ(tokens(blended_room("1 2 3")), std::pair(without.first + 1, 1));
  config.texture_borders = 1;
  EXPECT_EQ(tokens(kRoom), without);
  const auto clamped = tokens(bordered_room("clamp clamp", "1 2 3 4"));
  EXPECT_EQ(tokens(bordered_room("border border", "1 2 3 4")).first, clamped.first + 1);
}

// The same for levels and lines, whose parts may follow any others.
TEST(TexturedHardware, TokensBringLevelsAndLines) {
  std::mt19937_64 random(7);
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    const int bits = line_part_bits(state_word_bits(widths));
    LineRegister unit(bits);
    for (int n = 0; n < 200; ++n) {
      const auto word = static_cast<std::uint32_t>(random() % 6 | (random() >> 40) << 3) & 0x7fffffffU;
      EXPECT_EQ(TextureLevels::unpack(word).pack(), word);
      LodSetup lod;
      for (const std::size_t c : {0U, 1U}) {
        lod.along_y[c] = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())};
        lod.along_x[c] = {static_cast<std::uint32_t>(random()), lod.along_y[c].step};
      }
      lod.offset = static_cast<Lod>(random() % 60000) - 30000;
      const TextureLines lines = TextureLines::pack(lod, -7);
      PerPlane<std::uint32_t> code{};
      for (int part = 0; part < line_parts(bits); ++part) {
        set_state_word(code, line_part(lines, bits, part), widths);
        unit.move_in(wide_state_word(code, widths));
      }
      EXPECT_EQ(unit.lines(), lines) << label(config);
      const LodSetup out = unit.lines().unpack();
      EXPECT_EQ(out.offset, lod.offset - 7);
      for (const std::size_t c : {0U, 1U})
        for (const int at : {0, 1, 4095}) {
          EXPECT_EQ(out.along_y[c].at(at), lod.along_y[c].at(at));
          EXPECT_EQ(out.along_x[c].at(at), lod.along_x[c].at(at));
        }
    }
  }
}

// Whatever the sides, no two levels share a block but the last two, and each follows the previous level; in all they
// take the blocks that they need.
TEST(TexturedHardware, LevelsLieOneBehindTheOther) {
  for (int w = 0; w <= 12; ++w)
    for (int h = 0; h <= 12; ++h) {
      std::uint32_t next = 0;
      for (int n = 0; n <= std::max(w, h); ++n) {
        const LevelPlace place = level_place({w, h}, n);
        const std::uint32_t blocks = 1U << (std::max(0, w - 2 - n) + std::max(0, h - 2 - n));
        EXPECT_EQ(place.block, place.is_corner ? next - 1 : next) << w << ", " << h << ", level " << n;
        EXPECT_EQ(place.is_corner, n >= 2 && std::max(w, h) == n) << w << ", " << h << ", level " << n;
        if (!place.is_corner) next += blocks;
      }
    }
}

// For sides that are no powers of two, which hardware refuses to draw, memory holds the image alone.
TEST(TexturedHardware, LevelsOfOddSidesAreNotInMemory) {
  for (const auto& [width, height] : {std::pair{12, 8}, std::pair{8, 12}}) {
    const Texture texture =
        make_texture("odd", pattern_image(TexturePattern::chequer, width, height), TextureFormat::l8, Mips::box);
    EXPECT_GT(texture.last_level(), 0);
    EXPECT_EQ(texture_bytes(texture, true), texture_bytes(texture)) << width << " x " << height;
  }
}

// A level of detail that makes no difference is not sent; one of another scene that is held to any bound has none either.
TEST(TexturedHardware, SendsLinesOnlyWhereTheyMakeADifference) {
  const Config config = with("embedded", {{"texture.unit", "trilinear"}});
  const auto lines_of = [&](const std::string& states) {
    const std::string text =
        "halfplane 1\ntarget 64 48\ntexture t pattern chequer 16 16 mips box\nspace window\nstate cull back\nstate "
        "texture t\n" +
        states +
        "v 0 0 0 1 0 0 0 0 0 0\nv 40 0 0 1 0 0 0 0 4 0\nv 0 40 0 3 0 0 0 0 0 4\nv 20 20 0 1 0 0 0 0 2 2\n"
        "t 0 1 2\nt 0 2 1\nt 1 3 2\n";
    const Scene scene = read_capture(text, "lines");
    HostStream host(scene, config);
    int count = 0;
    while (const auto primitive = host.next())
      count += primitive->packet.kind == PrimitiveKind::state &&
               state_register(primitive->packet.state) == StateRegister::texture_lines;
    return count;
  };
  EXPECT_EQ(lines_of(""), 0);
  EXPECT_EQ(lines_of("state texture_min linear\n"), 2);  // one of three triangles faces here and has an area
  EXPECT_EQ(lines_of("state texture_min linear\nstate texture_mag linear\n"), 0);
  EXPECT_EQ(lines_of("state texture_min nearest_mipmap_nearest\n"), 2);
  EXPECT_EQ(lines_of("state texture_min linear_mipmap_linear\nstate texture_lod 0 2 2\n"), 0);
}

/// 2,000 triangles in boxes of 2x2 pixels at random places of 640x480, w random, 1.4 texels a pixel of a texture of so many a
/// side.
Scene small_triangles(const std::string& states, int side) {
  std::mt19937_64 random(9);
  const auto number = [&random](double low, double high) {
    return std::to_string(low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53);
  };
  std::string text = "halfplane 1\ntarget 640 480\nclear color 0 0 0 255 depth 1\ntexture t pattern grid " +
                     std::to_string(side) + " " + std::to_string(side) +
                     " format rgb565 mips box\nspace window\nstate texture t\nstate depth_test always\n" + states;
  for (int n = 0; n < 2000; ++n) {
    const int x = static_cast<int>(random() % 637), y = static_cast<int>(random() % 477);
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {2.5, 0.0}, {0.0, 2.5}})
      text += "v " + std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + number(0, 1) + " " + number(1, 4) +
              " 255 255 255 255 " + std::to_string((x + dx) * 1.4 / side) + " " +
              std::to_string((y + dy) * 1.4 / side) + "\n";
    text += "t " + std::to_string(3 * n) + " " + std::to_string(3 * n + 1) + " " + std::to_string(3 * n + 2) + "\n";
  }
  return read_capture(text, "small triangles");
}

// The whole frame: clear and flush, the framebuffer's memory and the texture's, which the cache holds: the pipeline's cycles.
// Each triangle has lines of its own, two tokens.
TEST(TexturedHardware, ATriangleOf2x2PixelsTakesAtMost16CyclesBetweenLevelsAndWithoutThem) {
  const Config config = with("embedded", {{"texture.unit", "trilinear"}, {"frame.clears", "flags"}});
  MemorySettings ddr3;
  ddr3.kind = memory_kind("ddr3");
  CycleOptions options;
  options.textures = ddr3;
  for (const std::string states :
       {"state texture_min linear\nstate texture_mag linear\n", "state texture_min linear_mipmap_linear\n"}) {
    const auto memory = make_memory(ddr3, config);
    const CycleRendering run = render_cycle(small_triangles(states, 32), config, *memory, {}, options);
    const double each = static_cast<double>(run.run.cycles) / 2000;
    std::printf("%.2f cycles each, %llu lines of texels\n", each,
                static_cast<unsigned long long>(run.rendering.counters.texture.fills));
    EXPECT_LE(each, 16) << states;
    EXPECT_EQ(run.rendering.counters.primitives_in, 2000U);
    EXPECT_GE(run.rendering.counters.texture.samples, 5900U);  // three a triangle
  }
}

TEST(TexturedHardware, CountsSamplesHitsAndLinesAsTheCycleEngineDoes) {
  for (const Config& config : configurations())
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Scene scene = random_scene(config, seed, 25);
      const auto memory = make_memory({}, config);
      CycleOptions options;
      options.want_misses = true;
      const CycleRendering cycle = render_cycle(scene, config, *memory, {}, options);
      const auto &a = cycle.rendering.counters.texture, b = render_hardware(scene, config).counters.texture;
      EXPECT_EQ(a.samples, b.samples) << label(config);
      EXPECT_EQ(a.hits, b.hits) << label(config);
      EXPECT_EQ(a.fills, b.fills) << label(config);
      EXPECT_LE(a.hits, a.samples);
      // The map of misses has each line at the pixel that asked for it.
      EXPECT_EQ(std::accumulate(cycle.misses.begin(), cycle.misses.end(), 0.0), static_cast<double>(a.fills));
    }
}

TEST(TexturedHardware, RefusesByNameWhatTheUnitLacks) {
  const Config with_unit = configurations().front();
  const auto fault = [](std::string text, const Config& config, const std::string& from, const std::string& to) {
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    try {
      check_hardware_scene(read_capture(text, "room"), config);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto names = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_EQ(fault(kRoom, with_unit, "", ""), "");
  EXPECT_TRUE(names(fault(kRoom, preset("embedded"), "", ""), "texture.unit=nearest"));
  const std::string over_w = "state color_interp perspective";
  EXPECT_TRUE(names(fault(kRoom, with_unit, "state texture off", over_w), "perspective.colors=1"));
  Config divides = with_unit;
  divides.perspective_colors = 1;
  EXPECT_EQ(fault(kRoom, divides, "state texture off", "state texture off\n" + over_w), "");
  EXPECT_TRUE(names(fault(kRoom, divides, "state texture off", over_w), "texture_interp affine"));
  EXPECT_THROW(validate(with("embedded", {{"perspective.colors", "1"}})), InputError);
  EXPECT_TRUE(names(fault(kRoom, with_unit, "state texture off", "state texture_mag linear"), "texture_mag"));
  const std::string linear = "state texture_mag linear\nstate texture_min linear";
  EXPECT_TRUE(names(fault(kRoom, with_unit, "state texture_wrap", linear + "\nstate texture_wrap"), "bilinear"));
  EXPECT_EQ(fault(kRoom, configurations()[2], "state texture_wrap", linear + "\nstate texture_wrap"), "");
  EXPECT_TRUE(
      names(fault(kRoom, with_unit, "state texture off", "state texture_mag linear"), "texture.unit=trilinear"));
  EXPECT_EQ(fault(kRoom, with("embedded", {{"texture.unit", "trilinear"}}), "state texture_wrap",
                  "state texture_min linear_mipmap_nearest\nstate texture_wrap"),
            "");
  EXPECT_TRUE(names(fault(kRoom, with_unit, "16 8 format", "16 9 format"), "16x9"));
  EXPECT_THROW(validate(with("tiny", {{"texture.unit", "nearest"}})), InputError);
  EXPECT_THROW(validate(with("full", {{"texture.unit", "nearest"}, {"stamp.size", "8"}})), InputError);
  EXPECT_THROW(validate(with("embedded", {{"texture.cache_kb", "3"}})), InputError);
  EXPECT_THROW(validate(with("embedded", {{"texture.lanes", "2"}})), InputError);
  EXPECT_THROW(validate(with("embedded", {{"texture.ways", "3"}})), InputError);
  EXPECT_THROW(validate(with("embedded", {{"texture.unit", "nearest"}, {"texture.ways", "2"}})), InputError);
  EXPECT_NO_THROW(
      validate(with("embedded", {{"texture.unit", "nearest"}, {"texture.lanes", "4"}, {"texture.ways", "2"}})));
  EXPECT_NO_THROW(validate(with("embedded", {{"texture.unit", "trilinear"}, {"texture.lanes", "4"}})));
  EXPECT_THROW(validate(with("embedded", {{"texture.unit", "nearest"}, {"texture.lanes", "4"}, {"stamp.size", "1"}})),
               InputError);
}

// With two ways the least recently used one is replaced, whether its last use was a hit or a fill; with one way the
// only one.
TEST(TextureCacheWays, ABlockTakesThePlaceOfTheOneLookedUpLongerAgo) {
  TextureCache one(16), two(16, 2);
  EXPECT_EQ(one.line_of(3, 2), 11U);
  EXPECT_EQ(two.line_of(3, 2), 3U) << "the highest bit of the row is the way";
  EXPECT_EQ(TextureCache(32, 2).line_of(7, 3), 27U) << "or of the column, which has more";
  EXPECT_EQ(one.line_of(1, 0, 1), 9U);
  EXPECT_EQ(two.line_of(1, 0, 1), 1U) << "levels have no halves";
  const auto hits = [](TextureCache& cache, std::uint32_t address) {
    const auto [line, is_hit] = cache.access(address, 1);
    EXPECT_EQ(cache.find(address, 1), line);
    return is_hit;
  };
  for (const std::uint32_t address : {64U, 128U}) EXPECT_FALSE(hits(two, address));
  EXPECT_NE(two.find(64, 1), two.find(128, 1));
  EXPECT_TRUE(hits(two, 64));
  EXPECT_FALSE(hits(two, 192));
  EXPECT_TRUE(hits(two, 64)) << "looked up after 128, which has gone";
  EXPECT_FALSE(hits(two, 128));
  EXPECT_FALSE(hits(two, 192)) << "gone for 128";
  two.drop();
  EXPECT_FALSE(hits(two, 192));
  EXPECT_FALSE(hits(one, 64));
  EXPECT_FALSE(hits(one, 128));
  EXPECT_FALSE(hits(one, 64));
}

// A triangle in window space may have any w; by one that is not above 0 nothing can be divided.
TEST(TexturedHardware, RefusesATriangleBehindTheEye) {
  const Scene scene = read_capture(
      "halfplane 1\ntarget 8 8\ntexture t pattern chequer 8 8\nspace window\nstate texture t\nv 0 0 0 1\nv 8 0 0 1\nv "
      "0 8 0 0\n"
      "t 0 1 2\n",
      "behind");
  EXPECT_THROW((void)render_hardware(scene, configurations().front()), InputError);
}

}  // namespace
}  // namespace halfplane::texture_hardware_test
