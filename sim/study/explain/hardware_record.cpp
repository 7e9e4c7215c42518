#include "hardware_record.hpp"

#include <array>
#include <cstring>
#include <stdexcept>

#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/hardware.hpp"
#include "model/packets/packet_words.hpp"
#include "sim/cosim/lockstep.hpp"

namespace halfplane::explain {
namespace {

/// Repeats coarse_raster's walk, with its own HiZ, driven by the hardware model's packets: skipped tiles appear in no
/// packet.
class WalkMirror {
 public:
  WalkMirror(const Config& config, const Widths& widths) : widths_(widths), hiz_(config, widths) {}

  void take(const SetupPacket& setup) {
    setup_ = setup;
    walk_.reset();
    if (is_token(setup.kind)) {
      const PixelBox& box = setup.box;
      if (setup.kind == PrimitiveKind::fast_clear && setup.state.depth_write)
        hiz_.clear(box.right >> widths_.tile_shift, box.bottom >> widths_.tile_shift, setup.range.high[kDepthPlane]);
      if (setup.kind == PrimitiveKind::line) hiz_.pass_line(setup);
      return;
    }
    asks_ = hiz_.is_eligible(setup, widths_);
    const auto tile = [this](int pixel) { return pixel >> widths_.tile_shift; };
    walk_.emplace(tile(setup.box.left), tile(setup.box.top), tile(setup.box.right), tile(setup.box.bottom), setup.dy);
  }

  /// The next tile packet of the primitive. Calls look(tile_x, tile_y, class, HiZ if tested) for it and for every tile
  /// skipped before it.
  template <class Look>
  void take(const TilePacket& packet, Look&& look) {
    while (walk_) {
      const int x = walk_->x(), y = walk_->y(), size = 1 << widths_.tile_shift;
      const EdgeValues edges = edges_at_tile(setup_, x, y, widths_);
      const TileClass kind = classify(setup_.dx, setup_.dy, edges, size);
      std::optional<HizLook> hiz;
      if (kind != TileClass::outside && asks_)
        hiz = {setup_.range.low[kDepthPlane], hiz_.bound(x, y), hiz_.rejects(setup_, x, y)};
      look(x, y, kind, hiz);
      const bool is_visit = kind != TileClass::outside && !(hiz && hiz->rejects);
      if (is_visit && !(packet.is_visit && packet.key.tile_x == x && packet.key.tile_y == y))
        throw std::logic_error("explain: its walk over the tiles is not that of coarse_raster");
      if (is_visit) hiz_.begin_visit(setup_.state);
      if (!walk_->next(outside_edges(setup_.dx, setup_.dy, edges, size))) walk_.reset();
      if (is_visit) return;
    }
  }

  void take(const RetirePacket& retired) { hiz_.retire(retired); }

 private:
  const Widths& widths_;
  Hiz hiz_;
  SetupPacket setup_;
  std::optional<TileWalk> walk_;
  bool asks_ = false;
};

/// The place of a pixel in the hardware.
struct Place {
  int tile_x = 0, tile_y = 0, stamp = 0;
  std::size_t sample = 0;
};

Place hardware_place(Pixel pixel, const Widths& widths) {
  const StampGrid& stamps = widths.stamps;
  const int shift = widths.tile_shift, last = (1 << shift) - 1, x = pixel.x & last, y = pixel.y & last;
  return {pixel.x >> shift, pixel.y >> shift, stamps.stamp_at(x, y),
          static_cast<std::size_t>(stamps.sample_at(x % stamps.size, y % stamps.size))};
}

class Recorder final : public EveryPacket<Recorder> {
 public:
  Recorder(const Config& config, const Widths& widths, const std::vector<Pixel>& pixels, PacketStore& packets)
      : widths_(widths), mirror_(config, widths), store_(packets), pixels_(pixels) {
    for (const Pixel pixel : pixels) places_.push_back(hardware_place(pixel, widths));
    at_.resize(pixels.size());
    awaits_write_.resize(pixels.size());
  }

  void begin(const HostPrimitive& host, bool is_wanted) {
    is_wanted_ = is_wanted;
    host_ = &host;
    shared_.clear();
    for (std::size_t i = 0; i < at_.size() && is_wanted; ++i)
      at_[i] = HardwareVisit{host, {}, {}, {}, {}, places_[i].sample, {}, {}, {}};
    take_any<Arrow::primitive>(host.packet);
    if (host.line) take_any<Arrow::line>(*host.line);
  }

  /// `dropped`: the reason if cull dropped it.
  void end(std::optional<Outcome> dropped, HardwareRecord& record) {
    if (!is_wanted_) return;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      HardwareVisit& visit = at_[i];
      visit.packets.insert(visit.packets.begin(), shared_.begin(), shared_.end());
      visit.outcome = dropped ? *dropped : outcome_of(visit);
      record.visits[i].push_back(std::move(visit));
    }
  }

