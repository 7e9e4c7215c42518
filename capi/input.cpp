#include "input.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "handles.hpp"
#include "model/capture/capture_lines.hpp"

namespace halfplane::capi {
namespace {

/// The place of a word in a list of names, which are told when it is none of them.
template <std::size_t N>
std::size_t place_in(const std::array<std::string_view, N>& names, std::string_view word, const char* what) {
  const auto found = std::ranges::find(names, word);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string known;
  for (const std::string_view name : names) known.append(known.empty() ? "" : ", ").append(name);
  throw InputError(std::string("there is no ") + what + " '" + std::string(word) + "'; give one of " + known);
}

template <class T>
double number_at(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

struct ComponentType {
  std::size_t bytes;
  double (*read)(const std::byte* at);
};

/// By the numbers of halfplane.h.
constexpr std::array<ComponentType, 5> kComponentTypes{{{0, nullptr},
                                                        {sizeof(double), number_at<double>},
                                                        {sizeof(float), number_at<float>},
                                                        {sizeof(std::uint8_t), number_at<std::uint8_t>},
                                                        {sizeof(std::int16_t), number_at<std::int16_t>}}};

/// An attribute of a layout that holds for `count` vertices of so many bytes in all.
class AttributeReader {
 public:
  AttributeReader(const halfplane_layout& layout, const halfplane_attribute& attribute, const char* name, int least,
                  int most, std::size_t bytes, std::size_t count)
      : attribute_(attribute), stride_(layout.stride) {
    const auto fail = [name](const std::string& what) {
      throw InputError(std::string("layout: ") + name + " " + what);
    };
    if (attribute.type < 0 || static_cast<std::size_t>(attribute.type) >= kComponentTypes.size())
      fail("of type " + std::to_string(attribute.type) + "; give HALFPLANE_F64, F32, U8 or I16, or HALFPLANE_NONE");
    type_ = kComponentTypes[static_cast<std::size_t>(attribute.type)];
    if (!is_there()) return;
    if (attribute.components < least || attribute.components > most)
      fail("of " + std::to_string(attribute.components) + " components; give " + std::to_string(least) +
           (most > least ? " to " + std::to_string(most) : ""));
    const std::size_t size = type_.bytes * static_cast<std::size_t>(attribute.components);
    // Of the last vertex: without products that could wrap.
    if (count > 0 && (attribute.offset > bytes || size > bytes - attribute.offset ||
                      (stride_ > 0 && count - 1 > (bytes - attribute.offset - size) / stride_)))
      fail("of " + std::to_string(count) + " vertices ends beyond the " + std::to_string(bytes) +
           " bytes that there are");
  }

  [[nodiscard]] bool is_there() const { return type_.read != nullptr; }
  /// Writes the components that there are.
  void read(const std::byte* data, std::size_t vertex, std::span<double> out) const {
    const std::byte* at = data + stride_ * vertex + attribute_.offset;
    for (std::size_t i = 0; i < static_cast<std::size_t>(attribute_.components); ++i, at += type_.bytes)
      out[i] = type_.read(at);
  }

 private:
  halfplane_attribute attribute_;
  std::size_t stride_;
  ComponentType type_{};
};

}  // namespace

Topology topology_of(std::string_view name) {
  static constexpr std::array<std::string_view, 7> kNames{"triangles",  "triangle_strip", "triangle_fan", "lines",
                                                          "line_strip", "line_loop",      "points"};
  return static_cast<Topology>(place_in(kNames, name, "topology"));
}

/// By the one reader of captures: as the head of a capture with a single draw, whose state is taken. Known textures stand in
/// the head, so that their names mean something.
Said read_lines(int width, int height, std::span<const Texture> known, std::string_view lines) {
  std::string capture = "halfplane 1\ntarget " + std::to_string(width) + " " + std::to_string(height) + "\n";
  for (const Texture& texture : known) capture += "texture " + texture.name + " pattern chequer 1 1\n";
  capture.append(lines).append("\nv 0 0 0 1\np 0\n");
  Said said{read_capture_lines(capture, "lines", 2 + known.size()), {}};
  if (said.scene.vertices.size() != 1) throw InputError("lines: vertices are given by arrays, not by lines");
  if (said.scene.width != width || said.scene.height != height)
    throw InputError("lines: the size of the target is given where it is made");
  said.state = said.scene.states.at(std::get<Draw>(said.scene.commands.back()).state);
  said.scene.commands.pop_back();
  said.scene.vertices.clear();
  said.scene.indices.clear();
  return said;
}

std::vector<Vertex> read_vertices(const double* values, int numbers, std::size_t count) {
  const auto parts = std::span(kVertexParts).subspan(1);  // a place has a w here
  const auto size = static_cast<std::size_t>(numbers);
  if (std::ranges::find(parts, size, &VertexPart::end) == parts.end()) {
    std::string sizes;
    for (const VertexPart& part : parts)
      sizes += (sizes.empty() ? "" : &part == &parts.back() ? " or " : ", ") + std::to_string(part.end);
    throw InputError("a vertex has " + sizes + " numbers, not " + std::to_string(numbers));
  }
  std::vector<Vertex> vertices;
  vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i, values += numbers) {
    VertexNumbers vertex = numbers_of(Vertex{});
    std::copy_n(values, size, vertex.begin());
    vertices.push_back(vertex_of(vertex));
  }
  return vertices;
}

Vertices read_vertices(const halfplane_layout& layout, const void* data, std::size_t bytes, std::size_t count) {
  const auto reader = [&](const halfplane_attribute& attribute, const char* name, int least, int most) {
    return AttributeReader(layout, attribute, name, least, most, bytes, count);
  };
  const AttributeReader position = reader(layout.position, "position", 2, 4),
                        color = reader(layout.color, "color", 3, 4),
                        texcoord = reader(layout.texcoord, "texcoord", 2, 2),
                        normal = reader(layout.normal, "normal", 3, 3);
  if (!position.is_there()) throw InputError("layout: vertices without a position");
  if (count > 0 && data == nullptr) throw InputError("the array of vertices is NULL");
  const auto* from = static_cast<const std::byte*>(data);
  Vertices made;
  made.vertices.resize(count);
  if (normal.is_there()) made.normals.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Vertex& v = made.vertices[i];
    std::array<double, 4> xyzw{0, 0, 0, 1};
    std::array<double, 2> uv{};
    position.read(from, i, xyzw);
    if (color.is_there()) color.read(from, i, v.rgba);
    if (texcoord.is_there()) texcoord.read(from, i, uv);
    if (normal.is_there()) normal.read(from, i, made.normals[i]);
    v.x = xyzw[0];
    v.y = xyzw[1];
    v.z = xyzw[2];
    v.w = xyzw[3];
    v.u = uv[0];
    v.v = uv[1];
  }
  return made;
}

