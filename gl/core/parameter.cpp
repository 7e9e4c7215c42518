#include "parameter.hpp"

#include <algorithm>
#include <cmath>

#include "matrix.hpp"

namespace halfplane::gl {
namespace {

int rounded(double value) {
  using Limits = std::numeric_limits<int>;
  if (std::isnan(value)) return 0;
  return static_cast<int>(std::clamp(std::round(value), double{Limits::min()}, double{Limits::max()}));
}

/// Sets a place; the error.
GLenum assign(const Place& place, const Params& params, bool takes_scalars) {
  const Vec4 value = place.kind == ValueKind::color ? color_of(params) : params.value;
  const bool is_bounded = std::isfinite(place.low) || std::isfinite(place.high);
  const auto is_legal = [&place, is_bounded](double v) {
    return !is_bounded || (v >= place.low && v <= place.high) || v == place.also;
  };
  const auto in_range = [&place](double v) { return place.is_held ? held(v) : v; };
  if (GLenum* const* name = std::get_if<GLenum*>(&place.where)) {
    const auto found = std::ranges::find_if(place.allowed, [&value](GLenum allowed) { return value[0] == allowed; });
    if (found == place.allowed.end()) return GL_INVALID_ENUM;
    **name = *found;
  } else if (int* const* number = std::get_if<int*>(&place.where)) {
    if (!is_legal(rounded(value[0]))) return GL_INVALID_VALUE;
    **number = rounded(value[0]);
  } else if (bool* const* flag = std::get_if<bool*>(&place.where)) {
    **flag = value[0] != 0;
  } else if (double* const* real = std::get_if<double*>(&place.where)) {
    if (!is_legal(value[0])) return GL_INVALID_VALUE;
    **real = in_range(value[0]);
  } else if (!params.is_vector && !takes_scalars) {
    return GL_INVALID_ENUM;
  } else if (Vec3* const* three = std::get_if<Vec3*>(&place.where)) {
    **three = {value[0], value[1], value[2]};
  } else if (Vec4* const* four = std::get_if<Vec4*>(&place.where)) {
    std::ranges::transform(value, (*four)->begin(), in_range);
  } else {
    std::ranges::transform(value, std::get<std::array<int, 4>*>(place.where)->begin(), rounded);
  }
  return GL_NO_ERROR;
}

}  // namespace

bool set_parameter(Context& context, const std::optional<Place>& place, const Params& params, bool takes_scalars) {
  const GLenum error = place ? assign(*place, params, takes_scalars) : GLenum{GL_INVALID_ENUM};
  if (error != GL_NO_ERROR) context.fail(error);
  return error == GL_NO_ERROR;
}

Values parameter(Context& context, const std::optional<Place>& place) {
  if (!place) return context.fail(GL_INVALID_ENUM), Values{};
  const auto values = [&place]<class T>(const T* where) -> Values {
    if constexpr (std::is_same_v<T, bool>)
      return {ValueKind::boolean, {*where ? 1.0 : 0.0}};
    else if constexpr (std::is_integral_v<T>)
      return {ValueKind::integer, {static_cast<double>(*where)}};
    else if constexpr (std::is_same_v<T, double>)
      return {place->kind, {*where}};
    else
      return {std::is_same_v<T, std::array<int, 4>> ? ValueKind::integer : place->kind, {where->begin(), where->end()}};
  };
  return std::visit(values, place->where);
}

}  // namespace halfplane::gl
