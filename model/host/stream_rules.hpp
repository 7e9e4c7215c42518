// The rules of the stream of primitives, which the hardware relies on and does not check (docs/interface.md), for streams
// of other hosts. rtl_ref/primitive_stream_checker.sv has the same for the ports of raster_top.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "../config.hpp"
#include "../packets/packets.hpp"

namespace halfplane {

/// Whether a line's pixels lie in a target of this size, and its error keeps to its register.
[[nodiscard]] bool is_line_inside(const LineSetup& line, const Widths& widths, int width, int height);

/// Whether the unit of a state register is in the hardware; core/command_decoder.sv has the same in UNIT_REGISTERS.
[[nodiscard]] bool has_register(StateRegister which, const Config& config);

class StreamRules {
 public:
  StreamRules(const Config& config, const Widths& widths) : config_(config), widths_(widths) {}
  /// Takes the next primitive. The rule that it breaks, with what to send instead: then it is not taken. Empty: none.
  [[nodiscard]] std::string take(const PrimitivePacket& packet);
  /// The same for a line, whatever the order between lines and their places.
  [[nodiscard]] std::string fault(const LineSetup& line) const;
  /// The target, pixels: the box of the last fast clear of both buffers. None before the first.
  [[nodiscard]] std::optional<PixelBox> target() const { return target_; }
  [[nodiscard]] std::uint64_t taken() const { return taken_; }          ///< primitives, of all kinds
  [[nodiscard]] std::uint64_t unwritten() const { return unwritten_; }  ///< primitives since the last flush

 private:
  [[nodiscard]] std::string fault(const PrimitivePacket& packet) const;
  [[nodiscard]] std::string box_fault(const PrimitivePacket& packet) const;

  Config config_;
  Widths widths_;
  std::optional<PixelBox> target_;
  std::uint64_t taken_ = 0, unwritten_ = 0;
};

}  // namespace halfplane
