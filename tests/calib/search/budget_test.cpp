#include "calib/search/budget.hpp"

#include <catch2/catch.hpp>

#include "calib/fit.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;

/// A fit with a validation that has its own nuisance parameter.
struct Job {
  Twin twin;
  std::vector<datasets::Record> records;

  Job() {
    twin.add("fitted", datasets::Waveform::square, 2.0, 0.01);
    twin.add("again", datasets::Waveform::sine, 3.0, 0.01);
    twin.add("other", datasets::Waveform::square, 3.0, 0.008, {}, datasets::Use::validate);
    twin.free("mass", 70.0, 10.0, 500.0);
    twin.free("valve_gain", 3.5e-5, 1e-6, 1e-3);
    auto& offset = twin.free("position_offset", 0.0, -5e-3, 5e-3, datasets::Scope::condition);
    offset.nuisance = true;
    twin.campaign.acceptance = {{datasets::Channel::position, "rho2", 0.9, std::nullopt}};
    records = twin.records(250, 500.0, 3);
  }
  Fit run(const FitOptions& options) const { return fit(twin.campaign, records, options); }
};

const ConditionScore& score(const Fit& fit, const std::string& id) {
  for (const ConditionScore& each : fit.conditions) {
    if (each.id == id) return each;
  }
  throw std::runtime_error("no condition " + id);
}

}  // namespace

TEST_CASE("budget: spent by a request, by time, by evaluations", "[calib]") {
  const auto now = Budget::Clock::now();
  std::atomic<bool> cancel = false;
  Budget free(&cancel, now, {}, {});
  CHECK_FALSE(free.spent());
  CHECK(free.reason().empty());
  CHECK_FALSE(free.evaluations_left().has_value());
  cancel = true;
  CHECK(free.spent());
  CHECK(free.reason() == "stopped on request");
  Budget timed(nullptr, now - std::chrono::seconds(2), 1.0, {});
  CHECK(timed.out_of_time());
  CHECK(timed.reason() == "stopped by the time limit");
  CHECK_FALSE(Budget(nullptr, now, 1000.0, {}).spent());
  Budget counted(nullptr, now, {}, 10);
  counted.count(9);
  CHECK(counted.evaluations_left() == 1);
  CHECK_FALSE(counted.spent());
  counted.count(5);
  CHECK(counted.evaluations_left() == 0);
  CHECK(counted.reason() == "stopped by the limit of evaluations");
}

TEST_CASE("budget: a limit that no clock can count is none", "[calib]") {
  for (const double seconds : {1e9, 1e10, 1e300})
    CHECK_FALSE(Budget(nullptr, Budget::Clock::now(), seconds, {}).deadline().has_value());
}

TEST_CASE("budget: a stop beside the fit keeps the fit, its scores, and what was made", "[calib]") {
  const Job job;
  const Fit whole = job.run({});
  REQUIRE(whole.status == FitStatus::converged);
  FitOptions options;
  options.bootstrap = 500;
  options.profiles = true;
  options.cross_validate = true;
  options.max_evaluations = whole.evaluations + 60;
  const Fit stopped = job.run(options);
  CHECK(stopped.status == FitStatus::stopped);
  CHECK(stopped.stopped_in == StoppedIn::bootstrap);
  CHECK(stopped.has_converged());
  CHECK_THAT(stopped.message, Contains("the bootstrap was stopped by the limit of evaluations"));
  REQUIRE(stopped.bootstrap);
  CHECK(stopped.bootstrap->replicates > 0);
  CHECK(stopped.bootstrap->replicates < 500);
  CHECK_THAT(stopped.bootstrap->message, Contains("500 were asked for"));
  CHECK(stopped.verdict == whole.verdict);
  CHECK(score(stopped, "other").channels.at(0).metrics.rho2 ==
        score(whole, "other").channels.at(0).metrics.rho2);
  for (std::size_t j = 0; j < whole.parameters.size(); ++j) {
    CHECK(stopped.parameters[j].value == whole.parameters[j].value);
    if (!stopped.parameters[j].profile) continue;  // a nuisance parameter, or a known value
    CHECK(stopped.parameters[j].profile->low.is_lost());
    CHECK_THAT(stopped.parameters[j].reason, Contains("stopped by the limit of evaluations"));
  }
  for (const HeldOut& held : stopped.cross_validation.value())
    CHECK_THAT(held.problem.value(), Contains("stopped by the limit of evaluations"));
  options.threads = 3;
  const Fit again = job.run(options);
  CHECK(again.bootstrap.value().replicates == stopped.bootstrap->replicates);
  for (std::size_t j = 0; j < stopped.parameters.size(); ++j) {
    REQUIRE(again.parameters[j].bootstrap.has_value() ==
            stopped.parameters[j].bootstrap.has_value());
    if (!stopped.parameters[j].bootstrap) continue;
    CHECK(again.parameters[j].bootstrap->standard_error ==
          stopped.parameters[j].bootstrap->standard_error);
  }
}

TEST_CASE("budget: a condition whose nuisance parameters were not estimated is not scored",
          "[calib]") {
  const Job job;
  FitOptions options;
  options.max_evaluations = 3;
  const Fit stopped = job.run(options);
  CHECK(stopped.status == FitStatus::stopped);
  CHECK(stopped.stopped_in == StoppedIn::starts);
  CHECK_FALSE(stopped.has_converged());
  const ConditionScore& other = score(stopped, "other");
  CHECK_FALSE(other.verdict.has_value());
  CHECK_THAT(other.not_scored.value(), Contains("stopped"));
  CHECK(other.channels.empty());
  CHECK(stopped.assessment.validation.state == AspectState::reservation);
}

TEST_CASE("budget: what is made beside a fit tells how far it is", "[calib]") {
  const Job job;
  FitOptions options;
  options.bootstrap = 20;
  std::vector<std::pair<std::string, int>> told;
  options.beside = [&](const char* pieces, int done, int all) {
    told.emplace_back(pieces, done);
    CHECK(all == 20);
  };
  job.run(options);
  REQUIRE(told.size() == 20);
  CHECK(told.back() == std::pair<std::string, int>{"replicates of the bootstrap", 20});
}

}  // namespace rigcal::calib
