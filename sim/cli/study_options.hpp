// The study rules of docs/rules.md and docs/numerics.md, for commands that can run the scalar engine.
#pragma once

#include <string>

#include "model/study/rules.hpp"
#include "sim/cli/options.hpp"

namespace halfplane {

/// As typed; the names are those of model/study/rules.hpp.
struct StudyOptions {
  std::string traversal{name_of(Traversal::tiled)};
  std::string fill_rule{name_of(FillRule::top_left)};
  std::string clipping{name_of(Clipping::polygon)};
  std::string gradients{name_of(Gradients::one_reciprocal)};
  std::string accumulator{name_of(Accumulator::wrap)};
  std::string weights{name_of(Weights::eight)};
  std::string interpolation = "scene";  ///< a change of the scene's states, possible in every engine
};

/// Adds --traversal, --fill-rule, --gradients, --accumulator and --weights.
void add_study_options(CLI::App& app, StudyOptions& options);

/// Adds --clipping: for commands that need no snapped triangles.
void add_clipping_option(CLI::App& app, StudyOptions& options);

void add_interpolation_option(CLI::App& app, StudyOptions& options);

/// The scene with all colours and texture coordinates interpolated as given: "affine", "perspective", or unchanged,
/// "scene".
[[nodiscard]] Scene interpolated(Scene scene, const std::string& interpolation);

/// " --fill-rule NAME ...": the rules that differ from the default, quoted for a shell.
[[nodiscard]] std::string study_arguments(const StudyOptions& options);

[[nodiscard]] StudyRules study_rules(const StudyOptions& options);

/// Throws InputError, naming the option, when an engine lacks a rule.
void check_study_rules(const StudyOptions& options, const std::string& engine);

/// Adds {traversal, fill_rule, clipping, gradients, accumulator, weights, interpolation} to a result.
void add_rules_json(Json& result, const StudyOptions& options);

/// Adds the rules, and {double_draws, undrawn_samples}.
void add_study_json(Json& result, const StudyOptions& options, const Scene& scene, const Config& config);

/// "traversal bbox, fill rule inclusive, 12 double draws": the same for people, without defaults, from the keys of
/// add_study_json(), from "clipping" alone, or from "interpolation".
[[nodiscard]] std::string study_text(const Json& result);

}  // namespace halfplane
