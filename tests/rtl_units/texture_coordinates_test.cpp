// The coordinates of the texture unit, a sample a clock, against over_q and wrapped_texel: every mantissa of q, and P, frames
// and textures at random, most of all where something is rounded, held or wrapped.
#include <gtest/gtest.h>
#include <verilated.h>

#include <cstdlib>
#include <random>

#include "../tier.hpp"
#include "VTextureCoordinates.h"
#include "VTextureCoordinatesFull.h"
#include "VTextureCoordinatesTiny.h"
#include "model/stages/texture_unit.hpp"

namespace halfplane {
namespace {

constexpr std::size_t kFrames = 16, kClocks = 8;

template <class Dut>
class Coordinates {
 public:
  Coordinates(const PerspectiveFormat& format, std::uint64_t seed) : format_(format), unit_({}, format), random_(seed) {
    dut_.clk_i = 0;
    dut_.eval();
  }
  ~Coordinates() { dut_.final(); }
  Coordinates(const Coordinates&) = delete;
  Coordinates& operator=(const Coordinates&) = delete;

  /// Returns how many texels were wrong.
  std::uint64_t run(std::uint64_t samples) {
    const int q_bits = q_local_bits(format_);
    std::uint64_t wrong = 0;
    for (std::uint64_t n = 0; n < samples; ++n) {
      if (n % 1024 == 0) {
        wrong += drain();
        new_texture();
      }
      // The mantissa is enumerated; the exponent and the bits below the mantissa are random.
      const int k = format_.mantissa_bits, exponent = pick(0, q_bits - 1);
      const std::uint64_t mantissa = (n & ((1U << (k - 1)) - 1)) | 1U << (k - 1);
      TextureSample sample;
      sample.q = exponent < k ? mantissa >> (k - 1 - exponent)
                              : mantissa << (exponent - k + 1) | (random_() & ((1U << (exponent - k + 1)) - 1));
      for (std::int64_t& p : sample.p) p = new_p();
      wrong += clock(sample, static_cast<std::size_t>(random_() % kFrames));
    }
    return wrong + drain();
  }

 private:
  int pick(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }

  std::int64_t new_p() {
    const int bits = p_local_bits(format_.coordinate, format_);
    const std::int64_t p = wrap_signed(static_cast<std::int64_t>(random_()), bits) >> pick(0, bits - 1);
    if (pick(0, 3) != 0) return p;
    return wrap_signed((std::int64_t{1} << pick(0, bits - 1)) * (pick(0, 1) != 0 ? 1 : -1) + pick(-2, 2), bits);
  }

  void new_texture() {
    TextureState state;
    state.log2_size = {pick(0, 12), pick(0, 12)};
    for (TextureWrap& wrap : state.wrap) wrap = static_cast<TextureWrap>(pick(0, 2));
    unit_.set(state);
    dut_.wrap_i = 0;
    dut_.last_i = 0;
    for (int i = 0; i < 2; ++i) {
      dut_.last_i |= ((1U << state.log2_size[static_cast<std::size_t>(i)]) - 1) << (12 * i);
      dut_.wrap_i =
          static_cast<CData>(dut_.wrap_i | static_cast<int>(state.wrap[static_cast<std::size_t>(i)]) << (3 * i));
    }
    const int narrow = format_.coordinate.narrow_bits;
    dut_.frame_valid_i = 1;
    for (std::size_t n = 0; n < kFrames; ++n) {
      TextureFrame& f = frame_[n];
      for (std::size_t i = 0; i < 2; ++i) {
        f.scale[i] = {pick(1 - narrow, 2 + format_.q_bits - narrow), pick(0, kMaxReach)};
        f.reference[i] = pick(-1, 1) * (1 << pick(0, 22)) + pick(-3, 3);
        f.reference[i] = std::clamp(f.reference[i], -(1 << 22), 1 << 22);
      }
      const auto both = [](auto&& value, int bits) {
        const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
        return (static_cast<std::uint64_t>(std::int64_t{value(1)}) & mask) << bits |
               (static_cast<std::uint64_t>(std::int64_t{value(0)}) & mask);
      };
      dut_.frame_index_i = static_cast<CData>(n);
      dut_.shift_i = static_cast<SData>(both([&f](std::size_t i) { return f.scale[i].shift; }, 6));
      dut_.reach_i = static_cast<SData>(both([&f](std::size_t i) { return f.scale[i].reach; }, 5));
      dut_.reference_i = both([&f](std::size_t i) { return f.reference[i]; }, 24);
      tick();
    }
    dut_.frame_valid_i = 0;
  }

  void tick() {
    dut_.clk_i = 1;
    dut_.eval();
    dut_.clk_i = 0;
    dut_.eval();
  }
  /// Compares the output of this clock with the input of eight clocks ago.
  std::uint64_t clock(const TextureSample& sample, std::size_t frame) {
    dut_.q_i = static_cast<IData>(sample.q);
    const std::uint64_t mask = (std::uint64_t{1} << p_local_bits(format_.coordinate, format_)) - 1;
    dut_.u_i = static_cast<IData>(static_cast<std::uint64_t>(sample.p[0]) & mask);
    dut_.v_i = static_cast<IData>(static_cast<std::uint64_t>(sample.p[1]) & mask);
    const auto [x, y] = unit_.texels_of(unit_.place_of(sample, frame_[frame]), false, 0);
    expected_[count_ % kClocks] = static_cast<std::uint32_t>(y.first << 12 | x.first);
    dut_.index_i = static_cast<CData>(frame);
    tick();
    ++count_;
    return count_ >= kClocks && dut_.texel_o != expected_[count_ % kClocks] ? 1 : 0;
  }
  std::uint64_t drain() {
    std::uint64_t wrong = 0;
    for (std::size_t n = 1; n < kClocks && count_ != 0; ++n) {
      tick();
      ++count_;
      wrong += count_ >= kClocks && dut_.texel_o != expected_[count_ % kClocks] ? 1 : 0;
    }
    count_ = 0;
    return wrong;
  }

  PerspectiveFormat format_;
  TextureUnit unit_;
  std::mt19937_64 random_;
  Dut dut_;
  std::array<TextureFrame, kFrames> frame_{};
  std::array<std::uint32_t, kClocks> expected_{};
  std::uint64_t count_ = 0;
};

std::uint64_t seed_of_run() {
  const char* given = std::getenv("HALFPLANE_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 0) : std::random_device{}();
}

template <class Dut>
void expect_right(const PerspectiveFormat& format, std::uint64_t samples) {
  const std::uint64_t seed = seed_of_run();
  Coordinates<Dut> coordinates(format, seed);
  EXPECT_EQ(coordinates.run(test::cases(samples / 8, samples)), 0U) << "HALFPLANE_SEED=" << seed;
}

TEST(TextureCoordinates, Embedded) { expect_right<VTextureCoordinates>(kEmbeddedPerspective, 2'000'000); }
TEST(TextureCoordinates, Full4096) { expect_right<VTextureCoordinatesFull>(kFull4096Perspective, 2'000'000); }
TEST(TextureCoordinates, Tiny) { expect_right<VTextureCoordinatesTiny>(kTinyPerspective, 2'000'000); }

}  // namespace
}  // namespace halfplane
