#include <catch2/catch.hpp>
#include <cmath>

#include "report/comparison/comparison_parts.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::report::Json;
using rigcal::test::ComparedJson;
using rigcal::test::stored_result;

namespace {

Json models_json(const std::vector<rigcal::report::Compared>& results) {
  return json_of(compared_models(results));
}

/// A fit of the mass to 1000 residuals of one record.
ComparedJson mass_alone(const std::string& name, double cost) {
  Json result = stored_result();
  result["model"] = "load_pressure";
  result["cost"] = cost;
  result["residual_count"] = 1000;
  result["independent_residuals"] = 1000.0;
  result["rank"] = 1;
  result["weights"] = {{{"condition", "sine"},
                        {"channel", "position"},
                        {"samples", 1000},
                        {"sd", 1e-5},
                        {"rms", 1e-5}}};
  result["provenance"]["inputs"] = {{{"path", name + ".toml"}, {"sha256", name}},
                                    {{"path", "sine.csv"}, {"sha256", "one"}}};
  return {name, name + "/fit.json", result};
}

/// The fit from mass_alone() with friction as an additional free parameter.
ComparedJson with_friction(const std::string& name, double cost) {
  ComparedJson compared = mass_alone(name, cost);
  Json friction = compared.result["parameters"][0];
  friction["name"] = "coulomb_friction_n";
  friction["key"] = "coulomb_friction";
  friction["lower"] = 0.0;
  friction["upper"] = 1000.0;
  compared.result["parameters"].push_back(friction);
  compared.result["rank"] = 2;
  return compared;
}

}  // namespace

TEST_CASE("models: a term that explains more than noise is preferred", "[report]") {
  const Json json = models_json({mass_alone("plain", 520.0), with_friction("friction", 499.0)});
  REQUIRE(json.size() == 2);
  CHECK(json[0].is_null());
  // 2 (520 - 499) / (998 / 998) = 42, with one more parameter.
  CHECK_THAT(json[1]["likelihood_ratio"].get<double>(), WithinRel(42.0, 1e-12));
  CHECK_THAT(json[1]["delta_aic"].get<double>(), WithinRel(2.0 - 42.0, 1e-12));
  CHECK_THAT(json[1]["delta_bic"].get<double>(), WithinRel(std::log(1000.0) - 42.0, 1e-12));
  CHECK(json[1]["freedom"] == 1);
  CHECK(json[1]["larger"] == "friction");
  CHECK(json[1]["reason"].is_null());
  CHECK_THAT(json[1]["verdict"].get<std::string>(), Contains("friction is preferred"));
  // In reverse order the signs change, but the test result does not.
  const Json turned = models_json({with_friction("friction", 499.0), mass_alone("plain", 520.0)});
  CHECK_THAT(turned[1]["delta_aic"].get<double>(), WithinRel(42.0 - 2.0, 1e-12));
  CHECK(turned[1]["p_value"] == json[1]["p_value"]);
}

TEST_CASE("models: the share of independent residuals is that of the better one", "[report]") {
  ComparedJson plain = mass_alone("plain", 5000.0);
  plain.result["independent_residuals"] = 20.0;
  const Json json = models_json({plain, with_friction("friction", 499.0)});
  // With a separate fraction for each model, the worse model would have 5000 * 2 / 50 compared with
  // 998.
  CHECK_THAT(json[1]["delta_aic"].get<double>(), WithinRel(2.0 - 9002.0, 1e-12));
}

TEST_CASE("models: estimated noise is compared at its own likeliest size", "[report]") {
  ComparedJson plain = mass_alone("plain", 510.0);
  ComparedJson more = with_friction("friction", 490.0);
  for (ComparedJson* each : {&plain, &more}) each->result["weights"][0]["sd"] = nullptr;
  plain.result["weights"][0]["rms"] = 2e-5;
  more.result["weights"][0]["rms"] = 1e-5;
  const Json json = models_json({plain, more});
  // 2 * 1000 * ln 2, whatever weights the fits ended with, divided by a variance of 1000 / 998.
  CHECK_THAT(json[1]["likelihood_ratio"].get<double>(),
             WithinRel(2000.0 * std::log(2.0) * 0.998, 1e-12));
}

TEST_CASE("models: what is not nested is told by the criteria alone", "[report]") {
  ComparedJson offset = with_friction("offset", 499.0);
  offset.result["parameters"][2]["key"] = "valve_offset";
  ComparedJson both = with_friction("friction", 480.0);
  both.result["rank"] = 3;
  const Json json = models_json({offset, both});
  CHECK(json[1]["likelihood_ratio"].is_null());
  CHECK_THAT(json[1]["reason"].get<std::string>(),
             Contains("friction does not contain offset: valve_offset is free in only one"));
  CHECK_THAT(json[1]["verdict"].get<std::string>(), Contains("friction is preferred"));
  ComparedJson supply = with_friction("supply", 499.0);
  supply.result["parameters"][1]["value"] = 7e6;
  CHECK_THAT(models_json({mass_alone("plain", 520.0), supply})[1]["reason"].get<std::string>(),
             Contains("known value of supply_pressure"));
  ComparedJson bounded = with_friction("bounded", 499.0);
  ComparedJson known = mass_alone("known", 520.0);
  Json friction = bounded.result["parameters"][2];
  friction["fitted"] = false;
  friction["value"] = 2000.0;
  known.result["parameters"].push_back(friction);
  CHECK_THAT(models_json({known, bounded})[1]["reason"].get<std::string>(),
             Contains("coulomb_friction is outside the bounds"));
  // The model with the additional term fits worse, so its fit is not at a minimum.
  const Json worse = models_json({mass_alone("plain", 520.0), with_friction("friction", 900.0)});
  CHECK_THAT(worse[1]["reason"].get<std::string>(),
             Contains("friction has more free parameters and fits worse"));
  CHECK(worse[1]["likelihood_ratio"].is_null());
  CHECK_THAT(worse[1]["verdict"].get<std::string>(), Contains("plain is preferred"));
}

TEST_CASE("models: what cannot be compared at all, and why", "[report]") {
  const auto reason = [](const ComparedJson& a, const ComparedJson& b) {
    const Json json = models_json({a, b});
    CHECK(json[1]["verdict"].is_null());
    CHECK(json[1]["delta_aic"].is_null());
    return json[1]["reason"].get<std::string>();
  };
  const ComparedJson plain = mass_alone("plain", 520.0);
  ComparedJson other = with_friction("other", 499.0);
  other.result["provenance"]["inputs"][1]["sha256"] = "two";
  CHECK_THAT(reason(plain, other), Contains("same records"));
  other = with_friction("other", 499.0);
  other.result["weights"][0]["sd"] = 2e-5;
  CHECK_THAT(reason(plain, other), Contains("weighted differently"));
  other = with_friction("other", 499.0);
  other.result["status"] = "stopped";
  CHECK_THAT(reason(plain, other), Contains("other did not converge"));
  other = with_friction("other", 499.0);
  other.result.erase("weights");
  CHECK_THAT(reason(plain, other), Contains("by this version"));
  other = with_friction("other", 499.0);
  other.result.erase("independent_residuals");
  CHECK_THAT(reason(plain, other), Contains("by this version"));
}
