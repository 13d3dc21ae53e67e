// Tests loops on quantities other than position, and second masses: keys, channels and errors.

#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::complaint_of;
using rigcal::test::kExample;
using rigcal::test::load_text;
using rigcal::test::replaced;

namespace {

const std::string kLoopGain = "kp = \"78.74 V/m\"";
const std::string kKnownMass =
    R"(mass = { start = "60 kg", lower = "10 kg", upper = "500 kg", fit = true })";

/// Returns the example with a force loop and a reference in N.
std::string force_loop(const std::string& gains) {
  std::string text = replaced(kExample, kLoopGain, "feedback = \"force\"\n" + gains);
  for (std::size_t at = text.find("50.8 mm"); at != std::string::npos; at = text.find("50.8 mm"))
    text.replace(at, 7, "2 kN");
  return replaced(text, "reference = { column = \"ref_mm\", unit = \"mm\" }",
                  "force_reference = { column = \"ref\", unit = \"kN\" }");
}

std::string loop_refusal_of(const std::string& text) {
  return complaint_of([&] { load_text(text); });
}

}  // namespace

TEST_CASE("load_campaign: a loop on force has its gains, its reference and amplitudes in newtons",
          "[datasets]") {
  const Campaign campaign =
      load_text(force_loop("force_kp = \"2 V/kN\"\nforce_ki = \"20 V/(kN s)\""));
  CHECK(campaign.rig.feedback == model::Feedback::force);
  CHECK(drive_channel(campaign) == Channel::force_reference);
  CHECK(campaign.channels.at(Channel::force_reference).role == ChannelRole::input);
  CHECK(campaign.conditions.front().amplitude == 2000.0);
  const auto values = values_in(campaign, campaign.conditions.front());
  CHECK(values["force_kp"] == Approx(2e-3));
  CHECK(values["force_ki"] == Approx(2e-2));
}

TEST_CASE("load_campaign: a loop has no gains but its own", "[datasets]") {
  CHECK_THAT(loop_refusal_of(force_loop(kLoopGain)),
             Catch::Contains("kp is a gain of a loop on position, but this one is on force") &&
                 Catch::Contains("expected force_kp"));
  CHECK_THAT(
      loop_refusal_of(replaced(kExample, kLoopGain, kLoopGain + "\nforce_ki = \"1 V/(N s)\"")),
      Catch::Contains("force_ki") && Catch::Contains("expected ki"));
  CHECK_THAT(loop_refusal_of(force_loop("")), Catch::Contains("no force_kp"));
  CHECK_THAT(loop_refusal_of(force_loop("force_kp = \"2 V/kN\"\nforce_kd = \"1 V s/kN\"")),
             Catch::Contains("derivative_filter"));
  CHECK_THAT(loop_refusal_of(force_loop("force_kp = \"2 V/m\"")), Catch::Contains("force_kp"));
}

TEST_CASE("load_campaign: what a loop controls is one of a list", "[datasets]") {
  CHECK_THAT(loop_refusal_of(replaced(kExample, kLoopGain, kLoopGain + "\nfeedback = \"forces\"")),
             Catch::Contains("forces") && Catch::Contains("force"));
  CHECK_THAT(loop_refusal_of(replaced(kExample, "type = \"pid\"\n" + kLoopGain,
                                      "type = \"none\"\nfeedback = \"force\"")),
             Catch::Contains("feedback") && Catch::Contains("type = \"pid\""));
}

