#include "record.hpp"

#include <stdexcept>

#include "model/engines/hardware.hpp"
#include "model/packets/packet_words.hpp"
#include "model/stages/color_packets.hpp"
#include "model/stages/interpolate.hpp"

namespace halfplane::vectors {
namespace {

class StageRecorder final : public EveryPacket<StageRecorder> {
 public:
  StageRecorder(const JudgedStage& stage, const Widths& widths, StagePackets& packets)
      : stage_(stage), widths_(widths), packets_(packets) {}

  template <Arrow A>
  void take_any(const PacketOf<A>& packet) {
    if constexpr (A == Arrow::fragment) set_colors(packet, colors_, widths_);
    // Colours go to depth_test if an alpha test downstream of the texture reads them.
    const bool is_of_others =
        A == Arrow::color && stage_.stage == Stage::depth_test && colors_.alpha.func == DepthFunc::always;
    if (!is_of_others) keep(info(A).name, packet);
    if constexpr (A == Arrow::context) context_ = packet;
    if constexpr (A == Arrow::stamp) keep("interpolated", interpolate(packet, context_, widths_));
    if constexpr (A == Arrow::write) {
      WritePacket tested = packet;  // before rop: no colours
      tested.color = {};
      keep("tested", tested);
    }
  }

 private:
  template <class Packet>
  void keep(std::string_view name, const Packet& packet) {
    const auto keep_in = [&](const std::vector<Port>& ports, std::vector<PacketList>& lists) {
      for (std::size_t i = 0; i < ports.size(); ++i)
        if (ports[i].name == name) lists[i].push(packed(packet, widths_));
    };
    keep_in(stage_.in, packets_.in);
    keep_in(stage_.out, packets_.out);
  }

  const JudgedStage& stage_;
  const Widths& widths_;
  StagePackets& packets_;
  ContextPacket context_;  ///< of the current primitive
  ColorState colors_;      ///< at the fragments
};

class Replay final : public StageIo {
 public:
  Replay(const StagePackets& packets, const Visit& visit)
      : packets_(packets), visit_(visit), taken_(packets.in.size()), sent_(packets.out.size()) {}

  std::span<const std::uint32_t> take(std::size_t port) override {
    if (taken_[port] == packets_.in[port].size()) return {};
    const std::size_t number = taken_[port]++;
    visit_(false, port, number, packets_.in[port][number]);
    return packets_.in[port][number];
  }
  void send(std::size_t port, std::span<const std::uint32_t> words) override {
    const std::size_t number = sent_[port]++;
    if (number >= packets_.out[port].size() || !std::ranges::equal(words, packets_.out[port][number]))
      throw std::logic_error("vectors: a stage by itself gives something else than in the hardware model");
    visit_(true, port, number, words);
  }
  void finish() const {
    for (std::size_t port = 0; port < sent_.size(); ++port)
      if (sent_[port] != packets_.out[port].size())
        throw std::logic_error("vectors: a stage by itself gives fewer packets than in the hardware model");
  }

 private:
  const StagePackets& packets_;
  const Visit& visit_;
  std::vector<std::size_t> taken_, sent_;
};

}  // namespace

StagePackets record_stage(const JudgedStage& stage, const Config& config, const SceneSource& next,
                          const std::function<void(std::uint64_t)>& progress) {
  require_stage(stage, config);
  const Widths widths = derive_widths(config);
  StagePackets packets(stage, widths);
  StageRecorder recorder(stage, widths, packets);
  HardwareModel hardware(config, recorder);
  std::uint64_t sent = 0;
  while (const auto scene = next()) {
    HostStream host(*scene, config);
    hardware.hold_textures(*scene);
    while (const auto primitive = host.next()) {
      recorder.take_any<Arrow::primitive>(primitive->packet);
      if (primitive->line) recorder.take_any<Arrow::line>(*primitive->line);
      hardware.run(primitive->packet, primitive->line);
      if (progress && ++sent % 256 == 0) progress(sent);
    }
  }
  return packets;
}

void replay_stage(const JudgedStage& stage, const Config& config, const StagePackets& packets, const Visit& visit) {
  if (!stage.can_run()) {
    for (std::size_t port = 0; port < packets.in.size(); ++port)
      for (std::size_t n = 0; n < packets.in[port].size(); ++n) visit(false, port, n, packets.in[port][n]);
    for (std::size_t port = 0; port < packets.out.size(); ++port)
      for (std::size_t n = 0; n < packets.out[port].size(); ++n) visit(true, port, n, packets.out[port][n]);
    return;
  }
  Replay replay(packets, visit);
  run_stage(stage, replay, config, derive_widths(config));
  replay.finish();
}

}  // namespace halfplane::vectors
