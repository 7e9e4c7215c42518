// Proofs by enumeration: every case of a claim at the widths of `tiny`, through the functions of model/stages.
//
// Each counts its cases, and must find the claim broken once the rule is. By itself each takes a second or two; with
// HALFPLANE_EXHAUSTIVE=whole (./dev prove) the ranges are wider. docs/proofs.md says which claims follow.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "model/config.hpp"
#include "model/packets/packets.hpp"
#include "model/widths.hpp"

namespace halfplane::test {

inline bool is_whole() {
  const char* text = std::getenv("HALFPLANE_EXHAUSTIVE");
  return text != nullptr && std::string_view(text) == "whole";
}

/// One line for tools/prove.py, which looks for its beginning.
inline void report_proof(const char* claim, std::uint64_t cases) {
  std::printf("proof: %s: %llu cases\n", claim, static_cast<unsigned long long>(cases));
  testing::Test::RecordProperty("cases", std::to_string(cases));
}

inline const Config& tiny() {
  static const Config config = preset("tiny");
  return config;
}

inline const Widths& tiny_widths() {
  static const Widths widths = derive_widths(tiny());
  return widths;
}

inline SnappedVertex vertex_at(int x, int y) {
  SnappedVertex v;
  v.x = x;
  v.y = y;
  return v;
}

}  // namespace halfplane::test
