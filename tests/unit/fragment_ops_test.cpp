// Alpha test, stencil, blending, dithering and masks: the arithmetic against real numbers and against tables of its own.
#include "model/stages/fragment_ops.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "model/golden/color.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/compare/layers.hpp"
#include "tests/scene_builder.hpp"

namespace halfplane::fragment_ops_test {
namespace {

using test::Random;

TEST(Blend, AQuotientBy255IsTheNearestForEverySumOfTwoProducts) {
  for (std::uint32_t sum = 0; sum <= 2 * 255 * 255; ++sum)
    ASSERT_EQ(std::min(divide_by_255(sum), 255U),
              static_cast<std::uint32_t>(std::floor(std::min(sum / 255.0, 255.0) + 0.5)))
        << sum;
}

/// Random operations that blend.
State blending_state(Random& random) {
  State state;
  const auto choose = chooser(random);
  for (const char* name : {"blend", "blend_equation", "blend_color", "color_mask", "dither"})
    draw_state(name).set(state, random_value(draw_state(name), choose));
  if (!state.blend) state.blend.emplace();
  return state;
}

TEST(Blend, OneBlendIsWithinHalfACodeOfRealArithmeticWhateverItsFactors) {
  Random random(24);
  double worst = 0;
  for (int n = 0; n < 200000; ++n) {
    State state = blending_state(random);
    state.color_mask = {true, true, true, true};
    constexpr auto format = ColorFormat::rgba8888;
    Channels<std::uint32_t> source;
    for (auto& c : source) c = static_cast<std::uint32_t>(random.index(256));
    const auto stored = static_cast<std::uint32_t>(random.unit() * 4294967296.0);
    const Channels<std::uint32_t> held = unpack_color(format, stored);
    const auto real_of = [](const Channels<std::uint32_t>& c) {
      return std::array{double(c[0]), double(c[1]), double(c[2]), double(c[3])};
    };
    const std::array<double, 4> real = golden::blended(state, real_of(source), real_of(held));
    const Channels<std::uint32_t> made =
        unpack_color(format, store_color(color_ops(state, format), format, source, stored, 0U));
    for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(made[c] - real[c]));
  }
  EXPECT_LE(worst, 0.5 + 1e-9);
}

// A stored code of rgb565 is widened to 8 bits, which is off by up to 0.082 codes of 5 bits and 0.177 of 6; a blend is
// rounded to 8 bits (0.061, 0.124) and then to the code (0.5). A factor at the stored colour, or on it, says how much of the
// first is left. Every source, alpha and stored code; the factors of each kind that are worst.
TEST(Blend, OneBlendOfRgb565IsWithinItsBoundOverEveryValue) {
  struct Case {
    BlendFactor src, dst;
    BlendEquation equation;
    std::array<double, 2> worst;  ///< stored codes of 5 bits, of 6
  };
  for (const Case& c :
       {Case{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendEquation::add, {0.635, 0.764}},
        Case{BlendFactor::src_alpha, BlendFactor::one, BlendEquation::add, {0.640, 0.793}},
        Case{BlendFactor::src_alpha, BlendFactor::one, BlendEquation::reverse_subtract, {0.640, 0.793}},
        Case{BlendFactor::src_alpha, BlendFactor::dst_color, BlendEquation::add, {0.707, 0.959}},
        Case{BlendFactor::dst_color, BlendFactor::dst_color, BlendEquation::add, {0.707, 0.959}}}) {
    State state;
    state.blend = BlendFactors{c.src, c.dst, c.src, c.dst};
    state.blend_equation = {c.equation, c.equation};
    constexpr auto format = ColorFormat::rgb565;
    const ColorOps ops = color_ops(state, format);
    const bool has_alpha = c.src == BlendFactor::src_alpha;
    std::array<double, 2> worst{};
    for (std::uint32_t code = 0; code < 64; ++code)
      for (std::uint32_t s = 0; s < 256; ++s)
        for (std::uint32_t alpha = has_alpha ? 0 : 255; alpha < 256; ++alpha) {
          const std::uint32_t stored = (code % 32) << 11 | code << 5;
          const Channels<std::uint32_t> made =
              unpack_color(format, store_color(ops, format, {s, s, s, alpha}, stored, 0U));
          const std::array<double, 4> real = golden::blended(state, {double(s), double(s), double(s), double(alpha)},
                                                             {(code % 32) * 255.0 / 31, code * 255.0 / 63, 0, 255});
          worst[0] = std::max(worst[0], std::abs(made[0] - real[0] * 31 / 255));
          worst[1] = std::max(worst[1], std::abs(made[1] - real[1] * 63 / 255));
        }
    for (const std::size_t bits : {0U, 1U})
      EXPECT_LE(worst[bits], c.worst[bits] + 0.0006) << static_cast<int>(c.src) << ", " << static_cast<int>(c.dst);
    EXPECT_GT(worst[1], 0.7);
    std::printf("rgb565 %d, %d: %.4f %.4f\n", static_cast<int>(c.src), static_cast<int>(c.dst), worst[0], worst[1]);
  }
}

TEST(Blend, WhatDoesNothingIsPlain) {
  State state;
  EXPECT_TRUE(color_ops(state, ColorFormat::rgba8888).is_plain());
  state.blend = BlendFactors{};
  EXPECT_TRUE(color_ops(state, ColorFormat::rgba8888).is_plain()) << "one, zero";
  state.blend_equation = {BlendEquation::subtract, BlendEquation::add};
  EXPECT_TRUE(color_ops(state, ColorFormat::rgba8888).is_plain()) << "less nothing";
  state.blend_equation = {BlendEquation::add, BlendEquation::max};
  EXPECT_FALSE(color_ops(state, ColorFormat::rgba8888).is_plain());
  EXPECT_TRUE(color_ops(state, ColorFormat::rgb565).is_plain()) << "no alpha is stored";
  state.blend.reset();
  state.color_mask[3] = false;
  EXPECT_TRUE(color_ops(state, ColorFormat::rgb565).is_plain());
  EXPECT_TRUE(color_ops(state, ColorFormat::rgba8888).reads_stored());
  state.color_mask = {false, false, false, true};
  EXPECT_FALSE(writes_color(state, ColorFormat::rgb565));
  EXPECT_TRUE(writes_color(state, ColorFormat::rgba8888));
}

TEST(Blend, WhatReplacesWhereTheSourceIsOpaqueDoesSoWhateverIsStored) {
  std::uint32_t replacing = 0, others_seen = 0;
  Random random(5);
  for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888})
    for (int n = 0; n < 20000; ++n) {
      State state;
      const auto factor = [&] { return static_cast<BlendFactor>(random.index(15)); };
      const auto equation = [&] { return static_cast<BlendEquation>(random.index(5)); };
      state.blend = BlendFactors{factor(), factor(), factor(), factor()};
      if (n % 2 == 0) state.blend_equation = {equation(), equation()};
      if (n % 5 == 0) state.color_mask[static_cast<std::size_t>(random.index(4))] = false;
      state.dither = n % 7 == 0;
      const ColorOps ops = color_ops(state, format);
      bool is_seen = false;
      for (int k = 0; k < 20; ++k) {
        const auto code = [&] { return static_cast<std::uint32_t>(random.index(256)); };
        const Channels<std::uint32_t> source{code(), code(), code(), 255}, other{code(), code(), code(), code()};
        const auto stored = pack_color<std::uint32_t>(format, other);
        const auto now = store_color<std::uint32_t>(ops, format, source, stored, static_cast<std::uint32_t>(n % 16));
        is_seen |= now != pack_color<std::uint32_t>(format, source);
      }
      if (!replaces_where_opaque(ops, format)) {
        others_seen += is_seen ? 1 : 0;
        continue;
      }
      ++replacing;
      EXPECT_FALSE(is_seen) << n;
    }
  EXPECT_GT(replacing, 100U);
  EXPECT_GT(others_seen, 30000U);
}

