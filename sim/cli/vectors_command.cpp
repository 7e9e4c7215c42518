#include <algorithm>
#include <limits>
#include <ostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/coverage_option.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/random_options.hpp"
#include "sim/cover/collector.hpp"
#include "sim/vectors/vector_file.hpp"

namespace halfplane {
namespace {

struct VectorsOptions : CommonOptions, RandomOptions {
  std::string stage, format = "jsonl", output, coverage;
};

vectors::Format vector_format(const std::string& name) {
  const auto found = std::find(vectors::kFormats.begin(), vectors::kFormats.end(), name);
  return static_cast<vectors::Format>(found - vectors::kFormats.begin());
}

Json port_counts(const std::vector<vectors::Port>& ports, const std::vector<vectors::PacketList>& lists) {
  Json json = Json::object();
  for (std::size_t p = 0; p < ports.size(); ++p) json[std::string(ports[p].name)] = lists[p].size();
  return json;
}

std::string ports_text(const std::vector<vectors::Port>& ports, const std::vector<vectors::PacketList>& lists) {
  std::string text;
  for (std::size_t p = 0; p < ports.size(); ++p)
    text += (text.empty() ? "" : ", ") + with_commas(lists[p].size()) + " " + std::string(ports[p].name);
  return text.empty() ? "nothing" : text;
}

vectors::VectorSource vector_source(const VectorsOptions& options) {
  return {options.random == 0 ? options.scene : random_arguments(options).substr(3), options.seed};
}

int run(const VectorsOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_random_options(options, options, "run");
  if (options.skip != "all") throw InputError("--skip: hardware skips by its own rules; leave it out");
  const vectors::Format format = vector_format(options.format);
  if (format == vectors::Format::hex && options.output == "-")
    throw InputError("-o: hex vectors are a folder, which cannot go to stdout; give its name");
  if (format != vectors::Format::hex) check_output(options.output);
  const Config config = effective_config(options);
  const vectors::JudgedStage& stage = vectors::judged_stage(options.stage);
  vectors::require_stage(stage, config);
  double load_s = 0;
  SceneSource scenes =
      options.random != 0 ? random_source(options, options, config) : single_scene(load_scene(options, config, load_s));
  std::optional<cover::Collector> coverage;
  if (!options.coverage.empty()) {
    coverage.emplace(config);
    scenes = [source = std::move(scenes), &coverage, &config]() mutable {
      auto scene = source();
      if (scene) coverage->run(*scene, config);
      return scene;
    };
  }
  Progress progress(options, "recording", "primitives");
  const vectors::StagePackets packets = vectors::record_stage(stage, config, scenes, [&progress](std::uint64_t sent) {
    progress(std::numeric_limits<double>::quiet_NaN(), sent);
  });
  const auto written = vectors::write_vectors(options.output, format, stage, config, packets, vector_source(options));
  Json result = result_head("vectors", options, config);
  result["seed"] = options.seed;
  add_random_json(result, options);
  result["stage"] = options.stage;
  result["format"] = options.format;
  result["can_be_checked"] = stage.can_run();
  result["in"] = port_counts(stage.in, packets.in);
  result["out"] = port_counts(stage.out, packets.out);
  result["files"] = Json::array();
  for (const auto& [path, bytes] : written) result["files"].push_back({{"path", path}, {"bytes", bytes}});
  const std::string covered =
      !coverage ? ""
                : save_coverage(options.coverage, coverage->hits(), config,
                                {typed_command(), stimulus_text(options, options), label(config), options.seed},
                                cover::Source::model, result);
  finish_json(options, result, start);
  std::ostream& out = human(options);
  out << options.stage << " of " << vector_source(options).text << ", " << label(config) << ", seed " << options.seed
      << '\n'
      << "in   " << ports_text(stage.in, packets.in) << '\n'
      << "out  " << ports_text(stage.out, packets.out) << '\n';
  for (const auto& [path, bytes] : written) out << path << "  " << with_commas(bytes) << " bytes\n";
  out << covered;
  if (!stage.can_run()) out << "`halfplane check` cannot judge this stage: " << stage.why_not << '\n';
  return exit_ok;
}

}  // namespace

void add_vectors_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<VectorsOptions>(
      app, selected, "vectors", "test vectors of a stage, inputs and expected outputs, for your own RTL", run);
  add_scene_options(*command, *options);
  command->get_option("SCENE")->required(false);
  add_random_options(*command, *options,
                     "N random triangles, lines and points of all sizes and states instead of a scene", 10'000'000);
  add_text_option(*command, "--stage", options->stage, "the stage: cull, triangle_setup, coarse_raster ...", "NAME")
      ->required();
  add_choice_option(*command, "--format", options->format,
                    std::vector<std::string>(vectors::kFormats.begin(), vectors::kFormats.end()),
                    "how they are written");
  add_output_option(*command, "-o", options->output, "the file, or for hex the folder; - for stdout")->required();
  add_coverage_option(*command, options->coverage);
  command->footer(
      "\nThe hardware model runs from reset. Judge the outputs of your implementation with `halfplane check`.\n"
      "\nExample:\n  halfplane vectors --random 200 --stage fine_raster -o fine_raster.jsonl");
}

}  // namespace halfplane
