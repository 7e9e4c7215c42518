#include "sim/scene/gltf_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/capture/capture_text.hpp"
#include "model/config.hpp"
#include "sim/scene/gltf_codecs.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {

// The parser of nlohmann-json keeps its own stack, so depth of nesting is no danger.
std::shared_ptr<const nlohmann::json> parse_json(std::string_view text, const std::string& file) {
  try {
    return std::make_shared<const nlohmann::json>(nlohmann::json::parse(text.begin(), text.end()));
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t read = std::min<std::size_t>(error.byte, text.size());
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(read), '\n');
    fail_at(file, static_cast<std::uint32_t>(lines + 1), "not JSON (at byte " + std::to_string(read) + ")",
            "export the file again, or mend the text there");
  } catch (const nlohmann::json::exception&) {  // the only other exception: a number such as 1e999
    throw InputError(file + ":1: a number beyond binary64; correct it");
  }
}

void JsonPlace::require_object() const {
  if (!value_->is_object()) fail("not an object", "write {...} there");
}

std::optional<JsonPlace> JsonPlace::find(std::string_view key) const {
  require_object();
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  return JsonPlace(*found, *file_, (path_.empty() ? "" : path_ + ".") + std::string(key));
}

std::optional<JsonPlace> JsonPlace::extension(std::string_view name) const {
  const std::optional<JsonPlace> all = find("extensions");
  return all ? all->find(name) : std::nullopt;
}

JsonPlace JsonPlace::at(std::string_view key) const {
  std::optional<JsonPlace> found = find(key);
  if (!found) fail("no " + std::string(key), "add it, or export the file again");
  return *found;
}

std::vector<std::string> JsonPlace::keys() const {
  require_object();
  std::vector<std::string> names;
  for (const auto& [name, member] : value_->items()) names.push_back(name);
  return names;
}

std::size_t JsonPlace::size() const {
  if (!value_->is_array()) fail("not a list", "write [...] there");
  return value_->size();
}

JsonPlace JsonPlace::operator[](std::size_t i) const {
  return {value_->at(i), *file_, path_ + "[" + std::to_string(i) + "]"};
}

double JsonPlace::number() const {
  if (!value_->is_number()) fail("not a number", "write one there");
  return value_->get<double>();  // finite: the parser refuses other numbers
}

std::uint64_t JsonPlace::whole(std::uint64_t most) const {
  const double value = number();
  // 2^53 bounds the integers that a double distinguishes; every `most` of ours is below it.
  const bool fits = value >= 0 && value <= 0x1p53 && value == std::floor(value);
  if (!fits || static_cast<std::uint64_t>(value) > most) {
    fail("not a whole number of 0..." + std::to_string(most), "correct it, or export the file again");
  }
  return static_cast<std::uint64_t>(value);
}

bool JsonPlace::is_text() const { return value_->is_string(); }

std::string JsonPlace::text() const {
  if (!is_text()) fail("not a string", "write \"...\" there");
  return value_->get<std::string>();
}

double JsonPlace::number_or(std::string_view key, double otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  return found ? found->number() : otherwise;
}

std::uint64_t JsonPlace::whole_or(std::string_view key, std::uint64_t most, std::uint64_t otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  return found ? found->whole(most) : otherwise;
}

std::string JsonPlace::text_or(std::string_view key, const std::string& otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  return found ? found->text() : otherwise;
}

bool JsonPlace::flag_or(std::string_view key, bool otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  if (!found) return otherwise;
  if (!found->value_->is_boolean()) found->fail("neither true nor false", "write one of them");
  return found->value_->get<bool>();
}

std::size_t JsonPlace::index(std::size_t count, std::string_view what) const {
  const std::uint64_t value = whole(0xffffffff);
  if (value >= count) {
    fail("index " + std::to_string(value) + " of " + std::to_string(count) + " " + std::string(what),
         "correct it, or export the file again");
  }
  return static_cast<std::size_t>(value);
}

