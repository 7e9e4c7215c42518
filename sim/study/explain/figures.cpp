#include "figures.hpp"

#include <algorithm>

#include "line_walk.hpp"
#include "model/engines/commands.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact_line.hpp"
#include "model/host/texture_memory.hpp"
#include "model/stages/fine_raster.hpp"
#include "model/stages/interpolate.hpp"
#include "model/stages/multisample.hpp"
#include "model/stages/texture_unit.hpp"
#include "model/study/fill_rule.hpp"
#include "model/study/plane_rules.hpp"

namespace halfplane::explain {
namespace {

PixelBounds bounds_of_rect(const Rect& rect) {
  return {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1};
}

bool holds(const PixelBounds& box, Pixel pixel) {
  return pixel.x >= box.left && pixel.x <= box.right && pixel.y >= box.top && pixel.y <= box.bottom;
}

std::string_view side_of(const SnappedVertex& from, const SnappedVertex& to) {
  const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
  if (dy == 0) return dx > 0 ? "top" : "bottom";
  return dy < 0 ? "left" : "right";
}

PlaneFigure plane_figure(const Widths& widths, std::size_t plane, int guard_bits, const PlaneSample& sample,
                         const exact::Rational& oracle) {
  return {widths.plane_name(plane),
          widths.of_plane(plane).code.bits,
          guard_bits,
          sample.unrounded,
          sample.code,
          oracle,
          {},
          {}};
}

constexpr std::uint32_t kWhole = 1U << 24;  ///< a weight of 1

/// Bits of a linear filter's weight.
int weight_bits(const StudyRules& rules) { return rules.weights == Weights::four ? 4 : kTexelFraction; }

/// Four texels of a linear filter, or one texel of a nearest filter, on one level.
void add_texels(const Sampler& sampler, const SurfaceSample& sample, bool is_linear, int level, std::uint32_t part,
                std::vector<TexelFigure>& texels) {
  const auto add = [&](int x, int y, std::uint32_t weight, bool is_border) {
    texels.push_back(
        {level, x, y, weight, {}, is_border ? sampler.border : sampler.texture->texel(level, x, y), is_border});
  };
  const auto& axes = sampler.axes;
  const TexturePlace& place = sample.place;
  if (!is_linear) {
    const TexelPair x = nearest_texel(place, axes, 0, level), y = nearest_texel(place, axes, 1, level);
    add(x.first, y.first, (kWhole >> 8) * part, x.is_first_border || y.is_first_border);
    return;
  }
  const TexelPair x = texels_around(place, axes, 0, level), y = texels_around(place, axes, 1, level);
  add(x.first, y.first, (256 - x.part) * (256 - y.part) * part, x.is_first_border || y.is_first_border);
  add(x.second, y.first, x.part * (256 - y.part) * part, x.is_second_border || y.is_first_border);
  add(x.first, y.second, (256 - x.part) * y.part * part, x.is_first_border || y.is_second_border);
  add(x.second, y.second, x.part * y.part * part, x.is_second_border || y.is_second_border);
}

SurfaceFigure surface_figure(const DrawContext& context, const Surface& surface, const SurfaceOracle& oracle,
                             Pixel pixel, const StudyRules& rules) {
  SurfaceFigure figure;
  figure.sample = surface.at(pixel.x, pixel.y, weight_bits(rules));
  figure.is_lit = surface.is_lit();
  figure.errors = oracle.errors(figure.sample, pixel.x, pixel.y);
  if (!context.state.texture) return figure;
  const Sampler& sampler = surface.sampler();
  figure.texture = sampler.texture->name;
  figure.filter = filter_of(sampler, figure.sample.lod);
  const auto& [is_linear, is_between, levels] = figure.filter;
  add_texels(sampler, figure.sample, is_linear, levels.lower, is_between ? 256 - levels.part : 256, figure.texels);
  if (is_between) add_texels(sampler, figure.sample, is_linear, levels.upper, levels.part, figure.texels);
  for (TexelFigure& texel : figure.texels)
    if (!texel.is_border)
      texel.address =
          texel_address(context.scene, context.config, *context.state.texture, texel.level, texel.x, texel.y);
  return figure;
}

/// Applies study rules, if there are any.
TriangleSetup by_rules(TriangleSetup setup, const Triangle& triangle, const StudyRules& rules, const Config& config,
                       const Widths& widths) {
  if (rules == StudyRules{} || setup.area == 0) return setup;
  const auto v = canonical(triangle.v, signed_area(triangle.v[0], triangle.v[1], triangle.v[2]));
  set_fill_rule(setup, v, rules.fill_rule, widths);
  set_planes(setup, v, rules, config, widths);
  return setup;
}

std::optional<Surface> made_surface(const DrawContext& context, const Triangle& triangle, const TriangleSetup& setup,
                                    const Widths& widths, const SampleOffset& offset) {
  if (setup.is_empty()) return std::nullopt;
  return surface_of(context, triangle, setup, widths, offset);
}

}  // namespace

std::optional<std::uint32_t> texel_address(const Scene& scene, const Config& config, std::uint32_t texture, int level,
                                           int x, int y) {
  if (!has_texture_planes(config)) return std::nullopt;
  const Texture& image = scene.textures[texture];
  LevelPlace place;
  if (level != 0) {
    const TextureAxis u{image.width()}, v{image.height()};
    if (config.texture_unit != TextureUnitKind::trilinear || !u.is_power_of_two() || !v.is_power_of_two())
      return std::nullopt;
    place = level_place(
        {floor_log2(static_cast<unsigned>(image.width())), floor_log2(static_cast<unsigned>(image.height()))}, level);
  }
  if (place.is_corner) x = y = 2;
  const TextureMemory memory(scene, config);
  const auto block_row =
      static_cast<std::uint32_t>((std::max(1, image.width() >> level) + kTextureBlock - 1) / kTextureBlock);
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  const std::uint32_t block = place.block + row / kTextureBlock * block_row + column / kTextureBlock;
  const std::uint32_t texel =
      block * kTextureBlock * kTextureBlock + row % kTextureBlock * kTextureBlock + column % kTextureBlock;
  return memory.base(texture) + (texel << texel_size_log2(stored_format(image.format)));
}

TrianglePiece::TrianglePiece(const DrawContext& context, const Widths& widths, const StudyRules& rules,
                             const Triangle& triangle, const SampleOffset& offset)
    : context_(context),
      widths_(widths),
      rules_(rules),
      triangle_(moved_to_sample(triangle, offset)),
      offset_(offset),
      setup_(by_rules(setup_at_sample(setup_triangle(triangle, context.config, widths, context.rect), offset, widths),
                      triangle_, rules, context.config, widths)),
      whole_(by_rules(setup_at_sample(setup_triangle(triangle, context.config, widths), offset, widths), triangle_,
                      rules, context.config, widths)),
      oracle_(triangle_, widths.grid_bits, rules.fill_rule),
      surface_(made_surface(context, triangle, setup_, widths, offset)) {
  const auto& v = triangle_.v;
  order_ = canonical_order(v, signed_area(v[0], v[1], v[2]));
  for (std::size_t i = 0; i < 3; ++i) corner_[i] = v[order_[i]];
  if (surface_) surface_oracle_.emplace(context.scene, context.config, triangle_, offset_);
}

/// As stepped by coarse_raster and fine_raster, from the first tile of the whole triangle.
EdgeValues TrianglePiece::edges_at(Pixel pixel) const {
  const int shift = widths_.tile_shift, last = (1 << shift) - 1;
  EdgeValues value = edges_at_tile(whole_, pixel.x >> shift, pixel.y >> shift, widths_);
  for (std::size_t i = 0; i < 3; ++i)
    value[i] += EdgeValue{pixel.y & last} * whole_.edge[i].dx - EdgeValue{pixel.x & last} * whole_.edge[i].dy;
  return value;
}

/// As in fine_raster.
bool TrianglePiece::is_covered(Pixel pixel) const {
  const int shift = widths_.tile_shift, last = (1 << shift) - 1;
  const TilePacket tile =
      make_tile_packet(to_setup_packet(setup_, widths_), pixel.x >> shift, pixel.y >> shift, 0, false, widths_);
  return halfplane::is_covered(tile, make_edge_context(setup_), {}, pixel.x & last, pixel.y & last);
}

Outcome TrianglePiece::outcome_at(Pixel pixel, const EdgeValues& edges) const {
  const bool is_inside = std::ranges::all_of(edges, [](EdgeValue e) { return e >= 0; });
  if (!holds(bounds_of_rect(context_.rect), pixel))
    return is_inside ? Outcome(Verdict::scissor)
                     : Outcome(Verdict::uncovered, Stage::cull,
                               "it does not cover the pixel, and the scissor or "
                               "viewport leaves the pixel out");
  if (setup_.is_empty()) return Outcome(Verdict::empty);
  if (!holds({setup_.left, setup_.top, setup_.right, setup_.bottom}, pixel))
    return {Verdict::uncovered, Stage::cull, "the pixel's centre lies outside its box"};
  const int shift = widths_.tile_shift;
  const EdgeValues at_tile = edges_at_tile(setup_, pixel.x >> shift, pixel.y >> shift, widths_);
  const bool has_tiles = rules_.traversal == Traversal::tiled;
  if (has_tiles && classify(setup_, at_tile, 1 << shift) == TileClass::outside) return Outcome(Verdict::tiles_outside);
  return is_covered(pixel) ? Outcome(Verdict::written) : Outcome(Verdict::uncovered);
}

Entry TrianglePiece::at(Pixel pixel) const {
  Entry entry;
  entry.kind = Kind::triangle;
  entry.primitive = triangle_.primitive;
  entry.draw = triangle_.draw;
  const auto& v = triangle_.v;
  for (SnappedVertex corner : v) {
    corner.x += offset_.x;
    corner.y += offset_.y;
    entry.corners.push_back(corner);
  }
  entry.area = signed_area(v[0], v[1], v[2]);
  entry.box = {setup_.left, setup_.top, setup_.right, setup_.bottom};
  const EdgeValues edges = edges_at(pixel);
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = corner_[i], &to = corner_[(i + 1) % 3];
    entry.edges.push_back({order_[i], order_[(i + 1) % 3], edges[i],
                           exact_edge(from, to, pixel.x, pixel.y, widths_.grid_bits, 0), widths_.edge_value.bits,
                           edge_bias(from, to, rules_.fill_rule, widths_.grid_bits) == 0, side_of(from, to)});
  }
  entry.oracle = OracleFigure{oracle_.covers(pixel.x, pixel.y),
                              exact::is_on_border(triangle_, pixel.x, pixel.y, widths_.grid_bits)};
  entry.specification = outcome_at(pixel, edges);
  if (holds(entry.box, pixel) && rules_.traversal == Traversal::tiled) {
    const int shift = widths_.tile_shift;
    entry.tile = classify(setup_, edges_at_tile(setup_, pixel.x >> shift, pixel.y >> shift, widths_), 1 << shift);
  }
  if (has_fragment(entry.specification.verdict)) add_attributes(pixel, entry);
  return entry;
}

