#include "sim/scene/mesh_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

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

/// What the opacity of a material asks for: `mask` draws what is opaque enough, `blend` lays colours over what is there,
/// which later draws still have to be able to lie behind.
void set_opacity(State& state, AlphaMode alpha, double cutoff) {
  if (alpha == AlphaMode::mask && cutoff > 1)
    state.alpha_test = {DepthFunc::never, 0};  // nothing is so opaque
  else if (alpha == AlphaMode::mask)
    state.alpha_test = {DepthFunc::gequal, static_cast<std::uint8_t>(std::ceil(255 * std::max(cutoff, 0.0)))};
  if (alpha != AlphaMode::blend) return;
  state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one,
                             BlendFactor::one_minus_src_alpha};
  state.depth_write = false;
}

/// The parts in the order in which they are drawn: those that blend behind all others, farthest first by the middles of their
/// objects' triangles. Objects that reach through each other have no such order.
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

/// A run of a part's triangles that are drawn in one state.
struct MaterialRun {
  std::size_t first = 0, count = 0;       ///< triangles
  std::optional<std::uint32_t> material;  ///< that fragments are lit by; none: they are not
};

/// Whether all corners have a normal, and a material that is lit.
bool is_lit(const Mesh& mesh, std::size_t triangle) {
  return std::ranges::all_of(mesh.triangles[triangle], [&mesh](std::uint32_t v) {
    return mesh.vertices[v].normal != Vec3{} && mesh.materials[mesh.vertices[v].material].has_header_light;
  });
}

/// Of a part whose vertices are lit, one.
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

/// Normals in eye space. Of a triangle of two sides that shows its back at all corners they are turned over, on copies of its
/// vertices; where corners differ, as at an outline, they stay.
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
  scene.vertices.reserve(mesh.vertices.size());
  const VertexTransform to_clip_space(view, projection, options.transform);
  for (const MeshVertex& in : mesh.vertices) {
    const Vec4 clip = to_clip_space.clip(in.position);
    const Vertex out{clip[0], clip[1], clip[2], clip[3], in.rgba, in.u, in.v};
    if (!finite(out)) throw InputError("--camera: a vertex leaves binary64; bring eye and fov nearer to the mesh");
    scene.vertices.push_back(out);
  }
  const auto colors = lit_colors(mesh, options.light, view, camera.ortho > 0);
  for (std::size_t i = 0; i < colors.size(); ++i) scene.vertices[i].rgba = colors[i];
  const std::size_t corners = mesh.triangles.size() * 3;  // the indices of lines and points follow those of triangles
  scene.indices.reserve(corners + mesh.indices.size());
  for (const auto& triangle : mesh.triangles) {
    scene.indices.insert(scene.indices.end(), triangle.begin(), triangle.end());
  }
  scene.indices.insert(scene.indices.end(), mesh.indices.begin(), mesh.indices.end());
  const bool is_phong = options.light.is_phong && !options.light.is_off;
  if (is_phong) set_normals(mesh, view, camera.ortho > 0, scene);
  // Object 0 of a scene is the unnamed one; a mesh's own unnamed part becomes it.
  std::vector<std::uint32_t> numbers;
  for (const std::string& name : mesh.objects) {
    numbers.push_back(name.empty() ? 0 : static_cast<std::uint32_t>(scene.objects.size()));
    if (!name.empty()) scene.objects.push_back(name);
  }
  const Mat4 to_clip = product(projection, view);
  scene.textures = mesh.textures;
  using Look = std::tuple<bool, std::optional<MeshSampler>, AlphaMode, double, std::optional<std::uint32_t>>;
  std::map<Look, std::uint32_t> states{{{false, std::nullopt, AlphaMode::opaque, 0.0, std::nullopt}, 0}};
  std::vector<std::uint8_t> outside;
  const std::vector<ObjectBounds> bounds = object_bounds(mesh);
  for (const ObjectBounds& object : bounds) outside.push_back(outside_view(object, to_clip));
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
      const std::size_t first = is_filled ? run.first * 3 : corners + run.first;
      const std::size_t count = is_filled ? run.count * 3 : run.count;
      scene.commands.push_back(Draw{state->second, object, part.topology, first, count, part.line, is_outside});
    }
  }
  return scene;
}

}  // namespace halfplane
