#include "sim/study/compare/coverage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "model/golden/exact.hpp"
#include "model/golden/exact_line.hpp"
#include "model/golden/line.hpp"
#include "model/golden/viewport.hpp"
#include "model/host/primitives.hpp"
#include "model/widths.hpp"

namespace halfplane {

namespace {

std::uint64_t difference(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

/// The pixels whose centres lie in the closed bounding box of the snapped vertices.
golden::PixelRange range_of(const Triangle& t, int grid_bits) {
  const auto [x_min, x_max] = std::minmax({t.v[0].x, t.v[1].x, t.v[2].x});
  const auto [y_min, y_max] = std::minmax({t.v[0].y, t.v[1].y, t.v[2].y});
  const std::int64_t half = std::int64_t{1} << (grid_bits - 1);
  const auto first = [&](std::int64_t low) { return static_cast<int>((low + half - 1) >> grid_bits); };
  const auto end = [&](std::int64_t high) { return static_cast<int>((high + half) >> grid_bits); };
  return {first(x_min), first(y_min), end(x_max), end(y_max)};
}

/// Compares triangle by triangle; an object holds the result and the inputs.
class OracleCheck {
 public:
  OracleCheck(const Config& config, const CoverageLog& log, FillRule rule)
      : log_(log), tile_size_(config.tile_size), grid_bits_(derive_widths(config).grid_bits), rule_(rule) {}

  /// `visit` runs over the log's visits; the visits of triangle `index` are consumed.
  void triangle(const Triangle& t, std::uint32_t index, const golden::PixelRange& region,
                std::vector<CoverageLog::Visit>::const_iterator& visit) {
    const golden::PixelRange range = intersect(region, range_of(t, grid_bits_));
    const exact::TriangleOracle oracle(t, grid_bits_, rule_);
    const auto end = log_.visits().end();
    const auto skip_to = [&](int tile_x, int tile_y) {
      // Visits before the tile were drawn outside the range, or a second time.
      while (visit != end && visit->triangle == index &&
             std::tie(visit->tile_y, visit->tile_x) < std::tie(tile_y, tile_x)) {
        report(t, index, visit->tile_x * tile_size_, visit->tile_y * tile_size_, false, log_.sample_count(*visit));
        ++visit;
      }
    };
    if (!range.empty()) {
      for (int ty = range.begin_y / tile_size_; ty <= (range.end_y - 1) / tile_size_; ++ty) {
        for (int tx = range.begin_x / tile_size_; tx <= (range.end_x - 1) / tile_size_; ++tx) {
          skip_to(tx, ty);
          const bool visited = visit != end && visit->triangle == index && visit->tile_x == tx && visit->tile_y == ty;
          tile(t, oracle, index, tx, ty, range, visited ? &*visit : nullptr);
          if (visited) ++visit;
        }
      }
    }
    while (visit != end && visit->triangle == index) skip_to(visit->tile_x + 1, visit->tile_y);
  }

  [[nodiscard]] const OracleResult& result() const { return result_; }

 private:
  void report(const Triangle& t, std::uint32_t index, int x, int y, bool oracle_covers, std::uint64_t count) {
    if (count > 0 && !result_.first) result_.first = CoverageMismatch{index, t.primitive, x, y, oracle_covers};
    result_.mismatches += count;
  }

  void tile(const Triangle& t, const exact::TriangleOracle& oracle, std::uint32_t index, int tx, int ty,
            const golden::PixelRange& range, const CoverageLog::Visit* visit) {
    const int x0 = tx * tile_size_, y0 = ty * tile_size_;
    std::uint64_t drawn_inside = 0;
    for (int y = std::max(range.begin_y, y0); y < std::min(range.end_y, y0 + tile_size_); ++y) {
      for (int x = std::max(range.begin_x, x0); x < std::min(range.end_x, x0 + tile_size_); ++x) {
        const bool drawn = visit != nullptr && log_.test(*visit, x - x0, y - y0);
        const bool expected = oracle.covers(x, y);
        drawn_inside += drawn ? 1 : 0;
        ++result_.samples;
        if (drawn != expected) report(t, index, x, y, expected, 1);
      }
    }
    if (visit != nullptr) report(t, index, x0, y0, false, log_.sample_count(*visit) - drawn_inside);
  }

  const CoverageLog& log_;
  int tile_size_, grid_bits_;
  FillRule rule_;
  OracleResult result_;
};

/// Marks in `near` the pixels of `wanted` whose centre is within reach, pixels, of the border of an outline.
class EdgeMarker {
 public:
  EdgeMarker(int width, int height, const std::vector<bool>& wanted)
      : near(wanted.size()), width_(width), height_(height), wanted_(wanted) {}

  void mark(const golden::Outline& triangle, double reach) {
    reach_ = reach;
    const auto &x = triangle.x, &y = triangle.y;
    for (std::size_t i = 0; i < 3; ++i) mark(x[i], y[i], x[(i + 1) % 3], y[(i + 1) % 3]);
  }

  std::vector<bool> near;

 private:
  void mark(double ax, double ay, double bx, double by) {
    if (by < ay) {
      std::swap(ax, bx);
      std::swap(ay, by);
    }
    const int top = golden::first_centre(ay - reach_, height_);
    const int bottom = golden::first_centre(by + 2 * reach_, height_);
    for (int y = top; y < bottom; ++y) {
      // The part of the segment within reach of this row, as a range of x.
      const double cy = y + 0.5, dy = by - ay;
      const double from = dy > 0 ? std::clamp((cy - reach_ - ay) / dy, 0.0, 1.0) : 0;
      const double to = dy > 0 ? std::clamp((cy + reach_ - ay) / dy, 0.0, 1.0) : 1;
      const auto [left, right] = std::minmax({ax + from * (bx - ax), ax + to * (bx - ax)});
      const int end = golden::first_centre(right + 2 * reach_, width_);
      for (int x = golden::first_centre(left - reach_, width_); x < end; ++x) {
        const std::size_t p =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        if (wanted_[p] && distance(x + 0.5 - ax, cy - ay, bx - ax, dy) <= reach_) near[p] = true;
      }
    }
  }

  /// Distance from the point p to the segment 0 - d.
  static double distance(double px, double py, double dx, double dy) {
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
    return std::hypot(px - t * dx, py - t * dy);
  }

  int width_, height_;
  double reach_ = 0;
  const std::vector<bool>& wanted_;
};

/// Bound of a corner's displacement by the snap, for a rectangle with the outline as one half: the end by the half
/// diagonal of a step, the offset across by as much, and its rotation with the ends.
double reach_of_rectangle(const golden::Outline& half, double width, double step) {
  const double length = std::hypot(half.x[2] - half.x[1], half.y[2] - half.y[1]);
  return std::min(std::numbers::sqrt2 * step * (1 + width / length), width + 2 * step);
}

}  // namespace

void CoverageLog::add(std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask) {
  visits_.push_back({triangle, tile_x, tile_y, words_.size()});
  words_.resize(words_.size() + words_per_tile_);
  for (int row = 0; row < tile_size_; ++row) {
    // A tile's side is a power of two up to 32, so a row never straddles two words.
    const auto bit = static_cast<std::size_t>(row * tile_size_);
    words_[visits_.back().first_word + bit / 64] |= std::uint64_t{mask[static_cast<std::size_t>(row)]} << bit % 64;
  }
}

void CoverageLog::sort() {
  std::sort(visits_.begin(), visits_.end(), [](const Visit& a, const Visit& b) {
    return std::tie(a.triangle, a.tile_y, a.tile_x) < std::tie(b.triangle, b.tile_y, b.tile_x);
  });
}

bool CoverageLog::test(const Visit& visit, int column, int row) const {
  const auto bit = static_cast<std::size_t>(row * tile_size_ + column);
  return (words_[visit.first_word + bit / 64] >> bit % 64 & 1) != 0;
}

std::uint64_t CoverageLog::sample_count(const Visit& visit) const {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < words_per_tile_; ++i)
    count += static_cast<std::uint64_t>(std::popcount(words_[visit.first_word + i]));
  return count;
}

namespace {

OracleResult check_sample(const Scene& scene, const Config& config, std::span<const Triangle> triangles,
                          const SampleOffset& offset, const CoverageLog& log, FillRule rule) {
  OracleCheck check(config, log, rule);
  auto visit = log.visits().begin();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const State& state = scene.states[std::get<Draw>(scene.commands[triangles[i].draw]).state];
    check.triangle(exact::seen_from(triangles[i], offset), static_cast<std::uint32_t>(i),
                   golden::draw_region(scene, state), visit);
  }
  OracleResult result = check.result();
  for (; visit != log.visits().end(); ++visit) result.mismatches += log.sample_count(*visit);  // samples of no triangle
  return result;
}

}  // namespace

