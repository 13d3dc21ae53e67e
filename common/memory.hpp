#pragma once

#include <cstdlib>  // tells which C library

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace rigcal {

/// Memory that is freed stays with the process. The C library would give large blocks back to the
/// system, and fetching their pages anew for the results of every simulation takes a tenth of a
/// fit. All threads share one heap: with one each, what one of them has freed is of no use to the
/// others, which is 15 MB of a fit of the demo; waiting for one another cannot be measured there.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargest = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, kLargest);
  mallopt(M_ARENA_MAX, 1);
#endif
}

/// But for what was kept for one task and is too scattered for the next: where the records are
/// read, or a search has ended.
inline void give_freed_memory_back() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// From now on the largest blocks, of which few are made, go back at once: the texts of a result.
inline void give_large_blocks_back() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 22;
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

}  // namespace rigcal
