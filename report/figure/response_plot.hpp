#pragma once

#include <string>
#include <vector>

#include "metrics/frequency_response.hpp"
#include "report/figure/svg.hpp"

namespace rigcal::report {

/// Gain and phase of record and model against the same drive.
struct ResponseCurves {
  std::string of;    ///< "position over reference"
  std::string unit;  ///< unit of the gain; "1" without one
  double si_per_unit = 1.0;
  std::vector<metrics::ResponsePoint> record;
  std::vector<metrics::ResponsePoint> model;
};

/// The points of both at which the coherence of both is at least metrics::kLeastCoherence: the same
/// frequencies in both.
ResponseCurves coherent(const ResponseCurves& all);

/// Gain (logarithmic) and phase over the logarithm of the frequency: the record as points with its
/// 95 % intervals, the model as points joined by a line. Phases continue beyond 180 degrees like
/// their neighbours, so that a curve does not jump.
Plot gain_plot(const std::string& condition, const ResponseCurves& curves);
Plot phase_plot(const std::string& condition, const ResponseCurves& curves);

}  // namespace rigcal::report
