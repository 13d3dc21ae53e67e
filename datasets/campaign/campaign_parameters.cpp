#include "datasets/campaign/campaign_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "datasets/campaign/keys/key_table.hpp"
#include "datasets/campaign/toml/quantity_range.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

bool belongs_to(const model::ParameterSpec& spec, ParameterGroup group) {
  const bool of_controller = spec.kind == model::ParameterKind::controller;
  return group == ParameterGroup::any || of_controller == (group == ParameterGroup::controller);
}

std::string with_unit(const model::ParameterSpec& spec, double value) {
  return spec.unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, spec.unit);
}

/// Reads the value of a parameter, and checks it against the limits in the parameter table.
double read_value(const TomlNode& node, const model::ParameterSpec& spec) {
  const double value = node.quantity(spec.unit);
  if (const auto problem = outside_limits(spec, value)) node.fail(*problem);
  return value;
}

/// Returns the names of the plants that have a parameter.
std::vector<std::string> plants_with(std::string_view key) {
  std::vector<std::string> names = model::plant_names();
  names.erase(std::remove_if(names.begin(), names.end(),
                             [&](const std::string& name) {
                               return model::parameter_index(model::plant_from_name(name).value(),
                                                             key) < 0;
                             }),
              names.end());
  return names;
}

/// Returns the parameter index of a key, and checks that the key is allowed in this table.
int read_index(const TomlNode& table, std::string_view key, model::PlantKind plant,
               ParameterGroup group, const std::vector<std::string>& others) {
  const int index = model::parameter_index(plant, key);
  if (index >= 0 && belongs_to(model::parameter_spec(plant, index), group)) return index;
  if (index >= 0) {
    table.require(key, "a parameter")
        .fail(group == ParameterGroup::rig ? "is a controller parameter: expected in "
                                             "[rig.controller], or in `controller` of a condition"
                                           : "is not a controller parameter: expected in "
                                             "[rig.parameters], or in `parameters`");
  }
  const std::vector<std::string> owners = plants_with(key);
  if (!owners.empty())
    table.require(key, "a parameter")
        .fail(fmt::format("is a parameter of {}, and not of {}, which this rig is",
                          fmt::join(owners, " and "), to_string(plant)));
  std::vector<std::string> known = others;
  const auto keys = parameter_keys(plant, group);
  known.insert(known.end(), keys.begin(), keys.end());
  table.fail_unknown(key, "parameter", known);
}

std::optional<Prior> read_prior(const TomlNode& node, const model::ParameterSpec& spec) {
  const auto mean = node.find("prior");
  const auto sd = node.find("prior_sd");
  if (!mean && !sd) return std::nullopt;
  if (!sd) mean->fail("has no prior_sd beside it: expected the standard deviation of the prior");
  if (!mean) sd->fail("has no prior beside it: expected the mean of the prior");
  return Prior{read_value(*mean, spec), sd->difference(spec.unit, kParameterDeviations)};
}

void read_between_repeats(const TomlNode& node, const model::ParameterSpec& spec,
                          ParameterSetting& setting) {
  if (const auto problem = cannot_be_fitted(spec)) node.fail(*problem);
  differ_between_repeats(spec, node.difference(spec.unit, kParameterDeviations), setting);
}

/// @param value  form of the parameter's values
KeyTable<ParameterSetting> setting_keys(const KeyForm& value) {
  using Row = KeyRow<ParameterSetting>;
  KeyForm quantity = value;
  quantity.name = "quantity";
  KeyForm difference = plain_form(value.kind, "quantity");
  difference.units = value.units;
  if (difference.kind == KeyForm::Kind::number) {
    difference.lower = kParameterDeviations.lower;
    difference.upper = kParameterDeviations.upper;
  }
  return KeyTable<ParameterSetting>({
      Row::described(
          "start", quantity,
          {.doc = "Start of the fit; used as the value wherever the parameter is not fitted",
           .needed = "the value from which a fit starts"}),
      Row::described("lower", quantity,
                     {.doc = "Lower bound of the fit; `start` is not below it",
                      .otherwise = "a tenth of `start` (below)"}),
      Row::described("upper", quantity,
                     {.doc = "Upper bound of the fit; `start` is not above it",
                      .otherwise = "ten times `start` (below)"}),
      Row::flag("fit", &ParameterSetting::fit,
                {.doc = "Whether `rigcal fit` estimates it (`--free` names others)"}),
      Row::word<Scope>("scope", &ParameterSetting::scope,
                       {.doc = "One value for the rig, one per leak level, or one per condition"}),
      Row::described("prior", quantity,
                     {.doc = "Mean of the prior. Needs `prior_sd`", .otherwise = "none"}),
      Row::described("prior_sd", difference,
                     {.doc = "Standard deviation of `prior`. If the value is not fitted: its "
                             "standard uncertainty, which all standard errors include",
                      .otherwise = "none"}),
      Row::flag("nuisance", &ParameterSetting::nuisance,
                {.doc = "Estimated again in validation, and reported there"}),
      Row::described(
          "between_repeats", difference,
          {.doc = "Standard deviation with which the value varies at random from repeat to repeat "
                  "about `start`. It is estimated for every condition, as a nuisance parameter. "
                  "The standard deviation of its prior is this one over the root of the number of "
                  "repeats. Not with `fit`, `scope`, `prior` or `nuisance`; bounds are "
                  "eight standard deviations unless given",
           .otherwise = "none"}),
  });
}

