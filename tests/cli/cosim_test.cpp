// The commands that run the RTL: `cosim`, `reduce`, `mutants` and `render --engine rtl`.
#include <algorithm>

#include "program.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane::cli::cosim_test {
namespace {

class RtlCommands : public Cli {
 protected:
  void SetUp() override { skip_without_rtl(); }
  /// The words after "halfplane" of the last line that begins with "  repeat".
  [[nodiscard]] static Arguments repeat_command(const std::string& report) {
    Arguments words;
    for (const std::string& line : lines_of(report))
      if (line.starts_with("  repeat")) words = split_words(line);
    if (words.size() > 2) words.erase(words.begin(), words.begin() + 2);
    return words;
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }
};

/// Every tag is closed in order, and attributes have quotes, as a JUnit reader requires.
bool is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0 || tag.find('<') != std::string::npos) return false;
    if (tag.starts_with('?') || tag.ends_with('/')) continue;
    if (!tag.starts_with('/')) {
      open.push_back(tag.substr(0, tag.find(' ')));
    } else if (open.empty() || open.back() != tag.substr(1)) {
      return false;
    } else {
      open.pop_back();
    }
  }
  return open.empty() && xml.starts_with("<?xml");
}

TEST_F(RtlCommands, CosimOfABuiltInSceneIsEqualAndSaysWhatItCompared) {
  const Outcome outcome = run({"cosim", "teapot:3", "--size", "160x120", "--stalls", "0.2"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"teapot:3", "triangles", "embedded", "seed 1", "compared", "stamp", "memory", "cycles",
                           "equal       every bit"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  EXPECT_EQ(outcome.out.find("MISMATCH"), std::string::npos);
  EXPECT_TRUE(listing().empty()) << "nothing is saved when nothing differs";
}

TEST_F(RtlCommands, CosimResultHasEveryKeyOfTheContract) {
  const Json json = result({"cosim", "--random", "200", "--seed", "7", "--junit", "equal.xml"});
  EXPECT_EQ(json["schema"], "halfplane.cosim/1");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["mismatches"], 0);
  EXPECT_TRUE(json["first_mismatch"].is_null());
  EXPECT_TRUE(json["scene"].is_null());
  for (const char* stage :
       {"cull", "triangle_setup", "coarse_raster", "fine_raster", "interpolate", "depth_test", "rop", "framebuffer"})
    EXPECT_GT(json["packets"][stage], 0u) << stage;
  for (const char* key : {"model", "rtl", "max_primitive_error"}) EXPECT_TRUE(json["cycles"].contains(key)) << key;
  EXPECT_GT(json["cycles"]["rtl"], 0u);
  EXPECT_GT(json["rtl_cycles_per_s"], 0.0);
  EXPECT_TRUE(json["wall_s"].is_number());
  EXPECT_TRUE(is_well_formed(text("equal.xml"))) << text("equal.xml");
  EXPECT_NE(text("equal.xml").find("failures=\"0\""), std::string::npos);
}

TEST_F(RtlCommands, AMutantIsNamedSavedReducedAndRepeated) {
  const Outcome outcome =
      run({"cosim", "--random", "6000", "--stalls", "0.2", "--mutant", "1", "--junit", "failed.xml", "--json=r.json"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const std::size_t model = outcome.out.find(" model "), rtl = outcome.out.find(" rtl ");
  EXPECT_NE(outcome.out.find("MISMATCH in cull: triangle packet"), std::string::npos) << outcome.out;
  EXPECT_NE(model, std::string::npos) << outcome.out;
  EXPECT_LT(model, rtl) << "model above rtl";
  EXPECT_NE(outcome.out.find('^'), std::string::npos) << "the bits that differ are marked";
  EXPECT_TRUE(is_well_formed(text("failed.xml"))) << text("failed.xml");
  EXPECT_NE(text("failed.xml").find("<failure "), std::string::npos);

  const Json json = Json::parse(text("r.json"));
  EXPECT_EQ(json["mismatches"], 1);
  EXPECT_TRUE(json["cycles"]["raster"].is_null()) << "the run stopped before it was known";
  EXPECT_NE(outcome.out.find(" to where the run stopped"), std::string::npos) << outcome.out;
  for (const char* key : {"stage", "key", "cycle", "fields", "repro"})
    EXPECT_TRUE(json["first_mismatch"].contains(key)) << key;
  EXPECT_EQ(json["first_mismatch"]["stage"], "cull");
  EXPECT_FALSE(json["first_mismatch"]["fields"].empty());
  const std::string capture = json["reduced"]["capture"], trace = json["reduced"]["trace"];
  EXPECT_TRUE(exists(capture));
  EXPECT_TRUE(exists(trace));
  EXPECT_LE(json["reduced"]["triangles"], 3u);
  // The JUnit file has the facts to act on: the reduced scene, its place, and the command that repeats the failure.
  for (const std::string& part :
       {capture, trace, json["reduced"]["repro"].get<std::string>(),
        "cycle " + std::to_string(json["reduced"]["cycle"].get<int>()), std::string("first seen cull: ")})
    EXPECT_NE(text("failed.xml").find(part), std::string::npos) << part << text("failed.xml");
  const std::string message = text("failed.xml").substr(text("failed.xml").find("<failure message="));
  EXPECT_NE(message.substr(0, message.find('>')).find(outcome.out.substr(outcome.out.find("MISMATCH in ") + 12, 40)),
            std::string::npos)
      << message;

  EXPECT_EQ(run(repeat_command(outcome.out)).status, 1) << "the printed command shows the same again";
  Arguments first = split_words(json["first_mismatch"]["repro"].get<std::string>());
  first.erase(first.begin());
  EXPECT_EQ(run(first).status, 1) << "and so does the one of the whole run";
  EXPECT_EQ(run({"cosim", capture}).status, 0) << "without the mutant there is nothing wrong with it";
}

/// Begin and end of a waveform, from its header: type, length, first time, last time.
std::pair<std::uint64_t, std::uint64_t> fst_times(const Bytes& file) {
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + 8; ++i) value = value << 8 | file[i];
    return value;
  };
  if (file.size() < 25) return {1, 0};
  return {number(9), number(17)};
}

TEST_F(RtlCommands, ARunWithoutAMismatchLeavesTheWaveformOfItsWindow) {
  ASSERT_TRUE(verilated_duts().front().has_trace) << "designs of builds with tests are traced";
  const Outcome first = run({"cosim", "triangle", "--size", "64x48", "--trace", "w.fst", "--json=r.json"});
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.out.find("waveform    w.fst, cycles 0 to "), std::string::npos) << first.out;
  Json json = Json::parse(read("r.json"));
  EXPECT_EQ(json["trace"], "w.fst");
  const std::uint64_t last = json["trace_cycles"][1];
  EXPECT_EQ(fst_times(read("w.fst")).first, 0u);
  EXPECT_GE(fst_times(read("w.fst")).second, 2 * last);
  json = result({"cosim", "triangle", "--size", "64x48", "--trace", "w.fst", "--trace-cycles", "100:199"});
  EXPECT_EQ(json["trace_cycles"], (Json{100, 199}));
  EXPECT_EQ(fst_times(read("w.fst")), std::pair(std::uint64_t{200}, std::uint64_t{399}));
  const Outcome late =
      run({"cosim", "triangle", "--size", "64x48", "--trace", "late.fst", "--trace-cycles", "9000000:9000009"});
  EXPECT_EQ(late.status, 0) << late.err;
  EXPECT_NE(late.out.find("waveform    none: the run has "), std::string::npos) << late.out;
  EXPECT_FALSE(exists("late.fst"));
}

