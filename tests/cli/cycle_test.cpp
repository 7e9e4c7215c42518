// `render --engine cycle`, `bench`, `config --stages`: their output, files and refusals.
#include <algorithm>
#include <cstring>
#include <map>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::cycle_test {
namespace {

class CycleCommand : public Cli {};

TEST_F(CycleCommand, ResultHasCyclesStagesTrafficAndTheFunctionalEnginesPicture) {
  const Json cycle = result({"render", "city:12", "--size", "160x120", "--engine", "cycle", "--explain"});
  const Json functional = result({"render", "city:12", "--size", "160x120"});
  EXPECT_EQ(cycle["color_hash"], functional["color_hash"]);
  EXPECT_EQ(cycle["depth_hash"], functional["depth_hash"]);
  EXPECT_EQ(cycle["fragments"]["depth_passed"], functional["fragments"]["depth_passed"]);
  EXPECT_EQ(cycle["fragments"]["written"], functional["fragments"]["written"]);
  EXPECT_EQ(cycle["primitives"], functional["primitives"]);
  EXPECT_GT(cycle["cycles"], cycle["raster_cycles"]);
  EXPECT_GT(cycle["raster_cycles"], cycle["tile_cycles"]);
  for (const char* stage : {"cull", "triangle_setup", "coarse_raster", "fine_raster", "interpolate", "framebuffer"}) {
    const Json& figures = cycle["stages"][stage];
    ASSERT_TRUE(figures.is_object()) << stage;
    for (const char* key : {"busy", "stalled", "starved", "items", "works", "no_item"})
      EXPECT_TRUE(figures[key].is_number_unsigned()) << stage << ", " << key;
    EXPECT_EQ(figures["busy"].get<std::uint64_t>() + figures["stalled"].get<std::uint64_t>() +
                  figures["starved"].get<std::uint64_t>(),
              cycle["cycles"]);
  }
  for (const char* cause : {"fill", "evict", "clear"})
    EXPECT_TRUE(cycle["traffic_bytes"][cause]["depth"].is_number_unsigned()) << cause;
  EXPECT_EQ(cycle["memory"], (Json{{"kind", "fixed"}, {"latency", 8}, {"mhz", 50}}));
  EXPECT_GT(cycle["per_second"]["frames"], 0.0);
  EXPECT_TRUE(cycle["saved_cycles"].contains("fast_clear"));
}

TEST_F(CycleCommand, BinsGiveTheSamePictureAndSayHowManyPrimitivesWereSent) {
  const Arguments common{"render", "city:12", "--size", "160x120", "--engine", "cycle"};
  const auto with = [&](Arguments more) {
    more.insert(more.begin(), common.begin(), common.end());
    return result(more);
  };
  const Json program = with({}), bins = with({"--set", "frame.order=bins"});
  const Json color = with({"--set", "frame.order=bins", "--set", "frame.store=color"});
  EXPECT_EQ(program["frame"]["order"], "program");
  EXPECT_EQ(program["frame"]["bins"], 1);
  EXPECT_EQ(bins["frame"]["order"], "bins");
  EXPECT_EQ(bins["frame"]["bins"], 4);
  EXPECT_EQ(bins["frame"], color["frame"]);
  EXPECT_EQ(bins["depth_hash"], program["depth_hash"]);
  EXPECT_TRUE(color["depth_hash"].is_null());
  for (const Json& other : {bins, color})
    for (const char* key : {"color_hash", "primitives"}) EXPECT_EQ(other[key], program[key]) << key;
  EXPECT_EQ(bins["fragments"]["written"], program["fragments"]["written"]);
  EXPECT_EQ(color["traffic_bytes"]["evict"]["depth"], 0);
  EXPECT_EQ(color["traffic_bytes"]["clear"]["depth"], 0);
}

TEST_F(CycleCommand, WithoutStoredDepthThereIsNoDepthToWriteAndACacheOfTilesHasNoBins) {
  expect_refused({"render", "triangle", "--set", "frame.store=color", "--depth", "d.npy"}, "frame.store=all");
  expect_refused({"render", "triangle", "--config", "small", "--set", "frame.order=bins"}, "cache.kind=blocks");
  expect_refused({"render", "triangle", "--config", "small", "--set", "frame.store=color"}, "cache.kind=blocks");
}

TEST_F(CycleCommand, ExplainRunsBothOrdersAndRecommendsOne) {
  const Json json = result({"render", "city:12", "--size", "160x120", "--engine", "cycle", "--explain"});
  const Json& tried = json["orders"]["tried"];
  ASSERT_EQ(tried.size(), 3u);
  EXPECT_EQ(tried[0]["cycles"], json["cycles"]);
  const Json bins =
      result({"render", "city:12", "--size", "160x120", "--engine", "cycle", "--set", "frame.order=bins"});
  EXPECT_EQ(tried[1]["cycles"], bins["cycles"]);
  EXPECT_EQ(json["orders"]["recommended"], bins["cycles"] < json["cycles"] ? "bins" : "program");
}

// Each relief is a what-if that a user can repeat.
TEST_F(CycleCommand, WhatIsSaidToRelieveItDoesSoWhenTried) {
  const Json explained = result({"render", "city:12", "--size", "160x120", "--engine", "cycle", "--explain"});
  ASSERT_FALSE(explained["reliefs"].empty());
  Arguments again{"render", "city:12", "--size", "160x120", "--engine", "cycle"};
  for (const Json& relief : explained["reliefs"]) {
    again.push_back("--what-if");
    again.push_back(relief["key"].get<std::string>() + "=" + relief["value"].get<std::string>());
  }
  const Json rows = result(again)["what_if"];
  ASSERT_EQ(rows.size(), explained["reliefs"].size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i]["cycles"], explained["reliefs"][i]["cycles"]);
    EXPECT_LT(rows[i]["cycles"], explained["cycles"]);
  }
}

