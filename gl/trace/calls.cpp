#include "calls.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>
#include <utility>

namespace halfplane::gl {
namespace {

using Caller = bool (*)(const void* entry, Arguments& arguments);

template <class Function>
struct Typed;
template <class R, class... A>
struct Typed<R(A...)> {
  static bool call(const void* entry, Arguments& arguments) {
    if (arguments.size() != sizeof...(A)) return false;
    const auto function = reinterpret_cast<R (*)(A...)>(const_cast<void*>(entry));
    const auto typed = [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::tuple<A...>{arguments.get<A>(I)...};
    }
    (std::index_sequence_for<A...>());
    if (arguments.has_wild_pointer()) return false;
    std::apply(function, typed);
    return true;
  }
};

struct Row {
  std::string_view name;
  Caller caller;
};

// In the order of their names.
// clang-format off
#define HALFPLANE_CALLS(X) \
  X(Accum) X(ActiveTexture) X(AlphaFunc) X(ArrayElement) X(Begin) X(BeginQuery) X(BindBuffer) X(BindTexture) X(Bitmap) \
  X(BlendColor) X(BlendEquation) X(BlendFunc) X(BlendFuncSeparate) X(BufferData) X(BufferSubData) X(CallList) \
  X(CallLists) X(Clear) X(ClearAccum) X(ClearColor) X(ClearDepth) X(ClearIndex) X(ClearStencil) X(ClientActiveTexture) \
  X(ClipPlane) X(Color3b) X(Color3bv) X(Color3d) X(Color3dv) X(Color3f) X(Color3fv) X(Color3i) X(Color3iv) X(Color3s) \
  X(Color3sv) X(Color3ub) X(Color3ubv) X(Color3ui) X(Color3uiv) X(Color3us) X(Color3usv) X(Color4b) X(Color4bv) \
  X(Color4d) X(Color4dv) X(Color4f) X(Color4fv) X(Color4i) X(Color4iv) X(Color4s) X(Color4sv) X(Color4ub) X(Color4ubv) \
  X(Color4ui) X(Color4uiv) X(Color4us) X(Color4usv) X(ColorMask) X(ColorMaterial) X(ColorPointer) \
  X(CompressedTexImage1D) X(CompressedTexImage2D) X(CompressedTexImage3D) X(CompressedTexSubImage1D) \
  X(CompressedTexSubImage2D) X(CompressedTexSubImage3D) X(CopyPixels) X(CopyTexImage1D) X(CopyTexImage2D) \
  X(CopyTexSubImage1D) X(CopyTexSubImage2D) X(CopyTexSubImage3D) X(CullFace) X(DeleteBuffers) X(DeleteLists) \
  X(DeleteQueries) X(DeleteTextures) X(DepthFunc) X(DepthMask) X(DepthRange) X(Disable) X(DisableClientState) \
  X(DrawArrays) X(DrawBuffer) X(DrawElements) X(DrawPixels) X(DrawRangeElements) X(EdgeFlag) X(EdgeFlagPointer) \
  X(EdgeFlagv) X(Enable) X(EnableClientState) X(End) X(EndList) X(EndQuery) X(EvalCoord1d) X(EvalCoord1dv) \
  X(EvalCoord1f) X(EvalCoord1fv) X(EvalCoord2d) X(EvalCoord2dv) X(EvalCoord2f) X(EvalCoord2fv) X(EvalMesh1) \
  X(EvalMesh2) X(EvalPoint1) X(EvalPoint2) X(Finish) X(Flush) X(FogCoordPointer) X(FogCoordd) X(FogCoorddv) \
  X(FogCoordf) X(FogCoordfv) X(Fogf) X(Fogfv) X(Fogi) X(Fogiv) X(FrontFace) X(Frustum) X(Hint) X(IndexMask) \
  X(IndexPointer) X(Indexd) X(Indexdv) X(Indexf) X(Indexfv) X(Indexi) X(Indexiv) X(Indexs) X(Indexsv) X(Indexub) \
  X(Indexubv) X(InitNames) X(InterleavedArrays) X(LightModelf) X(LightModelfv) X(LightModeli) X(LightModeliv) \
  X(Lightf) X(Lightfv) X(Lighti) X(Lightiv) X(LineStipple) X(LineWidth) X(ListBase) X(LoadIdentity) X(LoadMatrixd) \
  X(LoadMatrixf) X(LoadName) X(LoadTransposeMatrixd) X(LoadTransposeMatrixf) X(LogicOp) X(Map1d) X(Map1f) X(Map2d) \
  X(Map2f) X(MapGrid1d) X(MapGrid1f) X(MapGrid2d) X(MapGrid2f) X(Materialf) X(Materialfv) X(Materiali) X(Materialiv) \
  X(MatrixMode) X(MultMatrixd) X(MultMatrixf) X(MultTransposeMatrixd) X(MultTransposeMatrixf) X(MultiTexCoord1d) \
  X(MultiTexCoord1dv) X(MultiTexCoord1f) X(MultiTexCoord1fv) X(MultiTexCoord1i) X(MultiTexCoord1iv) X(MultiTexCoord1s) \
  X(MultiTexCoord1sv) X(MultiTexCoord2d) X(MultiTexCoord2dv) X(MultiTexCoord2f) X(MultiTexCoord2fv) X(MultiTexCoord2i) \
  X(MultiTexCoord2iv) X(MultiTexCoord2s) X(MultiTexCoord2sv) X(MultiTexCoord3d) X(MultiTexCoord3dv) X(MultiTexCoord3f) \
  X(MultiTexCoord3fv) X(MultiTexCoord3i) X(MultiTexCoord3iv) X(MultiTexCoord3s) X(MultiTexCoord3sv) X(MultiTexCoord4d) \
  X(MultiTexCoord4dv) X(MultiTexCoord4f) X(MultiTexCoord4fv) X(MultiTexCoord4i) X(MultiTexCoord4iv) X(MultiTexCoord4s) \
  X(MultiTexCoord4sv) X(NewList) X(Normal3b) X(Normal3bv) X(Normal3d) X(Normal3dv) X(Normal3f) X(Normal3fv) \
  X(Normal3i) X(Normal3iv) X(Normal3s) X(Normal3sv) X(NormalPointer) X(Ortho) X(PassThrough) X(PixelMapfv) \
  X(PixelMapuiv) X(PixelMapusv) X(PixelStoref) X(PixelStorei) X(PixelTransferf) X(PixelTransferi) X(PixelZoom) \
  X(PointParameterf) X(PointParameterfv) X(PointParameteri) X(PointParameteriv) X(PointSize) X(PolygonMode) \
  X(PolygonOffset) X(PolygonStipple) X(PopAttrib) X(PopClientAttrib) X(PopMatrix) X(PopName) X(PrioritizeTextures) \
  X(PushAttrib) X(PushClientAttrib) X(PushMatrix) X(PushName) X(RasterPos2d) X(RasterPos2dv) X(RasterPos2f) \
  X(RasterPos2fv) X(RasterPos2i) X(RasterPos2iv) X(RasterPos2s) X(RasterPos2sv) X(RasterPos3d) X(RasterPos3dv) \
  X(RasterPos3f) X(RasterPos3fv) X(RasterPos3i) X(RasterPos3iv) X(RasterPos3s) X(RasterPos3sv) X(RasterPos4d) \
  X(RasterPos4dv) X(RasterPos4f) X(RasterPos4fv) X(RasterPos4i) X(RasterPos4iv) X(RasterPos4s) X(RasterPos4sv) \
  X(ReadBuffer) X(Rectd) X(Rectdv) X(Rectf) X(Rectfv) X(Recti) X(Rectiv) X(Rects) X(Rectsv) X(RenderMode) X(Rotated) \
  X(Rotatef) X(SampleCoverage) X(Scaled) X(Scalef) X(Scissor) X(SecondaryColor3b) X(SecondaryColor3bv) \
  X(SecondaryColor3d) X(SecondaryColor3dv) X(SecondaryColor3f) X(SecondaryColor3fv) X(SecondaryColor3i) \
  X(SecondaryColor3iv) X(SecondaryColor3s) X(SecondaryColor3sv) X(SecondaryColor3ub) X(SecondaryColor3ubv) \
  X(SecondaryColor3ui) X(SecondaryColor3uiv) X(SecondaryColor3us) X(SecondaryColor3usv) X(SecondaryColorPointer) \
  X(ShadeModel) X(StencilFunc) X(StencilMask) X(StencilOp) X(TexCoord1d) X(TexCoord1dv) X(TexCoord1f) X(TexCoord1fv) \
  X(TexCoord1i) X(TexCoord1iv) X(TexCoord1s) X(TexCoord1sv) X(TexCoord2d) X(TexCoord2dv) X(TexCoord2f) X(TexCoord2fv) \
  X(TexCoord2i) X(TexCoord2iv) X(TexCoord2s) X(TexCoord2sv) X(TexCoord3d) X(TexCoord3dv) X(TexCoord3f) X(TexCoord3fv) \
  X(TexCoord3i) X(TexCoord3iv) X(TexCoord3s) X(TexCoord3sv) X(TexCoord4d) X(TexCoord4dv) X(TexCoord4f) X(TexCoord4fv) \
  X(TexCoord4i) X(TexCoord4iv) X(TexCoord4s) X(TexCoord4sv) X(TexCoordPointer) X(TexEnvf) X(TexEnvfv) X(TexEnvi) \
  X(TexEnviv) X(TexGend) X(TexGendv) X(TexGenf) X(TexGenfv) X(TexGeni) X(TexGeniv) X(TexImage1D) X(TexImage2D) \
  X(TexImage3D) X(TexParameterf) X(TexParameterfv) X(TexParameteri) X(TexParameteriv) X(TexSubImage1D) \
  X(TexSubImage2D) X(TexSubImage3D) X(Translated) X(Translatef) X(Vertex2d) X(Vertex2dv) X(Vertex2f) X(Vertex2fv) \
  X(Vertex2i) X(Vertex2iv) X(Vertex2s) X(Vertex2sv) X(Vertex3d) X(Vertex3dv) X(Vertex3f) X(Vertex3fv) X(Vertex3i) \
  X(Vertex3iv) X(Vertex3s) X(Vertex3sv) X(Vertex4d) X(Vertex4dv) X(Vertex4f) X(Vertex4fv) X(Vertex4i) X(Vertex4iv) \
  X(Vertex4s) X(Vertex4sv) X(VertexPointer) X(Viewport) X(WindowPos2d) X(WindowPos2dv) X(WindowPos2f) X(WindowPos2fv) \
  X(WindowPos2i) X(WindowPos2iv) X(WindowPos2s) X(WindowPos2sv) X(WindowPos3d) X(WindowPos3dv) X(WindowPos3f) \
  X(WindowPos3fv) X(WindowPos3i) X(WindowPos3iv) X(WindowPos3s) X(WindowPos3sv)
// clang-format on
#define HALFPLANE_CALL(name) Row{"gl" #name, &Typed<decltype(::gl##name)>::call},
constexpr std::array kCalls{HALFPLANE_CALLS(HALFPLANE_CALL)};

}  // namespace

void* Arguments::memory(const TraceValue& value) {
  if (value.kind != TraceValue::Kind::bytes) {
    const bool is_null = value.kind == TraceValue::Kind::null;
    wild_ = wild_ || addresses_ == Addresses::none || (!is_null && addresses_ != Addresses::offsets);
    return reinterpret_cast<void*>(value.integer);
  }
  std::vector<std::byte>& bytes = hold(value.bytes.size());
  std::memcpy(bytes.data(), value.bytes.data(), value.bytes.size());
  return bytes.data();
}

std::vector<std::byte>& Arguments::hold(std::size_t size) {
  return held_.emplace_back(std::max(size + 1, reach_));  // a string ends in 0
}

bool call_entry(std::string_view name, const void* entry, Arguments& arguments) {
  const auto row =
      std::lower_bound(kCalls.begin(), kCalls.end(), name, [](const Row& a, std::string_view b) { return a.name < b; });
  return row != kCalls.end() && row->name == name && row->caller(entry, arguments);
}

}  // namespace halfplane::gl
