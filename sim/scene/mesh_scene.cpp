#include "sim/scene/mesh_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "model/config.hpp"
#include "sim/scene/object_cull.hpp"

namespace halfplane {
namespace {

void look_up(State& state, const MeshSampler& sampler) {
  state.texture = sampler.texture;
  state.texture_min = sampler.min;
  state.texture_mag = sampler.mag;
  state.texture_wrap = sampler.wrap;
}

/// The states for a material's opacity: `mask` draws opaque parts, `blend` lays colours over the stored ones, so that
/// later draws can still lie behind.
void set_opacity(State& state, AlphaMode alpha, double cutoff) {
  if (alpha == AlphaMode::mask && cutoff > 1)
    state.alpha_test = {DepthFunc::never, 0};  // no opacity passes
  else if (alpha == AlphaMode::mask)
    state.alpha_test = {DepthFunc::gequal, static_cast<std::uint8_t>(std::ceil(255 * std::max(cutoff, 0.0)))};
  if (alpha != AlphaMode::blend) return;
  state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one,
                             BlendFactor::one_minus_src_alpha};
  state.depth_write = false;
}

/// The parts in drawing order: blended parts after all others, farthest first by the centres of their objects'
/// triangles. Intersecting objects have no such order.
std::vector<const MeshPart*> drawing_order(const Mesh& mesh, const std::vector<ObjectBounds>& bounds,
                                           const Mat4& to_clip, bool is_ortho) {
  std::vector<const MeshPart*> parts;
  for (const MeshPart& part : mesh.parts) parts.push_back(&part);
  const auto blended =
      std::stable_partition(parts.begin(), parts.end(), [](const MeshPart* p) { return p->alpha != AlphaMode::blend; });
  const auto distance = [&](const MeshPart* part) {
    const Vec3& middle = bounds[part->object].center;
    const Vec4 clip = transform(to_clip, {middle[0], middle[1], middle[2], 1});
    return is_ortho ? clip[2] : clip[3];  // every w is 1
  };
  std::stable_sort(blended, parts.end(),
                   [&](const MeshPart* a, const MeshPart* b) { return distance(a) > distance(b); });
  return parts;
}

/// A run of a part's triangles with one state.
struct MaterialRun {
  std::size_t first = 0, count = 0;       ///< triangles
  std::optional<std::uint32_t> material;  ///< material of lit fragments; none: not lit
};

/// Whether all corners have a normal and a lit material.
bool is_lit(const Mesh& mesh, std::size_t triangle) {
  return std::ranges::all_of(mesh.triangles[triangle], [&mesh](std::uint32_t v) {
    return mesh.vertices[v].normal != Vec3{} && mesh.materials[mesh.vertices[v].material].has_header_light;
  });
}

/// For a part with lit vertices, one run.
std::vector<MaterialRun> runs_of(const Mesh& mesh, const MeshPart& part, bool is_phong) {
  if (!is_phong || part.topology != Topology::triangles) return {{part.first, part.count, std::nullopt}};
  std::vector<MaterialRun> runs;
  for (std::size_t t = part.first; t < part.first + part.count; ++t) {
    const auto material = is_lit(mesh, t) ? std::optional(mesh.vertices[mesh.triangles[t][0]].material) : std::nullopt;
    if (runs.empty() || runs.back().material != material) runs.push_back({t, 0, material});
    ++runs.back().count;
  }
  return runs;
}

/// Normals in eye space. For a two-sided triangle that shows its back at all corners they are reversed, on copies of
/// its vertices; where corners differ, as at an outline, they stay.
void set_normals(const Mesh& mesh, const Mat4& view, bool is_ortho, Scene& scene) {
  const auto turned = [&view](const Vec3& v, double w) -> Vec3 {
    const Vec4 eye = transform(view, {v[0], v[1], v[2], w});
    return {eye[0], eye[1], eye[2]};
  };
  std::vector<bool> looks_away;
  for (const MeshVertex& vertex : mesh.vertices) {
    scene.normals.push_back(turned(vertex.normal, 0));
    const Vec3 to_eye = is_ortho ? Vec3{0, 0, 1} : scaled(turned(vertex.position, 1), -1);
    looks_away.push_back(mesh.materials[vertex.material].is_two_sided && dot(scene.normals.back(), to_eye) < 0);
  }
  std::map<std::uint32_t, std::uint32_t> copies;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!std::ranges::all_of(mesh.triangles[t], [&](std::uint32_t v) { return looks_away[v]; })) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& index = scene.indices[3 * t + i];
      const auto [copy, is_new] = copies.try_emplace(index, static_cast<std::uint32_t>(scene.vertices.size()));
      if (is_new) {
        scene.vertices.push_back(Vertex(scene.vertices[index]));
        scene.normals.push_back(scaled(Vec3(scene.normals[index]), -1));
      }
      index = copy->second;
    }
  }
}

