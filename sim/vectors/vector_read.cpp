#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "model/as_number.hpp"
#include "sim/config_file.hpp"
#include "sim/scene/text_cursor.hpp"
#include "sim/words.hpp"
#include "vector_file.hpp"

namespace halfplane::vectors {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The place of a message.
struct SourceLine {
  const std::string& path;
  std::size_t number = 0;
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(path + ":" + std::to_string(number) + ": " + what);
  }
};

/// The next line, if there is one. A file may be one endless line: a device, or not a file of vectors.
bool next_line(std::istream& in, std::string& text, const SourceLine& at) {
  constexpr std::size_t kLongest = std::size_t{1} << 20;  // bytes; a packet takes some thousand
  text.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (c == '\n') return true;
    if (text.size() == kLongest)
      at.fail("a line of more than " + std::to_string(kLongest) + " bytes; these are no vectors");
    text += static_cast<char>(c);
  }
  return !text.empty();
}

struct HexValue {
  std::uint64_t value = 0, undefined = 0;  ///< undefined bits are 0 in `value`
};

/// A hexadecimal number of at most `bits` bits, with 0x or without; x and z are digits whose bits are undefined.
HexValue parse_hex(std::string_view text, const FieldName& field, const SourceLine& at) {
  std::string_view digits = text;
  if (digits.starts_with("0x") || digits.starts_with("0X")) digits.remove_prefix(2);
  std::string known(digits), undefined(digits);
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const bool is_undefined = std::string_view("xXzZ").find(digits[i]) != std::string_view::npos;
    undefined[i] = is_undefined ? 'f' : '0';
    if (is_undefined) known[i] = '0';
  }
  const auto value = as_number<std::uint64_t>(known, 16), mask = as_number<std::uint64_t>(undefined, 16);
  if (!value || !mask)
    at.fail("'" + field.name + "' is " + in_quotes(text) + ", which is no hexadecimal number; give one as 0x1f");
  if (field.bits < 64 && *value >> field.bits != 0)
    at.fail("'" + field.name + "' has " + std::to_string(field.bits) + " bits, and " + in_quotes(text) +
            " needs more; give it in two's complement");
  return {*value, field.bits < 64 ? *mask & ((std::uint64_t{1} << field.bits) - 1) : *mask};
}

/// A header's text in messages stays on one line, and short.
void require_plain(std::string_view word, const SourceLine& at) {
  constexpr std::size_t kLongest = 256;  // bytes; far above any name and any value of a setting
  const bool is_plain = std::ranges::none_of(word, [](unsigned char c) { return c < ' ' || c == 0x7f; });
  if (word.size() > kLongest || !is_plain)
    at.fail("in the header, " + in_quotes(word) +
            " is no name and no value; keep the header that `halfplane vectors` wrote");
}

/// State of the reader.
class Reader {
 public:
  void begin(std::string_view stage, const std::map<std::string, std::string>& config, const SourceLine& at) {
    require_plain(stage, at);
    for (const auto& [key, value] : config) {
      require_plain(key, at);
      require_plain(value, at);
    }
    try {
      file_.stage = &judged_stage(stage);
      const auto preset_name = config.find("preset");
      file_.config = preset(preset_name == config.end() ? "embedded" : preset_name->second);
      for (const auto& [key, value] : config)
        if (key != "preset") set_by_key(file_.config, key, value);
      validate(file_.config);
      require_stage(*file_.stage, file_.config);
    } catch (const InputError& error) {
      at.fail(std::string("in the header, ") + error.what());
    }
    widths_ = derive_widths(file_.config);
    file_.packets = StagePackets(*file_.stage, widths_);
    for (const Port& port : file_.stage->in) in_.push_back(fields_of(port.like, widths_));
    for (const Port& port : file_.stage->out) out_.push_back(fields_of(port.like, widths_));
  }

  [[nodiscard]] bool has_begun() const { return file_.stage != nullptr; }

