#include "specification.hpp"

#include <algorithm>
#include <cmath>

#include "figures.hpp"
#include "model/engines/commands.hpp"
#include "model/engines/render.hpp"
#include "model/host/smooth_raster.hpp"

namespace halfplane::explain {
namespace {

struct Point {
  double x = 0, y = 0;  ///< pixels
};

bool draws_smooth(const DrawContext& context) {
  return drawn_as(context.state, context.draw.topology) != PrimitiveType::triangle &&
         is_smooth(context.state, context.config);
}

/// Distance from the segment.
double distance_to(const Point& a, const Point& b, const Point& p) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
  const double t = length > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// The shape of a primitive on the screen before the snap: a convex polygon, a line's two ends, or a point.
struct Shape {
  std::vector<Point> corners;
  double margin = 0;  ///< width of a border that belongs to it: half a point's side, and a pixel for a line

  [[nodiscard]] bool is_near(Pixel pixel, double near) const {
    if (corners.empty()) return false;
    const Point p{pixel.x + 0.5, pixel.y + 0.5};
    const auto [left, right] = std::ranges::minmax(corners, {}, &Point::x);
    const auto [top, bottom] = std::ranges::minmax(corners, {}, &Point::y);
    const double reach = near + margin;
    if (p.x < left.x - reach || p.x > right.x + reach || p.y < top.y - reach || p.y > bottom.y + reach) return false;
    bool is_left = true, is_right = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
      if (distance_to(a, b, p) <= near + margin) return true;
      const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
      is_left = is_left && side >= 0;
      is_right = is_right && side <= 0;
    }
    return corners.size() > 2 && (is_left || is_right);
  }
};

/// Of the vertices themselves, if none lies behind the eye, and of their part in the guard band.
Shape shape_of(const DrawContext& context, const AssembledPrimitive& primitive) {
  const State& state = context.state;
  const std::size_t count = primitive.type == PrimitiveType::triangle ? 3
                            : primitive.type == PrimitiveType::line   ? 2
                                                                      : 1;
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = context.scene.vertices[primitive.index[i]];
  Shape shape;
  shape.margin = drawn_as(state, context.draw.topology) == PrimitiveType::point
                     ? state.point_size * 0.7072
                     : (strands_of(state.line_width) + 1) / 2.0;
  if (draws_smooth(context)) shape.margin += 1;  // a corner of a pixel may be covered
  const auto add = [&](const Vertex& vertex) {
    const WindowPosition p = state.space == Space::clip ? to_window(vertex, state, context.viewport)
                                                        : window_position(vertex, state, context.scene.height);
    if (std::isfinite(p.x) && std::isfinite(p.y)) shape.corners.push_back({p.x, p.y});
  };
  const bool is_in_front = state.space == Space::window ||
                           std::ranges::all_of(std::span(v).first(count), [](const Vertex& u) { return u.w > 0; });
  if (is_in_front) {
    for (std::size_t i = 0; i < count; ++i) add(v[i]);
  } else if (count == 3) {
    const ClipPolygon polygon = clip(context.guard_band, v[0], v[1], v[2]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i) add(polygon.v[i]);
  } else if (count == 2) {
    if (const auto line = clip(context.guard_band, v[0], v[1]))
      for (const Vertex& end : *line) add(end);
  }
  return shape;
}

/// A piece after the snap.
Shape shape_of(std::initializer_list<SnappedVertex> corners, double margin, int grid_bits) {
  Shape shape{{}, margin};
  for (const SnappedVertex& v : corners)
    shape.corners.push_back({std::ldexp(v.x, -grid_bits), std::ldexp(v.y, -grid_bits)});
  return shape;
}

/// The reason why the host dropped a primitive.
Outcome dropped_by_host(const Counters& before, const Counters& after) {
  const auto &a = before.skipped, &b = after.skipped;
  if (b.frustum != a.frustum) return Outcome(Verdict::frustum);
  if (b.zero_area != a.zero_area) return Outcome(Verdict::zero_area);
  if (b.backface != a.backface) return Outcome(Verdict::backface);
  if (b.empty != a.empty) return Outcome(Verdict::empty);
  return {Verdict::frustum, Stage::clip, "the clipper leaves nothing of it"};
}

class SpecificationWalk {
 public:
  SpecificationWalk(const Scene& scene, const Config& config, const std::vector<Pixel>& pixels, const Options& options,
                    std::vector<std::string>& differences, std::uint64_t& checks)
      : scene_(scene),
        config_(config),
        options_(options),
        widths_(derive_widths(config)),
        cache_(scene.vertices.size()),
        differences_(differences),
        checks_(checks) {
    const Rendering empty = make_rendering(scene, config, {});
    const SamplePattern pattern = resolved_pattern(config.msaa_pattern, config.msaa_samples);
    for (const Pixel pixel : pixels)
      for (int k = 0; k < config.msaa_samples; ++k) {
        PixelHistory& history = record_.pixels.emplace_back();
        history.at = pixel;
        history.sample = k;
        history.place = pattern.place[static_cast<std::size_t>(k)];
        const std::size_t at = empty.frame.at(pixel.x, pixel.y);
        history.model = {empty.frame.depth[at], empty.frame.color[at], -1};
      }
  }

