#include "sim/study/bench/mesa_peer.hpp"

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "model/config.hpp"
#include "sim/study/bench/mesa_frame.hpp"

namespace halfplane {
namespace {

// Requests: f renders a frame, c asks for its colours. Answers: a kind, a size, that many bytes.
enum class AnswerKind : char { ok, missing, bad_input };
struct AnswerHead {
  AnswerKind kind = AnswerKind::ok;
  std::uint64_t size = 0;
};

bool send_bytes(int socket, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_bytes(int socket, void* bytes, std::size_t size) {
  char* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t received = recv(socket, at, size, 0);
    if (received <= 0) return false;
    at += received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

void send_answer(int socket, AnswerKind kind, const void* bytes, std::size_t size) {
  AnswerHead head;
  head.kind = kind;
  head.size = size;
  if (send_bytes(socket, &head, sizeof head)) (void)send_bytes(socket, bytes, size);
}

// Without worker threads llvmpipe rasterizes in the caller's thread. With workers the caller bins triangles and then
// waits for them, so that N threads keep N cores busy.
int worker_threads(int threads) { return threads <= 1 ? 0 : threads; }

void serve(int socket, MesaFrame& frame) {
  for (char request = 0; receive_bytes(socket, &request, 1);) {
    if (request == 'c') {
      const std::vector<std::uint32_t> pixels = frame.color();
      send_answer(socket, AnswerKind::ok, pixels.data(), pixels.size() * sizeof pixels[0]);
      continue;
    }
    const auto begin = std::chrono::steady_clock::now();
    frame.render();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    send_answer(socket, AnswerKind::ok, &seconds, sizeof seconds);
  }
}

}  // namespace

MesaPeer::MesaPeer(int width, int height, int depth_bits, int threads, int samples)
    : width_(width), height_(height), depth_bits_(depth_bits), threads_(threads), samples_(samples) {
  start(nullptr);
}

MesaPeer::~MesaPeer() { stop(); }

void MesaPeer::start(const Scene* scene) {
  int sockets[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0)
    throw std::runtime_error("llvmpipe: no socket to talk to it; close some files");
  process_ = fork();
  if (process_ == 0) {
    close(sockets[0]);
    const auto fail = [&](AnswerKind kind, const std::string& text) {
      send_answer(sockets[1], kind, text.data(), text.size());
    };
    try {
      setenv("LP_NUM_THREADS", std::to_string(worker_threads(threads_)).c_str(), 1);
      setenv("GALLIUM_DRIVER", "llvmpipe", 1);
      MesaFrame frame(width_, height_, depth_bits_, samples_);
      if (scene != nullptr) frame.upload(*scene);
      const std::string name = frame.name();
      send_answer(sockets[1], AnswerKind::ok, name.data(), name.size());
      serve(sockets[1], frame);
    } catch (const InputError& error) {
      fail(AnswerKind::bad_input, error.what());
    } catch (const std::exception& error) {
      fail(AnswerKind::missing, error.what());
    }
    _exit(0);
  }
  close(sockets[1]);
  socket_ = sockets[0];
  if (process_ < 0) {
    stop();
    throw std::runtime_error("llvmpipe: no process for it; close some programs");
  }
  try {
    const std::vector<char> name = answer();
    name_.assign(name.begin(), name.end());
  } catch (...) {
    stop();
    throw;
  }
  has_scene_ = scene != nullptr;
}

void MesaPeer::stop() {
  if (socket_ >= 0) {
    shutdown(socket_, SHUT_RDWR);  // processes started since also hold this end
    close(socket_);
  }
  if (process_ > 0) waitpid(process_, nullptr, 0);
  socket_ = process_ = -1;
  has_scene_ = false;
}

std::vector<char> MesaPeer::answer() {
  AnswerHead head;
  if (!receive_bytes(socket_, &head, sizeof head)) throw std::runtime_error("llvmpipe: its process has ended");
  std::vector<char> bytes(head.size);
  if (!receive_bytes(socket_, bytes.data(), bytes.size())) throw std::runtime_error("llvmpipe: its process has ended");
  const std::string text(bytes.begin(), head.kind == AnswerKind::ok ? bytes.begin() : bytes.end());
  if (head.kind == AnswerKind::bad_input) throw InputError(text);
  if (head.kind == AnswerKind::missing) throw std::runtime_error(text);
  return bytes;
}

std::vector<char> MesaPeer::ask(char request) {
  if (!has_scene_) throw std::runtime_error("llvmpipe: has no scene; upload one first");
  if (!send_bytes(socket_, &request, 1)) throw std::runtime_error("llvmpipe: its process has ended");
  return answer();
}

void MesaPeer::upload(const Scene& scene) {
  stop();
  start(&scene);
}

double MesaPeer::render() {
  const std::vector<char> bytes = ask('f');
  double seconds = 0;
  std::memcpy(&seconds, bytes.data(), sizeof seconds);
  return seconds;
}

std::vector<std::uint32_t> MesaPeer::color() {
  const std::vector<char> bytes = ask('c');
  std::vector<std::uint32_t> pixels(bytes.size() / sizeof(std::uint32_t));
  std::memcpy(pixels.data(), bytes.data(), bytes.size());
  return pixels;
}

}  // namespace halfplane