void JsonPlace::fail(const std::string& what, const std::string& mend) const {
  // Keys come from our code, except for the names in `attributes`: printable() keeps the message at one line.
  throw InputError(*file_ + ": " + (path_.empty() ? "" : printable(path_) + ": ") + what + "; " + mend);
}
namespace {

// Quantization only allows more kinds of number; visibility and instances are read (gltf_nodes.cpp). The others concern
// features that are not read, or do not affect the picture.
constexpr std::array<std::string_view, 9> kKnownExtensions{
    "KHR_mesh_quantization", "KHR_animation_pointer", "KHR_xmp",
    "KHR_xmp_json_ld",       "MSFT_texture_dds",      "KHR_node_selectability",
    "KHR_node_hoverability", "KHR_node_visibility",   "EXT_mesh_gpu_instancing"};
// Material extensions read: base colour, sides, `unlit`; of textures the transform; of lights none.
constexpr std::array<std::string_view, 5> kKnownFamilies{"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                                         "KHR_lights_", "EXT_lights_"};
constexpr std::string_view kDraco = "KHR_draco_mesh_compression", kMeshopt = "EXT_meshopt_compression";
// Its base colour is only in the extension.
constexpr std::string_view kOtherBaseColor = "KHR_materials_pbrSpecularGlossiness";

bool concerns_what_is_drawn(std::string_view extension) {
  if (extension == kDraco) return !can_read(GltfCodec::draco);
  if (extension == kMeshopt) return !can_read(GltfCodec::meshopt);
  if (extension == kOtherBaseColor) return true;
  if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), extension) != kKnownExtensions.end()) return false;
  return std::none_of(kKnownFamilies.begin(), kKnownFamilies.end(),
                      [extension](std::string_view family) { return extension.starts_with(family); });
}

constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

// Four bytes, little-endian; at + 4 <= bytes.size().
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return word;
}

// %20 and its like; a % that starts no code is literal.
std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (text[i] == '%' && low >= 0) {
      result += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

// Whether it is the name of a file next to this one, and not a place on a disk or a network.
bool is_relative(const std::string& name) {
  return !name.empty() && name.front() != '/' && name.front() != '\\' && name.find(':') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

}  // namespace

std::optional<std::string> decode_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string result;
  result.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;  // bits not yet written, in the low `held` bits
  int held = 0;
  for (const char c : text) {
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z') {
      value = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      value = static_cast<std::uint32_t>(c - 'a' + 26);
    } else if (c >= '0' && c <= '9') {
      value = static_cast<std::uint32_t>(c - '0' + 52);
    } else if (c == '+' || c == '/') {
      value = c == '+' ? 62 : 63;
    } else {
      return std::nullopt;
    }
    bits = (bits << 6 | value) & 0xffff;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    result += static_cast<char>(bits >> held & 0xff);
  }
  return text.size() % 4 == 1 ? std::nullopt : std::optional(result);  // a single letter left holds no byte
}

std::string way_without(std::string_view extension) {
  if (extension == kDraco) return "unpack it with `gltf-transform cp IN.glb OUT.glb`, or export it without compression";
  if (extension == kMeshopt || extension == "KHR_meshopt_compression")
    return "unpack it with `gltfpack -noq -i IN.glb -o OUT.glb`, or export it without compression";
  return "export it without that extension";
}

GltfFile::GltfFile(std::string bytes, std::string name, BufferSource source)
    : bytes_(std::move(bytes)), name_(std::move(name)), source_(std::move(source)), text_(bytes_) {
  if (bytes_.size() >= 4 && word_at(bytes_, 0) == kMagic) split_glb();
  json_ = parse_json(text_, name_);
  check_head();
}

// Header: magic, version, length; then chunks of length, type, bytes: JSON first, BIN second, others are skipped.
void GltfFile::split_glb() {
  const auto refuse = [this](const std::string& what) {
    throw InputError(name_ + ": " + what + "; export the file again");
  };
  if (bytes_.size() < 20) refuse("a .glb that ends in its header");
  if (word_at(bytes_, 4) != 2) refuse("a .glb of version " + std::to_string(word_at(bytes_, 4)) + ", not 2");
  const std::size_t length = word_at(bytes_, 8);
  if (length > bytes_.size() || length < 20) {
    refuse("a .glb of " + std::to_string(length) + " bytes in a file of " + std::to_string(bytes_.size()));
  }
  const std::string_view all = std::string_view(bytes_).substr(0, length);
  for (std::size_t at = 12, number = 0; at + 8 <= length; ++number) {
    const std::size_t size = word_at(all, at);
    const std::uint32_t type = word_at(all, at + 4);
    if (size > length - at - 8) refuse("chunk " + std::to_string(number) + " goes past the end of the .glb");
    if (number == 0 && type != kJsonChunk) refuse("the first chunk of the .glb is not JSON");
    if (number == 0) text_ = all.substr(at + 8, size);
    if (number == 1 && type == kBinChunk) chunk_ = all.substr(at + 8, size);
    at += 8 + size;
  }
}

