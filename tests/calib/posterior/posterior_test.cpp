#include "calib/posterior/posterior.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "calib/fit.hpp"
#include "common/task_farm.hpp"
#include "datasets/synthetic/noise.hpp"
#include "metrics/distributions.hpp"
#include "tests/calib/twin.hpp"
#include "tests/support/sanitized.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;

Twin drawn_rig() {
  Twin twin;
  twin.free("mass", 60.0, 20.0, 180.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.09e-3);
  twin.add("square", datasets::Waveform::square, 4.0, 0.01);
  return twin;
}

FitOptions few_draws() {
  FitOptions options;
  options.consider = false;
  options.posterior = 300;
  return options;
}

/// Keeps every result, as the file of kept tasks does, and can be stopped after a number of tasks.
class KeepingFarm final : public TaskFarm {
 public:
  std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) override {
    names.push_back(job.name);
    std::vector<TaskResult> results(job.count);
    for (std::size_t i = job.count; i-- > 0;) {
      const auto kept = known.find({job.name, job.state, i});
      if (kept != known.end()) {
        results[i] = {kept->second, true};
      } else {
        results[i] = task(i);
        ++made;
        if (results[i].whole) known[{job.name, job.state, i}] = results[i].bytes;
        if (made == stop_after) *cancel = true;
      }
      if (done) done(i, results[i]);
    }
    return results;
  }

  std::map<std::tuple<std::string, std::string, std::size_t>, std::string> known;
  std::vector<std::string> names;
  int made = 0;
  int stop_after = -1;
  std::atomic<bool>* cancel = nullptr;
};

void check_same_draws(const Fit& a, const Fit& b) {
  REQUIRE(a.posterior);
  REQUIRE(b.posterior);
  CHECK(a.posterior->draws == b.posterior->draws);
  CHECK(a.posterior->values == b.posterior->values);
  CHECK(a.posterior->evaluations == b.posterior->evaluations);
  CHECK(a.posterior->message == b.posterior->message);
  for (std::size_t j = 0; j < a.posterior->limits.size(); ++j)
    CHECK(a.posterior->limits[j].probability == b.posterior->limits[j].probability);
}

}  // namespace

TEST_CASE("posterior: near the optimum it is what the errors say", "[calib][long]") {
  Twin twin = drawn_rig();
  twin.campaign.acceptance.push_back({datasets::Channel::position, "rho2", 0.9, std::nullopt});
  twin.campaign.acceptance.push_back(
      {datasets::Channel::position, "rho2", 0.9999999, std::nullopt});
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options = few_draws();
  options.posterior = 1000;
  const Fit found = fit(twin.campaign, records, options);
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.posterior);
  CHECK(found.posterior->draws == 1000);
  CHECK(found.posterior->chains == 4);
  CHECK(found.posterior->r_hat <= 1.01);
  CHECK(found.posterior->diverged == 0);
  CHECK(found.posterior->values.at(0).size() == 4000);
  CHECK(found.posterior->energy_fraction > 0.5);
  // Four chains are worth more than one only if each has random numbers of its own.
  const auto deviations = [&](int chain) {
    const Eigen::Map<const Eigen::VectorXd> all(found.posterior->values[0].data(), 4000);
    const Eigen::VectorXd own = all.segment(1000 * chain, 1000);
    return Eigen::VectorXd((own.array() - own.mean()).matrix().normalized());
  };
  for (const int other : {1, 2, 3}) CHECK(std::abs(deviations(0).dot(deviations(other))) < 0.2);
  CHECK_THAT(found.posterior->message,
             Contains("4 chains of 1000 draws") && Contains("R-hat") && Contains("no divergence"));
  for (const FittedParameter& each : found.parameters) {
    if (!each.fitted) continue;
    REQUIRE(each.posterior);
    CAPTURE(each.index);
    const double error = each.robust_standard_error.value();
    CHECK_THAT(each.posterior->sd, WithinRel(error, 0.1));
    CHECK_THAT(each.posterior->median, WithinAbs(each.value, 0.15 * error));
    CHECK_THAT(each.posterior->ci95->high - each.posterior->ci95->low,
               WithinRel(2.0 * metrics::kNormal95 * error, 0.1));
    CHECK(each.posterior->bulk_draws > 1000.0);
    CHECK(each.posterior->tail_draws > 800.0);
  }
  REQUIRE(found.posterior->limits.size() == 2);
  CHECK(found.posterior->simulated == 200);
  CHECK(found.posterior->limits[0].probability == 1.0);
  CHECK(found.posterior->limits[1].probability == 0.0);
  CHECK(found.posterior->limits[1].median > 0.99);
}

