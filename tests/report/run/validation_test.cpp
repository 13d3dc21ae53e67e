#include "report/run/validation.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "report/run/write_result.hpp"
#include "tests/report/run/made_fit.hpp"

namespace rigcal::report {
namespace {

bool warns(const calib::Fit& fit, const std::string& words) {
  return std::any_of(fit.warnings.begin(), fit.warnings.end(), [&](const std::string& warning) {
    return warning.find(words) != std::string::npos;
  });
}

TEST_CASE("validation: a fit in memory is the fit of its file", "[report][run]") {
  test::MadeFit fitted;
  const EarlierFit of_memory =
      earlier_fit(stored(fitted.result()), "fit", fitted.campaign.rig.plant);
  {
    HeldFolder held(fitted.folder / "out", {"fit"});
    write_result(held, 1, fitted.result());
  }
  const EarlierFit of_file =
      read_fit(fitted.folder / "out" / "fit.json", fitted.campaign.rig.plant);
  REQUIRE(of_file.values.size() == 3);
  REQUIRE(of_memory.values.size() == of_file.values.size());
  for (std::size_t i = 0; i < of_file.values.size(); ++i)
    CHECK(of_memory.values[i].value == of_file.values[i].value);
  CHECK(of_memory.covariance == of_file.covariance);
  CHECK(of_memory.input_hashes == of_file.input_hashes);

  const calib::Fit validated =
      validate(fitted.campaign, fitted.records, &of_memory, fitted.provenance, fitted.settings);
  REQUIRE(validated.conditions.size() == 3);
  CHECK_FALSE(warns(validated, "in the fit"));
  for (const calib::FittedParameter& parameter : validated.parameters)
    if (parameter.index == of_file.values[0].index)
      CHECK(parameter.value == of_file.values[0].value);
}

TEST_CASE("validation: a known value that was another in the fit is told", "[report][run]") {
  test::MadeFit fitted;
  const EarlierFit earlier = earlier_fit(stored(fitted.result()), "fit", fitted.campaign.rig.plant);
  fitted.choice.set = {"density=900 kg/m3"};
  const datasets::Campaign changed = load(fitted.choice);
  const calib::Fit validated =
      validate(changed, fitted.records, &earlier, fitted.provenance, fitted.settings);
  CHECK(warns(validated, "density is 900 kg/m3 here, but was 847 kg/m3 in the fit"));
}

TEST_CASE("validation: without an earlier fit the campaign's own values count", "[report][run]") {
  test::MadeFit fitted;
  const calib::Fit validated =
      validate(fitted.campaign, fitted.records, nullptr, fitted.provenance, fitted.settings);
  const int mass = model::parameter_index(fitted.campaign.rig.plant, "mass");
  for (const calib::FittedParameter& parameter : validated.parameters)
    if (parameter.index == mass) CHECK(parameter.value == 60.0);  // the start value of the mass
}

}  // namespace
}  // namespace rigcal::report
