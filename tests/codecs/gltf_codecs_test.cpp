// Compressed glTF files, written by the libraries themselves: the decoded data equal the original, and damage is one
// line of message.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>

#include "model/config.hpp"
#include "sim/scene/gltf.hpp"
#include "sim/scene/gltf_codecs.hpp"
#include "sim/scene/random.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;

// An octahedron, whose corners all numbers hold, in eight triangles.
constexpr std::array<std::array<float, 3>, 6> kCorners{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
constexpr std::array<std::uint32_t, 24> kFaces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
constexpr std::array<std::array<std::uint8_t, 4>, 6> kColors{
    {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 0, 255}, {0, 255, 255, 255}, {9, 99, 199, 51}}};

/// Triangles as the places of their corners, each turned so that its least corner comes first, in order.
using Triangles = std::vector<std::array<Vec3, 3>>;
Triangles in_order(Triangles triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}
Triangles octahedron() {
  Triangles triangles;
  for (std::size_t i = 0; i < kFaces.size(); i += 3) {
    auto& t = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) std::copy_n(kCorners[kFaces[i + k]].begin(), 3, t[k].begin());
  }
  return in_order(std::move(triangles));
}
Triangles triangles_of(const Mesh& mesh) {
  Triangles triangles;
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.vertices[t[0]].position, mesh.vertices[t[1]].position, mesh.vertices[t[2]].position});
  return in_order(std::move(triangles));
}

Mesh mesh_of(const std::string& text) {
  std::vector<std::string> warnings;
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  Mesh mesh = parse_gltf(text, "test.gltf", none, warnings).mesh;
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  return mesh;
}

// --- meshopt -----------------------------------------------------------------------------------------------------------

/// A library's output, in a buffer of the size that it asked for.
std::string packed(std::size_t bound, const std::function<std::size_t(unsigned char*, std::size_t)>& encode) {
  std::string bytes(bound, '\0');
  bytes.resize(encode(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size()));
  return bytes;
}

std::string packed_vertices(const void* vertices, std::size_t count, std::size_t stride) {
  return packed(meshopt_encodeVertexBufferBound(count, stride), [=](unsigned char* to, std::size_t size) {
    return meshopt_encodeVertexBuffer(to, size, vertices, count, stride);
  });
}