void GltfFile::check_head() const {
  const JsonPlace asset = root().at("asset");
  const std::string version = asset.at("version").text(), least = asset.text_or("minVersion", "2.0");
  if (version.substr(0, 2) != "2." || least != "2.0") {
    asset.fail("glTF of version " + in_quotes(version.substr(0, 2) == "2." ? least : version), "export it as glTF 2.0");
  }
  const std::optional<JsonPlace> required = root().find("extensionsRequired");
  for (std::size_t i = 0; required && i < required->size(); ++i) {
    const std::string extension = (*required)[i].text();
    if (concerns_what_is_drawn(extension))
      (*required)[i].fail("the file needs " + in_quotes(extension) + ", which is not read here",
                          way_without(extension));
  }
}

std::vector<std::string> GltfFile::passed_over() const {
  std::vector<std::string> result;
  const std::optional<JsonPlace> used = root().find("extensionsUsed");
  for (std::size_t i = 0; used && i < used->size(); ++i) {
    std::string extension = (*used)[i].text();
    if (concerns_what_is_drawn(extension)) result.push_back(std::move(extension));
  }
  return result;
}

std::size_t GltfFile::count(std::string_view list) const {
  const std::optional<JsonPlace> found = root().find(list);
  return found ? found->size() : 0;
}

const std::string& GltfFile::buffer(const JsonPlace& index) {
  const std::size_t number = index.index(count("buffers"), "buffers");
  const auto known = buffers_.find(number);
  if (known != buffers_.end()) return known->second;
  const JsonPlace place = item("buffers", number);
  const std::uint64_t length = place.at("byteLength").whole(std::uint64_t{1} << 40);
  const std::optional<JsonPlace> uri = place.find("uri");
  if (!uri && (number != 0 || !chunk_)) {
    place.fail("no uri, and no bytes for it in the file", "export the file again");
  }
  std::string data = uri ? resource(*uri) : std::string(*chunk_);
  if (data.size() < length) {
    place.fail("byteLength " + std::to_string(length) + ", but there are " + std::to_string(data.size()) + " bytes",
               "export the file again; this one is cut off");
  }
  data.resize(static_cast<std::size_t>(length));
  return buffers_.emplace(number, std::move(data)).first->second;
}

std::string GltfFile::resource(const JsonPlace& uri) const {
  const std::string text = uri.text();
  if (text.starts_with("data:")) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view head = std::string_view(text).substr(0, comma);
    std::optional<std::string> data;
    if (comma < text.size() && head.ends_with(";base64")) {
      data = decode_base64(std::string_view(text).substr(comma + 1));
    }
    if (!data) uri.fail("a data: URI that is not base64", "export the file again, or with a file beside it");
    return std::move(*data);
  }
  const std::string file = percent_decoded(text);
  if (!is_relative(file)) uri.fail(in_quotes(file) + " is no file beside this one", "give a relative name");
  std::optional<std::string> data = source_(file);
  if (!data) uri.fail(in_quotes(file) + " cannot be read", "put it beside the glTF file");
  return std::move(*data);
}

ByteSpan GltfFile::view(const JsonPlace& view_place) {
  const std::optional<JsonPlace> packed = view_place.extension(kMeshopt);
  if (packed && can_read(GltfCodec::meshopt)) return unpacked_view(view_place, *packed);
  if (packed) {  // optional for the file: then the same bytes are in its buffer
    const JsonPlace holder = follow(view_place.at("buffer"), "buffers");
    if (!holder.find("uri") && holder.extension(kMeshopt))
      view_place.fail("compressed with " + std::string(kMeshopt) + ", which this build does not read",
                      way_without(kMeshopt));
  }
  return packed_view(view_place);
}

