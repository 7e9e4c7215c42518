// Mesa's software rasterizer on the same scene: the usual alternative. Optional, loaded on request.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene.hpp"

namespace halfplane {

/// llvmpipe in a process of its own, because its number of threads is fixed for the life of the library: several peers
/// with different numbers can coexist. Colour is RGBA8; depth is 16 bits for `depth_bits` up to 16, otherwise 24. The
/// same geometry, states and fill rule, but neither our bits nor our subpixels: llvmpipe has 8 subpixel bits and
/// interpolates in binary32, colours where a triangle is clipped are affine on the screen instead of along the edge,
/// and a point whose centre is outside the view is left out. It gets a scene, not a Config: the caller must refuse a
/// depth mapping (w, log).
class MesaPeer {
 public:
  /// `threads`: cores that may work at a time; `samples` of a pixel, 1 or 4. Throws std::runtime_error that names the
  /// package libosmesa6 when libOSMesa cannot be loaded.
  MesaPeer(int width, int height, int depth_bits, int threads, int samples = 1);
  ~MesaPeer();
  MesaPeer(const MesaPeer&) = delete;
  MesaPeer& operator=(const MesaPeer&) = delete;

  /// Starts afresh with this scene: vertices and indices once, into buffers of OpenGL. Draws that are consecutive in
  /// the indices and share their state become one, so that the driver's calls do not dominate the time; draws marked
  /// outside are left out. The scene has the size of the peer. Throws InputError that names a state unsupported by
  /// OpenGL.
  void upload(const Scene& scene);

  /// Seconds of one frame: clears, draws, and until the last pixel is written. The first one compiles shaders. Throws
  /// std::runtime_error without a scene, or when the process of llvmpipe has ended.
  [[nodiscard]] double render();

  /// The last frame, RGBA8 with R in the low byte, rows from the top.
  [[nodiscard]] std::vector<std::uint32_t> color();

  /// Its own name: "llvmpipe", its compiler and the width of its vectors.
  [[nodiscard]] std::string name() const { return name_; }

 private:
  void start(const Scene* scene);
  void stop();
  [[nodiscard]] std::vector<char> ask(char request);
  [[nodiscard]] std::vector<char> answer();

  int width_, height_, depth_bits_, threads_, samples_;
  int socket_ = -1, process_ = -1;
  bool has_scene_ = false;
  std::string name_;
};

}  // namespace halfplane
