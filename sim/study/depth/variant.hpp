// One way to keep depth: a mapping, a format, and the configuration that has them.
#pragma once

#include <string>

#include "model/config.hpp"
#include "model/stages/depth_encode.hpp"

namespace halfplane {

struct DepthVariant {
  DepthMapping mapping = DepthMapping::std;
  DepthFormat format;  ///< never `plane`
  DepthPlanes planes{1, 1000};
  Config config;  ///< with mapping, format and the interpolated depth's bits

  /// "std u16".
  [[nodiscard]] std::string name() const;
};

/// Bits of the plane that a format's codes are made from: as many where it is stored as it is, of a mapping that is affine on
/// the screen; else four more, of floats 32, and `more`; 32 at most.
[[nodiscard]] int interpolated_bits(const DepthFormat& format, bool is_linear, int more);

/// The mapping and format on top of `config`. Bits of the interpolated depth: those of the format where it can be stored
/// as it is (u<b> of 8 bits and more under a mapping that is affine on the screen); else enough for the format's finest
/// step at far, 32 at most. Throws InputError as validate() does.
[[nodiscard]] DepthVariant make_variant(const Config& config, DepthMapping mapping, const DepthFormat& format,
                                        const DepthPlanes& planes);

/// What hardware pays for it, in a few words.
[[nodiscard]] std::string hardware_cost(const DepthVariant& variant);

}  // namespace halfplane
