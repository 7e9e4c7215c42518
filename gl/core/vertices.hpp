// Vertices as lanes take them: eight in a block, a column of eight for each number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "state.hpp"

namespace halfplane::gl {

inline constexpr std::size_t kVertexLanes = 8;
/// A number of eight vertices.
using Column = std::array<double, kVertexLanes>;

/// What a program gives of a vertex. Texture coordinates have an attribute for each unit.
enum class Attribute : std::uint8_t { position, normal, color, secondary, fog_coord, point_size, edge_flag, tex_coord };
inline constexpr std::size_t kAttributes = static_cast<std::size_t>(Attribute::tex_coord) + kTextureUnits;
/// The first number of each attribute, and at the end how many there are.
inline constexpr std::array<std::size_t, kAttributes + 1> kInputNumber{0, 4, 7, 11, 14, 15, 16, 17, 21, 25};
constexpr std::size_t input_number(Attribute attribute, std::size_t unit = 0) {
  return kInputNumber[static_cast<std::size_t>(attribute) + unit];
}

/// The vertices of a primitive as the program gives them. Attributes that it sets among them have columns, the others one
/// value for all.
class InputVertices {
 public:
  using Values = std::array<double, kInputNumber.back()>;

  /// No vertices; values are the current ones of `state`.
  void begin(const State& state);
  /// Takes the current values for the next vertices.
  void load(const State& state);
  /// Makes the values of the last vertex current, where they vary.
  void store(State& state) const;
  /// From now on the attribute has columns; the vertices before keep their value.
  void vary(std::size_t attribute);
  /// Sets an attribute of the next vertices.
  void set(Attribute attribute, std::span<const double> value, std::size_t unit = 0) {
    const std::size_t which = static_cast<std::size_t>(attribute) + unit, first = kInputNumber[which];
    if (column_of_[first] == kOneValue) vary(which);
    for (std::size_t i = 0; i < value.size(); ++i) value_[first + i] = value[i];
  }
  /// Numbers of the next vertex, to be set where the attribute varies.
  [[nodiscard]] double* next(std::size_t number) { return &value_[number]; }
  void add() {
    const std::size_t lane = size_++ % kVertexLanes;
    if (lane == 0) return add_block();
    Column* const block = columns_.data() + (columns_.size() - stride_);
    for (std::size_t i = 0; i < stride_; ++i) block[i][lane] = value_[number_of_[i]];
  }
  void add(const Vec4& position) {
    for (std::size_t i = 0; i < 4; ++i) value_[i] = position[i];
    add();
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// Whether every attribute that varies was set before the first vertex.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// The column of a number in a block, in which lanes after the last vertex repeat another one; null: one value for all.
  [[nodiscard]] const Column* column(std::size_t number, std::size_t block) const {
    const std::uint8_t column = column_of_[number];
    return column == kOneValue ? nullptr : &columns_[block * stride_ + column];
  }
  /// Those of the next vertex.
  [[nodiscard]] const Values& values() const { return value_; }

 private:
  static constexpr std::uint8_t kOneValue = 0xff;
  void add_block();

  std::size_t size_ = 0, stride_ = 0;                                        ///< columns of a block
  std::vector<Column> columns_;                                              ///< block by block
  std::array<std::uint8_t, kInputNumber.back()> column_of_{}, number_of_{};  ///< each the other way around
  Values value_{};
  bool is_complete_ = true;
};

/// A vertex as primitives take it.
struct ShadedVertex {
  Vec4 eye{}, clip{};
  /// Lit for the front and for the back, held to 0...1; equal where there is no two-sided light. `secondary` is zero where
  /// nothing is added after the texture.
  std::array<Vec4, 2> color{}, secondary{};
  std::array<Vec4, kTextureUnits> tex_coord{};  ///< after texgen and the texture matrix
  double fog_distance = 0;                      ///< |z| in eye space or the fog coordinate
  double point_size = 1;                        ///< after attenuation
  bool edge_flag = true;                        ///< the edge to the next vertex is one of the polygon's
};

/// The numbers of a ShadedVertex in columns. An edge flag is a number that is not 0.
class ShadedVertices {
 public:
  /// The first number of each member.
  static constexpr std::size_t kEye = 0, kClip = 4, kColor = 8, kSecondary = 16, kTexCoord = 24,
                               kFogDistance = kTexCoord + 4 * kTextureUnits, kPointSize = kFogDistance + 1,
                               kEdgeFlag = kPointSize + 1, kNumbers = kEdgeFlag + 1;
  using Block = std::array<Column, kNumbers>;

  ShadedVertices() = default;
  explicit ShadedVertices(std::span<const ShadedVertex> vertices) {
    for (const ShadedVertex& v : vertices) push_back(v);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] ShadedVertex operator[](std::size_t i) const;
  [[nodiscard]] double number(std::size_t i, std::size_t number) const {
    return blocks_[i / kVertexLanes][number][i % kVertexLanes];
  }
  [[nodiscard]] std::vector<ShadedVertex> rows() const;
  /// Lanes after the last vertex repeat another one of the block.
  [[nodiscard]] std::span<const Block> blocks() const {
    return {blocks_.data(), (size_ + kVertexLanes - 1) / kVertexLanes};
  }

  void clear() { size_ = 0; }
  void push_back(const ShadedVertex& vertex);
  /// Blocks to be written; resize() makes vertices of them.
  [[nodiscard]] Block* reserve(std::size_t size);
  void resize(std::size_t size) { size_ = size; }

 private:
  std::size_t size_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace halfplane::gl
