// Tests a rig in radians: its keys and units, what drives it, and what cannot be combined.

#include <catch2/catch.hpp>

#include "datasets/campaign/campaign_parameters.hpp"
#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::load_text;
using rigcal::test::replaced;

namespace {

const std::string kArm = R"(schema = "rigcal.campaign/1"
[rig]
model = "linkage"
[rig.parameters]
inertia = "8000 kg m2"
joint_damping = { start = "5 kN m s/rad", fit = true }
reference_angle = "-90 deg"
lever = "12 mm/deg"
lower_stop = "-150 deg"
upper_stop = "-30 deg"
area_a = "75 cm2"
area_b = "150 cm2"
dead_volume_a = "3 L"
dead_volume_b = "3 L"
tank_pressure = "2 bar"
supply_pressure = "340 bar"
density = "870 kg/m3"
bulk_modulus = "800 MPa"
discharge_coefficient = 0.65
area_gradient = "20 mm"
pilot_gain = "0.3 mm/bar"
pilot_dead_band = "12 bar"
leakage_coefficient = 0
leakage_area = "1 mm2"
[rig.controller]
type = "none"
[recording]
initial = "record"
[recording.channels]
time = { column = "t_s", unit = "s" }
pilot_pressure = { column = "out_bar", minus = "in_bar", unit = "bar" }
angle = { column = "angle_deg", unit = "deg", sd = "0.1 deg" }
pressure_a = { column = "rod_bar", unit = "bar" }
[acceptance]
rho2 = 0.99
[[condition]]
id = "out"
waveform = "recorded"
use = "fit"
repeats = ["out.csv"]
)";

double value(const Campaign& campaign, const char* key) {
  return values_in(campaign, campaign.conditions.front())[key];
}

}  // namespace

TEST_CASE("load_campaign: a linkage is in radians, and a pilot pressure drives it", "[datasets]") {
  const Campaign campaign = load_text(kArm);
  CHECK(campaign.rig.plant == model::PlantKind::linkage);
  CHECK(campaign.rig.pilot);
  CHECK(drive_channel(campaign) == Channel::pilot_pressure);
  CHECK(motion_channel(campaign) == Channel::angle);
  CHECK(value(campaign, "lever") == Approx(0.012 * 180.0 / 3.14159265358979));
  CHECK(value(campaign, "lower_stop") == Approx(-150.0 * 3.14159265358979 / 180.0));
  CHECK(value(campaign, "pilot_gain") == Approx(3e-9));
  const ChannelSetting& pilot = campaign.channels.at(Channel::pilot_pressure);
  CHECK(pilot.role == ChannelRole::input);
  CHECK(pilot.minus == "in_bar");  // one column per direction
  CHECK(campaign.channels.at(Channel::angle).role == ChannelRole::output);
  CHECK(*campaign.channels.at(Channel::angle).sd == Approx(0.1 * 3.14159265358979 / 180.0));
  // A limit without a channel applies to the motion.
  REQUIRE(campaign.acceptance.size() == 1);
  CHECK(campaign.acceptance.front().channel == Channel::angle);
  const int inertia = model::parameter_index(model::PlantKind::linkage, "inertia");
  CHECK(model::parameter_table(model::PlantKind::linkage)[static_cast<std::size_t>(inertia)].name ==
        "inertia_kg_m2");
}

TEST_CASE("load_campaign: the torque of a linkage is compared, and its sensor has errors",
          "[datasets]") {
  const std::string text = replaced(
      replaced(kArm, "pressure_a = {",
               "torque = { column = \"M_kNm\", unit = \"kN m\", sd = \"50 Nm\" }\npressure_a = {"),
      "leakage_area = \"1 mm2\"",
      "leakage_area = \"1 mm2\"\ntorque_lag = \"2 ms\"\n"
      "torque_offset = { start = \"0 N m\", lower = \"-1 kN m\", upper = \"1 kN m\", fit = true }");
  const Campaign campaign = load_text(text);
  const ChannelSetting& torque = campaign.channels.at(Channel::torque);
  CHECK(torque.role == ChannelRole::output);
  CHECK(torque.to_si(3.0) == Approx(3e3));
  CHECK(*torque.sd == Approx(50.0));
  CHECK(value(campaign, "torque_lag") == Approx(2e-3));
  CHECK(info(Channel::torque).name == "torque_n_m");
  CHECK_THROWS_WITH(load_text(replaced(text, "unit = \"kN m\"", "unit = \"kN\"")),
                    Catch::Contains("'kN' is the unit of a force") && Catch::Contains("a torque"));
}

