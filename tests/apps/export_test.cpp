#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/two_chamber_fixture.hpp"
#include "tests/support/fmu.hpp"
#include "tests/support/sanitized.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;
using SimulatedColumns = std::map<std::string, std::vector<double>>;
using Drive = std::function<double(double)>;

/// Tolerance of both simulations at each step. The comparison is a hundred times coarser.
constexpr double kTolerance = 1e-9;

const Edits kGeneratedRuns{
    {"repeats = [\"records/sine_*.csv\"]", "duration = \"0.6 s\"\nsample_rate = \"200 Hz\""},
    {"repeats = [\"records/square_*.csv\"]", "duration = \"0.6 s\"\nsample_rate = \"200 Hz\""},
    {"[acceptance]", "[simulation]\ntolerance = 1e-9\n[acceptance]"}};

const Edits kTwoChamberGeneratedRuns{
    {"repeats = [\"records/square_*.csv\"]",
     "duration = \"0.6 s\"\nsample_rate = \"200 Hz\"\n[[condition]]\nid = \"sine\"\nwaveform = "
     "\"sine\"\nfrequency = \"2 Hz\"\namplitude = \"1 V\"\nuse = \"fit\"\nduration = \"0.6 "
     "s\"\nsample_rate = \"200 Hz\""},
    {"[recording.channels]", "[simulation]\ntolerance = 1e-9\n[recording.channels]"}};

const std::string kLoadTable =
    "load_table_from = \"-15 mm\"\nload_table_to = \"16 mm\"\nload_0 = \"90 N\"\nload_20 = \"-50 "
    "N\"\nload_40 = \"70 N\"\nload_60 = \"-30 N\"\nload_80 = \"40 N\"\nload_100 = \"-60 N\"\n";

const std::string kWarmOil =
    "reference_temperature = \"40 degC\"\noil_temperature = \"55 degC\"\nviscosity_decay = "
    "\"0.03 1/K\"\nthermal_expansion = \"7e-4 1/K\"\nbulk_modulus_decay = \"5.5e-3 1/K\"\n";

/// A vane motor against a spring. The gains of its loop come after `type`, and the amplitude of
/// both conditions is the reference's.
std::string vane_campaign(const std::string& controller, const std::string& amplitude) {
  std::string text = R"toml(schema = "rigcal.campaign/1"
[rig]
model = "linkage"
[rig.parameters]
inertia = "20 kg m2"
joint_damping = "500 N m s/rad"
displacement_per_radian = "200 cm3/rad"
lower_stop = "-140 deg"
upper_stop = "140 deg"
gravity_moment_gradient = "5 kN m/rad"
joint_friction = "30 N m"
joint_friction_smoothing = "0.05 rad/s"
dead_volume_a = "0.2 L"
dead_volume_b = "0.2 L"
tank_pressure = "2 bar"
supply_pressure = "140 bar"
density = "870 kg/m3"
bulk_modulus = "800 MPa"
discharge_coefficient = 0.65
area_gradient = "20 mm"
valve_gain = "0.02 mm/V"
valve_time_constant = "5 ms"
leakage_coefficient = 0
leakage_area = "1 mm2"
[recording]
initial = "rest"
[recording.channels]
time = { column = "t_s", unit = "s" }
angle = { column = "angle_deg", unit = "deg", sd = "0.5 mrad" }
[simulation]
tolerance = 1e-9
[rig.controller]
type = "pid"
)toml";
  text += controller;
  for (const auto& [waveform, frequency] : {std::pair{"sine", "2 Hz"}, std::pair{"square", "1 Hz"}})
    text += "[[condition]]\nid = \"" + std::string(waveform) + "\"\nwaveform = \"" + waveform +
            "\"\nfrequency = \"" + frequency + "\"\namplitude = \"" + amplitude +
            "\"\nuse = \"fit\"\nduration = \"0.6 s\"\nsample_rate = \"200 Hz\"\n";
  return text;
}

/// An arm with a pilot-operated valve, all of its metering terms, and a pump of two stages.
const std::string kArm = R"toml(schema = "rigcal.campaign/1"
[rig]
model = "linkage"
[rig.parameters]
inertia = "3000 kg m2"
joint_damping = "20 kN m s/rad"
joint_friction = "200 N m"
joint_friction_smoothing = "0.02 rad/s"
reference_angle = "20 deg"
lever = "0.6 m/rad"
lever_gradient = "-0.1 m/rad2"
lever_curvature = "-0.1 m/rad3"
gravity_moment = "20 kN m"
gravity_moment_gradient = "5 kN m/rad"
gravity_moment_curvature = "-5 kN m/rad2"
lower_stop = "-60 deg"
upper_stop = "100 deg"
area_a = "100 cm2"
area_b = "60 cm2"
dead_volume_a = "4 L"
dead_volume_b = "6 L"
external_leakage_b = "1e-12 m3/(s Pa)"
tank_pressure = "2 bar"
supply_pressure = "200 bar"
supply_resistance = "1e9 Pa s/m3"
supply_capacity = "2e-11 m3/Pa"
accumulator_volume = "0.2 L"
accumulator_precharge = "60 bar"
accumulator_exponent = 1.3
pump_flow = "40 L/min"
pump_first_rate = "10 (L/min)/s"
pump_second_flow = "80 L/min"
pump_delay = "0.15 s"
pump_rise = "50 ms"
load_sensing_margin = "30 bar"
density = "870 kg/m3"
bulk_modulus = "600 MPa"
discharge_coefficient = 0.65
area_gradient = "20 mm"
pilot_gain = "0.05 mm/bar"
pilot_dead_band = "3 bar"
pilot_range = "10 bar"
pilot_exponent = 1.4
valve_time_constant = "10 ms"
gain_supply_to_a = 0.9
gain_a_to_tank = 1.2
gain_supply_to_b = 1.1
gain_b_to_tank = 1.5
compensator_pressure = "12 bar"
return_dead_band = "4 bar"
return_exponent = 1.2
return_line_opening = "2 mm"
return_line_resistance = "1e9 Pa s/m3"
bypass_opening = "1 mm"
bypass_range = "15 bar"
relief_pressure = "60 bar"
relief_conductance = "1e-10 m3/(s Pa)"
make_up_conductance = "1e-8 m3/(s Pa)"
leakage_coefficient = 0.1
leakage_area = "1 mm2"
leakage_resistance = "1e11 Pa s/m3"
[rig.controller]
type = "none"
[recording]
initial = "rest"
[recording.channels]
time = { column = "t_s", unit = "s" }
angle = { column = "angle_deg", unit = "deg", sd = "0.5 mrad" }
[simulation]
tolerance = 1e-9
[[condition]]
id = "sine"
waveform = "sine"
frequency = "2 Hz"
amplitude = "20 bar"
use = "fit"
duration = "0.6 s"
sample_rate = "200 Hz"
[[condition]]
id = "square"
waveform = "square"
frequency = "1 Hz"
amplitude = "20 bar"
use = "fit"
duration = "0.6 s"
sample_rate = "200 Hz"
)toml";

