#include "sim/scene/gltf_nodes.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "model/as_number.hpp"
#include "model/config.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr Mat4 kIdentity{Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}, Vec4{0, 0, 0, 1}};

// A list of exactly N numbers, each within kLargestCoordinate.
template <std::size_t N>
std::array<double, N> numbers_of(const JsonPlace& place) {
  if (place.size() != N) place.fail(std::to_string(place.size()) + " numbers", "write " + std::to_string(N));
  std::array<double, N> result{};
  for (std::size_t i = 0; i < N; ++i) {
    result[i] = place[i].number();
    if (std::abs(result[i]) > kLargestCoordinate) place[i].fail("beyond +-1e30", "choose a smaller number");
  }
  return result;
}

// A quaternion x, y, z, w, normalised to length 1: exporters write binary32.
constexpr std::uint64_t kMostCopies = std::uint64_t{1} << 20;

std::array<double, 4> unit_rotation(std::array<double, 4> q, const JsonPlace& place) {
  const double norm = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  if (!(norm > 0)) place.fail("a rotation of length 0", "write 0, 0, 0, 1 for none");
  for (double& part : q) part /= norm;
  return q;
}

std::array<double, 4> read_rotation(const JsonPlace& place) { return unit_rotation(numbers_of<4>(place), place); }

Mat4 rotation_matrix(const std::array<double, 4>& q) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {Vec4{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
          Vec4{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
          Vec4{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}, Vec4{0, 0, 0, 1}};
}

Mat4 matrix_of(const NodeTransform& local) {
  Mat4 result = rotation_matrix(local.rotation);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) result[row][column] *= local.scale[column];
    result[row][3] = local.translation[row];
  }
  return result;
}

// matrix (16 numbers, column by column), or translation x rotation x scale, each of them optional.
void read_local(const JsonPlace& place, GltfNode& node) {
  const std::optional<JsonPlace> matrix = place.find("matrix"), translation = place.find("translation"),
                                 rotation = place.find("rotation"), scale = place.find("scale");
  if (matrix) {
    if (translation || rotation || scale) place.fail("a matrix besides translation, rotation or scale", "keep one");
    const std::array<double, 16> m = numbers_of<16>(*matrix);
    Mat4& result = node.matrix.emplace();
    for (std::size_t i = 0; i < 16; ++i) result[i % 4][i / 4] = m[i];
    if (result[3] != kIdentity[3]) matrix->fail("a last row that is not 0, 0, 0, 1", "export the file again");
    return;
  }
  if (translation) node.local.translation = numbers_of<3>(*translation);
  if (rotation) node.local.rotation = read_rotation(*rotation);
  if (scale) node.local.scale = numbers_of<3>(*scale);
}

Vec3 column(const Mat4& m, std::size_t i) { return {m[0][i], m[1][i], m[2][i]}; }

double positive(const JsonPlace& lens, const char* key) {
  const double value = lens.at(key).number();
  if (!(value > 0) || value > kLargestCoordinate) lens.at(key).fail("not a number above 0", "choose one up to 1e30");
  return value;
}

// near, far and the lens. The width follows from the target's aspect, so that the picture is not stretched.
void read_lens(const JsonPlace& camera, CameraRequest& request) {
  const std::string type = camera.at("type").text();
  if (type != "perspective" && type != "orthographic") {
    camera.fail("type " + in_quotes(type), "it is perspective or orthographic");
  }
  const JsonPlace lens = camera.at(type);
  if (type == "perspective") {
    request.fov = positive(lens, "yfov") * 180 / std::numbers::pi;
    if (!(*request.fov < 180)) lens.at("yfov").fail("not below pi", "choose an angle in radians");
    request.near = positive(lens, "znear");
    request.far = lens.find("zfar") ? positive(lens, "zfar") : std::numeric_limits<double>::infinity();
  } else {
    request.ortho = 2 * positive(lens, "ymag");
    request.near = lens.at("znear").number();
    if (*request.near < 0) lens.at("znear").fail("below 0", "choose 0 or more");
    request.far = positive(lens, "zfar");
  }
  if (!(*request.near < *request.far)) lens.fail("znear is not nearer than zfar", "choose znear < zfar");
}

