#include "sim/show/trace/primitive_spans.hpp"

#include <algorithm>

namespace halfplane {

std::string_view kind_name(PrimitiveKind kind) {
  const auto& all = WireEnum<PrimitiveKind>::all;
  return std::ranges::find(all, kind, &Enumerator<PrimitiveKind>::value)->name;
}

PrimitiveSpans::PrimitiveSpans() : text_("number,kind,primitive,command,first,last") {
  for (const Arrow boundary : kBoundaries)
    for (const char* column : {"_first", "_last", "_items"}) text_ += "," + std::string(info(boundary).name) + column;
  text_ += '\n';
}

void PrimitiveSpans::transfer(Arrow boundary, Cycle cycle) {
  Span& span = span_[index(boundary)];
  if (span.items++ == 0) span.first = cycle;
  span.last = cycle;
}

void PrimitiveSpans::primitive(const HostPrimitive& primitive) {
  write();
  has_primitive_ = true;
  span_ = {};
  head_ = std::to_string(number_++) + "," + std::string(kind_name(primitive.packet.kind)) + ",";
  if (is_counted(primitive.packet.kind)) head_ += std::to_string(primitive.primitive);
  head_ += ",";
  if (primitive.command != HostPrimitive::kNoCommand) head_ += std::to_string(primitive.command);
}

void PrimitiveSpans::write() {
  if (!has_primitive_) return;
  Cycle first = ~Cycle{0}, last = 0;
  std::string columns;
  for (const Arrow boundary : kBoundaries) {
    const Span& span = span_[index(boundary)];
    if (span.items == 0) {
      columns += ",,,0";
      continue;
    }
    first = std::min(first, span.first);
    last = std::max(last, span.last);
    columns += "," + std::to_string(span.first) + "," + std::to_string(span.last) + "," + std::to_string(span.items);
  }
  text_ += head_ + "," + std::to_string(first) + "," + std::to_string(last) + columns + '\n';
}

const std::string& PrimitiveSpans::finish() {
  write();
  has_primitive_ = false;
  return text_;
}

}  // namespace halfplane
