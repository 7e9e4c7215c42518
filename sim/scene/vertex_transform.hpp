// From world to clip space in binary64, binary32, or 32-bit fixed point. The next step is host_geometry.hpp; the errors
// of lower precision are measured in sim/study/compare/transform_errors.hpp.
#pragma once

#include <cstdint>
#include <string_view>

#include "sim/scene/camera.hpp"

namespace halfplane {

enum class TransformNumbers : std::uint8_t { binary64, binary32, s15_16 };

/// Reads --transform: `binary64`, `binary32` or `s15.16`. Throws InputError for anything else.
[[nodiscard]] TransformNumbers parse_transform(std::string_view text);

/// The nearest s15.16, halves up: a sign, 15 bits, 16 fraction bits. Throws InputError on overflow.
[[nodiscard]] std::int64_t to_s15_16(double v);
[[nodiscard]] double from_s15_16(std::int64_t v);

/// View and projection, one after the other, as in fixed-function hardware. Matrices and vertices are rounded once, and
/// so is every result: in binary32 each product and sum, in s15.16 (a sign, 15 bits, 16 fraction bits) the sum of four
/// exact products.
class VertexTransform {
 public:
  VertexTransform(const Mat4& view, const Mat4& projection, TransformNumbers numbers);

  /// Clip coordinates of a point of the world. Throws InputError for a number that does not fit s15.16.
  [[nodiscard]] Vec4 clip(const Vec3& world) const;

 private:
  Mat4 view_, projection_;
  TransformNumbers numbers_;
};

}  // namespace halfplane
