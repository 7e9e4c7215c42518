// Runs each stage on its input packets.
#include "stages.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "../engines/hardware.hpp"
#include "../packets/packet_words.hpp"
#include "../packets/state_packets.hpp"
#include "../stages/block_cache.hpp"
#include "../stages/coarse_raster.hpp"
#include "../stages/color_packets.hpp"
#include "../stages/cull.hpp"
#include "../stages/depth_test.hpp"
#include "../stages/fine_raster.hpp"
#include "../stages/interpolate.hpp"
#include "../stages/primitive_join.hpp"
#include "../stages/rop.hpp"
#include "../stages/surface.hpp"
#include "../stages/texture_stage.hpp"
#include "../stages/tile_cache.hpp"
#include "../stages/triangle_setup.hpp"

namespace halfplane::vectors {
namespace {

/// A running stage, with typed packets.
struct Run {
  StageIo& io;
  const Config& config;
  const Widths& widths;

  template <class Packet>
  [[nodiscard]] std::optional<Packet> take(std::size_t port) const {
    const auto words = io.take(port);
    if (words.empty()) return std::nullopt;
    return unpack_words<Packet>(words.data(), widths);
  }
  /// Takes a packet that must come.
  template <class Packet>
  [[nodiscard]] Packet need(std::size_t port, const char* what) const {
    auto packet = take<Packet>(port);
    if (!packet) throw InputError(std::string("the packets that go in end too early: there is no ") + what);
    return *packet;
  }
  template <class Packet>
  void send(std::size_t port, const Packet& packet) const {
    io.send(port, packed(packet, widths));
  }
};

/// Whether a fragment goes through the tests.
[[nodiscard]] bool is_tested(const FragmentPacket& fragment) {
  return (!is_token(fragment.kind) || fragment.kind == PrimitiveKind::line) && fragment.mask.any();
}

void run_cull(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  CounterPacket counters;
  while (const auto primitive = run.take<PrimitivePacket>(0))
    if (const auto triangle = cull(*primitive, widths, counters, config.setup_kind == SetupKind::pipelined))
      run.send(0, *triangle);
}

void run_triangle_setup(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  while (const auto triangle = run.take<TrianglePacket>(0)) {
    if (triangle->kind == PrimitiveKind::triangle && triangle->area == 0)
      throw InputError("a triangle without area goes into triangle_setup, which cull never sends");
    run.send(0, setup_packet(*triangle, config, widths));
  }
}

/// Each visit retires before the next one uses HiZ, which sees the update `lag` visits later.
void run_coarse_raster(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  CounterPacket counters;
  Hiz hiz(config, widths);
  std::uint8_t slot = 0;
  while (const auto setup = run.take<SetupPacket>(0)) {
    if (!is_token(setup->kind) && to_bounds(setup->box).is_empty())
      throw InputError("a box that ends before it begins goes into coarse_raster, which cull never sends");
    run.send(0, make_context(*setup, widths));
    const EdgeContext edges = make_edge_context(*setup);
    coarse_raster(*setup, slot, hiz, widths, counters, [&](const TilePacket& tile) {
      run.send(1, tile);
      run.send(2, edges);
      if (tile.is_visit) hiz.retire(run.need<RetirePacket>(1, "retire packet for a tile visit"));
    });
    slot = static_cast<std::uint8_t>((slot + 1) % config.context_slots);
  }
}

void run_fine_raster(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  while (const auto tile = run.take<TilePacket>(0))
    fine_raster(*tile, run.need<EdgeContext>(1, "edges packet for a tile"), widths,
                [&](const StampPacket& stamp) { run.send(0, stamp); });
}

void run_interpolate(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  std::optional<ContextPacket> context;  // of the current primitive
  while (const auto stamp = run.take<StampPacket>(0)) {
    if (!context) context = run.need<ContextPacket>(1, "context packet for a primitive");
    run.send(0, interpolate(*stamp, *context, widths));
    if (stamp->ends_primitive) context.reset();
  }
}

void run_line_raster(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  while (const auto line = run.take<LineSetup>(0))
    line_raster(*line, widths, [&](const LinePixel& pixel) { run.send(0, pixel); });
}

void run_primitive_join(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  while (const auto fragment = run.take<FragmentPacket>(0)) {
    bool has_more = fragment->kind == PrimitiveKind::line;
    if (!has_more) run.send(0, *fragment);
    while (has_more) {
      const auto pixel = run.need<LinePixel>(1, "line_pixel for the place of a line");
      run.send(0, line_fragment(*fragment, pixel, widths));
      has_more = !pixel.is_last;
    }
  }
}

/// Likewise for the stencil test.
void set_stencil(const FragmentPacket& fragment, StencilState& stencil, const Widths& widths) {
  if (fragment.kind == PrimitiveKind::state) stencil.set(state_register(fragment.state), state_word(fragment, widths));
}

/// Whether the alpha test is downstream of the texture.
[[nodiscard]] bool is_alpha_late(const ColorState& colors, const Config& config) {
  return has_texture_planes(config) && colors.tests_alpha();
}

void require_alpha(const Config& config) {
  if (packs_at_write(config) || config.color_format != ColorFormat::rgb565) return;
  throw InputError(
      "an alpha test downstream of a texture, but no packet of this configuration tells alpha; judge the whole by "
      "cosim, or "
      "use "
      "blend.lanes");
}

/// The samples of `shaded` that pass it, by the next color packet of a port.
[[nodiscard]] SampleMask opaque_samples(const Run& run, std::size_t port, SampleMask shaded, const ColorState& colors) {
  const auto packet = run.need<ColorPacket>(port, "color packet for a write");
  return alpha_passes(colors, shaded, run.widths, [&](std::size_t s) { return packet.color[s] >> 24; });
}

/// The depths under all stamps, with the stencil above them, as written by the fragments themselves.
class DepthPlane {
 public:
  explicit DepthPlane(const Widths& widths)
      : widths_(widths),
        code_(static_cast<std::size_t>(widths.tiles_x) * static_cast<std::size_t>(widths.tiles_y) *
              static_cast<std::size_t>(widths.stamps.stamps() * widths.samples)) {}
  void fill(std::uint32_t code) { std::ranges::fill(code_, code); }
  [[nodiscard]] std::span<std::uint32_t> under(const TileKey& key, int stamp) {
    const auto samples = static_cast<std::size_t>(widths_.samples);
    const std::size_t tile = std::size_t{key.tile_y} * static_cast<std::size_t>(widths_.tiles_x) + key.tile_x;
    const std::size_t at =
        (tile * static_cast<std::size_t>(widths_.stamps.stamps()) + static_cast<std::size_t>(stamp)) * samples;
    if (at + samples > code_.size()) throw InputError("a fragment lies outside of the largest target");
    return std::span(code_).subspan(at, samples);
  }

