#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::kExample;
using rigcal::test::load_text;
using rigcal::test::replaced;

namespace {

// Unit conversions round once or twice.
constexpr double kRounding = 1e-14;

const ParameterSetting& setting_of(const Campaign& campaign, std::string_view key) {
  const auto* setting = campaign.setting(model::parameter_index(campaign.rig.plant, key));
  REQUIRE(setting != nullptr);
  return *setting;
}

}  // namespace

TEST_CASE("load_campaign: the example of the contract", "[datasets]") {
  const Campaign campaign = load_text(kExample);
  CHECK(campaign.name == "UIS shake table");
  CHECK_FALSE(campaign.synthetic);
  CHECK(campaign.rig.plant == model::PlantKind::load_pressure);
  CHECK(campaign.rig.controller == model::ControllerKind::pid);
  CHECK(campaign.rig.initial == model::InitialState::rest);
  CHECK(campaign.separator == ',');
  CHECK(campaign.time_column == "t_s");

  const ParameterSetting& mass = setting_of(campaign, "mass");
  CHECK(mass.fit);
  CHECK(mass.value == 60.0);
  CHECK(mass.lower == 10.0);
  CHECK(mass.upper == 500.0);
  CHECK_FALSE(setting_of(campaign, "supply_pressure").fit);
  CHECK_THAT(setting_of(campaign, "supply_pressure").value, WithinRel(6.2e6, kRounding));
  CHECK_THAT(setting_of(campaign, "piston_area").value, WithinRel(633e-6, kRounding));
  const auto& prior = setting_of(campaign, "damping").prior;
  REQUIRE(prior.has_value());
  CHECK(prior->mean == 900.0);
  CHECK(prior->sd == 100.0);
  CHECK(setting_of(campaign, "leakage_coefficient").scope == Scope::leak_level);
  CHECK(setting_of(campaign, "position_offset").nuisance);
  CHECK(setting_of(campaign, "position_offset").scope == Scope::condition);
  CHECK(setting_of(campaign, "kp").value == 78.74);

  REQUIRE(campaign.conditions.size() == 2);
  const Condition& sine = campaign.conditions[0];
  CHECK(sine.waveform == Waveform::sine);
  CHECK(sine.frequency_hz == 0.1);
  CHECK_THAT(sine.amplitude.value(), WithinRel(0.0508, kRounding));
  CHECK(sine.leak_level == "33.33 %");
  CHECK(sine.repeats.at(0).file == "records/sine_0.1Hz_33_*.csv");
  const Condition& steps = campaign.conditions[1];
  CHECK(steps.use == Use::validate);
  REQUIRE(steps.repeats.size() == 2);
  CHECK(steps.repeats[0].numbers.size() == 10);
  CHECK(steps.repeats[0].numbers.front() == "01");
  CHECK(steps.repeats[0].numbers.back() == "10");
  CHECK(steps.repeats[1].columns.at(Channel::pressure_b) == "pB_bar_{n}");
  REQUIRE(steps.windows.size() == 1);
  CHECK(steps.windows[0].end_s == 12.0);
  CHECK_THAT(steps.temperature_k.value(), WithinRel(311.15, kRounding));
  CHECK(steps.date == "2026-03-01");
  CHECK(campaign.find("steps") == &steps);
  CHECK(campaign.find("stairs") == nullptr);
}

TEST_CASE("load_campaign: what is left out has its default", "[datasets]") {
  std::string text = replaced(kExample, "initial = \"rest\"\nseparator = \",\"\n", "");
  text = replaced(text, "name = \"UIS shake table\"\n", "");
  text = replaced(text, "[averaging]\nalign = \"correlate\"\n", "");
  const Campaign campaign = load_text(text);
  CHECK(campaign.name == "campaign");
  CHECK(campaign.initial == InitialMode::rest);
  CHECK(campaign.separator == 0);
  CHECK(campaign.alignment == Alignment::correlate);
  CHECK(campaign.fit.loss == Loss::squared);
  CHECK(campaign.fit.starts == 1);
  CHECK(campaign.simulation.method == model::Method::rosenbrock);
  CHECK_FALSE(campaign.synthetic_settings.has_value());
}

