// Expected behaviour of the texture unit for a random program, cycle by cycle: the specification gives the colours and
// requests, the timing model the cycle of each transfer. A run ends by itself, or by a reset.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

#include "model/engines/cycle/texture_timing.hpp"
#include "model/packets/packets.hpp"
#include "model/stages/texture_unit.hpp"

namespace halfplane::texture_test {

/// Format of the verilated unit.
struct UnitFormat {
  int samples, channels;
  TextureSettings settings;
  PerspectiveFormat perspective;
  bool divides_colors = false;  ///< OVER_W
  bool has_constant = false;    ///< CONSTANT
  bool has_border = false;      ///< BORDER
};

struct PlannedStamp {
  std::optional<StateRegister> sets;  ///< a token, and its value
  uint128 word = 0;
  bool is_triangle = true;
  std::uint32_t payload = 0;
  int x = 0, y = 0;  ///< its first pixel
  SampleMask mask;
  std::array<Texel, 16> color{}, combined{};
  std::array<TextureSample, 16> sample{};
  TextureFrame frame;
  Cycle enters = 0, offered = 0, left = 0;
};

[[nodiscard]] inline bool sets(const PlannedStamp& stamp, LevelsWord which) {
  return stamp.sets == StateRegister::texture_levels && levels_word(static_cast<std::uint64_t>(stamp.word)) == which;
}

struct PlannedRequest {
  std::uint32_t address = 0;
  int beats = 0;
  TextureLine line{};
  Cycle offered = 0, asked = 0;
  std::vector<Cycle> answered;
};

/// The world around the unit: when it stalls, how late memory is.
struct World {
  std::array<Stalls, 4> stalls{};  ///< of stamps in, stamps out, requests, answers
  int latency = 1;
  [[nodiscard]] bool is_stalled(int stream, Cycle cycle) const {
    const Stalls& s = stalls[static_cast<std::size_t>(stream)];
    return halfplane::is_stalled(s.seed, stream, cycle, s.threshold);
  }
  [[nodiscard]] Cycle next_free(int stream, Cycle cycle) const {
    return stalls[static_cast<std::size_t>(stream)].next_free(1U << stream, cycle);
  }
};

struct Plan {
  std::vector<PlannedStamp> stamps;
  std::vector<PlannedRequest> requests;
  Cycle last = 0;  ///< something crosses in it
  TextureUse use;
};

using Random = std::mt19937_64;
inline int pick(Random& random, int low, int high) { return std::uniform_int_distribution(low, high)(random); }

inline World random_world(Random& random) {
  World world;
  for (Stalls& stalls : world.stalls) {
    stalls.seed = random();
    const int kind = pick(random, 0, 3);
    stalls.threshold = kind < 2 ? 0 : stall_threshold(kind == 2 ? 0.3 : 0.8);
  }
  world.latency = pick(random, 1, 60);
  return world;
}

/// Draws random programs: states, stamps with and without texture, coordinates and levels that wander over the texture or jump.
class Program {
 public:
  Program(Random& random, const UnitFormat& format) : random_(random), format_(format) { new_triangle(); }

  [[nodiscard]] PlannedStamp next() {
    PlannedStamp stamp;
    if (tokens_.empty() && left_-- <= 0) {
      left_ = pick(random_, 0, 3) == 0 ? pick(random_, 0, 6) : pick(random_, 20, 150);
      const TextureState state = new_state();
      token(StateRegister::texture, state.pack());
      if (format_.settings.has_levels) token(StateRegister::texture_levels, new_levels(state).pack());
      if (format_.has_constant && (!has_constant_ || pick(random_, 0, 1) == 0)) {
        token(StateRegister::texture_levels, new_constant().pack());
        has_constant_ = true;
      }
      if (format_.has_border && (!has_border_ || pick(random_, 0, 1) == 0)) {
        TextureBorder border;
        for (std::uint8_t& channel : border.color) channel = static_cast<std::uint8_t>(random_());
        token(StateRegister::texture_levels, border.pack());
        has_border_ = true;
      }
    }
    if (tokens_.empty() && pick(random_, 0, 9) == 0) new_triangle();
    if (!tokens_.empty()) {
      stamp = tokens_.front();
      tokens_.pop_front();
      stamp.payload = static_cast<std::uint32_t>(random_());
      return stamp;
    }
    stamp.payload = static_cast<std::uint32_t>(random_());
    const int side = format_.samples == 1 ? 1 : format_.samples == 4 ? 2 : 4;
    stamp.x = (x_ + pick(random_, 0, 15)) / side * side;
    stamp.y = (y_ + pick(random_, 0, 15)) / side * side;
    stamp.is_triangle = pick(random_, 0, 15) != 0;
    const std::uint64_t all = SampleMask::all(format_.samples).bits();
    stamp.mask = SampleMask(pick(random_, 0, 2) != 0 ? all : random_() & all);
    if (pick(random_, 0, 15) == 0) stamp.mask = SampleMask::only(pick(random_, 0, format_.samples - 1));
    if (pick(random_, 0, 15) == 0) stamp.mask = {};
    stamp.frame = frame_;
    for (std::size_t s = 0; s < static_cast<std::size_t>(format_.samples); ++s) {
      for (std::size_t c = 0; c < 4; ++c)
        stamp.color[s][c] = static_cast<std::uint8_t>(pick(random_, 0, 3) == 0 ? 255U * (random_() & 1) : random_());
      if (format_.channels == 3) stamp.color[s][3] = 255;
      stamp.sample[s] = new_sample();
      stamp.sample[s].x = stamp.x + static_cast<int>(s) % side;
      stamp.sample[s].y = stamp.y + static_cast<int>(s) / side;
    }
    return stamp;
  }

