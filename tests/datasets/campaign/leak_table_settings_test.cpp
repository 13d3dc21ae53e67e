#include "datasets/campaign/leak_table_settings.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinRel;

namespace {

const std::string kSection = R"([leak_table]
targets = [10, 50]
coefficients = [0.01, 20]
[leak_table.assumptions]
mass = { value = "85 kg", source = "Table 2" }
kp = { value = "78.74 V/m", source = "fitted", fit = true, start = "40 V/m", lower = "4 V/m", upper = "800 V/m" }
residual_scale = { value = "55.35 1/m", source = "fitted", fit = true, start = "40 1/m", lower = "1 1/m", upper = "100 1/m" }
[[leak_table.signal]]
waveform = "square"
frequency = "0.1 Hz"
amplitude = "50.8 mm"
printed = ["0.25", "1.4"]
normal = "0.1"
notes = { "50" = "a misprint" }
[leak_table.features]
waveform = "sine"
frequency = "0.1 Hz"
amplitude = "50.8 mm"
[[leak_table.features.row]]
level = "Slight"
coefficient = 0.15
servo_flow = "2.0887 L/min"
mean = 0.0508
std = 0.022
left_out = ["std"]
reason = "unknown"
)";

Campaign campaign_with(const std::string& section, const test::TemporaryFolder& folder) {
  return load_campaign(folder.write("campaign.toml", test::kExample + section));
}

LeakTableSettings settings_of(const std::string& section) {
  const test::TemporaryFolder folder;
  return leak_table_settings(campaign_with(section, folder));
}

/// Returns the error message for a section in which `from` was replaced with `to`.
std::string complaint(const std::string& from, const std::string& to) {
  return test::complaint_of([&] { settings_of(test::replaced(kSection, from, to)); });
}

}  // namespace

TEST_CASE("leak_table_settings: reads what is there, in SI", "[datasets]") {
  const LeakTableSettings settings = settings_of(kSection);
  CHECK(settings.targets_percent == std::vector{10.0, 50.0});
  CHECK(settings.lowest_coefficient == 0.01);
  CHECK(settings.highest_coefficient == 20.0);
  REQUIRE(settings.signals.size() == 1);
  const LeakSignal& signal = settings.signals[0];
  CHECK(signal.name() == "square_0.1Hz");
  CHECK_THAT(signal.amplitude, WithinRel(0.0508, 1e-12));
  REQUIRE(signal.printed.size() == 2);
  // The rounding follows from the number of printed digits.
  CHECK_THAT(signal.printed.at(10.0).half_digit, WithinRel(0.005, 1e-12));
  CHECK_THAT(signal.printed.at(50.0).half_digit, WithinRel(0.05, 1e-12));
  CHECK(signal.printed.at(50.0).note == "a misprint");
  CHECK(signal.normal->value == 0.1);
  REQUIRE(settings.features.size() == 1);
  CHECK_THAT(settings.features[0].printed.at(Feature::servo_flow),
             WithinRel(2.0887e-3 / 60.0, 1e-12));
  CHECK(settings.features[0].left_out == std::vector{Feature::std});
  REQUIRE(settings.assumptions.size() == 3);
  CHECK(settings.assumptions[1].fit);
  CHECK_THAT(settings.assumptions[1].start, WithinRel(40.0, 1e-12));
  CHECK(settings.assumption(kResidualScale)->value == 55.35);
}

TEST_CASE("leak_table_settings: without a section, the sines and squares of the conditions",
          "[datasets]") {
  const LeakTableSettings settings = settings_of("");
  CHECK(settings.targets_percent == std::vector{10.0, 20.0, 30.0, 50.0});
  REQUIRE(settings.signals.size() == 1);
  CHECK(settings.signals[0].name() == "sine_0.1Hz");
  CHECK(settings.signals[0].printed.empty());
  CHECK(settings.features.empty());
}