  template <Arrow A>
  void take_any(const PacketOf<A>& packet) {
    const std::uint64_t number = count_[index(A)]++;
    if constexpr (A == Arrow::setup) mirror_.take(packet);
    if constexpr (A == Arrow::tile)
      mirror_.take(packet,
                   [this](int x, int y, TileClass kind, const std::optional<HizLook>& hiz) { look(x, y, kind, hiz); });
    if constexpr (A == Arrow::retire) mirror_.take(packet);
    if (!is_wanted_) return;
    bool is_kept = false;
    if constexpr (A == Arrow::primitive || A == Arrow::line || A == Arrow::triangle || A == Arrow::setup ||
                  A == Arrow::context) {
      shared_.emplace_back(A, number);
      is_kept = true;
    } else {
      for (std::size_t i = 0; i < at_.size(); ++i) {
        if (!concerns(on<A>, packet, i)) continue;
        at_[i].packets.emplace_back(A, number);
        is_kept = true;
      }
    }
    if (is_kept) store_[{A, number}].model = packed(packet, widths_);
  }

 private:
  void look(int x, int y, TileClass kind, const std::optional<HizLook>& hiz) {
    for (std::size_t i = 0; i < at_.size() && is_wanted_; ++i)
      if (places_[i].tile_x == x && places_[i].tile_y == y) {
        at_[i].tile = kind;
        at_[i].hiz = hiz;
      }
  }

  [[nodiscard]] bool is_in_tile(const TileKey& key, std::size_t i) const {
    return key.tile_x == places_[i].tile_x && key.tile_y == places_[i].tile_y;
  }
  [[nodiscard]] bool is_in_stamp(const TileKey& key, int stamp, SampleMask mask, std::size_t i) const {
    return is_in_tile(key, i) && stamp == places_[i].stamp && mask.has(places_[i].sample);
  }

  // Whether a packet contains pixel i; stores the needed fields.
  template <Arrow A, class Packet>
  bool concerns(On<A>, const Packet&, std::size_t) {
    return false;  // a memory packet, shared by many pixels
  }
  bool concerns(On<Arrow::tile>, const TilePacket& p, std::size_t i) {
    is_tile_ = p.is_visit;
    tile_ = p.key;
    return p.is_visit && is_in_tile(p.key, i);
  }
  bool concerns(On<Arrow::edges>, const EdgeContext&, std::size_t i) { return is_tile_ && is_in_tile(tile_, i); }
  bool concerns(On<Arrow::stamp>, const StampPacket& p, std::size_t i) {
    return is_in_stamp(p.key, p.stamp, p.mask, i);
  }
  bool concerns(On<Arrow::line_pixel>, const LinePixel& p, std::size_t i) {
    return p.x == pixels_[i].x && p.y == pixels_[i].y;
  }
  bool concerns(On<Arrow::fragment>, const FragmentPacket& p, std::size_t i) {
    if (is_token(p.kind) && p.kind != PrimitiveKind::line) return true;  // a clear, of all pixels
    if (!is_in_stamp(p.key, p.stamp, p.mask, i)) return false;
    at_[i].fragment = p;
    awaits_write_[i] = true;
    return true;
  }
  bool concerns(On<Arrow::write>, const WritePacket& p, std::size_t i) {
    if (!awaits_write_[i]) return false;  // it follows its fragment
    awaits_write_[i] = false;
    at_[i].write = p;
    return true;
  }
  bool concerns(On<Arrow::color>, const ColorPacket& p, std::size_t i) {
    // After the write of the same stamp, and only if one of its colours is written.
    if (!at_[i].write || at_[i].textured || !at_[i].write->write_color.has(places_[i].sample)) return false;
    at_[i].textured = p.color[places_[i].sample];
    return true;
  }
  bool concerns(On<Arrow::retire>, const RetirePacket& p, std::size_t i) { return is_in_tile(p.key, i); }

  [[nodiscard]] Outcome outcome_of(const HardwareVisit& visit) const {
    if (visit.host.packet.kind == PrimitiveKind::fast_clear) return Outcome(Verdict::written);
    if (visit.write) {
      if (!visit.write->passed.has(visit.sample)) return Outcome(Verdict::depth);
      return Outcome(visit.fragment->state.writes() ? Verdict::written : Verdict::masked);
    }
    if (visit.tile == TileClass::outside) return Outcome(Verdict::tiles_outside);
    if (visit.hiz && visit.hiz->rejects) return Outcome(Verdict::tiles_hiz);
    return Outcome(Verdict::uncovered);
  }

