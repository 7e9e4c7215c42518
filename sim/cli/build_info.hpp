// The build and the commit of this program.
#pragma once

#include <string_view>

namespace halfplane {

struct BuildInfo {
  std::string_view commit;    ///< abbreviated hash, followed by "+changes" if files differ; "unknown" outside of git
  std::string_view type;      ///< "Release", ...
  std::string_view compiler;  ///< "GNU 12.2.0"
};

[[nodiscard]] const BuildInfo& build_info();

}  // namespace halfplane
