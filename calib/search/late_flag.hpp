#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace rigcal::calib {

/// A flag that becomes true some time after a stop flag. A search ends at the stop flag. The
/// simulations that describe its result (scores, bands, errors) end at the late flag, so that a
/// stopped result gets its scores if these take only a moment.
class LateFlag {
 public:
  /// Time that the description of a stopped result may take. Commands end within a second.
  static constexpr double kGrace_s = 0.4;

  /// @param first  stop flag, which must outlive this object; may be null
  explicit LateFlag(const std::atomic<bool>* first, double grace_s = kGrace_s);
  ~LateFlag();
  LateFlag(const LateFlag&) = delete;
  LateFlag& operator=(const LateFlag&) = delete;

  /// Returns the late flag, or null if there is no stop flag. It is the stop flag itself if there
  /// is no grace, or if the system has no thread to wait with.
  const std::atomic<bool>* flag() const { return flag_; }

 private:
  void follow(const std::atomic<bool>& first, double grace_s);

  std::atomic<bool> late_ = false;
  const std::atomic<bool>* flag_ = nullptr;
  std::mutex mutex_;
  std::condition_variable over_;
  bool done_ = false;  ///< guarded by mutex_
  std::thread waiting_;
};

/// Returns true if there is a flag and it is set.
inline bool is_raised(const std::atomic<bool>* flag) {
  return flag != nullptr && flag->load(std::memory_order_relaxed);
}

}  // namespace rigcal::calib
