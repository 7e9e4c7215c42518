#include "frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <mutex>
#include <utility>

#include "../../model/host/clip.hpp"
#include "../../model/host/primitives.hpp"
#include "../../model/stages/surface.hpp"
#include "../../model/vertex_bounds.hpp"
#include "frame_memory.hpp"

namespace halfplane::gl {
namespace {

constexpr std::size_t kMostTextureBytes = std::size_t{512} << 20;
constexpr std::uint64_t kFramesKept = 30;  ///< for which an unused texture is kept
/// Vertices after which an unrecorded frame is dropped: a program may draw for ever and never swap.
constexpr std::size_t kMostVertices = std::size_t{1} << 20;
constexpr std::size_t kMostRecordedVertices = std::size_t{1} << 25;

std::mutex& process_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Entries of a list's primitive.
std::size_t list_step(PrimitiveType type) {
  return type == PrimitiveType::triangle ? 3U : type == PrimitiveType::line ? 2U : 1U;
}

Topology list_of(PrimitiveType type) {
  return type == PrimitiveType::triangle ? Topology::triangles
         : type == PrimitiveType::line   ? Topology::lines
                                         : Topology::points;
}

bool is_list(Topology topology) { return list_of(primitive_type(topology)) == topology; }

/// Draws of one kind may be in one scene: the engine takes its fast path for all of them or for none, and surfaces in window
/// coordinates may keep it from that by a w that is not positive.
int kind_of(const halfplane::State& state) { return has_surface(state) && state.space == Space::window ? 1 : 0; }

double within(double value, double low, double high) { return std::isnan(value) ? low : std::clamp(value, low, high); }

void add(Counters& sum, const Counters& c) {
  constexpr std::array kMembers{&Counters::primitives_in, &Counters::culled,  &Counters::drawn,
                                &Counters::clipped,       &Counters::covered, &Counters::depth_passed,
                                &Counters::alpha_killed,  &Counters::written, &Counters::samples_tested,
                                &Counters::tiles_visited};
  for (const auto member : kMembers) sum.*member += c.*member;
  for (const SkipName& one : kSkipNames) sum.skipped.*one.counter += c.skipped.*one.counter;
}

}  // namespace

void say_once(const std::string& what) {
  static std::set<std::string> said;
  std::string text = what;
  std::erase_if(text, [](char c) { return c >= '0' && c <= '9'; });
  const std::lock_guard lock(process_mutex());
  if (said.insert(text).second) std::cerr << "halfplane: " << what << std::endl;
}

int next_frame_number() {
  static int number = 0;
  const std::lock_guard lock(process_mutex());
  return number++;
}

// --- collecting -------------------------------------------------------------------------------------------------------

Frame::Memory::Memory(const Options& options_, int width, int height)
    : options(options_), config(options_.config), engine(options_.config) {
  scene.width = width;
  scene.height = height;
  try {
    picture = &engine.render(empty_scene()).frame;
  } catch (const InputError& error) {  // the window system's error does not say why
    say_once(error.what());
    throw;
  }
}

Scene Frame::Memory::empty_scene() const {
  Scene empty;
  empty.name = "frame";
  empty.width = scene.width;
  empty.height = scene.height;
  return empty;
}

void Frame::Memory::resize(int width, int height) {
  if (width == scene.width && height == scene.height) return;
  wait();
  forget();
  scene.width = width;
  scene.height = height;
  picture = &engine.render(empty_scene()).frame;
}

std::uint32_t Frame::Memory::state_number(const halfplane::State& state) {
  if (last_state < scene.states.size() && scene.states[last_state] == state) return last_state;
  // The first states of the frame: comparing is cheaper than a hash, and draws mostly alternate between a few.
  constexpr std::size_t kFew = 8;
  for (std::size_t i = 0; i < std::min(kFew, scene.states.size()); ++i)
    if (scene.states[i] == state) return last_state = static_cast<std::uint32_t>(i);
  const auto [at, is_new] = states.try_emplace(state, static_cast<std::uint32_t>(scene.states.size()));
  if (is_new) {
    scene.states.push_back(state);
    checked.push_back(0);
    refused.push_back(0);
    uses_stencil |= state.stencil.has_value();
  }
  return last_state = at->second;
}

/// Whether the engine draws primitives in this state.
bool Frame::Memory::takes(std::uint32_t state, Topology topology) {
  const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(primitive_type(topology)));
  if ((checked[state] & bit) != 0) return (refused[state] & bit) == 0;
  checked[state] |= bit;
  Scene one = empty_scene();
  one.states = {scene.states[state]};
  std::optional<std::uint32_t>& texture = one.states[0].texture;
  try {
    if (texture && (*texture >= slots.size() || slots[*texture].bytes == 0))
      throw InputError("a draw with a texture that is none");
    texture.reset();
    one.commands.emplace_back(Draw{.topology = topology});
    check_scene(one, config);
  } catch (const InputError& error) {
    say_once(std::string("not drawn: ") + error.what());
    refused[state] |= bit;
  }
  return (refused[state] & bit) == 0;
}

