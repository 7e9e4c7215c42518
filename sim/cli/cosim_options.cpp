#include "sim/cli/cosim_options.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <ostream>
#include <tuple>

#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cosim/report.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

/// "out/cosim-teapot.hpt", "out/cosim-random-7.hpt".
std::string default_save_path(const CosimOptions& options) {
  std::string name = options.random != 0    ? "random-" + std::to_string(options.seed)
                     : options.scene == "-" ? "stdin"
                                            : std::filesystem::path(options.scene).stem().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_' && c != '.') c = '-';
  if (options.mutant != 0) name += "-mutant-" + std::to_string(options.mutant);
  return "out/" + std::string(name.starts_with("cosim-") ? "" : "cosim-") + name +
         (options.random == 0 && (options.scene == "-" || options.scene.ends_with(".hpt")) ? "-reduced.hpt" : ".hpt");
}

void create_folder_of(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);  // the later write reports the error
}

/// The shortest text that reads back as the same number.
std::string probability_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

void add_stalls_option(CLI::App& app, CosimOptions& options) {
  add_real_option(app, "--stalls", options.stalls, 0.0, 0.95,
                  "probability with which each stream is held back in a cycle")
      ->capture_default_str();
}

void add_cosim_options(CLI::App& app, CosimOptions& options) {
  add_stalls_option(app, options);
  add_memory_options(app, options.memory);
  add_traffic_options(app, options.memory);
  add_number_option(app, "--mutant", options.mutant, 0, 65535,
                    "switch on one of the RTL's built-in faults, 0 for none");
  app.add_flag(
      "--ignore-cycles", options.ignores_cycles,
      "compare every bit, but not the cycles of the packets: for a stage with another latency (docs/your-rtl.md)");
  add_number_option(app, "--resets", options.resets, 0, 1000,
                    "number of times that each scene is started and cut off by a reset before it runs");
  add_file_option(app, "--trace", options.trace_path,
                  "waveform, .fst: around a mismatch (default: next to the saved capture); with cosim also of a run "
                  "without a mismatch",
                  ".fst");
}

const DutFactory& dut_for(const CosimOptions& options, const Config& config) {
  if (options.skip != "all") throw InputError("--skip: hardware skips by its own rules; leave it out");
  const std::tuple<std::string, bool, const char*> of_scenes[]{
      {"--size", !options.size.empty(), "have sizes of their own"},
      {"--camera", !options.camera.empty(), "have no camera"},
      {"--light", !options.lights.empty(), "have no lights"},
      {"--transform", options.transform != "binary64", "are in window space"}};
  for (const auto& [name, is_given, what] : of_scenes)
    if (options.random != 0 && is_given)
      throw InputError(std::string(name)
                           .append(": the scenes of --random ")
                           .append(what)
                           .append("; leave ")
                           .append(name)
                           .append(" out, or give a SCENE in place of --random"));
  if (options.trace_path == "-") throw InputError("--trace: a waveform cannot go to stdout; give a file, .fst");
  const DutFactory& factory = find_dut(config);
  if (options.mutant != 0 && !factory.has_mutants)
    throw InputError("--mutant: the RTL of " + factory.name + " has no mutants; use --config embedded");
  const auto all = mutants();
  const bool is_known = std::any_of(all.begin(), all.end(), [&](const Mutant& m) { return m.id == options.mutant; });
  if (options.mutant != 0 && !is_known)
    throw InputError("--mutant: no mutant has the number " + std::to_string(options.mutant) + "; give 1 to " +
                     std::to_string(all.empty() ? 0 : all.back().id) + ", or 0 for none");
  return factory;
}

LockstepOptions lockstep_options(const CosimOptions& options) {
  LockstepOptions lockstep;
  lockstep.seed = options.seed;
  lockstep.stall_probability = options.stalls;
  lockstep.memory = options.memory;
  lockstep.compares_cycles = !options.ignores_cycles;
  lockstep.resets = options.resets;
  lockstep.mutant = static_cast<std::uint16_t>(options.mutant);
  return lockstep;
}

std::string repeat_command(const CosimOptions& options, const Config& config, const std::string& capture,
                           const LockstepOptions& lockstep) {
  std::string command = program_word() + " cosim";
  if (!capture.empty()) {
    Config mapped = config;
    mapped.depth_mapping = DepthMapping::projection;  // a saved capture is mapped already, and has a size
    command += " " + quoted(capture) + config_arguments(mapped);
  } else {
    command += options.random != 0 ? random_arguments(options) : " " + quoted(options.scene);
    command += scene_arguments(options, config);
  }
  command += " --seed " + std::to_string(lockstep.seed);
  if (lockstep.stall_probability != 0) command += " --stalls " + probability_text(lockstep.stall_probability);
  command += memory_arguments(lockstep.memory);
  if (lockstep.resets != 0) command += " --resets " + std::to_string(lockstep.resets);
  if (!lockstep.compares_cycles) command += " --ignore-cycles";
  if (lockstep.mutant != 0) command += " --mutant " + std::to_string(lockstep.mutant);
  return command;
}

