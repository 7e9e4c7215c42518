// Vertices: matrices, texture coordinates, raster positions; arrays, buffers and lists give the results of glBegin and glEnd.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "gl/core/commands.hpp"
#include "gl/core/list.hpp"
#include "gl/core/matrix.hpp"
#include "gl/core/shading.hpp"

namespace halfplane::gl::vertex_test {
namespace {

struct Vertices : testing::Test {
  Context context;

  template <class Command>
  GLenum error_of(Command&& command) {
    context.error = GL_NO_ERROR;
    command();
    return context.error;
  }
  ShadedVertex vertex_of(const Vec4& position) {
    ++context.revision;
    begin(context, GL_POINTS);
    vertex(context, position[0], position[1], position[2], position[3]);
    context.primitive = Context::kNoPrimitive;
    shade_pending(context);
    return context.shaded[0];
  }
};

void expect_near(const Vec4& value, const Vec4& expected, double tolerance = 1e-12) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << i;
}

TEST_F(Vertices, GoThroughModelviewAndProjection) {
  matrix_mode(context, GL_PROJECTION);
  frustum(context, -1, 3, -2, 2, 2, 10);
  matrix_mode(context, GL_MODELVIEW);
  translate(context, 1, 2, -5);
  rotate(context, 90, 0, 0, 2);
  scale(context, 2, 3, 4);
  const ShadedVertex shaded = vertex_of({1, 1, 0.5, 1});
  expect_near(shaded.eye, {1 - 3, 2 + 2, -5 + 2, 1});
  // x: 2 n / (r - l) x + (r + l) / (r - l) z, and so on; w = -z.
  expect_near(shaded.clip, {2 * 2 / 4.0 * -2 + 2 / 4.0 * -3, 2 * 2 / 4.0 * 4, 12 / 8.0 * 3 - 40 / 8.0, 3});
  EXPECT_EQ(shaded.fog_distance, 3);
}

TEST_F(Vertices, TransposedAndMultiplied) {
  Mat4 m;
  std::iota(m.begin(), m.end(), 1.0);
  load_transpose_matrix(context, m);
  expect_near(vertex_of({1, 0, 0, 0}).eye, {1, 5, 9, 13});
  load_identity(context);
  scale(context, 1, 2, 3);
  mult_matrix(context, m);
  expect_near(vertex_of({0, 1, 0, 0}).eye, {5, 12, 21, 8});
  ortho(context, -1, 1, -1, 1, -1, 1);  // z turned over
  expect_near(vertex_of({0, 0, 1, 0}).eye, {-9, -20, -33, -12});
}

TEST_F(Vertices, StacksHaveTheirDepths) {
  constexpr std::pair<GLenum, int> kStacks[] = {
      {GL_MODELVIEW, kModelviewDepth}, {GL_PROJECTION, kProjectionDepth}, {GL_TEXTURE, kTextureDepth}};
  for (const auto& [mode, deepest] : kStacks) {
    const int depth = deepest;
    matrix_mode(context, mode);
    EXPECT_EQ(error_of([&] { pop_matrix(context); }), GLenum{GL_STACK_UNDERFLOW});
    EXPECT_EQ(error_of([&] {
                for (int i = 1; i < depth; ++i) push_matrix(context), translate(context, 1, 0, 0);
              }),
              GLenum{GL_NO_ERROR});
    EXPECT_EQ(error_of([&] { push_matrix(context); }), GLenum{GL_STACK_OVERFLOW});
    EXPECT_EQ(error_of([&] {
                for (int i = 1; i < depth; ++i) pop_matrix(context);
              }),
              GLenum{GL_NO_ERROR});
  }
  EXPECT_EQ(context.modelview.back(), kIdentity);
  EXPECT_EQ(error_of([&] { matrix_mode(context, GL_RGBA); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { frustum(context, -1, 1, -1, 1, 0, 1); }), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { frustum(context, 1, 1, -1, 1, 1, 2); }), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { ortho(context, -1, 1, -1, 1, 2, 2); }), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { viewport(context, 0, 0, -1, 4); }), GLenum{GL_INVALID_VALUE});
}

