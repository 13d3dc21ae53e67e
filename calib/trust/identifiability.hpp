#pragma once

#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Grades a value by the half width of its 95 % interval (see describe_unknowns()).
///
/// @param arbitrary_zero  zero is a value like any other in its range: offsets, initial states,
///                        bounds of both signs
Identifiability grade_of(const model::ParameterSpec& spec, double value, double half_width,
                         bool arbitrary_zero);

/// Describes the unknowns of a solved problem: values, errors, intervals, bounds and grades, with
/// reasons where a grade is poor.
///
/// The interval is value +- t SE, cut at the limits beyond which the parameter makes no sense. SE
/// is the robust error; it is the plain one if the residuals are below half of the known noise, or
/// too few to show their own correlation. A half width above 20 % of the value is weak; above 100
/// %, or without standard error, the parameter is not identifiable. If the value may be zero
/// (leakage, friction, optional terms; offsets, initial states and bounds of both signs), an
/// interval that includes zero makes it bounded instead: it is not significantly different from
/// zero, and only the interval is known. None of this depends on the bounds.
std::vector<FittedParameter> describe_unknowns(const Problem& problem, const Evaluation& optimum,
                                               const OptimumCheck& check,
                                               const Uncertainty& uncertainty);

/// Returns, for example, "half width of the 95 % interval is 37 % of the value".
///
/// @param share  half width divided by value
std::string half_width_words(double share);

/// Removes the grades after a search that was stopped before it converged: the derivatives at a
/// point that is no minimum cannot grade an estimate.
void withhold_grades(std::vector<FittedParameter>& parameters);

/// Grade and reason anew, after effects that the model leaves out have widened the interval.
void grade_widened(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                   FittedParameter& parameter);

/// Whether most of a standard error is what known values leave uncertain, not what the records do.
bool rests_on_known(const Problem& problem, const Uncertainty& uncertainty,
                    const std::vector<double>& z, std::size_t unknown);

/// Known values of the campaign: its other settings, and values of leak levels and conditions.
///
/// @param values  of an earlier fit, which replace those of the campaign; null: none
std::vector<FittedParameter> describe_known(
    const Problem& problem, const std::vector<datasets::FittedValue>* values = nullptr);

}  // namespace rigcal::calib
