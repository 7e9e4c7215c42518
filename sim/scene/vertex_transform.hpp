// From world to clip space in binary64, binary32, or 32-bit fixed point. The next step is host_geometry.hpp; the errors of the
// smaller numbers are measured in sim/study/compare/transform_errors.hpp.
#pragma once

#include <cstdint>
#include <string_view>

#include "model/config.hpp"
#include "sim/scene/camera.hpp"

namespace halfplane {

enum class TransformNumbers : std::uint8_t { binary64, binary32, s15_16 };

/// Reads --transform: `binary64`, `binary32` or `s15.16`. Throws InputError for anything else.
[[nodiscard]] TransformNumbers parse_transform(std::string_view text);

/// The nearest s15.16, halves up: a sign, 15 bits, 16 behind the point. Throws InputError beyond them.
[[nodiscard]] std::int64_t to_s15_16(double v);
[[nodiscard]] double from_s15_16(std::int64_t v);

/// View and projection, one after the other, as fixed-function hardware had them. Matrices and vertices are rounded once,
/// and so is every result: of binary32 each product and sum, of s15.16 (a sign, 15 bits, 16 behind the point) the sum of
/// four exact products.
class VertexTransform {
 public:
  VertexTransform(const Mat4& view, const Mat4& projection, TransformNumbers numbers);

  /// Clip coordinates of a point of the world. Throws InputError for a number that s15.16 cannot hold.
  [[nodiscard]] Vec4 clip(const Vec3& world) const;

 private:
  Mat4 view_, projection_;
  TransformNumbers numbers_;
};

}  // namespace halfplane