/// A file of compressed views: their unpacked bytes are in no file.
class MeshoptBuilder : public GltfBuilder {
 public:
  /// A view that is unpacked to count * stride bytes, and an accessor on it.
  std::size_t add(const std::string& data, const char* mode, const char* filter, std::size_t count, std::size_t stride,
                  int component, const char* type, bool is_normalized) {
    const std::size_t made = view(data);
    Json& place = json["bufferViews"][made];
    Json extension{{"buffer", 0},
                   {"byteOffset", place["byteOffset"]},
                   {"byteLength", data.size()},
                   {"mode", mode},
                   {"filter", filter},
                   {"count", count},
                   {"byteStride", stride}};
    place = {{"buffer", 1},
             {"byteOffset", fallback_},
             {"byteLength", count * stride},
             {"extensions", {{"EXT_meshopt_compression", extension}}}};
    if (std::string_view(mode) == "ATTRIBUTES") place["byteStride"] = stride;
    fallback_ += count * stride;
    Json accessor{{"bufferView", made}, {"componentType", component}, {"count", count}, {"type", type}};
    if (is_normalized) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return json["accessors"].size() - 1;
  }
  [[nodiscard]] std::string compressed() const {
    Json whole = Json::parse(text());
    whole["extensionsUsed"] = whole["extensionsRequired"] = {"EXT_meshopt_compression"};
    whole["buffers"].push_back(
        {{"byteLength", fallback_}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    return whole.dump();
  }

 private:
  std::size_t fallback_ = 0;  // bytes
};

std::size_t add_positions(MeshoptBuilder& b) {
  return b.add(packed_vertices(kCorners.data(), 6, 12), "ATTRIBUTES", "NONE", 6, 12, GltfBuilder::f32, "VEC3", false);
}

TEST(GltfCodecs, MeshoptVerticesAndBothKindsOfIndices) {
  for (const bool is_sequence : {false, true})
    for (const std::size_t bytes : {2U, 4U}) {
      MeshoptBuilder b;
      Json& primitive = b.mesh(add_positions(b));
      const std::string indices =
          is_sequence ? packed(meshopt_encodeIndexSequenceBound(24, 6),
                               [](unsigned char* to, std::size_t size) {
                                 return meshopt_encodeIndexSequence(to, size, kFaces.data(), 24);
                               })
                      : packed(meshopt_encodeIndexBufferBound(24, 6), [](unsigned char* to, std::size_t size) {
                          return meshopt_encodeIndexBuffer(to, size, kFaces.data(), 24);
                        });
      primitive["indices"] = b.add(indices, is_sequence ? "INDICES" : "TRIANGLES", "NONE", 24, bytes,
                                   bytes == 2 ? GltfBuilder::u16 : GltfBuilder::u32, "SCALAR", false);
      EXPECT_EQ(triangles_of(mesh_of(b.compressed())), octahedron()) << is_sequence << ", " << bytes << " bytes";
    }
}

/// Numbers as the extension defines them, worked out by hand.
TEST(GltfCodecs, MeshoptFiltersGiveWhatTheExtensionSays) {
  MeshoptBuilder b;
  // 2^e m: exponents of 8 bits above mantissas of 24. 6/4, -1, 3 * 2.
  const auto number = [](int e, int m) {
    return static_cast<std::uint32_t>(e & 255) << 24 | (static_cast<std::uint32_t>(m) & 0xffffffU);
  };
  const std::array<std::uint32_t, 9> places{number(-2, 6), number(0, -1), number(1, 3), number(0, 0), number(0, 0),
                                            number(0, 0),  number(3, 1),  number(0, 0), number(0, 0)};
  Json& primitive = b.mesh(b.add(packed_vertices(places.data(), 3, 12), "ATTRIBUTES", "EXPONENTIAL", 3, 12,
                                 GltfBuilder::f32, "VEC3", false));
  // x, y and the value of one: z is 1 - |x| - |y|.
  const std::array<std::int8_t, 12> normals{0, 0, 127, 0, 127, 0, 127, 0, 0, -127, 127, 0};
  primitive["attributes"]["NORMAL"] =
      b.add(packed_vertices(normals.data(), 3, 4), "ATTRIBUTES", "OCTAHEDRAL", 3, 4, GltfBuilder::i8, "VEC3", true);
  const Mesh mesh = mesh_of(b.compressed());
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0].position, (Vec3{1.5, -1, 6}));
  EXPECT_EQ(mesh.vertices[2].position, (Vec3{8, 0, 0}));
  EXPECT_EQ(mesh.vertices[0].normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh.vertices[1].normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.vertices[2].normal, (Vec3{0, -1, 0}));
}

// --- Draco -------------------------------------------------------------------------------------------------------------

