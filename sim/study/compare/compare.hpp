// Compare: one engine of the model against golden and oracle, each difference located and split into its parts.
//
// Four images: U unsnapped vertices, real arithmetic (golden); S the exact plane through the snapped vertices (oracle);
// H the hardware's value before storage rounding; D the stored code. Then snap = S - U, interpolation = H - S and
// storage = D - H. All are held as integers of 2^-20 LSB, so the parts sum to the total exactly.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../../show/image/coverage_class.hpp"
#include "coverage.hpp"
#include "fragment_judge.hpp"
#include "layers.hpp"
#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/golden/golden.hpp"
#include "model/scene.hpp"
#include "per_vertex.hpp"
#include "sim/study/compare/surface_oracle.hpp"
#include "statistics.hpp"

namespace halfplane {

using Engine = std::function<Rendering(const Scene&, const Config&, const RenderOptions&)>;

struct CompareOptions {
  Engine engine;         ///< none: render_functional, or render_scalar for rules that it alone has
  Engine specification;  ///< whose fragments are judged before the operations, by fragment_tap; none: render_scalar
  bool wants_affine_cost = true;  ///< fill Comparison::affine, by a second rendering of the golden
  StudyRules rules;               ///< the oracle follows the fill rule; the golden stays top_left
  golden::Precision precision = golden::Precision::binary64;
  Skip skip;
  std::function<void(double fraction)> progress;  ///< 0...1 over the whole; may be empty, may throw to end the work
};

/// Why a depth or colour is not what real arithmetic makes of the unsnapped scene.
struct ErrorParts {
  PartStats snap, interpolation, storage, total;
};

/// Of pixels with several samples each sample is compared as a pixel otherwise is, and counted; only `color_lsb` and
/// `color_error_lsb` are of the pixel's one colour, where all of its samples show the same primitives.
struct Comparison {
  // Coverage.
  PixelCoverage coverage;                              ///< against U
  OracleResult oracle;                                 ///< against S, sample by sample
  std::uint64_t missing_pixels = 0, extra_pixels = 0;  ///< pixels with at least one such sample of `coverage`
  std::uint64_t other_visible = 0;  ///< pixels covered equally often by both, with different primitives visible

  FragmentVerdict fragments;  ///< before the operations, against S; planes unless the rules make them otherwise

  // Against U, over the pixels where both show the same primitive. LSB of the stored formats.
  std::uint64_t compared_pixels = 0;
  ErrorStats depth_lsb, color_lsb;
  std::optional<ErrorStats> depth_eye;  ///< eye-space units; none where no perspective projection is to be found
  std::uint64_t beyond_eye = 0;         ///< pixels left out of depth_eye: the stored code lies at or beyond infinity
  ErrorParts parts, color_parts;        ///< of a colour, interpolation is all that comes before storage
  PartStats affine;  ///< what affine interpolation costs: U less U with all colours and textures perspective
  ErrorMoments affine_coordinate;  ///< likewise, how far texture coordinates are off, texels

  // Against S, over every pixel that the model owns, whatever U shows there: the datapath alone. Colours of planes only:
  // what a surface shows has bounds of its own.
  ErrorMoments datapath, color_datapath;
  // H - S as well: the storage rounding of a plane that climbs by halves has a mean of its own.
  ErrorMoments datapath_bias, color_datapath_bias;
  ErrorMoments color_over_w;             ///< of surfaces: their primitive's own colour before a texture, LSB of 8 bits
  ErrorMoments light;                    ///< of a colour in its light, against its own in real light; LSB of 8 bits
  ErrorMoments fog;                      ///< of a colour in fog, against its own in real fog; LSB of 8 bits
  ErrorMoments line_datapath;            ///< the depth of lines and points, whose bound is another; not in `datapath`
  std::optional<TextureErrors> texture;  ///< of the pixels that show one; none: no pixel does
  std::vector<PerVertexRow> per_vertex;  ///< what light at vertices would cost; empty where no fragment is lit
  std::vector<LayerRow> layers;          ///< pixels whose colour is more than one fragment's; not in `color_parts`
  std::uint64_t visible_triangles = 0;   ///< of the model, behind those figures
  std::uint64_t stage_mismatches = 0;    ///< stored values, and owners, that differ from what the fragments leave

  // Per pixel, width * height, rows from the top. NaN where not compared. Signed; of a colour, its worst channel.
  std::vector<float> depth_error_lsb, color_error_lsb;
  std::vector<float> affine_error_lsb, affine_texels;  ///< of `affine`, `affine_coordinate`; empty: not asked for
  std::vector<CoverageClass> coverage_class;

  Rendering rendering;      ///< with count, ids, visible, triangles, lines and points
  golden::Image golden;     ///< with outlines
  Framebuffer perspective;  ///< of the golden with all colours and textures perspective, if `affine` was asked for
};

/// Runs engine and golden on the scene. Throws InputError as the engine does.
[[nodiscard]] Comparison compare(const Scene& scene, const Config& config, const CompareOptions& options = {});

/// One line for every bound of docs/spec.md that the comparison breaks; empty when all hold.
[[nodiscard]] std::vector<std::string> broken_bounds(const Comparison& comparison, const Config& config);

/// What docs/spec.md promises and these rules do not: nobody holds them to it. Empty for the pipeline's own.
[[nodiscard]] std::vector<std::string> given_up_bounds(const StudyRules& rules);

}  // namespace halfplane
