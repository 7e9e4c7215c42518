#include "sim/cosim/arrows.hpp"

#include "model/packets/packet_words.hpp"

namespace halfplane {
namespace {

std::string decimal(std::uint64_t raw, int bits, bool is_signed) {
  return is_signed ? std::to_string(wrap_signed(static_cast<std::int64_t>(raw), bits)) : std::to_string(raw);
}

}  // namespace

std::string FieldPair::model_text() const { return decimal(model, bits, is_signed); }
std::string FieldPair::rtl_text() const { return decimal(rtl, bits, is_signed); }

template <class Packet>
std::vector<FieldPair> field_pairs(const Widths& widths, const std::uint32_t* model, const std::uint32_t* rtl) {
  const auto values = [&](const std::uint32_t* words) { return element_values<Packet>(words, widths); };
  const auto a = values(model), b = values(rtl);
  std::vector<FieldPair> pairs;
  for (const auto& [name, width] : element_names<Packet>(widths))
    pairs.push_back({name, width.bits, width.is_signed, a[pairs.size()], b[pairs.size()]});
  return pairs;
}
template std::vector<FieldPair> field_pairs<CounterPacket>(const Widths&, const std::uint32_t*, const std::uint32_t*);

std::vector<FieldPair> field_pairs(Arrow arrow, const Widths& widths, const std::uint32_t* model,
                                   const std::uint32_t* rtl) {
  return with_packet_type(
      arrow, [&]<class Packet>(std::type_identity<Packet>) { return field_pairs<Packet>(widths, model, rtl); });
}

}  // namespace halfplane
