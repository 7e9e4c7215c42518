#include "sim/scene/obj.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>

#include "model/capture/capture_textures.hpp"
#include "model/config.hpp"
#include "sim/scene/mesh_textures.hpp"
#include "sim/scene/obj_text.hpp"
#include "sim/scene/polygon.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr std::uint32_t kMadeNormal = 0x80000000;  // marks the number of a computed normal

// The key of corners that share a vertex. Computed normals of a flat face belong to it.
struct CornerKey {
  std::uint32_t position = 0, uv = 0, normal = 0, material = 0;
  bool operator==(const CornerKey&) const = default;
};

struct CornerHash {
  std::size_t operator()(const CornerKey& key) const {
    std::uint64_t hash = (static_cast<std::uint64_t>(key.position) << 32 | key.normal) * 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ (hash >> 29) ^ (static_cast<std::uint64_t>(key.uv) << 32 | key.material)) * 0xbf58476d1ce4e5b9ULL;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

class MeshBuilder {
 public:
  MeshBuilder(const ObjText& in, const MaterialSource& source, std::vector<std::string>& warnings)
      : in_(in), source_(source), warnings_(warnings) {}

  Mesh run() {
    if (in_.faces.empty() && in_.lines.empty()) {
      throw InputError(
          in_.file + ":1: no faces (f lines), lines or points, so nothing to draw; export the model as a polygon mesh");
    }
    vertex_of_.reserve(in_.positions.size() * 2);
    choose_colors();
    for (const ObjFace& face : in_.faces) add_face(face);
    for (const ObjLine& line : in_.lines) add_line(line);
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
      if ((normal_of_[i] & kMadeNormal) == 0) continue;
      mesh_.vertices[i].normal = normalized(made_normals_[normal_of_[i] & ~kMadeNormal]);
    }
    return std::move(mesh_);
  }

 private:
  void choose_colors() {
    for (const auto& color : in_.colors) {
      for (const double value : color) color_scale_ = value > 1 ? 1 : color_scale_;  // the file counts up to 255
    }
    const MtlMaterial plain{.rgba = {204, 204, 204, 255}};  // no material: a light grey
    for (const std::string& name : in_.material_names) {
      auto found = in_.materials.find(name);
      if (found == in_.materials.end()) found = in_.materials.find(without_comment(name));
      materials_.push_back(found == in_.materials.end() ? plain : found->second);
      material_known_.push_back(found != in_.materials.end() || name.empty());
    }
    texture_of_material_.resize(materials_.size());
    mesh_.materials.clear();
    for (const MtlMaterial& material : materials_) {
      MeshMaterial& surface = mesh_.materials.emplace_back(material.surface);
      // Without an exponent the highlight would fill the whole lit half.
      if (!material.has_highlight || surface.shininess == 0) surface.specular = {};
    }
    // Faces whose corners have colours show these, and only other faces are lit by our light.
    const bool are_all_colored =
        std::ranges::all_of(in_.faces, [this](const ObjFace& face) { return is_colored(face); });
    mesh_.lit = !are_all_colored || in_.faces.empty();
    if (!mesh_.lit || in_.colors.empty()) return;
    shown_as_is_ = static_cast<std::uint32_t>(mesh_.materials.size());
    for (std::size_t i = 0; i < materials_.size(); ++i) {
      mesh_.materials.push_back(mesh_.materials[i]);
      mesh_.materials.back().has_header_light = false;
    }
  }

  [[nodiscard]] bool has_color(const ObjCorner& corner) const {
    const auto position = static_cast<std::size_t>(corner.position);
    return position < in_.colors.size() && in_.colors[position][0] >= 0;
  }
  [[nodiscard]] bool is_colored(const auto& element) const {
    return std::ranges::all_of(std::span(in_.corners).subspan(element.first, element.count),
                               [this](const ObjCorner& corner) { return has_color(corner); });
  }

