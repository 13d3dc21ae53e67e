#include "calib/design/design.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "calib/fit.hpp"
#include "calib/trust/information.hpp"
#include "datasets/synthetic/noise.hpp"
#include "tests/calib/design/designed.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using datasets::DriveFamily;

/// Simulates the response independently, with finer time steps and a smaller tolerance than the
/// design.
Eigen::MatrixXd replayed(const datasets::Campaign& campaign, const Design& made) {
  std::vector<double> times;
  constexpr int kParts = 8;
  const double rate_hz = campaign.design->sample_rate_hz;
  for (std::size_t i = 0; i + 1 < made.time_s.size(); ++i)
    for (int k = 0; k < kParts; ++k) times.push_back(made.time_s[i] + k / (kParts * rate_hz));
  model::SimulationInputs inputs;
  inputs.drive = model::Signal::held(made.time_s, made.samples);
  model::SimulationOptions options;
  options.tolerance = 1e-9;
  const auto run = model::simulate(
      campaign.rig, datasets::values_in(campaign, {}), {}, inputs, times,
      std::vector{model::Output::position, model::Output::velocity, model::Output::acceleration,
                  model::Output::command, model::Output::servo_flow},
      options);
  REQUIRE(run.ok());
  return run.outputs;
}

}  // namespace

TEST_CASE("design: every family keeps every limit, and uses one of them", "[calib]") {
  Twin twin = designed_twin();
  for (const DriveFamily family : enumerators_like(DriveFamily{})) {
    CAPTURE(datasets::to_string(family));
    twin.campaign.design->family = family;
    const Design made = designed(twin.campaign, {"mass"});
    CHECK(made.family == family);
    REQUIRE(made.families.size() == 1);
    CHECK(made.families[0].evaluations == 24);
    const Eigen::MatrixXd run = replayed(twin.campaign, made);
    constexpr double kBetweenSamples = 1.01;  // the replay also evaluates times between the samples
    CHECK(run.col(0).minCoeff() > -0.012 * kBetweenSamples);
    CHECK(run.col(0).maxCoeff() < 0.015 * kBetweenSamples);
    CHECK(run.col(1).cwiseAbs().maxCoeff() < 0.15 * kBetweenSamples);
    CHECK(run.col(2).cwiseAbs().maxCoeff() < 12.0 * kBetweenSamples);
    CHECK(run.col(3).cwiseAbs().maxCoeff() < 5.0 * kBetweenSamples);
    CHECK(run.col(4).cwiseAbs().maxCoeff() < 1e-3 * kBetweenSamples);
    REQUIRE(made.limits.size() == 6);
    for (const LimitUse& use : made.limits) {
      CAPTURE(use.words);
      CHECK(use.share <= 1.0);
    }
    CHECK(made.samples.front() == 0.0);
    CHECK(std::abs(made.samples.back()) < 1e-9);
    CHECK(made.amplitude > 1e-3);
  }
}

TEST_CASE("design: a limit that is lower makes the drive smaller", "[calib]") {
  Twin twin = designed_twin();
  twin.campaign.design->family = DriveFamily::multisine;
  const double amplitude = designed(twin.campaign, {"mass"}).amplitude;
  struct Case {
    const char* key;
    std::optional<datasets::StatedLimit> datasets::DesignSettings::*limit;
    double value;
  };
  for (const Case& each :
       {Case{"speed", &datasets::DesignSettings::speed_m_per_s, 0.01},
        Case{"acceleration", &datasets::DesignSettings::acceleration_m_per_s2, 1.0},
        Case{"command", &datasets::DesignSettings::command_v, 0.2},
        Case{"flow", &datasets::DesignSettings::flow_m3_per_s, 1e-5}}) {
    CAPTURE(each.key);
    Twin lower = designed_twin();
    lower.campaign.design->family = DriveFamily::multisine;
    (*lower.campaign.design).*each.limit = datasets::StatedLimit{each.value, {}};
    const Design made = designed(lower.campaign, {"mass"});
    CHECK(made.amplitude < amplitude);
    for (const LimitUse& use : made.limits) CHECK(use.share <= 1.0);
  }
}

