#pragma once

#include <string>
#include <string_view>

namespace rigcal {

/// Unit of a * b^power in base units, "s" for kg and (N s/m)^-1; "1" without a dimension. Knows the
/// units of parameters: kg, m, s, rad (1), V, K, N, Pa, with digits as exponents and one `/`, after
/// which everything divides: "m3/(s Pa)".
///
/// @throws std::invalid_argument  another unit
std::string unit_product(std::string_view a, std::string_view b, double power);

/// Power of kg in a unit: 1 of "N s/m", -1 of "m3/(s Pa)".
///
/// @throws std::invalid_argument  a unit that unit_product() does not know
double mass_exponent(std::string_view unit);

}  // namespace rigcal
