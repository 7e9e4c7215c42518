#include "primitive_stream.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "../packets/state_packets.hpp"
#include "../stages/color_packets.hpp"
#include "../stages/fragment_ops.hpp"
#include "../stages/stencil_packets.hpp"
#include "../stages/surface.hpp"
#include "line_setup.hpp"
#include "primitives.hpp"

namespace halfplane {
namespace {

/// A primitive without vertices: constant depth and colour over its whole box.
PrimitivePacket flat_packet(PrimitiveKind kind, const Rect& rect) {
  PrimitivePacket packet;
  packet.kind = kind;
  packet.state.depth_test = DepthFunc::always;
  packet.box = to_box({rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1});
  return packet;
}

void clear_depth(PrimitivePacket& packet, double z, const Config& config) {
  packet.state.depth_write = true;
  for (auto& code : packet.vertex.code) code[kDepthPlane] = snap_depth(z, config.depth_bits);
}

void clear_color(PrimitivePacket& packet, const std::array<double, 4>& color, const Config& config) {
  packet.state.color_write = true;
  for (auto& code : packet.vertex.code) copy_color(code, snap_codes(0, {.rgba = color}, config), config);
}

/// The command if it is a clear of the whole target.
const Clear* whole_clear(const Scene& scene, const Command& command) {
  const auto* clear = std::get_if<Clear>(&command);
  return clear != nullptr && clear_rect(scene, *clear) == Rect{0, 0, scene.width, scene.height} ? clear : nullptr;
}

const Config& checked(const Scene& scene, const Config& config) {
  validate(config);
  check_hardware_scene(scene, config);
  return config;
}

}  // namespace

bool begins_once(const Scene& scene) {
  bool is_first = true;
  for (const Command& command : scene.commands) {
    const Clear* clear = whole_clear(scene, command);
    if (!is_first && clear != nullptr && (clear->depth || clear->stencil)) return false;
    is_first = is_first && clear != nullptr;
  }
  return true;
}

std::string stream_fault(const HostPrimitive& primitive, bool is_first) {
  const PrimitivePacket& packet = primitive.packet;
  if (is_first && packet.kind == PrimitiveKind::state) return "";
  if (is_first && (packet.kind != PrimitiveKind::fast_clear || !packet.state.depth_write || !packet.state.color_write))
    return "the stream does not begin with a fast clear of depth and colour: the flags of tiles are undefined";
  if (packet.kind == PrimitiveKind::fast_clear && packet.state.clears_bin() && packet.state.depth_write)
    return "a fast clear of one bin clears depth, too: that is of the whole target";
  if (packet.kind == PrimitiveKind::line && !primitive.line)
    return "the place of a line comes without its setup: primitive_join would wait for its pixels for good";
  return "";
}

/// The host's side, from commands to primitives.
class HostStream::Host {
 public:
  Host(const Scene& scene, const Config& config, BinContents* held);
  Host(const Host&) = delete;  // context_ points into config_
  Host& operator=(const Host&) = delete;
  [[nodiscard]] const HostPrimitive* pull();
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] double progress() const;

 private:
  void advance();
  void start_draw(const Draw& draw);
  void send_next_primitive();
  void send_outline(const AssembledPrimitive& assembled);
  void send_clear(const Clear& command);
  [[nodiscard]] const HostPrimitive* next_plain();
  [[nodiscard]] HostPrimitive triangle_primitive(const Triangle& triangle, bool is_culled);
  void send_triangle(const Triangle& triangle, bool is_culled);
  [[nodiscard]] HostPrimitive state_token(StateRegister which, uint128 word, const HostPrimitive& in_front_of) const;
  [[nodiscard]] const HostPrimitive* next_primitive();
  void send_line(const LinePrimitive& line);
  [[nodiscard]] PrimitivePacket draw_packet(PrimitiveKind kind, const PixelBounds& box) const;
  [[nodiscard]] PrimitivePacket fast_clear() const;
  void fill_word(Clear& clear) const;
  [[nodiscard]] bool begins_bins(const Command& command) const;
  void close_bins();
  void send_clears();
  void note_words(const PrimitiveState& state);
  void set_number(HostPrimitive& out, std::uint32_t primitive) const {
    out.primitive = primitive;
    out.packet.primitive_id = static_cast<std::uint32_t>(wrap_unsigned(primitive, widths_.primitive_id.bits));
  }
  [[nodiscard]] HostPrimitive host_primitive(const PrimitivePacket& packet, std::uint32_t primitive) const;
  [[nodiscard]] HostPrimitive drawn_primitive(PrimitiveKind kind, const PixelBounds& box,
                                              std::uint32_t primitive) const;
  void send(const HostPrimitive& primitive);