TEST_F(CycleCommand, WhatIfIsTheSameAsSettingIt) {
  const Arguments common{"render", "teapot:5", "--size", "128x96", "--engine", "cycle"};
  const auto with = [&](Arguments more) {
    more.insert(more.begin(), common.begin(), common.end());
    return result(more);
  };
  const Json rows =
      with({"--what-if", "stamp.size=1,4", "--what-if", "memory=sdram", "--what-if", "queue.tile=2"})["what_if"];
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0]["cycles"], with({"--set", "stamp.size=1"})["cycles"]);
  EXPECT_EQ(rows[1]["cycles"], with({"--set", "stamp.size=4"})["cycles"]);
  EXPECT_EQ(rows[2]["cycles"], with({"--memory", "sdram"})["cycles"]);
  EXPECT_EQ(rows[3]["cycles"], with({"--timing", "queue.tile=2"})["cycles"]);
  for (const Json& row : rows) EXPECT_EQ(row["same_picture"], true);
  EXPECT_EQ(with({"--what-if", "subpixel.bits=1"})["what_if"][0]["same_picture"], false);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

TEST_F(CycleCommand, TheListingHasALineForEveryPrimitiveInOrder) {
  const Json json = result({"render", "wires", "--size", "96x64", "--engine", "cycle", "--primitives", "p.csv"});
  const Bytes bytes = read("p.csv");
  const auto lines = lines_of(std::string(bytes.begin(), bytes.end()));
  ASSERT_GT(lines.size(), 10u);
  const auto head = cells_of(lines[0]);
  const auto at = [&](const std::string& name) {
    const auto column = std::find(head.begin(), head.end(), name);
    EXPECT_NE(column, head.end()) << name;
    return static_cast<std::size_t>(column - head.begin());
  };
  std::uint64_t fragments = 0, last = 0, taken = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = cells_of(lines[i]);
    ASSERT_EQ(cells.size(), head.size()) << lines[i];
    EXPECT_EQ(cells[0], std::to_string(i - 1));
    EXPECT_GE(std::stoull(cells[at("primitive_first")]), taken);
    taken = std::stoull(cells[at("primitive_first")]);
    last = std::max<std::uint64_t>(last, std::stoull(cells[at("last")]));
    fragments += std::stoull(cells[at("fragment_items")]);
  }
  EXPECT_EQ(cells_of(lines[1])[1], "fast_clear");
  EXPECT_EQ(cells_of(lines.back())[1], "flush");
  EXPECT_EQ(last + 1, json["cycles"]);
  EXPECT_EQ(fragments, json["stages"]["interpolate"]["items"]);
}

