#pragma once

namespace bnvpl {

// Exit codes of every tool, documented in docs/tools.md.
inline constexpr int kExitOk = 0;
inline constexpr int kExitInternal = 1;   // a bug in bnvpl
inline constexpr int kExitUsage = 2;      // invalid command line
inline constexpr int kExitInput = 3;      // input missing, damaged, stale or of the wrong kind
inline constexpr int kExitOutput = 4;     // output could not be written
inline constexpr int kExitDifferent = 5;  // vpl-inspect compare: the limit was exceeded
inline constexpr int kExitMemory = 6;     // not enough memory

}  // namespace bnvpl
