#include "report/store/stored/stored_fit.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::report;

TEST_CASE("periodic_frequency: of sine and square alone", "[report]") {
  using rigcal::datasets::Waveform;
  const auto frequency = [](Waveform waveform, std::optional<double> frequency_hz) {
    rigcal::calib::ConditionResult condition;
    condition.waveform = std::optional(waveform);
    condition.frequency_hz = frequency_hz;
    return periodic_frequency(condition);
  };
  CHECK(frequency(Waveform::sine, 2.0) == 2.0);
  CHECK(frequency(Waveform::square, 0.1) == 0.1);
  CHECK(frequency(Waveform::chirp, 2.0) == std::nullopt);
  CHECK(frequency(Waveform::sine, std::nullopt) == std::nullopt);
}

TEST_CASE("stored fit: what is unknown is null, what was not asked for is left out", "[report]") {
  const Json json = json_of(StoredFit());
  for (const char* key :
       {"reduced_chi_square", "independent_residuals", "between_repeats", "aic"}) {
    CAPTURE(key);
    CHECK(json.at(key).is_null());
  }
  CHECK(json.at("lack_of_fit").at("tests").empty());
  for (const char* key : {"considered", "stability", "bootstrap", "posterior", "cross_validation"})
    CHECK_FALSE(json.contains(key));
  // Earlier files lack some of the findings.
  Json earlier = json;
  earlier.erase("lack_of_fit");
  earlier.erase("independent_residuals");
  StoredFit read;
  read_into(JsonNode(earlier, "fit.json", "", "fit.json"), read);
  CHECK_FALSE(read.lack_of_fit.has_value());
  CHECK_FALSE(read.independent_residuals.has_value());
}
