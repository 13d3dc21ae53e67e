// Fits a rotary actuator under a loop on its angle or its torque, from its recorded angle and
// torque.

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "calib/fit.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "model/simulate.hpp"
#include "tests/datasets/campaign_fixture.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;

const char* const kVane = R"toml(schema = "rigcal.campaign/1"
[rig]
model = "linkage"
[rig.parameters]
inertia = { start = "30 kg m2", lower = "5 kg m2", upper = "100 kg m2", fit = true }
joint_damping = { start = "300 N m s/rad", lower = "50 N m s/rad", upper = "2000 N m s/rad", fit = true }
displacement_per_radian = "200 cm3/rad"
lower_stop = "-140 deg"
upper_stop = "140 deg"
dead_volume_a = "0.2 L"
dead_volume_b = "0.2 L"
tank_pressure = "2 bar"
supply_pressure = "140 bar"
density = "870 kg/m3"
bulk_modulus = "800 MPa"
discharge_coefficient = 0.65
area_gradient = "20 mm"
valve_gain = { start = "0.015 mm/V", lower = "0.005 mm/V", upper = "0.1 mm/V", fit = true }
valve_time_constant = "5 ms"
leakage_coefficient = 0
leakage_area = "1 mm2"
torque_offset = { start = "0 N m", lower = "-50 N m", upper = "50 N m", fit = true }
[rig.controller]
type = "pid"
angle_kp = "10 V/rad"
angle_ki = "5 V/(rad s)"
output_limit = "10 V"
[recording]
initial = "rest"
[recording.channels]
time = { column = "t_s", unit = "s" }
angle = { column = "angle_deg", unit = "deg", sd = "0.5 mrad" }
torque = { column = "M_Nm", unit = "Nm", sd = "2 Nm" }
[[condition]]
id = "square"
waveform = "square"
frequency = "0.5 Hz"
amplitude = "20 deg"
use = "fit"
repeats = ["square.csv"]
)toml";

using Truth = std::vector<std::pair<const char*, double>>;

datasets::Record vane_record(const datasets::Campaign& campaign, const Truth& truth) {
  const datasets::Condition& condition = campaign.conditions.front();
  auto values = datasets::values_in(campaign, condition);
  for (const auto& [key, value] : truth) values.set(key, value);
  datasets::Record record;
  record.condition = condition.id;
  for (int i = 0; i < 600; ++i) record.time_s.push_back(0.005 * i);
  const auto run = model::simulate(
      campaign.rig, values, {}, datasets::inputs_of(campaign, condition, values, nullptr),
      record.time_s, std::vector{model::Output::angle, model::Output::torque},
      model::SimulationOptions());
  INFO(run.reason);
  REQUIRE(run.ok());
  boost::random::mt19937_64 random(3);
  boost::random::normal_distribution<double> normal;
  const std::array sds{std::pair{datasets::Channel::angle, 5e-4},
                       std::pair{datasets::Channel::torque, 2.0}};
  for (std::size_t k = 0; k < sds.size(); ++k) {
    datasets::Series& series = record.channels[sds[k].first];
    for (Eigen::Index i = 0; i < run.outputs.rows(); ++i)
      series.mean.push_back(run.outputs(i, static_cast<Eigen::Index>(k)) +
                            sds[k].second * normal(random));
    series.sd_of_mean = sds[k].second;
  }
  return record;
}

/// Fits the records of a rig, and checks that its values come back.
void check_truth(const std::string& text, const Truth& truth) {
  const datasets::Campaign campaign = rigcal::test::load_text(text);
  const Fit found = fit(campaign, {vane_record(campaign, truth)}, {});
  for (const auto& [key, value] : truth) {
    const int index = model::parameter_index(model::PlantKind::linkage, key);
    CAPTURE(key);
    bool fitted = false;
    for (const FittedParameter& each : found.parameters) {
      if (each.index != index || !each.fitted) continue;
      fitted = true;
      const double error = each.standard_error.value();
      CAPTURE(each.value, error);
      CHECK_THAT(each.value, WithinAbs(value, 4.0 * error));
      CHECK(error < 0.1 * value);
    }
    CHECK(fitted);
  }
}

}  // namespace

TEST_CASE("fit: a vane motor under a loop on its angle, from angle and torque", "[calib]") {
  check_truth(
      kVane,
      {{"inertia", 20.0}, {"joint_damping", 500.0}, {"valve_gain", 2e-5}, {"torque_offset", 10.0}});
}

TEST_CASE("fit: a vane motor under a loop on its torque, from angle and torque", "[calib]") {
  using rigcal::test::replaced;
  std::string text = replaced(kVane,
                              "torque_offset = { start = \"0 N m\", lower = \"-50 N m\", "
                              "upper = \"50 N m\", fit = true }",
                              "gravity_moment_gradient = { start = \"3 kN m/rad\", lower = "
                              "\"1 kN m/rad\", upper = \"20 kN m/rad\", fit = true }");
  text = replaced(text, "angle_kp = \"10 V/rad\"\nangle_ki = \"5 V/(rad s)\"",
                  "feedback = \"torque\"\ntorque_kp = \"2 V/(kN m)\"\ntorque_ki = { start = "
                  "\"2 V/(kN m s)\", lower = \"0.5 V/(kN m s)\", upper = \"50 V/(kN m s)\", fit = "
                  "true }");
  check_truth(replaced(text, "amplitude = \"20 deg\"", "amplitude = \"600 Nm\""),
              {{"inertia", 20.0},
               {"joint_damping", 500.0},
               {"valve_gain", 2e-5},
               {"gravity_moment_gradient", 5e3},
               {"torque_ki", 5e-3}});
}

}  // namespace rigcal::calib
