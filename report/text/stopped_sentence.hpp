#pragma once

#include <string>

#include "calib/result/search_report.hpp"

namespace rigcal::report {

inline constexpr const char* kNoUsableResult =
    "There is no usable result: do not use any number below.";

/// Explains how far a stopped result can be used, which depends on the stage at which it stopped.
inline std::string stopped_sentence(calib::StoppedIn stage) {
  using calib::StoppedIn;
  if (stage == StoppedIn::starts)
    return "Ended before it converged: these are the best values so far, not a calibration.";
  if (stage == StoppedIn::validation) return "Some conditions were not scored.";
  return "The fit converged and was scored; further work that was requested is not finished.";
}

}  // namespace rigcal::report
