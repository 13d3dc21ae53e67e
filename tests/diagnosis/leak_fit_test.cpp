#include "diagnosis/leak_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"

using namespace rigcal;
using Catch::WithinRel;

namespace {

/// One healthy record of a short 1 Hz sine.
struct HealthySine {
  datasets::Campaign campaign;
  datasets::Record record;
};

HealthySine healthy_sine() {
  HealthySine made;
  made.campaign =
      datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/rigs/uis_shake_table/diagnosis.toml");
  std::erase_if(made.campaign.conditions,
                [](const auto& each) { return each.id != "sine_1Hz_open_0"; });
  made.campaign.conditions.front().duration_s = 2.0;
  made.campaign.conditions.front().sample_rate_hz = 250.0;
  const datasets::Campaign truth = datasets::true_campaign(made.campaign);
  std::vector<datasets::Repeat> repeats;
  for (auto& each : datasets::synthetic_repeats(truth, truth.conditions.front(), nullptr, 1))
    repeats.push_back(std::move(each.record));
  made.record =
      datasets::repeat_records(made.campaign, made.campaign.conditions.front(), repeats).average;
  return made;
}

/// The true rig, its valve gain known within 1 %.
diagnosis::RigFit rig_of(const datasets::Campaign& campaign) {
  diagnosis::RigFit rig;
  for (const auto& [index, value] : campaign.synthetic_settings->parameters)
    rig.values.push_back({index, datasets::Scope::rig, "", value});
  rig.indices = {model::parameter_index(campaign.rig.plant, "valve_gain")};
  rig.covariance = Eigen::MatrixXd::Constant(1, 1, 4.06e-7 * 4.06e-7);
  return rig;
}

calib::FittedParameter fitted(int index, double error, std::optional<double> robust) {
  calib::FittedParameter p;
  p.index = index;
  p.fitted = true;
  p.value = 1.0;
  p.standard_error = error;
  p.robust_standard_error = robust;
  return p;
}

}  // namespace

TEST_CASE("fit_leak: a healthy reference takes the rig's error off a healthy record",
          "[diagnosis]") {
  const HealthySine made = healthy_sine();
  const diagnosis::RigFit rig = rig_of(made.campaign);
  const diagnosis::LeakProblem problem(made.campaign, rig);
  const auto error = [&](int reference) {
    const auto fit =
        diagnosis::fit_leak(problem.up_to(1.0), rig, problem.campaign.conditions.front(),
                            made.record, std::nullopt, reference, nullptr, nullptr);
    REQUIRE(fit.ok());
    return fit.rig_se;
  };
  // Where nothing leaks a wrong rig makes the same error with and without the leak; alone, 1 % of
  // the valve gain passes for a leak.
  CHECK(error(0) > 1e-3);
  CHECK(error(5) < 0.2 * error(0));
}

TEST_CASE("fit_leak: a supply that differs between repeats is part of the error", "[diagnosis]") {
  HealthySine made = healthy_sine();
  datasets::Campaign& campaign = made.campaign;
  const int supply = model::parameter_index(campaign.rig.plant, "supply_pressure");
  const int leak = model::parameter_index(campaign.rig.plant, "leakage_coefficient");
  constexpr double kTrue = 0.3;
  constexpr int kRepeats = 40;
  campaign.conditions.front().overrides = {{leak, kTrue}};
  campaign.synthetic_settings->repeats = kRepeats;
  campaign.synthetic_settings->variation[supply] = 0.02;
  const datasets::Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::Repeat> repeats;
  for (auto& each : datasets::synthetic_repeats(truth, truth.conditions.front(), nullptr, 5))
    repeats.push_back(std::move(each.record));
  const auto records = datasets::repeat_records(campaign, campaign.conditions.front(), repeats);

  /// Root mean square of (estimate - truth) / standard error.
  const auto rms_score = [&](int reference) {
    const diagnosis::RigFit rig = rig_of(campaign);
    const diagnosis::LeakProblem problem =
        diagnosis::LeakProblem(campaign, rig).up_to(1.0).corrected_by(reference, 1);
    double squares = 0.0;
    for (const datasets::Record& record : records.singles) {
      const auto fit = diagnosis::fit_leak(problem, rig, problem.campaign.conditions.front(),
                                           record, std::nullopt, 0, nullptr, nullptr);
      REQUIRE(fit.ok());
      const double score = (fit.coefficient - kTrue) / fit.white_se;
      squares += score * score;
    }
    return std::sqrt(squares / kRepeats);
  };
  CHECK(rms_score(0) > 3.0);
  for (auto& setting : campaign.parameters) {
    if (setting.index != supply) continue;
    setting.lower = setting.upper = std::numeric_limits<double>::quiet_NaN();
    datasets::differ_between_repeats(datasets::spec_of(campaign.rig.plant, supply),
                                     0.02 * setting.value, setting);
  }
  // Of 40 independent scores the 0.1 and 99.9 % quantiles of the rms are 0.68 and 1.35.
  const double score = rms_score(0);
  CHECK(score > 0.68);
  CHECK(score < 1.35);
  // A reference of one repeat differs by as much again; the record tells a part of its own supply.
  CHECK(rms_score(1) < score);
}

TEST_CASE("rig_fit_of: the larger error of each value, and their correlation", "[diagnosis]") {
  calib::Fit fit;
  fit.parameters = {fitted(1, 2.0, 3.0), fitted(4, 5.0, 4.0), fitted(2, 7.0, std::nullopt)};
  fit.parameters.push_back(fitted(3, 1.0, 9.0));
  fit.parameters.back().nuisance = true;  // of a condition's own: not the rig's
  fit.correlation = Eigen::MatrixXd::Identity(4, 4);
  fit.correlation(0, 1) = fit.correlation(1, 0) = 0.5;
  const diagnosis::RigFit rig = diagnosis::rig_fit_of(fit);
  CHECK(rig.values.size() == 3);
  CHECK(rig.indices == std::vector<int>{1, 4, 2});
  REQUIRE(rig.covariance.rows() == 3);
  CHECK_THAT(rig.covariance(0, 0), WithinRel(9.0, 1e-12));
  CHECK_THAT(rig.covariance(1, 1), WithinRel(25.0, 1e-12));
  CHECK_THAT(rig.covariance(2, 2), WithinRel(49.0, 1e-12));
  CHECK_THAT(rig.covariance(0, 1), WithinRel(0.5 * 3.0 * 5.0, 1e-12));
}
