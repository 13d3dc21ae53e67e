#include "calib/trust/combinations.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "calib/trust/plan.hpp"
#include "calib/trust/symmetry.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;
using datasets::Waveform;

bool mentions(const std::vector<std::string>& texts, const std::string& a, const std::string& b) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return text.find(a) != std::string::npos && text.find(b) != std::string::npos;
  });
}

Twin bulk_twin() {
  Twin twin;
  twin.free("mass", 70.0, 17.0, 425.0);
  twin.free("bulk_modulus", 800e6, 138e6, 3445e6);
  twin.free("valve_gain", 0.035e-3, 0.008e-3, 0.2e-3);
  twin.free("leakage_coefficient", 0.4, 0.07, 1.75);
  return twin;
}

}  // namespace

TEST_CASE("combinations: the scaling symmetry is named, with mass and supply pressure", "[calib]") {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("damping", 900.0, 100.0, 5000.0);
  twin.free("stiffness", 1.5e4, 1e3, 1e5);
  twin.free("bulk_modulus", 8e8, 1e8, 2e9);
  twin.free("supply_pressure", 5e6, 1e6, 2e7);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.free("leakage_coefficient", 0.4, 0.05, 2.0);
  twin.add("square", Waveform::square, 2.0, 0.01);
  twin.add("sine", Waveform::sine, 5.0, 0.01);
  const auto records = twin.records(500, 500.0, 3);
  const Fit found = fit(twin.campaign, records, {});
  CHECK(mentions(found.combinations, "scaling symmetry", "mass_kg"));
  CHECK(mentions(found.combinations, "scaling symmetry", "supply_pressure_pa"));
  CHECK(mentions(found.combinations, "leaves all positions unchanged",
                 "valve_gain_m_per_v (by sqrt(s))"));
  // The records still determine mass over damping, 85 kg / (1000 N s/m).
  CHECK(mentions(found.combinations, "mass/", "the records determine only"));
  for (const auto* key : {"mass", "supply_pressure"}) {
    CHECK(parameter(found, key).identifiability == Identifiability::not_identifiable);
    CHECK_THAT(parameter(found, key).reason, Contains("a prior on"));
    // In the model the smoothing of the roots determines the scale, but not in a real rig.
    CHECK_FALSE(parameter(found, key).standard_error);
    CHECK_FALSE(parameter(found, key).ci95);
  }
  datasets::Campaign recorded = twin.campaign;
  for (auto& condition : recorded.conditions) condition.averaged = condition.id + ".csv";
  const Plan planned = plan(recorded, records, nullptr, 1);
  for (const PlannedParameter& each : planned.parameters) CHECK_FALSE(each.sd_all);
  CHECK_THAT(planned.parameters.at(0).remedy.value(),
             Contains("a prior on mass or supply pressure"));
  FitOptions more;
  more.profiles = true;
  more.bootstrap = 20;
  const Fit followed = fit(twin.campaign, records, more);
  CHECK_FALSE(parameter(followed, "mass").profile);
  CHECK_FALSE(parameter(followed, "mass").bootstrap);
  // A known stiffness fixes the scale, so errors of the stiffness affect it.
  twin.setting("stiffness").fit = false;
  twin.setting("stiffness").value = 2e4;
  const Fit resting = fit(twin.campaign, records, {});
  CHECK(mentions(resting.combinations, "only through the fixed stiffness_n_per_m", "mass_kg"));
  // If the supply pressure is known, there is no symmetry.
  twin.setting("supply_pressure").fit = false;
  twin.setting("supply_pressure").value = 6.2e6;
  CHECK_FALSE(mentions(fit(twin.campaign, records, {}).combinations, "scaling", "symmetry"));
}

TEST_CASE("combinations: the power that is fixed, and how well", "[calib]") {
  Twin twin;
  twin.free("mass", 80.0, 10.0, 500.0);
  twin.free("damping", 1000.0, 100.0, 5000.0);
  twin.add("sine", Waveform::sine, 5.0, 0.01);
  const auto records = twin.records(20, 500.0, 1);
  const Problem problem = problem_of(twin, records);
  REQUIRE(problem.spec(0).key == "mass");
  // Standard deviations of the logarithms, in two independent directions.
  const auto words_of = [&](const Eigen::RowVector2d& of_mass,
                            const Eigen::RowVector2d& of_damping) {
    Uncertainty found;
    Eigen::MatrixXd root(2, 2);
    root << of_mass / std::log(500.0 / 10.0), of_damping / std::log(5000.0 / 100.0);
    found.covariance_root = root;
    std::vector<FittedParameter> parameters(2);
    for (FittedParameter& each : parameters)
      each.identifiability = Identifiability::not_identifiable;
    return name_combinations(problem, problem.start(), found, parameters);
  };
  const auto square = words_of({1.0, 0.01}, {0.5, 0.0});
  REQUIRE(square.size() == 1);
  CHECK_THAT(square[0], Contains("mass/damping^2 = 8×10⁻⁵"));
  CHECK_THAT(square[0], Contains("(to 2 %)"));  // 1.96 times 1 %
  const auto product = words_of({0.5, 0.02}, {-0.5, 0.02});
  REQUIRE(product.size() == 1);
  CHECK_THAT(product[0], Contains("mass * damping = 80000"));
  CHECK_THAT(product[0], Contains("(to 7.8 %)"));    // 1.96 times 4 %
  CHECK(words_of({0.5, 0.2}, {0.5, -0.2}).empty());  // 78 % at best
}

TEST_CASE("combinations: a slow sine leaves the bulk modulus open, fast squares do not",
          "[calib]") {
  Twin slow = bulk_twin();
  slow.add("sine", Waveform::sine, 0.1, 0.0508);
  const Fit vague = fit(slow.campaign, slow.records(2000, 100.0, 5), {});
  const FittedParameter& open = parameter(vague, "bulk_modulus");
  CAPTURE(open.reason, open.value);
  CHECK(open.identifiability == Identifiability::not_identifiable);
  CHECK_FALSE(open.reason.empty());

  Twin all = bulk_twin();
  all.add("sine", Waveform::sine, 0.1, 0.0508);
  all.add("square1", Waveform::square, 1.0, 0.02);
  all.add("square10", Waveform::square, 10.0, 0.002);
  const Fit sure = fit(all.campaign, all.records(2000, 1000.0, 5), {});
  const FittedParameter& told = parameter(sure, "bulk_modulus");
  CAPTURE(told.reason, told.value);
  CHECK(told.identifiability == Identifiability::identified);
}

}  // namespace rigcal::calib
