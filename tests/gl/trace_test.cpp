// Traces of apitrace's: hand-written traces are read unchanged, damage is one line, and a replay draws.
#ifdef HALFPLANE_HAS_TRACES
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "../../gl/trace/replay.hpp"
#include "../../gl/trace/trace_file.hpp"
#include "../../model/config.hpp"

namespace halfplane::gl::trace_test {
namespace {

/// A trace of version 6, value by value.
class Writer {
 public:
  Writer() { stream_ = number(6) + number(0) + text("process.name") + text("test") + text(""); }

  static std::string number(std::uint64_t value) {
    std::string bytes;
    for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
    return bytes + static_cast<char>(value);
  }
  static std::string text(const std::string& value) { return number(value.size()) + value; }

  // Values.
  static std::string null() { return std::string(1, '\0'); }
  static std::string integer(std::int64_t value) {
    return value < 0 ? '\3' + number(static_cast<std::uint64_t>(-value))
                     : '\4' + number(static_cast<std::uint64_t>(value));
  }
  static std::string real(float value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return '\5' + bytes;
  }
  static std::string blob(const std::string& bytes) { return '\10' + text(bytes); }
  static std::string opaque(std::uint64_t address) { return '\15' + number(address); }
  static std::string array(const std::vector<std::string>& values) {
    std::string bytes = '\13' + number(values.size());
    for (const std::string& value : values) bytes += value;
    return bytes;
  }

  using Argument = std::pair<std::string, std::string>;
  void call(const std::string& name, const std::vector<Argument>& arguments = {}, const std::string& result = "") {
    const auto [known, is_new] = signatures_.emplace(name, signatures_.size());
    stream_ += '\0' + number(0) + number(known->second);
    if (is_new) {
      stream_ += text(name) + number(arguments.size());
      for (const Argument& argument : arguments) stream_ += text(argument.first);
    }
    for (std::size_t i = 0; i < arguments.size(); ++i) stream_ += '\1' + number(i) + arguments[i].second;
    stream_ += '\0';
    stream_ += '\1' + number(calls_++);
    if (!result.empty()) stream_ += '\2' + result;
    stream_ += '\0';
  }
  void begin(int width, int height) {
    call("glXCreateContext", {{"dpy", opaque(1)}, {"vis", null()}, {"shareList", null()}, {"direct", integer(1)}},
         opaque(7));
    call("glXMakeCurrent", {{"dpy", opaque(1)}, {"drawable", integer(9)}, {"ctx", opaque(7)}}, integer(1));
    call("glViewport", {{"x", integer(0)}, {"y", integer(0)}, {"width", integer(width)}, {"height", integer(height)}});
  }
  void swap() { call("glXSwapBuffers", {{"dpy", opaque(1)}, {"drawable", integer(9)}}); }

  /// The file: chunks of Snappy's literals.
  [[nodiscard]] std::string file() const {
    std::string bytes = "at";
    for (std::size_t at = 0; at < stream_.size(); at += 1000) {
      const std::string part = stream_.substr(at, 1000);
      std::string chunk = number(part.size());
      chunk += {static_cast<char>(61 << 2), static_cast<char>((part.size() - 1) & 0xff),
                static_cast<char>((part.size() - 1) >> 8)};
      chunk += part;
      for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(chunk.size() >> shift);
      bytes += chunk;
    }
    return bytes;
  }

