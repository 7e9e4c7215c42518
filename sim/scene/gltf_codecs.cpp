#include "sim/scene/gltf_codecs.hpp"

#include <array>
#include <cstring>
#include <exception>

#ifdef HALFPLANE_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#endif
#ifdef HALFPLANE_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif
#ifdef HALFPLANE_HAS_WEBP
#include <webp/decode.h>
#endif

#include "model/config.hpp"

namespace halfplane {

bool can_read([[maybe_unused]] GltfCodec codec) {
#ifdef HALFPLANE_HAS_DRACO
  if (codec == GltfCodec::draco) return true;
#endif
#ifdef HALFPLANE_HAS_MESHOPTIMIZER
  if (codec == GltfCodec::meshopt) return true;
#endif
#ifdef HALFPLANE_HAS_WEBP
  if (codec == GltfCodec::webp) return true;
#endif
  return false;
}

// --- meshopt -----------------------------------------------------------------------------------------------------------

#ifdef HALFPLANE_HAS_MESHOPTIMIZER
namespace {

/// Checks the library's unchecked assumptions: empty, or the fault.
std::string meshopt_fault(const MeshoptStream& stream, std::size_t packed_bytes) {
  const bool is_vertices = stream.mode == "ATTRIBUTES";
  if (!is_vertices && stream.mode != "TRIANGLES" && stream.mode != "INDICES")
    return "mode '" + stream.mode + "', which is none of ATTRIBUTES, TRIANGLES and INDICES";
  if (stream.count == 0) return "no elements";
  const bool is_stride = is_vertices ? stream.stride >= 4 && stream.stride <= 256 && stream.stride % 4 == 0
                                     : stream.stride == 2 || stream.stride == 4;
  if (!is_stride) return "a byteStride of " + std::to_string(stream.stride) + " in mode " + stream.mode;
  if (stream.mode == "TRIANGLES" && stream.count % 3 != 0)
    return std::to_string(stream.count) + " indices of triangles";
  if (stream.filter != "NONE") {
    const bool is_filter =
        is_vertices && ((stream.filter == "OCTAHEDRAL" && (stream.stride == 4 || stream.stride == 8)) ||
                        (stream.filter == "QUATERNION" && stream.stride == 8) || stream.filter == "EXPONENTIAL");
    if (!is_filter) return "filter '" + stream.filter + "' for elements of " + std::to_string(stream.stride) + " bytes";
  }
  // A byte can state at most that 64 are equal to earlier ones: no larger memory is allocated.
  constexpr std::uint64_t kMostRatio = 256;
  if (stream.count * stream.stride > packed_bytes * kMostRatio)
    return std::to_string(packed_bytes) + " bytes cannot hold " + std::to_string(stream.count) + " elements";
  return "";
}

}  // namespace

std::optional<std::string> decode_meshopt(const MeshoptStream& stream, ByteSpan packed, std::string& fault) {
  fault = meshopt_fault(stream, packed.size());
  if (!fault.empty()) return std::nullopt;
  const auto count = static_cast<std::size_t>(stream.count), stride = static_cast<std::size_t>(stream.stride);
  std::string bytes(count * stride, '\0');
  const int status = stream.mode == "ATTRIBUTES"
                         ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, packed.data(), packed.size())
                     : stream.mode == "TRIANGLES"
                         ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, packed.data(), packed.size())
                         : meshopt_decodeIndexSequence(bytes.data(), count, stride, packed.data(), packed.size());
  if (status != 0) {
    fault = "the compressed bytes are damaged";
    return std::nullopt;
  }
  if (stream.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
  if (stream.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
  if (stream.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
  return bytes;
}
#else
std::optional<std::string> decode_meshopt(const MeshoptStream&, ByteSpan, std::string& fault) {
  fault = "compressed, which this build does not read";
  return std::nullopt;
}
#endif

// --- Draco -------------------------------------------------------------------------------------------------------------

#ifdef HALFPLANE_HAS_DRACO
namespace {

/// Reads each vertex's element of an attribute, as numbers of type T. Returns whether all were available.
template <class T>
bool copy_as(const draco::PointCloud& mesh, const draco::PointAttribute& from, DracoAttribute& to) {
  std::array<T, 4> element{};
  const std::size_t bytes = sizeof(T) * static_cast<std::size_t>(to.width);
  to.bytes.resize(bytes * mesh.num_points());
  char* at = to.bytes.data();
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i, at += bytes) {
    if (!from.ConvertValue<T>(from.mapped_index(i), static_cast<std::int8_t>(to.width), element.data())) return false;
    std::memcpy(at, element.data(), bytes);
  }
  return true;
}

bool copy_attribute(const draco::PointCloud& mesh, const draco::PointAttribute& from, DracoAttribute& to) {
  switch (to.component) {
    case GltfComponent::i8: return copy_as<std::int8_t>(mesh, from, to);
    case GltfComponent::u8: return copy_as<std::uint8_t>(mesh, from, to);
    case GltfComponent::i16: return copy_as<std::int16_t>(mesh, from, to);
    case GltfComponent::u16: return copy_as<std::uint16_t>(mesh, from, to);
    case GltfComponent::u32: return copy_as<std::uint32_t>(mesh, from, to);
    case GltfComponent::f32: return copy_as<float>(mesh, from, to);
  }
  return false;
}

std::optional<DracoMesh> copied(const draco::Mesh& mesh, std::vector<DracoAttribute>& attributes, std::string& fault) {
  for (DracoAttribute& attribute : attributes) {
    const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(attribute.id));
    const bool is_there = from != nullptr && attribute.width <= 4;
    if (!is_there || !copy_attribute(mesh, *from, attribute)) {
      fault = "what is compressed has no attribute " + std::to_string(attribute.id) + " of its accessor's kind";
      return std::nullopt;
    }
  }
  DracoMesh made{mesh.num_points(), {}};
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh.face(f)) {
      const std::uint32_t index = corner.value();
      std::array<char, sizeof index> bytes{};
      std::memcpy(bytes.data(), &index, sizeof index);
      made.indices.append(bytes.data(), bytes.size());
    }
  return made;
}

}  // namespace

