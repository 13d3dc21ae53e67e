#include "calib/result/fit_result.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::calib {

bool Fit::has_converged() const {
  return status == FitStatus::converged ||
         (status == FitStatus::stopped && stopped_in && stopped_in != StoppedIn::starts);
}

bool Fit::usable() const {
  return status == FitStatus::converged &&
         std::all_of(parameters.begin(), parameters.end(),
                     [](const FittedParameter& each) { return std::isfinite(each.value); });
}

}  // namespace rigcal::calib
