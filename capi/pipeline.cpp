// The whole pipeline of the C interface: the hardware engine with its memory, and the host of a scene.
#include <algorithm>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <span>

#include "handles.hpp"
#include "model/engines/hardware.hpp"
#include "model/generate/raster_pkg.hpp"
#include "model/host/stream_rules.hpp"
#include "model/packets/packet_words.hpp"
#include "model/stages/depth_test.hpp"
#include "model/stages/memory_port.hpp"
#include "model/vectors/stages.hpp"

using namespace halfplane;
using namespace halfplane::capi;

static_assert(sizeof(halfplane_event) == 9 * sizeof(std::uint32_t), "the words that DPI-C passes");

namespace {

const Config& validated(const Config& config) {
  validate(config);
  require_sampled_hardware(config, "the RTL");
  return config;
}

}  // namespace

struct halfplane_pipeline final : PacketSink {
 public:
  halfplane_pipeline(const Config& config, int outputs)
      : config_(validated(config)), widths_(derive_widths(config_)), outputs_(outputs), rules_(config_, widths_) {
    set_layout(default_layout(widths_));
  }
  halfplane_pipeline(const halfplane_pipeline&) = delete;  // the model refers to its sink
  halfplane_pipeline& operator=(const halfplane_pipeline&) = delete;

  [[nodiscard]] const TileMemory& memory() const { return model_->memory(); }
  [[nodiscard]] const TextureMemory& texels() const { return texels_; }

  void set_layout(const MemoryLayout& layout) {
    if (rules_.taken() != 0) throw InputError("the layout is set before the first primitive");
    if (layout_end(layout, widths_) > std::uint64_t{1} << widths_.address.bits)
      throw InputError("the layout ends beyond the last address");
    model_.emplace(config_, *this, TileMemory(config_, layout));
    model_->hold_textures(texels_);
    if ((outputs_ & HALFPLANE_WRITES) != 0) model_->tap_writes([this](const WritePacket& packet) { written(packet); });
  }
  void hold_textures(const Scene& scene) {
    texels_ = TextureMemory(scene, config_);
    model_->hold_textures(texels_);
  }

  void put_primitive(const std::uint32_t* words) {
    const auto packet = unpack_words<PrimitivePacket>(words, widths_);
    if (const std::string fault = rules_.take(packet); !fault.empty()) throw InputError(fault);
    waiting_.push_back(packet);
    run();
  }
  void put_line(const std::uint32_t* words) {
    const auto line = unpack_words<LineSetup>(words, widths_);
    if (const std::string fault = rules_.fault(line); !fault.empty()) throw InputError(fault);
    lines_.push_back(line);
    run();
  }
  [[nodiscard]] bool get(halfplane_event& event) {
    if (events_.empty()) return false;
    event = events_.front();
    events_.pop_front();
    return true;
  }
  [[nodiscard]] bool get_beat(std::uint32_t* words) {
    if (beats_.empty()) return false;
    pack_words(beats_.front(), widths_, words);
    beats_.pop_front();
    return true;
  }
  [[nodiscard]] Framebuffer picture() const {
    if (!rules_.target()) throw InputError("nothing was cleared, so there is no picture");
    if (!waiting_.empty()) throw InputError("a line's place waits for its line: the picture is not complete");
    if (rules_.unwritten() != 0)
      throw InputError(std::to_string(rules_.unwritten()) +
                       " primitives after the last flush are on the chip alone; put a flush");
    return to_framebuffer(memory(), rules_.target()->right + 1, rules_.target()->bottom + 1, config_);
  }

 private:
  using PacketSink::take;
  void take(On<Arrow::beat>, const MemoryBeat& beat) override {
    if ((outputs_ & HALFPLANE_BEATS) != 0) beats_.push_back(beat);
  }

  /// As far as the lines that have come allow.
  void run() {
    while (!waiting_.empty()) {
      std::optional<LineSetup> line;
      if (waiting_.front().kind == PrimitiveKind::line) {
        if (lines_.empty()) return;
        line = lines_.front();
        lines_.pop_front();
      }
      model_->run(waiting_.front(), line);
      waiting_.pop_front();
      if ((outputs_ & HALFPLANE_RETIRED) != 0) events_.push_back(event(HALFPLANE_RETIRED));
      ++retired_;
    }
  }

