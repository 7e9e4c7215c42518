#include "sim/scene/gltf.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <unordered_map>

#include "model/config.hpp"
#include "sim/scene/gltf_materials.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

using Rgba = std::array<double, 4>;

// Accessors of one primitive, all with the same count.
struct Attributes {
  const GltfAccessor* position = nullptr;
  const GltfAccessor* normal = nullptr;
  const GltfAccessor* color = nullptr;
  const GltfAccessor* uv = nullptr;
  const GltfAccessor* indices = nullptr;
};

// Corners of a primitive, one after the other.
struct CornerRun {
  std::uint64_t first = 0, count = 0;
};

// A transform of positions and of face normals.
struct Placing {
  Mat4 world{};
  std::array<Vec3, 3> normal_rows{};  // cofactors: the inverse transpose times the determinant's magnitude
  bool is_mirrored = false;           // reverses counter-clockwise
};

Placing placing_of(const Mat4& m) {
  Placing result;
  result.world = m;
  const std::array<Vec3, 3> rows{Vec3{m[0][0], m[0][1], m[0][2]}, Vec3{m[1][0], m[1][1], m[1][2]},
                                 Vec3{m[2][0], m[2][1], m[2][2]}};
  for (std::size_t i = 0; i < 3; ++i) result.normal_rows[i] = cross(rows[(i + 1) % 3], rows[(i + 2) % 3]);
  result.is_mirrored = dot(rows[0], result.normal_rows[0]) < 0;
  if (result.is_mirrored)
    for (Vec3& row : result.normal_rows) row = scaled(row, -1);
  return result;
}

const GltfAccessor* checked(const GltfAccessor& accessor, const JsonPlace& place, int least, int most) {
  if (accessor.width < least || accessor.width > most) {
    const std::string wanted = most == 1 ? "SCALAR" : "VEC" + std::to_string(least);
    place.fail("an accessor of " + std::to_string(accessor.width) + " numbers an element", "use " + wanted);
  }
  return &accessor;
}

class GltfMeshBuilder {
 public:
  GltfMeshBuilder(GltfFile& file, std::vector<std::string>& warnings, std::size_t most_triangles)
      : file_(file),
        warnings_(warnings),
        left_(most_triangles),
        materials_(file, mesh_.textures, [this](const std::string& text) { warn(text); }) {}

  /// Fills `world` except its file.
  void run(GltfWorld& world) {
    for (const std::string& extension : file_.passed_over())
      warnings_.push_back(file_.name() + ": " + in_quotes(extension) +
                          " is used and not read here; what it changes is not seen");
    world.nodes = walk_nodes(file_, warnings_);
    has_lights_ = !world.nodes.lights.empty();
    mesh_.is_linear = true;
    mesh_.materials.clear();
    for (const GltfInstance& instance : world.nodes.instances) {
      const GltfSkin* skin = instance.skin ? skin_of(*instance.skin, world) : nullptr;
      object_ = object_number(instance.name);
      const JsonPlace list = file_.item("meshes", instance.mesh).at("primitives");
      for (std::size_t i = 0; i < list.size(); ++i) {
        GltfRun run{instance.node, mesh_.vertices.size(), 0, mesh_.triangles.size(), 0, false, false, {}};
        sources_.clear();
        add_primitive(list[i]);
        run.vertices = mesh_.vertices.size() - run.first_vertex;
        run.triangles = mesh_.triangles.size() - run.first_triangle;
        run.has_normals = material_.is_lit && attributes_.normal != nullptr;
        run.is_flat = is_flat();
        if (run.vertices == 0) continue;
        if (const auto targets = list[i].find("targets")) spend(list[i], targets->size() * run.vertices);
        run.deformation = read_deformation(file_, list[i], instance, world.nodes, skin, sources_, run.has_normals);
        world.runs.push_back(std::move(run));
      }
    }
    if (mesh_.parts.empty()) {
      throw InputError(file_.name() + ": nothing in its scene that could be drawn; export it with its meshes");
    }
    world.mesh = std::move(mesh_);
  }

 private:
  void warn(const std::string& text) {
    if (warned_.insert(text).second) warnings_.push_back(file_.name() + ": " + text);
  }

  // Read on first use by a mesh.
  const GltfSkin* skin_of(std::size_t number, GltfWorld& world) {
    world.skins.resize(file_.count("skins"));
    if (!world.skins[number]) world.skins[number] = read_skin(file_, world.nodes, number);
    if (!world.skins[number])
      warn("skins with joints outside of the scene are not read: meshes are shown as they were before any joint moved");
    return world.skins[number] ? &*world.skins[number] : nullptr;
  }

