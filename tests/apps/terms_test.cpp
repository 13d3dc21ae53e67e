// Tests rigs with single terms through the command line: records of a known rig, and the fit that
// finds its values again.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/two_chamber_fixture.hpp"

namespace rigcal::test {
namespace {

/// Fits the records in `twin/` and checks that the estimates of some parameters are near their
/// true values, known to at least one part in a hundred.
void check_recovery(const CommandFolder& folder,
                    const std::vector<std::pair<std::string, double>>& truth) {
  const Outcome outcome = folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--quiet"});
  INFO(outcome.err);
  REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 1));
  const auto fit = nlohmann::json::parse(folder.read("fit/fit.json"));
  REQUIRE(fit["status"].get<std::string>() == "converged");
  for (const auto& known : truth) {
    const std::string& key = known.first;
    const double value = known.second;
    const auto found = std::find_if(
        fit["parameters"].begin(), fit["parameters"].end(),
        [&](const nlohmann::json& each) { return each["key"].get<std::string>() == key; });
    REQUIRE(found != fit["parameters"].end());
    const double estimate = (*found)["value"].get<double>();
    const double error = (*found)["standard_error"].get<double>();
    CAPTURE(key, estimate, error);
    CHECK(std::abs(estimate - value) < 3.5 * error);
    CHECK(error < 0.01 * std::abs(value));
  }
}

}  // namespace

TEST_CASE("terms: a fit finds the main spool of a two-stage valve", "[apps]") {
  const CommandFolder folder;
  const std::string campaign =
      edited(kTwoChamber, {{"leakage_coefficient = 0\n",
                            "leakage_coefficient = 0\nvalve_time_constant = \"3 ms\"\n"
                            "main_spool_gain = { start = \"40 1/s\", lower = \"10 1/s\", upper = "
                            "\"500 1/s\", fit = true }\n"}});
  const std::string truth = edited(
      kTwoChamberTruth, {{"mass = \"5 kg\"", "mass = \"5 kg\", main_spool_gain = \"90 1/s\""}});
  const Outcome twin = synthesize_twin(folder, campaign + truth);
  INFO(twin.err);
  REQUIRE(twin.exit_code == 0);
  check_recovery(folder, {{"main_spool_gain", 90.0}, {"valve_gain", 4e-6}});
}

TEST_CASE("terms: a fit finds the gains of a shake table's controller", "[apps]") {
  const CommandFolder folder;
  const std::string campaign = edited(
      kTwoChamber,
      {{"mass = { start = \"6 kg\", lower = \"1 kg\", upper = \"50 kg\", fit = true }",
        "mass = \"5 kg\""},
       {"valve_gain = { start = \"5e-6 m/V\", lower = \"1e-6 m/V\", upper = \"2e-5 m/V\", fit = "
        "true }",
        "valve_gain = \"4e-6 m/V\""},
       {"type = \"none\"\n",
        "type = \"pid\"\nfeedback = \"three_variable_acceleration\"\nreference_frequency = \"1 "
        "Hz\"\nreference_damping_ratio = 0.7\n"
        "kp = { start = \"150 V/m\", lower = \"20 V/m\", upper = \"1000 V/m\", fit = true }\n"
        "velocity_kp = { start = \"5 V s/m\", lower = \"0.5 V s/m\", upper = \"50 V s/m\", fit = "
        "true }\nacceleration_kp = { start = \"0.02 V s2/m\", lower = \"0.002 V s2/m\", upper = "
        "\"0.2 V s2/m\", fit = true }\n"},
       {"command = { column = \"u_V\", unit = \"V\" }",
        "acceleration_reference = { column = \"a_ref\", unit = \"gravity\" }\n"
        "acceleration = { column = \"a\", unit = \"gravity\" }"},
       {"waveform = \"square\"\nfrequency = \"1 Hz\"\namplitude = \"1 V\"",
        "waveform = \"chirp\"\nfrequency = \"2 Hz\"\nend_frequency = \"40 Hz\"\nduration = "
        "\"4 s\"\namplitude = \"5 m/s2\""}});
  const std::string truth = R"([synthetic]
parameters = { kp = "220 V/m", velocity_kp = "8 V s/m", acceleration_kp = "0.01 V s2/m" }
repeats = 3
duration = "4 s"
sample_rate = "200 Hz"
noise = { position = "0.01 mm", pressure_a = "0.05 bar", pressure_b = "0.05 bar", acceleration = "0.02 m/s2" }
)";
  const Outcome twin = synthesize_twin(folder, campaign + truth);
  INFO(twin.err);
  REQUIRE(twin.exit_code == 0);
  check_recovery(folder, {{"kp", 220.0}, {"velocity_kp", 8.0}, {"acceleration_kp", 0.01}});
}

TEST_CASE("terms: a fit of a cold and a warm day finds how the viscosity falls", "[apps]") {
  const CommandFolder folder;
  const std::string day =
      "waveform = \"square\"\nfrequency = \"1 Hz\"\namplitude = \"1 V\"\nuse = \"fit\"\n";
  const std::string campaign = edited(
      kTwoChamber,
      {{"mass = { start = \"6 kg\", lower = \"1 kg\", upper = \"50 kg\", fit = true }",
        "mass = \"5 kg\""},
       {"leakage_coefficient = 0\n",
        "leakage_coefficient = 0\nlaminar_leakage = { start = \"1e-12 m3/(s Pa)\", lower = \"1e-13 "
        "m3/(s Pa)\", upper = \"1e-11 m3/(s Pa)\", fit = true }\nreference_temperature = \"40 "
        "degC\"\nthermal_expansion = \"7e-4 1/K\"\nviscosity_decay = { start = \"0.02 1/K\", lower "
        "= "
        "\"0.005 1/K\", upper = \"0.08 1/K\", fit = true }\n"},
       {"id = \"square\"\n", "id = \"cold\"\ntemperature = \"25 degC\"\n"},
       {"records/square_*.csv", "records/cold_*.csv"}});
  const std::string warm = "[[condition]]\nid = \"warm\"\ntemperature = \"55 degC\"\n" + day +
                           "repeats = [\"records/warm_*.csv\"]\n";
  const std::string truth =
      edited(kTwoChamberTruth,
             {{"mass = \"5 kg\"",
               "viscosity_decay = \"0.03 1/K\", laminar_leakage = \"2e-12 m3/(s Pa)\""}});
  const Outcome twin = synthesize_twin(folder, campaign + warm + truth);
  INFO(twin.err);
  REQUIRE(twin.exit_code == 0);
  check_recovery(folder,
                 {{"viscosity_decay", 0.03}, {"laminar_leakage", 2e-12}, {"valve_gain", 4e-6}});
}

}  // namespace rigcal::test
