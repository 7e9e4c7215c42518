#include "light.hpp"

#include <algorithm>
#include <cmath>

#include "fixed.hpp"

namespace halfplane {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << kDirectionBits;
constexpr int kTableBits = 9, kLines = 1 << kTableBits;  // of logarithm and power
constexpr int kLogBits = 40;                             // fraction bits of the entries of both tables
constexpr int kShininessBits = 16;

/// round(v 2^bits), clamped to an unsigned word of 32 or 48 bits.
std::uint64_t to_fixed(double v, int bits, int word) {
  const double scaled = std::ldexp(v, bits);
  const double largest = std::ldexp(1.0, word) - 1;
  return scaled <= 0 ? 0 : static_cast<std::uint64_t>(std::min(std::floor(scaled + 0.5), largest));
}
std::int32_t to_signed(double v, int bits) {
  const double scaled = std::floor(std::ldexp(v, bits) + 0.5);
  return static_cast<std::int32_t>(std::clamp(scaled, -2147483648.0, 2147483647.0));
}

/// Computed with integers only, so that every machine has the same values: 2^(2^-k) by square roots, from them powers
/// and logarithms.
struct Tables {
  std::array<std::uint64_t, kLines + 1> log;    ///< log2(1 + i / kLines), u1.40
  std::array<std::uint64_t, kLines + 1> power;  ///< 2^(-i / kLines), u1.40
  Tables() {
    constexpr int kBits = 62;
    constexpr std::uint64_t one = std::uint64_t{1} << kBits;
    std::array<std::uint64_t, kLogBits + 2> root{};  // roots of 2, u2.62
    root[0] = one << 1;
    for (std::size_t k = 1; k < root.size(); ++k) root[k] = integer_sqrt(uint128{root[k - 1]} << kBits);
    for (int i = 0; i <= kLines; ++i) {
      std::uint64_t p = one;  // 2^(i / kLines)
      for (int k = 0; k <= kTableBits; ++k)
        if ((i >> (kTableBits - k) & 1) != 0)
          p = static_cast<std::uint64_t>(uint128{p} * root[static_cast<std::size_t>(k)] >> kBits);
      power[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(((uint128{1} << (kBits + kLogBits)) + p / 2) / p);
      const std::uint64_t wanted = one + (static_cast<std::uint64_t>(i) << (kBits - kTableBits));
      std::uint64_t reached = one, digits = 0;
      for (int k = 0; k <= kLogBits; ++k) {
        const auto next = static_cast<std::uint64_t>(uint128{reached} * root[static_cast<std::size_t>(k)] >> kBits);
        if (next > wanted) continue;
        reached = next;
        digits |= std::uint64_t{1} << (kLogBits - k);
      }
      log[static_cast<std::size_t>(i)] = digits;
    }
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

/// Interpolates between two entries: `place` is 0...1 in u0.`bits`.
std::uint64_t on_line(const std::array<std::uint64_t, kLines + 1>& entries, std::uint64_t place, int bits) {
  const std::uint64_t line = place >> (bits - kTableBits);
  const std::uint64_t part = place & ((std::uint64_t{1} << (bits - kTableBits)) - 1);
  const auto low = static_cast<std::int64_t>(entries[line]), high = static_cast<std::int64_t>(entries[line + 1]);
  const auto moved = static_cast<int128>(high - low) * static_cast<std::int64_t>(part);
  return static_cast<std::uint64_t>(low + static_cast<std::int64_t>(moved >> (bits - kTableBits)));
}

/// a b 2^-bits, rounded.
std::uint64_t product(std::uint64_t a, std::uint64_t b, int bits) {
  return static_cast<std::uint64_t>((uint128{a} * b + (uint128{1} << (bits - 1))) >> bits);
}

}  // namespace

FixedDirection fixed_direction(const std::array<std::int64_t, 3>& v) {
  std::uint64_t largest = 0;
  for (const std::int64_t c : v) largest |= static_cast<std::uint64_t>(c < 0 ? -c : c);
  if (largest == 0) return {};
  // The largest component to 31 bits: no square has more than 62, no sum of three more than 64.
  const int shift = 30 - floor_log2(largest);
  std::array<std::int64_t, 3> scaled{};
  std::uint64_t square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    scaled[i] = shift >= 0 ? v[i] * (std::int64_t{1} << shift) : v[i] >> -shift;
    square += static_cast<std::uint64_t>(scaled[i] * scaled[i]);
  }
  const auto length = static_cast<std::int64_t>(integer_sqrt(square));
  FixedDirection result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t wide = scaled[i] * kOne;
    result[i] = static_cast<std::int32_t>((wide + (wide < 0 ? -length / 2 : length / 2)) / length);
  }
  return result;
}

FixedDirection fixed_direction(const std::array<double, 3>& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0)) return {};
  std::array<std::int64_t, 3> wide{};
  const int up = 40 - std::ilogb(largest);
  for (std::size_t i = 0; i < 3; ++i) wide[i] = static_cast<std::int64_t>(std::floor(std::ldexp(v[i], up) + 0.5));
  return fixed_direction(wide);
}

