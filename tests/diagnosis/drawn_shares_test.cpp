#include "diagnosis/drawn_shares.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>

#include "calib/fit.hpp"
#include "diagnosis/record/steady_leak.hpp"
#include "tests/calib/twin.hpp"

using namespace rigcal;
using Catch::WithinAbs;

namespace {

/// A rig whose seal was recorded tight and worn, with a coefficient to be found for each.
calib::Twin two_seals() {
  calib::Twin twin;
  twin.free("leakage_coefficient", 0.3, 0.0, 3.0, datasets::Scope::leak_level);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.09e-3);
  twin.level_leakage = {{"tight", 0.005}, {"worn", 0.58}};
  twin.add("fast_worn", datasets::Waveform::sine, 8.0, 0.005, "worn");
  twin.add("slow_tight", datasets::Waveform::sine, 4.0, 0.01, "tight");
  twin.add("slow_worn", datasets::Waveform::sine, 4.0, 0.01, "worn");
  return twin;
}

double probability_of(const calib::DrawnShare& share, datasets::LeakClass wanted) {
  for (const auto& [name, probability] : share.class_probabilities)
    if (name == datasets::to_string(wanted)) return probability;
  return std::nan("");
}

bool same(const std::vector<calib::DrawnShare>& a, const std::vector<calib::DrawnShare>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.level == y.level && x.draws == y.draws && x.condition == y.condition &&
           x.leak_share_percent == y.leak_share_percent &&
           x.class_probabilities == y.class_probabilities;
  });
}

}  // namespace

TEST_CASE("drawn_shares: each leak level has the class of its share", "[diagnosis]") {
  calib::Twin twin = two_seals();
  const auto records = twin.records(250, 500.0, 3);
  calib::FitOptions options;
  options.consider = false;
  options.posterior = 100;
  int calls = 0;
  options.shares = [&](const calib::Problem& problem, const std::vector<std::vector<double>>& draws,
                       const calib::Budget& left) {
    ++calls;
    CHECK(draws.size() == 200);
    const auto found = diagnosis::drawn_shares(problem, draws, 1, left);
    REQUIRE(found.size() == 2);
    const std::vector<std::vector<double>> few(draws.begin(), draws.begin() + 40);
    const auto of_few = diagnosis::drawn_shares(problem, few, 1, left);
    REQUIRE(of_few.size() == 2);
    CHECK(same(diagnosis::drawn_shares(problem, few, 3, left), of_few));
    for (const calib::DrawnShare& each : found) {
      CAPTURE(each.level);
      // The slowest sine is the duty of both.
      CHECK(each.condition == "slow_tight");
      CHECK(each.draws == 200);
      double sum = 0.0;
      for (const auto& [name, probability] : each.class_probabilities) sum += probability;
      CHECK_THAT(sum, WithinAbs(1.0, 1e-12));
      model::ParameterValues truth = twin.true_values(twin.campaign.conditions[1]);
      truth.set("leakage_coefficient", twin.level_leakage.at(each.level));
      const double share = diagnosis::steady_leak(problem, problem.conditions[1], truth, {}).share;
      CAPTURE(share);
      CHECK(each.leak_share_ci95_percent->low <= 100.0 * share + 0.5);
      CHECK(each.leak_share_ci95_percent->high >= 100.0 * share - 0.5);
      CHECK_THAT(each.leak_share_percent, WithinAbs(100.0 * share, 0.5 + 5.0 * share));
      CHECK(probability_of(each, datasets::class_of(twin.campaign.diagnosis, share)) > 0.9);
    }
    CHECK(found[0].leak_share_percent != found[1].leak_share_percent);

    // A limit at the median divides the draws.
    const calib::DrawnShare& worn = of_few[of_few[0].level == "worn" ? 0 : 1];
    const auto limits = twin.campaign.diagnosis.limits;
    const double median = worn.leak_share_percent / 100.0;
    twin.campaign.diagnosis.limits = {median / 4.0, median / 2.0, median, 2.0 * median};
    for (const calib::DrawnShare& each : diagnosis::drawn_shares(problem, few, 1, left)) {
      if (each.level != "worn") continue;
      CHECK_THAT(probability_of(each, datasets::LeakClass::medium), WithinAbs(0.5, 0.01));
      CHECK_THAT(probability_of(each, datasets::LeakClass::critical), WithinAbs(0.5, 0.01));
    }
    twin.campaign.diagnosis.limits = limits;

    twin.campaign.diagnosis.duty = "fast_worn";
    CHECK(diagnosis::drawn_shares(problem, few, 1, left).at(0).condition == "fast_worn");
    twin.campaign.diagnosis.duty = "not fitted";
    CHECK(same(diagnosis::drawn_shares(problem, few, 1, left), of_few));

    const std::atomic<bool> stopped = true;
    CHECK(diagnosis::drawn_shares(problem, draws, 1, calib::Budget(&stopped)).empty());
    return found;
  };
  const calib::Fit fit = calib::fit(twin.campaign, records, options);
  REQUIRE(fit.status == calib::FitStatus::converged);
  CHECK(calls == 1);
  REQUIRE(fit.posterior);
  CHECK(fit.posterior->shares.size() == 2);
  CHECK(fit.posterior->simulated == 200);
}
