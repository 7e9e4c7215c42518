// Lines and points: every pixel against the exact oracle, the books' own loops, and properties of each rule.
#include <map>

#include "../line_builder.hpp"
#include "model/host/point_raster.hpp"
#include "model/packets/packet_words.hpp"
#include "tests/packet_values.hpp"

namespace halfplane::line_raster_test {
namespace {

using namespace test;
using test::Random;  // beside sim's, which another file of the unity build may include

/// The midpoint loop of the books for 0 <= slope <= 1, drawn from left to right, literally: f(x + 1, y + 1/2).
Positions midpoint_loop(int x0, int y0, int x1, int y1) {
  const auto doubled_f = [&](int x2, int y2) {  // f(x, y) = (y0 - y1) x + (x1 - x0) y + x0 y1 - x1 y0 at x2/2, y2/2
    return (y0 - y1) * x2 + (x1 - x0) * y2 + 2 * (x0 * y1 - x1 * y0);
  };
  Positions list;
  for (int x = x0, y = y0; x <= x1; ++x) {
    list.emplace_back(x, y);
    if (doubled_f(2 * (x + 1), 2 * y + 1) < 0) ++y;
  }
  return list;
}

/// Bresenham's own loop in the same octant: an error term and two increments.
Positions bresenham_loop(int x0, int y0, int x1, int y1) {
  const int dx = x1 - x0, dy = y1 - y0;
  Positions list;
  for (int x = x0, y = y0, e = 2 * dy - dx; x <= x1; ++x) {
    list.emplace_back(x, y);
    if (e > 0) {
      ++y;
      e -= 2 * dx;
    }
    e += 2 * dy;
  }
  return list;
}

TEST(Line, MidpointAndBresenhamEqualTheLoopsOfTheBooksInTheirOctant) {
  const LineSpace space(preset("tiny"));
  for (int dx = 0; dx <= 12; ++dx)
    for (int dy = 0; dy <= dx; ++dy)
      for (const auto rule : {LineRule::midpoint, LineRule::bresenham}) {
        const exact::Line line{centre_of(-3, 2, space), centre_of(dx - 3, dy + 2, space), rule, false, 2};
        const auto expected =
            rule == LineRule::midpoint ? midpoint_loop(-3, 2, dx - 3, dy + 2) : bresenham_loop(-3, 2, dx - 3, dy + 2);
        EXPECT_EQ(positions(pixels_of(line, space)), expected) << text(line);
      }
}

TEST(Line, EveryShortSubpixelLineEqualsTheOracleInEveryRule) {
  // All starts in one pixel, all ends within two pixels of it: diamond corners, borders, centres and ties among them.
  for (const int bits : {0, 1, 2}) {
    Config config = preset("tiny");
    config.subpixel_bits = bits;
    const LineSpace space(config);
    const int pixel = 1 << space.widths.grid_bits;
    for (int start = 0; start < pixel * pixel; ++start)
      for (int x = -2 * pixel; x < 3 * pixel; ++x)
        for (int y = -2 * pixel; y < 3 * pixel; ++y)
          for (const auto& [rule, drops_last] : all_rules()) {
            const exact::Line line{snapped_vertex(start % pixel, start / pixel), snapped_vertex(x, y), rule, drops_last,
                                   space.widths.grid_bits};
            ASSERT_EQ(positions(pixels_of(line, space)), oracle_positions(line)) << text(line);
          }
  }
}

TEST(Line, RandomLinesEqualTheOracleInEveryPresetAndRule) {
  Random random(41);
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    for (const double reach : {1.0, 0.05, 0.005})
      for (int n = 0; n < (reach == 1.0 ? 4 : 200); ++n)
        for (const auto& [rule, drops_last] : all_rules()) {
          const SnappedVertex start = random_vertex(random, space, reach), end = random_vertex(random, space, reach);
          const exact::Line line{start, end, rule, drops_last, space.widths.grid_bits};
          ASSERT_EQ(positions(pixels_of(line, space)), oracle_positions_nearby(line)) << name << ' ' << text(line);
        }
  }
}

TEST(Line, MidpointAndBresenhamCoverTheSamePixelsInAllOctants) {
  const LineSpace space(preset("tiny"));
  for (int dx = -9; dx <= 9; ++dx)
    for (int dy = -9; dy <= 9; ++dy) {
      exact::Line line{centre_of(0, 0, space), centre_of(dx, dy, space), LineRule::midpoint, false, 2};
      const auto midpoint = pixels_of(line, space);
      line.rule = LineRule::bresenham;
      EXPECT_EQ(midpoint, pixels_of(line, space)) << text(line);
      EXPECT_EQ(midpoint.size(), static_cast<std::size_t>(std::max(std::abs(dx), std::abs(dy)) + 1)) << text(line);
    }
}

TEST(Line, ReversedLineCoversTheSamePixelsApartFromTheDroppedEnd) {
  const LineSpace space(preset("tiny"));
  for (int dx = -9; dx <= 9; ++dx)
    for (int dy = -9; dy <= 9; ++dy)
      for (const bool drops_last : {false, true}) {
        exact::Line line{centre_of(0, 0, space), centre_of(dx, dy, space), LineRule::bresenham, drops_last, 2};
        auto there = positions(pixels_of(line, space));
        std::swap(line.start, line.end);
        auto back = positions(pixels_of(line, space));
        if (drops_last && (dx != 0 || dy != 0)) {
          there.emplace_back(dx, dy);
          back.emplace_back(0, 0);
          std::sort(there.begin(), there.end());
          std::sort(back.begin(), back.end());
        }
        EXPECT_EQ(there, back) << text(line);
      }
}

TEST(Line, ReversedDiamondLineDiffersInThePixelsOfItsEndsOnly) {
  Random random(42);
  const LineSpace space(preset("embedded"));
  for (int n = 0; n < 2000; ++n) {
    const SnappedVertex start = random_vertex(random, space, 0.01), end = random_vertex(random, space, 0.01);
    const auto there = positions(pixels_of({start, end, LineRule::diamond, true, 4}, space));
    const auto back = positions(pixels_of({end, start, LineRule::diamond, true, 4}, space));
    Positions odd;
    std::set_symmetric_difference(there.begin(), there.end(), back.begin(), back.end(), std::back_inserter(odd));
    EXPECT_LE(odd.size(), 2u);
    for (const auto& [x, y] : odd) {  // the diamond of an end lies around it
      const auto is_near = [&](const SnappedVertex& v) {
        return std::abs(v.x - (x * 16 + 8)) + std::abs(v.y - (y * 16 + 8)) <= 8;
      };
      EXPECT_TRUE(is_near(start) || is_near(end)) << x << ", " << y;
    }
  }
}

TEST(Line, SlopeOneHalfTieGoesToTheSideOfTheLeftEnd) {
  const LineSpace space(preset("tiny"));
  const auto covered = [&](int x, int y, LineRule rule) {
    return positions(pixels_of({centre_of(0, 0, space), centre_of(x, y, space), rule, false, 2}, space));
  };
  EXPECT_EQ(covered(2, 1, LineRule::midpoint), (Positions{{0, 0}, {1, 0}, {2, 1}}));
  EXPECT_EQ(covered(2, -1, LineRule::midpoint), (Positions{{0, 0}, {1, 0}, {2, -1}}));
  EXPECT_EQ(covered(-2, 1, LineRule::midpoint), (Positions{{-2, 1}, {-1, 1}, {0, 0}}));
  EXPECT_EQ(covered(-2, -1, LineRule::midpoint), (Positions{{-2, -1}, {-1, -1}, {0, 0}}));
  EXPECT_EQ(covered(1, 2, LineRule::midpoint), (Positions{{0, 0}, {0, 1}, {1, 2}}));
  EXPECT_EQ(covered(-1, 2, LineRule::midpoint), (Positions{{-1, 1}, {-1, 2}, {0, 0}}));
  // Diamond exit: moved to the left, the line crosses x = 1 where it was further right: on the side of its right end.
  EXPECT_EQ(covered(2, 1, LineRule::diamond), (Positions{{0, 0}, {1, 1}}));
  EXPECT_EQ(covered(2, -1, LineRule::diamond), (Positions{{0, 0}, {1, -1}}));
  EXPECT_EQ(covered(1, 2, LineRule::diamond), (Positions{{0, 0}, {0, 1}}));
  EXPECT_EQ(covered(-1, 2, LineRule::diamond), (Positions{{-1, 1}, {0, 0}}));
}

TEST(Line, DiamondCornersAndBordersGoWhereThePerturbationPutsThem) {
  // One pixel, half-pixel grid (s = 1): centre (1, 1), corners of its diamond (0, 1), (2, 1), (1, 0), (1, 2).
  Config config = preset("tiny");
  config.subpixel_bits = 1;
  const LineSpace space(config);
  const auto covered = [&](int x0, int y0, int x1, int y1) {
    return positions(pixels_of({snapped_vertex(x0, y0), snapped_vertex(x1, y1), LineRule::diamond, true, 1}, space));
  };
  EXPECT_EQ(covered(2, 1, 4, 1), (Positions{{0, 0}})) << "both right corners move left, into their pixels";
  EXPECT_EQ(covered(0, 1, 2, 1), (Positions{{-1, 0}})) << "a line that ends there does not leave the pixel";
  EXPECT_EQ(covered(1, 2, 1, 4), (Positions{{0, 1}})) << "the lower corner moves left first: out of the pixel";
  EXPECT_EQ(covered(1, 0, 1, 2), (Positions{{0, 0}}));
  EXPECT_EQ(covered(0, 0, 4, 0), (Positions{{0, -1}, {1, -1}})) << "a level line between two rows goes up";
  EXPECT_EQ(covered(0, 0, 0, 4), (Positions{{-1, 0}, {-1, 1}})) << "an upright one between two columns left";
}

TEST(Line, DiamondExitBetweenPixelCentresIsBresenhamWithoutTheLastPixelWhereNothingTies) {
  const LineSpace space(preset("tiny"));
  for (int dx = -9; dx <= 9; ++dx)
    for (int dy = -9; dy <= 9; ++dy) {
      // An x-major line ties where k dy / dx = n + 1/2: when dx has more factors of 2 than dy.
      if (std::abs(dx) >= std::abs(dy) && dy != 0 && (dx & -dx) > (dy & -dy)) continue;
      exact::Line line{centre_of(0, 0, space), centre_of(dx, dy, space), LineRule::bresenham, true, 2};
      const auto bresenham = pixels_of(line, space);
      line.rule = LineRule::diamond;
      EXPECT_EQ(pixels_of(line, space), bresenham) << text(line);
    }
}

TEST(Line, LinesAtFortyFiveDegreesStepOnEveryPixel) {
  const LineSpace space(preset("embedded"));
  for (const int sx : {-1, 1})
    for (const int sy : {-1, 1})
      for (const auto& [rule, drops_last] : all_rules()) {
        const auto pixels = pixels_of(
            {centre_of(5, 7, space), centre_of(5 + 100 * sx, 7 + 100 * sy, space), rule, drops_last, 4}, space);
        ASSERT_EQ(pixels.size(), drops_last ? 100u : 101u);
        for (int i = 0; i < static_cast<int>(pixels.size()); ++i) {
          EXPECT_EQ(pixels[static_cast<std::size_t>(i)].x, 5 + i * sx);
          EXPECT_EQ(pixels[static_cast<std::size_t>(i)].y, 7 + i * sy);
        }
      }
}

TEST(Line, LineWithoutLengthIsOnePixelUnlessTheLastIsDropped) {
  const LineSpace space(preset("embedded"));
  const SnappedVertex start = snapped_vertex(100, -50, 1234, {1, 2, 3, 4}),
                      end = snapped_vertex(100, -50, 60000, {9, 9, 9, 9});
  for (const auto& [rule, drops_last] : all_rules()) {
    const auto pixels = pixels_of({start, end, rule, drops_last, 4}, space);
    if (drops_last) {
      EXPECT_TRUE(pixels.empty());
    } else {
      ASSERT_EQ(pixels.size(), 1u);
      EXPECT_EQ(pixels[0], (LinePixel{0, 6, -4, true, {1234, 1, 2, 3}}));
    }
  }
}

TEST(Line, StraightPolylineCutAnywhereCoversEveryPixelOfTheWholeLineOnce) {
  Random random(43);
  const LineSpace space(preset("embedded"));
  for (int n = 0; n < 1000; ++n) {
    const int dx = random.index(21) - 10, dy = random.index(21) - 10, pieces = 2 + random.index(30);
    const SnappedVertex start = snapped_vertex(random.index(64), random.index(64));
    Positions together;
    for (int i = 0; i < pieces; ++i) {
      const SnappedVertex a = snapped_vertex(start.x + i * dx, start.y + i * dy),
                          b = snapped_vertex(a.x + dx, a.y + dy);
      for (const auto& p : positions(pixels_of({a, b, LineRule::diamond, true, 4}, space))) together.push_back(p);
    }
    std::sort(together.begin(), together.end());
    const exact::Line whole{start, snapped_vertex(start.x + pieces * dx, start.y + pieces * dy), LineRule::diamond,
                            true, 4};
    ASSERT_EQ(together, positions(pixels_of(whole, space))) << text(whole) << " in " << pieces;
  }
}

TEST(Line, BentPolylineInOneOctantCoversEveryColumnOnce) {
  Random random(44);
  const LineSpace space(preset("embedded"));
  for (int octant = 0; octant < 8; ++octant)
    for (int n = 0; n < 200; ++n) {
      std::map<int, int> count;
      int a = random.index(16), b = random.index(16);
      const int first = a;
      for (int piece = 0; piece < 20; ++piece) {
        const int da = random.index(40), db = random.index(da + 1);
        const auto turned = [&](int u, int v) {
          if ((octant & 2) != 0) u = -u;
          if ((octant & 4) != 0) v = -v;
          return (octant & 1) != 0 ? snapped_vertex(v, u) : snapped_vertex(u, v);
        };
        const bool is_swapped = (octant & 1) != 0 && da == db;  // 45 degrees count as x-major: leave them out
        const int run = is_swapped ? da + 1 : da;
        for (const auto& pixel :
             pixels_of({turned(a, b), turned(a + run, b + db), LineRule::diamond, true, 4}, space)) {
          const int i = (octant & 1) != 0 ? pixel.y : pixel.x;
          ++count[(octant & 2) != 0 ? ~i : i];
        }
        a += run;
        b += db;
      }
      for (int i = (first >> 4) + 1; i < ((a - 1) >> 4); ++i)  // a corner on a border moves into the column before
        EXPECT_EQ(count[i], 1) << "octant " << octant << ", column " << i;
      for (const auto& [i, times] : count) EXPECT_EQ(times, 1) << "octant " << octant << ", column " << i;
    }
}

TEST(Line, ClosedPolygonCoversNoPixelTwice) {
  const LineSpace space(preset("embedded"));
  for (const auto& [rule, drops_last] : all_rules()) {
    if (!drops_last) continue;
    for (int corners = 6; corners <= 40; ++corners) {
      std::vector<SnappedVertex> v;
      for (int i = 0; i < corners; ++i)
        v.push_back(centre_of(static_cast<int>(std::lround(300 * std::cos(i * 6.283185307 / corners))),
                              static_cast<int>(std::lround(200 * std::sin(i * 6.283185307 / corners))), space));
      Positions all;
      for (std::size_t i = 0; i < v.size(); ++i)
        for (const auto& p : positions(pixels_of({v[i], v[(i + 1) % v.size()], rule, true, 4}, space)))
          all.push_back(p);
      std::sort(all.begin(), all.end());
      EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end()) << corners << " corners";
      for (const auto& corner : v)
        EXPECT_TRUE(std::binary_search(all.begin(), all.end(), std::pair{corner.x >> 4, corner.y >> 4}));
    }
  }
}

