#include "calib/consider/consider.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "calib/consider/catalogue.hpp"
#include "calib/consider/effect_changes.hpp"
#include "calib/fit.hpp"
#include "tests/calib/twin.hpp"
#include "tests/datasets/campaign_fixture.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;

/// A short campaign with mass, bulk modulus and valve gain free.
struct SmallRig : Twin {
  SmallRig() {
    free("mass", 90.0, 20.0, 400.0);
    free("bulk_modulus", 700e6, 1e8, 3e9);
    free("valve_gain", 4e-5, 1e-5, 2e-4);
    add("square", datasets::Waveform::square, 2.0, 0.01);
    add("sine", datasets::Waveform::sine, 3.0, 0.02);
  }

  Fit fitted(unsigned seed = 1) const { return fit(campaign, records(1000, 1000.0, seed), {}); }
};

const ConsideredEffect* effect(const Fit& fit, const std::string& key) {
  for (const ConsideredEffect& each : fit.considered.value().effects)
    if (each.key == key) return &each;
  return nullptr;
}

/// Returns the rows of the effects at a fraction of their sizes, at the true values.
Eigen::MatrixXd rows_at(const SmallRig& rig, const std::vector<datasets::Record>& records,
                        double fraction, std::vector<std::string>& keys) {
  std::vector<const datasets::Condition*> conditions;
  for (const auto& each : rig.campaign.conditions) conditions.push_back(&each);
  const Problem problem = make_problem(rig.campaign, records, conditions, false, nullptr);
  auto effects = effects_of(problem, problem.start());
  keys.clear();
  for (Effect& each : effects) {
    keys.push_back(each.about.key);
    each.secant = fraction;
  }
  return effect_rows(problem, 0, problem.start(), effects, nullptr);
}

TEST_CASE("considered: secants at the plausible size are near those of a smaller step", "[calib]") {
  const SmallRig rig;
  const auto records = rig.records(1000, 1000.0, 1);
  std::vector<std::string> keys;
  const Eigen::MatrixXd whole = rows_at(rig, records, 1.0, keys);
  const Eigen::MatrixXd part = rows_at(rig, records, 0.25, keys);
  REQUIRE(whole.cols() > 10);
  for (Eigen::Index k = 0; k < whole.cols(); ++k) {
    CAPTURE(keys[static_cast<std::size_t>(k)]);
    REQUIRE(whole.col(k).allFinite());
    REQUIRE(whole.col(k).norm() > 0.0);
    // Play is not linear: the larger it is, the larger the fraction of the motion that it hides.
    const double allowed = keys[static_cast<std::size_t>(k)] == "position_hysteresis" ? 0.5 : 0.3;
    CHECK((whole.col(k) - part.col(k)).norm() < allowed * whole.col(k).norm());
  }
}

TEST_CASE("considered: the interval of the rig includes that of an exact model", "[calib]") {
  const SmallRig rig;
  const Fit found = rig.fitted();
  REQUIRE(found.considered);
  CHECK(found.considered->missing.empty());
  int wider = 0;
  for (const FittedParameter& each : found.parameters) {
    if (!each.fitted) continue;
    CAPTURE(each.value);
    CHECK(each.ci95->low <= each.ci95_if_exact->low);
    CHECK(each.ci95->high >= each.ci95_if_exact->high);
    wider += each.ci95->high - each.ci95->low >
                     1.1 * (each.ci95_if_exact->high - each.ci95_if_exact->low)
                 ? 1
                 : 0;
  }
  CHECK(wider > 0);
}

