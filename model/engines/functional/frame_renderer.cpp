#include "frame_renderer.hpp"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "../../stages/surface.hpp"

namespace halfplane::functional {
namespace {

constexpr std::size_t kSlicePrimitives = 2048;  // small enough that two threads share a small frame evenly
constexpr std::size_t kBatchPrimitives = 1 << 18;
constexpr std::size_t kTiles = std::size_t{kBinTiles} * kBinTiles;  // in a bin

/// The range of a tile that holds no depth: it never decides.
constexpr struct { std::uint16_t low = 0xffff, high = 0; } kNoDepth;

using Clock = std::chrono::steady_clock;

/// Calls work(i) for 0 <= i < count. Throws the exception of the smallest i, whichever thread ran it.
template <class Work>
void for_each_index(tbb::task_arena* threads, std::size_t count, Work&& work) {
  if (threads == nullptr || count < 2) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::vector<std::exception_ptr> errors(count);
  threads->execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) try {
              work(i);
            } catch (...) {
              errors[i] = std::current_exception();
            }
        },
        tbb::simple_partitioner());
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

void add(Counters& sum, const Counters& c) {
  sum.primitives_in += c.primitives_in;
  sum.culled += c.culled;
  sum.drawn += c.drawn;
  sum.clipped += c.clipped;
  sum.covered += c.covered;
  sum.depth_passed += c.depth_passed;
  sum.alpha_killed += c.alpha_killed;
  sum.written += c.written;
  sum.samples_tested += c.samples_tested;
  sum.tiles_visited += c.tiles_visited;
  for (const SkipName& one : kSkipNames) sum.skipped.*one.counter += c.skipped.*one.counter;
}

/// Whether the fast path takes all surfaces: opaque, and every w > 0 of those in window coordinates. The scalar engine
/// reports refused triangles.
bool has_plain_surfaces(const Scene& scene, const RenderOptions& options) {
  if (options.general_fragments) return false;
  const auto is_in_front = [&scene](std::uint32_t index) { return index == kRestart || scene.vertices[index].w > 0; };
  return std::ranges::all_of(scene.commands, [&](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr || !has_surface(scene.states[draw->state]) || scene.states[draw->state].space != Space::window)
      return true;
    return std::ranges::all_of(std::span(scene.indices).subspan(draw->first, draw->count), is_in_front);
  });
}

/// Whether the fast path takes multisampled pixels: triangles and points, no stencil, no alpha that selects samples.
/// Edges move to a sample in 32 bits.
bool has_plain_samples(const Scene& scene, const Widths& widths, const RenderOptions& options) {
  if (options.general_fragments || widths.delta.bits + widths.grid_bits > 31) return false;
  if (std::ranges::any_of(scene.states, [](const State& s) { return s.stencil || s.alpha_to_coverage; })) return false;
  return std::ranges::none_of(scene.commands, [&scene](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && drawn_as(scene.states[draw->state], draw->topology) == PrimitiveType::line;
  });
}

}  // namespace

bool is_supported(const Scene& scene, const Config& config, const RenderOptions& options) {
  if (options.want_count || options.want_ids || options.keeps_triangles() || options.pixel_tap) return false;
  if (options.rules != StudyRules{} || config.tile_size != kTileSize) return false;
  if (std::ranges::any_of(scene.states, has_surface) && !has_plain_surfaces(scene, options)) return false;
  const Widths widths = derive_widths(config);
  if (widths.has_samples != 0 && !has_plain_samples(scene, widths, options)) return false;
  // Lanes of 32 bits for values in a tile, of 64 for planes; area and edges as the kernels compute them.
  return widths.depth().local.bits <= 32 && widths.color().local.bits <= 16 && config.depth_bits <= 30 &&
         widths.delta.bits <= 24 && widths.color().product.bits <= 64 && widths.color().line.bits <= 31 &&
         widths.reciprocal.bits <= 30 && DepthEncode(config, scene.planes).is_identity();
}

FrameRenderer::FrameRenderer(const Config& config) : given_(config), config_(config), widths_(derive_widths(config)) {}

