// Transformation, lighting, texture coordinates and fog of eight vertices at a time (OpenGL 1.5, 2.11 to 2.14, 3.3, 3.10), for
// the instruction set of the unit that includes this.
#pragma once

#include <limits>

#include "../../model/engines/functional/kernels/lanes.inl"
#include "shade_kernels.hpp"

namespace halfplane::gl::HALFPLANE_ISA_NAME {
namespace {

using namespace functional::HALFPLANE_ISA_NAME;  // NOLINT(google-build-using-namespace): lanes of the same set

using Number = Pack<double, kVertexLanes>;
using Mask = Pack<std::int64_t, kVertexLanes>;
constexpr unsigned kAllLanes = (1U << kVertexLanes) - 1;

/// A bit for each lane of a mask.
HALFPLANE_LEAF unsigned lane_bits(const Mask& mask) {
  unsigned bits = 0;
  for (int i = 0; i < Mask::kParts; ++i) {
#if HALFPLANE_ISA == 512
    bits |= static_cast<unsigned>(_mm512_movepi64_mask((__m512i)mask.part[i]));
#elif HALFPLANE_ISA == 256
    bits |= static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask.part[i])) << i * Mask::kLanes;
#elif defined(__x86_64__)
    bits |= static_cast<unsigned>(_mm_movemask_pd((__m128d)mask.part[i])) << i * Mask::kLanes;
#else
    for (int lane = 0; lane < Mask::kLanes; ++lane)
      bits |= (mask.part[i][lane] != 0 ? 1U : 0U) << (i * Mask::kLanes + lane);
#endif
  }
  return bits;
}

HALFPLANE_LEAF Number sqrt(const Number& v) {
  Number r;
  for (int i = 0; i < Number::kParts; ++i) {
#if HALFPLANE_ISA == 512
    r.part[i] = (Number::Register)_mm512_sqrt_pd((__m512d)v.part[i]);
#elif HALFPLANE_ISA == 256
    r.part[i] = (Number::Register)_mm256_sqrt_pd((__m256d)v.part[i]);
#elif defined(__x86_64__)
    r.part[i] = (Number::Register)_mm_sqrt_pd((__m128d)v.part[i]);
#else
    for (int lane = 0; lane < Number::kLanes; ++lane) r.part[i][lane] = std::sqrt(v.part[i][lane]);
#endif
  }
  return r;
}

HALFPLANE_LEAF Number absolute(const Number& v) {
  return as<Number>(as<Mask>(v) & std::numeric_limits<std::int64_t>::max());
}

/// Negative numbers as 0.
HALFPLANE_LEAF Number at_least_zero(const Number& v) {
  return functional::HALFPLANE_ISA_NAME::select(v < 0, Number(0), v);
}
/// As gl::held().
HALFPLANE_LEAF Number held(const Number& v) { return min(max(v, Number(0)), Number(1)); }

