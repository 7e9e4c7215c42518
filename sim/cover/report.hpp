// Coverage of one run or of many: what was hit, what was not, and which option would hit it.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/pipeline_graph.hpp"
#include "sim/cover/hits.hpp"

namespace halfplane::cover {

/// A run, or one of several.
struct Run {
  std::string command, stimulus, config;  ///< config: a preset and its settings
  std::uint64_t seed = 0;
};

struct BinResult {
  std::string name, what, hit_by, faults;  ///< faults: numbers, separated by blanks
  std::string excluded;                    ///< why no such run can hit it; empty: it can
  std::uint64_t hits = 0;
  [[nodiscard]] bool is_hole() const { return hits == 0 && excluded.empty(); }
};

/// Two states, and each pair of their values: hits, or none where no draw can have both.
struct PairResult {
  std::string a, b;
  std::vector<std::string> a_values, b_values;
  std::vector<std::optional<std::uint64_t>> hits;  ///< row by row: value of a, then of b
};

/// A pair that was not drawn.
struct MissingPair {
  std::string a, a_value, b, b_value, hit_by;
};

struct Report {
  std::vector<Run> runs;
  std::vector<BinResult> bins;
  std::vector<PairResult> pairs;

  /// Adds another one: a bin is excluded if both say so.
  void merge(const Report& other);
  [[nodiscard]] std::vector<MissingPair> missing_pairs() const;
};

/// Where the hits come from: scenes through all of the pipeline, with the RTL's streams or without, or the packets at
/// the ports of one stage.
enum class Source { rtl, model, ports };

/// The coverage of a run. `arrows`: of the ports, and `stage` their stage.
[[nodiscard]] Report report_of(const Hits& hits, const Config& config, Run run, Source source,
                               std::span<const Arrow> arrows = {}, std::string_view stage = {});

struct Totals {
  std::uint64_t bins = 0, hit = 0, holes = 0, excluded = 0;
  std::uint64_t pairs = 0, pairs_hit = 0;    ///< pairs that can be drawn
  std::uint64_t faults = 0, faults_met = 0;  ///< seeded faults with a bin, and those with a bin that was hit
  std::vector<std::string> faults_unmet;     ///< without any
};
[[nodiscard]] Totals totals_of(const Report& report);

/// Keys as in docs/json/halfplane.coverage.schema.json, without `schema`.
[[nodiscard]] nlohmann::ordered_json coverage_json(const Report& report);

/// A file that --coverage or `cover -o` has written. Throws InputError.
[[nodiscard]] Report read_coverage(const std::string& path);
void write_coverage(const std::string& path, const Report& report);

[[nodiscard]] std::string summary_line(const Report& report);
/// Totals, holes with the options that hit them, and what this hardware does not have. At most `most` missing pairs.
void print_coverage(std::ostream& out, const Report& report, std::size_t most = 20);

/// Writes a coverage file of Verilator (verilator_coverage reads it), and beside it PATH.txt, the lines that it counts: a
/// bin or a pair each.
void write_verilator_coverage(const std::string& path, const Report& report);

/// A self-contained page.
void write_coverage_page(const std::string& path, const Report& report, const std::string& command);

}  // namespace halfplane::cover
