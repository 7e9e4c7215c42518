#include "image.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "context.hpp"
#include "matrix.hpp"

namespace halfplane::gl {
namespace {

constexpr int kLuminance = 4;  ///< a channel that stands for red, green and blue together

/// Table 3.6: the channels of a format in the order of its components.
struct PixelFormat {
  GLenum name;
  int components;
  std::array<int, 4> channel;
  [[nodiscard]] bool is_index() const { return name == GL_COLOR_INDEX || name == GL_STENCIL_INDEX; }
};
constexpr auto kFormats = std::to_array<PixelFormat>({{GL_COLOR_INDEX, 1, {0}},
                                                      {GL_STENCIL_INDEX, 1, {0}},
                                                      {GL_DEPTH_COMPONENT, 1, {0}},
                                                      {GL_RED, 1, {0}},
                                                      {GL_GREEN, 1, {1}},
                                                      {GL_BLUE, 1, {2}},
                                                      {GL_ALPHA, 1, {3}},
                                                      {GL_RGB, 3, {0, 1, 2}},
                                                      {GL_BGR, 3, {2, 1, 0}},
                                                      {GL_RGBA, 4, {0, 1, 2, 3}},
                                                      {GL_BGRA, 4, {2, 1, 0, 3}},
                                                      {GL_LUMINANCE, 1, {kLuminance}},
                                                      {GL_LUMINANCE_ALPHA, 2, {kLuminance, 3}}});

enum class TypeKind { whole, negative_too, real, bits, packed, packed_from_low };

/// Tables 3.5 and 3.8. Of packed types the bits of each component; the first one lies highest, or lowest.
struct PixelType {
  GLenum name;
  int bytes;
  TypeKind kind;
  std::array<int, 4> bits{};
  [[nodiscard]] bool is_packed() const { return kind == TypeKind::packed || kind == TypeKind::packed_from_low; }
  [[nodiscard]] int components() const { return bits[3] == 0 ? 3 : 4; }
};
constexpr auto kTypes =
    std::to_array<PixelType>({{GL_UNSIGNED_BYTE, 1, TypeKind::whole},
                              {GL_BITMAP, 1, TypeKind::bits},
                              {GL_BYTE, 1, TypeKind::negative_too},
                              {GL_UNSIGNED_SHORT, 2, TypeKind::whole},
                              {GL_SHORT, 2, TypeKind::negative_too},
                              {GL_UNSIGNED_INT, 4, TypeKind::whole},
                              {GL_INT, 4, TypeKind::negative_too},
                              {GL_FLOAT, 4, TypeKind::real},
                              {GL_UNSIGNED_BYTE_3_3_2, 1, TypeKind::packed, {3, 3, 2}},
                              {GL_UNSIGNED_BYTE_2_3_3_REV, 1, TypeKind::packed_from_low, {3, 3, 2}},
                              {GL_UNSIGNED_SHORT_5_6_5, 2, TypeKind::packed, {5, 6, 5}},
                              {GL_UNSIGNED_SHORT_5_6_5_REV, 2, TypeKind::packed_from_low, {5, 6, 5}},
                              {GL_UNSIGNED_SHORT_4_4_4_4, 2, TypeKind::packed, {4, 4, 4, 4}},
                              {GL_UNSIGNED_SHORT_4_4_4_4_REV, 2, TypeKind::packed_from_low, {4, 4, 4, 4}},
                              {GL_UNSIGNED_SHORT_5_5_5_1, 2, TypeKind::packed, {5, 5, 5, 1}},
                              {GL_UNSIGNED_SHORT_1_5_5_5_REV, 2, TypeKind::packed_from_low, {5, 5, 5, 1}},
                              {GL_UNSIGNED_INT_8_8_8_8, 4, TypeKind::packed, {8, 8, 8, 8}},
                              {GL_UNSIGNED_INT_8_8_8_8_REV, 4, TypeKind::packed_from_low, {8, 8, 8, 8}},
                              {GL_UNSIGNED_INT_10_10_10_2, 4, TypeKind::packed, {10, 10, 10, 2}},
                              {GL_UNSIGNED_INT_2_10_10_10_REV, 4, TypeKind::packed_from_low, {10, 10, 10, 2}}});

template <class Table>
auto row_of(const Table& table, GLenum name) -> decltype(table.data()) {
  const auto row = std::ranges::find(table, name, [](const auto& r) { return r.name; });
  return row == table.end() ? nullptr : &*row;
}

constexpr std::uint32_t largest(int bits) { return bits >= 32 ? ~0U : (1U << bits) - 1; }

std::uint32_t load(const std::byte* at, int bytes, bool is_swapped) {
  std::uint32_t value = 0;
  if (bytes == 4 && !is_swapped) {  // in one instruction
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  for (int i = 0; i < bytes; ++i) {
    const bool is_upward = (std::endian::native == std::endian::little) != is_swapped;
    value |= std::to_integer<std::uint32_t>(at[i]) << 8 * (is_upward ? i : bytes - 1 - i);
  }
  return value;
}
void save(std::byte* at, int bytes, bool is_swapped, std::uint32_t value) {
  for (int i = 0; i < bytes; ++i) {
    const bool is_upward = (std::endian::native == std::endian::little) != is_swapped;
    at[i] = static_cast<std::byte>(value >> 8 * (is_upward ? i : bytes - 1 - i) & 255);
  }
}

std::int32_t extended(std::uint32_t raw, int bits) {
  return static_cast<std::int32_t>(raw << (32 - bits)) >> (32 - bits);
}

/// Table 2.9, or for an index the number itself.
float decoded(std::uint32_t raw, const PixelType& type, bool is_index) {
  if (type.kind == TypeKind::real) return std::bit_cast<float>(raw);
  const int bits = 8 * type.bytes;
  const double value = type.kind == TypeKind::whole ? double{1} * raw : extended(raw, bits);
  // A float holds 24 bits: of larger indices it gets the low bits, which decide.
  constexpr std::uint32_t kHeld = 1U << 24;
  if (is_index) return static_cast<float>(std::abs(value) < kHeld ? value : raw & (kHeld - 1));
  return static_cast<float>((type.kind == TypeKind::whole ? value : 2 * value + 1) / largest(bits));
}

/// Tables 4.4 and 4.6.
std::uint32_t encoded(float value, const PixelType& type, bool is_index) {
  const int bits = 8 * type.bytes;
  const bool is_signed = type.kind == TypeKind::negative_too;
  if (is_index) {
    if (type.kind == TypeKind::real) return std::bit_cast<std::uint32_t>(value);
    const auto number = static_cast<std::uint64_t>(held(value / 4294967295.0) * 4294967295.0);
    return static_cast<std::uint32_t>(number) & largest(is_signed ? bits - 1 : bits);
  }
  const double in_range = held(value);
  if (type.kind == TypeKind::real) return std::bit_cast<std::uint32_t>(static_cast<float>(in_range));
  if (!is_signed) return static_cast<std::uint32_t>(std::llround(in_range * largest(bits)));
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor((in_range * largest(bits) - 1) / 2 + 0.5)));
}

/// The first bit of component `i` of a packed type.
int shift_of(const PixelType& type, std::size_t i) {
  int below = 0;
  for (std::size_t k = 0; k < i; ++k) below += type.bits[k];
  return type.kind == TypeKind::packed_from_low ? below : 8 * type.bytes - below - type.bits[i];
}

/// Calls visit(pixel, its byte, its bit within that) for each pixel as it lies in memory (3.6.4, "Unpacking").
template <class Byte, class Visit>
void walk(const PixelStore& store, std::array<int, 3> size, bool is_3d, const PixelType& type, int components,
          Byte* memory, const Visit& visit) {
  const auto [width, height, depth] = size;
  const auto groups = static_cast<std::ptrdiff_t>(store.row_length > 0 ? store.row_length : width);
  const auto rows = static_cast<std::ptrdiff_t>(is_3d && store.image_height > 0 ? store.image_height : height);
  const bool is_bits = type.kind == TypeKind::bits;
  const std::ptrdiff_t group = type.is_packed() ? type.bytes : type.bytes * components;
  const std::ptrdiff_t row_bytes = is_bits ? (groups + 7) / 8 : groups * group;
  // Elements as large as the alignment, or larger, need none.
  const std::ptrdiff_t alignment = type.bytes >= store.alignment ? 1 : store.alignment;
  const std::ptrdiff_t row_stride = (row_bytes + alignment - 1) / alignment * alignment;
  std::size_t pixel = 0;
  for (std::ptrdiff_t z = 0; z < depth; ++z)
    for (std::ptrdiff_t y = 0; y < height; ++y) {
      Byte* const row = memory + row_stride * ((z + (is_3d ? store.skip_images : 0)) * rows + y + store.skip_rows);
      for (std::ptrdiff_t x = store.skip_pixels; x < std::ptrdiff_t{store.skip_pixels} + width; ++x) {
        if (is_bits)
          visit(pixel++, row + x / 8, static_cast<int>(store.lsb_first ? x % 8 : 7 - x % 8));
        else
          visit(pixel++, row + x * group, 0);
      }
    }
}

std::size_t pixel_count(int width, int height, int depth) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(depth);
}

