// The data of `explain` about a pixel: all primitives near it, in program order, step by step.
//
// The model's figures are those of the specification (model/stages); its packets are those of the hardware model. Added
// to these: the golden (unsnapped, real arithmetic), the oracle (snapped, exact), and the RTL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/engines/tapped_fragment.hpp"
#include "model/formats/sample_pattern.hpp"
#include "model/golden/exact.hpp"
#include "model/golden/golden.hpp"
#include "model/packets/packets.hpp"
#include "model/pipeline_graph.hpp"
#include "model/stages/surface.hpp"
#include "model/stages/tile_walk.hpp"
#include "model/study/rules.hpp"
#include "sim/study/compare/surface_oracle.hpp"

namespace halfplane::explain {

// The possible fates of a primitive at a pixel, and their stages: one table, from which names, stages and sentences
// follow.
//
// A new test of fragments is a row here and a row of operations.cpp.

// clang-format off
/// VERDICT(name, stage that says so, whether the primitive covers the pixel, why). Names as in Counters::skipped.
#define HALFPLANE_VERDICTS(VERDICT)                                                                          \
  VERDICT(frustum,       clip,          false, "all of it lies outside one side of the view")                \
  VERDICT(zero_area,     cull,          false, "its area is zero after the snap")                            \
  VERDICT(backface,      cull,          false, "it faces the side that is culled")                           \
  VERDICT(empty,         cull,          false, "its box holds no pixel centre that may be drawn")            \
  VERDICT(no_sample,     cull,          false, "it is small, and cull sees that it covers no sample")        \
  VERDICT(scissor,       cull,          true,  "it covers the pixel, but the scissor or viewport leaves it out") \
  VERDICT(tiles_outside, coarse_raster, false, "the pixel's tile lies outside one of its edges")             \
  VERDICT(tiles_hiz,     coarse_raster, true,  "nothing of it in this tile can be nearer than what is stored (HiZ)") \
  VERDICT(uncovered,     fine_raster,   false, "it does not cover the pixel's sample")                       \
  VERDICT(stencil,       depth_test,    true,  "the stencil test fails")                                     \
  VERDICT(depth,         depth_test,    true,  "the depth test fails")                                       \
  VERDICT(alpha,         depth_test,    true,  "it passes the other tests, but not that of its alpha")       \
  VERDICT(masked,        rop,           true,  "it passes, and neither depth nor colour may be written")     \
  VERDICT(written,       rop,           true,  "it passes and is written")
// clang-format on

#define HALFPLANE_NAME(name, ...) name,
enum class Verdict : std::uint8_t { HALFPLANE_VERDICTS(HALFPLANE_NAME) };
#undef HALFPLANE_NAME

struct VerdictInfo {
  std::string_view name;
  Stage stage;      ///< stage that usually decides the fate
  bool is_covered;  ///< as far as tested; a tile hidden by HiZ may contain uncovered pixels too
  std::string_view why;
};

#define HALFPLANE_VERDICT(name, stage, covered, why) VerdictInfo{#name, Stage::stage, covered, why},
inline constexpr std::array kVerdictInfo{HALFPLANE_VERDICTS(HALFPLANE_VERDICT)};
#undef HALFPLANE_VERDICT

[[nodiscard]] constexpr const VerdictInfo& info(Verdict verdict) {
  return kVerdictInfo[static_cast<std::size_t>(verdict)];
}

/// The stage where it ended, and the reason.
struct Outcome {
  Verdict verdict = Verdict::uncovered;
  Stage stage = Stage::fine_raster;
  std::string_view why{};

