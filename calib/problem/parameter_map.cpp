#include "calib/problem/parameter_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::ParameterSetting;
using datasets::Scope;

/// The scale is logarithmic if the ratio of the bounds exceeds this value.
constexpr double kLogarithmicRatio = 10.0;

UnitInterval interval_of(const Unknown& unknown) {
  const bool logarithmic = unknown.lower > 0.0 && unknown.upper > kLogarithmicRatio * unknown.lower;
  return {unknown.lower, unknown.upper, logarithmic};
}

bool contains(const datasets::Overrides& overrides, int index) {
  return std::any_of(overrides.begin(), overrides.end(),
                     [index](const auto& entry) { return entry.first == index; });
}

Unknown unknown_of(const ParameterSetting& setting, std::string level) {
  return {setting.index, setting.scope, std::move(level), setting.value,
          setting.lower, setting.upper, setting.prior,    setting.nuisance};
}

void check(const Unknown& unknown, std::string_view key, const Location& where) {
  if (!std::isfinite(unknown.lower) || !std::isfinite(unknown.upper) ||
      !(unknown.lower < unknown.upper)) {
    throw InputError(where, fmt::format("{}: bounds {:g} to {:g}, expected finite ones with lower "
                                        "below upper",
                                        key, unknown.lower, unknown.upper));
  }
  if (!(unknown.start >= unknown.lower && unknown.start <= unknown.upper)) {
    throw InputError(where, fmt::format("{}: the start {:g} is outside the bounds {:g} to {:g}",
                                        key, unknown.start, unknown.lower, unknown.upper));
  }
  if (unknown.prior && !(unknown.prior->sd > 0.0 && std::isfinite(unknown.prior->mean))) {
    throw InputError(where, fmt::format("{}: prior {:g} with prior_sd {:g}, expected a finite "
                                        "mean and a positive standard deviation",
                                        key, unknown.prior->mean, unknown.prior->sd));
  }
}

}  // namespace

double UnitInterval::value(double z) const {
  const double value = logarithmic ? std::exp(std::log(lower) + z * std::log(upper / lower))
                                   : lower + z * (upper - lower);
  return std::clamp(value, lower, upper);  // rounding must not carry a value beyond its limits
}

double UnitInterval::place(double value) const {
  const double z = logarithmic ? std::log(value / lower) / std::log(upper / lower)
                               : (value - lower) / (upper - lower);
  return std::clamp(z, 0.0, 1.0);
}

double UnitInterval::slope(double z) const {
  return logarithmic ? value(z) * std::log(upper / lower) : upper - lower;
}

bool known_in(const Campaign& campaign, const Condition& condition, int index) {
  if (contains(condition.overrides, index)) return true;
  if (!condition.leak_level) return false;
  const auto level = campaign.leak_levels.find(*condition.leak_level);
  return level != campaign.leak_levels.end() && contains(level->second, index);
}

std::string level_in(const Condition& condition, Scope scope, std::string_view parameter) {
  if (scope == Scope::condition) return condition.id;
  if (scope == Scope::rig) return {};
  if (!condition.leak_level) {
    throw InputError(
        condition.where,
        fmt::format("condition \"{}\" has no leak_level, but {} has one value per leak "
                    "level: expected a leak_level, or a known value in `parameters`",
                    condition.id, parameter));
  }
  return *condition.leak_level;
}

ParameterMap::ParameterMap(const Campaign& campaign,
                           const std::vector<const Condition*>& conditions, bool nuisance_only,
                           const std::vector<Unknown>& extra, const std::vector<int>& repeats) {
  std::vector<ParameterSetting> settings = campaign.parameters;
  std::stable_sort(settings.begin(), settings.end(),
                   [](const auto& a, const auto& b) { return a.index < b.index; });
  for (const ParameterSetting& setting : settings) {
    if (!setting.fit || (nuisance_only && !setting.nuisance)) continue;
    const auto key = model::parameter_spec(campaign.rig.plant, setting.index).key;
    const std::size_t first = unknowns_.size();
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const Condition* condition = conditions[i];
      if (known_in(campaign, *condition, setting.index)) continue;
      std::string level = level_in(*condition, setting.scope, key);
      const bool present =
          std::any_of(unknowns_.begin() + static_cast<std::ptrdiff_t>(first), unknowns_.end(),
                      [&](const Unknown& unknown) { return unknown.level == level; });
      if (present) continue;
      unknowns_.push_back(unknown_of(setting, std::move(level)));
      if (setting.between_repeats && !repeats.empty())
        unknowns_.back().prior->sd /= std::sqrt(static_cast<double>(repeats[i]));
    }
    if (unknowns_.size() > first) check(unknowns_.back(), key, setting.where);
  }
  for (const Unknown& unknown : extra) {
    check(unknown, model::parameter_spec(campaign.rig.plant, unknown.index).key,
          {campaign.file.string()});
    unknowns_.push_back(unknown);
  }
  std::stable_sort(unknowns_.begin(), unknowns_.end(),
                   [](const Unknown& a, const Unknown& b) { return a.index < b.index; });

  for (const Condition* condition : conditions) {
    std::vector<int>& acting = acting_.emplace_back();
    for (std::size_t j = 0; j < unknowns_.size(); ++j) {
      const Unknown& unknown = unknowns_[j];
      if (!known_in(campaign, *condition, unknown.index) &&
          condition->is_within(unknown.scope, unknown.level))
        acting.push_back(static_cast<int>(j));
    }
  }
  const bool apart = unknowns_.size() > kMostTogether;
  if (apart) layout_.own.resize(conditions.size());
  std::vector<bool> taken(unknowns_.size(), false);
  for (std::size_t i = 0; apart && i < conditions.size(); ++i) {
    for (const int j : acting_[i]) {
      const auto u = static_cast<std::size_t>(j);
      if (unknowns_[u].scope != Scope::condition || taken[u]) continue;
      layout_.own[i].push_back(j);
      taken[u] = true;
    }
  }
  for (std::size_t j = 0; j < unknowns_.size(); ++j) {
    if (!taken[j]) layout_.shared.push_back(static_cast<int>(j));
  }
  const bool none = std::find(taken.begin(), taken.end(), true) == taken.end();
  if (none) layout_.own.clear();
}

double ParameterMap::to_physical(int unknown, double z) const {
  return interval_of(unknowns_[static_cast<std::size_t>(unknown)]).value(z);
}

double ParameterMap::to_unit(int unknown, double value) const {
  return interval_of(unknowns_[static_cast<std::size_t>(unknown)]).place(value);
}

double ParameterMap::slope(int unknown, double z) const {
  return interval_of(unknowns_[static_cast<std::size_t>(unknown)]).slope(z);
}

double ParameterMap::prior_residual(int unknown, double z) const {
  const auto& prior = unknowns_[static_cast<std::size_t>(unknown)].prior;
  return prior ? prior->residual(to_physical(unknown, z)) : 0.0;
}

double ParameterMap::prior_slope(int unknown, double z) const {
  const auto& prior = unknowns_[static_cast<std::size_t>(unknown)].prior;
  return prior ? slope(unknown, z) / prior->sd : 0.0;
}

std::string parameter_label(const std::string& name, datasets::Scope scope,
                            const std::optional<std::string>& level) {
  if (!level || level->empty()) return name;
  return fmt::format("{} ({} {})", name,
                     scope == datasets::Scope::leak_level ? "leak level" : "condition", *level);
}

}  // namespace rigcal::calib
