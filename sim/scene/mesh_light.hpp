// Light on meshes: at the eye, from the file, or from --light; colours of vertices by model/light.hpp.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "model/light.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh.hpp"

namespace halfplane {

/// What a user asked for. Nothing: the file's own lights, or without any the header light.
struct LightRequest {
  bool is_off = false;          ///< colours are shown as they are
  std::optional<Vec3> ambient;  ///< from everywhere, 1 for full
  std::vector<Light> lights;    ///< in world space
  std::vector<Light> at_eye;    ///< those that go with the eye
  bool is_phong = false;        ///< fragments are lit, not vertices
  [[nodiscard]] bool is_given() const { return is_off || is_phong || ambient || !lights.empty() || !at_eye.empty(); }
};

/// Reads what --light was given, each a light: `off`; `eye`; `from=X,Y,Z`, where it comes from; `at=X,Y,Z`, where it is;
/// behind the last three `;color=R,G,B` (1 is full), of `at` also `;range=R` and `;attenuation=C,L,Q`. `ambient=R,G,B`
/// replaces what comes from everywhere; `phong` lights fragments. Throws InputError that names the part and the mend.
[[nodiscard]] LightRequest parse_lights(std::span<const std::string> texts);

/// The colours of a mesh's vertices as `view` (of the camera) shows them: 0...255, opacity as it was. `is_ortho`: the eye
/// is infinitely far.
[[nodiscard]] std::vector<std::array<double, 4>> lit_colors(const Mesh& mesh, const LightRequest& request,
                                                            const Mat4& view, bool is_ortho);

/// The state of a material that is lit by fragments: `state` with `shade phong` and the one light from infinitely far that
/// there is, in eye space; added up in display codes. Throws InputError for any other lights.
[[nodiscard]] State phong_state(State state, const Mesh& mesh, const MeshMaterial& material,
                                const LightRequest& request, const Mat4& view);

/// By what the lights of a mesh are multiplied so that a white surface comes out white where the light is stronger than
/// at 19 of 20 vertices: files have them in candela and lux. 1 without lights or normals.
[[nodiscard]] double exposure_of(const Mesh& mesh);

/// Of an sRGB display code, 0...255, the linear component, 0...1: display_code()'s inverse.
[[nodiscard]] double linear_component(double code);

/// A linear colour component of 0...1 (clamped) as an sRGB display code, 0...255, not rounded (IEC 61966-2-1).
[[nodiscard]] double display_code(double linear);

}  // namespace halfplane