TEST_CASE("load_campaign: roles follow from the controller", "[datasets]") {
  const std::string more =
      "command = { column = \"u\", unit = \"V\" }\n"
      "supply_pressure = { column = \"ps\", unit = \"bar\" }\n"
      "force = { column = \"f\", unit = \"kN\", role = \"input\", interpolation = \"linear\" }\n"
      "temperature = { column = \"T\", unit = \"degC\" }\n";
  const Campaign campaign = load_text(replaced(kExample, "[averaging]", more + "[averaging]"));
  const auto role = [&](Channel channel) { return campaign.channels.at(channel).role; };
  CHECK(role(Channel::reference) == ChannelRole::input);
  CHECK(role(Channel::command) == ChannelRole::ignore);
  CHECK(role(Channel::supply_pressure) == ChannelRole::input);
  CHECK(role(Channel::position) == ChannelRole::output);
  CHECK(role(Channel::temperature) == ChannelRole::ignore);
  CHECK(role(Channel::force) == ChannelRole::input);
  CHECK(campaign.channels.at(Channel::force).interpolation == Interpolation::linear);
  CHECK_THAT(campaign.channels.at(Channel::temperature).to_si(38.0), WithinRel(311.15, kRounding));
}

TEST_CASE("load_campaign: gain and offset act before the unit, sd behind the gain", "[datasets]") {
  const Campaign campaign =
      load_text(replaced(kExample, "unit = \"mm\", sd = \"0.05 mm\"",
                         "unit = \"mm\", gain = 25.4, offset = \"-0.2 cm\", sd = \"0.05 mm\""));
  const ChannelSetting& position = campaign.channels.at(Channel::position);
  // 25.4 * 2 - 2 = 48.8 mm.
  CHECK_THAT(position.to_si(2.0), WithinRel(0.0488, kRounding));
  CHECK_THAT(position.sd.value(), WithinRel(5e-5, kRounding));
}

TEST_CASE("load_campaign: a spread in degC is one in K", "[datasets]") {
  const Campaign campaign =
      load_text(replaced(kExample, "[averaging]",
                         "temperature = { column = \"T\", unit = \"degC\", sd = \"0.5 degC\" }\n"
                         "[averaging]"));
  // The scale is shifted by 273.15, and subtracting this costs three digits.
  CHECK_THAT(campaign.channels.at(Channel::temperature).sd.value(), WithinAbs(0.5, 1e-12));
}

TEST_CASE("load_campaign: decision rule and uncertainty of a sensor", "[datasets]") {
  const Campaign plain = load_text(kExample);
  CHECK(plain.acceptance_bounds.decision == DecisionRule::simple);
  CHECK(plain.channels.at(Channel::position).gain_sd == 0.0);
  const Campaign guarded = load_text(
      replaced(replaced(kExample, "absolute_error_percent = 1.0\n",
                        "absolute_error_percent = 1.0\ndecision = \"guard_band\"\n"),
               "sd = \"0.05 mm\"", "sd = \"0.05 mm\", gain_sd = 0.002, offset_sd = \"0.1 mm\""));
  CHECK(guarded.acceptance_bounds.decision == DecisionRule::guard_band);
  CHECK(guarded.acceptance.size() == plain.acceptance.size());
  CHECK(guarded.channels.at(Channel::position).gain_sd == 0.002);
  CHECK_THAT(guarded.channels.at(Channel::position).offset_sd, WithinRel(1e-4, kRounding));
}

TEST_CASE("load_campaign: channels that are to have no limit", "[datasets]") {
  const Campaign campaign = load_text(
      replaced(replaced(kExample, "rho2 = 0.99\n", "rho2 = 0.99\nnot_judged = [\"pressure_a\"]\n"),
               "parameters = { }", "acceptance = { not_judged = [\"position\"] }"));
  const Condition& own = campaign.conditions.at(0);
  const Condition& other = campaign.conditions.at(1);
  CHECK(campaign.may_lack_limits(own, Channel::position));
  CHECK(campaign.may_lack_limits(own, Channel::pressure_a));
  CHECK_FALSE(campaign.may_lack_limits(other, Channel::position));
  CHECK(campaign.may_lack_limits(other, Channel::pressure_a));
  CHECK_FALSE(campaign.may_lack_limits(own, Channel::pressure_b));
  CHECK(own.acceptance->empty());
}