TEST_F(RtlCommands, TheWindowOfAWaveformIsChecked) {
  for (const char* window : {"", "5", "5:", ":5", "9:5", "a:b", "-1:5", "1:2:3", "0:99999999999999999999"})
    expect_refused({"cosim", "triangle", "--trace", "w.fst", "--trace-cycles", window}, "--trace-cycles: ");
  expect_refused({"cosim", "triangle", "--trace-cycles", "0:9"}, "add --trace FILE.fst");
  expect_refused({"cosim", "triangle", "--trace", "-"}, "a waveform cannot go to stdout");
  // Even root cannot write a file there.
  expect_refused({"cosim", "triangle", "--trace", "/proc/self/w.fst"}, "cannot write '/proc/self/w.fst'");
}

// A limit on the file size: every write of the waveform writer that a full disk can refuse is refused at one of the
// limits.
TEST_F(RtlCommands, AWaveformThatTheDiskHasNoRoomForIsOneLineAndNoFile) {
  Surroundings full;
  for (const std::size_t bytes : {1'000, 5'000, 20'000, 100'000}) {
    full.file_bytes = bytes;
    expect_refused({"cosim", "triangle", "--size", "32x32", "--trace", "w.fst", "--quiet"}, "cannot write 'w.fst': ", 2,
                   full);
  }
  full.file_bytes = 10'000'000;
  EXPECT_EQ(run({"cosim", "triangle", "--size", "32x32", "--trace", "w.fst", "--quiet"}, full).status, 0);
  const Bytes whole = read("w.fst");
  EXPECT_GT(whole.size(), 10'000u);
  full.file_bytes = 20'000;
  EXPECT_EQ(run({"cosim", "triangle", "--size", "32x32", "--trace", "w.fst", "--quiet"}, full).status, 2);
  EXPECT_EQ(read("w.fst"), whole) << "the file of before stays";
  EXPECT_EQ(listing().size(), 1u);
}

TEST_F(RtlCommands, AMismatchIsWorthMoreThanItsWaveform) {
  Surroundings full;
  full.file_bytes = 20'000;
  const Outcome outcome = run({"cosim", "triangle", "--size", "32x32", "--mutant", "11", "--trace", "w.fst"}, full);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("MISMATCH in "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("waveform  none: cannot write 'w.fst': "), std::string::npos) << outcome.out;
  EXPECT_FALSE(exists("w.fst"));
}

TEST_F(RtlCommands, EveryCommandPrintedToRepeatRepeatsWhenPasted) {
  std::filesystem::create_directory(folder_ / "my scenes");
  write("my scenes/it's.obj", "v -1 -1 0\nv 1 -1 0.2\nv 0 1 -0.1\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  const std::vector<Arguments> runs{
      {"cosim", "my scenes/it's.obj", "--size", "96x80", "--camera", "eye=0,0,4;fov=40", "--set", "depth.mapping=rev",
       "--convention", "d3d", "--stalls", "0.123456789", "--memory", "sdram", "--mutant", "8"},
      {"cosim", "my scenes/it's.obj", "--mutant", "8", "--save", "a & b.hpt"},
      {"cosim", "--random", "300", "--seed", "5", "--mutant", "1"},
      {"reduce", "my scenes/it's.obj", "--mutant", "8", "-o", "my scenes/small; one.hpt"}};
  for (Arguments words : runs) {
    words.push_back("--json=r.json");
    const Outcome first = run(words);
    const std::string text = testing::PrintToString(words);
    const Json json = Json::parse(read("r.json"));
    const std::string repeat = [&] {
      for (const std::string& line : lines_of(first.out))
        if (line.starts_with("  repeat    ")) return line.substr(12);
      return std::string();
    }();
    std::vector<std::string> commands{repeat, json["first_mismatch"]["repro"]};
    for (const std::string& command : commands) {
      const Outcome again = paste(command + " --json=again.json");
      EXPECT_EQ(again.status, 1) << text << "\n" << command << "\n" << again.err;
      const Json now = Json::parse(read("again.json"), nullptr, false);
      ASSERT_FALSE(now.is_discarded()) << command;
      EXPECT_EQ(now["first_mismatch"]["stage"], json["first_mismatch"]["stage"]) << command;
    }
    if (words[0] == "cosim") {
      EXPECT_EQ(Json::parse(read("again.json"))["first_mismatch"]["cycle"], json["first_mismatch"]["cycle"])
          << commands[1];
    }
  }
}

TEST_F(RtlCommands, ASceneFromStdinIsRepeatedFromItsSavedCapture) {
  write("square.hpt", "halfplane 1\ntarget 32 32\nspace window\nv 1.5 1.5 .5\nv 9.5 1.5 .5\nv 1.5 9.5 .5\nt 0 1 2\n");
  Surroundings piped;
  piped.in = "square.hpt";
  EXPECT_EQ(run({"cosim", "-"}, piped).status, 0);
  const Outcome outcome = run({"cosim", "-", "--mutant", "23", "--json=r.json"}, piped);
  ASSERT_EQ(outcome.status, 1) << outcome.out << outcome.err;
  const Json json = Json::parse(text("r.json"));
  EXPECT_EQ(json["reduced"]["capture"], "out/cosim-stdin-mutant-23-reduced.hpt");
  EXPECT_EQ(paste(json["first_mismatch"]["repro"]).status, 1) << json["first_mismatch"]["repro"];
  const Outcome capture = run({"reduce", "-", "--mutant", "23", "-o", "-"}, piped);
  EXPECT_EQ(capture.status, 0) << capture.err;
  EXPECT_TRUE(capture.out.starts_with("halfplane 1\n")) << capture.out;
  EXPECT_NE(capture.err.find("MISMATCH"), std::string::npos) << capture.err;
  EXPECT_NE(capture.err.find("none beside a capture on stdout"), std::string::npos) << capture.err;
}

TEST_F(RtlCommands, ACaptureThatCannotBeWrittenIsNotWhatIsRepeated) {
  write("out", "where the folder should be");
  const Outcome outcome = run({"cosim", "--random", "200", "--mutant", "1", "--stalls", "0.2"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("cannot write 'out/cosim-random-1-mutant-1.hpt'"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("waveform  none"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("--random 200"), std::string::npos) << outcome.out;
  EXPECT_EQ(run(repeat_command(outcome.out)).status, 1) << outcome.out;
}

TEST_F(RtlCommands, ReduceOfAFailingSceneStillFailsAndIsSmall) {
  const Json json = result({"reduce", "teapot:3", "--size", "160x120", "--mutant", "23", "-o", "small.hpt"});
  EXPECT_EQ(json["schema"], "halfplane.reduce/1");
  EXPECT_EQ(json["capture"], "small.hpt");
  EXPECT_GT(json["triangles"]["before"], 100u);
  EXPECT_LE(json["triangles"]["after"], 3u);
  EXPECT_EQ(run({"cosim", "small.hpt", "--mutant", "23"}).status, 1);
  expect_refused({"reduce", "small.hpt"}, "does not fail");
}

TEST_F(RtlCommands, CyclesCanBeLeftOutOfTheComparison) {
  const Json result = this->result({"cosim", "--random", "50", "--config", "tiny", "--ignore-cycles"});
  for (const auto& [name, crossings] : result["crossings"].items()) EXPECT_EQ(crossings, 0) << name;
  EXPECT_GT(result["packets"]["fine_raster"], 0);
  EXPECT_EQ(result["mismatches"], 0);
  const Outcome outcome = run({"cosim", "--random", "60", "--mutant", "3", "--ignore-cycles"});
  EXPECT_EQ(outcome.status, 1) << "bits are compared";
  EXPECT_NE(outcome.out.find("--ignore-cycles --mutant 3"), std::string::npos) << outcome.out;
}

TEST_F(RtlCommands, WhatTheHardwareLacksIsNamed) {
  write("perspective.hpt",
        "halfplane 1\ntarget 32 32\nspace window\nstate color_interp perspective\nv 1 1 .5 1\nv 9 1 .5 1\nv 1 9 .5 1\n"
        "t 0 1 2\n");
  for (const Arguments& command : {Arguments{"cosim"}, {"render", "--engine", "rtl"}, {"reduce", "--mutant", "1"}}) {
    Arguments words = command;
    words.insert(words.begin() + 1, "perspective.hpt");
    expect_refused(words, "color_interp");
  }
  expect_refused({"cosim", "triangle", "--size", "4000x40"}, "4000x40");
  expect_refused({"cosim"}, "--random");
  expect_refused({"cosim", "triangle", "--random", "5"}, "leave one of them out");
  expect_refused({"cosim", "--random", "5", "--size", "8x8"}, "leave --size out, or give a SCENE in place of --random");
  expect_refused({"cosim", "--random", "5", "--camera", "fov=9"}, "leave --camera out, or give a SCENE in place of");
  expect_refused({"cosim", "triangle", "--mutant", "1000"}, "no mutant has the number 1000; give 1 to ");
  expect_refused({"cosim", "triangle", "--mutant", "1", "--config", "small", "--size", "8x8"}, "has no mutants");
  expect_refused({"mutants", "--config", "small"}, "has no mutants");
  expect_refused({"render", "triangle", "--engine", "rtl", "--ids", "ids.npy"}, "leave out --count and --ids");
  expect_refused({"render", "triangle", "--engine", "rtl", "--count", "count.npy"}, "leave out --count and --ids");
}

TEST_F(RtlCommands, AConfigurationWithoutRtlIsRefusedWithTheCommandThatBuildsIt) {
  const std::string part = "run ./dev build --config embedded --set stamp.size=8";
  const Arguments settings{"--config", "embedded", "--set", "stamp.size=8"};
  for (const Arguments& command : {Arguments{"cosim", "triangle"},
                                   {"render", "triangle", "--engine", "rtl"},
                                   {"reduce", "triangle"},
                                   {"mutants"}}) {
    Arguments words = command;
    words.insert(words.end(), settings.begin(), settings.end());
    expect_refused(words, part, 3);
  }
}

TEST_F(RtlCommands, EveryBuiltInSceneHasTheSameHashesInRtlAndFunctionalEngine) {
  for (const Builtin& builtin : builtin_scenes()) {
    std::string name(builtin.name);
    if (builtin.default_size != 0) name += ":" + std::to_string(std::max(builtin.min_size, builtin.default_size / 4));
    const Json rtl = result({"render", name, "--size", "160x120", "--engine", "rtl"});
    const Json functional = result({"render", name, "--size", "160x120"});
    for (const char* key : {"color_hash", "depth_hash", "primitives"}) EXPECT_EQ(rtl[key], functional[key]) << name;
    EXPECT_EQ(rtl["fragments"]["written"], functional["fragments"]["written"]) << name;
    EXPECT_GT(rtl["cycles"], 0u);
    EXPECT_GT(rtl["stages"]["fine_raster"]["items"], 0u);
  }
}

TEST_F(RtlCommands, TilesThatHizSkipsAreCountedWhereAnEngineHasHiz) {
  std::string capture = "halfplane 1\ntarget 96 96\nspace window\n";
  for (const char* z : {"0.1", "0.2", "0.3"})
    capture += std::string("v 0 0 ") + z + " 1\nv 200 0 " + z + " 1\nv 0 200 " + z + " 1\n";
  write("layers.hpt", capture + "t 0 1 2\nt 3 4 5\nt 6 7 8\n");
  for (const char* engine : {"rtl", "functional"})
    EXPECT_GT(result({"render", "layers.hpt", "--engine", engine})["skipped"]["tiles_hiz"], 100u) << engine;
  for (const char* engine : {"scalar", "golden"})
    EXPECT_EQ(result({"render", "layers.hpt", "--engine", engine})["skipped"]["tiles_hiz"], 0u) << engine;
}

TEST_F(RtlCommands, MutantsThatARunTooShortMissesAreAFailure) {
  const Outcome outcome = run({"mutants", "--random", "50", "--stalls", "0", "--only", "1,2,432", "--json=m.json"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("NOT CAUGHT"), std::string::npos) << outcome.out;
  const Json json = Json::parse(text("m.json"));
  ASSERT_EQ(json["mutants"].size(), 3u);
  EXPECT_EQ(json["mutants"][2]["id"], 432);
  EXPECT_EQ(json["caught"], 1);
  EXPECT_TRUE(json["pictures_unchanged"].is_null());
  const Outcome refused = run({"mutants", "--only", "1,60000"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("no mutant 60000"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace halfplane::cli::cosim_test
