// Lit vertices against the formula of the specification (OpenGL 1.5, 2.14.1), written again as it stands there; materials and
// lights as state.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gl/core/commands.hpp"
#include "gl/core/shading.hpp"

namespace halfplane::gl::light_test {
namespace {

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 unit(const Vec3& a) { return 1 / std::sqrt(dot(a, a)) * a; }

/// The unit vector from a to b in homogeneous coordinates.
Vec3 towards(const Vec4& a, const Vec4& b) {
  const Vec3 a3{a[0], a[1], a[2]}, b3{b[0], b[1], b[2]};
  if (b[3] == 0) return unit(b3);
  if (a[3] == 0) return unit(-1 * a3);
  return unit(1 / b[3] * b3 + -1 / a[3] * a3);
}

struct Lit {
  Vec3 primary{}, secondary{};
};

/// `eye` and `normal` in eye space.
Lit formula(const LightingState& state, const Material& material, const Vec4& eye, const Vec3& normal) {
  Lit lit;
  for (std::size_t c = 0; c < 3; ++c)
    lit.primary[c] = material.emission[c] + material.ambient[c] * state.model_ambient[c];
  for (std::size_t i = 0; i < kLights; ++i) {
    if (!state.light_enabled[i]) continue;
    const Light& light = state.light[i];
    const Vec3 to_light = towards(eye, light.position);
    double attenuation = 1;
    if (light.position[3] != 0) {
      const Vec3 way = 1 / light.position[3] * Vec3{light.position[0], light.position[1], light.position[2]} +
                       -1 / eye[3] * Vec3{eye[0], eye[1], eye[2]};
      const double d = std::sqrt(dot(way, way));
      attenuation = 1 / (light.attenuation[0] + light.attenuation[1] * d + light.attenuation[2] * d * d);
    }
    double spot = 1;
    if (light.spot_cutoff != 180) {
      const double cosine = dot(-1 * to_light, unit(light.spot_direction));
      spot = cosine >= std::cos(light.spot_cutoff * std::numbers::pi / 180) ? std::pow(cosine, light.spot_exponent) : 0;
    }
    const Vec3 to_eye = state.local_viewer ? towards(eye, {0, 0, 0, 1}) : Vec3{0, 0, 1};
    const double facing = std::max(dot(normal, to_light), 0.0);
    const double shine =
        facing == 0 ? 0 : std::pow(std::max(dot(normal, unit(to_light + to_eye)), 0.0), material.shininess);
    for (std::size_t c = 0; c < 3; ++c) {
      const double scale = attenuation * spot;
      lit.primary[c] +=
          scale * (material.ambient[c] * light.ambient[c] + facing * material.diffuse[c] * light.diffuse[c]);
      (state.color_control == GL_SINGLE_COLOR ? lit.primary : lit.secondary)[c] +=
          scale * shine * material.specular[c] * light.specular[c];
    }
  }
  return lit;
}

struct Lighting : testing::Test {
  Context context;
  std::mt19937 random{20260127};

