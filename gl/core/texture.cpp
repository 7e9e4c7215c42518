#include "texture.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include "commands.hpp"
#include "matrix.hpp"

namespace halfplane::gl {
namespace {

constexpr int kLastLevel = 12;
static_assert(1 << kLastLevel == kLargestTexture);
constexpr double kLargestDepth = 4294967295.0;  // of texel_of_depth()

std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Targets that a command can give images to.
struct ImageTarget {
  GLenum name;
  int dimensions;
  std::size_t index;  ///< in kTextureTargets
  std::size_t face;
  bool is_proxy;
};
constexpr auto kImageTargets = std::to_array<ImageTarget>({{GL_TEXTURE_1D, 1, 0, 0, false},
                                                           {GL_TEXTURE_2D, 2, 1, 0, false},
                                                           {GL_TEXTURE_3D, 3, 2, 0, false},
                                                           {GL_TEXTURE_CUBE_MAP_POSITIVE_X, 2, 3, 0, false},
                                                           {GL_TEXTURE_CUBE_MAP_NEGATIVE_X, 2, 3, 1, false},
                                                           {GL_TEXTURE_CUBE_MAP_POSITIVE_Y, 2, 3, 2, false},
                                                           {GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, 2, 3, 3, false},
                                                           {GL_TEXTURE_CUBE_MAP_POSITIVE_Z, 2, 3, 4, false},
                                                           {GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, 2, 3, 5, false},
                                                           {GL_PROXY_TEXTURE_1D, 1, 0, 0, true},
                                                           {GL_PROXY_TEXTURE_2D, 2, 1, 0, true},
                                                           {GL_PROXY_TEXTURE_3D, 3, 2, 0, true},
                                                           {GL_PROXY_TEXTURE_CUBE_MAP, 2, 3, 0, true}});

/// Null and GL_INVALID_ENUM for an unknown target. `dimensions` 0: of any.
const ImageTarget* image_target(Context& context, GLenum name, int dimensions) {
  const auto* target = std::ranges::find(kImageTargets, name, &ImageTarget::name);
  if (target != kImageTargets.end() && (dimensions == 0 || target->dimensions == dimensions)) return target;
  return context.fail(GL_INVALID_ENUM), nullptr;
}

/// Internal formats from `first` to `last` and the base format of each (table 3.16). No compressed format exists, so that
/// the generic ones are stored as their base format.
struct InternalFormats {
  GLint first, last;
  GLenum base;
};
constexpr auto kInternalFormats =
    std::to_array<InternalFormats>({{1, 1, GL_LUMINANCE},
                                    {2, 2, GL_LUMINANCE_ALPHA},
                                    {3, 3, GL_RGB},
                                    {4, 4, GL_RGBA},
                                    {GL_ALPHA, GL_ALPHA, GL_ALPHA},
                                    {GL_RGB, GL_RGB, GL_RGB},
                                    {GL_RGBA, GL_RGBA, GL_RGBA},
                                    {GL_LUMINANCE, GL_LUMINANCE, GL_LUMINANCE},
                                    {GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA},
                                    {GL_R3_G3_B2, GL_R3_G3_B2, GL_RGB},
                                    {GL_ALPHA4, GL_ALPHA16, GL_ALPHA},
                                    {GL_LUMINANCE4, GL_LUMINANCE16, GL_LUMINANCE},
                                    {GL_LUMINANCE4_ALPHA4, GL_LUMINANCE16_ALPHA16, GL_LUMINANCE_ALPHA},
                                    {GL_INTENSITY, GL_INTENSITY16, GL_INTENSITY},
                                    {GL_RGB4, GL_RGB16, GL_RGB},
                                    {GL_RGBA2, GL_RGBA16, GL_RGBA},
                                    {GL_COMPRESSED_ALPHA, GL_COMPRESSED_ALPHA, GL_ALPHA},
                                    {GL_COMPRESSED_LUMINANCE, GL_COMPRESSED_LUMINANCE, GL_LUMINANCE},
                                    {GL_COMPRESSED_LUMINANCE_ALPHA, GL_COMPRESSED_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA},
                                    {GL_COMPRESSED_INTENSITY, GL_COMPRESSED_INTENSITY, GL_INTENSITY},
                                    {GL_COMPRESSED_RGB, GL_COMPRESSED_RGB, GL_RGB},
                                    {GL_COMPRESSED_RGBA, GL_COMPRESSED_RGBA, GL_RGBA},
                                    {GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT},
                                    {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT32, GL_DEPTH_COMPONENT}});

/// GL_NONE for an unknown internal format.
GLenum base_format(GLint internal_format) {
  for (const InternalFormats& row : kInternalFormats)
    if (internal_format >= row.first && internal_format <= row.last) return row.base;
  return GL_NONE;
}

/// The format that an image reports: a generic compressed one is its base format.
GLint kept_format(GLint internal_format) {
  const bool is_compressed = internal_format >= GL_COMPRESSED_ALPHA && internal_format <= GL_COMPRESSED_RGBA;
  return is_compressed ? static_cast<GLint>(base_format(internal_format)) : internal_format;
}

Texel texel_of_depth(double depth) {
  const auto code = static_cast<std::uint32_t>(std::llround(held(depth) * kLargestDepth));
  Texel texel{};
  for (std::size_t c = 0; c < 4; ++c) texel[c] = static_cast<std::uint8_t>(code >> (24 - 8 * c) & 255);
  return texel;
}
using gl::stored_texel;
Texel stored_texel(GLenum base, const std::array<float, 4>& color) {
  return base == GL_DEPTH_COMPONENT ? texel_of_depth(color[0]) : stored_texel(base, texel_of(color));
}
Texel stored_texel(GLenum base, const Image& image, std::size_t i) {
  return image.byte.empty() ? stored_texel(base, image.pixel[i]) : stored_texel(base, image.byte[i]);
}
/// The way back, for glGetTexImage (table 6.1; a luminance is the red component alone).
std::array<float, 4> read_texel(GLenum base, const Texel& texel) {
  if (base == GL_DEPTH_COMPONENT) return {static_cast<float>(depth_of_texel(texel)), 0, 0, 0};
  std::array<float, 4> color{};
  for (std::size_t c = 0; c < 4; ++c) color[c] = static_cast<float>(texel[c]) / 255;
  switch (base) {
    case GL_ALPHA: return {0, 0, 0, color[3]};
    case GL_LUMINANCE:
    case GL_INTENSITY: return {color[0], 0, 0, 1};
    case GL_LUMINANCE_ALPHA: return {color[0], 0, 0, color[3]};
    default: return color;
  }
}
std::array<float, 4> red_alone(const std::array<float, 4>& color) { return {color[0], 0, 0, color[3]}; }

std::size_t texel_count(const TextureImage& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
         static_cast<std::size_t>(image.depth);
}
std::size_t texel_at(int width, int height, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}
/// An image without texels, of sides that hold the border. A side that a target lacks has length 1 and no border.
TextureImage empty_image(const std::array<int, 3>& sides, GLint internal_format, int border) {
  const auto inner = [&](std::size_t i) { return sides[i] > 1 ? sides[i] - 2 * border : sides[i]; };
  return {inner(0), inner(1), inner(2), border, kept_format(internal_format), base_format(internal_format), {}};
}

/// The object that a name is bound to. `create`: a name without one gets one.
std::shared_ptr<TextureObject> named_texture(SharedObjects& shared, GLuint name, GLenum target, bool create) {
  const std::scoped_lock lock(shared.mutex);
  const auto found = shared.textures.find(name);
  if (found == shared.textures.end() && !create) return nullptr;
  std::shared_ptr<TextureObject>& texture = found == shared.textures.end() ? shared.textures[name] : found->second;
  if (texture == nullptr) texture = std::make_shared<TextureObject>();
  texture->name = name;
  if (texture->target == 0 && create) texture->target = target;
  return texture;
}

TextureObject& object_of(Context& context, std::size_t index) {
  const auto unit = static_cast<std::size_t>(context.state.texture.active);
  const GLuint name = context.state.texture.unit[unit].bound[index];
  if (name == 0) return context.default_textures[index];
  std::shared_ptr<TextureObject>& bound = context.bound_textures[unit][index];
  if (bound == nullptr || bound->name != name)
    bound = named_texture(*context.shared, name, kTextureTargets[index], true);
  return *bound;
}

/// The image of a level. Null: there is none.
TextureImage* image_of(Context& context, const ImageTarget& target, GLint level) {
  const auto l = static_cast<std::size_t>(level);
  if (target.is_proxy) return &context.proxies[target.index][l];
  std::vector<TextureImage>& levels = object_of(context, target.index).face[target.face];
  return l < levels.size() ? &levels[l] : nullptr;
}

bool is_level(Context& context, GLint level) {
  if (level >= 0 && level <= kLastLevel) return true;
  return context.fail(GL_INVALID_VALUE), false;
}

/// Whether data of this format can become texels of that base format; else the error.
bool go_together(Context& context, GLenum format, GLenum base) {
  if (format == GL_STENCIL_INDEX)
    context.fail(GL_INVALID_ENUM);
  else if ((format == GL_DEPTH_COMPONENT) != (base == GL_DEPTH_COMPONENT))
    context.fail(GL_INVALID_OPERATION);
  else
    return true;
  return false;
}

/// Halves the sides of an image of sums, adding texels that fall together.
template <class Sum, class Value>
std::vector<Sum> halved(const std::vector<Value>& from, const TextureImage& size, const TextureImage& smaller) {
  std::vector<Sum> sums(texel_count(smaller));
  const int fx = size.width / smaller.width, fy = size.height / smaller.height, fz = size.depth / smaller.depth;
  std::size_t i = 0;
  for (int z = 0; z < size.depth; ++z)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x, ++i) {
        Sum& sum = sums[texel_at(smaller.width, smaller.height, x / fx, y / fy, z / fz)];
        for (std::size_t c = 0; c < 4; ++c) sum[c] += from[i][c];
      }
  return sums;
}

/// All levels below an image down to 1x1: means over boxes of it, rounded once.
std::vector<TextureImage> box_levels(const TextureImage& image) {
  using Sum = std::array<std::uint32_t, 4>;  // sum of 2^24 texels at most
  std::vector<TextureImage> levels;
  std::vector<Sum> sums;
  TextureImage size{image.width, image.height, image.depth, image.border, image.internal_format, image.base_format, {}};
  while (size.width > 1 || size.height > 1 || size.depth > 1) {
    TextureImage smaller = size;
    for (int TextureImage::*side : {&TextureImage::width, &TextureImage::height, &TextureImage::depth})
      smaller.*side = std::max(1, size.*side / 2);
    sums = levels.empty() ? halved<Sum>(image.texel, size, smaller) : halved<Sum>(sums, size, smaller);
    size = smaller;
    const std::uint64_t texels = texel_count(image) / texel_count(smaller);
    for (const Sum& sum : sums) {
      Texel& texel = smaller.texel.emplace_back();
      if (image.base_format == GL_DEPTH_COMPONENT) {
        double depths = 0;
        for (const std::uint32_t digit : sum) depths = 256 * depths + digit;
        texel = texel_of_depth(depths / static_cast<double>(texels) / kLargestDepth);
        continue;
      }
      for (std::size_t c = 0; c < 4; ++c) texel[c] = static_cast<std::uint8_t>((sum[c] + texels / 2) / texels);
    }
    levels.push_back(std::move(smaller));
  }
  return levels;
}

/// After each change of a level of one face.
void changed(TextureObject& texture, std::size_t face, GLint level) {
  texture.revision = next_revision();
  std::vector<TextureImage>& levels = texture.face[face];
  if (!texture.generate_mipmap || level != texture.base_level || levels[static_cast<std::size_t>(level)].texel.empty())
    return;
  std::vector<TextureImage> smaller = box_levels(levels[static_cast<std::size_t>(level)]);
  for (std::size_t i = 0; i < smaller.size() && level + static_cast<int>(i) < texture.max_level; ++i) {
    const std::size_t l = static_cast<std::size_t>(level) + 1 + i;
    if (l >= levels.size()) levels.resize(l + 1);
    levels[l] = std::move(smaller[i]);
  }
}

enum class SizeCheck { refused, too_large, fits };

/// The errors that an image has by its sizes. Too large is an error but for proxies.
SizeCheck check_size(Context& context, const ImageTarget& target, GLint level, const std::array<int, 3>& sides,
                     GLint border) {
  const auto refuse = [&context] { return context.fail(GL_INVALID_VALUE), SizeCheck::refused; };
  if (!is_level(context, level)) return SizeCheck::refused;
  if (border != 0 && border != 1) return refuse();
  const int largest = target.dimensions == 3 ? kLargestTexture3D : kLargestTexture;
  bool fits = true;
  for (int i = 0; i < target.dimensions; ++i) {
    const int side = sides[static_cast<std::size_t>(i)];
    const int inner = side - 2 * border;
    if (side < 0 || (side > 0 && (inner < 1 || !std::has_single_bit(static_cast<unsigned>(inner))))) return refuse();
    fits = fits && inner <= std::max(1, largest >> level);
  }
  if (target.index == 3 && sides[0] != sides[1]) return refuse();
  if (!fits && !target.is_proxy) return refuse();
  return fits ? SizeCheck::fits : SizeCheck::too_large;
}

void store_image(Context& context, const ImageTarget& target, GLint level, TextureImage image) {
  const auto l = static_cast<std::size_t>(level);
  if (target.is_proxy) {
    context.proxies[target.index][l] = std::move(image);
    return;
  }
  TextureObject& texture = object_of(context, target.index);
  std::vector<TextureImage>& levels = texture.face[target.face];
  if (l >= levels.size()) levels.resize(l + 1);
  levels[l] = std::move(image);
  changed(texture, target.face, level);
}

/// Depth textures have one or two dimensions.
bool takes_base(Context& context, const ImageTarget& target, GLenum base) {
  if (base != GL_DEPTH_COMPONENT || target.index < 2) return true;
  return context.fail(GL_INVALID_OPERATION), false;
}

/// The level that a sub image goes to. Null: the error has been reported. `end`: the texel after the last one, or `offset`
/// where no size is known yet.
TextureImage* sub_image_of(Context& context, int dimensions, GLenum name, GLint level,
                           const std::array<GLint, 3>& offset, const std::array<GLsizei, 3>& size) {
  const ImageTarget* target = image_target(context, name, dimensions);
  if (target == nullptr) return nullptr;
  if (target->is_proxy) return context.fail(GL_INVALID_ENUM), nullptr;
  if (!is_level(context, level)) return nullptr;
  TextureImage* image = image_of(context, *target, level);
  if (image == nullptr || image->texel.empty()) return context.fail(GL_INVALID_OPERATION), nullptr;
  const std::array<int, 3> sides{image->width, image->height, image->depth};
  for (std::size_t i = 0; i < 3; ++i) {
    const int border = static_cast<int>(i) < dimensions ? image->border : 0;
    if (size[i] < 0 || offset[i] < -border || std::int64_t{offset[i]} + size[i] > std::int64_t{sides[i]} + border)
      return context.fail(GL_INVALID_VALUE), nullptr;
  }
  return image;
}

/// Texels of a border are left out.
void store_sub_image(Context& context, GLenum name, GLint level, TextureImage& to, const std::array<GLint, 3>& offset,
                     const Image& image) {
  if (image.empty()) return;
  std::size_t i = 0;
  for (int z = offset[2]; z < offset[2] + image.depth; ++z)
    for (int y = offset[1]; y < offset[1] + image.height; ++y)
      for (int x = offset[0]; x < offset[0] + image.width; ++x, ++i)
        if (x >= 0 && y >= 0 && z >= 0 && x < to.width && y < to.height && z < to.depth)
          to.texel[texel_at(to.width, to.height, x, y, z)] = stored_texel(to.base_format, image, i);
  const ImageTarget& target = *image_target(context, name, 0);
  changed(object_of(context, target.index), target.face, level);
}

/// A rectangle of the framebuffer for a texture of this base format, after glPixelTransfer.
std::shared_ptr<const Image> copied(Context& context, GLint x, GLint y, GLsizei width, GLsizei height, GLenum base) {
  const GLenum format = base == GL_DEPTH_COMPONENT ? GL_DEPTH_COMPONENT : GL_RGBA;
  return transferred(context, std::make_shared<const Image>(read_rectangle(context, x, y, width, height, format)));
}

/// An image as an internal format keeps it, without its border.
TextureImage stored_image(const Image& image, GLint internal_format, int border) {
  const GLenum base = base_format(internal_format);
  TextureImage stored = empty_image({image.width, image.height, image.depth}, internal_format, border);
  const std::array<int, 3> cut{(image.width - stored.width) / 2, (image.height - stored.height) / 2,
                               (image.depth - stored.depth) / 2};
  stored.texel.reserve(texel_count(stored));
  for (int z = 0; z < stored.depth; ++z)
    for (int y = 0; y < stored.height; ++y)
      for (int x = 0; x < stored.width; ++x)
        stored.texel.push_back(
            stored_texel(base, image, texel_at(image.width, image.height, x + cut[0], y + cut[1], z + cut[2])));
  return stored;
}

/// Whether an image has the size of the level after `larger`.
bool is_next_level(const TextureImage& image, const TextureImage& larger) {
  return image.width == std::max(1, larger.width / 2) && image.height == std::max(1, larger.height / 2) &&
         image.depth == std::max(1, larger.depth / 2) && image.internal_format == larger.internal_format &&
         image.border == larger.border;
}

}  // namespace

