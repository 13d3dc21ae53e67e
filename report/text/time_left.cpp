#include "report/text/time_left.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigcal::report {
namespace {

constexpr double kLeastShare = 0.05;  ///< fraction of the work needed for a first estimate
constexpr double kMostOfStart = 0.95;

}  // namespace

TimeLeft::TimeLeft(int starts, double tolerance) : starts_(starts), tolerance_(tolerance) {}

void TimeLeft::note(int start, double relative_change) {
  if (first_ == 0) first_ = start;
  if (start > latest_) {
    latest_ = start;
    starts_ = std::max(starts_, start);  // there may be more starts than planned
    share_ = 0.0;
  }
  const double change = std::abs(relative_change);
  // The first iteration of a start has no previous cost, so there is no change yet.
  if (!(change > 0.0) || !std::isfinite(change)) return;
  const double share = std::log(std::min(1.0, change)) / std::log(tolerance_);
  share_ = std::max(share_, std::min(share, kMostOfStart));
}

std::optional<double> TimeLeft::seconds(double elapsed_s) const {
  if (first_ == 0) return std::nullopt;
  const double all = std::max(1, starts_ - first_ + 1);
  const double done = (latest_ - first_ + share_) / all;
  if (done < kLeastShare) return std::nullopt;
  return elapsed_s * std::max(0.0, 1.0 - done) / done;
}

std::string duration_text(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 99.5 * 60.0) return fmt::format("{:.3g} min", seconds / 60.0);
  return fmt::format("{:.3g} h", seconds / 3600.0);
}

}  // namespace rigcal::report
