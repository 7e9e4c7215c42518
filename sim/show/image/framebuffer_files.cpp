#include "framebuffer_files.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "model/stages/fragment_ops.hpp"
#include "png.hpp"
#include "sim/words.hpp"
#include "whole_file.hpp"

namespace halfplane {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kFnvOffset = 0xcbf29ce484222325u;
constexpr std::uint64_t kFnvPrime = 0x100000001b3u;
constexpr std::size_t kNpyAlignment = 64;  // bytes: the data begins at a multiple of it
constexpr std::size_t kNpyPrefix = 10;     // magic 6, version 2, header length 2
constexpr int kPngDepthBits = 16;

struct Fnv1a {
  std::uint64_t state = kFnvOffset;
  void add(std::uint32_t byte) { state = (state ^ (byte & 0xff)) * kFnvPrime; }
  // The `bytes` low bytes of `word`, lowest first.
  void add_little_endian(std::uint32_t word, int bytes) {
    for (int i = 0; i < bytes; ++i) add(word >> (8 * i));
  }
};

std::string hash_of(const Framebuffer& frame, const Framebuffer::Image& image, int bytes_per_pixel) {
  Fnv1a hash;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) hash.add_little_endian(image[frame.at(x, y)], bytes_per_pixel);
  return hex_digits(hash.state, 64);
}

// 5 or 6 bits to 8, the top bits repeated below: 0 stays 0 and full scale becomes 255.
std::uint8_t replicate(std::uint32_t value, int bits) {
  return static_cast<std::uint8_t>((value << (8 - bits)) | (value >> (2 * bits - 8)));
}

Rgb unpack(std::uint32_t code, ColorFormat format) {
  const auto c = unpack_color(format, code);
  if (format == ColorFormat::rgb565) return {replicate(c[0], 5), replicate(c[1], 6), replicate(c[2], 5)};
  return {static_cast<std::uint8_t>(c[0]), static_cast<std::uint8_t>(c[1]), static_cast<std::uint8_t>(c[2])};
}

std::string extension(const std::string& path) {
  std::string text = std::filesystem::path(path).extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

template <typename T>
Bytes npy_bytes(int width, int height, std::span<const T> values, std::string_view type) {
  std::string header = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                       std::to_string(height) + ", " + std::to_string(width) + "), }";
  header.append(kNpyAlignment - 1 - (kNpyPrefix + header.size()) % kNpyAlignment, ' ');
  header += '\n';
  Bytes bytes{0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0};
  bytes.push_back(static_cast<std::uint8_t>(header.size() & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(header.size() >> 8));
  bytes.insert(bytes.end(), header.begin(), header.end());
  bytes.reserve(bytes.size() + 4 * values.size());
  for (const T value : values)
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>((std::bit_cast<std::uint32_t>(value) >> shift) & 0xff));
  return bytes;
}

void require_npy(const std::string& path) {
  if (path != "-" && extension(path) != ".npy")
    throw InputError("cannot write '" + path + "': this option writes .npy files; give a name that ends in .npy");
}

}  // namespace

Picture color_picture(const Framebuffer& frame, ColorFormat format) {
  Picture picture(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) set_pixel(picture, x, y, unpack(frame.color[frame.at(x, y)], format));
  return picture;
}

Bytes encode_npy(int width, int height, std::span<const std::uint32_t> values) {
  return npy_bytes(width, height, values, "<u4");
}

Bytes encode_npy(int width, int height, std::span<const std::int32_t> values) {
  return npy_bytes(width, height, values, "<i4");
}

Bytes encode_npy(int width, int height, std::span<const float> values) {
  return npy_bytes(width, height, values, "<f4");
}

void write_npy(const std::string& path, int width, int height, std::span<const std::uint32_t> values) {
  require_npy(path);
  write_whole_file(path, encode_npy(width, height, values));
}

void write_npy(const std::string& path, int width, int height, std::span<const std::int32_t> values) {
  require_npy(path);
  write_whole_file(path, encode_npy(width, height, values));
}

void write_npy(const std::string& path, int width, int height, std::span<const float> values) {
  require_npy(path);
  write_whole_file(path, encode_npy(width, height, values));
}

void check_depth_path(const std::string& path, int depth_bits) {
  const std::string kind = extension(path);
  if (path == "-") return;  // .npy
  if (kind != ".png" && kind != ".npy")
    throw InputError("cannot write '" + path +
                     "': depths are written as .npy, or up to 16 bits as .png; give a name that ends in one of them");
  if (kind == ".png" && depth_bits > kPngDepthBits)
    throw InputError("'" + path + "': " + std::to_string(depth_bits) +
                     " depth bits do not fit a 16-bit PNG; write a .npy instead");
}

void write_depth(const std::string& path, const Framebuffer& frame, int depth_bits) {
  check_depth_path(path, depth_bits);
  const std::vector<std::uint32_t> codes = depth_codes(frame);
  if (extension(path) != ".png") return write_npy(path, frame.width, frame.height, std::span(codes));
  std::vector<std::uint16_t> samples(codes.size());
  std::transform(codes.begin(), codes.end(), samples.begin(),
                 [](std::uint32_t code) { return static_cast<std::uint16_t>(code); });  // < 2^16 by the check above
  write_whole_file(path, encode_png_grey16(frame.width, frame.height, samples));
}

std::vector<std::uint32_t> depth_codes(const Framebuffer& frame) {
  std::vector<std::uint32_t> codes;
  codes.reserve(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y) {
    const auto row = frame.depth.begin() + static_cast<std::ptrdiff_t>(frame.at(0, y));
    codes.insert(codes.end(), row, row + frame.width);
  }
  return codes;
}

std::string color_hash(const Framebuffer& frame, ColorFormat format) {
  return hash_of(frame, frame.color, format == ColorFormat::rgb565 ? 2 : 4);
}

std::string depth_hash(const Framebuffer& frame) { return hash_of(frame, frame.depth, 4); }

std::uint64_t fnv1a64(std::span<const std::uint8_t> bytes) {
  Fnv1a hash;
  for (const std::uint8_t byte : bytes) hash.add(byte);
  return hash.state;
}

}  // namespace halfplane
