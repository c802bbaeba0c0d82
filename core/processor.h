#pragma once

namespace bnvpl {

// Which processors must compute the same bits.
enum class Processor {
  This,  // this one only, at its full speed
  Any    // all x86-64 processors
};

}  // namespace bnvpl
