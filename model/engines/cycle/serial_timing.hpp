// The time of the RTL for the smallest parts (setup.kind serial): *_serial.sv. A stage reads its packet until it has
// finished it, so a packet often moves together with the last packet made from it: such transfers wait for the stalls
// of several streams at once.
#pragma once

#include "back_timing.hpp"
#include "parameters.hpp"
#include "work.hpp"

namespace halfplane {

class SerialTiming : public BackTiming<AnyRun> {
 public:
  SerialTiming(const Config& config, const Widths& widths, const Stalls& stalls, MemoryTiming& memory,
               const TimingParameters& parameters, TransferSink* sink, const MemorySettings& textures)
      : BackTiming(config, widths, stalls, memory, sink, textures),
        cycles_(widths),
        slots_(config.context_slots, 0, 2),
        visits_(config.hiz_lag, 0, kVisitIsSeen),
        skid_(parameters.stamp_queue, 1, 1) {}

  // The interface is that of PipelinedTiming.

  void begin(Cycle cycle) {
    offer_ = std::max(offer_, cycle);
    begin_scene();
  }

  void take(const PrimitiveWork& primitive) {
    const Cycle offered = offer_;
    if (primitive.is_line) take_line(offered);
    const Cycle sorts = stalls_.next_free(kPrimitive, std::max(offered, cull_.room())) + 1;
    const Cycle box = sorts + SerialCycles::sort + SerialCycles::box;
    const auto product = static_cast<Cycle>(cycles_.product);
    const Cycle judged = box + product;
    Cycle culled = box;
    if (primitive.is_triangle && !primitive.is_dropped)
      culled = judged + 1 + (primitive.is_negative ? 2 + product : 0) + 3 * product;
    if (primitive.is_dropped && primitive.is_triangle) culled = judged;
    work(Stage::cull, culled - sorts);
    if (primitive.is_dropped) {
      const Cycle dropped = stream(Arrow::primitive).transfer(offered, culled);
      take_primitive(primitive, dropped);
      return;
    }
    // triangle_setup works while the triangle is on offer, and takes it when its own result has gone.
    const Cycle begins = stalls_.next_free(kPrimitive | kTriangle, std::max(culled, triangle_setup_.room()));
    const Cycle ready = begins + 1 + cycles_.setup(primitive.log2_area);
    const Cycle walks = stream(Arrow::setup).transfer(ready, std::max(coarse_.room(), slots_.room()));
    work(Stage::triangle_setup, ready - begins);
    const Cycle walker = std::max(ready, coarse_.room());
    if (slots_.room() > walker) totals_.slot_cycles += slots_.room() - walker;
    const Cycle taken = stream(Arrow::primitive).transfer(offered, walks + 1, kTriangle);
    stream(Arrow::triangle).count(culled, taken);
    take_primitive(primitive, taken);
    note(Arrow::triangle, taken);
    note(Arrow::setup, walks);
    triangle_setup_.leave(taken);
    walk_ = walks + 1 + SerialCycles::turn;
    work(Stage::coarse_raster, 1 + SerialCycles::turn);
    primitive_starts_ = true;
  }

  void clear_bounds(std::uint64_t groups) {
    const Cycle clears = std::max(walk_, last_retire_ + 1);
    totals_.bound_cycles += clears - walk_;
    walk_ = clears + groups - 1;
    work(Stage::coarse_raster, groups);
  }

  void skip_outside() {
    walk_ += 1 + SerialCycles::turn;
    work(Stage::coarse_raster, 1 + SerialCycles::turn);
  }
  void read_bound() {
    const Cycle read = std::max(walk_, visits_.room());
    totals_.bound_cycles += read - walk_;
    walk_ = read + 1;
    work(Stage::coarse_raster, 1);
    has_bound_ = true;
  }
  void skip_behind() {
    walk_ += 1 + SerialCycles::turn;
    work(Stage::coarse_raster, 1 + SerialCycles::turn);
    has_bound_ = false;
  }

  template <class Shade>
  void end_walk(Shade&& shade) {
    end(walk_ - SerialCycles::turn, shade);  // after skipping the last tile the walk turns to the next one
  }
  template <class Shade>
  void end_token(Shade&& shade) {
    end(walk_ + 1, shade);
  }

