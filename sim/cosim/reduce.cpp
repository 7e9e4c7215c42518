#include "sim/cosim/reduce.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/host_stream.hpp"

namespace halfplane {
namespace {

/// A triangle or a clear with a state of its own, so that anything can be taken out.
struct Item {
  State state;
  std::optional<Clear> clear;
  std::array<Vertex, 3> v{};
};
using Items = std::vector<Item>;

Items items_of(const Scene& scene) {
  Items items;
  for (const Command& command : scene.commands) {
    if (const auto* clear = std::get_if<Clear>(&command)) items.push_back({scene.states[clear->state], *clear, {}});
    if (const auto* draw = std::get_if<Draw>(&command))
      for_each_triangle(scene, *draw, scene.states[draw->state].provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        items.push_back({scene.states[draw->state], {}, {scene.vertices[a], scene.vertices[b], scene.vertices[c]}});
      });
  }
  return items;
}

/// Neighbours of one state become one draw.
Scene scene_of(const Items& items, const Scene& like, int width, int height) {
  Scene scene;
  scene.name = like.name;
  scene.width = width;
  scene.height = height;
  for (const Item& item : items) {
    if (scene.states.empty() || !(scene.states.back() == item.state)) scene.states.push_back(item.state);
    const auto state = static_cast<std::uint32_t>(scene.states.size() - 1);
    if (item.clear) {
      Clear clear = *item.clear;
      clear.state = state;
      scene.commands.push_back(clear);
      continue;
    }
    Draw* draw = scene.commands.empty() ? nullptr : std::get_if<Draw>(&scene.commands.back());
    if (draw == nullptr || draw->state != state) {
      scene.commands.push_back(Draw{state, 0, Topology::triangles, scene.indices.size(), 0, 0});
      draw = std::get_if<Draw>(&scene.commands.back());
    }
    for (const Vertex& v : item.v) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(v);
    }
    draw->count += 3;
  }
  return scene;
}

/// Whether another size of the target moves it on the screen.
bool depends_on_target(const Item& item) {
  return item.state.origin == Origin::bottom_left || (!item.clear && item.state.space == Space::clip);
}

std::size_t triangles_in(const Items& items) {
  return static_cast<std::size_t>(std::count_if(items.begin(), items.end(), [](const Item& i) { return !i.clear; }));
}

class Reducer {
 public:
  Reducer(const Scene& scene, const Config& config, const LockstepOptions& lockstep, const FailTest& test,
          const ReduceOptions& options)
      : config_(config), test_(test), options_(options), scene_(scene), items_(items_of(scene)) {
    best_.lockstep = lockstep;
    best_.triangles_before = triangles_in(items_);
    width_ = scene.width;
    height_ = scene.height;
  }

  std::optional<Reduced> run() {
    LockstepOptions calm = best_.lockstep;
    calm.stall_probability = 0;
    if (best_.lockstep.stall_probability == 0 || !try_scene(scene_, calm))
      if (!try_scene(scene_, best_.lockstep)) return {};
    to_window_space();
    cut_after_failure();
    crop();
    remove();
    simplify_states();
    simplify_vertices();
    crop();
    remove();
    best_.triangles_after = triangles_in(items_);
    best_.is_minimal = !is_late();
    return best_;
  }

 private:
  [[nodiscard]] bool is_late() const { return elapsed() > options_.seconds; }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  bool try_scene(const Scene& scene, const LockstepOptions& lockstep) {
    ++best_.runs;
    if (options_.progress) options_.progress(elapsed() / options_.seconds);
    LockstepOptions limited = lockstep;
    limited.trace.clear();
    if (!best_.scene.commands.empty()) limited.progress = [this](double) { return !is_late(); };
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
  void simplify(Change change);

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
  const bool has_other = std::any_of(items_.begin(), items_.end(), depends_on_target);
  if (has_other) try_items(items_of(window_scene(scene_, config_)));
}

/// What comes after the primitive that fails is rarely needed, and often little of what comes before it.
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

/// A smaller target: to the tile that fails, then by halves. A flush of a large one would be most of every run.
void Reducer::crop() {
  for (const Item& item : items_)
    if (depends_on_target(item)) return;  // it would be another picture
  const Mismatch& m = best_.mismatch;
  if (m.tile_x && m.tile_y) {
    const int right = (static_cast<int>(*m.tile_x) + 1) * config_.tile_size;
    const int bottom = (static_cast<int>(*m.tile_y) + 1) * config_.tile_size;
    if (right < width_ || bottom < height_) try_items(items_, std::min(right, width_), std::min(bottom, height_));
  }
  while (width_ > 1 && try_items(items_, (width_ + 1) / 2, height_)) continue;
  while (height_ > 1 && try_items(items_, width_, (height_ + 1) / 2)) continue;
}

/// Takes out runs of items, long ones first, until no single one can go.
void Reducer::remove() {
  for (std::size_t length = std::max<std::size_t>(1, items_.size() / 2);;
       length = std::max<std::size_t>(1, length / 2)) {
    bool has_removed = false;
    for (std::size_t end = items_.size(); end > 0 && !is_late();) {  // from the back: causes come before effects
      const std::size_t begin = end - std::min(length, end);
      Items fewer(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(begin));
      fewer.insert(fewer.end(), items_.begin() + static_cast<std::ptrdiff_t>(end), items_.end());
      has_removed |= try_items(std::move(fewer));
      end = begin;
    }
    if (is_late() || (length == 1 && !has_removed)) return;
  }
}

/// Applies change(item) to all items at once, and if that no longer fails, to each alone. It returns whether it changed.
template <class Change>
void Reducer::simplify(Change change) {
  Items all = items_;
  bool has_changed = false;
  for (Item& item : all) has_changed |= change(item);
  if (!has_changed || try_items(std::move(all)) || items_.size() > 64) return;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    Items one = items_;
    if (change(one[i])) try_items(std::move(one));
  }
}

