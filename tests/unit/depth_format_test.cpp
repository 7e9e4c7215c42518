// Depth formats and mappings in the pipeline: codes against exact rationals, engines against each other and the golden.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/depth_encode.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/depth_mapping.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/depth/exact_depth.hpp"

namespace halfplane::depth_format_test {
namespace {

constexpr std::array<std::string_view, 12> kFormats{"u8",     "u16", "u31", "u32",    "bins8",  "bins16",
                                                    "bins32", "f16", "f32", "uf4.12", "uf8.24", "uf1.1"};

/// The code of a plane code as the definitions have it, by exact rationals: a depth of far 2 and near 1 under w is z - 1.
std::uint32_t exact_code(const DepthFormat& format, std::uint64_t numerator, std::uint64_t denominator) {
  const Rational d =
      Rational(mpz_class(static_cast<unsigned long>(numerator)), mpz_class(static_cast<unsigned long>(denominator)));
  return ExactDepth(DepthMapping::w, format, 1, 2).code(1 + d);
}

TEST(DepthFormat, CodesAreTheNearestExactly) {
  std::mt19937_64 random(11);
  for (const auto name : kFormats) {
    const DepthFormat format = parse_depth_format(name);
    EXPECT_EQ(to_string(format), name);
    EXPECT_EQ(depth_code(format, 0, 1), 0U) << name;
    EXPECT_EQ(depth_code(format, 1, 1), top_code(format)) << name;
    for (int i = 0; i < 3000; ++i) {
      // 2^k - 1 as the pipeline has it; 2^k, where floats tie.
      const std::uint64_t denominator = (std::uint64_t{1} << (8 + random() % 24)) - (i % 3 == 0 ? 0 : 1);
      const std::uint64_t numerator = (random() % (denominator + 1)) >> (i % 2 == 0 ? 0 : random() % 32);
      Rational d(mpz_class(static_cast<unsigned long>(numerator)), mpz_class(static_cast<unsigned long>(denominator)));
      d.canonicalize();
      const std::uint32_t expected = ExactDepth(DepthMapping::w, format, 1, 2).code(1 + d);
      ASSERT_EQ(depth_code(format, numerator, denominator), expected) << name << ' ' << numerator << '/' << denominator;
    }
  }
  EXPECT_EQ(exact_code(parse_depth_format("f32"), 1, 2), 0x3F000000U);
}

TEST(DepthFormat, IeeeCodesAreThoseOfTheMachine) {
  std::mt19937_64 random(12);
  const DepthFormat format = parse_depth_format("f32");
  for (int i = 0; i < 10000; ++i) {
    const auto z = static_cast<std::uint32_t>(random());
    const float nearest = static_cast<float>(static_cast<long double>(z) / 0xFFFFFFFFL);
    EXPECT_EQ(depth_code(format, z, 0xFFFFFFFF), std::bit_cast<std::uint32_t>(nearest));
    EXPECT_EQ(static_cast<float>(depth_value(format, depth_code(format, z, 0xFFFFFFFF))), nearest);
  }
}

TEST(DepthFormat, EveryCodeComesBackFromItsValueAndValuesRise) {
  for (const auto name : {"u8", "bins8", "uf3.5", "uf4.12", "f16", "uf1.1", "uf8.2"}) {
    const DepthFormat format = parse_depth_format(name);
    for (std::uint32_t code = 0; code <= top_code(format); ++code) {
      ASSERT_EQ(depth_code(format, depth_value(format, code)), code) << name;
      if (code > 0) {
        ASSERT_GT(depth_value(format, code), depth_value(format, code - 1)) << name;
      }
    }
  }
}

TEST(DepthFormat, RefusesWhatIsNone) {
  for (const char* bad : {"", "u", "u1", "u33", "f24", "uf4", "uf4.", "uf0.4", "uf9.4", "uf4.25", "uf8.25", "bins",
                          "u16x", "u-16", "bins0"})
    EXPECT_THROW((void)parse_depth_format(bad), InputError) << bad;
  Config config = preset("embedded");
  EXPECT_THROW(set(config, "depth.format", "u99"), InputError);
  EXPECT_THROW(set(config, "depth.mapping", "sideways"), InputError);
}

constexpr std::array kMappings{DepthMapping::std,    DepthMapping::rev, DepthMapping::stdinf,
                               DepthMapping::revinf, DepthMapping::w,   DepthMapping::log};

Config with(DepthMapping mapping, std::string_view format, int plane_bits) {
  Config config = preset("embedded");
  config.depth_mapping = mapping;
  config.depth_format = parse_depth_format(format);
  config.depth_bits = plane_bits;
  return config;
}

TEST(DepthMapping, EveryMappingAndFormatRunsThroughEnginesGoldenAndOracle) {
  const Scene original = make_builtin("teapot", 96, 72, {}, 1);
  for (const DepthMapping mapping : kMappings)
    for (const auto format : {"u16", "bins16", "f16", "f32", "uf4.12"}) {
      const Config config = with(mapping, format, 28);
      const Scene scene = in_depth_mapping(original, mapping);
      SCOPED_TRACE(label(config));
      const Comparison c = compare(scene, config);
      EXPECT_EQ(broken_bounds(c, config), std::vector<std::string>{});
      const Rendering scalar = render_scalar(scene, config, {});
      EXPECT_EQ(scalar.frame.depth, c.rendering.frame.depth);
      EXPECT_EQ(scalar.frame.color, c.rendering.frame.color);
      // The golden uses other arithmetic: for the same depth its code is equal or adjacent.
      const DepthEncode encode(config, scene.planes);
      std::uint64_t differ = 0, visible = 0;
      for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) {
          const std::size_t at = c.golden.frame.at(x, y);
          const auto plain = static_cast<std::size_t>(y * scene.width + x);
          if (c.golden.ids[plain] != c.rendering.ids[plain]) continue;
          if (c.golden.ids[plain] < 0) {
            EXPECT_EQ(c.golden.frame.depth[at], is_reversed(mapping) ? 0U : encode.of_window(1.0));
            EXPECT_EQ(c.rendering.frame.depth[c.rendering.frame.at(x, y)], c.golden.frame.depth[at]);
            continue;
          }
          ++visible;
          const auto plane = static_cast<std::uint32_t>(std::floor(c.golden.depth[plain] + 0.5));
          const auto code = static_cast<std::int64_t>(encode(plane));
          const std::int64_t beside = code - static_cast<std::int64_t>(c.golden.frame.depth[at]);
          differ += beside != 0 ? 1 : 0;
          if (std::string_view(format) != "f32") {
            EXPECT_LE(std::abs(beside), 1);
          } else {  // finer than the plane in places: an LSB of that, or a step of its own
            const auto of_golden = static_cast<double>(encode.plane_value(c.golden.frame.depth[at]));
            const auto of_plane = static_cast<double>(encode.plane_value(static_cast<std::uint32_t>(code)));
            EXPECT_NEAR(of_golden, of_plane, of_plane * 0x1p-23 + 0x1p-27);
          }
        }
      EXPECT_GT(visible, 1000U);
      if (std::string_view(format) != "f32") {
        EXPECT_LE(differ, visible / 20);
      }
    }
}

TEST(DepthMapping, ShowsTheSamePictureUnderEveryMapping) {
  const Scene original = make_builtin("knot", 96, 96, {}, 1);
  const Rendering plain = render_functional(original, with(DepthMapping::projection, "plane", 24), {});
  for (const DepthMapping mapping : kMappings) {
    const Config config =
        with(mapping, is_screen_linear(mapping) ? "plane" : "u24", is_screen_linear(mapping) ? 24 : 32);
    const Rendering r = render_functional(in_depth_mapping(original, mapping), config, {});
    EXPECT_EQ(r.frame.color, plain.frame.color) << label(config);
  }
}

TEST(DepthMapping, EncodingRisesWithThePlaneAndDecodesIntoItsBin) {
  std::mt19937 random(5);
  for (const DepthMapping mapping : kMappings)
    for (const auto format : {"u16", "bins12", "f16", "uf4.12"}) {
      const Config config = with(mapping, format, 24);
      const DepthEncode encode(config, DepthPlanes{0.5, 2000});
      std::uint32_t last = 0, last_code = 0;
      for (int i = 0; i < 4000; ++i) {
        const std::uint32_t plane =
            std::min<std::uint32_t>(last + static_cast<std::uint32_t>(random() % 8400), (1U << 24) - 1);
        const std::uint32_t code = encode(plane);
        EXPECT_GE(code, last_code) << label(config);
        const auto back = static_cast<std::uint32_t>(std::floor(encode.plane_value(code) * ((1 << 24) - 1) + 0.5L));
        EXPECT_LE(std::abs(static_cast<std::int64_t>(encode(back)) - static_cast<std::int64_t>(code)), 1);
        last = plane;
        last_code = code;
      }
      EXPECT_EQ(encode(0), 0U) << label(config);
      EXPECT_EQ(encode((1U << 24) - 1), top_code(encode.format())) << label(config);
    }
}

TEST(DepthMapping, RefusesWhatItCannotMap) {
  Scene scene = make_builtin("teapot", 32, 32, {}, 1);
  scene.planes.reset();
  EXPECT_THROW((void)in_depth_mapping(scene, DepthMapping::rev), InputError);
  EXPECT_THROW(DepthEncode(with(DepthMapping::w, "u16", 24), std::nullopt), InputError);
  for (const DepthPlanes& planes : {DepthPlanes{1, INFINITY}, {2, 2}, {0, 1}})
    EXPECT_THROW(DepthEncode(with(DepthMapping::log, "u16", 24), planes), InputError);
  scene.planes = {0.1, INFINITY};
  EXPECT_THROW((void)in_depth_mapping(scene, DepthMapping::std), InputError);
  EXPECT_NO_THROW((void)in_depth_mapping(scene, DepthMapping::revinf));
  scene.states[0].depth_range = {0.25, 0.5};
  scene.planes = {0.1, 10.0};
  EXPECT_THROW((void)in_depth_mapping(scene, DepthMapping::log), InputError);
  EXPECT_THROW(check_hardware_scene(scene, with(DepthMapping::std, "f16", 24)), InputError);
  EXPECT_NO_THROW(check_hardware_scene(scene, with(DepthMapping::rev, "u24", 24)));
}

TEST(DepthMapping, WindowDepthIsTheStoredDepthItself) {
  Scene scene;
  scene.width = scene.height = 16;
  scene.planes = {1.0, 100.0};
  State state;
  state.space = Space::window;
  scene.states.push_back(state);
  scene.vertices = {{-20, -20, 0.25}, {60, -20, 0.25}, {-20, 60, 0.25}};
  scene.indices = {0, 1, 2};
  scene.commands = {Clear{0, {}, 1.0}, Draw{0, 0, Topology::triangles, 0, 3, 0}};
  for (const DepthMapping mapping : kMappings) {
    const Config config = with(mapping, "u16", 32);
    const Rendering r = render_functional(in_depth_mapping(scene, mapping), config, {});
    EXPECT_EQ(r.frame.depth[r.frame.at(8, 4)], 16384U) << label(config);
    EXPECT_EQ(golden::render(in_depth_mapping(scene, mapping), config).frame.depth[r.frame.at(8, 4)], 16384U);
  }
}

}  // namespace
}  // namespace halfplane::depth_format_test
