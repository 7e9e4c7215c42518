#include "sim/study/bench/skips.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "model/engines/functional.hpp"
#include "sim/interrupt.hpp"
#include "sim/study/bench/growth.hpp"

namespace halfplane {
namespace {

constexpr std::string_view kObjects = "objects", kNodes = "nodes", kBins = "bins";
// Not built-in scenes: they show nothing new.
constexpr std::string_view kFineGrid = "grid below a subpixel", kGlassBehind = "glass behind a wall",
                           kFaint = "layers that fade out", kOpaqueGlass = "opaque glass", kMasked = "masked glass",
                           kOneMoves = "city, one house moves", kAllMove = "city, everything moves";
constexpr std::array kOwn{kFineGrid, kGlassBehind, kFaint, kOpaqueGlass, kMasked, kOneMoves, kAllMove};

/// The reasons for the pairs. objects, nodes and frustum: nearly all of `objects` lies outside, and the teapot inside.
/// backface: a closed mesh, and triangles of which none faces away. zero_area and empty: triangles smaller than the
/// snap grid and smaller than a pixel, and half-screen triangles. objects_hiz: whole objects hidden by a wall, and objects
/// drawn from front to back that mostly show. tiles_hiz: the same layers in either order. attributes: layers, and
/// triangles that take no tile as a whole. tiles_outside: long diagonal triangles, whose boxes are mostly empty, and
/// ones of about a pixel. trivially_accepted: large triangles, and ones that fill no tile. fragments_early_z: overlap
/// that tiles alone do not decide, and layers that all pass. clear: a mesh that touches few tiles, and triangles that
/// need every pixel of them. operations_early_z: blended layers behind opaque ones, and layers that all are seen.
/// alpha_tiles: layers half of which an alpha test drops by the alpha of their vertices, and by a texture's alpha,
/// which decides half of the tiles. opaque_blends: layers that blend, of alpha 1 and of less. masked_draws: blended
/// layers whose channels are masked, and layers that write all. bins: two alternating pictures in which one object has
/// moved, or all have; all other scenes are static.
constexpr std::array<SkipPair, 19> kPairs{{{kObjects, "objects", "teapot"},
                                           {kNodes, "objects", "teapot"},
                                           {"frustum", "objects", "teapot"},
                                           {"backface", "ball", "layers"},
                                           {"zero_area", kFineGrid, "layers"},
                                           {"empty", "slivers", "layers"},
                                           {"no_sample", "dust", "layers"},
                                           {"objects_hiz", "hidden", "blocks"},
                                           {"tiles_hiz", "layers_front", "layers"},
                                           {"tiles_outside", "slivers", "dust"},
                                           {"trivially_accepted", "layers", "dust"},
                                           {"fragments_early_z", "blocks", "layers"},
                                           {"attributes", "layers", "dust"},
                                           {"clear", "teapot", "dust"},
                                           {"operations_early_z", kGlassBehind, "layers_glass"},
                                           {"alpha_tiles", kFaint, "layers_leaves"},
                                           {"opaque_blends", kOpaqueGlass, "layers_glass"},
                                           {"masked_draws", kMasked, "layers"},
                                           {"bins", kOneMoves, kAllMove}}};

/// Frames of a separate engine, with or without one kind of skipping, of the scenes in turns. `counters`: of the last
/// frame; may be null.
Frame skip_frame(const std::vector<std::shared_ptr<const Scene>>& scenes, const SkipPlan& plan, std::string_view skip,
                 bool is_on, Counters* counters) {
  RenderOptions options;
  options.threads = plan.threads;
  options.follows = skip == kBins;
  for (const SkipName& entry : kSkipNames)
    if (entry.name == skip) options.skip.*entry.member = is_on;
  std::vector<std::shared_ptr<const PreparedScene>> prepared;
  for (const auto& scene : scenes) prepared.push_back(std::make_shared<const PreparedScene>(*scene));
  return [engine = std::make_shared<FunctionalEngine>(plan.config), scenes, prepared, options, counters,
          turn = std::size_t{0}]() mutable {
    const auto start = std::chrono::steady_clock::now();
    const Rendering& rendering = engine->render(*prepared[turn++ % prepared.size()], options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (counters != nullptr) *counters = rendering.counters;
    return FrameCost{seconds, 0};
  };
}

/// The same including the conversion of the mesh.
Frame whole_frame(const SkipMaker& maker, const SkipPlan& plan) {
  RenderOptions options;
  options.threads = plan.threads;
  return [engine = std::make_shared<FunctionalEngine>(plan.config), maker, options]() {
    const auto start = std::chrono::steady_clock::now();
    const Scene scene = maker.make();
    const PreparedScene prepared(scene);
    (void)engine->render(prepared, options);
    return FrameCost{std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0};
  };
}

Scene make_fine_grid(const SkipPlan& plan) {
  constexpr std::size_t kTriangles = 200'000;
  const double cell = std::ldexp(0.25, -plan.config.subpixel_bits);  // pixels
  return make_layered_grid({plan.width, plan.height, cell, cell, kTriangles});
}

/// The nearest two of `layers_front`, which hide all others: these are glass.
Scene glass_behind(Scene scene, const State& glass) {
  constexpr std::uint32_t kWall = 6;  // indices
  scene.states.push_back(glass);
  for (std::size_t i = kWall; i < scene.vertices.size(); ++i) scene.vertices[i].rgba[3] = 128;
  auto& wall = std::get<Draw>(scene.commands.back());
  Draw behind = wall;
  behind.state = static_cast<std::uint32_t>(scene.states.size() - 1);
  behind.first += kWall;
  behind.count -= kWall;
  wall.count = kWall;
  scene.commands.emplace_back(behind);
  return scene;
}

/// Alpha varying from corner to corner of each triangle of a scene.
Scene with_alpha(Scene scene, const std::array<double, 3>& alpha) {
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) scene.vertices[i].rgba[3] = alpha[i % 3];
  return scene;
}

/// Moved by a hundredth of the target to the right: everything, or one object.
Scene moved(Scene scene, bool moves_all) {
  std::vector<bool> moves(scene.vertices.size(), moves_all);
  const auto draws =
      std::ranges::count_if(scene.commands, [](const Command& c) { return std::holds_alternative<Draw>(c); });
  std::ptrdiff_t number = 0;
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command); draw != nullptr && number++ == draws / 2)
      for (std::size_t i = draw->first; i < draw->first + draw->count; ++i) moves[scene.indices[i]] = true;
  for (std::size_t i = 0; i < moves.size(); ++i)
    if (moves[i]) scene.vertices[i].x += 0.02 * scene.vertices[i].w;
  return scene;
}

