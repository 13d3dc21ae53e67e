#pragma once

#include <optional>
#include <string>

namespace rigcal::report {

/// How long the starts of a fit may still take. They run one after the other; within a start the
/// relative change of the cost tells, on a logarithmic scale, how far it has come to the tolerance
/// that ends it. A guess: a start may end earlier, or jump to a new valley.
class TimeLeft {
 public:
  /// @param starts     in all
  /// @param tolerance  relative change of the cost at which a start ends, below 1
  TimeLeft(int starts, double tolerance);

  /// An iteration of this start (from 1).
  void note(int start, double relative_change);

  /// Seconds that are left; nothing while too little is done to tell.
  std::optional<double> seconds(double elapsed_s) const;

 private:
  int starts_;
  double tolerance_;
  int first_ = 0;  ///< start that was told of first: those before it were resumed
  int latest_ = 0;
  double share_ = 0.0;  ///< of the latest start that is done
};

/// "12 s", "3.5 min", "1.2 h": for people who wait.
std::string duration_text(double seconds);

}  // namespace rigcal::report
