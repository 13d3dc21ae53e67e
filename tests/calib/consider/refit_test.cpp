#include "calib/consider/refit.hpp"

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "bench/foreign_campaign.hpp"
#include "calib/fit.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/problem/measured_tolerance.hpp"
#include "datasets/prepare/load_record.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Channel;

/// A fit of five values to records from an independent integrator and right-hand side
/// (bench/foreign_rig.hpp): a small version of the long study by scripts/coverage-study --effects.
struct ForeignFit {
  static constexpr std::array<std::pair<const char*, double bench::ForeignRig::*>, 5> kFree{
      {{"mass", &bench::ForeignRig::mass_kg},
       {"damping", &bench::ForeignRig::damping_n_s_per_m},
       {"bulk_modulus", &bench::ForeignRig::bulk_modulus_pa},
       {"valve_gain", &bench::ForeignRig::valve_gain_m_per_v},
       {"leakage_coefficient", &bench::ForeignRig::leak_coefficient}}};
  Fit fit;
  std::string named;  ///< the effect that the residuals call for first
  int held = 0;       ///< number of intervals that include the true value

  ForeignFit(const bench::ForeignRig& rig, unsigned seed) {
    const std::vector<bench::Reference> references{
        {"square", 1.0, 0.05, 2.0}, {"square", 4.0, 0.02, 1.0}, {"sine", 5.0, 0.02, 1.0}};
    datasets::Campaign campaign = bench::foreign_campaign(rig);
    for (const auto& [key, value] : kFree) {
      datasets::ParameterSetting setting = known(Twin::index(key), 1.1 * rig.*value);
      setting.fit = true;
      setting.lower = rig.*value / 5.0;
      setting.upper = rig.*value * 5.0;
      campaign.parameters.push_back(setting);
    }
    for (const bench::Reference& each : references) {
      datasets::Condition& condition = campaign.conditions.emplace_back();
      condition.id = each.waveform + std::to_string(each.frequency_hz);
      condition.waveform =
          each.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
      condition.frequency_hz = each.frequency_hz;
      condition.amplitude = each.amplitude_m;
      condition.duration_s = each.duration_s;
    }
    boost::random::mt19937_64 stream(seed);
    boost::random::normal_distribution<double> normal(0.0, 5e-5);
    std::vector<datasets::Record> records;
    for (std::size_t c = 0; c < references.size(); ++c) {
      const std::vector<double> exact = bench::foreign_readings(rig, references[c]);
      std::vector<datasets::Repeat> repeats(5);
      for (datasets::Repeat& repeat : repeats) {
        for (std::size_t k = 0; k < exact.size(); ++k) {
          repeat.time_s.push_back(static_cast<double>(k) / 1000.0);
          repeat.values[Channel::position].push_back(exact[k] + normal(stream));
        }
      }
      records.push_back(datasets::average_of(campaign, campaign.conditions[c], repeats, true));
    }
    fit = calib::fit(campaign, records, {});
    if (fit.considered && !fit.considered->missing.empty()) named = fit.considered->missing.front();
    for (const auto& [key, value] : kFree) {
      for (const FittedParameter& each : fit.parameters) {
        if (each.index != Twin::index(key) || !each.ci95) continue;
        held += each.ci95->low <= rig.*value && rig.*value <= each.ci95->high ? 1 : 0;
      }
    }
  }
};

TEST_CASE("refit: of two effects that act alike the true one leaves less", "[calib][long]") {
  bench::ForeignRig delayed;
  delayed.delay_s = 0.5e-3;
  const ForeignFit delay(delayed, 11);
  CHECK(delay.named == "transport_delay");
  CHECK(delay.held == 5);
  bench::ForeignRig leaking;
  leaking.laminar_m3_per_s_pa = 5e-12;
  const ForeignFit leak(leaking, 12);
  CHECK(leak.named == "laminar_leakage");
  CHECK(leak.held == 5);
  const ConsideredEffect& effect = *leak.fit.considered->find(leak.fit.considered->missing.at(0));
  CHECK_THAT(effect.alone.value(), WithinAbs(5e-12, 2.0 * effect.alone_half_width.value()));
}

TEST_CASE("refit: an effect that moves an estimate far is seen where the estimates follow it",
          "[calib]") {
  bench::ForeignRig leaking;
  leaking.laminar_m3_per_s_pa = 3e-12;  // takes the bulk modulus along by a tenth
  leaking.valve_gain_m_per_v = 4.9e-5;
  leaking.leak_coefficient = 0.4;
  const ForeignFit leak(leaking, 14);
  CHECK(leak.named == "laminar_leakage");
  CHECK(leak.held == 5);
  const ConsideredEffect& effect = *leak.fit.considered->find("laminar_leakage");
  CHECK_THAT(effect.alone.value(), WithinAbs(3e-12, 1.5 * effect.alone_half_width.value()));
}

TEST_CASE("refit: a rig without effects asks for none, and its values are held", "[calib]") {
  const ForeignFit none(bench::ForeignRig{}, 13);
  CHECK(none.named.empty());
  CHECK(none.held == 5);
}

