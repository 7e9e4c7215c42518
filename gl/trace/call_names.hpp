// Commands of OpenGL 1.5 as lists: X(Accum) X(ActiveTexture) and on, by name.
#pragma once

// clang-format off
// What a trace replays.
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

// What asks, and what takes or gives memory of the program.
#define HALFPLANE_QUERIES(X) \
  X(AreTexturesResident) X(FeedbackBuffer) X(GenBuffers) X(GenLists) X(GenQueries) X(GenTextures) X(GetBooleanv) \
  X(GetBufferParameteriv) X(GetBufferPointerv) X(GetBufferSubData) X(GetClipPlane) X(GetCompressedTexImage) \
  X(GetDoublev) X(GetError) X(GetFloatv) X(GetIntegerv) X(GetLightfv) X(GetLightiv) X(GetMapdv) X(GetMapfv) \
  X(GetMapiv) X(GetMaterialfv) X(GetMaterialiv) X(GetPixelMapfv) X(GetPixelMapuiv) X(GetPixelMapusv) X(GetPointerv) \
  X(GetPolygonStipple) X(GetQueryObjectiv) X(GetQueryObjectuiv) X(GetQueryiv) X(GetString) X(GetTexEnvfv) \
  X(GetTexEnviv) X(GetTexGendv) X(GetTexGenfv) X(GetTexGeniv) X(GetTexImage) X(GetTexLevelParameterfv) \
  X(GetTexLevelParameteriv) X(GetTexParameterfv) X(GetTexParameteriv) X(IsBuffer) X(IsEnabled) X(IsList) X(IsQuery) \
  X(IsTexture) X(MapBuffer) X(MultiDrawArrays) X(ReadPixels) X(SelectBuffer) X(UnmapBuffer)
// clang-format on
