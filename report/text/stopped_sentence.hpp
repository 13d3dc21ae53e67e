#pragma once

#include <string>

#include "calib/result/search_report.hpp"

namespace rigcal::report {

inline constexpr const char* kNoUsableResult =
    "There is no usable result: no number below may be used.";

/// What a result that was stopped is good for, by where it was stopped.
inline std::string stopped_sentence(calib::StoppedIn stage) {
  using calib::StoppedIn;
  if (stage == StoppedIn::starts || stage == StoppedIn::nothing)
    return "Ended before it converged: these are the best values so far, not a calibration.";
  if (stage == StoppedIn::validation) return "Some conditions were not scored.";
  return "The fit converged and was scored; not all that was asked for beside it was finished.";
}

}  // namespace rigcal::report