  struct Place {
    std::size_t port;
    bool is_out;
  };
  [[nodiscard]] Place place_of(std::string_view direction, std::string_view packet, const SourceLine& at) const {
    if (direction != "in" && direction != "out") at.fail("'dir' is " + in_quotes(direction) + "; give in or out");
    const bool is_out = direction == "out";
    const std::vector<Port>& ports = is_out ? file_.stage->out : file_.stage->in;
    std::string names;
    for (std::size_t p = 0; p < ports.size(); ++p) {
      if (ports[p].name == packet) return {p, is_out};
      names += (names.empty() ? "" : ", ") + std::string(ports[p].name);
    }
    at.fail(in_quotes(packet) + " is no packet that goes " + (is_out ? "out of " : "into ") +
            std::string(info(file_.stage->stage).name) + "; give one of " + names);
  }
  [[nodiscard]] const std::vector<FieldName>& fields(const Place& place) const {
    return place.is_out ? out_[place.port] : in_[place.port];
  }
  [[nodiscard]] PacketList& list(const Place& place) {
    return place.is_out ? file_.packets.out[place.port] : file_.packets.in[place.port];
  }
  /// Packets of a port are numbered from 0 on.
  void check_number(const Place& place, std::uint64_t number, const SourceLine& at) {
    if (number != list(place).size())
      at.fail("packet " + std::to_string(number) + " where " + std::to_string(list(place).size()) +
              " is due; give them in order, from 0");
  }

  /// Adds a packet. Inputs go to the specification, which is undefined for tiles or pixels outside the largest target;
  /// outputs are only compared, and may be arbitrarily wrong.
  void add(const Place& place, std::span<const HexValue> given, const SourceLine& at) {
    const auto& names = fields(place);
    std::vector<std::uint64_t> values, undefined;
    for (const HexValue& one : given) {
      values.push_back(one.value);
      undefined.push_back(one.undefined);
    }
    const auto first = std::ranges::find_if(undefined, [](std::uint64_t mask) { return mask != 0; });
    if (!place.is_out) {
      if (first != undefined.end())
        at.fail("'" + names[static_cast<std::size_t>(first - undefined.begin())].name +
                "' has undefined bits, and the specification takes none");
      if (const std::string fault = place_fault(names, values, file_.config, widths_); !fault.empty()) at.fail(fault);
    }
    list(place).push(words_from(names, values),
                     first == undefined.end() ? std::vector<std::uint32_t>() : words_from(names, undefined));
  }
  void add_words(const Place& place, std::span<const std::uint32_t> words, std::span<const std::uint32_t> undefined,
                 const SourceLine& at) {
    const Port& port = (place.is_out ? file_.stage->out : file_.stage->in)[place.port];
    const auto values = values_of(port.like, widths_, words), masks = values_of(port.like, widths_, undefined);
    std::vector<HexValue> given;
    for (std::size_t i = 0; i < values.size(); ++i) given.push_back({values[i], masks[i]});
    add(place, given, at);
  }

  VectorFile file_;

 private:
  Widths widths_;
  std::vector<std::vector<FieldName>> in_, out_;
};

void read_header(Reader& reader, const Json& header, const SourceLine& at) {
  if (!header.is_object() || !header.contains("schema") || header["schema"] != "halfplane.vectors/1")
    at.fail("the header is not that of vectors: \"schema\" must be \"halfplane.vectors/1\"");
  if (!header.contains("stage") || !header["stage"].is_string() || !header.contains("config") ||
      !header["config"].is_object())
    at.fail("the header lacks \"stage\" or \"config\"; keep the one that `halfplane vectors` wrote");
  std::map<std::string, std::string> config;
  for (const auto& [key, value] : header["config"].items())
    config[key] = value.is_string() ? value.get<std::string>() : value.dump();
  reader.begin(header["stage"].get<std::string>(), config, at);
  if (header.contains("source") && header["source"].is_string()) reader.file_.source.text = header["source"];
  if (header.contains("seed") && header["seed"].is_number_unsigned()) reader.file_.source.seed = header["seed"];
}