TEST_CASE("posterior: with effects it is what the budget says", "[calib]") {
  Twin twin = drawn_rig();
  twin.campaign.acceptance.push_back({datasets::Channel::position, "rho2", 0.9, std::nullopt});
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options = few_draws();
  options.consider = true;
  options.posterior = 1000;
  const Fit found = fit(twin.campaign, records, options);
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.posterior);
  CHECK(found.posterior->effects);
  CHECK(found.posterior->r_hat <= 1.01);
  CHECK(found.posterior->diverged == 0);
  CHECK_THAT(found.posterior->message, Contains("the sizes of the small effects"));
  for (const FittedParameter& each : found.parameters) {
    if (!each.fitted) continue;
    CAPTURE(each.index);
    REQUIRE(each.posterior);
    REQUIRE(each.budget);
    CHECK(each.budget->combined > 1.2 * each.robust_standard_error.value());
    CHECK_THAT(each.posterior->sd, WithinRel(each.budget->combined, 0.25));
    CHECK_THAT(each.posterior->median,
               WithinAbs(each.value + each.budget->shift, 0.5 * each.budget->combined));
  }
  REQUIRE(found.considered);
  int drawn = 0;
  for (const ConsideredEffect& each : found.considered->effects) {
    if (!each.estimate) continue;
    CAPTURE(each.key);
    REQUIRE(each.posterior);
    ++drawn;
    CHECK_THAT(each.posterior->sd, WithinRel(each.standard_error.value(), 0.25));
    if (each.one_sided) CHECK(each.posterior->ci95->low >= 0.0);
  }
  CHECK(drawn > 5);
  REQUIRE(found.posterior->limits.size() == 1);
  CHECK(found.posterior->limits[0].probability == 1.0);
}

TEST_CASE("posterior: an unknown at its bound stays within it", "[calib]") {
  Twin twin = drawn_rig();
  twin.free("leakage_coefficient", 0.2, 0.0, 2.0);
  datasets::ParameterSetting absent = known(Twin::index("leakage_coefficient"), 0.0);
  for (auto& each : twin.truth.parameters) {
    if (each.index == absent.index) each = absent;
  }
  const auto records = twin.records(250, 500.0, 3);
  const Fit found = fit(twin.campaign, records, few_draws());
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.posterior);
  const FittedParameter& leak = parameter(found, "leakage_coefficient");
  REQUIRE(leak.posterior);
  CHECK(leak.posterior->ci95->low >= 0.0);
  CHECK(leak.posterior->ci95->high < 2.0);
  CHECK(leak.posterior->ci95->high > leak.posterior->median);
  CHECK(found.posterior->r_hat < 1.05);
}

TEST_CASE("posterior: the same bits in any number of threads, in pieces, and elsewhere",
          "[calib]") {
  const Twin twin = drawn_rig();
  const auto records = twin.records(200, 500.0, 3);
  FitOptions options = few_draws();
  const Fit alone = fit(twin.campaign, records, options);
  REQUIRE(alone.posterior);
  REQUIRE(alone.posterior->draws == 300);
  options.threads = 3;
  check_same_draws(fit(twin.campaign, records, options), alone);

  std::atomic<bool> cancel = false;
  KeepingFarm farm;
  farm.cancel = &cancel;
  farm.stop_after = 6;  // during the first group of draws
  options.threads = 1;
  options.farm = &farm;
  options.cancel = &cancel;
  const Fit stopped = fit(twin.campaign, records, options);
  CHECK(stopped.status == FitStatus::stopped);
  CHECK(stopped.stopped_in == StoppedIn::posterior);
  REQUIRE(stopped.posterior);
  CHECK(stopped.posterior->draws == 0);
  CHECK_THAT(stopped.posterior->message, Contains("no draws: stopped on request"));
  CHECK_THAT(stopped.message, Contains("sampling of the posterior was stopped on request"));

  cancel = false;
  farm.stop_after = farm.made + 3;  // two complete the first group; one is in the next
  const Fit partly = fit(twin.campaign, records, options);
  CHECK(partly.status == FitStatus::stopped);
  REQUIRE(partly.posterior);
  CHECK(partly.posterior->draws == 250);
  CHECK_THAT(partly.posterior->message, Contains("300 were asked for: stopped on request"));
  CHECK(partly.parameters[0].posterior);

  cancel = false;
  farm.stop_after = -1;
  check_same_draws(fit(twin.campaign, records, options), alone);
  CHECK(farm.names.back() == "posterior draws 250 to 300");
}

