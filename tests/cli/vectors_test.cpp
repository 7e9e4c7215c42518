// `halfplane vectors` and `halfplane check`: another implementation's stage, judged.
#include <filesystem>

#include "program.hpp"

namespace halfplane::cli::vectors_test {
namespace {

class VectorsCommand : public Cli {
 protected:
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }
  /// Lines of a file with one of them changed.
  void change(const std::string& from, const std::string& to, const std::string& part, const std::string& by,
              std::size_t which = 0) const {
    std::string all = text(from);
    std::size_t at = all.find(part);
    for (; which > 0 && at != std::string::npos; --which) at = all.find(part, at + 1);
    ASSERT_NE(at, std::string::npos) << part;
    write(to, all.replace(at, part.size(), by));
  }
};

TEST_F(VectorsCommand, EveryStageInEveryFormatIsJudgedEqual) {
  for (const char* stage : {"cull", "triangle_setup", "coarse_raster", "fine_raster", "interpolate", "line_raster",
                            "primitive_join", "depth_test", "rop", "framebuffer", "memory_port", "memory"})
    for (const char* format : {"jsonl", "csv", "hex"}) {
      const std::string file = std::string(stage) + "." + format;
      const Json made = result({"vectors", "star:3", "--size", "16x16", "--config", "tiny", "--stage", stage,
                                "--format", format, "-o", file});
      EXPECT_EQ(made["can_be_checked"], true);
      const Json judged = result({"check", "--stage", stage, file});
      EXPECT_EQ(judged["packets"]["mismatches"], 0) << file;
      EXPECT_EQ(judged["packets"]["in"], made["in"]) << file;
      EXPECT_EQ(judged["packets"]["out"], made["out"]) << file;
      EXPECT_EQ(judged["config"], made["config"]);
    }
}

TEST_F(VectorsCommand, AForeignBitIsFoundByFieldAndBits) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "fine_raster", "-o", "v.jsonl"}).status, 0);
  change("v.jsonl", "bad.jsonl", "\"mask\":\"0xf\"", "\"mask\":\"0xe\"", 2);
  const Outcome outcome = run({"check", "--stage", "fine_raster", "bad.jsonl", "--json=r.json", "--junit", "j.xml"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("DIFFERENT  1 packets; the first: stamp"), std::string::npos) << outcome.out;
  const Json first = Json::parse(text("r.json"))["packets"]["first_mismatch"];
  EXPECT_EQ(first["packet"], "stamp");
  ASSERT_EQ(first["fields"].size(), 1U);
  EXPECT_EQ(first["fields"][0], Json::parse(R"({"field":"mask","bits":4,"expected":"0xf","got":"0xe"})"));
  EXPECT_NE(text("j.xml").find("failures=\"1\""), std::string::npos);
}

TEST_F(VectorsCommand, BitsWithoutAValueAreNamedByTheirField) {
  const Arguments vectors{"vectors", "triangle", "--size", "16x16", "--stage", "fine_raster"};
  Arguments lines = vectors, hex = vectors;
  lines.insert(lines.end(), {"-o", "v.jsonl"});
  hex.insert(hex.end(), {"--format", "hex", "-o", "v"});
  ASSERT_EQ(run(lines).status, 0);
  ASSERT_EQ(run(hex).status, 0);
  change("v.jsonl", "bad.jsonl", "\"mask\":\"0xf\"", "\"mask\":\"0xX\"", 0);
  const Outcome outcome = run({"check", "--stage", "fine_raster", "bad.jsonl", "--json=r.json"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("DIFFERENT  1 packets; the first: undefined bits in field mask of stamp "),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(Json::parse(text("r.json"))["packets"]["first_mismatch"]["fields"][0]["undefined"], "0xf");
  std::string stamps = text("v/stamp.hex");
  stamps[0] = 'x';
  write("v/stamp.hex", stamps);
  const Outcome of_hex = run({"check", "--stage", "fine_raster", "v"});
  EXPECT_EQ(of_hex.status, 1);
  EXPECT_NE(of_hex.out.find("undefined bits in field kind of stamp 0"), std::string::npos) << of_hex.out;
  change("v.jsonl", "in.jsonl", "\"right\":\"0x7\"", "\"right\":\"0xz\"", 0);
  expect_refused({"check", "--stage", "fine_raster", "in.jsonl"}, "'right' has undefined bits");
}

TEST_F(VectorsCommand, OutAloneIsJudgedBesideTheVectorsItWasMadeFrom) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "-o", "v.jsonl"}).status, 0);
  std::string mine;
  for (const std::string& line : lines_of(text("v.jsonl")))
    if (line.find("\"dir\":\"in\"") == std::string::npos) mine += line + "\n";
  write("mine.jsonl", mine);
  EXPECT_EQ(run({"check", "--stage", "cull", "mine.jsonl"}).status, 1) << "everything is too much";
  EXPECT_EQ(run({"check", "--stage", "cull", "mine.jsonl", "--vectors", "v.jsonl"}).status, 0);
}

