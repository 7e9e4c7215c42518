// The part of OpenGL 4.5 and OSMesa that MesaFrame uses, loaded from libOSMesa at run time: no header and no library is
// needed to build. Values and signatures as in the Khronos registry's gl.xml and Mesa's include/GL/osmesa.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace halfplane::gl {

using Enum = unsigned int;
using Name = unsigned int;

inline constexpr Enum kDepthBuffer = 0x100, kStencilBuffer = 0x400, kColorBuffer = 0x4000;  // masks of Clear
inline constexpr Enum kPoints = 0, kLines = 1, kLineLoop = 2, kLineStrip = 3;               // modes of DrawElements
inline constexpr Enum kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;                 // likewise
inline constexpr Enum kFront = 0x404, kBack = 0x405, kFrontAndBack = 0x408;                 // CullFace
inline constexpr Enum kCw = 0x900, kCcw = 0x901;                                            // FrontFace
inline constexpr Enum kPoint = 0x1b00, kLine = 0x1b01, kFill = 0x1b02;                      // PolygonMode
inline constexpr Enum kCullFace = 0xb44, kDepthTest = 0xb71, kDither = 0xbd0;               // Enable
inline constexpr Enum kScissorTest = 0xc11, kPrimitiveRestart = 0x8f9d;                     // likewise
inline constexpr Enum kPointSmooth = 0xb10, kLineSmooth = 0xb20, kPointSprite = 0x8861;     // likewise
inline constexpr Enum kBlend = 0xbe2, kColorLogicOp = 0xbf2, kStencilTest = 0xb90;          // likewise
inline constexpr Enum kOffsetPoint = 0x2a01, kOffsetLine = 0x2a02, kOffsetFill = 0x8037;
inline constexpr Enum kFirstVertex = 0x8e4d, kLastVertex = 0x8e4e;                        // ProvokingVertex
inline constexpr Enum kLowerLeft = 0x8ca1, kMinusOneToOne = 0x935e, kZeroToOne = 0x935f;  // ClipControl
inline constexpr Enum kUnsignedByte = 0x1401, kUnsignedInt = 0x1405, kFloat = 0x1406, kRgba = 0x1908;
inline constexpr Enum kTexture2d = 0xde1, kMagFilter = 0x2800, kMinFilter = 0x2801, kWrapS = 0x2802;
inline constexpr Enum kMinLod = 0x813a, kMaxLod = 0x813b, kLodBias = 0x8501, kMaxLevel = 0x813d;  // TexParameter
inline constexpr Enum kNearest = 0x2600, kLinear = 0x2601, kNearestMipmapNearest = 0x2700;  // three more follow it
inline constexpr Enum kRepeat = 0x2901, kClampToEdge = 0x812f, kMirroredRepeat = 0x8370;
inline constexpr Enum kClampToBorder = 0x812d, kClamp = 0x2900, kBorderColor = 0x1004;
inline constexpr Enum kRgba8 = 0x8058, kDepth16 = 0x81a5, kDepth24Stencil8 = 0x88f0;
inline constexpr Enum kRenderer = 0x1f01;
inline constexpr Enum kArrayBuffer = 0x8892, kElementBuffer = 0x8893, kStaticDraw = 0x88e4;
inline constexpr Enum kFragmentShader = 0x8b30, kVertexShader = 0x8b31, kCompiled = 0x8b81, kLinked = 0x8b82;
inline constexpr Enum kFramebuffer = 0x8d40, kRenderbuffer = 0x8d41, kComplete = 0x8cd5;
inline constexpr Enum kReadFramebuffer = 0x8ca8, kDrawFramebuffer = 0x8ca9;
inline constexpr Enum kColorAttachment = 0x8ce0, kDepthAttachment = 0x8d00, kDepthStencilAttachment = 0x821a;

// OSMesaCreateContextAttribs; each is followed by its value, the list ends with 0.
inline constexpr int kOsFormat = 0x22, kOsDepthBits = 0x30, kOsProfile = 0x33, kOsCompatibilityProfile = 0x35,
                     kOsMajor = 0x36, kOsMinor = 0x37;

using AnyFunction = void (*)();

/// Finds a function by its name, for a pointer of any type.
class Finder {
 public:
  explicit Finder(AnyFunction (*get)(const char*)) : get_(get) {}

  struct Found {
    AnyFunction function;
    template <class F>
    operator F*() const {  // NOLINT(google-explicit-constructor)
      return reinterpret_cast<F*>(function);
    }
  };
  /// Throws std::runtime_error where there is none.
  Found operator()(const char* name) const;

 private:
  AnyFunction (*get_)(const char*);
};