 private:
  void token(StateRegister sets, uint128 word) {
    PlannedStamp stamp;
    stamp.sets = sets;
    stamp.word = word;
    tokens_.push_back(stamp);
  }

  TextureConstant new_constant() {
    TextureConstant constant;
    for (std::uint8_t& channel : constant.color) channel = static_cast<std::uint8_t>(random_());
    return constant;
  }

  TextureLevels new_levels(const TextureState& state) {
    TextureLevels levels;
    levels.min = static_cast<TextureMin>(pick(random_, 0, 5));
    levels.last = pick(random_, 0, 9) == 0 ? 0 : std::max(state.log2_size[0], state.log2_size[1]);
    levels.least = pick(random_, 0, 2) == 0 ? pick(random_, 0, 12 * 256) : 0;
    levels.largest = pick(random_, 0, 2) == 0 ? pick(random_, 0, TextureLevels::kLargest) : 12 * 256;
    levels.largest = std::max(levels.least, levels.largest);
    return levels;
  }

  /// Lines whose level, about the pixels of the triangle, is one of a texture, or a little less.
  TextureLines new_lines() {
    LodSetup lod;
    const auto number = [this] { return static_cast<std::uint32_t>(random_() >> pick(random_, 32, 63)); };
    for (const std::size_t c : {0U, 1U}) {
      const std::uint32_t step = number() * (pick(random_, 0, 1) != 0 ? 1U : ~0U);
      lod.along_y[c] = {number() - static_cast<std::uint32_t>(y_) * step, step};
      lod.along_x[c] = {number() - static_cast<std::uint32_t>(x_) * step, step};
      if (pick(random_, 0, 3) == 0) lod.along_y[c].at_zero = number();
    }
    const Lod wanted = pick(random_, -2 * 256, 12 * 256) >> (pick(random_, 0, 2) == 0 ? 3 : 0);
    const Lod there = level_of_detail(lod, std::uint64_t{1} << (q_bits_ - 1), x_, y_);
    return TextureLines::pack(lod, pick(random_, 0, 30) == 0 ? pick(random_, -60, 60) * 1000 : wanted - there);
  }

  TextureState new_state() {
    TextureState state;
    state.enable = pick(random_, 0, 5) != 0;
    state.invalidates = texture_[0].base == 0 || pick(random_, 0, 5) == 0;
    if (state.invalidates)  // other textures, and other contents
      for (std::uint32_t n = 0; n < 4; ++n) {
        const int most = pick(random_, 0, 2) == 0 ? 12 : 6;
        texture_[n].format = static_cast<TextureFormat>(pick(random_, 0, 5));
        texture_[n].log2_size = {pick(random_, 0, most), pick(random_, 0, most)};
        texture_[n].base = n << 28 | static_cast<std::uint32_t>(pick(random_, 1, 4095)) << 6;
      }
    const int n = pick(random_, 0, 3);
    const TextureState& t = texture_[static_cast<std::size_t>(n)];
    state.format = t.format;
    state.log2_size = t.log2_size;
    state.base = t.base;
    state.combine = static_cast<TextureCombine>(pick(random_, 0, format_.has_constant ? 4 : 3));
    for (TextureWrap& wrap : state.wrap) wrap = static_cast<TextureWrap>(pick(random_, 0, format_.has_border ? 4 : 2));
    state.is_linear = format_.settings.has_linear && pick(random_, 0, 3) != 0;
    return state;
  }

