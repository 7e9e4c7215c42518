// What `halfplane bench` measured, between its options and its files: how it is written and printed.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "sim/cli/options.hpp"
#include "sim/study/bench/growth.hpp"
#include "sim/study/bench/rows.hpp"
#include "sim/study/bench/skips.hpp"

namespace halfplane {

struct BenchStudy {
  std::vector<BenchCase> cases;
  std::vector<BenchRow> rows;
  std::vector<SkipRow> skips;
  std::vector<GrowthRow> growth;
};

/// Adds rows, skips and growth, the last two when they were measured.
void add_bench_json(Json& result, const BenchStudy& study);

/// Writes the page: the result, and what the page alone needs.
void write_bench_page(const std::string& path, const Json& result, const std::string& command);

/// Tables for people.
void print_bench(std::ostream& out, const BenchStudy& study);

}  // namespace halfplane