TEST(Line, ClippedLineKeepsItsPixelsDepthsAndColoursBitForBit) {
  Random random(45);
  std::size_t kept = 0, cut = 0;
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    for (int n = 0; n < 60; ++n) {
      const double reach = n % 3 == 0 ? 1 : 0.02;
      const SnappedVertex start = random_vertex(random, space, reach), end = random_vertex(random, space, reach);
      for (const auto& [rule, drops_last] : all_rules()) {
        const exact::Line line{start, end, rule, drops_last, space.widths.grid_bits};
        const auto whole = pixels_of(line, space);
        for (int box = 0; box < 8; ++box) {
          const auto side = [&] {
            return static_cast<int>(reach * random.between(-space.config.guard_band, space.config.guard_band));
          };
          const auto [left, right] = std::minmax({side(), side()});
          const auto [top, bottom] = std::minmax({side(), side()});
          std::vector<LinePixel> expected;
          for (const LinePixel& p : whole)
            if (p.x >= left && p.x <= right && p.y >= top && p.y <= bottom) expected.push_back(p);
          if (!expected.empty()) expected.back().is_last = 1;
          ASSERT_EQ(pixels_of(line, space, {left, top, right, bottom}), expected) << name << ' ' << text(line);
          kept += expected.size();
          cut += whole.size() - expected.size();
        }
      }
    }
  }
  EXPECT_GT(kept, 10000u);
  EXPECT_GT(cut, 10000u);
}