std::int32_t fixed_dot(const FixedDirection& a, const FixedDirection& b) {
  std::int64_t sum = kOne / 2;
  for (std::size_t i = 0; i < 3; ++i) sum += std::int64_t{a[i]} * b[i];
  return static_cast<std::int32_t>(sum >> kDirectionBits);
}

std::uint32_t fixed_power(std::uint32_t x, std::uint32_t n) {
  constexpr auto one = static_cast<std::uint32_t>(kOne);
  if (n == 0 || x >= one) return one;
  if (x == 0) return 0;
  // -log2 x = octave - log2 of the mantissa, 1...2.
  const int octave = kDirectionBits - floor_log2(x);
  const std::uint64_t mantissa = (std::uint64_t{x} << octave) - one;  // fraction, u0.30
  const std::uint64_t log =
      (static_cast<std::uint64_t>(octave) << kLogBits) - on_line(tables().log, mantissa, kDirectionBits);
  const uint128 exponent = uint128{log} * n >> kShininessBits;  // u16.40
  const auto whole = static_cast<std::uint64_t>(exponent >> kLogBits);
  if (whole > kDirectionBits) return 0;
  const auto part = static_cast<std::uint64_t>(exponent & ((uint128{1} << kLogBits) - 1));
  const std::uint64_t power = on_line(tables().power, part, kLogBits) >> whole;
  return static_cast<std::uint32_t>((power + (1 << (kLogBits - kDirectionBits - 1))) >> (kLogBits - kDirectionBits));
}

FixedLighting::FixedLighting(const Lighting& lighting, double extent) : has_local_viewer_(lighting.has_local_viewer) {
  for (const Light& light : lighting.lights)
    if (light.position[3] != 0)
      for (std::size_t i = 0; i < 3; ++i) extent = std::max(extent, std::abs(light.position[i]));
  scale_ = extent > 0 ? 13 - std::ilogb(extent) : 0;  // below 2^14: a difference of two still is an s15.16
  const auto color = [](const std::array<double, 3>& c, int bits) {
    FixedColor result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = static_cast<std::uint32_t>(to_fixed(c[i], bits, 32));
    return result;
  };
  ambient_ = color(lighting.ambient, kMaterialBits);
  for (const Light& light : lighting.lights) {
    FixedLight& to = lights_.emplace_back();
    const std::array<double, 3> at{light.position[0], light.position[1], light.position[2]};
    to.is_somewhere = light.position[3] != 0;
    if (to.is_somewhere)
      to.place = place(at);
    else
      to.direction = fixed_direction(at);
    to.is_spot = light.spot_scale != 0;
    to.spot = fixed_direction(light.spot_direction);
    to.spot_scale = static_cast<std::int64_t>(std::ldexp(std::min(light.spot_scale, 1e6), kFallOffBits));
    to.spot_offset = static_cast<std::int64_t>(std::ldexp(std::max(light.spot_offset, -1e6), kFallOffBits));
    double brightest = 0;
    for (const auto* c : {&light.ambient, &light.diffuse, &light.specular})
      brightest = std::max({brightest, (*c)[0], (*c)[1], (*c)[2]});
    to.color_bits = brightest > 0 ? std::min(30 - std::ilogb(brightest), 46) : 0;
    to.ambient = color(light.ambient, to.color_bits);
    to.diffuse = color(light.diffuse, to.color_bits);
    to.specular = color(light.specular, to.color_bits);
    for (int i = 0; i < 3; ++i) {
      const double factor = light.attenuation[static_cast<std::size_t>(i)];
      if (!(factor > 0)) continue;
      const int bits = 31 - std::ilogb(factor);
      // A distance is 2^scale_ times as long in these units.
      to.attenuation[i] = {to_fixed(factor, bits, 33), bits + i * scale_};
    }
    if (light.range > 0) to.inverse_range = to_fixed(1 / light.range, kFallOffBits - scale_, 48);
  }
}

FixedPlace FixedLighting::place(const std::array<double, 3>& eye) const {
  return {to_signed(eye[0], kPlaceBits + scale_), to_signed(eye[1], kPlaceBits + scale_),
          to_signed(eye[2], kPlaceBits + scale_)};
}

