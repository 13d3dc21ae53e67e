#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>

#include "report/job/job.hpp"
#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("simulation: each condition, with its reference, all outputs", "[report][run]") {
  test::MadeRig rig;
  const datasets::Campaign campaign = load(rig.choice);
  const std::atomic<bool> cancel{false};
  JobTerms terms{"", {}, 2, cancel, "out"};
  PlannedFiles planned;
  terms.hold = [&](PlannedFiles files) { planned = std::move(files); };
  const JobResult job = simulation_job(campaign, {}, terms);
  const std::vector<model::Simulation>& simulations = job.simulations->simulations;
  REQUIRE(simulations.size() == 3);
  REQUIRE(job.files.size() == 3);
  REQUIRE(planned.files.size() == 3);
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    calib::SimulationTask task = job.simulations->tasks[i];
    REQUIRE(simulations[i].ok());
    const auto samples = static_cast<Eigen::Index>(task.time_s.size());
    CHECK(simulations[i].outputs.rows() == samples);
    CHECK(simulations[i].outputs.cols() == static_cast<Eigen::Index>(model::kAllOutputs.size()));
    CHECK(reference_of(task).size() == task.time_s.size());
    CHECK(job.files[i].path == planned.files[i]);
    const std::string& text = job.files[i].content;
    CHECK(std::count(text.begin(), text.end(), '\n') == samples + 1);
    task.rig.controller = model::ControllerKind::none;
    CHECK(reference_of(task).empty());
  }
  CHECK(job.printed->json.size() == 3);
  CHECK(job.printed->problems.empty());
}

TEST_CASE("simulation: the chosen conditions alone, each once, without a folder no files",
          "[report][run]") {
  test::MadeRig rig;
  const datasets::Campaign campaign = load(rig.choice);
  const std::atomic<bool> cancel{false};
  JobTerms terms{"", {}, 1, cancel};
  terms.hold = [](const PlannedFiles&) {};
  const std::string second = campaign.conditions[1].id;
  const JobResult job = simulation_job(campaign, {{second, second}}, terms);
  REQUIRE(job.simulations->tasks.size() == 1);
  CHECK(job.simulations->tasks[0].condition->id == second);
  CHECK(job.files.empty());
  CHECK_THROWS_WITH(simulation_job(campaign, {{"none"}, "condition"}, terms),
                    Catch::StartsWith("condition: "));
}

TEST_CASE("simulation: what the campaign says of it counts", "[report][run]") {
  datasets::Campaign campaign;
  CHECK(calib::simulation_options(campaign).tolerance == model::SimulationOptions().tolerance);
  campaign.simulation = {model::Method::dopri5, 1e-4, 3.0};
  const model::SimulationOptions options = calib::simulation_options(campaign);
  CHECK(options.method == model::Method::dopri5);
  CHECK(options.tolerance == 1e-4);
  CHECK(options.max_seconds == 3.0);
}

}  // namespace
}  // namespace rigcal::report