void Reducer::simplify_states() {
  const auto reset = [this](auto member) {
    const State plain;
    simplify([&](Item& item) {
      if (item.state.*member == plain.*member) return false;
      item.state.*member = plain.*member;
      return true;
    });
  };
  reset(&State::scissor);
  reset(&State::viewport);
  reset(&State::depth_range);
  reset(&State::shade);
  reset(&State::cull);
  reset(&State::front);
  reset(&State::color_write);
  reset(&State::depth_write);
  reset(&State::depth_test);
}

void Reducer::simplify_vertices() {
  const auto for_vertices = [this](auto change) {
    simplify([&](Item& item) {
      bool has_changed = false;
      if (!item.clear)
        for (Vertex& v : item.v) has_changed |= change(v, item);
      return has_changed;
    });
  };
  const auto assign = [](auto& value, const auto& to) { return std::exchange(value, to) != to; };
  for_vertices([&](Vertex& v, const Item&) { return assign(v.rgba, std::array<double, 4>{255, 255, 255, 255}); });
  for_vertices([&](Vertex& v, const Item& item) { return item.state.space == Space::window && assign(v.z, 0.5); });
  for_vertices([&](Vertex& v, const Item& item) { return assign(v.z, item.v[0].z); });
  for_vertices([&](Vertex& v, const Item&) { return (assign(v.u, 0.0) | assign(v.v, 0.0)) != 0; });
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
    } catch (const InputError&) {  // a simplification that left the guard band, say
      return {};
    }
  };
}

std::optional<Reduced> reduce(const Scene& scene, const Config& config, const LockstepOptions& lockstep,
                              const FailTest& test, const ReduceOptions& options) {
  return Reducer(scene, config, lockstep, test, options).run();
}

Scene window_scene(const Scene& scene, const Config& config) {
  const int channels = derive_widths(config).color_channels;
  const double grid = std::ldexp(1.0, std::max(1, config.subpixel_bits));
  const double largest = std::ldexp(1.0, config.depth_bits) - 1;
  HostStream host(scene, config);
  Items items;
  while (const auto sent = host.next()) {
    const PrimitivePacket& p = sent->packet;
    if (sent->command == HostPrimitive::kNoCommand) continue;  // the first clear and the flush
    Item item;
    item.state.space = Space::window;
    if (p.left > 0 || p.top > 0 || p.right + 1 < scene.width || p.bottom + 1 < scene.height)
      item.state.scissor = Rect{p.left, p.top, p.right - p.left + 1, p.bottom - p.top + 1};
    const auto color = [&](std::uint32_t rgba) {
      std::array<double, 4> c{0, 0, 0, 255};
      for (int i = 0; i < channels; ++i) c[static_cast<std::size_t>(i)] = rgba >> (8 * i) & 0xff;
      return c;
    };
    if (p.kind != static_cast<std::uint8_t>(PrimitiveKind::triangle)) {
      Clear clear;
      if (p.depth_write != 0) clear.depth = p.z[0] / largest;
      if (p.color_write != 0) clear.color = color(p.rgba[0]);
      item.clear = clear;
    } else {
      item.state.depth_test = static_cast<DepthFunc>(p.depth_test);
      item.state.depth_write = p.depth_write != 0;
      item.state.color_write = p.color_write != 0;
      item.state.cull = static_cast<Cull>(p.cull);
      item.state.front = p.front_cw != 0 ? FrontFace::cw : FrontFace::ccw;
      for (std::size_t i = 0; i < 3; ++i) {
        item.v[i].x = p.x[i] / grid;
        item.v[i].y = p.y[i] / grid;
        item.v[i].z = p.z[i] / largest;
        item.v[i].rgba = color(p.rgba[i]);
      }
    }
    items.push_back(item);
  }
  return scene_of(items, scene, scene.width, scene.height);
}

}  // namespace halfplane
