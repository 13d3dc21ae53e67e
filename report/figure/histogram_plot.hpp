#pragma once

#include <span>
#include <string>

#include "report/figure/svg.hpp"

namespace rigcal::report {

/// Plots the density of the residuals and the normal density with the same mean and standard
/// deviation. The bins are equal and cover the range. Their width follows Freedman and Diaconis (2
/// IQR n^(-1/3); Probability Theory 57, 1981), limited to between 11 and 41 bins.
///
/// @param title     first words for a screen reader
/// @param residual  shape (n), SI; samples that are not finite are left out
/// @param unit      unit of the horizontal axis
/// @param si        size of that unit in SI
Plot histogram_plot(const std::string& title, std::span<const double> residual,
                    const std::string& unit, double si);

}  // namespace rigcal::report
