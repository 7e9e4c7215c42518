#include "hardware.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>

#include "../packets/packet_words.hpp"
#include "../stages/coarse_raster.hpp"
#include "../stages/cull.hpp"
#include "../stages/fine_raster.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/primitive_join.hpp"
#include "../stages/resolve.hpp"
#include "../stages/triangle_setup.hpp"

namespace halfplane {

std::uint8_t memory_garbage(std::uint32_t address) {
  const std::uint32_t mixed = (address ^ 0xDEADBEEFU) * 0x9E3779B1U;  // an odd factor: no bit is lost
  return static_cast<std::uint8_t>(mixed >> 24);
}

TileMemory::TileMemory(const Config& config) : TileMemory(config, default_layout(derive_widths(config))) {}

TileMemory::TileMemory(const Config& config, const MemoryLayout& layout)
    : widths_(derive_widths(config)),
      layout_(layout),
      end_(layout_end(layout, widths_)),
      has_flags_{true, config.frame_clears == FrameClears::flags},
      compresses_(config.compress_units != 0),
      page_((end_ - 1) / kPage + 1, kNone) {}

std::uint8_t TileMemory::byte(std::uint32_t address) const {
  const std::uint32_t page = page_[address / kPage];
  return page == kNone ? memory_garbage(address) : bytes_[std::size_t{page} * kPage + address % kPage];
}

std::span<const std::uint8_t> TileMemory::page(std::size_t n) const {
  if (page_[n] == kNone) return {};
  return std::span(bytes_).subspan(std::size_t{page_[n]} * kPage, kPage);
}

void TileMemory::read(std::uint32_t address, MemoryBeat::Bytes& data) const {
  for (int n = 0; n < widths_.port_bytes; ++n)
    data[static_cast<std::size_t>(n)] = byte(address + static_cast<std::uint32_t>(n));
}

void TileMemory::write(const MemoryBeat& beat) {
  if (beat.strobe == 0) return;
  std::uint32_t& page = page_[beat.address / kPage];
  if (page == kNone) {
    page = static_cast<std::uint32_t>(bytes_.size() / kPage);
    const std::uint32_t first = beat.address / kPage * kPage;
    for (std::uint32_t n = 0; n < kPage; ++n) bytes_.push_back(memory_garbage(first + n));
  }
  std::uint8_t* bytes = bytes_.data() + std::size_t{page} * kPage + beat.address % kPage;
  for (std::uint64_t left = beat.strobe; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    bytes[n] = beat.data[n];
  }
}

void TileMemory::read(TilePlane plane, int tile_x, int tile_y, int stamp,
                      std::span<std::uint32_t, kMaxSamples> data) const {
  const bool is_color = halfplane::is_of_color(plane);
  const Width& code = is_color ? widths_.stored_color : widths_.stored_depth;
  std::uint32_t address = byte_address(plane, tile_x, tile_y, stamp, layout_, widths_);
  for (int s = 0; s < codes_of_stamp(plane, widths_); ++s) {
    std::uint32_t value = 0;
    for (int n = 0; n < 1 << widths_.memory.sample[is_color ? 1 : 0]; ++n)
      value |= std::uint32_t{byte(address++)} << 8 * n;
    data[static_cast<std::size_t>(s)] = static_cast<std::uint32_t>(wrap_unsigned(value, code.bits));
  }
}

bool TileMemory::is_cleared(bool is_color, int tile_x, int tile_y, int stamp) const {
  return has_flags_[is_color ? 1 : 0] &&
         flag(is_color ? TilePlane::color_flags : TilePlane::depth_flags, tile_x, tile_y, stamp);
}

bool TileMemory::is_of_pixels(int tile_x, int tile_y, int stamp) const {
  return compresses_ && flag(TilePlane::pixel_flags, tile_x, tile_y, stamp);
}

bool TileMemory::flag(TilePlane flags, int tile_x, int tile_y, int stamp) const {
  const BlockAddress block = block_stamp({static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y),
                                          static_cast<std::uint16_t>(stamp)},
                                         widths_)
                                 .block;
  const std::uint32_t row = byte_address(flags, 0, tile_y, block.y % widths_.blocks.per_tile, layout_, widths_);
  return (byte(row + block.x / 8U) >> block.x % 8U & 1) != 0;
}