  SpecificationRecord run() && {
    for (std::size_t i = 0; i < scene_.commands.size(); ++i) {
      const auto command = static_cast<std::uint32_t>(i);
      if (const auto* clear = std::get_if<Clear>(&scene_.commands[i])) this->clear(*clear, command);
      if (const auto* draw = std::get_if<Draw>(&scene_.commands[i])) this->draw(*draw, command);
    }
    record_.primitives = number_;
    return std::move(record_);
  }

 private:
  void clear(const Clear& command, std::uint32_t number) {
    const Rect rect = clear_rect(scene_, command);
    const DepthEncode encode(config_, scene_.planes);
    for (PixelHistory& history : record_.pixels) {
      const auto [x, y] = history.at;
      Entry entry;
      entry.kind = Kind::clear;
      entry.draw = number;
      const bool is_inside = x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height;
      entry.specification = is_inside
                                ? Outcome(Verdict::written, Stage::framebuffer, "it clears the pixel")
                                : Outcome(Verdict::scissor, Stage::framebuffer, "the scissor leaves the pixel out");
      const auto store = [&](std::string_view name, std::uint32_t& stored, std::uint32_t value, int bits) {
        entry.operations.push_back(
            {name, Stage::framebuffer, {}, {{"before", {stored}, bits}, {"after", {value}, bits}}});
        stored = value;
      };
      if (is_inside && command.depth)
        store("write_depth", history.model.depth, encode.of_window(*command.depth), encode.format().bits);
      if (is_inside && command.color)
        store("write_color", history.model.color, clear_color(*command.color, config_.color_format),
              config_.color_format == ColorFormat::rgb565 ? 16 : 32);
      if (is_inside && command.stencil) {
        entry.operations.push_back({"write_stencil",
                                    Stage::framebuffer,
                                    {},
                                    {{"before", {history.model.stencil}, 8}, {"after", {*command.stencil}, 8}}});
        history.model.stencil = *command.stencil;
      }
      if (is_inside) history.model.owner = -1;
      entry.outcome = entry.specification;
      history.history.push_back(std::move(entry));
    }
  }

  void draw(const Draw& draw, std::uint32_t command) {
    const State& state = scene_.states[draw.state];
    if (draw.outside != 0) {  // the whole object lies outside the view: it is only numbered
      number_ += static_cast<std::uint32_t>(primitive_count(scene_, draw));
      return;
    }
    const DrawContext context(scene_, config_, draw, command);
    for_each_primitive(scene_, draw, state.provoking, [&](const AssembledPrimitive& primitive) {
      const Shape shape = shape_of(context, primitive);
      std::vector<std::size_t> near;
      for (std::size_t i = 0; i < record_.pixels.size(); ++i)
        if (shape.is_near(record_.pixels[i].at, options_.near)) near.push_back(i);
      if (near.empty())
        ++number_;
      else
        tell(context, primitive, number_++, near);
    });
  }

