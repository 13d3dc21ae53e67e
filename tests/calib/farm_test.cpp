#include <catch2/catch.hpp>
#include <cmath>

#include "calib/fit.hpp"
#include "common/task_farm.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using datasets::Waveform;

/// Runs tasks as several processes might: in any order, and some tasks more than once.
class BackwardsFarm final : public TaskFarm {
 public:
  std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) override {
    names.push_back(job.name);
    std::vector<TaskResult> results(job.count);
    for (std::size_t i = job.count; i-- > 0;) {
      results[i] = task(i);
      if (i % 2 == 0) CHECK(task(i).bytes == results[i].bytes);
      if (done) done(i, results[i]);
    }
    return results;
  }
  int processes() const override { return 3; }

  std::vector<std::string> names;
};

Twin twin() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("square", Waveform::square, 2.0, 0.01);
  twin.add("sine", Waveform::sine, 1.0, 0.02);
  return twin;
}

void check_same(const Fit& found, const Fit& alone) {
  CHECK(found.message == alone.message);
  CHECK(found.cost == alone.cost);
  CHECK(found.evaluations == alone.evaluations);
  CHECK(found.best_start == alone.best_start);
  CHECK(found.failure_count == alone.failure_count);
  REQUIRE(found.failures.size() == alone.failures.size());
  for (std::size_t i = 0; i < found.failures.size(); ++i) {
    CHECK(found.failures[i].start == alone.failures[i].start);
    CHECK(found.failures[i].parameters == alone.failures[i].parameters);
    CHECK(found.failures[i].reason == alone.failures[i].reason);
  }
  REQUIRE(found.starts.size() == alone.starts.size());
  for (std::size_t i = 0; i < found.starts.size(); ++i) {
    CHECK(found.starts[i].end_values == alone.starts[i].end_values);
    // A start that could not be simulated has no cost.
    CHECK(std::isnan(found.starts[i].final_cost) == std::isnan(alone.starts[i].final_cost));
    if (!std::isnan(alone.starts[i].final_cost))
      CHECK(found.starts[i].final_cost == alone.starts[i].final_cost);
    CHECK(found.starts[i].iterations == alone.starts[i].iterations);
    CHECK(found.starts[i].message == alone.starts[i].message);
  }
  REQUIRE(found.parameters.size() == alone.parameters.size());
  for (std::size_t j = 0; j < found.parameters.size(); ++j) {
    const FittedParameter& a = found.parameters[j];
    const FittedParameter& b = alone.parameters[j];
    CHECK(a.value == b.value);
    REQUIRE(a.bootstrap.has_value() == b.bootstrap.has_value());
    if (a.bootstrap) CHECK(a.bootstrap->ci95 == b.bootstrap->ci95);
    REQUIRE(a.profile.has_value() == b.profile.has_value());
    if (a.profile) CHECK(a.profile->values == b.profile->values);
    if (a.profile) CHECK(a.profile->high.value == b.profile->high.value);
  }
  REQUIRE(found.cross_validation.has_value() == alone.cross_validation.has_value());
  if (!alone.cross_validation) return;
  REQUIRE(found.cross_validation->size() == alone.cross_validation->size());
  for (std::size_t i = 0; i < found.cross_validation->size(); ++i) {
    CHECK(found.cross_validation->at(i).rmse == alone.cross_validation->at(i).rmse);
    CHECK(found.cross_validation->at(i).largest_shift ==
          alone.cross_validation->at(i).largest_shift);
  }
}

}  // namespace

TEST_CASE("farm: the same bits as in one process, in whatever order", "[calib]") {
  const Twin small = twin();
  const auto records = small.records(250, 500.0, 3);
  FitOptions options;
  options.starts = 4;
  options.bootstrap = 30;
  options.profiles = true;
  options.cross_validate = true;
  const Fit alone = fit(small.campaign, records, options);
  REQUIRE(alone.status == FitStatus::converged);
  BackwardsFarm farm;
  options.farm = &farm;
  check_same(fit(small.campaign, records, options), alone);
  CHECK(farm.names == std::vector<std::string>{"starts", "bootstrap", "profiles", "folds"});
}

TEST_CASE("farm: failures are counted and named as in one process", "[calib]") {
  Twin hard = twin();
  // Except for the first start, the problem is too stiff for an explicit method.
  hard.free("bulk_modulus", 1e9, 1e8, 1e14);
  hard.campaign.simulation.method = model::Method::dopri5;
  const auto records = hard.records(250, 500.0, 3);
  FitOptions options;
  options.starts = 12;
  const Fit alone = fit(hard.campaign, records, options);
  REQUIRE(alone.failure_count > 3);
  BackwardsFarm farm;
  options.farm = &farm;
  check_same(fit(hard.campaign, records, options), alone);
}

TEST_CASE("farm: a limit of evaluations is counted over starts in their order", "[calib]") {
  const Twin small = twin();
  const auto records = small.records(250, 500.0, 3);
  FitOptions options;
  options.starts = 6;
  options.max_evaluations = 30;
  const Fit alone = fit(small.campaign, records, options);
  REQUIRE(alone.status == FitStatus::stopped);
  BackwardsFarm farm;
  options.farm = &farm;
  check_same(fit(small.campaign, records, options), alone);
}

}  // namespace rigcal::calib