TEST_CASE("load_campaign: a recorded moment is the load of a linkage where its role says so",
          "[datasets]") {
  const auto with_torque = [](const std::string& more) {
    return load_text(
        replaced(kArm, "pressure_a = {",
                 "torque = { column = \"M_kNm\", unit = \"kN m\"" + more + " }\npressure_a = {"));
  };
  Record record;
  record.time_s = {0.0, 1.0};
  record.channels[Channel::pilot_pressure].mean = {0.0, 0.0};
  record.channels[Channel::torque].mean = {100.0, 300.0};
  const auto load_of = [&record](const Campaign& campaign) {
    const Condition& out = campaign.conditions.front();
    return inputs_of(campaign, out, values_in(campaign, out), &record).external_load;
  };
  CHECK_FALSE(load_of(with_torque(", sd = \"50 Nm\"")));
  CHECK_FALSE(load_of(with_torque(", role = \"ignore\"")));
  const Campaign held = with_torque(", role = \"input\"");
  REQUIRE(load_of(held));
  CHECK(load_of(held)->value(0.5) == 100.0);
  CHECK(held.channels.at(Channel::torque).role == ChannelRole::input);
  CHECK(load_of(with_torque(", role = \"input\", interpolation = \"linear\""))->value(0.5) ==
        200.0);
  // The force on a piston is no load of a joint, and a torque none of a piston.
  CHECK_THROWS_WITH(load_text(replaced(kArm, "pressure_a = {",
                                       "force = { column = \"F\", unit = \"N\", role = \"input\" "
                                       "}\npressure_a = {")),
                    Catch::Contains("the channel torque"));
}

TEST_CASE("load_campaign: a linkage with an electric valve is driven by the command",
          "[datasets]") {
  std::string text = replaced(kArm, "pilot_gain = \"0.3 mm/bar\"\npilot_dead_band = \"12 bar\"",
                              "valve_gain = \"0.1 mm/V\"\nvalve_dead_band = \"1 V\"");
  text =
      replaced(text, "pilot_pressure = { column = \"out_bar\", minus = \"in_bar\", unit = \"bar\"",
               "command = { column = \"u_V\", unit = \"V\"");
  const Campaign campaign = load_text(text);
  CHECK_FALSE(campaign.rig.pilot);
  CHECK(drive_channel(campaign) == Channel::command);
}

namespace {

/// kArm with an electric valve under a loop on its angle.
std::string arm_loop() {
  std::string text = replaced(kArm, "pilot_gain = \"0.3 mm/bar\"\npilot_dead_band = \"12 bar\"",
                              "valve_gain = \"0.1 mm/V\"");
  text = replaced(text, "type = \"none\"",
                  "type = \"pid\"\nangle_kp = \"0.2 V/deg\"\nangle_ki = { start = \"5 V/(rad s)\", "
                  "lower = \"1 V/(rad s)\", upper = \"20 V/(rad s)\", fit = true }\n"
                  "output_limit = \"10 V\"");
  return replaced(text,
                  "pilot_pressure = { column = \"out_bar\", minus = \"in_bar\", unit = \"bar\"",
                  "angle_reference = { column = \"ref_deg\", unit = \"deg\", recognise = false");
}

}  // namespace

TEST_CASE("load_campaign: the controller of a linkage acts on its angle", "[datasets]") {
  const Campaign campaign = load_text(arm_loop());
  CHECK(campaign.rig.controller == model::ControllerKind::pid);
  CHECK(campaign.rig.feedback == model::Feedback::angle);
  CHECK(drive_channel(campaign) == Channel::angle_reference);
  const ChannelSetting& reference = campaign.channels.at(Channel::angle_reference);
  CHECK(reference.role == ChannelRole::input);
  CHECK(reference.to_si(180.0) == Approx(3.14159265358979));
  CHECK(value(campaign, "angle_kp") == Approx(0.2 * 180.0 / 3.14159265358979));
  CHECK(info(Channel::angle_reference).name == "angle_reference_rad");
  const std::string type = "type = \"pid\"";
  CHECK(load_text(replaced(arm_loop(), type, type + "\nfeedback = \"angle\"")).rig.feedback ==
        model::Feedback::angle);
  const std::string sine =
      replaced(arm_loop(), "waveform = \"recorded\"",
               "waveform = \"sine\"\nfrequency = \"0.5 Hz\"\namplitude = \"10 deg\"");
  CHECK(*load_text(sine).conditions.front().amplitude == Approx(3.14159265358979 / 18.0));
  CHECK_THROWS_WITH(load_text(replaced(sine, "10 deg", "10 mm")),
                    Catch::Contains("the waveform is the angle reference, in rad"));
}