TEST_CASE("considered: the budget adds up by hand", "[calib]") {
  const SmallRig rig;
  for (const FittedParameter& each : rig.fitted().parameters) {
    if (!each.fitted) continue;
    const Budget95& budget = each.budget.value();
    double sum = 0.0;
    for (const BudgetLine& line : budget.lines) sum += line.uncertainty * line.uncertainty;
    CHECK_THAT(std::sqrt(sum), WithinRel(budget.combined, 1e-9));
    CHECK_THAT(budget.expanded, WithinRel(budget.coverage_factor * budget.combined, 1e-12));
    CHECK(budget.coverage_factor > 1.95);
    // Beside it are the days, and the errors of the simulations, which hardly count.
    CHECK(budget.beside_of("days") == each.between_days_error);
    const double numerics = budget.beside_of("numerics").value();
    CHECK(numerics > 0.0);
    CHECK(numerics < 0.1 * each.standard_error.value());
    CHECK(each.ci95->high >= each.value + budget.shift + budget.expanded - 1e-9 * each.value);
  }
}

TEST_CASE("considered: a valve lag that the model lacks is named with its size", "[calib]") {
  SmallRig rig;
  rig.truth.parameters.push_back(known(Twin::index("valve_time_constant"), 0.5e-3));
  const Fit found = rig.fitted();
  REQUIRE_FALSE(found.considered->missing.empty());
  const ConsideredEffect& first = *found.considered->find(found.considered->missing.front());
  CHECK((first.key == "valve_time_constant" || first.key == "transport_delay"));
  const ConsideredEffect* lag = effect(found, "valve_time_constant");
  REQUIRE(lag != nullptr);
  CHECK(lag->p_of_all.value() < 1e-3);
  CHECK_THAT(lag->alone.value(), WithinRel(0.5e-3, 0.3));
  const std::vector<std::pair<const char*, double>> truth{{"mass", 85.0}, {"valve_gain", 4.06e-5}};
  for (const auto& [key, value] : truth) {
    for (const FittedParameter& each : found.parameters) {
      if (each.index != Twin::index(key)) continue;
      CAPTURE(key, each.ci95->low, each.ci95->high);
      CHECK(each.ci95->low <= value);
      CHECK(value <= each.ci95->high);
    }
  }
}

TEST_CASE("considered: sizes and what is left out are the campaign's", "[calib]") {
  SmallRig rig;
  rig.campaign.considered.sizes["coulomb_friction"] = 7.0;
  rig.campaign.considered.left_out = {"valve_dead_band"};
  const Fit found = rig.fitted();
  CHECK(effect(found, "coulomb_friction")->size == 7.0);
  CHECK(effect(found, "valve_dead_band") == nullptr);
  CHECK(found.considered->left_out == std::vector<std::string>{"valve_dead_band"});
  rig.campaign.considered.none = true;
  const Fit exact = rig.fitted();
  CHECK(exact.considered->effects.empty());
  for (const FittedParameter& each : exact.parameters)
    if (each.fitted)
      CHECK_THAT(each.ci95->high - each.ci95->low,
                 WithinRel(each.ci95_if_exact->high - each.ci95_if_exact->low, 0.02));
}

TEST_CASE("considered: what is free or given is no effect beside it", "[calib]") {
  SmallRig rig;
  rig.free("valve_time_constant", 0.5e-3, 1e-6, 0.01);
  rig.truth.parameters.push_back(known(Twin::index("valve_time_constant"), 0.5e-3));
  rig.campaign.parameters.push_back(known(Twin::index("coulomb_friction"), 5.0));
  rig.truth.parameters.push_back(known(Twin::index("coulomb_friction"), 5.0));
  const Fit found = rig.fitted();
  CHECK(effect(found, "valve_time_constant") == nullptr);
  CHECK(effect(found, "coulomb_friction") == nullptr);
  CHECK(effect(found, "transport_delay") != nullptr);
}

