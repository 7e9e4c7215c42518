#include "unit_words.hpp"

#include <algorithm>

#include "../stages/fog_unit.hpp"
#include "../stages/light_unit.hpp"
#include "../stages/stencil_packets.hpp"
#include "../stages/surface.hpp"
#include "../stages/texture_packets.hpp"
#include "host_primitive.hpp"
#include "primitives.hpp"
#include "texture_memory.hpp"

namespace halfplane {

void UnitSignatures::add(const UnitWords& units, SignatureHash& hash) {
  const auto add_optional = [&hash](const auto& word) {
    hash.add(word.has_value());
    if (word) hash.add(*word);
  };
  hash.add(units.texture_state);
  hash.add(units.texture_levels);
  add_optional(units.texture_constant);
  add_optional(units.texture_border);
  hash.add(units.texels);
  if (units.texture_lines)
    for (const uint128 part : {units.texture_lines->low, units.texture_lines->high}) {
      hash.add(static_cast<std::uint64_t>(part));
      hash.add(static_cast<std::uint64_t>(part >> 64));
    }
  for (std::size_t n = 0; n < units.tables.size(); ++n) {
    const RegisterWords& words = units.tables[n];
    hash.add(words != nullptr);
    if (words == nullptr) continue;
    Known& known = known_[n];
    if (known.words != words) {
      SignatureHash of_words;
      for (const std::uint64_t word : *words) of_words.add(word);
      known = {words, of_words.signature()};
    }
    hash.add(known.signature);
  }
  for (const auto& word : {units.colors.ops, units.colors.constant, units.colors.alpha}) add_optional(word);
  for (const std::size_t side : {0U, 1U}) {
    add_optional(units.stencil.test[side]);
    add_optional(units.stencil.update[side]);
  }
}

class HostUnits::Impl {
 public:
  Impl(const Scene& scene, const Config& config, const Widths& widths)
      : scene_(scene),
        config_(config),
        widths_(widths),
        format_(perspective_format(config)),
        texels_(scene.textures.size()) {
    if (has_texture_planes(config)) textures_.emplace(scene, config);
  }

  void fill(const DrawContext& context, const Triangle& triangle, bool is_compared, HostPrimitive& out) {
    const State& state = context.state;
    const bool reads_light = config_.shade_units != 0 && state.color_write;
    const bool reads_fog = config_.fog_units != 0 && state.color_write;
    if (reads_light) out.units.tables[kLight] = light_.of(context.phong);
    const std::shared_ptr<const FogTable> fog = state.fog ? context.fog : nullptr;
    if (reads_fog) out.units.tables[kFog] = fog_.of(fog);
    if (textures_ && state.texture) {
      set_coordinates(context, triangle, out);
      if (is_compared) out.units.texels = texels_of(*state.texture);
    }
    if (state.color_interp == ColorInterp::perspective) set_colors_over_w(context, triangle, out.packet);
    if (reads_fog && fog) set_distance(context, triangle, out);
    if (reads_light && context.phong) set_normals(context, triangle, out.packet);
  }

  void set_for(PrimitiveKind kind, const UnitWords& units, const Send& send) {
    set_colors(units, send);
    set_stencil(units, send);
    if (!textures_ || kind != PrimitiveKind::triangle) return;
    set_table(kLight, units, send);
    set_texture(units, send);
    set_table(kFog, units, send);
  }

 private:
  enum Table : std::size_t { kLight, kFog };  ///< indices of UnitWords::tables

  static std::vector<std::uint64_t> words_of(const FogTable* fog) {
    if (fog == nullptr) return {FogState{}.pack()};
    std::vector<std::uint64_t> words{FogState{true, fog->octave_bits(), fog->color()}.pack()};
    for (const FogLine& line : fog->lines()) words.push_back(fog_line_word(words.size() - 1, line));
    return words;
  }

  static std::vector<std::uint64_t> words_of(const PhongLight* light) {
    if (light == nullptr) return {no_light_word()};
    const auto registers = light_words(light->registers());
    std::vector<std::uint64_t> words(registers.begin(), registers.end());
    for (const FallingLine& line : light->lines())
      words.push_back(light_line_word(words.size() - registers.size(), line));
    return words;
  }

  /// The words of a unit for the last table, or none, of which they were asked.
  template <class Table>
  class LastWords {
   public:
    const RegisterWords& of(const std::shared_ptr<const Table>& table) {
      if (words_ == nullptr || table != table_)
        words_ = std::make_shared<const std::vector<std::uint64_t>>(words_of(table.get()));
      table_ = table;
      return words_;
    }

   private:
    std::shared_ptr<const Table> table_;
    RegisterWords words_;
  };

  /// Writes codes of a plane at the vertices, in the bits of the packet's field.
  void set_plane(std::size_t plane, const auto& codes, PrimitivePacket& packet) const {
    for (std::size_t i = 0; i < 3; ++i)
      packet.vertex.code[i][plane] = static_cast<std::uint32_t>(
          wrap_unsigned(static_cast<std::uint64_t>(codes[i]), widths_.of_plane(plane).code.bits));
  }

