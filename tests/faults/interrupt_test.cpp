// Signals that ask a tool to stop, either at once or after a loop has saved its work.
#include "tools/common/process/interrupt.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "formats/atomic_file.h"

namespace bnvpl {
namespace {

using ::testing::ExitedWithCode;
using ::testing::KilledBySignal;

TEST(Interrupt, EndsTheToolAtOnceBySignal) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    const auto run = [&] {
      catchInterrupts("tool");
      std::raise(signal);
    };
    EXPECT_EXIT(run(), KilledBySignal(signal),
                "^tool: interrupted \\(SIG[A-Z]+\\); no output was touched\n$");
  }
}

// Had the handler run on the thread that gets the signal, it would have ended before the file that
// the main thread makes at that time, and the file would stay.
TEST(Interrupt, EndsOnTheMainThreadWhicheverThreadGetsTheSignal) {
  const fs::path folder =
      fs::temp_directory_path() / ("bnvpl-main-thread-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto run = [&] {
    catchInterrupts("tool");
    std::atomic<bool> blocked{false};
    std::thread other([&] {
      while (!blocked) std::this_thread::yield();
      std::raise(SIGTERM);
    });
    sigset_t terminate;
    sigemptyset(&terminate);
    sigaddset(&terminate, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &terminate, nullptr);
    blocked = true;
    other.join();
    const AtomicFile made(folder / "made");
    std::fputs("made; ", stderr);
    ::pthread_sigmask(SIG_UNBLOCK, &terminate, nullptr);
  };
  EXPECT_EXIT(run(), KilledBySignal(SIGTERM), "^made; tool: interrupted");
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(Interrupt, RemovesPartialFilesAndTellsWhatWasReplaced) {
  const fs::path folder =
      fs::temp_directory_path() / ("bnvpl-interrupt-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto run = [&] {
    catchInterrupts("tool");
    AtomicFile whole(folder / "whole");
    whole.write("whole");
    whole.commit();
    AtomicFile partial(folder / "partial");
    partial.write("half");
    std::raise(SIGTERM);
  };
  EXPECT_EXIT(run(), KilledBySignal(SIGTERM), "replaced are whole, the others untouched");
  EXPECT_TRUE(fs::exists(folder / "whole"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  fs::remove_all(folder);
}

// A loop that defers interrupts gets `signals`, saves its work and says how to go on.
template <typename Signals>
void deferred(const Signals& signals, const char* howToGoOn) {
  catchInterrupts("tool");
  try {
    const DeferInterrupts defer;
    signals();
    if (interrupted()) throw Interrupted(howToGoOn);
  } catch (const Interrupted& reason) {
    endInterrupted(reason);
  }
}

TEST(Interrupt, ALoopThatDefersMaySaveAndSayHowToGoOn) {
  const auto run = [] {
    deferred([] { std::raise(SIGINT); }, "FILE holds 3 of 8 passes; the same command continues");
  };
  EXPECT_EXIT(run(), KilledBySignal(SIGINT),
              "^tool: interrupted \\(SIGINT\\); FILE holds 3 of 8 passes; the same command "
              "continues\n$");
}

TEST(Interrupt, TheSameSignalASecondLaterDoesNotWait) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto run = [&] {
      catchInterrupts("tool");
      const DeferInterrupts defer;
      std::raise(signal);
      ::usleep(1'100'000);
      std::raise(signal);
      std::exit(0);
    };
    EXPECT_EXIT(run(), KilledBySignal(signal), "no output was touched");
  }
}

// On Ctrl-C the tool gets a SIGINT and then a SIGTERM from Make; wrappers may send more.
TEST(Interrupt, OneRequestMayComeAsSeveralSignals) {
  const auto signals = [] {
    for (const int signal : {SIGINT, SIGTERM, SIGINT, SIGHUP, SIGTERM}) std::raise(signal);
    ::usleep(1'100'000);
    std::raise(SIGXCPU);
  };
  const auto run = [&] { deferred(signals, "the work is saved"); };
  EXPECT_EXIT(run(), KilledBySignal(SIGINT), "^tool: interrupted \\(SIGINT\\); the work is saved");
}

// Linux repeats it every CPU second behind the soft limit.
TEST(Interrupt, TheLimitOfCpuTimeIsOneRequestHoweverOftenItComes) {
  const auto signals = [] {
    std::raise(SIGXCPU);
    ::usleep(1'100'000);
    std::raise(SIGXCPU);
  };
  const auto run = [&] { deferred(signals, "the work is saved"); };
  EXPECT_EXIT(run(), KilledBySignal(SIGXCPU),
              "^tool: interrupted \\(SIGXCPU\\); the work is saved");
}

TEST(Interrupt, WhatNobodyActedUponEndsTheToolAfterTheLoop) {
  const auto run = [] {
    catchInterrupts("tool");
    {
      const DeferInterrupts defer;
      std::raise(SIGTERM);
    }
    std::exit(0);
  };
  EXPECT_EXIT(run(), KilledBySignal(SIGTERM), "no output was touched");
}

TEST(Interrupt, IgnoredSignalsStayIgnored) {
  const auto run = [] {
    std::signal(SIGHUP, SIG_IGN);  // nohup does this
    catchInterrupts("tool");
    std::raise(SIGHUP);
    std::exit(0);
  };
  EXPECT_EXIT(run(), ExitedWithCode(0), "");
}

}  // namespace
}  // namespace bnvpl
