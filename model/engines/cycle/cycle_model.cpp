#include "cycle_model.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

#include "../../stages/color_packets.hpp"
#include "../../stages/cull.hpp"
#include "../../stages/depth_test.hpp"
#include "../../stages/hiz.hpp"
#include "../../stages/line_raster.hpp"
#include "../../packets/state_packets.hpp"
#include "../../stages/surface.hpp"
#include "../../stages/texture_stage.hpp"
#include "../../host/viewport.hpp"
#include "../hardware.hpp"
#include "../tile_kernel.hpp"
#include "pipelined_timing.hpp"
#include "sampled_stamps.hpp"
#include "serial_timing.hpp"

namespace halfplane {
namespace {

/// Whether the area is negative with the vertices as cull_serial sorts them: it swaps two and turns all three on the way.
bool is_negative_when_sorted(const std::array<SnappedVertex, 3>& v, std::int64_t area) {
  const bool swaps_first = canonically_before(v[1], v[0]);
  const bool swaps_again = canonically_before(swaps_first ? v[1] : v[0], v[2]);
  return (area < 0) != (swaps_first != swaps_again);
}

PrimitiveWork work_of(const PrimitivePacket& packet, bool is_dropped) {
  PrimitiveWork work;
  const PrimitiveKind kind = packet.kind;
  work.is_triangle = kind == PrimitiveKind::triangle;
  work.is_line = kind == PrimitiveKind::line;
  work.is_state = kind == PrimitiveKind::state;
  work.is_counted = is_counted(kind);
  work.is_dropped = is_dropped;
  if (!work.is_triangle) return work;
  const auto v = to_snapped(packet.vertex);
  const std::int64_t area = signed_area(v[0], v[1], v[2]);
  const auto size = static_cast<std::uint64_t>(area < 0 ? -area : area);
  work.is_negative = is_negative_when_sorted(v, area);
  work.log2_area = size == 0 ? 0 : static_cast<int>(std::bit_width(size - 1));
  return work;
}

/// T: tile size; Lane: as in TileKernel.
template <class Timing, int T, class Lane>
class CycleModelOf final : public CycleModel {
 public:
  CycleModelOf(const Config& config, MemoryTiming& memory, const CycleOptions& options)
      : config_(config),
        widths_(derive_widths(config)),
        options_(options),
        timing_(config_, widths_, options.stalls, memory, options.parameters, options.sink, options.textures),
        hiz_(config_, widths_, options.parameters.untested_tiles) {
    if (config_.cache_kind == CacheKind::blocks)
      blocks_.emplace(config_, widths_);
    else
      tiles_.emplace(config_, widths_);
    if (options.layout) timing_.set_layout(*options.layout);
    if (config_.compress_units != 0)
      timing_.look_at_colors([this](const StampAddress& at, SampleMask mask) {
        return SampledTarget{rendering_.frame.samples, config_, widths_}.has_one_color(at, mask);
      });
    if (has_texture_planes(config_)) texture_.emplace(texture_settings(config_, widths_), perspective_format(config_));
  }

  void hold_textures(const Scene& scene) override { texels_ = TextureMemory(scene, config_); }

  void begin(int width, int height, Cycle cycle) override {
    Framebuffer held = std::move(rendering_.frame);
    rendering_ = {};
    if (held.width == width && held.height == height) {
      rendering_.frame = std::move(held);
    } else {
      rendering_.frame = Framebuffer(width, height, T);
      fill_padding(rendering_.frame.depth, snap_depth(1.0, config_.depth_bits));  // as in an empty target
      fill_padding(rendering_.frame.color, pack_color(config_.color_format, {0, 0, 0, 255}));
      if (widths_.has_samples != 0)
        rendering_.frame.samples.assign(static_cast<std::size_t>(config_.msaa_samples), Framebuffer(rendering_.frame));
    }
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (options_.want_count) rendering_.count.resize(pixels);
    if (options_.want_ids) rendering_.ids.assign(pixels, -1);
    if (options_.want_cost) cost_.assign(pixels, 0);
    if (options_.want_misses) misses_.assign(pixels, 0);
    timing_.begin(cycle);
  }

  void run(const HostPrimitive& host) override {
    if (options_.sink != nullptr) options_.sink->primitive(host);
    if (host.packet.kind != PrimitiveKind::fast_clear || options_.parameters.fast_clear != 0) {
      send(host, host.packet);
      return;
    }
    PrimitivePacket drawn = host.packet;
    drawn.kind = PrimitiveKind::rectangle;
    drawn.state.depth_test = DepthFunc::always;
    const ColorState held = colors_;
    const StencilState held_stencil = stencil_;
    if (drawn.state.depth_write && has_stencil(config_)) {
      stencil_.side[0] = replacing_stencil(stencil_.clear_value());
      (void)set_stencil_flags(drawn.state, stencil_.side);
    }
    set_colors({});  // nobody has set them for a clear
    send(host, drawn);
    stencil_ = held_stencil;
    set_colors(held);
  }

  [[nodiscard]] const CounterPacket& counters() const override { return counters_; }
  [[nodiscard]] const TimingTotals& totals() const override { return timing_.totals(); }
  [[nodiscard]] const Stream& stream(Arrow boundary) const override { return timing_.stream(boundary); }
  [[nodiscard]] Rendering& rendering() override { return rendering_; }
  [[nodiscard]] std::vector<float>& cost() override { return cost_; }
  [[nodiscard]] std::vector<float>& misses() override { return misses_; }

 private:
  using Kernel = TileKernel<T, Lane>;
  using Mask = typename Kernel::Mask;

