#pragma once

#include "core/processor.h"

namespace bnvpl {

// The C library has two variants of sin, exp, pow and similar functions, with and without fused
// multiply-add, which differ in the last digits. It selects one when a program starts. For
// Processor::Any this function restarts the program with GLIBC_TUNABLES set to the variant without,
// and returns if they are set already. Call it before other threads and files exist. Throws
// UsageError if the program cannot be restarted.
void pinFunctions(Processor processor, char** argv);

}  // namespace bnvpl
