#include "datasets/checks/swapped_chambers.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>

using namespace rigcal::datasets;
using Catch::Contains;

namespace {

/// A cylinder whose chambers carry half of the force each.
struct Cylinder {
  double mass_kg = 100.0;
  double friction_n = 150.0;
  double damping_n_s_per_m = 300.0;
  double load_n = 0.0;
  double stiffness_n_per_m = 0.0;
  double area_a_m2 = 2e-3;
  double area_b_m2 = 1e-3;
  double noise_pa = 2e3;
};

Record moving_record(const Cylinder& rig) {
  constexpr double kRate_hz = 1000.0;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  Record record;
  std::vector<double> x, a, b;
  for (int i = 0; i < 4000; ++i) {
    const double t = i / kRate_hz;
    double position = 0.0, speed = 0.0, acceleration = 0.0;
    for (const auto& [amplitude, hz] : {std::pair{0.02, 0.6}, {0.004, 3.1}, {0.001, 7.3}}) {
      const double w = 2.0 * std::acos(-1.0) * hz;
      position += amplitude * std::sin(w * t);
      speed += amplitude * w * std::cos(w * t);
      acceleration -= amplitude * w * w * std::sin(w * t);
    }
    const double force_n = rig.mass_kg * acceleration + rig.friction_n * std::tanh(speed / 1e-3) +
                           rig.damping_n_s_per_m * speed + rig.load_n +
                           rig.stiffness_n_per_m * position;
    record.time_s.push_back(t);
    x.push_back(position);
    a.push_back(5e6 + 0.5 * force_n / rig.area_a_m2 + rig.noise_pa * normal(random));
    b.push_back(6e6 - 0.5 * force_n / rig.area_b_m2 + rig.noise_pa * normal(random));
  }
  record.channels[Channel::position].mean = x;
  record.channels[Channel::pressure_a].mean = a;
  record.channels[Channel::pressure_b].mean = b;
  return record;
}

Record swapped(Record record) {
  std::swap(record.channels[Channel::pressure_a].mean, record.channels[Channel::pressure_b].mean);
  return record;
}

}  // namespace

TEST_CASE("swapped_chambers_warning: whatever the load, the friction and the areas", "[datasets]") {
  const Campaign campaign;
  Cylinder hanging;
  hanging.load_n = 8000.0;
  Cylinder spring;
  spring.stiffness_n_per_m = 4e4;
  Cylinder over_centre;
  over_centre.stiffness_n_per_m = -4e4;
  Cylinder smooth;
  smooth.friction_n = 0.0;
  Cylinder even;
  even.area_a_m2 = even.area_b_m2;
  for (const Cylinder& rig : {Cylinder{}, hanging, spring, over_centre, smooth, even}) {
    CAPTURE(rig.load_n, rig.stiffness_n_per_m, rig.friction_n, rig.area_a_m2);
    const Record record = moving_record(rig);
    CHECK(swapped_chambers_warning(campaign, record).empty());
    CHECK_THAT(swapped_chambers_warning(campaign, swapped(record)), Contains("swapped"));
  }
}

TEST_CASE("swapped_chambers_warning: silent where the record does not show it", "[datasets]") {
  const Campaign campaign;
  Cylinder light;
  light.mass_kg = 0.5;
  CHECK(swapped_chambers_warning(campaign, swapped(moving_record(light))).empty());
  Record still = swapped(moving_record({}));
  for (double& x : still.channels[Channel::position].mean) x = 0.01;
  CHECK(swapped_chambers_warning(campaign, still).empty());
  Record one = swapped(moving_record({}));
  one.channels.erase(Channel::pressure_b);
  CHECK(swapped_chambers_warning(campaign, one).empty());
  // In a sine alone a mass and a spring that pushes away look alike.
  Record sine = moving_record({});
  for (std::size_t i = 0; i < sine.time_s.size(); ++i) {
    const double s = std::sin(12.0 * sine.time_s[i]);
    sine.channels[Channel::position].mean[i] = 0.01 * s;
    sine.channels[Channel::pressure_a].mean[i] = 5e6 + 1e6 * s;
    sine.channels[Channel::pressure_b].mean[i] = 5e6 - 1e6 * s;
  }
  CHECK(swapped_chambers_warning(campaign, sine).empty());
  CHECK(swapped_chambers_warning(campaign, swapped(sine)).empty());
}
