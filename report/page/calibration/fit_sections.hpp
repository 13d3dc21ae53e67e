#pragma once

#include <optional>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// The sections of a fit or validation after its first page.

namespace rigcal::report {

/// Three numbers, and a small picture of measurement and model for every condition. Nothing if
/// nothing was scored.
std::optional<doc::Section> overview_section(const Calibration& stored);
/// For each channel, scores by signal and leak level, then group means.
///
/// @param unfinished  the search did not converge
doc::Section scores_section(const StoredFit& fit, bool unfinished);
/// @param judged  whether a search converged, so that estimates have grades
doc::Section parameters_section(const std::vector<StoredParameter>& parameters,
                                const calib::Correlation& correlation, bool judged);
/// What contributes to the uncertainty of each estimate; nothing where no effects were considered.
void add_budget(const std::vector<StoredParameter>& parameters, doc::Blocks& blocks);
/// One article for each condition: what it is, its scores, its plots and residual tests.
///
/// @param curves  whether plots and residual tests are drawn
doc::Section conditions_section(const Calibration& stored, int threads, bool curves);
/// Evidence on the estimates: singular values, profiles, bootstrap, lack of fit, predictions.
doc::Section identifiability_section(const StoredFit& fit);
/// Adds the singular values of the Jacobian with an explanation.
void add_singular_values(const StoredFit& fit, doc::Blocks& blocks);
/// Draws of the posterior: quantiles, diagnostics, limits, pairs; nothing where there are none.
void add_posterior(const StoredFit& fit, doc::Blocks& blocks);
/// Small effects that the model leaves out, and which of them the residuals ask for.
void add_considered(const StoredFit& fit, doc::Blocks& blocks);
/// Estimates from the validation records alone, beside those of the fit.
void add_stability(const StoredFit& fit, doc::Blocks& blocks);
doc::Section starts_section(const StoredFit& fit);
/// Failures and warnings.
doc::Section warnings_section(const StoredFit& fit);

/// Adds residual tests and curves for the channels of a condition.
void add_residual_tests(const StoredCondition& condition, const StoredChannelCurves* curves,
                        doc::Blocks& blocks);

}  // namespace rigcal::report
