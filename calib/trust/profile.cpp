#include "calib/trust/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "calib/search/search.hpp"
#include "common/bytes.hpp"
#include "common/readable.hpp"
#include "common/task_farm.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {

template <typename Archive>
void serialize(Archive& archive, ProfileEnd& end) {
  archive(end.value, end.reached, end.lost);
}

template <typename Archive>
void serialize(Archive& archive, Profile& profile) {
  archive(profile.low, profile.high, profile.values, profile.rises, profile.lower_cost_found);
}

namespace {

/// First step if there is no interval from which to derive it, and the smallest step. Both are
/// fractions of the box.
constexpr double kFirstStep = 0.05;
constexpr double kLeastStep = 1e-6;
/// With this many doublings, a step of 1/4000 of the box extends across the whole box.
constexpr int kMostDoublings = 12;
/// Even pure bisection would need only six steps to reduce a doubled step to kCrossing.
constexpr int kMostRefinements = 8;
/// If a fit does not converge, the step is shortened up to this many times, by this factor.
constexpr int kMostShortened = 4;
constexpr double kShorter = 8.0;
/// Tolerance for a crossing, relative to its distance from the optimum.
constexpr double kCrossing = 0.02;
/// If the cost falls below that of the optimum by more than this fraction of the threshold, about
/// one standard error, the fit was not at its minimum. A smaller decrease may be due to simulation
/// errors, which differ from point to point.
constexpr double kLower = 0.25;

datasets::Campaign campaign_with(const Problem& problem, const Unknown& unknown, double value) {
  datasets::Campaign campaign = *problem.campaign;
  for (auto& setting : campaign.parameters) {
    if (setting.index != unknown.index || unknown.scope != datasets::Scope::rig) continue;
    setting.fit = false;
    setting.value = value;
  }
  if (unknown.scope == datasets::Scope::leak_level)
    campaign.leak_levels[unknown.level].emplace_back(unknown.index, value);
  if (unknown.scope == datasets::Scope::condition) {
    for (auto& condition : campaign.conditions) {
      if (condition.id == unknown.level) condition.overrides.emplace_back(unknown.index, value);
    }
  }
  return campaign;
}

/// Minimises the cost over all other unknowns at fixed values of one unknown. Each fit starts from
/// the nearest point already known.
class Follower {
 public:
  Follower(const Problem& problem, const std::vector<datasets::Record>& records,
           std::size_t unknown, const Evaluation& optimum, double threshold,
           const FitOptions& options, Budget& budget)
      : problem_(problem),
        records_(records),
        unknown_(unknown),
        threshold_(threshold),
        options_(options),
        optimum_(optimum),
        budget_(budget) {
    options_.progress = nullptr;
    std::vector<double> others = optimum.z;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(unknown));
    points_[optimum.z[unknown]] = {0.0, std::move(others)};
  }

  /// Returns the rise in 2 cost as a fraction of the threshold, or std::nullopt if it could not be
  /// determined.
  std::optional<double> rise(double z) {
    const auto known = points_.find(z);
    if (known != points_.end()) return known->second.rise;
    datasets::Campaign campaign;
    const double value = problem_.map.to_physical(static_cast<int>(unknown_), z);
    const Problem fixed = with_known(problem_, records_, unknown_, value, campaign);
    Budget part = budget_.part();
    Evaluator evaluator(fixed, part);
    const std::vector<double>& from = nearest(z);
    if (fixed.map.unknowns().empty()) {
      evaluator.evaluate(from);
    } else {
      const auto solved = Search(fixed, evaluator, options_).polish(from);
      evaluations_ += evaluator.counters().evaluations;
      if (solved.status != FitStatus::converged) return std::nullopt;
    }
    if (!evaluator.best().ok) return std::nullopt;
    const double prior = problem_.map.prior_residual(static_cast<int>(unknown_), z);
    const double cost = evaluator.best().cost + 0.5 * prior * prior;
    const double found = 2.0 * (cost - optimum_.cost) / threshold_;
    points_[z] = {found, evaluator.best().z};
    return found;
  }

  bool interrupted() const { return budget_.interrupted(); }
  long evaluations() const { return evaluations_; }

  Profile table() const {
    Profile profile;
    for (const auto& [z, point] : points_) {
      profile.values.push_back(problem_.map.to_physical(static_cast<int>(unknown_), z));
      profile.rises.push_back(point.rise);
      profile.lower_cost_found = profile.lower_cost_found || point.rise < -kLower;
    }
    return profile;
  }

 private:
  struct Point {
    double rise = 0.0;
    std::vector<double> others;
  };

  const std::vector<double>& nearest(double z) const {
    const auto best = std::min_element(points_.begin(), points_.end(), [z](auto& a, auto& b) {
      return std::abs(a.first - z) < std::abs(b.first - z);
    });
    return best->second.others;
  }

