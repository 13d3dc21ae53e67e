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
  auto& check = score.checks.emplace_back();
  check.metric = "rho2";
  check.value = 0.9;
  check.used = 2.179;
  scene.fit.conditions = {score};
  CHECK_THAT(summary_text(scene.result(ResultKind::fit), {}, {}),
             Contains("sine: rho2 0.9000 of position, 220 % of the tolerance used"));
}

TEST_CASE("scorecard_text: each condition shows its worst channel, by name", "[report]") {
  Scene scene;
  const auto score = [](datasets::Channel channel, double rho2) {
    calib::ChannelScore each;
    each.channel = channel;
    each.agreement.emplace();
    each.agreement->rho2 = rho2;
    return each;
  };
  calib::ConditionScore sine;
  sine.id = "sine";
  sine.channels = {score(datasets::Channel::position, 0.9996),
                   score(datasets::Channel::pressure_a, 0.984),
                   score(datasets::Channel::pressure_b, 0.99)};
  scene.fit.conditions = {sine};
  const auto text = [&] { return scorecard_text(scene.result(ResultKind::fit), {}); };
  CHECK_THAT(text(), Contains("pressure_a") && Contains(" 0.9840 ") && !Contains("0.9996"));
  // A failed channel comes before one that is not judged.
  auto& check = scene.fit.conditions[0].checks.emplace_back();
  check.channel = datasets::Channel::pressure_b;
  check.metric = "rho2";
  check.value = 0.99;
  check.verdict = calib::Verdict::fail;
  scene.fit.conditions[0].verdict = calib::Verdict::fail;
  CHECK_THAT(text(), Contains("pressure_b") && Contains(" 0.9900 ") && !Contains("0.9840"));
}

TEST_CASE("result_text: what was stopped says so first and grades nothing", "[report]") {
  Scene scene;
  scene.add_parameter("mass", "");
  scene.fit.parameters[0].standard_error = 0.1;
  scene.fit.parameters[0].ci95 = {0.8, 1.2};
  scene.fit.parameters[0].upper = 500.0;
  scene.fit.verdict = calib::Verdict::warn;
  scene.fit.status = calib::FitStatus::stopped;
  scene.fit.stopped_in = calib::StoppedIn::starts;
  scene.fit.message = "stopped by the time limit";
  const auto text = [&] { return result_text(scene.result(ResultKind::fit), {}, {}); };
  CHECK_THAT(text(), Catch::StartsWith("STOPPED: stopped by the time limit. Ended before"));
  CHECK_THAT(text(), !Contains("identified") && !Contains("WARN") && !Contains("0.80 .. 1.20"));
  // After the search the estimates and the verdict are shown, with the missing parts.
  scene.fit.stopped_in = calib::StoppedIn::bootstrap;
  CHECK_THAT(text(), Catch::StartsWith("STOPPED: ") && Contains("verdict: WARN") &&
                         Contains("not all that was asked for") && Contains("identified") &&
                         Contains("0.80 .. 1.20"));
  scene.fit.status = calib::FitStatus::converged;
  CHECK_THAT(text(), Catch::StartsWith("verdict: WARN"));
  scene.fit.status = calib::FitStatus::failed;
  CHECK_THAT(text(), Catch::StartsWith("FAILED: ") && !Contains("WARN"));
}

TEST_CASE("result_text: the reason of a parameter is told once", "[report]") {
  Scene scene;
  scene.add_parameter("mass", "half width is 40 % of the value");
  scene.fit.parameters[0].identifiability = calib::Identifiability::weak;
  scene.fit.status = calib::FitStatus::converged;
  scene.fit.warnings = {"mass_kg: half width is 40 % of the value", "mass_kg: something else"};
  scene.fit.assessment.parameters.reasons = {calib::reason(
      calib::AspectState::reservation, "weak", "mass_kg: half width is 40 % of the value")};
  const std::string text = result_text(scene.result(ResultKind::fit), {}, {});
  const std::size_t first = text.find("half width is 40 %");
  REQUIRE(first != std::string::npos);
  CHECK(text.find("half width is 40 %", first + 1) == std::string::npos);
  CHECK_THAT(text, Contains("- mass_kg: weak\n") && Contains("warning: mass_kg: something else"));
}

TEST_CASE("parameters_text: no estimate is rounded to zero or out of its bounds", "[report]") {
  Scene scene;
  scene.add_parameter("mass", "");
  calib::FittedParameter& mass = scene.fit.parameters[0];
  scene.fit.status = calib::FitStatus::converged;
  mass.value = 10.04;
  mass.lower = 10.0;
  mass.upper = 500.0;
  mass.standard_error = 400.0;
  mass.ci95 = {0.0, 810.0};
  CHECK_THAT(parameters_text(scene.result(ResultKind::fit), {}),
             Contains(" 10 ") && Contains("0 .. 810") && Contains("10 .. 500"));
}

TEST_CASE("parameters_text: both intervals, and what widens one most", "[report]") {
  Scene scene;
  scene.add_parameter("mass", "");
  calib::FittedParameter& mass = scene.fit.parameters[0];
  scene.fit.status = calib::FitStatus::converged;
  mass.value = 110.0;
  mass.lower = 10.0;
  mass.upper = 500.0;
  mass.standard_error = 0.25;
  mass.ci95 = {98.0, 120.0};
  mass.ci95_if_exact = {109.5, 110.5};
  CHECK_THAT(parameters_text(scene.result(ResultKind::fit), {}),
             !Contains("if model exact") && !Contains("widened by"));
  scene.fit.considered.emplace();
  calib::Budget95& budget = mass.budget.emplace();
  budget.lines = {{"noise", "records", 0.25},
                  {"coulomb_friction", "effect", 3.0},
                  {"valve_time_constant", "effect", 4.0}};
  budget.combined = 5.00625;
  CHECK_THAT(parameters_text(scene.result(ResultKind::fit), {}),
             Contains("if model exact") && Contains(" +- 0.5  valve_time_constant ") &&
                 Contains(" 5 ") && Contains("valve_time_constant") &&
                 !Contains("coulomb_friction"));
  // Where the records are the largest part no effect is named.
  budget.lines[0].uncertainty = 8.0;
  CHECK_THAT(parameters_text(scene.result(ResultKind::fit), {}),
             Contains("if model exact") && !Contains("valve_time_constant"));
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
