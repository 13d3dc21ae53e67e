#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

namespace rigcal::calib {

/// Budget for a whole job, that is, the search and everything that follows it. All threads of the
/// job share it.
class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  /// Creates a budget without limits, which ends only on request.
  explicit Budget(const std::atomic<bool>* cancel = nullptr) : cancel_(cancel) {}
  /// @param cancel           becomes true to end the job; may be null
  /// @param max_seconds      time limit, counted from `began`; ignored if it exceeds the range of
  ///                         the clock
  /// @param max_evaluations  limit on evaluations of all residuals
  Budget(const std::atomic<bool>* cancel, Clock::time_point began,
         const std::optional<double>& max_seconds, const std::optional<long>& max_evaluations);

  /// Returns a budget for a part of the job whose evaluations are only counted when it ends. The
  /// part has the same deadline, but no limit on evaluations.
  Budget part() const { return Budget(cancel_, deadline_); }

  const std::atomic<bool>* cancel() const { return cancel_; }
  const std::optional<Clock::time_point>& deadline() const { return deadline_; }

  void count(long evaluations) { evaluations_ += evaluations; }
  /// Returns the remaining evaluations, or std::nullopt if there is no limit.
  std::optional<long> evaluations_left() const;

  bool cancelled() const;
  bool out_of_time() const { return deadline_ && Clock::now() >= *deadline_; }
  /// Returns true if the clock or the user requires the job to end now. From then on simulations
  /// end early, so that results may be wrong and must be discarded.
  bool interrupted() const { return cancelled() || out_of_time(); }
  bool out_of_evaluations() const {
    return max_evaluations_ && evaluations_.load() >= *max_evaluations_;
  }
  /// Returns true if no further work may begin.
  bool spent() const { return interrupted() || out_of_evaluations(); }
  /// Explains why the budget is spent: "stopped on request", "stopped by the time limit", ...
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
