#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "report/store/json.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// What is doubtful about the values of an earlier fit in this campaign, in words: a fit that was
/// stopped, and known values of the rig that were others when it was made.
std::vector<std::string> doubts_about(const EarlierFit& earlier,
                                      const datasets::Campaign& campaign);

/// Scores the `fit` and `validate` conditions with the values of an earlier fit, and warns where
/// they are asked for more than that fit can tell.
///
/// @param earlier     null: the campaign's own values
/// @param provenance  of the validation: by its inputs a record that the fit has seen is known
/// @throws InputError  as calib::validate()
calib::Fit validate(const datasets::Campaign& campaign,
                    const std::vector<datasets::Record>& records, const EarlierFit* earlier,
                    const Provenance& provenance, const calib::FitOptions& settings);

}  // namespace rigcal::report
