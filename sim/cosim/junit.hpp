// JUnit XML: what continuous integration reads.
#pragma once

#include <string>
#include <vector>

namespace halfplane {

struct JunitCase {
  std::string name;
  std::string failure;    ///< one line; empty: passed
  std::string details;    ///< of the failure
  std::string output;     ///< what a passed case has to say
  std::string skipped{};  ///< why it was not run; empty: it was
};

/// What holds for the whole suite.
struct JunitProperty {
  std::string name, value;
};

/// One test suite as XML. Bytes that XML cannot hold are replaced.
[[nodiscard]] std::string junit_xml(const std::string& suite, const std::vector<JunitCase>& cases, double seconds,
                                    const std::vector<JunitProperty>& properties = {});

}  // namespace halfplane
