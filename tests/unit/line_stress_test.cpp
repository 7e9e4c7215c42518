// The long and the many: item 19 of the stress list at full length, and lines in random configurations.
#include "../line_builder.hpp"
#include "../tier.hpp"

namespace halfplane::line_stress_test {
namespace {

using namespace test;
using test::Random;  // beside sim's, which another file of the unity build may include

/// (u, v) in one of the eight octants.
SnappedVertex in_octant(int u, int v, int octant) {
  if ((octant & 2) != 0) u = -u;
  if ((octant & 4) != 0) v = -v;
  return (octant & 1) != 0 ? snapped_vertex(v, u) : snapped_vertex(u, v);
}

/// The whole line against the oracle, clipped pieces of it against the whole, depth and colour against their bounds.
void check_line(const exact::Line& line, const LineSpace& space, Random& random, LineErrors& worst) {
  const auto pixels = pixels_of(line, space);
  ASSERT_EQ(positions(pixels), oracle_positions_nearby(line)) << label(space.config) << ' ' << text(line);
  add_errors(worst, line, pixels, space);
  for (int n = 0; n < 2; ++n) {
    const int band = space.config.guard_band;
    int side[4];
    for (int& v : side) v = random.index(2 * band) - band;
    const PixelBounds box{std::min(side[0], side[1]), std::min(side[2], side[3]), std::max(side[0], side[1]),
                          std::max(side[2], side[3])};
    std::vector<LinePixel> expected;
    for (const LinePixel& p : pixels)
      if (p.x >= box.left && p.x <= box.right && p.y >= box.top && p.y <= box.bottom) expected.push_back(p);
    if (!expected.empty()) expected.back().is_last = true;
    ASSERT_EQ(pixels_of(line, space, box), expected) << label(space.config) << ' ' << text(line);
  }
}

/// True for every line in --all, for one of `part` every day; no length of a loop is a multiple of `part`, so that each of its
/// values has its turn.
class Turns {
 public:
  explicit Turns(int part) : part_(test::cases(part, 1)) {}
  bool next() { return number_++ % part_ == 0; }

 private:
  int part_, number_ = 0;
};

TEST(StressLine, LinesOf16384PixelsEqualTheOracleInAllOctants) {
  Random random(51);
  Turns turns(9);
  for (const int bits : {0, 4, 8, 12}) {
    Config config = preset("full");
    config.subpixel_bits = bits;
    config.guard_band = 16384;
    const LineSpace space(config);
    const int s = space.widths.grid_bits, half = 1 << (s - 1);
    LineErrors worst;
    for (const auto& [du, dv] : {std::pair{16383, 1}, {16384, 8191}, {16383, 0}, {16383, 16383}, {16384, 8192}})
      for (int octant = 0; octant < 8; ++octant)
        for (const int shift : {0, 1, half})  // subpixels off the centre, which only diamond exit sees
          for (const auto& [rule, drops_last] : all_rules()) {
            if ((rule != LineRule::diamond && shift != 0) || !turns.next()) continue;
            exact::Line line{in_octant((-8192 << s) + half + shift, (-8192 << s) + half, octant),
                             in_octant(((du - 8192) << s) + half + shift, ((dv - 8192) << s) + half, octant), rule,
                             drops_last, s};
            line.start.code = {3, 255, 0, 7, 128};
            line.end.code = {16777215, 0, 255, 8, 128};
            ASSERT_NO_FATAL_FAILURE(check_line(line, space, random, worst));
            if (rule != LineRule::diamond) {
              EXPECT_EQ(pixels_of(line, space).size(), static_cast<std::size_t>(du + (drops_last ? 0 : 1)));
            }
          }
    EXPECT_LE(worst.depth, line_depth_error_bound(config)) << label(config);
    EXPECT_LE(worst.color, 0.75) << label(config);
    RecordProperty("depth_lsb_s" + std::to_string(bits), std::to_string(worst.depth));
  }
}

TEST(StressLine, LinesOverTheWholeGuardBandEqualTheOracle) {
  Random random(52);
  Turns turns(7);
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    const int lo = static_cast<int>(space.widths.coordinate.range.lo),
              hi = static_cast<int>(space.widths.coordinate.range.hi);
    LineErrors worst;
    for (const int x0 : {lo, lo + 1, 0, hi - 1, hi})
      for (const int y0 : {lo, 0, hi})
        for (const int x1 : {lo, -1, hi})
          for (const int y1 : {lo, lo + 1, 1, hi - 1, hi})
            for (const auto& [rule, drops_last] : all_rules()) {
              if (!turns.next()) continue;
              exact::Line line{snapped_vertex(x0, y0), snapped_vertex(x1, y1), rule, drops_last,
                               space.widths.grid_bits};
              line.end.depth() = static_cast<std::uint32_t>(space.widths.depth().code.range.hi);
              ASSERT_NO_FATAL_FAILURE(check_line(line, space, random, worst));
            }
    EXPECT_LE(worst.depth, line_depth_error_bound(space.config)) << name;
  }
}

TEST(StressLine, EverySubpixelLineOfThreePixelsEqualsTheOracleAtTwoAndThreeBits) {
  for (const int bits : {2, 3}) {
    Config config = preset("tiny");
    config.subpixel_bits = bits;
    const LineSpace space(config);
    const int pixel = 1 << bits, reach = bits == 2 ? 4 : 2;
    for (int start = 0; start < pixel * pixel; ++start)
      for (int x = -reach * pixel; x < (reach + 1) * pixel; ++x)
        for (int y = -reach * pixel; y < (reach + 1) * pixel; ++y)
          for (const auto& [rule, drops_last] : all_rules()) {
            if (rule != LineRule::diamond && start != 0) continue;  // only the pixels of their ends matter
            const exact::Line line{snapped_vertex(start % pixel, start / pixel), snapped_vertex(x, y), rule, drops_last,
                                   bits};
            ASSERT_EQ(positions(pixels_of(line, space)), oracle_positions(line)) << text(line);
          }
  }
}

TEST(StressLine, RandomLinesInRandomConfigurationsEqualTheOracle) {
  Random random(53);
  LineErrors worst_above_bound{-1, -1};
  for (int n = 0; n < test::cases(100, 400); ++n) {
    Config config = preset("small");
    config.subpixel_bits = random.index(13);
    config.guard_band = 1 << (9 + random.index(n % 50 == 0 ? 8 : 3));
    config.depth_bits = 8 + random.index(25);
    config.reciprocal_extra_bits = 2 + random.index(11);
    try {
      validate(config);
    } catch (const InputError&) {
      continue;
    }
    const LineSpace space(config);
    LineErrors worst;
    for (int i = 0; i < 40; ++i)
      for (const auto& [rule, drops_last] : all_rules()) {
        const double reach = i % 20 == 0 ? 1 : i % 2 == 0 ? 0.1 : 0.004;
        const SnappedVertex start = random_vertex(random, space, reach), end = random_vertex(random, space, reach);
        ASSERT_NO_FATAL_FAILURE(
            check_line({start, end, rule, drops_last, space.widths.grid_bits}, space, random, worst));
      }
    worst_above_bound.depth = std::max(worst_above_bound.depth, worst.depth - line_depth_error_bound(config));
    EXPECT_LE(worst.depth, line_depth_error_bound(config)) << label(config);
    EXPECT_LE(worst.color, 1.0) << label(config);
  }
  EXPECT_LE(worst_above_bound.depth, 0);
}

}  // namespace
}  // namespace halfplane::line_stress_test
