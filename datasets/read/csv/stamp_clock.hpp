#pragma once

#include <optional>
#include <string>

#include "datasets/read/csv/time_stamp.hpp"

namespace rigcal::datasets {

/// Counts the seconds of the time stamps of one file, from the first on.
///
/// All dates of a file have one order of day and month. It matters from the first row on that has
/// another date than the first one, and is decided there: by a number above 12, or else as the
/// order in which less time has passed. A time of day alone passes midnight where it falls by more
/// than half a day.
class StampClock {
 public:
  bool has_begun() const { return first_.has_value(); }

  /// Returns the seconds since the first stamp; std::nullopt if the stamp has no date in the order
  /// of the file, or a date where the others have none.
  std::optional<double> seconds(const TimeStamp& stamp);

  /// Says which order was assumed, if the dates have two readings that differ; else empty.
  const std::string& doubt() const { return doubt_; }

 private:
  enum class Order { unknown, day_first, month_first };
  void decide(const TimeStamp& stamp);

  std::optional<TimeStamp> first_;
  Order order_ = Order::unknown;
  std::string doubt_;
  long midnights_ = 0;  ///< passed by times of day without a date
  double last_s_ = 0.0;
};

}  // namespace rigcal::datasets