const Rendering& FrameRenderer::render(const PreparedScene& prepared, const RenderOptions& options) {
  start(prepared, options);
  try {
    run_commands(options);
  } catch (...) {  // the frame is whole in any case: later draws may go on it
    slice_count_ = 0;
    held_bins_.clear();
    finish();
    throw;
  }
  finish();
  return rendering_;
}

void FrameRenderer::run_commands(const RenderOptions& options) {
  const Scene& scene = *scene_;
  auto last_report = Clock::now();
  for (std::size_t i = 0; i < scene.commands.size(); ++i) {
    if (const auto* command = std::get_if<Clear>(&scene.commands[i])) clear(*command);
    if (std::holds_alternative<Draw>(scene.commands[i])) draw(static_cast<std::uint32_t>(i));
    if (pending_primitives_ >= kBatchPrimitives && !compares_) flush();
    if (options.progress && std::chrono::duration<double>(Clock::now() - last_report).count() > 0.1) {
      last_report = Clock::now();
      options.progress(static_cast<double>(entries_done_) /
                       static_cast<double>(std::max<std::size_t>(1, scene.indices.size())));
    }
  }
  flush(true);
}

Rendering FrameRenderer::take() {
  held_bins_.clear();
  return std::exchange(rendering_, {});
}

/// Whether all events in a bin are a pending clear, and then draws that are all drawn together.
bool FrameRenderer::compares(const RenderOptions& options) const {
  if (keeps_samples_ && widths_.has_samples != 0) return false;
  if (!options.follows || !skip_.bins || !skip_.clear || options.onto != nullptr || !is_stencil_zero_) return false;
  if (std::ranges::any_of(scene_->states, [](const State& s) { return s.stencil.has_value(); })) return false;
  std::size_t primitives = 0;  // all of them are pending together
  for (const PreparedScene::DrawChunks& draw : prepared_->draws) primitives += draw.primitives;
  if (primitives > 4 * kBatchPrimitives) return false;
  bool has_drawn = false;
  for (const Command& command : scene_->commands) {
    const auto* clear = std::get_if<Clear>(&command);
    has_drawn |= clear == nullptr;
    if (clear == nullptr) continue;
    if (has_drawn || clear->stencil || clear_rect(*scene_, *clear) != Rect{0, 0, scene_->width, scene_->height})
      return false;
  }
  return true;
}

void FrameRenderer::start(const PreparedScene& prepared, const RenderOptions& options) {
  const Scene& scene = prepared.scene();
  if (const Config wanted = with_alpha(given_, scene); wanted.alpha_units != config_.alpha_units) {
    config_ = wanted;
    widths_ = derive_widths(config_);
  }
  check_fits(scene, config_);
  check_onto(scene, config_, options);
  prepared_ = &prepared;
  scene_ = &scene;
  skip_ = options.skip;
  is_opaque_ = !options.general_fragments;
  if (options.threads != threads_) {
    threads_ = options.threads;
    const int most = tbb::info::default_concurrency();  // the library warns above this
    arena_ = threads_ > 1 ? std::make_unique<tbb::task_arena>(std::min(threads_, most)) : nullptr;
  }
  kernels_ = available_kernels().front();
  for (const Kernels* kernels : available_kernels())
    if (options.instruction_set == kernels->name) kernels_ = kernels;
  Framebuffer& frame = rendering_.frame;
  const bool is_new = frame.width != scene.width || frame.height != scene.height;
  if (is_new) {
    frame = Framebuffer(scene.width, scene.height, config_.tile_size);
    spare_samples_.clear();
  }
  if (frame.samples.empty()) frame.samples.swap(spare_samples_);
  keeps_samples_ = !options.resolved_only || options.onto != nullptr;
  if (keeps_samples_) need_samples();
  rendering_.sample_owners.assign(widths_.has_samples != 0 ? static_cast<std::size_t>(widths_.pixel_samples) : 0, {});
  is_stencil_zero_ |= is_new;
  rendering_.counters = {};
  rendering_.geometry_s = rendering_.raster_s = 0;
  bins_x_ = (scene.width + kBinSize - 1) / kBinSize;
  bins_y_ = (scene.height + kBinSize - 1) / kBinSize;
  const auto tiles = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_) * kBinTiles * kBinTiles;
  tiles_.z_low.resize(tiles);
  tiles_.z_high.resize(tiles);
  if (is_new || options.onto == nullptr) tiles_.pending.assign(tiles, 0);
  if (is_new || !skip_.clear) tiles_.held.assign(tiles, 0);
  if (is_new) find_tiles();
  contexts_.clear();
  slice_count_ = pending_primitives_ = 0;
  pending_rises_ = has_flushed_ = false;
  open_ = nullptr;
  primitive_ = 0;
  entries_done_ = 0;
  compares_ = compares(options);
  if (is_new || !compares_) held_bins_.clear();
  texels_.clear();
  if (compares_)
    for (const Texture& texture : scene.textures) texels_.push_back(signature_of(texture));
  if (options.onto == nullptr) {
    clear_whole(Clear{0, std::array<double, 4>{0, 0, 0, 255}, 1.0,
                      is_stencil_zero_ ? std::nullopt : std::optional(std::uint8_t{0})});
  } else if (options.onto != &frame) {
    frame = *options.onto;
    is_stencil_zero_ = false;
    forget_tiles();
  }
}

