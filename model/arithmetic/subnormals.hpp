#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace rigcal::model {

/// Makes this thread treat numbers below 2.2e-308 as zero during the lifetime of the object. A
/// sensitivity that only decays, such as the one to the initial state of a closed loop, gets that
/// small within seconds, and processors are a hundred times slower with such numbers.
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
  static constexpr unsigned kFlushToZero = 0x8040;  ///< flushes results and operands
  unsigned before_;
#endif
};

}  // namespace rigcal::model
