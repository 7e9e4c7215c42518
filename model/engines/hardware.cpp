#include "hardware.hpp"

#include <algorithm>
#include <chrono>

#include "../stages/coarse_raster.hpp"
#include "../stages/cull.hpp"
#include "../stages/depth_test.hpp"
#include "../stages/fine_raster.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/primitive_join.hpp"
#include "../stages/rop.hpp"
#include "../stages/triangle_setup.hpp"

namespace halfplane {

std::uint32_t memory_garbage(bool is_color, int tile_x, int tile_y, int stamp, int sample, const Widths& widths) {
  // Spread over all bits by an odd factor, so that a wrong tile, stamp or sample shows in narrow codes too.
  std::uint32_t value = 0xDEADBEEFU ^ (is_color ? 0x5A5A5A5AU : 0U);
  for (const int part : {tile_x, tile_y, stamp, sample})
    value = (value ^ static_cast<std::uint32_t>(part)) * 0x9E3779B1U ^ value >> 15;
  const Width& code = is_color ? widths.stored_color : widths.depth().code;
  return static_cast<std::uint32_t>(wrap_unsigned(value, code.bits));
}

TileMemory::TileMemory(const Config& config) : widths_(derive_widths(config)) {
  const auto tiles = static_cast<std::size_t>(widths_.tiles_x) * static_cast<std::size_t>(widths_.tiles_y);
  block_.resize(2 * tiles, kNone);
  if (config.cache_kind == CacheKind::blocks)
    for (auto& plane : flags_)
      plane.resize(tiles * static_cast<std::size_t>(widths_.blocks.per_tile * widths_.blocks.per_tile));
}

bool TileMemory::has(const MemoryRequest& request) const {
  if (request.tile_y >= tiles_y()) return false;
  if (request.plane == TilePlane::depth || request.plane == TilePlane::color)
    return request.tile_x < tiles_x() && request.stamp < stamps();
  return request.tile_x * widths_.blocks.flag_word < tiles_x() * widths_.blocks.per_tile &&
         request.stamp < widths_.blocks.per_tile && !flags_[0].empty();
}

bool TileMemory::is_cleared(bool is_color, int tile_x, int tile_y, int stamp) const {
  const std::vector<std::uint8_t>& flags = flags_[is_color ? 1 : 0];
  if (flags.empty()) return false;
  const BlockAddress block = block_stamp({static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y),
                                          static_cast<std::uint16_t>(stamp)},
                                         widths_)
                                 .block;
  return flags[static_cast<std::size_t>(block.y * tiles_x() * widths_.blocks.per_tile + block.x)] != 0;
}

void TileMemory::read(bool is_color, int tile_x, int tile_y, int stamp,
                      std::span<std::uint32_t, kMaxSamples> data) const {
  const std::uint32_t block = block_[index(is_color, tile_x, tile_y)];
  if (block == kNone) {
    for (int s = 0; s < samples(); ++s)
      data[static_cast<std::size_t>(s)] = memory_garbage(is_color, tile_x, tile_y, stamp, s, widths_);
    return;
  }
  std::copy_n(lanes_.begin() + first_lane(block, stamp), samples(), data.begin());
}

void TileMemory::write(const MemoryRequest& request) {
  if (request.plane == TilePlane::depth_flags || request.plane == TilePlane::color_flags) {
    const int row = tiles_x() * widths_.blocks.per_tile, first = request.tile_x * widths_.blocks.flag_word;
    const int y = request.tile_y * widths_.blocks.per_tile + request.stamp;
    const std::uint64_t bits = flag_word(request, widths_);
    auto& flags = flags_[request.plane == TilePlane::color_flags ? 1 : 0];
    for (int x = first; x < std::min(row, first + widths_.blocks.flag_word); ++x)
      flags[static_cast<std::size_t>(y * row + x)] = static_cast<std::uint8_t>(bits >> (x - first) & 1);
    return;
  }
  const bool is_color = request.plane == TilePlane::color;
  const int tile_x = request.tile_x, tile_y = request.tile_y;
  std::uint32_t& block = block_[index(is_color, tile_x, tile_y)];
  if (block == kNone) {
    block = blocks_++;
    for (int other = 0; other < stamps(); ++other)
      for (int s = 0; s < samples(); ++s) lanes_.push_back(memory_garbage(is_color, tile_x, tile_y, other, s, widths_));
  }
  const std::ptrdiff_t first = first_lane(block, request.stamp);
  request.strobe.for_each([&](std::size_t s) { lanes_[static_cast<std::size_t>(first) + s] = request.data[s]; });
}

Framebuffer to_framebuffer(const TileMemory& memory, int width, int height, const Config& config) {
  Framebuffer frame(width, height, config.tile_size);
  std::ranges::fill(frame.depth, snap_depth(1.0, config.depth_bits));
  std::ranges::fill(frame.color, pack_color(config.color_format, {0, 0, 0, 255}));
  const int tile = config.tile_size, size = config.stamp_size;
  const StampGrid stamps{size, tile / size};
  std::array<std::uint32_t, kMaxSamples> data;
  const auto copy_stamp = [&](bool is_color, int x, int y) {
    Framebuffer::Image& image = is_color ? frame.color : frame.depth;
    const int stamp = stamps.stamp_at(x % tile, y % tile);
    if (memory.is_cleared(is_color, x / tile, y / tile, stamp))
      data.fill(memory.clear_value(is_color));
    else
      memory.read(is_color, x / tile, y / tile, stamp, data);
    for (int s = 0; s < stamps.samples(); ++s) {
      const PixelOffset pixel = stamps.pixel_of(s);
      if (x + pixel.x < width && y + pixel.y < height)
        image[frame.at(x + pixel.x, y + pixel.y)] = data[static_cast<std::size_t>(s)];
    }
  };
  for (int y = 0; y < height; y += size)
    for (int x = 0; x < width; x += size) {
      copy_stamp(false, x, y);
      copy_stamp(true, x, y);
    }
  return frame;
}

