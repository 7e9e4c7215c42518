#include "sim/cosim/reduce.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "model/draw_states.hpp"
#include "model/host/primitive_assembly.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/host/primitives.hpp"
#include "model/host/viewport.hpp"
#include "model/stages/line_raster.hpp"
#include "sim/interrupt.hpp"

namespace halfplane {
namespace {

/// A triangle, line, point or clear with its own state, so that any item can be removed.
struct Item {
  State state;
  std::optional<Clear> clear;
  Topology topology = Topology::triangles;  ///< or lines or points: a list
  std::array<Vertex, 3> v{};
  std::array<std::array<double, 3>, 3> normal{};

  [[nodiscard]] std::span<Vertex> corners() {
    return std::span(v).first(topology == Topology::triangles ? 3 : topology == Topology::lines ? 2 : 1);
  }
};
using Items = std::vector<Item>;

void add_draw(Items& items, const Scene& scene, const Draw& draw) {
  Item item{scene.states[draw.state], {}, Topology::triangles, {}, {}};
  const auto add = [&](std::array<std::uint32_t, 3> index) {
    for (std::size_t i = 0; i < item.corners().size(); ++i) {
      item.v[i] = scene.vertices[index[i]];
      item.normal[i] = scene.normal(index[i]);
    }
    items.push_back(item);
  };
  switch (primitive_type(draw.topology)) {
    case PrimitiveType::triangle: {
      const Provoking provoking = std::exchange(item.state.provoking, Provoking::first);  // it comes first from now on
      for_each_triangle(scene, draw, provoking, [&](auto a, auto b, auto c) { add({a, b, c}); });
      return;
    }
    case PrimitiveType::line:
      item.topology = Topology::lines;
      for_each_line(scene, draw, [&](auto start, auto end) { add({start, end, 0}); });
      return;
    case PrimitiveType::point:
      item.topology = Topology::points;
      for_each_point(scene, draw, [&](auto index) { add({index, 0, 0}); });
  }
}

Items items_of(const Scene& scene) {
  Items items;
  for (const Command& command : scene.commands) {
    if (const auto* clear = std::get_if<Clear>(&command))
      items.push_back({scene.states[clear->state], *clear, Topology::triangles, {}, {}});
    if (const auto* draw = std::get_if<Draw>(&command)) add_draw(items, scene, *draw);
  }
  return items;
}

/// Adds the textures of the states, which have their numbers in `like`.
void add_textures(const Scene& like, Scene& scene) {
  std::vector<std::uint32_t> number(like.textures.size(), ~0U);
  for (State& state : scene.states) {
    if (!state.texture) continue;
    std::uint32_t& added = number[*state.texture];
    if (added == ~0U) {
      added = static_cast<std::uint32_t>(scene.textures.size());
      scene.textures.push_back(like.textures[*state.texture]);
    }
    state.texture = added;
  }
}

/// Neighbours of one state and kind become one draw.
Scene scene_of(Items items, const Scene& like, int width, int height) {
  Scene scene;
  scene.name = like.name;
  scene.width = width;
  scene.height = height;
  for (Item& item : items) {
    if (scene.states.empty() || !(scene.states.back() == item.state)) scene.states.push_back(item.state);
    const auto state = static_cast<std::uint32_t>(scene.states.size() - 1);
    if (item.clear) {
      Clear clear = *item.clear;
      clear.state = state;
      scene.commands.push_back(clear);
      continue;
    }
    Draw* draw = scene.commands.empty() ? nullptr : std::get_if<Draw>(&scene.commands.back());
    if (draw == nullptr || draw->state != state || draw->topology != item.topology) {
      scene.commands.push_back(Draw{state, 0, item.topology, scene.indices.size(), 0, 0});
      draw = std::get_if<Draw>(&scene.commands.back());
    }
    for (std::size_t i = 0; i < item.corners().size(); ++i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(item.v[i]);
      if (item.normal[i] == std::array<double, 3>{}) continue;
      scene.normals.resize(scene.vertices.size());
      scene.normals.back() = item.normal[i];
    }
    draw->count += item.corners().size();
  }
  add_textures(like, scene);
  return scene;
}

/// Whether another size of the target moves it on the screen.
bool depends_on_target(const Item& item) {
  return item.state.origin == Origin::bottom_left || (!item.clear && item.state.space == Space::clip);
}

std::size_t primitives_in(const Items& items) {
  return static_cast<std::size_t>(std::count_if(items.begin(), items.end(), [](const Item& i) { return !i.clear; }));
}

class Reducer {
 public:
  Reducer(const Scene& scene, const Config& config, const LockstepOptions& lockstep, const FailTest& test,
          const ReduceOptions& options)
      : config_(config), test_(test), options_(options), scene_(scene), items_(items_of(scene)) {
    best_.lockstep = lockstep;
    best_.primitives_before = primitives_in(items_);
    width_ = scene.width;
    height_ = scene.height;
  }

