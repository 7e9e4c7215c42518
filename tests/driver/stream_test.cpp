// The driver's words, decoded, are the packets of the model's host for the same scene in s15.16.
#include <gtest/gtest.h>

#include "../tier.hpp"
#include "driver/backend/decode.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/host/texture_memory.hpp"
#include "model/packets/packet_words.hpp"
#include "model/packets/state_packets.hpp"
#include "model/stages/color_packets.hpp"
#include "model/stages/fog_unit.hpp"
#include "model/stages/light_unit.hpp"
#include "model/stages/stencil_packets.hpp"
#include "model/stages/texture_packets.hpp"
#include "sim/scene/host_geometry.hpp"
#include "stream_case.hpp"

namespace halfplane::test {
namespace {

using driver::DecodedPrimitive;
using driver::Decoder;

constexpr std::uint32_t kSeed = 5400;

/// The effect of a packet in hardware does not depend on the order of a triangle's vertices (cull sorts them), on numbers
/// of primitives, on the box of tokens and on the facing of other primitives than triangles: a form without them.
DecodedPrimitive canonical_form(PrimitivePacket packet, std::optional<LineSetup> line) {
  packet.primitive_id = 0;
  if (line) line->primitive_id = 0;
  if (packet.kind == PrimitiveKind::triangle) {
    const auto v = to_snapped(packet.vertex);
    const std::int64_t area = signed_area(v[0], v[1], v[2]);
    set_vertices(packet.vertex, canonical(v, area));
    packet.front_cw = packet.front_cw != (area < 0);
  } else {
    packet.front_cw = false;
  }
  if (packet.kind == PrimitiveKind::line || packet.kind == PrimitiveKind::state) packet.box = {};
  return {packet, line};
}

/// A packet of the model, and the values it needs in the registers of units.
struct Wanted {
  DecodedPrimitive primitive;
  UnitWords units;
};

/// The model's packets, without triangles that the hardware's cull drops for area or facing, which the driver does not send,
/// and without tokens.
std::vector<Wanted> of_model(const Scene& scene, const Config& config) {
  const Scene projected = in_host_numbers(scene, TransformNumbers::s15_16, config);
  HostStream stream(projected, config);
  std::vector<Wanted> wanted;
  while (const auto primitive = stream.next()) {
    const PrimitivePacket& packet = primitive->packet;
    if (packet.kind == PrimitiveKind::state) continue;
    if (packet.kind == PrimitiveKind::triangle) {
      const auto v = to_snapped(packet.vertex);
      const auto front = packet.front_cw ? FrontFace::cw : FrontFace::ccw;
      if (cull(signed_area(v[0], v[1], v[2]), packet.cull, front) != CullResult::keep) continue;
    }
    wanted.push_back({canonical_form(packet, primitive->line), primitive->units});
  }
  return wanted;
}

/// The registers of the units, from the driver's tokens.
class Registers {
 public:
  Registers(const Config& config, const Widths& widths)
      : config_(config), widths_(widths), lines_(line_part_bits(state_word_bits(widths))) {}

  void set(const PrimitivePacket& token) {
    const StateRegister which = state_register(token.state);
    if (which == StateRegister::texture_lines) {
      ++line_tokens_;
      return lines_.move_in(wide_state_word(token.vertex.code[0], widths_));
    }
    const std::uint64_t word = state_word(token.vertex.code[0], widths_);
    colors_.set(which, word);
    if (which == StateRegister::color_ops) ops_ = static_cast<std::uint32_t>(word);
    stencil_.set(which, word);
    const LevelsWord kind = levels_word(word);
    if (which == StateRegister::texture) {
      const TextureState state = TextureState::unpack(word);
      EXPECT_TRUE(has_texture_ || state.invalidates) << "texels of an earlier frame";
      texture_ = state;
      texture_.invalidates = false;
      has_texture_ = true;
    } else if (which == StateRegister::texture_levels && kind == LevelsWord::levels) {
      levels_ = static_cast<std::uint32_t>(word);
    } else if (which == StateRegister::texture_levels && kind == LevelsWord::fog) {
      fog_word_ = word;
    } else if (which == StateRegister::texture_levels && kind == LevelsWord::fog_line) {
      fog_line_[word >> 35 & 255] = word;
    } else if (which == StateRegister::texture_levels && kind == LevelsWord::constant) {
      constant_ = word;
    } else if (which == StateRegister::texture_levels && kind == LevelsWord::border) {
      border_ = word;
    } else if (which == StateRegister::texture_levels) {
      light_register(word) = word;
    }
  }

