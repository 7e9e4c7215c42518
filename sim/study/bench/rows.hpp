// Run time against error: engines, configurations and scenes, side by side.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/scene.hpp"
#include "sim/study/bench/turns.hpp"

namespace halfplane {

/// A scene under a configuration.
struct BenchCase {
  std::string scene_name;
  std::shared_ptr<const Scene> scene;
  Config config;
  std::string variation;  ///< difference from the base configuration, "depth.bits=24 subpixel.bits=8"; empty: none
};

/// The error of a case: a part of Comparison, in its units.
struct BenchErrors {
  // None if no pixel was compared.
  std::optional<double> depth_lsb_max,
      depth_lsb_rms;  ///< LSB of depth.bits: a different length in every row that varies it
  std::optional<double> depth_range_max, depth_range_rms;  ///< the same as fractions of the depth range
  std::optional<double> depth_eye_max, depth_eye_rms;      ///< eye-space units: comparable between mappings too
  std::optional<double> color_lsb_max, color_lsb_rms;
  std::uint64_t coverage_mismatches = 0;                   ///< samples, against the exact oracle on snapped vertices
  std::uint64_t coverage_missing = 0, coverage_extra = 0;  ///< samples, against the golden on unsnapped ones
};

/// Data of a case common to all engines.
struct BenchFacts {
  Counters counters;    ///< with nothing skipped: every engine's rates count the same fragments
  double coverage = 0;  ///< fraction of covered pixels
  std::optional<BenchErrors> errors;
};

struct BenchRow {
  std::string engine;
  int threads = 1;
  std::size_t case_index = 0;
  FrameTimes times;
  BenchFacts facts;  ///< no errors for the golden, for engines not compared, or if not wanted

  [[nodiscard]] double mtri_s() const;        ///< millions of input primitives
  [[nodiscard]] double mpix_s() const;        ///< millions of covered samples
  [[nodiscard]] double cycles_per_s() const;  ///< hardware cycles simulated; 0: none
};

struct BenchPlan {
  std::vector<std::string> engines;
  std::vector<int> threads{1};  ///< for engines that use threads
  int repeat = 5;
  bool wants_errors = true;
  std::function<void(double)> progress;  ///< 0...1; may be empty. Interrupted, thrown there, ends the study
  std::function<void()> poll;            ///< called inside long frames; its exceptions end the study; may be empty
  /// Called for unsupported features of an engine: the engine, and one line with the reason. May be empty.
  std::function<void(const std::string& engine, const std::string& line)> left_out;
};

/// Measures every engine on every case; llvmpipe, which has no configuration, on the first case of each scene.
/// Unsupported combinations are left out. Throws the first reason when nothing is left, and std::runtime_error when
/// llvmpipe is requested and missing. A study ended early returns the rows with a measured frame.
[[nodiscard]] std::vector<BenchRow> measure_rows(std::span<const BenchCase> cases, const BenchPlan& plan);

/// Counters, coverage and, if wanted, errors. Throws InputError as render_functional().
[[nodiscard]] BenchFacts find_facts(const Scene& scene, const Config& config, bool wants_errors,
                                    const std::function<void(double)>& progress = {});

}  // namespace halfplane