ByteSpan GltfFile::unpacked_view(const JsonPlace& view_place, const JsonPlace& packed) {
  const auto known = unpacked_.find(view_place.path());
  const auto span = [](const std::string& bytes) {
    return ByteSpan(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  };
  if (known != unpacked_.end()) return span(known->second);
  constexpr std::uint64_t kMostCount = 0xffffffff, kMostStride = 256;
  const MeshoptStream stream{packed.at("mode").text(), packed.text_or("filter", "NONE"),
                             packed.at("count").whole(kMostCount), packed.at("byteStride").whole(kMostStride)};
  const std::uint64_t length = view_place.at("byteLength").whole(std::uint64_t{1} << 40);
  if (length < stream.count * stream.stride)
    view_place.fail("byteLength " + std::to_string(length) + " for " + std::to_string(stream.count) + " elements of " +
                        std::to_string(stream.stride) + " bytes",
                    "export the file again");
  std::string fault;
  std::optional<std::string> bytes = decode_meshopt(stream, packed_view(packed), fault);
  if (!bytes) packed.fail(fault, "export the file again");
  return span(unpacked_.emplace(view_place.path(), std::move(*bytes)).first->second);
}

void GltfFile::unpack(const JsonPlace& primitive) {
  const std::optional<JsonPlace> packed = primitive.extension(kDraco);
  if (!packed) return;
  const JsonPlace attributes = primitive.at("attributes");
  if (follow(attributes.at("POSITION"), "accessors").find("bufferView")) return;  // it is also there uncompressed
  if (!can_read(GltfCodec::draco))
    primitive.fail("compressed with " + std::string(kDraco) + ", which this build does not read", way_without(kDraco));
  const std::optional<JsonPlace> indices = primitive.find("indices");
  if (!indices || primitive.whole_or("mode", 6, 4) != 4)
    primitive.fail("compressed with Draco, and no indexed list of triangles", way_without(kDraco));
  constexpr std::uint64_t kMostId = 0xffffffff;
  std::vector<DracoAttribute> wanted;
  std::vector<JsonPlace> places;
  for (const std::string& name : packed->at("attributes").keys()) {
    const std::optional<JsonPlace> index = attributes.find(name);
    if (!index) continue;
    const GltfAccessor accessor = make_accessor(follow(*index, "accessors"));
    wanted.push_back({packed->at("attributes").at(name).whole(kMostId), accessor.component, accessor.width, {}});
    places.push_back(*index);
  }
  std::string fault;
  const std::optional<DracoMesh> mesh =
      decode_draco(packed_view(follow(packed->at("bufferView"), "bufferViews")), wanted, fault);
  if (!mesh) packed->fail(fault, "export the file again");
  for (std::size_t i = 0; i < wanted.size(); ++i)
    set_unpacked(places[i], wanted[i].component, mesh->vertices, std::move(wanted[i].bytes));
  set_unpacked(*indices, GltfComponent::u32, mesh->indices.size() / sizeof(std::uint32_t), mesh->indices);
}

/// Sets the accessor named by an index to the elements in `bytes`, packed, as numbers of that kind.
void GltfFile::set_unpacked(const JsonPlace& index, GltfComponent component, std::uint64_t elements,
                            std::string bytes) {
  const JsonPlace place = follow(index, "accessors");
  GltfAccessor made = make_accessor(place);
  if (made.count != elements)
    place.fail(std::to_string(made.count) + " elements, and " + std::to_string(elements) + " were compressed",
               "export the file again");
  const std::string& kept = unpacked_[place.path()] = std::move(bytes);
  made.component = component;
  made.stride = kept.size() / static_cast<std::size_t>(elements);
  made.bytes = ByteSpan(reinterpret_cast<const std::uint8_t*>(kept.data()), kept.size());
  accessors_[index.index(count("accessors"), "accessors")] = made;
}

ByteSpan GltfFile::packed_view(const JsonPlace& view_place) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 40;  // so that a sum of two is exact
  const std::string& data = buffer(view_place.at("buffer"));
  const std::uint64_t offset = view_place.whole_or("byteOffset", kMost, 0);
  const std::uint64_t length = view_place.at("byteLength").whole(kMost);
  if (offset + length > data.size()) {
    view_place.fail("bytes " + std::to_string(offset) + "..." + std::to_string(offset + length) + " of a buffer of " +
                        std::to_string(data.size()),
                    "correct byteOffset or byteLength");
  }
  return ByteSpan(reinterpret_cast<const std::uint8_t*>(data.data()), data.size())
      .subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

const GltfAccessor& GltfFile::accessor(const JsonPlace& index) {
  const std::size_t number = index.index(count("accessors"), "accessors");
  const auto known = accessors_.find(number);
  if (known != accessors_.end()) return known->second;
  return accessors_.emplace(number, make_accessor(item("accessors", number))).first->second;
}

}  // namespace halfplane