  const Problem& problem_;
  const std::vector<datasets::Record>& records_;
  std::size_t unknown_;
  double threshold_;
  FitOptions options_;
  const Evaluation& optimum_;
  Budget& budget_;
  long evaluations_ = 0;
  std::map<double, Point> points_;
};

/// Follows the profile from z0 towards one end, 0 or 1.
ProfileEnd follow(Follower& follower, const Problem& problem, std::size_t unknown, double z0,
                  double step, double side) {
  const auto value = [&](double z) {
    return problem.map.to_physical(static_cast<int>(unknown), z);
  };
  const double bound = side > 0.0 ? 1.0 : 0.0;
  double inside = z0;
  double inside_rise = 0.0;
  ProfileEnd end;
  end.reached = value(z0);
  double outside = z0;
  std::optional<double> outside_rise;
  for (int i = 0; i < kMostDoublings && inside != bound; ++i) {
    outside = std::clamp(inside + side * step, 0.0, 1.0);
    outside_rise = follower.rise(outside);
    // The step may have been too long for a fit from the previous point to succeed, for example if
    // the interval includes more than the uncertainty of the records.
    for (int k = 0; k < kMostShortened && !outside_rise && !follower.interrupted(); ++k) {
      step /= kShorter;
      outside = std::clamp(inside + side * step, 0.0, 1.0);
      outside_rise = follower.rise(outside);
    }
    if (!outside_rise) {
      end.lost = std::optional(true);
      return end;
    }
    end.reached = value(outside);
    if (*outside_rise >= 1.0) break;
    inside = outside;
    inside_rise = *outside_rise;
    step *= 2.0;
  }
  if (!outside_rise || *outside_rise < 1.0) return end;  // the profile is still open at this point
  // The square root of the rise is almost linear in z.
  for (int i = 0; i < kMostRefinements; ++i) {
    if (std::abs(outside - inside) <= kCrossing * std::abs(outside - z0)) break;
    const double a = std::sqrt(std::max(0.0, inside_rise));
    const double b = std::sqrt(*outside_rise);
    const double share = std::clamp((1.0 - a) / (b - a), 0.05, 0.95);
    const double between = inside + share * (outside - inside);
    const auto rise = follower.rise(between);
    if (!rise) break;
    if (std::abs(*rise - 1.0) <= kCrossing) {
      end.value = value(between);
      return end;
    }
    if (*rise < 1.0) {
      inside = between;
      inside_rise = *rise;
    } else {
      outside = between;
      outside_rise = rise;
    }
  }
  end.value = value(outside);
  return end;
}

/// Returns the rise in 2 cost at which the profile of this parameter ends. If the cost is
/// quadratic, this is where `ci95_if_exact` ends.
double threshold_of(const FittedParameter& parameter, double reduced_chi_square) {
  const double variance = std::max(1.0, reduced_chi_square);
  if (!parameter.ci95_if_exact || !parameter.standard_error)
    return metrics::kNormal95 * metrics::kNormal95 * variance;
  // The longer half is used, because the other half may be truncated at a limit.
  const double half = std::max(parameter.ci95_if_exact->high - parameter.value,
                               parameter.value - parameter.ci95_if_exact->low);
  const double errors = half / *parameter.standard_error;
  return errors * errors * variance;
}

double first_step(const Problem& problem, std::size_t unknown, double z0,
                  const FittedParameter& parameter) {
  if (!parameter.standard_error) return kFirstStep;
  const double error = parameter.robust_standard_error.value_or(*parameter.standard_error);
  const double slope = problem.map.slope(static_cast<int>(unknown), z0);
  return std::clamp(metrics::kNormal95 * error / slope, kLeastStep, 0.5);
}

/// Returns a profile that contains only the optimum, for use when the budget is spent.
Profile not_made(double value) {
  Profile profile;
  profile.low = {{}, value, true};
  profile.high = {{}, value, true};
  profile.values = {value};
  profile.rises = {0.0};
  return profile;
}

}  // namespace

Problem with_known(const Problem& problem, const std::vector<datasets::Record>& records,
                   std::size_t unknown, double value, datasets::Campaign& campaign) {
  campaign = campaign_with(problem, problem.map.unknowns()[unknown], value);
  std::vector<const datasets::Condition*> conditions;
  for (const ProblemCondition& each : problem.conditions)
    conditions.push_back(campaign.find(each.condition->id));
  Problem fixed = make_problem(campaign, records, conditions, false, nullptr);
  fixed.tolerance = problem.tolerance;
  fixed.tolerance_fixed = problem.tolerance_fixed;
  for (std::size_t i = 0; i < fixed.conditions.size(); ++i) {
    fixed.conditions[i].max_steps = problem.conditions[i].max_steps;
    fixed.conditions[i].measured_tolerance = problem.conditions[i].measured_tolerance;
    for (std::size_t k = 0; k < fixed.conditions[i].channels.size(); ++k)
      fixed.conditions[i].channels[k].sd = problem.conditions[i].channels[k].sd;
  }
  return fixed;
}

