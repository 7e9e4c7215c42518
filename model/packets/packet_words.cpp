#include "packet_words.hpp"

#include "../pipeline_graph.hpp"

namespace halfplane {
namespace {

/// for_each_value() from the lowest bit up.
template <class Packet, class Visit>
void for_each_value_upwards(Packet& packet, const Widths& widths, Visit& visit) {
  for_each_field_upwards<std::remove_const_t<Packet>>([&](const auto& field) {
    if constexpr (std::is_same_v<decltype(field.width), Nested>)
      for_each_value_upwards(packet.*field.member, widths, visit);
    else
      packet_detail::visit_member(packet.*field.member, element_count(field, widths), widths, field.width, visit);
  });
}

// Visitors have types of their own: a visitor of one packet's members is compiled once for all packets.

struct BitCounter {
  int bits = 0;
  void operator()(const auto&, const Width& width) { bits += width.bits; }
};

/// Whether a width of values of this type can be above 32 bits.
template <class T>
inline constexpr bool kIsLong = sizeof(T) > sizeof(std::uint32_t);

struct Packer {
  WordWriter writer;
  template <class T>
  void operator()(const T& value, const Width& width) {
    if constexpr (kIsLong<T>)
      writer.put(to_bits(value), width.bits);
    else
      writer.put_word(to_bits(value), width.bits);
  }
};

struct Unpacker {
  WordReader reader;
  template <class T>
  void operator()(T& value, const Width& width) {
    if constexpr (kIsLong<T>)
      value = from_bits<T>(reader.take(width.bits), width);
    else
      value = from_bits<T>(reader.take_word(width.bits), width);
  }
};

struct ValueList {
  std::vector<std::uint64_t> values;
  void operator()(const auto& value, const Width& width) {
    values.push_back(wrap_unsigned(to_bits(value), width.bits));
  }
};

/// Names of elements.
class NameList {
 public:
  explicit NameList(const Widths& widths) : widths_(widths) {}
  template <class Packet>
  void add_packet() {
    for_each_field<Packet>([this](const auto& field) { this->add(field); });
  }
  [[nodiscard]] std::vector<ElementName> take() { return std::move(names_); }

 private:
  template <class Packet, class Member>
  void add(const Field<Packet, Member, Nested>&) {
    add_packet<Member>();
  }
  template <class Packet, class Member>
  void add(const Field<Packet, Member, Width Widths::*>& field) {
    const std::size_t count = element_count(field, widths_);
    for (std::size_t i = 0; i < count; ++i)
      names_.push_back({numbered(field.name, kElements<Member, Width Widths::*> != 0, i), widths_.*field.width});
  }
  template <class Packet, class Member>
  void add(const Field<Packet, Member, Width AttributeWidths::*>& field) {
    const std::size_t count = element_count(field, widths_);
    for (std::size_t i = 0; i < count; ++i) add_planes(numbered(field.name, count > 1, i), field.width);
  }
  void add_planes(const std::string& name, Width AttributeWidths::*width) {
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.planes); ++p)
      if ((widths_.of_plane(p).*width).bits != 0)
        names_.push_back({name + "[" + std::string(widths_.plane_name(p)) + "]", widths_.of_plane(p).*width});
  }
  [[nodiscard]] static std::string numbered(std::string_view name, bool is_array, std::size_t i) {
    return is_array ? std::string(name) + "[" + std::to_string(i) + "]" : std::string(name);
  }

  const Widths& widths_;
  std::vector<ElementName> names_;
};

}  // namespace

template <class Packet>
int packet_bits(const Widths& widths) {
  const Packet packet;
  BitCounter counter;
  for_each_value(packet, widths, counter);
  return counter.bits;
}

// Flattened: the state of writer and reader stays in registers.
template <class Packet>
[[gnu::flatten]] void pack_words(const Packet& packet, const Widths& widths, std::uint32_t* out) {
  Packer packer{WordWriter(out)};
  for_each_value_upwards(packet, widths, packer);
  packer.writer.finish();
}

template <class Packet>
[[gnu::flatten]] Packet unpack_words(const std::uint32_t* words, const Widths& widths) {
  Packet packet;
  Unpacker unpacker{WordReader(words)};
  for_each_value_upwards(packet, widths, unpacker);
  return packet;
}

template <class Packet>
std::vector<ElementName> element_names(const Widths& widths) {
  NameList names(widths);
  names.add_packet<Packet>();
  return names.take();
}

template <class Packet>
std::vector<std::uint64_t> element_values(const std::uint32_t* words, const Widths& widths) {
  const auto packet = unpack_words<Packet>(words, widths);
  ValueList list;
  for_each_value(packet, widths, list);
  return std::move(list.values);
}

// All packets, and their nested parts.
#define HALFPLANE_COMPILE(Packet)                                                 \
  template int packet_bits<Packet>(const Widths&);                                \
  template void pack_words<Packet>(const Packet&, const Widths&, std::uint32_t*); \
  template Packet unpack_words<Packet>(const std::uint32_t*, const Widths&);      \
  template std::vector<ElementName> element_names<Packet>(const Widths&);         \
  template std::vector<std::uint64_t> element_values<Packet>(const std::uint32_t*, const Widths&);
#define HALFPLANE_ON_ARROW(name, packet, ...) HALFPLANE_COMPILE(packet)
HALFPLANE_ARROWS(HALFPLANE_ON_ARROW)
HALFPLANE_COMPILE(CounterPacket)
HALFPLANE_COMPILE(MemoryLayout)
HALFPLANE_COMPILE(PixelBox)
HALFPLANE_COMPILE(TileBox)
HALFPLANE_COMPILE(PrimitiveState)
HALFPLANE_COMPILE(TileKey)
HALFPLANE_COMPILE(TriangleVertices)
HALFPLANE_COMPILE(CodeRange)
HALFPLANE_COMPILE(CoordinateFrame)
#undef HALFPLANE_ON_ARROW
#undef HALFPLANE_COMPILE

}  // namespace halfplane
