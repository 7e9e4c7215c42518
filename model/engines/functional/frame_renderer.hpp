// The functional engine's fast path: a frame's commands become slices, slices become bin lists, bins become pixels.
#pragma once

#include <tbb/task_arena.h>

#include <deque>
#include <memory>

#include "../render.hpp"
#include "kernels.hpp"

namespace halfplane::functional {

/// Whether the fast path supports the scene, which is valid, the configuration and the options.
[[nodiscard]] bool is_supported(const Scene& scene, const Config& config, const RenderOptions& options);

/// Renders frames; reuses its memory from frame to frame.
class FrameRenderer {
 public:
  explicit FrameRenderer(const Config& config);

  /// Precondition: is_supported(). The result lives until the next call. Not inlined: tools/instructions.py counts what is in it.
  [[nodiscard, gnu::noinline]] const Rendering& render(const PreparedScene& prepared, const RenderOptions& options);

  /// Moves the last result out: the next frame allocates its own memory.
  [[nodiscard]] Rendering take();

 private:
  void start(const PreparedScene& prepared, const RenderOptions& options);
  void run_commands(const RenderOptions& options);
  void find_tiles();
  void need_samples();
  /// The image of the pixels, and the images of their samples.
  template <class Visit>
  void for_each_image(Visit&& visit) {
    visit(rendering_.frame);
    for (Framebuffer& sample : rendering_.frame.samples) visit(sample);
  }
  void forget_tiles();
  void forget_depths(std::size_t first, std::size_t count);
  void clear(const Clear& command);
  void clear_whole(const Clear& command);
  void draw(std::uint32_t command);
  void draw_prepared(std::uint32_t command);
  [[nodiscard]] static std::array<WindowPosition, 2> ends_of_box(const DrawContext& context,
                                                                 const PreparedScene::DrawChunks& draw);
  [[nodiscard]] bool is_uncut(const DrawContext& context, const PreparedScene::DrawChunks& draw) const;
  [[nodiscard]] bool is_in_view(const DrawContext& context, const PreparedScene::DrawChunks& draw) const;
  [[nodiscard]] bool is_behind(const DrawContext& context, const PreparedScene::DrawChunks& draw) const;
  void draw_outlines(const DrawContext& context);
  void flush(bool is_last = false);
  void settle(const Rect& rect);
  void finish();

  Slice& add_slice(const DrawContext& context);
  void build(Slice& slice) const;
  void build_outlines(Slice& slice) const;
  void sign(Slice& slice) const;
  [[nodiscard]] bool compares(const RenderOptions& options) const;
  [[nodiscard]] Signature signature_of_bin(std::size_t bin, const std::vector<const Slice*>& slices) const;
  void fill_bins(Slice& slice) const;
  void fill_bins(Slice& slice, std::span<const Dot> dots) const;

  /// A depth in the precision of tile ranges.
  [[nodiscard]] std::uint16_t range_of(std::uint32_t code) const {
    return static_cast<std::uint16_t>(code >> range_drop(config_));
  }

  Config given_;   ///< as passed in
  Config config_;  ///< extended for the scene: with_alpha()
  Widths widths_;
  const Kernels* kernels_ = nullptr;
  const PreparedScene* prepared_ = nullptr;
  const Scene* scene_ = nullptr;
  Skip skip_;
  bool is_opaque_ = true;  ///< SliceState::is_opaque of every draw
  int threads_ = 1;
  std::unique_ptr<tbb::task_arena>
      arena_;  ///< for more than one thread; kept, because every part of a frame would wait for a new one
  int bins_x_ = 0, bins_y_ = 0;
  Rendering rendering_;
  bool keeps_samples_ = true;               ///< Framebuffer::samples is read after the frame
  std::vector<Framebuffer> spare_samples_;  ///< if not: reused for the next frame
  TileStates tiles_;
  std::vector<std::uint8_t> is_in_target_;  ///< by tile: all bits or none
  std::uint32_t clear_depth_ = 0, clear_color_ = 0;
  std::uint32_t held_depth_ = 0, held_color_ = 0;  ///< the clear of TileStates::held
  std::deque<DrawContext> contexts_;
  std::deque<Slice> slices_;
  std::size_t slice_count_ = 0, pending_primitives_ = 0;
  bool pending_rises_ = false;  ///< pending draws may raise a stored depth
  bool has_flushed_ = false;    ///< since the last clear
  bool is_stencil_zero_ = true;
  Slice* open_ = nullptr;  ///< accepts further triangles of its state
  std::uint32_t open_state_ = 0;
  std::uint32_t primitive_ = 0;
  std::size_t entries_done_ = 0;
  std::vector<Counters> bin_counters_;
  bool compares_ = false;             ///< compares bins with the previous frame's
  std::vector<Signature> held_bins_;  ///< content of each bin of the frame; empty: unknown
  std::vector<Signature> texels_;     ///< of each texture, where bins are compared
};

}  // namespace halfplane::functional