  const Scene& scene_;
  Config config_;
  Widths widths_;
  VertexCache vertices_;
  Counters counters_;
  std::size_t command_ = 0;                    ///< the next of Scene::commands
  bool is_finished_ = false;                   ///< the flush has been queued
  std::uint32_t primitive_ = 0;                ///< number of the next input primitive
  std::optional<DrawContext> context_;         ///< of the current draw
  std::vector<AssembledPrimitive> assembled_;  ///< of the current draw
  std::size_t assembled_next_ = 0;             ///< the next of them
  std::vector<Triangle> pieces_;               ///< scratch
  Outline outline_;                            ///< scratch
  std::optional<FrameBins> bins_;              ///< with frame.order bins: primitives that wait for the end of the frame
  BinContents* held_ = nullptr;                ///< if bins are compared; then the initial clears wait
  std::vector<HostPrimitive> clears_;
  std::optional<HostPrimitive> part_;   ///< the last one of the bins
  std::vector<HostPrimitive> pending_;  ///< made but not yet pulled
  std::size_t pending_first_ = 0;
  HostUnits units_;
  std::optional<double> depth_everywhere_ = 1.0;                      ///< value of every pixel, if the host knows it
  std::optional<std::uint8_t> stencil_everywhere_ = std::uint8_t{0};  ///< likewise
  std::optional<HostPrimitive> plain_;      ///< the draw's triangles without surface, offset, bins or cuts
  bool sets_plain_ = false;                 ///< the registers for the draw's plain triangles have been set
  const HostPrimitive* waiting_ = nullptr;  ///< the primitive that waits for its tokens
  std::vector<HostPrimitive> tokens_;       ///< which are sent before it
  std::size_t tokens_first_ = 0;            ///< the next of them
};

HostStream::Host::Host(const Scene& scene, const Config& config, BinContents* held)
    : scene_(scene),
      config_(checked(scene, config)),
      widths_(derive_widths(config)),
      vertices_(scene.vertices.size()),
      units_(scene, config_, widths_) {
  if (config.frame_order == FrameOrder::bins) {
    const bool compares =
        held != nullptr && compares_bins(config) && FrameBins::has_whole_tiles(widths_) && begins_once(scene);
    if (compares) held_ = held;
    bins_.emplace(widths_, scene.width, scene.height, compares ? std::optional(config.frame_clears) : std::nullopt);
    counters_.bins = 0;
  }
  if (held != nullptr && held_ == nullptr) held->forget();
  const Clear* clear = scene.commands.empty() ? nullptr : whole_clear(scene, scene.commands.front());
  if (clear != nullptr && clear->depth && clear->color) return;
  PrimitivePacket first = fast_clear();
  clear_depth(first, 1.0, config);
  clear_color(first, {0, 0, 0, 255}, config);
  HostPrimitive out = host_primitive(first, 0);
  if (has_stencil(config)) out.units.stencil.test[0] = pack_test(replacing_stencil(0));
  out.command = HostPrimitive::kNoCommand;
  send(out);
}