/// The tests that find each object outside.
std::vector<std::uint8_t> objects_outside(const std::vector<ObjectBounds>& bounds, const BoundsTree* tree,
                                          const Mat4& to_clip, std::uint8_t tests, BoundsWork& work) {
  if (tree != nullptr) return tree->outside_view(to_clip, tests, work);
  std::vector<std::uint8_t> outside;
  for (const ObjectBounds& object : bounds) outside.push_back(outside_view(object, to_clip) & tests);
  work.tests = outside.size();
  return outside;
}

/// The part of a mesh that belongs to objects that may be visible.
struct SeenMesh {
  Mesh mesh;                            ///< vertices, triangles, indices and materials; no parts
  std::vector<std::uint32_t> vertices;  ///< their numbers in the whole mesh
  std::vector<std::size_t> first;       ///< by part of the whole mesh: its first triangle
  std::size_t most_left_out = 0;        ///< largest number of triangles left out of a part
};

SeenMesh seen_of(const Mesh& mesh, const std::vector<std::uint8_t>& outside) {
  constexpr std::uint32_t kNone = ~0U;
  SeenMesh seen;
  seen.mesh.materials = mesh.materials;
  seen.mesh.lights = mesh.lights;
  seen.mesh.lit = mesh.lit;
  seen.mesh.is_linear = mesh.is_linear;
  std::size_t triangles = 0;
  for (const MeshPart& part : mesh.parts)
    if (part.topology == Topology::triangles && outside[part.object] == 0) triangles += part.count;
  seen.mesh.triangles.reserve(triangles);
  seen.vertices.reserve(std::min(triangles, mesh.vertices.size()));
  seen.mesh.vertices.reserve(std::min(triangles, mesh.vertices.size()));
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
  const auto add = [&](std::uint32_t vertex) {
    if (number[vertex] == kNone) {
      number[vertex] = static_cast<std::uint32_t>(seen.vertices.size());
      seen.vertices.push_back(vertex);
      seen.mesh.vertices.push_back(mesh.vertices[vertex]);
    }
    return number[vertex];
  };
  for (const MeshPart& part : mesh.parts) {
    seen.first.push_back(seen.mesh.triangles.size());
    if (part.topology != Topology::triangles) continue;
    if (outside[part.object] != 0) {
      seen.most_left_out = std::max(seen.most_left_out, part.count);
      continue;
    }
    for (std::size_t t = part.first; t < part.first + part.count; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      seen.mesh.triangles.push_back({add(a), add(b), add(c)});
    }
  }
  for (const std::uint32_t index : mesh.indices) seen.mesh.indices.push_back(index == kRestart ? index : add(index));
  return seen;
}

bool finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

}  // namespace

Scene cleared_scene(int width, int height) {
  Scene scene;
  scene.width = width;
  scene.height = height;
  scene.states.push_back({});
  scene.commands.push_back(Clear{0, std::array<double, 4>{20, 20, 30, 255}, 1.0});
  return scene;
}

