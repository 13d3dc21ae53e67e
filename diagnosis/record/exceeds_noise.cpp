#include "diagnosis/record/exceeds_noise.hpp"

#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {

bool exceeds_noise(double variance, double noise_variance, double freedom) {
  constexpr double kUpperQuartile = 0.25;  // as in calib/trust/between_repeats.cpp
  if (!(variance > noise_variance)) return false;
  if (!(noise_variance > 0.0)) return true;
  return metrics::chi_squared_exceedance(freedom * variance / noise_variance, freedom) <
         kUpperQuartile;
}

}  // namespace rigcal::diagnosis
