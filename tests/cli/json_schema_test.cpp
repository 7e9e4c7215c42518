// Every result of --json against its schema in docs/json, by tests/cli/check_json.py.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::json_schema_test {
namespace {

class JsonSchema : public Cli {
 protected:
  [[nodiscard]] static std::string schema_path(const std::string& command) {
    return HALFPLANE_SOURCE_DIR "/docs/json/halfplane." + command + ".schema.json";
  }

  /// The checker's faults of files in the folder, a line each; `words` go before the schema.
  [[nodiscard]] std::vector<std::string> faults(const std::string& words, const std::string& command,
                                                const std::string& files) const {
    const std::string line = "cd '" + folder_.string() +
                             "' && python3 '" HALFPLANE_SOURCE_DIR "/tests/cli/check_json.py' " + words + " '" +
                             schema_path(command) + "' " + files + " 2>&1";
    std::FILE* pipe = popen(line.c_str(), "r");
    if (pipe == nullptr) return {"no shell"};
    std::string text;
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
    const int status = WEXITSTATUS(pclose(pipe));
    auto lines = lines_of(text);
    EXPECT_EQ(status, lines.empty() ? 0 : 1) << text;
    return lines;
  }

  /// Runs each and expects results in which the schema requires nothing more and describes everything.
  void expect_results(const std::string& command, const std::vector<std::string>& runs, int status = 0) const {
    std::string files;
    for (const std::string& words : runs) {
      Arguments arguments = split_words(command + " " + words);
      const std::string file = "result" + std::to_string(&words - runs.data()) + ".json";
      arguments.insert(arguments.end(), {"--quiet", "--json=" + file});
      const Outcome outcome = run(arguments);
      ASSERT_EQ(outcome.status, status) << testing::PrintToString(arguments) << outcome.err;
      files += " " + file;
    }
    for (const std::string& fault : faults("--described", command, files)) ADD_FAILURE() << fault;
  }
};

TEST_F(JsonSchema, RenderIsDescribed) {
  expect_results("render", {"triangle --size 16x16", "triangle --size 16x16 --engine scalar",
                            "teapot:2 --size 16x16 --engine golden --config full",
                            "triangle --size 16x16 --engine cycle --what-if cache.lines=1,4 --repeat 2",
                            "triangle --size 16x16 --engine cycle --memory sdram --stalls 0.2",
                            "triangle --size 16x16 --engine cycle --set frame.order=bins --set frame.store=color"});
}

TEST_F(JsonSchema, FramesAreDescribed) {
  ASSERT_EQ(run({"render", "teapot:2", "--size", "16x16", "--frames", "2", "--camera", "orbit", "--engine", "cycle",
                 "--quiet", "--json=frames.json"})
                .status,
            0);
  for (const std::string& fault : faults("--described", "frames", "frames.json")) ADD_FAILURE() << fault;
}

TEST_F(JsonSchema, CompareIsDescribed) {
  write("t.hpt",
        "halfplane 1\ntarget 32 32\ntexture t pattern grid 16 16\nspace window\nstate texture t\n"
        "state color_interp perspective\nv 1 1 0.5 1 255 0 0 255 0 0\nv 30 2 0.5 4 0 255 0 255 1 0\n"
        "v 5 30 0.5 2 0 0 255 255 0 1\nt 0 1 2\n");
  expect_results("compare", {"t.hpt"});
  expect_results("compare", {"triangle --size 32x32", "teapot:2 --size 32x32", "wires --size 32x32",
                             "triangle --size 32x32 --traversal bbox", "teapot:2 --size 32x32 --light phong",
                             "teapot:2 --size 32x32 --light phong --set setup.kind=serial"});
}

TEST_F(JsonSchema, ForeignImagesAreDescribed) {
  ASSERT_EQ(run({"render", "triangle", "--size", "32x32", "-o", "a.png", "--set", "subpixel.bits=0"}).status, 0);
  ASSERT_EQ(run({"render", "triangle", "--size", "32x32", "--depth", "a.npy"}).status, 0);
  expect_results("compare", {"triangle --size 32x32 --against a.npy"});
  expect_results("compare", {"triangle --size 32x32 --against a.png"}, 1);
}

TEST_F(JsonSchema, FoldersOfScenesAreDescribed) {
  ASSERT_EQ(paste("mkdir s i").status, 0);
  ASSERT_EQ(run({"convert", "triangle", "--size", "16x16", "-o", "s/a.hpt"}).status, 0);
  ASSERT_EQ(run({"render", "s/a.hpt", "-o", "i/a.png", "--quiet"}).status, 0);
  ASSERT_EQ(run({"compare", "s", "--against", "i", "--quiet", "--json=f.json"}).status, 0);
  for (const std::string& fault : faults("--described", "compare.folder", "f.json")) ADD_FAILURE() << fault;
}

TEST_F(JsonSchema, ReductionsByAForeignProgramAreDescribed) {
  ASSERT_EQ(run({"convert", "triangle", "--size", "16x16", "-o", "a.hpt"}).status, 0);
  ASSERT_EQ(run({"reduce", "a.hpt", "--command", "! grep -q ^t {}", "-o", "b.hpt", "--quiet", "--json=f.json"}).status,
            0);
  for (const std::string& fault : faults("--described", "reduce", "f.json")) ADD_FAILURE() << fault;
}

TEST_F(JsonSchema, DepthIsDescribed) {
  expect_results("depth",
                 {"--near 1 --far 100", "--near 1 --far 10 --mapping stdinf,revinf,log --format uf4.12 --error 0.1",
                  "--scene coplanar --size 32x24 --bits 16 --sweep --slope 1"});
}

TEST_F(JsonSchema, StressIsDescribed) {
  expect_results("stress",
                 {"--case fans --config tiny --seconds 0.05 --captures worst", "--case fans,mean_bias --seconds 0.05"});
}

TEST_F(JsonSchema, TheListOfStressCasesIsDescribed) {
  ASSERT_EQ(run({"stress", "--list", "--quiet", "--json=list.json"}).status, 0);
  for (const std::string& fault : faults("--described", "stress.list", "list.json")) ADD_FAILURE() << fault;
}

TEST_F(JsonSchema, WidthsAreDescribed) {
  write("t.hpt",
        "halfplane 1\ntarget 16 16\ntexture t pattern grid 16 16\nspace window\nstate texture t\n"
        "v 1 1 0.5 1 255 0 0 255 0 0\nv 15 2 0.5 4 0 255 0 255 1 0\nv 5 15 0.5 2 0 0 255 255 0 1\nt 0 1 2\n");
  expect_results("widths", {"--smallest --scene t.hpt --config tiny --texture-error 0.1", "--config tiny --samples 100",
                            "--smallest --scene triangle --size 32x32 --depth-error 1lsb"});
}

TEST_F(JsonSchema, BenchIsDescribed) {
  expect_results("bench", {"triangle --size 16x16 --space --vary stamp.size=1,2"});
  expect_results("bench", {"--antialiasing --size 48x32 --repeat 1"});
  expect_results("bench", {"triangle --size 16x16 --repeat 1 --engines functional,golden,cycle",
                           "triangle --size 16x16 --repeat 1 --skips --growth --growth-max 100"});
}

TEST_F(JsonSchema, ConfigAndScenesAreDescribed) {
  expect_results("config", {"", "--list --widths --stages --config full"});
  expect_results("scenes", {""});
  expect_results("convert", {"triangle -o t.hpt", "--random 60 --config tiny -o r.hpt"});
}

TEST_F(JsonSchema, ExplanationsAreDescribed) {
  write("t.hpt",
        "halfplane 1\ntarget 16 16\ntexture t pattern grid 16 16\nclear depth 1\nspace window\nv 0 0 0.5\nv 9 9 0.5\nl "
        "0 1\n"
        "p 1\nstate texture t\nv 1 1 0.5 1 255 0 0 255 0 0\nv 15 2 0.5 4 0 255 0 255 1 0\n"
        "v 5 15 0.5 2 0 0 255 255 0 1\nt 2 3 4\n");
  expect_results("explain", {"triangle 8 8 --size 16x16 --steps", "t.hpt 8 8 --box 2x2 --steps",
                             "t.hpt 8 8 --set msaa.samples=2", "t.hpt 8 8 --set texture.unit=nearest"});
}

TEST_F(JsonSchema, CoverageIsDescribed) {
  expect_results("vectors", {"--random 50 --stage cull -o v.jsonl --coverage c.json"});
  expect_results("cover", {"c.json", "c.json c.json -o d.json"});
  for (const std::string& fault : faults("--described", "coverage", "c.json d.json")) ADD_FAILURE() << fault;
}

TEST_F(JsonSchema, VectorsAndTheirJudgementAreDescribed) {
  expect_results("vectors",
                 {"triangle --size 16x16 --stage cull -o v.jsonl", "--random 20 --stage rop --format hex -o v"});
  expect_results("check", {"--stage cull v.jsonl", "--stage rop v", "--stage cull v.jsonl --coverage c.json"});
  std::string text;
  {
    std::ifstream file(folder_ / "v.jsonl");
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  const std::size_t at = text.find("\"dir\":\"out\"");
  ASSERT_NE(at, std::string::npos);
  text[text.find("\"area\":\"0x", at) + 10] = '1';
  write("bad.jsonl", text);
  expect_results("check", {"--stage cull bad.jsonl"}, 1);
}

/// Schemas of the commands that run the RTL.
class RtlJsonSchema : public JsonSchema {
 protected:
  void SetUp() override { skip_without_rtl(); }
};

TEST_F(RtlJsonSchema, CosimIsDescribed) {
  expect_results("cosim", {"triangle --size 16x16", "--random 20 --memory sdram",
                           "--random 90 --random-only less --first-scene 2 --scenes 1"});
  expect_results("render",
                 {"triangle --size 16x16 --engine rtl", "triangle --size 16x16 --engine rtl --set frame.order=bins"});
  expect_results("explain", {"triangle 8 8 --size 16x16 --rtl"});
}

TEST_F(RtlJsonSchema, MismatchesAreDescribed) {
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 20\n");
  expect_results("regress", {"p.toml"});
  write("q.toml", "[r]\nrandom = 60\noptions = \"--mutant 3\"\n");
  expect_results("regress", {"q.toml"}, 1);
  expect_results("cosim", {"triangle --size 32x32 --mutant 11"}, 1);
  expect_results("reduce", {"triangle --size 32x32 --mutant 11"});
  expect_results("mutants", {"--random 20 --only 11,432"}, 1);
}

TEST_F(JsonSchema, EveryCommandWithAResultHasASchema) {
  bool is_list = false;
  int count = 0;
  for (const std::string& line : lines_of(run({"--help"}).out)) {
    if (is_list && line.starts_with("  ") && line[2] != ' ') {
      const std::string command = line.substr(2, line.find(' ', 2) - 2);
      if (run({command, "--help"}).out.find("--json") == std::string::npos) continue;
      ++count;
      std::ifstream file(schema_path(command));
      const Json schema = Json::parse(file, nullptr, false);
      ASSERT_FALSE(schema.is_discarded()) << command;
      EXPECT_EQ(schema["properties"]["schema"]["const"], "halfplane." + command + "/1");
      EXPECT_EQ(schema["additionalProperties"], true) << command << ": keys may be added";
      for (const char* key : {"schema", "config", "scene", "seed", "wall_s", "command"})
        EXPECT_NE(std::find(schema["required"].begin(), schema["required"].end(), key), schema["required"].end())
            << command << " " << key;
    }
    is_list = line == "Subcommands:" || (is_list && !line.empty());
  }
  EXPECT_GE(count, 11);
}

/// Whether every object of the schema describes each of its keys.
void expect_described(const Json& schema, const std::string& where) {
  if (schema.contains("properties"))
    for (const auto& [key, value] : schema["properties"].items()) {
      if (!schema.contains("type")) continue;  // a condition
      EXPECT_TRUE(value.contains("description") || value.contains("$ref")) << where << "/" << key;
      expect_described(value, where + "/" + key);
    }
  for (const char* inner : {"items", "additionalProperties"})
    if (schema.contains(inner) && schema[inner].is_object()) expect_described(schema[inner], where + "/*");
}

TEST_F(JsonSchema, EveryKeyHasADescription) {
  for (const auto& entry : std::filesystem::directory_iterator(HALFPLANE_SOURCE_DIR "/docs/json")) {
    std::ifstream file(entry.path());
    const Json schema = Json::parse(file);
    expect_described(schema, entry.path().stem());
    if (schema.contains("$defs"))
      for (const auto& [name, value] : schema["$defs"].items()) {
        EXPECT_TRUE(value.contains("description")) << name;
        expect_described(value, name);
      }
  }
}

TEST_F(JsonSchema, ResultsWithKeysMissingOrMistypedAreRefused) {
  const Json good = result({"render", "triangle", "--size", "16x16", "--engine", "cycle"});
  std::ifstream file(schema_path("render"));
  std::vector<Json> bad;
  for (const auto& key : Json::parse(file)["required"]) {
    bad.push_back(good);
    bad.back().erase(key.get<std::string>());
  }
  for (const auto& [pointer, value] : std::vector<std::pair<const char*, Json>>{{"/width", "16"},
                                                                                {"/primitives/in", 1.5},
                                                                                {"/fragments/covered", -1},
                                                                                {"/color_hash", "xyz"},
                                                                                {"/schema", "halfplane.render/2"},
                                                                                {"/engine", "software"},
                                                                                {"/config/depth.bits", "16"},
                                                                                {"/stages/cull/busy", nullptr},
                                                                                {"/wall_s", nullptr}}) {
    bad.push_back(good);
    bad.back()[Json::json_pointer(pointer)] = value;
  }
  for (const char* pointer : {"/primitives", "/fragments", "/time_s", "/skipped", "/config"}) {
    bad.push_back(good);  // an empty object in place of a full one
    bad.back()[Json::json_pointer(pointer)] = Json::object();
  }
  bad.push_back(good);
  bad.back().erase("cycles");  // of this engine alone
  std::string files;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const std::string name = "bad" + std::to_string(i) + ".json";
    write(name, bad[i].dump());
    files += " " + name;
  }
  const auto lines = faults("", "render", files);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const std::string start = "bad" + std::to_string(i) + ".json: ";
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const std::string& l) { return l.starts_with(start); }))
        << bad[i].dump();
  }
}

TEST_F(JsonSchema, KeysThatAreAddedAreNoFaultButAreNotDescribed) {
  Json more = result({"render", "triangle", "--size", "16x16"});
  more["new_key"] = 1;
  more["fragments"]["new_key"] = 1;
  more["partial"] = true;
  write("more.json", more.dump());
  EXPECT_TRUE(faults("", "render", "more.json").empty());
  EXPECT_EQ(faults("--described", "render", "more.json").size(), 2u);
}

}  // namespace
}  // namespace halfplane::cli::json_schema_test