  const Widths& widths_;
  WalkMirror mirror_;
  PacketStore& store_;
  const std::vector<Pixel>& pixels_;
  std::vector<Place> places_;
  std::array<std::uint64_t, kArrows> count_{};
  const HostPrimitive* host_ = nullptr;  ///< the current one
  bool is_wanted_ = false, is_tile_ = false;
  TileKey tile_;
  std::vector<PacketId> shared_;  ///< packets that all pixels share
  std::vector<HardwareVisit> at_;
  std::vector<bool> awaits_write_;
};

/// The reason of cull's drop between these counts; none: not dropped.
std::optional<Outcome> dropped_by_cull(const CounterPacket& before, const CounterPacket& after) {
  if (after.zero_area != before.zero_area) return Outcome(Verdict::zero_area);
  if (after.backface != before.backface) return Outcome(Verdict::backface);
  if (after.empty != before.empty) return Outcome(Verdict::empty);
  if (after.no_sample != before.no_sample) return Outcome(Verdict::no_sample);
  return {};
}

/// For each arrow the wanted numbers in order, and the position reached.
class NumbersWanted {
 public:
  explicit NumbersWanted(PacketStore& packets) {
    for (auto& [id, packet] : packets) {
      wanted_[index(id.first)].emplace_back(id.second, &packet);
      if (const auto& rides = info(id.first).flow.rides_with) riders_[index(*rides)].emplace_back(id.second, &packet);
    }
  }
  /// The next packet of this arrow: calls visit(RecordedPacket&) for it, if wanted, and for each packet that moves with
  /// it.
  template <class Visit>
  void next(Arrow arrow, bool with_riders, Visit&& visit) {
    const std::uint64_t number = count_[index(arrow)]++;
    visit_one(wanted_[index(arrow)], next_[index(arrow)], number, visit);
    if (with_riders) visit_one(riders_[index(arrow)], next_rider_[index(arrow)], number, visit);
  }

 private:
  using List = std::vector<std::pair<std::uint64_t, RecordedPacket*>>;
  template <class Visit>
  static void visit_one(const List& list, std::size_t& at, std::uint64_t number, Visit&& visit) {
    if (at == list.size() || list[at].first != number) return;
    visit(*list[at++].second);
  }
  std::array<List, kArrows> wanted_, riders_;
  std::array<std::size_t, kArrows> next_{}, next_rider_{};
  std::array<std::uint64_t, kArrows> count_{};
};

class CycleRecorder final : public TransferSink {
 public:
  explicit CycleRecorder(PacketStore& packets) : wanted_(packets) {}
  void transfer(Arrow boundary, Cycle cycle) override {
    wanted_.next(boundary, true, [cycle](RecordedPacket& packet) { packet.model_cycle = cycle; });
  }

 private:
  NumbersWanted wanted_;
};

}  // namespace

HardwareRecord record_hardware(const Scene& scene, const Config& config, const std::vector<Pixel>& pixels,
                               const std::unordered_set<std::uint32_t>& wanted,
                               const std::function<void(double)>& progress, PacketStore& packets) {
  const Widths widths = derive_widths(config);
  HardwareRecord record;
  record.visits.resize(pixels.size());
  HostStream host(scene, config);
  Recorder recorder(config, widths, pixels, packets);
  HardwareModel hardware(config, recorder);
  hardware.hold_textures(scene);
  std::uint32_t sent = 0;
  while (const auto primitive = host.next()) {
    if (++sent % 1024 == 0) progress(host.progress());
    const PrimitiveKind kind = primitive->packet.kind;
    const bool is_clear = kind == PrimitiveKind::fast_clear || kind == PrimitiveKind::rectangle;
    recorder.begin(*primitive, is_clear || (is_counted(kind) && wanted.contains(primitive->primitive)));
    const CounterPacket before = hardware.counters();
    hardware.run(primitive->packet, primitive->line);
    recorder.end(dropped_by_cull(before, hardware.counters()), record);
  }
  record.frame = to_framebuffer(hardware.memory(), scene.width, scene.height, config);
  return record;
}

void record_cycles(const Scene& scene, const Config& config, PacketStore& packets) {
  CycleRecorder recorder(packets);
  CycleOptions options;
  options.sink = &recorder;
  const auto memory = make_memory({}, config);
  (void)render_cycle(scene, config, *memory, {}, options);
}

Framebuffer record_rtl(Dut& dut, const Scene& scene, const Config& config, std::uint16_t mutant,
                       const std::function<bool(double)>& progress, PacketStore& packets) {
  const Widths widths = derive_widths(config);
  NumbersWanted wanted(packets);
  LockstepOptions options;
  options.compares = false;
  options.mutant = mutant;
  options.progress = progress;
  options.tap = [&](Arrow arrow, const void* bytes, std::uint64_t cycle) {
    wanted.next(arrow, false, [&](RecordedPacket& packet) {
      const int bits = with_packet_type(
          arrow, [&]<class Packet>(std::type_identity<Packet>) { return packet_bits<Packet>(widths); });
      packet.rtl.assign(words_of(bits), 0);
      std::memcpy(packet.rtl.data(), bytes, static_cast<std::size_t>(bits + 7) / 8);
      packet.rtl_cycle = cycle;
    });
  };
  Lockstep lockstep(dut, config, options);
  const LockstepResult run = lockstep.run(scene);
  if (run.mismatch) throw std::runtime_error("the RTL hangs: " + run.mismatch->hint);
  return to_framebuffer(lockstep.memory(), scene.width, scene.height, config);
}

}  // namespace halfplane::explain
