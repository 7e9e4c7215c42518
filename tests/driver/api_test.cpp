// The driver's interface: refused calls, rings, and pictures of the software backend.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>

#include "../committed.hpp"
#include "driver/backend/draw.hpp"
#include "driver/stream.h"
#include "model/engines/hardware.hpp"
#include "model/generate/c_header.hpp"
#include "model/packets/packet_words.hpp"
#include "sim/scene/host_geometry.hpp"
#include "stream_case.hpp"

namespace halfplane::test {
namespace {

using driver::Decoder;

constexpr std::array<hp_fixed, 12> kSquare{-HP_ONE, -HP_ONE, 0, HP_ONE, -HP_ONE, 0,
                                           -HP_ONE, HP_ONE,  0, HP_ONE, HP_ONE,  0};
constexpr hp_vertices kVertices{kSquare.data(), nullptr, nullptr, 12, 0, 0, 0, nullptr, 0};
const hp_target kTarget = target_of(16, 16);

/// A context with a stream and a target.
class DriverInterface : public testing::Test {
 protected:
  explicit DriverInterface(std::uint32_t size = 4096) : words_(size) {
    hp_init(driver_.get());
    const hp_stream stream{words_.data(), size, nullptr, nullptr};
    hp_begin(driver_.get(), &stream);
    hp_set_target(driver_.get(), &kTarget);
    hp_clear(driver_.get(), HP_CLEAR_COLOR | HP_CLEAR_DEPTH, 0, HP_DEPTH_ONE, 0);
  }

  /// Expects a call to set exactly `status` and to send nothing.
  void expect_refused(std::uint32_t status, const std::function<void(hp_context*)>& call) {
    const auto driver = std::make_unique<hp_context>(*driver_);
    call(driver.get());
    EXPECT_EQ(hp_status(driver.get()), status);
    EXPECT_EQ(hp_written(driver.get()), hp_written(driver_.get()));
  }
  void expect_refused_state(std::uint32_t status, const std::function<void(hp_state&)>& change) {
    SCOPED_TRACE(status);
    hp_state state = hp_default_state();
    change(state);
    expect_refused(status, [&](hp_context* driver) { hp_set_state(driver, &state); });
  }

