#pragma once

#include "report/store/json.hpp"

namespace rigcal::report {

/// What fit.json says of how far a fit can be trusted, beside the errors of its parameters: noise
/// and model error, information criteria, which interval to believe. Adds keys.
void add_trust(const calib::Fit& fit, Json& json);

/// Bootstrap and profile of a parameter, where they were asked for. Adds keys.
void add_intervals(const calib::FittedParameter& parameter, Json& json);

}  // namespace rigcal::report
