// The time of the pipelined RTL: cull, triangle_setup, coarse_raster, fine_raster, interpolate (setup.kind pipelined).
// Each register, unit and buffer of the .sv is a Station here; the lines after a transfer are the stage's own time.
#pragma once

#include <vector>

#include "../../timing/queue.hpp"
#include "back_timing.hpp"
#include "parameters.hpp"
#include "work.hpp"

namespace halfplane {

template <class Run>
class PipelinedTiming : public BackTiming<Run> {
  using Base = BackTiming<Run>;
  using Base::last_fragment_, Base::last_retire_, Base::totals_;
  using Base::move, Base::note, Base::work, Base::retire;

 public:
  PipelinedTiming(const Config& config, const Widths& widths, const Stalls& stalls, MemoryTiming& memory,
                  const TimingParameters& parameters, TransferSink* sink, const MemorySettings& textures)
      : Base(config, widths, stalls, memory, sink, textures),
        setup_(config, widths, parameters.divide_bits),
        offer_setup_(1, setup_.last, 1),
        slots_(config.context_slots, 0, 2),
        visits_(config.hiz_lag, 0, kVisitIsSeen),
        interpolate_(kSteps + parameters.stamp_queue, kSteps, 1),
        triangle_queue_(parameters.triangle_queue),
        setup_queue_(parameters.setup_queue),
        tile_queue_(parameters.tile_queue),
        fragment_queue_(parameters.fragment_queue) {
    for (int part = 0; part < setup_.parts; ++part) parts_.emplace_back(1, setup_.part, 0);
  }

  /// The host offers its next primitive from `cycle` on.
  void begin(Cycle cycle) {
    offer_ = std::max(offer_, cycle);
    this->begin_scene();
  }

  /// Takes the next primitive, through cull and triangle_setup to coarse_raster; a dropped one goes only into cull.
  [[gnu::flatten]] void take(const PrimitiveWork& primitive) {
    const Cycle taken = this->stream(Arrow::primitive).transfer(offer_, sort_.room());
    note(Arrow::primitive, taken);
    if (primitive.is_counted) this->count_primitive(taken);
    if (primitive.is_line) this->take_line(offer_);
    offer_ = taken + 1;
    const bool is_beside = primitive.is_state && setup_.has_state_lane;
    const Cycle sorted = std::max(is_beside ? taken + PipelinedCycles::cull_state : sort_.ready(taken), decide_.room());
    sort_.leave(sorted);
    const Cycle decided = is_beside ? sorted + PipelinedCycles::cull_state : decide_.ready(sorted);
    work(Stage::cull, is_beside ? PipelinedCycles::cull_state : PipelinedCycles::cull_sort);
    if (primitive.is_dropped) {
      decide_.leave(decided);
      return;
    }
    const Passage triangle = triangle_queue_.pass(this->stream(Arrow::triangle), decided,
                                                  is_beside ? states_.room() : parts_.front().room());
    decide_.leave(triangle.left);
    note(Arrow::triangle, triangle.taken);
    work(Stage::triangle_setup, static_cast<std::uint64_t>(is_beside ? 1 : setup_.part));
    Station& lane = is_beside ? states_ : offer_setup_;
    Cycle ready = lane.ready(is_beside ? triangle.taken : through_parts(triangle.taken));
    if (setup_.has_state_lane) {
      const Cycle joined = std::max(ready, joined_.room());
      lane.leave(joined);
      ready = joined_.ready(joined);
    }
    const Passage setup = setup_queue_.pass(this->stream(Arrow::setup), ready, std::max(coarse_.room(), slots_.room()));
    (setup_.has_state_lane ? joined_ : lane).leave(setup.left);
    note(Arrow::setup, setup.taken);
    if (slots_.room() > std::max(ready, coarse_.room()))
      totals_.slot_cycles += slots_.room() - std::max(ready, coarse_.room());
    walk_ = setup.taken + PipelinedCycles::walk_begins;
    reads_bounds_ = false;
    work(Stage::coarse_raster, PipelinedCycles::walk_begins);
  }

  /// A fast clear sets the bounds of this many groups of tiles, when every visit has retired.
  void clear_bounds(std::uint64_t groups) {
    const Cycle clears = std::max(walk_ - 1, last_retire_ + 1);
    totals_.bound_cycles += clears - (walk_ - 1);
    walk_ = clears + 1 + groups + PipelinedCycles::clear_ends;
    work(Stage::coarse_raster, groups + PipelinedCycles::clear_ends);
  }

  /// The next tile of the walk is outside and is skipped.
  void skip_outside() {
    ++walk_;
    work(Stage::coarse_raster, 1);
  }

  /// The tile goes on with its bound, which was read after the last visit and includes the visit hiz.lag before.
  void read_bound() {
    reads_bounds_ = true;
    const Cycle unread = std::max(walk_, visit_left_ + 2), ready = std::max(unread, visits_.room() + 1);
    totals_.bound_cycles += ready - unread;
    walk_ = std::max(ready, tile_left_ + 1);
  }

  /// The primitive lies behind the bound, and the tile is skipped.
  void skip_behind() {
    ++walk_;
    work(Stage::coarse_raster, 1);
  }

