// Depth test: a fragment's depth code against the stored one.
//
// In: fragment and stored code. Out: pass or fail. Codes are unsigned integers; 0 is nearest with the default LESS.
#pragma once

#include <cstdint>

#include "../scene.hpp"

namespace halfplane {

template <DepthFunc Func, class Code>
[[nodiscard]] constexpr bool depth_passes(Code fragment, Code stored) {
  switch (Func) {
    case DepthFunc::never: return false;
    case DepthFunc::less: return fragment < stored;
    case DepthFunc::lequal: return fragment <= stored;
    case DepthFunc::equal: return fragment == stored;
    case DepthFunc::greater: return fragment > stored;
    case DepthFunc::gequal: return fragment >= stored;
    case DepthFunc::notequal: return fragment != stored;
    case DepthFunc::always: return true;
  }
}

/// The same, chosen at run time.
[[nodiscard]] constexpr bool depth_passes(DepthFunc func, std::uint32_t fragment, std::uint32_t stored) {
  switch (func) {
    case DepthFunc::never: break;
    case DepthFunc::less: return depth_passes<DepthFunc::less>(fragment, stored);
    case DepthFunc::lequal: return depth_passes<DepthFunc::lequal>(fragment, stored);
    case DepthFunc::equal: return depth_passes<DepthFunc::equal>(fragment, stored);
    case DepthFunc::greater: return depth_passes<DepthFunc::greater>(fragment, stored);
    case DepthFunc::gequal: return depth_passes<DepthFunc::gequal>(fragment, stored);
    case DepthFunc::notequal: return depth_passes<DepthFunc::notequal>(fragment, stored);
    case DepthFunc::always: return depth_passes<DepthFunc::always>(fragment, stored);
  }
  return false;
}

}  // namespace halfplane
