// Texture unit: the texture of a stamp's live samples in hardware, nearest or linear, on one level or between two, and
// its cache. Its coordinates, levels, texels and colours are those of perspective.hpp, level_of_detail.hpp,
// texture_sample.hpp, texture_filter.hpp and texture.hpp.
//
// In memory a level is a row of rows of blocks of 4x4 texels, the texels of a block row by row, a code's low byte
// first; sides below 4 are padded to a block, palettes are gone (rgba8888). texture_levels.hpp gives the start of the
// levels. A block is a line of the cache: 16, 32 or 64 bytes. The lowest bits of its column and row give its place in
// the cache; for a draw that reads two levels the highest of the row's bits says whether the level is odd, so that the
// levels do not conflict. With two ways a block may lie in two places, which differ in the highest bit of its row's
// part, or its column's where that has more; a miss replaces the line that was looked up longer ago. Then two levels
// share all places.
//
// A sample between two levels goes through cache and filter twice, once if the second level adds nothing.
//
// With four lanes the live samples of 2x2 go together. Their texels come from 16 banks, by the two lowest bits of
// column and row, and their lines from four, by the lowest bits of the blocks' column and row. So a clock serves
// samples that agree: along either axis no two of their texels are in one bank unless in one block, nor their blocks.
// Where not all agree, the first sample left takes with it, in order, each sample that agrees with all before, and the
// others follow. With levels samples agree only on one level; samples between two levels go a second time after all
// others, on their upper levels.
//
// Colours over w are divided here, by the reciprocal of the coordinates; the quotient is combined with the texture. A
// flag of the triangle selects this.
//
// A texel of the border counts as the texel next to it: its line is looked up, and its colour replaced. So a draw with
// half_border, whose samples have a texel of the image next to each of the border, uses the cache as with clamp.
//
// A state holds for later stamps. Stamps of primitives other than triangles, stamps without live samples, and all
// stamps while the state's texture is off and colours are affine pass unchanged.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../fixed.hpp"
#include "../formats/texture.hpp"
#include "../samples.hpp"
#include "../scene.hpp"
#include "perspective.hpp"
#include "texture_filter.hpp"
#include "texture_levels.hpp"

namespace halfplane {

inline constexpr int kTextureBlock = 4;                                 ///< texels along its side
inline constexpr int kTextureLine = 4 * kTextureBlock * kTextureBlock;  ///< bytes at most
using TextureLine = std::array<std::uint8_t, kTextureLine>;

/// For a format without palette: log2 of a texel's bytes.
[[nodiscard]] constexpr int texel_size_log2(TextureFormat format) {
  return format == TextureFormat::l8 ? 0 : format == TextureFormat::rgba8888 ? 2 : 1;
}
/// The format in which hardware stores it.
[[nodiscard]] TextureFormat stored_format(TextureFormat format);
/// The texture's bytes in memory: level 0, or all levels if the sides are powers of two.
[[nodiscard]] std::vector<std::uint8_t> texture_bytes(const Texture& texture, bool has_levels = false);

/// The unit's state for a draw.
struct TextureState {
  static constexpr int kBits = 49;
  bool enable = false;
  bool invalidates = false;                  ///< drops the cache's content. Needed if the texels in memory have changed
  TextureFormat format = TextureFormat::l8;  ///< without palette
  TextureCombine combine = TextureCombine::modulate;
  std::array<TextureWrap, 2> wrap{};
  std::array<int, 2> log2_size{};  ///< width, height; 0 to 12
  std::uint32_t base = 0;          ///< byte address, a multiple of 64
  bool is_linear = false;          ///< only with that filter; with levels: texture_mag

  /// From the lowest bit: enable, invalidates, format 3, combine 2, wraps 2 + 2, sizes 4 + 4, base / 64 26, is_linear,
  /// the third bit of combine: only of a unit with the constant, the third bits of the wraps: only of one with the
  /// border (0 repeat, 1 clamp, 2 mirror, 3 border, 5 half_border: the lowest bit keeps texels in the image).
  [[nodiscard]] std::uint64_t pack() const;
  [[nodiscard]] static TextureState unpack(std::uint64_t word);
  [[nodiscard]] TextureAxes axes() const;
  bool operator==(const TextureState&) const = default;
};

/// The constant colour of a draw that blends by its texels (texture.constant).
struct TextureConstant {
  std::array<std::uint8_t, 3> color{};