const HostPrimitive* HostStream::Host::pull() {
  if (waiting_ == nullptr) {
    waiting_ = next_primitive();
    if (waiting_ == nullptr) return nullptr;
    const bool is_plain = plain_ && waiting_ == &*plain_;
    if (is_plain && std::exchange(sets_plain_, true)) return std::exchange(waiting_, nullptr);
    tokens_.clear();
    tokens_first_ = 0;
    units_.set_for(waiting_->packet.kind, waiting_->units,
                   [&](StateRegister which, uint128 word) { tokens_.push_back(state_token(which, word, *waiting_)); });
  }
  if (tokens_first_ < tokens_.size()) return &tokens_[tokens_first_++];
  return std::exchange(waiting_, nullptr);
}

/// A token that sets a register of a unit from here on.
HostPrimitive HostStream::Host::state_token(StateRegister which, uint128 word, const HostPrimitive& in_front_of) const {
  PrimitivePacket packet;
  packet.kind = PrimitiveKind::state;
  packet.state = sets_register(which);
  for (auto& code : packet.vertex.code) set_state_word(code, word, widths_);
  HostPrimitive out = host_primitive(packet, in_front_of.primitive);
  out.command = in_front_of.command;
  return out;
}

/// The next primitive without the tokens in front of it, until the next call; null: there is no other.
const HostPrimitive* HostStream::Host::next_primitive() {
  while (pending_first_ == pending_.size()) {
    if (bins_ && (part_ = bins_->next())) return &*part_;
    if (is_finished_) return nullptr;
    if (const HostPrimitive* const plain = next_plain()) return plain;
    pending_.clear();
    pending_first_ = 0;
    advance();
  }
  return &pending_[pending_first_++];
}

/// The next triangle of the draw, if it is plain: it needs no work of the host but its vertices'.
const HostPrimitive* HostStream::Host::next_plain() {
  if (!plain_ || assembled_next_ == assembled_.size()) return nullptr;
  std::array<const VertexCache::Entry*, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = &vertices_.get(*context_, assembled_[assembled_next_].index[i]);
  if ((v[0]->outside_frustum & v[1]->outside_frustum & v[2]->outside_frustum) != 0) return nullptr;
  if ((v[0]->outside_guard_band | v[1]->outside_guard_band | v[2]->outside_guard_band) != 0) return nullptr;
  TriangleVertices& vertex = plain_->packet.vertex;
  for (std::size_t i = 0; i < 3; ++i) {
    vertex.x[i] = v[i]->snapped.x;
    vertex.y[i] = v[i]->snapped.y;
    vertex.code[i] = v[i]->snapped.code;
    if (context_->state.shade == Shade::flat) copy_color(vertex.code[i], v[0]->snapped.code, config_);
  }
  set_number(*plain_, primitive_++);
  ++assembled_next_;
  ++counters_.primitives_in;
  ++counters_.pairs;
  return &*plain_;
}

/// Does the next piece of work; it may send nothing.
void HostStream::Host::advance() {
  if (assembled_next_ < assembled_.size()) {
    send_next_primitive();
  } else if (bins_ && (!bins_->is_empty() || !clears_.empty()) &&
             (command_ == scene_.commands.size() || (!held_ && begins_bins(scene_.commands[command_])))) {
    close_bins();
  } else if (command_ < scene_.commands.size()) {
    const Command& command = scene_.commands[command_++];
    if (const auto* clear = std::get_if<Clear>(&command)) send_clear(*clear);
    if (const auto* draw = std::get_if<Draw>(&command)) start_draw(*draw);
  } else {
    PrimitivePacket flush = flat_packet(PrimitiveKind::flush, {0, 0, scene_.width, scene_.height});
    if (config_.frame_store == FrameStore::color) flush.state.depth_test = DepthFunc::never;  // drops_depth()
    send(host_primitive(flush, primitive_));
    pending_.back().command = HostPrimitive::kNoCommand;
    is_finished_ = true;
  }
}

