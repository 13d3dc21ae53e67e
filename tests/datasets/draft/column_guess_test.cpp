#include "datasets/draft/column_guess.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "common/quantity.hpp"

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
                                {"acc_base_g", Channel::base_acceleration, "gravity"},
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
                                {"duty_arm_in_pct", Channel::command, "%"},
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

TEST_CASE("guess_column: the part in a loop is apart from the quantity", "[datasets]") {
  const auto channel = [](const char* name) { return guess_column(name).channel; };
  for (const char* name :
       {"x_cmd_mm", "x_des_mm", "pos_cmd_mm", "pos_ref_mm", "Weg_Soll_mm", "Position_soll_mm",
        "Displacement Command (mm)", "Axial Displacement Command", "Wegsoll", "target position",
        "refpos", "xref", "x_d_mm", "u_mm", "r_mm", "Position Setpoint [mm]", "x_cmd_V"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::reference);
  }
  for (const char* name :
       {"Kraft_Soll_kN", "Sollkraft", "target load kN", "Axial Force Command", "Fsoll_N"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::force_reference);
  }
  for (const char* name : {"acc_ref_g", "a_soll_g", "Beschleunigung Soll [m/s2]"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::acceleration_reference);
  }
  for (const char* name : {"valve command", "spool_cmd_V", "Steuerspannung", "Ventilstrom_mA",
                           "servo cmd [V]", "cmd_v", "u_soll_V", "Stellgröße"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::command);
  }
  for (const char* name : {"act_mm", "actual_mm", "fb_mm", "Istweg", "xist", "Kolbenposition [mm]",
                           "Zylinderweg", "LVDT1", "rod_mm", "x_r_mm", "x_l_mm"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::position);
  }
  CHECK(channel("p_ref_bar") == Channel::load_pressure_reference);
  CHECK(channel("ref_deg") == Channel::angle_reference);
  CHECK(channel("Winkel_Soll") == Channel::angle_reference);
  for (const char* name : {"Drehmoment_Soll_Nm", "torque_ref_Nm", "M_soll_Nm"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::torque_reference);
  }
  CHECK(channel("Istkraft") == Channel::force);
  CHECK(channel("feedback_kN") == Channel::force);
  for (const char* name : {"torque", "Drehmoment_Nm", "M_ist_Nm", "shaft moment [kN m]"}) {
    CAPTURE(name);
    CHECK(channel(name) == Channel::torque);
  }
}

TEST_CASE("guess_column: where a pressure is", "[datasets]") {
  struct Case {
    const char* name;
    std::optional<Channel> channel;
  };
  for (const Case& each :
       {Case{"Druck Kolbenseite [bar]", Channel::pressure_a},
        Case{"Druck Stangenseite [bar]", Channel::pressure_b},
        Case{"Ringseite_bar", Channel::pressure_b}, Case{"Head Pressure", Channel::pressure_a},
        Case{"Rod Pressure", Channel::pressure_b}, Case{"Cap Pressure [bar]", Channel::pressure_a},
        Case{"Bore Pressure", Channel::pressure_a}, Case{"Pressure Port A", Channel::pressure_a},
        Case{"Pressure Port B [bar]", Channel::pressure_b},
        Case{"Piston Side Pressure", Channel::pressure_a}, Case{"p_1_bar", Channel::pressure_a},
        Case{"Pumpendruck", Channel::supply_pressure},
        Case{"Return pressure_bar", Channel::tank_pressure},
        Case{"load_bar", Channel::load_pressure}, Case{"deltap_bar", Channel::load_pressure},
        Case{"p_x_bar", std::nullopt}, Case{"p_bar_01", std::nullopt},
        Case{"p_A_ref_bar", std::nullopt},  // no loop controls one side
        Case{"oil pressure_bar", std::nullopt}}) {
    CAPTURE(each.name);
    CHECK(guess_column(each.name).channel == each.channel);
  }
}

