// A scene in the layout of the functional engine: attributes in arrays of their own, primitives assembled. Like an
// application's buffers on a GPU: made once, drawn any number of times.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../../attributes.hpp"
#include "../../host/primitive_assembly.hpp"
#include "../../packets/packets.hpp"
#include "../../scene.hpp"
#include "texel_blocks.hpp"

namespace halfplane {

/// A vertex's attributes over w, as lanes fetch them: half a cache line.
struct alignas(32) SurfaceRow {
  double w = 1;         ///< clip-space w
  double u = 0, v = 0;  ///< 0 to 1 over the texture
  double inverse = 1;   ///< 1 / w
};
[[nodiscard]] inline SurfaceRow surface_row(double w, double u, double v) { return {w, u, v, 1 / w}; }

/// When textures get the footprints of linear filters, which take as long as drawing each texel once: at once, or when they
/// are known from an earlier scene, for programs that draw many textures once.
enum class Footprints : std::uint8_t { at_once, when_known };

/// References the scene, which must not change. Its colours are snapped; nothing else is computed.
class PreparedScene {
 public:
  /// `known`: `textures` of an earlier prepared scene with the same textures, which then need not be decoded again.
  /// Throws InputError for an invalid scene.
  explicit PreparedScene(const Scene& scene, std::vector<TexelBlocks> known = {},
                         Footprints footprints = Footprints::at_once);
  [[nodiscard]] const Scene& scene() const { return *scene_; }

  /// Consecutive primitives of a draw, at most kChunk.
  struct Chunk {
    std::size_t first = 0, count = 0;             ///< into `index`
    std::uint32_t low_index = 0, high_index = 0;  ///< range of their vertices
  };
  static constexpr std::size_t kChunk = 2048;

  // Vertices, padded so that the last ones may be read a whole register at a time.
  std::vector<double> x, y, z, w;
  std::vector<std::uint32_t> rgba;  ///< snapped, R lowest
  std::vector<SurfaceRow> surface;  ///< where a state has surfaces
  std::vector<Normal> normals;      ///< where a state lights fragments
  // Triangles of filled draws, the provoking vertex first; lines of line draws: start, end, the provoking vertex; points:
  // their vertex three times. Padded likewise.
  std::array<std::vector<std::uint32_t>, 3> index;
  struct DrawChunks {
    std::size_t first = 0, count = 0;  ///< into `chunks`
    std::size_t primitives = 0;
    /// The draw after the division by w: like an application's bounding box. None where w is not positive.
    bool has_box = false;
    std::array<double, 3> low{}, high{};
  };
  std::vector<Chunk> chunks;
  std::vector<DrawChunks> draws;  ///< by command; empty for other commands
  std::vector<TexelBlocks> textures;

 private:
  const Scene* scene_;
};

}  // namespace halfplane
