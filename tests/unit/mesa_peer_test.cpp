// Mesa's picture of a scene equals the model's up to rounding: both times are of the same work.
#include "sim/study/bench/mesa_peer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "model/draw_states.hpp"
#include "model/engines/functional.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/study/bench/engines.hpp"

namespace halfplane::mesa_peer_test {
namespace {

constexpr int kWidth = 96, kHeight = 64;

class MesaPeerTest : public testing::Test {
 protected:
  void start(int depth_bits, int samples = 1) {
    peer_ = std::make_unique<MesaPeer>(kWidth, kHeight, depth_bits, 1, samples);
    depth_bits_ = depth_bits;
    samples_ = samples;
  }

  void SetUp() override {
    try {
      start(16);
    } catch (const std::runtime_error& error) {
      ASSERT_NE(std::string(error.what()).find("install"), std::string::npos);
      GTEST_SKIP() << error.what();
    }
  }

  // Pixels that differ by more than rounding in any channel.
  int differing(const Scene& scene) {
    peer_->upload(scene);
    EXPECT_GT(peer_->render(), 0);
    const std::vector<std::uint32_t> there = peer_->color();
    Config config = preset("full");
    config.depth_bits = depth_bits_;  // the unit of polygon_offset
    config.msaa_samples = samples_;
    if (samples_ > 1) {
      config.stamp_size = 2;  // no matter to a picture
      // Its rows go up, and so do the places in a pixel.
      config.msaa_pattern = parse_sample_pattern("0.375,0.875;0.875,0.625;0.125,0.375;0.625,0.125");
    }
    const Picture here = color_picture(render_functional(scene, config).frame, config.color_format);
    EXPECT_EQ(there.size() * 3, here.rgb.size());
    int count = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      int worst = 0;
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(static_cast<int>(there[i] >> 8 * c & 255U) - here.rgb[3 * i + c]));
      ++pixels_[static_cast<std::size_t>(std::min(worst, 3))];
      count += worst > 2 ? 1 : 0;
    }
    return count;
  }

  // Over all pictures so far, the number of pixels whose worst channel is equal, off by one, by two, by more.
  void report(const char* what) const {
    std::printf("%s: %llu pixels the same, %llu off by 1 of 255, %llu by 2, %llu by more\n", what, pixels_[0],
                pixels_[1], pixels_[2], pixels_[3]);
  }

  std::unique_ptr<MesaPeer> peer_;
  int depth_bits_ = 0, samples_ = 1;
  std::array<unsigned long long, 4> pixels_{};
};

TEST_F(MesaPeerTest, ItDrawsTheBuiltinScenesAsWeDo) {
  EXPECT_NE(peer_->name().find("llvmpipe"), std::string::npos);
  for (const char* name :
       {"triangle", "teapot:4", "city:20", "layers:8", "ball:12", "objects:80", "shell:8", "dust:500"})
    EXPECT_LE(differing(make_builtin(name, kWidth, kHeight, {}, 1)), kWidth * kHeight / 200) << name;
}

// Each state in turn, in both spaces, over the whole picture or within a scissor.
TEST_F(MesaPeerTest, StatesMeanTheSame) {
  const std::string head = "halfplane 1\ntarget 96 64\nclear color 20 20 30 255 depth 1\n";
  const std::string fan =
      "v 50 8 0.25 1 255 0 0 255\nv 10 50 0.5 2 0 255 0 255\nv 50 60 0.75 1 0 0 255 255\nv 90 40 0.5 3 255 255 0 255\n";
  const std::string flat = "v 5 5 0.4 1 200 90 0 255\nv 91 30 0.4 1 10 90 200 255\nv 20 60 0.6 1 255 255 255 255\n";
  for (const char* state : {"cull back",
                            "cull front",
                            "cull both",
                            "front cw\nstate cull back",
                            "depth_test greater",
                            "depth_test always",
                            "depth_test lequal",
                            "depth_test equal",
                            "depth_test notequal",
                            "depth_test gequal",
                            "depth_write off",
                            "color_write off",
                            "shade flat",
                            "shade flat\nstate provoking last",
                            "scissor 20 10 40 30",
                            "polygon_mode line",
                            "polygon_mode point\nstate point_size 4",
                            "polygon_mode line\nstate line_width 3",
                            "polygon_mode line\nstate line_width 4",
                            "polygon_offset 0 9000"}) {
    std::string text = head;
    text.append("space window\n").append(fan).append(flat).append("t 4 5 6\nstate ").append(state);
    text += "\ntf 0 1 2 3\nts 3 2 1 0\nt 4 6 5\nl 0 3\np 2\n";
    EXPECT_LE(differing(read_capture(text, "states.hpt")), 12) << state;
  }
  const std::string clip = "v -0.9 -0.8 -0.5 1 255 0 0 255\nv 0.9 -0.8 0.45 1 0 255 0 255\nv 0 0.9 0.5 1 0 0 255 255\n";
  for (const char* state : {"viewport 10.5 4 60 50.25", "depth_range 0.5 0.25", "clip_z zero_one", "cull back",
                            "front cw\nstate cull back"}) {
    std::string text = head;
    text.append("state ").append(state).append("\n").append(clip).append("t 0 1 2\n");
    EXPECT_LE(differing(read_capture(text, "clip.hpt")), 12) << state;
  }
}

