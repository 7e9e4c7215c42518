// What every engine of the model takes and gives: one interface, so that engines can be exchanged and compared.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "../config.hpp"
#include "../counters.hpp"
#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../stages/framebuffer.hpp"
#include "../stages/surface.hpp"
#include "../study/rules.hpp"

namespace halfplane {

/// Which samples of one tile a triangle covers: bit i of row j. Rows beyond the tile size are 0.
using TileMask = std::array<std::uint32_t, 32>;

/// Called for every tile that was not skipped, also when its mask is empty, in the engine's order: index into
/// Rendering::triangles, tile column, tile row, mask; and of which sample of its pixels the mask is, before State::sample_mask.
using CoverageTap =
    std::function<void(std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask, int sample)>;

/// Called for every covered pixel of a line or a point: its primitive, as in Rendering::ids.
using PixelTap = std::function<void(std::uint32_t primitive, int x, int y)>;

/// A covered sample with its attributes, as it comes to the operations: nothing has encoded, tested or packed it.
struct TappedFragment {
  PrimitiveKind kind = PrimitiveKind::triangle;  ///< triangle, line or point
  std::uint32_t primitive = 0;                   ///< as in Rendering::ids
  std::uint32_t draw = 0;                        ///< index into Scene::commands
  std::uint32_t item = 0;                        ///< index into Rendering::triangles, lines or points
  const Triangle* triangle = nullptr;            ///< the same, valid during the call; null for the other two kinds
  const DrawnLine* line = nullptr;               ///< likewise
  const DrawnPoint* point = nullptr;             ///< likewise
  int x = 0, y = 0;                              ///< pixels
  int guard_bits = 0;                            ///< l of its planes; of a line's G'
  int sample = 0;                                ///< of its pixel: each covered one is a fragment of its own
  int shaded_at = -1;  ///< where its colour is from: -1 the pixel's centre, else a sample (stages/multisample.hpp)
  PerPlane<PlaneSample> plane{};
  std::optional<SurfaceSample> surface{};  ///< of triangles whose colour is more than their planes
};

/// Called for every fragment in program order.
using FragmentTap = std::function<void(const TappedFragment& fragment)>;

struct RenderOptions {
  Skip skip;
  int threads = 1;                    ///< of the functional engine; the image does not depend on it
  std::string_view instruction_set;   ///< likewise: portable, avx2, avx512; otherwise the machine's best
  bool general_fragments = false;     ///< likewise: fragments one by one, as tests ask of it
  StudyRules rules;                   ///< anything but the default: render_scalar alone has it
  const Framebuffer* onto = nullptr;  ///< the frame that is drawn on, as this engine made it; null: an empty one
  bool follows = false;         ///< of FunctionalEngine: the frame before may be compared with this one, see Skip::bins
  bool resolved_only = false;   ///< Framebuffer::samples is not read: the functional engine may leave it empty
  bool want_count = false;      ///< fill Rendering::count
  bool want_ids = false;        ///< fill Rendering::ids
  bool want_triangles = false;  ///< keep Rendering::triangles (and fill `visible` beside `ids`)
  CoverageTap coverage_tap;     ///< implies want_triangles
  PixelTap pixel_tap;           ///< may be empty
  FragmentTap fragment_tap;     ///< of render_scalar alone; implies want_triangles
  std::function<void(double fraction)> progress;  ///< 0...1, called a few times a second at most; may be empty

  [[nodiscard]] bool keeps_triangles() const { return want_triangles || coverage_tap || fragment_tap; }
};

/// Who owns what is stored, width * height.
struct Owners {
  std::vector<std::int32_t> ids;      ///< input primitive that owns the stored colour or depth, -1 none
  std::vector<std::int32_t> visible;  ///< index into `triangles` of the same, -1 none, -2 line or point
};

/// `ids` and `visible` of the Owners are those of sample 0 where a pixel has several. Counters then count samples.
struct Rendering : Owners {
  Framebuffer frame;
  Counters counters;
  std::vector<std::uint32_t> count;   ///< covered samples per pixel before the depth test, width * height
  std::vector<Owners> sample_owners;  ///< of each sample of a pixel; empty where a pixel has one
  std::vector<Triangle> triangles;    ///< every triangle that reached setup, in program order
  std::vector<DrawnLine> lines;       ///< every line with a pixel inside the scissor; likewise, and kept with them
  std::vector<DrawnPoint> points;     ///< likewise
  double geometry_s = 0, raster_s = 0;
};

/// The frame that the options name, or an empty target: the farthest depth, opaque black. With the buffers that they ask for.
[[nodiscard]] Rendering make_rendering(const Scene& scene, const Config& config, const RenderOptions& options);

/// Throws InputError when the frame that the options name has another size, or other samples.
void check_onto(const Scene& scene, const Config& config, const RenderOptions& options);

/// What is left to do when all has been drawn: pixels with several samples get their colour, and sample 0's owners.
void finish_samples(Rendering& rendering, const Config& config);

/// A clear's colour, channels 0 to 255, as it is stored.
[[nodiscard]] std::uint32_t clear_color(const std::array<double, 4>& color, ColorFormat format);

/// Clears depth and colour inside the scissor; nobody owns the cleared pixels any more.
void clear(Rendering& rendering, const Scene& scene, const Clear& command, const Config& config);

}  // namespace halfplane