std::string save_scene(const CosimOptions& options, const Scene& scene) {
  std::string path = options.save_path.empty() ? default_save_path(options) : options.save_path;
  if (options.save_path.empty()) create_folder_of(path);
  write_text_file(path, capture_text(scene));
  return path;
}

SavedFinding save_finding(const CosimOptions& options, const Config& config, Dut& dut, const Scene& failed,
                          const Mismatch& mismatch, double seconds) {
  SavedFinding saved;
  saved.capture = options.save_path.empty() ? default_save_path(options) : options.save_path;
  if (options.save_path.empty()) create_folder_of(saved.capture);
  saved.trace = options.trace_path;
  if (saved.trace.empty() && saved.capture != "-")
    saved.trace = std::filesystem::path(saved.capture).replace_extension(".fst").string();
  Progress progress(options, "reducing");
  ReduceOptions reducing;
  reducing.seconds = seconds;
  reducing.progress = [&progress](double fraction) { progress(fraction); };
  saved.finding = investigate(dut, config, lockstep_options(options), failed, mismatch, saved.trace, reducing);
  if (!saved.finding.has_trace) saved.trace.clear();
  try {
    write_text_file(saved.capture, capture_text(saved.finding.scene));
  } catch (const std::exception& error) {  // the mismatch is worth more than the file
    saved.failure = error.what();
  }
  // A scene that does not fail alone, or a missing capture, cannot be repeated. A capture on stdout can only be
  // repeated from the caller's file, the scene on stdin likewise.
  const bool has_capture = saved.failure.empty() && (saved.finding.reduced || options.random == 0) &&
                           (saved.capture != "-" || options.scene == "-");
  saved.repeat = repeat_command(options, has_capture ? config : effective_config(options),
                                has_capture ? saved.capture : std::string(),
                                has_capture ? saved.finding.lockstep : lockstep_options(options));
  return saved;
}

void print_finding(std::ostream& out, const SavedFinding& saved) {
  const Finding& f = saved.finding;
  out << mismatch_report(f.mismatch) << "  saved     "
      << (saved.failure.empty() ? saved.capture : "nothing (" + saved.failure + ")");
  if (f.reduced)
    out << ", " << f.reduced->primitives_after << " of " << f.reduced->primitives_before << " primitives ("
        << f.reduced->runs << " runs"
        << (f.reduced->is_minimal ? ""
            : is_interrupted()    ? "; interrupted, it may get smaller"
                                  : "; out of time, it may get smaller")
        << ")\n";
  else
    out << (f.is_stopped ? ", the whole scene: interrupted before it was reduced\n"
                         : ", the whole scene: after a reset it does not fail alone\n");
  out << "  waveform  "
      << (saved.trace.empty() && is_interrupted()       ? "none: interrupted"
          : saved.trace.empty() && saved.capture == "-" ? "none beside a capture on stdout: add --trace FILE.fst"
          : !f.trace_failure.empty()                    ? "none: " + f.trace_failure
          : saved.trace.empty()                         ? "none: this design is built without tracing"
                                : saved.trace + ", mismatch at time " + std::to_string(2 * f.mismatch.cycle))
      << '\n'
      << "  repeat    " << saved.repeat << '\n';
}

Json mismatch_json(const Mismatch& m, const std::string& repeat) {
  Json fields = Json::array();
  for (const FieldPair& field : m.fields)
    if (field.differs())
      fields.push_back({{"name", field.name}, {"model", field.model_text()}, {"rtl", field.rtl_text()}});
  constexpr std::array kKinds{"differs", "extra", "missing", "memory", "counters", "protocol", "cycle"};
  return {{"stage", m.stage},
          {"arrow", m.arrow},
          {"kind", kKinds[static_cast<std::size_t>(m.kind)]},
          {"key",
           {{"primitive", m.primitive},
            {"tile_x", m.tile_x},
            {"tile_y", m.tile_y},
            {"stamp", m.stamp},
            {"packet", m.number}}},
          {"cycle", m.cycle},
          {"fields", fields},
          {"repro", repeat}};
}

}  // namespace halfplane
