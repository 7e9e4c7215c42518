#include "frame_bins.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "../packets/packet_words.hpp"
#include "../stages/edge_function.hpp"

namespace halfplane {
namespace {

constexpr std::uint64_t kFewSamples = 16;  ///< up to which every sample is tested

PixelBounds intersection(const PixelBounds& a, const PixelBounds& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

/// Whether a triangle of positive area may cover a sample of `box`: exact for a small box and one sample per pixel,
/// otherwise by the corner farthest inside each edge.
bool touches(const std::array<SnappedVertex, 3>& v, const PixelBounds& box, const Widths& widths) {
  const auto edge = [&](std::size_t i, int x, int y) {
    return edge_function(v[i], v[(i + 1) % 3], x, y, widths.grid_bits);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    const EdgeValue reach =
        widths.has_samples != 0 ? sample_edge_reach(EdgeValue{to.x} - from.x, EdgeValue{to.y} - from.y) : 0;
    if (edge(i, to.y < from.y ? box.right : box.left, to.x > from.x ? box.bottom : box.top) + reach < 0) return false;
  }
  if (box.samples() > kFewSamples || widths.has_samples != 0) return true;
  for (int y = box.top; y <= box.bottom; ++y)
    for (int x = box.left; x <= box.right; ++x)
      if (edge(0, x, y) >= 0 && edge(1, x, y) >= 0 && edge(2, x, y) >= 0) return true;
  return false;
}

std::optional<LineSetup> setup_in(const WholeLine& line, const PixelBounds& bin, const Widths& widths) {
  return setup_line(line.start, line.end, line.rule, line.drops_last, intersection(line.limit, bin), widths);
}

/// Pixels that the line may cover, with one more on each side for the line rule.
PixelBounds bounds_of(const WholeLine& line, int grid_bits) {
  const auto [left, right] = std::minmax({line.start.x >> grid_bits, line.end.x >> grid_bits});
  const auto [top, bottom] = std::minmax({line.start.y >> grid_bits, line.end.y >> grid_bits});
  return intersection({left - 1, top - 1, right + 1, bottom + 1}, line.limit);
}

}  // namespace

FrameBins::FrameBins(const Widths& widths, int width, int height, std::optional<FrameClears> compares)
    : widths_(widths), target_width_(width), target_height_(height), compares_(compares) {
  const int block = (1 << widths.tile_shift) / widths.blocks.per_tile;  // pixels along its side
  width_ = block << widths.line_x_bits;
  height_ = block << widths.line_y_bits;
  const auto count = [](int pixels, int of_bin) { return static_cast<std::size_t>((pixels + of_bin - 1) / of_bin); };
  columns_ = count(width, width_);
  bin_.resize(columns_ * count(height, height_));
}

bool FrameBins::has_whole_tiles(const Widths& widths) {
  return 1 << std::min(widths.line_x_bits, widths.line_y_bits) >= widths.blocks.per_tile;
}

PixelBounds FrameBins::box_of(std::size_t bin) const {
  const int left = static_cast<int>(bin % columns_) * width_, top = static_cast<int>(bin / columns_) * height_;
  return {left, top, left + width_ - 1, top + height_ - 1};
}

/// Adds the next item to those bins of `box` for which touches(bounds) is true. Returns whether there is one.
template <class Touches>
bool FrameBins::add_to_bins(const PixelBounds& box, Touches&& touches) {
  bool is_seen = false;
  for (int y = box.top / height_; y <= box.bottom / height_; ++y)
    for (int x = box.left / width_; x <= box.right / width_; ++x) {
      const std::size_t bin = static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x);
      if (!touches(box_of(bin))) continue;
      bin_[bin].push_back(static_cast<std::uint32_t>(items_.size()));
      is_seen = true;
    }
  return is_seen;
}

bool FrameBins::add(const HostPrimitive& primitive) {
  const PrimitivePacket& packet = primitive.packet;
  bool is_seen = false;
  if (packet.kind == PrimitiveKind::triangle) {
    auto v = to_snapped(packet.vertex);
    v = canonical(v, signed_area(v[0], v[1], v[2]));
    const PixelBounds box = sample_bounds(v, to_bounds(packet.box), widths_.grid_bits, widths_.pixel_samples);
    is_seen = add_to_bins(box, [&](const PixelBounds& bin) { return touches(v, intersection(box, bin), widths_); });
  } else {
    is_seen = add_to_bins(to_bounds(packet.box), [](const PixelBounds&) { return true; });
  }
  if (is_seen)
    items_.push_back(
        {packet, primitive.primitive, primitive.command, kNoLine, primitive.units, signature_of(primitive, nullptr)});
  return is_seen;
}

void FrameBins::add(const HostPrimitive& primitive, const WholeLine& line) {
  add_to_bins(bounds_of(line, widths_.grid_bits),
              [&](const PixelBounds& bin) { return setup_in(line, bin, widths_).has_value(); });
  items_.push_back({primitive.packet, primitive.primitive, primitive.command, static_cast<std::uint32_t>(lines_.size()),
                    primitive.units, signature_of(primitive, &line)});
  lines_.push_back(line);
}

/// Everything that the pixels of a primitive depend on. Not its number.
Signature FrameBins::signature_of(const HostPrimitive& primitive, const WholeLine* line) {
  if (!compares_) return {};
  SignatureHash hash;
  PrimitivePacket packet = primitive.packet;
  packet.primitive_id = 0;
  for_each_value(std::as_const(packet), widths_,
                 [&hash](const auto& value, const Width&) { hash.add(to_bits(value)); });
  units_.add(primitive.units, hash);
  if (line != nullptr) {
    for (const SnappedVertex* v : {&line->start, &line->end}) {
      hash.add(static_cast<std::uint64_t>(v->x));
      hash.add(static_cast<std::uint64_t>(v->y));
      for (const std::uint32_t code : v->code) hash.add(code);
    }
    hash.add(static_cast<std::uint64_t>(line->rule));
    hash.add(line->drops_last);
    for (const int side : {line->limit.left, line->limit.top, line->limit.right, line->limit.bottom})
      hash.add(static_cast<std::uint64_t>(side));
  }
  return hash.signature();
}

/// Lower bound of the cycles to draw a bin: its primitives and half of the stamps of their boxes; and where clears are
/// resolved about its stamps.
std::uint64_t FrameBins::least_cycles(std::size_t bin) const {
  constexpr std::uint64_t kSetup = 4;  // cycles from one primitive to the next
  const auto stamps = [this](const PixelBounds& box) {
    return box.samples() / static_cast<std::uint64_t>(widths_.pixels);
  };
  const PixelBounds bounds = box_of(bin);
  std::uint64_t cycles = 0;
  for (const std::uint32_t item : bin_[bin]) {
    const PrimitivePacket& packet = items_[item].packet;
    PixelBounds box = intersection(to_bounds(packet.box), bounds);
    if (packet.kind == PrimitiveKind::triangle)
      box = sample_bounds(to_snapped(packet.vertex), box, widths_.grid_bits, widths_.pixel_samples);
    cycles += kSetup + stamps(box) / 2;
  }
  return compares_ == FrameClears::resolve ? std::max(cycles, stamps(bounds) / 2) : cycles;
}

/// The savings are weighed against a clear of each drawn bin, and a walk over the cache lines before these clears.
void FrameBins::leave_out_equal(BinContents& held, const Signature& clears) {
  std::vector<Signature> now;
  now.reserve(bin_.size());
  for (const auto& bin : bin_) {
    SignatureHash hash;
    hash.add(clears);
    for (const std::uint32_t item : bin) hash.add(items_[item].signature);
    now.push_back(hash.signature());
  }
  const bool is_known = held.width == target_width_ && held.height == target_height_ && held.bin.size() == now.size();
  constexpr std::uint64_t kToken = 16;  // a token finds nothing under way after this many cycles
  const int words = ((1 << widths_.line_x_bits) - 1) / widths_.blocks.flag_word + 1;
  const std::uint64_t clear = kToken + 2 * static_cast<std::uint64_t>(words << widths_.line_y_bits);
  std::uint64_t saved = 0, cost = kToken + (std::uint64_t{1} << (widths_.line_x_bits + widths_.line_y_bits));
  std::size_t equal = 0;
  for (std::size_t n = 0; is_known && n < now.size(); ++n) {
    if (now[n] != held.bin[n]) {
      cost += clear;
    } else if (!bin_[n].empty()) {
      ++equal;
      saved += least_cycles(n);
    }
  }
  if (equal > 0 && saved > cost) {
    left_out_ += equal;
    const PixelBounds target{0, 0, target_width_ - 1, target_height_ - 1};
    cleared_.emplace();
    for (std::size_t n = 0; n < now.size(); ++n) {
      if (now[n] == held.bin[n])
        bin_[n].clear();
      else
        cleared_->push_back(intersection(box_of(n), target));
    }
  }
  held = {target_width_, target_height_, std::move(now)};
}

bool FrameBins::has_next() const {
  return is_closed_ && std::ranges::any_of(bin_, [](const auto& bin) { return !bin.empty(); });
}

void FrameBins::close(bool drops_depth, BinContents* held, const Signature& clears) {
  is_closed_ = true;
  cleared_.reset();
  bin_next_ = item_next_ = 0;
  const auto is_unseen = [&](std::uint32_t item) {  // a clear of depths after all reads of them
    const PrimitivePacket& packet = items_[item].packet;
    return drops_depth && packet.kind == PrimitiveKind::rectangle && !packet.state.color_write;
  };
  for (auto& bin : bin_)
    while (!bin.empty() && is_unseen(bin.back())) bin.pop_back();
  if (held != nullptr) leave_out_equal(*held, clears);
  for (const auto& bin : bin_) {
    bins_ += bin.empty() ? 0 : 1;
    pairs_ += static_cast<std::uint64_t>(
        std::ranges::count_if(bin, [&](std::uint32_t item) { return is_counted(items_[item].packet.kind); }));
  }
}

std::optional<HostPrimitive> FrameBins::next() {
  if (!is_closed_) return std::nullopt;
  for (; bin_next_ < bin_.size(); ++bin_next_, item_next_ = 0)
    if (item_next_ < bin_[bin_next_].size()) return part(items_[bin_[bin_next_][item_next_++]], box_of(bin_next_));
  is_closed_ = false;
  for (auto& bin : bin_) bin.clear();
  items_.clear();
  lines_.clear();
  return std::nullopt;
}

HostPrimitive FrameBins::part(const Item& item, const PixelBounds& bin) const {
  HostPrimitive out{item.packet, {}, item.primitive, item.command, true, item.units};
  if (item.line == kNoLine) {
    out.packet.box = to_box(intersection(to_bounds(item.packet.box), bin));
    return out;
  }
  out.line = setup_in(lines_[item.line], bin, widths_);
  out.line->primitive_id = item.packet.primitive_id;
  const auto x = static_cast<std::uint16_t>(out.line->x), y = static_cast<std::uint16_t>(out.line->y);
  out.packet.box = {x, y, x, y};
  return out;
}

}  // namespace halfplane
