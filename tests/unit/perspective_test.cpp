// Attributes over w: the guarantees of host, setup and pixel, and the cases at their limits. Their error is in
// accuracy/perspective_test.cpp.
#include "model/stages/perspective.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../perspective_case.hpp"
#include "model/stages/reciprocal.hpp"

namespace halfplane::perspective_test {
namespace {

using test::OverWRandom;
using test::OverWRun;
using test::OverWTriangle;
using test::perspective_design;
using test::PerspectiveDesign;

const std::array<PerspectiveDesign, 3>& designs() {
  static const std::array<PerspectiveDesign, 3> all{perspective_design("tiny", kTinyPerspective),
                                                    perspective_design("embedded", kEmbeddedPerspective),
                                                    perspective_design("full", kFullPerspective)};
  return all;
}

SnappedVertex vertex_at(int x, int y) {
  SnappedVertex v;
  v.x = x;
  v.y = y;
  return v;
}

TEST(QuantizeQ, TheLargestHasItsTopBitAndAllAreRoundedQuotients) {
  EXPECT_EQ(quantize_q({1, 2, 4}, 22), (QCodes{1U << 21, 1U << 20, 1U << 19}));
  EXPECT_EQ(quantize_q({3, 3, 3}, 16), (QCodes{43691, 43691, 43691})) << "2^17 / 3";
  EXPECT_EQ(quantize_q({1e-300, 1e300, 1}, 22), (QCodes{quantize_q({1e-300, 1, 1}, 22)[0], 1, 1})) << "at least 1";
  const double below_one = std::nextafter(1.0, 0.0);
  EXPECT_EQ(quantize_q({below_one, 1, 2}, 22)[0], 1U << 21) << "would be rounded to 2^22";
  OverWRandom random(1);
  for (int n = 0; n < 10000; ++n) {
    std::array<double, 3> w{};
    for (double& value : w) value = std::ldexp(static_cast<double>(random.between(1, 1 << 20)), -10);
    const QCodes q = quantize_q(w, 22);
    EXPECT_GE(*std::ranges::max_element(q), 1U << 21);
    EXPECT_LT(*std::ranges::max_element(q), 1U << 22);
    for (double& value : w) value = std::ldexp(value, 300);
    EXPECT_EQ(quantize_q(w, 22), q) << "only ratios count";
  }
}

TEST(QuantizeOverW, PAndXHaveTheirRanges) {
  OverWRandom random(2);
  for (const OverWFormat& attribute : {kEmbeddedPerspective.coordinate, kEmbeddedPerspective.color})
    for (int n = 0; n < 20000; ++n) {
      QCodes q{};
      for (std::uint32_t& code : q) code = static_cast<std::uint32_t>(random.between(1, (1 << 22) - 1));
      std::array<double, 3> value{};
      const int scale = static_cast<int>(random.between(-40, 12));
      for (double& v : value) v = std::ldexp(static_cast<double>(random.between(-4096, 4096)), scale - 12);
      const OverW result = quantize_over_w(value, q, attribute);
      std::int64_t largest = 0;
      double farthest = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        largest = std::max(largest, std::abs(result.p[i]));
        farthest = std::max(farthest, std::abs(value[i] - result.reference));
        const double exact = std::ldexp((value[i] - result.reference) * q[i], -result.exponent);
        EXPECT_LE(std::abs(static_cast<double>(result.p[i]) - exact), 0.5);
      }
      EXPECT_LT(largest, std::int64_t{1} << attribute.bits);
      EXPECT_LT(farthest * (1 + std::ldexp(1.0, -10)), std::ldexp(1.0, result.reach));
      EXPECT_TRUE(result.reach == 0 || farthest * (1 + std::ldexp(1.0, -10)) >= std::ldexp(0.5, result.reach));
      EXPECT_TRUE(largest >> (attribute.bits - 1) != 0 || result.exponent == result.reach - 1 - attribute.bits);
    }
  EXPECT_EQ(quantize_over_w({0, 0, 0}, {1, 1, 1}, kEmbeddedPerspective.color).p, (std::array<std::int64_t, 3>{}));
}

TEST(QuantizeOverW, RoundingUpToAPowerOfTwoTakesABitLess) {
  const OverWFormat attribute{8, 7, 0, false};
  const OverW result = quantize_over_w({255.75, 1, 0}, {1, 1, 1}, attribute);
  EXPECT_EQ(result.exponent, 1);
  EXPECT_EQ(result.p, (std::array<std::int64_t, 3>{128, 1, 0}));
}

TEST(QuantizeOverW, FarAwayValuesAreHeldAndTheirCentreStays) {
  const OverW result = quantize_over_w({-1e30, 1e30, 5}, {1 << 21, 1 << 21, 1 << 21}, kEmbeddedPerspective.coordinate);
  EXPECT_EQ(result.reference, 0);
  EXPECT_EQ(result.reach, kMaxReach);
  EXPECT_EQ(result.p[0], -result.p[1]);
}

// Without a u_ref the largest |u'| is the whole extent.
TEST(Perspective, ACentredAttributeHasTheSmallerBound) {
  PerspectiveFormat format = kEmbeddedPerspective;
  const double centred = coordinate_error_bound(1024, 16, format, 8);
  format.coordinate.is_centred = false;
  EXPECT_GT(coordinate_error_bound(1024, 16, format, 8), 1.5 * centred);
}

TEST(Perspective, ABaseIsTheFirstOfTheSmallestQ) {
  EXPECT_EQ(base_vertex({5, 4, 3}), 2U);
  EXPECT_EQ(base_vertex({4, 4, 5}), 0U);
  EXPECT_EQ(base_vertex({5, 4, 4}), 1U);
}

TEST(Perspective, NarrowedQAndPDecodeAtEveryCoveredSampleOfAnyWRatio) {
  for (const PerspectiveDesign& design : designs()) {
    const double delta = std::ldexp(design.config.tile_size + 1, -design.format.guard_bits - 1) + std::ldexp(1.0, -5);
    OverWRandom random(3);
    std::uint64_t samples = 0;
    for (int n = 0; n < 6000; ++n) {
      const std::int64_t ratio = std::int64_t{1} << random.between(0, 20);
      const OverWTriangle t = random.triangle(design, ratio, random.between(0, 1024));
      const OverWRun run(t, design, design.format.coordinate);
      const std::size_t base = base_vertex(run.q_codes());
      test::for_some_pixels(t, run.setup(), design, 12, random, [&](int x, int y, const auto&) {
        const auto weight = test::vertex_weights(run.canonical_vertices(), x, y, design.widths.grid_bits);
        long double q = 0, p = 0, area = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          q += static_cast<long double>(weight[i]) * run.q_codes()[i];
          p += static_cast<long double>(weight[i]) * static_cast<long double>(run.over_w().p[i]);
          area += static_cast<long double>(weight[i]);
        }
        q /= area;
        p /= area;
        const long double unit = std::ldexp(1.0L, -design.format.guard_bits),
                          relative = std::ldexp(1.0L, -design.format.reciprocal_bits);
        const long double q_error = std::abs(static_cast<long double>(run.q(x, y)) * unit - q),
                          p_error = std::abs(static_cast<long double>(run.p(x, y)) * unit - p);
        EXPECT_LE(q_error, delta + relative * (q - run.q_codes()[base]) + 1e-6L);
        EXPECT_LE(p_error, delta + relative * std::abs(p - static_cast<long double>(run.over_w().p[base])) + 1e-6L);
        EXPECT_GT(run.q(x, y), 0U);
        const double reach = std::ldexp(2.0, run.over_w().reach + design.format.coordinate.fraction_bits);
        EXPECT_LE(std::abs(static_cast<double>(run.value(x, y)) -
                           std::ldexp(run.over_w().reference, design.format.coordinate.fraction_bits)),
                  reach);
        ++samples;
      });
    }
    EXPECT_GT(samples, 20000U);
  }
}

