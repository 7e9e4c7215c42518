// The pipeline: every stage and every arrow between two stages, in the order of a triangle's path. Read this first.
//
//   host: primitive_assembly -> clip -> viewport                                   line_setup
//                                          | primitive                                  | line
//   rtl:                                 cull                                       line_raster
//                                          | triangle                                   | line_pixel
//                                    triangle_setup                                     |
//                                          | setup                                      |
//            .-- retire --> coarse_raster --context--> context RAM                      |
//            |                             | tile, edges                                |
//            |                        fine_raster                                       |
//            |                             | stamp                                      |
//            |                        interpolate ---> primitive_join <-----------------'
//            |                                               | fragment
//            '------------------------------------------ depth_test ---> rop -- write --> framebuffer
//                                                                           request v  ^ response
//                                                                              memory_port
//                                                                              beat v  ^ answer
//   memory:                                                                        memory
//
// With a texture unit, colours go to the framebuffer through it: depth_test -- write --> texture_unit ---> rop -- color -->
// framebuffer, and it has a memory of its own: texture v ^ texel. In the RTL the framebuffer of blocks is cache_tags,
// depth_cache, late_test, color_write, write_back and memory_answers; light_stage, texture_stage, fog_stage and stamp_rop are
// between depth_cache and late_test.
//
// A stage is a pair of files of its name: model/stages/NAME.hpp, for the host model/host/NAME.hpp, is the
// specification, and rtl_ref/stages/NAME.sv the hardware (stages of the host have no hardware, the memory has neither).
// The model of framebuffer is in cache_tags.hpp and block_cache.hpp, with tiles in tile_directory.hpp and
// tile_cache.hpp. An arrow carries packets: their fields are in packets/packets.hpp. engines/hardware.cpp sends them,
// the cycle model gives their cycles (engines/cycle/), raster_top.sv wires them, rtl_ref/cosim/taps.svh, generated from
// this file, shows them to the co-simulation, which compares model and RTL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

