#include "metrics/noise_floor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "metrics/moments.hpp"

namespace rigcal::metrics {

NoiseFloor noise_floor(std::span<const double> measured_mean, double sd_of_mean) {
  if (!std::isfinite(sd_of_mean) || sd_of_mean < 0.0)
    throw std::invalid_argument(fmt::format(
        "noise_floor: sd_of_mean is {}, expected a finite value of at least 0", sd_of_mean));
  const Range range = finite_range(measured_mean, "noise_floor", "measured");
  if (range.constant())
    throw std::domain_error(
        fmt::format("noise_floor: the measured signal is constant (every sample is {}), expected "
                    "one that varies",
                    range.low));

  const Extended noise = square(wide(sd_of_mean));
  const Extended total = Centred(measured_mean).variance();
  const Extended truth = std::max(0.0L, total - noise);
  const Extended absolute = wide(sd_of_mean) * std::sqrt(2.0L * std::numbers::inv_pi_v<Extended>);
  return {
      .rho2 = static_cast<double>(truth / total),
      .ccc = static_cast<double>(2.0L * truth / (truth + total)),
      .absolute_error_percent = to_double(100.0L * absolute / range.peak_to_peak(), "noise_floor")};
}

}  // namespace rigcal::metrics