Texel texel_of(const std::array<float, 4>& color) {
  Texel texel{};
  for (std::size_t c = 0; c < 4; ++c)
    texel[c] = static_cast<std::uint8_t>(static_cast<int>(held(color[c]) * 510 + 1) / 2);
  return texel;
}

Texel stored_texel(GLenum base, const Texel& t) {
  switch (base) {
    case GL_ALPHA: return {255, 255, 255, t[3]};
    case GL_LUMINANCE: return {t[0], t[0], t[0], 255};
    case GL_LUMINANCE_ALPHA: return {t[0], t[0], t[0], t[3]};
    case GL_INTENSITY: return {t[0], t[0], t[0], t[0]};
    case GL_RGB: return {t[0], t[1], t[2], 255};
    default: return t;
  }
}

double depth_of_texel(const Texel& texel) {
  double code = 0;
  for (const std::uint8_t digit : texel) code = 256 * code + digit;
  return code / kLargestDepth;
}

bool is_complete(const TextureObject& texture) {
  const bool is_cube = texture.target == GL_TEXTURE_CUBE_MAP;
  if (texture.base_level > texture.max_level) return false;
  const auto base = static_cast<std::size_t>(texture.base_level);
  const bool has_levels = texture.min_filter != GL_NEAREST && texture.min_filter != GL_LINEAR;
  for (std::size_t f = 0; f < (is_cube ? 6U : 1U); ++f) {
    const std::vector<TextureImage>& levels = texture.face[f];
    if (base >= levels.size() || levels[base].texel.empty()) return false;
    const TextureImage& first = texture.face[0][base];
    if (levels[base].width != first.width || levels[base].internal_format != first.internal_format ||
        levels[base].border != first.border)
      return false;
    const int side = std::max({first.width, first.height, first.depth});
    const auto last = std::min(base + static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(side))) - 1,
                               static_cast<std::size_t>(texture.max_level));
    for (std::size_t l = base + 1; has_levels && l <= last; ++l)
      if (l >= levels.size() || levels[l].texel.empty() || !is_next_level(levels[l], levels[l - 1])) return false;
  }
  return true;
}