void Frame::Memory::clear(const halfplane::State& state, Clear what) {
  const Stopwatch watch(driver_s, is_timed());
  halfplane::State region;
  region.scissor = state.scissor;
  region.origin = state.origin;
  what.state = state_number(region);
  if (what.color)
    for (double& channel : *what.color) channel = within(channel, 0, 255);
  if (what.depth) what.depth = within(*what.depth, 0, 1);
  uses_stencil |= what.stencil.value_or(0) != 0;
  if (scene.commands.size() > drawn.commands)
    if (auto* before = std::get_if<Clear>(&scene.commands.back()); before != nullptr && before->state == what.state) {
      if (what.color) before->color = what.color;
      if (what.depth) before->depth = what.depth;
      if (what.stencil) before->stencil = what.stencil;
      return;
    }
  scene.commands.emplace_back(what);
}

void Frame::Memory::draw(const halfplane::State& state, Topology topology, std::span<const Vertex> vertices,
                         std::span<const std::uint32_t> indices) {
  const PrimitiveType type = primitive_type(topology);
  const std::size_t step = list_step(type);
  if (is_list(topology)) indices = indices.first(indices.size() / step * step);
  if (indices.size() < step || vertices.size() >= kMostRecordedVertices) return;
  if (kind >= 0 && kind_of(state) != kind) flush();
  if (scene.vertices.size() + vertices.size() > (is_recorded() ? kMostRecordedVertices : kMostVertices)) rebase();

  const Stopwatch watch(driver_s, is_timed());
  const std::uint32_t number = state_number(state);
  if (!takes(number, topology)) return;
  kind = kind_of(state);
  std::uint32_t largest = 0;
  bool restarts = false;
  for (const std::uint32_t index : indices) {
    largest = std::max(largest, index == kRestart ? 0 : index);
    restarts |= index == kRestart;
  }
  if (largest >= vertices.size()) return say_once("not drawn: an index without a vertex");

  const auto first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
  Draw draw{.state = number, .topology = topology, .first = scene.indices.size(), .count = indices.size()};
  for (const std::uint32_t index : indices) scene.indices.push_back(index == kRestart ? index : first_vertex + index);
  scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
  bool is_plain = !restarts || !is_list(topology);

  constexpr double kPlain = 1e6;  // coordinates that nothing can go wrong with
  constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::denorm_min();
  const bool is_window = state.space == Space::window, needs_w = is_window && has_surface(state);
  const double band = is_window ? std::min(kPlain, guard_band_limit(config) - 1) : kPlain;
  if (!are_within(vertices,
                  {-band, -band, is_window ? 0 : -kPlain, needs_w ? kLeast : -kPlain, 0, 0, 0, 0, -kMost, -kMost},
                  {band, band, is_window ? 1 : kPlain, kPlain, 255, 255, 255, 255, kMost, kMost}))
    for (Vertex& vertex : std::span(scene.vertices).subspan(first_vertex)) {
      if (is_window) vertex.z = within(vertex.z, 0, 1);
      for (double& channel : vertex.rgba) channel = within(channel, 0, 255);
      for (double* coordinate : {&vertex.u, &vertex.v})
        if (!std::isfinite(*coordinate)) *coordinate = 0;
      is_plain &= std::abs(vertex.x) <= band && std::abs(vertex.y) <= band && std::abs(vertex.z) <= kPlain &&
                  std::abs(vertex.w) <= kPlain && (!needs_w || vertex.w > 0);
    }
  if (!is_plain) draw = as_list(draw, true);
  // A scene must not hold coordinates that are not finite, even undrawn ones.
  if (!is_plain)
    for (Vertex& vertex : std::span(scene.vertices).subspan(first_vertex))
      for (double* coordinate : {&vertex.x, &vertex.y, &vertex.z, &vertex.w})
        if (!std::isfinite(*coordinate)) *coordinate = 0;
  add(draw);
}