const char* const kConsideredArm = R"(schema = "rigcal.campaign/1"
[rig]
model = "linkage"
[rig.parameters]
inertia = { start = "420 kg m2", lower = "100 kg m2", upper = "2000 kg m2", fit = true }
joint_damping = "500 N m s/rad"
lever = "0.3 m/rad"
lower_stop = "-0.6 rad"
upper_stop = "1.4 rad"
stop_stiffness = "1e7 N m/rad"
area_a = "40 cm2"
area_b = "24 cm2"
dead_volume_a = "1 L"
dead_volume_b = "1 L"
tank_pressure = "2 bar"
supply_pressure = "200 bar"
density = "870 kg/m3"
bulk_modulus = "800 MPa"
discharge_coefficient = 0.65
area_gradient = "20 mm"
pilot_gain = { start = "0.048 mm/bar", lower = "0.01 mm/bar", upper = "0.2 mm/bar", fit = true }
pilot_dead_band = "10 bar"
pilot_range = "20 bar"
leakage_coefficient = 0
leakage_area = "1 mm2"
[rig.controller]
type = "none"
[recording]
initial = "rest"
[recording.channels]
time = { column = "t_s", unit = "s" }
pilot_pressure = { column = "pilot_bar", unit = "bar" }
angle = { column = "angle_rad", unit = "rad", sd = "0.5 mrad" }
[[condition]]
id = "sine"
waveform = "sine"
frequency = "2 Hz"
amplitude = "20 bar"
use = "fit"
repeats = ["sine.csv"]
)";

/// A record of an arm whose true values are 400 kg m2 and 0.05 mm/bar, with noise of the stated sd.
datasets::Record considered_arm_record(const datasets::Campaign& campaign) {
  auto values = datasets::values_in(campaign, campaign.conditions.front());
  values.set("inertia", 400.0);
  values.set("pilot_gain", 5e-10);
  datasets::Record record;
  record.condition = "sine";
  for (int i = 0; i < 400; ++i) record.time_s.push_back(0.005 * i);
  const auto run =
      model::simulate(campaign.rig, values, {},
                      datasets::inputs_of(campaign, campaign.conditions.front(), values, nullptr),
                      record.time_s, std::vector{model::Output::angle}, model::SimulationOptions());
  if (!run.ok()) throw std::runtime_error(run.reason);
  boost::random::mt19937_64 random(1);
  boost::random::normal_distribution<double> normal;
  datasets::Series series;
  for (Eigen::Index i = 0; i < run.outputs.rows(); ++i)
    series.mean.push_back(run.outputs(i, 0) + 5e-4 * normal(random));
  series.sd_of_mean = 5e-4;
  record.channels[datasets::Channel::angle] = series;
  return record;
}

TEST_CASE("considered: a linkage has effects in radians and of its pilot", "[calib]") {
  const datasets::Campaign campaign = rigcal::test::load_text(kConsideredArm);
  const std::vector<datasets::Record> records{considered_arm_record(campaign)};
  const Problem problem =
      make_problem(campaign, records, {&campaign.conditions.front()}, false, nullptr);
  const auto effects = effects_of(problem, problem.start());
  std::set<std::string> keys;
  for (const Effect& each : effects) keys.insert(each.about.key);
  // The dead band is known, so it is not among the effects. The pressures are not compared.
  CHECK(keys == std::set<std::string>{
                    "valve_time_constant", "transport_delay", "trigger", "joint_friction",
                    "laminar_leakage", "leakage_coefficient", "valve_null_leakage",
                    "pilot_hysteresis", "dead_volume_a", "dead_volume_b", "supply_sag", "angle_lag",
                    "angle_gain", "angle_offset", "angle_bow", "angle_wave", "angle_hysteresis"});
  const Eigen::MatrixXd rows = effect_rows(problem, 0, problem.start(), effects, nullptr);
  REQUIRE(rows.allFinite());
  const auto column = [&](std::string_view key) -> Eigen::VectorXd {
    for (std::size_t e = 0; e < effects.size(); ++e)
      if (effects[e].about.key == key) return rows.col(static_cast<Eigen::Index>(e));
    throw std::runtime_error("no effect");
  };
  for (const Effect& each : effects) {
    CAPTURE(each.about.key);
    CHECK(column(each.about.key).norm() > 0.0);
    if (each.about.key == "joint_friction")  // 0.1 % of lever, area and supply
      CHECK_THAT(each.about.size, WithinRel(1e-3 * 0.3 * 4e-3 * 2e7, 1e-12));
    if (each.about.key == "angle_offset") CHECK_THAT(each.about.size, WithinRel(2e-4 * 2.0, 1e-12));
    if (each.about.key == "laminar_leakage") {  // 5 % of the flow at pilot_range over the supply
      const double flow = 0.65 * 0.02 * 4.8e-10 * 2e6 * std::sqrt(2e7 / 870.0);
      CHECK_THAT(each.about.size, WithinRel(0.05 * flow / 2e7, 1e-9));
    }
  }
  CHECK_THAT(column("angle_offset").minCoeff(), WithinAbs(4e-4 / 5e-4, 1e-9));
  // The bow is symmetric about the middle between the stops, 0.4 rad, where it is 0.
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effects.size()));
  const Eigen::VectorXd reading =
      outputs_with(problem, 0, problem.start(), effects, none, Derivatives::none, nullptr).outputs;
  for (const Eigen::Index i : {0, 50, 170}) {
    const double turn = (reading(i) * 5e-4 - 0.4) / 2.0;
    CHECK_THAT(column("angle_bow")(i), WithinRel(2e-3 * 4.0 * turn * turn / 5e-4, 1e-6));
    CHECK_THAT(column("angle_wave")(i),
               WithinRel(2e-3 * std::sin(2.0 * 3.14159265358979 * turn) / 5e-4, 1e-6));
  }
}

