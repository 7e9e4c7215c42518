#include "fragment_judge.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "model/golden/exact_line.hpp"
#include "model/widths.hpp"

namespace halfplane {
namespace {

/// |value / 2^guard_bits - exact|, LSB.
double distance(std::int64_t value, int guard_bits, const exact::Rational& exact) {
  const int128 unit = int128{1} << guard_bits;
  const int128 difference = exact.denominator * value - exact.numerator * unit;
  return static_cast<double>(difference < 0 ? -difference : difference) / static_cast<double>(exact.denominator * unit);
}

void raise(double& worst, double value) { worst = std::max(worst, value); }

void raise(Held& worst, const Held& candidate) {
  if (!(candidate.ratio() <= worst.ratio())) worst = candidate;
}

void raise(SurfaceVerdict& worst, const SurfaceErrors& errors) {
  raise(worst.color, errors.color);
  raise(worst.light, errors.light);
  raise(worst.fog_factor, errors.fog_factor);
  raise(worst.fog, errors.fog);
  if (!errors.has_texture) return;
  raise(worst.coordinate, errors.coordinate);
  raise(worst.level, errors.level_size);
  raise(worst.filter, errors.filter);
}

std::string line(std::string_view plane, const char* what, double value, double bound) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "fragments: %.*s %s by %.3f LSB (bound %.2f)", static_cast<int>(plane.size()),
                plane.data(), what, value, bound);
  return text.data();
}

}  // namespace

FragmentJudge::FragmentJudge(const Scene& scene, const Config& config, FillRule rule)
    : scene_(scene), config_(config), widths_(derive_widths(config)), rule_(rule) {
  for (const JudgedPlane& plane : judged_planes(config)) verdict_.planes.push_back({plane});
  logs_ = coverage_logs(config);
  pixels_.resize(logs_.size());
  tiles_.resize(logs_.size());
}

void FragmentJudge::add(const TappedFragment& fragment) {
  ++verdict_.fragments;
  if (fragment.triangle != nullptr)
    add_to_triangle(fragment);
  else
    add_to_line(fragment);
}

void FragmentJudge::begin_triangle(const TappedFragment& fragment) {
  finish_triangle();
  item_ = fragment.item;
  oracles_.clear();
  surfaces_.clear();
  const std::size_t places = config_.msaa_samples == 1 ? 1 : logs_.size() + 1;
  for (std::size_t place = 0; place < places; ++place) {
    const SampleOffset offset = place == 0 ? SampleOffset{} : widths_.sample_offset[place - 1];
    const Triangle seen = exact::seen_from(*fragment.triangle, offset);
    oracles_.emplace_back(seen, widths_.grid_bits, rule_);
    if (fragment.surface) surfaces_.emplace_back(scene_, config_, seen, offset);
  }
}

std::size_t FragmentJudge::shaded_place(int x, int y) const {
  if (oracles_.size() == 1) return 0;
  const auto covered = std::ranges::find_if(oracles_, [x, y](const auto& oracle) { return oracle.covers(x, y); });
  return static_cast<std::size_t>(covered - oracles_.begin());
}

void FragmentJudge::add_to_triangle(const TappedFragment& fragment) {
  if (item_ != fragment.item) begin_triangle(fragment);
  const auto k = static_cast<std::size_t>(fragment.sample);
  const auto shaded = static_cast<std::size_t>(fragment.shaded_at + 1);
  misplaced_ += shaded != shaded_place(fragment.x, fragment.y) ? 1 : 0;
  if (fragment.surface) raise(verdict_.surfaces, surfaces_[shaded].errors(*fragment.surface, fragment.x, fragment.y));
  const int shift = widths_.tile_shift, last = (1 << shift) - 1;
  std::uint32_t& row =
      tiles_[k][{fragment.y >> shift, fragment.x >> shift}][static_cast<std::size_t>(fragment.y & last)];
  const std::uint32_t bit = 1U << (fragment.x & last);
  repeated_ += (row & bit) != 0 ? 1 : 0;
  row |= bit;
  const exact::PlaneWeights of_color = oracles_[shaded].weights_at(fragment.x, fragment.y);
  const exact::PlaneWeights of_depth =
      oracles_.size() == 1 ? of_color : oracles_[k + 1].weights_at(fragment.x, fragment.y);
  for (std::size_t i = 0; i < verdict_.planes.size(); ++i) {
    const exact::Rational exact =
        (verdict_.planes[i].plane.is_depth ? of_depth : of_color).plane(plane_codes(*fragment.triangle, i));
    const PlaneSample& sample = fragment.plane[i];
    raise(verdict_.planes[i].worst, distance(sample.code, 0, exact));
    raise(verdict_.planes[i].worst_unrounded, distance(sample.unrounded, fragment.guard_bits, exact));
  }
}

