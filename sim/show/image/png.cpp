#include "png.hpp"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <exception>
#include <limits>

#include "model/config.hpp"
#include "whole_file.hpp"

#define STB_IMAGE_WRITE_STATIC  // our copy stays in this file, whatever other libraries contain
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

namespace halfplane {
namespace {

using Bytes = std::vector<std::uint8_t>;

// libpng is C: callbacks must not throw, and leave it only by longjmp.
struct Grey16Job {
  Bytes* out = nullptr;
  std::array<char, 160> error{};
};

void append(png_structp png, png_bytep data, std::size_t size) {
  auto* job = static_cast<Grey16Job*>(png_get_io_ptr(png));
  bool grown = false;
  try {
    job->out->insert(job->out->end(), data, data + size);
    grown = true;
  } catch (const std::exception&) {  // reported below, outside the handler that longjmp must not cross
  }
  if (!grown) png_error(png, "out of memory");
}

void flush(png_structp) {}

void on_error(png_structp png, png_const_charp message) {
  auto* job = static_cast<Grey16Job*>(png_get_error_ptr(png));
  std::snprintf(job->error.data(), job->error.size(), "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

// `rows` contains big-endian samples. All locals are plain values: longjmp may return to this frame.
bool write_grey16(Grey16Job* job, int width, int height, const std::uint8_t* rows) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, job, append, flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 16, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t stride = 2 * static_cast<std::size_t>(width);
  for (int y = 0; y < height; ++y) png_write_row(png, rows + static_cast<std::size_t>(y) * stride);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Picture& picture) {
  const auto row_bytes = 3 * static_cast<long long>(picture.width) + 1;  // stb counts in int
  if (picture.width <= 0 || picture.height <= 0) throw InputError("a picture of 0 pixels has no PNG; give it a size");
  if (row_bytes > std::numeric_limits<int>::max() / picture.height)
    throw InputError("a picture of " + std::to_string(picture.width) + "x" + std::to_string(picture.height) +
                     " is too large for a PNG; give a smaller --size");
  int size = 0;
  unsigned char* data =
      stbi_write_png_to_mem(picture.rgb.data(), 3 * picture.width, picture.width, picture.height, 3, &size);
  if (data == nullptr) throw std::bad_alloc();
  Bytes bytes(data, data + size);
  STBIW_FREE(data);
  return bytes;
}

std::vector<std::uint8_t> encode_png_grey16(int width, int height, std::span<const std::uint16_t> samples) {
  if (width <= 0 || height <= 0) throw InputError("a picture of 0 pixels has no PNG; give it a size");
  Bytes rows;
  rows.reserve(2 * samples.size());
  for (const std::uint16_t sample : samples) {
    rows.push_back(static_cast<std::uint8_t>(sample >> 8));  // PNG is big-endian
    rows.push_back(static_cast<std::uint8_t>(sample & 0xff));
  }
  Bytes bytes;
  Grey16Job job{&bytes, {}};
  if (!write_grey16(&job, width, height, rows.data()))
    throw InputError(std::string("cannot make the depth PNG: ") + job.error.data() + "; write a .npy instead");
  return bytes;
}

void write_png(const std::string& path, const Picture& picture) { write_whole_file(path, encode_png(picture)); }

}  // namespace halfplane
