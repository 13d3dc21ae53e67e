#pragma once

#include <cstdlib>  // tells which C library

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace rigcal {

/// Memory that is freed stays with the process. The C library would give large blocks back to the
/// system, and fetching their pages anew for the results of every simulation takes a tenth of a
/// fit.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargest = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, kLargest);
#endif
}

}  // namespace rigcal
