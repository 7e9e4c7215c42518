// The theory of depth quantization, against an independent exact reference and against published results.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "halfplane_paths.hpp"
#include "model/config.hpp"
#include "sim/study/depth/theory.hpp"

namespace halfplane::depth_theory_test {
namespace {

DepthMapping mapping_named(std::string_view name) {
  const auto names = depth_mapping_names();
  return static_cast<DepthMapping>(std::find(names.begin(), names.end(), name) - names.begin());
}

ExactDepth depth(const std::string& mapping, const std::string& format, const std::string& near,
                 const std::string& far) {
  return {mapping_named(mapping), parse_depth_format(format), parse_decimal(near, "near"), parse_decimal(far, "far")};
}

Rational number(const std::string& text) { return parse_decimal(text, "z"); }

/// |a - b| as a part of b; 0 for equal infinities.
double relative_error(double a, double b) { return a == b ? 0 : std::abs(a - b) / std::abs(b); }

TEST(DepthTheory, AgreesWithTheIndependentReference) {
  std::ifstream file(HALFPLANE_TEST_DATA "/depth_reference.csv");  // by tools/depth_reference.py
  std::string line;
  std::getline(file, line);
  std::map<std::string, double> worst;
  int rows = 0;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::array<std::string, 9> cell;
    for (std::string& text : cell) std::getline(cells, text, ',');
    const DepthFigures got = depth(cell[0], cell[1], cell[2], cell[3]).at(number(cell[4]));
    EXPECT_EQ(std::to_string(got.code), cell[5]) << line;
    const std::array values{got.bin_width, got.max_recon_err, got.first_order};
    for (std::size_t i = 0; i < 3; ++i) {
      const double error = relative_error(values[i], std::stod(cell[6 + i]));
      EXPECT_LE(error, 1e-12) << line << " figure " << i << ": " << values[i];
    }
    ++rows;
  }
  EXPECT_GE(rows, 1300);
}

TEST(DepthTheory, SixteenBitsAtAFarNearRatioOfAHundredThousandEndNearTheFirstThird) {
  // n = 0.01, f = 1000: the last code but one is z = 395.9, everything farther shares the last code.
  const ExactDepth theory = depth("std", "u16", "0.01", "1000");
  EXPECT_NEAR(theory.reconstructed(65534), 395.9, 0.05);
  EXPECT_DOUBLE_EQ(theory.reconstructed(65535), 1000);
}

TEST(DepthTheory, NineTenthsOfTheCodesServeTheFirstTenthOfTheDepth) {
  const ExactDepth theory = depth("std", "u16", "1", "100");
  EXPECT_NEAR(theory.code(number("10")) / 65535.0, 0.909, 0.0005);
}

/// Neighbours that share a code among 10,001 depths from near to far, spaced evenly or evenly in their logarithm.
int indistinguishable(const ExactDepth& theory, bool is_logarithmic) {
  const double near = theory.near().get_d(), far = theory.far().get_d();
  int same = 0;
  std::optional<std::uint32_t> last;
  for (int i = 0; i <= 10000; ++i) {
    const double part = i / 10000.0;
    const double z = is_logarithmic ? near * std::pow(far / near, part) : near + (far - near) * part;
    const std::uint32_t code = theory.code(std::clamp(Rational(z), theory.near(), theory.far()));
    same += last && *last == code ? 1 : 0;
    last = code;
  }
  return same;
}

TEST(DepthTheory, ReversedFloatTellsTenThousandDepthsApart) {
  for (const bool is_logarithmic : {false, true}) {
    EXPECT_EQ(indistinguishable(depth("rev", "f32", "0.1", "10000"), is_logarithmic), 0);
    EXPECT_EQ(indistinguishable(depth("revinf", "f32", "0.1", "10000"), is_logarithmic), 0);
    EXPECT_GT(indistinguishable(depth("std", "u24", "0.1", "10000"), is_logarithmic), 500);
    EXPECT_GT(indistinguishable(depth("std", "f32", "0.1", "10000"), is_logarithmic), 500);
  }
}

/// The mean reconstruction error over evenly spaced eye depths.
double mean_error(const ExactDepth& theory) {
  double sum = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    const Rational z = theory.near() + (theory.far() - theory.near()) * (2 * i + 1) / (2 * kSamples);
    sum += std::abs(theory.reconstructed(theory.code(z)) - z.get_d());
  }
  return sum / kSamples;
}

