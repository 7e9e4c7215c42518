// The study of `halfplane depth`, between its options and its files: questions, rows, the study of a scene, and their
// output.
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

/// The parsed options.
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

/// Results of a scene: measurements, trials, sweeps, pictures.
struct SceneStudy {
  std::vector<DepthMeasurement> measured;
  std::vector<DepthTrial> trials;
  std::vector<DepthSweep> sweeps;
  std::vector<FewestBits> fewest;    ///< for each mapping; empty without overlaps
  std::vector<std::string> answers;  ///< with the fewest bits first, if known
};

// depth_rows.cpp

/// The shortest decimal that reads back, or "inf"; and with three digits for people.
[[nodiscard]] std::string depth_number(double value);
[[nodiscard]] std::string short_text(double value);
[[nodiscard]] std::string mapping_name(DepthMapping mapping);

/// The theory of one mapping and format, reporting the fraction done to `progress`; measurements of a scene, for the
/// whole with an empty z, for a decade with its first z.
void add_theory_rows(const DepthQuestion& question, DepthMapping mapping, const DepthFormat& format,
                     const std::function<void(double)>& progress, std::vector<DepthRow>& rows);
void add_measured_rows(const DepthQuestion& question, const DepthVariant& variant, const DepthMeasurement& m,
                       std::vector<DepthRow>& rows);
void add_fewest_rows(const DepthQuestion& question, const std::vector<FewestBits>& fewest, std::vector<DepthRow>& rows);

/// The mapping that keeps every step of the range below the length with the fewest bits: as integers, and as reversed
/// floats.
[[nodiscard]] std::vector<std::string> length_answers(const DepthQuestion& question);

[[nodiscard]] std::string depth_csv(const std::vector<DepthRow>& rows);
void print_theory(std::ostream& out, const std::vector<DepthRow>& rows);
void print_measured(std::ostream& out, const std::vector<DepthVariant>& variants, const SceneStudy& study);

// depth_page.cpp

/// rows, series, trials, sweeps, answers: the common part of the JSON and the page.
[[nodiscard]] Json study_json(const DepthQuestion& question, const std::vector<DepthRow>& rows,
                              const std::vector<DepthVariant>& variants, const SceneStudy& study);

/// Files for pictures and the page; "" for none.
struct DepthPaths {
  std::string page, heat, fights;
};

/// Writes the requested files. `scene` may be null.
void write_depth_files(const DepthPaths& paths, const std::string& title, const DepthQuestion& question,
                       const Json& result, const Scene* scene, const std::vector<DepthVariant>& variants,
                       const SceneStudy& study);

}  // namespace halfplane
