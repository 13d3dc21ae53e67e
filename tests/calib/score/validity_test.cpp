#include "calib/score/validity.hpp"

#include <catch2/catch.hpp>

#include "model/plant/parameter.hpp"

namespace rigcal::calib {

TEST_CASE("coverage: what conditions and the narrower scope of a fit tell", "[calib]") {
  using datasets::Channel;
  using datasets::Scope;
  using datasets::Use;
  datasets::Campaign campaign;
  campaign.rig = {model::PlantKind::load_pressure, model::ControllerKind::pid,
                  model::InitialState::rest};
  datasets::Condition chirp;
  chirp.id = "chirp";
  chirp.frequency_hz = 0.5;
  chirp.end_frequency_hz = 8.0;
  chirp.leak_level = "seal";
  datasets::Condition sine;
  sine.id = "sine";
  sine.frequency_hz = 1.0;
  sine.amplitude = 0.004;
  sine.leak_level = "none";
  datasets::Condition other = sine;
  other.id = "other";
  other.use = Use::validate;
  other.frequency_hz = 50.0;
  campaign.conditions = {chirp, sine, other};

  const auto parameter = [&](const char* key, Scope scope, const char* level, double value) {
    FittedParameter p;
    p.index = model::parameter_index(campaign.rig.plant, key);
    p.scope = scope;
    p.level = level;
    p.value = value;
    return p;
  };
  Fit fit;
  // In any order, the value of the condition takes precedence over that of its leak level, which
  // takes precedence over that of the rig.
  fit.parameters = {parameter("leakage_coefficient", Scope::condition, "sine", 0.7),
                    parameter("leakage_coefficient", Scope::condition, "other", 9.0),
                    parameter("leakage_coefficient", Scope::leak_level, "none", 5.0),
                    parameter("leakage_coefficient", Scope::leak_level, "seal", 0.2),
                    parameter("leakage_coefficient", Scope::rig, "", 6.0),
                    parameter("supply_pressure", Scope::rig, "", 7e6)};
  datasets::Record record;
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
  is(found.amplitude_m, 0.002, 0.004);  // half of -1 to 3 mm
  CHECK(found.amplitude().unit == "m");
  CHECK_FALSE(found.amplitude_v);
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
    if (p.value == 0.2) p.identifiability = Identifiability::bounded;
  is(coverage(campaign, {record}, fit, {Use::fit}).leakage_coefficient, 0.0, 0.7);
}

TEST_CASE("validity: an amplitude is in the member of its unit", "[calib]") {
  const std::optional<Range> range = Range{1.0, 2.0};
  for (const char* unit : {"m", "V", "N", "Pa", "m/s2", "rad"}) {
    Validity validity;
    put_amplitude(unit, range, validity);
    CHECK(validity.amplitude().unit == unit);
    CHECK(validity.amplitude().range == range);
    CHECK(validity.amplitude_m.has_value() == (std::string_view(unit) == "m"));
  }
  CHECK_FALSE(Validity().amplitude().range);
}

}  // namespace rigcal::calib