  void require_positions(const auto& element) const {
    for (const ObjCorner& corner : std::span(in_.corners).subspan(element.first, element.count)) {
      if (corner.position < static_cast<std::int64_t>(in_.positions.size())) continue;
      fail_at(in_.file, element.line,
              "v index " + std::to_string(corner.position + 1) + " of " + std::to_string(in_.positions.size()),
              "correct the line, or add the missing v lines");
    }
  }

  void warn_of_material(const auto& element) {
    if (material_known_[element.material]) return;
    material_known_[element.material] = true;  // one warning per name
    warnings_.once("material " + in_.material_names[element.material],
                   in_.file + ":" + std::to_string(element.line) + ": no material " +
                       in_quotes(in_.material_names[element.material]) + "; the default colour is used");
  }

  // A corner with its valid indices: an index of a missing vt or vn is a warning.
  ObjCorner present(const ObjFace& face, ObjCorner corner) {
    const auto check = [&](std::int64_t& index, std::size_t count, const char* what) {
      if (index < static_cast<std::int64_t>(count)) return;
      warnings_.once(what, in_.file + ":" + std::to_string(face.line) + ": " + what + " index " +
                               std::to_string(index + 1) + " of " + std::to_string(count) + "; it is taken as missing");
      index = kNoIndex;
    };
    check(corner.uv, in_.uvs.size(), "vt");
    check(corner.normal, in_.normals.size(), "vn");
    if (corner.normal != kNoIndex && in_.normals[static_cast<std::size_t>(corner.normal)] == Vec3{})
      corner.normal = kNoIndex;
    return corner;
  }

  // Checks the corners, gives them normals, splits the polygon.
  void add_face(const ObjFace& face) {
    require_positions(face);
    places_.clear();
    corners_.clear();
    for (std::size_t i = face.first; i < face.first + face.count; ++i) {
      corners_.push_back(present(face, in_.corners[i]));
      places_.push_back(in_.positions[static_cast<std::size_t>(corners_.back().position)]);
    }
    warn_of_material(face);
    split_.clear();
    if (!triangulate_polygon(places_, split_)) {
      fail_at(in_.file, face.line, "a concave polygon of " + std::to_string(face.count) + " corners",
              "split it into polygons of at most " + std::to_string(kLargestConcavePolygon));
    }
    open_part(face);
    vertices_.clear();
    const bool shows_colors = is_colored(face);
    for (const ObjCorner& corner : corners_)
      vertices_.push_back(vertex(corner, made_normal(face, corner), face.material, shows_colors));
    add_angles();
    for (const auto& triangle : split_) {
      mesh_.triangles.push_back({vertices_[triangle[0]], vertices_[triangle[1]], vertices_[triangle[2]]});
      ++mesh_.parts.back().count;
    }
    ++face_number_;
  }

  // Unlit: it has no normals.
  void add_line(const ObjLine& line) {
    require_positions(line);
    warn_of_material(line);
    const Topology topology = line.is_points ? Topology::points : Topology::line_strip;
    const std::uint32_t object = object_of(line.object);
    const AlphaMode alpha = materials_[line.material].rgba[3] < 255 ? AlphaMode::blend : AlphaMode::opaque;
    const bool is_next = !mesh_.parts.empty() && mesh_.parts.back().object == object &&
                         mesh_.parts.back().topology == topology && mesh_.parts.back().alpha == alpha;
    if (!is_next) {
      mesh_.parts.push_back({object, mesh_.indices.size(), 0, line.line});
      mesh_.parts.back().topology = topology;
      mesh_.parts.back().alpha = alpha;
    } else if (!line.is_points) {
      mesh_.indices.push_back(kRestart);
    }
    const bool shows_colors = is_colored(line);
    if (!no_normal_) {
      no_normal_ = static_cast<std::uint32_t>(made_normals_.size());
      made_normals_.push_back({});
    }
    for (std::size_t i = line.first; i < line.first + line.count; ++i) {
      ObjCorner corner = in_.corners[i];
      corner.uv = kNoIndex;
      mesh_.indices.push_back(vertex(corner, *no_normal_ | kMadeNormal, line.material, shows_colors));
    }
    mesh_.parts.back().count = mesh_.indices.size() - mesh_.parts.back().first;
  }

