#include "fog.hpp"

#include <algorithm>
#include <cmath>

#include "../fixed.hpp"

namespace halfplane {
namespace {

constexpr double kFirstTrace = 1.0 / 2048;  // of the fog: less is ignored
constexpr double kHair = 1 + 1.0 / 1024;    // a linear fog begins and ends inside its table, not at its ends

/// e^-x, x >= 0, within 2 ulp: 2^-n times the series of the rest, at most ln 2 / 2 in magnitude.
double exp_of_minus(double x) {
  if (!(x < 700)) return 0;
  constexpr double kLog2E = 1.4426950408889634, kUpper = 0x1.62e42fee00000p-1, kLower = 0x1.a39ef35793c76p-33;
  const double n = std::floor(x * kLog2E + 0.5);
  const double rest = (n * kUpper - x) + n * kLower;
  double sum = 1;
  for (int i = 17; i > 0; --i) sum = 1 + sum * rest / i;
  return std::ldexp(sum, -static_cast<int>(n));
}

double start_of(const Fog& fog) { return std::min(fog.start, fog.end * 255 / 256); }

/// Whether f is the same at every distance: a linear fog that ends at the eye, or a fog of density 0.
bool is_constant(const Fog& fog) { return fog.kind == FogKind::linear ? fog.end <= 0 : fog.start <= 0; }

/// The exponent of the largest power of two not above x > 0.
int exponent_of(double x) {
  int exponent = 0;
  (void)std::frexp(x, &exponent);
  return exponent - 1;
}

/// The distance from which on at most 2^-12 of the colour remains.
double farthest(const Fog& fog) {
  constexpr double kLog = 8.317766166719343, kRoot = 2.8840537732018747;  // ln 2^12, and its square root
  const double w =
      fog.kind == FogKind::linear ? fog.end * kHair : (fog.kind == FogKind::exp ? kLog : kRoot) / fog.start;
  return std::clamp(w, 1e-300, 1e300);
}

/// Bounds of f's derivatives by q, times q, q^2 and q^3: how much f changes, and how far it is from a straight line.
struct Bends {
  double first, second, third;
};
Bends bends_of(const Fog& fog, double lines_of_octave) {
  if (fog.kind == FogKind::exp)  // x, x^2 - 2x, x^3 - 6x^2 + 6x, times e^-x; x = start w
    return {0.368, 0.4613, 1.01};
  if (fog.kind == FogKind::exp2)  // 2y, 4y^2 - 6y, 8y^3 - 36y^2 + 24y, times e^-y; y = x^2
    return {0.7358, 1.2131, 4.44};
  const double steepness = fog.end * (1 + 1 / lines_of_octave) / (fog.end - start_of(fog));
  return {steepness, 2 * steepness, 6 * steepness};
}

}  // namespace

double fog_factor(const Fog& fog, double w, bool held) {
  if (is_constant(fog)) return fog.kind == FogKind::linear ? 0 : 1;
  if (fog.kind == FogKind::exp) return exp_of_minus(fog.start * w);
  if (fog.kind == FogKind::exp2) return exp_of_minus(fog.start * w * (fog.start * w));
  const double f = (fog.end - w) / (fog.end - start_of(fog));
  return held ? std::clamp(f, 0.0, 1.0) : f;
}

FogTable::FogTable(const Fog& fog, const std::array<std::uint8_t, 3>& color, int line_bits)
    : fog_(fog), color_(color), line_(std::size_t{1} << line_bits) {
  find_range();
  place_bits_ = kFogPlaceBits + octave_bits_ - line_bits;
  const int in_octave = line_bits - octave_bits_;
  for (std::size_t i = 0; i < line_.size(); ++i) {
    const auto q = [&](std::size_t line) {
      const auto part = static_cast<double>(line & ((std::size_t{1} << in_octave) - 1));
      return std::ldexp(1 + std::ldexp(part, -in_octave), first_ + static_cast<int>(line >> in_octave));
    };
    line_[i] = line_from(q(i), q(i + 1));
  }
}

/// The fewest octaves outside which f is constant in effect.
void FogTable::find_range() {
  if (is_constant(fog_)) return;
  first_ = exponent_of(1 / farthest(fog_));
  const double hair = fog_.kind == FogKind::linear ? kHair : 1;
  while (octave_bits_ < kFogOctaves &&
         fog_factor(fog_, std::ldexp(hair, -first_ - (1 << octave_bits_)), false) < 1 - kFirstTrace)
    ++octave_bits_;
}

FogTable::Line FogTable::line_from(double q, double next) const {
  const auto at = [this](double of) { return fog_factor(fog_, 1 / of, false); };
  const double first = at(q), last = at(next), off = at((q + next) / 2) - (first + last) / 2;
  // A place stands for all q that begin with its bits; their middle is used.
  const double middle = (last - first) * std::ldexp(0.5, -place_bits_);
  const double most = std::ldexp(1.0, kFogStartBits - 1) - 1;
  const auto rounded = [most](double value, double least) {
    return static_cast<std::int32_t>(std::clamp(std::floor(std::ldexp(value, kFogStartFraction) + 0.5), least, most));
  };
  return {rounded(first + off / 2 + middle, -most), rounded(last - first, 0)};
}

std::int32_t fog_position(std::uint64_t code, int octave, int octave_bits) {
  const int e = floor_log2(code);
  const std::uint64_t mantissa = e >= kFogPlaceBits ? code >> (e - kFogPlaceBits) : code << (kFogPlaceBits - e);
  const std::int64_t position = (std::int64_t{e} + octave) * (std::int64_t{1} << kFogPlaceBits) +
                                static_cast<std::int64_t>(mantissa) - (1 << kFogPlaceBits);
  const std::int64_t last = (std::int64_t{1} << (kFogPlaceBits + octave_bits)) - 1;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(position, 0, last));
}

