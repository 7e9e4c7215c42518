#include "sim/cosim/arrows.hpp"

#include "sim/cosim/packet_words.hpp"

namespace halfplane {
namespace {

std::string decimal(std::uint64_t raw, int bits, bool is_signed) {
  return is_signed ? std::to_string(wrap_signed(static_cast<std::int64_t>(raw), bits)) : std::to_string(raw);
}

PacketBits bits_of(const std::uint32_t* words, int size) {
  PacketBits bits(size);
  std::copy_n(words, bits.word.size(), bits.word.begin());
  return bits;
}

}  // namespace

std::string FieldPair::model_text() const { return decimal(model, bits, is_signed); }
std::string FieldPair::rtl_text() const { return decimal(rtl, bits, is_signed); }

template <class Packet>
std::vector<FieldPair> field_pairs(const Widths& widths, const std::uint32_t* model, const std::uint32_t* rtl) {
  const int size = packet_bits<Packet>(widths);
  const PacketBits a = bits_of(model, size), b = bits_of(rtl, size);
  std::vector<FieldPair> pairs;
  for_each_element<Packet>(widths, [&](const auto& field, const Width& width, std::size_t i, int position) {
    const bool is_array = kArraySize<std::decay_t<decltype(std::declval<Packet>().*field.member)>> != 0;
    pairs.push_back({std::string(field.name) + (is_array ? "[" + std::to_string(i) + "]" : ""), width.bits,
                     width.is_signed, a.take(position, width.bits), b.take(position, width.bits)});
  });
  return pairs;
}
template std::vector<FieldPair> field_pairs<CounterPacket>(const Widths&, const std::uint32_t*, const std::uint32_t*);

std::vector<FieldPair> field_pairs(Arrow arrow, const Widths& widths, const std::uint32_t* model,
                                   const std::uint32_t* rtl) {
  return with_packet_type(
      arrow, [&]<class Packet>(std::type_identity<Packet>) { return field_pairs<Packet>(widths, model, rtl); });
}

}  // namespace halfplane
