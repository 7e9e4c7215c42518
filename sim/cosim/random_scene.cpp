#include "sim/cosim/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "model/widths.hpp"
#include "sim/cosim/random_draw_states.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane {
namespace {

using Point = std::array<std::int64_t, 2>;  // subpixels of 2^-s pixel

class Generator {
 public:
  Generator(const Config& config, std::uint64_t seed, const RandomProfile& profile)
      : config_(config), profile_(profile), widths_(derive_widths(config)), seed_(seed), random_(seed) {
    unit_ = std::int64_t{1} << widths_.grid_bits;
    step_ = std::int64_t{1} << (widths_.grid_bits - config.subpixel_bits);  // at S = 0 a vertex has even coordinates
    scene_.name = "random-" + std::to_string(seed);
    const int limit = config.stamp_size == 1 ? 2 : 1;
    scene_.width = extent(std::min(640 / limit, config.target_width));
    scene_.height = extent(std::min(480 / limit, config.target_height));
    if (chance(0.7)) {  // so that there is room for events
      scene_.width = std::max(scene_.width, std::min(12 * config.tile_size, config.target_width));
      scene_.height = std::max(scene_.height, std::min(12 * config.tile_size, config.target_height));
    }
    if (profile.width != 0) {
      scene_.width = profile.width;
      scene_.height = profile.height;
    }
    start_chunk();
  }

  Scene make(std::size_t count) {
    for (std::size_t made = 0; made < count;) {
      if (chance(0.04)) {
        if (profile_.has_clears) clear();
        start_chunk();
      }
      const Topology topology = profile_.has_kinds()          ? one_of_kinds()
                                : has_lines_ && chance(0.25)  ? Topology::lines
                                : has_points_ && chance(0.15) ? Topology::points
                                                              : Topology::triangles;
      is_pile_ = chance(hiz_chunk_ ? 0.3 : 0.15) && !has_shapes();
      scene_.states.push_back(state());
      if (topology != Topology::triangles) line_and_point_state(scene_.states.back());
      const std::size_t run = std::min<std::size_t>(count - made, 1 + static_cast<std::size_t>(below(12)));
      const std::size_t corners = topology == Topology::triangles ? 3 : topology == Topology::lines ? 2 : 1;
      const Draw draw{
          static_cast<std::uint32_t>(scene_.states.size() - 1), 0, topology, scene_.indices.size(), corners * run, 0};
      for (std::size_t i = 0; i < run; ++i) {
        order_ = static_cast<double>(made + i) / static_cast<double>(count);
        primitive(corners, is_pile_ && i > 0);
      }
      scene_.commands.push_back(draw);
      made += run;
    }
    set_draw_states(scene_, config_, profile_, seed_, has_lines_ || has_points_ || config_.line_units == 0);
    apply_profile(scene_, config_, profile_, seed_);
    return std::move(scene_);
  }

 private:
  std::int64_t below(std::int64_t n) {
    return static_cast<std::int64_t>(random_.next() % static_cast<std::uint64_t>(std::max<std::int64_t>(1, n)));
  }
  bool chance(double probability) { return random_.uniform(0, 1) < probability; }
  /// In [1, largest], each octave equally likely; in integers, so that machines agree.
  std::int64_t sized(std::int64_t largest) {
    const int octaves = floor_log2(static_cast<uint128>(largest)) + 1;
    const std::int64_t octave = std::int64_t{1} << below(octaves);
    return std::min(largest, octave + below(octave));
  }
  int extent(int largest) { return chance(0.1) ? largest : static_cast<int>(sized(largest)); }

  void start_chunk() {
    hiz_chunk_ = chance(0.3);
    has_lines_ = config_.line_units != 0 && chance(0.7);
    has_points_ = chance(0.6);
    lines_raise_ = chance(0.3);
  }
  Topology one_of_kinds();
  /// Whether the profile says how corners lie to each other.
  [[nodiscard]] bool has_shapes() const { return profile_.extent || profile_.reuse || profile_.overlap; }
  std::array<Point, 3> profile_shape();
  State state();
  void set_any(State& s, std::string_view name);
  void clear();
  void line_and_point_state(State& s);
  void primitive(std::size_t corners, bool is_again);
  std::array<Point, 3> shape();
  std::array<Point, 3> around(Point center, std::int64_t reach);
  std::array<Point, 3> tile_half();
  Point snapped(Point p, int where) const;
  Rect scissor();
  double depth();

