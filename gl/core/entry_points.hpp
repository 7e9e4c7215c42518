// The functions that programs call, by name.
#pragma once

#include <string_view>

namespace halfplane::gl {

/// The function of an OpenGL 1.5 command, of one of its ARB and EXT names, or of OpenGL ES-CM 1.0; null: none. To be called
/// with the type that gl.xml gives it. Without a current context it does nothing and returns 0.
[[nodiscard]] const void* entry_point(std::string_view name);

}  // namespace halfplane::gl
