// Texture filter: wrap, weights and sums against their definitions in real numbers.
#include "model/stages/texture_filter.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>

namespace halfplane::texture_filter_test {
namespace {

constexpr std::array kWraps{TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror, TextureWrap::border,
                            TextureWrap::half_border};

/// A texel that any two places and levels have in common only by chance.
Texel noise(int level, int x, int y) {
  std::uint32_t hash = static_cast<std::uint32_t>(level) * 0x9e3779b9U ^ static_cast<std::uint32_t>(x) * 0x85ebca6bU ^
                       static_cast<std::uint32_t>(y) * 0xc2b2ae35U;
  hash = (hash ^ hash >> 15) * 0x2c1b3c6dU;
  hash ^= hash >> 13;
  return {static_cast<std::uint8_t>(hash), static_cast<std::uint8_t>(hash >> 8), static_cast<std::uint8_t>(hash >> 16),
          static_cast<std::uint8_t>(hash >> 24)};
}

/// The image that comes again, told by walking: one step of i is one step along it.
int walked_texel(int i, const TextureAxis& axis) {
  int at = 0, way = 1;
  for (int n = 0; n != i; n += i < 0 ? -1 : 1) {
    const int step = i < 0 ? -way : way;
    const bool is_end = at + step < 0 || at + step >= axis.size;
    if (!is_end) {
      at += step;
    } else if (axis.wrap == TextureWrap::repeat) {
      at = step > 0 ? 0 : axis.size - 1;
    } else if (axis.wrap == TextureWrap::mirror) {
      way = -way;  // the last texel twice
    }
  }
  return at;
}

TEST(TextureWrap, EveryTexelIsTheOneThatAWalkComesTo) {
  for (const TextureWrap wrap : kWraps)
    for (const int size : {1, 2, 3, 4, 5, 7, 8, 12, 16, 31, 64})
      for (int i = -3 * size - 2; i <= 3 * size + 2; ++i) {
        if (!has_period(wrap)) {
          EXPECT_EQ(wrapped_texel(i, {size, wrap}), std::clamp(i, 0, size - 1));
        } else {
          EXPECT_EQ(wrapped_texel(i, {size, wrap}), walked_texel(i, {size, wrap})) << size << " " << i;
        }
      }
}

TEST(TextureWrap, MaskAndModuloAreTheSameForEverySize) {
  for (const TextureWrap wrap : kWraps)
    for (int size = 1; size <= 4096; ++size) {
      const TextureAxis axis{size, wrap};
      EXPECT_EQ(axis.is_power_of_two(), (size & (size - 1)) == 0);
      for (const int i : {-8193, -size - 1, -size, -1, 0, 1, size - 1, size, 2 * size - 1, 2 * size, 8193}) {
        const int texel = wrapped_texel(i, axis);
        ASSERT_TRUE(texel >= 0 && texel < size) << size << " " << i;
        if (!has_period(wrap)) continue;
        ASSERT_EQ(texel, wrapped_texel(i + axis.period(), axis)) << size << " " << i;
      }
    }
}

TEST(TextureWrap, AReferenceAddedModuloThePeriodChangesNoTexel) {
  std::mt19937 random(1);
  const auto between = [&random](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
  };
  for (int n = 0; n < 20000; ++n) {
    const TextureAxis axis{between(0, 1) == 0 ? 1 << between(0, 12) : between(1, 4096),
                           kWraps[static_cast<std::size_t>(between(0, 4))]};
    const int reference = between(-100000, 100000), u = between(-(1 << 20), 1 << 20);
    const std::int64_t plain = u + reference * std::int64_t{256};
    const std::int64_t coordinate = texture_coordinate(u, wrapped_reference(reference, axis), 8, axis);
    EXPECT_EQ(wrapped_texel(coordinate >> 8, axis), wrapped_texel(plain >> 8, axis));
    EXPECT_EQ(coordinate & 255, plain & 255);
    if (!has_period(axis.wrap)) continue;
    EXPECT_GE(coordinate, 0);
    EXPECT_LT(coordinate, axis.period() << 8);
  }
  // Far beyond an image that is clamped, any reference is as good as another.
  const TextureAxis clamped{64, TextureWrap::clamp};
  EXPECT_EQ(wrapped_texel(texture_coordinate(-(1 << 28), wrapped_reference(1e300, clamped), 8, clamped) >> 8, clamped),
            63);
  EXPECT_EQ(wrapped_texel(texture_coordinate(1 << 28, wrapped_reference(-1e300, clamped), 8, clamped) >> 8, clamped),
            0);
}

TEST(TextureFilter, ACoordinateOnALevelIsTheScaledOneCutOff) {
  std::mt19937 random(2);
  for (int n = 0; n < 20000; ++n) {
    const TextureAxis axis{1 + static_cast<int>(random() % 4096), TextureWrap::repeat};
    const int level = static_cast<int>(random() % 13), f = 6 + static_cast<int>(random() % 3);
    const std::int64_t coordinate = static_cast<std::int64_t>(random() % (1U << 22)) - (1 << 21);
    const double exact =
        std::ldexp(static_cast<double>(coordinate), kTexelFraction - f) * axis.at_level(level).size / axis.size;
    EXPECT_EQ(at_level(coordinate, f, axis, level), static_cast<std::int64_t>(std::floor(exact)))
        << coordinate << " of " << axis.size << " at " << level;
    EXPECT_EQ(rounded_at_level(coordinate, f, axis, level), static_cast<std::int64_t>(std::floor(exact + 0.5)));
  }
  EXPECT_EQ(at_level(640, 8, {256, TextureWrap::repeat}, 3), 80);
  EXPECT_EQ(at_level(640, 8, {4, TextureWrap::repeat}, 3), 160) << "the last level of this axis has one texel";
}

/// The texels of an image at real coordinates of its level, blended in real numbers.
std::array<double, 4> real_linear(const TextureAxes& axes, double u, double v, int level) {
  const double left = std::floor(u - 0.5), top = std::floor(v - 0.5), a = u - 0.5 - left, b = v - 0.5 - top;
  std::array<double, 4> sum{};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const Texel texel = noise(level, wrapped_texel(static_cast<std::int64_t>(left) + i, axes[0].at_level(level)),
                                wrapped_texel(static_cast<std::int64_t>(top) + j, axes[1].at_level(level)));
      for (std::size_t c = 0; c < 4; ++c) sum[c] += (i == 0 ? 1 - a : a) * (j == 0 ? 1 - b : b) * texel[c];
    }
  return sum;
}

/// How far filters are from real ones at the hardware's own coordinates, over random places, in LSB.
struct FilterErrors {
  double linear = 0, trilinear = 0, linear_real = 0;
};
FilterErrors filter_errors(std::uint32_t seed, int places) {
  std::mt19937 random(seed);
  FilterErrors worst;
  for (int n = 0; n < places; ++n) {
    const TextureAxes axes{TextureAxis{1 << random() % 10, kWraps[random() % 3]},
                           TextureAxis{1 << random() % 10, kWraps[random() % 3]}};
    const TexturePlace place{{static_cast<std::int64_t>(random() % (1U << 20)) - (1 << 19),
                              static_cast<std::int64_t>(random() % (1U << 20)) - (1 << 19)},
                             8};
    const LevelPair levels{static_cast<int>(random() % 5), static_cast<int>(random() % 5),
                           static_cast<std::uint32_t>(random() % 256)};
    const auto at = [&](std::size_t axis, int level) {
      return std::ldexp(static_cast<double>(rounded_at_level(place.coordinate[axis], 8, axes[axis], level)), -8);
    };
    const auto lower = real_linear(axes, at(0, levels.lower), at(1, levels.lower), levels.lower),
               upper = real_linear(axes, at(0, levels.upper), at(1, levels.upper), levels.upper);
    const Texel linear = filter_linear(noise, axes, place, levels.lower),
                trilinear = filter_trilinear(noise, axes, place, levels);
    const auto exact = [&](std::size_t axis) {
      return std::ldexp(static_cast<double>(place.coordinate[axis]), -8) * axes[axis].at_level(levels.lower).size /
             axes[axis].size;
    };
    const auto real = real_linear(axes, exact(0), exact(1), levels.lower);
    for (std::size_t c = 0; c < 4; ++c) {
      const double between = lower[c] + (upper[c] - lower[c]) * levels.part / 256;
      worst.linear = std::max(worst.linear, std::abs(linear[c] - lower[c]));
      worst.trilinear = std::max(worst.trilinear, std::abs(trilinear[c] - between));
      worst.linear_real = std::max(worst.linear_real, std::abs(linear[c] - real[c]));
    }
  }
  return worst;
}

TEST(TextureFilter, SumsAreRoundedOnce) {
  const FilterErrors worst = filter_errors(1, 200000);
  std::printf("linear %.5f, trilinear %.5f LSB; with all bits of the coordinate %.3f\n", worst.linear, worst.trilinear,
              worst.linear_real);
  EXPECT_LE(worst.linear, 0.5);
  EXPECT_GT(worst.linear, 0.49);
  EXPECT_LE(worst.trilinear, 0.5 + std::ldexp(1.0, -9));
  EXPECT_LE(worst.linear_real, 0.5 + 255.0 / 256) << "half of 2^-8 along each axis";
}

TEST(TextureFilter, NearestIsTheTexelThatHoldsThePlace) {
  const TextureAxes axes{TextureAxis{8, TextureWrap::repeat}, TextureAxis{5, TextureWrap::mirror}};
  for (int v = -3000; v < 3000; v += 37)
    for (int u = -3000; u < 3000; u += 41) {
      EXPECT_EQ(filter_nearest(noise, axes, {{u, v}, 8}, 0),
                noise(0, walked_texel(u >> 8, axes[0]), walked_texel(v >> 8, axes[1])));
      EXPECT_EQ(filter_nearest(noise, axes, {{u, v}, 6}, 1),
                noise(1, walked_texel(u >> 7, {4, TextureWrap::repeat}),
                      walked_texel(static_cast<int>(std::floor(v / 64.0 * 2 / 5)), {2, TextureWrap::mirror})));
    }
}

// OpenGL 1.5, 3.8.7: CLAMP_TO_BORDER takes the border for every texel beyond the image; CLAMP holds the coordinate in
// [0, 1], so that a linear filter at a side mixes half the border, and a nearest one sees none of it.
TEST(TextureFilter, BeyondTheImageIsTheBorder) {
  const Texel border{201, 17, 99, 54};
  for (const int size : {1, 2, 5, 8})
    for (int u = -5 * 256; u <= (size + 5) * 256; u += 3)
      for (const TextureWrap wrap : {TextureWrap::border, TextureWrap::half_border}) {
        const TextureAxes axes{TextureAxis{size, wrap}, TextureAxis{4, TextureWrap::clamp}};
        const TexturePlace place{{u, 2 * 256 + 128}, 8};  // on the middle of a row
        const bool is_held = wrap == TextureWrap::half_border;
        const auto texel = [&](int x, bool shows_border) {
          return shows_border && (x < 0 || x >= size) ? border : noise(0, std::clamp(x, 0, size - 1), 2);
        };
        EXPECT_EQ(filter_nearest(noise, axes, place, 0, border), texel(u >> 8, !is_held)) << size << ' ' << u;
        const double at = (is_held ? std::clamp(u / 256.0, 0.0, double(size)) : u / 256.0) - 0.5, left = std::floor(at);
        const Texel first = texel(static_cast<int>(left), true), second = texel(static_cast<int>(left) + 1, true),
                    linear = filter_linear(noise, axes, place, 0, border);
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_EQ(linear[c], std::floor(first[c] + (at - left) * (second[c] - first[c]) + 0.5)) << size << ' ' << u;
      }
}

TEST(TextureFilter, ABorderIsThatOfEachLevel) {
  const Texel border{1, 2, 3, 4};
  const TextureAxes axes{TextureAxis{16, TextureWrap::border}, TextureAxis{16, TextureWrap::border}};
  for (int level = 0; level < 5; ++level) {
    EXPECT_EQ(filter_nearest(noise, axes, {{16 * 256 - 1, 0}, 8}, level, border), noise(level, (16 >> level) - 1, 0));
    EXPECT_EQ(filter_nearest(noise, axes, {{16 * 256, 0}, 8}, level, border), border);
    EXPECT_EQ(filter_nearest(noise, axes, {{5, -1}, 8}, level, border), border);
    EXPECT_EQ(filter_linear(noise, axes, {{-(128 << level), 5}, 8}, level, border), border);
  }
}

TEST(TextureFilter, TheMiddleOfATexelIsThatTexelWhateverTheFilter) {
  const TextureAxes axes{TextureAxis{16, TextureWrap::repeat}, TextureAxis{16, TextureWrap::clamp}};
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const TexturePlace middle{{x * 256 + 128, y * 256 + 128}, 8};
      EXPECT_EQ(filter_linear(noise, axes, middle, 0), noise(0, x, y));
      EXPECT_EQ(filter_nearest(noise, axes, middle, 0), noise(0, x, y));
      EXPECT_EQ(filter_trilinear(noise, axes, middle, {0, 3, 0}), noise(0, x, y));
    }
}