TEST_CASE("leak_table_settings: errors name the key and what was expected", "[datasets]") {
  CHECK_THAT(complaint("targets", "tragets"), Contains("tragets") && Contains("did you mean"));
  CHECK_THAT(complaint("[10, 50]", "[50, 10]"),
             Contains("leak_table.targets") && Contains("increasing"));
  CHECK_THAT(complaint("[10, 50]", "[]"), Contains("is empty"));
  CHECK_THAT(complaint("[10, 50]", "[-10, 50]"), Contains("above zero"));
  CHECK_THAT(complaint("[0.01, 20]", "[20, 0.01]"), Contains("0 < lowest < highest"));
  CHECK_THAT(complaint("[0.01, 20]", "[1]"), Contains("lowest and the highest"));
  CHECK_THAT(complaint("[\"0.25\", \"1.4\"]", "[\"0.25\"]"),
             Contains("has 1 coefficients, but there are 2 targets"));
  CHECK_THAT(complaint("\"0.25\"", "0.25"), Contains("in quotes"));
  CHECK_THAT(complaint("\"0.25\"", "\"0,25\""), Contains("in quotes"));
  CHECK_THAT(complaint("\"50\" =", "\"40\" ="), Contains("names no target"));
  CHECK_THAT(complaint("waveform = \"square\"", "waveform = \"chirp\""),
             Contains("leak_table.signal") && Contains("square"));
  CHECK_THAT(complaint("mass = {", "masse = {"), Contains("unknown parameter 'masse'"));
  CHECK_THAT(complaint("mass = {", "leakage_coefficient = {"),
             Contains("the parameter that the table varies"));
  CHECK_THAT(complaint("\"85 kg\"", "\"85 m\""), Contains("leak_table.assumptions.mass.value"));
  CHECK_THAT(complaint("\"85 kg\", source = \"Table 2\"", "\"85 kg\""), Contains("source"));
  CHECK_THAT(complaint("start = \"40 V/m\"", "start = \"1 V/m\""), Contains("lower <= start"));
  CHECK_THAT(complaint("source = \"Table 2\"", "source = \"Table 2\", upper = \"9 kg\""),
             Contains("expected fit = true as well"));
  CHECK_THAT(complaint("left_out = [\"std\"]", "left_out = [\"sdt\"]"), Contains("std"));
  CHECK_THAT(complaint("reason = \"unknown\"\n", ""), Contains("reason"));
  CHECK_THAT(complaint("left_out = [\"std\"]\n", ""), Contains("no value is left out"));
  CHECK_THAT(complaint("mean = 0.0508", "mean = 0"), Contains("above zero"));
}

TEST_CASE("leak_table_settings: a signal stands once", "[datasets]") {
  const std::string again =
      "[[leak_table.signal]]\nwaveform = \"square\"\nfrequency = \"0.1 Hz\"\n"
      "amplitude = \"50.8 mm\"\n";
  CHECK_THROWS_WITH(settings_of(test::replaced(kSection, "[leak_table.features]\n",
                                               again + "[leak_table.features]\n")),
                    Contains("appears twice"));
}

TEST_CASE("leak_table_values: assumptions count over the rig's values, --set over both",
          "[datasets]") {
  const test::TemporaryFolder folder;
  Campaign campaign = campaign_with(kSection, folder);
  LeakTableSettings settings = leak_table_settings(campaign);
  CHECK(leak_table_values(campaign, settings)["mass"] == 85.0);
  CHECK(leak_table_values(campaign, settings)["leakage_coefficient"] == 0.0);
  for (const char* assignment : {"mass=70 kg", "stiffness=100 N/m"}) {
    set_value(campaign, assignment);
    override_assumption(settings, campaign, assignment);
  }
  override_assumption(settings, campaign, "residual_scale=39.37 1/m");
  CHECK(leak_table_values(campaign, settings)["mass"] == 70.0);
  CHECK(leak_table_values(campaign, settings)["stiffness"] == 100.0);
  CHECK(settings.assumption(kResidualScale)->start == 39.37);
  CHECK(settings.assumption(model::parameter_index(campaign.rig.plant, "mass"))->source == "--set");
  CHECK_THROWS_AS(override_assumption(settings, campaign, "residual_scale=39.37 m"), UsageError);
  CHECK_THROWS_AS(override_assumption(settings, campaign, "residual_scale=-1 1/m"), UsageError);
  set_value(campaign, "kp=1 V/m");
  CHECK_THROWS_WITH(override_assumption(settings, campaign, "kp=1 V/m"),
                    Contains("outside the bounds"));
}

TEST_CASE("free_assumptions: exactly the named ones, with bounds", "[datasets]") {
  const test::TemporaryFolder folder;
  const Campaign campaign = campaign_with(kSection, folder);
  LeakTableSettings settings = leak_table_settings(campaign);
  free_assumptions(settings, campaign, {"kp", "damping"});
  int free = 0;
  for (const Assumption& assumption : settings.assumptions) free += assumption.fit ? 1 : 0;
  CHECK(free == 2);
  const Assumption* damping =
      settings.assumption(model::parameter_index(campaign.rig.plant, "damping"));
  REQUIRE(damping != nullptr);
  CHECK(damping->start == 1000.0);
  CHECK_THAT(damping->lower, WithinRel(100.0, 1e-12));
  CHECK_THAT(damping->upper, WithinRel(10000.0, 1e-12));
  CHECK_THROWS_WITH(free_assumptions(settings, campaign, {"kq"}),
                    Contains("unknown parameter 'kq'"));
  CHECK_THROWS_WITH(free_assumptions(settings, campaign, {"leakage_coefficient"}),
                    Contains("the parameter that the table varies"));
  CHECK_THROWS_WITH(free_assumptions(settings, campaign, {"leakage_smoothing"}),
                    Contains("cannot be fitted"));
  CHECK_THROWS_WITH(free_assumptions(settings, campaign, {"stiffness"}),
                    Contains("no value from which bounds can be derived"));
}

