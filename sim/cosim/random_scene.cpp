#include "sim/cosim/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "model/host/primitives.hpp"
#include "model/widths.hpp"
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
    set_newer();
    if (has_lines_ || has_points_ || config_.line_units == 0) set_shapes();
    set_units();
    if (config_.logic_units != 0) set_logic_ops();
    if (config_.stencil_bits != 0) set_stencils();
    if (has_texture_planes(config_)) set_textures();
    if (config_.fog_units != 0) set_fogs();
    if (has_normals(config_)) set_lights();
    if (config_.msaa_samples > 1) set_samples();
    if (config_.resolve_units != 0) drop_later_clears();
    if (has_colors_over_w(config_)) set_colors_over_w();
    keep_rules();
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
  void keep_rules();
  void settle(State& s, Topology topology) const;
  State state();
  void set_any(State& s, std::string_view name);
  void set_newer();
  void set_units();
  void set_logic_ops();
  void set_stencils();
  void set_textures();
  void set_constants();
  void set_borders();
  void set_shapes();
  void set_fogs();
  void set_lights();
  void set_samples();
  void drop_later_clears();
  void set_colors_over_w();
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

/// Gives the profile's states one of their values in each draw, and keeps states that go together with them. From
/// separate random numbers, so that states alone change nothing else.
void Generator::keep_rules() {
  Random random(seed_ ^ 0x701f11eu);
  for (const Command& command : scene_.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    State& state = scene_.states[draw != nullptr ? draw->state : std::get<Clear>(command).state];
    for (const RandomProfile::StateRule& rule : profile_.rules)
      rule.row->set(state, rule.values[random.next() % rule.values.size()]);
    if (draw != nullptr && !profile_.text.empty()) settle(state, draw->topology);
  }
}

