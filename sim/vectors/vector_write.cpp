#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "sim/config_file.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/words.hpp"
#include "vector_file.hpp"

namespace halfplane::vectors {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSchema = "halfplane.vectors/1";

Json ports_json(const std::vector<Port>& ports, const Widths& widths) {
  Json list = Json::array();
  for (const Port& port : ports) {
    Json fields = Json::array();
    for (const FieldName& field : fields_of(port.like, widths))
      fields.push_back({{"name", field.name}, {"bits", field.bits}, {"signed", field.is_signed}});
    list.push_back({{"packet", port.name}, {"bits", bits_of(port.like, widths)}, {"fields", fields}});
  }
  return list;
}

Json header_json(const JudgedStage& stage, const Config& config, const Widths& widths, const VectorSource& source) {
  return {{"schema", kSchema},
          {"stage", info(stage.stage).name},
          {"source", source.text},
          {"seed", source.seed ? Json(*source.seed) : Json(nullptr)},
          {"config", config_json(config)},
          {"in", ports_json(stage.in, widths)},
          {"out", ports_json(stage.out, widths)}};
}

/// Calls add(is_out, port, number, fields, values) for every packet, in the stage's order.
template <class Add>
void for_each_packet(const JudgedStage& stage, const Config& config, const StagePackets& packets, Add&& add) {
  const Widths widths = derive_widths(config);
  std::array<std::vector<std::vector<FieldName>>, 2> fields;  // in, out; looked up once
  for (const Port& port : stage.in) fields[0].push_back(fields_of(port.like, widths));
  for (const Port& port : stage.out) fields[1].push_back(fields_of(port.like, widths));
  replay_stage(stage, config, packets,
               [&](bool is_out, std::size_t p, std::size_t n, std::span<const std::uint32_t> words) {
                 const Port& port = (is_out ? stage.out : stage.in)[p];
                 add(is_out, port, n, fields[is_out ? 1 : 0][p], values_of(port.like, widths, words));
               });
}

std::string jsonl_text(const JudgedStage& stage, const Config& config, const StagePackets& packets,
                       const VectorSource& source) {
  const Widths widths = derive_widths(config);
  std::string text =
      header_json(stage, config, widths, source).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  for_each_packet(stage, config, packets,
                  [&text](bool is_out, const Port& port, std::size_t n, const auto& fields, const auto& values) {
                    text += is_out ? R"({"dir":"out","packet":")" : R"({"dir":"in","packet":")";
                    text.append(port.name).append("\",\"n\":").append(std::to_string(n));
                    for (std::size_t i = 0; i < fields.size(); ++i) {
                      text.append(",\"").append(fields[i].name).append("\":\"0x");
                      text.append(hex_digits(values[i], fields[i].bits)).append(1, '"');
                    }
                    text += "}\n";
                  });
  return text;
}

std::string csv_text(const JudgedStage& stage, const Config& config, const StagePackets& packets,
                     const VectorSource& source) {
  const Widths widths = derive_widths(config);
  std::string text = std::string(kSchema) + "," + std::string(info(stage.stage).name) + "," + source.text +
                     (source.seed ? ",seed=" + std::to_string(*source.seed) : std::string()) +
                     "\nconfig,preset=" + config.preset;
  for (const Setting& setting : settings()) text += "," + std::string(setting.key) + "=" + get(config, setting);
  text += '\n';
  const auto add_fields = [&](const char* direction, const std::vector<Port>& ports) {
    for (const Port& port : ports) {
      text += std::string("fields,") + direction + "," + std::string(port.name);
      for (const FieldName& field : fields_of(port.like, widths))
        text += "," + field.name + ":" + std::to_string(field.bits) + (field.is_signed ? "s" : "");
      text += '\n';
    }
  };
  add_fields("in", stage.in);
  add_fields("out", stage.out);
  for_each_packet(stage, config, packets,
                  [&text](bool is_out, const Port& port, std::size_t n, const auto& fields, const auto& values) {
                    text.append(is_out ? "out," : "in,").append(port.name).append(",").append(std::to_string(n));
                    for (std::size_t i = 0; i < fields.size(); ++i)
                      text.append(",0x").append(hex_digits(values[i], fields[i].bits));
                    text += '\n';
                  });
  return text;
}

WrittenFile write_text(const std::string& path, const std::string& text) {
  write_text_file(path, text);
  return {path, text.size()};
}

/// The packed struct as in raster_pkg, the highest digit first.
std::string hex_text(const Port& port, const PacketList& list, const Widths& widths) {
  const int bits = bits_of(port.like, widths);
  std::string text;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const auto words = list[n];
    for (int low = (bits - 1) / 32 * 32; low >= 0; low -= 32)
      text += hex_digits(words[static_cast<std::size_t>(low / 32)], std::min(32, bits - low));
    text += '\n';
  }
  return text;
}

}  // namespace

std::vector<WrittenFile> write_vectors(const std::string& path, Format format, const JudgedStage& stage,
                                       const Config& config, const StagePackets& packets, const VectorSource& source) {
  if (format == Format::jsonl) return {write_text(path, jsonl_text(stage, config, packets, source))};
  if (format == Format::csv) return {write_text(path, csv_text(stage, config, packets, source))};
  const Widths widths = derive_widths(config);
  replay_stage(stage, config, packets, [](bool, std::size_t, std::size_t, std::span<const std::uint32_t>) {});
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError("-o: cannot make the folder '" + path + "'; choose another");
  std::vector<WrittenFile> written;
  const auto in_folder = [&path](std::string_view name) { return (std::filesystem::path(path) / name).string(); };
  const auto add = [&](const std::vector<Port>& ports, const std::vector<PacketList>& lists) {
    for (std::size_t p = 0; p < ports.size(); ++p)
      written.push_back(
          write_text(in_folder(std::string(ports[p].name) + ".hex"), hex_text(ports[p], lists[p], widths)));
  };
  add(stage.in, packets.in);
  add(stage.out, packets.out);
  written.push_back(write_text(
      in_folder("header.json"),
      header_json(stage, config, widths, source).dump(1, ' ', false, Json::error_handler_t::replace) + "\n"));
  return written;
}

}  // namespace halfplane::vectors