  std::vector<std::uint32_t> words_;
  std::unique_ptr<hp_context> driver_ = std::make_unique<hp_context>();
};

TEST(DriverConfiguration, TheCommittedHeaderIsWhatTheConfigurationYields) {
  test::expect_committed("driver/halfplane_config.h", [](const auto&) { return c_header(preset("embedded")); });
}

TEST_F(DriverInterface, RefusesValuesOutOfTheirRange) {
  const auto bad = [&](const std::function<void(hp_context*)>& call) { expect_refused(HP_BAD_VALUE, call); };
  const hp_stream none{nullptr, 100, nullptr, nullptr}, tiny{words_.data(), 3, nullptr, nullptr};
  for (const hp_stream& stream : {none, tiny}) bad([&](hp_context* d) { hp_begin(d, &stream); });
  const std::array<std::function<void(hp_target&)>, 13> wrong{
      [](hp_target& t) { t.width = 0; },       [](hp_target& t) { t.height = 0; },
      [](hp_target& t) { t.width = 20000; },   [](hp_target& t) { t.height = 20000; },
      [](hp_target& t) { t.depth = 7; },       [](hp_target& t) { t.color = 1; },
      [](hp_target& t) { t.depth_flags = 1; }, [](hp_target& t) { t.color_flags = 1; },
      [](hp_target& t) { t.row_stride = 3; },  [](hp_target& t) { t.row_stride += 1; },
      [](hp_target& t) { t.row_stride /= 2; }, [](hp_target& t) { t.row_stride += 1U << 20; },
      [](hp_target& t) { t.textures = 2048; }};
  for (const auto& change : wrong) {
    hp_target target = kTarget;
    change(target);
    bad([&](hp_context* d) { hp_set_target(d, &target); });
  }
  for (const std::array<std::uint32_t, 2>& buffer : {std::array{1U, 0U}, {0U, 1U}})
    bad([&](hp_context* d) { hp_present(d, buffer[0], buffer[1]); });
  const hp_viewport whole{0, 0, 16 * HP_ONE, 16 * HP_ONE, 0, HP_DEPTH_ONE, 0};
  const std::array<std::function<void(hp_viewport&)>, 8> changes{
      [](hp_viewport& v) { v.width = 0; },         [](hp_viewport& v) { v.height = -1; },
      [](hp_viewport& v) { v.x = INT32_MIN; },     [](hp_viewport& v) { v.y = INT32_MIN; },
      [](hp_viewport& v) { v.width = INT32_MAX; }, [](hp_viewport& v) { v.height = INT32_MAX; },
      [](hp_viewport& v) { v.near_depth = ~0U; },  [](hp_viewport& v) { v.far_depth = ~0U; }};
  for (const auto& change : changes) {
    hp_viewport viewport = whole;
    change(viewport);
    bad([&](hp_context* d) { hp_set_viewport(d, &viewport); });
  }
  for (const std::array<std::int32_t, 4>& r : std::vector<std::array<std::int32_t, 4>>{{0, 0, -1, 1},
                                                                                       {0, 0, 1, -1},
                                                                                       {-70000, 0, 1, 1},
                                                                                       {0, -70000, 1, 1},
                                                                                       {70000, 0, 1, 1},
                                                                                       {0, 70000, 1, 1},
                                                                                       {0, 0, 70000, 1},
                                                                                       {0, 0, 1, 70000}})
    bad([&](hp_context* d) { hp_set_scissor(d, r[0], r[1], r[2], r[3]); });
  std::array<hp_fixed, 16> large{};
  large[12] = INT32_MIN;
  large[13] = INT32_MAX;
  large[14] = INT32_MAX;
  bad([&](hp_context* d) { hp_set_matrices(d, large.data(), nullptr); });
  bad([&](hp_context* d) { hp_set_matrices(d, nullptr, large.data()); });
  bad([&](hp_context* d) { hp_clear(d, 0, 0, 0, 0); });
  bad([&](hp_context* d) { hp_clear(d, 4, 0, 0, 0); });
  bad([&](hp_context* d) { hp_clear(d, 1, 0, ~0U, 0); });
  const hp_vertices nothing{};
  bad([&](hp_context* d) { hp_draw(d, HP_POINTS, &nothing, nullptr, 1); });
  bad([&](hp_context* d) { hp_draw(d, HP_POINTS, &kVertices, nullptr, 70000); });
  bad([&](hp_context* d) { hp_draw(d, static_cast<hp_topology>(7), &kVertices, nullptr, 1); });
  hp_stream stream{words_.data(), 100, nullptr, nullptr};
  hp_context fresh{};
  hp_init(&fresh);
  hp_begin(&fresh, &stream);
  hp_clear(&fresh, 3, 0, 0, 0);
  hp_draw(&fresh, HP_TRIANGLES, &kVertices, nullptr, 3);
  EXPECT_EQ(hp_status(&fresh), HP_BAD_VALUE) << "no target";
  EXPECT_EQ(hp_written(&fresh), 0U);
}

TEST_F(DriverInterface, RefusesWhatComesBeforeTheClearOrTheFlush) {
  const auto wrong = [&](const std::function<void(hp_context*)>& call) { expect_refused(HP_WRONG_ORDER, call); };
  wrong([](hp_context* d) { hp_present(d, 0, 0); });  // a clear is drawn, and is not flushed
  hp_flush(driver_.get(), 0);
  hp_set_target(driver_.get(), &kTarget);  // which is not cleared
  for (const hp_topology topology : {HP_TRIANGLES, HP_POINTS})
    wrong([&](hp_context* d) { hp_draw(d, topology, &kVertices, nullptr, 3); });
  wrong([](hp_context* d) { hp_flush(d, 0); });
  for (const std::uint32_t half : {HP_CLEAR_DEPTH, HP_CLEAR_COLOR})
    wrong([&](hp_context* d) { hp_clear(d, half, 0, 0, 0); });
  hp_set_scissor(driver_.get(), 1, 0, 99, 99);
  wrong([](hp_context* d) { hp_clear(d, HP_CLEAR_DEPTH | HP_CLEAR_COLOR, 0, 0, 0); });
  hp_set_scissor(driver_.get(), 0, 0, 16, 16);
  hp_clear(driver_.get(), HP_CLEAR_DEPTH | HP_CLEAR_COLOR, 0, 0, 0);
  hp_draw(driver_.get(), HP_TRIANGLES, &kVertices, nullptr, 3);
  hp_flush(driver_.get(), 0);
  hp_present(driver_.get(), 0, 0);
  EXPECT_EQ(hp_status(driver_.get()), 0U);
}

TEST_F(DriverInterface, AFlushWithoutRoomIsStillToCome) {
  const hp_stream stream{words_.data(), 64, nullptr, nullptr};
  hp_begin(driver_.get(), &stream);
  hp_set_target(driver_.get(), &kTarget);
  hp_clear(driver_.get(), 3, 0, 0, 0);
  while (hp_written(driver_.get()) < 64) hp_wait_vblank(driver_.get());
  ASSERT_EQ(hp_status(driver_.get()), 0U);
  hp_flush(driver_.get(), 0);
  EXPECT_EQ(hp_status(driver_.get()), HP_FULL);
  hp_present(driver_.get(), 0, 0);
  EXPECT_EQ(hp_status(driver_.get()), HP_FULL | HP_WRONG_ORDER);
}

TEST_F(DriverInterface, RefusesStates) {
  const Config& config = driver_config();
  hp_texture texture{0, 0, 4, 4, 0};
  const std::vector<std::function<void(hp_state&)>> bad{
      [](hp_state& s) { s.depth_test = 8; }, [](hp_state& s) { s.cull = 4; },
      [](hp_state& s) { s.front = 2; },      [](hp_state& s) { s.color_mask = 16; },
      [](hp_state& s) { s.logic_op = 16; },  [](hp_state& s) { s.line_rule = 3; },
      [](hp_state& s) { s.line_width = 0; }, [](hp_state& s) { s.line_width = 60000; },
      [](hp_state& s) { s.point_size = 0; }, [](hp_state& s) { s.point_size = INT32_MAX - 65535; }};
  for (const auto& change : bad) expect_refused_state(HP_BAD_VALUE, change);
  const std::vector<std::function<void(hp_state&)>> bad_texture{
      [&](hp_state&) { texture.log2_width = 13; }, [&](hp_state&) { texture.log2_height = 13; },
      [&](hp_state&) { texture.format = 6; },      [&](hp_state&) { texture.address = 32; },
      [&](hp_state&) { texture.levels = 6; },      [](hp_state& s) { s.levels = 3; },
      [](hp_state& s) { s.level_bias = 5000; },    [](hp_state& s) { s.level_bias = -5000; },
      [](hp_state& s) { s.least_level = 4000; },   [](hp_state& s) { s.largest_level = 4000; },
      [](hp_state& s) { s.wrap_u = 5; },           [](hp_state& s) { s.wrap_v = 5; },
      [](hp_state& s) { s.combine = 5; },          [](hp_state& s) { s.is_affine = s.perspective_colors = 1; }};
  for (const auto& change : bad_texture)
    expect_refused_state(HP_BAD_VALUE, [&](hp_state& s) {
      texture = {0, 0, 4, 4, 0};
      s.texture = &texture;
      change(s);
    });
  texture = {0, 0, 4, 4, 0};
  if (config.texture_unit == TextureUnitKind::off)
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture; });
  if (config.texture_unit == TextureUnitKind::nearest)
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture, s.is_linear = 1; });
  if (config.texture_unit == TextureUnitKind::bilinear || config.texture_unit == TextureUnitKind::nearest) {
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture, s.levels = HP_TWO_LEVELS; });
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture, s.minifies_otherwise = 1; });
    texture.levels = 2;
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture; });
    texture.levels = 0;
  }
  if (config.texture_constants == 0)
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture, s.combine = HP_BLEND_COLOR; });
  if (config.texture_borders == 0) {
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture, s.wrap_u = HP_BORDER; });
    expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.texture = &texture, s.wrap_v = HP_HALF_BORDER; });
  }
  if (config.logic_units == 0) expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.logic_op = HP_LOGIC_XOR; });
  if (config.perspective_colors == 0)
    expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.perspective_colors = 1; });
  if (config.stencil_bits == 0) expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.has_stencil = 1; });
  const hp_fog_line line{0, 0};
  const hp_fog fog{&line, 0, 0}, no_lines{nullptr, 0, 0}, too_many{&line, 0, 5};
  if (config.fog_units == 0) expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.fog = &fog; });
  expect_refused_state(HP_BAD_VALUE, [&](hp_state& s) { s.fog = &no_lines; });
  expect_refused_state(HP_BAD_VALUE, [&](hp_state& s) { s.fog = &too_many; });
  expect_refused_state(HP_BAD_VALUE, [&](hp_state& s) { s.texture = &texture, s.is_affine = 1, s.fog = &fog; });
  const hp_light_line light_line{0, 0};
  const hp_light light{{}, {}, 0, 0, 0, &light_line, 7}, dark{{}, {}, 0, 0, 0, nullptr, 0},
      narrow{{}, {}, 0, 0, 0, &light_line, 8};
  if (!has_normals(config)) expect_refused_state(HP_UNSUPPORTED, [&](hp_state& s) { s.light = &light; });
  for (const hp_light* wrong : {&dark, &narrow})
    expect_refused_state(HP_BAD_VALUE, [&](hp_state& s) { s.light = wrong; });
  expect_refused_state(HP_BAD_VALUE, [&](hp_state& s) { s.texture = &texture, s.is_affine = 1, s.light = &light; });
  if (config.alpha_units == 0) expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.alpha_func = HP_LESS; });
  if (config.msaa_samples == 1) expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.sample_mask = 1; });
  if (config.msaa_samples == 1 || !tests_alpha(config))
    expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.alpha_to_coverage = 1; });
  if (config.dither_units == 0 && config.color_format == ColorFormat::rgb565)
    expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.dithers = 1; });
  if (config.blend_lanes == 0) {
    expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.blends = 1; });
    expect_refused_state(HP_UNSUPPORTED, [](hp_state& s) { s.color_mask = 1; });
  }
  if (config.line_units == 0)
    expect_refused(HP_UNSUPPORTED, [](hp_context* d) { hp_draw(d, HP_LINES, &kVertices, nullptr, 2); });
}