TEST_CASE("considered: a loop on the angle has effects of its gains, and a torque of its sensor",
          "[calib]") {
  using rigcal::test::replaced;
  std::string text = replaced(kConsideredArm,
                              "pilot_gain = { start = \"0.048 mm/bar\", lower = \"0.01 mm/bar\", "
                              "upper = \"0.2 mm/bar\", fit = "
                              "true }\npilot_dead_band = \"10 bar\"\npilot_range = \"20 bar\"",
                              "valve_gain = { start = \"0.2 mm/V\", lower = \"0.05 mm/V\", upper = "
                              "\"1 mm/V\", fit = true }");
  text = replaced(text, "type = \"none\"", "type = \"pid\"\nangle_kp = \"2 V/rad\"");
  text = replaced(text, "pilot_pressure = { column = \"pilot_bar\", unit = \"bar\" }",
                  "torque = { column = \"M_Nm\", unit = \"N m\", sd = \"20 N m\" }");
  const datasets::Campaign campaign =
      rigcal::test::load_text(replaced(text, "amplitude = \"20 bar\"", "amplitude = \"0.3 rad\""));
  const datasets::Condition& condition = campaign.conditions.front();
  datasets::Record record;
  record.condition = condition.id;
  for (int i = 0; i < 200; ++i) record.time_s.push_back(0.005 * i);
  const auto values = datasets::values_in(campaign, condition);
  const auto run = model::simulate(
      campaign.rig, values, {}, datasets::inputs_of(campaign, condition, values, nullptr),
      record.time_s, std::vector{model::Output::angle, model::Output::torque},
      model::SimulationOptions());
  REQUIRE(run.ok());
  const std::array channels{std::pair{datasets::Channel::angle, 5e-4},
                            std::pair{datasets::Channel::torque, 20.0}};
  for (Eigen::Index k = 0; k < 2; ++k) {
    const auto& [channel, sd] = channels.at(static_cast<std::size_t>(k));
    const Eigen::VectorXd column = run.outputs.col(k);
    record.channels[channel].mean.assign(column.begin(), column.end());
    record.channels[channel].sd_of_mean = sd;
  }
  const std::vector<datasets::Record> records{record};
  const Problem problem = make_problem(campaign, records, {&condition}, false, nullptr);
  std::map<std::string, double> sizes;
  for (const Effect& each : effects_of(problem, problem.start()))
    sizes[each.about.key] = each.about.size;
  for (const char* key : {"angle_ki", "sample_time", "torque_lag", "torque_gain", "angle_gain"}) {
    CAPTURE(key);
    CHECK(sizes.contains(key));
  }
  CHECK_THAT(sizes["angle_kp"], WithinRel(5e-3 * 2.0, 1e-12));
  // 0.1 % of lever, area and supply.
  CHECK_THAT(sizes["torque_offset"], WithinRel(1e-3 * 0.3 * 4e-3 * 2e7, 1e-12));
  CHECK_FALSE(sizes.contains("pilot_hysteresis"));
}

