#pragma once

#include <optional>
#include <string>

namespace rigcal::report {

/// Estimates the time that the starts of a fit still need. They run one after the other. Within a
/// start the relative change of the cost, on a logarithmic scale, shows how close it is to the
/// tolerance. It is a guess: a start may end earlier, or jump to a new valley.
class TimeLeft {
 public:
  /// @param starts     in all
  /// @param tolerance  relative change of the cost at which a start ends, below 1
  TimeLeft(int starts, double tolerance);

  /// An iteration of this start (from 1).
  void note(int start, double relative_change);

  /// Seconds left; nothing while too little is done to estimate.
  std::optional<double> seconds(double elapsed_s) const;

 private:
  int starts_;
  double tolerance_;
  int first_ = 0;  ///< the first start reported; earlier ones were resumed
  int latest_ = 0;
  double share_ = 0.0;  ///< fraction of the latest start that is done
};

/// A duration as text: "12 s", "3.5 min", "1.2 h".
std::string duration_text(double seconds);

}  // namespace rigcal::report
