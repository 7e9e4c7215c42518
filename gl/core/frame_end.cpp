// The end of a frame: captures, cycles, results, and the line of figures over the picture.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "../../model/capture/capture.hpp"
#include "../../model/engines/cycle/cycle_model.hpp"
#include "../../model/host/primitives.hpp"
#include "../../model/stages/color_ops.hpp"
#include "frame_memory.hpp"

namespace halfplane::gl {
namespace {

using Json = nlohmann::ordered_json;

/// Keys as `halfplane render` has them.
Json counters_json(const Counters& c) {
  Json skipped = Json::object();
  for (const SkipName& one : kSkipNames) skipped[one.name] = c.skipped.*one.counter;
  return {{"primitives", {{"in", c.primitives_in}, {"culled", c.culled}, {"drawn", c.drawn}, {"clipped", c.clipped}}},
          {"fragments",
           {{"covered", c.covered},
            {"depth_passed", c.depth_passed},
            {"alpha_killed", c.alpha_killed},
            {"written", c.written}}},
          {"samples_tested", c.samples_tested},
          {"tiles_visited", c.tiles_visited},
          {"skipped", std::move(skipped)}};
}

/// Bytes between chip and memory, by cause and plane.
Json traffic_json(const CycleRun& run, const Config& config, std::uint64_t& total) {
  constexpr std::array kPlanes{"depth", "color"};
  const auto port_bytes = static_cast<std::uint64_t>(config.memory_port_bits / 8);
  Json traffic;
  for (std::size_t cause = 0; cause < kMoveCauses.size(); ++cause)
    for (std::size_t plane = 0; plane < kPlanes.size(); ++plane) {
      const std::uint64_t bytes = run.totals.beats[cause][plane] * port_bytes;
      traffic[std::string(kMoveCauses[cause])][kPlanes[plane]] = bytes;
      total += bytes;
    }
  const std::uint64_t texels =
      run.totals.texel_beats * static_cast<std::uint64_t>(derive_widths(config).texture_port_bytes);
  if (texels != 0) traffic["fill"]["texture"] = texels;
  total += texels;
  return traffic;
}

/// Cycles of each stage's output.
Json stages_json(const CycleRun& run) {
  Json stages = Json::object();
  for (const Arrow out : kElastic) {
    const Stage sender = info(out).from;
    if (!info(sender).is_timed || out == Arrow::response) continue;
    const StreamUse& use = run.use[index(out)];
    if (use.busy != 0)
      stages[std::string(info(sender).name)] = {
          {"busy", use.busy}, {"stalled", use.stalled}, {"starved", use.starved}, {"items", use.busy}};
  }
  return stages;
}

/// Adds a line to a file that `halfplane run` renames and reads at any time: not to one that was renamed in between.
bool append_line(const std::string& path, std::string line) {
  line += '\n';
  for (int i = 0; i < 100; ++i) {
    const int file = open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) return false;
    struct stat opened {
    }, named{};
    const bool is_named = flock(file, LOCK_EX) == 0 && fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
                          opened.st_ino == named.st_ino;
    const bool is_written = is_named && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    close(file);
    if (is_named) return is_written;
  }
  return false;
}

/// FNV-1a of the codes, as `halfplane render` has it.
std::string color_hash(const Framebuffer& frame, ColorFormat format) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const int bytes = format == ColorFormat::rgb565 ? 2 : 4;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      for (int i = 0; i < bytes; ++i) hash = (hash ^ (frame.color[frame.at(x, y)] >> 8 * i & 0xff)) * 0x100000001b3;
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

/// "frame.hpt" as "frame-0007.hpt".
std::string numbered(const std::string& path, int number) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "-%04d", number);
  const std::filesystem::path name(path);
  return (name.parent_path() / (name.stem().string() + digits.data() + name.extension().string())).string();
}

/// Channels of a stored colour, 0 to 255.
template <class Channel>
std::array<Channel, 4> channels_of(std::uint32_t code, ColorFormat format) {
  const auto [r, g, b, a] = widen_color(format, code);
  return {static_cast<Channel>(r), static_cast<Channel>(g), static_cast<Channel>(b), static_cast<Channel>(a)};
}

