#include "texture_unit.hpp"

namespace halfplane {
namespace {

/// Appends a level to the earlier levels.
void put_level(std::vector<std::uint8_t>& memory, const Texture& texture, int level, const LevelPlace& place) {
  const TextureLevel& image = texture.level[static_cast<std::size_t>(level)];
  const TextureFormat format = stored_format(texture.format);
  const auto bytes = std::size_t{1} << texel_size_log2(format);
  constexpr int kTexels = kTextureBlock * kTextureBlock;
  const auto blocks = [](int size) { return (size + kTextureBlock - 1) / kTextureBlock; };
  const int row = blocks(image.width), first = static_cast<int>(place.block), corner = place.is_corner ? 2 : 0;
  memory.resize(static_cast<std::size_t>((first + row * blocks(image.height)) * kTexels) * bytes);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      std::uint32_t code = image.code[static_cast<std::size_t>(y * image.width + x)];
      if (format != texture.format) code = encode_texel(format, texture.palette[code], {});
      const int block = first + y / kTextureBlock * row + x / kTextureBlock;
      const int texel = (y + corner) % kTextureBlock * kTextureBlock + (x + corner) % kTextureBlock;
      const std::size_t at = static_cast<std::size_t>(block * kTexels + texel) * bytes;
      for (std::size_t i = 0; i < bytes; ++i) memory[at + i] = static_cast<std::uint8_t>(code >> (8 * i));
    }
}

/// TextureWrap in a state's word.
constexpr std::uint64_t kHalfBorder = 5;
std::uint64_t code_of(TextureWrap wrap) {
  return wrap == TextureWrap::half_border ? kHalfBorder : static_cast<std::uint64_t>(wrap);
}
TextureWrap wrap_of(std::uint64_t code) {
  return code == kHalfBorder ? TextureWrap::half_border : static_cast<TextureWrap>(code);
}

}  // namespace

TextureFormat stored_format(TextureFormat format) {
  return palette_size(format) != 0 ? TextureFormat::rgba8888 : format;
}

std::vector<std::uint8_t> texture_bytes(const Texture& texture, bool has_levels) {
  const TextureAxes axes{TextureAxis{texture.width()}, TextureAxis{texture.height()}};
  const std::array log2_size{floor_log2(static_cast<unsigned>(texture.width())),
                             floor_log2(static_cast<unsigned>(texture.height()))};
  has_levels = has_levels && axes[0].is_power_of_two() && axes[1].is_power_of_two();
  std::vector<std::uint8_t> memory;
  for (int n = 0; n <= (has_levels ? texture.last_level() : 0); ++n)
    put_level(memory, texture, n, has_levels ? level_place(log2_size, n) : LevelPlace{});
  return memory;
}

std::uint64_t TextureState::pack() const {
  std::uint64_t word = 0;
  int at = 0;
  const auto put = [&](std::uint64_t value, int bits) {
    word |= value << at;
    at += bits;
  };
  put(enable ? 1 : 0, 1);
  put(invalidates ? 1 : 0, 1);
  put(static_cast<std::uint64_t>(format), 3);
  put(static_cast<std::uint64_t>(combine) & 3, 2);
  for (const TextureWrap w : wrap) put(code_of(w) & 3, 2);
  for (const int size : log2_size) put(static_cast<std::uint64_t>(size), 4);
  put(base / kTextureLine, 26);
  put(is_linear ? 1 : 0, 1);
  put(static_cast<std::uint64_t>(combine) >> 2, 1);
  for (const TextureWrap w : wrap) put(code_of(w) >> 2, 1);
  return word;
}

TextureState TextureState::unpack(std::uint64_t word) {
  const auto take = [&word](int bits) {
    const std::uint64_t value = word & ((std::uint64_t{1} << bits) - 1);
    word >>= bits;
    return value;
  };
  TextureState state;
  state.enable = take(1) != 0;
  state.invalidates = take(1) != 0;
  state.format = static_cast<TextureFormat>(take(3));
  const std::uint64_t combine = take(2);
  std::array<std::uint64_t, 2> wrap{};
  for (std::uint64_t& code : wrap) code = take(2);
  for (int& size : state.log2_size) size = static_cast<int>(take(4));
  state.base = static_cast<std::uint32_t>(take(26)) * kTextureLine;
  state.is_linear = take(1) != 0;
  state.combine = static_cast<TextureCombine>(combine | take(1) << 2);
  for (const std::size_t i : {0U, 1U}) state.wrap[i] = wrap_of(wrap[i] | take(1) << 2);
  return state;
}

TextureAxes TextureState::axes() const {
  return {TextureAxis{1 << log2_size[0], wrap[0]}, TextureAxis{1 << log2_size[1], wrap[1]}};
}

TextureState texture_state(const Texture& texture, const State& state, std::uint32_t base) {
  TextureState result;
  result.enable = true;
  result.format = stored_format(texture.format);
  result.combine = state.texture_combine;
  result.wrap = state.texture_wrap;
  result.log2_size = {floor_log2(static_cast<unsigned>(texture.width())),
                      floor_log2(static_cast<unsigned>(texture.height()))};
  result.base = base;
  result.is_linear = state.texture_mag == TextureMag::linear;
  return result;
}

}  // namespace halfplane
