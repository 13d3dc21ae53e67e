#include "report/store/validity.hpp"

#include <catch2/catch.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/plant/parameter.hpp"

using namespace rigcal::report;
using rigcal::Range;

namespace {

Validity amplitude(double low_m, double high_m) {
  Validity validity;
  validity.amplitude = Range{low_m, high_m};
  return validity;
}

}  // namespace

TEST_CASE("coverage: what conditions and the narrower scope of a fit tell", "[report]") {
  using rigcal::datasets::Channel;
  using rigcal::datasets::Scope;
  using rigcal::datasets::Use;
  rigcal::datasets::Campaign campaign;
  campaign.rig = {rigcal::model::PlantKind::load_pressure, rigcal::model::ControllerKind::pid,
                  rigcal::model::InitialState::rest};
  rigcal::datasets::Condition chirp;
  chirp.id = "chirp";
  chirp.frequency_hz = 0.5;
  chirp.end_frequency_hz = 8.0;
  chirp.leak_level = "seal";
  rigcal::datasets::Condition sine;
  sine.id = "sine";
  sine.frequency_hz = 1.0;
  sine.amplitude = 0.004;
  sine.leak_level = "none";
  rigcal::datasets::Condition other = sine;
  other.id = "other";
  other.use = Use::validate;
  other.frequency_hz = 50.0;
  campaign.conditions = {chirp, sine, other};

  const auto parameter = [&](const char* key, Scope scope, const char* level, double value) {
    rigcal::calib::FittedParameter p;
    p.index = rigcal::model::parameter_index(campaign.rig.plant, key);
    p.scope = scope;
    p.level = level;
    p.value = value;
    return p;
  };
  rigcal::calib::Fit fit;
  // Whatever the order, a condition's own value beats its leak level's, and that the rig's.
  fit.parameters = {parameter("leakage_coefficient", Scope::condition, "sine", 0.7),
                    parameter("leakage_coefficient", Scope::condition, "other", 9.0),
                    parameter("leakage_coefficient", Scope::leak_level, "none", 5.0),
                    parameter("leakage_coefficient", Scope::leak_level, "seal", 0.2),
                    parameter("leakage_coefficient", Scope::rig, "", 6.0),
                    parameter("supply_pressure", Scope::rig, "", 7e6)};
  rigcal::datasets::Record record;
  record.condition = "chirp";
  record.channels[Channel::reference].mean = {-0.001, 0.0, 0.003};
  record.channels[Channel::supply_pressure].mean = {6.1e6, 6.4e6};

  const Validity found = coverage(campaign, {record}, fit, {Use::fit});
  const auto is = [](const std::optional<Range>& range, double low, double high) {
    REQUIRE(range.has_value());
    CHECK(range->low == low);
    CHECK(range->high == high);
  };
  is(found.frequency_hz, 0.5, 8.0);
  is(found.amplitude, 0.002, 0.004);  // half of -1 to 3 mm
  is(found.supply_pressure_pa, 6.1e6, 7e6);
  auto recorded = campaign;
  recorded.conditions = {chirp};
  is(coverage(recorded, {record}, fit, {Use::fit}).supply_pressure_pa, 6.1e6, 6.4e6);
  is(found.leakage_coefficient, 0.2, 0.7);
  CHECK(found.leak_levels == std::vector<std::string>{"seal", "none"});
  std::swap(fit.parameters.front(), fit.parameters.back());
  is(coverage(campaign, {record}, fit, {Use::fit}).leakage_coefficient, 0.2, 0.7);
  is(coverage(campaign, {record}, fit, {Use::fit, Use::validate}).frequency_hz, 0.5, 50.0);
  for (auto& p : fit.parameters)
    if (p.value == 0.2) p.identifiability = rigcal::calib::Identifiability::bounded;
  is(coverage(campaign, {record}, fit, {Use::fit}).leakage_coefficient, 0.0, 0.7);
}

TEST_CASE("outside: a tenth beyond the covered range is let pass", "[report]") {
  CHECK(outside(amplitude(0.00201, 0.002063), amplitude(0.002063, 0.002063)).empty());
  CHECK(outside(amplitude(0.0046, 0.0109), amplitude(0.005, 0.01)).empty());
  CHECK(outside(amplitude(0.0044, 0.01), amplitude(0.005, 0.01)).size() == 1);
  CHECK(outside(amplitude(0.005, 0.0111), amplitude(0.005, 0.01)).size() == 1);
}

TEST_CASE("outside: one sentence in the units of the field", "[report]") {
  Validity covered = amplitude(0.005, 0.01);
  covered.frequency_hz = Range{0.1, 10.0};
  covered.supply_pressure_pa = Range{6.2e6, 6.2e6};
  covered.leakage_coefficient = Range{0.3, 0.6};
  Validity asked = amplitude(0.005, 0.0508);
  asked.frequency_hz = Range{20.0, 20.0};
  asked.supply_pressure_pa = Range{6.2e6, 7e6};
  asked.leakage_coefficient = Range{0.1, 0.6};
  CHECK(outside(asked, covered) ==
        std::vector<std::string>{
            "frequency 20 Hz is used, but the fit covers only 0.1 to 10 Hz",
            "amplitude 5 to 50.8 mm is used, but the fit covers only 5 to 10 mm",
            "supply pressure 6.2 to 7 MPa is used, but the fit covers only 6.2 MPa",
            "leakage coefficient 0.1 to 0.6 is used, but the fit covers only 0.3 to 0.6"});
  Validity validated;
  validated.frequency_hz = Range{20.0, 25.0};
  CHECK(outside(asked, covered, &validated).at(0) ==
        "frequency 20 Hz is used, but the fit covers only 0.1 to 10 Hz, validated at 20 to 25 Hz");
  CHECK(outside(asked, covered, &validated).at(1) == outside(asked, covered).at(1));
}

TEST_CASE("outside: what neither side tells is not compared", "[report]") {
  CHECK(outside(amplitude(0.1, 0.1), {}).empty());
  CHECK(outside({}, amplitude(0.1, 0.1)).empty());
}
