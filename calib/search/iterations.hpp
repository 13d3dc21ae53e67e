#pragma once

#include <algorithm>

#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// Counts the iterations of one start. All stages of the start share one limit, and one count for
/// progress messages. Borrows the options.
class Iterations {
 public:
  /// @param start   number of the start
  /// @param before  iterations that the start has already made; they are included in the count, but
  ///                not in the limit
  explicit Iterations(const FitOptions& options, int start = 1, int before = 0)
      : options_(options), start_(start), before_(before) {}

  int most() const { return options_.max_iterations; }
  int used() const { return used_; }
  int left() const { return std::max(0, options_.max_iterations - used_); }
  int total() const { return before_ + used_; }
  void add(int iterations) { used_ += iterations; }

  /// Reports one iteration of a stage whose iterations have not been added yet.
  void tell(int iteration, double cost, double relative_change, double seconds) const {
    if (options_.progress)
      options_.progress(start_, total() + iteration, cost, relative_change, seconds);
  }

 private:
  const FitOptions& options_;
  int start_;
  int before_;
  int used_ = 0;
};

}  // namespace rigcal::calib
