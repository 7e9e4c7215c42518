// The exact area reference, and supersampling by accumulation.
#include <gtest/gtest.h>

#include <cmath>

#include "model/engines/functional.hpp"
#include "model/golden/exact.hpp"
#include "model/golden/golden.hpp"
#include "model/stages/cull.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/scene_builder.hpp"
#include "sim/study/antialiasing/study.hpp"

namespace halfplane::antialiasing::antialiasing_test {
namespace {

constexpr int kGrid = 4, kSide = 12;

Triangle random_triangle(Random& random) {
  Triangle t;
  for (SnappedVertex& v : t.v) {
    v.x = static_cast<std::int32_t>(random.next() % (kSide << kGrid));
    v.y = static_cast<std::int32_t>(random.next() % (kSide << kGrid));
  }
  return t;
}

TEST(ExactArea, TheAreasOfAllPixelsSumToTheTrianglesExactly) {
  Random random(1);
  for (int n = 0; n < 60; ++n) {
    const Triangle t = random_triangle(random);
    mpq_class sum = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const mpq_class area = covered_area(t, x, y, kGrid);
        EXPECT_TRUE(area >= 0) << area.get_str();
        EXPECT_TRUE(area <= 1) << area.get_str();
        sum += area;
      }
    mpq_class whole(std::abs(signed_area(t.v[0], t.v[1], t.v[2])), 2L << (2 * kGrid));
    whole.canonicalize();
    EXPECT_TRUE(sum == whole) << sum.get_str() << " of " << whole.get_str();
  }
}

TEST(ExactArea, IsWhatEverMoreSamplesOfThePixelApproach) {
  Random random(2);
  constexpr int kFine = 7;  // 2^7 samples along a pixel's side, off the grid of the vertices
  for (int n = 0; n < 10; ++n) {
    const Triangle t = random_triangle(random);
    Triangle fine = t;
    for (SnappedVertex& v : fine.v) {  // a sample is the centre of a pixel of a scene 2^7 times as large
      v.x <<= kFine;
      v.y <<= kFine;
    }
    const exact::TriangleOracle oracle(fine, kGrid);
    const int x = static_cast<int>(random.next() % kSide), y = static_cast<int>(random.next() % kSide);
    int covered = 0;
    for (int j = 0; j < 1 << kFine; ++j)
      for (int i = 0; i < 1 << kFine; ++i) covered += oracle.covers((x << kFine) + i, (y << kFine) + j) ? 1 : 0;
    EXPECT_NEAR(covered_area(t, x, y, kGrid).get_d(), std::ldexp(covered, -2 * kFine), 4.0 / (1 << kFine));
  }
}

TEST(ExactArea, OfAllPixelsAtOnceIsTheSame) {
  Random random(3);
  std::vector<Triangle> triangles;
  for (int n = 0; n < 5; ++n) triangles.push_back(random_triangle(random));
  const auto areas = covered_areas(triangles, kSide, kSide, kGrid);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      mpq_class sum = 0;
      for (const Triangle& t : triangles) sum += covered_area(t, x, y, kGrid);
      EXPECT_EQ(areas[static_cast<std::size_t>(y * kSide + x)], sum.get_d());
    }
}

TEST(Supersample, GridsAreReadAndWhatIsNoneIsRefused) {
  EXPECT_EQ(parse_supersample("4x4").side, 4);
  EXPECT_TRUE(parse_supersample("2x2:rotated").is_rotated);
  for (const char* bad : {"", "1x1", "9x9", "2x3", "4", "4x4:", "4x4:turned", "x", "4X4"})
    EXPECT_THROW((void)parse_supersample(bad), InputError) << bad;
  for (const char* text : {"2x2:rotated", "3x3:rotated", "4x4:rotated"}) {
    const SupersampleGrid grid = parse_supersample(text);
    const auto places = places_of(grid);
    const double n = static_cast<double>(grid.side * grid.side);
    std::vector<bool> columns(places.size()), rows(places.size());
    for (const Place& place : places) {  // each in a column and a row of its own
      columns[static_cast<std::size_t>(place.x * n)] = true;
      rows[static_cast<std::size_t>(place.y * n)] = true;
    }
    EXPECT_EQ(std::count(columns.begin(), columns.end(), true) + std::count(rows.begin(), rows.end(), true),
              static_cast<std::ptrdiff_t>(2 * places.size()));
  }
}