/// The octahedron with a colour at each corner.
std::string draco_file(bool has_fallback = false) {
  draco::TriangleSoupMeshBuilder soup;
  soup.Start(8);
  const int position = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
            color = soup.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (std::uint32_t f = 0; f < 8; ++f) {
    const auto corner = [f](std::size_t k) { return kFaces[std::size_t{3} * f + k]; };
    soup.SetAttributeValuesForFace(position, draco::FaceIndex(f), kCorners[corner(0)].data(),
                                   kCorners[corner(1)].data(), kCorners[corner(2)].data());
    soup.SetAttributeValuesForFace(color, draco::FaceIndex(f), kColors[corner(0)].data(), kColors[corner(1)].data(),
                                   kColors[corner(2)].data());
  }
  const std::unique_ptr<draco::Mesh> mesh = soup.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  GltfBuilder b;
  const std::size_t view = b.view(std::string(buffer.data(), buffer.size()));
  const auto accessor = [&b](std::size_t count, int component, const char* type) {
    b.json["accessors"].push_back({{"componentType", component}, {"count", count}, {"type", type}});
    return b.json["accessors"].size() - 1;
  };
  Json& primitive = b.mesh(accessor(6, GltfBuilder::f32, "VEC3"));
  const std::size_t colors = accessor(6, GltfBuilder::u8, "VEC4");
  b.json["accessors"][colors]["normalized"] = true;
  primitive["attributes"]["COLOR_0"] = colors;
  primitive["indices"] = accessor(24, GltfBuilder::u16, "SCALAR");
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view},
      {"attributes",
       {{"POSITION", mesh->attribute(position)->unique_id()}, {"COLOR_0", mesh->attribute(color)->unique_id()}}}};
  if (has_fallback)
    b.json["accessors"][0]["bufferView"] = b.view(GltfBuilder::packed(GltfBuilder::f32, std::vector<double>(18, 2)));
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return b.text();
}

TEST(GltfCodecs, DracoGivesTheTrianglesAndTheColoursOfTheirCorners) {
  const Mesh mesh = mesh_of(draco_file());
  EXPECT_EQ(triangles_of(mesh), octahedron());
  ASSERT_EQ(mesh.vertices.size(), 6u);
  for (const MeshVertex& vertex : mesh.vertices) {
    const auto found = std::ranges::find_if(kCorners, [&](const auto& corner) {
      return std::equal(corner.begin(), corner.end(), vertex.position.begin());
    });
    ASSERT_NE(found, kCorners.end());
    const auto& color = kColors[static_cast<std::size_t>(found - kCorners.begin())];
    EXPECT_NEAR(vertex.rgba[3], color[3], 1e-9);
    for (std::size_t c = 0; c < 3; ++c)
      if (color[c] == 0 || color[c] == 255) {  // black and white are the same in both curves
        EXPECT_NEAR(vertex.rgba[c], color[c], 1e-9);
      }
  }
}