/// Of two states that this hardware refuses together, changes the one that the profile does not have.
void Generator::settle(State& s, Topology topology) const {
  const bool is_triangle = topology == Topology::triangles;
  const bool has_only_triangles = profile_.has_kinds() && !profile_.kinds[1];
  if (is_triangle && (has_only_triangles || (config_.line_units == 0 && s.line_rule != LineRule::rectangle)) &&
      profile_.rule("polygon_mode") == nullptr)
    s.polygon_mode = PolygonMode::fill;
  if (drawn_as(s, topology) != PrimitiveType::triangle) s.color_interp = ColorInterp::affine;
  if (config_.texture_unit == TextureUnitKind::nearest || config_.texture_unit == TextureUnitKind::bilinear) {
    if (profile_.rule("texture_min") == nullptr) s.texture_min = static_cast<TextureMin>(s.texture_mag);
    s.texture_mag = static_cast<TextureMag>(s.texture_min);  // the unit knows one filter
  }
  if (!s.texture || s.texture_interp == TextureInterp::perspective) return;
  if (profile_.rule("texture_interp") == nullptr && (s.fog || s.shade == Shade::phong)) {
    s.texture_interp = TextureInterp::perspective;
    return;
  }
  if (s.color_interp == ColorInterp::perspective && profile_.rule("texture_interp") == nullptr) {
    s.texture_interp = TextureInterp::perspective;
    return;
  }
  s.fog.reset();
  if (s.shade == Shade::phong) s.shade = Shade::smooth;
  s.color_interp = ColorInterp::affine;
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

/// Sets states added to the hardware later, from separate random numbers: tests hold the scenes of a seed by hashes and
/// cycle counts, so the original stream of numbers stays.
void Generator::set_newer() {
  StateRows rows = states_but({"depth_test", "depth_write", "color_write", "cull", "front"});
  std::erase_if(rows, [](const DrawState* row) { return row->home != StateHome::primitive; });
  Random random(~seed_);
  for (State& state : scene_.states) state = random_state(state, rows, chooser(random));
}

/// Sets wide lines and round points in a third of the draws of either; rectangles in a third of the draws of lines, and
/// without a line unit as edges of triangles; few rectangles and points are smooth, since that takes a primitive per
/// pixel. From separate random numbers, as above.
void Generator::set_shapes() {
  Random random(seed_ ^ 0x51a9e5u), of_rectangles(seed_ ^ 0x2ec7a91eu);
  const int beside = config_.guard_band - std::max(scene_.width, scene_.height);
  const int widest = 2 * (beside - 1), widest_rectangle = beside - 3;
  for (const Command& command : scene_.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    State& state = scene_.states[draw->state];
    const PrimitiveType type = drawn_as(state, draw->topology);
    const unsigned one_of = type == PrimitiveType::line ? 3 : 24;
    const bool may_be_rectangle =
        type == PrimitiveType::line || (type == PrimitiveType::triangle && config_.line_units == 0);
    if (may_be_rectangle && widest_rectangle >= 1 && of_rectangles.next() % one_of == 0) {
      if (type == PrimitiveType::triangle) state.polygon_mode = PolygonMode::line;
      state.line_rule = LineRule::rectangle;
      state.smooth = of_rectangles.next() % 8 == 0;
      const auto quarters = static_cast<std::uint64_t>(4 * (widest_rectangle - 1) + 1);
      state.line_width = 1 + static_cast<double>(of_rectangles.next() % std::min<std::uint64_t>(quarters, 25)) / 4;
      continue;
    }
    if (type == PrimitiveType::triangle) continue;
    if (type == PrimitiveType::point) state.smooth = of_rectangles.next() % 8 == 0;
    if (random.next() % 3 != 0) continue;
    if (type == PrimitiveType::line)
      state.line_width = std::clamp(static_cast<int>(2 + random.next() % 6), 1, std::max(widest, 1));
    else
      state.point_shape = PointShape::round;
  }
}

/// In a third of the draws selects some of a pixel's samples; by alpha if the hardware has it. From separate random
/// numbers, as above.
void Generator::set_samples() {
  Random random(seed_ ^ 0x5a3b1e5u);
  StateRows rows = states_named({"sample_mask"});
  if (tests_alpha(config_)) rows.push_back(&draw_state("alpha_to_coverage"));
  for (State& state : scene_.states)
    if (random.next() % 3 == 0) state = random_state(state, rows, chooser(random));
}

/// Of the clears after a draw, keeps clears of colours alone.
void Generator::drop_later_clears() {
  bool is_behind = false;
  std::erase_if(scene_.commands, [&](const Command& command) {
    const auto* clear = std::get_if<Clear>(&command);
    is_behind = is_behind || clear == nullptr;
    return clear != nullptr && is_behind && (clear->depth || clear->stencil);
  });
}

/// Sets states of this hardware's units downstream of the depth test, in runs of draws with and without. From separate
/// random numbers, as above.
void Generator::set_units() {
  StateRows rows;
  const auto add = [&rows](const StateRows& more) { rows.insert(rows.end(), more.begin(), more.end()); };
  if (config_.blend_lanes != 0)  // the first ones twice: blending is as likely as not
    add(states_named({"blend", "blend", "blend_equation", "blend_color", "color_mask"}));
  if (config_.dither_units != 0) add(states_named({"dither"}));
  if (tests_alpha(config_)) add(states_named({"alpha_test"}));
  Random random(seed_ ^ 0xb1e4du);
  bool has_units = false;
  for (State& state : scene_.states) {
    if (random.next() % 4 == 0) has_units = !has_units;
    if (has_units) state = random_state(state, rows, chooser(random));
  }
}

/// Gives some states a logic operation, in the place of blending. From separate random numbers, as above.
void Generator::set_logic_ops() {
  Random random(seed_ ^ 0x106100u);
  for (State& state : scene_.states)
    if (random.next() % 4 == 0) state.logic_op = static_cast<LogicOp>(random.next() % 16);
}

/// Sets stencil tests in runs of draws, with few values so that they meet, and clears of the stencil, alone and with
/// others. From separate random numbers, as above.
void Generator::set_stencils() {
  Random random(seed_ ^ 0x57e4c11u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  const auto value = [&] { return static_cast<std::uint8_t>(below(4) == 0 ? below(256) : below(3)); };
  const auto side = [&] {
    Stencil s;
    s.func = below(2) == 0 ? DepthFunc::always : static_cast<DepthFunc>(below(8));
    s.reference = value();
    if (below(3) == 0) s.read_mask = static_cast<std::uint8_t>(below(256));
    if (below(3) == 0) s.write_mask = below(4) == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(below(256));
    const auto op = [&] { return below(3) == 0 ? StencilOp::keep : static_cast<StencilOp>(below(8)); };
    const bool marks_failed = below(2) == 0;
    s.passes = op();
    if (marks_failed) s.stencil_fails = op();
    if (marks_failed) s.depth_fails = op();
    return s;
  };
  bool has_stencil = false;
  for (State& state : scene_.states) {
    if (below(4) == 0) has_stencil = !has_stencil;
    if (!has_stencil) continue;
    state.stencil = side();
    if (below(3) == 0) state.stencil_back = side();
  }
  // Now and then a whole word is replaced, or all but a few bits of it.
  Random rare(seed_ ^ 0x4e91aceu);
  const auto one_of = [&rare](std::uint64_t n) { return rare.next() % n == 0; };
  for (State& state : scene_.states) {
    if (!state.stencil || !one_of(6)) continue;
    state.depth_test = DepthFunc::always;
    state.depth_write = true;
    for (Stencil* s : {&*state.stencil, state.stencil_back ? &*state.stencil_back : nullptr}) {
      if (s == nullptr) continue;
      s->passes = one_of(6) ? StencilOp::zero : StencilOp::replace;
      s->reference |= 1;
      if (one_of(2)) s->func = DepthFunc::always;
      s->write_mask = one_of(3) ? static_cast<std::uint8_t>(rare.next() % 256) : std::uint8_t{255};
    }
  }
  for (Command& command : scene_.commands)
    if (auto* clear = std::get_if<Clear>(&command)) {
      if (below(2) == 0) clear->stencil = value();
      if (clear->stencil && below(4) == 0) clear->depth.reset();
      if (clear->stencil && below(4) == 0) clear->color.reset();
    }
}

/// Lets some states blend by their texels. From separate random numbers, as above.
void Generator::set_constants() {
  Random random(seed_ ^ 0xc057u);
  for (State& state : scene_.states) {
    if (random.next() % 3 != 0) continue;
    state.texture_combine = TextureCombine::blend;
    for (std::uint8_t& channel : state.texture_constant)
      channel = static_cast<std::uint8_t>(random.next() % 4 == 0 ? 255 * (random.next() % 2) : random.next() % 256);
  }
}

/// Lets some states have a border. From separate random numbers, as above.
void Generator::set_borders() {
  Random random(seed_ ^ 0xb0bdu);
  for (State& state : scene_.states) {
    for (TextureWrap& wrap : state.texture_wrap)
      if (random.next() % 3 == 0) wrap = random.next() % 2 == 0 ? TextureWrap::border : TextureWrap::half_border;
    const bool is_same = random.next() % 2 == 0;  // equal to other states' textures: no token in between
    for (std::uint8_t& channel : state.texture_border)
      channel = static_cast<std::uint8_t>(is_same ? 77 : random.next() % 4 == 0 ? 255 : random.next() % 256);
  }
}

/// Makes a few small textures, with levels if the unit has them, and triangles that show them: w ratios up to 2^10,
/// coordinates from next to a texel's border to many repeats away. From separate random numbers, as above.
void Generator::set_textures() {
  Random random(seed_ ^ 0x7e87u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  const auto chance = [&random](double probability) { return random.uniform(0, 1) < probability; };
  const bool has_levels = config_.texture_unit == TextureUnitKind::trilinear;
  const std::size_t drawn = 1 + below(4);
  const auto count = static_cast<std::size_t>(profile_.textures.value_or(static_cast<int>(drawn)));
  for (std::size_t n = 0; n < count; ++n) {
    TexelImage image{1 << below(7), 1 << below(7), {}};
    if (profile_.texels)
      image.width = image.height = *profile_.texels;
    else if (has_levels && chance(0.2))
      (chance(0.5) ? image.width : image.height) <<= 4;
    image.texel.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    const bool has_few_colors = chance(0.5);
    for (Texel& texel : image.texel)
      for (std::uint8_t& channel : texel)
        channel = static_cast<std::uint8_t>(has_few_colors ? 255 * below(2) : below(256));
    const std::size_t formats = has_few_colors ? 8 : 6;  // a palette has no more
    const auto format = static_cast<TextureFormat>(below(formats));
    const Mips mips = has_levels && chance(0.8) ? Mips::box : Mips::none;
    scene_.textures.push_back(make_texture("random" + std::to_string(n), image, format, mips));
  }
  for (State& state : scene_.states) {
    if (!chance(0.75)) continue;
    state.texture = static_cast<std::uint32_t>(below(count));
    state.texture_interp = chance(0.8) ? TextureInterp::perspective : TextureInterp::affine;
    for (TextureWrap& wrap : state.texture_wrap) wrap = static_cast<TextureWrap>(below(3));
    state.texture_combine = static_cast<TextureCombine>(below(4));
    if (config_.texture_unit == TextureUnitKind::bilinear && !chance(0.3)) {
      state.texture_min = TextureMin::linear;
      state.texture_mag = TextureMag::linear;
    }
    if (!has_levels) continue;
    state.texture_min = static_cast<TextureMin>(below(6));
    state.texture_mag = static_cast<TextureMag>(below(2));
    if (chance(0.5)) state.texture_lod[0] = random.uniform(-3, 3);
    if (chance(0.2)) state.texture_lod[1] = random.uniform(0, 4);
    if (chance(0.2)) state.texture_lod[2] = random.uniform(0, 12);
  }
  if (config_.texture_constants != 0) set_constants();
  if (config_.texture_borders != 0) set_borders();
  const double reach = std::ldexp(1.0, static_cast<int>(below(8)) - 2);  // offset of the coordinates, in repeats
  for (Vertex& v : scene_.vertices) {
    v.w = chance(0.3) ? 1.0 : std::exp2(random.uniform(-5, 5));
    v.u = random.uniform(-reach, reach);
    v.v = random.uniform(-reach, reach);
    if (chance(0.3)) v.u = static_cast<double>(below(65)) / 64;
    if (chance(0.3)) v.v = static_cast<double>(below(65)) / 64;
  }
  // Levels that have nothing to do with their image.
  for (Texture& texture : scene_.textures) {
    if (texture.mips != Mips::box || !chance(0.3)) continue;
    texture.mips = Mips::levels;
    const std::size_t codes =
        texture.palette.empty() ? std::size_t{1} << texel_bits(texture.format) : texture.palette.size();
    for (std::size_t n = 1; n < texture.level.size(); ++n)
      for (std::uint32_t& code : texture.level[n].code) code = static_cast<std::uint32_t>(below(codes));
  }
}

/// Makes a few fogs, from one that begins at the eye to one with almost no width, at distances of vertices and beyond;
/// in runs of draws, since each needs a table. From separate random numbers, as above.
void Generator::set_fogs() {
  Random random(seed_ ^ 0xf06u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  std::vector<State> fogs(1 + below(3));
  for (State& state : fogs) {
    Fog fog;
    fog.kind = static_cast<FogKind>(below(3));
    const double reach = std::exp2(random.uniform(-7, 7));
    if (fog.kind == FogKind::linear) {
      fog.start = below(2) == 0 ? 0 : reach * random.uniform(0, 1.25);
      fog.end = below(8) == 0 ? 0 : reach;
    } else {
      fog.start = fog.end = below(8) == 0 ? 0 : 1 / reach;
    }
    state.fog = fog;
    for (std::uint8_t& channel : state.fog_color) channel = static_cast<std::uint8_t>(below(256));
  }
  const State* fog = nullptr;
  for (State& state : scene_.states) {
    if (below(6) == 0) fog = below(3) == 0 ? nullptr : &fogs[below(fogs.size())];
    if (fog == nullptr || (state.texture && state.texture_interp == TextureInterp::affine)) continue;
    state.fog = fog->fog;
    state.fog_color = fog->fog_color;
  }
}

/// Makes a few lights, in runs of draws, since each needs a table; and normals, some of them 0, along an axis, or
/// nearly equal. From separate random numbers, as above.
void Generator::set_lights() {
  Random random(seed_ ^ 0x11967u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  const auto vector = [&]() -> std::array<double, 3> {
    std::array<double, 3> v{};
    if (below(6) == 0)
      v[below(3)] = below(2) == 0 ? 1 : -1;
    else if (below(12) != 0)
      for (double& c : v) c = random.uniform(-1, 1);
    return v;
  };
  std::vector<State> lights(1 + below(3));
  for (State& state : lights) {
    state.light_direction = vector();
    state.light_half = below(2) == 0 ? state.light_direction : vector();
    if (below(4) == 0)  // a normal away from the light would have the highlight
      for (std::size_t c = 0; c < 3; ++c) state.light_half[c] = -state.light_direction[c];
    for (auto* color : {&state.light_ambient, &state.light_diffuse, &state.light_specular})
      for (std::uint8_t& channel : *color) channel = static_cast<std::uint8_t>(below(4) == 0 ? 255 : below(256));
    state.light_shininess = below(4) == 0 ? 1 : std::exp2(random.uniform(0, 7));
  }
  const State* light = nullptr;
  for (State& state : scene_.states) {
    if (below(4) == 0) light = below(3) == 0 ? nullptr : &lights[below(lights.size())];
    if (light == nullptr || (state.texture && state.texture_interp == TextureInterp::affine)) continue;
    state.shade = Shade::phong;
    state.light_direction = light->light_direction;
    state.light_half = light->light_half;
    state.light_ambient = light->light_ambient;
    state.light_diffuse = light->light_diffuse;
    state.light_specular = light->light_specular;
    state.light_shininess = light->light_shininess;
  }
  std::array<double, 3> axis = vector();
  for (std::size_t n = 0; n < scene_.vertices.size(); ++n) {
    if (below(9) == 0) axis = vector();
    std::array<double, 3> normal = vector();
    if (below(2) == 0)
      for (std::size_t c = 0; c < 3; ++c) normal[c] = axis[c] + normal[c] / 16;
    scene_.normals.push_back(normal);
  }
}

/// Colours over w in runs of draws, textured and not. From separate random numbers, as above.
void Generator::set_colors_over_w() {
  Random random(seed_ ^ 0xc0107u);
  bool is_over_w = false;
  for (const Command& command : scene_.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    if (random.next() % 3 == 0) is_over_w = !is_over_w;
    State& state = scene_.states[draw->state];
    if (!is_over_w || drawn_as(state, draw->topology) != PrimitiveType::triangle) continue;
    state.color_interp = ColorInterp::perspective;
    state.texture_interp = TextureInterp::perspective;  // one 1/w per triangle
  }
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
      order == DepthOrder::random ? depth()
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
