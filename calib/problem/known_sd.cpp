#include "calib/problem/known_sd.hpp"

#include <cmath>
#include <limits>

namespace rigcal::calib {

double known_sd(const datasets::Campaign& campaign, datasets::Channel channel,
                const datasets::Series& series) {
  if (std::isfinite(series.sd_of_mean) && series.sd_of_mean > 0.0) return series.sd_of_mean;
  const auto sd = campaign.channels.at(channel).sd;
  return sd && *sd > 0.0 ? *sd : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace rigcal::calib
