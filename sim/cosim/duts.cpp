// The Verilated designs of this build: rtl_ref/CMakeLists.txt makes the classes.
#include <stdexcept>
#include <type_traits>

#include "model/generate/raster_pkg.hpp"
#include "sim/cosim/dut.hpp"

#ifdef HALFPLANE_HAS_RTL
#ifndef HALFPLANE_RTL_COVERAGE
#include <verilated_fst_c.h>
#endif

#include "dut_classes.inc"  // written by rtl_ref/CMakeLists.txt
#include "sim/cosim/verilated_dut.hpp"
#endif

namespace halfplane {
namespace {

#ifdef HALFPLANE_HAS_RTL
#ifdef HALFPLANE_RTL_COVERAGE  // built without waveforms
template <class V>
using Instance = VerilatedDut<V>;
#else
template <class V>
using Instance = VerilatedDut<V, VerilatedFstC>;
#endif

template <class V>
DutFactory verilated(const char* label, bool has_mutants) {
  constexpr bool kHasTrace = !std::is_same_v<Instance<V>, VerilatedDut<V>>;
  return {label, labelled(label), has_mutants, kHasTrace, [] { return std::make_unique<Instance<V>>(); }};
}

std::vector<DutFactory> make_duts() {
  return {
#include "dut_list.inc"
  };
}

constexpr Mutant kMutants[] = {
#include "mutants.inc"  // written by cmake/Mutants.cmake
};
#endif

std::string options_of(const Config& config) { return "--config " + label(config, " --set "); }

}  // namespace

const std::vector<DutFactory>& verilated_duts() {
#ifdef HALFPLANE_HAS_RTL
  static const std::vector<DutFactory> duts = make_duts();
#else
  static const std::vector<DutFactory> duts;
#endif
  return duts;
}

std::span<const Mutant> mutants() {
#ifdef HALFPLANE_HAS_RTL
  return kMutants;
#else
  return {};
#endif
}

const DutFactory& find_dut(const Config& config) {
  require_sampled_hardware(config, "the RTL");
  const auto& duts = verilated_duts();
  if (duts.empty())
    throw std::runtime_error(
        "this program was built without the RTL; install the package verilator, then run ./dev build");
  std::string choices;
  for (const DutFactory& dut : duts) {
    if (config_id(dut.config) == config_id(config)) return dut;
    choices += (choices.empty() ? "" : "; or ") + options_of(dut.config);
  }
  throw std::runtime_error("no RTL was Verilated for " + label(config) + "; run ./dev build " + options_of(config) +
                           "; this build has " + choices);
}

std::unique_ptr<Dut> make_dut(const DutFactory& factory) {
  std::unique_ptr<Dut> dut = factory.make();
  if (dut->config_id() != config_id(factory.config))
    throw std::runtime_error("the RTL of " + factory.name +
                             " was Verilated from another configuration than the model's; run ./dev build");
  return dut;
}

}  // namespace halfplane