  std::optional<Reduced> run() {
    bool is_whole = true;
    try {
      if (!is_failing()) return {};
      simplify_all();
    } catch (const Interrupted&) {
      if (!has_failed()) throw;
      is_whole = false;
    }
    best_.primitives_after = primitives_in(items_);
    best_.is_minimal = is_whole && !is_late();
    return best_;
  }

 private:
  [[nodiscard]] bool is_late() const { return elapsed() > options_.seconds; }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// Whether some run has failed: from then on there is a result.
  [[nodiscard]] bool has_failed() const { return !best_.scene.commands.empty(); }

  [[nodiscard]] bool keeps(std::string_view what) const {
    return std::find(options_.kept.begin(), options_.kept.end(), what) != options_.kept.end();
  }

  void report() const {
    if (options_.progress) options_.progress(elapsed() / options_.seconds);
  }

  /// Tests the whole scene, without stalls if it fails without them.
  bool is_failing() {
    LockstepOptions calm = best_.lockstep;
    calm.stall_probability = 0;
    if (best_.lockstep.stall_probability != 0 && try_scene(scene_, calm)) return true;
    return try_scene(scene_, best_.lockstep);
  }

  void simplify_all() {
    to_window_space();
    cut_after_failure();
    crop();
    remove();
    simplify_states();
    simplify_vertices();
    crop();
    remove();
  }

  bool try_scene(const Scene& scene, const LockstepOptions& lockstep) {
    ++best_.runs;
    report();
    LockstepOptions limited = lockstep;
    limited.trace.clear();
    limited.progress = [this](double) {
      report();
      return !has_failed() || !is_late();
    };
    auto mismatch = test_(scene, limited);
    if (!mismatch) return false;
    best_.scene = scene;
    best_.lockstep = lockstep;
    best_.mismatch = std::move(*mismatch);
    return true;
  }

  /// Keeps a change if it still fails.
  bool try_items(Items items, int width, int height) {
    if (is_late() || !try_scene(scene_of(items, scene_, width, height), best_.lockstep)) return false;
    items_ = std::move(items);
    width_ = width;
    height_ = height;
    return true;
  }
  bool try_items(Items items) { return try_items(std::move(items), width_, height_); }

  void to_window_space();
  void cut_after_failure();
  void crop();
  void remove();
  void simplify_states();
  void simplify_vertices();
  template <class Change>
  bool simplify(Change change);

