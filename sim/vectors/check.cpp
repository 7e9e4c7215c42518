#include "check.hpp"

#include <numeric>
#include <utility>

#include "model/packets/packet_words.hpp"

namespace halfplane::vectors {
namespace {

/// Gives the sink the packet of an arrow, known by its number.
template <std::size_t... I>
void give(PacketSink& sink, Arrow arrow, std::span<const std::uint32_t> words, const Widths& widths,
          std::index_sequence<I...>) {
  const auto give_one = [&]<Arrow A>(On<A> which) {
    if (arrow == A) sink.take(which, unpack_words<PacketOf<A>>(words.data(), widths));
  };
  (give_one(on<static_cast<Arrow>(I)>), ...);
}

class Judge final : public StageIo {
 public:
  Judge(const JudgedStage& stage, const Widths& widths, const StagePackets& packets, PacketSink* sink)
      : stage_(stage), widths_(widths), packets_(packets), sink_(sink) {
    result_.in.resize(packets.in.size());
    result_.compared.resize(packets.out.size());
    result_.differing.resize(packets.out.size());
    places_.resize(packets.out.size());
  }

  std::span<const std::uint32_t> take(std::size_t port) override {
    if (result_.in[port] == packets_.in[port].size()) return {};
    const auto words = packets_.in[port][result_.in[port]++];
    show(stage_.in[port], words);
    return words;
  }

  void send(std::size_t port, std::span<const std::uint32_t> expected) override {
    show(stage_.out[port], expected);
    Place& at = places_[port];
    const PacketList& list = packets_.out[port];
    ++result_.compared[port];
    const bool is_behind = std::exchange(at.is_behind_difference, false),
               may_be_extra = std::exchange(at.may_be_extra, false);
    if (is_equal(list, at.next, expected)) {
      ++at.next;
      return;
    }
    if (is_behind && is_equal(list, at.next - 1, expected)) {  // it was due before: one was lost
      if (result_.first->port == port && result_.first->number == at.next - 1)
        result_.first->hint = "what comes here is the packet that should come next: this one was lost";
      return;
    }
    if (may_be_extra && is_equal(list, at.next + 1, expected)) {  // so was the previous packet: an extra packet
      at.next += 2;
      return;
    }
    ++result_.differing[port];
    at.is_behind_difference = true;
    at.may_be_extra = is_equal(list, at.next + 1, expected);
    if (!result_.first) add_first(port, at.next, expected, at.may_be_extra);
    ++at.next;
  }

  Judgement finish() {
    for (std::size_t port = 0; port < packets_.out.size(); ++port) {
      const Place& at = places_[port];
      const std::size_t size = packets_.out[port].size(), next = at.next + (at.may_be_extra ? 1 : 0);
      if (size <= next) continue;
      if (!result_.first) result_.first = FirstDifference{FirstDifference::Kind::extra, port, next, {}, {}};
      result_.differing[port] += size - next;
      result_.compared[port] += size - next;
    }
    return std::move(result_);
  }

 private:
  /// The judge's position in the packets of an output port.
  struct Place {
    std::size_t next = 0;
    bool is_behind_difference = false;
    bool may_be_extra = false;  ///< the packet of that difference, if all later ones come a packet later
  };

  /// Ports that are no arrows are not shown.
  void show(const Port& port, std::span<const std::uint32_t> words) {
    if (sink_ != nullptr && port.name == info(port.like).name)
      give(*sink_, port.like, words, widths_, std::make_index_sequence<kArrows>());
  }

  [[nodiscard]] static bool is_equal(const PacketList& list, std::size_t number,
                                     std::span<const std::uint32_t> expected) {
    return number < list.size() && list.undefined(number).empty() && std::ranges::equal(expected, list[number]);
  }

  void add_first(std::size_t port, std::size_t number, std::span<const std::uint32_t> expected, bool is_extra) {
    const PacketList& list = packets_.out[port];
    FirstDifference& first = result_.first.emplace();
    const bool is_missing = number >= list.size();
    first.kind = is_missing ? FirstDifference::Kind::missing : FirstDifference::Kind::differs;
    first.port = port;
    first.number = number;
    if (is_missing) return;
    const Arrow like = stage_.out[port].like;
    const auto names = fields_of(like, widths_);
    const auto want = values_of(like, widths_, expected), got = values_of(like, widths_, list[number]);
    const auto mask = list.undefined(number);
    const auto undefined = mask.empty() ? std::vector<std::uint64_t>(names.size()) : values_of(like, widths_, mask);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (want[i] != got[i] || undefined[i] != 0)
        first.fields.push_back({names[i].name, names[i].bits, want[i], got[i], undefined[i]});
    if (is_extra) first.hint = "the next packet is what should come here: this one is too much";
  }

  const JudgedStage& stage_;
  const Widths& widths_;
  const StagePackets& packets_;
  PacketSink* sink_;
  Judgement result_;
  std::vector<Place> places_;
};

std::size_t sum_of(const std::vector<std::size_t>& list) {
  return std::accumulate(list.begin(), list.end(), std::size_t{0});
}

}  // namespace

std::size_t Judgement::total_compared() const { return sum_of(compared); }
std::size_t Judgement::total_differing() const { return sum_of(differing); }

Judgement judge(const JudgedStage& stage, const Config& config, const StagePackets& packets, PacketSink* sink) {
  if (!stage.can_run())
    throw InputError("stage " + std::string(info(stage.stage).name) +
                     " cannot be judged: " + std::string(stage.why_not));
  const Widths widths = derive_widths(config);
  Judge judge(stage, widths, packets, sink);
  run_stage(stage, judge, config, widths);
  return judge.finish();
}

}  // namespace halfplane::vectors
