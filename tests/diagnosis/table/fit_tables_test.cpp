#include "diagnosis/table/fit_tables.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "diagnosis/table/table_residuals.hpp"
#include "tests/diagnosis/leak_rig.hpp"

using namespace rigcal;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// The last column in Table 3, a 10 Hz sine, and three rows of Table 4.
test::LeakRig small_rig() {
  test::LeakRig rig;
  rig.settings.signals.erase(rig.settings.signals.begin(), rig.settings.signals.begin() + 5);
  rig.settings.features.resize(3);  // Normal, Slight, Medium
  return rig;
}

/// Options that are coarse enough to be quick.
diagnosis::LeakTableOptions quick() {
  diagnosis::LeakTableOptions options;
  options.periodic.simulation.tolerance = 1e-4;
  options.periodic.tolerance = 1e-3;
  options.series_samples = 400;
  return options;
}

std::vector<int> free_of(const datasets::LeakTableSettings& settings) {
  std::vector<int> free;
  for (const auto& assumption : settings.assumptions) {
    if (assumption.fit) free.push_back(assumption.index);
  }
  return free;
}

}  // namespace

TEST_CASE("table_residuals: count, names and weights of what is published", "[calib]") {
  const test::LeakRig rig;
  const diagnosis::TableResiduals all(rig.campaign, rig.settings, free_of(rig.settings), {});
  // 24 shares, the servo flow of Normal, and 5 numbers for each leaking row except the std of
  // Slight.
  CHECK(all.size() == 24 + 1 + 4 * 5 - 1);
  double weights = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all.name(i) != "std, Slight");
    CHECK((all.name(i).find("Normal") == std::string::npos || all.name(i) == "servo_flow, Normal"));
    weights += all.weight(i);
  }
  CHECK(weights == 24 * diagnosis::kShareWeight + 20.0);
}

TEST_CASE("table_residuals: derivatives are those of differences", "[calib]") {
  const test::LeakRig rig = small_rig();
  diagnosis::LeakTableOptions options;
  options.periodic.simulation.tolerance = 1e-6;
  options.periodic.tolerance = 1e-4;
  const auto free = free_of(rig.settings);
  diagnosis::TableResiduals residuals(rig.campaign, rig.settings, free, options);
  std::vector<double> values;
  for (const int index : free) values.push_back(rig.settings.assumption(index)->value);
  const auto at = residuals.evaluate(values, true);
  REQUIRE(at.failure.empty());
  for (std::size_t j = 0; j < free.size(); ++j) {
    const double h = 1e-2 * values[j];
    auto ahead = values;
    auto behind = values;
    ahead[j] += h;
    behind[j] -= h;
    const Eigen::VectorXd difference =
        (residuals.evaluate(ahead, false).residuals - residuals.evaluate(behind, false).residuals) /
        (2.0 * h);
    for (Eigen::Index i = 0; i < difference.size(); ++i) {
      CAPTURE(residuals.name(static_cast<std::size_t>(i)), j);
      // The derivative with respect to the logarithm of the value has noise of 1e-4 over a step of
      // 2e-2.
      CHECK_THAT(values[j] * at.jacobian(i, static_cast<Eigen::Index>(j)),
                 WithinAbs(values[j] * difference(i), 0.01));
    }
  }
}

TEST_CASE("fit_tables: a twin's values come back from a far start, a gain from zero", "[calib]") {
  test::LeakRig rig = small_rig();
  // The published values are replaced by those of the campaign's own rig.
  auto& signal = rig.settings.signals[0];
  const auto table = diagnosis::leak_table(rig.campaign, rig.settings, quick());
  for (const diagnosis::LeakEntry& entry : table.entries) {
    signal.printed.at(entry.target_percent).value = entry.coefficients.at(0);
  }
  for (std::size_t i = 0; i < table.features.size(); ++i) {
    const diagnosis::FeatureRow& row = table.features[i];
    rig.settings.features[i].left_out.clear();
    rig.settings.features[i].printed = {
        {datasets::Feature::servo_flow, row.servo_flow_l_per_min * kLitrePerMinute},
        {datasets::Feature::leak_flow, row.leak_flow_l_per_min * kLitrePerMinute},
        {datasets::Feature::mean, row.mean},
        {datasets::Feature::rms, row.rms},
        {datasets::Feature::std, row.std}};
  }
  const auto fit = diagnosis::fit_tables(rig.campaign, rig.settings, quick());
  CAPTURE(fit.message);
  REQUIRE(fit.status == calib::FitStatus::converged);
  CHECK(fit.rms < 3e-3);
  for (const calib::FittedParameter& p : fit.parameters) {
    const auto& spec = datasets::assumption_spec(rig.campaign.rig.plant, p.index);
    CAPTURE(spec.key, p.start, p.value);
    CHECK(p.start != rig.settings.assumption(p.index)->value);
    // The flows are accurate to 1e-3. For values with little influence this leaves an error of some
    // percent.
    CHECK_THAT(p.value, WithinRel(rig.settings.assumption(p.index)->value, 0.05));
    REQUIRE(p.ci95);
    CHECK(p.ci95->low < p.value);
    CHECK(p.value < p.ci95->high);
    CHECK(fit.settings.assumption(p.index)->value == p.value);
  }
  CHECK(fit.correlation.matrix.rows() == 4);
  CHECK(fit.residuals.size() == 4 + 3 * 5);
}