  double number(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  Vec4 color() { return {number(0, 0.6), number(0, 0.6), number(0, 0.6), number(0, 1)}; }
  Vec3 direction() { return unit({number(-1, 1), number(-1, 1), number(-1, 1)}); }
  bool coin() { return number(0, 1) < 0.5; }
  /// As a command with a vector.
  static Params vector(const Vec4& value) { return {value, false, true}; }
  static Params scalar(double value) { return {{value}, false, false}; }

  ShadedVertex vertex_of(const Vec4& position) {
    ++context.revision;
    begin(context, GL_POINTS);
    vertex(context, position[0], position[1], position[2], position[3]);
    context.primitive = Context::kNoPrimitive;
    shade_pending(context);
    return context.shaded[0];
  }
};

TEST_F(Lighting, IsTheFormula) {
  LightingState& state = context.state.lighting;
  state.enabled = true;
  context.state.transform.normalize = true;
  for (int round = 0; round < 400; ++round) {
    load_identity(context);
    translate(context, number(-2, 2), number(-2, 2), number(-9, -3));
    rotate(context, number(0, 360), number(-1, 1), number(-1, 1), number(0.1, 1));
    scale(context, number(0.3, 3), number(0.3, 3), number(0.3, 3));
    state.two_side = coin(), state.local_viewer = coin();
    state.color_control = coin() ? GL_SINGLE_COLOR : GL_SEPARATE_SPECULAR_COLOR;
    state.model_ambient = color();
    for (std::size_t i = 0; i < kLights; ++i) {
      state.light_enabled[i] = number(0, 1) < 0.3;
      const auto name = static_cast<GLenum>(GL_LIGHT0 + i);
      for (const GLenum pname : std::initializer_list<GLenum>{GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR})
        light(context, name, pname, vector(color()));
      light(context, name, GL_POSITION,
            vector({number(-3, 3), number(-3, 3), number(0, 9), coin() ? number(0.5, 2) : 0}));
      const Vec3 spot = direction();
      light(context, name, GL_SPOT_DIRECTION, vector({3 * spot[0], 3 * spot[1], 3 * spot[2]}));
      light(context, name, GL_SPOT_CUTOFF, scalar(coin() ? 180 : number(30, 90)));
      light(context, name, GL_SPOT_EXPONENT, scalar(coin() ? 0 : number(0, 5)));
      for (const GLenum pname :
           std::initializer_list<GLenum>{GL_CONSTANT_ATTENUATION, GL_LINEAR_ATTENUATION, GL_QUADRATIC_ATTENUATION})
        light(context, name, pname, scalar(coin() ? 1 : number(0.1, 1)));
    }
    for (const GLenum face : std::initializer_list<GLenum>{GL_FRONT, GL_BACK}) {
      for (const GLenum pname : std::initializer_list<GLenum>{GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION})
        material(context, face, pname, vector(color()));
      material(context, face, GL_SHININESS, scalar(coin() ? 0 : number(0, 128)));
    }
    const Vec3 n = direction();
    normal(context, n[0], n[1], n[2]);
    const Vec4 position{number(-1, 1), number(-1, 1), number(-1, 1), coin() ? 1 : number(0.5, 2)};
    const ShadedVertex shaded = vertex_of(position);

    // A normal stays perpendicular to its surface.
    const Mat4& m = context.modelview.back();
    const auto moved = [&](const Vec3& d) {
      return Vec3{m[0] * d[0] + m[4] * d[1] + m[8] * d[2], m[1] * d[0] + m[5] * d[1] + m[9] * d[2],
                  m[2] * d[0] + m[6] * d[1] + m[10] * d[2]};
    };
    const Vec3 tangent = unit(cross(n, std::abs(n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 eye_normal = unit(cross(moved(tangent), moved(cross(n, tangent))));
    for (std::size_t side = 0; side < 2; ++side) {
      const bool is_back = side == 1 && state.two_side;
      const Material& sided = state.material[is_back ? 1 : 0];
      const Lit lit = formula(state, sided, shaded.eye, is_back ? -1 * eye_normal : eye_normal);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(shaded.color[side][c], std::min(lit.primary[c], 1.0), 1e-9) << round << ' ' << side << ' ' << c;
        EXPECT_NEAR(shaded.secondary[side][c], std::min(lit.secondary[c], 1.0), 1e-9) << round << ' ' << side;
      }
      EXPECT_EQ(shaded.color[side][3], sided.diffuse[3]);
    }
  }
  EXPECT_EQ(context.error, GLenum{GL_NO_ERROR});
}

TEST_F(Lighting, RescaleUndoesAUniformScale) {
  context.state.lighting.enabled = context.state.lighting.light_enabled[0] = true;
  const auto lit = [&](double size, bool rescales) {
    load_identity(context);
    scale(context, size, size, size);
    rotate(context, 40, 1, 2, 3);
    context.state.transform.rescale_normal = rescales;
    return vertex_of({0, 0, 0, 1}).color[0][1];
  };
  EXPECT_NEAR(lit(5, true), lit(1, false), 1e-12);
  EXPECT_LT(lit(5, false), lit(1, false) - 0.1);
}

TEST_F(Lighting, ColorMaterialFollowsTheColor) {
  LightingState& state = context.state.lighting;
  state.enabled = true;
  gl::color(context, 0.1, 0.2, 0.3, 0.4);
  color_material(context, GL_FRONT, GL_AMBIENT_AND_DIFFUSE);
  state.color_material = true;
  track_color(context);
  const Vec4 given{0.1, 0.2, 0.3, 0.4};
  EXPECT_EQ(state.material[0].ambient, given);
  EXPECT_EQ(state.material[0].diffuse, given);
  EXPECT_EQ(state.material[1].diffuse, Material().diffuse);
  // Material values that follow the colour are not set by glMaterial; the others are.
  material(context, GL_FRONT_AND_BACK, GL_DIFFUSE, vector({1, 1, 1, 1}));
  EXPECT_EQ(state.material[0].diffuse, given);
  EXPECT_EQ(state.material[1].diffuse, (Vec4{1, 1, 1, 1}));
  // Within a primitive, of each vertex.
  color_material(context, GL_FRONT_AND_BACK, GL_EMISSION);
  state.model_ambient = {};
  begin(context, GL_POINTS);
  gl::color(context, 0.5, 0, 0, 1);
  vertex(context, 0, 0, 0, 1);
  gl::color(context, 0, 0.5, 0, 1);
  vertex(context, 0, 0, 0, 1);
  shade_pending(context);
  EXPECT_EQ(context.shaded[0].color[0][0], 0.5);
  EXPECT_EQ(context.shaded[1].color[0][1], 0.5);
  EXPECT_EQ(context.shaded[1].color[1][0], 0);
}

TEST_F(Lighting, AMaterialThatChangesBetweenVerticesOfOneNormalChangesTheirColors) {
  LightingState& state = context.state.lighting;
  state.enabled = state.light_enabled[0] = true;
  normal(context, 0, 0, 1);
  begin(context, GL_POINTS);
  const std::array<Vec4, 3> emission{{{0.25, 0, 0, 1}, {0.25, 0, 0, 1}, {0.5, 0, 0, 1}}};
  for (const Vec4& color : emission) {
    material(context, GL_FRONT, GL_EMISSION, vector(color));
    vertex(context, 0, 0, 0, 1);
    vertex(context, 1, 0, 0, 1);
  }
  material(context, GL_FRONT, GL_DIFFUSE, vector({0, 0, 0, 0.5}));
  vertex(context, 1, 0, 0, 1);
  normal(context, 0, 0, -1);
  vertex(context, 1, 0, 0, 1);
  shade_pending(context);
  for (std::size_t i = 0; i < context.shaded.size(); ++i) {
    const Vec3 at{0, 0, i == 7 ? -1.0 : 1.0};
    Material then = state.material[0];
    if (i < 6) then.emission = emission[i / 2], then.diffuse = Material().diffuse;
    const Lit lit = formula(state, then, context.shaded[i].eye, at);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(context.shaded[i].color[0][c], std::min(lit.primary[c], 1.0), 1e-12) << i << ' ' << c;
    EXPECT_EQ(context.shaded[i].color[0][3], then.diffuse[3]) << i;
  }
}

TEST_F(Lighting, LanesWithoutAVertexRepeatOneWhateverTheMaterialIsNow) {
  context.state.lighting.enabled = true;
  begin(context, GL_POINTS);
  vertex(context, 0, 0, 0, 1);
  material(context, GL_FRONT, GL_EMISSION, vector({0.5, 0, 0, 1}));
  vertex(context, 1, 0, 0, 1);
  shade_pending(context);
  const Column& red = context.shaded.blocks()[0][ShadedVertices::kColor];
  EXPECT_NE(red[0], red[1]);
  for (std::size_t lane = 2; lane < kVertexLanes; ++lane) EXPECT_EQ(red[lane], red[0]) << lane;
}

TEST_F(Lighting, LightsAreKeptInEyeSpace) {
  translate(context, 1, 2, 3);
  rotate(context, 90, 0, 0, 1);
  light(context, GL_LIGHT2, GL_POSITION, vector({1, 0, 0, 1}));
  light(context, GL_LIGHT2, GL_SPOT_DIRECTION, vector({1, 0, 0, 0}));
  load_identity(context);
  const Values position = get_light(context, GL_LIGHT2, GL_POSITION);
  const Values direction = get_light(context, GL_LIGHT2, GL_SPOT_DIRECTION);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(position.value[i], (Vec4{1, 3, 3, 1}[i]), 1e-12);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(direction.value[i], (Vec3{0, 1, 0}[i]), 1e-12);
}

TEST_F(Lighting, IntegersAreColorsWhereColorsAreMeant) {
  const Params integers{{2147483647, -2147483648.0, 0, 2147483647}, true, true};
  material(context, GL_FRONT, GL_SPECULAR, integers);
  EXPECT_EQ(context.state.lighting.material[0].specular, (Vec4{1, -1, 1 / 4294967295.0, 1}));
  light(context, GL_LIGHT0, GL_POSITION, {{1, 2, 3, 0}, true, true});
  EXPECT_EQ(context.state.lighting.light[0].position, (Vec4{1, 2, 3, 0}));
}

TEST_F(Lighting, ErrorsChangeNothing) {
  const auto error_of = [&](auto&& command) {
    context.error = GL_NO_ERROR;
    command();
    return context.error;
  };
  constexpr GLenum kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE;
  const auto light_error = [&](GLenum name, GLenum pname, const Params& params) {
    return error_of([&] { light(context, name, pname, params); });
  };
  EXPECT_EQ(light_error(GL_LIGHT0 + kLights, GL_AMBIENT, vector({})), kEnum);
  EXPECT_EQ(light_error(GL_LIGHT0, GL_EMISSION, vector({})), kEnum);
  EXPECT_EQ(light_error(GL_LIGHT0, GL_SPOT_CUTOFF, scalar(90.5)), kValue);
  EXPECT_EQ(light_error(GL_LIGHT0, GL_SPOT_CUTOFF, scalar(180)), GLenum{GL_NO_ERROR});
  EXPECT_EQ(light_error(GL_LIGHT0, GL_SPOT_EXPONENT, scalar(129)), kValue);
  EXPECT_EQ(light_error(GL_LIGHT0, GL_LINEAR_ATTENUATION, scalar(-1)), kValue);
  EXPECT_EQ(error_of([&] { material(context, GL_LEFT, GL_AMBIENT, vector({})); }), kEnum);
  EXPECT_EQ(error_of([&] { material(context, GL_FRONT, GL_POSITION, vector({})); }), kEnum);
  EXPECT_EQ(error_of([&] { material(context, GL_FRONT_AND_BACK, GL_SHININESS, scalar(std::nan(""))); }), kValue);
  EXPECT_EQ(error_of([&] { color_material(context, GL_FRONT, GL_SHININESS); }), kEnum);
  EXPECT_EQ(error_of([&] { light_model(context, GL_LIGHT_MODEL_COLOR_CONTROL, scalar(1)); }), kEnum);
  EXPECT_EQ(error_of([&] { fog(context, GL_FOG_DENSITY, scalar(-1)); }), kValue);
  EXPECT_EQ(error_of([&] { fog(context, GL_FOG_MODE, scalar(GL_ADD)); }), kEnum);
  EXPECT_EQ(error_of([&] { (void)get_material(context, GL_FRONT_AND_BACK, GL_AMBIENT); }), kEnum);
  EXPECT_EQ(context.state.lighting.material[0].shininess, 0);
  EXPECT_EQ(context.state.lighting.light[0].attenuation, (Vec3{1, 0, 0}));
  EXPECT_EQ(context.state.fog.density, 1);
}

}  // namespace
}  // namespace halfplane::gl::light_test