std::uint32_t fog_factor_on(const FogLine& line, std::int32_t place, int place_bits) {
  const int drop = place_bits + kFogStartFraction - kFogFactorBits;
  const std::int32_t sum = line.start * (1 << place_bits) + line.rise * place + (1 << (drop - 1));
  return static_cast<std::uint32_t>(std::clamp(sum >> drop, 0, static_cast<std::int32_t>(kFogClear)));
}

std::int32_t FogTable::position(std::uint64_t code, int scale) const {
  return fog_position(code, -scale - first_, octave_bits_);
}

std::uint32_t FogTable::factor(std::int32_t position) const {
  return fog_factor_on(line_[static_cast<std::size_t>(position >> place_bits_)], position & ((1 << place_bits_) - 1),
                       place_bits_);
}

double FogTable::error_bound() const {
  const double rounding = std::ldexp(1.0, -kFogStartFraction) + std::ldexp(0.5, -kFogFactorBits);
  if (is_constant(fog_)) return rounding;
  const double lines = std::ldexp(static_cast<double>(line_.size()), -octave_bits_);  // lines of an octave
  const Bends bends = bends_of(fog_, lines);
  const double straight = (bends.second + 1.5 * bends.third / lines) / (16 * lines * lines);
  const double far = fog_factor(fog_, std::ldexp(1.0, -first_)),
               near = 1 - fog_factor(fog_, std::ldexp(1.0, -first_ - (1 << octave_bits_)));
  // Beyond an end f is that of the middle of the end's place.
  return straight + rounding + std::max(far, near) + std::ldexp(bends.first, -kFogPlaceBits - 1);
}

std::shared_ptr<const FogTable> fog_table(const State& state) {
  if (!state.fog) return nullptr;
  // Contexts are made repeatedly, for few states.
  constexpr std::size_t kKept = 8;
  static thread_local std::array<std::shared_ptr<const FogTable>, kKept> kept;
  static thread_local std::size_t next = 0;
  for (const auto& table : kept)
    if (table && table->fog() == *state.fog && table->color() == state.fog_color) return table;
  next = (next + 1) % kKept;
  return kept[next] = std::make_shared<const FogTable>(*state.fog, state.fog_color);
}

double fog_error_bound(const FogTable& table, double w, double relative) {
  const double f = fog_factor(table.fog(), w), nearer = fog_factor(table.fog(), w / (1 + relative)),
               farther = relative < 1 ? fog_factor(table.fog(), w / (1 - relative)) : 0;
  return std::min(1.0, table.error_bound() + std::max(nearer - f, f - farther));
}

std::uint32_t fog_factor_of_vertex(const Fog& fog, double w) {
  return static_cast<std::uint32_t>(std::floor(std::ldexp(fog_factor(fog, std::max(w, 0.0)), kFogFactorBits) + 0.5));
}

}  // namespace halfplane