namespace halfplane {

/// The side of a stage.
enum class Side : std::uint8_t { host, rtl, memory };

// clang-format off
/// STAGE(name, side, timed, what). Timed: the cycle model counts the cycles in which it is busy; the other RTL
/// stages add none.
#define HALFPLANE_STAGES(STAGE)                                                                             \
  /*    name                side    timed  input -> output       */                                         \
  STAGE(primitive_assembly, host,   false, "indices and topology -> triangles, lines, points")              \
  STAGE(clip,               host,   false, "homogeneous triangle or line -> what is inside the guard band") \
  STAGE(viewport,           host,   false, "clip coordinates -> snapped window vertex")                     \
  STAGE(cull,               rtl,    true,  "primitive -> triangle in canonical order, its box and edges")   \
  STAGE(triangle_setup,     rtl,    true,  "triangle -> reciprocal of the area, planes")                    \
  STAGE(coarse_raster,      rtl,    true,  "planes -> tiles that are neither outside nor hidden (HiZ)")     \
  STAGE(fine_raster,        rtl,    true,  "tile -> stamps with covered samples")                           \
  STAGE(interpolate,        rtl,    true,  "stamp -> depth and colour of its samples")                      \
  STAGE(line_setup,         host,   false, "two snapped vertices -> first pixel, error term, steps")        \
  STAGE(line_raster,        rtl,    true,  "line -> pixels with depth and colour")                          \
  STAGE(point_raster,       host,   false, "snapped vertex -> the box of its pixels, a primitive")          \
  STAGE(primitive_join,     rtl,    false, "stamps, pixels of lines -> fragments in program order")         \
  STAGE(depth_test,         rtl,    false, "fragment, stored depth -> samples that pass; retired visit")    \
  STAGE(rop,                rtl,    false, "colour -> stored colour")                                       \
  STAGE(framebuffer,        rtl,    true,  "passed samples -> tiles on the chip, requests for memory")      \
  STAGE(memory_port,        rtl,    true,  "requests -> bursts; answers -> responses")                      \
  STAGE(memory,             memory, false, "bursts -> the two images, answers")                              \
  STAGE(texture_unit,       rtl,    true,  "passed samples -> texels at their coordinates, combined")       \
  STAGE(texture_memory,     memory, false, "lines of texels asked for -> texels")

/// ARROW(name, packet, from, via, to, flow). Via: a stage without registers that the packet passes on its way, or none.
/// Flow: see below. The number of an elastic arrow is its bit of raster_top's stall_i, and goes into the hash of
/// injected stalls: it never changes, and a new arrow takes the next free number.
#define HALFPLANE_ARROWS(ARROW)                                                                            \
  /*    name        packet           from            via             to              flow */               \
  ARROW(primitive,  PrimitivePacket, viewport,       none,           cull,           elastic(0))           \
  ARROW(line,       LineSetup,       line_setup,     none,           line_raster,    elastic(8))           \
  ARROW(triangle,   TrianglePacket,  cull,           none,           triangle_setup, elastic(1))           \
  ARROW(setup,      SetupPacket,     triangle_setup, none,           coarse_raster,  elastic(2))           \
  ARROW(context,    ContextPacket,   coarse_raster,  none,           interpolate,    beside(Arrow::setup)) \
  ARROW(tile,       TilePacket,      coarse_raster,  none,           fine_raster,    elastic(3))           \
  ARROW(edges,      EdgeContext,     coarse_raster,  none,           fine_raster,    beside(Arrow::tile))  \
  ARROW(stamp,      StampPacket,     fine_raster,    none,           interpolate,    elastic(4))           \
  ARROW(line_pixel, LinePixel,       line_raster,    none,           primitive_join, elastic(9))           \
  ARROW(fragment,   FragmentPacket,  interpolate,    primitive_join, depth_test,     elastic(5))           \
  ARROW(write,      WritePacket,     depth_test,     rop,            framebuffer,    always())             \
  ARROW(retire,     RetirePacket,    depth_test,     none,           coarse_raster,  always())             \
  ARROW(request,    MemoryRequest,   framebuffer,    none,           memory_port,    elastic(6))           \
  ARROW(beat,       MemoryBeat,      memory_port,    none,           memory,         elastic(11))          \
  ARROW(answer,     MemoryAnswer,    memory,         none,           memory_port,    elastic(12))          \
  ARROW(response,   MemoryResponse,  memory_port,    none,           framebuffer,    elastic(7))           \
  ARROW(texture,    TextureRequest,  texture_unit,   none,           texture_memory, elastic(13))          \
  ARROW(texel,      TexelBeat,       texture_memory, none,           texture_unit,   elastic(14))          \
  ARROW(color,      ColorPacket,     texture_unit,   rop,            framebuffer,    handshake())
// clang-format on

/// The stall stream of the memory itself, which then takes no request: its number is in the range of the arrows'.
inline constexpr int kMemoryStall = 10;

#define HALFPLANE_NAME(name, ...) name,
enum class Stage : std::uint8_t { HALFPLANE_STAGES(HALFPLANE_NAME) none };
enum class Arrow : std::uint8_t { HALFPLANE_ARROWS(HALFPLANE_NAME) };
#undef HALFPLANE_NAME

/// Movement of the packets of an arrow.
struct Flow {
  bool waits = false;               ///< valid and ready: moves in the cycle with both high; otherwise valid only
  int stall = -1;                   ///< bit of raster_top's stall_i that holds it back; -1: none
  std::optional<Arrow> rides_with;  ///< moves with every packet of that arrow, in its cycle

