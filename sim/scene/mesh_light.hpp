// Light on meshes: at the eye, from the file, or from --light; colours of vertices by model/light.hpp.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "model/light.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh.hpp"

namespace halfplane {

/// A user's request. Empty: the file's own lights, or without any the header light.
struct LightRequest {
  bool is_off = false;          ///< colours are shown unlit
  std::optional<Vec3> ambient;  ///< ambient light, full intensity is 1
  std::vector<Light> lights;    ///< in world space
  std::vector<Light> at_eye;    ///< lights fixed to the eye
  bool is_phong = false;        ///< fragments are lit, not vertices
  [[nodiscard]] bool is_given() const { return is_off || is_phong || ambient || !lights.empty() || !at_eye.empty(); }
};

/// Reads the values of --light, each a light: `off`; `eye`; `from=X,Y,Z`, its direction; `at=X,Y,Z`, its place; the
/// last three may be followed by `;color=R,G,B` (full is 1), `at` also by `;range=R` and `;attenuation=C,L,Q`.
/// `ambient=R,G,B` replaces ambient light; `phong` lights fragments. Throws InputError that names the part and the
/// remedy.
[[nodiscard]] LightRequest parse_lights(std::span<const std::string> texts);

/// The colours of a mesh's vertices seen through the camera's `view`: 0...255, opacity unchanged. `is_ortho`: the eye
/// is infinitely far.
[[nodiscard]] std::vector<std::array<double, 4>> lit_colors(const Mesh& mesh, const LightRequest& request,
                                                            const Mat4& view, bool is_ortho);

/// The state of a material that is lit by fragments: `state` with `shade phong` and the only, infinitely distant light,
/// in eye space; summed in display codes. Throws InputError for any other lights.
[[nodiscard]] State phong_state(State state, const Mesh& mesh, const MeshMaterial& material,
                                const LightRequest& request, const Mat4& view);

/// The factor of a mesh's lights that makes a white surface white where the light is stronger than at 19 of 20
/// vertices: files give intensities in candela and lux. 1 without lights or normals.
[[nodiscard]] double exposure_of(const Mesh& mesh);

/// The linear component, 0...1, of an sRGB display code, 0...255: display_code()'s inverse.
[[nodiscard]] double linear_component(double code);

/// A linear colour component of 0...1 (clamped) as an sRGB display code, 0...255, not rounded (IEC 61966-2-1).
[[nodiscard]] double display_code(double linear);

}  // namespace halfplane
