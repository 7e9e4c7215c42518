// What random scenes are made of: the knobs of `--random-only`, and profiles of them in TOML.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/draw_states.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Knobs of random_scene(). Without any, scenes are those of the seed alone.
struct RandomProfile {
  /// The values that one state may have, each as likely.
  struct StateRule {
    const DrawState* row = nullptr;
    std::vector<StateValue> values;
  };
  enum class DepthOrder { random, flat, equal, front_to_back, back_to_front };
  /// Of a primitive's box, its longer side: pixels before corners are moved to pixel centres.
  struct Extent {
    int least = 0, most = 0;
  };

  std::array<bool, 3> kinds{};  ///< by PrimitiveType, as drawn by the program; none: all that the hardware has
  std::vector<StateRule> rules;
  bool has_clears = true;  ///< clears between draws; a scene begins with one in any case
  int width = 0, height = 0;
  std::optional<Extent> extent;
  /// Primitives per hundred: with all corners on pixel centres; that share an edge with the one before; on the corners of
  /// the one before.
  std::optional<int> ties, reuse, overlap;
  std::optional<DepthOrder> depth;      ///< random: any depth at any corner; else each primitive has one depth
  std::optional<int> textures, texels;  ///< textures of a scene; texels of a side, a power of two
  std::string text;                     ///< as written; empty: no knob

  [[nodiscard]] bool has_kinds() const { return kinds != std::array<bool, 3>{}; }
  [[nodiscard]] const StateRule* rule(std::string_view state) const;
};

/// Reads "triangles,less,16x16,no-scissor,size=1..64,FILE.toml". Throws InputError, one line that begins with
/// "--random-only" or the file, for an unknown knob or value, and for one that the configuration does not have.
[[nodiscard]] RandomProfile read_random_profile(const std::string& text, const Config& config);

/// Gives the profile's states one of their values in each draw of a finished scene, and changes states that this hardware
/// refuses together with them. From random numbers of its own, so that states alone change nothing else.
void apply_profile(Scene& scene, const Config& config, const RandomProfile& profile, std::uint64_t seed);

}  // namespace halfplane