bool TrianglePiece::covers(Pixel pixel) const { return has_fragment(outcome_at(pixel, edges_at(pixel)).verdict); }

void TrianglePiece::add_attributes(Pixel pixel, Entry& entry) const {
  const Interpolated value = interpolate_by_rules(setup_, rules_, widths_, pixel.x, pixel.y);
  const exact::PlaneWeights weights = oracle_.weights_at(pixel.x, pixel.y);
  // Colours over w are not planes of their own codes.
  const bool is_affine = context_.state.color_interp == ColorInterp::affine;
  const std::size_t planes = is_affine ? static_cast<std::size_t>(widths_.affine_planes) : 1;
  for (std::size_t p = 0; p < planes; ++p) {
    const exact::Rational oracle =
        weights.plane({triangle_.v[0].code[p], triangle_.v[1].code[p], triangle_.v[2].code[p]});
    entry.planes.push_back(
        plane_figure(widths_, p, context_.config.local_guard_bits, {value.unrounded[p], value.code[p]}, oracle));
  }
  if (surface_) entry.surface = surface_figure(context_, *surface_, *surface_oracle_, pixel, rules_);
}

PlaneSample TrianglePiece::depth_at(int x, int y) const {
  if (rules_ == StudyRules{}) return plane_at(setup_, kDepthPlane, widths_, x, y);
  const Interpolated value = interpolate_by_rules(setup_, rules_, widths_, x, y);
  return {value.unrounded[kDepthPlane], value.code[kDepthPlane]};
}