 private:
  std::string stream_;
  std::map<std::string, std::size_t> signatures_;
  std::uint64_t calls_ = 0;
};

class Trace : public testing::Test {
 protected:
  ~Trace() override { std::filesystem::remove(path_); }
  std::string write(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return path_;
  }
  /// The error of reading `bytes`; empty: none.
  std::string fault(const std::string& bytes) {
    try {
      TraceFile file(write(bytes));
      for (TraceCall call; file.next(call);) {
      }
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  /// The colour codes at the middle of each frame.
  std::vector<std::uint32_t> middles(const std::string& bytes, std::vector<std::string>* lines = nullptr) {
    const TraceContents contents = survey(write(bytes));
    Options options;
    options.config = labelled("full");
    std::vector<std::uint32_t> result;
    ReplayHooks hooks;
    hooks.frame = [&](int, Frame& frame) {
      const Framebuffer& picture = frame.picture();
      result.push_back(picture.color[picture.at(frame.width() / 2, frame.height() / 2)]);
    };
    hooks.warn = [&](const std::string& line) {
      if (lines != nullptr) lines->push_back(line);
    };
    replay(path_, contents, options, contents.frames, hooks);
    return result;
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / ("halfplane-" + std::to_string(getpid()) + ".trace")).string();
};

Writer two_frames() {
  Writer writer;
  writer.begin(40, 30);
  const auto clear = [&](float red) {
    writer.call("glClearColor", {{"red", Writer::real(red)},
                                 {"green", Writer::real(0)},
                                 {"blue", Writer::real(0)},
                                 {"alpha", Writer::real(1)}});
    writer.call("glClear", {{"mask", Writer::integer(0x4100)}});
  };
  clear(1);
  writer.swap();
  clear(0);
  writer.call("glColor4fv",
              {{"v", Writer::array({Writer::real(0), Writer::real(1), Writer::real(0), Writer::real(1)})}});
  const std::vector<float> corners{-1, -1, 3, -1, -1, 3};
  std::string memory(sizeof(float) * corners.size(), '\0');
  std::memcpy(memory.data(), corners.data(), memory.size());
  writer.call("glEnableClientState", {{"array", Writer::integer(0x8074)}});
  writer.call("glVertexPointer", {{"size", Writer::integer(2)},
                                  {"type", Writer::integer(0x1406)},
                                  {"stride", Writer::integer(0)},
                                  {"pointer", Writer::blob(memory)}});
  writer.call("glDrawArrays",
              {{"mode", Writer::integer(4)}, {"first", Writer::integer(0)}, {"count", Writer::integer(3)}});
  writer.swap();
  return writer;
}

TEST_F(Trace, ReadsCallsAndValues) {
  Writer writer;
  writer.call("f",
              {{"a", Writer::integer(-300)},
               {"b", Writer::array({Writer::real(0.5F), Writer::null()})},
               {"c", Writer::blob("abc")},
               {"d", Writer::opaque(0x1234)}},
              Writer::integer(5));
  TraceFile file(write(writer.file()));
  TraceCall call;
  ASSERT_TRUE(file.next(call));
  EXPECT_EQ(call.function(), "f");
  EXPECT_EQ(call.argument("a").integer, -300);
  EXPECT_EQ(call.argument("a").real, -300);
  ASSERT_EQ(call.argument("x", "b").items.size(), 2U);
  EXPECT_EQ(call.argument("b").items[0].real, 0.5);
  EXPECT_EQ(call.argument("b").items[1].kind, TraceValue::Kind::null);
  EXPECT_EQ(call.argument("c").bytes, "abc");
  EXPECT_EQ(call.argument("d").kind, TraceValue::Kind::pointer);
  EXPECT_EQ(call.argument("none").kind, TraceValue::Kind::null);
  EXPECT_EQ(call.result.integer, 5);
  EXPECT_FALSE(file.next(call));
}

TEST_F(Trace, AFaultIsOneLine) {
  EXPECT_NE(fault("hello").find("is no trace"), std::string::npos);
  EXPECT_NE(fault("\x1f\x8b\b").find("gzip"), std::string::npos);
  EXPECT_NE(fault("").find("is no trace"), std::string::npos);
  const std::string whole = two_frames().file();
  EXPECT_EQ(fault(whole), "");
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    const std::string line = fault(whole.substr(0, length));
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_FALSE(line.empty()) << length;
  }
}

TEST_F(Trace, AReplayDraws) {
  const std::vector<std::uint32_t> colors = middles(two_frames().file());
  ASSERT_EQ(colors.size(), 2U);
  EXPECT_EQ(colors[0], 0xff0000ffU);
  EXPECT_EQ(colors[1], 0xff00ff00U);
}

TEST_F(Trace, WhatItsMemoryDoesNotHoldIsLeftOut) {
  Writer writer = two_frames();
  writer.call("glDrawArrays",
              {{"mode", Writer::integer(4)}, {"first", Writer::integer(1000000)}, {"count", Writer::integer(3)}});
  writer.call("glFogfv", {{"pname", Writer::integer(0xb66)}, {"params", Writer::null()}});
  writer.call("glUseProgram", {{"program", Writer::integer(3)}});
  writer.swap();
  std::vector<std::string> lines;
  EXPECT_EQ(middles(writer.file(), &lines).size(), 3U);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(lines[0].starts_with("glDrawArrays "));
  EXPECT_TRUE(lines[1].starts_with("glFogfv "));
  EXPECT_TRUE(lines[2].starts_with("glUseProgram "));
}

TEST_F(Trace, AnyDamageEndsInAPictureOrALine) {
  const std::string whole = two_frames().file();
  std::mt19937 random(1);  // a fixed seed: the same bytes in each run
  for (int round = 0; round < 500; ++round) {
    std::string bytes = whole;
    for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      middles(bytes);
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace halfplane::gl::trace_test
#endif
