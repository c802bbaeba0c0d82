#pragma once

namespace bnvpl {

// Whose bits a run computes.
enum class Processor {
  This,  // those of the processor at hand, at its full speed
  Any    // those that every x86-64 processor computes alike
};

}  // namespace bnvpl
