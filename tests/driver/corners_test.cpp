// A driver with room for six corners (tests/driver/CMakeLists.txt): a polygon of more is left out, and said to be.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "driver/halfplane.h"

namespace halfplane::test {
namespace {

static_assert(HP_CORNERS == 6);

TEST(DriverCorners, APolygonOfTooManyIsLeftOut) {
  std::vector<std::uint32_t> words(512);
  const hp_stream stream{words.data(), static_cast<std::uint32_t>(words.size()), nullptr, nullptr};
  const hp_target target{16, 16, 0, 0, 0, 0, 2 << HALFPLANE_PLANE_SHIFT << 1, 0};
  const auto driver = std::make_unique<hp_context>();
  hp_init(driver.get());
  hp_begin(driver.get(), &stream);
  hp_set_target(driver.get(), &target);
  hp_clear(driver.get(), HP_CLEAR_COLOR | HP_CLEAR_DEPTH, 0, HP_DEPTH_ONE, 0);

  // Three corners inside; one beyond the near plane, which makes four of them; each beyond the guard band and near or far.
  constexpr hp_fixed kFar = 30000 * HP_ONE;
  constexpr std::array<hp_fixed, 27> kPosition{-HP_ONE, -HP_ONE, 0,          HP_ONE,      -HP_ONE, 0,          0,
                                               HP_ONE,  0,       -HP_ONE,    -HP_ONE,     0,       HP_ONE,     -HP_ONE,
                                               0,       0,       HP_ONE,     -2 * HP_ONE, -kFar,   -kFar,      -2,
                                               kFar,    -kFar,   2 * HP_ONE, 0,           kFar,    -4 * HP_ONE};
  const hp_vertices vertices{kPosition.data(), nullptr, nullptr, 3 * sizeof(hp_fixed), 0, 0, 0, nullptr, 0};
  constexpr std::array<std::uint16_t, 9> kIndices{0, 1, 2, 3, 4, 5, 6, 7, 8};
  const std::array<std::uint32_t, 4> sent{0, 1, 3, 3}, status{0, 0, 0, HP_POLYGON};
  for (std::size_t n = 1; n < 4; ++n) {
    hp_draw(driver.get(), HP_TRIANGLES, &vertices, &kIndices[3 * (n - 1)], 3);
    EXPECT_EQ(hp_count(driver.get())->sent, sent[n]) << n;
    EXPECT_EQ(hp_status(driver.get()), status[n]) << n;
  }
  hp_draw(driver.get(), HP_TRIANGLES, &vertices, nullptr, 3);
  EXPECT_EQ(hp_count(driver.get())->sent, 4U) << "it goes on";
}

}  // namespace
}  // namespace halfplane::test
