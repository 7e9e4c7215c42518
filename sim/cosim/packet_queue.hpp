// A queue of packets as packed 32-bit words (model/packets/packet_words.hpp), without an allocation a packet.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/packets/packet_words.hpp"

namespace halfplane {

static_assert(std::endian::native == std::endian::little, "Verilated ports are compared as bytes, lowest first");

/// A first-in first-out ring of packets of one size. It grows; it never shrinks.
class PacketQueue {
 public:
  explicit PacketQueue(std::size_t words = 1) : words_(words) {}

  [[nodiscard]] bool empty() const { return head_ == tail_; }
  [[nodiscard]] std::size_t size() const { return tail_ - head_; }
  [[nodiscard]] std::size_t words() const { return words_; }

  /// Room for one more packet, to be filled by the caller; valid until the next push. `tag` comes back with it.
  std::uint32_t* push(std::uint32_t tag) {
    if (size() == capacity_) grow();
    std::uint32_t* slot = at(tail_++);
    slot[words_] = tag;
    return slot;
  }
  [[nodiscard]] const std::uint32_t* front(std::size_t ahead = 0) const { return at(head_ + ahead); }
  [[nodiscard]] std::uint32_t* front(std::size_t ahead = 0) { return at(head_ + ahead); }
  [[nodiscard]] std::uint32_t front_tag() const { return front()[words_]; }
  void pop() { ++head_; }

 private:
  [[nodiscard]] const std::uint32_t* at(std::size_t n) const {
    return ring_.data() + (n & (capacity_ - 1)) * (words_ + 1);
  }
  [[nodiscard]] std::uint32_t* at(std::size_t n) { return ring_.data() + (n & (capacity_ - 1)) * (words_ + 1); }
  void grow() {
    std::vector<std::uint32_t> ring((2 * capacity_) * (words_ + 1));
    for (std::size_t n = head_; n != tail_; ++n)
      std::copy_n(at(n), words_ + 1, ring.data() + (n & (2 * capacity_ - 1)) * (words_ + 1));
    ring_.swap(ring);
    capacity_ *= 2;
  }

  std::size_t words_, capacity_ = 64;  // capacity: packets, a power of two
  std::size_t head_ = 0, tail_ = 0;
  std::vector<std::uint32_t> ring_ = std::vector<std::uint32_t>(capacity_ * (words_ + 1));
};

}  // namespace halfplane
