#include "sim/study/stress/unit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/golden/exact.hpp"

namespace halfplane::stress {

void BiasSums::add_triangle(std::int64_t error_sum, std::int64_t count) {
  ++triangles;
  fragments += static_cast<std::uint64_t>(count);
  sum += error_sum;
  sum_squares += int128{error_sum} * error_sum;
  sum_products += int128{error_sum} * count;
  count_squares += int128{count} * count;
}

void BiasSums::add(const BiasSums& other) {
  triangles += other.triangles;
  fragments += other.fragments;
  sum += other.sum;
  sum_squares += other.sum_squares;
  sum_products += other.sum_products;
  count_squares += other.count_squares;
}

double BiasSums::mean() const {
  return fragments == 0 ? 0 : std::ldexp(static_cast<double>(sum) / static_cast<double>(fragments), -exact::kGridBits);
}

double BiasSums::standard_error() const {
  // Sum over the triangles of (s - m n)^2, over the squared number of fragments.
  const double m = fragments == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(fragments);
  const double residue = static_cast<double>(sum_squares) - 2 * m * static_cast<double>(sum_products) +
                         m * m * static_cast<double>(count_squares);
  return triangles < 2
             ? HUGE_VAL
             : std::ldexp(std::sqrt(std::max(residue, 0.0)) / static_cast<double>(fragments), -exact::kGridBits);
}

void Tally::keep_worst(const std::string& property, Worst candidate) {
  const auto [entry, is_new] = worst.try_emplace(property);
  const double now = candidate.ratio(), before = entry->second.ratio();
  if (is_new || now > before || (now == before && candidate.place.unit < entry->second.place.unit))
    entry->second = std::move(candidate);
}

void Tally::keep_first(Failure failure) {
  if (!first || failure.place.unit < first->place.unit) first = std::move(failure);
}

void Tally::merge(Tally&& other) {
  units += other.units;
  triangles += other.triangles;
  samples += other.samples;
  checks += other.checks;
  failures += other.failures;
  configs.insert(other.configs.begin(), other.configs.end());
  for (auto& [property, candidate] : other.worst) keep_worst(property, std::move(candidate));
  for (const auto& [name, value] : other.preset_depth) preset_depth[name] = std::max(preset_depth[name], value);
  for (const auto& [label, sums] : other.bias) bias[label].add(sums);
  bias_config.insert(other.bias_config.begin(), other.bias_config.end());
  if (other.first) keep_first(std::move(*other.first));
}

bool Unit::require(bool holds, std::string_view property, const Scene& scene, std::string_view what) {
  ++tally_.checks;
  if (holds) return true;
  ++tally_.failures;
  if (!tally_.first || number < tally_.first->place.unit)
    tally_.keep_first({std::string(property), std::string(what), {number, config, scene}});
  return false;
}

void Unit::measure(std::string_view property, std::string_view unit, double value, double bound, const Scene& scene,
                   FillRule rule) {
  const auto known = tally_.worst.find(property);
  const double ratio = bound > 0 ? value / bound : value;
  // Copying a scene is expensive, and a worse one is rare.
  if (known == tally_.worst.end() || ratio > known->second.ratio() ||
      (ratio == known->second.ratio() && number < known->second.place.unit))
    tally_.keep_worst(std::string(property),
                      {value, bound, std::string(unit), {number, config, scene, rule}, std::nullopt});
  if (property == "depth" && value > tally_.preset_depth[config.preset] && config == preset(config.preset))
    tally_.preset_depth[config.preset] = value;
  if (value <= bound) return;  // false for a NaN
  ++tally_.failures;
  if (!tally_.first || number < tally_.first->place.unit)
    tally_.keep_first({std::string(property),
                       std::to_string(value) + " " + std::string(unit) + ", bound " + std::to_string(bound),
                       {number, config, scene, rule}});
}

void Unit::add_bias(std::int64_t error_sum, std::int64_t count) {
  const std::string name = label(config);
  tally_.bias[name].add_triangle(error_sum, count);
  tally_.bias_config.try_emplace(name, config);
}

}  // namespace halfplane::stress
