#include "report/run/missing_terms.hpp"

#include <catch2/catch.hpp>

namespace rigcal::report {
namespace {

TEST_CASE("missing_terms: a line for each term that a campaign may estimate", "[report]") {
  calib::Considered considered;
  for (const auto& [key, size] : std::vector<std::pair<std::string, std::optional<double>>>{
           {"valve_time_constant", 2e-4},
           {"position_gain", -0.004},
           {"ki", 5.0},
           {"kp", 0.3},
           {"total_volume", 1e-6},
           {"position_wave", 1e-4},
           {"sample_time", 1e-3},
           {"coulomb_friction", std::nullopt}}) {
    calib::ConsideredEffect& effect = considered.effects.emplace_back();
    effect.key = key;
    effect.alone = size;
    considered.missing.push_back(key);
  }
  considered.missing.emplace_back("kd");  // no effect has this key
  const auto terms = missing_terms(model::PlantKind::load_pressure, considered);
  REQUIRE(terms.size() == 4);
  CHECK(terms[0].line ==
        "valve_time_constant = { start = \"0.0002 s\", lower = \"0 s\", upper = \"0.0022 s\", "
        "fit = true }");
  CHECK_FALSE(terms[0].of_controller);
  CHECK(terms[1].line ==
        "position_gain = { start = 0.996, lower = 0.956, upper = 1.04, fit = true }");
  CHECK(terms[2].of_controller);
  CHECK(
      terms[2].line ==
      "ki = { start = \"5 V/(m s)\", lower = \"0 V/(m s)\", upper = \"55 V/(m s)\", fit = true }");
  // There is no derivative with respect to the sampling period.
  CHECK(terms[3].line == "sample_time = \"0.001 s\"");
}

TEST_CASE("with_terms: each line stands at the head of its table", "[report]") {
  const std::vector<MissingTerm> terms{{false, "coulomb_friction = 1"}, {true, "ki = 2"}};
  CHECK(with_terms("a = 1\n[rig.parameters]\nmass = 1\n[rig.controller]\nkp = 1\n", terms) ==
        "a = 1\n[rig.parameters]\ncoulomb_friction = 1\nmass = 1\n[rig.controller]\nki = 2\nkp = "
        "1\n");
  CHECK(with_terms("a = 1\n[rig.parameters]\nmass = 1\n", terms) ==
        "a = 1\n[rig.parameters]\ncoulomb_friction = 1\nmass = 1\n\n[rig.controller]\nki = 2\n");
  CHECK(with_terms("a = 1\n", {}) == "a = 1\n");
}

}  // namespace
}  // namespace rigcal::report