void profiles(const Problem& problem, const std::vector<datasets::Record>& records,
              const Evaluation& optimum, const FitOptions& options, Fit& fit, Budget& left) {
  const auto& unknowns = problem.map.unknowns();
  const std::optional<long> allowed = left.evaluations_left();
  std::vector<long> taken(unknowns.size(), 0);
  std::atomic<int> done = 0;
  const auto make = [&](std::size_t j) -> TaskResult {
    if (unknowns[j].nuisance) return {};
    if (left.spent()) return {{}, false};
    Follower follower(problem, records, j, optimum,
                      threshold_of(fit.parameters[j], fit.reduced_chi_square.value_or(1.0)),
                      options, left);
    const double step = first_step(problem, j, optimum.z[j], fit.parameters[j]);
    const ProfileEnd low = follow(follower, problem, j, optimum.z[j], step, -1.0);
    const ProfileEnd high = follow(follower, problem, j, optimum.z[j], step, 1.0);
    Profile profile = follower.table();
    profile.low = low;
    profile.high = high;
    left.count(follower.evaluations());
    return {to_bytes(follower.evaluations(), profile), !follower.interrupted()};
  };
  const auto tell = [&](std::size_t j, const TaskResult& result) {
    if (options.beside && result.whole && !unknowns[j].nuisance)
      options.beside("profiles", ++done, static_cast<int>(unknowns.size()));
  };
  ThreadFarm threads;
  TaskFarm& farm = options.farm != nullptr ? *options.farm : threads;
  const auto results =
      farm.run({"profiles", to_bytes(optimum.z, optimum.cost), unknowns.size(), options.threads},
               make, tell);
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    if (unknowns[j].nuisance) continue;
    FittedParameter& parameter = fit.parameters[j];
    parameter.profile = not_made(parameter.value);
    if (!results[j].bytes.empty()) from_bytes(results[j].bytes, taken[j], *parameter.profile);
  }
  // Profiles after the one that reached the limit are discarded, because which of them were
  // computed depends on the number of threads.
  long sum = 0;
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    FittedParameter& parameter = fit.parameters[j];
    if (allowed && sum >= *allowed && parameter.profile)
      parameter.profile = not_made(parameter.value);
    sum += taken[j];
  }
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    FittedParameter& parameter = fit.parameters[j];
    if (!parameter.profile) continue;
    const Profile& profile = *parameter.profile;
    const auto say = [&](const std::string& text) {
      parameter.reason += (parameter.reason.empty() ? "" : "; ") + text;
    };
    if (profile.lower_cost_found)
      say("its profile finds a lower cost: the fit is not at the minimum; use more starts");
    if (profile.low.is_lost() || profile.high.is_lost()) {
      say(fmt::format("its profile was not computed {}: {}",
                      profile.low.is_lost() && profile.high.is_lost() ? "on either side"
                      : profile.low.is_lost()                         ? "below"
                                                                      : "above",
                      left.spent() ? left.reason() : "no fit converged there"));
    }
    if (profile.low.value && profile.high.value) continue;
    const model::ParameterSpec& spec = problem.spec(j);
    // A profile that reaches a limit of the parameter itself, such as zero leakage, is complete.
    const bool below =
        !profile.low.value && !profile.low.is_lost() && unknowns[j].lower > spec.lower;
    const bool above =
        !profile.high.value && !profile.high.is_lost() && unknowns[j].upper < spec.upper;
    if (!below && !above) continue;
    say(fmt::format("its profile is open {}: followed from {} to {}",
                    below && above ? "on both sides" : (above ? "above" : "below"),
                    readable(profile.low.value.value_or(profile.low.reached), spec.unit, 4),
                    readable(profile.high.value.value_or(profile.high.reached), spec.unit, 4)));
    // A bound within the interval restricts the parameter more than the records do; a bound outside
    // restricts it less.
    const double half_width = parameter.ci95_if_exact
                                  ? std::max(parameter.ci95_if_exact->high - parameter.value,
                                             parameter.value - parameter.ci95_if_exact->low)
                                  : 0.0;
    if ((below && parameter.value - unknowns[j].lower >= half_width) ||
        (above && unknowns[j].upper - parameter.value >= half_width))
      parameter.identifiability = Identifiability::not_identifiable;
  }
}

}  // namespace rigcal::calib