struct Vector {
  Number x, y, z;
  HALFPLANE_LEAF Vector(const Number& x_, const Number& y_, const Number& z_) : x(x_), y(y_), z(z_) {}
  HALFPLANE_LEAF Vector(const Vec3& v) : x(v[0]), y(v[1]), z(v[2]) {}  // NOLINT: the same in all lanes
  HALFPLANE_LEAF Vector(const Vector& v) : x(v.x), y(v.y), z(v.z) {}
  HALFPLANE_LEAF Vector& operator=(const Vector& v) {
    x = v.x, y = v.y, z = v.z;
    return *this;
  }
};
HALFPLANE_LEAF Number dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HALFPLANE_LEAF Vector operator*(const Vector& a, const Number& factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}
HALFPLANE_LEAF Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HALFPLANE_LEAF Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HALFPLANE_LEAF Vector select(const Mask& mask, const Vector& a, const Vector& b) {
  using functional::HALFPLANE_ISA_NAME::select;
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
/// Zero stays zero.
HALFPLANE_LEAF Vector unit(const Vector& a) {
  const Number square = dot(a, a);
  return select(square > 0, a * (1.0 / sqrt(square)), a);
}

struct Row {
  Number x, y, z, w;
  HALFPLANE_LEAF Row(const Number& x_, const Number& y_, const Number& z_, const Number& w_)
      : x(x_), y(y_), z(z_), w(w_) {}
  HALFPLANE_LEAF Row(const Row& v) : x(v.x), y(v.y), z(v.z), w(v.w) {}
  HALFPLANE_LEAF Row& operator=(const Row& v) {
    x = v.x, y = v.y, z = v.z, w = v.w;
    return *this;
  }
  HALFPLANE_LEAF Number& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};
HALFPLANE_LEAF Number dot(const Vec4& a, const Row& b) { return a[0] * b.x + a[1] * b.y + a[2] * b.z + a[3] * b.w; }
/// As gl::transformed().
HALFPLANE_LEAF Row transformed(const Mat4& m, const Row& v) {
  const auto row = [&](std::size_t i)
                       HALFPLANE_LAMBDA { return m[i] * v.x + m[4 + i] * v.y + m[8 + i] * v.z + m[12 + i] * v.w; };
  return {row(0), row(1), row(2), row(3)};
}

/// The point of homogeneous coordinates; the direction of one at infinity.
HALFPLANE_LEAF Vector point_of(const Row& v) {
  const Vector at{v.x, v.y, v.z};
  if (lane_bits(v.w == 1) == kAllLanes) return at;
  const Number divisor = functional::HALFPLANE_ISA_NAME::select(v.w == 0, Number(1), v.w);
  return {at.x / divisor, at.y / divisor, at.z / divisor};
}

/// base^exponent for an exponent of at most 128, most often an integer: by squaring.
HALFPLANE_INLINE Number power(Number base, double exponent) {
  const auto whole = static_cast<unsigned>(exponent);
  if (whole != exponent) {
    Column lanes;
    base.store(lanes.data());
    for (double& lane : lanes) lane = std::pow(lane, exponent);
    return Number::load(lanes.data());
  }
  Number result(1);
  for (unsigned bits = whole; bits != 0; bits >>= 1, base = base * base)
    if ((bits & 1) != 0) result = result * base;
  return result;
}

/// Eight vertices of the input.
struct Input {
  const InputVertices& vertices;
  const InputVertices::Values& values;
  std::size_t block;

  [[nodiscard]] HALFPLANE_LEAF Number number(std::size_t i) const {
    const Column* const column = vertices.column(i, block);
    return column == nullptr ? Number(values[i]) : Number::load(column->data());
  }
  [[nodiscard]] HALFPLANE_LEAF Vector vector(Attribute attribute) const {
    const std::size_t i = input_number(attribute);
    return {number(i), number(i + 1), number(i + 2)};
  }
  [[nodiscard]] HALFPLANE_LEAF Row row(Attribute attribute, std::size_t unit = 0) const {
    const std::size_t i = input_number(attribute, unit);
    return {number(i), number(i + 1), number(i + 2), number(i + 3)};
  }
};

HALFPLANE_LEAF void store(const Row& row, Column* to) {
  row.x.store(to[0].data()), row.y.store(to[1].data()), row.z.store(to[2].data()), row.w.store(to[3].data());
}

using Shaded = ShadedVertices;

/// How much of the lights arrives at a side of a surface, before its material.
struct Arrived {
  Vector diffuse{Vec3{}}, specular{Vec3{}};
};

/// The light of a vertex with its normal in eye space (OpenGL 1.5, 2.14.1).
struct Light {
  const Context& context;
  const Vector& normal;
  const Row& eye_row;
  const Vector& eye;
  const Row& color;  ///< given, which materials may follow
  Vector to_viewer{context.state.lighting.local_viewer ? unit(eye * Number(-1)) : Vector(kTowardsViewer)};
  Vector ambient{context.shading->scene_ambient};
  Arrived front{}, back{};

  [[nodiscard]] HALFPLANE_LEAF bool is_lit_twice() const { return context.state.lighting.two_side; }

  HALFPLANE_LEAF void add(const LightConstants& light) {
    const LightingState& state = context.state.lighting;
    Vector to_light(light.position);
    Number strength(1);
    if (light.is_positional) {
      to_light = select(eye_row.w == 0, eye * Number(-1), to_light - eye);
      const Number distance = sqrt(dot(to_light, to_light));
      to_light = select(distance > 0, to_light * (1.0 / distance), to_light);
      if (light.is_attenuated) {
        const Vec3& k = light.attenuation;
        strength = 1.0 / (k[0] + distance * (k[1] + distance * k[2]));
      }
    }
    Mask arrives(-1);
    if (light.is_spot) {
      const Number cosine = -dot(to_light, Vector(light.spot_direction));
      arrives = cosine >= light.spot_cosine;
      strength = strength * power(at_least_zero(cosine), light.spot_exponent);
    }
    ambient = select(arrives, ambient + Vector(light.ambient) * strength, ambient);
    const Number facing = dot(normal, to_light);
    Vector half(light.half);
    if (state.local_viewer || light.is_positional) {
      half = unit(to_light + to_viewer);
    }
    const Number shining = dot(normal, half);
    add_side(light, 0, arrives & (facing > 0), strength * facing, shining, strength, front);
    if (is_lit_twice())
      add_side(light, 1, arrives & ~(facing > 0) & (facing != 0), strength * -1.0 * facing, -shining, strength, back);
  }

  HALFPLANE_LEAF void add_side(const LightConstants& light, std::size_t side, const Mask& faces, const Number& diffuse,
                               const Number& shining, const Number& strength, Arrived& arrived) const {
    arrived.diffuse = select(faces, arrived.diffuse + Vector(light.diffuse) * diffuse, arrived.diffuse);
    const MaterialUse& use = context.shading->material[side];
    if (!use.is_shiny) return;
    const Number shine = strength * power(at_least_zero(shining), context.state.lighting.material[side].shininess);
    arrived.specular = select(faces, arrived.specular + Vector(light.specular) * shine, arrived.specular);
  }

  /// Puts the colours of a side, `to` places.
  HALFPLANE_LEAF void store_side(std::size_t side, const Arrived& arrived, Column* block, std::size_t to) const {
    const LightingState& state = context.state.lighting;
    const Material& material = state.material[side];
    const MaterialUse& use = context.shading->material[side];
    const bool separate = state.color_control == GL_SEPARATE_SPECULAR_COLOR;
    const auto put = [&](std::size_t i, const Number& own, const Number& light, const Number& towards,
                         const Number& shine_of) HALFPLANE_LAMBDA {
      const auto of = [&](MaterialUse::Part part, const Vec4& constant)
                          HALFPLANE_LAMBDA { return use.follows_color[part] ? own : Number(constant[i]); };
      const Number shine = of(MaterialUse::specular, material.specular) * shine_of;
      const Number sum = of(MaterialUse::emission, material.emission) +
                         of(MaterialUse::ambient, material.ambient) * light +
                         of(MaterialUse::diffuse, material.diffuse) * towards + (separate ? Number(0) : shine);
      const Number first = held(sum), second = separate ? held(shine) : Number(0);
      for (std::size_t place = side; place < to; ++place) {
        first.store(block[Shaded::kColor + 4 * place + i].data());
        second.store(block[Shaded::kSecondary + 4 * place + i].data());
      }
    };
    put(0, color.x, ambient.x, arrived.diffuse.x, arrived.specular.x);
    put(1, color.y, ambient.y, arrived.diffuse.y, arrived.specular.y);
    put(2, color.z, ambient.z, arrived.diffuse.z, arrived.specular.z);
    const Number alpha = held(use.follows_color[MaterialUse::diffuse] ? color.w : Number(material.diffuse[3]));
    for (std::size_t place = side; place < to; ++place) {
      alpha.store(block[Shaded::kColor + 4 * place + 3].data());
      Number(0).store(block[Shaded::kSecondary + 4 * place + 3].data());
    }
  }

  HALFPLANE_LEAF void store(Column* block) {
    for (const LightConstants& light : context.shading->lights) add(light);
    store_side(0, front, block, is_lit_twice() ? 1 : 2);
    if (is_lit_twice()) store_side(1, back, block, 2);
  }
};

/// Coordinates as glTexGen makes them (OpenGL 1.5, 2.11.4).
HALFPLANE_INLINE void generate(const TextureUnit& unit_state, const Row& object, const Row& eye, const Vector& at,
                               const Vector& normal, Row& coordinates) {
  const Vector to_vertex = unit(at), reflection = to_vertex - normal * (2.0 * dot(normal, to_vertex));
  const auto of = [](const Vector& v, std::size_t i) HALFPLANE_LAMBDA {
    return i == 0 ? v.x : i == 1 ? v.y : i == 2 ? v.z : Number(0);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const TexGen& gen = unit_state.gen[i];
    if (!gen.enabled) continue;
    Number& to = coordinates[i];
    switch (gen.mode) {
      case GL_OBJECT_LINEAR: to = dot(gen.object, object); break;
      case GL_EYE_LINEAR: to = dot(gen.eye, eye); break;
      case GL_SPHERE_MAP: {
        const Number sphere = 2.0 * sqrt(dot(reflection, reflection) + 2.0 * reflection.z + 1);
        to = i < 2 ? functional::HALFPLANE_ISA_NAME::select(sphere > 0, of(reflection, i) / sphere + 0.5, Number(0.5))
                   : Number(0.5);
        break;
      }
      case GL_NORMAL_MAP: to = of(normal, i); break;
      default: to = of(reflection, i);
    }
  }
}

HALFPLANE_LEAF void shade_block(const Context& context, const Input& input, Column* block, bool all_textures) {
  const ShadingConstants& constants = *context.shading;
  const State& state = context.state;
  const Row position = input.row(Attribute::position), eye = transformed(context.modelview.back(), position);
  store(eye, block + Shaded::kEye);
  const Vector at = point_of(eye);
  const Number distance =
      state.fog.coord_source == GL_FOG_COORDINATE ? input.number(input_number(Attribute::fog_coord)) : absolute(at.z);
  distance.store(block[Shaded::kFogDistance].data());
  input.number(input_number(Attribute::edge_flag)).store(block[Shaded::kEdgeFlag].data());

  Vector normal{Vec3{}};
  if (constants.needs_normal || all_textures) {
    const Vector given = input.vector(Attribute::normal);
    const auto& rows = constants.normal_rows;
    normal = {dot(given, Vector(rows[0])), dot(given, Vector(rows[1])), dot(given, Vector(rows[2]))};
    if (state.transform.normalize) normal = unit(normal);
  }
  const Row color = input.row(Attribute::color);
  if (state.lighting.enabled) {
    Light{context, normal, eye, at, color}.store(block);
  } else {
    const Vector given = state.fog.color_sum ? input.vector(Attribute::secondary) : Vector(Vec3{});
    const Row first{held(color.x), held(color.y), held(color.z), held(color.w)},
        second{held(given.x), held(given.y), held(given.z), Number(0)};
    for (std::size_t side = 0; side < 2; ++side) {
      store(first, block + Shaded::kColor + 4 * side);
      store(second, block + Shaded::kSecondary + 4 * side);
    }
  }

  for (std::size_t i = 0; i < kTextureUnits; ++i) {
    Row coordinates = input.row(Attribute::tex_coord, i);
    if (constants.has_texture[i] || all_textures) {
      if (constants.has_texgen[i]) generate(state.texture.unit[i], position, eye, at, normal, coordinates);
      if (constants.has_texture_matrix[i]) coordinates = transformed(context.texture_matrix[i].back(), coordinates);
    }
    store(coordinates, block + Shaded::kTexCoord + 4 * i);
  }

  const PointState& point = state.point;
  Number size = input.number(input_number(Attribute::point_size));
  if (constants.is_attenuated) {
    const Number from_eye = sqrt(dot(at, at));
    const Vec3& k = point.attenuation;
    size = size / sqrt(k[0] + from_eye * (k[1] + from_eye * k[2]));
  }
  const Number least(point.least), limited = min(size, Number(point.largest));
  functional::HALFPLANE_ISA_NAME::select(size > least, limited, least).store(block[Shaded::kPointSize].data());
}

}  // namespace

