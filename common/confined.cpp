#include "common/confined.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>

namespace rigcal {
namespace {

using Clock = std::chrono::steady_clock;

/// AddressSanitizer reserves terabytes of address space, beyond any limit.
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

void limit(decltype(RLIMIT_AS) resource, std::size_t most) {
  const rlimit both{most, most};
  ::setrlimit(resource, &both);  // fails where a lower limit is in force, which is as good
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

/// The child's part: never returns. An exception ends it here, before it could unwind a copy of the
/// parent's stack and remove the parent's files.
[[noreturn]] void work_in_child(const std::function<std::string()>& work,
                                const Confinement& confinement, std::size_t addresses, pid_t parent,
                                int out) noexcept {
  std::set_new_handler(nullptr);  // that of the parent may remove its files; `work` sees bad_alloc
  // The parent handles signals from the terminal; this process ends with it.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent ended before prctl()
  const int nothing = ::open("/dev/null", O_RDWR);
  if (nothing >= 0) {
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
  }
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::size_t>(confinement.cpu_seconds));
  if (kLimitsMemory) limit(RLIMIT_AS, addresses + confinement.bytes);
  const std::string result = work();
  ::_exit(write_all(out, result.data(), result.size()) ? 0 : 1);
}

/// Starts the child. Its end of the pipe is closed here before another child can inherit it.
pid_t start_child(const std::function<std::string()>& work, const Confinement& confinement,
                  int& from_child) {
  static std::mutex mutex;
  const std::size_t addresses = address_bytes();
  const std::lock_guard lock(mutex);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw ConfinedFailure(fmt::format("no process for it: {}", std::strerror(errno)));
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) work_in_child(work, confinement, addresses, parent, ends[1]);
  const int error = errno;
  ::close(ends[1]);
  from_child = ends[0];
  if (child > 0) return child;
  ::close(ends[0]);
  throw ConfinedFailure(fmt::format("no process for it: {}", std::strerror(error)));
}

/// Appends all that the child writes; false if it has not finished by the deadline.
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

}  // namespace

std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement) {
  int from_child = -1;
  const pid_t child = start_child(work, confinement, from_child);
  std::string text;
  const auto deadline = Clock::now() + std::chrono::seconds(confinement.wall_seconds);
  const bool in_time = read_until(deadline, from_child, text);
  if (!in_time) ::kill(child, SIGKILL);
  ::close(from_child);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time)
    throw ConfinedFailure(fmt::format("it took more than {} s", confinement.wall_seconds));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGKILL)
    throw ConfinedFailure(fmt::format("it took more than {} s", confinement.cpu_seconds));
  throw ConfinedFailure(
      fmt::format("it crashed, or needed more than {} MB of memory", confinement.bytes >> 20));
}

}  // namespace rigcal