/// Makes the images of the samples when they are first needed.
void FrameRenderer::need_samples() {
  Framebuffer& frame = rendering_.frame;
  if (widths_.has_samples == 0 || !frame.samples.empty()) return;
  frame.samples.assign(static_cast<std::size_t>(widths_.pixel_samples),
                       Framebuffer(frame.width, frame.height, config_.tile_size));
}

/// Marks the depth range of every tile as unknown.
void FrameRenderer::forget_tiles() {
  std::ranges::fill(tiles_.pending, std::uint8_t{0});
  std::ranges::fill(tiles_.held, std::uint8_t{0});
  forget_depths(0, is_in_target_.size());
}

void FrameRenderer::forget_depths(std::size_t first, std::size_t count) {
  const std::uint16_t largest = range_of((std::uint32_t{1} << config_.depth_bits) - 1);
  for (std::size_t i = first; i < first + count; ++i) {
    tiles_.z_low[i] = is_in_target_[i] != 0 ? std::uint16_t{0} : kNoDepth.low;
    tiles_.z_high[i] = is_in_target_[i] != 0 ? largest : kNoDepth.high;
  }
}

/// Finds the tiles of each bin that lie in the target. The others hold no depth: their ranges never decide.
void FrameRenderer::find_tiles() {
  is_in_target_.resize(tiles_.pending.size());
  for (std::size_t i = 0; i < is_in_target_.size(); ++i) {
    const auto bin = static_cast<int>(i) / (kBinTiles * kBinTiles),
               tile = static_cast<int>(i) % (kBinTiles * kBinTiles);
    const int x = bin % bins_x_ * kBinSize + tile % kBinTiles * kTileSize,
              y = bin / bins_x_ * kBinSize + tile / kBinTiles * kTileSize;
    is_in_target_[i] = x < scene_->width && y < scene_->height ? 0xff : 0;
    tiles_.z_low[i] = kNoDepth.low;
    tiles_.z_high[i] = kNoDepth.high;
  }
}

// --- clears -----------------------------------------------------------------------------------------------------------

