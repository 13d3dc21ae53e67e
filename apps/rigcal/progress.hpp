#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "calib/fit.hpp"
#include "report/text/time_left.hpp"

namespace rigcal::app {

/// A line on stderr that shows the progress of long work. On a terminal it is overwritten in place;
/// otherwise a plain line is printed about once a second. Nothing is shown during the first second.
/// Not thread-safe.
class StatusLine {
 public:
  explicit StatusLine(bool quiet);
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  ~StatusLine();

  /// Shows a text if it is time for an update.
  ///
  /// @param text  called only in that case, with the seconds since the start
  void show(const std::function<std::string(double)>& text);

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  bool is_open_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_shown_ = begin_;
};

class FitProgress {
 public:
  /// @param work      name of the work, such as "start {} of 3"; the braces are replaced by the
  ///                  number of the start
  /// @param settings  options of the fit; its starts, tolerance and time limit are used
  FitProgress(bool quiet, std::string work, const calib::FitOptions& settings);

  /// May be called from any thread. `seconds` is the duration of one solver call and is not shown.
  void operator()(int start, int iteration, double cost, double relative_change, double seconds);

 private:
  std::mutex mutex_;
  StatusLine line_;
  std::string work_;
  report::TimeLeft left_;
  std::optional<double> max_seconds_;
};

/// Shows how many tasks of the same kind are done.
class CountProgress {
 public:
  /// @param pieces  name for the tasks, such as "records"
  CountProgress(bool quiet, std::string pieces);

  /// May be called from any thread.
  void operator()(int done, int all);

 private:
  std::mutex mutex_;
  StatusLine line_;
  std::string pieces_;
};

/// Shows the progress of the bootstrap, then of the profiles, then of cross-validation.
class BesideProgress {
 public:
  explicit BesideProgress(bool quiet) : quiet_(quiet) {}

  /// May be called from any thread.
  void operator()(const char* pieces, int done, int all);

 private:
  std::mutex mutex_;
  bool quiet_;
  std::string pieces_;
  std::optional<CountProgress> line_;
};

}  // namespace rigcal::app