  const Config& config_;
  const RandomProfile& profile_;
  Widths widths_;
  std::uint64_t seed_;
  Random random_;
  Scene scene_;
  std::int64_t unit_ = 1;   // subpixels of a pixel
  std::int64_t step_ = 1;   // subpixels between two vertices
  bool hiz_chunk_ = false;  // large triangles and `less`: many tiles for HiZ to reject
  bool has_lines_ = false, has_points_ = false;
  bool lines_raise_ = false;  // lines may raise depths, which disables HiZ until the next fast clear
  bool is_pile_ = false;      // one triangle repeatedly: a stamp meets the previous stamp, a tile its last visit
  std::array<Point, 3> last_{};
  std::uint64_t last_depth_ = 0;  // code
  double order_ = 0;              // part of the scene's primitives before this one
};

/// Each kind of the profile as likely.
Topology Generator::one_of_kinds() {
  constexpr std::array kTopologies{Topology::triangles, Topology::lines, Topology::points};
  auto left = below(std::ranges::count(profile_.kinds, true));
  for (std::size_t kind = 0; kind < kTopologies.size(); ++kind)
    if (profile_.kinds[kind] && left-- == 0) return kTopologies[kind];
  return Topology::triangles;
}

/// The corners of the last primitive, its first edge and a third corner, or a box of the profile's extent with a corner
/// on either side of its longer one.
std::array<Point, 3> Generator::profile_shape() {
  constexpr int kSixteenth = 6;  // of a hundred, as without knobs
  const bool is_first = scene_.vertices.empty();
  if (!is_first && below(100) < profile_.overlap.value_or(kSixteenth)) return last_;
  const bool is_reused = !is_first && below(100) < profile_.reuse.value_or(kSixteenth);
  const std::int64_t least = profile_.extent ? profile_.extent->least * unit_ : 1;
  const std::int64_t most = profile_.extent ? profile_.extent->most * unit_ : 2 * config_.guard_band * unit_;
  const std::int64_t extent = profile_.extent ? least + sized(most - least + 1) - 1 : sized(most);
  if (is_reused) {
    Point far;
    for (std::size_t axis = 0; axis < 2; ++axis) {  // the box stays at most as large
      const auto [low, high] = std::minmax(last_[0][axis], last_[1][axis]);
      const std::int64_t room = std::max<std::int64_t>(0, most - (high - low));
      far[axis] = low - room + below(high - low + 2 * room + 1);
    }
    return {last_[1], last_[0], far};
  }
  std::array<Point, 3> p;
  for (Point& q : p) q = {below(extent + 1), below(extent + 1)};
  const auto axis = static_cast<std::size_t>(below(2));
  p[0][axis] = 0;
  p[1][axis] = extent;
  const Point corner{below(scene_.width * unit_) - extent / 2, below(scene_.height * unit_) - extent / 2};
  for (Point& q : p) q = {q[0] + corner[0], q[1] + corner[1]};
  return p;
}

State Generator::state() {
  State s;
  s.space = Space::window;
  constexpr std::array<DepthFunc, 3> kUsual{DepthFunc::less, DepthFunc::lequal, DepthFunc::equal};
  if (chance(hiz_chunk_ ? 0.9 : is_pile_ ? 0.25 : 0.5))
    s.depth_test = kUsual[static_cast<std::size_t>(below(hiz_chunk_ ? 2 : 3))];
  else
    set_any(s, "depth_test");
  s.depth_write = chance(0.85);
  s.color_write = chance(0.85);
  if (!chance(0.6)) set_any(s, "cull");
  s.front = chance(0.5) ? FrontFace::ccw : FrontFace::cw;
  s.shade = chance(0.8) ? Shade::smooth : Shade::flat;
  if (chance(0.25)) s.scissor = scissor();
  if (is_pile_ && chance(0.5)) {  // a few whole tiles
    const int tile = config_.tile_size;
    s.scissor = {static_cast<int>(below(scene_.width / tile)) * tile,
                 static_cast<int>(below(scene_.height / tile)) * tile, static_cast<int>(sized(6)) * tile,
                 static_cast<int>(sized(6)) * tile};
  }
  return s;
}

/// Sets any value of the state's row in the table.
void Generator::set_any(State& s, std::string_view name) {
  const DrawState& row = draw_state(name);
  row.set(s, random_value(row, chooser(random_)));
}

void Generator::line_and_point_state(State& s) {
  if (s.depth_test >= DepthFunc::greater) s.depth_write = s.depth_write && lines_raise_;
  s.line_rule = static_cast<LineRule>(below(3));  // rectangles are set later: the stream of numbers stays
  if (chance(0.5)) s.line_last = chance(0.5);
  s.point_size = static_cast<double>(unit_ + (chance(0.4) ? 0 : below(sized(12 * unit_)))) / static_cast<double>(unit_);
}

Rect Generator::scissor() {
  const int x = static_cast<int>(below(scene_.width + 8)) - 4, y = static_cast<int>(below(scene_.height + 8)) - 4;
  return {x, y, static_cast<int>(sized(scene_.width)), static_cast<int>(sized(scene_.height))};
}

void Generator::clear() {
  State s;
  s.space = Space::window;
  if (chance(0.6)) s.scissor = scissor();
  scene_.states.push_back(s);
  Clear clear{static_cast<std::uint32_t>(scene_.states.size() - 1), {}, {}};
  const auto planes = below(4);  // depth, colour, or (twice as often) both
  if (planes != 1) clear.depth = chance(0.5) ? 1.0 : depth();
  if (planes != 0) {
    clear.color.emplace();
    for (double& c : *clear.color) c = static_cast<double>(below(256));
  }
  scene_.commands.push_back(clear);
}

/// A window z that snaps to a random code: often the last code again, or a neighbour, or an end of the range.
double Generator::depth() {
  const std::uint64_t largest = (std::uint64_t{1} << config_.depth_bits) - 1;
  switch (below(8)) {
    case 0:
    case 1: break;
    case 2: last_depth_ = std::min(largest, last_depth_ + 1); break;
    case 3: last_depth_ = last_depth_ == 0 ? 0 : last_depth_ - 1; break;
    case 4: last_depth_ = chance(0.5) ? 0 : largest; break;
    default: last_depth_ = static_cast<std::uint64_t>(random_.uniform(0, 1) * static_cast<double>(largest + 1)); break;
  }
  return static_cast<double>(last_depth_) / static_cast<double>(largest);
}

/// Moves a point: 0 nowhere, 1 to a pixel centre, 2 to a tile's corner, 3 to a pixel's corner.
Point Generator::snapped(Point p, int where) const {
  const std::int64_t tile = unit_ * config_.tile_size;
  const auto floored = [](std::int64_t v, std::int64_t to) { return v - ((v % to) + to) % to; };
  for (std::int64_t& v : p) {
    if (where == 1) v = floored(v, unit_) + unit_ / 2;
    if (where == 2) v = floored(v + tile / 2, tile);
    if (where == 3) v = floored(v, unit_);
    v = std::clamp(floored(v, step_), static_cast<std::int64_t>(widths_.coordinate.range.lo),
                   floored(static_cast<std::int64_t>(widths_.coordinate.range.hi), step_));
  }
  return p;
}

std::array<Point, 3> Generator::around(Point center, std::int64_t reach) {
  std::array<Point, 3> p;
  for (Point& q : p) {
    q[0] = center[0] + below(2 * reach + 1) - reach;
    q[1] = center[1] + below(2 * reach + 1) - reach;
  }
  return p;
}

/// Half of a rectangle of whole tiles; twice in a row it covers them.
std::array<Point, 3> Generator::tile_half() {
  const std::int64_t tile = unit_ * config_.tile_size;
  const std::int64_t x = below(scene_.width * unit_ / tile + 1) * tile,
                     y = below(scene_.height * unit_ / tile + 1) * tile;
  const std::int64_t w = sized(8) * tile, h = sized(8) * tile;
  return {Point{x, y}, Point{x + 2 * w, y}, Point{x, y + 2 * h}};
}

std::array<Point, 3> Generator::shape() {
  const std::int64_t band = static_cast<std::int64_t>(config_.guard_band) * unit_;
  const std::int64_t screen = std::max(scene_.width, scene_.height) * unit_;
  const std::int64_t reach = hiz_chunk_ && chance(0.5) ? screen / 4 + below(screen) : sized(band);
  const Point center{below(scene_.width * unit_), below(scene_.height * unit_)};
  if (is_pile_ && hiz_chunk_ && chance(0.6))  // all of it; the second one reads bounds while the first is drawn
    return {Point{0, 0}, Point{2 * unit_ * scene_.width, 0}, Point{0, 2 * unit_ * scene_.height}};
  switch (below(16)) {
    case 0: return tile_half();
    case 1: {  // shares an edge with the previous triangle
      const Point far = around(center, reach)[0];
      return {last_[1], last_[0], far};
    }
    case 2: return last_;  // the same pixels again
    case 3: {              // the same place again, small
      return around(last_[0], sized(4 * unit_));
    }
    case 4: {  // a sliver: the third corner next to the midpoint of the others
      auto p = around(center, reach);
      p[2] = {(p[0][0] + p[1][0]) / 2 + below(3) - 1, (p[0][1] + p[1][1]) / 2 + below(3) - 1};
      return p;
    }
    case 5: {  // area 0, or almost
      auto p = around(center, reach);
      p[2] = chance(0.5) ? p[static_cast<std::size_t>(below(2))] : Point{2 * p[1][0] - p[0][0], 2 * p[1][1] - p[0][1]};
      return p;
    }
    case 6: {  // axis-parallel legs
      const auto p = around(center, reach);
      return {p[0], Point{p[1][0], p[0][1]}, Point{p[0][0], p[1][1]}};
    }
    case 7: return around({below(2 * band) - band, below(2 * band) - band}, reach);  // anywhere, mostly not visible
    case 8: return around(center, below(band) + 1);                                  // large
    default: return around(center, std::max<std::int64_t>(1, sized(band)));
  }
}

/// A line or a point uses the first corners of a triangle, close together or as far apart as the guard band.
void Generator::primitive(std::size_t corners, bool is_again) {
  std::array<Point, 3> p = is_again ? last_ : has_shapes() ? profile_shape() : shape();
  if (corners == 2 && !has_shapes() && chance(0.3)) p[1] = around(p[0], sized(24 * unit_))[0];  // visible if p[0] is
  // 1 to 3: all three to the same kind of point
  const int all = is_again        ? 0
                  : profile_.ties ? static_cast<int>(below(100) < *profile_.ties)
                  : has_shapes()  ? 0
                                  : static_cast<int>(below(8));
  for (Point& q : p) q = snapped(q, all < 4 ? all : chance(0.2) ? static_cast<int>(below(4)) : 0);
  last_ = p;
  using DepthOrder = RandomProfile::DepthOrder;
  const DepthOrder order = profile_.depth.value_or(DepthOrder::random);
  const double largest = static_cast<double>((std::uint64_t{1} << config_.depth_bits) - 1);
  const double flat_depth =
      order == DepthOrder::random || order == DepthOrder::flat ? depth()
      : order == DepthOrder::equal
          ? std::floor(largest / 2) / largest
          : std::floor(largest * (order == DepthOrder::front_to_back ? order_ : 1 - order_)) / largest;
  const bool is_flat = order != DepthOrder::random || chance(is_pile_ ? 0.7 : 0.25);
  const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
  const bool is_plain = chance(0.1);
  for (std::uint32_t i = 0; i < corners; ++i) {
    Vertex v;
    v.x = static_cast<double>(p[i][0]) / static_cast<double>(unit_);
    v.y = static_cast<double>(p[i][1]) / static_cast<double>(unit_);
    v.z = is_flat ? flat_depth : depth();
    for (double& c : v.rgba)
      c = is_plain ? 255 : chance(0.1) ? 255.0 * static_cast<double>(below(2)) : static_cast<double>(below(256));
    scene_.vertices.push_back(v);
    scene_.indices.push_back(first + i);
  }
}

}  // namespace