std::vector<TriangleStep> TrianglePiece::steps() const {
  std::vector<TriangleStep> steps;
  const int shift = widths_.tile_shift;
  for (int y = setup_.top; y <= setup_.bottom; ++y)
    for (int x = setup_.left; x <= setup_.right; ++x) {
      TriangleStep step{x,
                        y,
                        classify(setup_, edges_at_tile(setup_, x >> shift, y >> shift, widths_), 1 << shift),
                        edges_at({x, y}),
                        false,
                        {}};
      step.covered = is_covered({x, y});
      if (step.covered) step.depth = depth_at(x, y);
      steps.push_back(step);
    }
  return steps;
}

SampledPiece::SampledPiece(const DrawContext& context, const Widths& widths, const StudyRules& rules,
                           const Triangle& triangle)
    : centre_(context, widths, rules, triangle) {
  if (widths.pixel_samples == 1) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(widths.pixel_samples); ++k)
    samples_.push_back(std::make_unique<TrianglePiece>(context, widths, rules, triangle, widths.sample_offset[k]));
}

const TrianglePiece& SampledPiece::piece(int place) const {
  return samples_.empty() || place == kAtCentre ? centre_ : *samples_[static_cast<std::size_t>(place)];
}

/// Precondition: a sample of the pixel is covered.
int SampledPiece::shaded_at(Pixel pixel) const {
  if (centre_.covers(pixel)) return kAtCentre;
  int sample = 0;
  while (!piece(sample).covers(pixel)) ++sample;
  return sample;
}

