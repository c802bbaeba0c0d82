#pragma once

#include <string>

#include "core/processor.h"

namespace bnvpl {

// A hash of results that processors may round differently, as 16 hexadecimal digits: the bits of
// ray hits and of elementary functions. Embree and the C library select code by the instructions
// that the processor has, and Embree uses its approximate reciprocals. Processors with one id give
// the same bytes. With Processor::Any all have one id, unless their libraries differ. Takes 2 ms.
// Throws std::bad_alloc.
std::string processorId(Processor processor);

}  // namespace bnvpl