  /// Sends a primitive of the host's down the pipeline as `primitive`.
  void send(const HostPrimitive& host, const PrimitivePacket& primitive) {
    const auto triangle = cull(primitive, widths_, counters_, config_.setup_kind == SetupKind::pipelined);
    timing_.take(work_of(primitive, !triangle));
    if (!triangle) return;
    SetupPacket packet;  // what HiZ and the walk look at
    packet.kind = triangle->kind;
    packet.box = triangle->box;
    packet.state = triangle->state;
    switch (triangle->kind) {
      case PrimitiveKind::fast_clear: fast_clear(*triangle); return;
      case PrimitiveKind::flush: flush(packet); return;
      case PrimitiveKind::state:
        timing_.end_token([&](Cycle offered) {
          BlockItem item;
          set_state(*triangle, item.texture);
          return timing_.access(offered, TagResult{}, item);
        });
        return;
      case PrimitiveKind::line:
        hiz_.pass_line(packet);
        draw_line(packet.state, *host.line, host.primitive);
        return;
      case PrimitiveKind::triangle:
      case PrimitiveKind::rectangle:
      case PrimitiveKind::point: break;
    }
    const TriangleSetup setup = setup_primitive(*triangle, config_, widths_);
    packet.range = setup.range;
    for (std::size_t i = 0; i < 3; ++i) {
      packet.dx[i] = setup.edge[i].dx;
      packet.dy[i] = setup.edge[i].dy;
    }
    packet.coordinates = coordinates_ = triangle->coordinates;
    frame_ = texture_frame(triangle->coordinates, vertex_color(setup.range.low, widths_),
                           vertex_color(setup.range.high, widths_));
    draw(setup, packet, host.primitive);
  }

  void fast_clear(const TrianglePacket& clear) {
    const int last_x = clear.box.right >> widths_.tile_shift, last_y = clear.box.bottom >> widths_.tile_shift;
    const PerPlane<std::uint32_t>& code = clear.vertex.code[0];
    const std::array<bool, 2> planes{clear.state.depth_write, clear.state.color_write};
    if (planes[0]) {
      hiz_.clear(last_x, last_y, code[kDepthPlane]);
      if (config_.hiz_bits != 0)
        timing_.clear_bounds(static_cast<std::uint64_t>((last_x >> widths_.hiz_group_bits) + 1) *
                             static_cast<std::uint64_t>(last_y + 1));
      for (Framebuffer& frame : frames()) {
        fill(frame.depth, to_bounds(clear.box), code[kDepthPlane]);
        if (has_stencil(config_)) fill(frame.stencil, to_bounds(clear.box), stencil_.clear_value());
      }
    }
    timing_.end_token([&](Cycle offered) {
      if (blocks_) return timing_.pass_token(offered, *blocks_, true, clear.state, last_x, last_y);
      return timing_.pass_token(offered,
                                [&](auto& mover) { tiles_->fast_clear(last_x, last_y, planes, mover, counters_); });
    });
    if (planes[1])  // behind the blocks that leave the chip before it
      for (Framebuffer& frame : frames())
        fill(frame.color, to_bounds(clear.box), pack_color(config_.color_format, color_channels(code)));
    if (planes[0] || planes[1]) std::ranges::fill(rendering_.ids, -1);
  }

  /// Of each sample of a pixel.
  [[nodiscard]] std::span<Framebuffer> frames() {
    if (widths_.has_samples == 0) return {&rendering_.frame, 1};
    return rendering_.frame.samples;
  }

  /// The right ends of the rows and the rows below; the first clear fills the rest.
  void fill_padding(Framebuffer::Image& image, std::uint32_t code) const {
    const Framebuffer& frame = rendering_.frame;
    const auto row = [&](int y) { return image.begin() + static_cast<std::ptrdiff_t>(frame.at(0, y)); };
    for (int y = 0; y < frame.height; ++y) std::fill(row(y) + frame.width, row(y) + frame.stride, code);
    std::fill(row(frame.height), image.end(), code);
  }

  /// Leaves the padding alone.
  template <class Image>
  void fill(Image& image, const PixelBounds& box, typename Image::value_type code) const {
    for (int y = box.top; y <= box.bottom; ++y)
      std::fill_n(image.begin() + static_cast<std::ptrdiff_t>(rendering_.frame.at(box.left, y)),
                  box.right - box.left + 1, code);
  }

  void flush(const SetupPacket& packet) {
    const int last_x = packet.box.right >> widths_.tile_shift, last_y = packet.box.bottom >> widths_.tile_shift;
    timing_.end_token([&](Cycle offered) {
      if (blocks_) return timing_.pass_token(offered, *blocks_, false, packet.state, last_x, last_y);
      return timing_.pass_token(offered, [&](auto& mover) { tiles_->flush(last_x, last_y, mover, counters_); });
    });
  }