  /// From the lowest bit: R, G, B.
  [[nodiscard]] constexpr std::uint64_t pack() const {
    return tag_of(LevelsWord::constant) | std::uint64_t{color[2]} << 16 | std::uint64_t{color[1]} << 8 | color[0];
  }
  [[nodiscard]] static constexpr TextureConstant unpack(std::uint64_t word) {
    return {
        {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word >> 16)}};
  }
};

/// The border's colour (texture.border), as texel of the draw's format.
struct TextureBorder {
  Texel color{};

  /// From the lowest bit: R, G, B, A.
  [[nodiscard]] constexpr std::uint64_t pack() const {
    return tag_of(LevelsWord::border) | std::uint64_t{color[3]} << 24 | std::uint64_t{color[2]} << 16 |
           std::uint64_t{color[1]} << 8 | color[0];
  }
  [[nodiscard]] static constexpr TextureBorder unpack(std::uint64_t word) {
    return {{static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
             static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 24)}};
  }
};

/// The state of a texture with power-of-two sides at `base`.
[[nodiscard]] TextureState texture_state(const Texture& texture, const State& state, std::uint32_t base);

struct TextureSettings {
  int lines = 64;           ///< of the cache; a power of two, at least 2
  int port_bits = 64;       ///< of a beat of its memory port
  int queue = 16;           ///< stamps inside
  int in_flight = 32;       ///< samples between address and texel
  bool has_linear = false;  ///< FILTER: four texels a sample, lines in four banks
  bool has_levels = false;  ///< likewise: more than level 0; has_linear as well
  int line_bits = 104;      ///< of a TextureLines in a token
  int lanes = 1;            ///< LANES: samples that go together, 1 or 4
  int stamp_size = 2;       ///< with several lanes: samples along a stamp's side
  int ways = 1;             ///< places in the cache where a line may lie: 1, or 2 where lines are in banks
  /// Lines in four banks, requested one by one.
  [[nodiscard]] bool has_banks() const { return has_linear || lanes != 1; }
  /// Beats of a line.
  [[nodiscard]] int beats(TextureFormat format) const { return (128 << texel_size_log2(format)) / port_bits; }
};

/// A line in the cache lookup of a sample, or of samples that go together.
struct TextureLookup {
  std::uint32_t address = 0;  ///< of its line
  std::uint32_t line = 0;     ///< its place in the cache
  bool is_miss = false;
  int beats = 1;  ///< of the line
  int bank = 0;
  std::size_t sample = 0;  ///< number in the stamp: the first sample that needs it
  bool ends = true;        ///< the last of the lines that are looked up together
  bool continues = false;  ///< the sample needs another level, or other samples of the group follow
  bool turns = false;      ///< samples of one round: the next lookups are on upper levels, this one on lower
  int samples = 0;         ///< samples completed by the last line
  int hits = 0;            ///< samples among them whose lines were all present
};

/// The samples' use of the cache, each counted once for any number of levels.
struct TextureUse {
  std::uint64_t samples = 0;
  std::uint64_t hits = 0;   ///< samples that found all of their lines
  std::uint64_t fills = 0;  ///< lines requested
};
[[nodiscard]] inline TextureUse use_of(std::span<const TextureLookup> lookups) {
  TextureUse use;
  for (const TextureLookup& lookup : lookups) {
    use.fills += lookup.is_miss ? 1 : 0;
    use.samples += static_cast<std::uint64_t>(lookup.samples);
    use.hits += static_cast<std::uint64_t>(lookup.hits);
  }
  return use;
}

/// Whether several lanes can read these columns, or rows, of texels in one clock: of one block, or neither texels nor
/// blocks in one bank.
[[nodiscard]] constexpr bool agree(int a, int b) {
  const int block_a = a / kTextureBlock, block_b = b / kTextureBlock;
  return block_a == block_b || (((block_a ^ block_b) & 1) != 0 && (a ^ b) % kTextureBlock != 0);
}
[[nodiscard]] constexpr bool agree(const TexelPair& a, const TexelPair& b) {
  bool all = true;
  for (const int u : {a.first, a.second})
    for (const int v : {b.first, b.second}) all &= agree(u, v);
  return all;
}

/// The lines in the cache.
class TextureCache {
 public:
  struct Access {
    std::uint32_t line = 0;  ///< its place now
    bool is_hit = false;     ///< it was there
  };