  /// The end of a primitive whose last tile was skipped: an empty stamp without a visit. shade(offered): the stamp in
  /// depth_test.
  template <class Shade>
  void end_walk(Shade&& shade) {
    const Cycle offered = std::max(walk_, tile_left_ + 1);
    coarse_.leave(offered - 1);
    const auto [left, taken] = tile_queue_.pass(this->stream(Arrow::tile), offered, rows_.room());
    note(Arrow::tile, taken);
    tile_left_ = left;
    const Cycle row = std::max(rows_.ready(taken), coverage_.room());
    rows_.leave(row);
    const Cycle sent = std::max(coverage_.ready(row), stamps_.room());
    coverage_.leave(sent);
    stamps_.leave(send(stamps_.ready(sent), true, shade));
    work(Stage::interpolate, 1);
  }

  /// The end of a token, likewise.
  template <class Shade>
  void end_token(Shade&& shade) {
    end_walk(shade);
  }

  /// A visit of a tile. stamps.count(row), row by row: the stamps of the row with a covered sample.
  /// shade(offered, is_covered): a stamp in depth_test, in this order; not covered: an empty stamp.
  template <class Stamps, class Shade>
  void visit(const TileVisitWork& tile, Stamps&& stamps, Shade&& shade) {
    const Cycle decided = std::max(walk_, tile_left_) + 1;
    const Cycle offered = std::max(decided, visits_.room());
    totals_.visit_cycles += offered - decided;
    const auto [left, taken] = tile_queue_.pass(this->stream(Arrow::tile), offered, rows_.room());
    note(Arrow::tile, taken);
    if (tile.ends_primitive) coarse_.leave(decided - 1);
    walk_ = decided;
    tile_left_ = visit_left_ = left;
    if (reads_bounds_) work(Stage::coarse_raster, PipelinedCycles::read_again);
    work(Stage::coarse_raster, 1);
    Cycle row_at = rows_.ready(taken);
    std::uint64_t sent = 0, empty = 0;  // stamps; rows without one
    for (int row = tile.first_row;; ++row, ++row_at) {
      const bool is_last = row == tile.last_row;
      int left_in_row = stamps.count(row);
      row_at = std::max(row_at, coverage_.room());
      Cycle leaves = coverage_.ready(row_at);
      const bool is_covered = left_in_row != 0, is_sent = is_covered || is_last;
      if (is_sent) leaves = std::max(leaves, stamps_.room());
      coverage_.leave(leaves);
      if (!is_sent) {
        ++empty;
        continue;
      }
      Cycle at = stamps_.ready(leaves);
      do {
        --left_in_row;
        const bool ends = tile.ends_primitive && is_last && left_in_row <= 0;
        ++sent;
        at = send(at, ends, [&](Cycle shaded) { return shade(shaded, is_covered); }) + 1;
      } while (left_in_row > 0);
      stamps_.leave(at - 1);
      if (is_last) break;
    }
    rows_.leave(row_at);
    work(Stage::fine_raster, sent + empty);
    work(Stage::interpolate, sent);
    retire();
    visits_.leave(last_retire_);
  }

 private:
  /// From a triangle's arrival at triangle_setup to its last part.
  Cycle through_parts(Cycle entered) {
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const Station& next = part + 1 < parts_.size() ? parts_[part + 1] : offer_setup_;
      entered = std::max(parts_[part].ready(entered), next.room());
      parts_[part].leave(entered);
    }
    return entered;
  }

  static constexpr int kSteps = PipelinedCycles::interpolate_steps;

  /// A stamp on offer by fine_raster from `offered` on, through interpolate and its FIFO. Returns when it moves.
  template <class Shade>
  Cycle send(Cycle offered, bool ends_primitive, Shade&& shade) {
    const Cycle taken = move(Arrow::stamp, offered, interpolate_.room());
    if (!Run::is_plain) note(Arrow::stamp, taken);  // the transfer of its fragment is later
    if (ends_primitive) slots_.leave(taken + 1);
    last_left_ = fragment_queue_.pass(std::max(interpolate_.ready(taken), last_left_ + 1), last_fragment_ + 1, shade);
    interpolate_.leave(last_left_);
    return taken;
  }

  FixedStation<1, PipelinedCycles::cull_sort, 0> sort_;
  FixedStation<1, PipelinedCycles::cull_decide, 0> decide_;
  SetupCycles setup_;
  OwnLinesVector<Station> parts_;                                 ///< of triangle_setup, without the last
  Station offer_setup_;                                           ///< the last part
  Station states_{SetupCycles::kStates, 1, 1}, joined_{1, 1, 0};  ///< lane of states; output register of both
  FixedStation<1, 0, 1> coarse_;
  Station slots_, visits_;
  FixedStation<1, 1, 0> rows_, coverage_, stamps_;  ///< of fine_raster
  Station interpolate_;
  Queue triangle_queue_, setup_queue_, tile_queue_, fragment_queue_;
  Cycle offer_ = 0, last_left_ = 0;
  Cycle walk_ = 0;                        ///< when coarse_raster's walk is at the next tile
  Cycle tile_left_ = 0, visit_left_ = 0;  ///< when the last tile packet left it, and the last visit
  bool reads_bounds_ = false;             ///< the current primitive reads bounds
};

}  // namespace halfplane