// A font of 3 x 5 pixels: an octal digit a row, its highest bit on the left.
struct Glyph {
  char character;
  unsigned rows;
};
constexpr std::array kFont{Glyph{'0', 075557}, Glyph{'1', 026227}, Glyph{'2', 071747}, Glyph{'3', 071717},
                           Glyph{'4', 055711}, Glyph{'5', 074717}, Glyph{'6', 074757}, Glyph{'7', 071111},
                           Glyph{'8', 075757}, Glyph{'9', 075717}, Glyph{'.', 000002}, Glyph{'A', 025755},
                           Glyph{'C', 034443}, Glyph{'E', 074647}, Glyph{'F', 074644}, Glyph{'H', 055755},
                           Glyph{'I', 072227}, Glyph{'L', 044447}, Glyph{'M', 057755}, Glyph{'N', 065555},
                           Glyph{'O', 025552}, Glyph{'P', 065644}, Glyph{'R', 065655}, Glyph{'S', 034216},
                           Glyph{'T', 072222}, Glyph{'V', 055552}, Glyph{'Y', 055222}, Glyph{'Z', 071247}};
constexpr int kGlyphWidth = 3, kGlyphHeight = 5, kScale = 2;

}  // namespace

std::string saved_name(const Options& options, int number) {
  if (options.save_all) return numbered((std::filesystem::path(options.save_to) / "frame.hpt").string(), number);
  if (options.save_to.empty()) return numbered("frame.hpt", number);
  return options.save.size() == 1 ? options.save_to : numbered(options.save_to, number);
}

// --- captures ---------------------------------------------------------------------------------------------------------

Scene Frame::Memory::whole(bool restores) const {
  Scene whole = empty_scene();
  if (restores && goes_on) restore(whole);
  const auto vertices = static_cast<std::uint32_t>(whole.vertices.size()),
             states_before = static_cast<std::uint32_t>(whole.states.size());
  const std::size_t indices = whole.indices.size();
  whole.vertices.insert(whole.vertices.end(), scene.vertices.begin(), scene.vertices.end());
  for (const std::uint32_t index : scene.indices) whole.indices.push_back(index == kRestart ? index : index + vertices);
  for (Command command : scene.commands) {
    std::visit(
        [&](auto& of) {
          if constexpr (requires { of.state; }) of.state += states_before;
          if constexpr (requires { of.first; }) of.first += indices;
        },
        command);
    whole.commands.push_back(command);
  }
  std::map<std::uint32_t, std::uint32_t> number;
  for (halfplane::State state : scene.states) {
    if (state.texture && *state.texture < slots.size() && !slots[*state.texture].texture.level.empty()) {
      const auto [at, is_new] = number.try_emplace(*state.texture, static_cast<std::uint32_t>(whole.textures.size()));
      if (is_new) whole.textures.push_back(slots[at->first].texture);
      state.texture = at->second;
    } else {
      state.texture.reset();  // refused draws lose their texture
    }
    whole.states.push_back(state);
  }
  return whole;
}

/// The picture that the frame goes on with, but for cleared buffers: colours as rectangles with a texture, depths and stencil
/// values as points.
void Frame::Memory::restore(Scene& whole) const {
  const std::uint32_t far = DepthEncode(config, {}).of_window(1.0);
  halfplane::State state;
  state.space = Space::window;
  state.depth_test = DepthFunc::always;
  whole.states.push_back(state);
  whole.commands.emplace_back(Clear{0, channels_of<double>(base.color[0], config.color_format), 1.0, std::uint8_t{0}});
  const auto add = [&whole](const halfplane::State& with, Topology topology, std::size_t first) {
    whole.commands.emplace_back(Draw{.state = static_cast<std::uint32_t>(whole.states.size()),
                                     .topology = topology,
                                     .first = first,
                                     .count = whole.indices.size() - first});
    whole.states.push_back(with);
  };

  // Sides of powers of two, which every texture unit takes.
  constexpr int kSide = 1024;
  const auto side_of = [](int pixels) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(pixels))); };
  for (int top = 0; !cleared.color && top < base.height; top += kSide)
    for (int left = 0; left < base.width; left += kSide) {
      const int width = std::min(kSide, base.width - left), height = std::min(kSide, base.height - top);
      halfplane::Texture texture;
      texture.name = "before" + std::to_string(whole.textures.size());
      texture.format = config.color_format == ColorFormat::rgb565 ? TextureFormat::rgb565 : TextureFormat::rgba8888;
      TextureLevel& level = texture.level.emplace_back();
      level = {side_of(width), side_of(height), {}};
      level.code.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const std::uint32_t code = base.color[base.at(left + x, top + y)];
          level
              .code[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x)] =
              encode_texel(texture.format, channels_of<std::uint8_t>(code, config.color_format), {});
        }
      halfplane::State rectangle = state;
      rectangle.depth_write = false;
      rectangle.texture = static_cast<std::uint32_t>(whole.textures.size());
      rectangle.texture_combine = TextureCombine::replace;
      const std::size_t first = whole.indices.size();
      const auto corner = static_cast<std::uint32_t>(whole.vertices.size());
      for (const auto& [x, y] : {std::pair{0, 0}, {width, 0}, {0, height}, {width, height}})
        whole.vertices.push_back({static_cast<double>(left + x),
                                  static_cast<double>(top + y),
                                  0,
                                  1,
                                  {255, 255, 255, 255},
                                  static_cast<double>(x) / level.width,
                                  static_cast<double>(y) / level.height});
      for (const std::uint32_t i : {0U, 1U, 2U, 2U, 1U, 3U}) whole.indices.push_back(corner + i);
      whole.textures.push_back(std::move(texture));
      add(rectangle, Topology::triangles, first);
    }

  std::map<std::uint8_t, std::vector<std::pair<int, int>>> points;  // by stencil value
  for (int y = 0; y < base.height; ++y)
    for (int x = 0; x < base.width; ++x) {
      const std::size_t at = base.at(x, y);
      const std::uint8_t value = cleared.stencil ? std::uint8_t{0} : base.stencil[at];
      if ((!cleared.depth && base.depth[at] != far) || value != 0) points[value].emplace_back(x, y);
    }
  for (const auto& [value, places] : points) {
    halfplane::State pixel = state;
    pixel.color_write = false;
    pixel.depth_write = !cleared.depth;
    if (value != 0) pixel.stencil = Stencil{.reference = value, .passes = StencilOp::replace};
    const std::size_t first = whole.indices.size();
    for (const auto& [x, y] : places) {
      whole.indices.push_back(static_cast<std::uint32_t>(whole.vertices.size()));
      whole.vertices.push_back({x + 0.5, y + 0.5, static_cast<double>(base.depth[base.at(x, y)]) / far});
    }
    add(pixel, Topology::points, first);
  }
}

