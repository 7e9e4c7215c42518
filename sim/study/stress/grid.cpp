#include "sim/study/stress/grid.hpp"

#include <algorithm>

#include "sim/study/stress/unit.hpp"

namespace halfplane::stress {

bool is_legal(const Config& config) {
  try {
    validate(config);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

namespace {

constexpr std::size_t kCombinations = 48;

/// A random legal combination of all relevant settings.
Config random_config(std::uint64_t seed) {
  for (Random random(seed);;) {
    Config config = preset(preset_names()[static_cast<std::size_t>(random.index(4))]);
    config.subpixel_bits = random.index(9);
    config.depth_bits = 8 + random.index(25);
    config.guard_band = 32 << random.index(10);
    config.local_guard_bits = 4 + random.index(9);
    config.reciprocal_extra_bits = 2 + random.index(11);
    config.tile_size = 4 << random.index(4);
    config.stamp_size = 1 << random.index(4);
    config.color_format = random.coin() ? ColorFormat::rgb565 : ColorFormat::rgba8888;
    config.target_width = std::min(config.target_width, config.guard_band);
    config.target_height = std::min(config.target_height, config.guard_band);
    if (is_legal(config)) return config;
  }
}

std::vector<Config> make_grid() {
  std::vector<Config> configs;
  for (const auto name : {"embedded", "full", "tiny", "small"}) configs.push_back(preset(name));
  const auto add = [&configs](std::string_view base, auto&& change) {
    Config config = preset(base);
    change(config);
    if (is_legal(config) && std::find(configs.begin(), configs.end(), config) == configs.end())
      configs.push_back(config);
  };
  for (const std::string_view base : {"embedded", "full"})
    for (int bits = 0; bits <= 8; ++bits) add(base, [bits](Config& c) { c.subpixel_bits = bits; });
  for (int bits = 8; bits <= 32; ++bits) add("embedded", [bits](Config& c) { c.depth_bits = bits; });
  for (int band = 32; band <= 16384; band *= 2)
    add("embedded", [band](Config& c) {
      c.guard_band = band;
      c.target_width = std::min(c.target_width, band);
      c.target_height = std::min(c.target_height, band);
    });
  for (int bits = 4; bits <= 12; ++bits) add("embedded", [bits](Config& c) { c.local_guard_bits = bits; });
  for (int bits = 2; bits <= 12; ++bits) add("embedded", [bits](Config& c) { c.reciprocal_extra_bits = bits; });
  for (const int stamp : {1, 2, 4, 8}) add("embedded", [stamp](Config& c) { c.stamp_size = stamp; });
  for (const int tile : {4, 8, 16, 32})
    add("embedded", [tile](Config& c) {
      c.tile_size = tile;
      c.local_guard_bits = 8;  // needed by the widest of them
    });
  add("embedded", [](Config& c) { c.color_format = ColorFormat::rgba8888; });
  for (std::size_t i = 0; i < kCombinations; ++i) configs.push_back(random_config(i));
  return configs;
}

}  // namespace

const std::vector<Config>& grid() {
  static const std::vector<Config> configs = make_grid();
  return configs;
}

Config config_of(std::uint64_t number) {
  return number < grid().size() ? grid()[static_cast<std::size_t>(number)] : random_config(number);
}

}  // namespace halfplane::stress
