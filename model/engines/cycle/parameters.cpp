#include "parameters.hpp"

#include <array>
#include <string>

namespace halfplane {

std::span<const TimingSetting> timing_settings() {
  using P = TimingParameters;
  static constexpr std::array kSettings{
      TimingSetting{"queue.triangle", "triangles that wait in front of triangle_setup", 0, 1024, &P::triangle_queue,
                    true},
      TimingSetting{"queue.setup", "setups that wait in front of coarse_raster", 0, 1024, &P::setup_queue, true},
      TimingSetting{"queue.tile", "tiles that wait in front of fine_raster", 0, 1024, &P::tile_queue, true},
      TimingSetting{"queue.stamp", "stamps in the buffer behind interpolate", 1, 1024, &P::stamp_queue, false},
      TimingSetting{"queue.fragment", "fragments that wait in front of depth_test", 0, 1024, &P::fragment_queue, true},
      TimingSetting{"divide.bits", "quotient bits that triangle_setup makes in a cycle", 1, 64, &P::divide_bits, true},
      TimingSetting{"hiz.untested", "a triangle of at most so many tiles in x and y reads no HiZ bound", 0, 64,
                    &P::untested_tiles, false},
      TimingSetting{"walk.reject", "1: tiles outside an edge are passed over", 0, 1, &P::rejects, false},
      TimingSetting{"clear.fast", "1: a clear of the whole target marks tiles, 0: it is drawn", 0, 1, &P::fast_clear,
                    false}};
  return kSettings;
}

void validate(const TimingParameters& parameters, const Config& config) {
  const TimingParameters rtl;
  for (const TimingSetting& setting : timing_settings()) {
    const int value = parameters.*setting.member;
    if (value < setting.min || value > setting.max)
      throw InputError(std::string(setting.key) + ": " + std::to_string(value) + " is outside its range; give " +
                       std::to_string(setting.min) + "..." + std::to_string(setting.max));
    if (setting.is_pipelined_only && config.setup_kind == SetupKind::serial && value != rtl.*setting.member)
      throw InputError(std::string(setting.key) + ": the serial stages have no such thing; use setup.kind=pipelined");
  }
}

const TimingSetting* find_timing_setting(std::string_view key) {
  for (const TimingSetting& setting : timing_settings())
    if (setting.key == key) return &setting;
  return nullptr;
}

}  // namespace halfplane