  static std::array<double, 3> w_of(const Triangle& triangle) {
    return {triangle.surface[0].w, triangle.surface[1].w, triangle.surface[2].w};
  }

  /// Sets Q of the vertices. Every unit that reads it sets the same.
  QCodes set_q(const DrawContext& context, const Triangle& triangle, PrimitivePacket& packet) const {
    require_positive_w(context, triangle);
    const QCodes q = quantize_q(w_of(triangle), format_.q_bits);
    set_plane(widths_.q_plane, q, packet);
    return q;
  }

  /// Sets Q and P of the vertices, their format, and the state of the texture unit.
  void set_coordinates(const DrawContext& context, const Triangle& triangle, HostPrimitive& out) {
    const State& state = context.state;
    require_positive_w(context, triangle);
    const Texture& texture = scene_.textures[*state.texture];
    const TextureCoordinates coordinates = texture_coordinates(triangle.surface, state, texture, format_);
    PrimitivePacket& packet = out.packet;
    set_plane(widths_.q_plane, coordinates.q, packet);
    for (const std::size_t axis : {0U, 1U}) {
      const OverW& over_w = coordinates.over_w[axis];
      set_plane(widths_.q_plane + 1 + axis, over_w.p, packet);
      const OverWScale scale = over_w_scale(over_w, format_.coordinate);
      packet.coordinates.shift[axis] = scale.shift;
      packet.coordinates.reach[axis] = scale.reach;
      packet.coordinates.origin[axis] = coordinates.reference[axis];
    }
    out.units.texture_state = texture_state(texture, state, textures_->base(*state.texture)).pack();
    if (state.texture_combine == TextureCombine::blend)
      out.units.texture_constant = TextureConstant{state.texture_constant}.pack();
    if (has_border(state.texture_wrap[0]) || has_border(state.texture_wrap[1]))
      out.units.texture_border = TextureBorder{border_texel(state.texture_border, texture.format)}.pack();
    if (config_.texture_unit == TextureUnitKind::trilinear) set_levels(context, triangle, coordinates, out);
  }

  /// Sets Q of the vertices, and its octave in the fog's table.
  void set_distance(const DrawContext& context, const Triangle& triangle, HostPrimitive& out) const {
    (void)set_q(context, triangle, out.packet);
    out.packet.coordinates.fog_octave =
        fog_octave(*context.fog, q_exponent(w_of(triangle), format_.q_bits) + format_.guard_bits);
  }

  /// Sets P of the normals, and Q.
  void set_normals(const DrawContext& context, const Triangle& triangle, PrimitivePacket& packet) const {
    const QCodes q = set_q(context, triangle, packet);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto component = [&](std::size_t i) { return triangle.surface[i].normal[c]; };
      const OverW over_w = quantize_normal({component(0), component(1), component(2)}, q, format_);
      set_plane(widths_.normal_plane() + c, over_w.p, packet);
    }
  }

  /// Sets Q and P of the colours, and their format.
  void set_colors_over_w(const DrawContext& context, const Triangle& triangle, PrimitivePacket& packet) const {
    const QCodes q = set_q(context, triangle, packet);
    packet.coordinates.divides_colors = true;
    for (std::size_t c = 0; c < static_cast<std::size_t>(widths_.colors_over_w); ++c) {
      std::array<double, 3> value{};
      for (std::size_t i = 0; i < 3; ++i) value[i] = triangle.v[i].code[kColorPlane + c];
      const OverW over_w = quantize_over_w(value, q, format_.color);
      set_plane(widths_.color_over_w_plane() + c, over_w.p, packet);
      const OverWScale scale = over_w_scale(over_w, format_.color);
      packet.coordinates.color_shift[c] = scale.shift;
      packet.coordinates.color_reach[c] = scale.reach;
    }
  }

