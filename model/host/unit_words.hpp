// The state of the texture, fog, light, colour and stencil units that a primitive needs: what the host stream fills in,
// frames in bins keep and compare, and the hardware receives as tokens.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "../packets/state_packets.hpp"
#include "../signature.hpp"

namespace halfplane {

struct DrawContext;    // primitives.hpp
struct HostPrimitive;  // host_primitive.hpp
struct Scene;
struct Triangle;

/// The words of a unit's registers and table, each with a register of its own; shared by the primitives of a draw. Of a
/// unit that is off the first one alone.
using RegisterWords = std::shared_ptr<const std::vector<std::uint64_t>>;

inline constexpr std::size_t kMostUnitTables = 4;

/// The unit registers that a primitive needs, as words of tokens.
struct UnitWords {
  std::uint64_t texture_state = 0;                  ///< of a triangle: TextureState
  std::uint32_t texture_levels = 0;                 ///< likewise TextureLevels
  std::optional<TextureLines> texture_lines{};      ///< if its samples have a level of detail
  std::optional<std::uint64_t> texture_constant{};  ///< if it blends by its texels: TextureConstant
  std::optional<std::uint64_t> texture_border{};    ///< if a side of it has one: TextureBorder
  /// Of the units beside the texture in the order of their tokens; null: the primitive does not read that unit.
  std::array<RegisterWords, kMostUnitTables> tables{};
  ColorWords colors{};     ///< of the draw
  StencilWords stencil{};  ///< likewise; for a fast clear: its value
  Signature texels{};      ///< of the texture of a triangle, where bins are compared
};

/// Adds everything that pixels depend on to a hash.
class UnitSignatures {
 public:
  void add(const UnitWords& units, SignatureHash& hash);

 private:
  /// The signature of words is computed again only when they are others.
  struct Known {
    RegisterWords words;
    Signature signature;
  };
  std::array<Known, kMostUnitTables> known_;
};

/// The host's part of the units in the stream of stamps: what a triangle needs of them, and the registers that the host
/// has set since the scene began; before that their content is unknown.
class HostUnits {
 public:
  using Send = std::function<void(StateRegister which, uint128 word)>;

  /// All arguments must outlive this.
  HostUnits(const Scene& scene, const Config& config, const Widths& widths);
  ~HostUnits();
  /// Fills in a triangle's planes over w, and the words of the units. `is_compared`: bins are, so the content of its
  /// texture counts. Throws InputError for a w that is not positive.
  void fill(const DrawContext& context, const Triangle& triangle, bool is_compared, HostPrimitive& out);
  /// Calls `send` for each register that has another value than a primitive needs, in the order of the tokens.
  void set_for(PrimitiveKind kind, const UnitWords& units, const Send& send);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace halfplane
