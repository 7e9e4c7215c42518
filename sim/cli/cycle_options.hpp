// Options and output of `render --engine cycle` beyond the options and output of every engine.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "sim/cli/memory_options.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane {

struct CycleCommandOptions {
  MemorySettings memory;
  std::vector<std::string> timing;   ///< key=value
  std::vector<std::string> what_if;  ///< key=value,value...
  double stalls = 0;
  bool explain = false;
  std::string primitives_path, trace_path, heat_path, misses_path;

  /// The given options that only this engine has, for a message; empty: none.
  [[nodiscard]] std::string given() const;
};

/// Adds the options of this engine only.
void add_cycle_options(CLI::App& app, CycleCommandOptions& options);

/// Throws InputError for options that can be refused before a scene is read.
void check_cycle_options(const CycleCommandOptions& options, const Config& config);

/// The hardware of --set, --timing and --memory. Throws InputError.
[[nodiscard]] Hardware hardware_of(const CycleCommandOptions& options, const Config& config);

/// A run of the engine, and its analysis.
struct CycleResult {
  Hardware hardware;
  double stalls = 0;
  CycleRendering frame;
  std::vector<Trial> reliefs;      ///< only when explained
  std::vector<Saving> savings;     ///< likewise
  std::vector<OrderTrial> orders;  ///< likewise, of blocks
  bool is_explained = false;
  struct Row {
    std::string key, value;
    CycleRun run;
    double ms = 0;  ///< at its clock
    std::uint64_t bytes = 0;
    bool same_picture = true;
  };
  std::vector<Row> rows;  ///< of --what-if
};

/// Renders, writes the files that the options name, explains (on request, or if the frame has few cycles) and varies.
[[nodiscard]] CycleResult run_cycle_engine(const CommonOptions& common, const CycleCommandOptions& options,
                                           const Scene& scene, const Config& config, RenderOptions render);

/// Adds cycles, stages, memory, skipped savings, what_if to a result.
void add_cycle_json(Json& result, const CycleResult& cycle);

/// The same for people.
void print_cycles(std::ostream& out, const CycleResult& cycle);

}  // namespace halfplane
