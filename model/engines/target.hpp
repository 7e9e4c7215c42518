// A frame that stays: cleared and drawn on one command after the other, as a driver does, in memory of its own or of the
// caller's. Drawn by the functional engine, so the picture is that of a scene which holds the same commands.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "render.hpp"

namespace halfplane {

/// Images that the caller owns, rows from the top. Without padding: `width` pixels are written of each row.
struct PixelMemory {
  void* color = nullptr;           ///< stored codes of 2 bytes (rgb565) or 4 (rgba8888), of the machine's order
  std::size_t color_pitch = 0;     ///< bytes from one row to the next
  std::uint32_t* depth = nullptr;  ///< codes; null: nobody wants them
  std::size_t depth_pitch = 0;     ///< bytes from one row to the next
};

class Target {
 public:
  /// A target of `width` x `height` pixels, black and as far as can be. `planes` as Scene::planes. Throws InputError for
  /// a configuration that is none or a size that it does not take.
  Target(const Config& config, int width, int height, std::optional<std::array<double, 2>> planes = {});
  ~Target();
  Target(Target&&) noexcept;
  Target& operator=(Target&&) noexcept;

  /// Threads of the draws that follow, 1 at first; no bit depends on it. Throws InputError outside 1...1024.
  void set_threads(int threads);

  /// Keeps a texture for the draws that follow and returns its number, which State::texture names. Throws InputError for a
  /// texture that validate() refuses.
  std::uint32_t add_texture(Texture texture);
  /// Puts another texture in the place of one. Throws likewise, and the one before stays.
  void replace_texture(std::uint32_t number, Texture texture);

  /// Clears inside the scissor of `state`; Clear::state means nothing here. Throws InputError for numbers outside their
  /// range; the frame is then what it was.
  void clear(const Clear& what, const State& state = {});

  /// Draws at once; counts this draw alone. Without indices the vertices are taken in their order; what makes no whole
  /// primitive at their end is left out, as in a scene. `normals`: as Scene::normals. Throws InputError as
  /// FunctionalEngine::render(); the frame is then what it was.
  Counters draw(const State& state, Topology topology, std::span<const Vertex> vertices,
                std::span<const std::uint32_t> indices, std::span<const std::array<double, 3>> normals = {});
  Counters draw(const State& state, Topology topology, std::span<const Vertex> vertices);

  /// Every command of a scene of this size, without the clear that render_functional() begins with. Its textures are its
  /// own. Throws as above.
  Counters draw(const Scene& scene);

  /// What has been drawn so far. Valid until the next call.
  [[nodiscard]] const Framebuffer& frame() const;

  /// Copies the frame. Throws InputError for a pitch that is less than a row, or one that misaligns it.
  void copy_to(const PixelMemory& memory) const;
  /// Takes the frame over from memory: what is drawn next is drawn on it. Throws likewise, and for codes that the formats
  /// do not have.
  void copy_from(const PixelMemory& memory);

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace halfplane
