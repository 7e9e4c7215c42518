// Decoders of compressed parts of glTF files: external libraries, each optional in a build.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/formats/texture.hpp"
#include "sim/scene/gltf_file.hpp"

namespace halfplane {

enum class GltfCodec { draco, meshopt, webp };

/// Whether this build has the library. Without it the functions below report everything as damaged.
[[nodiscard]] bool can_read(GltfCodec codec);

/// A buffer view of EXT_meshopt_compression: `count` elements of `stride` bytes.
struct MeshoptStream {
  std::string mode, filter;
  std::uint64_t count = 0, stride = 0;
};
/// count * stride bytes; or none, with the reason in `fault`.
[[nodiscard]] std::optional<std::string> decode_meshopt(const MeshoptStream& stream, ByteSpan packed,
                                                        std::string& fault);

/// An attribute of a primitive of KHR_draco_mesh_compression.
struct DracoAttribute {
  std::uint64_t id = 0;     ///< its number in the compressed data
  GltfComponent component;  ///< of the accessor, like the next member
  int width = 1;
  std::string bytes{};  ///< the result: an element for each vertex, packed
};
struct DracoMesh {
  std::uint64_t vertices = 0;
  std::string indices;  ///< of triangles, 32 bits each
};
/// Fills in the attributes; or none, with the reason in `fault`.
[[nodiscard]] std::optional<DracoMesh> decode_draco(ByteSpan packed, std::vector<DracoAttribute>& attributes,
                                                    std::string& fault);

[[nodiscard]] bool is_webp(ByteSpan bytes);
/// The image's texels. Throws InputError: "`what`: the error".
[[nodiscard]] TexelImage decode_webp(ByteSpan bytes, const std::string& what);

}  // namespace halfplane
