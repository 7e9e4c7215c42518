#include "sim/study/bench/mesa_gl.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace halfplane::gl {
namespace {

using GetProcAddress = AnyFunction (*)(const char*);

void* open_osmesa() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  throw std::runtime_error("llvmpipe: libOSMesa.so.8 cannot be loaded; install libosmesa6 or leave llvmpipe out");
}

template <class F>
F symbol(void* library, const char* name) {
  void* address = dlsym(library, name);
  if (address == nullptr)
    throw std::runtime_error("llvmpipe: libOSMesa has no " + std::string(name) + "; install Mesa 22.3 or newer");
  return reinterpret_cast<F>(address);
}

}  // namespace

Finder::Found Finder::operator()(const char* name) const {
  const AnyFunction found = get_(name);
  if (found == nullptr)
    throw std::runtime_error("llvmpipe: libOSMesa has no " + std::string(name) + "; install Mesa 22.3 or newer");
  return {found};
}

Functions start_osmesa() {
  void* library = open_osmesa();
  const auto create = symbol<void* (*)(const int*, void*)>(library, "OSMesaCreateContextAttribs");
  const auto make_current = symbol<unsigned char (*)(void*, void*, Enum, int, int)>(library, "OSMesaMakeCurrent");
  const Finder find(symbol<GetProcAddress>(library, "OSMesaGetProcAddress"));
  // GL_POINT_SMOOTH, GL_POINT_SPRITE and GL_CLAMP are of the compatibility profile alone.
  const std::vector<int> attributes{kOsFormat,
                                    static_cast<int>(kRgba),
                                    kOsDepthBits,
                                    0,
                                    kOsProfile,
                                    kOsCompatibilityProfile,
                                    kOsMajor,
                                    3,
                                    kOsMinor,
                                    3,
                                    0};
  void* context = create(attributes.data(), nullptr);
  static std::vector<std::uint8_t> window(4UL * 16 * 16);  // required; frames go to a framebuffer object
  if (context == nullptr || make_current(context, window.data(), kUnsignedByte, 16, 16) == 0)
    throw std::runtime_error("llvmpipe: libOSMesa gives no OpenGL 3.3 context; install Mesa 22.3 or newer");
  return {find};
}

}  // namespace halfplane::gl
