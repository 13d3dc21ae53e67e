#include "calib/result/fitted_parameter.hpp"

#include <cmath>

namespace rigcal::calib {

std::string_view to_string(IntervalSource source) {
  switch (source) {
    case IntervalSource::none:
      return "none";
    case IntervalSource::standard_error:
      return "standard_error";
    case IntervalSource::robust_standard_error:
      return "robust_standard_error";
  }
  return "";
}

double undetermined_sd(const std::optional<Range>& ci95, double lower, double upper) {
  const auto [low, high] = ci95.value_or(Range{lower, upper});
  return (high - low) / std::sqrt(12.0);
}

}  // namespace rigcal::calib