TEST_CASE("considered: what a linkage leaves out widens its intervals, or is a reservation",
          "[calib]") {
  datasets::Campaign campaign = rigcal::test::load_text(kConsideredArm);
  const std::vector<datasets::Record> records{considered_arm_record(campaign)};
  const Fit found = fit(campaign, records, {});
  REQUIRE(found.considered);
  CHECK(found.considered->missing.empty());
  for (const FittedParameter& each : found.parameters) {
    if (!each.fitted) continue;
    CHECK(each.ci95->low < each.ci95_if_exact->low);
    CHECK(each.ci95->high > each.ci95_if_exact->high);
  }
  campaign.considered.left_out = {"joint_friction", "angle_bow"};
  CHECK(fit(campaign, records, {}).considered->left_out ==
        std::vector<std::string>{"joint_friction", "angle_bow"});
}

TEST_CASE("considered: the missing effect is refitted, and the estimates with it are the rig's",
          "[calib]") {
  SmallRig rig;
  rig.truth.parameters.push_back(known(Twin::index("laminar_leakage"), 2e-11));
  const Fit found = rig.fitted();
  const Considered& considered = found.considered.value();
  REQUIRE_FALSE(considered.missing.empty());
  REQUIRE_FALSE(considered.refitted.empty());
  const ConsideredEffect& first = *considered.find(considered.missing.front());
  CHECK(first.key == "laminar_leakage");
  CHECK_THAT(first.alone.value(), WithinAbs(2e-11, 1.5 * first.alone_half_width.value()));
  double weights = 0.0;
  double best = 0.0;
  for (const RefittedModel& each : considered.refitted) {
    weights += each.weight;
    REQUIRE(each.sizes.size() == each.effects.size());
    if (each.effects == considered.missing) best = each.fall;
    if (each.effects.empty()) {
      CHECK(each.fall == 0.0);
      CHECK(each.weight < 1e-3);
    }
  }
  CHECK_THAT(weights, WithinRel(1.0, 1e-12));
  for (const RefittedModel& each : considered.refitted) {
    if (each.effects.size() == 1) CHECK(each.fall <= best);
    REQUIRE(each.held_out_fall);
  }
  const std::vector<std::pair<const char*, double>> truth{
      {"mass", 85.0}, {"bulk_modulus", 689e6}, {"valve_gain", 4.06e-5}};
  for (const auto& [key, value] : truth) {
    for (const FittedParameter& each : found.parameters) {
      if (each.index != Twin::index(key)) continue;
      CAPTURE(key, each.value, each.averaged->value, each.averaged->standard_error);
      CHECK(std::abs(each.averaged->value - value) < 3.5 * each.averaged->standard_error);
      CHECK(each.ci95->low <= value);
      CHECK(value <= each.ci95->high);
      const Budget95& budget = each.budget.value();
      const auto line = std::find_if(budget.lines.begin(), budget.lines.end(),
                                     [](const auto& one) { return one.source == "nonlinearity"; });
      REQUIRE(line != budget.lines.end());
      const double differ = each.averaged->value - each.value - budget.shift;
      CHECK_THAT(line->uncertainty, WithinRel(std::abs(differ) / std::sqrt(3.0), 1e-9));
      CHECK(budget.combined >= line->uncertainty);
      // The refitted models lack the other effects, whose uncertainty is that of the budget.
      CHECK(budget.expanded > budget.coverage_factor * each.averaged->standard_error);
      const double least =
          model::parameter_table(
              model::PlantKind::load_pressure)[static_cast<std::size_t>(each.index)]
              .lower;
      CHECK(each.ci95->low <=
            (1.0 + 1e-9) * std::max(least, each.averaged->value - budget.expanded));
      CHECK(each.ci95->high >= (1.0 - 1e-9) * (each.averaged->value + budget.expanded));
    }
  }
}

