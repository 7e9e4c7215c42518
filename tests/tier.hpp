// How long a random test runs: docs/testing.md.
#pragma once

#include <cstdlib>

namespace halfplane::test {

/// Whether this is `./dev test --all`, which sets HALFPLANE_ALL.
inline bool runs_all() { return std::getenv("HALFPLANE_ALL") != nullptr; }

/// Cases of a random test: `everyday` in `./dev test`, `all` in `./dev test --all`.
template <class Number>
Number cases(Number everyday, Number all) {
  return runs_all() ? all : everyday;
}

}  // namespace halfplane::test