TEST_CASE("posterior: a limit of evaluations ends it between stretches", "[calib]") {
  const Twin twin = drawn_rig();
  const auto records = twin.records(200, 500.0, 3);
  FitOptions options = few_draws();
  options.max_evaluations = 4000;  // not enough for the warm-up and one group of draws
  const Fit stopped = fit(twin.campaign, records, options);
  REQUIRE(stopped.posterior);
  CHECK(stopped.status == FitStatus::stopped);
  CHECK(stopped.posterior->draws < 300);
  options.threads = 4;
  check_same_draws(fit(twin.campaign, records, options), stopped);
}

TEST_CASE("posterior: the ranks of truths among their draws are uniform", "[calib][long]") {
  // Simulation-based calibration (Talts et al., arXiv:1804.06788): true values are drawn from the
  // prior, and records are simulated from them. bench/posterior_study.cpp does this 500 times.
  constexpr int kCampaigns = test::kSanitized ? 10 : 40;
  constexpr int kBins = 5;
  std::map<int, std::vector<int>> counts;
  for (int campaign = 0; campaign < kCampaigns; ++campaign) {
    Twin twin;
    twin.free("mass", 60.0, 20.0, 180.0);
    twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.09e-3);
    twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
    twin.campaign.simulation.tolerance = 1e-4;  // the noise is a tenth of the motion
    auto stream = datasets::random_stream(17, {"truth", std::to_string(campaign)});
    std::map<int, double> truths;
    for (auto& setting : twin.campaign.parameters) {
      if (!setting.fit) continue;
      const double truth = datasets::uniform(stream, setting.lower, setting.upper);
      truths[setting.index] = truth;
      for (auto& each : twin.truth.parameters) {
        if (each.index == setting.index) each.value = truth;
      }
    }
    twin.noise_sd_m = 1e-3;
    const auto records = twin.records(30, 100.0, 100U + static_cast<unsigned>(campaign));
    FitOptions options = few_draws();
    options.posterior = 100;
    options.threads = 2;
    options.seed = static_cast<std::uint64_t>(campaign);
    const Fit found = fit(twin.campaign, records, options);
    REQUIRE(found.status == FitStatus::converged);
    REQUIRE(found.posterior);
    for (std::size_t j = 0; j < found.posterior->names.size(); ++j) {
      const std::vector<double>& values = found.posterior->values[j];
      int below = 0;
      int count = 0;
      for (std::size_t k = 0; k < values.size(); k += 4, ++count)
        below += values[k] < truths.at(found.parameters[j].index) ? 1 : 0;
      std::vector<int>& of_unknown = counts[found.parameters[j].index];
      of_unknown.resize(kBins, 0);
      ++of_unknown[static_cast<std::size_t>(below * kBins / (count + 1))];
    }
  }
  REQUIRE(counts.size() == 2);
  for (const auto& [index, bins] : counts) {
    CAPTURE(index, bins);
    double chi_squared = 0.0;
    for (const int each : bins) {
      const double expected = static_cast<double>(kCampaigns) / kBins;
      chi_squared += (each - expected) * (each - expected) / expected;
    }
    CHECK(metrics::chi_squared_exceedance(chi_squared, kBins - 1.0) > 0.01);
  }
}

}  // namespace rigcal::calib
