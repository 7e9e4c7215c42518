// Textured draws in the comparison: parts that sum, bounds that hold, and wrong engines that are caught.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../scene_builder.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/surface_oracle.hpp"

namespace halfplane::compare_textures_test {
namespace {

using test::SceneBuilder;

Vertex corner(double x, double y, double w, double u, double v) {
  Vertex vertex = test::at(x, y, 0.5, {250, 180, 120, 255});
  vertex.w = w;
  vertex.u = u;
  vertex.v = v;
  return vertex;
}

State textured_state() {
  State state = SceneBuilder::window_state();
  state.texture = 0;
  state.texture_min = TextureMin::linear_mipmap_linear;
  state.texture_mag = TextureMag::linear;
  return state;
}

/// A quad with w from 1 to 16, repeated four times, of a texture with levels; `shrink`: divisor of its usual size.
Scene floor_scene(const State& state = textured_state(), int shrink = 1) {
  SceneBuilder builder(48 / shrink, 40 / shrink, state);
  const auto at = [shrink](double x, double y, double w, double u, double v) {
    return corner(x / shrink, y / shrink, w, u, v);
  };
  const Vertex a = at(2.25, 38.5, 1, 0, 4), b = at(46.75, 37, 1.5, 4, 4), c = at(31, 3.5, 16, 4, 0),
               d = at(17, 2.75, 14, 0, 0);
  builder.triangle(a, b, c).triangle(a, c, d);
  builder.scene.textures.push_back(
      make_texture("t", pattern_image(TexturePattern::grid, 64, 64), TextureFormat::rgba8888, Mips::box));
  return builder.scene;
}

/// The specification with modified surface results.
Comparison compare_damaged(const Scene& scene, const Config& config, void (*damage)(SurfaceSample&)) {
  CompareOptions options;
  options.specification = [damage](const Scene& drawn, const Config& by, const RenderOptions& asked) {
    RenderOptions changed = asked;
    changed.fragment_tap = [&asked, damage](const TappedFragment& fragment) {
      TappedFragment copy = fragment;
      if (copy.surface) damage(*copy.surface);
      asked.fragment_tap(copy);
    };
    return render_scalar(drawn, by, changed);
  };
  return compare(scene, config, options);
}

void expect_broken(const Scene& scene, void (*damage)(SurfaceSample&), const char* what) {
  const Config config = preset("embedded");
  ASSERT_TRUE(broken_bounds(compare_damaged(scene, config, [](SurfaceSample&) {}), config).empty());
  const auto broken = broken_bounds(compare_damaged(scene, config, damage), config);
  EXPECT_TRUE(std::ranges::any_of(broken, [what](const std::string& b) { return b.find(what) != std::string::npos; }))
      << what << "; " << testing::PrintToString(broken);
}

TEST(CompareTextures, AFloorBreaksNoBoundInAnyPresetAndStateOfItsTexture) {
  for (const std::string name : {"tiny", "small", "embedded", "full"})
    for (int min = 0; min < 6; ++min)
      for (int wrap = 0; wrap < 5; ++wrap) {
        State state = textured_state();
        state.texture_border = {250, 10, 128, 60};
        state.texture_min = static_cast<TextureMin>(min);
        state.texture_mag = static_cast<TextureMag>(min % 2);
        state.texture_wrap = {static_cast<TextureWrap>(wrap), static_cast<TextureWrap>((wrap + 1) % 5)};
        state.texture_interp = min == 3 ? TextureInterp::affine : TextureInterp::perspective;
        state.color_interp = wrap == 1 ? ColorInterp::perspective : ColorInterp::affine;
        state.texture_lod = {0.3 * wrap - 0.21, 0.13, 4.77};
        const Config config = preset(name);
        const Comparison c = compare(floor_scene(state, name == "tiny" ? 4 : 1), config);
        const auto broken = broken_bounds(c, config);
        EXPECT_TRUE(broken.empty()) << name << ' ' << min << ' ' << wrap << ' ' << testing::PrintToString(broken);
        ASSERT_TRUE(c.texture);
        EXPECT_GT(c.texture->pixels, 50u);
        EXPECT_GT(c.texture->coordinate_of_bound, 0);
        EXPECT_EQ(c.color_over_w.count > 0, wrap == 1);
      }
}

TEST(CompareTextures, PartsSumToTexelLessExactTexel) {
  const Comparison c = compare(floor_scene(), preset("embedded"));
  const TextureErrors& t = *c.texture;
  EXPECT_TRUE(t.part_coordinate.sum + t.part_level.sum + t.part_weights.sum + t.part_rounding.sum == t.total.sum);
  for (const PartStats* part : {&t.part_coordinate, &t.part_level, &t.part_weights, &t.part_rounding})
    EXPECT_GT(part->max, 0);
  EXPECT_TRUE(c.color_parts.snap.sum + c.color_parts.interpolation.sum + c.color_parts.storage.sum ==
              c.color_parts.total.sum);
}

TEST(CompareTextures, EachPartIsOfItsOwnCause) {
  State state = textured_state();  // one level, its nearest texel: neither levels nor weights
  state.texture_min = TextureMin::nearest;
  state.texture_mag = TextureMag::nearest;
  const TextureErrors nearest = *compare(floor_scene(state), preset("embedded")).texture;
  EXPECT_EQ(nearest.part_level.max, 0);
  EXPECT_EQ(nearest.part_weights.max, 0);
  EXPECT_EQ(nearest.part_rounding.max, 0);
  state.texture_min = TextureMin::linear;  // one level and weights
  state.texture_mag = TextureMag::linear;
  const TextureErrors linear = *compare(floor_scene(state), preset("embedded")).texture;
  EXPECT_EQ(linear.part_level.max, 0);
  EXPECT_EQ(linear.part_weights.max, 0);  // level 0 has only 8 coordinate bits
  EXPECT_GT(linear.part_rounding.max, 0.4);
  const TextureErrors rough = *compare(floor_scene(state),
                                       [] {
                                         Config config = preset("embedded");
                                         config.perspective_bits = 12;
                                         return config;
                                       }())
                                   .texture;
  EXPECT_GT(rough.coordinate.rms, 10 * linear.coordinate.rms);
}

TEST(CompareTextures, WhereNothingIsTexturedThereAreNoFigures) {
  SceneBuilder builder(16, 16);
  builder.triangle(test::at(1, 1), test::at(15, 1), test::at(1, 15));
  EXPECT_FALSE(compare(builder.scene, preset("embedded")).texture);
}

TEST(CompareTexturesMustFail, ACoordinateOffByAnEighthOfATexelIsReported) {
  expect_broken(
      floor_scene(), [](SurfaceSample& s) { s.coordinate[1] += 0.125; }, "a texture coordinate is");
}

TEST(CompareTexturesMustFail, ALevelOffByAnEighthIsReported) {
  expect_broken(
      floor_scene(), [](SurfaceSample& s) { s.lod += 1 << (kLodFraction - 3); }, "a level of detail is");
}

TEST(CompareTexturesMustFail, ATexelOffByTwoCodesIsReported) {
  expect_broken(
      floor_scene(), [](SurfaceSample& s) { s.texel[1] = static_cast<std::uint8_t>(s.texel[1] ^ 2); }, "a texel is");
}

TEST(CompareTexturesMustFail, AColourOverWOffByTwoCodesIsReported) {
  State state = textured_state();
  state.color_interp = ColorInterp::perspective;
  expect_broken(
      floor_scene(state), [](SurfaceSample& s) { s.primitive[2] = static_cast<std::uint8_t>(s.primitive[2] + 2); },
      "a colour over w is");
}

TEST(CompareTexturesMustFail, AStoredColourOfAnotherTexelIsReported) {
  CompareOptions options;
  options.engine = [](const Scene& scene, const Config& config, const RenderOptions& asked) {
    Rendering rendering = render_scalar(scene, config, asked);
    rendering.frame.color[rendering.frame.at(24, 30)] ^= 0x0821;
    return rendering;
  };
  const Config config = preset("embedded");
  const auto broken = broken_bounds(compare(floor_scene(), config, options), config);
  ASSERT_FALSE(broken.empty());
  EXPECT_NE(broken[0].find("1 stored values differ"), std::string::npos) << broken[0];
}

TEST(OverWBound, IsThatOfTheFirstOrderWhereQIsLargeAndNeverMoreThanItsBitsHold) {
  const PerspectiveFormat format = kEmbeddedPerspective;
  const double first = coordinate_error_bound(1024, 64, format, 8);
  EXPECT_NEAR(over_w_bound(1024, 64, format, format.coordinate, 8) / first, 1, 1e-4);
  EXPECT_GT(over_w_bound(256, 1e6, format, format.coordinate, 8), coordinate_error_bound(256, 1e6, format, 8));
  EXPECT_LE(over_w_bound(256, 1e9, format, format.coordinate, 8), 5.01 * 129);
}

TEST(CompareTextures, WhereNothingIsPromisedNothingIsBroken) {
  for (const double far : {1e17, 1e300}) {
    SceneBuilder builder(32, 32, textured_state());
    builder.triangle(corner(1, 1, 1, far, 0), corner(30, 2, 1e-6, -far, far), corner(5, 30, 1e6, far, -far));
    builder.scene.textures.push_back(
        make_texture("t", pattern_image(TexturePattern::grid, 33, 17), TextureFormat::rgba8888, Mips::box));
    const Config config = preset("embedded");
    EXPECT_EQ(broken_bounds(compare(builder.scene, config), config), std::vector<std::string>{}) << far;
  }
}

}  // namespace
}  // namespace halfplane::compare_textures_test
