// Any bytes as a Scene filled in by a caller: any index, any float, any enumerator. Required for every such scene: each
// public function that takes a scene gives a picture or throws an InputError of one line, and the functions that draw
// the same scene draw the same picture. Shared by the fuzzer and by the test that draws random inputs.
#pragma once

#include <bit>
#include <limits>
#include <sstream>

#include "model/engines/hardware.hpp"
#include "model/engines/target.hpp"
#include "model/golden/golden.hpp"
#include "pipeline_case.hpp"

namespace halfplane::test {

/// A scene that no function has checked.
class SceneFromBytes {
 public:
  SceneFromBytes(ByteSource& bytes, const Config& config) : bytes_(bytes), config_(config) {}

  Scene scene() {
    wildness_ = bytes_.byte() % 8 / 2;
    Scene scene;
    scene.name = "bytes";
    scene.width = is_wild(64) ? any_int() : bytes_.between(1, std::min(40, config_.target_width));
    scene.height = is_wild(64) ? any_int() : bytes_.between(1, std::min(30, config_.target_height));
    if (is_wild(32)) scene.planes = {any_double(), any_double()};
    const int states = bytes_.between(is_wild(64) ? 0 : 1, 3);
    for (int i = 0; i < states; ++i) scene.states.push_back(state());
    const int vertices = bytes_.between(is_wild(32) ? 0 : 3, 8);
    for (int i = 0; i < vertices; ++i) scene.vertices.push_back(vertex(scene));
    const int indices = bytes_.between(3, 20);
    for (int i = 0; i < indices; ++i) scene.indices.push_back(index(scene.vertices.size()));
    const int commands = bytes_.between(1, 4);
    for (int i = 0; i < commands; ++i) scene.commands.push_back(command(scene));
    return scene;
  }

 private:
  /// Once in `n` choices, oftener the wilder the scene; a tame scene never.
  bool is_wild(std::uint32_t n) { return wildness_ != 0 && bytes_.byte() * wildness_ % n == 1; }

