#pragma once

#include <array>
#include <vector>

#include "bench/problems.hpp"

/// The baseline with which rigcal is compared: what a careful engineer could write in an afternoon
/// with Odeint and Ceres. It simulates the six signals with Dormand-Prince 5(4), computes
/// derivatives with ceres::Jet, and solves with dense QR on all residuals.
namespace rigcal::bench::baseline {

/// Number of free parameters: mass, bulk modulus, valve gain and leakage coefficient.
inline constexpr int kFree = 4;
using Values = std::array<double, kFree>;

Values truth();

/// Returns the positions at the sample times of one signal [m].
/// @param factors  multiples of the true values
std::vector<double> simulate(const Reference& signal, const Values& factors, double tolerance);
/// Returns the positions and their derivatives with respect to the factors. The derivatives are
/// integrated together with the states, and error control covers both.
/// @return  shape (samples, 1 + kFree), row by row
std::vector<double> simulate_with_sensitivities(const Reference& signal, const Values& factors,
                                                double tolerance);

/// A reference recorded at 1 kHz. It is constant between samples, or interpolated linearly.
struct Recorded {
  std::vector<double> reference_m;
  bool linear = false;
};
/// Return the positions at the samples of a recorded reference, without and with derivatives.
std::vector<double> simulate(const Recorded& drive, const Values& factors, double tolerance);
std::vector<double> simulate_with_sensitivities(const Recorded& drive, const Values& factors,
                                                double tolerance);

struct Fit {
  Values factors;  ///< multiples of the true values
  double cost = 0.0;
  int jacobians = 0;
  int residuals = 0;
  bool converged = false;
};

/// @param measured  recorded positions for each signal [m]
Fit fit(const std::vector<std::vector<double>>& measured, double noise_sd_m, double tolerance);
/// The same with a recorded reference for each record.
Fit fit(const std::vector<Recorded>& drives, const std::vector<std::vector<double>>& measured,
        double noise_sd_m, double tolerance);

}  // namespace rigcal::bench::baseline
