#pragma once

#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// How well a value is known by the half width of its 95 % interval, as describe_unknowns() says.
///
/// @param arbitrary_zero  zero lies within its range like any other value: offsets, initial
///                           states, bounds of both signs
Identifiability grade_of(const model::ParameterSpec& spec, double value, double half_width,
                         bool arbitrary_zero);

/// The unknowns of a solved problem as results: values, errors, intervals, bounds and how well each
/// is identified, in words where it is not.
///
/// Interval: value +- t SE, cut at the limits beyond which the parameter makes no sense; with the
/// robust error, and with the plain one where residuals are below half of what the noise is known
/// to be, or too few to tell their own correlation. Half width above 20 % of the value: weak; above
/// 100 %, or no standard error: not identifiable. Where the value may be zero (leakage, friction,
/// optional terms; offsets, initial states and bounds of both signs) an interval that holds zero
/// makes it bounded instead: it is not significantly different from zero, and the interval is what
/// is known. None of this depends on the bounds.
std::vector<FittedParameter> describe_unknowns(const Problem& problem, const Evaluation& optimum,
                                               const OptimumCheck& check,
                                               const Uncertainty& uncertainty);

/// "half width of the 95 % interval is 37 % of the value".
///
/// @param share  half width over the value
std::string half_width_words(double share);

/// Of a search that was stopped before it converged: no estimate is graded by the derivatives at a
/// point that is no minimum.
void withhold_grades(std::vector<FittedParameter>& parameters);

/// Grade and reason anew, after effects that the model leaves out have widened the interval.
void grade_widened(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                   FittedParameter& parameter);

/// Whether most of a standard error is what known values leave uncertain, not what the records do.
bool rests_on_known(const Problem& problem, const Uncertainty& uncertainty,
                    const std::vector<double>& z, std::size_t unknown);

/// What the campaign knows: its other settings, and values of leak levels and conditions.
///
/// @param values  of an earlier fit, which stand in for those of the campaign; null: none
std::vector<FittedParameter> describe_known(
    const Problem& problem, const std::vector<datasets::FittedValue>* values = nullptr);

}  // namespace rigcal::calib
