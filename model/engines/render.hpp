// Input and output of every engine of the model: one interface, so that engines can be exchanged and compared.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "../config.hpp"
#include "../counters.hpp"
#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../stages/framebuffer.hpp"
#include "../study/rules.hpp"

namespace halfplane {

/// Samples of one tile that a triangle covers: bit i of row j. Rows beyond the tile size are 0.
using TileMask = std::array<std::uint32_t, 32>;

/// Called for every tile that was not skipped, also when its mask is empty, in the engine's order: index into
/// Rendering::triangles, tile column, tile row, mask; and the mask's sample number in a pixel, before
/// State::sample_mask.
using CoverageTap =
    std::function<void(std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask, int sample)>;

/// Called for every covered pixel of a line or a point: its primitive, as in Rendering::ids.
using PixelTap = std::function<void(std::uint32_t primitive, int x, int y)>;

struct TappedFragment;  // tapped_fragment.hpp

/// Called for every fragment in program order.
using FragmentTap = std::function<void(const TappedFragment& fragment)>;

struct RenderOptions {
  Skip skip;
  int threads = 1;                    ///< of the functional and the cycle engine; no result depends on it
  std::string_view instruction_set;   ///< likewise: portable, avx2, avx512; otherwise the machine's best
  bool general_fragments = false;     ///< likewise: draws fragments one by one, for tests
  StudyRules rules;                   ///< other than the default only in render_scalar
  const Framebuffer* onto = nullptr;  ///< the frame to draw on, made by the same engine; null: an empty one
  bool follows = false;  ///< for FunctionalEngine: the frame may be compared with the previous frame, see Skip::bins
  bool resolved_only = false;   ///< Framebuffer::samples is not read: the functional engine may leave it empty
  bool want_count = false;      ///< fill Rendering::count
  bool want_ids = false;        ///< fill Rendering::ids
  bool want_triangles = false;  ///< keep Rendering::triangles (and fill `visible` next to `ids`)
  CoverageTap coverage_tap;     ///< implies want_triangles
  PixelTap pixel_tap;           ///< may be empty
  FragmentTap fragment_tap;     ///< in render_scalar only; implies want_triangles
  std::function<void(double fraction)> progress;  ///< 0...1, called at most a few times a second; may be empty

  [[nodiscard]] bool keeps_triangles() const { return want_triangles || coverage_tap || fragment_tap; }
};

/// Owner of each stored pixel, width * height.
struct Owners {
  std::vector<std::int32_t> ids;      ///< input primitive that owns the stored colour or depth, -1 none
  std::vector<std::int32_t> visible;  ///< index of the owner in `triangles`, -1 none, -2 line or point
};

/// `ids` and `visible` of the Owners are those of sample 0 where a pixel has several samples. Counters then count
/// samples.
struct Rendering : Owners {
  Framebuffer frame;
  Counters counters;
  std::vector<std::uint32_t> count;   ///< covered samples per pixel before the depth test, width * height
  std::vector<Owners> sample_owners;  ///< by sample of a pixel; empty with one sample per pixel
  std::vector<Triangle> triangles;    ///< every triangle that reached setup, in program order
  std::vector<DrawnLine> lines;       ///< every line with a pixel inside the scissor; kept with `triangles`
  std::vector<DrawnPoint> points;     ///< likewise
  double geometry_s = 0, raster_s = 0;
};

/// The frame named in the options, or an empty target: the farthest depth, opaque black. With the buffers that the
/// options request.
[[nodiscard]] Rendering make_rendering(const Scene& scene, const Config& config, const RenderOptions& options);

/// Throws InputError if the frame named in the options has another size, or another number of samples.
void check_onto(const Scene& scene, const Config& config, const RenderOptions& options);

/// Final work after all draws: multisampled pixels get their resolved colour, and sample 0's owners.
void finish_samples(Rendering& rendering, const Config& config);

/// A clear's colour, channels 0 to 255, in the stored format.
[[nodiscard]] std::uint32_t clear_color(const std::array<double, 4>& color, ColorFormat format);

/// Clears depth and colour inside the scissor; the cleared pixels have no owner.
void clear(Rendering& rendering, const Scene& scene, const Clear& command, const Config& config);

}  // namespace halfplane
