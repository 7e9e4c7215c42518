#include "verify.hpp"

#include <algorithm>
#include <cstdio>

#include "model/packets/packet_words.hpp"
#include "model/stages/depth_test.hpp"
#include "model/stages/line_raster.hpp"
#include "sim/cosim/arrows.hpp"

namespace halfplane::explain {
namespace {

std::string place_of(const PixelHistory& pixel) {
  return "pixel " + std::to_string(pixel.at.x) + "," + std::to_string(pixel.at.y) +
         (pixel.resolved || pixel.sample != 0 ? " sample " + std::to_string(pixel.sample) : "");
}
std::string place_of(const PixelHistory& pixel, const Entry& entry) {
  const std::string primitive = entry.primitive ? " primitive " + std::to_string(*entry.primitive) : " clear";
  return place_of(pixel) + primitive + (entry.piece != 0 ? " piece " + std::to_string(entry.piece) : "");
}

std::string hex(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "%llx", static_cast<unsigned long long>(value));
  return text;
}

class Checks {
 public:
  explicit Checks(Explanation& result) : result_(result) {}
  void same(std::uint64_t a, std::uint64_t b, const std::string& place, const std::string& what) {
    ++result_.checks;
    if (a != b) result_.differences.push_back(place + ": " + what + ", " + hex(a) + " and " + hex(b));
  }
  /// `whose`: "model and RTL".
  void stored(const Stored& a, const Stored& b, const std::string& place, const std::string& whose,
              bool has_depth = true, bool has_stencil = true) {
    if (has_depth) same(a.depth, b.depth, place, "stored depths of " + whose + " differ");
    same(a.color, b.color, place, "stored colours of " + whose + " differ");
    if (has_stencil) same(a.stencil, b.stencil, place, "stored stencil values of " + whose + " differ");
  }
  void holds(bool holds, const std::string& place, const std::string& what) {
    ++result_.checks;
    if (!holds) result_.differences.push_back(place + ": " + what);
  }

 private:
  Explanation& result_;
};

/// Whether a line contains that pixel.
bool has_pixel(const LineSetup& line, int x, int y, const Widths& widths) {
  for (LineState state = first_state(line);; advance(state, line, widths)) {
    if (state.x == x && state.y == y) return true;
    if (state.remaining == 0) return false;
  }
}

/// Whether a line of the host's stream is this one, or its part in one bin: the strands of a wide line differ only in
/// their places.
bool is_line_of(const LineSetup& whole, const LineSetup& sent, bool is_part, const Widths& widths) {
  const bool is_along = whole.step_stay == sent.step_stay && whole.step_move == sent.step_move &&
                        whole.is_x_major == sent.is_x_major && whole.is_x_negative == sent.is_x_negative &&
                        whole.is_y_negative == sent.is_y_negative && whole.start == sent.start &&
                        whole.step == sent.step;
  if (is_part) return is_along && has_pixel(whole, sent.x, sent.y, widths);
  return is_along && (whole.x == sent.x && whole.y == sent.y && whole.error == sent.error &&
                      whole.remaining == sent.remaining && whole.value == sent.value);
}

/// Whether a primitive of the host's stream is this entry, or a part of it in one bin.
bool is_of(const Entry& entry, const HostPrimitive& host, const Widths& widths) {
  const PrimitiveKind kind = host.packet.kind;
  if (entry.kind == Kind::clear) return !is_counted(kind) && host.command == entry.draw;
  if (!is_counted(kind) || host.primitive != *entry.primitive || host.command != entry.draw) return false;
  if (entry.corners.empty()) return true;
  const auto same = [&](const SnappedVertex& v, std::size_t i) {
    return v.x == host.packet.vertex.x[i] && v.y == host.packet.vertex.y[i];
  };
  switch (entry.kind) {
    case Kind::clear: break;
    case Kind::triangle:
      return kind == PrimitiveKind::triangle && same(entry.corners[0], 0) && same(entry.corners[1], 1) &&
             same(entry.corners[2], 2);
    case Kind::line:
      return kind == PrimitiveKind::line && is_line_of(entry.line->setup, *host.line, host.is_part, widths);
    case Kind::point: {
      const PixelBox& box = host.packet.box;
      const bool is_within = box.left >= entry.box.left && box.right <= entry.box.right && box.top >= entry.box.top &&
                             box.bottom <= entry.box.bottom;
      return kind == PrimitiveKind::point && is_within &&
             (host.is_part || to_bounds(box).samples() == entry.box.samples());
    }
  }
  return false;
}

/// The verdict of an entry, where the hardware and the specification may use other words.
Outcome joined(const Outcome& hardware, const Outcome& specification) {
  const Verdict h = hardware.verdict;
  const bool is_of_hardware = h == Verdict::no_sample || h == Verdict::tiles_hiz;
  return is_of_hardware ? hardware : specification;
}

/// Whether both agree about the pixel.
bool agree(const Outcome& hardware, const Outcome& specification) {
  const Verdict h = hardware.verdict, s = specification.verdict;
  const bool drew = h == Verdict::written || h == Verdict::masked;
  const bool draws = s == Verdict::written || s == Verdict::masked;
  if (s == Verdict::alpha) return drew || h == Verdict::alpha;  // the packets of depth_test do not show it
  if (drew || draws) return h == s;
  if (s == Verdict::depth || s == Verdict::stencil) return h == Verdict::depth || h == Verdict::tiles_hiz;
  return h != Verdict::depth;  // no coverage: whichever stage finds it first
}

void check_edges(const HardwareVisit& visit, const PixelHistory& pixel, const Entry& entry, const Config& config,
                 const PacketStore& packets, Checks& checks) {
  const Widths widths = derive_widths(config);
  const int last = (1 << widths.tile_shift) - 1;
  const auto find = [&](Arrow arrow) -> const RecordedPacket* {
    for (const PacketId& id : visit.packets)
      if (id.first == arrow) return &packets.at(id);
    return nullptr;
  };
  const RecordedPacket *tile = find(Arrow::tile), *edges = find(Arrow::edges);
  if (tile == nullptr || edges == nullptr || entry.edges.size() != 3) return;
  const auto t = unpack_words<TilePacket>(tile->model.data(), widths);
  const auto e = unpack_words<EdgeContext>(edges->model.data(), widths);
  const auto low = static_cast<std::int64_t>(widths.tile_edge.range.lo),
             high = static_cast<std::int64_t>(widths.tile_edge.range.hi);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t value = std::int64_t{t.edge_value[i]} + std::int64_t{pixel.at.x & last} * e.step_x[i] +
                               std::int64_t{pixel.at.y & last} * e.step_y[i];
    const std::string place = place_of(pixel, entry);
    checks.holds((value < 0) == (entry.edges[i].value < 0), place, "an edge value of the tile packet has another sign");
    if (t.edge_value[i] > low && t.edge_value[i] < high)  // not saturated
      checks.same(static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(entry.edges[i].value), place,
                  "edge values of tile packet and specification differ");
  }
}