/// With flat colours, four pictures moved by part of a pixel equal the four samples of a pixel.
TEST(Supersample, OfFlatTrianglesIsThePictureOfAsManySamplesAtTheSamePlaces) {
  Config config = preset("embedded");
  config.color_format = ColorFormat::rgba8888;
  for (const char* name : {"city", "teapot"}) {
    Scene scene = make_builtin(name, 96, 72, {}, 1);
    for (State& state : scene.states) state.shade = Shade::flat;
    for (const char* text : {"2x2", "2x2:rotated"}) {
      const SupersampleGrid grid = parse_supersample(text);
      Config many = config;
      many.msaa_samples = 4;
      std::string pattern;
      for (const Place& place : places_of(grid))
        pattern += (pattern.empty() ? "" : ";") + std::to_string(place.x) + "," + std::to_string(place.y);
      many.msaa_pattern = parse_sample_pattern(pattern);
      const Rendering samples = render_functional(scene, many);
      const Rendering pictures =
          supersampled(scene, config, grid, [&](const Scene& moved) { return render_functional(moved, config); });
      std::size_t different = 0;
      for (std::size_t p = 0; p < samples.frame.color.size(); ++p)
        different += samples.frame.color[p] != pictures.frame.color[p] ? 1 : 0;
      // A vertex between two places of the grid snaps apart from itself where binary64 has rounded its sum.
      EXPECT_LE(different, samples.frame.color.size() / 200) << name << ' ' << text;
      EXPECT_NE(render_functional(scene, config).frame.color, pictures.frame.color);
    }
  }
}

TEST(Supersample, WindowSpaceOfEitherOriginAndCentreMovesAsClipSpaceDoes) {
  const Config config = preset("embedded");
  const SupersampleGrid grid = parse_supersample("2x2:rotated");
  const auto picture = [&](Origin origin, PixelCenter centre) {
    State state = SceneBuilder::window_state();
    state.origin = origin;
    state.pixel_center = centre;
    const double shift = centre == PixelCenter::integer ? -0.5 : 0;
    const auto vertex = [&](double x, double y) {
      return at(x + shift, (origin == Origin::bottom_left ? 24 - y : y) + shift);
    };
    SceneBuilder builder(32, 24, state);
    builder.triangle(vertex(2.25, 3.5), vertex(29, 7), vertex(11.75, 22));
    return supersampled(builder.scene, config, grid,
                        [&](const Scene& moved) { return render_functional(moved, config); })
        .frame.color;
  };
  const auto first = picture(Origin::top_left, PixelCenter::half);
  EXPECT_EQ(picture(Origin::bottom_left, PixelCenter::half), first);
  EXPECT_EQ(picture(Origin::top_left, PixelCenter::integer), first);
  EXPECT_EQ(picture(Origin::bottom_left, PixelCenter::integer), first);
}

TEST(AreaStudy, MoreSamplesAreNearerToTheArea) {
  Config config = preset("embedded");
  config.color_format = ColorFormat::rgba8888;
  const AreaStudy study = measure_areas(blades(160, 120, 1), config, 1, [](double) {});
  EXPECT_GT(study.edge_pixels, 1000U);
  const auto rms = [&study](std::string_view kind) {
    const auto row = std::ranges::find(study.rows, kind, &AreaRow::kind);
    return row == study.rows.end() ? -1 : row->rms;
  };
  EXPECT_GT(rms("1 sample"), 1.4 * rms("msaa 2"));
  EXPECT_GT(rms("msaa 2"), 1.2 * rms("msaa 4"));
  EXPECT_GT(rms("msaa 4"), 1.2 * rms("msaa 8"));
  // Over edges of all angles four samples are as good as four pictures, and it is no matter much where they lie.
  EXPECT_NEAR(rms("msaa 4"), rms("supersample 2x2:rotated"), 0.02);
  EXPECT_NEAR(rms("msaa 4"), rms("supersample 2x2"), 0.03);
  EXPECT_GT(rms("supersample 2x2"), 1.5 * rms("supersample 4x4"));
  EXPECT_GT(rms("supersample 4x4:rotated"), 0);
  EXPECT_TRUE(std::ranges::any_of(study.rows, &AreaRow::is_front));
}

}  // namespace
}  // namespace halfplane::antialiasing::antialiasing_test
