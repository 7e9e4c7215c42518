// The vendor library that libglvnd loads for EGL 1.5. libEGL keeps each thread's current context and which library a display
// belongs to; the rest is here. Platforms: X11, and surfaceless with pbuffers alone.
#include <utility>

#include "../core/entry_points.hpp"
#include "egl.hpp"

#include <glvnd/libeglabi.h>

namespace halfplane::gl::egl {

std::recursive_mutex& mutex() {
  static auto* const mutex = new std::recursive_mutex;  // threads may outlive main()
  return *mutex;
}
std::map<std::pair<void*, int>, std::unique_ptr<EglDisplay>>& displays() {
  static auto* const displays = new std::map<std::pair<void*, int>, std::unique_ptr<EglDisplay>>;
  return *displays;
}

namespace {

EGLint get_error() { return std::exchange(t_state.error, EGL_SUCCESS); }

EGLBoolean get_supports_api(EGLenum api) {
  return api == EGL_OPENGL_API || api == EGL_OPENGL_ES_API ? EGL_TRUE : EGL_FALSE;
}

void* get_proc_address(const char* name) {
  if (std::string_view(name) == "eglGetError") return address(get_error);
  for (const auto table : {display_functions(), surface_functions(), context_functions()})
    if (const auto found = std::ranges::find(table, name, &Named::name); found != table.end()) return found->function;
  return const_cast<void*>(entry_point(name));
}

const char* get_vendor_string(int name) {
  return name == __EGL_VENDOR_STRING_PLATFORM_EXTENSIONS
             ? "EGL_EXT_platform_x11 EGL_KHR_platform_x11 EGL_MESA_platform_surfaceless"
             : nullptr;
}

// There are no extension functions to dispatch.
void* get_dispatch_address(const char*) { return nullptr; }
void set_dispatch_index(const char*, int) {}

}  // namespace
}  // namespace halfplane::gl::egl

extern "C" __attribute__((visibility("default"))) EGLBoolean __egl_Main(uint32_t version, const __EGLapiExports*,
                                                                        __EGLvendorInfo*, __EGLapiImports* imports) {
  namespace egl = halfplane::gl::egl;
  if (EGL_VENDOR_ABI_GET_MAJOR_VERSION(version) != EGL_VENDOR_ABI_MAJOR_VERSION || !halfplane::gl::answers("EGL"))
    return EGL_FALSE;
  imports->getPlatformDisplay = egl::get_platform_display;
  imports->getSupportsAPI = egl::get_supports_api;
  imports->getVendorString = egl::get_vendor_string;
  imports->getProcAddress = egl::get_proc_address;
  imports->getDispatchAddress = egl::get_dispatch_address;
  imports->setDispatchIndex = egl::set_dispatch_index;
  return EGL_TRUE;
}
