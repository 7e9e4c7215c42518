// Bad input of every kind: one line that begins "halfplane: ", status 2 (3 for a missing capability of the machine), no
// file made.
#include "program.hpp"

namespace halfplane::cli::errors_test {
namespace {

class BadInput : public Cli {
 protected:
  /// Expects both commands that read scenes to refuse a file of this text with `part`.
  void expect_file_refused(const std::string& name, const std::string& text, const std::string& part) const {
    write(name, text);
    for (const char* command : {"render", "compare"}) expect_refused({command, name}, part);
  }
  /// Expects the third line of a capture to be refused, by name and line.
  void expect_third_line_refused(const std::string& line) const {
    expect_file_refused("bad.hpt", "halfplane 1\ntarget 64 48\n" + line + "\n", "bad.hpt:3: ");
  }
};

TEST_F(BadInput, CommandThatDoesNotExistIsNamedWithThoseThatDo) {
  expect_refused({}, "render teapot");
  expect_refused({""}, "render, compare, cosim, reduce, mutants, depth, bench, stress, scenes, widths, config");
  expect_refused({"rendr", "teapot"}, "no command 'rendr'");
  expect_refused({"sweep", "teapot"}, "no command 'sweep' in this version");
  expect_refused({"teapot.obj"},
                 "render, compare, cosim, reduce, mutants, depth, bench, stress, scenes, widths, config");
  expect_refused({"--nonsense"}, "halfplane --help");
}

TEST_F(BadInput, WrongUsageNamesTheOptionAndWhereItIsExplained) {
  expect_refused({"render"}, "SCENE is required; see `halfplane render --help`");
  expect_refused({"render", "triangle", "--nonsense"}, "--nonsense");
  expect_refused({"render", "triangle", "second"}, "second");
  expect_refused({"render", "triangle", "--size", "8x8", "--size", "9x9"}, "--size");
  expect_refused({"compare", "triangle", "--golden", "binary16"}, "binary32");
  expect_refused({"scenes", "extra"}, "extra");
  expect_refused({"config", "--sv", "--json"}, "--sv");
  expect_refused({"config", "--c-header", "--sv"}, "--sv");
  for (const char* output : {"--sv", "--taps", "--dpi", "--c-header", "--toml"})
    for (const char* other : {"--list", "--widths", "--stages"}) expect_refused({"config", output, other}, other);
  expect_refused({"bench", "teapot", "--scan-out", "60", "--size", "32x32"},
                 "'--scan-out 60' is for --area and --space");
  expect_refused({"--json", "render", "triangle"}, "--json");
}

TEST_F(BadInput, RefusalsSayWhatIsWrongAndThenWhatToDo) {
  write("a.hpt", "halfplane 1\n");
  expect_refused({"render", "triangle", "-o", "picture"},
                 "'picture': this option writes .png files; give a name that ends in .png");
  expect_refused({"render", "triangle", "--depth", "d.txt"},
                 "or up to 16 bits as .png; give a name that ends in one of them");
  expect_refused({"render", "triangle", "-o", "a.png", "--draws", "a.png"},
                 "two options name the file 'a.png', and one would replace the other; give each its own");
  expect_refused({"render", "triangle", "--heat", "h.png", "--mhz", "7"},
                 "--mhz, --heat: the engine functional does not have it; add --engine cycle");
  expect_refused({"render", "triangle", "--cull-objects", "no"}, "no value 'no'; give none, sphere, box or both");
  expect_refused({"render", "triangle", "--convention", "dx"}, "no convention 'dx'; give one of gl, ");
  expect_refused({"compare", "triangle", "--panels", "model"}, "no sheet to choose from; add -o");
  expect_refused({"depth", "--near", "1", "--far", "9", "--camera", "fov=9"}, "no scene to look at; add --scene");
  expect_refused({"depth", "--near", "1", "--far", "9", "--error", "0"}, "'0' is not above 0; give more");
  expect_refused({"depth", "--near", "1", "--far", "9", "--error", "1", "--range", "0,3"}, "A,B with 1 <= A < B <= 9");
}

TEST_F(BadInput, NumbersOfOptionsAreCheckedWhole) {
  for (const auto& [option, word] : {std::pair{"--other-traffic", "1e7"},
                                     {"--other-traffic", "10M"},
                                     {"--mhz", "1.5"},
                                     {"--scan-out", "abc"},
                                     {"--scan-out", ""}})
    expect_refused({"render", "triangle", "--engine", "cycle", option, word},
                   "'" + std::string(word) + "' is not a whole number; give ");
  expect_refused({"render", "triangle", "--engine", "cycle", "--scan-out", "1001"}, "1001 not in range 0 to 1000");
  for (const char* size : {"", "0x0", "0x480", "640x0", "-4x4", "640", "640x", "x480", "640x480x", "640*480", "4.5x4",
                           "99999999999x1", "nanxnan"})
    expect_refused({"render", "triangle", "--size", size}, "--size");
  for (const char* seed : {"", "-1", "1.5", "1e3", "0x10", "18446744073709551616", "x"})
    expect_refused({"render", "slivers", "--seed", seed}, "--seed");
  for (const char* threads : {"0", "-1", "many", "1025"})
    expect_refused({"render", "triangle", "--threads", threads}, "--threads");
  for (const char* repeat : {"0", "-3", "x"}) expect_refused({"render", "triangle", "--repeat", repeat}, "--repeat");
  for (const char* skip : {"", "nothing", "all,none", "empty,", "frustum;empty"})
    expect_refused({"render", "triangle", "--skip", skip}, "--skip");
}

TEST_F(BadInput, SceneThatDoesNotExistIsNamed) {
  std::filesystem::create_directory(folder_ / "folder.obj");
  std::filesystem::create_directory(folder_ / "folder.hpt");
  for (const char* scene :
       {"nosuch", "nosuch.obj", "nosuch.hpt", "folder.obj", "folder.hpt", "nosuch.gltf", "nosuch.glb"})
    for (const char* command : {"render", "compare"}) expect_refused({command, scene}, scene);
  expect_refused({"render", "teapt"}, "did you mean teapot?");
  expect_refused({"render", ""}, "teapot");
  for (const char* scene : {"teapot:0", "teapot:x", "teapot:", "teapot:99999999999", "triangle:3"})
    expect_refused({"render", scene}, scene);
}

TEST_F(BadInput, CameraIsCheckedPartByPart) {
  for (const char* camera : {"garbage",
                             "eye",
                             "eye=",
                             "eye=1,2",
                             "eye=1,2,3,4",
                             "eye=a,b,c",
                             "eye=nan,0,0",
                             "eye=inf,0,0",
                             "fov=0",
                             "fov=180",
                             "fov=-5",
                             "ortho=0",
                             "near=0",
                             "near=-1",
                             "near=5;far=2",
                             "eye=0,0,0;target=0,0,0",
                             "up=0,0,0",
                             "fov=40;ortho=3",
                             "eye=0,0,5;eye=0,0,6",
                             "name=main",
                             "zoom=2",
                             "=",
                             ";;x"})
    expect_refused({"render", "teapot", "--camera", camera}, "--camera");
  expect_refused({"render", "triangle", "--camera", "fov=40"}, "--camera");  // a scene made in clip space
}

TEST_F(BadInput, LightsAndTransformsThatAreNoneAreRefused) {
  for (const char* light : {"sun", "from=0,0,0", "at=1,2", "eye;range=2"})
    expect_refused({"render", "teapot", "--light", light}, "--light: ");
  expect_refused({"render", "teapot", "--light", "off", "--light", "eye"}, "leave one of them out");
  expect_refused({"render", "star", "--light", "eye"}, "leave the light out");
  expect_refused({"render", "teapot", "--transform", "fixed"}, "write binary64, binary32 or s15.16");
  expect_refused({"render", "star", "--transform", "binary32"}, "leave the transform out");
  expect_refused({"render", "teapot", "--transform", "s15.16", "--camera", "eye=0,0,40000"}, "beyond +-32768");
  expect_refused({"cosim", "--random", "5", "--light", "eye"}, "leave --light out");
}

TEST_F(BadInput, SettingsAreCheckedForNameRangeAndTogether) {
  for (const char* command : {"render", "compare"}) {
    for (const char* setting : {"depth.bits", "=", "=3", "nosuch=1", "depth.bits=", "depth.bits=7", "depth.bits=33",
                                "depth.bits=16.0", "depth.bits=99999999999", "depth.bits=x", "color.format=rgb888",
                                "tile.size=12", "guard.band=3000", "target.width=0", "target.height=16385"})
      expect_refused({command, "triangle", "--set", setting}, "");
    expect_refused({command, "triangle", "--set", "no\nsuch=1"}, "no setting 'no?such'");
  }
  expect_refused({"config", "--set", "depth.bits=99"}, "8...32");
  expect_refused({"config", "--set", "nosuch=1"}, "config --list");
  expect_refused({"config", "--set", "target.width=4096"}, "guard.band");
  expect_refused({"config", "--set", "subpixel.bits=12", "--set", "guard.band=1048576"}, "bound");  // would overflow
}

TEST_F(BadInput, ConfigurationFileIsNamedWithItsLine) {
  std::filesystem::create_directory(folder_ / "folder.toml");
  expect_refused({"render", "triangle", "--config", "nosuch"}, "tiny, small, embedded, full");
  expect_refused({"render", "triangle", "--config", ""}, "tiny, small, embedded, full");
  expect_refused({"render", "triangle", "--config", "nosuch.toml"}, "nosuch.toml");
  expect_refused({"render", "triangle", "--config", "folder.toml"}, "folder.toml");
  write("bad.toml", "preset = \"tiny\"\n[depth]\nbits = 99\n");
  expect_refused({"render", "triangle", "--config", "bad.toml"}, "bad.toml:3: ");
  write("bad.toml", "\n[depth]\nbitz = 9\n");
  expect_refused({"config", "--config", "bad.toml"}, "bad.toml:3: ");
  write("bad.toml", "depth.bits = = 9\n");
  expect_refused({"compare", "triangle", "--config", "bad.toml"}, "bad.toml:1: ");
  write("bad.toml", std::string("\0\xff\xfe", 3));
  expect_refused({"config", "--config", "bad.toml"}, "bad.toml:1: ");
}

TEST_F(BadInput, BrokenMeshIsNamedWithItsLine) {
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "bad.obj:2: ");
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n", "bad.obj:3: ");
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "bad.obj:2: ");
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "bad.obj:4: ");
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "bad.obj:4: ");
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "bad.obj:4: ");
  expect_file_refused("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "no faces (f lines), lines or points");
  expect_file_refused("bad.obj", "", "bad.obj:1: ");
  expect_file_refused("bad.obj", "\x89PNG\r\n\x1a\n", "bad.obj:1: ");
}

