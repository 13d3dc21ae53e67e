#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace rigcal::test {

/// The rig that reproduces the paper's tables, with its internal leak at a medium opening. SI
/// units.
inline constexpr auto kPaperRig = std::to_array<std::pair<std::string_view, double>>({
    {"mass", 85.0},
    {"damping", 1000.0},
    {"stiffness", 0.0},
    {"piston_area", 1.62e-3},
    {"total_volume", 2.46888e-4},
    {"supply_pressure", 6.2e6},
    {"density", 847.0},
    {"bulk_modulus", 689e6},
    {"discharge_coefficient", 0.6},
    {"area_gradient", 0.02075},
    {"valve_gain", 0.0406e-3},
    {"leakage_coefficient", 0.35},
    {"leakage_area", 4.456e-6},
    {"kp", 78.74},
});

}  // namespace rigcal::test
