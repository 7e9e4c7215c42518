#include "sim/study/space/points.hpp"

#include <algorithm>

#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane {

namespace {

SpaceJson number_or_null(const std::optional<double>& value) { return value ? SpaceJson(*value) : SpaceJson(nullptr); }

/// A point beats no other that has an ability it lacks.
SpaceJson abilities(const Config& config) {
  SpaceJson values = SpaceJson::object();
  for (const Setting& setting : settings()) {
    if (setting.ability.empty()) continue;
    const std::string value = get(config, setting);
    values[setting.ability] =
        setting.is_number() ? std::stoi(value) : std::ranges::find(setting.names, value) - setting.names.begin();
  }
  values["blending"] = std::min(config.blend_lanes, 1);  // more lanes blend faster, not more
  return values;
}

}  // namespace

const BenchFacts& PointStudy::facts_of(const BenchCase& at, const Rendering& picture,
                                       const std::function<void(double)>& progress) {
  // Points with the same picture, on hardware with the same bits, have the same errors, which are computed once.
  Config shown = at.config;
  for (const Setting& setting : settings())
    if (!setting.may_change_pixels) set(shown, setting.key, get(preset("embedded"), setting));
  const std::string key = at.scene_name + '\n' + label(shown) + '\n' +
                          color_hash(picture.frame, at.config.color_format) + depth_hash(picture.frame);
  const auto found = facts_.find(key);
  if (found != facts_.end()) return found->second;
  return facts_.emplace(key, find_facts(*at.scene, at.config, true, progress)).first->second;
}

SpaceJson PointStudy::measure(const BenchCase& at, const std::function<void(double)>& progress) {
  const Hardware hardware{at.config, {}, memory_};
  check(hardware);
  RenderOptions options;
  options.progress = [&progress](double part) { progress(part / 2); };
  const CycleRendering frame = run_cycles(*at.scene, hardware, options);
  const BenchFacts& facts = facts_of(at, frame.rendering, [&progress](double part) { progress((1 + part) / 2); });
  const BenchErrors errors = facts.errors.value_or(BenchErrors{});
  return {{"scene", at.scene_name},
          {"label", at.variation},
          {"config", label(at.config)},
          {"settings", settings_of(at.variation)},
          {"width", at.scene->width},
          {"height", at.scene->height},
          {"depth_lsb_rms", number_or_null(errors.depth_lsb_rms)},
          {"depth_lsb_max", number_or_null(errors.depth_lsb_max)},
          {"depth_range_rms", number_or_null(errors.depth_range_rms)},
          {"depth_range_max", number_or_null(errors.depth_range_max)},
          {"depth_eye_rms", number_or_null(errors.depth_eye_rms)},
          {"depth_eye_max", number_or_null(errors.depth_eye_max)},
          {"color_lsb_rms", number_or_null(errors.color_lsb_rms)},
          {"color_lsb_max", number_or_null(errors.color_lsb_max)},
          {"coverage_mismatches", errors.coverage_mismatches},
          {"coverage_missing", errors.coverage_missing},
          {"coverage_extra", errors.coverage_extra},
          {"cycles", frame.run.cycles},
          {"ms", static_cast<double>(frame.run.cycles) / (1e3 * memory_.mhz)},
          {"bytes", traffic(frame.run, at.config).total()},
          {"abilities", abilities(at.config)}};
}

SpaceJson settings_of(const std::string& label) {
  SpaceJson settings = SpaceJson::object();
  for (std::size_t start = 0; start < label.size();) {
    const std::size_t end = std::min(label.find(' ', start), label.size());
    const std::string word = label.substr(start, end - start);
    const std::size_t equals = word.find('=');
    settings[word.substr(0, equals)] = word.substr(equals + 1);
    start = end + 1;
  }
  return settings;
}

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
