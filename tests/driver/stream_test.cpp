// The driver's words, decoded, are the packets of the model's host for the same scene in s15.16.
#include <gtest/gtest.h>

#include "../tier.hpp"
#include "driver/backend/decode.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/packets/packet_words.hpp"
#include "sim/scene/host_geometry.hpp"
#include "stream_case.hpp"

namespace halfplane::test {
namespace {

using driver::DecodedPrimitive;
using driver::Decoder;

constexpr std::uint32_t kSeed = 5400;

/// What the hardware does with a packet does not depend on the order of a triangle's vertices (cull sorts them), on numbers of
/// primitives, on the box of tokens and on the facing of what is no triangle: a form without them.
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

/// The model's packets, without triangles that the hardware's cull drops for area or facing: the driver does not send them.
std::vector<DecodedPrimitive> of_model(const Scene& scene, const Config& config) {
  const Scene projected = in_host_numbers(scene, TransformNumbers::s15_16, config);
  HostStream stream(projected, config);
  std::vector<DecodedPrimitive> packets;
  while (const auto primitive = stream.next()) {
    const PrimitivePacket& packet = primitive->packet;
    if (packet.kind == PrimitiveKind::triangle) {
      const auto v = to_snapped(packet.vertex);
      const auto front = packet.front_cw ? FrontFace::cw : FrontFace::ccw;
      if (cull(signed_area(v[0], v[1], v[2]), packet.cull, front) != CullResult::keep) continue;
    }
    packets.push_back(canonical_form(packet, primitive->line));
  }
  return packets;
}

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

/// Compares a case; what it holds of each kind is added to `kinds`.
void expect_equal(const StreamCase& made, const Config& config, std::array<std::uint64_t, 8>& kinds) {
  const Widths widths = derive_widths(config);
  Decoder decoder(config);
  decoder.read(made.words);
  const auto model = of_model(made.scene, config);
  const auto& driver = decoder.primitives();
  for (std::size_t i = 0; i < std::min(driver.size(), model.size()); ++i) {
    ++kinds[static_cast<std::size_t>(model[i].packet.kind)];
    const std::string found = difference(canonical_form(driver[i].packet, driver[i].line), model[i], widths);
    ASSERT_EQ(found, "") << "packet " << i << " of " << model.size() << ", kind "
                         << static_cast<int>(model[i].packet.kind);
  }
  ASSERT_EQ(driver.size(), model.size());
  const TextureMemory textures =
      config.texture_unit == TextureUnitKind::off ? TextureMemory() : TextureMemory(made.scene, config);
  std::vector<std::uint8_t> bytes(made.textures.size());
  textures.read(0, bytes);
  ASSERT_EQ(bytes, made.textures);
}

TEST(DriverStream, WordsAreTheModelsPackets) {
  const Config& config = driver_config();
  const std::uint64_t wanted = cases<std::uint64_t>(100'000, 1'000'000);
  std::array<std::uint64_t, 8> kinds{};
  hp_counts counts{};
  std::uint64_t primitives = 0, words = 0;
  for (std::uint32_t n = 0; primitives < wanted; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed + n) + ", " + label(config));
    const StreamCase made = random_case(kSeed + n, 400);
    ASSERT_EQ(made.status, 0U);
    ASSERT_NO_FATAL_FAILURE(expect_equal(made, config, kinds));
    primitives += made.counts.triangles + made.counts.lines + made.counts.points;
    words += made.words.size();
    counts.cut += made.counts.cut;
    counts.outside += made.counts.outside;
    counts.culled += made.counts.culled;
    counts.sent += made.counts.sent;
    counts.vertices += made.counts.vertices;
  }
  std::printf("%s, from seed %u: %llu primitives, %u outside, %u cut, %u culled, %u sent, %u vertices, %llu words\n",
              label(config).c_str(), kSeed, static_cast<unsigned long long>(primitives), counts.outside, counts.cut,
              counts.culled, counts.sent, counts.vertices, static_cast<unsigned long long>(words));
  EXPECT_GT(counts.cut, wanted / 100);
  EXPECT_GT(counts.outside, wanted / 100);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::triangle)], wanted / 10);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::point)], wanted / 100);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::rectangle)], 10U);
  EXPECT_GT(kinds[static_cast<std::size_t>(PrimitiveKind::fast_clear)], 10U);
  EXPECT_EQ(kinds[static_cast<std::size_t>(PrimitiveKind::line)] > wanted / 100, config.line_units != 0);
}

}  // namespace
}  // namespace halfplane::test
