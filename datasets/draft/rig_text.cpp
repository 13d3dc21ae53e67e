#include "datasets/draft/rig_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "datasets/campaign/toml/toml_reader.hpp"
#include "datasets/draft/draft_comment.hpp"
#include "model/plant/parameter.hpp"

namespace rigcal::datasets {
namespace {

/// Optional terms that most two-chamber cylinders have.
constexpr std::array<std::string_view, 15> kTwoChamberTerms{
    "retracted_position", "valve_dead_band",    "valve_time_constant", "transport_delay",
    "gain_b_to_tank",     "valve_null_leakage", "laminar_leakage",     "gravity",
    "external_force",     "load_gradient",      "coulomb_friction",    "bristle_stiffness",
    "air_fraction",       "stop_stiffness",     "make_up_conductance"};

/// Optional terms for a servo valve with a symmetric cylinder.
constexpr std::array<std::string_view, 8> kLoadPressureTerms{
    "valve_offset",       "valve_dead_band", "valve_time_constant", "transport_delay",
    "valve_null_leakage", "laminar_leakage", "external_force",      "coulomb_friction"};

/// Optional terms for a joint.
constexpr std::array<std::string_view, 16> kLinkageTerms{"reference_angle",
                                                         "lever_gradient",
                                                         "lever_curvature",
                                                         "gravity_moment",
                                                         "joint_friction",
                                                         "gravity_moment_gradient",
                                                         "gravity_moment_curvature",
                                                         "stop_stiffness",
                                                         "valve_time_constant",
                                                         "gain_a_to_tank",
                                                         "gain_b_to_tank",
                                                         "make_up_conductance",
                                                         "supply_resistance",
                                                         "supply_capacity",
                                                         "pump_flow",
                                                         "air_fraction"};

/// A rotary actuator in place of cylinder and lever, or the travel of the piston by a triangle or a
/// table in place of the lever.
constexpr std::array<std::string_view, 12> kTravelTerms{"displacement_per_radian",
                                                        "triangle_base",
                                                        "triangle_arm",
                                                        "triangle_angle",
                                                        "travel_table_from",
                                                        "travel_table_to",
                                                        "travel_0",
                                                        "travel_20",
                                                        "travel_40",
                                                        "travel_60",
                                                        "travel_80",
                                                        "travel_100"};

/// Terms for the pump and check valves behind a pilot-operated valve.
constexpr std::array<std::string_view, 8> kPumpTerms{
    "relief_pressure",  "supply_resistance", "supply_capacity",     "pump_flow",
    "pump_second_flow", "pump_delay",        "load_sensing_margin", "compensator_pressure"};

/// Terms for a valve that is driven by a pilot pressure.
constexpr std::array<std::string_view, 6> kPilotTerms{
    "pilot_dead_band",     "pilot_exponent",         "return_exponent",
    "return_line_opening", "return_line_resistance", "bypass_opening"};

/// Friction that grows with a pressure and a leak that a line throttles, proposed if pressures of
/// the cylinder were recorded: they show both.
constexpr std::array<std::string_view, 1> kLeakLineTerms{"leakage_resistance"};
constexpr std::array<std::string_view, 1> kSealTerms{"seal_friction"};

/// Friction of the cylinder of a joint, proposed with that of its seals: in newtons, apart from the
/// moment of the joint.
constexpr std::array<std::string_view, 2> kJointSealTerms{"coulomb_friction", "bristle_stiffness"};

/// A load that varies along the travel, proposed if a position and pressures were recorded.
constexpr std::array<std::string_view, 2> kLoadGradientTerms{"load_gradient", "load_curvature"};

/// Terms for an electric valve whose command was recorded: its opening is not in proportion to it,
/// or does not depend on the load. Four edges only.
constexpr std::array<std::string_view, 7> kOpeningTerms{
    "valve_exponent", "valve_range", "opening_20",          "opening_40",
    "opening_60",     "opening_80",  "compensator_pressure"};

/// The second stage of a valve, proposed if the position of a spool was recorded.
constexpr std::array<std::string_view, 1> kTwoStageTerms{"main_spool_gain"};

/// A supply whose pressure varies, proposed if it was recorded.
constexpr std::array<std::string_view, 5> kSupplyTerms{"supply_resistance", "supply_capacity",
                                                       "pump_flow", "accumulator_volume",
                                                       "accumulator_precharge"};

/// A pump that changes its flow or its pressure, proposed with them. Four edges only.
constexpr std::array<std::string_view, 3> kPumpControlTerms{"pump_second_flow", "pump_delay",
                                                            "load_sensing_margin"};

/// A load by a table, proposed if position and both chamber pressures were recorded: they show how
/// the load varies with the travel.
constexpr std::array<std::string_view, 8> kLoadTableTerms{
    "load_table_from", "load_table_to", "load_0",  "load_20",
    "load_40",         "load_60",       "load_80", "load_100"};

/// Optional terms for a rig with a payload, proposed if an acceleration was recorded.
constexpr std::array<std::string_view, 3> kPayloadTerms{"payload_mass", "payload_frequency",
                                                        "payload_damping_ratio"};

/// Oil that follows its temperature, proposed if a temperature was recorded.
constexpr std::array<std::string_view, 4> kWarmOilTerms{"reference_temperature", "viscosity_decay",
                                                        "thermal_expansion", "bulk_modulus_decay"};

/// Lists optional terms, as comments.
std::string terms_text(model::PlantKind plant, const RecordedSigns& signs) {
  std::vector<std::string_view> terms(kLoadPressureTerms.begin(), kLoadPressureTerms.end());
  if (plant == model::PlantKind::two_chamber)
    terms.assign(kTwoChamberTerms.begin(), kTwoChamberTerms.end());
  if (plant == model::PlantKind::linkage) {
    terms.assign(kLinkageTerms.begin(), kLinkageTerms.end());
    terms.insert(terms.end(), kTravelTerms.begin(), kTravelTerms.end());
  }
  // A key of two lists occurs once.
  const auto add = [&terms](std::span<const std::string_view> keys) {
    for (const std::string_view key : keys)
      if (std::find(terms.begin(), terms.end(), key) == terms.end()) terms.push_back(key);
  };
  if (signs.pilot && plant == model::PlantKind::two_chamber) {
    // A dead band in volts does not apply to this valve.
    terms.erase(std::remove(terms.begin(), terms.end(), "valve_dead_band"), terms.end());
  }
  if (signs.pilot) {
    add(kPumpTerms);
    add(kPilotTerms);
  }
  const bool slides = plant != model::PlantKind::linkage;
  const bool four_edges = plant != model::PlantKind::load_pressure;
  if (signs.spool) add(kTwoStageTerms);
  if (signs.command && four_edges) add(kOpeningTerms);
  if (signs.supply) add(kSupplyTerms);
  if (signs.supply && four_edges) add(kPumpControlTerms);
  if (signs.pressures) add(kLeakLineTerms);
  if (signs.pressures) add(kSealTerms);
  if (signs.pressures && !slides) add(kJointSealTerms);
  if (signs.pressures && signs.position && slides) add(kLoadGradientTerms);
  if (signs.load_table) add(kLoadTableTerms);
  if (signs.payload) add(kPayloadTerms);
  if (signs.temperature) add(kWarmOilTerms);
  std::string text = "# Terms that are absent unless given (rigcal params lists all):\n";
  for (const std::string_view key : terms) {
    const model::ParameterSpec& spec =
        model::parameter_spec(plant, model::parameter_index(plant, key));
    text += fmt::format("# {} = {}{}\n", key,
                        spec.unit == "1" ? "..." : fmt::format("\"... {}\"", spec.unit),
                        comment(fmt::format("{}: {}", spec.symbol, spec.meaning)));
  }
  return text;
}

std::string model_text(model::PlantKind plant) {
  switch (plant) {
    case model::PlantKind::load_pressure:
      return "model = \"load_pressure\"  # a symmetric cylinder on one servo-valve\n";
    case model::PlantKind::two_chamber:
      return "model = \"two_chamber\"  # single-rod or double-rod, with both chamber pressures\n";
    case model::PlantKind::linkage:
      return "model = \"linkage\"  # a cylinder that turns an arm; chamber A is the one whose "
             "pressure raises the angle\n";
  }
  return {};
}

}  // namespace

std::string rig_text(model::PlantKind plant, std::optional<model::Feedback> loop,
                     const RecordedSigns& signs) {
  std::string text = "[rig]\n" + model_text(plant);
  text +=
      "# Fit what the data sheet does not give: { start = ..., lower = ..., upper = ..., fit = "
      "true }\n"
      "# A value that is not fitted counts as exact unless its uncertainty is given: { start = "
      "..., "
      "prior = ..., prior_sd = ... }\n[rig.parameters]\n";
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    // A valve with four metering edges has one of two gains, depending on what drives it.
    // A linkage may have a triangle or a table in place of its lever, or a rotary actuator in place
    // of the cylinder.
    const bool needed = spec.key == "lever" || spec.key == "area_a" || spec.key == "area_b" ||
                        (plant != model::PlantKind::load_pressure &&
                         spec.key == std::string_view(signs.pilot ? "pilot_gain" : "valve_gain"));
    if (!needed && (spec.kind != model::ParameterKind::plant || spec.default_value)) continue;
    const std::string blank = spec.unit == "1"
                                  ? toml_quoted(kBlank)
                                  : toml_quoted(fmt::format("{} {}", kBlank, spec.unit));
    const bool of_cylinder = plant == model::PlantKind::linkage &&
                             (spec.key == "lever" || spec.key == "area_a" || spec.key == "area_b");
    text += fmt::format(
        "{} = {}{}\n", spec.key, blank,
        comment(fmt::format("{}: {}{}", spec.symbol, spec.meaning,
                            spec.unit == "1" ? " (a plain number)"
                            : of_cylinder    ? "; a rotary actuator has none, but "
                                               "displacement_per_radian, such as \"50 cm3/rev\""
                                             : "")));
  }
  text += terms_text(plant, signs);
  if (!loop)
    return text + fmt::format(
                      "[rig.controller]\ntype = \"none\"  # the recorded {} drives the "
                      "valve\n",
                      signs.pilot ? "pilot pressure" : "command");
  const model::FeedbackRow& row = model::gain_keys(*loop);
  const auto unit_of = [&](std::string_view key) {
    return model::parameter_spec(plant, model::parameter_index(plant, key)).unit;
  };
  text += "[rig.controller]\ntype = \"pid\"\n";
  if (*loop != model::Feedback::position)
    text += fmt::format(
        "feedback = \"{}\"{}\n", row.name,
        comment(fmt::format("what the loop controls; {} unless given",
                            plant == model::PlantKind::linkage ? "angle" : "position")));
  text += fmt::format("{} = \"{} {}\"{}\n", row.kp, kBlank, unit_of(row.kp),
                      comment("proportional gain; output_limit, sample_time if there are any"));
  text += fmt::format(
      "# {} = \"... {}\"{}\n", row.ki, unit_of(row.ki),
      comment(fmt::format(
          "integral gain: without it the model lags where the machine does not; {} likewise",
          row.kd)));
  const auto gain = [&](std::string_view key, const char* meaning) {
    text += fmt::format("# {} = \"... {}\"{}\n", key, unit_of(key), comment(meaning));
  };
  if (signs.pressures)
    gain("pressure_feedback", "inner loop on the pressure difference, for damping");
  if (!row.velocity_feedforward.empty()) {
    gain(row.velocity_feedforward, "feedforward gain on the rate of the reference");
    gain(row.acceleration_feedforward, "feedforward gain on the rate of that rate");
  }
  const bool acceleration = *loop == model::Feedback::acceleration;
  if (!signs.payload || !(acceleration || *loop == model::Feedback::position)) return text;
  const auto& table = model::gain_keys(acceleration ? model::Feedback::three_variable_acceleration
                                                    : model::Feedback::three_variable);
  return text + fmt::format("# feedback = \"{}\"{}\n", table.name,
                            comment(fmt::format("the controller of many shake tables: with {}, {}, "
                                                "{}, reference_frequency, reference_damping_ratio",
                                                table.kp, table.kd, table.acceleration)));
}

}  // namespace rigcal::datasets
