// The smallest configuration that keeps given errors on given scenes. Measured, not proven: another scene may need more.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Bounds for every scene. A missing bound is not checked, and no setting is reduced at its cost.
struct ErrorBounds {
  std::optional<double> depth;  ///< against the exact plane through the snapped vertices; part of the depth range
  std::optional<std::uint64_t> coverage;  ///< pixels missing or extra against the unsnapped scene
  std::optional<double>
      color;  ///< against the exact plane, LSB of the stored colour; over w, LSB of 8 bits before storage
  std::optional<double> texture;  ///< of texture coordinates against the exact ones, texels
  std::optional<double> fights;   ///< less than this fraction of the overlapping pairs of fragments may be out of order
};

/// The errors of a configuration on one scene, or the worst of several. Units as above.
struct SceneErrors {
  double depth = 0, color = 0, texture = 0;
  std::uint64_t coverage = 0;
  std::optional<double> fights;  ///< none: not measured, or the scene has no eye depths or no overlapping pairs
};

/// The cost of a configuration, in bits that depend on widths.
struct HardwareBits {
  long packets = 0;   ///< one register for every packet between stages
  long context = 0;   ///< the context RAM: context.slots times the constants of a primitive
  long products = 0;  ///< outputs of the multipliers of cull and triangle_setup, two of each kind
  long tiles = 0;     ///< depth, stencil and colour of cache.lines blocks, or tiles with cache.kind tiles
  long over_w = 0;    ///< planes of Q, u, v and the colours over w in the context RAM, and their divisions' products
  [[nodiscard]] long total() const { return packets + context + products + tiles + over_w; }
};
/// `has_over_w`: counts `over_w`, not needed for scenes without textures and colours over w.
[[nodiscard]] HardwareBits hardware_bits(const Config& config, bool has_over_w = false);

/// A configuration and its measurements.
struct TriedConfig {
  Config config;
  std::vector<SceneErrors> scenes;  ///< as far as measured: none after the first that breaks a bound
  std::string broken;               ///< the broken bound, one line; empty: every bound holds on every scene
  [[nodiscard]] bool holds() const { return broken.empty(); }
  [[nodiscard]] SceneErrors worst() const;
};

/// One setting of the smallest configuration and the effect of one step less.
struct OneLess {
  std::string_view key;
  int value = 0;          ///< in the smallest configuration
  bool is_fixed = false;  ///< no given bound depends on it, so it was not searched
  std::string broken;     ///< the bound broken with one bit less, or half the guard band; or why it cannot be less
};

struct Smallest {
  std::optional<TriedConfig> found;  ///< none: not even the widest configuration keeps the bounds
  TriedConfig widest;                ///< without scenes when a search ended early did not reach it
  std::vector<OneLess> one_less;
  int trials = 0;  ///< configurations measured
};

/// Searches depth.bits, plane.local_guard_bits, reciprocal.extra_bits, guard.band (up to the start's), subpixel.bits if
/// coverage is bounded, perspective.bits and perspective.mantissa_bits if textures are, or colours with some over w;
/// the rest of `start` stays. A setting on which no given bound depends is unchanged. Assumes that errors fall as
/// settings rise: a configuration below a failed one in every setting is not tried. Throws InputError when textures are
/// bounded and no scene has any, and when a scene cannot be drawn with `start` at all. `progress` is called with the
/// configurations measured, also within one. Interrupted, thrown there, ends the search: found is then the cheapest
/// success so far.
[[nodiscard]] Smallest find_smallest(const std::vector<Scene>& scenes, const Config& start, const ErrorBounds& bounds,
                                     const std::function<void(int trials)>& progress = {});

}  // namespace halfplane
