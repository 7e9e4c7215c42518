#include "sim/study/bench/mesa_gl.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace halfplane::gl {
namespace {

using AnyFunction = void (*)();
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

/// Sets each function by its name.
class Finder {
 public:
  explicit Finder(GetProcAddress get) : get_(get) {}

  template <class F>
  void operator()(F& function, const char* name) const {
    const AnyFunction found = get_(name);
    if (found == nullptr)
      throw std::runtime_error("llvmpipe: libOSMesa has no " + std::string(name) + "; install Mesa 22.3 or newer");
    function = reinterpret_cast<F>(found);
  }

 private:
  GetProcAddress get_;
};

void find_state_functions(const Finder& find, Functions& f) {
  find(f.get_string, "glGetString");
  find(f.get_error, "glGetError");
  find(f.enable, "glEnable");
  find(f.disable, "glDisable");
  find(f.viewport_indexedf, "glViewportIndexedf");
  find(f.depth_range, "glDepthRange");
  find(f.depth_func, "glDepthFunc");
  find(f.depth_mask, "glDepthMask");
  find(f.color_mask, "glColorMask");
  find(f.blend_func_separate, "glBlendFuncSeparate");
  find(f.blend_equation_separate, "glBlendEquationSeparate");
  find(f.blend_color, "glBlendColor");
  find(f.logic_op, "glLogicOp");
  find(f.stencil_func_separate, "glStencilFuncSeparate");
  find(f.stencil_op_separate, "glStencilOpSeparate");
  find(f.stencil_mask_separate, "glStencilMaskSeparate");
  find(f.cull_face, "glCullFace");
  find(f.front_face, "glFrontFace");
  find(f.scissor, "glScissor");
  find(f.polygon_mode, "glPolygonMode");
  find(f.polygon_offset, "glPolygonOffset");
  find(f.line_width, "glLineWidth");
  find(f.point_size, "glPointSize");
  find(f.provoking_vertex, "glProvokingVertex");
  find(f.clip_control, "glClipControl");
  find(f.primitive_restart_index, "glPrimitiveRestartIndex");
  find(f.use_program, "glUseProgram");
  find(f.bind_texture, "glBindTexture");
  find(f.tex_parameteri, "glTexParameteri");
  find(f.tex_parameterf, "glTexParameterf");
}

void find_work_functions(const Finder& find, Functions& f) {
  find(f.clear_color, "glClearColor");
  find(f.clear_depth, "glClearDepth");
  find(f.clear_stencil, "glClearStencil");
  find(f.clear, "glClear");
  find(f.finish, "glFinish");
  find(f.read_pixels, "glReadPixels");
  find(f.draw_elements, "glDrawElements");
  find(f.gen_buffers, "glGenBuffers");
  find(f.gen_textures, "glGenTextures");
  find(f.tex_image_2d, "glTexImage2D");
  find(f.bind_buffer, "glBindBuffer");
  find(f.buffer_data, "glBufferData");
  find(f.gen_vertex_arrays, "glGenVertexArrays");
  find(f.bind_vertex_array, "glBindVertexArray");
  find(f.vertex_attrib_pointer, "glVertexAttribPointer");
  find(f.enable_vertex_attrib_array, "glEnableVertexAttribArray");
  find(f.create_shader, "glCreateShader");
  find(f.shader_source, "glShaderSource");
  find(f.compile_shader, "glCompileShader");
  find(f.get_shaderiv, "glGetShaderiv");
  find(f.create_program, "glCreateProgram");
  find(f.attach_shader, "glAttachShader");
  find(f.link_program, "glLinkProgram");
  find(f.get_programiv, "glGetProgramiv");
  find(f.gen_renderbuffers, "glGenRenderbuffers");
  find(f.bind_renderbuffer, "glBindRenderbuffer");
  find(f.renderbuffer_storage, "glRenderbufferStorage");
  find(f.renderbuffer_storage_multisample, "glRenderbufferStorageMultisample");
  find(f.gen_framebuffers, "glGenFramebuffers");
  find(f.bind_framebuffer, "glBindFramebuffer");
  find(f.framebuffer_renderbuffer, "glFramebufferRenderbuffer");
  find(f.check_framebuffer_status, "glCheckFramebufferStatus");
  find(f.blit_framebuffer, "glBlitFramebuffer");
}

}  // namespace

Functions start_osmesa() {
  void* library = open_osmesa();
  const auto create = symbol<void* (*)(const int*, void*)>(library, "OSMesaCreateContextAttribs");
  const auto make_current = symbol<unsigned char (*)(void*, void*, Enum, int, int)>(library, "OSMesaMakeCurrent");
  const Finder find(symbol<GetProcAddress>(library, "OSMesaGetProcAddress"));
  const std::vector<int> attributes{
      kOsFormat, static_cast<int>(kRgba), kOsDepthBits, 0, kOsProfile, kOsCoreProfile, kOsMajor, 3, kOsMinor, 3, 0};
  void* context = create(attributes.data(), nullptr);
  static std::vector<std::uint8_t> window(4UL * 16 * 16);  // required; frames go to a framebuffer object
  if (context == nullptr || make_current(context, window.data(), kUnsignedByte, 16, 16) == 0)
    throw std::runtime_error("llvmpipe: libOSMesa gives no OpenGL 3.3 context; install Mesa 22.3 or newer");
  Functions functions{};
  find_state_functions(find, functions);
  find_work_functions(find, functions);
  return functions;
}

}  // namespace halfplane::gl
