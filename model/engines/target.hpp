// A persistent frame: cleared and drawn on command by command, as a driver does, in its own memory or the caller's. The
// functional engine draws it, so the picture equals that of a scene with the same commands.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "render.hpp"

namespace halfplane {

/// Images that the caller owns, rows from the top. No padding is written: `width` pixels of each row.
struct PixelMemory {
  void* color = nullptr;           ///< stored codes of 2 bytes (rgb565) or 4 (rgba8888), in the machine's byte order
  std::size_t color_pitch = 0;     ///< bytes from one row to the next
  std::uint32_t* depth = nullptr;  ///< codes; null: not wanted
  std::size_t depth_pitch = 0;     ///< bytes from one row to the next
};

class Target {
 public:
  /// A target of `width` x `height` pixels, black and at the farthest depth. `planes` as Scene::planes. Throws
  /// InputError for an invalid configuration or a size that it does not support.
  Target(const Config& config, int width, int height, std::optional<std::array<double, 2>> planes = {});
  ~Target();
  Target(Target&&) noexcept;
  Target& operator=(Target&&) noexcept;

  /// Threads for later draws, 1 at first; no bit depends on it. Throws InputError outside 1...1024.
  void set_threads(int threads);

  /// Keeps a texture for later draws and returns its number, for State::texture. Throws InputError for a texture that
  /// validate() refuses.
  std::uint32_t add_texture(Texture texture);
  /// Replaces a texture. Throws likewise, and the old texture stays.
  void replace_texture(std::uint32_t number, Texture texture);

  /// Clears inside the scissor of `state`; Clear::state is ignored. Throws InputError for numbers outside their range;
  /// the frame is then unchanged.
  void clear(const Clear& what, const State& state = {});

  /// Draws at once; counts this draw alone. Without indices the vertices are taken in their order; an incomplete
  /// primitive at their end is left out, as in a scene. `normals`: as Scene::normals. Throws InputError as
  /// FunctionalEngine::render(); the frame is then unchanged.
  Counters draw(const State& state, Topology topology, std::span<const Vertex> vertices,
                std::span<const std::uint32_t> indices, std::span<const std::array<double, 3>> normals = {});
  Counters draw(const State& state, Topology topology, std::span<const Vertex> vertices);

  /// Every command of a scene of this size, without the clear that render_functional() begins with. Its textures are its
  /// own. Throws as above.
  Counters draw(const Scene& scene);

  /// The pixels drawn so far. Valid until the next call.
  [[nodiscard]] const Framebuffer& frame() const;

  /// Copies the frame. Throws InputError for a pitch that is less than a row, or one that misaligns it.
  void copy_to(const PixelMemory& memory) const;
  /// Replaces the frame by the caller's memory: later draws go on it. Throws likewise, and for codes that the formats
  /// do not have.
  void copy_from(const PixelMemory& memory);

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace halfplane
