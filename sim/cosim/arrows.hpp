// The arrows between the stages that co-simulation compares, in the order of the pipeline.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "model/packets.hpp"
#include "model/stages/line_raster.hpp"

namespace halfplane {

/// In this order they are the bits of raster_cosim's fire_o; `request` is a port of its own.
enum class Arrow : std::uint8_t {
  triangle,
  setup,
  context,
  tile,
  edges,
  stamp,
  line_pixel,
  fragment,
  write,
  retire,
  request
};
inline constexpr std::size_t kArrows = 11;

struct ArrowInfo {
  std::string_view name;
  std::string_view stage;  ///< that sends it: the first suspect
};
inline constexpr std::array<ArrowInfo, kArrows> kArrowInfo{{{"triangle", "cull"},
                                                            {"setup", "triangle_setup"},
                                                            {"context", "triangle_setup"},
                                                            {"tile", "coarse_raster"},
                                                            {"edges", "coarse_raster"},
                                                            {"stamp", "fine_raster"},
                                                            {"line_pixel", "line_raster"},
                                                            {"fragment", "interpolate"},
                                                            {"write", "rop"},
                                                            {"retire", "depth_test"},
                                                            {"request", "framebuffer"}}};

[[nodiscard]] constexpr const ArrowInfo& info(Arrow arrow) { return kArrowInfo[static_cast<std::size_t>(arrow)]; }

/// Calls visit(std::type_identity<Packet>{}) with the packet type of an arrow.
template <class Visit>
decltype(auto) with_packet_type(Arrow arrow, Visit&& visit) {
  switch (arrow) {
    case Arrow::triangle: return visit(std::type_identity<TrianglePacket>{});
    case Arrow::setup: return visit(std::type_identity<SetupPacket>{});
    case Arrow::context: return visit(std::type_identity<ContextPacket>{});
    case Arrow::tile: return visit(std::type_identity<TilePacket>{});
    case Arrow::edges: return visit(std::type_identity<EdgeContext>{});
    case Arrow::stamp: return visit(std::type_identity<StampPacket>{});
    case Arrow::line_pixel: return visit(std::type_identity<LinePixel>{});
    case Arrow::fragment: return visit(std::type_identity<FragmentPacket>{});
    case Arrow::write: return visit(std::type_identity<WritePacket>{});
    case Arrow::retire: return visit(std::type_identity<RetirePacket>{});
    case Arrow::request: break;
  }
  return visit(std::type_identity<MemoryRequest>{});
}

/// One element of a packet on both sides.
struct FieldPair {
  std::string name;  ///< "mask", "edge_value[2]"
  int bits = 0;
  bool is_signed = false;
  std::uint64_t model = 0, rtl = 0;  ///< the raw bits

  [[nodiscard]] bool differs() const { return model != rtl; }
  [[nodiscard]] std::string model_text() const;  ///< as a decimal number
  [[nodiscard]] std::string rtl_text() const;
};

/// Every element of a packet type, from the packed words of both sides.
template <class Packet>
[[nodiscard]] std::vector<FieldPair> field_pairs(const Widths& widths, const std::uint32_t* model,
                                                 const std::uint32_t* rtl);

/// The same for the packet type of an arrow.
[[nodiscard]] std::vector<FieldPair> field_pairs(Arrow arrow, const Widths& widths, const std::uint32_t* model,
                                                 const std::uint32_t* rtl);

}  // namespace halfplane