TEST_F(DriverInterface, LeavesOutVerticesBeyondItsNumbers) {
  const std::array<hp_fixed, 9> far{INT32_MAX, 0, 0, 0, INT32_MAX, 0, 0, 0, 0};
  const hp_vertices vertices{far.data(), nullptr, nullptr, 12, 0, 0, 0, nullptr, 0};
  std::array<hp_fixed, 16> twice{};
  for (const std::size_t i : {0U, 5U, 10U, 15U}) twice[i] = 2 * HP_ONE;
  for (const bool is_view : {true, false}) {
    const auto driver = std::make_unique<hp_context>(*driver_);
    hp_set_matrices(driver.get(), is_view ? twice.data() : nullptr, is_view ? nullptr : twice.data());
    hp_draw(driver.get(), HP_TRIANGLES, &vertices, nullptr, 3);
    EXPECT_EQ(hp_count(driver.get())->sent, 0U);
    hp_draw(driver.get(), HP_POINTS, &vertices, nullptr, 3);
    EXPECT_EQ(hp_count(driver.get())->sent, 1U) << "the last one is in range";
    const std::uint32_t before = hp_count(driver.get())->sent;
    const std::array<hp_fixed, 15> near{0, 0, 0, 9000, 0, 0, 0, 9000, 0, INT32_MAX, 0, 0, 9000, 9000, 0};
    const hp_vertices strip{near.data(), nullptr, nullptr, 12, 0, 0, 0, nullptr, 0};
    hp_draw(driver.get(), HP_TRIANGLE_STRIP, &strip, nullptr, 5);
    EXPECT_EQ(hp_count(driver.get())->sent, before + 1) << "the others have the fourth one";
    if (driver_config().line_units != 0) {
      hp_draw(driver.get(), HP_LINES, &vertices, nullptr, 2);
      EXPECT_EQ(hp_count(driver.get())->sent, before + 1);
    }
    EXPECT_EQ(hp_status(driver.get()), HP_OUT_OF_RANGE);
  }
}

