// Signals that ask a tool to stop, such as Ctrl-C.
//
// SIGINT, SIGTERM, SIGHUP and SIGXCPU end a tool at once: partial files are removed, one line on
// stderr tells the state of the outputs, and the signal is raised again, so that Make and the shell
// see an interrupted tool (exit code 128 + signal). Signals that were ignored when the tool started
// (nohup) stay ignored. SIGPIPE keeps its default action. SIGXFSZ is ignored: the write fails and
// is reported as on a full disk.
//
// A loop that can save its progress defers interrupts:
//
//   DeferInterrupts defer;
//   while (more) {
//     if (interrupted()) {
//       save();
//       throw Interrupted("FILE holds 3 of 8 passes; the same command continues");
//     }
//     work();
//   }
#pragma once

#include <stdexcept>
#include <string>

namespace bnvpl {

// Installs the handlers. Called once, by runTool, before any other thread exists. The calling
// thread is the one that ends the tool, whichever thread gets a signal.
void catchInterrupts(const std::string& tool);

// While an instance exists, a signal only makes interrupted() true; the same signal a second or
// more later ends the tool at once. Unless an exception is being thrown, the destructor gives a
// pending signal its usual effect.
class DeferInterrupts {
 public:
  DeferInterrupts();
  ~DeferInterrupts();
  DeferInterrupts(const DeferInterrupts&) = delete;
  DeferInterrupts& operator=(const DeferInterrupts&) = delete;

 private:
  int exceptions_;  // uncaught exceptions at construction
};

// May be called from any thread; costs one relaxed load.
bool interrupted();

// The text completes the line "TOOL: interrupted (SIGINT); ..." and tells how to continue.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Prints that line and raises the deferred signal; called by runTool.
[[noreturn]] void endInterrupted(const Interrupted& reason);

}  // namespace bnvpl
