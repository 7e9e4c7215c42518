#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "model/engines/functional.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/cosim_options.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cosim/rtl_engine.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/show/image/framebuffer_files.hpp"

namespace halfplane {
namespace {

struct MutantsCommand : CosimOptions {
  bool scenes = false;
  std::vector<int> only;  ///< numbers of mutants; none: all
};

/// The mutants that are asked for, in the order of their list.
std::vector<Mutant> asked_for(const MutantsCommand& options) {
  if (options.only.empty()) return {mutants().begin(), mutants().end()};
  std::vector<Mutant> some;
  for (const Mutant& mutant : mutants())
    if (std::ranges::find(options.only, mutant.id) != options.only.end()) some.push_back(mutant);
  for (const int id : options.only)
    if (std::ranges::find(some, id, &Mutant::id) == some.end())
      throw InputError("--only: there is no mutant " + std::to_string(id) + "; without it `mutants` lists all");
  return some;
}

/// A built-in scene and the model's picture of it.
struct ModelPicture {
  Scene scene;
  std::string color, depth;      ///< hashes
  std::uint64_t cycles = ~0ULL;  ///< limit: four times the RTL's own
};

/// One seeded fault and its result.
struct Verdict {
  Mutant mutant;
  std::optional<Mismatch> mismatch;
  std::vector<std::string> pictures;  ///< scenes with different colour or depth, or that never end
};

std::vector<ModelPicture> model_pictures(const MutantsCommand& options, const Config& config) {
  std::vector<ModelPicture> pictures;
  CommonOptions request = options;
  for (const Builtin& builtin : builtin_scenes()) {
    request.scene = builtin.name;
    double load_s = 0;
    ModelPicture picture;
    picture.scene = load_scene(request, config, load_s);
    check_hardware_scene(picture.scene, config);
    const Rendering model = render_functional(picture.scene, config, {});
    picture.color = color_hash(model.frame, config.color_format);
    picture.depth = depth_hash(model.frame);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

bool shows(Dut& dut, const Config& config, const ModelPicture& picture, std::uint16_t mutant) {
  const auto [frame, cycles] = render_faulty(dut, picture.scene, config, mutant, picture.cycles);
  return frame && color_hash(*frame, config.color_format) == picture.color && depth_hash(*frame) == picture.depth;
}

/// Results of the random run on another design that has mutants, and parts that this one lacks.
std::optional<Mismatch> elsewhere(const LockstepOptions& options, const DutFactory& here, std::uint64_t random) {
  for (const DutFactory& factory : verilated_duts()) {
    if (!factory.has_mutants || factory.name == here.name) continue;
    const std::unique_ptr<Dut> dut = make_dut(factory);
    const auto scenes = random_scenes(factory.config, options.seed, random);
    if (const Session session = run_session(*dut, factory.config, options, scenes, HostOrders::drawn);
        session.result.mismatch)
      return session.result.mismatch;
  }
  return {};
}

/// Throws Interrupted.
Verdict judge(const MutantsCommand& options, const DutFactory& factory, Dut& dut, const Mutant& mutant,
              const std::vector<ModelPicture>& pictures) {
  const Config& config = factory.config;
  LockstepOptions lockstep = lockstep_options(options);
  lockstep.progress = [](double) {
    stop_if_interrupted();
    return true;
  };
  lockstep.mutant = static_cast<std::uint16_t>(mutant.id);
  const Session session =
      run_session(dut, config, lockstep, random_scenes(config, options.seed, options.random), HostOrders::drawn);
  Verdict verdict{mutant, session.result.mismatch, {}};
  if (!verdict.mismatch) verdict.mismatch = elsewhere(lockstep, factory, options.random);
  for (const ModelPicture& picture : pictures) {
    stop_if_interrupted();
    if (!shows(dut, config, picture, lockstep.mutant)) verdict.pictures.push_back(picture.scene.name);
  }
  return verdict;
}

std::string scenes_text(const std::vector<std::string>& names) {
  return names.empty() ? "none" : names.size() == builtin_scenes().size() ? "all" : joined(names, " ");
}

std::string column(const std::string& text, std::size_t width) { return left_aligned(text, width) + "  "; }

std::string stage_of(const Mutant& mutant) { return std::filesystem::path(mutant.file).stem().string(); }

/// Place of the difference: "setup step_x[depth]", "counters tiles_hiz +1", "tile never comes".
std::string where(const Mismatch& m) {
  const auto fields = m.differing();
  const std::string more = fields.size() > 1 ? " +" + std::to_string(fields.size() - 1) : "";
  const std::string what = m.kind == Mismatch::Kind::extra      ? "one too many"
                           : m.kind == Mismatch::Kind::missing  ? "never comes"
                           : m.kind == Mismatch::Kind::protocol ? "broken"
                           : m.kind == Mismatch::Kind::cycle    ? "other cycle"
                           : fields.empty()                     ? ""
                                                                : fields.front() + more;
  return m.arrow + " " + what;
}

void print_table(std::ostream& out, const std::vector<Verdict>& verdicts, bool has_pictures) {
  out << right_aligned("id", 3) + "  " << column("where", 14) << column("caught in", 30)
      << right_aligned("cycle", 9) + "  " << (has_pictures ? column("pictures changed", 41) : "") << "what is wrong\n";
  for (const Verdict& v : verdicts)
    out << right_aligned(std::to_string(v.mutant.id), 3) + "  " << column(stage_of(v.mutant), 14)
        << column(v.mismatch ? where(*v.mismatch) : "NOT CAUGHT", 30)
        << right_aligned(v.mismatch ? with_commas(v.mismatch->cycle) : "", 9) + "  "
        << (has_pictures ? column(scenes_text(v.pictures), 41) : "") << v.mutant.what << '\n';
}

Json verdict_json(const Verdict& v, bool has_pictures) {
  Json row{{"id", v.mutant.id}, {"file", v.mutant.file}, {"what", v.mutant.what}, {"caught", v.mismatch.has_value()}};
  row["stage"] = v.mismatch ? Json(v.mismatch->stage) : Json(nullptr);
  row["arrow"] = v.mismatch ? Json(v.mismatch->arrow) : Json(nullptr);
  row["fields"] = v.mismatch ? Json(v.mismatch->differing()) : Json::array();
  row["cycle"] = v.mismatch ? Json(v.mismatch->cycle) : Json(nullptr);
  if (has_pictures) row["pictures"] = v.pictures;
  return row;
}

/// Every picture of the design as it is must be the model's: otherwise no change could be blamed on a mutant. With one it
/// gets four times the cycles.
void check_pictures(const MutantsCommand& options, const Config& config, Dut& dut,
                    std::vector<ModelPicture>& pictures) {
  for (ModelPicture& picture : pictures) {
    const auto [frame, cycles] = render_faulty(dut, picture.scene, config, 0, ~0ULL);
    picture.cycles = 4 * cycles;
    if (!frame || color_hash(*frame, config.color_format) != picture.color || depth_hash(*frame) != picture.depth)
      throw std::runtime_error("without a mutant the RTL shows another picture of " + picture.scene.name +
                               " than the model; run " + program_word() + " cosim " + picture.scene.name +
                               config_arguments(config) + " --size " + quoted(options.size));
  }
}

int run(const MutantsCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  const std::vector<Mutant> asked = asked_for(options);
  const DutFactory& factory = find_dut(config);
  if (!factory.has_mutants) throw InputError("the RTL of " + factory.name + " has no mutants; use --config embedded");
  const std::unique_ptr<Dut> dut = make_dut(factory);
  std::vector<ModelPicture> pictures = options.scenes ? model_pictures(options, config) : std::vector<ModelPicture>();
  check_pictures(options, config, *dut, pictures);

  std::vector<Verdict> verdicts;
  {
    Progress progress(options, "running mutants");
    try {
      for (const Mutant& mutant : asked) {
        progress(static_cast<double>(verdicts.size()) / static_cast<double>(asked.size()));
        verdicts.push_back(judge(options, factory, *dut, mutant, pictures));
      }
    } catch (const Interrupted&) {  // the verdicts so far are kept
    }
  }
  const bool is_partial = is_interrupted();
  const auto caught = std::count_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.mismatch; });
  const auto unseen =
      std::count_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.pictures.empty(); });
  const bool all_caught = static_cast<std::size_t>(caught) == verdicts.size();

