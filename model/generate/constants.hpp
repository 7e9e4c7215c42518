// Constants that follow from a configuration, for the files that are generated from it: raster_pkg.sv and the C header.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "../widths.hpp"

namespace halfplane {

/// A constant that is no width of Widths::all().
struct DerivedConstant {
  std::string name;  ///< "GRID_BITS"
  long long value;
  std::string why;
};
[[nodiscard]] std::vector<DerivedConstant> derived_constants(const Config& config, const Widths& widths);

/// "edge value" and "depth.bits" in capitals, with _ between words.
[[nodiscard]] std::string constant_name(std::string_view name);

/// The value of a setting as a number; for one with names, the number of its name.
[[nodiscard]] long long number_of(const Setting& setting, std::string_view value);

/// The word for a member of AttributeWidths in the names of its tables: CODE_BITS_OF, CODE_AT, ALL_CODE_BITS.
struct PlaneTable {
  const char* word;
  Width AttributeWidths::*width;
  const char* what;
};
inline constexpr PlaneTable kPlaneTables[] = {{"CODE", &AttributeWidths::code, "codes"},
                                              {"RECIPROCAL", &AttributeWidths::reciprocal, "reciprocals of the area"},
                                              {"PLANE", &AttributeWidths::plane, "values and gradients"},
                                              {"LOCAL", &AttributeWidths::local, "values and gradients inside a tile"},
                                              {"STEP", &AttributeWidths::step, "gradients per pixel inside a tile"},
                                              {"FRAGMENT", &AttributeWidths::fragment, "values of a sample"},
                                              {"AFFINE_CODE", &AttributeWidths::affine_code, "codes that are clamped"},
                                              {"LINE", &AttributeWidths::line, "values along a line"}};

}  // namespace halfplane