  void draw_line(const PrimitiveState& state, const LineSetup& line, std::uint32_t primitive) {
    const StampGrid& stamps = widths_.stamps;
    LineState next = first_state(line);
    FragmentPlace place;
    place.depth_write = state.depth_write;
    PixelFates fates;
    const auto step = [&] {
      const LinePixel pixel = pixel_of(next, line, widths_);
      const int x = pixel.x & (T - 1), y = pixel.y & (T - 1);
      place.tile_x = pixel.x / T;
      place.tile_y = pixel.y / T;
      place.stamp = stamps.stamp_at(x, y);
      place.mask =
          stamps.samples_at(x % stamps.size, y % stamps.size) & stamps.in_every_pixel(~unsigned{state.masked_samples});
      fates = shade_pixel(state, pixel, primitive, place.mask);
      if (!pixel.is_last) advance(next, line, widths_);
      return !pixel.is_last;
    };
    const auto look_up = [&](auto& mover) {
      const bool hits = tiles_->access(place.tile_x, place.tile_y, mover, counters_);
      if (fates.kept.any())
        tiles_->wrote(place.tile_x, place.tile_y, place.stamp, state.depth_write, state.color_write);
      return hits;
    };
    const auto look_up_block = [&](BlockItem& item) {
      if (!place.mask.any()) return TagResult{};  // none of its samples is drawn
      const TagResult tags = block_access(place, state, item);
      note_result(state, fates.passed, fates.kept, fates.changes, item);
      return tags;
    };
    const Cycle before = timing_.last_fragment();
    timing_.end_token([&](Cycle offered) {
      return blocks_ ? timing_.take_block_pixels(offered, step, look_up_block)
                     : timing_.take_pixels(offered, place, step, look_up);
    });
    if (!options_.want_cost) return;
    const float cycles = static_cast<float>(timing_.last_fragment() - before) / static_cast<float>(line.remaining + 1);
    line_raster(line, widths_, [&](const LinePixel& pixel) { cost_[plain_index(pixel.x, pixel.y)] += cycles; });
  }

  /// What the tags of a framebuffer of blocks find for a fragment.
  TagResult block_access(const FragmentPlace& place, const PrimitiveState& state, BlockItem& item) {
    const StampAddress at{static_cast<std::uint16_t>(place.tile_x), static_cast<std::uint16_t>(place.tile_y),
                          static_cast<std::uint16_t>(place.stamp)};
    item.mask = place.mask;
    item.stamp = block_stamp(at, widths_).stamp;
    item.depth_write = state.writes_word();
    item.color_write = state.color_write;
    item.blends = colors_.ops.blends();
    item.is_late = is_late(state, colors_.tests_alpha(), config_);
    return blocks_->access(at, state, place.mask == SampleMask::all(widths_.samples));
  }

  /// Samples of a fragment whose stored depth, or the stencil above it, the tests change, and where that is written: the alpha
  /// test may keep it from being so.
  struct Changes {
    SampleMask wanted, written;
  };
  /// The same of a pixel of a line, and the samples that passed the tests, and the alpha test too.
  struct PixelFates {
    SampleMask passed, kept;
    Changes changes;
  };

  /// What became of it: of its samples some passed the depth test, and of those the alpha test kept some.
  void note_result(const PrimitiveState& state, SampleMask passed, SampleMask kept, const Changes& changes,
                   BlockItem& item) const {
    item.wrote_depth = changes.written.any();
    if (state.color_write) item.colors = kept;
    item.is_shaded = (tests_alpha() ? passed | changes.wanted : item.colors).any();
  }
  [[nodiscard]] bool tests_alpha() const { return colors_.tests_alpha(); }

  /// depth_test and rop of a pixel of a line; `samples`: of its stamp.
  PixelFates shade_pixel(const PrimitiveState& state, const LinePixel& pixel, std::uint32_t primitive,
                         SampleMask samples) {
    PixelFates result;
    samples.for_each([&](std::size_t s) {
      const auto k = static_cast<std::uint32_t>(s) % static_cast<std::uint32_t>(widths_.pixel_samples);
      Framebuffer& frame = frames()[k];
      const std::size_t at = frame.at(pixel.x, pixel.y), plain = plain_index(pixel.x, pixel.y);
      const int sample = static_cast<int>(s);
      ++counters_.covered;
      if (!rendering_.count.empty()) ++rendering_.count[plain];
      const bool changes =
          test_sample(state, stencil_.side[0], pixel.code[kDepthPlane], stored_word(frame, at), widths_).changes;
      result.changes.wanted.set(sample, changes);
      result.changes.written.set(
          sample, changes && (!tests_alpha() || colors_.keeps(color_channels(pixel.code)[3], k,
                                                              static_cast<std::uint32_t>(widths_.pixel_samples))));
      const Fate fate = apply_fragment(FragmentOps{state, colors_.alpha, sides_of(state), colors_.ops,
                                                   colors_.alpha_covers ? widths_.pixel_samples : 0},
                                       config_.color_format, {pixel.code[kDepthPlane], pixel.x, pixel.y, false, k},
                                       [&pixel] { return color_channels(pixel.code); },
                                       {frame.depth[at], frame.color[at], frame.stencil[at]});
      if (fate == Fate::failed) return;
      result.passed.set(sample);
      ++counters_.depth_passed;
      if (fate == Fate::killed) {
        ++counters_.alpha_killed;
        return;
      }
      result.kept.set(sample);
      if (!state.writes()) return;
      ++counters_.written;
      if (k == 0 && !rendering_.ids.empty()) rendering_.ids[plain] = static_cast<std::int32_t>(primitive);
    });
    return result;
  }

  /// The stencil test of a primitive.
  [[nodiscard]] std::optional<StencilSides> sides_of(const PrimitiveState& state) const {
    return state.tests_stencil ? std::optional(stencil_.side) : std::nullopt;
  }
  /// What is stored at a pixel, as hardware has it.
  [[nodiscard]] std::uint32_t stored_word(const Framebuffer& frame, std::size_t at) const {
    return depth_word(frame.depth[at], frame.stencil[at], widths_);
  }

  [[nodiscard]] std::size_t plain_index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering_.frame.width) + static_cast<std::size_t>(x);
  }