OracleResult check_coverage(const Scene& scene, const Config& config, std::span<const Triangle> triangles,
                            std::span<const CoverageLog> logs, FillRule rule) {
  const Widths widths = derive_widths(config);
  OracleResult result;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const OracleResult of = check_sample(scene, config, triangles, widths.sample_offset[k], logs[k], rule);
    result.samples += of.samples;
    result.mismatches += of.mismatches;
    if (result.first || !of.first) continue;
    result.first = of.first;
    result.first->sample = static_cast<int>(k);
  }
  return result;
}

std::vector<CoverageLog> coverage_logs(const Config& config) {
  return std::vector<CoverageLog>(static_cast<std::size_t>(config.msaa_samples), CoverageLog(config.tile_size));
}

PixelCoverage compare_counts(const Scene& scene, std::span<const std::uint32_t> model, const golden::Image& golden,
                             int subpixel_bits) {
  PixelCoverage result;
  std::vector<bool> differs(model.size());
  for (std::size_t p = 0; p < model.size(); ++p) {
    const std::uint32_t k = golden.count[p], m = model[p];
    differs[p] = k != m;
    (k > m ? result.missing : result.extra) += difference(k, m);
  }
  if (result.missing + result.extra == 0) return result;
  // A sample lies up to half a pixel's diagonal from its centre; distances refer to the centre.
  const double to_sample = golden.samples.empty() ? 0 : std::sqrt(0.5);
  const double step = std::ldexp(1.0, -subpixel_bits);
  EdgeMarker marker(golden.width, golden.height, differs);
  for (const golden::Outline& o : golden.outlines) {
    const Draw& draw = std::get<Draw>(scene.commands[o.draw]);
    const State& state = scene.states[draw.state];
    if (o.corners < 3)
      mark_uncertain(o, state, subpixel_bits, golden, differs, marker.near);
    else if (drawn_as(state, draw.topology) == PrimitiveType::line)  // half of one; smooth, it covers pixels partially
      marker.mark(o, reach_of_rectangle(o, state.line_width, step) + (state.smooth ? std::sqrt(0.5) : to_sample));
    else
      marker.mark(o, step + to_sample);
  }
  for (std::size_t p = 0; p < model.size(); ++p)
    if (marker.near[p]) result.near_edge += difference(golden.count[p], model[p]);
  return result;
}

