#pragma once

#include <string>

#include "core/processor.h"

namespace bnvpl {

// What a processor rounds its own way, as 16 hexadecimal digits: the bits of ray hits and of
// elementary functions. Embree takes other code where there are other instructions, and estimates
// reciprocals as the processor does; so does the C library with its functions. Two processors of
// one id give the same bytes. With Processor::Any all have one id, unless they run other libraries.
// Takes 2 ms. Throws std::bad_alloc.
std::string processorId(Processor processor);

}  // namespace bnvpl