TEST_CASE("guess_column: what no channel records", "[datasets]") {
  struct Case {
    const char* name;
    std::string_view other;
  };
  for (const Case& each : {Case{"v_mm_s", "a velocity"},
                           Case{"v_mm/s", "a velocity"},
                           Case{"Geschwindigkeit_mm/s", "a velocity"},
                           Case{"Durchfluss_l/min", "a flow"},
                           Case{"n_rpm", ""},
                           Case{"y_%", ""},
                           Case{"err_mm", "a control error"},
                           Case{"valve_position_mm", "the position of a spool"},
                           Case{"supply voltage [V]", ""},
                           Case{"start", ""},
                           Case{"offset", ""},
                           Case{"Untitled 1", ""},
                           Case{"Spool Feedback (V)", "the position of a spool"},
                           Case{"Istwert Ventil [V]", "the position of a spool"},
                           Case{"Schieber_Ist_%", "the position of a spool"},
                           Case{"PosDiff", "a control error"},
                           Case{"Schleppfehler [mm]", "a control error"},
                           Case{"ActVelo", "a velocity"},
                           Case{"n_Pumpe_1_min", "a speed of rotation"},
                           Case{"D\u00e9bit [l/min]", "a flow"},
                           Case{"Cycle pressure time [ms]", ""}}) {
    CAPTURE(each.name);
    const ColumnGuess guess = guess_column(each.name);
    CHECK_FALSE(guess.is_time);
    CHECK_FALSE(guess.channel);
    CHECK(guess.other == each.other);
  }
}

TEST_CASE("guess_column: units of several parts, and capital umlauts", "[datasets]") {
  CHECK(guess_column("a_m/s2").channel == Channel::acceleration);
  CHECK(guess_column("acc_g").unit == "gravity");
  CHECK(guess_column("acc [g]").unit == "gravity");
  CHECK(guess_column("acc", "g").unit == "gravity");
  CHECK(guess_column("Öltemperatur [degC]").channel == Channel::temperature);
  CHECK(guess_column("STELLGRÖSSE").channel == std::nullopt);  // SS is not lowered to ß
  CHECK(guess_column("Rücklaufdruck").channel == Channel::tank_pressure);
  CHECK(guess_column("RÜCKLAUFDRUCK").channel == Channel::tank_pressure);
}

TEST_CASE("guess_column: a unit that the file gives decides like one in the name", "[datasets]") {
  CHECK(guess_column("cmd", "mm").channel == Channel::reference);
  CHECK(guess_column("cmd", "V").channel == Channel::command);
  CHECK(guess_column("Axial Displacement Command", "mm").channel == Channel::reference);
  CHECK(guess_column("x", "bar").channel == std::nullopt);
  CHECK(guess_column("p", "PSI").unit == "psi");
  CHECK(guess_column("x", "counts").unit == "counts");
}

