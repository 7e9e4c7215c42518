// Calls of processes that musl declares and Emscripten has not: there are no processes.
#include <cerrno>

extern "C" {

int prctl(int, ...) {
  errno = ENOSYS;
  return -1;
}

int wait4(int, int*, int, void*) {
  errno = ENOSYS;
  return -1;
}
}
