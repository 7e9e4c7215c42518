// What a run has hit.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cover/state_pairs.hpp"

namespace halfplane::cover {

/// Hits of all bins (bins.hpp), in their order, and of pairs of states.
struct Hits {
  std::vector<std::uint64_t> bins;
  PairCounts pairs{all_dimensions()};

  /// None yet.
  Hits();
  /// The table of dimensions(), once.
  [[nodiscard]] static const std::vector<Dimension>& all_dimensions();
};

}  // namespace halfplane::cover
