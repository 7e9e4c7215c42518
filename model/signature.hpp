// Signatures: 128-bit hashes of a sequence of words.
//
// Two lanes of 64 bits, each of which absorbs a word by invertible steps: two different states stay different for any
// following words, so lengths do not matter. At the end each is folded. Sequences that differ have equal signatures
// with a probability of about 2^-128, for words not chosen to collide.
#pragma once

#include <bit>
#include <cstdint>

#include "fixed.hpp"

namespace halfplane {

struct Signature {
  std::uint64_t low = 0, high = 0;
  bool operator==(const Signature&) const = default;
};

class SignatureHash {
 public:
  void add(std::uint64_t word) {
    low_ = std::rotl((low_ ^ word) * 0x9e3779b97f4a7c15U, 29);
    high_ = std::rotl((high_ + word) * 0xd6e8feb86659fd93U, 37);
    ++words_;
  }
  void add(const Signature& signature) {
    add(signature.low);
    add(signature.high);
  }
  [[nodiscard]] Signature signature() const {
    const std::uint64_t low = low_ ^ words_, high = high_ ^ std::rotl(low_, 32);
    return {folded_product(low, 0xe7037ed1a0b428dbU) ^ low, folded_product(high, 0x8ebc6af09c88c6e3U) ^ high};
  }

 private:
  [[nodiscard]] static std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) {
    const uint128 product = uint128{a} * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }

  std::uint64_t low_ = 0x2545f4914f6cdd1dU, high_ = 0x589965cc75374cc3U;
  std::uint64_t words_ = 0;
};

}  // namespace halfplane
