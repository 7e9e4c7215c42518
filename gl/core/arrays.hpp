// What OpenGL 1.5 says about each vertex array (2.8, tables 2.4 and 6.6), for commands, queries and the reader of traces.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>

#include "embedded.hpp"

namespace halfplane::gl {

/// A set of types of numbers, from GL_BYTE on.
constexpr unsigned type_set(std::initializer_list<GLenum> types) {
  unsigned set = 0;
  for (const GLenum type : types) set |= 1U << (type - GL_BYTE);
  return set;
}
inline constexpr unsigned kLargeTypes = type_set({GL_SHORT, GL_INT, GL_FLOAT, GL_DOUBLE}),
                          kColorTypes =
                              kLargeTypes | type_set({GL_BYTE, GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_UNSIGNED_INT});

/// An array's names in glEnableClientState, glGetPointer and glGet; 0: none. Then its sizes, the largest one is the initial
/// one, its types, and whether the largest integer is 1.
struct ArrayKind {
  GLenum enable, pointer, stride, buffer, type, size;
  int least, largest;
  unsigned types;
  bool is_normalized;
};
/// By Array.
inline constexpr std::array<ArrayKind, kArrayKinds> kArrayTable{
    {{GL_VERTEX_ARRAY, GL_VERTEX_ARRAY_POINTER, GL_VERTEX_ARRAY_STRIDE, GL_VERTEX_ARRAY_BUFFER_BINDING,
      GL_VERTEX_ARRAY_TYPE, GL_VERTEX_ARRAY_SIZE, 2, 4, kLargeTypes, false},
     {GL_NORMAL_ARRAY, GL_NORMAL_ARRAY_POINTER, GL_NORMAL_ARRAY_STRIDE, GL_NORMAL_ARRAY_BUFFER_BINDING,
      GL_NORMAL_ARRAY_TYPE, 0, 3, 3, kLargeTypes | type_set({GL_BYTE}), true},
     {GL_COLOR_ARRAY, GL_COLOR_ARRAY_POINTER, GL_COLOR_ARRAY_STRIDE, GL_COLOR_ARRAY_BUFFER_BINDING, GL_COLOR_ARRAY_TYPE,
      GL_COLOR_ARRAY_SIZE, 3, 4, kColorTypes, true},
     {GL_SECONDARY_COLOR_ARRAY, GL_SECONDARY_COLOR_ARRAY_POINTER, GL_SECONDARY_COLOR_ARRAY_STRIDE,
      GL_SECONDARY_COLOR_ARRAY_BUFFER_BINDING, GL_SECONDARY_COLOR_ARRAY_TYPE, GL_SECONDARY_COLOR_ARRAY_SIZE, 3, 3,
      kColorTypes, true},
     {GL_INDEX_ARRAY, GL_INDEX_ARRAY_POINTER, GL_INDEX_ARRAY_STRIDE, GL_INDEX_ARRAY_BUFFER_BINDING, GL_INDEX_ARRAY_TYPE,
      0, 1, 1, kLargeTypes | type_set({GL_UNSIGNED_BYTE}), false},
     {GL_EDGE_FLAG_ARRAY, GL_EDGE_FLAG_ARRAY_POINTER, GL_EDGE_FLAG_ARRAY_STRIDE, GL_EDGE_FLAG_ARRAY_BUFFER_BINDING, 0,
      0, 1, 1, type_set({GL_UNSIGNED_BYTE}), false},
     {GL_FOG_COORD_ARRAY, GL_FOG_COORD_ARRAY_POINTER, GL_FOG_COORD_ARRAY_STRIDE, GL_FOG_COORD_ARRAY_BUFFER_BINDING,
      GL_FOG_COORD_ARRAY_TYPE, 0, 1, 1, type_set({GL_FLOAT, GL_DOUBLE}), false},
     {kPointSizeArray, kPointSizeArrayPointer, kPointSizeArrayStride, kPointSizeArrayBufferBinding, kPointSizeArrayType,
      0, 1, 1, type_set({GL_FLOAT, GL_FIXED}), false},
     {GL_TEXTURE_COORD_ARRAY, GL_TEXTURE_COORD_ARRAY_POINTER, GL_TEXTURE_COORD_ARRAY_STRIDE,
      GL_TEXTURE_COORD_ARRAY_BUFFER_BINDING, GL_TEXTURE_COORD_ARRAY_TYPE, GL_TEXTURE_COORD_ARRAY_SIZE, 1, 4,
      kLargeTypes, false}}};

/// What the array at a place of ClientState::array is.
constexpr const ArrayKind& array_kind(std::size_t place) { return kArrayTable[std::min(place, kArrayKinds - 1)]; }
/// The place of an array, for texture coordinates that of the active unit.
inline std::size_t array_place(const ClientState& client, std::size_t kind) {
  return kind + (kind == kArrayKinds - 1 ? static_cast<std::size_t>(client.active_texture) : 0);
}
/// The place of the array that has `name` as its `member`; kArrays: there is none.
inline std::size_t find_array(const ClientState& client, GLenum ArrayKind::*member, GLenum name) {
  const auto found = std::ranges::find(kArrayTable, name, member);
  const auto kind = static_cast<std::size_t>(found - kArrayTable.begin());
  return name == 0 || kind == kArrayKinds ? kArrays : array_place(client, kind);
}

/// Bytes of a number of an array; 1 for unknown types.
[[nodiscard]] std::size_t array_type_bytes(GLenum type);
/// A number of a known type.
[[nodiscard]] double array_number(GLenum type, const std::byte* at);

}  // namespace halfplane::gl