  /// A primitive that passes near some of the pixels.
  void tell(const DrawContext& context, const AssembledPrimitive& primitive, std::uint32_t number,
            const std::vector<std::size_t>& near) {
    record_.near.insert(number);
    Counters counters;
    const Counters before = counters;
    pieces_.clear();
    outline_ = {};
    const bool is_filled = drawn_as(context.state, context.draw.topology) == PrimitiveType::triangle;
    if (is_filled)
      geometry(context, cache_, primitive.index, number, Skip{}, counters, pieces_);
    else
      geometry(context, widths_, cache_, primitive, number, counters, outline_);
    pieces_.insert(pieces_.end(), outline_.triangles.begin(), outline_.triangles.end());
    if (pieces_.empty() && outline_.lines.empty() && outline_.points.empty()) {
      const Outcome outcome = dropped_by_host(before, counters);
      for (const std::size_t i : near) add_dropped(context, primitive, number, outcome, i);
      return;
    }
    const bool is_cut = counters.clipped != 0;
    const int s = widths_.grid_bits;
    std::uint32_t piece = 0;
    std::vector<std::size_t> untold = near;  // pixels that no piece has come near yet
    const auto tell = [&](std::size_t i, auto&& entry_at) {
      add(context, entry_at(record_.pixels[i].at, record_.pixels[i].sample), piece, is_cut, i);
      std::erase(untold, i);
    };
    const auto for_each_near = [&](const Shape& shape, auto&& entry_at) {
      for (const std::size_t i : near)
        if (shape.is_near(record_.pixels[i].at, options_.near)) tell(i, entry_at);
      ++piece;
    };
    for (const Triangle& triangle : pieces_) {
      const SampledPiece at_pixels(context, widths_, options_.rules, triangle);
      for_each_near(shape_of({triangle.v[0], triangle.v[1], triangle.v[2]}, 0, s), [&](Pixel pixel, int sample) {
        Entry entry = at_pixels.at(pixel, sample);
        if (options_.wants_steps) entry.steps = at_pixels.steps(sample);
        return entry;
      });
    }
    const auto entry_of_line = [&](const LinePrimitive& line) {
      return [&](Pixel pixel, int) { return line_entry(context, widths_, line, pixel, options_.wants_steps); };
    };
    for (const LinePrimitive& line : outline_.lines)
      for_each_near(shape_of({line.drawn.start, line.drawn.end}, 1, s), entry_of_line(line));
    // The golden's strands may lie on the other sides of a wide line near a diagonal: reported with the first one.
    if (strands_of(context.state.line_width) > 1 && !outline_.lines.empty()) {
      piece = 0;
      for (const std::size_t i : std::vector(untold)) tell(i, entry_of_line(outline_.lines.front()));
    }
    if (draws_smooth(context)) {  // each point is a pixel: only its own
      for (const PointPrimitive& point : outline_.points) {
        for (const std::size_t i : near)
          if (record_.pixels[i].at == Pixel{point.box.left, point.box.top})
            tell(i, [&](Pixel pixel, int) { return point_entry(widths_, point, pixel); });
        ++piece;
      }
      for (const std::size_t i : untold)
        add_dropped(context, primitive, number,
                    {Verdict::uncovered, Stage::point_raster, "it covers next to nothing of the pixel"}, i);
      return;
    }
    for (const PointPrimitive& point : outline_.points)
      for_each_near(shape_of({point.drawn.at}, std::ldexp(point.drawn.size, -s), s),
                    [&](Pixel pixel, int) { return point_entry(widths_, point, pixel); });
  }

  /// For a whole primitive that was never drawn.
  void add_dropped(const DrawContext& context, const AssembledPrimitive& primitive, std::uint32_t number,
                   const Outcome& outcome, std::size_t pixel) {
    Entry entry;
    entry.kind = primitive.type == PrimitiveType::triangle ? Kind::triangle
                 : primitive.type == PrimitiveType::line   ? Kind::line
                                                           : Kind::point;
    entry.primitive = number;
    entry.draw = context.command;
    const std::size_t count = entry.kind == Kind::triangle ? 3 : entry.kind == Kind::line ? 2 : 1;
    bool is_snapped = true;
    for (std::size_t i = 0; i < count; ++i) {
      const VertexCache::Entry& vertex = cache_.get(context, primitive.index[i]);
      is_snapped = is_snapped && vertex.outside_guard_band == 0;
      entry.corners.push_back(vertex.snapped);
    }
    if (!is_snapped) entry.corners.clear();
    if (entry.corners.size() == 3) entry.area = signed_area(entry.corners[0], entry.corners[1], entry.corners[2]);
    entry.specification = entry.outcome = outcome;
    record_.pixels[pixel].history.push_back(std::move(entry));
  }