void FrameRenderer::clear_whole(const Clear& command) {
  const auto started = Clock::now();
  has_flushed_ = false;
  std::uint8_t bits = 0;
  if (command.stencil) {
    for_each_image([&command](Framebuffer& image) {  // not the padding
      for (int y = 0; y < image.height; ++y)
        std::fill_n(image.stencil.begin() + static_cast<std::ptrdiff_t>(image.at(0, y)), image.width, *command.stencil);
    });
    is_stencil_zero_ = *command.stencil == 0;
  }
  if (command.depth) {
    bits |= TileStates::kDepthCleared;
    clear_depth_ = DepthEncode(config_, scene_->planes).of_window(*command.depth);
  }
  if (command.color) {
    bits |= TileStates::kColorCleared;
    clear_color_ = clear_color(*command.color, config_.color_format);
  }
  // Loops that the compiler vectorises: their stores cannot alias their pointers.
  const std::size_t tiles = is_in_target_.size();
  const std::uint8_t* const is_in = is_in_target_.data();
  std::uint8_t* const pending = tiles_.pending.data();
  std::uint32_t again = 0;  // the clear before
  for (std::size_t i = 0; i < tiles; ++i) again += (pending[i] & bits) != 0 ? 1U : 0U;
  rendering_.counters.skipped.clear += again;
  for (std::size_t i = 0; i < tiles; ++i) pending[i] = static_cast<std::uint8_t>(pending[i] | (is_in[i] & bits));
  if (command.depth) {
    const std::uint16_t code = range_of(clear_depth_);
    std::uint16_t *const low = tiles_.z_low.data(), *const high = tiles_.z_high.data();
    for (std::size_t i = 0; i < tiles; ++i) low[i] = is_in[i] != 0 ? code : kNoDepth.low;
    for (std::size_t i = 0; i < tiles; ++i) high[i] = is_in[i] != 0 ? code : kNoDepth.high;
  }
  rendering_.raster_s += std::chrono::duration<double>(Clock::now() - started).count();
  if (!skip_.clear) settle({0, 0, scene_->width, scene_->height});
}

void FrameRenderer::clear(const Clear& command) {
  flush();
  const Rect rect = clear_rect(*scene_, command);
  if (rect.width <= 0 || rect.height <= 0) return;
  if (rect == Rect{0, 0, scene_->width, scene_->height}) return clear_whole(command);
  need_samples();
  settle(rect);
  is_stencil_zero_ = is_stencil_zero_ && command.stencil.value_or(0) == 0;
  std::ranges::fill(tiles_.held, std::uint8_t{0});
  halfplane::clear(rendering_, *scene_, command, config_);
  if (!command.depth) return;
  const std::uint16_t code = range_of(DepthEncode(config_, scene_->planes).of_window(*command.depth));
  has_flushed_ = false;
  for (std::size_t i = 0; i < is_in_target_.size(); ++i) {
    if (!is_in_target_[i]) continue;
    tiles_.z_low[i] = std::min(tiles_.z_low[i], code);
    tiles_.z_high[i] = std::max(tiles_.z_high[i], code);
  }
}

/// Writes the clears that are still pending in tiles that meet `rect`, except where memory holds them already.
void FrameRenderer::settle(const Rect& rect) {
  Framebuffer& frame = rendering_.frame;
  const auto forget = [this](std::uint8_t bit, std::uint32_t& held, std::uint32_t value) {
    if (held == value) return;
    held = value;
    for (std::uint8_t& bits : tiles_.held) bits &= static_cast<std::uint8_t>(~bit);
  };
  forget(TileStates::kDepthCleared, held_depth_, clear_depth_);
  forget(TileStates::kColorCleared, held_color_, clear_color_);
  const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
  const bool is_whole = rect == Rect{0, 0, frame.width, frame.height};
  for_each_index(arena_.get(), bins, [&](std::size_t bin) {
    std::uint8_t* const waits = tiles_.pending.data() + bin * kTiles;
    std::uint8_t is_missing = 0;  // not yet in memory
    for (std::size_t i = 0; i < kTiles; ++i)
      is_missing |= static_cast<std::uint8_t>(waits[i] & ~tiles_.held[bin * kTiles + i]);
    // The contents of samples are unknown.
    if (is_whole && is_missing == 0 && frame.samples.empty()) {
      std::fill_n(waits, kTiles, std::uint8_t{0});
      return;
    }
    const int first_x = static_cast<int>(bin) % bins_x_ * kBinSize,
              first_y = static_cast<int>(bin) / bins_x_ * kBinSize;
    for (int tile = 0; tile < kBinTiles * kBinTiles; ++tile) {
      const int x = first_x + tile % kBinTiles * kTileSize, y = first_y + tile / kBinTiles * kTileSize;
      const std::size_t at = bin * kBinTiles * kBinTiles + static_cast<std::size_t>(tile);
      std::uint8_t& pending = tiles_.pending[at];
      if (pending == 0 || x >= frame.width || y >= frame.height) continue;
      if (x >= rect.x + rect.width || x + kTileSize <= rect.x || y >= rect.y + rect.height || y + kTileSize <= rect.y)
        continue;
      const auto fill = [&](std::uint8_t bits, std::uint8_t bit, std::uint32_t* image, std::uint32_t value) {
        if ((bits & bit) == 0) return;
        std::uint32_t* row = image + frame.at(x, y);
        for (int j = 0; j < kTileSize; ++j, row += frame.stride)
          for (int i = 0; i < kTileSize; ++i) row[i] = value;
      };
      const auto fill_image = [&](Framebuffer& image, std::uint8_t bits) {
        fill(bits, TileStates::kDepthCleared, image.depth.data(), clear_depth_);
        fill(bits, TileStates::kColorCleared, image.color.data(), clear_color_);
      };
      fill_image(frame, static_cast<std::uint8_t>(pending & ~tiles_.held[at]));
      for (Framebuffer& sample : frame.samples) fill_image(sample, pending);
      tiles_.held[at] |= pending;
      pending = 0;
    }
  });
}