/// In each place of a triangle, by the affine view, the perspective division's product, and w itself.
TEST_F(DriverInterface, LeavesOutTrianglesWithAVertexBeyondItsNumbers) {
  std::array<hp_fixed, 16> twice{}, none{}, perspective{};
  for (const std::size_t i : {0U, 5U, 10U}) twice[i] = 2 * HP_ONE, none[i] = perspective[i] = HP_ONE;
  twice[15] = none[15] = HP_ONE;
  perspective[14] = -HP_ONE;
  const auto draw = [&](const std::array<hp_fixed, 16>& view, const hp_fixed* projection, const hp_fixed far_corner[3],
                        std::size_t place, std::uint16_t step) {
    SCOPED_TRACE(place);
    const auto driver = std::make_unique<hp_context>(*driver_);
    std::vector<hp_fixed> position(3 * (2U * step + 1), -HP_ONE);
    std::copy_n(far_corner, 3, position.begin() + static_cast<std::ptrdiff_t>(3 * place * step));
    const hp_vertices vertices{position.data(), nullptr, nullptr, 12, 0, 0, 0, nullptr, 0};
    const std::array<std::uint16_t, 3> indices{0, step, static_cast<std::uint16_t>(2 * step)};
    hp_set_matrices(driver.get(), view.data(), projection);
    hp_draw(driver.get(), HP_TRIANGLES, &vertices, indices.data(), 3);
    EXPECT_EQ(hp_count(driver.get())->sent, 0U);
    EXPECT_EQ(hp_status(driver.get()), HP_OUT_OF_RANGE);
  };
  const hp_fixed far_x[]{INT32_MAX, 0, -HP_ONE}, far_z[]{0, 0, INT32_MIN};
  for (const std::size_t place : {0U, 1U, 2U})
    for (const std::uint16_t step : {std::uint16_t{1}, std::uint16_t{16}}) {  // 16: all share an entry of the cache
      draw(twice, nullptr, far_x, place, step);
      draw(none, perspective.data(), far_z, place, step);
      perspective[0] = 2 * HP_ONE;
      draw(none, perspective.data(), far_x, place, step);
      perspective[0] = HP_ONE;
    }
}

