#pragma once

#include <optional>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// The sections of a fit or validation beneath its first page.

namespace rigcal::report {

/// Three numbers, and measurement and model of every condition as a small picture; nothing where
/// nothing was scored.
std::optional<doc::Section> overview_section(const Calibration& stored);
/// Per channel: signals by leak levels, then means by groups.
///
/// @param unfinished  the search did not come to its end
doc::Section scores_section(const StoredFit& fit, bool unfinished);
/// @param judged  whether a search came to its end, so that there are grades
doc::Section parameters_section(const std::vector<StoredParameter>& parameters,
                                const StoredCorrelation& correlation, bool judged);
/// What contributes to the uncertainty of each estimate; nothing where no effects were considered.
void add_budget(const std::vector<StoredParameter>& parameters, doc::Blocks& blocks);
/// One article for each condition: what it is, its scores, its plots and residual tests.
doc::Section conditions_section(const Calibration& stored, int threads);
/// How far the estimates can be trusted: singular values, profiles, bootstrap, lack of fit,
/// predictions.
doc::Section identifiability_section(const StoredFit& fit);
/// Its first part: singular values of the Jacobian, and what they say.
void add_singular_values(const StoredFit& fit, doc::Blocks& blocks);
/// Small effects that the model leaves out, and which of them the residuals ask for.
void add_considered(const StoredFit& fit, doc::Blocks& blocks);
/// Estimates from the validation records alone, beside those of the fit.
void add_stability(const StoredFit& fit, doc::Blocks& blocks);
doc::Section starts_section(const StoredFit& fit);
/// Failures and warnings.
doc::Section warnings_section(const StoredFit& fit);

/// What the residuals of the channels of a condition show, with the curves behind it.
void add_residual_tests(const StoredCondition& condition, const StoredChannelCurves* curves,
                        doc::Blocks& blocks);

}  // namespace rigcal::report