TEST(GltfCodecs, DracoThatIsNoListOfTrianglesOrOfOtherCountsIsRefused) {
  const auto refusal = [](const std::function<void(Json&)>& damage) -> std::string {
    Json file = Json::parse(draco_file());
    damage(file);
    try {
      (void)mesh_of(file.dump());
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal([](Json&) {}), "");
  const auto expect = [&](const std::function<void(Json&)>& damage, const std::string& part) {
    EXPECT_NE(refusal(damage).find(part), std::string::npos) << refusal(damage);
  };
  expect([](Json& f) { f["meshes"][0]["primitives"][0]["mode"] = 5; }, "no indexed list of triangles; unpack it");
  expect([](Json& f) { f["meshes"][0]["primitives"][0].erase("indices"); }, "no indexed list of triangles");
  expect([](Json& f) { f["accessors"][0]["count"] = 7; }, "accessors[0]: 7 elements, and 6 were compressed");
  expect([](Json& f) { f["accessors"][2]["count"] = 21; }, "21 elements, and 24 were compressed");
  expect(
      [](Json& f) {
        f["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 77;
      },
      "has no attribute 77");
}

/// Damage somewhere in a file's one buffer: one line, or a mesh, and nothing else.
void expect_damage_is_told(const std::string& text, std::uint64_t seed) {
  Json file = Json::parse(text);
  const std::string head = "data:application/octet-stream;base64,";
  const std::string bytes = *decode_base64(file["buffers"][0]["uri"].get<std::string>().substr(head.size()));
  Random random(seed);
  int refused = 0;
  for (int n = 0; n < 300; ++n) {
    std::string damaged = bytes;
    for (int i = 0; i <= n % 4; ++i) damaged[random.next() % bytes.size()] = static_cast<char>(random.next());
    file["buffers"][0]["uri"] = head + test::encode_base64(damaged);
    try {
      std::vector<std::string> warnings;
      (void)parse_gltf(
          file.dump(), "test.gltf", [](const std::string&) { return std::nullopt; }, warnings);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, 20) << "of 300";
}

TEST(GltfCodecs, DamageIsToldInALine) {
  expect_damage_is_told(draco_file(), 1);
  MeshoptBuilder b;
  Json& primitive = b.mesh(add_positions(b));
  primitive["indices"] = b.add(packed(meshopt_encodeIndexBufferBound(24, 6),
                                      [](unsigned char* to, std::size_t size) {
                                        return meshopt_encodeIndexBuffer(to, size, kFaces.data(), 24);
                                      }),
                               "TRIANGLES", "NONE", 24, 2, GltfBuilder::u16, "SCALAR", false);
  expect_damage_is_told(b.compressed(), 2);
  // Faults that the library does not check.
  const auto refusal = [&](const char* key, const Json& value) -> std::string {
    Json file = Json::parse(b.compressed());
    file["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    try {
      (void)mesh_of(file.dump());
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(refusal("mode", "VERTICES").find("none of ATTRIBUTES, TRIANGLES and INDICES"), std::string::npos);
  EXPECT_NE(refusal("byteStride", 10).find("a byteStride of 10"), std::string::npos);
  EXPECT_NE(refusal("byteStride", 0).find("a byteStride of 0"), std::string::npos);
  EXPECT_NE(refusal("filter", "QUATERNION").find("filter 'QUATERNION' for elements of 12 bytes"), std::string::npos);
  EXPECT_NE(refusal("count", 0xffffffffU).find("byteLength 72 for 4294967295 elements"), std::string::npos);
  EXPECT_NE(refusal("byteLength", 3).find("damaged"), std::string::npos);
}

TEST(GltfCodecs, WhatStandsInTheFileAsItWasIsTakenFromThere) {
  const Mesh mesh = mesh_of(draco_file(true));
  for (const MeshVertex& vertex : mesh.vertices) EXPECT_EQ(vertex.position, (Vec3{2, 2, 2}));
}

// --- WebP --------------------------------------------------------------------------------------------------------------

TEST(GltfCodecs, WebpTexelsAreThoseThatWereCompressed) {
  constexpr int kWidth = 5, kHeight = 3;
  std::array<std::uint8_t, std::size_t{4} * kWidth * kHeight> texels{};
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(17 * i);
  std::uint8_t* made = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(texels.data(), kWidth, kHeight, 4 * kWidth, &made);
  const std::string image(reinterpret_cast<const char*>(made), size);
  WebPFree(made);
  for (const bool is_extension : {true, false}) {
    GltfBuilder b;
    Json& primitive = b.mesh(b.accessor(GltfBuilder::f32, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
    primitive["attributes"]["TEXCOORD_0"] = b.accessor(GltfBuilder::f32, 2, {0, 0, 1, 0, 0, 1});
    primitive["material"] = 0;
    b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    b.json["images"] = {{{"bufferView", b.view("no image")}, {"mimeType", "image/png"}},
                        {{"bufferView", b.view(image)}, {"mimeType", "image/webp"}}};
    b.json["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
    if (!is_extension) b.json["textures"] = {{{"source", 1}}};
    const Mesh mesh = mesh_of(b.text());
    ASSERT_EQ(mesh.textures.size(), 1u);
    const Texture& texture = mesh.textures[0];
    ASSERT_EQ(texture.width(), kWidth);
    ASSERT_EQ(texture.height(), kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t at = 4 * static_cast<std::size_t>(y * kWidth + x);
        EXPECT_EQ(texture.texel(0, x, y), (Texel{texels[at], texels[at + 1], texels[at + 2], 255})) << x << ", " << y;
      }
    b.json["images"][1]["bufferView"] = b.view(image.substr(0, image.size() / 2));
    EXPECT_THROW((void)mesh_of(b.text()), InputError);
  }
}

}  // namespace
}  // namespace halfplane
