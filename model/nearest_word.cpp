#include "nearest_word.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace halfplane {
namespace {

constexpr std::size_t kLongest = 64;  // letters: a longer word is no typing error, and the distance is quadratic

// Edit distance of two words: insertions, deletions and substitutions (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (letter == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words) {
  if (word.size() < 2 || word.size() > kLongest) return {};
  std::size_t best = word.size() <= 3 ? 1 : word.size() <= 6 ? 2 : word.size() / 3;
  std::string_view nearest;
  for (const std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance > best || (distance == best && !nearest.empty())) continue;
    best = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> words) {
  const std::string_view nearest = nearest_word(word, words);
  return nearest.empty() ? "" : " did you mean " + std::string(nearest) + "?";
}

}  // namespace halfplane