HardwareModel::HardwareModel(const Config& config, PacketSink& sink)
    : config_(config),
      widths_(derive_widths(config)),
      sink_(sink),
      hiz_(config, widths_),
      cache_(std::in_place_type<TileCache>, config, widths_),
      memory_(config) {
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
  coarse_raster(setup, slot_, hiz_, widths_, counters_, [&](const TilePacket& tile) {
    sink_.take(on<Arrow::tile>, tile);
    sink_.take(on<Arrow::edges>, edges);
    fine_raster(tile, edges, widths_, [&](const StampPacket& stamp) {
      sink_.take(on<Arrow::stamp>, stamp);
      const FragmentPacket fragment = interpolate(stamp, context, widths_);
      if (line) {
        line_raster(*line, widths_, [&](const LinePixel& pixel) {
          sink_.take(on<Arrow::line_pixel>, pixel);
          join(line_fragment(fragment, pixel, widths_));
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

/// depth_test, rop and framebuffer.
void HardwareModel::shade(const FragmentPacket& fragment) {
  switch (fragment.kind) {
    case PrimitiveKind::fast_clear: {
      const std::uint32_t color = stored_color(fragment.code[0], config_);
      std::visit([&](auto& cache) { cache.fast_clear(fragment, color, *this, counters_); }, cache_);
      if (fragment.state.depth_write) memory_.set_clear_value(TilePlane::depth, fragment.code[0][kDepthPlane]);
      if (fragment.state.color_write) memory_.set_clear_value(TilePlane::color, color);
      return;
    }
    case PrimitiveKind::flush:
      std::visit([&](auto& cache) { cache.flush(fragment, *this, counters_); }, cache_);
      return;
    case PrimitiveKind::triangle:
    case PrimitiveKind::rectangle:
    case PrimitiveKind::point:
    case PrimitiveKind::line: break;
  }
  if (fragment.mask.any()) {
    const auto stored = std::visit([&](auto& cache) { return cache.access(fragment, *this, counters_); }, cache_);
    const WritePacket packet = rop(fragment, depth_test(fragment, stored, widths_), config_, widths_);
    sink_.take(on<Arrow::write>, packet);
    std::visit([&](auto& cache) { cache.write(fragment, packet); }, cache_);
    if (fragment.kind != PrimitiveKind::line) visit_.add(fragment, packet.passed, widths_);
    if (is_counted(fragment.kind)) {
      const auto passed = static_cast<std::uint32_t>(packet.passed.count());
      counters_.covered += static_cast<std::uint32_t>(fragment.mask.count());
      counters_.depth_passed += passed;
      if (fragment.state.writes()) counters_.written += passed;
    }
  }
  if (fragment.ends_visit) {
    const RetirePacket retired = visit_.retire(fragment, config_, widths_);
    sink_.take(on<Arrow::retire>, retired);
    hiz_.retire(retired);
    visit_ = {};
  }
}

void HardwareModel::write(const MemoryRequest& request) {
  sink_.take(on<Arrow::request>, request);
  memory_.write(request);
}

const MemoryResponse& HardwareModel::read(const MemoryRequest& request) {
  sink_.take(on<Arrow::request>, request);
  memory_.read(request.plane == TilePlane::color, request.tile_x, request.tile_y, request.stamp, response_.data);
  sink_.take(on<Arrow::response>, response_);
  return response_;
}

void count_hardware(const CounterPacket& hardware, std::uint64_t drawn, Counters& counters) {
  // One input triangle may have sent several pieces: those without a pixel are counted by triangle, not by piece.
  const std::uint64_t culled_before_box = counters.culled + hardware.zero_area + hardware.backface;
  counters.drawn += drawn;  // the host knows about lines and points
  counters.culled = counters.primitives_in - counters.drawn;
  counters.skipped.empty += counters.culled - culled_before_box;
  counters.skipped.zero_area += hardware.zero_area;
  counters.skipped.backface += hardware.backface;
  counters.skipped.no_sample = hardware.no_sample;
  counters.skipped.tiles_outside = hardware.tiles_outside;
  counters.skipped.trivially_accepted = hardware.trivially_accepted;
  counters.skipped.tiles_hiz = hardware.tiles_hiz;
  counters.skipped.fragments_early_z = hardware.covered - hardware.depth_passed;
  counters.tiles_visited = hardware.tiles_visited;
  counters.samples_tested = hardware.samples_tested;
  counters.covered = hardware.covered;
  counters.depth_passed = hardware.depth_passed;
  counters.written = hardware.written;
}

Rendering render_hardware(const Scene& scene, const Config& config, const RenderOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  PacketSink nobody;
  HostStream host(scene, config);
  HardwareModel hardware(config, nobody);
  DrawnCount drawn;
  std::uint32_t sent = 0;
  while (const auto primitive = host.next()) {
    const std::uint32_t dropped_before = drawn.dropped(hardware.counters());
    hardware.run(primitive->packet, primitive->line);
    drawn.add(*primitive, drawn.dropped(hardware.counters()) == dropped_before);
    if (options.progress && ++sent % 4096 == 0) options.progress(host.progress());
  }
  Rendering rendering;
  rendering.frame = to_framebuffer(hardware.memory(), scene.width, scene.height, config);
  rendering.counters = host.counters();
  count_hardware(hardware.counters(), drawn.count(), rendering.counters);
  rendering.raster_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return rendering;
}

}  // namespace halfplane