TEST_F(VectorsCommand, HexIsWhatReadmemhReads) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "--format", "hex", "-o", "v"}).status, 0);
  const auto lines = lines_of(text("v/triangle.hex"));
  const Json header = Json::parse(text("v/header.json"));
  const std::size_t bits = header["out"][0]["bits"];
  ASSERT_FALSE(lines.empty());
  for (const std::string& line : lines) EXPECT_EQ(line.size(), (bits + 3) / 4);
  std::string spaced = "// by hand\n";
  for (const std::string& line : lines) spaced += "0x" + line.substr(0, 4) + "_" + line.substr(4) + " // a packet\n";
  write("v/triangle.hex", spaced);
  EXPECT_EQ(run({"check", "--stage", "cull", "v"}).status, 0);
}

TEST_F(VectorsCommand, HexOfWhatCameOutIsJudgedBesideTheVectors) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "--format", "hex", "-o", "v"}).status, 0);
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "-o", "v.jsonl"}).status, 0);
  ASSERT_TRUE(std::filesystem::remove(folder_ / "v" / "primitive.hex"));
  expect_refused({"check", "--stage", "cull", "v"}, "primitive.hex");
  EXPECT_EQ(run({"check", "--stage", "cull", "v", "--vectors", "v.jsonl"}).status, 0);
}

TEST_F(VectorsCommand, APlaceOutsideTheTargetIsAMismatchOfWhatCameOut) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "-o", "v.jsonl"}).status, 0);
  std::string all = text("v.jsonl");
  const std::string right = "\"right\":\"0x00";
  const std::size_t at = all.find(right, all.find("\"dir\":\"out\""));
  ASSERT_NE(at, std::string::npos);
  write("out.jsonl", all.replace(at, right.size(), "\"right\":\"0x7f"));
  EXPECT_EQ(run({"check", "--stage", "cull", "out.jsonl"}).status, 1);
}

TEST_F(VectorsCommand, NothingComparedIsNoSuccess) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "line_raster", "-o", "v.jsonl"}).status, 0);
  const Outcome outcome = run({"check", "--stage", "line_raster", "v.jsonl"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("nothing was compared"), std::string::npos);
}

TEST_F(VectorsCommand, AFileWithoutAnEndIsRefused) {
  expect_refused({"check", "--stage", "cull", "/dev/zero"}, "/dev/zero:1: a line of more than");
  write("endless.hpt", "halfplane 1\ntarget 8 8\ntexture T file /dev/zero\n");
  expect_refused({"render", "endless.hpt"}, "endless.hpt:3: /dev/zero: more than");
  std::filesystem::create_symlink("/dev/zero", folder_ / "endless.npy");
  expect_refused({"compare", "triangle", "--size", "16x16", "--against", "endless.npy"}, "no array of depth codes");
}

