// The capture reader's refusals: each message names file, line, fault and remedy.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "model/capture/capture.hpp"
#include "model/config.hpp"

namespace halfplane::capture_errors_test {
namespace {

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// The message for `text`, or "" if it is accepted.
std::string message_for(const std::string& text) {
  try {
    (void)read_capture(text, "test.hpt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Expects the message to name `line` of the file, to hold `part` and to be one line that ends in a mend.
void expect_refused(const std::string& text, int line, const std::string& part) {
  const std::string message = message_for(text);
  EXPECT_EQ(message.rfind("test.hpt:" + std::to_string(line) + ": ", 0), 0u) << "got: " << message << "\nfor: " << text;
  EXPECT_NE(message.find(part), std::string::npos) << "got: " << message << "\nfor: " << text;
  EXPECT_NE(message.find("; "), std::string::npos) << "no mend: " << message;
  for (const char c : message) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << "unprintable byte in: " << message;
}

/// The same for one line, which stands third in the file.
void expect_line_refused(const std::string& line, const std::string& part) {
  expect_refused("halfplane 1\n# two\n" + line + "\n", 3, part);
}

TEST(CaptureErrors, WhatIsNoFiniteNumberIsRefused) {
  for (const char* text :
       {"nan", "-nan", "inf",  "-inf",  "infinity", "NaN", "abc",  "1,5", "1..2",  "--1",  "+-1",   "-", "+",
        ".",   "0x",   "0x-1", "0xinf", "1e",       "1e+", "0x1p", "1f",  "1.0.0", "\x80", "1_000", "e5"})
    expect_line_refused("v 0 " + std::string(text) + " 0", "is not a finite number");
  for (const char* text : {"1e400", "-1e400", "1e-400", "0x1p1024", "0x1p-1080", "1e99999999999999999999"})
    expect_line_refused("v 0 0 " + std::string(text), "outside the range of a double");
}

TEST(CaptureErrors, WhatIsNoCaptureIsNamedAsSuch) {
  expect_refused("", 1, "empty");
  expect_refused("\n\n# nothing\n", 1, "empty");
  expect_refused("target 640 480\n", 1, "no capture");
  expect_refused("\n\nv 0 0 0\n", 3, "'halfplane 1'");
  expect_refused("halfplane\n", 1, "without a version");
  expect_refused("halfplane 2\n", 1, "version '2'");
  expect_refused("halfplane 1.0\n", 1, "version '1.0'");
  expect_refused("halfplane 1 2\n", 1, "left over");
  expect_refused("halfplane 1\nhalfplane 1\n", 2, "second 'halfplane'");
  expect_refused(std::string("\x89PNG\r\n\x1a\n\0\0", 10), 1, "'\\x89PNG'");
  expect_refused(std::string(100, '\xff'), 1, "...'");
}

TEST(CaptureErrors, NulByteNamesItsLineEvenInAComment) {
  expect_refused(std::string("halfplane 1\nv 0 0 0\n# a\0b\n", 27), 3, "NUL");
  expect_refused(std::string("halfplane 1\nv 0 0 \0\n", 20), 2, "NUL");
}

TEST(CaptureErrors, UnknownLinesAndStatesAreNamed) {
  expect_line_refused("vertex 1 2 3", "'vertex'");
  expect_line_refused("\x01\x02", "'\\x01\\x02'");
  expect_line_refused("state", "state without a name");
  expect_line_refused("state glow on", "state 'glow' is not known");
  expect_line_refused("state cull", "the value of cull should follow");
  expect_line_refused("state cull backwards", "'backwards' is no value of cull; write one of none, back, front, both");
  expect_line_refused("state cull back front", "'front' is left over");
  expect_line_refused("space", "the value of space");
  expect_line_refused("space eye", "'eye' is no value of space");
  expect_line_refused("frame 2", "'2' is left over");
}

TEST(CaptureErrors, PlanesAreTwoPositiveDistancesInOrderAndGivenOnce) {
  expect_line_refused("planes 0 100", "planes must be 0 < near < far; far may be inf");
  expect_line_refused("planes 5 5", "planes must be 0 < near < far");
  expect_line_refused("planes inf 5", "is not a finite number");
  expect_line_refused("planes 1", "the line ends where the far plane should follow");
  expect_refused("halfplane 1\nplanes 1 10\nplanes 1 10\n", 3, "a second planes line");
}

TEST(CaptureErrors, StatesOfLinesAndPointsAreCheckedAsTheOthers) {
  expect_line_refused("state polygon_mode wire", "'wire' is no value of polygon_mode; write one of fill, line, point");
  expect_line_refused("state line_rule xiaolin", "write one of midpoint, bresenham, diamond");
  expect_line_refused("state line_last maybe", "write one of off, on, rule");
  expect_line_refused("state point_size 0.5", "point_size is 0.5; write a number from 1 to 1048576");
  expect_line_refused("state line_width 0", "line_width is 0; write a number from 1 to 1048576");
  expect_line_refused("state point_shape disc", "write one of square, round");
  expect_line_refused("state polygon_offset 1", "the line ends where polygon_offset's constant should follow");
  expect_line_refused("state provoking middle", "write one of first, last");
  expect_line_refused("state point_clip none", "write one of pixel, center");
}

TEST(CaptureErrors, DrawsNeedWholePrimitives) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  const auto refused = [&](const std::string& line, const char* what) {
    const std::string message = message_for("halfplane 1\n" + vertices + line + "\n");
    EXPECT_NE(message.find(":6: "), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  refused("l 0 1 2", "l with 3 indices; write 2 for each line");
  refused("ls 0", "ls with 1 index; write at least 2, all on one line");
  refused("ll 0", "ll with 1 index; write at least 2");
  refused("ts 0 1 2 restart 0 1", "ts with a run of 2 indices; write at least 3");
  refused("ls restart 0 1", "ls with a run of 0 indices");
  refused("ls 0 1 restart", "ls with a run of 0 indices");
  refused("l 0 1 restart 2 3", "restart in a list; leave it out, lines of a list share nothing");
  refused("p 4", "index '4' has no vertex yet");
  refused("p restarted", "'restarted' is not an index");
}

TEST(CaptureErrors, TargetIsOneAndWithinItsBounds) {
  expect_line_refused("target", "the target's width should follow");
  expect_line_refused("target 640", "the target's height should follow");
  expect_line_refused("target 0 480", "the target's width is '0'; write a whole number from 1 to 16384");
  expect_line_refused("target 640 16385", "the target's height is '16385'");
  expect_line_refused("target 640 99999999999", "the target's height");
  expect_line_refused("target 640.5 480", "'640.5'");
  expect_line_refused("target -1 480", "'-1'");
  expect_line_refused("target 640 480 3", "'3' is left over");
  expect_refused("halfplane 1\ntarget 1 1\ntarget 1 1\n", 3, "the first is on line 2");
  EXPECT_EQ(message_for("halfplane 1\ntarget 16384 1\n"), "");
}

TEST(CaptureErrors, ClearIsCompleteAndWithinItsBounds) {
  expect_line_refused("clear", "without anything to clear");
  expect_line_refused("clear mist 0", "'mist' cannot be cleared");
  expect_line_refused("clear color 1 2 3", "a colour component should follow");
  expect_line_refused("clear color 1 2 3 256", "a colour component is 256; write a number from 0 to 255");
  expect_line_refused("clear color 1 2 3 -1", "a colour component is -1");
  expect_line_refused("clear color 1 2 3 depth 1", "'depth' is not a finite number");
  expect_line_refused("clear depth", "the clear depth should follow");
  expect_line_refused("clear depth 1.5", "the clear depth is 1.5; write a number from 0 to 1");
  expect_line_refused("clear depth nan", "'nan'");
  expect_line_refused("clear depth 1 depth 1", "second 'depth'");
  expect_line_refused("clear color 1 2 3 4 color 1 2 3 4", "second 'color'");
}

TEST(CaptureErrors, StateNumbersAreWithinTheirBounds) {
  expect_line_refused("state scissor", "scissor without a value; write off or x y width height");
  expect_line_refused("state scissor none", "scissor x is 'none'");
  expect_line_refused("state scissor 0 0 1", "scissor height should follow");
  expect_line_refused("state scissor 0 0 -1 1", "scissor width is '-1'");
  expect_line_refused("state scissor 0.5 0 1 1", "'0.5'");
  expect_line_refused("state scissor 0 2147483648 1 1", "scissor y");
  expect_line_refused("state viewport", "viewport without a value; write full or x y width height");
  expect_line_refused("state viewport 0 0 0 1", "must be above 0");
  expect_line_refused("state viewport 0 0 1 -1", "viewport height is -1");
  expect_line_refused("state viewport inf 0 1 1", "'inf'");
  expect_line_refused("state viewport 1e9 0 1 1", "viewport x is 1e+09");
  expect_line_refused("state depth_range 0", "a bound of depth_range should follow");
  expect_line_refused("state depth_range 0 1.5", "a bound of depth_range is 1.5; write a number from 0 to 1");
  expect_line_refused("state depth_range -0.5 1", "a bound of depth_range is -0.5");
}

TEST(CaptureErrors, VertexOfAnotherLengthNamesTheLengthsThatThereAre) {
  for (const int count : {0, 1, 2, 5, 6, 7, 9}) {
    std::string line = "v";
    for (int i = 0; i < count; ++i) line += " 1";
    expect_line_refused(
        line, "a vertex of " + std::to_string(count) + " numbers; write 3 (x y z), 4 (and w), 8 (and r g b a)");
  }
  expect_line_refused("v 1 1 1 1 1 1 1 1 1 1 1", "a vertex of more than 10 numbers");
  expect_line_refused("v 1 1 1 1 256 1 1 1", "a colour component outside 0...255");
  expect_line_refused("v 1 1 1 1 1 1 1 -0.5", "a colour component outside 0...255");
}

TEST(CaptureErrors, IndexWithoutAVertexNamesTheRange) {
  expect_line_refused("t 0 1 2", "index '0' has no vertex yet; write the 'v' lines above");
  const std::string head = "halfplane 1\n" + three_vertices;  // lines 1...4
  expect_refused(head + "t 0 1 3\nv 0 0 0\n", 5, "index '3' has no vertex yet; write 0 to 2");
  expect_refused(head + "t 0 1 99999999999999999999\n", 5, "has no vertex yet");
  expect_refused(head + "t 0 1 -1\n", 5, "'-1' is not an index");
  expect_refused(head + "t 0 1 1.0\n", 5, "'1.0' is not an index");
  expect_refused(head + "ts 0 1 2 x\n", 5, "'x' is not an index");
  expect_refused(head + "t\n", 5, "a vertex index should follow");
  expect_refused(head + "t 0 1\n", 5, "t with 2 indices; write 3 for each triangle");
  expect_refused(head + "t 0 1 2 0\n", 5, "t with 4 indices");
  expect_refused(head + "t 0 # 1 2\n", 5, "t with 1 index;");
  expect_refused(head + "ts 0 1\n", 5, "ts with 2 indices; write at least 3");
  expect_refused(head + "tf 0 1\n", 5, "tf with 2 indices; write at least 3");
}

TEST(CaptureErrors, ObjectNameHoldsNoControlBytesAndNoLonePercent) {
  expect_line_refused("object a\x01", "control byte");
  expect_line_refused("object a\rb", "control byte");
  expect_line_refused("object 50%", "write %25 for a % sign");
  expect_line_refused("object %2", "write %25");
  expect_line_refused("object %zz", "write %25");
}

TEST(CaptureErrors, TruncatedVertexLineNamesTheLine) {
  expect_refused("halfplane 1\nv 1 2 3\nv 1 2", 3, "a vertex of 2 numbers");
  expect_refused("halfplane 1\nv 1 2 3\nv 1 2 0.1", 3, "cut off");
  expect_refused("halfplane 1\n" + three_vertices + "t 0 1", 5, "t with 2 indices");
  expect_refused("halfplane 1\nstate", 2, "state without a name");
  expect_refused("halfplane 1\nclear depth", 2, "cut off");
}

TEST(CaptureErrors, NoCutOfAFileIsReadAsAnotherVertex) {
  const std::string text = "halfplane 1\nv 10.25 20.5 0.125 1 255 128 64 255\nv 1 2 3\n";
  const Scene whole = read_capture(text, "");
  for (std::size_t length = 0; length < text.size(); ++length) {
    const std::string cut = text.substr(0, length);
    if (!message_for(cut).empty()) continue;
    const Scene scene = read_capture(cut, "");
    for (std::size_t i = 0; i < scene.vertices.size(); ++i)
      EXPECT_EQ(scene.vertices[i].x, whole.vertices[i].x) << "cut to " << length << " bytes";
    EXPECT_TRUE(cut.ends_with('\n') || scene.vertices.empty()) << "cut to " << length << " bytes";
  }
}

TEST(CaptureErrors, FileThatCannotBeReadIsNamed) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      (void)read_capture_file(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("no/such.hpt"), "no/such.hpt: there is no such file; give the path of a capture");
  EXPECT_EQ(message("."), ".: this is a folder; give the path of a capture");
  EXPECT_NE(message("/dev/zero").find("device"), std::string::npos);  // it never ends
}

}  // namespace
}  // namespace halfplane::capture_errors_test