  /// Runs the operations, and compares their result with the specification of all of them together.
  void add(const DrawContext& context, Entry entry, std::uint32_t piece, bool is_cut, std::size_t pixel) {
    PixelHistory& history = record_.pixels[pixel];
    entry.piece = piece;
    entry.is_cut = is_cut;
    const auto sample = static_cast<std::uint32_t>(history.sample);
    if (has_fragment(entry.specification.verdict) && (drawn_samples(context.state) >> sample & 1U) == 0) {
      entry.specification = {Verdict::uncovered, Stage::fine_raster,
                             "it covers the sample, but the sample mask leaves it out"};
      entry.is_left_out = true;
      entry.shaded_at.reset();
      entry.planes.clear();
      entry.surface.reset();
    }
    if (has_fragment(entry.specification.verdict)) {
      const auto color = color_of(entry);
      std::uint32_t depth_after = history.model.depth, color_after = history.model.color;
      std::uint8_t stencil_after = history.model.stencil;
      const std::uint32_t plane = entry.planes[kDepthPlane].code;
      const auto finished = [&] {
        if (!entry.surface) return color;
        const Texel& c = entry.surface->sample.color;
        return std::array<std::uint32_t, 4>{c[0], c[1], c[2], c[3]};
      };
      const bool is_back =
          entry.kind == Kind::triangle && !context.state_of_rectangles && shows_back(entry.area, context.state.front);
      const Fate fate = apply_fragment(context.fragment_ops, config_.color_format,
                                       {context.depth_encode(plane), history.at.x, history.at.y, is_back, sample},
                                       finished, {depth_after, color_after, stencil_after});
      FragmentAtWork fragment{
          context, entry.surface ? &*entry.surface : nullptr, plane, color, 0, 0, history.model, history.at, is_back};
      fragment.primitive = *entry.primitive;
      fragment.sample = sample;
      entry.specification = run_operations(fragment, entry.operations);
      const Verdict verdict = entry.specification.verdict;
      const Fate told = verdict == Verdict::written || verdict == Verdict::masked ? Fate::passed
                        : verdict == Verdict::alpha                               ? Fate::killed
                                                                                  : Fate::failed;
      ++checks_;
      if (fate != told || stencil_after != history.model.stencil || depth_after != history.model.depth ||
          color_after != history.model.color)
        differences_.push_back("pixel " + std::to_string(history.at.x) + "," + std::to_string(history.at.y) +
                               " primitive " + std::to_string(*entry.primitive) +
                               ": the table of operations leaves something else than apply_fragment");
    }
    entry.outcome = entry.specification;
    history.history.push_back(std::move(entry));
  }

  /// The primitive's own colour. Alpha is 255 if no plane holds it and it is not read.
  [[nodiscard]] std::array<std::uint32_t, 4> color_of(const Entry& entry) const {
    std::array<std::uint32_t, 4> color{0, 0, 0, 255};
    if (entry.surface)
      for (std::size_t c = 0; c < 4; ++c) color[c] = entry.surface->sample.primitive[c];
    else
      for (std::size_t c = 0;
           c < static_cast<std::size_t>(widths_.color_planes) && kColorPlane + c < entry.planes.size(); ++c)
        color[c] = entry.planes[kColorPlane + c].code;
    return color;
  }

  const Scene& scene_;
  const Config& config_;
  const Options& options_;
  const Widths widths_;
  VertexCache cache_;
  std::vector<std::string>& differences_;
  std::uint64_t& checks_;
  SpecificationRecord record_;
  std::vector<Triangle> pieces_;  ///< scratch
  Outline outline_;               ///< scratch
  std::uint32_t number_ = 0;      ///< of the next input primitive
};

}  // namespace

SpecificationRecord record_specification(const Scene& scene, const Config& config, const std::vector<Pixel>& pixels,
                                         const Options& options, std::vector<std::string>& differences,
                                         std::uint64_t& checks) {
  return SpecificationWalk(scene, config, pixels, options, differences, checks).run();
}

}  // namespace halfplane::explain
