#pragma once

namespace rigcal::report {

struct Range {
  double low = 0.0;
  double high = 0.0;
  bool operator==(const Range&) const = default;
};

}  // namespace rigcal::report
