#pragma once

#include <array>
#include <string>
#include <string_view>

#include "datasets/campaign/campaign.hpp"
#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// What was judged of a fit or validation, in words.

namespace rigcal::report {

struct AspectName {
  StoredAspect StoredAssessment::*aspect;
  const char* name;
  const char* short_name;
  const char* link;  ///< id of the section with the evidence
};
inline constexpr std::array kAspects{
    AspectName{&StoredAssessment::agreement, "Agreement with the limits", "Agreement", "matrix"},
    AspectName{&StoredAssessment::validation, "Independent validation", "Validation", "matrix"},
    AspectName{&StoredAssessment::adequacy, "Adequacy of the model", "Adequacy", "conditions"},
    AspectName{&StoredAssessment::parameters, "Parameters", "Parameters", "parameters"}};

/// Id of what shows the evidence for a reason.
///
/// @param section  that of its aspect
std::string evidence_of(const StoredFit& fit, const StoredReason& reason, const char* section);

/// Whether an aspect names a reason of this code.
bool names_reason(const StoredFit& fit, StoredAspect StoredAssessment::*aspect,
                  std::string_view code);

/// The aspects that did not pass: "independent validation: not assessed".
std::string open_aspects(const StoredFit& fit);

/// What a decision rule means for who reads the verdict (ISO/IEC 17025, 7.8.6).
std::string rule_words(datasets::DecisionRule rule);

/// How well estimates are told apart; those without a number are left out.
std::string correlation_words(const StoredCorrelation& correlation);

/// Every reason of every aspect, and how the search ended.
doc::Section assessment_section(const StoredFit& fit);

}  // namespace rigcal::report
