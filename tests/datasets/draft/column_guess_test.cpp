#include "datasets/draft/column_guess.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace rigcal::datasets;

TEST_CASE("guess_column: channels and units by name", "[datasets]") {
  struct Case {
    std::string name;
    std::optional<Channel> channel;
    std::string unit;
  };
  const std::vector<Case> cases{{"ref_mm", Channel::reference, "mm"},
                                {"x [mm]", Channel::position, "mm"},
                                {"Position (cm)", Channel::position, "cm"},
                                {"x_mm_A", Channel::position, "mm"},
                                {"pA_bar_", Channel::pressure_a, "bar"},
                                {"p_b_bar", Channel::pressure_b, "bar"},
                                {"P1_psi", Channel::pressure_a, "psi"},
                                {"pA", Channel::pressure_a, ""},
                                {"p_A [bar]", Channel::pressure_a, "bar"},
                                {"p_A_bar", Channel::pressure_a, "bar"},
                                {"pressure_B_MPa", Channel::pressure_b, "MPa"},
                                {"Pressure A (Pa)", Channel::pressure_a, "Pa"},
                                {"chamber_A_bar", Channel::pressure_a, "bar"},
                                {"log.chamberB", Channel::pressure_b, ""},
                                {"p_cap_bar", Channel::pressure_a, "bar"},
                                {"p_rod_bar", Channel::pressure_b, "bar"},
                                {"p2_pa", Channel::pressure_b, "Pa"},
                                {"u_A", Channel::command, "A"},
                                {"pl_bar", Channel::load_pressure, "bar"},
                                {"supply_pressure", Channel::supply_pressure, ""},
                                {"u_V", Channel::command, "V"},
                                {"cmd_mm", Channel::reference, "mm"},
                                {"ref_kN", Channel::force_reference, "kN"},
                                {"ref_force_norm", Channel::force_reference, ""},
                                {"force_norm", Channel::force, ""},
                                {"setpoint_bar", Channel::load_pressure_reference, "bar"},
                                {"acc_x", Channel::acceleration, ""},
                                {"acc_base_g", Channel::base_acceleration, ""},
                                {"ground acceleration [m/s2]", Channel::base_acceleration, "m/s2"},
                                {"log.position", Channel::position, ""},
                                {"F_kN", Channel::force, "kN"},
                                {"temp_C", Channel::temperature, "degC"},
                                {"pl_bar [psi]", Channel::load_pressure, "psi"},
                                {"p_A [kgf/cm2]", Channel::pressure_a, "kgf/cm2"},
                                {"/m/position", Channel::position, ""},
                                {"Sollwert [mm]", Channel::reference, "mm"},
                                {"Weg", Channel::position, ""},
                                {"Lastdruck (bar)", Channel::load_pressure, "bar"},
                                {"Druck_A_bar", Channel::pressure_a, "bar"},
                                {"Druck A [bar]", Channel::pressure_a, "bar"},
                                {"U1_V", Channel::command, "V"},
                                {"s1_mm", Channel::position, "mm"},
                                {"pt_bar", Channel::tank_pressure, "bar"},
                                {"drive_t_mm", Channel::reference, "mm"},
                                {"drive_V", Channel::command, "V"},
                                {"dem_mm", Channel::reference, "mm"},
                                {"target_mm", Channel::reference, "mm"},
                                {"duty_arm_in_pct", Channel::command, ""},
                                {"block", std::nullopt, ""},
                                {"data(:,2)", std::nullopt, ""},
                                {"", std::nullopt, ""}};
  for (const Case& each : cases) {
    CAPTURE(each.name);
    const ColumnGuess guess = guess_column(each.name);
    CHECK_FALSE(guess.is_time);
    CHECK(guess.channel == each.channel);
    CHECK(guess.unit == each.unit);
  }
}

TEST_CASE("guess_column: the time", "[datasets]") {
  for (const char* name :
       {"t", "t_s", "Time [s]", "log.time", "tout", "Zeit", "Zeit_s", "X_Value"}) {
    CAPTURE(name);
    CHECK(guess_column(name).is_time);
    CHECK_FALSE(guess_column(name).channel);
  }
  CHECK(guess_column("t_ms").unit == "ms");
}

TEST_CASE("guess_by_unit: where the name tells nothing", "[datasets]") {
  CHECK(guess_by_unit("mm", false) == Channel::position);
  CHECK(guess_by_unit("mm", true) == Channel::reference);
  CHECK(guess_by_unit("bar", true) == Channel::pressure_a);
  CHECK(guess_by_unit("mV", true) == Channel::command);
  CHECK_FALSE(guess_by_unit("", true));
  CHECK_FALSE(guess_by_unit("rpm", true));
}