TEST_F(Vertices, InverseMatrices) {
  const Mat4 m{2, 1, 0, 3, -1, 4, 2, 0, 0.5, 0, 3, 1, 7, -2, 1, 1};
  const Mat4 product_with_inverse = product(m, inverse(m));
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(product_with_inverse[i], kIdentity[i], 1e-14) << i;
  for (const double value : inverse(Mat4{})) EXPECT_TRUE(std::isfinite(value));
  // A plane stays where it is: the point (2, 0, 0) lies on x = 2.
  translate(context, 5, 0, 0);
  clip_plane(context, GL_CLIP_PLANE3, {1, 0, 0, -2});
  expect_near(context.state.transform.clip_plane[3], {1, 0, 0, -7});
  EXPECT_EQ(error_of([&] { clip_plane(context, GL_CLIP_PLANE0 + kClipPlanes, {}); }), GLenum{GL_INVALID_ENUM});
}

TEST_F(Vertices, TextureCoordinatesAreGenerated) {
  TextureUnit& unit = context.state.texture.unit[0];
  unit.enabled[1] = true;
  translate(context, 0, 0, -4);
  rotate(context, 30, 1, 0, 0);
  const Vec3 n{0.6, 0, 0.8};
  normal(context, n[0], n[1], n[2]);
  tex_coord(context, GL_TEXTURE0, 9, 8, 7, 6);
  const auto with_mode = [&](GLenum mode) {
    for (TexGen& gen : unit.gen) gen.enabled = true, gen.mode = mode, gen.object = {1, 2, 3, 4}, gen.eye = {4, 3, 2, 1};
    if (mode == GL_SPHERE_MAP) unit.gen[2].enabled = unit.gen[3].enabled = false;
    if (mode == GL_NORMAL_MAP || mode == GL_REFLECTION_MAP) unit.gen[3].enabled = false;
    return vertex_of({1, 2, 3, 1});
  };
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  const Vec3 eye{1, 2 * c - 3 * s, 2 * s + 3 * c - 4}, eye_normal{n[0], n[1] * c - n[2] * s, n[1] * s + n[2] * c};
  const double length = std::hypot(eye[0], eye[1], eye[2]);
  const double along = (eye[0] * eye_normal[0] + eye[1] * eye_normal[1] + eye[2] * eye_normal[2]) / length;
  Vec3 r;
  for (std::size_t i = 0; i < 3; ++i) r[i] = eye[i] / length - 2 * along * eye_normal[i];
  const double m = 2 * std::sqrt(r[0] * r[0] + r[1] * r[1] + (r[2] + 1) * (r[2] + 1));

  expect_near(with_mode(GL_OBJECT_LINEAR).tex_coord[0], {18, 18, 18, 18});
  const double linear = 4 * eye[0] + 3 * eye[1] + 2 * eye[2] + 1;
  expect_near(with_mode(GL_EYE_LINEAR).tex_coord[0], {linear, linear, linear, linear});
  expect_near(with_mode(GL_SPHERE_MAP).tex_coord[0], {r[0] / m + 0.5, r[1] / m + 0.5, 7, 6});
  expect_near(with_mode(GL_NORMAL_MAP).tex_coord[0], {eye_normal[0], eye_normal[1], eye_normal[2], 6});
  expect_near(with_mode(GL_REFLECTION_MAP).tex_coord[0], {r[0], r[1], r[2], 6});
  // Generated coordinates pass the texture matrix.
  matrix_mode(context, GL_TEXTURE);
  scale(context, 2, 3, 4);
  expect_near(with_mode(GL_OBJECT_LINEAR).tex_coord[0], {36, 54, 72, 18});
}

TEST_F(Vertices, ColorsAreHeld) {
  color(context, 2, -1, 0.5, std::nan(""));
  secondary_color(context, 0.25, 3, -3);
  EXPECT_EQ(vertex_of({}).color[1], (Vec4{1, 0, 0.5, 0}));
  EXPECT_EQ(vertex_of({}).secondary[0], Vec4{});
  context.state.fog.color_sum = true;
  EXPECT_EQ(vertex_of({}).secondary[1], (Vec4{0.25, 1, 0, 0}));
}

TEST_F(Vertices, PointsShrinkWithTheDistance) {
  point_size(context, 8);
  point_parameter(context, GL_POINT_DISTANCE_ATTENUATION, {{0, 0, 0.25}, false, true});
  EXPECT_NEAR(vertex_of({0, 3, 4, 1}).point_size, 8 / std::sqrt(0.25 * 25), 1e-12);
  point_parameter(context, GL_POINT_SIZE_MIN, {{5}, false, false});
  EXPECT_EQ(vertex_of({0, 3, 4, 1}).point_size, 5);
  EXPECT_EQ(error_of([&] {
              point_parameter(context, GL_POINT_SIZE_MAX, {{-1}, false, false});
            }),
            GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { point_parameter(context, GL_POINT_SIZE_MAX, {{0}, false, false}); }), GLenum{GL_NO_ERROR});
  EXPECT_EQ(error_of([&] { point_size(context, 0); }), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { line_width(context, -1); }), GLenum{GL_INVALID_VALUE});
}

