// The accessors of a glTF file: checked on construction, read element by element.
#include <algorithm>
#include <bit>
#include <cmath>

#include "model/config.hpp"
#include "sim/scene/gltf_file.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr std::uint64_t kMostElements = 0xffffffff;            // indices have 32 bits
constexpr std::uint64_t kMostOffset = std::uint64_t{1} << 40;  // keeps every sum below in 64 bits

constexpr std::size_t size_of(GltfComponent component) {
  switch (component) {
    case GltfComponent::i8:
    case GltfComponent::u8: return 1;
    case GltfComponent::i16:
    case GltfComponent::u16: return 2;
    default: return 4;
  }
}

GltfComponent component_of(const JsonPlace& place) {
  switch (const std::uint64_t code = place.whole(0xffff)) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126: return static_cast<GltfComponent>(code);
    default: place.fail("component type " + std::to_string(code), "it is one of 5120...5123, 5125 and 5126");
  }
}

int width_of(const JsonPlace& place) {
  const std::string type = place.text();
  if (type == "SCALAR") return 1;
  if (type == "MAT4") return 16;
  if (type.size() == 4 && type.substr(0, 3) == "VEC" && type[3] >= '2' && type[3] <= '4') return type[3] - '0';
  place.fail("type " + in_quotes(type), "what is drawn is made of SCALAR, VEC2, VEC3, VEC4 or MAT4");
}

// Returns `bytes` from `offset` on, if `count` elements of `size` bytes, `stride` apart, lie in them. count >= 1.
ByteSpan checked(ByteSpan bytes, const JsonPlace& place, std::uint64_t count, std::size_t size, std::size_t stride) {
  const std::uint64_t offset = place.whole_or("byteOffset", kMostOffset, 0);
  const std::uint64_t end = offset + (count - 1) * stride + size;  // < 2^40 + 2^32 * 2^8 + 16
  if (end > bytes.size()) {
    place.fail(std::to_string(count) + " elements need " + std::to_string(end) + " bytes of a buffer view of " +
                   std::to_string(bytes.size()),
               "correct count, byteOffset or the view");
  }
  return bytes.subspan(static_cast<std::size_t>(offset));
}

std::uint32_t bits_at(ByteSpan bytes, std::size_t at, std::size_t size) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) bits |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
  return bits;
}

// One number; both lowest codes of a signed normalized number are -1.
double number_at(ByteSpan bytes, std::size_t at, GltfComponent component, bool normalized) {
  const std::uint32_t bits = bits_at(bytes, at, size_of(component));
  double value = bits, largest = 1;
  switch (component) {
    case GltfComponent::i8:
      value = static_cast<std::int8_t>(bits);
      largest = 127;
      break;
    case GltfComponent::i16:
      value = static_cast<std::int16_t>(bits);
      largest = 32767;
      break;
    case GltfComponent::u8: largest = 255; break;
    case GltfComponent::u16: largest = 65535; break;
    case GltfComponent::u32: largest = 4294967295.0; break;
    case GltfComponent::f32: return std::bit_cast<float>(bits);
  }
  return normalized ? std::max(value / largest, -1.0) : value;
}

std::uint32_t sparse_index(const GltfAccessor& accessor, std::uint64_t k) {
  const std::size_t size = size_of(accessor.sparse_component);
  return bits_at(accessor.sparse_indices, static_cast<std::size_t>(k) * size, size);
}

