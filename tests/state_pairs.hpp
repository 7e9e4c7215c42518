// Scenes in which every pair of values of two draw states (sim/cover/state_pairs.hpp) is drawn, in as few draws as a greedy
// choice takes.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "model/config.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cover/state_pairs.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::test {

using cover::Dimension;
using cover::is_possible;
using cover::PairCounts;

/// Without the colours of a texture unit: `stencilled` has neither a constant nor a border.
inline std::vector<Dimension> dimensions() {
  std::vector<Dimension> all = cover::dimensions();
  for (Dimension& one : all) {
    if (one.name == "texture_combine") one.values = 4;
    if (one.row == "texture_wrap") one.values = 3;
  }
  return all;
}

/// Values of all states, a row a draw, so that each pair is in some row: the first missing pair, then state by state
/// the value that adds most of the missing pairs.
inline std::vector<std::vector<int>> pair_rows(const std::vector<Dimension>& all, std::uint64_t seed) {
  halfplane::Random random(seed);
  PairCounts counts(all);
  std::vector<std::vector<int>> rows;
  constexpr int kUnset = -2;
  const auto index_of = [&all](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(all, name, &Dimension::name) - all.begin());
  };
  while (true) {
    std::vector<int> row(all.size(), kUnset);
    bool is_missing = false;
    counts.for_each([&](std::size_t a, int va, std::size_t b, int vb, std::size_t times) {
      if (times != 0 || is_missing) return;
      is_missing = true;
      row[a] = va;
      row[b] = vb;
    });
    if (!is_missing) return rows;
    for (std::size_t n = 0; n < all.size(); ++n)
      if (row[n] >= 0 && !all[n].part_of.empty()) row[index_of(all[n].part_of)] = 1;
    std::vector<std::size_t> order;  // parts in order, after the commands before them
    for (const bool parts : {false, true}) {
      const auto first = static_cast<std::ptrdiff_t>(order.size());
      for (std::size_t n = 0; n < all.size(); ++n)
        if (all[n].part_of.empty() != parts) order.push_back(n);
      for (auto n = static_cast<std::size_t>(first); n < order.size(); ++n)
        std::swap(order[n], order[n + random.next() % (order.size() - n)]);
    }
    for (const std::size_t n : order) {
      if (row[n] != kUnset) continue;
      std::size_t best = 0, ties = 0;
      for (int v = 0; v < all[n].values; ++v) {
        bool fits = true;
        std::size_t gain = 1;
        for (std::size_t m = 0; m < all.size() && fits; ++m) {
          if (m == n || row[m] < 0) continue;
          fits = is_possible(all[n], v, all[m], row[m]);
          if (fits && counts.times(n, v, m, row[m]) == 0) ++gain;
        }
        if (!fits || gain < best) continue;
        ties = gain > best ? 1 : ties + 1;
        best = gain;
        if (random.next() % ties == 0) row[n] = v;
      }
      if (row[n] == kUnset) row[n] = -1;  // a part of a disabled unit
    }
    counts.add(row);
    rows.push_back(std::move(row));
  }
}

/// Random scenes of 150 primitives whose draws have the values of the rows, one row a draw.
inline std::vector<Scene> paired_scenes(const Config& config, const std::vector<Dimension>& all, std::uint64_t seed) {
  const auto rows = pair_rows(all, seed);
  std::vector<Scene> scenes;
  for (std::size_t next = 0; next < rows.size(); ++seed) {
    Scene scene = random_scene(config, seed, 150);
    scene.name = "paired-" + std::to_string(seed);
    for (const Command& command : scene.commands) {
      const auto* draw = std::get_if<Draw>(&command);
      if (draw == nullptr || next == rows.size()) continue;
      State& state = scene.states[draw->state];
      for (std::size_t n = 0; n < all.size(); ++n)
        if (rows[next][n] >= 0 && all[n].part_of.empty()) all[n].set(state, rows[next][n]);
      for (std::size_t n = 0; n < all.size(); ++n)
        if (rows[next][n] >= 0 && !all[n].part_of.empty()) all[n].set(state, rows[next][n]);
      ++next;
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace halfplane::test