TEST_CASE("signal_from_text: waveform, frequency, amplitude", "[datasets]") {
  const test::TemporaryFolder folder;
  const Campaign campaign = campaign_with(kSection, folder);
  const LeakTableSettings settings = leak_table_settings(campaign);
  const LeakSignal known = signal_from_text(campaign, settings, "square@0.1Hz");
  CHECK(known.printed.size() == 2);
  const LeakSignal other = signal_from_text(campaign, settings, "sine@2Hz@20mm");
  CHECK(other.name() == "sine_2Hz");
  CHECK_THAT(other.amplitude, WithinRel(0.02, 1e-12));
  CHECK(other.printed.empty());
  for (const char* text : {"sine", "saw@1Hz", "sine@1m", "sine@-1Hz", "sine@1Hz@1V", "sine@1Hz@0mm",
                           "sine@1Hz@1mm@1", ""}) {
    CAPTURE(text);
    CHECK_THROWS_AS(signal_from_text(campaign, settings, text), UsageError);
  }
}

TEST_CASE("fitted_leak_table_text: reads back to the same assumptions", "[datasets]") {
  const test::TemporaryFolder folder;
  const Campaign campaign = campaign_with(kSection, folder);
  LeakTableSettings settings = leak_table_settings(campaign);
  settings.assumptions[1].value = 77.123456789012345;
  settings.assumptions[1].source = "estimated";
  const auto file =
      folder.write("fitted.toml", fitted_leak_table_text(campaign, settings, folder.path()));
  const LeakTableSettings again = leak_table_settings(load_campaign(file));
  REQUIRE(again.assumptions.size() == settings.assumptions.size());
  CHECK(again.assumptions[1].value == settings.assumptions[1].value);
  CHECK(again.assumptions[1].source == "estimated");
  CHECK(again.assumptions[1].fit);
  CHECK(again.signals[0].printed.at(10.0).value == 0.25);
}

TEST_CASE("leak table settings: a fit's values replace assumptions and say what", "[datasets]") {
  const test::TemporaryFolder folder;
  const Campaign campaign = campaign_with(kSection, folder);
  LeakTableSettings settings = leak_table_settings(campaign);
  const auto index = [&](const char* key) {
    return model::parameter_index(campaign.rig.plant, key);
  };
  take_fitted(settings, campaign,
              {{index("mass"), Scope::rig, "", 90.0},
               {index("damping"), Scope::rig, "", 700.0},
               {index("leakage_coefficient"), Scope::leak_level, "none", 0.3}});
  const Assumption* mass = settings.assumption(index("mass"));
  CHECK(mass->value == 90.0);
  CHECK(mass->fitted);
  CHECK(mass->source == "fit, in place of 85 kg (Table 2)");
  CHECK(settings.assumption(index("damping"))->source == "fit");
  CHECK(settings.assumption(index("leakage_coefficient")) == nullptr);
  CHECK_FALSE(settings.assumption(index("kp"))->fitted);  // the fit does not include it
  CHECK(leak_table_values(campaign, settings)["mass"] == 90.0);
  CHECK(leak_table_values(campaign, settings)["damping"] == 700.0);
  Campaign set = campaign;
  set_value(set, "mass=70 kg");
  override_assumption(settings, set, "mass=70 kg");
  CHECK_FALSE(settings.assumption(index("mass"))->fitted);
  CHECK(leak_table_values(set, settings)["mass"] == 70.0);
}

TEST_CASE("leak table settings: a rig needs a single value", "[datasets]") {
  const test::TemporaryFolder folder;
  const Campaign campaign = campaign_with(kSection, folder);
  LeakTableSettings settings = leak_table_settings(campaign);
  const int friction = model::parameter_index(campaign.rig.plant, "coulomb_friction");
  CHECK_THROWS_WITH(
      take_fitted(settings, campaign, {{friction, Scope::condition, "sine", 50.0}}),
      Contains("coulomb_friction was fitted per condition") && Contains("--set coulomb_friction"));
  const int mass = model::parameter_index(campaign.rig.plant, "mass");
  take_fitted(settings, campaign, {{mass, Scope::leak_level, "none", 90.0}});
  CHECK(settings.assumption(mass)->value == 85.0);  // value that the campaign states for the rig
}
