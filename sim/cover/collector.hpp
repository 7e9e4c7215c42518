// Collects coverage: runs scenes through a hardware model of its own, in the order and with the memory of a run, and counts
// the bins that they hit. Nothing of it exists unless --coverage is given.
#pragma once

#include <array>
#include <memory>

#include "model/config.hpp"
#include "model/pipeline_graph.hpp"
#include "model/scene.hpp"
#include "model/timing/stream.hpp"
#include "sim/cover/hits.hpp"

namespace halfplane::cover {

/// A run.
class Collector {
 public:
  explicit Collector(const Config& config);
  ~Collector();
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;

  /// One scene after the others, sent as `host` says, which may differ from the configuration in frame.order and
  /// frame.store. Throws InputError for a scene that the hardware does not support.
  void run(const Scene& scene, const Config& host);
  /// Cycles of the RTL's streams.
  void add(const std::array<StreamUse, kStreams.size()>& use);
  /// Counts packets that no scene of run() made, in the order of a pipeline.
  [[nodiscard]] PacketSink& packets();

  [[nodiscard]] const Hits& hits() const;

 private:
  struct Run;
  std::unique_ptr<Run> run_;
};

}  // namespace halfplane::cover
