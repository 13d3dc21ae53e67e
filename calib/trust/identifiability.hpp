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
/// @param arbitrary_zero  true if zero is an ordinary value in the range: offsets, initial states,
///                        bounds of both signs
Identifiability grade_of(const model::ParameterSpec& spec, double value, double half_width,
                         bool arbitrary_zero);

/// Describes the unknowns of a solved problem: values, errors, intervals, bounds and grades, with
/// reasons for poor grades.
///
/// The interval is value +- t SE, truncated at the limits beyond which the parameter makes no
/// sense. SE is the robust error. It is the plain error if the residuals are below half of the
/// known noise, or if there are too few residuals to estimate their correlation. A half-width above
/// 20 % of the value means weak. Above 100 %, or without a standard error, the parameter is not
/// identifiable. If the value may be zero (leakage, friction, optional terms; offsets, initial
/// states and bounds of both signs), an interval that includes zero makes the parameter bounded
/// instead: it is not significantly different from zero, and only the interval is known. None of
/// this depends on the bounds.
std::vector<FittedParameter> describe_unknowns(const Problem& problem, const Evaluation& optimum,
                                               const OptimumCheck& check,
                                               const Uncertainty& uncertainty);

/// Returns, for example, "half width of the 95 % interval is 37 % of the value".
///
/// @param share  half-width divided by the value
std::string half_width_words(double share);

/// Removes the grades after a search that was stopped before it converged. Derivatives at a point
/// that is not a minimum cannot be used to grade an estimate.
void withhold_grades(std::vector<FittedParameter>& parameters);

/// Updates grade and reason after effects that the model leaves out have widened the interval.
void grade_widened(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                   FittedParameter& parameter);

/// Returns true if most of a standard error comes from the uncertainty of known values, not from
/// the records.
bool rests_on_known(const Problem& problem, const Uncertainty& uncertainty,
                    const std::vector<double>& z, std::size_t unknown);

/// Describes the known values of the campaign: its other settings, and values for leak levels and
/// conditions.
///
/// @param values  values from an earlier fit, which replace those of the campaign; null if there
///                are none
std::vector<FittedParameter> describe_known(
    const Problem& problem, const std::vector<datasets::FittedValue>* values = nullptr);

}  // namespace rigcal::calib
