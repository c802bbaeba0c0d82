// Whether the build has AddressSanitizer or ThreadSanitizer, whose memory and time say nothing of
// the program's.
#pragma once

namespace bnvpl {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace bnvpl
