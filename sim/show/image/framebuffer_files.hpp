// The two images of a framebuffer as pictures, files and hashes. Formats: docs/spec.md, "Files written".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/stages/framebuffer.hpp"
#include "sim/show/image/picture.hpp"

namespace halfplane {

/// The stored colours at 8 bits: rgb565 expanded by bit replication, rgba8888 without its alpha.
[[nodiscard]] Picture color_picture(const Framebuffer& frame, ColorFormat format);

/// An array file, format 1.0: <u4 or <i4, C order, shape (height, width), row 0 at the top.
[[nodiscard]] std::vector<std::uint8_t> encode_npy(int width, int height, std::span<const std::uint32_t> values);
[[nodiscard]] std::vector<std::uint8_t> encode_npy(int width, int height, std::span<const std::int32_t> values);
[[nodiscard]] std::vector<std::uint8_t> encode_npy(int width, int height, std::span<const float> values);

/// Writes width * height values to `path`, which must end in .npy. Throws InputError naming path and reason.
void write_npy(const std::string& path, int width, int height, std::span<const std::uint32_t> values);
void write_npy(const std::string& path, int width, int height, std::span<const std::int32_t> values);
void write_npy(const std::string& path, int width, int height, std::span<const float> values);

/// Throws InputError when the format of `path` has too few bits for depth codes: a .png has 16, a .npy has 32. Call it
/// before rendering, so that no time is lost for a picture that cannot be saved.
void check_depth_path(const std::string& path, int depth_bits);

/// Writes the stored codes, unscaled, in the format that the extension names.
void write_depth(const std::string& path, const Framebuffer& frame, int depth_bits);

/// Depth codes without the padding of the rows.
[[nodiscard]] std::vector<std::uint32_t> depth_codes(const Framebuffer& frame);

/// FNV-1a 64 of the image's bytes, 16 lowercase hex digits. Rows from the top without padding; rgb565 as little-endian
/// 16-bit words, rgba8888 as bytes R, G, B, A; depth as little-endian 32-bit words.
[[nodiscard]] std::string color_hash(const Framebuffer& frame, ColorFormat format);
[[nodiscard]] std::string depth_hash(const Framebuffer& frame);

/// The hash itself (Fowler, Noll, Vo; parameters of the 64-bit 1a variant).
[[nodiscard]] std::uint64_t fnv1a64(std::span<const std::uint8_t> bytes);

}  // namespace halfplane