namespace {

using Pixel = PixelLog::Pixel;
using GoldenLine = golden::Line<double>;

/// The draw's state.
const State& state_of(const Scene& scene, std::uint32_t command) {
  return scene.states[std::get<Draw>(scene.commands[command]).state];
}

/// Every disagreement of two sorted lists counts, also a pixel that is drawn twice.
void compare_pixels(std::span<const Pixel> drawn, std::span<const Pixel> expected, OracleResult& result) {
  const auto report = [&result](const Pixel& pixel, bool oracle_covers) {
    ++result.mismatches;
    if (!result.first) result.first = CoverageMismatch{0, pixel.primitive, pixel.x, pixel.y, oracle_covers};
  };
  auto d = drawn.begin();
  auto e = expected.begin();
  while (d != drawn.end() || e != expected.end()) {
    if (e == expected.end() || (d != drawn.end() && *d < *e))
      report(*d++, false);
    else if (d == drawn.end() || *e < *d)
      report(*e++, true);
    else
      ++d, ++e;
  }
}

double distance_to_segment(double px, double py, const GoldenLine& line) {
  const double dx = line.end.x - line.start.x, dy = line.end.y - line.start.y, length2 = dx * dx + dy * dy;
  px -= line.start.x;
  py -= line.start.y;
  const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
  return std::hypot(px - t * dx, py - t * dy);
}

/// Distance from a point to the border of the diamond around (cx, cy).
double distance_to_diamond(double px, double py, double cx, double cy) {
  // By symmetry the side from (1/2, 0) to (0, 1/2).
  GoldenLine side;
  side.start.x = side.end.y = 0.5;
  return distance_to_segment(std::abs(px - cx), std::abs(py - cy), side);
}

/// Coverage changes where the segment passes a corner of the diamond, or where an end crosses its border.
bool diamond_is_uncertain(const GoldenLine& line, int x, int y, double reach) {
  const double cx = x + 0.5, cy = y + 0.5;
  for (const auto& end : {line.start, line.end})
    if (distance_to_diamond(end.x, end.y, cx, cy) <= reach) return true;
  for (const auto& [u, v] : {std::array{0.5, 0.0}, std::array{-0.5, 0.0}, std::array{0.0, 0.5}, std::array{0.0, -0.5}})
    if (distance_to_segment(cx + u, cy + v, line) <= reach) return true;
  return false;
}

/// Coverage changes where an end moves to another pixel: whether pixels within reach of the ends give different
/// results.
bool rounded_is_uncertain(const GoldenLine& line, int x, int y, double reach) {
  const auto low = [reach](double v) { return std::floor(v - reach); };
  const auto high = [reach](double v) { return std::floor(v + reach); };
  const auto &a = line.start, &b = line.end;
  const bool now = covers(line, x, y);
  for (double x0 = low(a.x); x0 <= high(a.x); ++x0)
    for (double y0 = low(a.y); y0 <= high(a.y); ++y0)
      for (double x1 = low(b.x); x1 <= high(b.x); ++x1)
        for (double y1 = low(b.y); y1 <= high(b.y); ++y1)
          if (golden::connects(x0, y0, x1, y1, line.drops_last, x, y) != now) return true;
  return false;
}

/// Coverage changes where a border of the point passes the centre.
bool point_is_uncertain(double dx, double dy, const State& state, double reach) {
  const double distance =
      state.point_shape == PointShape::round ? std::hypot(dx, dy) : std::max(std::abs(dx), std::abs(dy));
  return std::abs(distance - state.point_size / 2) <= reach;
}

/// Whether a line within reach of this one may have the other major axis, and thus its strands on the other sides.
bool may_turn(const GoldenLine& line, double reach) {
  const double run = std::abs(line.end.x - line.start.x), rise = std::abs(line.end.y - line.start.y);
  // Each coordinate moves by that much, and by a pixel more if it is rounded.
  return std::abs(run - rise) <= 4 * (line.rule == LineRule::diamond ? reach : reach + 1);
}

/// The pixels of `region` that a line covers by definition. `tested` counts the tested pixels.
std::vector<Pixel> oracle_pixels(const DrawnLine& drawn, LineRule rule, const golden::PixelRange& region, int grid_bits,
                                 std::uint64_t& tested) {
  const exact::Line line{drawn.start, drawn.end, rule, drawn.drops_last, grid_bits};
  const auto real = [grid_bits](const SnappedVertex& v) {
    golden::ScreenVertex<double> at;
    at.x = std::ldexp(v.x, -grid_bits);
    at.y = std::ldexp(v.y, -grid_bits);
    return at;
  };
  std::vector<Pixel> pixels;
  // The walk only selects candidates: two pixels more to each side than a line can reach.
  golden::for_each_candidate(GoldenLine{real(drawn.start), real(drawn.end), rule, true}, region, 3, [&](int x, int y) {
    ++tested;
    if (exact::covers(line, x, y)) pixels.push_back({drawn.primitive, y, x});
  });
  return pixels;
}

/// Likewise for a point.
std::vector<Pixel> oracle_pixels(const DrawnPoint& point, const golden::PixelRange& region, int grid_bits,
                                 std::uint64_t& tested) {
  // In halves of a subpixel, so that the border of an odd size is an integer.
  const std::int64_t pixel = std::int64_t{2} << grid_bits, size = point.size;
  const std::int64_t x = std::int64_t{2} * point.at.x, y = std::int64_t{2} * point.at.y;
  const auto holds = [&](std::int64_t centre, std::int64_t at) { return at - size <= centre && centre < at + size; };
  const auto around = [&](std::int64_t border, int low, int high) {  // the pixel that contains it, inside the region
    return static_cast<int>(std::clamp<std::int64_t>(border >> (grid_bits + 1), low, high));
  };
  // Twice the distance from the centre, squared: below 2^63 as long as sizes are below 2^30.
  const auto disc_holds = [&](std::int64_t i, std::int64_t j) {
    const std::int64_t dx = i * pixel + pixel / 2 - x, dy = j * pixel + pixel / 2 - y;
    return point.shape == PointShape::square || dx * dx + dy * dy <= size * size;
  };
  std::vector<Pixel> pixels;
  for (int j = around(y - size - pixel, region.begin_y, region.end_y);
       j < around(y + size + 2 * pixel, region.begin_y, region.end_y); ++j)
    for (int i = around(x - size - pixel, region.begin_x, region.end_x);
         i < around(x + size + 2 * pixel, region.begin_x, region.end_x); ++i) {
      ++tested;
      if (holds(i * pixel + pixel / 2, x) && holds(j * pixel + pixel / 2, y) && disc_holds(i, j))
        pixels.push_back({point.primitive, j, i});
    }
  return pixels;
}

}  // namespace