  /// coarse_raster, and for each visit the rest of the pipeline.
  void draw(const TriangleSetup& setup, const SetupPacket& packet, std::uint32_t primitive) {
    if (widths_.has_samples != 0) {
      SampledStamps stamps(setup, packet, widths_);
      walk(setup, packet, [&](const SentTile& tile) { visit_samples(stamps, packet, tile, primitive); });
      return;
    }
    const Kernel kernel({state_of_kernel(packet.state), {}, stencil_of_kernel(packet.state), {}}, config_, widths_);
    const TriangleLanes<T, Lane> lanes(setup, widths_);
    walk(setup, packet, [&](const SentTile& tile) { visit(kernel, setup, lanes, packet, tile, primitive); });
  }

  /// A tile that coarse_raster sends on.
  struct SentTile {
    int x, y;
    PixelBounds box;   ///< what the primitive's box has of it, in pixels of it
    EdgeValues edges;  ///< at its first pixel
    bool is_inside, ends_primitive;
  };

  /// coarse_raster. Calls visit(SentTile).
  template <class Visit>
  void walk(const TriangleSetup& setup, const SetupPacket& packet, Visit&& visit) {
    CounterPacket uncounted;
    CounterPacket& count = packet.kind == PrimitiveKind::triangle ? counters_ : uncounted;
    const bool asks_hiz = hiz_.is_eligible(packet, widths_);
    TileWalk tiles(setup.left / T, setup.top / T, setup.right / T, setup.bottom / T, packet.dy);
    bool has_ended = false;
    unsigned outside = 0;
    if (asks_hiz) timing_.read_ahead();
    do {
      ++count.tiles_visited;
      const EdgeValues edges = edges_at_tile(setup, tiles.x(), tiles.y(), widths_);
      outside = outside_edges(packet.dx, packet.dy, moved_by_samples(edges, packet.dx, packet.dy, true, widths_), T);
      if (options_.parameters.rejects == 0) outside = 0;
      if (outside != 0) {
        ++count.tiles_outside;
        timing_.skip_outside();
        continue;
      }
      if (asks_hiz) {
        timing_.read_bound();
        if (hiz_.rejects(packet, tiles.x(), tiles.y())) {
          ++count.tiles_hiz;
          timing_.skip_behind();
          continue;
        }
      }
      const bool is_inside =
          classify(packet.dx, packet.dy, moved_by_samples(edges, packet.dx, packet.dy, false, widths_), T) ==
          TileClass::inside;
      const PixelBounds box = tile_box(setup, tiles.x(), tiles.y(), widths_);
      if (is_inside)
        ++count.trivially_accepted;
      else
        count.samples_tested +=
            static_cast<std::uint32_t>(box.samples()) * static_cast<std::uint32_t>(widths_.pixel_samples);
      has_ended = tiles.is_last();
      visit(SentTile{tiles.x(), tiles.y(), box, edges, is_inside, has_ended});
      if (asks_hiz && !has_ended) timing_.read_ahead();
    } while (tiles.next(outside));
    if (!has_ended) timing_.end_walk([&](Cycle offered) { return timing_.pass(offered); });
  }

  /// What the kernel writes by itself: nothing whose alpha is tested, and colours where they replace each other.
  [[nodiscard]] PrimitiveState state_of_kernel(PrimitiveState state) const {
    state.depth_write = state.depth_write && !tests_alpha();
    state.color_write = state.color_write && !tests_alpha() && colors_.ops.is_plain();
    return state;
  }

  /// Likewise.
  [[nodiscard]] std::optional<StencilSides> stencil_of_kernel(const PrimitiveState& state) const {
    std::optional<StencilSides> sides = sides_of(state);
    if (sides && tests_alpha())
      for (Stencil& side : *sides) side.write_mask = 0;
    return sides;
  }

  /// What fine_raster will have to do in it, but for the stamps.
  [[nodiscard]] TileVisitWork work_in(const SentTile& tile) const {
    const int size = config_.stamp_size;
    return {tile.ends_primitive,  tile.box.top / size,   tile.box.bottom / size,
            tile.box.left / size, tile.box.right / size, {}};
  }

