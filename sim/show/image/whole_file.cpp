#include "whole_file.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "model/input_error.hpp"

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

// A name that no other process or call uses; short, so that it fits wherever the target's name does.
std::FILE* open_temporary(const fs::path& folder, fs::path& name) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = folder / (".halfplane-" + std::to_string(getpid()) + "-" + std::to_string(attempt) + ".part");
    if (std::FILE* file = std::fopen(name.c_str(), "wbx")) return file;
    if (errno != EEXIST) return nullptr;
  }
  return nullptr;
}

}  // namespace

PartFile::PartFile(const std::string& path) : path_(path), target_(path) {
  if (path.empty()) throw InputError("cannot write to an empty file name; give a file");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(path, EISDIR);
  if (fs::exists(status)) target_ = fs::canonical(path, error).string();
  if (error && fs::exists(status)) fail(path, error.value());
  fs::path temporary;
  std::FILE* file = open_temporary(fs::path(target_).parent_path(), temporary);
  if (file == nullptr) fail(path, errno);
  name_ = temporary.string();
  half_written_.emplace(name_);
  (void)std::fclose(file);
}

PartFile::~PartFile() {
  if (half_written_) std::remove(name_.c_str());
}

void PartFile::finish(int error) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (error == 0 && fs::exists(status)) fs::permissions(name_, status.permissions(), ignored);  // unchanged
  if (error == 0 && std::rename(name_.c_str(), target_.c_str()) != 0) error = errno;
  if (error != 0) std::remove(name_.c_str());
  half_written_.reset();
  if (error != 0) fail(path_, error);
}

void write_whole_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  if (path == "-" && isatty(STDOUT_FILENO) != 0 && std::find(bytes.begin(), bytes.end(), 0) != bytes.end())
    throw InputError("-: this file is no text, and stdout is a terminal; give a pipe, or a file in place of -");
  if (path == "-") return write_stdout(bytes, "-", "give a place that takes it, or a file in place of -");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const bool is_device = fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
  std::optional<PartFile> part;  // none for a device: renaming would replace it
  if (!is_device) part.emplace(path);
  std::FILE* file = std::fopen(part ? part->name().c_str() : path.c_str(), "wb");
  const int reason = file == nullptr ? errno : write_all(file, bytes);
  if (part) return part->finish(reason);
  if (reason != 0) fail(path, reason);
}

bool is_stdout_unread() {
  pollfd out{STDOUT_FILENO, 0, 0};  // POLLERR and POLLHUP are always reported
  return poll(&out, 1, 0) > 0 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

void write_stdout(std::span<const std::uint8_t> bytes, const std::string& what, const std::string& mend) {
  std::cout.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!std::cout.flush() && !is_stdout_unread()) throw InputError(what + ": writing to stdout failed; " + mend);
}

}  // namespace halfplane
