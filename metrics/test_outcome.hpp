#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rigcal::metrics {

/// Outcome of a significance test. A test that would hardly ever reject proves nothing by not
/// rejecting: that is no pass.
enum class TestOutcome { passed, failed, not_judged };

/// "passed", "failed", "not_judged"
std::string_view to_string(TestOutcome outcome);

struct Judged {
  TestOutcome outcome = TestOutcome::not_judged;
  std::optional<std::string> reason;  ///< why it cannot be judged

  bool passed() const { return outcome == TestOutcome::passed; }
  bool failed() const { return outcome == TestOutcome::failed; }
};

/// Fewest effective samples with which a rejection counts. Bounds and p values are those of the
/// normal distribution, but the scale is estimated from the same samples: with 10 of them the
/// nominal level of 5 % is one of 8 % (Student's t with 9 degrees of freedom beyond 1.96), with 3
/// one of 19 %.
inline constexpr double kLeastEffectiveSamples = 10.0;

/// Largest useful bound of a correlation or of a cumulative fraction of power, both of which end at
/// 1. Half as large is a large effect (Cohen, Statistical Power Analysis, 1988). A test that
/// accepts it, a quarter of the variance explained, proves nothing by passing.
inline constexpr double kLargestUsefulBound = 0.5;

/// The same for an excess kurtosis: that of a sine wave, the commonest residual that is not normal,
/// is -1.5.
inline constexpr double kLargestUsefulKurtosis = 1.5;

/// The smallest effect that a test detects, with its kind.
struct Power {
  double effective_samples = 0.0;
  double bound = 0.0;           ///< smallest effect that is rejected
  double largest_useful = 0.0;  ///< bound above which a pass proves nothing
  std::string_view effect{};    ///< "a correlation with the input", in the reason
};

/// The one rule for all tests. A test fails if it rejects and its level is valid. It passes if it
/// does not reject although it could have detected an effect of interest. Otherwise it cannot be
/// judged.
Judged judge(bool rejects, const Power& power);

}  // namespace rigcal::metrics
