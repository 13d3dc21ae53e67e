#include <algorithm>
#include <catch2/catch.hpp>

#include "report/document/render_terminal.hpp"
#include "report/run/write_result.hpp"

// For a fit, the terminal shows the same document as the page.

namespace rigcal::report {
namespace {

using Catch::Contains;
using Catch::StartsWith;

struct Scene {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;
  calib::Fit fit;
  Provenance provenance;

  Scene() { fit.status = calib::FitStatus::converged; }

  calib::FittedParameter& add_mass(double value, const Range& ci95) {
    const model::PlantKind plant = campaign.rig.plant;
    calib::FittedParameter& mass = fit.parameters.emplace_back(calib::parameter_in_row(
        plant, model::parameter_index(plant, "mass"), datasets::Scope::rig, {}));
    mass.value = value;
    mass.lower = 10.0;
    mass.upper = 500.0;
    mass.standard_error = 0.25;
    mass.ci95 = ci95;
    mass.ci95_from = std::optional(calib::IntervalSource::standard_error);
    mass.identifiability = calib::Identifiability::identified;
    mass.fitted = true;
    return mass;
  }

  std::string shown(const Style& style = {}) const {
    return doc::render_terminal(document_of({ResultKind::fit, campaign, records, fit, provenance}),
                                style);
  }
};

const Style kEverything{false, 0, 0, true};

TEST_CASE("fit on a terminal: what was stopped says so first and grades nothing", "[report][run]") {
  Scene scene;
  scene.add_mass(1.0, {0.8, 1.2}).lower = 0.1;
  scene.fit.verdict = calib::Verdict::warn;
  scene.fit.status = calib::FitStatus::stopped;
  scene.fit.stopped_in = calib::StoppedIn::starts;
  scene.fit.message = "stopped by the time limit";
  CHECK_THAT(scene.shown(), StartsWith("STOPPED: Ended before") &&
                                Contains("- stopped by the time limit") &&
                                !Contains("identified") && !Contains("WARN"));
  // After the search the estimates are shown, and the missing steps are named.
  scene.fit.stopped_in = calib::StoppedIn::bootstrap;
  CHECK_THAT(scene.shown(), StartsWith("STOPPED: ") &&
                                Contains("further work that was requested") &&
                                Contains("identified") && Contains("± 0.20"));
  scene.fit.status = calib::FitStatus::converged;
  CHECK_THAT(scene.shown(), StartsWith("WARN: "));
  scene.fit.status = calib::FitStatus::failed;
  CHECK_THAT(scene.shown(), StartsWith("FAILED: ") && !Contains("WARN"));
}

TEST_CASE("fit on a terminal: no estimate is rounded to zero or out of its bounds",
          "[report][run]") {
  Scene scene;
  scene.add_mass(10.04, {0.0, 810.0});
  CHECK_THAT(scene.shown(kEverything),
             Contains(" 10 ") && Contains("0 … 810") && Contains("10 … 500"));
}

TEST_CASE("fit on a terminal: both intervals, and what widens one", "[report][run]") {
  Scene scene;
  calib::FittedParameter& mass = scene.add_mass(110.0, {98.0, 122.0});
  mass.ci95_if_exact = {109.5, 110.5};
  CHECK_THAT(scene.shown(), Contains("± 12") && !Contains("model is exact"));
  calib::Budget95& budget = mass.budget.emplace();
  budget.lines = {{"noise", "records", 0.25}, {"valve_time_constant", "effect", 4.0}};
  budget.combined = 4.0078;
  CHECK_THAT(scene.shown(), Contains("U if the model is exact") && Contains("± 0.50"));
  CHECK_THAT(scene.shown(kEverything), Contains("valve time constant"));
}

TEST_CASE("fit on a terminal: at most 60 lines, however many conditions and warnings",
          "[report][run]") {
  Scene scene;
  scene.add_mass(110.0, {98.0, 122.0});
  for (int i = 0; i < 500; ++i) {
    calib::ConditionScore& score = scene.fit.conditions.emplace_back();
    score.id = "condition_" + std::to_string(i);
    score.verdict = calib::Verdict::pass;
    score.channels.emplace_back().metrics.rho2 = 0.999;
    calib::LimitCheck& check = score.limit_checks.emplace_back();
    check.metric = "rho2";
    check.value = 0.999;
    check.limit = 0.9;
    check.tolerance_used = 0.01;
    check.verdict = calib::Verdict::pass;
    scene.fit.warnings.push_back("warning " + std::to_string(i));
  }
  const auto lines = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  const Style terminal{false, 100, kTerminalLines};
  CHECK(lines(scene.shown(terminal)) <= 60);
  CHECK_THAT(scene.shown(terminal), Contains("more (-v for all)"));
  const std::string all = scene.shown(kEverything);
  CHECK_THAT(all, Contains("condition_499") && Contains("warning: warning 499"));
}

}  // namespace
}  // namespace rigcal::report
