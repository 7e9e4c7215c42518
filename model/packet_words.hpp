// Packets as packed 32-bit words, lowest first: what goes into and comes out of the RTL. All of it follows from a packet's
// fields (packets.hpp). SystemVerilog puts the first field of a packed struct highest; arrays have element 0 lowest.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "packets.hpp"

namespace halfplane {

/// A value as the bits that hold it, and back. The bits of a signed one go on with its sign.
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

/// Elements of a field in one configuration; 1 for a plain one, 0 if the configuration does not have it. Of an array with an element for each plane: those of its
/// outermost dimension, if there is another one, else 1.
template <class Packet, class Member, class Place>
[[nodiscard]] constexpr std::size_t element_count(const Field<Packet, Member, Place>& field, const Widths& widths) {
  if (field.count != nullptr) return static_cast<std::size_t>(widths.*field.count);
  if constexpr (std::is_same_v<Place, Width AttributeWidths::*>)
    return kArraySize<std::remove_cvref_t<decltype(std::declval<Member>()[0])>> == 0 ? 1 : kArraySize<Member>;
  else
    return std::max<std::size_t>(1, kArraySize<Member>);
}

/// Calls visit(value, width) for every element of every field, the first field first or the last one, which is the lowest;
/// elements of an array in order. Packet: const or not.
template <bool kIsUpwards, class Packet, class Visit>
constexpr void for_each_value_in_order(Packet& packet, const Widths& widths, Visit&& visit) {
  constexpr auto fields = std::remove_const_t<Packet>::fields();
  const auto planes = [&](auto& values, Width AttributeWidths::*width) {
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p)
      if ((widths.of_plane(p).*width).bits != 0) visit(values[p], widths.of_plane(p).*width);
  };
  const auto elements = [&](auto& member, const Width& width, std::size_t count) {
    if constexpr (kArraySize<std::remove_cvref_t<decltype(member)>> != 0)
      for (std::size_t i = 0; i < count; ++i) visit(member[i], width);
    else if (count != 0)
      visit(member, width);
  };
  const auto one = [&](const auto& field) {
    auto& member = packet.*field.member;
    using Member = std::remove_cvref_t<decltype(member)>;
    using Place = std::remove_cvref_t<decltype(field.width)>;
    const std::size_t count = element_count(field, widths);
    if constexpr (std::is_same_v<Place, Nested>) {
      for_each_value_in_order<kIsUpwards>(member, widths, visit);
    } else if constexpr (std::is_same_v<Place, Width Widths::*>) {
      elements(member, widths.*field.width, count);
    } else if constexpr (kArraySize<std::remove_cvref_t<decltype(std::declval<Member>()[0])>> == 0) {
      planes(member, field.width);
    } else {
      for (std::size_t i = 0; i < count; ++i) planes(member[i], field.width);
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (one(std::get < kIsUpwards ? sizeof...(I) - 1 - I : I > (fields)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(fields)>>{});
}
template <class Packet, class Visit>
constexpr void for_each_value(Packet& packet, const Widths& widths, Visit&& visit) {
  for_each_value_in_order<false>(packet, widths, visit);
}
/// From the lowest bit up.
template <class Packet, class Visit>
constexpr void for_each_value_upwards(Packet& packet, const Widths& widths, Visit&& visit) {
  for_each_value_in_order<true>(packet, widths, visit);
}

/// Bits of the packed struct.
template <class Packet>
[[nodiscard]] constexpr int packet_bits(const Widths& widths) {
  int bits = 0;
  const Packet packet;
  for_each_value_upwards(packet, widths, [&bits](const auto&, const Width& width) { bits += width.bits; });
  return bits;
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

/// Reads values from the lowest bit up.
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

/// Writes the packed struct to `out`, words_of(packet_bits) of them.
template <class Packet>
void pack_words(const Packet& packet, const Widths& widths, std::uint32_t* out) {
  WordWriter writer(out);
  for_each_value_upwards(packet, widths,
                         [&writer](const auto& value, const Width& width) { writer.put(to_bits(value), width.bits); });
  writer.finish();
}

template <class Packet>
[[nodiscard]] std::vector<std::uint32_t> packed(const Packet& packet, const Widths& widths) {
  std::vector<std::uint32_t> words(words_of(packet_bits<Packet>(widths)));
  pack_words(packet, widths, words.data());
  return words;
}

template <class Packet>
[[nodiscard]] Packet unpack_words(const std::uint32_t* words, const Widths& widths) {
  Packet packet;
  WordReader reader(words);
  for_each_value_upwards(packet, widths, [&reader](auto& value, const Width& width) {
    value = from_bits<std::remove_reference_t<decltype(value)>>(reader.take(width.bits), width);
  });
  return packet;
}

/// One element of a packet, as a reader sees it.
struct ElementName {
  std::string name;  ///< "mask", "edge_value[2]", "step_x[depth]", "code[1][red]"; of a nested one, its own name alone
  Width width;
};

/// Every element of a packet type that has bits, the highest field first, elements of an array in order.
template <class Packet>
[[nodiscard]] std::vector<ElementName> element_names(const Widths& widths) {
  std::vector<ElementName> names;
  const auto planes = [&](const std::string& name, Width AttributeWidths::*width) {
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p)
      if ((widths.of_plane(p).*width).bits != 0)
        names.push_back({name + "[" + std::string(widths.plane_name(p)) + "]", widths.of_plane(p).*width});
  };
  const auto one = [&]<class P, class Member, class Place>(const Field<P, Member, Place>& field) {
    const std::string name(field.name);
    if constexpr (std::is_same_v<Place, Nested>) {
      const auto inner = element_names<Member>(widths);
      names.insert(names.end(), inner.begin(), inner.end());
    } else {
      const bool is_array = !std::is_same_v<Place, Width AttributeWidths::*> && kArraySize<Member> != 0;
      const std::size_t count = element_count(field, widths);
      for (std::size_t i = 0; i < count; ++i) {
        const std::string numbered = is_array || count > 1 ? name + "[" + std::to_string(i) + "]" : name;
        if constexpr (std::is_same_v<Place, Width Widths::*>)
          names.push_back({numbered, widths.*field.width});
        else
          planes(numbered, field.width);
      }
    }
  };
  std::apply([&](const auto&... field) { (one(field), ...); }, Packet::fields());
  return names;
}

/// The bits of every element, in the order of element_names().
template <class Packet>
[[nodiscard]] std::vector<std::uint64_t> element_values(const std::uint32_t* words, const Widths& widths) {
  const auto packet = unpack_words<Packet>(words, widths);
  std::vector<std::uint64_t> values;
  for_each_value(packet, widths, [&values](const auto& value, const Width& width) {
    values.push_back(wrap_unsigned(to_bits(value), width.bits));
  });
  return values;
}

}  // namespace halfplane
