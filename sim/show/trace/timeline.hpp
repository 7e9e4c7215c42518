// Timeline of a run as Chrome trace JSON, for Perfetto (ui.perfetto.dev): stages as tracks, primitives, tiles and tile
// moves as slices. One cycle is one microsecond. Held in memory until finish(): about 100 bytes a slice, of which a
// primitive has three and a tile visit up to five.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/engines/cycle/cycle_model.hpp"

namespace halfplane {

// Per-primitive cycle listing: the first and last crossing of each boundary by each primitive, a line of CSV each,
// about 150 bytes, held in memory until finish().

class PrimitiveSpans final : public TransferSink {
 public:
  PrimitiveSpans();
  void transfer(Arrow boundary, Cycle cycle) override;
  void primitive(const HostPrimitive& primitive) override;
  /// The whole listing, header first. Call it once, after the run.
  [[nodiscard]] const std::string& finish();

 private:
  struct Span {
    Cycle first = 0, last = 0;
    std::uint64_t items = 0;
  };
  void write();

  std::string text_, head_;  ///< head_: of the current line
  bool has_primitive_ = false;
  std::uint64_t number_ = 0;
  std::array<Span, kArrows> span_{};
};

/// "triangle", "rectangle", "fast_clear", "flush", "point", "line".
[[nodiscard]] std::string_view kind_name(PrimitiveKind kind);

class Timeline final : public TransferSink {
 public:
  /// `title`, a JSON string with its quotes, names the process: scene and configuration.
  explicit Timeline(const std::string& title);
  void transfer(Arrow boundary, Cycle cycle) override;
  void primitive(const HostPrimitive& primitive) override;
  void visit(int tile_x, int tile_y) override;
  void move(MoveCause cause, bool is_color, int tile_x, int tile_y, Cycle from, Cycle to) override;
  void wait(Cycle from, Cycle to) override;
  /// The whole document. Call it once, after the run.
  [[nodiscard]] const std::string& finish();

 private:
  enum Track : int { cull, setup = 2, coarse = 8, fine = 10, lines, depth, framebuffer, memory_depth, memory_color };
  static constexpr int kOrder = 64;  ///< distance of tracks: room for more lanes of a stage
  /// One of the tracks of a stage with several primitives under way.
  struct Lane {
    int track;
    Cycle end = 0;               ///< of its last slice
    int order = kOrder * track;  ///< from top to bottom
  };
  void add_track(int track, int order, const std::string& name);
  void slice(int track, const std::string& name, Cycle from, Cycle to);
  /// Adds the primitive in such a stage: on the first lane free from `from` on, or on a new one.
  void slice_in(std::vector<Lane>& lanes, Cycle from, Cycle to);
  void end_tile(Cycle limit);
  void end_visit();
  void end_primitive();

  std::string text_;
  std::string name_, tile_name_,
      next_tile_name_;  ///< names of the primitive, of the tile in fine_raster, of the next tile
  bool has_tile_ = false, has_stamps_ = false, has_fragments_ = false, has_setup_ = false, has_line_ = false;
  Cycle taken_ = 0, triangle_ = 0, setup_ = 0, last_tile_ = 0, tile_ = 0, first_stamp_ = 0, last_stamp_ = 0,
        first_fragment_ = 0, last_fragment_ = 0, line_ = 0, last_pixel_ = 0;
  std::vector<Lane> cull_lanes_{{cull}, {cull + 1}},
      setup_lanes_{{setup}, {setup + 1}, {setup + 2}, {setup + 3}, {setup + 4}, {setup + 5}},
      coarse_lanes_{{coarse}, {coarse + 1}};
  int tracks_ = memory_color + 1;  ///< the tracks above, and the lanes for deeper configurations
};

}  // namespace halfplane