const TextureObject* sampled_texture(const Context& context, int unit) {
  const auto u = static_cast<std::size_t>(unit);
  const TextureUnit& state = context.state.texture.unit[u];
  for (std::size_t index = kTextureTargets.size(); index-- > 0;) {
    if (!state.enabled[index]) continue;
    const GLuint name = state.bound[index];
    const TextureObject* texture = &context.default_textures[index];
    if (name != 0) {
      const auto& bound = context.bound_textures[u][index];
      // The texture of popped attributes may not be bound yet.
      texture = bound != nullptr && bound->name == name
                    ? bound.get()
                    : named_texture(*context.shared, name, kTextureTargets[index], false).get();
    }
    return texture != nullptr && is_complete(*texture) ? texture : nullptr;
  }
  return nullptr;
}

unsigned textured_units(const Context& context) {
  unsigned units = 0;
  for (int u = 0; u < kTextureUnits; ++u) units |= sampled_texture(context, u) != nullptr ? 1U << u : 0;
  return units;
}

TextureObject* bound_texture(Context& context, GLenum target) {
  const auto* found = std::ranges::find(kTextureTargets, target);
  if (found != kTextureTargets.end())
    return &object_of(context, static_cast<std::size_t>(found - kTextureTargets.begin()));
  return context.fail(GL_INVALID_ENUM), nullptr;
}