  /// Sets the texture unit's levels. A triangle that the hardware drops needs none.
  void set_levels(const DrawContext& context, const Triangle& triangle, const TextureCoordinates& coordinates,
                  HostPrimitive& out) const {
    const State& state = context.state;
    const TextureLevels levels = texture_levels(scene_.textures[*state.texture], state);
    out.units.texture_levels = levels.pack();
    const std::int64_t area = signed_area(triangle.v[0], triangle.v[1], triangle.v[2]);
    if (!needs_level(levels, state.texture_mag) || cull(area, out.packet.cull, state.front) != CullResult::keep) return;
    const auto order = canonical_order(triangle.v, area);
    std::array<SnappedVertex, 3> v;
    QCodes q{};
    std::array<std::array<double, 3>, 2> texels{};
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = triangle.v[order[i]];
      q[i] = coordinates.q[order[i]];
      for (const std::size_t axis : {0U, 1U}) texels[axis][i] = coordinates.texels[axis][order[i]];
    }
    const LodSetup lod = setup_lod(v, std::abs(area), q, texels, format_.guard_bits, widths_.grid_bits);
    out.units.texture_lines = TextureLines::pack(lod, Sampler(scene_.textures[*state.texture], state).bias);
  }

  /// Signature of all data that can be read from a texture.
  Signature texels_of(std::size_t texture) {
    std::optional<Signature>& known = texels_[texture];
    if (!known) known = signature_of(scene_.textures[texture]);
    return *known;
  }

  /// Sets the colour registers that differ from the wanted values. At the start of a scene their content is unknown.
  void set_colors(const UnitWords& units, const Send& send) {
    const auto set = [&](StateRegister which, std::optional<std::uint32_t> ColorWords::*word) {
      const auto& wanted = units.colors.*word;
      if (!wanted || wanted == colors_.*word) return;
      colors_.*word = wanted;
      send(which, *wanted);
    };
    set(StateRegister::color_ops, &ColorWords::ops);
    set(StateRegister::blend_constant, &ColorWords::constant);
    set(StateRegister::alpha_test, &ColorWords::alpha);
  }

  /// Likewise for the stencil registers. Values common to both sides go in one token.
  void set_stencil(const UnitWords& units, const Send& send) {
    const auto set = [&](StateRegister which, auto member) {
      const auto& wanted = units.stencil.*member;
      auto& held = stencil_.*member;
      std::uint32_t sides = 0;
      for (const std::size_t n : {0U, 1U})
        if (wanted[n] && wanted[n] != held[n]) sides |= 1U << n;
      if (sides == 3 && wanted[0] == wanted[1])
        send(which, with_sides(which, *wanted[0], sides));
      else
        for (const std::size_t n : {0U, 1U})
          if ((sides >> n & 1) != 0) send(which, with_sides(which, *wanted[n], 1U << n));
      for (const std::size_t n : {0U, 1U})
        if (wanted[n]) held[n] = wanted[n];
    };
    set(StateRegister::stencil_test, &StencilWords::test);
    set(StateRegister::stencil_update, &StencilWords::update);
  }

  /// Sets the texture unit for a triangle. The first state of a scene drops texels of an earlier scene.
  void set_texture(const UnitWords& units, const Send& send) {
    if (units.texture_state != texture_state_) {
      TextureState next = TextureState::unpack(units.texture_state);
      next.invalidates = !texture_state_;
      texture_state_ = units.texture_state;
      send(StateRegister::texture, next.pack());
    }
    if (units.texture_constant && units.texture_constant != texture_constant_) {
      texture_constant_ = units.texture_constant;
      send(StateRegister::texture_levels, *texture_constant_);
    }
    if (units.texture_border && units.texture_border != texture_border_) {
      texture_border_ = units.texture_border;
      send(StateRegister::texture_levels, *texture_border_);
    }
    if (config_.texture_unit != TextureUnitKind::trilinear || !TextureState::unpack(units.texture_state).enable) return;
    if (units.texture_levels != texture_levels_) {
      texture_levels_ = units.texture_levels;
      send(StateRegister::texture_levels, units.texture_levels);
    }
    if (!units.texture_lines || units.texture_lines == texture_lines_) return;
    texture_lines_ = units.texture_lines;
    const int part_bits = line_part_bits(state_word_bits(widths_));
    for (int n = 0; n < line_parts(part_bits); ++n)
      send(StateRegister::texture_lines, line_part(*units.texture_lines, part_bits, n));
  }

  /// Sets a unit for a triangle: only words that differ from the unit's.
  void set_table(Table unit, const UnitWords& units, const Send& send) {
    const RegisterWords& wanted = units.tables[unit];
    if (wanted == nullptr || wanted == set_[unit]) return;
    set_[unit] = wanted;
    auto& held = table_[unit];
    held.resize(std::max(held.size(), wanted->size()));
    for (std::size_t n = 0; n < wanted->size(); ++n) {
      if (held[n] == (*wanted)[n]) continue;
      held[n] = (*wanted)[n];
      send(StateRegister::texture_levels, held[n]);
    }
  }

  const Scene& scene_;
  const Config& config_;
  const Widths& widths_;
  const PerspectiveFormat format_;
  std::optional<TextureMemory> textures_;         ///< with a texture unit
  std::vector<std::optional<Signature>> texels_;  ///< of each texture
  LastWords<PhongLight> light_;
  LastWords<FogTable> fog_;
  // Registers that have been set.
  ColorWords colors_;
  StencilWords stencil_;
  std::optional<std::uint64_t> texture_state_, texture_constant_, texture_border_;
  std::optional<std::uint32_t> texture_levels_;
  std::optional<TextureLines> texture_lines_;
  std::array<RegisterWords, kMostUnitTables> set_;                 ///< the last ones
  std::array<std::vector<std::uint64_t>, kMostUnitTables> table_;  ///< 0: unknown; no word is 0
};

HostUnits::HostUnits(const Scene& scene, const Config& config, const Widths& widths)
    : impl_(std::make_unique<Impl>(scene, config, widths)) {}
HostUnits::~HostUnits() = default;
void HostUnits::fill(const DrawContext& context, const Triangle& triangle, bool is_compared, HostPrimitive& out) {
  impl_->fill(context, triangle, is_compared, out);
}
void HostUnits::set_for(PrimitiveKind kind, const UnitWords& units, const Send& send) {
  impl_->set_for(kind, units, send);
}

}  // namespace halfplane
