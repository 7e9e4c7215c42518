// The first difference between RTL and model, as data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/cosim/arrows.hpp"

namespace halfplane {

struct Mismatch {
  enum class Kind {
    differs,   ///< a packet with other bits
    extra,     ///< a packet that the model does not send
    missing,   ///< a packet that the RTL never sends
    memory,    ///< the final memory image
    counters,  ///< the performance counters
    protocol,  ///< valid, ready or idle broke their rule
    cycle      ///< a packet comes in another cycle than the cycle model says
  };
  Kind kind = Kind::differs;
  std::string stage, arrow;                ///< the first suspect, and where it was seen
  std::string hint;                        ///< one line more, or empty
  std::vector<FieldPair> fields;           ///< all of them; one side is 0 when it has no packet
  std::uint64_t cycle = 0;                 ///< since reset
  std::uint64_t number = 0;                ///< of the packet on its arrow, from 0 at the scene's beginning
  std::optional<std::uint32_t> primitive;  ///< number of the input primitive; none for a clear, the flush, or unknown
  std::optional<std::uint64_t> tile_x, tile_y, stamp;

  /// Names of the fields that differ.
  [[nodiscard]] std::vector<std::string> differing() const {
    std::vector<std::string> names;
    for (const FieldPair& field : fields)
      if (field.differs()) names.push_back(field.name);
    return names;
  }
};

}  // namespace halfplane
