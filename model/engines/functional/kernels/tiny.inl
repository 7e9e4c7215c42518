// Tiny triangles, within two by two pixels: culling has found which of the four pixel centres (samples) they cover.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "layers.inl"
#include "small_batch.inl"
#include "small_setup.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Format of written colours; for surfaces numbers are written. laid_over: part of has_operations.
enum class Writes { nothing, rgba8888, other, surface, laid_over, operated };

/// The samples of triangles with few samples, in rounds: one sample of each triangle per round.
struct SampleRounds {
  static constexpr std::size_t kMost = 4;
  std::size_t count = 0;
  alignas(64) std::array<SmallBatch::Lane, kMost> to_x, to_y;   ///< FromOrigin of its tile's anchor
  alignas(64) std::array<SmallBatch::Lane, kMost> column, row;  ///< relative to it, in both halves
  alignas(64) std::array<SmallBatch::Lane, kMost> place, depth, color;

  [[nodiscard]] HALFPLANE_INLINE FromOrigin to(std::size_t round) const {
    return {I16::load(to_x[round].data()), I16::load(to_y[round].data())};
  }
};

/// Finds the places of the samples. As many rounds as the largest number of samples; a lane without a sample left gets
/// any place.
HALFPLANE_INLINE void find_samples(const Bin& bin, const SmallCorners& corners, SampleRounds& rounds) {
  const SmallBatch& batch = bin.small;
  const I16 left = I16::load(batch.left.data()), top = I16::load(batch.top.data());
  I16 rest = I16::load(batch.samples.data());
  for (rounds.count = 0; is_any(rest != 0); ++rounds.count) {
    const I16 sample = rest & -rest, is_last = shift_right_logical(sample, 3);  // 1 2 / 4 8
    rest &= rest - 1;
    const I16 x = left + ((shift_right_logical(sample, 1) & 1) | is_last),
              y = top + ((shift_right_logical(sample, 2) & 1) | is_last);
    const FromOrigin to = anchor_from_origin(corners, x, y, bin.widths.grid_bits, bin.first_x, bin.first_y);
    const I16 column = (x & (kTileSize - 1)) - kTileSize / 2, row = (y & (kTileSize - 1)) - kTileSize / 2;
    const std::size_t r = rounds.count;
    to.x.store(rounds.to_x[r].data());
    to.y.store(rounds.to_y[r].data());
    pairs(column, column).store(rounds.column[r].data());
    pairs(row, row).store(rounds.row[r].data());
    place_of(x, y).store(rounds.place[r].data());
  }
}

template <class Arithmetic>
HALFPLANE_INLINE void sample_depths(const Bin& bin, const SmallPlanes<Arithmetic>& planes, SampleRounds& rounds) {
  const LaneFormat& format = bin.depth_format;
  const auto [x, y] = planes.depth_gradients(format);
  const I16 step_x = local_step(x, format), step_y = local_step(y, format);
  const I16 &low = planes.corners.z_low, &high = planes.corners.z_high;
  for (std::size_t r = 0; r < rounds.count; ++r) {
    const I16 anchor =
        narrowed(plane_at(rounds.to(r), bin.widths.plane_fraction, planes.corners.origin.z, x, y, format), format);
    const I16 column = I16::load(rounds.column[r].data()) >> 16, row = I16::load(rounds.row[r].data()) >> 16;
    decode(column * step_x + row * step_y + anchor, format, low, high).store(rounds.depth[r].data());
  }
}

/// A channel: half of a lane.
template <class Step>
struct SampleChannel {
  I16 at_origin;
  Step x, y;
  I16 step_x, step_y;
};

/// Writes two channels of each round, centred, to `value`.
template <class Arithmetic>
HALFPLANE_INLINE void sample_pair(const Bin& bin, const SmallPlanes<Arithmetic>& planes, std::size_t pair,
                                  const SampleRounds& rounds,
                                  std::array<SmallBatch::Lane, SampleRounds::kMost>& value) {
  const LaneFormat& format = bin.centred_color;
  const PairCodes codes(planes.corners, pair, bin.state.is_flat);
  const auto gradient = planes.color();
  const auto channel = [&](std::size_t half) HALFPLANE_LAMBDA {
    const auto of_half = [half](const I16& both) HALFPLANE_LAMBDA { return PairCodes::of_half(both, half); };
    const auto [x, y] = channel_gradients(planes.corners, gradient, codes, half);
    using Step = std::remove_const_t<decltype(x)>;
    return SampleChannel<Step>{of_half(codes.at_origin), x, y, local_step(x, format), local_step(y, format)};
  };
  const auto first = channel(0), second = channel(1);
  const auto step_x = as<S32>(pairs(first.step_x, second.step_x)), step_y = as<S32>(pairs(first.step_y, second.step_y));
  for (std::size_t r = 0; r < rounds.count; ++r) {
    const auto anchor = [&](const auto& half) HALFPLANE_LAMBDA {
      return narrowed(plane_at(rounds.to(r), bin.widths.plane_fraction, half.at_origin, half.x, half.y, format),
                      format);
    };
    const S32 at = S32::load(rounds.column[r].data()) * step_x + S32::load(rounds.row[r].data()) * step_y +
                   as<S32>(pairs(anchor(first), anchor(second)));
    (at >> format.down).store(value[r].data());
  }
}

