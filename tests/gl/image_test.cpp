// Pixels between the program's memory and the driver: every format with every type, pixel store, pixel transfer.
#include "gl/core/image.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "gl/core/commands.hpp"

namespace halfplane::gl::image_test {
namespace {

constexpr auto kFormats =
    std::to_array<GLenum>({GL_COLOR_INDEX, GL_STENCIL_INDEX, GL_DEPTH_COMPONENT, GL_RED, GL_GREEN, GL_BLUE, GL_ALPHA,
                           GL_RGB, GL_RGBA, GL_BGR, GL_BGRA, GL_LUMINANCE, GL_LUMINANCE_ALPHA});
constexpr auto kScalarTypes = std::to_array<GLenum>(
    {GL_BITMAP, GL_UNSIGNED_BYTE, GL_BYTE, GL_UNSIGNED_SHORT, GL_SHORT, GL_UNSIGNED_INT, GL_INT, GL_FLOAT});
constexpr auto kPackedTypes = std::to_array<GLenum>(
    {GL_UNSIGNED_BYTE_3_3_2, GL_UNSIGNED_BYTE_2_3_3_REV, GL_UNSIGNED_SHORT_5_6_5, GL_UNSIGNED_SHORT_5_6_5_REV,
     GL_UNSIGNED_SHORT_4_4_4_4, GL_UNSIGNED_SHORT_4_4_4_4_REV, GL_UNSIGNED_SHORT_5_5_5_1, GL_UNSIGNED_SHORT_1_5_5_5_REV,
     GL_UNSIGNED_INT_8_8_8_8, GL_UNSIGNED_INT_8_8_8_8_REV, GL_UNSIGNED_INT_10_10_10_2, GL_UNSIGNED_INT_2_10_10_10_REV});

bool is_luminance(GLenum format) { return format == GL_LUMINANCE || format == GL_LUMINANCE_ALPHA; }

TEST(GlImage, FormatsAndTypesThatGoTogether) {
  EXPECT_EQ(check_format(GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV), GLenum{GL_NO_ERROR});
  EXPECT_EQ(check_format(GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV), GLenum{GL_NO_ERROR});
  EXPECT_EQ(check_format(GL_RGB, GL_UNSIGNED_SHORT_5_6_5), GLenum{GL_NO_ERROR});
  EXPECT_EQ(check_format(GL_BGR, GL_UNSIGNED_SHORT_5_6_5), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(check_format(GL_RGB, GL_UNSIGNED_SHORT_4_4_4_4), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(check_format(GL_LUMINANCE, GL_UNSIGNED_BYTE_3_3_2), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(check_format(GL_RGB, GL_BITMAP), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(check_format(GL_STENCIL_INDEX, GL_BITMAP), GLenum{GL_NO_ERROR});
  EXPECT_EQ(check_format(GL_RGBA, GL_DOUBLE), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(check_format(4, GL_FLOAT), GLenum{GL_INVALID_ENUM});
}

/// Bytes that were unpacked and packed come back, whatever they are, with every pixel store.
TEST(GlImage, UnpackedAndPackedComesBack) {
  constexpr int kWidth = 5, kHeight = 3;
  Context context;
  int pairs = 0;
  const auto check = [&](GLenum format, GLenum type, bool swaps, int alignment) {
    SCOPED_TRACE(std::to_string(format) + " " + std::to_string(type));
    context.client.unpack.swap_bytes = context.client.pack.swap_bytes = swaps;
    context.client.unpack.alignment = context.client.pack.alignment = alignment;
    std::array<unsigned char, 512> from{}, to{};
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<unsigned char>(i * 73 + 11);
    if (type == GL_FLOAT)  // numbers in 0...1, of few bits
      for (std::size_t i = 0; i < from.size() / 4; ++i) {
        auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(i % 17) / 16);
        if (swaps) bits = bits >> 24 | (bits >> 8 & 0xff00) | (bits << 8 & 0xff0000) | bits << 24;
        std::memcpy(from.data() + 4 * i, &bits, sizeof bits);
      }
    const bool is_wide = type == GL_INT || type == GL_UNSIGNED_INT;
    if (is_wide)  // floats hold 24 bits
      for (std::size_t i = 0; i < from.size(); ++i)
        from[i] = (i % 4 == (swaps ? 0U : 3U)) ? 0x5a : i % 4 == 1 ? 0x33 : 0;
    const bool is_index = format == GL_COLOR_INDEX || format == GL_STENCIL_INDEX;
    const bool is_signed = type == GL_BYTE || type == GL_SHORT || type == GL_INT;
    if (is_signed)  // negative ones are held to 0, or masked
      for (unsigned char& byte : from) byte &= 0x7f;
    const Image image = unpack(context, kWidth, kHeight, 1, format, type, from.data());
    pack(context, image, format, type, to.data());
    const Image again = unpack(context, kWidth, kHeight, 1, format, type, to.data());
    ASSERT_EQ(image.pixel.size(), again.pixel.size());
    for (std::size_t i = 0; i < image.pixel.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c) {
        // A luminance is packed as the sum of three: it comes back three times as large.
        const float expected =
            is_luminance(format) && c < 3 ? std::min(3 * image.pixel[i][c], 1.0F) : image.pixel[i][c];
        const float tolerance =
            is_index || !is_luminance(format) ? (is_wide ? 1e-6F * std::max(1.0F, expected) : 1e-6F) : 0.005F;
        EXPECT_NEAR(again.pixel[i][c], expected, tolerance);
      }
    ++pairs;
  };
  for (const bool swaps : {false, true})
    for (const int alignment : {1, 2, 4, 8})
      for (const GLenum format : kFormats) {
        for (const GLenum type : kScalarTypes)
          if (check_format(format, type) == GL_NO_ERROR) check(format, type, swaps, alignment);
        for (const GLenum type : kPackedTypes)
          if (check_format(format, type) == GL_NO_ERROR) check(format, type, swaps, alignment);
      }
  EXPECT_EQ(pairs, 8 * (13 * 7 + 2 + 4 + 2 * 8));
}

TEST(GlImage, ChannelsOfFormats) {
  Context context;
  const std::array<GLubyte, 4> bytes{51, 102, 153, 204};
  const auto first = [&](GLenum format, GLenum type, const void* pixels) {
    return unpack(context, 1, 1, 1, format, type, pixels).pixel.front();
  };
  using Color = std::array<float, 4>;
  EXPECT_EQ(first(GL_RGBA, GL_UNSIGNED_BYTE, bytes.data()), (Color{0.2F, 0.4F, 0.6F, 0.8F}));
  EXPECT_EQ(first(GL_BGRA, GL_UNSIGNED_BYTE, bytes.data()), (Color{0.6F, 0.4F, 0.2F, 0.8F}));
  EXPECT_EQ(first(GL_BGR, GL_UNSIGNED_BYTE, bytes.data()), (Color{0.6F, 0.4F, 0.2F, 1}));
  EXPECT_EQ(first(GL_ALPHA, GL_UNSIGNED_BYTE, bytes.data()), (Color{0, 0, 0, 0.2F}));
  EXPECT_EQ(first(GL_GREEN, GL_UNSIGNED_BYTE, bytes.data()), (Color{0, 0.2F, 0, 1}));
  EXPECT_EQ(first(GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, bytes.data()), (Color{0.2F, 0.2F, 0.2F, 0.4F}));
  const GLushort word = 0xf80f;
  EXPECT_EQ(first(GL_RGB, GL_UNSIGNED_SHORT_5_6_5, &word), (Color{1, 0, 15.0F / 31, 1}));
  EXPECT_EQ(first(GL_RGB, GL_UNSIGNED_SHORT_5_6_5_REV, &word), (Color{15.0F / 31, 0, 1, 1}));
  EXPECT_EQ(first(GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, &word), (Color{1, 8.0F / 15, 0, 1}));
  EXPECT_EQ(first(GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV, &word), (Color{30.0F / 31, 0, 15.0F / 31, 1}));
  const GLuint wide = 0x40000003;  // alpha 1/3, blue 0, green 0, red 3
  EXPECT_EQ(first(GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, &wide), (Color{3.0F / 1023, 0, 0, 1.0F / 3}));
  const GLbyte lowest = -128;
  EXPECT_EQ(first(GL_RED, GL_BYTE, &lowest)[0], -1);
  EXPECT_EQ(first(GL_COLOR_INDEX, GL_BYTE, &lowest)[0], -128);
  const GLint large = 0x7a000078;
  EXPECT_EQ(first(GL_STENCIL_INDEX, GL_INT, &large)[0], 0x78);
  EXPECT_TRUE(unpack(context, 1, 1, 1, GL_RGB, GL_FLOAT, nullptr).pixel.empty());
}

TEST(GlImage, RowsLieAsPixelStoreSays) {
  Context context;
  std::array<GLubyte, 256> bytes{};
  std::iota(bytes.begin(), bytes.end(), GLubyte{0});
  PixelStore& store = context.client.unpack;
  store = {.row_length = 5, .skip_rows = 2, .skip_pixels = 1, .alignment = 4};
  Image image = unpack(context, 2, 2, 1, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, bytes.data());
  EXPECT_EQ(image.pixel[0][0], 2 * 8 + 1);  // rows of 5 bytes, at each fourth
  EXPECT_EQ(image.pixel[3][0], 3 * 8 + 2);
  store = {.image_height = 4, .skip_images = 1, .alignment = 1};
  image = unpack(context, 3, 2, 2, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, bytes.data(), true);
  EXPECT_EQ(image.pixel[0][0], 12);
  EXPECT_EQ(image.pixel[6][0], 24);
  image = unpack(context, 3, 2, 1, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, bytes.data());
  EXPECT_EQ(image.pixel[0][0], 0);  // two dimensions: images are not skipped
}

TEST(GlImage, BitmapsFromBothEnds) {
  Context context;
  const std::array<GLubyte, 8> bits{0b1010'0000, 0b0100'0000, 0, 0, 0b0000'0001, 0x80, 0, 0};
  Bitmap bitmap = unpack_bitmap(context, 10, 2, bits.data());
  EXPECT_TRUE(bitmap.bit[0] && bitmap.bit[2] && bitmap.bit[9] && bitmap.bit[10 + 7] && bitmap.bit[10 + 8]);
  EXPECT_EQ(std::ranges::count(bitmap.bit, true), 5);
  context.client.unpack.lsb_first = true;
  context.client.unpack.skip_pixels = 5;
  bitmap = unpack_bitmap(context, 4, 1, bits.data());
  EXPECT_EQ(bitmap.bit, (std::vector<bool>{true, false, true, false}));
}

std::array<float, 4> after_transfer(const Context& context, GLenum format, const std::array<float, 4>& pixel) {
  auto image = std::make_shared<Image>(Image{1, 1, 1, format, {pixel}});
  return transferred(context, image)->pixel.front();
}

TEST(GlImage, PixelTransfer) {
  Context context;
  pixel_transfer(context, GL_RED_SCALE, 2);
  pixel_transfer(context, GL_GREEN_BIAS, 0.25);
  pixel_transfer(context, GL_ALPHA_SCALE, -1);
  EXPECT_EQ(after_transfer(context, GL_RGBA, {0.25F, 0.5F, 0.75F, 1}), (std::array<float, 4>{0.5F, 0.75F, 0.75F, 0}));
  pixel_map(context, GL_PIXEL_MAP_B_TO_B, std::make_shared<std::vector<float>>(std::vector<float>{1, 0.5F, 0}));
  pixel_transfer(context, GL_MAP_COLOR, 1);
  EXPECT_EQ(after_transfer(context, GL_RGBA, {0, 0, 0.9F, 1})[2], 0);
  EXPECT_EQ(after_transfer(context, GL_RGBA, {0, 0, 0.5F, 1})[2], 0.5F);
  pixel_transfer(context, GL_DEPTH_BIAS, 0.5);
  EXPECT_EQ(after_transfer(context, GL_DEPTH_COMPONENT, {0.75F})[0], 1);
  pixel_transfer(context, GL_INDEX_SHIFT, 2);
  pixel_transfer(context, GL_INDEX_OFFSET, 1);
  EXPECT_EQ(after_transfer(context, GL_STENCIL_INDEX, {3})[0], 13);
  pixel_map(context, GL_PIXEL_MAP_I_TO_G, std::make_shared<std::vector<float>>(std::vector<float>{0, 0.5F}));
  EXPECT_EQ(after_transfer(context, GL_COLOR_INDEX, {3})[1], 0.5F);  // 13 of two entries
  EXPECT_EQ(context.error, GLenum{GL_NO_ERROR});
  pixel_map(context, GL_PIXEL_MAP_I_TO_G, std::make_shared<std::vector<float>>(3, 0.0F));
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_VALUE});  // no power of two
  pixel_store(context, GL_PACK_ALIGNMENT, 3);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_VALUE});
  pixel_store(context, GL_UNPACK_ROW_LENGTH, -1);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_VALUE});
  pixel_transfer(context, GL_ZOOM_X, 1);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_ENUM});
}

}  // namespace
}  // namespace halfplane::gl::image_test