TEST(Line, EmptyScissorCoversNothing) {
  const LineSpace space(preset("embedded"));
  const exact::Line line{snapped_vertex(0, 0), snapped_vertex(1600, 900), LineRule::diamond, true, 4};
  EXPECT_TRUE(pixels_of(line, space, {5, 0, 4, 100}).empty());
  EXPECT_TRUE(pixels_of(line, space, {0, 5, 100, 4}).empty());
}

TEST(Line, DepthAndColourStayWithinTheDerivedBoundOfTheExactValue) {
  Random random(46);
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    LineErrors worst;
    for (int n = 0; n < 300; ++n) {
      const double reach = n % 10 == 0 ? 1 : n % 2 == 0 ? 0.05 : 0.002;
      const SnappedVertex start = random_vertex(random, space, reach), end = random_vertex(random, space, reach);
      for (const auto& [rule, drops_last] : all_rules()) {
        const exact::Line line{start, end, rule, drops_last, space.widths.grid_bits};
        add_errors(worst, line, pixels_of(line, space), space);
      }
    }
    EXPECT_LE(worst.depth, line_depth_error_bound(space.config)) << name;
    EXPECT_LE(line_depth_error_bound(space.config), 0.75) << name;
    EXPECT_LE(worst.color, 0.75) << name;
    EXPECT_GT(worst.depth, 0.4999) << name << ": lines on which nothing was rounded prove nothing";
    RecordProperty(std::string(name) + "_depth_lsb", std::to_string(worst.depth));
    RecordProperty(std::string(name) + "_color_lsb", std::to_string(worst.color));
  }
}