/// The condition "square" of every campaign. At 1 Hz its edges are at half seconds.
Drive square(double amplitude) {
  return [amplitude](double t) { return std::fmod(t + 1e-9, 1.0) < 0.5 ? amplitude : -amplitude; };
}
Drive sine(double amplitude) {
  return [amplitude](double t) { return amplitude * std::sin(4.0 * std::numbers::pi * t); };
}

SimulatedColumns simulated(const CommandFolder& folder, const std::string& condition) {
  const Outcome outcome =
      folder.run({"simulate", "campaign.toml", "--condition", condition, "--out", "simulated"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  SimulatedColumns columns;
  std::istringstream csv(folder.read("simulated/" + condition + ".csv"));
  std::string line;
  std::getline(csv, line);
  std::vector<std::string> names;
  std::istringstream head(line);
  for (std::string name; std::getline(head, name, ',');) names.push_back(name);
  while (std::getline(csv, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (const std::string& name : names) {
      std::getline(cells, cell, ',');
      columns[name].push_back(std::strtod(cell.c_str(), nullptr));
    }
  }
  return columns;
}

/// Exports the campaign in a folder and unpacks the FMU.
Fmu exported(const CommandFolder& folder, CommandFolder::Arguments more = {}) {
  CommandFolder::Arguments arguments{"export", "fmu", "campaign.toml", "--out", "fmu"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = folder.run(arguments);
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder.work() / "fmu")) {
    if (entry.path().extension() != ".fmu") continue;
    const auto to = folder.work() / "unpacked f\u00fcr 1" / entry.path().stem();
    unzip(entry.path(), to);
    return Fmu(to);
  }
  throw std::runtime_error("nothing was exported");
}

/// Maps the names of the outputs to the names of the columns that `simulate` writes.
std::map<std::string, std::string> outputs_of(const Fmu& fmu, const SimulatedColumns& columns) {
  std::map<std::string, std::string> outputs;
  for (const auto& [name, variable] : fmu.variables) {
    if (variable.causality != "output") continue;
    for (const auto& [column, values] : columns) {
      if (column.rfind(name + "_", 0) == 0 && column.size() - name.size() < 12)
        outputs[name] = column;
    }
  }
  return outputs;
}

double peak_of(const std::vector<double>& values) {
  double peak = 0.0;
  for (const double value : values) peak = std::max(peak, std::abs(value));
  return peak;
}

/// Compares every output at every sample to a millionth of the peak of its column. The tolerance is
/// ten times larger for leakage, a square root of the pressure with a steep slope at zero, and for
/// accelerations, which are small differences of large forces.
void require_same(FmuRun& run, const std::map<std::string, std::string>& outputs,
                  const SimulatedColumns& columns, std::size_t sample) {
  for (const auto& [name, column] : outputs) {
    const std::vector<double>& values = columns.at(column);
    const double tolerance = name == "leakage_flow" || name == "acceleration" ? 1e-5 : 1e-6;
    INFO(name << " at sample " << sample << ", off by "
              << (run.get(name) - values[sample]) / peak_of(values) << " of its peak");
    REQUIRE(run.get(name) == Approx(values[sample]).margin(tolerance * peak_of(values)).epsilon(0));
  }
}

/// Runs a co-simulation whose inputs are linear between communication points. There are enough
/// points that a 2 Hz sine is off by only (2 pi f h)^2 / 8 = 5e-8 of its amplitude, an error that
/// accelerations amplify.
void require_co_simulation(const Fmu& fmu, const FmuLibrary& library, const std::string& input,
                           const Drive& drive, bool jumps, const SimulatedColumns& columns) {
  FmuRun run(fmu, library, fmi2CoSimulation);
  REQUIRE(run.component != nullptr);
  run.initialize(0.0, kTolerance, {{input, drive(0.0)}});
  const auto outputs = outputs_of(fmu, columns);
  REQUIRE(outputs.size() >= 10);
  const auto& times = columns.at("time_s");
  REQUIRE(times.size() == 121);
  for (std::size_t i = 0; i < times.size(); ++i) {
    run.require(run.set(input, drive(times[i])));
    require_same(run, outputs, columns, i);
    if (i + 1 == times.size()) break;
    const int parts = jumps ? 1 : 100;
    const double h = (times[i + 1] - times[i]) / parts;
    for (int k = 0; k < parts; ++k) {
      const double t = times[i] + k * h;
      run.require(run.set(input, drive(t)));
      if (!jumps) run.require(run.set_slope(input, (drive(t + h) - drive(t)) / h));
      run.require(run.step(t, h));
    }
  }
  CHECK(run.messages().empty());
}

void require_model_exchange(const Fmu& fmu, const FmuLibrary& library, const std::string& input,
                            const Drive& drive, bool jumps, const SimulatedColumns& columns) {
  FmuRun run(fmu, library, fmi2ModelExchange);
  REQUIRE(run.component != nullptr);
  run.initialize(0.0, kTolerance, {{input, drive(0.0)}});
  ExchangeRun exchange(run);
  const auto outputs = outputs_of(fmu, columns);
  const auto& times = columns.at("time_s");
  for (std::size_t i = 0; i < times.size(); ++i) {
    run.require(run.set(input, drive(times[i])));
    const auto& info = exchange.info();
    if (info.nextEventTimeDefined != fmi2False && times[i] > info.nextEventTime - 1e-9)
      exchange.event();
    require_same(run, outputs, columns, i);
    if (i + 1 == times.size()) break;
    const double held = drive(times[i]);
    exchange.advance(times[i], times[i + 1], 400,
                     [&](double t) { run.require(run.set(input, jumps ? held : drive(t))); });
  }
  std::vector<double> indicators(fmu.indicators());
  run.require(RIGCAL_FMI2(library, fmi2GetEventIndicators)(run.component, indicators.data(),
                                                           indicators.size()));
  CHECK(run.messages().empty());
}

/// Checks every condition with its drive, with both interfaces.
void require_both(const CommandFolder& folder, const std::string& input,
                  const std::map<std::string, Drive>& drives) {
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  for (const auto& [condition, drive] : drives) {
    CAPTURE(condition);
    const SimulatedColumns columns = simulated(folder, condition);
    const bool jumps = condition == "square";
    require_co_simulation(fmu, library, input, drive, jumps, columns);
    require_model_exchange(fmu, library, input, drive, jumps, columns);
  }
}

}  // namespace

TEST_CASE("export: a closed loop with a leak runs as simulate has it", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  require_both(folder, "reference", {{"sine", sine(0.005)}, {"square", square(0.004)}});
}

TEST_CASE("export: two chambers in open loop run as simulate has them", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kTwoChamber, kTwoChamberGeneratedRuns));
  require_both(folder, "command", {{"sine", sine(1.0)}, {"square", square(1.0)}});
}