TEST(DepthTheory, ComplementaryFloatOfSixteenBitsHasAboutTwiceTheErrorOfAWBuffer) {
  for (const char* far : {"100", "300", "1000"}) {
    const double ratio = mean_error(depth("rev", "uf4.12", "1", far)) / mean_error(depth("w", "u16", "1", far));
    EXPECT_GT(ratio, 1.7) << far;
    EXPECT_LT(ratio, 2.3) << far;
  }
}

TEST(DepthTheory, TheTextbooksFirstOrderStepIsRightUntilTheStepIsAPartOfTheDepth) {
  // Delta z = (2nf / ((f-n) z_w^2)) Delta z_w with z_w the depth in [-1, 1] seen from infinity: z^2 (f-n) / (nf) / B.
  const ExactDepth theory = depth("std", "u16", "1", "1000");
  for (const char* z : {"2", "10", "100"}) {
    const DepthFigures figures = theory.at(number(z));
    const double zd = number(z).get_d();
    EXPECT_NEAR(figures.first_order, zd * zd * 999 / 1000 / 65535, 1e-12 * zd);
    EXPECT_NEAR(figures.bin_width / figures.first_order, 1, 0.01) << z;
  }
  EXPECT_NEAR(theory.at(number("900")).bin_width, 12.447, 0.0005);
  EXPECT_NEAR(theory.at(number("900")).first_order, 12.347, 0.0005);
  // The bin that ends at far is truncated to a half, which no derivative shows.
  EXPECT_LT(theory.at(number("999.9")).bin_width, 0.6 * theory.at(number("999.9")).first_order);
}

TEST(DepthTheory, BinsAreTheSetsOfDepthsThatShareACode) {
  std::mt19937 random(7);
  for (const std::string mapping : {"std", "rev", "stdinf", "revinf", "w", "log"})
    for (const std::string format : {"u8", "bins7", "uf3.5", "f16"}) {
      const ExactDepth theory = depth(mapping, format, "0.5", "300");
      for (int i = 0; i < 40; ++i) {
        const Rational z(std::uniform_real_distribution<double>(0.5, 300)(random));
        const auto bin = theory.bin(theory.code(z));
        ASSERT_TRUE(bin);
        EXPECT_LE(bin->nearest, z.get_d() * (1 + 1e-15));
        EXPECT_GE(bin->farthest, z.get_d() * (1 - 1e-15));
        EXPECT_NEAR(bin->farthest - bin->nearest, bin->width, 1e-13 * bin->farthest);
        const double inside = bin->nearest + 0.999 * bin->width;
        EXPECT_EQ(theory.code(Rational(inside)), theory.code(z)) << mapping << ' ' << format << ' ' << z.get_d();
      }
    }
}

TEST(DepthTheory, FindsWhereBinsOutgrowALength) {
  for (const std::string mapping : {"std", "rev", "stdinf", "revinf", "w", "log"})
    for (const std::string format : {"u8", "bins8", "uf3.5", "uf4.4"}) {
      const ExactDepth theory = depth(mapping, format, "1", "50");
      for (const double length : {1e-3, 0.03, 0.3, 1.0, 5.0, 100.0}) {
        std::optional<double> expected;  // by looking at every bin
        double longest = 0;
        for (std::uint32_t code = 0; code <= top_code(theory.format()); ++code) {
          const auto bin = theory.bin(code);
          if (!bin) continue;
          longest = std::max(longest, bin->width);
          if (bin->width > length) expected = expected ? std::min(*expected, bin->nearest) : bin->nearest;
        }
        const auto found = theory.first_exceeding(length, theory.near(), theory.far());
        ASSERT_EQ(found.has_value(), expected.has_value()) << mapping << ' ' << format << ' ' << length;
        if (found) {
          EXPECT_DOUBLE_EQ(*found, *expected) << mapping << ' ' << format << ' ' << length;
        }
        EXPECT_DOUBLE_EQ(theory.longest_bin(theory.near(), theory.far()), longest) << mapping << ' ' << format;
      }
    }
}

