// The comparison with another rasterizer's image in `compare`: options, results, panels, JUnit.
#pragma once

#include <string>
#include <vector>

#include "sim/cli/options.hpp"
#include "sim/cli/study_options.hpp"
#include "sim/cosim/junit.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/study/compare/against.hpp"

namespace halfplane {

/// Options as typed.
struct AgainstWords {
  std::string path;       ///< path of the image; empty: none
  std::string tolerance;  ///< "color=1,depth=1"
  int listed = 10;        ///< pixels
  bool has_listed = false;
};

/// Adds --against, --tolerance and --first.
void add_against_options(CLI::App& app, AgainstWords& words);

/// Throws InputError for an invalid tolerance, and for options of an image without one.
[[nodiscard]] Tolerance parse_tolerance(const AgainstWords& words);

/// An image with its verdict.
struct JudgedImage {
  std::string path;
  ForeignImage image;
  Tolerance tolerance;
  AgainstResult result;
};

[[nodiscard]] Json against_json(const JudgedImage& judged);

/// Lines for people, the verdict last.
[[nodiscard]] std::vector<std::string> against_lines(const JudgedImage& judged);

/// The listed pixels. `explain`: the command that explains a pixel, without its column and row.
[[nodiscard]] std::vector<std::string> difference_lines(const JudgedImage& judged, const std::string& explain);

/// The panels of kAgainstPanelNames.
[[nodiscard]] std::vector<NamedPanel> against_panels(const JudgedImage& judged);

/// One case: the image is equal, or the pixels differ.
[[nodiscard]] JunitCase against_case(const JudgedImage& judged);

// `compare FOLDER --against FOLDER`: each scene of a folder against another rasterizer's image of the same name.

/// What `compare` was told about it.
struct CompareFolder {
  const CommonOptions& common;
  const StudyOptions& study;
  const AgainstWords& against;
  const std::string& junit_path;
};

/// Compares every scene file of the folder with NAME.png, NAME.npy, or both. An image that is missing, or of another size,
/// is a failure of its scene, and so is a bound that the model breaks. Returns the exit status.
[[nodiscard]] int compare_folder(const CompareFolder& options);

}  // namespace halfplane