/// Writes all pending data; the padding is as in an empty target.
void FrameRenderer::finish() {
  const auto started = Clock::now();
  std::uint64_t pending = 0;
  for (const std::uint8_t bits : tiles_.pending) pending += bits != 0 ? 1U : 0U;
  if (skip_.clear) rendering_.counters.skipped.clear += pending;
  Framebuffer& frame = rendering_.frame;
  if (!keeps_samples_) spare_samples_.swap(frame.samples);
  if (pending != 0) settle({0, 0, frame.width, frame.height});
  const std::uint32_t far = DepthEncode(config_, scene_->planes).of_window(1.0);
  const std::uint32_t black = clear_color({0, 0, 0, 255}, config_.color_format);
  const auto stride = static_cast<std::size_t>(frame.stride);
  const std::size_t rows = frame.depth.size() / stride;
  for_each_image([&](Framebuffer& image) {
    for (std::size_t y = 0; y < rows; ++y) {
      const auto from = y < static_cast<std::size_t>(frame.height) ? static_cast<std::size_t>(frame.width) : 0;
      std::fill_n(image.depth.begin() + static_cast<std::ptrdiff_t>(y * stride + from), stride - from, far);
      std::fill_n(image.color.begin() + static_cast<std::ptrdiff_t>(y * stride + from), stride - from, black);
    }
  });
  rendering_.raster_s += std::chrono::duration<double>(Clock::now() - started).count();
}

// --- draws ------------------------------------------------------------------------------------------------------------

void FrameRenderer::draw(std::uint32_t command) {
  const Draw& draw = std::get<Draw>(scene_->commands[command]);
  entries_done_ += draw.count;
  const PrimitiveType type = primitive_type(draw.topology);
  const bool is_prepared = drawn_as(scene_->states[draw.state], draw.topology) == type;
  if (draw.outside != 0) {
    const std::size_t count = is_prepared ? prepared_->draws[command].primitives : primitive_count(*scene_, draw);
    primitive_ += static_cast<std::uint32_t>(count);
    rendering_.counters.primitives_in += count;
    rendering_.counters.culled += count;
    return;
  }
  // The lanes take lines of one pixel and small points that are not fogged: the host side fogs ends of lines and points.
  const State& state = scene_->states[draw.state];
  const bool is_thin = state.line_rule != LineRule::rectangle && !state.smooth && strands_of(state.line_width) == 1,
             is_plain = type == PrimitiveType::triangle ||
                        (!state.fog && (type == PrimitiveType::line ? is_thin : are_dots(state, widths_)));
  if (is_prepared && is_plain) return draw_prepared(command);
  open_ = nullptr;
  draw_outlines(contexts_.emplace_back(*scene_, config_, draw, command));
}

