#include "check.hpp"

#include <numeric>
#include <utility>

namespace halfplane::vectors {
namespace {

class Judge final : public StageIo {
 public:
  Judge(const JudgedStage& stage, const Widths& widths, const StagePackets& packets)
      : stage_(stage), widths_(widths), packets_(packets) {
    result_.in.resize(packets.in.size());
    result_.compared.resize(packets.out.size());
    result_.differing.resize(packets.out.size());
  }

  std::span<const std::uint32_t> take(std::size_t port) override {
    if (result_.in[port] == packets_.in[port].size()) return {};
    return packets_.in[port][result_.in[port]++];
  }

  void send(std::size_t port, std::span<const std::uint32_t> expected) override {
    const PacketList& list = packets_.out[port];
    const std::size_t number = result_.compared[port]++;
    if (hints_at_ && result_.first->port == port) {  // the packet behind the first that differs
      if (std::ranges::equal(expected, list[result_.first->number]))
        result_.first->hint = "what comes here is the packet that should come next: this one was lost";
      hints_at_ = false;
    }
    const bool is_missing = number >= list.size();
    if (!is_missing && std::ranges::equal(expected, list[number])) return;
    ++result_.differing[port];
    if (result_.first) return;
    FirstDifference& first = result_.first.emplace();
    first.kind = is_missing ? FirstDifference::Kind::missing : FirstDifference::Kind::differs;
    first.port = port;
    first.number = number;
    if (is_missing) return;
    const auto names = fields_of(stage_.out[port].like, widths_);
    const auto want = values_of(stage_.out[port].like, widths_, expected),
               got = values_of(stage_.out[port].like, widths_, list[number]);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (want[i] != got[i]) first.fields.push_back({names[i].name, names[i].bits, want[i], got[i]});
    hints_at_ = true;
    if (number + 1 < list.size() && std::ranges::equal(expected, list[number + 1]))
      first.hint = "the next packet is what should come here: this one is too much";
  }

  Judgement finish() {
    for (std::size_t port = 0; port < packets_.out.size(); ++port) {
      const std::size_t size = packets_.out[port].size();
      if (size <= result_.compared[port]) continue;
      if (!result_.first)
        result_.first = FirstDifference{FirstDifference::Kind::extra, port, result_.compared[port], {}, {}};
      result_.differing[port] += size - result_.compared[port];
      result_.compared[port] = size;
    }
    return std::move(result_);
  }

 private:
  const JudgedStage& stage_;
  const Widths& widths_;
  const StagePackets& packets_;
  Judgement result_;
  bool hints_at_ = false;  ///< the next packet of that port may tell more of the first that differs
};

std::size_t sum_of(const std::vector<std::size_t>& list) {
  return std::accumulate(list.begin(), list.end(), std::size_t{0});
}

}  // namespace

std::size_t Judgement::total_compared() const { return sum_of(compared); }
std::size_t Judgement::total_differing() const { return sum_of(differing); }

Judgement judge(const JudgedStage& stage, const Config& config, const StagePackets& packets) {
  if (!stage.can_run())
    throw InputError("stage " + std::string(info(stage.stage).name) +
                     " cannot be judged: " + std::string(stage.why_not));
  const Widths widths = derive_widths(config);
  Judge judge(stage, widths, packets);
  run_stage(stage, judge, config, widths);
  return judge.finish();
}

}  // namespace halfplane::vectors