TEST(Line, BothEndPixelsShowTheirVerticesExactlyBetweenPixelCentres) {
  Random random(47);
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    for (int n = 0; n < 200; ++n) {
      const SnappedVertex start = random_vertex(random, space, 0.1), end = random_vertex(random, space, 0.1);
      const auto pixels = pixels_of({start, end, LineRule::bresenham, false, space.widths.grid_bits}, space);
      ASSERT_FALSE(pixels.empty());
      EXPECT_EQ(pixels.front().code, start.code);
      if (pixels.size() == 1) continue;
      EXPECT_EQ(pixels.back().code, end.code);
    }
  }
}

TEST(Line, ConstantDepthStaysConstant) {
  Random random(48);
  const LineSpace space(preset("full"));
  for (const std::uint32_t z : {0u, 1u, 8388608u, 16777215u}) {
    SnappedVertex start = random_vertex(random, space, 0.5), end = random_vertex(random, space, 0.5);
    start.depth() = end.depth() = z;
    for (const LinePixel& pixel : pixels_of({start, end, LineRule::diamond, true, 8}, space))
      EXPECT_EQ(pixel.code[kDepthPlane], z);
  }
}

/// Does every value that the hardware would hold fit the width that is derived for it?
void expect_fits(const Width& width, int128 value) {
  EXPECT_TRUE(value >= width.range.lo && value <= width.range.hi) << width.name << ' ' << static_cast<double>(value);
}

