#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/describe.hpp"

namespace rigcal::metrics {

/// Outcome of a significance test. A test that would hardly ever reject proves nothing by not
/// rejecting, so this does not count as a pass.
enum class TestOutcome { passed, failed, not_judged };
RIGCAL_NAMES(TestOutcome, passed, failed, not_judged)

/// What every test has.
struct Judged {
  TestOutcome outcome = TestOutcome::not_judged;  ///< "passed", "failed" or "not_judged"
  std::optional<std::string> reason;              ///< why the test cannot be judged

  bool passed() const { return outcome == TestOutcome::passed; }
  bool failed() const { return outcome == TestOutcome::failed; }
};

/// Minimum number of effective samples for a rejection to count. Bounds and p-values are those of
/// the normal distribution, but the scale is estimated from the same samples. With 10 of them, the
/// nominal level of 5 % is really 8 % (Student's t with 9 degrees of freedom beyond 1.96); with 3,
/// it is 19 %.
inline constexpr double kLeastEffectiveSamples = 10.0;

/// Largest useful bound for a correlation or a cumulative fraction of power, both of which are at
/// most 1. A correlation of 0.5 is a large effect, which explains a quarter of the variance (Cohen,
/// Statistical Power Analysis, 1988). A test that would accept it proves nothing by passing.
inline constexpr double kLargestUsefulBound = 0.5;

/// Largest useful bound for an excess kurtosis. A sine wave, the most common residual that is not
/// normal, has -1.5.
inline constexpr double kLargestUsefulKurtosis = 1.5;

/// The smallest effect that a test detects, and what kind of effect it is.
struct Power {
  double effective_samples = 0.0;
  double bound = 0.0;           ///< smallest effect that is rejected
  double largest_useful = 0.0;  ///< bound above which passing proves nothing
  std::string_view effect{};    ///< for the reason, such as "a correlation with the input"
};

/// Applies the same rule to all tests. A test fails if it rejects and its level is valid. It passes
/// if it does not reject although it could have detected an effect of interest. Otherwise it cannot
/// be judged.
Judged judge(bool rejects, const Power& power);

}  // namespace rigcal::metrics
