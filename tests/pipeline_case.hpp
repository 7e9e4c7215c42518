// Any bytes as a configuration and a capture, and the properties required of every one: the engines agree with each
// other for every setting of skips, and with oracle and golden within the bounds. Shared by the fuzzer and by the test
// that replays its corpus.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "model/capture/capture.hpp"
#include "model/capture/capture_states.hpp"
#include "model/config.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/functional/kernels.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/widths.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::test {

struct PipelineCase {
  Config config;
  std::string capture;  ///< text
  int stalls = 0;       ///< chance of a stall in the cycle engine, percent
};

/// Bytes in, choices out; zeros when they are used up.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }

  std::uint32_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint32_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  std::uint32_t word() {
    const std::uint32_t high = byte();
    return high << 8 | byte();
  }
  int between(int low, int high) { return low + static_cast<int>(byte() % static_cast<std::uint32_t>(high - low + 1)); }
  template <std::size_t N>
  const char* pick(const std::array<const char*, N>& names) {
    return names[byte() % N];
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// Writes a capture as the bytes say.
class CaptureFromBytes {
 public:
  CaptureFromBytes(ByteSource& bytes, const Config& config) : bytes_(bytes), config_(config) {}

  std::string text() {
    width_ = bytes_.between(1, std::min(100, config_.target_width));
    height_ = bytes_.between(1, std::min(72, config_.target_height));
    line("halfplane 1");
    line("target " + std::to_string(width_) + " " + std::to_string(height_));
    set_space();
    constexpr int kMost = 24;
    for (int made = 0; made < kMost && !bytes_.is_empty(); ++made) {
      const std::uint32_t choice = bytes_.byte() % 16;
      if (choice < 9)
        primitive();
      else if (choice < 14)
        set_state();
      else if (choice == 14)
        set_space();
      else
        clear();
    }
    return std::move(text_);
  }

 private:
  void line(const std::string& what) { text_ += what + "\n"; }

  static std::string exact(double value) {
    std::array<char, 40> text;
    std::snprintf(text.data(), text.size(), "%a", value);
    return text.data();
  }

  void set_space() {
    is_clip_ = bytes_.byte() % 4 == 3;
    line(is_clip_ ? "space clip" : "space window");
  }

  void clear() {
    line("clear color " + std::to_string(bytes_.byte()) + " " + std::to_string(bytes_.byte()) + " 40 255 depth " +
         exact(bytes_.byte() / 255.0));
  }

  void set_state() {
    const auto states = capture_states();
    const DrawState& row = states[bytes_.byte() % states.size()];
    State state;
    row.set(state, random_value(row, [this](std::uint32_t n) { return bytes_.byte() % n; }));
    std::string text = "state " + std::string(row.name);
    write_state_value(state, row, {}, text);
    line(text);
  }

  /// Coordinates: anywhere near the target, on pixel centres and half-edge points, beside the vertex before, or anywhere
  /// in the guard band.
  double coordinate(int size, double before) {
    const double subpixel = std::ldexp(1.0, -config_.subpixel_bits);
    const int raw = static_cast<int>(bytes_.word());
    switch (raw & 3) {
      case 0: return (raw >> 2) % (2 * (size + 8)) / 2.0 - 4;
      case 1: return before + ((raw >> 2) % 17 - 8) * subpixel;
      case 2: return std::ldexp((raw >> 2) % ((size + 8) << 8), -8) - 4;
      default: return std::ldexp((raw >> 2) - 8192, -13) * (config_.guard_band - 1);
    }
  }

  double depth() {
    const std::uint32_t raw = bytes_.word();
    if (raw % 8 == 0) return raw % 16 == 0 ? 1.0 : 0.0;
    return raw / 65535.0;
  }

  void vertex() {
    x_ = coordinate(width_, x_);
    y_ = coordinate(height_, y_);
    std::string text = "v ";
    if (is_clip_) {
      const std::uint32_t raw = bytes_.byte();  // w: around 1, sometimes 0 or behind the eye
      const double w = raw % 8 == 7 ? static_cast<int>(raw >> 3) / 8.0 - 2 : 1 + raw / 64.0;
      text += exact((x_ / width_ * 2 - 1) * w) + " " + exact((1 - y_ / height_ * 2) * w) + " " +
              exact((depth() * 2.5 - 1.25) * w) + " " + exact(w);
    } else {
      const auto held = [this](double v) {
        return exact(std::clamp(v, 1.0 - config_.guard_band, config_.guard_band - 1.0));
      };
      text += held(x_) + " " + held(y_) + " " + exact(depth()) + " 1";
    }
    std::string normal = "a normal";  // of shade phong, from the same bytes
    for (int c = 0; c < 4; ++c) {
      const int byte = bytes_.byte();
      text += " " + std::to_string(byte);
      if (c < 3) normal += " " + std::to_string(byte - 128);
    }
    line(text);
    line(normal);
    ++vertices_;
  }

  void primitive() {
    constexpr std::array kKinds{"t", "t", "t", "ts", "tf", "l", "ls", "p"};
    const std::string kind = bytes_.pick(kKinds);
    const int corners = kind == "t" ? 3 : kind == "l" ? 2 : kind == "p" ? 1 : bytes_.between(3, 6);
    const int shared = vertices_ >= 2 && bytes_.byte() % 3 == 0 ? 2 : 0;  // a common edge
    std::string text = kind;
    const int first = vertices_ - shared;
    for (int i = shared; i < std::max(corners, shared); ++i) vertex();
    for (int i = 0; i < corners; ++i) text += " " + std::to_string(std::min(first + i, vertices_ - 1));
    line(text);
  }

  ByteSource& bytes_;
  const Config& config_;
  std::string text_;
  int width_ = 1, height_ = 1, vertices_ = 0;
  bool is_clip_ = false;
  double x_ = 0, y_ = 0;
};

/// A preset with some settings changed, if it may be changed so.
inline Config config_from(ByteSource& bytes) {
  Config base = preset(preset_names()[bytes.byte() % preset_names().size()]);
  Config config = base;
  if (bytes.byte() % 2 != 0) config.subpixel_bits = bytes.between(0, 8);
  if (bytes.byte() % 2 != 0) config.depth_bits = bytes.between(8, 24);
  if (bytes.byte() % 4 == 1) config.local_guard_bits = bytes.between(4, 12);
  if (bytes.byte() % 4 == 1) config.tile_size = 1 << bytes.between(2, 5);
  if (bytes.byte() % 4 == 1) config.stamp_size = 1 << bytes.between(0, 2);
  if (bytes.byte() % 4 == 1) config.hiz_bits = bytes.between(0, config.depth_bits);
  if (bytes.byte() % 4 == 1) config.color_format = ColorFormat::rgba8888;
  const std::uint8_t setup = bytes.byte() % 4;
  if (setup == 1) config.setup_kind = SetupKind::serial;
  if (setup == 2) config.setup_plane_clocks = 2;
  try {
    validate(config);
  } catch (const InputError&) {
    return base;
  }
  return config;
}

inline PipelineCase pipeline_case(std::span<const std::uint8_t> data) {
  ByteSource bytes(data);
  PipelineCase result;
  result.config = config_from(bytes);
  result.stalls = bytes.byte() % 4 == 1 ? bytes.between(1, 60) : 0;
  result.capture = CaptureFromBytes(bytes, result.config).text();
  return result;
}

/// An engine's result for a scene: an image, or one line that refuses it.
struct Outcome {
  std::optional<Rendering> rendering;
  std::string refusal;
};

inline Outcome outcome_of(const std::function<Rendering()>& engine) {
  try {
    return {engine(), {}};
  } catch (const InputError& error) {
    return {std::nullopt, error.what()};
  }
}

/// How the second differs from the first; nothing when it does not.
inline std::string difference(const Outcome& a, const Outcome& b, bool same_coverage) {
  if (a.refusal != b.refusal) return "one says '" + a.refusal + "', the other '" + b.refusal + "'";
  if (!a.rendering) return {};
  const Rendering &p = *a.rendering, &q = *b.rendering;
  if (p.frame.depth != q.frame.depth) return "the depths differ";
  if (p.frame.color != q.frame.color) return "the colours differ";
  if (p.counters.depth_passed != q.counters.depth_passed) return "depth_passed differs";
  if (p.counters.written != q.counters.written) return "written differs";
  if (p.counters.primitives_in != q.counters.primitives_in) return "primitives_in differs";
  if (same_coverage && p.counters.covered != q.counters.covered) return "covered differs";
  return {};
}

/// The first broken property of the case; empty when all hold.
inline std::string pipeline_fault(const PipelineCase& input) {
  const Scene scene = read_capture(input.capture, "bytes.hpt");
  const Config& config = input.config;
  const auto functional = [&](std::string_view kernels, int threads, const Skip& skip) {
    return outcome_of([&] {
      RenderOptions options;
      options.instruction_set = kernels;
      options.threads = threads;
      options.skip = skip;
      return render_functional(scene, config, options);
    });
  };
  const Outcome scalar = outcome_of([&] { return render_scalar(scene, config); });
  for (const functional::Kernels* kernels : functional::available_kernels())
    for (const bool skips : {true, false}) {
      const Outcome fast = functional(kernels->name, skips ? 1 : 2, skips ? Skip{} : skip_none());
      const std::string found = difference(scalar, fast, !skips);
      if (!found.empty())
        return std::string("scalar and functional (") + kernels->name + (skips ? ", skip all): " : ", skip none): ") +
               found;
    }
  bool is_for_hardware = true;
  try {
    check_hardware_scene(scene, config);
  } catch (const InputError&) {
    is_for_hardware = false;
  }
  if (is_for_hardware) {
    const auto memory = make_memory({}, config);
    CycleOptions options;
    options.stalls.threshold = stall_threshold(input.stalls / 100.0);
    const std::string found = difference(
        scalar, outcome_of([&] { return render_cycle(scene, config, *memory, {}, options).rendering; }), false);
    if (!found.empty()) return "scalar and cycle: " + found;
  }
  if (!scalar.rendering) return {};
  const Comparison comparison = compare(scene, config);
  if (comparison.oracle.mismatches != 0) return "coverage differs from the oracle's";
  if (scalar.rendering->counters.covered == 0) return {};  // nothing to compare
  const std::vector<std::string> broken = broken_bounds(comparison, config);
  return broken.empty() ? std::string() : "against oracle and golden: " + broken.front();
}

}  // namespace halfplane::test
