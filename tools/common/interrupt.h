// Ctrl-C and its kin: what a tool does when it is asked to stop.
//
// SIGINT, SIGTERM, SIGHUP and SIGXCPU end a tool at once, wherever it is: partial files are
// removed, one line on stderr says what became of the outputs, and the signal is raised again, so
// that Make and the shell see a tool that was interrupted (exit code 128 + signal). Those that were
// ignored when the tool started (nohup) stay ignored. SIGPIPE is left alone, and SIGXFSZ ignored:
// the write then fails and is reported like that of a full disk.
//
// A loop that can save what it has done asks for time to do so:
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

// Called once, by runTool, before there is any other thread.
void catchInterrupts(const std::string& tool);

// While one lives, a signal only makes interrupted() true; the same signal again, a second later or
// more, ends the tool at once. At its end a signal that nobody acted upon has its usual effect.
class DeferInterrupts {
 public:
  DeferInterrupts();
  ~DeferInterrupts();
  DeferInterrupts(const DeferInterrupts&) = delete;
  DeferInterrupts& operator=(const DeferInterrupts&) = delete;

 private:
  int exceptions_;  // in flight at the start
};

// From any thread, and cheap: one relaxed load.
bool interrupted();

// The text ends the line "TOOL: interrupted (SIGINT); ..." and says how to go on.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What runTool does with an Interrupted: the line, and the signal that was deferred.
[[noreturn]] void endInterrupted(const Interrupted& reason);

}  // namespace bnvpl
