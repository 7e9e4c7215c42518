// The packets of an arrow, field by field, in model and RTL.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/packets/packets.hpp"
#include "model/pipeline_graph.hpp"

namespace halfplane {

/// One element of a packet on both sides.
struct FieldPair {
  std::string name;  ///< "mask", "edge_value[2]"
  int bits = 0;
  bool is_signed = false;
  std::uint64_t model = 0, rtl = 0;  ///< raw bits

  [[nodiscard]] bool differs() const { return model != rtl; }
  [[nodiscard]] std::string model_text() const;  ///< as a decimal number
  [[nodiscard]] std::string rtl_text() const;
};

/// Every element of a packet type, from the packed words of both sides.
template <class Packet>
[[nodiscard]] std::vector<FieldPair> field_pairs(const Widths& widths, const std::uint32_t* model,
                                                 const std::uint32_t* rtl);

/// The same for the packet type of an arrow.
[[nodiscard]] std::vector<FieldPair> field_pairs(Arrow arrow, const Widths& widths, const std::uint32_t* model,
                                                 const std::uint32_t* rtl);

}  // namespace halfplane