TEST(AlphaTest, WhatItComesToForARangeIsWhatItSaysOfEachValue) {
  for (const DepthFunc func : {DepthFunc::never, DepthFunc::less, DepthFunc::lequal, DepthFunc::equal,
                               DepthFunc::greater, DepthFunc::gequal, DepthFunc::notequal, DepthFunc::always})
    for (const std::uint32_t reference : {0U, 1U, 7U, 8U, 15U})
      for (std::uint32_t low = 0; low < 16; ++low) {
        bool all = true, any = false;
        for (std::uint32_t high = low; high < 16; ++high) {
          const bool passes = depth_passes(func, high, reference);
          all = all && passes;
          any = any || passes;
          const Outcome outcome = test_outcome(func, reference, low, high);
          EXPECT_EQ(outcome == Outcome::all_pass, all);
          EXPECT_EQ(outcome == Outcome::none_passes, !any);
        }
      }
}

TEST(Dither, SixteenPixelsTogetherHaveTheColourThatOneCannotHave) {
  double worst = 0, worst_mean = 0;
  for (std::uint32_t c = 0; c < 256; ++c) {
    std::array<double, 3> sum{};
    const std::array<double, 3> most{31, 63, 31};
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const std::uint32_t code = pack_rgb565_dithered(c, c, c, dither_threshold(x, y));
        const Channels<std::uint32_t> stored = unpack_color(ColorFormat::rgb565, code);
        for (std::size_t i = 0; i < 3; ++i) {
          worst = std::max(worst, std::abs(stored[i] - c * most[i] / 255));
          sum[i] += stored[i];
        }
      }
    for (std::size_t i = 0; i < 3; ++i) worst_mean = std::max(worst_mean, std::abs(sum[i] / 16 - c * most[i] / 255));
  }
  EXPECT_LE(worst, 0.97);
  EXPECT_LE(worst_mean, 0.05);
  EXPECT_GT(worst, 0.9);
}

