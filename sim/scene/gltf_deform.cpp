#include "sim/scene/gltf_deform.hpp"

#include <algorithm>
#include <cmath>

#include "model/config.hpp"

namespace halfplane {
namespace {

const GltfAccessor& wide_accessor(GltfFile& file, const JsonPlace& index, int width, std::uint64_t least) {
  const GltfAccessor& accessor = file.accessor(index);
  if (accessor.width != width)
    index.fail("an accessor of " + std::to_string(accessor.width) + " numbers an element",
               width == 16 ? "use MAT4" : "use VEC" + std::to_string(width));
  if (accessor.count < least)
    index.fail(std::to_string(accessor.count) + " elements where " + std::to_string(least) + " are needed",
               "export the file again");
  return accessor;
}

/// Number of vertices: the positions of the primitive.
std::uint64_t vertices_of(GltfFile& file, const JsonPlace& primitive) {
  return file.accessor(primitive.at("attributes").at("POSITION")).count;
}

void read_joints(GltfFile& file, const JsonPlace& primitive, const GltfSkin& skin,
                 const std::vector<std::uint64_t>& sources, GltfDeformation& made) {
  const JsonPlace attributes = primitive.at("attributes");
  std::vector<std::pair<const GltfAccessor*, const GltfAccessor*>> sets;
  for (const char* number : {"0", "1"}) {  // eight joints a vertex
    const auto joints = attributes.find(std::string("JOINTS_") + number);
    const auto weights = attributes.find(std::string("WEIGHTS_") + number);
    if (!joints || !weights) break;
    const std::uint64_t count = vertices_of(file, primitive);
    sets.emplace_back(&wide_accessor(file, *joints, 4, count), &wide_accessor(file, *weights, 4, count));
  }
  if (sets.empty()) return;
  made.joints_of_vertex = 4 * sets.size();
  made.joints.reserve(made.joints_of_vertex * sources.size());
  for (const std::uint64_t source : sources) {
    const std::size_t first = made.joints.size();
    double sum = 0;
    for (const auto& [joints, weights] : sets) {
      const std::array<double, 4> joint = read_element(*joints, source), weight = read_element(*weights, source);
      for (std::size_t k = 0; k < 4; ++k) {
        const double part = std::max(weight[k], 0.0);  // a joint with weight 0 may be any number
        if (part > 0 && !(joint[k] >= 0 && joint[k] < static_cast<double>(skin.joints.size())))
          throw InputError(joints->place + ": element " + std::to_string(source) + " is a joint of " +
                           std::to_string(skin.joints.size()) + " that is not there; export the file again");
        made.joints.push_back({part > 0 ? static_cast<std::uint32_t>(joint[k]) : 0, part});
        sum += part;
      }
    }
    if (sum == 0) made.joints[first].weight = sum = 1;  // forbidden by the format
    for (std::size_t k = first; k < made.joints.size(); ++k) made.joints[k].weight /= sum;
  }
}

std::vector<Vec3> read_displacements(GltfFile& file, const std::optional<JsonPlace>& index, std::uint64_t count,
                                     const std::vector<std::uint64_t>& sources) {
  std::vector<Vec3> result;
  if (!index) return result;
  const GltfAccessor& accessor = wide_accessor(file, *index, 3, count);
  result.reserve(sources.size());
  for (const std::uint64_t source : sources) {
    const std::array<double, 4> element = read_element(accessor, source);
    result.push_back({element[0], element[1], element[2]});
  }
  return result;
}

}  // namespace

std::optional<GltfSkin> read_skin(GltfFile& file, const GltfNodes& nodes, std::size_t number) {
  const JsonPlace place = file.item("skins", number), joints = place.at("joints");
  if (joints.size() == 0) joints.fail("no joints", "export the file again");
  std::vector<std::size_t> at(file.count("nodes"), nodes.nodes.size());
  for (std::size_t i = 0; i < nodes.nodes.size(); ++i)
    if (!nodes.nodes[i].is_copy) at[nodes.nodes[i].number] = i;
  GltfSkin skin;
  const std::optional<JsonPlace> inverse = place.find("inverseBindMatrices");
  const GltfAccessor* matrices = inverse ? &wide_accessor(file, *inverse, 16, joints.size()) : nullptr;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::size_t node = at[joints[i].index(file.count("nodes"), "nodes")];
    if (node == nodes.nodes.size()) return std::nullopt;
    skin.joints.push_back(node);
    Mat4 matrix{Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}, Vec4{0, 0, 0, 1}};
    if (matrices != nullptr) {
      const std::array<double, 16> columns = read_matrix(*matrices, i);
      for (std::size_t k = 0; k < 16; ++k)
        if (k % 4 != 3) matrix[k % 4][k / 4] = columns[k];  // the last row is 0, 0, 0, 1
    }
    skin.inverse_bind.push_back(matrix);
  }
  return skin;
}

GltfDeformation read_deformation(GltfFile& file, const JsonPlace& primitive, const GltfInstance& instance,
                                 const GltfNodes& nodes, const GltfSkin* skin,
                                 const std::vector<std::uint64_t>& sources, bool has_normals) {
  GltfDeformation made;
  if (skin != nullptr) {
    read_joints(file, primitive, *skin, sources, made);
    if (made.joints_of_vertex > 0) made.skin = instance.skin;
  }
  const std::optional<JsonPlace> targets = primitive.find("targets");
  if (!targets) return made;
  const std::uint64_t count = vertices_of(file, primitive);
  std::optional<JsonPlace> weights = file.item("nodes", nodes.nodes[instance.node].number).find("weights");
  if (!weights) weights = file.item("meshes", instance.mesh).find("weights");
  for (std::size_t i = 0; i < targets->size(); ++i) {
    const JsonPlace target = (*targets)[i];
    MorphTarget& morph = made.targets.emplace_back();
    morph.positions = read_displacements(file, target.find("POSITION"), count, sources);
    if (has_normals) morph.normals = read_displacements(file, target.find("NORMAL"), count, sources);
    if (!weights || i >= weights->size()) continue;
    morph.weight = (*weights)[i].number();
    if (std::abs(morph.weight) > kLargestCoordinate) (*weights)[i].fail("beyond +-1e30", "choose a smaller number");
  }
  return made;
}

std::vector<double> morph_weights(const std::vector<MorphTarget>& targets, std::size_t node,
                                  const GltfAnimation* animation, double time) {
  std::vector<double> result;
  for (const MorphTarget& target : targets) result.push_back(target.weight);
  if (animation == nullptr) return result;
  for (const GltfTrack& track : animation->tracks)
    if (track.path == GltfTrack::Path::weight && track.node == node && track.target < result.size())
      result[track.target] = value_at(track, time)[0];
  return result;
}

std::vector<Mat4> joint_matrices(const GltfSkin& skin, const std::vector<Mat4>& world) {
  std::vector<Mat4> result;
  result.reserve(skin.joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i)
    result.push_back(product(world[skin.joints[i]], skin.inverse_bind[i]));
  return result;
}

Mat4 skin_matrix(const GltfDeformation& deformation, const std::vector<Mat4>& joints, std::size_t i) {
  Mat4 sum{};
  for (std::size_t k = 0; k < deformation.joints_of_vertex; ++k) {
    const JointWeight& part = deformation.joints[i * deformation.joints_of_vertex + k];
    if (part.weight == 0) continue;
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        sum[row][column] += part.weight * joints[part.joint][row][column];
  }
  return sum;
}

}  // namespace halfplane
