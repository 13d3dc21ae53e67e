#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::kExample;
using rigcal::test::replaced;
using rigcal::test::TemporaryFolder;

namespace {

const std::string kOddLevel = "\"33 \\\"%\\\"\\n\\u0001 é <script>alert('x')</script>\"";
const std::string kOddLevelValue = "33 \"%\"\n\x01 \xC3\xA9 <script>alert('x')</script>";

/// Values without a short decimal form.
constexpr double kMassValue = 61.234567890123456;
constexpr double kLeak = 0.1 + 0.2;

int index_of(const Campaign& campaign, std::string_view key) {
  return model::parameter_index(campaign.rig.plant, key);
}

}  // namespace

TEST_CASE("fitted_campaign_text: loads again with the same values", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = replaced(kExample, "leak_level = \"none\"", "leak_level = " + kOddLevel);
  text = replaced(text, "\"UIS shake table\"", kOddLevel);
  const Campaign campaign = load_campaign(folder.write("in/campaign.toml", text));
  const std::vector<FittedValue> values{
      {index_of(campaign, "mass"), Scope::rig, "", kMassValue},
      {index_of(campaign, "damping"), Scope::rig, "", 1.0 / 3.0},
      {index_of(campaign, "leakage_coefficient"), Scope::leak_level, kOddLevelValue, kLeak},
      {index_of(campaign, "position_offset"), Scope::condition, "steps", 1e-4}};
  const auto out = folder.path() / "out" / "deep";
  const std::string written = fitted_campaign_text(campaign, values, out);
  const Campaign again = load_campaign(folder.write("out/deep/fitted.toml", written));

  CHECK(written.starts_with("# Written by rigcal fit from \"campaign.toml\""));
  CHECK(again.name == kOddLevelValue);
  REQUIRE(again.conditions.size() == 2);
  const auto sine = values_in(again, again.conditions[0]);
  const auto steps = values_in(again, again.conditions[1]);
  CHECK(again.conditions[1].leak_level == kOddLevelValue);
  CHECK(sine["mass"] == kMassValue);
  CHECK(sine["damping"] == 1.0 / 3.0);
  CHECK(sine["leakage_coefficient"] == 0.35);
  CHECK(steps["leakage_coefficient"] == kLeak);
  CHECK_FALSE(again.setting(index_of(again, "mass"))->fit);
  // Every condition has a value. The start value of the fit does not apply to other levels.
  CHECK(again.setting(index_of(again, "leakage_coefficient")) == nullptr);
  const ParameterSetting* offset = again.setting(index_of(again, "position_offset"));
  REQUIRE(offset != nullptr);
  CHECK(offset->fit);
  CHECK(offset->nuisance);
  for (const char* known : {"supply_pressure", "piston_area", "valve_gain", "kp"}) {
    CHECK(sine[known] == values_in(campaign, campaign.conditions[0])[known]);
  }
  CHECK(again.conditions[0].repeats[0].file == "../../in/records/sine_0.1Hz_33_*.csv");
  CHECK(again.conditions[1].repeats[1].file == "../../in/steps_1V.csv");
  CHECK(again.conditions[1].repeats[1].columns == campaign.conditions[1].repeats[1].columns);
  CHECK(again.conditions[1].date == campaign.conditions[1].date);
  CHECK(again.conditions[1].temperature_k == campaign.conditions[1].temperature_k);
  CHECK(again.acceptance.size() == campaign.acceptance.size());
  // The order of the file is kept, so that readers can find their way around.
  CHECK(written.find("schema") < written.find("[rig.parameters]"));
  CHECK(written.find("[rig.parameters]") < written.find("[acceptance]"));
}

TEST_CASE("fitted_campaign_text: a level without a value is an error", "[datasets]") {
  const TemporaryFolder folder;
  const Campaign campaign = load_campaign(folder.write("campaign.toml", kExample));
  const std::string written = fitted_campaign_text(
      campaign, {{index_of(campaign, "leakage_coefficient"), Scope::leak_level, "none", 0.0}},
      folder.path());
  const std::string other = replaced(written, "leak_level = \"none\"", "leak_level = \"50 %\"");
  CHECK_THROWS_WITH(load_campaign(folder.write("fitted.toml", other)),
                    Catch::Contains("leakage_coefficient"));
}

TEST_CASE("fitted_campaign_text: values of conditions, controllers and options", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = replaced(kExample, "kp = \"78.74 V/m\"",
                              "kp = { start = \"78.74 V/m\", fit = true, scope = \"condition\" }");
  text = replaced(text, "[averaging]", "[synthetic]\nnoise = { position = \"1 um\" }\n[averaging]");
  Campaign campaign = load_campaign(folder.write("campaign.toml", text));
  set_value(campaign, "coulomb_friction=12.5 N");
  set_value(campaign, "supply_pressure=7.1 MPa");
  set_value(campaign, "discharge_coefficient=0.65");
  const std::string written = fitted_campaign_text(
      campaign,
      {{index_of(campaign, "kp"), Scope::condition, "steps", 77.123456789012345},
       {index_of(campaign, "bulk_modulus"), Scope::condition, "steps", 7.001e8}},
      folder.path());
  const Campaign again = load_campaign(folder.write("fitted.toml", written));
  const auto sine = values_in(again, *again.find("sine_0.1Hz_open_33"));
  const auto steps = values_in(again, *again.find("steps"));
  CHECK(steps["kp"] == 77.123456789012345);
  CHECK(sine["kp"] == 78.74);
  CHECK(steps["bulk_modulus"] == 7.001e8);
  CHECK(sine["coulomb_friction"] == 12.5);
  CHECK(sine["supply_pressure"] == 7.1e6);
  CHECK(sine["discharge_coefficient"] == 0.65);
  CHECK(again.synthetic_settings.has_value());
  CHECK_THROWS_AS(
      fitted_campaign_text(campaign, {{index_of(campaign, "kp"), Scope::condition, "no such", 1.0}},
                           folder.path()),
      std::invalid_argument);
}

TEST_CASE("fitted_campaign_text: writing twice changes nothing", "[datasets]") {
  const TemporaryFolder folder;
  const Campaign campaign = load_campaign(folder.write("campaign.toml", kExample));
  const std::string once = fitted_campaign_text(campaign, {}, folder.path());
  const Campaign again = load_campaign(folder.write("campaign.toml", once));
  CHECK(fitted_campaign_text(again, {}, folder.path()) == once);
}
