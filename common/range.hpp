#pragma once

namespace rigcal {

/// An interval. In results, it is an array of two numbers.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool operator==(const Range&) const = default;
};

}  // namespace rigcal