  explicit TextureCache(int lines, int ways = 1) : lines_(static_cast<std::size_t>(lines)) {
    const int bits = floor_log2(static_cast<unsigned>(lines));
    x_bits_ = (bits + 1) / 2;
    y_bits_ = bits / 2;
    if (ways == 2) second_ = std::uint32_t{1} << ((x_bits_ == y_bits_ ? bits : x_bits_) - 1);
  }

  /// The place of the block with that column and row; with two ways the first.
  [[nodiscard]] std::uint32_t line_of(std::uint32_t x, std::uint32_t y) const {
    return ((y & ((1U << y_bits_) - 1)) << x_bits_ | (x & ((1U << x_bits_) - 1))) & ~second_;
  }
  /// The same in the half for even or for odd levels, where there is one way.
  [[nodiscard]] std::uint32_t line_of(std::uint32_t x, std::uint32_t y, int level) const {
    if (second_ != 0) return line_of(x, y);
    const auto half = std::uint32_t{1} << (y_bits_ - 1);
    return line_of(x, (y & (half - 1)) | ((level & 1) != 0 ? half : 0));
  }
  /// The place of a line that is in the cache; `first` from line_of().
  [[nodiscard]] std::uint32_t find(std::uint32_t address, std::uint32_t first) const {
    return is_at(address, first) ? first : first | second_;
  }
  /// Brings the line into the cache, if missing: with two ways in place of the line that was looked up longer ago.
  Access access(std::uint32_t address, std::uint32_t first) {
    const std::uint32_t second = first | second_;
    Access result{first, is_at(address, first)};
    if (!result.is_hit && second != first) {
      const bool is_second = is_at(address, second);
      if (is_second || !lines_[first].is_second_newer) result.line = second;
      result.is_hit = is_second;
    }
    lines_[result.line].is_valid = true;
    lines_[result.line].address = address;
    lines_[first].is_second_newer = result.line != first;
    return result;
  }
  void drop() {
    for (Line& line : lines_) line.is_valid = line.is_second_newer = false;
  }

 private:
  struct Line {
    bool is_valid = false;
    bool is_second_newer = false;  ///< in a first way: the second way was looked up later
    std::uint32_t address = 0;
  };
  [[nodiscard]] bool is_at(std::uint32_t address, std::uint32_t line) const {
    return lines_[line].is_valid && lines_[line].address == address;
  }

  std::vector<Line> lines_;
  int x_bits_ = 0, y_bits_ = 0;
  std::uint32_t second_ = 0;  ///< the bit of a place that selects the way; 0 with one way
};

/// Texture constants of a triangle, u and v; and the format of its colours if they lie over w too.
struct TextureFrame {
  std::array<OverWScale, 2> scale{};
  std::array<std::int32_t, 2> reference{};  ///< wrapped_reference()
  bool divides_colors = false;
  std::array<OverWScale, 4> color_scale{};
  Texel least{}, greatest{};  ///< of the vertices' colours
};

/// A sample's place, local to its tile (q_at, p_at), and its pixel, of which levels take the 12 lowest bits.
struct TextureSample {
  std::uint64_t q = 1;
  std::array<std::int64_t, 2> p{};
  int x = 0, y = 0;
  std::array<std::int64_t, 4> color_p{};  ///< of a triangle whose colours lie over w
  std::array<std::int64_t, 3> normal{};   ///< of a lit sample: P of its normal
};

class TextureUnit {
 public:
  TextureUnit(const TextureSettings& settings, const PerspectiveFormat& format)
      : settings_(settings),
        format_(format),
        lines_(settings.line_bits),
        cache_(settings.lines, settings.ways),
        data_(static_cast<std::size_t>(settings.lines)) {}

  [[nodiscard]] const TextureState& state() const { return state_; }
  void set_constant(const TextureConstant& constant) { constant_ = constant.color; }
  /// For later stamps.
  void set_border(const TextureBorder& border) { border_ = border.color; }
  void set(const TextureState& state) {
    state_ = state;
    sampler_.mag = state.is_linear ? TextureMag::linear : TextureMag::nearest;
    if (state.invalidates) cache_.drop();
  }
  void set_levels(const TextureLevels& levels) {
    levels_ = levels;
    sampler_.min = levels.min;
    sampler_.least = levels.least;
    sampler_.largest = levels.largest;
    sampler_.last_level = levels.last;
  }
  /// A part of the next triangle's lines.
  void move_in(uint128 line_part) {
    lines_.move_in(line_part);
    lod_ = lines_.lines().unpack();
  }
  [[nodiscard]] bool is_textured(bool is_triangle, SampleMask live) const {
    return state_.enable && is_triangle && live.any();
  }