TEST(Stencil, EveryOperationDoesWhatTheGoldenDoes) {
  for (int op = 0; op < 8; ++op)
    for (const int mask : {0, 1, 0x55, 0xf0, 255})
      for (int reference = 0; reference < 256; reference += 17)
        for (int stored = 0; stored < 256; ++stored) {
          Stencil s;
          s.reference = static_cast<std::uint8_t>(reference);
          s.write_mask = static_cast<std::uint8_t>(mask);
          ASSERT_EQ(apply_stencil(static_cast<StencilOp>(op), s, static_cast<std::uint32_t>(stored)),
                    static_cast<std::uint32_t>(golden::operated(static_cast<StencilOp>(op), s, stored)))
              << op << " " << mask << " " << reference << " " << stored;
        }
}

TEST(Stencil, WhatTheAlphaTestDropsLeavesNothingBehind) {
  State state;
  state.stencil = Stencil{.func = DepthFunc::always, .reference = 7, .passes = StencilOp::replace};
  state.alpha_test = {DepthFunc::greater, 100};
  const FragmentOps ops = fragment_ops(state, ColorFormat::rgb565);
  std::uint32_t depth = 50, color = 3;
  std::uint8_t stencil = 1;
  const auto run = [&](std::uint32_t z, std::uint32_t alpha) {
    return apply_fragment(ops, ColorFormat::rgb565, {z},
                          [alpha] {
                            return Channels<std::uint32_t>{255, 255, 255, alpha};
                          },
                          {depth, color, stencil});
  };
  EXPECT_EQ(run(40, 100), Fate::killed);
  EXPECT_EQ(run(60, 100), Fate::failed) << "the depth test comes first in the counters";
  EXPECT_EQ(depth, 50U);
  EXPECT_EQ(color, 3U);
  EXPECT_EQ(stencil, 1);
  EXPECT_EQ(run(40, 101), Fate::passed);
  EXPECT_EQ(depth, 40U);
  EXPECT_EQ(color, 0xffffU);
  EXPECT_EQ(stencil, 7);
}

