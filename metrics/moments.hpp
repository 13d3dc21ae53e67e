#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace rigcal::metrics {

/// Type used for every sum. With its 64-bit mantissa, sums of 1e7 terms are exact to double
/// precision. With its exponent, the squares of 1e+-300 neither overflow nor vanish.
using Extended = long double;
static_assert(std::numeric_limits<Extended>::digits >= 64 &&
                  std::numeric_limits<Extended>::max_exponent >= 16384,
              "the metrics require a long double that is wider than double");

constexpr Extended wide(double value) { return static_cast<Extended>(value); }

/// Mean of term(i) for i in [0, n), n >= 1. Summed in blocks, so that the error grows with the size
/// and the number of blocks, not with n.
template <class Term>
Extended mean_of(std::size_t n, Term term) {
  constexpr std::size_t kBlock = 1024;
  Extended total = 0.0L;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t end = std::min(n, begin + kBlock);
    Extended partial = 0.0L;
    for (std::size_t i = begin; i < end; ++i) partial += term(i);
    total += partial;
  }
  return total / static_cast<Extended>(n);
}

template <class Value>
constexpr Value square(Value value) {
  return value * value;
}

/// Smallest and largest value of a signal.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool constant() const { return low == high; }  ///< whatever the offset
  Extended peak_to_peak() const { return wide(high) - wide(low); }
};

/// Finds the range of a signal of shape (n).
///
/// @param function, name  names of the caller and of the signal, for the message
/// @throws std::invalid_argument  if n < 2, or if a value is not finite; the message says which
Range finite_range(std::span<const double> signal, std::string_view function,
                   std::string_view name);

/// Checks that at least two times are finite and increase.
///
/// @throws std::invalid_argument  if they do not
void require_increasing(std::span<const double> time_s, std::string_view function);

/// Converts the result of `function` to a double.
///
/// @throws std::domain_error  if it exceeds the largest double
double to_double(Extended value, std::string_view function);

/// A signal minus its mean. Even for offsets of 1e9, it is exact to the rounding of the deviation,
/// because the first sample is subtracted before the mean is computed.
class Centred {
 public:
  /// @param signal  shape (n), n >= 1, finite; must outlive this object
  explicit Centred(std::span<const double> signal)
      : signal_(signal), mean_(mean_of(signal.size(), [this](auto i) { return from_first(i); })) {}

  /// signal[i] - signal[0]
  Extended from_first(std::size_t i) const { return wide(signal_[i]) - first_; }
  /// mean of from_first
  Extended mean_from_first() const { return mean_; }
  /// signal[i] - mean
  Extended operator[](std::size_t i) const { return from_first(i) - mean_; }
  /// Population variance (divided by n).
  Extended variance() const {
    return mean_of(signal_.size(), [this](auto i) { return square((*this)[i]); });
  }

 private:
  std::span<const double> signal_;
  Extended first_ = wide(signal_.front());
  Extended mean_ = 0.0L;
};

}  // namespace rigcal::metrics