  /// If the frame divides_colors: P over Q, the sample's own colour; with three channels alpha stays.
  void divide_colors(const TextureSample& sample, const TextureFrame& frame, int channels, Texel& color) const {
    const PixelReciprocal q = divide_by_q(sample.q, format_);
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
      color[c] = static_cast<std::uint8_t>(
          color_over_q(over_q(sample.color_p[c], q, frame.color_scale[c], format_.color, format_), frame.least[c],
                       frame.greatest[c]));
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

  /// The filter of a sample.
  [[nodiscard]] SampleFilter filter_at(const TextureSample& sample) const {
    if (!settings_.has_levels) return {state_.is_linear, false, {}};
    return filter_of(sampler_, level_of_detail(lod_, sample.q, sample.x, sample.y));
  }

  /// The columns and rows of texels that it reads on a level: for a nearest filter one of each, twice.
  [[nodiscard]] std::array<TexelPair, 2> texels_of(const TexturePlace& place, bool is_linear, int level) const {
    const TextureAxes axes = state_.axes();
    std::array<TexelPair, 2> texels{};
    for (const std::size_t i : {0U, 1U})
      texels[i] = is_linear ? texels_around(place, axes, i, level) : nearest_texel(place, axes, i, level);
    return texels;
  }

  /// Calls visit(samples) for the `live` samples that go together, in order: each alone with one lane, a square with
  /// four.
  template <class Visit>
  void for_each_group(SampleMask live, Visit&& visit) const {
    if (settings_.lanes == 1)
      return live.for_each([&](std::size_t s) { visit(SampleMask::only(static_cast<int>(s))); });
    const int side = settings_.stamp_size;
    for (int y = 0; y < side; y += 2)
      for (int x = 0; x < side; x += 2) {
        const SampleMask square = live & SampleMask((std::uint64_t{3} | std::uint64_t{3} << side) << (y * side + x));
        if (square.any()) visit(square);
      }
  }
  /// Room for the samples of the current stamp.
  [[nodiscard]] std::span<TextureSample> samples() { return samples_; }

  [[nodiscard]] int groups(SampleMask live) const {
    int n = 0;
    for_each_group(live, [&n](SampleMask) { ++n; });
    return n;
  }

  /// A stamp whose samples `live` are textured: replaces their colours by the results. read(address, beats): the bytes
  /// of a line, requested in order. Returns the samples' lookups, in their order; valid until the next stamp.
  template <class Read>
  std::span<const TextureLookup> take(SampleMask live, std::span<const TextureSample> samples,
                                      const TextureFrame& frame, std::span<Texel> colors, Read&& read) {
    lookups_.clear();
    for_each_group(live, [&](SampleMask group) {
      if (settings_.lanes == 1)
        take_sample(static_cast<std::size_t>(group.first()), samples, frame, colors, read);
      else
        take_group(group, samples, frame, colors, read);
    });
    return lookups_;
  }

 private:
  using Sums = std::array<std::uint32_t, 4>;
  using Texels = std::array<TexelPair, 2>;

  template <class Read>
  void take_sample(std::size_t s, std::span<const TextureSample> samples, const TextureFrame& frame,
                   std::span<Texel> colors, Read&& read) {
    const TexturePlace place = place_of(samples[s], frame);
    const SampleFilter filter = filter_at(samples[s]);
    const LevelPair& levels = filter.levels;
    const std::size_t first = lookups_.size();
    const auto look_up_on = [&](int level) {
      look_up(
          level, SampleMask::only(static_cast<int>(s)),
          [&](std::size_t) { return texels_of(place, filter.is_linear, level); }, read);
      return sums(place, filter.is_linear, level);
    };
    const Sums lower = look_up_on(levels.lower);
    Sums upper = lower;
    if (has_two(filter)) {
      lookups_.back().continues = true;
      upper = look_up_on(levels.upper);
    }
    TextureLookup& last = lookups_.back();
    last.samples = last.hits = 1;
    for (std::size_t n = first; n < lookups_.size(); ++n)
      if (lookups_[n].is_miss) last.hits = 0;
    colors[s] =
        combined(colors[s], texel_of(filter, lower, upper), state_.combine, has_alpha(state_.format), constant_);
  }

  /// Samples of a square, agreeing ones together: all on their only or lower level, then samples between two levels on
  /// the upper one.
  template <class Read>
  void take_group(SampleMask group, std::span<const TextureSample> samples, const TextureFrame& frame,
                  std::span<Texel> colors, Read&& read) {
    GroupPlaces at;
    SampleMask between;
    group.for_each([&](std::size_t s) {
      at.place[s] = place_of(samples[s], frame);
      at.filter[s] = filter_at(samples[s]);
      if (has_two(at.filter[s])) between.set(static_cast<int>(s));
    });
    for (const bool is_upper : {false, true}) {
      SampleMask left = is_upper ? between : group;
      left.for_each([&](std::size_t s) {
        const LevelPair& levels = at.filter[s].levels;
        at.level[s] = is_upper ? levels.upper : levels.lower;
        at.texels[s] = texels_of(at.place[s], at.filter[s].is_linear, at.level[s]);
      });
      while (left.any()) {
        const SampleMask pass = at.agreeing(left);
        left = SampleMask(left.bits() & ~pass.bits());
        take_pass(at, pass, is_upper ? SampleMask{} : SampleMask(pass.bits() & between.bits()), colors, read);
        lookups_.back().turns = !is_upper && between.any() && !left.any();
        lookups_.back().continues = left.any() || lookups_.back().turns;
      }
    }
  }

  /// Texels that the samples of a square need, indexed by sample number in the stamp (at most 4x4).
  struct GroupPlaces {
    std::array<TexturePlace, 16> place;
    std::array<SampleFilter, 16> filter;
    std::array<int, 16> level{};  ///< the current one of the two
    std::array<Texels, 16> texels;
    std::array<Sums, 16> lower{};
    SampleMask lacked;  ///< samples between two levels whose lower level missed

    /// The first of `left`, and each sample that agrees with all before.
    [[nodiscard]] SampleMask agreeing(SampleMask left) const {
      SampleMask pass;
      left.for_each([&](std::size_t s) {
        bool joins = true;
        pass.for_each([&](std::size_t other) {
          joins = joins && level[s] == level[other] && agree(texels[s][0], texels[other][0]) &&
                  agree(texels[s][1], texels[other][1]);
        });
        if (joins) pass.set(static_cast<int>(s));
      });
      return pass;
    }
  };

  /// Samples that agree; `waiting` ones read another level later.
  template <class Read>
  void take_pass(GroupPlaces& at, SampleMask pass, SampleMask waiting, std::span<Texel> colors, Read&& read) {
    const std::size_t first = lookups_.size();
    look_up(
        at.level[static_cast<std::size_t>(pass.first())], pass, [&](std::size_t s) { return at.texels[s]; }, read);
    TextureLookup& last = lookups_.back();
    pass.for_each([&](std::size_t s) {
      bool lacks = at.lacked.has(s);
      for (std::size_t n = first; n < lookups_.size(); ++n)
        lacks = lacks || (lookups_[n].is_miss && wants(at.texels[s], lookups_[n].bank));
      const SampleFilter& filter = at.filter[s];
      const Sums sum = sums(at.place[s], filter.is_linear, at.level[s]);
      if (waiting.has(s)) {
        at.lower[s] = sum;
        if (lacks) at.lacked.set(static_cast<int>(s));
        return;
      }
      ++last.samples;
      if (!lacks) ++last.hits;
      colors[s] = combined(colors[s], texel_of(filter, has_two(filter) ? at.lower[s] : sum, sum), state_.combine,
                           has_alpha(state_.format), constant_);
    });
  }

  /// Whether the upper level contributes.
  [[nodiscard]] static bool has_two(const SampleFilter& filter) {
    return filter.is_between && filter.levels.part != 0 && filter.levels.upper != filter.levels.lower;
  }
  /// The result of a filter from its sums.
  [[nodiscard]] static Texel texel_of(const SampleFilter& filter, const Sums& lower, const Sums& upper) {
    Texel texel{};
    for (std::size_t c = 0; c < 4; ++c)
      texel[c] = filter.is_between
                     ? blend_levels(round_shift(lower[c], 8), round_shift(upper[c], 8), filter.levels.part)
                     : static_cast<std::uint8_t>(round_shift(lower[c], 16));
    return texel;
  }

  /// Whether one of these texels lies in a block of that bank.
  [[nodiscard]] static bool wants(const Texels& texels, int bank) {
    return block_in(texels[0], bank & 1) >= 0 && block_in(texels[1], bank >> 1) >= 0;
  }

  /// The lines of samples that agree, bank by bank, by the lowest bits of a block's row and column; without banks the
  /// only block.
  template <class TexelsOf, class Read>
  void look_up(int level, SampleMask pass, TexelsOf&& texels_of_sample, Read&& read) {
    for (const int bank : {0, 1, 2, 3}) {
      bool is_wanted = false;
      pass.for_each([&](std::size_t s) {
        const Texels texels = texels_of_sample(s);
        const bool is_passed_over = is_wanted | !wants(texels, bank);
        if (is_passed_over) return;
        is_wanted = true;
        look_up(level, static_cast<std::uint32_t>(block_in(texels[0], bank & 1)),
                static_cast<std::uint32_t>(block_in(texels[1], bank >> 1)), read);
        lookups_.back().bank = bank;
        lookups_.back().sample = s;
      });
    }
    lookups_.back().ends = true;
  }

  /// The sums of the filter on a level, 16 fraction bits, if its lines are present.
  [[nodiscard]] Sums sums(const TexturePlace& place, bool is_linear, int level) const {
    if (is_linear)
      return linear_sums([this](int l, int u, int v) { return texel(l, u, v); }, state_.axes(), place, level, border_);
    const auto [x, y] = texels_of(place, is_linear, level);
    const Texel nearest = x.is_first_border || y.is_first_border ? border_ : texel(level, x.first, y.first);
    Sums sums{};
    for (std::size_t c = 0; c < 4; ++c) sums[c] = std::uint32_t{nearest[c]} << 16;
    return sums;
  }

  /// The block whose lowest bit is `bit`, of two columns or rows of texels; -1: there is none.
  [[nodiscard]] static int block_in(const TexelPair& pair, int bit) {
    for (const int texel : {pair.first, pair.second})
      if ((texel / kTextureBlock & 1) == bit) return texel / kTextureBlock;
    return -1;
  }
  [[nodiscard]] std::uint32_t address_of(int level, std::uint32_t block_x, std::uint32_t block_y) const {
    const int row = std::max(0, state_.log2_size[0] - 2 - level);
    const std::uint32_t block = level_place(state_.log2_size, level).block + (block_y << row) + block_x;
    return state_.base + (block << (4 + texel_size_log2(state_.format)));
  }
  [[nodiscard]] std::uint32_t line_of(int level, std::uint32_t block_x, std::uint32_t block_y) const {
    return levels_.has_two() ? cache_.line_of(block_x, block_y, level) : cache_.line_of(block_x, block_y);
  }
  template <class Read>
  void look_up(int level, std::uint32_t block_x, std::uint32_t block_y, Read&& read) {
    TextureLookup lookup;
    lookup.address = address_of(level, block_x, block_y);
    const TextureCache::Access access = cache_.access(lookup.address, line_of(level, block_x, block_y));
    lookup.line = access.line;
    lookup.is_miss = !access.is_hit;
    lookup.beats = settings_.beats(state_.format);
    lookup.ends = false;
    if (lookup.is_miss) data_[lookup.line] = read(lookup.address, lookup.beats);
    lookups_.push_back(lookup);
  }
  /// A texel whose line is present.
  [[nodiscard]] Texel texel(int level, int column, int row) const {
    const std::uint32_t corner = level_place(state_.log2_size, level).is_corner ? 2 : 0;
    const auto x = static_cast<std::uint32_t>(column) + corner, y = static_cast<std::uint32_t>(row) + corner;
    const std::uint32_t block_x = x / kTextureBlock, block_y = y / kTextureBlock;
    const TextureLine& line = data_[cache_.find(address_of(level, block_x, block_y), line_of(level, block_x, block_y))];
    const int size = texel_size_log2(state_.format);
    const std::uint32_t at = (y % kTextureBlock * kTextureBlock + x % kTextureBlock) << size;
    std::uint32_t code = 0;
    for (std::uint32_t i = 0; i >> size == 0; ++i) code |= std::uint32_t{line[at + i]} << (8 * i);
    return decode_texel(state_.format, code, {});
  }

  TextureSettings settings_;
  PerspectiveFormat format_;
  TextureState state_;
  std::array<std::uint8_t, 3> constant_{};
  Texel border_{};
  TextureLevels levels_;
  LineRegister lines_;
  LodSetup lod_;     ///< the lines in it
  Sampler sampler_;  ///< state_ and levels_, without the texture
  TextureCache cache_;
  std::vector<TextureLine> data_;
  std::vector<TextureLookup> lookups_;
  std::array<TextureSample, kMaxSamples> samples_{};
};

}  // namespace halfplane