/// Depths and colours of the samples of a batch, from the planes at the anchors of their tiles.
template <class Arithmetic>
HALFPLANE_NOINLINE void set_up_samples(Bin& bin, const Slice& slice, SampleRounds& rounds) {
  const SmallCorners corners = small_corners(bin.small.corner, bin.small.live, slice);
  const SmallPlanes<Arithmetic> planes(corners, bin.widths);
  find_samples(bin, corners, rounds);
  sample_depths(bin, planes, rounds);
  if (!bin.state.color_write || bin.state.has_surface) return;
  alignas(64) std::array<SmallBatch::Lane, SampleRounds::kMost> red_green, blue_alpha;
  sample_pair(bin, planes, 0, rounds, red_green);
  sample_pair(bin, planes, 1, rounds, blue_alpha);
  const ColorRange range(corners, bin.state.is_flat);
  for (std::size_t r = 0; r < rounds.count; ++r) {
    const B64 channels = turns_of_halves(saturated(S32::load(red_green[r].data()), S32::load(blue_alpha[r].data())));
    const I16 rgba = ColorRange::clamped(channels, range.low, range.high);
    packed_at(I16::load(rounds.place[r].data()), rgba, bin.packing).store(rounds.color[r].data());
  }
}

/// Draws triangles whose few samples are known: sample by sample, in order. The state says which buffers are written.
template <class Fragments, bool kDepth, Writes kColor, class Depth>
HALFPLANE_INLINE void draw_samples(Bin& bin, const SampleRounds& rounds, Depth* depths) {
  const SliceState state = bin.state;
  std::uint32_t* const colors = bin.memory.color.data();
  std::uint16_t* const surfaces = bin.memory.surface.data();
  const std::int32_t first_surface = bin.batch_surface;
  unsigned covered_pixels = 0, passed_pixels = 0;
  for (std::uint32_t lanes = bin.small.live; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
    const auto samples = static_cast<unsigned>(bin.small.samples[i]);
    std::size_t round = 0;
    for (unsigned rest = samples; rest != 0; rest &= rest - 1, ++round) {
      const auto at = static_cast<std::uint32_t>(rounds.place[round][i]);
      const std::int32_t depth = rounds.depth[round][i], stored = depths[at];
      // A failing sample stores the old value: a branch would be mispredicted.
      const bool passed = Fragments::passes_one(state, depth, stored);
      passed_pixels += passed ? 1 : 0;
      if (kDepth) depths[at] = static_cast<Depth>(passed ? depth : stored);
      if (kColor == Writes::surface && passed)
        surfaces[at] = static_cast<std::uint16_t>(first_surface + static_cast<std::int32_t>(i));
      if (kColor == Writes::other) {
        const std::uint32_t color = static_cast<std::uint32_t>(rounds.color[round][i]), old = colors[at];
        colors[at] = passed ? color : old;
      }
    }
    covered_pixels += static_cast<unsigned>(round);
  }
  bin.job.counters.samples_tested += std::uint64_t{4} * static_cast<unsigned>(std::popcount(bin.small.live));
  count_fragments(bin, covered_pixels, passed_pixels);
}
template <class Fragments, class Depth>
HALFPLANE_INLINE void draw_samples(Bin& bin, const SampleRounds& rounds, Depth* depths) {
  const bool has_depth = bin.state.depth_write, has_color = bin.state.color_write;
  if (bin.sees_surfaces())
    return has_depth ? draw_samples<Fragments, true, Writes::surface>(bin, rounds, depths)
                     : draw_samples<Fragments, false, Writes::surface>(bin, rounds, depths);
  if (has_depth && has_color) return draw_samples<Fragments, true, Writes::other>(bin, rounds, depths);
  if (has_depth) return draw_samples<Fragments, true, Writes::nothing>(bin, rounds, depths);
  has_color ? draw_samples<Fragments, false, Writes::other>(bin, rounds, depths)
            : draw_samples<Fragments, false, Writes::nothing>(bin, rounds, depths);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
