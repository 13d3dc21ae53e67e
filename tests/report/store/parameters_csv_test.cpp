#include "report/store/parameters_csv.hpp"

#include <catch2/catch.hpp>

#include "tests/report/stored_fixture.hpp"

using rigcal::report::Json;
using rigcal::report::StoredFit;

namespace {

std::string parameters_csv(const Json& json) {
  const auto fit = rigcal::report::as<StoredFit>(json, "folder", "fit.json");
  return rigcal::report::parameters_csv(fit.status, fit.message, fit.parameters);
}

}  // namespace

TEST_CASE("parameters_csv: a row per parameter, numbers with all their bits", "[report]") {
  Json json = rigcal::test::stored_result();
  json["parameters"][0]["reason"] = "one, two";
  CHECK(parameters_csv(json) ==
        "name,key,symbol,unit,scope,level,fitted,nuisance,start,lower,upper,value,standard_error,"
        "robust_standard_error,ci95_low,ci95_high,at_bound,identifiability,reason\n"
        "mass_kg,mass,m,kg,rig,,1,0,60,10,500,85.01139529,0.026,,84.9,85.1,0,identified,"
        "\"one, two\"\n"
        "supply_pressure_pa,supply_pressure,P_s,Pa,rig,,0,0,6200000,,,6200000,,,,,0,,\n");
}

TEST_CASE("parameters_csv: what failed says so first", "[report]") {
  Json json = rigcal::test::stored_result();
  json["status"] = "failed";
  json["message"] = "no start\ncould be simulated";
  CHECK(parameters_csv(json).rfind("# status: failed: no start could be simulated\nname,", 0) == 0);
}
