// One image from every engine and traversal; the stages stepped over the whole guard band; other fill rules.
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/exact.hpp"
#include "model/stages/interpolate.hpp"
#include "model/stages/tile_walk.hpp"
#include "model/study/traversal.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/specification.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/shapes.hpp"
#include "sim/study/stress/triangle_families.hpp"

namespace halfplane::stress {
namespace {

Scene family_scene(Unit& unit, int width, int height, int count) {
  TriangleFamilies<Random> families(unit.config, width, height, Random(unit.random.next()));
  SceneBuilder builder(width, height);
  for (int k = 0; k < count; ++k) {
    if (k % 4 == 3) {
      State state = SceneBuilder::window_state();
      state.depth_test = static_cast<DepthFunc>(unit.random.index(8));
      builder.with_state(state);
    }
    const auto v = families.triangle(unit.random.index(decltype(families)::kFamilies));
    builder.triangle(v[0], v[1], v[2]);
  }
  return std::move(builder.scene);
}

/// The box row by row, every second row from right to left: one addition per edge and step. Returns the samples where
/// the stepped edge functions and the oracle disagree.
std::uint64_t serpentine_errors(const TriangleSetup& setup, const Triangle& triangle, const Widths& widths,
                                std::uint64_t& samples) {
  const exact::TriangleOracle oracle(triangle, widths.grid_bits);
  EdgeValues value{};
  for (std::size_t i = 0; i < 3; ++i)
    value[i] = setup.edge[i].value -
               EdgeValue{setup.left - (setup.left >> widths.tile_shift << widths.tile_shift)} * setup.edge[i].dy +
               EdgeValue{setup.top - (setup.top >> widths.tile_shift << widths.tile_shift)} * setup.edge[i].dx;
  std::uint64_t errors = 0;
  int x = setup.left, way = 1;
  for (int y = setup.top; y <= setup.bottom; ++y, way = -way) {
    for (;;) {
      errors += (value[0] >= 0 && value[1] >= 0 && value[2] >= 0) != oracle.covers(x, y) ? 1 : 0;
      ++samples;
      if (x == (way > 0 ? setup.right : setup.left)) break;
      for (std::size_t i = 0; i < 3; ++i) value[i] -= EdgeValue{way} * setup.edge[i].dy;
      x += way;
    }
    for (std::size_t i = 0; i < 3; ++i) value[i] += setup.edge[i].dx;
  }
  return errors;
}

}  // namespace

void traversals(Unit& unit) {
  const int width = unit.width(24 + unit.random.index(16)), height = unit.height(24 + unit.random.index(16));
  const Scene scene = family_scene(unit, width, height, 6);
  const Rendering first = check_scene(unit, scene);
  for (const Traversal traversal : {Traversal::tiled, Traversal::bbox, Traversal::scanline, Traversal::brute}) {
    RenderOptions options = render_options();
    options.rules.traversal = traversal;
    expect_same_image(unit, scene, first, render_scalar(scene, unit.config, options));
  }
  std::uint64_t wrong = 0, samples = 0;
  for (const Triangle& t : first.triangles) {
    const TriangleSetup setup = setup_triangle(t, unit.config, unit.widths, {0, 0, width, height});
    if (!setup.is_empty()) wrong += serpentine_errors(setup, t, unit.widths, samples);
  }
  unit.count_samples(samples);
  unit.measure("serpentine", "samples", static_cast<double>(wrong), 0, scene);
}

void fill_rules(Unit& unit) {
  const Scene scene = family_scene(unit, unit.width(24), unit.height(24), 6);
  (void)check_scene(unit, scene, FillRule::offset_point);
  (void)check_scene(unit, scene, FillRule::inclusive);
  (void)check_scene(unit, scene, FillRule::exclusive);
}

void full_guard_band(Unit& unit) {
  // Stepping only: from the first tile to any other of the guard band, then inside it. No target, no clip.
  Random& random = unit.random;
  const Widths& widths = unit.widths;
  const int band = unit.config.guard_band, tile = unit.config.tile_size,
            grid_shift = widths.grid_bits - unit.config.subpixel_bits;
  Triangle triangle;
  SceneBuilder builder(unit.width(64), unit.height(64));
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    Point p = random_guard_point(unit);
    if (random.coin()) p.x = random.coin() ? lowest(unit) : highest(unit);
    if (random.coin()) p.y = random.coin() ? lowest(unit) : highest(unit);
    v[i] = random_vertex_at(unit, p);
    const auto z = static_cast<std::uint32_t>(std::llround(v[i].z * max_depth(unit.config)));
    triangle.v[i] = {static_cast<std::int32_t>(p.x << grid_shift), static_cast<std::int32_t>(p.y << grid_shift), z, {}};
  }
  builder.triangle(v[0], v[1], v[2]);
  unit.count_triangles(1);
  const TriangleSetup setup = setup_triangle(triangle, unit.config, widths);
  if (setup.area == 0 || setup.is_empty()) return;
  const exact::TriangleOracle oracle(triangle, widths.grid_bits);
  std::uint64_t wrong = 0, samples = 0, fragments = 0;
  double worst = 0;
  for (int n = 0; n < 48; ++n) {
    // A random tile, or the tile of a point near an edge.
    const std::size_t edge = static_cast<std::size_t>(random.index(3));
    const SnappedVertex &a = triangle.v[edge], &b = triangle.v[(edge + 1) % 3];
    const double t = random.unit();
    const bool is_near = random.coin();
    const auto pixel = [&](std::int32_t from, std::int32_t to) {
      return is_near ? static_cast<int>(from + t * (static_cast<double>(to) - from)) >> widths.grid_bits
                     : static_cast<int>(random.integer(-band, band - 1));
    };
    const int px = pixel(a.x, b.x), py = pixel(a.y, b.y);
    const int tile_x = px >> widths.tile_shift, tile_y = py >> widths.tile_shift;
    const EdgeValues value = edges_at_tile(setup, tile_x, tile_y, widths);
    for (int j = 0; j < tile; ++j)
      for (int i = 0; i < tile; ++i) {
        bool is_covered = true;
        for (std::size_t e = 0; e < 3; ++e)
          is_covered &= saturate_tile_edge(value[e], widths) - i * setup.edge[e].dy + j * setup.edge[e].dx >= 0;
        const int x = tile_x * tile + i, y = tile_y * tile + j;
        const bool expected = oracle.covers(x, y);
        ++samples;
        wrong += is_covered != expected ? 1 : 0;
        if (!expected) continue;
        const exact::Rational plane = oracle.depth_at(x, y);
        const int128 distance =
            int128{plane_at(setup, kDepthPlane, widths, x, y).code} * plane.denominator - plane.numerator;
        ++fragments;
        worst = std::max(
            worst, static_cast<double>(distance < 0 ? -distance : distance) / static_cast<double>(plane.denominator));
      }
  }
  unit.count_samples(samples + fragments);
  unit.measure("coverage", "samples", static_cast<double>(wrong), 0, builder.scene);
  unit.measure("depth over the guard band", "LSB", worst, depth_error_bound(unit.config), builder.scene);
}

