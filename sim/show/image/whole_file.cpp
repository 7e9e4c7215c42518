#include "whole_file.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

#include "model/config.hpp"
#include "sim/interrupt.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
  std::string mend = "; choose another file";
  if (error == ENOENT) mend = "; create its folder first";
  if (error == EACCES || error == EPERM || error == EROFS) mend = "; choose a folder you may write to";
  if (error == ENOSPC || error == EDQUOT) mend = "; free some space or choose another disk";
  throw InputError("cannot write '" + path + "': " + std::strerror(error) + mend);
}

// Returns 0 or the errno of the first step that failed.
int write_all(std::FILE* file, std::span<const std::uint8_t> bytes) {
  int error = 0;
  if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size()) error = errno;
  if (std::fflush(file) != 0 && error == 0) error = errno;  // a full disk shows up here at the latest
  if (std::fclose(file) != 0 && error == 0) error = errno;
  return error;
}

// A name that no other process or call uses; short, so that it fits wherever the target's own name does.
std::FILE* open_temporary(const fs::path& folder, fs::path& name) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = folder / (".halfplane-" + std::to_string(getpid()) + "-" + std::to_string(attempt) + ".part");
    if (std::FILE* file = std::fopen(name.c_str(), "wbx")) return file;
    if (errno != EEXIST) return nullptr;
  }
  return nullptr;
}

}  // namespace

void write_whole_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  if (path.empty()) throw InputError("cannot write to an empty file name; give a file");
  if (path == "-" && isatty(STDOUT_FILENO) != 0 && std::find(bytes.begin(), bytes.end(), 0) != bytes.end())
    throw InputError("-: this file is no text, and stdout is a terminal; give a pipe, or a file in place of -");
  if (path == "-") return write_stdout(bytes, "-", "give a place that takes it, or a file in place of -");
  fs::path target(path);
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) fail(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {  // renaming would replace the device itself
    std::FILE* device = std::fopen(target.c_str(), "wb");
    if (device == nullptr) fail(path, errno);
    if (const int reason = write_all(device, bytes)) fail(path, reason);
    return;
  }
  if (fs::exists(status)) target = fs::canonical(target, error);
  if (error && fs::exists(status)) fail(path, error.value());

  fs::path temporary;
  std::FILE* file = open_temporary(target.parent_path(), temporary);
  if (file == nullptr) fail(path, errno);
  const HalfWrittenFile half_written(temporary.string());
  int reason = write_all(file, bytes);
  if (reason == 0 && fs::exists(status)) fs::permissions(temporary, status.permissions(), error);  // as they were
  if (reason == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) reason = errno;
  if (reason != 0) {
    std::remove(temporary.c_str());
    fail(path, reason);
  }
}

bool is_stdout_unread() {
  pollfd out{STDOUT_FILENO, 0, 0};  // POLLERR and POLLHUP are always told
  return poll(&out, 1, 0) > 0 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

void write_stdout(std::span<const std::uint8_t> bytes, const std::string& what, const std::string& mend) {
  std::cout.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!std::cout.flush() && !is_stdout_unread()) throw InputError(what + ": writing to stdout failed; " + mend);
}

}  // namespace halfplane
