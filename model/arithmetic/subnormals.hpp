#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace rigcal::model {

/// Treats numbers below 2.2e-308 as zero in this thread while it lives. A sensitivity that only
/// decays, such as that to the initial state of a closed loop, becomes so small within seconds, and
/// processors are a hundred times slower with such numbers.
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
  static constexpr unsigned kFlushToZero = 0x8040;  ///< results, and the operands of computations
  unsigned before_;
#endif
};

}  // namespace rigcal::model