 private:
  const Widths& widths_;
  std::vector<std::uint32_t> code_;
};

void run_depth_test(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  DepthPlane depths(widths);
  TileVisit visit;
  ColorState colors;
  StencilState stencil;
  while (const auto fragment = run.take<FragmentPacket>(0)) {
    const bool is_clear = fragment->kind == PrimitiveKind::fast_clear;
    if (is_clear && fragment->state.depth_write)
      depths.fill(depth_word(fragment->code[0][kDepthPlane], stencil.clear_value(), widths));
    set_stencil(*fragment, stencil, widths);
    set_colors(*fragment, colors, widths);
    if (is_token(fragment->kind) && fragment->kind != PrimitiveKind::line) continue;
    if (fragment->mask.any()) {
      const auto stored = depths.under(fragment->key, fragment->stamp);
      WritePacket tested = depth_test(*fragment, stored, stencil, widths);
      SampleMask kept = tested.passed;
      const bool may_fail = is_late(fragment->state, colors.tests_alpha(), config);
      if (!has_texture_planes(config)) {
        const SampleMask opaque = halfplane::opaque_samples(*fragment, colors, widths);
        keep(opaque, tested);
        complete_depths(*fragment, tested, widths);
        kept = kept & opaque;
      }
      run.send(0, tested);
      // With a texture unit the alpha test decides later about writes: alpha comes with the colours.
      if (may_fail) require_alpha(config);
      const SampleMask shaded = shaded_samples(tested, colors);
      if (is_alpha_late(colors, config) && shaded.any()) keep(opaque_samples(run, 1, shaded, colors), tested);
      tested.write_depth.for_each([&](std::size_t s) { stored[s] = tested.depth[s]; });
      if (fragment->kind != PrimitiveKind::line) visit.add(*fragment, kept, may_fail ? SampleMask() : kept, widths);
    }
    if (!fragment->ends_visit) continue;
    run.send(1, visit.retire(*fragment, config, widths));
    visit = {};
  }
}

void run_rop(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  while (const auto fragment = run.take<FragmentPacket>(0))
    if (is_tested(*fragment))
      run.send(0, rop(*fragment, run.need<WritePacket>(1, "tested packet for a stamp"), config, widths));
}

/// The memory of a cache, as packets.
class PacketMemory final : public MemoryPort {
 public:
  PacketMemory(const Run& run, std::size_t requests, std::size_t responses)
      : run_(run), requests_(requests), responses_(responses) {}
  void request(const MemoryRequest& request) override { run_.send(requests_, request); }
  const MemoryResponse& response() override {
    response_ = run_.need<MemoryResponse>(responses_, "response to a read");
    return response_;
  }