// Images to a quarter of their side beyond them, with a border of another colour and alpha.
TEST_F(MesaPeerTest, BordersOfTexturesMeanTheSame) {
  for (const char* filter : {"linear", "nearest"})
    for (const char* wrap : {"border border", "half_border half_border", "clamp half_border", "border repeat"}) {
      std::string text =
          "halfplane 1\ntarget 96 64\nclear color 20 20 30 255 depth 1\nspace window\n"
          "texture cells pattern chequer 8 8 format rgba8888\nstate texture cells\nstate texture_combine modulate\n"
          "state texture_border 255 40 0 90\nstate blend src_alpha one_minus_src_alpha\n";
      text.append("state texture_min ").append(filter).append("\nstate texture_mag ").append(filter);
      text.append("\nstate texture_wrap ").append(wrap);
      text +=
          "\nv 5 3 0.5 1 255 255 255 255 -0.27 -0.26\nv 90 3 0.5 1 255 200 255 255 1.24 -0.26\n"
          "v 90 60 0.5 1 255 255 90 255 1.24 1.25\nv 5 60 0.5 1 255 255 255 99 -0.27 1.25\nt 0 1 2 0 2 3\n";
      const Scene scene = read_capture(text, "border.hpt");
      EXPECT_LE(differing(scene), 12) << filter << ", " << wrap;
    }
  report("borders");
}

// OpenGL leaves the coverage of smooth lines and points to the implementation: both resemble the area, and are far nearer to
// each other than to what is not smooth.
TEST_F(MesaPeerTest, SmoothLinesAndPointsCoverAboutTheSame) {
  const auto picture_of = [](const std::string& smooth, const char* width) {
    std::string text =
        "halfplane 1\ntarget 96 64\nclear color 20 20 30 255 depth 1\nspace window\n"
        "state depth_test always\nstate depth_write off\nstate blend src_alpha one\n";
    for (int i = 0; i < 16; ++i) {
      const double angle = 0.1 + i * 0.39;
      text += "v " + std::to_string(48.3 + 9 * std::cos(angle)) + " " + std::to_string(32.2 + 9 * std::sin(angle)) +
              " 0.5 1 50 220 60 255\nv " + std::to_string(48.3 + 29 * std::cos(angle)) + " " +
              std::to_string(32.2 + 29 * std::sin(angle)) + " 0.5 1 50 220 60 255\n";
    }
    text.append(smooth).append("state line_width ").append(width).append("\nstate point_size ").append(width);
    for (int i = 0; i < 16; ++i) text += "\nl " + std::to_string(2 * i) + " " + std::to_string(2 * i + 1);
    for (int i = 0; i < 16; i += 3) text += "\np " + std::to_string(2 * i);
    return read_capture(text + "\n", "smooth.hpt");
  };
  const auto difference = [this](const Scene& there, const Scene& here) {
    peer_->upload(there);
    EXPECT_GT(peer_->render(), 0);
    const std::vector<std::uint32_t> theirs = peer_->color();
    Config config = preset("full");
    config.color_format = ColorFormat::rgba8888;
    const Picture ours = color_picture(render_functional(here, config).frame, config.color_format);
    long sum = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i)
      sum += std::abs(static_cast<int>(theirs[i] >> 8 & 255U) - ours.rgb[3 * i + 1]);
    return sum;
  };
  for (const char* width : {"1", "2", "3.5", "6"}) {
    const Scene smooth = picture_of("state smooth on\nstate point_shape round\n", width), plain = picture_of("", width);
    const long off = difference(smooth, smooth);
    EXPECT_LT(2 * off, difference(smooth, plain)) << width;
    EXPECT_LT(2 * off, difference(plain, smooth)) << width;
  }
}