/// Reads a table such as { start = ..., lower = ..., ... }.
void read_setting_table(const TomlNode& node, const model::ParameterSpec& spec,
                        ParameterSetting& setting) {
  static const KeyTable<ParameterSetting> keys = setting_keys(plain_form(KeyForm::Kind::quantity));
  node.allow_only(keys.names());
  const TomlNode start =
      node.require("start", fmt::format("the value from which a fit starts, in {}", spec.unit));
  setting.value = read_value(start, spec);
  const auto lower = node.find("lower");
  const auto upper = node.find("upper");
  if (lower) setting.lower = read_value(*lower, spec);
  if (upper) setting.upper = read_value(*upper, spec);
  if (lower && upper && !(setting.lower < setting.upper)) {
    lower->fail(fmt::format("lower ({}) is not below upper ({})", with_unit(spec, setting.lower),
                            with_unit(spec, setting.upper)));
  }
  if ((lower && setting.value < setting.lower) || (upper && setting.value > setting.upper)) {
    start.fail(fmt::format("{} is outside its own bounds {} to {}", with_unit(spec, setting.value),
                           lower ? with_unit(spec, setting.lower) : "(not given)",
                           upper ? with_unit(spec, setting.upper) : "(not given)"));
  }
  keys.read_rows(node, setting);
  if (const auto problem = cannot_be_fitted(spec); setting.fit && problem)
    node.require("fit", "true or false").fail(*problem);
  if (setting.scope == Scope::leak_level && spec.kind == model::ParameterKind::controller)
    node.require("scope", "a scope")
        .fail("a leak level cannot have its own controller: expected \"rig\" or \"condition\"");
  setting.prior = read_prior(node, spec);
  if (const auto between = node.find("between_repeats")) {
    for (const char* key : {"fit", "scope", "prior", "prior_sd", "nuisance"}) {
      if (const auto other = node.find(key))
        other->fail(
            "is combined with between_repeats, which implies it: the value varies at random from "
            "repeat to repeat about `start` and is estimated per condition");
    }
    read_between_repeats(*between, spec, setting);
  }
  if (!setting.fit) return;
  if (const auto problem = complete_bounds(spec, setting)) start.fail(*problem);
}

}  // namespace

void differ_between_repeats(const model::ParameterSpec& spec, double sd,
                            ParameterSetting& setting) {
  constexpr double kReach = 8.0;  // in standard deviations; no repeat differs more from the mean
  setting.between_repeats = true;
  setting.fit = true;
  setting.scope = Scope::condition;
  setting.nuisance = true;
  setting.prior = Prior{setting.value, sd};
  if (std::isnan(setting.lower)) setting.lower = std::max(spec.lower, setting.value - kReach * sd);
  if (std::isnan(setting.upper)) setting.upper = std::min(spec.upper, setting.value + kReach * sd);
}

std::vector<std::string> parameter_keys(model::PlantKind plant, ParameterGroup group) {
  std::vector<std::string> keys;
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    if (belongs_to(spec, group)) keys.emplace_back(spec.key);
  }
  return keys;
}

std::vector<CampaignKey> parameter_rows(ParameterGroup group, bool fitted) {
  std::vector<CampaignKey> rows;
  for (const std::string& plant : model::plant_names()) {
    for (const model::ParameterSpec& spec :
         model::parameter_table(model::plant_from_name(plant).value())) {
      if (!belongs_to(spec, group)) continue;
      if (find_key(rows, spec.key) == nullptr)
        rows.push_back(
            {std::string(spec.key), quantity_form(spec.unit), std::string(spec.meaning)});
      // A parameter that several plants share may differ between them in unit and limits.
      KeyForm& form = std::find_if(rows.begin(), rows.end(), [&](const CampaignKey& row) {
                        return row.key == spec.key;
                      })->form;
      if (form.kind == KeyForm::Kind::number) {
        form.lower = std::isfinite(form.lower) ? std::min(form.lower, spec.lower) : spec.lower;
        form.upper = std::isfinite(form.upper) ? std::max(form.upper, spec.upper) : spec.upper;
      } else if (std::find(form.units.begin(), form.units.end(), spec.unit) == form.units.end()) {
        form.units.emplace_back(spec.unit);
      }
    }
  }
  if (!fitted) return rows;
  for (CampaignKey& row : rows) {
    // The nested table omits the numeric limits, so that all parameters with the same unit share
    // one.
    KeyForm value = plain_form(row.form.kind);
    value.units = row.form.units;
    row.form = either_form({row.form, table_form(setting_keys(value).keys())}, "quantity or table");
  }
  return rows;
}

std::optional<std::string> outside_limits(const model::ParameterSpec& spec, double value) {
  if (value >= spec.lower && value <= std::min(spec.upper, kSizes.upper)) return std::nullopt;
  // Without a limit, such as the largest reading of a sensor, the value is infinity.
  if (value == spec.upper) return std::nullopt;
  return fmt::format("{} is not plausible for {} ({}): expected {} to {}", with_unit(spec, value),
                     spec.key, spec.meaning, with_unit(spec, spec.lower),
                     with_unit(spec, std::min(spec.upper, kSizes.upper)));
}

