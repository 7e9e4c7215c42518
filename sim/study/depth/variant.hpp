// One way to store depth: a mapping, a format, and a configuration with both.
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

/// Bits of the interpolated plane for a format: equal if it is stored unchanged, with a mapping that is affine on the
/// screen; else four more, for floats 32, plus `more`; at most 32.
[[nodiscard]] int interpolated_bits(const DepthFormat& format, bool is_linear, int more);

/// The mapping and format on top of `config`. Bits of the interpolated depth: the format's bits if it can be stored
/// unchanged (u<b> of 8 bits and more under a mapping that is affine on the screen); else enough for the format's
/// finest step at far, 32 at most. Throws InputError as validate() does.
[[nodiscard]] DepthVariant make_variant(const Config& config, DepthMapping mapping, const DepthFormat& format,
                                        const DepthPlanes& planes);

/// Its hardware cost, in a few words.
[[nodiscard]] std::string hardware_cost(const DepthVariant& variant);

}  // namespace halfplane
