// The class of a pixel by its coverage in model and golden.
#pragma once

#include <cstdint>

namespace halfplane {

enum class CoverageClass : std::uint8_t {
  none,     ///< neither covers it
  both,     ///< equally often, with the same triangle visible
  missing,  ///< the golden covers it more often
  extra,    ///< the model covers it more often
  other     ///< equally often, but another triangle is visible
};

}  // namespace halfplane