std::optional<DracoMesh> decode_draco(ByteSpan packed, std::vector<DracoAttribute>& attributes, std::string& fault) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  std::string why = "the compressed bytes are damaged";
  try {
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (decoded.ok()) return copied(*std::move(decoded).value(), attributes, fault);
    why += " (Draco: " + decoded.status().error_msg_string() + ")";
  } catch (const std::exception&) {  // invalid lengths
  }
  fault = why;
  return std::nullopt;
}
#else
std::optional<DracoMesh> decode_draco(ByteSpan, std::vector<DracoAttribute>&, std::string& fault) {
  fault = "compressed, which this build does not read";
  return std::nullopt;
}
#endif

// --- WebP --------------------------------------------------------------------------------------------------------------

bool is_webp(ByteSpan bytes) {
  return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
         std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

#ifdef HALFPLANE_HAS_WEBP
TexelImage decode_webp(ByteSpan bytes, const std::string& what) {
  TexelImage image;
  if (WebPGetInfo(bytes.data(), bytes.size(), &image.width, &image.height) == 0)
    throw InputError(what + ": no WebP image; give one");
  if (image.width > kLargestTexture || image.height > kLargestTexture)
    throw InputError(what + ": " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " texels; give an image of at most 4096x4096");
  image.texel.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const std::size_t size = image.texel.size() * sizeof(Texel);
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.texel.front().data(), size, 4 * image.width) == nullptr)
    throw InputError(what + ": the image is damaged; save it again");
  return image;
}
#else
TexelImage decode_webp(ByteSpan, const std::string& what) {
  throw InputError(what + ": a WebP image, which this build does not read; give a PNG");
}
#endif

}  // namespace halfplane
