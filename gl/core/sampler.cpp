#include "sampler.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "matrix.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

constexpr double kLargestBias = 16;

/// Table 3.19: the face that a direction meets. `s` and `t` are components of the direction, with a sign.
struct CubeFace {
  std::size_t major, s, t;
  double s_sign, t_sign;
};
constexpr std::array<CubeFace, 6> kFaces{
    {{0, 2, 1, -1, -1}, {0, 2, 1, 1, -1}, {1, 0, 2, 1, 1}, {1, 0, 2, 1, -1}, {2, 0, 1, 1, -1}, {2, 0, 1, -1, -1}}};

std::size_t face_of(const Vec4& direction) {
  std::size_t major = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (std::abs(direction[c]) > std::abs(direction[major])) major = c;
  return 2 * major + (direction[major] < 0 ? 1 : 0);
}

/// A direction as homogeneous coordinates of the face's image.
Vec4 on_face(std::size_t face, const Vec4& direction) {
  const CubeFace& f = kFaces[face];
  const double major = face % 2 == 0 ? direction[f.major] : -direction[f.major];
  return {(f.s_sign * direction[f.s] + major) / 2, (f.t_sign * direction[f.t] + major) / 2, 0, major};
}

/// The two texels of a side that a coordinate lies between, and how far it is towards the second. Below 0: the border.
struct Span {
  std::array<int, 2> texel{};
  double fraction = 0;
};

/// The texel of a whole number of texels from the image's edge.
int wrapped(GLenum wrap, double texel, int size) {
  const bool is_inside = texel >= 0 && texel < size;
  switch (wrap) {
    case GL_REPEAT: texel -= std::floor(texel / size) * size; break;
    case GL_CLAMP:
    case GL_CLAMP_TO_BORDER:
      if (!is_inside) return -1;
      break;
    default: break;  // what is beyond by half a texel is the edge
  }
  return static_cast<int>(held(texel, 0, size - 1));
}

Span span_of(GLenum wrap, double coordinate, int size, bool is_linear) {
  constexpr double kFarthest = 1e9;  // texels, far inside the range of int and of exact fractions
  const double half = 0.5 / size;
  if (wrap == GL_MIRRORED_REPEAT) {
    const double whole = std::floor(coordinate);
    const double part = coordinate - whole;
    coordinate = std::fmod(whole, 2) == 0 ? part : 1 - part;
  }
  if (wrap == GL_CLAMP) coordinate = held(coordinate);
  if (wrap == GL_CLAMP_TO_EDGE || wrap == GL_MIRRORED_REPEAT) coordinate = held(coordinate, half, 1 - half);
  if (wrap == GL_CLAMP_TO_BORDER) coordinate = held(coordinate, -half, 1 + half);
  const double at = held(coordinate * size - (is_linear ? 0.5 : 0), -kFarthest, kFarthest), first = std::floor(at);
  // The end of a clamped side belongs to its last texel.
  if (!is_linear) return {{wrapped(wrap, wrap == GL_CLAMP ? std::min<double>(first, size - 1) : first, size), 0}, 0};
  return {{wrapped(wrap, first, size), wrapped(wrap, first + 1, size)}, at - first};
}

/// GL_NEVER and the numbers after it have a bit for each of less, equal and greater.
bool passes(GLenum func, double reference, double depth) {
  return ((func - GL_NEVER) & (reference < depth ? 1U : reference == depth ? 2U : 4U)) != 0;
}

/// Texels from a pixel to the next, of those coordinates that the texture has.
double texels_per_pixel(const Vec4& at, const Vec4& change, const std::array<int, 3>& size) {
  double square = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double texels = size[c] * (change[c] - at[c] / at[3] * change[3]) / at[3];
    square += texels * texels;
  }
  return std::sqrt(square);
}

}  // namespace

bool is_linear(GLenum filter) {
  return filter == GL_LINEAR || filter == GL_LINEAR_MIPMAP_NEAREST || filter == GL_LINEAR_MIPMAP_LINEAR;
}

GLenum base_of(const TextureObject& texture) {
  const GLenum base = texture.face[0][static_cast<std::size_t>(texture.base_level)].base_format;
  return base == GL_DEPTH_COMPONENT ? texture.depth_mode : base;
}

std::size_t last_level(const TextureObject& texture) {
  const auto first = static_cast<std::size_t>(texture.base_level);
  if (texture.min_filter == GL_NEAREST || texture.min_filter == GL_LINEAR) return first;
  const TextureImage& image = texture.face[0][first];
  const auto side = static_cast<unsigned>(std::max({image.width, image.height, image.depth}));
  return std::min(first + static_cast<std::size_t>(std::bit_width(side)) - 1,
                  static_cast<std::size_t>(texture.max_level));
}