Slice& FrameRenderer::add_slice(const DrawContext& context) {
  if (slice_count_ == slices_.size()) slices_.emplace_back();
  Slice& slice = slices_[slice_count_++];
  const State& state = context.state;
  slice.context = &context;
  const FragmentOps& ops = context.fragment_ops;
  const bool is_masked = !ops.state.color_write && ops.alpha.func == DepthFunc::always && !ops.stencil;
  FragmentOps rest = ops;
  rest.color = undithered(ops.color, widths_.pixel_samples);
  slice.state = {ops.state, state.shade == Shade::flat,
                 is_opaque_ && rest.is_plain() && (!is_masked || skip_.masked_draws), false,
                 is_masked && skip_.masked_draws};
  slice.state.color_write |= ops.alpha.func != DepthFunc::always;
  slice.parts.clear();
  slice.outlines.clear();
  slice.triangles = 0;
  slice.is_lines = slice.has_dots = false;
  slice.is_in_view = true;
  slice.low_index = ~0U;
  slice.high_index = 0;
  slice.counters = {};
  is_stencil_zero_ = is_stencil_zero_ && !ops.stencil;
  pending_rises_ |= ops.state.depth_write && can_raise_depth(ops.state.depth_test);
  return slice;
}

/// Window positions of two corners of a draw's box.
std::array<WindowPosition, 2> FrameRenderer::ends_of_box(const DrawContext& context,
                                                         const PreparedScene::DrawChunks& draw) {
  const auto corner = [&](const std::array<double, 3>& p) {
    return to_window({p[0], p[1], p[2], 1, {}, 0, 0}, context.state, context.viewport);
  };
  return {corner(draw.low), corner(draw.high)};
}

/// Whether the clipper cuts nothing of the draw and refuses no vertex.
bool FrameRenderer::is_uncut(const DrawContext& context, const PreparedScene::DrawChunks& draw) const {
  const double limit = config_.guard_band - 2, near = context.state.clip_z == ClipZ::zero_one ? 0 : -1, hair = 1e-9;
  const auto is_inside = [limit](const WindowPosition& p) { return std::abs(p.x) < limit && std::abs(p.y) < limit; };
  return draw.has_box && std::ranges::all_of(ends_of_box(context, draw), is_inside) && draw.low[2] > near + hair &&
         draw.high[2] < 1 - hair;
}

/// Slice::is_in_view, of one part. The volume that culls is a pixel wider than the box that is tested.
bool FrameRenderer::is_in_view(const DrawContext& context, const PreparedScene::DrawChunks& draw) const {
  return context.state.space == Space::clip && is_uncut(context, draw) && std::min(draw.low[0], draw.low[1]) >= -1 &&
         std::max(draw.high[0], draw.high[1]) <= 1;
}

/// Whether every fragment of the draw would fail against the depths drawn so far. Pending triangles may only lower
/// depths.
bool FrameRenderer::is_behind(const DrawContext& context, const PreparedScene::DrawChunks& draw) const {
  const State& state = context.state;
  const DepthFunc func = context.fragment_ops.state.depth_test;
  const bool falls = func == DepthFunc::less || func == DepthFunc::lequal;
  if (!is_opaque_ || context.fragment_ops.stencil || context.rect.width <= 0 || context.rect.height <= 0) return false;
  if (!falls || pending_rises_ || state.polygon_offset != std::array<double, 2>{0.0, 0.0}) return false;
  if (!is_uncut(context, draw)) return false;  // corners and errors of a cut draw are not the box's
  const auto [a, b] = ends_of_box(context, draw);
  // One pixel and one code more: the snap, and the rounding of the plane.
  const Rect& rect = context.rect;
  const auto tile = [](double pixel, int first, int last) {
    return static_cast<int>(std::clamp(pixel, static_cast<double>(first), static_cast<double>(last))) >> kTileShift;
  };
  const int left = tile(std::min(a.x, b.x) - 1, rect.x, rect.x + rect.width - 1),
            right = tile(std::max(a.x, b.x) + 1, rect.x, rect.x + rect.width - 1),
            top = tile(std::min(a.y, b.y) - 1, rect.y, rect.y + rect.height - 1),
            bottom = tile(std::max(a.y, b.y) + 1, rect.y, rect.y + rect.height - 1);
  const double codes = static_cast<double>((std::int64_t{1} << config_.depth_bits) - 1);
  const double nearest = std::floor(std::min(a.z, b.z) * codes) - 1;
  constexpr int kShift = kBinShift - kTileShift;
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const int bin = (y >> kShift) * bins_x_ + (x >> kShift);
      const int at = (bin * kBinTiles + (y & (kBinTiles - 1))) * kBinTiles + (x & (kBinTiles - 1));
      // The dropped bits of a range may all be ones.
      const std::int64_t above = (std::int64_t{tiles_.z_high[static_cast<std::size_t>(at)]} + 1) << range_drop(config_);
      if (nearest < static_cast<double>(above)) return false;
    }
  return true;
}

