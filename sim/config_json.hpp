// A configuration as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "model/config.hpp"

namespace halfplane {

/// The preset and every effective value, keyed as in --set.
[[nodiscard]] nlohmann::ordered_json config_json(const Config& config);

}  // namespace halfplane
