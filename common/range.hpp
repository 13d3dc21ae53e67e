#pragma once

namespace rigcal {

/// Two ends of an interval: in results, an array of two numbers.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool operator==(const Range&) const = default;
};

}  // namespace rigcal
