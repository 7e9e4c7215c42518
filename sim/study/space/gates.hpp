// Cells of a configuration of the RTL, by Yosys. rtl_ref/area/gates.py does the work and keeps what it found,
// module by module: it is in the folder of the RTL, and ./dev area imports it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/config.hpp"

namespace halfplane {

/// The parts supported by gates.py.
inline const std::vector<std::string> kGateParts{"ecp5", "ice40"};

class Gates {
 public:
  /// `rtl`: the folder of raster_top.sv; empty: that of the installation or of the sources. `cache`: the folder in which
  /// results are kept; empty: halfplane/gates in the user's cache. Throws std::runtime_error, one line, where Yosys,
  /// Python or the RTL is missing.
  Gates(std::string rtl, std::string cache, const std::vector<std::string>& parts);

  /// Cells of the design by part: {"ecp5": {"places", "lut4", "ccu2c", "dpr16x4", "ff", "multipliers", "block_rams"},
  /// "ice40": {"lut4", "carries", "ff", "block_rams"}}. Throws std::runtime_error with Yosys's message, and Interrupted.
  [[nodiscard]] nlohmann::ordered_json of(const Config& config) const;

 private:
  std::string command_;
  std::vector<std::string> parts_;
};

}  // namespace halfplane