  [[nodiscard]] std::uint64_t line_tokens() const { return line_tokens_; }

  /// A difference from what a packet needs, or an empty text.
  [[nodiscard]] std::string difference(const Wanted& wanted) {
    const auto& [colors, stencil] = std::tie(wanted.units.colors, wanted.units.stencil);
    if (colors.ops && colors.ops != ops_) return "color_ops";
    if (colors.constant && *colors.constant != pack(colors_.ops.constant)) return "blend_constant";
    if (colors.alpha && *colors.alpha != pack(colors_.alpha, colors_.alpha_covers)) return "alpha_test";
    for (const std::size_t n : {0U, 1U}) {
      if (stencil.test[n] && *stencil.test[n] != pack_test(stencil_.side[n])) return "stencil_test";
      if (stencil.update[n] && *stencil.update[n] != pack_update(stencil_.side[n])) return "stencil_update";
    }
    if (wanted.primitive.packet.kind != PrimitiveKind::triangle || config_.texture_unit == TextureUnitKind::off)
      return "";
    if (wanted.units.texture_state != texture_.pack() || !has_texture_) return "texture";
    if (config_.texture_unit == TextureUnitKind::trilinear && texture_.enable && wanted.units.texture_levels != levels_)
      return "texture_levels";
    if (wanted.units.texture_constant && wanted.units.texture_constant != constant_) return "texture_constant";
    if (wanted.units.texture_border && wanted.units.texture_border != border_) return "texture_border";
    if (wanted.units.texture_lines && *wanted.units.texture_lines != lines_.lines()) return "texture_lines";
    for (const RegisterWords& words : wanted.units.tables)
      for (std::size_t n = 0; words != nullptr && n < words->size(); ++n) {
        const std::uint64_t word = (*words)[n];
        const LevelsWord kind = levels_word(word);
        if (kind == LevelsWord::fog && word != fog_word_) return "fog";
        if (kind == LevelsWord::fog_line && word != fog_line_[n - 1]) return "lines of the fog";
        if (kind == LevelsWord::light && word != light_register(word)) return "light";
      }
    return "";
  }

 private:
  std::uint64_t& light_register(std::uint64_t word) {
    const auto kind = static_cast<std::size_t>(word >> kLightWordBit & 7);
    return kind < kLightWords ? light_word_[kind] : light_line_[word >> 27 & 255];
  }