/// Adds chunk by chunk to the open slice while that has the same state and room.
void FrameRenderer::draw_prepared(std::uint32_t command) {
  const Draw& draw = std::get<Draw>(scene_->commands[command]);
  const PreparedScene::DrawChunks& chunks = prepared_->draws[command];
  const PrimitiveType type = primitive_type(draw.topology);
  const bool is_lines = type == PrimitiveType::line, has_dots = type == PrimitiveType::point;
  if (skip_.objects_hiz && chunks.has_box && !compares_) {
    // Occluders must be drawn to be known: before the first draw that is worth it, and from time to time.
    constexpr std::size_t kMany = 512, kStale = 1 << 15;
    if (chunks.primitives >= kMany && pending_primitives_ > 0 && (!has_flushed_ || pending_primitives_ >= kStale))
      flush();
    // Before the first draw there is only the clear, which hides something unless it is the farthest depth.
    const bool may_hide = has_flushed_ || clear_depth_ < (std::uint32_t{1} << config_.depth_bits) - 1;
    if (may_hide && is_behind(DrawContext(*scene_, config_, draw, command), chunks)) {
      primitive_ += static_cast<std::uint32_t>(chunks.primitives);
      Counters& counters = rendering_.counters;
      counters.primitives_in += chunks.primitives;
      counters.culled += chunks.primitives;
      ++counters.skipped.objects_hiz;
      return;
    }
  }
  // Vertices that neighbouring slices share are projected in each slice: fewer slices, fewer of these. Lines of a bin are
  // set up sixteen at a time, slice by slice: the more a slice has, the fewer lanes stay empty.
  const std::size_t slices_of_draw = is_lines ? 4 : 16, most = (is_lines ? 8 : 4) * kSlicePrimitives,
                    slice_limit = std::clamp(chunks.primitives / slices_of_draw, kSlicePrimitives, most);
  for (std::size_t i = chunks.first; i < chunks.first + chunks.count; ++i) {
    const PreparedScene::Chunk& chunk = prepared_->chunks[i];
    if (pending_primitives_ >= kBatchPrimitives && !compares_) flush();
    if (open_ == nullptr || open_state_ != draw.state || open_->is_lines != is_lines || open_->has_dots != has_dots ||
        open_->triangles + chunk.count > slice_limit) {
      open_ = &add_slice(contexts_.emplace_back(*scene_, config_, draw, command));
      open_state_ = draw.state;
      open_->is_lines = is_lines;
      open_->has_dots = has_dots;
      open_->state.has_surface = type == PrimitiveType::triangle && has_surface(open_->context->state);
    }
    open_->parts.push_back({chunk.first, chunk.count, command, primitive_});
    open_->triangles += chunk.count;
    open_->is_in_view &= is_in_view(*open_->context, chunks);
    if (open_->state.is_masked) rendering_.counters.skipped.masked_draws += chunk.count;
    open_->low_index = std::min(open_->low_index, chunk.low_index);
    open_->high_index = std::max(open_->high_index, chunk.high_index);
    primitive_ += static_cast<std::uint32_t>(chunk.count);
    pending_primitives_ += chunk.count;
  }
}

