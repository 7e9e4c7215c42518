// Every seeded fault of the RTL is caught by the co-simulation of random scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "../tier.hpp"
#include "halfplane_paths.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/cosim/session.hpp"

namespace halfplane::mutants_test {
namespace {

/// A co-simulation of random scenes.
struct Run {
  std::string design;  ///< of model/designs.toml
  double stalls = 0;   ///< the probability that a stream is blocked in a cycle
  bool resets = false;
  std::uint64_t seed = 1;
};

std::string text(int id, const Run& run) {
  std::ostringstream line;
  line << id << ' ' << run.design << ' ' << run.stalls << ' ' << run.resets << ' ' << run.seed;
  return line.str();
}

bool catches(const Run& run, const Mutant& mutant, std::uint64_t primitives = 6000) {
  LockstepOptions options;
  options.compares_cycles = true;  // some faults cost time alone
  options.seed = run.seed;
  options.stall_probability = run.stalls;
  options.mutant = static_cast<std::uint16_t>(mutant.id);
  if (run.resets) {  // with answers in flight
    options.resets = 8;
    options.memory.latency = 40;
  }
  const DutFactory& factory = find_dut(labelled(run.design));
  const auto dut = make_dut(factory);
  const auto scenes = random_scenes(factory.config, options.seed, primitives);
  return run_session(*dut, factory.config, options, scenes, HostOrders::drawn).result.mismatch.has_value();
}

/// Runs in which a fault can show, the likely ones first.
std::vector<Run> runs_for(const Mutant& mutant, std::uint64_t seed) {
  const auto is_of = [&mutant](std::initializer_list<const char*> kinds) {
    return std::any_of(kinds.begin(), kinds.end(), [&](const char* kind) { return mutant.what.starts_with(kind); });
  };
  std::vector<Run> runs;
  const auto with_and_without_stalls = [&](const char* design) {
    runs.push_back({design, 0.2, false, seed});
    runs.push_back({design, 0, false, seed});
  };
  if (is_of({"resolve", "samples, textures"})) {
    with_and_without_stalls("resolved");
  } else if (is_of({"samples"})) {
    with_and_without_stalls("sampled");
  } else {
    const bool is_of_operations = is_of({"colours", "alpha", "lanes"});
    if (is_of({"texture"})) runs.push_back({"textured", 0.2, true, seed});
    if (is_of_operations) with_and_without_stalls("blended");
    if (is_of_operations || is_of({"stencil", "fog", "light", "two clocks"})) with_and_without_stalls("stencilled");
    runs.push_back({"embedded", 0.2, false, seed});
    with_and_without_stalls("tiny");  // which has the framebuffer of tiles
    runs.push_back({"embedded", 0.2, true, seed});
  }
  return runs;
}

/// Lines of tests/data/mutant_runs.txt: the run that caught each fault when the file was written.
std::map<int, Run> known_runs() {
  std::map<int, Run> runs;
  std::ifstream file(HALFPLANE_TEST_DATA "/mutant_runs.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    int id = 0;
    Run run;
    if (words >> id >> run.design >> run.stalls >> run.resets >> run.seed) runs[id] = run;
  }
  return runs;
}

/// The run that catches the fault, looked for: many short runs before the long ones, so that the line of mutant_runs.txt is one
/// that shows the fault early.
std::optional<Run> search(const Mutant& mutant) {
  struct Effort {
    std::uint64_t primitives, seeds;
  };
  for (const Effort effort : {Effort{50, 8}, Effort{250, 8}, Effort{1000, 4}, Effort{6000, 3}})
    for (std::uint64_t seed = 1; seed <= effort.seeds; ++seed)
      for (const Run& run : runs_for(mutant, seed))
        if (catches(run, mutant, effort.primitives)) return run;
  return std::nullopt;
}

/// Faults whose number is `part` modulo 2, so that two processors share the work. A known run is tried first; one
/// that does not catch its fault any more (scenes change) costs time, and its new line is printed.
void expect_all_caught(std::size_t part) {
  const std::map<int, Run> known = test::runs_all() ? std::map<int, Run>() : known_runs();
  for (std::size_t i = part; i < mutants().size(); i += 2) {
    const Mutant& mutant = mutants()[i];
    const auto run = known.find(mutant.id);
    if (run != known.end() && catches(run->second, mutant)) continue;
    const std::optional<Run> found = search(mutant);
    EXPECT_TRUE(found) << "mutant " << mutant.id << " of " << mutant.file << " is not caught: " << mutant.what;
    if (found) std::printf("mutant_runs.txt: %s\n", text(mutant.id, *found).c_str());
  }
}

// Must fail: each mutant differs from the design by one expression.
TEST(Mutants, EveryEvenOneIsCaughtByARandomRun) {
  EXPECT_GE(mutants().size(), 100u);
  expect_all_caught(0);
}
TEST(Mutants, EveryOddOneIsCaughtByARandomRun) { expect_all_caught(1); }

// Random scenes, and no fault: nothing is caught.
TEST(Mutants, WithoutAFaultNoDesignDiffers) {
  for (const DutFactory& factory : verilated_duts()) {
    if (!factory.has_mutants) continue;
    EXPECT_FALSE(catches({label(factory.config, " "), 0.2, true, 1}, Mutant{}, test::cases(750, 6000))) << factory.name;
  }
}

}  // namespace
}  // namespace halfplane::mutants_test
