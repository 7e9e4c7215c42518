// A folder of tasks that any shell can run, here or on a cluster: `tasks`, a command a line, and `job.sh` for sbatch.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/cli/options.hpp"

namespace halfplane {

/// "points/00001.json" for index 0: a task's result, seen from its folder.
[[nodiscard]] std::string task_result(const std::string& folder, std::size_t index);

/// This program, as tasks call it.
[[nodiscard]] std::string own_program();

/// Makes the folder with `results` and `logs` in it. Throws InputError, which begins with `option`.
void make_task_folder(const std::string& option, const std::filesystem::path& folder, const std::string& results);

/// Writes `tasks`: each command runs unless its result is there, so that a second run goes on; and `job.sh`.
void write_tasks(const std::filesystem::path& folder, const std::string& results,
                 const std::vector<std::string>& commands);

/// "N tasks. On a cluster: ..., here: ..., then: THEN".
[[nodiscard]] std::string tasks_text(const std::filesystem::path& folder, std::size_t tasks, const std::string& then);

/// Throws InputError, which ends with `mend`, for a file that cannot be read, or is no JSON.
[[nodiscard]] Json read_task_json(const std::filesystem::path& path, const std::string& mend);

}  // namespace halfplane