/// The light with the number given in a node; its colours are divided by pi, for scattering by a white surface.
Light read_light(const JsonPlace& place) {
  const std::string type = place.at("type").text();
  if (type != "directional" && type != "point" && type != "spot")
    place.fail("type " + in_quotes(type), "it is directional, point or spot");
  Light light;
  light.position = {0, 0, 0, 1};
  const double intensity = place.number_or("intensity", 1);
  if (!(intensity >= 0)) place.fail("an intensity below 0", "choose 0 or more");
  if (intensity > kLargestCoordinate) place.fail("an intensity beyond 1e30", "choose a smaller number");
  std::array<double, 3> color{1, 1, 1};
  if (const auto given = place.find("color")) color = numbers_of<3>(*given);
  for (std::size_t i = 0; i < 3; ++i)
    light.diffuse[i] = light.specular[i] = std::max(color[i], 0.0) * intensity / std::numbers::pi;
  if (type == "directional") {
    light.position = {0, 0, 1, 0};
    return light;
  }
  light.attenuation = {0, 0, 1};
  light.range = std::max(place.number_or("range", 0), 0.0);
  if (type == "point") return light;
  const std::optional<JsonPlace> spot = place.find("spot");
  const double outer = std::min(spot ? spot->number_or("outerConeAngle", std::numbers::pi / 4) : std::numbers::pi / 4,
                                std::numbers::pi / 2);
  const double inner = std::min(spot ? spot->number_or("innerConeAngle", 0) : 0, outer);
  if (inner < 0 || outer < 0) place.fail("an angle below 0", "correct innerConeAngle and outerConeAngle");
  light.spot_scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer));
  light.spot_offset = -std::cos(outer) * light.spot_scale;
  return light;
}

class Walker {
 public:
  Walker(GltfFile& file, std::vector<std::string>& warnings) : file_(file), warnings_(warnings) {}

  GltfNodes run() {
    reached_.assign(file_.count("nodes"), false);
    push_roots();
    while (!stack_.empty()) {
      const Entry entry = stack_.back();
      stack_.pop_back();
      visit(entry);
    }
    return std::move(result_);
  }

 private:
  struct Entry {
    std::size_t node = 0;               // in the file
    std::optional<std::size_t> parent;  // in result_.nodes
    bool is_hidden = false;
  };

  // The stack returns the last item pushed, so lists are pushed from their ends.
  void push_roots() {
    const std::size_t scenes = file_.count("scenes"), nodes = file_.count("nodes");
    if (scenes == 0) {
      std::vector<bool> is_child(nodes, false);
      for (std::size_t i = 0; i < nodes; ++i) {
        const std::optional<JsonPlace> children = file_.item("nodes", i).find("children");
        for (std::size_t k = 0; children && k < children->size(); ++k) {
          is_child[(*children)[k].index(nodes, "nodes")] = true;
        }
      }
      for (std::size_t i = nodes; i-- > 0;) {
        if (!is_child[i]) stack_.push_back({i, std::nullopt, false});
      }
      return;
    }
    const std::optional<JsonPlace> chosen = file_.root().find("scene");
    const std::size_t number = chosen ? chosen->index(scenes, "scenes") : 0;
    if (scenes > 1) {
      warnings_.push_back(file_.name() + ": scene " + std::to_string(number) + " of " + std::to_string(scenes) +
                          " is drawn, the file's default");
    }
    if (const std::optional<JsonPlace> roots = file_.item("scenes", number).find("nodes"))
      push(*roots, std::nullopt, false);
  }

  void push(const JsonPlace& list, std::optional<std::size_t> parent, bool is_hidden) {
    for (std::size_t i = list.size(); i-- > 0;)
      stack_.push_back({list[i].index(reached_.size(), "nodes"), parent, is_hidden});
  }

