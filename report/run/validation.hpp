#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "report/store/json.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// Doubts about the values of an earlier fit in this campaign, in words: a fit that was stopped,
/// and known values of the rig that have changed since.
std::vector<std::string> doubts_about(const EarlierFit& earlier,
                                      const datasets::Campaign& campaign);

/// Scores the `fit` and `validate` conditions with the values of an earlier fit, and warns if they
/// exceed its range.
///
/// @param earlier     null: the campaign's own values
/// @param provenance  of the validation: its inputs show which records the fit has seen
/// @throws InputError  as calib::validate()
calib::Fit validate(const datasets::Campaign& campaign,
                    const std::vector<datasets::Record>& records, const EarlierFit* earlier,
                    const Provenance& provenance, const calib::FitOptions& settings);

}  // namespace rigcal::report