TEST_CASE("export: every term that an FMU can have is in it", "[apps][long]") {
  const CommandFolder folder;
  SECTION("load pressure") {
    Edits edits = kGeneratedRuns;
    edits.push_back({"mass = \"60 kg\"", "mass = \"60 kg\"\n" + kLoadTable});
    edits.push_back({"leakage_coefficient = 0.3",
                     "leakage_coefficient = 0.3\nlaminar_leakage = \"1e-13 m3/(s "
                     "Pa)\"\ncoulomb_friction = \"40 N\"\nstribeck_friction = \"20 "
                     "N\"\nexternal_force = \"100 N\"\nvalve_frequency = \"400 "
                     "rad/s\"\nvalve_damping_ratio = 0.9\nvalve_rate_limit = \"200 "
                     "V/s\"\nvalve_offset = \"20 mV\"\nvalve_dead_band = \"50 "
                     "mV\"\nvalve_null_leakage = \"1e-13 m3/(s Pa)\""});
    edits.push_back({"kp = \"1000 V/m\"",
                     "kp = \"400 V/m\"\nki = \"500 V/(m s)\"\nkd = \"1 V s/m\"\n"
                     "derivative_filter = \"300 rad/s\"\noutput_limit = \"1.5 V\""});
    folder.write("campaign.toml", edited(kCampaign, edits));
    require_both(folder, "reference", {{"sine", sine(0.005)}, {"square", square(0.004)}});
  }
  SECTION("two chambers") {
    Edits edits = kTwoChamberGeneratedRuns;
    edits.push_back({"area_gradient =", kLoadTable + "area_gradient ="});
    edits.push_back(
        {"stroke = \"200 mm\"",
         "stroke = \"40 mm\"\ngravity = \"9.81 m/s2\"\nair_fraction = 0.01\nvalve_time_constant = "
         "\"3 ms\"\nvalve_null_opening = \"20 mV\"\nvalve_line_opening = \"3 "
         "V\"\nexternal_leakage_a = \"1e-13 m3/(s Pa)\"\nsupply_resistance = \"1e10 Pa "
         "s/m3\"\nsupply_capacity = \"1e-12 m3/Pa\"\nhose_capacity_a = \"1e-13 "
         "m3/Pa\"\nhose_yield = \"5 bar\"\nstop_stiffness = \"1e6 N/m\"\nstop_damping = \"1 "
         "s/m\""});
    folder.write("campaign.toml", edited(kTwoChamber, edits));
    require_both(folder, "command", {{"sine", sine(1.0)}, {"square", square(1.0)}});
  }
  SECTION("feed-forward, inner feedback, seals and a leak in one law, with warm oil") {
    Edits edits = kGeneratedRuns;
    edits.push_back({"leakage_coefficient = 0.3",
                     "leakage_coefficient = 0.3\nleakage_resistance = \"2e10 Pa "
                     "s/m3\"\ncoulomb_friction = \"30 N\"\nseal_friction = \"20 mm2\"\n" +
                         kWarmOil});
    edits.push_back({"kp = \"1000 V/m\"",
                     "kp = \"400 V/m\"\nki = \"500 V/(m s)\"\nderivative_filter = \"300 "
                     "rad/s\"\nvelocity_feedforward = \"4 V s/m\"\nacceleration_feedforward = "
                     "\"0.02 V s2/m\"\npressure_feedback = \"5e-8 V/Pa\"\noutput_limit = \"5 V\""});
    folder.write("campaign.toml", edited(kCampaign, edits));
    require_both(folder, "reference", {{"sine", sine(0.005)}, {"square", square(0.004)}});
  }
  SECTION("a vane motor under a loop on its torque, with inner feedback") {
    folder.write("campaign.toml",
                 vane_campaign("feedback = \"torque\"\ntorque_kp = \"2 V/(kN m)\"\ntorque_ki = "
                               "\"5 V/(kN m s)\"\ntorque_kd = \"20 mV s/(kN m)\"\n"
                               "derivative_filter = \"200 rad/s\"\noutput_limit = \"5 V\"\n"
                               "pressure_feedback = \"5e-8 V/Pa\"\n",
                               "600 N m"));
    require_both(folder, "reference", {{"sine", sine(600.0)}, {"square", square(600.0)}});
  }
  SECTION("a vane motor under a loop on its load pressure") {
    folder.write("campaign.toml", vane_campaign("feedback = \"load_pressure\"\n"
                                                "load_pressure_kp = \"0.04 V/bar\"\n"
                                                "load_pressure_ki = \"0.1 V/(bar s)\"\n",
                                                "30 bar"));
    require_both(folder, "reference", {{"sine", sine(3e6)}, {"square", square(3e6)}});
  }
  SECTION("a vane motor under a loop on its angle, with feed-forward") {
    // Small, since it amplifies the steps in the slope of an input that is linear between points.
    folder.write("campaign.toml",
                 vane_campaign("angle_kp = \"10 V/rad\"\nderivative_filter = \"200 rad/s\"\n"
                               "angular_velocity_feedforward = \"2 V s/rad\"\n"
                               "angular_acceleration_feedforward = \"0.01 V s2/rad\"\n"
                               "output_limit = \"8 V\"\n",
                               "0.1 rad"));
    require_both(folder, "reference", {{"sine", sine(0.1)}, {"square", square(0.1)}});
  }
  SECTION("an arm with its pilot-operated valve and its pump") {
    folder.write("campaign.toml", kArm);
    require_both(folder, "pilot_pressure", {{"sine", sine(2e6)}, {"square", square(2e6)}});
  }
  SECTION("a supply that gives way, with its pump, accumulator and relief valves") {
    Edits edits = kGeneratedRuns;
    edits.push_back({"mass = \"60 kg\"",
                     "mass = \"60 kg\"\nsupply_resistance = \"1e10 Pa "
                     "s/m3\"\nsupply_capacity = \"1e-13 m3/Pa\"\npump_flow = \"5 "
                     "L/min\"\naccumulator_volume = \"2 mL\"\naccumulator_precharge = \"30 "
                     "bar\"\naccumulator_exponent = 1.3\nrelief_pressure = \"35 "
                     "bar\"\nrelief_conductance = \"1e-11 m3/(s Pa)\""});
    folder.write("campaign.toml", edited(kCampaign, edits));
    require_both(folder, "reference", {{"sine", sine(0.005)}, {"square", square(0.004)}});
  }
  SECTION("an arm whose cylinder rubs, on a lubricant film") {
    // Without the second flow of the pump, the solver has room for the film.
    folder.write("campaign.toml",
                 edited(kArm, {{"pump_first_rate = \"10 (L/min)/s\"\npump_second_flow = \"80 "
                                "L/min\"\npump_delay = \"0.15 s\"\npump_rise = \"50 ms\"\n",
                                ""},
                               {"joint_friction = ",
                                "coulomb_friction = \"1 kN\"\nstribeck_friction = \"600 "
                                "N\"\nseal_friction = \"1 cm2\"\nbristle_stiffness = \"10 "
                                "N/um\"\nbristle_damping = \"10 N s/mm\"\nfilm_velocity = \"50 "
                                "mm/s\"\nfilm_growth_time = \"50 ms\"\nfilm_decay_time = \"0.2 "
                                "s\"\nfilm_dwell_time = \"5 s\"\njoint_friction = "}}));
    require_both(folder, "pilot_pressure", {{"sine", sine(2e6)}, {"square", square(2e6)}});
  }
  SECTION("a loop on force, against a load that varies with the travel") {
    Edits edits = kGeneratedRuns;
    edits.push_back({"mass = \"60 kg\"",
                     "mass = \"60 kg\"\nload_gradient = \"80 kN/m\"\nload_curvature = "
                     "\"500 kN/m2\"\nstribeck_friction = \"20 N\"\nstribeck_velocity = "
                     "\"20 mm/s\"\nfriction_smoothing = \"10 mm/s\""});
    edits.push_back({"type = \"pid\"", "type = \"pid\"\nfeedback = \"force\""});
    edits.push_back({"kp = \"1000 V/m\"",
                     "force_kp = \"2 V/kN\"\nforce_ki = \"5 V/(kN s)\"\noutput_limit = "
                     "\"5 V\""});
    edits.push_back({"amplitude = \"5 mm\"", "amplitude = \"300 N\""});
    edits.push_back({"amplitude = \"4 mm\"", "amplitude = \"200 N\""});
    folder.write("campaign.toml", edited(kCampaign, edits));
    require_both(folder, "reference", {{"sine", sine(300.0)}, {"square", square(200.0)}});
  }
  SECTION("overlaps and gains of edges, hoses that yield, air") {
    Edits edits = kTwoChamberGeneratedRuns;
    edits.push_back(
        {"stroke = \"200 mm\"",
         "stroke = \"200 mm\"\nair_fraction = 0.005\nair_exponent = 1.2\nhose_capacity_a = "
         "\"1e-13 m3/Pa\"\nhose_capacity_b = \"2e-13 m3/Pa\"\nhose_yield = "
         "\"5 bar\"\nhose_yield_ratio = 20\nexternal_leakage_b = \"1e-13 m3/(s "
         "Pa)\"\nvalve_time_constant = \"3 ms\"\noverlap_supply_to_a = \"20 "
         "mV\"\noverlap_a_to_tank = \"-10 mV\"\noverlap_supply_to_b = \"30 "
         "mV\"\noverlap_b_to_tank = \"15 mV\"\ngain_supply_to_a = 0.9\ngain_a_to_tank = "
         "1.1\ngain_supply_to_b = 1.2\ngain_b_to_tank = 0.8"});
    folder.write("campaign.toml", edited(kTwoChamber, edits));
    require_both(folder, "command", {{"sine", sine(1.0)}, {"square", square(1.0)}});
  }
  SECTION("edges by a power, with seals") {
    Edits edits = kTwoChamberGeneratedRuns;
    edits.push_back({"leakage_coefficient = 0",
                     "leakage_coefficient = 0.05\nleakage_resistance = \"5e11 Pa s/m3\""});
    edits.push_back(
        {"stroke = \"200 mm\"",
         "stroke = \"200 mm\"\nvalve_exponent = 1.6\nvalve_range = \"2 V\"\nvalve_time_constant "
         "= \"3 ms\"\ncoulomb_friction = \"20 N\"\nstribeck_friction = \"10 N\"\nseal_friction = "
         "\"5 mm2\""});
    folder.write("campaign.toml", edited(kTwoChamber, edits));
    require_both(folder, "command", {{"sine", sine(1.0)}, {"square", square(1.0)}});
  }
  SECTION("pre-sliding on a lubricant film") {
    Edits edits = kTwoChamberGeneratedRuns;
    edits.push_back(
        {"stroke = \"200 mm\"",
         "stroke = \"200 mm\"\nvalve_time_constant = \"3 ms\"\ncoulomb_friction = \"20 "
         "N\"\nstribeck_friction = \"10 N\"\nseal_friction = \"5 mm2\"\nbristle_stiffness = "
         "\"2e5 N/m\"\nbristle_damping = \"50 N s/m\"\nfilm_velocity = \"50 "
         "mm/s\"\nfilm_growth_time = \"50 ms\"\nfilm_decay_time = \"0.2 s\"\nfilm_dwell_time = "
         "\"5 s\""});
    folder.write("campaign.toml", edited(kTwoChamber, edits));
    require_both(folder, "command", {{"sine", sine(1.0)}, {"square", square(1.0)}});
  }
  SECTION("edges by a table, with warm oil") {
    Edits edits = kTwoChamberGeneratedRuns;
    edits.push_back({"leakage_coefficient = 0",
                     "leakage_coefficient = 0.05\nleakage_resistance = \"5e11 Pa s/m3\""});
    edits.push_back(
        {"stroke = \"200 mm\"",
         "stroke = \"200 mm\"\nvalve_range = \"1.2 V\"\nopening_20 = 0.06\nopening_40 = "
         "0.2\nopening_60 = 0.45\nopening_80 = 0.7\nvalve_time_constant = \"3 "
         "ms\"\nexternal_leakage_a = \"1e-13 m3/(s Pa)\"\n" +
             kWarmOil});
    folder.write("campaign.toml", edited(kTwoChamber, edits));
    require_both(folder, "command", {{"sine", sine(1.0)}, {"square", square(1.0)}});
  }
}

