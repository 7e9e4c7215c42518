// Packets as packed 32-bit words in place, without an allocation a packet: the fast twin of model/packet_bits.hpp, which
// a test holds it against.
#pragma once

#include <bit>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "model/packet_bits.hpp"

namespace halfplane {

static_assert(std::endian::native == std::endian::little, "Verilated ports are compared as bytes, lowest first");

/// Words that hold `bits`.
[[nodiscard]] constexpr std::size_t words_of(int bits) { return static_cast<std::size_t>((bits + 31) / 32); }

/// Writes fields from the lowest bit up.
class WordWriter {
 public:
  explicit WordWriter(std::uint32_t* out) : out_(out) {}
  /// `bits` of 1 to 64.
  void put(std::uint64_t value, int bits) {
    if (bits > 32) {
      put(value & 0xffffffffU, 32);
      value >>= 32;
      bits -= 32;
    }
    pending_ |= (value & (~0ULL >> (64 - bits))) << filled_;  // filled_ < 32: nothing is lost
    filled_ += bits;
    if (filled_ >= 32) {
      *out_++ = static_cast<std::uint32_t>(pending_);
      pending_ >>= 32;
      filled_ -= 32;
    }
  }
  void finish() {
    if (filled_ > 0) *out_ = static_cast<std::uint32_t>(pending_);
  }

 private:
  std::uint32_t* out_;
  std::uint64_t pending_ = 0;
  int filled_ = 0;
};

/// Writes the packed struct to `out`, words_of(packet_bits) of them. The last field is the lowest.
template <class Packet>
void pack_words(const Packet& packet, const Widths& widths, std::uint32_t* out) {
  WordWriter writer(out);
  constexpr auto fields = Packet::fields();
  const auto put = [&](const auto& field) {
    const int bits = (widths.*field.width).bits;
    const std::size_t count = element_count(field, widths);
    for (std::size_t i = 0; i < count; ++i)
      writer.put(static_cast<std::uint64_t>(element(packet, field.member, i)), bits);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (put(std::get<sizeof...(I) - 1 - I>(fields)), ...); }
  (std::make_index_sequence<std::tuple_size_v<decltype(fields)>>{});
  writer.finish();
}

template <class Packet>
[[nodiscard]] std::vector<std::uint32_t> packed(const Packet& packet, const Widths& widths) {
  std::vector<std::uint32_t> words(words_of(packet_bits<Packet>(widths)));
  pack_words(packet, widths, words.data());
  return words;
}

/// Reads fields from the lowest bit up.
class WordReader {
 public:
  explicit WordReader(const std::uint32_t* in) : in_(in) {}
  /// `bits` of 1 to 64.
  std::uint64_t take(int bits) {
    if (bits > 32) {
      const std::uint64_t low = take(32);
      return low | take(bits - 32) << 32;
    }
    if (held_ < bits) {
      pending_ |= std::uint64_t{*in_++} << held_;
      held_ += 32;
    }
    const std::uint64_t value = pending_ & (~0ULL >> (64 - bits));
    pending_ >>= bits;
    held_ -= bits;
    return value;
  }

 private:
  const std::uint32_t* in_;
  std::uint64_t pending_ = 0;
  int held_ = 0;
};

template <class Packet>
[[nodiscard]] Packet unpack_words(const std::uint32_t* words, const Widths& widths) {
  Packet packet;
  WordReader reader(words);
  constexpr auto fields = Packet::fields();
  const auto take = [&](const auto& field) {
    const Width& width = widths.*field.width;
    const std::size_t count = element_count(field, widths);
    for (std::size_t i = 0; i < count; ++i) {
      auto& value = element(packet, field.member, i);
      const std::uint64_t raw = reader.take(width.bits);
      value = static_cast<std::decay_t<decltype(value)>>(
          width.is_signed ? static_cast<std::uint64_t>(wrap_signed(static_cast<std::int64_t>(raw), width.bits)) : raw);
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (take(std::get<sizeof...(I) - 1 - I>(fields)), ...); }
  (std::make_index_sequence<std::tuple_size_v<decltype(fields)>>{});
  return packet;
}

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
