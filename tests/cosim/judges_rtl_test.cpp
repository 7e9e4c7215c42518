// The judges of tests/judges on the RTL: the designs that have the units. Where a design lacks one, the case is left out.
#include <gtest/gtest.h>

#include <iostream>

#include "../judges/fragment_operations.hpp"
#include "../judges/rasterization.hpp"
#include "../judges/textures.hpp"
#include "../tier.hpp"
#include "model/capture/capture.hpp"
#include "model/host/primitive_stream.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/cosim/rtl_engine.hpp"

namespace halfplane::judges_rtl_test {
namespace {

/// Every `step`th case; `least`: cases that the design must have.
void judge(const std::string& design, const std::vector<judges::Case>& cases, std::size_t step, std::size_t least) {
  const Config config = preset(design);
  const auto dut = make_dut(find_dut(config));
  std::size_t judged = 0;
  for (std::size_t n = 0; n < cases.size(); n += step) {
    const Scene scene = read_capture(cases[n].capture, "");
    try {
      check_hardware_scene(scene, config);
    } catch (const InputError&) {
      continue;
    }
    EXPECT_EQ(cases[n].verdict(render_rtl(*dut, scene, config, {}).rendering.frame, config), "") << cases[n].name;
    ++judged;
  }
  std::cout << design << ": " << judged << " of " << cases.size() << " cases\n";
  EXPECT_GE(judged, least);
}

TEST(JudgesOfRtl, RasterizationIsAsSpecified) { judge("blended", judges::rasterization(), 1, 76); }
TEST(JudgesOfRtl, FragmentOperationsAreAsSpecified) {
  judge("blended", judges::fragment_operations(), test::cases<std::size_t>(13, 1), test::cases<std::size_t>(50, 700));
  judge("stencilled", judges::fragment_operations(), test::cases<std::size_t>(13, 1),
        test::cases<std::size_t>(90, 1250));
}
TEST(JudgesOfRtl, TexturesAreAsSpecified) {
  judge("blended", judges::textures(), test::cases<std::size_t>(7, 1), test::cases<std::size_t>(50, 380));
}

// Seeded faults of the RTL, each by the cases that are about it.
TEST(JudgesOfRtl, SeededFaultsAreRejected) {
  struct Fault {
    std::uint16_t mutant;
    std::string_view design, cases;  ///< beginning of their names
  };
  const auto polygons = judges::rasterization(), operations = judges::fragment_operations(),
             lookups = judges::textures();
  for (const Fault& fault : {Fault{1, "blended", "triangles/square_on_centres"}, Fault{23, "blended", "triangles/"},
                             Fault{42, "blended", "lines/"}, Fault{32, "blended", "depth/gequal"},
                             Fault{181, "blended", "blend/reverse_subtract/one/"}, Fault{187, "blended", "blend/max/"},
                             Fault{188, "blended", "color_mask"}, Fault{200, "blended", "alpha_test less"},
                             Fault{211, "stencilled", "stencil/always_127_255_255/keep/keep/incr"},
                             Fault{155, "blended", "texture/8x8/mirror_"}}) {
    const Config config = preset(fault.design);
    const auto dut = make_dut(find_dut(config));
    bool is_rejected = false;
    for (const auto* cases : {&polygons, &operations, &lookups})
      for (const judges::Case& one : *cases) {
        if (is_rejected || !one.name.starts_with(fault.cases)) continue;
        const Scene scene = read_capture(one.capture, "");
        const FaultyFrame drawn = render_faulty(*dut, scene, config, fault.mutant, 200'000);
        is_rejected = !drawn.frame || !one.verdict(*drawn.frame, config).empty();
        if (!is_rejected) continue;
        const FaultyFrame right = render_faulty(*dut, scene, config, 0, 200'000);
        ASSERT_TRUE(right.frame.has_value()) << one.name;
        EXPECT_EQ(one.verdict(*right.frame, config), "") << one.name;
      }
    EXPECT_TRUE(is_rejected) << "fault " << fault.mutant << " of " << fault.design;
  }
}

}  // namespace
}  // namespace halfplane::judges_rtl_test
