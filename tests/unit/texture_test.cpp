// Textures by themselves: formats, mipmaps, patterns; and their lines in captures.
#include "model/formats/texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "../scene_builder.hpp"
#include "model/capture/capture.hpp"
#include "model/config.hpp"

namespace halfplane::texture_test {
namespace {

constexpr std::array<TextureFormat, 6> kPlainFormats{TextureFormat::l8,       TextureFormat::la88,
                                                     TextureFormat::rgb565,   TextureFormat::rgba5551,
                                                     TextureFormat::rgba4444, TextureFormat::rgba8888};

TEST(Texture, EveryCodeIsItsOwnNearestOne) {
  for (const TextureFormat format : kPlainFormats) {
    const std::uint64_t codes = std::uint64_t{1} << texel_bits(format), step = codes > 65536 ? 104729 : 1;
    for (std::uint64_t code = 0; code < codes; code += step)
      ASSERT_EQ(encode_texel(format, decode_texel(format, static_cast<std::uint32_t>(code), {}), {}), code)
          << kTextureFormats[static_cast<std::size_t>(format)];
  }
}

TEST(Texture, AChannelIsWidenedByRepetitionAndReachesBothEnds) {
  EXPECT_EQ(decode_texel(TextureFormat::rgb565, 0b10110'110101'00001, {}), (Texel{0b10110101, 0b11010111, 8, 255}));
  EXPECT_EQ(decode_texel(TextureFormat::rgba5551, 0xffff, {}), (Texel{255, 255, 255, 255}));
  EXPECT_EQ(decode_texel(TextureFormat::rgba5551, 0xfffe, {}), (Texel{255, 255, 255, 0}));
  EXPECT_EQ(decode_texel(TextureFormat::rgba4444, 0x12ef, {}), (Texel{0x11, 0x22, 0xee, 0xff}));
  EXPECT_EQ(decode_texel(TextureFormat::la88, 0x4080, {}), (Texel{0x40, 0x40, 0x40, 0x80}));
  EXPECT_EQ(decode_texel(TextureFormat::l8, 0x40, {}), (Texel{0x40, 0x40, 0x40, 255}));
  EXPECT_EQ(decode_texel(TextureFormat::rgba8888, 0x01020304, {}), (Texel{1, 2, 3, 4}));
}

TEST(Texture, TheNearestCodeIsOffByHalfAStepAtMost) {
  for (int c = 0; c < 256; ++c) {
    const auto v = static_cast<std::uint8_t>(c);
    const Texel back = decode_texel(TextureFormat::rgb565, encode_texel(TextureFormat::rgb565, {v, v, v, 0}, {}), {});
    EXPECT_LE(std::abs(back[0] - c), 4) << c;
    EXPECT_LE(std::abs(back[1] - c), 2) << c;
    EXPECT_EQ(back[3], 255);
  }
}

TEST(Texture, APaletteHoldsItsColoursAndNoMore) {
  const TexelImage image = pattern_image(TexturePattern::chequer, 16, 16);
  const Texture texture = make_texture("t", image, TextureFormat::p4, Mips::none);
  EXPECT_EQ(texture.palette.size(), 2u);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) EXPECT_EQ(texture.texel(0, x, y), image.texel[static_cast<std::size_t>(16 * y + x)]);
  EXPECT_THROW((void)make_texture("t", pattern_image(TexturePattern::gradient, 32, 32), TextureFormat::p8, Mips::none),
               InputError);
}

TEST(Texture, MipmapsHalveDownToOneTexel) {
  const Texture texture =
      make_texture("t", pattern_image(TexturePattern::grid, 40, 5), TextureFormat::rgba8888, Mips::box);
  ASSERT_EQ(texture.level.size(), 6u);
  const std::array<std::array<int, 2>, 6> sides{{{40, 5}, {20, 2}, {10, 1}, {5, 1}, {2, 1}, {1, 1}}};
  for (std::size_t n = 0; n < sides.size(); ++n) {
    EXPECT_EQ(texture.level[n].width, sides[n][0]);
    EXPECT_EQ(texture.level[n].height, sides[n][1]);
  }
}

TEST(Texture, ABoxIsTheMeanOfItsTexelsRoundedOnce) {
  TexelImage image{4, 1, {{0, 0, 0, 0}, {1, 10, 255, 255}, {2, 20, 255, 0}, {3, 31, 255, 0}}};
  const Texture texture = make_texture("t", image, TextureFormat::rgba8888, Mips::box);
  EXPECT_EQ(texture.texel(1, 0, 0), (Texel{1, 5, 128, 128}));
  EXPECT_EQ(texture.texel(1, 1, 0), (Texel{3, 26, 255, 0}));
  EXPECT_EQ(texture.texel(2, 0, 0), (Texel{2, 15, 191, 64}));
}

// A side of three becomes one: its texels have equal weights, and none is left out.
TEST(Texture, AnOddSideLosesNoTexel) {
  TexelImage image{3, 1, {{30, 0, 0, 255}, {60, 0, 0, 255}, {90, 0, 0, 255}}};
  EXPECT_EQ(make_texture("t", image, TextureFormat::rgba8888, Mips::box).texel(1, 0, 0)[0], 60);
  image = {5, 1, {{100, 0, 0, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {50, 0, 0, 255}}};
  const Texture five = make_texture("t", image, TextureFormat::rgba8888, Mips::box);
  EXPECT_EQ(five.texel(1, 0, 0)[0], 40);  // 2.5 texels: 100 over 2.5
  EXPECT_EQ(five.texel(1, 1, 0)[0], 20);
}

TEST(Texture, LinearLightIsBrighterThanTheMeanOfItsCodes) {
  const TexelImage image{2, 1, {{0, 0, 0, 0}, {255, 255, 255, 255}}};
  EXPECT_EQ(make_texture("t", image, TextureFormat::rgba8888, Mips::box).texel(1, 0, 0), (Texel{128, 128, 128, 128}));
  EXPECT_EQ(make_texture("t", image, TextureFormat::rgba8888, Mips::box_linear).texel(1, 0, 0),
            (Texel{188, 188, 188, 128}));
  const TexelImage even{2, 1, {{77, 12, 200, 9}, {77, 12, 200, 9}}};  // a mean of equals is itself
  EXPECT_EQ(make_texture("t", even, TextureFormat::rgba8888, Mips::box_linear).texel(1, 0, 0), even.texel[0]);
}

TEST(Texture, PatternsOfEverySizeAreWhole) {
  for (const TexturePattern pattern : {TexturePattern::chequer, TexturePattern::gradient, TexturePattern::grid})
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 7}, {8, 8}, {130, 90}}) {
      const TexelImage image = pattern_image(pattern, width, height);
      EXPECT_EQ(image.texel.size(), static_cast<std::size_t>(width * height));
      EXPECT_TRUE(std::ranges::all_of(image.texel, [](const Texel& t) { return t[3] == 255; }));
    }
  const TexelImage gradient = pattern_image(TexturePattern::gradient, 256, 256);
  EXPECT_EQ(gradient.texel[256 * 10 + 200], (Texel{200, 10, 128, 255}));
}

