#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace rigcal::app {

/// Tells on stderr how far a long fit is: one line that is rewritten on a terminal, a plain line
/// about every second elsewhere. Silent for the first second.
class Progress {
 public:
  /// @param work  what is told of: "start {} of 3"; braces stand for the number of the start
  Progress(bool quiet, std::string work);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// May be called from any thread.
  void operator()(int start, int iteration, double cost, double relative_change, double seconds);

 private:
  using Clock = std::chrono::steady_clock;

  std::mutex mutex_;
  bool quiet_;
  bool terminal_;
  std::string work_;
  bool line_is_open_ = false;
  Clock::time_point last_shown_ = Clock::now();
};

}  // namespace rigcal::app
