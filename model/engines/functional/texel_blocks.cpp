#include "texel_blocks.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace halfplane {
namespace {

int blocks_along(int texels) { return (texels + TexelBlocks::kSize - 1) / TexelBlocks::kSize; }

/// The next texel along an axis.
int next(int i, int size, TextureWrap wrap) {
  if (i + 1 < size) return i + 1;
  return wrap == TextureWrap::repeat ? 0 : i;
}

bool is_mirrored(const std::array<TextureWrap, 2>& wrap) {
  return wrap[0] == TextureWrap::mirror || wrap[1] == TextureWrap::mirror;
}

std::size_t index_of(const std::array<TextureWrap, 2>& wrap) {
  return (wrap[0] == TextureWrap::repeat ? 1U : 0U) + (wrap[1] == TextureWrap::repeat ? 2U : 0U);
}

std::uint32_t packed(const Texel& t) {
  return t[0] | std::uint32_t{t[1]} << 8 | std::uint32_t{t[2]} << 16 | std::uint32_t{t[3]} << 24;
}

/// Calls use(decode): decode(code) is a texel of the texture, R lowest. The formats of large images have their own.
template <class Use>
void with_decoder(const Texture& texture, const Use& use) {
  switch (texture.format) {
    case TextureFormat::rgba8888: return use([](std::uint32_t code) { return __builtin_bswap32(code); });
    case TextureFormat::la88: return use([](std::uint32_t code) { return (code >> 8) * 0x10101U | code << 24; });
    case TextureFormat::l8: return use([](std::uint32_t code) { return code * 0x10101U | 0xff000000U; });
    default:
      return use([&](std::uint32_t code) { return packed(decode_texel(texture.format, code, texture.palette)); });
  }
}

/// Footprints of four texels of a row, R lowest: `right` has those to the right of `left`, `lower...` the next row.
void make_quads(const std::uint32_t* left, const std::uint32_t* right, const std::uint32_t* lower_left,
                const std::uint32_t* lower_right, TexelBlocks::Quad* to) {
  using Words __attribute__((vector_size(16))) = std::uint32_t;
  struct Row {
    Words even, odd;  // channels of the left and the right texel

    Row(const std::uint32_t* from, const std::uint32_t* next) {
      constexpr std::uint32_t kEven = 0xff00ffU;
      Words l, r;
      std::memcpy(&l, from, sizeof l);
      std::memcpy(&r, next, sizeof r);
      even = (l & kEven) | (r & kEven) << 8;
      odd = (l >> 8 & kEven) | (r & ~kEven);
    }
  };
  const auto low = [](const Words& a, const Words& b) { return ((a & 0xffffU) | b << 16) ^ TexelBlocks::kCentre; };
  const auto high = [](const Words& a, const Words& b) { return (a >> 16 | (b & ~0xffffU)) ^ TexelBlocks::kCentre; };
  const Row above(left, right), below(lower_left, lower_right);
  const Words red = low(above.even, below.even), green = low(above.odd, below.odd), blue = high(above.even, below.even),
              alpha = high(above.odd, below.odd);
  const auto store = [](const Words& rg, const Words& ba, TexelBlocks::Quad* two) {
    const Words first = __builtin_shufflevector(rg, ba, 0, 1, 4, 5),
                second = __builtin_shufflevector(rg, ba, 2, 3, 6, 7);
    std::memcpy(two, &first, sizeof first);
    std::memcpy(two + 1, &second, sizeof second);
  };
  store(__builtin_shufflevector(red, green, 0, 4, 1, 5), __builtin_shufflevector(blue, alpha, 0, 4, 1, 5), to);
  store(__builtin_shufflevector(red, green, 2, 6, 3, 7), __builtin_shufflevector(blue, alpha, 2, 6, 3, 7), to + 2);
}

}  // namespace

TexelBlocks::TexelBlocks(const Texture& texture) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < texture.level.size(); ++n) {
    const TextureLevel& level = texture.level[n];
    size_.push_back({level.width, level.height});
    first[n] = static_cast<std::int32_t>(count * kTexels);
    count += static_cast<std::size_t>(blocks_along(level.width)) * static_cast<std::size_t>(blocks_along(level.height));
  }
  blocks.resize(count);
  std::uint32_t all = ~0U;
  with_decoder(texture, [&](const auto& decode) {
    for (std::size_t n = 0; n < texture.level.size(); ++n) {
      const TextureLevel& level = texture.level[n];
      const std::uint32_t* code = level.code.data();
      for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; x += kSize) {
          std::uint32_t* const row = row_of(n, x, y);
          for (int i = 0; i < std::min(kSize, level.width - x); ++i) all &= row[i] = decode(*code++);
        }
    }
  });
  is_opaque = all >> 24 == 255;
}

std::size_t TexelBlocks::place_of(std::size_t level, int x, int y) const {
  const int block = (x >> kShift) * blocks_along(size_[level].height) + (y >> kShift);
  return static_cast<std::size_t>(first[level] + block * kTexels + (y & (kSize - 1)) * kSize + (x & (kSize - 1)));
}