  // Nodes with the same name are one object.
  std::uint32_t object_number(const std::string& name) {
    const auto [place, added] = object_numbers_.try_emplace(name, static_cast<std::uint32_t>(mesh_.objects.size()));
    if (added) mesh_.objects.push_back(name);
    return place->second;
  }

  void add_primitive(const JsonPlace& place) {
    spend(place, 1);  // its triangles come later: many empty ones cost time, too
    const std::uint64_t mode = place.whole_or("mode", 6, 4);
    const JsonPlace attributes = place.at("attributes");
    if (!attributes.find("POSITION")) {
      warn("primitives without POSITION are passed over");
      return;
    }
    file_.unpack(place);
    material_ = materials_.of(place);
    attributes_ = read_attributes(place, attributes);
    MeshMaterial surface = surface_of(material_);
    surface.has_header_light = material_.is_lit && attributes_.color == nullptr;
    const auto known = std::ranges::find(mesh_.materials, surface);
    surface_ = static_cast<std::uint32_t>(known - mesh_.materials.begin());
    if (known == mesh_.materials.end()) mesh_.materials.push_back(surface);
    mode < 4 ? add_outline(place, mode) : add_triangles(place, mode);
  }

  Attributes read_attributes(const JsonPlace& primitive, const JsonPlace& list) {
    Attributes result;
    const auto read = [&](const char* key, int least, int most) -> const GltfAccessor* {
      const std::optional<JsonPlace> index = list.find(key);
      if (!index) return nullptr;
      const GltfAccessor* accessor = checked(file_.accessor(*index), *index, least, most);
      if (result.position != nullptr && accessor->count != result.position->count) {
        index->fail(
            std::to_string(accessor->count) + " elements for " + std::to_string(result.position->count) + " positions",
            "export the file again");
      }
      return accessor;
    };
    result.position = read("POSITION", 3, 3);
    result.normal = read("NORMAL", 3, 3);
    result.color = read("COLOR_0", 3, 4);
    result.uv = read(material_.uv_set.c_str(), 2, 2);
    if (result.color != nullptr && result.color->component != GltfComponent::f32 && !result.color->normalized) {
      list.at("COLOR_0").fail("colours of whole numbers that are not normalized", "add \"normalized\": true");
    }
    if (const std::optional<JsonPlace> index = primitive.find("indices")) {
      result.indices = checked(file_.accessor(*index), *index, 1, 1);
      const GltfComponent kind = result.indices->component;
      const bool is_unsigned = kind == GltfComponent::u8 || kind == GltfComponent::u16 || kind == GltfComponent::u32;
      if (!is_unsigned || result.indices->normalized) {
        index->fail("indices that are no unsigned whole numbers", "use component type 5121, 5123 or 5125");
      }
    }
    return result;
  }

  void spend(const JsonPlace& place, std::uint64_t count) {
    if (count > left_) place.fail("the scene has more triangles than are read here", "export fewer, or in parts");
    left_ -= static_cast<std::size_t>(count);
  }

  /// Corners between two indices of the largest value of their type, which restart strips, fans, loops and lists: the
  /// format forbids them, but exporters write them, because graphics APIs interpret them so.
  std::vector<CornerRun> runs() {
    const GltfAccessor* indices = attributes_.indices;
    const std::uint64_t corners = indices != nullptr ? indices->count : attributes_.position->count;
    std::vector<CornerRun> result{{0, 0}};
    const double restart = indices == nullptr                         ? -1
                           : indices->component == GltfComponent::u8  ? 255
                           : indices->component == GltfComponent::u16 ? 65535
                                                                      : 4294967295.0;
    for (std::uint64_t i = 0; i < corners; ++i) {
      if (indices == nullptr || read_element(*indices, i)[0] != restart) {
        ++result.back().count;
        continue;
      }
      result.push_back({i + 1, 0});
      warn("indices of " + std::to_string(static_cast<std::uint64_t>(restart)) +
           " start primitives anew, as graphics APIs do; glTF 2.0 does not allow them");
    }
    return result;
  }

