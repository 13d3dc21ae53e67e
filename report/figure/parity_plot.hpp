#pragma once

#include <span>
#include <string>

#include "report/figure/svg.hpp"

namespace rigcal::report {

/// Mean and standard deviation of measured minus simulated, over the samples that have both.
struct ResidualMoments {
  std::size_t samples = 0;
  double mean = 0.0;  ///< mean of measured minus simulated
  double sd = 0.0;    ///< population standard deviation
};
ResidualMoments residual_moments(std::span<const double> measured,
                                 std::span<const double> simulated);

/// Plots simulated against measured values, with the line of equality and, dashed, the 95 % limits
/// for normal residuals: the line of equality shifted by the mean residual, and by 1.96 standard
/// deviations more to either side (Bland and Altman, Lancet 1986). Samples are drawn as grid cells
/// in three shades that depend on the number of samples in the cell. A long record therefore takes
/// no more room than a short one, and a rare sample is as visible as frequent ones.
///
/// @param title      first words for a screen reader
/// @param measured   shape (n), SI; samples that are not finite are left out
/// @param simulated  shape (n), SI
/// @param unit       unit of both axes
/// @param si         size of that unit in SI
Plot parity_plot(const std::string& title, std::span<const double> measured,
                 std::span<const double> simulated, const std::string& unit, double si);

}  // namespace rigcal::report
