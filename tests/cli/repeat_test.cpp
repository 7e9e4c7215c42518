// `command` of every JSON and JUnit: the command that gives the result again, which is typed again here.
#include "program.hpp"

namespace halfplane::cli::repeat_test {
namespace {

/// The result without its times: keys that end in _s.
Json without_times(const Json& json) {
  if (!json.is_structured()) return json;
  Json rest = json.is_array() ? Json::array() : Json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array())
      rest.push_back(without_times(value));
    else if (!key.ends_with("_s"))
      rest[key] = without_times(value);
  }
  return rest;
}

class Repeat : public Cli {
 protected:
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }

  /// Runs, types the command in the result, and expects the same result.
  void expect_repeated(const std::string& words, int status = 0) const {
    SCOPED_TRACE(words);
    Arguments arguments = split_words(words);
    arguments.insert(arguments.end(), {"--quiet", "--json"});
    const Outcome first = run(arguments);
    ASSERT_EQ(first.status, status) << first.err;
    const Json json = Json::parse(first.out);
    ASSERT_TRUE(json["command"].is_string());
    const Outcome again = paste(json["command"]);
    EXPECT_EQ(again.status, status) << json["command"] << again.err;
    EXPECT_TRUE(without_times(Json::parse(again.out, nullptr, false)) == without_times(json)) << json["command"];
  }

  /// A property of the suite in a file of JUnit; empty: there is none.
  [[nodiscard]] std::string property(const std::string& file, const std::string& name) const {
    const std::string xml = text(file), start = "<property name=\"" + name + "\" value=\"";
    const std::size_t at = xml.find(start);
    if (at == std::string::npos) return "";
    std::string value = xml.substr(at + start.size(), xml.find('"', at + start.size()) - at - start.size());
    for (std::size_t amp = value.find("&amp;"); amp != std::string::npos; amp = value.find("&amp;", amp + 1))
      value.replace(amp, 5, "&");
    return value;
  }

  /// The command in a file of JUnit writes the file again, with the same content but for times.
  void expect_written_again(const std::string& file) const {
    const auto content = [&] {
      std::string xml = text(file);
      if (const std::size_t at = xml.find(" time=\""); at != std::string::npos)
        xml.erase(at, xml.find('"', at + 7) + 1 - at);
      return xml;
    };
    const std::string repeat = property(file, "command"), first = content();
    std::filesystem::remove(folder_ / file);
    EXPECT_EQ(paste(repeat).status, 0) << repeat;
    EXPECT_EQ(content(), first) << repeat;
  }
};

TEST_F(Repeat, TheCommandOfEveryResultGivesItAgain) {
  write("my one.hpt", "halfplane 1\ntarget 16 16\nspace window\nv 1 1 .5\nv 9 1 .5\nv 1 9 .5\nt 0 1 2\n");
  for (const char* words :
       {"render dust:50 --size 32x24 --seed 5 --engine cycle --stalls 0.3 --set depth.bits=20",
        "render 'my one.hpt' -o 'a & b.png'", "render teapot:2 --size 16x16 --frames 2 --camera orbit",
        "compare dust:50 --size 32x24 --seed 5", "explain dust:50 8 8 --size 16x16 --seed 5",
        "vectors --random 20 --seed 5 --config tiny --stage cull -o v.jsonl", "check --stage cull v.jsonl",
        "convert --random 20 --seed 5 --config tiny -o r.hpt", "widths --config tiny --samples 100 --seed 5",
        "widths --smallest --scene triangle --size 32x32 --depth-error 1lsb",
        "depth --scene coplanar --size 32x24 --bits 16", "stress --case zero_area --unit 3 --seed 5", "stress --list",
        "bench triangle --size 16x16 --space --vary stamp.size=1,2", "config --set depth.bits=20", "scenes"})
    expect_repeated(words);
}

TEST_F(Repeat, SceneSeedAndConfigurationOfACheckAreThoseOfItsVectors) {
  for (const char* format : {"jsonl", "csv", "hex"}) {
    const std::string file = std::string("v.") + format;
    ASSERT_EQ(run({"vectors", "dust:50", "--size", "16x16", "--seed", "9", "--config", "tiny", "--set", "depth.bits=10",
                   "--stage", "cull", "--format", format, "-o", file})
                  .status,
              0);
    const Json json = result({"check", "--stage", "cull", file, "--junit", "c.xml"});
    EXPECT_EQ(json["scene"], "dust:50") << format;
    EXPECT_EQ(json["seed"], 9) << format;
    EXPECT_EQ(json["config"]["depth.bits"], 10) << format;
    EXPECT_EQ(property("c.xml", "scene"), "dust:50");
    EXPECT_EQ(property("c.xml", "seed"), "9");
    EXPECT_EQ(property("c.xml", "config"), "--config tiny --set depth.bits=10");
    EXPECT_EQ(property("c.xml", "command"), json["command"]);
    expect_written_again("c.xml");
  }
}

TEST_F(Repeat, JunitOfStressSaysHowItIsRepeated) {
  ASSERT_EQ(
      run({"stress", "--case", "zero_area", "--unit", "3", "--seed", "8", "--config", "tiny", "--junit", "a & b.xml"})
          .status,
      0);
  EXPECT_EQ(property("a & b.xml", "seed"), "8");
  EXPECT_EQ(property("a & b.xml", "config"), "--config tiny");
  expect_written_again("a & b.xml");
}

class RtlRepeat : public Repeat {
 protected:
  void SetUp() override { skip_without_rtl(); }
};

TEST_F(RtlRepeat, CosimAndWhatFailsAreRepeated) {
  expect_repeated("cosim --random 60 --seed 5 --stalls 0.2 --config tiny");
  expect_repeated("cosim triangle --size 16x16 --mutant 11", 1);
  expect_repeated("reduce triangle --size 32x32 --mutant 11 -o small.hpt");
  ASSERT_EQ(run({"cosim", "--random", "60", "--seed", "5", "--config", "tiny", "--junit", "c.xml"}).status, 0);
  EXPECT_EQ(property("c.xml", "seed"), "5");
  EXPECT_EQ(property("c.xml", "config"), "--config tiny");
  expect_written_again("c.xml");
}

}  // namespace
}  // namespace halfplane::cli::repeat_test