  static constexpr Flow elastic(int number) { return {true, number, {}}; }
  static constexpr Flow handshake() { return {true, -1, {}}; }  ///< waits, and has no stall of its own
  static constexpr Flow always() { return {}; }
  static constexpr Flow beside(Arrow other) { return {false, -1, other}; }
};

struct StageInfo {
  std::string_view name;
  Side side;
  bool is_timed;
  std::string_view what;
};
struct ArrowInfo {
  std::string_view name;
  Stage from, via, to;
  Flow flow;
};

#define HALFPLANE_STAGE(name, side, timed, what) StageInfo{#name, Side::side, timed, what},
inline constexpr std::array kStageInfo{HALFPLANE_STAGES(HALFPLANE_STAGE)};
#undef HALFPLANE_STAGE
#define HALFPLANE_ARROW(name, packet, from, via, to, flow) \
  ArrowInfo{#name, Stage::from, Stage::via, Stage::to, Flow::flow},
inline constexpr std::array kArrowInfo{HALFPLANE_ARROWS(HALFPLANE_ARROW)};
#undef HALFPLANE_ARROW
inline constexpr std::size_t kStages = kStageInfo.size(), kArrows = kArrowInfo.size();

[[nodiscard]] constexpr std::size_t index(Stage stage) { return static_cast<std::size_t>(stage); }
[[nodiscard]] constexpr std::size_t index(Arrow arrow) { return static_cast<std::size_t>(arrow); }
[[nodiscard]] constexpr const StageInfo& info(Stage stage) { return kStageInfo[index(stage)]; }
[[nodiscard]] constexpr const ArrowInfo& info(Arrow arrow) { return kArrowInfo[index(arrow)]; }

// Sets of arrows that follow from the table.

/// The RTL sends it: model and RTL are compared packet by packet.
[[nodiscard]] constexpr bool is_compared(Arrow arrow) { return info(info(arrow).from).side == Side::rtl; }
/// It is inside the RTL: raster_cosim has a tap on it.
[[nodiscard]] constexpr bool is_tapped(Arrow arrow) {
  return is_compared(arrow) && info(info(arrow).to).side == Side::rtl;
}
/// Its crossings have their own cycles in the cycle model.
[[nodiscard]] constexpr bool is_boundary(Arrow arrow) { return !info(arrow).flow.rides_with; }
/// Only hardware with a texture unit has it.
[[nodiscard]] constexpr bool is_of_texture_unit(Arrow arrow) {
  return info(arrow).from == Stage::texture_unit || info(arrow).to == Stage::texture_unit;
}
/// It can be stalled.
[[nodiscard]] constexpr bool is_elastic(Arrow arrow) { return info(arrow).flow.stall >= 0; }
/// Elastic and inside the RTL: raster_cosim shows its valid and ready.
[[nodiscard]] constexpr bool is_stream(Arrow arrow) { return is_tapped(arrow) && is_elastic(arrow); }

/// The arrows for which `is` is true, in order.
template <bool (*is)(Arrow)>
[[nodiscard]] consteval auto arrows_that() {
  constexpr std::size_t kCount = [] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kArrows; ++i) count += is(static_cast<Arrow>(i)) ? 1 : 0;
    return count;
  }();
  std::array<Arrow, kCount> list{};
  std::size_t next = 0;
  for (std::size_t i = 0; i < kArrows; ++i)
    if (is(static_cast<Arrow>(i))) list[next++] = static_cast<Arrow>(i);
  return list;
}
inline constexpr auto kCompared = arrows_that<is_compared>();
inline constexpr auto kTapped = arrows_that<is_tapped>();  ///< bit i of raster_cosim's fire_o is kTapped[i]
inline constexpr auto kBoundaries = arrows_that<is_boundary>();
inline constexpr auto kElastic = arrows_that<is_elastic>();
inline constexpr auto kStreams = arrows_that<is_stream>();  ///< likewise of stream_valid_o and stream_ready_o

/// The bit of a tapped arrow in raster_cosim's fire_o.
[[nodiscard]] constexpr std::uint32_t tap_bit(Arrow arrow) {
  std::uint32_t bit = 1;
  for (const Arrow tapped : kTapped) {
    if (tapped == arrow) return bit;
    bit <<= 1;
  }
  return 0;
}

[[nodiscard]] constexpr unsigned stall_bit(Arrow arrow) { return is_elastic(arrow) ? 1U << info(arrow).flow.stall : 0; }

/// Bits of raster_top's stall_i, and the number of stall streams including the memory's.
inline constexpr int kStallBits = [] {
  int bits = 0;
  for (const Arrow arrow : kElastic) bits = bits > info(arrow).flow.stall ? bits : info(arrow).flow.stall + 1;
  return bits;
}();
inline constexpr int kStallStreams = kStallBits > kMemoryStall ? kStallBits : kMemoryStall + 1;

static_assert(
    [] {
      unsigned seen = 1U << kMemoryStall;
      for (const Arrow arrow : kElastic) {
        if ((seen & stall_bit(arrow)) != 0) return false;
        seen |= stall_bit(arrow);
      }
      return true;
    }(),
    "two arrows, or an arrow and the memory, are stalled by the same number");
static_assert(
    [] {
      for (const ArrowInfo& arrow : kArrowInfo)
        if (arrow.flow.rides_with && info(*arrow.flow.rides_with).flow.rides_with) return false;
      return true;
    }(),
    "an arrow rides with one that rides itself");
