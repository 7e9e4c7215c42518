// Golden depth test, on real depth.
#pragma once

#include "../scene.hpp"

namespace halfplane::golden {

template <class Real>
[[nodiscard]] bool passes(DepthFunc function, Real fragment, Real stored) {
  switch (function) {
    case DepthFunc::never: return false;
    case DepthFunc::less: return fragment < stored;
    case DepthFunc::lequal: return fragment <= stored;
    case DepthFunc::equal: return fragment == stored;
    case DepthFunc::greater: return fragment > stored;
    case DepthFunc::gequal: return fragment >= stored;
    case DepthFunc::notequal: return fragment != stored;
    case DepthFunc::always: return true;
  }
  return false;
}

}  // namespace halfplane::golden