Scene mesh_scene(const Mesh& mesh, const CameraRequest& request, int width, int height, Cull cull,
                 const MeshOptions& options, const Mesh* framed) {
  const double aspect = static_cast<double>(width) / height;
  const Camera camera = frame(request, framed != nullptr ? *framed : mesh, aspect);
  const Mat4 view = view_matrix(camera), projection = projection_matrix(camera, aspect);

  Scene scene = cleared_scene(width, height);
  scene.states[0].cull = cull;
  if (camera.ortho == 0) scene.planes = {camera.near, camera.far};
  const Mat4 to_clip = product(projection, view);
  const auto found = options.places == nullptr ? object_bounds(mesh) : std::vector<ObjectBounds>();
  const std::vector<ObjectBounds>& bounds = options.places != nullptr ? options.places->bounds : found;
  const BoundsTree* const tree = options.places != nullptr && options.has_tree ? &options.places->tree : nullptr;
  const bool leaves_out = options.leaves_out != CullObjects::none;
  MeshWork work;
  const std::vector<std::uint8_t> outside =
      objects_outside(bounds, tree, to_clip, bits_of(leaves_out ? options.leaves_out : CullObjects::both), work.bounds);
  const bool is_reduced = leaves_out && std::ranges::any_of(outside, [](std::uint8_t bits) { return bits != 0; });
  const std::optional<SeenMesh> reduced = is_reduced ? std::optional(seen_of(mesh, outside)) : std::nullopt;
  const Mesh& seen = reduced ? reduced->mesh : mesh;
  work.vertices_skipped = mesh.vertices.size() - seen.vertices.size();
  if (options.work != nullptr) *options.work = work;

  scene.vertices.reserve(seen.vertices.size());
  const VertexTransform to_clip_space(view, projection, options.transform);
  for (const MeshVertex& in : seen.vertices) {
    const Vec4 clip = to_clip_space.clip(in.position);
    const Vertex out{clip[0], clip[1], clip[2], clip[3], in.rgba, in.u, in.v};
    if (!finite(out)) throw InputError("--camera: a vertex leaves binary64; bring eye and fov nearer to the mesh");
    scene.vertices.push_back(out);
  }
  const bool is_lit_by_all = reduced && (options.light.is_given() || !mesh.lights.empty());
  const auto colors = lit_colors(is_lit_by_all ? mesh : seen, options.light, view, camera.ortho > 0);
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    scene.vertices[i].rgba = colors[is_lit_by_all ? reduced->vertices[i] : i];
  const std::size_t corners = seen.triangles.size() * 3;  // the indices of lines and points follow those of triangles
  scene.indices.reserve(corners + seen.indices.size());
  for (const auto& triangle : seen.triangles) {
    scene.indices.insert(scene.indices.end(), triangle.begin(), triangle.end());
  }
  scene.indices.insert(scene.indices.end(), seen.indices.begin(), seen.indices.end());
  const bool is_phong = options.light.is_phong && !options.light.is_off;
  if (is_phong) set_normals(seen, view, camera.ortho > 0, scene);
  const std::size_t left_out = scene.indices.size();  // indices of all triangles left out: as many as one draw has
  if (reduced) {
    scene.indices.resize(left_out + 3 * reduced->most_left_out, static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back({0, 0, 0, 1});
  }
  // Object 0 of a scene is the unnamed one; a mesh's own unnamed part becomes it.
  std::vector<std::uint32_t> numbers;
  for (const std::string& name : mesh.objects) {
    numbers.push_back(name.empty() ? 0 : static_cast<std::uint32_t>(scene.objects.size()));
    if (!name.empty()) scene.objects.push_back(name);
  }
  scene.textures = mesh.textures;
  using Look = std::tuple<bool, std::optional<MeshSampler>, AlphaMode, double, std::optional<std::uint32_t>>;
  std::map<Look, std::uint32_t> states{{{false, std::nullopt, AlphaMode::opaque, 0.0, std::nullopt}, 0}};
  for (const MeshPart* const at : drawing_order(mesh, bounds, to_clip, camera.ortho > 0)) {
    const MeshPart& part = *at;
    const std::uint32_t object = numbers[part.object];
    const bool is_culled = !part.two_sided && cull == Cull::none;
    const bool is_filled = part.topology == Topology::triangles;
    // Pixels of lines and points can reach beyond their vertices.
    const std::uint8_t is_outside = is_filled ? outside[part.object] : std::uint8_t{0};
    for (const MaterialRun& run : runs_of(mesh, part, is_phong)) {
      const double cutoff = part.alpha == AlphaMode::mask ? part.alpha_cutoff : 0;
      const auto [state, is_new] = states.try_emplace({is_culled, part.sampler, part.alpha, cutoff, run.material},
                                                      static_cast<std::uint32_t>(scene.states.size()));
      if (is_new) {
        State& made = scene.states.emplace_back(scene.states[0]);
        if (is_culled) made.cull = Cull::back;
        if (part.sampler) look_up(made, *part.sampler);
        set_opacity(made, part.alpha, part.alpha_cutoff);
        if (run.material) made = phong_state(made, mesh, mesh.materials[*run.material], options.light, view);
      }
      std::size_t first = is_filled ? run.first * 3 : corners + run.first;
      if (reduced && is_filled) {
        const auto part_number = static_cast<std::size_t>(at - mesh.parts.data());
        first = is_outside != 0 ? left_out : 3 * (reduced->first[part_number] + run.first - part.first);
      }
      const std::size_t count = is_filled ? run.count * 3 : run.count;
      scene.commands.push_back(Draw{state->second, object, part.topology, first, count, part.line, is_outside});
    }
  }
  return scene;
}

}  // namespace halfplane
