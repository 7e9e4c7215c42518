// A scene as the functional engine takes it: attributes in arrays of their own, primitives assembled. What a GPU's
// buffers are to an application's: made once, drawn as often as one likes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../../host/primitive_assembly.hpp"
#include "../../packets/packets.hpp"
#include "../../scene.hpp"
#include "../../stages/phong.hpp"
#include "texel_blocks.hpp"

namespace halfplane {

/// What of a vertex lives over w, as lanes fetch it: half a cache line.
struct alignas(32) SurfaceRow {
  double w = 1;         ///< clip-space w
  double u = 0, v = 0;  ///< 0 and 1 are the sides of a texture
  double inverse = 1;   ///< 1 / w
};
[[nodiscard]] inline SurfaceRow surface_row(double w, double u, double v) { return {w, u, v, 1 / w}; }

/// Holds on to the scene, which must not change. Its colours are snapped; nothing else is computed.
class PreparedScene {
 public:
  /// `known`: `textures` of an earlier one whose scene had the same textures, so that they need not be decoded again. Throws
  /// InputError for a scene that is not valid.
  explicit PreparedScene(const Scene& scene, std::vector<TexelBlocks> known = {});
  [[nodiscard]] const Scene& scene() const { return *scene_; }

  /// Primitives of a draw that lie one behind the other, at most kChunk of them.
  struct Chunk {
    std::size_t first = 0, count = 0;             ///< into `index`
    std::uint32_t low_index = 0, high_index = 0;  ///< range of their vertices
  };
  static constexpr std::size_t kChunk = 2048;

  // Vertices, and a few more of nothing so that the last ones may be read as many at a time.
  std::vector<double> x, y, z, w;
  std::vector<std::uint32_t> rgba;  ///< snapped, R lowest
  std::vector<SurfaceRow> surface;  ///< where a state has surfaces
  std::vector<Normal> normals;      ///< where one is lit by fragments
  // Triangles of the draws that are filled, the provoking vertex first; lines of those that are drawn as such: start,
  // end, the provoking vertex. Likewise a few more.
  std::array<std::vector<std::uint32_t>, 3> index;
  struct DrawChunks {
    std::size_t first = 0, count = 0;  ///< into `chunks`
    std::size_t primitives = 0;
    /// The draw after the division by w: what an application's bounding box would say. None where w is not positive.
    bool has_box = false;
    std::array<double, 3> low{}, high{};
  };
  std::vector<Chunk> chunks;
  std::vector<DrawChunks> draws;  ///< by command; empty for what is neither
  std::vector<TexelBlocks> textures;

 private:
  const Scene* scene_;
};

}  // namespace halfplane
