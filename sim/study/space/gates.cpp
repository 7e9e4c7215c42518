#include "sim/study/space/gates.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "model/generate/raster_pkg.hpp"
#include "sim/interrupt.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

bool is_on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  const std::string folders = path == nullptr ? "" : path;
  for (std::size_t start = 0; start <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', start), folders.size());
    if (::access((fs::path(folders.substr(start, end - start)) / program).c_str(), X_OK) == 0) return true;
    start = end + 1;
  }
  return false;
}

/// Next to the program as laid out by `cmake --install`, or where the program was built.
std::string default_rtl() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = self.parent_path().parent_path() / "share/halfplane/rtl_ref";
  return fs::exists(installed / "area/gates.py", error) ? installed.string() : HALFPLANE_RTL_SOURCES;
}

std::string default_cache() {
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder != nullptr && *folder == '/')
    return std::string(folder) + "/halfplane/gates";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::string(home) + "/.cache/halfplane/gates";
  return (fs::temp_directory_path() / "halfplane-gates").string();
}

/// The output of a command, and its status.
struct Said {
  std::string out;
  int status = 0;
};

Said run(const std::string& command) {
  Said said;
  FILE* pipe = ::popen(command.c_str(), "r");  // NOLINT: the shell joins stderr to stdout
  if (pipe == nullptr) throw std::runtime_error("--area: no process can be started");
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;) said.out.append(part.data(), n);
  const int status = ::pclose(pipe);
  said.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return said;
}

/// A file that is removed after its last use.
class PackageFile {
 public:
  explicit PackageFile(const std::string& text) : path_((fs::temp_directory_path() / "halfplane-XXXXXX.sv").string()) {
    const int file = ::mkstemps(path_.data(), 3);
    if (file < 0) throw std::runtime_error("--area: " + path_ + " cannot be written; give TMPDIR a folder that can");
    const auto written = ::write(file, text.data(), text.size());
    ::close(file);
    if (written != static_cast<ssize_t>(text.size()))
      throw std::runtime_error("--area: " + path_ + ": the disk is full");
  }
  ~PackageFile() { ::unlink(path_.c_str()); }
  PackageFile(const PackageFile&) = delete;
  PackageFile& operator=(const PackageFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

Gates::Gates(std::string rtl, std::string cache, const std::vector<std::string>& parts) : parts_(parts) {
  for (const char* program : {"yosys", "python3"})
    if (!is_on_path(program))
      throw std::runtime_error("--area counts gates with Yosys and a Python script, and there is no " +
                               std::string(program) + " on the PATH; install yosys and python3, or leave out --area");
  if (rtl.empty()) rtl = default_rtl();
  if (cache.empty()) cache = default_cache();
  const fs::path script = fs::path(rtl) / "area/gates.py";
  if (!fs::exists(script))
    throw std::runtime_error("--area: " + script.string() + " is not there; give the folder of raster_top.sv by --rtl");
  std::string list;
  for (const std::string& part : parts) list += (list.empty() ? "" : ",") + part;
  command_ = "python3 " + in_single_quotes(script.string()) + " --rtl " + in_single_quotes(rtl) + " --cache " +
             in_single_quotes(cache) + " --parts " + list + " ";
}

nlohmann::ordered_json Gates::of(const Config& config) const {
  const PackageFile package(raster_pkg(config));
  const Said said = run(command_ + in_single_quotes(package.path()) + " 2>&1");
  stop_if_interrupted();
  if (said.status != 0) {
    const std::string line = said.out.substr(0, said.out.find('\n'));
    throw std::runtime_error("--area: " + (line.empty() ? "gates.py failed" : line));
  }
  const auto all = nlohmann::ordered_json::parse(said.out);
  nlohmann::ordered_json found;
  for (const std::string& part : parts_) {
    found[part] = all.at(part);
    found[part].erase("modules");
  }
  return found;
}

}  // namespace halfplane