/// The frame as a capture, whole or not at all.
void Frame::Memory::save(int number) const {
  const std::string name = saved_name(options, number), part = name + ".part";
  std::error_code error;
  try {
    std::ofstream out(part);
    out << "# Frame " << number << " of a program that drew through OpenGL\n";
    if (goes_on) out << "# It goes on with the picture before it, which the first draws put back\n";
    if (goes_on && (!base.samples.empty() || !DepthEncode(config, {}).is_identity()))
      out << "# but for the samples of its pixels and depths in a format of their own\n";
    write_capture(whole(true), out);
    out.close();
    if (!out) error = std::make_error_code(std::errc::io_error);
    if (!error) std::filesystem::rename(part, name, error);
  } catch (const InputError& fault) {
    say_once("frame " + std::to_string(number) + " is not saved: " + fault.what());
    error = std::make_error_code(std::errc::invalid_argument);
  }
  if (!error) return;
  say_once(name + ": " + error.message());
  std::filesystem::remove(part, error);
}

// --- the end of a frame -----------------------------------------------------------------------------------------------

/// Figures that are known without drawing the frame again.
nlohmann::ordered_json Frame::Memory::figures(int number) const {
  Json row{{"frame", number}, {"width", scene.width}, {"height", scene.height}, {"goes_on", goes_on}};
  row.update(counters_json(counters));
  const auto draws = std::ranges::count_if(
      scene.commands, [](const Command& command) { return std::holds_alternative<Draw>(command); });
  row["draws"] = draws;
  row["textures"] =
      std::ranges::count_if(slots, [this](const Slot& slot) { return slot.frame == frame && slot.key != 0; });
  row["texture_bytes"] = texture_bytes;
  for (const char* key : {"cycles", "bytes", "bins", "pairs", "color_hash", "lacks"}) row[key] = nullptr;
  return row;
}

