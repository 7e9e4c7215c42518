// Signatures: 128 bits that stand for a sequence of words.
//
// Two lanes, each of which folds the 128-bit product of its state and a constant of its own for every word. Sequences that
// differ have equal signatures with a probability of about 2^-128, for words that nobody chose so as to make them equal: n
// comparisons are all right but for one in 2^128 / n.
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
    low_ = folded_product(low_ ^ word, 0x9e3779b97f4a7c15U);
    high_ = folded_product(high_ + std::rotl(word, 32), 0xd6e8feb86659fd93U) +
            1;  // + 1: lanes without a common fixed point
    ++words_;
  }
  void add(const Signature& signature) {
    add(signature.low);
    add(signature.high);
  }
  [[nodiscard]] Signature signature() const {
    return {folded_product(low_ ^ words_, 0xe7037ed1a0b428dbU), folded_product(high_ ^ ~words_, 0x8ebc6af09c88c6e3U)};
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