 private:
  const Run& run_;
  std::size_t requests_, responses_;
  MemoryResponse response_;
};

void run_framebuffer(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  PacketMemory memory(run, 0, 2);
  CounterPacket counters;
  std::variant<TileCache, BlockCache> either(std::in_place_type<TileCache>, config, widths);
  if (config.cache_kind == CacheKind::blocks) either.emplace<BlockCache>(config, widths);
  const bool has_texture = has_texture_planes(config);
  ColorState colors;
  StencilState stencil;
  std::visit(
      [&](auto& cache) {
        constexpr bool has_colors = std::is_same_v<std::remove_cvref_t<decltype(cache)>, BlockCache>;
        while (const auto fragment = run.take<FragmentPacket>(0)) {
          set_colors(*fragment, colors, widths);
          set_stencil(*fragment, stencil, widths);
          if constexpr (has_colors) cache.set(colors, stencil);
          if (fragment->kind == PrimitiveKind::fast_clear)
            cache.fast_clear(*fragment, depth_word(fragment->code[0][kDepthPlane], stencil.clear_value(), widths),
                             stored_color(fragment->code[0], config), memory, counters);
          if (fragment->kind == PrimitiveKind::flush) cache.flush(*fragment, memory, counters);
          if (!is_tested(*fragment)) continue;
          (void)cache.access(*fragment, memory, counters);
          WritePacket write = run.need<WritePacket>(1, "write packet for a stamp");
          if (has_texture) {
            const SampleMask shaded = shaded_samples(write, colors);
            write.color = {};
            if (is_alpha_late(colors, config)) require_alpha(config);
            if (shaded.any()) write.color = run.need<ColorPacket>(3, "color packet for a write").color;
            if (colors.tests_alpha())
              keep(alpha_passes(colors, shaded, widths, [&](std::size_t s) { return write.color[s] >> 24; }), write);
          }
          if constexpr (has_colors)
            if (packs_at_write(config))
              written_colors(colors.ops, {fragment->key.tile_x, fragment->key.tile_y, fragment->stamp},
                             write.write_color, cache.colors(), write.color, config, widths);
          cache.write(*fragment, write);
        }
      },
      either);
}

void run_memory_port(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  PortStage port(widths, default_layout(widths));
  while (const auto request = run.take<MemoryRequest>(0)) {
    const TilePlane plane = request->plane;
    const int sample = widths.memory.sample[is_of_color(plane) ? 1 : 0];
    if (!request->is_write && codes_of_stamp(plane, widths) << sample > 1 << item_shift(plane, widths.memory))
      throw InputError(
          "a read of flags, whose word is shorter than a stamp of this configuration: write flags, or read a plane");
    port.take(*request, [&](const MemoryBeat& beat) {
      run.send(0, beat);
      const int answers = beat.is_write ? (beat.length == 1 ? 1 : 0) : beat.length;
      for (int n = 0; n < answers; ++n) {
        const auto answer = run.need<MemoryAnswer>(1, "answer to a burst");
        if (!beat.is_write) port.answer(answer, [&](const MemoryResponse& response) { run.send(1, response); });
      }
    });
  }
}

void run_memory(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  TileMemory memory(config);
  while (const auto beat = run.take<MemoryBeat>(0)) {
    MemoryBeat last = *beat;
    last.address += static_cast<std::uint32_t>(std::max(1, int{beat->length}) - 1) << widths.memory.port;
    if (!memory.has(*beat) || !memory.has(last)) throw InputError("a burst lies outside of the target's memory");
    if (beat->is_write) {
      memory.write(*beat);
      if (beat->length == 1) run.send(0, MemoryAnswer{true, {}});
      continue;
    }
    MemoryAnswer answer;
    for (std::uint32_t n = 0; n < beat->length; ++n) {
      memory.read(beat->address + (n << widths.memory.port), answer.data);
      run.send(0, answer);
    }
  }
}

void run_texture_unit(StageIo& io, const Config& config, const Widths& widths) {
  const Run run{io, config, widths};
  FragmentUnits units(config, widths);
  ColorState colors;
  const auto read = [&](std::uint32_t address, int beats) {
    run.send(0, TextureRequest{address, static_cast<std::uint16_t>(beats)});
    TextureLine line{};
    const auto bytes = static_cast<std::size_t>(widths.texture_port_bytes);
    for (std::size_t n = 0; n < static_cast<std::size_t>(beats); ++n)
      std::copy_n(run.need<TexelBeat>(2, "texel beat of a line").data.begin(), bytes,
                  line.begin() + static_cast<std::ptrdiff_t>(n * bytes));
    return line;
  };
  while (const auto fragment = run.take<FragmentPacket>(0)) {
    set_colors(*fragment, colors, widths);
    if (fragment->kind == PrimitiveKind::state && is_of_texture(state_register(fragment->state)))
      units.set(state_register(fragment->state), *fragment, widths);
    if (!is_tested(*fragment)) continue;
    const auto write = run.need<WritePacket>(1, "write packet for a stamp");
    const TexturedStamp shaded = texture_stamp(units, *fragment, write, colors, config, widths, read);
    if (shaded.packet.mask.any()) run.send(1, shaded.packet);
  }
}

}  // namespace

void run_stage(const JudgedStage& stage, StageIo& io, const Config& config, const Widths& widths) {
  switch (stage.stage) {
    case Stage::cull: return run_cull(io, config, widths);
    case Stage::triangle_setup: return run_triangle_setup(io, config, widths);
    case Stage::coarse_raster: return run_coarse_raster(io, config, widths);
    case Stage::fine_raster: return run_fine_raster(io, config, widths);
    case Stage::interpolate: return run_interpolate(io, config, widths);
    case Stage::line_raster: return run_line_raster(io, config, widths);
    case Stage::primitive_join: return run_primitive_join(io, config, widths);
    case Stage::depth_test: return run_depth_test(io, config, widths);
    case Stage::rop: return run_rop(io, config, widths);
    case Stage::framebuffer: return run_framebuffer(io, config, widths);
    case Stage::memory_port: return run_memory_port(io, config, widths);
    case Stage::memory: return run_memory(io, config, widths);
    case Stage::texture_unit: return run_texture_unit(io, config, widths);
    default: break;  // can_run() is false
  }
}

}  // namespace halfplane::vectors