TEST_F(Vertices, RasterPositions) {
  viewport(context, 10, 20, 200, 100);
  depth_range(context, 0.5, 1);
  color(context, 0.5, 1.5, 0, 1);
  tex_coord(context, GL_TEXTURE0, 1, 2, 3, 4);
  translate(context, 0, 0, -0.5);
  raster_pos(context, 0.5, -0.5, 0.5, 1);
  const RasterPosition& raster = context.state.current.raster;
  EXPECT_TRUE(raster.valid);
  expect_near(raster.window, {10 + 150, 20 + 25, 0.75, 1});
  EXPECT_EQ(raster.color, (Vec4{0.5, 1, 0, 1}));
  EXPECT_EQ(raster.tex_coord[0], (Vec4{1, 2, 3, 4}));
  EXPECT_EQ(raster.distance, 0);
  ++context.revision;
  raster_pos(context, 1.001, 0, 0, 1);
  EXPECT_FALSE(raster.valid);
  window_pos(context, 5, 6, 2);
  EXPECT_TRUE(raster.valid);
  expect_near(raster.window, {5, 6, 1, 1});
  context.state.transform.clip_enabled[2] = true;
  context.state.transform.clip_plane[2] = {1, 0, 0, 0};
  raster_pos(context, -0.1, 0, 0, 1);
  EXPECT_FALSE(raster.valid);
}