  // Only objects with something to draw enter the mesh.
  std::uint32_t object_of(std::uint32_t object) {
    if (object_number_.empty()) object_number_.assign(in_.object_names.size(), kUnused);
    if (object_number_[object] == kUnused) {
      object_number_[object] = static_cast<std::uint32_t>(mesh_.objects.size());
      mesh_.objects.push_back(in_.object_names[object]);
    }
    return object_number_[object];
  }

  void open_part(const ObjFace& face) {
    const std::optional<MeshSampler> sampler = sampler_of(face);
    const AlphaMode alpha = alpha_of(face, sampler);
    const std::uint32_t object = object_of(face.object);
    if (!mesh_.parts.empty() && mesh_.parts.back().object == object && mesh_.parts.back().sampler == sampler &&
        mesh_.parts.back().alpha == alpha)
      return;
    mesh_.parts.push_back({object, mesh_.triangles.size(), 0, face.line});
    mesh_.parts.back().sampler = sampler;
    mesh_.parts.back().alpha = alpha;
  }

  // d below 1 blends; so does a map_d, unless it only cuts out.
  AlphaMode alpha_of(const ObjFace& face, const std::optional<MeshSampler>& sampler) {
    const double opacity = materials_[face.material].rgba[3];
    if (opacity == 0)
      warnings_.once("opacity", in_.file + ":" + std::to_string(face.line) + ": material " +
                                    in_quotes(in_.material_names[face.material]) +
                                    " has opacity 0: nothing of it is seen");
    if (opacity < 255) return AlphaMode::blend;
    if (!sampler || !materials_[face.material].opacity_map) return AlphaMode::opaque;
    return texture_alpha_[sampler->texture];
  }

  // The sampler of a face's texture; none without one, or if a corner has no texture coordinate.
  std::optional<MeshSampler> sampler_of(const ObjFace& face) {
    const MtlMaterial& material = materials_[face.material];
    if (!material.texture && !material.opacity_map) return std::nullopt;
    if (std::ranges::find(corners_, kNoIndex, &ObjCorner::uv) != corners_.end()) return std::nullopt;
    auto& texture = texture_of_material_[face.material];
    if (!texture) texture = texture_of(material);
    if (!*texture) return std::nullopt;
    MeshSampler sampler{.texture = **texture};
    const TextureWrap wrap = map_of(material).wrap;
    sampler.wrap = {wrap, wrap};
    return sampler;
  }

  // Materials that name the same files share a texture.
  std::optional<std::uint32_t> texture_of(const MtlMaterial& material) {
    const auto name = [](const std::optional<MtlTexture>& map) { return map ? map->file : ""; };
    const auto [place, is_new] = texture_of_files_.try_emplace({name(material.texture), name(material.opacity_map)});
    if (is_new) place->second = load_texture(material);
    return place->second;
  }

  static const MtlTexture& map_of(const MtlMaterial& material) {
    return material.texture ? *material.texture : *material.opacity_map;
  }

  // An unreadable image is a warning, as for a library.
  std::optional<TexelImage> load_image(const MtlTexture& map, const std::string& key, const std::string& else_shown) {
    const std::string what = map.place + ": " + key + " " + in_quotes(map.file);
    std::optional<std::string> bytes = source_(map.file);
    if (!bytes) bytes = source_(without_comment(map.file));
    try {
      if (!bytes) throw InputError(what + ": there is no such file");
      return read_image(*bytes, what);
    } catch (const InputError& error) {
      warnings_.once("image " + map.place, std::string(error.what()) + "; " + else_shown);
      return std::nullopt;
    }
  }