void FragmentJudge::add_to_line(const TappedFragment& fragment) {
  pixels_[static_cast<std::size_t>(fragment.sample)].add(fragment.primitive, fragment.x, fragment.y);
  const State& state = scene_.states[std::get<Draw>(scene_.commands[fragment.draw]).state];
  for (std::size_t i = 0; i < verdict_.planes.size(); ++i) {
    exact::Rational exact;
    if (fragment.point != nullptr) {
      exact = {fragment.point->at.code[i], 1};
    } else {
      const DrawnLine& drawn = *fragment.line;
      const exact::Line line{drawn.start, drawn.end, state.line_rule, drawn.drops_last, widths_.grid_bits};
      exact = exact::plane_at(line, fragment.x, fragment.y, drawn.start.code[i], drawn.end.code[i]);
    }
    raise(verdict_.planes[i].worst_of_lines, distance(fragment.plane[i].code, 0, exact));
  }
}

void FragmentJudge::finish_triangle() {
  for (std::size_t k = 0; k < tiles_.size(); ++k) {
    for (const auto& [place, mask] : tiles_[k]) logs_[k].add(*item_, place.second, place.first, mask);
    tiles_[k].clear();
  }
}

FragmentVerdict FragmentJudge::finish(const Rendering& rendering) {
  finish_triangle();
  for (CoverageLog& log : logs_) log.sort();
  verdict_.coverage = check_coverage(scene_, config_, rendering.triangles, logs_, rule_);
  verdict_.coverage.mismatches += repeated_ + misplaced_;
  for (PixelLog& pixels : pixels_) {
    pixels.sort();
    check_line_coverage(scene_, config_, rendering, pixels, verdict_.coverage);
  }
  return verdict_;
}

std::vector<std::string> broken_fragment_bounds(const FragmentVerdict& verdict, const Config& config) {
  std::vector<std::string> broken;
  if (verdict.coverage.mismatches != 0)
    broken.push_back("fragments: " + std::to_string(verdict.coverage.mismatches) +
                     " samples differ from the exact oracle (bound 0)");
  for (const PlaneVerdict& v : verdict.planes) {
    const double bound = v.plane.is_depth ? depth_error_bound(config) : 1;
    const double line_bound = v.plane.is_depth ? line_depth_error_bound(config) : 1;
    if (!(v.worst <= bound)) broken.push_back(line(v.plane.name, "is off the exact plane", v.worst, bound));
    if (!(v.worst_unrounded <= bound - 0.5))
      broken.push_back(line(v.plane.name, "before rounding is off the exact plane", v.worst_unrounded, bound - 0.5));
    if (!(v.worst_of_lines <= line_bound))
      broken.push_back(line(v.plane.name, "of lines is off the exact value", v.worst_of_lines, line_bound));
  }
  const auto hold = [&broken](const Held& held, const char* format) {
    if (held.holds()) return;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), format, held.value, held.bound);
    broken.emplace_back(text.data());
  };
  hold(verdict.surfaces.color, "fragments: a colour over w is %.3f LSB from the exact quotient (bound %.3f)");
  hold(verdict.surfaces.light, "fragments: a colour is %.3f LSB from the same one in real light (bound %.3f)");
  hold(verdict.surfaces.coordinate, "fragments: a texture coordinate is %.4f texels from the exact one (bound %.4f)");
  hold(verdict.surfaces.level, "fragments: a level of detail is %.3f from the exact one (bound %.2f)");
  hold(verdict.surfaces.filter, "fragments: a texel is %.3f LSB from the real filter at its place (bound %.2f)");
  hold(verdict.surfaces.fog_factor, "fragments: the factor of fog is %.3f LSB from the real one (bound %.3f)");
  hold(verdict.surfaces.fog, "fragments: a colour is %.3f LSB from the same one in real fog (bound %.3f)");
  return broken;
}

}  // namespace halfplane
