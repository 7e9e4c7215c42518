// What `compare` says of another rasterizer's image: options, results, panels, JUnit.
#pragma once

#include <string>
#include <vector>

#include "sim/cli/options.hpp"
#include "sim/cosim/junit.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/study/compare/against.hpp"

namespace halfplane {

/// As typed.
struct AgainstWords {
  std::string path;       ///< of the image; empty: none
  std::string tolerance;  ///< "color=1,depth=1"
  int listed = 10;        ///< pixels
  bool has_listed = false;
};

/// Adds --against, --tolerance and --first.
void add_against_options(CLI::App& app, AgainstWords& words);

/// Throws InputError for a tolerance that is none, and for options of an image without one.
[[nodiscard]] Tolerance parse_tolerance(const AgainstWords& words);

/// An image with what came of it.
struct JudgedImage {
  std::string path;
  ForeignImage image;
  Tolerance tolerance;
  AgainstResult result;
};

[[nodiscard]] Json against_json(const JudgedImage& judged);

/// For people, the verdict last.
[[nodiscard]] std::vector<std::string> against_lines(const JudgedImage& judged);

/// The pixels that are listed. `explain`: the command that explains a pixel, without its column and row.
[[nodiscard]] std::vector<std::string> difference_lines(const JudgedImage& judged, const std::string& explain);

/// As kAgainstPanelNames has them.
[[nodiscard]] std::vector<NamedPanel> against_panels(const JudgedImage& judged);

/// One case: the image is equal, or the pixels that differ.
[[nodiscard]] JunitCase against_case(const JudgedImage& judged);

}  // namespace halfplane
