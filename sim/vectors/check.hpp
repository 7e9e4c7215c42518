// Check: compares the output of another implementation of a stage with the specification's output for the same input.
#pragma once

#include <optional>

#include "packets.hpp"

namespace halfplane::vectors {

/// A field on both sides.
struct FieldDifference {
  std::string name;
  int bits = 0;
  std::uint64_t expected = 0, got = 0;  ///< two's complement
  std::uint64_t undefined = 0;          ///< bits of `got` that have no value, and are 0 there
};

/// The first packet that is not as it should be, of those that differ the one that the stage gives first.
struct FirstDifference {
  enum class Kind : std::uint8_t { differs, missing, extra };
  Kind kind = Kind::differs;
  std::size_t port = 0, number = 0;     ///< of those that come out
  std::vector<FieldDifference> fields;  ///< of `differs`
  std::string hint;                     ///< one line more, or empty
};
inline constexpr std::array<std::string_view, 3> kDifferenceKinds{"differs", "missing", "extra"};

struct Judgement {
  std::vector<std::size_t> in;                   ///< packets taken, by port
  std::vector<std::size_t> compared, differing;  ///< packets that come out, by port; a lost or an extra one is one
  std::optional<FirstDifference> first;

  [[nodiscard]] std::size_t total_compared() const;
  [[nodiscard]] std::size_t total_differing() const;
};

/// Throws InputError for a stage that cannot be judged, and when what goes in ends too early.
[[nodiscard]] Judgement judge(const JudgedStage& stage, const Config& config, const StagePackets& packets);

}  // namespace halfplane::vectors