TEST_CASE("guess_column: names of other languages and of controllers", "[datasets]") {
  struct Case {
    const char* name;
    Channel channel;
  };
  for (const Case& each : {Case{"Consigne position [mm]", Channel::reference},
                           Case{"Consigna [mm]", Channel::reference},
                           Case{"Riferimento posizione [mm]", Channel::reference},
                           Case{"D\u00e9placement [mm]", Channel::position},
                           Case{"Course v\u00e9rin (mm)", Channel::position},
                           Case{"POSICI\u00d3N (mm)", Channel::position},
                           Case{"Posizione attuale [mm]", Channel::position},
                           Case{"Fuerza (kN)", Channel::force},
                           Case{"Effort [kN]", Channel::force},
                           Case{"Pression chambre A (bar)", Channel::pressure_a},
                           Case{"Presi\u00f3n A (bar)", Channel::pressure_a},
                           Case{"Pressione B [bar]", Channel::pressure_b},
                           Case{"Pression alimentation [bar]", Channel::supply_pressure},
                           Case{"Pressione scarico [bar]", Channel::tank_pressure},
                           Case{"Commande vanne (V)", Channel::command},
                           Case{"Corrente valvola [mA]", Channel::command},
                           Case{"Corriente v\u00e1lvula (mA)", Channel::command},
                           Case{"I_Spule_A", Channel::command},
                           Case{"Ventilansteuerung [%]", Channel::command},
                           Case{"Schieber_Soll_%", Channel::command},
                           Case{"Temperatura olio (\u00b0C)", Channel::temperature},
                           Case{"\u00d6ltemp. [\u00b0C]", Channel::temperature},
                           Case{"temp_grad", Channel::temperature},
                           Case{"Pos. Soll [mm]", Channel::reference},
                           Case{"Pos. Ist", Channel::position},
                           Case{"GVL.rPressureA", Channel::pressure_a},
                           Case{"MAIN.fValveOut", Channel::command},
                           Case{"rActPosition", Channel::position},
                           Case{"lrPosition", Channel::position},
                           Case{"fPosSoll", Channel::reference},
                           Case{"fSoll_N", Channel::force_reference},
                           Case{"xSoll", Channel::reference},
                           Case{"CylPressA_bar", Channel::pressure_a},
                           Case{"RodEndPressure", Channel::pressure_b},
                           Case{"BoomPressHead", Channel::pressure_a},
                           Case{"\"Model Root\"/\"Position\"/\"Out1\"", Channel::position},
                           Case{"A-Druck [bar]", Channel::pressure_a},
                           Case{"P-Druck [bar]", Channel::supply_pressure},
                           Case{"p_Sys_bar", Channel::supply_pressure},
                           Case{"Prs_A", Channel::pressure_a},
                           Case{"ax [g]", Channel::acceleration},
                           Case{"AccX_g", Channel::acceleration},
                           Case{"F_N_m", Channel::force}}) {
    CAPTURE(each.name);
    CHECK(guess_column(each.name).channel == each.channel);
  }
  CHECK(guess_column("AI 1/Druck_B").channel == Channel::pressure_b);
  CHECK(guess_column("p Druck A").channel == Channel::pressure_a);
  CHECK(guess_column("control effort [V]").channel == Channel::command);
  CHECK(guess_column("ax1_pos").channel == Channel::position);
  CHECK(guess_column("Real Time (s)").is_time);
  CHECK(guess_column("temp_grad").unit == "degC");
  CHECK(guess_column("F_N_m").unit == "N");
  for (const char* name : {"Tiempo (s)", "Tempo [s]", "RecTime", "timestamps", "Zeit rel. [s]"}) {
    CAPTURE(name);
    CHECK(guess_column(name).is_time);
  }
}

TEST_CASE("guess_column: a load from outside, and a force between parts of the rig", "[datasets]") {
  for (const char* name : {"F_ext_kN", "External Force (kN)", "F_load_N", "Lastkraft_kN", "M_ext",
                           "M_ext_Nm", "St\u00f6rkraft_kN", "Gegenkraft [N]", "Lastmoment_Nm"}) {
    CAPTURE(name);
    const ColumnGuess guess = guess_column(name);
    CHECK(guess.is_external_load);
    CHECK((guess.channel == Channel::force || guess.channel == Channel::torque));
  }
  for (const char* name : {"Load (kN)", "load cell [kN]", "Axial Force (kN)", "F_kN", "Istkraft",
                           "F_load_ist_N", "M_Nm", "p_ext_bar", "m_load"}) {
    CAPTURE(name);
    CHECK_FALSE(guess_column(name).is_external_load);
  }
}

TEST_CASE("guess_by_unit: where the name tells nothing", "[datasets]") {
  const auto guess = [](const char* unit, std::vector<Channel> taken) {
    return guess_by_unit(unit, taken);
  };
  CHECK(guess("mm", {}) == Channel::position);
  CHECK(guess("mm", {Channel::position}) == Channel::reference);
  CHECK(guess("bar", {Channel::position}) == Channel::pressure_a);
  CHECK(guess("bar", {Channel::pressure_a}) == Channel::pressure_b);
  CHECK(guess("mV", {}) == Channel::command);
  CHECK_FALSE(guess("mm", {Channel::position, Channel::reference}));
  CHECK_FALSE(guess("", {}));
  CHECK_FALSE(guess("rpm", {}));
}

