#include "halfplane.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <string>

#include "model/capture/capture.hpp"
#include "model/capture/capture_lines.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/raster_pkg.hpp"
#include "stage_at_work.hpp"

using namespace halfplane;

struct halfplane_config {
  Config config;
};
struct halfplane_scene {
  Scene scene;
  State state{};  ///< of the next draw from arrays
};
struct halfplane_frame {
  Framebuffer frame;
  std::map<std::string, std::uint64_t, std::less<>> counters;
  std::map<std::string, std::vector<double>, std::less<>> reals;  ///< of the golden
};
struct halfplane_stage {
  capi::StageAtWork at_work;
};

namespace {

thread_local std::string last_error;  // NOLINT: what errno is to C

/// What `work` returns, or `failure`, when it throws; then last_error says why.
template <class Failure, class Work>
auto guarded(Failure failure, Work&& work) noexcept -> decltype(work()) {
  try {
    try {
      return work();
    } catch (const std::bad_alloc&) {
      last_error = "there is not enough memory";
    } catch (const std::exception& error) {
      last_error = error.what();
      std::ranges::replace_if(
          last_error, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    }
  } catch (...) {  // of the assignments
  }
  return failure;
}

template <class T>
T& required(T* pointer, const char* what) {
  if (pointer == nullptr) throw InputError(std::string(what) + " is NULL");
  return *pointer;
}
std::string_view text(const char* word, const char* what) { return &required(word, what); }

const Setting& setting_of(std::string_view key) {
  for (const Setting& setting : settings())
    if (setting.key == key) return setting;
  throw InputError("there is no setting '" + std::string(key) + "'");
}

Topology topology_of(std::string_view name) {
  static constexpr std::array<std::string_view, 7> kNames{"triangles",  "triangle_strip", "triangle_fan", "lines",
                                                          "line_strip", "line_loop",      "points"};
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end())
    throw InputError("there is no topology '" + std::string(name) + "'; give triangles, lines...");
  return static_cast<Topology>(found - kNames.begin());
}

/// Lines of a capture, read by the one reader of captures: as the head of one with a single draw, whose state is taken.
void say(halfplane_scene& made, std::string_view lines) {
  Scene& scene = made.scene;
  const std::string head =
      "halfplane 1\ntarget " + std::to_string(scene.width) + " " + std::to_string(scene.height) + "\n";
  const Scene said = read_capture_lines(head + std::string(lines) + "\nv 0 0 0 1\np 0\n", "lines", 2);
  if (said.vertices.size() != 1) throw InputError("lines: vertices are given by halfplane_scene_vertices");
  if (said.width != scene.width || said.height != scene.height)
    throw InputError("lines: the size of the target is given by halfplane_scene_new");
  const auto first_texture = static_cast<std::uint32_t>(scene.textures.size());
  made.state = said.states.at(std::get<Draw>(said.commands.back()).state);
  if (made.state.texture) *made.state.texture += first_texture;
  scene.textures.insert(scene.textures.end(), said.textures.begin(), said.textures.end());
  scene.commands.insert(scene.commands.end(), said.commands.begin(), said.commands.end() - 1);
  if (said.planes) scene.planes = said.planes;
}

std::size_t add_vertices(Scene& scene, const double* values, int numbers, std::size_t count) {
  if (numbers != 4 && numbers != 8 && numbers != 10)
    throw InputError("a vertex has 4, 8 or 10 numbers, not " + std::to_string(numbers));
  const std::size_t first = scene.vertices.size();
  for (std::size_t i = 0; i < count; ++i, values += numbers) {
    Vertex v{values[0], values[1], values[2], values[3]};
    if (numbers >= 8) std::copy_n(values + 4, 4, v.rgba.begin());
    if (numbers == 10) {
      v.u = values[8];
      v.v = values[9];
    }
    scene.vertices.push_back(v);
  }
  return first;
}

void add_draw(halfplane_scene& made, Topology topology, const std::uint32_t* indices, std::size_t count) {
  Scene& scene = made.scene;
  for (std::size_t i = 0; i < count; ++i)
    if (indices[i] != kRestart && indices[i] >= scene.vertices.size())
      throw InputError("index " + std::to_string(i) + " of the draw is " + std::to_string(indices[i]) +
                       ", and the scene has " + std::to_string(scene.vertices.size()) + " vertices");
  if (scene.states.empty() || scene.states.back() != made.state) scene.states.push_back(made.state);
  Draw draw;
  draw.topology = topology;
  draw.first = scene.indices.size();
  draw.count = count;
  draw.state = static_cast<std::uint32_t>(scene.states.size() - 1);
  scene.indices.insert(scene.indices.end(), indices, indices + count);
  scene.commands.emplace_back(draw);
}

void count(halfplane_frame& made, const Counters& counters) {
  made.counters = {{"primitives_in", counters.primitives_in},
                   {"drawn", counters.drawn},
                   {"covered", counters.covered},
                   {"depth_passed", counters.depth_passed},
                   {"alpha_killed", counters.alpha_killed},
                   {"written", counters.written}};
}

halfplane_frame taken_from(Rendering&& rendering) {
  halfplane_frame made{std::move(rendering.frame), {}, {}};
  count(made, rendering.counters);
  return made;
}

halfplane_frame golden_frame(const Scene& scene, const Config& config) {
  golden::Image image = golden::render(scene, config);
  halfplane_frame made{std::move(image.frame), {}, {}};
  count(made, image.counters);
  made.reals["depth"] = std::move(image.depth);
  auto& color = made.reals["color"];
  for (const auto& channels : image.color) color.insert(color.end(), channels.begin(), channels.end());
  return made;
}

halfplane_frame cycle_frame(const Scene& scene, const Config& config) {
  const auto memory = make_memory({}, config);
  CycleRendering drawn = render_cycle(scene, config, *memory);
  halfplane_frame made = taken_from(std::move(drawn.rendering));
  made.counters["cycles"] = drawn.run.cycles;
  return made;
}

halfplane_frame rendered(const Scene& scene, const Config& config, std::string_view engine) {
  validate(config);
  if (engine == "functional") return taken_from(render_functional(scene, config));
  if (engine == "scalar") return taken_from(render_scalar(scene, config));
  if (engine == "cycle") return cycle_frame(scene, config);
  if (engine == "golden") return golden_frame(scene, config);
  throw InputError("there is no engine '" + std::string(engine) + "'; give functional, scalar, cycle or golden");
}

void require_room(std::size_t needed, std::size_t count) {
  if (count < needed)
    throw InputError("there is room for " + std::to_string(count) + " values of " + std::to_string(needed));
}

template <class Plane>
std::int64_t copied(const Framebuffer& frame, const Plane& plane, std::uint32_t* values, std::size_t count) {
  const std::size_t width = static_cast<std::size_t>(frame.width),
                    pixels = width * static_cast<std::size_t>(frame.height);
  require_room(pixels, count);
  for (int y = 0; y < frame.height; ++y)
    values = std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(frame.at(0, y)), width, values);
  return static_cast<std::int64_t>(pixels);
}