TEST_CASE("design: the same bits for any number of threads, others for another seed", "[calib]") {
  Twin twin = designed_twin();
  const Design one = designed(twin.campaign, {"mass", "valve_gain"}, 1);
  const Design three = designed(twin.campaign, {"valve_gain", "mass"}, 3);
  CHECK(one.family == three.family);
  CHECK(one.samples == three.samples);
  CHECK(one.response == three.response);
  for (std::size_t j = 0; j < one.parameters.size(); ++j) {
    CHECK(one.parameters[j].sd == three.parameters[j].sd);
    CHECK(one.parameters[j].sd_own_signals == three.parameters[j].sd_own_signals);
  }
  CHECK(one.families.size() == 4);
  twin.campaign.design->seed = 2;
  CHECK(designed(twin.campaign, {"mass", "valve_gain"}, 1).samples != one.samples);
}

TEST_CASE("design: it tells more than the campaign's own signals", "[calib]") {
  const Twin twin = designed_twin();
  const Design made = designed(twin.campaign, {"mass"});
  REQUIRE(made.own_signals == std::vector<std::string>{"square"});
  CHECK(made.own_signals_duration_s == Approx(2.0));
  CHECK(made.parameters[0].named);
  CHECK_FALSE(made.parameters[1].named);
  CHECK(made.parameters[0].sd.value() < 0.8 * made.parameters[0].sd_own_signals.value());
}

TEST_CASE("design: own signals count by their time, whatever their length and rate", "[calib]") {
  Twin twin = designed_twin();
  twin.campaign.design->family = DriveFamily::chirp;
  twin.campaign.design->evaluations = 6;
  const double sd = designed(twin.campaign, {"mass"}).parameters[0].sd_own_signals.value();
  datasets::Condition& own = twin.campaign.conditions.back();
  own.duration_s = 20.0;  // ten times as long; the 2 Hz square wave repeats itself
  const double longer = designed(twin.campaign, {"mass"}).parameters[0].sd_own_signals.value();
  CHECK(longer == Approx(sd).epsilon(0.06));
  own.sample_rate_hz = 1000.0;
  const double denser = designed(twin.campaign, {"mass"}).parameters[0].sd_own_signals.value();
  CHECK(denser == Approx(longer).epsilon(0.03));
  twin.campaign.design->repeats = 4;
  CHECK(designed(twin.campaign, {"mass"}).parameters[0].sd_own_signals.value() ==
        Approx(0.5 * denser).epsilon(1e-6));
}

TEST_CASE("design: the worst interval is smaller where that is what counts", "[calib]") {
  Twin twin = designed_twin();
  twin.campaign.design->evaluations = 60;
  twin.campaign.design->family = DriveFamily::multisine;
  const auto worst_of = [&](datasets::DesignCriterion criterion) {
    twin.campaign.design->criterion = criterion;
    double worst = 0.0;
    for (const DesignedParameter& each : designed(twin.campaign, {"mass", "valve_gain"}).parameters)
      worst = std::max(worst, each.sd.value() / each.value);
    return worst;
  };
  const double by_volume = worst_of(datasets::DesignCriterion::determinant);
  CHECK(worst_of(datasets::DesignCriterion::worst) <= 1.05 * by_volume);
}

TEST_CASE("design: a flag that is set before there is a drive is an error", "[calib]") {
  const Twin twin = designed_twin();
  const std::atomic<bool> cancel{true};
  try {
    design(twin.campaign, {}, {"mass"}, nullptr, {1, &cancel, {}});
    FAIL("expected an error");
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::stopped);
  }
}

