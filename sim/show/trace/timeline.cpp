#include "sim/show/trace/timeline.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace halfplane {

std::string_view kind_name(PrimitiveKind kind) {
  const auto& all = kEnumerators<PrimitiveKind>;
  return std::ranges::find(all, kind, &Enumerator<PrimitiveKind>::value)->name;
}

PrimitiveSpans::PrimitiveSpans() : text_("number,kind,primitive,command,first,last") {
  for (const Arrow boundary : kBoundaries)
    for (const char* column : {"_first", "_last", "_items"}) text_ += "," + std::string(info(boundary).name) + column;
  text_ += '\n';
}

void PrimitiveSpans::transfer(Arrow boundary, Cycle cycle) {
  Span& span = span_[index(boundary)];
  if (span.items++ == 0) span.first = cycle;
  span.last = cycle;
}

void PrimitiveSpans::primitive(const HostPrimitive& primitive) {
  write();
  has_primitive_ = true;
  span_ = {};
  head_ = std::to_string(number_++) + "," + std::string(kind_name(primitive.packet.kind)) + ",";
  if (is_counted(primitive.packet.kind)) head_ += std::to_string(primitive.primitive);
  head_ += ",";
  if (primitive.command != HostPrimitive::kNoCommand) head_ += std::to_string(primitive.command);
}

void PrimitiveSpans::write() {
  if (!has_primitive_) return;
  Cycle first = ~Cycle{0}, last = 0;
  std::string columns;
  for (const Arrow boundary : kBoundaries) {
    const Span& span = span_[index(boundary)];
    if (span.items == 0) {
      columns += ",,,0";
      continue;
    }
    first = std::min(first, span.first);
    last = std::max(last, span.last);
    columns += "," + std::to_string(span.first) + "," + std::to_string(span.last) + "," + std::to_string(span.items);
  }
  text_ += head_ + "," + std::to_string(first) + "," + std::to_string(last) + columns + '\n';
}

const std::string& PrimitiveSpans::finish() {
  write();
  has_primitive_ = false;
  return text_;
}
namespace {

/// By Timeline::Track: the stage, or two tracks of memory.
constexpr std::array kTracks{Stage::cull,           Stage::cull,           Stage::triangle_setup, Stage::triangle_setup,
                             Stage::triangle_setup, Stage::triangle_setup, Stage::triangle_setup, Stage::triangle_setup,
                             Stage::coarse_raster,  Stage::coarse_raster,  Stage::fine_raster,    Stage::line_raster,
                             Stage::depth_test,     Stage::framebuffer,    Stage::memory,         Stage::memory};

/// "cull", "cull, second"; "memory, depth".
std::string track_name(std::size_t track) {
  constexpr std::array<const char*, 6> kNumbers{"", ", second", ", third", ", fourth", ", fifth", ", sixth"};
  const Stage stage = kTracks[track];
  const auto first = static_cast<std::size_t>(std::ranges::find(kTracks, stage) - kTracks.begin());
  const char* const part = stage != Stage::memory ? kNumbers[track - first] : track == first ? ", depth" : ", colour";
  return std::string(info(stage).name) + part;
}

std::string tile_text(int x, int y) { return "tile (" + std::to_string(x) + ", " + std::to_string(y) + ")"; }

/// `value`: JSON.
std::string metadata(const std::string& what, int track, const std::string& key, const std::string& value) {
  return "{\"name\":\"" + what + "\",\"ph\":\"M\",\"pid\":1,\"tid\":" + std::to_string(track) + ",\"args\":{\"" + key +
         "\":" + value + "}}";
}

}  // namespace

Timeline::Timeline(const std::string& title)
    : text_("{\"displayTimeUnit\":\"ms\",\"otherData\":{\"unit\":\"1 us is 1 cycle\"},\"traceEvents\":[\n") {
  text_ += metadata("process_name", 0, "name", title);
  for (std::size_t i = 0; i < kTracks.size(); ++i) {
    const int track = static_cast<int>(i);
    add_track(track, kOrder * track, track_name(i));
  }
}

void Timeline::add_track(int track, int order, const std::string& name) {
  text_ += ",\n" + metadata("thread_name", track, "name", "\"" + name + "\"");
  text_ += ",\n" + metadata("thread_sort_index", track, "sort_index", std::to_string(order));
}

