// The measurements of `halfplane bench`, between its options and its files: how they are written and printed.
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

class Gates;

/// `bench --antialiasing`: error against the exact area, and time, cycles and bytes of each kind of antialiasing;
/// `gates`: also the gates of its hardware, unless null. `size`, `repeat`, `seed` are the command's. Adds to `result`
/// and prints.
void measure_antialiasing(const CommonOptions& options, const Config& config, int repeat, const Gates* gates,
                          Json& result);

void write_antialiasing_page(const std::string& path, const Json& result, const std::string& command);

/// Adds rows, and skips and growth if they were measured.
void add_bench_json(Json& result, const BenchStudy& study);

/// Writes the page: the result, and data that only the page needs.
void write_bench_page(const std::string& path, const Json& result, const std::string& command);

/// Prints a table with columns as wide as their content; the first `left` columns are left-aligned. A column of only
/// blanks and "-" is left out.
void print_bench_table(std::ostream& out, const std::vector<std::vector<std::string>>& lines, std::size_t left);

/// Prints tables for people.
void print_bench(std::ostream& out, const BenchStudy& study);

}  // namespace halfplane
