// Vertices shaded by the kernels of every instruction set: the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <vector>

#include "gl/core/commands.hpp"
#include "gl/core/shade_kernels.hpp"
#include "model/engines/functional/kernels.hpp"

namespace halfplane::gl::shade_kernels_test {
namespace {

using Blocks = std::vector<ShadedVertices::Block>;

std::vector<const ShadeKernels*> kernels_here() {
  std::vector<const ShadeKernels*> kernels{&kPortableShading};
#if defined(__x86_64__) && !defined(__clang__)
  for (const ShadeKernels* const of : {&kAvx2Shading, &kAvx512Shading})
    if (std::ranges::any_of(functional::available_kernels(), [&](const auto* k) { return k->name == of->name; }))
      kernels.push_back(of);
#endif
  return kernels;
}

struct Random {
  std::mt19937 source{20261130};
  double number(double low, double high) { return std::uniform_real_distribution(low, high)(source); }
  bool coin() { return number(0, 1) < 0.5; }
  GLenum one_of(std::initializer_list<GLenum> names) {
    return names.begin()[static_cast<std::size_t>(number(0, static_cast<double>(names.size())))];
  }
  Vec4 row(double low, double high) { return {number(low, high), number(low, high), number(low, high), number(0, 1)}; }
  Vec3 vector() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }
};

void set_state(State& state, Random& random) {
  LightingState& lighting = state.lighting;
  lighting.enabled = random.coin();
  lighting.two_side = random.coin(), lighting.local_viewer = random.coin();
  lighting.color_control = random.one_of({GL_SINGLE_COLOR, GL_SEPARATE_SPECULAR_COLOR});
  lighting.color_material = random.coin();
  lighting.color_material_face = random.one_of({GL_FRONT, GL_BACK, GL_FRONT_AND_BACK});
  lighting.color_material_mode =
      random.one_of({GL_EMISSION, GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_AMBIENT_AND_DIFFUSE});
  for (std::size_t i = 0; i < kLights; ++i) {
    lighting.light_enabled[i] = random.number(0, 1) < 0.3;
    Light& light = lighting.light[i];
    light.ambient = random.row(0, 0.5), light.diffuse = random.row(0, 0.5), light.specular = random.row(0, 0.5);
    light.position = random.row(-3, 3);
    if (random.coin()) light.position[3] = 0;
    light.spot_direction = random.vector();
    if (random.coin()) light.spot_cutoff = random.number(30, 90), light.spot_exponent = random.number(0, 5);
    if (random.coin()) light.attenuation = {1, random.number(0, 1), random.number(0, 1)};
  }
  for (Material& material : lighting.material) {
    material.specular = random.coin() ? random.row(0, 1) : Vec4{};
    material.shininess = random.coin() ? 20 : random.number(0, 128);
  }
  state.transform.normalize = random.coin();
  state.fog.coord_source = random.one_of({GL_FRAGMENT_DEPTH, GL_FOG_COORDINATE});
  state.fog.color_sum = random.coin();
  if (random.coin()) state.point.attenuation = {1, 0.5, 0.25};
  for (TextureUnit& unit : state.texture.unit) {
    unit.enabled[1] = random.coin();
    for (TexGen& gen : unit.gen) {
      gen.enabled = random.coin();
      gen.mode = random.one_of({GL_OBJECT_LINEAR, GL_EYE_LINEAR, GL_SPHERE_MAP, GL_NORMAL_MAP, GL_REFLECTION_MAP});
    }
  }
}

TEST(GlShadeKernels, EveryInstructionSetGivesTheSameBits) {
  constexpr std::size_t kVertices = 21, kBlocks = 3;
  Random random;
  for (int round = 0; round < 100; ++round) {
    Context context;
    rotate(context, random.number(0, 360), 0.2, random.number(-1, 1), 1);
    translate(context, 1, -2, random.number(-5, 5));
    set_state(context.state, random);
    matrix_mode(context, GL_TEXTURE);
    if (random.coin()) rotate(context, 30, 1, 1, 1);
    ++context.revision;
    begin(context, GL_POINTS);
    for (std::size_t i = 0; i < kVertices; ++i) {
      const Vec3 n = random.vector();
      normal(context, n[0], n[1], n[2]);
      fog_coord(context, random.number(0, 9));
      const Vec4 c = random.row(0, 1), t = random.row(-1, 1);
      color(context, c[0], c[1], c[2], c[3]);
      secondary_color(context, c[2], c[1], c[0]);
      tex_coord(context, GL_TEXTURE0, t[0], t[1], t[2], t[3]);
      vertex(context, t[2], c[0], n[0], random.coin() ? 1 : random.number(0, 2));
    }
    finish_vertices(context, context.input, context.input.values(), context.shaded);  // what follows from the material
    Blocks first;
    for (const ShadeKernels* const kernels : kernels_here()) {
      Blocks blocks(kBlocks);
      const unsigned beyond = kernels->place(context, context.input, 0, blocks.data());
      kernels->finish(context, context.input, context.input.values(), 0, blocks.data(), false);
      if (first.empty()) first = blocks;
      EXPECT_EQ(beyond, kPortableShading.place(context, context.input, 0, blocks.data())) << kernels->name;
      for (std::size_t b = 0; b < kBlocks; ++b)
        for (std::size_t i = 0; i < ShadedVertices::kNumbers; ++i)
          for (std::size_t lane = 0; lane < kVertexLanes; ++lane)
            EXPECT_EQ(std::bit_cast<std::uint64_t>(blocks[b][i][lane]), std::bit_cast<std::uint64_t>(first[b][i][lane]))
                << kernels->name << ", number " << i;
      const BatchTraits a = kernels->traits(blocks, 0), b = kPortableShading.traits(blocks, 0);
      EXPECT_EQ(a.has_one_color, b.has_one_color);
      EXPECT_EQ(a.is_two_sided, b.is_two_sided);
      EXPECT_EQ(a.is_fogged_by_w, b.is_fogged_by_w);
    }
  }
}

}  // namespace
}  // namespace halfplane::gl::shade_kernels_test
