#pragma once

#include <array>
#include <string>
#include <string_view>

#include "datasets/campaign/campaign.hpp"
#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// The assessment of a fit or validation in words.

namespace rigcal::report {

struct AspectName {
  calib::Aspect calib::Assessment::*aspect;
  const char* name;
  const char* short_name;
  const char* link;  ///< id of the section with the evidence
};
inline constexpr std::array kAspects{
    AspectName{&calib::Assessment::agreement, "Agreement with the limits", "Agreement", "matrix"},
    AspectName{&calib::Assessment::validation, "Independent validation", "Validation", "matrix"},
    AspectName{&calib::Assessment::adequacy, "Adequacy of the model", "Adequacy", "conditions"},
    AspectName{&calib::Assessment::parameters, "Parameters", "Parameters", "parameters"}};

/// Returns the id of the section with the evidence for a reason.
///
/// @param section  section that belongs to the aspect
std::string evidence_of(const StoredFit& fit, const calib::Reason& reason, const char* section);

/// Returns true if an aspect has a reason with this code.
bool names_reason(const StoredFit& fit, calib::Aspect calib::Assessment::*aspect,
                  std::string_view code);

/// Lists the aspects that did not pass: "independent validation: not assessed".
std::string open_aspects(const StoredFit& fit);

/// Explains a decision rule to the reader of the verdict (ISO/IEC 17025, 7.8.6).
std::string rule_words(datasets::DecisionRule rule);

/// Returns the correlation of two estimates; NaN if it is unknown.
double correlation_at(const calib::Correlation& correlation, std::size_t i, std::size_t j);

/// Returns the correlations with the keys of the campaign as names, as in "valve_gain" and
/// "leakage_coefficient (leak level 100 %)".
calib::Correlation correlation_by_key(calib::Correlation correlation,
                                      const std::vector<calib::FittedParameter>& parameters);

/// Describes how strongly the estimates are correlated. Leaves out estimates without a correlation.
std::string correlation_words(const calib::Correlation& correlation);

/// Returns the section with the reasons for every aspect and the outcome of the search.
doc::Section assessment_section(const StoredFit& fit);

}  // namespace rigcal::report