TEST_CASE("load_campaign: acceptance limits", "[datasets]") {
  const Campaign campaign =
      load_text(replaced(kExample, "absolute_error_percent = 1.0\n",
                         "absolute_error_percent = 1.0\nrmse = \"0.4 mm\"\n"
                         "[acceptance.pressure_a]\nrmse = \"2 bar\"\nwarn_rmse = \"1 bar\"\n"
                         "[acceptance.position]\nrho2 = 0.9\n"));
  const auto limit = [&](Channel channel, const std::string& metric) {
    for (const AcceptanceLimit& entry : campaign.acceptance) {
      if (entry.channel == channel && entry.metric == metric) return entry;
    }
    FAIL("no limit of " << metric);
    return AcceptanceLimit{};
  };
  CHECK(campaign.acceptance.size() == 5);
  CHECK(limit(Channel::position, "ccc").limit == 0.99);
  CHECK_FALSE(limit(Channel::position, "ccc").warn.has_value());
  CHECK_THAT(limit(Channel::position, "rmse").limit.value(), WithinRel(4e-4, kRounding));
  CHECK_THAT(limit(Channel::pressure_a, "rmse").warn.value(), WithinRel(1e5, kRounding));
  // The entry of a channel replaces both limit and warning of the general one.
  CHECK(limit(Channel::position, "rho2").limit == 0.9);
  CHECK_FALSE(limit(Channel::position, "rho2").warn.has_value());
}

TEST_CASE("load_campaign: a condition's own limits stand in place of the campaign's",
          "[datasets]") {
  const auto with = [](const std::string& acceptance) {
    return load_text(replaced(kExample, "parameters = { }", "acceptance = " + acceptance));
  };
  const Campaign campaign = with("{ pressure_a = { rho2 = 0.97, warn_rho2 = 0.98 } }");
  REQUIRE(campaign.acceptance.size() > 1);
  const auto own = std::find_if(campaign.conditions.begin(), campaign.conditions.end(),
                                [](const Condition& c) { return c.acceptance.has_value(); });
  REQUIRE(own != campaign.conditions.end());
  REQUIRE(campaign.limits(*own).size() == 1);
  CHECK(campaign.limits(*own)[0].channel == Channel::pressure_a);
  CHECK(campaign.limits(*own)[0].limit == 0.97);
  CHECK(campaign.limits(*own)[0].warn == 0.98);
  Condition other = *own;
  other.acceptance.reset();
  CHECK(campaign.limits(other).size() == campaign.acceptance.size());
  const Campaign unjudged = with("{ }");
  CHECK(std::any_of(unjudged.conditions.begin(), unjudged.conditions.end(),
                    [&](const auto& c) { return c.acceptance && unjudged.limits(c).empty(); }));
}

TEST_CASE("load_campaign: without position the limits hold for every output", "[datasets]") {
  std::string text =
      replaced(kExample, "position = { column = \"x_mm\", unit = \"mm\", sd",
               "position = { column = \"x_mm\", role = \"ignore\", unit = \"mm\", sd");
  text = replaced(text, "pressure_a = { unit", "pressure_a = { column = \"pa\", unit");
  const Campaign campaign = load_text(text);
  REQUIRE(campaign.acceptance.size() == 6);
  CHECK(std::none_of(campaign.acceptance.begin(), campaign.acceptance.end(),
                     [](const auto& entry) { return entry.channel == Channel::position; }));
}

