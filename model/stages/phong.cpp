#include "phong.hpp"

#include <algorithm>
#include <cmath>

#include "../fixed.hpp"

namespace halfplane {
namespace {

constexpr int kShininessFraction = 16;
constexpr double kTrace = 1.0 / 2048;  // of a highlight: less is ignored

std::uint32_t shininess_code(double shininess) {
  return static_cast<std::uint32_t>(snap(shininess, 1 << kShininessFraction));
}

/// A direction of the state, truncated so that none is longer than 1.
Normal direction_codes(const std::array<double, 3>& direction) {
  const std::array<double, 3> unit = unit_normal(direction);
  constexpr double kLargest = (1 << kNormalFraction) - 1;  // 16 bits, signed
  Normal codes;
  for (std::size_t i = 0; i < 3; ++i) codes[i] = static_cast<std::int32_t>(std::trunc(unit[i] * kLargest));
  return codes;
}

double length_of(const Normal& codes) {
  double square = 0;
  for (const std::int32_t c : codes) square += std::ldexp(static_cast<double>(c) * c, -2 * kNormalFraction);
  return std::sqrt(square);
}

/// The chord of a falling curve, less half of its error in the middle. `ahead`: the fraction of the line that one place
/// covers, where the looked-up value has more bits: a place stands for its middle.
FallingLine chord(double first, double middle, double last, int fraction, double ahead) {
  const double off = middle - (first + last) / 2, fall = first - last;
  const double start = first + off / 2 - ahead * fall / 2;
  const auto code = [fraction](double value) {
    return static_cast<std::int32_t>(snap(value, std::ldexp(1.0, fraction)));
  };
  return {code(start), code(fall)};
}

/// 0...255 as 0...2^12.
std::uint32_t factor_of(std::uint8_t code) { return ((std::uint32_t{code} << kLightFraction) + 127) / 255; }

}  // namespace

std::array<double, 3> unit_normal(const std::array<double, 3>& normal) {
  const double largest = std::max({std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])});
  if (!(largest > 0)) return {};
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  std::array<double, 3> n{};
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    n[i] = std::ldexp(normal[i], -exponent);
    square += n[i] * n[i];
  }
  const double length = std::sqrt(square);
  for (double& c : n) c /= length;
  return n;
}

Normal normal_codes(const std::array<double, 3>& normal) {
  Normal codes;
  for (std::size_t i = 0; i < 3; ++i) codes[i] = static_cast<std::int32_t>(snap(normal[i], 1 << kNormalFraction));
  return codes;
}

OverW quantize_normal(const std::array<std::int32_t, 3>& component, const QCodes& q, const PerspectiveFormat& format) {
  const int drop = kNormalFraction + format.q_bits - normal_format(format).bits;
  OverW result;
  for (std::size_t i = 0; i < 3; ++i) result.p[i] = round_shift(std::int64_t{component[i]} * q[i], drop);
  return result;
}

Normal block_normal(const std::array<std::int64_t, 3>& p) {
  std::uint64_t bits = 0;  // bits of the largest component; the last bit of a negative number may differ
  for (const std::int64_t c : p) bits |= static_cast<std::uint64_t>(c ^ (c >> 63));
  const int drop = (bits == 0 ? 0 : floor_log2(bits)) + 1 - kBlockBits;
  Normal m;
  for (std::size_t i = 0; i < 3; ++i)
    m[i] = static_cast<std::int32_t>(std::min<std::int64_t>(round_shift(p[i], drop), (1 << kBlockBits) - 1));
  return m;
}

const std::array<FallingLine, std::size_t{2} << kRootLines>& root_lines() {
  static const auto made = [] {
    std::array<FallingLine, std::size_t{2} << kRootLines> lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::size_t octave = i >> kRootLines;
      const auto at = [&](double line) {
        return 1 / std::sqrt(std::ldexp(1 + std::ldexp(line, -kRootLines), static_cast<int>(octave)));
      };
      const auto line = static_cast<double>(i & ((std::size_t{1} << kRootLines) - 1));
      lines[i] = chord(at(line), at(line + 0.5), at(line + 1), kRootFraction, std::ldexp(1.0, -kRootPlaceBits));
    }
    return lines;
  }();
  return made;
}