static_assert(kTapped.size() <= 32 && kStallStreams <= 32, "raster_cosim's fire_o and stall_i are words of 32 bits");

// Fault attribution.

/// The stage whose timing decides the cycle of a crossing. Host stages have no timing: the name is "host".
[[nodiscard]] constexpr std::string_view sender_name(Arrow arrow) {
  const StageInfo& stage = info(info(arrow).from);
  return stage.side == Side::host ? "host" : stage.name;
}

/// The stage to suspect first for a wrong packet, by its arrow only. rop finishes a write; a fragment passes
/// primitive_join unchanged, unless it belongs to a line.
[[nodiscard]] constexpr Stage suspect(Arrow arrow) { return arrow == Arrow::write ? Stage::rop : info(arrow).from; }

/// The same for a packet with known differing fields: the fields of a write come from two stages, and so do fragments.
struct Difference {
  bool is_of_line = false;       ///< the fragment of a line
  bool is_in_color_only = true;  ///< no field but stored colours differs
};
[[nodiscard]] constexpr Stage suspect(Arrow arrow, const Difference& difference) {
  if (arrow == Arrow::fragment && difference.is_of_line) return Stage::primitive_join;
  if (arrow == Arrow::write && !difference.is_in_color_only) return Stage::depth_test;
  return suspect(arrow);
}

// Packets by arrow.

#define HALFPLANE_DECLARE(name, packet, ...) struct packet;
HALFPLANE_ARROWS(HALFPLANE_DECLARE)
#undef HALFPLANE_DECLARE

/// An arrow as a type, and as an argument: take(on<Arrow::tile>, packet).
template <Arrow A>
using On = std::integral_constant<Arrow, A>;
template <Arrow A>
inline constexpr On<A> on{};

template <Arrow A>
struct PacketOn;
#define HALFPLANE_PACKET(name, packet, ...) \
  template <>                               \
  struct PacketOn<Arrow::name> {            \
    using Type = packet;                    \
  };
HALFPLANE_ARROWS(HALFPLANE_PACKET)
#undef HALFPLANE_PACKET
template <Arrow A>
using PacketOf = typename PacketOn<A>::Type;

/// Calls visit(std::type_identity<Packet>{}) with the packet type of an arrow. Only this function maps arrows to
/// packets.
template <class Visit>
decltype(auto) with_packet_type(Arrow arrow, Visit&& visit) {
#define HALFPLANE_CASE(name, packet, ...) \
  case Arrow::name: return visit(std::type_identity<packet>{});
  switch (arrow) { HALFPLANE_ARROWS(HALFPLANE_CASE) }
#undef HALFPLANE_CASE
  return visit(std::type_identity<MemoryResponse>{});  // no such arrow
}

/// \cond inheritance that Doxygen takes for endless
// take(on<arrow>, packet) for the arrows from number I on; each does nothing.
template <std::size_t I = 0>
struct PacketSinkFrom : PacketSinkFrom<I + 1> {
  using PacketSinkFrom<I + 1>::take;
  virtual void take(On<static_cast<Arrow>(I)>, const PacketOf<static_cast<Arrow>(I)>&) {}
};
template <>
struct PacketSinkFrom<kArrows> {
  virtual ~PacketSinkFrom() = default;
  void take() = delete;  // something for the first `using`
};
/// \endcond

/// A sink overrides the overloads it needs: take(On<Arrow::tile>, const TilePacket&). Each arrow's packets come in the
/// order of that arrow; packets of different arrows come interleaved as the work happens.
using PacketSink = PacketSinkFrom<>;

/// \cond
template <class Derived, std::size_t I = 0>
struct EveryPacketFrom : EveryPacketFrom<Derived, I + 1> {
  using EveryPacketFrom<Derived, I + 1>::take;
  void take(On<static_cast<Arrow>(I)>, const PacketOf<static_cast<Arrow>(I)>& packet) final {
    static_cast<Derived&>(*this).template take_any<static_cast<Arrow>(I)>(packet);
  }
};
template <class Derived>
struct EveryPacketFrom<Derived, kArrows> : PacketSink {};
/// \endcond

/// A sink for all packets: Derived has `template <Arrow A> void take_any(const PacketOf<A>&)`, public.
template <class Derived>
using EveryPacket = EveryPacketFrom<Derived>;

}  // namespace halfplane
