#include "config_json.hpp"

namespace halfplane {

nlohmann::ordered_json config_json(const Config& config) {
  nlohmann::ordered_json json{{"preset", config.preset}};
  for (const Setting& setting : settings()) {
    const std::string value = get(config, setting);
    if (setting.is_number())
      json[std::string(setting.key)] = std::stoi(value);
    else
      json[std::string(setting.key)] = value;
  }
  return json;
}

}  // namespace halfplane
