#include "sim/utf8.hpp"

namespace halfplane {
namespace {

constexpr bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; }

}  // namespace

char32_t next_code_point(std::string_view text, std::size_t& at) {
  const auto first = static_cast<unsigned char>(text[at++]);
  if (first < 0x80) return first;
  const std::size_t more = first >= 0xf0 && first < 0xf8 ? 3 : first >= 0xe0 ? 2 : 1;
  if (first < 0xc0 || first >= 0xf8) return kNoCodePoint;
  char32_t code = first & (0x3fU >> more);
  for (std::size_t i = 0; i < more; ++i) {
    if (at == text.size() || !continues(text[at])) return kNoCodePoint;
    code = code << 6 | (static_cast<unsigned char>(text[at++]) & 0x3fU);
  }
  constexpr char32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code < kLeast[more] || code > 0x10ffff || is_surrogate ? kNoCodePoint : code;
}

std::size_t without_last_code_point(std::string_view text) {
  std::size_t last = 0;
  for (std::size_t at = 0; at < text.size();) {
    last = at;
    (void)next_code_point(text, at);
  }
  return last;
}

}  // namespace halfplane