  void visit(const Kernel& kernel, const TriangleSetup& setup, const TriangleLanes<T, Lane>& lanes,
             const SetupPacket& packet, const SentTile& tile, std::uint32_t primitive) {
    const int size = config_.stamp_size, tile_x = tile.x, tile_y = tile.y;
    const PixelBounds& box = tile.box;
    TileMask covered_rows{}, passed_rows{}, stencil_rows{};
    TileVisitWork work = work_in(tile);
    Mask covered_count{}, passed_count{};
    const bool wants_bits = options_.want_count || options_.want_ids;
    kernel.draw(setup, lanes, tile.edges, tile.is_inside, tile_x, tile_y, false, packet.state.is_back, rendering_.frame,
                [&](int j, const Mask& covered_lanes, const typename Kernel::Fates& fates) {
                  const Mask& passed_lanes = fates.passed;
                  const std::uint32_t row = kernel.to_bits(covered_lanes);
                  covered_rows[static_cast<std::size_t>(j)] = row;
                  passed_rows[static_cast<std::size_t>(j)] = kernel.to_bits(passed_lanes);
                  stencil_rows[static_cast<std::size_t>(j)] = kernel.to_bits(fates.passed_stencil);
                  work.columns[static_cast<std::size_t>(j / size)] |= row;  // pixels so far
                  covered_count += covered_lanes;
                  passed_count += passed_lanes;
                  if (wants_bits)
                    note_row(tile_x * T, tile_y * T + j, row, tests_alpha() ? 0 : kernel.to_bits(passed_lanes), packet,
                             primitive);
                });
    const std::uint32_t covered = kernel.count(covered_count), passed = kernel.count(passed_count);
    for (int row = work.first_row; row <= work.last_row; ++row) {
      std::uint32_t& pixels = work.columns[static_cast<std::size_t>(row)];
      std::uint32_t columns = 0;
      for (std::uint32_t left = pixels; left != 0;) {
        const int column = std::countr_zero(left) / size;
        columns |= 1U << column;
        left &= ~(((1U << size) - 1) << column * size);
      }
      pixels = columns;
    }
    std::uint32_t killed = 0;  // by the alpha test
    bool is_resident = false;
    const Cycle before = timing_.last_fragment();
    if (options_.sink != nullptr) options_.sink->visit(tile_x, tile_y);
    timing_.visit(work, [&](Cycle offered, int row, int column) {
      if (column < 0) return timing_.pass(offered);
      FragmentPlace place{tile_x, tile_y, row * widths_.stamps.stamps_per_row + column, {}, packet.state.depth_write};
      const auto samples = [&](const TileMask& rows) {
        std::uint64_t bits = 0;
        for (int j = 0; j < size; ++j)
          bits |= std::uint64_t{rows[static_cast<std::size_t>(row * size + j)] >> column * size & ((1U << size) - 1)}
                  << j * size;
        return SampleMask(bits);
      };
      place.mask = samples(covered_rows);
      const bool passes = samples(passed_rows).any();
      if (blocks_) {
        BlockItem item;
        const TagResult tags = block_access(place, packet.state, item);
        const SampleMask live = samples(passed_rows);
        Changes changes;
        changes.wanted = changed_samples(packet.state, place.mask, samples(stencil_rows), live);
        const SampleMask opaque = shade_stamp(setup, packet, place, live, changes.wanted, item, primitive),
                         kept = live & opaque;
        changes.written = changes.wanted & opaque;
        killed += static_cast<std::uint32_t>(live.count() - kept.count());
        note_result(packet.state, live, kept, changes, item);
        return timing_.access(offered, tags, item);
      }
      const Cycle moved = timing_.access(offered, place, [&](auto& mover) {
        return is_resident || ((is_resident = true), tiles_->access(tile_x, tile_y, mover, counters_));
      });
      if (passes) tiles_->wrote(tile_x, tile_y, place.stamp, packet.state.depth_write, packet.state.color_write);
      return moved;
    });
    if (is_counted(packet.kind)) {
      counters_.covered += covered;
      counters_.depth_passed += passed;
      counters_.alpha_killed += killed;
      if (packet.state.writes()) counters_.written += passed - killed;
    }
    const bool is_late = halfplane::is_late(packet.state, colors_.tests_alpha(), config_);
    retire(packet, tile_x, tile_y, is_late ? passed : passed - killed, is_late);
    if (!options_.want_cost) return;
    const auto cycles = static_cast<float>(timing_.last_fragment() - before);
    for (int j = box.top; j <= box.bottom; ++j)
      for (int i = box.left; i <= box.right; ++i)
        if (covered == 0)
          cost_[plain_index(tile_x * T + i, tile_y * T + j)] += cycles / static_cast<float>(box.samples());
        else if ((covered_rows[static_cast<std::size_t>(j)] >> i & 1) != 0)
          cost_[plain_index(tile_x * T + i, tile_y * T + j)] += cycles / static_cast<float>(covered);
  }

  /// visit() where pixels have several samples.
  void visit_samples(SampledStamps& stamps, const SetupPacket& packet, const SentTile& tile, std::uint32_t primitive) {
    TileVisitWork work = work_in(tile);
    const int per_row = widths_.stamps.stamps_per_row;
    stamps.enter(tile.x, tile.y,
                 [&](int stamp) { work.columns[static_cast<std::size_t>(stamp / per_row)] |= 1U << stamp % per_row; });
    SampledTarget target{rendering_.frame.samples, config_, widths_};
    CounterPacket count;  // of this visit
    bool is_resident = false;
    const Cycle before = timing_.last_fragment();
    if (options_.sink != nullptr) options_.sink->visit(tile.x, tile.y);
    timing_.visit(work, [&](Cycle offered, int row, int column) {
      if (column < 0) return timing_.pass(offered);
      FragmentPacket fragment = stamps.fragment(row * per_row + column);
      if (!fragment.mask.any()) return timing_.pass(offered);
      const FragmentPlace place{tile.x, tile.y, fragment.stamp, fragment.mask, packet.state.depth_write};
      WritePacket written = target.test(fragment, stencil_);
      BlockItem item;
      if (texture_) shade_pixels(target, shaded_samples(written, colors_), fragment, item);
      const SampleMask wanted = written.write_depth,
                       opaque = tests_alpha() ? opaque_samples(fragment, colors_, widths_) : fragment.mask,
                       kept = written.passed & opaque;
      keep(opaque, written);
      count.covered += static_cast<std::uint64_t>(fragment.mask.count());
      count.depth_passed += static_cast<std::uint64_t>(written.passed.count());
      count.written += static_cast<std::uint64_t>(kept.count());
      target.store(fragment, written, colors_.ops);
      note_samples(target, fragment, kept, packet, primitive);
      if (blocks_) {
        const TagResult tags = block_access(place, packet.state, item);
        note_result(packet.state, written.passed, kept, {wanted, written.write_depth}, item);
        return timing_.access(offered, tags, item);
      }
      const Cycle moved = timing_.access(offered, place, [&](auto& mover) {
        return is_resident || ((is_resident = true), tiles_->access(tile.x, tile.y, mover, counters_));
      });
      if (written.passed.any())
        tiles_->wrote(tile.x, tile.y, place.stamp, packet.state.depth_write, packet.state.color_write);
      return moved;
    });
    if (is_counted(packet.kind)) {
      counters_.covered += count.covered;
      counters_.depth_passed += count.depth_passed;
      counters_.alpha_killed += count.depth_passed - count.written;
      if (packet.state.writes()) counters_.written += count.written;
    }
    const bool is_late = halfplane::is_late(packet.state, tests_alpha(), config_);
    retire(packet, tile.x, tile.y, static_cast<std::uint32_t>(is_late ? count.depth_passed : count.written), is_late);
    if (!options_.want_cost) return;
    const PixelBounds& box = tile.box;
    const auto cycles = static_cast<float>(timing_.last_fragment() - before) / static_cast<float>(box.samples());
    for (int j = box.top; j <= box.bottom; ++j)
      for (int i = box.left; i <= box.right; ++i) cost_[plain_index(tile.x * T + i, tile.y * T + j)] += cycles;
  }