Texture read_texture(std::string_view name, int width, int height, const std::uint8_t* rgba, std::string_view format,
                     std::string_view mips) {
  const auto is_side = [](int side) { return side >= 1 && side <= kLargestTexture; };
  if (!is_side(width) || !is_side(height))
    throw InputError("a texture of " + std::to_string(width) + "x" + std::to_string(height) +
                     " texels; give sides of 1 to " + std::to_string(kLargestTexture));
  const auto stored_as = static_cast<TextureFormat>(place_in(kTextureFormats, format, "texture format"));
  const auto kind = static_cast<Mips>(place_in(kMips, mips, "kind of mips"));
  const std::uint8_t* texels = &required(rgba, "the array of texels");
  const auto next_image = [&texels](int w, int h) {
    TexelImage image{w, h, {}};
    image.texel.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    std::memcpy(image.texel.data(), texels, image.texel.size() * sizeof(Texel));
    texels += image.texel.size() * sizeof(Texel);
    return image;
  };
  std::vector<TexelImage> levels{next_image(width, height)};
  while (kind == Mips::levels && (levels.back().width > 1 || levels.back().height > 1))
    levels.push_back(next_image(std::max(1, levels.back().width / 2), std::max(1, levels.back().height / 2)));
  Scene probe;
  probe.name = "texture";
  probe.textures.push_back(kind == Mips::levels ? make_texture(std::string(name), levels, stored_as)
                                                : make_texture(std::string(name), levels.front(), stored_as, kind));
  validate(probe);  // its name
  return std::move(probe.textures.front());
}

void check_indices(std::span<const std::uint32_t> indices, std::size_t vertices, std::string_view owner) {
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] != kRestart && indices[i] >= vertices)
      throw InputError("index " + std::to_string(i) + " of the draw is " + std::to_string(indices[i]) + ", and the " +
                       std::string(owner) + " has " + std::to_string(vertices) + " vertices");
}

}  // namespace halfplane::capi
