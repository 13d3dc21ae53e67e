#include "report/text/terminal.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using namespace rigcal::report;
using Catch::Contains;

namespace {

struct Scene {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;
  calib::Fit fit;
  Provenance provenance;

  Result result(ResultKind kind) const { return {kind, campaign, records, fit, provenance}; }

  void add_parameter(std::string_view key, const std::string& reason) {
    calib::FittedParameter parameter;
    parameter.index = model::parameter_index(campaign.rig.plant, key);
    parameter.value = 1.0;
    parameter.fitted = true;
    parameter.reason = reason;
    fit.parameters.push_back(parameter);
  }

  std::string scorecard_at(double rho2) {
    calib::ChannelScore channel;
    channel.agreement.emplace();
    channel.agreement->rho2 = rho2;
    calib::ConditionScore score;
    score.id = "sine";
    score.channels.push_back(channel);
    fit.conditions = {score};
    return scorecard_text(result(ResultKind::fit), {});
  }
};

}  // namespace

TEST_CASE("scorecard_text: agreement never looks perfect where it is not", "[report]") {
  Scene scene;
  CHECK_THAT(scene.scorecard_at(0.999812), Contains(" 0.9998 "));
  CHECK_THAT(scene.scorecard_at(0.9999), Contains(" 0.9999 "));
  CHECK_THAT(scene.scorecard_at(0.999999), Contains(" > 0.9999 "));
  CHECK_THAT(scene.scorecard_at(1.0 - 9.7e-8), Contains(" > 0.9999 "));
  CHECK_THAT(scene.scorecard_at(1.0 - 5.3e-14), Contains(" > 0.9999 "));
  CHECK_THAT(scene.scorecard_at(1.0), Contains(" 1.0000 "));
  CHECK_THAT(scene.scorecard_at(-0.5), Contains(" -0.5000 "));
}

TEST_CASE("summary_text: a tolerance that is far exceeded, without an exponent", "[report]") {
  Scene scene;
  calib::ConditionScore score;
  score.id = "sine";
  score.checks.push_back({.metric = "rho2", .value = 0.9, .used = 2.179});
  scene.fit.conditions = {score};
  CHECK_THAT(summary_text(scene.result(ResultKind::fit), {}, {}),
             Contains("sine: rho2 0.9000 of position, 220 % of the tolerance used"));
}

TEST_CASE("parameters_text: a reason that several share is told once", "[report]") {
  Scene scene;
  scene.add_parameter("mass", "shared");
  scene.add_parameter("damping", "shared");
  CHECK_THAT(parameters_text(scene.result(ResultKind::fit), {}), Contains("\n  all: shared\n"));
  scene.add_parameter("valve_gain", "its own");
  CHECK_THAT(parameters_text(scene.result(ResultKind::fit), {}),
             Contains("\n  mass (rig), damping (rig): shared\n  valve_gain (rig): its own\n"));
}

TEST_CASE("parameters_text: nothing estimated", "[report]") {
  const Scene scene;
  CHECK(parameters_text(scene.result(ResultKind::validation), {}) == "All parameters as given.\n");
  CHECK(parameters_text(scene.result(ResultKind::fit), {}) == "No parameter was estimated.\n");
}
