#pragma once

#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Grades a value by the half-width of its 95 % interval (see describe_unknowns()).
///
/// @param arbitrary_zero  true if zero is an ordinary value in the range: for offsets, initial
///                        states, and bounds of opposite signs
Identifiability grade_of(const model::ParameterSpec& spec, double value, double half_width,
                         bool arbitrary_zero);

/// Describes the unknowns of a solved problem: values, errors, intervals, bounds and grades, with
/// reasons for poor grades.
///
/// The interval is value +- t SE, truncated at the limits beyond which the parameter has no
/// physical meaning. SE is the robust error, or the plain error if the residuals are below half of
/// the known noise or there are too few of them to estimate their correlation. A parameter is weak
/// if the half-width exceeds 20 % of the value. It is not identifiable if the half-width exceeds
/// 100 %, or if there is no standard error. If the value may be zero (leakage, friction, optional
/// terms, offsets, initial states, and bounds of opposite signs), a parameter whose interval
/// includes zero is called bounded instead: it is not significantly different from zero, and only
/// the interval is known. Grades do not depend on where the bounds are.
std::vector<FittedParameter> describe_unknowns(const Problem& problem, const Evaluation& optimum,
                                               const OptimumCheck& check,
                                               const Uncertainty& uncertainty);

/// Returns, for example, "half width of the 95 % interval is 37 % of the value".
///
/// @param fraction  half-width divided by the value
std::string half_width_words(double fraction);

/// Removes the grades after a search that was stopped before it converged. Derivatives at a point
/// that is not a minimum cannot be used to grade an estimate.
void withhold_grades(std::vector<FittedParameter>& parameters);

/// Updates grade and reason after effects that the model omits have widened the interval.
void grade_widened(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                   FittedParameter& parameter);

/// Returns true if most of a standard error is due to the uncertainty of known values rather than
/// to the records.
bool rests_on_known(const Problem& problem, const Uncertainty& uncertainty,
                    const std::vector<double>& z, std::size_t unknown);

/// Describes the known values of the campaign: settings that are not fitted, and values for leak
/// levels and conditions.
///
/// @param values  values from an earlier fit that replace those of the campaign, or null
std::vector<FittedParameter> describe_known(
    const Problem& problem, const std::vector<datasets::FittedValue>* values = nullptr);

}  // namespace rigcal::calib
