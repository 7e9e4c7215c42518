// JUnit XML: the result format of continuous integration.
#pragma once

#include <string>
#include <vector>

namespace halfplane {

/// A property of a case, or of the whole suite.
struct JunitProperty {
  std::string name, value;
};

struct JunitCase {
  std::string name;
  std::string failure;    ///< one line; empty: passed
  std::string details;    ///< of the failure
  std::string output;     ///< output of a passed case
  std::string skipped{};  ///< why it was not run; empty: it was run
  double seconds = -1;    ///< that it took; negative: not measured
  std::vector<JunitProperty> properties{};
};

/// One test suite as XML. Bytes invalid in XML are replaced.
[[nodiscard]] std::string junit_xml(const std::string& suite, const std::vector<JunitCase>& cases, double seconds,
                                    const std::vector<JunitProperty>& properties = {});

}  // namespace halfplane
