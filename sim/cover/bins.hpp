// Bins of functional coverage: what a stimulus must do to the hardware before a run without a mismatch says much.
//
// kBinRows (bins.cpp) is the one table. A row is a bin, or a family of bins that differ in one word; it names the event
// that may hit it, the condition, the settings without which the hardware lacks it, the options that hit it, and the
// seeded faults (rtl_ref/cosim/mutants.cmake) that no run can catch without it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/host/primitives.hpp"
#include "model/packets/packets.hpp"
#include "model/pipeline_graph.hpp"
#include "model/stages/cache_tags.hpp"
#include "model/stages/fragment_path.hpp"

namespace halfplane::cover {

/// What a row looks at. Each event fills its members of Seen.
enum class Event : std::uint8_t {
  draw,       ///< a draw of the scene
  primitive,  ///< the host sends a primitive
  counted,    ///< the hardware has drawn it
  triangle,   ///< the packets of these arrows
  setup,
  tile,  ///< with the triangle's edges
  tie,   ///< with its corners, too
  stamp,
  line,
  retire,
  request,
  texture,
  lookup,   ///< a stamp in the tags
  meeting,  ///< a stamp and the stored words
  sample,   ///< a covered sample and its stored word
  fate,     ///< what became of a stamp
  stream    ///< cycles of a stream in the RTL
};
inline constexpr std::size_t kEvents = static_cast<std::size_t>(Event::stream) + 1;

/// What the collector knows at an event.
struct Seen {
  const Config& config;
  const Widths& widths;

  PrimitiveType type = PrimitiveType::triangle;  // draw
  const State* state = nullptr;

  PrimitiveKind kind = PrimitiveKind::triangle;  // primitive
  const PrimitivePacket* primitive = nullptr;
  bool is_clipped = false, is_outside = false, is_part = false;  ///< by the host since the primitive before
  CounterPacket counted{};                                       // counted: since the primitive before

  const TrianglePacket* triangle = nullptr;  // triangle
  unsigned corner = 0;  ///< of the input that is the first in canonical order, 3 more if it was turned

  const SetupPacket* setup = nullptr;                              // setup, and the events of tiles
  bool walks_left = false;                                         ///< the walk returns to the left of a row's start
  bool asks_hiz = false;                                           ///< its tiles are tested
  bool is_hiz_off_by_line = false, is_hiz_off_by_stencil = false;  ///< they would be, but for that

  const TilePacket* tile = nullptr;  // tile
  bool is_best_on_edge = false;      ///< an edge's largest value in the tile is 0, its smallest value likewise
  bool is_worst_on_edge = false;
  bool is_hidden_by_newer = false;    ///< by the updates that are not visible yet
  bool is_hiz_bound_equal = false;    ///< the bound is the smallest depth
  bool is_in_raising_window = false;  ///< a visit that may raise a depth is still unseen
  unsigned ties = 0;                  // tie: 1 top, 2 left, 4 other edge, 8 two edges at once

  const StampPacket* stamp = nullptr;  // stamp
  const LineSetup* line = nullptr;     // line
  bool has_line_tie = false;           ///< the error is 0 at a step
  const RetirePacket* retire = nullptr;
  const MemoryRequest* request = nullptr;
  const TextureRequest* texture = nullptr;

  const FragmentPacket* fragment = nullptr;  // lookup, meeting, sample, fate
  const TagResult* tags = nullptr;           ///< none with cache.kind tiles
  bool is_victim_again = false;              ///< the block waits among the victims
  std::size_t victims = 0;                   ///< that waited before it
  bool is_same_stamp = false;                ///< as the stamp before, whose samples it shares, and which writes depth

  DepthFunc func = DepthFunc::always;  // sample
  std::uint32_t depth = 0, stored = 0;
  bool has_stored = false;  ///< the stored depth was read
  const Stencil* stencil = nullptr;
  std::uint8_t stored_stencil = 0;
  bool passes_stencil = false, passes_depth = false;

  const StampFate* fate = nullptr;  // fate
  const ColorState* colors = nullptr;

  std::size_t stream = 0;  // stream: index in kStreams
};

struct BinRow {
  Event event;
  std::string_view name;     ///< with a * where the word of a family goes
  std::string_view members;  ///< words, separated by blanks; empty: one bin
  std::string_view what;
  std::string_view needs = {};   ///< settings, as "stencil.bits" (on) or "cache.kind=blocks", separated by blanks
  std::string_view hit_by = {};  ///< options of cosim and vectors; *: the member. Empty: --random 20000
  std::string_view faults = {};  ///< numbers of seeded faults, separated by blanks
  std::uint64_t (*hits)(const Seen&) = nullptr;  ///< bit n: member n
};

[[nodiscard]] std::span<const BinRow> bin_rows();

struct Bin {
  const BinRow* row;
  unsigned member;
  std::string name, what, hit_by;
};

/// All bins, row by row.
[[nodiscard]] const std::vector<Bin>& bins();

/// Why this configuration has no such bin: the setting that it needs. Empty: it has it.
[[nodiscard]] std::string missing_setting(const BinRow& row, const Config& config);

}  // namespace halfplane::cover