TEST_CASE("load_campaign: settings of fit, simulation and synthesis", "[datasets]") {
  const std::string sections = R"(
[fit]
loss = "huber"
loss_scale = 2
max_iterations = 50
posterior = 300
starts = 8
max_time = "1 min"
outputs = ["position", "pressure_a"]
[simulation]
method = "dopri5"
tolerance = 1e-8
max_seconds = 5
[synthetic]
parameters = { mass = "12 kg", kp = "70 V/m" }
repeats = 3
duration = "20 s"
sample_rate = "500 Hz"
noise = { position = "0.05 mm" }
ar1_noise = { pressure_a = "0.1 bar" }
ar1_coefficient = 0.8
quantisation = { position = "1 um" }
drift = { position = "0.1 mm" }
trigger_jitter = "1 ms"
supply_ripple = "50 kPa"
supply_ripple_frequency = "60 Hz"
variation = { mass = 0.01 }
[synthetic.leak_level."33.33 %"]
parameters = { leakage_coefficient = 0.4 }
[averaging])";
  std::string text = replaced(kExample, "\n[averaging]", sections);
  text = replaced(text, "repeats = [\"records/sine_0.1Hz_33_*.csv\"]\n", "");
  const Campaign campaign = load_text(text);
  CHECK(campaign.fit.loss == Loss::huber);
  CHECK(campaign.fit.loss_scale == 2.0);
  CHECK(campaign.fit.max_iterations == 50);
  CHECK(campaign.fit.posterior == 300);
  CHECK(campaign.fit.starts == 8);
  CHECK(campaign.fit.max_seconds == 60.0);
  CHECK(campaign.fit.outputs == std::vector<Channel>{Channel::position, Channel::pressure_a});
  CHECK(campaign.simulation.method == model::Method::dopri5);
  CHECK(campaign.simulation.tolerance == 1e-8);
  CHECK(campaign.simulation.max_seconds == 5.0);
  REQUIRE(campaign.synthetic_settings.has_value());
  const SyntheticSettings& synthetic = *campaign.synthetic_settings;
  CHECK(synthetic.parameters.size() == 2);
  CHECK(synthetic.repeats == 3);
  CHECK_THAT(synthetic.noise_sd.at(Channel::position), WithinRel(5e-5, kRounding));
  CHECK_THAT(synthetic.ar1_sd.at(Channel::pressure_a), WithinRel(1e4, kRounding));
  CHECK(synthetic.ar1_coefficient == 0.8);
  CHECK_THAT(synthetic.quantisation.at(Channel::position), WithinRel(1e-6, kRounding));
  CHECK_THAT(synthetic.drift.at(Channel::position), WithinRel(1e-4, kRounding));
  CHECK_THAT(synthetic.trigger_jitter_s, WithinRel(1e-3, kRounding));
  CHECK(synthetic.supply_ripple_pa == 50e3);
  CHECK(synthetic.supply_ripple_hz == 60.0);
  CHECK(synthetic.variation.begin()->second == 0.01);
  CHECK(synthetic.level_parameters.at("33.33 %").at(0).second == 0.4);
  // If a condition has no record, [synthetic] gives the duration.
  CHECK(campaign.conditions[0].duration_s == 20.0);
  CHECK(campaign.conditions[0].sample_rate_hz == 500.0);
  CHECK_FALSE(campaign.conditions[1].duration_s.has_value());
}

TEST_CASE("load_campaign: records may be labelled as synthetic", "[datasets]") {
  CHECK(load_text("synthetic = true\n" + kExample).synthetic);
}

TEST_CASE("load_campaign: bounds that are not given", "[datasets]") {
  const auto with = [](const std::string& entry) {
    return load_text(replaced(kExample, "supply_pressure = \"6.2 MPa\"", entry));
  };
  const Campaign positive = with("supply_pressure = { start = \"6 MPa\", fit = true }");
  CHECK_THAT(setting_of(positive, "supply_pressure").lower, WithinRel(6e5, kRounding));
  CHECK_THAT(setting_of(positive, "supply_pressure").upper, WithinRel(6e7, kRounding));
  const Campaign negative =
      with("supply_pressure = \"6.2 MPa\"\nexternal_force = { start = \"-20 N\", fit = true }");
  CHECK(setting_of(negative, "external_force").lower == -200.0);
  CHECK(setting_of(negative, "external_force").upper == -2.0);
  const Campaign zero =
      with("supply_pressure = \"6.2 MPa\"\ncoulomb_friction = { start = \"0 N\", fit = true }");
  CHECK(setting_of(zero, "coulomb_friction").lower == 0.0);
  CHECK(setting_of(zero, "coulomb_friction").upper == 1e8);
}

TEST_CASE("values_in: rig, then leak level, then condition", "[datasets]") {
  Campaign campaign = load_text(kExample);
  const Condition& sine = campaign.conditions[0];
  CHECK(values_in(campaign, sine)["leakage_coefficient"] == 0.35);
  CHECK(values_in(campaign, campaign.conditions[1])["leakage_coefficient"] == 0.3);
  campaign = load_text(replaced(kExample, "parameters = { }",
                                "parameters = { leakage_coefficient = 0.7 }\n"
                                "controller = { kp = \"50 V/m\" }"));
  CHECK(values_in(campaign, campaign.conditions[0])["leakage_coefficient"] == 0.7);
  CHECK(values_in(campaign, campaign.conditions[0])["kp"] == 50.0);
  CHECK(values_in(campaign, campaign.conditions[1])["kp"] == 78.74);
  CHECK(values_in(campaign, campaign.conditions[0]).is_given("mass"));
  CHECK_FALSE(values_in(campaign, campaign.conditions[0]).is_given("coulomb_friction"));
}

