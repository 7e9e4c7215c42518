#include "sim/cosim/junit.hpp"

#include <algorithm>
#include <cstdio>

#include "sim/utf8.hpp"

namespace halfplane {
namespace {

/// XML 1.0 allows no other control characters, and neither U+FFFE nor U+FFFF.
bool is_xml(char32_t c) { return c == '\t' || (c >= ' ' && c != 0x7f && c < 0xfffd) || c > 0xffff; }

std::string escaped(const std::string& text) {
  std::string xml;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = at;
    const char32_t c = next_code_point(text, at);
    switch (c) {
      case '&': xml += "&amp;"; break;
      case '<': xml += "&lt;"; break;
      case '>': xml += "&gt;"; break;
      case '"': xml += "&quot;"; break;
      case '\n': xml += "&#10;"; break;
      default: xml += is_xml(c) ? text.substr(from, at - from) : "?";
    }
  }
  return xml;
}

std::string time_text(double seconds) {
  char time[32];
  std::snprintf(time, sizeof time, "%.3f", seconds);
  return time;
}

std::string properties_xml(const std::vector<JunitProperty>& properties, const std::string& indent) {
  if (properties.empty()) return "";
  std::string xml = indent + "<properties>\n";
  for (const JunitProperty& p : properties)
    xml += indent + "  <property name=\"" + escaped(p.name) + "\" value=\"" + escaped(p.value) + "\"/>\n";
  return xml + indent + "</properties>\n";
}

}  // namespace

std::string junit_xml(const std::string& suite, const std::vector<JunitCase>& cases, double seconds,
                      const std::vector<JunitProperty>& properties) {
  const auto failures =
      std::count_if(cases.begin(), cases.end(), [](const JunitCase& c) { return !c.failure.empty(); });
  const auto skipped = std::count_if(cases.begin(), cases.end(), [](const JunitCase& c) { return !c.skipped.empty(); });
  const std::string name = escaped(suite);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"" + name +
                    "\" tests=\"" + std::to_string(cases.size()) + "\" failures=\"" + std::to_string(failures) +
                    "\" errors=\"0\"" + (skipped > 0 ? " skipped=\"" + std::to_string(skipped) + "\"" : std::string()) +
                    " time=\"" + time_text(seconds) + "\">\n" + properties_xml(properties, "    ");
  for (const JunitCase& c : cases) {
    xml += "    <testcase classname=\"" + name + "\" name=\"" + escaped(c.name) + "\"";
    if (c.seconds >= 0) xml += " time=\"" + time_text(c.seconds) + "\"";
    if (c.failure.empty() && c.output.empty() && c.skipped.empty() && c.properties.empty()) {
      xml += "/>\n";
      continue;
    }
    xml += ">\n" + properties_xml(c.properties, "      ");
    if (!c.skipped.empty()) xml += "      <skipped message=\"" + escaped(c.skipped) + "\"/>\n";
    if (!c.failure.empty())
      xml += "      <failure message=\"" + escaped(c.failure) + "\">" + escaped(c.details) + "</failure>\n";
    if (!c.output.empty()) xml += "      <system-out>" + escaped(c.output) + "</system-out>\n";
    xml += "    </testcase>\n";
  }
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace halfplane
