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

/// But for what was kept for one task and is too scattered for the next: where a fit ends and its
/// results are written, say. From now on the largest blocks, of which few are made, go back at
/// once.
inline void give_freed_memory_back() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 22;
  malloc_trim(0);
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

}  // namespace rigcal