void tex_image(Context& context, int dimensions, GLenum target, GLint level, GLint internal_format, GLsizei width,
               GLsizei height, GLsizei depth, GLint border, std::shared_ptr<const Image> image) {
  const ImageTarget* to = image_target(context, target, dimensions);
  if (to == nullptr) return;
  const GLenum base = base_format(internal_format);
  if (base == GL_NONE) return context.fail(GL_INVALID_VALUE);
  const SizeCheck fit = check_size(context, *to, level, {width, height, depth}, border);
  if (fit == SizeCheck::refused || !takes_base(context, *to, base)) return;
  if (image != nullptr && !go_together(context, image->format, base)) return;
  if (fit == SizeCheck::too_large) return store_image(context, *to, level, {});
  if (to->is_proxy || image == nullptr || image->empty()) {
    TextureImage blank = empty_image({width, height, depth}, internal_format, border);
    if (!to->is_proxy) blank.texel.resize(texel_count(blank), stored_texel(base, std::array<float, 4>{0, 0, 0, 1}));
    return store_image(context, *to, level, std::move(blank));
  }
  store_image(context, *to, level, stored_image(*transferred(context, std::move(image)), internal_format, border));
}

void tex_sub_image(Context& context, int dimensions, GLenum target, GLint level, GLint x, GLint y, GLint z,
                   std::shared_ptr<const Image> image) {
  TextureImage* to =
      sub_image_of(context, dimensions, target, level, {x, y, z}, {image->width, image->height, image->depth});
  if (to == nullptr || !go_together(context, image->format, to->base_format)) return;
  store_sub_image(context, target, level, *to, {x, y, z}, *transferred(context, std::move(image)));
}

