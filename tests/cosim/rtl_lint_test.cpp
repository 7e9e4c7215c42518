// Every configuration that is accepted has RTL that Verilator reads without a warning: random ones, the package of each in
// front of the same sources. A build with RTL was made by Verilator, so it is there.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../tier.hpp"
#include "halfplane_paths.hpp"
#include "model/generate/raster_pkg.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::rtl_lint_test {
namespace {

const std::filesystem::path kRtl = std::filesystem::path(HALFPLANE_SOURCE_DIR) / "rtl_ref";

/// Any preset with about half of its settings changed, most of them to an end of their range or near it.
Config random_config(Random& random) {
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random.next() % n); };
  for (;;) {
    Config config = preset(preset_names()[below(preset_names().size())]);
    for (const Setting& setting : settings()) {
      if (!setting.is_hardware() || below(2) == 0) continue;
      if (setting.key == "msaa.pattern") continue;  // the standard one
      if (setting.is_number()) {
        int value = setting.min + static_cast<int>(below(static_cast<std::size_t>(setting.max - setting.min) + 1));
        if (setting.max > 64 && below(3) != 0) value = 1 << below(12);  // small targets
        if (setting.key == "target.width" || setting.key == "target.height") value += static_cast<int>(below(2));
        if (!setting.values.empty()) value = setting.values[below(setting.values.size())];
        if (value < setting.min || value > setting.max) continue;
        set(config, setting.key, std::to_string(value));
      } else {
        set(config, setting.key, setting.names[below(setting.names.size())]);
      }
    }
    try {
      validate(config);
      require_sampled_hardware(config, "the RTL");
      return config;
    } catch (const InputError&) {  // another one
    }
  }
}

/// Messages of Verilator on the design with this package; empty: none.
std::string lint(const std::string& package, const std::string& top = "raster_top") {
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();  // others run beside it
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / ("halfplane_lint_" + test);
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "raster_pkg.sv").string(), said = (folder / "said.txt").string(),
                    rtl = kRtl.string();
  std::ofstream(file) << package;
  const std::string command = "verilator_bin --lint-only -Wall -I" + rtl + " -I" + rtl + "/lib -I" + rtl +
                              "/stages --top-module " + top + " " + rtl + "/lint.vlt " + file + " " + rtl +
                              "/raster_top.sv > " + said + " 2>&1";
  const int status = std::system(command.c_str());
  std::ostringstream text;
  text << std::ifstream(said).rdbuf();
  return status == 0 ? "" : text.str().empty() ? "verilator_bin failed" : text.str();
}

/// Four, of all tests fifty; with HALFPLANE_SOAK=SECONDS a hundred, and more while there is time.
TEST(StressRtlLint, EveryAcceptedConfigurationIsReadWithoutAWarning) {
  const char* soak = std::getenv("HALFPLANE_SOAK");
  const std::uint64_t seed =
      soak == nullptr ? 1 : static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(soak == nullptr ? 0 : std::atoi(soak));
  for (int done = 0; done < (soak == nullptr ? test::cases(4, 50) : 100) || std::chrono::steady_clock::now() < until;
       ++done) {
    const Config config = random_config(random);
    ASSERT_EQ(lint(raster_pkg(config)), "") << label(config, " --set ");
  }
}

TEST(RtlLint, TargetsNoLargerThanATileAreRead) {
  for (const auto& [width, height] : {std::pair{8, 8}, {1, 1}, {8, 9}, {20, 3}}) {
    Config config = preset("embedded");
    config.target_width = width;
    config.target_height = height;
    EXPECT_EQ(lint(raster_pkg(config)), "") << width << "x" << height;
  }
}

TEST(RtlLintMustFail, AWireThatNobodyReadsIsFound) {
  std::string package = raster_pkg(preset("tiny"));
  const std::string bits = "localparam int PIXEL_X_BITS = ";
  const auto at = package.find(bits) + bits.size();
  EXPECT_NE(lint(package.replace(at, package.find(';', at) - at, "3")), "")
      << "pixels of a tile, and no bit for the tile";
}

TEST(RtlLintMustFail, ASignalThatNothingReadsIsFoundDespiteTheWaivers) {
  const std::string module =
      "module forgets (input logic a_i, output logic y_o);\n"
      "  logic forgotten;\n  assign forgotten = a_i;\n  assign y_o = a_i;\nendmodule\n";
  EXPECT_NE(lint(raster_pkg(preset("tiny")) + module, "forgets").find("'forgotten'"), std::string::npos);
}

}  // namespace
}  // namespace halfplane::rtl_lint_test