TEST_CASE("refit: unknowns and effect end at the truth of noiseless records", "[calib]") {
  Twin twin;
  twin.noise_sd_m = 0.0;
  twin.free("mass", 85.0, 20.0, 400.0);
  twin.free("valve_gain", 4.06e-5, 1e-5, 2e-4);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  twin.add("sine", datasets::Waveform::sine, 3.0, 0.02);
  twin.truth.parameters.push_back(known(Twin::index("coulomb_friction"), 30.0));
  const auto records = twin.records(1000, 1000.0, 1);
  std::vector<const datasets::Condition*> conditions;
  for (const auto& each : twin.campaign.conditions) conditions.push_back(&each);
  Problem problem = make_problem(twin.campaign, records, conditions, false, nullptr);
  for (ProblemCondition& condition : problem.conditions) {
    for (ProblemChannel& channel : condition.channels) channel.sd = 1e-5;
  }
  const std::vector<double> z = problem.start();  // the true values, but without friction
  std::vector<Effect> effects = effects_of(problem, z);
  std::erase_if(effects, [](const Effect& each) { return each.about.key != "coulomb_friction"; });
  REQUIRE(effects.size() == 1);
  const Evaluation at = evaluate_at(problem, z, 1, {Fidelity::full, nullptr, true});
  std::vector<ScoreRows> scores;
  for (const ConditionRows& rows : *at.rows) {
    ScoreRows& own = scores.emplace_back();
    own.residual = rows.residual;
  }
  const Refitter refitter(problem, z, scores, 1, nullptr);
  const auto found = refitter.fit(effects, z, Eigen::VectorXd::Constant(1, 1.0));
  REQUIRE(found);
  CHECK_THAT(found->sizes(0) * effects[0].about.size, WithinRel(30.0, 0.02));
  const std::vector<double> values = problem.to_physical(found->z);
  CHECK_THAT(values[0], WithinRel(85.0, 1e-3));
  CHECK_THAT(values[1], WithinRel(4.06e-5, 1e-3));
  REQUIRE(found->held_out);
  CHECK(*found->held_out >= found->squares);
}

TEST_CASE("refit: with a recorded drive fewer simulations lead to the same minimum", "[calib]") {
  Twin twin;
  twin.free("mass", 85.0, 20.0, 400.0);
  twin.free("valve_gain", 4.06e-5, 1e-5, 2e-4);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  twin.add("sine", datasets::Waveform::sine, 3.0, 0.02);
  twin.truth.parameters.push_back(known(Twin::index("coulomb_friction"), 30.0));
  auto records = twin.records(1000, 1000.0, 3);
  twin.add_channel(Channel::reference, datasets::ChannelRole::input);
  boost::random::mt19937_64 random(7);
  boost::random::normal_distribution<double> noise(0.0, 2e-5);
  const model::Signal drives[] = {model::Signal::square(0.01, 2.0), model::Signal::sine(0.02, 3.0)};
  std::vector<const datasets::Condition*> conditions;
  for (std::size_t c = 0; c < records.size(); ++c) {
    twin.campaign.conditions[c].waveform = datasets::Waveform::recorded;
    conditions.push_back(&twin.campaign.conditions[c]);
    datasets::Series& reference = records[c].channels[Channel::reference];
    for (const double t : records[c].time_s)
      reference.mean.push_back(drives[c].value(t) + noise(random));
  }
  Problem problem = make_problem(twin.campaign, records, conditions, false, nullptr);
  const std::vector<double> z = problem.start();  // the true values, but without friction
  std::vector<Effect> effects = effects_of(problem, z);
  std::erase_if(effects, [](const Effect& each) { return each.about.key != "coulomb_friction"; });
  REQUIRE(effects.size() == 1);
  const auto refitted_from = [&](const std::vector<double>& start, double size) {
    const Evaluation at = evaluate_at(problem, z, 1, {Fidelity::full, nullptr, true});
    std::vector<ScoreRows> scores;
    for (const ConditionRows& rows : *at.rows) scores.emplace_back().residual = rows.residual;
    const Refitter refitter(problem, z, scores, 1, nullptr);
    return refitter.fit(effects, start, Eigen::VectorXd::Constant(1, size));
  };
  const auto refitted = [&] { return refitted_from(z, 0.2); };
  const auto full = refitted();  // derivatives at each point, each step simulated
  measure_tolerances(problem, z, 1, nullptr);
  REQUIRE(problem.conditions[0].measured_tolerance > 0.0);
  const auto few = refitted();
  REQUIRE(full);
  REQUIRE(few);
  CHECK(full->sizes(0) > 5.0 * std::sqrt(full->covariance(2, 2)));
  CHECK(std::abs(few->sizes(0) - full->sizes(0)) < 0.1 * std::sqrt(full->covariance(2, 2)));
  for (Eigen::Index j = 0; j < 2; ++j) {
    const auto u = static_cast<std::size_t>(j);
    CHECK(std::abs(few->z[u] - full->z[u]) < 0.1 * std::sqrt(full->covariance(j, j)));
    CHECK_THAT(few->covariance(j, j), WithinRel(full->covariance(j, j), 0.02));
  }
  const double variance = full->squares / static_cast<double>(problem.residual_count());
  CHECK_THAT(few->squares, WithinAbs(full->squares, 0.3 * variance));
  REQUIRE(few->held_out);
  CHECK_THAT(*few->held_out, WithinRel(*full->held_out, 0.05));

  // From 0.8 standard errors beside the minimum, the step to it is taken without a simulation.
  const Eigen::VectorXd beside = 0.8 * few->covariance.col(1) / std::sqrt(few->covariance(1, 1));
  const auto near =
      refitted_from({few->z[0] + beside(0), few->z[1] + beside(1)}, few->sizes(0) + beside(2));
  REQUIRE(near);
  CHECK_THAT(near->squares, WithinAbs(few->squares, 0.15 * variance));
  CHECK(std::abs(near->z[1] - few->z[1]) < 0.2 * std::sqrt(few->covariance(1, 1)));
  CHECK_THAT(*near->held_out - near->squares, WithinRel(*few->held_out - few->squares, 0.01));
}