TEST_CASE("design: real fits scatter as predicted", "[calib][long]") {
  Twin twin = designed_twin();
  twin.campaign.design->evaluations = 40;
  const Design made = designed(twin.campaign, {"mass", "valve_gain"});
  datasets::Campaign campaign = twin.campaign;
  campaign.conditions.clear();
  datasets::Condition condition;
  condition.id = "design";
  condition.waveform = datasets::Waveform::recorded;
  campaign.conditions.push_back(condition);
  datasets::ChannelSetting drive;
  drive.channel = datasets::Channel::reference;
  drive.role = datasets::ChannelRole::input;
  drive.recognise = false;
  campaign.channels[drive.channel] = drive;
  // The design's values are the true ones; each fit starts from different values.
  const auto truth = [&](std::size_t j) { return made.parameters[j].value; };
  for (auto& setting : campaign.parameters)
    if (setting.fit) setting.value *= 1.1;
  constexpr int kFits = 40;
  std::vector<double> squares(2, 0.0);
  for (int i = 0; i < kFits; ++i) {
    auto stream = datasets::random_stream(7, {"spread", std::to_string(i)});
    datasets::Record record;
    record.condition = "design";
    record.time_s = made.time_s;
    datasets::Series position;
    position.mean = datasets::white_noise(stream, made.time_s.size(), 5e-5);
    for (std::size_t k = 0; k < position.mean.size(); ++k)
      position.mean[k] += made.response(static_cast<Eigen::Index>(k), 0);
    position.sd_of_mean = 5e-5;
    record.channels[datasets::Channel::position] = position;
    record.channels[datasets::Channel::reference].mean = made.samples;
    FitOptions options;
    options.consider = false;
    const Fit result = fit(campaign, {record}, options);
    REQUIRE(result.status == FitStatus::converged);
    for (std::size_t j = 0; j < 2; ++j)
      squares[j] += std::pow(result.parameters[j].value - truth(j), 2);
  }
  for (std::size_t j = 0; j < 2; ++j) {
    CAPTURE(j);
    const double ratio = std::sqrt(squares[j] / kFits) / made.parameters[j].sd.value();
    // The root mean square of 40 values has a standard deviation of 11 %.
    CHECK(ratio > 0.7);
    CHECK(ratio < 1.35);
  }
}

TEST_CASE("design: what it refuses", "[calib]") {
  struct Case {
    const char* name;
    std::function<void(datasets::Campaign&)> change;
    std::vector<std::string> names;
    const char* message;
  };
  const auto no_change = [](datasets::Campaign&) {};
  const std::vector<Case> cases{
      {"unknown", no_change, {"mas"}, "did you mean 'mass'"},
      {"known", no_change, {"kp"}, "'rig.controller.kp': --design names it, but it is not fitted"},
      {"nobody", no_change, {}, "expected the names of fitted parameters"},
      {"no table", [](auto& c) { c.design.reset(); }, {"mass"}, "needs a table [design]"},
      {"noise",
       [](auto& c) { c.design->noise_sd.clear(); },
       {"mass"},
       "the noise of channel position"},
      {"stroke beside the rig",
       [](auto& c) { c.design->lowest_m.value = 0.01; },
       {"mass"},
       "key 'design.stroke': no drive can stay within this limit"},
      {"moves by itself",
       [](auto& c) {
         datasets::ParameterSetting force;
         force.index = Twin::index("external_force");
         force.value = 5000.0;
         c.parameters.push_back(force);
         c.design->acceleration_m_per_s2 = datasets::StatedLimit{0.01, {"twin.toml", 7, 1}};
       },
       {"mass"},
       "twin.toml:7:1: key 'design.acceleration': no drive can stay within this limit"},
      {"without a loop",
       [](auto& c) {
         c.rig.controller = model::ControllerKind::none;
         c.design->command_v.reset();
       },
       {"mass"},
       "nothing limits the drive"},
  };
  for (const Case& each : cases) {
    CAPTURE(each.name);
    Twin twin = designed_twin();
    each.change(twin.campaign);
    try {
      designed(twin.campaign, each.names);
      FAIL_CHECK("expected an error");
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::bad_input);
      CHECK_THAT(error.what(), Contains(each.message));
    }
  }
}

TEST_CASE("design: a parameter of each leak level needs to know the level", "[calib]") {
  Twin twin = designed_twin();
  twin.free("leakage_coefficient", 0.3, 0.0, 5.0, datasets::Scope::leak_level);
  twin.campaign.conditions.back().leak_level = "33 %";
  CHECK_THROWS_WITH(designed(twin.campaign, {"mass"}), Contains("expected like = "));
  twin.campaign.design->like = "square";
  twin.campaign.design->family = DriveFamily::prbs;
  twin.campaign.design->evaluations = 4;
  const Design made = designed(twin.campaign, {"mass"});
  const auto leak =
      std::find_if(made.parameters.begin(), made.parameters.end(),
                   [](const DesignedParameter& each) { return each.level == "33 %"; });
  REQUIRE(leak != made.parameters.end());
  CHECK(leak->sd_own_signals.has_value());
}

}  // namespace rigcal::calib
