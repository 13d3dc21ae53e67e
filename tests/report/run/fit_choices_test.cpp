#include "report/run/fit_choices.hpp"

#include <catch2/catch.hpp>

#include "datasets/prepare/load_record.hpp"
#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("fit choices: what nobody asked for is the campaign's", "[report][run]") {
  datasets::Campaign campaign;
  campaign.fit.starts = 4;
  campaign.fit.max_seconds = 7.0;
  campaign.fit.max_iterations = 11;
  campaign.fit.posterior = 700;
  const std::atomic<bool> cancel{false};
  calib::FitOptions settings = fit_options(campaign, 3, cancel);
  apply({}, settings);
  CHECK(settings.starts == 4);
  CHECK(settings.further_starts == 3);  // used if the single start does not end at a minimum
  CHECK(settings.max_seconds == 7.0);
  CHECK(settings.max_iterations == 11);
  CHECK(settings.posterior == 700);
  CHECK(settings.threads == 3);
  CHECK(settings.cancel == &cancel);
  CHECK(recorded(FitChoices{}).empty());
  CHECK(arguments_of(FitChoices{}).empty());

  FitChoices choices;
  choices.starts = 2;
  choices.seed = 9;
  choices.bootstrap = 5;
  choices.profiles = true;
  choices.posterior = 300;
  choices.cross_validate = true;
  choices.max_time_s = 1.5;
  choices.max_evaluations = 100;
  settings = fit_options(campaign, 3, cancel);
  apply(choices, settings);
  CHECK(settings.starts == 2);
  CHECK(settings.further_starts == 0);
  CHECK(settings.seed == 9);
  CHECK(settings.bootstrap == 5);
  CHECK(settings.profiles);
  CHECK(settings.posterior == 300);
  CHECK(settings.cross_validate);
  CHECK(settings.max_seconds == 1.5);
  CHECK(settings.max_evaluations == 100);
  CHECK(recorded(choices) ==
        std::vector<std::pair<std::string, std::string>>{{"bootstrap", "5"},
                                                         {"profiles", "true"},
                                                         {"posterior", "300"},
                                                         {"cross_validate", "true"}});
  CHECK(arguments_of(choices) ==
        std::vector<std::string>{"--starts", "2", "--seed", "9", "--bootstrap", "5", "--profiles",
                                 "--posterior", "300", "--cross-validate", "--max-time", "1.5",
                                 "--max-evaluations", "100"});
}

TEST_CASE("fit choices: a provenance names inputs and what the starts rest on", "[report][run]") {
  test::MadeRig rig;
  const datasets::Campaign campaign = load(rig.choice);
  const auto records = datasets::load_records(campaign, {datasets::Use::fit}, 1, true);
  calib::FitOptions settings;
  settings.starts = 6;
  FitChoices choices;
  choices.seed = 3;
  choices.bootstrap = 50;
  const Provenance provenance = provenance_of_starts("rigcal fit", recorded(rig.choice), choices,
                                                     settings, campaign, records);
  CHECK(provenance.command == "rigcal fit");
  CHECK(provenance.seed == 3);
  CHECK(provenance.options == std::vector<std::pair<std::string, std::string>>{
                                  {"set", ""}, {"free", ""}, {"starts", "6"}});
  REQUIRE(provenance.inputs.size() == 7);  // the campaign, and two conditions with three repeats
  CHECK(provenance.inputs.front().path == campaign.file.string());
}

}  // namespace
}  // namespace rigcal::report