  void visit(const Entry& entry) {
    const JsonPlace node = file_.item("nodes", entry.node);
    if (reached_[entry.node]) node.fail("the child of two nodes, or its own ancestor", "give every node one parent");
    reached_[entry.node] = true;
    const std::size_t number = result_.nodes.size();
    GltfNode& made = result_.nodes.emplace_back();
    made.number = entry.node;
    made.parent = entry.parent;
    read_local(node, made);
    const auto visibility = node.extension("KHR_node_visibility");
    const bool is_hidden = entry.is_hidden || (visibility && !visibility->flag_or("visible", true));
    const std::optional<JsonPlace> mesh = node.find("mesh");
    if (mesh && !is_hidden) {
      const auto copies = node.extension("EXT_mesh_gpu_instancing");
      copies ? add_copies(*copies, node, *mesh, number) : add_mesh(node, *mesh, number);
    }
    if (const std::optional<JsonPlace> index = node.find("camera")) add_camera(node, *index, number);
    if (const auto punctual = node.extension("KHR_lights_punctual"); punctual && !is_hidden)
      add_light(punctual->at("light"), number);
    if (const std::optional<JsonPlace> children = node.find("children")) push(*children, number, is_hidden);
  }

  void add_mesh(const JsonPlace& node, const JsonPlace& index, std::size_t number) {
    const std::size_t mesh = index.index(file_.count("meshes"), "meshes");
    const std::string name = node.text_or("name", file_.item("meshes", mesh).text_or("name", ""));
    GltfInstance& instance = result_.instances.emplace_back(GltfInstance{mesh, number, name, {}});
    if (const std::optional<JsonPlace> skin = node.find("skin"))
      instance.skin = skin->index(file_.count("skins"), "skins");
  }

  // EXT_mesh_gpu_instancing: the mesh once for each element of the attributes, each as a child node.
  void add_copies(const JsonPlace& copies, const JsonPlace& node, const JsonPlace& index, std::size_t number) {
    const JsonPlace attributes = copies.at("attributes");
    const auto accessor = [&](std::string_view name, int width) -> const GltfAccessor* {
      const std::optional<JsonPlace> given = attributes.find(name);
      if (!given) return nullptr;
      const GltfAccessor& found = file_.accessor(*given);
      if (found.width != width)
        given->fail("elements of " + std::to_string(found.width) + " numbers",
                    "it has " + std::to_string(width) + " each");
      return &found;
    };
    const std::array all{accessor("TRANSLATION", 3), accessor("ROTATION", 4), accessor("SCALE", 3)};
    std::optional<std::uint64_t> count;
    for (const GltfAccessor* const of : all) {
      if (of == nullptr) continue;
      if (count && *count != of->count) attributes.fail("attributes of different counts", "export the file again");
      count = of->count;
    }
    if (!count) return add_mesh(node, index, number);
    if (*count > kMostCopies)
      attributes.fail(std::to_string(*count) + " instances", "draw at most " + std::to_string(kMostCopies));
    for (std::uint64_t i = 0; i < *count; ++i) {
      GltfNode& made = result_.nodes.emplace_back();
      made.number = result_.nodes[number].number;
      made.parent = number;
      made.is_copy = true;
      const auto three = [i](const GltfAccessor& of) {
        const auto e = read_element(of, i);
        return std::array{e[0], e[1], e[2]};
      };
      if (all[0] != nullptr) made.local.translation = three(*all[0]);
      if (all[1] != nullptr) made.local.rotation = unit_rotation(read_element(*all[1], i), attributes);
      if (all[2] != nullptr) made.local.scale = three(*all[2]);
      add_mesh(node, index, result_.nodes.size() - 1);
    }
  }

  void add_light(const JsonPlace& index, std::size_t number) {
    const auto punctual = file_.root().extension("KHR_lights_punctual");
    const auto lights = punctual ? punctual->find("lights") : std::nullopt;
    if (!lights) index.fail("a light of a file without KHR_lights_punctual.lights", "export the file again");
    result_.lights.push_back({number, read_light((*lights)[index.index(lights->size(), "lights")])});
  }

  void add_camera(const JsonPlace& node, const JsonPlace& index, std::size_t number) {
    GltfCameraNode& made = result_.cameras.emplace_back();
    made.number = index.index(file_.count("cameras"), "cameras");
    const JsonPlace camera = file_.item("cameras", made.number);
    made.name = camera.text_or("name", "");
    made.node_name = node.text_or("name", "");
    made.node = number;
    read_lens(camera, made.lens);
  }

  GltfFile& file_;
  std::vector<std::string>& warnings_;
  std::vector<Entry> stack_;
  std::vector<bool> reached_;
  GltfNodes result_;
};

bool is_called(const GltfCamera& camera, const std::string& name) {
  return camera.name == name || camera.node_name == name;
}

}  // namespace