/// Extends the previous draw where its state is equal.
void Frame::Memory::add(Draw draw) {
  if (draw.count == 0) return;
  Draw* before = scene.commands.size() > drawn.commands ? std::get_if<Draw>(&scene.commands.back()) : nullptr;
  if (before == nullptr || before->state != draw.state || before->topology != draw.topology ||
      before->first + before->count != draw.first) {
    scene.commands.emplace_back(draw);
    return;
  }
  if (!is_list(draw.topology)) {
    scene.indices.insert(scene.indices.begin() + static_cast<std::ptrdiff_t>(draw.first), kRestart);
    ++draw.count;
  }
  before->count += draw.count;
}

/// Whether the engine takes a primitive of these vertices. Invisible primitives may be left out.
bool Frame::Memory::can_draw(const halfplane::State& state, std::span<const std::uint32_t> primitive) const {
  double largest = 0, nearest = -std::numeric_limits<double>::infinity();
  int left = 0, right = 0, above = 0, below = 0;
  bool is_finite = true, is_inside = true;
  const double limit = guard_band_limit(config);
  for (const std::uint32_t index : primitive) {
    const Vertex& v = scene.vertices[index];
    for (const double c : {v.x, v.y, v.z, v.w}) {
      is_finite &= std::abs(c) <= 1e300;  // false of NaN
      largest = std::max(largest, std::abs(c));
    }
    nearest = std::max(nearest, v.w);
    if (state.space == Space::clip) continue;
    const WindowPosition p = window_position(v, state, scene.height);
    left += p.x < 0;
    right += p.x > scene.width;
    above += p.y < 0;
    below += p.y > scene.height;
    is_inside &= std::abs(p.x) <= limit && std::abs(p.y) <= limit && (!has_surface(state) || v.w > 0);
  }
  if (!is_finite) {
    say_once("not drawn: primitives with coordinates that are not finite, or beyond 1e300");
    return false;
  }
  if (state.space == Space::clip) {
    // Nothing of it is in front of the eye, or the place where it is cut would be off by a pixel.
    const double error = largest * std::max(scene.width, scene.height) * std::numeric_limits<double>::epsilon();
    if (nearest > 0 && error > nearest) say_once("not drawn: primitives with coordinates too large to be cut exactly");
    return nearest > 0 && error <= nearest;
  }
  const int size = static_cast<int>(primitive.size());
  if (left == size || right == size || above == size || below == size) return false;
  if (!is_inside)
    say_once("not drawn: primitives in window coordinates beyond the guard band of " +
             std::to_string(config.guard_band) + " pixels, or with w <= 0; raise guard.band");
  return is_inside;
}

