#include <catch2/catch.hpp>

#include "report/store/csv.hpp"
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
  CHECK(
      parameters_csv(json) ==
      "name,key,symbol,unit,scope,level,fitted,nuisance,start,lower,upper,value,standard_error,"
      "robust_standard_error,ci95_low,ci95_high,at_bound,identifiability,reason,"
      "ci95_if_exact_low,ci95_if_exact_high,u_records,u_known_values,u_effects,u_combined,"
      "u_degrees_of_freedom,coverage_factor,shift,"
      "u_days,u_numerics\n"
      "mass_kg,mass,m,kg,rig,,1,0,60,10,500,85.01139529,0.026,,84.9,85.1,0,identified,"
      "\"one, two\",,,,,,,,,,,\n"
      "supply_pressure_pa,supply_pressure,P_s,Pa,rig,,0,0,6200000,,,6200000,,,,,0,,,,,,,,,,,,,\n");
}

TEST_CASE("parameters_csv: of a budget what each kind of source contributes", "[report]") {
  Json json = rigcal::test::stored_result();
  json["parameters"][0]["ci95_if_exact"] = {84.95, 85.05};
  json["parameters"][0]["budget"] = {
      {"lines",
       {{{"source", "noise"}, {"kind", "records"}, {"uncertainty", 0.25}},
        {{"source", "coulomb_friction"}, {"kind", "effect"}, {"uncertainty", 3.0}},
        {{"source", "valve_time_constant"}, {"kind", "effect"}, {"uncertainty", 4.0}}}},
      {"combined", 5.00625},
      {"degrees_of_freedom", 40.0},
      {"coverage_factor", 2.0},
      {"expanded", 10.0125},
      {"shift", -0.5}};
  CHECK_THAT(parameters_csv(json),
             Catch::Contains(",identified,,84.95,85.05,0.25,0,5,5.00625,40,2,-0.5,,\n"));
  json["parameters"][0]["budget"]["beside"] = {
      {{"source", "numerics"}, {"kind", "numerics"}, {"uncertainty", 0.002}},
      {{"source", "days"}, {"kind", "days"}, {"uncertainty", 1.5}}};
  CHECK_THAT(parameters_csv(json), Catch::Contains(",40,2,-0.5,1.5,0.002\n"));
}

TEST_CASE("parameters of an earlier schema: what was an interval is that of an exact model",
          "[report]") {
  const Json json = rigcal::test::stored_result();
  auto fit = rigcal::report::as<StoredFit>(json, "folder", "fit.json");
  REQUIRE(fit.schema == "rigcal.fit/1");
  CHECK_FALSE(fit.parameters[0].ci95_if_exact);
  rigcal::report::as_of_now(fit.schema, fit.parameters);
  REQUIRE(fit.parameters[0].ci95_if_exact);
  CHECK(fit.parameters[0].ci95_if_exact->low == 84.9);
  CHECK(fit.parameters[0].ci95_if_exact->high == 85.1);
}

TEST_CASE("parameters_csv: what failed says so first", "[report]") {
  Json json = rigcal::test::stored_result();
  json["status"] = "failed";
  json["message"] = "no start\ncould be simulated";
  CHECK(parameters_csv(json).rfind("# status: failed: no start could be simulated\nname,", 0) == 0);
}