  void add_triangles(const JsonPlace& place, std::uint64_t mode) {
    const std::vector<CornerRun> all = runs();
    if (all.size() == 1 && (all[0].count < 3 || (mode == 4 && all[0].count % 3 != 0))) {
      place.fail(std::to_string(all[0].count) + " corners make no whole triangles", "export the file again");
    }
    const auto triangles_of = [mode](const CornerRun& run) {
      return mode == 4 ? run.count / 3 : std::max<std::uint64_t>(run.count, 2) - 2;
    };
    std::uint64_t count = 0;
    for (const CornerRun& run : all) count += triangles_of(run);
    if (count == 0) place.fail("its corners make no whole triangles", "export the file again");
    spend(place, count);
    MeshPart& part = mesh_.parts.emplace_back();
    part.object = object_;
    part.first = mesh_.triangles.size();
    part.count = static_cast<std::size_t>(count);
    part.two_sided = material_.is_two_sided;
    part.alpha = material_.alpha;
    part.alpha_cutoff = material_.alpha_cutoff;
    if (attributes_.uv != nullptr) part.sampler = materials_.sampler(material_);
    if (attributes_.uv == nullptr && material_.texture) {
      warn("primitives without " + material_.uv_set + " are shown without their texture");
    }
    new_index_ = {};  // clear() would keep a table of the largest primitive's size
    for (const CornerRun& run : all)
      for (std::uint64_t i = 0; i < triangles_of(run); ++i) {
        // A strip reverses every other triangle; a fan keeps its first vertex, as its last corner.
        std::array<std::uint64_t, 3> at{3 * i, 3 * i + 1, 3 * i + 2};
        if (mode == 5) at = {i, i + 1 + i % 2, i + 2 - i % 2};
        if (mode == 6) at = {i + 1, i + 2, 0};
        for (std::uint64_t& corner : at) corner = source_vertex(run.first + corner);
        add_triangle(at);
      }
  }

  // Points, lines, line loops and line strips, in that order of `mode`. Without normals they are shown unlit.
  void add_outline(const JsonPlace& place, std::uint64_t mode) {
    constexpr std::array<Topology, 4> kTopologies{Topology::points, Topology::lines, Topology::line_loop,
                                                  Topology::line_strip};
    const std::uint64_t least = mode == 0 ? 1 : 2;
    const std::vector<CornerRun> all = runs();
    if (const std::uint64_t corners = all[0].count;
        all.size() == 1 && (corners < least || (mode == 1 && corners % 2 != 0))) {
      place.fail(std::to_string(corners) + (corners == 1 ? " corner makes" : " corners make") + " no whole lines",
                 "export the file again");
    }
    new_index_ = {};
    for (const CornerRun& run : all) {
      const std::uint64_t corners = mode == 1 ? run.count / 2 * 2 : run.count;
      if (corners < least) continue;
      spend(place, corners);
      mesh_.parts.push_back({object_, mesh_.indices.size(), static_cast<std::size_t>(corners), 0, true,
                             kTopologies[static_cast<std::size_t>(mode)]});
      for (std::uint64_t i = 0; i < corners; ++i) mesh_.indices.push_back(shared_vertex(source_vertex(run.first + i)));
    }
  }

  std::uint64_t source_vertex(std::uint64_t corner) const {
    if (attributes_.indices == nullptr) return corner;
    const auto vertex = static_cast<std::uint64_t>(read_element(*attributes_.indices, corner)[0]);
    if (vertex >= attributes_.position->count) {
      throw InputError(attributes_.indices->place + ": element " + std::to_string(corner) + " is vertex " +
                       std::to_string(vertex) + " of " + std::to_string(attributes_.position->count) +
                       "; correct it, or export the file again");
    }
    return vertex;
  }

  // Adds only vertices that are used to the mesh, each once: primitives often share one long list.
  std::uint32_t shared_vertex(std::uint64_t from) {
    const auto [place, added] = new_index_.try_emplace(from, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) add_vertex(from);
    return place->second;
  }