void FrameRenderer::draw_outlines(const DrawContext& context) {
  Slice* slice = nullptr;
  for_each_primitive(*scene_, context.draw, context.state.provoking, [&](const AssembledPrimitive& assembled) {
    if (slice == nullptr || slice->outlines.size() >= kSlicePrimitives) {
      slice = &add_slice(context);
      slice->parts.push_back({0, 0, context.command, primitive_});
    }
    slice->outlines.push_back(assembled);
    if (slice->state.is_masked) ++rendering_.counters.skipped.masked_draws;
    ++primitive_;
    ++pending_primitives_;
  });
}

/// Signature of all draws in a bin, in order, over the clears. Slices of one state count as one.
Signature FrameRenderer::signature_of_bin(std::size_t bin, const std::vector<const Slice*>& slices) const {
  SignatureHash hash;
  hash.add(clear_depth_);
  hash.add(clear_color_);
  const Slice* before = nullptr;
  for (const Slice* slice : slices) {
    const std::uint32_t first = slice->bin_first[bin], end = slice->bin_first[bin + 1];
    if (first == end) continue;
    if (before == nullptr || slice->state_signature != before->state_signature) hash.add(slice->state_signature);
    before = slice;
    if (slice->has_dots)
      for (const Dot& dot : std::span(slice->dots).subspan(first, end - first))
        for (const std::uint64_t pair : std::bit_cast<std::array<std::uint64_t, 2>>(dot)) hash.add(pair);
    else
      for (std::uint32_t i = first; i < end; ++i) hash.add(slice->signatures[slice->bin_records[i]]);
  }
  return hash.signature();
}

/// Draws all pending slices. Where bins are compared these are the whole frame.
void FrameRenderer::flush(bool is_last) {
  open_ = nullptr;
  if (slice_count_ == 0 && !(compares_ && is_last)) return;
  const auto started = Clock::now();
  // Later draws read samples: then they must be in memory.
  const bool writes_samples = widths_.has_samples != 0 && (keeps_samples_ || !is_last);
  if (writes_samples) need_samples();
  for_each_index(arena_.get(), slice_count_, [this](std::size_t i) { build(slices_[i]); });
  const auto built = Clock::now();
  const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
  bin_counters_.assign(bins, {});
  const FrameContext frame{*prepared_, config_, widths_, skip_, bins_x_, !is_opaque_};
  std::vector<const Slice*> slices;
  for (std::size_t i = 0; i < slice_count_; ++i) slices.push_back(&slices_[i]);
  const bool is_known = held_bins_.size() == bins;
  if (compares_) held_bins_.resize(bins);
  for_each_index(arena_.get(), bins, [&](std::size_t bin) {
    const bool is_idle = std::ranges::all_of(
        slices, [bin](const Slice* slice) { return slice->bin_first[bin] == slice->bin_first[bin + 1]; });
    if (compares_) {
      const Signature now = signature_of_bin(bin, slices);
      if (std::exchange(held_bins_[bin], now) == now && is_known) {
        std::fill_n(tiles_.pending.begin() + static_cast<std::ptrdiff_t>(bin * kTiles), kTiles, std::uint8_t{0});
        if (!is_idle) forget_depths(bin * kTiles, kTiles);
        bin_counters_[bin].skipped.bins = is_idle ? 0 : 1;
        return;
      }
    }
    if (is_idle) return;
    BinJob job{frame,        slices,       static_cast<int>(bin), rendering_.frame, tiles_,
               clear_depth_, clear_color_, bin_counters_[bin],    writes_samples};
    kernels_->raster(job);
  });
  for (std::size_t i = 0; i < slice_count_; ++i) add(rendering_.counters, slices_[i].counters);
  for (const Counters& counters : bin_counters_) add(rendering_.counters, counters);
  slice_count_ = pending_primitives_ = 0;
  pending_rises_ = false;
  has_flushed_ = true;
  contexts_.clear();
  rendering_.geometry_s += std::chrono::duration<double>(built - started).count();
  rendering_.raster_s += std::chrono::duration<double>(Clock::now() - built).count();
}

}  // namespace halfplane::functional
