#include "texture_levels.hpp"

namespace halfplane {
namespace {

/// The `bits` lowest bits.
[[nodiscard]] constexpr uint128 low_bits(uint128 value, int bits) { return value & ((uint128{1} << bits) - 1); }

/// Bits 0 to 127 and 128 to 255 of a value shifted to the left.
void put(TextureLines& lines, uint128 value, int at) {
  if (at < 128) lines.low |= value << at;
  if (at > 0) lines.high |= at < 128 ? value >> (128 - at) : value << (at - 128);
}

}  // namespace

std::uint32_t TextureLevels::pack() const {
  return static_cast<std::uint32_t>(min) | static_cast<std::uint32_t>(last) << 3 |
         static_cast<std::uint32_t>(least) << 7 | static_cast<std::uint32_t>(largest) << 19;
}

TextureLevels TextureLevels::unpack(std::uint32_t word) {
  return {static_cast<TextureMin>(word & 7U), static_cast<int>(word >> 3 & 15U), static_cast<Lod>(word >> 7 & kLargest),
          static_cast<Lod>(word >> 19 & kLargest)};
}

TextureLevels texture_levels(const Texture& texture, const State& state) {
  const Sampler sampler(texture, state);
  const auto held = [](Lod level) { return std::clamp(level, 0, TextureLevels::kLargest); };
  return {sampler.min, sampler.last_level, held(sampler.least), held(sampler.largest)};
}

bool needs_level(const TextureLevels& levels, TextureMag mag) {
  if (levels.least == levels.largest) return false;
  const bool has_levels = levels.min > TextureMin::linear;
  const bool is_linear = (static_cast<unsigned>(levels.min) & 1U) != 0;
  return has_levels || is_linear != (mag == TextureMag::linear);
}

TextureLines TextureLines::pack(const LodSetup& setup, Lod bias) {
  constexpr Lod kLimit = 1 << (kOffsetBits - 1);
  const Lod offset = std::clamp(setup.offset + bias, -kLimit, kLimit - 1);
  TextureLines lines;
  int at = 0;
  const auto add = [&](std::uint32_t value) {
    put(lines, value, at);
    at += 32;
  };
  for (const LodLine& line : setup.along_y) add(line.at_zero);
  for (const LodLine& line : setup.along_x) add(line.at_zero);
  for (const LodLine& line : setup.along_y) add(line.step);  // the steps along x are the same
  put(lines, wrap_unsigned(static_cast<std::uint64_t>(offset), kOffsetBits), at);
  return lines;
}

LodSetup TextureLines::unpack() const {
  LodSetup setup;
  for (const std::size_t c : {0U, 1U}) {
    const int at = 32 * static_cast<int>(c);
    const auto step = static_cast<std::uint32_t>(high >> at);
    setup.along_y[c] = {static_cast<std::uint32_t>(low >> at), step};
    setup.along_x[c] = {static_cast<std::uint32_t>(low >> (64 + at)), step};
  }
  setup.offset = static_cast<Lod>(wrap_signed(static_cast<std::int64_t>(high >> 64), kOffsetBits));
  return setup;
}

uint128 line_part(const TextureLines& lines, int part_bits, int n) {
  const int at = n * part_bits;
  if (at >= 128) return low_bits(lines.high >> (at - 128), part_bits);
  return low_bits(at == 0 ? lines.low : lines.low >> at | lines.high << (128 - at), part_bits);
}

void LineRegister::move_in(uint128 part) {
  const int parts = line_parts(part_bits_);
  for (int n = 0; n + 1 < parts; ++n) part_[static_cast<std::size_t>(n)] = part_[static_cast<std::size_t>(n) + 1];
  part_[static_cast<std::size_t>(parts) - 1] = low_bits(part, part_bits_);
}

TextureLines LineRegister::lines() const {
  TextureLines lines;
  for (int n = 0; n < line_parts(part_bits_); ++n) put(lines, part_[static_cast<std::size_t>(n)], n * part_bits_);
  lines.high = low_bits(lines.high, TextureLines::kBits - 128);
  return lines;
}

}  // namespace halfplane