// ---- captures

constexpr const char* kDrawn = "v 0 0 0.5\nv 8 0 0.5\nv 0 8 0.5\nt 0 1 2\n";

TEST(CaptureTextures, EveryFormatAndStateComesBackBitForBit) {
  Scene scene = test::SceneBuilder(8, 8).triangle(test::at(0, 0), test::at(8, 0), test::at(0, 8)).scene;
  for (std::size_t i = 0; i < kTextureFormats.size(); ++i)
    scene.textures.push_back(make_texture("t" + std::string(kTextureFormats[i]),
                                          pattern_image(TexturePattern::chequer, 20, 3 + static_cast<int>(i)),
                                          static_cast<TextureFormat>(i), static_cast<Mips>(i % 3)));
  Texture& own = scene.textures.emplace_back(scene.textures[4]);
  own.name = "own";
  own.mips = Mips::levels;
  for (std::size_t n = 1; n < own.level.size(); ++n)
    for (std::uint32_t& code : own.level[n].code) code = static_cast<std::uint32_t>(n) * 0x1111;
  scene.textures.emplace_back(scene.textures[7]).name = "palette";
  scene.textures.back().mips = Mips::levels;
  State& state = scene.states[0];
  state.texture = 6;
  state.texture_min = TextureMin::linear_mipmap_nearest;
  state.texture_wrap = {TextureWrap::clamp, TextureWrap::mirror};
  state.texture_lod = {-0.75, 1, 5.5};
  state.texture_combine = TextureCombine::decal;
  scene.commands.erase(scene.commands.begin());
  std::ostringstream text;
  write_capture(scene, text);
  const Scene back = read_capture(text.str(), "test.hpt");
  EXPECT_TRUE(same_scene(scene, back)) << text.str();
  EXPECT_EQ(back.textures, scene.textures);
}

TEST(CaptureTextures, APatternIsTheImageItNames) {
  const Scene scene =
      read_capture("halfplane 1\ntexture floor pattern grid 64 32 format rgb565 mips box\nstate texture floor\n" +
                       std::string(kDrawn),
                   "test.hpt");
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0],
            make_texture("floor", pattern_image(TexturePattern::grid, 64, 32), TextureFormat::rgb565, Mips::box));
  EXPECT_EQ(scene.states.at(0).texture, 0u);
}

TEST(CaptureTextures, LevelsOfItsOwnFollowTheImage) {
  const Scene scene = read_capture(
      "halfplane 1\ntexture a inline l8 4 2 mips levels\ntexels 0001020304050607 10\n"
      "texels 11 20\nstate texture a\n" +
          std::string(kDrawn),
      "test.hpt");
  const Texture& texture = scene.textures.at(0);
  ASSERT_EQ(texture.level.size(), 3u);
  EXPECT_EQ(texture.level[1], (TextureLevel{2, 1, {0x10, 0x11}}));
  EXPECT_EQ(texture.level[2], (TextureLevel{1, 1, {0x20}}));
}

