#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rigcal::report {

/// Thins a series for drawing: of each bucket of `size` samples the least and the largest are kept,
/// so that no peak is lost.
struct Buckets {
  std::size_t samples = 0;
  std::size_t size = 1;  ///< 1: every sample stays

  std::size_t points() const;
};

/// The smallest buckets that leave at most about `points` points of `samples`.
Buckets buckets(std::size_t samples, std::size_t points);

/// Times of the points of a thinned series, for series with common times: the first and the middle
/// sample of each bucket.
std::vector<double> thinned_times(std::span<const double> time_s, const Buckets& buckets);

/// Times of the samples that thinned() keeps of a series, so that a line goes through measured
/// points only. A bucket without numbers gets the times of the function above.
std::vector<double> thinned_times(std::span<const double> time_s, std::span<const double> values,
                                  const Buckets& buckets);

/// Least and largest value of each bucket in the order in which they occur; NaN for a bucket
/// without numbers.
std::vector<double> thinned(std::span<const double> values, const Buckets& buckets);

/// Values at the samples that thinned() keeps of `extremes`, for columns that belong to that
/// series.
std::vector<double> thinned_where(std::span<const double> values, std::span<const double> extremes,
                                  const Buckets& buckets);

/// Values as 16-bit steps above the least one: little endian, base64; 65535 is NaN.
struct Quantised {
  double low = 0.0;
  double step = 0.0;  ///< half of it is the largest error: 1/131068 of the range
  std::string base64;
};
Quantised quantised(std::span<const double> values);

/// Values as 32-bit floats: little endian, base64.
std::string floats_base64(std::span<const double> values);
/// Values as 64-bit floats: little endian, base64.
std::string doubles_base64(std::span<const double> values);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace rigcal::report
