// Memory of a Frame: the frame's commands so far (frame.cpp), and its figures at its end (frame_end.cpp).
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "../../model/draw_states.hpp"
#include "../../model/engines/functional.hpp"
#include "frame.hpp"
#include "helper_thread.hpp"

namespace halfplane::gl {

/// One line on stderr, once for each text; numbers in it do not make it another one.
void say_once(const std::string& what);
/// The process's next frame: frames of all its drawables count together, so that a number names one picture.
[[nodiscard]] int next_frame_number();

using Clock = std::chrono::steady_clock;

/// Adds the seconds of its life to `seconds`, if it runs.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds, bool runs = true) : seconds_(seconds), runs_(runs) {
    if (runs) start_ = Clock::now();
  }
  ~Stopwatch() {
    if (runs_) seconds_ += std::chrono::duration<double>(Clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  bool runs_;
  Clock::time_point start_;
};

/// A frame so far. Textures of its states are numbers of Frame::Memory::slots.
struct CollectedFrame {
  Scene scene;
  std::unordered_map<halfplane::State, std::uint32_t, StateHash> states;  ///< number in `scene`
  std::vector<std::uint8_t> checked, refused;                             ///< by state: primitive types, a bit each
  std::uint32_t last_state = 0;                                           ///< the state that was asked for last
  int kind = -1;  ///< kind of the waiting draws, see kind_of(); -1: none

  /// How much of the scene has been drawn.
  struct Mark {
    std::size_t commands = 0, vertices = 0, indices = 0;
  };
  Mark drawn;
  Counters counters;  ///< of all draws so far

  bool goes_on = false;    ///< the frame looks at some of the picture before it
  bool has_begun = false;  ///< some of it has been drawn: goes_on is known
  struct Cleared {
    bool color = false, depth = false, stencil = false;
  };
  Cleared cleared;  ///< buffers cleared as a whole before the first draw

  [[nodiscard]] Mark end_mark() const { return {scene.commands.size(), scene.vertices.size(), scene.indices.size()}; }
};

struct Frame::Memory : CollectedFrame {
  Memory(const Options& options_, int width, int height);

  /// Collecting.
  void resize(int width, int height);
  void clear(const halfplane::State& state, Clear what);
  void draw(const halfplane::State& state, Topology topology, std::span<const Vertex> vertices,
            std::span<const std::uint32_t> indices);
  [[nodiscard]] std::uint32_t texture(std::uint64_t key, const std::function<halfplane::Texture()>& make);

  /// Renders the waiting draws.
  void flush();
  void end(Show show);
  /// Waits for `ended`.
  void wait();

  const Options options;
  const Config config;
  FunctionalEngine engine;
  const Framebuffer* picture = nullptr;  ///< the engine's
  double raster_s = 0;                   ///< since the program began
  std::uint64_t samples = 0;             ///< passed in earlier frames

  Framebuffer base;           ///< the picture that the frame continues, where `goes_on`
  bool uses_stencil = false;  ///< since the program began

  struct Slot {
    std::uint64_t key = 0, frame = 0;  ///< the frame that it was used in last
    halfplane::Texture texture;        ///< without levels while a Part has it
    std::optional<TexelBlocks> blocks;
    std::size_t bytes = 0;  ///< 0: free
  };
  std::vector<Slot> slots;
  std::unordered_map<std::uint64_t, std::uint32_t> slot_of;
  std::size_t texture_bytes = 0;
  std::uint64_t frame = 0, textures_made = 0;
  std::uint64_t revision = 1;  ///< Frame::revision()

  // Results and the HUD (frame_end.cpp).
  // Seconds of this frame: of collecting, of waiting for the one before; of rendering, the engine's host side.
  double driver_s = 0, waited_s = 0, geometry_s = 0;
  double raster_before_s = 0;
  Clock::time_point frame_start = Clock::now();
  double frames_per_second = 0;
  std::optional<std::uint64_t> last_cycles;
  std::uint64_t last_primitives = 0;
  std::set<std::string, std::less<>> missing;  ///< of this frame

  /// The frame as a scene of its own. `restores`: begins with the picture that it was drawn on, where it looks at that.
  [[nodiscard]] Scene whole(bool restores) const;

  struct Part;

  /// The frame before this one, while `helper` renders what was left of it. Until wait() only the helper uses the engine, its
  /// picture, and the figures of rendering.
  struct Ended {
    CollectedFrame frame;
    std::unique_ptr<Part> part;
    std::function<void(const Counters&)> after;  ///< when it is drawn
    std::exception_ptr fault;                    ///< it was not
  };
  Ended ended;
  HelperThread helper;

  [[nodiscard]] Scene empty_scene() const;
  /// Whether someone reads the seconds of this frame.
  [[nodiscard]] bool is_timed() const { return !options.results.empty(); }
  [[nodiscard]] bool is_recorded() const { return options.is_recorded(); }
  [[nodiscard]] std::uint32_t state_number(const halfplane::State& state);
  [[nodiscard]] bool takes(std::uint32_t state, Topology topology);
  [[nodiscard]] bool can_draw(const halfplane::State& state, std::span<const std::uint32_t> primitive) const;
  [[nodiscard]] Draw as_list(const Draw& draw, bool only_good);
  void add(Draw draw);
  void begin();
  void forget();
  void render();
  void render(Part& part);
  void draw_or_recover();
  void draw_beside(std::function<void(const Counters&)> after);
  void recover();
  void keep_good(const Draw& draw, std::vector<Command>& kept);
  [[nodiscard]] std::string fault_of(const Draw& draw);
  void rebase();
  void drop_textures(std::size_t most_bytes, std::uint64_t least_frame);
  void restore(Scene& whole) const;
  [[nodiscard]] nlohmann::ordered_json figures(int number) const;
  void save(int number) const;
};

}  // namespace halfplane::gl