TEST_CASE("export: a rig starts where its record does, without the sensor's offset", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"mass = \"60 kg\"", "mass = \"60 kg\"\nposition_offset = \"2 mm\""},
                              {"[recording.channels]",
                               "[recording]\ninitial = \"record\"\n[recording.channels]"}})
              .exit_code == 0);
  folder.write(
      "campaign.toml",
      edited(folder.read("twin/campaign.toml"),
             {{"[recording.channels]", "[simulation]\ntolerance = 1e-9\n[recording.channels]"}}));
  std::filesystem::rename(folder.work() / "twin" / "records", folder.work() / "records");
  const SimulatedColumns columns = simulated(folder, "square");
  const Fmu fmu = exported(folder, {"--condition", "square"});
  const FmuLibrary library(fmu.library());
  FmuRun run(fmu, library, fmi2CoSimulation);
  run.initialize(0.0, kTolerance, {{"reference", 0.004}});
  const auto& times = columns.at("time_s");
  const auto& readings = columns.at("position_m");
  CHECK(std::abs(readings.front()) > 1e-4);
  for (std::size_t i = 0; i < 50; ++i) {
    REQUIRE(run.get("position") + 0.002 == Approx(readings[i]).margin(1e-6 * 0.004).epsilon(0));
    run.require(run.step(times[i], times[i + 1] - times[i]));
  }
  CHECK_THAT(text_of(fmu.folder() / "modelDescription.xml"), !Contains("position_offset"));
  CHECK(std::stod(fmu.variables.at("initial_position").start) + 0.002 == Approx(readings.front()));
}