TEST(PerspectiveMustFail, OneBitLessDecodesWrongly) {
  // Q modulo 2^(N+l-1): its value in a lane that is too narrow.
  const PerspectiveDesign& design = designs()[1];
  OverWRandom random(4);
  int wrong = 0;
  for (int n = 0; n < 100; ++n) {
    const OverWTriangle t = random.triangle(design, 2, 16);
    const OverWRun run(t, design, design.format.coordinate);
    test::for_some_pixels(t, run.setup(), design, 4, random, [&](int x, int y, const auto&) {
      wrong += wrap_unsigned(run.q(x, y), q_local_bits(design.format) - 2) != run.q(x, y);
    });
  }
  EXPECT_GT(wrong, 0);
}

TEST(Perspective, PIsNeverHeldWithinTheBound) {
  // The margin of x covers the errors of Q and P, if a unit of Q is small beside the smallest: here 2^9 at least.
  const PerspectiveDesign& design = designs()[1];
  OverWRandom random(5);
  std::int64_t farthest = 0;
  for (int n = 0; n < 5000; ++n) {
    const OverWTriangle t = random.triangle(design, 1024, random.between(1, 1024));
    const OverWRun run(t, design, design.format.coordinate);
    test::for_some_pixels(t, run.setup(), design, 4, random, [&](int x, int y, const auto&) {
      const PixelReciprocal q = divide_by_q(run.q(x, y), design.format);
      farthest = std::max(farthest, std::abs(narrow_p(run.p(x, y), q, run.over_w(), design.format.coordinate)));
    });
  }
  EXPECT_LT(farthest, (1 << 17) - 1);
  EXPECT_GT(farthest, 1 << 16);
}