TEST_F(BadInput, BrokenCaptureIsNamedWithItsLine) {
  for (const char* line : {"v 0 0 nan",
                           "v inf 0 0",
                           "v 0 0",
                           "v 0 0 0 1 2",
                           "v 1e999 0 0",
                           "t 0 1 2",
                           "t",
                           "nonsense 1",
                           "target 64 48",
                           "state nonsense on",
                           "state cull sideways",
                           "state depth_test",
                           "state polygon_mode lines",
                           "state line_rule x",
                           "state point_size 0",
                           "state polygon_offset 1",
                           "state viewport 0 0 0 0",
                           "state depth_range 0 2",
                           "l 0 1",
                           "p 0",
                           "planes 10 1",
                           "clear color 256 0 0 0",
                           "clear depth 1.5",
                           "clear color",
                           "space nowhere"})
    expect_third_line_refused(line);
  expect_file_refused("bad.hpt", "", "bad.hpt:1: ");
  expect_file_refused("bad.hpt", "halfplane 2\n", "bad.hpt:1: ");
  expect_file_refused("bad.hpt", "v 0 0 0\n", "bad.hpt:1: ");
  expect_file_refused("bad.hpt", "halfplane 1\ntarget 0 0\n", "bad.hpt:2: ");
  expect_file_refused("bad.hpt", "halfplane 1\ntarget 16385 1\n", "bad.hpt:2: ");
}

