#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "../../model/timing/memory.hpp"
#include "frame.hpp"

namespace halfplane::gl {
namespace {

/// The configuration of a driver without options: the visual that programs expect, and every unit.
Config plain_config() {
  return labelled(
      "full stencil.bits=8 perspective.colors=1 texture.unit=trilinear texture.constant=1 texture.border=1 "
      "alpha.unit=1 blend.lanes=4 logic.unit=1 fog.unit=1");
}

OnMissing on_missing_of(const std::string& word) {
  const std::map<std::string, OnMissing> words{
      {"host", OnMissing::host}, {"warn", OnMissing::warn}, {"stop", OnMissing::stop}};
  const auto found = words.find(word);
  if (found == words.end()) throw InputError("on_missing: '" + word + "'; give host, warn or stop");
  return found->second;
}

}  // namespace

Options options_from_environment() {
  Options options;
  options.config = plain_config();
  const char* const text = std::getenv("HALFPLANE_GL");
  if (text == nullptr || *text == '\0') return options;
  try {
    const auto json = nlohmann::json::parse(text);
    // {"preset": "embedded", "config": ["depth.bits=20", ...], ...}; every key may be left out.
    if (json.contains("preset")) options.config = preset(json.at("preset").get<std::string>());
    for (const std::string& setting : json.value("config", std::vector<std::string>{})) {
      const std::size_t equals = setting.find('=');
      set(options.config, setting.substr(0, equals), equals == std::string::npos ? "" : setting.substr(equals + 1));
    }
    validate(options.config);
    options.threads = json.value("threads", options.threads);
    options.on_missing = on_missing_of(json.value("on_missing", std::string("warn")));
    options.hud = json.value("hud", options.hud);
    options.cycles = json.value("cycles", options.cycles);
    options.first_frame = json.value("first_frame", options.first_frame);
    options.last_frame = json.value("last_frame", options.last_frame);
    options.mhz = json.value("mhz", options.mhz);
    options.memory = json.value("memory", options.memory);
    options.memory_latency = json.value("memory_latency", options.memory_latency);
    options.save = json.value("save", options.save);
    options.save_to = json.value("save_to", options.save_to);
    options.save_all = json.value("save_all", options.save_all);
    options.results = json.value("results", options.results);
    if (MemorySettings memory; !options.memory.empty()) set_memory(memory, options.memory);
    if (options.threads < 1 || options.threads > 1024 || options.memory_latency < 1)
      throw InputError("threads are 1 to 1024, memory_latency is at least 1");
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("HALFPLANE_GL: ") + error.what());
  } catch (const InputError& error) {
    throw InputError(std::string("HALFPLANE_GL: ") + error.what());
  }
  return options;
}

}  // namespace halfplane::gl
