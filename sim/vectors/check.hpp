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
  std::uint64_t undefined = 0;          ///< bits of `got` without a value; they are 0 there
};

/// The first packet that differs; of several, the packet that the stage sends first.
struct FirstDifference {
  enum class Kind : std::uint8_t { differs, missing, extra };
  Kind kind = Kind::differs;
  std::size_t port = 0, number = 0;     ///< of the outputs
  std::vector<FieldDifference> fields;  ///< of a differing packet
  std::string hint;                     ///< one more line, or empty
};
inline constexpr std::array<std::string_view, 3> kDifferenceKinds{"differs", "missing", "extra"};

struct Judgement {
  std::vector<std::size_t> in;                   ///< packets taken, by port
  std::vector<std::size_t> compared, differing;  ///< output packets, by port; a lost or an extra one counts as one
  std::optional<FirstDifference> first;

  [[nodiscard]] std::size_t total_compared() const;
  [[nodiscard]] std::size_t total_differing() const;
};

/// Throws InputError for a stage that cannot be judged, and when an input ends too early. `sink` sees the packets of the
/// stage's arrows, inputs as they are taken, outputs as the specification sends them; null: nothing does.
[[nodiscard]] Judgement judge(const JudgedStage& stage, const Config& config, const StagePackets& packets,
                              PacketSink* sink = nullptr);

}  // namespace halfplane::vectors
