// The planes that compare and stress judge: those of the one list (model/attributes.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "model/attributes.hpp"
#include "model/packets/packets.hpp"

namespace halfplane {

/// Plane i of TappedFragment::plane.
struct JudgedPlane {
  std::string_view name;
  int bits = 0;           ///< of a code
  bool is_depth = false;  ///< its bound is depth_error_bound() or line_depth_error_bound(); of all others 1 LSB
  bool is_color = false;  ///< a channel of the stored colour
};

/// All that is interpolated.
[[nodiscard]] inline std::vector<JudgedPlane> judged_planes(const Config& config) {
  std::vector<JudgedPlane> planes;
  for (const Attribute& a : attributes_of(config))
    for (int i = 0; i < a.planes; ++i)
      planes.push_back(
          {a.part[static_cast<std::size_t>(i)], a.bits, a.stored == StoredAs::depth, a.stored == StoredAs::color});
  return planes;
}

/// The codes of judged_planes()[plane] at the vertices.
[[nodiscard]] inline std::array<std::uint32_t, 3> plane_codes(const Triangle& triangle, std::size_t plane) {
  return {triangle.v[0].code[plane], triangle.v[1].code[plane], triangle.v[2].code[plane]};
}

}  // namespace halfplane