/// The table of glPixelMap; one zero until it is set.
std::span<const float> map_table(const Context& context, GLenum name) {
  static constexpr float kZero = 0;
  const auto found = context.pixel_maps.find(name);
  if (found == context.pixel_maps.end() || found->second.empty()) return {&kZero, 1};
  return found->second;
}

/// Shift and offset of an index (3.6.5).
std::int64_t moved_index(const PixelState& state, float index) {
  constexpr double kFarthest = 4294967296.0;
  const double factor = std::ldexp(1.0, std::clamp(state.index_shift, -64, 31));
  const double moved = std::clamp(std::floor(index * factor), -kFarthest, kFarthest) + state.index_offset;
  return std::isnan(moved) ? 0 : static_cast<std::int64_t>(moved);
}
/// The tables of indices have powers of two as sizes.
float looked_up(std::span<const float> table, std::int64_t index) {
  return table[static_cast<std::size_t>(index) & (table.size() - 1)];
}

}  // namespace

GLenum check_format(GLenum format, GLenum type) {
  const PixelFormat* f = row_of(kFormats, format);
  const PixelType* t = row_of(kTypes, type);
  if (f == nullptr || t == nullptr || (t->kind == TypeKind::bits && !f->is_index())) return GL_INVALID_ENUM;
  if (t->is_packed() && (f->components != t->components() || format == GL_BGR)) return GL_INVALID_OPERATION;
  return GL_NO_ERROR;
}