TEST_F(CycleCommand, TheTimelineIsChromeTraceJsonWhoseSlicesDoNotOverlapOnATrack) {
  for (const auto& [config, scene] : {std::pair{"embedded", "teapot:4"}, {"embedded", "star"}, {"small", "teapot:4"}}) {
    (void)result({"render", scene, "--size", "96x64", "--config", config, "--engine", "cycle", "--trace", "t.json"});
    const Bytes bytes = read("t.json");
    const Json trace = Json::parse(bytes.begin(), bytes.end());
    std::map<int, std::vector<std::pair<std::uint64_t, std::uint64_t>>> slices;
    std::size_t tracks = 0;
    for (const Json& event : trace["traceEvents"]) {
      tracks += event["name"] == "thread_name" ? 1 : 0;
      if (event["ph"] == "X") slices[event["tid"]].emplace_back(event["ts"], event["dur"]);
    }
    EXPECT_EQ(tracks, 16u);
    EXPECT_GE(slices.size(), 6u);
    for (auto& [track, of_track] : slices) {
      std::sort(of_track.begin(), of_track.end());
      std::uint64_t end = 0;
      for (const auto& [from, duration] : of_track) {
        EXPECT_GE(from, end) << config << ", track " << track;
        EXPECT_GT(duration, 0u);
        end = from + duration;
      }
    }
  }
}

TEST_F(CycleCommand, TheTimelineHasEveryPrimitiveHoweverManyAreUnderWay) {
  for (const char* const setting : {"depth.bits=16", "depth.bits=32"}) {
    (void)result({"render", "dust:2000", "--size", "64x64", "--set", setting, "--set", "reciprocal.extra_bits=12",
                  "--engine", "cycle", "--trace", "t.json"});
    const Bytes bytes = read("t.json");
    const Json trace = Json::parse(bytes.begin(), bytes.end());
    std::map<int, std::string> name;
    std::size_t in_setup = 0, in_raster = 0;
    for (const Json& event : trace["traceEvents"]) {
      if (event["name"] == "thread_name") name[event["tid"]] = event["args"]["name"];
      if (event["ph"] != "X") continue;
      in_setup += name.at(event["tid"]).starts_with("triangle_setup") ? 1 : 0;
      in_raster += name.at(event["tid"]).starts_with("coarse_raster") ? 1 : 0;
    }
    EXPECT_GT(in_raster, 500u);
    EXPECT_EQ(in_setup, in_raster) << setting;
  }
}

TEST_F(CycleCommand, TheHeatMapSharesOutTheCyclesOfTheVisits) {
  const Json json = result({"render", "teapot:5", "--size", "64x48", "--engine", "cycle", "--heat", "heat.npy"});
  const Bytes bytes = read("heat.npy");
  ASSERT_GT(bytes.size(), 64u * 48u * 4u);
  double sum = 0;
  for (std::size_t at = bytes.size() - 64 * 48 * 4; at < bytes.size(); at += 4) {
    float value;
    std::memcpy(&value, bytes.data() + at, 4);
    EXPECT_GE(value, 0.0F);
    sum += value;
  }
  // All cycles except those of the clear, the flush, and stamps that end a primitive without a visit.
  EXPECT_GT(sum, 0.5 * json["raster_cycles"].get<double>());
  EXPECT_LT(sum, 1.001 * json["cycles"].get<double>());
  EXPECT_EQ(run({"render", "teapot:5", "--size", "64x48", "--engine", "cycle", "--heat", "heat.png"}).status, 0);
  EXPECT_TRUE(exists("heat.png"));
}

