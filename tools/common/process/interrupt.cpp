#include "tools/common/process/interrupt.h"

#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <exception>

#include "formats/atomic_file.h"
#include "formats/output_folder.h"
#include "tools/common/files/standard_streams.h"

namespace bnvpl {
namespace {

struct Stop {
  int signal;
  const char* name;
};
constexpr std::array<Stop, 4> kStops{
    {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}, {SIGXCPU, "SIGXCPU"}}};

std::array<char, 64> toolName{};  // set before any handler runs, as is mainThread
pthread_t mainThread;
std::atomic<bool> deferring{false}, ending{false};
std::atomic<int> pending{0};
std::array<std::atomic<int64_t>, kStops.size()> firstNs{};  // first arrival of each signal; 0: none
constexpr int64_t kOneRequestNs = 1'000'000'000;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void sayInterrupted(int signal, const char* what) {
  ErrorLine line;
  line.add(toolName.data()).add(": interrupted (");
  for (const Stop& stop : kStops) {
    if (stop.signal == signal) line.add(stop.name);
  }
  line.add("); ").add(what);
}

// If this runs in a handler, the raised signal is delivered when the handler returns.
void end(int signal, const char* what) {
  if (ending.exchange(true)) return;
  removePartialFiles();
  removePartialFolder();
  sayInterrupted(signal, what);
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

void endAtOnce(int signal) {
  end(signal, anyOutputReplaced() ? "outputs that were replaced are whole, the others untouched"
                                  : "no output was touched");
}

// One request to stop may arrive as several signals: Ctrl-C reaches a tool and Make, which then
// sends SIGTERM. Only the same signal, kOneRequestNs or more after the first, is another request.
// The kernel repeats SIGXCPU every second, which is none.
bool isAnotherRequest(int signal) {
  if (signal == SIGXCPU) return false;
  struct timespec now {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const int64_t nowNs = int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
  for (size_t i = 0; i < kStops.size(); ++i) {
    int64_t first = 0;
    if (kStops[i].signal == signal && !firstNs[i].compare_exchange_strong(first, nowNs))
      return nowNs - first >= kOneRequestNs;
  }
  return false;
}

// The main thread makes and renames all files. Where a handler ran on another one, a file could
// appear after the handler has removed them.
extern "C" void onStop(int signal) {
  if (!::pthread_equal(::pthread_self(), mainThread)) {
    ::pthread_kill(mainThread, signal);
    return;
  }
  const int saved = errno;
  int none = 0;
  const bool another = isAnotherRequest(signal);
  if (!deferring || (!pending.compare_exchange_strong(none, signal) && another)) endAtOnce(signal);
  errno = saved;
}

}  // namespace

void catchInterrupts(const std::string& tool) {
  mainThread = ::pthread_self();
  std::strncpy(toolName.data(), tool.c_str(), toolName.size() - 1);
  std::signal(SIGXFSZ, SIG_IGN);
  struct sigaction action {};
  action.sa_handler = onStop;
  action.sa_flags = SA_RESTART;
  for (const Stop& stop : kStops) sigaddset(&action.sa_mask, stop.signal);
  for (const Stop& stop : kStops) {
    struct sigaction old {};
    ::sigaction(stop.signal, nullptr, &old);
    if (old.sa_handler != SIG_IGN) ::sigaction(stop.signal, &action, nullptr);
  }
}

DeferInterrupts::DeferInterrupts() : exceptions_(std::uncaught_exceptions()) { deferring = true; }

DeferInterrupts::~DeferInterrupts() {
  deferring = false;
  if (pending != 0 && std::uncaught_exceptions() == exceptions_) endAtOnce(pending);
}

bool interrupted() { return pending.load(std::memory_order_relaxed) != 0; }

void endInterrupted(const Interrupted& reason) {
  const int signal = pending;
  end(signal, reason.what());
  ::_exit(128 + signal);  // not reached, unless the signal is blocked
}

}  // namespace bnvpl