std::optional<std::string> complete_bounds(const model::ParameterSpec& spec,
                                           ParameterSetting& setting) {
  const double low = std::min(setting.value / 10.0, setting.value * 10.0);
  const double high = std::max(setting.value / 10.0, setting.value * 10.0);
  const bool zero = setting.value == 0.0;
  if (std::isnan(setting.lower)) setting.lower = zero ? spec.lower : std::max(spec.lower, low);
  if (std::isnan(setting.upper)) setting.upper = zero ? spec.upper : std::min(spec.upper, high);
  if (!std::isfinite(setting.lower) || !std::isfinite(setting.upper)) {
    return "a fit needs finite bounds here: expected `lower` and `upper`";
  }
  if (setting.lower < setting.upper && setting.value >= setting.lower &&
      setting.value <= setting.upper) {
    return std::nullopt;
  }
  return fmt::format("{} is outside the bounds {} to {}", with_unit(spec, setting.value),
                     with_unit(spec, setting.lower), with_unit(spec, setting.upper));
}

std::optional<std::string> cannot_be_fitted(const model::ParameterSpec& spec) {
  if (spec.can_be_fitted) return std::nullopt;
  return fmt::format("{} ({}) cannot be fitted: expected a known value", spec.key, spec.meaning);
}

std::vector<ParameterSetting> read_settings(const TomlNode& table, model::PlantKind plant,
                                            ParameterGroup group,
                                            const std::vector<std::string>& others) {
  std::vector<ParameterSetting> settings;
  for (const auto& [key, node] : table.entries()) {
    if (std::find(others.begin(), others.end(), key) != others.end()) continue;
    ParameterSetting setting;
    setting.index = read_index(table, key, plant, group, others);
    setting.lower = kNotGiven;
    setting.upper = kNotGiven;
    setting.where = node.where();
    const model::ParameterSpec& spec = model::parameter_spec(plant, setting.index);
    if (node.is_table()) {
      read_setting_table(node, spec, setting);
    } else {
      setting.value = read_value(node, spec);
    }
    settings.push_back(setting);
  }
  return settings;
}

bool has_entry(const Overrides& overrides, int index) {
  return std::any_of(overrides.begin(), overrides.end(),
                     [&](const auto& entry) { return entry.first == index; });
}

Overrides read_overrides(const TomlNode& table, model::PlantKind plant, ParameterGroup group) {
  Overrides overrides;
  for (const auto& [key, node] : table.entries()) {
    const int index = read_index(table, key, plant, group, {});
    if (node.is_table()) {
      node.fail_type(
          "a known value: fitted ones belong in [rig.parameters] or [rig.controller], "
          "with scope = \"leak_level\" or \"condition\" if it differs from run to run");
    }
    overrides.emplace_back(index, read_value(node, model::parameter_spec(plant, index)));
  }
  return overrides;
}