const capi::StageAtWork::PortInfo& port_of(const halfplane_stage* stage, int is_out, int port) {
  const auto& ports = required(stage, "the stage").at_work.ports(is_out != 0);
  if (port < 0 || static_cast<std::size_t>(port) >= ports.size())
    throw InputError("there is no port " + std::to_string(port) + "; the stage has " + std::to_string(ports.size()) +
                     (is_out != 0 ? " that come out" : " that go in"));
  return ports[static_cast<std::size_t>(port)];
}

const vectors::FieldName& field_of(const halfplane_stage* stage, int is_out, int port, int field) {
  const auto& fields = port_of(stage, is_out, port).fields;
  if (field < 0 || static_cast<std::size_t>(field) >= fields.size())
    throw InputError("there is no field " + std::to_string(field) + "; the packet has " +
                     std::to_string(fields.size()));
  return fields[static_cast<std::size_t>(field)];
}

}  // namespace

extern "C" {

int halfplane_abi(void) { return HALFPLANE_ABI; }
const char* halfplane_last_error(void) { return last_error.c_str(); }

halfplane_config* halfplane_config_new(const char* name) {
  return guarded(nullptr, [&] { return new halfplane_config{preset(text(name, "the preset"))}; });
}
int halfplane_config_set(halfplane_config* config, const char* key, const char* value) {
  return guarded(-1, [&] {
    set(required(config, "the configuration").config, text(key, "the key"), text(value, "the value"));
    return 0;
  });
}
int halfplane_config_get(const halfplane_config* config, const char* key, char* value, size_t bytes) {
  return guarded(-1, [&] {
    const std::string got = get(required(config, "the configuration").config, setting_of(text(key, "the key")));
    if (bytes > 0) {
      const std::size_t length = std::min(got.size(), bytes - 1);
      std::memcpy(&required(value, "the room for the value"), got.data(), length);
      value[length] = '\0';
    }
    return static_cast<int>(got.size());
  });
}
uint64_t halfplane_config_id(const halfplane_config* config) {
  return guarded(std::uint64_t{0}, [&] {
    const Config& known = required(config, "the configuration").config;
    validate(known);
    return config_id(known);
  });
}
void halfplane_config_free(halfplane_config* config) { delete config; }

halfplane_scene* halfplane_scene_read(const char* words, size_t bytes) {
  return guarded(nullptr, [&] {
    return new halfplane_scene{read_capture(std::string_view(&required(words, "the text"), bytes), "scene")};
  });
}
halfplane_scene* halfplane_scene_new(int width, int height) {
  return guarded(nullptr, [&] {
    auto made = std::make_unique<halfplane_scene>();
    made->scene.name = "scene";
    made->scene.width = width;
    made->scene.height = height;
    validate(made->scene);
    return made.release();
  });
}
int halfplane_scene_say(halfplane_scene* scene, const char* lines, size_t bytes) {
  return guarded(-1, [&] {
    say(required(scene, "the scene"), std::string_view(&required(lines, "the text"), bytes));
    return 0;
  });
}
int64_t halfplane_scene_vertices(halfplane_scene* scene, const double* values, int numbers, size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    return static_cast<std::int64_t>(
        add_vertices(required(scene, "the scene").scene, &required(values, "the array of vertices"), numbers, count));
  });
}
int halfplane_scene_draw(halfplane_scene* scene, const char* topology, const uint32_t* indices, size_t count) {
  return guarded(-1, [&] {
    add_draw(required(scene, "the scene"), topology_of(text(topology, "the topology")),
             &required(indices, "the array of indices"), count);
    return 0;
  });
}
void halfplane_scene_free(halfplane_scene* scene) { delete scene; }