  Json result = result_head("mutants", options, config);
  result["seed"] = options.seed;
  result["random"] = options.random;
  result["stalls"] = options.stalls;
  result["caught"] = caught;
  result["pictures_unchanged"] = options.scenes ? Json(unseen) : Json(nullptr);
  result["mutants"] = Json::array();
  for (const Verdict& verdict : verdicts) result["mutants"].push_back(verdict_json(verdict, options.scenes));
  finish_json(options, result, start, is_partial);

  std::ostream& out = human(options);
  print_table(out, verdicts, options.scenes);
  out << caught << " of " << verdicts.size() << " mutants caught by " << with_commas(options.random)
      << " random primitives, " << label(config) << ", seed " << options.seed << ", stalls " << fixed(options.stalls, 2)
      << '\n';
  if (options.scenes)
    out << unseen << " of them change no picture of the " << pictures.size() << " built-in scenes at " << options.size
        << ": only the comparison of packets and counters shows them\n";
  return ended(out, is_partial, all_caught ? exit_ok : exit_mismatch);
}

}  // namespace

void add_mutants_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<MutantsCommand>(
      app, selected, "mutants", "seeded faults of the RTL, each of which co-simulation must catch", run);
  options->random = 6000;
  options->stalls = 0.2;
  options->size = "160x120";
  add_output_options(*command, *options);
  add_seed_option(*command, *options, "seed of the random run and its stalls");
  add_number_option(*command, "--random", options->random, std::uint64_t{1}, std::uint64_t{1'000'000},
                    "primitives of the random run");
  add_stalls_option(*command, *options);
  command->add_option("--only", options->only, "these mutants alone: numbers with commas")
      ->delimiter(',')
      ->type_name("LIST");
  command->add_flag("--scenes", options->scenes, "also says which pictures of the built-in scenes each mutant changes");
  command->add_option("--size", options->size, "of these pictures, WxH pixels")->capture_default_str();
  command->footer("\nExit status 1 when a mutant is not caught.\n\nExample:\n  halfplane mutants --json=mutants.json");
}

}  // namespace halfplane
