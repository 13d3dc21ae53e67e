#include "diagnosis/machine/between_days.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "common/readable.hpp"
#include "common/significant.hpp"
#include "diagnosis/machine/machine_state.hpp"
#include "diagnosis/record/obstacles.hpp"

namespace rigcal::diagnosis {
namespace {

constexpr const char* kDayOfFit = "the day of the fit";

std::size_t place_of(const std::vector<std::string>& days, const std::string& day) {
  return static_cast<std::size_t>(std::find(days.begin(), days.end(), day) - days.begin());
}

std::vector<const datasets::Condition*> fitted_conditions(const datasets::Campaign& campaign) {
  std::vector<const datasets::Condition*> result;
  for (const datasets::Condition& each : campaign.conditions) {
    if (each.use == datasets::Use::fit) result.push_back(&each);
  }
  return result;
}

std::string quantity_in_words(const calib::DayQuantity& quantity) {
  return quantity.meaning + " " + readable(quantity.sd, quantity.unit, 2);
}

}  // namespace

double BetweenDays::error(double weight, const Eigen::VectorXd& effects) const {
  return weight * factor * effects.norm();
}

std::string day_label(const datasets::Condition& condition) {
  if (condition.date) return *condition.date;
  if (condition.use == datasets::Use::fit) return kDayOfFit;
  return fmt::format("\"{}\" (no date)", state_of(condition).name());
}

model::ParameterValues rig_values(const LeakProblem& problem) {
  model::ParameterValues values =
      datasets::values_in(problem.campaign, problem.campaign.conditions.front());
  for (const datasets::FittedValue& each : problem.values) {
    if (each.scope == datasets::Scope::rig) values.set(each.index, each.value);
  }
  return values;
}

double shortest_interval(const std::vector<datasets::RepeatRecords>& records) {
  double least = HUGE_VAL;
  for (const datasets::RepeatRecords& each : records) {
    const auto& time_s = each.average.time_s;
    if (time_s.size() > 1)
      least = std::min(least,
                       (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1));
  }
  return least;
}

BetweenDays between_days_of(const datasets::Campaign& campaign,
                            const model::ParameterValues& values, double sample_s) {
  BetweenDays between;
  between.quantities = calib::day_quantities(campaign, values, sample_s);
  if (campaign.between_days.is_stated()) between.source = DaySource::stated;
  std::set<std::string> healthy;
  between.days.emplace_back(kDayOfFit);
  for (const datasets::Condition* each : diagnosed_conditions(campaign)) {
    const std::string day = day_label(*each);
    if (place_of(between.days, day) == between.days.size()) between.days.push_back(day);
    if (each->date && is_healthy(campaign, *each)) healthy.insert(*each->date);
  }
  between.healthy_dates = static_cast<int>(healthy.size());
  return between;
}

DayWeights day_weights(const BetweenDays& between, const datasets::Campaign& campaign,
                       const datasets::Condition& condition,
                       const std::vector<const datasets::Condition*>& references) {
  const auto days = static_cast<Eigen::Index>(between.days.size());
  DayWeights weights{Eigen::VectorXd::Zero(days), Eigen::VectorXd::Zero(days)};
  const auto place = [&](const datasets::Condition& each) {
    return static_cast<Eigen::Index>(place_of(between.days, day_label(each)));
  };
  weights.own(place(condition)) = 1.0;
  const auto& of = references.empty() ? fitted_conditions(campaign) : references;
  for (const datasets::Condition* each : of)
    weights.reference(place(*each)) += 1.0 / static_cast<double>(of.size());
  if (of.empty()) weights.reference(0) = 1.0;  // the fit used other records
  return weights;
}

void estimate_days(const std::vector<HealthyDay>& healthy, BetweenDays& between) {
  if (between.source == DaySource::stated || between.healthy_dates < kLeastHealthyDates) return;
  double beyond = 0.0;
  double expected = 0.0;
  for (const HealthyDay& each : healthy) {
    const double all = each.variance + each.days_variance;
    if (!(each.days_variance > 0.0) || !(all > 0.0)) continue;
    const double weight = each.days_variance / (all * all);
    beyond += weight * (each.coefficient * each.coefficient - each.variance);
    expected += weight * each.days_variance;
  }
  if (!(expected > 0.0)) return;
  between.source = DaySource::estimated;
  between.variance = std::max(0.0, beyond / expected);
  between.factor = std::sqrt(between.variance);
  between.freedom = between.healthy_dates - 1.0;
  for (calib::DayQuantity& each : between.quantities) each.sd *= between.factor;
}

std::optional<std::string> in_words(const BetweenDays& between) {
  if (between.other_days.empty()) return std::nullopt;
  const std::string who = fmt::format("records of {}: another day than their reference's",
                                      fmt::join(between.other_days, ", "));
  if (between.quantities.empty())
    return who +
           ". The campaign states that there is no day-to-day variation (between_days), so any "
           "change since then counts as a leak";
  std::vector<std::string> sizes;
  for (const calib::DayQuantity& each : between.quantities)
    sizes.push_back(quantity_in_words(each));
  std::string from = "usual sizes, which [between_days] can override";
  if (between.source == DaySource::stated) from = "[between_days]";
  if (between.source == DaySource::estimated)
    from = fmt::format("{} times the usual sizes, by healthy records of {} dates",
                       significant(between.factor, 2), between.healthy_dates);
  return fmt::format(
      "{}. Between days the rig may differ (standard deviations: {}; {}); intervals, classes, "
      "alarms and smallest leaks include that",
      who, fmt::join(sizes, ", "), from);
}

CoefficientError with_days(CoefficientError error, double days_se, double freedom) {
  if (!(days_se > 0.0)) return error;
  const double before = error.total();
  error.freedom =
      metrics::effective_freedom(std::array{metrics::ErrorPart{before * before, error.freedom},
                                            metrics::ErrorPart{days_se * days_se, freedom}});
  error.days_se = days_se;
  return error;
}

}  // namespace rigcal::diagnosis