void HostStream::Host::close_bins() {
  SignatureHash clears;
  for (const HostPrimitive& clear : clears_) {
    for (const std::uint32_t code : clear.packet.vertex.code[0]) clears.add(code);
    clears.add(clear.packet.state.depth_write);
    clears.add(clear.packet.state.color_write);
    clears.add(clear.units.stencil.test[0].value_or(0));
  }
  bins_->close(config_.frame_store == FrameStore::color, held_, clears.signature());
  counters_.bins = bins_->bins();
  counters_.pairs = bins_->pairs();
  counters_.skipped.bins = bins_->left_out();
  send_clears();
}

/// Sends the clears that waited for the bins: unchanged, or, if some bins are skipped, the last colour in each of the
/// others, and then depth, if any draw follows.
void HostStream::Host::send_clears() {
  if (!bins_->cleared()) {
    pending_.insert(pending_.end(), clears_.begin(), clears_.end());
  } else {
    const auto has_color = [](const HostPrimitive& clear) { return clear.packet.state.color_write; };
    if (const auto last = std::find_if(clears_.rbegin(), clears_.rend(), has_color); last != clears_.rend()) {
      HostPrimitive part = *last;
      part.packet.state.depth_test = DepthFunc::equal;  // clears_bin()
      part.packet.state.depth_write = false;
      part.units.stencil = {};
      for (const PixelBounds& box : *bins_->cleared()) {
        part.packet.box = to_box(box);
        pending_.push_back(part);
      }
    }
    for (HostPrimitive& clear : clears_) {
      if (!clear.packet.state.depth_write || !bins_->has_next()) continue;
      clear.packet.state.color_write = false;
      pending_.push_back(clear);
    }
  }
  clears_.clear();
}

void HostStream::Host::start_draw(const Draw& draw) {
  if (draw.outside != 0) {
    const std::size_t count = primitive_count(scene_, draw);
    primitive_ += static_cast<std::uint32_t>(count);
    counters_.primitives_in += count;
    counters_.culled += count;
    return;
  }
  context_.emplace(scene_, config_, draw, static_cast<std::uint32_t>(command_ - 1));
  note_words(draw_packet(PrimitiveKind::triangle, {}).state);
  assembled_.clear();
  assembled_next_ = 0;
  for_each_primitive(scene_, draw, context_->state.provoking,
                     [this](const AssembledPrimitive& assembled) { assembled_.push_back(assembled); });
  plain_.reset();
  sets_plain_ = false;
  const State& state = context_->state;
  if (!bins_ && drawn_as(state, draw.topology) == PrimitiveType::triangle && !has_surface(state) &&
      state.polygon_offset == std::array<double, 2>{} && context_->rect.width > 0 && context_->rect.height > 0)
    plain_ = triangle_primitive({}, false);
}

void HostStream::Host::send_next_primitive() {
  const AssembledPrimitive& assembled = assembled_[assembled_next_++];
  if (drawn_as(context_->state, context_->draw.topology) != PrimitiveType::triangle) {
    send_outline(assembled);
  } else {
    pieces_.clear();
    bool is_culled = true;  // nothing is left to cull: no packet can express an empty rectangle, and bins hold none
    if (!bins_ && context_->rect.width > 0 && context_->rect.height > 0)
      is_culled = geometry_for_hardware(*context_, vertices_, assembled.index, primitive_, counters_, pieces_);
    else
      geometry(*context_, vertices_, assembled.index, primitive_, Skip{}, counters_, pieces_);
    for (const Triangle& piece : pieces_) send_triangle(piece, is_culled);
  }
  ++primitive_;
}

/// Sends lines with a packet that holds their place, strand by strand, rectangles as triangles, points as boxes; only
/// lines and points with at least one pixel.
void HostStream::Host::send_outline(const AssembledPrimitive& assembled) {
  outline_.clear();
  geometry(*context_, widths_, vertices_, assembled, primitive_, counters_, outline_);
  if (!bins_ && !outline_.triangles.empty()) --counters_.drawn;  // in program order the hardware counts triangles
  for (const LinePrimitive& line : outline_.lines) send_line(line);
  for (const Triangle& triangle : outline_.triangles) send_triangle(triangle, true);
  for (const PointPrimitive& point : outline_.points)
    for_each_run(point, widths_.grid_bits, [&](const PixelBounds& box) {
      HostPrimitive drawn = drawn_primitive(PrimitiveKind::point, box, primitive_);
      drawn.packet.vertex.code.fill(point.drawn.at.code);
      send(drawn);
    });
}