TEST_CASE("load_campaign: the controller of a linkage may act on torque or pressure",
          "[datasets]") {
  struct Row {
    const char* feedback;
    const char* gains;
    const char* channel;
    const char* amplitude;
    Channel drive;
    const char* kp;
    double kp_si;
    double reference_si;  ///< SI value of a reading of 1
    double amplitude_si;
    const char* note;
  };
  const std::string gains =
      "angle_kp = \"0.2 V/deg\"\nangle_ki = { start = \"5 V/(rad s)\", lower = \"1 V/(rad s)\", "
      "upper = \"20 V/(rad s)\", fit = true }";
  for (const Row& row :
       {Row{"torque", "torque_kp = \"1 V/(kN m)\"\ntorque_ki = \"2 mV/(N m s)\"",
            "torque_reference = { column = \"M_kNm\", unit = \"kN m\", recognise = false", "2 kN m",
            Channel::torque_reference, "torque_kp", 1e-3, 1e3, 2e3,
            "the waveform is the torque reference, in N m"},
        Row{"load_pressure", "load_pressure_kp = \"0.02 V/bar\"",
            "load_pressure_reference = { column = \"p_bar\", unit = \"bar\", recognise = false",
            "20 bar", Channel::load_pressure_reference, "load_pressure_kp", 2e-7, 1e5, 2e6,
            "the waveform is the load_pressure reference, in Pa"}}) {
    CAPTURE(row.feedback);
    std::string text = replaced(arm_loop(), gains, row.gains);
    text = replaced(text, "type = \"pid\"",
                    "type = \"pid\"\nfeedback = \"" + std::string(row.feedback) + "\"");
    text = replaced(text,
                    "angle_reference = { column = \"ref_deg\", unit = \"deg\", recognise = false",
                    row.channel);
    const Campaign campaign = load_text(text);
    CHECK(model::gain_keys(campaign.rig.feedback).name == row.feedback);
    CHECK(drive_channel(campaign) == row.drive);
    CHECK(campaign.channels.at(row.drive).role == ChannelRole::input);
    CHECK(campaign.channels.at(row.drive).to_si(1.0) == Approx(row.reference_si));
    CHECK(value(campaign, row.kp) == Approx(row.kp_si));
    const std::string sine =
        replaced(text, "waveform = \"recorded\"",
                 "waveform = \"sine\"\nfrequency = \"0.5 Hz\"\namplitude = \"" +
                     std::string(row.amplitude) + "\"");
    CHECK(*load_text(sine).conditions.front().amplitude == Approx(row.amplitude_si));
    CHECK_THROWS_WITH(load_text(replaced(sine, row.amplitude, "10 deg")),
                      Catch::Contains(row.note));
    CHECK_THROWS_WITH(
        load_text(replaced(text, "type = \"pid\"",
                           "type = \"pid\"\nangular_velocity_feedforward = \"1 V s/rad\"\n"
                           "derivative_filter = \"200 rad/s\"")),
        Catch::Contains("angular_velocity_feedforward feeds the rate of an angle forward, but this "
                        "loop is on " +
                        std::string(row.feedback) + ": expected feedback = \"angle\""));
  }
}