void TexelBlocks::add_quads(const std::array<TextureWrap, 2>& wrap) {
  std::vector<Quad>& quads = quads_[index_of(wrap)];
  if (is_mirrored(wrap) || !quads.empty() || blocks.size() * kTexels > kMostQuads) return;
  quads.resize(blocks.size() * kTexels);
  for (std::size_t n = 0; n < size_.size(); ++n) {
    const auto [width, height] = size_[n];
    for (int y = 0; y < height; ++y) {
      const int below = next(y, height, wrap[1]);
      for (int x = 0; x < width; x += kSize) {
        // The texels of a block's row, of the row below, and the texels next to their ends.
        const int count = std::min(kSize, width - x), right = next(x + count - 1, width, wrap[0]);
        const std::uint32_t *const upper = row_of(n, x, y), *const lower = row_of(n, x, below);
        std::array<std::uint32_t, kSize> next_upper{}, next_lower{};
        for (int i = 0; i + 1 < count; ++i) {
          next_upper[static_cast<std::size_t>(i)] = upper[i + 1];
          next_lower[static_cast<std::size_t>(i)] = lower[i + 1];
        }
        const auto end = static_cast<std::size_t>(count - 1);
        next_upper[end] = texel(place_of(n, right, y));
        next_lower[end] = texel(place_of(n, right, below));
        make_quads(upper, next_upper.data(), lower, next_lower.data(), quads.data() + place_of(n, x, y));
      }
    }
  }
}

const TexelBlocks::Quad* TexelBlocks::quads(const std::array<TextureWrap, 2>& wrap) const {
  const std::vector<Quad>& quads = quads_[index_of(wrap)];
  return is_mirrored(wrap) || quads.empty() ? nullptr : quads.data();
}

const std::uint32_t* TexelBlocks::alpha_quads(const std::array<TextureWrap, 2>& wrap) const {
  const std::vector<std::uint32_t>& alphas = alpha_quads_[index_of(wrap)];
  return is_mirrored(wrap) || alphas.empty() ? nullptr : alphas.data();
}

void TexelBlocks::add_alpha_quads() {
  for (std::size_t i = 0; i < quads_.size(); ++i) {
    if (alpha_quads_[i].size() == quads_[i].size()) continue;
    alpha_quads_[i].clear();
    for (const Quad& quad : quads_[i]) alpha_quads_[i].push_back(quad[3]);
  }
}

void TexelBlocks::add_alpha_ranges() {
  const auto [width, height] = size_[0];
  const auto is_power = [](int side) { return std::has_single_bit(static_cast<unsigned>(side)); };
  if (alpha_ranges_ || !is_power(width) || !is_power(height)) return;
  alpha_ranges_.emplace(*this, std::array{std::countr_zero(static_cast<unsigned>(width)),
                                          std::countr_zero(static_cast<unsigned>(height))});
}

TexelBlocks::AlphaRanges::AlphaRanges(const TexelBlocks& texels, const std::array<int, 2>& bits) : bits_(bits) {
  const auto add = [](Range& to, std::uint8_t low, std::uint8_t high) {
    to.low = std::min(to.low, low);
    to.high = std::max(to.high, high);
  };
  for (int shift = kShift;; ++shift) {
    const int columns = bits_along(0, shift), rows = bits_along(1, shift);
    std::vector<Range> squares(std::size_t{1} << (columns + rows));
    const auto square = [&](int x, int y) -> Range& { return squares[static_cast<std::size_t>(y << columns | x)]; };
    if (squares_.empty()) {
      for (int y = 0; y < 1 << bits[1]; ++y)
        for (int x = 0; x < 1 << bits[0]; ++x) {
          const auto alpha = static_cast<std::uint8_t>(texels.texel(texels.place_of(0, x, y)) >> 24);
          add(square(x >> shift, y >> shift), alpha, alpha);
        }
    } else {
      const std::vector<Range>& finer = squares_.back();
      const int finer_columns = bits_along(0, shift - 1), finer_rows = bits_along(1, shift - 1);
      for (int y = 0; y < 1 << finer_rows; ++y)
        for (int x = 0; x < 1 << finer_columns; ++x) {
          const Range& from = finer[static_cast<std::size_t>(y << finer_columns | x)];
          add(square(std::min(x >> 1, (1 << columns) - 1), std::min(y >> 1, (1 << rows) - 1)), from.low, from.high);
        }
    }
    squares_.push_back(std::move(squares));
    if (columns == 0 && rows == 0) return;
  }
}

TexelBlocks::AlphaRanges::Range TexelBlocks::AlphaRanges::range(const std::array<std::int32_t, 2>& low,
                                                                const std::array<std::int32_t, 2>& high,
                                                                const std::array<TextureWrap, 2>& wrap) const {
  // Squares such that two along each axis cover the columns and rows.
  std::size_t level = 0;
  const auto is_more_than_two = [&](std::size_t axis) {
    const auto shift = static_cast<int>(level) + kShift;
    return (high[axis] >> shift) - (low[axis] >> shift) > 1;
  };
  while (level + 1 < squares_.size() && (is_more_than_two(0) || is_more_than_two(1))) ++level;
  if (is_more_than_two(0) || is_more_than_two(1)) return squares_.back().front();
  const auto shift = static_cast<int>(level) + kShift;
  const auto along = [&](std::size_t axis, std::int32_t texel) -> std::size_t {
    const std::int32_t square = texel >> shift, last = (1 << bits_along(axis, shift)) - 1, period = 2 * last + 1;
    switch (wrap[axis]) {
      case TextureWrap::repeat: return static_cast<std::size_t>(square & last);
      case TextureWrap::clamp: return static_cast<std::size_t>(std::clamp(square, 0, last));
      default: return static_cast<std::size_t>((square & period) > last ? period - (square & period) : square & period);
    }
  };
  Range all;
  for (const std::int32_t y : {low[1], high[1]})
    for (const std::int32_t x : {low[0], high[0]}) {
      const Range& one = squares_[level][along(1, y) << bits_along(0, shift) | along(0, x)];
      all.low = std::min(all.low, one.low);
      all.high = std::max(all.high, one.high);
    }
  return all;
}

}  // namespace halfplane