TEST_CASE("guess_column: units in names, of every quantity and as many spellings", "[datasets]") {
  struct Case {
    std::string name;
    std::optional<Channel> channel;
    std::string_view si;
    double per_unit = 1.0;  ///< SI value of one unit
  };
  const auto none = std::nullopt;
  const double kDeg = std::acos(-1.0) / 180.0;
  const std::vector<Case> cases{{"M_kNm", Channel::torque, "N m", 1e3},
                                {"M [kNm]", Channel::torque, "N m", 1e3},
                                {"M_kN_m", Channel::torque, "N m", 1e3},
                                {"torque [kN m]", Channel::torque, "N m", 1e3},
                                {"Drehmoment (N\u00b7m)", Channel::torque, "N m"},
                                {"torque_N.m", Channel::torque, "N m"},
                                {"torque_N-m", Channel::torque, "N m"},
                                {"Mext_Nm", Channel::torque, "N m"},
                                {"Lastmoment_Nm", Channel::torque, "N m"},
                                {"External_Moment_kNm", Channel::torque, "N m", 1e3},
                                {"moment_daNm", Channel::torque, "N m", 10.0},
                                {"torque_mNm", Channel::torque, "N m", 1e-3},
                                {"torque_nm", Channel::torque, "N m"},
                                {"torque [nm]", Channel::torque, "N m"},
                                {"torque [ft-lb]", Channel::torque, "N m", 1.3558179483314},
                                {"torque [in-lbf]", Channel::torque, "N m", 0.1129848290276},
                                {"Msoll_Nm", Channel::torque_reference, "N m"},
                                {"M_soll_kNm", Channel::torque_reference, "N m", 1e3},
                                {"torque_cmd_kNm", Channel::torque_reference, "N m", 1e3},
                                {"pump torque [Nm]", none, "N m"},
                                {"k_N_m", none, "N m"},  // a stiffness may be meant
                                {"F_daN", Channel::force, "N", 10.0},
                                {"F_kgf", Channel::force, "N", 9.80665},
                                {"F_MN", Channel::force, "N", 1e6},
                                {"F_mN", Channel::force, "N", 1e-3},
                                {"pA_psi", Channel::pressure_a, "Pa", 6894.757293168},
                                {"P_A_PSI", Channel::pressure_a, "Pa", 6894.757293168},
                                {"pB_mbar", Channel::pressure_b, "Pa", 100.0},
                                {"pA_N/mm2", Channel::pressure_a, "Pa", 1e6},
                                {"p_A [kp/cm2]", Channel::pressure_a, "", 0.0},
                                {"Q_gpm", none, "m3/s", 6.30901964e-5},
                                {"Q_cm3_s", none, "m3/s", 1e-6},
                                {"acc [m/s\u00b2]", Channel::acceleration, "m/s2"},
                                {"acc_mm_s2", Channel::acceleration, "m/s2", 1e-3},
                                {"v_mm/s", none, "m/s", 1e-3},
                                {"omega_\u00b0/s", none, "rad/s", kDeg},
                                {"angle_mrad", Channel::angle, "rad", 1e-3},
                                {"theta_\u00b0", Channel::angle, "rad", kDeg},
                                {"Drehwinkel_Grad", Channel::angle, "rad", kDeg},
                                {"encoder_deg", Channel::angle, "rad", kDeg},
                                {"encoder_mm", Channel::position, "m", 1e-3},
                                {"angle_ref_mrad", Channel::angle_reference, "rad", 1e-3},
                                {"x_\u00b5m", Channel::position, "m", 1e-6},
                                {"x_um", Channel::position, "m", 1e-6},
                                {"x_mil", Channel::position, "m", 2.54e-5},
                                {"X_CMD_MM", Channel::reference, "m", 1e-3},
                                {"T_\u00b0C", Channel::temperature, "K"}};
  for (const Case& each : cases) {
    CAPTURE(each.name);
    const ColumnGuess guess = guess_column(each.name);
    CAPTURE(guess.unit);
    CHECK_FALSE(guess.is_time);
    CHECK(guess.channel == each.channel);
    if (each.si.empty()) continue;
    REQUIRE(converts_to(guess.unit, each.si));
    CHECK(rigcal::unit_conversion(guess.unit, each.si).scale ==
          Approx(each.per_unit).epsilon(1e-6));
  }
}
