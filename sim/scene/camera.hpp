// Cameras: the option `--camera`, the default framing for its missing parts, and the matrices. Right-handed, looking
// along -z in eye space; clip space as OpenGL has it: +y up, z in -w...w. All in binary64.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/scene/mesh.hpp"

namespace halfplane {

using Vec4 = std::array<double, 4>;
using Mat4 = std::array<Vec4, 4>;  ///< four rows; points are columns

/// What a user asked for. What is left out is framed.
struct CameraRequest {
  std::optional<Vec3> eye, target, up;
  std::optional<double> fov;        ///< vertical, degrees
  std::optional<double> ortho;      ///< height of the view in world units: orthographic instead of fov
  std::optional<double> near, far;  ///< distances along the view; far may be infinite with fov
  std::optional<double> orbit;  ///< degrees by which the eye is turned about `up` through the target, counter-clockwise
  std::optional<std::string> name;  ///< a camera of the file's own, which gives what the rest leaves out
  bool operator==(const CameraRequest&) const = default;
};

/// A complete, valid camera.
struct Camera {
  Vec3 eye{}, target{}, up{0, 1, 0};
  double fov = 45;               ///< vertical, degrees, in (0, 180)
  double ortho = 0;              ///< height of an orthographic view; 0 for perspective
  double near = 0.1, far = 100;  ///< distances along the view, 0 < near < far (perspective: far may be infinite)
};

/// Reads `eye=0,1,3;target=0,0,0;up=0,1,0;fov=45;near=.1;far=100` or `ortho=2`; empty asks for nothing. `name=NAME`
/// asks for a camera of the file's own; `orbit=DEGREES` turns it, `orbit` alone once round. Throws InputError that names the
/// part and the mend.
[[nodiscard]] CameraRequest parse_camera(std::string_view text);

/// `request`, with what it leaves out taken from `defaults`. A user's fov or ortho replaces either default;
/// an orthographic view takes no infinite far.
[[nodiscard]] CameraRequest merged(const CameraRequest& request, const CameraRequest& defaults);

/// Fills a request in for a mesh with at least one vertex: a three-quarter view (from the front, right and above) of
/// the middle of its bounding box, as near as holds every vertex at this aspect (width / height); near and far just
/// around the mesh. An `up` along the view is replaced. With an orbit the framed distance holds every vertex from any side,
/// so that it stays the same all the way round. Throws InputError if the whole makes no camera: eye = target,
/// near >= far; or asks for a name, which whoever has named cameras has looked up before.
[[nodiscard]] Camera frame(const CameraRequest& request, const Mesh& mesh, double aspect);

[[nodiscard]] Mat4 view_matrix(const Camera& camera);
[[nodiscard]] Mat4 projection_matrix(const Camera& camera, double aspect);
[[nodiscard]] Mat4 product(const Mat4& left, const Mat4& right);
[[nodiscard]] Vec4 transform(const Mat4& matrix, const Vec4& point);

}  // namespace halfplane
