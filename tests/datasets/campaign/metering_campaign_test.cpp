// Tests campaigns for a cylinder with a pilot-operated or shaped valve and a pump: the drive, and
// parameters that cannot be combined.

#include <catch2/catch.hpp>

#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/design/drive_file.hpp"
#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::load_text;
using rigcal::test::replaced;

namespace {

const std::string kSlide = R"(schema = "rigcal.campaign/1"
[rig]
model = "two_chamber"
[rig.parameters]
mass = "2 t"
damping = { start = "40 kN s/m", fit = true }
stiffness = "0 N/m"
stroke = "1 m"
area_a = "40 cm2"
area_b = "24 cm2"
dead_volume_a = "1 L"
dead_volume_b = "1 L"
tank_pressure = "2 bar"
supply_pressure = "200 bar"
supply_resistance = "1e9 Pa s/m3"
supply_capacity = "1e-11 m3/Pa"
density = "870 kg/m3"
bulk_modulus = "800 MPa"
discharge_coefficient = 0.65
area_gradient = "20 mm"
pilot_gain = "0.1 mm/bar"
leakage_coefficient = 0
leakage_area = "1 mm2"
[rig.controller]
type = "none"
[recording]
initial = "record"
[recording.channels]
time = { column = "t_s", unit = "s" }
pilot_pressure = { column = "out_bar", minus = "in_bar", unit = "bar" }
position = { column = "x_mm", unit = "mm", sd = "1 mm" }
pressure_a = { column = "a_bar", unit = "bar" }
[acceptance]
rho2 = 0.99
[[condition]]
id = "out"
waveform = "recorded"
use = "fit"
repeats = ["out.csv"]
)";

const std::string kGain = "pilot_gain = \"0.1 mm/bar\"\n";

/// Returns the campaign with an electric instead of a pilot-operated valve.
std::string electric() {
  return replaced(replaced(kSlide, kGain, "valve_gain = \"0.1 mm/V\"\n"),
                  "pilot_pressure = { column = \"out_bar\", minus = \"in_bar\", unit = \"bar\" }",
                  "command = { column = \"u_V\", unit = \"V\" }");
}

}  // namespace

TEST_CASE("load_campaign: a pilot pressure drives a cylinder that slides", "[datasets]") {
  const Campaign campaign = load_text(kSlide);
  CHECK(campaign.rig.pilot);
  CHECK(drive_channel(campaign) == Channel::pilot_pressure);
  CHECK_FALSE(load_text(electric()).rig.pilot);
  CHECK(drive_channel(load_text(electric())) == Channel::command);
}

TEST_CASE("load_campaign: every term of valve, pump and friction has its unit", "[datasets]") {
  const Campaign campaign = load_text(replaced(
      kSlide, kGain,
      kGain + "pilot_exponent = 1.5\nreturn_exponent = 2\ncompensator_pressure = \"8 bar\"\n"
              "load_sensing_margin = \"20 bar\"\naccumulator_volume = \"0.2 L\"\n"
              "accumulator_precharge = \"80 bar\"\nrelief_pressure = \"250 bar\"\n"
              "relief_conductance = \"1 L/min/bar\"\nmake_up_conductance = \"10 L/min/bar\"\n"
              "coulomb_friction = \"2 kN\"\nbristle_stiffness = \"10 N/um\"\n"));
  const auto values = values_in(campaign, campaign.conditions.front());
  CHECK(values["compensator_pressure"] == Approx(8e5));
  CHECK(values["load_sensing_margin"] == Approx(2e6));
  CHECK(values["accumulator_volume"] == Approx(2e-4));
  CHECK(values["relief_conductance"] == Approx(1.0 / 60e8));
  CHECK(values["bristle_stiffness"] == Approx(1e7));
}