TEST_CASE(
    "load_campaign: three-variable control has its generator, and the reference of either kind",
    "[datasets]") {
  const std::string gains =
      "kp = \"40 V/m\"\nki = \"5 V/(m s)\"\nvelocity_kp = \"2 V s/m\"\nacceleration_kp = \"0.01 V "
      "s2/m\"\nvelocity_feedforward = \"10 V s/m\"\n";
  const std::string generator = "reference_frequency = \"0.5 Hz\"\nreference_damping_ratio = 0.7\n";
  const std::string control = "feedback = \"three_variable\"\n";
  const auto with = [](const std::string& lines) { return replaced(kExample, kLoopGain, lines); };
  const Campaign position = load_text(with(control + gains + generator));
  CHECK(position.rig.feedback == model::Feedback::three_variable);
  CHECK(drive_channel(position) == Channel::reference);
  const auto values = values_in(position, position.conditions.front());
  CHECK(values["reference_frequency"] == Approx(3.14159265358979));
  CHECK(values["velocity_kp"] == 2.0);
  CHECK_THAT(loop_refusal_of(with(control + gains + "reference_frequency = \"0.5 Hz\"")),
             Catch::Contains("a loop on three_variable has no reference_damping_ratio"));
  CHECK_THAT(loop_refusal_of(with(control + gains)),
             Catch::Contains("has no reference_frequency: expected reference_frequency and "
                             "reference_damping_ratio in [rig.controller]"));
  CHECK_THAT(loop_refusal_of(with(control + gains + generator + "kd = \"1 V s/m\"")),
             Catch::Contains("kd is a gain of a loop on position, but this one is on "
                             "three_variable: expected velocity_kp"));
  CHECK_THAT(loop_refusal_of(with(control + gains + generator + "acceleration_ki = \"1 V s/m\"")),
             Catch::Contains("acceleration_ki is a gain of a loop on acceleration"));
  CHECK_THAT(
      loop_refusal_of(with(control + gains + generator + "derivative_filter = \"300 rad/s\"")),
      Catch::Contains("derivative_filter filters the derivative of an error"));
  CHECK_THAT(loop_refusal_of(with(control + generator)), Catch::Contains("has no kp"));
  CHECK_THAT(loop_refusal_of(with(kLoopGain + "\n" + generator)),
             Catch::Contains("reference_frequency belongs to three-variable control, but this loop "
                             "is on position"));
  CHECK_THAT(
      loop_refusal_of(with(kLoopGain + "\nvelocity_kp = \"2 V s/m\"")),
      Catch::Contains("velocity_kp is a gain of a loop on three_variable, but this one is on "
                      "position: expected kd"));
  CHECK_THAT(loop_refusal_of(with(kLoopGain + "\nacceleration_kp = \"2 V s2/m\"")),
             Catch::Contains("acceleration_kp is a gain of a loop on acceleration"));
  std::string text = with("feedback = \"three_variable_acceleration\"\n" + gains + generator);
  for (std::size_t at = text.find("50.8 mm"); at != std::string::npos; at = text.find("50.8 mm"))
    text.replace(at, 7, "2 m/s2");
  const Campaign shaken =
      load_text(replaced(text, "reference = { column = \"ref_mm\", unit = \"mm\" }",
                         "acceleration_reference = { column = \"ref\", unit = \"gravity\" }"));
  CHECK(shaken.rig.feedback == model::Feedback::three_variable_acceleration);
  CHECK(drive_channel(shaken) == Channel::acceleration_reference);
  CHECK(shaken.conditions.front().amplitude == 2.0);
}

TEST_CASE("load_campaign: all of a second mass or nothing", "[datasets]") {
  const std::string payload = kKnownMass + "\npayload_mass = \"1 t\"";
  CHECK_THAT(loop_refusal_of(replaced(kExample, kKnownMass, payload)),
             Catch::Contains("payload_mass") && Catch::Contains("as well"));
  const std::string all = payload + "\npayload_frequency = \"16 Hz\"\npayload_damping_ratio = 0.05";
  const Campaign campaign = load_text(replaced(kExample, kKnownMass, all));
  const auto values = values_in(campaign, campaign.conditions.front());
  CHECK(values["payload_mass"] == Approx(1000.0));
  CHECK(values["payload_frequency"] == Approx(2.0 * 3.14159265358979 * 16.0));
}

TEST_CASE("load_campaign: a load may fall along the travel, a spring may not", "[datasets]") {
  const Campaign campaign =
      load_text(replaced(kExample, kKnownMass, kKnownMass + "\nload_gradient = \"-9 kN/m\""));
  CHECK(values_in(campaign, campaign.conditions.front())["load_gradient"] == Approx(-9000.0));
  CHECK_THAT(
      loop_refusal_of(replaced(kExample, "stiffness = \"0 N/m\"", "stiffness = \"-9 kN/m\"")),
      Catch::Contains("is not plausible for stiffness"));
}

