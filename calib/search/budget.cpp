#include "calib/search/budget.hpp"

#include <algorithm>

namespace rigcal::calib {
namespace {

/// In seconds, about thirty years. A much longer time would overflow a clock that counts
/// nanoseconds.
constexpr double kWithoutEnd = 1e9;

}  // namespace

Budget::Budget(const std::atomic<bool>* cancel, Clock::time_point began,
               const std::optional<double>& max_seconds, const std::optional<long>& max_evaluations)
    : cancel_(cancel), max_evaluations_(max_evaluations) {
  if (!max_seconds || *max_seconds >= kWithoutEnd) return;
  deadline_ = began + std::chrono::duration_cast<Clock::duration>(
                          std::chrono::duration<double>(*max_seconds));
}

std::optional<long> Budget::evaluations_left() const {
  if (!max_evaluations_) return std::nullopt;
  return std::max(0L, *max_evaluations_ - evaluations_.load());
}

bool Budget::cancelled() const {
  return cancel_ != nullptr && cancel_->load(std::memory_order_relaxed);
}

std::string Budget::reason() const {
  if (cancelled()) return "stopped on request";
  if (out_of_time()) return "stopped by the time limit";
  if (out_of_evaluations()) return "stopped by the limit of evaluations";
  return {};
}

}  // namespace rigcal::calib
