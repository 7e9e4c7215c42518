// A context with a drawable of 64x64 pixels without a window, and the entry points by name.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <gtest/gtest.h>

#include <array>

#include "../../gl/core/context.hpp"
#include "../../gl/core/entry_points.hpp"

// The entry point of that name, with its type.
#define HALFPLANE_GL(name) (reinterpret_cast<decltype(&::name)>(const_cast<void*>(halfplane::gl::entry_point(#name))))

namespace halfplane::gl {

class EntryPointCase : public testing::Test {
 protected:
  EntryPointCase() { make_current(&context, &drawable, &drawable); }
  ~EntryPointCase() override { make_current(nullptr, nullptr, nullptr); }

  GLenum error() { return HALFPLANE_GL(glGetError)(); }
  template <std::size_t N>
  std::array<float, N> floats(GLenum pname) {
    std::array<float, N> values{};
    HALFPLANE_GL(glGetFloatv)(pname, values.data());
    return values;
  }
  int integer(GLenum pname) {
    int value = -77;
    HALFPLANE_GL(glGetIntegerv)(pname, &value);
    return value;
  }

  Drawable drawable{Options{}, 64, 64};
  Context context;
};

}  // namespace halfplane::gl