  /// The texture unit, light in front of it and fog behind it: pixels with a sample in `shaded` get their colours.
  void shade_pixels(const SampledTarget& target, SampleMask shaded, FragmentPacket& fragment, BlockItem& item) {
    const SampleMask live = widths_.stamps.pixels_of(shaded);
    if (!live.any()) return;
    const auto planes = static_cast<std::size_t>(widths_.color_planes);
    std::array<Texel, kMaxSamples> color;
    std::array<PixelOffset, kMaxSamples> at;
    live.for_each([&](std::size_t i) {
      at[i] = target.pixel(fragment, i * static_cast<std::size_t>(widths_.pixel_samples));
      color[i] = {0, 0, 0, 255};
      for (std::size_t c = 0; c < planes; ++c)
        color[i][c] = static_cast<std::uint8_t>(fragment.code[i][kColorPlane + c]);
    });
    if (frame_.divides_colors) item.texture.divided = texture_->groups(live);
    if (texture_->light().is_lit(fragment.kind == PrimitiveKind::triangle)) item.texture.lit = live.count();
    note_lookups(at, halfplane::shade_pixels(*texture_, fragment, live, widths_, color, texel_reader()), item);
    live.for_each([&](std::size_t i) {
      for (std::size_t c = 0; c < planes; ++c) fragment.code[i][kColorPlane + c] = color[i][c];
    });
  }

  /// Counts of a stamp's covered samples, and the owners of those that are stored: a pixel has that of its first.
  void note_samples(const SampledTarget& target, const FragmentPacket& fragment, SampleMask kept,
                    const SetupPacket& packet, std::uint32_t primitive) {
    const bool counts = is_counted(packet.kind);
    fragment.mask.for_each([&](std::size_t s) {
      const PixelOffset at = target.pixel(fragment, s);
      const std::size_t plain = plain_index(at.x, at.y);
      if (counts && !rendering_.count.empty()) ++rendering_.count[plain];
      if (s % static_cast<std::size_t>(widths_.pixel_samples) == 0 && kept.has(s) && !rendering_.ids.empty() &&
          (packet.state.writes() || !counts))
        rendering_.ids[plain] = counts ? static_cast<std::int32_t>(primitive) : -1;
    });
  }

  /// The covered samples of a stamp whose stored word the tests change.
  [[nodiscard]] SampleMask changed_samples(const PrimitiveState& state, SampleMask covered, SampleMask passed_stencil,
                                           SampleMask passed) const {
    SampleMask changed = state.depth_write ? passed : SampleMask();
    const Stencil& side = stencil_.side[state.is_back ? 1 : 0];
    if (state.tests_stencil && side.write_mask != 0)
      covered.for_each([&](std::size_t s) {
        // One that passes the stencil test and not both fails the depth test.
        if (stencil_op(side, passed_stencil.has(s), passed.has(s)) != StencilOp::keep) changed.set(static_cast<int>(s));
      });
    return changed;
  }