/// The last value written by an operation, if it ran.
std::optional<std::uint64_t> figure_of(const Entry& entry, std::string_view operation, std::string_view name) {
  for (const OperationStep& step : entry.operations)
    if (step.name == operation)
      for (const Figure& figure : step.figures)
        if (figure.name == name) return figure.values.front();
  return {};
}

void check_fragment(const HardwareVisit& visit, const PixelHistory& pixel, const Entry& entry, const Config& config,
                    Checks& checks) {
  const std::string place = place_of(pixel, entry);
  if (visit.fragment)
    for (std::size_t p = 0;
         p < std::min(entry.planes.size(), static_cast<std::size_t>(derive_widths(config).affine_planes)); ++p)
      checks.same(visit.fragment->code[visit.sample][p], entry.planes[p].code, place,
                  "codes of fragment packet and specification differ");
  if (!visit.write) return;
  const std::size_t s = visit.sample;
  const Widths widths = derive_widths(config);
  const bool writes = visit.write->write_depth.has(s);
  // If only the stencil changes, the word contains the stored depth.
  const PrimitiveState& state = visit.fragment->state;
  const bool keeps_depth = state.tests_stencil && !(visit.write->passed.has(s) && state.depth_write);
  if (const auto depth = figure_of(entry, "depth_test", "fragment"); depth && !keeps_depth)
    checks.same(depth_of(visit.write->depth[s], widths), *depth, place,
                "depths of write packet and specification differ");
  // Downstream of a texture no packet shows the samples that the alpha test drops.
  const bool is_late = has_texture_planes(config) && figure_of(entry, "alpha_test", "reference");
  if (is_late) return;
  const auto stencil = figure_of(entry, "write_stencil", "after");
  if (!stencil || !has_stencil(config))
    checks.holds(writes == figure_of(entry, "write_depth", "after").has_value(), place,
                 "write packet and specification differ in whether depth is written");
  else
    checks.same(writes ? stencil_of(visit.write->depth[s], widths) : *figure_of(entry, "write_stencil", "before"),
                *stencil, place, "stencil values of write packet and specification differ");
  const auto color = figure_of(entry, "write_color", "after");
  checks.holds(visit.write->write_color.has(s) == color.has_value(), place,
               "write packet and specification differ in whether colour is written");
  if (color && !packs_at_write(config))  // otherwise no packet has it in the stored format
    checks.same(visit.textured.value_or(visit.write->color[s]), *color, place,
                "colours of the hardware and of the specification differ");
}

