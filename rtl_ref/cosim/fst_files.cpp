#include "fst_files.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

struct FstState {
  std::string folder;
  int error = 0;
};

FstState& state() {
  thread_local FstState one;
  return one;
}

void note(int error) {
  if (state().error == 0) state().error = error;
}

/// Opens a temporary file without a name, so that it vanishes when closed.
std::FILE* open_temporary() {
  std::string name = state().folder + ".halfplane-fst-XXXXXX";
  const int descriptor = mkstemp(name.data());
  std::FILE* const file = descriptor < 0 ? nullptr : fdopen(descriptor, "w+b");
  if (file == nullptr) note(errno);
  if (descriptor >= 0) (void)unlink(name.c_str());
  return file;
}

std::FILE* open_noted(const char* path, const char* mode) {
  const bool writes = *mode == 'w';
  if (writes && std::string_view(path).ends_with(".hier")) return open_temporary();  // ends up in the waveform
  std::FILE* const file = std::fopen(path, mode);
  if (file == nullptr && writes) note(errno);
  return file;
}

/// A failed write shows here at the latest.
int close_noted(std::FILE* file) {
  errno = 0;
  const bool had_error = std::ferror(file) != 0;
  const int result = std::fclose(file);
  if (had_error || result != 0) note(errno != 0 ? errno : EIO);
  return result;
}

std::size_t write_noted(const void* bytes, std::size_t size, std::size_t count, std::FILE* file) {
  errno = 0;
  const std::size_t written = std::fwrite(bytes, size, count, file);
  if (written != count) note(errno != 0 ? errno : EIO);
  return written;
}

int flush_noted(std::FILE* file) {
  const int result = std::fflush(file);
  if (result != 0) note(errno);
  return result;
}

int seek_noted(std::FILE* file, off_t offset, int whence) {
  const int result = fseeko(file, offset, whence);
  if (result != 0) note(errno);
  return result;
}

/// A mapping with every page present: of the file where it is long enough, else of anonymous memory.
void* map_whole(void* address, std::size_t length, int protection, int flags, int descriptor, off_t offset) {
  if (length == 0) return nullptr;
  if (const int error = posix_fallocate(descriptor, offset, static_cast<off_t>(length)); error != 0) {
    note(error);
    return mmap(address, length, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  }
  return mmap(address, length, protection, flags, descriptor, offset);
}

}  // namespace

namespace halfplane {

void begin_fst(const std::string& folder) { state() = {folder.empty() ? "./" : folder, 0}; }

int fst_error() { return state().error; }

}  // namespace halfplane

#define fopen open_noted
#define tmpfile open_temporary
#define fclose close_noted
#define fwrite write_noted
#define fflush flush_noted
#define fseeko seek_noted
#define mmap map_whole
#include <verilated_fst_c.cpp>
