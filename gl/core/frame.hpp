// A frame of a program as a scene of the model: draws are collected, and rendered when the program reads pixels or swaps.
// So that a saved frame is a capture, and any engine can draw it again.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../../model/config.hpp"
#include "../../model/scene.hpp"
#include "../../model/stages/framebuffer.hpp"

namespace halfplane::gl {

enum class OnMissing { host, warn, stop };

/// Settings of `halfplane run`, in the environment variable HALFPLANE_GL as JSON (options.cpp).
struct Options {
  Config config;
  int threads = 2;
  OnMissing on_missing = OnMissing::warn;
  bool hud = false;
  bool cycles = false;                   ///< the cycle engine draws the frames from `first_frame` to `last_frame`, too
  int first_frame = 0, last_frame = -1;  ///< -1: to the end
  double mhz = 0;                        ///< clock of the hardware, 0: not said
  std::string memory;                    ///< name of a MemoryKind; empty: fixed
  int memory_latency = 8;                ///< of the fixed memory, cycles
  std::vector<int> save;  ///< frames that are written as captures; several: with their numbers in the name
  std::string save_to;    ///< path of `save`, or the folder of all frames
  bool save_all = false;
  std::string results;  ///< file that takes one line of JSON for each frame; empty: none
  /// Whether frames become captures, or are drawn by the cycle engine as well.
  [[nodiscard]] bool is_recorded() const { return save_all || !save.empty() || cycles; }
  /// Whether draws outside the view are part of what is asked for: a capture or figures.
  [[nodiscard]] bool keeps_draws() const { return is_recorded() || !results.empty(); }
};
/// The options of HALFPLANE_GL, or the defaults. Throws InputError.
[[nodiscard]] Options options_from_environment();

/// The file that frame `number` is saved to.
[[nodiscard]] std::string saved_name(const Options& options, int number);

class Frame {
 public:
  /// Black, as far as can be. Throws InputError for a size that the configuration does not take.
  Frame(const Options& options, int width, int height);
  ~Frame();

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  [[nodiscard]] const Options& options() const;
  /// Another size: the picture is lost. Beyond the largest target of the configuration: held to that, and said.
  void resize(int width, int height);

  /// Clears inside the scissor of `state`, all channels.
  void clear(const halfplane::State& state, const Clear& what);
  /// `indices` count within `vertices`.
  void draw(const halfplane::State& state, Topology topology, std::span<const Vertex> vertices,
            std::span<const std::uint32_t> indices);
  /// The number, for State::texture, of the texture that was made for `key` (TextureObject::revision and all else that makes it
  /// another one); made once and kept over frames while it is used.
  [[nodiscard]] std::uint32_t texture(std::uint64_t key, const std::function<halfplane::Texture()>& make);

  /// Another number after numbers of textures and reported features are forgotten: in the next frame, at least.
  [[nodiscard]] std::uint64_t revision() const;

  /// The picture, after drawing what waits. Valid until the next call of a function that is not const.
  [[nodiscard]] const Framebuffer& picture();
  /// Takes the colours of another buffer of this size for its own; depths and stencil values stay. A capture of the frame
  /// begins here.
  void exchange_colors(Framebuffer& other);
  /// Samples that passed the depth test since the program began, after rendering the waiting draws: for occlusion queries.
  [[nodiscard]] std::uint64_t samples_passed();
  /// Ends the frame: renders the waiting draws, then saves and measures as the options ask, and shows the picture by `show`.
  /// Where nothing but the picture is asked for, all that happens on a thread of its own while the program goes on; a call
  /// that needs the picture waits for it.
  using Show = std::function<void(const Framebuffer&)>;
  void end(Show show = {});
  /// Waits until the frame that ended last is shown.
  void wait();

  /// Reports once for each `what` that this configuration does not have it, and how it is drawn instead; ends the program
  /// where the options say stop.
  void missing(std::string_view what, std::string_view instead);

  /// Draws the figures of Options::hud into a picture to be shown: 0xrrggbb, rows from the top. Leaves the frame as
  /// it is; does nothing without the option.
  void draw_hud(std::span<std::uint32_t> xrgb, int width, int height, int pitch_pixels) const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace halfplane::gl
