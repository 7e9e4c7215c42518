#include "sim/cover/bins.hpp"

#include <algorithm>
#include <bit>

#include "sim/words.hpp"

namespace halfplane::cover {
namespace {

constexpr std::string_view kFunctions = "never less lequal equal greater gequal notequal always";
constexpr std::string_view kStencilOps = "keep zero replace incr decr invert incr_wrap decr_wrap";

constexpr std::uint64_t one(bool is) { return is ? 1 : 0; }
template <class Enum>
constexpr std::uint64_t bit(Enum value, bool is = true) {
  return is ? std::uint64_t{1} << static_cast<unsigned>(value) : 0;
}

/// The counter went up.
template <std::uint64_t CounterPacket::*counter>
constexpr std::uint64_t rose(const Seen& s) {
  return one(s.counted.*counter != 0);
}

bool has_operation(const Seen& s) { return s.stencil != nullptr; }
StencilOp operation(const Seen& s) { return stencil_op(*s.stencil, s.passes_stencil, s.passes_depth); }
/// The operation runs on this stored value, with some bit to write.
std::uint64_t stencil_at(const Seen& s, StencilOp op, std::uint8_t stored) {
  return one(has_operation(s) && operation(s) == op && s.stored_stencil == stored && s.stencil->write_mask != 0);
}

std::uint64_t sides_tied(const Seen& s) { return s.ties; }

// clang-format off
const BinRow kBinRows[] = {
    // ---- what the host sends
    {Event::draw, "draw.*", "triangles lines points", "a draw of triangles, lines, points", {}, "--random 2000 --random-only *",
     {}, [](const Seen& s) { return bit(s.type, s.type != PrimitiveType::line || s.config.line_units != 0); }},
    {Event::draw, "scissor", "", "a draw inside a scissor", {}, "--random 20000", "24",
     [](const Seen& s) { return one(s.state->scissor.has_value()); }},
    {Event::primitive, "kind.*", "triangle rectangle fast_clear flush point", "a primitive of this kind reaches cull", {}, {},
     {}, [](const Seen& s) { return s.kind <= PrimitiveKind::point ? bit(s.kind) : 0; }},
    {Event::primitive, "kind.line", "", "the place of a line reaches cull", "lines.unit", "--random 2000 --random-only lines",
     {}, [](const Seen& s) { return one(s.kind == PrimitiveKind::line); }},
    {Event::primitive, "kind.state", "", "a token sets a unit's register",
     "blend.lanes|texture.unit|alpha.unit|stencil.bits|dither.unit|fog.unit", {}, "376",
     [](const Seen& s) { return one(s.kind == PrimitiveKind::state); }},
    {Event::primitive, "clear.*", "depth color both", "a fast clear of depth, of colour, of both", {}, {}, "37 71 75",
     [](const Seen& s) {
       return s.kind != PrimitiveKind::fast_clear
                  ? 0
                  : one(s.primitive->state.depth_write && !s.primitive->state.color_write) |
                        one(!s.primitive->state.depth_write && s.primitive->state.color_write) << 1 |
                        one(s.primitive->state.depth_write && s.primitive->state.color_write) << 2;
     }},
    {Event::primitive, "clear.bin", "", "a fast clear of one bin, in a frame after another", "cache.kind=blocks",
     "--random 20000", "404 405 406 407",
     [](const Seen& s) { return one(s.kind == PrimitiveKind::fast_clear && s.primitive->state.clears_bin()); }},
    {Event::primitive, "flush.drops_depth", "", "a flush that does not store depth", "cache.kind=blocks",
     "--random 20000 --set frame.store=color", "94 95",
     [](const Seen& s) { return one(s.kind == PrimitiveKind::flush && s.primitive->state.drops_depth()); }},
    {Event::primitive, "bin.part", "", "the part of a primitive in one bin", "cache.kind=blocks",
     "--random 20000 --set frame.order=bins", {}, [](const Seen& s) { return one(s.is_part); }},
    {Event::primitive, "clip.guard_band", "", "the host clips a triangle or a line", {}, "walk --size 64x64", {},
     [](const Seen& s) { return one(s.is_clipped); }},
    {Event::primitive, "clip.outside", "", "the host drops what lies outside one clip plane", {}, "walk --size 64x64", {},
     [](const Seen& s) { return one(s.is_outside); }},
    // ---- cull
    {Event::counted, "cull.zero_area", "", "a triangle of area 0", {}, {}, {}, rose<&CounterPacket::zero_area>},
    {Event::counted, "cull.backface", "", "a triangle that faces away", {},
     "--random 20000 --random-only 'triangles,cull=back|front'", "2", rose<&CounterPacket::backface>},
    {Event::counted, "cull.empty", "", "a primitive without a pixel centre in its box", {}, {}, "6",
     rose<&CounterPacket::empty>},
    {Event::counted, "cull.no_sample", "", "a small triangle that covers no sample, found by cull",
     "setup.kind=pipelined msaa.samples=1", "--random 20000 --random-only triangles,size=1..3", "56 57 58 59",
     rose<&CounterPacket::no_sample>},
    {Event::triangle, "cull.order.*", "012 120 201 021 102 210", "corners in this canonical order of the input", {}, {}, "4 5",
     [](const Seen& s) { return std::uint64_t{1} << s.corner; }},
    {Event::triangle, "cull.same_corner", "", "two corners of a triangle kept with the same y, or the same x", {}, {}, "4",
     [](const Seen& s) {
       const auto& v = s.triangle->vertex;
       return one(s.triangle->kind == PrimitiveKind::triangle &&
                  (v.x[0] == v.x[1] || v.x[1] == v.x[2] || v.y[0] == v.y[1] || v.y[1] == v.y[2]));
     }},
    {Event::triangle, "cull.box_on_corner", "", "the leftmost corner lies on a column of pixel centres", {}, {}, "3",
     [](const Seen& s) {
       const auto& x = s.triangle->vertex.x;
       const int unit = 1 << s.widths.grid_bits;
       return one(s.triangle->kind == PrimitiveKind::triangle &&
                  ((std::min({x[0], x[1], x[2]}) - unit / 2) & (unit - 1)) == 0);
     }},
    {Event::triangle, "setup.area_power_of_two", "", "the area is a power of two: its reciprocal is exact", {}, {}, "9",
     [](const Seen& s) {
       return one(s.triangle->kind == PrimitiveKind::triangle && std::has_single_bit(s.triangle->area));
     }},
    {Event::setup, "setup.depth.*", "flat rises_x falls_x rises_y falls_y", "the gradient of depth", {}, {}, "8 20",
     [](const Seen& s) {
       const auto x = s.setup->step_x[kDepthPlane], y = s.setup->step_y[kDepthPlane];
       return s.setup->kind != PrimitiveKind::triangle
                  ? 0
                  : one(x == 0 && y == 0) | one(x > 0) << 1 | one(x < 0) << 2 | one(y > 0) << 3 | one(y < 0) << 4;
     }},
    // ---- the tile walk
    {Event::setup, "walk.left", "", "a row of tiles is walked to the left of its start", {}, {}, "65 66 67",
     [](const Seen& s) { return one(s.walks_left); }},
    {Event::counted, "tile.rejected", "", "a tile outside an edge: trivial reject", {}, {}, "18",
     rose<&CounterPacket::tiles_outside>},
    {Event::tile, "tile.accepted", "", "a tile inside all edges: trivial accept", {},
     "--random 20000 --random-only triangles,size=40..400", {},
     [](const Seen& s) {
       return one(s.tile->is_visit && s.tile->kind == PrimitiveKind::triangle && s.tile->is_inside);
     }},
    {Event::tile, "tile.cut", "", "a tile that an edge cuts", {}, {}, {},
     [](const Seen& s) {
       return one(s.tile->is_visit && s.tile->kind == PrimitiveKind::triangle && !s.tile->is_inside);
     }},
    {Event::tile, "tile.end_without_visit", "", "a primitive whose last tile was skipped", {}, {}, {},
     [](const Seen& s) { return one(!s.tile->is_visit && s.tile->kind == PrimitiveKind::triangle); }},
    {Event::tile, "tile.box_ends", "", "the box ends left of a tile's last column", {}, {}, "19",
     [](const Seen& s) { return one(s.tile->is_visit && s.tile->box.right + 1 < 1 << s.widths.tile_shift); }},
    {Event::tile, "tile.saturated", "", "an edge value beyond the narrow range of a tile", {},
     "--random 20000 --random-only triangles,size=40..400", "14",
     [](const Seen& s) {
       const auto& range = s.widths.tile_edge.range;
       return one(
           s.tile->is_visit && s.tile->kind == PrimitiveKind::triangle &&
           std::ranges::any_of(s.tile->edge_value, [&](std::int32_t v) { return v == range.lo || v == range.hi; }));
     }},
    {Event::tie, "tile.reject_tie", "", "a tile is kept because its best sample is on an edge", "msaa.samples=1", {}, "12",
     [](const Seen& s) { return one(s.widths.has_samples == 0 && s.is_best_on_edge); }},
    {Event::tie, "tile.accept_tie", "", "a tile is accepted with its worst sample on an edge", "msaa.samples=1", {}, "13",
     [](const Seen& s) { return one(s.widths.has_samples == 0 && s.is_worst_on_edge && s.tile->is_inside); }},
    // ---- ties
    {Event::tie, "tie.*", "top left other", "a pixel centre on an edge of this kind, inside the others", {},
     "--random 2000 --random-only triangles,ties=100,size=1..40", "1 23", [](const Seen& s) { return sides_tied(s) & 7; }},
    {Event::tie, "tie.corner", "", "a pixel centre on a corner: on two edges", {},
     "--random 2000 --random-only triangles,ties=100,size=1..40", "1 23", [](const Seen& s) { return sides_tied(s) >> 3 & 1; }},
    // ---- HiZ
    {Event::counted, "hiz.skip", "", "a tile hidden by its bound", "hiz.bits",
     "--random 20000 --random-only triangles,less,size=100..400,overlap=50", {}, rose<&CounterPacket::tiles_hiz>},
    {Event::tile, "hiz.pass", "", "a tile that was tested and is drawn", "hiz.bits", {}, {},
     [](const Seen& s) { return one(s.tile->is_visit && s.asks_hiz); }},
    {Event::tile, "hiz.lag", "", "a tile is drawn that an update hides which the lag still holds back", "hiz.bits", {}, "15",
     [](const Seen& s) { return one(s.tile->is_visit && s.asks_hiz && s.is_hidden_by_newer); }},
    {Event::tile, "hiz.equal", "", "the bound is the primitive's smallest depth, with lequal or equal", "hiz.bits", {}, "16",
     [](const Seen& s) {
       return one(s.tile->is_visit && s.asks_hiz && s.is_hiz_bound_equal &&
                  s.setup->state.depth_test != DepthFunc::less);
     }},
    {Event::tile, "hiz.raising", "", "a tile is tested while a visit that may raise a depth is unseen", "hiz.bits", {},
     "17 62 63", [](const Seen& s) { return one(s.tile->is_visit && s.asks_hiz && s.is_in_raising_window); }},
    {Event::setup, "hiz.off_by_line", "", "bounds do not hold: a line may have raised a depth", "hiz.bits lines.unit", {}, "51",
     [](const Seen& s) { return one(s.is_hiz_off_by_line); }},
    {Event::setup, "hiz.off_by_stencil", "", "tiles are not tested: a sample that fails changes the stencil",
     "hiz.bits stencil.bits", {}, "213", [](const Seen& s) { return one(s.is_hiz_off_by_stencil); }},
    {Event::retire, "hiz.update.*", "none set clear", "a visit leaves its tile's bound, lowers it, or makes it all ones",
     "hiz.bits", {}, "33 34 112", [](const Seen& s) { return bit(s.retire->update, s.config.hiz_bits != 0); }},
    // ---- fine raster
    {Event::stamp, "stamp.*", "empty partial full", "a stamp with no, some, all samples covered", {}, {}, "25",
     [](const Seen& s) {
       return s.stamp->kind == PrimitiveKind::line
                  ? 0
                  : std::uint64_t{1} << (!s.stamp->mask.any()                                 ? 0
                                         : s.stamp->mask == SampleMask::all(s.widths.samples) ? 2
                                                                                              : 1);
     }},
    {Event::stamp, "stamp.centre_uncovered", "", "a pixel with a covered sample and an uncovered centre", "msaa.samples", {},
     "427 422 424 425",
     [](const Seen& s) {
       return one(s.widths.has_samples != 0 &&
                  (s.widths.stamps.pixels_of(s.stamp->mask).bits() & ~s.stamp->centre.bits()) != 0);
     }},
    // ---- lines
    {Event::line, "line.octant.*",
     "x_right_down x_right_up x_left_down x_left_up y_right_down y_right_up y_left_down y_left_up",
     "a line in this octant: major axis, directions", "lines.unit", "--random 2000 --random-only lines", "42",
     [](const Seen& s) {
       return std::uint64_t{1} << ((s.line->is_x_major ? 0 : 4) + (s.line->is_x_negative ? 2 : 0) +
                                   (s.line->is_y_negative ? 1 : 0));
     }},
    {Event::line, "line.tie", "", "a step at which the error is 0", "lines.unit", "--random 2000 --random-only lines",
     "40", [](const Seen& s) { return one(s.has_line_tie); }},
    {Event::line, "line.one_pixel", "", "a line of one pixel", "lines.unit", "--random 2000 --random-only lines", "43",
     [](const Seen& s) { return one(s.line->remaining == 0); }},
    {Event::line, "line.before_start", "", "a line's first pixel lies before its start", "lines.unit",
     "--random 2000 --random-only lines", "44", [](const Seen& s) { return one(s.line->is_before_start); }},
    // ---- depth test
    {Event::sample, "depth.equal.*", kFunctions, "the fragment's depth is the stored one, with this function", {},
     "--random 2000 --random-only *,always,depth=equal,overlap=60", "32",
     [](const Seen& s) { return bit(s.func, s.has_stored && s.depth == s.stored); }},
    {Event::sample, "depth.pass.*", kFunctions.substr(kFunctions.find(' ') + 1), "a sample passes this function", {},
     "--random 2000 --random-only *,overlap=60", {},
     [](const Seen& s) { return bit(s.func, s.passes_depth && s.func != DepthFunc::never) >> 1; }},
    {Event::sample, "depth.fail.*", kFunctions.substr(0, kFunctions.rfind(' ')), "a sample fails this function", {},
     "--random 2000 --random-only *,overlap=60", {},
     [](const Seen& s) { return bit(s.func, !s.passes_depth && s.func != DepthFunc::always); }},
    {Event::sample, "depth.code.*", "nearest farthest", "a fragment with the smallest, the largest code", {}, {}, "27",
     [](const Seen& s) { return one(s.depth == 0) | one(s.depth == s.widths.depth().code.range.hi) << 1; }},
    {Event::meeting, "hazard.same_stamp", "", "two stamps in a row share samples, and the first writes depth", {},
     "--random 20000 --random-only triangles,overlap=60,size=1..2", "31 76",
     [](const Seen& s) { return one(s.is_same_stamp); }},
    // ---- stencil
    {Event::sample, "stencil.pass.*", kFunctions.substr(kFunctions.find(' ') + 1), "a sample passes this stencil function",
     "stencil.bits", {}, "208",
     [](const Seen& s) {
       return s.stencil == nullptr ? 0
                                   : bit(s.stencil->func, s.passes_stencil && s.stencil->func != DepthFunc::never) >> 1;
     }},
    {Event::sample, "stencil.fail.*", kFunctions.substr(0, kFunctions.rfind(' ')), "a sample fails this stencil function",
     "stencil.bits", {}, "208",
     [](const Seen& s) {
       return s.stencil == nullptr ? 0
                                   : bit(s.stencil->func, !s.passes_stencil && s.stencil->func != DepthFunc::always);
     }},
    {Event::sample, "stencil.sfail.*", kStencilOps, "the operation of a sample that fails the stencil test", "stencil.bits", {},
     "209 213", [](const Seen& s) { return has_operation(s) ? bit(operation(s), !s.passes_stencil) : 0; }},
    {Event::sample, "stencil.zfail.*", kStencilOps, "the operation of a sample that fails the depth test alone", "stencil.bits",
     {}, "209 214",
     [](const Seen& s) { return has_operation(s) ? bit(operation(s), s.passes_stencil && !s.passes_depth) : 0; }},
    {Event::sample, "stencil.zpass.*", kStencilOps, "the operation of a sample that passes both tests", "stencil.bits", {},
     "322 323", [](const Seen& s) { return has_operation(s) ? bit(operation(s), s.passes_stencil && s.passes_depth) : 0; }},
    {Event::sample, "stencil.wrap.incr", "", "incr_wrap of 255", "stencil.bits",
     "--random 20000 --random-only 'overlap=60,stencil=always 255 255 255 replace replace replace|always 1 255 255 "
     "incr_wrap incr_wrap incr_wrap'", {}, [](const Seen& s) { return stencil_at(s, StencilOp::incr_wrap, 255); }},
    {Event::sample, "stencil.wrap.decr", "", "decr_wrap of 0", "stencil.bits", {}, {},
     [](const Seen& s) { return stencil_at(s, StencilOp::decr_wrap, 0); }},
    {Event::sample, "stencil.hold.incr", "", "incr of 255 stays", "stencil.bits",
     "--random 20000 --random-only 'overlap=60,stencil=always 255 255 255 replace replace replace|always 1 255 255 "
     "incr incr incr'",
     "211", [](const Seen& s) { return stencil_at(s, StencilOp::incr, 255); }},
    {Event::sample, "stencil.hold.decr", "", "decr of 0 stays", "stencil.bits", {}, {},
     [](const Seen& s) { return stencil_at(s, StencilOp::decr, 0); }},
    {Event::sample, "stencil.write_mask", "", "a sample keeps stored bits outside the write mask", "stencil.bits", {}, "210",
     [](const Seen& s) {
       return one(has_operation(s) && operation(s) != StencilOp::keep && s.stencil->write_mask != 255 &&
                  (s.stored_stencil & ~s.stencil->write_mask) != 0);
     }},
    {Event::meeting, "stencil.back", "", "a stamp of a triangle that shows its back, with a stencil test", "stencil.bits", {},
     "212 217", [](const Seen& s) { return one(s.fragment->state.tests_stencil && s.fragment->state.is_back); }},
    // ---- alpha test
    {Event::fate, "alpha.*", "kept killed", "the alpha test keeps, drops a sample that passed the depth test", "alpha.unit", {},
     "207 324 325 329 330",
     [](const Seen& s) {
       return !s.colors->tests_alpha() ? 0 : one(s.fate->kept.any()) | one(s.fate->kept != s.fate->passed) << 1;
     }},
    {Event::fate, "alpha.killed_depth", "", "a sample that the alpha test drops would have written depth", "alpha.unit", {},
     "201 202 203 327 328",
     [](const Seen& s) {
       return one(s.colors->tests_alpha() && s.fragment->state.depth_write && s.fate->kept != s.fate->passed);
     }},
    {Event::fate, "alpha.func.*", kFunctions.substr(0, kFunctions.rfind(' ')), "a stamp is tested with this alpha function",
     "alpha.unit", {}, "200 326",
     [](const Seen& s) { return bit(s.colors->alpha.func, s.colors->alpha.func != DepthFunc::always); }},
    // ---- colours
    {Event::fate, "color.reads_stored", "", "operations read the stored colour of a sample that they write", "blend.lanes", {},
     "182 183 184 185 190 192",
     [](const Seen& s) {
       return one(s.colors->ops.reads_stored() && s.fragment->state.color_write && s.fate->kept.any());
     }},
    // ---- framebuffer
    {Event::lookup, "cache.depth_from.*", "none chip clear memory", "the source of a stamp's stored depth", "cache.kind=blocks",
     {}, "74 77", [](const Seen& s) { return bit(s.tags->source); }},
    {Event::lookup, "cache.color_from.*", "chip clear memory", "the source of a stamp's stored colour",
     "cache.kind=blocks blend.lanes", {}, "189 196 197 198 199",
     [](const Seen& s) { return bit(s.tags->color_source, s.tags->color_source != DepthSource::none) >> 1; }},
    {Event::lookup, "cache.conflict", "", "a block that was written leaves its line for another one", "cache.kind=blocks", {},
     "70 72 73 191 220 221", [](const Seen& s) { return one(s.tags->eviction.has_value()); }},
    {Event::lookup, "cache.victim_full", "", "an eviction while all victims are taken: the oldest goes to memory",
     "cache.kind=blocks cache.victims", {}, "80 261 262 263 264",
     [](const Seen& s) {
       return one(s.tags->eviction.has_value() && s.victims == static_cast<std::size_t>(s.config.cache_victims) &&
                  !s.is_victim_again);
     }},
    {Event::lookup, "cache.victim_again", "", "a block is needed while it waits among the victims",
     "cache.kind=blocks cache.victims", {}, "72", [](const Seen& s) { return one(s.is_victim_again); }},
    {Event::lookup, "cache.flag_falls", "", "a cleared block leaves: memory gets all of it, and its flag falls",
     "cache.kind=blocks", {}, "79 92 96 222 223", [](const Seen& s) { return one(s.tags->falls()); }},
    {Event::counted, "tile.fill", "", "depths are read from memory", {}, {}, "78", rose<&CounterPacket::tile_fills>},
    {Event::counted, "tile.clear", "", "depths are those of a fast clear", {}, {}, {}, rose<&CounterPacket::tile_clears>},
    {Event::counted, "tile.evict", "", "stamps are written back to memory", {}, {}, "36 121",
     rose<&CounterPacket::tile_evictions>},
    {Event::request, "request.*", "read write", "a request for memory", {}, {}, {},
     [](const Seen& s) { return std::uint64_t{1} << (s.request->is_write ? 1 : 0); }},
    {Event::request, "request.partial", "", "a write of some samples of a stamp", {}, {}, "102 78",
     [](const Seen& s) {
       return one(s.request->is_write && s.request->plane <= TilePlane::color && s.request->strobe.any() &&
                  s.request->strobe != SampleMask::all(s.widths.samples));
     }},
    {Event::request, "request.run", "", "a burst of several stamps", {}, {}, "101 108 126",
     [](const Seen& s) { return one(s.request->run > 1); }},
    {Event::request, "request.flags", "", "a flush writes flags of cleared blocks", {}, {}, "94",
     [](const Seen& s) {
       return one(s.request->plane == TilePlane::depth_flags || s.request->plane == TilePlane::color_flags);
     }},
    {Event::request, "request.pixels", "", "a block with one colour a pixel", "compress.unit", {}, "455 456 457 458 459 460",
     [](const Seen& s) { return one(s.request->plane == TilePlane::pixel_color); }},
    // ---- texture unit
    {Event::fate, "texture.*", "hit miss", "a sample finds its lines in the cache, or not", "texture.unit", {},
     "149 151 152 153",
     [](const Seen& s) {
       std::uint64_t hits = 0;
       for (const TextureLookup& lookup : s.fate->lookups) hits |= one(lookup.hits != 0) | one(lookup.is_miss) << 1;
       return hits;
     }},
    {Event::fate, "texture.two_levels", "", "a sample between two levels", "texture.unit=trilinear", {}, "168 170 254 255",
     [](const Seen& s) {
       return one(std::ranges::any_of(s.fate->lookups,
                                      [](const TextureLookup& lookup) { return lookup.continues || lookup.turns; }));
     }},
    {Event::texture, "texture.read", "", "a line of texels is read from memory", "texture.unit", {}, "150 256",
     [](const Seen&) { return std::uint64_t{1}; }},
    // ---- cycles of the RTL
    {Event::stream, "flow.held.*", "@streams", "a packet on this arrow is held back", {}, "--random 20000 --stalls 0.3",
     "26 28 30 46 60", [](const Seen& s) { return std::uint64_t{1} << s.stream; }},
};
// clang-format on

/// The words of a row's family.
std::vector<std::string> members_of(const BinRow& row) {
  if (row.members.empty()) return {""};
  if (row.members != "@streams") return words_of(row.members, ' ');
  std::vector<std::string> words;
  for (const Arrow arrow : kStreams) words.emplace_back(info(arrow).name);
  return words;
}

std::string filled(std::string_view text, const std::string& word) {
  std::string result(text);
  for (std::size_t at = result.find('*'); at != std::string::npos; at = result.find('*', at + word.size()))
    result.replace(at, 1, word);
  return result;
}

}  // namespace

std::span<const BinRow> bin_rows() { return kBinRows; }

const std::vector<Bin>& bins() {
  static const std::vector<Bin> kAll = [] {
    std::vector<Bin> all;
    for (const BinRow& row : kBinRows) {
      unsigned member = 0;
      for (const std::string& word : members_of(row))
        all.push_back({&row, member++, filled(row.name, word), filled(row.what, word),
                       filled(row.hit_by.empty() ? "--random 20000" : row.hit_by, word)});
    }
    return all;
  }();
  return kAll;
}

std::string missing_setting(const BinRow& row, const Config& config) {
  for (const std::string& need : words_of(row.needs, ' ')) {
    bool has_one = false;
    for (const std::string& choice : split(need, '|')) {
      const std::size_t equals = choice.find('=');
      const std::string key = choice.substr(0, equals);
      const auto setting = std::ranges::find(settings(), key, &Setting::key);
      const std::string value = get(config, *setting);
      has_one |= equals != std::string::npos
                     ? value == choice.substr(equals + 1)
                     : value != "0" && value != "off" && !(key == "msaa.samples" && value == "1");
    }
    if (!has_one) return need;
  }
  return "";
}

}  // namespace halfplane::cover
