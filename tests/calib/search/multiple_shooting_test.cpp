#include "calib/search/multiple_shooting.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "calib/search/search.hpp"
#include "common/error.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using datasets::Channel;

/// A single-rod cylinder with known parameters and a recorded command. Its position is the integral
/// of the flow, so any valve error makes it drift until the piston reaches a stop.
struct OpenLoop {
  datasets::Campaign campaign;
  model::ParameterValues truth = model::ParameterValues::defaults(model::PlantKind::two_chamber);
  std::vector<Channel> recorded{Channel::position};
  bool rings = false;  ///< the valve is open for a quarter of the time and closed for the rest

  OpenLoop() {
    campaign.file = "open_loop.toml";
    campaign.rig = {model::PlantKind::two_chamber, model::ControllerKind::none,
                    model::InitialState::rest};
    for (const auto& [key, value] : std::initializer_list<std::pair<std::string_view, double>>{
             {"mass", 40.0},
             {"damping", 300.0},
             {"stiffness", 0.0},
             {"area_a", 2.0e-4},
             {"area_b", 1.2e-4},
             {"stroke", 0.2},
             {"dead_volume_a", 2e-5},
             {"dead_volume_b", 3e-5},
             {"supply_pressure", 4.4e6},
             {"tank_pressure", 1e5},
             {"density", 850.0},
             {"bulk_modulus", 700e6},
             {"discharge_coefficient", 0.6},
             {"area_gradient", 0.02},
             {"valve_gain", 4e-6},
             {"valve_offset", 0.1},
             {"leakage_coefficient", 0.0},
             {"leakage_area", 1e-6},
             {"laminar_leakage", 2e-13},
         }) {
      campaign.parameters.push_back(known(index(key), value));
      truth.set(key, value);
    }
  }

  static int index(std::string_view key) {
    return model::parameter_index(model::PlantKind::two_chamber, key);
  }

  void set(std::string_view key, double value) {
    truth.set(key, value);
    for (auto& each : campaign.parameters) {
      if (each.index == index(key)) each.value = value;
    }
  }

  void free(std::string_view key, double start, double lower, double upper) {
    for (auto& each : campaign.parameters) {
      if (each.index != index(key)) continue;
      each.value = start;
      each.lower = lower;
      each.upper = upper;
      each.fit = true;
    }
  }

  /// Makes records with a command that changes every 0.15 s, one second for each condition.
  std::vector<datasets::Record> records(int conditions, unsigned seed) {
    boost::random::mt19937_64 random(seed);
    boost::random::normal_distribution<double> normal;
    campaign.channels.clear();
    campaign.channels[Channel::command].channel = Channel::command;
    campaign.channels[Channel::command].role = datasets::ChannelRole::input;
    std::vector<model::Output> outputs;
    for (const Channel channel : recorded) {
      campaign.channels[channel].channel = channel;
      outputs.push_back(datasets::model_output(channel).value());
    }
    std::vector<datasets::Record> result;
    for (int c = 0; c < conditions; ++c) {
      datasets::Condition condition;
      condition.id = "run" + std::to_string(c);
      condition.waveform = datasets::Waveform::recorded;
      campaign.conditions.push_back(condition);
      datasets::Record record;
      record.condition = condition.id;
      std::vector<double>& command = record.channels[Channel::command].mean;
      for (int i = 0; i <= 1500; ++i) {
        record.time_s.push_back(1e-3 * i);
        const int step = i / 150 + 3 * c;
        const double opening = (step % 2 == 0 ? 1.0 : -1.0) * (0.6 + 0.2 * (step % 4));
        const double pulse = step % 4 == 0 ? (step % 8 == 0 ? 0.8 : -0.6) : 0.0;
        command.push_back((rings ? pulse : opening) - truth["valve_offset"]);
      }
      model::SimulationInputs inputs;
      inputs.drive = model::Signal::held(record.time_s, command);
      model::SimulationOptions options;
      options.tolerance = 1e-9;
      const auto run =
          model::simulate(campaign.rig, truth, {}, inputs, record.time_s, outputs, options);
      if (!run.ok()) throw std::runtime_error("open loop: " + run.reason);
      for (std::size_t k = 0; k < recorded.size(); ++k) {
        const double sd = recorded[k] == Channel::position ? 5e-5 : 1e4;
        datasets::Series& series = record.channels[recorded[k]];
        for (Eigen::Index i = 0; i < run.outputs.rows(); ++i)
          series.mean.push_back(run.outputs(i, static_cast<Eigen::Index>(k)) + sd * normal(random));
        series.sd_of_mean = sd;
      }
      result.push_back(record);
    }
    return result;
  }
};

