#include <algorithm>
#include <catch2/catch.hpp>

#include "report/run/simulation_file.hpp"
#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("simulation: each condition, with its reference, all outputs", "[report][run]") {
  test::MadeRig rig;
  const datasets::Campaign campaign = load(rig.choice);
  std::vector<calib::SimulationTask> tasks;
  for (const datasets::Condition& condition : campaign.conditions)
    tasks.push_back(calib::simulation_task(campaign, condition));
  const auto simulations = calib::simulate(tasks, calib::simulation_options(campaign), 2);
  REQUIRE(simulations.size() == 3);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    REQUIRE(simulations[i].ok());
    const auto samples = static_cast<Eigen::Index>(tasks[i].time_s.size());
    CHECK(simulations[i].outputs.rows() == samples);
    CHECK(simulations[i].outputs.cols() == static_cast<Eigen::Index>(model::kAllOutputs.size()));
    CHECK(reference_of(tasks[i]).size() == tasks[i].time_s.size());
    const std::string text = simulation_file(tasks[i], simulations[i]);
    CHECK(std::count(text.begin(), text.end(), '\n') == samples + 1);
    tasks[i].rig.controller = model::ControllerKind::none;
    CHECK(reference_of(tasks[i]).empty());
  }
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
