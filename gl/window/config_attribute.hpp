// Attributes of frame buffer configurations, which GLX and EGL compare by the same rules (GLX 1.4, 3.3.3; EGL 1.5, 3.4.1).
#pragma once

#include <algorithm>
#include <span>

namespace halfplane::gl {

/// GLX_DONT_CARE and EGL_DONT_CARE.
inline constexpr int kDontCare = -1;

/// How a configuration's value compares with the one that a program asks for. `level`: exactly, kDontCare is a level, too.
enum class Rule { at_least, exact, level, mask, not_compared };

template <class Config>
struct ConfigAttribute {
  int name;
  Rule rule;
  int by_default;  ///< asked for where the program does not say
  int (*value)(const Config&);

  [[nodiscard]] bool fits(const Config& config, int wanted) const {
    if (rule == Rule::not_compared || (wanted == kDontCare && rule != Rule::level)) return true;
    const int has = value(config);
    return rule == Rule::at_least ? has >= wanted : rule == Rule::mask ? (has & wanted) == wanted : has == wanted;
  }
};

/// Null: none of that name.
template <class Config, std::size_t N>
[[nodiscard]] const ConfigAttribute<Config>* find_attribute(const ConfigAttribute<Config> (&attributes)[N], int name) {
  const auto* const found = std::ranges::find(attributes, name, &ConfigAttribute<Config>::name);
  return found == std::end(attributes) ? nullptr : found;
}

/// Whether a configuration fits a map of what a program asks for, by name. Where it asks for an `id`, nothing else counts.
template <class Config, std::size_t N, class Wishes>
[[nodiscard]] bool fits(const ConfigAttribute<Config> (&attributes)[N], const Config& config, const Wishes& wishes,
                        int id) {
  const auto wished_id = wishes.find(id);
  const bool by_id = wished_id != wishes.end() && wished_id->second != kDontCare;
  return std::ranges::all_of(attributes, [&](const ConfigAttribute<Config>& a) {
    const auto wish = wishes.find(a.name);
    const int wanted = wish == wishes.end() ? a.by_default : static_cast<int>(wish->second);
    return (by_id && a.name != id) || a.fits(config, wanted);
  });
}

}  // namespace halfplane::gl
