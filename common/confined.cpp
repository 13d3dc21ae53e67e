#include "common/confined.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>

namespace rigcal {
namespace {

using Clock = std::chrono::steady_clock;

/// AddressSanitizer reserves terabytes of address space, more than any limit.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLimitsMemory = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif
#else
constexpr bool kLimitsMemory = true;
#endif

/// Size of the address space of this process.
std::size_t address_bytes() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Limits a resource, but never raises a limit that is already in force.
void limit(decltype(RLIMIT_AS) resource, rlim_t soft, rlim_t hard) {
  rlimit now{};
  ::getrlimit(resource, &now);
  const rlimit least{std::min(soft, now.rlim_cur), std::min(hard, now.rlim_max)};
  ::setrlimit(resource, &least);
}

bool write_all(int descriptor, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(descriptor, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

/// Runs in the child and never returns. An exception ends the process here, before it could unwind
/// a copy of the parent's stack and remove the parent's files.
[[noreturn]] void work_in_child(const std::function<std::string()>& work,
                                const Confinement& confinement, std::size_t addresses, pid_t parent,
                                int out) noexcept {
  // The parent's handler may remove its files. Without it, `work` gets std::bad_alloc.
  std::set_new_handler(nullptr);
  // The parent handles signals from the terminal. This process ends when the parent does.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent ended before prctl()
  const int nothing = ::open("/dev/null", O_RDWR);
  if (nothing >= 0) {
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
  }
  limit(RLIMIT_CORE, 0, 0);
  const auto seconds = static_cast<rlim_t>(confinement.cpu_seconds);
  limit(RLIMIT_CPU, seconds, seconds + 2);  // SIGXCPU comes first; SIGKILL means lack of memory
  const rlim_t bytes = addresses + confinement.bytes;
  if (kLimitsMemory) limit(RLIMIT_AS, bytes, bytes);
  const std::string result = work();
  ::_exit(write_all(out, result.data(), result.size()) ? 0 : 1);
}

std::string no_process(int error) {
  return fmt::format(
      "cannot start a process to read a file in: {}; try again later, or with fewer threads",
      std::strerror(error));
}

/// Starts the child. Closes its end of the pipe before another child can inherit it.
pid_t start_child(const std::function<std::string()>& work, const Confinement& confinement,
                  int& from_child) {
  static std::mutex mutex;
  const std::size_t addresses = address_bytes();
  const std::lock_guard lock(mutex);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw NoResources(no_process(errno));
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) work_in_child(work, confinement, addresses, parent, ends[1]);
  const int error = errno;
  ::close(ends[1]);
  from_child = ends[0];
  if (child > 0) return child;
  ::close(ends[0]);
  throw NoResources(no_process(error));
}

/// Appends everything that the child writes. Returns false if it has not finished by the deadline.
bool read_until(Clock::time_point deadline, int descriptor, std::string& text) {
  std::array<char, std::size_t{1} << 16> block;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd ready{descriptor, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(left)) <= 0) continue;
    const ssize_t got = ::read(descriptor, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    text.append(block.data(), static_cast<std::size_t>(got));
  }
}

constexpr const char* kShortMemory =
    "out of memory in the process that reads a file: memory is limited (ulimit -v)";

}  // namespace

Confinement Confinement::of_file(std::uintmax_t file_bytes) {
  constexpr int kLeastSeconds = 4;
  constexpr int kSecondsPerMB = 2;
  constexpr std::uintmax_t kMostMB = 1000;
  Confinement result;
  result.cpu_seconds =
      kLeastSeconds + kSecondsPerMB * static_cast<int>(std::min(file_bytes >> 20, kMostMB));
  // On a busy machine a second of CPU time takes several seconds.
  constexpr int kWallPerCpu = 10;
  result.wall_seconds = std::max(result.wall_seconds, kWallPerCpu * result.cpu_seconds);
  return result;
}

bool Confinement::memory_is_short() const {
  rlimit now{};
  return ::getrlimit(RLIMIT_AS, &now) == 0 && now.rlim_cur != RLIM_INFINITY &&
         now.rlim_cur < address_bytes() + bytes;
}

std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement) {
  int from_child = -1;
  const pid_t child = start_child(work, confinement, from_child);
  std::string text;
  const auto deadline = Clock::now() + std::chrono::seconds(confinement.wall_seconds);
  const bool in_time = read_until(deadline, from_child, text);
  if (!in_time) ::kill(child, SIGKILL);
  ::close(from_child);
  int status = 0;
  rusage used{};
  while (::wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
  }
  if (!in_time)
    throw ConfinedFailure(fmt::format("it took more than {} s", confinement.wall_seconds));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU ||
      (signal == SIGKILL && used.ru_utime.tv_sec + used.ru_stime.tv_sec >= confinement.cpu_seconds))
    throw ConfinedFailure(fmt::format("it took more than {} s", confinement.cpu_seconds));
  if (signal == SIGKILL)
    throw NoResources(
        "the system ended the process that reads a file, as it does when memory runs out");
  if (confinement.memory_is_short()) throw NoResources(kShortMemory);
  throw ConfinedFailure(
      fmt::format("it crashed, or needed more than {} MB of memory", confinement.bytes >> 20));
}

}  // namespace rigcal