/// A scene without a file, made from built-in ones.
Scene make_skip_scene(const SkipPlan& plan, std::string_view name) {
  if (name == kFineGrid) return make_fine_grid(plan);
  const auto load = [&plan](const char* built_in) { return *plan.load(built_in, false).scene; };
  const Scene glass = load("layers_glass");
  if (name == kOneMoves || name == kAllMove) return *plan.load("city:100", false).scene;
  if (name == kGlassBehind) return glass_behind(load("layers_front"), glass.states[0]);
  if (name == kFaint) {
    Scene scene = with_alpha(load("layers"), {0, 128, 255});
    scene.states[0].alpha_test = {DepthFunc::gequal, 128};
    return scene;
  }
  Scene scene = name == kOpaqueGlass ? with_alpha(glass, {255, 255, 255}) : glass;
  scene.states[0].depth_write = true;
  if (name == kMasked) scene.states[0].color_mask = {false, false, false, false};
  return scene;
}

/// Loads each scene once.
class SceneShelf {
 public:
  explicit SceneShelf(const SkipPlan& plan) : plan_(plan) {}
  const SkipScene& get(const std::string& name, bool culls_objects) {
    const auto key = std::pair(name, culls_objects);
    if (const auto found = scenes_.find(key); found != scenes_.end()) return found->second;
    const bool is_own = std::ranges::find(kOwn, name) != kOwn.end();
    const SkipScene made = is_own ? SkipScene{std::make_shared<const Scene>(make_skip_scene(plan_, name)), 0}
                                  : plan_.load(name, culls_objects);
    return scenes_.emplace(key, made).first->second;
  }

