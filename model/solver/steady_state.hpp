#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "model/arithmetic/state.hpp"
#include "model/solver/error_norm.hpp"
#include "model/solver/sampled_period.hpp"

namespace rigcal::model {

/// Detects when a run with periodic inputs is so close to its periodic steady state that the rest
/// of it can be extrapolated. Either the states and their sensitivities repeat those of one period
/// earlier, or each period adds a fixed fraction of the previous period's change, as a single slow
/// mode does (docs/decisions/0012). If a half period reverses the inputs, the states are compared
/// with those of half a period earlier with the opposite sign.
///
/// The detector checks a few times per period, at whole fractions of a period before the end, from
/// when the inputs repeat.
template <int N, int P>
class SteadyState {
 public:
  using X = State<N, P>;
  using C = Active<P>;

  SteadyState(const std::optional<SampledPeriod>& period, double end_s) {
    if (!period) return;
    samples_ = period->samples;
    sign_ = period->sign();
    looks_a_period_ = period->reversed ? kLooks / 2 : kLooks;
    interval_s_ = period->duration_s / static_cast<double>(looks_a_period_);
    end_s_ = end_s;
    looks_left_ = std::min(static_cast<long>(std::ceil(end_s / interval_s_)) - 1,
                           static_cast<long>(std::floor((end_s - period->from_s) / interval_s_)));
  }

  /// Time of the next check; infinity if there is none.
  double next_look_s() const {
    return looks_left_ > 0 ? end_s_ - static_cast<double>(looks_left_) * interval_s_
                           : std::numeric_limits<double>::infinity();
  }

  /// Checks the state at this instant.
  ///
  /// @return  whether the rest of the run can be extrapolated
  [[gnu::cold]] bool look(const X& x, const ErrorNorm<N, P>& norm) {
    const auto phase = static_cast<std::size_t>(looks_left_ % looks_a_period_);
    periods_left_ = static_cast<double>(looks_left_) / static_cast<double>(looks_a_period_);
    --looks_left_;
    ++looks_;
    X change = x;
    add_scaled(change, -1.0, seen_[phase]);
    const X before = change_[phase];
    seen_[phase] = next(x);
    change_[phase] = next(change);
    if (looks_ <= looks_a_period_) return false;
    // A drift that is too slow to detect adds the same amount in each further period.
    reached_ = std::max(1.0, periods_left_) * size(change, norm) <= kSteady;
    if (reached_) return true;
    return looks_ > 2 * looks_a_period_ && follows(change, before, norm, phase == 0);
  }

  /// Whether the run is in its steady state. If not, it approaches the steady state by a fixed
  /// fraction per period.
  bool reached() const { return reached_; }
  /// Change over the next `periods`, as a multiple of the last change.
  [[gnu::cold]] C growth(long periods) const {
    C sum(0.0);
    for (long k = 0; k < periods; ++k) sum = ratio_ * (sum + 1.0);
    return sum;
  }
  std::size_t samples() const { return samples_; }  ///< samples in one period
  double sign() const { return sign_; }             ///< factor from one period to the next

 private:
  /// Number of checks per whole period. A half period gets four, so that steps are cut short
  /// equally often.
  static constexpr long kLooks = 8;
  // Allowed error of the rest of the run in units of the step tolerance: kSteady if it is taken as
  // steady, kForeseen if it is extrapolated. Sensitivities always have larger errors than the
  // states.
  static constexpr double kSteady = 1.0;
  static constexpr double kForeseen = 2.0;
  static constexpr double kLooserSensitivities = 10.0;

  /// The state one period later in a periodic run.
  X next(X x) const {
    for (std::size_t i = 0; i < N; ++i) x[i] = x[i] * sign_;
    return x;
  }

  static double size(const X& change, const ErrorNorm<N, P>& norm) {
    return std::max(norm.of_states(change, change),
                    norm.of_sensitivities(change, change) / kLooserSensitivities);
  }

  /// Whether all changes over a period are the same fraction of those over the period before.
  ///
  /// @param ends  whether the period ends here; the answer is valid only then
  [[gnu::cold]] bool follows(const X& change, const X& before, const ErrorNorm<N, P>& norm,
                             bool ends) {
    // Multiple of the present change that is still to come.
    const double to_come = std::min(periods_left_, 1.0 / std::max(1.0 - value_of(ratio_), 1e-3));
    X missed = change;
    for (std::size_t i = 0; i < N; ++i) missed[i] = missed[i] - ratio_ * before[i];
    follows_ = follows_ && to_come * size(missed, norm) <= kForeseen;
    along_ = along_ + norm.inner(change, before);
    square_ = square_ + norm.inner(before, before);
    if (!ends) return false;
    // The fraction itself drifts as the changes become small. The drift is assumed to continue in
    // each of these periods.
    const C ratio = along_ / square_;
    X drift = change;
    for (std::size_t i = 0; i < N; ++i) drift[i] = drift[i] * (ratio - ratio_);
    const bool result = follows_ && std::abs(value_of(ratio)) < 1.0 &&
                        to_come * to_come * to_come * size(drift, norm) <= kForeseen;
    ratio_ = ratio;
    along_ = square_ = C(0.0);
    follows_ = true;
    return result;
  }

  /// next() of the latest state at each phase.
  std::array<X, static_cast<std::size_t>(kLooks)> seen_{};
  /// next() of the latest change over a period at each phase.
  std::array<X, static_cast<std::size_t>(kLooks)> change_{};
  C ratio_{0.0};  ///< ratio of the changes in the last complete period to those in the one before
  C along_{0.0};  ///< sum over this period, for the next ratio
  C square_{0.0};
  bool follows_ = false;
  bool reached_ = false;
  double periods_left_ = 0.0;
  std::size_t samples_ = 0;
  double sign_ = 1.0;
  long looks_a_period_ = kLooks;
  double interval_s_ = 0.0;
  double end_s_ = 0.0;
  long looks_ = 0;
  long looks_left_ = 0;  ///< checks that remain before the end
};

}  // namespace rigcal::model
