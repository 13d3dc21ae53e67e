#include "datasets/read/csv/stamp_clock.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace rigcal::datasets {
namespace {

constexpr double kDay_s = 86400.0;

std::optional<long> days_between(const std::optional<long>& from, const std::optional<long>& to) {
  return from && to ? std::optional(*to - *from) : std::nullopt;
}

}  // namespace

void StampClock::decide(const TimeStamp& stamp) {
  const auto by_day = days_between(first_->day_first, stamp.day_first);
  const auto by_month = days_between(first_->month_first, stamp.month_first);
  if (by_day == by_month) return;  // the same date still, or one that reads the same both ways
  if (!by_day || !by_month) {
    order_ = by_day ? Order::day_first : Order::month_first;
    return;
  }
  // A recording passes midnight once in a while, and seldom a month.
  const bool day_first = *by_month < 0 || (*by_day >= 0 && *by_day < *by_month);
  order_ = day_first ? Order::day_first : Order::month_first;
  doubt_ = fmt::format(
      "the dates of the time stamps may have the day or the month first; the {} is assumed to be "
      "first, so that {} days pass at the first change of the date and not {}",
      day_first ? "day" : "month", day_first ? *by_day : *by_month,
      day_first ? *by_month : *by_day);
}

std::optional<double> StampClock::seconds(const TimeStamp& stamp) {
  if (!first_) {
    first_ = stamp;
    last_s_ = stamp.time_s;
  }
  if (stamp.has_date != first_->has_date) return std::nullopt;
  if (!stamp.has_date) {
    if (stamp.time_s < last_s_ - 0.5 * kDay_s) ++midnights_;
    last_s_ = stamp.time_s;
    return kDay_s * static_cast<double>(midnights_) + (stamp.time_s - first_->time_s);
  }
  if (order_ == Order::unknown) decide(stamp);
  auto days = order_ == Order::month_first ? days_between(first_->month_first, stamp.month_first)
                                           : days_between(first_->day_first, stamp.day_first);
  if (!days && order_ == Order::unknown)
    days = days_between(first_->month_first, stamp.month_first);
  if (!days) return std::nullopt;
  return kDay_s * static_cast<double>(*days) + (stamp.time_s - first_->time_s);
}

}  // namespace rigcal::datasets
