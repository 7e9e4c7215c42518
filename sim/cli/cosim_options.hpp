// Shared by `cosim` and `reduce`: their options, and the handling of a failing scene.
#pragma once

#include <iosfwd>
#include <string>

#include "sim/cli/memory_options.hpp"
#include "sim/cli/random_options.hpp"

namespace halfplane {

struct CosimOptions : CommonOptions, RandomOptions {
  double stalls = 0;
  int mutant = 0, resets = 0;
  bool ignores_cycles = false;
  MemorySettings memory;
  std::string junit_path, trace_path, save_path;
  std::string trace_cycles;  ///< FIRST:LAST
  std::string coverage;      ///< file
};

void add_stalls_option(CLI::App& app, CosimOptions& options);

/// Adds all options except --random and --junit.
void add_cosim_options(CLI::App& app, CosimOptions& options);

/// The design for this configuration. Throws InputError for a mutant that it does not have, std::runtime_error (exit
/// status 3) when there is no such design.
[[nodiscard]] const DutFactory& dut_for(const CosimOptions& options, const Config& config);

[[nodiscard]] LockstepOptions lockstep_options(const CosimOptions& options);

/// The command that runs a saved capture again; "": the scene or --random of the options.
[[nodiscard]] std::string repeat_command(const CosimOptions& options, const Config& config, const std::string& capture,
                                         const LockstepOptions& lockstep);

/// Writes a scene to the path of `--save`, or to the default path; returns the path.
std::string save_scene(const CosimOptions& options, const Scene& scene);

/// Reduces the failing scene, saves it to `save_path` (creating its folder) and its waveform next to it.
struct SavedFinding {
  Finding finding;
  std::string capture, trace;  ///< files; trace is empty when there is none
  std::string repeat;          ///< command
  std::string failure;         ///< reason why the capture was not written; empty: written
};
[[nodiscard]] SavedFinding save_finding(const CosimOptions& options, const Config& config, Dut& dut,
                                        const Scene& failed, const Mismatch& mismatch, double seconds);

/// Prints the report for a person.
void print_finding(std::ostream& out, const SavedFinding& saved);

/// {stage, arrow, key, cycle, fields, repro, ...}.
[[nodiscard]] Json mismatch_json(const Mismatch& mismatch, const std::string& repeat);

}  // namespace halfplane
