// The error of light at vertices against light at fragments, as `compare` has it: LSB by the size of triangles, cycles.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../hardware_scene.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/show/report/hardware.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/per_vertex.hpp"

namespace halfplane::per_vertex_test {
namespace {

using test::with;

Scene lit_scene(const char* name, int width, int height) {
  MeshOptions options;
  options.light = parse_lights(std::vector<std::string>{"phong", "from=1,2,3"});
  Scene scene = make_builtin(name, width, height, {}, 1, options);
  for (State& state : scene.states) {
    state.light_shininess = 64;
    state.light_specular = {255, 255, 255};
  }
  return scene;
}

double worst_rms(const std::vector<PerVertexRow>& rows) {
  double rms = 0;
  for (const PerVertexRow& row : rows) rms = std::max(rms, row.rms);
  return rms;
}

std::uint64_t cycles_of(const Scene& scene, const Config& config) {
  return run_cycles(scene, {config, {}, {}}).run.cycles;
}

TEST(PerVertex, LightAtVerticesIsFartherOffTheLargerTrianglesAre) {
  const Config config = with("embedded", {{"color.format", "rgba8888"}});
  const auto rows = [&](const char* name) { return compare(lit_scene(name, 160, 120), config).per_vertex; };
  const auto coarse = rows("knot:16"), fine = rows("knot:96");
  ASSERT_FALSE(coarse.empty());
  ASSERT_FALSE(fine.empty());
  EXPECT_GT(worst_rms(coarse), 2 * worst_rms(fine));
  EXPECT_TRUE(compare(make_builtin("knot:16", 60, 40, {}, 1), config).per_vertex.empty());
}

TEST(PerVertex, LightAtFragmentsTakesALitPixelAClock) {
  const Config config = preset("embedded");
  const Scene scene = lit_scene("knot:16", 160, 120);
  const PerVertexCycles cycles = per_vertex_cycles(scene, config);
  EXPECT_EQ(cycles.refused, "");
  EXPECT_EQ(cycles.set, (std::vector<std::string>{"texture.unit=nearest", "shade.unit=1"}));
  const Config unit = with("embedded", {{"texture.unit", "nearest"}, {"shade.unit", "1"}});
  EXPECT_EQ(cycles.fragments, cycles_of(scene, unit));
  EXPECT_EQ(cycles.vertices, cycles_of(lit_at_vertices(scene), unit));
  EXPECT_EQ(cycles.without_unit, cycles_of(lit_at_vertices(scene), with("embedded", {{"texture.unit", "nearest"}})));
  // One over the other: a clock for each sample that is lit, against one for a stamp of four.
  EXPECT_GT(cycles.fragments, cycles.vertices * 11 / 10);
  EXPECT_GE(cycles.vertices, cycles.without_unit);
  EXPECT_GT(cycles.without_unit, 0U);
}

TEST(PerVertex, TheUnitsOfTheConfigurationStay) {
  const Scene scene = lit_scene("knot:16", 48, 32);
  const Config own = with("embedded", {{"texture.unit", "bilinear"}, {"texture.lanes", "4"}, {"shade.unit", "1"}});
  const PerVertexCycles cycles = per_vertex_cycles(scene, own);
  EXPECT_TRUE(cycles.set.empty());
  EXPECT_EQ(cycles.fragments, cycles_of(scene, own));
  const Config texture = with("embedded", {{"texture.unit", "trilinear"}});
  EXPECT_EQ(per_vertex_cycles(scene, texture).set, std::vector<std::string>{"shade.unit=1"});
}

TEST(PerVertex, ATextureUnitIsSetThatTakesTheScene) {
  Scene scene = lit_scene("knot:16", 48, 32);
  scene.textures.push_back(
      make_texture("chequer", pattern_image(TexturePattern::chequer, 8, 8), TextureFormat::rgba8888, Mips::none));
  for (State& state : scene.states) {
    state.texture = 0;
    state.texture_min = TextureMin::linear;
    state.texture_mag = TextureMag::linear;
  }
  const PerVertexCycles cycles = per_vertex_cycles(scene, preset("embedded"));
  EXPECT_EQ(cycles.refused, "");
  EXPECT_EQ(cycles.set, (std::vector<std::string>{"texture.unit=bilinear", "shade.unit=1"}));
}

TEST(PerVertex, HardwareThatCannotHaveTheUnitIsSaidSo) {
  const Scene scene = lit_scene("knot:16", 48, 32);
  for (const auto& [config, word] :
       {std::pair{with("embedded", {{"setup.kind", "serial"}}), "setup.kind=pipelined"},
        {with("embedded", {{"texture.unit", "nearest"}, {"perspective.colors", "1"}}), "perspective.colors=0"}}) {
    const PerVertexCycles cycles = per_vertex_cycles(scene, config);
    EXPECT_NE(cycles.refused.find(word), std::string::npos) << cycles.refused;
    EXPECT_TRUE(cycles.set.empty());
    EXPECT_EQ(cycles.fragments, 0U);
  }
}

}  // namespace
}  // namespace halfplane::per_vertex_test