TEST_CASE("load_campaign: what does not go together in a loop on the angle", "[datasets]") {
  struct Row {
    const char* part;
    const char* with;
    const char* message;
  };
  for (const Row& row :
       {Row{"type = \"pid\"", "type = \"pid\"\nfeedback = \"force\"",
            "key 'rig.controller.feedback': the controller of a linkage controls the angle of the "
            "joint, its torque or the pressure difference: expected \"angle\", \"torque\" or "
            "\"load_pressure\""},
        Row{"type = \"pid\"", "type = \"pid\"\nfeedback = \"torque\"",
            "angle_kp is a gain of a loop on angle, but this one is on torque: expected torque_kp, "
            "or feedback = \"angle\""},
        Row{"angle_kp", "torque_kp = \"1 mV/(N m)\"\nangle_kp",
            "torque_kp is a gain of a loop on torque, but this one is on angle"},
        Row{"angle_kp = \"0.2 V/deg\"\n", "", "the pid controller has no angle_kp"},
        Row{"angle_kp", "kp",
            "is a parameter of load_pressure and two_chamber, and not of linkage"},
        Row{"angle_kp", "angle_kd = \"1 V s/rad\"\nangle_kp", "angle_kd without derivative_filter"},
        Row{"output_limit", "velocity_feedforward = \"1 V s/m\"\noutput_limit",
            "is a parameter of load_pressure and two_chamber, and not of linkage"},
        Row{"output_limit", "angular_velocity_feedforward = \"1 V s/rad\"\noutput_limit",
            "angular_velocity_feedforward without derivative_filter: expected the corner N"},
        Row{"output_limit",
            "angular_velocity_feedforward = \"1 V s/rad\"\nangular_acceleration_feedforward = "
            "\"0.1 V s2/rad\"\nderivative_filter = \"200 rad/s\"\nsample_time = \"5 ms\"\n"
            "angle_kd = \"1 V s/rad\"\noutput_limit",
            "the rig has 9 states, and the solver of the plant linkage has room for 8: expected "
            "fewer of angular_acceleration_feedforward, angular_velocity_feedforward, angle_kd, "
            "sample_time, angle_ki"},
        Row{"valve_gain = \"0.1 mm/V\"",
            "valve_gain = \"0.1 mm/V\"\nvalve_frequency = \"40 Hz\"\nvalve_damping_ratio = 0.7\n"
            "pump_flow = \"100 L/min\"\nsupply_resistance = \"1e9 Pa s/m3\"\nsupply_capacity = "
            "\"1e-12 m3/Pa\"\npump_second_flow = \"150 L/min\"\npump_delay = \"1 s\"",
            "the rig has 9 states, and the solver of the plant linkage has room for 8: expected "
            "fewer of pump_second_flow, angle_ki"},
        Row{"angle_reference = { column = \"ref_deg\", unit = \"deg\", recognise = false",
            "reference = { column = \"ref_mm\", unit = \"mm\"",
            "the waveform \"recorded\" needs the channel angle_reference where a pid "
            "controller"}}) {
    CAPTURE(row.with);
    CHECK_THROWS_WITH(load_text(replaced(arm_loop(), row.part, row.with)),
                      Catch::Contains(row.message));
  }
}

TEST_CASE("load_campaign: a generated pilot pressure has an amplitude in bar", "[datasets]") {
  const std::string text =
      replaced(kArm, "waveform = \"recorded\"",
               "waveform = \"sine\"\nfrequency = \"0.5 Hz\"\namplitude = \"20 bar\"");
  CHECK(*load_text(text).conditions.front().amplitude == Approx(2e6));
  CHECK_THROWS_WITH(load_text(replaced(text, "20 bar", "2 V")),
                    Catch::Contains("pilot_gain makes the waveform a pilot pressure"));
}