InverseLength inverse_length(const Normal& m) {
  std::uint32_t square = 0;  // 2^28 to 3 2^30
  for (const std::int32_t c : m) square += static_cast<std::uint32_t>(c * c);
  const int e = floor_log2(square);
  const std::uint32_t behind = square << (31 - e) << 1;  // the leading one
  const std::uint32_t line = static_cast<std::uint32_t>(e & 1) << kRootLines | behind >> (32 - kRootLines);
  const auto place = static_cast<std::int32_t>(behind << kRootLines >> (32 - kRootPlaceBits));
  const FallingLine& on = root_lines()[line];
  const std::int32_t root = on.start - round_shift(on.fall * place, kRootPlaceBits);
  return {e >> 1, static_cast<std::uint32_t>(root)};
}

std::uint32_t cosine(const Normal& m, const InverseLength& length, const Normal& direction) {
  std::int64_t dot = 0;  // 32 bits, signed
  for (std::size_t i = 0; i < 3; ++i) dot += std::int64_t{m[i]} * direction[i];
  if (dot <= 0) return 0;
  // 17 bits, plus a half for the dropped bits.
  const auto part = static_cast<std::uint64_t>(dot >> (length.exponent - 1)) << 1 | 1;
  return static_cast<std::uint32_t>(round_shift(part * length.root, kRootFraction));
}

PhongLight::Given PhongLight::given_by(const State& state) {
  return {state.light_direction, state.light_half,     state.light_ambient,
          state.light_diffuse,   state.light_specular, state.light_shininess};
}

PhongLight::PhongLight(const Given& given) : given_(given) {
  registers_.direction = direction_codes(given.direction);
  registers_.half = direction_codes(given.half);
  half_length_ = length_of(registers_.half);
  for (std::size_t c = 0; c < 3; ++c) {
    registers_.ambient[c] = factor_of(given.ambient[c]);
    registers_.diffuse[c] = factor_of(given.diffuse[c]);
  }
  registers_.specular = given.specular;
  make_power();
}

/// Power of a cosine() result for N.H, corrected for the slightly short half vector. Not clamped to 1, which would be a
/// bend in the first line.
double PhongLight::real_power(double x) const {
  return half_length_ > 0 ? power_of(x / half_length_, shininess_code(given_.shininess)) : 0;
}

/// The table is as narrow as the power allows: the rest of the range shows no trace.
void PhongLight::make_power() {
  const std::uint32_t n = shininess_code(given_.shininess);
  int& narrow = registers_.narrow;
  while (power_of(1 - std::ldexp(0.5, -narrow), n) < kTrace) ++narrow;
  for (std::size_t i = 0; i < registers_.line.size(); ++i) {
    const auto at = [&](double line) { return real_power(1 - std::ldexp(line, -kPowerLines - narrow)); };
    const auto line = static_cast<double>(i);
    registers_.line[i] = chord(at(line), at(line + 0.5), at(line + 1), kPowerStartFraction, 0);
  }
}

std::uint32_t LightRegisters::power(std::uint32_t cosine) const {
  const auto away = std::max(0, (1 << kCosineFraction) - static_cast<std::int32_t>(cosine));
  const auto at = static_cast<std::size_t>(away >> place_bits());
  if (at >= line.size()) return 0;
  const std::int32_t place = away & ((1 << place_bits()) - 1);
  const int drop = place_bits() + kPowerStartFraction - kLightFraction;
  const std::int32_t sum = line[at].start * (1 << place_bits()) - line[at].fall * place;
  return static_cast<std::uint32_t>(std::clamp(round_shift(sum, drop), 0, 1 << kLightFraction));
}

LightFactors LightRegisters::factors(const Normal& m) const {
  if (m == Normal{}) return {};
  const InverseLength length = inverse_length(m);
  const std::uint32_t facing = cosine(m, length, direction);
  if (facing == 0) return {};
  return {round_shift(facing, kCosineFraction - kLightFraction), power(cosine(m, length, half))};
}