/// 1 / (constant + linear d + quadratic d^2), faded and in the cone: u16.32. `distance` in u16.16.
std::uint64_t FixedLighting::fall_off(const FixedLight& light, std::uint64_t distance,
                                      const FixedDirection& to_light) const {
  constexpr int kBits = 48;  // fraction bits of the denominator
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 48) - 1;
  uint128 sum = 0;
  for (int i = 0; i < 3; ++i) {
    uint128 term = light.attenuation[i].mantissa;
    for (int k = 0; k < i; ++k) term *= distance;
    if (term == 0) continue;
    const int right = light.attenuation[i].bits + i * kPlaceBits - kBits;
    if (floor_log2(term) - right > 100) return 0;  // too far away to matter
    sum += right >= 128 ? 0 : right >= 0 ? term >> right : term << -right;
  }
  if (sum == 0) return kLargest;
  const uint128 quotient = ((uint128{1} << (kFallOffBits + kBits)) + sum / 2) / sum;
  std::uint64_t result = quotient > kLargest ? kLargest : static_cast<std::uint64_t>(quotient);
  constexpr std::uint64_t one = std::uint64_t{1} << kFallOffBits;
  if (light.inverse_range != 0) {
    const uint128 part = uint128{light.inverse_range} * distance >> kPlaceBits;  // u.32
    if (part >= one) return 0;
    const auto d = static_cast<std::uint64_t>(part);
    const std::uint64_t square = product(d, d, kFallOffBits);
    result = product(result, one - product(square, square, kFallOffBits), kFallOffBits);
  }
  if (light.is_spot) {
    const std::int64_t cosine = -std::int64_t{fixed_dot(light.spot, to_light)};
    const auto scaled = static_cast<std::int64_t>(static_cast<int128>(cosine) * light.spot_scale >> kDirectionBits);
    const auto cone = static_cast<std::uint64_t>(
        std::clamp<std::int64_t>(scaled + light.spot_offset, 0, static_cast<std::int64_t>(one)));
    result = product(result, product(cone, cone, kFallOffBits), kFallOffBits);
  }
  return result;
}

std::array<std::uint16_t, 3> FixedLighting::color(const FixedPlace& eye, const FixedDirection& normal,
                                                  const Material& material) const {
  constexpr std::uint64_t kFull = std::uint64_t{1} << kMaterialBits;
  const auto part = [](double c) { return to_fixed(c, kMaterialBits, 32); };
  const auto n = static_cast<std::uint32_t>(to_fixed(std::min(material.shininess, kMostShininess), kShininessBits, 32));
  const bool shines = material.specular != std::array<double, 3>{};
  std::array<std::uint64_t, 3> sum{};  // u.24
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] = part(material.emission[c]) + product(ambient_[c], part(material.ambient[c]), kMaterialBits);
  for (const FixedLight& light : lights_) {
    FixedDirection to_light = light.direction;
    std::uint64_t strength = std::uint64_t{1} << kFallOffBits;
    if (light.is_somewhere) {
      std::array<std::int64_t, 3> way{};
      uint128 square = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        way[i] = std::int64_t{light.place[i]} - eye[i];
        square += static_cast<std::uint64_t>(way[i] * way[i]);
      }
      to_light = fixed_direction(way);
      strength = fall_off(light, integer_sqrt(square), to_light);
    }
    const std::int32_t facing = fixed_dot(normal, to_light);
    std::uint64_t diffuse = 0, specular = 0;  // u.32
    if (facing > 0) {
      diffuse = product(strength, static_cast<std::uint64_t>(facing), kDirectionBits);
      if (shines) {
        FixedDirection viewer{0, 0, static_cast<std::int32_t>(kOne)};
        if (has_local_viewer_)
          viewer = fixed_direction(
              std::array<std::int64_t, 3>{-std::int64_t{eye[0]}, -std::int64_t{eye[1]}, -std::int64_t{eye[2]}});
        std::array<std::int64_t, 3> between{};
        for (std::size_t i = 0; i < 3; ++i) between[i] = std::int64_t{to_light[i]} + viewer[i];
        const std::int32_t cosine = fixed_dot(normal, fixed_direction(between));
        const std::uint32_t power = fixed_power(static_cast<std::uint32_t>(std::max(cosine, 0)), n);
        specular = product(strength, power, kDirectionBits);
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const auto add = [&](std::uint64_t of_light, double of_material, std::uint64_t much) {
        sum[c] += product(of_light * part(of_material), much, light.color_bits + kFallOffBits);
      };
      add(light.ambient[c], material.ambient[c], strength);
      add(light.diffuse[c], material.diffuse[c], diffuse);
      if (specular != 0) add(light.specular[c], material.specular[c], specular);
    }
  }
  std::array<std::uint16_t, 3> result{};
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = static_cast<std::uint16_t>((std::min(sum[c], kFull) * 255 + (1 << 15)) >> 16);
  return result;
}

}  // namespace halfplane