TEST_CASE("export: a sampled controller ticks as in simulate", "[apps]") {
  const CommandFolder folder;
  Edits edits = kGeneratedRuns;
  edits.push_back({"kp = \"1000 V/m\"",
                   "kp = \"400 V/m\"\nki = \"500 V/(m s)\"\nkd = \"1 V s/m\"\n"
                   "derivative_filter = \"300 rad/s\"\noutput_limit = \"1.5 V\"\nsample_time = "
                   "\"5 ms\""});
  folder.write("campaign.toml", edited(kCampaign, edits));
  require_both(folder, "reference", {{"sine", sine(0.005)}, {"square", square(0.004)}});
}

TEST_CASE("export: steps of any length lead to the same end", "[apps]") {
  const CommandFolder folder;
  Edits edits = kGeneratedRuns;
  edits.push_back({"kp = \"1000 V/m\"", "kp = \"400 V/m\"\nsample_time = \"7 ms\""});
  folder.write("campaign.toml", edited(kCampaign, edits));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  const auto end_of = [&](const std::vector<double>& lengths) {
    FmuRun run(fmu, library, fmi2CoSimulation);
    run.initialize(10.0, kTolerance, {{"reference", 0.004}});
    double t = 10.0;
    for (std::size_t i = 0; t < 10.3 - 1e-9; ++i) {
      const double h = std::min(lengths[i % lengths.size()], 10.3 - t);
      run.require(run.step(t, h));
      t += h;
    }
    return run.get("position");
  };
  const double whole = end_of({0.3});
  CHECK(whole == Approx(0.004).epsilon(0.2));
  CHECK(end_of({0.001}) == Approx(whole).epsilon(1e-6));
  CHECK(end_of({0.02, 0.003, 0.0005}) == Approx(whole).epsilon(1e-6));
}

