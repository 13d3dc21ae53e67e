#pragma once

#include <cstdlib>  // defines __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace rigcal {

/// Keeps freed memory in the process. Otherwise the C library would return large blocks to the
/// system, and fetching their pages again for the results of every simulation takes a tenth of the
/// time of a fit. All threads share one heap. With one heap per thread, memory freed by one thread
/// would be useless to the others, which costs 15 MB in a fit of the demo. The threads do not
/// measurably wait for each other.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargest = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, kLargest);
  mallopt(M_ARENA_MAX, 1);
#endif
}

/// Returns freed memory to the system. Called after the records have been read and after a search,
/// because the freed blocks are then too fragmented for the next task.
inline void give_freed_memory_back() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// From now on, returns blocks of 4 MB and more to the system as soon as they are freed. Only the
/// texts of a result are that large.
inline void give_large_blocks_back() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 22;
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

}  // namespace rigcal
