// What `halfplane depth` works out, between its options and its files: questions, rows, the study of a scene, and how they
// are written.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "sim/cli/options.hpp"
#include "sim/study/depth/answers.hpp"
#include "sim/study/depth/exact_depth.hpp"
#include "sim/study/depth/two_planes.hpp"

namespace halfplane {

/// One line of the result, as in the CSV.
struct DepthRow {
  std::string mapping, format, near, far, z, metric;
  double value;
};

/// What the options ask for, read.
struct DepthQuestion {
  Config config;
  Rational near, far;
  std::string near_text, far_text;
  DepthPlanes planes{};  ///< the same, to the nearest binary64
  std::vector<DepthMapping> mappings;
  std::vector<DepthFormat> formats;
  std::vector<std::string> z;
  std::optional<Rational> low, high;  ///< --range
  std::optional<double> length;       ///< --error
  double fight_rate = 0.01;           ///< --fight-rate
  std::optional<SurfaceView> view;    ///< --slope
  std::uint64_t seed = 1;
};

/// What a scene adds: measurements, trials, sweeps, pictures.
struct SceneStudy {
  std::vector<DepthMeasurement> measured;
  std::vector<DepthTrial> trials;
  std::vector<DepthSweep> sweeps;
  std::vector<FewestBits> fewest;    ///< of each mapping; empty where nothing overlaps
  std::vector<std::string> answers;  ///< with the fewest bits first, where they are known
};

// depth_rows.cpp

/// The shortest decimal that reads back, or "inf"; and three digits for people.
[[nodiscard]] std::string depth_number(double value);
[[nodiscard]] std::string short_text(double value);
[[nodiscard]] std::string mapping_name(DepthMapping mapping);

/// The theory of one mapping and format, with the part done to `progress`; what a scene measured, of the whole with an empty
/// z, of a decade with the z that it begins at.
void add_theory_rows(const DepthQuestion& question, DepthMapping mapping, const DepthFormat& format,
                     const std::function<void(double)>& progress, std::vector<DepthRow>& rows);
void add_measured_rows(const DepthQuestion& question, const DepthVariant& variant, const DepthMeasurement& m,
                       std::vector<DepthRow>& rows);
void add_fewest_rows(const DepthQuestion& question, const std::vector<FewestBits>& fewest, std::vector<DepthRow>& rows);

/// Which mapping keeps every step of the range below the length with the fewest bits: as integers, and as reversed floats.
[[nodiscard]] std::vector<std::string> length_answers(const DepthQuestion& question);

[[nodiscard]] std::string depth_csv(const std::vector<DepthRow>& rows);
void print_theory(std::ostream& out, const std::vector<DepthRow>& rows);
void print_measured(std::ostream& out, const std::vector<DepthVariant>& variants, const SceneStudy& study);

// depth_page.cpp

/// rows, series, trials, sweeps, answers: what the JSON and the page have in common.
[[nodiscard]] Json study_json(const DepthQuestion& question, const std::vector<DepthRow>& rows,
                              const std::vector<DepthVariant>& variants, const SceneStudy& study);

/// Where pictures and the page go; "" for none.
struct DepthPaths {
  std::string page, heat, fights;
};

/// Writes the files that are asked for. `scene` may be null.
void write_depth_files(const DepthPaths& paths, const std::string& title, const DepthQuestion& question,
                       const Json& result, const Scene* scene, const std::vector<DepthVariant>& variants,
                       const SceneStudy& study);

}  // namespace halfplane
