#include "datasets/read/unit_in_name.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace rigcal::datasets;

TEST_CASE("unit_in_name: in brackets, or behind a word", "[datasets]") {
  struct Case {
    std::string name;
    std::string unit;
    bool is_certain = true;
  };
  const std::vector<Case> cases{{"pl_bar [psi]", "psi"},
                                {"x_mm (m)", "m"},
                                {"t_s [ms]", "ms"},
                                {"x [mm]", "mm"},
                                {"p [kgf/cm2]", "kgf/cm2"},
                                {"p [kg/cm2]", "kgf/cm2"},
                                {"p [PSI]", "psi"},
                                {"p [psig]", "psi"},
                                {"p [MPA]", "MPa"},
                                {"T [C]", "degC"},
                                {"/run1/v [m/s]", "m/s"},
                                {"u [%]", "%"},
                                {"q (m3/(s Pa))", "m3/(s Pa)"},
                                {"x [mm] filtered", "mm"},
                                {"x_mm", "mm", false},
                                {"/run1/x_mm", "mm", false},
                                {"Log!pA_bar_03", "bar", false},
                                {"Position in mm", "mm", false},
                                {"t in s", "s", false},
                                {"rod_m_1_mm", "mm", false},
                                {"p_bar_A", "bar", false},
                                {"p_bar_min", "bar", false},  // the least pressure
                                {"p_bar_s_pa", "bar", false},
                                {"x_in", "in", false},
                                {"x_in_1", "in", false},
                                {"p_pa", "Pa", false},
                                {"p (in)", "in", false},
                                {"t (min)", "min", false},
                                {"v_mm_s", "mm/s", false},
                                {"v_mm/s", "mm/s", false},
                                {"v_mm_s_03", "mm/s", false},
                                {"acc_m_s2", "m/s2", false},
                                {"a_m/s^2", "m/s2", false},
                                {"q_l/min", "L/min", false},
                                {"omega_deg_s", "deg/s", false},
                                {"x_mm_s_filtered", "mm", false},  // "s" may be anything here
                                {"p_bar_s", "bar", false},         // pressure of the supply
                                {"duty_pct", "%", false},
                                {"y_%", "%", false},
                                {"M_Nm", "N m", false},
                                {"n_rpm", "rpm", false},
                                {"M_kNm", "kNm", false},
                                {"M_kN_m", "kN m", false},
                                {"torque_N-m", "N m", false},
                                {"torque_N.m", "N m", false},
                                {"M_N\u00b7m", "N\u00b7m", false},
                                {"torque [N\u00b7m]", "N\u00b7m"},
                                {"torque [NM]", "N m"},
                                {"torque [ft-lb]", "ft lbf"},
                                {"torque_in_lb [in-lb]", "inch lbf"},
                                {"torque_ft_lb", "ft lbf", false},
                                {"torque [nm]", "nm", false},  // newton metres may be meant
                                {"M_mNm", "mNm", false},
                                {"M_MNm", "MNm", false},
                                {"Force in lbs", "lbf", false},
                                {"F_daN", "daN", false},
                                {"F_mN", "mN", false},
                                {"F_MN", "MN", false},
                                {"F_kgf", "kgf", false},
                                {"F [kp]", "kgf"},
                                {"p_N/mm2", "N/mm2", false},
                                {"p_kgf_cm2", "kgf/cm2", false},
                                {"p_mbar", "mbar", false},
                                {"P_A_PSI", "psi", false},  // capitals only
                                {"X_ACT_MM", "mm", false},
                                {"PRESS_PA", "Pa", false},
                                {"q_cm3_s", "cm3/s", false},
                                {"Q_gpm", "gpm", false},
                                {"n [U/min]", "rpm"},
                                {"v [ips]", "inch/s"},
                                {"theta_mrad", "mrad", false},
                                {"Winkel_Grad", "deg", false},
                                {"omega_\u00b0/s", "\u00b0/s", false},
                                {"a_m/s\u00b2", "m/s\u00b2", false},
                                {"x_\u00b5m", "\u00b5m", false},
                                {"x_\u03bcm", "\u03bcm", false},
                                {"T_\u00b0C", "\u00b0C", false}};
  for (const Case& each : cases) {
    CAPTURE(each.name);
    const auto found = unit_in_name(each.name);
    REQUIRE(found);
    CHECK(found->unit == each.unit);
    CHECK(found->is_certain == each.is_certain);
  }
  for (const char* name : {"x", "x (ist)", "p (A)", "pressure (g)", "x [-]", "x [1]", "data(:,3)",
                           "ans(2,:)", "p_A", "/s/x", "run (2)", "Pressure Port A", "", "[mm]",
                           "x [", "log.s.values", "log.N.m", "X_MEAN"}) {
    CAPTURE(name);
    CHECK_FALSE(unit_in_name(name));
  }
}

TEST_CASE("unit_of_text: what UDUNITS calls it", "[datasets]") {
  CHECK(unit_of_text(" mm ") == "mm");
  CHECK(unit_of_text("seconds since 2026-01-01 00:00:00") == "seconds");
  CHECK(unit_of_text("BAR") == "bar");
  CHECK(unit_of_text("S") == "s");
  CHECK(unit_of_text("Volt") == "Volt");
  CHECK(unit_of_text("Nm") == "N m");
  CHECK(unit_of_text("nm") == "nm");
  CHECK(unit_of_text("percent") == "%");
  for (const char* text : {"", "raw", "2 mm", "see note", "-"}) {
    CAPTURE(text);
    CHECK(unit_of_text(text).empty());
  }
}