void copy_tex_image(Context& context, int dimensions, GLenum target, GLint level, GLenum internal_format, GLint x,
                    GLint y, GLsizei width, GLsizei height, GLint border) {
  const ImageTarget* to = image_target(context, target, dimensions);
  if (to == nullptr) return;
  const auto format = static_cast<GLint>(internal_format);
  const GLenum base = base_format(format);
  if (to->is_proxy || base == GL_NONE || format <= 4) return context.fail(GL_INVALID_ENUM);
  if (dimensions == 1) height = 1;
  if (check_size(context, *to, level, {width, height, 1}, border) != SizeCheck::fits || !takes_base(context, *to, base))
    return;
  store_image(context, *to, level, stored_image(*copied(context, x, y, width, height, base), format, border));
}

void copy_tex_sub_image(Context& context, int dimensions, GLenum target, GLint level, GLint xoffset, GLint yoffset,
                        GLint zoffset, GLint x, GLint y, GLsizei width, GLsizei height) {
  if (dimensions == 1) height = 1;
  const std::array<GLint, 3> offset{xoffset, yoffset, zoffset};
  TextureImage* to = sub_image_of(context, dimensions, target, level, offset, {width, height, 1});
  if (to == nullptr) return;
  store_sub_image(context, target, level, *to, offset, *copied(context, x, y, width, height, to->base_format));
}

