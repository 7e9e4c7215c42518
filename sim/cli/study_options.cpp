#include "sim/cli/study_options.hpp"

#include <algorithm>
#include <span>

#include "sim/cli/option_kinds.hpp"
#include "sim/study/compare/double_draws.hpp"

namespace halfplane {
namespace {

/// A rule as an option, a key of results and words for people.
struct Rule {
  enum class Kind { samples, clipping, planes, interpolation } kind;
  const char *option, *key;
  std::string StudyOptions::*value;
  std::span<const std::string_view> names;  ///< the pipeline's own first
  const char* meaning;
};

constexpr std::array<std::string_view, 3> kInterpolationNames{"scene", "affine", "perspective"};

/// In the order of results.
constexpr Rule kRules[]{
    {Rule::Kind::samples, "--traversal", "traversal", &StudyOptions::traversal, kRuleNames<Traversal>,
     "study, scalar engine: how samples are found; the image stays the same"},
    {Rule::Kind::samples, "--fill-rule", "fill_rule", &StudyOptions::fill_rule, kRuleNames<FillRule>,
     "study, scalar engine: which triangle owns a sample exactly on an edge"},
    {Rule::Kind::clipping, "--clipping", "clipping", &StudyOptions::clipping, kRuleNames<Clipping>,
     "study, scalar and golden engines: triangles clipped to polygons, or homogeneous edge functions without clipping"},
    {Rule::Kind::planes, "--gradients", "gradients", &StudyOptions::gradients, kRuleNames<Gradients>,
     "study, scalar engine: how triangle setup computes gradients; two of the ways are faults"},
    {Rule::Kind::planes, "--accumulator", "accumulator", &StudyOptions::accumulator, kRuleNames<Accumulator>,
     "study, scalar engine: what the register of a plane does on overflow; saturate is a fault"},
    {Rule::Kind::planes, "--weights", "weights", &StudyOptions::weights, kRuleNames<Weights>,
     "study, scalar engine: bits of a linear texture filter's weights; 4 is a fault"},
    {Rule::Kind::interpolation, "--interpolation", "interpolation", &StudyOptions::interpolation, kInterpolationNames,
     "study, every engine: interpolate all colours and texture coordinates affinely on the screen, or over w, whatever "
     "the scene's states say"},
};

bool is_of_scalar_engine(const Rule& rule) {
  return rule.kind == Rule::Kind::samples || rule.kind == Rule::Kind::planes;
}

bool is_unusual(const Rule& rule, const StudyOptions& options) { return options.*rule.value != rule.names.front(); }

void add_rule_option(CLI::App& app, StudyOptions& options, const Rule& rule) {
  add_choice_option(app, rule.option, options.*rule.value,
                    std::vector<std::string>(rule.names.begin(), rule.names.end()), rule.meaning);
}

/// The enumerator of a name; CLI11 has refused all others.
template <class Enum>
Enum enumerator(const std::string& name) {
  const auto& names = kRuleNames<Enum>;
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

void add_study_options(CLI::App& app, StudyOptions& options) {
  for (const Rule& rule : kRules)
    if (is_of_scalar_engine(rule)) add_rule_option(app, options, rule);
}

void add_clipping_option(CLI::App& app, StudyOptions& options) { add_rule_option(app, options, kRules[2]); }

void add_interpolation_option(CLI::App& app, StudyOptions& options) { add_rule_option(app, options, kRules[6]); }

Scene interpolated(Scene scene, const std::string& interpolation) {
  if (interpolation == "scene") return scene;
  const bool is_affine = interpolation == "affine";
  for (State& state : scene.states) {
    state.color_interp = is_affine ? ColorInterp::affine : ColorInterp::perspective;
    state.texture_interp = is_affine ? TextureInterp::affine : TextureInterp::perspective;
  }
  return scene;
}

std::string study_arguments(const StudyOptions& options) {
  std::string text;
  for (const Rule& rule : kRules)
    if (is_unusual(rule, options)) text += std::string(" ") + rule.option + " " + options.*rule.value;
  return text;
}

StudyRules study_rules(const StudyOptions& options) {
  return {enumerator<Traversal>(options.traversal),     enumerator<FillRule>(options.fill_rule),
          enumerator<Clipping>(options.clipping),       enumerator<Gradients>(options.gradients),
          enumerator<Accumulator>(options.accumulator), enumerator<Weights>(options.weights)};
}

void check_study_rules(const StudyOptions& options, const std::string& engine) {
  const bool is_homogeneous = options.clipping != kRuleNames<Clipping>.front();
  for (const Rule& rule : kRules) {
    if (!is_of_scalar_engine(rule) || !is_unusual(rule, options)) continue;
    if (is_homogeneous)
      throw InputError(
          "--clipping homogeneous replaces setup and sampling: leave out --traversal, --fill-rule, --gradients, "
          "--accumulator and --weights");
    if (engine != "scalar")
      throw InputError(std::string(rule.option) + " " + options.*rule.value + ": the engine " + engine +
                       " does not have it; add --engine scalar");
  }
  if (is_homogeneous && engine != "scalar" && engine != "golden")
    throw InputError("--clipping " + options.clipping + ": the engine " + engine +
                     " does not have it; add --engine scalar or --engine golden");
}

void add_rules_json(Json& result, const StudyOptions& options) {
  for (const Rule& rule : kRules) result[rule.key] = options.*rule.value;
}

void add_study_json(Json& result, const StudyOptions& options, const Scene& scene, const Config& config) {
  add_rules_json(result, options);
  const DrawsOfRule draws = count_draws(scene, config, study_rules(options));
  result["double_draws"] = draws.doubled;
  result["undrawn_samples"] = draws.undrawn;
}

std::string study_text(const Json& result) {
  std::vector<std::string> parts;
  const auto add_count = [&](const char* key, const char* label) {
    if (result.contains(key)) parts.push_back(with_commas(result[key].get<std::uint64_t>()) + label);
  };
  const auto add_unusual = [&](bool is_of_planes) {
    for (const Rule& rule : kRules) {
      if ((rule.kind == Rule::Kind::planes || rule.kind == Rule::Kind::interpolation) != is_of_planes) continue;
      if (!result.contains(rule.key) || result[rule.key] == rule.names.front()) continue;
      std::string label = rule.key;
      std::replace(label.begin(), label.end(), '_', ' ');
      parts.push_back(label + " " + result[rule.key].get<std::string>());
    }
  };
  add_unusual(false);
  if (!parts.empty()) {
    add_count("double_draws", " double draws");
    if (result.contains("undrawn_samples") && result["undrawn_samples"] != 0)
      add_count("undrawn_samples", " undrawn samples");
  }
  add_unusual(true);
  return joined(parts);
}

}  // namespace halfplane
