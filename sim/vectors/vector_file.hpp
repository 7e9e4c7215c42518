// Files of vectors: a header that names stage, configuration, fields and widths, then packets, as described in
// docs/your-rtl.md.
//
//   jsonl   a line for the header, then one for each packet, inputs and outputs in the order of the stage
//   csv     the same as rows
//   hex     a folder: header.json, and PACKET.hex for each port, one packed packet per line, for $readmemh
#pragma once

#include <array>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "packets.hpp"
#include "record.hpp"

namespace halfplane::vectors {

enum class Format : std::uint8_t { jsonl, csv, hex };
inline constexpr std::array<std::string_view, 3> kFormats{"jsonl", "csv", "hex"};

struct WrittenFile {
  std::string path;
  std::size_t bytes = 0;
};

/// The source of the packets: a scene, or "random N".
struct VectorSource {
  std::string text;
  std::optional<std::uint64_t> seed;  ///< none: an older file without it
};

/// Replays the stage into `path`, a file or for hex a folder, completely or not at all.
std::vector<WrittenFile> write_vectors(const std::string& path, Format format, const JudgedStage& stage,
                                       const Config& config, const StagePackets& packets, const VectorSource& source);

/// The content of a file.
struct VectorFile {
  const JudgedStage* stage = nullptr;
  Config config;
  VectorSource source;
  StagePackets packets;
};

/// A file in any of the formats, recognised by its form: a folder is hex, a first line that begins with '{' jsonl.
/// `needs_in`: refuses a folder without input files. Throws InputError with file and line.
[[nodiscard]] VectorFile read_vectors(const std::string& path, bool needs_in = true);

/// Opens a file by its path; none if there is no such file.
using FileSource = std::function<std::unique_ptr<std::istream>(const std::string& path)>;
/// The same for files that need not be on disk. `is_folder`: `path` is the folder of hex.
[[nodiscard]] VectorFile read_vectors(const std::string& path, bool is_folder, const FileSource& open,
                                      bool needs_in = true);

}  // namespace halfplane::vectors
