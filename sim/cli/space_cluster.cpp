// The design space on a cluster: tasks that any shell can run, one point each, and the collection of their results.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "sim/cli/space_study.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/study/space/gates.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

/// Slurm's own limit is 1,001 unless MaxArraySize is set.
constexpr std::size_t kMostJobs = 1000;

std::string point_name(std::size_t index) {
  const std::string digits = std::to_string(index + 1);
  return "points/" + std::string(digits.size() < 5 ? 5 - digits.size() : 0, '0') + digits + ".json";
}

std::string job_script(const fs::path& folder, std::size_t points) {
  const std::size_t jobs = std::min(points, kMostJobs);
  return "#!/bin/sh\n"
         "# Submit with `sbatch " +
         quoted((folder / "job.sh").string()) +
         "`; again, it does the points that are missing.\n"
         "#SBATCH --job-name=halfplane\n"
         "#SBATCH --array=1-" +
         std::to_string(jobs) +
         "\n"
         "#SBATCH --ntasks=1\n"
         "#SBATCH --output=" +
         (folder / "logs/%a.log").string() +
         "\n"
         "cd " +
         quoted(folder.string()) +
         " || exit 1\n"
         "count=$(wc -l <tasks)\n"
         "line=$SLURM_ARRAY_TASK_ID\n"
         "status=0\n"
         "while [ \"$line\" -le \"$count\" ]; do\n"
         "  sh -c \"$(sed -n \"${line}p\" tasks)\" || status=1\n"
         "  line=$((line + " +
         std::to_string(jobs) +
         "))\n"
         "done\n"
         "exit $status\n";
}

Json read_json(const fs::path& path) {
  std::ifstream in(path);
  if (!in) throw InputError(path.string() + ": cannot be read; --collect takes a folder that --slurm has made");
  Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded()) throw InputError(path.string() + ": no JSON; remove it, and its task makes it again");
  return json;
}

}  // namespace

void write_cluster(const CommonOptions& common, const SpaceOptions& options, const std::vector<BenchCase>& cases,
                   const std::function<std::string(const BenchCase&)>& arguments, const SpaceStudy& study) {
  if (options.wants_area)
    (void)Gates(options.rtl, options.cache, options.parts);  // reports early the tools that the cluster would miss
  std::error_code error;
  const fs::path folder = fs::absolute(options.slurm, error).lexically_normal();
  for (const char* part : {"points", "logs"}) {
    fs::create_directories(folder / part, error);
    if (error) throw InputError("--slurm: " + (folder / part).string() + ": " + error.message());
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const std::string cache = options.cache.empty() ? (folder / "cache").string() : fs::absolute(options.cache).string();
  std::string tasks;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const BenchCase& at = cases[i];
    const fs::path file = fs::absolute(at.scene_name, error);
    tasks += "test -s " + point_name(i) + " || " + quoted(program.string()) + " bench " +
             quoted(fs::exists(file, error) ? file.string() : at.scene_name) + arguments(at);
    if (options.wants_area) {
      tasks += " --area --cache " + quoted(cache) + " --parts " + joined(options.parts, ",");
      if (!options.rtl.empty()) tasks += " --rtl " + quoted(fs::absolute(options.rtl).string());
    } else {
      tasks += " --space";
    }
    tasks += memory_arguments(options.memory) + " --quiet --json=" + point_name(i) + "\n";
  }
  Json manifest = study.result;
  manifest["schema"] = "halfplane.space/1";
  manifest["command"] = study.command;
  manifest["labels"] = Json::array();
  for (const BenchCase& at : cases) manifest["labels"].push_back({at.scene_name, at.variation});
  write_text_file(folder / "tasks", tasks);
  write_text_file(folder / "job.sh", job_script(folder, cases.size()));
  write_text_file(folder / "space.json", manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  if (common.quiet) return;
  std::cout << cases.size() << " tasks. On a cluster: sbatch " << quoted((folder / "job.sh").string()) << "\nHere: (cd "
            << quoted(folder.string()) << " && parallel <tasks)\nThen: " << program_word() << " bench --collect "
            << quoted(options.slurm) << " -o space.html\n";
}

namespace {

/// Adds the points of one folder to the study, and its head if there is none yet. Returns the number of missing points.
std::size_t collect_folder(const fs::path& folder, SpaceStudy& study, bool is_first) {
  Json manifest = read_json(folder / "space.json");
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
    const fs::path path = folder / point_name(i);
    if (!fs::exists(path)) {
      ++missing;
      continue;
    }
    const Json one = read_json(path);
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
