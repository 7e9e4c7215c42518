// Textures of glTF and OBJ files: the source of their texels, their lookup, the messages for bad ones.
#include "sim/scene/mesh_textures.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <sstream>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "model/engines/functional.hpp"
#include "model/golden/golden.hpp"
#include "sim/scene/gltf.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/obj.hpp"
#include "sim/show/image/png.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::mesh_textures_test {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;
using Files = std::map<std::string, std::string>;

const std::string kMapped =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.25 0.75\n"
    "usemtl m\nf 1/1 2/2 3/3 4/4\n";

// 3 x 2 texels, all different.
Texel texel_of(int x, int y) { return {static_cast<std::uint8_t>(50 * x), static_cast<std::uint8_t>(90 * y), 7, 255}; }

std::string png() {
  Picture picture(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) set_pixel(picture, x, y, {texel_of(x, y)[0], texel_of(x, y)[1], texel_of(x, y)[2]});
  const std::vector<std::uint8_t> bytes = encode_png(picture);
  return {bytes.begin(), bytes.end()};
}

struct Read {
  Mesh mesh;
  std::vector<std::string> warnings;
};

BufferSource source_of(const Files& files) {
  return [&files](const std::string& name) {
    const auto found = files.find(name);
    return found == files.end() ? std::nullopt : std::optional(found->second);
  };
}

Read read_gltf(const GltfBuilder& builder, const Files& files = {}) {
  Read result;
  result.mesh = parse_gltf(builder.text(), "test.gltf", source_of(files), result.warnings).mesh;
  return result;
}

Read read_obj(const std::string& text, const Files& files) {
  Read result;
  result.mesh = parse_obj(text, "test.obj", source_of(files), result.warnings);
  return result;
}

// A triangle with uv in two sets; its material has the image `images[0]`, which is in the file.
GltfBuilder textured() {
  GltfBuilder builder = test::one_triangle();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = builder.accessor(GltfBuilder::f32, 2, {0, 0, 1, 0, 0.25, 0.5});
  primitive["attributes"]["TEXCOORD_1"] = builder.accessor(GltfBuilder::u8, 2, {255, 0, 0, 255, 51, 102}, true);
  primitive["material"] = 0;
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["images"] = {{{"bufferView", builder.view(png())}, {"mimeType", "image/png"}}};
  return builder;
}

Json& base_texture(GltfBuilder& builder) {
  return builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
}

void expect_texels(const Texture& texture, bool is_turned) {
  ASSERT_EQ(texture.width(), 3);
  ASSERT_EQ(texture.height(), 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) EXPECT_EQ(texture.texel(0, x, is_turned ? 1 - y : y), texel_of(x, y)) << x << ' ' << y;
}

std::string refusal(const GltfBuilder& builder, const Files& files = {}) {
  try {
    (void)read_gltf(builder, files);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GltfTexture, AnImageInTheBufferInADataUriAndInAFileAreTheSame) {
  GltfBuilder builder = textured();
  const Mesh inside = read_gltf(builder).mesh;
  ASSERT_EQ(inside.textures.size(), 1u);
  expect_texels(inside.textures[0], false);
  builder.json["images"] = {{{"uri", "data:image/png;base64," + test::encode_base64(png())}}};
  EXPECT_EQ(read_gltf(builder).mesh.textures, inside.textures);
  builder.json["images"] = {{{"uri", "a%20b/c.png"}}};
  const Mesh beside = read_gltf(builder, {{"a b/c.png", png()}}).mesh;
  EXPECT_EQ(beside.textures[0].level, inside.textures[0].level);
  EXPECT_EQ(beside.textures[0].name, "a_20b_c.png");
}

TEST(GltfTexture, ATexturedTriangleIsThePictureOfACapture) {
  GltfBuilder builder = textured();
  builder.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", Json::object()}};
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 1, 0.5};
  const CameraRequest camera = parse_camera("eye=0,0,2;target=0,0,0;ortho=2;near=1;far=3");
  std::string capture = "halfplane 1\ntarget 96 96\ntexture t inline rgba8888 3 2 mips box_linear\ntexels ";
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      char code[9];
      std::snprintf(code, sizeof code, "%02x%02x%02x%02x", texel_of(x, y)[0], texel_of(x, y)[1], texel_of(x, y)[2],
                    255);
      capture += code;
    }
  capture +=
      "\nclear color 20 20 30 255 depth 1\nspace clip\nstate cull back\nstate texture t\n"
      "state texture_min linear_mipmap_linear\nstate texture_mag linear\n"
      "v 0 0 0 1 255 0 255 127.5 0 0\nv 1 0 0 1 255 0 255 127.5 1 0\nv 0 1 0 1 255 0 255 127.5 0.25 0.5\nt 0 1 2\n";
  const Config config = preset("embedded");
  const auto picture = [&config](const Scene& scene) { return render_functional(scene, config, {}).frame.color; };
  EXPECT_EQ(picture(mesh_scene(read_gltf(builder).mesh, camera, 96, 96)), picture(read_capture(capture, "test.hpt")));
}

