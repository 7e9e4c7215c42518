#include "helper_thread.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <utility>

namespace halfplane::gl {
namespace {

std::atomic<int> g_at_work = 0;         // pieces of work
std::atomic<pid_t> g_process = 0;       // that started the last one: a forked child has no threads
thread_local bool g_is_helper = false;  // its work may call exit(), as Xlib does without a server

[[gnu::destructor]] void finish_work() {
  if (g_is_helper || g_process != getpid()) return;
  for (int count = g_at_work; count != 0; count = g_at_work) g_at_work.wait(count);
}

}  // namespace

HelperThread::~HelperThread() {
  if (!thread_.joinable()) return;
  wait();
  work_ = nullptr;
  begun_.release();
  thread_.join();
}

void HelperThread::start(std::function<void()> work) {
  wait();
  if (!thread_.joinable()) {
    // Signals are the program's: its own threads take them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  work_ = std::move(work);
  g_process = getpid();
  ++g_at_work;
  is_busy_ = true;
  begun_.release();
}

void HelperThread::wait() {
  if (std::exchange(is_busy_, false)) done_.acquire();
}

void HelperThread::run() {
  g_is_helper = true;
  for (begun_.acquire(); work_; begun_.acquire()) {
    work_();
    --g_at_work;
    g_at_work.notify_all();
    done_.release();
  }
}

}  // namespace halfplane::gl
