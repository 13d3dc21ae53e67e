#pragma once

#include <optional>
#include <string>

namespace rigcal::report {

/// Estimates the remaining time for the starts of a fit, which run one after the other. The
/// progress within a start follows from the relative change of the cost, compared with the
/// tolerance on a logarithmic scale. The estimate is rough, since a start may end earlier or move
/// to a new valley.
class TimeLeft {
 public:
  /// @param starts     total number of starts
  /// @param tolerance  relative change of the cost at which a start ends, below 1
  TimeLeft(int starts, double tolerance);

  /// Records an iteration of a start; starts are numbered from 1.
  void note(int start, double relative_change);

  /// Returns the remaining seconds; std::nullopt while too little work is done for an estimate.
  std::optional<double> seconds(double elapsed_s) const;

 private:
  int starts_;
  double tolerance_;
  int first_ = 0;  ///< the first start reported; earlier ones were resumed
  int latest_ = 0;
  double share_ = 0.0;  ///< completed fraction of the latest start
};

/// Writes a duration as text: "12 s", "3.5 min", "1.2 h".
std::string duration_text(double seconds);

}  // namespace rigcal::report