/// An affine view of vertices with a w of their own: w is 1 with and without them.
TEST_F(DriverInterface, AWOfOneIsThatOfVerticesWithoutW) {
  std::array<hp_fixed, 16> view{};
  for (const std::size_t i : {0U, 5U, 10U}) view[i] = HP_ONE / 3;
  view[3] = 4321, view[7] = -9876, view[15] = HP_ONE;
  std::array<hp_fixed, 16> with_w{};
  for (std::size_t i = 0; i < 16; ++i) with_w[i] = i % 4 == 3 ? HP_ONE : kSquare[i / 4 * 3 + i % 4];
  const hp_vertices vertices{with_w.data(), nullptr, nullptr, 16, 0, 0, 1, nullptr, 0};
  hp_set_matrices(driver_.get(), view.data(), nullptr);
  std::array<std::uint32_t, 3> end{hp_written(driver_.get())};
  hp_draw(driver_.get(), HP_TRIANGLE_STRIP, &kVertices, nullptr, 4);  // which sends the state as well
  for (std::size_t n = 0; n < 2; ++n) {
    end[n] = hp_written(driver_.get());
    hp_draw(driver_.get(), HP_TRIANGLE_STRIP, n == 0 ? &kVertices : &vertices, nullptr, 4);
  }
  end[2] = hp_written(driver_.get());
  ASSERT_GT(end[1], end[0]);
  EXPECT_TRUE(std::equal(&words_[end[0]], &words_[end[1]], &words_[end[1]], &words_[end[2]]));
  EXPECT_EQ(hp_count(driver_.get())->sent, 6U);
}

/// Of internal.h. Quotients of what is inside of the guard band are far from 2^32, with any guard band but the widest.
extern "C" std::int64_t hp_divide_rounded(std::int64_t n, std::uint32_t d);

TEST(DriverArithmetic, DividesAndRounds) {
  Random random(1);
  const auto number = [&](double bits) { return std::exp2(random.between(0, bits)); };
  int beyond = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto d = static_cast<std::uint32_t>(number(31.9));
    auto n = static_cast<std::int64_t>(number(62)) * (random.index(2) != 0 ? -1 : 1);
    if (random.index(4) == 0) n = n / d * d + random.index(3) - 1 + (random.index(2) != 0 ? d / 2 : 0);  // about a tie
    const std::int64_t twice = 2 * (n % d), whole = n / d;
    const std::int64_t exact = whole + (twice >= d ? 1 : twice < -std::int64_t{d} ? -1 : 0);  // floor(n / d + 1/2)
    const std::int64_t quotient = hp_divide_rounded(n, d);
    if (exact > -(std::int64_t{1} << 32) && exact < std::int64_t{1} << 32) {
      ASSERT_EQ(quotient, exact) << n << " / " << d;
    } else {
      ASSERT_TRUE(exact < 0 ? quotient <= -(std::int64_t{1} << 32) : quotient >= std::int64_t{1} << 32);
      ++beyond;
    }
  }
  EXPECT_GT(beyond, 1000);
}

TEST_F(DriverInterface, WithoutAStreamThereIsNoRoom) {
  hp_init(driver_.get());
  hp_fence(driver_.get(), 1);
  EXPECT_EQ(hp_status(driver_.get()), HP_FULL);
  EXPECT_EQ(hp_written(driver_.get()), 0U);
}

TEST_F(DriverInterface, LinesAndPointsThatDoNotFitAreLeftOut) {
  std::vector<std::uint16_t> indices(16384);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i % 4;
  for (const hp_topology topology : {HP_LINES, HP_POINTS}) {
    if (topology == HP_LINES && driver_config().line_units == 0) continue;
    const auto driver = std::make_unique<hp_context>(*driver_);
    hp_draw(driver.get(), topology, &kVertices, indices.data(), 16384);
    EXPECT_EQ(hp_status(driver.get()), HP_FULL);
    EXPECT_LE(hp_written(driver.get()), 4096U);
    EXPECT_GT(hp_written(driver.get()), 4000U);
  }
}

TEST_F(DriverInterface, AStripCostsOneVertexATriangle) {
  std::vector<hp_fixed> position;
  for (int i = 0; i < 40; ++i)
    position.insert(position.end(), {(i - 20) * HP_ONE / 32, (i % 2 * 2 - 1) * HP_ONE / 2, 0});
  const hp_vertices vertices{position.data(), nullptr, nullptr, 12, 0, 0, 0, nullptr, 0};
  hp_draw(driver_.get(), HP_TRIANGLE_STRIP, &vertices, nullptr, 40);
  EXPECT_EQ(hp_count(driver_.get())->sent, 38U);
  EXPECT_EQ(hp_count(driver_.get())->vertices, 40U);
  EXPECT_EQ(hp_count(driver_.get())->transformed, 40U);
  hp_draw(driver_.get(), HP_TRIANGLE_FAN, &vertices, nullptr, 17);
  EXPECT_EQ(hp_count(driver_.get())->transformed, 58U) << "the first one once more: the cache has 16";
}