TEST_CASE("considered: an uncertain value that cannot be zero is known up to a factor", "[calib]") {
  SmallRig rig;
  rig.free("damping", 1500.0, 300.0, 6000.0);
  // An uncertain volume acts like softer oil, so the bulk modulus becomes uncertain.
  rig.campaign.considered.sizes["total_volume"] = 0.3 * 2.47e-4;
  rig.noise_sd_m *= 8.0;
  rig.campaign.considered.sizes["coulomb_friction"] = 200.0;
  const Fit found = rig.fitted();
  const auto estimate = [](const Fit& fit, const char* key) {
    return *std::find_if(fit.parameters.begin(), fit.parameters.end(),
                         [&](const auto& each) { return each.index == Twin::index(key); });
  };
  const FittedParameter oil = estimate(found, "bulk_modulus");
  const Budget95& budget = oil.budget.value();
  REQUIRE_FALSE(oil.averaged);
  REQUIRE(budget.expanded > kWeak * oil.value);
  // The mean size of the volume shifts the estimate further than the likeliest size, zero.
  REQUIRE(budget.shift > 0.03 * oil.value);
  CHECK_THAT(oil.ci95->high,
             WithinRel(oil.value * std::exp((budget.shift + budget.expanded) / oil.value), 1e-9));
  CHECK(oil.ci95->low <= oil.value - budget.expanded);
  // Below a fifth of the value, and for a value that may be zero, the interval is linear.
  const FittedParameter gain = estimate(found, "valve_gain");
  const FittedParameter damping = estimate(found, "damping");
  REQUIRE(gain.budget->expanded < kWeak * gain.value);
  REQUIRE(damping.budget->expanded > kWeak * damping.value);
  for (const FittedParameter& each : {gain, damping}) {
    const double above = std::max(0.0, each.budget->shift) + each.budget->expanded;
    CHECK_THAT(each.ci95->high, WithinRel(each.value + above, 1e-9));
  }
  rig.campaign.considered.none = true;
  const FittedParameter exact = estimate(rig.fitted(), "bulk_modulus");
  CHECK_THAT(exact.ci95->high, WithinRel(exact.ci95_if_exact->high, 1e-3));
}

TEST_CASE("considered: nothing is refitted where the residuals ask for nothing", "[calib]") {
  const SmallRig rig;
  const Fit found = rig.fitted();
  CHECK(found.considered->refitted.empty());
  for (const FittedParameter& each : found.parameters) CHECK_FALSE(each.averaged);
}

TEST_CASE("considered: what a model error that nothing shows could move at most", "[calib]") {
  SmallRig rig;
  const auto moved = [&](double tolerated) {
    rig.campaign.acceptance_bounds.model_error_to_noise = tolerated;
    return parameter(rig.fitted(), "mass");
  };
  const FittedParameter little = moved(0.05);
  // In phase with the sensitivity at each of 1000 samples of a condition.
  CHECK_THAT(little.moved_by_unseen,
             WithinRel(0.05 * std::sqrt(1000.0) * little.standard_error.value(), 0.05));
  CHECK_THAT(moved(0.1).moved_by_unseen, WithinRel(2.0 * little.moved_by_unseen, 1e-6));
  // A larger error would show, however much is tolerated: F with about 1000 degrees of freedom.
  const double most = moved(5.0).moved_by_unseen;
  CHECK(most == moved(50.0).moved_by_unseen);
  CHECK(most > 4.0 * little.moved_by_unseen);
  CHECK(most < 10.0 * little.moved_by_unseen);
}