TEST_CASE("export: parameters and inputs of an FMU act as those of a campaign", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  const auto position = [&](const Fmu& from, const std::map<std::string, double>& values) {
    FmuRun run(from, library, fmi2CoSimulation);
    run.initialize(0.0, kTolerance, {{"reference", 0.004}});
    for (const auto& [name, value] : values) run.require(run.set(name, value));
    run.require(run.step(0.0, 0.1));
    return run.get("position");
  };
  const double as_is = position(fmu, {});
  struct Change {
    std::string name;
    double value;
    std::string set;
  };
  for (const Change& change : {Change{"mass", 600.0, "mass=600 kg"},
                               Change{"leakage_coefficient", 3.0, "leakage_coefficient=3"},
                               Change{"supply_pressure", 3e6, "supply_pressure=3 MPa"},
                               Change{"external_force", 1500.0, "external_force=1500 N"}}) {
    CAPTURE(change.name);
    const double changed = position(fmu, {{change.name, change.value}});
    CHECK(std::abs(changed - as_is) > 1e-5 * std::abs(as_is));
    const Outcome outcome = folder.run(
        {"export", "fmu", "campaign.toml", "--set", change.set, "--out", "set/" + change.name});
    REQUIRE(outcome.exit_code == 0);
    unzip(folder.work() / "set" / change.name / "small_rig.fmu", folder.work() / change.name);
    CHECK(position(Fmu(folder.work() / change.name), {}) == Approx(changed).epsilon(1e-12));
  }
}

TEST_CASE("export: instances are apart, and go back to what they were", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  FmuRun one(fmu, library, fmi2CoSimulation);
  FmuRun other(fmu, library, fmi2CoSimulation);
  one.initialize(0.0, kTolerance, {{"reference", 0.004}});
  other.initialize(0.0, kTolerance, {{"reference", -0.004}});
  one.require(one.step(0.0, 0.01));
  other.require(other.step(0.0, 0.01));
  CHECK(one.get("position") == -other.get("position"));
  fmi2FMUstate state = nullptr;
  one.require(RIGCAL_FMI2(library, fmi2GetFMUstate)(one.component, &state));
  one.require(one.step(0.01, 0.02));
  const double later = one.get("position");
  one.require(RIGCAL_FMI2(library, fmi2SetFMUstate)(one.component, state));
  CHECK(one.get("position") == -other.get("position"));
  one.require(one.step(0.01, 0.02));
  CHECK(one.get("position") == later);
  one.require(RIGCAL_FMI2(library, fmi2FreeFMUstate)(one.component, &state));
  CHECK(state == nullptr);
  one.require(RIGCAL_FMI2(library, fmi2Reset)(one.component));
  one.initialize(0.0, kTolerance, {{"reference", 0.004}});
  one.require(one.step(0.0, 0.01));
  CHECK(one.get("position") == -other.get("position"));
}

TEST_CASE("export: without a tolerance of the importer, an FMU has the campaign's", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  const auto position_with = [&](fmi2Boolean defined, double tolerance) {
    FmuRun run(fmu, library, fmi2CoSimulation);
    run.require(
        RIGCAL_FMI2(library, fmi2SetupExperiment)(run.component, defined, tolerance, 0.0, 0, 0.0));
    run.require(RIGCAL_FMI2(library, fmi2EnterInitializationMode)(run.component));
    run.require(RIGCAL_FMI2(library, fmi2ExitInitializationMode)(run.component));
    run.require(run.set("reference", 0.004));
    run.require(run.step(0.0, 0.1));
    return run.get("position");
  };
  // An importer that defines none passes zero, which would be refused as a tolerance.
  CHECK(position_with(fmi2False, 0.0) == position_with(fmi2True, kTolerance));
  CHECK(position_with(fmi2False, 0.0) != position_with(fmi2True, 1e-3));
}

TEST_CASE("export: an FMU says in words what it refuses", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  const double nan = std::nan("");
  FmuRun stranger(fmu, library, fmi2CoSimulation, "{another}");
  CHECK(stranger.component == nullptr);
  CHECK_THAT(stranger.messages(), Contains("the GUID is {another}, expected " + fmu.guid()));
  FmuRun run(fmu, library, fmi2CoSimulation);
  CHECK(run.step(0.0, 0.01) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("fmi2DoStep: the instance is instantiated, expected "));
  CHECK(run.set("mass", 1e9) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("mass: found 1e+09, expected 0.001 to 1000000 kg"));
  run.initialize(0.0, 1e-6);
  CHECK(run.set("reference", nan) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("found nan, expected a finite number"));
  CHECK(run.set("position", 1.0) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("no input or parameter has it"));
  CHECK(run.step(0.5, 0.01) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("currentCommunicationPoint: found 0.5 s, expected 0 s"));
  CHECK(run.step(0.0, 0.0) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("communicationStepSize: found 0, expected one above 0"));
  const fmi2ValueReference unknown = 99;
  double value = 0.0;
  CHECK(RIGCAL_FMI2(library, fmi2GetReal)(run.component, &unknown, 1, &value) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("no variable has the value reference 99"));
  const fmi2ValueReference largest = 0x80000000U;  // beyond the largest int
  CHECK(RIGCAL_FMI2(library, fmi2SetReal)(run.component, &largest, 1, &value) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("2147483648: no input or parameter has it"));
  CHECK(run.step(0.0, 0.01) == fmi2OK);
  const auto real_status = RIGCAL_FMI2(library, fmi2GetRealStatus);
  CHECK(real_status(run.component, fmi2LastSuccessfulTime, &value) == fmi2OK);
  CHECK(value == 0.01);
  CHECK(real_status(run.component, fmi2Terminated, &value) == fmi2Error);
  CHECK_THAT(run.messages(), Contains("fmi2GetRealStatus: expected fmi2LastSuccessfulTime"));

  FmuRun exchange(fmu, library, fmi2ModelExchange);
  exchange.initialize(0.0, 1e-6);
  CHECK(exchange.step(0.0, 0.01) == fmi2Error);
  const std::vector<double> states(7, nan);
  const auto set_states = RIGCAL_FMI2(library, fmi2SetContinuousStates);
  CHECK(set_states(exchange.component, states.data(), 7) == fmi2Error);
  CHECK_THAT(exchange.messages(), Contains("found room for 7 numbers, expected 3"));
  CHECK(set_states(exchange.component, states.data(), 3) == fmi2Error);
  CHECK_THAT(exchange.messages(), Contains("state 0: found nan"));

  std::ofstream(fmu.folder() / "resources" / "rig.txt", std::ios::app) << "parameter mass much\n";
  FmuRun damaged(fmu, library, fmi2CoSimulation);
  CHECK(damaged.component == nullptr);
  CHECK_THAT(damaged.messages(), Contains("found much, expected a number"));
}

