#include "sim/cli/memory_options.hpp"

namespace halfplane {
namespace {

std::string name_of(MemoryKind kind) { return std::string(kMemoryKinds[static_cast<std::size_t>(kind)]); }

}  // namespace

void add_memory_options(CLI::App& app, MemorySettings& settings) {
  app.add_option_function<std::string>(
         "--memory",
         [&settings](const std::string& name) {
           try {
             settings.kind = memory_kind(name);
           } catch (const InputError& error) {
             throw InputError(std::string("--memory: ") + error.what());
           }
         },
         "what is behind the memory port: fixed (ideal), sram, sdram, psram, ddr3")
      ->default_str("fixed");
  app.add_option("--memory-latency", settings.latency, "of the fixed memory: cycles from a read request to its answer")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--mhz", settings.mhz,
                 "clock of the hardware: turns cycles into seconds, and those of memories into cycles")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

std::string memory_arguments(const MemorySettings& settings) {
  const MemorySettings standard;
  std::string text;
  if (settings.kind != standard.kind) text += " --memory " + name_of(settings.kind);
  if (settings.latency != standard.latency) text += " --memory-latency " + std::to_string(settings.latency);
  if (settings.mhz != standard.mhz) text += " --mhz " + std::to_string(settings.mhz);
  return text;
}

Json memory_json(const MemorySettings& settings) {
  const bool is_fixed = settings.kind == MemoryKind::fixed;
  return {{"kind", name_of(settings.kind)},
          {"latency", is_fixed ? Json(settings.latency) : Json(nullptr)},
          {"mhz", settings.mhz}};
}

std::string memory_text(const MemorySettings& settings) {
  if (settings.kind == MemoryKind::fixed) return "fixed, " + std::to_string(settings.latency) + " cycles";
  return name_of(settings.kind) + ", the chip at " + std::to_string(settings.mhz) + " MHz";
}

}  // namespace halfplane
