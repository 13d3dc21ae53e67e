#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

namespace rigcal::calib {

/// Budget of a whole job: the search and everything in addition to it. Its threads share it.
class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  /// Without limits, but for a request.
  explicit Budget(const std::atomic<bool>* cancel = nullptr) : cancel_(cancel) {}
  /// @param cancel           ends the job when it becomes true; may be null
  /// @param max_seconds      from `began`; longer than a clock can count means no limit
  /// @param max_evaluations  of all residuals
  Budget(const std::atomic<bool>* cancel, Clock::time_point began,
         const std::optional<double>& max_seconds, const std::optional<long>& max_evaluations);

  /// Budget of a part of the job whose evaluations are counted at its end: the same deadline, any
  /// number of evaluations.
  Budget part() const { return Budget(cancel_, deadline_); }

  const std::atomic<bool>* cancel() const { return cancel_; }
  const std::optional<Clock::time_point>& deadline() const { return deadline_; }

  void count(long evaluations) { evaluations_ += evaluations; }
  /// Evaluations that are left; none without a limit.
  std::optional<long> evaluations_left() const;

  bool cancelled() const;
  bool out_of_time() const { return deadline_ && Clock::now() >= *deadline_; }
  bool out_of_evaluations() const {
    return max_evaluations_ && evaluations_.load() >= *max_evaluations_;
  }
  /// Whether no further work may begin.
  bool spent() const { return cancelled() || out_of_time() || out_of_evaluations(); }
  /// What has spent it: "stopped on request", "stopped by the time limit", ...
  std::string reason() const;

 private:
  Budget(const std::atomic<bool>* cancel, const std::optional<Clock::time_point>& deadline)
      : cancel_(cancel), deadline_(deadline) {}

  const std::atomic<bool>* cancel_;
  std::optional<Clock::time_point> deadline_;
  std::optional<long> max_evaluations_;
  std::atomic<long> evaluations_ = 0;
};

}  // namespace rigcal::calib
