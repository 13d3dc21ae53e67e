#include "apps/rigcal/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string_view>
#include <system_error>

namespace rigcal::app {
namespace {

/// Number of bytes kept from the end of a child's stderr.
constexpr std::size_t kMostKept = 16'384;
constexpr int kLookEvery_ms = 50;

/// Returns true for environment variables that a launcher sets to mark a process as one of several.
bool is_of_launcher(std::string_view variable) {
  constexpr std::array kPrefixes{"OMPI_", "PMIX_", "PMI_", "PRTE_", "MPI_"};
  return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                     [&](std::string_view prefix) { return variable.starts_with(prefix); });
}

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  int get() const { return value_; }
  void close() {
    if (value_ >= 0) ::close(value_);
    value_ = -1;
  }

 private:
  int value_;
};

report::VerbEnd not_started(const char* what) {
  report::VerbEnd end;
  end.error = fmt::format("{}: {}", what, std::generic_category().message(errno));
  return end;
}

/// Turns the forked child into the new program. In a process with several threads, only functions
/// that are safe between fork and exec may be called here.
[[noreturn]] void become(char* const* arguments, char* const* environment, int err, int null,
                         pid_t parent) {
  ::setpgid(0, 0);  // signals from the terminal go only to the parent, which passes each on once
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const bool ready = ::getppid() == parent && ::dup2(null, STDIN_FILENO) >= 0 &&
                     ::dup2(null, STDOUT_FILENO) >= 0 && ::dup2(err, STDERR_FILENO) >= 0;
  std::signal(SIGXFSZ, SIG_DFL);
  if (ready) ::execve("/proc/self/exe", arguments, environment);
  ::_exit(static_cast<int>(ExitCode::internal));
}

/// Reads until the child closes its end of the pipe.
std::string read_all(int pipe, pid_t child, const std::atomic<bool>& cancel) {
  std::string text;
  bool signalled = false;
  for (;;) {
    if (cancel && !signalled) {
      ::kill(child, SIGTERM);
      signalled = true;
    }
    pollfd look{pipe, POLLIN, 0};
    if (::poll(&look, 1, kLookEvery_ms) <= 0) continue;
    std::array<char, 4096> buffer{};
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(got));
    if (text.size() > 2 * kMostKept) text.erase(0, text.size() - kMostKept);
  }
}

/// Returns the last message from the program, without the program's name.
std::string message_of(const std::string& text) {
  constexpr std::string_view kName = "rigcal: ";
  const std::size_t at = ("\n" + text).rfind("\n" + std::string(kName));
  if (at == std::string::npos) return {};
  const std::size_t begin = at + kName.size();
  return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

report::VerbEnd run_child(const std::vector<std::string>& arguments,
                          const std::atomic<bool>& cancel) {
  const auto began = std::chrono::steady_clock::now();
  std::vector<std::string> words{"rigcal"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::vector<char*> variables;
  for (char** each = environ; *each != nullptr; ++each)
    if (!is_of_launcher(*each)) variables.push_back(*each);
  variables.push_back(nullptr);

  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return not_started("cannot create a pipe to it");
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const Descriptor null(::open("/dev/null", O_RDWR | O_CLOEXEC));
  if (null.get() < 0) return not_started("/dev/null cannot be opened");
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return not_started("cannot start a process for it");
  if (child == 0) become(argv.data(), variables.data(), in.get(), null.get(), parent);
  in.close();

  const std::string said = read_all(out.get(), child, cancel);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  report::VerbEnd end;
  end.error = message_of(said);
  if (WIFSIGNALED(status)) {
    end.error =
        fmt::format("ended by signal {}{}", WTERMSIG(status),
                    WTERMSIG(status) == SIGKILL ? ", as the system does when memory runs out" : "");
    if (WTERMSIG(status) == SIGTERM) end.code = ExitCode::stopped;
  } else if (WEXITSTATUS(status) <= static_cast<int>(ExitCode::internal)) {
    end.code = static_cast<ExitCode>(WEXITSTATUS(status));
  }
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return end;
}

}  // namespace rigcal::app