TEST_CASE("load_campaign: all of a load table or nothing, and no polynomial beside it",
          "[datasets]") {
  const auto with = [](const std::string& lines) {
    return replaced(kExample, kKnownMass, kKnownMass + "\n" + lines);
  };
  const std::string values =
      "load_0 = { start = \"900 N\", lower = \"-2 kN\", upper = \"2 kN\", fit = true }\n"
      "load_20 = \"500 N\"\nload_40 = \"700 N\"\nload_60 = \"-300 N\"\nload_80 = \"-100 N\"\n"
      "load_100 = \"0.4 kN\"\n";
  const std::string places = "load_table_from = \"-40 mm\"\nload_table_to = \"50 mm\"\n";
  const Campaign campaign = load_text(with(values + places + "external_force = \"1 kN\""));
  const auto read = values_in(campaign, campaign.conditions.front());
  CHECK(read["load_table_to"] == Approx(0.05));
  CHECK(read["load_60"] == Approx(-300.0));
  CHECK(read["load_100"] == Approx(400.0));
  const auto refusal = [&](const std::string& lines) { return loop_refusal_of(with(lines)); };
  CHECK_THAT(refusal(values),
             Catch::Contains("'load_0'") && Catch::Contains("expected load_table_from as well"));
  CHECK_THAT(refusal(places),
             Catch::Contains("'load_table_from'") && Catch::Contains("expected load_0 as well"));
  CHECK_THAT(refusal(replaced(values, "load_80 = \"-100 N\"\n", "") + places),
             Catch::Contains("expected load_80 as well"));
  CHECK_THAT(refusal(values + replaced(places, "50 mm", "-40 mm")),
             Catch::Contains("load_table_to = -0.04 m is not above load_table_from = -0.04 m"));
  for (const char* key : {"load_gradient = \"1 N/m\"", "load_curvature = \"1 N/m2\""})
    CHECK_THAT(refusal(values + places + key), Catch::Contains("expected one of them"));
  CHECK_THAT(refusal(values + replaced(places, "\"50 mm\"", "{ start = \"50 mm\", fit = true }")),
             Catch::Contains("load_table_to") && Catch::Contains("cannot be fitted"));
}

TEST_CASE("load_campaign: each condition may have its own mass and payload", "[datasets]") {
  const std::string payload =
      kKnownMass +
      "\npayload_mass = { start = \"1 t\", fit = true, scope = \"condition\" }\n"
      "payload_frequency = \"16 Hz\"\npayload_damping_ratio = 0.05";
  const Campaign campaign =
      load_text(replaced(replaced(kExample, kKnownMass, payload), "parameters = { }",
                         "parameters = { mass = \"80 kg\", payload_mass = \"250 kg\" }"));
  const auto heavy = values_in(campaign, campaign.conditions[0]);
  CHECK(heavy["mass"] == Approx(80.0));
  CHECK(heavy["payload_mass"] == Approx(250.0));
  const auto plain = values_in(campaign, campaign.conditions[1]);
  CHECK(plain["mass"] == Approx(60.0));
  CHECK(plain["payload_mass"] == Approx(1000.0));
  const auto mass = model::parameter_index(model::PlantKind::load_pressure, "payload_mass");
  REQUIRE(campaign.setting(mass) != nullptr);
  CHECK(campaign.setting(mass)->scope == Scope::condition);
}

TEST_CASE("load_campaign: an integral at the start needs integral action", "[datasets]") {
  const std::string start = kKnownMass + "\ninitial_integral = \"0.1 V\"";
  std::string text = replaced(kExample, kKnownMass, start);
  CHECK_THAT(loop_refusal_of(text),
             Catch::Contains("initial_integral") || Catch::Contains("initial"));
}

TEST_CASE("load_campaign: accelerations are outputs", "[datasets]") {
  const Campaign campaign = load_text(
      replaced(kExample, "position = { column",
               "acceleration = { column = \"a\", unit = \"gravity\" }\nposition = { column"));
  const ChannelSetting& setting = campaign.channels.at(Channel::acceleration);
  CHECK(setting.role == ChannelRole::output);
  CHECK(setting.to_si.scale == Approx(9.80665));
}