void stalls(Unit& unit) {
  // The cycle engine, exact against the RTL, with random back-pressure on every stream. The RTL itself: `cosim --stalls`.
  Random& random = unit.random;
  const Scene scene = random_scene(unit.config, random.next(), 24);
  if (!is_drawn_by_hardware(scene, unit.config)) return;
  MemorySettings memory;
  memory.kind = static_cast<MemoryKind>(random.index(5));
  memory.latency = 1 + random.index(40);
  CycleOptions options;
  options.stalls = {random.next(), stall_threshold(random.between(0, 0.7))};
  const auto timing = make_memory(memory, unit.config);
  const Rendering functional = unit.engine(scene, unit.config, render_options());
  unit.count_triangles(functional.triangles.size());
  options.textures = memory;
  const CycleRendering cycle = render_cycle(scene, unit.config, *timing, {}, options);
  expect_same_image(unit, scene, functional, cycle.rendering);
}

void hardware_surfaces(Unit& unit) {
  // The hardware model, the reference of co-simulation, and the engine against the scalar one.
  const Config config = random_shading_config(unit.random);
  unit.count_config(std::hash<std::string>()(label(config, " --set ")));
  const Scene scene = random_scene(config, unit.random.next(), 24);
  Unit shaded(unit, config);
  shaded.count_triangles(24);
  const std::string of_hardware = difference_from_specification(scene, config);
  (void)shaded.require(of_hardware.empty(), "hardware model", scene, of_hardware);
  const std::string of_engine = difference_from_specification(
      scene, config,
      [&unit](const Scene& drawn, const Config& with) { return unit.engine(drawn, with, render_options()).frame; });
  (void)shaded.require(of_engine.empty(), "engine", scene, of_engine);
}

void frames(Unit& unit) {
  // Skipped bins have equal signatures: in the functional engine and, if such hardware exists, in its model.
  Random& random = unit.random;
  FunctionalEngine engine(unit.config);
  Config bins = unit.config;
  bins.frame_order = FrameOrder::bins;
  bins.frame_store = FrameStore::color;
  std::optional<HardwareFrames> hardware;
  Scene scene = random_scene(unit.config, random.next(), 8);
  try {
    (void)unit.engine(scene, unit.config, render_options());
  } catch (const InputError&) {
    return;  // a guard band without room for a point beside the target
  }
  if (is_drawn_by_hardware(scene, bins)) hardware.emplace(bins);
  RenderOptions follows;
  follows.follows = true;
  for (int n = 0; n < 4; ++n) {
    const Rendering alone = unit.engine(scene, unit.config, render_options());
    unit.count_triangles(alone.triangles.size());
    expect_same_image(unit, scene, alone, engine.render(scene, follows));
    if (hardware) {
      const Rendering frame = hardware->draw(scene);
      unit.measure("bins left alone", "pixels", frame.frame.color == alone.frame.color ? 0 : 1, 0, scene);
    }
    scene = next_frame(scene, random.next());
  }
}

}  // namespace halfplane::stress