/// The draw as a list of its primitives, or of the ones that can_draw(), at the end of the scene's indices. In place of the
/// draw where it is the last one.
Draw Frame::Memory::as_list(const Draw& draw, bool only_good) {
  const halfplane::State& state = scene.states[draw.state];
  const PrimitiveType type = primitive_type(draw.topology);
  const std::size_t corners = list_step(type);
  std::vector<std::uint32_t> list;
  for_each_primitive(scene, draw, state.provoking, [&](AssembledPrimitive primitive) {
    // Assembly names the provoking vertex of a triangle first.
    if (type == PrimitiveType::triangle && state.provoking == Provoking::last)
      std::rotate(primitive.index.begin(), primitive.index.begin() + 1, primitive.index.end());
    const auto index = std::span(primitive.index).first(corners);
    if (!only_good || can_draw(state, index)) list.insert(list.end(), index.begin(), index.end());
  });
  if (draw.first + draw.count == scene.indices.size()) scene.indices.resize(draw.first);
  Draw result = draw;
  result.topology = list_of(type);
  result.first = scene.indices.size();
  result.count = list.size();
  scene.indices.insert(scene.indices.end(), list.begin(), list.end());
  return result;
}

// --- textures ---------------------------------------------------------------------------------------------------------

std::uint32_t Frame::Memory::texture(std::uint64_t key, const std::function<halfplane::Texture()>& make) {
  if (const auto known = slot_of.find(key); known != slot_of.end()) {
    slots[known->second].frame = frame;
    return known->second;
  }
  if (texture_bytes > kMostTextureBytes) {
    wait();
    drop_textures(kMostTextureBytes / 2, 0);
    if (texture_bytes > kMostTextureBytes && !is_recorded()) {
      rebase();
      drop_textures(0, frame + 1);
    }
  }
  const Stopwatch watch(driver_s, is_timed());
  const std::string name = "t" + std::to_string(textures_made++);
  Scene alone = empty_scene();
  try {
    alone.textures = {make()};
    alone.textures[0].name = name;
    validate(alone);
  } catch (const InputError& error) {
    say_once(std::string("a white texture in place of one: ") + error.what());
    alone.textures = {make_texture(name, {1, 1, {Texel{255, 255, 255, 255}}}, TextureFormat::rgba8888, Mips::none)};
  }
  const auto is_free = [](const Slot& slot) { return slot.bytes == 0; };
  const auto place = static_cast<std::uint32_t>(std::ranges::find_if(slots, is_free) - slots.begin());
  if (place == slots.size()) slots.emplace_back();
  Slot& slot = slots[place];
  slot = {key, frame, std::move(alone.textures[0]), {}, 0};
  constexpr std::size_t kBytesOfTexel = 4 + 4 + 16;  // its code, its place in a block, its footprint
  for (const TextureLevel& level : slot.texture.level) slot.bytes += level.code.size() * kBytesOfTexel;
  texture_bytes += slot.bytes;
  slot_of.emplace(key, place);
  return place;
}

/// Drops textures last used before `least_frame`; then, above `most_bytes`, the longest unused. Textures that the frame
/// uses stay.
void Frame::Memory::drop_textures(std::size_t most_bytes, std::uint64_t least_frame) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> unused;
  for (std::uint32_t i = 0; i < slots.size(); ++i)
    if (slots[i].bytes != 0 && slots[i].frame < std::max(frame, least_frame)) unused.emplace_back(slots[i].frame, i);
  std::ranges::sort(unused);
  for (const auto& [used, i] : unused) {
    if (used >= least_frame && texture_bytes <= most_bytes) return;
    texture_bytes -= slots[i].bytes;
    slot_of.erase(slots[i].key);
    slots[i] = {};
  }
}

// --- drawing ----------------------------------------------------------------------------------------------------------