void active_texture(Context& context, GLenum unit) {
  if (unit < GL_TEXTURE0 || unit >= GL_TEXTURE0 + kTextureUnits) return context.fail(GL_INVALID_ENUM);
  context.state.texture.active = static_cast<int>(unit - GL_TEXTURE0);
}

void bind_texture(Context& context, GLenum target, GLuint name) {
  const auto* found = std::ranges::find(kTextureTargets, target);
  if (found == kTextureTargets.end()) return context.fail(GL_INVALID_ENUM);
  const auto index = static_cast<std::size_t>(found - kTextureTargets.begin());
  const auto unit = static_cast<std::size_t>(context.state.texture.active);
  std::shared_ptr<TextureObject> texture;
  if (name != 0) {
    texture = named_texture(*context.shared, name, target, true);
    if (texture->target != target) return context.fail(GL_INVALID_OPERATION);
  }
  context.state.texture.unit[unit].bound[index] = name;
  context.bound_textures[unit][index] = std::move(texture);
}

void prioritize_textures(Context& context,
                         const std::shared_ptr<const std::vector<std::pair<GLuint, double>>>& priorities) {
  for (const auto& [name, priority] : *priorities)
    if (const auto texture = name == 0 ? nullptr : named_texture(*context.shared, name, 0, false))
      texture->priority = held(priority);
}

