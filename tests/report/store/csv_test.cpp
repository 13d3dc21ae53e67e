#include "report/store/csv.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace rigcal;
using datasets::Channel;

namespace {

/// One condition with three samples. The last one is outside the window.
struct ThreeSamples {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;
  calib::Fit fit;
  report::Provenance provenance;

  ThreeSamples() {
    campaign.rig = {model::PlantKind::load_pressure, model::ControllerKind::pid,
                    model::InitialState::rest};
    datasets::Condition sine;
    sine.id = "sine";
    campaign.conditions = {sine};
    datasets::Record record;
    record.condition = "sine";
    datasets::Series& series = record.channels[Channel::position];
    series.repeats = 2;
    series.sd = {0.01, 0.02, 0.03};
    records = {record};
    calib::ConditionScore score;
    score.id = "sine";
    score.samples = 2;
    score.time_s = {0.0, 0.5, 1.0};
    score.series[Channel::position] = {{2.0, 2.5, 3.0}, {1.5, 2.75, 3.0}};
    score.in_window = {true, true, false};
    score.drive = {7.0, 8.0, 9.0};
    score.servo_flow_m3_per_s = {0.125, 0.25, 0.375};
    score.leakage_flow_m3_per_s = {0.0625, 0.03125, 0.0};
    fit.conditions = {score};
    fit.status = calib::FitStatus::converged;
    calib::FittedParameter mass;
    mass.value = 85.0;
    fit.parameters = {mass};
  }

  std::string residuals() const {
    return report::residuals_csv({report::ResultKind::fit, campaign, records, fit, provenance},
                                 fit.conditions[0]);
  }
  std::string scorecard() const {
    return report::scorecard_csv({report::ResultKind::fit, campaign, records, fit, provenance});
  }
};

const std::string kTitles =
    "time_s,measured_position_m,simulated_position_m,residual_position_m,sd_position_m,in_window,"
    "reference_m,servo_flow_m3_per_s,leakage_flow_m3_per_s\n";

}  // namespace

TEST_CASE("residuals_csv: measured minus simulated, and what goes with it", "[report]") {
  const ThreeSamples result;
  CHECK(result.residuals() == kTitles +
                                  "0,2,1.5,0.5,0.01,1,7,0.125,0.0625\n"
                                  "0.5,2.5,2.75,-0.25,0.02,1,8,0.25,0.03125\n"
                                  "1,3,3,0,0.03,0,9,0.375,0\n");
}

TEST_CASE("residuals_csv: a single repeat has no scatter, a record without windows counts",
          "[report]") {
  ThreeSamples result;
  result.records[0].channels[Channel::position].repeats = 1;
  result.fit.conditions[0].in_window.clear();
  CHECK(result.residuals() == kTitles +
                                  "0,2,1.5,0.5,,1,7,0.125,0.0625\n"
                                  "0.5,2.5,2.75,-0.25,,1,8,0.25,0.03125\n"
                                  "1,3,3,0,,1,9,0.375,0\n");
}

TEST_CASE("residuals_csv: the prediction's standard deviation where it is known", "[report]") {
  ThreeSamples result;
  result.fit.conditions[0].prediction_sd[Channel::position] = {0.25, 0.5, 0.75};
  CHECK(result.residuals() ==
        "time_s,measured_position_m,simulated_position_m,residual_position_m,sd_position_m,"
        "prediction_sd_position_m,in_window,reference_m,servo_flow_m3_per_s,leakage_flow_m3_per_s\n"
        "0,2,1.5,0.5,0.01,0.25,1,7,0.125,0.0625\n"
        "0.5,2.5,2.75,-0.25,0.02,0.5,1,8,0.25,0.03125\n"
        "1,3,3,0,0.03,0.75,0,9,0.375,0\n");
}

TEST_CASE("residuals_csv: a fit that did not converge says so first", "[report]") {
  ThreeSamples result;
  result.fit.status = calib::FitStatus::stopped;
  result.fit.message = "stopped on request";
  CHECK(result.residuals().rfind("# status: stopped: stopped on request\ntime_s,", 0) == 0);
  CHECK(result.scorecard().rfind("# status: stopped: stopped on request\ncondition,", 0) == 0);
}

TEST_CASE("residual_table: what is read back of the text, to the last bit", "[report]") {
  ThreeSamples result;
  calib::ConditionScore& score = result.fit.conditions[0];
  score.time_s = {0.1, 0.2, 0.1 + 0.2};
  score.series[Channel::position] = {{1.0 / 3.0, -0.0, 1e-310},
                                     {2e300, 1e17}};  // one value is missing
  score.drive = {std::numeric_limits<double>::infinity(), -1e-5, 123456789012345680.0};
  const report::Table made = report::residual_table(
      {report::ResultKind::fit, result.campaign, result.records, result.fit, result.provenance},
      score);
  const report::Table read = report::parse_table(result.residuals(), "residuals.csv");
  REQUIRE(made.names == read.names);
  REQUIRE(made.columns.size() == read.columns.size());
  for (std::size_t k = 0; k < made.columns.size(); ++k) {
    CAPTURE(made.names[k]);
    REQUIRE(made.columns[k].size() == read.columns[k].size());
    for (std::size_t i = 0; i < made.columns[k].size(); ++i) {
      const double a = made.columns[k][i];
      const double b = read.columns[k][i];
      CHECK(((std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b))));
    }
  }
}

TEST_CASE("scorecard_csv: gain, phase and delay in columns of their own", "[report]") {
  ThreeSamples result;
  calib::ChannelScore channel;
  channel.metrics.gain_ratio = 0.5;
  channel.metrics.phase_deg = -30.0;
  channel.metrics.delay_s = 0.25;
  result.fit.conditions[0].channels = {channel};
  const std::string text = result.scorecard();
  CHECK(text.find("gain_ratio,phase_deg,delay_s,problem,rho2_expanded_uncertainty,") !=
        std::string::npos);
  CHECK(text.ends_with(",0.5,-30,0.25,,,,,,,,\n"));
}

TEST_CASE("scorecard_csv: each score has its uncertainty at the end", "[report]") {
  ThreeSamples result;
  calib::ChannelScore channel;
  channel.expanded_uncertainty.emplace();
  channel.expanded_uncertainty->rho2 = 0.25;
  channel.expanded_uncertainty->maximum_error = 0.5;
  result.fit.conditions[0].channels = {channel};
  CHECK(result.scorecard().ends_with(",0.25,0,0,0,0,0,0.5\n"));
}
