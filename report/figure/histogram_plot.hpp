#pragma once

#include <span>
#include <string>

#include "report/figure/svg.hpp"

namespace rigcal::report {

/// Density of the residuals beside the normal density with their mean and standard deviation. Equal
/// bins over their range, as wide as Freedman and Diaconis propose (2 IQR n^(-1/3); Probability
/// Theory 57, 1981), between 11 and 41 of them.
///
/// @param title     first words for a screen reader
/// @param residual  shape (n), SI; samples that are not finite are left out
/// @param unit      of the horizontal axis
/// @param si        one of that unit in SI
Plot histogram_plot(const std::string& title, std::span<const double> residual,
                    const std::string& unit, double si);

}  // namespace rigcal::report
