#include "calib/problem/parameter_map.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "datasets/campaign/campaign_parameters.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Scope;
using datasets::Waveform;

Twin three_scopes() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("damping", 900.0, 0.0, 5000.0);
  twin.free("leakage_coefficient", 0.3, 0.0, 5.0, Scope::leak_level);
  twin.free("position_offset", 0.0, -5e-3, 5e-3, Scope::condition).nuisance = true;
  twin.add("a", Waveform::sine, 1.0, 0.02, "low");
  twin.add("b", Waveform::sine, 2.0, 0.02, "high");
  twin.add("c", Waveform::sine, 3.0, 0.02, "low");
  return twin;
}

std::vector<const datasets::Condition*> all(const datasets::Campaign& campaign) {
  std::vector<const datasets::Condition*> result;
  for (const auto& condition : campaign.conditions) result.push_back(&condition);
  return result;
}

std::vector<std::string> acting_names(const ParameterMap& map, std::size_t condition) {
  std::vector<std::string> names;
  for (const int j : map.acting(condition)) {
    const Unknown& u = map.unknowns()[static_cast<std::size_t>(j)];
    names.push_back(std::to_string(u.index == Twin::index("mass")) + u.level);
  }
  return names;
}

}  // namespace

TEST_CASE("parameter map: one unknown per level, acting where it belongs", "[calib]") {
  const Twin twin = three_scopes();
  const ParameterMap map(twin.campaign, all(twin.campaign), false);
  CHECK(map.unknowns().size() == 1 + 1 + 2 + 3);
  CHECK(acting_names(map, 0) == std::vector<std::string>{"1", "0", "0low", "0a"});
  CHECK(acting_names(map, 1) == std::vector<std::string>{"1", "0", "0high", "0b"});
  CHECK(acting_names(map, 2) == std::vector<std::string>{"1", "0", "0low", "0c"});
}

TEST_CASE("parameter map: only nuisance parameters in validation", "[calib]") {
  const Twin twin = three_scopes();
  const ParameterMap map(twin.campaign, all(twin.campaign), true);
  CHECK(map.unknowns().size() == 3);
  for (const Unknown& unknown : map.unknowns()) CHECK(unknown.nuisance);
}

TEST_CASE("parameter map: a known value of a condition or level is no unknown", "[calib]") {
  Twin twin = three_scopes();
  twin.campaign.conditions[1].overrides.emplace_back(Twin::index("mass"), 70.0);
  twin.campaign.leak_levels["low"].emplace_back(Twin::index("leakage_coefficient"), 0.1);
  const ParameterMap map(twin.campaign, all(twin.campaign), false);
  CHECK(acting_names(map, 0) == std::vector<std::string>{"1", "0", "0a"});
  CHECK(acting_names(map, 1) == std::vector<std::string>{"0", "0high", "0b"});
}

TEST_CASE("parameter map: what differs between repeats averages out in a mean of them", "[calib]") {
  Twin twin = three_scopes();
  datasets::ParameterSetting& supply = twin.setting("supply_pressure");
  supply.lower = supply.upper = std::numeric_limits<double>::quiet_NaN();
  datasets::differ_between_repeats(model::parameter_spec(twin.campaign.rig.plant, supply.index),
                                   1e5, supply);
  CHECK(supply.lower == supply.value - 8e5);
  const auto sds = [&](const std::vector<int>& repeats) {
    const ParameterMap map(twin.campaign, all(twin.campaign), false, {}, repeats);
    std::vector<double> result;
    for (const Unknown& unknown : map.unknowns()) {
      if (unknown.index != supply.index) continue;
      CHECK(unknown.nuisance);
      CHECK(unknown.scope == Scope::condition);
      CHECK(unknown.prior->mean == supply.value);
      result.push_back(unknown.prior->sd);
    }
    return result;
  };
  CHECK(sds({}) == std::vector<double>{1e5, 1e5, 1e5});
  CHECK(sds({4, 1, 25}) == std::vector<double>{5e4, 1e5, 2e4});
}

TEST_CASE("parameter map: round trip and slope", "[calib]") {
  const Twin twin = three_scopes();
  const ParameterMap map(twin.campaign, all(twin.campaign), false);
  for (int j = 0; j < static_cast<int>(map.unknowns().size()); ++j) {
    for (const double z : {0.05, 0.3, 0.9}) {
      CAPTURE(j, z);
      // 1e-12 is the error of an exp and a log for bounds one or two decades apart, or of one
      // subtraction.
      CHECK_THAT(map.to_unit(j, map.to_physical(j, z)), WithinAbs(z, 1e-12));
      // Central difference with error h^2 / 6 times the third derivative: 1e-10 of the slope here.
      constexpr double h = 1e-5;
      const double difference = (map.to_physical(j, z + h) - map.to_physical(j, z - h)) / (2.0 * h);
      CHECK_THAT(map.slope(j, z), WithinRel(difference, 1e-8));
    }
  }
}

TEST_CASE("parameter map: the faces of the box are the bounds, exactly", "[calib]") {
  const Twin twin = three_scopes();
  const ParameterMap map(twin.campaign, all(twin.campaign), false);
  for (int j = 0; j < static_cast<int>(map.unknowns().size()); ++j) {
    const Unknown& u = map.unknowns()[static_cast<std::size_t>(j)];
    CHECK(map.to_physical(j, 0.0) >= u.lower);
    CHECK(map.to_physical(j, 1.0) <= u.upper);
    CHECK_THAT(map.to_physical(j, 1.0), WithinRel(u.upper, 1e-14));  // a few rounding errors
  }
}

TEST_CASE("parameter map: logarithmic where the bounds span more than a decade", "[calib]") {
  const Twin twin = three_scopes();
  const ParameterMap map(twin.campaign, all(twin.campaign), false);
  CHECK_THAT(map.to_physical(0, 0.5), WithinRel(std::sqrt(10.0 * 500.0), 1e-12));  // mass
  CHECK_THAT(map.to_physical(1, 0.5), WithinRel(2500.0, 1e-12));  // damping, with lower bound 0
}

TEST_CASE("parameter map: a scope of leak levels needs a leak level", "[calib]") {
  Twin twin = three_scopes();
  twin.campaign.conditions[2].leak_level.reset();
  CHECK_THROWS_WITH(ParameterMap(twin.campaign, all(twin.campaign), false),
                    Catch::Contains("\"c\"") && Catch::Contains("leakage_coefficient"));
}

TEST_CASE("parameter map: a start outside its bounds is an error", "[calib]") {
  Twin twin = three_scopes();
  twin.setting("mass").value = 5.0;
  CHECK_THROWS_WITH(ParameterMap(twin.campaign, all(twin.campaign), false),
                    Catch::Contains("mass") && Catch::Contains("outside the bounds"));
}

}  // namespace rigcal::calib
