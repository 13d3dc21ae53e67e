#pragma once

#include <string>

namespace rigcal::test {

/// The parameters that all campaigns with a small rig have in common, as lines of [rig.parameters].
inline const std::string kSmallRig = R"(stiffness = "0 N/m"
piston_area = "633 mm2"
total_volume = "468 cm3"
density = "850 kg/m3"
bulk_modulus = "689 MPa"
discharge_coefficient = 0.6
area_gradient = "20 mm"
leakage_area = "1 mm2"
)";

}  // namespace rigcal::test