Image unpack(const Context& context, int width, int height, int depth, GLenum format, GLenum type, const void* pixels,
             bool is_3d, bool keeps_bytes) {
  const PixelFormat& f = *row_of(kFormats, format);
  const PixelType& t = *row_of(kTypes, type);
  const bool is_color = !f.is_index() && format != GL_DEPTH_COMPONENT;
  Image image{width, height, depth, is_color ? GL_RGBA : format, {}};
  if (pixels == nullptr) return image;
  const PixelStore& store = context.client.unpack;
  // The component that each channel comes from.
  constexpr int kNone = -1;
  std::array<int, 4> source{kNone, kNone, kNone, kNone};
  for (int i = 0; i < f.components; ++i) {
    const int channel = f.channel[static_cast<std::size_t>(i)];
    if (channel == kLuminance)
      source[0] = source[1] = source[2] = i;
    else
      source[static_cast<std::size_t>(channel)] = i;
  }
  const auto read_to = [&]<class Pixel>(std::vector<Pixel>& to, const Pixel& missing, const auto& component) {
    to.resize(pixel_count(width, height, depth));
    walk(store, {width, height, depth}, is_3d, t, f.components, static_cast<const std::byte*>(pixels),
         [&](std::size_t index, const std::byte* at, int bit) {
           Pixel pixel = missing;
           for (std::size_t c = 0; c < 4; ++c)
             if (source[c] != kNone) pixel[c] = component(at, bit, source[c]);
           to[index] = pixel;
         });
  };
  const auto read = [&](const auto& component) { read_to(image.pixel, {0, 0, 0, is_color ? 1.0F : 0.0F}, component); };
  std::array<int, 4> shift{};
  for (std::size_t i = 0; t.is_packed() && i < 4; ++i) shift[i] = shift_of(t, i);
  const auto packed = [&](const std::byte* at, int component) {
    const auto i = static_cast<std::size_t>(component);
    return load(at, t.bytes, store.swap_bytes) >> shift[i] & largest(t.bits[i]);
  };
  const bool is_byte = t.name == GL_UNSIGNED_BYTE, is_four_bytes = t.bits == std::array{8, 8, 8, 8};
  if (keeps_bytes && is_color && is_byte) {  // most images
    read_to(image.byte, {0, 0, 0, 255},
            [](const std::byte* at, int, int component) { return std::to_integer<std::uint8_t>(at[component]); });
  } else if (keeps_bytes && is_four_bytes) {
    read_to(image.byte, {0, 0, 0, 255},
            [&](const std::byte* at, int, int component) { return static_cast<std::uint8_t>(packed(at, component)); });
  } else if (t.is_packed()) {
    read([&](const std::byte* at, int, int component) {
      return static_cast<float>(packed(at, component)) /
             static_cast<float>(largest(t.bits[static_cast<std::size_t>(component)]));
    });
  } else if (t.kind == TypeKind::bits) {
    read([](const std::byte* at, int bit, int) {
      return static_cast<float>(std::to_integer<int>(*at >> bit & std::byte{1}));
    });
  } else if (is_byte) {
    std::array<float, 256> value;
    for (std::uint32_t i = 0; i < value.size(); ++i) value[i] = decoded(i, t, f.is_index());
    read([&](const std::byte* at, int, int component) { return value[std::to_integer<std::size_t>(at[component])]; });
  } else {
    read([&](const std::byte* at, int, int component) {
      return decoded(load(at + component * t.bytes, t.bytes, store.swap_bytes), t, f.is_index());
    });
  }
  return image;
}

