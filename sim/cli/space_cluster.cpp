// The design space on a cluster: tasks that any shell can run, one point each, and the collection of their results.
#include <filesystem>
#include <iostream>

#include "sim/cli/space_study.hpp"
#include "sim/cli/task_folder.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/study/space/gates.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

}  // namespace

void write_cluster(const CommonOptions& common, const SpaceOptions& options, const std::vector<BenchCase>& cases,
                   const std::function<std::string(const BenchCase&)>& arguments, const SpaceStudy& study) {
  if (options.wants_area)
    (void)Gates(options.rtl, options.cache, options.parts);  // reports early the tools that the cluster would miss
  std::error_code error;
  const fs::path folder = fs::absolute(options.slurm, error).lexically_normal();
  make_task_folder("--slurm", folder, "points");
  const std::string cache = options.cache.empty() ? (folder / "cache").string() : fs::absolute(options.cache).string();
  std::vector<std::string> tasks;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const BenchCase& at = cases[i];
    const fs::path file = fs::absolute(at.scene_name, error);
    std::string task = quoted(own_program()) + " bench " +
                       quoted(fs::exists(file, error) ? file.string() : at.scene_name) + arguments(at);
    if (options.wants_area) {
      task += " --area --cache " + quoted(cache) + " --parts " + joined(options.parts, ",");
      if (!options.rtl.empty()) task += " --rtl " + quoted(fs::absolute(options.rtl).string());
    } else {
      task += " --space";
    }
    tasks.push_back(task + memory_arguments(options.memory) + " --quiet --json=" + task_result("points", i));
  }
  Json manifest = study.result;
  manifest["schema"] = "halfplane.space/1";
  manifest["command"] = study.command;
  manifest["labels"] = Json::array();
  for (const BenchCase& at : cases) manifest["labels"].push_back({at.scene_name, at.variation});
  write_tasks(folder, "points", tasks);
  write_text_file(folder / "space.json", manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  if (common.quiet) return;
  std::cout << tasks_text(folder, cases.size(),
                          program_word() + " bench --collect " + quoted(options.slurm) + " -o space.html");
}

namespace {

/// Adds the points of one folder to the study, and its head if there is none yet. Returns the number of missing points.
std::size_t collect_folder(const fs::path& folder, SpaceStudy& study, bool is_first) {
  Json manifest = read_task_json(folder / "space.json", "--collect takes a folder that --slurm has made");
  if (manifest.value("schema", "") != "halfplane.space/1" || !manifest.contains("labels"))
    throw InputError((folder / "space.json").string() + ": not written by --slurm; give the folder that it has made");
  const Json labels = manifest["labels"];
  study.command += (study.command.empty() ? "" : "\n") + manifest.value("command", "");
  if (is_first) {
    manifest.erase("labels");
    manifest.erase("command");
    manifest["schema"] = "halfplane.bench/1";
    study.result = std::move(manifest);
    study.result["points"] = Json::array();
  }
  std::size_t missing = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const fs::path path = folder / task_result("points", i);
    if (!fs::exists(path)) {
      ++missing;
      continue;
    }
    const Json one = read_task_json(path, "its task makes it again");
    const bool is_point = one.contains("points") && one["points"].is_array() && one["points"].size() == 1;
    if (!is_point || one["points"][0].value("label", "") != labels[i][1])
      throw InputError(path.string() + ": not the point of this task; remove it, and its task makes it again");
    study.result["points"].push_back(one["points"][0]);
    study.result["points"].back()["scene"] = labels[i][0];
  }
  return missing;
}

}  // namespace

std::size_t collect_space(const SpaceOptions& options, SpaceStudy& study) {
  study.command.clear();
  std::size_t missing = 0;
  for (const std::string& folder : options.collect)
    missing += collect_folder(folder, study, &folder == &options.collect.front());
  study.result["missing"] = missing;
  return missing;
}

}  // namespace halfplane