TEST(TextureFilter, OneColorStaysThatColor) {
  std::mt19937 random(3);
  for (int n = 0; n < 5000; ++n) {
    const auto c = static_cast<std::uint8_t>(random());
    const Texel color{c, c, c, c};
    const auto fetch = [&color](int, int, int) { return color; };
    const TexturePlace place{{static_cast<std::int64_t>(random() % 65536), static_cast<std::int64_t>(random() % 65536)},
                             8};
    const TextureAxes axes{TextureAxis{64, TextureWrap::repeat}, TextureAxis{48, TextureWrap::mirror}};
    const LevelPair levels{1, 2, static_cast<std::uint32_t>(random() % 256)};
    EXPECT_EQ(filter_linear(fetch, axes, place, 1), color);
    EXPECT_EQ(filter_trilinear(fetch, axes, place, levels), color);
    EXPECT_EQ(filter_between_nearest(fetch, axes, place, levels), color);
  }
}

TEST(TextureFilter, BetweenTwoNearestLevelsIsTheRoundedMean) {
  const TextureAxes axes{TextureAxis{64, TextureWrap::repeat}, TextureAxis{64, TextureWrap::repeat}};
  for (std::uint32_t part = 0; part < 256; ++part) {
    const TexturePlace place{{static_cast<std::int64_t>(part) * 61, static_cast<std::int64_t>(part) * 17}, 8};
    const Texel lower = filter_nearest(noise, axes, place, 2), upper = filter_nearest(noise, axes, place, 3),
                blended = filter_between_nearest(noise, axes, place, {2, 3, part});
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_EQ(blended[c], std::floor((lower[c] * (256.0 - part) + upper[c] * static_cast<double>(part)) / 256 + 0.5));
  }
}

