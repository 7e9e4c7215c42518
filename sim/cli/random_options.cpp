#include "sim/cli/random_options.hpp"

#include <memory>

#include "sim/cli/option_kinds.hpp"

namespace halfplane {

void add_random_options(CLI::App& app, RandomOptions& options, const std::string& meaning, std::uint64_t most) {
  constexpr std::uint64_t kOne = 1, kMostScenes = 1'000'000'000;
  app.add_option("--random", options.random, meaning)->check(whole_number(kOne, most))->type_name("N");
  add_text_option(app, "--random-only", options.random_only,
                  "knobs of --random, as triangles,less,16x16,size=1..40,ties=20,no-scissor or FILE.toml "
                  "(docs/random.md)",
                  "KNOBS");
  app.add_option("--first-scene", options.first_scene, "of --random: begin with scene K of the run, counted from 1")
      ->check(whole_number(kOne, kMostScenes))
      ->type_name("K");
  app.add_option("--scenes", options.scenes, "of --random: N scenes at most")
      ->check(whole_number(kOne, kMostScenes))
      ->type_name("N");
}

void check_random_options(const CommonOptions& common, const RandomOptions& options, const std::string& done) {
  if (common.scene.empty() && options.random == 0)
    throw InputError("nothing to " + done + "; give a SCENE or --random N");
  if (!common.scene.empty() && options.random != 0)
    throw InputError("a SCENE and --random exclude each other; leave one of them out");
  if (options.random != 0) return;
  for (const auto& [is_given, name] :
       {std::pair(!options.random_only.empty(), "--random-only"), std::pair(options.first_scene != 0, "--first-scene"),
        std::pair(options.scenes != 0, "--scenes")})
    if (is_given) throw InputError(std::string(name) + ": there are no random scenes; add --random N");
}

SceneSource random_source(const CommonOptions& common, const RandomOptions& options, const Config& config) {
  const RandomProfile profile =
      options.random_only.empty() ? RandomProfile{} : read_random_profile(options.random_only, config);
  SceneRange range{std::max<std::uint64_t>(1, options.first_scene)};
  if (options.scenes != 0) range.count = options.scenes;
  SceneSource source = random_scenes(config, common.seed, options.random, profile, range);
  if (range.first == 1) return source;
  auto first = std::make_shared<std::optional<Scene>>(source());
  if (!*first)
    throw InputError("--first-scene: the " + with_commas(options.random) + " primitives of this run make fewer than " +
                     with_commas(range.first) + " scenes; give a smaller K, or a larger --random");
  return [source = std::move(source), first] { return *first ? std::exchange(*first, std::nullopt) : source(); };
}

std::string random_arguments(const RandomOptions& options) {
  std::string text = " --random " + std::to_string(options.random);
  if (!options.random_only.empty()) text += " --random-only " + quoted(options.random_only);
  if (options.first_scene != 0) text += " --first-scene " + std::to_string(options.first_scene);
  if (options.scenes != 0) text += " --scenes " + std::to_string(options.scenes);
  return text;
}

void add_random_json(Json& result, const RandomOptions& options) {
  result["random"] = or_null(options.random != 0, options.random);
  if (!options.random_only.empty()) result["random_only"] = options.random_only;
  if (options.first_scene != 0) result["first_scene"] = options.first_scene;
  if (options.scenes != 0) result["scenes_at_most"] = options.scenes;
}

}  // namespace halfplane
