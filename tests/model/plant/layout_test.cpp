#include "model/plant/layout.hpp"

#include <catch2/catch.hpp>

#include "tests/model/rig.hpp"

using namespace rigcal::model;

TEST_CASE("layout_of: states follow from what was given", "[model]") {
  struct Row {
    std::vector<const char*> given;
    ControllerKind controller;
    int valve, integral, filter, held, states;
  };
  constexpr auto kPid = ControllerKind::pid;
  for (const Row& row : {
           Row{{}, kPid, -1, -1, -1, -1, 3},
           Row{{"valve_time_constant"}, kPid, 3, -1, -1, -1, 4},
           Row{{"valve_frequency"}, kPid, 3, -1, -1, -1, 5},
           Row{{"valve_time_constant", "main_spool_gain", "ki"}, kPid, 3, 5, -1, -1, 6},
           Row{{"valve_frequency", "main_spool_gain"}, kPid, 3, -1, -1, -1, 6},
           Row{{"main_spool_gain"}, kPid, -1, -1, -1, -1, 3},
           Row{{"ki"}, kPid, -1, 3, -1, -1, 4},
           Row{{"kd"}, kPid, -1, -1, 3, -1, 4},
           Row{{"sample_time"}, kPid, -1, -1, -1, 3, 4},
           Row{{"valve_frequency", "ki", "kd", "sample_time"}, kPid, 3, 5, 6, 7, 8},
           Row{{"valve_time_constant", "ki", "kd"}, kPid, 3, 4, 5, -1, 6},
           // Without a controller, its parameters add no states.
           Row{{"ki", "kd", "sample_time"}, ControllerKind::none, -1, -1, -1, -1, 3},
       }) {
    auto values = paper_rig();
    for (const char* key : row.given) values.set(key, 1.0);
    const Layout layout = layout_of({PlantKind::load_pressure, row.controller, {}}, values, {}, 3);
    CAPTURE(row.given);
    CHECK(layout.states == row.states);
    CHECK(layout.valve == row.valve);
    CHECK(layout.integral == row.integral);
    CHECK(layout.filter == row.filter);
    CHECK(layout.held == row.held);
    CHECK(layout.sampled() == (row.held >= 0));
    CHECK_FALSE(layout.terms.friction);
  }
}

TEST_CASE("layout_of: either dry-friction term brings friction", "[model]") {
  for (const char* key : {"coulomb_friction", "stribeck_friction"}) {
    auto values = paper_rig();
    values.set(key, 1.0);
    const PresentTerms terms = layout_of({}, values, {}, 3).terms;
    CHECK(terms.friction);
    CHECK(terms.stribeck == values.is_given("stribeck_friction"));
  }
  auto values = ParameterValues::defaults(PlantKind::linkage);
  values.set("joint_friction", 1.0);
  const PresentTerms terms = layout_of({PlantKind::linkage, {}, {}}, values, {}, 4).terms;
  CHECK((terms.joint_friction && !terms.friction));
}

TEST_CASE("layout_of: a leak of zero takes part only where it is free", "[model]") {
  auto values = paper_rig();
  const std::vector<int> free{parameter_index(values.plant, "leakage_coefficient")};
  values.set("leakage_coefficient", 0.0);
  CHECK_FALSE(layout_of({}, values, {}, 3).terms.orifice_leak);
  CHECK(layout_of({}, values, free, 3).terms.orifice_leak);
  values.set("leakage_coefficient", 0.15);
  CHECK(layout_of({}, values, {}, 3).terms.orifice_leak);
}

TEST_CASE("layout_of: the valve has its state at a lag of zero, free or not", "[model]") {
  auto values = paper_rig();
  const std::vector<int> free{parameter_index(values.plant, "valve_time_constant")};
  values.set("valve_time_constant", 0.0);
  CHECK(layout_of({}, values, {}, 3).states == 4);
  CHECK(layout_of({}, values, free, 3).states == 4);
}