TEST(GltfTexture, ASamplerSaysHowAndWithoutOneItRepeatsAndFiltersItsBest) {
  const MeshSampler best = *read_gltf(textured()).mesh.parts[0].sampler;
  EXPECT_EQ(best, (MeshSampler{0, TextureMin::linear_mipmap_linear, TextureMag::linear, {}}));
  const std::pair<int, TextureMin> min_codes[]{{9728, TextureMin::nearest},
                                               {9729, TextureMin::linear},
                                               {9984, TextureMin::nearest_mipmap_nearest},
                                               {9985, TextureMin::linear_mipmap_nearest},
                                               {9986, TextureMin::nearest_mipmap_linear},
                                               {9987, TextureMin::linear_mipmap_linear}};
  GltfBuilder builder = textured();
  builder.json["textures"][0]["sampler"] = 0;
  for (const auto& [code, min] : min_codes) {
    builder.json["samplers"] = {{{"minFilter", code}, {"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}};
    const Mesh mesh = read_gltf(builder).mesh;
    EXPECT_EQ(*mesh.parts[0].sampler,
              (MeshSampler{0, min, TextureMag::nearest, {TextureWrap::clamp, TextureWrap::mirror}}));
    EXPECT_EQ(mesh.textures[0].mips, code < 9984 ? Mips::none : Mips::box_linear) << code;
    EXPECT_EQ(mesh.textures[0].last_level(), code < 9984 ? 0 : 1) << code;
  }
}

TEST(GltfTexture, AnImageThatSeveralMaterialsShowIsKeptOnce) {
  GltfBuilder builder = textured();
  Json& primitive = builder.json["meshes"][0]["primitives"].emplace_back(builder.json["meshes"][0]["primitives"][0]);
  primitive["material"] = 1;
  builder.json["materials"][1] = builder.json["materials"][0];
  builder.json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
  builder.json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
  builder.json["samplers"] = {{{"minFilter", 9728}}};
  const Mesh mesh = read_gltf(builder).mesh;
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].mips, Mips::box_linear);  // the second one asks for them
  const Scene scene = mesh_scene(mesh, {}, 32, 32);
  EXPECT_EQ(scene.states.size(), 3u);  // the clear's, and one for each sampler
  EXPECT_EQ(scene.states[1].texture_min, TextureMin::nearest);
  EXPECT_EQ(scene.states[2].texture_min, TextureMin::linear_mipmap_linear);
}

TEST(GltfTexture, TheTransformScalesTurnsCounterclockwiseAndMovesInThatOrder) {
  GltfBuilder builder = textured();
  base_texture(builder)["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.25, -1}}, {"scale", {2, 4}}, {"rotation", std::numbers::pi / 2}};
  const Mesh mesh = read_gltf(builder).mesh;  // v points down: (1, 0) turns to (0, -1)
  EXPECT_NEAR(mesh.vertices[1].u, 0.25, 1e-15);
  EXPECT_NEAR(mesh.vertices[1].v, -3, 1e-15);
  EXPECT_NEAR(mesh.vertices[2].u, 0.25 + 4 * 0.5, 1e-15);
  EXPECT_NEAR(mesh.vertices[2].v, -1 - 2 * 0.25, 1e-15);
}

TEST(GltfTexture, TheTextureOrItsTransformChoosesTheSetOfCoordinates) {
  GltfBuilder builder = textured();
  EXPECT_EQ(read_gltf(builder).mesh.vertices[2].u, 0.25);
  base_texture(builder)["texCoord"] = 1;
  EXPECT_EQ(read_gltf(builder).mesh.vertices[2].u, 51.0 / 255);
  base_texture(builder)["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}};
  EXPECT_EQ(read_gltf(builder).mesh.vertices[2].u, 0.25);
}

TEST(GltfTexture, WhatCannotBeShownIsShownWithoutItsTextureAndSaidSo) {
  const auto expect_plain = [](const GltfBuilder& builder, const char* warning) {
    const Read read = read_gltf(builder);
    ASSERT_EQ(read.warnings.size(), 1u) << warning;
    EXPECT_NE(read.warnings[0].find(warning), std::string::npos) << read.warnings[0];
    EXPECT_FALSE(read.mesh.parts[0].sampler);
    EXPECT_TRUE(read.mesh.textures.empty());
  };
  GltfBuilder builder = textured();
  base_texture(builder)["texCoord"] = 2;
  expect_plain(builder, "without TEXCOORD_2");
  builder = textured();
  builder.json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  expect_plain(builder, "neither PNG nor JPEG");
  builder = textured();
  builder.json["images"][0]["mimeType"] = "image/ktx2";
  expect_plain(builder, "neither PNG nor JPEG");
}

TEST(GltfTexture, TheAlphaModeIsKept) {
  GltfBuilder builder = textured();
  EXPECT_EQ(read_gltf(builder).mesh.parts[0].alpha, AlphaMode::opaque);
  builder.json["materials"][0]["alphaMode"] = "MASK";
  builder.json["materials"][0]["alphaCutoff"] = 0.25;
  const Read masked = read_gltf(builder);
  EXPECT_EQ(masked.mesh.parts[0].alpha, AlphaMode::mask);
  EXPECT_EQ(masked.mesh.parts[0].alpha_cutoff, 0.25);
  EXPECT_TRUE(masked.warnings.empty());
  builder.json["materials"][0]["alphaMode"] = "BLEND";
  EXPECT_EQ(read_gltf(builder).mesh.parts[0].alpha, AlphaMode::blend);
}

TEST(GltfTexture, WhatIsBrokenIsRefusedWithItsPlace) {
  struct Damage {
    const char* pointer;
    const char* value;
    const char* message;
  };
  const Damage damages[]{
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "1",
       "baseColorTexture.index: index 1 of 1 textures"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture", "{}", "baseColorTexture: no index"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "-1", "texCoord: not a whole number"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions",
       "{\"KHR_texture_transform\": {\"offset\": [1]}}", ": 1 numbers; write 2"},
      {"/textures/0/source", "5", "textures[0].source: index 5 of 1 images"},
      {"/textures/0/sampler", "0", "textures[0].sampler: index 0 of 0 samplers"},
      {"/images/0/bufferView", "99", "images[0].bufferView: index 99 of"},
      {"/images/0/bufferView", "0", "images[0]: no PNG, JPEG, BMP or TGA image"},
      {"/images/0", "{}", "images[0]: no bufferView"},
      {"/images/0", "{\"uri\": \"gone.png\"}", "images[0].uri: 'gone.png' cannot be read"},
      {"/images/0", "{\"uri\": \"/etc/passwd\"}", "images[0].uri: '/etc/passwd' is no file beside this one"},
      {"/images/0", "{\"uri\": \"data:image/png,abc\"}", "images[0].uri: a data: URI that is not base64"},
  };
  for (const Damage& damage : damages) {
    GltfBuilder builder = textured();
    builder.json[Json::json_pointer(damage.pointer)] = Json::parse(damage.value);
    const std::string message = refusal(builder);
    EXPECT_EQ(message.find("test.gltf: "), 0u) << damage.message;
    EXPECT_NE(message.find(damage.message), std::string::npos) << "wanted: " << damage.message << "; got: " << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  GltfBuilder builder = textured();
  builder.json["textures"][0]["sampler"] = 0;
  builder.json["samplers"] = {{{"wrapS", 7}}};
  EXPECT_NE(refusal(builder).find("samplers[0].wrapS: no code of wrapS"), std::string::npos) << refusal(builder);
  builder = textured();
  const std::string cut = png().substr(0, 60);
  builder.json["images"] = {{{"uri", "cut.png"}}};
  EXPECT_NE(refusal(builder, {{"cut.png", cut}}).find("images[0]: the image is damaged"), std::string::npos);
  builder = textured();
  base_texture(builder)["extensions"]["KHR_texture_transform"] = {{"scale", {1e31, 1}}};
  EXPECT_NE(refusal(builder).find("beyond 1e30 on its texture"), std::string::npos) << refusal(builder);
}

TEST(MeshTextures, NamesAreWordsOfACaptureAndUnlikeEachOther) {
  std::vector<Texture> textures;
  const TexelImage image{1, 1, {Texel{}}};
  for (const char* name : {"a b#c", "a b#c", "", "off", "x\ny"}) (void)add_texture(textures, image, name, "here");
  const char* const expected[]{"a_b_c", "a_b_c-2", "texture", "texture-2", "x_y"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(textures[i].name, expected[i]);
}

TEST(MeshTextures, NoMoreTexelsAreKeptThanAMachineHolds) {
  std::vector<Texture> textures;
  const TexelImage image = pattern_image(TexturePattern::grid, 8, 8);
  (void)add_texture(textures, image, "a", "here", 128);
  (void)add_texture(textures, image, "b", "here", 128);
  EXPECT_THROW((void)add_texture(textures, image, "c", "here", 128), InputError);
  EXPECT_EQ(textures.size(), 2u);
}

TEST(ObjTexture, AnImageIsTurnedOverBecauseVCountsFromTheBottom) {
  const Mesh mesh = read_obj(kMapped, {{"a.mtl", "newmtl m\nmap_Kd x.png\n"}, {"x.png", png()}}).mesh;
  ASSERT_EQ(mesh.textures.size(), 1u);
  expect_texels(mesh.textures[0], true);
  EXPECT_EQ(mesh.textures[0].name, "x");
  EXPECT_EQ(*mesh.parts[0].sampler, MeshSampler{});
  EXPECT_EQ(mesh.vertices[3].u, 0.25);
  EXPECT_EQ(mesh.vertices[3].v, 0.75);
}

TEST(ObjTexture, KdTimesTheImageAndWithoutKdTheImageAlone) {
  const auto rgba = [](const std::string& library) {
    return read_obj(kMapped, {{"a.mtl", library}, {"x.png", png()}}).mesh.vertices[0].rgba;
  };
  EXPECT_EQ(rgba("newmtl m\nmap_Kd x.png\n"), (std::array<double, 4>{255, 255, 255, 255}));
  EXPECT_EQ(rgba("newmtl m\nmap_Kd x.png\nKd 1 0 0.2\n"), (std::array<double, 4>{255, 0, 51, 255}));
  EXPECT_EQ(rgba("newmtl m\nKd 1 0 0.2\nmap_Kd x.png\n"), (std::array<double, 4>{255, 0, 51, 255}));
  EXPECT_EQ(rgba("newmtl m\n"), (std::array<double, 4>{204, 204, 204, 255}));
}

TEST(ObjTexture, OptionsScaleMoveAndClampAndNamesMayHoldBlanks) {
  const std::string library = "newmtl m\nmap_Kd -blendu on -s 2 4 1 -mm 0 1 -o 0.5 -clamp on -t 1 1 1 my pic.png\n";
  const Mesh mesh = read_obj(kMapped, {{"a.mtl", library}, {"my pic.png", png()}}).mesh;
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].name, "my_pic");
  EXPECT_EQ(mesh.parts[0].sampler->wrap, (std::array{TextureWrap::clamp, TextureWrap::clamp}));
  EXPECT_EQ(mesh.vertices[3].u, 0.25 * 2 + 0.5);
  EXPECT_EQ(mesh.vertices[3].v, 0.75 * 4);
}

TEST(ObjTexture, AnImageIsBesideTheLibraryThatNamesIt) {
  const std::string text = "mtllib lib\\a.mtl" + kMapped.substr(kMapped.find('\n'));
  const Mesh mesh = read_obj(text, {{"lib\\a.mtl", "newmtl m\nmap_Kd tex\\x.png\n"}, {"lib/tex/x.png", png()}}).mesh;
  EXPECT_EQ(mesh.textures.size(), 1u);
}

TEST(ObjTexture, OnlyFacesWithAPlaceOnTheImageShowIt) {
  const std::string text = kMapped + "f 1 2 3\nf 1/1 3/3 4/4\n";
  const Mesh mesh = read_obj(text, {{"a.mtl", "newmtl m\nmap_Kd x.png\n"}, {"x.png", png()}}).mesh;
  ASSERT_EQ(mesh.parts.size(), 3u);
  EXPECT_TRUE(mesh.parts[0].sampler);
  EXPECT_FALSE(mesh.parts[1].sampler);
  EXPECT_TRUE(mesh.parts[2].sampler);
  EXPECT_EQ(mesh.textures.size(), 1u);
}

TEST(ObjTexture, AnImageThatCannotBeReadIsAWarningWithTheLibrarysLine) {
  const std::string library = "newmtl m\nmap_Kd x.tga\n";
  for (const Files& files : {Files{{"a.mtl", library}}, Files{{"a.mtl", library}, {"x.tga", "text"}}}) {
    const Read read = read_obj(kMapped + "f 1/1 3/3 4/4\n", files);
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_EQ(read.warnings[0].find("a.mtl:2: map_Kd 'x.tga': "), 0u) << read.warnings[0];
    EXPECT_FALSE(read.mesh.parts[0].sampler);
  }
  for (const char* damaged :
       {"newmtl m\nmap_Kd -s x.png\n", "newmtl m\nmap_Kd -clamp on\n", "map_Kd x.png\nnewmtl m\n"}) {
    const Read read = read_obj(kMapped + "f 1/1 3/3 4/4\n", {{"a.mtl", damaged}});
    ASSERT_EQ(read.warnings.size(), 1u) << damaged;
    EXPECT_NE(read.warnings[0].find("; the line is passed over"), std::string::npos) << read.warnings[0];
  }
}

TEST(MeshTextures, ACaptureOfATexturedMeshReadsBackAsTheSameScene) {
  const std::string library = "newmtl m\nmap_Kd -s 3 3 x.png\nnewmtl n\nmap_Kd -clamp on y.png\n";
  const std::string text = kMapped + "o second\nusemtl n\nf 3/3 2/2 1/1\n";
  const Files files{{"a.mtl", library}, {"x.png", png()}, {"y.png", png()}};
  const Scene scene = mesh_scene(read_obj(text, files).mesh, {}, 64, 48);
  ASSERT_EQ(scene.textures.size(), 2u);
  std::ostringstream capture;
  write_capture(scene, capture);
  EXPECT_TRUE(same_scene(read_capture(capture.str(), "test.hpt"), scene));
}

// The golden's homogeneous rasterizer cuts nothing.
TEST(MeshTextures, ATriangleThatIsClippedKeepsItsPlaceOnTheTexture) {
  Mesh floor;
  floor.lit = false;
  floor.objects = {"floor"};
  for (const auto& [x, z] : {std::pair{-20.0, 20.0}, {20.0, 20.0}, {0.0, -30.0}}) {
    MeshVertex& v = floor.vertices.emplace_back();
    v.position = {x, 0, z};
    v.u = x / 40 + 0.5;
    v.v = z / 64 + 0.5;
  }
  floor.triangles = {{0, 1, 2}};
  floor.textures.push_back(
      make_texture("g", pattern_image(TexturePattern::gradient, 256, 256), TextureFormat::rgba8888, Mips::none));
  MeshPart& part = floor.parts.emplace_back();
  part.count = 1;
  part.sampler = MeshSampler{0, TextureMin::linear, TextureMag::linear, {TextureWrap::clamp, TextureWrap::clamp}};
  const CameraRequest camera = parse_camera("eye=0,2,6;target=0,0,-4;near=0.5;far=60");
  const Scene scene = mesh_scene(floor, camera, 160, 120);
  const Config config = preset("full");
  RenderOptions render_options;
  render_options.want_count = true;
  const Rendering drawn = render_functional(scene, config, render_options);
  EXPECT_EQ(drawn.counters.clipped, 1u);
  golden::Options options;
  options.clipping = Clipping::homogeneous;
  const golden::Image image = golden::render(scene, config, options);
  std::size_t compared = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const auto p = static_cast<std::size_t>(y * 160 + x);
      if (image.count[p] == 0 || drawn.count[p] == 0) continue;
      ++compared;
      for (int c = 0; c < 2; ++c)  // a texel is a code: its bound, the weights' 1.5 LSB and a snap of 1/256 pixel
        ASSERT_NEAR(golden::stored_channel(drawn.frame.color[drawn.frame.at(x, y)], config.color_format, c),
                    image.color[p][static_cast<std::size_t>(c)], 2.5)
            << x << ' ' << y << " channel " << c;
    }
  EXPECT_GT(compared, 5000u);
}

}  // namespace
}  // namespace halfplane::mesh_textures_test