TEST_F(BadInput, CaptureCutShortAnywhereIsDrawnOrRefusedButNeverCrashes) {
  const std::string whole =
      "halfplane 1\ntarget 16 16\nspace window\nv 0 0 .5\nv 9 0 .5 1 255 0 0 255\nv 0 9 .5\nt 0 1 2\n";
  int refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write("cut.hpt", whole.substr(0, size));
    const Outcome outcome = run({"render", "cut.hpt"});
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << size << ": " << outcome.status;
    if (outcome.status == 0) continue;
    ++refused;
    EXPECT_EQ(outcome.err.rfind("halfplane: cut.hpt:", 0), 0u) << outcome.err;
    EXPECT_EQ(lines_of(outcome.err).size(), 1u) << outcome.err;
  }
  EXPECT_GT(refused, 40);  // every cut inside a vertex, at least
  write("cut.hpt", whole.substr(0, whole.find("\nv 0 9 .5") + 8));
  expect_refused({"render", "cut.hpt"}, "cut.hpt:6: ");
}

TEST_F(BadInput, WhatTheConfigurationCannotHoldIsRefused) {
  expect_refused({"render", "triangle", "--size", "1921x1080"}, "1920x1080");
  expect_refused({"render", "triangle", "--config", "tiny", "--size", "17x16"}, "16x16");
  write("large.hpt", "halfplane 1\ntarget 4000 3000\nclear depth 1\n");
  expect_refused({"render", "large.hpt"}, "large.hpt: the target is 4000x3000");
  EXPECT_EQ(run({"render", "large.hpt", "--config", "full"}).status, 0);

  const std::string head = "halfplane 1\ntarget 64 48\nspace window\nv 0 0 .5\nv 0 40 .5\n";
  expect_file_refused("outside.hpt", head + "v 2048 0 .5\nt 0 1 2\n", "guard band");
  expect_file_refused("outside.hpt", head + "v -2049 0 .5\nt 0 1 2\n", "outside.hpt: draw from line 7: vertex 2");
  expect_file_refused("outside.hpt", head + "v 1e30 0 .5\nt 0 1 2\n", "guard band");
  expect_file_refused("outside.hpt", head + "v 40 0 1.5\nt 0 1 2\n", "outside.hpt: draw from line 7: ");
  write("inside.hpt", head + "v 2047 0 .5\nt 0 1 2\n");
  EXPECT_EQ(run({"render", "inside.hpt"}).status, 0);
  expect_file_refused("viewport.hpt",
                      "halfplane 1\ntarget 64 48\nstate viewport 0 0 5000 48\nv 0 0 0\nv 1 0 0\nv 0 1 0\nt 0 1 2\n",
                      "state viewport");
  expect_refused({"render", "star:12", "--config", "tiny", "--set", "guard.band=16", "--size", "16x16"},
                 "no point fits");
  // The clipper cuts at the largest coordinate. Below two subpixel bits the samples of a last column lie beyond it.
  const auto as_wide_as_the_band = [&](const char* subpixels) {
    return Arguments{"render", "triangle",         "--size", "128x48",         "--set", "target.width=128",
                     "--set",  "target.height=48", "--set",  "guard.band=128", "--set", subpixels};
  };
  EXPECT_EQ(run(as_wide_as_the_band("subpixel.bits=2")).status, 0);
  expect_refused(as_wide_as_the_band("subpixel.bits=1"), "below 2 a pixel inside");
}