  void new_triangle() {
    const int q_bits = format_.perspective.q_bits, narrow = format_.perspective.coordinate.narrow_bits;
    is_wild_ = pick(random_, 0, 7) == 0;
    step_ = std::ldexp(1.0, pick(random_, -3, is_wild_ ? 8 : 1));
    for (std::size_t i = 0; i < 2; ++i) {
      const int reach = pick(random_, 0, 3) == 0 ? pick(random_, 0, kMaxReach) : pick(random_, 4, 10);
      exponent_[i] = reach - pick(random_, 0, pick(random_, 0, 2) == 0 ? q_bits + 1 : 3);
      frame_.scale[i] = {1 + reach - exponent_[i] - narrow, reach};
      frame_.reference[i] = pick(random_, -300, 300) << (pick(random_, 0, 9) == 0 ? 13 : 0);
      at_[i] = pick(random_, -100, 400);
    }
    q_bits_ = pick(random_, 1, q_bits + 1 + format_.perspective.guard_bits);
    if (format_.divides_colors) new_colors();
    if (!format_.settings.has_levels) return;
    x_ = pick(random_, 0, pick(random_, 0, 1) != 0 ? 4079 : 31);
    y_ = pick(random_, 0, pick(random_, 0, 1) != 0 ? 4079 : 31);
    const int bits = format_.settings.line_bits;
    const TextureLines lines = new_lines();
    for (int n = 0; n < line_parts(bits); ++n) token(StateRegister::texture_lines, line_part(lines, bits, n));
  }

  /// Whether colours lie over w, and how P is to be read; sometimes in combinations that no host sends.
  void new_colors() {
    const OverWFormat& attribute = format_.perspective.color;
    frame_.divides_colors = pick(random_, 0, 2) != 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const int reach = pick(random_, 0, 3) == 0 ? pick(random_, 0, 8) : 8;
      const int least = attribute.bits - format_.perspective.q_bits, most = attribute.bits + 1;  // of x - sp
      const int above =
          pick(random_, 0, 1) != 0 ? std::min(most, least + pick(random_, 0, 4)) : pick(random_, least, most);
      frame_.color_scale[c] = {1 + above - attribute.narrow_bits, reach};
      color_exponent_[c] = reach - above;
      frame_.least[c] = static_cast<std::uint8_t>(pick(random_, 0, 1) != 0 ? 0 : pick(random_, 0, 255));
      frame_.greatest[c] =
          static_cast<std::uint8_t>(pick(random_, 0, 1) != 0 ? 255 : pick(random_, frame_.least[c], 255));
    }
  }

  /// P of a value between the vertices' or a little beyond.
  void set_colors(TextureSample& sample) {
    const int p_bits = p_local_bits(format_.perspective.color, format_.perspective);
    const double limit = std::ldexp(1.0, p_bits - 1);
    for (std::size_t c = 0; c < 4; ++c) {
      const double value = std::uniform_real_distribution(-2.0, std::ldexp(1.0, frame_.color_scale[c].reach))(random_);
      const double p = std::floor(value * static_cast<double>(sample.q) * std::ldexp(1.0, -color_exponent_[c]));
      sample.color_p[c] = static_cast<std::int64_t>(std::clamp(p, -limit, limit - 1));
      if (pick(random_, 0, 30) == 0)
        sample.color_p[c] = wrap_signed(static_cast<std::int64_t>(random_()), p_bits) >> pick(random_, 0, p_bits - 1);
    }
  }

  TextureSample new_sample() {
    TextureSample sample;
    sample.q = (std::uint64_t{1} << (q_bits_ - 1)) | (random_() & ((std::uint64_t{1} << (q_bits_ - 1)) - 1));
    const int p_bits = p_local_bits(format_.perspective.coordinate, format_.perspective);
    for (std::size_t i = 0; i < 2; ++i) {
      at_[i] += step_ * std::uniform_real_distribution(-0.4, 1.0)(random_);
      const double p = (at_[i] - frame_.reference[i]) * static_cast<double>(sample.q) * std::ldexp(1.0, -exponent_[i]);
      const double limit = std::ldexp(1.0, p_bits - 1);
      sample.p[i] = static_cast<std::int64_t>(std::clamp(std::floor(p), -limit, limit - 1));
      if (is_wild_ && pick(random_, 0, 3) == 0)
        sample.p[i] = wrap_signed(static_cast<std::int64_t>(random_()), p_bits) >> pick(random_, 0, p_bits - 1);
    }
    if (frame_.divides_colors) set_colors(sample);
    return sample;
  }