TEST_CASE("load_campaign: what does not go together on a linkage", "[datasets]") {
  struct Row {
    const char* part;
    const char* with;
    const char* message;
  };
  const char* const gain = "pilot_gain = \"0.3 mm/bar\"";
  for (const Row& row : {
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\nvalve_gain = \"0.1 mm/V\"",
               "pilot_gain and valve_gain are both given: expected valve_gain (an electric valve"},
           Row{gain, "", "the gain of the valve is unknown"},
           Row{gain, "valve_gain = \"0.1 mm/V\"",
               "pilot_dead_band applies to a pilot-operated valve"},
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\nvalve_offset = \"0.1 V\"",
               "valve_offset is in volts"},
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\npump_flow = \"100 L/min\"",
               "a pump of limited flow needs supply_resistance"},
           Row{gain,
               "pilot_gain = \"0.3 mm/bar\"\npump_flow = \"100 L/min\"\nsupply_resistance = \"1e9 "
               "Pa s/m3\"\nsupply_capacity = \"1e-12 m3/Pa\"\npump_second_flow = \"150 L/min\"",
               "expected pump_delay as well"},
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\npump_delay = \"1 s\"",
               "pump_delay without a first flow: expected pump_flow"},
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\nbypass_opening = \"0.4 mm\"",
               "expected supply_resistance and supply_capacity"},
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\nbypass_range = \"8 bar\"",
               "bypass_range without a bypass: expected bypass_opening"},
           Row{gain, "pilot_gain = \"0.3 mm/bar\"\nmass = \"5 kg\"", "mass"},
           Row{"upper_stop = \"-30 deg\"", "upper_stop = \"-160 deg\"", "is not above lower_stop"},
           Row{"lever = \"12 mm/deg\"", "lever = \"12 mm/deg\"\nlever_gradient = \"-1 m/rad2\"",
               "expected one above 0 in all of the range"},
           Row{"type = \"none\"", "type = \"pid\"",
               "the controller's output is a voltage, and pilot_gain makes the pilot pressure"},
           Row{"angle = { column",
               "position = { column = \"x_m\", unit = \"m\" }\nangle = { column",
               "the plant linkage moves an arm, so its motion is the angle of the joint"},
           Row{"angle = { column",
               "force = { column = \"F_N\", unit = \"N\", role = \"output\" }\nangle = { column",
               "expected the channel torque (unit \"N m\")"},
           Row{"angle = { column",
               "base_acceleration = { column = \"a\", unit = \"m/s2\" }\nangle = { column",
               "the effect of a moving base depends on lengths"},
           Row{"unit = \"deg\", sd", "unit = \"mm\", sd", "angle"},
       }) {
    CAPTURE(row.with);
    CHECK_THROWS_WITH(load_text(replaced(kArm, row.part, row.with)), Catch::Contains(row.message));
  }
}

namespace {

const char* const kLever = "lever = \"12 mm/deg\"";
const std::string kTriangle =
    "triangle_base = \"1.9 m\"\ntriangle_arm = \"800 mm\"\ntriangle_angle = \"95 deg\"";
const std::string kTravel =
    "travel_table_from = \"-160 deg\"\ntravel_table_to = \"-20 deg\"\ntravel_0 = \"0 "
    "mm\"\ntravel_20 = \"0.3 m\"\ntravel_40 = \"0.65 m\"\ntravel_60 = \"1.05 m\"\ntravel_80 = "
    "{ start = \"1.4 m\", lower = \"1.2 m\", upper = \"1.6 m\", fit = true }\ntravel_100 = "
    "\"1.7 m\"";

}  // namespace

TEST_CASE("load_campaign: the lever of a linkage by a triangle, or the travel by a table",
          "[datasets]") {
  const Campaign triangle = load_text(replaced(kArm, kLever, kTriangle));
  CHECK(value(triangle, "triangle_arm") == Approx(0.8));
  CHECK(value(triangle, "triangle_angle") == Approx(95.0 * 3.14159265358979 / 180.0));
  // The cylinder may be on the other side of the joint.
  CHECK_NOTHROW(load_text(replaced(kArm, kLever, replaced(kTriangle, "95 deg", "-95 deg"))));
  const Campaign travel = load_text(replaced(kArm, kLever, kTravel));
  CHECK(value(travel, "travel_table_to") == Approx(-20.0 * 3.14159265358979 / 180.0));
  CHECK(value(travel, "travel_80") == Approx(1.4));
}

TEST_CASE("load_campaign: exactly one law gives the travel of a linkage", "[datasets]") {
  struct Row {
    std::string with;
    const char* message;
  };
  const std::string lever = kLever;
  for (const Row& row :
       {Row{"", "the travel of the piston per angle is unknown: expected lever, or a triangle"},
        Row{"lever_gradient = \"1 m/rad2\"", "by a polynomial needs lever: expected lever as well"},
        Row{lever + "\n" + kTriangle,
            "triangle_base (the travel of the piston by a triangle) is combined with lever"},
        Row{kTriangle + "\n" + kTravel,
            "travel_table_from (the travel of the piston by a table) is combined with "
            "triangle_base (by a triangle)"},
        Row{replaced(kTriangle, "triangle_arm = \"800 mm\"", ""),
            "needs triangle_base, triangle_arm and triangle_angle: expected triangle_arm as well"},
        Row{replaced(kTravel, "travel_40 = \"0.65 m\"", ""), "expected travel_40 as well"},
        Row{replaced(kTravel, "\"-20 deg\"", "\"-170 deg\""), "is not above travel_table_from"},
        Row{replaced(kTravel, "0.65 m", "0.3 m"), "travel_40 = 0.3 m is not above travel_20 = 0.3"},
        Row{replaced(kTriangle, "95 deg", "50 deg"),
            "between triangle_base and triangle_arm is -0.174533 rad at lower_stop: expected one "
            "between 0 and 3.14159 rad from stop to stop"},
        Row{replaced(kTriangle, "95 deg", "125 deg"), "rad at upper_stop"},
        Row{replaced(kTriangle, "95 deg", "-50 deg"),
            "rad at upper_stop: expected one between -3.14159 and 0 rad"}}) {
    CAPTURE(row.with);
    CHECK_THROWS_WITH(load_text(replaced(kArm, kLever, row.with)), Catch::Contains(row.message));
  }
}

