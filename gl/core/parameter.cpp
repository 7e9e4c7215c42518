#include "parameter.hpp"

#include <algorithm>
#include <array>
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

/// The place that a name has in any command with Params, in no context's state.
std::optional<Place> any_place(GLenum pname) {
  static State state;
  static TextureParameters texture;
  constexpr std::array<std::optional<Place> (*)(GLenum), 8> kPlaces{
      [](GLenum name) { return material_place(state.lighting.material[0], name); },
      [](GLenum name) { return light_place(state.lighting.light[0], name); },
      [](GLenum name) { return light_model_place(state.lighting, name); },
      [](GLenum name) { return fog_place(state.fog, name); },
      [](GLenum name) { return point_place(state.point, name); },
      [](GLenum name) { return environment_place(state.texture.unit[0], GL_TEXTURE_ENV, name); },
      [](GLenum name) { return generation_place(state.texture.unit[0], GL_S, name); },
      [](GLenum name) { return texture_place(texture, name); }};
  for (const auto& place_of : kPlaces)
    if (const auto place = place_of(pname)) return place;
  return std::nullopt;
}

}  // namespace

std::size_t param_count(GLenum pname) {
  const auto count = []<class T>(const T*) -> std::size_t {
    if constexpr (requires { std::tuple_size<T>::value; }) return std::tuple_size_v<T>;
    return 1;
  };
  const auto place = any_place(pname);
  return place ? std::visit(count, place->where) : 1;
}

bool is_unscaled(GLenum pname) {
  const auto is_whole = []<class T>(const T*) {
    return std::is_same_v<T, GLenum> || std::is_same_v<T, bool> || std::is_same_v<T, std::array<int, 4>>;
  };
  const auto place = any_place(pname);
  return place && std::visit(is_whole, place->where);
}

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