  [[nodiscard]] halfplane_event event(std::uint32_t kind) const {
    halfplane_event made{};
    made.kind = kind;
    made.primitive = retired_;
    return made;
  }

  void written(const WritePacket& packet) {
    const StampGrid& stamps = widths_.stamps;
    const PixelOffset origin = stamps.origin_of(packet.stamp);
    (packet.write_depth | packet.write_color).for_each([&](std::size_t s) {
      const PixelOffset pixel = stamps.pixel_of(static_cast<int>(s));
      halfplane_event write = event(HALFPLANE_WRITES);
      write.x = static_cast<std::uint32_t>(packet.key.tile_x * config_.tile_size + origin.x + pixel.x);
      write.y = static_cast<std::uint32_t>(packet.key.tile_y * config_.tile_size + origin.y + pixel.y);
      write.sample = static_cast<std::uint32_t>(static_cast<int>(s) % stamps.per_pixel);
      if (packet.write_depth.has(s)) {
        write.parts |= HALFPLANE_DEPTH;
        write.depth = depth_of(packet.depth[s], widths_);
        write.stencil = stencil_of(packet.depth[s], widths_);
      }
      if (packet.write_color.has(s)) {
        write.parts |= HALFPLANE_COLOR;
        write.color = packet.color[s];
      }
      events_.push_back(write);
    });
  }

  Config config_;
  Widths widths_;
  int outputs_;
  StreamRules rules_;
  TextureMemory texels_;
  std::optional<HardwareModel> model_;
  std::deque<PrimitivePacket> waiting_;  ///< the first is the place of a line that has not come
  std::deque<LineSetup> lines_;          ///< whose places have not come
  std::deque<halfplane_event> events_;
  std::deque<MemoryBeat> beats_;
  std::uint32_t retired_ = 0;  ///< primitives that are through
};

struct halfplane_host {
  halfplane_host(const Scene& of, const Config& config)
      : scene(of), widths(derive_widths(validated(config))), stream(scene, config) {}
  Scene scene;
  Widths widths;
  HostStream stream;
};

namespace {

constexpr const char* kPipeline = "the pipeline";

Arrow arrow_of(std::string_view name) {
  for (std::size_t i = 0; i < kArrows; ++i)
    if (kArrowInfo[i].name == name) return static_cast<Arrow>(i);
  throw InputError("there is no arrow '" + std::string(name) + "' in the pipeline");
}

void require_bytes(std::uint64_t end, std::uint32_t address, std::size_t count) {
  if (address > end || count > end - address)
    throw InputError("memory ends at address " + std::to_string(end) + ", and " + std::to_string(count) +
                     " bytes from " + std::to_string(address) + " on were asked for");
}

}  // namespace

