#include "sim/scene/obj.hpp"

#include <algorithm>
#include <filesystem>
#include <span>

#include "model/capture/capture_textures.hpp"
#include "model/config.hpp"
#include "sim/scene/mesh_textures.hpp"
#include "sim/scene/obj_text.hpp"
#include "sim/scene/polygon.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr std::uint32_t kMadeNormal = 0x80000000;  // marks the number of a normal that the file did not give

// What makes two corners the same vertex. Made normals of a flat face are its own.
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
    if (in_.faces.empty()) {
      throw InputError(in_.file + ":1: no faces (f lines), so nothing to draw; export the model as a polygon mesh");
    }
    vertex_of_.reserve(in_.positions.size() * 2);
    choose_colors();
    for (const ObjFace& face : in_.faces) add_face(face);
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
      if ((normal_of_[i] & kMadeNormal) == 0) continue;
      mesh_.vertices[i].normal = normalized(made_normals_[normal_of_[i] & ~kMadeNormal]);
    }
    return std::move(mesh_);
  }

 private:
  void choose_colors() {
    mesh_.lit = in_.colors.empty();
    for (const auto& color : in_.colors) {
      for (const double value : color) color_scale_ = value > 1 ? 1 : color_scale_;  // the file counts to 255
    }
    const MtlMaterial plain{.rgba = {204, 204, 204, 255}};  // no material: a light grey
    for (const std::string& name : in_.material_names) {
      const auto found = in_.materials.find(name);
      materials_.push_back(found == in_.materials.end() ? plain : found->second);
      material_known_.push_back(found != in_.materials.end() || name.empty());
    }
    mesh_.materials.clear();
    for (const MtlMaterial& material : materials_) {
      MeshMaterial& surface = mesh_.materials.emplace_back(material.surface);
      // Without an exponent the highlight would be all of the lit half.
      if (!material.has_highlight || surface.shininess == 0) surface.specular = {};
    }
  }

  // Checks the corners, gives them normals, splits the polygon.
  void add_face(const ObjFace& face) {
    places_.clear();
    for (std::size_t i = face.first; i < face.first + face.count; ++i) {
      const ObjCorner& corner = in_.corners[i];
      check(face, corner.position, in_.positions.size(), "v");
      check(face, corner.uv, in_.uvs.size(), "vt");
      check(face, corner.normal, in_.normals.size(), "vn");
      places_.push_back(in_.positions[static_cast<std::size_t>(corner.position)]);
    }
    if (!material_known_[face.material]) {
      material_known_[face.material] = true;  // one warning a name
      warnings_.push_back(in_.file + ":" + std::to_string(face.line) + ": no material " +
                          in_quotes(in_.material_names[face.material]) + "; the default colour is used");
    }
    split_.clear();
    if (!triangulate_polygon(places_, split_)) {
      fail_at(in_.file, face.line, "a concave polygon of " + std::to_string(face.count) + " corners",
              "split it into polygons of at most " + std::to_string(kLargestConcavePolygon));
    }
    open_part(face);
    vertices_.clear();
    for (std::size_t i = 0; i < face.count; ++i) vertices_.push_back(vertex(face, in_.corners[face.first + i]));
    add_angles();
    for (const auto& triangle : split_) {
      mesh_.triangles.push_back({vertices_[triangle[0]], vertices_[triangle[1]], vertices_[triangle[2]]});
      ++mesh_.parts.back().count;
    }
    ++face_number_;
  }

  void check(const ObjFace& face, std::int64_t index, std::size_t count, const char* what) const {
    if (index < static_cast<std::int64_t>(count)) return;
    fail_at(in_.file, face.line,
            std::string(what) + " index " + std::to_string(index + 1) + " of " + std::to_string(count),
            "correct the face, or add the missing " + std::string(what) + " lines");
  }

  void open_part(const ObjFace& face) {
    const std::optional<MeshSampler> sampler = sampler_of(face);
    if (!mesh_.parts.empty() && part_object_ == face.object && mesh_.parts.back().sampler == sampler) return;
    part_object_ = face.object;
    if (object_number_.empty()) object_number_.assign(in_.object_names.size(), kUnused);
    if (object_number_[face.object] == kUnused) {  // only objects with faces get into the mesh
      object_number_[face.object] = static_cast<std::uint32_t>(mesh_.objects.size());
      mesh_.objects.push_back(in_.object_names[face.object]);
    }
    mesh_.parts.push_back({object_number_[face.object], mesh_.triangles.size(), 0, face.line});
    mesh_.parts.back().sampler = sampler;
  }

  // How a face's texture is looked up; nothing without one, or where a corner has no place on it.
  std::optional<MeshSampler> sampler_of(const ObjFace& face) {
    const std::optional<MtlTexture>& map = materials_[face.material].texture;
    const auto corners = std::span(in_.corners).subspan(face.first, face.count);
    if (!map || std::ranges::find(corners, kNoIndex, &ObjCorner::uv) != corners.end()) return std::nullopt;
    const auto [place, is_new] = texture_of_file_.try_emplace(map->file);
    if (is_new) place->second = load_texture(*map);
    if (!place->second) return std::nullopt;
    MeshSampler sampler{.texture = *place->second};
    sampler.wrap = {map->wrap, map->wrap};
    return sampler;
  }

  // An image that cannot be read is a warning, as a library is.
  std::optional<std::uint32_t> load_texture(const MtlTexture& map) {
    const std::string what = map.place + ": map_Kd " + in_quotes(map.file);
    const std::optional<std::string> bytes = source_(map.file);
    TexelImage image;
    try {
      if (!bytes) throw InputError(what + ": there is no such file");
      image = read_image(*bytes, what);
    } catch (const InputError& error) {
      warnings_.push_back(std::string(error.what()) + "; the colour is shown alone");
      return std::nullopt;
    }
    for (int top = 0, bottom = image.height - 1; top < bottom; ++top, --bottom) {  // v counts from the bottom
      const auto row = [&image](int y) { return image.texel.begin() + std::ptrdiff_t{y} * image.width; };
      std::swap_ranges(row(top), row(top + 1), row(bottom));
    }
    const std::uint32_t texture =
        add_texture(mesh_.textures, image, std::filesystem::path(map.file).stem().string(), what);
    add_mips_for(MeshSampler{}.min, mesh_.textures[texture]);
    return texture;
  }

  // The mesh vertex of a corner: a known one if everything about it agrees.
  std::uint32_t vertex(const ObjFace& face, const ObjCorner& corner) {
    const auto position = static_cast<std::uint32_t>(corner.position);
    const std::uint32_t normal =
        corner.normal == kNoIndex ? made_normal(face, position) : static_cast<std::uint32_t>(corner.normal);
    const CornerKey key{position, static_cast<std::uint32_t>(corner.uv), normal, face.material};
    const auto [place, added] = vertex_of_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (!added) return place->second;
    MeshVertex made;
    made.position = in_.positions[position];
    if (corner.normal != kNoIndex) made.normal = normalized(in_.normals[normal]);
    if (corner.uv != kNoIndex) {
      const auto& [u, v] = in_.uvs[static_cast<std::size_t>(corner.uv)];
      const std::optional<MtlTexture>& map = materials_[face.material].texture;
      made.u = map ? u * map->scale[0] + map->offset[0] : u;
      made.v = map ? v * map->scale[1] + map->offset[1] : v;
    }
    made.rgba = color(position, face.material);
    made.material = face.material;
    mesh_.vertices.push_back(made);
    normal_of_.push_back(normal);
    return place->second;
  }

  std::array<double, 4> color(std::uint32_t position, std::uint32_t material) const {
    if (in_.colors.empty()) return materials_[material].rgba;
    std::array<double, 4> rgba{255, 255, 255, 255};
    if (position >= in_.colors.size()) return rgba;
    for (std::size_t i = 0; i < 4; ++i) {
      const double value = in_.colors[position][i];
      if (value >= 0) rgba[i] = std::min(value * color_scale_, 255.0);
    }
    return rgba;
  }

  // One made normal for each position and smoothing group; for each position and face when flat.
  std::uint32_t made_normal(const ObjFace& face, std::uint32_t position) {
    const bool flat = face.smoothing == 0;
    const CornerKey key{position, flat, flat ? face_number_ : face.smoothing, 0};
    const auto [place, added] = normal_at_.try_emplace(key, static_cast<std::uint32_t>(made_normals_.size()));
    if (added) made_normals_.push_back({});
    return place->second | kMadeNormal;
  }

  // Adds the direction of each new triangle to the made normals of its corners, weighted by the angle there, so that
  // the way in which a polygon was split does not show.
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
  std::vector<std::string>& warnings_;
  Mesh mesh_;
  std::unordered_map<CornerKey, std::uint32_t, CornerHash> vertex_of_, normal_at_;
  std::vector<std::uint32_t> normal_of_;  // for each mesh vertex
  std::vector<Vec3> made_normals_;
  std::vector<MtlMaterial> materials_;  // for each of in_.material_names
  std::vector<bool> material_known_;
  std::unordered_map<std::string, std::optional<std::uint32_t>> texture_of_file_;
  std::vector<std::uint32_t> object_number_;
  double color_scale_ = 255;
  std::uint32_t part_object_ = 0, face_number_ = 0;
  std::vector<Vec3> places_;  // of the face at hand, as are the next two
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
    std::replace(name.begin(), name.end(), '\\', '/');  // written on Windows
    return read_regular_file((folder / name).string());
  };
  return parse_obj(*text, path, beside, warnings);
}

}  // namespace halfplane
