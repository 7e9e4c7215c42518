// Texture environments (OpenGL 1.5, 3.8.13), a channel at a time, over numbers (host_shader.cpp) or what becomes of any number
// (texture_upload.cpp).
#pragma once

#include "state.hpp"

namespace halfplane::gl {

/// Table 3.23, before the scale. `source(name, channel)`: a channel of a source; one that an operand takes for another channel
/// is the third argument.
template <class Value, class Source>
Value combined(const TextureCombiner& combiner, std::size_t channel, const Source& source) {
  const auto arg = [&](std::size_t i, std::size_t to) -> Value {  // tables 3.24 and 3.25
    const GLenum operand = combiner.operand[i];
    const bool takes_alpha = operand == GL_SRC_ALPHA || operand == GL_ONE_MINUS_SRC_ALPHA;
    const Value value = source(combiner.source[i], takes_alpha ? 3 : to, to);
    return operand == GL_ONE_MINUS_SRC_COLOR || operand == GL_ONE_MINUS_SRC_ALPHA ? 1 - value : value;
  };
  const Value first = arg(0, channel);
  switch (combiner.function) {
    case GL_REPLACE: return first;
    case GL_MODULATE: return first * arg(1, channel);
    case GL_ADD: return first + arg(1, channel);
    case GL_ADD_SIGNED: return first + arg(1, channel) - 0.5;
    case GL_SUBTRACT: return first - arg(1, channel);
    case GL_INTERPOLATE: {
      const Value part = arg(2, channel);
      return first * part + arg(1, channel) * (1 - part);
    }
    default: {  // the dot products
      Value sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum = sum + 4 * ((arg(0, c) - 0.5) * (arg(1, c) - 0.5));
      return sum;
    }
  }
}

/// Tables 3.21 and 3.22: the modes without a combiner, except that the sum of GL_ADD is not held to 1. `f`: the channel before
/// the unit.
template <class Value>
Value plain(const TextureUnit& unit, GLenum base, std::size_t channel, const Value& f, const Vec4& texel) {
  const bool is_opaque = base == GL_RGB || base == GL_LUMINANCE, is_color = channel < 3;
  const double t = texel[channel], alpha = texel[3];
  if ((base == GL_ALPHA && is_color) || (is_opaque && !is_color)) return f;
  const bool adds = is_color || base == GL_INTENSITY;  // an intensity is a colour in all channels
  switch (unit.env_mode) {
    case GL_REPLACE: return t;
    case GL_DECAL: return !is_color ? f : is_opaque ? Value(t) : f * (1 - alpha) + t * alpha;
    case GL_ADD: return adds ? f + t : f * t;
    case GL_BLEND: return adds ? f * (1 - t) + unit.env_color[channel] * t : f * t;
    default: return f * t;
  }
}

}  // namespace halfplane::gl