TEST_CASE("export: the sources compile with a compiler alone, to the same model", "[apps][long]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Fmu fmu = exported(folder);
  std::string files;
  for (const auto& [tag, node] : fmu.description().get_child("CoSimulation.SourceFiles"))
    files += " " + node.get<std::string>("<xmlattr>.name");
  const auto library_file = folder.work() / "compiled.so";
  const std::string command = "cd '" + (fmu.folder() / "sources").string() +
                              "' && c++ -std=c++20 -Wall -Wextra -Werror -Wno-maybe-uninitialized "
                              "-fPIC -shared -I. -o '" +
                              library_file.string() + "'" + files;
  REQUIRE(std::system(command.c_str()) == 0);
  const FmuLibrary library(library_file);
  const SimulatedColumns columns = simulated(folder, "square");
  require_co_simulation(fmu, library, "reference", square(0.004), true, columns);
  require_model_exchange(fmu, library, "reference", square(0.004), true, columns);
}

TEST_CASE("export: the model description keeps the rules of the standard", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Fmu fmu = exported(folder, {"--condition", "sine"});
  const auto& root = fmu.description();
  CHECK(root.get<std::string>("<xmlattr>.fmiVersion") == "2.0");
  CHECK(root.get<std::string>("ModelExchange.<xmlattr>.modelIdentifier") == fmu.identifier());
  CHECK(root.get<double>("DefaultExperiment.<xmlattr>.stopTime") == 0.6);
  CHECK(root.get<double>("DefaultExperiment.<xmlattr>.stepSize") == Approx(0.005));

  std::set<std::string> units;
  for (const auto& [tag, unit] : root.get_child("UnitDefinitions"))
    CHECK(units.insert(unit.get<std::string>("<xmlattr>.name")).second);
  std::set<unsigned> references;
  std::map<std::size_t, Variable> by_index;
  for (const auto& [name, variable] : fmu.variables) {
    CAPTURE(name);
    CHECK(units.count(variable.unit) == 1);
    CHECK(references.insert(variable.reference).second);
    by_index[variable.index] = variable;
    const bool has_start = variable.causality == "input" || variable.causality == "parameter";
    CHECK(variable.start.empty() != has_start);
    const bool constant = variable.causality == "parameter";
    CHECK((variable.variability == "continuous") != constant);
  }
  const auto listed = [&](const char* list) {
    std::vector<std::size_t> indices;
    for (const auto& [tag, unknown] : root.get_child(std::string("ModelStructure.") + list))
      indices.push_back(unknown.get<std::size_t>("<xmlattr>.index"));
    CHECK(std::is_sorted(indices.begin(), indices.end()));
    return std::set<std::size_t>(indices.begin(), indices.end());
  };
  const auto outputs = listed("Outputs");
  const auto derivatives = listed("Derivatives");
  std::set<std::size_t> initial = outputs;
  for (const auto& [index, variable] : by_index) {
    CHECK(outputs.count(index) == (variable.causality == "output" ? 1 : 0));
    CHECK(derivatives.count(index) == (variable.derivative > 0 ? 1 : 0));
    if (variable.derivative == 0) continue;
    CHECK(by_index.count(variable.derivative) == 1);
    initial.insert(index);
    initial.insert(variable.derivative);
  }
  CHECK(listed("InitialUnknowns") == initial);
  CHECK(derivatives.size() == 3);
  CHECK_THAT(text_of(fmu.folder() / "resources" / "rig.txt"), Contains("guid " + fmu.guid()));
  // The linked C++ library must not replace that of the importer.
  const FmuLibrary library(fmu.library());
  if (!kSanitized) CHECK_THROWS(library.function<void()>("_ZNSt6locale7classicEv"));
}

TEST_CASE("export: the same campaign gives the same bytes, another one another GUID", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  for (const char* out : {"one", "two"})
    REQUIRE(folder.run({"export", "fmu", "campaign.toml", "--out", out}).exit_code == 0);
  CHECK(folder.read("one/small_rig.fmu") == folder.read("two/small_rig.fmu"));
  const std::string guid = exported(folder).guid();
  CHECK(exported(folder, {"--set", "mass=61 kg"}).guid() != guid);
}

