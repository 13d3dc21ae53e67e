#include "calib/problem/known_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "calib/problem/parameter_map.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::FittedValue;
using datasets::Scope;

bool is_nuisance(const Campaign& campaign, int index) {
  const auto* setting = campaign.setting(index);
  const auto row = static_cast<std::size_t>(index);
  const bool initial =
      model::parameter_table(campaign.rig.plant)[row].kind == model::ParameterKind::initial;
  return setting != nullptr ? setting->nuisance : initial;
}

[[noreturn]] void fail_missing(const Campaign& campaign, const Condition& condition, int index,
                               const std::vector<FittedValue>& fitted) {
  std::vector<std::string> levels;
  Scope scope = Scope::rig;
  for (const FittedValue& value : fitted) {
    if (value.index != index) continue;
    scope = value.scope;
    levels.push_back(fmt::format("\"{}\"", value.level));
  }
  const auto key = model::parameter_spec(campaign.rig.plant, index).key;
  if (levels.empty()) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": the fit has no value for {}, which this "
                                 "campaign fits: expected a fit of it, or a known value",
                                 condition.id, key));
  }
  if (scope == Scope::leak_level) {
    throw InputError(
        condition.where,
        fmt::format("condition \"{}\": the fit has no {} for {}, only for {}: expected one of "
                    "these, or a known value in [leak_level.\"...\"]",
                    condition.id, key,
                    condition.leak_level ? fmt::format("leak level \"{}\"", *condition.leak_level)
                                         : std::string("a condition without leak_level"),
                    fmt::join(levels, ", ")));
  }
  throw InputError(
      condition.where,
      fmt::format("condition \"{}\": the fit has no {} for it, only for {}: expected a known value "
                  "in `parameters`, or nuisance = true for a parameter that is estimated anew",
                  condition.id, key, fmt::join(levels, ", ")));
}

}  // namespace

model::ParameterValues values_with(const Campaign& campaign, const Condition& condition,
                                   const std::vector<FittedValue>& fitted) {
  std::set<int> needed;
  for (const auto& setting : campaign.parameters) {
    if (setting.fit) needed.insert(setting.index);
  }
  for (const FittedValue& value : fitted) needed.insert(value.index);

  auto values = datasets::values_in(campaign, condition);
  for (const int index : needed) {
    if (is_nuisance(campaign, index) || known_in(campaign, condition, index)) continue;
    const auto found = std::find_if(fitted.begin(), fitted.end(), [&](const FittedValue& value) {
      return value.index == index && condition.is_within(value.scope, value.level);
    });
    if (found == fitted.end()) fail_missing(campaign, condition, index, fitted);
    values.set(index, found->value);
  }
  return values;
}

}  // namespace rigcal::calib