TEST_F(BadInput, CaptureTakesNeitherAnotherSizeNorACamera) {
  write("window.hpt", "halfplane 1\ntarget 16 16\nspace window\nv 0 0 .5\nv 9 0 .5\nv 0 9 .5\nt 0 1 2\n");
  expect_refused({"render", "window.hpt", "--size", "32x32"}, "--size");
  expect_refused({"render", "window.hpt", "--camera", "fov=40"}, "--camera");
  EXPECT_EQ(run({"render", "window.hpt", "--size", "16x16"}).status, 0);
}

TEST_F(BadInput, ResultThatNobodyTakesIsAnError) {
  for (const Stdout out : {Stdout::closed, Stdout::full_disk}) {
    for (const Arguments& arguments : {Arguments{"render", "triangle", "--json", "--quiet"},
                                       {"compare", "triangle", "--json"},
                                       {"scenes", "--json"},
                                       {"config", "--json"},
                                       {"render", "triangle"},
                                       {"scenes"},
                                       {"config", "--sv"},
                                       {"config", "--c-header"},
                                       {"--help"}})
      expect_refused(arguments, "stdout", 2, {out, 0, 0, ""});
    EXPECT_EQ(run({"render", "triangle", "--quiet"}, {out, 0, 0, ""}).status, 0);  // no output, so nothing is lost
  }
}

