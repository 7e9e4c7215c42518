// The real range of the pipeline's intermediates. The stages run on one primitive at a time, and the smallest and the
// largest value of every width are recorded.
//
// Packet fields are read from the packet. Values inside a stage (products, numerators, a line's positions) are computed
// again in 128 bits, and compared with the stage's output.
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

/// A primitive after the snap: the test input for widths. The scissor is the whole target of the configuration.
struct Probe {
  bool is_line = false;
  LineRule rule = LineRule::diamond;  ///< of a line
  std::array<SnappedVertex, 3> v{};   ///< a line uses the first two
  bool operator==(const Probe&) const = default;
};

/// The values of one width so far. For a modular width: the values decoded from the residues at covered samples.
struct Seen {
  std::uint64_t count = 0;
  int128 lo = 0, hi = 0;  ///< meaningless while count is 0

  void add(int128 value) {
    if (count == 0 || value < lo) lo = value;
    if (count == 0 || value > hi) hi = value;
    ++count;
  }
};

/// The range of the values of `width`, a member of `widths`: Width::range; for a modular plane, the codes at covered
/// samples with the derived error on both sides, in units of its last fraction bit.
[[nodiscard]] Interval value_range(const Width& width, const Widths& widths, const Config& config);

/// Runs the stages and records the values.
class WidthObserver {
 public:
  explicit WidthObserver(const Config& config);
  WidthObserver(const WidthObserver&) = delete;  // widths are identified by their addresses
  WidthObserver& operator=(const WidthObserver&) = delete;

  /// Runs the primitive through every stage up to its fragments. For a triangle, visits the tiles at the corners of its
  /// box, at its vertices and along its edges: values are linear, so extremes lie there. For a line, its first 256
  /// pixels and its last. Throws std::logic_error when an intermediate differs from its stage's.
  void observe(const Probe& probe);
  /// Forgets all recorded values.
  void clear();

  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] const Widths& widths() const { return widths_; }
  /// In the order of Widths::all().
  [[nodiscard]] std::span<const Seen> seen() const { return seen_; }
  /// For a member of widths().
  [[nodiscard]] const Seen& seen(const Width& width) const { return seen_[place_of(width)]; }
  /// Whether that width of all() is observed. Not if the range counts states, slots or numbers that wrap: such a width
  /// is exact by construction.
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