  /// What comes behind the depth test for a stamp, `passed` of whose samples passed, and `changed`: texture unit, alpha test,
  /// operations on colours; what the kernel did not write is. Returns samples of which the alpha test drops none, and all of
  /// those if they passed or changed.
  SampleMask shade_stamp(const TriangleSetup& setup, const SetupPacket& packet, const FragmentPlace& place,
                         SampleMask passed, SampleMask changed, BlockItem& item, std::uint32_t primitive) {
    const SampleMask live = tests_alpha() ? passed | changed : packet.state.color_write ? passed : SampleMask();
    const bool is_textured = texture_ && texture_->is_textured(packet.kind == PrimitiveKind::triangle, live);
    const SampleMask all = SampleMask::all(widths_.samples);
    const bool is_fogged =
        texture_ && texture_->fog().is_fogged(packet.kind == PrimitiveKind::triangle) && packet.state.color_write;
    const bool divides = frame_.divides_colors && live.any();
    const bool is_lit = texture_ && texture_->light().is_lit(packet.kind == PrimitiveKind::triangle);
    if (!live.any() || !(is_textured || divides || is_fogged || is_lit || tests_alpha() || !colors_.ops.is_plain()))
      return all;
    std::array<Texel, kMaxSamples> color{};
    std::array<PixelOffset, kMaxSamples> at;  // pixels of the target
    const PixelOffset origin = widths_.stamps.origin_of(place.stamp);
    live.for_each([&](std::size_t s) {
      const PixelOffset pixel = widths_.stamps.pixel_of(static_cast<int>(s));
      at[s] = {place.tile_x * T + origin.x + pixel.x, place.tile_y * T + origin.y + pixel.y};
      for (std::size_t c = 0; c < static_cast<std::size_t>(widths_.color_planes); ++c)
        color[s][c] = static_cast<std::uint8_t>(plane_at(setup, kColorPlane + c, widths_, at[s].x, at[s].y).code);
    });
    std::array<TextureSample, kMaxSamples> sample;
    if (is_textured || divides || is_lit) set_samples(setup, live, at, sample);
    if (divides) {
      item.texture.divided = texture_->groups(live);
      live.for_each([&](std::size_t s) { texture_->divide_colors(sample[s], frame_, widths_.color_planes, color[s]); });
    }
    if (is_lit) {
      item.texture.lit = live.count();
      live.for_each([&](std::size_t s) { texture_->light().add(sample[s].normal, color[s]); });
    }
    if (is_textured) look_up_texels(live, at, sample, color, item);
    if (is_fogged)
      live.for_each(
          [&](std::size_t s) { texture_->fog().add(q_at_pixel(setup, at[s]), coordinates_.fog_octave, color[s]); });
    Framebuffer& frame = rendering_.frame;
    const auto index = [&](std::size_t s) { return frame.at(at[s].x, at[s].y); };
    const SampleMask kept =
        alpha_passes(colors_, live, widths_, [&](std::size_t s) { return std::uint32_t{color[s][3]}; });
    kept.for_each([&](std::size_t s) {
      const Texel& c = color[s];
      if (tests_alpha() && changed.has(s)) change_word(setup, packet.state, at[s]);
      if (!passed.has(s)) return;
      if (packet.state.color_write)
        frame.color[index(s)] = store_color<std::uint32_t>(colors_.ops, config_.color_format, {c[0], c[1], c[2], c[3]},
                                                           frame.color[index(s)], dither_threshold(at[s].x, at[s].y));
      if (tests_alpha() && !rendering_.ids.empty() && packet.state.writes())
        rendering_.ids[plain_index(at[s].x, at[s].y)] =
            is_counted(packet.kind) ? static_cast<std::int32_t>(primitive) : -1;
    });
    return tests_alpha() ? kept : all;
  }

  /// A pixel's depth and stencil, as the tests leave them.
  void change_word(const TriangleSetup& setup, const PrimitiveState& state, const PixelOffset& at) {
    Framebuffer& frame = rendering_.frame;
    const std::size_t pixel = frame.at(at.x, at.y);
    const std::uint32_t depth = plane_at(setup, kDepthPlane, widths_, at.x, at.y).code;
    const std::uint32_t word =
        test_sample(state, stencil_.side[state.is_back ? 1 : 0], depth, stored_word(frame, pixel), widths_).word;
    frame.depth[pixel] = depth_of(word, widths_);
    frame.stencil[pixel] = stencil_of(word, widths_);
  }

  [[nodiscard]] std::uint64_t q_at_pixel(const TriangleSetup& setup, const PixelOffset& at) const {
    return q_at(setup.plane[widths_.q_plane], place_of(setup, widths_, at.x, at.y), perspective_, widths_);
  }

  /// What the texture unit gets of the samples of a stamp that live.
  void set_samples(const TriangleSetup& setup, SampleMask live, const std::array<PixelOffset, kMaxSamples>& at,
                   std::array<TextureSample, kMaxSamples>& sample) const {
    const std::size_t q = widths_.q_plane, red = widths_.color_over_w_plane();
    live.for_each([&](std::size_t s) {
      sample[s].x = at[s].x;
      sample[s].y = at[s].y;
      const PixelPlace where = place_of(setup, widths_, at[s].x, at[s].y);
      sample[s].q = q_at(setup.plane[q], where, perspective_, widths_);
      for (const std::size_t i : {0U, 1U})
        sample[s].p[i] = p_at(setup.plane[q + 1 + i], where, perspective_.coordinate, perspective_, widths_);
      for (std::size_t c = 0; c < static_cast<std::size_t>(widths_.colors_over_w); ++c)
        sample[s].color_p[c] = p_at(setup.plane[red + c], where, perspective_.color, perspective_, widths_);
      for (std::size_t c = 0; c < static_cast<std::size_t>(widths_.normals); ++c)
        sample[s].normal[c] =
            p_at(setup.plane[widths_.normal_plane() + c], where, normal_format(perspective_), perspective_, widths_);
    });
  }

  /// The texture unit: the colours of those samples, and how they were looked up.
  void look_up_texels(SampleMask live, const std::array<PixelOffset, kMaxSamples>& at,
                      const std::array<TextureSample, kMaxSamples>& sample, std::array<Texel, kMaxSamples>& color,
                      BlockItem& item) {
    if (widths_.color_planes == 3) live.for_each([&](std::size_t s) { color[s][3] = 255; });
    note_lookups(at, texture_->take(live, sample, frame_, color, texel_reader()), item);
  }

  /// Gives the texture unit its lines of texels.
  [[nodiscard]] auto texel_reader() {
    return [this](std::uint32_t address, int) {
      TextureLine line;
      texels_.read(address, line);
      return line;
    };
  }

  void note_lookups(const std::array<PixelOffset, kMaxSamples>& at, std::span<const TextureLookup> lookups,
                    BlockItem& item) {
    item.texture.lookups = lookups;
    count(use_of(lookups), counters_);
    if (options_.want_misses) note_misses(at, lookups);
  }

