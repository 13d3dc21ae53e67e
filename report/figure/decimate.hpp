#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rigcal::report {

/// Thins a series for drawing. Of each bucket of `size` samples the minimum and the maximum are
/// kept, so that no peak is lost.
struct Buckets {
  std::size_t samples = 0;
  std::size_t size = 1;  ///< 1: every sample is kept

  std::size_t points() const;
};

/// Chooses the smallest buckets that reduce `samples` samples to about `points` points at most.
Buckets buckets(std::size_t samples, std::size_t points);

/// Returns the times of the points in a thinned series, for several series with common times: the
/// first and the middle sample of each bucket.
std::vector<double> thinned_times(std::span<const double> time_s, const Buckets& buckets);

/// Returns the times of the samples that thinned() keeps, so that a line passes only through
/// measured points. A bucket without finite values gets the first and the middle sample time.
std::vector<double> thinned_times(std::span<const double> time_s, std::span<const double> values,
                                  const Buckets& buckets);

/// Returns the minimum and maximum of each bucket in the order in which they occur; NaN for a
/// bucket without finite values.
std::vector<double> thinned(std::span<const double> values, const Buckets& buckets);

/// Returns the elements of `values` at the samples that thinned() keeps of `extremes`, for columns
/// that accompany that series.
std::vector<double> thinned_where(std::span<const double> values, std::span<const double> extremes,
                                  const Buckets& buckets);

/// Vertical bars, one per pixel column, from the smallest to the largest value in it, so that all
/// peaks are visible and a line joins no two of them. NaN lifts the pen after each bar.
struct Bars {
  std::vector<double> x;  ///< middle of the column, in samples
  std::vector<double> y;
};
/// Returns the bars of a series. A column without finite values has none.
Bars column_bars(std::span<const double> values, std::size_t columns);

/// Values quantised to 16-bit steps above the minimum: little endian, base64; 65535 is NaN.
struct Quantised {
  double low = 0.0;
  double step = 0.0;  ///< the largest error is half a step: 1/131068 of the range
  std::string base64;
};
Quantised quantised(std::span<const double> values);

/// Encodes values as 32-bit floats: little endian, base64.
std::string floats_base64(std::span<const double> values);
/// Encodes values as 64-bit floats: little endian, base64.
std::string doubles_base64(std::span<const double> values);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace rigcal::report