halfplane_frame* halfplane_render(const halfplane_scene* scene, const halfplane_config* config, const char* engine) {
  return guarded(nullptr, [&] {
    return new halfplane_frame(rendered(required(scene, "the scene").scene,
                                        required(config, "the configuration").config, text(engine, "the engine")));
  });
}
int halfplane_frame_width(const halfplane_frame* frame) {
  return guarded(-1, [&] { return required(frame, "the frame").frame.width; });
}
int halfplane_frame_height(const halfplane_frame* frame) {
  return guarded(-1, [&] { return required(frame, "the frame").frame.height; });
}
int64_t halfplane_frame_plane(const halfplane_frame* frame, const char* plane, uint32_t* values, size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    const Framebuffer& from = required(frame, "the frame").frame;
    const std::string_view name = text(plane, "the plane");
    (void)required(values, "the room for the values");
    if (name == "depth") return copied(from, from.depth, values, count);
    if (name == "color") return copied(from, from.color, values, count);
    if (name == "stencil") return copied(from, from.stencil, values, count);
    throw InputError("there is no plane '" + std::string(name) + "'; give depth, color or stencil");
  });
}
int64_t halfplane_frame_reals(const halfplane_frame* frame, const char* plane, double* values, size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    const auto& reals = required(frame, "the frame").reals;
    const auto found = reals.find(text(plane, "the plane"));
    if (found == reals.end()) throw InputError("only the golden has real numbers, of depth and color");
    require_room(found->second.size(), count);
    std::ranges::copy(found->second, &required(values, "the room for the values"));
    return static_cast<std::int64_t>(found->second.size());
  });
}
int64_t halfplane_frame_counter(const halfplane_frame* frame, const char* name) {
  return guarded(std::int64_t{-1}, [&] {
    const auto& counters = required(frame, "the frame").counters;
    const auto found = counters.find(text(name, "the counter"));
    if (found == counters.end()) throw InputError("this frame has no counter '" + std::string(name) + "'");
    return static_cast<std::int64_t>(found->second);
  });
}
void halfplane_frame_free(halfplane_frame* frame) { delete frame; }

halfplane_stage* halfplane_stage_new(const halfplane_config* config, const char* name) {
  return guarded(nullptr, [&] {
    return new halfplane_stage{{required(config, "the configuration").config, text(name, "the stage's name")}};
  });
}
int halfplane_stage_ports(const halfplane_stage* stage, int is_out) {
  return guarded(-1, [&] { return static_cast<int>(required(stage, "the stage").at_work.ports(is_out != 0).size()); });
}
const char* halfplane_stage_port_name(const halfplane_stage* stage, int is_out, int port) {
  return guarded(nullptr, [&] { return port_of(stage, is_out, port).name.c_str(); });
}
int halfplane_stage_port_bits(const halfplane_stage* stage, int is_out, int port) {
  return guarded(-1, [&] { return port_of(stage, is_out, port).bits; });
}
int halfplane_stage_fields(const halfplane_stage* stage, int is_out, int port) {
  return guarded(-1, [&] { return static_cast<int>(port_of(stage, is_out, port).fields.size()); });
}
const char* halfplane_stage_field_name(const halfplane_stage* stage, int is_out, int port, int field) {
  return guarded(nullptr, [&] { return field_of(stage, is_out, port, field).name.c_str(); });
}
int halfplane_stage_field_bits(const halfplane_stage* stage, int is_out, int port, int field) {
  return guarded(-1, [&] {
    const vectors::FieldName& found = field_of(stage, is_out, port, field);
    return found.is_signed ? -found.bits : found.bits;
  });
}
int halfplane_stage_put(halfplane_stage* stage, int port, const uint32_t* words) {
  return guarded(-1, [&] {
    (void)port_of(stage, 0, port);
    stage->at_work.put(static_cast<std::size_t>(port), &required(words, "the packet"));
    return 0;
  });
}
int halfplane_stage_get(halfplane_stage* stage, int port, uint32_t* words) {
  return guarded(-1, [&] {
    (void)port_of(stage, 1, port);
    return stage->at_work.get(static_cast<std::size_t>(port), &required(words, "the room for a packet")) ? 1 : 0;
  });
}
void halfplane_stage_free(halfplane_stage* stage) { delete stage; }

}  // extern "C"
