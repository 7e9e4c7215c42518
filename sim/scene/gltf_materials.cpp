#include "sim/scene/gltf_materials.hpp"

#include <algorithm>
#include <cmath>

#include "model/capture/capture_textures.hpp"
#include "model/config.hpp"
#include "sim/scene/gltf_codecs.hpp"
#include "sim/scene/mesh_textures.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

/// `count` numbers of an optional list.
template <std::size_t count>
std::array<double, count> numbers_or(const JsonPlace& place, std::string_view key,
                                     std::array<double, count> otherwise) {
  const std::optional<JsonPlace> list = place.find(key);
  if (!list) return otherwise;
  if (list->size() != count) {
    list->fail(std::to_string(list->size()) + " numbers", "write " + std::to_string(count));
  }
  std::array<double, count> result{};
  for (std::size_t i = 0; i < count; ++i) result[i] = (*list)[i].number();
  return result;
}

// Maps OpenGL's codes to ours.
template <class Word, std::size_t count>
Word word_or(const JsonPlace& sampler, std::string_view key,
             const std::array<std::pair<std::uint64_t, Word>, count>& words, Word otherwise) {
  const std::optional<JsonPlace> code = sampler.find(key);
  if (!code) return otherwise;
  const auto found = std::ranges::find(words, code->whole(0xffff), &std::pair<std::uint64_t, Word>::first);
  if (found == words.end()) code->fail("no code of " + std::string(key), "see samplers in the glTF specification");
  return found->second;
}

constexpr std::array<std::pair<std::uint64_t, TextureMin>, 6> kMinCodes{{{9728, TextureMin::nearest},
                                                                         {9729, TextureMin::linear},
                                                                         {9984, TextureMin::nearest_mipmap_nearest},
                                                                         {9985, TextureMin::linear_mipmap_nearest},
                                                                         {9986, TextureMin::nearest_mipmap_linear},
                                                                         {9987, TextureMin::linear_mipmap_linear}}};
constexpr std::array<std::pair<std::uint64_t, TextureMag>, 2> kMagCodes{
    {{9728, TextureMag::nearest}, {9729, TextureMag::linear}}};
constexpr std::array<std::pair<std::uint64_t, TextureWrap>, 3> kWrapCodes{
    {{10497, TextureWrap::repeat}, {33071, TextureWrap::clamp}, {33648, TextureWrap::mirror}}};

// Filters not given in the file are implementation-defined: the best available.
MeshSampler read_sampler(const JsonPlace& place) {
  MeshSampler sampler;
  sampler.min = word_or(place, "minFilter", kMinCodes, sampler.min);
  sampler.mag = word_or(place, "magFilter", kMagCodes, sampler.mag);
  sampler.wrap = {word_or(place, "wrapS", kWrapCodes, TextureWrap::repeat),
                  word_or(place, "wrapT", kWrapCodes, TextureWrap::repeat)};
  return sampler;
}

// KHR_texture_transform: scaled, rotated, moved. Rotation is counter-clockwise with v down.
void read_transform(const JsonPlace& place, GltfMaterial& material) {
  const auto [offset_u, offset_v] = numbers_or<2>(place, "offset", {0, 0});
  const auto [scale_u, scale_v] = numbers_or<2>(place, "scale", {1, 1});
  const double angle = place.number_or("rotation", 0), c = std::cos(angle), s = std::sin(angle);
  material.uv_transform = {{{c * scale_u, s * scale_v, offset_u}, {-s * scale_u, c * scale_v, offset_v}}};
}

}  // namespace

MeshMaterial surface_of(const GltfMaterial& material) {
  // The lobe: Beckmann's roughness r^2 as an exponent n, and the height that keeps the energy of Blinn-Phong, faded out
  // for small n: there a highlight without the factor N.L would be a flat disc. A dielectric reflects 4 % at normal
  // incidence; a metal reflects its colour. A metal has no diffuse part, but the surroundings that it would mirror are
  // missing: half of its colour stands for them.
  const double alpha = std::max(material.roughness * material.roughness, 1e-3);
  const double n = std::clamp(2 / (alpha * alpha) - 2, 0.0, kMostShininess), height = (n + 8) / 8 * n / (n + 2);
  MeshMaterial surface;
  surface.shininess = n;
  surface.specular.fill(0.04 * (1 - material.metallic) * height);
  surface.mirrored = material.metallic * height;
  surface.diffuse = 1 - material.metallic / 2;
  surface.emission = material.emission;
  surface.is_two_sided = material.is_two_sided;
  return surface;
}