namespace {

std::optional<ParameterConflict> find_supply_conflict(const model::ParameterValues& values) {
  const bool resistance = values.is_given("supply_resistance");
  if (resistance == values.is_given("supply_capacity")) return std::nullopt;
  return ParameterConflict{resistance ? "supply_resistance" : "supply_capacity",
                           fmt::format("a supply whose pressure drops with flow needs both "
                                       "supply_resistance and supply_capacity: expected {} as well",
                                       resistance ? "supply_capacity" : "supply_resistance")};
}

/// Checks the keys of the valve drive: a spool follows either a voltage or a pilot pressure.
std::optional<ParameterConflict> find_pilot_conflict(const model::Rig& rig,
                                                     const model::ParameterValues& values) {
  const bool pilot = values.is_given("pilot_gain");
  if (pilot == values.is_given("valve_gain"))
    return ParameterConflict{
        pilot ? "pilot_gain" : "",
        fmt::format("{}: expected valve_gain (an electric valve, driven by the channel command) or "
                    "pilot_gain (a pilot-operated one, driven by pilot_pressure)",
                    pilot ? "pilot_gain and valve_gain are both given"
                          : "the gain of the valve is unknown")};
  if (pilot != rig.pilot)
    return ParameterConflict{"pilot_gain",
                             "pilot_gain decides what drives the rig, but only some conditions "
                             "have it: expected it in [rig.parameters]"};
  if (pilot && rig.controller != model::ControllerKind::none)
    return ParameterConflict{
        "pilot_gain",
        "the controller's output is a voltage, and pilot_gain makes the pilot pressure the drive: "
        "expected valve_gain, or type = \"none\" in [rig.controller] and the recorded "
        "pilot_pressure"};
  constexpr std::array kOfPilot{"pilot_dead_band", "pilot_range", "pilot_exponent",
                                "return_dead_band", "bypass_range"};
  constexpr std::array kOfVolts{
      std::pair{"valve_dead_band", "pilot_dead_band for an overlap"},
      std::pair{"valve_offset", "pilot_dead_band for an overlap"},
      std::pair{"valve_rate_limit", "the lag of the valve"},
      std::pair{"overlap_supply_to_a", "pilot_dead_band for an overlap"},
      std::pair{"overlap_a_to_tank", "return_dead_band for the overlap of edges to the tank"},
      std::pair{"overlap_supply_to_b", "pilot_dead_band for an overlap"},
      std::pair{"overlap_b_to_tank", "return_dead_band for the overlap of edges to the tank"},
      std::pair{"valve_null_opening", "valve_null_leakage for a leak"},
      std::pair{"valve_line_opening", "return_line_opening for the line to the tank"},
      std::pair{"valve_exponent", "pilot_exponent for a power law"},
      std::pair{"valve_range", "pilot_range"},
      std::pair{"valve_bypass_range", "bypass_range"}};
  for (const char* key : kOfPilot) {
    if (pilot || !values.is_given(key)) continue;
    return ParameterConflict{key, fmt::format("{} applies to a pilot-operated valve, but this one "
                                              "is driven by a voltage: expected pilot_gain",
                                              key)};
  }
  for (const auto& [key, instead] : kOfVolts) {
    if (!pilot || !values.is_given(key)) continue;
    return ParameterConflict{key, fmt::format("{} is in volts, but pilot_gain makes the pilot "
                                              "pressure the drive: expected {} instead",
                                              key, instead)};
  }
  return std::nullopt;
}

/// Checks that only one law describes the opening of a metering edge.
std::optional<ParameterConflict> find_opening_conflict(const model::ParameterValues& values) {
  constexpr std::array kTable{"opening_20", "opening_40", "opening_60", "opening_80"};
  const char* above = nullptr;
  for (const char* key : kTable) {
    for (const char* power : {"valve_exponent", "pilot_exponent"}) {
      if (values.is_given(key) && values.is_given(power))
        return ParameterConflict{key, fmt::format("{} (an opening by a table) is combined with "
                                                  "{} (by a power): expected one of them",
                                                  key, power)};
    }
    if (above != nullptr && values[key] < values[above])
      return ParameterConflict{key,
                               fmt::format("{} = {:g} is below {} = {:g}: expected openings that "
                                           "do not decrease (0.2, 0.4, 0.6 and 0.8 by default)",
                                           key, values[key], above, values[above])};
    above = key;
  }
  return std::nullopt;
}

/// A parameter that requires another one, and the reason, for messages.
struct Companion {
  const char* key;
  const char* needed;
  const char* why;
};

std::optional<ParameterConflict> find_pump_conflict(const model::ParameterValues& values) {
  constexpr std::array kCompanions{
      Companion{"pump_flow", "supply_resistance",
                "a pump of limited flow needs supply_resistance (its pressure drop up to full "
                "flow) and supply_capacity: expected both"},
      Companion{"bypass_opening", "supply_resistance",
                "a bypass flow acts through the pressure drop of the supply: expected "
                "supply_resistance and supply_capacity"},
      Companion{"load_sensing_margin", "supply_resistance",
                "a load-sensing pump needs supply_resistance (its pressure drop per flow) and "
                "supply_capacity: expected both"},
      Companion{"accumulator_volume", "supply_resistance",
                "an accumulator fills through supply_resistance, and the oil beside it has "
                "supply_capacity: expected both"},
      Companion{"accumulator_volume", "accumulator_precharge",
                "the gas law needs the pressure at which the gas has accumulator_volume: expected "
                "accumulator_precharge as well"},
      Companion{"accumulator_precharge", "accumulator_volume",
                "accumulator_precharge without an accumulator: expected accumulator_volume"},
      Companion{"accumulator_exponent", "accumulator_volume",
                "accumulator_exponent without an accumulator: expected accumulator_volume"},
      Companion{"bypass_range", "bypass_opening",
                "bypass_range without a bypass: expected bypass_opening"},
      Companion{"valve_bypass_range", "bypass_opening",
                "valve_bypass_range without a bypass: expected bypass_opening"},
      Companion{"relief_pressure", "relief_conductance",
                "a relief valve needs relief_conductance (its flow per pressure beyond "
                "relief_pressure): expected it as well"},
      Companion{"relief_conductance", "relief_pressure",
                "relief_conductance without a relief valve: expected relief_pressure"}};
  for (const Companion& row : kCompanions) {
    if (values.is_given(row.key) && !values.is_given(row.needed))
      return ParameterConflict{row.key, row.why};
  }
  constexpr std::array kSecond{"pump_second_flow", "pump_delay"};
  for (const char* key : {"pump_second_flow", "pump_delay", "pump_rise", "pump_first_rate"}) {
    if (!values.is_given(key)) continue;
    if (!values.is_given("pump_flow"))
      return ParameterConflict{key,
                               fmt::format("{} without a first flow: expected pump_flow", key)};
    for (const char* needed : kSecond) {
      if (values.is_given(needed)) continue;
      return ParameterConflict{key, fmt::format("a pump that rises to a second flow needs "
                                                "pump_second_flow and pump_delay: expected {} as "
                                                "well",
                                                needed)};
    }
  }
  return std::nullopt;
}

/// Checks the valve parameters of a two-chamber cylinder.
std::optional<ParameterConflict> find_metering_conflict(const model::Rig& rig,
                                                        const model::ParameterValues& values) {
  if (model::parameter_index(values.plant, "pilot_gain") < 0) return std::nullopt;
  if (const auto conflict = find_pilot_conflict(rig, values)) return conflict;
  return find_opening_conflict(values);
}

/// Parameters that belong together: the first that was given, and the first that was not.
struct Completeness {
  const char* present = nullptr;
  const char* absent = nullptr;
};

Completeness completeness(const model::ParameterValues& values, std::span<const char* const> keys) {
  Completeness found;
  for (const char* key : keys) {
    const char*& first = values.is_given(key) ? found.present : found.absent;
    if (first == nullptr) first = key;
  }
  return found;
}

constexpr std::array kPolynomialKeys{"lever", "lever_gradient", "lever_curvature"};
constexpr std::array kTriangleKeys{"triangle_base", "triangle_arm", "triangle_angle"};
constexpr std::array kTravelKeys{"travel_0",  "travel_20", "travel_40",
                                 "travel_60", "travel_80", "travel_100"};
constexpr std::array kTravelTableKeys{"travel_table_from", "travel_table_to", "travel_0",
                                      "travel_20",         "travel_40",       "travel_60",
                                      "travel_80",         "travel_100"};

/// Checks that a rig that turns has either a cylinder on a linkage or a rotary actuator.
std::optional<ParameterConflict> find_actuator_conflict(const model::ParameterValues& values) {
  constexpr std::array kAreas{"area_a", "area_b"};
  if (!values.is_given("displacement_per_radian")) {
    const char* const absent = completeness(values, kAreas).absent;
    if (absent == nullptr) return std::nullopt;
    return ParameterConflict{
        "", fmt::format("no value for {}: expected a known value or a start in [rig.parameters], "
                        "or displacement_per_radian of a rotary actuator",
                        absent)};
  }
  for (const auto& keys :
       {std::span<const char* const>(kAreas), std::span<const char* const>(kPolynomialKeys),
        std::span<const char* const>(kTriangleKeys),
        std::span<const char* const>(kTravelTableKeys)}) {
    const char* const present = completeness(values, keys).present;
    if (present == nullptr) continue;
    return ParameterConflict{
        present, fmt::format("{} applies to a cylinder on a linkage, but displacement_per_radian "
                             "makes the rig a rotary actuator: expected only one of them",
                             present)};
  }
  constexpr std::array kOfPiston{"coulomb_friction",   "stribeck_friction", "stribeck_velocity",
                                 "friction_smoothing", "seal_friction",     "bristle_stiffness",
                                 "bristle_damping",    "film_velocity",     "film_growth_time",
                                 "film_decay_time",    "film_dwell_time"};
  if (const char* const present = completeness(values, kOfPiston).present)
    return ParameterConflict{
        present, fmt::format("{} is friction of a piston that slides, in newtons and metres, but "
                             "displacement_per_radian makes the rig a rotary actuator, whose "
                             "friction is a moment: expected joint_friction",
                             present)};
  return std::nullopt;
}

/// Checks that exactly one law gives the travel of the piston over the angle, and that it is
/// complete.
std::optional<ParameterConflict> find_travel_law_conflict(const model::ParameterValues& values) {
  struct Law {
    const char* name;
    const char* needs;
    Completeness keys;
  };
  const std::array laws{
      Law{"a polynomial", "lever", completeness(values, kPolynomialKeys)},
      Law{"a triangle", "triangle_base, triangle_arm and triangle_angle",
          completeness(values, kTriangleKeys)},
      Law{"a table",
          "travel_table_from, travel_table_to and the travels travel_0, travel_20, travel_40, "
          "travel_60, travel_80 and travel_100",
          completeness(values, kTravelTableKeys)}};
  const Law* chosen = nullptr;
  for (const Law& law : laws) {
    if (law.keys.present == nullptr) continue;
    if (chosen != nullptr)
      return ParameterConflict{
          law.keys.present,
          fmt::format("{} (the travel of the piston by {}) is combined with {} (by {}): expected "
                      "one of them",
                      law.keys.present, law.name, chosen->keys.present, chosen->name)};
    chosen = &law;
  }
  if (chosen == nullptr)
    return ParameterConflict{"",
                             "the travel of the piston per angle is unknown: expected lever, or a "
                             "triangle (triangle_base, triangle_arm, triangle_angle), or a table "
                             "(travel_table_from, travel_table_to, travel_0 to travel_100)"};
  const bool whole =
      chosen == laws.data() ? values.is_given("lever") : chosen->keys.absent == nullptr;
  if (whole) return std::nullopt;
  return ParameterConflict{
      chosen->keys.present,
      fmt::format("the travel of the piston by {} needs {}: expected {} as well", chosen->name,
                  chosen->needs, chosen == laws.data() ? "lever" : chosen->keys.absent)};
}

/// Checks that the angle of the triangle stays between 0 and pi, where the cylinder is shortest and
/// longest.
std::optional<ParameterConflict> find_triangle_conflict(const model::ParameterValues& values) {
  constexpr double kPi = std::numbers::pi;
  const double sign = values["triangle_angle"] < 0.0 ? -1.0 : 1.0;
  for (const char* stop : {"lower_stop", "upper_stop"}) {
    const double psi = values["triangle_angle"] + values[stop] - values["reference_angle"];
    if (sign * psi > 0.0 && sign * psi < kPi) continue;
    return ParameterConflict{
        "triangle_angle",
        fmt::format(
            "the angle between triangle_base and triangle_arm is {:g} rad at {}: expected "
            "one between {:g} and {:g} rad from stop to stop, where the cylinder has a "
            "lever{}",
            psi, stop, std::min(0.0, sign * kPi), std::max(0.0, sign * kPi),
            sign > 0.0 ? " (a negative triangle_angle if it shortens as the angle grows)" : "")};
  }
  return std::nullopt;
}

/// Checks that the travel by a table rises from each value to the next.
std::optional<ParameterConflict> find_travel_table_conflict(const model::ParameterValues& values) {
  if (!(values["travel_table_to"] > values["travel_table_from"]))
    return ParameterConflict{
        "travel_table_to",
        fmt::format("travel_table_to = {:g} rad is not above travel_table_from = {:g} rad",
                    values["travel_table_to"], values["travel_table_from"])};
  for (std::size_t i = 1; i < kTravelKeys.size(); ++i) {
    const char* const before = kTravelKeys[i - 1];
    if (values[kTravelKeys[i]] > values[before]) continue;
    return ParameterConflict{
        kTravelKeys[i],
        fmt::format("{} = {:g} m is not above {} = {:g} m: expected a travel that grows with the "
                    "angle (chamber A is the one that raises the angle)",
                    kTravelKeys[i], values[kTravelKeys[i]], before, values[before])};
  }
  return std::nullopt;
}

/// Checks that the lever is positive everywhere between the stops.
std::optional<ParameterConflict> find_joint_conflict(const model::ParameterValues& values) {
  const double lower = values["lower_stop"];
  const double upper = values["upper_stop"];
  if (!(upper > lower))
    return ParameterConflict{
        "upper_stop",
        fmt::format("upper_stop = {:g} rad is not above lower_stop = {:g} rad", upper, lower)};
  if (const auto conflict = find_actuator_conflict(values)) return conflict;
  if (values.is_given("displacement_per_radian")) return std::nullopt;
  if (const auto conflict = find_travel_law_conflict(values)) return conflict;
  if (values.is_given("triangle_base")) return find_triangle_conflict(values);
  if (values.is_given("travel_table_to")) return find_travel_table_conflict(values);
  const double d1 = values["lever_gradient"];
  const double d2 = values["lever_curvature"];
  std::vector<double> angles{lower, upper};
  const double turn = d2 == 0.0 ? lower : values["reference_angle"] - 0.5 * d1 / d2;
  if (turn > lower && turn < upper) angles.push_back(turn);
  for (const double angle : angles) {
    const double from = angle - values["reference_angle"];
    const double lever = values["lever"] + (d1 + d2 * from) * from;
    if (lever > 0.0) continue;
    return ParameterConflict{
        "lever", fmt::format("the lever is {:g} m/rad at {:g} rad, between the stops: expected one "
                             "above 0 in all of the range (chamber A is the one that raises the "
                             "angle)",
                             lever, angle)};
  }
  return std::nullopt;
}

/// Checks that a second mass has either all or none of its parameters.
std::optional<ParameterConflict> find_payload_conflict(const model::ParameterValues& values) {
  constexpr std::array kKeys{"payload_mass", "payload_frequency", "payload_damping_ratio"};
  const char* present = nullptr;
  const char* absent = nullptr;
  for (const char* key : kKeys) (values.is_given(key) ? present : absent) = key;
  if (present == nullptr) return std::nullopt;
  if (absent != nullptr)
    return ParameterConflict{present,
                             fmt::format("a second mass needs payload_mass, payload_frequency and "
                                         "payload_damping_ratio: expected {} as well",
                                         absent)};
  return std::nullopt;
}

/// Checks that a load table is complete and increases in position, and that no polynomial describes
/// the same load.
std::optional<ParameterConflict> find_load_conflict(const model::ParameterValues& values) {
  constexpr std::array kKeys{"load_table_from", "load_table_to", "load_0",  "load_20",
                             "load_40",         "load_60",       "load_80", "load_100"};
  const auto [present, absent] = completeness(values, kKeys);
  if (present == nullptr) return std::nullopt;
  if (absent != nullptr)
    return ParameterConflict{
        present, fmt::format("a load by a table needs load_table_from, load_table_to and the loads "
                             "load_0, load_20, load_40, load_60, load_80 and load_100: expected {} "
                             "as well",
                             absent)};
  if (!(values["load_table_to"] > values["load_table_from"]))
    return ParameterConflict{
        "load_table_to", fmt::format("load_table_to = {:g} m is not above load_table_from = {:g} m",
                                     values["load_table_to"], values["load_table_from"])};
  for (const char* key : {"load_gradient", "load_curvature"}) {
    if (values.is_given(key))
      return ParameterConflict{key, fmt::format("{} (a load by a polynomial) is combined with "
                                                "load_table_to (by a table): expected one of them",
                                                key)};
  }
  return std::nullopt;
}

/// Checks that what depends on the temperature of the oil has the temperature at which the given
/// values hold.
std::optional<ParameterConflict> find_temperature_conflict(const model::ParameterValues& values) {
  if (values.is_given("reference_temperature")) return std::nullopt;
  for (const char* key :
       {"oil_temperature", "viscosity_decay", "thermal_expansion", "bulk_modulus_decay"}) {
    if (values.is_given(key))
      return ParameterConflict{key, fmt::format("{} without reference_temperature: expected the "
                                                "temperature at which density, bulk modulus, "
                                                "damping and laminar leaks have the given values",
                                                key)};
  }
  return std::nullopt;
}

/// Checks the parameters of pre-sliding friction. It needs the sliding force, and replaces the
/// smoothed sign function.
std::optional<ParameterConflict> find_bristle_conflict(const model::ParameterValues& values) {
  if (values.is_given("bristle_damping") && !values.is_given("bristle_stiffness"))
    return ParameterConflict{"bristle_damping",
                             "bristle_damping without pre-sliding: expected bristle_stiffness"};
  constexpr std::array kFilm{"film_velocity",   "film_growth_time",  "film_decay_time",
                             "film_dwell_time", "bristle_stiffness", "stribeck_friction"};
  const auto [film, absent] = completeness(values, std::span(kFilm).first(4));
  if (film != nullptr) {
    const char* lacks = absent != nullptr ? absent : completeness(values, kFilm).absent;
    if (lacks != nullptr)
      return ParameterConflict{
          film, fmt::format("friction that follows the lubricant film needs film_velocity, "
                            "film_growth_time, film_decay_time and film_dwell_time, beside "
                            "bristle_stiffness and stribeck_friction: expected {} as well",
                            lacks)};
  }
  if (!values.is_given("bristle_stiffness")) return std::nullopt;
  if (!values.is_given("coulomb_friction"))
    return ParameterConflict{"bristle_stiffness",
                             "friction with pre-sliding needs the force at which it slides: "
                             "expected coulomb_friction as well"};
  return std::nullopt;
}

/// Checks that the solver of the plant has room for all states. Terms that add states are listed in
/// the message.
std::optional<ParameterConflict> find_room_conflict(const model::Rig& rig,
                                                    const model::ParameterValues& values) {
  const model::StateCount count = model::count_states(rig, values);
  if (count.needed <= count.room) return std::nullopt;
  const model::FeedbackRow& loop = model::gain_keys(rig.feedback);
  std::vector<std::string_view> terms{"hose_yield",       "hose_yield_ratio", "payload_mass",
                                      "pump_second_flow", "main_spool_gain",  "bristle_stiffness",
                                      "film_velocity"};
  if (!model::is_three_variable(rig.feedback))  // its generator has two states in any case
    terms.insert(terms.end(), {loop.acceleration_feedforward, loop.velocity_feedforward, loop.kd});
  terms.insert(terms.end(), {"sample_time", loop.ki});
  std::vector<std::string_view> present;
  for (const std::string_view key : terms) {
    if (!key.empty() && values.is_given(key)) present.push_back(key);
  }
  return ParameterConflict{
      present.empty() ? "" : std::string(present.front()),
      fmt::format("the rig has {} states, and the solver of the plant {} has room for {}: expected "
                  "fewer of {}",
                  count.needed, to_string(values.plant), count.room, fmt::join(present, ", "))};
}

/// Checks the keys of the reference generator: three-variable control needs all of them, and has no
/// other filter.
std::optional<ParameterConflict> find_generator_conflict(const model::Rig& rig,
                                                         const model::ParameterValues& values) {
  const model::FeedbackRow& loop = model::gain_keys(rig.feedback);
  if (model::is_three_variable(rig.feedback) && values.is_given("derivative_filter"))
    return ParameterConflict{"derivative_filter",
                             fmt::format("derivative_filter filters the derivative of an error, "
                                         "which a loop on {} does not use: remove it",
                                         loop.name)};
  for (const char* key : {"reference_frequency", "reference_damping_ratio"}) {
    if (model::is_three_variable(rig.feedback) == values.is_given(key)) continue;
    if (values.is_given(key))
      return ParameterConflict{
          key, fmt::format("{} belongs to three-variable control, but this loop is on {}: expected "
                           "feedback = \"three_variable\" or \"three_variable_acceleration\"",
                           key, loop.name)};
    return ParameterConflict{"", fmt::format("a loop on {} has no {}: expected reference_frequency "
                                             "and reference_damping_ratio in [rig.controller], "
                                             "the corner and the damping of the generator of its "
                                             "references",
                                             loop.name, key)};
  }
  return std::nullopt;
}

/// Checks that a feed-forward belongs to the loop, and has its filter.
std::optional<ParameterConflict> find_feedforward_conflict(const model::FeedbackRow& loop,
                                                           const model::ParameterValues& values) {
  for (const model::FeedbackRow& row : model::kFeedbacks) {
    for (const std::string_view key : {row.velocity_feedforward, row.acceleration_feedforward}) {
      if (key.empty() || !values.is_given(key)) continue;
      if (key != loop.velocity_feedforward && key != loop.acceleration_feedforward)
        return ParameterConflict{
            std::string(key),
            fmt::format(
                "{} feeds the rate of {} forward, but this loop is on {}: expected feedback = "
                "\"{}\"",
                key,
                row.kp == model::gain_keys(model::Feedback::angle).kp ? "an angle" : "a position",
                loop.name, row.name)};
      if (!values.is_given("derivative_filter"))
        return ParameterConflict{
            std::string(key), fmt::format("{} without derivative_filter: expected the corner N of "
                                          "its filter, such as derivative_filter = \"500 rad/s\"",
                                          key)};
    }
  }
  return std::nullopt;
}

/// Checks that a loop has the gains for its controlled quantity, and no others.
std::optional<ParameterConflict> find_loop_conflict(const model::Rig& rig,
                                                    const model::ParameterValues& values) {
  const model::FeedbackRow& loop = model::gain_keys(rig.feedback);
  for (const model::FeedbackRow& other : model::kFeedbacks) {
    if (other.name == loop.name) continue;
    for (const auto& [key, own] : {std::pair{other.kp, loop.kp}, std::pair{other.ki, loop.ki},
                                   std::pair{other.kd, loop.kd}}) {
      const bool shared = key == loop.kp || key == loop.ki || key == loop.kd;
      if (!values.is_given(key) || shared || key == loop.acceleration) continue;
      return ParameterConflict{std::string(key),
                               fmt::format("{0} is a gain of a loop on {1}, but this one is on "
                                           "{2}: expected {3}, or feedback = \"{1}\"",
                                           key, other.name, loop.name, own)};
    }
  }
  const bool of_motion = loop.kp == model::gain_keys(model::Feedback::position).kp ||
                         rig.feedback == model::Feedback::angle;
  if (!values.is_given(loop.kp) && !(values.is_given(loop.ki) && !of_motion)) {
    return ParameterConflict{
        "", fmt::format("the pid controller has no {}: expected one in [rig.controller]", loop.kp)};
  }
  if (const auto conflict = find_generator_conflict(rig, values)) return conflict;
  const bool generator = model::is_three_variable(rig.feedback);
  if (values.is_given(loop.kd) && !generator && !values.is_given("derivative_filter")) {
    return ParameterConflict{
        std::string(loop.kd),
        fmt::format("{} without derivative_filter: expected the corner N of its filter, such as "
                    "derivative_filter = \"500 rad/s\"",
                    loop.kd)};
  }
  if (!generator) {
    if (const auto conflict = find_feedforward_conflict(loop, values)) return conflict;
  }
  if (values.is_given("initial_integral") && !values.is_given(loop.ki))
    return ParameterConflict{"initial_integral",
                             fmt::format("initial_integral without integral action: expected {} in "
                                         "[rig.controller]",
                                         loop.ki)};
  return std::nullopt;
}

}  // namespace

