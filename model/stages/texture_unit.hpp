// Texture unit: the texture of a stamp's live samples in hardware, level 0, nearest or linear, and the cache that it reads
// through. Its coordinates, texels and colours are those of perspective.hpp, texture_filter.hpp and texture.hpp.
//
// In memory a texture is a row of rows of blocks of 4x4 texels, the texels of a block row by row, a code's low byte first;
// sides below 4 are padded to a block, palettes are gone (rgba8888). A block is a line of the cache: 16, 32 or 64 bytes. The
// lowest bits of its column and row say where in the cache it may lie.
//
// A state holds for the stamps behind it. Stamps of other primitives than triangles, stamps without live samples, and all
// while the state's texture is off pass as they are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../fixed.hpp"
#include "../samples.hpp"
#include "../scene.hpp"
#include "../texture.hpp"
#include "perspective.hpp"
#include "texture_filter.hpp"

namespace halfplane {

inline constexpr int kTextureBlock = 4;                                 ///< texels along its side
inline constexpr int kTextureLine = 4 * kTextureBlock * kTextureBlock;  ///< bytes at most
using TextureLine = std::array<std::uint8_t, kTextureLine>;

/// Of a format without palette: log2 of a texel's bytes.
[[nodiscard]] constexpr int texel_size_log2(TextureFormat format) {
  return format == TextureFormat::l8 ? 0 : format == TextureFormat::rgba8888 ? 2 : 1;
}
/// The format in which hardware stores it.
[[nodiscard]] TextureFormat stored_format(TextureFormat format);
/// Level 0 as it lies in memory.
[[nodiscard]] std::vector<std::uint8_t> texture_bytes(const Texture& texture);

/// What the unit knows of a draw.
struct TextureState {
  static constexpr int kBits = 46;
  bool enable = false;
  bool invalidates = false;  ///< drops what is in the cache. Needed where memory that was read has other texels now
  TextureFormat format = TextureFormat::l8;  ///< without palette
  TextureCombine combine = TextureCombine::modulate;
  std::array<TextureWrap, 2> wrap{};
  std::array<int, 2> log2_size{};  ///< width, height; 0 to 12
  std::uint32_t base = 0;          ///< byte address, a multiple of 64
  bool is_linear = false;          ///< only of a unit with that filter

  /// From the lowest bit: enable, invalidates, format 3, combine 2, wraps 2 + 2, sizes 4 + 4, base / 64 26, is_linear.
  [[nodiscard]] std::uint64_t pack() const;
  [[nodiscard]] static TextureState unpack(std::uint64_t word);
  [[nodiscard]] TextureAxes axes() const;
  bool operator==(const TextureState&) const = default;
};

/// That of a texture of power-of-two sides at `base`.
[[nodiscard]] TextureState texture_state(const Texture& texture, const State& state, std::uint32_t base);

struct TextureSettings {
  int lines = 64;           ///< of the cache; a power of two, at least 2
  int port_bits = 64;       ///< of a beat of its memory port
  int queue = 16;           ///< stamps inside
  int in_flight = 32;       ///< samples between address and texel
  bool has_linear = false;  ///< FILTER: four texels a sample, lines in four banks
  /// Beats of a line.
  [[nodiscard]] int beats(TextureFormat format) const { return (128 << texel_size_log2(format)) / port_bits; }
};

/// A sample's way through the cache.
struct TextureLookup {
  std::uint32_t address = 0;  ///< of its line
  std::uint32_t line = 0;     ///< the place in the cache
  bool is_miss = false;
  int beats = 1;     ///< of the line
  bool ends = true;  ///< the last of its sample's lines
};

/// Which lines are in the cache.
class TextureCache {
 public:
  explicit TextureCache(int lines) : lines_(static_cast<std::size_t>(lines)) {
    const int bits = floor_log2(static_cast<unsigned>(lines));
    x_bits_ = (bits + 1) / 2;
    y_bits_ = bits / 2;
  }

  /// Where the block of that column and row may lie.
  [[nodiscard]] std::uint32_t line_of(std::uint32_t x, std::uint32_t y) const {
    return (y & ((1U << y_bits_) - 1)) << x_bits_ | (x & ((1U << x_bits_) - 1));
  }
  /// Whether the line was there; it is now.
  bool access(std::uint32_t address, std::uint32_t line) {
    Line& l = lines_[line];
    const bool is_hit = l.is_valid && l.address == address;
    l = {true, address};
    return is_hit;
  }
  void drop() {
    for (Line& line : lines_) line.is_valid = false;
  }

 private:
  struct Line {
    bool is_valid = false;
    std::uint32_t address = 0;
  };
  std::vector<Line> lines_;
  int x_bits_ = 0, y_bits_ = 0;
};

/// What the samples of a triangle share, u and v.
struct TextureFrame {
  std::array<OverWScale, 2> scale{};
  std::array<std::int32_t, 2> reference{};  ///< wrapped_reference()
};

/// A sample's place, local to its tile (q_at, p_at).
struct TextureSample {
  std::uint64_t q = 1;
  std::array<std::int64_t, 2> p{};
};

class TextureUnit {
 public:
  TextureUnit(const TextureSettings& settings, const PerspectiveFormat& format)
      : settings_(settings), format_(format), cache_(settings.lines), data_(static_cast<std::size_t>(settings.lines)) {}

