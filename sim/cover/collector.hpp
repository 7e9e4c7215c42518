// Collects coverage: runs scenes through a hardware model of its own, in the order and with the memory of a run, and counts
// the bins that they hit. Nothing of it exists unless --coverage is given.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "model/engines/hardware.hpp"
#include "model/engines/hardware_watch.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/hiz.hpp"
#include "model/timing/stream.hpp"
#include "sim/cover/bins.hpp"
#include "sim/cover/state_pairs.hpp"

namespace halfplane::cover {

/// Hits of all bins, in their order, and of pairs of states.
struct Hits {
  std::vector<std::uint64_t> bins = std::vector<std::uint64_t>(cover::bins().size());
  PairCounts pairs{all_dimensions()};

  /// The table of dimensions(), once.
  [[nodiscard]] static const std::vector<Dimension>& all_dimensions();
};

/// Sees packets, in the order of a pipeline.
class PacketCoverage : public PacketSink, public HardwareWatch {
 public:
  explicit PacketCoverage(const Config& config);
  PacketCoverage(const PacketCoverage&) = delete;
  PacketCoverage& operator=(const PacketCoverage&) = delete;

  void take(On<Arrow::primitive>, const PrimitivePacket& packet) override;
  void take(On<Arrow::line>, const LineSetup& packet) override;
  void take(On<Arrow::triangle>, const TrianglePacket& packet) override;
  void take(On<Arrow::setup>, const SetupPacket& packet) override;
  void take(On<Arrow::tile>, const TilePacket& packet) override;
  void take(On<Arrow::edges>, const EdgeContext& packet) override;
  void take(On<Arrow::stamp>, const StampPacket& packet) override;
  void take(On<Arrow::retire>, const RetirePacket& packet) override;
  void take(On<Arrow::request>, const MemoryRequest& packet) override;
  void take(On<Arrow::texture>, const TextureRequest& packet) override;
  using PacketSink::take;

  void looked_up(const FragmentPacket& fragment, const TagResult& tags) override;
  void meets(const FragmentPacket& fragment, std::span<const std::uint32_t> stored, const StencilState& state) override;
  void shaded(const FragmentPacket& fragment, const StampFate& fate, const ColorState& colors) override;

  [[nodiscard]] const Hits& hits() const { return hits_; }

 protected:
  void see(Event event);

  Config config_;
  Widths widths_;
  Hits hits_;
  Seen seen_;

 private:
  struct Rule {
    std::uint64_t (*hits)(const Seen&);
    std::size_t first;  ///< bin of member 0
  };

  std::array<std::vector<Rule>, kEvents> rules_;
  PrimitivePacket primitive_;
  TrianglePacket triangle_;
  SetupPacket setup_;
  TilePacket tile_;
  std::array<bool, 3> may_tie_{}, is_top_left_{};  ///< by edge of the triangle: a pixel centre may lie on it
  bool has_triangle_ = false, has_setup_ = false;  ///< of the same primitive as the tiles
  Hiz hiz_, newest_;  ///< with the configured lag, and without one; the second does not know of lines
  int since_raise_;   ///< visits since one that may raise a depth
  FragmentPacket last_;
  bool has_last_ = false, has_stored_ = true;
  std::vector<BlockAddress> victims_;  ///< oldest first
};

/// A run.
class Collector final : public PacketCoverage {
 public:
  explicit Collector(const Config& config);

  /// One scene after the others, sent as `host` says, which may differ from the configuration in frame.order and
  /// frame.store. Throws InputError for a scene that the hardware does not support.
  void run(const Scene& scene, const Config& host);
  /// Cycles of the RTL's streams.
  void add(const std::array<StreamUse, kStreams.size()>& use);

 private:
  HardwareModel model_;
  BinContents held_;
  CounterPacket counted_;
};

}  // namespace halfplane::cover