TEST_CASE("refit: a condition that is held out is predicted by the others alone", "[calib]") {
  Twin twin;
  twin.free("mass", 85.0, 20.0, 400.0);
  twin.free("valve_gain", 4.06e-5, 1e-5, 2e-4);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  twin.add("sine", datasets::Waveform::sine, 3.0, 0.02);
  const auto records = twin.records(1000, 1000.0, 4);
  const auto problem_with = [&](const std::vector<std::size_t>& kept) {
    std::vector<const datasets::Condition*> conditions;
    for (const std::size_t c : kept) conditions.push_back(&twin.campaign.conditions[c]);
    return make_problem(twin.campaign, records, conditions, false, nullptr);
  };
  const auto refitted = [](const Problem& problem) {
    const std::vector<double> z = problem.start();
    const Evaluation at = evaluate_at(problem, z, 1, {Fidelity::full, nullptr, true});
    std::vector<ScoreRows> scores;
    for (const ConditionRows& rows : *at.rows) scores.emplace_back().residual = rows.residual;
    const auto found = Refitter(problem, z, scores, 1, nullptr).fit({}, z, Eigen::VectorXd());
    REQUIRE(found);
    return *found;
  };
  const Problem both = problem_with({0, 1});
  const Refit whole = refitted(both);
  const auto squares_of = [&](std::size_t condition, const std::vector<double>& z) {
    ConditionRows rows;
    REQUIRE(evaluate_condition(both, condition, z, nullptr, &rows).ok());
    return rows.residual.squaredNorm();
  };
  double more = 0.0;
  for (const std::size_t c : {0UL, 1UL})
    more += squares_of(c, refitted(problem_with({1 - c})).z) - squares_of(c, whole.z);
  REQUIRE(more > 1.0);
  REQUIRE(whole.held_out);
  CHECK_THAT(*whole.held_out - whole.squares, WithinRel(more, 0.15));
}

TEST_CASE("refit: the derivative by the error of a sensor takes no simulation", "[calib]") {
  Twin twin;
  twin.free("mass", 85.0, 20.0, 400.0);
  twin.add("sine", datasets::Waveform::sine, 3.0, 0.02);
  const auto records = twin.records(400, 1000.0, 1);
  const Problem problem =
      make_problem(twin.campaign, records, {&twin.campaign.conditions[0]}, false, nullptr);
  const std::vector<double> z = problem.start();
  std::vector<Effect> effects = effects_of(problem, z);
  std::erase_if(effects, [](const Effect& each) {
    return each.about.key != "position_bow" && each.about.key != "coulomb_friction";
  });
  REQUIRE(effects.size() == 2);
  const Eigen::Index bow = effects[0].is_of_sensor() ? 0 : 1;
  const Eigen::VectorXd sizes = Eigen::VectorXd::Constant(2, 0.7);
  const auto with = outputs_with(problem, 0, z, effects, sizes, Derivatives::of_unknowns, nullptr);
  Eigen::VectorXd further = sizes;
  further(bow) += kEffectStep;
  const auto there =
      outputs_with(problem, 0, z, effects, further, Derivatives::of_unknowns, nullptr);
  REQUIRE(with.by_sensor.cols() == 2);
  const Eigen::VectorXd difference = (there.outputs - with.outputs) / kEffectStep;
  CHECK(difference.norm() > 0.1);
  CHECK((with.by_sensor.col(bow) - difference).norm() < 1e-9 * difference.norm());
  CHECK(with.by_sensor.col(1 - bow).norm() == 0.0);
  CHECK(outputs_with(problem, 0, z, effects, sizes, Derivatives::none, nullptr).by_sensor.cols() ==
        0);
}

}  // namespace
}  // namespace rigcal::calib
