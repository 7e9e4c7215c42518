#include "sim/cli/study_options.hpp"

#include <algorithm>

#include "sim/study/compare/double_draws.hpp"

namespace halfplane {
namespace {

/// The enumerator of a name; CLI11 let no other through.
template <class Enum, class Names>
Enum enumerator(const Names& names, const std::string& name) {
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <class Names>
std::vector<std::string> as_strings(const Names& names) {
  return {names.begin(), names.end()};
}

}  // namespace

void add_study_options(CLI::App& app, StudyOptions& options) {
  app.add_option("--traversal", options.traversal,
                 "study, scalar engine: how samples are found; the image stays the same")
      ->check(CLI::IsMember(as_strings(kTraversalNames)))
      ->capture_default_str();
  app.add_option("--fill-rule", options.fill_rule, "study, scalar engine: who owns samples exactly on an edge")
      ->check(CLI::IsMember(as_strings(kFillRuleNames)))
      ->capture_default_str();
  app.add_option("--gradients", options.gradients,
                 "study, scalar engine: how triangle setup makes them; two are faults")
      ->check(CLI::IsMember(as_strings(kGradientsNames)))
      ->capture_default_str();
  app.add_option("--accumulator", options.accumulator,
                 "study, scalar engine: what a plane does beyond the range of its register; saturate is a fault")
      ->check(CLI::IsMember(as_strings(kAccumulatorNames)))
      ->capture_default_str();
  app.add_option("--weights", options.weights,
                 "study, scalar engine: bits of a linear texture filter's weights; 4 is a fault")
      ->check(CLI::IsMember(as_strings(kWeightsNames)))
      ->capture_default_str();
}

void add_clipping_option(CLI::App& app, StudyOptions& options) {
  app.add_option(
         "--clipping", options.clipping,
         "study, scalar and golden engines: triangles cut to polygons, or homogeneous edge functions and no cut")
      ->check(CLI::IsMember(as_strings(kClippingNames)))
      ->capture_default_str();
}

void add_interpolation_option(CLI::App& app, StudyOptions& options) {
  app.add_option(
         "--interpolation", options.interpolation,
         "study, every engine: all colours and texture coordinates affine on the screen, or over w, in place of "
         "what the scene's states say")
      ->check(CLI::IsMember({"scene", "affine", "perspective"}))
      ->capture_default_str();
}

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
  const StudyOptions usual;
  std::string text;
  const auto add = [&](const char* name, std::string StudyOptions::*value) {
    if (options.*value != usual.*value) text += std::string(" ") + name + " " + options.*value;
  };
  add("--traversal", &StudyOptions::traversal);
  add("--fill-rule", &StudyOptions::fill_rule);
  add("--clipping", &StudyOptions::clipping);
  add("--gradients", &StudyOptions::gradients);
  add("--accumulator", &StudyOptions::accumulator);
  add("--weights", &StudyOptions::weights);
  add("--interpolation", &StudyOptions::interpolation);
  return text;
}

StudyRules study_rules(const StudyOptions& options) {
  return {enumerator<Traversal>(kTraversalNames, options.traversal),
          enumerator<FillRule>(kFillRuleNames, options.fill_rule),
          enumerator<Clipping>(kClippingNames, options.clipping),
          enumerator<Gradients>(kGradientsNames, options.gradients),
          enumerator<Accumulator>(kAccumulatorNames, options.accumulator),
          enumerator<Weights>(kWeightsNames, options.weights)};
}

void check_study_rules(const StudyRules& rules, const std::string& engine) {
  if (rules.clipping != Clipping::polygon) {
    if (rules != StudyRules{.clipping = rules.clipping})
      throw InputError(
          "--clipping homogeneous has its own setup and samples: leave out --traversal, --fill-rule, --gradients, "
          "--accumulator and --weights");
    if (engine != "scalar" && engine != "golden")
      throw InputError("--clipping " + std::string(name_of(rules.clipping)) + ": the engine " + engine +
                       " does not have it; add --engine scalar or --engine golden");
    return;
  }
  if (engine == "scalar") return;
  const std::string rest = ": the engine " + engine + " does not have it; add --engine scalar";
  if (rules.traversal != Traversal::tiled)
    throw InputError("--traversal " + std::string(name_of(rules.traversal)) + rest);
  if (rules.fill_rule != FillRule::top_left)
    throw InputError("--fill-rule " + std::string(name_of(rules.fill_rule)) + rest);
  if (rules.gradients != Gradients::one_reciprocal)
    throw InputError("--gradients " + std::string(name_of(rules.gradients)) + rest);
  if (rules.accumulator != Accumulator::wrap)
    throw InputError("--accumulator " + std::string(name_of(rules.accumulator)) + rest);
  if (rules.weights != Weights::eight) throw InputError("--weights " + std::string(name_of(rules.weights)) + rest);
}

void add_rules_json(Json& result, const StudyOptions& options) {
  result["traversal"] = options.traversal;
  result["fill_rule"] = options.fill_rule;
  result["clipping"] = options.clipping;
  result["gradients"] = options.gradients;
  result["accumulator"] = options.accumulator;
  result["weights"] = options.weights;
  result["interpolation"] = options.interpolation;
}

void add_study_json(Json& result, const StudyOptions& options, const Scene& scene, const Config& config) {
  add_rules_json(result, options);
  const DrawsOfRule draws = count_draws(scene, config, study_rules(options));
  result["double_draws"] = draws.doubled;
  result["undrawn_samples"] = draws.undrawn;
}

std::string study_text(const Json& result) {
  struct Rule {
    const char *key, *label;
    std::string_view usual;
  };
  constexpr Rule kSamples[] = {{"traversal", "traversal", name_of(Traversal::tiled)},
                               {"fill_rule", "fill rule", name_of(FillRule::top_left)},
                               {"clipping", "clipping", name_of(Clipping::polygon)}};
  constexpr Rule kPlanes[] = {{"gradients", "gradients", name_of(Gradients::one_reciprocal)},
                              {"accumulator", "accumulator", name_of(Accumulator::wrap)},
                              {"weights", "weights", name_of(Weights::eight)},
                              {"interpolation", "interpolation", "scene"}};
  std::vector<std::string> parts;
  const auto add_unusual = [&](const auto& rules) {
    for (const Rule& rule : rules)
      if (result.contains(rule.key) && result[rule.key] != rule.usual)
        parts.push_back(std::string(rule.label) + " " + result[rule.key].get<std::string>());
  };
  add_unusual(kSamples);
  const auto add_count = [&](const char* key, const char* label) {
    if (result.contains(key)) parts.push_back(with_commas(result[key].get<std::uint64_t>()) + label);
  };
  if (!parts.empty()) {
    add_count("double_draws", " double draws");
    if (result.contains("undrawn_samples") && result["undrawn_samples"] != 0)
      add_count("undrawn_samples", " undrawn samples");
  }
  add_unusual(kPlanes);
  std::string line;
  for (const std::string& part : parts) line += (line.empty() ? "" : ", ") + part;
  return line;
}

}  // namespace halfplane