void PixelLog::sort() { std::sort(pixels_.begin(), pixels_.end()); }

void check_line_coverage(const Scene& scene, const Config& config, const Rendering& rendering, const PixelLog& log,
                         OracleResult& result) {
  const int grid_bits = derive_widths(config).grid_bits;
  std::vector<Pixel> expected;
  const auto append = [&expected](const std::vector<Pixel>& pixels) {
    expected.insert(expected.end(), pixels.begin(), pixels.end());
  };
  for (const DrawnLine& line : rendering.lines) {
    const State& state = state_of(scene, line.draw);
    append(oracle_pixels(line, state.line_rule, golden::draw_region(scene, state), grid_bits, result.samples));
  }
  for (const DrawnPoint& point : rendering.points)
    append(oracle_pixels(point, golden::draw_region(scene, state_of(scene, point.draw)), grid_bits, result.samples));
  std::sort(expected.begin(), expected.end());
  compare_pixels(log.pixels(), expected, result);
}

void mark_uncertain(const golden::Outline& outline, const State& state, int subpixel_bits, const golden::Image& image,
                    const std::vector<bool>& wanted, std::vector<bool>& near) {
  // A smooth primitive covers pixels partially, up to half a diagonal from their centres.
  const double reach = std::ldexp(1.0, -subpixel_bits) + (state.smooth && image.samples.empty() ? std::sqrt(0.5) : 0);
  const golden::PixelRange target{0, 0, image.width, image.height};
  const auto index = [&image](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  };
  if (outline.corners == 1) {
    const double half = state.point_size / 2, far = half + reach + 1;
    const auto pixel = [](double v, int limit) {
      return static_cast<int>(std::clamp<double>(std::floor(v), 0, limit));
    };
    for (int y = pixel(outline.y[0] - far, image.height); y < pixel(outline.y[0] + far + 1, image.height); ++y)
      for (int x = pixel(outline.x[0] - far, image.width); x < pixel(outline.x[0] + far + 1, image.width); ++x)
        if (wanted[index(x, y)] && point_is_uncertain(x + 0.5 - outline.x[0], y + 0.5 - outline.y[0], state, reach))
          near[index(x, y)] = true;
    return;
  }
  GoldenLine line;
  line.rule = state.line_rule;
  line.drops_last = golden::drops_last_pixel(state);
  line.start.x = outline.x[0];
  line.start.y = outline.y[0];
  line.end.x = outline.x[1];
  line.end.y = outline.y[1];
  // 3: an end moves by at most a pixel, and may move the line out of its column's three candidates by as much.
  const auto mark = [&](const GoldenLine& strand, auto&& is_uncertain) {
    golden::for_each_candidate(strand, target, 3, [&](int x, int y) {
      if (wanted[index(x, y)] && !near[index(x, y)] && is_uncertain(x, y)) near[index(x, y)] = true;
    });
  };
  const int count = golden::strands_of(state.line_width);
  for (int i = 0; i < count; ++i) {
    const GoldenLine strand = golden::strand(line, i, count);
    mark(strand, [&](int x, int y) {
      return strand.rule == LineRule::diamond ? diamond_is_uncertain(strand, x, y, reach)
                                              : rounded_is_uncertain(strand, x, y, reach);
    });
    if (count > 1 && may_turn(line, reach))
      for (const auto axis : {&golden::ScreenVertex<double>::x, &golden::ScreenVertex<double>::y})
        mark(golden::strand_along(line, axis, i, count), [](int, int) { return true; });
  }
}

}  // namespace halfplane