TEST_CASE("load_campaign: the cylinder of a linkage has friction of its own", "[datasets]") {
  const auto with = [](const std::string& lines) {
    return load_text(replaced(kArm, kLever, std::string(kLever) + "\n" + lines));
  };
  const auto campaign = with(
      "coulomb_friction = \"1 kN\"\nseal_friction = \"1 cm2\"\nbristle_stiffness = \"10 N/um\"");
  CHECK(value(campaign, "seal_friction") == Approx(1e-4));
  CHECK(value(campaign, "bristle_stiffness") == Approx(1e7));
  CHECK_THROWS_WITH(with("bristle_stiffness = \"1 N/um\""),
                    Catch::Contains("expected coulomb_friction as well"));
  CHECK_THROWS_WITH(with("film_velocity = \"0.1 m/s\""),
                    Catch::Contains("expected film_growth_time as well"));
}

TEST_CASE("load_campaign: a rotary actuator has a displacement, and no linkage", "[datasets]") {
  const std::string areas = "area_a = \"75 cm2\"\narea_b = \"150 cm2\"\n";
  const std::string displacement = "displacement_per_radian = \"300 cm3/rad\"";
  const std::string vane = replaced(replaced(kArm, areas, ""), kLever, displacement);
  CHECK(value(load_text(vane), "displacement_per_radian") == Approx(3e-4));
  for (const std::string& other :
       {std::string("area_a = \"75 cm2\""), std::string(kLever), kTriangle, kTravel}) {
    CAPTURE(other);
    CHECK_THROWS_WITH(
        load_text(replaced(vane, displacement, displacement + "\n" + other)),
        Catch::Contains(
            "applies to a cylinder on a linkage, but displacement_per_radian makes the rig "
            "a rotary actuator: expected only one of them"));
  }
  for (const char* friction : {"coulomb_friction = \"1 N\"", "seal_friction = \"1 mm2\"",
                               "bristle_damping = \"1 N s/m\"", "film_velocity = \"1 mm/s\""}) {
    CAPTURE(friction);
    CHECK_THROWS_WITH(load_text(replaced(vane, displacement, displacement + "\n" + friction)),
                      Catch::Contains("whose friction is a moment: expected joint_friction"));
  }
  CHECK_THROWS_WITH(load_text(replaced(vane, displacement, "")),
                    Catch::Contains("no value for area_a: expected a known value or a start in "
                                    "[rig.parameters], or displacement_per_radian"));
  CHECK_THROWS_WITH(load_text(replaced(kArm, "area_b = \"150 cm2\"", "")),
                    Catch::Contains("no value for area_b"));
}

TEST_CASE("load_campaign: a load that slides has no angle and no torque", "[datasets]") {
  CHECK_THROWS_WITH(
      load_text(replaced(
          test::kExample, "pressure_a = { unit = \"bar\" }",
          "pressure_a = { unit = \"bar\" }\nangle = { column = \"a_deg\", unit = \"deg\" }")),
      Catch::Contains("moves a load along a line, and has no joint"));
  CHECK_THROWS_WITH(
      load_text(replaced(
          test::kExample, "pressure_a = { unit = \"bar\" }",
          "pressure_a = { unit = \"bar\" }\ntorque = { column = \"M_Nm\", unit = \"N m\" }")),
      Catch::Contains("has no joint: expected the channel force"));
  CHECK_THROWS_WITH(
      load_text(replaced(test::kExample, "type = \"pid\"", "type = \"pid\"\nfeedback = \"angle\"")),
      Catch::Contains("the plant load_pressure has no joint: expected another quantity"));
}

