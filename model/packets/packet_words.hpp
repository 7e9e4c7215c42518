// Packets as packed 32-bit words, lowest first: the input and output of the RTL. Everything follows from a packet's
// fields (packets.hpp). SystemVerilog puts the first field of a packed struct highest; arrays have element 0 lowest.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "packets.hpp"

namespace halfplane {

/// Converts a value to the bits that hold it, and back. Signed values are sign-extended.
template <class T>
[[nodiscard]] constexpr std::uint64_t to_bits(const T& value) {
  if constexpr (std::is_same_v<T, SampleMask>)
    return value.bits();
  else
    return static_cast<std::uint64_t>(value);
}
template <class T>
[[nodiscard]] constexpr T from_bits(std::uint64_t bits, const Width& width) {
  if (width.is_signed) bits = static_cast<std::uint64_t>(wrap_signed(static_cast<std::int64_t>(bits), width.bits));
  return static_cast<T>(bits);
}

/// Elements of a member that is an array of them; 0 for a plain member. Where each plane has its own width, an element
/// is an array over the planes.
template <class Member, class Place>
inline constexpr std::size_t kElements = kArraySize<Member>;
template <class Member>
inline constexpr std::size_t kElements<Member, Width AttributeWidths::*> =
    kArraySize<typename Member::value_type> == 0 ? 0 : kArraySize<Member>;

/// Elements of a field in one configuration; 1 for a plain one, 0 if the configuration does not have it.
template <class Packet, class Member, class Place>
[[nodiscard]] constexpr std::size_t element_count(const Field<Packet, Member, Place>& field, const Widths& widths) {
  if (field.count != nullptr) return static_cast<std::size_t>(widths.*field.count);
  return std::max<std::size_t>(1, kElements<Member, Place>);
}

namespace packet_detail {

/// Calls visit(value, width) for an element, or for its value on every plane that has one.
template <class Value, class Visit>
constexpr void visit_element(Value& value, const Widths& widths, Width Widths::*width, Visit& visit) {
  visit(value, widths.*width);
}
template <class Values, class Visit>
constexpr void visit_element(Values& values, const Widths& widths, Width AttributeWidths::*width, Visit& visit) {
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p)
    if ((widths.of_plane(p).*width).bits != 0) visit(values[p], widths.of_plane(p).*width);
}

/// Likewise for an array of elements. It is not typed: arrays of all sizes share this function.
template <class Value, class Place, class Visit>
constexpr void visit_array(Value* values, std::size_t count, const Widths& widths, Place width, Visit& visit) {
  for (std::size_t i = 0; i < count; ++i) visit_element(values[i], widths, width, visit);
}

/// Likewise for the elements of a member.
template <class Member, class Place, class Visit>
constexpr void visit_member(Member& member, std::size_t count, const Widths& widths, Place width, Visit& visit) {
  if constexpr (kElements<std::remove_const_t<Member>, Place> != 0)
    visit_array(member.data(), count, widths, width, visit);
  else if (count != 0)
    visit_element(member, widths, width, visit);
}

}  // namespace packet_detail

/// Calls visit(value, width) for every element of every field, the first field first; elements of an array in order.
/// Packet: const or not.
template <class Packet, class Visit>
constexpr void for_each_value(Packet& packet, const Widths& widths, Visit&& visit) {
  for_each_field<std::remove_const_t<Packet>>([&](const auto& field) {
    if constexpr (std::is_same_v<decltype(field.width), Nested>)
      for_each_value(packet.*field.member, widths, visit);
    else
      packet_detail::visit_member(packet.*field.member, element_count(field, widths), widths, field.width, visit);
  });
}

/// Words that hold `bits`.
[[nodiscard]] constexpr std::size_t words_of(int bits) { return static_cast<std::size_t>((bits + 31) / 32); }

/// Writes values from the lowest bit up.
class WordWriter {
 public:
  explicit WordWriter(std::uint32_t* out) : out_(out) {}
  /// `bits` of 1 to 64.
  void put(std::uint64_t value, int bits) {
    if (bits > 32) {
      put_word(value, 32);
      value >>= 32;
      bits -= 32;
    }
    put_word(value, bits);
  }
  /// `bits` of 1 to 32.
  void put_word(std::uint64_t value, int bits) {
    pending_ |= (value & (~0ULL >> (64 - bits))) << filled_;  // filled_ < 32: no bit is lost
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

/// Reads values from the lowest bit up.
class WordReader {
 public:
  explicit WordReader(const std::uint32_t* in) : in_(in) {}
  /// `bits` of 1 to 64.
  std::uint64_t take(int bits) {
    if (bits <= 32) return take_word(bits);
    const std::uint64_t low = take_word(32);
    return low | take_word(bits - 32) << 32;
  }
  /// `bits` of 1 to 32.
  std::uint64_t take_word(int bits) {
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

// Templates without a body are compiled in packet_words.cpp, for the packets and parts of packets listed there.

/// Bits of the packed struct.
template <class Packet>
[[nodiscard]] int packet_bits(const Widths& widths);

/// Writes the packed struct to `out`, words_of(packet_bits) of them.
template <class Packet>
void pack_words(const Packet& packet, const Widths& widths, std::uint32_t* out);

template <class Packet>
[[nodiscard]] std::vector<std::uint32_t> packed(const Packet& packet, const Widths& widths) {
  std::vector<std::uint32_t> words(words_of(packet_bits<Packet>(widths)));
  pack_words(packet, widths, words.data());
  return words;
}

template <class Packet>
[[nodiscard]] Packet unpack_words(const std::uint32_t* words, const Widths& widths);

/// One element of a packet, in readable form.
struct ElementName {
  std::string name;  ///< "mask", "edge_value[2]", "step_x[depth]", "code[1][red]"; if nested, only its own name
  Width width;
};

/// Every element of a packet type that has bits, the highest field first, elements of an array in order.
template <class Packet>
[[nodiscard]] std::vector<ElementName> element_names(const Widths& widths);

/// The bits of every element, in the order of element_names().
template <class Packet>
[[nodiscard]] std::vector<std::uint64_t> element_values(const std::uint32_t* words, const Widths& widths);

}  // namespace halfplane
