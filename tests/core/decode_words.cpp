// Output of the software backend's decoder: for the test that holds it against core/command_decoder.sv.
//
// usage: decode_words CONFIG <STREAMS >RESULTS; a line of STREAMS is the words of a stream in hexadecimal, a line of RESULTS
// JSON. After a STOP the stream is started again.
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "driver/backend/decode.hpp"
#include "model/packets/packet_words.hpp"

namespace halfplane {
namespace {

template <class Packet>
std::string hex(const Packet& packet, const Widths& widths) {
  std::string text;
  for (const std::uint32_t word : packed(packet, widths)) {
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", word);
    text.insert(0, digits);
  }
  return text;
}

nlohmann::json decode(const std::vector<std::uint32_t>& stream, const Config& config, const Widths& widths) {
  driver::Decoder decoder(config);
  nlohmann::json result{{"outcome", "taken"}, {"packets", nlohmann::json::array()}, {"lines", nlohmann::json::array()}};
  int starts = 0;
  try {
    for (std::span<const std::uint32_t> rest = stream; !rest.empty(); ++starts) rest = rest.subspan(decoder.read(rest));
  } catch (const driver::RefusedWord& refused) {
    result["outcome"] = "refused";
    result["error"] = refused.error;
    result["words"] = refused.words;
  } catch (const InputError& error) {
    result["outcome"] = error.what();
  }
  for (const driver::DecodedPrimitive& primitive : decoder.primitives()) {
    result["packets"].push_back(hex(primitive.packet, widths));
    if (primitive.line) result["lines"].push_back(hex(*primitive.line, widths));
  }
  result["starts"] = starts;
  result["fences"] = decoder.fences();
  result["presented"] = nlohmann::json::array();
  for (const driver::Presented& shown : decoder.presented())
    result["presented"].push_back({shown.color, shown.color_flags});
  result["layout"] = hex(decoder.layout(), widths);
  return result;
}

}  // namespace
}  // namespace halfplane

int main(int, char** argv) {
  const halfplane::Config config = halfplane::labelled(argv[1]);
  const halfplane::Widths widths = halfplane::derive_widths(config);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream text(line);
    std::vector<std::uint32_t> stream;
    for (std::string word; text >> word;) stream.push_back(static_cast<std::uint32_t>(std::stoul(word, nullptr, 16)));
    std::cout << halfplane::decode(stream, config, widths).dump() << '\n';
  }
}
