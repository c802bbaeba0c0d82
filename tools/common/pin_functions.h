#pragma once

#include "core/processor.h"

namespace bnvpl {

// The C library has sin, exp, pow and their kin twice: for processors that contract products and
// sums, with other last digits, and for those that do not. It chooses when a program starts. For
// Processor::Any this starts the program anew, as GLIBC_TUNABLES says that none contracts; it
// returns where that is said already. Called before there are other threads and files. Throws
// UsageError where the program cannot be started.
void pinFunctions(Processor processor, char** argv);

}  // namespace bnvpl