  [[nodiscard]] const TextureState& state() const { return state_; }
  void set(const TextureState& state) {
    state_ = state;
    if (state.invalidates) cache_.drop();
  }
  [[nodiscard]] bool is_textured(bool is_triangle, SampleMask live) const {
    return state_.enable && is_triangle && live.any();
  }

  /// A sample's place on the texture.
  [[nodiscard]] TexturePlace place_of(const TextureSample& sample, const TextureFrame& frame) const {
    const OverWFormat& attribute = format_.coordinate;
    const PixelReciprocal q = divide_by_q(sample.q, format_);
    const TextureAxes axes = state_.axes();
    TexturePlace place{{}, attribute.fraction_bits};
    for (const std::size_t i : {0U, 1U})
      place.coordinate[i] = texture_coordinate(over_q(sample.p[i], q, frame.scale[i], attribute, format_),
                                               frame.reference[i], attribute.fraction_bits, axes[i]);
    return place;
  }

  /// The columns and rows of texels that it looks at: of a nearest filter one of each, twice.
  [[nodiscard]] std::array<TexelPair, 2> texels_of(const TexturePlace& place) const {
    const TextureAxes axes = state_.axes();
    std::array<TexelPair, 2> texels{};
    for (const std::size_t i : {0U, 1U}) {
      if (state_.is_linear) {
        texels[i] = texels_around(place, axes, i, 0);
      } else {
        texels[i].first = texels[i].second = wrapped_texel(place.coordinate[i] >> place.fraction_bits, axes[i]);
      }
    }
    return texels;
  }

  /// A stamp whose samples `live` are textured: their colours become those of the result. read(address, beats): the bytes of
  /// a line, asked for in order. Returns what the samples did, lowest first; it stays until the next stamp.
  template <class Read>
  std::span<const TextureLookup> take(SampleMask live, std::span<const TextureSample> samples,
                                      const TextureFrame& frame, std::span<Texel> colors, Read&& read) {
    lookups_.clear();
    live.for_each([&](std::size_t s) {
      const TexturePlace place = place_of(samples[s], frame);
      const auto [x, y] = texels_of(place);
      // Bank by bank, by the lowest bits of a block's row and column; without banks the one block that there is.
      for (const int bank : {0, 1, 2, 3}) {
        const auto block_x = block_in(x, bank & 1), block_y = block_in(y, bank >> 1);
        if (block_x >= 0 && block_y >= 0)
          look_up(static_cast<std::uint32_t>(block_x), static_cast<std::uint32_t>(block_y), read);
      }
      lookups_.back().ends = true;
      const auto fetch = [this](int, int column, int row) { return texel(column, row); };
      const Texel texel = state_.is_linear ? filter_linear(fetch, state_.axes(), place, 0) : fetch(0, x.first, y.first);
      colors[s] = combined(colors[s], texel, state_.combine, has_alpha(state_.format));
    });
    return lookups_;
  }

 private:
  /// Of two columns or rows of texels, the block whose lowest bit is `bit`; -1: there is none.
  [[nodiscard]] static int block_in(const TexelPair& pair, int bit) {
    for (const int texel : {pair.first, pair.second})
      if ((texel / kTextureBlock & 1) == bit) return texel / kTextureBlock;
    return -1;
  }
  template <class Read>
  void look_up(std::uint32_t block_x, std::uint32_t block_y, Read&& read) {
    const int row = std::max(0, state_.log2_size[0] - 2);
    TextureLookup lookup;
    lookup.address = state_.base + (((block_y << row) + block_x) << (4 + texel_size_log2(state_.format)));
    lookup.line = cache_.line_of(block_x, block_y);
    lookup.is_miss = !cache_.access(lookup.address, lookup.line);
    lookup.beats = settings_.beats(state_.format);
    lookup.ends = false;
    if (lookup.is_miss) data_[lookup.line] = read(lookup.address, lookup.beats);
    lookups_.push_back(lookup);
  }
  /// A texel whose line is there.
  [[nodiscard]] Texel texel(int column, int row) const {
    const auto x = static_cast<std::uint32_t>(column), y = static_cast<std::uint32_t>(row);
    const TextureLine& line = data_[cache_.line_of(x / kTextureBlock, y / kTextureBlock)];
    const int size = texel_size_log2(state_.format);
    const std::uint32_t at = (y % kTextureBlock * kTextureBlock + x % kTextureBlock) << size;
    std::uint32_t code = 0;
    for (std::uint32_t i = 0; i >> size == 0; ++i) code |= std::uint32_t{line[at + i]} << (8 * i);
    return decode_texel(state_.format, code, {});
  }

  TextureSettings settings_;
  PerspectiveFormat format_;
  TextureState state_;
  TextureCache cache_;
  std::vector<TextureLine> data_;
  std::vector<TextureLookup> lookups_;
};

}  // namespace halfplane