extern "C" {

halfplane_pipeline* halfplane_pipeline_new(const halfplane_config* config, uint64_t id, int outputs) {
  return guarded(nullptr, [&] {
    constexpr int kAll = HALFPLANE_WRITES | HALFPLANE_RETIRED | HALFPLANE_BEATS;
    const Config& known = required(config, "the configuration").config;
    if ((outputs & ~kAll) != 0) throw InputError("outputs are a sum of HALFPLANE_WRITES, _RETIRED and _BEATS");
    auto made = std::make_unique<halfplane_pipeline>(known, outputs);
    if (id != config_id(known))
      throw InputError("the design's CONFIG_ID is of another configuration than the pipeline's");
    return made.release();
  });
}
int halfplane_pipeline_put_primitive(halfplane_pipeline* pipeline, const uint32_t* words) {
  return guarded(-1, [&] {
    required(pipeline, kPipeline).put_primitive(&required(words, "the packet"));
    return 0;
  });
}
int halfplane_pipeline_put_line(halfplane_pipeline* pipeline, const uint32_t* words) {
  return guarded(-1, [&] {
    required(pipeline, kPipeline).put_line(&required(words, "the packet"));
    return 0;
  });
}
int halfplane_pipeline_get_event(halfplane_pipeline* pipeline, halfplane_event* event) {
  return guarded(-1,
                 [&] { return required(pipeline, kPipeline).get(required(event, "the room for an event")) ? 1 : 0; });
}
int halfplane_pipeline_get_beat(halfplane_pipeline* pipeline, uint32_t* words) {
  return guarded(
      -1, [&] { return required(pipeline, kPipeline).get_beat(&required(words, "the room for a packet")) ? 1 : 0; });
}
int halfplane_pipeline_layout(const halfplane_pipeline* pipeline, uint32_t* bytes) {
  return guarded(-1, [&] {
    const MemoryLayout& layout = required(pipeline, kPipeline).memory().layout();
    const std::array all{layout.depth_base, layout.color_base, layout.depth_flags_base, layout.color_flags_base,
                         layout.row_stride};
    std::ranges::copy(all, &required(bytes, "the room for the layout"));
    return 0;
  });
}
int halfplane_pipeline_set_layout(halfplane_pipeline* pipeline, const uint32_t* bytes) {
  return guarded(-1, [&] {
    const std::span<const std::uint32_t, 5> given(&required(bytes, "the layout"), 5);
    required(pipeline, kPipeline).set_layout({given[0], given[1], given[2], given[3], given[4]});
    return 0;
  });
}
int64_t halfplane_pipeline_memory_size(const halfplane_pipeline* pipeline) {
  return guarded(std::int64_t{-1},
                 [&] { return static_cast<std::int64_t>(required(pipeline, kPipeline).memory().end()); });
}
int halfplane_pipeline_memory(const halfplane_pipeline* pipeline, uint32_t address, void* bytes, size_t count) {
  return guarded(-1, [&] {
    const TileMemory& memory = required(pipeline, kPipeline).memory();
    require_bytes(memory.end(), address, count);
    memory.read(address, {&required(static_cast<std::uint8_t*>(bytes), "the room"), count});
    return 0;
  });
}
int64_t halfplane_pipeline_plane(const halfplane_pipeline* pipeline, const char* plane, uint32_t* values,
                                 size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    return copy_plane(required(pipeline, kPipeline).picture(), text(plane, "the plane"),
                      &required(values, "the room for the values"), count);
  });
}
int halfplane_pipeline_textures(halfplane_pipeline* pipeline, const halfplane_scene* scene) {
  return guarded(-1, [&] {
    required(pipeline, kPipeline).hold_textures(required(scene, "the scene").scene);
    return 0;
  });
}
int halfplane_pipeline_texels(const halfplane_pipeline* pipeline, uint32_t address, void* bytes, size_t count) {
  return guarded(-1, [&] {
    required(pipeline, kPipeline)
        .texels()
        .read(address, {&required(static_cast<std::uint8_t*>(bytes), "the room"), count});
    return 0;
  });
}
void halfplane_pipeline_free(halfplane_pipeline* pipeline) { delete pipeline; }

halfplane_host* halfplane_host_new(const halfplane_scene* scene, const halfplane_config* config) {
  return guarded(nullptr, [&] {
    return new halfplane_host(required(scene, "the scene").scene, required(config, "the configuration").config);
  });
}
int halfplane_host_next(halfplane_host* host, uint32_t* primitive, uint32_t* line) {
  return guarded(-1, [&] {
    halfplane_host& made = required(host, "the host");
    const auto next = made.stream.next();
    if (!next) return 0;
    pack_words(next->packet, made.widths, &required(primitive, "the room for a primitive"));
    if (!next->line) return 1;
    pack_words(*next->line, made.widths, &required(line, "the room for a line"));
    return 2;
  });
}
void halfplane_host_free(halfplane_host* host) { delete host; }

int halfplane_packet_bits(const halfplane_config* config, const char* arrow) {
  return guarded(-1, [&] {
    return vectors::bits_of(arrow_of(text(arrow, "the arrow")),
                            derive_widths(validated(required(config, "the configuration").config)));
  });
}

}  // extern "C"
