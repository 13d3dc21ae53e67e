#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/document/document.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/stored.hpp"

// The sections of a fit or validation after its first page.

namespace rigcal::report {

/// Returns the lowest rho2, the largest mean error and the least certain estimate.
doc::Facts three_numbers(const StoredFit& fit);
/// Returns a small picture of measurement and model over the last two periods, or over the whole
/// record of a recorded drive. Returns std::nullopt if the condition was not simulated.
std::optional<Plot> condition_picture(const Calibration& stored, std::size_t number,
                                      const std::string& channel);
/// Returns gain and phase of the rig: those of the conditions that are shown in full, together.
/// Empty if they have fewer than two frequencies.
std::vector<Figure> rig_response_figures(const Calibration& stored);
/// Adds gain and phase of the rig. Adds nothing if there are fewer than two frequencies.
void add_rig_response(const Calibration& stored, doc::Blocks& blocks);
/// Lists three key numbers and the scores for each channel by signal and leak level, those of the
/// motion with small pictures, followed by group means and the response of the rig.
///
/// @param unfinished  whether the search did not converge
doc::Section scores_section(const Calibration& stored, bool unfinished);
/// @param judged  whether a search converged, so that the estimates have grades
doc::Section parameters_section(const std::vector<calib::FittedParameter>& parameters,
                                const calib::Correlation& correlation, bool judged);
/// Adds the contributions to the uncertainty of each estimate. Adds nothing if no effects were
/// considered.
void add_budget(const std::vector<calib::FittedParameter>& parameters, doc::Blocks& blocks);
/// Adds the contributions to the uncertainty of each score of a condition. Adds nothing if they are
/// unknown.
void add_score_budgets(const calib::ConditionResult& condition, doc::Blocks& blocks);
/// Returns one article for each condition, with its description, scores, plots and residual tests.
///
/// @param curves  whether plots and residual tests are drawn
doc::Section conditions_section(const Calibration& stored, int threads, bool curves);
/// Returns the evidence for the estimates: singular values, profiles, bootstrap, lack of fit,
/// predictions.
doc::Section identifiability_section(const StoredFit& fit);
/// Adds the singular values of the Jacobian with an explanation.
void add_singular_values(const StoredFit& fit, doc::Blocks& blocks);
/// Adds a summary of the posterior draws: quantiles, diagnostics, limits, pairs. Adds nothing if
/// there are no draws.
void add_posterior(const StoredFit& fit, doc::Blocks& blocks);
/// Adds the small effects that the model leaves out, and marks those that the residuals call for.
void add_considered(const StoredFit& fit, doc::Blocks& blocks);
/// Adds the estimates from only the validation records next to those of the fit.
void add_stability(const StoredFit& fit, doc::Blocks& blocks);
doc::Section starts_section(const StoredFit& fit);
/// Returns the warnings of a fit except those that only repeat the reason of a parameter, which the
/// table of parameters shows.
std::vector<std::string> warnings_to_show(const StoredFit& fit);
/// Lists failures and warnings.
doc::Section warnings_section(const StoredFit& fit);

/// Adds residual tests and curves for the channels of a condition.
void add_residual_tests(const calib::ConditionResult& condition, const calib::ChannelCurves* curves,
                        doc::Blocks& blocks);

}  // namespace rigcal::report
