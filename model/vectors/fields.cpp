#include <algorithm>
#include <functional>
#include <numeric>
#include <type_traits>

#include "../packets/packet_words.hpp"
#include "stages.hpp"

namespace halfplane::vectors {

namespace {

/// "code[3][red]" in its parts: "code", then the text in brackets.
std::string_view stem_of(std::string_view name) { return name.substr(0, name.find('[')); }

/// Places the fields in the packed struct: the first field highest; of the elements of one array the first lowest.
void place(std::vector<FieldName>& fields) {
  int low = 0;
  for (std::size_t end = fields.size(); end > 0;) {
    std::size_t first = end - 1;
    const bool is_array = fields[first].name.find('[') != std::string::npos;
    while (is_array && first > 0 && stem_of(fields[first - 1].name) == stem_of(fields[end - 1].name)) --first;
    for (std::size_t i = first; i < end; ++i) low = (fields[i].low = low) + fields[i].bits;
    end = first;
  }
}

}  // namespace

std::vector<FieldName> fields_of(Arrow like, const Widths& widths) {
  return with_packet_type(like, [&]<class Packet>(std::type_identity<Packet>) {
    std::vector<FieldName> fields;
    for (const auto& [name, width] : element_names<Packet>(widths))
      fields.push_back({name, width.bits, width.is_signed});
    place(fields);
    return fields;
  });
}

std::vector<FieldName> highest_first(std::vector<FieldName> fields) {
  std::ranges::sort(fields, std::greater(), &FieldName::low);
  return fields;
}

std::vector<std::uint64_t> values_of(Arrow like, const Widths& widths, std::span<const std::uint32_t> words) {
  return with_packet_type(
      like, [&]<class Packet>(std::type_identity<Packet>) { return element_values<Packet>(words.data(), widths); });
}

std::vector<std::uint32_t> words_from(std::span<const FieldName> fields, std::span<const std::uint64_t> values) {
  std::vector<std::size_t> order(fields.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return fields[i].low; });
  std::vector<std::uint32_t> words(words_of(order.empty() ? 0 : fields[order.back()].low + fields[order.back()].bits));
  WordWriter writer(words.data());
  for (const std::size_t i : order) writer.put(values[i], fields[i].bits);
  writer.finish();
  return words;
}

std::string place_fault(std::span<const FieldName> fields, std::span<const std::uint64_t> values, const Config& config,
                        const Widths& widths) {
  const auto limit_of = [&](std::string_view name) {
    const bool is_x = name == "x" || name == "left" || name == "right";
    const bool is_y = name == "y" || name == "top" || name == "bottom";
    if (name == "tile_x") return widths.tiles_x;
    if (name == "tile_y") return widths.tiles_y;
    return is_x ? config.target_width : is_y ? config.target_height : 0;
  };
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const int limit = limit_of(fields[i].name);
    if (limit != 0 && values[i] >= static_cast<std::uint64_t>(limit))
      return "'" + fields[i].name + "' is " + std::to_string(values[i]) + ", and the largest target ends at " +
             std::to_string(limit - 1);
  }
  return {};
}

}  // namespace halfplane::vectors