TEST_CASE("considered: a band of prediction includes an effect less what the fit took for it",
          "[calib]") {
  SmallRig rig;
  rig.add("faster", datasets::Waveform::sine, 6.0, 0.01).use = datasets::Use::validate;
  // Prediction variance beyond the noise, from the estimates and the effects, summed over all
  // samples.
  const auto beyond_noise = [&](datasets::Use use) {
    const Fit found = rig.fitted();
    double sum = 0.0;
    for (const ConditionScore& each : found.conditions) {
      if (each.use != use) continue;
      for (const double sd : each.prediction_sd.at(datasets::Channel::position))
        sum += sd * sd - rig.noise_sd_m * rig.noise_sd_m;
    }
    return sum;
  };
  const double predicted = beyond_noise(datasets::Use::validate);
  const double fitted = beyond_noise(datasets::Use::fit);
  rig.campaign.considered.none = true;
  CHECK(predicted > 5.0 * beyond_noise(datasets::Use::validate));
  CHECK_THAT(fitted, WithinRel(beyond_noise(datasets::Use::fit), 1e-9));
}

TEST_CASE("effect_covariance: second moments of the sizes, and moves by the lines of budgets",
          "[calib]") {
  Considered considered;
  considered.effects.resize(2);
  considered.effects[0].key = "ki";
  considered.effects[0].estimate = 3.0;
  considered.effects[0].standard_error = 4.0;
  considered.effects[1].key = "laminar_leakage";
  considered.effects[1].estimate = 0.0;
  considered.effects[1].standard_error = 1e-12;
  considered.correlation = Eigen::Matrix2d::Identity();
  considered.correlation(0, 1) = considered.correlation(1, 0) = -0.5;
  Budget95 budget;
  // A known value may have the name of an effect.
  budget.lines = {{"noise", "records", 1.0},
                  {"laminar_leakage", "effect", 2.0, 7e12},
                  {"ki", "known_value", 1.0, 9.0}};
  const EffectCovariance spread = effect_covariance(considered, {&budget, nullptr});
  CHECK_THAT(spread.size("ki"), WithinRel(5.0, 1e-12));
  CHECK_THAT(spread.size("laminar_leakage"), WithinRel(1e-12, 1e-12));
  CHECK(spread.size("kp") == 0.0);
  const Eigen::MatrixXd moments = spread.root * spread.root.transpose();
  CHECK_THAT(moments(0, 1), WithinRel(-0.5 * 4.0 * 1e-12, 1e-9));
  CHECK(spread.moves(0, 1) == 7e12);
  CHECK(spread.moves(0, 0) == 0.0);
  CHECK(spread.moves.row(1).norm() == 0.0);
}

TEST_CASE("sensor_changes: gain, offset and lag of a sensor, each by its size", "[calib]") {
  const SmallRig rig;
  const auto records = rig.records(1000, 1000.0, 1);
  std::vector<const datasets::Condition*> conditions;
  for (const auto& each : rig.campaign.conditions) conditions.push_back(&each);
  const Problem problem = make_problem(rig.campaign, records, conditions, false, nullptr);
  EffectCovariance spread;
  spread.keys = {"position_gain", "position_offset", "position_lag", "ki"};
  spread.root = Eigen::Vector4d(2e-3, 1e-5, 1e-3, 1.0).asDiagonal();
  spread.moves = Eigen::MatrixXd::Zero(0, 4);
  const auto acting = considered_in(problem, problem.start(), spread);
  REQUIRE(acting.size() == 4);
  const std::vector<double> reading{0.0, 0.01, 0.04};
  const std::vector<double> time_s{0.0, 0.1, 0.2};
  const auto changes = sensor_changes(datasets::Channel::position, acting, spread, reading, time_s);
  REQUIRE(changes.size() == 3);
  double gain = 0.0, offset = 0.0, lag = 0.0;
  for (const auto& each : changes) {
    if (each.key == "position_gain") gain = each.change[2];
    if (each.key == "position_offset") offset = each.change[2];
    if (each.key == "position_lag") lag = each.change[1];
  }
  CHECK_THAT(gain, WithinRel(2e-3 * 0.04, 1e-12));
  CHECK_THAT(offset, WithinRel(1e-5, 1e-12));
  CHECK_THAT(lag, WithinRel(-1e-3 * 0.2, 1e-9));
  CHECK(sensor_changes(datasets::Channel::force, acting, spread, reading, time_s).empty());
}

}  // namespace
}  // namespace rigcal::calib