// llvmpipe has the standard places of four samples, and draws lines with several samples as rectangles. One colour: with
// several samples its colours are computed at a place beside the pixel's centre.
TEST_F(MesaPeerTest, RectanglesOfLinesHaveTheSameSamples) {
  start(24, 4);
  for (const char* width : {"1", "1.5", "2", "3", "7.25"}) {
    std::string text =
        "halfplane 1\ntarget 96 64\nclear color 20 20 30 255 depth 1\nspace window\nstate depth_test always\n";
    for (int i = 0; i < 16; ++i) {
      const double angle = 0.1 + i * 0.39;
      text += "v 48.3 32.2 0.5 1 250 200 60 255\nv " + std::to_string(48.3 + 29 * std::cos(angle)) + " " +
              std::to_string(32.2 + 29 * std::sin(angle)) + " 0.5 1 250 200 60 255\n";
    }
    text.append("state line_rule rectangle\nstate line_width ").append(width).append("\n");
    for (int i = 0; i < 16; ++i) text += "l " + std::to_string(2 * i) + " " + std::to_string(2 * i + 1) + "\n";
    text += "ls 1 5 9 13 17\n";
    EXPECT_LE(differing(read_capture(text, "rectangles.hpt")), 12) << width;
  }
  report("rectangles");
}

// bench asks for the configuration's samples a pixel; numbers and places that llvmpipe lacks are refused.
TEST(MesaPeer, HasOneSampleAPixelOrFour) {
  const auto scene = std::make_shared<const Scene>(make_builtin("triangle", 16, 16, {}, 1));
  for (const int samples : {2, 8}) {
    Config config = preset("embedded");
    config.msaa_samples = samples;
    EXPECT_THROW((void)make_frame("llvmpipe", scene, config, 1, {}), InputError) << samples;
  }
  Config moved = preset("embedded");
  moved.msaa_samples = 4;
  moved.msaa_pattern = parse_sample_pattern("0,0;0.5,0;0,0.5;0.5,0.5");
  EXPECT_THROW((void)make_frame("llvmpipe", scene, moved, 1, {}), InputError);
}

TEST_F(MesaPeerTest, SaysWhatItHasNotOfSeveralSamples) {
  start(24, 4);
  for (const char* state : {"sample_mask 3", "alpha_to_coverage on"}) {
    const std::string text =
        std::string("halfplane 1\ntarget 96 64\nspace window\nv 1 1 0 1\nv 9 1 0 1\nv 1 9 0 1\nstate ") + state +
        "\nt 0 1 2\n";
    EXPECT_THROW(peer_->upload(read_capture(text, "samples.hpt")), InputError) << state;
  }
}