TEST(Perspective, PIsHeldAtTheEndsOfItsBits) {
  const PixelReciprocal one = divide_by_q(1 << 20, kEmbeddedPerspective);
  OverW over_w;
  const OverWFormat& attribute = kEmbeddedPerspective.coordinate;
  EXPECT_EQ(narrow_p(std::int64_t{1} << 30, one, over_w, attribute), (1 << 17) - 1);
  EXPECT_EQ(narrow_p(-(std::int64_t{1} << 30), one, over_w, attribute), -(1 << 17));
  EXPECT_EQ(narrow_p(5, one, over_w, attribute), round_shift(5, 20 + 1 - 17));
}

TEST(Perspective, AShortQIsItsOwnMantissa) {
  const PixelReciprocal short_q = divide_by_q(11, kEmbeddedPerspective);
  EXPECT_EQ(short_q.exponent, 3);
  EXPECT_EQ(short_q.reciprocal, mantissa_reciprocal(11U << 14, 18));
  const PixelReciprocal long_q = divide_by_q((11U << 22) | 255U, kEmbeddedPerspective);
  EXPECT_EQ(long_q.exponent, 25);
  EXPECT_EQ(long_q.reciprocal, short_q.reciprocal) << "cut off";
}

TEST(Perspective, AConstantOnTheGridOfTheResultIsThatConstant) {
  for (const PerspectiveDesign& design : designs()) {
    const OverWFormat& attribute = design.format.coordinate;
    OverWRandom random(6);
    for (int n = 0; n < 3000; ++n) {
      OverWTriangle t = random.triangle(design, std::int64_t{1} << random.between(0, 6), 0);
      t.value.fill(random.between(-16 * 4096, 16 * 4096));
      const OverWRun run(t, design, attribute);
      test::for_some_pixels(t, run.setup(), design, 8, random, [&](int x, int y, const auto&) {
        EXPECT_EQ(run.value(x, y), t.value[0] * (1 << attribute.fraction_bits) / 16) << design.name;
      });
    }
  }
}

TEST(Perspective, WithEqualWAnAttributeIsAffineWithinItsBound) {
  for (const PerspectiveDesign& design : designs()) {
    const double bound = coordinate_error_bound(256, 1, design.format, design.config.tile_size);
    OverWRandom random(7);
    double worst = 0;
    for (int n = 0; n < 5000; ++n) {
      const OverWTriangle t = random.triangle(design, 1, 256);
      const OverWRun run(t, design, design.format.coordinate);
      test::for_some_pixels(t, run.setup(), design, 8, random, [&](int x, int y, const auto& weight) {
        worst = std::max(
            worst, std::abs(test::over_w_error(t, weight, run.value(x, y), design.format.coordinate.fraction_bits)));
      });
    }
    EXPECT_LE(worst, bound) << design.name;
    EXPECT_GT(worst, 0) << "not free of error";
  }
}

