#pragma once

#include <string>
#include <string_view>

namespace rigcal {

/// Returns the unit of a * b^power in base units: "s" for kg and (N s/m)^-1, "1" if it has no
/// dimension. Knows the units of parameters: kg, m, s, rad (1), V, K, N, Pa, with digits as
/// exponents and one `/`, after which everything is in the denominator: "m3/(s Pa)".
///
/// @throws std::invalid_argument  if it does not know a unit
std::string unit_product(std::string_view a, std::string_view b, double power);

/// Power of kg in a unit: 1 for "N s/m", -1 for "m3/(s Pa)".
///
/// @throws std::invalid_argument  if unit_product() does not know the unit
double mass_exponent(std::string_view unit);

}  // namespace rigcal