/// The functions, as in OpenGL without the prefix, in our naming style.
struct Functions {
  Finder find;
  const unsigned char* (*get_string)(Enum) = find("glGetString");
  Enum (*get_error)() = find("glGetError");
  void (*enable)(Enum) = find("glEnable");
  void (*disable)(Enum) = find("glDisable");
  void (*viewport_indexedf)(unsigned, float, float, float, float) = find("glViewportIndexedf");
  void (*depth_range)(double, double) = find("glDepthRange");
  void (*depth_func)(Enum) = find("glDepthFunc");
  void (*depth_mask)(unsigned char) = find("glDepthMask");
  void (*color_mask)(unsigned char, unsigned char, unsigned char, unsigned char) = find("glColorMask");
  void (*blend_func_separate)(Enum, Enum, Enum, Enum) = find("glBlendFuncSeparate");
  void (*blend_equation_separate)(Enum, Enum) = find("glBlendEquationSeparate");
  void (*logic_op)(Enum) = find("glLogicOp");
  void (*blend_color)(float, float, float, float) = find("glBlendColor");
  void (*stencil_func_separate)(Enum, Enum, int, unsigned) = find("glStencilFuncSeparate");
  void (*stencil_op_separate)(Enum, Enum, Enum, Enum) = find("glStencilOpSeparate");
  void (*stencil_mask_separate)(Enum, unsigned) = find("glStencilMaskSeparate");
  void (*cull_face)(Enum) = find("glCullFace");
  void (*front_face)(Enum) = find("glFrontFace");
  void (*scissor)(int, int, int, int) = find("glScissor");
  void (*polygon_mode)(Enum, Enum) = find("glPolygonMode");
  void (*polygon_offset)(float, float) = find("glPolygonOffset");
  void (*line_width)(float) = find("glLineWidth");
  void (*point_size)(float) = find("glPointSize");
  void (*provoking_vertex)(Enum) = find("glProvokingVertex");
  void (*clip_control)(Enum, Enum) = find("glClipControl");
  void (*clear_color)(float, float, float, float) = find("glClearColor");
  void (*clear_depth)(double) = find("glClearDepth");
  void (*clear_stencil)(int) = find("glClearStencil");
  void (*clear)(Enum) = find("glClear");
  void (*gen_textures)(int, Name*) = find("glGenTextures");
  void (*bind_texture)(Enum, Name) = find("glBindTexture");
  void (*tex_image_2d)(Enum, int, int, int, int, int, Enum, Enum, const void*) = find("glTexImage2D");
  void (*tex_parameteri)(Enum, Enum, int) = find("glTexParameteri");
  void (*tex_parameterf)(Enum, Enum, float) = find("glTexParameterf");
  void (*tex_parameterfv)(Enum, Enum, const float*) = find("glTexParameterfv");
  void (*finish)() = find("glFinish");
  void (*read_pixels)(int, int, int, int, Enum, Enum, void*) = find("glReadPixels");
  void (*gen_buffers)(int, Name*) = find("glGenBuffers");
  void (*bind_buffer)(Enum, Name) = find("glBindBuffer");
  void (*buffer_data)(Enum, std::ptrdiff_t, const void*, Enum) = find("glBufferData");
  void (*gen_vertex_arrays)(int, Name*) = find("glGenVertexArrays");
  void (*bind_vertex_array)(Name) = find("glBindVertexArray");
  void (*vertex_attrib_pointer)(Name, int, Enum, unsigned char, int,
                                std::uintptr_t) = find("glVertexAttribPointer");  // an offset: a buffer is bound
  void (*enable_vertex_attrib_array)(Name) = find("glEnableVertexAttribArray");
  Name (*create_shader)(Enum) = find("glCreateShader");
  void (*shader_source)(Name, int, const char* const*, const int*) = find("glShaderSource");
  void (*compile_shader)(Name) = find("glCompileShader");
  void (*get_shaderiv)(Name, Enum, int*) = find("glGetShaderiv");
  Name (*create_program)() = find("glCreateProgram");
  void (*attach_shader)(Name, Name) = find("glAttachShader");
  void (*link_program)(Name) = find("glLinkProgram");
  void (*get_programiv)(Name, Enum, int*) = find("glGetProgramiv");
  void (*use_program)(Name) = find("glUseProgram");
  void (*primitive_restart_index)(Name) = find("glPrimitiveRestartIndex");
  void (*draw_elements)(Enum, int, Enum, std::uintptr_t) = find("glDrawElements");  // likewise
  void (*gen_renderbuffers)(int, Name*) = find("glGenRenderbuffers");
  void (*bind_renderbuffer)(Enum, Name) = find("glBindRenderbuffer");
  void (*renderbuffer_storage)(Enum, Enum, int, int) = find("glRenderbufferStorage");
  void (*renderbuffer_storage_multisample)(Enum, int, Enum, int, int) = find("glRenderbufferStorageMultisample");
  void (*gen_framebuffers)(int, Name*) = find("glGenFramebuffers");
  void (*bind_framebuffer)(Enum, Name) = find("glBindFramebuffer");
  void (*framebuffer_renderbuffer)(Enum, Enum, Enum, Name) = find("glFramebufferRenderbuffer");
  Enum (*check_framebuffer_status)(Enum) = find("glCheckFramebufferStatus");
  void (*blit_framebuffer)(int, int, int, int, int, int, int, int, Enum, Enum) = find("glBlitFramebuffer");
};

/// Loads libOSMesa, makes a context current for the rest of the process and finds the functions. Throws
/// std::runtime_error that names the package when the library is missing, or the missing function.
[[nodiscard]] Functions start_osmesa();

}  // namespace halfplane::gl
