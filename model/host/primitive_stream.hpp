// The host's output to the hardware for a scene: snapped primitives with their states, one packet each.
//
// First a fast clear of both buffers, unless the scene begins with one, then the scene's commands, at the end a flush.
// In program order (frame.order program) primitives are sent as they are made: the host clips; the hardware tests
// facing, area and box, except for a clipped polygon, which the host culls as a whole. In bins the host culls, sorts
// the rest (frame_bins.hpp), and sends it bin by bin: at the flush, and where the depth of the whole target is cleared,
// which begins new bins. Other clears after the first primitive of the bins go into them.
//
// A frame that follows another on the same hardware, with BinContents between them, skips bins whose content equals
// their draws. Of its initial clears then remain colours, bin by bin, and depth as a whole.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "../stages/surface.hpp"
#include "frame_bins.hpp"
#include "host_primitive.hpp"
#include "line_setup.hpp"
#include "primitives.hpp"
#include "texture_memory.hpp"

namespace halfplane {

/// Whether all clears of the whole target come before everything else, except clears of colours only: then its bins
/// begin once.
[[nodiscard]] bool begins_once(const Scene& scene);

/// The primitives of a scene, pulled one at a time. `scene` must outlive the stream.
class HostStream {
 public:
  /// Throws InputError for a scene that the hardware does not support. `held`: the content of a target in the
  /// hardware's memory; it must outlive the stream, and describes memory once all has been drawn. Null: everything is
  /// drawn.
  HostStream(const Scene& scene, const Config& config, BinContents* held = nullptr);

  HostStream(const HostStream&) = delete;  // context_ points into config_
  HostStream& operator=(const HostStream&) = delete;

  /// The next primitive; none after the flush. Throws InputError for a vertex that cannot be snapped.
  [[nodiscard]] std::optional<HostPrimitive> next();

  /// The host's own counts so far: primitives_in, clipped, and culled primitives, by reason; bins and pairs.
  [[nodiscard]] const Counters& counters() const { return counters_; }

  /// 0...1: the fraction of the scene that has been sent, by commands.
  [[nodiscard]] double progress() const;

 private:
  void advance();
  void start_draw(const Draw& draw);
  void send_next_primitive();
  void send_outline(const AssembledPrimitive& assembled);
  void send_clear(const Clear& command);
  void send_triangle(const Triangle& triangle, bool is_culled);
  void set_plane(std::size_t plane, const auto& codes, PrimitivePacket& packet) const;
  void set_coordinates(const Triangle& triangle, HostPrimitive& out);
  void set_distance(const Triangle& triangle, HostPrimitive& out) const;
  void set_colors_over_w(const Triangle& triangle, PrimitivePacket& packet) const;
  void set_normals(const Triangle& triangle, PrimitivePacket& packet) const;
  void set_colors(const HostPrimitive& primitive);
  void set_stencil(const HostPrimitive& primitive);
  void set_levels(const Triangle& triangle, const TextureCoordinates& coordinates, const PerspectiveFormat& format,
                  HostPrimitive& out) const;
  void set_texture(const HostPrimitive& triangle);
  void set_fog(const HostPrimitive& triangle);
  void set_light(const HostPrimitive& triangle);
  [[nodiscard]] HostPrimitive state_token(StateRegister which, uint128 word, const HostPrimitive& in_front_of) const;
  [[nodiscard]] std::optional<HostPrimitive> next_primitive();
  void send_line(const LinePrimitive& line);
  [[nodiscard]] PrimitivePacket draw_packet(PrimitiveKind kind, const PixelBounds& box) const;
  [[nodiscard]] PrimitivePacket fast_clear() const;
  void fill_word(Clear& clear) const;
  [[nodiscard]] bool begins_bins(const Command& command) const;
  void close_bins();
  void send_clears();
  [[nodiscard]] Signature texels_of(std::size_t texture);
  void note_words(const PrimitiveState& state);
  [[nodiscard]] HostPrimitive host_primitive(const PrimitivePacket& packet, std::uint32_t primitive) const;
  [[nodiscard]] HostPrimitive drawn_primitive(const PrimitivePacket& packet, std::uint32_t primitive) const;
  void send(const HostPrimitive& primitive);

  const Scene& scene_;
  Config config_;
  Widths widths_;
  VertexCache vertices_;
  Counters counters_;
  std::size_t command_ = 0;                    ///< the next of Scene::commands
  bool is_finished_ = false;                   ///< the flush has been queued
  std::uint32_t primitive_ = 0;                ///< number of the next input primitive
  std::optional<DrawContext> context_;         ///< of the current draw
  std::vector<AssembledPrimitive> assembled_;  ///< of the current draw
  std::size_t assembled_next_ = 0;             ///< the next of them
  std::vector<Triangle> pieces_;               ///< scratch
  Outline outline_;                            ///< scratch
  std::optional<FrameBins> bins_;              ///< with frame.order bins: primitives that wait for the end of the frame
  BinContents* held_ = nullptr;                ///< if bins are compared; then the initial clears wait
  std::vector<HostPrimitive> clears_;
  std::vector<std::optional<Signature>> texels_;  ///< of each texture, likewise
  std::vector<HostPrimitive> pending_;            ///< made but not yet pulled
  std::size_t pending_first_ = 0;
  std::optional<TextureMemory> textures_;          ///< with a texture unit
  std::optional<std::uint64_t> texture_state_;     ///< the unit's state since the scene began
  std::optional<std::uint32_t> texture_levels_;    ///< likewise, with levels
  std::optional<std::uint64_t> texture_constant_;  ///< likewise
  std::optional<std::uint64_t> texture_border_;    ///< likewise
  std::optional<FogState> fog_state_;              ///< likewise, and the lines of its table
  std::array<std::optional<FogLine>, std::size_t{1} << kFogLines> fog_line_{};
  std::array<std::optional<std::uint64_t>, kLightWords> light_word_{};  ///< likewise for light
  std::array<std::optional<FallingLine>, std::size_t{1} << kPowerLines> light_line_{};
  std::optional<TextureLines> texture_lines_;
  ColorWords colors_;                                                 ///< other registers set since the scene began
  StencilWords stencil_;                                              ///< likewise
  std::optional<double> depth_everywhere_ = 1.0;                      ///< value of every pixel, if the host knows it
  std::optional<std::uint8_t> stencil_everywhere_ = std::uint8_t{0};  ///< likewise
  std::deque<HostPrimitive> in_front_;  ///< tokens to be sent first, and the triangle that waits for them
};

/// Rules that the hardware relies on and does not check: after reset and state tokens, a fast clear of both buffers,
/// without which the flags of tiles are undefined, and a setup for the place of every line, for which primitive_join
/// would wait forever. Returns the rule that a primitive breaks, or an empty text; `is_first`: the first one after
/// reset.
[[nodiscard]] std::string stream_fault(const HostPrimitive& primitive, bool is_first);

/// Throws InputError, one line naming the state, when `scene` needs a feature that the hardware lacks.
void check_hardware_scene(const Scene& scene, const Config& config);

}  // namespace halfplane