// The index of element i among the replaced ones, or sparse_count. Their indices ascend.
std::uint64_t find_sparse(const GltfAccessor& accessor, std::uint64_t i) {
  std::uint64_t low = 0, high = accessor.sparse_count;
  while (low < high) {
    const std::uint64_t middle = (low + high) / 2;
    if (sparse_index(accessor, middle) < i) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  const bool found = low < accessor.sparse_count && sparse_index(accessor, low) == i;
  return found ? low : accessor.sparse_count;
}

/// The first N numbers of an element; missing ones are 0.
template <std::size_t N>
std::array<double, N> numbers_at(const GltfAccessor& accessor, std::uint64_t i) {
  std::array<double, N> result{};
  const std::size_t size = size_of(accessor.component), width = static_cast<std::size_t>(accessor.width);
  const std::uint64_t sparse = find_sparse(accessor, i);
  const bool is_replaced = sparse < accessor.sparse_count;
  const ByteSpan bytes = is_replaced ? accessor.sparse_values : accessor.bytes;
  if (bytes.empty()) return result;
  const std::size_t at =
      is_replaced ? static_cast<std::size_t>(sparse) * size * width : static_cast<std::size_t>(i) * accessor.stride;
  for (std::size_t k = 0; k < std::min(N, width); ++k) {
    result[k] = number_at(bytes, at + k * size, accessor.component, accessor.normalized);
    if (!std::isfinite(result[k])) {
      throw InputError(accessor.place + ": element " + std::to_string(i) +
                       " is not a finite number; export the file again");
    }
  }
  return result;
}

}  // namespace

GltfAccessor GltfFile::make_accessor(const JsonPlace& place) {
  GltfAccessor made;
  made.place = name_ + ": " + place.path();
  made.component = component_of(place.at("componentType"));
  made.width = width_of(place.at("type"));
  made.normalized = place.flag_or("normalized", false);
  made.count = place.at("count").whole(kMostElements);
  if (made.count == 0) place.at("count").fail("no elements", "write at least 1");
  const std::size_t size = size_of(made.component) * static_cast<std::size_t>(made.width);
  if (const std::optional<JsonPlace> index = place.find("bufferView")) {
    const JsonPlace bytes = follow(*index, "bufferViews");
    made.stride = static_cast<std::size_t>(bytes.whole_or("byteStride", 252, size));
    if (made.stride < size) {
      bytes.fail(
          "byteStride " + std::to_string(made.stride) + " below the " + std::to_string(size) + " bytes of an element",
          "correct it, or leave it out");
    }
    made.bytes = checked(view(bytes), place, made.count, size, made.stride);
  }
  if (place.find("sparse")) add_sparse(made, place.at("sparse"));
  return made;
}

void GltfFile::add_sparse(GltfAccessor& accessor, const JsonPlace& place) {
  const std::uint64_t count = place.at("count").whole(accessor.count);
  if (count == 0) return;
  const JsonPlace indices = place.at("indices"), values = place.at("values");
  const GltfComponent component = component_of(indices.at("componentType"));
  if (component != GltfComponent::u8 && component != GltfComponent::u16 && component != GltfComponent::u32) {
    indices.fail("indices that are not unsigned", "use component type 5121, 5123 or 5125");
  }
  const auto bytes_of = [&](const JsonPlace& part, std::size_t size) {
    return checked(view(follow(part.at("bufferView"), "bufferViews")), part, count, size, size);
  };
  accessor.sparse_component = component;
  accessor.sparse_indices = bytes_of(indices, size_of(component));
  accessor.sparse_values = bytes_of(values, size_of(accessor.component) * static_cast<std::size_t>(accessor.width));
  accessor.sparse_count = count;
  for (std::uint64_t k = 0; k < count; ++k) {
    if (sparse_index(accessor, k) >= accessor.count) {
      indices.fail(
          "index " + std::to_string(sparse_index(accessor, k)) + " of " + std::to_string(accessor.count) + " elements",
          "correct it");
    }
    if (k > 0 && sparse_index(accessor, k) <= sparse_index(accessor, k - 1)) {
      indices.fail("indices that do not ascend", "sort them, each once");
    }
  }
}

std::array<double, 4> read_element(const GltfAccessor& accessor, std::uint64_t i) { return numbers_at<4>(accessor, i); }

std::array<double, 16> read_matrix(const GltfAccessor& accessor, std::uint64_t i) {
  return numbers_at<16>(accessor, i);
}

}  // namespace halfplane
