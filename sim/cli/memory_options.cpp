#include "sim/cli/memory_options.hpp"

#include "sim/cli/option_kinds.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane {

void add_memory_options(CLI::App& app, MemorySettings& settings) {
  app.add_option_function<std::string>(
         "--memory",
         [&settings](const std::string& name) {
           try {
             set_memory(settings, name);
           } catch (const InputError& error) {
             throw InputError(std::string("--memory: ") + error.what());
           }
         },
         "memory at the memory port: fixed (ideal), sram, sdram, psram, ddr3; sdram,width=32,mhz=133 is another "
         "SDRAM")
      ->default_str("fixed");
  add_number_option(app, "--memory-latency", settings.latency, 1, 10000,
                    "of the fixed memory: cycles from a read request to its answer");
  add_number_option(app, "--mhz", settings.mhz, 1, 1000,
                    "clock of the hardware: converts its cycles to seconds, and the times of memories to cycles");
}

void add_traffic_options(CLI::App& app, MemorySettings& settings) {
  add_number_option(app, "--scan-out", settings.traffic.scan_out_hz, 0, kMaxScanOutHz,
                    "pictures a second that scan-out reads from the same memory; 0: none")
      ->type_name("HZ");
  add_number_option(app, "--other-traffic", settings.traffic.other_bytes_per_s, 0, kMaxOtherBytes,
                    "bytes a second that other masters read from the same memory; 0: none")
      ->type_name("BYTES/S");
}

std::string memory_arguments(const MemorySettings& settings) {
  const MemorySettings standard;
  std::string text;
  if (settings.kind != standard.kind) text += " --memory " + memory_name(settings);
  if (settings.latency != standard.latency) text += " --memory-latency " + std::to_string(settings.latency);
  if (settings.mhz != standard.mhz) text += " --mhz " + std::to_string(settings.mhz);
  const MemoryTraffic& traffic = settings.traffic;
  if (traffic.scan_out_hz != 0) text += " --scan-out " + std::to_string(traffic.scan_out_hz);
  if (traffic.other_bytes_per_s != 0) text += " --other-traffic " + std::to_string(traffic.other_bytes_per_s);
  return text;
}

Json memory_json(const MemorySettings& settings) {
  const bool is_fixed = settings.kind == MemoryKind::fixed;
  Json json{{"kind", kMemoryKinds[static_cast<std::size_t>(settings.kind)]},
            {"latency", is_fixed ? Json(settings.latency) : Json(nullptr)},
            {"mhz", settings.mhz}};
  if (settings.kind == MemoryKind::sdram) {
    json["width"] = settings.sdram_width;
    json["memory_mhz"] = settings.sdram_mhz;
  }
  if (settings.traffic.scan_out_hz != 0) json["scan_out_hz"] = settings.traffic.scan_out_hz;
  if (settings.traffic.other_bytes_per_s != 0) json["other_bytes_per_s"] = settings.traffic.other_bytes_per_s;
  return json;
}

std::string memory_text(const MemorySettings& settings) {
  std::string text = settings.kind == MemoryKind::fixed
                         ? "fixed, " + std::to_string(settings.latency) + " cycles"
                         : memory_name(settings) + ", the chip at " + std::to_string(settings.mhz) + " MHz";
  const MemoryTraffic& traffic = settings.traffic;
  if (traffic.scan_out_hz != 0) text += ", scan-out at " + std::to_string(traffic.scan_out_hz) + " Hz";
  if (traffic.other_bytes_per_s != 0)
    text += ", " + std::to_string(traffic.other_bytes_per_s) + " bytes/s of other masters";
  return text;
}

}  // namespace halfplane
