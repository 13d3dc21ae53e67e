// Preloaded into rigcal by tests/reliability/environment.py. The wall clock jumps by hours,
// forwards and backwards, each time it is read. Monotonic clocks are not affected.

#include <dlfcn.h>
#include <sys/time.h>

#include <atomic>
#include <ctime>

namespace {

constexpr long kJump_s = 5 * 3600;

/// Present error of the clock in seconds.
long jump_s() {
  static std::atomic<int> reads{0};
  constexpr long kJumps[]{0, kJump_s, -kJump_s, 20 * kJump_s};
  return kJumps[reads++ % 4];
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, struct timespec* now) {
  static const auto real = next<int(clockid_t, struct timespec*)>("clock_gettime");
  const int result = real(clock, now);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
    now->tv_sec += jump_s();
  return result;
}

int gettimeofday(struct timeval* now, void* zone) {
  static const auto real = next<int(struct timeval*, void*)>("gettimeofday");
  const int result = real(now, zone);
  if (result == 0) now->tv_sec += jump_s();
  return result;
}

std::time_t time(std::time_t* now) {
  struct timeval moment {};
  gettimeofday(&moment, nullptr);
  if (now != nullptr) *now = moment.tv_sec;
  return moment.tv_sec;
}

}  // extern "C"