TEST(Perspective, QCloseToAPowerOfTwoFromBothSidesKeepsTheBound) {
  const PerspectiveDesign& design = designs()[1];
  const double bound = coordinate_error_bound(256, 2, design.format, design.config.tile_size);
  OverWRandom random(8);
  for (int n = 0; n < 3000; ++n) {
    OverWTriangle t = random.triangle(design, 1, 256);
    for (std::int64_t& w : t.w) w = (1 << 19) + random.between(-2, 2);
    const OverWRun run(t, design, design.format.coordinate);
    test::for_some_pixels(t, run.setup(), design, 8, random, [&](int x, int y, const auto& weight) {
      EXPECT_LE(std::abs(test::over_w_error(t, weight, run.value(x, y), 8)), bound);
    });
  }
}

TEST(Perspective, AllOrdersOfTheVerticesGiveTheSameBits) {
  const PerspectiveDesign& design = designs()[1];
  OverWRandom random(9);
  for (int n = 0; n < 500; ++n) {
    const OverWTriangle t = random.triangle(design, std::int64_t{1} << random.between(0, 10), 64);
    const OverWRun run(t, design, design.format.coordinate);
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      OverWTriangle other;
      for (std::size_t i = 0; i < 3; ++i) {
        other.v[i] = t.v[order[i]];
        other.w[i] = t.w[order[i]];
        other.value[i] = t.value[order[i]];
      }
      const OverWRun same(other, design, design.format.coordinate);
      test::for_some_pixels(t, run.setup(), design, 4, random,
                            [&](int x, int y, const auto&) { EXPECT_EQ(same.value(x, y), run.value(x, y)); });
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Perspective, AValueDoesNotDependOnWhereTheBoxBegins) {
  // The scissor moves the first tile, from which the planes start.
  const PerspectiveDesign& design = designs()[1];
  const std::array v{vertex_at(100, 80), vertex_at(9000, 500), vertex_at(3000, 7000)};
  const QCodes q{1U << 21, 12345, 700000};
  const OverW over_w = quantize_over_w({3, 200, 77}, q, design.format.coordinate);
  const auto values = [&](const Rect& rect) {
    const TriangleSetup setup = setup_triangle({0, 0, v}, design.config, design.widths, rect);
    const PerspectiveFrame frame = perspective_frame(v, base_vertex(q), setup, design.format, design.widths);
    const PixelPlace place = place_of(setup, design.widths, 200, 200);
    return std::pair(q_at(setup_q(q, frame, design.format, design.widths), place, design.format, design.widths),
                     p_at(setup_over_w(over_w, frame, design.format.coordinate, design.widths), place,
                          design.format.coordinate, design.format, design.widths));
  };
  EXPECT_EQ(values({0, 0, 1920, 1080}), values({190, 150, 100, 100}));
}

TEST(Perspective, AColorIsHeldToItsVertices) {
  EXPECT_EQ(color_over_q(9, 10, 20), 10U);
  EXPECT_EQ(color_over_q(-3, 0, 20), 0U);
  EXPECT_EQ(color_over_q(15, 10, 20), 15U);
  EXPECT_EQ(color_over_q(21, 10, 20), 20U);
}

TEST(Perspective, ItsWidthsAreThoseOfTheContract) {
  const auto& [tiny, embedded, full] = designs();
  EXPECT_EQ(q_local_bits(embedded.format), 27);
  EXPECT_EQ(p_local_bits(embedded.format.coordinate, embedded.format), 28);
  EXPECT_EQ(q_local_bits(full.format), 31);
  EXPECT_EQ(p_local_bits(full.format.coordinate, full.format), 32);
  for (const PerspectiveDesign& design : designs()) {
    EXPECT_LE(p_plane_bits(design.format.coordinate, design.widths), 64) << design.name;
    EXPECT_EQ(q_plane_bits(design.format, design.widths), design.format.q_bits + 1 + design.widths.plane_fraction);
  }
}

}  // namespace
}  // namespace halfplane::perspective_test