void gen_textures(Context& context, GLsizei n, GLuint* names) {
  const std::scoped_lock lock(context.shared->mutex);
  generate(context, context.shared->textures, n, names);
}

void delete_textures(Context& context, GLsizei n, const GLuint* names) {
  if (n < 0) return context.fail(GL_INVALID_VALUE);
  ++context.revision;  // bound ones are unbound
  for (GLsizei i = 0; i < n; ++i) {
    if (names[i] == 0) continue;
    for (std::size_t unit = 0; unit < context.bound_textures.size(); ++unit)
      for (std::size_t index = 0; index < kTextureTargets.size(); ++index) {
        GLuint& bound = context.state.texture.unit[unit].bound[index];
        if (bound != names[i]) continue;
        bound = 0;
        context.bound_textures[unit][index] = nullptr;
      }
    const std::scoped_lock lock(context.shared->mutex);
    context.shared->textures.erase(names[i]);
  }
}

GLboolean is_texture(Context& context, GLuint name) {
  const auto texture = name == 0 ? nullptr : named_texture(*context.shared, name, 0, false);
  return texture != nullptr && texture->target != 0 ? GL_TRUE : GL_FALSE;
}

GLboolean are_textures_resident(Context& context, GLsizei n, const GLuint* names, GLboolean*) {
  if (n < 0) return context.fail(GL_INVALID_VALUE), GL_FALSE;
  for (GLsizei i = 0; i < n; ++i)
    if (is_texture(context, names[i]) == GL_FALSE) return context.fail(GL_INVALID_VALUE), GL_FALSE;
  return GL_TRUE;  // all are, and `residences` stays as it is
}