GltfNodes walk_nodes(GltfFile& file, std::vector<std::string>& warnings) { return Walker(file, warnings).run(); }

std::vector<Mat4> world_matrices(const GltfFile& file, const GltfNodes& nodes, const GltfAnimation* animation,
                                 double time) {
  std::vector<std::size_t> place(file.count("nodes"), nodes.nodes.size());  // index in nodes.nodes, by the file's node
  std::vector<NodeTransform> locals;
  locals.reserve(nodes.nodes.size());
  for (const GltfNode& node : nodes.nodes) {
    if (!node.is_copy) place[node.number] = locals.size();
    locals.push_back(node.local);
  }
  if (animation != nullptr) {
    for (const GltfTrack& track : animation->tracks) {
      if (place[track.node] < locals.size()) apply(track, time, locals[place[track.node]]);
    }
  }
  std::vector<Mat4> world;
  world.reserve(nodes.nodes.size());
  for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
    const GltfNode& node = nodes.nodes[i];
    const Mat4 local = node.matrix ? *node.matrix : matrix_of(locals[i]);
    world.push_back(product(node.parent ? world[*node.parent] : kIdentity, local));
    for (const Vec4& row : world.back()) {
      for (const double number : row) {
        if (!(std::abs(number) <= kLargestCoordinate))
          file.item("nodes", node.number).fail("its place in the world is beyond 1e30", "move it");
      }
    }
  }
  return world;
}

std::vector<GltfCamera> placed_cameras(const GltfFile& file, const GltfNodes& nodes, const std::vector<Mat4>& world) {
  std::vector<GltfCamera> result;
  for (const GltfCameraNode& camera : nodes.cameras) {
    const Mat4& matrix = world[camera.node];
    const Vec3 eye = column(matrix, 3), back = normalized(column(matrix, 2)), up = normalized(column(matrix, 1));
    if (back == Vec3{} || up == Vec3{}) {
      file.item("nodes", nodes.nodes[camera.node].number)
          .fail("a camera whose axes are scaled to 0", "scale its node by 1");
    }
    GltfCamera& made = result.emplace_back(GltfCamera{camera.name, camera.node_name, camera.number, camera.lens});
    made.request.eye = eye;
    // Far enough away that a target at an eye far from the origin is exact in binary64.
    made.request.target = subtract(eye, scaled(back, std::max(1.0, length(eye))));
    made.request.up = up;
  }
  return result;
}

std::vector<Light> placed_lights(const GltfNodes& nodes, const std::vector<Mat4>& world) {
  std::vector<Light> result;
  for (const GltfLightNode& at : nodes.lights) {
    const Mat4& matrix = world[at.node];
    const Vec3 back = normalized(column(matrix, 2)), place = column(matrix, 3);
    Light& light = result.emplace_back(at.light);
    light.spot_direction = scaled(back, -1);
    light.position = light.position[3] == 0 ? std::array{back[0], back[1], back[2], 0.0}
                                            : std::array{place[0], place[1], place[2], 1.0};
  }
  return result;
}

CameraRequest choose_camera(const std::vector<GltfCamera>& cameras, const CameraRequest& request) {
  if (!request.name) return request == CameraRequest() && !cameras.empty() ? cameras.front().request : request;
  if (cameras.empty()) return request;  // frame() reports that there are none
  const std::string& name = *request.name;
  auto found = std::find_if(cameras.begin(), cameras.end(), [&](const GltfCamera& c) { return is_called(c, name); });
  if (found == cameras.end()) {  // many exporters give no names
    const auto number = as_number<std::size_t>(name);
    found = std::find_if(cameras.begin(), cameras.end(), [&](const GltfCamera& c) { return c.number == number; });
  }
  if (found == cameras.end()) {
    std::string names;
    for (const GltfCamera& camera : cameras) {
      const std::string& shown = camera.name.empty() ? camera.node_name : camera.name;
      names += (names.empty() ? "" : ", ") + (shown.empty() ? std::to_string(camera.number) : printable(shown));
      if (names.size() > 200) break;
    }
    throw InputError("--camera: no camera " + in_quotes(name) + " in this scene; there are " + names);
  }
  CameraRequest rest = request;
  rest.name.reset();
  return merged(rest, found->request);
}

}  // namespace halfplane