  int any_int() {
    constexpr std::array kInts{
        0, -1, 1, 16384, 16385, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    const std::uint32_t choice = bytes_.byte();
    return choice % 8 < kInts.size() ? kInts[choice % 8] : static_cast<int>(bytes_.word() << 16 | bytes_.word());
  }

  double any_double() {
    using Limits = std::numeric_limits<double>;
    constexpr std::array kNumbers{0.0,
                                  -0.0,
                                  1e-300,
                                  Limits::denorm_min(),
                                  1e300,
                                  -1e300,
                                  Limits::max(),
                                  -Limits::max(),
                                  Limits::infinity(),
                                  -Limits::infinity(),
                                  Limits::quiet_NaN(),
                                  2048.0,
                                  1e18,
                                  -3e9};
    const std::uint32_t choice = bytes_.byte() % 16;
    if (choice < kNumbers.size()) return kNumbers[choice];
    std::uint64_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 16 | bytes_.word();
    return std::bit_cast<double>(bits);
  }

  double number(double low, double step, int count) {
    return is_wild(48) ? any_double() : low + step * static_cast<double>(bytes_.word() % static_cast<unsigned>(count));
  }

  State state() {
    State state;
    for (const DrawState& row : draw_states())
      if (bytes_.byte() % 4 == 1)
        row.set(state, random_value(
                           row, [this](std::uint32_t n) { return bytes_.byte() % n; },
                           is_wild(8) ? Refused::kept : Refused::left_out));
    if (is_wild(16)) state.viewport = {any_double(), any_double(), any_double(), any_double()};
    if (is_wild(16)) state.scissor = {any_int(), any_int(), any_int(), any_int()};
    if (is_wild(16)) state.point_size = any_double();
    if (is_wild(16)) state.depth_range = {any_double(), any_double()};
    if (is_wild(16)) state.polygon_offset = {any_double(), any_double()};
    if (is_wild(32)) state.depth_test = static_cast<DepthFunc>(any_int());
    if (is_wild(32)) state.line_rule = static_cast<LineRule>(any_int());
    if (is_wild(32)) state.space = static_cast<Space>(any_int());
    if (is_wild(32)) state.polygon_mode = static_cast<PolygonMode>(any_int());
    return state;
  }

  /// In the space of the first state, so that some of it is seen.
  Vertex vertex(const Scene& scene) {
    Vertex v;
    const bool is_window = !scene.states.empty() && scene.states.front().space == Space::window;
    v.x = is_window ? number(-4, 1.0 / 16, 800) : number(-1.5, 1.0 / 1024, 3072);
    v.y = is_window ? number(-4, 1.0 / 16, 600) : number(-1.5, 1.0 / 1024, 3072);
    v.z = is_window ? number(0, 1.0 / 4096, 4097) : number(-1.25, 1.0 / 1024, 2560);
    v.w = bytes_.byte() % 4 != 0 ? 1 : number(-1, 1.0 / 64, 300);
    for (double& c : v.rgba) c = number(0, 1, 256);
    v.u = number(0, 1, 2);
    return v;
  }

  std::uint32_t index(std::size_t vertices) {
    if (is_wild(32)) return static_cast<std::uint32_t>(any_int());
    if (vertices == 0 || bytes_.byte() % 16 == 15) return kRestart;
    return (bytes_.byte() + next_++) % static_cast<std::uint32_t>(vertices);
  }

  Command command(const Scene& scene) {
    const auto number_below = [&](std::size_t size) {
      return is_wild(64) || size == 0 ? static_cast<std::uint32_t>(any_int())
                                      : bytes_.byte() % static_cast<std::uint32_t>(size);
    };
    const std::uint32_t choice = bytes_.byte() % 8;
    if (choice == 2) return EndFrame{};
    if (choice == 1) {
      Clear clear{.state = number_below(scene.states.size())};
      if (bytes_.byte() % 2 == 0) clear.color = {number(0, 1, 256), number(0, 1, 256), number(0, 1, 256), 255};
      if (bytes_.byte() % 2 == 0) clear.depth = number(0, 1.0 / 256, 257);
      return clear;
    }
    Draw draw{.state = number_below(scene.states.size()), .object = is_wild(64) ? 7U : 0U};
    draw.topology = is_wild(64) ? static_cast<Topology>(any_int()) : static_cast<Topology>(bytes_.between(0, 6));
    draw.first = scene.indices.empty() ? 0 : bytes_.byte() % scene.indices.size();
    draw.count = scene.indices.size() - draw.first;
    if (is_wild(32)) draw.first = static_cast<std::size_t>(any_int());
    if (is_wild(32)) draw.count = static_cast<std::size_t>(any_int());
    return draw;
  }

  ByteSource& bytes_;
  const Config& config_;
  std::uint32_t next_ = 0;      ///< so that indices differ when the bytes are used up
  std::uint32_t wildness_ = 0;  ///< 0: a valid scene
};

struct ApiCase {
  Config config;
  Scene scene;
};

inline ApiCase api_case(std::span<const std::uint8_t> data) {
  ByteSource bytes(data);
  Config config = config_from(bytes);
  config.target_width = 64;  // the hardware's memories are of this size: a large one would take all the time
  config.target_height = 48;
  return {config, SceneFromBytes(bytes, config).scene()};
}

/// The scene through a Target, command by command, by one to three threads.
inline Rendering by_target(const Scene& scene, const Config& config) {
  validate(scene);  // as a whole, as the others do: a Target has drawn the commands before a bad one
  check_scene(scene, config);
  Target target(config, scene.width, scene.height, scene.planes);
  target.set_threads(1 + static_cast<int>(scene.vertices.size() % 3));
  for (const Texture& texture : scene.textures) (void)target.add_texture(texture);
  Counters sum;
  for (const Command& command : scene.commands) {
    if (const auto* clear = std::get_if<Clear>(&command)) target.clear(*clear, scene.states[clear->state]);
    if (const auto* draw = std::get_if<Draw>(&command)) {
      const std::span indices = std::span(scene.indices).subspan(draw->first, draw->count);
      const Counters c = target.draw(scene.states[draw->state], draw->topology, scene.vertices, indices, scene.normals);
      sum.primitives_in += c.primitives_in;
      sum.depth_passed += c.depth_passed;
      sum.written += c.written;
    }
  }
  Rendering rendering;
  rendering.frame = target.frame();
  rendering.counters = sum;
  return rendering;
}

/// The property that does not hold for the case; empty when all hold. Exceptions but InputError pass through.
inline std::string api_fault(const ApiCase& input) {
  const Scene& scene = input.scene;
  const Config& config = input.config;
  const Outcome scalar = outcome_of([&] { return render_scalar(scene, config); });
  if (scalar.refusal.find('\n') != std::string::npos) return "a refusal of two lines: " + scalar.refusal;
  if (!scalar.rendering && scalar.refusal.empty()) return "refused without a word";
  const auto compared = [&](const char* name, const Outcome& other) -> std::string {
    const std::string found = difference(scalar, other, false);
    return found.empty() ? found : std::string("scalar and ") + name + ": " + found;
  };
  std::string fault = compared("functional", outcome_of([&] { return render_functional(scene, config); }));
  if (!fault.empty()) return fault;
  RenderOptions everything;
  everything.want_count = everything.want_ids = everything.want_triangles = true;
  everything.threads = 2;
  fault = compared("functional with ids", outcome_of([&] { return render_functional(scene, config, everything); }));
  if (!fault.empty()) return fault;
  const auto refusal_of = [](auto&& call) -> std::string {
    try {
      call();
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const bool is_valid = refusal_of([&] { validate(scene); }).empty();
  if (!is_valid && scalar.rendering) return "a scene that is not valid was drawn";
  const std::string refused_by_golden = refusal_of([&] { (void)golden::render(scene, config); });
  if (!is_valid && refused_by_golden.empty()) return "a scene that is not valid was drawn by the golden";
  const std::string refused_by_hardware = refusal_of([&] { (void)render_hardware(scene, config); });
  if (!is_valid && refused_by_hardware.empty()) return "a scene that is not valid was sent to the hardware";
  if (refused_by_hardware.empty()) {
    fault = compared("hardware", outcome_of([&] { return render_hardware(scene, config); }));
    if (fault.empty())
      fault = compared("cycle", outcome_of([&] {
                         const auto memory = make_memory({}, config);
                         return render_cycle(scene, config, *memory).rendering;
                       }));
    if (!fault.empty()) return fault;
  }
  std::ostringstream text;
  const std::string unwritten = refusal_of([&] { write_capture(scene, text); });
  if (is_valid != unwritten.empty()) return "write_capture and validate differ: " + unwritten;
  if (!is_valid) return {};
  const Scene again = read_capture(text.str(), "again.hpt");
  if (!scalar.rendering) return {};  // the capture leaves out draws without effect, and may then be drawn
  const Outcome read = outcome_of([&] { return render_scalar(again, config); });
  if (!read.rendering) return "refused by capture: " + read.refusal;
  if (scalar.rendering->frame.depth != read.rendering->frame.depth) return "another depth by capture";
  if (scalar.rendering->frame.color != read.rendering->frame.color) return "another colour by capture";
  return compared("target", outcome_of([&] { return by_target(scene, config); }));
}

}  // namespace halfplane::test
