#include "hardware.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <utility>
#include <variant>

#include "../packets/packet_words.hpp"
#include "../stages/block_cache.hpp"
#include "../stages/coarse_raster.hpp"
#include "../stages/cull.hpp"
#include "../stages/fine_raster.hpp"
#include "../stages/fragment_path.hpp"
#include "../stages/hiz.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/memory_port.hpp"
#include "../stages/primitive_join.hpp"
#include "../stages/tile_cache.hpp"
#include "../stages/triangle_setup.hpp"
#include "hardware_watch.hpp"

namespace halfplane {

class HardwareModel::Pipeline final : private MemoryPort {
 public:
  Pipeline(const Config& config, PacketSink& sink, TileMemory memory)
      : config_(config),
        widths_(derive_widths(config)),
        sink_(sink),
        hiz_(config, widths_),
        cache_(std::in_place_type<TileCache>, config, widths_),
        memory_(std::move(memory)),
        path_(config, widths_),
        port_(widths_, memory_.layout()) {
    if (config.cache_kind == CacheKind::blocks) cache_.emplace<BlockCache>(config, widths_);
  }
  void hold_textures(TextureMemory textures) { texels_ = std::move(textures); }
  void tap_writes(std::function<void(const WritePacket&)> tap) { written_ = std::move(tap); }
  void set_watch(HardwareWatch* watch) { watch_ = watch; }
  void run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line);
  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] const CounterPacket& counters() const { return counters_; }
  [[nodiscard]] const TileMemory& memory() const { return memory_; }

 private:
  void join(const FragmentPacket& fragment);
  void shade(const FragmentPacket& fragment);
  void request(const MemoryRequest& request) override;
  const MemoryResponse& response() override;
  void set_state(const FragmentPacket& token);
  struct StampPort;
  [[nodiscard]] TextureLine read_texels(std::uint32_t address, int beats);

  Config config_;
  Widths widths_;
  PacketSink& sink_;
  HardwareWatch* watch_ = nullptr;
  CounterPacket counters_;
  Hiz hiz_;
  std::variant<TileCache, BlockCache> cache_;
  TileMemory memory_;
  FragmentPath path_;
  TextureMemory texels_;
  PortStage port_;
  std::deque<MemoryResponse> responses_;  ///< to earlier requests
  MemoryResponse response_;
  std::uint8_t slot_ = 0;  ///< context slot of the next primitive
  std::function<void(const WritePacket&)> written_;
};

void HardwareModel::Pipeline::run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line) {
  const auto triangle = cull(primitive, widths_, counters_, config_.setup_kind == SetupKind::pipelined);
  if (!triangle) return;
  sink_.take(on<Arrow::triangle>, *triangle);
  const SetupPacket setup = setup_packet(*triangle, config_, widths_);
  sink_.take(on<Arrow::setup>, setup);
  const ContextPacket context = make_context(setup, widths_);
  sink_.take(on<Arrow::context>, context);
  const EdgeContext edges = make_edge_context(setup);
  FragmentPacket fragment;  // of each stamp in turn
  coarse_raster(setup, slot_, hiz_, widths_, counters_, [&](const TilePacket& tile) {
    sink_.take(on<Arrow::tile>, tile);
    sink_.take(on<Arrow::edges>, edges);
    fine_raster(tile, edges, widths_, [&](const StampPacket& stamp) {
      sink_.take(on<Arrow::stamp>, stamp);
      interpolate(stamp, context, widths_, fragment);
      if (line) {
        line_raster(*line, widths_, [&](const LinePixel& pixel) {
          sink_.take(on<Arrow::line_pixel>, pixel);
          set_line_pixel(pixel, widths_, fragment);
          join(fragment);
        });
      } else {
        join(fragment);
      }
    });
  });
  slot_ = static_cast<std::uint8_t>((slot_ + 1) % config_.context_slots);
}

void HardwareModel::Pipeline::join(const FragmentPacket& fragment) {
  sink_.take(on<Arrow::fragment>, fragment);
  shade(fragment);
}

/// The caches, the texture memory and the sink, as the fragment path sees them.
struct HardwareModel::Pipeline::StampPort {
  static constexpr bool kSendsPackets = true;
  Pipeline& model;
  const FragmentPacket& fragment;