TEST_CASE("load_campaign: the supply of a load-pressure rig may give way", "[datasets]") {
  const auto with = [](const std::string& lines) {
    return load_text(replaced(test::kExample, "stiffness = ", lines + "\nstiffness = "));
  };
  const Campaign campaign = with(
      "supply_resistance = \"1e10 Pa s/m3\"\nsupply_capacity = \"1e-13 m3/Pa\"\n"
      "pump_flow = \"5 L/min\"\naccumulator_volume = \"0.2 L\"\n"
      "accumulator_precharge = \"30 bar\"");
  CHECK(values_in(campaign, campaign.conditions.front())["pump_flow"] == Approx(5e-3 / 60.0));
  CHECK_THROWS_WITH(with("pump_flow = \"5 L/min\""), Catch::Contains("needs supply_resistance"));
  CHECK_THROWS_WITH(with("relief_pressure = \"80 bar\""), Catch::Contains("expected it as well"));
  // What it lacks is another plant's.
  CHECK_THROWS_WITH(with("load_sensing_margin = \"20 bar\""),
                    Catch::Contains("is a parameter of two_chamber and linkage, and not of "
                                    "load_pressure, which this rig is"));
}

TEST_CASE("load_campaign: what does not go together behind a valve of two chambers", "[datasets]") {
  struct Row {
    const char* lines;
    const char* message;
  };
  for (const Row& row : {
           Row{"valve_gain = \"0.1 mm/V\"", "pilot_gain and valve_gain are both given"},
           Row{"overlap_a_to_tank = \"0.1 V\"",
               "overlap_a_to_tank is in volts, but pilot_gain makes the pilot pressure the drive: "
               "expected return_dead_band"},
           Row{"valve_exponent = 2", "expected pilot_exponent for a power law"},
           Row{"valve_null_opening = \"0.1 V\"", "expected valve_null_leakage for a leak"},
           Row{"pilot_exponent = 2\nopening_40 = 0.3",
               "opening_40 (an opening by a table) is combined with pilot_exponent"},
           Row{"opening_40 = 0.9", "opening_60 = 0.6 is below opening_40 = 0.9"},
           Row{"accumulator_volume = \"1 L\"", "expected accumulator_precharge as well"},
           Row{"accumulator_precharge = \"80 bar\"", "expected accumulator_volume"},
           Row{"accumulator_exponent = 1.2", "expected accumulator_volume"},
           Row{"relief_pressure = \"80 bar\"", "expected it as well"},
           Row{"relief_conductance = \"1 L/min/bar\"", "expected relief_pressure"},
           Row{"bypass_range = \"80 bar\"", "bypass_range without a bypass"},
           Row{"bristle_stiffness = \"1 N/um\"", "expected coulomb_friction as well"},
           Row{"bristle_damping = \"1 N s/m\"", "expected bristle_stiffness"},
           Row{"film_velocity = \"0.1 m/s\"", "expected film_growth_time as well"},
           Row{"film_velocity = \"0.1 m/s\"\nfilm_growth_time = \"20 ms\"\nfilm_decay_time = "
               "\"0.2 s\"\nfilm_dwell_time = \"20 s\"",
               "expected bristle_stiffness as well"},
       }) {
    CAPTURE(row.lines);
    CHECK_THROWS_WITH(load_text(replaced(kSlide, kGain, kGain + row.lines + "\n")),
                      Catch::Contains(row.message));
  }
  CHECK_THROWS_WITH(load_text(replaced(kSlide, kGain, "")),
                    Catch::Contains("the gain of the valve is unknown"));
  CHECK_THROWS_WITH(
      load_text(replaced(replaced(kSlide, "type = \"none\"", "type = \"pid\"\nkp = \"10 V/m\""),
                         "pilot_pressure = { column = \"out_bar\", minus = \"in_bar\", unit = "
                         "\"bar\" }",
                         "reference = { column = \"r_mm\", unit = \"mm\" }")),
      Catch::Contains("the controller's output is a voltage"));
  std::string stiff = replaced(kSlide, "supply_resistance = \"1e9 Pa s/m3\"\n", "");
  stiff = replaced(stiff, "supply_capacity = \"1e-11 m3/Pa\"\n", "");
  for (const auto& [lines, message] :
       {std::pair{"load_sensing_margin = \"20 bar\"", "a load-sensing pump needs"},
        std::pair{"accumulator_volume = \"1 L\"", "an accumulator fills through"},
        std::pair{"pump_flow = \"20 L/min\"", "a pump of limited flow needs"}})
    CHECK_THROWS_WITH(load_text(replaced(stiff, kGain, kGain + lines + "\n")),
                      Catch::Contains(message));
  for (const auto& [line, message] :
       {std::pair{"return_dead_band = \"8 bar\"",
                  "return_dead_band applies to a pilot-operated valve"},
        std::pair{"bypass_range = \"8 bar\"", "bypass_range applies to a pilot-operated valve"},
        std::pair{"valve_bypass_range = \"8 V\"", "valve_bypass_range without a bypass"}})
    CHECK_THROWS_WITH(load_text(replaced(electric(), "valve_gain = \"0.1 mm/V\"\n",
                                         std::string("valve_gain = \"0.1 mm/V\"\n") + line + "\n")),
                      Catch::Contains(message));
}

