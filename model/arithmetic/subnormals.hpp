#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace rigcal::model {

/// While it lives, numbers below 2.2e-308 count as zero in this thread. A sensitivity that does
/// nothing but decay, as that to the initial state of a closed loop, gets there in seconds, and
/// processors take a hundred times longer for such numbers.
class SubnormalsAreZero {
 public:
#ifdef __SSE2__
  SubnormalsAreZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushToZero); }
  ~SubnormalsAreZero() { _mm_setcsr(before_); }
#else
  SubnormalsAreZero() = default;
#endif
  SubnormalsAreZero(const SubnormalsAreZero&) = delete;
  SubnormalsAreZero& operator=(const SubnormalsAreZero&) = delete;

#ifdef __SSE2__
 private:
  static constexpr unsigned kFlushToZero = 0x8040;  ///< results, and what they are computed from
  unsigned before_;
#endif
};

}  // namespace rigcal::model
