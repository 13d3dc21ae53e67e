#pragma once

#include <string>
#include <string_view>

namespace rigcal::calib {

/// Returns the unit of a * b^power in base units, such as "s" for kg (N s/m)^-1, or "1" if it has
/// no dimension. Accepts the units of parameters: kg, m, s, rad (as 1), V, K, N and Pa, with digits
/// as exponents and at most one `/`, after which everything is in the denominator: "m3/(s Pa)".
///
/// @throws std::invalid_argument  if it does not know one of the units
std::string unit_product(std::string_view a, std::string_view b, double power);

/// Exponent of kg in a unit: 1 for "N s/m", -1 for "m3/(s Pa)".
///
/// @throws std::invalid_argument  if unit_product() does not know the unit
double mass_exponent(std::string_view unit);

}  // namespace rigcal::calib
