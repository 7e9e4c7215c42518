// Evaluators: curves and surfaces against their polynomials, normals against differences, grids, and unchanged state.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gl/core/commands.hpp"
#include "gl/core/shading.hpp"

namespace halfplane::gl::eval_test {
namespace {

struct Evaluators : testing::Test {
  Context context;

  static std::shared_ptr<const std::vector<double>> points(std::vector<double> values) {
    return std::make_shared<const std::vector<double>>(std::move(values));
  }
  void enable1(GLenum target) { context.state.eval.map1[target - GL_MAP1_COLOR_4] = true; }
  void enable2(GLenum target) { context.state.eval.map2[target - GL_MAP2_COLOR_4] = true; }
  /// The vertices that `draw` issues within a primitive.
  template <class Draw>
  std::vector<ShadedVertex> drawn(Draw&& draw) {
    ++context.revision;
    begin(context, GL_POINTS);
    draw();
    context.primitive = Context::kNoPrimitive;
    shade_pending(context);
    return context.shaded.rows();
  }
};

double binomial(int n, int k) { return k == 0 ? 1 : binomial(n - 1, k - 1) * n / k; }
double bernstein(int n, int i, double u) { return binomial(n, i) * std::pow(u, i) * std::pow(1 - u, n - i); }

TEST_F(Evaluators, CurvesAreTheirPolynomials) {
  const std::vector<double> control{0, 1, 2, 3, -1, 4, 5, 2, -2, 0, 1, 1, 7, 3, 5};
  map1(context, GL_MAP1_VERTEX_3, 2, 6, 5, points(control));
  enable1(GL_MAP1_VERTEX_3);
  for (const double u : {2.0, 2.5, 3.3, 5.0, 6.0, 7.0}) {
    const auto vertices = drawn([&] { eval_coord1(context, u); });
    ASSERT_EQ(vertices.size(), 1U);
    for (std::size_t k = 0; k < 3; ++k) {
      double expected = 0;
      for (int i = 0; i < 5; ++i)
        expected += control[static_cast<std::size_t>(3 * i) + k] * bernstein(4, i, (u - 2) / 4);
      EXPECT_NEAR(vertices[0].eye[k], expected, 1e-12) << u;
    }
    EXPECT_EQ(vertices[0].eye[3], 1);
  }
}

TEST_F(Evaluators, SurfacesAndTheirNormals) {
  std::vector<double> control;  // 3 by 4, v fastest, not flat and with a w of its own
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      const double w = 1 + 0.1 * i + 0.05 * j;
      control.insert(control.end(), {w * i, w * j, w * (0.3 * i * i - 0.2 * j * i), w});
    }
  map2(context, GL_MAP2_VERTEX_4, 0, 1, 3, -1, 1, 4, points(control));
  enable2(GL_MAP2_VERTEX_4);
  context.state.eval.auto_normal = true;
  context.state.lighting.enabled = context.state.lighting.light_enabled[0] = true;
  const auto at = [&](double u, double v) {
    Vec4 sum{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k)
          sum[k] +=
              control[static_cast<std::size_t>(16 * i + 4 * j) + k] * bernstein(2, i, u) * bernstein(3, j, (v + 1) / 2);
    return sum;
  };
  for (const double u : {0.1, 0.5, 0.8})
    for (const double v : {-0.7, 0.0, 0.6}) {
      const ShadedVertex shaded = drawn([&] { eval_coord2(context, u, v); }).at(0);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(shaded.eye[k], at(u, v)[k], 1e-12);
      // The light stands along z: its diffuse part is the z of the normal.
      constexpr double kStep = 1e-6;
      const auto slope = [&](double du, double dv) {
        const Vec4 a = at(u - du, v - dv), b = at(u + du, v + dv);
        return Vec3{b[0] / b[3] - a[0] / a[3], b[1] / b[3] - a[1] / a[3], b[2] / b[3] - a[2] / a[3]};
      };
      const Vec3 p = slope(kStep, 0), q = slope(0, kStep);
      const Vec3 n{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
      const double z = n[2] / std::hypot(n[0], n[1], n[2]);
      EXPECT_NEAR(shaded.color[0][0], 0.2 * 0.2 + 0.8 * std::max(z, 0.0), 1e-6);
    }
}

TEST_F(Evaluators, AttributesOfTheMomentOnly) {
  map1(context, GL_MAP1_VERTEX_4, 0, 1, 2, points({0, 0, 0, 1, 1, 0, 0, 1}));
  map1(context, GL_MAP1_COLOR_4, 0, 1, 2, points({0, 0, 0, 1, 1, 1, 1, 1}));
  map1(context, GL_MAP1_TEXTURE_COORD_1, 0, 1, 1, points({9}));
  map1(context, GL_MAP1_TEXTURE_COORD_2, 0, 1, 2, points({0, 4, 2, 8}));
  for (const GLenum target : std::initializer_list<GLenum>{GL_MAP1_VERTEX_4, GL_MAP1_COLOR_4, GL_MAP1_TEXTURE_COORD_1,
                                                           GL_MAP1_TEXTURE_COORD_2})
    enable1(target);
  const CurrentState before = context.state.current;
  const auto vertices = drawn([&] { eval_coord1(context, 0.25); });
  EXPECT_EQ(vertices.at(0).color[0], (Vec4{0.25, 0.25, 0.25, 1}));
  EXPECT_EQ(vertices[0].tex_coord[0], (Vec4{0.5, 5, 0, 1}));  // the largest map of texture coordinates counts
  EXPECT_EQ(context.state.current.color, before.color);
  EXPECT_EQ(context.state.current.tex_coord, before.tex_coord);
}

TEST_F(Evaluators, GridsEndAtTheirEnds) {
  map1(context, GL_MAP1_VERTEX_3, 0, 1, 2, points({0, 0, 0, 1, 1, 1}));
  enable1(GL_MAP1_VERTEX_3);
  map_grid1(context, 3, 0.1, 0.7);
  const auto vertices = drawn([&] {
    for (int i = 0; i <= 3; ++i) eval_point1(context, i);
  });
  ASSERT_EQ(vertices.size(), 4U);
  EXPECT_EQ(vertices[0].eye[0], 0.1);
  EXPECT_NEAR(vertices[1].eye[0], 0.3, 1e-15);
  EXPECT_EQ(vertices[3].eye[0], 0.7);
}

TEST_F(Evaluators, MapsAsTheyBegin) {
  EXPECT_EQ(get_map(context, GL_MAP2_VERTEX_4, GL_COEFF).value, (std::vector<double>{0, 0, 0, 1}));
  EXPECT_EQ(get_map(context, GL_MAP1_COLOR_4, GL_COEFF).value, (std::vector<double>{1, 1, 1, 1}));
  EXPECT_EQ(get_map(context, GL_MAP1_NORMAL, GL_COEFF).value, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(get_map(context, GL_MAP1_NORMAL, GL_ORDER).value, (std::vector<double>{1}));
  EXPECT_EQ(get_map(context, GL_MAP2_NORMAL, GL_DOMAIN).value, (std::vector<double>{0, 1, 0, 1}));
  map2(context, GL_MAP2_INDEX, 1, 2, 2, 3, 4, 1, points({5, 6}));
  EXPECT_EQ(get_map(context, GL_MAP2_INDEX, GL_ORDER).value, (std::vector<double>{2, 1}));
  EXPECT_EQ(get_map(context, GL_MAP2_INDEX, GL_DOMAIN).value, (std::vector<double>{1, 2, 3, 4}));
}

TEST_F(Evaluators, Errors) {
  const auto error_of = [&](auto&& command) {
    context.error = GL_NO_ERROR;
    command();
    return context.error;
  };
  const auto many = points(std::vector<double>(4 * kEvalOrder * kEvalOrder));
  const auto map1_error = [&](GLenum target, double u1, double u2, GLint order) {
    return error_of([&] { map1(context, target, u1, u2, order, many); });
  };
  EXPECT_EQ(map1_error(GL_MAP2_COLOR_4, 0, 1, 1), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(map1_error(GL_MAP1_COLOR_4, 1, 1, 1), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(map1_error(GL_MAP1_COLOR_4, 0, 1, 0), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(map1_error(GL_MAP1_COLOR_4, 0, 1, kEvalOrder + 1), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(map1_error(GL_MAP1_COLOR_4, 0, 1, kEvalOrder), GLenum{GL_NO_ERROR});
  EXPECT_EQ(error_of([&] { map_grid2(context, 1, 0, 1, 0, 0, 1); }), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of([&] { eval_mesh1(context, GL_FILL, 0, 1); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_of([&] { (void)get_map(context, GL_MAP1_COLOR_4, GL_COLOR); }), GLenum{GL_INVALID_ENUM});
  // Without a map of vertices nothing is drawn, at once.
  EXPECT_EQ(error_of([&] { eval_mesh2(context, GL_FILL, -2147483647, 2147483647, -2147483647, 2147483647); }),
            GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace halfplane::gl::eval_test