  const Config& config_;
  const FailTest& test_;
  const ReduceOptions& options_;
  const Scene& scene_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Items items_;
  int width_ = 0, height_ = 0;
  Reduced best_;
};

void Reducer::to_window_space() {
  if (keeps("space") || std::none_of(items_.begin(), items_.end(), depends_on_target)) return;
  try {
    try_items(items_of(window_scene(scene_, config_)));
  } catch (const InputError&) {  // what this hardware does not have: a program of others may
  }
}

/// Removes items after the failing primitive, which are rarely needed, and often most of the earlier items.
void Reducer::cut_after_failure() {
  if (!best_.mismatch.primitive) return;
  std::size_t end = 0;
  for (std::size_t seen = 0; end < items_.size(); ++end)
    if (!items_[end].clear && seen++ == *best_.mismatch.primitive) break;
  if (end >= items_.size()) return;
  const auto last = items_.begin() + static_cast<std::ptrdiff_t>(end) + 1;
  for (std::size_t n = 1; n <= end; n *= 4)
    if (try_items(Items(last - static_cast<std::ptrdiff_t>(n), last))) return;
  try_items(Items(items_.begin(), last));
}

/// Makes the target smaller: to the failing tile, then by halves. A flush of a large target would be most of every run.
void Reducer::crop() {
  if (keeps("target")) return;
  for (const Item& item : items_)
    if (depends_on_target(item)) return;  // the picture would change
  const Mismatch& m = best_.mismatch;
  if (m.tile_x && m.tile_y) {
    const int right = (static_cast<int>(*m.tile_x) + 1) * config_.tile_size;
    const int bottom = (static_cast<int>(*m.tile_y) + 1) * config_.tile_size;
    if (right < width_ || bottom < height_) try_items(items_, std::min(right, width_), std::min(bottom, height_));
  }
  while (width_ > 1 && try_items(items_, (width_ + 1) / 2, height_)) continue;
  while (height_ > 1 && try_items(items_, width_, (height_ + 1) / 2)) continue;
}

/// Removes runs of items, long ones first, until no single one can be removed.
void Reducer::remove() {
  for (std::size_t length = std::max<std::size_t>(1, items_.size() / 2);;
       length = std::max<std::size_t>(1, length / 2)) {
    bool has_removed = false;
    for (std::size_t end = items_.size(); end > 0 && !is_late();) {  // from the end: causes come before effects
      const std::size_t begin = end - std::min(length, end);
      Items fewer(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(begin));
      fewer.insert(fewer.end(), items_.begin() + static_cast<std::ptrdiff_t>(end), items_.end());
      has_removed |= try_items(std::move(fewer));
      end = begin;
    }
    if (is_late() || (length == 1 && !has_removed)) return;
  }
}

/// Applies change(item) to all items at once, and if the scene no longer fails, to each alone. change() returns whether
/// it changed the item. Returns whether any change was kept.
template <class Change>
bool Reducer::simplify(Change change) {
  Items all = items_;
  bool has_changed = false;
  for (Item& item : all) has_changed |= change(item);
  if (!has_changed) return false;
  if (try_items(std::move(all))) return true;
  bool is_kept = false;
  for (std::size_t i = 0; items_.size() <= 64 && i < items_.size(); ++i) {
    Items one = items_;
    if (change(one[i])) is_kept |= try_items(std::move(one));
  }
  return is_kept;
}

/// Simplifies each state of the table; hardware states last, and the last of them first: a culled primitive no longer
/// fails, so `front` may have to stay until `cull` is reset. Repeats until nothing changes.
void Reducer::simplify_states() {
  std::vector<const DrawState*> rows;
  for (const DrawState& row : draw_states())
    if (!keeps(row.name)) rows.push_back(&row);
  const auto hardware = std::stable_partition(rows.begin(), rows.end(),
                                              [](const DrawState* row) { return row->home == StateHome::host; });
  std::reverse(hardware, rows.end());
  for (bool has_changed = true; has_changed && !is_late();) {
    has_changed = false;
    for (const DrawState* row : rows)
      has_changed |= simplify([row, simplest = row->simplest_value()](Item& item) {
        if (row->value(item.state) == simplest) return false;
        row->set(item.state, simplest);
        return true;
      });
  }
}

void Reducer::simplify_vertices() {
  const auto for_vertices = [this](auto change) {
    simplify([&](Item& item) {
      bool has_changed = false;
      if (!item.clear)
        for (Vertex& v : item.corners()) has_changed |= change(v, item);
      return has_changed;
    });
  };
  const auto assign = [](auto& value, const auto& to) { return std::exchange(value, to) != to; };
  for (std::size_t part = 2; part < kVertexParts.size(); ++part)  // colours, and the later parts
    for_vertices([part](Vertex& v, const Item&) {
      constexpr VertexNumbers defaults = numbers_of(Vertex{});
      const VertexNumbers before = numbers_of(v);
      VertexNumbers after = before;
      for (std::size_t i = kVertexParts[part - 1].end; i < kVertexParts[part].end; ++i) after[i] = defaults[i];
      v = vertex_of(after);
      return after != before;
    });
  for_vertices([&](Vertex& v, const Item& item) { return item.state.space == Space::window && assign(v.z, 0.5); });
  for_vertices([&](Vertex& v, const Item& item) { return assign(v.z, item.v[0].z); });
  simplify([](Item& item) { return std::exchange(item.normal, {}) != decltype(item.normal){}; });
  for_vertices([&](Vertex& v, const Item& item) {
    if (item.state.space != Space::window) return false;
    const double most = config_.guard_band - 1;
    return (assign(v.x, std::min(most, std::round(v.x))) | assign(v.y, std::min(most, std::round(v.y)))) != 0;
  });
}

}  // namespace

FailTest lockstep_test(Dut& dut, const Config& config) {
  return [&dut, &config](const Scene& scene, const LockstepOptions& options) -> std::optional<Mismatch> {
    try {
      return Lockstep(dut, config, options).run(scene).mismatch;
    } catch (const InputError&) {  // a simplification that left the guard band, for example
      return {};
    }
  };
}

std::optional<Reduced> reduce(const Scene& scene, const Config& config, const LockstepOptions& lockstep,
                              const FailTest& test, const ReduceOptions& options) {
  return Reducer(scene, config, lockstep, test, options).run();
}

namespace {

/// From its first pixel to its last: sufficient for finding a fault, although not always with the same pixels.
void to_window_line(Item& item, const LineSetup& line, const Config& config, const Widths& widths) {
  item.topology = Topology::lines;
  item.state.line_rule = LineRule::bresenham;
  item.state.scissor.reset();  // its box is at its beginning
  bool is_first = true;
  line_raster(line, widths, [&](const LinePixel& pixel) {
    item.v[1] = vertex_of_codes(pixel.code, config);
    item.v[1].x = pixel.x + 0.5;
    item.v[1].y = pixel.y + 0.5;
    if (std::exchange(is_first, false)) item.v[0] = item.v[1];
  });
}

/// A square around the middle of its box, which is the scissor.
void to_window_point(Item& item, const PrimitivePacket& p, const Config& config) {
  item.topology = Topology::points;
  const PixelBox& box = p.box;
  item.state.point_size = std::max(box.right - box.left, box.bottom - box.top) + 1;
  item.v[0] = vertex_of_codes(p.vertex.code[0], config);
  item.v[0].x = (box.left + box.right + 1) / 2.0;
  item.v[0].y = (box.top + box.bottom + 1) / 2.0;
}

}  // namespace

Scene window_scene(const Scene& scene, const Config& config) {
  const Widths widths = derive_widths(config);
  const double grid = std::ldexp(1.0, std::max(1, config.subpixel_bits));
  Config in_program_order = config;  // each primitive once
  in_program_order.frame_order = FrameOrder::program;
  in_program_order.resolve_units = 0;
  HostStream host(scene, in_program_order);
  Items items;
  while (const auto sent = host.next()) {
    const PrimitivePacket& p = sent->packet;
    if (sent->command == HostPrimitive::kNoCommand) continue;  // the first clear and the flush
    Item item;
    item.state.space = Space::window;
    const PixelBox& box = p.box;
    if (box.left > 0 || box.top > 0 || box.right + 1 < scene.width || box.bottom + 1 < scene.height)
      item.state.scissor = Rect{box.left, box.top, box.right - box.left + 1, box.bottom - box.top + 1};
    if (!is_counted(p.kind)) {
      const Vertex cleared = vertex_of_codes(p.vertex.code[0], config);
      Clear clear;
      if (p.state.depth_write) clear.depth = cleared.z;
      if (p.state.color_write) clear.color = cleared.rgba;
      item.clear = clear;
    } else {
      const Draw& draw = std::get<Draw>(scene.commands[sent->command]);
      State drawn = scene.states[draw.state];
      if (draws_rectangles(drawn, draw.topology)) drawn = rectangle_state(drawn);
      for (const DrawState& row : draw_states())
        if (row.home != StateHome::host) row.set(item.state, row.value(drawn));
      item.state.cull = p.cull;  // none where it was clipped
      item.state.front = p.front_cw ? FrontFace::cw : FrontFace::ccw;
      if (p.kind == PrimitiveKind::line)
        to_window_line(item, *sent->line, config, widths);
      else if (p.kind == PrimitiveKind::point)
        to_window_point(item, p, config);
      else
        for (std::size_t i = 0; i < 3; ++i) {
          item.v[i] = vertex_of_codes(p.vertex.code[i], config);
          item.v[i].x = p.vertex.x[i] / grid;
          item.v[i].y = p.vertex.y[i] / grid;
        }
    }
    items.push_back(item);
  }
  return scene_of(items, scene, scene.width, scene.height);
}

}  // namespace halfplane