void HostStream::Host::send_line(const LinePrimitive& line) {
  const LineSetup& setup = line.setup;
  HostPrimitive place = drawn_primitive(PrimitiveKind::line, {setup.x, setup.y, setup.x, setup.y}, primitive_);
  if (bins_) {
    const Rect& rect = context_->rect;
    bins_->add(place, {line.drawn.start,
                       line.drawn.end,
                       context_->state.line_rule,
                       line.drawn.drops_last,
                       {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1}});
    return;
  }
  place.line = setup;
  place.line->primitive_id = place.packet.primitive_id;
  send(place);
}

PrimitivePacket HostStream::Host::draw_packet(PrimitiveKind kind, const PixelBounds& box) const {
  const State& state = context_->state;
  PrimitivePacket packet;
  packet.kind = kind;
  packet.state = fragment_state(state, config_.color_format);
  if (const auto& sides = context_->fragment_ops.stencil) (void)set_stencil_flags(packet.state, *sides);
  if (widths_.has_samples != 0)
    packet.state.masked_samples =
        static_cast<std::uint8_t>(~drawn_samples(state) & ((1U << widths_.pixel_samples) - 1));
  packet.box = to_box(box);
  return packet;
}

HostPrimitive HostStream::Host::triangle_primitive(const Triangle& triangle, bool is_culled) {
  const State& state = context_->state;
  const Rect& rect = context_->rect;
  HostPrimitive out = drawn_primitive(
      PrimitiveKind::triangle, {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1}, triangle.primitive);
  out.packet.cull = is_culled ? Cull::none : state.cull;
  out.packet.front_cw = state.front == FrontFace::cw;
  set_vertices(out.packet.vertex, triangle.v);
  units_.fill(*context_, triangle, held_ != nullptr, out);
  return out;
}

void HostStream::Host::send_triangle(const Triangle& triangle, bool is_culled) {
  send(triangle_primitive(triangle, is_culled));
}

/// A fast clear of the whole target; of no buffer so far.
PrimitivePacket HostStream::Host::fast_clear() const {
  PrimitivePacket packet = flat_packet(PrimitiveKind::fast_clear, {0, 0, scene_.width, scene_.height});
  if (bins_ && config_.frame_store == FrameStore::color) packet.state.depth_test = DepthFunc::never;  // drops_depth()
  return packet;
}

/// Depth and stencil are one word of memory. A clear of one of them clears both if the host knows the value of the
/// other.
void HostStream::Host::fill_word(Clear& clear) const {
  if (!has_stencil(config_)) {
    clear.stencil.reset();
    return;
  }
  if (clear.depth && !clear.stencil) clear.stencil = stencil_everywhere_;
  if (clear.stencil && !clear.depth) clear.depth = depth_everywhere_;
}

/// Whether new bins begin with a command: with a fast clear of depth.
bool HostStream::Host::begins_bins(const Command& command) const {
  const Clear* whole = whole_clear(scene_, command);
  if (whole == nullptr) return false;
  Clear clear = *whole;
  fill_word(clear);
  return clear.depth && clear.stencil.has_value() == has_stencil(config_);
}