TEST_F(VectorsCommand, BadInputIsRefusedWithFileAndLine) {
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "-o", "v.jsonl"}).status, 0);
  expect_refused({"check", "--stage", "cul", "v.jsonl"}, "did you mean cull?");
  expect_refused({"check", "--stage", "rop", "v.jsonl"}, "has vectors of cull");
  expect_refused({"check", "--stage", "cull", "none.jsonl"}, "none.jsonl: there is no such file");
  expect_refused({"vectors", "triangle", "--stage", "cull"}, "-o is required");
  expect_refused({"vectors", "--stage", "cull", "-o", "x"}, "nothing to run");
  expect_refused({"vectors", "triangle", "--stage", "texture_unit", "-o", "x"}, "set texture.unit to nearest");
  expect_refused({"vectors", "triangle", "--stage", "cull", "--format", "hex", "-o", "-"}, "a folder");
  change("v.jsonl", "a.jsonl", "\"kind\":\"0x", "\"kind\":\"0xg");
  expect_refused({"check", "--stage", "cull", "a.jsonl"}, "a.jsonl:2: 'kind' is '0xg");
  change("v.jsonl", "b.jsonl", "\"kind\":\"0x", "\"kind\":\"0xff");
  expect_refused({"check", "--stage", "cull", "b.jsonl"}, "b.jsonl:2: 'kind' has 3 bits");
  change("v.jsonl", "c.jsonl", "\"kind\":", "\"kin\":");
  expect_refused({"check", "--stage", "cull", "c.jsonl"}, "c.jsonl:2: there is no \"kind\"");
  change("v.jsonl", "d.jsonl", "\"n\":1", "\"n\":7");
  expect_refused({"check", "--stage", "cull", "d.jsonl"}, "packet 7 where 1 is due");
  change("v.jsonl", "e.jsonl", "\"depth.bits\":16", "\"depth.bits\":99");
  expect_refused({"check", "--stage", "cull", "e.jsonl"}, "e.jsonl:1: in the header, depth.bits");
  change("v.jsonl", "f.jsonl", "\"in\",\"packet\":\"primitive\"", "\"in\",\"packet\":\"tile\"");
  expect_refused({"check", "--stage", "cull", "f.jsonl"}, "'tile' is no packet that goes into cull");
  change("v.jsonl", "i.jsonl", "\"right\":\"0x00", "\"right\":\"0x7f");
  expect_refused({"check", "--stage", "cull", "i.jsonl"}, "i.jsonl:2: 'right' is 20");
  write("g.jsonl", "{\"schema\":1}\n");
  expect_refused({"check", "--stage", "cull", "g.jsonl"}, "g.jsonl:1:");
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "cull", "--format", "csv", "-o", "v.csv"}).status,
            0);
  const auto rows = lines_of(text("v.csv"));
  ASSERT_EQ(rows[1].substr(0, 7), "config,");
  write("j.csv", rows[0] + "\n" + rows[1] + "\n" + rows[1] + "\n");
  expect_refused({"check", "--stage", "cull", "j.csv"}, "j.csv:3: a second line begins with config");
  write("k.jsonl", lines_of(text("v.jsonl"))[0] + "\n{\"dir\":\"" + std::string(500, 'x') +
                       "\",\"packet\":\"triangle\",\"n\":0}\n");
  const std::string said = run({"check", "--stage", "cull", "k.jsonl"}).err;
  EXPECT_LT(said.size(), 200U) << said;
  write("h.csv", "a,b\n");
  expect_refused({"check", "--stage", "cull", "h.csv"}, "h.csv:1: these are no vectors");
  ASSERT_EQ(run({"vectors", "triangle", "--size", "16x16", "--stage", "viewport", "-o", "w.jsonl"}).status, 0);
  expect_refused({"check", "--stage", "viewport", "w.jsonl"}, "cannot be judged: it is the host's");
}

}  // namespace
}  // namespace halfplane::cli::vectors_test