TEST_CASE("export: a fit gives the values of its leak level", "[apps]") {
  const CommandFolder folder;
  const Edits by_level{
      {"leakage_coefficient = 0.3",
       "leakage_coefficient = { start = 0.3, lower = 0.01, upper = 3, fit = true, scope = "
       "\"leak_level\" }"},
      {"[leak_level.\"none\"]", "[leak_level.\"none\"]\n[leak_level.\"big\"]"}};
  REQUIRE(write_twin(folder, by_level).exit_code == 0);
  const Outcome fitted = folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--quiet"});
  CAPTURE(fitted.err);
  REQUIRE(fitted.exit_code <= 1);
  const CommandFolder::Arguments common{
      "export", "fmu", "twin/campaign.toml", "--fit", "fit/fit.json", "--out", "fmu"};
  const auto run = [&](const CommandFolder::Arguments& more) {
    CommandFolder::Arguments arguments = common;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return folder.run(arguments);
  };
  const Outcome of_level = run({"--level", "none"});
  CAPTURE(of_level.err);
  REQUIRE(of_level.exit_code == 0);
  CHECK_THAT(of_level.out, Contains("leak level: none") && !Contains("warning"));
  unzip(folder.work() / "fmu" / "small_rig_synthetic_none.fmu", folder.work() / "unpacked");
  const Fmu fmu(folder.work() / "unpacked");
  CHECK(std::stod(fmu.variables.at("damping").start) == Approx(1000.0).epsilon(0.05));
  CHECK(std::stod(fmu.variables.at("valve_gain").start) == Approx(3e-5).epsilon(0.05));
  CHECK_THAT(folder.read("unpacked/documentation/index.html"),
             Contains("verdict of the fit") && Contains("fit.json, SHA-256 ") &&
                 Contains("fitted at frequencies of"));

  const Outcome set = run({"--level", "none", "--set", "damping=700 N s/m", "--json"});
  REQUIRE(set.exit_code == 0);
  unzip(folder.work() / "fmu" / "small_rig_synthetic_none.fmu", folder.work() / "set");
  CHECK(Fmu(folder.work() / "set").variables.at("damping").start == "700");

  CHECK_THAT(run({}).err, Contains("2 leak levels: expected --level with one of big, none"));
  const Outcome without = run({"--level", "big"});
  CHECK(without.exit_code == 2);
  CHECK_THAT(without.err, Contains("fit.json has no leakage_coefficient for it, only for none"));
  const Outcome unknown = run({"--level", "nine"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.err, Contains("--level: unknown leak level 'nine'"));
  CHECK(run({"--level", "none", "--condition", "sine"}).exit_code == 2);
}

TEST_CASE("export: what speaks against a fit goes with it", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"rho2 = 0.9", "rho2 = 0.999999999"}}).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 1);
  const CommandFolder::Arguments arguments{"export",     "fmu",          "twin/campaign.toml",
                                           "--fit",      "fit/fit.json", "--set",
                                           "mass=61 kg", "--out",        "fmu"};
  const Outcome outcome = folder.run(arguments);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("verdict of the fit: FAIL") &&
                              Contains("warning: the verdict of the fit is FAIL") &&
                              Contains("warning: mass is 61 kg here, but was 60 kg in the fit"));
  unzip(folder.work() / "fmu" / "small_rig_synthetic.fmu", folder.work() / "unpacked");
  CHECK_THAT(folder.read("unpacked/documentation/index.html"),
             Contains("the verdict of the fit is FAIL") && Contains("mass=61 kg"));
}

TEST_CASE("export: bad input", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kGeneratedRuns));
  const Outcome format = folder.run({"export", "fmx", "campaign.toml"});
  CHECK(format.exit_code == 2);
  CHECK_THAT(format.err, Contains("unknown format 'fmx'") && Contains("known: fmu"));
  const Outcome condition = folder.run({"export", "fmu", "campaign.toml", "--condition", "sin"});
  CHECK(condition.exit_code == 2);
  CHECK_THAT(condition.err, Contains("unknown condition 'sin'; did you mean 'sine'?"));
  const Outcome delay = folder.run(
      {"export", "fmu", "campaign.toml", "--set", "transport_delay=4 ms", "--out", "out"});
  CHECK(delay.exit_code == 2);
  CHECK_THAT(delay.err,
             Contains("transport_delay is 0.004 s, but the inputs of an FMU act without delay"));
  const Outcome without = folder.run({"export", "fmu", "campaign.toml", "--set",
                                      "transport_delay=4 ms", "--without-delay", "--out", "late"});
  CHECK(without.exit_code == 0);
  CHECK_THAT(without.out, Contains("transport_delay is left out: delay the reference by 0.004 s"));
  folder.write("shaken.toml",
               edited(kCampaign, {{"[recording.channels]",
                                   "[recording.channels]\nbase_acceleration = { column = "
                                   "\"a_base\", unit = \"m/s2\" }"}}));
  const Outcome base = folder.run({"export", "fmu", "shaken.toml", "--out", "out"});
  CHECK(base.exit_code == 2);
  CHECK_THAT(base.err, Contains("base_acceleration': an FMU has no such input") &&
                           Contains("external_force"));
  folder.write(
      "warm.toml",
      edited(kCampaign,
             {{"[recording.channels]",
               "[recording.channels]\ntemperature = { column = \"T\", unit = \"K\", role = "
               "\"input\" }"},
              {"[rig.parameters]\n", "[rig.parameters]\nreference_temperature = \"40 degC\"\n"}}));
  const Outcome warm = folder.run({"export", "fmu", "warm.toml", "--out", "out"});
  CHECK(warm.exit_code == 2);
  CHECK_THAT(warm.err,
             Contains("temperature': an FMU has no such input") && Contains("oil_temperature"));
  folder.write("file", "");
  const Outcome out = folder.run({"export", "fmu", "campaign.toml", "--out", "file/out"});
  CHECK(out.exit_code == 5);
  CHECK(!folder.has("out"));
  const Outcome start = folder.run({"export", "fmu", "campaign.toml", "--out", "out"});
  CHECK_THAT(start.out, Contains("warning: not calibrated: damping, valve_gain"));
  // No fit gives the value of a nuisance parameter that an FMU for all records could have.
  folder.write(
      "nuisance.toml",
      edited(folder.read("campaign.toml"),
             {{"upper = \"1e5 N s/m\", fit = true",
               "upper = \"1e5 N s/m\", fit = true, scope = \"condition\", nuisance = true"}}));
  const Outcome nuisance = folder.run({"export", "fmu", "nuisance.toml", "--out", "out"});
  CAPTURE(nuisance.err);
  CHECK(nuisance.exit_code == 0);
  CHECK_THAT(nuisance.out, Contains("not calibrated: valve_gain") && !Contains("damping, ") &&
                               Contains("damping differ from record to record"));
}

}  // namespace rigcal::test