void read_jsonl_packet(Reader& reader, const Json& line, const SourceLine& at) {
  const auto word = [&](const char* key) {
    if (!line.contains(key) || !line[key].is_string()) at.fail(std::string("there is no \"") + key + "\"");
    return line[key].get<std::string>();
  };
  const Reader::Place place = reader.place_of(word("dir"), word("packet"), at);
  if (!line.contains("n") || !line["n"].is_number_unsigned()) at.fail("there is no \"n\", the packet's number");
  reader.check_number(place, line["n"].get<std::uint64_t>(), at);
  const auto& fields = reader.fields(place);
  std::vector<HexValue> values;
  for (const FieldName& field : fields) values.push_back(parse_hex(word(field.name.c_str()), field, at));
  if (line.size() != fields.size() + 3) {
    for (const auto& [key, value] : line.items())
      if (key != "dir" && key != "packet" && key != "n" &&
          std::ranges::find(fields, key, &FieldName::name) == fields.end())
        at.fail("no field is called " + in_quotes(key) + "; the header names them");
  }
  reader.add(place, values, at);
}

VectorFile read_jsonl(std::istream& in, const std::string& path) {
  Reader reader;
  std::string text;
  for (std::size_t number = 1; next_line(in, text, {path, number}); ++number) {
    const SourceLine at{path, number};
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Json line = Json::parse(text, nullptr, false);
    if (line.is_discarded() || !line.is_object()) at.fail("this is no JSON object; give one a line");
    reader.has_begun() ? read_jsonl_packet(reader, line, at) : read_header(reader, line, at);
  }
  if (!reader.has_begun()) throw InputError(path + ": the file is empty; give one that `halfplane vectors` wrote");
  return std::move(reader.file_);
}

void read_csv_row(Reader& reader, const std::vector<std::string>& cells, const SourceLine& at) {
  if (cells.size() < 3) at.fail("a row has at least dir, packet and n");
  const Reader::Place place = reader.place_of(cells[0], cells[1], at);
  const auto number = as_number<std::uint64_t>(cells[2]);
  if (!number) at.fail("the third cell is no number");
  reader.check_number(place, *number, at);
  const auto& fields = reader.fields(place);
  if (cells.size() != fields.size() + 3)
    at.fail(std::to_string(cells.size() - 3) + " values where " + std::to_string(fields.size()) + " are due");
  std::vector<HexValue> values;
  for (std::size_t i = 0; i < fields.size(); ++i) values.push_back(parse_hex(cells[i + 3], fields[i], at));
  reader.add(place, values, at);
}

/// From the first row: halfplane.vectors/1,STAGE,SOURCE,seed=N.
VectorSource csv_source(const std::vector<std::string>& cells) {
  VectorSource source;
  if (cells.size() > 2) source.text = cells[2];
  constexpr std::string_view kSeed = "seed=";
  if (cells.size() >= 4 && cells.back().starts_with(kSeed))
    source.seed = as_number<std::uint64_t>(cells.back().substr(kSeed.size()));
  return source;
}

VectorFile read_csv(std::istream& in, const std::string& path) {
  Reader reader;
  std::string text, stage;
  VectorSource source;
  for (std::size_t number = 1; next_line(in, text, {path, number}); ++number) {
    const SourceLine at{path, number};
    if (text.ends_with('\r')) text.pop_back();
    if (text.empty()) continue;
    const auto cells = split(text, ',');
    if (number == 1) {
      if (cells[0] != "halfplane.vectors/1" || cells.size() < 2)
        at.fail("these are no vectors: the first line must begin with halfplane.vectors/1,STAGE");
      stage = cells[1];
      source = csv_source(cells);
    } else if (cells[0] == "config") {
      if (reader.has_begun()) at.fail("a second line begins with config; a file has one");
      std::map<std::string, std::string> config;
      for (std::size_t i = 1; i < cells.size(); ++i) {
        const std::size_t equals = cells[i].find('=');
        if (equals == std::string::npos) at.fail(in_quotes(cells[i]) + " is no key=value");
        config[cells[i].substr(0, equals)] = cells[i].substr(equals + 1);
      }
      reader.begin(stage, config, at);
      reader.file_.source = source;
    } else if (cells[0] != "fields") {
      if (!reader.has_begun()) at.fail("a packet comes before the line that begins with config");
      read_csv_row(reader, cells, at);
    }
  }
  if (!reader.has_begun()) throw InputError(path + ": there is no line that begins with config");
  return std::move(reader.file_);
}