  /// Which pixels the lines are of that were asked for.
  void note_misses(const std::array<PixelOffset, kMaxSamples>& at, std::span<const TextureLookup> lookups) {
    for (const TextureLookup& lookup : lookups)
      if (lookup.is_miss) misses_[plain_index(at[lookup.sample].x, at[lookup.sample].y)] += 1.0F;
  }

  /// What a token sets, here and in the tags; `texture`: what that is to the texture unit.
  void set_state(const TrianglePacket& token, TextureWork& texture) {
    const StateRegister which = state_register(token.state);
    if (is_of_texture(which)) {
      set_register(*texture_, which, token.vertex.code[2], widths_);  // what a lane of states leaves
      const LevelsWord beside = word_beside_texture(which, token.vertex.code[2], widths_);
      texture.sets_light = beside == LevelsWord::light;
      if (beside != LevelsWord::levels) return;
      texture.sets = which;
      texture.invalidates = which == StateRegister::texture && texture_->state().invalidates;
      return;
    }
    stencil_.set(which, state_word(token.vertex.code[2], widths_));
    ColorState colors = colors_;
    colors.set(which, state_word(token.vertex.code[2], widths_));
    set_colors(colors);
  }

  void set_colors(const ColorState& colors) {
    colors_ = colors;
    if (blocks_) blocks_->set(colors_.ops.reads_stored(), tests_alpha(), stencil_.replaces());
  }

  /// The news of a visit for HiZ.
  void retire(const SetupPacket& packet, int tile_x, int tile_y, std::uint32_t passed, bool is_late) {
    if (config_.hiz_bits == 0) return;
    hiz_.begin_visit(packet.state);
    RetirePacket retired;
    retired.key.tile_x = static_cast<std::uint16_t>(tile_x);
    retired.key.tile_y = static_cast<std::uint16_t>(tile_y);
    const bool is_full =
        packet.state.depth_write && passed == static_cast<std::uint32_t>(T * T * widths_.pixel_samples) && !is_late;
    std::uint32_t largest = 0;
    if (is_full)  // the codes of a covered tile are a plane, rounded and clamped: the largest is at a corner
      for (const int y : {0, T - 1})
        for (const int x : {0, T - 1})
          for (const Framebuffer& frame : frames())
            largest = std::max(largest, frame.depth[frame.at(tile_x * T + x, tile_y * T + y)]);
    set_hiz_update(retired, packet.state, is_full, passed != 0, largest, config_, widths_);
    hiz_.retire(retired);
  }

  /// Counts and owners of a row that begins at pixel (x, y).
  void note_row(int x, int y, std::uint32_t covered, std::uint32_t passed, const SetupPacket& packet,
                std::uint32_t primitive) {
    const std::size_t first = plain_index(x, y);
    const auto for_each = [first](std::uint32_t bits, auto&& visit) {
      for (; bits != 0; bits &= bits - 1) visit(first + static_cast<std::size_t>(std::countr_zero(bits)));
    };
    if (!is_counted(packet.kind)) {  // a clear inside the scissor: nobody owns its pixels
      if (!rendering_.ids.empty()) for_each(passed, [&](std::size_t pixel) { rendering_.ids[pixel] = -1; });
      return;
    }
    if (!rendering_.count.empty()) for_each(covered, [&](std::size_t pixel) { ++rendering_.count[pixel]; });
    if (!rendering_.ids.empty() && packet.state.writes())
      for_each(passed, [&](std::size_t pixel) { rendering_.ids[pixel] = static_cast<std::int32_t>(primitive); });
  }

  Config config_;
  Widths widths_;
  CycleOptions options_;
  Timing timing_;
  CounterPacket counters_;
  Hiz hiz_;
  std::optional<TileDirectory> tiles_;  ///< one of them, by cache.kind
  std::optional<CacheTags> blocks_;
  std::optional<TextureUnit> texture_;
  ColorState colors_;
  StencilState stencil_;
  PerspectiveFormat perspective_ = perspective_format(config_);
  CoordinateFrame coordinates_;  ///< of the triangle at work
  TextureFrame frame_;           ///< of it too
  TextureMemory texels_;
  Rendering rendering_;
  std::vector<float> cost_, misses_;
};

// Lanes of 64 bits do for every configuration; only the usual tile size of pipelined hardware has the faster 32 too.
template <class Timing>
std::unique_ptr<CycleModel> make(const Config& config, MemoryTiming& memory, const CycleOptions& options) {
  switch (config.tile_size) {
    case 4: return std::make_unique<CycleModelOf<Timing, 4, std::uint64_t>>(config, memory, options);
    case 8: break;
    case 16: return std::make_unique<CycleModelOf<Timing, 16, std::uint64_t>>(config, memory, options);
    default: return std::make_unique<CycleModelOf<Timing, 32, std::uint64_t>>(config, memory, options);
  }
  if constexpr (std::is_same_v<Timing, PipelinedTiming>)
    if (derive_widths(config).depth().local.bits <= 32)
      return std::make_unique<CycleModelOf<Timing, 8, std::uint32_t>>(config, memory, options);
  return std::make_unique<CycleModelOf<Timing, 8, std::uint64_t>>(config, memory, options);
}

}  // namespace

std::unique_ptr<CycleModel> make_cycle_model(const Config& config, MemoryTiming& memory, const CycleOptions& options) {
  validate(config);
  validate(options.parameters, config);
  return config.setup_kind == SetupKind::pipelined ? make<PipelinedTiming>(config, memory, options)
                                                   : make<SerialTiming>(config, memory, options);
}

}  // namespace halfplane