/// Returns the largest distance of the unknowns from given values, in standard errors of a fit.
double errors_off(const Fit& fit, const std::vector<double>& values) {
  double worst = 0.0;
  std::size_t j = 0;
  for (const FittedParameter& each : fit.parameters) {
    if (!each.fitted) continue;
    worst = std::max(worst, std::abs(each.value - values[j++]) / each.standard_error.value());
  }
  return worst;
}

std::vector<double> true_values(const OpenLoop& rig, const Fit& fit) {
  std::vector<double> values;
  for (const FittedParameter& each : fit.parameters) {
    if (each.fitted) values.push_back(rig.truth.value[static_cast<std::size_t>(each.index)]);
  }
  return values;
}

Problem problem_of(const datasets::Campaign& campaign,
                   const std::vector<datasets::Record>& records) {
  std::vector<const datasets::Condition*> conditions;
  for (const auto& condition : campaign.conditions) conditions.push_back(&condition);
  return make_problem(campaign, records, conditions, false, nullptr);
}

/// Runs only multiple shooting, from the campaign's start values.
ShootingResult shoot(const Problem& problem, double interval_s, int threads = 1) {
  Budget budget;
  Evaluator evaluator(problem, budget, threads);
  const FitOptions options;
  Iterations iterations(options);
  return multiple_shooting(problem, evaluator, problem.start(), interval_s, 100, iterations);
}

}  // namespace

TEST_CASE("multiple shooting: by itself it ends where single shooting does", "[calib]") {
  OpenLoop rig;
  rig.recorded = {Channel::position, Channel::pressure_a, Channel::pressure_b};
  rig.free("mass", 30.0, 4.0, 400.0);
  rig.free("bulk_modulus", 600e6, 70e6, 7000e6);
  rig.free("valve_gain", 5e-6, 0.4e-6, 40e-6);
  rig.free("laminar_leakage", 4e-13, 0.0, 1e-11);
  // The tolerance is so small that simulation errors, which are different for pieces, do not
  // matter.
  rig.campaign.simulation.tolerance = 1e-9;
  const auto records = rig.records(1, 5);
  const Fit single = fit(rig.campaign, records, {});
  REQUIRE(single.status == FitStatus::converged);
  CHECK(errors_off(single, true_values(rig, single)) < 3.5);

  const Problem problem = problem_of(rig.campaign, records);
  const ShootingResult shot = shoot(problem, 0.1);
  CHECK(shot.largest_gap < 1.0);
  CHECK(errors_off(single, problem.to_physical(shot.z)) < 0.01);
}

TEST_CASE("multiple shooting: the same bits for any number of threads", "[calib]") {
  OpenLoop rig;
  rig.free("mass", 30.0, 4.0, 400.0);
  rig.free("valve_gain", 5e-6, 0.4e-6, 40e-6);
  const auto records = rig.records(2, 5);
  const Problem problem = problem_of(rig.campaign, records);
  const ShootingResult one = shoot(problem, 0.1);
  CHECK(one.iterations > 0);
  const ShootingResult other = shoot(problem, 0.1, 3);
  REQUIRE(other.z.size() == one.z.size());
  CHECK(std::memcmp(other.z.data(), one.z.data(), one.z.size() * sizeof(double)) == 0);
}

TEST_CASE("multiple shooting: an interval longer than the records leaves nothing to do",
          "[calib]") {
  OpenLoop rig;
  rig.free("valve_gain", 5e-6, 0.4e-6, 40e-6);
  const auto records = rig.records(1, 5);
  const Problem problem = problem_of(rig.campaign, records);
  const ShootingResult none = shoot(problem, 5.0);
  CHECK(none.iterations == 0);
  CHECK(none.z == problem.start());
}