  [[nodiscard]] std::span<const std::uint32_t> stored() const {
    const std::span<const std::uint32_t> words = std::visit(
        [this](auto& cache) -> std::span<const std::uint32_t> {
          return cache.access(fragment, model, model.counters_);
        },
        model.cache_);
    if (model.watch_ != nullptr) {
      if (const auto* blocks = std::get_if<BlockCache>(&model.cache_))
        model.watch_->looked_up(fragment, blocks->last_lookup());
      model.watch_->meets(fragment, words, model.path_.stencil());
    }
    return words;
  }
  void interpolate_colors(SampleMask) const {}
  void interpolate_over_w(SampleMask) const {}
  [[nodiscard]] TextureLine read(std::uint32_t address, int beats) const { return model.read_texels(address, beats); }
  [[nodiscard]] std::span<const std::uint32_t> stored_colors(SampleMask) const {
    return std::get<BlockCache>(model.cache_).colors();
  }
  void send(const WritePacket& packet) const { model.sink_.take(on<Arrow::write>, packet); }
  void send(const ColorPacket& packet) const { model.sink_.take(on<Arrow::color>, packet); }
  void write(const WritePacket& packet) const {
    std::visit([&](auto& cache) { cache.write(fragment, packet); }, model.cache_);
    if (model.written_) model.written_(packet);
  }
};

/// depth_test, rop and framebuffer.
void HardwareModel::Pipeline::shade(const FragmentPacket& fragment) {
  switch (fragment.kind) {
    case PrimitiveKind::fast_clear: {
      const std::uint32_t color = stored_color(fragment.code[0], config_);
      const std::uint32_t depth = depth_word(fragment.code[0][kDepthPlane], path_.stencil().clear_value(), widths_);
      std::visit([&](auto& cache) { cache.fast_clear(fragment, depth, color, *this, counters_); }, cache_);
      if (fragment.state.depth_write) memory_.set_clear_value(TilePlane::depth, depth);
      if (fragment.state.color_write) memory_.set_clear_value(TilePlane::color, color);
      return;
    }
    case PrimitiveKind::flush:
      std::visit([&](auto& cache) { cache.flush(fragment, *this, counters_); }, cache_);
      return;
    case PrimitiveKind::state: set_state(fragment); return;
    case PrimitiveKind::triangle:
    case PrimitiveKind::rectangle:
    case PrimitiveKind::point:
    case PrimitiveKind::line: break;
  }
  if (fragment.mask.any()) {
    const StampFate fate = path_.shade(fragment, counters_, StampPort{*this, fragment});
    if (watch_ != nullptr) watch_->shaded(fragment, fate, path_.colors());
  }
  if (fragment.ends_visit) {
    const RetirePacket retired = path_.retire(fragment);
    sink_.take(on<Arrow::retire>, retired);
    hiz_.retire(retired);
  }
}

/// Sets a register of a unit downstream of the depth test.
void HardwareModel::Pipeline::set_state(const FragmentPacket& token) {
  const StateRegister which = state_register(token.state);
  path_.set(which, token);
  if (!is_of_texture(which)) std::get<BlockCache>(cache_).set(path_.colors(), path_.stencil());
}

TextureLine HardwareModel::Pipeline::read_texels(std::uint32_t address, int beats) {
  sink_.take(on<Arrow::texture>, TextureRequest{address, static_cast<std::uint16_t>(beats)});
  TextureLine line{};
  const auto bytes = static_cast<std::size_t>(widths_.texture_port_bytes);
  for (std::size_t n = 0; n < static_cast<std::size_t>(beats); ++n) {
    TexelBeat beat;
    texels_.read(address + static_cast<std::uint32_t>(n * bytes), std::span(beat.data).first(bytes));
    std::copy_n(beat.data.begin(), bytes, line.begin() + static_cast<std::ptrdiff_t>(n * bytes));
    sink_.take(on<Arrow::texel>, beat);
  }
  return line;
}

void HardwareModel::Pipeline::request(const MemoryRequest& request) {
  sink_.take(on<Arrow::request>, request);
  port_.take(request, [&](const MemoryBeat& beat) {
    sink_.take(on<Arrow::beat>, beat);
    if (beat.is_write) {
      memory_.write(beat);
      if (beat.length == 1) sink_.take(on<Arrow::answer>, MemoryAnswer{true, {}});
      return;
    }
    MemoryAnswer answer;
    for (std::uint32_t n = 0; n < beat.length; ++n) {
      memory_.read(beat.address + (n << widths_.memory.port), answer.data);
      sink_.take(on<Arrow::answer>, answer);
      port_.answer(answer, [&](const MemoryResponse& response) {
        sink_.take(on<Arrow::response>, response);
        responses_.push_back(response);
      });
    }
  });
}

const MemoryResponse& HardwareModel::Pipeline::response() {
  response_ = responses_.front();
  responses_.pop_front();
  return response_;
}

HardwareModel::HardwareModel(const Config& config, PacketSink& sink)
    : HardwareModel(config, sink, TileMemory(config)) {}
HardwareModel::HardwareModel(const Config& config, PacketSink& sink, TileMemory memory)
    : pipeline_(std::make_unique<Pipeline>(config, sink, std::move(memory))) {}
