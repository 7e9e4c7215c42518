// The bounds of docs/spec.md for a comparison, and the bounds that study rules give up.
#include <array>
#include <cmath>
#include <cstdio>

#include "compare.hpp"
#include "model/widths.hpp"
#include "sim/study/compare/fragment_judge.hpp"

namespace halfplane {
namespace {

std::string bound_line(const char* format, double value, double bound) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, value, bound);
  return text.data();
}

}  // namespace

std::vector<std::string> broken_bounds(const Comparison& c, const Config& config) {
  std::vector<std::string> broken = broken_fragment_bounds(c.fragments, config);
  const auto require = [&broken](bool holds, const char* format, double value, double bound) {
    if (!holds) broken.push_back(bound_line(format, value, bound));
  };
  if (c.rendering.counters.covered == 0) broken.push_back("nothing was compared: no primitive covers a sample");
  const double depth_bound = depth_error_bound(config);
  // The mean is a property of many triangles: one alone has the error of its own reciprocal, up to 1/16 LSB.
  const bool has_population = c.visible_triangles >= 100;

  require(c.oracle.mismatches == 0, "coverage: %.0f samples differ from the exact oracle (bound %.0f)",
          static_cast<double>(c.oracle.mismatches), 0);
  require(c.stage_mismatches == 0, "engine: %.0f stored values differ from what the stages compute (bound %.0f)",
          static_cast<double>(c.stage_mismatches), 0);
  require(c.datapath.max <= depth_bound,
          "depth: %.3f LSB from the exact plane through the snapped vertices (bound %.2f)", c.datapath.max,
          depth_bound);
  require(c.line_datapath.max <= line_depth_error_bound(config),
          "depth of lines: %.3f LSB from the exact value between the snapped ends (bound %.2f)", c.line_datapath.max,
          line_depth_error_bound(config));
  require(!has_population || std::abs(c.datapath_bias.mean) < 0.05,
          "depth: mean error %.4f LSB before rounding (bound %.2f)", c.datapath_bias.mean, 0.05);
  for (const LayerRow& row : c.layers)
    require(row.part_of_bound <= 1, "colour under layers: an error of %.3f of its bound (largest bound %.3f LSB)",
            row.part_of_bound, row.bound);
  require(c.color_datapath.max <= 1, "colour: %.3f LSB from the exact plane through the snapped vertices (bound %.0f)",
          c.color_datapath.max, 1);
  return broken;
}

std::vector<std::string> given_up_bounds(const StudyRules& rules) {
  std::vector<std::string> bounds;
  if (rules.fill_rule == FillRule::inclusive)
    bounds.emplace_back(
        "a sample of a closed mesh or on a shared edge is drawn once: fill rule inclusive draws it twice");
  if (rules.fill_rule == FillRule::offset_point)
    bounds.emplace_back(
        "a sample of a closed mesh or on a shared edge is drawn once: fill rule offset_point may leave it out");
  if (rules.fill_rule == FillRule::exclusive)
    bounds.emplace_back(
        "a sample of a closed mesh or on a shared edge is drawn once: fill rule exclusive leaves it out");
  if (rules.clipping == Clipping::homogeneous)
    bounds.emplace_back(
        "a sample at a shared vertex is drawn once: clipping homogeneous may draw it twice or leave it out");
  const auto planes = [&](bool is_unusual, std::string_view what, std::string_view name) {
    if (!is_unusual) return;
    bounds.push_back("planes of each fragment before depth test and packing: " + std::string(what) + " " +
                     std::string(name) + " is a fault, judged by what is stored");
  };
  planes(rules.gradients != Gradients::one_reciprocal, "gradients", name_of(rules.gradients));
  planes(rules.accumulator != Accumulator::wrap, "accumulator", name_of(rules.accumulator));
  return bounds;
}

}  // namespace halfplane