// Every factor and equation, masks, alpha and stencil, over three triangles that lie over each other.
TEST_F(MesaPeerTest, FragmentOperationsMeanTheSame) {
  start(24);  // a stencil goes with it
  const std::string head =
      "halfplane 1\ntarget 96 64\nclear color 200 120 30 90 depth 1 stencil 5\nspace window\nstate blend_color 250 10 "
      "128 60\n"
      "v 50 2 0.25 1 255 0 0 20\nv 3 60 0.5 1 0 255 0 130\nv 92 55 0.75 1 0 0 255 255\n"
      "v 5 5 0.6 1 200 90 0 240\nv 91 30 0.4 1 10 90 200 10\nv 20 60 0.3 1 255 255 255 128\n"
      "v 90 3 0.2 1 70 80 90 200\nv 60 62 0.2 1 1 200 3 60\nv 2 30 0.8 1 99 98 97 0\n";
  std::vector<std::string> states;
  const DrawState& blend = draw_state("blend");
  const auto factors = blend.numbers[0].words;
  for (std::size_t src = 0; src < factors.size();
       ++src)  // each source factor with four others, each of these with four
    for (std::size_t n = 0; n < 4; ++n)
      states.push_back("blend " + std::string(factors[src]) + " " +
                       std::string(factors[(src + 4 * n) % factors.size()]));
  for (const char* equation : {"subtract", "reverse_subtract", "min", "max", "add subtract", "max reverse_subtract"})
    states.push_back("blend src_alpha one_minus_dst_color one dst_alpha\nstate blend_equation " +
                     std::string(equation));
  for (const char* state :
       {"color_mask on off on off", "color_mask off off off on", "alpha_test greater 100", "alpha_test notequal 60",
        "alpha_test never 0", "stencil equal 5 255 255 incr decr replace", "stencil less 3 7 15 keep invert zero",
        "stencil always 9 255 254 keep incr_wrap decr_wrap\nstate stencil_back notequal 1 255 255 zero keep incr",
        "stencil gequal 5 255 255 keep replace invert\nstate alpha_test gequal 70\nstate blend one "
        "one_minus_src_alpha"})
    states.emplace_back(state);
  for (const std::string& state : states) {
    const Scene scene = read_capture(
        head + "state depth_test lequal\nstate " + state + "\nt 0 1 2\nt 3 4 5\nt 8 7 6\nt 5 1 8\n", "ops.hpt");
    // A factor that is a stored colour doubles the error of that colour, layer by layer.
    EXPECT_LE(differing(scene), state.find("dst_color") == std::string::npos ? 12 : 80) << state;
  }
  EXPECT_GT(states.size(), 70u);
  report("operations");
}

TEST_F(MesaPeerTest, FogMeansTheSame) {
  start(24);
  const std::string head =
      "halfplane 1\ntarget 96 64\nclear color 200 120 30 90 depth 1\nspace window\n"
      "v 50 2 0.25 1 255 0 0 20\nv 3 60 0.5 4 0 255 0 130\nv 92 55 0.75 9 0 0 255 255\n"
      "v 5 5 0.6 3 200 90 0 240\nv 91 30 0.4 1 10 90 200 10\nv 20 60 0.3 7 255 255 255 128\n";
  for (const char* fog : {"linear 2 6", "linear 0 9", "exp 0.2", "exp2 0.3", "linear 5 5", "exp 0"}) {
    const std::string state = "state fog " + std::string(fog) + "\nstate fog_color 250 128 9\n";
    EXPECT_LE(differing(read_capture(head + state + "t 0 1 2\nt 3 4 5\np 1\n", "fog.hpt")), 12) << fog;
  }
  report("fog");
  EXPECT_THROW(peer_->upload(read_capture(head + "state fog exp 1\nl 0 1\n", "line.hpt")), InputError);
}

TEST_F(MesaPeerTest, WhatItDoesNotHaveIsRefusedByName) {
  try {
    peer_->upload(make_builtin("star", kWidth, kHeight, {}, 1));
    FAIL() << "drawn";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line_rule midpoint"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)peer_->render(), std::runtime_error);  // there is no scene now
  const std::string head = "halfplane 1\ntarget 96 64\nspace window\nv 9 9 0.5 1\n";
  EXPECT_THROW(peer_->upload(read_capture(head + "state point_shape round\np 0\n", "round.hpt")), InputError);
  EXPECT_THROW(peer_->upload(read_capture(head + "state smooth on\np 0\n", "square.hpt")), InputError);
}

TEST_F(MesaPeerTest, PeersOfDifferentThreadCountsLiveSideBySide) {
  const Scene scene = make_builtin("layers:8", kWidth, kHeight, {}, 1);
  MesaPeer other(kWidth, kHeight, 24, 2);
  peer_->upload(scene);
  other.upload(scene);
  EXPECT_GT(peer_->render(), 0);
  EXPECT_GT(other.render(), 0);
  EXPECT_EQ(peer_->color(), other.color());
}

}  // namespace
}  // namespace halfplane::mesa_peer_test