  template <class Stamps, class Shade>
  void visit(const TileVisitWork& tile, Stamps&& stamps, Shade&& shade) {
    const Cycle starts = has_bound_ ? walk_ : std::max(walk_, visits_.room());
    totals_.visit_cycles += starts - walk_;
    const Cycle offered = starts + 1;
    has_bound_ = false;
    // From the tile's first stamp to the first stamp of the box, two cycles per row on the way down; then one position
    // a cycle, and one more for a row of one stamp.
    const int waits = tile.first_column == tile.last_column ? 1 : 0;
    Cycle at = stalls_.next_free(kTile, std::max(offered, fine_.room())) + 1 +
               static_cast<Cycle>(tile.first_column + 2 * tile.first_row + waits);
    for (int row = tile.first_row; row < tile.last_row; ++row, at += static_cast<Cycle>(waits)) {
      const std::uint32_t columns = stamps.columns(row);
      for (int column = tile.first_column; column <= tile.last_column; ++column, ++at)
        if ((columns >> column & 1) != 0) at = send(at, 0, 0, [&](Cycle t) { return shade(t, true); });
    }
    const std::uint32_t columns = stamps.columns(tile.last_row);
    int held = -1;  // column of the last covered stamp of the last row so far
    for (int column = tile.first_column; column <= tile.last_column; ++column, ++at) {
      if ((columns >> column & 1) == 0) continue;
      if (held >= 0) at = send(at, 0, 0, [&](Cycle t) { return shade(t, true); });
      if (held >= 0 && column == tile.last_column) ++at;  // it waits there for the last stamp
      held = column;
    }
    --at;
    const Cycle taken = send(at, kTile, 0, [&](Cycle t) { return shade(t, held >= 0); });
    stream(Arrow::tile).count(offered, taken);
    note(Arrow::tile, taken);
    fine_.leave(taken);
    walk_ = taken + 1 + SerialCycles::turn;
    work(Stage::coarse_raster, 1 + SerialCycles::turn);
    const int row_cycles = tile.last_column - tile.first_column + 1 + waits;
    work(Stage::fine_raster, static_cast<std::uint64_t>(1 + tile.first_column + 2 * tile.first_row +
                                                        (tile.last_row - tile.first_row + 1) * row_cycles));
    if (tile.ends_primitive) coarse_.leave(taken);
    retire();
    visits_.leave(last_retire_);
  }

 private:
  static constexpr unsigned kPrimitive = stall_bit(Arrow::primitive), kTriangle = stall_bit(Arrow::triangle),
                            kTile = stall_bit(Arrow::tile), kStamp = stall_bit(Arrow::stamp);

  template <class Shade>
  void end(Cycle offered, Shade&& shade) {
    const Cycle taken = send(offered, kTile, fine_.room(), shade);
    stream(Arrow::tile).count(offered, taken);
    note(Arrow::tile, taken);
    fine_.leave(taken);
    coarse_.leave(taken);
  }

  void take_primitive(const PrimitiveWork& work, Cycle taken) {
    cull_.leave(taken);
    note(Arrow::primitive, taken);
    if (work.is_counted) count_primitive(taken);
    offer_ = taken + 1;
  }

  /// A stamp on offer from `offered` on, through interpolate and the buffer after it; it moves when `others` are free
  /// too and not before `room`. Returns the cycle in which it moves.
  template <class Shade>
  Cycle send(Cycle offered, unsigned others, Cycle room, Shade&& shade) {
    Cycle ready = std::max(room, interpolate_.room());
    if (primitive_starts_) {  // the context is read when everything before has left
      const Cycle read = stalls_.next_free(kStamp | others, std::max({offered, room, last_made_ + 1}));
      slots_.leave(read);
      ready = std::max(ready, read + 1);
    }
    primitive_starts_ = false;
    const Cycle taken = stream(Arrow::stamp).transfer(offered, ready, others);
    note(Arrow::stamp, taken);
    work(Stage::interpolate, 1);
    const Cycle made = std::max({interpolate_.ready(taken), last_made_ + 1, skid_.room()});
    interpolate_.leave(made);
    last_made_ = made;
    skid_.leave(shade(std::max(skid_.ready(made), last_fragment_ + 1)));
    return taken;
  }

  SerialCycles cycles_;
  Station cull_{1, 0, 1}, triangle_setup_{1, 0, 1}, coarse_{1, 0, 1}, fine_{1, 0, 1}, slots_, visits_;
  Station interpolate_{SerialCycles::interpolate_steps, SerialCycles::interpolate_steps, 0}, skid_;
  Cycle offer_ = 0, walk_ = 0, last_made_ = 0;
  bool primitive_starts_ = false, has_bound_ = false;
};

}  // namespace halfplane
