// The judges of tests/judges: the scalar and the functional engine draw as the specifications say, and each judge rejects a
// deliberately wrong picture. The RTL: tests/cosim/judges_rtl_test.cpp.
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <string>

#include "../judges/fragment_operations.hpp"
#include "../judges/rasterization.hpp"
#include "../judges/textures.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"

namespace halfplane::judges_test {
namespace {

using judges::Case;

void judge(const std::vector<Case>& cases, std::size_t least_faults) {
  const Config config = preset("full");
  std::size_t rejected = 0;
  std::map<std::string, std::size_t> by_family;  // the first word of a case's name
  for (const Case& one : cases) {
    const Scene scene = read_capture(one.capture, "");
    EXPECT_EQ(one.verdict(render_scalar(scene, config).frame, config), "") << one.name << ", scalar";
    EXPECT_EQ(one.verdict(render_functional(scene, config).frame, config), "") << one.name << ", functional";
    std::size_t& of_family = by_family[one.name.substr(0, one.name.find_first_of("/ "))];
    if (one.wrong.empty()) continue;
    const bool is_rejected = !one.verdict(render_functional(read_capture(one.wrong, ""), config).frame, config).empty();
    rejected += is_rejected ? 1 : 0;
    of_family += is_rejected ? 1 : 0;
    EXPECT_TRUE(is_rejected) << one.name << " takes a wrong picture";
  }
  std::cout << cases.size() << " cases, " << rejected << " wrong pictures rejected\n";
  EXPECT_GE(rejected, least_faults);
  for (const auto& [family, count] : by_family) EXPECT_GT(count, 0U) << family << " rejects no wrong picture";
}

TEST(Judges, RasterizationIsAsSpecified) { judge(judges::rasterization(), 50); }
TEST(Judges, FragmentOperationsAreAsSpecified) { judge(judges::fragment_operations(), 1250); }
TEST(Judges, TexturesAreAsSpecified) { judge(judges::textures(), 180); }

}  // namespace
}  // namespace halfplane::judges_test