  void add_triangle(const std::array<std::uint64_t, 3>& from) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_flat()) {
        triangle[i] = static_cast<std::uint32_t>(mesh_.vertices.size());
        add_vertex(from[i]);
      } else {
        triangle[i] = shared_vertex(from[i]);
      }
    }
    mesh_.triangles.push_back(triangle);
  }

  /// Lit without normals: the format requires face normals. Without lights a primitive with colours is not lit.
  bool is_flat() const {
    const bool has_light = attributes_.color == nullptr || has_lights_;
    return material_.is_lit && has_light && attributes_.normal == nullptr;
  }

  void add_vertex(std::uint64_t from) {
    mesh_.vertices.push_back(make_vertex(from));
    sources_.push_back(from);
  }

  MeshVertex make_vertex(std::uint64_t i) const {
    MeshVertex made;
    made.material = surface_;
    const Rgba p = read_element(*attributes_.position, i);
    std::copy_n(p.begin(), 3, made.position.begin());
    if (attributes_.normal != nullptr && material_.is_lit) {
      const Rgba n = read_element(*attributes_.normal, i);
      std::copy_n(n.begin(), 3, made.normal.begin());
    }
    Rgba color = material_.base;
    if (attributes_.color != nullptr) {
      const Rgba own = read_element(*attributes_.color, i);
      for (std::size_t k = 0; k < 3; ++k) color[k] *= own[k];
      if (attributes_.color->width == 4) color[3] *= own[3];
    }
    for (std::size_t k = 0; k < 3; ++k) made.rgba[k] = display_code(color[k]);
    made.rgba[3] = std::clamp(color[3], 0.0, 1.0) * 255;  // opacity is linear in both
    if (attributes_.uv != nullptr) {
      const Rgba uv = read_element(*attributes_.uv, i);
      const auto& [to_u, to_v] = material_.uv_transform;
      made.u = to_u[0] * uv[0] + to_u[1] * uv[1] + to_u[2];
      made.v = to_v[0] * uv[0] + to_v[1] * uv[1] + to_v[2];
      if (!(std::abs(made.u) <= kLargestCoordinate && std::abs(made.v) <= kLargestCoordinate)) {
        throw InputError(attributes_.uv->place + ": element " + std::to_string(i) +
                         " is beyond 1e30 on its texture; scale it down");
      }
    }
    return made;
  }

  GltfFile& file_;
  std::vector<std::string>& warnings_;
  std::size_t left_;  // limit of further triangles
  Mesh mesh_;
  std::set<std::string> warned_;
  std::unordered_map<std::string, std::uint32_t> object_numbers_;
  std::uint32_t object_ = 0;
  GltfMaterials materials_;
  bool has_lights_ = false;
  GltfMaterial material_;  // of the current primitive, like the next three members
  std::uint32_t surface_ = 0;
  Attributes attributes_;
  std::unordered_map<std::uint64_t, std::uint32_t> new_index_;
  std::vector<std::uint64_t> sources_;  // indices of its vertices in its accessors
};

/// Applies the morph targets to a run's vertices.
void morph_run(const GltfRun& run, const std::vector<double>& weights, Mesh& mesh) {
  for (std::size_t t = 0; t < weights.size(); ++t) {
    const MorphTarget& target = run.deformation.targets[t];
    if (weights[t] == 0) continue;
    for (std::size_t i = 0; i < target.positions.size(); ++i) {
      Vec3& position = mesh.vertices[run.first_vertex + i].position;
      position = add(position, scaled(target.positions[i], weights[t]));
    }
    for (std::size_t i = 0; i < target.normals.size(); ++i) {
      Vec3& normal = mesh.vertices[run.first_vertex + i].normal;
      normal = add(normal, scaled(target.normals[i], weights[t]));
    }
  }
}

/// Transforms a run's vertices to world space, the vertices of a skin by `joints`, and orients its triangles.
void place_run(const GltfRun& run, const Mat4& node, const std::vector<Mat4>& joints, Mesh& mesh) {
  Placing placing = placing_of(node);
  std::vector<bool> is_mirrored;  // of each vertex of a skin
  for (std::size_t i = 0; i < run.vertices; ++i) {
    MeshVertex& vertex = mesh.vertices[run.first_vertex + i];
    const Vec3 p = vertex.position, n = vertex.normal;
    if (!joints.empty()) {
      placing = placing_of(skin_matrix(run.deformation, joints, i));
      is_mirrored.push_back(placing.is_mirrored);
    }
    const Vec4 world = transform(placing.world, {p[0], p[1], p[2], 1});
    for (std::size_t k = 0; k < 3; ++k) {
      vertex.position[k] = world[k];
      if (run.has_normals) vertex.normal[k] = dot(placing.normal_rows[k], n);
    }
    if (run.has_normals) vertex.normal = normalized(vertex.normal);
  }
  for (std::size_t i = 0; i < run.triangles; ++i) {
    auto& triangle = mesh.triangles[run.first_triangle + i];
    const bool turns = joints.empty() ? placing.is_mirrored : is_mirrored[triangle[0] - run.first_vertex];
    if (turns) std::swap(triangle[1], triangle[2]);
    if (!run.is_flat) continue;
    const auto corner = [&](std::size_t k) -> MeshVertex& { return mesh.vertices[triangle[k]]; };
    const Vec3 side = subtract(corner(1).position, corner(0).position);
    const Vec3 normal = normalized(cross(side, subtract(corner(2).position, corner(0).position)));
    for (std::size_t k = 0; k < 3; ++k) corner(k).normal = normal;
  }
}