TEST_CASE("load_campaign: a rotary actuator is stated in the units of its data sheet",
          "[datasets]") {
  struct Row {
    const char* key;
    const char* text;
    double si;
  };
  const std::string vane =
      replaced(replaced(replaced(kArm, "lever = \"12 mm/deg\"\n", ""), "area_a = \"75 cm2\"\n", ""),
               "area_b = \"150 cm2\"\n", "");
  const double turn = 2.0 * 3.14159265358979;
  for (const Row& row :
       {Row{"displacement_per_radian", "50 cm3/rev", 50e-6 / turn},
        Row{"displacement_per_radian", "50 cm^3/rev", 50e-6 / turn},
        Row{"displacement_per_radian", "50 mL/turn", 50e-6 / turn},
        Row{"displacement_per_radian", "3 in3/rev", 4.9161192e-5 / turn},
        Row{"displacement_per_radian", "8e-6 m^3/rad", 8e-6},
        Row{"displacement_per_radian", "0.14 cm3/deg", 0.14e-6 * 360.0 / turn},
        Row{"joint_friction", "20 Nm", 20.0}, Row{"joint_friction", "0.02 kNm", 20.0},
        Row{"joint_friction", "20 N.m", 20.0},
        Row{"joint_friction", "15 ft lbf", 15.0 * 1.3558179483314},
        Row{"joint_damping", "3 N m s/rad", 3.0}, Row{"joint_damping", "3 Nm/(rad/s)", 3.0},
        Row{"joint_damping", "0.3 N m/rpm", 0.3 * 60.0 / turn},
        Row{"laminar_leakage", "1 cm3/(min bar)", 1e-6 / 60.0 / 1e5}}) {
    CAPTURE(row.key, row.text);
    const std::string line = std::string(row.key) + " = \"" + row.text + "\"\n";
    std::string text = replaced(vane, "tank_pressure =", line + "tank_pressure =");
    const bool damping = std::string(row.key) == "joint_damping";
    if (damping)
      text = replaced(text, "joint_damping = { start = \"5 kN m s/rad\", fit = true }\n", "");
    if (std::string(row.key) != "displacement_per_radian")
      text = replaced(
          text, "tank_pressure =", "displacement_per_radian = \"8 cm3/rad\"\ntank_pressure =");
    CHECK(value(load_text(text), row.key) == Approx(row.si).epsilon(1e-9));
  }
  CHECK_THROWS_WITH(load_text(replaced(vane, "tank_pressure =",
                                       "displacement_per_radian = \"50 cm3\"\ntank_pressure =")),
                    Catch::Contains("'cm3' differs by an angle") && Catch::Contains("50 cm3/rev"));
}

TEST_CASE("load_campaign: the load of a joint is not the column that its loop follows",
          "[datasets]") {
  std::string text = replaced(arm_loop(), "type = \"pid\"\nangle_kp = \"0.2 V/deg\"",
                              "type = \"pid\"\nfeedback = \"torque\"\ntorque_kp = \"1 V/kNm\"");
  text = replaced(text,
                  "\nangle_ki = { start = \"5 V/(rad s)\", lower = \"1 V/(rad s)\", upper = "
                  "\"20 V/(rad s)\", fit = true }",
                  "");
  text = replaced(text, "angle_reference = { column = \"ref_deg\", unit = \"deg\"",
                  "torque = { column = \"M_kNm\", unit = \"kN m\", role = \"input\" }\n"
                  "torque_reference = { column = \"ref_kNm\", unit = \"kN m\"");
  const Campaign campaign = load_text(text);
  CHECK(drive_channel(campaign) == Channel::torque_reference);
  CHECK(external_load_channel(campaign) == Channel::torque);
  const std::string same = replaced(text, "\"ref_kNm\"", "\"M_kNm\"");
  CHECK_THROWS_WITH(load_text(same), Catch::Contains("the column 'M_kNm' is torque_reference") &&
                                         Catch::Contains("the load torque") &&
                                         Catch::Contains("role = \"output\""));
  // Compared with the model it is no load, and a repeat may name columns of its own.
  CHECK_NOTHROW(load_text(replaced(same, "role = \"input\"", "role = \"output\"")));
  const std::string own = "repeats = [{ file = \"out.csv\", columns = { torque = \"ref_kNm\" } }]";
  CHECK_THROWS_WITH(load_text(replaced(text, "repeats = [\"out.csv\"]", own)),
                    Catch::Contains("the column 'ref_kNm' is torque_reference"));
  CHECK_NOTHROW(load_text(replaced(same, "repeats = [\"out.csv\"]", own)));
}