std::shared_ptr<const Image> transferred(const Context& context, std::shared_ptr<const Image> image) {
  const PixelState& state = context.state.pixel;
  const bool is_scaled = state.scale != Vec4{1, 1, 1, 1} || state.bias != Vec4{};
  if (image->format == GL_RGBA && !is_scaled && !state.map_color) return image;
  auto result = std::make_shared<Image>(*image);
  result->pixel.reserve(std::max(result->pixel.size(), result->byte.size()));
  for (const Texel& byte : std::exchange(result->byte, {})) {
    std::array<float, 4>& pixel = result->pixel.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) pixel[c] = decoded(byte[c], *row_of(kTypes, GL_UNSIGNED_BYTE), false);
  }
  const auto tables = [&context](GLenum first) {  // of red, green, blue and alpha
    return std::array{map_table(context, first), map_table(context, first + 1), map_table(context, first + 2),
                      map_table(context, first + 3)};
  };
  if (image->format == GL_RGBA) {
    const auto maps = tables(GL_PIXEL_MAP_R_TO_R);
    for (auto& pixel : result->pixel)
      for (std::size_t c = 0; c < 4; ++c) {
        pixel[c] = static_cast<float>(held(pixel[c] * state.scale[c] + state.bias[c]));
        if (!state.map_color) continue;
        const auto last = static_cast<float>(maps[c].size() - 1);
        pixel[c] = maps[c][static_cast<std::size_t>(std::floor(pixel[c] * last + 0.5F))];
      }
  } else if (image->format == GL_DEPTH_COMPONENT) {
    for (auto& pixel : result->pixel)
      pixel[0] = static_cast<float>(held(pixel[0] * state.depth_scale + state.depth_bias));
  } else if (image->format == GL_STENCIL_INDEX) {
    const auto map = map_table(context, GL_PIXEL_MAP_S_TO_S);
    for (auto& pixel : result->pixel) {
      const std::int64_t index = moved_index(state, pixel[0]);
      const auto stencil = state.map_stencil ? static_cast<std::int64_t>(looked_up(map, index)) : index;
      pixel[0] = static_cast<float>(stencil & 255);
    }
  } else {
    const auto maps = tables(GL_PIXEL_MAP_I_TO_R);
    result->format = GL_RGBA;
    for (auto& pixel : result->pixel) {
      const std::int64_t index = moved_index(state, pixel[0]);
      for (std::size_t c = 0; c < 4; ++c) pixel[c] = looked_up(maps[c], index);
    }
  }
  return result;
}

void pack(const Context& context, const Image& image, GLenum format, GLenum type, void* pixels, bool is_3d) {
  const PixelFormat& f = *row_of(kFormats, format);
  const PixelType& t = *row_of(kTypes, type);
  const PixelStore& store = context.client.pack;
  if (pixels == nullptr) return;
  const auto take = [&f](const std::array<float, 4>& from, std::size_t component) {
    const int channel = f.channel[component];
    return channel == kLuminance ? from[0] + from[1] + from[2] : from[static_cast<std::size_t>(channel)];
  };
  walk(store, {image.width, image.height, image.depth}, is_3d, t, f.components, static_cast<std::byte*>(pixels),
       [&](std::size_t index, std::byte* at, int bit) {
         const std::array<float, 4>& from = image.pixel[index];
         if (t.kind == TypeKind::bits) {
           const std::byte mask = std::byte{1} << bit;
           *at = (encoded(from[0], kTypes[0], true) & 1) != 0 ? *at | mask : *at & ~mask;
         } else if (t.is_packed()) {
           std::uint32_t word = 0;
           for (std::size_t i = 0; i < static_cast<std::size_t>(f.components); ++i)
             word |= static_cast<std::uint32_t>(std::llround(held(take(from, i)) * largest(t.bits[i])))
                     << shift_of(t, i);
           save(at, t.bytes, store.swap_bytes, word);
         } else {
           for (std::size_t i = 0; i < static_cast<std::size_t>(f.components); ++i, at += t.bytes)
             save(at, t.bytes, store.swap_bytes, encoded(take(from, i), t, f.is_index()));
         }
       });
}

Bitmap unpack_bitmap(const Context& context, int width, int height, const GLubyte* bits) {
  Bitmap bitmap{width, height, {}};
  bitmap.bit.resize(pixel_count(width, height, 1));
  walk(context.client.unpack, {width, height, 1}, false, *row_of(kTypes, GL_BITMAP), 1, bits,
       [&bitmap](std::size_t pixel, const GLubyte* at, int bit) { bitmap.bit[pixel] = (*at >> bit & 1) != 0; });
  return bitmap;
}

}  // namespace halfplane::gl
