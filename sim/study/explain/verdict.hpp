// What can become of a primitive at a pixel, and where: one table, from which names, stages and sentences follow.
//
// A new test of fragments is a row here and a row of operations.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "model/pipeline_graph.hpp"

namespace halfplane::explain {

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
  Stage stage;      ///< that usually says so
  bool is_covered;  ///< as far as anybody has looked; a tile behind HiZ may hold uncovered pixels too
  std::string_view why;
};

#define HALFPLANE_VERDICT(name, stage, covered, why) VerdictInfo{#name, Stage::stage, covered, why},
inline constexpr std::array kVerdictInfo{HALFPLANE_VERDICTS(HALFPLANE_VERDICT)};
#undef HALFPLANE_VERDICT

[[nodiscard]] constexpr const VerdictInfo& info(Verdict verdict) {
  return kVerdictInfo[static_cast<std::size_t>(verdict)];
}

/// Where it ended, and why.
struct Outcome {
  Verdict verdict = Verdict::uncovered;
  Stage stage = Stage::fine_raster;
  std::string_view why{};

  Outcome() = default;
  explicit constexpr Outcome(Verdict v) : Outcome(v, info(v).stage, info(v).why) {}
  constexpr Outcome(Verdict v, Stage s, std::string_view w) : verdict(v), stage(s), why(w) {}
};

/// Whether the fragment came to the tests, so that it has attributes.
[[nodiscard]] constexpr bool has_fragment(Verdict verdict) {
  return info(verdict).is_covered && verdict != Verdict::scissor && verdict != Verdict::tiles_hiz;
}

}  // namespace halfplane::explain