TEST(Blend, LanesDoWhatTheScalarInstanceDoes) {
  typedef std::uint32_t Four __attribute__((vector_size(16)));  // NOLINT(modernize-use-using)
  Random random(5);
  for (int n = 0; n < 20000; ++n) {
    const State state = blending_state(random);
    const auto format = random.index(2) == 0 ? ColorFormat::rgb565 : ColorFormat::rgba8888;
    const ColorOps ops = color_ops(state, format);
    Channels<Four> source;
    Four stored, threshold;
    for (int i = 0; i < 4; ++i) {
      for (Four& c : source) c[i] = static_cast<std::uint32_t>(random.index(256));
      stored[i] = static_cast<std::uint32_t>(random.unit() * (format == ColorFormat::rgb565 ? 65536.0 : 4294967296.0));
      threshold[i] = static_cast<std::uint32_t>(random.index(16));
    }
    const Four made = store_color(ops, format, source, stored, threshold);
    for (int i = 0; i < 4; ++i) {
      const Channels<std::uint32_t> one{source[0][i], source[1][i], source[2][i], source[3][i]};
      ASSERT_EQ(made[i], store_color(ops, format, one, std::uint32_t{stored[i]}, std::uint32_t{threshold[i]})) << n;
    }
    Stencil s;
    s.reference = static_cast<std::uint8_t>(random.index(256));
    s.write_mask = static_cast<std::uint8_t>(random.index(256));
    const auto op = static_cast<StencilOp>(random.index(8));
    const Four values = stored & 255;
    const Four after = apply_stencil(op, s, values);
    for (int i = 0; i < 4; ++i) ASSERT_EQ(after[i], apply_stencil(op, s, std::uint32_t{values[i]}));
  }
}

// The golden's operations are written one by one, the model's are one sum.
TEST(LogicOp, StoresWhatTheGoldenHasOnTheSameCodes) {
  Random random(41);
  for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888})
    for (int n = 0; n < 64000; ++n) {
      State state;
      state.logic_op = static_cast<LogicOp>(n % 16);
      if (state.logic_op == LogicOp::copy) continue;  // it is none: the golden rounds nothing
      state.blend = BlendFactors{BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one};
      if (n % 3 == 0) state.color_mask[random.index(4)] = false;
      const bool has_alpha = format == ColorFormat::rgba8888;
      Channels<std::uint32_t> source;
      for (auto& c : source) c = static_cast<std::uint32_t>(random.index(256));
      const auto stored = static_cast<std::uint32_t>(random.unit() * (has_alpha ? 4294967296.0 : 65536.0));
      const Channels<std::uint32_t> held = unpack_color(format, stored);
      golden::RealColor s{}, d{};
      for (std::size_t c = 0; c < 4; ++c) {
        s[c] = source[c];
        d[c] = held[c] * 255.0 / golden::largest_code(has_alpha, c);
      }
      const golden::RealColor real = golden::blended(state, s, d, has_alpha);
      const std::uint32_t made = store_color(color_ops(state, format), format, source, stored, 0U);
      ASSERT_TRUE(has_alpha || made <= 0xffffU);
      const Channels<std::uint32_t> channels = unpack_color(format, made);
      for (std::size_t c = 0; c < (has_alpha ? 4U : 3U); ++c)
        ASSERT_NEAR(channels[c], real[c] * golden::largest_code(has_alpha, c) / 255, 1e-9)
            << draw_state("logic_op").words[static_cast<std::size_t>(n % 16)] << ", channel " << c;
    }
}

