#include "sim/cosim/session.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/specification.hpp"
#include "sim/interrupt.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {
namespace {

constexpr std::uint64_t kLargestChunk = 2000;                  // primitives
constexpr std::uint64_t kTraceBefore = 200, kTraceAfter = 20;  // cycles around the mismatch
constexpr std::uint64_t kQuickTrace = 200'000;                 // cycles that a user waits after Ctrl-C

/// Whether the order of a frame is random: if no other was requested.
bool has_orders(const Config& config) {
  return config.cache_kind == CacheKind::blocks && config.frame_order == FrameOrder::program &&
         config.frame_store == FrameStore::all;
}

void draw_order(Random& random, Config& config) {
  const std::uint64_t drawn = random.next();
  config.frame_order = (drawn & 1) != 0 ? FrameOrder::bins : FrameOrder::program;
  config.frame_store = (drawn & 2) != 0 ? FrameStore::color : FrameStore::all;
}

}  // namespace

SceneSource single_scene(Scene scene) {
  return [left = std::make_shared<std::optional<Scene>>(std::move(scene))] { return std::exchange(*left, {}); };
}

SceneSource random_scenes(const Config& config, std::uint64_t seed, std::uint64_t count, const RandomProfile& profile,
                          SceneRange range) {
  return [config, profile, range, random = Random(seed), left = count, chunk = std::uint64_t{50},
          number = std::uint64_t{0}]() mutable -> std::optional<Scene> {
    while (left != 0) {
      const std::uint64_t n = std::min(left, chunk), scene_seed = random.next();
      left -= n;
      chunk = std::min(kLargestChunk, 2 * chunk);
      if (++number < range.first) continue;
      if (number - range.first >= range.count) break;
      return random_scene(config, scene_seed, n, profile);
    }
    return {};
  };
}

Session run_session(Dut& dut, const Config& config, const LockstepOptions& options, const SceneSource& next,
                    HostOrders orders, bool holds_model, std::uint64_t first) {
  const auto start = std::chrono::steady_clock::now();
  Session session;
  session.config = config;
  const bool is_drawn = orders == HostOrders::drawn, draws = is_drawn && has_orders(config);
  Lockstep lockstep(dut, config, options);
  Random random(options.seed);
  const auto run = [&](Scene scene, bool is_alone) {
    const LockstepResult result = lockstep.run(scene, session.config);
    session.result.add(result);
    session.counters = lockstep.host_counters();
    ++session.scenes;
    const bool goes_on = !result.mismatch && !result.is_stopped;
    if (goes_on && is_alone && holds_model) session.disagreement = difference_from_specification(scene, session.config);
    if (result.mismatch || !session.disagreement.empty()) session.failed = std::move(scene);
    return goes_on && session.disagreement.empty();
  };
  const auto drawn = [&]() -> std::optional<std::uint64_t> {  // what the seed gives a scene: orders, and a next frame
    ++session.scene;
    if (draws) draw_order(random, session.config);
    return is_drawn && compares_bins(session.config) ? std::optional(random.next()) : std::nullopt;
  };
  while (session.scene + 1 < first) (void)drawn();
  while (auto scene = next()) {
    std::optional<Scene> second;  // a next frame, some of whose bins are unchanged
    if (const auto seed = drawn()) second = next_frame(*scene, *seed);
    if (!run(std::move(*scene), true) || (second && !run(std::move(*second), false))) break;
  }
  session.has_trace = lockstep.finish_trace();
  session.trace_failure = lockstep.trace_failure();
  session.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return session;
}

Finding investigate(Dut& dut, const Config& config, const LockstepOptions& options, const Scene& failed,
                    const Mismatch& mismatch, const std::string& trace, const ReduceOptions& reducing) {
  Finding finding{failed, options, mismatch, {}, false, false, {}};
  try {
    finding.reduced = reduce(failed, config, options, lockstep_test(dut, config), reducing);
  } catch (const Interrupted&) {
    finding.is_stopped = true;
  }
  if (!finding.reduced) return finding;
  finding.scene = finding.reduced->scene;
  finding.lockstep = finding.reduced->lockstep;
  finding.mismatch = finding.reduced->mismatch;
  if (trace.empty() || !dut.can_trace()) return finding;
  LockstepOptions traced = finding.lockstep;
  traced.progress = {};
  traced.trace = trace;
  traced.trace_first = finding.mismatch.cycle - std::min(finding.mismatch.cycle, kTraceBefore);
  traced.trace_last = finding.mismatch.cycle + kTraceAfter;
  if (is_interrupted() && traced.trace_last > kQuickTrace) return finding;
  Lockstep rerun(dut, config, traced);
  (void)rerun.run(finding.scene);
  finding.has_trace = rerun.finish_trace();
  finding.trace_failure = rerun.trace_failure();
  return finding;
}

}  // namespace halfplane