void Frame::Memory::end(Show show) {
  const bool is_beside =
      options.threads > 1 && !is_recorded() && !options.hud && scene.commands.size() != drawn.commands;
  if (is_beside) {
    const Stopwatch watch(waited_s, is_timed());
    wait();
  } else {
    flush();
  }
  if (!has_begun) begin();
  const int number = next_frame_number();
  const bool is_asked = number >= options.first_frame && (options.last_frame < 0 || number <= options.last_frame);
  const bool is_saved = options.save_all ? is_asked : std::ranges::find(options.save, number) != options.save.end();
  if (is_saved) save(number);

  const bool is_told = is_asked && (!options.results.empty() || options.cycles);
  Json row = is_told ? figures(number) : Json();
  if (options.cycles && is_asked) {
    try {
      MemorySettings settings;
      if (!options.memory.empty()) set_memory(settings, options.memory);
      settings.latency = options.memory_latency;
      if (options.mhz >= 1) settings.mhz = static_cast<int>(options.mhz);
      const auto timing = make_memory(settings, config);
      CycleOptions cycle;
      cycle.textures = settings;
      const CycleRendering measured = render_cycle(whole(false), config, *timing, {}, cycle);
      std::uint64_t bytes = 0;
      row["traffic_bytes"] = traffic_json(measured.run, config, bytes);
      row["cycles"] = *(last_cycles = measured.run.cycles);
      row["bytes"] = bytes;
      row["bins"] = measured.rendering.counters.bins;
      row["pairs"] = measured.rendering.counters.pairs;
      row["stages"] = stages_json(measured.run);
    } catch (const std::exception& error) {
      row["lacks"] = error.what();
      say_once(std::string("no cycles: ") + error.what());
    }
  }
  if (is_told && (is_saved || !row["cycles"].is_null())) row["color_hash"] = color_hash(*picture, config.color_format);

  const Clock::time_point now = Clock::now();
  const double frame_s = std::chrono::duration<double>(now - std::exchange(frame_start, now)).count();
  // Over the last frames, so that the figure can be read.
  const double rate = 1 / std::max(frame_s, 1e-6);
  frames_per_second = frames_per_second == 0 ? rate : frames_per_second + (rate - frames_per_second) / 8;
  if (is_told) {
    row["time_s"] = {{"geometry", 0}, {"raster", 0}, {"driver", driver_s}, {"waited", waited_s}, {"frame", frame_s}};
    row["missing"] = missing;
  }
  missing.clear();
  driver_s = waited_s = 0;

  // The helper may call this.
  auto after = [this, row = std::move(row), show = std::move(show)](const Counters& all) mutable {
    samples += all.depth_passed - all.alpha_killed;
    last_primitives = all.primitives_in;
    const double drawing = raster_s - std::exchange(raster_before_s, raster_s), geometry = std::exchange(geometry_s, 0);
    if (!row.is_null() && !options.results.empty()) {
      row.update(counters_json(all));
      row["time_s"]["geometry"] = geometry;
      row["time_s"]["raster"] = drawing - geometry;
      if (!append_line(options.results, row.dump(-1, ' ', false, Json::error_handler_t::replace)))
        say_once(options.results + ": cannot be written");
    }
    if (show) show(*picture);
  };
  is_beside ? draw_beside(std::move(after)) : after(counters);
}

// --- the HUD ----------------------------------------------------------------------------------------------------------

void Frame::draw_hud(std::span<std::uint32_t> xrgb, int width, int height, int pitch_pixels) const {
  const Memory& m = *memory_;
  if (!m.options.hud) return;
  std::array<char, 96> line{};
  if (m.last_cycles)
    std::snprintf(line.data(), line.size(), "%.1f FPS %.3fM CYCLES %.0fMHZ FOR 30", m.frames_per_second,
                  static_cast<double>(*m.last_cycles) / 1e6, std::ceil(static_cast<double>(*m.last_cycles) * 30 / 1e6));
  else
    std::snprintf(line.data(), line.size(), "%.1f FPS  %llu PRIMITIVES", m.frames_per_second,
                  static_cast<unsigned long long>(m.last_primitives));
  const std::string_view text(line.data());
  constexpr int kMargin = kScale, kAdvance = (kGlyphWidth + 1) * kScale;
  constexpr std::uint32_t kInk = 0xffffff, kPaper = 0x000000;
  const int columns = std::min(width, static_cast<int>(text.size()) * kAdvance + 2 * kMargin),
            rows = std::min(height, kGlyphHeight * kScale + 2 * kMargin);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(pitch_pixels) + static_cast<std::size_t>(x);
      if (at >= xrgb.size()) return;
      const int i = x - kMargin, column = i % kAdvance / kScale, row = (y - kMargin) / kScale;
      bool is_ink = false;
      if (i >= 0 && static_cast<std::size_t>(i / kAdvance) < text.size() && y >= kMargin && row < kGlyphHeight &&
          column < kGlyphWidth) {
        const auto* glyph = std::ranges::find(kFont, text[static_cast<std::size_t>(i / kAdvance)], &Glyph::character);
        is_ink = glyph != kFont.end() && (glyph->rows >> (3 * (kGlyphHeight - 1 - row) + 2 - column) & 1U) != 0;
      }
      xrgb[at] = is_ink ? kInk : kPaper;
    }
}

}  // namespace halfplane::gl
