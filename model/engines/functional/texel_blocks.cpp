#include "texel_blocks.hpp"

#include <algorithm>

namespace halfplane {
namespace {

int blocks_along(int texels) { return (texels + TexelBlocks::kSize - 1) / TexelBlocks::kSize; }

/// The next texel along an axis.
int next(int i, int size, TextureWrap wrap) {
  if (i + 1 < size) return i + 1;
  return wrap == TextureWrap::repeat ? 0 : i;
}

bool is_mirrored(const std::array<TextureWrap, 2>& wrap) {
  return wrap[0] == TextureWrap::mirror || wrap[1] == TextureWrap::mirror;
}

std::size_t index_of(const std::array<TextureWrap, 2>& wrap) {
  return (wrap[0] == TextureWrap::repeat ? 1U : 0U) + (wrap[1] == TextureWrap::repeat ? 2U : 0U);
}

}  // namespace

TexelBlocks::TexelBlocks(const Texture& texture) {
  for (std::size_t n = 0; n < texture.level.size(); ++n) {
    const TextureLevel& level = texture.level[n];
    size_.push_back({level.width, level.height});
    first[n] = static_cast<std::int32_t>(blocks.size() * kTexels);
    blocks.resize(blocks.size() + static_cast<std::size_t>(blocks_along(level.width)) *
                                      static_cast<std::size_t>(blocks_along(level.height)));
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x) {
        const Texel t = texture.texel(static_cast<int>(n), x, y);
        const std::size_t place = place_of(n, x, y);
        blocks[place / kTexels].texel[place % kTexels] =
            t[0] | std::uint32_t{t[1]} << 8 | std::uint32_t{t[2]} << 16 | std::uint32_t{t[3]} << 24;
      }
  }
}

std::size_t TexelBlocks::place_of(std::size_t level, int x, int y) const {
  const int block = (y >> kShift) * blocks_along(size_[level].width) + (x >> kShift);
  return static_cast<std::size_t>(first[level] + block * kTexels + (y & (kSize - 1)) * kSize + (x & (kSize - 1)));
}

void TexelBlocks::add_quads(const std::array<TextureWrap, 2>& wrap) {
  std::vector<Quad>& quads = quads_[index_of(wrap)];
  if (is_mirrored(wrap) || !quads.empty() || blocks.size() * kTexels > kMostQuads) return;
  quads.resize(blocks.size() * kTexels);
  for (std::size_t n = 0; n < size_.size(); ++n)
    for (int y = 0; y < size_[n].height; ++y)
      for (int x = 0; x < size_[n].width; ++x) {
        const int right = next(x, size_[n].width, wrap[0]), below = next(y, size_[n].height, wrap[1]);
        quads[place_of(n, x, y)] = {texel(place_of(n, x, y)), texel(place_of(n, right, y)),
                                    texel(place_of(n, x, below)), texel(place_of(n, right, below))};
      }
}

const TexelBlocks::Quad* TexelBlocks::quads(const std::array<TextureWrap, 2>& wrap) const {
  const std::vector<Quad>& quads = quads_[index_of(wrap)];
  return is_mirrored(wrap) || quads.empty() ? nullptr : quads.data();
}

}  // namespace halfplane
