#include <algorithm>
#include <cstring>
#include <memory>

#include "handles.hpp"
#include "input.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/generate/raster_pkg.hpp"
#include "model/golden/golden.hpp"
#include "stage_at_work.hpp"

using namespace halfplane;
using namespace halfplane::capi;

struct halfplane_stage {
  StageAtWork at_work;
};

namespace {

thread_local std::string last_error;  // NOLINT: what errno is to C

const Setting& setting_of(std::string_view key) {
  for (const Setting& setting : settings())
    if (setting.key == key) return setting;
  throw InputError("there is no setting '" + std::string(key) + "'");
}

void say(halfplane_scene& made, std::string_view lines) {
  Scene& scene = made.scene;
  const Said said = read_lines(scene.width, scene.height, scene.textures, lines);
  made.state = said.state;
  scene.textures.insert(scene.textures.end(),
                        said.scene.textures.begin() + static_cast<std::ptrdiff_t>(scene.textures.size()),
                        said.scene.textures.end());
  if (said.scene.planes) scene.planes = said.scene.planes;
  for (const Command& command : said.scene.commands) {
    const auto* clear = std::get_if<Clear>(&command);
    if (clear == nullptr) continue;
    Clear own = *clear;
    own.state = static_cast<std::uint32_t>(scene.states.size());
    scene.states.push_back(said.scene.states[clear->state]);
    scene.commands.emplace_back(own);
  }
}

std::int64_t add_vertices(Scene& scene, const Vertices& given) {
  const std::size_t first = scene.vertices.size();
  scene.vertices.insert(scene.vertices.end(), given.vertices.begin(), given.vertices.end());
  if (!given.normals.empty()) {
    scene.normals.resize(first);
    scene.normals.insert(scene.normals.end(), given.normals.begin(), given.normals.end());
  }
  return static_cast<std::int64_t>(first);
}

void add_draw(halfplane_scene& made, Topology topology, std::span<const std::uint32_t> indices) {
  Scene& scene = made.scene;
  check_indices(indices, scene.vertices.size(), "scene");
  if (scene.states.empty() || scene.states.back() != made.state) scene.states.push_back(made.state);
  Draw draw;
  draw.topology = topology;
  draw.first = scene.indices.size();
  draw.count = indices.size();
  draw.state = static_cast<std::uint32_t>(scene.states.size() - 1);
  scene.indices.insert(scene.indices.end(), indices.begin(), indices.end());
  scene.commands.emplace_back(draw);
}

void add_texture(Scene& scene, Texture texture) {
  if (std::ranges::find(scene.textures, texture.name, &Texture::name) != scene.textures.end())
    throw InputError("the scene has a texture '" + texture.name + "' already");
  scene.textures.push_back(std::move(texture));
}

halfplane_frame taken_from(Rendering&& rendering) {
  return {std::move(rendering.frame), named(rendering.counters), {}};
}

halfplane_frame golden_frame(const Scene& scene, const Config& config) {
  golden::Image image = golden::render(scene, config);
  halfplane_frame made{std::move(image.frame), named(image.counters), {}};
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

halfplane_frame rendered(const Scene& scene, const Config& config, std::string_view engine, int threads) {
  validate(config);
  constexpr int kMostThreads = 1024;
  if (threads < 1 || threads > kMostThreads)
    throw InputError(std::to_string(threads) + " threads; give 1 to " + std::to_string(kMostThreads));
  RenderOptions options;
  options.threads = threads;
  if (engine == "functional") return taken_from(render_functional(scene, config, options));
  if (engine == "scalar") return taken_from(render_scalar(scene, config));
  if (engine == "cycle") return cycle_frame(scene, config);
  if (engine == "golden") return golden_frame(scene, config);
  throw InputError("there is no engine '" + std::string(engine) + "'; give functional, scalar, cycle or golden");
}

void require_room(std::size_t needed, std::size_t count) {
  if (count < needed)
    throw InputError("there is room for " + std::to_string(count) + " values of " + std::to_string(needed));
}

const StageAtWork::PortInfo& port_of(const halfplane_stage* stage, int is_out, int port) {
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

void halfplane::capi::set_last_error(std::string_view text) {
  last_error = text;
  std::ranges::replace_if(
      last_error, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
}

CounterNames halfplane::capi::named(const Counters& counters) {
  return {{"primitives_in", counters.primitives_in},
          {"drawn", counters.drawn},
          {"covered", counters.covered},
          {"depth_passed", counters.depth_passed},
          {"alpha_killed", counters.alpha_killed},
          {"written", counters.written}};
}

std::int64_t halfplane::capi::counter(const CounterNames& counters, std::string_view name) {
  const auto found = counters.find(name);
  if (found == counters.end()) throw InputError("this frame has no counter '" + std::string(name) + "'");
  return static_cast<std::int64_t>(found->second);
}

std::int64_t halfplane::capi::copy_plane(const Framebuffer& frame, std::string_view plane, std::uint32_t* values,
                                         std::size_t count) {
  const std::size_t width = static_cast<std::size_t>(frame.width),
                    pixels = width * static_cast<std::size_t>(frame.height);
  const auto copied = [&](const auto& from) {
    require_room(pixels, count);
    for (int y = 0; y < frame.height; ++y)
      values = std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(frame.at(0, y)), width, values);
    return static_cast<std::int64_t>(pixels);
  };
  if (plane == "depth") return copied(frame.depth);
  if (plane == "color") return copied(frame.color);
  if (plane == "stencil") return copied(frame.stencil);
  throw InputError("there is no plane '" + std::string(plane) + "'; give depth, color or stencil");
}

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
halfplane_scene* halfplane_scene_open(const char* path) {
  return guarded(nullptr, [&] { return new halfplane_scene{read_capture_file(std::string(text(path, "the path")))}; });
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
    return add_vertices(required(scene, "the scene").scene,
                        {read_vertices(&required(values, "the array of vertices"), numbers, count), {}});
  });
}
int64_t halfplane_scene_records(halfplane_scene* scene, const halfplane_layout* layout, const void* data, size_t bytes,
                                size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    return add_vertices(required(scene, "the scene").scene,
                        read_vertices(required(layout, "the layout"), data, bytes, count));
  });
}
int halfplane_scene_texture(halfplane_scene* scene, const char* name, int width, int height, const uint8_t* rgba,
                            const char* format, const char* mips) {
  return guarded(-1, [&] {
    add_texture(required(scene, "the scene").scene,
                read_texture(text(name, "the texture's name"), width, height, rgba, text(format, "the format"),
                             text(mips, "the kind of mips")));
    return 0;
  });
}
int halfplane_scene_draw(halfplane_scene* scene, const char* topology, const uint32_t* indices, size_t count) {
  return guarded(-1, [&] {
    add_draw(required(scene, "the scene"), topology_of(text(topology, "the topology")),
             std::span(&required(indices, "the array of indices"), count));
    return 0;
  });
}
void halfplane_scene_free(halfplane_scene* scene) { delete scene; }

halfplane_frame* halfplane_render_threads(const halfplane_scene* scene, const halfplane_config* config,
                                          const char* engine, int threads) {
  return guarded(nullptr, [&] {
    return new halfplane_frame(rendered(required(scene, "the scene").scene,
                                        required(config, "the configuration").config, text(engine, "the engine"),
                                        threads));
  });
}
halfplane_frame* halfplane_render(const halfplane_scene* scene, const halfplane_config* config, const char* engine) {
  return halfplane_render_threads(scene, config, engine, 1);
}
int halfplane_frame_width(const halfplane_frame* frame) {
  return guarded(-1, [&] { return required(frame, "the frame").frame.width; });
}
int halfplane_frame_height(const halfplane_frame* frame) {
  return guarded(-1, [&] { return required(frame, "the frame").frame.height; });
}
int64_t halfplane_frame_plane(const halfplane_frame* frame, const char* plane, uint32_t* values, size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    return copy_plane(required(frame, "the frame").frame, text(plane, "the plane"),
                      &required(values, "the room for the values"), count);
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
  return guarded(std::int64_t{-1},
                 [&] { return counter(required(frame, "the frame").counters, text(name, "the counter")); });
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
