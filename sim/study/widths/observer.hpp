// What the intermediates of the pipeline really hold. The stages are run on one primitive at a time, and the smallest and
// the largest value of every width are kept.
//
// Whatever a packet carries is read from the packet. What stays inside a stage (products, numerators, a line's
// positions) is computed a second time in 128 bits, and held against what the stage hands on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "model/host/line_setup.hpp"
#include "model/packets/packet_words.hpp"
#include "model/scene.hpp"
#include "model/widths.hpp"

namespace halfplane {

/// A primitive after the snap: what the widths are tried with. The scissor is the whole target of the configuration.
struct Probe {
  bool is_line = false;
  LineRule rule = LineRule::diamond;  ///< of a line
  std::array<SnappedVertex, 3> v{};   ///< a line uses the first two
  bool operator==(const Probe&) const = default;
};

/// The values of one width so far. Of a modular one: the values read back from the residues at covered samples.
struct Seen {
  std::uint64_t count = 0;
  int128 lo = 0, hi = 0;  ///< meaningless while count is 0

  void add(int128 value) {
    if (count == 0 || value < lo) lo = value;
    if (count == 0 || value > hi) hi = value;
    ++count;
  }
};

/// The range that the values of `width`, a member of `widths`, lie in: Width::range; of a modular plane, the codes at
/// covered samples with the derived error on both sides, in units of its last fraction bit.
[[nodiscard]] Interval value_range(const Width& width, const Widths& widths, const Config& config);

/// Runs the stages and keeps what it sees.
class WidthObserver {
 public:
  explicit WidthObserver(const Config& config);
  WidthObserver(const WidthObserver&) = delete;  // the widths are known by their addresses
  WidthObserver& operator=(const WidthObserver&) = delete;

  /// Runs the primitive through every stage up to its fragments. Of a triangle, the tiles at the corners of its box, at
  /// its vertices and along its edges are visited: values are linear, so extremes lie there. Of a line, its first 256
  /// pixels and its last. Throws std::logic_error when an intermediate is not what its stage made of it.
  void observe(const Probe& probe);
  /// Forgets all that was seen.
  void clear();

  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] const Widths& widths() const { return widths_; }
  /// In the order of Widths::all().
  [[nodiscard]] std::span<const Seen> seen() const { return seen_; }
  /// Of a member of widths().
  [[nodiscard]] const Seen& seen(const Width& width) const { return seen_[place_of(width)]; }
  /// Whether it looks at that width of all(). It does not where the range counts states, slots or numbers that wrap: such
  /// a width is exact by construction.
  [[nodiscard]] bool is_observed(std::size_t place) const { return is_observed_[place]; }

 private:
  [[nodiscard]] std::size_t place_of(const Width& width) const;  // in all()
  void see(const Width& width, int128 value);
  template <class Packet>
  void see_packet(const Packet& packet);

  struct TriangleStages;  // one triangle's packets
  void observe_triangle(const std::array<SnappedVertex, 3>& v);
  void observe_area(const std::array<SnappedVertex, 3>& v);
  void observe_edges(const TrianglePacket& packet);
  void observe_planes(const TriangleStages& stages);
  void observe_tile(const TriangleStages& stages, int tile_x, int tile_y);
  void observe_stamp(const TriangleStages& stages, const StampPacket& stamp);
  void observe_sample(const TriangleStages& stages, const FragmentPacket& fragment, std::size_t sample);
  void observe_line(const Probe& probe);
  void observe_positions(const Probe& probe, const LineSetup& line, bool is_whole);
  void observe_attributes(const Probe& probe, const LineSetup& line);
  void observe_pixels(const LineSetup& line);

  Config config_;
  Widths widths_;
  PixelBounds target_;
  std::vector<const Width*> all_;
  std::vector<std::pair<const Width*, std::size_t>> place_;  ///< in all_, by address
  std::vector<bool> is_observed_;
  std::vector<Seen> seen_;
};

}  // namespace halfplane