void get_tex_image(Context& context, GLenum target, GLint level, GLenum format, GLenum type, void* pixels) {
  const ImageTarget* from = image_target(context, target, 0);
  if (from == nullptr) return;
  if (from->is_proxy) return context.fail(GL_INVALID_ENUM);
  if (!is_level(context, level)) return;
  if (const GLenum error = check_format(format, type); error != GL_NO_ERROR) return context.fail(error);
  if (format == GL_STENCIL_INDEX || format == GL_COLOR_INDEX) return context.fail(GL_INVALID_ENUM);
  const TextureImage* stored = image_of(context, *from, level);
  if (stored == nullptr || stored->texel.empty()) return;
  if (!go_together(context, format, stored->base_format)) return;
  // Texels of the border are not kept: reads give the texels next to them.
  const std::array<int, 3> border{stored->border, from->dimensions > 1 ? stored->border : 0,
                                  from->dimensions > 2 ? stored->border : 0};
  Image image{stored->width + 2 * border[0], stored->height + 2 * border[1], stored->depth + 2 * border[2], format, {}};
  for (int z = -border[2]; z < stored->depth + border[2]; ++z)
    for (int y = -border[1]; y < stored->height + border[1]; ++y)
      for (int x = -border[0]; x < stored->width + border[0]; ++x)
        image.pixel.push_back(read_texel(
            stored->base_format,
            stored->texel[texel_at(stored->width, stored->height, std::clamp(x, 0, stored->width - 1),
                                   std::clamp(y, 0, stored->height - 1), std::clamp(z, 0, stored->depth - 1))]));
  if (format == GL_LUMINANCE || format == GL_LUMINANCE_ALPHA)
    std::ranges::transform(image.pixel, image.pixel.begin(), red_alone);
  pack(context, image, format, type, pixels, from->dimensions == 3);
}

void compressed_image(Context& context) { context.fail(GL_INVALID_ENUM); }

Values get_tex_level_parameter(Context& context, GLenum target, GLint level, GLenum pname) {
  const ImageTarget* from = image_target(context, target, 0);
  if (from == nullptr || !is_level(context, level)) return {};
  static const TextureImage none;
  const TextureImage* found = image_of(context, *from, level);
  const TextureImage& image = found == nullptr ? none : *found;
  const int border = image.border;
  const auto side = [border](int inner, bool has) { return inner == 0 ? 0 : inner + (has ? 2 * border : 0); };
  const auto one = [](int value) { return Values{ValueKind::integer, {static_cast<double>(value)}}; };
  /// Which base formats have a component.
  struct Component {
    GLenum pname;
    std::array<GLenum, 3> base;
  };
  constexpr auto kComponents =
      std::to_array<Component>({{GL_TEXTURE_RED_SIZE, {GL_RGB, GL_RGBA}},
                                {GL_TEXTURE_GREEN_SIZE, {GL_RGB, GL_RGBA}},
                                {GL_TEXTURE_BLUE_SIZE, {GL_RGB, GL_RGBA}},
                                {GL_TEXTURE_ALPHA_SIZE, {GL_ALPHA, GL_LUMINANCE_ALPHA, GL_RGBA}},
                                {GL_TEXTURE_LUMINANCE_SIZE, {GL_LUMINANCE, GL_LUMINANCE_ALPHA}},
                                {GL_TEXTURE_INTENSITY_SIZE, {GL_INTENSITY}},
                                {GL_TEXTURE_DEPTH_SIZE, {GL_DEPTH_COMPONENT}}});
  if (const auto* row = std::ranges::find(kComponents, pname, &Component::pname); row != kComponents.end())
    return one(image.width != 0 && std::ranges::find(row->base, image.base_format) != row->base.end()
                   ? pname == GL_TEXTURE_DEPTH_SIZE ? 24 : 8  // depths pass an Image, whose floats hold 24
                   : 0);
  switch (pname) {
    case GL_TEXTURE_WIDTH: return one(side(image.width, true));
    case GL_TEXTURE_HEIGHT: return one(side(image.height, from->dimensions > 1));
    case GL_TEXTURE_DEPTH: return one(side(image.depth, from->dimensions > 2));
    case GL_TEXTURE_BORDER: return one(border);
    case GL_TEXTURE_INTERNAL_FORMAT: return one(image.internal_format);
    case GL_TEXTURE_COMPRESSED: return {ValueKind::boolean, {0}};
    case GL_TEXTURE_COMPRESSED_IMAGE_SIZE: context.fail(GL_INVALID_OPERATION); return {};
    default: context.fail(GL_INVALID_ENUM); return {};
  }
}

}  // namespace halfplane::gl