GltfMaterial GltfMaterials::of(const JsonPlace& primitive) const {
  GltfMaterial result;
  const std::optional<JsonPlace> index = primitive.find("material");
  if (!index) return result;
  const JsonPlace place = file_.follow(*index, "materials");
  result.is_two_sided = place.flag_or("doubleSided", false);
  result.is_lit = !place.extension("KHR_materials_unlit");
  const std::string alpha = place.text_or("alphaMode", "OPAQUE");
  if (alpha != "OPAQUE" && alpha != "MASK" && alpha != "BLEND")
    warn_("alphaMode " + in_quotes(alpha) + " is none of glTF 2.0: drawn opaque");
  result.alpha = alpha == "MASK" ? AlphaMode::mask : alpha == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
  result.alpha_cutoff = place.number_or("alphaCutoff", result.alpha_cutoff);
  result.emission = numbers_or<3>(place, "emissiveFactor", result.emission);
  for (double& channel : result.emission) channel = std::clamp(channel, 0.0, 1.0);
  for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
    if (place.find(key)) warn_("of the textures only those of base colours are shown");
  }
  if (place.find("emissiveTexture")) result.emission = {};  // the texture that limits the emission is not read
  if (const auto shading = place.find("pbrMetallicRoughness")) read_base_color(*shading, result);
  return result;
}

void GltfMaterials::read_base_color(const JsonPlace& shading, GltfMaterial& material) const {
  if (shading.find("metallicRoughnessTexture")) warn_("of the textures only those of base colours are shown");
  material.base = numbers_or<4>(shading, "baseColorFactor", material.base);
  for (double& channel : material.base) channel = std::clamp(channel, 0.0, 1.0);
  // With a texture for metal, most of the surface is not metal.
  const double metallic = shading.find("metallicRoughnessTexture") ? 0 : material.metallic;
  material.metallic = std::clamp(shading.number_or("metallicFactor", metallic), 0.0, 1.0);
  material.roughness = std::clamp(shading.number_or("roughnessFactor", material.roughness), 0.0, 1.0);
  const std::optional<JsonPlace> texture = shading.find("baseColorTexture");
  if (!texture) return;
  material.texture = texture->at("index");
  constexpr std::uint64_t kMostSets = 999;
  std::uint64_t set = texture->whole_or("texCoord", kMostSets, 0);
  if (const auto transform = texture->extension("KHR_texture_transform")) {
    read_transform(*transform, material);
    set = transform->whole_or("texCoord", kMostSets, set);
  }
  material.uv_set = "TEXCOORD_" + std::to_string(set);
}

std::optional<MeshSampler> GltfMaterials::sampler(const GltfMaterial& material) {
  if (!material.texture) return std::nullopt;
  const JsonPlace texture = file_.follow(*material.texture, "textures");
  MeshSampler sampler;
  if (const auto index = texture.find("sampler")) sampler = read_sampler(file_.follow(*index, "samplers"));
  const auto webp = can_read(GltfCodec::webp) ? texture.extension("EXT_texture_webp") : std::nullopt;
  const std::optional<JsonPlace> source = webp ? webp->find("source") : texture.find("source");
  const std::string kind = source ? file_.follow(*source, "images").text_or("mimeType", "image/png") : "";
  if (kind != "image/png" && kind != "image/jpeg" && (kind != "image/webp" || !can_read(GltfCodec::webp))) {
    warn_(std::string("textures that are neither PNG nor JPEG ") +
          (can_read(GltfCodec::webp) ? "nor WebP" : "(WebP: this build is without libwebp)") +
          " are not read: their base colours are shown without them");
    return std::nullopt;
  }
  sampler.texture = image(*source);
  add_mips_for(sampler.min, textures_[sampler.texture]);
  return sampler;
}

std::uint32_t GltfMaterials::image(const JsonPlace& index) {
  const std::size_t number = index.index(file_.count("images"), "images");
  if (const auto known = texture_of_image_.find(number); known != texture_of_image_.end()) return known->second;
  const JsonPlace place = file_.item("images", number);
  const std::string where = file_.name() + ": " + place.path();
  const std::optional<JsonPlace> uri = place.find("uri");
  const std::string beside = uri ? file_.resource(*uri) : "";
  const ByteSpan bytes = uri ? ByteSpan(reinterpret_cast<const std::uint8_t*>(beside.data()), beside.size())
                             : file_.view(file_.follow(place.at("bufferView"), "bufferViews"));
  const TexelImage image = is_webp(bytes)
                               ? decode_webp(bytes, where)
                               : read_image({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, where);
  const std::string name = place.text_or("name", uri && !uri->text().starts_with("data:") ? uri->text() : "");
  return texture_of_image_[number] = add_texture(textures_, image, name, where);
}

}  // namespace halfplane
