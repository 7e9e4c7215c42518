// Attributes of frame buffer configurations, which GLX and EGL compare by the same rules (GLX 1.4, 3.3.3; EGL 1.5, 3.4.1),
// and the lists of attributes that their calls take.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>

namespace halfplane::gl {

/// GLX_DONT_CARE and EGL_DONT_CARE.
inline constexpr int kDontCare = -1;

/// Requests of a program, by the attribute's name.
using Wishes = std::map<std::intptr_t, std::intptr_t>;

/// Overwrites values by a list's. False: it names an attribute that `wishes` lacks.
template <std::intptr_t End, class T>
[[nodiscard]] bool read_list(const T* list, Wishes& wishes) {
  for (; list != nullptr && *list != End; list += 2) {
    const auto wish = wishes.find(list[0]);
    if (wish == wishes.end()) return false;
    wish->second = list[1];
  }
  return true;
}

/// How a configuration's value compares with the value that a program asks for. `level`: exactly, kDontCare is a level, too.
enum class Rule { at_least, exact, level, mask, not_compared };

template <class Config>
struct ConfigAttribute {
  int name;
  Rule rule;
  int by_default;  ///< asked for where the program does not say
  int (*value)(const Config&);

  [[nodiscard]] bool fits(const Config& config, std::intptr_t wanted) const {
    if (rule == Rule::not_compared || (wanted == kDontCare && rule != Rule::level)) return true;
    const int has = value(config);
    return rule == Rule::at_least ? has >= wanted : rule == Rule::mask ? (has & wanted) == wanted : has == wanted;
  }
};

/// An attribute whose value all configurations share.
template <int N, class Config>
int constant(const Config&) {
  return N;
}

/// Null: none of that name.
template <class Config, std::size_t N>
[[nodiscard]] const ConfigAttribute<Config>* find_attribute(const ConfigAttribute<Config> (&attributes)[N], int name) {
  const auto* const found = std::ranges::find(attributes, name, &ConfigAttribute<Config>::name);
  return found == std::end(attributes) ? nullptr : found;
}

/// Defaults of a program's requests.
template <class Config, std::size_t N>
[[nodiscard]] Wishes defaults(const ConfigAttribute<Config> (&attributes)[N]) {
  Wishes wishes;
  for (const ConfigAttribute<Config>& a : attributes) wishes[a.name] = a.by_default;
  return wishes;
}

/// Whether a configuration fits `wishes`, which has every attribute. Where they ask for an `id`, nothing else counts.
template <class Config, std::size_t N>
[[nodiscard]] bool fits(const ConfigAttribute<Config> (&attributes)[N], const Config& config, const Wishes& wishes,
                        int id) {
  const bool by_id = wishes.at(id) != kDontCare;
  return std::ranges::all_of(attributes, [&](const ConfigAttribute<Config>& a) {
    return (by_id && a.name != id) || a.fits(config, wishes.at(a.name));
  });
}

}  // namespace halfplane::gl