TEST(LogicOp, ReadsWhatIsStoredWhereItsResultDependsOnIt) {
  for (int op = 0; op < 16; ++op) {
    State state;
    state.logic_op = static_cast<LogicOp>(op);
    const ColorOps ops = color_ops(state, ColorFormat::rgba8888);
    bool depends = false;
    for (const std::uint32_t source : {0U, 255U}) {
      const Channels<std::uint32_t> all{source, source, source, source};
      depends = depends || store_color(ops, ColorFormat::rgba8888, all, 0U, 0U) !=
                               store_color(ops, ColorFormat::rgba8888, all, ~0U, 0U);
    }
    EXPECT_EQ(ops.reads_stored(), depends) << op;
    EXPECT_FALSE(ops.blends());
    EXPECT_EQ(ops.is_plain(), state.logic_op == LogicOp::copy);
    EXPECT_EQ(replaces_where_opaque(ops, ColorFormat::rgba8888), state.logic_op == LogicOp::copy);
  }
}

TEST(LogicOp, CopyLeavesBlendingAndAnyOtherTakesItsPlace) {
  State state;
  state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one, BlendFactor::one, BlendFactor::one};
  EXPECT_TRUE(color_ops(state, ColorFormat::rgb565).blends());
  state.logic_op = LogicOp::xor_op;
  EXPECT_FALSE(color_ops(state, ColorFormat::rgb565).blends());
  state.blend.reset();
  const ColorOps without = color_ops(state, ColorFormat::rgb565);
  state.blend = BlendFactors{BlendFactor::dst_color, BlendFactor::one, BlendFactor::one, BlendFactor::one};
  EXPECT_EQ(color_ops(state, ColorFormat::rgb565), without);
}

/// One fragment under an operation, over a cleared pixel.
double part_of_bound(LogicOp op, const std::array<double, 4>& cleared, std::uint32_t stored) {
  LayeredColors layers(1, ColorFormat::rgb565);
  State state;
  state.logic_op = op;
  layers.clear(0, cleared);
  layers.write(0, state, {200, 100, 50, 255});
  layers.judge(0, stored);
  return layers.rows().back().part_of_bound;
}

// 24, 25 and 6 are the codes of 200, 100 and 50; 8, 16 and 31 the codes of 66, 65 and 255.
TEST(LogicOp, OnCertainCodesTheBoundTakesNoOtherBit) {
  const std::array<double, 4> whole{66, 65, 255, 255};
  const auto rgb = [](unsigned r, unsigned g, unsigned b) { return r << 11 | g << 5 | b; };
  EXPECT_LE(part_of_bound(LogicOp::xor_op, whole, rgb(24 ^ 8, 25 ^ 16, 6 ^ 31)), 1);
  EXPECT_GT(part_of_bound(LogicOp::xor_op, whole, rgb(24 ^ 8, 25 ^ 16, 6 ^ 30)), 1000);
  EXPECT_GT(part_of_bound(LogicOp::or_op, whole, rgb(24 ^ 8, 25 ^ 16, 6 ^ 31)), 1000);
}

TEST(LogicOp, WhereACodeIsUncertainTheBoundHasEveryCodeItMayBe) {
  const std::array<double, 4> between{66.4, 65, 255, 255};  // 7 to 9 is within the bound of a clear
  const auto rgb = [](unsigned r, unsigned g, unsigned b) { return r << 11 | g << 5 | b; };
  for (const unsigned red : {8U, 9U})
    EXPECT_LE(part_of_bound(LogicOp::xor_op, between, rgb(24 ^ red, 25 ^ 16, 6 ^ 31)), 1) << red;
  EXPECT_GT(part_of_bound(LogicOp::xor_op, between, rgb(24 ^ 24, 25 ^ 16, 6 ^ 31)), 1);
}

}  // namespace
}  // namespace halfplane::fragment_ops_test
