#pragma once

#include <string>
#include <vector>

#include "metrics/frequency_response.hpp"
#include "report/figure/svg.hpp"

namespace rigcal::report {

/// Gain and phase of the record and of the model for the same drive.
struct ResponseCurves {
  std::string of;    ///< which response: "position over reference"
  std::string unit;  ///< unit of the gain; "1" if it is dimensionless
  double si_per_unit = 1.0;
  std::vector<metrics::ResponsePoint> record;
  std::vector<metrics::ResponsePoint> model;
};

/// Keeps the frequencies at which the coherence of both the record and the model is at least
/// metrics::kLeastCoherence. Both curves then have the same frequencies.
ResponseCurves coherent(const ResponseCurves& all);

/// Plots gain (logarithmic) and phase over the logarithm of the frequency. The record is drawn as
/// points with 95 % intervals, the model as points joined by a line. Phases are unwrapped beyond
/// 180 degrees, so that a curve does not jump.
Plot gain_plot(const std::string& condition, const ResponseCurves& curves);
Plot phase_plot(const std::string& condition, const ResponseCurves& curves);

/// Plots the responses of several conditions together, in the unit of the first. A line joins only
/// the points of one condition. Phases are unwrapped in the order of the frequencies of all of
/// them.
///
/// @param name  replaces the condition in the title
/// @param all   of the same signals, at least one
Plot gain_plot(const std::string& name, const std::vector<ResponseCurves>& all);
Plot phase_plot(const std::string& name, const std::vector<ResponseCurves>& all);

}  // namespace rigcal::report
