#include "sim/show/trace/primitive_spans.hpp"

#include <algorithm>

namespace halfplane {

std::string_view kind_name(std::uint8_t kind) {
  switch (static_cast<PrimitiveKind>(kind)) {
    case PrimitiveKind::triangle: return "triangle";
    case PrimitiveKind::rectangle: return "rectangle";
    case PrimitiveKind::fast_clear: return "fast_clear";
    case PrimitiveKind::flush: return "flush";
    case PrimitiveKind::point: return "point";
    case PrimitiveKind::line: break;
  }
  return "line";
}

PrimitiveSpans::PrimitiveSpans() : text_("number,kind,primitive,command,first,last") {
  for (const std::string_view name : kBoundaryNames)
    for (const char* column : {"_first", "_last", "_items"}) text_ += "," + std::string(name) + column;
  text_ += '\n';
}

void PrimitiveSpans::transfer(Boundary boundary, Cycle cycle) {
  Span& span = span_[static_cast<std::size_t>(boundary)];
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
  for (const Span& span : span_) {
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
