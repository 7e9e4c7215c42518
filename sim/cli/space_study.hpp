// `bench --area`, --slurm, --collect: the design space of the hardware, here or on a cluster.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/cli/bench_study.hpp"
#include "sim/cli/memory_options.hpp"

namespace halfplane {

struct SpaceOptions {
  bool wants_area = false, wants_space = false;
  std::vector<std::string> parts{"ecp5", "ice40"};
  std::vector<std::string> front;  ///< figures; empty: default_axes()
  std::string cache, rtl, csv, slurm;
  std::vector<std::string> collect;  ///< folders
  MemorySettings memory;

  [[nodiscard]] bool is_wanted() const { return wants_area || wants_more_than_area(); }
  [[nodiscard]] bool wants_more_than_area() const {
    return wants_space || !csv.empty() || !front.empty() || !slurm.empty() || !collect.empty();
  }
};

/// Adds all of these options to `bench`.
void add_space_options(CLI::App& command, SpaceOptions& options);

/// The options that select the same again.
[[nodiscard]] std::string space_arguments(const SpaceOptions& options);

/// Throws InputError for options that can be refused before a scene is read.
void check_space_options(const CommonOptions& common, const SpaceOptions& options, const std::string& page);

/// The results, and their outputs.
struct SpaceStudy {
  Json result;          ///< head, and later `points`
  std::string command;  ///< repeats the measurement
  std::string page;     ///< file; may be empty
  bool is_partial = false;
};

/// Measures the cases one by one. `study.is_partial` when a signal ended it.
void measure_space(const CommonOptions& common, const SpaceOptions& options, const std::vector<BenchCase>& cases,
                   SpaceStudy& study);

/// Writes DIR/tasks (a shell command a line, for GNU parallel too), DIR/job.sh (for sbatch) and DIR/space.json.
/// `arguments` gives the options of a case besides its own settings.
void write_cluster(const CommonOptions& common, const SpaceOptions& options, const std::vector<BenchCase>& cases,
                   const std::function<std::string(const BenchCase&)>& arguments, const SpaceStudy& study);

/// Reads the results of the tasks in the folders; the first one's configuration is the base. Returns the number of
/// missing points.
std::size_t collect_space(const SpaceOptions& options, SpaceStudy& study);

/// Marks the front, writes JSON, CSV and page, and prints.
void finish_space(const CommonOptions& common, const SpaceOptions& options, SpaceStudy& study);

}  // namespace halfplane
