#include <ostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/coverage_option.hpp"
#include "sim/cli/explain_output.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/options.hpp"
#include "sim/cosim/junit.hpp"
#include "sim/cover/collector.hpp"
#include "sim/vectors/check.hpp"
#include "sim/vectors/vector_file.hpp"

namespace halfplane {
namespace {

struct CheckOptions : CommonOptions {
  std::string stage, file, vectors, junit, coverage;
};

/// The file to judge: with --vectors the input comes from that file, and the output from FILE.
vectors::VectorFile checked_file(const CheckOptions& options) {
  vectors::VectorFile file = vectors::read_vectors(options.file, options.vectors.empty());
  if (!options.vectors.empty()) {
    vectors::VectorFile given = vectors::read_vectors(options.vectors);
    if (given.stage != file.stage || given.config != file.config)
      throw InputError(options.file + " and " + options.vectors +
                       " have different headers; make both from one run of `halfplane vectors`");
    file.packets.in = std::move(given.packets.in);
  }
  const std::string_view name = info(file.stage->stage).name;
  if (name != options.stage)
    throw InputError("--stage " + options.stage + ", but " + options.file + " has vectors of " + std::string(name) +
                     "; give --stage " + std::string(name));
  return file;
}

std::string difference_text(const vectors::JudgedStage& stage, const vectors::FirstDifference& first) {
  for (const vectors::FieldDifference& field : first.fields)
    if (field.undefined != 0)
      return "undefined bits in field " + field.name + " of " + std::string(stage.out[first.port].name) + " " +
             std::to_string(first.number);
  return std::string(stage.out[first.port].name) + " " + std::to_string(first.number) + " " +
         std::string(first.kind == vectors::FirstDifference::Kind::differs   ? "differs"
                     : first.kind == vectors::FirstDifference::Kind::missing ? "is missing"
                                                                             : "is too much: nothing comes there");
}

std::string field_text(const vectors::FieldDifference& field) {
  if (field.undefined != 0)
    return left_aligned(field.name, 24) + "expected " + explain::hex_text(field.expected, field.bits) +
           "  got x or z in bits " + explain::hex_text(field.undefined, field.bits);
  const std::uint64_t flipped = field.expected ^ field.got;
  return left_aligned(field.name, 24) + "expected " + explain::hex_text(field.expected, field.bits) + "  got " +
         explain::hex_text(field.got, field.bits) + "  bits " + explain::hex_text(flipped, field.bits);
}

Json judgement_json(const vectors::JudgedStage& stage, const vectors::Judgement& judgement) {
  Json json{{"in", Json::object()}, {"out", Json::object()}, {"differing", Json::object()}};
  for (std::size_t p = 0; p < stage.in.size(); ++p) json["in"][std::string(stage.in[p].name)] = judgement.in[p];
  for (std::size_t p = 0; p < stage.out.size(); ++p) {
    json["out"][std::string(stage.out[p].name)] = judgement.compared[p];
    json["differing"][std::string(stage.out[p].name)] = judgement.differing[p];
  }
  json["mismatches"] = judgement.total_differing();
  json["first_mismatch"] = nullptr;
  if (!judgement.first) return json;
  Json fields = Json::array();
  for (const auto& [name, bits, expected, got, undefined] : judgement.first->fields) {
    fields.push_back({{"field", name},
                      {"bits", bits},
                      {"expected", explain::hex_text(expected, bits)},
                      {"got", explain::hex_text(got, bits)}});
    if (undefined != 0) fields.back()["undefined"] = explain::hex_text(undefined, bits);
  }
  json["first_mismatch"] = {{"kind", vectors::kDifferenceKinds[static_cast<std::size_t>(judgement.first->kind)]},
                            {"packet", stage.out[judgement.first->port].name},
                            {"n", judgement.first->number},
                            {"fields", fields},
                            {"hint", or_null(judgement.first->hint)}};
  return json;
}

void write_check_junit(const CheckOptions& options, const vectors::VectorFile& file,
                       const vectors::Judgement& judgement, const Json& result) {
  if (options.junit.empty()) return;
  std::vector<JunitCase> cases;
  for (std::size_t p = 0; p < file.stage->out.size(); ++p) {
    JunitCase& one = cases.emplace_back();
    one.name = std::string(file.stage->out[p].name);
    one.output = with_commas(judgement.compared[p]) + " packets compared";
    if (judgement.compared[p] == 0 && judgement.total_compared() == 0) one.failure = "nothing was compared";
    if (judgement.differing[p] == 0) continue;
    one.output.clear();
    one.failure = with_commas(judgement.differing[p]) + " of " + with_commas(judgement.compared[p]) + " packets differ";
    if (judgement.first && judgement.first->port == p) {
      one.failure += "; first: " + difference_text(*file.stage, *judgement.first);
      for (const auto& field : judgement.first->fields) one.details += field_text(field) + "\n";
    }
  }
  write_junit(options.junit, "check." + options.stage, cases, result["wall_s"], result, &file.config);
}

void print_judgement(std::ostream& out, const vectors::VectorFile& file, const vectors::Judgement& judgement) {
  const vectors::JudgedStage& stage = *file.stage;
  out << info(stage.stage).name << ", " << label(file.config) << ": took";
  for (std::size_t p = 0; p < stage.in.size(); ++p)
    out << (p == 0 ? " " : ", ") << with_commas(judgement.in[p]) << ' ' << stage.in[p].name;
  out << "; compared";
  for (std::size_t p = 0; p < stage.out.size(); ++p)
    out << (p == 0 ? " " : ", ") << with_commas(judgement.compared[p]) << ' ' << stage.out[p].name;
  out << '\n';
  if (judgement.first) {
    out << "DIFFERENT  " << with_commas(judgement.total_differing())
        << " packets; the first: " << difference_text(stage, *judgement.first) << '\n';
    for (const auto& field : judgement.first->fields) out << "  " << field_text(field) << '\n';
    if (!judgement.first->hint.empty()) out << "  " << judgement.first->hint << '\n';
    return;
  }
  out << (judgement.total_compared() == 0 ? "FAILED: nothing was compared" : "equal      every bit of every packet")
      << '\n';
}

int run(const CheckOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  (void)vectors::judged_stage(options.stage);
  const vectors::VectorFile file = checked_file(options);
  vectors::Judgement judgement;
  std::optional<cover::Collector> coverage;
  if (!options.coverage.empty()) coverage.emplace(file.config);
  try {
    judgement = vectors::judge(*file.stage, file.config, file.packets, coverage ? &coverage->packets() : nullptr);
  } catch (const InputError& error) {
    throw InputError(options.file + ": " + error.what());
  }
  Json result = result_head("check", options, file.config);
  result["scene"] = file.source.text;
  result["seed"] = file.source.seed;
  result["stage"] = options.stage;
  result["file"] = options.file;
  result["packets"] = judgement_json(*file.stage, judgement);
  std::string covered;
  if (coverage) {
    std::vector<Arrow> arrows;
    for (const auto* ports : {&file.stage->in, &file.stage->out})
      for (const vectors::Port& port : *ports)
        if (port.name == info(port.like).name) arrows.push_back(port.like);
    covered = save_coverage(options.coverage, coverage->hits(), file.config,
                            {typed_command(), options.file, label(file.config), file.source.seed.value_or(0)},
                            cover::Source::ports, result, arrows, options.stage);
  }
  result["wall_s"] = seconds_since(start);
  write_check_junit(options, file, judgement, result);
  write_json(options, result);
  print_judgement(human(options), file, judgement);
  human(options) << covered;
  return judgement.first || judgement.total_compared() == 0 ? exit_mismatch : exit_ok;
}

}  // namespace

void add_check_command(CLI::App& app, Action& selected) {
  const auto [command, options] =
      add_command<CheckOptions>(app, selected, "check", "judges the outputs of another implementation of a stage", run);
  command->add_option("FILE", options->file, "vectors whose `out` is yours: jsonl, csv, or a folder of hex")
      ->required()
      ->each(claim_input);
  add_output_options(*command, *options);
  command->remove_option(command->get_option("--config"));  // the header contains it
  command->remove_option(command->get_option("--set"));
  add_text_option(*command, "--stage", options->stage, "the stage: cull, triangle_setup, coarse_raster ...", "NAME")
      ->required();
  add_text_option(*command, "--vectors", options->vectors, "take the inputs from this file; FILE then needs only `out`",
                  "FILE")
      ->each(claim_input);
  add_file_option(*command, "--junit", options->junit, "result as JUnit XML");
  add_coverage_option(*command, options->coverage);
  command->footer(
      "\nThe specification of the stage runs on the inputs, in order from reset, and every output bit is\n"
      "compared. The exit status is 1 where one differs.\n"
      "\nExample:\n  halfplane vectors triangle --size 64x64 --stage cull -o cull.jsonl\n"
      "  halfplane check --stage cull cull.jsonl");
}

}  // namespace halfplane
