// The animations of a glTF file: how the transforms of its nodes change with time.
#pragma once

#include "sim/scene/gltf_file.hpp"

namespace halfplane {

/// Translation times rotation times scale. A rotation is a quaternion x, y, z, w of length 1.
struct NodeTransform {
  std::array<double, 3> translation{};
  std::array<double, 4> rotation{0, 0, 0, 1};
  std::array<double, 3> scale{1, 1, 1};
};

/// The animation of one part of one node's transform, or of the weight of one of its morph targets.
struct GltfTrack {
  enum class Path : std::uint8_t { translation, rotation, scale, weight };
  enum class Interpolation : std::uint8_t { step, linear, cubic_spline };

  std::size_t node = 0;  ///< in the file's list of nodes
  Path path = Path::translation;
  std::size_t target = 0;  ///< morph target of a weight
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< of the keyframes, seconds, ascending; at least one
  std::vector<std::array<double, 4>>
      values;  ///< one per keyframe, a weight in the first component; for a cubic spline in-tangent, value, out-tangent
};

struct GltfAnimation {
  std::vector<GltfTrack> tracks;
  double end = 0;  ///< of its last keyframe, seconds
};

/// The animation with this name or number, the first for an empty one. Throws InputError when there is none.
[[nodiscard]] std::size_t choose_animation(const GltfFile& file, const std::string& name);

/// Reads entry `number` of the list of animations. Unsupported tracks (pointers) are left out; a channel of weights is
/// a track for each morph target. Throws InputError "file: place: the error; the remedy".
[[nodiscard]] GltfAnimation read_animation(GltfFile& file, std::size_t number);

/// The value of a track at a time, a rotation normalised to length 1: constant before its first and after its last
/// keyframe (glTF 2.0, 3.11 and appendix C; LINEAR rotations follow the shorter arc at constant speed).
[[nodiscard]] std::array<double, 4> value_at(const GltfTrack& track, double time);

/// Sets the value of `track` at a time in the transform of its node; a weight does not change the transform.
void apply(const GltfTrack& track, double time, NodeTransform& transform);

}  // namespace halfplane