  const Config& config_;
  const Widths& widths_;
  ColorState colors_;
  std::optional<std::uint32_t> ops_;  ///< as it came: some of its bits follow from others
  StencilState stencil_;
  TextureState texture_;
  std::uint32_t levels_ = 0;
  std::optional<std::uint64_t> constant_, border_;
  LineRegister lines_;
  bool has_texture_ = false;
  std::uint64_t line_tokens_ = 0;
  std::array<std::uint64_t, kLightWords> light_word_{};
  std::array<std::uint64_t, std::size_t{1} << kPowerLines> light_line_{};
  std::uint64_t fog_word_ = 0;
  std::array<std::uint64_t, 256> fog_line_{};
};

std::string difference(const DecodedPrimitive& driver, const DecodedPrimitive& model, const Widths& widths) {
  std::string text;
  const auto compare = [&]<class Packet>(const Packet& a, const Packet& b) {
    const auto words_a = packed(a, widths), words_b = packed(b, widths);
    if (words_a == words_b) return;
    const auto names = element_names<Packet>(widths);
    const auto values_a = element_values<Packet>(words_a.data(), widths),
               values_b = element_values<Packet>(words_b.data(), widths);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (values_a[i] != values_b[i])
        text +=
            names[i].name + ": driver " + std::to_string(values_a[i]) + ", model " + std::to_string(values_b[i]) + "; ";
  };
  compare(driver.packet, model.packet);
  if (driver.line.has_value() != model.line.has_value()) return text + "one has a line";
  if (driver.line) compare(*driver.line, *model.line);
  return text;
}

/// Compares a case; its number of each kind of word is added to `kinds`.
void expect_equal(const StreamCase& made, const Config& config, std::array<std::uint64_t, 8>& kinds,
                  std::uint64_t& line_tokens) {
  const Widths widths = derive_widths(config);
  Decoder decoder(config);
  decoder.read(made.words);
  const std::vector<Wanted> model = of_model(made.scene, config);
  Registers registers(config, widths);
  std::size_t next = 0;
  for (const auto& [packet, line] : decoder.primitives()) {
    ++kinds[static_cast<std::size_t>(packet.kind)];
    if (packet.kind == PrimitiveKind::state) {
      registers.set(packet);
      continue;
    }
    ASSERT_LT(next, model.size()) << "the driver has more";
    const Wanted& wanted = model[next++];
    ASSERT_EQ(difference(canonical_form(packet, line), wanted.primitive, widths), "")
        << "packet " << next << " of " << model.size() << ", kind " << static_cast<int>(packet.kind);
    ASSERT_EQ(registers.difference(wanted), "") << "packet " << next << " of " << model.size();
  }
  ASSERT_EQ(next, model.size()) << "the driver has fewer";
  line_tokens += registers.line_tokens();
  if (config.texture_unit == TextureUnitKind::off) return;
  const TextureMemory textures(made.scene, config);
  std::vector<std::uint8_t> bytes(made.textures.size());
  textures.read(0, bytes);
  ASSERT_EQ(bytes, made.textures);
}

TEST(DriverStream, WordsAreTheModelsPackets) {
  const Config& config = driver_config();
  const std::uint64_t wanted = cases<std::uint64_t>(100'000, 1'000'000);
  std::array<std::uint64_t, 8> kinds{};
  hp_counts counts{};
  std::uint64_t primitives = 0, words = 0, line_tokens = 0;
  for (std::uint32_t n = 0; primitives < wanted; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed + n) + ", " + label(config));
    const StreamCase made = random_case(kSeed + n, 400);
    ASSERT_EQ(made.status, 0U);
    ASSERT_NO_FATAL_FAILURE(expect_equal(made, config, kinds, line_tokens));
    primitives += made.counts.triangles + made.counts.lines + made.counts.points;
    words += made.words.size();
    counts.cut += made.counts.cut;
    counts.outside += made.counts.outside;
    counts.culled += made.counts.culled;
    counts.sent += made.counts.sent;
    counts.vertices += made.counts.vertices;
  }
  std::printf(
      "%s, from seed %u: %llu primitives, %u outside, %u cut, %u culled, %u sent, %u vertices, %llu words, %llu tokens "
      "of lines\n",
      label(config).c_str(), kSeed, static_cast<unsigned long long>(primitives), counts.outside, counts.cut,
      counts.culled, counts.sent, counts.vertices, static_cast<unsigned long long>(words),
      static_cast<unsigned long long>(line_tokens));
  EXPECT_GT(counts.cut, wanted / 100);
  EXPECT_GT(counts.outside, wanted / 100);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::triangle)], wanted / 10);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::point)], wanted / 100);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::rectangle)], 10U);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::fast_clear)], 10U);
  EXPECT_EQ(line_tokens > wanted / 100, config.texture_unit == TextureUnitKind::trilinear);
  EXPECT_EQ(kinds[static_cast<std::size_t>(PrimitiveKind::line)] > wanted / 100, config.line_units != 0);
  EXPECT_EQ(kinds[static_cast<std::size_t>(PrimitiveKind::state)] > 100,
            config.texture_unit != TextureUnitKind::off || packs_at_write(config));
}

}  // namespace
}  // namespace halfplane::test