unsigned place(const Context& context, const InputVertices& vertices, std::size_t first_block,
               ShadedVertices::Block* blocks) {
  unsigned beyond = ~0U;
  for (std::size_t b = first_block; b * kVertexLanes < vertices.size(); ++b) {
    Column* const block = blocks[b].data();
    const Row position = Input{vertices, vertices.values(), b}.row(Attribute::position);
    const Row clip = transformed(context.shading->to_clip, position);
    store(clip, block + Shaded::kClip);
    unsigned planes = 0;
    for (const Number& c : {clip.x, clip.y, clip.z}) {
      planes = planes << 1 | (lane_bits(c < -clip.w) == kAllLanes ? 1U : 0U);
      planes = planes << 1 | (lane_bits(c > clip.w) == kAllLanes ? 1U : 0U);
    }
    beyond &= planes;
  }
  return beyond;
}

void finish(const Context& context, const InputVertices& vertices, const InputVertices::Values& values,
            std::size_t first_block, ShadedVertices::Block* blocks, bool all_textures) {
  for (std::size_t b = first_block; b * kVertexLanes < vertices.size(); ++b)
    shade_block(context, {vertices, values, b}, blocks[b].data(), all_textures);
}

BatchTraits traits(std::span<const ShadedVertices::Block> blocks, std::size_t unit) {
  const ShadedVertices::Block& first = blocks.front();
  const std::size_t q_at = Shaded::kTexCoord + 4 * unit + 3;
  Mask other_color(0), other_w(0), other_q(0), no_positive_q(0), secondary(0), other_fog(0), other_back(0);
  for (const ShadedVertices::Block& block : blocks) {
    const auto of = [&](std::size_t i) HALFPLANE_LAMBDA { return Number::load(block[i].data()); };
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t color = Shaded::kColor + i, added = Shaded::kSecondary + i;
      other_color |= (of(color) != first[color][0]) | (of(added) != first[added][0]);
      other_back |= (of(color) != of(color + 4)) | (of(added) != of(added + 4));
      secondary |= of(added) != 0;
    }
    const Number w = of(Shaded::kClip + 3), q = of(q_at), fog = of(Shaded::kFogDistance);
    other_w |= w != first[Shaded::kClip + 3][0];
    other_q |= q != first[q_at][0];
    no_positive_q |= ~(q > 0);
    other_fog |= ~(absolute(absolute(w) - fog) <= 1e-6 * fog);
  }
  const auto is_empty = [](const Mask& mask) HALFPLANE_LAMBDA { return lane_bits(mask) == 0; };
  return {.has_one_color = is_empty(other_color),
          .has_one_w = is_empty(other_w),
          .has_one_q = is_empty(other_q),
          .has_positive_q = is_empty(no_positive_q),
          .has_secondary = !is_empty(secondary),
          .is_fogged_by_w = is_empty(other_fog),
          .is_two_sided = !is_empty(other_back)};
}

}  // namespace halfplane::gl::HALFPLANE_ISA_NAME
