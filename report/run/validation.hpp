#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "report/store/json.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// Describes, in words, doubts about using the values from an earlier fit in this campaign: the fit
/// was stopped, or known values of the rig have changed since.
std::vector<std::string> doubts_about(const EarlierFit& earlier,
                                      const datasets::Campaign& campaign);

/// Scores the `fit` and `validate` conditions with the values from an earlier fit, and warns if
/// they exceed the range covered by that fit.
///
/// @param earlier     null: the campaign's own values are used
/// @param provenance  provenance of the validation; its inputs show which records the fit has seen
/// @throws InputError  as for calib::validate()
calib::Fit validate(const datasets::Campaign& campaign,
                    const std::vector<datasets::Record>& records, const EarlierFit* earlier,
                    const Provenance& provenance, const calib::FitOptions& settings);

}  // namespace rigcal::report