TEST_CASE("set_value: changes values, starts and optional terms", "[datasets]") {
  Campaign campaign = load_text(kExample);
  set_value(campaign, "supply_pressure=7 MPa");
  set_value(campaign, "mass=70 kg");
  set_value(campaign, "coulomb_friction=20 N");
  set_value(campaign, "discharge_coefficient=0.62");
  CHECK(setting_of(campaign, "supply_pressure").value == 7e6);
  CHECK(setting_of(campaign, "mass").value == 70.0);
  CHECK(setting_of(campaign, "mass").fit);
  CHECK(values_in(campaign, campaign.conditions[0])["coulomb_friction"] == 20.0);
  CHECK(setting_of(campaign, "discharge_coefficient").value == 0.62);
  CHECK_NOTHROW(check_values(campaign));
}

TEST_CASE("set_everywhere: before leak levels, conditions and bounds", "[datasets]") {
  Campaign campaign =
      load_text(replaced(kExample, "parameters = { }",
                         "parameters = { leakage_coefficient = 0.7, mass = \"90 kg\" }"));
  set_everywhere(campaign, "leakage_coefficient=9");  // the bounds of the fit end at 5
  for (const Condition& condition : campaign.conditions)
    CHECK(values_in(campaign, condition)["leakage_coefficient"] == 9.0);
  CHECK_FALSE(setting_of(campaign, "leakage_coefficient").fit);
  CHECK(values_in(campaign, campaign.conditions[0])["mass"] == 90.0);
  CHECK_THROWS_WITH(set_everywhere(campaign, "mass=-70 kg"), Catch::Contains("is not plausible"));
}

TEST_CASE("set_value: refuses what is not plausible", "[datasets]") {
  const Campaign campaign = load_text(kExample);
  const auto message = [&](const std::string& assignment) -> std::string {
    Campaign changed = campaign;
    try {
      set_value(changed, assignment);
    } catch (const UsageError& error) {
      CHECK(error.code() == ExitCode::bad_input);
      return error.what();
    }
    return "";
  };
  CHECK_THAT(message("mas=70 kg"), Catch::Contains("did you mean 'mass'"));
  CHECK_THAT(message("mass"), Catch::Contains("expected name="));
  CHECK_THAT(message("mass=70 mm"), Catch::Contains("a mass"));
  CHECK_THAT(message("mass=70"), Catch::Contains("unit"));
  CHECK_THAT(message("mass=-70 kg"), Catch::Contains("is not plausible"));
  CHECK_THAT(message("mass=600 kg"), Catch::Contains("outside the bounds 10 kg to 500 kg"));
  CHECK_THAT(message("mass=nan kg"), Catch::Contains("not finite"));
}

TEST_CASE("set_value: a value that every condition overrides", "[datasets]") {
  Campaign campaign =
      load_text(replaced(kExample, "leak_level = \"none\"", "leak_level = \"33.33 %\""));
  CHECK_THROWS_WITH(set_value(campaign, "leakage_coefficient=0.2"),
                    Catch::Contains("every condition has a value of its own"));
}

TEST_CASE("set_value: a pair may be set one by one", "[datasets]") {
  Campaign campaign = load_text(kExample);
  set_value(campaign, "valve_frequency=80 Hz");
  CHECK_THROWS_WITH(check_values(campaign), Catch::Contains("valve_damping_ratio"));
  set_value(campaign, "valve_damping_ratio=0.7");
  CHECK_NOTHROW(check_values(campaign));
  // 80 Hz is 160 pi rad/s, and pi itself is rounded.
  CHECK_THAT(setting_of(campaign, "valve_frequency").value,
             WithinRel(160.0 * std::acos(-1.0), 1e-13));
}