void join_visit(const HardwareVisit& visit, const PixelHistory& pixel, Entry& entry, const Config& config,
                const PacketStore& packets, Checks& checks) {
  const std::string place = place_of(pixel, entry);
  const bool is_first = !entry.hardware;
  if (is_first) entry.hardware = HardwareFigure{visit.outcome, visit.hiz, visit.packets};
  // In bins the parts of a primitive are successive; the part that came furthest at the pixel counts.
  const bool is_further = !is_first && (visit.fragment || (!entry.hardware->hiz && visit.hiz));
  if (is_further) entry.hardware = HardwareFigure{visit.outcome, visit.hiz, visit.packets};
  if (entry.kind == Kind::clear) return;
  check_edges(visit, pixel, entry, config, packets, checks);
  check_fragment(visit, pixel, entry, config, checks);
}

}  // namespace

void join_hardware(const HardwareRecord& hardware, const Config& config, Explanation& result) {
  Checks checks(result);
  const Widths widths = derive_widths(config);
  for (std::size_t p = 0; p < result.pixels.size(); ++p) {
    PixelHistory& pixel = result.pixels[p];
    std::vector<bool> is_taken(hardware.visits[p].size());
    for (Entry& entry : pixel.history) {
      for (std::size_t v = 0; v < hardware.visits[p].size(); ++v) {
        const HardwareVisit& visit = hardware.visits[p][v];
        if (is_taken[v] || !is_of(entry, visit.host, widths)) continue;
        // Coinciding corners are equal points of one primitive: one each. Parts in bins are repeated.
        if (entry.kind == Kind::point && entry.hardware && !visit.host.is_part) break;
        is_taken[v] = true;
        join_visit(visit, pixel, entry, config, result.packets, checks);
      }
      if (!entry.hardware || entry.kind == Kind::clear) continue;
      checks.holds(agree(entry.hardware->outcome, entry.specification), place_of(pixel, entry),
                   "hardware model and specification come to another verdict");
      entry.outcome = joined(entry.hardware->outcome, entry.specification);
    }
  }
}

std::vector<std::string> differing_fields(const PacketId& id, const RecordedPacket& packet, const Widths& widths) {
  std::vector<std::string> fields;
  for (const FieldPair& pair : field_pairs(id.first, widths, packet.model.data(), packet.rtl.data()))
    if (pair.differs()) fields.push_back(pair.name + " " + hex(pair.model) + " " + hex(pair.rtl));
  return fields;
}

void verify(const Config& config, Explanation& result) {
  Checks checks(result);
  const Widths widths = derive_widths(config);
  bool has_rtl = false;
  for (const PixelHistory& pixel : result.pixels) {
    const std::string place = place_of(pixel);
    for (const Entry& entry : pixel.history) {
      if (!entry.oracle) continue;
      const Verdict verdict = entry.specification.verdict;
      checks.holds(entry.oracle->covers == (has_fragment(verdict) || verdict == Verdict::scissor || entry.is_left_out),
                   place_of(pixel, entry), "the oracle decides otherwise whether the sample is covered");
    }
    checks.stored(pixel.model, pixel.engine, place, "specification and engine");
    checks.same(static_cast<std::uint32_t>(pixel.model.owner), static_cast<std::uint32_t>(pixel.engine.owner), place,
                "owners of the pixel in specification and engine differ");
    if (pixel.resolved) {
      const Stored &model = pixel.resolved->model, &engine = pixel.resolved->engine;
      checks.same(model.color, engine.color, place, "the mean of the samples' colours and the engine's pixel differ");
      checks.same(model.depth, engine.depth, place, "the pixel's depths in specification and engine differ");
      checks.same(model.stencil, engine.stencil, place, "the pixel's stencils in specification and engine differ");
      checks.same(static_cast<std::uint32_t>(model.owner), static_cast<std::uint32_t>(engine.owner), place,
                  "the pixel's owners in specification and engine differ");
    }
    const bool has_depth = config.frame_store == FrameStore::all;
    if (pixel.hardware)
      checks.stored(pixel.model, *pixel.hardware, place, "specification and hardware", has_depth,
                    has_depth && has_stencil(config));
    has_rtl = has_rtl || pixel.rtl;
    if (pixel.rtl) checks.stored(*pixel.hardware, *pixel.rtl, place, "model and RTL", has_depth, has_depth);
  }
  if (!has_rtl) return;
  for (const auto& [id, packet] : result.packets) {
    const bool is_seen = is_compared(id.first) || id.first == Arrow::primitive || id.first == Arrow::line;
    if (!is_seen) continue;
    const std::string place = std::string(info(id.first).name) + " " + std::to_string(id.second);
    checks.holds(!packet.rtl.empty(), place, "the RTL never sends this packet");
    if (packet.rtl.empty()) continue;
    for (const std::string& field : differing_fields(id, packet, widths))
      checks.holds(false, place, "model and RTL differ in " + field);
    if (packet.model_cycle && packet.rtl_cycle)
      checks.same(*packet.model_cycle, *packet.rtl_cycle, place, "cycles of model and RTL differ");
  }
}

}  // namespace halfplane::explain
