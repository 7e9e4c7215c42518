// Small glTF files for tests, in both containers.
#pragma once

#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace halfplane::test {

/// RFC 4648, with padding.
inline std::string encode_base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      bits = bits << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      result += at + i <= bytes.size() ? kLetters[bits >> (18 - 6 * i) & 63] : '=';
    }
  }
  return result;
}

/// A file under construction: `json` is there to be changed at will, `bytes` is its one buffer.
class GltfBuilder {
 public:
  using Json = nlohmann::json;

  /// Component types of the format.
  enum Component { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

  Json json = {{"asset", {{"version", "2.0"}}}, {"bufferViews", Json::array()}, {"accessors", Json::array()}};
  std::string bytes;

  /// The numbers as they lie in a buffer.
  static std::string packed(Component component, const std::vector<double>& values) {
    std::string result;
    for (const double value : values) {
      const auto bits = component == f32 ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                         : static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
      const int size = component <= u8 ? 1 : component <= u16 ? 2 : 4;
      for (int i = 0; i < size; ++i) result += static_cast<char>(bits >> (8 * i) & 0xff);
    }
    return result;
  }

  /// A new buffer view; its number.
  std::size_t view(const std::string& data) {
    while (bytes.size() % 4 != 0) bytes += '\0';
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
    bytes += data;
    return json["bufferViews"].size() - 1;
  }

  /// A new accessor on a view of its own; its number.
  std::size_t accessor(Component component, std::size_t width, const std::vector<double>& values,
                       bool normalized = false) {
    const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    Json made{{"bufferView", view(packed(component, values))},
              {"componentType", component},
              {"count", values.size() / width},
              {"type", types[width - 1]}};
    if (normalized) made["normalized"] = true;
    json["accessors"].push_back(made);
    return json["accessors"].size() - 1;
  }

  /// A node at the root of scene 0 with a new mesh of one primitive; returns the primitive.
  Json& mesh(std::size_t position, const Json& node = Json::object()) {
    json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", position}}}}}}});
    Json placed = node;
    placed["mesh"] = json["meshes"].size() - 1;
    root(placed);
    return json["meshes"].back()["primitives"][0];
  }

  /// A node at the root of scene 0; its number.
  std::size_t root(const Json& node) {
    json["nodes"].push_back(node);
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
    return json["nodes"].size() - 1;
  }

  /// As .gltf, the buffer in a data: URI.
  [[nodiscard]] std::string text() const {
    return with_uri("data:application/octet-stream;base64," + encode_base64(bytes));
  }

  /// As .gltf, the buffer where `uri` says.
  [[nodiscard]] std::string with_uri(const std::string& uri) const {
    Json whole = json;
    if (!bytes.empty()) whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
    return whole.dump();
  }

  /// As .glb.
  [[nodiscard]] std::string glb() const {
    Json whole = json;
    if (!bytes.empty()) whole["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string text = whole.dump(), data = bytes;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t value) { return packed(u32, {static_cast<double>(value)}); };
    std::string chunks = word(text.size()) + "JSON" + text;
    if (!bytes.empty()) chunks += word(data.size()) + std::string("BIN\0", 4) + data;
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
  }
};

/// One white triangle in the plane z = 0.
inline GltfBuilder one_triangle() {
  GltfBuilder builder;
  builder.mesh(builder.accessor(GltfBuilder::f32, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
  return builder;
}

}  // namespace halfplane::test