Scene random_scene(const Config& config, std::uint64_t seed, std::size_t count, const RandomProfile& profile) {
  return Generator(config, seed, profile).make(count);
}

Scene next_frame(const Scene& scene, std::uint64_t seed) {
  Random random(seed);
  Scene next = scene;
  const std::uint64_t change = random.next() % 6;
  const auto any = [&]() -> Vertex& { return next.vertices[random.next() % next.vertices.size()]; };
  if (change < 3 && !next.vertices.empty()) {
    Vertex &a = any(), &b = any();
    if (change == 0) std::swap(a.rgba, b.rgba);
    if (change == 1) std::swap(a.z, b.z);
    if (change == 2) std::swap(a.u, b.u);
  } else if (change == 3) {
    for (Command& command : next.commands)
      if (auto* clear = std::get_if<Clear>(&command); clear != nullptr && clear->color)
        std::swap((*clear->color)[0], (*clear->color)[1]);
  } else if (change == 4) {
    std::vector<std::size_t> draws;
    for (std::size_t i = 0; i < next.commands.size(); ++i)
      if (std::holds_alternative<Draw>(next.commands[i])) draws.push_back(i);
    if (!draws.empty())
      next.commands.erase(next.commands.begin() + static_cast<std::ptrdiff_t>(draws[random.next() % draws.size()]));
  }
  return next;
}

}  // namespace halfplane