 private:
  const SkipPlan& plan_;
  std::map<std::pair<std::string, bool>, SkipScene> scenes_;
};

void take_times(SkipRow& row, std::vector<FrameTimes> times) {
  for (const FrameTimes& one : times)
    if (one.refusal) std::rethrow_exception(one.refusal);
  row.with = std::move(times[0]);
  row.without = std::move(times[1]);
}

void measure_nodes(SkipRow& row, const SkipPlan& plan, const std::function<void(double)>& progress) {
  const SkipMaker with = plan.open(row.scene, true);
  const std::array<Frame, 2> frames{whole_frame(with, plan), whole_frame(plan.open(row.scene, false), plan)};
  take_times(row, measure_in_turns(frames, plan.repeat, progress));
  row.counter = with.vertices_skipped();
}

void measure_skip(SkipRow& row, SceneShelf& shelf, const SkipPlan& plan, const std::function<void(double)>& progress) {
  if (row.skip == kNodes) return measure_nodes(row, plan, progress);
  const bool is_objects = row.skip == kObjects;
  // Culled objects have no triangles left for the frustum test to drop.
  const SkipScene with = shelf.get(row.scene, row.skip != "frustum");
  const SkipScene without = is_objects ? shelf.get(row.scene, false) : with;
  std::vector<std::shared_ptr<const Scene>> scenes{with.scene};
  if (row.scene == kOneMoves || row.scene == kAllMove)
    scenes.push_back(std::make_shared<const Scene>(moved(*with.scene, row.scene == kAllMove)));
  Counters counters;
  const std::array<Frame, 2> frames{
      skip_frame(scenes, plan, row.skip, true, &counters),
      skip_frame(is_objects ? std::vector{without.scene} : scenes, plan, row.skip, false, nullptr)};
  take_times(row, measure_in_turns(frames, plan.repeat, progress));
  if (is_objects) row.counter = with.primitives_culled;
  for (const SkipName& entry : kSkipNames)
    if (entry.name == row.skip) row.counter = counters.skipped.*entry.counter;
}

}  // namespace

std::span<const SkipPair> skip_pairs() { return kPairs; }

std::vector<SkipRow> measure_skips(const SkipPlan& plan) {
  std::vector<SkipRow> rows;
  for (const SkipPair& pair : kPairs) {
    const auto add = [&](std::string_view scene) {
      SkipRow row;
      row.skip = pair.skip;
      row.scene = scene;
      row.is_made_for = scene == pair.made_for;
      rows.push_back(std::move(row));
    };
    for (const std::string& scene : plan.scenes) add(scene);
    if (plan.scenes.empty()) {
      add(pair.made_for);
      add(pair.cannot_help);
    }
  }
  SceneShelf shelf(plan);
  try {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto progress = [&, i](double fraction) {
        if (plan.progress) plan.progress((static_cast<double>(i) + fraction) / static_cast<double>(rows.size()));
      };
      progress(0);
      measure_skip(rows[i], shelf, plan, progress);
    }
  } catch (const Interrupted&) {  // the rows so far are kept
  }
  // Incomplete if the study was ended early.
  std::erase_if(rows, [](const SkipRow& row) { return row.with.seconds.empty() || row.without.seconds.empty(); });
  return rows;
}

}  // namespace halfplane
