// The hardware model at the pixels: the packets that contain them, coarse_raster's HiZ tests there, and the cycles of
// all crossings, by the cycle model and by the RTL.
#pragma once

#include <functional>
#include <unordered_set>
#include <vector>

#include "history.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/coarse_raster.hpp"
#include "sim/cosim/dut.hpp"

namespace halfplane::explain {

/// One primitive of the host's stream at one pixel.
struct HardwareVisit {
  HostPrimitive host;
  Outcome outcome;  ///< final outcome in hardware; scissor and box count as uncovered
  std::optional<TileClass> tile;
  std::optional<HizLook> hiz;
  std::vector<PacketId> packets;
  std::size_t sample = 0;                  ///< of the pixel in its stamp
  std::optional<FragmentPacket> fragment;  ///< the fragment that covers the pixel
  std::optional<WritePacket> write;
  std::optional<std::uint32_t> textured;  ///< stored colour after the texture unit
};

struct HardwareRecord {
  std::vector<std::vector<HardwareVisit>> visits;  ///< by pixel, in the order of the host's stream
  Framebuffer frame;
};

/// Runs `scene` and records the visits of `pixels` by the input primitives in `wanted` and by all clears; their packets
/// go to `packets`. `progress` gets the fraction done; it may throw. Throws InputError as check_hardware_scene().
[[nodiscard]] HardwareRecord record_hardware(const Scene& scene, const Config& config, const std::vector<Pixel>& pixels,
                                             const std::unordered_set<std::uint32_t>& wanted,
                                             const std::function<void(double)>& progress, PacketStore& packets);

/// Adds the cycles of the cycle model to `packets`: of the arrows that are boundaries, and of the arrows that move with
/// them.
void record_cycles(const Scene& scene, const Config& config, PacketStore& packets);

/// Runs the RTL and adds its packets and their cycles. Returns its frame. `mutant`: the fault in it, 0 for none.
[[nodiscard]] Framebuffer record_rtl(Dut& dut, const Scene& scene, const Config& config, std::uint16_t mutant,
                                     const std::function<bool(double fraction)>& progress, PacketStore& packets);

}  // namespace halfplane::explain
