#include "stage_table.hpp"

#include "port_timing.hpp"

namespace halfplane {
namespace {

std::string text(std::uint64_t value) { return std::to_string(value); }

std::vector<StageRow> front_of(const Config& config, const Widths& widths, const TimingParameters& parameters) {
  const std::string stamps = text(static_cast<std::uint64_t>(parameters.stamp_queue));
  const auto number = [](int value) { return text(static_cast<std::uint64_t>(value)); };
  if (config.setup_kind == SetupKind::pipelined) {
    const SetupCycles setup(config, widths, parameters.divide_bits);
    const int sort = PipelinedCycles::cull_sort, decide = PipelinedCycles::cull_decide;
    const std::string state = setup.has_state_lane ? ", of a state 1" : "";
    return {{Stage::cull, number(sort + decide), number(std::max(sort, decide)) + state, "2"},
            {Stage::triangle_setup, number(setup.latency), number(setup.part) + state,
             number(setup.parts + 1) +
                 (setup.has_state_lane ? ", " + number(SetupCycles::kStates) + " states, 1 of either" : "")},
            {Stage::coarse_raster, text(PipelinedCycles::walk_begins + 1) + " to the first tile",
             "1 a tile, 3 for a visit where HiZ bounds are read",
             number(config.context_slots) + " primitives up to interpolate, " + number(config.hiz_lag) + " visits"},
            {Stage::fine_raster, "3", "1 a stamp or row of stamps without one", "3 rows"},
            {Stage::interpolate, number(PipelinedCycles::interpolate_steps), "1",
             number(PipelinedCycles::interpolate_steps + parameters.stamp_queue)}};
  }
  const SerialCycles serial(widths);
  const Cycle start = SerialCycles::sort + SerialCycles::box + 1, product = static_cast<Cycle>(serial.product);
  const std::string kept = text(start + 4 * product + 1) + " or " + text(start + 5 * product + 3) + "; " +
                           text(start + product) + " where it is dropped, " + text(start) + " for what is no triangle";
  return {{Stage::cull, kept, "the same", "1"},
          {Stage::triangle_setup,
           text(1 + serial.setup(0)) + " and " + text(serial.setup(1) - serial.setup(0)) + " for each bit of the area",
           "2 more", "1"},
          {Stage::coarse_raster, text(1 + SerialCycles::turn) + " to the first tile",
           text(1 + SerialCycles::turn) + " a tile, one more for a visit, one more where a HiZ bound is read",
           number(config.context_slots) + " primitives up to interpolate, " + number(config.hiz_lag) + " visits"},
          {Stage::fine_raster, "1 and the way to the first stamp of the box, 2 a row down",
           "1 a stamp of the box, 1 more in a row of one stamp", "1 tile"},
          {Stage::interpolate, number(SerialCycles::interpolate_steps) + ", then 1 in the buffer", "1",
           number(SerialCycles::interpolate_steps) + ", and " + stamps + " in the buffer"}};
}

StageRow framebuffer_of(const Config& config, const Widths& widths) {
  const auto stamps = static_cast<std::uint64_t>(widths.stamps.stamps());
  if (config.cache_kind == CacheKind::blocks) {
    const auto block = static_cast<std::uint64_t>(widths.blocks.stamps());
    return {Stage::framebuffer, "4 to the test, for a stamp of depth from memory the memory port's latency more",
            "1; behind a flag that falls 1 more for another block; of the memory port 1 a stamp: a block that leaves "
            "at most " +
                text(2 * block) + ", beside what follows",
            text(static_cast<std::uint64_t>(config.cache_lines)) + " blocks, " +
                text(static_cast<std::uint64_t>(config.cache_queue)) + " fragments, " +
                text(static_cast<std::uint64_t>(config.cache_victims)) + " blocks on their way to memory"};
  }
  return {Stage::framebuffer, "1 where the tile is on the chip",
          "1; a miss 2, for a dirty plane 3 and its stamps, at most " + text(stamps + 3) +
              ", for a tile that was cleared " + text(stamps) + ", for its depth from memory " + text(stamps + 2) +
              " and the memory port's latency",
          text(static_cast<std::uint64_t>(config.cache_lines)) + " tiles"};
}

StageRow memory_port_of(const Config& config, const Widths& widths) {
  const int depth = widths.memory.stamp[0] - widths.memory.port, color = widths.memory.stamp[1] - widths.memory.port;
  const auto beats = [](int shift) {
    return shift < 0 ? "1 for " + text(std::uint64_t{1} << -shift) : text(std::uint64_t{1} << shift);
  };
  return {Stage::memory_port, "1, and the memory's",
          "1 a beat of " + text(static_cast<std::uint64_t>(config.memory_port_bits)) + " bits: for a stamp of depth " +
              beats(depth) + ", of colour " + beats(color),
          "1 stamp or beat, " + text(PortTiming<>::kUnanswered) + " bursts that are being written"};
}

}  // namespace

std::vector<StageRow> stage_table(const Config& config) {
  const Widths widths = derive_widths(config);
  std::vector<StageRow> rows = front_of(config, widths, {});
  if (config.line_units != 0) rows.push_back({Stage::line_raster, "1", "1 a pixel, 1 more a line", "1 line"});
  if (config.line_units != 0) rows.push_back({Stage::primitive_join, "0", "1", "0"});
  rows.push_back(
      {Stage::depth_test, "1 to the write, 2 to the retired visit",
       config.cache_kind == CacheKind::blocks ? "1" : "1; 2 where a fragment needs the depth of the one before", "2"});
  rows.push_back({Stage::rop, "0", "1", "0"});
  rows.push_back(framebuffer_of(config, widths));
  rows.push_back(memory_port_of(config, widths));
  return rows;
}

std::string stage_table_markdown(const Config& config) {
  std::string table = "| stage | latency | one every | holds |\n| --- | --- | --- | --- |\n";
  for (const StageRow& row : stage_table(config))
    table += "| " + std::string(info(row.stage).name) + " | " + row.latency + " | " + row.interval + " | " + row.holds +
             " |\n";
  return table;
}

}  // namespace halfplane
