#include "sim/study/space/front.hpp"

#include <algorithm>

namespace halfplane {
namespace {

/// Whether `a` has all abilities of `b`.
bool does_as_much(const SpaceJson& a, const SpaceJson& b) {
  return std::all_of(b.items().begin(), b.items().end(), [&](const auto& entry) {
    return a.at(entry.key()).template get<int>() >= entry.value().template get<int>();
  });
}

/// A point's figures on the axes; empty: one is missing.
std::vector<double> place(const SpaceJson& point, const std::vector<std::string>& axes) {
  std::vector<double> at;
  for (const std::string& axis : axes) {
    const auto value = figure(point, axis);
    if (!value) return {};
    at.push_back(*value);
  }
  return at;
}

bool is_better(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return x <= y; }) && a != b;
}

}  // namespace

std::optional<double> figure(const SpaceJson& point, const std::string& name) {
  const std::size_t dot = name.find('.');
  if (dot != std::string::npos) {
    const auto part = point.find(name.substr(0, dot));
    return part == point.end() || !part->is_object() ? std::nullopt : figure(*part, name.substr(dot + 1));
  }
  const auto value = point.find(name);
  if (value == point.end() || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

std::vector<std::string> figures_of(const SpaceJson& points) {
  std::vector<std::string> names;
  if (points.empty()) return names;
  for (const auto& [key, value] : points[0].items()) {
    if (value.is_number()) names.push_back(key);
    if (value.is_object() && key != "settings" && key != "abilities")
      for (const auto& entry : value.items()) names.push_back(key + "." + entry.key());
  }
  std::erase_if(names, [&](const std::string& name) {
    return std::any_of(points.begin(), points.end(), [&](const SpaceJson& p) { return !figure(p, name); });
  });
  return names;
}

std::vector<std::string> default_axes(const SpaceJson& points) {
  const auto all_have = [&](const char* name) {
    return std::all_of(points.begin(), points.end(),
                       [&](const SpaceJson& point) { return figure(point, name).has_value(); });
  };
  std::vector<std::string> axes;
  for (const char* error : {"depth_eye_rms", "depth_range_rms"})
    if (axes.empty() && all_have(error)) axes.emplace_back(error);
  axes.emplace_back("cycles");
  for (const char* gates : {"ecp5.places", "ecp5.block_rams"})
    if (all_have(gates)) axes.emplace_back(gates);
  if (axes.size() < 3 && all_have("ice40.lut4")) axes.emplace_back("ice40.lut4");
  return axes;
}

void mark_front(SpaceJson& points, const std::vector<std::string>& axes) {
  std::vector<std::vector<double>> places;
  for (const SpaceJson& point : points) places.push_back(place(point, axes));
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool is_beaten = places[i].empty();
    for (std::size_t k = 0; k < points.size() && !is_beaten; ++k)
      is_beaten = !places[k].empty() && points[k].at("scene") == points[i].at("scene") &&
                  is_better(places[k], places[i]) && does_as_much(points[k].at("abilities"), points[i].at("abilities"));
    points[i]["on_front"] = !is_beaten;
  }
}

}  // namespace halfplane