TEST(TextureFilter, ALinearFilterLooksAtTheFourBanksOnce) {
  // Texels of one footprint differ in the lowest bits of x and y, so that four banks answer at once; but where clamp,
  // mirror or a side of one texel make two of them one.
  const TextureAxes axes{TextureAxis{32, TextureWrap::repeat}, TextureAxis{32, TextureWrap::repeat}};
  for (std::int64_t n = 0; n < 10000; n += 7) {
    std::set<std::pair<int, int>> banks;
    const auto fetch = [&banks](int, int x, int y) {
      banks.emplace(x & 1, y & 1);
      return Texel{};
    };
    (void)filter_linear(fetch, axes, {{n, 3 * n}, 8}, 0);
    EXPECT_EQ(banks.size(), 4U);
  }
}

TEST(TextureCombine, EveryProductIsRoundedExactly) {
  for (std::uint32_t value = 0; value <= 255 * 255; ++value)
    EXPECT_EQ(divide_by_255(value), std::floor(value / 255.0 + 0.5)) << value;
}

TEST(TextureCombine, IsOpenGLsTable) {
  const Texel color{200, 100, 50, 128}, texel{255, 128, 0, 64};
  const auto of = [&](TextureCombine combine, bool has_alpha) {
    return combined(color, texel, combine, has_alpha, {10, 20, 30});
  };
  EXPECT_EQ(of(TextureCombine::modulate, true), (Texel{200, 50, 0, 32}));
  EXPECT_EQ(of(TextureCombine::replace, true), (Texel{255, 128, 0, 64}));
  EXPECT_EQ(of(TextureCombine::replace, false), (Texel{255, 128, 0, 128}));
  EXPECT_EQ(of(TextureCombine::decal, true), (Texel{214, 107, 37, 128}));
  EXPECT_EQ(of(TextureCombine::add, true), (Texel{255, 228, 50, 32}));
  EXPECT_EQ(of(TextureCombine::blend, true), (Texel{10, 60, 50, 32}));
}

// Every colour and texel: C (255 - T) + K T over 255, to the nearest.
TEST(TextureCombine, BlendIsRoundedExactly) {
  for (int color = 0; color < 256; ++color)
    for (int texel = 0; texel < 256; ++texel)
      for (const int constant : {0, 1, 84, 127, 128, 200, 254, 255}) {
        const auto c = static_cast<std::uint8_t>(color), t = static_cast<std::uint8_t>(texel),
                   k = static_cast<std::uint8_t>(constant);
        const int sum = color * (255 - texel) + constant * texel;  // 2 sum + 255 is odd: no ties
        const Texel got = combined({c, c, c, 255}, {t, t, t, 255}, TextureCombine::blend, true, {k, k, k});
        ASSERT_EQ(got[0], (2 * sum + 255) / 510) << color << ' ' << texel << ' ' << constant;
      }
}

}  // namespace
}  // namespace halfplane::texture_filter_test