  std::optional<std::uint32_t> load_texture(const MtlMaterial& material) {
    std::optional<TexelImage> image;
    if (material.texture) image = load_image(*material.texture, "map_Kd", "the colour is shown alone");
    AlphaMode alpha = AlphaMode::opaque;
    if (material.opacity_map) {
      const auto opacity = load_image(*material.opacity_map, "map_d", "it is drawn opaque");
      if (opacity && !image) {
        image = TexelImage{opacity->width, opacity->height, {}};
        image->texel.assign(opacity->texel.size(), {255, 255, 255, 255});
      }
      if (opacity) alpha = lay_over(*opacity, *image);
    }
    if (!image) return std::nullopt;
    for (int top = 0, bottom = image->height - 1; top < bottom; ++top, --bottom) {  // v counts from the bottom
      const auto row = [&image](int y) { return image->texel.begin() + std::ptrdiff_t{y} * image->width; };
      std::swap_ranges(row(top), row(top + 1), row(bottom));
    }
    const MtlTexture& map = map_of(material);
    const std::uint32_t texture = add_texture(mesh_.textures, *image, std::filesystem::path(map.file).stem().string(),
                                              map.place + ": " + in_quotes(map.file));
    add_mips_for(MeshSampler{}.min, mesh_.textures[texture]);
    texture_alpha_.resize(mesh_.textures.size(), AlphaMode::opaque);
    texture_alpha_[texture] = alpha;
    return texture;
  }