  Random& random_;
  const UnitFormat& format_;
  int left_ = 0;
  std::deque<PlannedStamp> tokens_;  ///< in front of the next stamp
  bool has_constant_ = false;        ///< one has been sent; before that it is undefined
  bool has_border_ = false;          ///< likewise
  int x_ = 0, y_ = 0;                ///< about where the triangle is
  std::array<TextureState, 4> texture_{};
  TextureFrame frame_;
  std::array<int, 2> exponent_{};
  std::array<int, 4> color_exponent_{};
  std::array<double, 2> at_{};
  double step_ = 1;
  bool is_wild_ = false;
  int q_bits_ = 8;
};

/// A program of `stamps` stamps, begun with the unit's rst_ni high from `start` on.
inline Plan make_plan(const UnitFormat& format, const World& world, Random& random, int stamps, Cycle start,
                      Cycle recovered, Cycle answered) {
  Plan plan;
  TextureUnit unit(format.settings, format.perspective);
  TextureTiming timing(format.settings, start, recovered);
  Program program(random, format);
  std::uint64_t contents = random();  // of memory
  const auto read = [&](std::uint32_t address, int beats) {
    PlannedRequest request{address, beats, {}, 0, 0, {}};
    for (int i = 0; i < beats * format.settings.port_bits / 8; ++i) {
      std::uint64_t z = contents + (address + static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15ULL;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
      request.line[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(z >> 40);
    }
    plan.requests.push_back(request);
    return request.line;
  };
  std::size_t asked = 0;
  const auto memory = make_memory({MemoryKind::fixed, world.latency, 50}, Config{});
  Stream request_stream(world.stalls[2], 1U << 2), answer_stream(world.stalls[3], 1U << 3);
  TexturePort port(*memory, request_stream, answer_stream);
  port.answers_until(answered);
  const auto ask = [&](Cycle cycle, std::uint32_t address, int beats) {
    PlannedRequest& request = plan.requests[asked++];
    const LineTimes times = port.ask(cycle, address, beats, [&](int, Cycle came) { request.answered.push_back(came); });
    request.offered = cycle;
    request.asked = times.asked;
    plan.last = std::max(plan.last, times.answered);
    return times;
  };
  Cycle x = start;
  for (int n = 0; n < stamps; ++n) {
    PlannedStamp stamp = program.next();
    x = world.next_free(0, std::max(x + 1, timing.room()));
    stamp.enters = x + 1;
    stamp.combined = stamp.color;
    const bool divides = stamp.frame.divides_colors && !stamp.sets && stamp.is_triangle && stamp.mask.any();
    if (divides)
      stamp.mask.for_each(
          [&](std::size_t s) { unit.divide_colors(stamp.sample[s], stamp.frame, format.channels, stamp.combined[s]); });
    if (stamp.sets == StateRegister::texture) {
      const auto state = TextureState::unpack(static_cast<std::uint64_t>(stamp.word));
      if (state.invalidates) contents = random();
      unit.set(state);
      stamp.offered = timing.set(x, state.invalidates);
    } else if (sets(stamp, LevelsWord::border)) {
      unit.set_border(TextureBorder::unpack(static_cast<std::uint64_t>(stamp.word)));
      stamp.offered = timing.set_border(x);
    } else if (sets(stamp, LevelsWord::constant)) {
      unit.set_constant(TextureConstant::unpack(static_cast<std::uint64_t>(stamp.word)));
      stamp.offered = timing.pass(x);
    } else if (stamp.sets == StateRegister::texture_levels) {
      unit.set_levels(TextureLevels::unpack(static_cast<std::uint32_t>(stamp.word)));
      stamp.offered = timing.set(x, false);
    } else if (stamp.sets == StateRegister::texture_lines) {
      unit.move_in(stamp.word);
      stamp.offered = timing.set_lines(x);
    } else if (!unit.is_textured(stamp.is_triangle, stamp.mask)) {
      stamp.offered = divides ? timing.divide(x, unit.groups(stamp.mask)) : timing.pass(x);
    } else {
      const auto lookups = unit.take(stamp.mask, stamp.sample, stamp.frame, stamp.combined, read);
      const TextureUse use = use_of(lookups);
      plan.use.samples += use.samples;
      plan.use.hits += use.hits;
      plan.use.fills += use.fills;
      stamp.offered = timing.take(x, lookups, ask);
    }
    stamp.left = world.next_free(1, stamp.offered);
    timing.leave(stamp.left);
    plan.last = std::max(plan.last, stamp.left);
    plan.stamps.push_back(stamp);
  }
  plan.last = std::max(plan.last, timing.is_empty());
  return plan;
}

}  // namespace halfplane::texture_test
