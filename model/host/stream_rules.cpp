#include "stream_rules.hpp"

#include "../packets/state_packets.hpp"
#include "../stages/line_raster.hpp"

namespace halfplane {
namespace {

bool clears_both(const PrimitivePacket& packet) {
  const PrimitiveState& state = packet.state;
  return packet.kind == PrimitiveKind::fast_clear && !state.clears_bin() && state.depth_write && state.color_write;
}

}  // namespace

bool is_line_inside(const LineSetup& line, const Widths& widths, int width, int height) {
  LineState state = first_state(line);
  for (;;) {
    if (state.x < 0 || state.y < 0 || state.x >= width || state.y >= height ||
        state.error != wrap_signed(state.error, widths.line_error.bits))
      return false;
    if (state.remaining == 0) return true;
    advance(state, line, widths);
  }
}

bool has_register(StateRegister which, const Config& config) {
  switch (which) {
    case StateRegister::texture:
    case StateRegister::texture_levels:
    case StateRegister::texture_lines: return has_texture_planes(config);
    case StateRegister::color_ops:
    case StateRegister::blend_constant: return packs_at_write(config);
    case StateRegister::alpha_test: return tests_alpha(config);
    case StateRegister::stencil_test:
    case StateRegister::stencil_update: return config.stencil_bits != 0;
  }
  return false;
}

std::string StreamRules::take(const PrimitivePacket& packet) {
  if (std::string broken = fault(packet); !broken.empty())
    return "primitive " + std::to_string(taken_) + " of the stream " + broken;
  ++taken_;
  if (packet.kind == PrimitiveKind::flush)
    unwritten_ = 0;
  else if (packet.kind != PrimitiveKind::state)
    ++unwritten_;
  if (clears_both(packet)) target_ = packet.box;
  return {};
}

std::string StreamRules::fault(const LineSetup& line) const {
  if (config_.line_units == 0) return "a line is sent, and this hardware draws none; set lines.unit to 1";
  const int width = target_ ? target_->right + 1 : config_.target_width,
            height = target_ ? target_->bottom + 1 : config_.target_height;
  if (is_line_inside(line, widths_, width, height)) return {};
  return "a line leaves the target; send the part inside, as line_setup does";
}

std::string StreamRules::fault(const PrimitivePacket& packet) const {
  const auto number = [](auto value) { return std::to_string(static_cast<unsigned>(value)); };
  switch (packet.kind) {
    case PrimitiveKind::triangle:
    case PrimitiveKind::rectangle:
    case PrimitiveKind::point:
    case PrimitiveKind::fast_clear:
    case PrimitiveKind::flush: return box_fault(packet);
    case PrimitiveKind::line:
      if (config_.line_units == 0) return "is a line, and this hardware draws none; set lines.unit to 1";
      return box_fault(packet);
    case PrimitiveKind::state:
      if (has_register(state_register(packet.state), config_)) return {};
      return "sets state register " + number(packet.state.depth_test) + ", of a unit that this hardware does not have";
  }
  return "is of kind " + number(packet.kind) + ", which no hardware has; send one of primitive_kind_t";
}

std::string StreamRules::box_fault(const PrimitivePacket& packet) const {
  const PixelBox& box = packet.box;
  const bool is_clear = packet.kind == PrimitiveKind::fast_clear, is_flush = packet.kind == PrimitiveKind::flush;
  const bool has_blocks = config_.cache_kind == CacheKind::blocks, is_bin = is_clear && packet.state.clears_bin();
  if (!target_ && !clears_both(packet))
    return "is drawn before the first clear; send a fast clear of depth and colour in front of it";
  if (box.left > box.right || box.top > box.bottom) return "has an inverted box; leave out what covers no pixel";
  if (is_clear || is_flush) {
    const bool is_plain = packet.state.depth_test == DepthFunc::always;
    if (!is_plain && !(has_blocks && (packet.state.drops_depth() || is_bin)))
      return "is a fast clear or flush with another depth test than always (never and equal: docs/pipeline.md)";
    if (is_bin && packet.state.depth_write)
      return "is a fast clear of one bin and clears depth: that is of the whole target";
  }
  if (clears_both(packet)) {
    if (box.left != 0 || box.top != 0 || box.right >= config_.target_width || box.bottom >= config_.target_height)
      return "is a fast clear of another box than a whole target, of at most " + std::to_string(config_.target_width) +
             "x" + std::to_string(config_.target_height) + " pixels";
    if (target_ && unwritten_ != 0 && (box.right != target_->right || box.bottom != target_->bottom))
      return "changes the target's size after " + std::to_string(unwritten_) +
             " primitives without a flush; flush first";
    return {};
  }
  if (box.right > target_->right || box.bottom > target_->bottom)
    return "has a box outside the target; cut it with the target";
  const bool is_whole = box.left == 0 && box.top == 0 && box.right == target_->right && box.bottom == target_->bottom;
  if ((is_clear || is_flush) && !is_bin && !is_whole)
    return "is a fast clear or flush of a part of the target; give the box of the first clear";
  return {};
}

}  // namespace halfplane