TEST_F(DriverInterface, WordsThatDoNotFitAreLeftOut) {
  const hp_stream stream{words_.data(), 64, nullptr, nullptr};
  hp_begin(driver_.get(), &stream);
  hp_set_target(driver_.get(), &kTarget);
  hp_clear(driver_.get(), 3, 0, 0, 0);
  std::uint32_t fences = 0;
  while (hp_status(driver_.get()) == 0) hp_fence(driver_.get(), ++fences);
  EXPECT_EQ(hp_status(driver_.get()), HP_FULL);
  EXPECT_LE(hp_written(driver_.get()), 64U);
  const std::uint32_t before = hp_written(driver_.get());
  hp_set_target(driver_.get(), &kTarget);
  hp_clear(driver_.get(), 3, 0, 0, 0);
  hp_set_scissor(driver_.get(), 1, 1, 3, 3);
  hp_clear(driver_.get(), 3, 0, 0, 0);
  for (const hp_topology topology : {HP_TRIANGLES, HP_POINTS}) hp_draw(driver_.get(), topology, &kVertices, nullptr, 3);
  EXPECT_LE(hp_written(driver_.get()), before + 1) << "a flush of one word, if at all";
  Decoder decoder(driver_config());
  decoder.read(std::span(words_).first(before));
  EXPECT_EQ(decoder.fences().size(), fences - 1);
}

/// A core that reads a ring in steps.
struct Ring {
  std::vector<std::uint32_t> words = std::vector<std::uint32_t>(80), taken;
  std::uint32_t read = 0;
  int waits = 0;
  bool is_stuck = false;

  void take(std::uint32_t written) {
    for (; read != written; ++read) taken.push_back(words[read % words.size()]);
  }
  static std::uint32_t wait(void* user, std::uint32_t written) {
    auto* ring = static_cast<Ring*>(user);
    ++ring->waits;
    if (!ring->is_stuck) ring->take(written);
    return ring->read;
  }
};

TEST_F(DriverInterface, ARingHasTheSameWords) {
  Ring ring;
  const auto draw = [&](const hp_stream& stream) {
    hp_begin(driver_.get(), &stream);
    hp_set_target(driver_.get(), &kTarget);
    hp_clear(driver_.get(), 3, 7, 9, 0);
    for (int i = 0; i < 30; ++i) hp_draw(driver_.get(), HP_TRIANGLE_STRIP, &kVertices, nullptr, 4);
    hp_flush(driver_.get(), 1);
    hp_present(driver_.get(), 1U << 16, 1U << 17);
    hp_wait_vblank(driver_.get());
    hp_stop(driver_.get());
  };
  draw({ring.words.data(), static_cast<std::uint32_t>(ring.words.size()), Ring::wait, &ring});
  ring.take(hp_written(driver_.get()));
  EXPECT_GT(ring.waits, 2);
  draw({words_.data(), static_cast<std::uint32_t>(words_.size()), nullptr, nullptr});
  words_.resize(hp_written(driver_.get()));
  EXPECT_EQ(ring.taken, words_);
  EXPECT_EQ(hp_status(driver_.get()), 0U);
  Ring stuck;
  stuck.is_stuck = true;
  draw({stuck.words.data(), static_cast<std::uint32_t>(stuck.words.size()), Ring::wait, &stuck});
  EXPECT_EQ(hp_status(driver_.get()), HP_FULL);
}

TEST_F(DriverInterface, MultipliesMatrices) {
  std::array<hp_fixed, 16> a{}, b{}, out{};
  for (std::size_t i = 0; i < 16; ++i) {
    a[i] = static_cast<hp_fixed>(i * 9000) - 70000;
    b[i] = 50000 - static_cast<hp_fixed>(i * 7001);
  }
  hp_multiply(out.data(), a.data(), b.data());
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) sum += static_cast<double>(a[4 * row + i]) * b[4 * i + column];
      EXPECT_EQ(out[4 * row + column], std::floor(sum / 65536 + 0.5));
    }
}

/// A clear or a draw where there is nothing to draw sends nothing; another target flushes the previous one.
TEST_F(DriverInterface, AnEmptyScissorDrawsNothing) {
  hp_set_scissor(driver_.get(), 3, 3, 0, 5);
  const std::uint32_t before = hp_written(driver_.get());
  hp_draw(driver_.get(), HP_TRIANGLES, &kVertices, nullptr, 3);
  hp_clear(driver_.get(), 3, 0, 0, 0);
  hp_set_scissor(driver_.get(), 3, 3, 5, 0);
  hp_draw(driver_.get(), HP_TRIANGLES, &kVertices, nullptr, 3);
  hp_clear(driver_.get(), 3, 0, 0, 0);
  EXPECT_EQ(hp_written(driver_.get()), before);
  hp_set_target(driver_.get(), &kTarget);
  EXPECT_EQ(words_[before], HP_HEADER(HP_FLUSH, 0));
}