Entry SampledPiece::at(Pixel pixel, int sample) const {
  Entry entry = piece(sample).at(pixel);
  if (samples_.empty() || !has_fragment(entry.specification.verdict)) return entry;
  entry.shaded_at = shaded_at(pixel);
  if (*entry.shaded_at == sample) return entry;
  const PlaneFigure depth = entry.planes[kDepthPlane];
  entry.planes.clear();
  piece(*entry.shaded_at).add_attributes(pixel, entry);
  entry.planes[kDepthPlane] = depth;
  return entry;
}

Entry line_entry(const DrawContext& context, const Widths& widths, const LinePrimitive& line, Pixel pixel,
                 bool wants_steps) {
  const DrawnLine& drawn = line.drawn;
  Entry entry;
  entry.kind = Kind::line;
  entry.primitive = drawn.primitive;
  entry.draw = drawn.draw;
  entry.corners = {drawn.start, drawn.end};
  const PixelBounds rect = bounds_of_rect(context.rect);
  entry.box = rect;
  const LineRule rule = context.state.line_rule;
  entry.line = line_figure(line, rule, rect, widths, pixel, wants_steps);
  const exact::Line exact{drawn.start, drawn.end, rule, drawn.drops_last, widths.grid_bits};
  entry.oracle = OracleFigure{exact::covers(exact, pixel.x, pixel.y), false};
  entry.specification = {Verdict::uncovered, Stage::line_raster, "the line takes another pixel here, or ends before"};
  if (!holds(rect, pixel)) {
    if (entry.oracle->covers) entry.specification = Outcome(Verdict::scissor);
    return entry;
  }
  tap_line(line, widths, 0, [&](const TappedFragment& fragment) {
    if (fragment.x != pixel.x || fragment.y != pixel.y || fragment.sample != 0) return;  // all samples have the same
    entry.specification = Outcome(Verdict::written);
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
      entry.planes.push_back(
          plane_figure(widths, p, fragment.guard_bits, fragment.plane[p],
                       exact::plane_at(exact, pixel.x, pixel.y, drawn.start.code[p], drawn.end.code[p])));
  });
  return entry;
}

Entry point_entry(const Widths& widths, const PointPrimitive& point, Pixel pixel) {
  const DrawnPoint& drawn = point.drawn;
  Entry entry;
  entry.kind = Kind::point;
  entry.primitive = drawn.primitive;
  entry.draw = drawn.draw;
  entry.corners = {drawn.at};
  entry.box = point.box;
  entry.point_size = drawn.size;
  entry.point_shape = drawn.shape;
  // From the definition, in halves of a subpixel: the centre lies in [X - n/2, X + n/2), and so across; or in the disc.
  const auto distance = [&](int i, std::int32_t at) {
    return (2 * std::int64_t{i} + 1) * (std::int64_t{1} << widths.grid_bits) - 2 * std::int64_t{at};
  };
  const std::int64_t dx = distance(pixel.x, drawn.at.x), dy = distance(pixel.y, drawn.at.y), n = drawn.size;
  const bool is_round = drawn.shape == PointShape::round;
  const bool in_square = dx >= -n && dx < n && dy >= -n && dy < n;
  entry.oracle = OracleFigure{in_square && (!is_round || dx * dx + dy * dy <= n * n), false};
  bool is_drawn = false;
  for_each_run(point, widths.grid_bits, [&](const PixelBounds& run) {
    if (!holds(run, pixel)) return;
    is_drawn = true;
    entry.box = run;  // as sent to the hardware
  });
  if (!is_drawn) {
    entry.specification = entry.oracle->covers ? Outcome(Verdict::scissor)
                          : is_round
                              ? Outcome(Verdict::uncovered, Stage::point_raster, "the pixel lies outside its disc")
                              : Outcome(Verdict::uncovered, Stage::point_raster, "the pixel lies outside its square");
    return entry;
  }
  entry.specification = Outcome(Verdict::written);
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
    const std::uint32_t code = drawn.at.code[p];
    entry.planes.push_back(plane_figure(widths, p, 0, {code, code}, {code, 1}));
  }
  return entry;
}

}  // namespace halfplane::explain
