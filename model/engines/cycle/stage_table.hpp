// The latency and the interval of every stage, from the figures that the cycle model computes with: the table of
// docs/pipeline.md.
#pragma once

#include <string>
#include <vector>

#include "../../pipeline_graph.hpp"
#include "parameters.hpp"
#include "work.hpp"

namespace halfplane {

/// In cycles. Strings, because some depend on the item.
struct StageRow {
  Stage stage;
  std::string latency;   ///< from an item in to its results out
  std::string interval;  ///< cycles between two items
  std::string holds;     ///< items under way at most
};

/// The stages of a configuration, in the order of the pipeline, without the host.
[[nodiscard]] std::vector<StageRow> stage_table(const Config& config);

[[nodiscard]] std::string stage_table_markdown(const Config& config);

}  // namespace halfplane
