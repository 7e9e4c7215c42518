// Shared by the tests of the hardware model: a configuration in one line, and a sink that records.
#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "model/engines/hardware.hpp"
#include "model/host/primitive_stream.hpp"

namespace halfplane::test {

/// A preset with some settings changed.
inline Config with(const char* preset_name, std::initializer_list<std::pair<const char*, const char*>> settings) {
  Config config = preset(preset_name);
  for (const auto& [key, value] : settings) set(config, key, value);
  validate(config);
  return config;
}

/// Records the packets that the tests check.
struct Recorder : PacketSink {
  using PacketSink::take;
  void take(On<Arrow::tile>, const TilePacket& packet) override { tiles.push_back(packet); }
  void take(On<Arrow::stamp>, const StampPacket& packet) override { stamps.push_back(packet); }
  void take(On<Arrow::retire>, const RetirePacket& packet) override { retired.push_back(packet); }
  void take(On<Arrow::request>, const MemoryRequest& packet) override { requests.push_back(packet); }
  void take(On<Arrow::beat>, const MemoryBeat& packet) override { beats.push_back(packet); }
  std::vector<TilePacket> tiles;
  std::vector<StampPacket> stamps;
  std::vector<RetirePacket> retired;
  std::vector<MemoryRequest> requests;
  std::vector<MemoryBeat> beats;
};

/// The whole scene through the model; its counters.
inline CounterPacket run_scene(const Scene& scene, const Config& config, PacketSink& sink) {
  HostStream host(scene, config);
  HardwareModel hardware(config, sink);
  while (const auto primitive = host.next()) hardware.run(primitive->packet, primitive->line);
  return hardware.counters();
}

}  // namespace halfplane::test
