// Parameters by pname (glLight, glFog, glTexParameter, glPixelStore, ...): a place in the state, which is set and queried alike.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <variant>

#include "commands.hpp"

namespace halfplane::gl {

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();
inline constexpr double kFinite = std::numeric_limits<double>::max();  ///< a bound that leaves out NaN and infinity

/// Place of a parameter, and its legal values.
struct Place {
  std::variant<GLenum*, int*, bool*, double*, Vec3*, Vec4*, std::array<int, 4>*> where;
  std::span<const GLenum> allowed{};                       ///< of an enum
  ValueKind kind = ValueKind::real;                        ///< color: integers map linearly
  bool is_held = false;                                    ///< to 0...1
  double low = -kNoBound, high = kNoBound;                 ///< of a single number that is not held
  double also = std::numeric_limits<double>::quiet_NaN();  ///< is legal beside them
};

/// Sets a parameter, or reports the error. Whether it was set. `takes_scalars`: also vectors, whose rest is then 0.
bool set_parameter(Context& context, const std::optional<Place>& place, const Params& params,
                   bool takes_scalars = true);
[[nodiscard]] Values parameter(Context& context, const std::optional<Place>& place);

// None: no name of theirs. glGet queries the last five, too.
[[nodiscard]] std::optional<Place> light_place(Light& light, GLenum pname);            // light.cpp
[[nodiscard]] std::optional<Place> material_place(Material& material, GLenum pname);   // light.cpp
[[nodiscard]] std::optional<Place> texture_place(TextureParameters& t, GLenum pname);  // texture_state.cpp
[[nodiscard]] std::optional<Place> environment_place(TextureUnit& unit, GLenum target, GLenum pname);  // likewise
[[nodiscard]] std::optional<Place> generation_place(TextureUnit& unit, GLenum coord, GLenum pname);    // likewise
[[nodiscard]] std::optional<Place> fog_place(FogState& fog, GLenum pname);                             // light.cpp
[[nodiscard]] std::optional<Place> light_model_place(LightingState& lighting, GLenum pname);           // light.cpp
[[nodiscard]] std::optional<Place> point_place(PointState& point, GLenum pname);                       // vertex.cpp
[[nodiscard]] std::optional<Place> transfer_place(PixelState& pixel, GLenum pname);                    // pixels.cpp
[[nodiscard]] std::optional<Place> store_place(ClientState& client, GLenum pname);                     // pixels.cpp

}  // namespace halfplane::gl
