#include "metrics/allowed_rms.hpp"

#include <cmath>

#include "metrics/moments.hpp"

namespace rigcal::metrics {

double allowed_rms(std::span<const double> measured, double rho2_limit) {
  if (measured.size() < 2 || !(rho2_limit < 1.0)) return 0.0;
  finite_range(measured, "allowed_rms", "measured");
  return to_double(std::sqrt((1.0L - wide(rho2_limit)) * Centred(measured).variance()),
                   "allowed_rms");
}

}  // namespace rigcal::metrics
