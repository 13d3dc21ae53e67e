#include "diagnosis/record/steady_leak.hpp"

#include <catch2/catch.hpp>

#include "tests/diagnosis/healthy_sine.hpp"

using namespace rigcal;
using Catch::WithinRel;

TEST_CASE("steady_leak: of the periodic state where nothing but a wave drives the rig",
          "[diagnosis]") {
  const test::HealthySine made = test::healthy_sine(0.3);
  const std::vector<datasets::Record> records{made.record};
  const datasets::Condition& condition = made.campaign.conditions.front();
  calib::Problem problem = calib::make_problem(made.campaign, records, {&condition}, true, nullptr);
  calib::ProblemCondition& prepared = problem.conditions.front();
  prepared.values.set("leakage_coefficient", 0.3);
  const auto periodic = diagnosis::steady_leak(problem, prepared, prepared.values, {});
  CHECK(periodic.is_periodic);
  // A recorded force of zero changes nothing, but it is an input that belongs to the record.
  prepared.inputs.external_load = model::Signal::held(
      records.front().time_s, std::vector<double>(records.front().time_s.size()));
  const auto recorded = diagnosis::steady_leak(problem, prepared, prepared.values, {});
  CHECK_FALSE(recorded.is_periodic);
  CHECK_THAT(recorded.share, WithinRel(periodic.share, 0.02));
}