void check_places(const GltfWorld& world, const GltfRun& run, const Mesh& mesh) {
  for (std::size_t i = 0; i < run.vertices; ++i) {
    for (const double coordinate : mesh.vertices[run.first_vertex + i].position) {
      if (!(std::abs(coordinate) <= kLargestCoordinate)) {
        world.file->item("nodes", world.nodes.nodes[run.node].number)
            .fail("vertex " + std::to_string(i) + " of what is drawn there is beyond 1e30 in the world",
                  "scale the model down");
      }
    }
  }
}

}  // namespace

GltfWorld parse_gltf_world(std::string bytes, const std::string& file, const BufferSource& source,
                           std::vector<std::string>& warnings, std::size_t most_triangles) {
  GltfWorld world;
  world.file = std::make_unique<GltfFile>(std::move(bytes), file, source);
  GltfMeshBuilder(*world.file, warnings, most_triangles).run(world);
  if (!world.nodes.lights.empty()) world.exposure = exposure_of(posed(world).mesh);
  return world;
}

GltfWorld read_gltf_world(const std::string& path, std::vector<std::string>& warnings) {
  std::optional<std::string> bytes = read_regular_file(path);
  if (!bytes) throw InputError(path + ": cannot be read as a file; check the name and its permissions");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const auto beside = [folder](const std::string& name) { return read_regular_file((folder / name).string()); };
  return parse_gltf_world(std::move(*bytes), path, beside, warnings);
}

GltfModel posed(const GltfWorld& world, const GltfAnimation* animation, double time) {
  const std::vector<Mat4> matrices = world_matrices(*world.file, world.nodes, animation, time);
  GltfModel model{world.mesh, placed_cameras(*world.file, world.nodes, matrices)};
  model.mesh.lights = placed_lights(world.nodes, matrices);
  for (Light& light : model.mesh.lights)
    for (std::size_t c = 0; c < 3; ++c) light.specular[c] = light.diffuse[c] *= world.exposure;
  std::vector<std::vector<Mat4>> joints;  // of each skin
  const std::vector<Mat4> none;
  for (const auto& skin : world.skins) joints.push_back(skin ? joint_matrices(*skin, matrices) : std::vector<Mat4>());
  for (const GltfRun& run : world.runs) {
    const GltfDeformation& deformation = run.deformation;
    if (!deformation.targets.empty())
      morph_run(run, morph_weights(deformation.targets, world.nodes.nodes[run.node].number, animation, time),
                model.mesh);
    place_run(run, matrices[run.node], deformation.skin ? joints[*deformation.skin] : none, model.mesh);
    check_places(world, run, model.mesh);
  }
  return model;
}

Mesh extent_over_time(const GltfWorld& world, const GltfAnimation& animation) {
  constexpr int kSteps = 16;
  Mesh extent;
  for (int step = 0; step <= kSteps; ++step) {
    const Mesh mesh = posed(world, &animation, animation.end * step / kSteps).mesh;
    for (const GltfRun& run : world.runs) {
      Vec3 low = mesh.vertices[run.first_vertex].position, high = low;
      for (std::size_t i = 1; i < run.vertices; ++i) {
        const Vec3& p = mesh.vertices[run.first_vertex + i].position;
        for (std::size_t k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], p[k]);
          high[k] = std::max(high[k], p[k]);
        }
      }
      for (unsigned corner = 0; corner < 8; ++corner) {
        MeshVertex& made = extent.vertices.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) made.position[k] = (corner >> k & 1U) != 0 ? high[k] : low[k];
      }
    }
  }
  return extent;
}

GltfModel parse_gltf(std::string bytes, const std::string& file, const BufferSource& source,
                     std::vector<std::string>& warnings, std::size_t most_triangles) {
  return posed(parse_gltf_world(std::move(bytes), file, source, warnings, most_triangles));
}

}  // namespace halfplane
