#include "sim/scene/vertex_transform.hpp"

#include <cmath>

#include "model/fixed.hpp"
#include "model/input_error.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr int kFractionBits = 16;

Vec4 times_s15_16(const Mat4& matrix, const Vec4& point) {
  Vec4 result{};
  for (std::size_t row = 0; row < 4; ++row) {
    int128 sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += int128{to_s15_16(matrix[row][i])} * to_s15_16(point[i]);
    result[row] = from_s15_16(static_cast<std::int64_t>((sum + (int128{1} << (kFractionBits - 1))) >> kFractionBits));
  }
  return result;
}

Vec4 times_binary32(const Mat4& matrix, const Vec4& point) {
  Vec4 result{};
  for (std::size_t row = 0; row < 4; ++row) {
    float sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const float product = static_cast<float>(matrix[row][i]) * static_cast<float>(point[i]);
      sum += product;
    }
    result[row] = static_cast<double>(sum);
  }
  return result;
}

}  // namespace

TransformNumbers parse_transform(std::string_view text) {
  if (text == "binary64") return TransformNumbers::binary64;
  if (text == "binary32") return TransformNumbers::binary32;
  if (text == "s15.16") return TransformNumbers::s15_16;
  throw InputError("--transform: " + in_quotes(text) + " is unknown; write binary64, binary32 or s15.16");
}

std::int64_t to_s15_16(double v) {
  const double scaled = std::floor(std::ldexp(v, kFractionBits) + 0.5);
  if (!(scaled >= -2147483648.0 && scaled <= 2147483647.0))
    throw InputError(
        "--transform s15.16: a coordinate of this scene or camera is beyond +-32768; scale the model down, " +
        std::string("or take binary32"));
  return static_cast<std::int64_t>(scaled);
}

double from_s15_16(std::int64_t v) { return std::ldexp(static_cast<double>(v), -kFractionBits); }

VertexTransform::VertexTransform(const Mat4& view, const Mat4& projection, TransformNumbers numbers)
    : view_(view), projection_(projection), numbers_(numbers) {}

Vec4 VertexTransform::clip(const Vec3& world) const {
  const Vec4 point{world[0], world[1], world[2], 1};
  switch (numbers_) {
    case TransformNumbers::binary32: return times_binary32(projection_, times_binary32(view_, point));
    case TransformNumbers::s15_16: return times_s15_16(projection_, times_s15_16(view_, point));
    case TransformNumbers::binary64: break;
  }
  return transform(projection_, transform(view_, point));
}

}  // namespace halfplane