/// A packed packet, the highest digit first, with 0x or without; '_' and comments as in $readmemh.
void read_hex_line(Reader& reader, std::string text, int bits, const Reader::Place& place, const SourceLine& at) {
  text = text.substr(0, text.find("//"));
  std::erase_if(text, [](unsigned char c) { return c == '_' || std::isspace(c) != 0; });
  if (text.starts_with("0x") || text.starts_with("0X")) text.erase(0, 2);
  if (text.empty()) return;
  if (text.front() == '@') at.fail("addresses are not read; give the packets in order");
  std::vector<std::uint32_t> words(static_cast<std::size_t>((bits + 31) / 32)), undefined = words;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view digit(&text[text.size() - 1 - i], 1);
    const auto [value, mask] = parse_hex(digit, {"packet", 4, false}, at);
    const int low = static_cast<int>(4 * i);
    const bool fits = low < bits && (low + 4 <= bits || value >> (bits - low) == 0);
    if (!fits && value != 0) at.fail("a packet of " + std::to_string(bits) + " bits, and this line has more");
    if (low >= bits) continue;
    words[i / 8] |= static_cast<std::uint32_t>(value << 4 * (i % 8));
    undefined[i / 8] |= static_cast<std::uint32_t>((mask & (~0ULL >> (64 - std::min(4, bits - low)))) << 4 * (i % 8));
  }
  reader.add_words(place, words, undefined, at);
}

VectorFile read_hex(const std::string& folder, const FileSource& open, bool needs_in) {
  const std::string header_path = (fs::path(folder) / "header.json").string();
  const auto header_file = open(header_path);
  if (!header_file)
    throw InputError(header_path + ": there is no such file; give a folder that `halfplane vectors` wrote");
  Reader reader;
  const SourceLine first{header_path, 1};
  const Json header = Json::parse(*header_file, nullptr, false);
  if (header.is_discarded()) first.fail("this is no JSON");
  read_header(reader, header, first);
  VectorFile& file = reader.file_;
  const Widths widths = derive_widths(file.config);
  const auto read_ports = [&](const std::vector<Port>& ports, bool is_out) {
    for (std::size_t p = 0; p < ports.size(); ++p) {
      const std::string path = (fs::path(folder) / (std::string(ports[p].name) + ".hex")).string();
      const auto in = open(path);
      if (!in && !is_out && !needs_in) continue;
      if (!in) throw InputError(path + ": there is no such file; give one with a packet a line");
      std::string text;
      for (std::size_t number = 1; next_line(*in, text, {path, number}); ++number)
        read_hex_line(reader, text, bits_of(ports[p].like, widths), {p, is_out}, {path, number});
    }
  };
  read_ports(file.stage->in, false);
  read_ports(file.stage->out, true);
  return std::move(reader.file_);
}

}  // namespace

VectorFile read_vectors(const std::string& path, bool is_folder, const FileSource& open, bool needs_in) {
  if (is_folder) return read_hex(path, open, needs_in);
  const auto in = open(path);
  if (!in) throw InputError(path + ": there is no such file; give one that `halfplane vectors` wrote");
  return in->peek() == '{' ? read_jsonl(*in, path) : read_csv(*in, path);
}

VectorFile read_vectors(const std::string& path, bool needs_in) {
  std::error_code error;
  const auto open = [](const std::string& name) -> std::unique_ptr<std::istream> {
    auto file = std::make_unique<std::ifstream>(name);
    if (!*file) return nullptr;
    return file;
  };
  return read_vectors(path, fs::is_directory(path, error), open, needs_in);
}

}  // namespace halfplane::vectors