TEST_F(Vertices, BeginAndEnd) {
  EXPECT_EQ(error_of([&] { end(context); }), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(error_of([&] { begin(context, GL_POLYGON + 1); }), GLenum{GL_INVALID_ENUM});
  EXPECT_FALSE(context.inside_begin());
  vertex(context, 1, 2, 3, 4);  // a vertex without a primitive
  begin(context, GL_LINES);
  EXPECT_TRUE(context.input.empty());
  EXPECT_EQ(error_of([&] { begin(context, GL_LINES); }), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(error_of([&] { draw_arrays(context, GL_LINES, 0, 2); }), GLenum{GL_INVALID_OPERATION});
  end(context);
  EXPECT_EQ(error_of([&] { tex_coord(context, GL_TEXTURE0 + kTextureUnits, 0, 0, 0, 0); }), GLenum{GL_INVALID_ENUM});
}

/// Vertices with everything, as GL_T2F_C4F_N3F_V3F.
struct Packed {
  std::array<float, 2> tex_coord;
  std::array<float, 4> color;
  std::array<float, 3> normal, position;
};

/// Feedback of primitives that are issued in several ways.
struct Arrays : Vertices {
  std::vector<Packed> packed;
  std::vector<GLushort> indices;

  Arrays() {
    for (int i = 0; i < 12; ++i) {
      const auto x = static_cast<float>(i);
      packed.push_back({{x / 3, x / 5},
                        {x / 12, 1 - x / 12, 0.5F, 1},
                        {0.6F, 0, 0.8F},
                        {std::cos(x) * 0.9F, std::sin(x) * 0.8F, x / 20}});
    }
    indices = {3, 4, 5, 3, 7, 8, 0, 1, 11, 10, 9, 8};
    viewport(context, 0, 0, 64, 64);
    context.state.lighting.enabled = context.state.lighting.light_enabled[0] = true;
    context.state.lighting.color_material = true;
    ++context.revision;
  }

  template <class Draw>
  std::vector<float> fed(Draw&& draw) {
    std::vector<float> buffer(4096);
    feedback_buffer(context, 4096, GL_4D_COLOR_TEXTURE, buffer.data());
    set_render_mode(context, GL_FEEDBACK);
    ++context.revision;
    draw();
    buffer.resize(static_cast<std::size_t>(set_render_mode(context, GL_RENDER)));
    return buffer;
  }
  void issue_vertex(std::size_t i) {
    const Packed& v = packed[i];
    tex_coord(context, GL_TEXTURE0, v.tex_coord[0], v.tex_coord[1], 0, 1);
    color(context, v.color[0], v.color[1], v.color[2], v.color[3]);
    normal(context, v.normal[0], v.normal[1], v.normal[2]);
    vertex(context, v.position[0], v.position[1], v.position[2], 1);
  }
  std::vector<float> immediate(GLenum mode, std::span<const GLushort> elements) {
    return fed([&] {
      begin(context, mode);
      for (const GLushort i : elements) issue_vertex(i);
      end(context);
    });
  }
};

TEST_F(Arrays, AreImmediateMode) {
  interleaved_arrays(context, GL_T2F_C4F_N3F_V3F, 0, packed.data());
  std::vector<GLushort> all(packed.size());
  std::iota(all.begin(), all.end(), GLushort{0});
  const std::array<GLint, 2> firsts{2, 6};
  const std::array<GLsizei, 2> counts{4, 5};
  for (GLenum mode = GL_POINTS; mode <= GL_POLYGON; ++mode) {
    const auto elements = immediate(mode, indices);
    EXPECT_GT(elements.size(), 24U) << mode;
    EXPECT_EQ(fed([&] { draw_arrays(context, mode, 2, 9); }), immediate(mode, std::span(all).subspan(2, 9))) << mode;
    const auto count = static_cast<GLsizei>(indices.size());
    EXPECT_EQ(fed([&] { draw_elements(context, mode, count, GL_UNSIGNED_SHORT, indices.data()); }), elements) << mode;
    EXPECT_EQ(fed([&] { draw_range_elements(context, mode, 0, 11, count, GL_UNSIGNED_SHORT, indices.data()); }),
              elements);
    EXPECT_EQ(fed([&] {
                begin(context, mode);
                for (const GLushort i : indices) array_element(context, i);
                end(context);
              }),
              elements)
        << mode;
    auto both = immediate(mode, std::span(all).subspan(2, 4));
    const auto second = immediate(mode, std::span(all).subspan(6, 5));
    both.insert(both.end(), second.begin(), second.end());
    EXPECT_EQ(fed([&] { multi_draw_arrays(context, mode, firsts.data(), counts.data(), 2); }), both) << mode;

    // A list has the arrays as they were.
    new_list(context, 1, GL_COMPILE);
    draw_elements(context, mode, count, GL_UNSIGNED_SHORT, indices.data());
    end_list(context);
    const auto kept = packed;
    packed.assign(packed.size(), {});
    EXPECT_EQ(fed([&] { call_list(context, 1); }), elements) << mode;
    packed = kept;
    interleaved_arrays(context, GL_T2F_C4F_N3F_V3F, 0, packed.data());
  }
  EXPECT_EQ(context.error, GLenum{GL_NO_ERROR});
}

TEST_F(Arrays, OfAListAreRefusedWithinAPrimitive) {
  interleaved_arrays(context, GL_T2F_C4F_N3F_V3F, 0, packed.data());
  for (const GLsizei count : {3, 0}) {
    new_list(context, 1, GL_COMPILE);
    draw_arrays(context, GL_POINTS, 0, count);
    end_list(context);
    EXPECT_EQ(get_error(context), GLenum{GL_NO_ERROR});
    begin(context, GL_POINTS);
    EXPECT_EQ(error_of([&] { call_list(context, 1); }), GLenum{GL_INVALID_OPERATION});
    EXPECT_TRUE(context.input.empty());
    end(context);
    (void)get_error(context);
  }
}

TEST_F(Arrays, KeepTheCurrentAttributes) {
  color(context, 0.1, 0.2, 0.3, 1);
  const Vec4 before = context.state.current.color;
  interleaved_arrays(context, GL_T2F_C4F_N3F_V3F, 0, packed.data());
  draw_arrays(context, GL_POINTS, 0, 3);
  EXPECT_EQ(context.state.current.color, before);
  new_list(context, 1, GL_COMPILE_AND_EXECUTE);
  draw_arrays(context, GL_POINTS, 0, 3);
  end_list(context);
  call_list(context, 1);
  EXPECT_EQ(context.state.current.color, before);
  EXPECT_EQ(context.state.lighting.material[1].diffuse, before);
}

TEST_F(Arrays, SparseIndicesDrawTheSame) {
  std::vector<Packed> sparse(40000);
  std::ranges::copy(packed, sparse.end() - static_cast<std::ptrdiff_t>(packed.size()));
  sparse[0] = packed[0];
  const std::vector<GLuint> far{0, static_cast<GLuint>(sparse.size() - 1), static_cast<GLuint>(sparse.size() - 2)};
  const std::vector<GLushort> same{0, 11, 10};
  interleaved_arrays(context, GL_T2F_C4F_N3F_V3F, 0, sparse.data());
  EXPECT_EQ(fed([&] { draw_elements(context, GL_TRIANGLES, 3, GL_UNSIGNED_INT, far.data()); }),
            immediate(GL_TRIANGLES, same));
}

TEST_F(Arrays, OfBuffersAreReadWithinThem) {
  std::array<GLuint, 2> names{};
  gen_buffers(context, 2, names.data());
  EXPECT_FALSE(is_buffer(context, names[0]));
  bind_buffer(context, GL_ARRAY_BUFFER, names[0]);
  EXPECT_TRUE(is_buffer(context, names[0]));
  const auto bytes = static_cast<GLsizeiptr>(packed.size() * sizeof(Packed));
  buffer_data(context, GL_ARRAY_BUFFER, bytes, packed.data(), GL_STATIC_DRAW);
  bind_buffer(context, GL_ELEMENT_ARRAY_BUFFER, names[1]);
  buffer_data(context, GL_ELEMENT_ARRAY_BUFFER, 24, nullptr, GL_DYNAMIC_DRAW);
  buffer_sub_data(context, GL_ELEMENT_ARRAY_BUFFER, 0, 24, indices.data());
  interleaved_arrays(context, GL_T2F_C4F_N3F_V3F, 0, nullptr);
  const auto elements = immediate(GL_TRIANGLES, indices);
  const auto draw = [&](GLsizei count, std::size_t offset = 0) {
    return fed(
        [&] { draw_elements(context, GL_TRIANGLES, count, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(offset)); });
  };
  EXPECT_EQ(draw(12), elements);
  EXPECT_EQ(draw(2000000000), elements);  // all elements
  EXPECT_TRUE(draw(3, 25).empty());
  EXPECT_EQ(fed([&] { draw_arrays(context, GL_POINTS, 11, 2000000000); }),
            immediate(GL_POINTS, std::vector<GLushort>{11}));
  EXPECT_TRUE(fed([&] { draw_arrays(context, GL_POINTS, 2147483647, 2147483647); }).empty());
  const GLushort beyond = 60000;
  buffer_sub_data(context, GL_ELEMENT_ARRAY_BUFFER, 0, 2, &beyond);
  (void)draw(12);

  const auto part_error = [&](GLintptr offset, GLsizeiptr size) {
    return error_of([&] { buffer_sub_data(context, GL_ARRAY_BUFFER, offset, size, packed.data()); });
  };
  EXPECT_EQ(part_error(-1, 1), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(part_error(1, bytes), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(part_error(bytes, 0), GLenum{GL_NO_ERROR});
  void* const mapped = map_buffer(context, GL_ARRAY_BUFFER, GL_READ_ONLY);
  ASSERT_NE(mapped, nullptr);
  EXPECT_EQ(std::memcmp(mapped, packed.data(), static_cast<std::size_t>(bytes)), 0);
  void* pointer = nullptr;
  get_buffer_pointer(context, GL_ARRAY_BUFFER, GL_BUFFER_MAP_POINTER, &pointer);
  EXPECT_EQ(pointer, mapped);
  EXPECT_EQ(part_error(0, 1), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(error_of([&] { draw_arrays(context, GL_POINTS, 0, 1); }), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(error_of([&] { (void)map_buffer(context, GL_ARRAY_BUFFER, GL_READ_ONLY); }), GLenum{GL_INVALID_OPERATION});
  EXPECT_TRUE(unmap_buffer(context, GL_ARRAY_BUFFER));
  EXPECT_EQ(error_of([&] { (void)unmap_buffer(context, GL_ARRAY_BUFFER); }), GLenum{GL_INVALID_OPERATION});
  delete_buffers(context, 2, names.data());
  EXPECT_EQ(context.client.array_buffer, 0U);
  EXPECT_TRUE(fed([&] { draw_arrays(context, GL_POINTS, 0, 1); }).empty());
  EXPECT_EQ(error_of([&] { buffer_data(context, GL_ARRAY_BUFFER, 4, nullptr, GL_STATIC_DRAW); }),
            GLenum{GL_INVALID_OPERATION});
}

TEST_F(Arrays, IntegersOfColorsAreFractions) {
  const std::array<GLbyte, 3> bytes{127, -128, 0};
  const std::array<GLushort, 4> shorts{65535, 0, 32768, 65535};
  const std::array<GLshort, 2> positions{-3, 7};
  array_pointer(context, Array::color, 3, GL_BYTE, 0, bytes.data());
  client_state(context, GL_COLOR_ARRAY, true);
  array_element(context, 0);
  expect_near(context.state.current.color, {1, -1, 1 / 255.0, 1});
  array_pointer(context, Array::color, 4, GL_UNSIGNED_SHORT, 0, shorts.data());
  array_pointer(context, Array::vertex, 2, GL_SHORT, 0, positions.data());
  client_state(context, GL_VERTEX_ARRAY, true);
  begin(context, GL_POINTS);
  array_element(context, 0);
  expect_near(context.state.current.color, {1, 0, 32768 / 65535.0, 1});
  shade_pending(context);
  EXPECT_EQ(context.shaded[0].eye, (Vec4{-3, 7, 0, 1}));
  end(context);
  // Fixed-point numbers are OpenGL ES's alone.
  const std::array<GLfixed, 4> fixed{1 << 16, -(1 << 15), 0, 1};
  EXPECT_EQ(error_of([&] { array_pointer(context, Array::color, 4, GL_FIXED, 0, fixed.data()); }),
            GLenum{GL_INVALID_ENUM});
  context.is_embedded = true;
  EXPECT_EQ(error_of([&] { array_pointer(context, Array::color, 4, GL_FIXED, 0, fixed.data()); }), GLenum{GL_NO_ERROR});
  array_element(context, 0);
  expect_near(context.state.current.color, {1, -0.5, 0, 1 / 65536.0});
}

TEST_F(Arrays, Errors) {
  EXPECT_EQ(error_of([&] { array_pointer(context, Array::vertex, 1, GL_FLOAT, 0, nullptr); }),
            GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { array_pointer(context, Array::vertex, 3, GL_BYTE, 0, nullptr); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { array_pointer(context, Array::vertex, 3, GL_FLOAT, -4, nullptr); }),
            GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { client_state(context, GL_FLOAT, true); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { interleaved_arrays(context, GL_FLOAT, 0, nullptr); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { draw_arrays(context, 99, 0, 1); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { draw_arrays(context, GL_POINTS, 0, -1); }), GLenum{GL_INVALID_VALUE});
  const std::array<GLint, 2> firsts{0, 0};
  const std::array<GLsizei, 2> counts{1, -1};
  EXPECT_EQ(error_of([&] { multi_draw_arrays(context, GL_POINTS, firsts.data(), counts.data(), 2); }),
            GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { draw_elements(context, GL_POINTS, 1, GL_INT, nullptr); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { bind_buffer(context, GL_RGBA, 1); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { array_element(context, -1); }), GLenum{GL_INVALID_VALUE});
}

TEST_F(Arrays, Queries) {
  std::array<GLuint, 2> names{};
  gen_queries(context, 2, names.data());
  EXPECT_NE(names[0], names[1]);
  EXPECT_FALSE(is_query(context, names[0]));
  EXPECT_EQ(error_of([&] { begin_query(context, GL_SAMPLES_PASSED, 0); }), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(error_of([&] { begin_query(context, GL_RGBA, names[0]); }), GLenum{GL_INVALID_ENUM});
  begin_query(context, GL_SAMPLES_PASSED, names[0]);
  EXPECT_TRUE(is_query(context, names[0]));
  EXPECT_EQ(error_of([&] { begin_query(context, GL_SAMPLES_PASSED, names[1]); }), GLenum{GL_INVALID_OPERATION});
  GLint value = -1;
  EXPECT_EQ(error_of([&] { get_query_object(context, names[0], GL_QUERY_RESULT, &value); }),
            GLenum{GL_INVALID_OPERATION});
  get_query(context, GL_SAMPLES_PASSED, GL_CURRENT_QUERY, &value);
  EXPECT_EQ(value, static_cast<GLint>(names[0]));
  EXPECT_EQ(error_of([&] { end_query(context, GL_SAMPLES_PASSED); }), GLenum{GL_NO_ERROR});
  EXPECT_EQ(error_of([&] { end_query(context, GL_SAMPLES_PASSED); }), GLenum{GL_INVALID_OPERATION});
  get_query_object(context, names[0], GL_QUERY_RESULT, &value);
  EXPECT_EQ(value, 0);
  delete_queries(context, 2, names.data());
  EXPECT_FALSE(is_query(context, names[0]));
}

}  // namespace
}  // namespace halfplane::gl::vertex_test