/// The backend's picture of a stream is the hardware model's of the scene.
TEST(DriverBackend, DrawsThePictureOfTheScene) {
  const Config& config = driver_config();
  for (std::uint32_t seed = 100; seed < 105; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StreamCase made = random_case(seed, 60);
    const Framebuffer frame = driver::draw(made.words, config, made.textures);
    const Rendering wanted = render_hardware(in_host_numbers(made.scene, TransformNumbers::s15_16, config), config);
    ASSERT_EQ(frame.width, made.scene.width);
    ASSERT_EQ(frame.color, wanted.frame.color);
    ASSERT_EQ(frame.depth, wanted.frame.depth);
    EXPECT_NE(std::ranges::count(frame.color, frame.color[0]), static_cast<std::ptrdiff_t>(frame.color.size()));
  }
}

int affine_bits() {
  const Widths widths = derive_widths(driver_config());
  int bits = 0;
  for (int p = 0; p < widths.affine_planes; ++p) bits += widths.of_plane(static_cast<std::size_t>(p)).code.bits;
  return bits;
}

/// Words of a frame of 8x8 pixels up to the first clear, with a box and a state.
std::vector<std::uint32_t> begun() {
  std::vector<std::uint32_t> words{HP_SET_OF(HP_BOX_MIN, 10),  0, 0x70007, 0x19, 0x70007, 0, 0, 0, 0, 0x800, 0,
                                   HP_HEADER(HP_FAST_CLEAR, 3)};
  words.resize(words.size() + words_of(affine_bits()));
  return words;
}

/// The words after begun(), and the error at which of them, counted from 1. tests/core/test_backend_decoder.py holds
/// all errors against the core's decoder.
TEST(DriverBackend, RefusesWordsThatTheCoreRefuses) {
  const auto refused = [](std::uint32_t error, std::uint32_t word, const std::vector<std::uint32_t>& more) {
    std::vector<std::uint32_t> words = begun();
    const auto before = static_cast<std::uint32_t>(words.size());
    words.insert(words.end(), more.begin(), more.end());
    Decoder decoder(driver_config());
    try {
      decoder.read(words);
      ADD_FAILURE() << "error " << error << " is not seen";
    } catch (const driver::RefusedWord& said) {
      EXPECT_EQ(said.error, error);
      EXPECT_EQ(said.words, before + word);
      EXPECT_NE(std::string(said.what()).find("word " + std::to_string(before + word) + " of"), std::string::npos);
    }
  };
  const std::uint32_t nop = HP_HEADER(HALFPLANE_COMMAND_NOP, 0), flush = HP_HEADER(HP_FLUSH, 0);
  refused(HALFPLANE_ERROR_UNKNOWN_OPCODE, 1, {0xff000000});
  for (const std::uint32_t header : {HP_HEADER(HP_FENCE, 1), HP_HEADER(HP_FLUSH, 2), HP_HEADER(HP_TRIANGLE, 0x107),
                                     HP_SET_OF(4, 5) | 1U << 16, HP_HEADER(HP_FAST_CLEAR, 0), nop | 1})
    refused(HALFPLANE_ERROR_RESERVED, 2, {nop, header});
  refused(HALFPLANE_ERROR_BAD_REGISTER, 1, {HP_SET_OF(0, 0)});
  refused(HALFPLANE_ERROR_BAD_REGISTER, 1, {HP_SET_OF(9, 2), 0, 0});
  refused(HALFPLANE_ERROR_NOT_FLUSHED, 2, {HP_SET_OF(HP_TARGET, 1), 0});
  refused(HALFPLANE_ERROR_NO_CLEAR, 4, {flush, HP_SET_OF(HP_TARGET, 1), 0, HP_HEADER(HP_RECTANGLE, 0)});
  refused(HALFPLANE_ERROR_BAD_BOX, 3, {HP_SET_OF(HALFPLANE_STATE_REGISTER_BOX_MAX, 1), 8, HP_HEADER(HP_POINT, 0)});
  const Config& config = driver_config();
  if (config.cache_kind == CacheKind::tiles) {
    for (const std::uint32_t header :
         {HP_HEADER(HP_FLUSH, 1), HP_HEADER(HP_FAST_CLEAR, 11), HP_HEADER(HP_FAST_CLEAR, 6)})
      refused(HALFPLANE_ERROR_NOT_SUPPORTED, 1, {header});
  } else {
    refused(HALFPLANE_ERROR_RESERVED, 1, {HP_HEADER(HP_FAST_CLEAR, 7)});
    refused(HALFPLANE_ERROR_BAD_BOX, 3, {HP_SET_OF(HP_BOX_MIN, 1), 8, HP_HEADER(HP_FAST_CLEAR, 6)});
  }
  if (config.line_units == 0) refused(HALFPLANE_ERROR_NOT_SUPPORTED, 1, {HP_HEADER(HP_LINE, 0)});
  const auto refuses_registers = [&](std::initializer_list<std::uint32_t> registers) {
    for (const std::uint32_t which : registers) refused(HALFPLANE_ERROR_NOT_SUPPORTED, 1, {HP_HEADER(HP_TOKEN, which)});
  };
  if (config.texture_unit == TextureUnitKind::off) {
    refused(HALFPLANE_ERROR_NOT_SUPPORTED, 1, {HP_HEADER(HP_TRIANGLE, 0x17)});
    refuses_registers({0, 1, 2});
  }
  if (config.stencil_bits == 0) refuses_registers({3, 7});
  if (config.blend_lanes == 0 && config.dither_units == 0) refuses_registers({4, 5});
  if (config.alpha_units == 0) refuses_registers({6});
}