std::uint32_t LightRegisters::lit(std::size_t channel, std::uint32_t color, const LightFactors& factors) const {
  const std::uint32_t much = ambient[channel] + round_shift(diffuse[channel] * factors.diffuse, kLightFraction);
  const std::uint32_t sum = color * much + specular[channel] * factors.specular;
  return std::min(round_shift(sum, kLightFraction), 255U);
}

PhongLight::Bounds PhongLight::error_bounds(double cosine_of_light, double cosine_of_half, double turn) const {
  const double rounded_direction = std::sqrt(3.0) * std::ldexp(1.0, 1 - kNormalFraction);  // truncated, and 2^-15 short
  turn += std::sqrt(3.0) * std::ldexp(0.5, 1 - kBlockBits);                                // m
  const double chord_of_root = 0.75 / 16 * std::ldexp(1.0, -2 * kRootLines);
  const double root =
      chord_of_root + std::ldexp(1.0, -kRootFraction) + std::ldexp(0.5, -kRootLines - kRootPlaceBits - 1);
  const double cosine_rounded = root + std::ldexp(1.5, -kCosineFraction);
  Bounds bounds;
  const double off = turn + rounded_direction + cosine_rounded;
  bounds.diffuse = off + std::ldexp(0.5, -kLightFraction);
  if (cosine_of_light < -off) {
    bounds.diffuse = 0;
    return bounds;
  }
  // The length of H is corrected in N.H, and a turn counts as its sine.
  const double turned = turn + rounded_direction, x = std::max(cosine_of_half, 0.0);
  const double sine = std::sqrt(std::max(0.0, 1 - x * x));
  const double moved = turned * sine + turned * turned / 2 + cosine_rounded;
  const double n = given_.shininess, real = std::pow(std::min(x, 1.0), n);
  const double higher = std::pow(std::min(x + moved, 1.0), n), lower = std::pow(std::max(x - moved, 0.0), n);
  const double width = std::ldexp(1.0, -kPowerLines - narrow());
  const double bend = n * std::max(n - 1, 0.0) * width * width;  // bound of a line's second derivative
  const double table = bend / 16 * (1 + n * width) + std::ldexp(1.5, -kPowerStartFraction) +
                       std::ldexp(0.5, -kLightFraction) + power_of(1 - std::ldexp(1.0, -narrow()), shininess_code(n));
  bounds.specular = std::max(higher - real, real - lower) + table;
  // At the edge of the light either side of N.L = 0 is possible.
  if (std::abs(cosine_of_light) <= off) bounds.specular = std::max(bounds.specular, higher + table);
  return bounds;
}

double PhongLight::error_bound(std::size_t channel, std::uint32_t color, const Bounds& bounds) const {
  const double ambient = std::ldexp(0.5, -kLightFraction), product = std::ldexp(1.0, -kLightFraction);
  const double diffuse = given_.diffuse[channel] / 255.0 * bounds.diffuse;
  return color * (diffuse + ambient + product) + given_.specular[channel] * bounds.specular + 0.5;
}

std::shared_ptr<const PhongLight> phong_light(const State& state) {
  if (state.shade != Shade::phong) return nullptr;
  // Contexts are made repeatedly, for few states.
  constexpr std::size_t kKept = 8;
  static thread_local std::array<std::shared_ptr<const PhongLight>, kKept> kept;
  static thread_local std::size_t next = 0;
  const PhongLight::Given given = PhongLight::given_by(state);
  for (const auto& light : kept)
    if (light && light->given() == given) return light;
  next = (next + 1) % kKept;
  return kept[next] = std::make_shared<const PhongLight>(given);
}

double power_of(double x, std::uint32_t n) {
  double result = 1, square = x, root = x;
  for (std::uint32_t whole = n >> kShininessFraction; whole != 0; whole >>= 1) {
    if ((whole & 1) != 0) result *= square;
    square *= square;
  }
  for (int bit = kShininessFraction - 1; bit >= 0; --bit) {
    root = std::sqrt(root);
    if ((n >> bit & 1) != 0) result *= root;
  }
  return result;
}

}  // namespace halfplane
