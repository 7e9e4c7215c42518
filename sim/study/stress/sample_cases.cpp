// Several samples per pixel: each against the exact oracle at its own place, and the functional engine against the
// stages.
#include <algorithm>
#include <optional>

#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/stages/fragment_ops.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/compare/fragment_judge.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/check.hpp"
#include "sim/study/stress/grid.hpp"
#include "sim/study/stress/shapes.hpp"
#include "sim/study/stress/triangle_families.hpp"

namespace halfplane::stress {
namespace {

/// The unit's configuration with 2, 4 or 8 samples at Direct3D's places, or on any grid down to 1/256 pixel.
Config with_samples(Unit& unit) {
  Random& random = unit.random;
  Config config = unit.config;
  config.msaa_samples = 2 << random.index(3);
  while (config.stamp_size * config.stamp_size * config.msaa_samples > 64) config.stamp_size /= 2;
  if (random.coin()) return config;
  SamplePattern& pattern = config.msaa_pattern;
  pattern.count = config.msaa_samples;
  const int step = 1 << random.index(kPatternFraction);  // of 2^-8 pixel
  for (std::size_t k = 0; k < static_cast<std::size_t>(pattern.count); ++k) {
    const auto place = [&] { return random.index((1 << kPatternFraction) / step) * step; };
    pattern.place[k].x = place();
    pattern.place[k].y = place();
  }
  return config;
}

/// The hardware with every unit that fits its framebuffer; none: it does not support the scene with several samples.
std::optional<Config> hardware_of(Config config, const Scene& scene) {
  const bool has_blocks = config.cache_kind == CacheKind::blocks;
  config.texture_unit = TextureUnitKind::off;
  config.alpha_units = config.dither_units = has_blocks ? 1 : 0;
  config.blend_lanes = has_blocks ? 4 : 0;
  config.compress_units = has_blocks && scene.width % 2 == 0 ? 1 : 0;  // one colour per pixel in memory, or not
  config.stencil_bits = has_blocks && config.depth_bits <= 24 ? 8 : 0;
  return is_drawn_by_hardware(scene, config) ? std::optional(config) : std::nullopt;
}

/// Every fragment of the specification at each of its samples, and the unit's engine and the hardware against it.
void check_samples(Unit& here, const Scene& scene) {
  const Config& config = here.config;
  const Config judged = with_alpha(config, scene);
  FragmentJudge judge(scene, judged);
  RenderOptions options = render_options();
  options.fragment_tap = [&judge](const TappedFragment& fragment) { judge.add(fragment); };
  const Rendering specification = render_scalar(scene, config, options);
  const FragmentVerdict verdict = judge.finish(specification);
  here.count_triangles(specification.triangles.size());
  here.count_samples(verdict.coverage.samples);
  here.measure("coverage", "samples", static_cast<double>(verdict.coverage.mismatches), 0, scene);
  for (const PlaneVerdict& plane : verdict.planes) {
    if (plane.plane.is_depth)
      here.measure("depth of samples", "LSB", plane.worst, depth_error_bound(config), scene);
    else
      here.measure("color of samples", "LSB of 8 bits", plane.worst, 1, scene);
  }
  expect_same_image(here, scene, specification, here.engine(scene, config, render_options()));
  if (config.msaa_samples == 1) return;
  if (const auto hardware = hardware_of(config, scene))
    expect_same_image(here, scene, specification, render_hardware(scene, *hardware));
}

}  // namespace

void samples(Unit& unit) {
  const Config config = with_samples(unit);
  if (!is_legal(config)) return;  // the sample grid leaves too few bits of a lane
  Unit here(unit, config);
  const int width = unit.width(8 + unit.random.index(24)), height = unit.height(8 + unit.random.index(24));
  TriangleFamilies<Random> families(unit.config, width, height, Random(unit.random.next()));
  SceneBuilder builder(width, height);
  const Chooser choose = chooser(unit.random);
  for (int k = 0; k < 8; ++k) {
    if (k % 2 == 1)
      builder.with_state(random_state(SceneBuilder::window_state(),
                                      states_named({"depth_test", "cull", "blend", "color_mask", "stencil", "dither",
                                                    "alpha_test", "sample_mask", "alpha_to_coverage"}),
                                      choose));
    const auto v = families.triangle(k % decltype(families)::kFamilies);
    builder.triangle(v[0], v[1], v[2]);
  }
  check_samples(here, builder.scene);
}

void rectangles(Unit& unit) {
  Random& random = unit.random;
  const Config config = random.coin() ? unit.config : with_samples(unit);
  if (!is_legal(config)) return;  // the sample grid leaves too few bits of a lane
  Unit here(unit, config);
  const int width = unit.width(8 + random.index(24)), height = unit.height(8 + random.index(24));
  const int widest = std::min(9, config.guard_band - 3 - std::max(width, height));
  if (widest < 1) return;
  SceneBuilder builder(width, height);
  Scene& scene = builder.scene;
  const Chooser choose = chooser(random);
  for (std::uint32_t k = 1; k <= 6; ++k) {
    State state =
        random_state(SceneBuilder::window_state(),
                     states_named({"cull", "front", "polygon_mode", "shade", "scissor", "sample_mask"}), choose);
    state.line_rule = LineRule::rectangle;
    state.line_width = 1 + random.index(4 * (widest - 1) + 1) / 4.0;
    state.smooth = random.index(4) == 0;  // with one sample per pixel
    scene.states.push_back(state);
    const auto topology = static_cast<Topology>(random.index(6));
    scene.commands.push_back(Draw{k, 0, topology, scene.indices.size(), 6, 0});
    for (int i = 0; i < 6; ++i) {
      const bool is_far = random.index(8) == 0;
      const Point point = is_far ? random_guard_point(unit) : random_point(unit, width, height, 6);
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(random_vertex_at(unit, point));
    }
  }
  check_samples(here, scene);
}

}  // namespace halfplane::stress