TEST_CASE("fit_tables: identifiability has the grades of any fit", "[calib]") {
  test::LeakRig rig = small_rig();
  // The published numbers deviate by a tenth from the rig without friction.
  auto& signal = rig.settings.signals[0];
  const auto table = diagnosis::leak_table(rig.campaign, rig.settings, quick());
  double sign = 1.0;
  for (const diagnosis::LeakEntry& entry : table.entries) {
    sign = -sign;
    signal.printed.at(entry.target_percent).value = entry.coefficients.at(0) * (1.0 + 0.1 * sign);
  }
  for (std::size_t i = 0; i < table.features.size(); ++i) {
    const diagnosis::FeatureRow& row = table.features[i];
    rig.settings.features[i].left_out.clear();
    rig.settings.features[i].printed = {
        {datasets::Feature::servo_flow,
         (1.0 + 0.1 * sign) * row.servo_flow_l_per_min * kLitrePerMinute},
        {datasets::Feature::leak_flow,
         (1.0 - 0.1 * sign) * row.leak_flow_l_per_min * kLitrePerMinute}};
    sign = -sign;
  }
  const int friction = model::parameter_index(rig.campaign.rig.plant, "coulomb_friction");
  datasets::Assumption absent;
  absent.index = friction;
  absent.source = "none, and it may be so";
  absent.fit = true;
  absent.start = 5.0;
  absent.lower = 0.0;
  absent.upper = 500.0;
  rig.settings.assumptions.push_back(absent);
  const auto fit = diagnosis::fit_tables(rig.campaign, rig.settings, quick());
  CAPTURE(fit.message);
  bool bounded = false;
  bool wide = false;
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!p.ci95) continue;
    const double half_width = 0.5 * (p.ci95->high - p.ci95->low);
    const double share = half_width / p.value;
    CAPTURE(datasets::assumption_spec(rig.campaign.rig.plant, p.index).key, p.value, share);
    if (p.index == friction) {
      bounded = p.ci95->low <= 0.0;
      CHECK(p.identifiability ==
            (bounded ? calib::Identifiability::bounded : calib::Identifiability::weak));
      continue;
    }
    wide = wide || share > 0.2;
    CHECK(p.identifiability == (share > 1.0   ? calib::Identifiability::not_identifiable
                                : share > 0.2 ? calib::Identifiability::weak
                                              : calib::Identifiability::identified));
  }
  CHECK(bounded);
  CHECK(wide);
}

TEST_CASE("fit_tables: too little to fit is said", "[calib]") {
  test::LeakRig rig = small_rig();
  rig.settings.signals[0].printed.clear();
  rig.settings.features.clear();
  CHECK_THROWS_WITH(diagnosis::fit_tables(rig.campaign, rig.settings, {}),
                    Contains("0 published numbers cannot determine 4 values"));
  for (auto& assumption : rig.settings.assumptions) assumption.fit = false;
  CHECK_THROWS_AS(diagnosis::fit_tables(rig.campaign, rig.settings, {}), InputError);
}

TEST_CASE("fit_tables: a start that cannot be simulated is a failed fit with a reason", "[calib]") {
  const test::LeakRig rig = small_rig();
  diagnosis::LeakTableOptions options;
  options.periodic.simulation.max_steps = 5;
  const auto fit = diagnosis::fit_tables(rig.campaign, rig.settings, options);
  CHECK(fit.status == calib::FitStatus::failed);
  CHECK_THAT(fit.message, Contains("too many steps"));
  for (const calib::FittedParameter& p : fit.parameters) CHECK_FALSE(p.ci95);
}
