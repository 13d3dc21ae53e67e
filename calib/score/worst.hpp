#pragma once

#include <optional>
#include <tuple>

#include "calib/result/condition_score.hpp"

namespace rigcal::calib {

/// How badly the model agrees with a condition or with one of its channels. The order of these is
/// the only one that decides which of several is the worst; the worse one is larger.
///
/// What could not be scored comes first. Then the verdicts count, then the tolerance that is used,
/// and, without limits or at equal distances from them, rho2.
struct Badness {
  bool unusable = false;           ///< not simulated or not scored
  std::optional<Verdict> verdict;  ///< absent without limits
  double tolerance_used = 0.0;     ///< infinite if a metric with a limit has no value
  double disagreement = 0.0;       ///< 1 - rho2; infinite if rho2 has no value

  /// Adds a limit. The one that uses most of its tolerance counts.
  void add(const LimitCheck& check);
  /// Adds the agreement of a channel; NaN if it has none. The lowest counts.
  void add_rho2(double rho2);

  friend bool operator<(const Badness& a, const Badness& b) {
    return std::tie(a.unusable, a.verdict, a.tolerance_used, a.disagreement) <
           std::tie(b.unusable, b.verdict, b.tolerance_used, b.disagreement);
  }
};

/// @param channel  key of the channel; empty: the whole condition
Badness badness(const ConditionResult& condition, std::string_view channel = {});

/// Whether a goes before b where there is no room for all: first what fails, so that it is never
/// left out, then validation records, then the others. The worst come first among each kind.
bool shown_before(datasets::Use use_a, const Badness& a, datasets::Use use_b, const Badness& b);

}  // namespace rigcal::calib
