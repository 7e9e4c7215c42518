// `compare FOLDER --against FOLDER`: each scene of a folder against another rasterizer's image of the same name.
#pragma once

#include <string>

#include "sim/cli/compare_against.hpp"
#include "sim/cli/study_options.hpp"

namespace halfplane {

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