  Outcome() = default;
  explicit constexpr Outcome(Verdict v) : Outcome(v, info(v).stage, info(v).why) {}
  constexpr Outcome(Verdict v, Stage s, std::string_view w) : verdict(v), stage(s), why(w) {}
};

/// Whether the fragment reached the tests, so that it has attributes.
[[nodiscard]] constexpr bool has_fragment(Verdict verdict) {
  return info(verdict).is_covered && verdict != Verdict::scissor && verdict != Verdict::tiles_hiz;
}

/// Pixels in integers, the top left one is 0 0.
struct Pixel {
  int x = 0, y = 0;
  bool operator==(const Pixel&) const = default;
};

enum class Kind : std::uint8_t { clear, triangle, line, point };
inline constexpr std::array<std::string_view, 4> kKindNames{"clear", "triangle", "line", "point"};

/// One edge of a triangle at the pixel's centre.
struct EdgeFigure {
  std::size_t from = 0, to = 0;  ///< corners, in the primitive's order
  EdgeValue value = 0;           ///< the model's: floor((E + bias) / 2^s), stepped from the tile's first pixel
  std::int64_t exact = 0;        ///< E itself, square subpixels
  int bits = 0;                  ///< of `value`
  bool owns_ties = false;        ///< a sample exactly on it belongs to this triangle
  std::string_view side;         ///< top, left, bottom or right: the first two own their ties
  [[nodiscard]] bool is_tie() const { return exact == 0; }
};

/// Parts of a value's error, in 2^-20 LSB: they sum to the code less the golden's value.
struct Parts {
  std::int64_t snap = 0, interpolation = 0, storage = 0;
};

/// A plane at the pixel.
struct PlaneFigure {
  std::string_view name;
  int bits = 0;                  ///< of a code
  int guard_bits = 0;            ///< fraction bits of `unrounded`
  std::int64_t unrounded = 0;    ///< 2^-guard_bits LSB, before rounding and clamp
  std::uint32_t code = 0;        ///< after
  exact::Rational oracle;        ///< LSB
  std::optional<double> golden;  ///< LSB; none if the golden has no such fragment, or its colour is textured
  std::optional<Parts> parts;    ///< with `golden`
};

/// A texel that a sample reads.
struct TexelFigure {
  int level = 0, x = 0, y = 0;
  std::uint32_t weight = 0;              ///< 2^-24
  std::optional<std::uint32_t> address;  ///< byte address in the texture unit's memory, if there is one
  Texel color{};
  bool is_border = false;  ///< the colour is the border's, beyond this texel
};

/// A colour over w, its light or a texture at the pixel.
struct SurfaceFigure {
  SurfaceSample sample;
  bool is_lit = false;
  std::string texture;  ///< its name; empty: only colours over w
  SampleFilter filter;
  std::vector<TexelFigure> texels;
  SurfaceErrors errors;
};

/// A state of a line's registers, and the values of two textbooks at the same pixel.
struct LineStep {
  std::uint32_t step = 0;
  int x = 0, y = 0;
  std::int64_t error = 0;  ///< line_raster's: >= 0 moves along both axes
  bool moves = false;
};
struct LineWalk {
  LineRule rule = LineRule::midpoint;
  std::vector<LineStep> steps;  ///< of the whole line, or of the pixel's column alone
};
inline constexpr std::array<std::string_view, 3> kLineRuleNames{"midpoint", "bresenham", "diamond"};
struct LineFigure {
  LineRule rule = LineRule::midpoint;
  std::int64_t major = 0, minor = 0;  ///< D and d, subpixels
  bool is_x_major = false;
  LineSetup setup;
  std::vector<LineWalk> walks;      ///< by each rule
  std::vector<LineStep> bresenham;  ///< the textbook's decision p (Bresenham 1965), pixels; likewise
  std::vector<LineStep> midpoint;   ///< 2 F(M) of the midpoint method (Pitteway 1967, Van Aken 1984), pixels
};

/// A pixel of a triangle's box, for --steps.
struct TriangleStep {
  int x = 0, y = 0;
  TileClass tile = TileClass::outside;
  EdgeValues value{};
  bool covered = false;
  PlaneSample depth{};  ///< of covered pixels
};

/// A figure of an operation: codes, or the channels R, G, B, A.
struct Figure {
  std::string_view name;
  std::vector<std::uint64_t> values;
  int bits = 0;  ///< of each; 0: a word of `text`
  std::string_view text{};
};

/// One operation on the fragment, and its effect.
struct OperationStep {
  std::string_view name;
  Stage stage = Stage::none;
  std::optional<bool> passes;  ///< result of a test
  std::vector<Figure> figures;
};

/// Packet `number` of an arrow, counted from reset.
using PacketId = std::pair<Arrow, std::uint64_t>;
struct RecordedPacket {
  std::vector<std::uint32_t> model, rtl;  ///< words; rtl is empty without RTL
  std::optional<std::uint64_t> model_cycle, rtl_cycle;
};
using PacketStore = std::map<PacketId, RecordedPacket>;

/// coarse_raster's test of the tile's HiZ bound. Depth codes.
struct HizLook {
  std::uint64_t nearest = 0;   ///< of the primitive: the smallest code of its corners
  std::uint64_t farthest = 0;  ///< of the tile: no stored code is larger
  bool rejects = false;
};

/// The hardware model's treatment of a primitive at the pixel.
struct HardwareFigure {
  Outcome outcome;
  std::optional<HizLook> hiz;
  std::vector<PacketId> packets;  ///< in order
};

/// The golden's treatment of it.
struct GoldenFigure {
  std::optional<golden::Outline> outline;  ///< none: dropped before the raster
  std::vector<double> edges;               ///< of a triangle, square pixels: by corner opposite, >= 0 inside
  std::optional<golden::TappedFragment> fragment;
};

/// The exact answer.
struct OracleFigure {
  bool covers = false, is_on_border = false;
};

/// A primitive, or a piece of one, at the pixel; with several samples, at one of them.
struct Entry {
  Kind kind = Kind::triangle;
  std::optional<std::uint32_t> primitive;  ///< number over the whole scene; none for a clear
  std::uint32_t draw = 0;                  ///< index into Scene::commands
  std::uint32_t piece = 0;                 ///< of a clipped triangle, or of a triangle whose edges are drawn
  Outcome outcome;                         ///< the hardware's if it supports the scene
  Outcome specification;
  bool is_cut = false;
  std::optional<int> shaded_at;        ///< for a covered sample: source of its colour, kAtCentre or a sample's number
  bool is_left_out = false;            ///< covered, but not in State::sample_mask
  std::vector<SnappedVertex> corners;  ///< of the piece; empty when nothing was snapped
  std::int64_t area = 0;               ///< twice, signed, square subpixels
  PixelBounds box;                     ///< pixel centres inside the scissor
  std::vector<EdgeFigure> edges;
  std::optional<TileClass> tile;
  std::vector<PlaneFigure> planes;
  std::optional<SurfaceFigure> surface;
  std::optional<LineFigure> line;
  std::vector<TriangleStep> steps;  ///< only if requested
  std::int32_t point_size = 0;      ///< subpixels
  PointShape point_shape = PointShape::square;
  std::vector<OperationStep> operations;
  std::optional<HardwareFigure> hardware;
  std::optional<GoldenFigure> golden;
  std::optional<OracleFigure> oracle;
};

/// The final stored values of the pixel.
struct Stored {
  std::uint32_t depth = 0, color = 0;
  std::int32_t owner = -1;   ///< input primitive, -1 none; unknown for the RTL and the hardware model
  std::uint8_t stencil = 0;  ///< likewise
};
struct GoldenStored {
  double depth = 0;               ///< LSB of the interpolated depth, not rounded
  std::array<double, 4> color{};  ///< 0...255
  Stored rounded;
};

/// The resolved pixel of several samples: the mean of their colours; depth, stencil and owner of sample 0.
struct Resolved {
  Stored model, engine;
  GoldenStored golden;
};

/// History of a pixel, or of one of its samples: those of a pixel are consecutive, and name the same primitives.
struct PixelHistory {
  Pixel at;
  int sample = 0;      ///< in the pixel
  SampleOffset place;  ///< of the sample, from the pixel's upper left corner, 2^-8 pixel
  std::vector<Entry> history;
  Stored model;   ///< the result of the operations
  Stored engine;  ///< the functional engine's result, or with study rules the scalar engine's
  GoldenStored golden;
  std::optional<Stored> hardware, rtl;
  std::optional<Resolved> resolved;  ///< with sample 0 of several
};

struct Explanation {
  std::vector<PixelHistory> pixels;         ///< in the requested order, each sample separately
  int samples = 1;                          ///< of a pixel
  FillRule fill_rule = FillRule::top_left;  ///< of the specification
  PacketStore packets;                      ///< packets named in a history
  std::uint64_t primitives = 0;             ///< of the scene
  std::string no_hardware;                  ///< reason why the hardware cannot draw the scene; empty: it can
  std::uint64_t checks = 0;                 ///< compared figures
  std::vector<std::string> differences;     ///< differing figures, a line each
};

/// The histories of one pixel: one per sample.
using PixelSamples = std::span<const PixelHistory>;
/// The samples of every pixel, in order.
[[nodiscard]] inline std::vector<PixelSamples> pixels_of(const Explanation& told) {
  std::vector<PixelSamples> pixels;
  const auto samples = static_cast<std::size_t>(told.samples);
  for (std::size_t first = 0; first < told.pixels.size(); first += samples)
    pixels.push_back(PixelSamples(told.pixels).subspan(first, samples));
  return pixels;
}

}  // namespace halfplane::explain