TEST(Line, EveryRegisterFitsItsWidthAndEveryPacketItsBits) {
  Random random(49);
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    const Widths& w = space.widths;
    for (int n = 0; n < 200; ++n) {
      const auto rule = all_rules()[static_cast<std::size_t>(n % 5)];
      const SnappedVertex start = random_vertex(random, space, n % 2 == 0 ? 1 : 0.01);
      const SnappedVertex end = random_vertex(random, space, n % 2 == 0 ? 1 : 0.01);
      const auto line = setup_line(start, end, rule.first, rule.second, space.target(), w);
      if (!line) continue;
      test::expect_survives_packing(*line, w);
      expect_fits(w.line_stay, line->step_stay);
      expect_fits(w.line_move, line->step_move);
      expect_fits(w.depth().line, line->step[kDepthPlane]);
      LineState state = first_state(*line);
      for (;; advance(state, *line, w)) {
        expect_fits(w.pixel_x, state.x);
        expect_fits(w.pixel_y, state.y);
        expect_fits(w.line_count, state.remaining);
        expect_fits(w.line_error, state.error);
        for (std::size_t p = 0; p < static_cast<std::size_t>(w.planes); ++p) {
          expect_fits(w.of_plane(p).line, state.value[p]);
          expect_fits(w.of_plane(p).code, pixel_of(state, *line, w).code[p]);
        }
        if (state.remaining == 0) break;
      }
    }
  }
}