TEST_CASE("load_campaign: a main spool needs the lag of its pilot stage, and a command in volts",
          "[datasets]") {
  const auto valve = [](const std::string& rig, const std::string& gain, const std::string& lines) {
    return load_text(replaced(rig, gain, gain + lines));
  };
  const std::string volts = "valve_gain = \"0.1 mm/V\"\n";
  const Campaign campaign =
      valve(electric(), volts, "valve_time_constant = \"2 ms\"\nmain_spool_gain = \"250 1/s\"\n");
  CHECK(values_in(campaign, campaign.conditions.front())["main_spool_gain"] == 250.0);
  CHECK_THROWS_WITH(valve(electric(), volts, "main_spool_gain = \"250 1/s\"\n"),
                    Catch::Contains("main_spool_gain without the lag of the pilot stage: expected "
                                    "valve_time_constant, or valve_frequency, as well"));
  CHECK_THROWS_WITH(
      valve(kSlide, kGain, "valve_time_constant = \"2 ms\"\nmain_spool_gain = \"250 1/s\"\n"),
      Catch::Contains("is combined with pilot_gain"));
  CHECK_THROWS_WITH(valve(electric(), volts, "main_spool_gain = \"250 Hz\"\n"),
                    Catch::Contains("Hz and rad/s count turns"));
}

TEST_CASE("load_campaign: feed-forward is of a position loop with a filter", "[datasets]") {
  const auto loop = [](const std::string& lines) {
    const std::string text = replaced(electric(), "type = \"none\"", "type = \"pid\"\n" + lines);
    return replaced(text, "command = { column = \"u_V\", unit = \"V\" }",
                    "reference = { column = \"r_mm\", unit = \"mm\" }\n"
                    "force_reference = { column = \"r_kN\", unit = \"kN\", role = \"ignore\" }");
  };
  const std::string gains = "kp = \"10 V/m\"\nvelocity_feedforward = \"2 V s/m\"\n";
  CHECK_THROWS_WITH(load_text(loop(gains)),
                    Catch::Contains("velocity_feedforward without derivative_filter"));
  CHECK_THROWS_WITH(load_text(loop("feedback = \"force\"\nforce_kp = \"1 V/kN\"\n"
                                   "derivative_filter = \"300 rad/s\"\n"
                                   "acceleration_feedforward = \"0.1 V s2/m\"\n")),
                    Catch::Contains("feeds the rate of a position forward, but this loop is on "
                                    "force"));
  const Campaign campaign = load_text(loop(gains + "derivative_filter = \"300 rad/s\"\n"));
  CHECK(values_in(campaign, campaign.conditions.front())["velocity_feedforward"] == 2.0);
}

