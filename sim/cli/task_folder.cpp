#include "sim/cli/task_folder.hpp"

#include <fstream>

#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

/// Slurm's own limit is 1,001 unless MaxArraySize is set.
constexpr std::size_t kMostJobs = 1000;

std::string job_script(const fs::path& folder, std::size_t tasks) {
  const std::string jobs = std::to_string(std::min(tasks, kMostJobs));
  return "#!/bin/sh\n"
         "# Submit with `sbatch " +
         quoted((folder / "job.sh").string()) +
         "`; again, it does the tasks whose results are missing.\n"
         "#SBATCH --job-name=halfplane\n"
         "#SBATCH --array=1-" +
         jobs +
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
         jobs +
         "))\n"
         "done\n"
         "exit $status\n";
}

}  // namespace

std::string task_result(const std::string& folder, std::size_t index) {
  const std::string digits = std::to_string(index + 1);
  return folder + "/" + std::string(digits.size() < 5 ? 5 - digits.size() : 0, '0') + digits + ".json";
}

std::string own_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

void make_task_folder(const std::string& option, const fs::path& folder, const std::string& results) {
  std::error_code error;
  for (const std::string& part : {results, std::string("logs")}) {
    fs::create_directories(folder / part, error);
    if (error) throw InputError(option + ": " + (folder / part).string() + ": " + error.message());
  }
}

void write_tasks(const fs::path& folder, const std::string& results, const std::vector<std::string>& commands) {
  std::string tasks;
  for (std::size_t i = 0; i < commands.size(); ++i)
    tasks.append("test -s ").append(task_result(results, i)).append(" || ").append(commands[i]).append("\n");
  write_text_file(folder / "tasks", tasks);
  write_text_file(folder / "job.sh", job_script(folder, commands.size()));
}

std::string tasks_text(const fs::path& folder, std::size_t tasks, const std::string& then) {
  return std::to_string(tasks) + " tasks. On a cluster: sbatch " + quoted((folder / "job.sh").string()) +
         "\nHere: (cd " + quoted(folder.string()) + " && parallel <tasks)\nThen: " + then + "\n";
}

Json read_task_json(const fs::path& path, const std::string& mend) {
  std::ifstream in(path);
  if (!in) throw InputError(path.string() + ": cannot be read; " + mend);
  Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded()) throw InputError(path.string() + ": no JSON; remove it, and its task makes it again");
  return json;
}

}  // namespace halfplane