Framebuffer to_framebuffer(const TileMemory& memory, int width, int height, const Config& config) {
  Framebuffer frame(width, height, config.tile_size);
  std::ranges::fill(frame.depth, snap_depth(1.0, config.depth_bits));
  std::ranges::fill(frame.color, pack_color(config.color_format, {0, 0, 0, 255}));
  const bool has_samples = config.msaa_samples > 1 && config.resolve_units == 0;
  frame.samples.assign(has_samples ? static_cast<std::size_t>(config.msaa_samples) : 0, frame);
  const Widths widths = derive_widths(config);
  const int tile = config.tile_size, size = config.stamp_size;
  const StampGrid& stamps = widths.stamps;
  std::array<std::uint32_t, kMaxSamples> data;
  const auto copy_stamp = [&](bool is_color, int x, int y) {
    const int stamp = stamps.stamp_at(x % tile, y % tile);
    const bool of_pixels = is_color && (config.resolve_units != 0 || memory.is_of_pixels(x / tile, y / tile, stamp));
    const TilePlane plane = !is_color                                 ? TilePlane::depth
                            : of_pixels && config.compress_units != 0 ? TilePlane::pixel_color
                                                                      : TilePlane::color;
    if (memory.is_cleared(is_color, x / tile, y / tile, stamp))
      data.fill(memory.clear_value(is_color));
    else
      memory.read(plane, x / tile, y / tile, stamp, data);
    for (int s = 0; s < stamps.samples(); ++s) {
      const PixelOffset pixel = stamps.pixel_of(s);
      if (x + pixel.x >= width || y + pixel.y >= height) continue;
      Framebuffer& of_sample =
          frame.samples.empty() ? frame : frame.samples[static_cast<std::size_t>(s % stamps.per_pixel)];
      const std::size_t at = frame.at(x + pixel.x, y + pixel.y);
      const std::uint32_t code = data[static_cast<std::size_t>(of_pixels ? s / stamps.per_pixel : s)];
      if (is_color) {
        of_sample.color[at] = code;
      } else {
        of_sample.depth[at] = depth_of(code, widths);
        of_sample.stencil[at] = stencil_of(code, widths);
      }
    }
  };
  for (int y = 0; y < height; y += size)
    for (int x = 0; x < width; x += size) {
      copy_stamp(false, x, y);
      copy_stamp(true, x, y);
    }
  resolve(frame, config.color_format);
  return frame;
}

HardwareModel::HardwareModel(const Config& config, PacketSink& sink)
    : HardwareModel(config, sink, TileMemory(config)) {}

HardwareModel::HardwareModel(const Config& config, PacketSink& sink, TileMemory memory)
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

void HardwareModel::run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line) {
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

void HardwareModel::join(const FragmentPacket& fragment) {
  sink_.take(on<Arrow::fragment>, fragment);
  shade(fragment);
}

/// The caches, the texture memory and the sink, as the fragment path sees them.
struct HardwareModel::StampPort {
  static constexpr bool kSendsPackets = true;
  HardwareModel& model;
  const FragmentPacket& fragment;

  [[nodiscard]] std::span<const std::uint32_t> stored() const {
    return std::visit([this](auto& cache) { return cache.access(fragment, model, model.counters_); }, model.cache_);
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
  }
};

/// depth_test, rop and framebuffer.
void HardwareModel::shade(const FragmentPacket& fragment) {
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
    (void)path_.shade(fragment, counters_, StampPort{*this, fragment});
  }
  if (fragment.ends_visit) {
    const RetirePacket retired = path_.retire(fragment);
    sink_.take(on<Arrow::retire>, retired);
    hiz_.retire(retired);
  }
}

/// Sets a register of a unit downstream of the depth test.
void HardwareModel::set_state(const FragmentPacket& token) {
  const StateRegister which = state_register(token.state);
  path_.set(which, token);
  if (!is_of_texture(which)) std::get<BlockCache>(cache_).set(path_.colors(), path_.stencil());
}

/// Reads a line of texels.
TextureLine HardwareModel::read_texels(std::uint32_t address, int beats) {
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

void HardwareModel::request(const MemoryRequest& request) {
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

const MemoryResponse& HardwareModel::response() {
  response_ = responses_.front();
  responses_.pop_front();
  return response_;
}

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