TEST_CASE("load_campaign: a rig with more states than its solver has room for is an error",
          "[datasets]") {
  std::string text = replaced(
      electric(), "valve_gain = \"0.1 mm/V\"\n",
      "valve_gain = \"0.1 mm/V\"\nvalve_frequency = \"300 rad/s\"\nvalve_damping_ratio = 0.8\n"
      "pump_flow = \"20 L/min\"\npump_second_flow = \"40 L/min\"\npump_delay = \"1 s\"\n"
      "payload_mass = \"100 kg\"\npayload_frequency = \"50 rad/s\"\npayload_damping_ratio = 0.1\n"
      "coulomb_friction = \"1 kN\"\nbristle_stiffness = \"10 N/um\"\n");
  load_text(text);  // has eleven states
  text = replaced(text, "payload_damping_ratio = 0.1\n",
                  "payload_damping_ratio = 0.1\nhose_capacity_a = \"1e-12 m3/Pa\"\n"
                  "hose_yield = \"2 bar\"\n");
  CHECK_THROWS_WITH(
      load_text(text),
      Catch::Contains("the rig has 13 states, and the solver of the plant two_chamber has room for "
                      "12: expected fewer of hose_yield, payload_mass, pump_second_flow, "
                      "bristle_stiffness"));
}

TEST_CASE("load_campaign: a command in % or mA counts as 10 V at its full scale", "[datasets]") {
  const auto conversion = [](const std::string& keys) {
    const Campaign campaign = load_text(replaced(electric(), "unit = \"V\" }", keys + " }"));
    return campaign.channels.at(Channel::command).to_si;
  };
  CHECK(conversion("unit = \"%\"")(40.0) == Approx(4.0));
  CHECK(conversion("unit = \"1\"")(-0.4) == Approx(-4.0));
  CHECK(conversion("unit = \"%\", full_scale = \"80 %\"")(80.0) == Approx(10.0));
  CHECK(conversion("unit = \"mA\", full_scale = \"40 mA\"")(-20.0) == Approx(-5.0));
  CHECK(conversion("unit = \"mA\", full_scale = \"0.04 A\"")(20.0) == Approx(5.0));
  CHECK(conversion("unit = \"%\", gain = -1.0")(40.0) == Approx(-4.0));
  // A current of 4 to 20 mA, with the spool in the middle at 12 mA.
  const auto live_zero = conversion("unit = \"mA\", full_scale = \"8 mA\", offset = \"-12 mA\"");
  CHECK(live_zero(4.0) == Approx(-10.0));
  CHECK(live_zero(12.0) == Approx(0.0).margin(1e-12));
  CHECK(live_zero(20.0) == Approx(10.0));
  // A voltage needs no full scale.
  CHECK(conversion("unit = \"mV\"")(500.0) == Approx(0.5));
}

TEST_CASE("load_campaign: a full scale belongs to a command in % or mA", "[datasets]") {
  struct Row {
    const char* part;
    const char* with;
    const char* message;
  };
  const char* const command = "unit = \"V\" }";
  const char* const position = "position = { column = \"x_mm\", unit = \"mm\"";
  for (const Row& row :
       {Row{command, "unit = \"mA\" }", "the current at which the valve is fully open"},
        Row{command, "unit = \"mA\", full_scale = \"0 mA\" }", "full_scale"},
        Row{command, "unit = \"mA\", full_scale = \"10 V\" }", "full_scale"},
        Row{command, "unit = \"V\", full_scale = \"10 V\" }",
            "is meaningful only for a command in % or mA"},
        Row{position, "position = { column = \"x_mm\", unit = \"mm\", full_scale = \"1 m\"",
            "is meaningful only for a command in % or mA"},
        Row{position, "position = { column = \"x_mm\", unit = \"%\"",
            "'%' is the unit of a pure number"},
        Row{command, "unit = \"bar\" }", "is the unit of a pressure"}}) {
    CAPTURE(row.with);
    CHECK_THROWS_WITH(load_text(replaced(electric(), row.part, row.with)),
                      Catch::Contains(row.message));
  }
}

TEST_CASE("drive_csv: a designed command has the unit of the recorded one", "[datasets]") {
  const Campaign campaign =
      load_text(replaced(electric(), "unit = \"V\" }", "unit = \"mA\", full_scale = \"40 mA\" }"));
  CHECK(drive_csv(campaign, {0.0, 0.5}, {0.0, 2.5}) == "time_s,command_mA\n0,0\n0.5,10\n");
  CHECK(written_drive(drive_unit(campaign), 2.5) == Approx(2.5));
}