void Timeline::slice(int track, const std::string& name, Cycle from, Cycle to) {
  if (to <= from) return;
  text_ += ",\n{\"name\":\"" + name + "\",\"ph\":\"X\",\"ts\":" + std::to_string(from) +
           ",\"dur\":" + std::to_string(to - from) + ",\"pid\":1,\"tid\":" + std::to_string(track) + "}";
}

void Timeline::slice_in(std::vector<Lane>& lanes, Cycle from, Cycle to) {
  auto lane = std::find_if(lanes.begin(), lanes.end(), [&](const Lane& free) { return free.end <= from; });
  if (lane == lanes.end()) {
    const Stage stage = kTracks[static_cast<std::size_t>(lanes.front().track)];
    lane = lanes.insert(lanes.end(), {tracks_++, 0, lanes.back().order + 1});
    add_track(lane->track, lane->order, std::string(info(stage).name) + ", number " + std::to_string(lanes.size()));
  }
  slice(lane->track, name_, from, to);
  lane->end = to;
}

void Timeline::primitive(const HostPrimitive& primitive) {
  end_primitive();
  name_ = kind_name(primitive.packet.kind);
  if (is_counted(primitive.packet.kind)) name_ += " " + std::to_string(primitive.primitive);
}

void Timeline::visit(int tile_x, int tile_y) { next_tile_name_ = name_ + ", " + tile_text(tile_x, tile_y); }

void Timeline::transfer(Arrow boundary, Cycle cycle) {
  switch (boundary) {
    case Arrow::primitive: taken_ = cycle; break;
    case Arrow::triangle:
      slice_in(cull_lanes_, taken_, cycle);
      triangle_ = cycle;
      break;
    case Arrow::setup: {
      const Cycle from = std::min(triangle_, cycle);  // serial: the triangle leaves with its setup
      slice_in(setup_lanes_, from, cycle);
      has_setup_ = true;
      setup_ = last_tile_ = cycle;
      break;
    }
    case Arrow::tile: {
      const bool is_serial = has_stamps_ && !has_tile_;  // there a tile moves together with its last stamp
      end_tile(cycle);
      tile_name_ = next_tile_name_.empty() ? name_ + ", end" : std::exchange(next_tile_name_, {});
      if (is_serial) slice(fine, tile_name_, first_stamp_, cycle + 1);
      has_tile_ = !is_serial;
      has_stamps_ = false;
      tile_ = last_tile_ = cycle;
      break;
    }
    case Arrow::stamp:
      if (!has_stamps_) first_stamp_ = cycle;
      has_stamps_ = true;
      last_stamp_ = cycle;
      break;
    case Arrow::line:
      has_line_ = true;
      line_ = cycle;
      break;
    case Arrow::line_pixel: last_pixel_ = cycle; break;
    case Arrow::fragment:
      if (!has_fragments_) first_fragment_ = cycle;
      has_fragments_ = true;
      last_fragment_ = cycle;
      break;
    case Arrow::retire: end_visit(); break;
    default: break;
  }
}

void Timeline::end_tile(Cycle limit) {
  if (has_tile_) slice(fine, tile_name_, tile_, std::min(limit, last_stamp_ + 1));
  has_tile_ = false;
}

void Timeline::end_visit() {
  if (has_fragments_) slice(depth, tile_name_.empty() ? name_ : tile_name_, first_fragment_, last_fragment_ + 1);
  has_fragments_ = false;
}

void Timeline::end_primitive() {
  end_visit();
  if (has_setup_) slice_in(coarse_lanes_, setup_, std::max(last_tile_, setup_ + 1));
  if (has_line_) slice(lines, name_, line_ + 1, last_pixel_ + 1);
  has_setup_ = has_line_ = false;
}

void Timeline::move(MoveCause cause, bool is_color, int tile_x, int tile_y, Cycle from, Cycle to) {
  slice(is_color ? memory_color : memory_depth,
        std::string(kMoveCauses[static_cast<std::size_t>(cause)]) + " " + tile_text(tile_x, tile_y), from, to);
}

void Timeline::wait(Cycle from, Cycle to) { slice(framebuffer, name_, from, to); }

const std::string& Timeline::finish() {
  end_primitive();
  end_tile(~Cycle{0});
  text_ += "\n]}\n";
  return text_;
}

}  // namespace halfplane
