// Functions on blocks of vertices, compiled for each instruction set (shade_lanes.inl). All give the same results.
#pragma once

#include <span>
#include <string_view>

#include "batch.hpp"
#include "shading.hpp"
#include "vertices.hpp"

namespace halfplane::gl {

struct ShadeKernels {
  std::string_view name;  ///< that of functional::Kernels
  /// Positions in clip space of the vertices from a block on. A bit for each plane of the view volume beyond which all are.
  unsigned (*place)(const Context& context, const InputVertices& vertices, std::size_t first_block,
                    ShadedVertices::Block* blocks);
  /// Everything else; attributes that do not vary are of `values`. `all_textures`: texture coordinates also without textures.
  void (*finish)(const Context& context, const InputVertices& vertices, const InputVertices::Values& values,
                 std::size_t first_block, ShadedVertices::Block* blocks, bool all_textures);
  BatchTraits (*traits)(std::span<const ShadedVertices::Block> blocks, std::size_t unit);
};
extern const ShadeKernels kAvx512Shading, kAvx2Shading, kPortableShading;

/// Those for this machine, of the instruction set that the functional engine takes.
[[nodiscard]] const ShadeKernels& shade_kernels();

}  // namespace halfplane::gl