/// The waiting draws of a frame as a scene of their own. Vertices and textures are lent, and given back at the end.
struct Frame::Memory::Part {
  Part(Memory& memory_, CollectedFrame& collected_)
      : memory(memory_), collected(collected_), scene(memory_.empty_scene()) {
    Scene& frame = collected.scene;
    const Mark& from = collected.drawn;
    if (from.commands == 0) {
      scene.vertices.swap(frame.vertices);
      scene.indices.swap(frame.indices);
    } else {
      scene.vertices.assign(frame.vertices.begin() + static_cast<std::ptrdiff_t>(from.vertices), frame.vertices.end());
      scene.indices.assign(frame.indices.begin() + static_cast<std::ptrdiff_t>(from.indices), frame.indices.end());
      for (std::uint32_t& index : scene.indices)
        if (index != kRestart) index -= static_cast<std::uint32_t>(from.vertices);
    }
    scene.commands.assign(frame.commands.begin() + static_cast<std::ptrdiff_t>(from.commands), frame.commands.end());
    std::vector<std::uint32_t> local(frame.states.size(), kRestart);
    for (Command& command : scene.commands)
      std::visit(
          [&](auto& of) {
            if constexpr (requires { of.state; }) {
              if (local[of.state] == kRestart) {
                local[of.state] = static_cast<std::uint32_t>(scene.states.size());
                scene.states.push_back(frame.states[of.state]);
              }
              of.state = local[of.state];
            }
            if constexpr (requires { of.first; }) of.first -= from.commands == 0 ? 0 : from.indices;
          },
          command);
    // Textures with prepared texels come first: only the others are decoded.
    for (const halfplane::State& state : scene.states)
      if (state.texture && std::ranges::find(slot, *state.texture) == slot.end()) slot.push_back(*state.texture);
    std::stable_partition(slot.begin(), slot.end(),
                          [this](std::uint32_t i) { return memory.slots[i].blocks.has_value(); });
    std::vector<std::uint32_t> number(memory.slots.size());
    for (const std::uint32_t i : slot) {
      number[i] = static_cast<std::uint32_t>(scene.textures.size());
      scene.textures.push_back(std::move(memory.slots[i].texture));
      if (memory.slots[i].blocks) blocks.push_back(std::move(*std::exchange(memory.slots[i].blocks, {})));
    }
    for (halfplane::State& state : scene.states)
      if (state.texture) state.texture = number[*state.texture];
  }
  ~Part() {
    if (collected.drawn.commands == 0) {
      scene.vertices.swap(collected.scene.vertices);
      scene.indices.swap(collected.scene.indices);
    }
    for (std::size_t i = 0; i < slot.size(); ++i) {
      memory.slots[slot[i]].texture = std::move(scene.textures[i]);
      if (i < blocks.size()) memory.slots[slot[i]].blocks = std::move(blocks[i]);
    }
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  Memory& memory;
  CollectedFrame& collected;
  Scene scene;
  std::vector<std::uint32_t> slot;  ///< slot of each texture
  std::vector<TexelBlocks> blocks;  ///< blocks of the first textures
};

/// Throws InputError; then the picture may hold some of the draws.
void Frame::Memory::render(Part& part) {
  const Stopwatch watch(raster_s);
  PreparedScene prepared(part.scene, std::move(part.blocks), Footprints::when_known);
  RenderOptions render;
  render.onto = picture;
  render.threads = options.threads;
  const Rendering& rendering = engine.render(prepared, render);
  part.blocks = std::move(prepared.textures);
  picture = &rendering.frame;
  gl::add(part.collected.counters, rendering.counters);
  geometry_s += rendering.geometry_s;
}

/// Renders the waiting draws, as the other one.
void Frame::Memory::render() {
  {
    Part part(*this, *this);
    render(part);
  }
  drawn = end_mark();
}

/// Begins a frame: finds out which buffers of the previous picture it reads.
void Frame::Memory::begin() {
  has_begun = true;
  cleared = {};
  for (const Command& command : scene.commands) {
    const auto* clear = std::get_if<Clear>(&command);
    if (clear == nullptr || clear_rect(scene, *clear) != Rect{0, 0, scene.width, scene.height}) break;
    cleared.color |= clear->color.has_value();
    cleared.depth |= clear->depth.has_value();
    cleared.stencil |= clear->stencil.has_value();
  }
  goes_on = !cleared.color || !cleared.depth || !(cleared.stencil || !uses_stencil);
  if (goes_on) base = *picture;
}

void Frame::Memory::flush() {
  const Stopwatch watch(waited_s, is_timed());
  wait();
  if (scene.commands.size() == drawn.commands) return;
  if (!has_begun) begin();
  kind = -1;
  draw_or_recover();
}

void Frame::Memory::draw_or_recover() {
  try {
    try {
      render();
    } catch (const InputError&) {
      recover();
    }
  } catch (const std::exception& error) {  // not even so: the frame goes on without it
    say_once(std::string("not drawn: ") + error.what());
    scene.commands.resize(drawn.commands);
    drawn = end_mark();
  }
}

/// Hands the rest of this frame over to `helper`.
void Frame::Memory::draw_beside(std::function<void(const Counters&)> after) {
  std::swap<CollectedFrame>(*this, ended.frame);
  scene.width = ended.frame.scene.width;
  scene.height = ended.frame.scene.height;
  ended.after = std::move(after);
  ended.part = std::make_unique<Part>(*this, ended.frame);
  helper.start([this] {
    try {
      render(*ended.part);
    } catch (...) {
      ended.fault = std::current_exception();
      return;
    }
    ended.after(ended.frame.counters);
  });
}

void Frame::Memory::wait() {
  if (ended.part == nullptr) return;
  helper.wait();
  ended.part.reset();
  if (ended.fault == nullptr) return;
  ended.fault = nullptr;
  std::swap<CollectedFrame>(*this, ended.frame);
  draw_or_recover();
  ended.after(counters);
  std::swap<CollectedFrame>(*this, ended.frame);
}

/// Draws the frame again without the draws that the engine refuses.
void Frame::Memory::recover() {
  const std::size_t before = drawn.commands;
  std::vector<Command> kept(scene.commands.begin(), scene.commands.begin() + static_cast<std::ptrdiff_t>(before));
  for (std::size_t i = before; i < scene.commands.size(); ++i) {
    if (const auto* draw = std::get_if<Draw>(&scene.commands[i]))
      keep_good(Draw(*draw), kept);
    else
      kept.push_back(scene.commands[i]);
  }
  scene.commands = std::move(kept);
  if (!goes_on && !cleared.stencil) {  // it was 0 everywhere when the frame began
    base = *picture;
    std::ranges::fill(base.stencil, std::uint8_t{0});
    for (Framebuffer& sample : base.samples) std::ranges::fill(sample.stencil, std::uint8_t{0});
    goes_on = true;
  }
  if (goes_on) picture = &base;
  drawn = {};
  counters = {};
  try {
    render();
  } catch (...) {
    drawn.commands = before;
    throw;
  }
}

/// Halves the list until the refused draws are isolated.
void Frame::Memory::keep_good(const Draw& draw, std::vector<Command>& kept) {
  const std::string fault = fault_of(draw);
  if (fault.empty()) {
    kept.emplace_back(draw);
    return;
  }
  const Draw list = is_list(draw.topology) ? draw : as_list(draw, false);
  const std::size_t step = list_step(primitive_type(list.topology)), half = list.count / step / 2 * step;
  if (half == 0) return say_once("not drawn: " + fault);
  Draw one = list, other = list;
  one.count = half;
  other.first += half;
  other.count -= half;
  keep_good(one, kept);
  keep_good(other, kept);
}

/// The reason why the engine refuses the draw; empty: accepted.
std::string Frame::Memory::fault_of(const Draw& draw) {
  Scene one = empty_scene();
  one.states = {scene.states[draw.state]};
  if (one.states[0].texture) {
    one.textures = {slots[*one.states[0].texture].texture};
    one.states[0].texture = 0;
  }
  for (const std::uint32_t index : std::span(scene.indices).subspan(draw.first, draw.count)) {
    one.indices.push_back(index == kRestart ? index : static_cast<std::uint32_t>(one.vertices.size()));
    if (index != kRestart) one.vertices.push_back(scene.vertices[index]);
  }
  one.commands.emplace_back(Draw{.topology = draw.topology, .count = draw.count});
  try {
    (void)render_functional(one, config);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// The frame so far becomes the picture that it goes on with.
void Frame::Memory::rebase() {
  flush();
  const Counters before = counters;
  forget();
  counters = before;
  base = *picture;
  goes_on = has_begun = true;
}

void Frame::Memory::forget() {
  ++revision;
  scene.vertices.clear();
  scene.indices.clear();
  scene.states.clear();
  scene.commands.clear();
  states.clear();
  checked.clear();
  refused.clear();
  drawn = {};
  counters = {};
  cleared = {};
  has_begun = goes_on = false;
  kind = -1;
}

// --- Frame ------------------------------------------------------------------------------------------------------------

Frame::Frame(const Options& options, int width, int height)
    : memory_(std::make_unique<Memory>(options, width, height)) {}
Frame::~Frame() = default;

int Frame::width() const { return memory_->scene.width; }
int Frame::height() const { return memory_->scene.height; }
const Options& Frame::options() const { return memory_->options; }

void Frame::resize(int width, int height) {
  const Config& config = memory_->config;
  if (width > config.target_width || height > config.target_height)
    missing("a window of " + std::to_string(width) + "x" + std::to_string(height) + " pixels",
            "its first " + std::to_string(config.target_width) + "x" + std::to_string(config.target_height) +
                " are; raise target.width and target.height");
  memory_->resize(std::clamp(width, 1, config.target_width), std::clamp(height, 1, config.target_height));
}

void Frame::clear(const halfplane::State& state, const Clear& what) { memory_->clear(state, what); }

void Frame::draw(const halfplane::State& state, Topology topology, std::span<const Vertex> vertices,
                 std::span<const std::uint32_t> indices) {
  memory_->draw(state, topology, vertices, indices);
}

std::uint32_t Frame::texture(std::uint64_t key, const std::function<halfplane::Texture()>& make) {
  return memory_->texture(key, make);
}

const Framebuffer& Frame::picture() {
  memory_->flush();
  return *memory_->picture;
}

void Frame::exchange_colors(Framebuffer& other) {
  memory_->rebase();
  Framebuffer& base = memory_->base;
  base.color.swap(other.color);
  for (std::size_t i = 0; i < base.samples.size(); ++i) base.samples[i].color.swap(other.samples[i].color);
  memory_->picture = &base;
}

void Frame::wait() { memory_->wait(); }

std::uint64_t Frame::samples_passed() {
  memory_->flush();
  return memory_->samples + memory_->counters.depth_passed - memory_->counters.alpha_killed;
}

void Frame::end(Show show) {
  memory_->end(std::move(show));
  Memory& m = *memory_;
  m.forget();
  m.drop_textures(kMostTextureBytes, std::max(m.frame + 1, kFramesKept) - kFramesKept);
  ++m.frame;
}

void Frame::missing(std::string_view what, std::string_view instead) {
  const Options& options = memory_->options;
  if (memory_->missing.contains(what)) return;  // said in this frame
  memory_->missing.emplace(what);
  const std::string text = "this configuration does not have " + std::string(what);
  if (options.on_missing == OnMissing::warn) say_once(text + "; " + std::string(instead));
  if (options.on_missing != OnMissing::stop) return;
  say_once(text + "; --on-missing stop ends the program");
  std::_Exit(2);  // nothing of the program runs any more: it may hold locks
}

std::uint64_t Frame::revision() const { return memory_->revision; }

}  // namespace halfplane::gl
