#include "sim/cosim/report.hpp"

#include <algorithm>

namespace halfplane {
namespace {

constexpr std::size_t kFieldsShown = 8;
constexpr std::size_t kLine = 100;  // characters of a wrapped line

std::string grouped(const std::string& digits) {
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i != 0 && (digits.size() - i) % 4 == 0) text += '_';
    text += digits[i];
  }
  return text;
}

/// Binary up to 32 bits, hex beyond.
std::string digits_of(std::uint64_t value, int bits) {
  const int step = bits <= 32 ? 1 : 4;
  std::string digits;
  for (int low = (bits - 1) / step * step; low >= 0; low -= step)
    digits += "0123456789abcdef"[value >> low & (step == 1 ? 1 : 15)];
  return grouped(digits);
}

std::string marks(const std::string& a, const std::string& b) {
  std::string text;
  for (std::size_t i = 0; i < a.size(); ++i) text += a[i] == b[i] ? ' ' : '^';
  return text.substr(0, text.find_last_of('^') + 1);
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string field_report(const FieldPair& field) {
  const std::string model = digits_of(field.model, field.bits), rtl = digits_of(field.rtl, field.bits);
  const std::string base = field.bits <= 32 ? "" : "0x";
  return "  " + padded(field.name, 18) + "model  " + base + model + "  = " + field.model_text() + "\n" +
         std::string(20, ' ') + "rtl    " + base + rtl + "  = " + field.rtl_text() + "\n" + std::string(27, ' ') +
         std::string(base.size(), ' ') + marks(model, rtl) + "\n";
}

/// "name value, name value ...", wrapped; `rtl` selects the side.
std::string values(const std::vector<FieldPair>& fields, const std::string& title, bool rtl, bool equal_only) {
  std::string text, line = "  " + padded(title, 18);
  const std::string indent(20, ' ');
  bool is_first = true;
  for (const FieldPair& field : fields) {
    if (equal_only && field.differs()) continue;
    const std::string word = (is_first ? "" : ", ") + field.name + " " + (rtl ? field.rtl_text() : field.model_text());
    if (line.size() + word.size() > kLine) {
      text += line + ",\n";
      line = indent + word.substr(is_first ? 0 : 2);
    } else {
      line += word;
    }
    is_first = false;
  }
  return is_first ? "" : text + line + "\n";
}

std::string place(const Mismatch& m) {
  std::string text;
  if (m.primitive) text += ", primitive " + std::to_string(*m.primitive);
  if (m.tile_x && m.tile_y) text += ", tile (" + std::to_string(*m.tile_x) + ", " + std::to_string(*m.tile_y) + ")";
  if (m.stamp) text += ", stamp " + std::to_string(*m.stamp);
  return text + ", cycle " + std::to_string(m.cycle);
}

std::string what(const Mismatch& m) {
  const std::string packet = m.arrow + " packet " + std::to_string(m.number);
  switch (m.kind) {
    case Mismatch::Kind::extra: return packet + " is one that the model does not send";
    case Mismatch::Kind::missing: return packet + " never comes";
    case Mismatch::Kind::protocol: return m.hint;
    case Mismatch::Kind::memory: return "the final memory image differs";
    case Mismatch::Kind::cycle: return packet + " comes in another cycle than the cycle model says";
    case Mismatch::Kind::counters:
    case Mismatch::Kind::differs: break;
  }
  const auto names = m.differing();
  std::string list;
  for (std::size_t i = 0; i < std::min<std::size_t>(4, names.size()); ++i) list += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > 4) list += " and " + std::to_string(names.size() - 4) + " more";
  return (m.kind == Mismatch::Kind::counters ? "counters differ: " : packet + " differs in ") + list;
}

}  // namespace

std::string mismatch_line(const Mismatch& m) { return m.stage + ": " + what(m) + place(m); }

std::string mismatch_report(const Mismatch& m) {
  std::string text = "MISMATCH in " + mismatch_line(m) + "\n";
  if (m.kind != Mismatch::Kind::protocol && !m.hint.empty()) text += "  (" + m.hint + ")\n";
  if (m.kind == Mismatch::Kind::extra) return text + values(m.fields, "rtl", true, false);
  if (m.kind == Mismatch::Kind::missing) return text + values(m.fields, "model", false, false);
  std::size_t shown = 0, differing = 0;
  for (const FieldPair& field : m.fields) {
    if (!field.differs()) continue;
    if (++differing > kFieldsShown) continue;
    text += field_report(field);
    ++shown;
  }
  if (differing > shown) text += "  and " + std::to_string(differing - shown) + " more fields\n";
  return text + values(m.fields, "equal", false, true);
}

std::string compared_report(const LockstepResult& result) {
  std::string text;
  for (const Arrow arrow : kCompared)
    text += std::string(info(arrow).name) + " " + std::to_string(result.compared[index(arrow)]) + ", ";
  return text + "memory " + std::to_string(result.memory_compared) + " stamps, counters " +
         std::to_string(result.counters_compared);
}

std::vector<JunitCase> junit_cases(const LockstepResult& result, const JunitFinding* finding) {
  std::vector<JunitCase> cases;
  const Mismatch* mismatch = finding != nullptr ? &finding->mismatch : result.mismatch ? &*result.mismatch : nullptr;
  const auto fail = [&](JunitCase& c) {
    c.failure = mismatch_line(*mismatch);
    c.details = finding != nullptr ? finding->report : mismatch_report(*mismatch);
  };
  bool has_failed = false;
  const auto add = [&](const std::string& name, std::uint64_t count) {
    cases.push_back({name, {}, {}, std::to_string(count) + " compared"});
    if (result.is_stopped && count == 0) cases.back().skipped = "interrupted before the first";
    if (mismatch == nullptr || mismatch->arrow != name) return;
    fail(cases.back());
    has_failed = true;
  };
  for (const Arrow arrow : kCompared) add(std::string(info(arrow).name), result.compared[index(arrow)]);
  add("memory", result.memory_compared);
  add("counters", result.counters_compared);
  if (mismatch != nullptr && !has_failed) {  // the protocol, or a boundary whose packets are compared elsewhere
    cases.push_back({mismatch->arrow, {}, {}, {}});
    fail(cases.back());
  }
  if (result.total() == 0 && !result.is_stopped) cases.push_back({"anything", "nothing was compared", "", ""});
  return cases;
}

}  // namespace halfplane