TEST(Line, WidthsNeedExactlyTheBitsOfTheirRanges) {
  for (const auto name : preset_names()) {
    const Widths widths = derive_widths(preset(name));
    for (const Width* width : widths.all()) {
      const int128 half = int128{1} << (width->bits - 1);
      const Interval fits = width->is_signed ? Interval{-half, half - 1} : Interval{0, 2 * half - 1};
      EXPECT_TRUE(width->range.lo >= fits.lo && width->range.hi <= fits.hi) << width->name;
      EXPECT_TRUE(width->range.lo < -half / 2 || width->range.hi >= half / (width->is_signed ? 2 : 1)) << width->name;
    }
  }
}

TEST(Point, CoversThePixelsWhoseCentresLieInItsSquare) {
  const PixelBounds everything{-100, -100, 100, 100};
  for (const int s : {1, 2, 4})
    for (int size = 1 << s; size <= 5 << s; ++size)
      for (int x = -2 << s; x <= 2 << s; ++x) {
        const PixelBounds box = point_bounds(snapped_vertex(x, -x), size, everything, s);
        for (int i = -8; i <= 8; ++i) {  // in halves of a subpixel
          const int centre = (2 * i + 1) << s;
          EXPECT_EQ(i >= box.left && i <= box.right, centre >= 2 * x - size && centre < 2 * x + size) << x << ' ' << i;
          EXPECT_EQ(i >= box.top && i <= box.bottom, centre >= -2 * x - size && centre < -2 * x + size)
              << x << ' ' << i;
        }
      }
}

TEST(Point, WholeSizeCoversAsManyPixelsWhereverItLies) {
  for (int x = -40; x <= 40; ++x)
    for (int size = 1; size <= 64; ++size) {
      const PixelBounds box = point_bounds(snapped_vertex(x, 3 * x), size << 4, {-200, -200, 200, 200}, 4);
      EXPECT_EQ(box.right - box.left + 1, size);
      EXPECT_EQ(box.bottom - box.top + 1, size);
    }
}

TEST(Point, IsCutByTheScissorPixelByPixel) {
  const PixelBounds box = point_bounds(snapped_vertex(8, 8), 5 << 4, {0, 1, 1, 50}, 4);
  EXPECT_EQ(box.left, 0);
  EXPECT_EQ(box.right, 1);
  EXPECT_EQ(box.top, 1);
  EXPECT_EQ(box.bottom, 2);
  EXPECT_TRUE(point_bounds(snapped_vertex(8, 8), 16, {1, 0, 9, 9}, 4).is_empty());
}

TEST(Point, ARoundOneCoversThePixelsOfItsSquareWhoseCentresLieInItsDisc) {
  const PixelBounds everything{-100, -100, 100, 100};
  for (const int s : {1, 2, 4})
    for (int size = 1 << s; size <= 6 << s; ++size)
      for (int x = -1 << s; x <= 1 << s; ++x)
        for (int y = -1 << s; y <= 1 << s; ++y) {
          const SnappedVertex at = snapped_vertex(x, y);
          const PixelBounds box = point_bounds(at, size, everything, s);
          std::map<std::pair<int, int>, int> covered;
          for_each_run(at, size, PointShape::round, box, s, [&](const PixelBounds& run) {
            ASSERT_EQ(run.top, run.bottom);
            for (int i = run.left; i <= run.right; ++i) ++covered[{i, run.top}];
          });
          for (int j = box.top; j <= box.bottom; ++j)
            for (int i = box.left; i <= box.right; ++i) {  // in halves of a subpixel
              const int dx = ((2 * i + 1) << s) - 2 * x, dy = ((2 * j + 1) << s) - 2 * y;
              const auto found = covered.find({i, j});
              ASSERT_EQ(found == covered.end() ? 0 : found->second, dx * dx + dy * dy <= size * size ? 1 : 0)
                  << x << ' ' << y << ' ' << size << ": " << i << ' ' << j;
              if (found != covered.end()) covered.erase(found);
            }
          ASSERT_TRUE(covered.empty()) << "outside its square";
        }
}

}  // namespace
}  // namespace halfplane::line_raster_test
