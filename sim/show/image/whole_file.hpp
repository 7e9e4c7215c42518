// Files are written whole or not at all.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace halfplane {

/// Replaces `path` by `bytes`: written to a temporary name in the same folder, then renamed, so that a reader sees the
/// old file or the new one. A symbolic link keeps pointing at its target; a device or pipe is written directly. Throws
/// InputError naming path and reason; nothing half-written is left.
void write_whole_file(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace halfplane
