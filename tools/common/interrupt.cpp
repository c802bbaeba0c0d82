#include "tools/common/interrupt.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include "formats/atomic_file.h"
#include "tools/common/standard_streams.h"

namespace bnvpl {
namespace {

struct Stop {
  int signal;
  const char* name;
};
constexpr std::array<Stop, 4> kStops{
    {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}, {SIGXCPU, "SIGXCPU"}}};

std::array<char, 64> toolName{};  // what a handler needs is ready before it runs
std::atomic<bool> deferring{false}, ending{false};
std::atomic<int> pending{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void sayInterrupted(int signal, const char* what) {
  ErrorLine line;
  line.add(toolName.data()).add(": interrupted (");
  for (const Stop& stop : kStops) {
    if (stop.signal == signal) line.add(stop.name);
  }
  line.add("); ").add(what);
}

// Inside the handler the signal waits until it returns.
void end(int signal, const char* what) {
  if (ending.exchange(true)) return;
  removePartialFiles();
  sayInterrupted(signal, what);
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

void endAtOnce(int signal) {
  end(signal, anyOutputReplaced() ? "outputs that were replaced are whole, the others untouched"
                                  : "no output was touched");
}

extern "C" void onStop(int signal) {
  const int saved = errno;
  int none = 0;
  if (!deferring || !pending.compare_exchange_strong(none, signal)) endAtOnce(signal);
  errno = saved;
}

}  // namespace

void catchInterrupts(const std::string& tool) {
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
