// Cameras: the option `--camera`, the default framing for its missing parts, and the matrices. Right-handed, looking
// along -z in eye space; clip space as in OpenGL: +y up, z in -w...w. All in binary64.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/scene/mesh.hpp"

namespace halfplane {

using Vec4 = std::array<double, 4>;
using Mat4 = std::array<Vec4, 4>;  ///< four rows; points are columns

/// A user's request. Missing parts are framed.
struct CameraRequest {
  std::optional<Vec3> eye, target, up;
  std::optional<double> fov;        ///< vertical, degrees
  std::optional<double> ortho;      ///< height of the view in world units: orthographic instead of fov
  std::optional<double> near, far;  ///< distances along the view; far may be infinite with fov
  std::optional<double> orbit;  ///< degrees by which the eye is rotated about `up` around the target, counter-clockwise
  std::optional<std::string> name;  ///< a camera of the file, which supplies missing parts
  bool operator==(const CameraRequest&) const = default;
};

/// A complete, valid camera.
struct Camera {
  Vec3 eye{}, target{}, up{0, 1, 0};
  double fov = 45;               ///< vertical, degrees, in (0, 180)
  double ortho = 0;              ///< height of an orthographic view; 0 for perspective
  double near = 0.1, far = 100;  ///< distances along the view, 0 < near < far (perspective: far may be infinite)
};

/// Reads `eye=0,1,3;target=0,0,0;up=0,1,0;fov=45;near=.1;far=100` or `ortho=2`; empty: all parts are framed.
/// `name=NAME` selects a camera of the file; `orbit=DEGREES` rotates it, `orbit` alone by a full turn. Throws
/// InputError that names the part and the remedy.
[[nodiscard]] CameraRequest parse_camera(std::string_view text);

/// `request`, with missing parts from `defaults`. A user's fov or ortho replaces either default; an orthographic view
/// has no infinite far.
[[nodiscard]] CameraRequest merged(const CameraRequest& request, const CameraRequest& defaults);

/// Completes a request for a mesh with at least one vertex: a three-quarter view (from the front, right and above) of
/// the centre of its bounding box, as near as possible with every vertex in view at this aspect (width / height); near
/// and far just around the mesh. An `up` along the view is replaced. With an orbit the framed distance keeps every
/// vertex in view from any side, so that it is constant over the orbit. Throws InputError if the result is no camera:
/// eye = target, near >= far; or if it names a camera, since names must have been resolved before.
[[nodiscard]] Camera frame(const CameraRequest& request, const Mesh& mesh, double aspect);

[[nodiscard]] Mat4 view_matrix(const Camera& camera);
[[nodiscard]] Mat4 projection_matrix(const Camera& camera, double aspect);
[[nodiscard]] Mat4 product(const Mat4& left, const Mat4& right);
[[nodiscard]] Vec4 transform(const Mat4& matrix, const Vec4& point);

}  // namespace halfplane