TEST(Texture, LevelsOfItsOwnGoOnAsBoxMeans) {
  const auto plain = [](int width, int height, std::uint8_t v) {
    return TexelImage{width, height, std::vector<Texel>(static_cast<std::size_t>(width * height), Texel{v, v, v, 255})};
  };
  const std::array<TexelImage, 2> levels{plain(8, 4, 10), plain(4, 2, 200)};
  const Texture texture = make_texture("t", levels, TextureFormat::rgba8888);
  ASSERT_EQ(texture.level.size(), 4u);
  EXPECT_EQ(texture.texel(0, 0, 0)[0], 10);
  EXPECT_EQ(texture.texel(1, 3, 1)[0], 200);
  EXPECT_EQ(texture.texel(3, 0, 0)[0], 200);
  const std::array<TexelImage, 2> wrong{plain(8, 4, 0), plain(4, 4, 0)};
  EXPECT_THROW((void)make_texture("t", wrong, TextureFormat::rgba8888), InputError);
  EXPECT_THROW((void)make_texture("t", std::span<const TexelImage>(), TextureFormat::rgba8888), InputError);
  EXPECT_THROW((void)make_texture("t", levels, TextureFormat::p4), InputError);
}

TEST(CaptureTextures, WhatIsWrongIsSaidInOneLine) {
  const auto message = [](const std::string& lines) -> std::string {
    try {
      (void)read_capture("halfplane 1\n" + lines + kDrawn, "x.hpt");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto says = [&](const std::string& lines, const std::string& what) {
    EXPECT_NE(message(lines).find(what), std::string::npos) << lines << message(lines);
    EXPECT_EQ(message(lines).find('\n'), std::string::npos);
    EXPECT_TRUE(message(lines).starts_with("x.hpt:")) << message(lines);
  };
  says("texture\n", "without a name");
  says("texture off pattern grid 8 8\n", "named off");
  says("texture a pattern grid 8 8\ntexture a pattern grid 8 8\n", "a second texture 'a'");
  says("texture a pattern grid 0 8\n", "the texture's width");
  says("texture a pattern grid 8 4097\n", "the texture's height");
  says("texture a pattern gradient 64 64 format p8\n", "colours, but p8 holds 256");
  says("texture a file\n", "without a path");
  says("texture a file nowhere.png\n", "nowhere.png");
  says("texture a inline l8 2 2\n", "has 0 of its 2x2 texels");
  says("texture a pattern grid 8 8 mips levels\n", "not inline");
  says("texture a inline l8 2 2 mips levels\ntexels 00010203\n",
       "level 1 of texture 'a' from line 2 has 0 of its 1x1 texels");
  says("texture a inline l8 4 4 mips levels\ntexels 000102030405060708090a0b0c0d0e0f 01\n", "level 1 of texture 'a'");
  says("texture a inline l8 2 1 mips levels\ntexels 000102 03\n", "more texels than the 1 of the last level");
  says("texture a inline l8 2 2\ntexels 000102\n", "has 3 of its 2x2 texels");
  says("texture a inline l8 2 2\ntexels 0001020304\n", "more texels than the 4");
  says("texture a inline l8 2 2\ntexels 00010g03\n", "no hex digit");
  says("texture a inline l8 2 2\ntexels 000\n", "3 digits in a word");
  says("texture a inline l8 2 2 format l8\n", "names it already");
  says("texture a inline p4 2 1\ntexels 01\n", "texel 0 of a palette of 0");
  says("texels 00\n", "texels without a texture");
  says("palette 00000000\n", "palette without");
  says("state texture floor\n", "'floor' is not known");
  says("state texture_wrap repeat\n", "texture_wrap along v");
}

TEST(CaptureTextures, ASceneWithBrokenTexturesIsRefused) {
  const Texture good = make_texture("t", pattern_image(TexturePattern::grid, 8, 8), TextureFormat::p4, Mips::box);
  const auto refused = [&](auto&& change) {
    Scene scene = test::SceneBuilder(8, 8).scene;
    scene.textures = {good};
    EXPECT_NO_THROW(validate(scene));
    change(scene);
    EXPECT_THROW(validate(scene), InputError);
  };
  refused([](Scene& s) { s.textures[0].name = "a b"; });
  refused([](Scene& s) { s.textures[0].name = "off"; });
  refused([](Scene& s) { s.textures.push_back(s.textures[0]); });
  refused([](Scene& s) { s.textures[0].level.clear(); });
  refused([](Scene& s) { s.textures[0].level[0].width = 0; });
  refused([](Scene& s) { s.textures[0].level[1].code.pop_back(); });
  refused([](Scene& s) { s.textures[0].level[0].code[5] = 16; });
  refused([](Scene& s) {
    s.textures[0].mips = Mips::levels;
    s.textures[0].level.pop_back();
  });
  refused([](Scene& s) { s.states[0].texture = 1; });
}

}  // namespace
}  // namespace halfplane::texture_test
