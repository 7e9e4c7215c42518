// Packets for tests: their values.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>
#include <vector>

#include "model/packets/packet_words.hpp"

namespace halfplane::test {

/// Every value of a packet in this configuration, not truncated to its width, the first field first.
template <class Packet>
[[nodiscard]] std::vector<std::uint64_t> values_of(const Packet& packet, const Widths& widths) {
  std::vector<std::uint64_t> values;
  for_each_value(packet, widths, [&](const auto& value, const Width&) { values.push_back(to_bits(value)); });
  return values;
}

/// The RTL returns the packet unchanged: every value fits its field.
template <class Packet>
void expect_survives_packing(const Packet& packet, const Widths& widths) {
  const auto back = unpack_words<Packet>(packed(packet, widths).data(), widths);
  ASSERT_EQ(values_of(back, widths), values_of(packet, widths)) << Packet::name;
}

/// Every field of the packet fits the member that holds it in C++.
template <class Packet>
void expect_members_wide_enough(const Widths& widths) {
  const Packet packet;
  for_each_value(packet, widths, []<class Member>(const Member&, const Width& width) {
    const int room = std::is_same_v<Member, bool> ? 1 : static_cast<int>(8 * sizeof(Member));
    EXPECT_LE(width.bits, room) << Packet::name << ": " << width.name;
    const bool is_signed = std::is_signed_v<Member>;
    EXPECT_EQ(width.is_signed, is_signed) << Packet::name << ": " << width.name;
  });
}

}  // namespace halfplane::test