void HostStream::Host::send_clear(const Clear& command) {
  const Rect rect = clear_rect(scene_, command);
  Clear clear = command;
  const bool is_whole = rect == Rect{0, 0, scene_.width, scene_.height};
  if (is_whole || !has_stencil(config_)) fill_word(clear);
  if (rect.width <= 0 || rect.height <= 0 || (!clear.depth && !clear.color && !clear.stencil)) return;
  const bool is_word = !has_stencil(config_) || clear.depth.has_value() == clear.stencil.has_value();
  const bool is_fast = is_whole && is_word && (!bins_ || bins_->is_empty());
  PrimitivePacket packet = is_fast ? fast_clear() : flat_packet(PrimitiveKind::rectangle, rect);
  if (clear.depth) clear_depth(packet, *clear.depth, config_);
  if (clear.color) clear_color(packet, *clear.color, config_);
  HostPrimitive out = host_primitive(packet, primitive_);
  if (!is_fast) out.units.colors = color_words({packet.state, {}, {}, {}}, config_);  // for any earlier draws
  if (clear.stencil && is_fast) out.units.stencil.test[0] = pack_test(replacing_stencil(*clear.stencil));
  if (clear.stencil && !is_fast) {
    const Stencil replacing = replacing_stencil(*clear.stencil);
    (void)set_stencil_flags(out.packet.state, {replacing, replacing});
    out.units.stencil.test[0] = pack_test(replacing);  // a rectangle shows its front
    out.units.stencil.update[0] = pack_update(replacing);
  }
  note_words(out.packet.state);
  if (is_whole && clear.depth) depth_everywhere_ = clear.depth;
  if (is_whole && clear.stencil) stencil_everywhere_ = clear.stencil;
  send(out);
}

/// Marks the buffers that a primitive may write as no longer uniform.
void HostStream::Host::note_words(const PrimitiveState& state) {
  if (state.depth_write) depth_everywhere_.reset();
  if (state.writes_stencil) stencil_everywhere_.reset();
}

HostPrimitive HostStream::Host::host_primitive(const PrimitivePacket& packet, std::uint32_t primitive) const {
  HostPrimitive out{packet, {}, primitive, static_cast<std::uint32_t>(command_ - 1), false};
  set_number(out, primitive);
  return out;
}

/// A primitive of the current draw, without its vertices.
HostPrimitive HostStream::Host::drawn_primitive(PrimitiveKind kind, const PixelBounds& box,
                                                std::uint32_t primitive) const {
  HostPrimitive out{draw_packet(kind, box), {}, primitive, static_cast<std::uint32_t>(command_ - 1), false};
  set_number(out, primitive);
  const FragmentOps& ops = context_->fragment_ops;
  out.units.colors = color_words(ops, config_);
  if (out.packet.state.tests_stencil) out.units.stencil = stencil_words(*ops.stencil);
  return out;
}

/// Sends tokens at once, and in program order everything.
void HostStream::Host::send(const HostPrimitive& primitive) {
  const PrimitiveKind kind = primitive.packet.kind;
  if (bins_ && kind != PrimitiveKind::fast_clear && kind != PrimitiveKind::flush) {
    if (!bins_->add(primitive)) ++counters_.skipped.no_sample;
    return;
  }
  if (held_ != nullptr && kind == PrimitiveKind::fast_clear) {
    clears_.push_back(primitive);
    return;
  }
  pending_.push_back(primitive);
  if (is_counted(kind)) ++counters_.pairs;
}

double HostStream::Host::progress() const {
  if (is_finished_) return 1;
  const auto part = [](std::size_t done, std::size_t all) {
    return all == 0 ? 0.0 : static_cast<double>(done) / static_cast<double>(all);
  };
  const auto commands = static_cast<double>(scene_.commands.size());
  const double left_of_draw = assembled_.empty() ? 0.0 : 1.0 - part(assembled_next_, assembled_.size());
  return commands == 0 ? 0.0 : (static_cast<double>(command_) - left_of_draw) / commands;
}

HostStream::HostStream(const Scene& scene, const Config& config, BinContents* held)
    : host_(std::make_unique<Host>(scene, config, held)) {}
HostStream::~HostStream() = default;
const HostPrimitive* HostStream::pull() { return host_->pull(); }
std::optional<HostPrimitive> HostStream::next() {
  const HostPrimitive* const primitive = pull();
  return primitive == nullptr ? std::nullopt : std::optional(*primitive);
}
const Counters& HostStream::counters() const { return host_->counters(); }
double HostStream::progress() const { return host_->progress(); }

}  // namespace halfplane
