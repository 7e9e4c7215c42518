// Files of vectors: a header that names stage, configuration, fields and widths, then packets, as docs/your-rtl.md has it.
//
//   jsonl   a line for the header, then one for each packet, inputs and outputs in the order of the stage
//   csv     the same as rows
//   hex     a folder: header.json, and PACKET.hex for each port, a packed packet a line, for $readmemh
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

/// What the packets are of: a scene, or "random N".
struct VectorSource {
  std::string text;
  std::optional<std::uint64_t> seed;  ///< none: an older file, which does not say
};

/// Replays the stage into `path`, a file or for hex a folder, whole or not at all.
std::vector<WrittenFile> write_vectors(const std::string& path, Format format, const JudgedStage& stage,
                                       const Config& config, const StagePackets& packets, const VectorSource& source);

/// What a file holds.
struct VectorFile {
  const JudgedStage* stage = nullptr;
  Config config;
  VectorSource source;
  StagePackets packets;
};

/// A file of any of the formats, told apart by what it is: a folder is hex, a first line that begins with '{' jsonl.
/// `needs_in`: a folder without the files of what goes in is refused. Throws InputError with file and line.
[[nodiscard]] VectorFile read_vectors(const std::string& path, bool needs_in = true);

/// Opens a file by its path; none where there is no such file.
using FileSource = std::function<std::unique_ptr<std::istream>(const std::string& path)>;
/// The same of files that need not lie on a disk. `is_folder`: `path` is the folder of hex.
[[nodiscard]] VectorFile read_vectors(const std::string& path, bool is_folder, const FileSource& open,
                                      bool needs_in = true);

}  // namespace halfplane::vectors
