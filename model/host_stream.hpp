// What the host sends to the hardware for a scene: snapped primitives with their states, one packet each.
//
// First a fast clear of both planes, unless the scene begins with one, then the scene's commands in order, at the end a
// flush. The host clips; facing,
// area and box are the hardware's to look at, except for a clipped polygon, which is culled as a whole.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pipeline.hpp"
#include "stages/line_setup.hpp"

namespace halfplane {

/// A primitive on its way to the hardware, and where it came from.
struct HostPrimitive {
  static constexpr std::uint32_t kNoCommand = ~0U;

  PrimitivePacket packet;
  std::optional<LineSetup> line;  ///< beside a packet of kind line
  std::uint32_t primitive = 0;    ///< number of the input primitive over the whole scene; otherwise: of the next one
  std::uint32_t command = kNoCommand;  ///< index into Scene::commands; kNoCommand: the first clear and the flush
};

/// The primitives of a scene, pulled one at a time. `scene` must outlive the stream.
class HostStream {
 public:
  /// Throws InputError for a scene that the hardware cannot take.
  HostStream(const Scene& scene, const Config& config);

  HostStream(const HostStream&) = delete;  // the draw at work points into config_
  HostStream& operator=(const HostStream&) = delete;

  /// The next primitive; none after the flush. Throws InputError for a vertex that cannot be snapped.
  [[nodiscard]] std::optional<HostPrimitive> next();

  /// What the host itself has counted so far: primitives_in, clipped, and what it culled, by reason.
  [[nodiscard]] const Counters& counters() const { return counters_; }

  /// 0...1: how much of the scene has been sent, every command counted alike.
  [[nodiscard]] double progress() const;

 private:
  void advance();
  void start_draw(const Draw& draw);
  void send_next_primitive();
  void send_outline(const AssembledPrimitive& assembled);
  void send_clear(const Clear& command);
  void send_triangle(const Triangle& triangle, bool is_clipped);
  [[nodiscard]] PrimitivePacket draw_packet(PrimitiveKind kind, const PixelBounds& box) const;
  void send(const PrimitivePacket& packet, std::uint32_t primitive);

  const Scene& scene_;
  Config config_;
  Widths widths_;
  VertexCache vertices_;
  Counters counters_;
  std::size_t command_ = 0;                    ///< the next of Scene::commands
  bool is_finished_ = false;                   ///< the flush has been queued
  std::uint32_t primitive_ = 0;                ///< number of the next input primitive
  std::optional<DrawContext> context_;         ///< of the draw at work
  std::vector<AssembledPrimitive> assembled_;  ///< of the draw at work
  std::size_t assembled_next_ = 0;             ///< the next of them
  std::vector<Triangle> pieces_;               ///< scratch
  Outline outline_;                            ///< scratch
  std::vector<HostPrimitive> pending_;         ///< made but not yet pulled
  std::size_t pending_first_ = 0;
};

/// What the hardware relies on and cannot see: behind reset a fast clear of both planes, without which the flags of tiles are
/// undefined, and a setup for the place of every line, for which primitive_join would wait for good. What is wrong with a
/// primitive of a stream, `is_first` behind reset; empty: nothing.
[[nodiscard]] std::string stream_fault(const HostPrimitive& primitive, bool is_first);

/// Throws InputError, one line naming the state, when `scene` asks for what the hardware does not have.
void check_hardware_scene(const Scene& scene, const Config& config);

}  // namespace halfplane
