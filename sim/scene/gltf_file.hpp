// A glTF 2.0 file in either container (.gltf: JSON; .glb: JSON and bytes), its buffers, and the numbers in them. Every
// offset and length is checked against its container before anything is read.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halfplane {

// A value in a JSON document that knows its place, so that every error names file and place.

/// Parses a whole text. Throws InputError "file:line: the error; the remedy" when it is not JSON.
[[nodiscard]] std::shared_ptr<const nlohmann::json> parse_json(std::string_view text, const std::string& file);

/// One value and its path from the root, as `nodes[3].mesh`. A view: document and file name must outlive it. Every read
/// of a value of another kind throws InputError "file: path: the error; the remedy".
class JsonPlace {
 public:
  JsonPlace(const nlohmann::json& value, const std::string& file, std::string path = "")
      : value_(&value), file_(&file), path_(std::move(path)) {}

  /// A member of this object, or none.
  [[nodiscard]] std::optional<JsonPlace> find(std::string_view key) const;
  /// An extension of this object, or none.
  [[nodiscard]] std::optional<JsonPlace> extension(std::string_view name) const;
  /// A member that must be there.
  [[nodiscard]] JsonPlace at(std::string_view key) const;
  /// The names of this object's members.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Number of elements of this array.
  [[nodiscard]] std::size_t size() const;
  /// An element of this array; i < size().
  [[nodiscard]] JsonPlace operator[](std::size_t i) const;

  /// This value as a finite number.
  [[nodiscard]] double number() const;
  /// This value as a whole number of 0...most; 3.0 is one too.
  [[nodiscard]] std::uint64_t whole(std::uint64_t most) const;
  [[nodiscard]] bool is_text() const;
  /// This value as a string. It may contain any byte that JSON allows.
  [[nodiscard]] std::string text() const;

  // The same for an optional member.
  [[nodiscard]] double number_or(std::string_view key, double otherwise) const;
  [[nodiscard]] std::uint64_t whole_or(std::string_view key, std::uint64_t most, std::uint64_t otherwise) const;
  [[nodiscard]] std::string text_or(std::string_view key, const std::string& otherwise) const;
  [[nodiscard]] bool flag_or(std::string_view key, bool otherwise) const;

  /// This value as an index into a list of `count` things called `what` ("meshes").
  [[nodiscard]] std::size_t index(std::size_t count, std::string_view what) const;

  /// Throws InputError "file: path: the error; the remedy".
  [[noreturn]] void fail(const std::string& what, const std::string& mend) const;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void require_object() const;

  const nlohmann::json* value_;
  const std::string* file_;
  std::string path_;
};

using ByteSpan = std::span<const std::uint8_t>;

/// The bytes of a file next to this one, a buffer or an image, by its (decoded) relative name; none: there is no such
/// file.
using BufferSource = std::function<std::optional<std::string>(const std::string& name)>;

/// The kinds of number in a buffer, by the codes of the file format.
enum class GltfComponent : std::uint16_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// A checked window on `count` elements of 1...4 numbers, or of the 16 of a matrix: every read of element i < count lies
/// inside the bytes.
struct GltfAccessor {
  std::uint64_t count = 0;
  int width = 1;  ///< numbers per element
  GltfComponent component = GltfComponent::f32;
  bool normalized = false;  ///< integers stand for 0...1 or -1...1
  ByteSpan bytes;           ///< from the first element on; empty: all zero
  std::size_t stride = 0;   ///< bytes from one element to the next

  // Replaced elements: ascending element numbers and their values, packed.
  std::uint64_t sparse_count = 0;
  GltfComponent sparse_component = GltfComponent::u32;
  ByteSpan sparse_indices, sparse_values;

  std::string place;  ///< for messages: "file: accessors[3]"
};

/// Element i < count, converted as the format says (binary32 exactly); missing numbers are 0. Throws InputError for a
/// number that is NaN or infinite.
[[nodiscard]] std::array<double, 4> read_element(const GltfAccessor& accessor, std::uint64_t i);
/// The same for a matrix, column by column.
[[nodiscard]] std::array<double, 16> read_matrix(const GltfAccessor& accessor, std::uint64_t i);

class GltfFile {
 public:
  /// Parses the container and the JSON; checks version and required extensions. Throws InputError.
  GltfFile(std::string bytes, std::string name, BufferSource source);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] JsonPlace root() const { return {*json_, name_}; }
  /// Number of entries of a top-level list ("nodes"); 0 when it is left out.
  [[nodiscard]] std::size_t count(std::string_view list) const;
  /// Optional extensions used by the file that affect the picture and are not read here.
  [[nodiscard]] std::vector<std::string> passed_over() const;
  /// Entry i < count(list) of a top-level list.
  [[nodiscard]] JsonPlace item(std::string_view list, std::size_t i) const { return root().at(list)[i]; }
  /// The entry of `list` named by an index.
  [[nodiscard]] JsonPlace follow(const JsonPlace& index, std::string_view list) const {
    return item(list, index.index(count(list), list));
  }
  /// The accessor named by an index. Buffers are loaded on first use. The reference is valid as long as this.
  [[nodiscard]] const GltfAccessor& accessor(const JsonPlace& index);
  /// The bytes of an entry of `bufferViews`, decompressed if necessary. Valid as long as this.
  [[nodiscard]] ByteSpan view(const JsonPlace& view_place);
  /// Decompresses a primitive with KHR_draco_mesh_compression: its accessors then refer to the decompressed data.
  /// Throws InputError for one that is damaged, or that this build cannot read.
  void unpack(const JsonPlace& primitive);
  /// The bytes of a `uri`: inline (data:), or of a file next to this one.
  [[nodiscard]] std::string resource(const JsonPlace& uri) const;

 private:
  void split_glb();
  void check_head() const;
  [[nodiscard]] GltfAccessor make_accessor(const JsonPlace& place);
  void add_sparse(GltfAccessor& accessor, const JsonPlace& place);
  [[nodiscard]] const std::string& buffer(const JsonPlace& index);
  [[nodiscard]] ByteSpan packed_view(const JsonPlace& view_place);
  [[nodiscard]] ByteSpan unpacked_view(const JsonPlace& view_place, const JsonPlace& packed);
  void set_unpacked(const JsonPlace& index, GltfComponent component, std::uint64_t elements, std::string bytes);

  std::string bytes_;  // the whole file
  std::string name_;
  BufferSource source_;
  std::string_view text_;                  // the JSON in bytes_
  std::optional<std::string_view> chunk_;  // the BIN chunk in bytes_
  std::shared_ptr<const nlohmann::json> json_;
  std::map<std::size_t, std::string> buffers_;  // buffers used so far; maps keep their elements in place
  std::map<std::size_t, GltfAccessor> accessors_;
  std::map<std::string, std::string> unpacked_;  // decompressed views and accessors, by their places
};

/// The remedy for a file that requires this unsupported extension: for compressed ones the tool that decompresses them.
[[nodiscard]] std::string way_without(std::string_view extension);

/// The bytes of a base64 text (RFC 4648; the padding may be left out), or none when it is invalid.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

}  // namespace halfplane
