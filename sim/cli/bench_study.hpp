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

class Gates;

/// `bench --antialiasing`: error against the exact area, and time, cycles and bytes of each kind of antialiasing; `gates`: and
/// those of its hardware, unless it is null. `size`, `repeat`, `seed` are the command's. Adds to `result` and prints.
void measure_antialiasing(const CommonOptions& options, const Config& config, int repeat, const Gates* gates,
                          Json& result);

/// Its page, of such a result.
void write_antialiasing_page(const std::string& path, const Json& result, const std::string& command);

/// Adds rows, skips and growth, the last two when they were measured.
void add_bench_json(Json& result, const BenchStudy& study);

/// Writes the page: the result, and what the page alone needs.
void write_bench_page(const std::string& path, const Json& result, const std::string& command);

/// A table whose columns are as wide as what stands in them; the first `left` columns begin at the left. A column of
/// nothing but blanks and "-" is left out.
void print_bench_table(std::ostream& out, const std::vector<std::vector<std::string>>& lines, std::size_t left);

/// Tables for people.
void print_bench(std::ostream& out, const BenchStudy& study);

}  // namespace halfplane