HardwareModel::~HardwareModel() = default;
HardwareModel::HardwareModel(HardwareModel&&) noexcept = default;
HardwareModel& HardwareModel::operator=(HardwareModel&&) noexcept = default;

void HardwareModel::hold_textures(const Scene& scene) { hold_textures(TextureMemory(scene, pipeline_->config())); }
void HardwareModel::hold_textures(TextureMemory textures) { pipeline_->hold_textures(std::move(textures)); }
void HardwareModel::set_watch(HardwareWatch* watch) { pipeline_->set_watch(watch); }
void HardwareModel::tap_writes(std::function<void(const WritePacket&)> tap) { pipeline_->tap_writes(std::move(tap)); }
void HardwareModel::run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line) {
  pipeline_->run(primitive, line);
}
const CounterPacket& HardwareModel::counters() const { return pipeline_->counters(); }
const TileMemory& HardwareModel::memory() const { return pipeline_->memory(); }

CounterPacket as_counted(CounterPacket counters, const Widths& widths) {
  counters.overflow = false;
  bool overflow = false;
  for_each_value(std::as_const(counters), widths, [&overflow](const auto& value, const Width& width) {
    overflow = overflow || to_bits(value) >> width.bits != 0;
  });
  counters.overflow = overflow;
  return counters;
}

CounterPacket since(CounterPacket now, const CounterPacket& before) {
  using P = CounterPacket;
  for (auto counter : {&P::primitives_in,   &P::zero_area,      &P::backface,       &P::empty,
                       &P::no_sample,       &P::tiles_visited,  &P::tiles_outside,  &P::trivially_accepted,
                       &P::tiles_hiz,       &P::samples_tested, &P::covered,        &P::depth_passed,
                       &P::written,         &P::tile_fills,     &P::tile_evictions, &P::tile_clears,
                       &P::texture_samples, &P::texture_hits,   &P::texture_fills,  &P::alpha_killed})
    now.*counter -= before.*counter;
  return now;
}

void count_hardware(const CounterPacket& hardware, std::uint64_t drawn, Counters& counters) {
  // One input triangle may have sent several pieces: pieces without a pixel are counted by triangle, not by piece.
  const std::uint64_t culled_before_box = counters.culled + hardware.zero_area + hardware.backface;
  counters.drawn += drawn;  // the host counts lines and points
  counters.culled = counters.primitives_in - counters.drawn;
  counters.skipped.empty += counters.culled - culled_before_box;
  counters.skipped.zero_area += hardware.zero_area;
  counters.skipped.backface += hardware.backface;
  counters.skipped.no_sample += hardware.no_sample;
  counters.skipped.tiles_outside = hardware.tiles_outside;
  counters.skipped.trivially_accepted = hardware.trivially_accepted;
  counters.skipped.tiles_hiz = hardware.tiles_hiz;
  counters.skipped.fragments_early_z = hardware.covered - hardware.depth_passed;
  counters.tiles_visited = hardware.tiles_visited;
  counters.samples_tested = hardware.samples_tested;
  counters.covered = hardware.covered;
  counters.depth_passed = hardware.depth_passed;
  counters.alpha_killed = hardware.alpha_killed;
  counters.written = hardware.written;
  counters.texture = {hardware.texture_samples, hardware.texture_hits, hardware.texture_fills};
}

Rendering HardwareFrames::draw(const Scene& scene, const RenderOptions& options) {
  if (!options.skip.bins) held_.forget();
  return draw(scene, options, &held_);
}

Rendering HardwareFrames::draw(const Scene& scene, const RenderOptions& options, BinContents* held) {
  const auto started = std::chrono::steady_clock::now();
  HostStream host(scene, config_, held);
  model_.hold_textures(scene);
  DrawnCount drawn;
  std::uint32_t sent = 0;
  while (const auto primitive = host.next()) {
    const std::uint64_t dropped_before = drawn.dropped(model_.counters());
    model_.run(primitive->packet, primitive->line);
    drawn.add(*primitive, drawn.dropped(model_.counters()) == dropped_before);
    if (options.progress && ++sent % 4096 == 0) options.progress(host.progress());
  }
  Rendering rendering;
  rendering.frame = to_framebuffer(model_.memory(), scene.width, scene.height, config_);
  rendering.counters = host.counters();
  count_hardware(since(model_.counters(), counted_), drawn.count(), rendering.counters);
  counted_ = model_.counters();
  rendering.raster_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return rendering;
}

Rendering render_hardware(const Scene& scene, const Config& config, const RenderOptions& options) {
  return HardwareFrames(config).draw(scene, options, nullptr);
}

}  // namespace halfplane