TEST_CASE("set_free: exactly these parameters are free", "[datasets]") {
  Campaign campaign = load_text(kExample);
  set_free(campaign, {"mass", "bulk_modulus", "kp", "coulomb_friction"});
  std::vector<std::string> free;
  for (const ParameterSetting& setting : campaign.parameters) {
    if (!setting.fit) continue;
    free.emplace_back(
        model::parameter_table(campaign.rig.plant)[static_cast<std::size_t>(setting.index)].key);
  }
  CHECK(free == std::vector<std::string>{"mass", "bulk_modulus", "kp", "coulomb_friction"});
  CHECK(setting_of(campaign, "mass").upper == 500.0);
  CHECK_THAT(setting_of(campaign, "bulk_modulus").lower, WithinRel(68.9e6, kRounding));
  CHECK_THAT(setting_of(campaign, "bulk_modulus").upper, WithinRel(6.89e9, kRounding));
}

TEST_CASE("set_free: refuses and leaves the campaign as it was", "[datasets]") {
  Campaign campaign = load_text(kExample);
  CHECK_THROWS_WITH(set_free(campaign, {"bulk", "mass"}), Catch::Contains("unknown parameter"));
  CHECK_THROWS_WITH(set_free(campaign, {"leakage_smoothing"}), Catch::Contains("cannot be fitted"));
  CHECK_THROWS_WITH(set_free(campaign, {"valve_frequency"}),
                    Catch::Contains("no value to start from"));
  CHECK(setting_of(campaign, "damping").fit);
  CHECK(campaign.setting(model::parameter_index(campaign.rig.plant, "valve_frequency")) == nullptr);
}

TEST_CASE("set_free: a lag that the campaign does not have starts at zero", "[datasets]") {
  Campaign campaign = load_text(kExample);
  set_free(campaign, {"valve_time_constant", "position_lag"});
  for (const char* key : {"valve_time_constant", "position_lag"}) {
    const ParameterSetting& lag = setting_of(campaign, key);
    CHECK(lag.value == 0.0);
    CHECK(lag.lower == 0.0);
    CHECK(lag.upper == 10.0);
  }
  CHECK(values_in(campaign, campaign.conditions.front()).is_given("valve_time_constant"));
}

TEST_CASE("values_in: a valve lag that stays zero is none", "[datasets]") {
  const auto is_given = [](const std::string& lines) {
    const Campaign campaign =
        load_text(replaced(kExample, "stiffness = \"0 N/m\"", "stiffness = \"0 N/m\"\n" + lines));
    return values_in(campaign, campaign.conditions.front()).is_given("valve_time_constant");
  };
  CHECK_FALSE(is_given("valve_time_constant = \"0 s\""));
  CHECK(is_given("valve_time_constant = \"1 us\""));
  CHECK(is_given("valve_time_constant = { start = \"0 s\", fit = true }"));
  CHECK(is_given(
      "valve_time_constant = { start = \"0 s\", prior = \"0 s\", prior_sd = \"1 ms\" }"));  // its
                                                                                            // uncertainty
                                                                                            // counts
  // A limit of the spool's rate needs the spool's state.
  CHECK(is_given("valve_time_constant = \"0 s\"\nvalve_rate_limit = \"100 V/s\""));
}

TEST_CASE("load_campaign: the example of the documentation", "[datasets]") {
  std::ifstream in(std::string(RIGCAL_SOURCE_DIR) + "/docs/campaign-file.md");
  const std::string document(std::istreambuf_iterator<char>(in), {});
  const std::string fence = "```toml\n";
  const std::size_t begin = document.find(fence);
  REQUIRE(begin != std::string::npos);
  const std::size_t end = document.find("```", begin + fence.size());
  const Campaign campaign =
      load_text(document.substr(begin + fence.size(), end - begin - fence.size()));
  CHECK(campaign.conditions.size() == 1);
  CHECK(setting_of(campaign, "mass").fit);
}

TEST_CASE("condition: a value counts where its scope says", "[datasets]") {
  datasets::Condition condition;
  condition.id = "sine";
  condition.leak_level = "33 %";
  CHECK(condition.is_within(datasets::Scope::rig, ""));
  CHECK(condition.is_within(datasets::Scope::leak_level, "33 %"));
  CHECK_FALSE(condition.is_within(datasets::Scope::leak_level, "sine"));
  CHECK(condition.is_within(datasets::Scope::condition, "sine"));
  CHECK_FALSE(condition.is_within(datasets::Scope::condition, "33 %"));
  condition.leak_level.reset();
  CHECK_FALSE(condition.is_within(datasets::Scope::leak_level, "33 %"));
}
