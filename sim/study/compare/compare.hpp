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
#include "layers.hpp"
#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/golden/golden.hpp"
#include "model/scene.hpp"
#include "per_vertex.hpp"
#include "sim/study/compare/fragment_judge.hpp"
#include "sim/study/compare/surface_oracle.hpp"
#include "statistics.hpp"

namespace halfplane {

using Engine = std::function<Rendering(const Scene&, const Config&, const RenderOptions&)>;

struct CompareOptions {
  Engine engine;                  ///< none: render_functional, or render_scalar for rules that only it has
  Engine specification;           ///< judged before the operations, by fragment_tap; none: render_scalar
  bool wants_affine_cost = true;  ///< fill Comparison::affine, by a second rendering of the golden
  StudyRules rules;               ///< the oracle follows the fill rule; the golden stays top_left
  golden::Precision precision = golden::Precision::binary64;
  Skip skip;
  std::function<void(double fraction)> progress;  ///< 0...1 over the whole; may be empty, may throw to end the work
};

/// Parts of the difference between a depth or colour and real arithmetic on the unsnapped scene.
struct ErrorParts {
  PartStats snap, interpolation, storage, total;
};

/// With several samples per pixel each sample is compared and counted like a pixel; only `color_lsb` and
/// `color_error_lsb` refer to the pixel's one colour, if all of its samples show the same primitives.
struct Comparison {
  // Coverage.
  PixelCoverage coverage;                              ///< against U
  OracleResult oracle;                                 ///< against S, sample by sample
  std::uint64_t missing_pixels = 0, extra_pixels = 0;  ///< pixels with at least one such sample of `coverage`
  std::uint64_t other_visible = 0;  ///< pixels covered equally often by both, with different primitives visible

  FragmentVerdict fragments;  ///< before the operations, against S; planes unless changed by the rules

  // Against U, over the pixels where both show the same primitive. LSB of the stored formats.
  std::uint64_t compared_pixels = 0;
  ErrorStats depth_lsb, color_lsb;
  std::optional<ErrorStats> depth_eye;  ///< eye-space units; none without a perspective projection
  std::uint64_t beyond_eye = 0;         ///< pixels left out of depth_eye: the stored code is at or beyond infinity
  ErrorParts parts, color_parts;        ///< for a colour, interpolation is everything before storage
  PartStats affine;  ///< error of affine interpolation: U less U with all colours and textures perspective
  ErrorMoments affine_coordinate;  ///< likewise for texture coordinates, texels

  // Against S, over every pixel that the model owns, independent of U: the datapath alone. Colours of planes only:
  // surfaces have separate bounds.
  ErrorMoments datapath, color_datapath;
  // H - S as well: the storage rounding of a plane that climbs by halves has a mean of its own.
  ErrorMoments datapath_bias, color_datapath_bias;
  ErrorMoments color_over_w;             ///< surfaces: the primitive's own colour before a texture, LSB of 8 bits
  ErrorMoments light;                    ///< a lit colour, against the same colour in real light; LSB of 8 bits
  ErrorMoments fog;                      ///< a fogged colour, against the same colour in real fog; LSB of 8 bits
  ErrorMoments line_datapath;            ///< depth of lines and points, which has another bound; not in `datapath`
  std::optional<TextureErrors> texture;  ///< of textured pixels; none: no such pixel
  std::vector<PerVertexRow> per_vertex;  ///< the error of light at vertices; empty if no fragment is lit
  std::vector<LayerRow> layers;          ///< pixels whose colour is from several fragments; not in `color_parts`
  std::uint64_t visible_triangles = 0;   ///< triangles of the model in these figures
  std::uint64_t stage_mismatches = 0;    ///< stored values, and owners, that differ from the result of the fragments

  // Per pixel, width * height, rows from the top. NaN if not compared. Signed; for a colour, its worst channel.
  std::vector<float> depth_error_lsb, color_error_lsb;
  std::vector<float> affine_error_lsb, affine_texels;  ///< of `affine`, `affine_coordinate`; empty: not requested
  std::vector<CoverageClass> coverage_class;

  Rendering rendering;      ///< with count, ids, visible, triangles, lines and points
  golden::Image golden;     ///< with outlines
  Framebuffer perspective;  ///< the golden with all colours and textures perspective, if `affine` was requested
};

/// Runs engine and golden on the scene. Throws InputError as the engine does.
[[nodiscard]] Comparison compare(const Scene& scene, const Config& config, const CompareOptions& options = {});

/// One line for every bound of docs/spec.md that the comparison breaks; empty when all hold.
[[nodiscard]] std::vector<std::string> broken_bounds(const Comparison& comparison, const Config& config);

/// Bounds of docs/spec.md that these rules give up: they are not checked. Empty for the pipeline's own.
[[nodiscard]] std::vector<std::string> given_up_bounds(const StudyRules& rules);

}  // namespace halfplane
