#include "vertices.hpp"

#include <algorithm>

namespace halfplane::gl {
namespace {

/// Calls visit(row, number) for each row of four numbers, and visit(number) for single ones.
template <class Vertex, class Visit>
void for_each_number(Vertex& vertex, const Visit& visit) {
  std::size_t number = 0;
  const auto row = [&](auto& of) {
    for (auto& value : of) visit(value, number++);
  };
  row(vertex.eye), row(vertex.clip);
  for (auto* member : {&vertex.color, &vertex.secondary, &vertex.tex_coord})
    for (auto& of : *member) row(of);
  visit(vertex.fog_distance, number++);
  visit(vertex.point_size, number++);
}

/// Calls visit(value, number) for the current attributes, but for the edge flag, in the numbers of InputVertices.
template <class AnyState, class Visit>
void for_each_current(AnyState& state, const Visit& visit) {
  auto& current = state.current;
  const auto row = [&](auto& of, std::size_t size, Attribute attribute, std::size_t unit = 0) {
    for (std::size_t i = 0; i < size; ++i) visit(of[i], input_number(attribute, unit) + i);
  };
  row(current.normal, 3, Attribute::normal);
  row(current.color, 4, Attribute::color);
  row(current.secondary, 3, Attribute::secondary);
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit) row(current.tex_coord[unit], 4, Attribute::tex_coord, unit);
  visit(current.fog_coord, input_number(Attribute::fog_coord));
  visit(state.point.size, input_number(Attribute::point_size));
}

}  // namespace

void InputVertices::begin(const State& state) {
  size_ = stride_ = 0;
  is_complete_ = true;
  columns_.clear();
  column_of_.fill(kOneValue);
  load(state);
  vary(static_cast<std::size_t>(Attribute::position));
}

void InputVertices::load(const State& state) {
  for_each_current(state, [&](const double& current, std::size_t number) { value_[number] = current; });
  value_[input_number(Attribute::edge_flag)] = state.current.edge_flag ? 1 : 0;
}

void InputVertices::store(State& state) const {
  for_each_current(state, [&](double& current, std::size_t number) {
    if (column_of_[number] != kOneValue) current = value_[number];
  });
  constexpr std::size_t kEdgeFlag = input_number(Attribute::edge_flag);
  if (column_of_[kEdgeFlag] != kOneValue) state.current.edge_flag = value_[kEdgeFlag] != 0;
}

void InputVertices::vary(std::size_t attribute) {
  const std::size_t before = stride_, blocks = before == 0 ? 0 : columns_.size() / before;
  for (std::size_t number = kInputNumber[attribute]; number < kInputNumber[attribute + 1]; ++number) {
    column_of_[number] = static_cast<std::uint8_t>(stride_);
    number_of_[stride_++] = static_cast<std::uint8_t>(number);
  }
  if (blocks == 0) return;
  is_complete_ = false;
  std::vector<Column> columns;
  columns.reserve(blocks * stride_);
  for (std::size_t block = 0; block < blocks; ++block) {
    const auto from = columns_.begin() + static_cast<std::ptrdiff_t>(block * before);
    columns.insert(columns.end(), from, from + static_cast<std::ptrdiff_t>(before));
    for (std::size_t i = before; i < stride_; ++i) columns.emplace_back().fill(value_[number_of_[i]]);
  }
  columns_ = std::move(columns);
}

void InputVertices::add_block() {
  for (std::size_t i = 0; i < stride_; ++i) columns_.emplace_back().fill(value_[number_of_[i]]);
}

ShadedVertex ShadedVertices::operator[](std::size_t i) const {
  const Block& block = blocks_[i / kVertexLanes];
  const std::size_t lane = i % kVertexLanes;
  ShadedVertex vertex;
  for_each_number(vertex, [&](double& value, std::size_t number) { value = block[number][lane]; });
  vertex.edge_flag = block[kEdgeFlag][lane] != 0;
  return vertex;
}

std::vector<ShadedVertex> ShadedVertices::rows() const {
  std::vector<ShadedVertex> rows;
  rows.reserve(size_);
  for (std::size_t i = 0; i < size_; ++i) rows.push_back((*this)[i]);
  return rows;
}

void ShadedVertices::push_back(const ShadedVertex& vertex) {
  const std::size_t lane = size_ % kVertexLanes;
  Block& block = reserve(size_ + 1)[size_ / kVertexLanes];
  const auto put = [&](double value, std::size_t number) {
    if (lane == 0)
      block[number].fill(value);
    else
      block[number][lane] = value;
  };
  for_each_number(vertex, put);
  put(vertex.edge_flag ? 1 : 0, kEdgeFlag);
  ++size_;
}

ShadedVertices::Block* ShadedVertices::reserve(std::size_t size) {
  const std::size_t blocks = (size + kVertexLanes - 1) / kVertexLanes;
  if (blocks_.size() < blocks) blocks_.resize(std::max(blocks, 2 * blocks_.size()));
  return blocks_.data();
}

}  // namespace halfplane::gl