TEST_F(BadInput, ReaderThatWentAwayEndsTheProgramSilently) {
  const Surroundings unread{Stdout::pipe_without_reader, 0, 0, ""};
  for (const Arguments& arguments : {Arguments{"render", "triangle", "--json", "--quiet"},
                                     {"compare", "triangle", "--json", "--quiet"},
                                     {"scenes", "--json", "--quiet"},
                                     {"config", "--list"},
                                     {"render", "triangle"},
                                     {"depth", "--near", "1", "--far", "10", "--csv", "-"},
                                     {"config", "--sv"},
                                     {"stress", "--list"},
                                     {"--help"},
                                     {"render", "--help"}}) {
    const Outcome outcome = run(arguments, unread);
    EXPECT_EQ(outcome.status, 141) << testing::PrintToString(arguments);
    EXPECT_EQ(outcome.err, "") << testing::PrintToString(arguments);
  }
  EXPECT_EQ(run({"render", "triangle", "--quiet"}, unread).status, 0);
  expect_refused({"render", "nosuch"}, "nosuch", 2, unread);
}

TEST_F(BadInput, ReaderThatWentAwayLeavesFilesWhole) {
  EXPECT_EQ(run({"render", "triangle", "-o", "whole.png", "--ids", "whole.npy"}).status, 0);
  EXPECT_EQ(run({"render", "triangle", "-o", "unread.png", "--ids", "unread.npy", "--json"},
                {Stdout::pipe_without_reader, 0, 0, ""})
                .status,
            141);
  EXPECT_EQ(read("unread.png"), read("whole.png"));
  EXPECT_EQ(read("unread.npy"), read("whole.npy"));
}

TEST_F(BadInput, MissingMemoryIsOneLineAndStatusThree) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer needs the address space itself";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
  GTEST_SKIP() << "the sanitizer needs the address space itself";
#endif
#endif
  const Surroundings small_machine{Stdout::captured, 0, 512u << 20, ""};
  const Arguments huge{"--size", "16384x16384",         "--set", "target.width=16384",
                       "--set",  "target.height=16384", "--set", "guard.band=16384"};  // 2 GB of colour and depth
  for (const Arguments& command : {Arguments{"render", "triangle"},
                                   {"render", "triangle", "--engine", "scalar"},
                                   {"render", "triangle", "--engine", "golden"},
                                   {"compare", "triangle"}}) {
    Arguments arguments = command;
    arguments.insert(arguments.end(), huge.begin(), huge.end());
    expect_refused(arguments, "memory", 3, small_machine);
  }
}

TEST_F(BadInput, MissingMaterialsAreAWarningAndDefaultColours) {
  write("plain.obj", "mtllib nosuch.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome outcome = run({"render", "plain.obj", "--json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err.rfind("halfplane: warning: plain.obj:", 0), 0u) << outcome.err;
  EXPECT_FALSE(Json::parse(outcome.out, nullptr, false).is_discarded());
}

}  // namespace
}  // namespace halfplane::cli::errors_test
