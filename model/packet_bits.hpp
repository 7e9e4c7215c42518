// Packets as bits: what goes into and comes out of the RTL, a trace line, and the field-by-field difference. All of it
// follows from a packet's field list (packets.hpp).
#pragma once

#include <string>
#include <vector>

#include "packets.hpp"

namespace halfplane {

/// A packed struct, word 0 lowest. SystemVerilog puts the first field of a packed struct highest.
struct PacketBits {
  int size = 0;                     ///< bits
  std::vector<std::uint32_t> word;  ///< 32 bits each, unused high bits 0
  bool operator==(const PacketBits&) const = default;

  explicit PacketBits(int size_) : size(size_), word(static_cast<std::size_t>((size_ + 31) / 32)) {}

  void put(int position, int bits, std::uint64_t value) {
    for (int done = 0; done < bits;) {  // up to the end of a word at a time
      const auto n = static_cast<std::size_t>(position + done);
      const int room = std::min(32 - static_cast<int>(n % 32), bits - done);
      const std::uint64_t piece = value >> done & (~0ULL >> (64 - room));
      word[n / 32] |= static_cast<std::uint32_t>(piece << n % 32);
      done += room;
    }
  }
  [[nodiscard]] std::uint64_t take(int position, int bits) const {
    std::uint64_t value = 0;
    for (int done = 0; done < bits;) {
      const auto n = static_cast<std::size_t>(position + done);
      const int room = std::min(32 - static_cast<int>(n % 32), bits - done);
      value |= (std::uint64_t{word[n / 32]} >> n % 32 & (~0ULL >> (64 - room))) << done;
      done += room;
    }
    return value;
  }
};

/// Calls visit(field, width, element, lowest bit) for every element of every field.
template <class Packet, class Visit>
void for_each_element(const Widths& widths, Visit&& visit) {
  int position = packet_bits<Packet>(widths);
  for_each_field<Packet>(widths, [&](const auto& field, const Width& width, std::size_t elements) {
    position -= width.bits * static_cast<int>(elements);
    for (std::size_t i = 0; i < elements; ++i) visit(field, width, i, position + static_cast<int>(i) * width.bits);
  });
}

/// The element as a reference, whether the member is an array or not.
template <class Packet, class Member>
[[nodiscard]] constexpr auto& element(Packet& packet, Member member, std::size_t i) {
  auto& value = packet.*member;
  if constexpr (kArraySize<std::remove_cvref_t<decltype(value)>> != 0)
    return value[i];
  else
    return value;
}

template <class Packet>
[[nodiscard]] PacketBits pack(const Packet& packet, const Widths& widths) {
  PacketBits bits(packet_bits<Packet>(widths));
  for_each_element<Packet>(widths, [&](const auto& field, const Width& width, std::size_t i, int position) {
    bits.put(position, width.bits, static_cast<std::uint64_t>(element(packet, field.member, i)));
  });
  return bits;
}

template <class Packet>
[[nodiscard]] Packet unpack(const PacketBits& bits, const Widths& widths) {
  Packet packet;
  for_each_element<Packet>(widths, [&](const auto& field, const Width& width, std::size_t i, int position) {
    auto& value = element(packet, field.member, i);
    const std::uint64_t raw = bits.take(position, width.bits);
    value = static_cast<std::decay_t<decltype(value)>>(
        width.is_signed ? static_cast<std::uint64_t>(wrap_signed(static_cast<std::int64_t>(raw), width.bits)) : raw);
  });
  return packet;
}

/// "name=value name[0]=value ...": the trace line.
template <class Packet>
[[nodiscard]] std::string to_string(const Packet& packet, const Widths& widths) {
  std::string text(Packet::name);
  for_each_element<Packet>(widths, [&](const auto& field, const Width& width, std::size_t i, int) {
    text += " " + std::string(field.name);
    if (kArraySize<std::decay_t<decltype(packet.*field.member)>> != 0) text += "[" + std::to_string(i) + "]";
    const auto value = element(packet, field.member, i);
    text += "=" + (width.is_signed ? std::to_string(static_cast<std::int64_t>(value))
                                   : std::to_string(static_cast<std::uint64_t>(value)));
  });
  return text;
}

/// The names of the fields in which two packets differ; empty when they are equal.
template <class Packet>
[[nodiscard]] std::vector<std::string> differing_fields(const Packet& a, const Packet& b, const Widths& widths) {
  std::vector<std::string> names;
  for_each_element<Packet>(widths, [&](const auto& field, const Width&, std::size_t i, int) {
    if (element(a, field.member, i) == element(b, field.member, i)) return;
    const bool is_array = kArraySize<std::decay_t<decltype(a.*field.member)>> != 0;
    names.push_back(std::string(field.name) + (is_array ? "[" + std::to_string(i) + "]" : ""));
  });
  return names;
}

}  // namespace halfplane