TEST(DepthTheory, CodesByDecadeAreAllCodesInUse) {
  for (const std::string mapping : {"std", "rev", "stdinf", "revinf", "w", "log"})
    for (const std::string format : {"u16", "f32", "uf4.12"})
      for (const auto& [near, far] : {std::pair{"1", "1000.1"}, {"0.1", "10000"}, {"0.3", "7"}}) {
        const ExactDepth theory = depth(mapping, format, near, far);
        std::uint64_t codes = 0;
        double share = 0;
        for (const CodeShare& part : codes_by_decade(theory)) {
          codes += part.codes;
          share += part.share;
        }
        EXPECT_EQ(codes, codes_in_use(theory)) << mapping << ' ' << format << ' ' << far;
        EXPECT_NEAR(share, 1, 1e-12);
      }
}

// A float's codes are denser there than anything else is.
TEST(DepthTheory, DepthsAHairBehindNearAreDoneAtOnce) {
  for (const std::string mapping : {"std", "w", "log"}) {
    const ExactDepth theory = depth(mapping, "f32", "1", "1000");
    const std::uint32_t farther = theory.code(number("1.00000000000000000001"));
    EXPECT_GT(farther, 0U) << mapping;
    EXPECT_LT(farther, theory.code(number("1.0000000000000000001"))) << mapping;
  }
}

TEST(DepthTheory, TheLeastNearPlaneAndTheFewestBitsAreEnoughAndNoMoreThanThat) {
  const Rational low = 100, high = 500, far = 1000;
  for (const DepthMapping mapping :
       {DepthMapping::std, DepthMapping::rev, DepthMapping::stdinf, DepthMapping::revinf}) {
    const DepthFormat format = parse_depth_format("u16");
    const auto near = best_near(mapping, format, far, low, high, 0.1);
    ASSERT_TRUE(near);
    EXPECT_LE(ExactDepth(mapping, format, Rational(*near * 1.00001), far).longest_bin(low, high), 0.1);
    EXPECT_GT(ExactDepth(mapping, format, Rational(*near * 0.999), far).longest_bin(low, high), 0.1);
    const auto bits = fewest_bits(mapping, 1, far, low, high, 0.1);
    ASSERT_TRUE(bits);
    EXPECT_LE(ExactDepth(mapping, {DepthFormat::Kind::unorm, *bits, 0, 0}, 1, far).longest_bin(low, high), 0.1);
    EXPECT_GT(ExactDepth(mapping, {DepthFormat::Kind::unorm, *bits - 1, 0, 0}, 1, far).longest_bin(low, high), 0.1);
  }
  EXPECT_FALSE(best_near(DepthMapping::std, parse_depth_format("u8"), far, low, high, 1e-6));
  EXPECT_FALSE(best_near(DepthMapping::rev, parse_depth_format("uf4.6"), far, low, high, 100));
}

TEST(DepthTheory, ReadsDecimalsExactly) {
  EXPECT_TRUE(number("0.1") == Rational(1, 10));
  EXPECT_TRUE(number("-12.50e1") == Rational(-125));
  EXPECT_TRUE(number("1e-3") == Rational(1, 1000));
  for (const char* bad : {"", ".", "1e", "1.2.3", "x", "0x10", "1e999", "nan", "inf", "1 "})
    EXPECT_THROW((void)number(bad), InputError) << bad;
}

}  // namespace
}  // namespace halfplane::depth_theory_test
