#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/describe.hpp"

namespace rigcal::calib {

/// State of one aspect of a result, or of one reason.
enum class AspectState {
  pass,
  reservation,   ///< nothing failed, but whoever signs must know about it
  fail,          ///< a limit is broken, or cannot be evaluated
  not_assessed,  ///< the data for a judgement are missing
  note,          ///< only for reasons: shown, but does not affect the state of the aspect
};
RIGCAL_NAMES(AspectState, pass, reservation, fail, not_assessed, note)

/// Returns true if a reason in this state prevents its aspect from passing.
bool is_against(AspectState state);

/// A reason, with a code for scripts, the numbers that it is based on, and a sentence for readers.
struct Reason {
  std::string code;                       ///< "limit_broken", "lack_of_fit", ...; docs/report.md
  AspectState state = AspectState::pass;  ///< state that the reason supports
  std::optional<std::string> subject;     ///< condition or parameter; absent for the whole result
  Keyed<double> numbers;                  ///< numbers that the reason is based on, by name
  std::string words;                      ///< the reason, a sentence
  RIGCAL_DESCRIBE(code, state, subject, numbers, words)
};

/// @param subject  condition or parameter; empty for the whole result
Reason reason(AspectState state, std::string code, std::string words,
              const std::string& subject = {}, Keyed<double> numbers = {});

/// One aspect of a result, with all reasons for and against it.
struct Aspect {
  AspectState state = AspectState::not_assessed;  ///< state of the most serious reason
  std::vector<Reason> reasons;                    ///< sorted, most serious first
  RIGCAL_DESCRIBE(state, reasons)
};

/// Makes an aspect whose state is that of its most serious reason, notes excluded. Reasons with the
/// same state keep their order.
Aspect aspect_of(std::vector<Reason> reasons);

/// The four aspects, each judged separately. The verdict follows from them.
struct Assessment {
  Aspect agreement;   ///< compares every scored condition with the limits of the campaign
  Aspect validation;  ///< compares conditions that were not fitted with the same limits
  Aspect adequacy;    ///< compares the model error with the noise of the records
  Aspect parameters;  ///< whether the records determine the estimates
  RIGCAL_DESCRIBE(agreement, validation, adequacy, parameters)
};

}  // namespace rigcal::calib
