#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {

/// Result of a finished command.
struct Outcome {
  int exit_code = -1;  ///< minus the signal number if a signal ended it
  std::string out;
  std::string err;
};

/// A temporary folder in which the command runs as a user would call it.
class CommandFolder {
 public:
  using Arguments = std::vector<std::string>;

  CommandFolder() { std::filesystem::create_directories(work()); }

  /// Working folder of the command.
  std::filesystem::path work() const { return root_ / "work"; }

  void write(const std::string& name, const std::string& content) const {
    root_.write("work/" + name, content);
  }
  std::string read(const std::string& name) const { return text_of(work() / name); }
  bool has(const std::string& name) const { return std::filesystem::exists(work() / name); }

  /// All files below the working folder, with relative paths.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(work())) {
      if (entry.is_regular_file()) {
        names.insert(entry.path().lexically_relative(work()).generic_string());
      }
    }
    return names;
  }

  /// @param out  where stdout goes; empty: into a file that is read back
  Outcome run(const Arguments& arguments, const std::string& out = {}) const {
    return finish(start(arguments, out));
  }

  /// Runs the command, sends `signal` once its stderr contains `sign`, and waits for the end.
  Outcome run_and_signal(const Arguments& arguments, const std::string& sign, int signal) const {
    return signalled(arguments, signal, sign,
                     [&] { return text_of(err_file()).find(sign) != std::string::npos; });
  }

  /// Runs the command, sends `signal` once `path` is in its working folder, and waits for the end.
  Outcome run_and_signal_at(const Arguments& arguments, const std::string& path, int signal) const {
    return signalled(arguments, signal, path, [&] { return has(path); });
  }

  /// Runs the command and kills it once a file in its working folder contains `sign`. Returns how
  /// it ended; a fast command may end before it is killed.
  Outcome run_and_kill(const Arguments& arguments, const std::string& file,
                       const std::string& sign) const {
    const pid_t process = start(arguments, {});
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
      if (has(file) && read(file).find(sign) != std::string::npos) ::kill(process, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {code, text_of(out_file()), text_of(err_file())};
  }

 private:
  std::filesystem::path out_file() const { return root_ / "stdout"; }
  std::filesystem::path err_file() const { return root_ / "stderr"; }

  /// Runs the command and sends `signal` once `is_time`. A command that ends before is not
  /// signalled.
  ///
  /// @throws std::runtime_error if it runs for a minute and `awaited` does not appear
  Outcome signalled(const Arguments& arguments, int signal, const std::string& awaited,
                    const std::function<bool()>& is_time) const {
    const pid_t process = start(arguments, {});
    const auto has_ended = [&] {
      siginfo_t info{};
      return ::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
             info.si_pid == process;
    };
    constexpr int kMostTries = 6000;
    for (int tries = 0; !is_time() && !has_ended(); ++tries) {
      if (tries == kMostTries) {
        ::kill(process, SIGKILL);
        const Outcome outcome = finish(process);
        throw std::runtime_error("no '" + awaited + "' within a minute: " + outcome.err);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ::kill(process, signal);
    return finish(process);
  }

  pid_t start(const Arguments& arguments, const std::string& out) const {
    std::vector<char*> argv{const_cast<char*>("rigcal")};
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const std::string folder = work().string();
    const std::string out_path = out.empty() ? out_file().string() : out;
    const std::string err_path = err_file().string();
    const pid_t process = ::fork();
    if (process < 0) throw std::runtime_error("fork failed");
    if (process == 0) {
      const int out_fd = ::open(out_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      const int err_fd = ::open(err_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      const bool ready = out_fd >= 0 && err_fd >= 0 && ::dup2(out_fd, STDOUT_FILENO) >= 0 &&
                         ::dup2(err_fd, STDERR_FILENO) >= 0 && ::chdir(folder.c_str()) == 0;
      if (ready) ::execv(RIGCAL_BINARY, argv.data());
      ::_exit(127);
    }
    return process;
  }

  Outcome finish(pid_t process) const {
    int status = 0;
    if (::waitpid(process, &status, 0) != process) throw std::runtime_error("waitpid failed");
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {code, text_of(out_file()), text_of(err_file())};
  }

  TemporaryFolder root_;
};

}  // namespace rigcal::test
