// The reader of vectors (`check`) on hostile input, and the judge on every accepted input. Bytes that begin with "%hex"
// are a folder: header.json up to the first line "%NAME", then NAME.hex up to the next one. Properties: no crash, no
// undefined behaviour; an InputError is one line that begins with the file's name; judging reaches the end of the
// input.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "model/config.hpp"
#include "sim/vectors/check.hpp"
#include "sim/vectors/vector_file.hpp"

namespace {

using namespace halfplane;

constexpr int kWidest = 64;  // pixels of a target that is judged: stages hold whole planes
constexpr std::string_view kFolder = "%hex\n";

void require(bool holds, const char* what, std::string_view message) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_vectors: %s: %.*s\n", what, static_cast<int>(message.size()), message.data());
  std::abort();
}

/// The files of a folder by their names.
std::map<std::string, std::string> files_of(std::string_view input) {
  std::map<std::string, std::string> files;
  std::string name = "fuzz/header.json";
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size() - 1) + 1;
    const std::string_view line = input.substr(0, end);
    if (line.starts_with('%'))
      name = "fuzz/" + std::string(line.substr(1, line.find('\n') - 1)) + ".hex";
    else
      files[name] += line;
    input.remove_prefix(end);
  }
  return files;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const bool is_folder = input.starts_with(kFolder);
  std::map<std::string, std::string> files;
  if (is_folder)
    files = files_of(input.substr(kFolder.size()));
  else
    files["fuzz"] = input;
  const auto open = [&](const std::string& path) -> std::unique_ptr<std::istream> {
    const auto found = files.find(path);
    if (found == files.end()) return nullptr;
    return std::make_unique<std::istringstream>(found->second);
  };
  try {
    const vectors::VectorFile file = vectors::read_vectors("fuzz", is_folder, open);
    if (file.config.target_width > kWidest || file.config.target_height > kWidest) return 0;
    try {
      const vectors::Judgement judgement = vectors::judge(*file.stage, file.config, file.packets);
      require(judgement.first.has_value() == (judgement.total_differing() != 0), "a difference that is not shown", "");
    } catch (const InputError& error) {
      const std::string_view message = error.what();
      require(message.find('\n') == std::string_view::npos && message.size() < 600, "no one line", message);
    }
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz"), "the place is not named", message);
    require(message.find('\n') == std::string_view::npos && message.size() < 1200, "no one line", message);
  }
  return 0;
}