TEST_F(CycleCommand, TheMapOfMissesHasEachLineOfTexelsOnce) {
  const Arguments command{"render",   HALFPLANE_SOURCE_DIR "/docs/texture/hardware.hpt",
                          "--engine", "cycle",
                          "--set",    "texture.unit=bilinear",
                          "--misses", "misses.npy"};
  const Json json = result(command);
  const auto pixels = json["width"].get<std::size_t>() * json["height"].get<std::size_t>();
  const Bytes bytes = read("misses.npy");
  ASSERT_GT(bytes.size(), 4 * pixels);
  double sum = 0;
  for (std::size_t at = bytes.size() - 4 * pixels; at < bytes.size(); at += 4) {
    float value;
    std::memcpy(&value, bytes.data() + at, 4);
    sum += value;
  }
  EXPECT_GT(sum, 0);
  EXPECT_EQ(sum, json["texture"]["fills"].get<double>());
  expect_refused({"render", "triangle", "--engine", "cycle", "--misses", "m.png"},
                 "--misses: there is no texture unit");
}

TEST_F(CycleCommand, WhatOtherEnginesOrThisHardwareDoNotHaveIsRefused) {
  expect_refused({"render", "triangle", "--memory", "sdram"}, "--memory: the engine functional does not have it");
  expect_refused({"render", "triangle", "--what-if", "queue.tile=2"},
                 "--what-if: the engine functional does not have it; add --engine cycle");
  const auto cycle = [](Arguments more) {
    more.insert(more.begin(), {"render", "triangle", "--engine", "cycle"});
    return more;
  };
  expect_refused(cycle({"--memory", "hbm"}), "--memory: no memory 'hbm'; give fixed, sram, sdram, psram or ddr3");
  expect_refused(cycle({"--what-if", "queue.tile"}), "--what-if: 'queue.tile' is not KEY=VALUE");
  expect_refused(cycle({"--what-if", "queue.stamp=2,"}),
                 "--what-if: queue.stamp: '' is no number in its range; give 1...1024");
  expect_refused(cycle({"--what-if", "queue.stamp=0"}), "'0' is no number in its range; give 1...1024");
  expect_refused(cycle({"--what-if", "cash.lines=4"}), "no setting 'cash.lines'");
  expect_refused(cycle({"--what-if", "cache.lines=3"}), "cache.lines");
  expect_refused(cycle({"--timing", "stamp.size=4"}), "--set takes the others");
  expect_refused(cycle({"--config", "small", "--timing", "queue.tile=4"}), "setup.kind=pipelined");
  expect_refused(cycle({"--mhz", "0"}), "--mhz");
  expect_refused(cycle({"--stalls", "nan"}), "'nan' is no number");
  expect_refused(cycle({"--trace", "t.json", "--timing", "queue.tile=4"}), "--trace");
  expect_refused(cycle({"--heat", "x.png", "-o", "x.png"}), "two options name the file 'x.png'");
  expect_refused(cycle({"--skip", "none"}), "leave out --skip");
  expect_refused(cycle({"--primitives", "p.txt"}), ".csv");
  expect_refused(cycle({"--trace", "nowhere/t.json"}), "nowhere");
  expect_refused(cycle({"--traversal", "bbox"}), "add --engine scalar");
  expect_refused({"render", "star", "--engine", "cycle", "--config", "small"}, "set lines.unit=1");
}

TEST_F(CycleCommand, BenchMeasuresEnginesSideBySide) {
  const Json json =
      result({"bench", "triangle", "walk", "--size", "64x48", "--engines", "functional,cycle", "--repeat", "2"});
  ASSERT_EQ(json["rows"].size(), 4u);
  for (const Json& row : json["rows"]) {
    EXPECT_GT(row["frame_s"], 0.0);
    EXPECT_EQ(row["cycles"].is_null(), row["engine"] == "functional");
  }
  EXPECT_EQ(json["schema"], "halfplane.bench/1");
  expect_refused({"bench", "triangle", "--engines", "gpu"}, "--engines: no engine 'gpu'");
}

TEST_F(CycleCommand, ConfigListsWhatTheCycleEngineCanVaryAndWhatEveryStageTakes) {
  const Json list = result({"config", "--list"});
  EXPECT_EQ(list["timing_settings"].size(), 9u);
  const Json stages = result({"config", "--stages"})["stages"];
  EXPECT_EQ(stages[0]["stage"], "cull");
  EXPECT_EQ(stages[1]["latency"], "21");
}

}  // namespace
}  // namespace halfplane::cli::cycle_test