std::optional<ParameterConflict> find_conflict(const model::Rig& rig,
                                               const model::ParameterValues& values) {
  if (const auto missing = values.missing(); !missing.empty()) {
    return ParameterConflict{"", fmt::format("no value for {}: expected a known value or a start "
                                             "in [rig.parameters]",
                                             fmt::join(missing, ", "))};
  }
  if (values.is_given("valve_time_constant") && values.is_given("valve_frequency")) {
    return ParameterConflict{"valve_time_constant",
                             "valve_time_constant (a first-order valve) is combined with "
                             "valve_frequency (a second-order one): expected one of them"};
  }
  if (values.is_given("valve_frequency") != values.is_given("valve_damping_ratio")) {
    const bool frequency = values.is_given("valve_frequency");
    return ParameterConflict{
        frequency ? "valve_frequency" : "valve_damping_ratio",
        fmt::format("a second-order valve needs both valve_frequency and valve_damping_ratio: "
                    "expected {} as well",
                    frequency ? "valve_damping_ratio" : "valve_frequency")};
  }
  if (values.is_given("main_spool_gain") && !values.is_given("valve_time_constant") &&
      !values.is_given("valve_frequency")) {
    return ParameterConflict{"main_spool_gain",
                             "main_spool_gain without the lag of the pilot stage: expected "
                             "valve_time_constant, or valve_frequency, as well"};
  }
  if (values.is_given("main_spool_gain") && values.is_given("pilot_gain")) {
    return ParameterConflict{"main_spool_gain",
                             "main_spool_gain (a main spool with position feedback) is combined "
                             "with pilot_gain (a spool that a pilot pressure moves against its "
                             "spring): expected one of them"};
  }
  if (values.is_given("valve_rate_limit") && !values.is_given("valve_time_constant") &&
      !values.is_given("valve_frequency")) {
    return ParameterConflict{"valve_rate_limit",
                             "valve_rate_limit without the valve's own lag: expected "
                             "valve_time_constant, or valve_frequency, as well"};
  }
  if (const auto conflict = find_supply_conflict(values)) return conflict;
  if (const auto conflict = find_payload_conflict(values)) return conflict;
  if (values.plant == model::PlantKind::linkage) {
    if (const auto conflict = find_joint_conflict(values)) return conflict;
  }
  if (const auto conflict = find_metering_conflict(rig, values)) return conflict;
  if (const auto conflict = find_pump_conflict(values)) return conflict;
  if (const auto conflict = find_bristle_conflict(values)) return conflict;
  if (const auto conflict = find_load_conflict(values)) return conflict;
  if (const auto conflict = find_temperature_conflict(values)) return conflict;
  if (rig.controller != model::ControllerKind::none) {
    if (const auto conflict = find_loop_conflict(rig, values)) return conflict;
  }
  return find_room_conflict(rig, values);
}

}  // namespace rigcal::datasets
