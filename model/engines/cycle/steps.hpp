// What the bits of a frame hand to its times: each primitive, step of a walk, tile visit, stamp and token, in program
// order. That order does not depend on time, so the bits may be ahead, or on another thread (step_queue.hpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../../packets/packets.hpp"
#include "../../stages/clear_flags.hpp"
#include "../../stages/cull.hpp"
#include "block_timing.hpp"
#include "work.hpp"

namespace halfplane {

enum class StepKind : std::uint8_t {
  take,        ///< cull takes the next of Steps::primitives
  outside,     ///< the walk skips `count` tiles outside an edge
  behind,      ///< the bound of the next tile, and that the tile is behind it
  end_walk,    ///< the primitive ends without a visit
  visit,       ///< the next of Steps::visits, with the next `count` of Steps::stamps
  lane_visit,  ///< the same with Steps::lane_stamps, and the next of Steps::lane_rows for each row of stamps in its box
  line_pixels,  ///< the next `count` of Steps::stamps are the pixels of a line
  set_tags,     ///< the next of Steps::tags
  set_state,    ///< a token in the shading units; with a texture unit the next of Steps::textures
  clear,        ///< a fast clear of the next of Steps::areas
  flush         ///< a flush of the next of Steps::areas
};

struct PrimitiveStep {
  PrimitiveWork work;
  PrimitiveState state;  ///< downstream of cull
};

struct VisitStep {
  std::uint16_t tile_x = 0, tile_y = 0;
  TileBox box;
  bool ends_primitive = false;
};

/// A stamp in the framebuffer. Without covered samples it passes.
struct StampStep {
  BlockItem item;
  StampAddress at;
  std::uint8_t pixel = 0;  ///< of a line: its number in the stamp
  bool is_dirty = false;   ///< for a cache of tiles: some sample may have been written
  SampleMask even;         ///< with compress.unit: pixels that are stored with one colour in all samples
};

/// A stamp with covered samples that was drawn in lanes (stamp_lanes.hpp): the rest of its StampStep is the primitive's.
struct LaneStamp {
  std::uint16_t stamp = 0;
  std::uint8_t covered = 0, passed = 0;
};

/// Items of a batch, in the memory of the batch before.
template <class Item>
class StepItems {
 public:
  void add_item(const Item& item) {
    *room(1) = item;
    ++size_;
  }
  /// Room for `most` items more; add() says how many were written.
  [[nodiscard]] Item* room(std::size_t most) {
    if (room_ < size_ + most) grow(most);
    return items_.data() + size_;
  }
  void add(std::size_t items) { size_ += items; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Item* data() const { return items_.data(); }
  [[nodiscard]] std::span<const Item> items() const { return {items_.data(), size_}; }
  [[nodiscard]] Item& last() { return items_[size_ - 1]; }
  void clear() { size_ = 0; }

 private:
  [[gnu::noinline]] void grow(std::size_t most) {
    room_ = 2 * (size_ + most);
    items_.resize(room_);
  }

  std::vector<Item> items_;
  std::size_t size_ = 0, room_ = 0;  ///< room_: items_.size(), whose division by an item's size is asked for often
};

/// Arguments of CacheTags::set().
struct TagsStep {
  bool reads_color = false, tests_alpha = false;
  std::array<bool, 2> replaces_stencil{};
};

/// The last tile of a token, and for a fast clear the groups of tiles whose bounds it sets.
struct AreaStep {
  int last_x = 0, last_y = 0;
  std::uint64_t bounds = 0;
  PixelBounds box;  ///< in pixels
};

struct TextureStep {
  TextureWork work;           ///< without its lookups
  std::uint32_t lookups = 0;  ///< the next of Steps::lookups
};

/// A batch of steps.
struct Steps {
  struct Step {
    StepKind kind;
    bool reads_bound = false;  ///< of a visit: the bound of its tile has been read
    std::uint32_t count = 1;
  };
  StepItems<Step> order;
  StepItems<PrimitiveStep> primitives;
  StepItems<VisitStep> visits;
  StepItems<StampStep> stamps;
  StepItems<LaneStamp> lane_stamps;
  StepItems<std::uint8_t> lane_rows;  ///< the number of a row's lane stamps
  std::vector<TagsStep> tags;
  std::vector<AreaStep> areas;
  std::vector<TextureStep> textures;  ///< with a texture unit: one for each stamp with covered samples, and each token
  std::vector<TextureLookup> lookups;

  void add(StepKind kind, std::size_t count = 1, bool reads_bound = false) {
    order.add_item({kind, reads_bound, static_cast<std::uint32_t>(count)});
  }
  void add_outside() {
    if (order.size() != 0 && order.last().kind == StepKind::outside)
      ++order.last().count;
    else
      add(StepKind::outside);
  }
  /// Long enough to be worth a hand-over between threads, and short enough for one batch to stay in a second-level cache.
  [[nodiscard]] bool is_full() const { return stamps.size() + lane_stamps.size() >= 1024 || order.size() >= 4096; }
  void clear() {
    order.clear();
    primitives.clear();
    visits.clear();
    stamps.clear();
    lane_stamps.clear();
    lane_rows.clear();
    tags.clear();
    areas.clear();
    textures.clear();
    lookups.clear();
  }
};

}  // namespace halfplane