  // A map_d becomes the alpha of the image: its own alpha if it has one, else its red; the nearest texel where sizes differ.
  static AlphaMode lay_over(const TexelImage& opacity, TexelImage& image) {
    const bool has_alpha = std::ranges::any_of(opacity.texel, [](const auto& texel) { return texel[3] < 255; });
    bool cuts_out = true;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const int from_x = x * opacity.width / image.width, from_y = y * opacity.height / image.height;
        const auto& texel = opacity.texel[static_cast<std::size_t>(from_y * opacity.width + from_x)];
        const std::uint8_t alpha = texel[has_alpha ? 3 : 0];
        image.texel[static_cast<std::size_t>(y * image.width + x)][3] = alpha;
        cuts_out = cuts_out && (alpha == 0 || alpha == 255);
      }
    return cuts_out ? AlphaMode::mask : AlphaMode::blend;
  }

  // The mesh vertex of a corner: an existing one if everything agrees.
  std::uint32_t vertex(const ObjCorner& corner, std::uint32_t normal, std::uint32_t material, bool shows_colors) {
    const auto position = static_cast<std::uint32_t>(corner.position);
    const std::uint32_t surface = shows_colors ? material + shown_as_is_ : material;
    const CornerKey key{position, static_cast<std::uint32_t>(corner.uv), normal, surface};
    const auto [place, added] = vertex_of_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (!added) return place->second;
    MeshVertex made;
    made.position = in_.positions[position];
    if ((normal & kMadeNormal) == 0) made.normal = normalized(in_.normals[normal]);
    if (corner.uv != kNoIndex) {
      const auto& [u, v] = in_.uvs[static_cast<std::size_t>(corner.uv)];
      const MtlMaterial& of = materials_[material];
      const MtlTexture* const map = of.texture || of.opacity_map ? &map_of(of) : nullptr;
      made.u = map != nullptr ? u * map->scale[0] + map->offset[0] : u;
      made.v = map != nullptr ? v * map->scale[1] + map->offset[1] : v;
    }
    made.rgba = shows_colors ? own_color(position) : materials_[material].rgba;
    made.material = surface;
    mesh_.vertices.push_back(made);
    normal_of_.push_back(normal);
    return place->second;
  }

  std::array<double, 4> own_color(std::uint32_t position) const {
    std::array<double, 4> rgba{255, 255, 255, 255};
    for (std::size_t i = 0; i < 4; ++i) {
      const double value = in_.colors[position][i];
      if (value >= 0) rgba[i] = std::min(value * color_scale_, 255.0);
    }
    return rgba;
  }

  // The file's normal, or one computed normal for each position and smoothing group; for each position and face when
  // flat.
  std::uint32_t made_normal(const ObjFace& face, const ObjCorner& corner) {
    if (corner.normal != kNoIndex) return static_cast<std::uint32_t>(corner.normal);
    const auto position = static_cast<std::uint32_t>(corner.position);
    const bool flat = face.smoothing == 0;
    const CornerKey key{position, flat, flat ? face_number_ : face.smoothing, 0};
    const auto [place, added] = normal_at_.try_emplace(key, static_cast<std::uint32_t>(made_normals_.size()));
    if (added) made_normals_.push_back({});
    return place->second | kMadeNormal;
  }

  // Adds the direction of each new triangle to the computed normals of its corners, weighted by the angle there, so
  // that the split of a polygon is not visible.
  void add_angles() {
    for (const auto& triangle : split_) {
      const std::array<Vec3, 3> p{places_[triangle[0]], places_[triangle[1]], places_[triangle[2]]};
      const Vec3 direction = normalized(cross(subtract(p[1], p[0]), subtract(p[2], p[0])));
      if (direction == Vec3{}) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t normal = normal_of_[vertices_[triangle[i]]];
        if ((normal & kMadeNormal) == 0) continue;
        const Vec3 a = subtract(p[(i + 1) % 3], p[i]), b = subtract(p[(i + 2) % 3], p[i]);
        const double angle = std::atan2(length(cross(a, b)), dot(a, b));
        Vec3& sum = made_normals_[normal & ~kMadeNormal];
        sum = add(sum, scaled(direction, angle));
      }
    }
  }

  static constexpr std::uint32_t kUnused = ~0U;
  const ObjText& in_;
  const MaterialSource& source_;
  Warnings warnings_;
  Mesh mesh_;
  std::unordered_map<CornerKey, std::uint32_t, CornerHash> vertex_of_, normal_at_;
  std::vector<std::uint32_t> normal_of_;  // for each mesh vertex
  std::vector<Vec3> made_normals_;
  std::vector<MtlMaterial> materials_;  // for each of in_.material_names
  std::vector<bool> material_known_;
  std::map<std::pair<std::string, std::string>, std::optional<std::uint32_t>> texture_of_files_;
  std::vector<std::optional<std::optional<std::uint32_t>>> texture_of_material_;  // none: not searched yet
  std::vector<AlphaMode> texture_alpha_;                                          // for textures with a map_d
  std::optional<std::uint32_t> no_normal_;
  std::uint32_t shown_as_is_ = 0;  // added to the material number of a coloured face
  std::vector<std::uint32_t> object_number_;
  double color_scale_ = 255;
  std::uint32_t face_number_ = 0;
  std::vector<Vec3> places_;  // of the current face, like the next three members
  std::vector<ObjCorner> corners_;
  std::vector<std::uint32_t> vertices_;
  std::vector<std::array<std::uint32_t, 3>> split_;
};

}  // namespace

Mesh parse_obj(std::string_view text, const std::string& file, const MaterialSource& materials,
               std::vector<std::string>& warnings) {
  const ObjText parsed = parse_obj_text(text, file, materials, warnings);
  constexpr std::size_t kMost = 0x7fffffff;  // numbers of vertices and normals keep one bit free
  if (std::max({parsed.positions.size(), parsed.normals.size(), parsed.corners.size()}) > kMost) {
    throw InputError(file + ":1: more than 2^31 entries; split the file");
  }
  return MeshBuilder(parsed, materials, warnings).run();
}

Mesh read_obj_file(const std::string& path, std::vector<std::string>& warnings) {
  const std::optional<std::string> text = read_regular_file(path);
  if (!text) throw InputError(path + ": cannot be read as a file; check the name and its permissions");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const auto beside = [&folder](std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');  // for paths written on Windows
    std::optional<std::string> bytes = read_regular_file((folder / name).string());
    if (!bytes) bytes = read_regular_file((folder / std::filesystem::path(name).filename()).string());
    return bytes;
  };
  return parse_obj(*text, path, beside, warnings);
}

}  // namespace halfplane