/// Errors that the core does not check, and words without meaning: one line, and no picture.
TEST(DriverBackend, RefusesWhatTheCoreDrawsUndefined) {
  const Config& config = driver_config();
  const auto refused = [&](const std::vector<std::uint32_t>& words, const std::string& why) {
    try {
      (void)driver::draw(words, config);
      ADD_FAILURE() << why;
    } catch (const driver::RefusedWord& said) {
      ADD_FAILURE() << said.what();
    } catch (const InputError& said) {
      EXPECT_NE(std::string(said.what()).find(why), std::string::npos) << said.what();
    }
  };
  const auto after = [](std::vector<std::uint32_t> more) {
    std::vector<std::uint32_t> words = begun();
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  refused({}, "no words");
  refused({HP_HEADER(HALFPLANE_COMMAND_NOP, 0)}, "draw nothing");
  refused(after({HP_HEADER(HP_FENCE, 0)}), "ends inside a command");
  refused(after({HP_HEADER(HP_TRIANGLE, 0)}), "slot 0 holds no vertex");
  refused(after({HP_HEADER(HP_FLUSH, 0), HP_SET_OF(HP_TARGET, 1), 0x0fff0fff}),
          "4096x4096, and this configuration has");
  refused({HP_SET_OF(HP_TARGET, 1), 0x70007, HP_HEADER(HP_FAST_CLEAR, 3)}, "state register 4 was never set");
  // A flush overwrites the slots.
  std::vector<std::uint32_t> drawn = after({HP_HEADER(HP_TRIANGLE, 7)});
  drawn.resize(drawn.size() + 3 * (1 + words_of(affine_bits())));
  drawn.push_back(HP_HEADER(HP_TRIANGLE, 0));
  EXPECT_NO_THROW((void)driver::draw(drawn, config));
  drawn.insert(drawn.end() - 1, HP_HEADER(HP_FLUSH, 0));
  refused(drawn, "slot 0 holds no vertex");
  if (config.line_units == 0) return;
  const Widths widths = derive_widths(config);
  const auto line_words = words_of(packet_bits<LineSetup>(widths) - widths.primitive_id.bits);
  for (const std::uint32_t garbage : {0xffffffffU, 0x12345678U}) {
    std::vector<std::uint32_t> line(1, HP_HEADER(HP_LINE, 0));
    line.resize(1 + line_words, garbage);
    refused(after(line), "a LINE whose setup is none");
  }
}

/// Words after a STOP belong to the next start; NOP is a command.
TEST(DriverBackend, StopsAtAStopAndGoesOnAfterIt) {
  std::vector<std::uint32_t> words = begun();
  words.insert(words.end(),
               {HP_HEADER(HALFPLANE_COMMAND_NOP, 0), HP_HEADER(HP_STOP, 0), HP_HEADER(HP_FENCE, 0), 5, 0xffffffff});
  Decoder decoder(driver_config());
  const std::size_t taken = decoder.read(words);
  EXPECT_EQ(taken, words.size() - 3);
  EXPECT_TRUE(decoder.fences().empty());
  try {
    decoder.read(std::span(words).subspan(taken));
    ADD_FAILURE();
  } catch (const driver::RefusedWord& said) {
    EXPECT_EQ(said.words, words.size());
  }
  EXPECT_EQ(decoder.fences(), std::vector{5U});
}

}  // namespace
}  // namespace halfplane::test
