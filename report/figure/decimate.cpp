#include "report/figure/decimate.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace rigcal::report {
namespace {

constexpr std::uint16_t kNothing = 65535;
constexpr double kSteps = 65534.0;

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
  }
  return text;
}

std::size_t Buckets::points() const {
  return size == 1 ? samples : 2 * ((samples + size - 1) / size);
}

Buckets buckets(std::size_t samples, std::size_t points) {
  if (samples <= points) return {samples, 1};
  const std::size_t most = std::max<std::size_t>(1, points / 2);
  return {samples, std::max<std::size_t>(2, (samples + most - 1) / most)};
}

std::vector<double> thinned_times(std::span<const double> time_s, const Buckets& buckets) {
  if (buckets.size == 1) return {time_s.begin(), time_s.end()};
  std::vector<double> result;
  result.reserve(buckets.points());
  for (std::size_t begin = 0; begin < time_s.size(); begin += buckets.size) {
    const std::size_t count = std::min(buckets.size, time_s.size() - begin);
    result.push_back(time_s[begin]);
    result.push_back(count > 1 ? time_s[begin + count / 2] : time_s[begin]);
  }
  return result;
}

std::vector<double> thinned_where(std::span<const double> values, std::span<const double> extremes,
                                  const Buckets& buckets) {
  if (buckets.size == 1) return {values.begin(), values.end()};
  std::vector<double> result;
  result.reserve(buckets.points());
  for (std::size_t begin = 0; begin < extremes.size(); begin += buckets.size) {
    const std::size_t end = std::min(begin + buckets.size, extremes.size());
    std::size_t least = end;
    std::size_t largest = end;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isnan(extremes[i])) continue;
      if (least == end || extremes[i] < extremes[least]) least = i;
      if (largest == end || extremes[i] > extremes[largest]) largest = i;
    }
    const bool empty = least == end;
    for (const std::size_t i : {std::min(least, largest), std::max(least, largest)})
      result.push_back(empty ? std::numeric_limits<double>::quiet_NaN() : values[i]);
  }
  return result;
}

std::vector<double> thinned_times(std::span<const double> time_s, std::span<const double> values,
                                  const Buckets& buckets) {
  std::vector<double> result = thinned_where(time_s, values, buckets);
  const std::vector<double> shared = thinned_times(time_s, buckets);
  for (std::size_t i = 0; i < result.size(); ++i)
    if (std::isnan(result[i])) result[i] = shared[i];
  return result;
}

std::vector<double> thinned(std::span<const double> values, const Buckets& buckets) {
  return thinned_where(values, values, buckets);
}

Bars column_bars(std::span<const double> values, std::size_t columns) {
  Bars bars;
  const double width = static_cast<double>(values.size()) / static_cast<double>(columns);
  for (std::size_t i = 0; i < columns; ++i) {
    const std::size_t begin = i * values.size() / columns;
    const std::size_t end = std::max(begin + 1, (i + 1) * values.size() / columns);
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t j = begin; j < std::min(end, values.size()); ++j) {
      if (!std::isfinite(values[j])) continue;
      low = std::min(low, values[j]);
      high = std::max(high, values[j]);
    }
    if (!(low <= high)) continue;
    const double middle = (static_cast<double>(i) + 0.5) * width;
    bars.x.insert(bars.x.end(), {middle, middle, middle});
    bars.y.insert(bars.y.end(), {low, high, std::numeric_limits<double>::quiet_NaN()});
  }
  return bars;
}

Quantised quantised(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  Quantised result;
  if (low <= high) {
    result.low = low;
    // Divided separately, because the difference between two doubles can overflow.
    result.step = high / kSteps - low / kSteps;
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  for (const double value : values) {
    std::uint16_t code = kNothing;
    if (std::isfinite(value)) {
      const double steps = result.step > 0.0 ? (value - low) / result.step : 0.0;
      code = static_cast<std::uint16_t>(std::clamp(std::round(steps), 0.0, kSteps));
    }
    bytes.push_back(static_cast<std::uint8_t>(code & 255U));
    bytes.push_back(static_cast<std::uint8_t>(code >> 8U));
  }
  result.base64 = base64(bytes);
  return result;
}

std::string floats_base64(std::span<const double> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * values.size());
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (const unsigned shift : {0U, 8U, 16U, 24U})
      bytes.push_back(static_cast<std::uint8_t>(bits >> shift & 255U));
  }
  return base64(bytes);
}

std::string doubles_base64(std::span<const double> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(8 * values.size());
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned shift = 0; shift < 64; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>(bits >> shift & 255U));
  }
  return base64(bytes);
}

}  // namespace rigcal::report