Sampler::Sampler(const TextureObject& texture, double unit_lod_bias)
    : texture_(&texture),
      base_(base_of(texture)),
      dimensions_(texture.target == GL_TEXTURE_1D   ? 1
                  : texture.target == GL_TEXTURE_3D ? 3
                                                    : 2),
      first_(static_cast<std::size_t>(texture.base_level)),
      last_(last_level(texture)),
      is_depth_(texture.face[0][first_].base_format == GL_DEPTH_COMPONENT),
      lod_bias_(held(texture.lod_bias + unit_lod_bias, -kLargestBias, kLargestBias)) {}

Vec4 Sampler::value_of_depth(double depth, double reference) const {
  if (texture_->compare_mode != GL_NONE) depth = passes(texture_->compare_func, held(reference), depth) ? 1 : 0;
  const double color = base_ == GL_ALPHA ? 0 : depth;
  return {color, color, color, base_ == GL_LUMINANCE ? 1 : depth};
}

Vec4 Sampler::value_of(const Texel& texel, double reference) const {
  if (is_depth_) return value_of_depth(depth_of_texel(texel), reference);
  constexpr double kByte = 1.0 / 255;
  const double alpha = kByte * texel[3];
  if (base_ == GL_ALPHA) return {0, 0, 0, alpha};
  return {kByte * texel[0], kByte * texel[1], kByte * texel[2], alpha};
}

Vec4 Sampler::sample_level(const Spot& spot, std::size_t level, bool is_linear) const {
  const TextureImage& image = texture_->face[spot.face][level];
  const std::array<int, 3> size{image.width, image.height, image.depth};
  std::array<Span, 3> span{};
  for (std::size_t c = 0; c < static_cast<std::size_t>(dimensions_); ++c)
    span[c] = span_of(texture_->wrap[c], spot.coordinate[c], size[c], is_linear);
  Vec4 sum{};
  const unsigned corners = is_linear ? 1U << dimensions_ : 1;
  for (unsigned corner = 0; corner < corners; ++corner) {
    double weight = 1;
    std::array<int, 3> at{};
    bool is_border = false;
    for (std::size_t c = 0; c < static_cast<std::size_t>(dimensions_); ++c) {
      const std::size_t end = corner >> c & 1;
      at[c] = span[c].texel[end];
      weight *= end == 0 ? 1 - span[c].fraction : span[c].fraction;
      is_border |= at[c] < 0;
    }
    if (weight == 0) continue;
    Vec4 value;
    if (is_border) {
      value = is_depth_ ? value_of_depth(held(texture_->border_color[0]), spot.reference)
                        : value_of(border_texel(*texture_), spot.reference);
    } else {
      const auto row =
          static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(at[1]);
      value = value_of(image.texel[row * static_cast<std::size_t>(size[0]) + static_cast<std::size_t>(at[0])],
                       spot.reference);
    }
    for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * value[c];
  }
  return sum;
}

Vec4 Sampler::operator()(const TexturePlace& place) const {
  TexturePlace p = place;
  Spot spot;
  if (texture_->target == GL_TEXTURE_CUBE_MAP) {
    spot.face = face_of(p.at);
    for (Vec4* v : {&p.at, &p.dx, &p.dy}) *v = on_face(spot.face, *v);
  }
  for (std::size_t c = 0; c < 3; ++c) spot.coordinate[c] = p.at[c] / p.at[3];
  spot.reference = spot.coordinate[2];

  const TextureImage& image = texture_->face[0][first_];
  const std::array<int, 3> size{image.width, dimensions_ > 1 ? image.height : 0, dimensions_ > 2 ? image.depth : 0};
  const double rho = std::max(texels_per_pixel(p.at, p.dx, size), texels_per_pixel(p.at, p.dy, size));
  const double lod = held(std::log2(rho) + lod_bias_, texture_->min_lod, texture_->max_lod);

  const GLenum min = texture_->min_filter;
  const bool is_sharp = min == GL_NEAREST_MIPMAP_NEAREST || min == GL_NEAREST_MIPMAP_LINEAR;
  if (lod <= (texture_->mag_filter == GL_LINEAR && is_sharp ? 0.5 : 0))
    return sample_level(spot, first_, texture_->mag_filter == GL_LINEAR);
  const bool filters = is_linear(min);
  const double level = held(lod, 0, static_cast<double>(last_ - first_));
  if (min == GL_NEAREST_MIPMAP_NEAREST || min == GL_LINEAR_MIPMAP_NEAREST || last_ == first_) {
    const double nearest = level > 0.5 ? std::ceil(level + 0.5) - 1 : 0;
    return sample_level(spot, first_ + static_cast<std::size_t>(nearest), filters);
  }
  const auto upper = static_cast<std::size_t>(level);
  const double fraction = level - static_cast<double>(upper);
  Vec4 value = sample_level(spot, first_ + upper, filters);
  if (fraction == 0) return value;
  const Vec4 lower = sample_level(spot, first_ + upper + 1, filters);
  for (std::size_t c = 0; c < 4; ++c) value[c] += fraction * (lower[c] - value[c]);
  return value;
}

}  // namespace halfplane::gl