TEST_CASE("multiple shooting: finds what single shooting does not", "[calib]") {
  // After each pulse of the valve the oil rings for eleven periods. If the initial mass is wrong by
  // a factor of 3.75, every simulation loses count of the periods, and the fit ends in one of many
  // meaningless minima.
  OpenLoop rig;
  rig.rings = true;
  rig.recorded = {Channel::position, Channel::pressure_a, Channel::pressure_b};
  rig.set("damping", 30.0);
  rig.set("laminar_leakage", 2e-14);
  rig.free("mass", 150.0, 4.0, 400.0);
  rig.free("bulk_modulus", 700e6, 70e6, 7000e6);
  rig.free("valve_gain", 8e-6, 0.4e-6, 40e-6);
  const auto records = rig.records(1, 5);
  const Fit single = fit(rig.campaign, records, {});
  CHECK(errors_off(single, true_values(rig, single)) > 10.0);
  CHECK(single.reduced_chi_square > 100.0);

  rig.campaign.fit.shooting_interval_s = 0.02;
  const Fit shot = fit(rig.campaign, records, {});
  REQUIRE(shot.status == FitStatus::converged);
  CHECK(errors_off(shot, true_values(rig, shot)) < 3.5);
  CHECK(shot.reduced_chi_square < 1.1);

  SECTION("what is reported is the fit of whole runs from there") {
    for (auto& each : rig.campaign.parameters) {
      for (const FittedParameter& found : shot.parameters) {
        if (found.fitted && found.index == each.index) each.value = found.value;
      }
    }
    rig.campaign.fit.shooting_interval_s.reset();
    const Fit again = fit(rig.campaign, records, {});
    REQUIRE(again.status == FitStatus::converged);
    CHECK(again.cost == Approx(shot.cost).epsilon(1e-6));
    CHECK(again.residual_count == shot.residual_count);
    for (const FittedParameter& each : again.parameters) {
      if (!each.fitted) continue;
      const auto same = std::find_if(shot.parameters.begin(), shot.parameters.end(),
                                     [&](const auto& other) { return other.index == each.index; });
      CHECK(each.standard_error.value() == Approx(same->standard_error.value()).epsilon(1e-2));
    }
  }
}

TEST_CASE("multiple shooting: what comes to nothing never looks converged", "[calib]") {
  OpenLoop rig;
  rig.free("valve_gain", 5e-6, 0.4e-6, 40e-6);
  rig.free("mass", 30.0, 4.0, 400.0);
  const auto records = rig.records(1, 5);
  SECTION("a signal") {
    rig.campaign.fit.shooting_interval_s = 0.1;
    std::atomic<bool> cancel{true};
    FitOptions options;
    options.cancel = &cancel;
    CHECK(fit(rig.campaign, records, options).status == FitStatus::stopped);
  }
  SECTION("a limit of evaluations that ends it between two stages") {
    rig.campaign.fit.shooting_interval_s = 0.1;
    FitOptions options;
    options.max_evaluations = 8;
    const Fit stopped = fit(rig.campaign, records, options);
    CHECK(stopped.status == FitStatus::stopped);
    CHECK(stopped.evaluations <= 9);
  }
  SECTION("pieces without samples, a controller with ticks") {
    const Problem problem = problem_of(rig.campaign, records);
    CHECK_THROWS_WITH(shoot(problem, 2e-3), Contains("run0") && Contains("fewer than 4 samples"));
    datasets::Campaign sampled = rig.campaign;
    sampled.rig.controller = model::ControllerKind::pid;
    sampled.parameters.push_back(known(OpenLoop::index("kp"), 10.0));
    sampled.parameters.push_back(known(OpenLoop::index("sample_time"), 1e-3));
    datasets::ChannelSetting reference;
    reference.channel = Channel::reference;
    reference.role = datasets::ChannelRole::input;
    sampled.channels[Channel::reference] = reference;
    auto looped = records;
    looped[0].channels[Channel::reference] = looped[0].channels[Channel::position];
    CHECK_THROWS_WITH(shoot(problem_of(sampled, looped), 0.1), Contains("sample_time"));
  }
}

}  // namespace rigcal::calib
